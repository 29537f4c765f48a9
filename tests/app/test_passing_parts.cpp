// Stiffness that changes as teeth and rolling elements pass, or as magnets are switched: linear steps take
// what it is in the mean, and look at what the change does, or refuse.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <cmath>

using whirl::test::DeckRun;

namespace {

/// A rigid rotor of 20 kg on supports at both ends; `law`: their kind.
std::string passing_rotor(const std::string& law, const std::string& steps) {
  const auto support = [&](const char* name, const char* at) {
    return fmt::format("[[bearing]]\nname = \"{}\"\nat = \"body:{}\"\n{}", name, at, law);
  };
  return "format = 1\n[shaft]\nname = \"rotor\"\n[[shaft.section]]\nname = \"body\"\nlength = \"1 "
         "m\"\nrigid = true\n[[disk]]\nat = \"body:mid\"\nmass = \"20 kg\"\nIp = \"0.2 "
         "kg.m^2\"\nId = \"3 kg.m^2\"\n" +
         support("A", "start") + support("B", "end") +
         "[[bearing]]\nat = \"body:end\"\ntype = \"linear\"\nkxx = \"1e8 N/m\"\ncxx = \"1e3 "
         "N.s/m\"\n" +
         steps;
}

const std::string ball_bearing = R"(type = "ball"
balls = 6
ball_diameter = "12 mm"
pitch_diameter = "60 mm"
clearance = "6 um"
stiffness = "8e9 N/m^1.5"
c_radial = "50 N.s/m"
)";

/// Two rigid rotors on stiff supports, geared.
std::string passing_gears(const std::string& harmonics, const std::string& steps) {
  const auto line = [](const char* name, const char* more, const char* disk) {
    return fmt::format(
        "[[shaft]]\nname = \"{0}\"\n{1}[[shaft.section]]\nname = \"body\"\nlength = \"200 "
        "mm\"\nrigid = true\n[[disk]]\nat = \"{0}/body:mid\"\n{2}[[bearing]]\nat = "
        "\"{0}/body:mid\"\ntype = \"linear\"\nkxx = \"1e9 N/m\"\nkyy = \"1e10 N/m\"\nkzz = \"1e10 "
        "N/m\"\nkrr = \"1e9 N.m/rad\"\ncxx = \"1e5 N.s/m\"\ncyy = \"1e5 N.s/m\"\nczz = \"1e5 "
        "N.s/m\"\ncrr = \"1e4 N.m.s/rad\"\n",
        name, more, disk);
  };
  return "format = 1\n[model]\ngravity = \"0 m/s^2\"\n" +
         line("pinion", "", "mass = \"5 kg\"\nIp = \"0.01 kg.m^2\"\nId = \"0.02 kg.m^2\"\n") +
         line("wheel", "origin = [\"0 m\", \"150 mm\", \"0 m\"]\nspeed_ratio = -0.5\n",
              "mass = \"15 kg\"\nIp = \"0.08 kg.m^2\"\nId = \"0.1 kg.m^2\"\n") +
         "[[bearing]]\nname = \"mesh\"\nat = \"pinion/body:mid\"\nto = "
         "\"wheel/body:mid\"\ntype = \"gear\"\nteeth = 40\nother_teeth = 80\npitch_diameter = "
         "\"100 mm\"\nstiffness = \"1e8 N/m\"\ndamping = \"200 N.s/m\"\n" +
         harmonics + steps;
}

const std::string steps_of_stability =
    "[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = { start = \"2000 rpm\", stop = "
    "\"3500 rpm\", points = 4 }\n";
const std::string step_of_small_motions =
    "[[step]]\nname = \"t\"\ntype = \"transient\"\nlinear = true\nstart = \"static\"\n"
    "initial_speed = \"3000 rpm\"\nduration = \"10 ms\"\n";

}  // namespace

// The teeth pass at twice the frequency w of the torsional mode (906.5 Hz) at 2719.6 rpm, where stiffness that
// varies by 0.3 of itself makes it grow by 0.3 w/4 less what damping takes, 35.2 1/s (Mathieu). Supports a
// hundred times as stiff as the mesh take 2 % of its share.
TEST(PassingParts, TeethMakeATorsionalModeGrow) {
  const DeckRun varying(passing_gears("stiffness_harmonics = [0.3]\n", steps_of_stability));
  ASSERT_EQ(varying.exit, 0) << varying.log;
  EXPECT_TRUE(varying.says("W14")) << varying.log;
  EXPECT_TRUE(varying.says("of the mean stiffness of gear pair 'mesh'")) << varying.log;
  const whirl::io::Value s = varying.summary("s");
  EXPECT_FALSE(s.at("certified").boolean());
  ASSERT_FALSE(s.at("growth by what passes").items().empty());
  const whirl::io::Value& most = s.at("growth by what passes").items().front();
  const double w = 2 * M_PI * most.at("first frequency [Hz]").number();
  EXPECT_NEAR(most.at("speed [rpm]").number(), 2 * w / 40 * 30 / M_PI, 0.1);
  EXPECT_NEAR(most.at("growth [1/s]").number(), 0.3 * w / 4 - 35.2, 0.03 * w * 0.3 / 4);
  const DeckRun constant(passing_gears("", steps_of_stability));
  ASSERT_EQ(constant.exit, 0) << constant.log;
  EXPECT_FALSE(constant.says("W14")) << constant.log;
  EXPECT_TRUE(constant.summary("s").at("certified").boolean());
}

// A little variation is less than what damping takes: a/4 w = 35.2 at a = 0.025.
TEST(PassingParts, DampingHoldsSmallVariations) {
  const DeckRun small(passing_gears("stiffness_harmonics = [0.02]\n", steps_of_stability));
  ASSERT_EQ(small.exit, 0) << small.log;
  EXPECT_TRUE(small.says("to first order nothing grows by what passes")) << small.log;
  EXPECT_TRUE(small.summary("s").at("growth by what passes").items().empty());
}

// Six balls that pass at twice the frequency of the vertical mode, 148.6 Hz, at 7432 rpm: by shooting and
// Floquet's multipliers of the two equations of motion, 224 1/s at 7000 rpm and none at 6000 rpm.
TEST(PassingParts, RollingElementsMakeARotorGrow) {
  const DeckRun passing(
      passing_rotor(ball_bearing,
                    "[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = { start = \"1000 "
                    "rpm\", stop = \"8000 rpm\", points = 8 }\n"));
  ASSERT_EQ(passing.exit, 0) << passing.log;
  EXPECT_TRUE(passing.says("of the mean stiffness of bearing 'A', bearing 'B'")) << passing.log;
  const whirl::io::Value s = passing.summary("s");
  EXPECT_FALSE(s.at("certified").boolean());
  ASSERT_FALSE(s.at("growth by what passes").items().empty());
  const whirl::io::Value& most = s.at("growth by what passes").items().front();
  EXPECT_GT(most.at("growth [1/s]").number(), 50);
  EXPECT_GT(most.at("speed [rpm]").number(), 6500);
}

TEST(PassingParts, AreNoSmallMotions) {
  const DeckRun teeth(passing_gears("stiffness_harmonics = [0.3]\n", step_of_small_motions));
  EXPECT_EQ(teeth.exit, 3) << teeth.log;
  EXPECT_TRUE(teeth.says("the stiffness of gear pair 'mesh' changes as its teeth pass"))
      << teeth.log;
  const DeckRun passing(passing_rotor(ball_bearing, step_of_small_motions));
  EXPECT_EQ(passing.exit, 3) << passing.log;
  EXPECT_TRUE(passing.says("the stiffness of bearing 'A' changes as its rolling elements pass"))
      << passing.log;
}

// A law of the power that changes before the step begins is a constant one in it.
TEST(PassingParts, MagnetsThatAreSwitchedAreNoSmallMotions) {
  const std::string magnets = R"(type = "magnetic"
current_stiffness = "200 N/A"
position_stiffness = "1e6 N/m"
amplifier_bandwidth = "2000 Hz"
control = [{ type = "pid", p = "3e4 A/m", d = "60 A.s/m", lag = "50 us" }]
power = { type = "smooth", time = ["1 ms", "5 ms"], value = [0.5, 1] }
)";
  const DeckRun switched(passing_rotor(magnets, step_of_small_motions));
  EXPECT_EQ(switched.exit, 3) << switched.log;
  EXPECT_TRUE(switched.says("the power of magnetic bearing 'A' changes")) << switched.log;
  const DeckRun before(passing_rotor(magnets,
                                     "[[step]]\nname = \"first\"\ntype = \"transient\"\nstart = "
                                     "\"rest\"\nduration = \"10 ms\"\n[[step]]\nname = "
                                     "\"t\"\ntype = \"transient\"\nfrom = \"first\"\nlinear = "
                                     "true\nduration = \"10 ms\"\n"));
  EXPECT_EQ(before.exit, 0) << before.log;
}

// A thrust of a tenth of Euler's load, in a step that keeps the stiffness of the start: frequencies go
// with sqrt(1 - N/N_E), to first order by N/(2 N_E).
TEST(PassingParts, LoadsThatStiffenShaftsAreSaid) {
  const auto deck = [](const char* force) {
    return fmt::format(
        "format = 1\n[model]\ngravity = \"0 m/s^2\"\n[shaft]\nname = \"rotor\"\nmaterial = "
        "\"steel\"\ncolumns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"body\", 1000, "
        "40]]\n[[bearing]]\nat = \"body:start\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", "
        "\"z\"]\n[[bearing]]\nat = \"body:end\"\ntype = \"rigid\"\ndirections = [\"y\", "
        "\"z\"]\n[[load]]\nname = \"thrust\"\nat = \"body:end\"\nforce = {}\nfactor = {{ type = "
        "\"smooth\", time = [\"1 ms\", \"5 ms\"], value = [0, 1] }}\n[[step]]\nname = "
        "\"t\"\ntype = \"transient\"\nlinear = true\ninitial_speed = \"3000 rpm\"\nduration = "
        "\"10 ms\"\n",
        force);
  };
  // N_E = pi^2 E I/L^2 = 260 kN
  const DeckRun thrust(deck("[\"-26 kN\", \"0 N\", \"0 N\"]"));
  ASSERT_EQ(thrust.exit, 0) << thrust.log;
  EXPECT_TRUE(thrust.says("load 'thrust' as it is at t = 0.005 s moves the natural frequency at"))
      << thrust.log;
  EXPECT_TRUE(thrust.says("by 5 % (to first order)") || thrust.says("by 5.1 % (to first order)"))
      << thrust.log;
  const DeckRun across(deck("[\"0 N\", \"100 N\", \"0 N\"]"));
  ASSERT_EQ(across.exit, 0) << across.log;
  EXPECT_FALSE(across.says("keeps the stiffness of the start")) << across.log;
}

// What changes the speed in no time stands in no column.
TEST(PrescribedSpeeds, ThatJumpAreSaid) {
  const auto deck = [](const char* speed) {
    return fmt::format(
        "format = 1\n[shaft]\nname = \"rotor\"\n[[shaft.section]]\nname = \"body\"\nlength = "
        "\"1 m\"\nrigid = true\n[[disk]]\nat = \"body:mid\"\nmass = \"20 kg\"\nIp = \"0.2 "
        "kg.m^2\"\n[[bearing]]\nat = \"body:mid\"\ntype = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = "
        "\"1e6 N/m\"\nkzz = \"1e6 N/m\"\nkrr = \"1e6 N.m/rad\"\n[[drive]]\nname = \"motor\"\nat "
        "= \"body:start\"\ntype = \"speed\"\nspeed = {}\n[[step]]\nname = \"t\"\ntype = "
        "\"transient\"\nduration = \"20 ms\"\n",
        speed);
  };
  const DeckRun jumps(deck(
      "{ type = \"piecewise\", pieces = [{ start = \"0 s\", law = \"1000 rpm\" }, { start = \"10 "
      "ms\", law = \"2000 rpm\" }] }"));
  ASSERT_EQ(jumps.exit, 0) << jumps.log;
  EXPECT_TRUE(jumps.says("the speed of drive 'motor' jumps by 1000 rpm at t = 0.01 s"))
      << jumps.log;
  const DeckRun ramp(
      deck("{ type = \"ramp\", time = [\"5 ms\", \"10 ms\"], value = [\"1000 rpm\", \"2000 "
           "rpm\"] }"));
  ASSERT_EQ(ramp.exit, 0) << ramp.log;
  EXPECT_FALSE(ramp.says("jumps by")) << ramp.log;
}
