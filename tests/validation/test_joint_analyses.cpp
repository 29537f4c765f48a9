// Joints in the frequency domain, in linearised buckling and in small motions.
#include "joint_decks.hpp"
#include "record.hpp"

#include <analysis/response/frequency_response.hpp>
#include <analysis/response/unbalance.hpp>
#include <analysis/spectra/critical.hpp>
#include <analysis/statics/buckling.hpp>
#include <analysis/transient/linear_motion.hpp>
#include <core/error.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::test;

namespace {

std::string bearing(const char* name, const char* at, bool driven) {
  return fmt::format(
      "[[bearing]]\nname = \"{}\"\nat = \"{}\"\ntype = \"linear\"\nkyy = \"2e6 N/m\"\nkzz = \"3e6 "
      "N/m\"\nkyz = \"2e5 N/m\"\nkzy = \"-1e5 N/m\"\ncyy = \"300 N.s/m\"\nczz = \"200 N.s/m\"\n{}",
      name, at, driven ? "kxx = \"1e7 N/m\"\ncxx = \"100 N.s/m\"\n" : "");
}

/// A rotor of 0.9 m in two bearings, a disk within and one outside; as one line, or cut at 0.5 m and
/// welded.
std::string rotor_deck(bool cut) {
  const std::string disk =
      "[[disk]]\nname = \"{0}\"\nat = \"{1}\"\nmass = \"{2} kg\"\nIp = \"0.02 kg.m^2\"\nId = "
      "\"0.012 kg.m^2\"\n";
  std::string deck = head + "[[shaft]]\nname = \"rotor\"\nmaterial = \"m\"\n" +
                     section("zero", 0.3, 3) + section("one", 0.2, 2);
  if (cut)
    deck +=
        "[[shaft]]\nname = \"rest\"\nmaterial = \"m\"\norigin = [\"0.5 m\", \"0 m\", \"0 m\"]\n";
  deck += section("two", 0.3, 3) + section("three", 0.1, 1);
  deck += fmt::format(fmt::runtime(disk), "inner", "zero:end", 4.0) +
          fmt::format(fmt::runtime(disk), "outer", "three:end", 2.0);
  deck += bearing("left", "zero:start", true) + bearing("right", "two:end", false);
  // one of them on the node that follows
  deck +=
      "[[unbalance]]\nat = \"two:start\"\namount = \"0.2 g.mm\"\nphase = \"40 deg\"\n"
      "[[unbalance]]\nat = \"outer\"\namount = \"0.5 g.mm\"\n";
  if (cut)
    deck += "[[joint]]\nname = \"weld\"\nkind = \"rigid\"\nat = \"two:start\"\nto = \"one:end\"\n";
  return deck;
}

/// The rotor twice. Node k of the one line is node of(k) of the two.
struct Rotors {
  DeckModel whole{rotor_deck(false)}, cut{rotor_deck(true)};
  Linearizer of_whole{whole.built.system, whole.running()};
  Linearizer of_cut{cut.built.system, cut.running()};
  Index weld() const { return last_node(cut, 0); }
  Index nodes() const { return whole.mesh.lines[0].nodes; }
  Index of(Index k) const { return k <= weld() ? k : k + 1; }

  /// Largest difference of two motions over the largest of that kind, displacement or angle.
  double apart(const VecXc& one, const VecXc& two) const {
    double difference[2] = {0, 0}, size[2] = {0, 0};
    for (Index k = 0; k < nodes(); ++k)
      for (Index c = 0; c < 6; ++c) {
        const Complex x = one[6 * k + c], y = two[6 * of(k) + c];
        const int kind = c < 3 ? 0 : 1;
        size[kind] = std::max(size[kind], std::abs(x));
        difference[kind] = std::max(difference[kind], std::abs(x - y));
        if (k == weld())  // the node that follows moves as the one it stands on
          difference[kind] = std::max(difference[kind], std::abs(x - two[6 * (k + 1) + c]));
      }
    return std::max(difference[0] / size[0], size[1] > 0 ? difference[1] / size[1] : 0.0);
  }
};

}  // namespace

TEST(JointAnalyses, WeldedRotorAnswersUnbalanceAsOne) {
  Rotors r;
  ASSERT_EQ(r.nodes() + 1, last_node(r.cut, 1) + 1);
  const auto answer = [](const DeckModel& m, Linearizer& linear) {
    UnbalanceOptions o;
    for (const double n : {-4000.0, 500.0, 1500.0, 3000.0, 6000.0, 12000.0})
      o.speeds.push_back(n * rpm);
    o.probes.push_back({"tip", {last_node(m, m.mesh.lines.size() - 1)}, {}});
    o.refine_peaks = false;
    o.shapes = true;
    return UnbalanceSolver(linear, o).run();
  };
  const UnbalanceResponse a = answer(r.whole, r.of_whole), b = answer(r.cut, r.of_cut);
  ASSERT_EQ(a.points.size(), b.points.size());
  double worst = 0;
  for (std::size_t k = 0; k < a.points.size(); ++k) {
    worst = std::max(worst, r.apart(a.points[k].shape[0], b.points[k].shape[0]));
    const PointAmplitude &x = a.points[k].probe[0][0], &y = b.points[k].probe[0][0];
    worst = std::max(worst, std::abs(x.forward() - y.forward()) / std::abs(x.forward()));
  }
  std::printf("welded rotor, unbalance response: %.1e\n", worst);
  EXPECT_LT(worst, 1e-9);
}

TEST(JointAnalyses, WeldedRotorAnswersHarmonicForcesAsOne) {
  Rotors r;
  const auto answer = [](Linearizer& linear, Index node, double w) {
    FrequencyResponseOptions o;
    o.forces = {
        {6 * node + 1, 30.0}, {6 * node + 3, Complex(0.5, 0.2)}, {6 * node + 5, Complex(0, 2.0)}};
    o.shapes = true;
    return HarmonicResponder(linear, o).at(5000 * rpm, w).shape;
  };
  double worst = 0;
  for (const double w : {50.0, 300.0, 900.0, 5000.0})  // on the node that follows
    worst = std::max(worst,
                     r.apart(answer(r.of_whole, r.weld(), w), answer(r.of_cut, r.weld() + 1, w)));
  std::printf("welded rotor, harmonic response: %.1e\n", worst);
  EXPECT_LT(worst, 1e-9);
}

TEST(JointAnalyses, WeldedRotorHasTheSameCriticalSpeeds) {
  Rotors r;
  for (const bool damped : {false, true})
    for (const Motion motion : {Motion::all, Motion::lateral}) {
      CriticalOptions o;
      o.max_speed = 20000 * rpm;
      o.damped = damped;
      o.motion = motion;
      const std::vector<Critical> a = critical_speeds(r.of_whole, o),
                                  b = critical_speeds(r.of_cut, o);
      ASSERT_GE(a.size(), 4U);
      ASSERT_EQ(a.size(), b.size());
      for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_NEAR(b[k].speed, a[k].speed, 1e-9 * a[k].speed);
        EXPECT_EQ(b[k].mode.direction, a[k].mode.direction);
        EXPECT_EQ(b[k].mode.kind, a[k].mode.kind);
      }
    }
}

TEST(JointAnalyses, WhatStandsOnAWeldCountsForBothSides) {
  // The correction of the masses asks how much of what a node carries is the elements' own.
  const std::string disk =
      "[[disk]]\nname = \"extra\"\nat = \"{}\"\nmass = \"6 kg\"\nIp = \"0.05 kg.m^2\"\nId = "
      "\"0.03 kg.m^2\"\n";
  const std::string support =
      "[[bearing]]\nname = \"middle\"\nat = \"{}\"\ntype = \"linear\"\nkyy = \"1e6 N/m\"\nkzz = "
      "\"1e6 N/m\"\nkrxx = \"500 N.m/rad\"\nkrr = \"800 N.m/rad\"\n";
  for (const std::string& part : {disk, support})
    for (const char* place : {"one:end", "two:start"}) {
      const std::string there = fmt::format(fmt::runtime(part), place);
      const DeckModel whole(rotor_deck(false) + there), cut(rotor_deck(true) + there);
      Linearizer of_whole(whole.built.system, whole.running()),
          of_cut(cut.built.system, cut.running());
      ModesOptions o;
      o.count = 12;
      const auto a = whirl_modes(of_whole, 3000 * rpm, o), b = whirl_modes(of_cut, 3000 * rpm, o);
      ASSERT_EQ(a.size(), 12U);
      ASSERT_EQ(b.size(), 12U);
      for (std::size_t k = 0; k < a.size(); ++k)
        EXPECT_NEAR(b[k].frequency, a[k].frequency, 1e-9 * a[k].frequency) << place << " " << k;
    }
}

TEST(JointAnalyses, LinesOnABallKeepTheirSpeeds) {
  // The second line spins faster by 5e-4 and by twice that: what gyroscopic couples do to a frequency
  // is proportional to it. A weld takes speeds that differ by rounding for one.
  const auto rotor = [](const char* joint, double ratio) {
    std::string deck = rotor_deck(true);
    deck.replace(deck.find("kind = \"rigid\""), 14, joint);
    deck.insert(deck.find("origin"), fmt::format("speed_ratio = {:.17g}\n", ratio));
    return DeckModel(deck +
                     "[[bearing]]\nname = \"tilt\"\nat = \"two:start\"\ntype = \"linear\"\n"
                     "krr = \"2e3 N.m/rad\"\n");
  };
  double f[3];
  for (int k = 0; k < 3; ++k) {
    const double ratio = 1 + 5e-4 * k;
    const DeckModel m = rotor("kind = \"spherical\"", ratio);
    EXPECT_EQ(SteadySystem(m.built.system, m.running()).ratio(1), ratio);
    Linearizer linear(m.built.system, m.running());
    ModesOptions o;
    o.count = 4;
    o.motion = Motion::lateral;
    f[k] = whirl_modes(linear, 12000 * rpm, o).back().frequency;
  }
  EXPECT_GT(std::abs(f[1] - f[0]), 1e-7 * f[0]);
  EXPECT_NEAR((f[2] - f[0]) / (f[1] - f[0]), 2.0, 0.01);
  const DeckModel welded = rotor("kind = \"rigid\"", 1 + 1e-7);
  EXPECT_EQ(SteadySystem(welded.built.system, welded.running()).ratio(1), 1.0);
}

TEST(JointAnalyses, SplinesAndFlexibleCouplingsTurnSteadily) {
  // A slide along the axis leaves bending and twist those of the weld and gives a rigid body mode along
  // it; a hinge along the axis leaves bending and axial motion, and puts its spring into the twist.
  const auto rotor = [](const std::string& joint) {
    std::string deck = rotor_deck(true);
    deck.replace(deck.find("kind = \"rigid\""), 14, joint);
    return DeckModel(deck);
  };
  const auto modes = [](const DeckModel& m, Motion motion) {
    Linearizer linear(m.built.system, m.running());
    ModesOptions o;
    o.count = 4;
    o.motion = motion;
    std::vector<double> out;
    for (const WhirlMode& x : whirl_modes(linear, 9000 * rpm, o))
      out.push_back(x.frequency);
    return out;
  };
  const DeckModel weld(rotor_deck(true)),
      spline(rotor("kind = \"slider\"\naxis = [1, 0, 0]\nstiffness = \"2e5 N/m\"")),
      coupling(rotor("kind = \"hinge\"\naxis = [1, 0, 0]\nstiffness = \"3e3 N.m/rad\""));
  const auto same = [&](const DeckModel& m, Motion motion) {
    const std::vector<double> a = modes(weld, motion), b = modes(m, motion);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k)
      EXPECT_NEAR(a[k], b[k], 1e-9 * a[k]) << k;
  };
  same(spline, Motion::lateral);
  same(spline, Motion::torsional);
  same(coupling, Motion::lateral);
  same(coupling, Motion::axial);
  // two rigid parts on a soft spring: the first with its thrust bearing of 1e7 N/m, the second alone
  const double second = 2.0 + 8000 * pi / 4 * 4e-4 * 0.4;
  const double along = std::sqrt(1 / (1 / 2e5 + 1 / 1e7) / second);
  EXPECT_NEAR(modes(spline, Motion::axial)[0], along, 0.01 * along);
  const double G = 80e9, J = pi / 32 * std::pow(0.02, 4), polar = 8000 * J;
  const double left = 0.02 + polar * 0.5, right = 0.02 + polar * 0.4,
               soft = 1 / (0.2 / (G * J) + 1 / 3e3 + 0.4 / (G * J));
  const double twist = std::sqrt(soft * (1 / left + 1 / right));
  EXPECT_NEAR(modes(coupling, Motion::torsional)[0], twist, 0.02 * twist);
  const DeckModel hinge(rotor("kind = \"hinge\"\naxis = [0, 1, 0]\nstiffness = \"3e3 N.m/rad\""));
  try {
    modes(hinge, Motion::all);
    ADD_FAILURE() << "a hinge across the axis has no constant matrices";
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().front().code, "E41");
    EXPECT_NE(e.diagnostics().front().message.find("have no constant matrices"), std::string::npos);
  }
}

TEST(JointAnalyses, AWeldAtARigidHubTurnsAsOne) {
  // The joint stands at the end of a rigid stretch, an arm away from the node.
  const auto rotor = [](bool cut) {
    std::string deck = rotor_deck(cut);
    const std::string hub =
        "[[shaft.section]]\nname = \"hub\"\nlength = \"60 mm\"\nod = \"80 mm\"\nrigid = true\n";
    deck.insert(cut ? deck.find("[[shaft]]\nname = \"rest\"")
                    : deck.find("[[shaft.section]]\nname = \"two\""),
                hub);
    if (cut) {
      deck.replace(deck.find("0.5 m"), 5, "0.56 m");
      deck.replace(deck.find("to = \"one:end\""), 14, "to = \"hub:end\"");
    }
    return DeckModel(deck);
  };
  const auto modes = [](const DeckModel& m) {
    Linearizer linear(m.built.system, m.running());
    ModesOptions o;
    o.count = 12;
    std::vector<double> out;
    for (const WhirlMode& x : whirl_modes(linear, 6000 * rpm, o))
      out.push_back(x.frequency);
    return out;
  };
  const std::vector<double> a = modes(rotor(false)), b = modes(rotor(true));
  ASSERT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    worst = std::max(worst, std::abs(b[k] / a[k] - 1));
  std::printf("weld at a rigid hub: %.1e\n", worst);
  // the inertia of the hub counts about its own node, here one side of it, there the other
  EXPECT_LT(worst, 1e-4);
}

TEST(JointAnalyses, WeldedRotorTwistsAsOne) {
  Rotors r;
  ModesOptions o;
  o.count = 4;
  for (const Motion motion : {Motion::torsional, Motion::axial}) {
    o.motion = motion;
    const auto a = whirl_modes(r.of_whole, 3000 * rpm, o), b = whirl_modes(r.of_cut, 3000 * rpm, o);
    ASSERT_GE(a.size(), 4U);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k)
      EXPECT_NEAR(b[k].frequency, a[k].frequency, 1e-9 * a[k].frequency);
  }
}

TEST(JointAnalyses, WeldedRotorMovesLinearlyAsOne) {
  Rotors r;
  const auto run = [](const DeckModel& m) {
    const double Omega = 3000 * rpm;
    system::State start = m.built.system.make_state();
    SteadySystem(m.built.system, m.running()).set_rates(Omega, start.v);
    m.built.system.follow(start);
    LinearMotion small(m.built.system, m.running(), Omega, start);
    TransientOptions o;
    o.integrator.tolerance = 1e-9;
    o.integrator.t_end = 0.05;
    o.integrator.dt_fixed = 1e-4;
    o.method = "radau5";
    const TransientResult x = run_transient(small, start, o, {});
    EXPECT_EQ(x.reason, StopReason::end_time) << x.detail;
    return x.end;
  };
  const system::State a = run(r.whole), b = run(r.cut);
  double size = 0, worst = 0;
  for (Index k = 0; k < r.nodes(); ++k) {
    const Vec3 u = a.q.segment<3>(6 * k);
    size = std::max(size, u.norm());
    worst = std::max(worst, (u - b.q.segment<3>(6 * r.of(k))).norm());
  }
  std::printf("welded rotor, linear motion: %.1e\n", worst / size);
  EXPECT_GT(size, 1e-9);
  EXPECT_LT(worst, 1e-8 * size);
  EXPECT_NEAR(a.total_phi(0, 0), b.total_phi(last_node(r.cut, 1), 1), 1e-6);
}

TEST(JointAnalyses, LoadsOfJointsInLinearMotion) {
  // Those of the general model at the same motion, but for its square (here 1e-5 of them).
  const DeckModel m(rotor_deck(true));
  const system::System& s = m.built.system;
  const double Omega = 3000 * rpm;
  system::State start = s.make_state();
  SteadySystem(s, m.running()).set_rates(Omega, start.v);
  s.follow(start);
  LinearMotion small(s, m.running(), Omega, start);
  small.take_joint_loads();
  TransientOptions o;
  o.integrator.tolerance = 1e-9;
  o.integrator.t_end = 0.05;
  o.integrator.dt_fixed = 1e-4;
  o.method = "radau5";
  const TransientResult x = run_transient(small, start, o, {});
  ASSERT_EQ(x.reason, StopReason::end_time) << x.detail;
  VecX linear(s.size()), general(s.size());
  ASSERT_TRUE(small.residual(x.end.t, x.end.q, x.end.v, x.end.a, linear));
  system::SystemProblem all(s);
  all.frames = x.end.frames;
  ASSERT_TRUE(all.residual(x.end.t, x.end.q, x.end.v, x.end.a, general));
  const Index b = 6 * s.followers()[0].node;
  for (const Index part : {b, b + 3}) {  // force, moment
    const Vec3 load = general.segment<3>(part);
    std::printf("load of the weld: %.3e, apart %.1e\n", load.norm(),
                (linear.segment<3>(part) - load).norm());
    EXPECT_GT(load.norm(), part == b ? 1e-4 : 1e-5);
    EXPECT_LT((linear.segment<3>(part) - load).norm(), 1e-4 * load.norm());
  }
}

TEST(JointAnalyses, WeldedColumnBucklesAsOne) {
  const std::string line = "[[shaft]]\nname = \"bar\"\nmaterial = \"m\"\nrotating = false\n";
  const std::string load = R"([[load]]
at = "two:end"
force = ["-1000 N", "0 N", "0 N"]
)";
  const DeckModel whole(head + line + section("one", 0.6, 5) + section("two", 0.4, 4) + clamp +
                        load);
  const DeckModel cut(head + line + section("one", 0.6, 5) +
                      "[[shaft]]\nname = \"rest\"\nmaterial = \"m\"\nrotating = false\n"
                      "origin = [\"0.6 m\", \"0 m\", \"0 m\"]\n" +
                      section("two", 0.4, 4) + clamp + load +
                      "[[joint]]\nname = \"weld\"\nkind = \"rigid\"\nat = \"two:start\"\n"
                      "to = \"one:end\"\n");
  SteadySystem of_whole(whole.built.system, whole.running()),
      of_cut(cut.built.system, cut.running());
  const auto a = buckling(of_whole, 0.0, 4).modes;
  const auto [b, count, unloaded] = buckling(of_cut, 0.0, 4);
  ASSERT_EQ(a.size(), b.size());
  EXPECT_TRUE(count.complete()) << count.why_not;
  double worst = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    worst = std::max(worst, std::abs(b[k].factor / a[k].factor - 1.0));
  std::printf("welded column, factors: %.1e\n", worst);
  EXPECT_LT(worst, 1e-9);
  const Index n = cut.mesh.lines[1].first_node;
  EXPECT_LT((b[0].x.segment<6>(6 * n) - b[0].x.segment<6>(6 * (n - 1))).norm(), 1e-12);
}

namespace {

/// Two rigid bars on hinges about z, springs at the second hinge and at the far end.
struct Hinged {
  static constexpr double a = 0.5, b = 0.3, k1 = 4e4, k2 = 7e4;
  static std::string deck() {
    const auto hinge = [](const char* name, const char* at, const char* to) {
      return fmt::format(
          "[[joint]]\nname = \"{}\"\nkind = \"hinge\"\nat = \"{}\"\n{}axis = [0, 0, 1]\n", name, at,
          *to ? fmt::format("to = \"{}\"\n", to) : "");
    };
    const auto spring = [](const char* name, const char* at, double k) {
      return fmt::format(
          "[[bearing]]\nname = \"{}\"\nat = \"{}\"\ntype = \"linear\"\nkyy = \"{} N/m\"\nkzz = \"0 "
          "N/m\"\n",
          name, at, k);
    };
    return head + rigid_line("one", 0, a) + rigid_line("two", a, b) +
           hinge("foot", "one1:start", "") + hinge("elbow", "two1:start", "one1:end") +
           spring("elbow_spring", "two1:start", k1) + spring("end_spring", "two1:end", k2) +
           "[[load]]\nat = \"two1:end\"\nforce = [\"-1000 N\", \"0 N\", \"0 N\"]\n";
  }
  DeckModel m{deck()};
  meshes::Place elbow() const { return m.mesh.place(m.deck.model.bearings[0].at); }
  meshes::Place end() const { return m.mesh.place(m.deck.model.bearings[1].at); }
};

}  // namespace

TEST(JointAnalyses, HingedColumnBuckles) {
  Record record("Two rigid bars on hinges, springs at the hinge and at the loaded end",
                "det(K - P G) = 0, V = P (y1^2/2a + (y2 - y1)^2/2b)");
  const Hinged h;
  Mat2 K, G;
  K << h.k1, 0, 0, h.k2;
  G << 1 / h.a + 1 / h.b, -1 / h.b, -1 / h.b, 1 / h.b;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat2> exact(G, K);
  SteadySystem running(h.m.built.system, h.m.running());
  const auto found = buckling(running, 0.0, 2).modes;
  ASSERT_EQ(found.size(), 2U);
  for (Index k = 0; k < 2; ++k)
    record.check(fmt::format("load factor {}", k + 1), "-",
                 found[static_cast<std::size_t>(k)].factor.real(),
                 1 / exact.eigenvalues()[1 - k] / 1000.0, 1e-6);
}

TEST(JointAnalyses, HingedBarsAnswerHarmonicForces) {
  Record record("Two rigid bars on hinges, force on the second hinge",
                "two equations of motion, linear");
  const Hinged h;
  const Bar one(h.a), two(h.b);
  const double J1 = one.I + one.m * h.a * h.a / 4;
  Mat2 M, K, G;
  M << J1 / (h.a * h.a) + two.m / 4 + two.I / (h.b * h.b), two.m / 4 - two.I / (h.b * h.b),
      two.m / 4 - two.I / (h.b * h.b), two.m / 4 + two.I / (h.b * h.b);
  K << h.k1, 0, 0, h.k2;
  G << 1 / h.a + 1 / h.b, -1 / h.b, -1 / h.b, 1 / h.b;
  K -= 1000.0 * G;  // under the load
  Linearizer linear(h.m.built.system, h.m.running());
  FrequencyResponseOptions o;
  const meshes::Place at = h.elbow(), end = h.end();
  o.forces = {{6 * at.node + 1, 5.0}, {6 * at.node + 5, 5.0 * at.offset}};
  o.probes = {{"elbow", {at.node, at.offset}, {}}, {"end", {end.node, end.offset}, {}}};
  HarmonicResponder responder(linear, o);
  double worst = 0;
  for (const double w : {0.0, 100.0, 350.0, 1000.0}) {
    const FrequencyPoint x = responder.at(0.0, w);
    const Vec2 y = (K - w * w * M).inverse() * Vec2(5.0, 0.0);
    for (Index k = 0; k < 2; ++k)
      worst = std::max(worst, std::abs(x.probe[static_cast<std::size_t>(k)].y - y[k]) / y.norm());
  }
  record.below("displacements at 0 to 1000 rad/s, relative", "-", worst, 1e-9);
}
