// Arnoldi's method with a locked (already known) invariant subspace, deflation of dependent
// vectors, and restart from a fresh random vector when a Krylov space is exhausted.
#pragma once
#include <core/contract.hpp>
#include <core/types.hpp>
#include <random>

namespace whirl::la {

/// Orthonormal basis V = [locked | searched] and, over the searched part, H = V^H Op V of the
/// processed vectors.
template <class Scalar>
class Krylov {
 public:
  using Vec = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
  using Mat = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /// Forgets everything. dim: length of the vectors.
  void reset(Index dim, unsigned seed) {
    WHIRL_EXPECTS(dim >= 0);
    dim_ = dim;
    locked_ = size_ = next_ = 0;
    rng_.seed(seed);
    if (basis_.rows() != dim || basis_.cols() == 0) basis_.resize(dim, std::min<Index>(dim, 32));
    work_.resize(dim);
  }
  /// Adds a vector to the locked part; false when it depends on the ones already there. Only before
  /// a search.
  bool lock(const Vec& v) {
    WHIRL_EXPECTS(v.size() == dim_ && size_ == locked_);
    if (!append(v, 1e-7)) return false;
    locked_ = next_ = size_;
    return true;
  }

  /// Adds a random vector to the search; false when the whole space is spanned.
  bool inject() {
    for (int tries = 0; tries < 5 && size_ < dim_; ++tries) {
      Vec v(dim_);
      for (Index i = 0; i < dim_; ++i)
        v(i) = static_cast<double>(rng_() >> 11) * 0x1p-52 - 1.0;
      if (append(v, 1e-8)) return true;
    }
    return false;
  }

  /// Applies op(in, out) to the next basis vector; a fresh random vector is taken when none is
  /// left. False: the space is exhausted.
  template <class Op>
  bool step(Op&& op) {
    if (next_ == size_ && !inject()) return false;
    if (searched() + 2 > h_.rows()) {
      const Index n = std::max<Index>(32, 2 * h_.rows());
      h_.conservativeResize(n, n);
    }
    op(basis_.col(next_), work_);
    const double before = work_.norm();
    orthogonalize();
    const double after = work_.norm();
    const Index j = next_ - locked_;
    h_.col(j).setZero();
    h_.col(j).head(searched()) = coefficients_.tail(searched());
    ++next_;
    if (after > 1e-13 * before && size_ < dim_) {
      // Rows beyond the processed columns start at zero for every earlier column.
      h_.row(searched()).head(processed()).setZero();
      h_(searched(), j) = after;
      grow();
      basis_.col(size_++) = work_ / after;
    }
    return true;
  }

  Index dimension() const { return dim_; }
  Index locked() const { return locked_; }
  Index processed() const { return next_ - locked_; }
  Index searched() const { return size_ - locked_; }
  /// H over the processed vectors (square).
  auto projected() const { return h_.topLeftCorner(processed(), processed()); }
  /// Rows of H below it: norm of (rest * y) is the residual of a Ritz pair with H y = theta y.
  auto rest() const { return h_.block(processed(), 0, searched() - processed(), processed()); }
  auto searched_basis() const { return basis_.middleCols(locked_, processed()); }

 private:
  void grow() {
    if (size_ + 1 > basis_.cols())
      basis_.conservativeResize(dim_, std::min(dim_, 2 * basis_.cols()));
  }
  /// work_ -= V V^H work_, twice when needed (Daniel, Gragg, Kaufman & Stewart); coefficients_ =
  /// the sum of both.
  void orthogonalize() {
    const auto v = basis_.leftCols(size_);
    const double before = work_.norm();
    coefficients_.noalias() = v.adjoint() * work_;
    work_.noalias() -= v * coefficients_;
    double last = before;
    for (int pass = 0; pass < 2 && !(work_.norm() > 0.7 * last); ++pass) {
      last = work_.norm();
      correction_.noalias() = v.adjoint() * work_;
      work_.noalias() -= v * correction_;
      coefficients_ += correction_;
    }
  }
  bool append(const Vec& v, double threshold) {
    if (size_ >= dim_) return false;
    work_ = v;
    const double before = work_.norm();
    if (!(before > 0.0)) return false;
    orthogonalize();
    const double after = work_.norm();
    if (!(after > threshold * before)) return false;
    grow();
    if (searched() < h_.rows()) h_.row(searched()).setZero();
    basis_.col(size_++) = work_ / after;
    return true;
  }

  Index dim_ = 0, locked_ = 0, size_ = 0, next_ = 0;
  Mat basis_, h_;
  Vec work_, coefficients_, correction_;
  std::mt19937_64 rng_;
};

}  // namespace whirl::la
