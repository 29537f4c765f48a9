// Spectral radius of every scheme on q'' + 2 zeta w q' + w^2 q = 0 against theory, numerical
// damping over 1e5 revolutions, and orders that do not collapse on stiff systems.
#include "toys.hpp"
#include <core/error.hpp>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>
#include <time/stability.hpp>
#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::time::test {
namespace {

/// The map (q, v/w) -> one step.
Mat2 one_step(const char* name, double wh, double zeta) {
  Mat2 map;
  for (int k = 0; k < 2; ++k) {
    auto p = oscillator(1.0, zeta);
    Options o;
    o.dt_fixed = wh;
    o.t_end = wh;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, k == 0 ? 1.0 : 0.0),
                      VecX::Constant(1, k == 1 ? 1.0 : 0.0));
    EXPECT_TRUE(integrator->advance().ok());
    map(0, k) = integrator->q()[0];
    map(1, k) = integrator->v()[0];
  }
  return map;
}

TEST(Stability, CollocationIsItsStabilityFunction) {
  for (const char* name : {"radau5", "gauss4", "gauss6"})
    for (double zeta : {0.0, 0.01, 0.3})
      for (double wh : {1e-3, 0.1, 1.0, 3.0, 10.0, 1e3, 1e6}) {
        const Mat2 map = one_step(name, wh, zeta);
        const Complex lambda = wh * Complex(-zeta, std::sqrt(1.0 - zeta * zeta));
        const Complex r = stability_function(name, lambda);
        // Trace and determinant of the map: 2 Re R and |R|^2. h v0 = wh is added to q0 = 1 and
        // removed again.
        EXPECT_NEAR(map.trace(), 2.0 * r.real(), 1e-14 * (10.0 + wh)) << name << " " << wh;
        EXPECT_NEAR(map.determinant(), std::norm(r), 1e-14 * (10.0 + wh)) << name << " " << wh;
      }
}

TEST(Stability, GeneralizedAlphaIsItsAmplificationMatrix) {
  for (double rho : {0.0, 0.5, 0.9, 1.0})
    for (double wh : {0.1, 1.0, 10.0, 1e4}) {
      // M a + K q = 0 with M = 1, K = w^2; state (q, h v, h^2 b, h^2 a)
      const double am = (2 * rho - 1) / (rho + 1), af = rho / (rho + 1), g = 0.5 - am + af,
                   b = 0.25 * (g + 0.5) * (g + 0.5);
      const double k = wh * wh;
      Eigen::Matrix4d left = Eigen::Matrix4d::Zero(), right = left;
      left << 1, 0, -b, 0, 0, 1, -g, 0, 0, 0, 1 - am, -(1 - af), k, 0, 0, 1;
      right << 1, 1, 0.5 - b, 0, 0, 1, 1 - g, 0, 0, 0, -am, af, 0, 0, 0, 0;
      const Eigen::Matrix4d A = left.fullPivLu().solve(right);
      const double radius = A.eigenvalues().cwiseAbs().maxCoeff();
      auto p = oscillator(1.0);
      Options o;
      o.dt_fixed = wh;
      o.rho_inf = rho;
      auto integrator = make_integrator("generalized_alpha", p, o);
      integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
      Eigen::Vector4d x(1.0, 0.0, -k, -k);
      for (int n = 0; n < 50; ++n) {
        EXPECT_TRUE(integrator->advance().ok());
        x = A * x;
        EXPECT_NEAR(integrator->q()[0], x[0], 1e-12 + 1e-15 * k) << rho << " " << wh << " " << n;
      }
      EXPECT_NEAR(mode_response("generalized_alpha", 1.0, 0.0, wh, rho).radius, radius,
                  1e-6);              // double roots: sqrt(1e-16)
      EXPECT_LE(radius, 1.0 + 1e-7);  // double eigenvalues at rho_inf = 1: root of round-off
      if (wh > 1e3 && rho > 0.0) {
        EXPECT_NEAR(radius, rho, 3e-3);  // approached as 1/wh
      }
    }
}

// The damping and the frequency that mode_response() states, against a run.
TEST(Stability, ModeResponseIsWhatARunShows) {
  for (const char* name : {"radau5", "gauss4", "gauss6", "generalized_alpha"})
    for (double zeta : {0.0, 0.02})
      for (double wh : {0.1, 0.7, 1.5}) {
        const ModeResponse m = mode_response(name, 1.0, zeta, wh, 0.8);
        auto p = oscillator(1.0, zeta);
        Options o;
        o.dt_fixed = wh;
        o.rho_inf = 0.8;
        auto integrator = make_integrator(name, p, o);
        integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
        // A complex root r: q_{n+2} - 2 Re r q_{n+1} + |r|^2 q_n = 0, once the spurious root of
        // generalized-alpha is gone.
        for (int n = 0; n < 60; ++n)
          ASSERT_TRUE(integrator->advance().ok());
        std::array<double, 4> q{};
        for (double& x : q) {
          x = integrator->q()[0];
          ASSERT_TRUE(integrator->advance().ok());
        }
        const double det = q[1] * q[1] - q[0] * q[2];
        const double twice_re = (q[1] * q[2] - q[0] * q[3]) / det,
                     modulus2 = (q[2] * q[2] - q[1] * q[3]) / det;
        const double modulus = std::sqrt(modulus2),
                     angle = std::acos(std::clamp(twice_re / (2.0 * modulus), -1.0, 1.0));
        EXPECT_NEAR(modulus, m.amplification, 1e-9) << name << " " << wh;
        EXPECT_NEAR(angle / (wh * std::sqrt(1.0 - zeta * zeta)) - 1.0, m.frequency_error, 1e-7)
            << name << " " << wh;
        EXPECT_NEAR(-std::log(modulus) / std::hypot(angle, std::log(modulus)), m.damping + zeta,
                    1e-8)
            << name << " " << wh;
      }
  // known leading terms: Radau damps by (w h)^5/7200, BDF2 by (w h)^3/4; Gauss not at all
  EXPECT_NEAR(mode_response("radau5", 1.0, 0.0, 0.2).damping / (std::pow(0.2, 5) / 7200.0), 1.0,
              0.02);
  EXPECT_NEAR(mode_response("ida", 1.0, 0.0, 0.02).damping / (std::pow(0.02, 3) / 4.0), 1.0, 0.02);
  EXPECT_NEAR(mode_response("gauss6", 1.0, 0.0, 2.0).damping, 0.0, 1e-15);
  EXPECT_NEAR(mode_response("generalized_alpha", 1.0, 0.0, 1e5, 0.6).radius, 0.6, 1e-3);
  EXPECT_THROW(mode_response("euler", 1.0, 0.0, 1.0), Error);
}

// Amplitude after 1e5 revolutions of an undamped mode: |R(i w h)|^steps.
TEST(Stability, AmplitudeOverAHundredThousandRevolutions) {
  constexpr int revolutions = 100000, per_revolution = 20;
  for (const char* name : {"radau5", "gauss4", "gauss6"}) {
    auto p = oscillator(two_pi);
    Options o;
    o.dt_fixed = 1.0 / per_revolution;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Constant(1, 1.0), VecX::Zero(1));
    for (int n = 0; n < revolutions * per_revolution; ++n)
      ASSERT_TRUE(integrator->advance().ok());
    const double amplitude = std::hypot(integrator->q()[0], integrator->v()[0] / two_pi);
    // |R| is known to 1e-16 only, so is its power to 2e-10: its logarithm from |R|^2 - 1, without
    // cancellation
    const double y = two_pi / per_revolution, y2 = y * y;
    const double damping =
        0.5 *
        std::log1p(-y2 * y2 * y2 / 3600.0 /
                   std::norm(1.0 - Complex(0, y) * 0.6 - 0.15 * y2 + Complex(0, y2 * y) / 60.0));
    const double exact =
        std::string_view(name) == "radau5" ? std::exp(damping * revolutions * per_revolution) : 1.0;
    // 2e6 steps: the rounding of the tableau biases each by less than 5e-17
    EXPECT_NEAR(amplitude, exact, 1e-10) << name;
    // exp(-2e6 (0.314)^6/7200): the decay a user of Radau sees at 20 steps a revolution
    if (std::string_view(name) == "radau5") {
      EXPECT_NEAR(amplitude, 0.766, 1e-3);
    }
  }
}

// Two masses: a soft mode that is forced, and a support of stiffness k between the second mass and
// the ground.
TEST(Stability, NoOrderCollapseOnStiffSupports) {
  auto error = [](const char* name, double k, int n) {
    MatX M = MatX::Identity(2, 2), C = MatX::Zero(2, 2), K(2, 2);
    K << 1e4, -1e4, -1e4, 1e4 + k;
    C << 2.0, -2.0, -2.0, 2.0;
    auto make = [&] {
      return LinearProblem(all(2), M, C, K, [](double t, Ref f) {
        f[0] = 100.0 * std::sin(70.0 * t);
        f[1] = 50.0 * std::sin(40.0 * t);
      });
    };
    auto p = make();
    Options o;
    o.dt_fixed = 0.2 / n;
    auto integrator = make_integrator(name, p, o);
    integrator->start(0.0, VecX::Zero(2), VecX::Zero(2));
    EXPECT_EQ(run(*integrator, 0.2), StepStatus::ok);
    // reference: Radau with forty times as many steps as the finest run
    auto fine = make();
    o.dt_fixed = 0.2 / 8000;
    auto reference = make_integrator("radau5", fine, o);
    reference->start(0.0, VecX::Zero(2), VecX::Zero(2));
    EXPECT_EQ(run(*reference, 0.2), StepStatus::ok);
    return std::abs(integrator->q()[0] - reference->q()[0]) /
           0.05;  // of a response of a few hundredths
  };
  for (double k : {1e5, 1e12}) {
    // The forced mass sees the stiff support only through a force that the support holds: order 5
    // (4 on the support's own motion, which is 1e-8 of this one).
    const double coarse = error("radau5", k, 100), fine = error("radau5", k, 200);
    EXPECT_LT(coarse, 2e-5) << k;
    EXPECT_NEAR(std::log2(coarse / fine), 5.0, 0.6) << k;
  }
}

// Van der Pol at mu = 1000: one relaxation cycle in a few hundred steps, jumps included.
TEST(Stability, VanDerPolRelaxation) {
  VanDerPol p(1000.0);
  Options o;
  o.tolerance = 1e-5;
  auto integrator = make_integrator("radau5", p, o);
  integrator->start(0.0, VecX::Constant(1, 2.0), VecX::Constant(1, 0.0));
  EXPECT_EQ(run(*integrator, 2000.0), StepStatus::ok);
  EXPECT_LT(integrator->statistics().accepted, 1000);
  // y(2000) = 1.706167732170483 for y(0) = 2, y'(0) = 0: Hairer & Wanner II, test set, scaled time
  // t/mu = 2
  EXPECT_NEAR(integrator->q()[0], 1.706167732170483, 2e-5);
}

}  // namespace
}  // namespace whirl::time::test
