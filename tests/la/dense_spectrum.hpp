// All eigenvalues of a small quadratic problem by a dense method of its own: the reference of the
// sparse eigensolver and of the root counter.
#pragma once
#include "fixtures.hpp"
#include <la/dense.hpp>
#include <la/eigen.hpp>
#include <la/root_count.hpp>

namespace whirl::la::test {

/// Finite roots, conjugates included, of the unknowns that are not held: 1/(lambda - shift) are the
/// eigenvalues of the linearisation at a shift where Q is regular. Eigenvalues at infinity (no
/// mass) come out as rounding of zero and are left out.
inline std::vector<Complex> dense_spectrum(const MCK& m, const Mask& active, double shift) {
  std::vector<Index> u;
  for (std::size_t i = 0; i < active.size(); ++i)
    if (active[i]) u.push_back(static_cast<Index>(i));
  const MatX M = dense(m.M)(u, u);
  const MatX C = dense(m.C)(u, u);
  const MatX K = dense(m.K)(u, u);
  const Index n = K.rows();
  // Rows and columns scaled alike so that displacements and angles compare.
  const MatX Q = shift * shift * M + shift * C + K;
  VecX scale(n);
  for (Index i = 0; i < n; ++i)
    scale(i) = 1.0 / std::sqrt(std::max(std::abs(Q(i, i)), 1e-300));
  const auto scaled = [&](const MatX& a) {
    return MatX(scale.asDiagonal() * a * scale.asDiagonal());
  };
  const DenseLu<double> lu(scaled(Q));
  MatX op(2 * n, 2 * n);
  const MatX linear = shift * (2.0 * shift * scaled(M) + scaled(C));
  // z = (x, (lambda - shift) x / shift): Q(shift) x + (lambda - shift) Q' x + (lambda - shift)^2 M
  // x = 0.
  op.topLeftCorner(n, n) = -lu.solve(linear);
  op.topRightCorner(n, n) = -lu.solve(MatX(shift * shift * scaled(M)));
  op.bottomLeftCorner(n, n).setIdentity();
  op.bottomRightCorner(n, n).setZero();
  const VecXc theta = eigenvalues(op);
  std::vector<Complex> out;
  for (const Complex t : theta)
    if (std::abs(t) > 1e-10 * theta.cwiseAbs().maxCoeff()) out.push_back(shift + shift / t);
  return out;
}

}  // namespace whirl::la::test
