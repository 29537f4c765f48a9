// Speeds, reversals, tilts from 1e-12 rad to beyond the chart, and very many revolutions, against
// exact solutions.
#include "../time/dense_problem.hpp"
#include "scene.hpp"
#include <core/law.hpp>
#include <elements/loads/unbalance.hpp>
#include <fmt/format.h>
#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

/// A disk held in place, free to tilt on a spring C2 and to spin.
system::System tilting_disk(double Jt, double Jp, double C2) {
  system::Builder b;
  b.add_line("shaft");
  const Index n = b.add_node({Vec3::Zero(), 0, "disk", false});
  b.add(elements::RigidDisk{1.0, Jt, Jp, 0.0}, {n}, "rigid disks");
  b.add(elements::SpringBlock{0.0, C2, 0.0}, {n}, "spring blocks");
  for (int c = 0; c < 3; ++c)
    b.hold(n, c);
  return b.finalize();
}

}  // namespace

// Jt g'' - i Jp Omega g' + C2 g = 0 for small g = gamma2 + i gamma3: slow and fast precession, 0 to
// 1e6 rpm and both ways.
TEST(Rotation, SpeedsToAMillionRpm) {
  const double Jt = 0.01, Jp = 0.018, C2 = 100.0, g0 = 1e-6, t = 2.0 * pi / 100.0 * 2.3;
  const system::System s = tilting_disk(Jt, Jp, C2);
  for (const char* method : methods)
    for (double rpm : {0.0, 1e-3, 1.0, 1e3, 1e4, 1e5, 1e6, -1e3, -1e6}) {
      const double Omega = rpm * pi / 30.0, G = Jp * Omega, root = std::sqrt(G * G + 4.0 * Jt * C2);
      const double fast = (G + std::copysign(root, G)) / (2.0 * Jt),
                   slow = -C2 / (Jt * fast);  // product of the roots: -C2/Jt
      system::State start = s.make_state();
      start.q[4] = g0;
      start.v[3] = Omega;
      const Complex i(0.0, 1.0);
      const Complex exact =
          g0 / (fast - slow) * (fast * std::exp(i * slow * t) - slow * std::exp(i * fast * t));
      const std::string what = fmt::format("{} {:g} rpm", method, rpm);
      const system::State end = run_ok(s, start, {t, 1.0, method}, what);
      EXPECT_NEAR(end.q[4], exact.real(), aimed * g0) << what;
      EXPECT_NEAR(end.q[5], exact.imag(), aimed * g0) << what;
      EXPECT_NEAR(end.total_phi(0, 0), Omega * t, 1e-9 * std::max(1.0, std::abs(Omega * t)))
          << what;
    }
}

// An unbalanced mass on a spring whose speed is led from +Omega through zero to -Omega: exact
// prescribed angle, against an extrapolated reference solution of m (w'' + e d2/dt2 exp(i phi)) + c
// w' + k w = 0.
TEST(Rotation, ReversalThroughZero) {
  const double m = 3.0, e = 1e-4, k = 3.0e4, c = 30.0, Omega0 = 300.0, T = 1.5;
  system::Builder b;
  b.add_line("shaft");
  const Index n = b.add_node({Vec3::Zero(), 0, "disk", false});
  b.add(elements::RigidDisk{m, 0.01, 0.02, 0.0}, {n}, "rigid disks");
  b.add(elements::UnbalanceMass(m * e, 0.0), {n}, "unbalances");
  add_spring(b, n, isotropic(k), isotropic(c));
  b.hold(n, system::spin_phi,
         make_angle_of_speed(make_polynomial({Omega0, -2.0 * Omega0 / T}), 0.0));
  b.hold(n, 4);
  b.hold(n, 5);
  const system::System s = b.finalize();
  const auto f = [&](double t, const VecX& y) {
    const double phi = Omega0 * t - Omega0 / T * t * t, O = Omega0 - 2.0 * Omega0 / T * t,
                 alpha = -2.0 * Omega0 / T;
    const Complex w(y[0], y[1]), dw(y[2], y[3]), r = std::polar(1.0, phi);
    const Complex a = -(c * dw + k * w) / m - e * (Complex(0.0, alpha) - O * O) * r;
    VecX out(4);
    out << y[2], y[3], a.real(), a.imag();
    return out;
  };
  const VecX exact = time::test::reference(f, 0.0, T, VecX::Zero(4), 600);
  for (const char* method : methods) {
    system::State start = s.make_state();
    start.v[3] = Omega0;
    const system::State end = run_ok(s, start, {T, 1.0, method}, method);
    // largest deflection: two passes of the resonance at 100 rad/s, about e/(2 zeta) = 1e-3 m
    EXPECT_NEAR(end.q[1], exact[0], aimed * 1e-3) << method;
    EXPECT_NEAR(end.q[2], exact[1], aimed * 1e-3) << method;
  }
}

// Plane swing on the central tilt spring: gamma = gamma0 cos(w t) at any amplitude, 1e-12 rad to
// just below pi, where the chart is changed under way. The measure is the angle between the axis
// and its rest position.
TEST(Rotation, TiltsFromTinyToTheChartLimit) {
  const double Jt = 0.02, C2 = 200.0, w = 100.0, t = 2.0 * pi / w * 2.1;
  const system::System s = tilting_disk(Jt, 0.03, C2);
  for (const char* method : methods)
    for (double g0 : {1e-12, 1e-9, 1e-6, 1e-3, 0.1, 1.0, 1.9, 2.5, 3.0}) {
      system::State start = s.make_state();
      start.q[4] = g0;
      const std::string what = fmt::format("{} gamma0 = {:g}", method, g0);
      const system::State end = run_ok(s, start, {t, 1.0, method}, what);
      rotation::Director d;
      rotation::director(end.q.segment<2>(4), d);
      const Vec3 axis = end.frames.axes(0) * (d.t + Vec3::UnitX());
      const double angle = std::atan2(std::hypot(axis.y(), axis.z()), axis.x());
      EXPECT_NEAR(angle, std::abs(g0 * std::cos(w * t)), aimed * (g0 + 1e-13))
          << what;  // 1e-13 rad: floor of error control
    }
}

// Without the change of chart a tumbling body meets the limit at pi: it must be said, with node and
// time.
TEST(Rotation, BeyondTheChartIsDiagnosed) {
  const system::System s = tilting_disk(0.02, 0.03, 0.0);
  system::State start = s.make_state();
  start.v[4] = 10.0;
  const analysis::TransientResult r = run(s, start, {1.0}, {}, false);
  EXPECT_EQ(r.reason, analysis::StopReason::failed);
  EXPECT_NE(r.detail.find("disk"), std::string::npos) << r.detail;
  EXPECT_NE(r.detail.find("pi"), std::string::npos) << r.detail;
  EXPECT_NEAR(r.end.t, pi / 10.0, 1e-2) << r.detail;
  // with it the body turns over and over: 1 s at 10 rad/s from the first direction
  const system::State end = run_ok(s, start, {1.0}, "tumbling");
  rotation::Director d;
  rotation::director(end.q.segment<2>(4), d);
  const Vec3 axis = end.frames.axes(0) * (d.t + Vec3::UnitX());
  EXPECT_NEAR(axis.x(), std::cos(10.0), aimed);
  EXPECT_NEAR(std::abs(axis.z()), std::abs(std::sin(10.0)), aimed);
}

// One million revolutions: phi is known to the last digits of the turn it is in.
TEST(Rotation, AMillionRevolutions) {
  const double Omega = 1e6 * pi / 30.0, t = 60.0;
  const system::System s = tilting_disk(0.01, 0.018, 100.0);
  for (const char* method : methods) {
    system::State start = s.make_state();
    start.v[3] = Omega;
    const system::State end = run_ok(s, start, {t, 1.0, method}, method);
    EXPECT_NEAR(end.total_phi(0, 0), Omega * t, 1e-15 * Omega * t * 4.0)
        << method;  // 6.28e6 rad in double: 9e-10
  }
}
