// What grows stands in a list of modes wherever the roots were counted, beyond the frequencies that
// were asked for as well.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

using whirl::test::DeckRun;

// 10 kg on 1e6 N/m: 50.3 Hz. 1e5 N/m of cross-coupling make it grow by 15.8 1/s, 1e3 N s/m of
// damping hold it.
TEST(GrowthBeyond, MaxFrequencyHidesNoGrowingMode) {
  const auto mode = [](const char* damping) {
    return whirl::test::lateral_mass(10, "0 m/s^2", std::string(R"([[bearing]]
name = "film"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
kyz = "1e5 N/m"
kzy = "-1e5 N/m"
cyy = ")") + damping + R"( N.s/m"
czz = ")" + damping + R"( N.s/m"
[[step]]
name = "m"
type = "modal"
modes = 4
speed = "6000 rpm"
max_frequency = "10 Hz"
[output]
report = false
)");
  };
  const DeckRun grows(mode("0"));
  ASSERT_EQ(grows.exit, 0) << grows.log;
  EXPECT_EQ(grows.summary("m").at("unstable modes").number(), 1) << grows.log;
  EXPECT_NEAR(grows.csv("m_modes.csv").last().at("frequency [Hz]"), 50.3, 0.3);
  const DeckRun decays(mode("1e3"));
  ASSERT_EQ(decays.exit, 0) << decays.log;
  EXPECT_EQ(decays.summary("m").at("unstable modes").number(), 0) << decays.log;
  EXPECT_TRUE(decays.csv("m_modes.csv").rows.empty());
}
