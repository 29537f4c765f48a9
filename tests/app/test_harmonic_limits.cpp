// Harmonic forces where nothing answers them: an error, or no number; never a quiet zero.
#include "deck_run.hpp"
#include <gtest/gtest.h>
#include <cmath>

namespace {

std::string deck(const std::string& thrust, const std::string& frequency, const std::string& motion) {
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
)" + thrust + R"(
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
motion = ")" + motion + "\"\nfrequency = { values = [\"" + frequency + R"("] }
[[step.force]]
at = "b:end"
force = ["100 N", "0 N", "0 N"]
[output]
report = false
)";
}

double thrust_of(const whirl::test::DeckRun& r) { return r.csv("push_response.csv").last().at("bearing L force x [N]"); }

}  // namespace

TEST(HarmonicLimits, AxialForceOnAFreeShaftIsAnError) {
  const whirl::test::DeckRun r(deck("", "10 Hz", "all"));
  EXPECT_EQ(r.exit, 3);
  EXPECT_TRUE(r.says("nothing resists axial motion of shaft 'hp'")) << r.log;
}

TEST(HarmonicLimits, ThrustBearingCarriesIt) {
  const whirl::test::DeckRun still(deck("kxx = \"1e7 N/m\"", "0 Hz", "axial"));
  ASSERT_EQ(still.exit, 0) << still.log;
  EXPECT_NEAR(thrust_of(still), 100, 1e-9);
  // at 10 Hz the mass m on the thrust bearing k, the shaft itself stiff: 100/(1 - m w^2/k), bar within 1e-4 of it
  const whirl::test::DeckRun slow(deck("kxx = \"1e7 N/m\"", "10 Hz", "all"));
  ASSERT_EQ(slow.exit, 0) << slow.log;
  const double m = 7850 * 3.14159265 * 0.04 * 0.04 / 4 * 0.6, w = 20 * 3.14159265;
  EXPECT_NEAR(thrust_of(slow), 100 / (1 - m * w * w / 1e7), 0.01);
}

TEST(HarmonicLimits, NoNumberWhereNothingResists) {   // the free twist at 0 Hz
  const whirl::test::DeckRun r(deck("kxx = \"1e7 N/m\"", "0 Hz", "all"));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(std::isnan(thrust_of(r)));
}
