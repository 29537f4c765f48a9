// Gear mesh: conformance, geometry, ratio, power, backlash.
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/between_shafts/gear_mesh.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

GearGeometry pair(int z1, int z2, double helix = 0.0) {
  GearGeometry g;
  g.z1 = z1;
  g.z2 = z2;
  g.pitch_radius = 0.5;
  g.base_helix = helix;
  g.centre_angle = 0.7;
  return g;
}

NodeFrame<2, 7> at(const Vector<12>& q, const Vector<12>& v = Vector<12>::Zero()) {
  static const Mat3 chart = Mat3::Identity();
  return {q, v, Vector<12>(Vector<12>::Zero()), chart, Vec3::Zero()};
}

}  // namespace

TEST(GearMesh, Conformance) {
  ConformanceOptions o;
  o.symmetric_K = true;
  o.phi = 0.3;
  o.tilt = 0.3;  // the mesh phase is 5 phi: smooth on the scale of the differences
  const std::vector<GearHarmonic> k{{0.3, 0.2}, {0.1, -1.0}}, e{{0.02, 0.5}};
  check_kernel(make_gear_mesh(pair(5, 9, 0.3), 1000, 3, k, e), o);
  check_kernel(make_gear_mesh(pair(5, -17, -0.2), 1000, 3, k, e), o);
  o.chart = tilted_chart();
  check_kernel(make_gear_mesh(pair(5, 9), 1000, 3), o);
  // backlash: pressed on the drive flank, on the back flank, free
  const auto b = make_backlash_gear_mesh(pair(5, 9, 0.2), 1000, 0.05, 0.2, k, e);
  o.chart = Mat3::Identity();
  o.u = 0.05;
  o.phi = 0.03;
  o.tilt = 0.05;
  o.dphi = 0.5;
  o.du = 0.5;
  o.dtilt = 0.3;
  o.q0.assign(12, 0.0);
  for (double turn : {0.6, -1.1, -0.2}) {
    o.q0[3] = turn;
    o.over_declared.spin = turn == -0.2;  // free: nothing is damped
    check_kernel(b, o);
  }
}

TEST(GearMesh, RatioAndWholeTurns) {
  const auto m = make_gear_mesh(pair(23, 41), 1e8, 0);
  Vector<12> q = Vector<12>::Zero();
  q[3] = 41 * 0.01;
  q[9] = -23 * 0.01;  // rolling without compression
  auto x = at(q);
  EXPECT_NEAR(m.compression(x.nodes()), 0.0, 1e-15);
  // ... for a million turns of gear 2 and the matching turns of gear 1
  x.state[0].turns = 41e6;
  x.state[1].turns = -23e6;
  EXPECT_NEAR(m.compression(x.nodes()), 0.0, 1e-15);
  x.state[0].turns += 1;  // one turn too many: 2 pi r_b1
  EXPECT_NEAR(m.compression(x.nodes()), two_pi * 0.5 * std::cos(20 * pi / 180), 1e-12);
  // internal pair: both turn the same way
  const auto ring = make_gear_mesh(pair(20, -60), 1e8, 0);
  q[3] = 0.3;
  q[9] = 0.1;
  EXPECT_NEAR(ring.compression(at(q).nodes()), 0.0, 1e-15);
}

TEST(GearMesh, ForcesOfATransmittedTorque) {
  // drive torque T on gear 1: tangential force T/r, separating T/r tan alpha, axial T/r tan(helix
  // at the pitch circle)
  for (double helix : {0.0, 0.25}) {
    const auto g = pair(20, 40, helix);
    const auto m = make_gear_mesh(g, 1e6, 0);
    Vector<12> q = Vector<12>::Zero();
    q[3] = 1e-4;
    system::ForceX<14> f = Vector<14>::Zero();
    const auto x = at(q);
    m.add_force(x.nodes(), {}, f);
    const double T = f[6];  // what an external torque on gear 1 has to be
    EXPECT_GT(T, 0.0);
    EXPECT_NEAR(f[13], 2 * T,
                1e-12 * T);  // gear 2 (ratio 2) needs the same sign: both push the mesh together
    const Vec3 c(0, std::cos(g.centre_angle), std::sin(g.centre_angle)), around(0, -c.z(), c.y());
    const Vec3 on1 = -f.segment<3>(0), on2 = -f.segment<3>(7);  // force of the mesh on the gears
    EXPECT_NEAR(on1.dot(around), -T / 0.5, 1e-9 * T);
    EXPECT_NEAR(on1.dot(c), -T / 0.5 * std::tan(20 * pi / 180), 1e-9 * T);  // pushed apart
    EXPECT_NEAR(on2.dot(c), T / 0.5 * std::tan(20 * pi / 180), 1e-9 * T);
    // a driver of right-hand teeth, fingers of the right hand along its turning: thrust along the thumb
    EXPECT_NEAR(on1.x(), T / 0.5 * std::tan(helix) / std::cos(20 * pi / 180), 1e-9 * T);
    // the axial force at the pitch point tilts gear 1: moment about its axis direction c x e ... =
    // r (c x F)
    const Vec3 moment = Vec3::UnitX().cross(f.segment<3>(3));  // d x f_d at no tilt
    EXPECT_LT((moment - Vec3((0.5 * c).cross(Vec3(-on1.x(), 0, 0)))).norm(), 1e-9 * T);
  }
}

// As any gear does, the ring presses the pinion away from the mesh, back to its centre.
TEST(GearMesh, AnInternalGearPressesItsPinionInwards) {
  const auto g = pair(20, -60);
  const auto m = make_gear_mesh(g, 1e6, 0);
  Vector<12> q = Vector<12>::Zero();
  q[3] = 1e-4;
  system::ForceX<14> f = Vector<14>::Zero();
  const auto x = at(q);
  m.add_force(x.nodes(), {}, f);
  const double T = f[6], radial = T / 0.5 * std::tan(20 * pi / 180);
  const Vec3 to_mesh(0, std::cos(g.centre_angle), std::sin(g.centre_angle));
  EXPECT_NEAR(-f.segment<3>(0).dot(to_mesh), -radial, 1e-9 * T);
  EXPECT_NEAR(-f.segment<3>(7).dot(to_mesh), radial, 1e-9 * T);
}

TEST(GearMesh, VaryingStiffnessDoesNoNetWork) {
  // conservative: over one tooth, at constant compression, the torque on the phase averages to zero
  const auto m = make_gear_mesh(pair(10, 10), 1e5, 0, {{0.4, 0.0}, {0.1, 1.0}});
  double sum = 0, largest = 0;
  for (int i = 0; i < 50; ++i) {
    Vector<12> q = Vector<12>::Zero();
    q[3] = two_pi / 10 * i / 50;
    q[9] = -q[3] + 1e-3;
    system::ForceX<14> f = Vector<14>::Zero();
    m.add_force(at(q).nodes(), {}, f);
    const double phase_torque = f[6] - f[13];  // radii are equal: what is left is k' delta^2/2
    sum += phase_torque;
    largest = std::max(largest, std::abs(phase_torque));
  }
  EXPECT_GT(largest, 0.0);
  EXPECT_NEAR(sum / 50, 0.0, 1e-12 * largest);
}

TEST(GearMesh, BacklashOpensAndCloses) {
  const double j = 1e-3;
  const auto m = make_backlash_gear_mesh(pair(20, 40), 1e6, 0, j);
  const double rb = 0.5 * std::cos(20 * pi / 180);
  const auto torque = [&](double delta) {
    Vector<12> q = Vector<12>::Zero();
    q[3] = delta / rb;
    system::ForceX<14> f = Vector<14>::Zero();
    m.add_force(at(q).nodes(), {}, f);
    return f[6];
  };
  EXPECT_NEAR(torque(1e-4), 1e6 * 1e-4 * rb, 1e-9);
  EXPECT_EQ(torque(-0.5 * j), 0.0);
  EXPECT_NEAR(torque(-j - 2e-4), -1e6 * 2e-4 * rb, 1e-9);
  // the centres moved together use up the backlash from both sides: no play left beyond j/(2 sin
  // alpha)
  Vector<12> q = Vector<12>::Zero();
  const double closer = 0.6 * j / std::sin(20 * pi / 180);
  q[1] = closer * std::cos(0.7);
  q[2] = closer * std::sin(0.7);
  q[3] = -0.5 * j / rb;
  system::ForceX<14> f = Vector<14>::Zero();
  m.add_force(at(q).nodes(), {}, f);
  const Vec3 c(0, std::cos(0.7), std::sin(0.7));
  EXPECT_LT(-f.segment<3>(0).dot(c), 0.0);  // both flanks push gear 1 back
  EXPECT_NEAR(f[6], 0.0, 1e-9);
}

TEST(GearMesh, BadInput) {
  const auto code = [](auto make) {
    try {
      make();
      return std::string("none");
    } catch (const Error& e) {
      return e.diagnostics().front().code;
    }
  };
  EXPECT_EQ(code([] { make_gear_mesh(pair(20, 40), 1, 1); }), "none");
  EXPECT_EQ(code([] { make_gear_mesh(pair(0, 40), 1, 1); }), "E86");
  EXPECT_EQ(code([] { make_gear_mesh(pair(20, -20), 1, 1); }), "E86");
  EXPECT_EQ(code([] { make_gear_mesh(pair(20, 40), -1, 1); }), "E86");
  EXPECT_EQ(code([] { make_gear_mesh(pair(20, 40), 1, 1, {{0.7, 0}, {0.4, 0}}); }), "E86");
  EXPECT_EQ(code([] { make_backlash_gear_mesh(pair(20, 40), 1, 1, -1e-6); }), "E86");
}
