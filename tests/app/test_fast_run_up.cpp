// Spectra where the speed changes within a block.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

using whirl::two_pi;
using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

// A mass of 10 kg on 1e9 N/m, well damped, runs from 600 to 6000 rpm in two seconds: a block of half a
// second sees 22.5 Hz go by, eleven lines.
const char* fast_run_up = R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "rotor"
[[shaft.section]]
name = "body"
length = "100 mm"
rigid = true
[[disk]]
name = "mass"
at = "body:mid"
mass = "10 kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
name = "springs"
at = "body:mid"
type = "linear"
kxx = "1e9 N/m"
kyy = "1e9 N/m"
kzz = "1e9 N/m"
krr = "1e9 N.m/rad"
cyy = "1e5 N.s/m"
czz = "1e5 N.s/m"
[[unbalance]]
at = "mass"
amount = "1000 g.mm"
[[drive]]
name = "motor"
at = "mass"
type = "speed"
speed = { type = "ramp", time = ["0 s", "2 s"], value = ["600 rpm", "6000 rpm"] }
[[probe]]
name = "P"
at = "mass"
[[step]]
name = "t"
type = "transient"
duration = "2 s"
[output.spectra]
max_frequency = "200 Hz"
lines = 100
)";

/// The run-up with a part of its text replaced.
std::string with_other(std::string text, const std::string& old, const std::string& now) {
  return text.replace(text.find(old), old.size(), now);
}

}  // namespace

// With the acceleration constant the square of the speed, and the amplitude with it, grows evenly with the
// angle: in the mean over a window about the middle angle it is (w0^2 + w1^2)/2.
TEST(FastRunUp, RidgeKeepsFrequencyAndAmplitude) {
  const DeckRun d(fast_run_up);
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns ridge = d.csv("t_P_ridge.csv"), lines_of = d.csv("t_P_spectra.csv");
  ASSERT_GE(ridge.rows.size(), 6u);
  const auto r = ridge.last();
  const double rad = two_pi / 60, w = r.at("speed [rpm]") * rad,
               half = 0.5 * r.at("change of speed [rpm]") * rad;
  EXPECT_NEAR(r.at("change of speed [rpm]"), 2700 * 0.5 * 511 / 512, 0.01);
  EXPECT_EQ(r.at("equal angles [-]"), 1);
  EXPECT_NEAR(r.at("frequency [Hz]"), w / two_pi, 0.02);
  const double expected = 1e-3 / 1e9 * (w * w + half * half);
  EXPECT_NEAR(r.at("amplitude [m]"), expected, 5e-3 * expected);
  // samples at equal times smear it
  const std::vector<double>& smeared = lines_of.rows.back();
  EXPECT_LT(*std::max_element(smeared.begin() + 2, smeared.end()), 0.6 * expected);
  // and the pictures say so
  std::ostringstream page;
  page << std::ifstream(d.folder / "r" / "report.html").rdbuf();
  EXPECT_NE(page.str().find("from samples at equal angles"), std::string::npos);
  EXPECT_NE(page.str().find("ridge: strongest component"), std::string::npos);
}

// 22.5 Hz, eleven lines, go by within a block: sixteen overlap, and the speed changes by less than a
// line from one to the next.
TEST(FastRunUp, SpectraFollowAsCloselyAsTheSpeedChanges) {
  const DeckRun d(fast_run_up);
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns ridge = d.csv("t_P_ridge.csv");
  ASSERT_GE(ridge.rows.size(), 45u);
  for (std::size_t k = 1; k < ridge.rows.size(); ++k) {
    const auto a = ridge.named(ridge.rows[k - 1]), b = ridge.named(ridge.rows[k]);
    EXPECT_NEAR(b.at("speed [rpm]") - a.at("speed [rpm]"), 2700.0 * 0.5 / 16, 0.1);
    EXPECT_GT(b.at("amplitude [m]"), a.at("amplitude [m]"));
  }
}

// What the run-up shows does not lie under what the run-down shows.
TEST(FastRunUp, RisesAndFallsAreDrawnApart) {
  const DeckRun d(
      with_other(fast_run_up, R"(time = ["0 s", "2 s"], value = ["600 rpm", "6000 rpm"])",
                 R"(time = ["0 s", "1 s", "2 s"], value = ["600 rpm", "6000 rpm", "600 rpm"])"));
  ASSERT_EQ(d.exit, 0) << d.log;
  for (const char* figure : {"t_P_waterfall", "t_P_spectrogram"}) {
    const auto picture = [&](const std::string& what) {
      return std::filesystem::exists(d.folder / "r" / "plots" / (figure + what + ".svg"));
    };
    EXPECT_TRUE(picture("_rising_speed")) << figure;
    EXPECT_TRUE(picture("_falling_speed")) << figure;
    EXPECT_FALSE(picture("")) << figure;
  }
}

// A speed that swings to and fro is no row of run-ups: all in one picture, and none is left out.
TEST(FastRunUp, ManySwingsAreDrawnTogether) {
  const std::string swings = with_other(
      fast_run_up, R"(time = ["0 s", "2 s"], value = ["600 rpm", "6000 rpm"])",
      R"(time = ["0 s", "1 s", "2 s", "3 s", "4 s", "5 s"], value = ["600 rpm", "6000 rpm", "600 rpm", "6000 rpm", "600 rpm", "6000 rpm"])");
  const DeckRun d(with_other(swings, "duration = \"2 s\"", "duration = \"5 s\""));
  ASSERT_EQ(d.exit, 0) << d.log;
  for (const char* figure : {"t_P_waterfall.svg", "t_P_spectrogram.svg"})
    EXPECT_TRUE(std::filesystem::exists(d.folder / "r" / "plots" / figure)) << figure;
}

// The base accelerates ever more: the mass goes aside in proportion, 1 mm in the run, three
// thousandths of it within a block. It is no vibration of low frequency.
TEST(FastRunUp, ACentreLineThatMovesIsNoVibration) {
  const DeckRun d(
      with_other(fast_run_up, "[output.spectra]",
                 "[base]\ny = { type = \"ramp\", time = [\"0 s\", \"2 s\"], value = [\"0 "
                 "m/s^2\", \"1e5 m/s^2\"] }\n[output.spectra]"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns lines = d.csv("t_P_spectra.csv");
  for (const std::vector<double>& row : lines.rows)
    for (std::size_t k = 100; k <= 104; ++k)  // two lines to each side of 0 Hz
      EXPECT_LT(row[k], 0.01 * 0.25e-3) << row[0] << " s, line " << k;
}
