// Rigid disk, rigid body, unbalance, point mass: the conformance suite, and Newton-Euler written
// out independently.
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/loads/unbalance.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

ConformanceOptions free_body() {
  ConformanceOptions o;
  o.objective = true;
  o.chart = tilted_chart();
  return o;
}

const RigidDisk disk{5.0, 0.08, 0.15, 0.2};

RigidBody lopsided() {
  Mat3 J;
  J << 0.20, 0.03, -0.02, 0.03, 0.15, 0.01, -0.02, 0.01, 0.12;
  return RigidBody(3.0, Vec3(0.1, 0.05, -0.08), J);
}

}  // namespace

TEST(RigidDisk, Conformance) {
  check_kernel(disk, free_body());
  ConformanceOptions far = free_body();
  far.tilt = 2.2;
  far.seed = 2;  // beyond the usual switch of chart
  check_kernel(disk, far);
}

TEST(RigidBody, Conformance) {
  check_kernel(lopsided(), free_body());
  ConformanceOptions far = free_body();
  far.tilt = 2.2;
  far.seed = 2;
  check_kernel(lopsided(), far);
}

TEST(Unbalance, Conformance) {
  ConformanceOptions o = free_body();
  o.semidefinite_M = false;  // the static moment alone is a difference of bodies
  check_kernel(UnbalanceMass(0.03, 0.4), o);
  check_kernel(UnbalanceMass(0.03, 0.4, nullptr, -0.3), o);
  check_kernel(UnbalanceMass(0.03, -2.0, make_smooth_step(0, 2, 0.3, 1.7)), o);
  o.position = {Vec3::Zero(), Vec3(0.2, 0, 0)};
  check_kernel(LightUnbalance(0.03, 0.4, nullptr, -0.3), o);
  check_kernel(LightUnbalance(0.03, -2.0, make_smooth_step(0, 2, 0.3, 1.7)), o);
}

TEST(PointMass, Conformance) {
  ConformanceOptions o = free_body();
  check_kernel(PointMass{2.5}, o);
}

namespace {

// Newton and Euler about the mass centre, from rotation tensors alone: resultant force on the body
// and moment about the node that the motion needs, less gravity.
struct Needed {
  Vec3 force, moment;
};

Needed newton_euler(double m, const Vec3& eps, const Mat3& J, const Vec2& g, double phi,
                    const Vec3& omega, const Vec3& domega, const Vec3& a, const Mat3& chart) {
  const Mat3 R = chart * rotation::L(Vec3(0, g.x(), g.y())) * rotation::L(Vec3(phi, 0, 0));
  const Vec3 w = chart * omega, dw = chart * domega, r = R * eps;
  const Mat3 Js = R * J * R.transpose();
  const Vec3 ac = a + dw.cross(r) + w.cross(w.cross(r));
  return {m * ac, Js * dw + w.cross(Js * w) + r.cross(m * ac)};
}

template <class K>
void compare_with_newton_euler(const K& k, double m, const Vec3& eps, const Mat3& J) {
  Random r(5);
  for (int n = 0; n < 40; ++n) {
    Vector<6> q, v, a;
    q << r.vector<3>(), 3 * r.number(), 2.5 * r.number() * r.direction<2>();
    v << r.vector<3>(), 40 * r.number(), 3 * r.vector<2>();
    a << 5 * r.vector<3>(), 9 * r.number(), 5 * r.vector<2>();
    const Mat3 chart = r.rotation();
    const Vec3 gravity(0, 1, -9.81);
    const NodeFrame<1, 7> x(q, v, a, chart, gravity);
    system::ForceX<7> f = Vector<7>::Zero();
    k.add_force(x.nodes(), {0.0, gravity}, f);
    const auto& s = x.state[0];
    const Vec3 fd = f.segment<3>(3), F = f.head<3>();
    const Vec3 moment = s.d().cross(fd) + f[6] * (s.e() + s.d()) / (1 + s.e().dot(s.d()));
    const Vec2 g = q.tail<2>();
    const Needed e =
        newton_euler(m, eps, J, g, q[3], rotation::omega_of_rates(g, v[3], v.tail<2>()),
                     rotation::omega_rate_of_rates(g, v[3], v.tail<2>(), a[3], a.tail<2>()),
                     a.head<3>() - gravity, chart);
    // 1e-12 of forces up to m r s^2 (s = 40 rad/s): rounding of the two computations
    const double size = 1e-12 * (e.force.norm() + e.moment.norm() + m * 1600);
    EXPECT_LT((F - e.force).norm(), size);
    EXPECT_LT((moment - e.moment).norm(), size * (1 + J.norm()));
    // kinetic energy
    const Mat3 R = chart * rotation::L(Vec3(0, g.x(), g.y())) * rotation::L(Vec3(q[3], 0, 0));
    const Vec3 w = chart * rotation::omega_of_rates(g, v[3], v.tail<2>()),
               vc = v.head<3>() + w.cross(R * eps);
    system::Energy en;
    k.add_energy(x.nodes(), {0.0, gravity}, en);
    const double T = 0.5 * m * vc.squaredNorm() + 0.5 * w.dot(R * J * R.transpose() * w);
    EXPECT_NEAR(en.kinetic, T, 1e-13 * T);
    // inertia() describes the same body, about the node
    const system::RigidInertia in = k.inertia(0.0);
    EXPECT_NEAR(in.mass, m, 1e-15 * m);
    EXPECT_LT((in.moment - m * eps).norm(), 1e-15 * m);
    EXPECT_LT(
        (in.J - J - m * (eps.squaredNorm() * Mat3::Identity() - eps * eps.transpose())).norm(),
        1e-14 * in.J.norm());
  }
}

}  // namespace

TEST(RigidDisk, IsNewtonEuler) {
  compare_with_newton_euler(disk, disk.mass, Vec3(disk.offset, 0, 0),
                            Vec3(disk.Jp, disk.Jt, disk.Jt).asDiagonal());
}

TEST(RigidBody, IsNewtonEuler) {
  Mat3 J;
  J << 0.20, 0.03, -0.02, 0.03, 0.15, 0.01, -0.02, 0.01, 0.12;
  compare_with_newton_euler(lopsided(), 3.0, Vec3(0.1, 0.05, -0.08), J);
}

TEST(Unbalance, IsTheOffsetMassCentreOfADisk) {
  // disk about the node + static moment = body with its mass centre at eps and inertia about the
  // mass centre less m eps^2
  const double m = 5, eps = 0.01, beta = 0.7, Jp = 0.15, Jt = 0.08;
  const Vec3 arm(0, eps * std::cos(beta), eps * std::sin(beta));
  const Mat3 about_station = Vec3(Jp, Jt, Jt).asDiagonal();
  for (double station : {0.0, 0.2}) {  // from the node along the shaft
    const RigidBody body(
        m, arm + Vec3(station, 0, 0),
        about_station - m * (eps * eps * Mat3::Identity() - arm * arm.transpose()));
    const RigidDisk centred{m, Jt, Jp, station};
    const UnbalanceMass u(m * eps, beta, nullptr, station);
    system::RigidInertia parts = centred.inertia(0.0);
    parts += u.inertia(0.0);
    const system::RigidInertia whole = body.inertia(0.0);
    EXPECT_LT((parts.J - whole.J).norm(), 1e-14 * whole.J.norm());
    EXPECT_LT((parts.moment - whole.moment).norm(), 1e-14 * whole.moment.norm());
    Random r(6);
    for (int n = 0; n < 20; ++n) {
      const Vector<6> q = r.vector<6>(), v = 5 * r.vector<6>(), a = 9 * r.vector<6>();
      const Mat3 chart = r.rotation();
      const NodeFrame<1, 7> x(q, v, a, chart, Vec3(0, 0, -9.81));
      const system::Context c{0.0, Vec3(0, 0, -9.81)};
      system::ForceX<7> f1 = Vector<7>::Zero(), f2 = f1;
      body.add_force(x.nodes(), c, f1);
      centred.add_force(x.nodes(), c, f2);
      u.add_force(x.nodes(), c, f2);
      EXPECT_LT((x.J.transpose() * (f1 - f2)).norm(), 1e-13 * f1.norm());
    }
  }
}

TEST(RigidDisk, SmallTiltGivesTheTextbookGyroscopicMatrix) {
  // linear rotor: Jt gamma2'' + Jp Omega gamma3' = m_y, Jt gamma3'' - Jp Omega gamma2' = m_z
  const double Omega = 300.0;
  Vector<6> q = Vector<6>::Zero(), v = q, a = q;
  v[3] = Omega;
  const Mat3 chart = Mat3::Identity();
  const NodeFrame<1, 7> x(q, v, a, chart, Vec3::Zero());
  system::TangentX<7> t;
  t.set_zero();
  RigidDisk{5.0, 0.08, 0.15, 0}.add_tangent(x.nodes(), {}, t);
  const Matrix<6> C = x.J.transpose() * (t.C * x.J + 2.0 * t.M * x.J1),
                  M = x.J.transpose() * t.M * x.J;
  EXPECT_NEAR(C(4, 5), 0.15 * Omega, 1e-13);
  EXPECT_NEAR(C(5, 4), -0.15 * Omega, 1e-13);
  EXPECT_NEAR(M(4, 4), 0.08, 1e-16);
  EXPECT_NEAR(M(5, 5), 0.08, 1e-16);
  EXPECT_NEAR(M(3, 3), 0.15, 1e-16);
  EXPECT_NEAR(C.cwiseAbs().sum(), 2 * 0.15 * Omega, 1e-12);
}

TEST(RigidBody, SkewedDiskTensor) {
  const Mat3 J = skewed_inertia(0.15, 0.08, 0.1, pi / 2);
  EXPECT_NEAR(J.trace(), 0.31, 1e-15);
  const Vec3 axis(std::cos(0.1), 0, std::sin(0.1));
  EXPECT_LT((J * axis - 0.15 * axis).norm(), 1e-16);
}

TEST(RigidBody, ImpossibleBodiesAreRefused) {
  EXPECT_THROW(RigidBody(-1, Vec3::Zero(), Mat3::Identity()), Error);
  EXPECT_THROW(RigidBody(1, Vec3::Zero(), Mat3(Vec3(1, 1, 3).asDiagonal())), Error);
  EXPECT_THROW(RigidBody(1, Vec3::Zero(), Mat3(Vec3(1, 1, -1).asDiagonal())), Error);
  Mat3 J = Mat3::Identity();
  J(0, 1) = 0.2;
  EXPECT_THROW(RigidBody(1, Vec3::Zero(), J), Error);
  EXPECT_NO_THROW(RigidBody(1, Vec3::Zero(), Mat3(Vec3(2, 1, 1).asDiagonal())));
}
