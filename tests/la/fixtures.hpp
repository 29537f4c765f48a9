// Random matrices on chains, trees and general graphs, and their dense counterparts.
#pragma once
#include <la/block.hpp>
#include <random>
#include <span>

namespace whirl::la::test {

using Pairs = std::vector<std::pair<Index, Index>>;
using Mask = std::vector<unsigned char>;

inline Pairs chain(Index n) {
  Pairs p;
  for (Index i = 0; i + 1 < n; ++i)
    p.emplace_back(i, i + 1);
  return p;
}

inline Pairs random_tree(Index n, std::mt19937& rng) {
  Pairs p;
  for (Index i = 1; i < n; ++i)
    p.emplace_back(std::uniform_int_distribution<Index>(0, i - 1)(rng), i);
  return p;
}

/// A tree and some more couplings: cycles, hence fill.
inline Pairs random_graph(Index n, Index extra, std::mt19937& rng) {
  Pairs p = random_tree(n, rng);
  std::uniform_int_distribution<Index> any(0, n - 1);
  for (Index k = 0; k < extra; ++k)
    p.emplace_back(any(rng), any(rng));
  return p;
}

inline Mask all_active(const BlockPattern& p) {
  return Mask(static_cast<std::size_t>(6 * p.size()), 1);
}

inline Mask random_mask(const BlockPattern& p, double held, std::mt19937& rng) {
  Mask m = all_active(p);
  std::bernoulli_distribution off(held);
  for (auto& x : m)
    x = off(rng) ? 0 : 1;
  return m;
}

/// Entries uniform in [-1, 1]; `shift` times the identity is added to K's diagonal blocks.
inline MCK random_matrices(const BlockPattern& p, double shift, std::mt19937& rng) {
  MCK m(p);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (BlockMatrix<6>* a : {&m.M, &m.C, &m.K})
    for (std::size_t i = 0; i < a->value_count(); ++i)
      a->data()[i] = u(rng);
  for (Index i = 0; i < p.size(); ++i)
    m.K.block(p.diagonal(i)) += shift * Matrix<6>::Identity();
  return m;
}

inline MatX dense(const BlockMatrix<6>& a) {
  const BlockPattern& p = a.pattern();
  MatX d = MatX::Zero(6 * p.size(), 6 * p.size());
  for (Index i = 0; i < p.size(); ++i)
    for (Index k = p.row_start()[static_cast<std::size_t>(i)];
         k < p.row_start()[static_cast<std::size_t>(i) + 1]; ++k)
      d.block<6, 6>(6 * i, 6 * p.cols()[static_cast<std::size_t>(k)]) = a.block(k);
  return d;
}

template <class Scalar>
Eigen::Matrix<Scalar, -1, -1> dense(const MCK& m, std::span<const unsigned char> active, Scalar cm,
                                    Scalar cc, Scalar ck) {
  Eigen::Matrix<Scalar, -1, -1> s = cm * dense(m.M).cast<Scalar>() +
                                    cc * dense(m.C).cast<Scalar>() + ck * dense(m.K).cast<Scalar>();
  for (Index u = 0; u < s.rows(); ++u)
    if (!active[static_cast<std::size_t>(u)]) {
      s.row(u).setZero();
      s.col(u).setZero();
      s(u, u) = Scalar(1.0);
    }
  return s;
}

}  // namespace whirl::la::test
