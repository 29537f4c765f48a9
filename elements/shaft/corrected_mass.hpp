// A correction of a mass matrix, bounded so that the mass stays positive.
#pragma once
#include <core/types.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>

namespace whirl::elements {

/// mass and as much of a correction as leaves a quarter of it in every direction.
///
/// Corrections of full share only add (timoshenko_matrices.hpp). Rows of different shares leave
/// parts of both signs, which are more than the mass itself where an element is alone between two
/// such nodes, or short.
/// @param mass symmetric, positive semi-definite.
/// @param correction symmetric, zero where the mass is.
template <int N>
Matrix<N> corrected_mass(const Matrix<N>& mass, const Matrix<N>& correction) {
  constexpr double allowed = -0.75, rounding = 1e-12;
  Vector<N> size = mass.diagonal();
  if (!(size.maxCoeff() > 0)) return mass;
  for (double& s : size)
    s = s > 0 ? std::sqrt(s) : 1.0;
  const auto scaled = [&size](const Matrix<N>& m) {
    const Vector<N> inverse = size.cwiseInverse();
    return Matrix<N>(inverse.asDiagonal() * m * inverse.asDiagonal());
  };
  const Eigen::LLT<Matrix<N>> root(scaled(mass) + rounding * Matrix<N>::Identity());
  const Matrix<N> half = root.matrixL().solve(scaled(correction));
  const Matrix<N> relative = root.matrixL().solve(half.transpose().eval());
  const Matrix<N> symmetric = 0.5 * (relative + relative.transpose());
  const double least =
      Eigen::SelfAdjointEigenSolver<Matrix<N>>(symmetric, Eigen::EigenvaluesOnly).eigenvalues()[0];
  return mass + (least < allowed ? allowed / least : 1.0) * correction;
}

}  // namespace whirl::elements
