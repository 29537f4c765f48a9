// What a problem with constant matrices (Problem::is_linear) may offer beside its residual.
#pragma once
#include <core/contract.hpp>
#include <time/problem.hpp>
#include <span>

namespace whirl::time {

/// Where motion goes on freely from a state.
struct FreeMotion {
  double t;                      ///< of the state
  CRef q, v;                     ///< the state
  std::span<const double> span;  ///< times after t
  std::span<const double> time;  ///< t + span, rounded as the scheme has them
};

class AffineProblem {
 public:
  virtual ~AffineProblem() = default;
  /// Column k of r = R(time_k, q + span_k v, v, 0) with held entries as at time_k: R is affine, so
  /// that all columns share the products with the matrices. False: residual() is to be asked for
  /// each (held entries do not move freely, or one of the columns is not finite).
  /// @pre r with a column for every time.
  virtual bool residuals_along(const FreeMotion& m, Eigen::Ref<MatX> r) = 0;
};

}  // namespace whirl::time
