// Point loads and torques.
#include "conformance.hpp"
#include <elements/loads/moment.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/loads/spin_torque.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

ConformanceOptions general() {
  ConformanceOptions o;
  o.chart = tilted_chart();
  return o;
}

const LawPtr law = make_harmonic(0.4, 1.0, 3.0, 0.2);

TorqueLaw smooth_law() {
  TorqueLaw t;
  t.of_time = law;
  t.friction = 0.3;
  t.friction_speed = 2.0;
  t.viscous = 0.1;
  t.induction = TorqueLaw::Induction{2.0, 0.2, 12.0};
  t.dc = TorqueLaw::DcLine{1.5, 20.0};
  t.brake = make_polynomial({0.1, 0.2});
  t.governor = TorqueLaw::Governor{3.0, 0.7, 0.5, infinity, 0.2};
  t.pulsation = TorqueLaw::Pulsation{4.0, 2, 0.3, {-50, 50}, {0.5, 2.5}};
  return t;
}

}  // namespace

TEST(PointLoad, Conformance) {
  check_kernel(PointForce{Vec3(1, -2, 3), law}, general());
  check_kernel(FixedLoad{Vec3(1, -2, 3), Vec3(-2, 0.5, 1), 0.3, law}, general());
  check_kernel(FixedLoad{Vec3(1, -2, 3), Vec3(-2, 0.5, 1), 0.3, nullptr}, general());
  check_kernel(BodyLoad{Vec3(1, -2, 3), Vec3(-2, 0.5, 1), 0.3, law}, general());
  ConformanceOptions o = general();
  o.objective = true;  // a load that turns with the body needs no fixed axes
  check_kernel(BodyLoad{Vec3(1, -2, 3), Vec3(-2, 0.5, 1), 0.3, nullptr}, o);
}

TEST(PointLoad, FixedMomentAgainstItsClosedForm) {
  // M along e: Q_phi = M cos g, Q_gamma = M (1 - cos g)/g^2 (-gamma3, gamma2)
  const double M = 2.5;
  Random r(4);
  for (int n = 0; n < 10; ++n) {
    Vector<6> q = r.vector<6>(), zero = Vector<6>::Zero();
    const Mat3 chart = tilted_chart();
    const NodeFrame<1, 7> x(q, zero, zero, chart, Vec3::Zero());
    system::ForceX<7> f = Vector<7>::Zero();
    FixedLoad{Vec3::Zero(), M * chart.col(0), 0, nullptr}.add_force(x.nodes(), {}, f);
    const Vector<6> Q = -x.J.transpose() * f;
    const double g = q.tail<2>().norm();
    EXPECT_NEAR(Q[3], M * std::cos(g), 1e-14);
    const Vec2 expected = M * (1 - std::cos(g)) / (g * g) * Vec2(-q[5], q[4]);
    EXPECT_LT((Q.tail<2>() - expected).norm(), 1e-13);
    // and the moment is what was asked for
    EXPECT_LT((moment_of(x.state[0], f.segment<3>(3), f[6]) + M * chart.col(0)).norm(), 1e-14);
  }
}

TEST(PointLoad, BodyMomentTurnsWithTheBody) {
  Random r(5);
  for (int n = 0; n < 10; ++n) {
    const Vector<6> q = r.vector<6>(), v = r.vector<6>(), zero = Vector<6>::Zero();
    const Mat3 chart = r.rotation();
    const NodeFrame<1, 7> x(q, v, zero, chart, Vec3::Zero());
    const Vec3 F = r.vector<3>(), M = r.vector<3>();
    system::ForceX<7> f = Vector<7>::Zero();
    BodyLoad{F, M, 0, nullptr}.add_force(x.nodes(), {}, f);
    const Mat3 R = chart * rotation::L(Vec3(0, q[4], q[5])) * rotation::L(Vec3(q[3], 0, 0));
    EXPECT_LT((f.head<3>() + R * F).norm(), 1e-14);
    EXPECT_LT((moment_of(x.state[0], f.segment<3>(3), f[6]) + R * M).norm(), 1e-14);
  }
}

TEST(SpinTorque, Conformance) {
  check_kernel(JointTorque{smooth_law(), Vec3::UnitX()}, general());
  check_kernel(NormalTorque{smooth_law(), Vec3::UnitX()}, general());
  check_kernel(FixedTorque{smooth_law(), Vec3(0.6, 0.8, 0)}, general());
  // kinked laws, away from their kinks
  TorqueLaw kinked;
  kinked.speed = {-50, 0, 10, 50};
  kinked.torque = {5, 4, 2, -1};
  kinked.quadratic = 0.02;
  kinked.power = TorqueLaw::ConstantPower{30, 20};
  ConformanceOptions o = general();
  o.v0 = {0, 0, 0, 25, 0, 0};
  o.dtilt = 0.5;
  check_kernel(JointTorque{kinked, Vec3::UnitX()}, o);
  check_kernel(NormalTorque{kinked, Vec3::UnitX()}, o);
  for (const double power : {-30.0, -3000.0}) {  // a brake beyond its limit and within it
    kinked.power->power = power;
    check_kernel(JointTorque{kinked, Vec3::UnitX()}, o);
  }
}

TEST(SpinTorque, Directions) {
  TorqueLaw T;
  T.of_time = make_constant(3.0);
  Random r(6);
  for (int n = 0; n < 10; ++n) {
    const Vector<6> q = r.vector<6>(), v = r.vector<6>(), zero = Vector<6>::Zero();
    const Mat3 chart = r.rotation();
    const NodeFrame<1, 7> x(q, v, zero, chart, Vec3::Zero());
    const auto& s = x.state[0];
    const auto moment = [&](const auto& k) {
      system::ForceX<7> f = Vector<7>::Zero();
      k.add_force(x.nodes(), {}, f);
      return Vec3(-moment_of(s, f.template segment<3>(3), f[6]));
    };
    EXPECT_LT((moment(JointTorque{T, {}}) - 3.0 * (s.e() + s.d()) / (1 + s.e().dot(s.d()))).norm(),
              1e-14);
    EXPECT_LT((moment(NormalTorque{T, {}}) - 3.0 * s.d()).norm(), 1e-14);
    EXPECT_LT((moment(FixedTorque{T, Vec3::UnitZ()}) - 3.0 * Vec3::UnitZ()).norm(), 1e-14);
    // the speed each works on
    EXPECT_NEAR((JointTorque{T, {}}.working(s, 0).speed),
                (s.e() + s.d()).dot(s.omega()) / (1 + s.e().dot(s.d())), 1e-14);
    EXPECT_NEAR((NormalTorque{T, {}}.working(s, 0).speed), s.d().dot(s.omega()), 1e-14);
    EXPECT_NEAR((FixedTorque{T, Vec3::UnitZ()}.working(s, 0).speed), s.omega().z(), 1e-14);
  }
}

TEST(TorqueLaw, Terms) {
  TorqueLaw t;
  EXPECT_EQ(t.at(0, 5, 0).T, 0.0);
  t.speed = {0, 10};
  t.torque = {4, 2};
  EXPECT_DOUBLE_EQ(t.at(0, 5, 0).T, 3);
  EXPECT_DOUBLE_EQ(t.at(0, -5, 0).T, 4);
  EXPECT_DOUBLE_EQ(t.at(0, 15, 0).T, 2);
  EXPECT_DOUBLE_EQ(t.at(0, 15, 0).dx, 0);
  t = {};
  t.induction = TorqueLaw::Induction{100, 0.2, 150};
  EXPECT_DOUBLE_EQ(t.at(0, 150, 0).T, 0);
  EXPECT_DOUBLE_EQ(t.at(0, 150 * 0.8, 0).T, 100);  // breakdown
  EXPECT_NEAR(t.at(0, 150 * 0.8, 0).dx, 0, 1e-14);
  EXPECT_DOUBLE_EQ(t.at(0, 0, 0).T, 200 / (5 + 0.2));  // starting torque
  EXPECT_LT(t.at(0, 160, 0).T, 0);                     // a generator above synchronous speed
  t = {};
  t.power = TorqueLaw::ConstantPower{1000, 50};
  EXPECT_DOUBLE_EQ(t.at(0, 100, 0).T, 10);
  EXPECT_DOUBLE_EQ(t.at(0, 1, 0).T, 50);
  EXPECT_DOUBLE_EQ(t.at(0, -1, 0).T, 50);
  t.power = TorqueLaw::ConstantPower{-1000, 50};  // a brake, whichever way it turns
  EXPECT_DOUBLE_EQ(t.at(0, 100, 0).T, -10);
  EXPECT_DOUBLE_EQ(t.at(0, 1, 0).T, -50);
  EXPECT_DOUBLE_EQ(t.at(0, -1, 0).T, 50);
  EXPECT_DOUBLE_EQ(t.at(0, -100, 0).T, 10);
  EXPECT_EQ(t.at(0, 0, 0).T, 0);
  t = {};
  t.governor = TorqueLaw::Governor{100, 2, 0.5, 30, 1.0};
  EXPECT_DOUBLE_EQ(t.at(2, 95, 191).T, 2 * 5 + 0.5 * 10);
  EXPECT_DOUBLE_EQ(t.at(2, 0, 191).T, 30);
  EXPECT_DOUBLE_EQ(t.at(2, 300, 191).T, -30);
  t = {};
  t.dc = TorqueLaw::DcLine{8, 40};
  EXPECT_DOUBLE_EQ(t.at(0, 10, 0).T, 6);
  EXPECT_DOUBLE_EQ(t.at(0, 10, 0).dx, -0.2);
  t = {};
  t.brake = make_table({1, 2}, {0, 6});
  EXPECT_DOUBLE_EQ(t.at(1.5, 10, 0).T, -3);
  EXPECT_DOUBLE_EQ(t.at(1.5, -10, 0).loss, 3);
  EXPECT_EQ(t.breakpoints(), (std::vector<double>{1, 2}));
  t = {};
  t.friction = 5;
  t.viscous = 0.1;
  t.quadratic = 0.01;
  EXPECT_DOUBLE_EQ(t.at(0, 10, 0).T, -(5 + 1 + 1));
  EXPECT_DOUBLE_EQ(t.at(0, -10, 0).T, 7);
  EXPECT_EQ(t.at(0, 0, 0).T, 0);
  EXPECT_DOUBLE_EQ(t.at(0, 10, 0).loss, -7);
}
