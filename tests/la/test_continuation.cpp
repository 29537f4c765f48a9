#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>
#include <la/continuation.hpp>

using namespace whirl;
using namespace whirl::la;

namespace {

/// Shallow two-bar arch under a dead load P = mu: rise w0 - q, half span 1, EA = 1 (von Mises).
/// Equilibrium mu = 2 (w0 - q) (1/sqrt(1 + (w0-q)^2) - 1/sqrt(1 + w0^2)), with a linear spring to a
/// second unknown that hangs on it.
struct Arch : ContinuationProblem {
  double w0 = 0.3, hanger = 5.0;
  VecX unit = VecX::Constant(2, 0.3);
  double force(double q) const {
    const double w = w0 - q;
    return 2.0 * w * (1.0 / std::sqrt(1.0 + w * w) - 1.0 / std::sqrt(1.0 + w0 * w0));
  }
  double stiffness(double q) const {
    const double w = w0 - q, l = std::sqrt(1.0 + w * w);
    return -2.0 * (1.0 / l - 1.0 / std::sqrt(1.0 + w0 * w0) - w * w / (l * l * l));
  }
  Mat2 K;
  bool residual(const VecX& q, double mu, VecX& f) override {
    f(0) = force(q(0)) - hanger * (q(1) - q(0));
    f(1) = hanger * (q(1) - q(0)) - mu;
    return true;
  }
  void load(const VecX&, double, VecX& f) override {
    f(0) = 0.0;
    f(1) = -1.0;
  }
  bool factor(const VecX& q, double) override {
    K << stiffness(q(0)) + hanger, -hanger, -hanger, hanger;
    return std::abs(K.determinant()) > 1e-13;
  }
  void solve(VecX& b) override { b = (K.inverse() * b).eval(); }
  const VecX& scale() const override { return unit; }
  double mu_scale() const override { return 0.01; }
};

}  // namespace

TEST(Continuation, FollowsSnapThroughByArcLength) {
  Arch arch;
  VecX q = VecX::Zero(2);
  double mu = 0.0;
  ContinuationOptions o;
  o.max_step = 0.1;
  Continuation c;
  int limits = 0;
  double highest = 0.0, lowest = 0.0;
  const auto result = c.run(arch, q, mu, o, [&](const VecX& x, const ContinuationPoint& p) {
    EXPECT_NEAR(p.mu, arch.force(x(0)), 1e-11);
    EXPECT_NEAR(arch.hanger * (x(1) - x(0)), p.mu, 1e-11);
    limits += p.limit_point;
    if (x(0) < arch.w0) highest = std::max(highest, p.mu);  // beyond, the arch hangs and stiffens
    lowest = std::min(lowest, p.mu);
    return x(0) < 0.8;
  });
  EXPECT_EQ(result.status, ContinuationStatus::stopped);
  EXPECT_EQ(limits, 2);
  // Limit load where stiffness() vanishes: l^3 = sqrt(1 + w0^2).
  const double l0 = std::sqrt(1.0 + 0.09), l = std::cbrt(l0), w = std::sqrt(l * l - 1.0);
  const double limit = 2.0 * w * (1.0 / l - 1.0 / l0);
  EXPECT_LE(highest, limit * (1.0 + 1e-9));
  EXPECT_GT(highest, 0.97 * limit);  // points 0.1 apart straddle the top
  EXPECT_LT(lowest, -0.97 * limit);
}

TEST(Continuation, DisplacementControlAndALastLoad) {
  Arch arch;
  VecX q = VecX::Zero(2);
  double mu = 0.0;
  ContinuationOptions o;
  o.controlled = 0;
  o.first_step = 0.07;
  Continuation c;
  auto result =
      c.run(arch, q, mu, o, [&](const VecX& x, const ContinuationPoint&) { return x(0) < 0.7; });
  EXPECT_EQ(result.status, ContinuationStatus::stopped);
  EXPECT_NEAR(mu, arch.force(q(0)), 1e-11);
  // Load to an exact value on the first branch.
  q.setZero();
  mu = 0.0;
  o = {};
  o.last_mu = 0.005;
  result = c.run(arch, q, mu, o, [](const VecX&, const ContinuationPoint&) { return true; });
  EXPECT_EQ(result.status, ContinuationStatus::finished);
  EXPECT_EQ(mu, 0.005);
  EXPECT_NEAR(arch.force(q(0)), 0.005, 1e-12);
  EXPECT_LT(q(0), 0.15);
}
