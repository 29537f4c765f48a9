#include "fixtures.hpp"
#include <gtest/gtest.h>

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
  for (Index i = 0; i < 4; ++i) EXPECT_EQ(p.diagonal(i), p.slot(i, i));
  EXPECT_FALSE(p.is_tridiagonal());
}

TEST(BlockPattern, KnowsAChain) {
  EXPECT_TRUE(BlockPattern(5, chain(5)).is_tridiagonal());
  EXPECT_TRUE(BlockPattern(5, {{3, 4}, {1, 0}}).is_tridiagonal());  // two chains and a loose node
  EXPECT_FALSE(BlockPattern(5, {{0, 4}}).is_tridiagonal());
  EXPECT_TRUE(BlockPattern(1, {}).is_tridiagonal());
  EXPECT_EQ(BlockPattern(0, {}).blocks(), 0);
}

TEST(BlockPattern, RejectsUnknownNodes) { EXPECT_THROW(BlockPattern(2, {{0, 2}}), std::out_of_range); }

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
