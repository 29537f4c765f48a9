// Dense factorisations and eigenvalue problems of any size, by Eigen, compiled once: Eigen's
// solvers take seconds of every file that instantiates them, so only dense.cpp does.
#pragma once
#include <core/types.hpp>
#include <memory>
#include <optional>

namespace whirl::la {

/// A x = values(j) x for x = vectors.col(j), each of unit length; in no particular order.
struct DenseEigenpairs {
  VecXc values;
  MatXc vectors;
};

/// All eigenpairs of a square matrix (n x n).
/// @pre square and finite.
DenseEigenpairs eigenpairs(const MatX& a);
DenseEigenpairs eigenpairs(const MatXc& a);
/// Eigenvalues alone.
VecXc eigenvalues(const MatX& a);

/// A x = values(j) x with values ascending and orthonormal columns x.
struct SymmetricEigenpairs {
  VecX values;
  MatX vectors;
};

/// Of a symmetric matrix; only its lower triangle is read.
SymmetricEigenpairs symmetric_eigenpairs(const MatX& a);
/// K x = values(j) M x with M symmetric and positive definite; vectors are M-orthonormal.
SymmetricEigenpairs symmetric_eigenpairs(const MatX& k, const MatX& m);
/// Of a Hermitian matrix, ascending.
VecX hermitian_eigenvalues(const MatXc& a);

/// Moore-Penrose inverse.
MatX pseudo_inverse(const MatX& a);
/// x with A x = b in least squares, the shortest of them.
/// @pre as many rows of A as of b, here and below.
MatX least_squares(const MatX& a, const MatX& b);
VecXc least_squares(const MatXc& a, const VecXc& b);
/// x with A x = b by full pivoting; A square, perhaps nearly singular.
VecXc pivoted_solution(const MatXc& a, const VecXc& b);
/// The same; nothing when no pivot exceeds `least` or A is singular in rounding.
std::optional<MatX> pivoted_solution(const MatX& a, const MatX& b, double least);

/// Orthonormal columns that span those of A, directions below `threshold` of the largest left out.
MatX orthonormal_span(const MatX& a, double threshold);

/// A = P L U with partial pivoting. Scalar: double or Complex.
template <class Scalar>
class DenseLu {
 public:
  using Mat = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vec = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  DenseLu();
  /// @param a square and regular: nothing is checked.
  explicit DenseLu(const Mat& a);
  ~DenseLu();
  DenseLu(DenseLu&&) noexcept;
  DenseLu& operator=(DenseLu&&) noexcept;

  void factor(const Mat& a);
  Vec solve(const Vec& b) const;
  Mat solve(const Mat& b) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

/// The space that the columns of a matrix span, by QR with column pivoting. Scalar: double or
/// Complex.
template <class Scalar>
class ColumnSpan {
 public:
  using Mat = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vec = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  explicit ColumnSpan(const Mat& a);
  ~ColumnSpan();
  /// c that makes the length of x - A c least.
  Vec coordinates(const Vec& x) const;
  /// What is left of x outside the space: x - A c.
  Vec outside(const Vec& x) const;

 private:
  struct Factors;
  std::unique_ptr<Factors> factors_;
};

extern template class DenseLu<double>;
extern template class DenseLu<Complex>;
extern template class ColumnSpan<double>;
extern template class ColumnSpan<Complex>;

}  // namespace whirl::la
