// Reports after standards, number by number against hand calculations: a mass on springs, two discs
// on a bar without mass, vectors on paper.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <cmath>
#include <complex>

using namespace whirl;
using test::DeckRun;

namespace {

constexpr double m = 10, k = 1e6, c = 600;
double rad(double rpm) { return rpm * pi / 30; }

/// 10 kg on 1e6 N/m and 600 N s/m, a probe on it; the report over 4000 to 5000 rpm.
std::string lateral_report(const std::string& keys, const std::string& beside = "") {
  return test::lateral_mass(m, "9.80665 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "600 N.s/m"
czz = "600 N.s/m"
[[probe]]
name = "P"
at = "mass"
[output]
report = false
)" + beside + R"([[step]]
name = "l"
type = "api_lateral"
operating_speed = ["4000 rpm", "5000 rpm"]
)" + keys);
}

const char* const clearances = R"([step.clearances]
columns = ["name", "at", "diametral[mm]"]
rows = [["labyrinth", "mass", 0.3]]
)";
const char* const stages = R"([step.stages]
columns = ["name", "power[kW]", "speed[rpm]", "diameter[mm]", "width[mm]", "suction_density[kg/m^3]", "discharge_density[kg/m^3]"]
rows = [["1", 10, 1000, 350, 80, 1, 1.11], ["2", 10, 1000, 350, 80, 1, 1.14]]
)";

double unbalance() { return 2 * 6350e-6 * m / 4000; }  // the mode is at 3020 rpm: N = 4000 rpm
double response(double rpm) {
  const double w = rad(rpm);
  return unbalance() * w * w / std::abs(Complex(k - m * w * w, c * w));
}
/// Log decrement of the least stable root of m l^2 + c l + k -+ i q.
double log_decrement(double q) {
  double least = infinity;
  for (const double sign : {-1.0, 1.0})
    for (const double branch : {-1.0, 1.0}) {
      const Complex root =
          (-c + branch * std::sqrt(Complex(c * c - 4 * m * k, sign * 4 * m * q))) / (2 * m);
      if (root.imag() > 0) least = std::min(least, -2 * pi * root.real() / root.imag());
    }
  return least;
}

struct Row {
  std::string check, result;
  double value = whirl::nan, limit = whirl::nan;
};
std::vector<Row> compliance(const DeckRun& d, const std::string& step) {
  std::vector<Row> out;
  const io::Value of = d.summary(step);
  for (const io::Value& e : of.at("compliance").items()) {
    Row r{e.at("check").text(), e.at("result").text()};
    if (e.at("value").is_number()) r.value = e.at("value").number();
    if (e.at("limit").is_number()) r.limit = e.at("limit").number();
    out.push_back(std::move(r));
  }
  return out;
}

void expect(const Row& r, const char* check, double value, double limit, const char* result) {
  EXPECT_EQ(r.check, check);
  EXPECT_NEAR(r.value, value, 1e-6 * std::abs(value)) << check;
  EXPECT_NEAR(r.limit, limit, 1e-6 * std::abs(limit)) << check;
  EXPECT_EQ(r.result, result) << check;
}

constexpr double peak = 3047.302992474;  // w_n/sqrt(1 - 2 zeta^2), rpm
constexpr double amplification = 5.078092979906;
const double anticipated = 3 * 9.55 * 10000 * (1.11 + 1.14) / (1000 * 0.35 * 0.08);

}  // namespace

TEST(Reports, LateralNumbersAreThoseOfAMassOnSprings) {
  const DeckRun d(lateral_report(std::string(clearances) + stages));
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::vector<Row> rows = compliance(d, "l");
  ASSERT_EQ(rows.size(), 7u);
  expect(rows[0], "separation margin", 100 * (4000 - peak) / 4000,
         17 * (1 - 1 / (amplification - 1.5)), "passed");
  expect(rows[1], "vibration at probes", 2e6 * response(4000), 25.4, "passed");
  const double scale = 25.4e-6 / (2 * response(4000));
  expect(rows[2], "close clearances", 100 * scale * 2 * response(peak) / 0.3e-3, 75, "passed");
  EXPECT_EQ(rows[3].check, "critical speeds without a peak");
  EXPECT_EQ(rows[3].result, "for information");
  expect(rows[4], "level 1: log decrement", log_decrement(anticipated), 0.1, "passed");
  expect(rows[5], "level 1: Q0/QA", c * std::sqrt(k / m) / anticipated, 2, "passed");
  const io::Value parts = d.summary("l").at("parts"), told = parts.at("l_level_1");
  EXPECT_NEAR(parts.at("l_mode_1").at("scale factor").number(), scale, 1e-6 * scale);
  EXPECT_NEAR(told.at("anticipated cross-coupling QA [N/m]").number(), anticipated, 1e-6);
  EXPECT_NEAR(told.at("cross-coupling at the onset Q0 [N/m]").number(), c * std::sqrt(k / m), 0.1);
  EXPECT_NEAR(told.at("mean density [kg/m^3]").number(), (1 + 1.14) / 2, 1e-12);
  EXPECT_TRUE(d.says("7 checks")) << d.log;
  EXPECT_TRUE(d.says("close clearances")) << d.log;
}

TEST(Reports, LateralTables) {
  const DeckRun d(lateral_report(std::string(clearances) + stages));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto planes = d.csv("l_modes_unbalance.csv").last();
  EXPECT_NEAR(planes.at("critical speed [rpm]"), std::sqrt(k / m) * 30 / pi, 1e-6);
  EXPECT_NEAR(planes.at("place [m]"), 0.1, 1e-9);
  EXPECT_NEAR(planes.at("weight [kg]"), 10, 1e-6);
  EXPECT_NEAR(planes.at("speed [rpm]"), 4000, 1e-9);
  EXPECT_NEAR(planes.at("unbalance [g mm]"), 1e6 * unbalance(), 1e-6);
  EXPECT_EQ(planes.at("angle [deg]"), 0);
  EXPECT_EQ(planes.at("mode [-]"), 1);
  const auto margin = d.csv("l_mode_1_margins.csv").last();
  EXPECT_NEAR(margin.at("peak [rpm]"), peak, 1e-5);
  EXPECT_NEAR(margin.at("amplification factor [-]"), amplification, 1e-6);
  EXPECT_NEAR(margin.at("required [%]"), 17 * (1 - 1 / (amplification - 1.5)), 1e-6);
  EXPECT_NEAR(margin.at("actual [%]"), 100 * (4000 - peak) / 4000, 1e-6);
  const auto close = d.csv("l_mode_1_clearances.csv").last();
  EXPECT_NEAR(close.at("response [um]"), 2e6 * response(peak), 1e-6);
  EXPECT_NEAR(close.at("scaled [um]"), 25.4 * response(peak) / response(4000), 1e-6);
  EXPECT_NEAR(close.at("share [%]"), 25.4 / 3 * response(peak) / response(4000), 1e-6);
  EXPECT_NEAR(close.at("speed [rpm]"), peak, 1e-3);
  EXPECT_NEAR(close.at("diametral [mm]"), 0.3, 1e-12);
  const auto curve = d.csv("l_level_1_log_decrement.csv");
  for (const std::size_t row : {0u, 4u, 40u}) {
    const auto at = curve.named(curve.rows[row]);
    EXPECT_NEAR(at.at("cross-coupling [N/m]"), row / 4.0 * anticipated, 1e-6);
    EXPECT_NEAR(at.at("Q / QA [-]"), row / 4.0, 1e-12);
    EXPECT_NEAR(at.at("log decrement [-]"), log_decrement(row / 4.0 * anticipated), 1e-6);
  }
  EXPECT_NEAR(curve.named(curve.rows[0]).at("frequency [Hz]"),
              std::sqrt(k / m - c * c / (4 * m * m)) / (2 * pi), 1e-6);
  EXPECT_NEAR(d.csv("l_level_1_stages.csv").last().at("cross-coupling [N/m]"), anticipated, 1e-6);
  const auto masses = d.csv("l_masses.csv").last();
  EXPECT_NEAR(masses.at("mass [kg]"), 10, 1e-9);
  EXPECT_NEAR(masses.at("centre [m]"), 0.1, 1e-12);
  EXPECT_NEAR(masses.at("Ip [kg m2]"), 0.1, 1e-12);
  EXPECT_NEAR(masses.at("Id [kg m2]"), 0.06, 1e-12);
}

TEST(Reports, EverySetOfBearingsIsLookedAt) {
  const DeckRun d(lateral_report(R"(set = [
  { name = "stiff", change = ["bearing.spring.kyy = 4e6 N/m", "bearing.spring.kzz=4e6 N/m"] },
  { name = "as given" }]
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_EQ(compliance(d, "l").size(), 10u);
  EXPECT_NEAR(d.csv("l_stiff_modes_unbalance.csv").last().at("critical speed [rpm]"),
              2 * std::sqrt(k / m) * 30 / pi, 1e-5);
  EXPECT_NEAR(d.csv("l_as_given_modes_unbalance.csv").last().at("critical speed [rpm]"),
              std::sqrt(k / m) * 30 / pi, 1e-5);
}

TEST(Reports, SealsBelongToLevelTwo) {
  const DeckRun d(lateral_report(stages, R"([[bearing]]
name = "seal"
at = "mass"
type = "cross_coupling"
k = "1e5 N/m"
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::vector<Row> rows = compliance(d, "l");
  ASSERT_EQ(rows.size(), 7u);
  expect(rows[3], "level 1: log decrement", log_decrement(anticipated), 0.1, "passed");
  expect(rows[5], "level 2: log decrement", log_decrement(1e5), 0.1, "passed");
}

// A rotor at twice the reference speed: half the speeds in the deck, the same numbers.
TEST(Reports, SpeedsOfAGearedRotorAreItsOwn) {
  std::string deck = lateral_report(std::string(clearances) + stages);
  const std::string shaft = "[shaft]\n", speeds = "[\"4000 rpm\", \"5000 rpm\"]";
  deck.replace(deck.find(shaft), shaft.size(), shaft + "speed_ratio = 2\n");
  deck.replace(deck.find(speeds), speeds.size(), "[\"2000 rpm\", \"2500 rpm\"]");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::vector<Row> rows = compliance(d, "l");
  ASSERT_EQ(rows.size(), 7u);
  expect(rows[0], "separation margin", 100 * (4000 - peak) / 4000,
         17 * (1 - 1 / (amplification - 1.5)), "passed");
  expect(rows[1], "vibration at probes", 2e6 * response(4000), 25.4, "passed");
  expect(rows[4], "level 1: log decrement", log_decrement(anticipated), 0.1, "passed");
  EXPECT_NEAR(d.csv("l_modes_unbalance.csv").last().at("unbalance [g mm]"), 1e6 * unbalance(),
              1e-6);
}

// The mirror image of a machine: gas that drives the whirl goes round with the rotor.
TEST(Reports, ARotorThatTurnsBackwardsIsJudgedTheSame) {
  std::string deck = lateral_report(std::string(clearances) + stages);
  const std::string shaft = "[shaft]\n";
  deck.replace(deck.find(shaft), shaft.size(), shaft + "speed_ratio = -1\n");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::vector<Row> rows = compliance(d, "l");
  ASSERT_EQ(rows.size(), 7u);
  expect(rows[1], "vibration at probes", 2e6 * response(4000), 25.4, "passed");
  expect(rows[4], "level 1: log decrement", log_decrement(anticipated), 0.1, "passed");
  expect(rows[5], "level 1: Q0/QA", c * std::sqrt(k / m) / anticipated, 2, "passed");
}

// Journals in films, their tables over the shaft's own speed; nothing holds the rotor along its axis.
TEST(Reports, FilmsOfARotorThatTurnsBackwards) {
  const auto rows_of = [](const char* ratio) {
    std::string deck =
        std::string("format = 1\n[output]\nreport = false\n[shaft]\nspeed_ratio = ") + ratio + R"(
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["left", 300, 80], ["middle", 600, 100], ["right", 300, 80]]
[[disk]]
at = "middle:mid"
mass = "200 kg"
Ip = "4 kg.m^2"
Id = "2.2 kg.m^2"
[[probe]]
name = "P"
at = "left:start"
[[step]]
name = "a"
type = "api_lateral"
operating_speed = ["5000 rpm", "6000 rpm"]
[step.stages]
columns = ["name", "power[kW]", "speed[rpm]", "diameter[mm]", "width[mm]", "suction_density[kg/m^3]", "discharge_density[kg/m^3]"]
rows = [["1", 300, 6000, 350, 80, 1, 1.11]]
)";
    for (const char* at : {"left:start", "right:end"})
      deck += std::string("[[bearing]]\nat = \"") + at +
              "\"\ntype = \"short_journal\"\ndiameter = \"80 mm\"\nlength = \"30 mm\"\nclearance = "
              "\"120 um\"\nviscosity = \"0.01 Pa.s\"\n";
    const DeckRun d(deck);
    EXPECT_EQ(d.exit, 0) << d.log;
    return compliance(d, "a");
  };
  const std::vector<Row> ahead = rows_of("1"), back = rows_of("-1");
  ASSERT_EQ(ahead.size(), 6u);
  ASSERT_EQ(back.size(), 6u);
  for (std::size_t k = 0; k < ahead.size(); ++k) {
    EXPECT_EQ(back[k].result, ahead[k].result) << ahead[k].check;
    if (std::isnan(ahead[k].value)) continue;
    EXPECT_NEAR(back[k].value, ahead[k].value, 1e-5 * std::abs(ahead[k].value)) << ahead[k].check;
  }
}

// A slow rotor beside it, on bearings of its own, whose modes are the first eight of the deck.
TEST(Reports, AnotherRotorOfTheDeckChangesNothing) {
  const auto rows_of = [](const std::string& beside) {
    std::string deck =
        lateral_report(std::string("bearings = [\"spring\"]\n") + clearances + stages,
                       R"([[bearing]]
name = "seal"
at = "mass"
type = "cross_coupling"
k = "1e5 N/m"
)" + beside);
    const std::string shaft = "[shaft]\n";
    deck.replace(deck.find(shaft), shaft.size(), "[[shaft]]\n");
    const DeckRun d(deck);
    EXPECT_EQ(d.exit, 0) << d.log;
    return compliance(d, "l");
  };
  std::string other = R"([[shaft]]
name = "other"
material = "steel"
origin = ["0 mm", "1 m", "0 mm"]
columns = ["name", "length[mm]", "od[mm]"]
rows = [["long", 4000, 20]]
)";
  for (const char* at : {"other/long:start", "other/long:end"})
    other +=
        std::string("[[bearing]]\nat = \"") + at +
        "\"\ntype = \"linear\"\nkxx = \"1e6 N/m\"\nkyy = \"1e5 N/m\"\nkzz = \"2e5 N/m\"\ncyy = "
        "\"100 N.s/m\"\nczz = \"100 N.s/m\"\n";
  const std::vector<Row> alone = rows_of(""), two = rows_of(other);
  ASSERT_EQ(alone.size(), 8u);
  ASSERT_EQ(two.size(), 8u);
  for (std::size_t k = 0; k < alone.size(); ++k) {
    EXPECT_EQ(two[k].result, alone[k].result) << alone[k].check;
    if (std::isnan(alone[k].value)) continue;
    EXPECT_NEAR(two[k].value, alone[k].value, 1e-6 * std::abs(alone[k].value)) << alone[k].check;
  }
}

TEST(Reports, LimitsAreSettings) {
  const DeckRun d(lateral_report(std::string("trip_speed = \"5500 rpm\"\n") + clearances + stages +
                                 R"([step.limits]
unbalance_factor = 4
unbalance_constant = 1000
unbalance_speed = "2000 rpm"
vibration = "10 um"
vibration_speed = "4500 rpm"
scale = 0.5
clearance = 0.1
margin = 0.3
stage_factor = 6
torque_constant = 9
ratio = 4
log_decrement = 0.7
source = "the house"
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::vector<Row> rows = compliance(d, "l");
  ASSERT_EQ(rows.size(), 7u);
  const double share = 4 * 1000 / 2000.0 / (2 * 6350 / 4000.0);  // of the default unbalance
  const double qa = anticipated * 2 * 9 / 9.55;
  expect(rows[0], "separation margin", 100 * (4000 - peak) / 4000, 30, "FAILED");
  expect(rows[1], "vibration at probes", 2e6 * share * response(4000), 10 * std::sqrt(0.9),
         "passed");
  expect(rows[2], "close clearances", 100 * 0.5 * 2 * share * response(peak) / 0.3e-3, 10,
         "passed");
  expect(rows[4], "level 1: log decrement", log_decrement(qa), 0.7, "FAILED");
  expect(rows[5], "level 1: Q0/QA", c * std::sqrt(k / m) / qa, 4, "passed");
  EXPECT_EQ(d.summary("l").at("compliance").items()[0].at("source").text(), "the house");
}

TEST(Reports, WhatDoesNotFitIsSaid) {
  const auto says = [](const std::string& deck, const char* code, const char* text) {
    const DeckRun d(deck);
    EXPECT_EQ(d.exit, 3) << d.log;
    EXPECT_TRUE(d.says(code) && d.says(text)) << text << "\n" << d.log;
  };
  says(lateral_report("bearings = [\"none\"]\n"), "E70", "which the deck does not have");
  says(lateral_report("probes = [\"none\"]\n"), "E70", "which the deck does not have");
  says(lateral_report("set = [{ name = \"a\", change = [\"bearing.spring.kyy\"] }]\n"), "E20",
       "is no key = value");
  says(lateral_report("set = [{ name = \"a\", change = [\"bearing.spring.kyy = 1 kg\"] }]\n"),
       "E08", "set 'a'");
  says(lateral_report("set = [{ name = \"a\" }, { name = \"a\" }]\n"), "E16", "called 'a'");
  says(lateral_report("trip_speed = \"4500 rpm\"\n"), "E21", "trip speed");
  says(lateral_report("apply = \"stages\"\n" + std::string(stages)), "E05", "has no place");
  says(lateral_report("[step.limits]\ndensity = [\"1 kg/m^3\"]\n"), "E26", "critical speed ratios");
  says(lateral_report("modes = [7]\n"), "E70", "undamped mode 7");
  const std::string balancing =
      "[[step]]\nname = \"b\"\ntype = \"balancing\"\nspeeds = [\"3500 "
      "rpm\"]\nplane = [{ name = \"disc\", at = \"mass\" }]\n";
  const std::string vectors =
      "[step.measured]\ncolumns = [\"run\", \"probe\", \"speed[rpm]\", \"amplitude[um]\", "
      "\"phase[deg]\"]\nrows = [[\"a\", \"P\", 3500, 10, 30]]\n";
  const auto trial = [](const char* run, const char* plane) {
    return fmt::format("trial = [{{ run = \"{}\", plane = \"{}\", amount = \"5 g.mm\" }}]\n", run,
                       plane);
  };
  says(lateral_report("", balancing + trial("b", "disc") + vectors), "E63", "lacks the vector");
  says(lateral_report("", balancing + trial("a", "hub") + vectors), "E63", "names plane 'hub'");
  says(lateral_report("", balancing + trial("a", "disc")), "E26", "measured vectors");
  says(lateral_report("", balancing + "method = \"modal\"\n"), "E05", "lacks 'modes'");
}

namespace {
/// Two discs of 1 and 3 kg m2 on a bar of 1 m and 50 mm without mass.
std::string torsional_report(const std::string& keys) {
  return R"(format = 1
[[material]]
name = "light"
E = "200 GPa"
G = "80 GPa"
density = "1e-6 kg/m^3"
[shaft]
name = "r"
material = "light"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["bar", 1000, 50]]
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
[output]
report = false
[[step]]
name = "t"
type = "api_torsional"
operating_speed = ["1000 rpm", "1100 rpm"]
modes = 1
)" + keys;
}
const double J = pi * std::pow(0.05, 4) / 32;
const double natural = std::sqrt(80e9 * J * (1.0 + 1.0 / 3)) / (2 * pi);  // Hz
}  // namespace

TEST(Reports, TorsionalNumbersAreThoseOfTwoDiscs) {
  const DeckRun d(torsional_report(R"(line_frequency = "50 Hz"
stress_limit = "30 MPa"
concentration = 1.5
[[step.torque]]
name = "pulsation"
at = "A"
frequency = "20 Hz"
amplitude = "100 N.m"
[[step.torque]]
name = "gear"
at = "A"
order = 0.5
amplitude = "100 N.m"
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(d.csv("t_modes.csv").last().at("frequency [Hz]"), natural, 1e-6 * natural);
  // 2x: 33.3 to 36.7 Hz, 1x: to 18.3, twice the line frequency 100, 50: nearest to 41.0 Hz
  const std::vector<Row> rows = compliance(d, "t");
  ASSERT_EQ(rows.size(), 3u);
  const double above = 100 * (natural - 2 * 1100 / 60.0) / (2 * 1100 / 60.0);
  const double line = 100 * (50 - natural) / 50;
  expect(rows[0], "torsional margin", std::min(above, line), 10,
         std::min(above, line) >= 10 ? "passed" : "FAILED");
  const auto stress = [&](double f) {  // 3/4 of the torque turns B, times 1/(1 - (f/fn)^2)
    return 1e-6 * 1.5 * 100 * 0.75 / std::abs(1 - f * f / (natural * natural)) * 0.025 / J;
  };
  expect(rows[1], "torsional stress", stress(20), 30, "passed");
  expect(rows[2], "torsional stress", stress(0.5 * 1100 / 60), 30, "passed");
  const auto row = d.csv("t_stresses.csv").last();
  EXPECT_NEAR(row.at("torque in the shaft [N m]"),
              75 / (1 - std::pow(0.5 * 1100 / 60 / natural, 2)), 1e-4);
  EXPECT_NEAR(row.at("speed [rpm]"), 1100, 1e-6);
  EXPECT_NEAR(d.csv("t_train.csv").last().at("inertia [kg m2]"), 4, 1e-6);
  const io::Value told = d.summary("t").at("frequencies [Hz]");
  EXPECT_NEAR(told.items().at(told.items().size() - 1).number(), natural, 1e-6 * natural);
}

TEST(Reports, AResonanceWithoutDampingIsSaid) {
  const double speed = natural * 60;
  const DeckRun d(torsional_report("[[step.torque]]\nname = \"once\"\nat = \"A\"\norder = " +
                                   std::to_string(speed / 1050) + "\namplitude = \"1 N.m\"\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto rows = compliance(d, "t");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].result, "FAILED");
  EXPECT_LT(rows[0].value, 0);
}

// At the very speed of a mode the matrix may be singular to the last digit, or not.
TEST(Reports, AResonanceWithoutDampingIsSaidWhereverTheSpeedsEnd) {
  for (int k = 0; k < 12; ++k) {
    const std::string inertia = std::to_string(3.0 + 0.37 * k);
    std::string deck = torsional_report(
        "stress_limit = \"50 MPa\"\n[[step.torque]]\nname = \"once\"\nat = \"A\"\norder = "
        "1\namplitude = \"1 N.m\"\n");
    const std::string given = "Ip = \"3 kg.m^2\"", speeds = "[\"1000 rpm\", \"1100 rpm\"]";
    deck.replace(deck.find(given), given.size(), "Ip = \"" + inertia + " kg.m^2\"");
    const double f = std::sqrt(80e9 * J * (1.0 + 1.0 / std::stod(inertia))) / (2 * pi);
    deck.replace(deck.find(speeds), speeds.size(),
                 "[\"" + std::to_string(59 * f) + " rpm\", \"" +
                     std::to_string(60 * f + 7 * k + 1) + " rpm\"]");
    const DeckRun d(deck);
    ASSERT_EQ(d.exit, 0) << d.log;
    const auto rows = compliance(d, "t");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[1].result, "FAILED") << inertia;
    EXPECT_TRUE(std::isnan(rows[1].value)) << inertia << ": " << rows[1].value;
  }
}

TEST(Reports, BalancingFindsTheUnbalance) {
  const DeckRun d(lateral_report("", R"([[unbalance]]
at = "mass"
amount = "30 g.mm"
phase = "40 deg"
[[step]]
name = "b"
type = "balancing"
speeds = ["2000 rpm", "3500 rpm"]
plane = [{ name = "disc", at = "mass" }]
[[step]]
name = "u"
type = "unbalance_response"
speed = { start = "2000 rpm", stop = "5000 rpm", points = 4 }
operating_speed = ["4000 rpm", "5000 rpm"]
balance_grade = "G1"
[step.zones]
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto w = d.csv("b_corrections.csv").last();
  EXPECT_NEAR(w.at("correction [g mm]"), 30, 1e-7);
  EXPECT_NEAR(w.at("angle [deg]"), 220, 1e-6);
  EXPECT_NEAR(w.at("place [m]"), 0.1, 1e-12);
  const io::Value told = d.summary("b").at("corrections").at("disc");
  EXPECT_NEAR(told.at("amount [g mm]").number(), 30, 1e-7);
  EXPECT_NEAR(told.at("angle [deg]").number(), 220, 1e-6);
  const auto left = d.csv("b_residuals.csv");
  const double w2 = rad(2000);
  const double amplitude = 30e-6 * w2 * w2 / std::abs(Complex(k - m * w2 * w2, c * w2));
  const auto first = left.named(left.rows[0]);
  EXPECT_NEAR(first.at("before [um]"), 1e6 * amplitude, 1e-6);
  EXPECT_NEAR(first.at("lag before [deg]"), std::atan2(c * w2, k - m * w2 * w2) * 180 / pi - 40,
              1e-6);
  EXPECT_NEAR(first.at("after [um]"), 0, 1e-7);
  const auto influence = d.csv("b_influence.csv");
  EXPECT_NEAR(influence.named(influence.rows[0]).at("disc [um/(g mm)]"), 1e6 * amplitude / 30,
              1e-7);
  // e omega of 30 g mm in 10 kg at 5000 rpm; the zones at 4000 rpm, where the response is largest
  const auto grade = d.csv("u_balance_grade.csv").last();
  EXPECT_NEAR(grade.at("grade [mm/s]"), 30e-3 / 10 * rad(5000), 1e-6);
  EXPECT_NEAR(grade.at("permissible [g mm]"), 1e3 * 10 / rad(5000), 1e-6);
  EXPECT_NEAR(grade.at("unbalance [g mm]"), 30, 1e-9);
  const auto zone = d.csv("u_zones.csv").last();
  EXPECT_NEAR(zone.at("A/B [um]"), 4800 / std::sqrt(4000.0), 1e-6);
  EXPECT_NEAR(zone.at("B/C [um]"), 9000 / std::sqrt(4000.0), 1e-6);
  EXPECT_NEAR(zone.at("C/D [um]"), 13200 / std::sqrt(4000.0), 1e-6);
  EXPECT_NEAR(zone.at("amplitude peak to peak [um]"), 2e6 * 30e-6 / unbalance() * response(4000),
              1e-6);
  EXPECT_EQ(d.summary("u").at("zones").at("P").text(), "A");
}

// Speeds are the reference's; a shaft at twice of them, or against them, is balanced at its own.
TEST(Reports, BalancingOfAShaftAtASpeedOfItsOwn) {
  for (const double ratio : {2.0, -1.0, -2.0}) {
    std::string deck = lateral_report("", R"([[unbalance]]
at = "mass"
amount = "30 g.mm"
phase = "40 deg"
[[step]]
name = "b"
type = "balancing"
speeds = ["1750 rpm"]
plane = [{ name = "disc", at = "mass" }]
)");
    const std::string shaft = "[shaft]\n";
    deck.replace(deck.find(shaft), shaft.size(),
                 shaft + "speed_ratio = " + std::to_string(ratio) + "\n");
    const std::size_t report = deck.find("[[step]]\nname = \"l\"");
    deck.erase(report, deck.find("[[unbalance]]") - report);
    const DeckRun d(deck);
    ASSERT_EQ(d.exit, 0) << d.log;
    const auto w = d.csv("b_corrections.csv").last();
    EXPECT_NEAR(w.at("correction [g mm]"), 30, 1e-7) << ratio;
    EXPECT_NEAR(w.at("angle [deg]"), 220, 1e-6) << ratio;
    const double omega = rad(1750 * std::abs(ratio));
    const double amplitude =
        30e-6 * omega * omega / std::abs(Complex(k - m * omega * omega, c * omega));
    EXPECT_NEAR(d.csv("b_residuals.csv").last().at("before [um]"), 1e6 * amplitude, 1e-6) << ratio;
  }
}

// 10 um lagging 30 deg; 5 g mm at 0 deg add 10 um lagging 45 deg: 5 g mm at 195 deg take it away.
TEST(Reports, BalancingFromMeasuredVectors) {
  const Complex r0 = std::polar(10.0, -pi / 6), r1 = r0 + std::polar(10.0, -pi / 4);
  const DeckRun d(lateral_report("", R"([[step]]
name = "b"
type = "balancing"
speeds = ["3500 rpm"]
amplitude = "0-peak"
plane = [{ name = "disc", at = "mass" }]
trial = [{ run = "trial", plane = "disc", amount = "5 g.mm", phase = "0 deg" }]
[step.measured]
columns = ["run", "probe", "speed[rpm]", "amplitude[um]", "phase[deg]"]
rows = [["as found", "P", 3500, 10, 30], ["trial", "P", 3500, )" +
                                         std::to_string(std::abs(r1)) + ", " +
                                         std::to_string(-std::arg(r1) * 180 / pi) + "]]\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto w = d.csv("b_corrections.csv").last();
  EXPECT_NEAR(w.at("correction [g mm]"), 5, 2e-6);
  EXPECT_NEAR(w.at("angle [deg]"), 195, 2e-5);
  EXPECT_NEAR(d.summary("b").at("root mean square before 0-peak [um]").number(), 10, 1e-9);
  EXPECT_NEAR(d.summary("b").at("root mean square after 0-peak [um]").number(), 0, 1e-9);
}

TEST(Reports, ATitleBlockHeadsTheReport) {
  std::string deck = lateral_report("", R"([title_block]
project = "Unit <7>"
revision = "B"
)");
  const std::string off = "report = false\n";
  deck.erase(deck.find(off), off.size());
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  std::ostringstream page;
  page << std::ifstream(d.folder / "r" / "report.html").rdbuf();
  const std::string html = page.str();
  EXPECT_NE(html.find("class=\"title-block\""), std::string::npos);
  EXPECT_NE(html.find("Unit &lt;7&gt;"), std::string::npos);
  EXPECT_NE(html.find("<td class=\"passed\">passed</td>"), std::string::npos);
  EXPECT_NE(html.find("@page"), std::string::npos);
  EXPECT_EQ(d.summary().at("title block").at("Revision").text(), "B");
  // the figures that the table names are there
  for (std::size_t at = html.find("href=\"#l_"); at != std::string::npos;
       at = html.find("href=\"#l_", at + 1)) {
    const std::size_t end = html.find('"', at + 7);
    EXPECT_NE(html.find("id=\"" + html.substr(at + 7, end - at - 7) + "\""), std::string::npos)
        << html.substr(at, end - at);
  }
}
