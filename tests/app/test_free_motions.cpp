// What a deck leaves free stays free: a step of another kind changes no other, frames are held by
// their supports alone, and what is held is said.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <vector>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

/// A bar on two rings that let it slide.
std::string sliding_bar(const std::string& parts) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "bar"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 400, 50]]
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
at = "a:end"
type = "rigid"
directions = ["y", "z"]
[[probe]]
name = "p"
at = "a:mid"
[output]
report = false
every = "2 ms"
quantities = ["positions"]
)" + parts;
}

const std::string in_time = R"([[step]]
name = "t"
type = "transient"
start = "rest"
duration = "20 ms"
)";
/// Along x, of the probe, m.
double way(const DeckRun& run) {
  const Columns history = run.csv("t.csv");
  const std::size_t x = history.column("p position.x [m]");
  return history.rows.back()[x] - history.rows.front()[x];
}

const std::string modes = "[[step]]\nname = \"m\"\ntype = \"modal\"\n";

}  // namespace

TEST(FreeMotions, AreThoseOfTheStepAlone) {
  const std::string thrown = "[[initial]]\nvelocity = [\"1 m/s\", \"0 m/s\", \"0 m/s\"]\n";
  for (const std::string& before :
       {std::string(), modes,
        std::string("[[step]]\ntype = \"torsional\"\nmax_speed = \"3000 rpm\"\n")}) {
    const DeckRun run(sliding_bar(thrown + before + in_time));
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_NEAR(way(run), 0.02, 1e-12) << before;  // 1 m/s for 20 ms, nothing resists
  }
}

TEST(FreeMotions, FollowTheShakenBase) {
  const std::string shaken =
      "[base]\nx = { type = \"harmonic\", amplitude = \"10 m/s^2\", frequency = \"25 Hz\" }\n";
  const DeckRun alone(sliding_bar(shaken + in_time)), beside(sliding_bar(shaken + modes + in_time));
  ASSERT_EQ(alone.exit, 0) << alone.log;
  ASSERT_EQ(beside.exit, 0) << beside.log;
  EXPECT_GT(std::abs(way(alone)), 1e-5);
  EXPECT_EQ(way(beside), way(alone));
}

// Nothing says where a bar that the base moves along starts in equilibrium.
TEST(FreeMotions, HaveNoEquilibriumOnAShakenBase) {
  const std::string shaken =
      "[base]\nx = { type = \"harmonic\", amplitude = \"10 m/s^2\", frequency = \"25 Hz\" }\n";
  const DeckRun run(sliding_bar(
      shaken + "[[step]]\ntype = \"transient\"\nduration = \"1 ms\"\nstart = \"static\"\n"));
  EXPECT_EQ(run.exit, 3) << run.log;
  EXPECT_TRUE(run.says("E32")) << run.log;
}

// A right-angle frame on ball feet at A and C and a support at the corner B, loaded across its plane
// at the middle of B-C: moments about the line A-B and about B-C give 0, 50 and 50 N.
TEST(FreeMotions, FramesAreHeldByTheirSupportsAlone) {
  const DeckRun run(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "frame"
material = "steel"
rotating = false
path = [{ to = ["1 m", "0 m", "0 m"] }, { to = ["1 m", "1 m", "0 m"] }]
columns = ["name", "length[mm]", "od[mm]"]
rows = [["l1", 1000, 30], ["l2", 1000, 30]]
[[bearing]]
name = "A"
at = "l1:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "B"
at = "l1:end"
type = "rigid"
directions = ["z"]
[[bearing]]
name = "C"
at = "l2:end"
type = "rigid"
directions = ["x", "y", "z"]
[[load]]
at = "l2:mid"
force = ["0 N", "0 N", "0.1 N"]
[[step]]
name = "s"
type = "static"
[output]
report = false
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_EQ(run.log.find("held"), std::string::npos) << run.log;
  const Columns forces = run.csv("s_supports.csv");
  const std::size_t z = forces.column("F_z [N]");
  EXPECT_NEAR(forces.rows[0][z], 0.0, 1e-5);
  EXPECT_NEAR(std::abs(forces.rows[1][z]), 0.05, 1e-5);
  EXPECT_NEAR(std::abs(forces.rows[2][z]), 0.05, 1e-5);
}

// A cantilever under the end moment 2 pi n EI/L closes on itself n times; sections stand upside down
// at the half turns, where no smallest rotation leads.
TEST(FreeMotions, RollUpsPassTheOpposite) {
  for (const double turns : {0.5, 1.0, 3.0}) {
    const double EI = 210e9 * std::numbers::pi / 64 * 1e-8;
    const DeckRun run(fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "210 GPa"
nu = 0.3
density = "7850 kg/m^3"
[[shaft]]
name = "A"
material = "m"
rotating = false
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 1000, 10, 60]]
[[joint]]
name = "clamp"
kind = "rigid"
at = "a:start"
[[load]]
at = "a:end"
moment = ["0 N.m", "0 N.m", "{:.17g} N.m"]
[[step]]
name = "s"
type = "static"
load_steps = 60
[output]
report = false
)",
                                  2 * std::numbers::pi * turns * EI));
    ASSERT_EQ(run.exit, 0) << run.log;
    const auto tip = run.csv("s_deflection.csv").last();
    const double radius = 1.0 / (2 * std::numbers::pi * turns);
    const double angle = 2 * std::numbers::pi * turns;
    EXPECT_NEAR(tip.at("u_x [m]"), radius * std::sin(angle) - 1.0, 1e-6) << turns;
    EXPECT_NEAR(tip.at("u_y [m]"), radius * (1.0 - std::cos(angle)), 1e-6) << turns;
    const Columns sections = run.csv("s_sections.csv");
    for (const auto& row : sections.rows) {
      const auto at = sections.named(row);
      EXPECT_NEAR(std::hypot(at.at("M_y [N m]"), at.at("M_z [N m]")), angle * EI,
                  1e-6 * angle * EI);
    }
  }
}

// 100 kg on 1e7 N/m, zeta 0.0316, weight, unbalance and a free spin. The mean of what the unbalance
// does to the spin over a revolution is zero but for rounding, by which the list had "0 modes,
// complete" and stability "diverges, certified".
TEST(FreeMotions, RoundingOfAMeanHoldsNoSpin) {
  for (const char* turned : {"0 deg", "90 deg"})
    for (const char* law : {"linear\"\nkyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\ncyy = \"2e3 "
                            "N.s/m\"\nczz = \"2e3 N.s/m\"\n",
                            "ball\"\nballs = 9\nball_diameter = \"12 mm\"\npitch_diameter = \"65 "
                            "mm\"\n"}) {
      const DeckRun run(whirl::test::lateral_mass(
          100, "9.81 m/s^2",
          fmt::format("[[bearing]]\nname = \"B\"\nat = \"mass\"\ntype = \"{}[[unbalance]]\nat = "
                      "\"mass\"\namount = \"100 g.mm\"\nphase = \"{}\"\n[[step]]\nname = "
                      "\"m\"\ntype = \"modal\"\nspeed = \"3000 rpm\"\n[[step]]\nname = "
                      "\"s\"\ntype = \"stability\"\nspeed = {{ start = \"500 rpm\", stop = \"6000 "
                      "rpm\", points = 4 }}\n[output]\nreport = false\n",
                      law, turned)));
      ASSERT_EQ(run.exit, 0) << run.log;
      EXPECT_EQ(run.csv("m_modes.csv").rows.size(), 2u) << run.log;
      EXPECT_TRUE(run.says("stable from 500 to 6000 rpm (certified at 4 speeds")) << run.log;
    }
}

// A rotor that dampers alone hold drifts to rest along both axes at one rate, c/m: a double root, of which
// one was taken for a copy of the other.
TEST(FreeMotions, BothRatesOfAFloatingRotorOnDampersAreListed) {
  for (const double unequal : {1.0, 1.0 + 1e-9, 1.0 + 1e-5, 1.01, 3.0}) {
    const double c = 400.0;
    const std::string text =
        "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = "
        "\"s\"\nmaterial = "
        "\"steel\"\n[[shaft.section]]\nname = \"s\"\nlength = \"1000 mm\"\nrigid = "
        "true\n[[disk]]\nname = \"d\"\nat "
        "= \"s:mid\"\nmass = \"20 kg\"\nIp = \"0.5 kg.m^2\"\nId = \"0.25 kg.m^2\"\n[[bearing]]\nat "
        "= "
        "\"s:mid\"\ntype = \"linear\"\nkxx = \"1e9 N/m\"\nkrr = \"1e7 N.m/rad\"\n" +
        fmt::format("cyy = \"{} N.s/m\"\nczz = \"{:.12g} N.s/m\"\n", c, c * unequal) +
        "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 12\nmotion = \"lateral\"\n";
    const DeckRun run(text);
    ASSERT_EQ(run.exit, 0) << unequal << run.log;
    const Columns roots = run.csv("m_real_roots.csv");
    ASSERT_EQ(roots.rows.size(), 4u) << unequal;
    const std::size_t rate = roots.column("rate [1/s]");
    std::vector<double> rates;
    for (const auto& row : roots.rows)
      rates.push_back(row[rate]);
    std::sort(rates.begin(), rates.end());
    EXPECT_NEAR(rates[0] / (-unequal * c / 20.0), 1.0, 1e-8) << unequal;
    EXPECT_NEAR(rates[1] / (-c / 20.0), 1.0, 1e-8) << unequal;
    EXPECT_EQ(rates[2], 0.0);
    EXPECT_EQ(rates[3], 0.0);
  }
}

// A casing on two bearings whose mass hangs beside its axis: sqrt(m g e/(Ip + m e^2)) about its axis; it
// was held at its angle.
TEST(FreeMotions, ACasingThatHangsSwings) {
  const auto casing = [](const char* offset, const char* step) {
    return std::string(R"(format = 1
[output]
report = false
every = "1 ms"
quantities = ["rotation"]
[model]
gravity = "9.81 m/s^2"
gravity_direction = "-z"
[[shaft]]
name = "c"
rotating = false
[[shaft.section]]
name = "a"
length = "1 m"
rigid = true
[[disk]]
name = "d"
at = "a:mid"
mass = "10 kg"
Ip = "0.05 kg.m^2"
Id = "0.5 kg.m^2"
offset = )") +
           offset +
           R"(
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "a:end"
type = "rigid"
directions = ["y", "z"]
[[probe]]
name = "p"
at = "d"
[[step]]
name = "s"
)" + step;
  };
  const double expected = std::sqrt(10 * 9.81 * 0.1 / (0.05 + 10 * 0.01)) / (2 * std::numbers::pi);
  const DeckRun modes(
      casing(R"(["0 mm", "0 mm", "-100 mm"])", "type = \"modal\"\nspeed = \"0 rpm\"\nmodes = 1\n"));
  ASSERT_EQ(modes.exit, 0) << modes.log;
  const auto table = modes.csv("s_modes.csv");
  EXPECT_NEAR(table.named(table.rows.at(0)).at("frequency [Hz]"), expected, 1e-6);
  // from level it swings through the lowest point to the other side: 180 degrees
  const DeckRun swing(casing(R"(["0 mm", "100 mm", "0 mm"])",
                             "type = \"transient\"\nstart = \"rest\"\nduration = \"1 s\"\n"));
  ASSERT_EQ(swing.exit, 0) << swing.log;
  const auto motion = swing.csv("s.csv");
  double least = 0;
  for (const auto& row : motion.rows)
    least = std::min(least, row[motion.column("p phi [rad]")]);
  EXPECT_NEAR(least, -std::numbers::pi, 1e-3);
}
