// Rainflow counting and cumulative damage.
#include <analysis/response/fatigue.hpp>
#include <gtest/gtest.h>
#include <cmath>
#include <map>

using namespace whirl;
using namespace whirl::analysis;

namespace {

/// Cycles by range.
std::map<double, double> counted(const std::vector<double>& history, int repeats = 1) {
  std::map<double, double> out;
  const auto take = [&](const LoadCycle& c) { out[c.range] += c.count; };
  Rainflow rainflow;
  for (int k = 0; k < repeats; ++k)
    for (const double x : history)
      rainflow.push(x, take);
  rainflow.finish(take);
  return out;
}

}  // namespace

// The example of ASTM E1049-85 (its figure 6, as everywhere): A -2, B 1, C -3, D 5, E -1, F 3, G -4, H 4, I -2.
TEST(Rainflow, ExampleOfTheStandard) {
  const std::map<double, double> expected{{3, 0.5}, {4, 1.5}, {6, 0.5}, {8, 1.0}, {9, 0.5}};
  EXPECT_EQ(counted({-2, 1, -3, 5, -1, 3, -4, 4, -2}), expected);
  // what lies between reversals, and values that stay, change nothing
  EXPECT_EQ(counted({-2, -2, 0, 1, 1, -1, -3, 0, 2, 5, 5, 4, -1, 3, 0, -4, 1, 4, 3, -2}), expected);
}

TEST(Rainflow, SmallCyclesInALargeOneKeepIt) {
  // 0 to 10 with ten cycles of 2 about 5 on the way up
  std::vector<double> history{0};
  for (int k = 0; k < 10; ++k) {
    history.push_back(6);
    history.push_back(4);
  }
  history.push_back(10);
  history.push_back(0);
  const std::map<double, double> expected{{2, 10.0}, {10, 1.0}};
  EXPECT_EQ(counted(history), expected);
}

TEST(Rainflow, GoesOnFromWhatIsOpen) {
  const std::vector<double> history{-2, 1, -3, 5, -1, 3, -4, 4, -2};
  std::map<double, double> out;
  const auto take = [&](const LoadCycle& c) { out[c.range] += c.count; };
  Rainflow first;
  for (std::size_t k = 0; k < 6; ++k)
    first.push(history[k], take);
  Rainflow second;
  second.reopen(first.open());
  for (std::size_t k = 6; k < history.size(); ++k)
    second.push(history[k], take);
  second.finish(take);
  EXPECT_EQ(out, counted(history));
}

TEST(Fatigue, LivesOfThePowerLaw) {
  const FatigueStrength s{400, 300, 100, 1e6};
  EXPECT_NEAR(s.life(300), 1e3, 1e-9);
  EXPECT_NEAR(s.life(std::sqrt(300.0 * 100.0)), std::sqrt(1e3 * 1e6), 1e-6);
  EXPECT_NEAR(s.life(100 * (1 + 1e-12)), 1e6, 1e-3);
  EXPECT_EQ(s.life(100), infinity);
  EXPECT_EQ(s.life(400), 0);
  // Goodman: half of the strength as a mean doubles the amplitude
  EXPECT_NEAR(s.equivalent(50, 200), 100, 1e-12);
  EXPECT_NEAR(s.equivalent(50, -200), 100, 1e-12);
  EXPECT_EQ(s.equivalent(1, 400), infinity);
  EXPECT_EQ(s.damage({100, 200, 1}), 0);
  EXPECT_NEAR(s.damage({300, 200, 0.5}), 0.5 / 1e3, 1e-12);
  EXPECT_EQ(s.damage({100, 500, 1}), infinity);
}
