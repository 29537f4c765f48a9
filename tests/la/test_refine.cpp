#include "fixtures.hpp"
#include <gtest/gtest.h>
#include <la/refine.hpp>

using namespace whirl;
using namespace whirl::la;
using namespace whirl::la::test;

TEST(Refinement, BackwardErrorIsTheRelativeChangeOfOneEntry) {
  std::mt19937 rng(2);
  const BlockPattern p(5, chain(5));
  const MCK m = random_matrices(p, 10.0, rng);
  const Mask active = random_mask(p, 0.2, rng);
  const auto solver = make_direct_solver<Complex>(p, active);
  const Complex cm(0.3, 0.1), cc(-0.2, 0.7), ck(1.0, 0.0);
  ASSERT_EQ(solver->factor(m, cm, cc, ck), Status::ok);
  const VecXc b = VecXc::Random(30);
  VecXc x = b;
  solver->solve(x);
  Refinement<Complex> refinement(p, active);
  EXPECT_LT(refinement.backward_error(m, cm, cc, ck, x, b),
            1e-14);  // diagonally dominant, 30 unknowns
  const MatXc s = dense<Complex>(m, active, cm, cc, ck);
  Index u = 7;
  while (!active[static_cast<std::size_t>(u)])
    ++u;
  x(u) *= 1.0 + 1e-6;
  const VecXc r = b - s * x;
  const double expected =
      (r.cwiseAbs().array() / (s.cwiseAbs() * x.cwiseAbs() + b.cwiseAbs()).array()).maxCoeff();
  EXPECT_NEAR(refinement.backward_error(m, cm, cc, ck, x, b), expected,
              1e-5 * expected);  // residuals of 1e-6 hold 9 digits
  EXPECT_LT((refinement.residual() - r).norm(), 1e-13);
}

TEST(Refinement, RecoversFromAnInaccurateFactorisation) {
  std::mt19937 rng(4);
  const BlockPattern p(20, chain(20));
  MCK m = random_matrices(p, 8.0, rng);
  const Mask active = all_active(p);
  const auto solver = make_direct_solver<double>(p, active);
  ASSERT_EQ(solver->factor(m, 0.0, 0.0, 1.0), Status::ok);
  const MCK old = m;
  for (std::size_t i = 0; i < m.K.value_count(); ++i)
    m.K.data()[i] *= 1.0 + 1e-6 * std::sin(static_cast<double>(i));
  const VecX b = VecX::Random(120);
  VecX x = b;
  solver->solve(x);
  Refinement<double> refinement(p, active);
  EXPECT_GT(refinement.backward_error(m, 0.0, 0.0, 1.0, x, b), 1e-9);
  // Each step gains the six digits the factorisation has right.
  EXPECT_LT(refinement.refine(*solver, m, 0.0, 0.0, 1.0, b, x, 3), 3e-15);
}
