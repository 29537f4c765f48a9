// Statics of shafts in their bearings against closed forms: sag, reactions, section forces,
// stresses, preload, thermal offset, torque.
#include "../meshes/models.hpp"
#include "record.hpp"
#include "static_model.hpp"

#include <core/rotation.hpp>
#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::test;

namespace {

/// Rotor of example 5.9.1 of M. Friswell, J. Penny, S. Garvey, A. Lees, Dynamics of Rotating
/// Machines, Cambridge 2010: 1.5 m shaft of 50 mm, disks at 0.5 m (280 x 70 mm) and 1.0 m (350 x 70
/// mm), bearings of 1 MN/m at the ends.
model::Model two_disks(int elements) {
  model::Model m;
  model::Material s;
  s.name = "steel";
  s.E = 211e9;
  s.G = 81.2e9;
  s.nu = s.E / (2 * s.G) - 1;
  s.rho = 7810;
  m.materials = {s};
  model::Shaft shaft;
  shaft.name = "shaft";
  for (const char* name : {"a", "b", "c"})
    shaft.sections.push_back(cylinder(name, 0.5, 0.05, 0, elements));
  m.shafts = {shaft};
  const auto add_disk = [&](double s0, double od) {
    const double di = 0.05, w = 0.07, mass = 7810 * pi / 4 * (od * od - di * di) * w;
    m.disks.push_back(disk("disk", s0, mass, mass * (od * od + di * di) / 8,
                           mass * (3 * (od * od + di * di) + 4 * w * w) / 48));
  };
  add_disk(0.5, 0.28);
  add_disk(1.0, 0.35);
  m.bearings = {spring("left", 0.0, 1e6), spring("right", 1.5, 1e6)};
  std::get<model::LinearBearing>(m.bearings[0].law).K(0, 0) = 1e6;
  m.gravity = Vec3(0, -9.81, 0);
  return m;
}

}  // namespace

TEST(StaticRotor, SagReactionsAndSlopesOfTwoDisks) {
  Record record(
      "Static sag of the two-disk rotor",
      "closed form of the Timoshenko beam (Cowper 1966); load divided by 1000, values multiplied");
  // The closed form is that of the linear Timoshenko beam; large rotation enters with the square of
  // the slope, 2e-3: the load is divided by 1000, which leaves 4e-12.
  const double f = 1e-3;
  for (int n : {1, 2, 8}) {
    const std::string elements = std::to_string(n) + " elements a section";
    const model::Model m = two_disks(n);
    EXPECT_NEAR(m.disks[0].mass, 32.58972765, 1e-8);
    EXPECT_NEAR(m.disks[1].mass, 51.52526111, 1e-8);
    const Solved s = solve(m, 0.0, f);
    const double expected[4] = {-0.0004944509431, -0.001303792929, -0.0013445792, -0.0005563701375};
    for (int k = 0; k < 4; ++k)
      record.check(elements + ", sag at " + std::to_string(500 * k) + " mm", "m",
                   s.node_at(place(0.5 * k)).u.y() / f, expected[k], 1e-9 * 1.4e-3);
    record.check(elements + ", left reaction", "N", s.support(0).y() / f, 494.4509431, 1e-9 * 495);
    record.check(elements + ", right reaction", "N", s.support(1).y() / f, 556.3701375, 1e-9 * 557);
    record.check(elements + ", slope at the left end", "rad", s.node_at(place(0)).t.y() / f,
                 -0.001921605587, 1e-9 * 2e-3);
    EXPECT_NEAR(s.node_at(place(1.5)).t.y() / f, 0.001918756454, 1e-9 * 2e-3);
  }
}

TEST(StaticRotor, SectionForcesAndStresses) {
  const double f = 1e-3, g = 9.81;
  const model::Model m = two_disks(2);
  const Solved s = solve(m, 0.0, f);
  const double w = 7810 * pi / 4 * 0.05 * 0.05 * g, R1 = 494.4509431, P1 = m.disks[0].mass * g,
               P2 = m.disks[1].mass * g;
  const double I = pi / 64 * std::pow(0.05, 4);
  std::size_t checked = 0;
  for (const assembly::SectionPoint& p : s.sections) {
    // Force and moment of the right part on the left one.
    const double x = p.s;
    const bool after1 = x > 0.5 || (x == 0.5 && p.xi == 0.0),
               after2 = x > 1.0 || (x == 1.0 && p.xi == 0.0);
    const double V = -(R1 - w * x - (after1 ? P1 : 0) - (after2 ? P2 : 0));
    const double M =
        R1 * x - 0.5 * w * x * x - (after1 ? P1 * (x - 0.5) : 0) - (after2 ? P2 * (x - 1.0) : 0);
    EXPECT_NEAR(p.V.x() / f, V, 1e-8 * 557) << x;
    EXPECT_NEAR(p.M.y() / f, M, 1e-8 * 260)
        << x;  // quadratic between nodes: the interpolation is exact
    EXPECT_NEAR(p.V.y(), 0.0, 1e-12);
    EXPECT_NEAR(p.T, 0.0, 1e-12);
    ASSERT_TRUE(p.has_stress);
    EXPECT_NEAR(p.bending / f, std::abs(M) * 0.025 / I, 1e-8 * 22e6);
    ++checked;
  }
  EXPECT_EQ(checked, 6u * 5u);
}

TEST(StaticRotor, UniformPinnedShaft) {
  Record record("Sag of a uniform pinned shaft",
                "5 w L^4/(384 EI) + w L^2/(8 kGA), Cowper's kappa");
  // kappa = 0.886306
  for (int n : {2, 6}) {
    model::Model m;
    model::Material s;
    s.name = "steel";
    s.E = 211e9;
    s.G = 81.2e9;
    s.nu = s.E / (2 * s.G) - 1;
    s.rho = 7810;
    m.materials = {s};
    model::Shaft shaft;
    shaft.name = "shaft";
    shaft.sections = {cylinder("a", 0.5, 0.05, 0, n / 2), cylinder("b", 0.5, 0.05, 0, n / 2)};
    m.shafts = {shaft};
    m.bearings = {held("l", 0, {true, true, true, false, false, false}),
                  held("r", 1.0, {false, true, true, false, false, false})};
    m.gravity = Vec3(0, 0, -9.81);
    record.check(std::to_string(n) + " elements: middle", "m",
                 solve(m, 0.0, 1e-2).node_at(place(0.5)).u.z() / 1e-2, -3.039219629e-05,
                 1e-9 * 3.04e-5);
  }
}

TEST(StaticRotor, TorqueTensionAndBendingTogether) {
  // Cantilever with an end load of every kind; stresses by the elementary formulas. Small loads:
  // the formulas are linear.
  model::Model m;
  m.materials = {steel()};
  model::Shaft shaft;
  shaft.name = "shaft";
  shaft.sections = {cylinder("a", 0.8, 0.04, 0.02, 4)};
  m.shafts = {shaft};
  m.bearings = {held("wall", 0, {true, true, true, true, true, true})};
  auto load = named<model::PointLoad>("end", 0.8);
  load.force = Vec3(3.0, -0.02, 0.01);
  load.moment = Vec3(0.5, 0, 0);
  m.loads = {load};
  const Solved s = solve(m);
  const assembly::SectionPoint& p = s.sections.front();
  const double A = pi / 4 * (0.04 * 0.04 - 0.02 * 0.02),
               I = pi / 64 * (std::pow(0.04, 4) - std::pow(0.02, 4));
  // second-order effects: slope 1e-6 times 3 N
  EXPECT_NEAR(p.N, 3.0, 1e-5);
  EXPECT_NEAR(p.T, 0.5, 1e-6);
  EXPECT_NEAR(p.V.x(), -0.02, 1e-5);
  EXPECT_NEAR(p.V.y(), 0.01, 1e-5);
  EXPECT_NEAR(p.M.y(), -0.016, 1e-5);
  EXPECT_NEAR(p.M.x(), -0.008, 1e-5);
  const double axial = 3.0 / A, bending = std::hypot(0.016, 0.008) * 0.02 / I,
               torsion = 0.5 * 0.02 / (2 * I);
  EXPECT_NEAR(p.von_mises, std::sqrt(std::pow(axial + bending, 2) + 3 * torsion * torsion),
              1e-3 * p.von_mises);
  // reaction moment of the wall balances the load
  const Vec3 M = s.built.support_forces[0].moment(
      [&](Index n) -> const system::NodeState& { return s.node(n); }, system::Context{},
      [&](Index k) { return s.r[k]; });
  EXPECT_NEAR((M - Vec3(-0.5, 0.008, 0.016)).norm(), 0.0, 1e-5);
}

TEST(StaticRotor, StressesAlongAHollowCone) {
  // Cantilever, outer and inner diameter falling along it, under axial, transverse and torsional
  // load at its free end: at every point the diameters of that point.
  model::Model m;
  m.materials = {steel()};
  model::Shaft shaft;
  shaft.name = "shaft";
  model::Section cone = cylinder("cone", 0.6, 0.08, 0.05, 3);
  cone.od_r = 0.05;
  cone.id_r = 0.01;
  shaft.sections = {cone};
  m.shafts = {shaft};
  m.bearings = {held("wall", 0, {true, true, true, true, true, true})};
  auto load = named<model::PointLoad>("end", 0.6);
  load.force = Vec3(-0.1, 0.3, -0.4);
  load.moment = Vec3(0.02, 0, 0);
  m.loads = {load};
  const Solved s = solve(m);
  bool surface_decides = false, middle_decides = false;
  for (const assembly::SectionPoint& p : s.sections) {
    const double x = p.s / 0.6, c = 0.5 * (0.08 - 0.03 * x), r = 0.5 * (0.05 - 0.04 * x);
    const double A = pi * (c * c - r * r), I = pi / 4 * (std::pow(c, 4) - std::pow(r, 4));
    // mean shear at the neutral axis: V Q/(I b), Q of the half ring, b both walls
    const double Q = 2.0 / 3.0 * (std::pow(c, 3) - std::pow(r, 3)), b = 2 * (c - r);
    const double axial = -0.1 / A, bending = 0.5 * (0.6 - p.s) * c / I,
                 torsion = 0.02 * c / (2 * I), shear = 0.5 * Q / (I * b);
    const double surface = std::hypot(std::abs(axial) + bending, std::sqrt(3.0) * torsion),
                 middle = std::hypot(axial, std::sqrt(3.0) * (torsion + shear));
    (surface > middle ? surface_decides : middle_decides) = true;
    const double small = 1e-6 * std::max(surface, middle);  // large rotation: slopes of 1e-7
    EXPECT_NEAR(p.axial, axial, small) << p.s;
    EXPECT_NEAR(p.bending, bending, small) << p.s;
    EXPECT_NEAR(p.torsion, torsion, small) << p.s;
    EXPECT_NEAR(p.von_mises, std::max(surface, middle), small) << p.s;
  }
  EXPECT_TRUE(surface_decides && middle_decides);
}

TEST(StaticRotor, WeightOfAConeDoesNotDependOnTheChart) {
  // The energy of gravity is a potential of position: the same after the reference axes were moved.
  model::Model m;
  m.materials = {steel()};
  model::Shaft shaft;
  shaft.name = "shaft";
  model::Section cone = cylinder("cone", 0.6, 0.08, 0.01, 2);
  cone.od_r = 0.02;
  shaft.sections = {cone};
  m.shafts = {shaft};
  m.gravity = Vec3(3, -9.81, 2);
  m.bearings = {spring("a", 0.0, 1e5), spring("b", 0.6, 1e5)};
  for (const bool general : {false, true}) {
    if (general)
      m.shafts[0].sections[0].general =
          model::Section::General{1e-3, 4e-7, 2e-7, 1e-7, 0.85, 0.85, 0.3};
    const meshes::Mesh mesh = meshes::make_mesh(m);
    const assembly::Built built = assembly::build_system(m, mesh);
    const system::System& sys = built.system;
    system::SystemProblem problem(sys);
    system::State s = sys.make_state();
    for (Index n = 0; n < mesh.lines[0].nodes; ++n) {
      s.q.segment<3>(6 * n) = Vec3(0.01 * static_cast<double>(n), -0.02, 0.03);
      s.q.segment<3>(6 * n + 3) =
          Vec3(0.2, 0.3, 2.1 + 0.05 * static_cast<double>(n));  // beyond rotation::chart_switch
    }
    VecX r(sys.size());
    const auto gravity = [&] {
      EXPECT_TRUE(problem.residual(0, s.q, s.v, s.a, r));
      problem.power(0, s.q, s.v, s.a, r);
      return problem.energy().gravity;
    };
    const double before = gravity();
    ASSERT_TRUE(problem.accept(0, s.q, s.v, s.a));
    EXPECT_GT((problem.frames.axes(0).col(0) - Vec3::UnitX()).norm(), 0.5);
    EXPECT_NEAR(gravity(), before, 1e-12 * std::abs(before)) << general;  // rounding
  }
}

TEST(StaticRotor, FreeMotionIsNamed) {
  // Nothing holds the shaft along its axis, and a load pulls it there.
  model::Model m = two_disks(2);
  std::get<model::LinearBearing>(m.bearings[0].law).K(0, 0) = 0;
  m.shafts[0].name = "hp";
  try {
    solve(m);
    FAIL() << "an equilibrium without support";
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().front().code, "E75");
    EXPECT_NE(std::string(e.what()).find("nothing resists axial motion of shaft 'hp'"),
              std::string::npos)
        << e.what();
  }
  m.bearings.pop_back();
  m.bearings[0].law = model::LinearBearing{};
  std::get<model::LinearBearing>(m.bearings[0].law).K(2, 2) = 1e6;
  try {
    solve(m);
    FAIL() << "an equilibrium without support";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("of shaft 'hp'"), std::string::npos) << e.what();
  }
}

TEST(StaticRotor, ThermalGrowthFreeAndHeldBack) {
  // alpha dT L of a free end; -EA alpha dT between two walls.
  model::Model m;
  m.materials = {steel()};
  m.materials[0].expansion = 12e-6;
  model::Shaft shaft;
  shaft.name = "shaft";
  shaft.sections = {cylinder("a", 0.5, 0.04, 0, 2), cylinder("b", 0.3, 0.04, 0, 2)};
  for (model::Section& s : shaft.sections)
    s.temperature_rise = 60;
  m.shafts = {shaft};
  m.bearings = {held("l", 0, {true, true, true, true, false, false}),
                held("r", 0.8, {false, true, true, false, false, false})};
  for (const bool general : {false, true}) {
    if (general)
      for (model::Section& s : m.shafts[0].sections)
        s.general = model::Section::General{pi * 4e-4, 1e-7, 2e-7, 3e-7, 0.9, 0.9, 0.2};
    const Solved free = solve(m);
    EXPECT_NEAR(free.node_at(place(0.8)).u.x(), 12e-6 * 60 * 0.8, 1e-12);
    EXPECT_NEAR(free.sections.front().N, 0.0, 1e-6);  // of 190 kN
    model::Model walls = m;
    walls.bearings[1] = held("r", 0.8, {true, true, true, false, false, false});
    const Solved held_back = solve(walls);
    EXPECT_NEAR(held_back.sections.front().N, -2.1e11 * pi * 4e-4 * 12e-6 * 60, 1e-6 * 1.9e5);
    EXPECT_NEAR(held_back.support(0).x(), 2.1e11 * pi * 4e-4 * 12e-6 * 60, 1e-6 * 1.9e5);
  }
}

TEST(StaticRotor, PreloadOfAGeneralSectionStiffensIt) {
  // String under tension: deflection of the middle P L/(4 N) as the tension outweighs the bending
  // stiffness; and equal to the round element's.
  double w[2];
  for (int general = 0; general < 2; ++general) {
    model::Model m;
    m.materials = {steel()};
    model::Shaft shaft;
    shaft.name = "wire";
    shaft.sections = {cylinder("a", 0.5, 0.002, 0, 40),
                      cylinder("b", 0.5, 0.002, 0,
                               40)};  // the ends and the load bend it within EI/N's root, 18 mm
    shaft.axial_preload = 500.0;
    if (general == 1)
      for (model::Section& s : shaft.sections) {
        const double d = 0.002, I = pi / 64 * std::pow(d, 4), nu = 0.3,
                     kappa = 6 * (1 + nu) / (7 + 6 * nu);
        s.general = model::Section::General{pi / 4 * d * d, I, I, 2 * I, kappa, kappa, 0.0};
      }
    m.shafts = {shaft};
    m.bearings = {held("l", 0, {true, true, true, true, false, false}),
                  held("r", 1.0, {true, true, true, false, false, false})};
    auto load = named<model::PointLoad>("middle", 0.5);
    load.force = Vec3(0, -1e-3, 0);
    m.loads = {load};
    w[general] = solve(m).node_at(place(0.5)).u.y();
  }
  EXPECT_NEAR(w[1], w[0], 1e-9 * std::abs(w[0]));
  // T. Timoshenko, Strength of Materials II: P L/(4 N) (1 - tanh(u)/u), u = L/2 sqrt(N/EI); shear
  // adds 1e-4
  const double EI = 2.1e11 * pi / 64 * std::pow(0.002, 4), u = 0.5 * std::sqrt(500.0 / EI);
  EXPECT_NEAR(w[0], -1e-3 / (4 * 500.0) * (1 - std::tanh(u) / u), 1e-3 * std::abs(w[0]));
}

TEST(StaticRotor, BowedShaftTakesItsShapeAndTurnsIt) {
  // Unloaded on two supports it stands bowed by A sin(pi s/L); weight adds its sag; at the turned
  // angle the bow is elsewhere.
  model::Model m;
  m.materials = {steel()};
  model::Shaft shaft;
  shaft.name = "shaft";
  shaft.sections = {cylinder("a", 0.4, 0.03, 0, 4), cylinder("b", 0.4, 0.03, 0.01, 4)};
  shaft.bow = {1e-4, 0.5};
  m.shafts = {shaft};
  m.bearings = {held("l", 0, {true, true, true, true, false, false}),
                held("r", 0.8, {false, true, true, false, false, false})};
  const Solved s = solve(m);
  // slopes are 4e-4, their squares 1.5e-7: second-order terms
  for (Index n = 0; n < s.mesh.lines[0].nodes; ++n) {
    const double w = 1e-4 * std::sin(pi * s.mesh.nodes[static_cast<std::size_t>(n)].s / 0.8);
    EXPECT_NEAR(s.node(n).u.y(), w * std::cos(0.5), 1e-10);
    EXPECT_NEAR(s.node(n).u.z(), w * std::sin(0.5), 1e-10);
  }
  for (const assembly::SectionPoint& p : s.sections)
    EXPECT_LT(p.M.norm(), 1e-4);  // of the 320 N m that would bend it so
}
