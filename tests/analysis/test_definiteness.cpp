// Negative directions of tangents: against dense eigenvalues, and of columns beyond their buckling
// loads.
#include <la/dense.hpp>
#include "rotors.hpp"

#include <analysis/statics/definiteness.hpp>
#include <analysis/statics/equilibrium.hpp>

#include <gtest/gtest.h>

#include <random>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::tests;

namespace {

MatX dense(const la::BlockMatrix<6>& K, std::span<const unsigned char> free) {
  const la::BlockPattern& p = K.pattern();
  MatX out = MatX::Zero(6 * p.size(), 6 * p.size());
  for (Index i = 0; i < p.size(); ++i)
    for (Index b = p.row_start()[static_cast<std::size_t>(i)];
         b < p.row_start()[static_cast<std::size_t>(i + 1)]; ++b)
      out.block<6, 6>(6 * i, 6 * p.cols()[static_cast<std::size_t>(b)]) = K.block(b);
  std::vector<Index> keep;
  for (Index k = 0; k < out.rows(); ++k)
    if (free[static_cast<std::size_t>(k)]) keep.push_back(k);
  return out(keep, keep);
}

system::System chain(Index elements, double thrust = 0.0) {
  Rotor r;
  r.add_shaft(constants(1e9, 0, 1500, 2000, 1), 1.5, static_cast<int>(elements))
      .pin(0, true)
      .pin(1.5);
  r.b.hold(r.at(0), 3);
  if (thrust != 0.0)
    r.b.add(elements::FixedLoad{Vec3(-thrust, 0, 0), Vec3::Zero(), 0, nullptr}, {r.at(1.5)},
            "thrust");
  return r.b.finalize();
}

}  // namespace

TEST(Definiteness, CountsAsDenseEigenvaluesDo) {
  const system::System s = chain(5);
  std::mt19937 rng(5);
  std::normal_distribution<double> normal;
  int unsymmetric_negative = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const bool symmetric = trial % 2 == 0;
    la::BlockMatrix<6> K(s.pattern());
    for (std::size_t k = 0; k < K.value_count(); ++k)
      K.data()[k] = normal(rng);
    const double shift = 3.0 * std::abs(normal(rng));
    for (Index i = 0; i < s.nodes(); ++i) {
      if (symmetric)
        for (Index j : {i, std::min<Index>(i + 1, s.nodes() - 1)}) {
          const Matrix<6> mean =
              0.5 * (K.block(s.pattern().slot(i, j)) + K.block(s.pattern().slot(j, i)).transpose());
          K.block(s.pattern().slot(i, j)) = mean;
          K.block(s.pattern().slot(j, i)) = mean.transpose();
        }
      K.block(s.pattern().diagonal(i)).diagonal().array() += shift;
    }
    const MatX D = dense(K, s.active());
    const Definiteness d = judge_tangent(K, s.active(), s, 1.5);
    EXPECT_EQ(d.symmetric, symmetric);
    if (symmetric) {
      const la::SymmetricEigenpairs eigen = la::symmetric_eigenpairs(D);
      EXPECT_EQ(d.negative, (eigen.values.array() < 0).count()) << trial;
      EXPECT_TRUE(d.certain);
      if (d.negative > 0) {
        // the shape belongs to a negative energy, and none is lower in its metric
        VecX Kx = VecX::Zero(s.size());
        K.add_multiply(1.0, d.shape, Kx);
        double metric = 0;
        for (Index k = 0; k < s.size(); ++k)
          metric += (k % 6 < 3 ? 1.0 : 0.0225) * d.shape[k] * d.shape[k];
        EXPECT_NEAR(d.shape.dot(Kx) / metric, d.lowest, 1e-6 * std::abs(d.lowest)) << trial;
      }
      continue;
    }
    const VecXc values = la::eigenvalues(D);
    // the number of negative real ones depends on the metric, its parity does not
    const Index negative = (values.array().real() < 0 && values.array().imag() == 0).count();
    EXPECT_EQ(d.sign < 0, negative % 2 != 0) << trial;
    EXPECT_EQ(d.negative % 2, negative % 2) << trial;
    unsymmetric_negative += negative > 0;
  }
  EXPECT_GT(unsymmetric_negative, 20);
}

TEST(Definiteness, WhatCannotBeFactoredIsNotProved) {
  // Elimination makes numbers beyond what a double holds of this K, at every shift that is tried.
  const system::System s = chain(5);
  la::BlockMatrix<6> K(s.pattern());
  K.set_zero();
  for (Index i = 0; i < s.nodes(); ++i)
    K.block(s.pattern().diagonal(i)).diagonal().setConstant(i == 2 || i == 3 ? 0.0 : 1e290);
  K.block(s.pattern().slot(2, 3)) = 1e290 * Matrix<6>::Identity();
  K.block(s.pattern().slot(3, 2)) = 1e290 * Matrix<6>::Identity();
  const Definiteness d = judge_tangent(K, s.active(), s, 1.5);
  EXPECT_TRUE(d.symmetric);
  EXPECT_FALSE(d.certain);
}

TEST(Definiteness, ColumnBeyondItsLoads) {
  // pinned column: each Euler load k^2 pi^2 EI/L^2 makes two more directions, one a plane
  const double euler = pi * pi * 2000 / (1.5 * 1.5);
  for (const auto& [load, expected] :
       {std::pair{0.99, 0}, {1.01, 2}, {3.9, 2}, {4.1, 4}, {9.2, 6}}) {
    const system::System s = chain(16, load * euler);
    SteadyRotation still;
    still.ratio.assign(static_cast<std::size_t>(s.lines()), 0.0);
    SteadySystem running(s, still);
    EquilibriumSolver solver(running);
    const Equilibrium e = solver.solve(0.0);
    la::MCK m = s.make_matrices();
    running.tangent(e.state.frames, 0.0, e.state.q, m);
    const Definiteness d = judge_tangent(m.K, solver.free(), s, solver.length());
    EXPECT_TRUE(d.symmetric);
    EXPECT_EQ(d.negative, expected) << load;
  }
}

TEST(Definiteness, FreeMotionIsNotUnstable) {
  // nothing resists axial motion and spin of this shaft: indifferent, at any number of elements
  for (const int n : {1, 7, 60, 400}) {
    Rotor r;
    r.add_shaft(constants(1e9, 0, 1500, 2000, 1), 1.5, n).pin(0, false).pin(1.5);
    const system::System s = r.b.finalize();
    SteadyRotation still;
    SteadySystem running(s, still);
    la::MCK m = s.make_matrices();
    const system::State rest = s.make_state();
    running.tangent(rest.frames, 0.0, rest.q, m);
    EXPECT_EQ(judge_tangent(m.K, s.active(), s, 1.5).negative, 0) << n;
  }
}
