// Harmonic forces at and next to 0 Hz, where a rotor that is free to turn has no stiffness against
// it: the right answer where there is one, an error or a warning where there is none; never a quiet
// zero or a quiet NaN.
#include "deck_run.hpp"
#include <gtest/gtest.h>
#include <cmath>
#include <map>

namespace {

std::string deck(const std::string& thrust, const std::string& frequency,
                 const std::string& motion) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "hp"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 300, 40], ["b", 300, 40]]
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
)" + thrust +
         R"(
kyy = "1e7 N/m"
kzz = "1e7 N/m"
[[bearing]]
name = "R"
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
[[step]]
name = "push"
type = "harmonic_response"
motion = ")" +
         motion + "\"\nfrequency = { values = [\"" + frequency + R"("] }
[[step.force]]
at = "b:end"
force = ["100 N", "0 N", "0 N"]
[output]
report = false
)";
}

double thrust_of(const whirl::test::DeckRun& r) {
  return r.csv("push_response.csv").last().at("bearing L force x [N]");
}

}  // namespace

TEST(HarmonicLimits, AxialForceOnAFreeShaftIsAnError) {
  const whirl::test::DeckRun r(deck("", "10 Hz", "all"));
  EXPECT_EQ(r.exit, 3);
  EXPECT_TRUE(r.says("nothing resists axial motion of shaft 'hp'")) << r.log;
}

// Along the axis nothing takes part in lateral motion: the force had no effect, and nobody said so.
TEST(HarmonicLimits, WhatLateralMotionLeavesOutIsSaid) {
  const whirl::test::DeckRun r(deck("kxx = \"1e7 N/m\"", "10 Hz", "lateral"));
  EXPECT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(r.says("leaves out what of a force acts along the shaft")) << r.log;
  const whirl::test::DeckRun axial(deck("kxx = \"1e7 N/m\"", "10 Hz", "axial"));
  EXPECT_FALSE(axial.says("leaves out")) << axial.log;
}

TEST(HarmonicLimits, ThrustBearingCarriesIt) {
  const whirl::test::DeckRun still(deck("kxx = \"1e7 N/m\"", "0 Hz", "axial"));
  ASSERT_EQ(still.exit, 0) << still.log;
  EXPECT_NEAR(thrust_of(still), 100, 1e-9);
  // at 10 Hz the mass m on the thrust bearing k, the shaft itself stiff: 100/(1 - m w^2/k), bar
  // within 1e-4 of it
  const whirl::test::DeckRun slow(deck("kxx = \"1e7 N/m\"", "10 Hz", "all"));
  ASSERT_EQ(slow.exit, 0) << slow.log;
  const double m = 7850 * 3.14159265 * 0.04 * 0.04 / 4 * 0.6, w = 20 * 3.14159265;
  EXPECT_NEAR(thrust_of(slow), 100 / (1 - m * w * w / 1e7), 0.01);
}

namespace {

constexpr const char* with_thrust = "kxx = \"1e7 N/m\"";

std::string with_force(const std::string& force, const std::string& frequency = "0 Hz") {
  std::string text = deck(with_thrust, frequency, "all");
  const std::string given = "force = [\"100 N\", \"0 N\", \"0 N\"]\n";
  text.replace(text.find(given), given.size(), force);
  const std::size_t end = text.find("[[bearing]]");
  return text.insert(
      end,
      "[[disk]]\nname = \"d\"\nat = \"a:end\"\nmass = \"3 kg\"\nIp = \"0.02 kg.m^2\"\nId = \"0.01 "
      "kg.m^2\"\n"
      "[[probe]]\nname = \"P\"\nat = \"d\"\n[[probe]]\nname = \"Q\"\nat = \"b:end\"\n");
}

std::map<std::string, double> answer(const std::string& text) {
  const whirl::test::DeckRun r(text);
  EXPECT_EQ(r.exit, 0) << r.log;
  EXPECT_FALSE(r.says("not finite")) << r.log;
  return r.csv("push_response.csv").last();
}

}  // namespace

// 0 Hz is the documented default start. A rotor that is free to turn makes the matrix singular
// there, yet only its angle is undetermined.
TEST(HarmonicLimits, AFreeSpinHidesNothingAtZeroFrequency) {
  const whirl::test::DeckRun r(deck(with_thrust, "0 Hz", "all"));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_NEAR(thrust_of(r), 100, 1e-9);
}

TEST(HarmonicLimits, ZeroFrequencyIsTheLimitOfLowOnes) {
  const std::string force = "force = [\"0 N\", \"100 N\", \"20 N\"]\n";
  const auto zero = answer(with_force(force)), low = answer(with_force(force, "0.001 Hz"));
  // (w/w1)^2 = 1e-10 away
  for (const auto& [name, value] : low) {
    if (name.find("phase") != std::string::npos || name.find("frequency") != std::string::npos)
      continue;
    const double scale =
        name.find("[N]") != std::string::npos ? 100 : 1e-5;  // the force over one of the supports
    EXPECT_NEAR(zero.at(name), value, 1e-8 * (std::abs(value) + scale)) << name;
  }
  // simply supported by two springs: the force stands over R
  EXPECT_NEAR(zero.at("bearing R force y [N]"), 100, 1e-6);
}

TEST(HarmonicLimits, CouplesInBalanceTwistAFreeShaft) {
  std::string text = with_force("moment = [\"10 N.m\", \"0 N.m\", \"0 N.m\"]\n");
  text += "\n";
  const std::string second =
      "[[step.force]]\nat = \"d\"\nmoment = [\"-10 N.m\", \"0 N.m\", \"0 N.m\"]\n";
  text.insert(text.find("[output]"), second);
  const auto zero = answer(text);
  // 10 N m over 0.3 m of 40 mm steel
  const double G = 80e9, J = 3.14159265358979 * std::pow(0.04, 4) / 32;
  const double twist =
      zero.at("Q twist amplitude [rad]") + zero.at("P twist amplitude [rad]");  // of opposite sense
  EXPECT_NEAR(twist, 10 * 0.3 / (G * J), 0.02 * twist);                         // steel's G to 2 %
  EXPECT_NEAR(zero.at("largest torque in hp [N.m]"), 10, 1e-6);
}

TEST(HarmonicLimits, ATorqueOnAFreeRotorHasNoAnswerAndThatIsSaid) {
  const whirl::test::DeckRun r(with_force(
      "force = [\"0 N\", \"100 N\", \"0 N\"]\nmoment = [\"10 N.m\", \"0 N.m\", \"0 N.m\"]\n"));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(r.says("are not finite")) << r.log;
  const auto row = r.csv("push_response.csv").last();
  EXPECT_TRUE(std::isnan(row.at("P twist amplitude [rad]")));
  // bending knows nothing of the torque
  const auto bending = answer(with_force("force = [\"0 N\", \"100 N\", \"0 N\"]\n"));
  EXPECT_NEAR(row.at("Q y amplitude [m]"), bending.at("Q y amplitude [m]"),
              1e-9 * bending.at("Q y amplitude [m]"));
}

TEST(HarmonicLimits, UnbalanceNextToStandstill) {
  std::string text = with_force("");
  text.resize(text.find("[[step]]"));
  text +=
      "[[unbalance]]\nat = \"d\"\namount = \"60 g.mm\"\n[[step]]\nname = \"push\"\ntype = "
      "\"unbalance_response\"\nspeed = { values = [\"1e-7 rpm\", \"1 rpm\"] }\n[output]\nreport = "
      "false\n";
  const whirl::test::DeckRun r(text);
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_FALSE(r.says("not finite")) << r.log;
  const whirl::test::Columns c = r.csv("push_response.csv");
  ASSERT_EQ(c.rows.size(), 2u);
  // a force that grows with the square of the speed on springs
  const auto slow = c.named(c.rows[0]), fast = c.named(c.rows[1]);
  EXPECT_NEAR(slow.at("P y amplitude [m]") * 1e14, fast.at("P y amplitude [m]"),
              1e-4 * fast.at("P y amplitude [m]"));
}

namespace {

/// A light damped rotor; resonances far narrower than the grid's steps of 34 Hz.
std::string narrow_resonances(const std::string& grid) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 500, 30, 4], ["b", 500, 30, 4]]
[shaft.damping]
internal_beta = "1e-6 s"
[[disk]]
name = "d"
at = "a:end"
mass = "5 kg"
Ip = "0.02 kg.m^2"
Id = "0.01 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e8 N/m"
kzz = "1.1e8 N/m"
cyy = "3e4 N.s/m"
czz = "3e4 N.s/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "1e8 N/m"
kzz = "1.1e8 N/m"
cyy = "3e4 N.s/m"
czz = "3e4 N.s/m"
[[probe]]
name = "p"
at = "d"
[[step]]
name = "push"
type = "harmonic_response"
rotor_speed = "1000 rpm"
frequency = )" +
         grid + R"(
[[step.force]]
at = "d"
force = ["0 N", "1e-3 N", "0 N"]
[output]
report = false
)";
}

}  // namespace

// Resonances between the points of the grid: the largest of the response was 5e-5 of what it is.
TEST(HarmonicLimits, PeaksBetweenThePointsOfTheGridAreFound) {
  const auto range = [](int points) {
    return narrow_resonances(
        "{ start = \"5 Hz\", stop = \"1000 Hz\", points = " + std::to_string(points) + " }");
  };
  const whirl::test::DeckRun coarse(range(30)), fine(range(4001));
  ASSERT_EQ(coarse.exit, 0) << coarse.log;
  ASSERT_EQ(fine.exit, 0) << fine.log;
  const auto peaks = coarse.csv("push_peaks.csv"), wanted = fine.csv("push_peaks.csv");
  ASSERT_GE(wanted.rows.size(), 2u);
  ASSERT_EQ(peaks.rows.size(), wanted.rows.size());
  const std::size_t frequency = wanted.column("frequency [Hz]"),
                    amplitude = wanted.column("amplitude [m]");
  for (std::size_t k = 0; k < wanted.rows.size(); ++k)
    for (const std::size_t c : {frequency, amplitude})
      EXPECT_NEAR(peaks.rows[k][c], wanted.rows[k][c], 1e-6 * wanted.rows[k][c]);
}

// A mode at 10 Hz, below the table: the response from 20 Hz on does not need it.
TEST(HarmonicLimits, ResonancesThatATableDoesNotReachAreSaid) {
  std::string bearings;
  for (const char* at : {"a:start", "b:end"})
    bearings += std::string("[[bearing]]\nat = \"") + at + R"("
type = "table"
columns = ["speed[rpm]", "frequency[Hz]", "kyy[N/m]", "kzz[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [[0, 20, 2e4, 2e4, 20, 20], [0, 200, 2.2e4, 2.2e4, 20, 20],
  [3000, 20, 2e4, 2e4, 20, 20], [3000, 200, 2.2e4, 2.2e4, 20, 20]]
)";
  std::string text = narrow_resonances("{ start = \"20 Hz\", stop = \"200 Hz\", points = 10 }");
  const std::size_t first = text.find("[[bearing]]"), last = text.find("[[probe]]");
  text.replace(first, last - first,
               bearings + "[[bearing]]\nat = \"a:start\"\ntype = \"linear\"\nkxx = \"1e7 N/m\"\n");
  const whirl::test::DeckRun r(text);
  EXPECT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(r.says("W15")) << r.log;
  EXPECT_TRUE(r.says("whether free motions grow at 1000 rpm is not known")) << r.log;
  EXPECT_EQ(r.csv("push_response.csv").rows.size(), 10u);
}

// A resonance without damping has no height: it is found, said to be without bound, and no fault of the
// mesh.
TEST(HarmonicLimits, UndampedResonancesAreFoundAndNotJudged) {
  std::string text = narrow_resonances("{ start = \"5 Hz\", stop = \"200 Hz\", points = 10 }");
  const auto without = [&text](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from))
      text.replace(at, from.size(), to);
  };
  without("internal_beta = \"1e-6 s\"\n", "");
  without("[shaft.damping]\n", "");
  without("cyy = \"3e4 N.s/m\"\n", "");
  without("czz = \"3e4 N.s/m\"\n", "");
  const whirl::test::DeckRun r(text);
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(r.says("W13")) << r.log;
  EXPECT_FALSE(r.says("W10")) << r.log;
  const auto peaks = r.csv("push_peaks.csv");
  ASSERT_EQ(peaks.rows.size(), 2u);
  for (const auto& row : peaks.rows)
    EXPECT_TRUE(std::isnan(row[peaks.column("amplitude [m]")]));
  for (const auto& row : peaks.rows)
    EXPECT_TRUE(std::isnan(row[peaks.column("mesh error of amplitude [-]")]));
}
