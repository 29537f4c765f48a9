// Alarms of responses and stability of rotors whose stiffness turns with them, of those stable at high
// speed only, of lobed films; places and unbalances that could be mistaken.
#include "deck_run.hpp"

#include <fmt/format.h>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

const std::string probe_at_disk = "[[probe]]\nname = \"p\"\nat = \"a:mid\"\n";
const std::string small_unbalance = "[[unbalance]]\nat = \"a:mid\"\namount = \"200 g.mm\"\n";

/// 25 kg amid a shaft whose second moments are 1.4 % apart, damping ratio 0.7 %: no band is left of the
/// parametric instability, since the split of the stiffness is below twice that.
std::string two_pole(const std::string& parts) {
  return R"(format = 1
[shaft]
name = "r"
material = "steel"
[[shaft.section]]
name = "a"
length = "1200 mm"
min_elements = 12
[shaft.section.general]
A = "2827 mm^2"
Iy = "645000 mm^4"
Iz = "636000 mm^4"
J = "1270000 mm^4"
kappa_y = 0.89
kappa_z = 0.89
[shaft.damping]
rayleigh_alpha = "8 1/s"
[[disk]]
name = "imp"
at = "a:mid"
mass = "25 kg"
Ip = "0.2 kg.m^2"
Id = "0.11 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "2e4 N.s/m"
czz = "2e4 N.s/m"
[[bearing]]
name = "B"
at = "a:end"
type = "linear"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "2e4 N.s/m"
czz = "2e4 N.s/m"
[output]
report = false
)" + probe_at_disk +
         small_unbalance + parts;
}

const std::string response_about_the_critical =
    "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n"
    "speed = { start = \"2800 rpm\", stop = \"3000 rpm\", points = 41 }\n";
const std::string cross_coupled =
    "[[bearing]]\nname = \"stage\"\nat = \"imp\"\ntype = \"cross_coupling\"\nk = \"4e5 N/m\"\n";

}  // namespace

TEST(GrowthAlarms, AnUnroundRotorThatDampingHoldsRaisesNone) {
  const DeckRun d(two_pole(response_about_the_critical));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("unstable")) << d.log;
}

TEST(GrowthAlarms, AnUnroundRotorThatASealDrivesRaisesOne) {
  const DeckRun d(two_pole(cross_coupled + response_about_the_critical));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("unstable from below 2800 to above 3000 rpm")) << d.log;
}

// A stage drives whirl that the seal's damping holds at high speed only: growth 5.4 1/s at 1000 rpm.
TEST(GrowthAlarms, TheFirstSpeedIsJudged) {
  const DeckRun d(R"(format = 1
[shaft]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 1200, 60]]
[[disk]]
name = "imp"
at = "a:mid"
mass = "25 kg"
Ip = "0.2 kg.m^2"
Id = "0.11 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "2e3 N.s/m"
czz = "2e3 N.s/m"
[[bearing]]
name = "B"
at = "a:end"
type = "linear"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "2e3 N.s/m"
czz = "2e3 N.s/m"
[[bearing]]
name = "seal"
at = "imp"
type = "table"
columns = ["speed[rpm]", "kyy[N/m]", "kzz[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [[500, 1e5, 1e5, 200, 200], [2000, 2e5, 2e5, 400, 400], [3000, 4e5, 4e5, 1500, 1500], [6000, 1.2e6, 1.2e6, 4500, 4500]]
[[bearing]]
name = "stage"
at = "imp"
type = "cross_coupling"
k = "2e5 N/m"
[output]
report = false
)" + probe_at_disk +
                  small_unbalance +
                  R"([[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["1000 rpm", "3500 rpm", "5000 rpm", "6000 rpm"] }
[[step]]
name = "s"
type = "stability"
speed = { start = "1000 rpm", stop = "6000 rpm", points = 11 }
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("unstable at 1000 rpm")) << d.log;
  const double again = d.csv("s_onset.csv").last().at("speed [rpm]");
  EXPECT_NEAR(again, 2318, 1);
  EXPECT_TRUE(d.says(fmt::format("stable again above {:.8g} rpm", again))) << d.log;
}

// Unequal supports and an unround shaft without mass: Floquet's multipliers of the reduced equations have
// three bands; with three harmonics of Hill's equations the second and third were one, with growth where
// motions decay. The band in the middle is found though only its neighbours are asked for.
TEST(GrowthAlarms, BandsAreApartWithEnoughHarmonics) {
  const DeckRun d(R"(format = 1
[[material]]
name = "light"
E = "210 GPa"
G = "80 GPa"
density = "5 kg/m^3"
[shaft]
name = "r"
material = "light"
shear = "none"
[[shaft.section]]
name = "a"
length = "1000 mm"
min_elements = 2
[shaft.section.general]
A = "1256.6 mm^2"
Iy = "130000 mm^4"
Iz = "120000 mm^4"
J = "250000 mm^4"
kappa_y = 0.89
kappa_z = 0.89
[shaft.damping]
internal_beta = "2e-6 s"
[[disk]]
name = "d"
at = "a:mid"
mass = "20 kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e6 N/m"
kzz = "3e6 N/m"
cyy = "120 N.s/m"
czz = "120 N.s/m"
[[bearing]]
name = "B"
at = "a:end"
type = "linear"
kyy = "2e6 N/m"
kzz = "3e6 N/m"
cyy = "120 N.s/m"
czz = "120 N.s/m"
[output]
report = false
[[step]]
name = "stab"
type = "stability"
speed = { values = ["2050 rpm", "2085 rpm", "2110 rpm", "2157 rpm", "2180 rpm", "2210 rpm"] }
modes = 4
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns bands = d.csv("stab_bands.csv");
  ASSERT_EQ(bands.rows.size(), 3u) << d.log;
  const double edges[3][2] = {{2071, 2103}, {2117.5, 2150}, {2163, 2199}};  // to 2 rpm
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(bands.rows[k][0], edges[k][0], 2.0);
    EXPECT_NEAR(bands.rows[k][1], edges[k][1], 2.0);
  }
  EXPECT_NEAR(bands.rows[2][2], 1.79, 0.02);
}

// Two lobes of preload 0.7: beside their middles the bush is wider than its clearance as assembled, and a
// journal there at 1.16 times that has 65 um of film.
TEST(GrowthAlarms, ALobedBushIsWiderBesideItsLobes) {
  const auto bearing = [](const char* name, const char* at) {
    return fmt::format(R"([[bearing]]
name = "{}"
at = "{}"
type = "journal"
shape = "lobes"
lobes = 2
preload = 0.7
lobe_at = "-90 deg"
diameter = "120 mm"
length = "90 mm"
clearance = "0.3 mm"
iso_vg = 46
temperature = "50 degC"
)",
                       name, at);
  };
  const DeckRun d(R"(format = 1
[shaft]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 1000, 160]]
[[disk]]
name = "d"
at = "a:mid"
mass = "600 kg"
Ip = "20 kg.m^2"
Id = "15 kg.m^2"
[[bearing]]
name = "thrust"
at = "a:end"
type = "linear"
kxx = "1e8 N/m"
[[unbalance]]
at = "d"
amount = "15000 g.mm"
[output]
report = false
)" + bearing("B1", "a:start + 50 mm") +
                  bearing("B2", "a:end - 50 mm") + probe_at_disk +
                  "[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"3000 rpm\"\n"
                  "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n"
                  "speed = { values = [\"3000 rpm\"] }\n");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("believed")) << d.log;
  EXPECT_FALSE(d.says("from the middle of")) << d.log;
}

// ISO 21940-11: the residual unbalance of a place is a vector.
TEST(GrowthAlarms, UnbalancesOfAPlaceAddUpWithTheirAngles) {
  const std::string second =
      "[[unbalance]]\nat = \"a:mid\"\namount = \"200 g.mm\"\nphase = \"{} deg\"\n";
  const std::string step =
      "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n"
      "speed = { values = [\"2000 rpm\", \"2500 rpm\"] }\n"
      "balance_grade = \"G2.5\"\noperating_speed = [\"2000 rpm\", \"2500 rpm\"]\n";
  for (const auto& [angle, sum] : {std::pair{180, 0.0}, {90, 200 * std::sqrt(2.0)}, {0, 400.0}}) {
    const DeckRun d(two_pole(fmt::format(fmt::runtime(second), angle) + step));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_NEAR(d.csv("u_balance_grade.csv").last().at("unbalance [g mm]"), sum, 1e-9) << angle;
    EXPECT_EQ(d.says("the unbalances cancel"), sum == 0.0) << d.log;
    EXPECT_FALSE(d.says("W10")) << d.log;  // of rounding
  }
}

TEST(GrowthAlarms, ANameOfTwoPlacesIsAsked) {
  const auto deck = [](const std::string& at) {
    return R"(format = 1
[shaft]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["shaft", 500, 60], ["wheel", 500, 60]]
[[disk]]
name = "wheel"
at = "wheel:mid"
mass = "20 kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
name = "A"
at = "r:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e6 N/m"
kzz = "3e6 N/m"
[[bearing]]
name = "B"
at = "r:end"
type = "linear"
kyy = "2e6 N/m"
kzz = "3e6 N/m"
[output]
report = false
[[probe]]
name = "p"
at = ")" + at +
           "\"\n[[step]]\nname = \"s\"\ntype = \"static\"\n";
  };
  const DeckRun asked(deck("wheel"));
  EXPECT_EQ(asked.exit, 3);
  EXPECT_TRUE(asked.says("'wheel' is a section and a disk or bearing, at different places"))
      << asked.log;
  EXPECT_EQ(DeckRun(deck("wheel:start")).exit, 0);
  EXPECT_EQ(DeckRun(deck("wheel:mid")).exit, 0);
}

// What steps without time take of a load that changes with it is said.
TEST(GrowthAlarms, LoadsInTimeEnterAsTheyBegin) {
  const DeckRun d(two_pole(
      "[[load]]\nname = \"pulse\"\nat = \"imp\"\nforce = [\"0 N\", \"0 N\", \"-1000 N\"]\n"
      "factor = { type = \"harmonic\", amplitude = 1, frequency = \"20 Hz\", phase = \"90 deg\" }\n"
      "[[step]]\nname = \"s\"\ntype = \"static\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("load 'pulse' at its value at t = 0")) << d.log;
}

// A rotor that runs backwards under a cross-coupling is the mirror image of one under its negative.
TEST(GrowthAlarms, BandsOfARotorThatRunsBackwardsAreItsOwn) {
  const auto growth = [](const char* k, const char* speeds) {
    std::string deck =
        two_pole(fmt::format("[[bearing]]\nname = \"stage\"\nat = \"imp\"\n"
                             "type = \"cross_coupling\"\nk = \"{} N/m\"\n"
                             "[[step]]\nname = \"stab\"\ntype = \"stability\"\n"
                             "speed = {{ values = {} }}\nmodes = 4\n",
                             k, speeds));
    deck.insert(deck.find("rayleigh_alpha"), "internal_beta = \"2e-5 s\"\n");
    const DeckRun d(deck);
    EXPECT_EQ(d.exit, 0) << d.log;
    std::map<double, double> out;
    for (const auto& row : d.csv("stab_growth.csv").rows)
      out[std::round(std::abs(row[0]))] = row[1];
    return out;
  };
  const auto backwards = growth("6e4", R"(["-4000 rpm", "-1500 rpm"])");
  const auto mirrored = growth("-6e4", R"(["1500 rpm", "4000 rpm"])");
  for (const double rpm : {1500.0, 4000.0})
    EXPECT_NEAR(backwards.at(rpm), mirrored.at(rpm), 1e-6 * std::abs(mirrored.at(rpm))) << rpm;
  EXPECT_GT(std::abs(growth("6e4", R"(["1500 rpm", "4000 rpm"])").at(4000.0) - mirrored.at(4000.0)),
            0.1);
}

// A moment of fixed direction on an overhung impeller drives whirl that the same torque on the turning
// does not: the load is named.
TEST(GrowthAlarms, AMomentAlongAShaftIsNamedWhereMotionsGrow) {
  const auto deck = [](const std::string& torque) {
    return R"(format = 1
[shaft]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 400, 60], ["b", 300, 60]]
[[disk]]
name = "imp"
at = "b:end"
mass = "20 kg"
Ip = "0.6 kg.m^2"
Id = "0.35 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
[[bearing]]
name = "B"
at = "a:end"
type = "linear"
kyy = "1e8 N/m"
kzz = "1e8 N/m"
[[unbalance]]
at = "imp"
amount = "20 g.mm"
[[probe]]
name = "p"
at = "imp"
[output]
report = false
)" + torque +
           "[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 4\nspeed = \"1000 rpm\"\n"
           "[[step]]\nname = \"s\"\ntype = \"stability\"\nmodes = 4\n"
           "speed = { values = [\"1000 rpm\", \"1200 rpm\"] }\n"
           "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = [\"1000 "
           "rpm\"] }\n";
  };
  const DeckRun load(deck(
      "[[load]]\nname = \"process\"\nat = \"imp\"\nmoment = [\"2000 N.m\", \"0 N.m\", \"0 N.m\"]\n"
      "[[load]]\nname = \"motor\"\nat = \"a:start\"\n"
      "moment = [\"-2000 N.m\", \"0 N.m\", \"0 N.m\"]\n"));
  ASSERT_EQ(load.exit, 0) << load.log;
  EXPECT_TRUE(load.says("unstable")) << load.log;
  const std::string named =
      "load 'process', 'motor' twists a shaft by a moment that has no potential";
  EXPECT_TRUE(load.says("m: assumed: " + named)) << load.log;
  EXPECT_TRUE(load.says("s: assumed: " + named)) << load.log;
  EXPECT_TRUE(load.says("does there; " + named)) << load.log;
  const DeckRun drive(
      deck("[[drive]]\nat = \"imp\"\ntype = \"torque\"\ntorque = \"2000 N.m\"\n"
           "[[drive]]\nat = \"a:start\"\ntype = \"torque\"\ntorque = \"-2000 N.m\"\n"));
  ASSERT_EQ(drive.exit, 0) << drive.log;
  EXPECT_FALSE(drive.says("unstable")) << drive.log;
  EXPECT_FALSE(drive.says("no potential")) << drive.log;
}

// Geared to another shaft, an unround one turns with no step but a transient.
TEST(GrowthAlarms, AnUnroundGearedShaftIsSentToATransient) {
  std::string deck = two_pole(R"([[shaft]]
name = "wheel shaft"
material = "steel"
origin = ["0 mm", "200 mm", "0 mm"]
speed_ratio = -0.5
columns = ["name", "length[mm]", "od[mm]"]
rows = [["w", 1200, 80]]
[[disk]]
name = "wheel"
at = "w:mid"
mass = "60 kg"
Ip = "1.2 kg.m^2"
Id = "0.6 kg.m^2"
[[bearing]]
name = "C"
at = "w:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "D"
at = "w:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "g"
at = "a:mid"
to = "w:mid"
type = "gear"
teeth = 20
other_teeth = 40
pitch_diameter = "133.33 mm"
pressure_angle = "20 deg"
stiffness = "1e8 N/m"
drive = "positive"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["1000 rpm"] }
)");
  const std::string alone = "[shaft]";
  deck.replace(deck.find(alone), alone.size(), "[[shaft]]");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("as its mean over a revolution")) << d.log;
  EXPECT_TRUE(d.says("a transient turns with the shafts")) << d.log;
}
