// Residual check and iterative refinement for S x = b with S = cm M + cc C + ck K.
#pragma once
#include <la/direct.hpp>

namespace whirl::la {

template <class Scalar>
class Refinement {
 public:
  using Vec = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  /// active as given to the solver; copied.
  Refinement(const BlockPattern& pattern, std::span<const unsigned char> active);

  /// Componentwise backward error max_i |b - S x|_i / (|S| |x| + |b|)_i (Oettli & Prager,
  /// doi 10.1007/BF01386090): the smallest relative change of the single entries of S and b that
  /// makes x exact. Does not depend on units; about 1e-15 when x is as good as the data deserve.
  /// Rows of held unknowns do not count. Keeps the residual for correct().
  double backward_error(const MCK& m, Scalar cm, Scalar cc, Scalar ck, const Vec& x, const Vec& b);
  /// x += S^-1 (b - S x) with the residual of the last backward_error() and a solver that holds S
  /// (or something near it).
  void correct(DirectSolver<Scalar>& solver, Vec& x);
  /// Up to `steps` corrections until the backward error is below `goal`; returns the last backward
  /// error.
  double refine(DirectSolver<Scalar>& solver, const MCK& m, Scalar cm, Scalar cc, Scalar ck,
                const Vec& b, Vec& x, int steps = 2, double goal = 1e-15);
  const Vec& residual() const { return residual_; }

 private:
  std::vector<unsigned char> active_;
  Vec residual_;
  VecX size_;
};

extern template class Refinement<double>;
extern template class Refinement<Complex>;

}  // namespace whirl::la
