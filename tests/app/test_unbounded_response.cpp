// Peaks that are poles: their height is where the search for it ends in rounding.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

std::string rotor(const std::string& of_shaft, double damping, const std::string& step) {
  const std::string bearing = fmt::format(
      "type = \"linear\"\nkyy = \"2e7 N/m\"\nkzz = \"2e7 N/m\"\ncyy = \"{0} N.s/m\"\nczz = \"{0} "
      "N.s/m\"\n",
      damping);
  return "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n[shaft]\nname = "
         "\"r\"\nmaterial = "
         "\"steel\"\n" +
         of_shaft +
         "[[disk]]\nname = \"d\"\nat = \"a:end\"\nmass = \"20 kg\"\nIp = \"0.4 kg.m^2\"\nId = "
         "\"0.2 kg.m^2\"\n" +
         "[[bearing]]\nat = \"a:start\"\n" + bearing + "[[bearing]]\nat = \"b:end\"\n" + bearing +
         "[[unbalance]]\nat = \"d\"\namount = \"100 g.mm\"\nphase = \"30 deg\"\n[[probe]]\nname = "
         "\"p\"\nat = "
         "\"d\"\n[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\n" +
         step;
}

const std::string round_shaft =
    "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 400, 50], [\"b\", 600, "
    "50]]\n";

std::string flat_shaft() {
  std::string s;
  for (const auto& [name, length] : {std::pair{"a", 400}, {"b", 600}})
    s += fmt::format(
        "[[shaft.section]]\nname = \"{}\"\nlength = \"{} mm\"\n[shaft.section.general]\nA = \"1963 "
        "mm^2\"\n"
        "Iy = \"3.0e5 mm^4\"\nIz = \"3.6e5 mm^4\"\nJ = \"6.1e5 mm^4\"\nkappa_y = 0.89\nkappa_z = "
        "0.89\n",
        name, length);
  return s;
}

std::vector<double> column(const Columns& c, const std::string& name) {
  std::vector<double> out;
  for (const auto& row : c.rows)
    out.push_back(row[c.column(name)]);
  return out;
}

}  // namespace

TEST(UnboundedResponse, OfAnUndampedRotorIsSaid) {
  double before = 0;
  for (const int points : {21, 34, 101}) {
    const DeckRun run(
        rotor(round_shaft, 0,
              fmt::format("speed = {{ start = \"500 rpm\", stop = \"5000 rpm\", points = {} }}\n",
                          points)));
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_TRUE(run.says("the response has no bound at")) << run.log;
    EXPECT_TRUE(run.says("without bound at")) << run.log;
    const Columns peaks = run.csv("u_peaks.csv");
    ASSERT_EQ(peaks.rows.size(), 1u) << run.log;
    EXPECT_TRUE(std::isnan(column(peaks, "amplitude [m]")[0]));
    EXPECT_TRUE(std::isnan(column(peaks, "amplification factor [-]")[0]));
    const double speed = column(peaks, "speed [rpm]")[0];
    if (before > 0) {
      EXPECT_NEAR(speed / before, 1.0, 1e-8);
    }
    before = speed;
  }
  const DeckRun critical(
      rotor(round_shaft, 0,
            "speed = { values = [\"500 rpm\"] }\n[[step]]\nname = \"c\"\ntype = "
            "\"critical_speeds\"\nmax_speed = \"5000 rpm\"\nmotion = \"lateral\"\n"));
  double nearest = 1.0;
  for (const double x : column(critical.csv("c_undamped.csv"), "speed [rpm]"))
    nearest = std::min(nearest, std::abs(x / before - 1.0));
  EXPECT_LT(nearest, 1e-6) << critical.log;
}

namespace {

/// 100 kg on 1e6 N/m: w = 100 rad/s, which points of these grids meet to the last digit.
std::string hundred_rad(const std::string& step) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[output]
report = false
[[shaft]]
name = "s"
[[shaft.section]]
name = "body"
length = "1 m"
rigid = true
[[disk]]
name = "d"
at = "body:mid"
mass = "100 kg"
Ip = "0.5 kg.m^2"
Id = "0.5 kg.m^2"
[[bearing]]
at = "body:mid"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
krr = "2e4 N.m/rad"
[[unbalance]]
at = "d"
amount = "100 g.mm"
[[probe]]
name = "p"
at = "d"
[[step]]
name = "u"
)" + step;
}

}  // namespace

// A point of the grid that is the resonance, inside it or at an end, hides nothing.
TEST(UnboundedResponse, APointOnTheResonanceIsSaid) {
  for (const std::string range :
       {"start = \"0 rad/s\", stop = \"200 rad/s\", points = 6",
        "start = \"0 rad/s\", stop = \"200 rad/s\", points = 7",
        "start = \"0 rad/s\", stop = \"100 rad/s\", points = 5",
        "start = \"100 rad/s\", stop = \"200 rad/s\", points = 5", "values = [\"100 rad/s\"]"}) {
    const DeckRun unbalance(
        hundred_rad("type = \"unbalance_response\"\noperating_speed = [\"1100 rpm\", \"1300 "
                    "rpm\"]\nspeed = { " +
                    range + " }\n"));
    ASSERT_EQ(unbalance.exit, 0) << unbalance.log;
    EXPECT_TRUE(unbalance.says("the response has no bound at 954.93 rpm"))
        << range << unbalance.log;
    EXPECT_TRUE(unbalance.says("1 separation margin FAILED")) << range << unbalance.log;
    EXPECT_FALSE(unbalance.says("not finite") || unbalance.says("is zero")) << unbalance.log;
    EXPECT_EQ(unbalance.csv("u_peaks.csv").rows.size(), 1u) << range;
    for (const double x : column(unbalance.csv("u_response.csv"), "p major [m]"))
      EXPECT_LT(x, 10.0) << range;
    const DeckRun harmonic(hundred_rad("type = \"harmonic_response\"\nfrequency = { " + range +
                                       " }\n[[step.force]]\nat = \"d\"\nforce = [\"0 N\", \"1 N\", "
                                       "\"0 N\"]\n"));
    ASSERT_EQ(harmonic.exit, 0) << harmonic.log;
    EXPECT_TRUE(harmonic.says("the response has no bound at 15.9155 Hz")) << range << harmonic.log;
    EXPECT_EQ(harmonic.csv("u_peaks.csv").rows.size(), 1u) << range;
  }
}

// The faintest damping bounds it: the amplitude is that of one mode, in proportion to 1/c.
TEST(UnboundedResponse, FaintDampingBoundsIt) {
  std::vector<double> size;
  for (const double c : {1.0, 10.0, 100.0}) {
    const DeckRun run(rotor(round_shaft, c,
                            "speed = { start = \"500 rpm\", stop = \"5000 rpm\", points = 34 }\n"));
    EXPECT_FALSE(run.says("no bound")) << run.log;
    size.push_back(column(run.csv("u_peaks.csv"), "amplitude [m]").at(0));
  }
  EXPECT_NEAR(size[0] / size[1], 10.0, 1e-3);
  EXPECT_NEAR(size[1] / size[2], 10.0, 1e-2);
}

// At an edge of its band an asymmetric rotor bends out.
TEST(UnboundedResponse, NoPeakStandsAtTheEdgeOfABand) {
  for (const int points : {41, 57}) {
    const DeckRun run(
        rotor(flat_shaft(), 2e3,
              fmt::format("speed = {{ start = \"1000 rpm\", stop = \"4000 rpm\", points = {} }}\n",
                          points)));
    ASSERT_EQ(run.exit, 0) << run.log;
    const Columns peaks = run.csv("u_peaks.csv");
    for (const double a : column(peaks, "amplitude [m]"))
      EXPECT_TRUE(std::isnan(a) || a < 0.1) << a << run.log;
  }
}

namespace {

std::string cracked_rotor(double loss, const std::string& speed) {
  const std::string bearing =
      "type = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = \"6e7 N/m\"\nkzz = \"4e7 N/m\"\ncyy = \"1e4 "
      "N.s/m\"\nczz = \"1e4 "
      "N.s/m\"\n";
  return "format = 1\n[output]\nreport = false\n[[shaft]]\nname = \"r\"\nmaterial = "
         "\"steel\"\ncolumns = [\"name\", "
         "\"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 500, 50], [\"b\", 100, 60], [\"c\", 600, "
         "50]]\n[[disk]]\nname "
         "= \"w\"\nat = \"b:end\"\nmass = \"40 kg\"\nIp = \"0.6 kg.m^2\"\nId = \"0.32 "
         "kg.m^2\"\n[[bearing]]\nat = "
         "\"a:start\"\n" +
         bearing + "[[bearing]]\nat = \"c:end\"\n" + bearing +
         "[[probe]]\nname = \"p\"\nat = \"b:start\"\n[[crack]]\nat = \"a:end - 60 mm\"\nto = "
         "\"a:end "
         "- 20 "
         "mm\"\nloss = " +
         fmt::format("{}", loss) +
         "\nbreathing = \"mayes\"\n[[unbalance]]\nat = \"w\"\namount = \"200 "
         "g.mm\"\n[[step]]\nname "
         "= \"u\"\ntype = \"unbalance_response\"\nspeed = " +
         speed + "\n";
}

}  // namespace

// A speed without a periodic motion is a row without numbers, not the end of the step.
TEST(UnboundedResponse, SpeedsWithoutAMotionLeaveTheOthersTheirRows) {
  const DeckRun run(cracked_rotor(0.3, "{ values = [\"900 rpm\", \"2500 rpm\", \"6000 rpm\"] }"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns response = run.csv("u_response.csv");
  for (const double asked : {900.0, 2500.0, 6000.0}) {
    bool there = false;
    for (const auto& row : response.rows)
      there = there || (std::abs(row[0] - asked) < 1e-6 &&
                        std::isfinite(row[response.column("p major [m]")]));
    EXPECT_TRUE(there) << asked << run.log;
  }
}

// The ends of the speeds without one are peaks, however far apart the points are: margins are held against them.
TEST(UnboundedResponse, NoBoundIsWhereMotionsEnd) {
  std::string deck =
      cracked_rotor(0.1, "{ start = \"1800 rpm\", stop = \"2000 rpm\", points = 3 }");
  const std::string along = "kxx = \"1e8 N/m\"\n";
  deck.erase(deck.rfind(along), along.size());
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("no bound at 1891.7")) << run.log;
  std::vector<double> ends;
  const Columns peaks = run.csv("u_peaks.csv");
  for (const auto& row : peaks.rows)
    if (std::isnan(row[peaks.column("amplitude [m]")]))
      ends.push_back(row[peaks.column("speed [rpm]")]);
  ASSERT_GE(ends.size(), 2u) << run.log;
  EXPECT_NEAR(ends.front(), 1891.76, 0.1);  // of the band that W13 names
  EXPECT_NEAR(ends.back(), 1893.26, 0.1);
}

// The same under forces of a shaker: two wheels on a spring, twisted at the frequency that they have.
TEST(UnboundedResponse, OfUndampedShakenRotorsIsSaid) {
  const std::string text =
      "format = 1\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = \"t\"\nmaterial = \"steel\"\n"
      "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 1000, 50]]\n"
      "[[disk]]\nname = \"f\"\nat = \"t:start\"\nmass = \"20 kg\"\nIp = \"0.5 kg.m^2\"\nId = \"0.3 "
      "kg.m^2\"\n[[disk]]\nname = \"g\"\nat = \"t:end\"\nmass = \"20 kg\"\nIp = \"0.5 kg.m^2\"\nId "
      "= "
      "\"0.3 kg.m^2\"\n[[bearing]]\nat = \"t:start\"\ntype = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = "
      "\"1e8 N/m\"\nkzz = \"1e8 N/m\"\n[[bearing]]\nat = \"t:end\"\ntype = \"linear\"\nkyy = \"1e8 "
      "N/m\"\nkzz = \"1e8 N/m\"\n[[probe]]\nname = \"f\"\nat = \"f\"\n[[step]]\nname = \"h\"\ntype "
      "= "
      "\"harmonic_response\"\nrotor_speed = \"3000 rpm\"\nfrequency = { start = \"10 Hz\", stop = "
      "\"200 Hz\", points = 50 }\n[[step.force]]\nat = \"f\"\n";
  for (const char* force :
       {"moment = [\"1 N.m\", \"0 N.m\", \"0 N.m\"]\n", "force = [\"0 N\", \"1 N\", \"0 N\"]\n"}) {
    const DeckRun run(text + force);
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_TRUE(run.says("warning[W13]: step 'h': the response has no bound at")) << run.log;
    EXPECT_TRUE(run.says("without bound at")) << run.log;
    const Columns peaks = run.csv("h_peaks.csv");
    ASSERT_GE(peaks.rows.size(), 1u);
    for (const double amplitude :
         column(peaks, "amplitude [" + std::string(force[0] == 'm' ? "rad" : "m") + "]"))
      EXPECT_TRUE(std::isnan(amplitude)) << run.log;
    // GJ/L (1/I1 + 1/I2) with the shaft's own inertia left out of the closed form
    if (force[0] == 'm') {
      EXPECT_NEAR(column(peaks, "frequency [Hz]")[0], 70.8, 0.1);
    }
  }
}

// A shaft that is not straight moves its stations as soon as it turns at all: as much at 0 rpm as at 1.
TEST(UnboundedResponse, SlowRollBeginsAtRest) {
  const auto deck = [](const char* start) {
    return std::string(
               "format = 1\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = \"r\"\nmaterial = "
               "\"steel\"\nbow = { amount = \"30 um\" }\ncolumns = [\"name\", \"length[mm]\", "
               "\"od[mm]\"]\nrows = [[\"a\", 250, 50], [\"b\", 500, 50], [\"c\", 250, 50]]\n"
               "[[disk]]\nname = \"w\"\nat = \"c:end\"\nmass = \"20 kg\"\nIp = \"0.2 kg.m^2\"\nId "
               "= "
               "\"0.12 kg.m^2\"\n[[bearing]]\nat = \"a:end\"\ntype = \"linear\"\nkyy = \"2e6 "
               "N/m\"\nkzz "
               "= \"2e6 N/m\"\ncyy = \"3e3 N.s/m\"\nczz = \"3e3 N.s/m\"\n[[bearing]]\nat = "
               "\"b:end\"\n"
               "type = \"linear\"\nkyy = \"2e6 N/m\"\nkzz = \"2e6 N/m\"\ncyy = \"3e3 N.s/m\"\nczz "
               "= "
               "\"3e3 N.s/m\"\n[[probe]]\nname = \"p\"\nat = \"a:start\"\n[[step]]\nname = "
               "\"u\"\ntype "
               "= \"unbalance_response\"\nspeed = { start = \"") +
           start + "\", stop = \"2000 rpm\", points = 40 }\n";
  };
  const DeckRun rest(deck("0 rpm")), slow(deck("1 rpm"));
  ASSERT_EQ(rest.exit, 0) << rest.log;
  ASSERT_EQ(slow.exit, 0) << slow.log;
  const Columns response = rest.csv("u_response.csv");
  // 30 um (sin(pi x/L) - sin(pi/4)) at x = 0
  EXPECT_NEAR(column(response, "p major [m]")[0], 30e-6 * std::sqrt(0.5), 1e-10);
  for (const auto& row : response.rows)
    for (const double x : row)
      EXPECT_TRUE(std::isfinite(x));
  const Columns peaks = rest.csv("u_peaks.csv"), expected = slow.csv("u_peaks.csv");
  ASSERT_EQ(peaks.rows.size(), expected.rows.size());
  EXPECT_NEAR(column(peaks, "speed [rpm]")[0], column(expected, "speed [rpm]")[0], 1e-3);
}
