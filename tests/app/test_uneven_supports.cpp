// A disk on unequal supports, and a spring with two stiffnesses that turns with it: two degrees of freedom
// whose equations are written down here. Forced motion against harmonic balance of 25 harmonics, growth
// against Floquet's multipliers.
#include "deck_run.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unsupported/Eigen/MatrixFunctions>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>

using std::numbers::pi;
using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

using Complex = std::complex<double>;
constexpr double rpm = pi / 30;

struct Machine {
  double m = 10, kyy = 2e6, kzz = 2e5, k1 = 9e5, k2 = 1e5, c = 60;

  /// At an angle of the spring.
  Eigen::Matrix2d stiffness(double theta) const {
    const double mean = 0.5 * (k1 + k2), half = 0.5 * (k1 - k2);
    Eigen::Matrix2d K;
    K << mean + half * std::cos(2 * theta), half * std::sin(2 * theta), half * std::sin(2 * theta),
        mean - half * std::cos(2 * theta);
    K(0, 0) += kyy;
    K(1, 1) += kzz;
    return K;
  }
  /// 1/s.
  double growth(double Omega) const {
    constexpr int steps = 1024;
    const double h = pi / Omega / steps;  // of half a turn
    Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
    for (int k = 0; k < steps; ++k) {
      Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
      A.topRightCorner<2, 2>().setIdentity();
      A.bottomLeftCorner<2, 2>() = -stiffness((k + 0.5) * pi / steps) / m;
      A.bottomRightCorner<2, 2>().diagonal().setConstant(-c / m);
      turn = (A * h).exp() * turn;
    }
    return std::log(turn.eigenvalues().cwiseAbs().maxCoeff()) / (pi / Omega);
  }
  /// Amplitudes of y + i z at exp(i h Omega t), h = -25 .. 25, under weight along -z and an unbalance.
  Eigen::VectorXcd motion(double Omega, double unbalance, double phase, double g) const {
    constexpr int H = 25, n = 2 * H + 1;
    const Complex i(0, 1);
    // u = y + i z: m u'' + c u' + a u + b conj(u) + s u + d exp(2 i theta) conj(u) = F
    const double a = 0.5 * (kyy + kzz), b = 0.5 * (kyy - kzz), s = 0.5 * (k1 + k2),
                 d = 0.5 * (k1 - k2);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    Eigen::VectorXd F = Eigen::VectorXd::Zero(2 * n);
    const auto add = [&](int row, int column, Complex by, bool conjugate) {
      const double sign = conjugate ? -1.0 : 1.0;
      A(2 * row, 2 * column) += by.real();
      A(2 * row, 2 * column + 1) += -sign * by.imag();
      A(2 * row + 1, 2 * column) += by.imag();
      A(2 * row + 1, 2 * column + 1) += sign * by.real();
    };
    for (int h = -H; h <= H; ++h) {
      const double w = h * Omega;
      add(h + H, h + H, a + s - m * w * w + i * c * w, false);
      add(h + H, -h + H, b, true);  // conj(u) at h is the conjugate of u at -h
      if (std::abs(2 - h) <= H) add(h + H, 2 - h + H, d, true);
    }
    F[2 * H + 1] = -m * g;
    const Complex turning = unbalance * Omega * Omega * std::polar(1.0, phase);
    F[2 * (H + 1)] = turning.real();
    F[2 * (H + 1) + 1] = turning.imag();
    const Eigen::VectorXd x = A.partialPivLu().solve(F);
    Eigen::VectorXcd out(n);
    for (int k = 0; k < n; ++k)
      out[k] = Complex(x[2 * k], x[2 * k + 1]);
    return out;
  }
  std::string deck(double g, const std::string& parts) const {
    return fmt::format(R"(format = 1
[model]
gravity = "{} m/s^2"
[output]
report = false
[[shaft]]
name = "A"
columns = ["name", "length[mm]", "rigid"]
rows = [["a", 200, true], ["b", 200, true]]
[[shaft]]
name = "B"
columns = ["name", "length[mm]", "rigid"]
rows = [["a", 200, true], ["b", 200, true]]
[[disk]]
at = "A/a:end"
mass = "{} kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[disk]]
at = "B/a:end"
mass = "5 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
at = "A/a:end"
type = "rigid"
directions = ["x", "ry", "rz"]
[[bearing]]
at = "B/a:end"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[bearing]]
at = "A/a:end"
type = "linear"
kyy = "{} N/m"
kzz = "{} N/m"
cyy = "{} N.s/m"
czz = "{} N.s/m"
[[bearing]]
at = "A/a:end"
to = "B/a:end"
type = "coupling"
kxx = "1e6 N/m"
kyy = "{} N/m"
kzz = "{} N/m"
krxx = "1e6 N.m/rad"
crxx = "100 N.m.s/rad"
[[probe]]
name = "p"
at = "A/a:end"
{})",
                       g, m, kyy, kzz, c, c, k1, k2, parts);
  }
};

// So unequal that three harmonics of the revolution are too few where it turns slowly.
TEST(UnevenSupports, EveryMultipleIsThatOfManyHarmonics) {
  const auto check = [&](const Machine& machine, double gravity, double speed, double left) {
    const DeckRun r(machine.deck(
        gravity, fmt::format("[[unbalance]]\nat = \"A/a:end\"\namount = \"200 g.mm\"\nphase = \"40 "
                             "deg\"\n[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed "
                             "= {{ values = [\"{} rpm\"] }}\n",
                             speed)));
    ASSERT_EQ(r.exit, 0) << r.log;
    const auto row = r.csv("u_multiples.csv").last();
    const Eigen::VectorXcd exact = machine.motion(speed * rpm, 2e-4, 40 * pi / 180, gravity);
    double largest = 0;
    for (int h = 1; h <= 3; ++h)
      largest = std::max({largest, std::abs(exact[25 + h]), std::abs(exact[25 - h])});
    for (int h = 1; h <= 3; ++h) {
      EXPECT_NEAR(row.at(fmt::format("p {}x forward [m]", h)), std::abs(exact[25 + h]),
                  1e-4 * largest)
          << speed << " rpm, " << h;
      EXPECT_NEAR(row.at(fmt::format("p {}x backward [m]", h)), std::abs(exact[25 - h]),
                  1e-4 * largest)
          << speed << " rpm, " << h;
    }
    EXPECT_LT(row.at("left out [-]"), left);
  };
  Machine machine;
  for (const double speed : {420.0, 1000.0, 1700.0, 5500.0})
    check(machine, 9.80665, speed, 2e-2);
  check(machine, 0.0, 1000.0, 2e-2);  // what unbalance alone does at three times the speed
  // nothing oscillates: multiples beyond the third fall off slowly, and are not shown
  machine.c = 5e4;
  check(machine, 9.80665, 60.0, 0.1);
}

// Unbalance alone makes three times the speed; its peak is solved for with the motion at each speed.
TEST(UnevenSupports, ThePeakAtThreeTimesTheSpeedDoesNotDependOnThePoints) {
  const Machine machine;
  const auto largest = [&](const char* from, const char* to, int points) {
    const DeckRun r(machine.deck(
        0.0, fmt::format("[[unbalance]]\nat = \"A/a:end\"\namount = \"200 g.mm\"\n"
                         "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = "
                         "{{ start = \"{}\", stop = \"{}\", points = {} }}\n",
                         from, to, points)));
    EXPECT_EQ(r.exit, 0) << r.log;
    const Columns t = r.csv("u_multiples.csv");
    double most = 0;
    for (const std::vector<double>& cells : t.rows)
      most = std::max(most, cells.at(t.column("p 3x forward [m]")));
    return most;
  };
  const double few = largest("300 rpm", "3000 rpm", 12);
  EXPECT_GT(few, 1e-8);
  EXPECT_NEAR(largest("300 rpm", "3000 rpm", 31) / few, 1, 1e-4);
  // against the spin, which the speeds list the slowest last
  EXPECT_NEAR(largest("-3000 rpm", "-300 rpm", 31) / few, 1, 1e-4);
}

TEST(UnevenSupports, BandsOfRotorsInWhichNothingOscillates) {
  Machine machine;
  machine.c = 5e4;
  const DeckRun r(machine.deck(9.80665,
                               "[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = { start = "
                               "\"20 rpm\", stop = \"300 rpm\", points = 5 }\n"));
  EXPECT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(r.says("no growth found from 20 to 300 rpm (certified")) << r.log;
  EXPECT_FALSE(r.says("not looked for")) << r.log;  // there are no resonances
}

// The slowest speed of a step needs the most harmonics; a band is no band where there is a gap.
TEST(UnevenSupports, GrowthIsFloquets) {
  Machine machine;
  machine.c = 8;
  const auto run = [&](const char* speeds) {
    return DeckRun(machine.deck(
        0,
        fmt::format("[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = {{ values = [{}] }}\n",
                    speeds)));
  };
  const DeckRun two = run("\"788 rpm\", \"850 rpm\"");
  ASSERT_EQ(two.exit, 0) << two.log;
  const double exact = machine.growth(788 * rpm);
  EXPECT_NEAR(exact, 1.970, 1e-3);
  const auto growth = two.csv("s_growth.csv").rows.front();
  EXPECT_NEAR(growth.at(0), 788, 1e-6);
  EXPECT_NEAR(growth.at(1), exact, 1e-3 * exact);
  const DeckRun ends = run("\"788 rpm\", \"1784 rpm\"");
  ASSERT_EQ(ends.exit, 0) << ends.log;
  const auto bands = ends.csv("s_bands.csv").rows;
  const auto listed = [&](double speed) {
    return std::any_of(bands.begin(), bands.end(),
                       [&](const auto& b) { return !(speed < b.at(0)) && !(speed > b.at(1)); });
  };
  for (const double speed : {788.0, 1111.0, 1195.0, 1290.0, 1784.0}) {
    EXPECT_GT(machine.growth(speed * rpm), 1.0) << speed;
    EXPECT_TRUE(listed(speed)) << speed;
  }
  for (const double speed : {850.0, 1150.0, 1240.0, 1400.0}) {
    EXPECT_LT(machine.growth(speed * rpm), 0.0) << speed;
    EXPECT_FALSE(listed(speed)) << speed;
  }
}

// Where forward whirl meets the spin its hysteretic damping changes sign, and with it, on unequal supports
// that damp, its frequency: the critical speed lies there all the same, where the response peaks.
TEST(UnevenSupports, CriticalSpeedsWithHystereticDampingAreAllThere) {
  const auto run = [](const char* loss) {
    return DeckRun(fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[output]
report = false
[shaft]
name = "rotor"
material = "steel"
damping = {{ internal_loss_factor = {} }}
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 500, 40], ["right", 500, 40]]
[[disk]]
at = "left:end"
mass = "20 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
at = "left:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "1e7 N/m"
cyy = "20 kN.s/m"
czz = "20 kN.s/m"
[[bearing]]
at = "right:end"
type = "linear"
kyy = "2e7 N/m"
kzz = "1e7 N/m"
cyy = "20 kN.s/m"
czz = "20 kN.s/m"
[[step]]
name = "c"
type = "critical_speeds"
motion = "lateral"
max_speed = "6000 rpm"
[[step]]
name = "camp"
type = "campbell"
speed = {{ start = "0 rpm", stop = "6000 rpm", points = 25 }}
orders = [1]
modes = 4
)",
                               loss));
  };
  const DeckRun without = run("0"), with = run("0.02");
  const auto sound = without.csv("c_damped.csv").rows, damped = with.csv("c_damped.csv").rows,
             crossings = with.csv("camp_critical_speeds.csv").rows;
  ASSERT_EQ(sound.size(), 2u) << without.log;
  ASSERT_EQ(damped.size(), 2u) << with.log;
  ASSERT_EQ(crossings.size(), 2u) << with.log;
  const std::size_t column = with.csv("c_damped.csv").column("speed [rpm]"),
                    of_campbell = with.csv("camp_critical_speeds.csv").column("speed [rpm]");
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(damped[k].at(column), sound[k].at(column), 2e-3 * sound[k].at(column));
    EXPECT_NEAR(crossings[k].at(of_campbell), damped[k].at(column), 1e-6 * damped[k].at(column));
  }
}

}  // namespace
