// Shafts with unequal principal stiffnesses: bands of parametric instability of a Jeffcott rotor,
// against closed forms (F. M. Dimentberg 1961; A. Tondl, Some Problems of Rotor Dynamics, 1965;
// Friswell et al., Dynamics of Rotating Machines, 2010, ch. 7) and, where the supports are unequal
// too, against Floquet's multipliers of the two-degree-of-freedom rotor found by integrating over a
// period.
#include "../app/deck_run.hpp"
#include "beam_line.hpp"
#include "record.hpp"

#include <analysis/spectra/instability_bands.hpp>
#include <assembly/build_system.hpp>
#include <deck/deck.hpp>
#include <meshes/mesh.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/rigid/rigid_disk.hpp>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::test;

namespace {

constexpr double m = 10, k1 = 9e5, k2 = 1.1e6;

/// Massless pinned shaft, 48 EI/L^3 = k1 and k2 in its axes, disk in the middle, external damping c
/// and springs ky, kz there.
system::System jeffcott(double c, double ky = 0, double kz = 0) {
  system::Builder b;
  const Index line = b.add_line("rotor");
  const BeamSection section{1e9, 0, 0, 1e5, k2 / 48, k1 / 48};
  add_beam(
      b, line, Mat3::Identity(),
      [](double s) {
        return LinePoint{Vec3(s, 0, 0), Mat3::Identity()};
      },
      0.0, 1.0, 2, section);
  for (const Index n : {Index(0), Index(2)})
    for (int k = n == 0 ? 0 : 1; k < 3; ++k)
      b.hold(n, k);
  b.add(elements::RigidDisk{m, 0.01, 0.005, 0}, {Index(1)}, "disks");
  elements::TranslationalBearing support;
  support.K(1, 1) = ky;
  support.K(2, 2) = kz;
  support.C(1, 1) = support.C(2, 2) = c;
  b.add(support, {Index(1), b.add_ground(Vec3(0.5, 0, 0), "ground")}, "springs");
  return b.finalize();
}

BandResult bands(const system::System& s, double from, double to, int points,
                 double tolerance = 1e-11) {
  Linearizer linear(s);
  RotatingAxes axes(linear, to);
  EXPECT_TRUE(axes.turning());
  BandOptions o;
  o.modes = 4;
  o.tolerance = tolerance;
  for (int k = 0; k < points; ++k)
    o.speeds.push_back(from + (to - from) * k / (points - 1));
  return find_bands(axes, o);
}

/// Largest growth rate of m r'' + c r' + (K_shaft(Omega t) + K_fixed) r = 0, from the multipliers
/// of one period pi/Omega.
double floquet(double Omega, double c, double ky, double kz, int steps = 300) {
  using V = Eigen::Matrix4d;
  const auto slope = [&](double t, const V& x) {
    const double C = std::cos(2 * Omega * t), S = std::sin(2 * Omega * t), kb = 0.5 * (k1 + k2),
                 dk = 0.5 * (k1 - k2);
    Eigen::Matrix2d K;
    K << kb + dk * C + ky, dk * S, dk * S, kb - dk * C + kz;
    V d;
    d.topRows<2>() = x.bottomRows<2>();
    d.bottomRows<2>() = -(K * x.topRows<2>() + c * x.bottomRows<2>()) / m;
    return d;
  };
  V x = V::Identity();
  const double T = pi / Omega, h = T / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = h * i;
    const V a = slope(t, x), b = slope(t + h / 2, x + h / 2 * a),
            d = slope(t + h / 2, x + h / 2 * b), e = slope(t + h, x + h * d);
    x += h / 6 * (a + 2 * b + 2 * d + e);
  }
  return std::log(x.eigenvalues().cwiseAbs().maxCoeff()) / T;
}

}  // namespace

// Tilting of the disk is damped by nothing: outside the band the fastest motion neither grows nor
// decays, at every speed, and all motions are counted.
TEST(AsymmetricShaft, UndampedTiltingIsInEveryCount) {
  const BandResult r = bands(jeffcott(100), 200, 420, 41);
  EXPECT_TRUE(r.complete());
  EXPECT_GE(r.counted, 41);
  EXPECT_LT(r.counted_to, infinity);
  for (std::size_t k = 0; k < r.speeds.size(); ++k)
    if (r.speeds[k] < 300.7 || r.speeds[k] > 330.9) {
      EXPECT_NEAR(r.growth[k], 0.0, 1e-6) << r.speeds[k];
    }
}

TEST(AsymmetricShaft, BandOnEqualSupports) {
  test::Record record("Asymmetric shaft on equal supports: band of instability",
                      "closed form (k1 - m W^2)(k2 - m W^2) + c^2 W^2 = 0 of a disk on a shaft "
                      "with two stiffnesses");
  struct Case {
    double c, low, high;
  };
  // m^2 O^4 - .. : (k1 - m O^2)(k2 - m O^2) + c^2 O^2 = 0; undamped: sqrt(k1/m), sqrt(k2/m)
  for (const Case& x : {Case{0, 300, 331.662479036}, Case{50, 300.1887461, 331.4539436},
                        Case{100, 300.7707354, 330.8125825}, Case{200, 303.3998216, 327.9459532},
                        Case{300, 310.4124108, 320.5372603}}) {
    const BandResult r =
        bands(jeffcott(x.c), 20, 1000,
              15);  // 70 rad/s apart: the band, 32 wide or less, lies between two of them
    ASSERT_EQ(r.bands.size(), 1u) << x.c;
    const std::string damping = "c = " + std::to_string(static_cast<int>(x.c)) + " N s/m, ";
    record.check(damping + "from", "rad/s", r.bands[0].low, x.low,
                 1e-9 * x.low);  // as stated, ten digits
    record.check(damping + "to", "rad/s", r.bands[0].high, x.high, 1e-9 * x.high);
    EXPECT_NEAR(r.bands[0].frequency, 0.0, 1e-9);
    if (x.c == 0) {
      record.check(damping + "largest growth", "1/s", r.bands[0].growth, 15.811388300842,
                   1e-10 * 15.8);
      EXPECT_NEAR(r.bands[0].speed, 315.832233947, 1e-7 * 315.8);  // a flat maximum
    }
  }
  // c > 316.62479: c^2 = m (k1 + k2) - 2 m sqrt(k1 k2)
  EXPECT_TRUE(bands(jeffcott(316.7), 20, 1000, 15).bands.empty());
  EXPECT_EQ(bands(jeffcott(316.5), 20, 1000, 15).bands.size(), 1u);
}

TEST(AsymmetricShaft, BandsOnUnequalSupports) {
  const double ky = 3e5, kz = 8e5;
  for (const double c : {40.0}) {
    const system::System s = jeffcott(c, ky, kz);
    Linearizer linear(s);
    RotatingAxes axes(linear, 500.0);
    EXPECT_FALSE(axes.constant());
    const BandResult r = bands(s, 340, 440, 11, 1e-6);
    ASSERT_GE(r.bands.size(), 1u) << c;
    double widest = 0;
    for (const InstabilityBand& b : r.bands) {
      ASSERT_FALSE(std::isnan(b.low) || std::isnan(b.high));
      EXPECT_NEAR(b.growth, floquet(b.speed, c, ky, kz), 1e-5 * b.growth) << b.speed;
      // stable just outside, unstable just inside, by a ten-thousandth of the speed (the growth
      // there is far above the rounding of the multipliers)
      const double step = 1e-4 * b.low, none = c > 0 ? 0.0 : 1e-7;
      EXPECT_LE(floquet(b.low - step, c, ky, kz), none) << b.low;
      EXPECT_LE(floquet(b.high + step, c, ky, kz), none) << b.high;
      if (b.high - b.low > 4 * step) {
        EXPECT_GT(floquet(b.low + step, c, ky, kz), none) << b.low;
        EXPECT_GT(floquet(b.high - step, c, ky, kz), none) << b.high;
      }
      widest = std::max(widest, b.high - b.low);
    }
    EXPECT_GT(widest, 1.0);
    // and nothing is missed on the grid
    for (std::size_t k = 0; k < r.speeds.size(); ++k)
      if (r.growth[k] > 1e-3 || floquet(r.speeds[k], c, ky, kz) > 1e-3) {
        EXPECT_NEAR(r.growth[k], floquet(r.speeds[k], c, ky, kz),
                    1e-4 * std::abs(r.growth[k]) + 1e-4)
            << r.speeds[k];
      }
  }
}

namespace {

/// A flat shaft of 1 m with a disk in its middle, of weight `gravity`, on supports of 1e8 N/m in y
/// and of kz.
system::System flat_shaft(const std::string& gravity, const std::string& kz) {
  const deck::Deck d = deck::read_deck_text(R"(format = 1
[model]
gravity = ")" + gravity + R"("
[[shaft]]
name = "R"
material = "steel"
damping = { internal_beta = "2e-6 s", external_beta = "1e-5 s" }
[[shaft.section]]
name = "a"
length = "1000 mm"
min_elements = 8
general = { A = "1200 mm^2", Iy = "150000 mm^4", Iz = "100000 mm^4", J = "170000 mm^4", kappa_y = 0.85, kappa_z = 0.85 }
[[disk]]
at = "a:mid"
mass = "20 kg"
Ip = "0.2 kg.m^2"
Id = "0.11 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = ")" + kz + R"("
cyy = "100 N.s/m"
czz = "100 N.s/m"
[[bearing]]
at = "a:end"
type = "linear"
kyy = "1e8 N/m"
kzz = ")" + kz + R"("
cyy = "100 N.s/m"
czz = "100 N.s/m"
)",
                                            "flat shaft");
  EXPECT_TRUE(d.ok()) << d.report();
  return std::move(assembly::build_system(d.model, meshes::make_mesh(d.model), "").system);
}

}  // namespace

// The sag of a rotor makes its matrices periodic, by so little that one harmonic is enough and the
// band is that of the rotor without weight. Its edges and its top take some dozen speeds, not a
// bisection each.
TEST(AsymmetricShaft, SagTakesOneHarmonicAndFewSpeeds) {
  const double from = 500 * pi / 30, to = 4000 * pi / 30;
  BandResult found[2];
  for (const bool heavy : {false, true}) {
    const system::System s = flat_shaft(heavy ? "9.80665 m/s^2" : "0 m/s^2", "1e8 N/m");
    Linearizer linear(s);
    RotatingAxes axes(linear, to);
    EXPECT_EQ(axes.harmonics(), heavy ? 1 : 0);
    BandOptions o;
    for (int k = 0; k < 8; ++k)
      o.speeds.push_back(from + (to - from) * k / 7);
    int told = 0;
    o.progress = [&](double share, double) {
      EXPECT_GE(share, 0.0);
      EXPECT_LE(share, 1.0);
      ++told;
    };
    found[heavy] = find_bands(axes, o);
    ASSERT_EQ(found[heavy].bands.size(), 1u);
    EXPECT_GE(told, 8);
    EXPECT_LT(found[heavy].evaluations, 110);
  }
  const InstabilityBand &light = found[0].bands[0], &heavy = found[1].bands[0];
  EXPECT_NEAR(heavy.low, light.low, 1e-6 * light.low);
  EXPECT_NEAR(heavy.high, light.high, 1e-6 * light.high);
  EXPECT_NEAR(heavy.growth, light.growth, 1e-4 * light.growth);
  const system::System unequal = flat_shaft("9.80665 m/s^2", "2e6 N/m");
  Linearizer linear(unequal);
  EXPECT_EQ(RotatingAxes(linear, to).harmonics(), 3);
}

// Weight on an asymmetric shaft at half its critical speed, through the deck of an example: with w
// = y + i z
//   m w'' + c w' + kb w + d exp(2 i Omega t) conj(w) = -i m g
// has the exact steady solution w = W0 + W2 exp(2 i Omega t).
TEST(AsymmetricShaft, TwicePerTurnUnderGravity) {
  Record record("Asymmetric shaft under gravity at half its critical speed",
                "exact solution of the Jeffcott rotor: steady sag and motion at twice the speed");
  std::ifstream file(WHIRL_SOURCE "/examples/15_twice_per_turn/deck.toml");
  std::stringstream text;
  text << file.rdbuf();
  const DeckRun r(text.str());
  ASSERT_EQ(r.exit, 0) << r.log;
  const double Omega = 158, c = 100, g = 9.81, kb = 0.5 * (k1 + k2), d = 0.5 * (k2 - k1);
  const Complex D(kb - 4 * m * Omega * Omega, 2 * Omega * c),
      W0 = Complex(0, -m * g) / (kb - d * d / std::conj(D)), W2 = -d * std::conj(W0) / D;
  // least squares on the last tenth of a second
  Complex E = 0, S0 = 0, S2 = 0;
  const auto rows = r.csv("run.csv").rows;
  ASSERT_GT(rows.size(), 90u);
  const double n = static_cast<double>(rows.size());
  for (const auto& x : rows) {
    const Complex e = std::polar(1.0, 2 * Omega * x[0]), w(x[1], x[2]);
    E += e / n;
    S0 += w / n;
    S2 += std::conj(e) * w / n;
  }
  const Complex X0 = (S0 - E * S2) / (1 - std::norm(E)),
                X2 = (S2 - std::conj(E) * S0) / (1 - std::norm(E));
  // 158 rad/s is so near half the critical speed that 1e-7 of the stiffness is 3e-6 of the motion:
  // what large rotation and the step leave
  record.check("motion at twice the speed", "m", std::abs(X2), std::abs(W2), 1e-5 * std::abs(W2));
  record.check("steady y", "m", X0.real(), W0.real(), 1e-5 * std::abs(W0));
  record.check("steady z", "m", X0.imag(), W0.imag(), 1e-5 * std::abs(W0));
}
