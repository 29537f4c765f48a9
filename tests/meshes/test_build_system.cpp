#include <la/dense.hpp>
#include "mass_of_system.hpp"
#include "models.hpp"

#include <assembly/build_system.hpp>
#include <assembly/element_section.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/shaft_damping.hpp>
#include <elements/loads/spin_torque.hpp>
#include <elements/supports/spring_block.hpp>
#include <elements/supports/table_bearing.hpp>
#include <elements/loads/unbalance.hpp>
#include <gtest/gtest.h>
#include <system/problem.hpp>

using namespace whirl;
using namespace whirl::assembly;
using namespace whirl::test;

namespace {

Built build(const model::Model& m, const std::string& step = {}) {
  return build_system(m, meshes::make_mesh(m), step);
}

template <class K>
std::size_t count(const Built& b) {
  const auto* batch = b.system.batch<K>();
  return batch ? batch->count() : 0;
}

void ask_equilibrium(model::Model& m) {
  model::Step s;
  s.name = "weight";
  s.law = model::StaticStep{};
  m.steps.push_back(s);
}

/// Static equilibrium by plain Newton from the reference state, spins held.
struct Rest {
  VecX q, r;
  system::SystemProblem problem;
  explicit Rest(const Built& b, const std::vector<Index>& also_held = {}) : problem(b.system) {
    const Index n = b.system.size();
    q = VecX::Zero(n);
    r = VecX::Zero(n);
    const VecX zero = VecX::Zero(n);
    VecX v = zero, a = zero;
    problem.impose(0.0, q, v, a);
    std::vector<Index> free;
    for (Index k = 0; k < n; ++k)
      if (b.system.active()[S(k)] && k % 6 != system::spin_phi &&
          std::find(also_held.begin(), also_held.end(), k) == also_held.end())
        free.push_back(k);
    for (int it = 0; it < 30; ++it) {
      EXPECT_TRUE(problem.residual(0.0, q, zero, zero, r));
      problem.linearize(0.0, q, zero, zero);
      MatX K = MatX::Zero(n, n);
      for (Index k = 0; k < n; ++k)
        problem.add_K(1.0, VecX::Unit(n, k), K.col(k));
      const VecX dx = la::DenseLu<double>(MatX(K(free, free))).solve(VecX(r(free)));
      q(free) -= dx;
      if (dx.norm() < 1e-15 * (1 + q.norm())) break;
    }
    EXPECT_TRUE(problem.residual(0.0, q, zero, zero, r));
  }
  Vec3 force(const Built& b, std::size_t support) {
    return b.support_forces[support].force(
        [&](Index i) -> const system::NodeState& { return problem.workspace().nodes[S(i)]; },
        system::Context{}, [&](Index k) { return r[k]; });
  }
};

// ---------------------------------------------------------------- what is added

TEST(BuildSystem, NodesAreThoseOfTheMesh) {
  model::Model m = one_shaft({cylinder("a", 0.4, 0.04, 0, 4)});
  auto b = spring("b", 0.0, 1e7);
  b.pedestal = model::Pedestal{10, 1e8 * Mat3::Identity(), Mat3::Zero()};
  m.bearings = {b, spring("c", 0.4, 1e7)};
  const meshes::Mesh mesh = meshes::make_mesh(m);
  const Built built = build_system(m, mesh);
  ASSERT_EQ(built.system.nodes(), static_cast<Index>(mesh.nodes.size()));
  for (Index i = 0; i < built.system.nodes(); ++i) {
    EXPECT_EQ(built.system.node(i).position, mesh.nodes[S(i)].position);
    EXPECT_EQ(built.system.node(i).name, mesh.nodes[S(i)].name);
  }
  EXPECT_EQ(built.spins.size(), 1u);
  EXPECT_EQ(built.system.line_name(0), "rotor");
}

// The correction of the shaft's mass counts what else acts on a node laterally
// (src/assembly/mass_shares.hpp): a thrust bearing does not, be its stiffness constant or
// tabulated; a table with lateral entries does.
TEST(BuildSystem, ThrustBearingsLeaveTheLateralMassAlone) {
  model::Model m = one_shaft({cylinder("a", 0.4, 0.04, 0, 4)});
  m.bearings = {spring("b", 0.0, 1e7), spring("c", 0.4, 1e7)};
  const auto mass = [&] {
    return build(m).system.batch<elements::ShaftBeam<false>>()->elements()[1].c.M4;
  };
  const Matrix<4> plain = mass();
  auto thrust = named<model::Bearing>("thrust", 0.2);
  model::LinearBearing linear;
  linear.K(0, 0) = 1e8;
  linear.C(0, 0) = 1e3;
  thrust.law = linear;
  m.bearings.push_back(thrust);
  EXPECT_EQ(mass(), plain);
  model::TableBearing table;
  table.speed = {0, 100};
  table.K = {linear.K, 2 * linear.K};
  table.C = {linear.C, linear.C};
  m.bearings.back().law = table;
  EXPECT_EQ(mass(), plain);
  table.K[1](1, 1) = table.K[1](2, 2) = 1e7;
  m.bearings.back().law = table;
  EXPECT_NE(mass(), plain);
}

TEST(BuildSystem, AbsentPhysicsIsAnAbsentBatch) {
  model::Model m = one_shaft({cylinder("a", 0.4, 0.04, 0, 4)});
  m.bearings = {spring("b", 0.0, 1e7), spring("c", 0.4, 1e7)};
  const Built plain = build(m);
  EXPECT_EQ(plain.system.terms().size(), 2u);  // shaft elements and bearings
  EXPECT_EQ(count<elements::ShaftBeam<false>>(plain), 4u);
  EXPECT_EQ(count<elements::TranslationalBearing>(plain), 2u);
  EXPECT_TRUE(plain.breakpoints.empty());

  m.shafts[0].damping = {
      .alpha = 1.5, .beta_external = 2e-5, .beta_internal = 1e-5, .beta_torsion = 3e-6};
  m.disks = {disk("balanced", 0.1, 3, 0.02, 0.01), disk("point", 0.2, 1, 0, 0),
             disk("eccentric", 0.3, 3, 0.02, 0.01)};
  m.disks[2].offset = Vec3(0, 1e-4, 0);
  auto u = named<model::Unbalance>("u", 0.2);
  u.amount = 1e-4;
  u.factor = make_table({1, 2}, {1, 0});
  m.unbalances = {u};
  auto force = named<model::PointLoad>("force", 0.2), moment = force, body = force;
  force.force = Vec3(0, 1, 0);
  force.factor = make_table({0.5, 1}, {0, 1});
  moment.moment = Vec3(0, 0, 1);
  body.force = Vec3(0, 1, 0);
  body.frame = model::LoadFrame::rotating;
  m.loads = {force, moment, body};
  auto block = named<model::Bearing>("block", 0.2);
  block.law = model::SpringBlock{100, 10};
  m.bearings.push_back(block);
  auto tilt = spring("tilt", 0.1, 1e3);
  std::get<model::LinearBearing>(tilt.law).K(4, 4) = 10;
  m.bearings.push_back(tilt);
  auto table = named<model::Bearing>("table", 0.3);
  model::TableBearing law;
  law.speed = {0, 100};
  const auto lateral = [](double k) { return Matrix<6>(Vector<6>(0, k, k, 0, 0, 0).asDiagonal()); };
  law.K = {lateral(1e6), lateral(2e6)};
  law.C = {lateral(1e3), lateral(1e3)};
  table.law = law;
  m.bearings.push_back(table);
  auto torque = named<model::Drive>("motor", 0.0);
  torque.law = model::TorqueCurve{};
  m.drives = {torque};
  const Built b = build(m);
  EXPECT_EQ(count<elements::ShaftDamping<true>>(b), 4u);
  EXPECT_EQ(count<elements::ShaftDamping<false>>(b), 4u);
  EXPECT_EQ(count<elements::ShaftMassDamping>(b), 4u);
  EXPECT_EQ(count<elements::RigidDisk>(b), 1u);
  EXPECT_EQ(count<elements::PointMass>(b), 1u);
  EXPECT_EQ(count<elements::RigidBody>(b), 1u);
  EXPECT_EQ(count<elements::UnbalanceMass>(b), 1u);
  EXPECT_EQ(count<elements::PointForce>(b), 1u);
  EXPECT_EQ(count<elements::FixedLoad>(b), 1u);
  EXPECT_EQ(count<elements::BodyLoad>(b), 1u);
  EXPECT_EQ(count<elements::SpringBlock>(b), 1u);
  EXPECT_EQ(count<elements::LinearBearing>(b), 1u);
  EXPECT_EQ((count<elements::LateralJoint<elements::TableBearingLaw<false>, false>>(b)), 1u);
  EXPECT_EQ(count<elements::JointTorque>(b), 1u);
  EXPECT_EQ(b.breakpoints, (std::vector<double>{0.5, 1, 2}));
  EXPECT_EQ(b.support_forces.size(), 5u);
  // Torsion is damped once, with the sum of all.
  const auto& in = b.system.batch<elements::ShaftDamping<true>>()->elements()[0];
  const auto& ex = b.system.batch<elements::ShaftDamping<false>>()->elements()[0];
  const double GJ_l = b.system.batch<elements::ShaftBeam<false>>()->elements()[0].c.GJ_l;
  EXPECT_NEAR(in.d_twist, 3.3e-5 * GJ_l, 1e-12 * GJ_l);
  EXPECT_EQ(ex.d_twist, 0.0);
}

// A stiffness that only couples another motion into a direction does not hold it.
TEST(BuildSystem, CouplingStiffnessHoldsNothing) {
  model::Model m = one_shaft({cylinder("a", 0.4, 0.04, 0, 4)});
  auto b = spring("b", 0.0, 1e7);
  std::get<model::LinearBearing>(b.law).K(0, 1) = 1e5;
  m.bearings = {b, spring("c", 0.4, 1e7)};
  model::Step modes;
  modes.name = "modes";
  modes.law = model::ModalStep{};
  m.steps = {modes};
  EXPECT_EQ(build(m).axially_free, std::vector<Index>{0});
  std::get<model::LinearBearing>(m.bearings[0].law).K(0, 0) = 1e6;
  EXPECT_TRUE(build(m).axially_free.empty());
}

TEST(BuildSystem, DrivesOfTheStepOnly) {
  model::Model m = one_shaft({cylinder("a", 0.4, 0.04, 0, 4)});
  m.shafts[0].spin0 = 12;
  auto up = named<model::Drive>("up", 0.4);
  up.step = "run_up";
  up.law = model::PrescribedSpin{make_angle_of_speed(make_table({0, 5}, {0, 300}), 0.1), true};
  m.drives = {up};
  const meshes::Mesh mesh = meshes::make_mesh(m);
  const Built other = build_system(m, mesh, "other"), run = build_system(m, mesh, "run_up");
  EXPECT_FALSE(other.spins[0].prescribed);
  EXPECT_EQ(other.spins[0].spin0, 12);
  EXPECT_EQ(other.reference, 0);
  EXPECT_TRUE(run.spins[0].prescribed);
  EXPECT_EQ(run.reference, 4);
  EXPECT_EQ(run.breakpoints, (std::vector<double>{0, 5}));
  EXPECT_EQ(run.drive_torques.size(), 1u);
  EXPECT_FALSE(run.system.active()[S(6 * 4 + system::spin_phi)]);
  EXPECT_TRUE(other.system.active()[S(6 * 4 + system::spin_phi)]);
  m.drives.push_back(up);  // twice at one place
  EXPECT_THROW(build_system(m, mesh, "run_up"), Error);
}

// ---------------------------------------------------------------- mass

TEST(BuildSystem, AssembledMassIsThatOfTheModel) {
  model::Model m = one_shaft({rigid("stub", 0.1, 0.08), cylinder("a", 0.3, 0.05, 0.01, 3),
                              cylinder("cone", 0.2, 0.05, 0.02, 2), rigid("hub", 0.1),
                              cylinder("b", 0.25, 0.07, 0, 2)});
  m.shafts[0].origin = Vec3(0.3, -0.1, 0.2);
  m.shafts[0].sections[2].od_r = 0.09;
  m.shafts[0].sections[2].id_r = 0.03;
  m.shafts[0].sections[1].added_mass_per_length = 4;
  m.shafts[0].sections[4].stiffness_diameters = {{0.06, 0, 0.06, 0}};
  m.disks = {disk("d", 0.62, 3, 0.02, 0.012), disk("skewed", 0.35, 2, 0.01, 0.006),
             disk("eccentric", 0.05, 1, 0.01, 0.006)};
  m.disks[1].skew = 0.1;
  m.disks[1].skew_phase = 0.7;
  m.disks[2].offset = Vec3(0.01, 2e-3, -1e-3);
  auto u = named<model::Unbalance>("u", 0.65);  // on the rigid hub, away from its node
  u.amount = 1e-3;
  u.phase = 0.3;
  m.unbalances = {u};
  model::Shaft keyed;
  keyed.name = "keyed";
  keyed.sections = {cylinder("g", 0.5, 0.02, 0, 3)};
  keyed.sections[0].general = model::Section::General{1e-3, 2e-7, 1e-7, 2e-7, 0.85, 0.85, 0.4};
  m.shafts.push_back(keyed);
  m.bearings = {held("left", 0.0,
                     {true, true, true, true, true, true})};  // a wholly held node keeps its mass
  const Built b = build(m);
  for (Index line : {0, 1}) {
    const auto assembled = mass_of_system(b.system, line), exact = meshes::shaft_mass(m, S(line));
    EXPECT_LT(mass_disagreement(assembled, exact, m.shafts[S(line)].length()), 1e-13) << line;
  }
  EXPECT_LT(mass_disagreement(mass_of_system(b.system), meshes::total_mass(m), 1.0), 1e-13);
}

// ---------------------------------------------------------------- statics through the whole chain

// Stepped, conical, hollow, with rigid hub and offsets: weight, reactions and equilibrium, and the
// deflection of a cantilever.
TEST(BuildSystem, ReactionsCarryTheWeight) {
  model::Model m = one_shaft(
      {cylinder("a", 0.3, 0.05, 0.01, 2), rigid("hub", 0.1, 0.2), cylinder("b", 0.25, 0.04, 0, 2)});
  m.shafts[0].sections[0].od_r = 0.06;
  m.gravity = Vec3(0, 0, -9.81);
  m.disks = {disk("d", 0.38, 3, 0.02, 0.012)};
  m.bearings = {spring("left", 0.0, 1e7), spring("right", 0.6, 3e6)};
  auto thrust = named<model::Bearing>("thrust", 0.32);  // on the hub: offset
  model::LinearBearing k;
  k.K(0, 0) = 1e7;
  thrust.law = k;
  m.bearings.push_back(thrust);
  ask_equilibrium(m);
  const Built b = build(m);
  Rest rest(b);
  const meshes::MassProperties p = meshes::total_mass(m);
  const double W = p.mass * 9.81,
               right = W * p.centre().x() /
                       0.6;  // moments about the left bearing sit within z^2/L of this
  EXPECT_NEAR((rest.force(b, 0) + rest.force(b, 1)).z(), W, 1e-10 * W);
  EXPECT_NEAR(rest.force(b, 1).z(), right, 1e-7 * W);
  EXPECT_NEAR(rest.force(b, 2).x(), 0, 1e-6 * W);
}

TEST(BuildSystem, ConicalCantileverSagsAsTheIntegralSays) {
  model::Model m = one_shaft({cylinder("cone", 0.8, 0.08, 0.02, 1)});
  m.shafts[0].sections[0].od_r = 0.04;
  auto load = named<model::PointLoad>("tip", 0.8);
  load.force = Vec3(0, -1e-3, 0);  // small: linear
  m.loads = {load};
  m.bearings = {held("wall", 0.0, {true, true, true, true, true, true})};
  ask_equilibrium(m);
  for (int n : {1, 5}) {
    m.min_elements = n;
    const Built b = build(m);
    Rest rest(b);
    const elements::ElementSection s = element_section(m, {0, 0, {}, {}, 0, 0.8, 0, 1});
    double w = 0;
    const int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double x = (i + 0.5) / steps, arm = 0.8 * (1 - x);
      const elements::SectionProperties p = s.at(x);
      w += 0.8 / steps * (arm * arm / p.EI + 1 / p.kGA);
    }
    EXPECT_NEAR(rest.q[6 * n + 1], -1e-3 * w, 1e-8 * 1e-3 * w);  // midpoint rule: 1/20000^2
    EXPECT_NEAR(rest.force(b, 0).y(), 1e-3, 1e-13);
  }
}

TEST(BuildSystem, RigidOffsetsEqualManyStiffNodes) {
  // The same shaft with a rigid stretch and with a very stiff, massless one.
  const auto sag = [](bool is_rigid) {
    model::Model m = one_shaft({cylinder("a", 0.3, 0.05, 0, 2), cylinder("hub", 0.2, 0.05),
                                cylinder("b", 0.3, 0.05, 0, 2)});
    model::Section& hub = m.shafts[0].sections[1];
    if (is_rigid)
      hub = rigid("hub", 0.2);
    else
      hub.constants = model::Section::Constants{1e16, 0, 1e14, 1e14, 0, 0, 0};
    m.gravity = Vec3(0, 0, -9.81);
    m.disks = {disk("d", 0.35, 8, 0.05, 0.03)};
    m.bearings = {held("l", 0, {true, true, true, false, false, false}),
                  held("r", 0.8, {false, true, true, false, false, false})};
    ask_equilibrium(m);
    const meshes::Mesh mesh = meshes::make_mesh(m);
    const Built b = build_system(m, mesh);
    Rest rest(b);
    const meshes::Place p = mesh.place(m.disks[0].at);
    const double tilt = rest.problem.workspace().nodes[S(p.node)].t.z();
    return rest.q[6 * p.node + 2] + p.offset * tilt;
  };
  EXPECT_NEAR(
      sag(true) / sag(false), 1.0,
      1e-7);  // EI ratio of the "stiff" one: 1e14 / 6.4e4, but its matrix is that ill-conditioned
}

TEST(BuildSystem, PedestalTakesTheForce) {
  model::Model m = one_shaft({rigid("bar", 1.0, 0.05)});
  m.gravity = Vec3(0, 0, -9.81);
  auto l = spring("l", 0.0, 1e6), r = spring("r", 1.0, 1e6);
  Mat3 K = Mat3::Zero();
  K(1, 1) = 2e6;
  K(2, 2) = 4e6;
  l.pedestal = model::Pedestal{10, K, Mat3::Zero()};
  m.bearings = {l, r};
  ask_equilibrium(m);
  const meshes::Mesh mesh = meshes::make_mesh(m);
  const Built b = build_system(m, mesh);
  Rest rest(b);
  const double half = 0.5 * meshes::total_mass(m).mass * 9.81;
  EXPECT_NEAR(rest.force(b, 0).z(), half, 1e-6 * half);
  EXPECT_NEAR(rest.q[6 * mesh.bearings[0].pedestal + 2], -(half + 98.1) / 4e6, 1e-11);
  EXPECT_EQ(b.axially_free.size(), 1u);  // the pedestal has no axial spring either
}

TEST(BuildSystem, RigidBearingOnAPedestal) {
  model::Model m = one_shaft({cylinder("a", 1.0, 0.05, 0, 4)});
  m.gravity = Vec3(0, 0, -9.81);
  auto l = held("l", 0.0, {true, true, true, false, false, false}),
       r = held("r", 1.0, {false, true, true, false, false, false});
  l.pedestal = r.pedestal = model::Pedestal{10, 1e6 * Mat3::Identity(), Mat3::Zero()};
  m.bearings = {l, r};
  ask_equilibrium(m);
  const Built b = build(m);
  Rest rest(b);
  const double half = 0.5 * meshes::total_mass(m).mass * 9.81;
  EXPECT_NEAR(rest.q[2], -(half + 98.1) / 1e6,
              1e-10);  // holds all directions: the pedestal's mass is the shaft's
  EXPECT_NEAR(rest.q[6 * 4 + 2], -half / 1e6,
              1e-10);  // its mass acts in y and z only, without weight
}

TEST(BuildSystem, TwoRigidBearingsOnARigidBar) {
  model::Model m = one_shaft({rigid("bar", 1.0, 0.05), cylinder("overhang", 0.4, 0.05, 0, 2)});
  m.gravity = Vec3(0, -3, -9.81);
  m.bearings = {held("l", 0.2, {true, true, true, false, false, false}),
                held("r", 0.9, {false, true, true, false, false, false})};
  ask_equilibrium(m);
  const Built b = build(m);
  Rest rest(b);
  const meshes::MassProperties p = meshes::total_mass(m);
  const Vec3 right = -p.mass * m.gravity * (p.centre().x() - 0.2) / 0.7,
             left = -p.mass * m.gravity - right;
  // The overhang sags: its weight acts a little (sag^2/length) nearer.
  EXPECT_LT((rest.force(b, 0) - left).norm(), 1e-6 * left.norm());
  EXPECT_LT((rest.force(b, 1) - right).norm(), 1e-6 * right.norm());
  m.bearings.push_back(held("third", 0.5, {false, true, false, false, false, false}));
  EXPECT_THROW(build(m), Error);
}

TEST(BuildSystem, GeneralSectionBendsAsItsTwoPlanesSay) {
  model::Model m = one_shaft({cylinder("g", 0.5, 0, 0, 2)});
  m.shafts[0].sections[0].general = model::Section::General{1e-3, 2e-7, 1e-7, 2e-7, 0, 0, 0};
  m.bearings = {held("wall", 0.0, {true, true, true, true, true, true})};
  auto load = named<model::PointLoad>("tip", 0.5);
  load.force = Vec3(0, 1e-3, 1e-3);
  m.loads = {load};
  ask_equilibrium(m);
  const Built b = build(m);
  EXPECT_EQ(count<elements::GeneralBeam>(b), 2u);
  Rest rest(b);
  const double w = 1e-3 * 0.125 / 3 / 2.1e11;
  EXPECT_NEAR(rest.q[6 * 2 + 1], w / 1e-7, 1e-9 * w / 1e-7);  // along y: bends about z
  EXPECT_NEAR(rest.q[6 * 2 + 2], w / 2e-7, 1e-9 * w / 2e-7);
}

// ---------------------------------------------------------------- unrestrained motion

std::vector<Diagnostic> errors_of(const model::Model& m) {
  try {
    build(m);
  } catch (const Error& e) {
    EXPECT_EQ(e.exit(), Exit::deck);
    return e.diagnostics();
  }
  return {};
}

TEST(BuildSystem, NothingResistsAxialMotion) {
  model::Model m = one_shaft({cylinder("a", 1.0, 0.05, 0, 2)}, "hp");
  m.bearings = {spring("l", 0, 1e7), spring("r", 1, 1e2)};
  ask_equilibrium(m);
  const Built b = build(m);  // nothing loads it: equilibria hold it, small motions do not
  EXPECT_TRUE(b.system.active()[0]);
  EXPECT_EQ(b.axially_free, std::vector<Index>{0});
  model::Model in_time = m;  // a motion that starts from an equilibrium is held, and that is said
  in_time.steps[0].law = model::TransientStep{};
  std::get<model::TransientStep>(in_time.steps[0].law).start =
      model::TransientStep::Start::static_equilibrium;
  const Built moving = build(in_time);
  EXPECT_FALSE(moving.system.active()[0]);
  EXPECT_TRUE(moving.axially_free.empty());
  ASSERT_EQ(moving.left_out.size(), 1u);
  EXPECT_EQ(moving.left_out[0],
            "axial motion of shaft 'hp' as a whole: nothing resists or loads it; held at the node "
            "at 0 m of shaft 'hp'");
  m.gravity = Vec3(-9.81, 0, 0);
  auto e = errors_of(m);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(e[0].code, "E32");
  EXPECT_EQ(e[0].message, "nothing resists axial motion of shaft 'hp'");
  m.steps[0].law = model::TransientStep{};
  std::get<model::TransientStep>(m.steps[0].law).start = model::TransientStep::Start::rest;
  EXPECT_TRUE(errors_of(m).empty());  // from rest it may fall
  EXPECT_TRUE(build(m).system.active()[0]);
}

TEST(BuildSystem, NothingResistsLateralMotionOrTurning) {
  model::Model m = one_shaft({cylinder("a", 1.0, 0.05, 0, 2)}, "hp");
  m.gravity = Vec3(0, 0, -9.81);
  ask_equilibrium(m);
  auto e = errors_of(m);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(e[0].message, "nothing resists lateral motion of shaft 'hp' (y and z)");
  m.bearings = {spring("l", 0.25, 1e7)};
  e = errors_of(m);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(e[0].message,
            "nothing resists turning of shaft 'hp' about the point at 0.25 m (y and z)");
  auto second = spring("r", 0.75, 1e-3);  // however weak
  std::get<model::LinearBearing>(second.law).K(2, 2) = 0;
  m.bearings.push_back(second);
  e = errors_of(m);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(e[0].message, "nothing resists turning of shaft 'hp' about the point at 0.25 m (z)");
  std::get<model::LinearBearing>(m.bearings[1].law).K(5, 5) =
      1;  // holds the tilt about z, not that about y
  EXPECT_EQ(errors_of(m).size(), 1u);
  std::get<model::LinearBearing>(m.bearings[1].law).K(4, 4) = 1;
  EXPECT_TRUE(errors_of(m).empty());
  // Free in space is no mistake where nothing asks for an equilibrium.
  m.bearings.clear();
  m.gravity.setZero();
  m.steps[0].law = model::ModalStep{};
  EXPECT_TRUE(errors_of(m).empty());
  m.gravity.z() = -9.81;
  EXPECT_EQ(errors_of(m).size(), 1u);
}

TEST(BuildSystem, InnerSpoolHangsOnTheOuter) {
  model::Model m = one_shaft({cylinder("lp", 1.0, 0.04, 0, 2)}, "lp");
  model::Shaft hp;
  hp.name = "hp";
  hp.origin = Vec3(0.2, 0, 0);
  hp.sections = {cylinder("hp", 0.5, 0.12, 0.1, 2)};
  m.shafts.push_back(hp);
  m.gravity = Vec3(0, 0, -9.81);
  auto i1 = spring("i1", 0.2, 1e7), i2 = spring("i2", 0.7, 1e7);
  i1.to = place(0.0, 1);
  i2.to = place(0.5, 1);
  m.bearings = {i1, i2};
  ask_equilibrium(m);
  auto e = errors_of(m);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(e[0].message,
            "nothing resists lateral motion of shaft 'lp' and shaft 'hp' together (y and z)");
  m.bearings.push_back(spring("l", 0, 1e7));
  e = errors_of(m);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(e[0].message,
            "nothing resists turning of shaft 'lp' and shaft 'hp' together about the point at 0 m "
            "(y and z)");
  m.bearings.push_back(spring("r", 1, 1e7));
  EXPECT_TRUE(errors_of(m).empty());
  EXPECT_EQ(build(m).axially_free.size(), 2u);  // each slides freely
}

TEST(BuildSystem, CasingDoesNotTurnAndAPointMassRotorKeepsItsSpin) {
  model::Model m = one_shaft({cylinder("c", 1.0, 0.5, 0.48, 2)}, "frame");
  m.shafts[0].rotating = false;
  m.bearings = {spring("l", 0, 1e7), spring("r", 1, 1e7)};
  EXPECT_FALSE(build(m).system.active()[system::spin_phi]);

  model::Model j = one_shaft({cylinder("massless", 1.0, 0.01, 0, 2)}, "jeffcott");
  j.shafts[0].sections[0].constants = model::Section::Constants{1e7, 0, 100, 100, 0, 0, 0};
  j.shafts[0].spin0 = 50;
  j.disks = {disk("m", 0.5, 2, 0, 0)};
  j.bearings = {held("l", 0, {true, true, true, false, false, false}),
                held("r", 1, {false, true, true, false, false, false})};
  const Built b = build(j);
  EXPECT_FALSE(b.spins[0].prescribed);
  for (Index n = 0; n < 3; ++n)
    EXPECT_FALSE(b.system.active()[S(6 * n + system::spin_phi)]);
  ASSERT_EQ(b.coasting.size(), 1u);
  const auto angle = [&b](double t) {
    for (const system::Hold& h : b.system.holds())
      if (h.unknown == system::spin_phi) return h.law->at(t).f;
    return whirl::nan;
  };
  EXPECT_EQ(angle(2.0), 100.0);
  b.coasting[0].begin(1.0, 3.0, -20.0);  // time, angle, spin
  EXPECT_EQ(angle(2.0), -17.0);
}

TEST(BuildSystem, ImpossibleBodiesAndContradictions) {
  model::Model m = one_shaft({rigid("bar", 1.0, 0.05)});
  m.disks = {disk("thin", 0.5, 3, 0.02, 0.009)};
  auto e = errors_of(m);
  ASSERT_EQ(e.size(), 1u);
  EXPECT_EQ(e[0].code, "E24");
  EXPECT_EQ(e[0].message,
            "disk 'thin': Id = 0.009 kg m2 is less than Ip/2 = 0.01 kg m2; no body has such "
            "moments of inertia");
  m.disks[0] = disk("tensor", 0.5, 3, 0, 0);
  m.disks[0].inertia = Mat3(Vec3(1, 1, 3).asDiagonal());
  EXPECT_EQ(errors_of(m).at(0).code, "E24");
  m.disks.clear();
  auto self = spring("self", 0.1, 1e6);
  self.to = place(0.9);
  m.bearings = {self};
  EXPECT_EQ(errors_of(m).at(0).code, "E26");
  auto between = held("between", 0.1, {true, true, true, false, false, false});
  model::Shaft other = m.shafts[0];
  other.name = "other";
  m.shafts.push_back(other);
  between.to = place(0.5, 1);
  m.bearings = {between};
  EXPECT_EQ(errors_of(m).at(0).code, "E26");
}

}  // namespace
