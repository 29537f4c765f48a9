// What a problem with constant matrices (Problem::is_linear) may offer beside its residual.
#pragma once
#include <core/contract.hpp>
#include <time/problem.hpp>
#include <optional>
#include <span>

namespace whirl::time {

/// Where motion goes on freely from a state.
struct FreeMotion {
  double t;                      ///< of the state
  CRef q, v;                     ///< the state
  std::span<const double> span;  ///< times after t
  std::span<const double> time;  ///< t + span, rounded as the scheme has them
};

/// What a state leaves of the residual along every motion from it:
///   R(t + s, q + s v + y, v + y', a) = M a + C y' + K y + force + s rate + x(t + s)
/// with x of AffineProblem::changing().
struct Bound {
  VecX force, rate;
  void resize(Index n) {
    force.setZero(n);
    rate.setZero(n);
  }
};

/// Products with the matrices that a step asks for beside those of its end.
struct StepProducts {
  VecX stiff_of, inertia_of, filter_of;
  double shift = 0.0;
  VecX stiff;    ///< K stiff_of
  VecX inertia;  ///< M inertia_of
  VecX filter;   ///< (shift M + C) filter_of
  void resize(Index n) {
    for (VecX* x : {&stiff_of, &inertia_of, &filter_of, &stiff, &inertia, &filter})
      x->setZero(n);
  }
};

/// Its power() counts as supplied what the stored energy gains and what is dissipated, less the work
/// of the residual, v . R over works(): so that the balance of a run closes but for the work that
/// the residual of the interpolant does (Integrator::residual_work).
class AffineProblem {
 public:
  virtual ~AffineProblem() = default;
  /// Column k of r = R(time_k, q + span_k v, v, 0) with held entries as at time_k: R is affine, so
  /// that all columns share the products with the matrices. False: residual() is to be asked for
  /// each (held entries do not move freely, or one of the columns is not finite).
  /// @pre r with a column for every time.
  virtual bool residuals_along(const FreeMotion& m, Eigen::Ref<MatX> r) = 0;
  /// Whether Bound and changing() tell the residual along this motion and beside it: what is held
  /// goes on freely, and the rest of R(t) is known. What an earlier call found stays known.
  virtual bool bound_along(const FreeMotion& m) = 0;
  /// The bound of a state and, in the same pass over the matrices, what the step asks for.
  /// @pre bound_along() of a motion from this state; all vectors of length size().
  virtual void multiply(double t, CRef q, CRef v, Bound& bound, StepProducts& step) = 0;
  /// R = M a + C v + K q + (first degree in t) + x(t), x zero but for these entries; nothing where x
  /// is not known to be so. Known once residuals_along() has succeeded.
  virtual std::optional<std::span<const Index>> changing_entries() const = 0;
  /// Those entries of x.
  /// @pre values of the length of changing_entries().
  virtual void changing(double t, Ref values) const = 0;
  /// Per unknown: 1 where its row of R times its rate is power.
  virtual std::span<const unsigned char> works() const = 0;
};

}  // namespace whirl::time
