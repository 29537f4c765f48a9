// Magnetic bearings: conformance of magnet and signals, the force law and its limits, stages of
// controllers against their transfer functions.
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/magnetic/magnet.hpp>
#include <elements/magnetic/signal.hpp>
#include <elements/magnetic/transfer.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

constexpr Magnet linear{.per_current = 250, .per_displacement = 1.5e6};
constexpr Magnet magnetic{
    .per_current = 200, .per_displacement = 1.1e6, .bias = 3, .gap = 0.5e-3, .saturation = 600};

MagnetJoint<true> joint_of(const Magnet& m) {
  MagnetJoint<true> out;
  out.magnet = m;
  out.axis = {Vec2(std::cos(0.4), std::sin(0.4)), Vec2(-std::sin(0.4), std::cos(0.4))};
  out.current_unit = 6000;
  out.offset = {1e-5, 2e-5};
  out.power = make_polynomial({0.7, 0.1});
  return out;
}

ConformanceOptions small_motions() {
  ConformanceOptions o;
  o.u = 1e-4;
  o.du = 1e-2;
  o.ddu = 1.0;
  o.tilt = 0.3;
  o.signals = {2, 3};
  o.over_declared = {.time = true};
  return o;
}

TEST(MagneticBearing, MagnetConforms) {
  for (const Magnet& m : {linear, magnetic}) {
    MagnetJoint<true> varying = joint_of(m);
    check_kernel(varying, small_motions());
    MagnetJoint<false> still;
    still.magnet = m;
    still.current_unit = 6000;
    ConformanceOptions o = small_motions();
    o.over_declared = {};
    check_kernel(still, o);
  }
}

TEST(MagneticBearing, SignalsConform) {
  ConformanceOptions o;
  o.signals = {0};
  check_kernel(SignalState{3.0, -2.0}, o);
  check_kernel(SignalLink{1.5}, o);
  for (const double limit : {0.05, 1.0, 20.0})
    check_kernel(RateLimit{3.0, 2.0, limit}, o);
  check_kernel(Sensor<false>{Vec3(0, 2e5, -1e5), 0.1, 30.0, nullptr}, o);
  check_kernel(Sensor<true>{Vec3(0, 2e5, -1e5), 0.1, 30.0, make_polynomial({0.5, 0.2})}, o);
}

// Small demands are followed, large ones as far as the limit; 2^(-1/8) of it where both are alike.
TEST(MagneticBearing, RateLimit) {
  const RateLimit r{1.0, 1.0, 2.5};
  EXPECT_NEAR(r.followed(0.1).value, 0.1, 1e-12);
  EXPECT_EQ(r.followed(0.0).slope, 1.0);
  EXPECT_NEAR(r.followed(-2.5).value, -2.5 * std::pow(2.0, -0.125), 1e-14);
  EXPECT_NEAR(r.followed(100.0).value, 2.5, 1e-9);
  EXPECT_NEAR(r.followed(-1e30).value, -2.5, 1e-12);
  const double h = 1e-5;
  for (const double q : {-4.0, -2.2, 0.3, 2.5, 3.1})
    EXPECT_NEAR(r.followed(q).slope, (r.followed(q + h).value - r.followed(q - h).value) / (2 * h),
                1e-8);
}

// dF/di = k_i, dF/dx = k_s in the middle; k_i i alone there, by the difference of two squares.
TEST(MagneticBearing, ForceInTheMiddle) {
  Magnet m = magnetic;
  m.saturation = 0;
  const Magnet::Pull still = m.pull(0, 0);
  EXPECT_EQ(still.force, 0.0);
  EXPECT_NEAR(still.by_current, 200, 1e-10);
  EXPECT_NEAR(still.by_displacement, 1.1e6, 1e-6);
  EXPECT_NEAR(m.pull(0, 1.7).force, 340, 1e-10);
  // c = k_i s0^2/(4 i0), b = k_s s0/(k_i i0) = 0.916667: (3 + 1)^2/(0.5 - b 0.1)^2 ..
  const double c = 200 * 0.25e-6 / 12, b = 1.1e6 * 0.5e-3 / 600;
  EXPECT_NEAR(m.pull(1e-4, 1).force,
              c * (16 / std::pow(0.5e-3 - b * 1e-4, 2) - 4 / std::pow(0.5e-3 + b * 1e-4, 2)), 1e-9);
}

// Beyond the bias current one coil is off and the other one pulls with the square of its current.
TEST(MagneticBearing, OneCoilBeyondTheBias) {
  Magnet m = magnetic;
  m.saturation = 0;
  EXPECT_NEAR(m.pull(0, 5).force, 200.0 / 12 * 64, 1e-9);
}

TEST(MagneticBearing, Limits) {
  EXPECT_NEAR(magnetic.pull(0, 60).force, 600, 1.0);
  EXPECT_NEAR(magnetic.pull(0, -60).force, -600, 1.0);
  Magnet limited = linear;
  limited.current_limit = 2;
  EXPECT_NEAR(limited.pull(0, 1).force, 250, 250 * 0.5e-3);  // (1 + 2^-8)^(-1/8)
  EXPECT_NEAR(limited.pull(0, 200).force, 500, 1e-9);
  const double h = 1e-6;
  for (const double i : {-4.0, -1.9, 0.3, 2.1, 50.0})
    EXPECT_NEAR(limited.pull(0, i).by_current,
                (limited.pull(0, i + h).force - limited.pull(0, i - h).force) / (2 * h), 1e-6);
  EXPECT_TRUE(std::isfinite(magnetic.pull(0.01, 1).force));  // beyond the pole
}

Complex of_fraction(std::span<const double> b, std::span<const double> a, Complex s) {
  Complex up = 0, down = 0;
  for (std::size_t k = b.size(); k-- > 0;)
    up = up * s + b[k];
  for (std::size_t k = a.size(); k-- > 0;)
    down = down * s + a[k];
  return up / down;
}

TEST(MagneticBearing, TransferFunctionsAsWritten) {
  const std::vector<double> b{3, 2e-2, 1e-4, 5e-8}, a{0, 1, 4e-3, 2e-6, 1e-9};
  const StateSpace s = make_transfer(b, a);
  const StateSpace proper = make_transfer(std::array{1.0, 2.0, 3.0}, std::array{4.0, 5.0, 6.0});
  for (const double w : {0.1, 7.0, 300.0, 4e4}) {
    const Complex at(0.2, w);
    EXPECT_NEAR(std::abs(s.at(at)(0, 0) / of_fraction(b, a, at) - 1.0), 0, 1e-12);
    const Complex both = of_fraction(b, a, at) *
                         of_fraction(std::array{1.0, 2.0, 3.0}, std::array{4.0, 5.0, 6.0}, at);
    EXPECT_NEAR(std::abs(series(s, proper).at(at)(0, 0) / both - 1.0), 0, 1e-12);
    EXPECT_NEAR(std::abs(rescaled(s, sizes_of_states(s)).at(at)(0, 0) / s.at(at)(0, 0) - 1.0), 0,
                1e-12);
  }
}

// Pade's forms pass all frequencies alike and lag by w T, the better the higher the degree.
TEST(MagneticBearing, DelayLagsByItsTime) {
  const double T = 1e-4;
  double last = 1;
  for (int degree = 1; degree <= 6; ++degree) {
    const StateSpace s = make_delay(T, degree);
    const Complex at(0, 0.5 / T);
    EXPECT_NEAR(std::abs(s.at(at)(0, 0)), 1, 1e-12);
    const double off = std::abs(std::arg(s.at(at)(0, 0)) + 0.5);
    EXPECT_LT(off, std::max(0.02 * last, 1e-12)) << degree;
    last = off;
  }
}

TEST(MagneticBearing, ImproperFractionsAreRefused) {
  EXPECT_THROW(make_transfer(std::array{0.0, 1.0}, std::array{1.0}), Error);
  EXPECT_THROW(make_transfer(std::array{1.0}, std::array{0.0}), Error);
}

}  // namespace
