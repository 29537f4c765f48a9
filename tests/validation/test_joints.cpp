// Joints without penalty through the deck: welds against uncut lines, frames, linkages.
#include <la/dense.hpp>
#include "../la/fixtures.hpp"
#include "joint_decks.hpp"
#include "record.hpp"
#include "static_model.hpp"

#include <analysis/spectra/whirl_modes.hpp>
#include <analysis/statics/load_path.hpp>
#include <core/error.hpp>
#include <system/joint_start.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::test;

// A bar cut in two and welded is the bar.
TEST(Joints, AWeldedBarIsTheBar) {
  const std::string line = "[[shaft]]\nname = \"bar\"\nmaterial = \"m\"\nrotating = false\n";
  const std::string load = R"([[load]]
at = "two:end"
force = ["-20 N", "300 N", "200 N"]
moment = ["40 N.m", "0 N.m", "0 N.m"]
)";
  const DeckModel whole(head + line + section("one", 0.6, 5) + section("two", 0.4, 4) + clamp +
                        load);
  const DeckModel cut(head + line + section("one", 0.6, 5) +
                      "[[shaft]]\nname = \"rest\"\nmaterial = \"m\"\nrotating = false\n"
                      "origin = [\"0.6 m\", \"0 m\", \"0 m\"]\n" +
                      section("two", 0.4, 4) + clamp + load +
                      "[[joint]]\nname = \"weld\"\nkind = \"rigid\"\nat = \"two:start\"\n"
                      "to = \"one:end\"\n");
  const Solved a = solve(whole.deck.model), b = solve(cut.deck.model);
  const Vec3 one = a.node(last_node(whole, 0)).u, two = b.node(last_node(cut, 1)).u;
  EXPECT_GT(one.norm(), 0.05);
  EXPECT_LT((one - two).norm(), 1e-12 * one.norm());
  EXPECT_LT((a.support(0) - b.support(0)).norm(), 1e-9 * 300);
  const auto reaction = [&](Index k) { return b.r[k]; };
  const auto node = [&](Index n) -> const system::NodeState& { return b.node(n); };
  const assembly::JointResult& weld = b.built.joints[0];
  // what the weld does to the outer part holds the load there
  const Vec3 F(-20, 300, 200), M(40, 0, 0);
  EXPECT_LT((weld.force(node, {}, reaction) + F).norm(), 1e-8 * F.norm());
  const Vec3 arm = Vec3(0.4, 0, 0) + two - b.node(last_node(cut, 0)).u;
  EXPECT_LT((weld.moment(node, {}, reaction) + M + arm.cross(F)).norm(),
            1e-8 * arm.norm() * F.norm());

  ModesOptions o;
  o.count = 8;
  Linearizer of_whole(whole.built.system, whole.running()), of_cut(cut.built.system, cut.running());
  const auto modes = whirl_modes(of_whole, 0.0, o), same = whirl_modes(of_cut, 0.0, o);
  ASSERT_EQ(modes.size(), same.size());
  for (std::size_t k = 0; k < modes.size(); ++k) {
    EXPECT_NEAR(same[k].frequency, modes[k].frequency, 1e-9 * modes[k].frequency) << k;
    // shapes, the welded node too
    const Index n = cut.mesh.lines[1].first_node;
    const double of_first = same[k].x.segment<6>(6 * (n - 1)).norm();
    EXPECT_LT((same[k].x.segment<6>(6 * n) - same[k].x.segment<6>(6 * (n - 1))).norm(),
              1e-9 * (1e-6 + of_first));
  }

  const auto let_go = [](const DeckModel& m, const Solved& s) {
    system::State x = s.found.state;
    x.t = 0;
    system::State y = m.built.system.make_state();
    y.v = 3.0 * x.q;
    m.built.system.follow(y);
    return move_to(m, y, 0.05, 1e-6, "radau5", 1e-4);
  };
  const system::State u = let_go(whole, a), v = let_go(cut, b);
  const Vec3 left = place_of(whole, u, last_node(whole, 0)),
             right = place_of(cut, v, last_node(cut, 1));
  EXPECT_LT((left - right).norm(), 1e-9);
}

namespace {

std::string elbow_deck(int n, bool joined) {
  const std::string legs = fmt::format(
      "length = \"10 m\"\nmin_elements = {}\nconstants = {{ EA = \"1e6 N\", kGA = \"1e6 N\", GJ = "
      "\"1000 N.m^2\", EI = \"1000 N.m^2\", rhoA = \"1 kg/m\", rhoI = \"10 kg.m\", rhoIp = \"20 "
      "kg.m\" }}\n",
      n);
  std::string out = "format = 1\n[model]\ngravity = \"0 m/s^2\"\n";
  const auto line = [&](const char* name, const char* path) {
    return fmt::format("[[shaft]]\nname = \"{}\"\nrotating = false\n{}\n", name, path);
  };
  const std::string one = "[[shaft.section]]\nname = \"one\"\n" + legs,
                    two = "[[shaft.section]]\nname = \"two\"\n" + legs;
  if (joined)
    out += line("first", "path = [{ to = [\"10 m\", \"0 m\", \"0 m\"] }]") + one +
           line("second",
                "origin = [\"10 m\", \"0 m\", \"0 m\"]\npath = [{ to = [\"10 m\", \"10 m\", \"0 "
                "m\"] }]") +
           two +
           "[[joint]]\nname = \"elbow\"\nkind = \"rigid\"\nat = \"one:end\"\nto = \"two:start\"\n";
  else
    out += line("frame",
                "path = [{ to = [\"10 m\", \"0 m\", \"0 m\"] }, { to = [\"10 m\", \"10 m\", \"0 "
                "m\"] }]") +
           one + two;
  return out + clamp +
         "[[load]]\nat = \"one:end\"\nforce = [\"0 N\", \"0 N\", \"50 N\"]\nfactor = { type = "
         "\"table\", time = [\"0 "
         "s\", \"1 s\", \"2 s\"], value = [0, 1, 0] }\n";
}

}  // namespace

TEST(Joints, RightAngleCantileverOfTwoLines) {
  Record record("Right-angle cantilever of two lines, welded at the elbow",
                "J. C. Simo, L. Vu-Quoc 1988, doi 10.1016/0045-7825(88)90073-4; values of a "
                "converged exact rod");
  const DeckModel m(elbow_deck(20, true)), whole(elbow_deck(20, false));
  struct Point {
    double t;
    Vec3 tip, elbow;
  };
  system::State x = m.built.system.make_state(), y = whole.built.system.make_state();
  double worst = 0, apart = 0;
  for (const Point& p :
       {Point{1,
              {9.996982923, 9.976611401, 0.05403185762},
              {9.945803876, 0.02288157267, 0.9513144037}},
        Point{2, {10.10626067, 9.307850017, 0.0692637757}, {8.9888861, 0.2673890374, 4.115245753}},
        Point{4, {10.44198178, 9.29375872, 3.508934343}, {8.435605298, -0.4276576962, 4.642069082}},
        Point{8,
              {10.02320608, 7.355170441, 7.960555231},
              {9.806106064, -0.3268247383, 1.633319188}}}) {
    x = move_to(m, x, p.t, 1e-5, "radau5", 0.0, {1.0, 2.0});
    y = move_to(whole, y, p.t, 1e-5, "radau5", 0.0, {1.0, 2.0});
    const Vec3 tip = place_of(m, x, last_node(m, 1)), elbow = place_of(m, x, last_node(m, 0));
    worst = std::max({worst, (tip - p.tip).norm(), (elbow - p.elbow).norm()});
    apart = std::max(apart, (tip - place_of(whole, y, last_node(whole, 0))).norm());
  }
  record.below("tip and elbow to 8 s, largest distance, 20 elements a leg", "m", worst, 1.5e-3);
  record.below("the same frame as one line", "m", apart, 1e-4);
}

namespace {

/// A line between two points with a strong section, n elements.
std::string bar_line(const std::string& name, const Vec3& from, const Vec3& to, int n,
                     const std::string& section) {
  return fmt::format(
      "[[shaft]]\nname = \"{0}\"\nmaterial = \"m\"\nrotating = false\norigin = [\"{1:.17g} m\", "
      "\"{2:.17g} m\", \"{3:.17g} m\"]\npath = [{{ to = [\"{4:.17g} m\", \"{5:.17g} m\", "
      "\"{6:.17g} "
      "m\"] }}]\n[[shaft.section]]\nname = \"{0}1\"\nlength = \"{7:.17g} m\"\nmin_elements = "
      "{8}\n{9}\n",
      name, from.x(), from.y(), from.z(), to.x(), to.y(), to.z(), (to - from).norm(), n, section);
}

}  // namespace

// A shaft drives another one at 30 degrees through a Cardan joint.
TEST(Joints, UniversalJointTurnsUnevenly) {
  Record record("Shaft driven through a Cardan joint at 30 degrees",
                "tan b = tan a/cos 30 deg; b' = a' cos 30 deg/(1 - sin^2 30 deg cos^2 a)");
  const double beta = pi / 6;
  const Vec3 along(std::cos(beta), std::sin(beta), 0), side(-std::sin(beta), std::cos(beta), 0);
  const auto deck = [&](const char* second_axis) {
    return head + R"([[shaft]]
name = "driver"
material = "m"
[[shaft.section]]
name = "driver1"
length = "300 mm"
od = "30 mm"
min_elements = 2
[[bearing]]
name = "left"
at = "driver1:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "right"
at = "driver1:end"
type = "rigid"
directions = ["y", "z"]
[[drive]]
name = "motor"
at = "driver1:start"
type = "speed"
speed = "60 rpm"
)" + bar_line("driven", Vec3(0.3, 0, 0), Vec3(0.3, 0, 0) + 0.3 * along, 2, "od = \"30 mm\"") +
           fmt::format(R"([[joint]]
name = "cross"
kind = "universal"
at = "driver1:end"
to = "driven1:start"
axis = [0, 1, 0]
second_axis = {}
[[joint]]
name = "end"
kind = "hinge"
at = "driven1:end"
axis = [{:.17g}, {:.17g}, 0]
)",
                       second_axis, along.x(), along.y());
  };
  const DeckModel m(deck("[0, 0, 1]"));
  const system::System& s = m.built.system;
  system::State x = s.make_state();
  const double rate = two_pi;
  for (Index n = 0; n < m.mesh.lines[0].nodes; ++n)
    x.v[6 * n + 3] = rate;
  // the arm y of the cross in the driver, z in the driven shaft: both across their shafts
  const Index angle = m.built.joints[1].angles[0];
  // the driven shaft starts at its own speed: at a = 0 the driver's arm lies in the plane of both
  const double first = rate * std::cos(beta) / (1 - std::pow(std::sin(beta), 2));
  const Index from = m.mesh.lines[1].first_node;
  for (Index n = from; n < from + m.mesh.lines[1].nodes; ++n)
    x.v.segment<3>(6 * n + 3) = first * along;
  EXPECT_EQ(system::fit_joints(s, x), "");
  double worst = 0, worst_rate = 0;
  for (int k = 1; k <= 24; ++k) {
    const double t = k / 12.0 + 0.01;
    x = move_to(m, x, t, 1e-7);
    const double a = rate * t;
    const double b = std::atan2(std::sin(a), std::cos(a) * std::cos(beta));
    const double b_rate = rate * std::cos(beta) / (1 - std::pow(std::sin(beta) * std::cos(a), 2));
    worst = std::max(worst, std::abs(std::remainder(x.q[6 * angle] - b, two_pi)));
    worst_rate = std::max(worst_rate, std::abs(x.v[6 * angle] - b_rate));
  }
  EXPECT_NEAR(x.q[6 * angle], 2 * two_pi, 0.3);
  record.below("angle of the driven shaft over two turns, largest error", "rad", worst, 1e-5);
  record.below("its speed", "rad/s", worst_rate, 1e-3);
}

// Crank, coupler and rocker of bars that deform little, set going: against one equation of motion.
TEST(Joints, FourBarLinkage) {
  Record record("Four-bar linkage, bars of 0.2, 0.6 and 0.45 m on pivots 0.5 m apart",
                "one equation of motion of rigid bars, Runge-Kutta of order 4");
  const double r1 = 0.2, r2 = 0.6, r3 = 0.45, base = 0.5, start_angle = 1.0, speed = 10.0;
  const auto solve_loop = [&](double a, double& b, double& c) {  // coupler and rocker directions
    const Vec2 A(r1 * std::cos(a), r1 * std::sin(a)), P(base, 0);
    const Vec2 D = P - A;
    const double d = D.norm();
    const double at_A = std::acos((r2 * r2 + d * d - r3 * r3) / (2 * r2 * d));
    b = std::atan2(D.y(), D.x()) + at_A;
    const Vec2 B = A + r2 * Vec2(std::cos(b), std::sin(b));
    c = std::atan2(B.y() - P.y(), B.x() - P.x());
  };
  double b0, c0;
  solve_loop(start_angle, b0, c0);
  const Vec3 A(r1 * std::cos(start_angle), r1 * std::sin(start_angle), 0), P(base, 0, 0);
  const Vec3 B = A + r2 * Vec3(std::cos(b0), std::sin(b0), 0);
  const auto deck = [&](double stiff, int n) {
    const std::string s = fmt::format(
        "constants = {{ EA = \"{0} N\", kGA = \"{0} N\", GJ = \"{1} N.m^2\", EI = \"{1} N.m^2\", "
        "rhoA = \"2 kg/m\", rhoI = \"1e-5 kg.m\", rhoIp = \"2e-5 kg.m\" }}",
        2e6 * stiff, 500 * stiff);
    const auto hinge = [](const char* name, const char* at, const char* to) {
      return fmt::format(
          "[[joint]]\nname = \"{}\"\nkind = \"{}\"\nat = \"{}\"\n{}axis = [0, 0, 1]\n", name,
          "hinge", at, *to ? fmt::format("to = \"{}\"\n", to) : "");
    };
    return head + bar_line("crank", Vec3::Zero(), A, n, s) + bar_line("coupler", A, B, n, s) +
           bar_line("rocker", B, P, n, s) + hinge("a", "crank1:start", "") +
           hinge("b", "coupler1:start", "crank1:end") +
           hinge("c", "rocker1:start", "coupler1:end") + hinge("d", "rocker1:end", "");
  };
  // reduced model: kinetic energy J(a) a'^2/2, J' from differences; a'' = -J' a'^2/(2 J)
  const auto inertia = [&](double a) {
    const double h = 1e-5;
    double b1, c1, b2, c2;
    solve_loop(a - h, b1, c1);
    solve_loop(a + h, b2, c2);
    const double db = (b2 - b1) / (2 * h), dc = (c2 - c1) / (2 * h);
    double b, c;
    solve_loop(a, b, c);
    const double m1 = 2 * r1, m2 = 2 * r2, m3 = 2 * r3, rho = 1e-5;
    const Vec2 v =
        r1 * Vec2(-std::sin(a), std::cos(a)) + 0.5 * r2 * db * Vec2(-std::sin(b), std::cos(b));
    return m1 * r1 * r1 / 3 + rho * r1 + m2 * v.squaredNorm() +
           (m2 * r2 * r2 / 12 + rho * r2) * db * db + (m3 * r3 * r3 / 3 + rho * r3) * dc * dc;
  };
  const auto rate = [&](const VecX& y) {
    const double h = 1e-3;  // differences of differences
    const double slope = (8 * (inertia(y[0] + h) - inertia(y[0] - h)) -
                          (inertia(y[0] + 2 * h) - inertia(y[0] - 2 * h))) /
                         (12 * h);
    VecX out(2);
    out << y[1], -0.5 * slope * y[1] * y[1] / inertia(y[0]);
    return out;
  };
  VecX y(2);
  y << start_angle, speed;
  const double t = 1.5;
  const VecX exact = integrate(rate, y, t, 3000);
  EXPECT_GT(exact[0], two_pi);
  double last = 0;
  for (const double stiff : {1.0, 10.0}) {
    const DeckModel m(deck(stiff, 4));
    const system::System& s = m.built.system;
    system::State x = s.make_state();
    double b1, c1, b2, c2;
    const double h = 1e-6;
    solve_loop(start_angle - h, b1, c1);
    solve_loop(start_angle + h, b2, c2);
    const double w[] = {speed, speed * (b2 - b1) / (2 * h), speed * (c2 - c1) / (2 * h)};
    const Vec3 pivot[] = {Vec3::Zero(), A, P};
    const Vec3 z = Vec3::UnitZ(), at_A = speed * z.cross(A);
    const Vec3 v[] = {Vec3::Zero(), at_A, Vec3::Zero()};
    for (std::size_t k = 0; k < 3; ++k)
      for (Index n = m.mesh.lines[k].first_node;
           n < m.mesh.lines[k].first_node + m.mesh.lines[k].nodes; ++n) {
        x.v.segment<3>(6 * n) = v[k] + w[k] * z.cross(Vec3(s.node(n).position - pivot[k]));
        x.v[6 * n + 5] = w[k];
      }
    ASSERT_EQ(system::fit_joints(s, x), "");
    const double energy = energy_of(s, x);
    const system::State end = move_to(m, x, t, 1e-6);
    const double a = start_angle + end.q[6 * m.built.joints[0].angles[0]];
    const double error = std::abs(a - exact[0]);
    std::printf("four-bar linkage, stiffness %g: %.3e rad of %.3f, energy %.1e\n", stiff, error,
                exact[0], energy_of(s, end) / energy - 1);
    EXPECT_LT(std::abs(energy_of(s, end) / energy - 1), 1e-4);
    if (last > 0) {
      record.below("angle of the crank after 1.5 s, bars ten times as stiff", "rad", error,
                   0.2 * last);
    }
    last = error;
  }
}

// Joints without coordinates of their own: clamped beam on a stiff post with a ball at its top.
TEST(Joints, WithoutCoordinatesOfTheirOwnStart) {
  std::string deck = head;
  deck.replace(deck.find("\"0 m/s^2\""), 9, "\"10 m/s^2\"");
  deck += bar_line("beam", Vec3::Zero(), Vec3(1, 0, 0), 4, "od = \"20 mm\"") +
          bar_line("post", Vec3(1, 0, 0), Vec3(1, 0, -0.5), 4, "od = \"200 mm\"");
  for (const char* joint : {"name = \"wall\"\nkind = \"rigid\"\nat = \"beam1:start\"\n",
                            "name = \"ball\"\nkind = \"spherical\"\nat = \"post1:start\"\nto = "
                            "\"beam1:end\"\n",
                            "name = \"foot\"\nkind = \"rigid\"\nat = \"post1:end\"\n"})
    deck += std::string("[[joint]]\n") + joint;
  const DeckModel m(deck);
  system::State x = m.built.system.make_state();
  EXPECT_EQ(system::fit_joints(m.built.system, x), "");
}

// Legs of a strip on edge, end moments in the plane, ends on hinges: buckles sideways at
// pi/L sqrt(EI GJ).
TEST(Joints, HingedRightAngleFrameBucklesSideways) {
  Record record(
      "Hinged right-angle frame of strips under end moments",
      "J. H. Argyris et al. 1979, doi 10.1016/0045-7825(79)90061-2; J. C. Simo, L. Vu-Quoc "
      "1986, doi 10.1016/0045-7825(86)90079-4: 622.2 N mm = pi/L sqrt(EI GJ)");
  const double side = 0.24 * std::sqrt(0.5);
  const std::string strip =
      "general = { A = \"18 mm^2\", Iy = \"0.54 mm^4\", Iz = \"1350 mm^4\", J = \"2.16 mm^4\", "
      "kappa_y = 0.8333333333333333, kappa_z = 0.8333333333333333 }";
  std::string deck = head;
  deck.replace(deck.find("200 GPa"), 7, "71.24 GPa");
  deck.replace(deck.find("80 GPa"), 6, "71.24 GPa / 2.62");
  deck += bar_line("left", Vec3(-side, 0, 0), Vec3(0, side, 0), 16, strip) +
          bar_line("right", Vec3(0, side, 0), Vec3(side, 0, 0), 16, strip) + R"([[joint]]
name = "apex"
kind = "rigid"
at = "left1:end"
to = "right1:start"
[[joint]]
name = "foot"
kind = "hinge"
at = "left1:start"
axis = [0, 0, 1]
[[bearing]]
name = "roller"
at = "right1:end"
type = "rigid"
directions = ["y", "z", "rx", "ry"]
[[load]]
at = "left1:start"
moment = ["0 N.m", "0 N.m", "-0.1 N.m"]
[[load]]
at = "right1:end"
moment = ["0 N.m", "0 N.m", "0.1 N.m"]
)";
  const DeckModel m(deck);
  SteadySystem running(m.built.system, m.running());
  for (const double sign : {1.0, -1.0}) {
    LoadPathOptions o;
    o.max_points = 400;
    o.last_load = 8.0 * sign;
    o.steps = 40;
    const LoadPathResult r = follow_load_path(running, 0.0, running.system().make_state(), o,
                                              [](const LoadPathPoint&) { return true; });
    ASSERT_FALSE(r.critical.empty());
    record.check(fmt::format("critical moment, {}", sign > 0 ? "positive" : "negative"), "N mm",
                 100 * r.critical.front().load, sign * 622.2, 0.6);
  }
}

// Half of it, held in the plane of symmetry, followed along the branch: it turns over about the line of
// its feet, bends and twists, and is back where it was after one revolution, under the opposite moment.
TEST(Joints, HingedRightAngleFrameGoesRoundOnce) {
  Record record("Hinged right-angle frame of strips, one revolution after buckling",
                "J. C. Simo, L. Vu-Quoc 1986, doi 10.1016/0045-7825(86)90079-4: back in the first "
                "place after a "
                "whole turn, the moment reversed: -622.2 N mm");
  const double side = 0.24 * std::sqrt(0.5);
  const std::string strip =
      "general = { A = \"18 mm^2\", Iy = \"0.54 mm^4\", Iz = \"1350 mm^4\", J = \"2.16 mm^4\", "
      "kappa_y = 0.8333333333333333, kappa_z = 0.8333333333333333 }";
  const auto carriage = [](const char* name, const Vec3& at) {
    return fmt::format(
        "[[shaft]]\nname = \"{0}\"\nmaterial = \"m\"\nrotating = false\norigin = [\"{1:.17g} m\", "
        "\"{2:.17g} m\", \"0 m\"]\n[[shaft.section]]\nname = \"{0}1\"\nlength = \"10 mm\"\nod = "
        "\"10 "
        "mm\"\nrigid = true\n",
        name, at.x(), at.y());
  };
  const auto joint = [](const char* name, const char* kind, const char* at, const char* to,
                        const char* axis) {
    return fmt::format("[[joint]]\nname = \"{}\"\nkind = \"{}\"\nat = \"{}\"\n{}axis = {}\n", name,
                       kind, at, *to ? fmt::format("to = \"{}\"\n", to) : "", axis);
  };
  for (const int n : {8, 16}) {
    std::string deck = head;
    deck.replace(deck.find("200 GPa"), 7, "71.24 GPa");
    deck.replace(deck.find("80 GPa"), 6, "71.24 GPa / 2.62");
    const Vec3 top(side, side, 0);
    deck += bar_line("leg", Vec3::Zero(), top, n, strip) + carriage("foot", Vec3::Zero()) +
            carriage("low", top) + carriage("high", top) +
            joint("rail", "slider", "foot1:start", "", "[1, 0, 0]") +
            joint("pin", "hinge", "leg1:start", "foot1:start", "[0, 0, 1]") +
            joint("y", "slider", "low1:start", "", "[0, 1, 0]") +
            joint("z", "slider", "high1:start", "low1:start", "[0, 0, 1]") +
            joint("apex", "hinge", "leg1:end", "high1:start", "[1, 0, 0]") +
            "[[load]]\nat = \"leg1:start\"\nmoment = [\"0 N.m\", \"0 N.m\", \"-0.1 N.m\"]\n";
    const DeckModel m(deck);
    SteadySystem running(m.built.system, m.running());
    LoadPathOptions o;
    o.max_points = 1000;
    o.last_load = 31.1;
    o.steps = 40;
    o.branch = 1;
    const Index apex = last_node(m, 0), turn = m.built.joints[4].angles[0];
    double least = 0, last_z = 0, last_load = 0, back_load = 0, angle = 0;
    follow_load_path(running, 0.0, running.system().make_state(), o, [&](const LoadPathPoint& p) {
      const double z = p.state->q[6 * apex + 2];
      angle = p.state->q[6 * turn];
      least = std::min(least, p.state->q[6 * apex + 1]);
      // back in the plane, after it has been far below
      if (std::abs(angle) > 1.5 * pi && z * last_z < 0) {
        back_load = last_load + (p.load - last_load) * last_z / (last_z - z);
        return false;
      }
      last_z = z;
      last_load = p.load;
      return true;
    });
    std::printf("half frame, %d elements: back at %.3f N mm, turned by %.5f, lowest %.5f m\n", n,
                100 * back_load, angle, least);
    EXPECT_LT(least, -0.35);
    record.check(fmt::format("{} elements: moment where it is back in its plane", n), "N mm",
                 100 * back_load, -622.2, 0.6);
    record.check(fmt::format("{} elements: turn of the apex", n), "rad", std::abs(angle), two_pi,
                 0.02);
  }
}

namespace {

/// What building the deck complains about.
std::string complaint(const std::string& deck) {
  try {
    const DeckModel m(deck);
  } catch (const Error& e) {
    const Diagnostic& d = e.diagnostics().front();
    return d.code + ": " + d.message;
  }
  return {};
}

}  // namespace

TEST(Joints, WhatLocksOrIsHeldTwiceIsNamed) {
  const std::string two = head + rigid_line("one", 0, 0.5) + rigid_line("two", 0.5, 0.3);
  const auto hinge = [](const char* name, const char* at, const std::string& to, const char* axis) {
    return fmt::format("[[joint]]\nname = \"{}\"\nkind = \"hinge\"\nat = \"{}\"\n{}axis = {}\n",
                       name, at, to.empty() ? "" : "to = \"" + to + "\"\n", axis);
  };
  // two hinges across each other leave nothing; the same hinge twice holds five directions twice
  EXPECT_EQ(
      complaint(two + hinge("a", "two1:start", "one1:end", "[0, 1, 0]") +
                hinge("b", "two1:start", "one1:end", "[0, 0, 1]")),
      "E40: joint 'b': it closes a loop of rigid parts with joint 'a': 10 directions held, 6 of "
      "them independent, of 6 motions; they lock; 4 held more than once");
  EXPECT_EQ(
      complaint(two + hinge("a", "two1:start", "one1:end", "[0, 1, 0]") +
                hinge("b", "two1:start", "one1:end", "[0, 1, 0]")),
      "E40: joint 'b': it closes a loop of rigid parts with joint 'a': 10 directions held, 5 of "
      "them independent, of 6 motions; 5 held more than once");
  // a plane linkage of rigid bars
  const std::string three = two + rigid_line("three", 0, 0.8);
  const std::string loop = complaint(three + hinge("a", "one1:start", "", "[0, 0, 1]") +
                                     hinge("b", "two1:start", "one1:end", "[0, 0, 1]") +
                                     hinge("c", "three1:end", "two1:end", "[0, 0, 1]") +
                                     hinge("d", "three1:mid", "", "[0, 0, 1]"));
  EXPECT_EQ(loop.find("E40: joint 'd': it closes a loop of rigid parts with joints"), 0u) << loop;
  EXPECT_NE(loop.find("20 directions held"), std::string::npos) << loop;
  EXPECT_EQ(complaint(two + hinge("a", "one1:start", "", "[0, 0, 1]") +
                      "[[bearing]]\nname = \"wall\"\nat = \"one1:start\"\ntype = \"rigid\"\n"
                      "directions = [\"y\"]\n")
                .substr(0, 3),
            "E40");
}

// Lines on joints that nothing holds are one free part, which no line of it alone is.
TEST(Joints, FreePartsAreNamedTogether) {
  const auto message = [](const std::string& support) {
    std::string heavy = head;
    heavy.replace(heavy.find("\"0 m/s^2\""), 9, "\"10 m/s^2\"");
    const DeckModel m(heavy + bar_line("beam", Vec3::Zero(), Vec3(1, 0, 0), 2, "od = \"20 mm\"") +
                      bar_line("post", Vec3(1, 0, 0), Vec3(1, 0, -0.5), 2, "od = \"20 mm\"") +
                      "[[joint]]\nname = \"corner\"\nkind = \"rigid\"\nat = \"post1:start\"\nto = "
                      "\"beam1:end\"\n" +
                      support);
    SteadySystem running(m.built.system, m.running());
    EquilibriumSolver solver(running);
    try {
      solver.solve(0.0);
    } catch (const Error& e) {
      return e.diagnostics().front().code + ": " + e.diagnostics().front().message;
    }
    return std::string();
  };
  const std::string both = " of shafts 'beam' and 'post' on their joints";
  EXPECT_EQ(
      message("").find("E75: nothing resists axial motion" + both + ", nor lateral motion along y" +
                       both + ", nor lateral motion along z" + both + " (at 0"),
      0U)
      << message("");
  const std::string y_alone = message(
      "[[bearing]]\nname = \"foot\"\nat = \"post1:end\"\ntype = \"rigid\"\ndirections = "
      "[\"x\", \"z\", \"rx\", \"ry\", \"rz\"]\n");
  EXPECT_EQ(y_alone.find("E75: nothing resists lateral motion along y" + both + " (at 0"), 0U)
      << y_alone;
}

namespace {

/// A flat line along +y and a link off its end.
struct FlatLine {
  std::string section, joint, mass = "corrected";
  int elements = 8;
  Vec3 to = Vec3(0, 0, 0.25);  ///< from end to end of the link, m
  std::string deck() const {
    std::string model = head;
    model.replace(model.find("[[material]]"), 0, "mesh = { mass = \"" + mass + "\" }\n");
    return model + fmt::format(R"([[shaft]]
name = "beam"
material = "m"
rotating = false
path = [{{ to = ["0 m", "1 m", "0 m"] }}]
[[shaft.section]]
name = "line"
length = "1 m"
min_elements = {}
{}
[[shaft]]
name = "link"
material = "m"
rotating = false
origin = ["0 m", "1 m", "0 m"]
path = [{{ to = ["{} m", "{} m", "{} m"] }}]
[[shaft.section]]
name = "all"
length = "{} m"
min_elements = 2
od = "48 mm"
[[joint]]
name = "joint"
at = "beam:end"
to = "link:start"
{}
[[bearing]]
name = "clamp"
at = "beam:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[bearing]]
name = "foot"
at = "link:end"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
)",
                               elements, section, to.x(), 1 + to.y(), to.z(), to.norm(), joint);
  }
};

std::string flat_section(double height, double flat) {
  const double b = height * flat, A = b * height, Iy = height * b * b * b / 12;
  return fmt::format(
      "general = {{ A = \"{:.17g} m^2\", Iy = \"{:.17g} m^4\", Iz = \"{:.17g} m^4\", "
      "J = \"{:.17g} m^4\", kappa_y = 0.83, kappa_z = 0.83 }}",
      A, Iy, b * std::pow(height, 3) / 12, 3.7 * Iy);
}

/// Smallest eigenvalue of the mass matrix at rest, scaled to a diagonal of one.
double least_mass(const DeckModel& d) {
  const system::System& s = d.built.system;
  system::Workspace w = s.make_workspace();
  const system::State x = s.make_state();
  la::MCK m = s.make_matrices();
  EXPECT_TRUE(s.tangent(w, x.frames, 0, x.q, x.v, x.a, m));
  const MatX M = la::test::dense(m.M);
  std::vector<Index> massive;
  for (Index i = 0; i < M.rows(); ++i)
    if (M(i, i) != 0) massive.push_back(i);
  const VecX size = M.diagonal()(massive).cwiseAbs().cwiseSqrt().cwiseInverse();
  const MatX scaled = size.asDiagonal() * M(massive, massive) * size.asDiagonal();
  return la::symmetric_eigenpairs(scaled).values[0];
}

}  // namespace

TEST(Joints, MassIsPositiveWhateverMeets) {
  // Flat sections whose elements are shorter than they are high, and elements alone between two
  // bends or joints: the first had a rotary inertia of both signs, the second a correction of both.
  std::mt19937 random(5);
  const auto draw = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  for (int trial = 0; trial < 60; ++trial) {
    FlatLine line;
    line.section = trial % 4 == 3 ? "od = \"150 mm\""
                                  : flat_section(std::pow(10.0, draw(-2, 0)), draw(0.01, 1));
    line.elements = 1 + trial % 9;
    line.mass = trial % 5 == 0 ? "consistent" : "corrected";
    line.to = 0.25 * Vec3(draw(-1, 1), draw(-1, 1), draw(-1, 1)).normalized();
    line.joint = fmt::format("kind = \"{}\"", trial % 2 == 0 ? "spherical" : "rigid");
    const DeckModel d(line.deck());
    EXPECT_GT(least_mass(d), 0.0) << line.deck();
  }
}

TEST(Joints, AFlatLineOnABallKeepsItsEnergy) {
  // It grew to 1e293 J within a millisecond.
  FlatLine line;
  line.section = flat_section(0.1, 0.1);
  line.joint = "kind = \"spherical\"";
  const DeckModel d(line.deck());
  system::State x = d.built.system.make_state();
  for (Index i = 1; i < d.mesh.lines[0].nodes; ++i)
    x.v[6 * (d.mesh.lines[0].first_node + i)] = 0.2 * std::sin(pi * static_cast<double>(i) / 8);
  d.built.system.follow(x);
  const double before = energy_of(d.built.system, x);
  const system::State y = move_to(d, x, 0.1, 1e-8);
  EXPECT_GT(before, 1e-3);
  EXPECT_NEAR(energy_of(d.built.system, y), before, 1e-5 * before);
}
