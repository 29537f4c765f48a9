// Critical speeds of any excitation order n, solved for directly: a whirl frequency equal to n
// Omega.
//
// Undamped (the conservative part M, skew C, symmetric K): speeds at which the Hermitian matrix
//   S(Omega) = K(Omega) + i n Omega C(Omega) - (n Omega)^2 M
// is singular. The number of its negative eigenvalues (Sylvester, from the block factorisation)
// changes by one at each, so none is missed between the speeds of the search grid; bisection on
// that number isolates it and a secant on the eigenvalue finds it to rounding. K and C are
// linearised anew at every trial speed: bearings that depend on speed are included exactly.
//
// Damped: speeds at which Im lambda(Omega) = n Omega for a damped mode, i.e. crossings in the
// Campbell diagram of the damped frequency. Modes are followed over the speed and the crossing
// solved for by secant. (Peaks of the response lie a little elsewhere; see api684.hpp for those.)
#pragma once
#include <analysis/spectra/track.hpp>
#include <string>

namespace whirl::analysis {

struct CriticalOptions {
  double order = 1;      ///< excitations a revolution
  double min_speed = 0;  ///< rad/s; 0 stands for a thousandth of the highest
  double max_speed = 0;  ///< rad/s
  bool damped = false;
  bool certify = true;  ///< count the damped modes that are followed; else they are only found
  Motion motion = Motion::all;
  Index grid = 40;                  ///< speeds of the search
  double max_frequency = infinity;  ///< rad/s: critical speeds beyond it are left out
  double tolerance = 1e-13;         ///< relative
  int threads = 1;                  ///< 0: all processors; the results are the same for any number
};

struct Critical {
  double speed = 0;      ///< rad/s
  double frequency = 0;  ///< order x speed, rad/s
  double order = 1;
  WhirlMode mode;  ///< at that speed
  /// Of the eigenvalue there, 1/(2 zeta): what a half-power measurement would give for a lone mode.
  /// inf where nothing damps it beyond rounding, or it grows.
  double amplification() const { return mode.growth() < 0 ? 0.5 / mode.damping_ratio : infinity; }
};

/// Damped critical speeds of one order, found while modes are followed over rising speeds: steps in
/// which a frequency passes n Omega are kept, and solved for afterwards.
class OrderCrossings {
 public:
  /// modes: those that are followed, which tell how far up each list reaches.
  /// @pre order > 0, 0 <= min_speed < max_speed.
  OrderCrossings(double order, double min_speed, double max_speed, const ModesOptions& modes);
  /// One step of the tracker, as ModeTracker::Visit.
  void look(double from, double to, const std::vector<TrackedMode>& modes);
  /// In ascending order.
  std::vector<Critical> solve(const Linearizer& linear, double tolerance, int threads = 1);
  /// rad/s: up to here no crossing was beyond the lists of modes or, once solved for, lost.
  double sure_to() const { return sure_to_; }

 private:
  struct Step {
    double from, to;
    WhirlMode before, now;
  };
  double gap(double Omega, const WhirlMode& w) const { return w.frequency - order_ * Omega; }
  double reach_of(const std::vector<TrackedMode>& modes) const;
  double order_, min_speed_, max_speed_, sure_to_;
  bool sure_ = true;
  ModesOptions modes_;
  std::vector<Step> steps_;
};

/// rad/s: so far up the undamped frequencies of motions reach whose highest damped one has this frequency
/// (rad/s) and damping ratio. It is |lambda|, but for what damping does to the shape, which is of the second
/// order in the ratio.
double undamped_reach(double frequency, double damping_ratio);

/// Where a search begins: at standstill every rotor that turns freely has the frequency 0 = n x 0,
/// which is no critical speed.
double lowest_speed(double min_speed, double max_speed);
/// In ascending order. certificate: of the damped modes they are crossings of, at the speed of the
/// search where least is known (undamped ones are counted by inertia: none is missed).
/// @throws Error (E77) without an order above zero and a range of speeds.
std::vector<Critical> critical_speeds(Linearizer& linear, const CriticalOptions& options,
                                      SpectrumCertificate* certificate = nullptr);

/// Undamped critical speeds against the stiffness of the supports. build: the system with that
/// stiffness (N/m) in its supports, the same nodes at every stiffness.
///
/// From one stiffness to the next the critical speeds are paired by shape, whatever way they turn:
/// |projection|^2 on the other one's modes in the metric of the mass, less half the relative
/// distance of the speeds, best pairs first. Where two shapes are less than 0.6 alike, or lines
/// change places whose shapes are not nearly the same, a stiffness in between is put in (down to
/// 1/16 of the step on a logarithmic scale); what stays in doubt is paired from
/// below: a critical speed rises with the stiffness, by no more than its root.
struct CriticalMapOptions {
  CriticalOptions critical;
  SteadyRotation running;
  std::vector<double> stiffness;  ///< N/m, ascending
  /// Without lines that turn backward at all their stiffnesses (forwardness below -0.5), which
  /// unbalance hardly excites, and with one line for two planes of equal speeds.
  bool forward_only = true;
  bool undeformed = false;  ///< Linearizer::stay_undeformed()
  int threads = 1;          ///< of the stiffnesses; 0: all processors
};
struct CriticalMapLine {
  ModeKind kind = ModeKind::lateral;
  Direction direction = Direction::forward;  ///< by the mean of forwardness; never mixed
  double forwardness = 0;                    ///< WhirlMode::forwardness, mean of the stiffnesses
  std::vector<double> speed;  ///< rad/s, one a stiffness; nan: not between min_speed and max_speed
};
struct CriticalMap {
  std::vector<double> stiffness;
  std::vector<CriticalMapLine> lines;  ///< by speed at the first stiffness they appear at
};
/// With a motion other than all, of that kind of modes alone.
CriticalMap critical_map(const std::function<system::System(double stiffness)>& build,
                         const CriticalMapOptions& options);

}  // namespace whirl::analysis
