// Measured orders of every scheme on nonlinear problems with M(q), gyroscopic terms, prescribed
// motion and massless rows.
#include "toys.hpp"
#include <gtest/gtest.h>
#include <cmath>

namespace whirl::time::test {
namespace {

struct Scheme {
  const char* name;
  double order;
};
constexpr Scheme schemes[] = {
    {"radau5", 5}, {"gauss4", 4}, {"gauss6", 6}, {"generalized_alpha", 2}};

/// Slope of log(error) over log(steps) between the two finest of three runs; errors(n) runs with n
/// equal steps.
double slope(const std::function<double(int)>& error, int n) {
  return std::log2(error(n) / error(2 * n));
}

Options fixed(double dt) {
  Options o;
  o.dt_fixed = dt;
  o.tolerance = 1e-10;  // Newton converges far below the errors measured
  o.max_newton = 30;
  return o;
}

/// Steps per unit of time at which the schemes are in their asymptotic range and above round-off.
int steps(const Scheme& s, int radau, int gauss4, int gauss6, int alpha) {
  const std::string_view n = s.name;
  return n == "radau5" ? radau : n == "gauss4" ? gauss4 : n == "gauss6" ? gauss6 : alpha;
}

TEST(Order, DoublePendulum) {
  DoublePendulum exact(9.81, 0.1);
  VecX y0(4);
  y0 << 1.0, 0.5, 0.0, 0.3;
  const VecX y = reference([&](double, const VecX& x) { return exact.rate(x); }, 0.0, 1.0, y0, 200);
  for (const Scheme& s : schemes) {
    auto error = [&](int n) {
      DoublePendulum p(9.81, 0.1);
      auto integrator = make_integrator(s.name, p, fixed(1.0 / n));
      integrator->start(0.0, y0.head(2), y0.tail(2));
      EXPECT_EQ(run(*integrator, 1.0), StepStatus::ok);
      EXPECT_EQ(integrator->statistics().accepted, n);
      return (integrator->q() - y.head(2)).norm() + 0.1 * (integrator->v() - y.tail(2)).norm();
    };
    // The next term of the error expansion is O(h) relative: a tenth of an order at these steps.
    EXPECT_NEAR(slope(error, steps(s, 40, 40, 30, 400)), s.order, 0.25) << s.name;
  }
}

TEST(Order, LavalRotorWithFreeSpinAndGyroscopicCoupling) {
  LavalRotor model;
  model.m = 1.0;
  model.e = 0.05;
  model.J = 0.02;
  model.k = 100.0;
  model.c = 0.3;
  model.b = 2.0;
  model.torque = 0.5;
  VecX y0(6);
  y0 << 0.02, -0.01, 0.3, 0.1, 0.2, 12.0;
  const VecX y = reference([&](double, const VecX& x) { return model.rate(x); }, 0.0, 1.0, y0, 400);
  for (const Scheme& s : schemes) {
    auto error = [&](int n) {
      LavalRotor p = model;
      auto integrator = make_integrator(s.name, p, fixed(1.0 / n));
      integrator->start(0.0, y0.head(3), y0.tail(3));
      EXPECT_EQ(run(*integrator, 1.0), StepStatus::ok);
      VecX q = integrator->q();
      q[2] = p.phi(q);
      return (q - y.head(3)).norm() + 0.1 * (integrator->v() - y.tail(3)).norm();
    };
    EXPECT_NEAR(slope(error, steps(s, 100, 100, 60, 800)), s.order, 0.25) << s.name;
  }
}

TEST(Order, PrescribedMotion) {
  DrivenPendulum model;
  VecX y0(2);
  y0 << 0.8, 0.0;
  const VecX y =
      reference([&](double t, const VecX& x) { return model.rate(t, x); }, 0.0, 2.0, y0, 200);
  for (const Scheme& s : schemes) {
    auto error = [&](int n) {
      DrivenPendulum p;
      auto integrator = make_integrator(s.name, p, fixed(2.0 / n));
      integrator->start(0.0, Vec2(0.0, y0[0]), Vec2(0.0, y0[1]));
      EXPECT_EQ(run(*integrator, 2.0), StepStatus::ok);
      EXPECT_EQ(integrator->q()[0],
                p.amplitude * std::cos(p.w * 2.0));  // the law itself, to the last bit
      EXPECT_EQ(integrator->v()[0], -p.amplitude * p.w * std::sin(p.w * 2.0));
      return std::abs(integrator->q()[1] - y[0]) + 0.2 * std::abs(integrator->v()[1] - y[1]);
    };
    EXPECT_NEAR(slope(error, steps(s, 40, 40, 25, 400)), s.order, 0.3) << s.name;
  }
}

// A mass on a spring in series with a damper and a massless joint: unknowns (mass, joint,
// follower). Joint: first order (c x2' + k x2 = k x1); follower: algebraic (x3 = x1 + x2, no C, no
// M).
LinearProblem maxwell() {
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
  return LinearProblem(
      {Kind::displacement, Kind::displacement, Kind::internal}, M, C, K,
      [](double t, Ref f) { f[0] = std::cos(2.0 * t); }, false);
}

TEST(Order, MasslessUnknowns) {
  VecX y0(3);
  y0 << 0.1, 0.05, 0.0;  // mass, joint, velocity of the mass
  const VecX y = reference(
      [](double t, const VecX& x) {
        VecX dy(3);
        dy << x[2], (20.0 * x[0] - 20.0 * x[1]) / 5.0,
            std::cos(2.0 * t) - 30.0 * x[0] + 20.0 * x[1];
        return dy;
      },
      0.0, 2.0, y0, 200);
  for (const Scheme& s : schemes) {
    auto error = [&](int n) {
      auto p = maxwell();
      auto integrator = make_integrator(s.name, p, fixed(2.0 / n));
      // the follower's start value and the joint's rate are wrong on purpose: start() finds them
      integrator->start(0.0, Vec3(y0[0], y0[1], 7.0), Vec3(0.0, 123.0, 0.0));
      EXPECT_NEAR(integrator->q()[2], 0.15, 1e-12);
      EXPECT_NEAR(integrator->v()[1], 0.2, 1e-9);
      EXPECT_EQ(run(*integrator, 2.0), StepStatus::ok);
      // Radau and generalized-alpha satisfy algebraic rows at every step's end, Gauss only to its
      // stage order
      if (std::string_view(s.name).starts_with("gauss")) {
        EXPECT_NEAR(integrator->q()[2], y[0] + y[1], 1e-4);
      } else {
        EXPECT_NEAR(integrator->q()[2], integrator->q()[0] + integrator->q()[1], 1e-13);
      }
      return std::abs(integrator->q()[0] - y[0]) + std::abs(integrator->q()[1] - y[1]);
    };
    EXPECT_NEAR(slope(error, steps(s, 30, 30, 15, 400)), s.order, 0.3) << s.name;
  }
}

// A change of step must not cost generalized-alpha its second order, nor disturb the others:
// alternating steps h, 2h.
TEST(Order, UnequalSteps) {
  VecX y0(4);
  y0 << 1.0, 0.5, 0.0, 0.3;
  DoublePendulum exact(9.81, 0.1);
  const VecX y = reference([&](double, const VecX& x) { return exact.rate(x); }, 0.0, 1.0, y0, 200);
  for (const Scheme& s : schemes) {
    auto error = [&](int n) {
      DoublePendulum p(9.81, 0.1);
      Options o = fixed(1.0);
      auto integrator = make_integrator(s.name, p, o);
      integrator->start(0.0, y0.head(2), y0.tail(2));
      for (int k = 1; k <= n; ++k) {
        // ends chosen one by one: the step lands on each
        const double t = (k / 2 * 3 + k % 2) / (1.5 * n);
        EXPECT_EQ(run(*integrator, k == n ? 1.0 : t), StepStatus::ok);
      }
      EXPECT_EQ(integrator->statistics().accepted, n);
      return (integrator->q() - y.head(2)).norm() + 0.1 * (integrator->v() - y.tail(2)).norm();
    };
    EXPECT_NEAR(slope(error, steps(s, 40, 60, 60, 600)), s.order, 0.3) << s.name;
  }
}

}  // namespace
}  // namespace whirl::time::test
