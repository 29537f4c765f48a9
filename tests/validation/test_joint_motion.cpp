// Bars on joints in motion, against reduced models integrated here, and their balances.
#include "joint_decks.hpp"
#include "record.hpp"

#include <system/joint_start.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::test;

namespace {

/// Bars that hang on each other by hinges about y, the first on the ground.
std::string pendulum_deck() {
  std::string deck = head;
  deck.replace(deck.find("\"0 m/s^2\""), 9, "\"10 m/s^2\"");
  return deck + rigid_line("first", 0, 0.5) + rigid_line("second", 0.5, 0.3) + R"([[joint]]
name = "shoulder"
kind = "hinge"
at = "first1:start"
axis = [0, 1, 0]
[[joint]]
name = "elbow"
kind = "hinge"
at = "second1:start"
to = "first1:end"
axis = [0, 2, 0]
)";
}

/// (a1, a2, a1', a2'): angles of both bars about y from x, weight along -z.
VecX double_pendulum(const VecX& y) {
  const double L1 = 0.5, L2 = 0.3, g = 10;
  const Bar b1(L1), b2(L2);
  const double c = std::cos(y[0] - y[1]), s = std::sin(y[0] - y[1]), k = 0.5 * b2.m * L1 * L2;
  Mat2 M;
  M << b1.I + b1.m * L1 * L1 / 4 + b2.m * L1 * L1, k * c, k * c, b2.I + b2.m * L2 * L2 / 4;
  // z of a point at r along a bar is -r sin a
  const Vec2 f((0.5 * b1.m + b2.m) * g * L1 * std::cos(y[0]) - k * s * y[3] * y[3],
               0.5 * b2.m * g * L2 * std::cos(y[1]) + k * s * y[2] * y[2]);
  const double det = M(0, 0) * M(1, 1) - M(0, 1) * M(1, 0);
  VecX out(4);
  out << y[2], y[3], (M(1, 1) * f[0] - M(0, 1) * f[1]) / det,
      (M(0, 0) * f[1] - M(1, 0) * f[0]) / det;
  return out;
}

}  // namespace

TEST(Joints, DoublePendulum) {
  Record record("Double pendulum of rigid bars, let go level",
                "two equations of Lagrange, Runge-Kutta of order 4");
  const DeckModel m(pendulum_deck());
  const system::System& s = m.built.system;
  const VecX exact = integrate(double_pendulum, VecX::Zero(4), 1.5, 60000);
  const auto angles = [&](const system::State& x) {
    const double a = x.q[6 * m.built.joints[0].angles[0]], b = x.q[6 * m.built.joints[1].angles[0]];
    return Vec2(a, a + b);
  };
  const system::State start = s.make_state();
  const double before = energy_of(s, start);
  const system::State end = move_to(m, start, 1.5, 1e-8);
  record.check("angle of the first bar at 1.5 s", "rad", angles(end)[0], exact[0], 1e-6);
  record.check("angle of the second", "rad", angles(end)[1], exact[1], 1e-6);
  record.below("change of the energy over that of one bar upside down", "-",
               std::abs(energy_of(s, end) - before) / (Bar(0.5).m * 10 * 0.5), 1e-7);
  // orders of the schemes
  for (const auto& [method, order] : {std::pair("radau5", 5.0), std::pair("gauss4", 4.0)}) {
    double last = 0;
    for (const double dt : {1.5 / 150, 1.5 / 300}) {
      const double error =
          (angles(move_to(m, start, 1.5, 1e-10, method, dt)) - Vec2(exact.head<2>())).norm();
      std::printf("double pendulum, %s, dt %.4f: %.3e rad\n", method, dt, error);
      if (last > 0) {
        EXPECT_GT(std::log2(last / error), order - 0.6) << method;
      }
      last = error;
    }
  }
}

TEST(Joints, ForcesOfThePendulumBalance) {
  const DeckModel m(pendulum_deck());
  const system::System& s = m.built.system;
  const system::State x = move_to(m, s.make_state(), 0.7, 1e-7);
  system::SystemProblem p(s);
  p.frames = x.frames;
  VecX r(s.size());
  ASSERT_TRUE(p.residual(x.t, x.q, x.v, x.a, r));
  const auto node = [&](Index n) -> const system::NodeState& {
    return p.workspace().nodes[static_cast<std::size_t>(n)];
  };
  const auto reaction = [&](Index k) { return r[k]; };
  // accelerations of the centres, from the angles
  const Vec2 a(x.q[6 * m.built.joints[0].angles[0]],
               x.q[6 * m.built.joints[0].angles[0]] + x.q[6 * m.built.joints[1].angles[0]]);
  const Vec2 v(x.v[6 * m.built.joints[0].angles[0]],
               x.v[6 * m.built.joints[0].angles[0]] + x.v[6 * m.built.joints[1].angles[0]]);
  VecX y(4);
  y << a, v;
  const Vec2 w = double_pendulum(y).tail<2>();
  const auto accel = [&](std::size_t k, double r) {  // of a point at r from the bar's own hinge
    const Index i = static_cast<Index>(k);
    const Vec3 along(std::cos(a[i]), 0, -std::sin(a[i])),
        across(-std::sin(a[i]), 0, -std::cos(a[i]));
    return Vec3(r * (w[i] * across - v[i] * v[i] * along));
  };
  const Vec3 g(0, 0, -10);
  const Vec3 on_second = Bar(0.3).m * (accel(0, 0.5) + accel(1, 0.15) - g);
  const Vec3 on_first = Bar(0.5).m * (accel(0, 0.25) - g) + on_second;
  const Vec3 shoulder = m.built.joints[0].force(node, {}, reaction),
             elbow = m.built.joints[1].force(node, {}, reaction);
  EXPECT_GT(on_first.norm(), 5);
  EXPECT_LT((shoulder - on_first).norm(), 1e-3 * on_first.norm());
  EXPECT_LT((elbow - on_second).norm(), 1e-3 * on_second.norm());
  // a hinge gives no moment about its axis, and nothing pulls the bars out of their plane
  EXPECT_LT(m.built.joints[1].moment(node, {}, reaction).norm(), 1e-3);
}

TEST(Joints, FreeJointedBodyKeepsItsMomenta) {
  // Three bars on a ball and a hinge, thrown, over a hundred tumbles.
  const DeckModel m(head + rigid_line("first", 0, 0.5) + rigid_line("second", 0.5, 0.3) +
                    rigid_line("third", 0.8, 0.4, 40) + R"([[joint]]
name = "ball"
kind = "spherical"
at = "second1:start"
to = "first1:end"
[[joint]]
name = "hinge"
kind = "hinge"
at = "third1:start"
to = "second1:end"
axis = [1, 2, 3]
)");
  const system::System& s = m.built.system;
  const auto momenta = [&](const system::State& x) {
    // of every bar about the origin, from its node and its own inertia
    system::Workspace w = s.make_workspace();
    EXPECT_TRUE(s.evaluate_nodes(w, x.frames, x.t, x.q, x.v, x.a));
    Vector<6> out = Vector<6>::Zero();
    const double length[] = {0.5, 0.3, 0.4}, d[] = {0.02, 0.02, 0.04}, x0[] = {0, 0.5, 0.8};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index i = m.mesh.lines[k].first_node;
      const system::NodeState& n = w.nodes[static_cast<std::size_t>(i)];
      const Bar bar(length[k], d[k]);
      const double c = x0[k] + 0.5 * length[k] - s.node(i).position.x();
      const Vec3 place = s.node(i).position + n.u + c * n.d(), speed = n.du + c * n.dd;
      const Vec3 own = bar.I * n.d().cross(n.dd) + bar.polar * n.spin() * n.d();
      out.head<3>() += bar.m * speed;
      out.tail<3>() += bar.m * place.cross(speed) + own;
    }
    return out;
  };
  system::State x = s.make_state();
  const Vec3 omega(3, 40, -25);
  for (Index i = 0; i < s.nodes(); ++i)
    if (!s.node(i).scalar) {
      x.v.segment<3>(6 * i) = omega.cross(Vec3(s.node(i).position - Vec3(0.6, 0, 0)));
      x.v.segment<3>(6 * i + 3) = omega;
    }
  ASSERT_EQ(system::fit_joints(s, x), "");
  // the third bar turns about its hinge, the first about its axis
  x.v[6 * m.built.joints[1].angles[0]] += 20;
  s.follow(x);
  const Vector<6> before = momenta(x);
  const double energy = energy_of(s, x);
  // what is lost is the integrator's and goes with its tolerance
  double lost[2];
  for (int k = 0; k < 2; ++k)
    lost[k] =
        (momenta(move_to(m, x, 1.0, k == 0 ? 1e-6 : 1e-8, "gauss6")) - before).tail<3>().norm();
  EXPECT_LT(lost[1], 0.1 * lost[0]);
  // the motion is chaotic: at 1e-6 what is lost differs by five times from rounding to rounding
  const system::State end = move_to(m, x, 14.0, 1e-7, "gauss6");
  EXPECT_TRUE(end.frames.moved());
  const Vector<6> after = momenta(end);
  EXPECT_LT((after - before).head<3>().norm(), 2e-4 * before.tail<3>().norm());
  EXPECT_LT((after - before).tail<3>().norm(), 2e-4 * before.tail<3>().norm());
  EXPECT_NEAR(energy_of(s, end), energy, 1e-5 * energy);
}

TEST(Joints, SphericalPendulum) {
  Record record("Spherical pendulum, a rigid bar on a ball",
                "its equation of motion, Runge-Kutta of order 4");
  std::string deck = head;
  deck.replace(deck.find("\"0 m/s^2\""), 9, "\"10 m/s^2\"");
  const DeckModel m(deck + rigid_line("bar", 0, 0.5) +
                    "[[joint]]\nname = \"ball\"\nkind = \"spherical\"\nat = \"bar1:start\"\n");
  const system::System& s = m.built.system;
  system::State x = s.make_state();
  const Vec3 omega(0, 2.0, 3.0);
  const Index i = m.mesh.lines[0].first_node;
  x.v.segment<3>(6 * i) = omega.cross(s.node(i).position);
  x.v.segment<3>(6 * i + 3) = omega;
  for (std::size_t k = 0; k < s.followers().count(); ++k) {  // the ball's centre turns with it
    const system::FollowerDef& f = s.followers()[k];
    if (f.pinned) x.v.segment<3>(6 * f.node + 3) = omega;
  }
  s.follow(x);
  const Bar bar(0.5);
  const double I = bar.I + bar.m * 0.25 * 0.25;
  // I d x d'' = m g l/2 d x (-z)
  const auto rate = [&](const VecX& y) {
    const Vec3 d = y.head<3>(), v = y.tail<3>();
    const Vec3 pull = bar.m * 0.25 / I * Vec3(0, 0, -10);
    VecX out(6);
    out << v, pull - pull.dot(d) * d - v.squaredNorm() * d;
    return out;
  };
  VecX y(6);
  y << Vec3::UnitX(), omega.cross(Vec3::UnitX());
  const VecX exact = integrate(rate, y, 3.0, 60000);
  const system::State end = move_to(m, x, 3.0, 1e-8);
  const Vec3 d = end.normals()[static_cast<std::size_t>(i)];
  for (int c = 0; c < 3; ++c)
    record.check(fmt::format("direction of the bar at 3 s, {}", "xyz"[c]), "-", d[c], exact[c],
                 1e-6);
  EXPECT_NEAR(energy_of(s, end), energy_of(s, x), 1e-6 * bar.m * 10 * 0.5);
}

TEST(Joints, SliderOnARotatingArm) {
  Record record("Bar that slides on a spring along a free rotating arm",
                "two equations of Lagrange, Runge-Kutta of order 4");
  const DeckModel m(head + rigid_line("arm", 0, 0.5) + rigid_line("mass", 0.5, 0.2, 40) +
                    R"([[joint]]
name = "hub"
kind = "hinge"
at = "arm1:start"
axis = [0, 0, 1]
[[joint]]
name = "guide"
kind = "slider"
at = "mass1:start"
to = "arm1:end"
axis = [1, 0, 0]
stiffness = "2000 N/m"
)");
  const system::System& s = m.built.system;
  const Index hub = m.built.joints[0].angles[0], guide = m.built.joints[1].slide;
  system::State x = s.make_state();
  x.v[6 * hub] = 12.0;
  s.follow(x);
  const Bar arm(0.5), mass(0.2, 0.04);
  const double J = arm.I + arm.m * 0.25 * 0.25 + mass.I;
  // angle, slide: r = 0.6 + slide of the centre
  const auto rate = [&](const VecX& y) {
    const double r = 0.6 + y[1];
    VecX out(4);
    out << y[2], y[3], -2 * mass.m * r * y[3] * y[2] / (J + mass.m * r * r),
        r * y[2] * y[2] - 2000 / mass.m * y[1];
    return out;
  };
  VecX y(4);
  y << 0, 0, 12, 0;
  const VecX exact = integrate(rate, y, 2.0, 60000);
  const system::State end = move_to(m, x, 2.0, 1e-9);
  EXPECT_GT(exact[0], 3 * two_pi);  // the hinge counts its turns
  record.check("angle of the arm at 2 s", "rad", end.q[6 * hub], exact[0], 1e-6);
  record.check("slide", "m", end.q[6 * guide], exact[1], 1e-7);
  EXPECT_NEAR(energy_of(s, end), energy_of(s, x), 1e-7 * energy_of(s, x));
}
