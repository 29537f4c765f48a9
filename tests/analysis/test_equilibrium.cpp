// Static and spinning equilibria against closed forms; diagnosis of what cannot stand.
#include "rotors.hpp"

#include <analysis/statics/equilibrium.hpp>
#include <core/error.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/loads/spin_torque.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::tests;

namespace {

Equilibrium solve(const system::System& s, double Omega = 0, double load = 1,
                  SteadyRotation running = {}) {
  running.mean = Omega != 0;
  SteadySystem r(s, running);
  r.set_load(load);
  return EquilibriumSolver(r).solve(Omega);
}

}  // namespace

// Sag of the two-disk rotor: Timoshenko beam closed form (exact at nodes). Loads times 1e-4 and
// results times 1e4, so that the geometric nonlinearity (slope^2 = 4e-6 at full load) drops below
// the tolerance.
TEST(Equilibrium, SagOfTheTwoDiskRotor) {
  for (int n : {6, 24}) {
    TwoDisk rotor(n);
    rotor.b.set_gravity(Vec3(0, 0, -9.81));
    const system::System s = rotor.b.finalize();
    const Equilibrium e = solve(s, 0, 1e-4);
    const double expected[] = {-0.0004944509431, -0.001303792929, -0.0013445792, -0.0005563701375};
    for (int k = 0; k < 4; ++k) {
      const Index i = rotor.at(0.5 * k);
      EXPECT_NEAR(1e4 * e.state.q[6 * i + 2], expected[k], 1e-9 * std::abs(expected[k]));
      EXPECT_NEAR(e.state.q[6 * i + 1], 0.0, 1e-18);
    }
    // dv/dx of the section: d_z = -gamma2 to first order (gamma x e, e = x)
    EXPECT_NEAR(-1e4 * e.state.q[6 * rotor.at(0) + 4], -0.001921605587, 1e-9 * 0.0019);
    EXPECT_NEAR(-1e4 * e.state.q[6 * rotor.at(1.5) + 4], 0.001918756454, 1e-9 * 0.0019);
    EXPECT_EQ(e.spin_holds.size(), 1u);
  }
}

// At full load the pins of a simply supported shaft carry exactly its weight, whatever the
// deflection.
TEST(Equilibrium, ReactionsCarryTheWeight) {
  Rotor rotor;
  rotor.add_shaft(cylinder(0.05, 2.11e11, 8.12e10, 7810), 1.0, 8).pin(0, true).pin(1.0);
  rotor.b.set_gravity(Vec3(0, 0, -9.81));
  const system::System s = rotor.b.finalize();
  const Equilibrium e = solve(s, 100.0);
  const double weight = 9.81 * 7810 * pi / 4 * 0.05 * 0.05 * 1.0;
  EXPECT_NEAR(e.reactions[6 * rotor.at(0) + 2], 0.5 * weight, 1e-9 * weight);
  EXPECT_NEAR(e.reactions[6 * rotor.at(1.0) + 2], 0.5 * weight, 1e-9 * weight);
  // 5 w L^4/(384 EI) + w L^2/(8 kGA), kappa = 0.886306; nonlinear geometry changes slope^2 = 1e-8
  // of it
  EXPECT_NEAR(e.state.q[6 * rotor.at(0.5) + 2], -3.039219629e-05, 1e-8 * 3.04e-5);
  EXPECT_NEAR(e.reactions[e.spin_holds.at(0)], 0.0, 1e-9);  // no torque is needed to keep turning
}

// A cantilever under an end moment bends to an arc: x = EI/M sin(M L/EI), z = EI/M (1 - cos(M
// L/EI)). At 0.9 pi the split element stays within its chart. Constant curvature is an exact state
// of the element but for the chord's quartic term, hence order 4.
TEST(Equilibrium, EndMomentBendsToAnArcWithOrderFour) {
  const double L = 10, EI = 86900, M = 0.9 * pi * EI / L;
  double error[2];
  for (int k = 0; k < 2; ++k) {
    Rotor rotor;
    rotor.add_shaft(constants(1.77e6, 1.77e6, 8160, EI, 1), L, 8 << k).clamp(0);
    rotor.b.add(elements::FixedLoad{Vec3::Zero(), Vec3(0, -M, 0), 0, nullptr}, {rotor.at(L)},
                "moment");
    const system::System s = rotor.b.finalize();
    const Equilibrium e = solve(s);
    const Vec3 tip = s.node(rotor.at(L)).position + e.state.q.segment<3>(6 * rotor.at(L));
    const double r = EI / M;
    error[k] = (tip - Vec3(r * std::sin(L / r), 0, r * (1 - std::cos(L / r)))).norm();
    const Vec3 d = e.state.normals()[at(rotor.at(L))];
    EXPECT_NEAR(std::atan2(d.z(), d.x()), 0.9 * pi, 1e-9);  // the tip's rotation is exact
    EXPECT_NEAR(e.reactions[4], M, 1e-8 * M);
  }
  EXPECT_LT(error[1], 1e-4 * L);
  EXPECT_NEAR(std::log2(error[0] / error[1]), 4.0, 0.1);
}

// Torsional wind-up far beyond a turn: T L/(GJ) = 8 pi; five spans of 1 m held laterally (buckling
// needs 40.8 rad).
TEST(Equilibrium, TorsionalWindUpOfFourTurns) {
  Rotor rotor;
  rotor.add_shaft(cylinder(0.02, 2.08e11, 8e10, 7850), 5.0, 10).clamp(0);
  for (double x = 1; x < 5.5; x += 1)
    rotor.pin(x);
  const double T = 6316.546817;
  rotor.b.add(elements::FixedLoad{Vec3::Zero(), Vec3(T, 0, 0), 0, nullptr}, {rotor.at(5)},
              "torque");
  const system::System s = rotor.b.finalize();
  const Equilibrium e = solve(s);
  EXPECT_NEAR(e.state.q[6 * rotor.at(5) + 3], 25.13274123, 25.13 * 1e-9);  // the table's digits
  EXPECT_NEAR(e.reactions[3], -T, 1e-9 * T);
  system::Workspace w = s.make_workspace();
  ASSERT_TRUE(s.evaluate_nodes(w, e.state.frames, 0, e.state.q, e.state.v, e.state.a));
  EXPECT_NEAR(s.energy(w).elastic, 79376.0683, 79376 * 1e-9);
}

// Axial preload and rest shape do not disturb: an unloaded rotor is in equilibrium at once.
TEST(Equilibrium, NothingToDo) {
  TwoDisk rotor(6);
  const system::System s = rotor.b.finalize();
  const Equilibrium e = solve(s, 500.0);
  EXPECT_EQ(e.iterations, 0);
  EXPECT_TRUE(e.state.q.isZero(0.0));
  EXPECT_EQ(e.state.v[3], 500.0);
}

// A rotor driven at one end and loaded at the other winds up; the hold at its first node carries
// nothing when the torques balance.
TEST(Equilibrium, DriveAndLoadTorque) {
  TwoDisk rotor(6);
  elements::JointTorque drive, load;
  drive.law.of_time = make_constant(300.0);
  load.law.viscous = 1.0;
  rotor.b.add(drive, {rotor.at(0)}, "torque");
  rotor.b.add(load, {rotor.at(1.5)}, "torque");
  const system::System s = rotor.b.finalize();
  const double GJ = 8.12e10 * pi / 32 * std::pow(0.05, 4);
  const Equilibrium e = solve(s, 300.0);
  EXPECT_NEAR(e.state.q[6 * rotor.at(1.5) + 3], -300.0 * 1.5 / GJ, 1e-9 * 300.0 * 1.5 / GJ);
  EXPECT_NEAR(e.reactions[e.spin_holds.at(0)], 0.0, 1e-7);
  const Equilibrium faster = solve(s, 400.0);  // 100 N m are missing
  EXPECT_NEAR(faster.reactions[faster.spin_holds.at(0)], 100.0, 1e-7);
}

// What turns with the rotor has no part in the mean equilibrium.
TEST(Equilibrium, UnbalanceIsAveragedAway) {
  TwoDisk rotor(6), plain(6);
  for (TwoDisk* r : {&rotor, &plain})
    r->b.set_gravity(Vec3(0, 0, -9.81));
  rotor.add_unbalance(0.5, 1e-3, 0.7);
  const system::System s = rotor.b.finalize(), p = plain.b.finalize();
  const Equilibrium a = solve(s, 300.0), b = solve(p, 300.0);
  // The unbalance keeps only the weight's 1X torque on phi, which averages out too.
  EXPECT_LT((a.state.q - b.state.q).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Equilibrium, NamesWhatIsNotResisted) {
  Rotor rotor;
  rotor.add_shaft(cylinder(0.05, 2.11e11, 8.12e10, 7810), 1.0, 4)
      .add_bearing(0, 1e6, 1e6)
      .add_bearing(1.0, 1e6, 1e6);
  rotor.b.set_gravity(Vec3(0, 0, -9.81));
  const system::System s = rotor.b.finalize();
  try {
    solve(s);
    FAIL() << "an axially free shaft has no unique equilibrium";
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().at(0).code, "E75");
    EXPECT_NE(std::string(e.what()).find("nothing resists axial motion of shaft 'rotor'"),
              std::string::npos)
        << e.what();
  }
}

TEST(Equilibrium, SaysWhenAShaftCannotTurn) {
  Rotor rotor;
  rotor.add_shaft(cylinder(0.05, 2.11e11, 8.12e10, 7810), 1.0, 4).pin(0, true).pin(1.0);
  rotor.b.hold(rotor.at(0), system::spin_phi);
  const system::System s = rotor.b.finalize();
  try {
    solve(s, 100.0);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().at(0).code, "E78");
  }
  SteadyRotation still;
  still.ratio = {0.0};
  EXPECT_NO_THROW(solve(s, 100.0, 1.0, still));
  EXPECT_NO_THROW(solve(s, 0.0));
}

// A roll-up to the full circle and beyond needs a chart of its own for every node.
TEST(Equilibrium, RollUpToAFullCircleAndTwoTurns) {
  const double L = 10, EI = 86900;
  const int n = 24;
  for (double turns : {1.0, 2.0}) {
    system::Builder b;
    std::vector<Index> node;
    for (int i = 0; i <= n; ++i) {
      const std::string name = "node " + std::to_string(i);
      node.push_back(b.add_node({Vec3(L * i / n, 0, 0), b.add_line(name), name}));
    }
    elements::GeneralBeamConstants c;
    const double l = L / n, Phi = 12 * EI / (1.77e6 * l * l);
    c.length = l;
    c.EA_l = 1.77e6 / l;
    c.GJ_l = 8160 / l;
    c.kz_def11 = c.kz_def22 = c.ky_def11 = c.ky_def22 = EI * (4 + Phi) / (l * (1 + Phi));
    c.kz_def12 = c.ky_def12 = EI * (2 - Phi) / (l * (1 + Phi));
    const double q = (1 + Phi) * (1 + Phi);
    c.b11 = c.b22 = (2.0 / 15 + Phi / 6 + Phi * Phi / 12) / q;
    c.b12 = -(1.0 / 30 + Phi / 6 + Phi * Phi / 12) / q;
    for (int i = 0; i < n; ++i)
      b.add(elements::GeneralBeam(c, Vec3(l, 0, 0), Mat3::Identity(), Mat3::Identity()),
            {node[i], node[i + 1]}, "beams");
    for (int k = 0; k < 6; ++k)
      b.hold(node[0], k);
    b.add(elements::FixedLoad{Vec3::Zero(), Vec3(0, -two_pi * turns * EI / L, 0), 0, nullptr},
          {node[n]}, "moment");
    const system::System s = b.finalize();
    const Equilibrium e = solve(s);
    const Vec3 tip = s.node(node[n]).position + e.state.q.segment<3>(6 * node[n]);
    EXPECT_LT(tip.norm(), 1e-9) << turns
                                << " turns";  // every element bends alike: the polygon closes
  }
}
