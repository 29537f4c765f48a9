// Modes followed over the speed through crossings and veerings: what the Campbell diagram, damped
// critical speeds and the onset of instability share.
//
// From one speed to the next the modes are paired by likeness of shape and nearness of frequency
// (best pairs first). When the pairing is in doubt, a speed in between is put in, down to 1/256 of
// the step: at a crossing the shapes then keep apart, at a veering they turn gradually.
#pragma once
#include <analysis/spectra/modes_ahead.hpp>
#include <functional>

namespace whirl::analysis {

struct TrackOptions {
  ModesOptions modes;
  double doubt = 0.6;    ///< likeness below which an intermediate speed is put in
  int halvings = 8;      ///< at most
  int most_doubts = 64;  ///< between two speeds asked for; then pairs are taken as they are (a
                         ///< rotor whose modes change beyond recognition)
  /// rad/s: speeds that advance() will be asked for, in this order, and how many of them (0: all) are
  /// found side by side (modes_ahead.hpp) on how many threads (0: all processors).
  std::vector<double> ahead{};
  std::size_t at_once = 0;
  int threads = 1;
};

/// One mode on its way. id counts lines in order of appearance; before is valid when has_before.
struct TrackedMode {
  Index id = 0;
  WhirlMode now, before;
  bool has_before = false;
};

class ModeTracker {
 public:
  ModeTracker(Linearizer& linear, const TrackOptions& options);

  /// Called for every step taken, intermediate ones included: speed before, speed now.
  using Visit = std::function<void(double, double, const std::vector<TrackedMode>&)>;
  /// Goes on to Omega; visit sees each step.
  const std::vector<TrackedMode>& advance(double Omega, const Visit& visit = {});
  double speed() const { return speed_; }
  Index lines() const { return next_id_; }
  WhirlSolver& solver() { return solver_; }
  /// Of the modes at hand.
  const SpectrumCertificate& certificate() const { return certificate_; }
  long speeds_solved() const { return solved_; }

 private:
  /// Likeness of a mode at hand and a new one.
  struct Likeness;
  /// All pairs within reach, best first.
  std::vector<Likeness> compare(const std::vector<WhirlMode>& found);
  /// of_new: for each new mode the one at hand that it continues, or -1. False: in doubt.
  bool pair(const std::vector<WhirlMode>& found, bool last_chance, std::vector<Index>& of_new);
  bool step(double Omega, bool last_chance);
  /// From those found ahead, else solved for.
  const std::vector<WhirlMode>& find(double Omega);
  Linearizer& linear_;
  TrackOptions options_;
  WhirlSolver solver_;
  std::optional<ModesAhead> ahead_;
  const ModesAtSpeed* found_ahead_ = nullptr;
  SpectrumCertificate certificate_;
  bool started_ = false;
  double speed_ = 0;
  Index next_id_ = 0;
  long solved_ = 0;
  std::vector<TrackedMode> modes_;
};

/// The speed between a and b at which g(Omega, lambda) of one followed mode is zero, to `tolerance`
/// relative to the larger speed: secant safeguarded by bisection, with a mode solved for at each
/// trial. start_a, start_b: the mode at both ends. nullopt: the mode was lost, or
/// another taken for it.
struct TrackedRoot {
  double speed = 0;
  WhirlMode mode;
};
/// @pre a != b, tolerance > 0.
std::optional<TrackedRoot> find_on_mode(WhirlSolver& solver, double a, const WhirlMode& start_a,
                                        double b, const WhirlMode& start_b,
                                        const std::function<double(double, const WhirlMode&)>& g,
                                        double tolerance = 1e-13);

}  // namespace whirl::analysis
