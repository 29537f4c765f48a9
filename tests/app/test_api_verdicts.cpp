// What an API report passes: nothing that grows, no critical speed that its unbalances do not drive, no
// torsional mode that is not among those asked for.
#include "deck_run.hpp"
#include "flat_rotor.hpp"
#include "sealed_rotor.hpp"

#include <fmt/format.h>

using whirl::test::DeckRun;

namespace {

/// 116 kg between two bearings 880 mm apart, all of their coefficients given.
std::string machine(const std::string& bearings, const std::string& parts) {
  return R"(format = 1
[output]
report = false
[shaft]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["e1", 100, 80], ["j1", 80, 90], ["a", 400, 110], ["b", 400, 110], ["j2", 80, 90], ["e2", 100, 80]]
[[disk]]
name = "w"
at = "a:end"
mass = "40 kg"
Ip = "0.8 kg.m^2"
Id = "0.5 kg.m^2"
[[bearing]]
name = "DE"
at = "j1:mid"
)" + bearings +
         R"([[bearing]]
name = "NDE"
at = "j2:mid"
)" + bearings +
         R"([[bearing]]
name = "thrust"
at = "e1:start"
type = "linear"
kxx = "1e8 N/m"
cxx = "1e4 N.s/m"
[[probe]]
name = "p1"
at = "j1:end"
[[probe]]
name = "p2"
at = "j2:start"
)" + parts;
}

std::string linear(const std::string& kyy, const std::string& kzz, const std::string& cyy,
                   const std::string& czz) {
  return fmt::format(
      "type = \"linear\"\nkyy = \"{} N/m\"\nkzz = \"{} N/m\"\ncyy = \"{} N.s/m\"\nczz = \"{} "
      "N.s/m\"\n",
      kyy, kzz, cyy, czz);
}

std::string seal(const std::string& name, const std::string& at, const std::string& k) {
  return fmt::format(
      "[[bearing]]\nname = \"{}\"\nat = \"{}\"\ntype = \"linear\"\nkyz = \"{} N/m\"\nkzy = \"-{} "
      "N/m\"\n",
      name, at, k, k);
}

std::string api(const std::string& speeds, const std::string& more = "") {
  return "[[step]]\nname = \"api\"\ntype = \"api_lateral\"\noperating_speed = [" + speeds + "]\n" +
         more;
}

const std::string stage = R"([step.stages]
columns = ["name", "power[kW]", "diameter[mm]", "width[mm]", "suction_density[kg/m^3]", "discharge_density[kg/m^3]"]
rows = [["w", 200, 380, 22, 14.0, 16.4]]
)";

/// What the table says of a check: passed, FAILED, for information; "": it is not there.
std::string result_of(const DeckRun& r, const std::string& check) {
  const whirl::io::Value summary = r.summary("api");
  for (const whirl::io::Value& c : summary.at("compliance").items())
    if (c.at("check").text() == check) return c.at("result").text();
  return "";
}

}  // namespace

// The unbalance goes to modes on the mean of the stiffnesses in both directions. On bearings a hundred times
// softer along y the conical motion along y, 2 k a^2/Id = 5300 rpm by hand, is none of them, and stands in
// the middle of the operating range with an amplification of 27.
TEST(ApiVerdicts, ACriticalSpeedThatNoUnbalanceDrivesIsFound) {
  const DeckRun r(machine(linear("6e6", "6e8", "4e2", "2e5"), api("\"5100 rpm\", \"5500 rpm\"")));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(result_of(r, "margin of a critical speed"), "FAILED") << r.log;
  EXPECT_TRUE(r.says("5298.1 rpm")) << r.log;
  EXPECT_EQ(r.summary("api").at("failed").number(), 1);
}

// With pedestals as soft no undamped mode lies below the last speed at all: an empty table is no pass.
TEST(ApiVerdicts, NoModeToPlaceUnbalanceForIsNoPass) {
  const std::string pedestal =
      "support = { mass = \"10 kg\", kyy = \"6.06e6 N/m\", kzz = \"1e10 N/m\", cyy = \"400 "
      "N.s/m\", czz = "
      "\"400 N.s/m\" }\n";
  const DeckRun r(
      machine(linear("6e8", "6e8", "2e5", "2e5") + pedestal, api("\"4200 rpm\", \"4500 rpm\"")));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(result_of(r, "margin of a critical speed"), "FAILED") << r.log;
  EXPECT_TRUE(r.says("4321")) << r.log;
}

// A seal that drives backward whirl is no better than one that drives forward whirl.
TEST(ApiVerdicts, GrowthFailsWhateverWayItWhirls) {
  for (const char* k : {"3e7", "-3e7"}) {
    const std::string sign = std::string(k).starts_with('-') ? k + 1 : k;
    const std::string across = k[0] == '-'
                                   ? "kyz = \"-" + sign + " N/m\"\nkzy = \"" + sign + " N/m\"\n"
                                   : "kyz = \"" + sign + " N/m\"\nkzy = \"-" + sign + " N/m\"\n";
    const DeckRun r(machine(linear("3e7", "3e7", "2e4", "2e4"),
                            "[[bearing]]\nname = \"seal\"\nat = \"a:mid\"\ntype = \"linear\"\n" +
                                across +
                                api("\"7000 rpm\", \"9000 rpm\"", "seals = [\"seal\"]\n" + stage)));
    ASSERT_EQ(r.exit, 0) << r.log;
    EXPECT_EQ(result_of(r, "level 2: log decrement"), "FAILED") << k << "\n" << r.log;
  }
}

// Two seals against each other make one forward motion above the speed well damped and the other one grow.
TEST(ApiVerdicts, GrowthFailsWhateverItsNumber) {
  const DeckRun r(
      machine(linear("3e7", "3e7", "4e3", "4e3"),
              seal("seal", "a:mid", "2.5e8") +
                  "[[bearing]]\nname = \"seal2\"\nat = \"b:mid\"\ntype = \"linear\"\nkyz = "
                  "\"-2.5e8 N/m\"\nkzy = \"2.5e8 N/m\"\n" +
                  api("\"7000 rpm\", \"9000 rpm\"", "seals = [\"seal\", \"seal2\"]\n" + stage)));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(result_of(r, "level 2: log decrement"), "FAILED") << r.log;
}

// Without stages there is no level 1, and the machine is judged as it is given.
TEST(ApiVerdicts, StabilityIsJudgedWithoutStages) {
  const DeckRun sealed(machine(
      linear("3e7", "3e7", "2e4", "2e4"),
      seal("seal", "a:mid", "3e7") + api("\"7000 rpm\", \"9000 rpm\"", "seals = [\"seal\"]\n")));
  ASSERT_EQ(sealed.exit, 0) << sealed.log;
  EXPECT_EQ(result_of(sealed, "level 2: log decrement"), "FAILED") << sealed.log;
  const DeckRun bare(machine(linear("3e7", "3e7", "2e4", "2e4"),
                             seal("rotor", "a:mid", "3e7") + api("\"7000 rpm\", \"9000 rpm\"")));
  EXPECT_EQ(result_of(bare, "log decrement"), "FAILED") << bare.log;
  const DeckRun sound(
      machine(linear("3e7", "3e7", "2e4", "2e4"), api("\"7000 rpm\", \"9000 rpm\"")));
  EXPECT_EQ(result_of(sound, "log decrement"), "passed") << sound.log;
}

// Nine discs: the order 8.7 meets the eighth mode, six are asked for by default.
TEST(ApiVerdicts, TorsionalModesAreJudgedAsFarAsExcitationsReach) {
  std::string rows, disks;
  for (int k = 0; k < 9; ++k) {
    rows += fmt::format("{}[\"s{}\", 150, 60]", k ? ", " : "", k);
    disks += fmt::format(
        "[[disk]]\nname = \"d{}\"\nat = \"s{}:start\"\nmass = \"20 kg\"\nIp = \"{:.2f} kg.m^2\"\n",
        k, k, 0.30 + 0.02 * k);
  }
  const std::string deck =
      "format = 1\n[output]\nreport = false\n[shaft]\nname = \"R\"\nmaterial = "
      "\"steel\"\ncolumns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [" +
      rows + "]\n" + disks +
      "[[bearing]]\nat = \"s0:end\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", "
      "\"z\"]\n[[bearing]]\nat = \"s8:end\"\ntype = \"rigid\"\ndirections = [\"y\", "
      "\"z\"]\n[[step]]\nname = \"api\"\ntype = \"api_torsional\"\noperating_speed = "
      "[\"2900 rpm\", \"3100 rpm\"]\norders = [8.7]\n";
  const DeckRun r(deck);
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(r.summary("api").at("failed").number(), 2) << r.log;
  const whirl::io::Value summary = r.summary("api");
  const auto& modes = summary.at("frequencies [Hz]").items();
  ASSERT_GE(modes.size(), 8u);
  EXPECT_NEAR(modes[7].number(), 434.88, 0.05);
}

// A motor whose torque rises by 2.86 N m s/rad drives the torsion of the train: 1/2 2.86/0.1 = 14.3 1/s but for
// what the other disk takes.
TEST(ApiVerdicts, TorsionThatGrowsFails) {
  const auto deck = [](const std::string& rows) {
    return R"(format = 1
[output]
report = false
[shaft]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 30], ["b", 500, 30]]
[[disk]]
name = "m"
at = "a:start"
mass = "20 kg"
Ip = "0.1 kg.m^2"
[[disk]]
name = "l"
at = "b:end"
mass = "20 kg"
Ip = "2 kg.m^2"
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "b:end"
type = "rigid"
directions = ["y", "z"]
[[drive]]
name = "motor"
at = "m"
type = "torque"
columns = ["speed[rpm]", "torque[N.m]"]
rows = )" + rows +
           R"(
[[drive]]
name = "load"
at = "l"
type = "torque"
torque = "-130 N.m"
[[step]]
name = "api"
type = "api_torsional"
operating_speed = ["950 rpm", "1000 rpm"]
)";
  };
  const DeckRun grows(deck("[[0, 100], [900, 100], [1100, 160], [2000, 160]]"));
  ASSERT_EQ(grows.exit, 0) << grows.log;
  EXPECT_EQ(result_of(grows, "torsional stability"), "FAILED") << grows.log;
  EXPECT_TRUE(grows.says("W13")) << grows.log;
  // a stretch between the ends and the middle of the operating speeds
  const DeckRun within(deck("[[0, 100], [955, 100], [965, 120], [2000, 120]]"));
  EXPECT_EQ(result_of(within, "torsional stability"), "FAILED") << within.log;
  const DeckRun decays(deck("[[0, 160], [900, 160], [1100, 100], [2000, 100]]"));
  EXPECT_EQ(result_of(decays, "torsional stability"), "") << decays.log;
  EXPECT_FALSE(decays.says("W13")) << decays.log;
}

// On unequal supports slow modes are nearly straight lines: of them, not of the first one that happens to be
// forward, the least stable one is judged.
TEST(ApiVerdicts, StraightLinesAreNoBackwardWhirl) {
  const DeckRun r(machine(linear("6e6", "6e8", "4e2", "2e5"),
                          seal("seal", "a:mid", "1e3") +
                              api("\"7200 rpm\", \"8000 rpm\"", "seals = [\"seal\"]\n" + stage)));
  ASSERT_EQ(r.exit, 0) << r.log;
  const whirl::io::Value summary = r.summary("api");
  for (const whirl::io::Value& c : summary.at("compliance").items()) {
    if (c.at("check").text() != "level 2: log decrement") continue;
    EXPECT_NE(c.at("where").text().find("49.9"), std::string::npos) << r.log;
  }
}

// Negative stiffness between the bearings: the rotor leaves its place without a swing.
TEST(ApiVerdicts, WhatDivergesFails) {
  const DeckRun r(
      machine(linear("3e7", "3e7", "2e4", "2e4"),
              "[[bearing]]\nname = \"pull\"\nat = \"a:end\"\ntype = \"linear\"\nkyy = \"-9e7 "
              "N/m\"\nkzz = \"-9e7 N/m\"\n" +
                  api("\"7000 rpm\", \"9000 rpm\"", "bearings = [\"DE\", \"NDE\"]\n")));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(result_of(r, "log decrement"), "FAILED") << r.log;
}

// A rigid rotor has one node, which its conical mode tilts and does not move: the mode was lost, and with it
// every unbalance of a couple.
TEST(ApiVerdicts, CountTheConicalModeOfARigidRotor) {
  const DeckRun d(R"(format = 1
[output]
report = false
[[shaft]]
name = "rotor"
[[shaft.section]]
name = "body"
length = "1 m"
rigid = true
[[disk]]
at = "body:mid"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "2 kg.m^2"
[[bearing]]
at = "body:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "100 N.s/m"
czz = "100 N.s/m"
[[bearing]]
at = "body:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "100 N.s/m"
czz = "100 N.s/m"
[[probe]]
name = "P"
at = "body:start"
[[step]]
name = "api"
type = "api_lateral"
operating_speed = ["4500 rpm", "4600 rpm"]
points = 31
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("api_modes: 2 modes")) << d.log;
  EXPECT_TRUE(d.says("mode 2, P, peak at")) << d.log;
}

// A seal that drives whirl at 5000 rpm alone (numpy: + 55.8 1/s at 54.3 Hz): levels 1 and 2 look at the highest
// speed, 6400 rpm, and pass.
TEST(ApiVerdicts, GrowthWithinTheOperatingSpeedsFails) {
  const DeckRun r(whirl::test::sealed_rotor(
      5000,
      "[100, 1e6, 1e6, 4e5, -4e5, 2000, 2000], [4000, 1e6, 1e6, 4e5, -4e5, 2000, 2000], "
      "[5000, 1e6, 1e6, 6e6, -6e6, 2000, 2000], [6000, 1e6, 1e6, 6e5, -6e5, 2000, 2000], "
      "[9000, 1e6, 1e6, 6e5, -6e5, 2000, 2000]",
      api("\"4500 rpm\", \"6400 rpm\"",
          "bearings = [\"A\", \"B\"]\nseals = [\"seal\"]\npoints = 31\n")));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(result_of(r, "level 2: log decrement"), "passed");
  EXPECT_EQ(result_of(r, "growth in operation"), "FAILED");
  EXPECT_TRUE(r.says("is unstable at 5000 rpm (lateral motion at 54.3")) << r.log;
}

// By Floquet's exponents of a model of its own: + 9.7 1/s at 7000 rpm. The mean stiffness has no growth.
TEST(ApiVerdicts, AnAsymmetricRotorThatGrowsFails) {
  const DeckRun r(
      whirl::test::flat_rotor(2, 1, 60,
                              api("\"6900 rpm\", \"7150 rpm\"",
                                  "points = 21\nresponse_speed = [\"3500 rpm\", \"9400 rpm\"]\n")));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(result_of(r, "log decrement"), "passed");
  EXPECT_EQ(result_of(r, "growth in operation"), "FAILED");
}

// The weight shakes a flat rotor at twice its speed: 7.94 mm at its weight critical speed, 1117 rpm, where once
// per turn it moves by micrometres.
TEST(ApiVerdicts, VibrationAtTwiceTheSpeedCounts) {
  const DeckRun r(
      whirl::test::flat_rotor(4, 2, 2000, api("\"1050 rpm\", \"1180 rpm\"", "points = 21\n")));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_EQ(result_of(r, "vibration at probes"), "FAILED");
  const whirl::io::Value summary = r.summary("api");
  for (const whirl::io::Value& c : summary.at("compliance").items())
    if (c.at("check").text() == "vibration at probes") {
      EXPECT_NEAR(c.at("value").number(), 15880, 60);
    }
}

// Journals resist tilting: the undamped modes have it as critical speeds have. Without it they are 2766.5 and
// 14807 rpm, and the unbalance of the first 30 % too large.
TEST(ApiVerdicts, UndampedModesHaveTheTiltingStiffnessOfJournals) {
  const std::string journal = R"(type = "linear"
kyy = "3e7 N/m"
kzz = "3e7 N/m"
krr = "2e6 N.m/rad"
cyy = "3000 N.s/m"
czz = "3000 N.s/m"
)";
  const DeckRun r(R"(format = 1
[output]
report = false
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 600, 60], ["over", 350, 60]]
[[disk]]
name = "impeller"
at = "over:end"
mass = "30 kg"
Ip = "0.6 kg.m^2"
Id = "0.33 kg.m^2"
[[bearing]]
name = "DE"
at = "left:start"
kxx = "1e8 N/m"
)" + journal + R"([[bearing]]
name = "NDE"
at = "left:end"
)" + journal + R"([[probe]]
name = "p"
at = "left:mid"
[[step]]
name = "c"
type = "critical_speeds"
max_speed = "20000 rpm"
motion = "lateral"
)" + api("\"3000 rpm\", \"6000 rpm\"", "modes = [1, 2]\npoints = 21\n"));
  ASSERT_EQ(r.exit, 0) << r.log;
  const auto modes = r.csv("api_modes_unbalance.csv");
  const auto criticals = r.csv("c_undamped.csv");
  ASSERT_EQ(modes.rows.size(), 2u);
  for (const auto& mode : modes.rows) {
    const double speed = mode[modes.column("critical speed [rpm]")];
    double nearest = 1.0;
    for (const auto& row : criticals.rows)
      nearest = std::min(nearest, std::abs(row[criticals.column("speed [rpm]")] / speed - 1.0));
    EXPECT_LT(nearest, 1e-6) << speed << r.log;
  }
  EXPECT_NEAR(modes.rows[0][modes.column("critical speed [rpm]")], 3912.88, 0.5);
}
