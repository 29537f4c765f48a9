// One accepted step at a time through R(t, q, v, a) = 0: the interface of every time scheme.
//
//   auto integrator = make_integrator("radau5", problem, options);
//   integrator->start(t0, q0, v0);
//   while (integrator->time() < t_end) {
//     const StepReport step = integrator->advance();
//     if (!step.ok()) throw ...;                       // recovery by shorter steps is exhausted
//     integrator->interpolate(t, q, v, a);             // anywhere in [step.t0, step.t1]
//   }
//
// Problem::accept() (whole turns out of phi, change of chart) is called at the *beginning* of the
// next advance(), so the step just made, its dense output and its end state all stand in one chart.
#pragma once
#include <core/law.hpp>
#include <time/problem.hpp>
#include <time/twist_scale.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <span>
#include <vector>

namespace whirl::time {

/// What one unit of error is, by kind of unknown. The scale of a kind is its running response: half
/// the range its largest unknown has swept since start (for spin_angle always spin_angle_scale,
/// never the number of turns; for internal unknowns each its own). Floors hold while nothing has
/// moved, among them 1e-6 of the size of the coordinates themselves (a sag, for tilts over the length
/// too); the displacement and tilt scales also floor each other (cross_floor * length), so that the
/// round-off in a coordinate the motion never reaches asks for no steps.
struct Scales {
  double spin_angle = 1.0;            ///< rad
  double displacement = 0.0;          ///< expected response, m; 0: unknown, found while running
  double tilt = 0.0;                  ///< expected response, rad; 0: unknown
  double internal = 0.0;              ///< expected response, own units; 0: unknown
  double floor_displacement = 1e-13;  ///< m
  double floor_tilt = 1e-13;          ///< rad
  double floor_internal = 1e-9;       ///< own units
  double length = 1.0;                ///< a length of the model, m: converts tilt to displacement
  double cross_floor = 1e-6;
  /// Unknowns that something finer than the response of their kind depends on (the journal in a
  /// film: the clearance), and the largest scale they may have.
  struct Limit {
    Index unknown;
    double scale;
  };
  std::vector<Limit> limits;
  /// Shafts whose twist is looked at, and whether steps are chosen such that it is right to the
  /// tolerance of its own range; else only its error is told (Statistics::twist_error).
  std::vector<TwistGroup> twists;
  bool follow_twist = false;
};

struct Options {
  double tolerance = 1e-4;  ///< aimed-at global error relative to the peak response of each kind
  double t_end = infinity;  ///< a step lands on it exactly
  double dt_fixed =
      0.0;  ///< > 0: equal steps, no longer than this, between breakpoints; 0: adaptive
  double dt_first = 0.0;  ///< 0: chosen
  /// Shorter ones only where they end: at a stop, a break, a corner. 0: 1e-14 of the time reached
  /// and never below 1e-300
  double dt_min = 0.0;
  double dt_max = infinity;
  std::vector<double>
      breakpoints;  ///< times where data jump: a step lands on each and history is dropped there
  std::vector<Pace> paces;  ///< adaptive steps keep them
  Scales scales;
  double rho_inf = 0.9;  ///< generalized-alpha: spectral radius at infinite step, 0..1
  int max_newton = 10;   ///< iterations a step
  bool linearize_inside =
      false;  ///< matrices inside the steps, where Newton's iteration converges best: for films.
              ///< Not where gaps may close: the error test passes over what the matrices make
              ///< stiff, so a step would pass over a whole impact
  int max_attempts = 60;  ///< tries of one step before it is given up
  int max_order = 2;      ///< IDA only: BDF above 2 is unstable on lightly damped modes
};

enum class StepStatus {
  ok,
  error_test,  ///< step shorter than dt_min still fails the error test
  newton,      ///< Newton does not converge at dt_min
  domain,      ///< residual() refuses the configuration at dt_min
  singular,    ///< iteration matrix singular at dt_min
  finished     ///< advance() called at t_end: nothing was done
};
std::string_view message(StepStatus);

struct StepReport {
  StepStatus status = StepStatus::ok;
  double t0 = 0.0, t1 = 0.0;  ///< the accepted step
  double error = 0.0;         ///< estimated local error / its allowance (<= 1 when adaptive)
  int newton_iterations = 0;  ///< of the accepted attempt
  int rejected_error = 0, rejected_newton = 0;
  bool at_breakpoint = false;  ///< t1 is a breakpoint
  bool ok() const { return status == StepStatus::ok; }
};

struct Statistics {
  long accepted = 0, rejected_error = 0, rejected_newton = 0;
  long newton_iterations = 0, linearizations = 0, factorizations_real = 0,
       factorizations_complex = 0;
  long residuals = 0, solves_real = 0, solves_complex = 0;
  double step_min = infinity, step_max = 0.0, step_sum = 0.0;  ///< of accepted steps, s
  /// Estimated local error / allowance.
  double error_max = 0.0, error_sum = 0.0;
  // of judged_statistics()
  double twist = 0.0;         ///< half the range of twist (Scales::twists), rad
  double twist_error = 0.0;   ///< largest local error / allowance in it, by that range
  bool twists_alone = false;  ///< nothing has moved but in twist
  double step_mean() const { return accepted ? step_sum / static_cast<double>(accepted) : 0.0; }
  double error_mean() const { return accepted ? error_sum / static_cast<double>(accepted) : 0.0; }
};

/// Everything a scheme needs to continue bit-identically. The Problem's own state (charts, turns)
/// is saved by its owner at the same moment.
struct IntegratorState {
  double t = 0.0;
  VecX q, v, a;
  std::vector<double> history;  ///< scheme-specific, opaque
  std::vector<double> serialize() const;
  /// @throws std::invalid_argument when the data are not what serialize() wrote.
  static IntegratorState deserialize(const std::vector<double>& data);
};

class Integrator {
 public:
  virtual ~Integrator() = default;
  virtual std::string_view name() const = 0;
  /// Classical order of q for smooth solutions.
  virtual int order() const = 0;

  /// Begins at (t, q, v): held entries are imposed, a (and, of massless unknowns, what the
  /// equations determine) computed. Statistics and scales start anew.
  /// @throws Error when the initial acceleration cannot be found.
  /// @pre q and v of length Problem::size().
  virtual void start(double t, CRef q, CRef v) = 0;
  /// The problem changed its equations, or the caller the state, at the present time: continues
  /// from (q, v) without history. Scales and statistics go on. corner: the force has one here (a
  /// gap closes). What begins may be far faster than what was, and leave again with rates that act
  /// for as long as the steps were before: until steps are as long again, errors of rates count as
  /// displacements after that time. (Position errors alone let a contact of microseconds rebound as
  /// it likes.)
  virtual void restart(CRef q, CRef v, bool corner = false) = 0;
  /// One accepted step (or the reason why none is possible; the state is then that before the
  /// step).
  /// @throws Error (N20, N21) where the data jump and no acceleration or velocity follows.
  virtual StepReport advance() = 0;
  /// Makes the last step again so that it ends at t, t0 < t < t1 of that step (to land on an
  /// event), before any other advance().
  /// @throws std::invalid_argument for a t outside the last step.
  virtual StepReport shorten_to(double t) = 0;

  virtual double time() const = 0;
  virtual const VecX& q() const = 0;
  virtual const VecX& v() const = 0;
  virtual const VecX& a() const = 0;
  /// Length the next step will try.
  virtual double proposed_step() const = 0;
  /// State at t inside the last step, held entries exact from their laws. v = q', a = q'' of the
  /// same interpolant.
  /// @pre vectors of length Problem::size().
  virtual void interpolate(double t, Ref q, Ref v, Ref a) const = 0;
  /// The same of some entries of q alone, in the order given; false, and nothing written, where the
  /// scheme has no cheaper way than interpolate(), or one of the entries is held.
  /// @pre q of the length of entries.
  virtual bool interpolate_entries(double t, std::span<const Index> entries, Ref q) const {
    (void)t;
    (void)entries;
    (void)q;
    return false;
  }
  /// State at t inside the last step, of these entries alone and of those that are held, the others
  /// left as they are; false, and nothing written, as above.
  /// @pre vectors of length Problem::size().
  virtual bool interpolate_some(double t, std::span<const Index> entries, Ref q, Ref v,
                                Ref a) const {
    (void)t;
    (void)entries;
    (void)q;
    (void)v;
    (void)a;
    return false;
  }
  /// Work the residual does along the interpolant of the last step, integral of v . R dt over the
  /// unknowns, N m, right to rounding: what is missing in the balance of energy of an AffineProblem.
  /// Nothing for other problems, and where the scheme has no cheap way to say.
  virtual std::optional<double> residual_work() { return std::nullopt; }

  /// To be called by whoever used linearize() or factor() of the problem between steps.
  virtual void refresh() = 0;
  virtual void set_end(double t_end) = 0;
  virtual void set_breakpoints(std::vector<double> times) = 0;
  virtual const Statistics& statistics() const = 0;
  /// The same; errors of equal steps by the response of the whole run so far, and those of twist.
  virtual Statistics judged_statistics() const { return statistics(); }

  /// Snapshot between steps. Marks a fresh linearisation for the next step, here and in whoever
  /// restores it: the two continue bit-identically (with equal options).
  virtual IntegratorState save() = 0;
  /// @throws std::invalid_argument when it is the state of another problem or scheme.
  virtual void restore(const IntegratorState& state) = 0;
};

/// name: radau5, gauss4, gauss6, generalized_alpha, ida (loads the SUNDIALS plug-in). The problem
/// must outlive it.
/// @throws Error for an unknown name or options out of range.
std::unique_ptr<Integrator> make_integrator(std::string_view name, Problem& problem,
                                            const Options& options);
/// The names make_integrator knows.
std::vector<std::string_view> integrator_names();

}  // namespace whirl::time
