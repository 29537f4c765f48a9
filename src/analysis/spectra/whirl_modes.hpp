// Whirl modes of the spinning rotor at one speed or a series of them (whirl_mode.hpp: what a mode is).
#pragma once
#include <analysis/spectra/growth_bound.hpp>
#include <analysis/spectra/frequency_dependent_modes.hpp>
#include <analysis/spectra/spectrum_certificate.hpp>
#include <analysis/spectra/whirl_mode.hpp>
#include <la/axis_count.hpp>
#include <la/eigen.hpp>
#include <la/wedge_count.hpp>
#include <optional>
#include <vector>

namespace whirl::analysis {

struct ModesOptions {
  Index count = 12;                 ///< modes of least frequency
  double max_frequency = infinity;  ///< rad/s; with count = 0: all modes up to it
  Index guard = 2;  ///< modes sought beyond count, so that the next speed of a series loses none
  Motion motion = Motion::all;
  bool damped = true;       ///< false: conservative part of the matrices only
  bool real_roots = false;  ///< also motions that do not oscillate
  bool continued = false;   ///< also WhirlMode::continued
  bool certify = true;      ///< count the roots: SpectrumCertificate
  /// Go on to the frequency above which nothing can grow (growth_bound.hpp), and list what grows
  /// whatever its number.
  bool judge = false;
  /// Hysteretic damping as of a motion at this multiple of the speed: of synchronous whirl nothing, which
  /// lies on neither side of the spin. NaN: as of each motion's own frequency.
  double hysteresis_order = nan;
};

/// Modes at one speed: motions that do not oscillate first (when asked for), then by frequency.
std::vector<WhirlMode> whirl_modes(Linearizer& linear, double Omega,
                                   const ModesOptions& options = {},
                                   SpectrumCertificate* certificate = nullptr);

/// Modes at a series of speeds; each call starts from what the last one found. Supports tabulated
/// against frequency (SteadyRotation:: table_frequencies): every whirling mode satisfies Q(lambda;
/// Im lambda) x = 0, its coefficients being those at its own frequency
/// (frequency_dependent_modes.hpp: all of them); real roots take those at zero frequency, or the
/// synchronous ones where the tables do not reach down to it. Hysteretic damping makes the problem
/// depend on lambda likewise: each mode is solved for in turn until it agrees with the rate its
/// matrices are for (contraction about half the loss factor a round).
class WhirlSolver {
 public:
  explicit WhirlSolver(Linearizer& linear, const ModesOptions& options = {});
  const std::vector<WhirlMode>& solve(double Omega);
  /// The next solve() starts from what the other solver, of the same system and options, found last.
  void start_from(const WhirlSolver& other) { solver_.start_from(other.solver_); }
  /// Moves the matrices to a speed without looking for modes.
  void move_to(double Omega) { matrices_at(Omega, Complex(0, infinity)); }
  /// The mode near `start` at another speed, by Newton; nullopt when there is none or another one
  /// was met (shape changed).
  std::optional<WhirlMode> follow(double Omega, const WhirlMode& start);
  /// Matrices at the last speed.
  const la::MCK& matrices() const { return *matrices_; }
  Linearizer& linear() { return linear_; }
  const ModesOptions& options() const { return options_; }
  la::ModeSolver::Work work() const { return solver_.work(); }
  /// Of the last solve().
  const SpectrumCertificate& certificate() const { return certificate_; }

 private:
  const la::MCK& matrices_at(double Omega, Complex lambda, double side = nan) {
    return matrices_at(Omega, lambda, side, lambda.imag());
  }
  /// tables: frequency that supports answer to.
  const la::MCK& matrices_at(double Omega, Complex lambda, double side, double tables);
  bool by_frequency() const { return own_.has_value(); }
  /// Matrices with the tables at a frequency, hysteretic damping left to settle_rate.
  OwnFrequency::Matrices at_frequency(double Omega);
  /// The mode that `start` (an eigenpair at its own rate) becomes when hysteretic damping acts at
  /// the rate of the mode itself.
  std::optional<la::Mode> settle_rate(double Omega, la::Mode start);
  void solve_by_frequency(double Omega);
  void solve_hysteretic(double Omega);
  /// Counts the modes known (all that were settled, before the list is cut to its number) by
  /// la/wedge_count.hpp, in bands between the speeds of the shafts, at which their damping jumps.
  void count_hysteretic(double Omega);
  /// Better vectors of modes of nearly equal frequency, within the space they span, under the
  /// damping at their mean rate.
  void separate(double Omega, std::vector<la::Mode>& group);
  void solve_counted(double Omega);
  /// Lateral modes of one root (separate_pair).
  void separate_pairs(bool turning);
  std::optional<GrowthBound::Quiet> quiet_above(const la::MCK& m, double reached);
  /// Modes with one set of matrices and, where stability is judged, all that grows.
  const std::vector<la::Mode>& judged(const la::MCK& m, double Omega, SpectrumCertificate& known);
  /// Growing roots on supports that answer by frequency. rest: what is known of the roots with the
  /// coefficients of zero frequency.
  void count_along_axis(double Omega, const la::Certificate& rest);
  /// Adds growing motions from beyond the list, where the count along the axis asks for more.
  void add_growth_beyond(double Omega);
  /// Matrices that a root answers to: of its own frequency; of real roots those of zero frequency
  /// where the tables reach it, else the synchronous ones.
  const la::MCK& own_matrices(double Omega, Complex lambda);
  Linearizer& linear_;
  ModesOptions options_;
  MotionReduction motion_;
  la::ModeSolver solver_;
  std::optional<GrowthBound> bound_;  ///< where stability is judged
  SpectrumCertificate certificate_;
  std::optional<OwnFrequency> own_;  ///< where supports answer by frequency
  std::optional<la::AxisCounter> axis_;
  double quiet_held_ = 0;  ///< rad/s: with the ends of the tables held all that grows is slower
  std::optional<la::WedgeCounter> wedge_;  ///< where damping is hysteretic
  const la::MCK* matrices_ = nullptr;
  la::BlockMatrix<6> following_;  ///< stiffness of what follows, where the rate is complex
  std::vector<WhirlMode> modes_;
  std::vector<la::Mode> shorter_;  ///< a list that is complete, where a longer one is not
};

}  // namespace whirl::analysis
