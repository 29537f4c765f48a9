// Supports, masses, damping and scales over many orders of magnitude, against exact solutions.
#include "scene.hpp"
#include <core/error.hpp>
#include <fmt/format.h>
#include <array>
#include <cmath>

using namespace whirl;
using namespace whirl::test;

// A mass dropped on its spring, three and a third periods: z = -(g/w^2)(1 - cos w t). Stiffness 1e2
// to 1e14 N/m, so periods down to 0.6 us and runs of 2 us.
TEST(Supports, StiffnessFromSoftToRigid) {
  for (const char* method : methods)
    for (double k = 1e2; k < 2e14; k *= 100.0) {
      const double w = std::sqrt(k), t = 2.0 * pi / w * (3.0 + 1.0 / 3.0), sag = 9.81 / k;
      const system::System s = mass_on_spring(1.0, k, 0.0, 9.81);
      const std::string what = fmt::format("{} k = {:g}", method, k);
      const system::State end = run_ok(s, s.make_state(), {t, 1.0, method}, what);
      // The stiffest springs sag by less than the absolute floors of error control, 1e-13 m: they
      // add to the aim.
      EXPECT_NEAR(end.q[2], -sag * (1.0 - std::cos(w * t)), aimed * (2.0 * sag + 1e-13)) << what;
      EXPECT_NEAR(equilibrium(s).state.q[2], -sag, 1e-12 * sag) << what;
    }
}

// A shaft on two springs under a force at its middle: F L^3/48EI + F L/(4 kGA) + F/2k. The springs
// hold x, the spin is held.
TEST(Supports, StiffnessUnderAFlexibleShaft) {
  const elements::ElementSection bar = round_bar(0.05);
  const double L = 1.0, F = 1e-4;
  const elements::SectionProperties p = bar.at(0.5);
  const double bending = F * L * L * L / (48.0 * p.EI) + F * L / (4.0 * p.kGA);
  for (double k = 1e2; k < 2e14; k *= 100.0) {
    system::Builder b;
    b.add_line("shaft");
    add_shaft(b, bar, {L / 4, L / 4, L / 4, L / 4});
    add_spring(b, 0, isotropic(k));
    add_spring(b, 4, isotropic(k));
    b.hold(0, system::spin_phi);
    b.add(elements::PointForce{Vec3(0, 0, -F), nullptr}, {Index(2)}, "forces");
    const system::System s = b.finalize();
    const double exact = -(bending + F / (2.0 * k));
    // relative 1e-9: round-off of K, condition number about EI/(l^3 k) or its inverse, up to 1e7;
    // deflection is linear to (F/kL)^2
    EXPECT_NEAR(equilibrium(s).state.q[6 * 2 + 2], exact, 1e-9 * std::abs(exact)) << k;
  }
}

// Two masses on two springs, mass ratios 1e-9 to 1e9, dropped: the sum of both modes.
TEST(Supports, MassRatios) {
  for (const char* method : {"radau5", "gauss6", "generalized_alpha"})
    for (double ratio = 1e-9; ratio < 2e9; ratio *= 1e3) {
      const double m2 = 1.0, m1 = ratio, k1 = 1e4, k2 = 1e4, g = 9.81;
      system::Builder b;
      b.add_line("shaft");
      const Index n1 = b.add_node({Vec3::Zero(), 0, "pedestal", false}),
                  n2 = b.add_node({Vec3::Zero(), 0, "rotor", false});
      b.add(elements::PointMass{m1}, {n1}, "point masses");
      b.add(elements::PointMass{m2}, {n2}, "point masses");
      add_spring(b, n1, isotropic(k1));
      elements::TranslationalBearing link;
      link.K = isotropic(k2);
      b.add(link, {n2, n1}, "springs");
      b.set_gravity(Vec3(0, 0, -g));
      const system::System s = b.finalize();
      const double t = 2.0 * pi / std::sqrt(k2 / m2) * 3.3;
      // modes: m1 m2 l^2 - (m1 k2 + m2 (k1 + k2)) l + k1 k2 = 0, roots without cancellation
      const double B = m1 * k2 + m2 * (k1 + k2), root = std::sqrt(B * B - 4.0 * m1 * m2 * k1 * k2);
      const double big = (B + root) / (2.0 * m1 * m2), small = 2.0 * k1 * k2 / (B + root);
      const double x1 = -(m1 + m2) * g / k1, x2 = x1 - m2 * g / k2;  // equilibrium
      double exact = x2, peak = 0.0;
      for (const double l : {big, small}) {
        // shape (x1, x2), by the row that does not cancel
        const double d1 = k1 + k2 - m1 * l, d2 = k2 - m2 * l;
        const std::array<double, 2> f = std::abs(d2) * k2 > std::abs(d1) * k2
                                            ? std::array{d2 / k2, 1.0}
                                            : std::array{1.0, d1 / k2};
        const double c = (f[0] * m1 * x1 + f[1] * m2 * x2) / (f[0] * m1 * f[0] + f[1] * m2 * f[1]);
        exact -= c * f[1] * std::cos(std::sqrt(l) * t);
        peak += std::abs(c * f[1]) * std::min(2.0, 0.5 * l * t * t);
      }
      const std::string what = fmt::format("{} ratio {:g}", method, ratio);
      const system::State end = run_ok(s, s.make_state(), {t, 1.0, method}, what);
      EXPECT_NEAR(end.q[6 * n2 + 2], exact, aimed * peak) << what;
    }
}

// Free vibration with damping ratios from negative (growing) over critical to 1.5.
TEST(Supports, DampingRatios) {
  for (const char* method : methods)
    for (double zeta : {-0.3, -0.01, 0.0, 1e-6, 0.01, 0.5, 0.999999, 1.0, 1.000001, 1.5}) {
      const double w = 100.0, t = 2.0 * pi / w * 2.7, q0 = 1e-3;
      const system::System s = mass_on_spring(2.0, 2.0 * w * w, 2.0 * 2.0 * zeta * w, 0.0);
      system::State start = s.make_state();
      start.q[2] = q0;
      double exact = 0.0;
      const Complex r = std::sqrt(Complex(zeta * zeta - 1.0));
      // e^(-zeta w t) (cosh(r w t) + zeta sinh(r w t)/r), the last factor by its series where r is
      // small
      const Complex x = r * w * t;
      const Complex sinhc =
          std::abs(x) < 1e-2 ? 1.0 + x * x / 6.0 * (1.0 + x * x / 20.0) : std::sinh(x) / x;
      exact = q0 * std::exp(-zeta * w * t) * (std::cosh(x) + zeta * w * t * sinhc).real();
      const std::string what = fmt::format("{} zeta = {:g}", method, zeta);
      const system::State end = run_ok(s, start, {t, 1.0, method}, what);
      EXPECT_NEAR(end.q[2], exact, aimed * q0 * std::max(1.0, std::exp(-zeta * w * t))) << what;
    }
}

// Periods from 1 us to 1e6 s and displacements from 1e-12 to 1e12 m, masses and stiffnesses of
// 1e-12 to 1e12: units that make the numbers small or large must not matter.
TEST(Supports, SpansOfTimeAndUnits) {
  for (const char* method : {"radau5", "gauss6", "generalized_alpha"})
    for (double period : {1e-6, 1e-3, 1.0, 1e3, 1e6})
      for (double m : {1e-12, 1.0, 1e12})
        for (double amplitude : {1e-12, 1e-6, 1.0, 1e6, 1e12}) {
          const double w = 2.0 * pi / period, t = 2.3 * period;
          const system::System s = mass_on_spring(m, m * w * w, 0.0, 0.5 * amplitude * w * w);
          const std::string what =
              fmt::format("{} T = {:g} m = {:g} u = {:g}", method, period, m, amplitude);
          const system::State end = run_ok(s, s.make_state(), {t, amplitude, method}, what);
          // floor of error control: 1e-13 m
          EXPECT_NEAR(end.q[2], -0.5 * amplitude * (1.0 - std::cos(w * t)),
                      aimed * (amplitude + 1e-13))
              << what;
        }
}

// What cannot be determined is said: a mass on nothing has no equilibrium.
TEST(Supports, NothingHoldsIt) {
  const system::System s = mass_on_spring(1.0, 0.0, 0.0, 9.81);
  EXPECT_THROW(equilibrium(s), Error);
  const system::State end = run_ok(s, s.make_state(), {1e6, 1.0}, "free fall");
  EXPECT_NEAR(end.q[2], -0.5 * 9.81 * 1e12,
              1e-8 * 0.5 * 9.81 * 1e12);  // exact for every scheme but for rounding over the steps
}
