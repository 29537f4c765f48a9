// Rigid bodies with known motions, as systems with their initial states.
#pragma once
#include <core/rotation.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <system/system.hpp>
#include <cmath>

namespace whirl::test {

struct RigidCase {
  system::System system;
  system::State start;
};

inline RigidCase finish(system::Builder& b) {
  RigidCase c{b.finalize(), {}};
  c.start = c.system.make_state();
  return c;
}

/// Heavy top of Geradin, Cardona, Bruels: m = 15 kg, mass centre 1 m from the fixed point along
/// body y, J = (0.234375, 0.46875, 0.234375) kg m2 about it, g = 9.81 along -z, omega = (0, 150,
/// -4.61538) rad/s. Bruels, Cardona, Arnold, Mech. Mach. Theory 48 (2012) 121, doi
/// 10.1016/j.mechmachtheory.2011.07.017. The chart axis e is y: (e, e2, e3) = (y, z, x).
inline RigidCase heavy_top() {
  system::Builder b;
  Mat3 triad;
  triad << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Index line = b.add_line("top", triad), n = b.add_node({Vec3::Zero(), line, "pivot"});
  for (int c = 0; c < 3; ++c)
    b.hold(n, c);
  b.add(elements::RigidDisk{15.0, 0.234375, 0.46875, 1.0}, {n}, "top");
  b.set_gravity(Vec3(0, 0, -9.81));
  RigidCase c = finish(b);
  c.start.v << 0, 0, 0, 150.0, -4.61538, 0.0;
  return c;
}

struct TopPoint {
  double t;
  Vec3 centre;
};
/// DOP853 with rtol 1e-13; Bruels et al. at dt = 2e-6 agree to 1e-6 at t = 2 s.
inline const TopPoint heavy_top_table[] = {
    {0.1, {0.421296658925, 0.894571974346, -0.149164700562}},
    {0.5, {-0.702468297057, -0.021165184702, -0.711400257652}},
    {1.0, {0.173343964098, 0.64008859207, -0.748490791134}},
    {2.0, {-0.150416822746, -0.724165591637, -0.67302226956}}};
inline constexpr double heavy_top_energy = 5435.6967908;

/// Free body J = diag(1, 2, 3) kg m2, spun about its middle axis: omega0 = (eps, 5, eps) rad/s;
/// chart axis e = body 1.
inline RigidCase free_top(double eps) {
  system::Builder b;
  const Index n = b.add_node({Vec3::Zero(), b.add_line("body"), "body"});
  b.add(elements::RigidBody(1.0, Vec3::Zero(), Mat3(Vec3(1, 2, 3).asDiagonal())), {n}, "body");
  RigidCase c = finish(b);
  c.start.v << 0, 0, 0, eps, 5.0, eps;
  return c;
}

/// Symmetric top about a fixed point: transverse inertia 0.02, axial 0.01 kg m2, m g l = 1.5696 N
/// m, axis 30 degrees from the vertical (the chart axis), released with pure spin 200 rad/s.
inline RigidCase symmetric_top() {
  system::Builder b;
  Mat3 triad;
  triad << 0, 1, 0, 0, 0, 1, 1, 0, 0;  // (z, x, y)
  const Index line = b.add_line("top", triad), n = b.add_node({Vec3::Zero(), line, "pivot"});
  for (int c = 0; c < 3; ++c)
    b.hold(n, c);
  const double m = 10.0, l = 0.016;
  b.add(elements::RigidDisk{m, 0.02 - m * l * l, 0.01, l}, {n}, "top");
  b.set_gravity(Vec3(0, 0, -9.81));
  RigidCase c = finish(b);
  const Vec2 gamma(pi / 6, 0);
  const Vec3 d = rotation::L(Vec3(0, gamma.x(), gamma.y())).col(0);
  const auto rates = rotation::rates_of_omega(gamma, 200.0 * d);
  c.start.q.tail<2>() = gamma;
  c.start.v[3] = rates.phi;
  c.start.v.tail<2>() = rates.gamma;
  return c;
}

/// Rigid rotor on two isotropic springs: m = 122.68 kg, Id = 2.8625, Ip = 0.6134 kg m2, 1.0e6 and
/// 1.3e6 N/m at -0.25 and +0.25 m from the mass centre (a rotor of the size of Friswell et al.,
/// Dynamics of Rotating Machines, 2010, ch. 3).
inline RigidCase rigid_rotor(double spin) {
  system::Builder b;
  const Index line = b.add_line("rotor"), n = b.add_node({Vec3::Zero(), line, "rotor"});
  const Index ground = b.add_ground(Vec3::Zero(), "ground");
  b.add(elements::RigidDisk{122.68, 2.8625, 0.6134, 0.0}, {n}, "rotor");
  const Matrix<6> zero = Matrix<6>::Zero();
  for (const auto& [k, s] : {std::pair{1.0e6, -0.25}, std::pair{1.3e6, 0.25}}) {
    Matrix<6> K = zero;
    K(1, 1) = K(2, 2) = k;
    b.add(elements::LinearBearing(K, zero, zero, Vector<6>::Zero(), Vector<6>::Zero(), s, s),
          {n, ground}, "bearing");
  }
  b.hold(n, 0);
  RigidCase c = finish(b);
  c.start.v[3] = spin;
  return c;
}

}  // namespace whirl::test
