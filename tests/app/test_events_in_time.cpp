// What transients must not pass over, and where they go on: shocks between steps, drives after other
// drives, speeds at which a run ends.
#include "deck_run.hpp"

#include <algorithm>
#include <cmath>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;

/// A heavy disk on a short shaft in two springs.
std::string rotor(const std::string& rest, const std::string& shaft_keys = {}) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "s"
material = "steel"
)" + shaft_keys +
         R"(columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 200, 40, 1], ["b", 200, 40, 1]]
[[disk]]
name = "d"
at = "s/a:end"
mass = "10 kg"
Ip = "2 kg.m^2"
Id = "1 kg.m^2"
[[bearing]]
name = "A"
at = "s:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "5e3 N.s/m"
czz = "5e3 N.s/m"
[[bearing]]
name = "B"
at = "s:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "5e3 N.s/m"
czz = "5e3 N.s/m"
[[probe]]
name = "p"
at = "d"
[output]
report = false
every = "5 ms"
quantities = ["speed", "torque", "energy", "probes"]
)" + rest;
}
std::string transient(const std::string& name, const std::string& keys) {
  return "[[step]]\nname = \"" + name + "\"\ntype = \"transient\"\n" + keys;
}
std::string drive(const std::string& keys) { return "[[drive]]\nat = \"d\"\n" + keys; }
std::string looked_at_closely(std::string deck) {
  const std::string coarse = "every = \"5 ms\"";
  return deck.replace(deck.find(coarse), coarse.size(), "every = \"0.5 ms\"");
}
double largest_of(const Columns& t, const std::string& column) {
  double out = 0;
  for (const auto& row : t.rows)
    out = std::max(out, std::abs(row[t.column(column)]));
  return out;
}
double last_of(const DeckRun& run, const std::string& file, const std::string& column) {
  const Columns t = run.csv(file);
  return t.rows.back()[t.column(column)];
}

}  // namespace

// A balanced rotor in large steps went over a shock that had died away before the next look at it.
TEST(Shocks, AreMetHoweverLongTheRun) {
  const std::string shock =
      "[base]\nz = { type = \"decaying\", start = \"0.5 s\", amplitude = \"100 m/s^2\", frequency "
      "= "
      "\"100 Hz\", phase = \"-90 deg\", decay = \"5 ms\" }\n" +
      drive("type = \"speed\"\nspeed = \"3000 rpm\"\n");
  for (const char* linear : {"false", "true"}) {
    double peak[2];
    for (int k = 0; k < 2; ++k) {
      const DeckRun run(looked_at_closely(
          rotor(shock + transient("t", std::string("start = \"static\"\nlinear = ") + linear +
                                           "\nduration = \"" + (k == 0 ? "0.7 s" : "4 s") +
                                           "\"\nintegrator = { tolerance = 1e-5 }\n"))));
      ASSERT_EQ(run.exit, 0) << run.log;
      peak[k] = largest_of(run.csv("t.csv"), "p.z [m]");
    }
    EXPECT_GT(peak[0], 1e-5) << linear;
    EXPECT_NEAR(peak[1], peak[0], 1e-3 * peak[0]) << linear;
  }
}

// The same of a torque: a short circuit in a train that turns steadily.
TEST(Shocks, ShortCircuitsAreMetToo) {
  double most[2];
  for (int k = 0; k < 2; ++k) {
    const DeckRun run(looked_at_closely(rotor(
        "[[disk]]\nname = \"m\"\nat = \"s:end\"\nmass = \"1 kg\"\nIp = \"0.5 kg.m^2\"\nId = \"0.3 "
        "kg.m^2\"\n" +
        drive("type = \"torque\"\ntorque = { type = \"decaying\", start = \"1 s\", "
              "amplitude = \"500 N.m\", frequency = \"50 Hz\", phase = \"-90 deg\", decay = \"20 "
              "ms\" }\n") +
        transient("t",
                  std::string("start = \"rest\"\ninitial_speed = \"1500 rpm\"\nduration = \"") +
                      (k == 0 ? "1.2 s" : "10 s") + "\"\n"))));
    ASSERT_EQ(run.exit, 0) << run.log;
    most[k] = largest_of(run.csv("t.csv"), "energy.elastic [J]");
  }
  EXPECT_GT(most[0], 1e-3);
  EXPECT_NEAR(most[1], most[0], 0.02 * most[0]);
}

// A speed drive that follows a torque took the shaft to the angle its own law would have reached.
TEST(Drives, GoOnFromTheAngleThereIs) {
  const std::string deck =
      drive("name = \"torque\"\ntype = \"torque\"\ntorque = \"100 N.m\"\nstep = \"a\"\n") +
      drive(
          "name = \"hold\"\ntype = \"speed\"\nspeed = \"477.27650358599703 rpm\"\nstep = \"b\"\n") +
      transient("a", "duration = \"1 s\"\nstart = \"rest\"\n") +
      transient("b", "duration = \"0.2 s\"\nfrom = \"a\"\n");
  const DeckRun run(rotor(deck));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns a = run.csv("a.csv"), b = run.csv("b.csv");
  const std::size_t phi = a.column("phi [rad]");
  EXPECT_NEAR(b.rows.front()[phi], a.rows.back()[phi], 1e-9 * a.rows.back()[phi]);
  const double speed = 477.27650358599703 * M_PI / 30;
  EXPECT_NEAR(b.rows.back()[phi], a.rows.back()[phi] + 0.2 * speed, 1e-6);
  for (const auto& row : b.rows) {
    EXPECT_LT(std::abs(row[b.column("drive hold torque [N.m]")]), 20.0);
    EXPECT_LT(row[b.column("energy.elastic [J]")], 0.1);
  }
}

// A drive of the same name with another law, after another run: its angle is the one there is; and
// the next step, on the same system, begins anew.
TEST(Drives, GoOnFromAnotherRunWhateverTheirLaw) {
  const std::string ramp = drive(
      "name = \"motor\"\ntype = \"speed\"\nspeed = { type = \"ramp\", time = [\"0 s\", \"1 "
      "s\"], value = [\"0 rpm\", \"1000 rpm\"] }\n");
  const DeckRun before(
      rotor(ramp + transient("t", "duration = \"1 s\"\nstart = \"rest\"\ncheckpoint = \"1 s\"\n")));
  ASSERT_EQ(before.exit, 0) << before.log;
  const DeckRun after(rotor(drive("name = \"motor\"\ntype = \"speed\"\nspeed = \"1000 rpm\"\n") +
                            transient("t", "duration = \"0.1 s\"\nprevious = \"" +
                                               (before.folder / "r").string() + "\"\n") +
                            transient("anew", "duration = \"0.1 s\"\nstart = \"rest\"\n")));
  ASSERT_EQ(after.exit, 0) << after.log;
  const Columns t = after.csv("t.csv");
  EXPECT_NEAR(t.rows.front()[t.column("phi [rad]")], 500 * M_PI / 30, 1e-9);
  const Columns anew = after.csv("anew.csv");
  EXPECT_EQ(anew.rows.front()[anew.column("phi [rad]")], 0.0);
  for (const auto& row : anew.rows)
    EXPECT_LT(row[anew.column("energy.elastic [J]")], 0.1);
  for (const auto& row : t.rows)
    EXPECT_LT(row[t.column("energy.elastic [J]")], 0.1);
}

// "unless 'from' names a transient step": after a static step the start was forgotten.
TEST(Starts, AreThoseOfTheirKeysAfterAStaticStep) {
  const std::string turning = "[[unbalance]]\nat = \"d\"\namount = \"100 g.mm\"\n" +
                              drive("type = \"speed\"\nspeed = \"3000 rpm\"\n") +
                              "[[step]]\nname = \"s\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n";
  for (const char* start :
       {"start = \"unbalance_response\"\n",
        "start = \"mode\"\nmode_kind = \"lateral\"\nmode_amplitude = \"0.1 mm\"\n"}) {
    const std::string keys = std::string("duration = \"5 ms\"\n") + start;
    const DeckRun alone(rotor(turning + transient("t", keys))),
        after(rotor(turning + transient("t", keys + "from = \"s\"\n")));
    ASSERT_EQ(alone.exit, 0) << alone.log;
    ASSERT_EQ(after.exit, 0) << after.log;
    const Columns x = alone.csv("t.csv"), y = after.csv("t.csv");
    for (const char* column : {"p.y [m]", "p.z [m]"}) {
      const double expected = x.rows.front()[x.column(column)];
      EXPECT_NEAR(y.rows.front()[y.column(column)], expected, 1e-9 * std::abs(expected) + 1e-15)
          << start << column;
    }
    EXPECT_GT(y.rows.front()[y.column("energy.elastic [J]")], 1e-9);
    EXPECT_NEAR(y.rows.front()[y.column("energy.elastic [J]")],
                x.rows.front()[x.column("energy.elastic [J]")], 1e-9);
  }
}

TEST(Starts, AStepBeginsWhereOneMotionEnded) {
  const DeckRun run(rotor(transient("a", "duration = \"5 ms\"\nstart = \"rest\"\n") +
                          transient("b", "duration = \"5 ms\"\nfrom = \"a\"\nprevious = \"x\"\n")));
  EXPECT_EQ(run.exit, 3) << run.log;
  EXPECT_TRUE(run.says("cannot begin both from step 'a' and from the run in")) << run.log;
}

// Zero was taken for "never".
TEST(StopSpeed, MayBeZero) {
  const DeckRun run(
      rotor(drive("type = \"torque\"\ntorque = \"-100 N.m\"\n") +
            transient("t",
                      "start = \"rest\"\ninitial_speed = \"500 rpm\"\nstop_speed = \"0 rpm\"\n"
                      "duration = \"4 s\"\n")));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("stop speed reached")) << run.log;
  EXPECT_NEAR(last_of(run, "t.csv", "speed [rpm]"), 0.0, 2.5);  // a row is 2.4 rpm
}

// It is of the reference speed, as initial_speed is, whatever drive stands first.
TEST(StopSpeed, IsOfTheReference) {
  const DeckRun run(
      rotor(drive("type = \"torque\"\ntorque = \"100 N.m\"\n") +
                transient("t",
                          "start = \"rest\"\ninitial_speed = \"1000 rpm\"\nstop_speed = \"500 "
                          "rpm\"\nduration = \"8 s\"\n"),
            "speed_ratio = -2\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("stop speed reached")) << run.log;
  EXPECT_NEAR(last_of(run, "t.csv", "speed [rpm]"), -1000.0, 2.5);
}

// Between two looks of one long step the speed fell below it and rose again.
TEST(StopSpeed, IsMetWhereTheSpeedTurns) {
  for (const double stop : {98.0, 97.0, 96.0, 95.8}) {
    const DeckRun run(rotor(
        drive("type = \"torque\"\ntorque = { type = \"table\", time = [\"0 s\", \"10 s\"], value = "
              "[\"-20 N.m\", \"80 N.m\"] }\n") +
        transient("t", "start = \"rest\"\ninitial_speed = \"191.1 rpm\"\nstop_speed = \"" +
                           std::to_string(stop) + " rpm\"\nduration = \"4 s\"\n")));
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_TRUE(run.says("stop speed reached")) << stop << run.log;
  }
}

// The law of a drive that ends with its ramp was read on the far side of the corner.
TEST(Drives, EndOnTheirNearSide) {
  const std::string ramp = drive(
      "type = \"speed\"\nspeed = { type = \"ramp\", time = [\"0 s\", \"1 s\"], value = [\"0 rpm\", "
      "\"1000 rpm\"] }\n");
  const DeckRun run(rotor(ramp + transient("t", "duration = \"1 s\"\nstart = \"rest\"\n")));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_FALSE(run.says("energy balance")) << run.log;
  const Columns t = run.csv("t.csv");
  const double alpha = 1000 * M_PI / 30;
  // all inertia is that of the disk but for the shaft's own
  EXPECT_NEAR(t.rows.back()[t.column("drive drive 1 torque [N.m]")], 2.0 * alpha, 0.01 * alpha);
}

// A smooth law of speed: its torque was that of one step from end to end.
TEST(Drives, SmoothLawsHaveTheirTorques) {
  const DeckRun run(rotor(
      drive("type = \"speed\"\nspeed = { type = \"smooth\", time = [\"0.1 s\", \"0.3 s\"], value = "
            "[\"100 rpm\", \"-500 rpm\"] }\n") +
      transient("t", "duration = \"0.4 s\"\nstart = \"rest\"\n")));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns t = run.csv("t.csv");
  for (const auto& row : t.rows) {
    const double s = std::clamp((row[0] - 0.1) / 0.2, 0.0, 1.0);
    const double alpha = -600 * M_PI / 30 / 0.2 * 30 * s * s * (1 - s) * (1 - s);
    EXPECT_NEAR(row[t.column("drive drive 1 torque [N.m]")], 2.0 * alpha, 6.0) << row[0];
  }
}

// A gear between a shaft at speed and one at rest is a shock, and says so.
TEST(Starts, ShaftsThatTurnTogetherBeginTogetherOrItIsSaid) {
  const std::string second =
      "[[shaft]]\nname = \"t\"\norigin = [\"410 mm\", \"0 mm\", \"0 mm\"]\nmaterial = \"steel\"\n"
      "columns = [\"name\", \"length[mm]\", \"od[mm]\", \"min_elements\"]\nrows = [[\"c\", 200, "
      "40, "
      "1]]\n[[bearing]]\nname = \"E\"\nat = \"t:end\"\ntype = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = "
      "\"1e8 N/m\"\nkzz = \"1e8 N/m\"\n[[bearing]]\nname = \"C\"\nat = \"s:end\"\nto = "
      "\"t:start\"\ntype = \"coupling\"\nkyy = \"1e6 N/m\"\nkzz = \"1e6 N/m\"\nkrxx = \"1e4 "
      "N.m/rad\"\ncrxx = \"2 N.m.s/rad\"\n";
  const std::string driven = drive("type = \"speed\"\nspeed = \"3000 rpm\"\n");
  const std::string keys = "duration = \"5 ms\"\nstart = \"rest\"\n";
  const DeckRun apart(rotor(second + driven + transient("t", keys)));
  ASSERT_EQ(apart.exit, 0) << apart.log;
  EXPECT_TRUE(apart.says("meets them with a shock")) << apart.log;
  const DeckRun together(
      rotor(second + driven + transient("t", keys + "initial_speed = \"3000 rpm\"\n")));
  ASSERT_EQ(together.exit, 0) << together.log;
  EXPECT_FALSE(together.says("meets them with a shock")) << together.log;
}

namespace {

/// A speed that ends where it stays, of a rotor that whirls.
std::string ramp_and_hold(const std::string& from, const std::string& to, const std::string& more) {
  return rotor(
      "[[unbalance]]\nat = \"d\"\namount = \"2000 g.mm\"\n"
      "[[drive]]\nat = \"s:start\"\ntype = \"speed\"\nspeed = { type = \"ramp\", "
      "time = [\"0 s\", \"0.2 s\"], value = [\"" +
      from + "\", \"" + to + "\"] }\n" + more);
}
std::string level(const std::string& value, const std::string& more = {}) {
  return "[[event]]\nname = \"full\"\ntype = \"speed\"\nvalue = \"" + value + "\"\n" + more;
}
const std::string run_on = transient("t", "start = \"static\"\nduration = \"0.3 s\"\n");

/// The time of the only passage.
double only_passage(const DeckRun& run) {
  EXPECT_EQ(run.exit, 0) << run.log;
  EXPECT_EQ(run.summary("t").at("events").number(), 1.0) << run.log;
  const Columns t = run.csv("t_events.csv");
  EXPECT_EQ(t.rows.size(), 1u);
  return t.rows.empty() ? NAN : t.rows[0][t.column("time [s]")];
}

}  // namespace

// The speed of a node that whirls is within 1e-7 rpm of that of its drive: it passed the level it
// stays at dozens of times, the first one late; from above it never did.
TEST(Levels, AreReachedOnceWhereARampEnds) {
  const DeckRun up(ramp_and_hold("1000 rpm", "3000 rpm", level("3000 rpm") + run_on));
  EXPECT_NEAR(only_passage(up), 0.2, 1e-7);
  EXPECT_EQ(up.csv("t_events.csv").rows.size(), 1u);
  const DeckRun down(ramp_and_hold("3000 rpm", "1000 rpm", level("1000 rpm") + run_on));
  EXPECT_NEAR(only_passage(down), 0.2, 1e-7);
  const DeckRun through(ramp_and_hold("1000 rpm", "3000 rpm", level("2000 rpm") + run_on));
  EXPECT_NEAR(only_passage(through), 0.1, 1e-7);
}

// It leaves the level again: that is another passage.
TEST(Levels, AreLeftAfterTheyWereHeld) {
  const DeckRun run(
      rotor("[[drive]]\nat = \"s:start\"\ntype = \"speed\"\nspeed = { type = \"ramp\", time = "
            "[\"0 s\", \"0.1 s\", \"0.2 s\", \"0.3 s\"], value = [\"1000 rpm\", \"3000 rpm\", "
            "\"3000 rpm\", \"1000 rpm\"] }\n" +
            level("3000 rpm") + run_on));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns t = run.csv("t_events.csv");
  ASSERT_EQ(t.rows.size(), 2u);
  EXPECT_NEAR(t.rows[0][t.column("time [s]")], 0.1, 1e-6);
  EXPECT_NEAR(t.rows[1][t.column("time [s]")], 0.2, 1e-6);
}

// An event that ended the run was in no table, as the last step ended a rounding before it.
TEST(Levels, AStopIsListed) {
  for (const char* value : {"3000 rpm", "2345 rpm"}) {
    const DeckRun run(
        ramp_and_hold("1000 rpm", "3000 rpm", level(value, "stop = true\n") + run_on));
    EXPECT_TRUE(run.says("stop speed reached")) << run.log;
    const double end = run.summary("t").at("t_end [s]").number();
    EXPECT_NEAR(end, 0.2 * (std::stod(value) - 1000) / 2000, 1e-7);
    EXPECT_NEAR(only_passage(run), end, 1e-9);
  }
}

TEST(Levels, StopSpeedsAreThoseOfTheDrive) {
  const std::string keys = "start = \"static\"\nduration = \"0.3 s\"\nstop_speed = \"3000 rpm\"\n";
  const DeckRun reached(ramp_and_hold("1000 rpm", "3000 rpm", transient("t", keys)));
  ASSERT_EQ(reached.exit, 0) << reached.log;
  EXPECT_NEAR(reached.summary("t").at("t_end [s]").number(), 0.2, 1e-7);
  // where it is from the start, nothing is reached
  const DeckRun held(ramp_and_hold("3000 rpm", "3000 rpm", transient("t", keys)));
  ASSERT_EQ(held.exit, 0) << held.log;
  EXPECT_EQ(held.summary("t").at("t_end [s]").number(), 0.3) << held.log;
}

// A governor brings the speed to its target, and what is left of its swing is no passage.
TEST(Levels, AreReachedOnceByAGovernor) {
  const DeckRun run(
      rotor(drive("type = \"torque\"\ntorque = \"0 N.m\"\ngovernor = { target = \"1000 rpm\", kp = "
                  "\"100 N.m.s/rad\", ki = \"2000 N.m/rad\", max_torque = \"10 kN.m\" }\n") +
            level("1000 rpm") +
            transient("t", "start = \"rest\"\ninitial_speed = \"900 rpm\"\nduration = \"4 s\"\n")));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_LE(run.csv("t_events.csv").rows.size(), 3u);
  EXPECT_GE(run.csv("t_events.csv").rows.size(), 1u);
}
