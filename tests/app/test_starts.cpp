// Where a transient step begins: angles of drives, initial motions beside them, steady responses that
// are none.
#include "deck_run.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;

/// A steel shaft with a wheel on two springs, in steps of `rest`.
std::string rotor(const std::string& rest, const std::string& section = {}) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "s"
material = "steel"
)" +
         (section.empty()
              ? "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 400, 40]]\n"
              : section) +
         R"([[disk]]
name = "d"
at = "a:mid"
mass = "20 kg"
Ip = "0.3 kg.m^2"
[[unbalance]]
at = "d"
amount = "100 g.mm"
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
cyy = "4e3 N.s/m"
czz = "4e3 N.s/m"
[[bearing]]
name = "R"
at = "a:end"
type = "linear"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
cyy = "4e3 N.s/m"
czz = "4e3 N.s/m"
[[probe]]
name = "p"
at = "d"
[output]
report = false
every = "0.5 ms"
quantities = ["speed", "probes", "energy"]
)" + rest;
}
const std::string turned =
    "[[drive]]\nat = \"a:start\"\ntype = \"speed\"\nspeed = \"3000 rpm\"\nangle = \"70 deg\"\nstep "
    "= \"t\"\n";
std::string transient(const std::string& keys) {
  return "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"5 ms\"\n" + keys;
}
double most_elastic(const DeckRun& run) {
  const Columns t = run.csv("t.csv");
  double most = 0;
  for (const auto& row : t.rows)
    most = std::max(most, row[t.column("energy.elastic [J]")]);
  return most;
}

}  // namespace

// The equilibrium has its shafts at angle zero: a drive that begins elsewhere wound the shaft up, by
// 80 kJ.
TEST(Starts, ADriveThatBeginsAtAnAngleWindsNothingUp) {
  for (const char* start :
       {"start = \"rest\"\n", "start = \"static\"\n", "start = \"unbalance_response\"\n"}) {
    const DeckRun run(rotor(turned + transient(start)));
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_LT(most_elastic(run), 1.0) << start;
  }
  const DeckRun after(rotor(turned +
                            "[[step]]\nname = \"s\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n" +
                            transient("from = \"s\"\ninitial_speed = \"3000 rpm\"\n")));
  ASSERT_EQ(after.exit, 0) << after.log;
  EXPECT_LT(most_elastic(after), 1.0);
  const DeckRun alike(rotor(turned +
                            "[[step]]\nname = \"s\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n" +
                            transient("from = \"s\"\n")));
  ASSERT_EQ(alike.exit, 0) << alike.log;
  EXPECT_LT(most_elastic(alike), 1.0);
}

// Beside a drive the spin of an initial motion was added to it: twice the speed.
TEST(Starts, TheSpinIsNotGivenTwice) {
  const std::string initial =
      "[[initial]]\nangular_velocity = [\"314 rad/s\", \"0 rad/s\", \"0 rad/s\"]\n";
  const DeckRun twice(rotor(turned + initial + transient("start = \"rest\"\n")));
  EXPECT_EQ(twice.exit, 3) << twice.log;
  EXPECT_TRUE(twice.says("the spin of shaft 's' is given twice")) << twice.log;
  const DeckRun once(rotor(initial + transient("start = \"rest\"\n")));
  ASSERT_EQ(once.exit, 0) << once.log;
  EXPECT_NEAR(once.csv("t.csv").rows.front()[1], 314 * 30 / M_PI, 1e-6);
  const DeckRun lost(rotor(initial + transient("start = \"static\"\n")));
  EXPECT_TRUE(lost.says("the initial motion 'initial 1' has no effect")) << lost.log;
}

// Flat sections, a bow on its way, a second shaft at an angle: the start was another motion than the
// steady one.
TEST(Starts, AResponseThatIsNotSteadyIsNoStart) {
  const std::string start =
      transient("start = \"unbalance_response\"\ninitial_speed = \"3000 rpm\"\n");
  const DeckRun flat(rotor(start, R"([[shaft.section]]
name = "a"
length = "400 mm"
general = { A = "1000 mm^2", Iy = "2e4 mm^4", Iz = "5e5 mm^4", J = "9e4 mm^4", kappa_y = 0.85, kappa_z = 0.85 }
)"));
  EXPECT_NE(flat.exit, 0);
  EXPECT_TRUE(flat.says("its stiffness or inertia turns with it")) << flat.log;
  const DeckRun bowed(
      rotor(start,
            "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 400, 40]]\nbow = { "
            "amount = \"50 um\", time_constant = \"1 s\" }\n"));
  EXPECT_NE(bowed.exit, 0);
  EXPECT_TRUE(bowed.says("the thermal bow of shaft 's'")) << bowed.log;
}

// A drive holds a bowed shaft at 30 degrees: the bow of 40 degrees lies at 70, and nothing moves. Where it
// takes hold of the shaft after the equilibrium only, it does so without twisting it.
TEST(Starts, AtRestTheRotorLiesAtTheAngleOfItsDrive) {
  const std::string deck = R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "s"
material = "steel"
bow = { amount = "50 um", phase = "40 deg" }
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 20], ["b", 500, 20]]
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "b:end"
type = "rigid"
directions = ["y", "z"]
[[probe]]
name = "P"
at = "a:end"
[[drive]]
at = "a:start"
type = "speed"
speed = "0 rpm"
angle = "30 deg"
[[step]]
name = "st"
type = "static"
[[step]]
name = "t"
type = "transient"
duration = "20 ms"
start = "static"
[[step]]
name = "t2"
type = "transient"
duration = "20 ms"
from = "st"
)";
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  constexpr double degree = std::numbers::pi / 180, bow = 50e-6, angle = 70 * degree;
  for (const char* file : {"t.csv", "t2.csv"}) {
    const Columns t = d.csv(file);
    for (const auto& cells : t.rows) {
      const auto row = t.named(cells);
      EXPECT_NEAR(row.at("P.y [m]"), bow * std::cos(angle), 1e-9) << file;
      EXPECT_NEAR(row.at("P.z [m]"), bow * std::sin(angle), 1e-9) << file;
      EXPECT_NEAR(row.at("phi [rad]"), 30 * degree, 1e-12) << file;
    }
  }
  std::string later = deck;
  const std::string angle_key = "angle = \"30 deg\"\n";
  later.insert(later.find(angle_key), "step = \"t2\"\n");
  const DeckRun held_later(later);
  ASSERT_EQ(held_later.exit, 0) << held_later.log;
  const Columns t = held_later.csv("t2.csv");
  for (const auto& cells : t.rows) {
    const auto row = t.named(cells);
    EXPECT_NEAR(row.at("phi [rad]"), 30 * degree, 1e-12);
    // the bow of its equilibrium lay at 40 degrees and swings about 70
    EXPECT_LT(std::hypot(row.at("P.y [m]"), row.at("P.z [m]")), 2 * bow);
  }
}

// A step that goes on from another turns on from the angle there: what its drive prescribes besides is told.
TEST(Starts, AnAngleThatIsNotThereIsTold) {
  const auto run_with = [](const std::string& drive) {
    return DeckRun(
        rotor("[[drive]]\nname = \"m\"\nat = \"a:start\"\nstep = \"one\"\ntype = "
              "\"speed\"\nspeed = \"600 rpm\"\n[[drive]]\nname = \"n\"\nat = "
              "\"a:start\"\nstep = \"two\"\n" +
              drive +
              "[[step]]\nname = \"one\"\ntype = \"transient\"\nduration = \"50 ms\"\n"
              "[[step]]\nname = \"two\"\ntype = \"transient\"\nfrom = \"one\"\n"
              "duration = \"5 ms\"\n"));
  };
  // half a turn on: 0.05 s at 10 Hz, and as many rad more as the law has
  const DeckRun ahead = run_with(
      "type = \"angle\"\nangle = { type = \"polynomial\", coefficients = [\"1 rad\", "
      "\"62.83185307179586 rad/s\"] }\n");
  ASSERT_EQ(ahead.exit, 0) << ahead.log;
  EXPECT_TRUE(ahead.says("stands at 3.14159 rad: it turns on from there, off by -1 rad"))
      << ahead.log;
  const DeckRun given = run_with("type = \"speed\"\nspeed = \"600 rpm\"\nangle = \"90 deg\"\n");
  EXPECT_TRUE(given.says("off by -1.5708 rad")) << given.log;
  const DeckRun speed = run_with("type = \"speed\"\nspeed = \"600 rpm\"\n");
  EXPECT_FALSE(speed.says("turns on from there")) << speed.log;
  const DeckRun same = run_with(
      "type = \"angle\"\nangle = { type = \"polynomial\", coefficients = [\"0 rad\", "
      "\"62.83185307179586 rad/s\"] }\n");
  EXPECT_FALSE(same.says("turns on from there")) << same.log;
}
