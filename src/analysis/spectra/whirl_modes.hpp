// Whirl modes of the spinning rotor: frequency, damping, direction, kind, shape.
//
// x(t) = Re(x exp(lambda t)). Direction: the orbit of a node in the plane across its shaft is the
// sum of a part that turns with the spin, |Y + i s Z|/2, and one against it, |Y - i s Z|/2 (Y, Z
// amplitudes along e2, e3; s = +1 where the shaft turns from e2 to e3, else -1). Whose spin that is
// for what stands still: spin_senses() in steady_rotation.hpp. Kind: the largest share of the
// energy (kinetic and strain) among lateral, torsional and axial motion.
#pragma once
#include <analysis/spectra/growth_bound.hpp>
#include <analysis/linearizer.hpp>
#include <analysis/spectra/frequency_dependent_modes.hpp>
#include <la/axis_count.hpp>
#include <la/eigen.hpp>
#include <la/wedge_count.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace whirl::analysis {

enum class Direction {
  forward,
  backward,
  mixed,
  planar,
  none
};  ///< planar: no orbit has an area; none: not lateral
enum class ModeKind { lateral, torsional, axial };
std::string_view to_string(Direction d);
std::string_view to_string(ModeKind k);

struct WhirlMode {
  Complex lambda;            ///< 1/s, Im >= 0
  double frequency = 0;      ///< damped natural frequency Im lambda, rad/s
  double damping_ratio = 0;  ///< -Re lambda / |lambda|; 0 for a rigid motion
  double log_decrement =
      0;  ///< -2 pi Re lambda / Im lambda, per cycle; +-inf when it does not oscillate
  ModeKind kind = ModeKind::lateral;
  Direction direction = Direction::none;
  double forwardness = 0;  ///< sum of (forward^2 - backward^2)/(forward^2 + backward^2), -1 .. 1: a
                           ///< smooth measure of direction
  double lateral = 0, torsional = 0, axial = 0;  ///< shares of energy
  VecXc x;  ///< (u, phi, gamma) a node; largest displacement (twist, when torsional) is 1 and real
  double residual = 0;  ///< backward error of the eigenpair
  double rounding = 0;  ///< 1/s: growth that rounding of the matrices alone can cause
  /// +1: grows, -1: decays, 0: neutral, its growth rate being within rounding of zero.
  int growth() const { return lambda.real() > rounding ? 1 : lambda.real() < -rounding ? -1 : 0; }
  /// False of real roots and of pairs damped beyond 0.949 of critical (la::oscillates).
  bool oscillates() const { return la::oscillates(lambda); }
  /// 1/s: lambda to first order with coefficients that depend on frequency continued to the complex
  /// frequency -i lambda of the motion itself (OwnFrequency::continued); equal to lambda where
  /// nothing depends on it.
  Complex continued;
  Index from = -1;  ///< mode of the last speed it continues, -1: none
};

struct ModesOptions {
  Index count = 12;                 ///< modes of least frequency
  double max_frequency = infinity;  ///< rad/s; with count = 0: all modes up to it
  Motion motion = Motion::all;
  bool damped = true;       ///< false: conservative part of the matrices only
  bool real_roots = false;  ///< also motions that do not oscillate
  bool continued = false;   ///< also WhirlMode::continued
  bool certify = true;      ///< count the roots: SpectrumCertificate
  /// Go on to the frequency above which nothing can grow (growth_bound.hpp), and list what grows
  /// whatever its number.
  bool judge = false;
};

/// What is known of a list of modes, and of its stability.
struct SpectrumCertificate {
  la::Certificate list;  ///< roots counted against roots found
  std::string open;      ///< why nothing was counted; empty when it was
  /// rad/s: above it nothing grows (energy) by more than quiet_ratio of its frequency, times its
  /// frequency over this one; nan: not excluded, or not asked for.
  double quiet_above = nan;
  double quiet_ratio = 0;
  /// Supports tabulated against frequency: growing roots counted along the imaginary axis, on which
  /// alone the tables say what the supports do (la/axis_count.hpp). It certifies that every growing
  /// motion is in the list; of the decaying ones ByFrequency says what is known.
  struct Axis {
    bool counted = false;  ///< the samples settle, and the problem at the tables' end is certified
    Index unknown = 0;     ///< growing roots beyond those found
    bool held_beyond = true;  ///< false: the tables end, and were held beyond for the count
    double top = 0;           ///< rad/s: where they end
    Index factorizations = 0;
    bool certain() const { return counted && unknown == 0; }
  };
  std::optional<Axis> axis;
  /// The same supports, and hysteretic damping: `list` is what la/wedge_count.hpp says, of modes from
  /// `low` (rad/s) on.
  struct ByFrequency {
    double low = 0;
    Index rising = 0;  ///< roots met at which a branch of frequencies rises; not in the list
  };
  std::optional<ByFrequency> by_frequency;
  /// More or fewer motions grow, by the count along the imaginary axis, than were found.
  bool contradicted() const { return axis && axis->counted && axis->unknown != 0; }
  bool complete() const { return open.empty() && list.complete() && !contradicted(); }
  /// Every growing motion is in the list, at any frequency.
  bool stability_certain() const {
    return axis ? axis->certain() : complete() && quiet_above <= list.radius;
  }
  /// "every root up to 1234 Hz (damping ratio to 0.95) counted"; what is missing and where; or why
  /// not.
  std::string text() const;
  void take(const OwnFrequency::Known& known);

 private:
  std::string text_of_list() const;
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
  const la::MCK& matrices_at(double Omega, Complex lambda, double side = nan);
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
  std::vector<WhirlMode> modes_;
};

/// Fills kind, direction and the rest from lambda and x. Scales x.
WhirlMode describe_mode(const la::Mode& mode, const la::MCK& m, const Linearizer& linear);

/// |x^H M y|^2/((x^H M x)(y^H M y)), 0 .. 1: likeness of two shapes.
double likeness(const la::MCK& m, const VecXc& x, const VecXc& y);

/// The elliptic orbit Re((Y, Z) exp(i omega t)) of a point.
struct Orbit {
  double forward = 0, backward = 0;  ///< radii of the two circles, with the spin and against it
  double major = 0, minor = 0;       ///< half axes; minor < 0: run against the spin
  double angle = 0;                  ///< of the major axis, from e2 towards e3, rad
};
/// sense: +1 where the spin is from e2 to e3, -1 where it is the other way.
Orbit orbit_of(Complex Y, Complex Z, double sense = 1.0);

/// Displacement amplitude of a node along the axes (e, e2, e3) of its line.
Eigen::Vector3cd local_displacement(const Linearizer& linear, const VecXc& x, Index node);

}  // namespace whirl::analysis
