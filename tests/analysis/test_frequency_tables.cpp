// Bearings tabulated against frequency, in every analysis that has one. Reference: a mass m on a
// spring k1 and damper c1 that stand on a pedestal m2, k2, c2. Seen from the mass the support is
// the dynamic stiffness
//   D(w) = 1/(1/(k1 + i w c1) + 1/(k2 - w^2 m2 + i w c2)),   K(w) = Re D,  C(w) = Im D/w,
// so the response to F exp(i w t) is F/(D - m w^2), and without dampers the frequencies are the
// roots of m w^2 = D(w).
#include <analysis/response/frequency_response.hpp>
#include <analysis/response/unbalance.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <assembly/build_system.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <system/problem.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include "../validation/deck_model.hpp"

#include <stdexcept>

using namespace whirl;

namespace {

constexpr double m = 50, k1 = 8e6, m2 = 20, k2 = 2e7, e = 2e-5;
struct Support {
  double c1, c2;
  Complex D(double w) const {
    return 1.0 / (1.0 / Complex(k1, w * c1) + 1.0 / Complex(k2 - w * w * m2, w * c2));
  }
};

/// w: rad/s.
std::string deck_text(const Support& s, const std::vector<double>& w,
                      const char* extrapolate = "error") {
  std::string rows;
  for (double rpm : {0.0, 6000.0})
    for (double x : w) {
      const Complex d = s.D(x);
      // C at w = 0 is the limit: c1 k2^2 + c2 k1^2 over (k1 + k2)^2
      const double C =
          x > 0 ? d.imag() / x : (s.c1 * k2 * k2 + s.c2 * k1 * k1) / ((k1 + k2) * (k1 + k2));
      rows += fmt::format("[{}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}],\n", rpm, x / two_pi,
                          d.real(), d.real(), C, C);
    }
  return test::lateral_mass(m, "0 m/s^2",
                            fmt::format(R"([[unbalance]]
at = "mass"
amount = "{:.17g} kg.m"
[[bearing]]
name = "shaken"
at = "mass"
type = "table"
extrapolate = "{}"
columns = ["speed[rpm]", "frequency[Hz]", "kyy[N/m]", "kzz[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [
{}]
)",
                                        m * e, extrapolate, rows));
}

std::vector<double> grid(double last, int n) {
  std::vector<double> w;
  for (int i = 0; i <= n; ++i)
    w.push_back(last * i / n);
  return w;
}

constexpr Support damped{2e3, 5e3}, undamped{0, 0};

}  // namespace

// On the grid's frequencies the table is exact, and so is the response, at any speed.
TEST(FrequencyTable, ResponseAtTheFrequencyOfExcitation) {
  const std::vector<double> w = grid(600, 12);
  const test::DeckModel a(deck_text(damped, w));
  ASSERT_FALSE(a.built.table_frequencies.empty());
  analysis::Linearizer linear(a.built.system, a.running());
  const Index y = 6 * a.disk() + 1;
  analysis::FrequencyResponseOptions o;
  o.forces = {{y, Complex(100, 0)}};
  o.unknowns = {y};
  for (double Omega : {0.0, 123.0, 500.0}) {
    analysis::HarmonicResponder responder(linear, o);
    for (double frequency : {100.0, 350.0, 600.0}) {
      const analysis::FrequencyPoint p = responder.at(Omega, frequency);
      const Complex x = 100.0 / (damped.D(p.frequency) - m * p.frequency * p.frequency);
      EXPECT_LT(std::abs(p.unknown[0] - x), 1e-11 * std::abs(x)) << Omega << " " << p.frequency;
    }
  }
}

TEST(FrequencyTable, UnbalanceAtTheFrequencyOfTheSpin) {
  const test::DeckModel a(deck_text(damped, grid(600, 12)));
  analysis::Linearizer linear(a.built.system, a.running());
  analysis::UnbalanceOptions o;
  o.probes = {{"mass", {a.disk(), 0.0}, {}}};
  analysis::UnbalanceSolver solver(linear, o);
  for (double Omega : {150.0, 400.0, 600.0}) {
    const double x = std::abs(m * e * Omega * Omega / (damped.D(Omega) - m * Omega * Omega));
    EXPECT_NEAR(solver.at(Omega).probe[0][0].orbit().major, x, 1e-11 * x);
  }
}

// Undamped: the root of m w^2 = D(w), found by bisection; the cubic through a grid of 5 rad/s is
// exact to 1e-8 there. Coefficients at the frequency of the spin would put it more than 1 % off.
TEST(FrequencyTable, ModesAtTheirOwnFrequency) {
  const test::DeckModel a(deck_text(undamped, grid(600, 120)));
  double low = 100, high = 600;
  for (int i = 0; i < 100; ++i) {
    const double mid = 0.5 * (low + high);
    (m * mid * mid < undamped.D(mid).real() ? low : high) = mid;
  }
  analysis::Linearizer linear(a.built.system, a.running());
  analysis::ModesOptions o;
  o.count = 6;
  o.motion = analysis::Motion::lateral;
  for (double Omega : {40.0, 600.0}) {
    const auto modes = analysis::whirl_modes(linear, Omega, o);
    ASSERT_EQ(modes.size(), 2u);  // one a plane
    for (const auto& mode : modes)
      EXPECT_NEAR(mode.frequency, low, 1e-7 * low) << Omega;
    const double synchronous = std::sqrt(undamped.D(Omega).real() / m);
    EXPECT_GT(std::abs(synchronous - low), 0.01 * low);
  }
}

// Overdamped: the roots of m l^2 + C(0) l + K(0), C(0) and K(0) those at zero frequency; a table
// that begins at 5 rad/s leaves those at the spin.
TEST(FrequencyTable, RealRootsAtZeroFrequency) {
  constexpr Support heavy{3e5, 4e5};
  for (const bool covered : {true, false}) {
    std::vector<double> w = grid(600, 120);
    if (!covered) w.erase(w.begin());
    const test::DeckModel a(deck_text(heavy, w));
    const double Omega = 300.0, at = covered ? 0.0 : Omega;
    const double K = heavy.D(at).real(),
                 C = covered ? (heavy.c1 * k2 * k2 + heavy.c2 * k1 * k1) / ((k1 + k2) * (k1 + k2))
                             : heavy.D(Omega).imag() / Omega;
    const double root = std::sqrt(C * C - 4 * m * K);
    ASSERT_GT(root, 0.0);
    analysis::Linearizer linear(a.built.system, a.running());
    analysis::ModesOptions o;
    o.count = 8;
    o.motion = analysis::Motion::lateral;
    o.real_roots = true;
    const auto modes = analysis::whirl_modes(linear, Omega, o);
    for (const double exact : {(-C + root) / (2 * m), (-C - root) / (2 * m)}) {
      int found = 0;
      for (const auto& mode : modes)
        found += std::abs(mode.lambda - exact) < 1e-9 * std::abs(exact) ? 1 : 0;
      EXPECT_EQ(found, 2) << exact;  // one a plane
    }
  }
}

// Damped: lambda^2 m + lambda C(w) + K(w) = 0 at w = Im lambda, solved here by iteration on the
// exact coefficients.
TEST(FrequencyTable, DampedModesAtTheirOwnFrequency) {
  const test::DeckModel a(deck_text(damped, grid(600, 120)));
  double w = 300;
  Complex lambda;
  for (int i = 0; i < 200; ++i) {
    const double K = damped.D(w).real(), C = damped.D(w).imag() / w;
    lambda = Complex(-C / (2 * m), std::sqrt(K / m - C * C / (4 * m * m)));
    w = lambda.imag();
  }
  analysis::Linearizer linear(a.built.system, a.running());
  analysis::ModesOptions o;
  o.count = 6;
  o.motion = analysis::Motion::lateral;
  for (const auto& mode : analysis::whirl_modes(linear, 100.0, o))
    EXPECT_LT(std::abs(mode.lambda - lambda), 1e-6 * std::abs(lambda));
}

TEST(FrequencyTable, StaticsAndMotionsTakeTheSynchronousValues) {
  const test::DeckModel a(deck_text(damped, grid(600, 12)));
  system::SystemProblem p(a.built.system);
  system::State s = a.built.system.make_state();
  const Index k = 6 * a.disk();
  s.q[k + 1] = 1e-5;
  for (double spin : {0.0, 250.0, 600.0}) {
    s.v[k + 3] = spin;
    VecX r(a.built.system.size());
    p.residual(0, s.q, s.v, s.a, r);
    EXPECT_NEAR(r[k + 1], damped.D(spin).real() * 1e-5 - m * e * spin * spin, 1e-11 * k1 * 1e-5);
  }
}

TEST(FrequencyTable, UncoveredFrequencyIsAnError) {
  const test::DeckModel a(deck_text(undamped, grid(200, 4)));
  analysis::Linearizer linear(a.built.system, a.running());
  analysis::ModesOptions o;
  o.count = 6;
  o.motion = analysis::Motion::lateral;
  try {
    analysis::whirl_modes(linear, 40.0, o);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.diagnostics().front().code, "E81");
    EXPECT_NE(std::string(error.what()).find("does not cover the frequency"), std::string::npos);
  }
  const test::DeckModel held(deck_text(undamped, grid(200, 4), "hold"));
  analysis::Linearizer other(held.built.system, held.running());
  EXPECT_EQ(analysis::whirl_modes(other, 40.0, o).size(), 2u);
}
