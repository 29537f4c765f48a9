// The same machine at the ends of what people build, with nothing tuned by hand: sizes from a gram
// to a hundred tonnes, speeds from 1 to 100,000 rpm, supports of 1e12 N/m, meshes from two nodes to
// five thousand.
#include "deck_run.hpp"
#include <gtest/gtest.h>
#include <io/value.hpp>
#include <array>
#include <cmath>
#include <complex>
#include <string>

#include <fmt/format.h>

using namespace whirl;

namespace {

constexpr double pi = 3.14159265358979323846;

struct Machine {
  double length, od, support, damping, unbalance, rpm, duration;  // m, m, N/m, N s/m, kg m, rpm, s
  int elements;
};

/// A uniform shaft on two equal supports at its ends, turning at constant speed from its steady
/// response on.
std::string deck(const Machine& m) {
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
material = "steel"
columns = ["name", "length[m]", "od[m]", "min_elements"]
rows = [["body", {}, {}, {}]]
[[unbalance]]
at = "body:mid"
amount = "{} kg.m"
[[bearing]]
name = "A"
at = "body:start"
type = "linear"
kxx = "{} N/m"
kyy = "{} N/m"
kzz = "{} N/m"
cyy = "{} N.s/m"
czz = "{} N.s/m"
[[bearing]]
name = "B"
at = "body:end"
type = "linear"
kyy = "{} N/m"
kzz = "{} N/m"
cyy = "{} N.s/m"
czz = "{} N.s/m"
[[drive]]
name = "motor"
at = "body:start"
type = "speed"
speed = "{} rpm"
[[probe]]
name = "end"
at = "body:start"
[[step]]
name = "run"
type = "transient"
start = "unbalance_response"
initial_speed = "{} rpm"
duration = "{} s"
[output]
report = false
every = "{} s"
)",
                     m.length, m.od, m.elements, m.unbalance, m.support, m.support, m.support,
                     m.damping, m.damping, m.support, m.support, m.damping, m.damping, m.rpm, m.rpm,
                     m.duration, m.duration / 10);
}

/// Returns the step's summary.
io::Value run(const Machine& m) {
  const test::DeckRun r(deck(m));
  EXPECT_EQ(r.exit, 0) << r.log;
  return tests::read_json(r.folder / "r/summary.json").at("steps").at("run");
}

double amplitude(const io::Value& step) {
  return step.at("peaks").at("end").at("amplitude 0-peak [m]").number();
}
double mass(const Machine& m) { return 7850.0 * pi / 4 * m.od * m.od * m.length; }

/// |u| at the supports in steady forward whirl under U W^2 in the middle: the differential
/// equations of a spinning Timoshenko shaft,
///   w' = th + Q/(kGA),  th' = M/EI,  M' = -Q - (rhoI - rhoIp) W^2 th,  Q' = -rhoA W^2 w
/// (complex, w = y + i z in axes that turn), from the middle, th = 0 and Q = -U W^2/2, to the end,
/// M = 0 and Q = -(k + i W c) w. Classical Runge-Kutta with so many steps that its error is below
/// 1e-10.
double exact(const Machine& m) {
  using C = std::complex<double>;
  using Y = std::array<C, 4>;                                 // w, th, M, Q
  const double E = 2.1e11, nu = 0.3, G = E / (2 * (1 + nu));  // steel of the library
  const double A = pi / 4 * m.od * m.od, I = pi / 64 * std::pow(m.od, 4),
               kGA = 6 * (1 + nu) / (7 + 6 * nu) * G * A, W = m.rpm * pi / 30;
  const double mu = 7850 * A * W * W, rotary = (7850 * I - 2 * 7850 * I) * W * W;
  const auto f = [&](const Y& y) {
    return Y{y[1] + y[3] / kGA, y[2] / (E * I), -y[3] - rotary * y[1], -mu * y[0]};
  };
  const auto shoot = [&](Y y) {
    const int n = 4000;
    const double h = m.length / 2 / n;
    const auto plus = [](Y a, double c, const Y& b) {
      for (int i = 0; i < 4; ++i)
        a[i] += c * b[i];
      return a;
    };
    for (int k = 0; k < n; ++k) {
      const Y a = f(y), b = f(plus(y, h / 2, a)), c = f(plus(y, h / 2, b)), d = f(plus(y, h, c));
      for (int i = 0; i < 4; ++i)
        y[i] += h / 6 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
    return y;
  };
  const C support(m.support, W * m.damping);
  const Y force = shoot({0, 0, 0, -0.5 * m.unbalance * W * W}), lift = shoot({1, 0, 0, 0}),
          moment = shoot({0, 0, 1, 0});
  // w(0), M(0) from M(L/2) = 0 and Q + support w = 0
  const auto end = [&](const Y& y) { return y[3] + support * y[0]; };
  const C det = lift[2] * end(moment) - moment[2] * end(lift);
  const C w0 = (-force[2] * end(moment) + moment[2] * end(force)) / det,
          M0 = (-lift[2] * end(force) + force[2] * end(lift)) / det;
  return std::abs(force[0] + w0 * lift[0] + M0 * moment[0]);
}

}  // namespace

// Tolerances: 2e-4 for the default accuracy of the run, 1e-4, on both sides of the start; meshes
// are fine enough for less.

TEST(Extremes, OneGramAtAHundredThousandRpm) {
  // 2 mm x 40 mm: 0.99 g; on supports so soft that it turns about its mass centre, bending by a
  // fifth of that under its own load
  const Machine m{0.040, 0.002, 1e3, 0.05, 1e-9, 100000, 0.02, 8};
  EXPECT_NEAR(mass(m), 1e-3, 2e-5);
  EXPECT_NEAR(amplitude(run(m)) / exact(m), 1.0, 2e-4);
}

TEST(Extremes, AHundredTonnesAtOneRpm) {
  // 1.27 m x 10 m: 99 t; 300 s are five turns
  const Machine m{10.0, 1.27, 1e8, 1e6, 1.0, 1, 300, 2};
  EXPECT_NEAR(mass(m), 1e5, 2e3);
  EXPECT_NEAR(amplitude(run(m)) / exact(m), 1.0, 2e-4);
}

TEST(Extremes, StiffSupportsAndFewNodes) {
  // 1e12 N/m: the ends move by 5 nm. One element of the deck's section is two in the mesh, with the
  // unbalance between them.
  for (const int n : {1, 8}) {
    const Machine m{1.0, 0.05, 1e12, 1e3, 1e-4, 3000, 0.1, n};
    EXPECT_NEAR(amplitude(run(m)) / exact(m), 1.0, n == 1 ? 1e-3 : 2e-4)
        << n;  // two elements: their own error
  }
}

TEST(Extremes, FiveThousandNodes) {
  // Elements of a 250th of the diameter. The slice of one node could not carry the unbalance: its
  // kinetic energy would be negative.
  const Machine m{1.0, 0.05, 1e7, 1e3, 1e-4, 3000, 0.01, 5000};
  EXPECT_NEAR(amplitude(run(m)) / exact(m), 1.0, 2e-4);
}

TEST(Extremes, AnUnbalanceThatNoShaftCanHaveIsRefused) {
  // 10 kg m on 15 kg: the mass centre 0.65 m from the axis of a 50 mm shaft
  const test::DeckRun r(deck({1.0, 0.05, 1e7, 1e3, 10.0, 3000, 0.01, 8}));
  EXPECT_NE(r.exit, 0);
  EXPECT_TRUE(r.says("[E38]")) << r.log;
}
