// Nodes in axes of their own (system/frames.hpp): nothing that acts may depend on them.
#include <elements/loads/moment.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/loads/spin_torque.hpp>
#include <elements/loads/unbalance.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/shaft_damping.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/supports/spring_block.hpp>
#include <la/multiply.hpp>
#include <system/problem.hpp>
#include <system/system.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace whirl;
using namespace whirl::system;

namespace {

constexpr Index count = 4;

/// A shaft with all that compares, turns or counts angles, in a direction of its own.
System everything() {
  Builder b;
  const Mat3 axes = rotation::L(Vec3(0.3, 0.5, -0.4));
  const Index line = b.add_line("shaft", axes);
  elements::ElementSection bar;
  bar.od1 = bar.od2 = bar.mass_od1 = bar.mass_od2 = 0.05;
  bar.E = 2e9;
  bar.G = 8e8;
  bar.rho = 7850;
  const auto constants = elements::make_shaft_constants(bar, 0.3);
  for (Index i = 0; i < count; ++i)
    b.add_node({0.3 * static_cast<double>(i) * axes.col(0), line, "node"});
  for (Index i = 1; i < count; ++i) {
    b.add(elements::ShaftBeam<false>(constants, axes.col(0)), {i - 1, i}, "shaft");
    b.add(elements::ShaftDamping<true>(constants, axes.col(0), 1e-3, 2e-3, 1e-3), {i - 1, i},
          "damping");
  }
  b.add(elements::RigidDisk{3.0, 0.02, 0.03, 0.01}, {1}, "disk");
  const Mat3 J = Vec3(0.03, 0.02, 0.04).asDiagonal();
  b.add(elements::RigidBody(2.0, Vec3(0.01, 0.02, -0.01), J), {2}, "body");
  b.add(elements::UnbalanceMass(1e-3, 0.7, nullptr, 0.02), {2}, "unbalance");
  elements::TorqueLaw law;
  law.viscous = 0.3;
  law.governor = elements::TorqueLaw::Governor{100.0, 0.2, 0.5};
  b.add(elements::JointTorque{law}, {0}, "drive");
  b.add(elements::NormalTorque{law}, {3}, "drag");
  b.add(elements::FixedLoad{Vec3(1, 2, 3), Vec3(4, 5, 6), 0.1, nullptr}, {3}, "load");
  b.add(elements::BodyLoad{Vec3(3, -2, 1), Vec3(1, 5, -6), 0.1, nullptr}, {1}, "follower");
  Matrix<6> K = Matrix<6>::Random();
  K = (K * K.transpose() * 1e3).eval();
  b.add(elements::LinearBearing(K, 1e-3 * K, Matrix<6>::Zero(), Vector<6>::Zero(),
                                Vector<6>::Zero(), 0.02, 0.0, axes),
        {3, b.add_ground(b.node(3).position, "ground")}, "bearing");
  b.set_gravity(Vec3(0, 0, -9.81));
  return b.finalize();
}

State random_state(const System& s, std::mt19937& rng) {
  std::normal_distribution<double> d;
  State x = s.make_state();
  for (Index k = 0; k < 6 * count; ++k) {
    x.q[k] = 0.05 * d(rng);
    x.v[k] = d(rng);
    x.a[k] = d(rng);
  }
  const Vec2 tilt(1.1, -0.7);  // of all together
  for (Index i = 0; i < count; ++i) {
    x.q.segment<2>(6 * i + gamma2) += tilt;
    x.q[6 * i + spin_phi] += 3.0 + 7.0 * static_cast<double>(i);  // wound up by more than a turn
  }
  return x;
}

/// Force and moment on every node, global axes.
VecX loads(const System& s, const State& x) {
  Workspace w = s.make_workspace();
  VecX r(s.size()), out(6 * count);
  EXPECT_TRUE(s.residual(w, x.frames, 0.3, x.q, x.v, x.a, r));
  for (Index i = 0; i < count; ++i) {
    const Vector<7>& f = w.force[at(i)];
    out.segment<3>(6 * i) = f.head<3>();
    out.segment<3>(6 * i + 3) = elements::moment_of(w.nodes[at(i)], f.segment<3>(3), f[6]);
  }
  return out;
}

Vector<5> energies(const System& s, const State& x) {
  Workspace w = s.make_workspace();
  EXPECT_TRUE(s.evaluate_nodes(w, x.frames, 0.3, x.q, x.v, x.a));
  const Energy e = s.energy(w);
  Vector<5> out;
  out << e.kinetic, e.elastic, e.gravity, e.supplied, e.dissipated;
  return out;
}

void move(const System& s, State& x, Index node, const Vec3& axis) {
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
}

}  // namespace

TEST(Frames, AWorkspaceKeepsTheAxesOfItsEvaluation) {
  const System system = everything();
  State s = system.make_state();
  Workspace w = system.make_workspace();
  ASSERT_TRUE(system.evaluate_nodes(w, s.frames, 0.0, s.q, s.v, s.a));
  const std::vector<Mat3> axes = s.frames.chart;
  for (Mat3& chart : s.frames.chart)
    chart.setZero();
  s.frames.chart.emplace_back(Mat3::Zero());  // as when nodes move to axes of their own
  for (std::size_t i = 0; i < w.nodes.size(); ++i)
    EXPECT_EQ(*w.nodes[i].chart, axes[static_cast<std::size_t>(s.frames.of_node[i])]) << i;
}

TEST(Frames, NoForceNorEnergyDependsOnThem) {
  const System s = everything();
  std::mt19937 rng(3);
  std::normal_distribution<double> d;
  for (int trial = 0; trial < 20; ++trial) {
    State x = random_state(s, rng);
    const VecX before = loads(s, x);
    const Vector<5> energy = energies(s, x);
    std::vector<double> angle;
    for (Index i = 0; i < count; ++i)
      angle.push_back(x.total_phi(i, 0));
    for (int moves = 0; moves < 12; ++moves) {
      const Index node = static_cast<Index>(rng() % count);
      const Vec3 near = (x.normals()[at(node)] + 0.5 * Vec3(d(rng), d(rng), d(rng))).normalized();
      if (near.dot(x.normals()[at(node)]) < 0.2) continue;
      move(s, x, node, near);
      // twist stiffness times the rounding of angles of 30 rad
      EXPECT_LT((loads(s, x) - before).norm(), 1e-11 * before.norm()) << trial << " " << moves;
      EXPECT_LT((energies(s, x) - energy).norm(), 1e-11 * energy.norm()) << trial << " " << moves;
      for (Index i = 0; i < count; ++i)
        EXPECT_NEAR(x.total_phi(i, 0), angle[at(i)], 1e-12);
    }
  }
}

/// Blocks of some terms are those of their tangent, bit for bit; nothing stands elsewhere.
TEST(Tangents, OfSomeTermsStandInTheirBlocks) {
  const System s = everything();
  std::mt19937 rng(3);
  const State x = random_state(s, rng);
  for (std::size_t k = 0; k < s.terms().size(); ++k) {
    const std::vector<std::size_t> only{k};
    const System::Blocks where = s.blocks_of(only);
    Workspace w = s.make_workspace(), used = s.make_workspace();
    la::MCK all = s.make_matrices(), some = s.make_matrices();
    ASSERT_TRUE(s.tangent(w, x.frames, 0.3, x.q, x.v, x.a, all, &only));
    ASSERT_TRUE(s.tangent(used, x.frames, 0.3, x.q, x.v, x.a, some));  // leaves its blocks behind
    some = s.make_matrices();
    ASSERT_TRUE(s.tangent_blocks(used, x.frames, 0.3, x.q, x.v, x.a, some, only, where));
    const std::string kind(s.terms()[k]->kind());
    for (const auto part : {&la::MCK::M, &la::MCK::C, &la::MCK::K})
      for (Index slot = 0; slot < s.pattern().blocks(); ++slot)
        EXPECT_EQ((some.*part).block(slot), (all.*part).block(slot)) << kind << " " << slot;
    const auto full = static_cast<std::size_t>(s.pattern().blocks());
    const bool at_one_node = kind.find("disk") != std::string::npos;
    EXPECT_TRUE(!at_one_node || where.slots.size() < full) << kind;
  }
}

TEST(Frames, TangentsOfMovedNodesAreExact) {
  const System s = everything();
  std::mt19937 rng(5);
  State x = random_state(s, rng);
  for (Index i = 0; i < count; ++i)
    move(s, x, i,
         (x.normals()[at(i)] + Vec3(0.3, 0.2 * static_cast<double>(i), -0.4)).normalized());
  Workspace w = s.make_workspace();
  la::MCK m = s.make_matrices();
  ASSERT_TRUE(s.tangent(w, x.frames, 0.3, x.q, x.v, x.a, m));
  VecX up(s.size()), down(s.size());
  for (Index k = 0; k < 6 * count; ++k)
    for (int which = 0; which < 3; ++which) {
      State y = x;
      VecX& z = which == 0 ? y.q : which == 1 ? y.v : y.a;
      VecX exact;
      la::multiply(which == 0 ? m.K : which == 1 ? m.C : m.M, VecX(VecX::Unit(s.size(), k)), exact);
      const double h = which == 0 ? 1e-6 : 1e-2;  // quadratic in rates
      z[k] += h;
      ASSERT_TRUE(s.residual(w, y.frames, 0.3, y.q, y.v, y.a, up));
      z[k] -= 2 * h;
      ASSERT_TRUE(s.residual(w, y.frames, 0.3, y.q, y.v, y.a, down));
      const VecX difference = ((up - down) / (2 * h)).head(6 * count);
      // rounding of forces of 1e6 N over the step
      EXPECT_LT((difference - exact.head(6 * count)).norm(), 1e-6 * (exact.norm() + 1.0))
          << which << " " << k;
    }
}

// Between a move of axes and the next evaluation, and after one that found a node outside its chart,
// a workspace knows no node in other axes than those it was evaluated in.
TEST(Frames, OwnAxesAreThoseOfTheLastEvaluation) {
  const System s = everything();
  std::mt19937 rng(7);
  State x = random_state(s, rng);
  Workspace w = s.make_workspace();
  const auto evaluate = [&] { return s.evaluate_nodes(w, x.frames, 0.3, x.q, x.v, x.a); };
  ASSERT_TRUE(evaluate());
  EXPECT_FALSE(w.moved());
  const double before = w.in_own_axes(2).phi;
  move(s, x, 2, x.normals()[2]);
  ASSERT_TRUE(x.frames.moved());
  ASSERT_FALSE(w.moved());  // nothing is there yet
  EXPECT_EQ(w.in_own_axes(2).phi, before);
  ASSERT_TRUE(evaluate());
  ASSERT_TRUE(w.moved());
  EXPECT_NEAR(w.in_own_axes(2).phi, before, 1e-12);
  // as far as the chart goes, and further
  const Vec2 tilt = x.q.segment<2>(gamma2);
  x.q.segment<2>(gamma2) = Vec2(0, 3.3);
  EXPECT_FALSE(evaluate());
  EXPECT_EQ(w.outside, 0);
  EXPECT_FALSE(w.moved());
  x.q.segment<2>(gamma2) = tilt;
  ASSERT_TRUE(evaluate());
  EXPECT_TRUE(w.moved());
}

// A body on a spring and a drive about its line's axis, tilted by 2.9 rad and precessing: axes are
// changed a hundred times, or never.
TEST(Frames, PrecessionNearTheAntipodeCountsItsTurns) {
  Builder b;
  b.add_line("shaft");
  b.add_node({Vec3::Zero(), 0, "body"});
  for (int c = 0; c < 3; ++c)
    b.hold(0, c);
  b.add(elements::RigidDisk{1.0, 0.02, 0.03, 0.0}, {0}, "disk");
  const System s = b.finalize();
  SystemProblem p(s);
  State x = s.make_state();
  const double tilt = 2.9;
  const auto place = [&](State& y, double azimuth) {
    y.q[3] = 0.1;
    y.q.segment<2>(4) = tilt * Vec2(std::cos(azimuth), std::sin(azimuth));
  };
  place(x, 0.0);
  p.frames = x.frames;
  p.accept(0, x.q, x.v, x.a);
  ASSERT_TRUE(p.frames.moved());
  double before = x.q[3];
  for (int n = 1; n <= 400; ++n) {
    // the same attitude in the line's own axes, brought into those of the node
    const double azimuth = 0.1 * n;
    State y = s.make_state();
    place(y, azimuth);
    const Vec3 d = y.normals()[0];
    const Mat3& axes = p.frames.axes(0);
    const Vec2 gamma = rotation::gamma_of_director(axes.transpose() * d - Vec3::UnitX());
    x.frames = p.frames;
    x.q.segment<2>(4) = gamma;
    x.q[3] = 0.0;
    x.q[3] = 0.1 - x.total_phi(0, 0);
    // same body axes as before, whatever the turns
    const auto attitude = [](const State& z) {
      const Vec2 g = z.q.segment<2>(4);
      return Mat3(z.frames.axes(0) * rotation::L(Vec3(0, g[0], g[1])) *
                  rotation::L(Vec3(z.q[3], 0, 0)));
    };
    ASSERT_LT((attitude(x) - attitude(y)).norm(), 1e-12) << n;
    // the node's own angle goes on where it was: 0.2 rad a step, 1.97 a turn of the normal
    EXPECT_LT(std::abs(x.q[3] - before), 0.5) << n;
    p.accept(0, x.q, x.v, x.a);
    before = x.q[3];
  }
}
