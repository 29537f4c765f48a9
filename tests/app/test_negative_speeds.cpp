// Speeds below zero: the rotor turns the other way, and everything that is said of it has the same
// size. Unequal supports without cross-coupling: the machine at -Omega is its mirror image at Omega.
#include "deck_run.hpp"

#include <algorithm>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

std::string rotor(const std::string& steps) {
  return R"(format = 1
[output]
report = false
[[shaft]]
name = "r"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 30], ["b", 500, 30]]
[[disk]]
name = "d"
at = "a:end - 100 mm"
mass = "5 kg"
Ip = "0.05 kg.m^2"
Id = "0.03 kg.m^2"
[[unbalance]]
at = "d"
amount = "20 g.mm"
phase = "30 deg"
[[probe]]
name = "p"
at = "d"
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e6 N/m"
kzz = "2e6 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
[[bearing]]
name = "R"
at = "b:end"
type = "linear"
kyy = "1e6 N/m"
kzz = "2e6 N/m"
cyy = "500 N.s/m"
czz = "500 N.s/m"
)" + steps;
}

std::vector<double> column(const Columns& csv, const std::string& name) {
  std::vector<double> out;
  for (const auto& row : csv.rows)
    out.push_back(row[csv.column(name)]);
  return out;
}

}  // namespace

// A diagram from -6000 to 6000 rpm said "0 critical speeds".
TEST(NegativeSpeeds, CampbellFindsTheCriticalSpeedsOfBothSenses) {
  const auto diagram = [](const char* start, const char* stop) {
    return rotor(std::string("[[step]]\nname = \"c\"\ntype = \"campbell\"\nmodes = 6\nspeed = "
                             "{ start = \"") +
                 start + "\", stop = \"" + stop + "\", points = 9 }\n");
  };
  const DeckRun forth(diagram("0 rpm", "6000 rpm"));
  ASSERT_EQ(forth.exit, 0) << forth.log;
  const std::vector<double> known = column(forth.csv("c_critical_speeds.csv"), "speed [rpm]");
  ASSERT_GE(known.size(), 2u);
  const DeckRun through(diagram("-6000 rpm", "6000 rpm"));
  ASSERT_EQ(through.exit, 0) << through.log;
  const std::vector<double> both = column(through.csv("c_critical_speeds.csv"), "speed [rpm]");
  ASSERT_EQ(both.size(), 2 * known.size());
  for (std::size_t k = 0; k < known.size(); ++k) {
    EXPECT_NEAR(both[known.size() - 1 - k], -known[k], 1e-6 * known[k]);
    EXPECT_NEAR(both[known.size() + k], known[k], 1e-6 * known[k]);
  }
  const DeckRun back(diagram("-6000 rpm", "-60 rpm"));
  ASSERT_EQ(back.exit, 0) << back.log;
  EXPECT_EQ(column(back.csv("c_critical_speeds.csv"), "speed [rpm]").size(), known.size());
}

// The amplification factor of a peak below zero was negative, which made it "critically damped": no
// separation margin was asked for.
TEST(NegativeSpeeds, PeaksMarginsAndZones) {
  const auto response = [](const char* start, const char* stop) {
    return rotor(
        std::string("[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\noperating_speed = "
                    "[\"1500 rpm\", \"3000 rpm\"]\nzones = {}\nspeed = { start = \"") +
        start + "\", stop = \"" + stop + "\", points = 9 }\n");
  };
  const DeckRun forth(response("500 rpm", "6000 rpm")), back(response("-6000 rpm", "-500 rpm"));
  ASSERT_EQ(forth.exit, 0) << forth.log;
  ASSERT_EQ(back.exit, 0) << back.log;
  for (const auto& [file, name] : {std::pair{"u_peaks.csv", "amplification factor [-]"},
                                   {"u_peaks.csv", "amplitude [m]"},
                                   {"u_margins.csv", "required [%]"},
                                   {"u_margins.csv", "actual [%]"},
                                   {"u_zones.csv", "amplitude peak to peak [um]"}}) {
    std::vector<double> one = column(forth.csv(file), name);
    std::vector<double> other = column(back.csv(file), name);
    std::sort(one.begin(), one.end());
    std::sort(other.begin(), other.end());
    ASSERT_EQ(one.size(), other.size()) << file;
    ASSERT_GE(one.size(), 1u) << file;
    for (std::size_t k = 0; k < one.size(); ++k)
      EXPECT_NEAR(other[k], one[k], 1e-4 * std::abs(one[k])) << file << " " << name;
  }
  EXPECT_GT(column(back.csv("u_peaks.csv"), "amplification factor [-]").front(), 2.5);
}

// Material damping makes it whirl beyond its onset, whichever way it turns; the fastest speed of a range
// below zero is its first.
TEST(NegativeSpeeds, GrowthIsLookedForAtTheFastestSpeed) {
  const auto damped = [](const std::string& speeds) {
    std::string text = rotor("[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { " +
                             speeds + ", points = 12 }\n");
    const std::string material = "material = \"steel\"\n";
    return text.insert(text.find(material) + material.size(),
                       "damping = { internal_beta = \"2e-3 s\" }\n");
  };
  const DeckRun forth(damped("start = \"100 rpm\", stop = \"20000 rpm\"")),
      back(damped("start = \"-20000 rpm\", stop = \"-100 rpm\""));
  EXPECT_TRUE(forth.says("the rotor is unstable at ")) << forth.log;
  EXPECT_TRUE(back.says("the rotor is unstable at -")) << back.log;
}
