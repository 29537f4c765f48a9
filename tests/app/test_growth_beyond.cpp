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

// A list that goes on to a growing mode beyond its number leaves out none before it: its beginning and
// its labels are those of a longer list. Two masses on springs, 16 and 50 Hz, and one that
// cross-coupling drives at 159 Hz.
TEST(GrowthBeyond, AListHasNoHoles) {
  const auto deck = [](int modes) {
    std::string one = whirl::test::lateral_mass(10, "0 m/s^2", "");
    one.replace(one.find("[shaft]"), 7, "[[shaft]]");
    return one + R"([[shaft]]
name = "two"
material = "steel"
origin = ["0 m", "1 m", "0 m"]
columns = ["name", "length[mm]", "rigid"]
rows = [["fore", 100, true], ["aft", 100, true]]
[[disk]]
name = "second"
at = "fore:end"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
at = "second"
type = "rigid"
directions = ["x", "ry", "rz"]
[[bearing]]
name = "B1"
at = "mass"
type = "linear"
kyy = "1e5 N/m"
kzz = "1e6 N/m"
cyy = "10 N.s/m"
czz = "10 N.s/m"
[[bearing]]
name = "B2"
at = "second"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
kyz = "1e6 N/m"
kzy = "-1e6 N/m"
[[step]]
name = "m"
type = "modal"
speed = "6000 rpm"
shapes = 0
modes = )" +
           std::to_string(modes) + "\n[output]\nreport = false\n";
  };
  const DeckRun one(deck(1)), all(deck(4));
  ASSERT_EQ(one.exit, 0) << one.log;
  ASSERT_EQ(all.exit, 0) << all.log;
  EXPECT_EQ(one.summary("m").at("unstable modes").number(), 1) << one.log;
  const auto a = one.csv("m_modes.csv"), b = all.csv("m_modes.csv");
  const std::size_t f = b.column("frequency [Hz]");
  ASSERT_EQ(b.rows.size(), 4u);
  ASSERT_GE(a.rows.size(), 3u);
  for (std::size_t k = 0; k < a.rows.size(); ++k)
    EXPECT_NEAR(a.rows[k][f], b.rows[k][f], 1e-9 * b.rows[k][f]) << k;
  EXPECT_NEAR(b.rows[0][f], 15.9, 0.1);
  EXPECT_NEAR(b.rows[1][f], 50.3, 0.1);
  EXPECT_NEAR(b.rows[2][f], 159.2, 1.0);
}
