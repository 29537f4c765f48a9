// Torques that transients send through shafts, the load cycles and the fatigue they cause, and how the
// torsional report takes them; several orders at once. Two discs of 1 and 3 kg m2 on a bar without mass.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

using namespace whirl;
using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

const double J = pi * std::pow(0.05, 4) / 32;                           // m4
const double natural = std::sqrt(80e9 * J * (1.0 + 1.0 / 3)) / two_pi;  // Hz
const double stress_of = 0.025 / J;                                     // Pa a N m

std::string discs(const std::string& keys) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "light"
E = "200 GPa"
G = "80 GPa"
density = "1e-6 kg/m^3"
[shaft]
name = "r"
material = "light"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["bar", 1000, 50, 1]]
[[disk]]
name = "A"
at = "bar:start"
mass = "10 kg"
Ip = "1 kg.m^2"
[[disk]]
name = "B"
at = "bar:end"
mass = "10 kg"
Ip = "3 kg.m^2"
[[bearing]]
name = "b1"
at = "bar:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "b2"
at = "bar:end"
type = "rigid"
directions = ["y", "z"]
[[probe]]
name = "P"
at = "bar:mid"
)" + keys;
}

/// A torque of 100 N m on A at once, over so many periods of the ringing that it causes. step: its
/// keys and tables.
std::string rings_in(double periods, const std::string& step, const std::string& quantities) {
  char duration[40];
  std::snprintf(duration, sizeof duration, "%.15g s", periods / natural);
  return discs(std::string(R"([[drive]]
name = "motor"
at = "A"
type = "torque"
step = "ring"
torque = "100 N.m"
[[step]]
name = "ring"
type = "transient"
start = "rest"
duration = ")") +
               duration + "\"\n" + step + "\n[output]\nreport = false\nquantities = " + quantities +
               "\n");
}

std::string rings(double periods, const std::string& torques, const std::string& more = "",
                  const std::string& dt = "0.1 ms") {
  return rings_in(periods,
                  "[step.integrator]\ndt = \"" + dt + "\"\n[step.torques]\n" + torques + more,
                  R"(["speed", "shaft_torque"])");
}

std::string report(const std::string& keys) {
  return R"([[step]]
name = "t"
type = "api_torsional"
operating_speed = ["1000 rpm", "1100 rpm"]
modes = 1
multiples = [1]
)" + keys;
}

/// Words and numbers of a line of a table.
std::vector<std::vector<std::string>> lines(const DeckRun& d, const std::string& file) {
  std::ifstream in(d.folder / "r" / file);
  std::vector<std::vector<std::string>> out;
  for (std::string line; std::getline(in, line);)
    out.push_back(Columns::cells_of(line));
  return out;
}

double half_swing(const std::function<double(double)>& f) {
  double low = f(0), high = low;
  for (int k = 0; k < 400000; ++k) {
    const double x = f(two_pi * 2 * k / 400000);
    low = std::min(low, x);
    high = std::max(high, x);
  }
  return 0.5 * (high - low);
}

}  // namespace

// 3/4 of the torque drives B through the bar: -75 (1 - cos w t) N m of the right part on the left one.
TEST(ShaftTorques, OfABarThatRings) {
  const DeckRun d(rings(10.5,
                        "concentration = 1.5\nultimate = \"100 MPa\"\nendurance = \"2 MPa\"\n"
                        "thousand = \"50 MPa\"\ncycles = 1e5\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto row = d.csv("ring_torques.csv").last();
  EXPECT_NEAR(row.at("lowest [N m]"), -150, 1e-3);
  EXPECT_NEAR(row.at("highest [N m]"), 0, 1e-3);
  EXPECT_NEAR(row.at("from [m]"), 0.5, 1e-12);  // a node at the probe
  EXPECT_NEAR(row.at("to [m]"), 1, 1e-12);
  const double stress = 1.5 * 150 * stress_of;
  EXPECT_NEAR(row.at("shear stress [MPa]"), 1e-6 * stress, 1e-5 * 1e-6 * stress);
  // 21 half cycles between 0 and the peak; Goodman in shear, 0.67 of the tensile strength
  const double a = 0.5 * stress / (1 - 0.5 * stress / 67e6);
  const double slope = std::log(1e5 / 1e3) / std::log(50.0 / 2.0);
  const double damage = 10.5 / (1e3 * std::pow(a / 50e6, -slope));
  EXPECT_NEAR(row.at("damage [-]"), damage, 1e-4 * damage);
  EXPECT_NEAR(row.at("times [-]"), 1 / damage, 1e-4 / damage);
  const Columns classes = d.csv("ring_rainflow.csv");
  double cycles = 0, sum = 0, most = 0;
  for (const auto& r : classes.rows) {
    const auto c = classes.named(r);
    cycles += c.at("cycles [-]");
    sum += c.at("damage [-]");
    if (c.at("damage [-]") > most) {
      most = c.at("damage [-]");
      EXPECT_LE(c.at("from [MPa]"), 1e-6 * a);
      EXPECT_GE(c.at("to [MPa]"), 1e-6 * a);
    }
  }
  EXPECT_NEAR(cycles, 10.5, 0.01);
  EXPECT_NEAR(sum, damage, 1e-4 * damage);
  // at the probe; the whole torque turns both, 100/4 rad/s2
  const auto end = d.csv("ring.csv").last();
  EXPECT_NEAR(end.at("P shaft torque [N.m]"), -150, 1e-2);
  const auto summary = d.summary().at("steps").at("ring").at("torques");
  EXPECT_NEAR(summary.at("largest torque there [N m]").number(), 150, 1e-3);
  EXPECT_NEAR(summary.at("damage").number(), damage, 1e-4 * damage);
}

// A part that breaks in one cycle has used up its life without end: nothing is missing there.
TEST(ShaftTorques, OfABarThatBreaks) {
  const DeckRun d(rings(1.5,
                        "concentration = 1.5\nultimate = \"10 MPa\"\nendurance = \"2 MPa\"\n"
                        "thousand = \"5 MPa\"\ncycles = 1e5\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("not finite")) << d.log;
  const auto row = d.csv("ring_torques.csv").last();
  EXPECT_TRUE(std::isinf(row.at("damage [-]")));
  EXPECT_EQ(row.at("times [-]"), 0);
}

// Steps of an eighth of a period: the nearest of 32 looks a period is 0.03 N m off.
TEST(ShaftTorques, ExtremesLieBetweenTheLooks) {
  const DeckRun d(rings(3.2, "yield = \"10 MPa\"\n", "", "3.1 ms"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto row = d.csv("ring_torques.csv").last();
  EXPECT_NEAR(row.at("lowest [N m]"), -150, 0.01);
  EXPECT_NEAR(row.at("largest at [s]"), 0.5 / natural, 1e-4);
  EXPECT_NEAR(row.at("of yield [%]"), 100 * 150 * stress_of / 10e6, 100 * 0.01 * stress_of / 10e6);
}

// Angles alone are right to 1e-4 rad by default, half a per cent of this twist: the steps let the
// vibration die within ten periods.
TEST(ShaftTorques, DefaultStepsFollowTheVibrationOfTwist) {
  for (const char* method : {"radau5", "gauss6", "generalized_alpha", "ida"}) {
    const std::string integrator = std::string("[step.integrator]\nmethod = \"") + method + "\"\n";
    for (const std::string asked : {"[step.torques]\n", ""}) {
      const DeckRun d(rings_in(50, integrator + asked, R"(["speed", "shaft_torque"])"));
      ASSERT_EQ(d.exit, 0) << d.log;
      EXPECT_FALSE(d.says("vibration of twist")) << d.log;
      const Columns rows = d.csv("ring.csv");
      const std::size_t torque = rows.column("P shaft torque [N.m]");
      double error = 0;
      for (const auto& row : rows.rows)
        error =
            std::max(error, std::abs(row[torque] + 75 * (1 - std::cos(two_pi * natural * row[0]))));
      EXPECT_LT(error, 2e-3 * 150) << method;
    }
  }
}

/// Two disks on an undamped steel shaft that sags, from rest by a torque at once.
std::string torque_from_rest(const std::string& step) {
  return R"(format = 1
[model]
gravity = "9.81 m/s^2"
[shaft]
name = "motor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 400, 80], ["b", 400, 80]]
[[disk]]
name = "core"
at = "a:mid"
mass = "120 kg"
Ip = "2 kg.m^2"
Id = "3 kg.m^2"
[[disk]]
name = "fan"
at = "b:end"
mass = "20 kg"
Ip = "0.3 kg.m^2"
Id = "0.2 kg.m^2"
[[bearing]]
name = "DE"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = "8e7 N/m"
cyy = "5e4 N.s/m"
czz = "5e4 N.s/m"
[[bearing]]
name = "NDE"
at = "b:mid"
type = "linear"
kyy = "1e8 N/m"
kzz = "8e7 N/m"
cyy = "5e4 N.s/m"
czz = "5e4 N.s/m"
[[drive]]
name = "air gap"
at = "core"
type = "torque"
torque = "300 N.m"
step = "start"
[[probe]]
name = "tip"
at = "b:end"
[output]
report = false
[[step]]
name = "start"
type = "transient"
start = "static"
initial_speed = "0 rpm"
duration = "0.02 s"
)" + step;
}

// The torque shakes the sagging shaft by some 1e-5 of its twist, at all frequencies: 15,600 steps would
// follow that.
TEST(ShaftTorques, BendingThatTwistShakesIsNotFollowed) {
  const auto place = [](const std::string& integrator, double& steps) {
    const DeckRun d(torque_from_rest(integrator));
    EXPECT_EQ(d.exit, 0) << d.log;
    steps = d.summary("start").at("integrator").at("steps").number();
    return d.csv("start.csv").last();
  };
  double steps = 0.0, closely = 0.0;
  const auto coarse = place("", steps);
  const auto fine = place("integrator = { tolerance = 1e-6 }", closely);
  EXPECT_LT(steps, 6000);
  EXPECT_NEAR(coarse.at("tip.z [m]"), fine.at("tip.z [m]"), 1e-5 * std::abs(fine.at("tip.z [m]")));
  EXPECT_NEAR(coarse.at("speed [rpm]"), fine.at("speed [rpm]"), 1e-3 * fine.at("speed [rpm]"));
}

TEST(ShaftTorques, StepsThatPassOverAVibrationOfTwistSaySo) {
  const DeckRun d(rings_in(50, "", R"(["speed"])"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("do not follow the vibration of twist")) << d.log;
  EXPECT_TRUE(d.says("a table 'torques' in the step makes them follow it")) << d.log;
  // 75 N m about as many, over the stiffness of a bar of 1 m; disk A moves 3/4 of that
  const io::Value accuracy = d.summary("ring").at("accuracy");
  EXPECT_NEAR(accuracy.at("twist, half its range [rad]").number(), 0.75 * 75 / (80e9 * J), 5e-6);
  EXPECT_GT(accuracy.at("local error of twist / allowance").number(), 100);
  // beside lateral motion that is no fault of a run-up: a note in the report
}

TEST(ShaftTorques, WithoutStrengthsNothingIsCounted) {
  const DeckRun d(rings(2, "concentration = 2\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("ring_torques.csv");
  EXPECT_EQ(std::count(t.names.begin(), t.names.end(), "damage [-]"), 0);
  EXPECT_FALSE(std::filesystem::exists(d.folder / "r" / "ring_rainflow.csv"));
  EXPECT_NEAR(t.last().at("shear stress [MPa]"), 1e-6 * 2 * 150 * stress_of, 1e-4);
}

// Of the report the events: the sum of the damages, each times how often it happens.
TEST(ShaftTorques, EventsOfATorsionalReport) {
  const std::string strengths =
      "ultimate = \"100 MPa\"\nendurance = \"2 MPa\"\nyield = \"5 MPa\"\n";
  const std::string events = R"([[step.event]]
name = "start"
step = "ring"
times = 300
[[step.event]]
name = "again"
step = "ring"
)";
  const DeckRun d(
      rings(10.5, strengths, report("damage_limit = 1e-3\nmultiples = [1]\n") + events));
  // 'multiples' is in the step already: the deck says so
  EXPECT_EQ(d.exit, 3) << d.log;
  const DeckRun run(rings(10.5, strengths, report("damage_limit = 1e-3\n") + events));
  ASSERT_EQ(run.exit, 0) << run.log;
  const double damage = run.csv("ring_torques.csv").last().at("damage [-]");
  const Columns rows = run.csv("t_events.csv");
  ASSERT_EQ(rows.rows.size(), 2u);
  EXPECT_NEAR(rows.named(rows.rows[0]).at("damage [-]"), damage, 1e-9 * damage);
  EXPECT_EQ(rows.named(rows.rows[0]).at("times [-]"), 300);
  const auto table = lines(run, "t_compliance.csv");
  ASSERT_EQ(table.size(), 5u);
  EXPECT_EQ(table[2][0], "transient stress");
  EXPECT_NEAR(std::stod(table[2][3]), 1e-6 * 150 * stress_of, 1e-4);
  EXPECT_EQ(table[2].at(7), "FAILED") << table[2].size();
  EXPECT_EQ(table[4][0], "fatigue damage");
  EXPECT_NEAR(std::stod(table[4][3]), 301 * damage, 1e-6 * 301 * damage);
}

// Two orders with their phases: the stress is half of what the sum swings, not the sum of the parts.
TEST(ShaftTorques, OrdersAddUpWithTheirPhases) {
  const DeckRun d(discs(report(R"(concentration = 2
[[step.torque]]
name = "both"
at = "A"
[step.torque.harmonics]
columns = ["order", "amplitude[N.m]", "phase[deg]"]
rows = [[0.5, 100, 0], [1, 60, 75]]
[output]
report = false
)")));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto torque = [](double rpm) {
    return half_swing([rpm](double angle) {
      const auto part = [rpm](double order) {
        return 0.75 / (1 - std::pow(order * rpm / 60 / natural, 2));
      };
      return 100 * part(0.5) * std::cos(0.5 * angle) +
             60 * part(1) * std::cos(angle + 75 * pi / 180);
    });
  };
  const auto row = d.csv("t_stresses.csv").last();
  EXPECT_NEAR(row.at("speed [rpm]"), 1100, 1e-6);
  EXPECT_NEAR(row.at("torque in the shaft [N m]"), torque(1100), 1e-6 * torque(1100));
  EXPECT_NEAR(row.at("shear stress [MPa]"), 2e-6 * torque(1100) * stress_of,
              2e-12 * torque(1100) * stress_of);
  EXPECT_EQ(row.at("amplitude [N m]"), 100);
}

// A triangle between -100 and 100 N m: 800/pi2 (cos angle + cos(3 angle)/9 + ..).
TEST(ShaftTorques, ACrankEffortIsItsOrders) {
  const auto effort = [](const char* turns, double cycle) {
    return std::string(R"([[step.torque]]
name = "crank"
at = "A"
[step.torque.crank]
harmonics = 3
turns = ")") +
           turns + "\"\ncolumns = [\"angle[deg]\", \"torque[N.m]\"]\nrows = [[0, 100], [" +
           std::to_string(cycle / 4) + ", 0], [" + std::to_string(cycle / 2) +
           ", -100]]\n[output]\nreport = false\n";
  };
  for (const int turns : {1, 2}) {
    const DeckRun d(discs(report(effort(turns == 1 ? "one" : "two", 360.0 * turns))));
    ASSERT_EQ(d.exit, 0) << d.log;
    const auto torque = [turns](double rpm) {
      return half_swing([turns, rpm](double angle) {
        double sum = 0;
        for (const int k : {1, 3})
          sum += 800 / (pi * pi * k * k) * std::cos(angle * k / turns) * 0.75 /
                 (1 - std::pow(rpm / 60 / natural * k / turns, 2));
        return sum;
      });
    };
    const auto row = d.csv("t_stresses.csv").last();
    const double rpm = row.at("speed [rpm]"), found = row.at("torque in the shaft [N m]");
    EXPECT_NEAR(found, torque(rpm), 1e-6 * found) << turns;
    for (const double other : {1000.0, 1050.0, 1100.0})
      EXPECT_GE(found, torque(other) * (1 - 1e-6)) << turns << " " << other;
  }
}

// Twice the slip frequency of four poles on 50 Hz: |100 Hz - 4 speed|.
TEST(ShaftTorques, TwiceTheSlipCrossesModes) {
  const DeckRun d(discs(report(R"([[step.torque]]
name = "slip"
at = "A"
order = 4
frequency = "100 Hz"
amplitude = "10 N.m"
[output]
report = false
)")));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns met = d.csv("t_interferences.csv");
  double speed = 0;
  for (const auto& line : lines(d, "t_interferences.csv"))
    if (line[0] == "slip") speed = std::stod(line[2]);
  EXPECT_NEAR(speed, 15 * (100 - natural), 1e-5);
  // at 1000 rpm 33.3 Hz, at 1100 rpm 26.7 Hz: nearest to the mode at 1000 rpm
  const auto row = d.csv("t_stresses.csv").last();
  const double f = 100 - 4 * 1000 / 60.0;
  EXPECT_NEAR(row.at("speed [rpm]"), 1000, 1e-6);
  EXPECT_NEAR(row.at("frequency [Hz]"), f, 1e-9);
  EXPECT_NEAR(row.at("torque in the shaft [N m]"), 7.5 / (1 - std::pow(f / natural, 2)), 1e-5);
}

namespace {

/// Three wheels on a shaft, and a torque of 2 N m on the first. `section`: rows or tables of the shaft.
std::string three_wheels(const std::string& section, const std::string& steps) {
  std::string deck =
      "format = 1\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = \"s\"\nmaterial = "
      "\"steel\"\ndamping = { torsion_beta = \"1e-7 s\" }\n" +
      section;
  for (const char* wheel :
       {"at = \"a:start\"\nIp = \"0.3 kg.m^2\"", "at = \"a:end\"\nIp = \"0.2 kg.m^2\"",
        "at = \"b:end\"\nIp = \"0.1 kg.m^2\""})
    deck += std::string("[[disk]]\nmass = \"20 kg\"\n") + wheel + "\n";
  for (const char* place : {"a:start", "b:end"})
    deck += std::string(
                "[[bearing]]\ntype = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = \"2e7 N/m\"\nkzz = "
                "\"1e7 N/m\"\nat = \"") +
            place + "\"\n";
  return deck + steps + "[output]\nreport = false\n";
}
const std::string round_sections =
    "columns = [\"name\", \"length[mm]\", \"od[mm]\", \"min_elements\"]\nrows = [[\"a\", 400, 50, "
    "2], "
    "[\"b\", 400, 50, 2]]\n";
std::string train(const std::string& name, int modes) {
  return "[[step]]\nname = \"" + name +
         "\"\ntype = \"api_torsional\"\noperating_speed = [\"10000 "
         "rpm\", \"15000 rpm\"]\nmodes = " +
         std::to_string(modes) +
         "\nmultiples = [9]\nstress_limit = \"20 MPa\"\n[[step.torque]]\nname = \"x\"\nat = "
         "\"a:start\"\norder = 1\namplitude = \"2 N.m\"\n";
}

}  // namespace

// The torque meets the second mode at 11,000 rpm: a list of one mode is no reason to look elsewhere.
TEST(ShaftTorques, ResonancesBeyondTheListOfModesAreMet) {
  const DeckRun run(three_wheels(round_sections, train("few", 1) + train("many", 6)));
  ASSERT_EQ(run.exit, 0) << run.log;
  const auto few = run.csv("few_stresses.csv").last(), many = run.csv("many_stresses.csv").last();
  EXPECT_NEAR(few.at("shear stress [MPa]"), many.at("shear stress [MPa]"),
              1e-6 * many.at("shear stress [MPa]"));
  EXPECT_GT(many.at("shear stress [MPa]"), 20.0);
  EXPECT_TRUE(run.says("FAILED")) << run.log;
}

// Sections given by their constants have no diameter: 0 MPa "passed".
TEST(ShaftTorques, AStressThatIsNotKnownIsNotPassed) {
  std::string general;
  for (const char* name : {"a", "b"})
    general +=
        std::string("[[shaft.section]]\nname = \"") + name +
        "\"\nlength = \"400 mm\"\ngeneral = { A = \"1000 mm^2\", Iy = \"2e4 mm^4\", Iz = \"5e5 "
        "mm^4\", J = \"9e4 mm^4\", kappa_y = 0.85, kappa_z = 0.85 }\n";
  const DeckRun run(three_wheels(general, train("t", 6)));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("no stress is known where a section has no diameters: s")) << run.log;
  EXPECT_TRUE(std::isnan(run.csv("t_stresses.csv").last().at("shear stress [MPa]"))) << run.log;
}

// Nothing damps the torsion: 3e10 MPa, "for information".
TEST(ShaftTorques, AResonanceThatNothingDampsIsNamed) {
  std::string deck = three_wheels(round_sections, train("t", 6));
  deck.erase(deck.find("damping = "), deck.find("columns") - deck.find("damping = "));
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("a resonance without damping lies within the operating speeds")) << run.log;
}
