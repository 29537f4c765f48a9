// Annular seal: closed form against the perturbation equations it solves; cross-coupling formulas.
#include "conformance.hpp"
#include <elements/films/annular_seal.hpp>
#include <complex>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

AnnularSeal pump(double swirl = 0.5) {
  return {0.05, 0.035, 2.5e-4, 2e6, 1000.0, 1e-3, 0.2, swirl};
}

/// First-order bulk flow, harmonic e^{-i theta} e^{st} with h1 = -r: the axial velocity w1 from
/// continuity with the swirl 1/2 + v0 e^{-az}, the pressure gradient from the axial momentum
/// equation without the acceleration of the inlet perturbation (Childs' short-seal approximation),
/// integrated with Simpson's rule; returns the integral of p over the length per h1.
Complex film_integral(const AnnularSeal& k, double spin, Complex s, double weight_v0) {
  const auto f = k.flow(spin);
  const double T = k.length / f.V, m0 = -0.25, b = f.V / (k.radius * spin),
               beta = 1 / (1 + 4 * b * b);
  const double B = 1 + 4 * b * b * beta * (1 + m0), a = f.sigma * (1 + beta * (1 + m0)),
               v0 = weight_v0 * (k.inlet_swirl - 0.5);
  const Complex D0 = T * (s - Complex(0, spin / 2));
  const Complex S = Complex(0, -spin * T * v0);
  const int N = 400;
  const double h = 1.0 / N;
  // w1 = w0 + u(z), u(0) = 0, u' = -(D0 + S e^{-az}); terms of first order in S only
  const auto u = [&](double z) { return -D0 * z - S * (1 - std::exp(-a * z)) / a; };
  const auto gradient = [&](double z) {  // -dp1/dz less what w0 contributes
    const Complex second =
        -D0 * D0 * z - D0 * S * ((1 - std::exp(-a * z)) / a + z * std::exp(-a * z));
    return -(1 - m0) * f.sigma + B * f.sigma * u(z) + second - (D0 + S * std::exp(-a * z));
  };
  Complex drop = 0, moment = 0;
  for (int i = 0; i <= N; ++i) {
    const double z = i * h, w = (i == 0 || i == N ? 1 : i % 2 ? 4 : 2) * h / 3;
    drop += w * gradient(z);
    moment += w * z * gradient(z);
  }
  // inlet: p1(0) = -(1 + xi) w0 = drop + B sigma w0
  const Complex w0 = -drop / (1 + k.inlet_loss + B * f.sigma);
  return moment + 0.5 * B * f.sigma * w0;
}

}  // namespace

TEST(AnnularSeal, ClosedFormSolvesThePerturbedFlow) {
  for (double swirl : {0.5, 0.0, 0.8}) {
    const AnnularSeal k = pump(swirl);
    for (double spin : {50.0, 300.0, 900.0}) {
      AnnularSeal::Coefficients v, dv;
      k.coefficients(spin, v, dv);
      const auto f = k.flow(spin);
      const double unit = k.density * f.V * f.V * pi * k.radius * k.length / k.clearance;
      for (Complex s : {Complex(0, 0), Complex(0, 250), Complex(30, -120)}) {
        // force on the journal, complex y + i z: F = unit * integral * r = -(K - i k) r - (C - i c)
        // s r - M s^2 r
        const Complex closed = -(Complex(v.K, -v.k) + Complex(v.C, -v.c) * s + v.M * s * s);
        const Complex solved = unit * film_integral(k, spin, s, 1.0);
        EXPECT_LT(std::abs(closed - solved), 1e-8 * std::abs(solved)) << swirl << " " << spin;
      }
    }
  }
}

TEST(AnnularSeal, LeakageAndDerivatives) {
  const AnnularSeal k = pump(0.3);
  for (double spin : {-400.0, 0.0, 1.0, 400.0}) {
    const auto f = k.flow(spin);
    EXPECT_NEAR(0.5 * k.density * f.V * f.V * (1 + k.inlet_loss + 2 * f.sigma), k.pressure_drop,
                1e-9 * k.pressure_drop);
    const double x = std::pow(k.radius * spin / (2 * f.V), 2);
    EXPECT_NEAR(f.lambda, 0.066 * std::pow(f.V * k.clearance * 1e6, -0.25) * std::pow(1 + x, 0.375),
                1e-12);
    AnnularSeal::Coefficients v, dv, a, b, d;
    k.coefficients(spin, v, dv);
    const double h = 0.5;
    k.coefficients(spin + h, a, d);
    k.coefficients(spin - h, b, d);
    // central differences over 1 rad/s: error about h^2/(R s/V)^2
    EXPECT_NEAR(dv.K, (a.K - b.K) / (2 * h), 1e-6 * v.K / 100);
    EXPECT_NEAR(dv.k, (a.k - b.k) / (2 * h), 1e-6 * v.K / 100);
    EXPECT_NEAR(dv.C, (a.C - b.C) / (2 * h), 1e-6 * v.C / 100);
    EXPECT_NEAR(dv.M, (a.M - b.M) / (2 * h), 1e-6 * v.M / 100);
  }
  // reversed spin: even direct, odd cross terms
  AnnularSeal::Coefficients p, q, d;
  k.coefficients(300, p, d);
  k.coefficients(-300, q, d);
  EXPECT_NEAR(p.K, q.K, 1e-9 * p.K);
  EXPECT_NEAR(p.k, -q.k, 1e-9 * p.K);
  EXPECT_NEAR(p.c, -q.c, 1e-9 * p.C);
  // with half swirl a seal behaves like a medium turning at half speed: whirl ratio k/(C s) = 1/2
  // exactly, c = M s
  pump(0.5).coefficients(500, p, d);
  EXPECT_NEAR(p.k / (p.C * 500), 0.5, 1e-12);
  EXPECT_NEAR(p.c, p.M * 500, 1e-12 * p.c);
}

TEST(AnnularSeal, Conformance) {
  ConformanceOptions o;
  o.u = 5e-5;
  o.du = 0.02;
  o.ddu = 10;
  o.tilt = 0.2;
  o.dtilt = 1;
  o.ddtilt = 10;
  o.dphi = 10;
  o.ddphi = 100;
  o.v0.assign(12, 0.0);
  o.v0[3] = 400;
  check_kernel(SealJoint{{pump(0.2)}}, o);
  o.chart = tilted_chart();
  check_kernel(LateralJoint<AnnularSeal, true>{{pump(0.7)}, {1e-3, -2e-3}}, o);
}

TEST(AnnularSeal, CrossCouplingFormulas) {
  EXPECT_NEAR(alford_stiffness(1.5, 1e4, 0.6, 0.05), 1.5 * 1e4 / 0.03, 1e-9);
  // Wachel in US units: 6300 HP MW/(N D h) rho_d/rho_s, lbf/in: 5000 HP, 28 g/mol, 10000 rpm, D 20
  // in, h 1 in, ratio 1.5
  const double us = 6300.0 * 5000 * 28 / (10000 * 20 * 1.0) * 1.5;
  const double si =
      wachel_stiffness(5000 * 745.69987, 10000 * two_pi / 60, 20 * 0.0254, 0.0254, 0.028, 1.5);
  EXPECT_NEAR(si, us * 175.12684, 5e-4 * si);  // 6300 stands for 6302.5
}
