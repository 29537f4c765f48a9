// What turns a shaft, one law at a time, against the closed form of J s' = T(t, s) for a rotor that
// only spins.
#include "jeffcott.hpp"

#include <gtest/gtest.h>
#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

constexpr double J = 0.05;

/// Spins at the times, from spin0.
std::vector<double> spins(elements::TorqueLaw law, double spin0, const std::vector<double>& times) {
  Jeffcott j;
  j.k = 0.0;
  j.e = 0.0;
  j.J = J;
  j.driven = true;
  j.torque = std::move(law);
  std::vector<double> out;
  for (const At::Sample& s : run(j, times.back(), 1e-9, spin0, times).samples)
    out.push_back(s.spin);
  return out;
}

const std::vector<double> times{0.1, 0.25, 0.5, 0.8, 1.0};

/// The tolerance 1e-9 bounds the angle's error, 1e-9 rad a second here; speeds are of the order 100
/// rad/s: 1e-8 of them is asserted.
template <class F>
void expect(const std::vector<double>& found, F&& exact, double tolerance = 1e-8) {
  ASSERT_EQ(found.size(), times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double e = exact(times[i]);
    EXPECT_NEAR(found[i], e, tolerance * std::max(std::abs(e), 1.0)) << "t = " << times[i];
  }
}

}  // namespace

TEST(Drives, ConstantPower) {
  elements::TorqueLaw law;
  law.power = {1000.0, 1e6};
  expect(spins(law, 50.0, times),
         [](double t) { return std::sqrt(50.0 * 50.0 + 2.0 * 1000.0 * t / J); });
}

TEST(Drives, ConstantPowerIsLimitedNearStandstill) {
  // torque 20 N m up to 50 rad/s, then 1 kW
  elements::TorqueLaw law;
  law.power = {1000.0, 20.0};
  const double t1 = J * 50.0 / 20.0;
  expect(
      spins(law, 0.0, times),
      [&](double t) { return t < t1 ? 20.0 * t / J : std::sqrt(2500.0 + 2000.0 * (t - t1) / J); },
      3e-8);  // the law has a corner at 50 rad/s, inside a step: three such errors
}

TEST(Drives, Windage) {
  elements::TorqueLaw law;
  law.quadratic = 1e-3;
  expect(spins(law, 200.0, times), [](double t) { return 200.0 / (1.0 + 1e-3 * 200.0 * t / J); });
  // against a negative spin it pushes the other way
  expect(spins(law, -200.0, times), [](double t) { return -200.0 / (1.0 + 1e-3 * 200.0 * t / J); });
}

TEST(Drives, ViscousCoastDown) {
  elements::TorqueLaw law;
  law.viscous = 0.1;
  expect(spins(law, 300.0, times), [](double t) { return 300.0 * std::exp(-0.1 * t / J); });
}

TEST(Drives, BrakeStopsTheShaftAndHoldsIt) {
  // 10 N m from 0.2 s on: 100 rad/s are gone after J 100/10 = 0.5 s more
  elements::TorqueLaw law;
  law.brake = make_piecewise({0.0, 0.2}, {make_constant(0.0), make_constant(10.0)});
  const std::vector<double> found = spins(law, 100.0, times);
  expect({found[0], found[1], found[2], 0, 0},
         [](double t) { return t < 0.2 ? 100.0 : std::max(0.0, 100.0 - 10.0 * (t - 0.2) / J); });
  // dry friction is smoothed below 0.05 rad/s, where it acts as a viscous one: what is left decays
  // with J 0.05/10 = 0.25 ms
  EXPECT_LT(std::abs(found[3]), 1e-9);
  EXPECT_LT(std::abs(found[4]), 1e-9);
}

TEST(Drives, DirectCurrentLine) {
  elements::TorqueLaw law;
  law.dc = {8.0, 300.0};
  expect(spins(law, 0.0, times),
         [](double t) { return 300.0 * (1.0 - std::exp(-8.0 * t / (300.0 * J))); });
}

TEST(Drives, InductionMotor) {
  // Kloss with slip z: J N dz/dt = -2 Tb/(z/zb + zb/z), so (z0^2 - z^2)/(2 zb) + zb ln(z0/z) = 2 Tb
  // t/(J N)
  elements::TorqueLaw law;
  const double Tb = 20.0, zb = 0.2, N = 157.0;
  law.induction = {Tb, zb, N};
  expect(spins(law, 0.0, times), [&](double t) {
    double a = 1e-300, b = 1.0;  // slip, by bisection of its logarithm
    for (int k = 0; k < 2000; ++k) {
      const double z = std::sqrt(a * b);
      ((1.0 - z * z) / (2.0 * zb) - zb * std::log(z) > 2.0 * Tb * t / (J * N) ? a : b) = z;
    }
    return N * (1.0 - b);
  });
}

TEST(Drives, ControllerWithASpeedTarget) {
  // x = target - s: J x'' + kp x' + ki x = 0, x(0) = target, x'(0) = -kp target/J
  elements::TorqueLaw law;
  const double target = 120.0, kp = 0.4, ki = 2.0;
  law.governor = {target, kp, ki, infinity, 0.0};
  const Complex root = std::sqrt(Complex(kp * kp - 4.0 * J * ki, 0.0)),
                s1 = (-kp + root) / (2.0 * J), s2 = (-kp - root) / (2.0 * J);
  const double v0 = -kp * target / J;
  const Complex a = (v0 - s2 * target) / (s1 - s2), b = target - a;
  expect(spins(law, 0.0, times),
         [&](double t) { return target - (a * std::exp(s1 * t) + b * std::exp(s2 * t)).real(); });
}

TEST(Drives, TorqueAgainstSpeedTable) {
  // 10 N m at rest to 2 N m at 200 rad/s: s' = (10 - 0.04 s)/J
  elements::TorqueLaw law;
  law.speed = {0.0, 200.0};
  law.torque = {10.0, 2.0};
  expect(spins(law, 0.0, {0.1, 0.25, 0.5, 0.8, 1.0}), [](double t) {
    const double t1 = -J / 0.04 * std::log(1.0 - 0.04 * 200.0 / 10.0);  // reaches 200 rad/s
    return t < t1 ? 250.0 * (1.0 - std::exp(-0.04 * t / J)) : 200.0 + 2.0 * (t - t1) / J;
  });
}

TEST(Drives, TorqueOfTimeAndPrescribedSpeedAgree) {
  // torque pulse of half a second: s = T t/J, then constant
  elements::TorqueLaw law;
  law.of_time = make_piecewise({0.0, 0.5}, {make_constant(4.0), make_constant(0.0)});
  expect(spins(law, 10.0, times), [](double t) { return 10.0 + 4.0 * std::min(t, 0.5) / J; });
}
