// Beams and shafts that turn over many times: no tilt is a limit (system/frames.hpp).
#include "deck_model.hpp"
#include "exact_rod.hpp"
#include "free_motion.hpp"
#include "static_model.hpp"

#include <analysis/transient/transient.hpp>
#include <elements/loads/spin_torque.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/shaft_damping.hpp>
#include <elements/supports/spring_block.hpp>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

using namespace whirl;
using namespace whirl::test;

namespace {

enum class Kind { shaft, general };

/// Clamped beam along x of n elements with a force and a moment of fixed direction at its end.
struct Cantilever {
  system::System system;
  Index tip;
};

Cantilever cantilever(Kind kind, int n, double length, const BeamSection& section, const Vec3& F,
                      const Vec3& M) {
  system::Builder b;
  const Index line = b.add_line("beam");
  Index tip = 0;
  if (kind == Kind::general) {
    const auto straight = [](double s) { return LinePoint{Vec3(s, 0, 0), Mat3::Identity()}; };
    tip = add_beam(b, line, Mat3::Identity(), straight, 0.0, length, n, section);
  } else {
    elements::ElementSection e;
    e.constants = true;
    e.given = {section.EA,   section.kGA_B,  section.GJ,        section.EI_B,
               section.rhoA, section.rhoI_B, 2 * section.rhoI_B};
    b.add_node({Vec3::Zero(), line, "clamp"});
    const auto c = elements::make_shaft_constants(e, length / n);
    for (int i = 0; i < n; ++i) {
      tip = b.add_node({Vec3((i + 1) * length / n, 0, 0), line, "node"});
      b.add(elements::ShaftBeam<false>(c, Vec3::UnitX()), {tip - 1, tip}, "shaft");
    }
  }
  clamp(b, 0);
  b.add(elements::FixedLoad{F, M, 0.0, nullptr}, {tip}, "loads");
  return {b.finalize(), tip};
}

Vec3 tip_of(const Cantilever& c, int load_steps) {
  const system::State x = settle(c.system, load_steps);
  EXPECT_TRUE(x.frames.moved());
  return c.system.node(c.tip).position + displacement(x, c.tip);
}

}  // namespace

TEST(ManyTurns, RollUpByFiveTurns) {
  // r(L) = EI/M (sin(ML/EI), 1 - cos(ML/EI)); every element bends alike, so that whole turns close
  const double L = 10, EI = 100;
  const BeamSection section{1e6, 1e6, 1e6, 100, EI, EI};
  for (const Kind kind : {Kind::shaft, Kind::general})
    for (const double turns : {1.0, 3.0, 5.0}) {
      const double M = two_pi * turns * EI / L;
      const Vec3 r = tip_of(cantilever(kind, 40, L, section, Vec3::Zero(), Vec3(0, 0, M)), 40);
      EXPECT_LT(r.norm(), 1e-9 * L) << turns << " " << static_cast<int>(kind);
    }
}

TEST(ManyTurns, HelixOfTenTurnsConverges) {
  // End moment and a force across the plane it rolls the beam up in: A. Ibrahimbegovic, Comput.
  // Methods Appl. Mech. Engrg. 149 (1997) 49-71, doi 10.1016/S0045-7825(97)00059-5. Reference: the
  // rod equations by shooting.
  const double L = 10;
  // no shear: under axial force the elements tend to Engesser's rod, the reference is Haringx's
  const BeamSection section{1e6, 0, 0, 100, 100, 100};
  const Vec3 F(0, 0, 50), M(0, 0, 20 * pi * 10);
  ExactRod rod{section, L};
  rod.steps = 4000;
  const Vec3 exact = rod.solve(F, 40, M).r;
  for (const Kind kind : {Kind::shaft, Kind::general}) {
    double last = 0;
    for (const int n : {60, 120}) {
      const double error = (tip_of(cantilever(kind, n, L, section, F, M), 100) - exact).norm();
      std::printf("helix, %s, %d elements: %.3e m\n", kind == Kind::shaft ? "shaft" : "general", n,
                  error);
      if (last > 0) {
        EXPECT_GT(std::log2(last / error), 3.5);
      }
      last = error;
    }
    EXPECT_LT(last, 1e-4);
  }
}

namespace {

/// Displacement of the end of a clamped line of 10 m under a load, by a deck.
Vec3 tip_of_deck(bool rotating, const std::string& section, int n, const Vec3& F, const Vec3& M) {
  const DeckModel d(fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "beam"
rotating = {}
[[shaft.section]]
name = "line"
length = "10 m"
min_elements = {}
{}
[[bearing]]
name = "clamp"
at = "beam:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "beam:end"
force = ["{:.17g} N", "{:.17g} N", "{:.17g} N"]
moment = ["{:.17g} N.m", "{:.17g} N.m", "{:.17g} N.m"]
)",
                                rotating, n, section, F.x(), F.y(), F.z(), M.x(), M.y(), M.z()));
  const Solved s = solve(d.deck.model);
  const meshes::Line& line = s.mesh.lines[0];
  return s.node(line.first_node + line.nodes - 1).u;
}

const char* round_section =
    R"(constants = { EA = "1e6 N", kGA = "1e9 N", GJ = "100 N.m^2", EI = "100 N.m^2", rhoA = "1 kg/m", rhoI = "0.1 kg.m", rhoIp = "0.2 kg.m" })";

}  // namespace

TEST(ManyTurns, RollUpByFiveTurnsFromADeck) {
  const double M = two_pi * 5 * 100 / 10;
  for (const bool rotating : {false, true}) {
    const Vec3 u = tip_of_deck(rotating, round_section, 40, Vec3::Zero(), Vec3(0, 0, M));
    EXPECT_LT((u + Vec3(10, 0, 0)).norm(), 1e-8) << rotating;
  }
}

TEST(ManyTurns, HelixOfTenTurnsFromADeck) {
  const BeamSection section{1e6, 0, 0, 100, 100, 100};
  const Vec3 F(0, 0, 50), M(0, 0, 20 * pi * 10);
  ExactRod rod{section, 10};
  rod.steps = 4000;
  const Vec3 exact = rod.solve(F, 40, M).r - Vec3(10, 0, 0);
  double last = 0;
  for (const int n : {60, 120}) {
    const double error = (tip_of_deck(false, round_section, n, F, M) - exact).norm();
    std::printf("helix from a deck, %d elements: %.3e m\n", n, error);
    if (last > 0) {
      EXPECT_GT(std::log2(last / error), 3.5);
    }
    last = error;
  }
  EXPECT_LT(last, 1e-4);
}

TEST(ManyTurns, AFlexibleRotorTumblesAThousandRadians) {
  // Thrown: momentum and energy stay.
  const system::System s = free_rotor();
  system::State start = s.make_state();
  const Vec3 omega(5.0, 1.0, -10.0);
  for (Index i = 0; i < s.nodes(); ++i) {
    start.v.segment<3>(6 * i) = omega.cross(s.node(i).position);
    start.v.segment<3>(6 * i + 3) = omega;
  }
  system::SystemProblem problem(s);
  analysis::TransientOptions o;
  o.method = "gauss4";
  o.integrator.tolerance = 1e-6;
  o.integrator.t_end = 10.0;
  const auto momenta = [&](const system::State& x) {
    system::Workspace w = s.make_workspace();
    la::MCK m = s.make_matrices();
    EXPECT_TRUE(s.tangent(w, x.frames, x.t, x.q, x.v, x.a, m));
    const system::Energy e = s.energy(w);
    return e.kinetic + e.elastic;
  };
  const double before = momenta(start);
  const analysis::TransientResult r = analysis::run_transient(problem, start, o, {});
  ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
  EXPECT_TRUE(r.end.frames.moved());
  EXPECT_NEAR(momenta(r.end), before, 1e-4 * before);
}

TEST(ManyTurns, ARigidBodyTumblesAThousandTimes) {
  tumble_a_thousand_times("A rigid body over 1,000 tumbles", free_body(), Vec3(0.3, 10, 0.2), 700.0,
                          "gauss4", 1e-6, 1e-4, 1e-4);
}

namespace {

/// A free shaft of 10 m with EI = 500 N m^2, first bending about 5 rad/s, as of the flying beam.
system::System free_beam(Kind kind, int n) {
  const double L = 10;
  const BeamSection section{1e4, 1e4, 1e4, 500, 500, 500, 1, 10, 10};
  system::Builder b;
  const Index line = b.add_line("beam");
  if (kind == Kind::general) {
    const auto straight = [](double s) { return LinePoint{Vec3(s, 0, 0), Mat3::Identity()}; };
    add_beam(b, line, Mat3::Identity(), straight, -0.5 * L, 0.5 * L, n, section);
    return b.finalize();
  }
  elements::ElementSection e;
  e.constants = true;
  e.given = {section.EA,   section.kGA_B,  section.GJ,        section.EI_B,
             section.rhoA, section.rhoI_B, 2 * section.rhoI_B};
  const auto c = elements::make_shaft_constants(e, L / n);
  b.add_node({Vec3(-0.5 * L, 0, 0), line, "left"});
  for (int i = 1; i <= n; ++i) {
    b.add_node({Vec3(i * L / n - 0.5 * L, 0, 0), line, "node"});
    b.add(elements::ShaftBeam<false>(c, Vec3::UnitX()), {i - 1, i}, "shaft");
  }
  return b.finalize();
}

}  // namespace

TEST(ManyTurns, AFlexibleBodyTumblesAThousandTimes) {
  // End over end at a fifth of its lowest frequency, let go unbent: what it keeps is lost by the
  // integrator alone, the less the smaller the tolerance.
  tumble_a_thousand_times("A flexible body over 1,000 tumbles, tolerance 1e-6",
                          free_beam(Kind::shaft, 2), Vec3(0.2, 0.1, 1.0), 6300.0, "gauss6", 1e-6,
                          1e-4, 1e-5);
}

TEST(ManyTurns, AFlexibleBodyTumblesAThousandTimesClosely) {
  tumble_a_thousand_times("A flexible body over 1,000 tumbles, tolerance 1e-9",
                          free_beam(Kind::shaft, 2), Vec3(0.2, 0.1, 1.0), 6300.0, "gauss6", 1e-9,
                          1e-6, 2e-7);
}

TEST(ManyTurns, ADriveAtALargeTiltDoesNotSeeTheAxesChange) {
  // The rotor of Sorokin and Zhang tilted by 2.2 rad, with a torque on its axial angle: by changing
  // axes under way, and in the line's own all the time.
  system::Builder b;
  const Index line = b.add_line("rod");
  const Index node = b.add_node({Vec3::Zero(), line, "rod"});
  b.add(elements::RigidDisk{5.0, 0.12, 0.1, 0.75}, {node}, "disk");
  elements::SpringBlock springs;
  springs.C1 = 2000;
  springs.C2 = 500;
  b.add(springs, {node}, "springs");
  elements::TorqueLaw law;
  law.of_time = make_constant(-4.0);
  law.viscous = 0.01;
  law.governor = elements::TorqueLaw::Governor{30.0, 0.05, 0.2};
  b.add(elements::JointTorque{law}, {node}, "drive");
  b.set_gravity(Vec3(0, 0, -9.81));
  const system::System s = b.finalize();
  system::State start = s.make_state();
  start.q[4] = 2.2;
  start.v.segment<3>(3) = Vec3(20, 3, -5);
  std::array<Vec3, 2> disk;
  std::array<double, 2> angle;
  for (const bool change : {false, true}) {
    system::SystemProblem problem(s, {la::SolverKind::automatic, change});
    analysis::TransientOptions o;
    o.integrator.tolerance = 1e-9;
    o.integrator.t_end = 1.0;
    const analysis::TransientResult r = analysis::run_transient(problem, start, o, {});
    ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
    EXPECT_EQ(r.end.frames.moved(), change);
    disk[change] = displacement(r.end, node) + 0.75 * r.end.normals()[0];
    angle[change] = r.end.total_phi(node, line);
  }
  EXPECT_LT((disk[0] - disk[1]).norm(), 1e-7);
  EXPECT_NEAR(angle[0], angle[1], 1e-6);
}
