// Joints without penalty (system/joints.hpp): kinematics, exact tangents, and no dependence on
// axes.
#include <elements/loads/point_load.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <la/multiply.hpp>
#include <system/problem.hpp>
#include <system/system.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace whirl;
using namespace whirl::system;

namespace {

struct Linkage {
  System system;
  std::vector<Index> bodies;   ///< in the order of the chain
  std::vector<Index> scalars;  ///< hinge, universal (two), slide, and the turn about it
  Index far = 0;               ///< end of the beam
};

const Vec3 hinge_axis = Vec3(1, 2, 2) / 3.0, first_axis = Vec3(0.6, 0, 0.8),
           second_axis = Vec3(0.8, 0, -0.6), slide_axis = Vec3(0, -0.6, 0.8);

/// Ground, hinge, body, universal joint, body, slide that also turns, body, ball, body with a beam,
/// and an arm welded to it: every kind, each part in axes of its own.
Linkage linkage() {
  Builder b;
  Linkage out;
  int parts = 0;
  const auto part = [&](const Vec3& place) {
    ++parts;
    const Mat3 axes = rotation::L(Vec3(0.7 * parts, 0.5 - 0.3 * parts, 0.2 * parts * parts));
    const Index line = b.add_line("part", axes);
    return b.add_node({place, line, "body"});
  };
  const auto weight = [&](Index node) {
    Mat3 J = Vec3(0.03, 0.02, 0.04).asDiagonal();
    J(0, 1) = J(1, 0) = 0.004;
    b.add(elements::RigidBody(2.0, Vec3(0.01, 0.02, -0.01), J), {node}, "body");
    out.bodies.push_back(node);
  };
  const auto scalar = [&] {
    const Index n = b.add_node({Vec3::Zero(), 0, "joint", true});
    out.scalars.push_back(n);
    return n;
  };
  b.add_line("first");
  const Index ground = b.add_ground(Vec3(0.1, 0.2, 0.3), "ground");
  const Index first = part(Vec3(0.1, 0.2, 0.3));
  weight(first);
  b.add_follower({first, ground, false, scalar(), -1, hinge_axis, "hinge"});

  const Vec3 elbow(0.4, 0.1, 0.5);
  const Index tip = part(elbow), cross = part(elbow), second = part(elbow);
  weight(second);
  b.add_follower({tip, first, false, -1, -1, Vec3::UnitX(), "arm"});
  b.add_follower({cross, tip, false, scalar(), -1, first_axis, "universal"});
  b.add_follower({second, cross, false, scalar(), -1, second_axis, "universal"});

  const Index third = part(Vec3(0.5, 0.1, 0.2));
  weight(third);
  const Index slide = scalar();
  b.add_follower({third, second, false, scalar(), slide, slide_axis, "slide"});

  const Index fourth = part(Vec3(0.5, 0.1, 0.2));
  weight(fourth);
  b.add_follower({fourth, third, true, -1, -1, Vec3::UnitX(), "ball"});

  elements::ElementSection bar;
  bar.od1 = bar.od2 = bar.mass_od1 = bar.mass_od2 = 0.05;
  bar.E = 2e6;
  bar.G = 8e5;
  bar.rho = 7850;
  const Index line = b.node(fourth).line;
  const Mat3 axes = rotation::L(Vec3(0.7 * 6, 0.5 - 0.3 * 6, 0.2 * 36));
  out.far = b.add_node({b.node(fourth).position + 0.3 * axes.col(0), line, "end"});
  b.add(elements::ShaftBeam<false>(elements::make_shaft_constants(bar, 0.3), axes.col(0)),
        {fourth, out.far}, "shaft");
  const Index fifth = part(b.node(out.far).position + Vec3(0.1, 0.2, 0));
  weight(fifth);
  b.add_follower({fifth, out.far, false, -1, -1, Vec3::UnitX(), "weld"});
  b.add(elements::FixedLoad{Vec3(1, 2, 3), Vec3(4, 5, 6), 0.1, nullptr}, {fifth}, "load");
  b.add(elements::BodyLoad{Vec3(3, -2, 1), Vec3(1, 5, -6), 0.1, nullptr}, {second}, "follower");
  b.set_gravity(Vec3(0.3, 0, -9.81));
  out.system = b.finalize();
  return out;
}

State place_at_random(const System& s, std::mt19937& rng) {
  std::normal_distribution<double> d;
  State x = s.make_state();
  for (Index k = 0; k < s.size(); ++k) {
    if (!s.active()[at(k)]) continue;
    x.q[k] = 0.4 * d(rng);
    x.v[k] = d(rng);
    x.a[k] = d(rng);
  }
  s.follow(x);
  return x;
}

void shift_axes(const System& s, State& x, Index node, const Vec3& axis) {
  const Index k = 6 * node;
  rotation::Angles angles{x.q[k + spin_phi],          x.v[k + spin_phi],
                          x.a[k + spin_phi],          x.q.segment<2>(k + gamma2),
                          x.v.segment<2>(k + gamma2), x.a.segment<2>(k + gamma2)};
  const std::vector<Vec3> normals = x.normals();
  x.frames.move(s, {&node, 1}, axis, normals, {&angles, 1});
  x.q[k + spin_phi] = angles.phi;
  x.v[k + spin_phi] = angles.dphi;
  x.a[k + spin_phi] = angles.ddphi;
  x.q.segment<2>(k + gamma2) = angles.gamma;
  x.v.segment<2>(k + gamma2) = angles.dgamma;
  x.a.segment<2>(k + gamma2) = angles.ddgamma;
  s.followers().keep_turns(x.frames, x.q);
}

/// Rotation of a node from the reference.
Mat3 attitude(const System& s, const State& x, Index node) {
  const Vec2 g = x.q.segment<2>(6 * node + gamma2);
  const Mat3& E = x.frames.axes(node);
  const Mat3 start = s.make_state().frames.chart[at(s.node(node).line)];
  return E * rotation::L(Vec3(0, g[0], g[1])) * rotation::L(Vec3(x.q[6 * node + spin_phi], 0, 0)) *
         start.transpose();
}
Vec3 place(const System& s, const State& x, Index node) {
  return s.node(node).position + x.q.segment<3>(6 * node);
}

void check_tangents(const System& s, const State& x) {
  Workspace w = s.make_workspace();
  la::MCK m = s.make_matrices();
  ASSERT_TRUE(s.tangent(w, x.frames, 0.3, x.q, x.v, x.a, m));
  VecX up(s.size()), down(s.size());
  for (Index k = 0; k < s.size(); ++k) {
    if (!s.active()[at(k)]) continue;
    for (int which = 0; which < 3; ++which) {
      State y = x;
      VecX& z = which == 0 ? y.q : which == 1 ? y.v : y.a;
      VecX exact;
      la::multiply(which == 0 ? m.K : which == 1 ? m.C : m.M, VecX(VecX::Unit(s.size(), k)), exact);
      const double h = which == 0 ? 1e-5 : 1e-2;  // quadratic in rates
      z[k] += h;
      ASSERT_TRUE(s.residual(w, y.frames, 0.3, y.q, y.v, y.a, up));
      z[k] -= 2 * h;
      ASSERT_TRUE(s.residual(w, y.frames, 0.3, y.q, y.v, y.a, down));
      VecX difference = (up - down) / (2 * h);
      for (Index j = 0; j < s.size(); ++j)
        if (!s.active()[at(j)]) difference[j] = exact[j] = 0.0;
      EXPECT_LT((difference - exact).norm(), 2e-6 * (exact.norm() + 1.0)) << which << " " << k;
    }
  }
}

}  // namespace

TEST(Joints, FollowersStandWhereTheJointsPutThem) {
  const Linkage l = linkage();
  const System& s = l.system;
  std::mt19937 rng(7);
  for (int trial = 0; trial < 10; ++trial) {
    const State x = place_at_random(s, rng);
    const auto value = [&](std::size_t k) { return x.q[6 * l.scalars[k]]; };
    const Mat3 A = rotation::L(value(0) * hinge_axis);
    EXPECT_LT((attitude(s, x, l.bodies[0]) - A).norm(), 1e-13);
    EXPECT_LT((place(s, x, l.bodies[0]) - Vec3(0.1, 0.2, 0.3)).norm(), 1e-15);
    const Mat3 B = A * rotation::L(value(1) * first_axis) * rotation::L(value(2) * second_axis);
    EXPECT_LT((attitude(s, x, l.bodies[1]) - B).norm(), 1e-13);
    const Vec3 elbow = Vec3(0.1, 0.2, 0.3) + A * Vec3(0.3, -0.1, 0.2);
    EXPECT_LT((place(s, x, l.bodies[1]) - elbow).norm(), 1e-14);
    const Mat3 C = B * rotation::L(value(4) * slide_axis);
    EXPECT_LT((attitude(s, x, l.bodies[2]) - C).norm(), 1e-13);
    const Vec3 third = elbow + B * (Vec3(0.1, 0, -0.3) + value(3) * slide_axis);
    EXPECT_LT((place(s, x, l.bodies[2]) - third).norm(), 1e-14);
    EXPECT_LT((place(s, x, l.bodies[3]) - third).norm(), 1e-14);
    EXPECT_LT((attitude(s, x, l.bodies[4]) - attitude(s, x, l.far)).norm(), 1e-13);
  }
}

TEST(Joints, RatesAreThoseOfThePlaces) {
  const Linkage l = linkage();
  const System& s = l.system;
  std::mt19937 rng(11);
  const State x = place_at_random(s, rng);
  const double h = 1e-3;
  State before = x, after = x;
  for (auto [y, t] : {std::pair(&before, -h), std::pair(&after, h)}) {
    y->q = x.q + t * x.v + 0.5 * t * t * x.a;
    y->v = x.v + t * x.a;
    s.follow(*y);
  }
  for (Index k = 0; k < s.size(); ++k) {
    EXPECT_NEAR((after.q[k] - before.q[k]) / (2 * h), x.v[k], 1e-3) << k;
    EXPECT_NEAR((after.q[k] - 2 * x.q[k] + before.q[k]) / (h * h), x.a[k], 1e-2) << k;
  }
}

TEST(Joints, TangentsAreExact) {
  const Linkage l = linkage();
  std::mt19937 rng(5);
  for (int trial = 0; trial < 3; ++trial)
    check_tangents(l.system, place_at_random(l.system, rng));
}

TEST(Joints, TangentsAreExactInMovedAxes) {
  const Linkage l = linkage();
  const System& s = l.system;
  std::mt19937 rng(6);
  State x = place_at_random(s, rng);
  for (Index i = 0; i < s.nodes(); ++i)
    if (!s.node(i).scalar && i > 0)
      shift_axes(s, x, i,
                 (x.normals()[at(i)] + Vec3(0.3, 0.1 * static_cast<double>(i), -0.4)).normalized());
  check_tangents(s, x);
}

TEST(Joints, NothingDependsOnAxes) {
  const Linkage l = linkage();
  const System& s = l.system;
  std::mt19937 rng(9);
  std::normal_distribution<double> d;
  const auto of = [&](const State& x) {
    Workspace w = s.make_workspace();
    VecX r(s.size());
    EXPECT_TRUE(s.residual(w, x.frames, 0.3, x.q, x.v, x.a, r));
    const Energy e = s.energy(w);
    VecX out(3 + static_cast<Index>(l.scalars.size() + 3 * s.followers().count()));
    out.head<3>() << e.kinetic, e.elastic, e.gravity;
    Index n = 3;
    for (const Index k : l.scalars)
      out[n++] = r[6 * k];
    for (std::size_t k = 0; k < s.followers().count(); ++k, n += 3)
      out.segment<3>(n) = r.segment<3>(6 * s.followers()[k].node);
    return out;
  };
  for (int trial = 0; trial < 10; ++trial) {
    State x = place_at_random(s, rng);
    const VecX before = of(x);
    for (int moves = 0; moves < 20; ++moves) {
      const Index node = static_cast<Index>(rng() % static_cast<unsigned>(s.nodes()));
      if (s.node(node).scalar || node == 0) continue;
      const Vec3 normal = x.normals()[at(node)];
      const Vec3 near = (normal + 0.5 * Vec3(d(rng), d(rng), d(rng))).normalized();
      if (near.dot(normal) < 0.2) continue;
      shift_axes(s, x, node, near);
      EXPECT_LT((of(x) - before).norm(), 1e-11 * before.norm()) << trial << " " << moves;
    }
  }
}

// Two parts of a shaft welded together, spinning fast: phi of the second is that of the first,
// however many turns a step makes.
TEST(Joints, AWeldKeepsTheAngleOverManyTurns) {
  Builder b;
  b.add_line("first");
  b.add_line("second");
  const Index a = b.add_node({Vec3::Zero(), 0, "a"}), c = b.add_node({Vec3::Zero(), 1, "b"});
  const Index angle = b.add_node({Vec3::Zero(), 0, "joint", true});
  b.add(elements::RigidDisk{1.0, 0.02, 0.03, 0.0}, {a}, "disk");
  b.add(elements::RigidDisk{1.0, 0.02, 0.03, 0.0}, {c}, "disk");
  b.add_follower({c, a, false, angle, -1, Vec3::UnitX(), "joint"});
  const System s = b.finalize();
  State x = s.make_state();
  for (const double phi : {0.0, 3.0, 47.0, -200.0, 1e5}) {
    x.q[6 * a + spin_phi] = phi;
    x.q[6 * angle] = -0.7 * phi;
    x.q.segment<2>(6 * a + gamma2) = Vec2(0.3, -0.2);
    s.follow(x);
    EXPECT_NEAR(x.q[6 * c + spin_phi], 0.3 * phi, 1e-14 * (100 + std::abs(phi)));
    EXPECT_LT((x.q.segment<2>(6 * c + gamma2) - Vec2(0.3, -0.2)).norm(), 1e-14);
  }
}
