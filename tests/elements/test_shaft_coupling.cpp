// Flexible coupling between two shaft lines.
#include "conformance.hpp"
#include <elements/supports/linear_bearing.hpp>
#include <elements/between_shafts/shaft_coupling.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

ShaftCoupling disc_pack() {
  ShaftCoupling k;
  k.K.diagonal() << 200, 500, 300, 80, 40, 25;
  k.K(1, 5) = k.K(5, 1) = 20;
  k.K(2, 4) = k.K(4, 2) = -15;
  k.K(0, 3) = k.K(3, 0) = 4;
  k.C.diagonal() << 2, 3, 4, 1, 0.5, 0.7;
  k.offset = Vec3(0.02, -0.05, 0.03);
  k.angle = Vec2(0.02, -0.04);
  return k;
}

}  // namespace

TEST(ShaftCoupling, Conformance) {
  ConformanceOptions o;
  o.symmetric_K = true;
  o.tilt = 0.4;
  o.phi = 1.0;
  check_kernel(disc_pack(), o);
  o.chart = tilted_chart();
  check_kernel(disc_pack(), o);
}

TEST(ShaftCoupling, IsotropicIsALinearBearing) {
  ShaftCoupling k;
  k.K.diagonal() << 200, 500, 500, 80, 40, 40;
  k.offset = Vec3(0.0, 1e-3, -2e-3);
  k.angle = Vec2(2e-3, 1e-3);
  // rx, ry, rz of the linear bearing: tilts -tau_z, tau_y; the setpoint is minus the misalignment
  Vector<6> set;
  set << -k.offset, 0.0, k.angle.y(), -k.angle.x();
  const LinearBearing b(k.K, Matrix<6>::Zero(), Matrix<6>::Zero(), set, Vector<6>::Zero());
  Random r(4);
  Vector<12> q = 0.1 * r.vector<12>(), v = r.vector<12>();
  const Mat3 chart = Mat3::Identity();
  NodeFrame<2, 7> x(q, v, v, chart, Vec3::Zero());
  x.state[0].turns = 7;
  x.state[1].turns = 5;  // wound up by two turns
  system::ForceX<14> f = Vector<14>::Zero(), g = f;
  k.add_force(x.nodes(), {}, f);
  b.add_force(x.nodes(), {}, g);
  EXPECT_LT((f - g).norm(), 1e-12 * g.norm());
  EXPECT_GT(f[6], 80 * (2 * two_pi - 1));
}

TEST(ShaftCoupling, ParallelMisalignmentShakesAtTwiceTheSpin) {
  // unequal stiffness k_1, k_2 and offset o along y: force (k_1+k_2)/2 o + (k_1-k_2)/2 o (cos 2
  // psi, sin 2 psi); no work over a turn
  ShaftCoupling k;
  k.K.diagonal() << 0, 900, 500, 10, 0, 0;
  k.offset = Vec3(0, 1e-3, 0);
  double work = 0;
  for (int i = 0; i < 64; ++i) {
    const double psi = two_pi * i / 64;
    Vector<12> q = Vector<12>::Zero(), zero = q;
    q[3] = q[9] = psi;
    const Mat3 chart = Mat3::Identity();
    const NodeFrame<2, 7> x(q, zero, zero, chart, Vec3::Zero());
    system::ForceX<14> f = Vector<14>::Zero();
    k.add_force(x.nodes(), {}, f);
    EXPECT_NEAR(f[1], 1e-3 * (700 + 200 * std::cos(2 * psi)), 1e-12);
    EXPECT_NEAR(f[2], 1e-3 * 200 * std::sin(2 * psi), 1e-12);
    EXPECT_NEAR(f[6], f[13],
                1e-15);  // no twist: the torque of the misalignment acts on both hubs alike
    work += f[6] + f[13];
  }
  EXPECT_NEAR(work, 0.0, 1e-12);
}

TEST(ShaftCoupling, AngularMisalignmentGivesAMoment) {
  ShaftCoupling k;
  k.K.diagonal() << 0, 0, 0, 0, 60, 60;
  k.angle = Vec2(0, -0.01);  // tau_z = -0.01: a rotation of +0.01 rad about y
  Vector<12> q = Vector<12>::Zero();
  const Mat3 chart = Mat3::Identity();
  const NodeFrame<2, 7> x(q, q, q, chart, Vec3::Zero());
  system::ForceX<14> f = Vector<14>::Zero();
  k.add_force(x.nodes(), {}, f);
  const Vec3 moment = -Vec3::UnitX().cross(f.segment<3>(3));  // on hub 0; f stands on the left
  EXPECT_NEAR(moment.y(), -0.6, 1e-14);                       // turns it back about y
  EXPECT_NEAR(moment.z(), 0.0, 1e-14);
}
