// Rotors on nonlinear supports, from the deck to the motion.
//
// Oil whirl: rotor on the short journal bearings of Friswell, Penny, Garvey & Lees, Dynamics of
// Rotating Machines (2010), examples 5.5.1 and 5.9.6; onsets from the closed form of the short
// bearing's coefficients and Routh's criterion, transients from an independent integration of
// Capone's film force.
// Blade loss: a Jeffcott rotor whose unbalance is switched on while it turns; the exact
// superposition of steady and free motion,
//   r = H e^(iOt) + a e^(s1 t) + b e^(s2 t),   H = O^2/(1 - O^2 + 2 i zeta O),
//       a = H (s2 - iO)/(s1 - s2),   b = -H - a   (units of e and omega_n).
#include <analysis/spectra/stability.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include "deck_model.hpp"
#include "record.hpp"
#include "../app/oil_whirl_rotor.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace whirl;

namespace {

using test::DeckModel;
using test::rpm;
using test::Windows;

const char* const journal = R"(type = "short_journal"
diameter = "100 mm"
length = "30 mm"
clearance = "100 um"
viscosity = "100 mPa.s"
)";

/// One mass on one bearing: half a symmetric rigid rotor. It translates only.
std::string rigid_rotor() {
  return test::lateral_mass(53.51681957, "9.81 m/s^2",
                            std::string("[[bearing]]\nname = \"film\"\nat = \"mass\"\n") + journal);
}

/// 20 kg under its weight, guided sideways by a soft spring, in a nonlinear spring of this shape
/// along z.
std::string mass_in_a_stop(const std::string& shape) {
  return test::lateral_mass(20, "9.8 m/s^2", R"([[bearing]]
name = "sideways"
at = "mass"
type = "linear"
kyy = "1e3 N/m"
[[bearing]]
name = "stop"
at = "mass"
type = "nonlinear_spring"
direction = "z"
gap = "2 mm"
stiffness = "1e7 N/m"
shape = ")" + shape + "\"\n");
}

analysis::Onset onset(const DeckModel& m, double low, double high) {
  analysis::Linearizer linear(m.built.system, m.running());
  analysis::StabilityOptions o;
  o.min_speed = low;
  o.max_speed = high;
  o.grid = 20;
  o.modes = 6;
  o.motion = analysis::Motion::lateral;
  const auto r = analysis::find_instability(linear, o);
  EXPECT_TRUE(r.stable_at_start);
  if (r.onsets.empty()) throw std::runtime_error("no onset");
  return r.onsets.front();
}

}  // namespace

// Closed form: 8244.3368 rpm, whirl 432.5136 rad/s (given to 8 and 7 digits).
TEST(OilWhirl, OnsetOfTheRigidRotor) {
  const auto o = onset(DeckModel(rigid_rotor()), 3000 * rpm, 10000 * rpm);
  EXPECT_NEAR(o.speed / rpm, 8244.3368, 1e-7 * 8244);
  EXPECT_NEAR(o.frequency, 432.5136, 2e-7 * 432);
  EXPECT_TRUE(o.gains);
}

// Reference: another code's two-node Timoshenko elements, given to 2e-4.
TEST(OilWhirl, OnsetOfTheFlexibleRotor) {
  const auto o = onset(DeckModel(test::oil_whirl_rotor()), 1000 * rpm, 3000 * rpm);
  EXPECT_NEAR(o.speed / rpm, 2075.4209, 2e-4 * 2075);
  EXPECT_NEAR(o.frequency / two_pi, 17.418836, 2e-4 * 17.4);
}

// Same rotor at 4000 rpm: frequency in Hz and growth in 1/s of the six lowest modes, given to 1e-3
// of the eigenvalue.
TEST(OilWhirl, EigenvaluesOfTheFlexibleRotorAboveTheOnset) {
  const double table[][2] = {{17.1086, -0.4277}, {18.0849, 1.4765},  {33.7413, -49.923},
                             {33.7554, -44.617}, {67.0671, -2.2445}, {71.2037, -4.9874}};
  test::Record record(
      "Oil whirl of the two-disk rotor: eigenvalues at 4000 rpm",
      "another code's two-node Timoshenko elements and the closed-form film coefficients");
  const DeckModel m(test::oil_whirl_rotor());
  analysis::Linearizer linear(m.built.system, m.running());
  analysis::ModesOptions o;
  o.count = 6;
  o.motion = analysis::Motion::lateral;
  const auto modes = analysis::whirl_modes(linear, 4000 * rpm, o);
  ASSERT_GE(modes.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const double w = two_pi * table[i][0];
    record.check(fmt::format("mode {}: frequency", i + 1), "Hz", modes[i].lambda.imag() / two_pi,
                 table[i][0], 1e-5 * table[i][0]);
    record.check(fmt::format("mode {}: growth", i + 1), "1/s", modes[i].lambda.real(), table[i][1],
                 1e-4 * w);
  }
}

// Below the onset the nonlinear motion from a small offset dies out, above it grows, at the rates
// of the reference integration. The film only takes power, in every step.
TEST(OilWhirl, NonlinearRunsDecayBelowAndGrowAbove) {
  const double c = 1e-4, at = 8244.3368 * rpm;
  const double expected[2][3] = {{0.02, 0.0129947, 0.0080702}, {0.0232846, 0.0360067, 0.0591007}};
  for (int k = 0; k < 2; ++k) {
    const double Omega = (k == 0 ? 0.98 : 1.02) * at;
    const DeckModel m(rigid_rotor() +
                      "[[drive]]\nname = \"motor\"\nat = \"mass\"\ntype = \"speed\"\nspeed = \"" +
                      std::to_string(Omega) + " rad/s\"\n");
    const system::System& s = m.built.system;
    analysis::SteadySystem running(s, m.running());
    analysis::Equilibrium e = analysis::EquilibriumSolver(running).solve(Omega);
    const Index node = m.disk();
    const Vec2 centre = e.state.q.segment<2>(6 * node + 1);
    e.state.q[6 * node + 1] += 0.02 * c;
    system::SystemProblem problem(s);
    problem.impose(0.0, e.state.q, e.state.v, e.state.a);
    analysis::TransientOptions o;
    o.integrator.tolerance = 1e-6;
    o.integrator.t_end = 0.6;
    Windows w(node, centre, {{0, 0.09}, {0.24, 0.33}, {0.51, 0.6}});
    const auto r = analysis::run_transient(problem, e.state, o, {&w});
    ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(w.peak[i] / c, expected[k][i], 0.02 * expected[k][i]) << k << " window " << i;
    EXPECT_GE(w.dissipated_least, 0.0);
  }
}

// A ball bearing with clearance carries nothing in the reference configuration: the mass is let
// down on it. Root of the eight-ball sum, ball under the load, 196 N, 5 um.
TEST(Gaps, MassSettlesInABallBearingWithClearance) {
  const DeckModel m(test::lateral_mass(20, "9.8 m/s^2", R"([[bearing]]
name = "ball bearing"
at = "mass"
type = "ball"
balls = 8
ball_diameter = "11.9 mm"
pitch_diameter = "52 mm"
clearance = "5 um"
stiffness = "1.334e10 N/m^1.5"
)"));
  analysis::SteadyRotation turning = m.running();
  turning.mean = false;
  analysis::SteadySystem running(m.built.system, turning);
  const auto e = analysis::EquilibriumSolver(running).solve(0.0);
  const Index node = m.disk();
  EXPECT_NEAR(e.state.q[6 * node + 2], -9.87145827e-06, 1e-9 * 9.9e-6);
  EXPECT_NEAR(e.state.q[6 * node + 1], 0.0, 1e-15);
}

// A shaft that lies in two stops with gaps of 0.1 and 0.25 mm and stands on nothing else: one
// closes before the other. The stops carry the weight, by the lever rule.
TEST(Gaps, ShaftSettlesInTwoStops) {
  const DeckModel m(R"(format = 1
[model]
gravity = "9.81 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 300, 40, 2], ["b", 600, 40, 3]]
[[bearing]]
name = "thrust"
at = "a:start"
type = "rigid"
directions = ["x"]
[[bearing]]
name = "near"
at = "a:end"
type = "rub"
gap = "0.1 mm"
stiffness = "1e7 N/m"
friction = 0.2
[[bearing]]
name = "far"
at = "b:end"
type = "rub"
gap = "0.25 mm"
stiffness = "1e7 N/m"
friction = 0.2
)");
  analysis::SteadySystem running(m.built.system, m.running());
  const auto e = analysis::EquilibriumSolver(running).solve(0.0);
  const double W = 7850 * pi / 4 * 0.04 * 0.04 * 0.9 * 9.81, far = W * (0.45 - 0.3) / 0.6;
  const auto z = [&](std::size_t bearing) {
    return -e.state.q[6 * m.mesh.bearings[bearing].shaft.node + 2];
  };
  EXPECT_NEAR(z(1) - 1e-4, (W - far) / 1e7, 1e-9 * z(1));
  EXPECT_NEAR(z(2) - 2.5e-4, far / 1e7, 1e-9 * z(2));
}

// A one-sided stop under a mass that is guided sideways by a soft spring: the gap, and the weight
// over the stiffness.
TEST(Gaps, MassSettlesOnAOneSidedStop) {
  const DeckModel m(mass_in_a_stop("clearance"));
  analysis::SteadySystem running(m.built.system, m.running());
  const auto e = analysis::EquilibriumSolver(running).solve(0.0);
  EXPECT_NEAR(e.state.q[6 * m.disk() + 2], -2e-3 - 196 / 1e7, 1e-12);
}

// A rigid shaft in two stops, without weight: a couple has no resultant, and turns the shaft until
// both are closed on opposite sides.
TEST(Gaps, CoupleTurnsAShaftIntoItsStops) {
  const auto stop = [](const char* name, const char* at) {
    return std::string("[[bearing]]\nname = \"") + name + "\"\nat = \"" + at +
           "\"\ntype = \"rub\"\ngap = \"0.1 mm\"\nstiffness = \"1e7 N/m\"\nfriction = 0\n";
  };
  const DeckModel m(R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["left", 300, true], ["right", 700, true]]
[[disk]]
name = "mass"
at = "left:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
name = "guide"
at = "mass"
type = "rigid"
directions = ["x"]
[[load]]
at = "mass"
moment = ["0 N.m", "0 N.m", "50 N.m"]
)" + stop("near", "left:start") +
                    stop("far", "right:end"));
  analysis::SteadySystem running(m.built.system, m.running());
  const auto e = analysis::EquilibriumSolver(running).solve(0.0);
  system::Workspace w = m.built.system.make_workspace();
  ASSERT_TRUE(
      m.built.system.evaluate_nodes(w, e.state.frames, 0.0, e.state.q, e.state.v, e.state.a));
  // 50 N at each end; the tilt of 2e-4 shortens the arms by 2e-8
  for (const std::size_t k : {1u, 2u}) {
    const meshes::Place at = m.mesh.bearings[k].shaft;
    const system::NodeState& n = w.nodes[static_cast<std::size_t>(at.node)];
    const Vec3 u = n.u + at.offset * n.t;
    EXPECT_NEAR(u.y(), (k == 1 ? -1 : 1) * (1e-4 + 50 / 1e7), 1e-6 * 1e-4);
    EXPECT_NEAR(u.z(), 0.0, 1e-12);
  }
}

// The load stands right over one ball of a bearing with so much play that its neighbours stay
// clear: sideways nothing resists and nothing loads, and the ball carries the weight alone,
// (W/K)^(2/3) into the contact.
TEST(Gaps, OneBallCarriesAlone) {
  const DeckModel m(test::lateral_mass(20, "9.8 m/s^2", R"([[bearing]]
name = "ball bearing"
at = "mass"
type = "ball"
balls = 8
ball_diameter = "11.9 mm"
pitch_diameter = "52 mm"
clearance = "40 um"
stiffness = "1.334e10 N/m^1.5"
)"));
  analysis::SteadyRotation still = m.running();
  still.mean = false;
  analysis::SteadySystem running(m.built.system, still);
  const auto e = analysis::EquilibriumSolver(running).solve(0.0);
  EXPECT_NEAR(e.state.q[6 * m.disk() + 2], -4e-5 - std::pow(196 / 1.334e10, 2.0 / 3), 1e-10 * 4e-5);
  EXPECT_NEAR(e.state.q[6 * m.disk() + 1], 0.0, 1e-12);
}

// What no play excuses stays an error: a motion that a load drives on and on, and one that nothing
// resists beside a support without play.
TEST(Gaps, NothingToFind) {
  const DeckModel away(mass_in_a_stop("one_sided"));
  analysis::SteadySystem running(away.built.system, away.running());
  EXPECT_THROW(analysis::EquilibriumSolver(running).solve(0.0), Error);
}

// A foundation whose matrices are diagonal is a set of pedestals.
TEST(Foundation, DiagonalMatricesArePedestals) {
  const std::string rotor = R"(format = 1
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 400, 50, 2], ["b", 400, 50, 2]]
[[disk]]
name = "disk"
at = "a:end"
mass = "30 kg"
Ip = "0.4 kg.m^2"
Id = "0.22 kg.m^2"
[[bearing]]
name = "thrust"
at = "a:start"
type = "rigid"
directions = ["x"]
)";
  const auto bearing = [](const char* name, const char* at, const char* support) {
    return std::string("[[bearing]]\nname = \"") + name + "\"\nat = \"" + at +
           "\"\ntype = \"linear\"\nkyy = \"5e7 N/m\"\nkzz = \"5e7 N/m\"\ncyy = \"1e3 N.s/m\"\nczz "
           "= \"1e3 N.s/m\"\n" +
           support;
  };
  const char* pedestal =
      "support = { mass = \"12 kg\", kyy = \"4e7 N/m\", kzz = \"6e7 N/m\", cyy = \"500 N.s/m\", "
      "czz = \"500 N.s/m\" }\n";
  const DeckModel one(rotor + bearing("DE", "a:start", pedestal) +
                      bearing("NDE", "b:end", pedestal));
  const DeckModel two(rotor + bearing("DE", "a:start", "") + bearing("NDE", "b:end", "") +
                      R"([[foundation]]
name = "table"
coordinates = ["DE.y", "DE.z", "NDE.y", "NDE.z"]
columns = ["row", "column", "K[N/m]", "C[N.s/m]", "M[kg]"]
rows = [[1, 1, 4e7, 500, 12], [2, 2, 6e7, 500, 12], [3, 3, 4e7, 500, 12], [4, 4, 6e7, 500, 12]]
)");
  std::vector<Complex> lambda[2];
  double sag[2];
  const DeckModel* models[2] = {&one, &two};
  for (int k = 0; k < 2; ++k) {
    const DeckModel& m = *models[k];
    analysis::Linearizer linear(m.built.system, m.running());
    linear.at(300.0);
    sag[k] = linear.equilibrium().state.q[6 * m.disk() + 2];
    analysis::ModesOptions options;
    options.count = 8;
    for (const auto& mode : analysis::whirl_modes(linear, 300.0, options))
      lambda[k].push_back(mode.lambda);
  }
  EXPECT_NEAR(sag[0], sag[1], 1e-12 * std::abs(sag[0]));
  ASSERT_EQ(lambda[0].size(), lambda[1].size());
  for (std::size_t i = 0; i < lambda[0].size(); ++i)
    EXPECT_NEAR(std::abs(lambda[0][i] - lambda[1][i]), 0.0, 1e-8 * std::abs(lambda[0][i]));
}

TEST(BladeLoss, TransientMaximumAndSteadyRadius) {
  // Omega/omega_n, steady |r|/e, transient maximum |r|/e and omega_n t of it; at omega_n itself the
  // radius grows all the time, towards 10
  const double table[][4] = {{0.5, 0.3325950526, 0.5754267293, 6.291},
                             {0.9, 3.852777103, 4.76700133, 25.164},
                             {1.0, 10, 9.999999982, 400},
                             {1.2, 3.15740887, 4.99282775, 14.092},
                             {2.0, 1.33038021, 3.236627822, 2.066}};
  const double mass = 10, k = 1e6, wn = std::sqrt(k / mass), lost = 0.05, e = 1e-4;
  test::Record record("Blade loss on a rigid support",
                      "closed form of the transient after a sudden unbalance, damping ratio 0.05");
  for (const auto& row : table) {
    const std::string deck = test::lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "316.22776601683796 N.s/m"
czz = "316.22776601683796 N.s/m"
[[unbalance]]
at = "mass"
amount = "1 kg.mm"
factor = { type = "piecewise", pieces = [{ start = "0 s", law = 0 }, { start = "0.05 s", law = 1 }] }
[[drive]]
name = "motor"
at = "mass"
type = "speed"
speed = ")" + std::to_string(row[0] * wn) + " rad/s\"\n");
    const DeckModel m(deck);
    const system::System& s = m.built.system;
    system::SystemProblem problem(s);
    system::State start = s.make_state();
    problem.impose(0.0, start.q, start.v, start.a);
    analysis::TransientOptions o;
    o.integrator.tolerance = 1e-8;
    o.integrator.breakpoints = m.built.breakpoints;
    o.integrator.t_end = lost + 400 / wn;  // e^(-zeta omega_n t) = 2e-9
    const Index node = m.disk();
    Windows w(node, Vec2::Zero(),
              {{0, lost}, {lost, o.integrator.t_end}, {lost + 380 / wn, o.integrator.t_end}});
    const auto r = analysis::run_transient(problem, start, o, {&w});
    ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
    EXPECT_EQ(w.peak[0], 0.0);
    // samples eight to a step see the maximum to about (omega dt/16)^2/2
    char at[40];
    std::snprintf(at, sizeof at, "speed %g omega_n: ", row[0]);
    record.check(std::string(at) + "largest radius after the loss", "e", w.peak[1] / e, row[2],
                 1e-4 * row[2]);
    // the maximum is flat, and seen by eight samples a step
    record.check(std::string(at) + "when it is there, after the loss", "1/omega_n",
                 wn * (w.peak_time[1] - lost), row[3], row[0] == 1.0 ? 5.0 : 0.03);
    record.check(std::string(at) + "steady radius", "e", w.peak[2] / e, row[1], 1e-5 * row[1]);
  }
}
