// What one look at the projected matrix of a Krylov space gives.
#pragma once
#include <algorithm>
#include <cmath>
#include <la/dense.hpp>
#include <la/krylov.hpp>
#include <vector>

namespace whirl::la {

/// Ritz values by falling size, with residuals.
struct Ritz {
  std::vector<Complex> theta;
  std::vector<double> residual;
  MatXc y;  ///< eigenvectors of H, in the same order
};

template <class Scalar>
Ritz look(const Krylov<Scalar>& krylov) {
  const Index p = krylov.processed();
  const DenseEigenpairs eig = eigenpairs(typename Krylov<Scalar>::Mat(krylov.projected()));
  std::vector<Index> order(static_cast<std::size_t>(p));
  for (Index j = 0; j < p; ++j)
    order[static_cast<std::size_t>(j)] = j;
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) {
    return std::abs(eig.values(a)) > std::abs(eig.values(b));
  });
  Ritz r;
  r.y.resize(p, p);
  const typename Krylov<Scalar>::Mat rest = krylov.rest();
  for (Index j = 0; j < p; ++j) {
    const Index e = order[static_cast<std::size_t>(j)];
    r.theta.push_back(eig.values(e));
    r.y.col(j) = eig.vectors.col(e) / eig.vectors.col(e).norm();
    r.residual.push_back(rest.rows() == 0 ? 0.0
                                          : (rest.template cast<Complex>() * r.y.col(j)).norm());
  }
  return r;
}

}  // namespace whirl::la
