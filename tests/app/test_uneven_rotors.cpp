// Rotors that are not the same across two diameters: couplings, blades, slotted rolls. Where they are
// unstable, and what weight and misalignment shake at twice the speed.
#include "deck_run.hpp"
#include "flat_rotor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

using std::numbers::pi;
using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

const std::string no_report = "[output]\nreport = false\n";

/// Beam of 2 m without mass, E I 1.442e5 and 1.03e5 N m2, 100 kg in the middle, damped by 200 N s/m.
std::string slotted_roll(const std::string& parts) {
  return R"(format = 1
[[material]]
name = "light"
E = "206 GPa"
G = "79 GPa"
density = "1e-3 kg/m^3"
[shaft]
name = "roll"
material = "light"
shear = "none"
[[shaft.section]]
name = "a"
length = "2000 mm"
min_elements = 2
general = { A = "3000 mm^2", Iy = "5e5 mm^4", Iz = "7e5 mm^4", J = "1.2e6 mm^4", kappa_y = 0.85, kappa_z = 0.85 }
[[disk]]
name = "shell"
at = "a:mid"
mass = "100 kg"
Ip = "2 kg.m^2"
Id = "1.5 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "B"
at = "a:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "air"
at = "a:mid"
type = "linear"
cyy = "200 N.s/m"
czz = "200 N.s/m"
[[unbalance]]
at = "shell"
amount = "5000 g.mm"
phase = "30 deg"
[[probe]]
name = "p"
at = "shell"
)" + no_report +
         parts;
}

struct TwoCircles {
  double mean, twice;  ///< m
};

/// In axes that turn with the shaft the weight turns backwards: (K - m W^2 + c W J - m W^2 + i W (c + 2 m W
/// J)) q = m g (i, -1), J a quarter turn; forward and backward circles of q are the second multiple and the
/// mean in fixed axes.
TwoCircles of_weight(double W) {
  using Complex = std::complex<double>;
  constexpr double E = 206e9, length = 2, m = 100, c = 200, g = 9.80665;
  const double k = 48 * E / std::pow(length, 3);
  const Complex i(0, 1);
  const Complex a = k * 7e-7 - 2 * m * W * W + i * W * c, b = k * 5e-7 - 2 * m * W * W + i * W * c,
                across = c * W + i * W * 2.0 * m * W;
  const Complex fy = m * g * i, fz = -m * g, det = a * b + across * across;
  const Complex y = (fy * b + across * fz) / det, z = (a * fz - across * fy) / det;
  return {std::abs(std::conj(y) + i * std::conj(z)) / 2, std::abs(y + i * z) / 2};
}

/// A body carried by a coupling of 3e6 and 1e6 N/m across.
const std::string on_a_coupling = R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "a"
[[shaft.section]]
name = "al"
length = "200 mm"
rigid = true
[[shaft]]
name = "b"
origin = ["200 mm", "0 mm", "0 mm"]
[[shaft.section]]
name = "bl"
length = "200 mm"
rigid = true
[[disk]]
name = "A"
at = "al:mid"
mass = "50 kg"
Ip = "1 kg.m^2"
Id = "0.6 kg.m^2"
[[disk]]
name = "B"
at = "bl:start"
mass = "30 kg"
Ip = "0.3 kg.m^2"
Id = "0.2 kg.m^2"
[[bearing]]
name = "BA"
at = "al:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "BA2"
at = "al:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "BB"
at = "bl:start"
type = "linear"
kxx = "1e8 N/m"
cxx = "1e3 N.s/m"
krr = "1e6 N.m/rad"
crr = "100 N.m.s/rad"
[[bearing]]
name = "cpl"
at = "al:end"
to = "bl:start"
type = "coupling"
krxx = "1e6 N.m/rad"
crxx = "50 N.m.s/rad"
kyy = "3e6 N/m"
kzz = "1e6 N/m"
[[unbalance]]
at = "B"
amount = "10 g.mm"
[[probe]]
name = "p"
at = "B"
)" + no_report;

/// A body with moments of inertia 1.2, 2.2, 1.2 kg m2 on a tilting spring.
const std::string two_blades = R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
[[shaft.section]]
name = "link"
length = "200 mm"
rigid = true
[[disk]]
name = "two blades"
at = "link:mid"
mass = "30 kg"
inertia = ["1.2 kg.m^2", "2.2 kg.m^2", "1.2 kg.m^2", "0 kg.m^2", "0 kg.m^2", "0 kg.m^2"]
[[bearing]]
name = "B"
at = "link:mid"
type = "linear"
kxx = "1e8 N/m"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "1e4 N.s/m"
czz = "1e4 N.s/m"
krr = "2e5 N.m/rad"
)" + no_report;

std::string stability(const char* from, const char* to) {
  return fmt::format(
      "[[step]]\nname = \"s\"\ntype = \"stability\"\n"
      "speed = {{ start = \"{} rpm\", stop = \"{} rpm\", points = 11 }}\n",
      from, to);
}

}  // namespace

// Half of what a slotted roll is asked about: its weight at half the critical speed, 437 times its
// unbalance.
TEST(UnevenRotors, WeightShakesASlottedRollAtTwiceTheSpeed) {
  const DeckRun d(slotted_roll(R"([[bearing]]
name = "stop"
at = "a:mid"
type = "rub"
gap = "4 mm"
stiffness = "1e7 N/m"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["300 rpm", "410 rpm", "500 rpm"] }
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("u_multiples.csv");
  ASSERT_EQ(t.rows.size(), 3u);
  for (const std::vector<double>& cells : t.rows) {
    const std::map<std::string, double> row = t.named(cells);
    const TwoCircles right = of_weight(row.at("speed [rpm]") * pi / 30);
    EXPECT_NEAR(row.at("p 2x forward [m]") / right.twice, 1, 2e-3);
    EXPECT_NEAR(std::hypot(row.at("p mean y [m]"), row.at("p mean z [m]")) / right.mean, 1, 2e-3);
    EXPECT_LT(row.at("p 2x backward [m]"), 1e-3 * right.twice);
  }
  EXPECT_TRUE(d.says("at twice the speed 6.8")) << d.log;
  EXPECT_TRUE(d.says("W11")) << d.log;  // of the stop, which the first multiple is far from
}

// Half the critical speed lies between the speeds of the range: it is among those looked at.
TEST(UnevenRotors, HalfTheCriticalSpeedIsLookedAt) {
  const DeckRun d(slotted_roll(R"([[step]]
name = "u"
type = "unbalance_response"
speed = { start = "300 rpm", stop = "500 rpm", points = 3 }
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  double most = 0, right = 0;
  const Columns t = d.csv("u_multiples.csv");
  for (const std::vector<double>& cells : t.rows)
    most = std::max(most, cells[t.column("p 2x forward [m]")]);
  for (double rpm = 300; rpm < 500; rpm += 0.1)
    right = std::max(right, of_weight(rpm * pi / 30).twice);
  EXPECT_NEAR(most / right, 1, 2e-3);
}

// On supports that are unequal too, against the motion itself.
TEST(UnevenRotors, MultiplesAreThoseOfTheMotion) {
  std::string deck = slotted_roll(R"([[bearing]]
name = "side"
at = "a:mid"
type = "linear"
kyy = "2e5 N/m"
kyz = "5e4 N/m"
cyy = "2000 N.s/m"
czz = "1000 N.s/m"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["-430 rpm"] }
[[step]]
name = "t"
type = "transient"
duration = "2.5 s"
initial_speed = "-430 rpm"
[[drive]]
step = "t"
at = "a:start"
type = "speed"
speed = "-430 rpm"
)");
  deck.replace(deck.find(no_report), no_report.size(), no_report + "every = \"1 ms\"\n");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  const double W = -430 * pi / 30;
  const Columns t = d.csv("t.csv");
  const int turns = 5;
  const double last = t.last().at("t [s]"), from = last - turns * 2 * pi / std::abs(W);
  std::complex<double> forward = 0, backward = 0, mean = 0;
  double weight = 0;
  for (const std::vector<double>& cells : t.rows) {
    const std::map<std::string, double> row = t.named(cells);
    const double time = row.at("t [s]");
    if (time < from) continue;
    const std::complex<double> r(row.at("p.y [m]"), row.at("p.z [m]")), i(0, 1);
    const double x = (time - from) / (last - from), hann = std::pow(std::sin(pi * x), 2);
    forward += hann * r * std::exp(-2.0 * i * W * time);
    backward += hann * r * std::exp(2.0 * i * W * time);
    mean += hann * r;
    weight += hann;
  }
  const auto u = d.csv("u_multiples.csv").last();
  EXPECT_NEAR(u.at("p 2x forward [m]") / std::abs(forward / weight), 1, 5e-3);
  EXPECT_NEAR(u.at("p 2x backward [m]") / std::abs(backward / weight), 1, 5e-3);
  EXPECT_NEAR(u.at("p mean z [m]") / mean.imag() * weight, 1, 5e-3);
}

TEST(UnevenRotors, ACouplingThatIsUnequalAcrossHasItsBand) {
  const DeckRun d(on_a_coupling + stability("500", "5000") +
                  "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n"
                  "speed = { values = [\"2000 rpm\"] }\n");
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto band = d.csv("s_bands.csv").last();
  EXPECT_NEAR(band.at("from [rpm]"), std::sqrt(1e6 / 30) * 30 / pi, 0.01);
  EXPECT_NEAR(band.at("to [rpm]"), std::sqrt(3e6 / 30) * 30 / pi, 0.01);
  EXPECT_TRUE(d.says("W13")) << d.log;
  const DeckRun linear(on_a_coupling +
                       "[[step]]\nname = \"t\"\ntype = \"transient\"\nduration = \"1 ms\"\n"
                       "initial_speed = \"100 rpm\"\nlinear = true\n");
  EXPECT_EQ(linear.exit, 3);
  EXPECT_TRUE(linear.says("the stiffness of coupling 'cpl' turns with its shafts")) << linear.log;
}

// k = (Jy - Jx) W^2: the blades swing out.
TEST(UnevenRotors, TwoBladesAreUnstableAboveTheirSpeed) {
  const DeckRun d(two_blades + stability("1000", "6000") +
                  "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"3000 rpm\"\n");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(d.csv("s_bands.csv").last().at("from [rpm]"), std::sqrt(2e5) * 30 / pi, 0.01);
  EXPECT_FALSE(d.says("s: stable")) << d.log;
  EXPECT_TRUE(d.says("growth in bands of speed not excluded")) << d.log;
}

// A zone is that of the largest motion over the operating speeds, peaks between the speeds included.
TEST(UnevenRotors, ZonesKnowThePeaksBetweenTheSpeeds) {
  const DeckRun d(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "r"
[[shaft.section]]
name = "link"
length = "200 mm"
rigid = true
[[disk]]
name = "wheel"
at = "link:mid"
mass = "20 kg"
Ip = "0.05 kg.m^2"
Id = "0.03 kg.m^2"
[[bearing]]
name = "B"
at = "link:mid"
type = "linear"
kxx = "1e6 N/m"
kyy = "2e6 N/m"
kzz = "3e6 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
krr = "1e5 N.m/rad"
crr = "10 N.m.s/rad"
[[unbalance]]
at = "wheel"
amount = "80 g.mm"
[[probe]]
name = "p"
at = "wheel"
[[step]]
name = "u"
type = "unbalance_response"
speed = { values = ["1000 rpm", "2000 rpm", "4000 rpm", "5000 rpm"] }
operating_speed = ["2700 rpm", "3200 rpm"]
zones = {}
)" + no_report);
  ASSERT_EQ(d.exit, 0) << d.log;
  const auto zone = d.csv("u_zones.csv").last();
  const auto peak = d.csv("u_peaks.csv").last();
  EXPECT_NEAR(zone.at("amplitude peak to peak [um]"), 2e6 * peak.at("amplitude [m]"), 1e-3);
  EXPECT_NEAR(zone.at("speed [rpm]"), 3021.6, 0.1);
}

namespace {

/// A two-pole rotor, whose body is a seventh softer across one diameter in each direction, on supports that are
/// unequal too and damp hardly at all.
std::string two_pole_rotor(int elements, const std::string& speed) {
  const std::string bearing =
      "type = \"linear\"\nkyy = \"3e8 N/m\"\nkzz = \"6e8 N/m\"\ncyy = \"200 N.s/m\"\nczz = \"200 "
      "N.s/m\"\n";
  return fmt::format("format = 1\n[model.mesh]\nmin_elements_per_section = {}\n", elements) +
         R"([[shaft]]
name = "gen"
material = "steel"
[[shaft.section]]
name = "j1"
length = "300 mm"
od = "200 mm"
[[shaft.section]]
name = "body"
length = "1800 mm"
general = { A = "90000 mm^2", Iy = "7.5e8 mm^4", Iz = "5.5e8 mm^4", J = "1.2e9 mm^4", kappa_y = 0.85, kappa_z = 0.85 }
[[shaft.section]]
name = "j2"
length = "300 mm"
od = "200 mm"
[[unbalance]]
at = "body:mid"
amount = "5000 g.mm"
phase = "30 deg"
[[probe]]
name = "m"
at = "body:mid"
[[bearing]]
name = "A"
at = "j1:mid"
kxx = "1e8 N/m"
)" + bearing +
         "[[bearing]]\nname = \"B\"\nat = \"j2:mid\"\n" + bearing +
         "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n" + speed + no_report;
}

double at_twice_the_speed(const DeckRun& d) {
  const Columns t = d.csv("u_multiples.csv");
  double most = 0;
  for (const std::vector<double>& cells : t.rows)
    most =
        std::max(most, cells[t.column("m 2x forward [m]")] + cells[t.column("m 2x backward [m]")]);
  return most;
}

}  // namespace

// At both edges of its first band it bends out, from 5136.92 to 5247.32 rpm by the Floquet multipliers of another
// program; the lower edge, which lies within the separation margin, is a peak of a few rpm.
TEST(UnevenRotors, PeaksDoNotDependOnThePoints) {
  std::vector<double> twice;
  for (const int points : {12, 30}) {
    const DeckRun d(two_pole_rotor(
        2, fmt::format("speed = {{ start = \"500 rpm\", stop = \"6000 rpm\", points = {} }}\n"
                       "operating_speed = [\"4000 rpm\", \"4100 rpm\"]\n",
                       points)));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_TRUE(d.says("no bound at 5136.92, 5247.32 rpm")) << d.log;
    EXPECT_TRUE(d.says("unstable from 5136.92 to 5247.32 rpm")) << d.log;
    EXPECT_TRUE(d.says("1 separation margin FAILED")) << d.log;
    EXPECT_FALSE(d.says("W17")) << d.log;
    twice.push_back(at_twice_the_speed(d));
  }
  EXPECT_NEAR(twice[0] / twice[1], 1, 1e-6);
}

// Harmonic balance of Timoshenko elements in another program: 14.7607 mm at 3191.4 rpm with two elements a
// section, 14.7725 at 3189.9 with eight. The peak is half a rpm wide, the points 100 and 31 rpm apart.
TEST(UnevenRotors, TheirPeakAtTwiceTheSpeedIsSolvedFor) {
  std::vector<double> twice;
  for (const int points : {5, 14})
    twice.push_back(at_twice_the_speed(DeckRun(two_pole_rotor(
        8, fmt::format("speed = {{ start = \"3000 rpm\", stop = \"3400 rpm\", points = {} }}\n",
                       points)))));
  EXPECT_NEAR(twice[0] / twice[1], 1, 1e-6);
  EXPECT_NEAR(twice[0], 14.7725e-3, 1e-3 * 14.7725e-3);
}

// Nothing damps what the weight shakes.
TEST(UnevenRotors, TheirPeakAtTwiceTheSpeedMayHaveNoBound) {
  std::string deck = slotted_roll(
      "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n"
      "speed = { start = \"300 rpm\", stop = \"500 rpm\", points = 3 }\n");
  const std::size_t air = deck.find("[[bearing]]\nname = \"air\"");
  deck.erase(air, deck.find("[[unbalance]]") - air);
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("at twice the speed without bound at 4")) << d.log;
  EXPECT_TRUE(d.says("at a multiple of the speed has no bound")) << d.log;
}

// Magnets may drive motions faster than those that are looked at: the same is said of a wheel whose inertia turns
// as of a round one.
TEST(UnevenRotors, GrowthThatIsNotExcludedIsSaid) {
  const auto magnet = [](const std::string& place) {
    return "[[bearing]]\nat = \"" + place + R"pid("
type = "magnetic"
current_stiffness = "300 N/A"
bias_current = "5 A"
gap = "0.5 mm"
amplifier_bandwidth = "2 kHz"
[[bearing.control]]
type = "pid"
p = "3e4 A/m"
i = "2e5 A/(m.s)"
d = "50 A.s/m"
lag = "30 us"
)pid";
  };
  for (const std::string across : {"0.5", "0.4"}) {
    const DeckRun d(
        "format = 1\n" + no_report +
        "[model]\ngravity = \"0 m/s^2\"\n[model.mesh]\nmin_elements_per_section = 1\n" +
        R"([shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 100, 60], ["b", 300, 80], ["c", 300, 80], ["d", 100, 60]]
[[unbalance]]
at = "b:end"
amount = "100 g.mm"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
[[disk]]
name = "disk"
at = "b:end"
mass = "60 kg"
)" +
        fmt::format(
            "inertia = [\"0.8 kg.m^2\", \"0.5 kg.m^2\", \"{} kg.m^2\", \"0 kg.m^2\", \"0 kg.m^2\", "
            "\"0 kg.m^2\"]\n",
            across) +
        magnet("a:end") + magnet("d:start") +
        "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = [\"3000 "
        "rpm\"] }\n");
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_TRUE(d.says("growth above 4040 Hz not excluded")) << d.log;
  }
}

// An asymmetric shaft on unequal supports has three bands of parametric instability, where the sum of two
// frequencies is twice the speed: 1400 to 1476, 1579 to 1645 and 1754 to 1815 rpm by the Floquet multipliers
// of its two equations of motion. No speed of a coarse list lies in the first and the last.
TEST(UnevenRotors, BandsBetweenTheSpeedsAreFound) {
  const auto deck = [](int points) {
    const std::string section =
        "length = \"500 mm\"\nshear = \"none\"\nod = \"30 mm\"\nmin_elements = 2\ngeneral = { A = "
        "\"700 "
        "mm^2\", Iy = \"40000 mm^4\", Iz = \"30000 mm^4\", J = \"70000 mm^4\", kappa_y = 0.85, "
        "kappa_z = "
        "0.85 }\n";
    return fmt::format(R"(format = 1
{}[model]
gravity = "0 m/s^2"
[[material]]
name = "light"
E = "200 GPa"
G = "77 GPa"
density = "1 kg/m^3"
[[shaft]]
name = "R"
material = "light"
[[shaft.section]]
name = "a"
{}[[shaft.section]]
name = "b"
{}[[disk]]
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
type = "linear"
kyy = "1.2e5 N/m"
kzz = "3.6e5 N/m"
cyy = "10 N.s/m"
czz = "10 N.s/m"
[[step]]
name = "s"
type = "stability"
speed = {{ start = "500 rpm", stop = "4000 rpm", points = {} }}
)",
                       no_report, section, section, points);
  };
  const DeckRun coarse(deck(8));
  const DeckRun fine(deck(64));
  ASSERT_EQ(coarse.exit, 0) << coarse.log;
  const auto bands_of = [](const DeckRun& r) {
    std::vector<double> out;
    const whirl::io::Value summary = r.summary("s");
    for (const whirl::io::Value& b : summary.at("bands").items())
      for (const char* end : {"from [rpm]", "to [rpm]"})
        out.push_back(b.at(end).number());
    return out;
  };
  const std::vector<double> found = bands_of(coarse), expected = bands_of(fine);
  ASSERT_EQ(found.size(), 6u) << coarse.log;
  ASSERT_EQ(expected.size(), 6u) << fine.log;
  const double floquet[] = {1400, 1476, 1579, 1645, 1754, 1815};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(found[k], expected[k], 1e-4 * expected[k]);
    EXPECT_NEAR(found[k], floquet[k], 1.0);
  }
}

// A controller's integral is held by no stiffness: the count of negative ones ended in a search without end.
TEST(UnevenRotors, StandInMagneticBearingsWithAnIntegrator) {
  const auto bearing = [](const std::string& name, const std::string& place) {
    return "[[bearing]]\nname = \"" + name + "\"\nat = \"" + place + R"pid("
type = "magnetic"
angle = "45 deg"
current_stiffness = "200 N/A"
position_stiffness = "8e5 N/m"
amplifier_bandwidth = "1.8 kHz"
[[bearing.control]]
type = "pid"
p = "1.2e4 A/m"
i = "4e4 A/(m.s)"
d = "20 A.s/m"
lag = "0.4 ms"
)pid";
  };
  const DeckRun r("format = 1\n" + no_report +
                  "[model]\ngravity = \"0 m/s^2\"\n[model.mesh]\nmin_elements_per_section = 1\n" +
                  R"([shaft]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 100, 50], ["b", 400, 55], ["c", 100, 50]]
[[disk]]
name = "w"
at = "b:mid"
mass = "15 kg"
inertia = ["0.15 kg.m^2", "0.08 kg.m^2", "0.09 kg.m^2", "0 kg.m^2", "0 kg.m^2", "0 kg.m^2"]
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "2e6 N/m"
kzz = "2e6 N/m"
)" + bearing("A", "a:end") +
                  bearing("B", "b:end") + R"([[step]]
name = "s"
type = "stability"
speed = { values = ["2000 rpm", "2500 rpm"] }
)");
  EXPECT_EQ(r.exit, 0) << r.log;
  EXPECT_TRUE(r.says("certified at")) << r.log;
}

// Bands that the speeds asked for do not separate: what lay between them was called unstable. By Floquet's
// multipliers (the monodromy of twelve modes) it decays between the first two. Few speeds and many find the same.
TEST(UnevenRotors, BandsWithStableRangesBetweenThemAreApart) {
  const auto bands = [](int points) {
    const DeckRun d(fmt::format(R"(format = 1
[model.mesh]
min_elements_per_section = 2
[[shaft]]
name = "gen"
material = "steel"
[[shaft.section]]
name = "j1"
length = "300 mm"
od = "200 mm"
rigid = true
[[shaft.section]]
name = "body"
length = "1800 mm"
general = {{ A = "90000 mm^2", Iy = "7.5e8 mm^4", Iz = "5.5e8 mm^4", J = "1.2e9 mm^4", kappa_y = 0.85, kappa_z = 0.85 }}
[[shaft.section]]
name = "j2"
length = "300 mm"
od = "200 mm"
rigid = true
[[bearing]]
at = "j1:mid"
type = "linear"
kxx = "1e8 N/m"
kyy = "3e8 N/m"
kzz = "6e8 N/m"
cyy = "200 N.s/m"
czz = "200 N.s/m"
[[bearing]]
at = "j2:mid"
type = "linear"
kyy = "3e8 N/m"
kzz = "6e8 N/m"
cyy = "200 N.s/m"
czz = "200 N.s/m"
[[step]]
name = "s"
type = "stability"
speed = {{ start = "500 rpm", stop = "6000 rpm", points = {} }}
modes = 4
)",
                                points));
    EXPECT_EQ(d.exit, 0) << d.log;
    return d.csv("s_bands.csv");
  };
  const Columns few = bands(5), many = bands(30);
  ASSERT_EQ(few.rows.size(), 2u);
  ASSERT_EQ(many.rows.size(), 2u);
  EXPECT_LT(few.rows[0][few.column("to [rpm]")] + 300, few.rows[1][few.column("from [rpm]")]);
  for (std::size_t k = 0; k < 2; ++k)
    for (const char* edge : {"from [rpm]", "to [rpm]"})
      EXPECT_NEAR(few.rows[k][few.column(edge)], many.rows[k][many.column(edge)], 1.0);
}

// A band of one motion goes on as that of another, weaker: 6756.1 to 7394.4 rpm, by a model of its own in axes
// that turn (+ 0.015 1/s at 6800 and 7300 rpm). Edges were speeds that had been looked at, 6825 and 7208.8.
TEST(UnevenRotors, EdgesOfABandAreWhereNothingGrows) {
  for (const int points : {14, 18, 20}) {
    const DeckRun r(whirl::test::flat_rotor(
        2, 1, 60,
        fmt::format(
            "[[step]]\nname = \"s\"\ntype = \"stability\"\nabout = \"undeformed\"\nspeed = {{ "
            "start = \"300 rpm\", stop = \"9000 rpm\", points = {} }}\n",
            points)));
    ASSERT_EQ(r.exit, 0) << r.log;
    const auto bands = r.csv("s_bands.csv").rows;
    ASSERT_EQ(bands.size(), 2u) << points;
    EXPECT_NEAR(bands[1].at(0), 6756.06, 0.5) << points;
    EXPECT_NEAR(bands[1].at(1), 7394.38, 0.5) << points;
  }
}

// At rest a flat shaft would roll under its weight, with next to nothing against it: it does not while it bends.
TEST(UnevenRotors, AtRestLateralModesAreThoseOfAllMotion) {
  const auto modes = [](const char* motion) {
    const DeckRun r(whirl::test::flat_rotor(
        4, 2, 0,
        fmt::format("[model]\ngravity = \"9.81 m/s^2\"\n[[step]]\nname = \"m\"\ntype = "
                    "\"modal\"\nspeed = \"0 rpm\"\nmodes = 4\nmotion = \"{}\"\n",
                    motion)));
    EXPECT_EQ(r.exit, 0) << r.log;
    const auto rows = r.csv("m_modes.csv").rows;
    std::vector<double> found;
    for (const auto& row : rows)
      if (row.at(4) > 1) found.push_back(row.at(4));  // rolling is slow
    return std::pair(found.at(0), found.at(1));
  };
  const auto lateral = modes("lateral"), all = modes("all");
  EXPECT_GT(all.second / all.first, 1.1);
  EXPECT_NEAR(lateral.first / all.first, 1.0, 1e-6);
  EXPECT_NEAR(lateral.second / all.second, 1.0, 1e-6);
}

namespace {

/// A rigid rotor of 1 m on two bearings of 1e7 and 6e6 N/m and 20 N s/m, its disk of 50 kg in the middle: it
/// shifts and tilts, and neither knows of the other.
std::string tilting_rotor(double Jy, double Jz, const std::string& speed) {
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "bar"
[[shaft.section]]
name = "left"
length = "500 mm"
rigid = true
[[shaft.section]]
name = "right"
length = "500 mm"
rigid = true
[[disk]]
name = "D"
at = "left:end"
mass = "50 kg"
inertia = ["3 kg.m^2", "{} kg.m^2", "{} kg.m^2", "0 kg.m^2", "0 kg.m^2", "0 kg.m^2"]
[[bearing]]
name = "A"
at = "left:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e7 N/m"
kzz = "6e6 N/m"
cyy = "20 N.s/m"
czz = "20 N.s/m"
[[bearing]]
name = "B"
at = "right:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "6e6 N/m"
cyy = "20 N.s/m"
czz = "20 N.s/m"
[[step]]
name = "s"
type = "stability"
speed = {}
)",
                     Jy, Jz, speed) +
         no_report;
}

/// Growth of its tilt, 1/s, by the angular momentum over half a turn: with tilts b about y and z and the momentum
/// H = I(theta) b' + Jx W (b_z, -b_y), H' = -K b - C b'.
double growth_of_tilt(double Jy, double Jz, double W) {
  constexpr double Jx = 3.0, C = 10.0;
  constexpr std::array<double, 2> K{3e6, 5e6};
  using State = std::array<double, 4>;
  const auto rate = [&](double t, const State& x) {
    const double c = std::cos(W * t), s = std::sin(W * t);
    const double yy = Jy * c * c + Jz * s * s, zz = Jy * s * s + Jz * c * c, yz = (Jy - Jz) * c * s;
    const double hy = x[2] - Jx * W * x[1], hz = x[3] + Jx * W * x[0];
    const double det = yy * zz - yz * yz;
    const double by = (zz * hy - yz * hz) / det, bz = (yy * hz - yz * hy) / det;
    return State{by, bz, -K[0] * x[0] - C * by, -K[1] * x[1] - C * bz};
  };
  constexpr int steps = 4000;
  const double period = pi / W, h = period / steps;
  std::array<State, 4> turned{};  // columns
  for (std::size_t k = 0; k < 4; ++k) {
    State x{};
    x[k] = 1.0;
    const auto moved = [&](const State& v, double by) {
      State y = x;
      for (std::size_t i = 0; i < 4; ++i)
        y[i] += by * v[i];
      return y;
    };
    for (int n = 0; n < steps; ++n) {
      const double t = n * h;
      const State a = rate(t, x), b = rate(t + 0.5 * h, moved(a, 0.5 * h)),
                  c = rate(t + 0.5 * h, moved(b, 0.5 * h)), d = rate(t + h, moved(c, h));
      for (std::size_t i = 0; i < 4; ++i)
        x[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
    }
    turned[k] = x;
  }
  // the largest multiplier, by squaring again and again
  double growth = 0.0, weight = 1.0;
  for (int n = 0; n < 40; ++n) {
    double size = 0.0;
    for (const State& x : turned)
      for (const double v : x)
        size = std::max(size, std::abs(v));
    for (State& x : turned)
      for (double& v : x)
        v /= size;
    growth += weight * std::log(size);
    weight *= 0.5;
    const std::array<State, 4> m = turned;
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t i = 0; i < 4; ++i) {
        turned[k][i] = 0.0;
        for (std::size_t j = 0; j < 4; ++j)
          turned[k][i] += m[j][i] * m[k][j];
      }
  }
  return growth / period;
}

}  // namespace

// Nothing is displaced where the rotor stands: growth was left out with the copies of other motions, and the
// rotor certified not to grow.
TEST(UnevenRotors, TiltAboutTheMiddleGrows) {
  const DeckRun first(
      tilting_rotor(4.5, 5.5, R"({ values = ["6400 rpm", "6500 rpm", "6600 rpm"] })"));
  ASSERT_EQ(first.exit, 0) << first.log;
  const Columns growth = first.csv("s_growth.csv");
  ASSERT_GE(growth.rows.size(), 3u);
  bool seen = false;
  for (const auto& row : growth.rows) {
    const double W = row[0] * pi / 30;
    // shift dies by c/m, tilt by what the momentum says
    const double right = std::max(growth_of_tilt(4.5, 5.5, W), -20.0 / 50.0);
    EXPECT_NEAR(row[1], right, 1e-4 * std::abs(right)) << row[0];
    seen = seen || right > 1.0;
  }
  EXPECT_TRUE(seen);
  const DeckRun second(
      tilting_rotor(4.0, 6.0, R"({ start = "8200 rpm", stop = "11500 rpm", points = 6 })"));
  ASSERT_EQ(second.exit, 0) << second.log;
  const Columns bands = second.csv("s_bands.csv");
  ASSERT_EQ(bands.rows.size(), 2u) << second.log;
  for (const double edge : {bands.rows[0][0], bands.rows[0][1], bands.rows[1][0]}) {
    const double below = growth_of_tilt(4.0, 6.0, edge * pi / 30 * (1 - 1e-5)),
                 above = growth_of_tilt(4.0, 6.0, edge * pi / 30 * (1 + 1e-5));
    EXPECT_LT(below * above, 0.0) << edge;
  }
}

// Between the speeds asked for, and a tenth of their distance from where the mean inertia places the resonance.
TEST(UnevenRotors, ABandThatWhatVariesHasMovedIsFound) {
  const DeckRun d(tilting_rotor(4.0, 6.0, R"({ values = ["6000 rpm", "6500 rpm", "7000 rpm"] })"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns bands = d.csv("s_bands.csv");
  ASSERT_EQ(bands.rows.size(), 1u) << d.log;
  for (const double edge : {bands.rows[0][0], bands.rows[0][1]})
    EXPECT_LT(growth_of_tilt(4.0, 6.0, edge * pi / 30 * (1 - 1e-5)) *
                  growth_of_tilt(4.0, 6.0, edge * pi / 30 * (1 + 1e-5)),
              0.0)
        << edge;
}
