// The speed a step gives is the one it is solved at, whatever drives prescribe; what drives hold
// there is said.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

const std::string film = R"(type = "short_journal"
diameter = "50 mm"
length = "20 mm"
clearance = "50 um"
viscosity = "20 mPa.s"
)";

/// A disk of 40 kg between two short journal bearings. drive: what follows at and type.
std::string rotor(const std::string& drive, const std::string& steps) {
  return R"(format = 1
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 50], ["b", 500, 50]]
[[disk]]
at = "a:end"
mass = "40 kg"
Ip = "0.5 kg.m^2"
[[bearing]]
name = "j1"
at = "a:start"
)" + film +
         "[[bearing]]\nname = \"j2\"\nat = \"b:end\"\n" + film + R"([[bearing]]
name = "thrust"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
)" + (drive.empty() ? "" : "[[drive]]\nname = \"motor\"\nat = \"b:end\"\n" + drive + "\n") +
         steps + "[output]\nreport = false\n";
}

double eccentricity(const DeckRun& d, const std::string& file, std::size_t row) {
  const Columns c = d.csv(file);
  return c.rows.at(row).at(c.column("eccentricity / clearance [-]"));
}

const std::string smooth =
    "type = \"speed\"\nspeed = { type = \"smooth\", time = [\"0 s\", \"1 s\"], value = [\"1000 "
    "rpm\", \"9000 rpm\"] }";
const std::string sag = "[[step]]\nname = \"sag\"\ntype = \"static\"\nspeed = \"9000 rpm\"\n";

}  // namespace

TEST(StepSpeeds, OfAnEquilibriumUnderEveryDrive) {
  // e/c at 9000 rpm: that of the short bearing under half the weight, without a drive
  const DeckRun none(rotor("", sag));
  ASSERT_EQ(none.exit, 0) << none.log;
  const double e = eccentricity(none, "sag_coefficients.csv", 0);
  EXPECT_NEAR(e, 0.207, 5e-4);
  for (const std::string& drive :
       {smooth, std::string("type = \"speed\"\nspeed = \"1000 rpm\""),
        std::string("type = \"angle\"\nangle = { type = \"polynomial\", coefficients = [\"0 rad\", "
                    "\"100 rad/s\"] }"),
        std::string("type = \"torque\"\ntorque = \"1 N.m\""),
        std::string("type = \"torque\"\ngovernor = { target = \"2000 rpm\", kp = \"0.01 "
                    "N.m.s/rad\", ki = \"0.01 N.m/rad\" }")}) {
    SCOPED_TRACE(drive);
    const DeckRun d(rotor(drive, sag + "[[step]]\nname = \"many\"\ntype = \"static\"\nspeeds = { "
                                       "values = [\"3000 rpm\", \"9000 rpm\"] }\n"));
    ASSERT_EQ(d.exit, 0) << d.log;
    // the torques twist the shaft by 1e-5 rad and leave the films alone
    EXPECT_NEAR(eccentricity(d, "sag_coefficients.csv", 0), e, 1e-6);
    EXPECT_NEAR(eccentricity(d, "many_coefficients.csv", 2), e, 1e-6);
    EXPECT_NEAR(d.summary("sag").at("speed [rpm]").number(), 9000.0, 1e-9);
  }
}

TEST(StepSpeeds, OfModesUnderADrive) {
  // The whirl frequencies at 9000 rpm hang on the films there: the same without a drive and under
  // one that would turn at 1000 rpm.
  const std::string modes =
      "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 4\nspeed = \"9000 rpm\"\nmotion = "
      "\"lateral\"\n";
  std::vector<double> frequencies[2];
  for (int k = 0; k < 2; ++k) {
    const DeckRun d(rotor(k == 0 ? "" : smooth, modes));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns c = d.csv("m_modes.csv");
    for (const auto& row : c.rows)
      frequencies[k].push_back(row.at(c.column("frequency [Hz]")));
  }
  ASSERT_EQ(frequencies[0].size(), 4u);
  ASSERT_EQ(frequencies[1].size(), 4u);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(frequencies[1][k], frequencies[0][k], 1e-6 * frequencies[0][k]) << k;
}

TEST(StepSpeeds, NoneGivenIsThatOfTheDrive) {
  const DeckRun d(rotor(smooth, "[[step]]\nname = \"sag\"\ntype = \"static\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(d.summary("sag").at("speed [rpm]").number(), 1000.0, 1e-9);
  EXPECT_NEAR(eccentricity(d, "sag_coefficients.csv", 0), 0.641, 1e-3);
}

TEST(StepSpeeds, StartingFromAnotherEquilibriumItIsTheNewOne) {
  const DeckRun d(rotor(
      "",
      sag +
          "[[step]]\nname = \"slow\"\ntype = \"static\"\nfrom = \"sag\"\nspeed = \"1000 rpm\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(eccentricity(d, "slow_coefficients.csv", 0), 0.641, 1e-3);
}

TEST(StepSpeeds, OfShaftsWithSpeedRatios) {
  // A second rotor of the same kind at twice the speed, and a drive on it: at 4500 rpm of the
  // reference its films run as at 9000 rpm.
  const std::string second = R"([[shaft]]
name = "two"
origin = ["0 mm", "1 m", "0 mm"]
speed_ratio = 2
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["c", 500, 50], ["d", 500, 50]]
[[disk]]
at = "two/c:end"
mass = "40 kg"
Ip = "0.5 kg.m^2"
[[bearing]]
name = "k1"
at = "two/c:start"
)" + film + "[[bearing]]\nname = \"k2\"\nat = \"two/d:end\"\n" +
                             film + R"([[bearing]]
at = "two/c:start"
type = "linear"
kxx = "1e8 N/m"
[[drive]]
at = "two/d:end"
type = "speed"
speed = "700 rpm"
)";
  std::string deck =
      rotor("", second + "[[step]]\nname = \"sag\"\ntype = \"static\"\nspeed = \"4500 rpm\"\n");
  for (const char* place : {"a:", "b:"})
    for (std::size_t p = deck.find(std::string("at = \"") + place); p != std::string::npos;
         p = deck.find(std::string("at = \"") + place, p))
      deck.insert(p + 6, "r/");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(d.summary("sag").at("speed [rpm]").number(), 4500.0, 1e-9);
  const Columns c = d.csv("sag_coefficients.csv");
  ASSERT_EQ(c.rows.size(), 4u);
  const std::size_t speed = c.column("speed [rpm]"), e = c.column("eccentricity / clearance [-]");
  EXPECT_NEAR(c.rows[0][speed], 4500.0, 1e-6);
  EXPECT_NEAR(c.rows[2][speed], 9000.0, 1e-6);
  EXPECT_NEAR(c.rows[2][e], 0.207, 5e-4);
  EXPECT_GT(c.rows[0][e], 0.3);
}

TEST(StepSpeeds, AReferenceAtRestLeavesTheOthersTheirSpins) {
  // The first shaft stands, the second turns: its film carries.
  const std::string deck = R"(format = 1
[[shaft]]
name = "still"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["p", 500, 50]]
[[shaft]]
name = "turning"
initial_spin = "9000 rpm"
origin = ["0 mm", "1 m", "0 mm"]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 50], ["b", 500, 50]]
[[bearing]]
at = "still/p:start"
type = "rigid"
directions = ["x", "y", "z", "rx"]
[[bearing]]
at = "still/p:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
at = "turning/a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "film"
at = "turning/b:end"
)" + film + R"([[step]]
name = "go"
type = "transient"
duration = "1 ms"
[output]
report = false
)";
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns c = d.csv("go.csv");
  EXPECT_NEAR(c.rows.front().at(c.column("speed turning [rpm]")), 9000.0, 1e-6);
  EXPECT_NEAR(c.rows.front().at(c.column("speed still [rpm]")), 0.0, 1e-9);
}

TEST(StepSpeeds, AContradictionOfTheDriveIsAnError) {
  const std::string up = "[[step]]\nname = \"up\"\ntype = \"transient\"\nduration = \"1 ms\"\n";
  const DeckRun given(rotor(smooth, up + "initial_speed = \"3000 rpm\"\n"));
  EXPECT_EQ(given.exit, 3) << given.log;
  EXPECT_TRUE(given.says("begins at 3000 rpm, but drive 'motor' prescribes 1000 rpm at time 0"))
      << given.log;
  const DeckRun from(rotor(smooth, sag + up + "from = \"sag\"\n"));
  EXPECT_EQ(from.exit, 0) << from.log;
  EXPECT_TRUE(
      from.says("drive 'motor' prescribes 1000 rpm at t = 0 s, where shaft 'r' turns at 9000 rpm: "
                "its speed jumps"))
      << from.log;
  const DeckRun agrees(rotor(smooth, sag + up + "initial_speed = \"1000 rpm\"\n"));
  EXPECT_EQ(agrees.exit, 0) << agrees.log;
}

TEST(StepSpeeds, WhatADriveHoldsIsSaid) {
  const DeckRun d(rotor(smooth, R"([[step]]
name = "m"
type = "modal"
speed = "9000 rpm"
[[step]]
name = "bending"
type = "modal"
speed = "9000 rpm"
motion = "lateral"
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("W06")) << d.log;
  EXPECT_FALSE(d.says("without effect")) << d.log;
  EXPECT_TRUE(d.says("held: twist of shaft 'r' at b:end: drive 'motor' prescribes its angle"))
      << d.log;
  const io::Value held = d.summary("m").at("held");
  ASSERT_EQ(held.items().size(), 1u);
  EXPECT_EQ(held.items()[0].text(),
            "twist of shaft 'r' at b:end: drive 'motor' prescribes its angle (the speed is that of "
            "the step)");
  EXPECT_EQ(d.summary("bending").at("held").items().size(), 2u);
  // of one step alone
  const DeckRun one(rotor(smooth + "\nstep = \"m\"\n", R"([[step]]
name = "m"
type = "modal"
speed = "9000 rpm"
[[step]]
name = "free"
type = "modal"
speed = "9000 rpm"
)"));
  ASSERT_EQ(one.exit, 0) << one.log;
  EXPECT_EQ(one.summary("m").at("held").items().size(), 1u);
  EXPECT_TRUE(one.says("m: held")) << one.log;
  EXPECT_FALSE(one.says("free: held")) << one.log;
}

TEST(StepSpeeds, WhatNothingHoldsIsSaid) {
  // no thrust bearing, a casing that nothing keeps from turning, and an equilibrium that holds the
  // angle of the shaft
  const DeckRun d(R"(format = 1
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 50]]
[[shaft]]
name = "case"
rotating = false
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "id[mm]"]
rows = [["c", 500, 150, 120]]
[[bearing]]
at = "r/a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "r/a:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
at = "case/c:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "case/c:end"
type = "rigid"
directions = ["y", "z"]
[[step]]
name = "s"
type = "static"
[output]
report = false
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::string all = io::to_json(d.summary("s").at("held"));
  EXPECT_NE(all.find("turning of casing 'case' about its axis: held at its left end"),
            std::string::npos)
      << all;
  EXPECT_NE(all.find("nothing else holds the turning of shaft 'r'"), std::string::npos) << all;
}

TEST(StepSpeeds, RunTimesAreNamed) {
  const DeckRun d(rotor(
      "", sag + "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"9000 rpm\"\n[[step]]\nname = "
                "\"t\"\ntype = \"transient\"\nduration = \"1 ms\"\nfrom = \"sag\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  for (const char* step : {"sag", "m", "t"}) {
    const io::Value s = d.summary(step);
    EXPECT_TRUE(s.at("run time, CPU [s]").is_number()) << step;
    EXPECT_TRUE(s.at("run time, wall [s]").is_number()) << step;
    EXPECT_TRUE(s.at("run time [s]").is_null()) << step;
    const std::size_t line = d.log.find(std::string(step) + ": ");
    ASSERT_NE(line, std::string::npos) << step;
  }
  const io::Value whole = d.summary();
  for (const char* key : {"run time, CPU [s]", "run time, wall [s]", "run time by phase, CPU [s]",
                          "run time by phase, wall [s]"})
    EXPECT_FALSE(whole.at(key).is_null()) << key;
  std::size_t said = 0;
  for (std::size_t p = d.log.find(" s CPU, "); p != std::string::npos;
       p = d.log.find(" s CPU, ", p + 1))
    ++said;
  EXPECT_EQ(said, 3u) << d.log;
}
