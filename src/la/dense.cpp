#include <la/dense.hpp>
#include <core/contract.hpp>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace whirl::la {

DenseEigenpairs eigenpairs(const MatX& a) {
  WHIRL_EXPECTS(a.rows() == a.cols() && a.allFinite());
  const Eigen::EigenSolver<MatX> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

DenseEigenpairs eigenpairs(const MatXc& a) {
  WHIRL_EXPECTS(a.rows() == a.cols() && a.allFinite());
  const Eigen::ComplexEigenSolver<MatXc> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VecXc eigenvalues(const MatX& a) { return Eigen::EigenSolver<MatX>(a, false).eigenvalues(); }

SymmetricEigenpairs symmetric_eigenpairs(const MatX& a) {
  WHIRL_EXPECTS(a.rows() == a.cols());
  const Eigen::SelfAdjointEigenSolver<MatX> solver(a);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigenpairs symmetric_eigenpairs(const MatX& k, const MatX& m) {
  WHIRL_EXPECTS(k.rows() == k.cols() && m.rows() == k.rows() && m.cols() == k.cols());
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatX> solver(k, m);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

VecX hermitian_eigenvalues(const MatXc& a) {
  WHIRL_EXPECTS(a.rows() == a.cols());
  // [re -im; im re] has them twice: the complex solver would be compiled for this alone
  const Index n = a.rows();
  MatX real(2 * n, 2 * n);
  real << a.real(), -a.imag(), a.imag(), a.real();
  const VecX twice =
      Eigen::SelfAdjointEigenSolver<MatX>(real, Eigen::EigenvaluesOnly).eigenvalues();
  VecX out(n);
  for (Index k = 0; k < n; ++k)
    out[k] = twice[2 * k];
  return out;
}

MatX pseudo_inverse(const MatX& a) {
  if (a.size() == 0) return MatX::Zero(a.cols(), a.rows());
  return a.completeOrthogonalDecomposition().pseudoInverse();
}

MatX least_squares(const MatX& a, const MatX& b) {
  WHIRL_EXPECTS(a.rows() == b.rows());
  return a.completeOrthogonalDecomposition().solve(b);
}
VecXc least_squares(const MatXc& a, const VecXc& b) {
  WHIRL_EXPECTS(a.rows() == b.size());
  return a.completeOrthogonalDecomposition().solve(b);
}

VecXc pivoted_solution(const MatXc& a, const VecXc& b) { return a.colPivHouseholderQr().solve(b); }

std::optional<MatX> pivoted_solution(const MatX& a, const MatX& b, double least) {
  WHIRL_EXPECTS(a.rows() == a.cols() && a.rows() == b.rows());
  const Eigen::ColPivHouseholderQR<MatX> qr(a);
  if (!(qr.maxPivot() > least) || !qr.isInvertible()) return {};
  return qr.solve(b);
}

MatX orthonormal_span(const MatX& a, double threshold) {
  WHIRL_EXPECTS(threshold >= 0.0);
  const Eigen::JacobiSVD<MatX> svd(a, Eigen::ComputeThinU);
  const VecX& size = svd.singularValues();
  Index rank = 0;
  while (rank < size.size() && size[rank] > threshold * size[0])
    ++rank;
  return svd.matrixU().leftCols(rank);
}

template <class Scalar>
struct DenseLu<Scalar>::Factors {
  Eigen::PartialPivLU<Mat> lu;
};

template <class Scalar>
DenseLu<Scalar>::DenseLu() : factors_(std::make_unique<Factors>()) {}
template <class Scalar>
DenseLu<Scalar>::DenseLu(const Mat& a) : DenseLu() {
  factor(a);
}
template <class Scalar>
DenseLu<Scalar>::~DenseLu() = default;
template <class Scalar>
DenseLu<Scalar>::DenseLu(DenseLu&&) noexcept = default;
template <class Scalar>
DenseLu<Scalar>& DenseLu<Scalar>::operator=(DenseLu&&) noexcept = default;

template <class Scalar>
void DenseLu<Scalar>::factor(const Mat& a) {
  WHIRL_EXPECTS(a.rows() == a.cols());
  factors_->lu.compute(a);
}

template <class Scalar>
typename DenseLu<Scalar>::Vec DenseLu<Scalar>::solve(const Vec& b) const {
  WHIRL_EXPECTS(factors_->lu.rows() == b.size());
  return factors_->lu.solve(b);
}

template <class Scalar>
typename DenseLu<Scalar>::Mat DenseLu<Scalar>::solve(const Mat& b) const {
  WHIRL_EXPECTS(factors_->lu.rows() == b.rows());
  return factors_->lu.solve(b);
}

template <class Scalar>
struct ColumnSpan<Scalar>::Factors {
  Mat a;
  Eigen::ColPivHouseholderQR<Mat> qr;
};

template <class Scalar>
ColumnSpan<Scalar>::ColumnSpan(const Mat& a)
    : factors_(std::make_unique<Factors>(Factors{a, Eigen::ColPivHouseholderQR<Mat>(a)})) {}
template <class Scalar>
ColumnSpan<Scalar>::~ColumnSpan() = default;

template <class Scalar>
typename ColumnSpan<Scalar>::Vec ColumnSpan<Scalar>::coordinates(const Vec& x) const {
  WHIRL_EXPECTS(x.size() == factors_->a.rows());
  return factors_->qr.solve(x);
}

template <class Scalar>
typename ColumnSpan<Scalar>::Vec ColumnSpan<Scalar>::outside(const Vec& x) const {
  WHIRL_EXPECTS(x.size() == factors_->a.rows());
  return x - factors_->a * factors_->qr.solve(x);
}

template class DenseLu<double>;
template class DenseLu<Complex>;
template class ColumnSpan<double>;
template class ColumnSpan<Complex>;

}  // namespace whirl::la
