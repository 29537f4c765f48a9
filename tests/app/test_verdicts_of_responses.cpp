// What a response and a stability step say of growth: neither what the mesh makes up nor silence about
// what was not looked at.
#include "deck_run.hpp"
#include "sealed_rotor.hpp"

using whirl::test::DeckRun;

namespace {

std::string two_disks(const std::string& support, const std::string& steps,
                      const std::string& mesh = "") {
  return R"(format = 1
[output]
report = false
[model]
gravity = "0 m/s^2"
)" + mesh +
         R"([[shaft]]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["l1", 80, 45], ["l2", 260, 60], ["l3", 300, 70], ["l4", 200, 60], ["l5", 120, 45]]
[[disk]]
name = "d1"
at = "l2:end"
od = "280 mm"
id = "60 mm"
width = "40 mm"
material = "steel"
[[disk]]
name = "d2"
at = "l5:end"
mass = "12 kg"
Ip = "0.09 kg.m^2"
Id = "0.055 kg.m^2"
[[bearing]]
name = "A"
at = "l1:mid"
type = "linear"
kyy = "3e7 N/m"
kzz = "2e7 N/m"
cyy = "4e3 N.s/m"
czz = "3e3 N.s/m"
[[unbalance]]
at = "d1"
amount = "10 g.mm"
)" + support +
         steps;
}

std::string with_stage(const std::string& k) {
  return R"([[bearing]]
name = "B"
at = "l4:end"
type = "linear"
kyy = "2.5e7 N/m"
kzz = "2.5e7 N/m"
cyy = "4e3 N.s/m"
czz = "4e3 N.s/m"
[[bearing]]
name = "S"
at = "l3:mid"
type = "cross_coupling"
k = ")" + k +
         "\"\n";
}

const std::string response = R"([[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["4200 rpm"] }
)";

/// Its controller's phase is too late at 2 kHz, above the corner of its amplifier.
const std::string magnetic = R"D([[bearing]]
name = "B"
at = "l4:end"
type = "magnetic"
current_stiffness = "250 N/A"
position_stiffness = "1.5e6 N/m"
amplifier_bandwidth = "1500 Hz"
sensor_bandwidth = "5 kHz"
delay = "40 us"
angle = "45 deg"
[[bearing.control]]
type = "pid"
p = "2.5e4 A/m"
i = "2e5 A/(m.s)"
d = "60 A.s/m"
lag = "100 us"
)D";

}  // namespace

// Seven elements made a root at 6304 Hz that grew by 0.12 1/s, and W13 of it; the rotor has no mode there
// (5343 and 7411 Hz on a fine mesh, both damped). A stage too strong is unstable on every mesh.
TEST(VerdictsOfResponses, AModeOfTheMeshIsNoGrowthOfTheRotor) {
  const DeckRun sound(two_disks(with_stage("3e5 N/m"), response));
  ASSERT_EQ(sound.exit, 0) << sound.log;
  EXPECT_FALSE(sound.says("W13")) << sound.log;
  EXPECT_TRUE(sound.says("growth above 6303.7 Hz not excluded")) << sound.log;
  EXPECT_NEAR(sound.summary("u").at("growth not excluded above [Hz]").number(), 6303.7, 1.0);
  const DeckRun strong(two_disks(with_stage("3e7 N/m"), response));
  EXPECT_TRUE(strong.says("W13")) << strong.log;
}

// The list ended at the corner of the amplifier, 1.5 kHz, and nothing was said of what lies above;
// "stable at the first speed" was true beside "certified": false.
TEST(VerdictsOfResponses, AControllerIsUnstableAboveItsCorner) {
  const DeckRun d(two_disks(magnetic, response + R"([[step]]
name = "s"
type = "stability"
speed = { start = "3000 rpm", stop = "6000 rpm", points = 4 }
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("W13")) << d.log;
  EXPECT_TRUE(d.says("s: unstable at 3000 rpm already")) << d.log;
  EXPECT_FALSE(d.summary("s").at("stable at the first speed").boolean());
}

// Where growth at high frequencies is not excluded a summary must not say that the rotor is stable.
TEST(VerdictsOfResponses, WhatIsNotCertifiedIsNotCalledStable) {
  const DeckRun d(two_disks(with_stage("3e5 N/m"), response + R"([[step]]
name = "s"
type = "stability"
speed = { values = ["3000 rpm", "4000 rpm"] }
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("W13")) << d.log;
  EXPECT_TRUE(d.says("no growth found from 3000 to 4000 rpm")) << d.log;
  EXPECT_TRUE(d.summary("s").at("stable at the first speed").is_null()) << d.log;
  EXPECT_FALSE(d.summary("u").at("growth not excluded above [Hz]").is_null());
}

// A table drives the whirl at 2100 rpm and neither below nor above: k/(2 m w) - c/(2 m) = 2.4 1/s.
TEST(VerdictsOfResponses, SpeedsOfTheListAndRowsOfTablesAreLookedAt) {
  const auto deck = [](const std::string& speeds) {
    return R"(format = 1
[output]
report = false
[model]
gravity = "0 m/s^2"
[shaft]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 30], ["b", 500, 30]]
[[disk]]
name = "d"
at = "a:end"
mass = "20 kg"
Ip = "0.1 kg.m^2"
Id = "0.05 kg.m^2"
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "b:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "dash"
at = "d"
type = "table"
interpolation = "linear"
extrapolate = "hold"
columns = ["speed[rpm]", "kyz[N/m]", "kzy[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [[0, 0, 0, 50, 50], [2000, 0, 0, 50, 50], [2100, 2e4, -2e4, 50, 50], [2200, 0, 0, 50, 50], [9000, 0, 0, 50, 50]]
[[unbalance]]
at = "d"
amount = "100 g.mm"
[[step]]
name = "u"
type = "unbalance_response"
speed = )" +
           speeds + "[[step]]\nname = \"h\"\ntype = \"harmonic_response\"\nspeed = " + speeds +
           "[[step.force]]\nat = \"d\"\nforce = [\"0 N\", \"1 N\", \"0 N\"]\n";
  };
  for (const char* speeds : {"{ values = [\"1000 rpm\", \"2100 rpm\", \"3000 rpm\"] }\n",
                             "{ start = \"1000 rpm\", stop = \"3000 rpm\", points = 40 }\n"}) {
    const DeckRun r(deck(speeds));
    ASSERT_EQ(r.exit, 0) << r.log;
    EXPECT_TRUE(r.says("warning[W13]: step 'u': the rotor is unstable at 2100 rpm")) << r.log;
    EXPECT_TRUE(r.says("warning[W13]: step 'h': the rotor is unstable at 2100 rpm")) << r.log;
  }
  const DeckRun beside(deck("{ values = [\"1000 rpm\", \"1900 rpm\"] }\n"));
  EXPECT_FALSE(beside.says("W13")) << beside.log;
}

// Whirl driven at one row of a table, between the speeds asked for: eigenvalues at 5000 rpm + 7.41 + 316.8 i.
TEST(VerdictsOfResponses, RowsOfTablesBetweenTheSpeedsOfAStabilityStepAreLookedAt) {
  const DeckRun r(whirl::test::sealed_rotor(
      50,
      "[1000, 1e6, 1e6, 0, 0, 2000, 2000], [4000, 1e6, 1e6, 5e4, -5e4, 2000, 2000], "
      "[5000, 1e6, 1e6, 9e5, -9e5, 2000, 2000], [6000, 1e6, 1e6, 6e4, -6e4, 2000, 2000], "
      "[8000, 1e6, 1e6, 6e4, -6e4, 2000, 2000]",
      "[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = { values = [\"1000 rpm\", \"4000 "
      "rpm\", "
      "\"8000 rpm\"] }\n"));
  ASSERT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(r.says("instability above 47")) << r.log;
  EXPECT_TRUE(r.says("stable again above 52")) << r.log;
  EXPECT_EQ(r.csv("s_verdicts.csv").rows.size(), 5u);
}
