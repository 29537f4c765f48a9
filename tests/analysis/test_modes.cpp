// Linearisation, whirl modes, Campbell diagram and critical speeds on rotors with known answers.
#include "rotors.hpp"
#include "../validation/deck_model.hpp"

#include <analysis/spectra/campbell.hpp>
#include <analysis/spectra/critical.hpp>
#include <analysis/spectra/stability.hpp>

#include <gtest/gtest.h>

#include <algorithm>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::tests;

namespace {

constexpr double rpm = pi / 30;

}  // namespace

// The matrices at any speed, composed from three evaluations, are those of the tangent itself.
TEST(Linearizer, PolynomialInSpeedIsExact) {
  TwoDisk rotor(9, 1e6, 8e5, 100);
  rotor.add_shaft_damping<true>(1e-5).add_shaft_damping<false>(2e-5).add_unbalance(0.5, 1e-3, 0.3);
  rotor.b.set_gravity(Vec3(0, 0, -9.81));
  const system::System s = rotor.b.finalize();
  SteadyRotation running;
  running.top_speed = 1000;
  SteadySystem sweep(s, running);
  EquilibriumSolver solver(sweep);
  const Equilibrium e = solver.solve(200);
  la::MCK a = s.make_matrices(), b = s.make_matrices();
  sweep.tangent(e.state.frames, 0, e.state.q, b);  // first and second speed make the polynomials
  for (double Omega : {100.0, 1.0, 1000.0, -300.0, 1900.0}) {
    ASSERT_TRUE(sweep.tangent(e.state.frames, Omega, e.state.q, a));
    SteadySystem direct(s);
    ASSERT_TRUE(direct.tangent(e.state.frames, Omega, e.state.q, b));
    for (auto [x, y] : {std::pair{&a.M, &b.M}, std::pair{&a.C, &b.C}, std::pair{&a.K, &b.K}}) {
      const Eigen::Map<const VecX> X(x->data(), static_cast<Index>(x->value_count())),
          Y(y->data(), static_cast<Index>(y->value_count()));
      EXPECT_LT((X - Y).cwiseAbs().maxCoeff(), 1e-13 * Y.cwiseAbs().maxCoeff()) << Omega;
    }
    VecX r, q;
    ASSERT_TRUE(sweep.residual(e.state.frames, Omega, e.state.q, r));
    ASSERT_TRUE(direct.residual(e.state.frames, Omega, e.state.q, q));
    EXPECT_LT((r - q).cwiseAbs().maxCoeff(), 1e-9) << Omega;  // N, of internal forces of 1e3 N
  }
}

// The rotating force of an unbalance is U Omega^2 at its angle, whatever else there is.
TEST(Linearizer, ForcingOfUnbalance) {
  TwoDisk rotor(6);
  rotor.add_unbalance(0.5, 1e-3, 0.3);
  const system::System s = rotor.b.finalize();
  Linearizer linear(s);
  linear.at(250.0);
  ASSERT_EQ(linear.forcing().size(), 1u);
  const VecXc& f = linear.forcing()[0];
  const Index i = rotor.at(0.5);
  // left side: -force. y = U w^2 cos(w t + b), z = U w^2 sin(w t + b)
  const Complex expected = -1e-3 * 250.0 * 250.0 * std::polar(1.0, 0.3);
  EXPECT_LT(std::abs(f[6 * i + 1] - expected), 1e-12 * std::abs(expected));
  EXPECT_LT(std::abs(f[6 * i + 2] - expected * Complex(0, -1)), 1e-12 * std::abs(expected));
}

// Speeds 1 : 1.3 : -0.7 on three lines: each unbalance turns up at its own order, in its own
// direction.
TEST(Linearizer, ForcingOfSeveralLines) {
  system::Builder b;
  std::vector<Index> node;
  for (int k = 0; k < 3; ++k)
    b.add_line("line " + std::to_string(k));  // before the line of the ground points
  for (int k = 0; k < 3; ++k) {
    node.push_back(b.add_node({Vec3(k, 0, 0), k, "node"}));
    b.add(elements::RigidDisk{1.0, 0.01, 0.02, 0}, {node.back()}, "disks");
    b.add(elements::UnbalanceMass(1e-3 * (k + 1), 0.2 * k), {node.back()}, "unbalance");
    elements::TranslationalBearing t;
    t.K = 1e5 * Mat3::Identity();
    b.add(t, {node.back(), b.add_ground(Vec3(k, 0, 0), "ground")}, "bearings");
    b.hold(node.back(), system::gamma2);
    b.hold(node.back(), system::gamma3);
  }
  const system::System s = b.finalize();
  SteadyRotation running;
  running.ratio = {1.0, 1.3, -0.7};
  Linearizer linear(s, running);
  linear.at(100.0);
  ASSERT_EQ(linear.running().orders().size(), 3u);  // 0.7, 1, 1.3
  const int line_of_order[] = {2, 0, 1};
  for (std::size_t o = 0; o < 3; ++o)
    for (int k = 0; k < 3; ++k) {
      const double w = 100.0 * running.ratio[static_cast<std::size_t>(k)], U = 1e-3 * (k + 1);
      const Complex y = linear.forcing()[o][6 * node[static_cast<std::size_t>(k)] + 1],
                    z = linear.forcing()[o][6 * node[static_cast<std::size_t>(k)] + 2];
      if (k != line_of_order[o]) {
        EXPECT_LT(std::abs(y) + std::abs(z), 1e-10);
        continue;
      }
      // Re of f exp(i |r| W t): y = cos(r W t + b)
      const Complex expected = -U * w * w * std::polar(1.0, (w < 0 ? -1 : 1) * 0.2 * k);
      EXPECT_LT(std::abs(y - expected), 1e-11 * std::abs(expected)) << k;
      EXPECT_LT(std::abs(z - expected * Complex(0, w < 0 ? 1 : -1)), 1e-11 * std::abs(expected))
          << k;
    }
}

// A speed-independent rotor keeps its equilibrium in a sweep to the last bit; one with internal
// damping does not.
TEST(Linearizer, EquilibriumFollowsTheSpeed) {
  for (bool internal : {false, true}) {
    TwoDisk rotor(6);
    if (internal) rotor.add_shaft_damping<true>(1e-5);
    rotor.b.set_gravity(Vec3(0, 0, -9.81));
    const system::System s = rotor.b.finalize();
    Linearizer linear(s);
    linear.at(50.0);
    const VecX q = linear.equilibrium().state.q;
    linear.at(90.0);
    EXPECT_EQ(linear.equilibrium().state.q == q, !internal);
    const double sideways = linear.equilibrium().state.q[6 * rotor.at(1.0) + 1];
    // Bending about z sees Omega beta times the bending about y: the sag leans sideways, here by
    // the shaft's share of the sag
    if (internal) {
      EXPECT_GT(std::abs(sideways), 1e-8);
    } else {
      EXPECT_EQ(sideways, 0.0);
    }
  }
}

TEST(WhirlModes, DirectionsKindsAndPairs) {
  TwoDisk rotor(12);
  const system::System s = rotor.b.finalize();
  Linearizer linear(s);
  ModesOptions o;
  o.max_frequency = two_pi * 1500;
  o.count = 0;
  const auto modes = whirl_modes(linear, 4000 * rpm, o);
  int forward = 0, backward = 0, torsional = 0, axial = 0;
  for (const WhirlMode& m : modes) {
    EXPECT_LT(m.residual, 1e-12);
    // An undamped rotor: energy does not change (growth below the rounding of the eigenvalue).
    EXPECT_LT(std::abs(m.damping_ratio), 1e-9);
    if (m.kind == ModeKind::lateral) {
      EXPECT_NEAR(m.lateral, 1.0, 1e-9);
      EXPECT_NEAR(std::abs(m.forwardness), 1.0, 1e-9);  // isotropic: circles
      (m.direction == Direction::forward ? forward : backward)++;
    } else {
      (m.kind == ModeKind::torsional ? torsional : axial)++;
      EXPECT_EQ(m.direction, Direction::none);
    }
  }
  EXPECT_GE(forward, 4);
  EXPECT_GE(backward, 4);
  EXPECT_GE(torsional, 1);
  EXPECT_GE(axial, 1);
}

// Spinning the other way mirrors everything: same frequencies, forward stays "with the spin".
TEST(WhirlModes, ReversedSpin) {
  TwoDisk rotor(6, 1e6, 7e5, 50);
  const system::System s = rotor.b.finalize();
  Linearizer linear(s);
  const auto a = whirl_modes(linear, 400.0), b = whirl_modes(linear, -400.0);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_NEAR(std::abs(a[k].lambda - b[k].lambda), 0.0, 1e-9 * std::abs(a[k].lambda) + 1e-9);
    EXPECT_EQ(a[k].direction, b[k].direction);
  }
}

TEST(WhirlModes, OrbitGeometry) {
  // y = 3 cos t, z = sin t: forward ellipse along e2
  Orbit o = orbit_of(3.0, Complex(0, -1));
  EXPECT_NEAR(o.major, 3, 1e-15);
  EXPECT_NEAR(o.minor, 1, 1e-15);
  EXPECT_NEAR(o.angle, 0, 1e-15);
  // the same turned by 30 degrees and run backward
  const double c = std::cos(pi / 6), d = std::sin(pi / 6);
  o = orbit_of(3 * c - Complex(0, 1) * d, 3 * d + Complex(0, 1) * c);
  EXPECT_NEAR(o.major, 3, 1e-15);
  EXPECT_NEAR(o.minor, -1, 1e-15);
  EXPECT_NEAR(o.angle, pi / 6, 1e-15);
}

// Lines of the Campbell diagram go through crossings: on isotropic supports every lateral line
// keeps its direction at all speeds.
TEST(Campbell, LinesKeepTheirDirectionThroughCrossings) {
  TwoDisk rotor(12);
  const system::System s = rotor.b.finalize();
  Linearizer linear(s);
  CampbellOptions o;
  for (int k = 0; k <= 30; ++k)
    o.speeds.push_back(k * 400 * rpm);
  o.track.modes.count = 14;
  const Campbell c = campbell(linear, o);
  int complete = 0;
  for (const CampbellLine& l : c.lines) {
    if (l.kind != ModeKind::lateral) continue;
    bool whole = true;
    for (std::size_t k = 1; k < o.speeds.size(); ++k) {
      whole = whole && !std::isnan(l.frequency[k]);
      if (std::isnan(l.frequency[k])) continue;
      EXPECT_EQ(l.direction_at[k], l.direction) << l.label << " at " << o.speeds[k];
      // forward lines rise, backward lines fall
      if (!std::isnan(l.frequency[k - 1])) {
        const double slope = l.frequency[k] - l.frequency[k - 1];
        EXPECT_GE(l.direction == Direction::forward ? slope : -slope, -1e-7) << l.label;
      }
    }
    complete += whole;
  }
  EXPECT_GE(complete, 6);
}

// Direct critical speeds: undamped, damped limit, and the frequency at them is n Omega to rounding.
TEST(Critical, OrdersAndDampedLimit) {
  TwoDisk rotor(12), slightly(12, 1e6, 1e6, 1e-3);
  const system::System s = rotor.b.finalize(), t = slightly.b.finalize();
  Linearizer linear(s), damped(t);
  for (double order : {0.5, 1.0, 2.0, 3.0}) {
    CriticalOptions o;
    o.order = order;
    o.max_speed = 9000 * rpm / order;
    const auto a = critical_speeds(linear, o);
    o.damped = true;
    const auto b = critical_speeds(damped, o);
    ASSERT_GE(a.size(), 5u);
    ASSERT_EQ(a.size(), b.size()) << order;
    for (std::size_t k = 0; k < a.size(); ++k) {
      EXPECT_NEAR(a[k].speed, b[k].speed, 1e-7 * a[k].speed);  // damping ratio 1e-6
      EXPECT_NEAR(a[k].mode.frequency, order * a[k].speed, 1e-9 * a[k].frequency);
      EXPECT_NEAR(b[k].mode.frequency, order * b[k].speed, 1e-9 * b[k].frequency);
    }
  }
}

// A shaft made rigid by its modulus, as engineers do: the five modes of the rigid body on its
// springs are all there, to what is left of the shaft's compliance and the rounding of springs a
// billion times softer than the elements they hold.
TEST(WhirlModes, RigidByItsModulus) {
  const double kx = 1e7, ky = 2e7, kz = 3e7;
  for (const double E : {2.1e5, 2.1e7, 2.1e8, 2.1e10}) {  // GPa
    const test::DeckModel m(fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "stiff"
E = "{} GPa"
density = "0 kg/m^3"
[shaft]
material = "stiff"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 500, 50, 4], ["b", 500, 50, 4]]
[[disk]]
name = "mass"
at = "a:end"
mass = "20 kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e7 N/m"
kzz = "3e7 N/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "2e7 N/m"
kzz = "3e7 N/m"
)",
                                        E));
    Linearizer linear(m.built.system, m.running());
    ModesOptions o;
    o.count = 5;
    const auto modes = whirl_modes(linear, 0.0, o);
    ASSERT_EQ(modes.size(), 5u) << E;
    const double exact[5] = {std::sqrt(kx / 20), std::sqrt(2 * ky / 20), std::sqrt(2 * kz / 20),
                             std::sqrt(0.5 * ky / 0.1), std::sqrt(0.5 * kz / 0.1)};
    // compliance of the shaft, 1/(48 EI/L^3) = 1/(3.1e6 N/m) at 210 GPa, against springs of 6e7
    // N/m: half of it in the frequency; rounding: 1e-16 of EA/l
    const double tolerance = 10.0 * 210 / E + 1e-16 * (E * 1e9 * 1.96e-3 / 0.125) / kx;
    for (int k = 0; k < 5; ++k)
      EXPECT_NEAR(modes[static_cast<std::size_t>(k)].frequency, exact[k], tolerance * exact[k])
          << E << " " << k;
  }
}
