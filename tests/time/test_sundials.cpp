// IDA and ARKODE agree with the built-in schemes and with references.
#include "toys.hpp"
#include <core/error.hpp>
#include <core/plugin.hpp>
#include <gtest/gtest.h>
#include <time/first_order.hpp>
#include <cmath>

namespace whirl::time::test {
namespace {

class Sundials : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!Plugin::available("sundials")) GTEST_SKIP() << "built without SUNDIALS";
  }
};

TEST_F(Sundials, IdaKeepsItsTolerance) {
  for (double tolerance : {1e-2, 1e-3, 1e-4}) {
    auto p = oscillator(two_pi);
    Options o;
    o.tolerance = tolerance;
    auto integrator = make_integrator("ida", p, o);
    integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
    EXPECT_EQ(run(*integrator, 10.0), StepStatus::ok);
    EXPECT_LT(std::hypot(integrator->q()[0] - 1.0, integrator->v()[0] / two_pi), 2.5 * tolerance);
    EXPECT_GT(integrator->statistics().accepted, 10);
  }
}

TEST_F(Sundials, IdaOnAFreeSpinThroughResonance) {
  LavalRotor model;
  model.torque = 0.4;
  VecX y = VecX::Zero(6);
  double peak = 0.0, error = 0.0, spin = 0.0;
  LavalRotor p = model;
  Options o;
  o.tolerance = 1e-2;
  auto integrator = make_integrator("ida", p, o);
  integrator->start(0.0, VecX::Zero(3), VecX::Zero(3));
  for (int k = 0; k < 40; ++k) {
    y = reference([&](double, const VecX& x) { return model.rate(x); }, 0.0, 0.1, y, 20);
    EXPECT_EQ(run(*integrator, 0.1 * (k + 1)), StepStatus::ok);
    peak = std::max(peak, y.head(2).norm());
    error = std::max(error, (integrator->q().head(2) - y.head(2)).norm());
    spin = std::max(spin, std::abs(p.phi(integrator->q()) - y[2]));
  }
  EXPECT_LT(error, 0.015 * peak);
  EXPECT_LT(spin, 1e-2);  // absolute, after 320 rad
  EXPECT_GT(p.turns, 40.0);
}

TEST_F(Sundials, IdaPrescribedMotionBreakpointsAndInterpolation) {
  DrivenPendulum p;
  Options o;
  o.tolerance = 1e-4;
  o.breakpoints = {0.7};
  auto integrator = make_integrator("ida", p, o);
  integrator->start(0.0, Vec2(0.0, 0.8), Vec2::Zero());
  integrator->set_end(2.0);
  VecX y = Vec2(0.8, 0.0), q(2), v(2), a(2);
  double t = 0.0;
  bool hit = false;
  while (integrator->time() < 2.0) {
    const StepReport s = integrator->advance();
    ASSERT_TRUE(s.ok());
    hit = hit || (s.at_breakpoint && s.t1 == 0.7);
    if (integrator->statistics().accepted % 200) continue;
    const double middle = 0.5 * (s.t0 + s.t1);
    y = reference([&](double time, const VecX& x) { return p.rate(time, x); }, t, middle, y, 10);
    t = middle;
    integrator->interpolate(middle, q, v, a);
    EXPECT_NEAR(q[1], y[0], 2e-4);
    EXPECT_NEAR(v[1], y[1], 2e-3);
    EXPECT_EQ(q[0], p.amplitude * std::cos(p.w * middle));
  }
  EXPECT_TRUE(hit);
}

TEST_F(Sundials, IdaEndsAStepWhereItIsTold) {
  auto p = oscillator(two_pi);
  Options o;
  o.tolerance = 1e-6;
  auto integrator = make_integrator("ida", p, o);
  integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
  while (integrator->time() < 0.2)
    ASSERT_TRUE(integrator->advance().ok());
  const StepReport step = integrator->advance();
  const double t = step.t0 + 0.3 * (step.t1 - step.t0);
  VecX q(1), v(1), a(1);
  integrator->interpolate(t, q, v, a);
  ASSERT_TRUE(integrator->shorten_to(t).ok());
  EXPECT_EQ(integrator->q()[0], q[0]);
  EXPECT_EQ(integrator->v()[0], v[0]);
  EXPECT_NEAR(integrator->v()[0], -two_pi * std::sin(two_pi * t), 1e-4);
}

TEST_F(Sundials, IdaMasslessUnknowns) {
  // as in the order tests: mass, first-order joint, algebraic follower
  MatX M = MatX::Zero(3, 3), C = M, K = M;
  M(0, 0) = 1.0;
  K(0, 0) = 30.0;
  K(0, 1) = -20.0;
  C(1, 1) = 5.0;
  K(1, 1) = 20.0;
  K(1, 0) = -20.0;
  K(2, 0) = -1.0;
  K(2, 1) = -1.0;
  K(2, 2) = 1.0;
  auto make = [&] {
    return LinearProblem(
        {Kind::displacement, Kind::displacement, Kind::internal}, M, C, K,
        [](double t, Ref f) { f[0] = std::cos(2.0 * t); }, false);
  };
  Options o;
  o.tolerance = 1e-4;
  auto p = make(), p2 = make();
  auto ida = make_integrator("ida", p, o);
  auto radau = make_integrator("radau5", p2, o);
  for (auto* i : {&ida, &radau}) {
    (*i)->start(0.0, Vec3(0.1, 0.05, 0.15), Vec3::Zero());
    EXPECT_EQ(run(**i, 2.0), StepStatus::ok);
  }
  EXPECT_NEAR((ida->q() - radau->q()).norm(), 0.0, 1e-4);
}

TEST_F(Sundials, IdaReportsAndRefuses) {
  auto p = oscillator(1.0);
  Options o;
  o.dt_fixed = 0.1;
  EXPECT_THROW(make_integrator("ida", p, o), Error);
  // a state the model refuses
  class Wall final : public DenseProblem {
   public:
    Wall() : DenseProblem(all(1)) { M.setOnes(); }
    bool residual(double, CRef q, CRef, CRef a, Ref r) override {
      r[0] = a[0];
      return q[0] < 1.0;
    }
    void tangent(double, CRef, CRef, CRef) override {}
  } wall;
  auto integrator = make_integrator("ida", wall, Options{});
  integrator->start(0.0, VecX::Zero(1), VecX::Ones(1));
  integrator->set_end(2.0);
  StepReport s;
  do
    s = integrator->advance();
  while (s.ok());
  EXPECT_EQ(s.status, StepStatus::domain);
  EXPECT_LT(integrator->q()[0], 1.0);
}

/// The Laval rotor as y' = F(t, y).
class LavalRates final : public FirstOrderProblem {
 public:
  LavalRotor model;
  Index size() const override { return 6; }
  bool rate(double, CRef y, Ref dy) override {
    dy = model.rate(y);
    return true;
  }
  double scale(Index i) const override { return i == 2 ? 1.0 : i < 2 ? 1e-2 : 1.0; }
  bool is_unbounded(Index i) const override { return i == 2; }
};

TEST_F(Sundials, ExplicitRungeKuttaAgrees) {
  LavalRates p;
  p.model.torque = 0.4;
  VecX y0(6);
  y0 << 1e-3, 0.0, 0.2, 0.0, 0.0, 50.0;
  const VecX y =
      reference([&](double, const VecX& x) { return p.model.rate(x); }, 0.0, 1.0, y0, 400);
  for (int order : {3, 4, 5, 8}) {
    Options o;
    o.tolerance = order == 3 ? 1e-7 : 1e-10;
    o.t_end = 1.0;
    o.breakpoints = {0.25};
    auto erk = make_explicit_integrator(p, o, order);
    erk->start(0.0, y0);
    bool hit = false;
    while (erk->time() < 1.0) {
      const StepReport s = erk->advance();
      ASSERT_TRUE(s.ok());
      hit = hit || s.t1 == 0.25;
    }
    EXPECT_TRUE(hit);
    EXPECT_EQ(erk->time(), 1.0);
    EXPECT_EQ(erk->advance().status, StepStatus::finished);
    // local errors of the tolerance in scale units, a few hundred to thousand steps
    EXPECT_NEAR((erk->y() - y).cwiseAbs().maxCoeff(), 0.0, 1e3 * o.tolerance) << order;
  }
}

TEST_F(Sundials, ExplicitRungeKuttaOrder) {
  LavalRates p;
  p.model.e = 0.05;
  p.model.k = 100.0;
  p.model.torque = 0.5;
  VecX y0(6);
  y0 << 0.02, -0.01, 0.3, 0.1, 0.2, 12.0;
  const VecX y =
      reference([&](double, const VecX& x) { return p.model.rate(x); }, 0.0, 1.0, y0, 400);
  for (int order : {4, 5, 8}) {
    auto error = [&](int n) {
      Options o;
      o.dt_fixed = 1.0 / n;
      o.t_end = 1.0;
      auto erk = make_explicit_integrator(p, o, order);
      erk->start(0.0, y0);
      while (erk->time() < 1.0)
        EXPECT_TRUE(erk->advance().ok());
      return (erk->y() - y).norm();
    };
    const int n = order == 8 ? 20 : 150;
    EXPECT_NEAR(std::log2(error(n) / error(2 * n)), order, 0.6) << order;
  }
}

TEST_F(Sundials, ExplicitInterpolation) {
  LavalRates p;
  VecX y0(6);
  y0 << 1e-3, 0.0, 0.2, 0.0, 0.0, 50.0;
  Options o;
  o.tolerance = 1e-9;
  auto erk = make_explicit_integrator(p, o, 5);
  erk->start(0.0, y0);
  VecX middle(6);
  for (int k = 0; k < 50; ++k) {
    const StepReport s = erk->advance();
    ASSERT_TRUE(s.ok());
    if (k % 10) continue;
    const double t = 0.4 * s.t0 + 0.6 * s.t1;
    erk->interpolate(t, middle);
    const VecX y =
        reference([&](double, const VecX& x) { return p.model.rate(x); }, 0.0, t, y0, 100);
    EXPECT_NEAR((middle - y).cwiseAbs().maxCoeff(), 0.0, 1e-6);
    erk->interpolate(s.t1, middle);
    EXPECT_EQ(middle, erk->y());
  }
}

TEST(WithoutPlugin, TheBuiltInSchemesLoadNone) {
  auto p = oscillator(1.0);
  const bool before = Plugin::loaded("sundials");
  for (const char* name : {"radau5", "gauss4", "gauss6", "generalized_alpha"})
    make_integrator(name, p, {});
  EXPECT_EQ(Plugin::loaded("sundials"), before);
}

}  // namespace
}  // namespace whirl::time::test
