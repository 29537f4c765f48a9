// Continuation of f(q, mu) = 0 past limit points. The problem comes as callbacks; nothing here
// throws or knows mechanics. Arc length: E. Riks, J. Appl. Mech. 39 (1972) 1060, doi
// 10.1115/1.3422829; the corrector stays in the plane across the tangent.
#pragma once
#include <core/types.hpp>
#include <functional>

namespace whirl::la {

/// f(q, mu) = 0 with one parameter (load factor).
struct ContinuationProblem {
  virtual ~ContinuationProblem() = default;
  virtual bool residual(const VecX& q, double mu, VecX& f) = 0;
  /// df/dmu.
  virtual void load(const VecX& q, double mu, VecX& f_mu) = 0;
  virtual bool factor(const VecX& q, double mu) = 0;
  virtual void solve(VecX& b) = 0;
  /// Characteristic size of every unknown (> 0), and of mu.
  virtual const VecX& scale() const = 0;
  virtual double mu_scale() const { return 1.0; }
};

struct ContinuationOptions {
  double first_step =
      0.05;  ///< scaled arc length (or, with a controlled unknown, scaled change of it)
  double min_step = 1e-8, max_step = 0.5;
  int max_steps = 1000;
  int max_iterations = 12;    ///< of one corrector
  double tolerance = 1e-10;   ///< scaled size of the corrector step that is left
  int wanted_iterations = 4;  ///< the step grows below and shrinks above
  Index controlled = -1;      ///< >= 0: displacement control, steps of this unknown (its sign:
                              ///< first_step < 0 goes down)
  double direction = 1.0;     ///< arc length: sign of the first change of mu
  double last_mu = infinity;  ///< stop when mu passes this value, exactly there
  double last_controlled = infinity;  ///< displacement control: stop when the controlled unknown
                                      ///< reaches this value, exactly there
  /// Arc length: the first step goes this way (scaled to length 1 by the run) with mu as it is,
  /// instead of along the tangent. It leaves a point where K is singular for another branch.
  const VecX* start_direction = nullptr;
};

struct ContinuationPoint {
  double mu = 0.0;
  double arc = 0.0;  ///< scaled arc length so far
  double dmu = 0.0;  ///< dmu/ds of the tangent; changes sign at a limit point
  int iterations = 0;
  bool limit_point = false;  ///< dmu/ds has changed sign since the last point
};

enum class ContinuationStatus { finished, stopped, step_too_small, singular_start, too_many_steps };

struct ContinuationResult {
  ContinuationStatus status = ContinuationStatus::finished;
  int steps = 0;
};

/// Follows the branch through (q, mu), which must be a solution. `accept` sees every point and ends
/// the run by returning false. Arc length (E. Riks; H. B. Keller) or displacement control, by
/// bordering: each iteration is one factorisation and two solutions.
class Continuation {
 public:
  using Accept = std::function<bool(const VecX& q, const ContinuationPoint&)>;
  /// @pre problem.scale() of the length of q and positive; 0 < min_step <= max_step; first_step not
  /// 0.
  ContinuationResult run(ContinuationProblem& problem, VecX& q, double& mu,
                         const ContinuationOptions& options, const Accept& accept);
  /// The point of the path at `part` (0 .. 1) of the chord from (qa, mua) to (qb, mub), in the
  /// plane across it; false: none found.
  bool between(ContinuationProblem& problem, const VecX& qa, double mua, const VecX& qb, double mub,
               double part, const ContinuationOptions& options, VecX& q, double& mu);

 private:
  void prepare(ContinuationProblem& problem, Index n);
  bool tangent(ContinuationProblem& problem, const VecX& q, double mu,
               const ContinuationOptions& options, bool first);
  /// The direction of the first step; false: K is singular at the start.
  bool set_out(ContinuationProblem& problem, const VecX& q, double mu,
               const ContinuationOptions& options);
  /// failed, turned: ds is halved, and nothing was taken.
  enum class Advance { failed, turned, on_the_way, arrived };
  /// One step of length ds from (q, mu) to trial_ and trial_mu_. point: all but its arc length.
  Advance advance(ContinuationProblem& problem, const VecX& q, double mu, double& ds, bool leaving,
                  const ContinuationOptions& options, ContinuationPoint& point);
  int correct(ContinuationProblem& problem, const VecX& q, double mu, double ds,
              const ContinuationOptions& options, bool fixed_mu);

  VecX f_, load_, a_, b_, trial_, direction_, last_, weight_;
  double trial_mu_ = 0.0, mu_direction_ = 0.0, mu_weight_ = 1.0;
};

}  // namespace whirl::la
