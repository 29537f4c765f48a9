#include "fixtures.hpp"
#include <gtest/gtest.h>
#include <la/multiply.hpp>
#include <la/step_products.hpp>

using namespace whirl;
using namespace whirl::la;
using namespace whirl::la::test;

TEST(BlockPattern, SortsMergesAndMirrorsCouplings) {
  const BlockPattern p(4, {{2, 0}, {0, 2}, {3, 3}, {1, 0}});
  EXPECT_EQ(p.blocks(), 4 + 2 * 2);
  EXPECT_EQ(p.row_start(), (std::vector<Index>{0, 3, 5, 7, 8}));
  EXPECT_EQ(p.cols(), (std::vector<Index>{0, 1, 2, 0, 1, 0, 2, 3}));
  EXPECT_EQ(p.slot(0, 2), 2);
  EXPECT_EQ(p.slot(2, 0), 5);
  EXPECT_EQ(p.slot(1, 2), -1);
  EXPECT_EQ(p.slot(4, 0), -1);
  for (Index i = 0; i < 4; ++i)
    EXPECT_EQ(p.diagonal(i), p.slot(i, i));
  EXPECT_FALSE(p.is_tridiagonal());
}

TEST(BlockPattern, KnowsAChain) {
  EXPECT_TRUE(BlockPattern(5, chain(5)).is_tridiagonal());
  EXPECT_TRUE(BlockPattern(5, {{3, 4}, {1, 0}}).is_tridiagonal());  // two chains and a loose node
  EXPECT_FALSE(BlockPattern(5, {{0, 4}}).is_tridiagonal());
  EXPECT_TRUE(BlockPattern(1, {}).is_tridiagonal());
  EXPECT_EQ(BlockPattern(0, {}).blocks(), 0);
}

TEST(BlockPattern, RejectsUnknownNodes) {
  EXPECT_THROW(BlockPattern(2, {{0, 2}}), std::out_of_range);
}

TEST(BlockMatrix, MultipliesAsItsDenseForm) {
  std::mt19937 rng(1);
  const BlockPattern p(7, random_graph(7, 5, rng));
  const MCK m = random_matrices(p, 0.0, rng);
  const VecX x = VecX::Random(42);
  VecX y = VecX::Random(42);
  const VecX expected = y - 2.5 * dense(m.K) * x;
  m.K.add_multiply(-2.5, x, y);
  EXPECT_LT((y - expected).norm(), 1e-13 * expected.norm());  // 42 products a row
  const VecXc xc = VecXc::Random(42);
  VecXc yc = VecXc::Zero(42);
  m.M.add_multiply(1.0, xc, yc);
  EXPECT_LT((yc - dense(m.M) * xc).norm(), 1e-13 * yc.norm());
}

TEST(Multiply, MatchesDense) {
  std::mt19937 rng(6);
  const BlockPattern p(9, random_graph(9, 4, rng));
  const MCK m = random_matrices(p, 0.0, rng);
  const VecX x = VecX::Random(54);
  const VecXc z = VecXc::Random(54);
  VecX y(54);
  VecXc w(54), a(54), b(54), c(54);
  multiply(m.K, x, y);
  multiply(m.K, z, w);
  multiply(m, z, a, b, c);
  const MatX k = dense(m.K);
  EXPECT_LT((y - k * x).norm(), 1e-14 * y.norm());
  EXPECT_LT((w - k * z).norm(), 1e-14 * w.norm());
  EXPECT_LT((a - dense(m.M) * z).norm(), 1e-14 * a.norm());
  EXPECT_LT((b - dense(m.C) * z).norm(), 1e-14 * b.norm());
  EXPECT_LT((c - k * z).norm(), 1e-14 * c.norm());
  y.setOnes();
  add_multiply_size(m.K, 2.5, x, y);
  EXPECT_LT((y - VecX::Ones(54) - 2.5 * k.cwiseAbs() * x).norm(), 1e-14 * y.norm());
  y.setOnes();
  add_multiply(m.K, -2.5, x, y);
  EXPECT_LT((y - VecX::Ones(54) + 2.5 * k * x).norm(), 1e-14 * y.norm());
  const VecX v = VecX::Random(54), acceleration = VecX::Random(54);
  const VecX two = VecX::Ones(54) + k * x + dense(m.C) * v;
  const VecX three = two + dense(m.M) * acceleration;
  y.setOnes();
  add_forces(m, x, v, y);
  EXPECT_LT((y - two).norm(), 1e-14 * y.norm());
  y.setOnes();
  add_forces(m, x, v, acceleration, y);
  EXPECT_LT((y - three).norm(), 1e-14 * y.norm());

  const VecX stiff_of = VecX::Random(54), inertia_of = VecX::Random(54),
             filter_of = VecX::Random(54);
  VecX bound(54), rate(54), stiff(54), inertia(54), filter(54);
  constexpr double shift = 3.5;
  multiply(m, {x, v, stiff_of, inertia_of, filter_of, shift, bound, rate, stiff, inertia, filter});
  EXPECT_LT((bound - k * x - dense(m.C) * v).norm(), 1e-14 * bound.norm());
  EXPECT_LT((rate - k * v).norm(), 1e-14 * rate.norm());
  EXPECT_LT((stiff - k * stiff_of).norm(), 1e-14 * stiff.norm());
  EXPECT_LT((inertia - dense(m.M) * inertia_of).norm(), 1e-14 * inertia.norm());
  EXPECT_LT((filter - (shift * dense(m.M) + dense(m.C)) * filter_of).norm(), 1e-14 * filter.norm());
}

TEST(Multiply, ExactSumsSurviveCancellation) {
  // Rows whose terms cancel to 1e-12 of their size: plain sums keep four digits, these all of them
  // (long double as reference).
  std::mt19937 rng(8);
  const BlockPattern p(12, chain(12));
  MCK m = random_matrices(p, 0.0, rng);
  const VecXc z = VecXc::Random(72);
  const VecX x = z.real();
  for (Index i = 0; i < 12; ++i) {
    auto d = m.K.block(p.diagonal(i));
    VecX y = VecX::Zero(72);
    m.K.add_multiply(1.0, x, y);
    for (int r = 0; r < 6; ++r)
      d(r, 0) -= y(6 * i + r) / x(6 * i) * (1.0 - 1e-12);
  }
  VecXc w(72), plain(72);
  multiply_exact(m.K, z, w);
  multiply(m.K, z, plain);
  const MatX k = dense(m.K);
  double worst = 0.0, worst_plain = 0.0;
  for (Index r = 0; r < 72; ++r) {
    long double s = 0.0L, size = 0.0L;
    for (Index c = 0; c < 72; ++c) {
      s += static_cast<long double>(k(r, c)) * x(c);
      size += std::abs(static_cast<long double>(k(r, c)) * x(c));
    }
    worst = std::max(worst, static_cast<double>(std::abs(s - w(r).real()) / size));
    worst_plain = std::max(worst_plain, static_cast<double>(std::abs(s - plain(r).real()) / size));
    EXPECT_NEAR(static_cast<double>(s), w(r).real(),
                1e-18 * static_cast<double>(size) + 1e-15 * std::abs(w(r).real()));
  }
  VecX real(72);
  multiply_exact(m.K, x, real);
  EXPECT_EQ(real, w.real());
  EXPECT_GT(worst_plain, 20.0 * worst);  // the reference itself is good to 1e-19
}
