// What the analyses in the frequency domain are about: the state, the kind of motion, the numbers
// of the modes; the critical map.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// A shaft of 6 m that sags by 10 mm under its weight, free to shorten: both planes are alike.
std::string sagging(const std::string& steps) {
  return R"(format = 1
[model]
mesh = { min_elements_per_section = 20 }
[shaft]
material = "steel"
columns = ["length[m]", "od[mm]"]
rows = [[6, 100]]
[[bearing]]
name = "left"
at = "0 m"
type = "linear"
kxx = "1e9 N/m"
kyy = "1e9 N/m"
kzz = "1e9 N/m"
[[bearing]]
name = "right"
at = "6 m"
type = "linear"
kyy = "1e9 N/m"
kzz = "1e9 N/m"
[output]
report = false
)" + steps;
}

std::string modal(const std::string& name, const std::string& keys) {
  return "[[step]]\nname = \"" + name + "\"\ntype = \"modal\"\nshapes = 0\n" + keys;
}

std::vector<double> frequencies(const DeckRun& run, const std::string& step) {
  const Columns t = run.csv(step + "_modes.csv");
  std::vector<double> out;
  for (const auto& row : t.rows)
    out.push_back(row[t.column("frequency [Hz]")]);
  return out;
}

}  // namespace

// Held along its axis the sagged shaft would have to stretch as it bends in its plane: 5.966 Hz
// there instead of 5.640.
TEST(LateralMotion, SaggedShaftBendsWithoutStretching) {
  const DeckRun run(sagging(modal("lateral", "modes = 6\nmotion = \"lateral\"\n") +
                            modal("all", "modes = 6\nmotion = \"all\"\n")));
  ASSERT_EQ(run.exit, 0) << run.log;
  const std::vector<double> lateral = frequencies(run, "lateral"), all = frequencies(run, "all");
  ASSERT_EQ(lateral.size(), 6u);
  EXPECT_NEAR(lateral[0], 5.640, 5e-4);
  // planes differ by the square of the sag over the length, 3e-6, times small integers
  EXPECT_NEAR(lateral[1], lateral[0], 3e-4 * lateral[0]);
  // axial and torsional inertia left out: the square of 5.6 Hz over 215 Hz and more, times that of
  // the slope of the sag
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(lateral[k], all[k], 1e-4 * all[k]) << k;
}

// A shaft that is free along its axis and about it has no lateral mode of that.
TEST(LateralMotion, FreeMotionsAlongAndAboutTheAxisAreNoModes) {
  const std::string deck =
      sagging(modal("free", "modes = 4\nmotion = \"lateral\"\nspeed = \"300 rpm\"\n"));
  std::string soft = deck;
  soft.replace(soft.find("kxx = \"1e9 N/m\""), 15, "kxx = \"1e-3 N/m\"");
  const DeckRun held(deck);
  ASSERT_EQ(held.exit, 0) << held.log;
  const std::vector<double> expected = frequencies(held, "free");
  const DeckRun run(soft);
  ASSERT_EQ(run.exit, 0) << run.log;
  const std::vector<double> found = frequencies(run, "free");
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_NEAR(found[k], expected[k], 1e-5 * expected[k]) << k;
}

TEST(LateralMotion, CriticalMapOfTheSaggedShaft) {
  const DeckRun run(sagging(R"([[step]]
name = "map"
type = "critical_map"
stiffness_min = "1e8 N/m"
stiffness_max = "1e9 N/m"
points = 2
max_speed = "600 rpm"
backward = true
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns t = run.csv("map_critical_map.csv");
  ASSERT_EQ(t.names.size(), 3u) << run.log;  // both planes
  EXPECT_NEAR(t.rows.at(1)[1], 338.35, 0.06);
  EXPECT_NEAR(t.rows.at(1)[2], 338.46, 0.06);
  // what its list is worth
  EXPECT_TRUE(run.summary("map").at("certificate").at("counted at each stiffness").boolean());
  EXPECT_TRUE(run.says("counted at each")) << run.log;
}

// What a step is about stands in the summary and on the terminal, and a deck chooses.
TEST(LinearisedAbout, IsSaidAndChosen) {
  const DeckRun run(sagging(
      modal("sag", "modes = 2\nspeed = \"300 rpm\"\n") +
      modal("straight", "modes = 2\nspeed = \"300 rpm\"\nabout = \"undeformed\"\n") + R"([[step]]
name = "c"
type = "critical_speeds"
max_speed = "500 rpm"
about = "undeformed"
)"));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_EQ(run.summary("sag").at("linearised").text(), "about the static equilibrium at 300 rpm");
  EXPECT_EQ(run.summary("straight").at("linearised").text(), "about the undeformed rotor");
  EXPECT_EQ(run.summary("c").at("linearised").text(), "about the undeformed rotor");
  EXPECT_TRUE(run.says("about the static equilibrium at 300 rpm")) << run.log;
  EXPECT_TRUE(run.says("about the undeformed rotor")) << run.log;
  // pinned straight beam of 6 m by Euler-Bernoulli: pi/2 sqrt(EI/(rho A))/L^2; shear and rotary
  // inertia take 1e-3, the supports 1e-4
  const double straight = frequencies(run, "straight").at(1), sag = frequencies(run, "sag").at(1);
  const Columns material = run.csv("straight_modes.csv");
  EXPECT_GT(std::abs(straight - sag), 1e-6 * sag);  // the sag matters, if little
  EXPECT_NEAR(straight, sag, 1e-2 * sag);
}

// Films have no coefficients without their load.
TEST(LinearisedAbout, UndeformedFilmIsAnError) {
  const DeckRun run(R"(format = 1
[shaft]
material = "steel"
columns = ["length[m]", "od[mm]"]
rows = [[1, 50]]
[[bearing]]
name = "film"
at = "0 m"
type = "short_journal"
diameter = "50 mm"
length = "20 mm"
clearance = "50 um"
viscosity = "0.02 Pa.s"
[[bearing]]
name = "other"
at = "1 m"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
[[step]]
name = "m"
type = "modal"
about = "undeformed"
)");
  EXPECT_EQ(run.exit, 3) << run.log;
  EXPECT_TRUE(run.says("E26")) << run.log;
  EXPECT_TRUE(run.says("film")) << run.log;
}

namespace {

std::string map_deck(const std::string& bearings, const std::string& more = {}) {
  return R"(format = 1
[[material]]
name = "steel"
E = "210 GPa"
density = "7850 kg/m^3"
[[shaft]]
name = "s"
material = "steel"
[[shaft.section]]
name = "a"
length = "1 m"
od = "50 mm"
min_elements = 8
[[disk]]
name = "d"
at = "a:end"
mass = "20 kg"
Ip = "0.3 kg.m^2"
Id = "0.2 kg.m^2"
[output]
report = false
)" + bearings +
         R"([[step]]
name = "map"
type = "critical_map"
stiffness_min = "1e6 N/m"
stiffness_max = "1e9 N/m"
points = 4
max_speed = "30000 rpm"
)" + more;
}

const std::string two_supports = R"([[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
krr = "2e5 N.m/rad"
[[bearing]]
name = "B"
at = "a:mid"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
krr = "2e5 N.m/rad"
)";

}  // namespace

// Tables and linear bearings of the same coefficients have the same map, tilting stiffness
// included: 1740 rpm at 1e7 N/m. A thrust bearing and a stop carry nothing laterally and are not
// varied. (The mesh shares an element's mass with a support of constant stiffness in another way
// than with a table: 4e-5 of the highest critical speeds here.)
TEST(CriticalMap, KeepsEveryStiffnessButTheOneVaried) {
  const std::string linear = map_deck(two_supports);
  const std::string table = map_deck(R"([[bearing]]
name = "A"
at = "a:start"
type = "table"
columns = ["speed[rpm]", "kxx[N/m]", "kyy[N/m]", "kzz[N/m]", "krr[N.m/rad]"]
rows = [[0, 1e8, 1e7, 1e7, 2e5], [40000, 1e8, 1e7, 1e7, 2e5]]
[[bearing]]
name = "B"
at = "a:mid"
type = "table"
columns = ["speed[rpm]", "kyy[N/m]", "kzz[N/m]", "krr[N.m/rad]"]
rows = [[0, 1e7, 1e7, 2e5], [40000, 1e7, 1e7, 2e5]]
)");
  const std::string apart = map_deck(R"([[bearing]]
name = "thrust"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
[[bearing]]
name = "tilt A"
at = "a:start"
type = "linear"
krr = "2e5 N.m/rad"
[[bearing]]
name = "tilt B"
at = "a:mid"
type = "linear"
krr = "2e5 N.m/rad"
[[bearing]]
name = "stop"
at = "a:end"
type = "rub"
gap = "5 mm"
stiffness = "1e8 N/m"
[[bearing]]
name = "A"
at = "a:start"
type = "linear"
kyy = "3e6 N/m"
kzz = "3e6 N/m"
[[bearing]]
name = "B"
at = "a:mid"
type = "linear"
kyy = "3e6 N/m"
kzz = "3e6 N/m"
)");
  std::vector<std::vector<double>> rows;
  for (const std::string& deck : {linear, table, apart}) {
    const DeckRun run(deck);
    ASSERT_EQ(run.exit, 0) << run.log;
    const Columns t = run.csv("map_critical_map.csv");
    EXPECT_NEAR(t.rows.at(1)[t.column("critical 1 [rpm]")], 1740.0, 1.0);
    if (rows.empty()) rows = t.rows;
    ASSERT_EQ(t.rows.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < rows[i].size(); ++j)
        if (!std::isnan(rows[i][j])) {
          EXPECT_NEAR(t.rows[i][j], rows[i][j], 1e-4 * rows[i][j]) << i << " " << j;
        }
  }
}

// Angular-contact bearings, whose lateral and tilting stiffness are coupled, at the lateral
// stiffness that the static step gives them: the map is at the critical speeds of the machine
// itself. (A mesh shares mass with a linear support in another way: 3e-5.)
TEST(CriticalMap, RollingBearingsAtTheirOwnStiffness) {
  const auto deck = [](const std::string& steps) {
    std::string text = R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
material = "steel"
columns = ["name", "length[m]", "od[mm]", "min_elements"]
rows = [["a", 0.3, 40, 4], ["b", 0.2, 40, 3]]
[[disk]]
at = "b:end"
mass = "8 kg"
Ip = "0.05 kg.m^2"
Id = "0.03 kg.m^2"
[output]
report = false
)";
    for (const auto& [name, at, side] :
         {std::array{"A", "a:start", "+x"}, std::array{"B", "a:end", "-x"}})
      text += fmt::format(
          "[[bearing]]\nname = \"{}\"\nat = \"{}\"\ndirection = \"{}\"\ntype = \"ball\"\nballs = "
          "12\nball_diameter = \"10 mm\"\n"
          "pitch_diameter = \"60 mm\"\ncontact_angle = \"25 deg\"\npreload = \"500 N\"\n",
          name, at, side);
    return text + steps;
  };
  double stiffness = 0;
  std::vector<double> own;
  {
    const DeckRun run(
        deck("[[step]]\nname = \"s\"\ntype = \"static\"\nspeed = \"20000 rpm\"\n[[step]]\nname = "
             "\"c\"\ntype = \"critical_speeds\"\n"
             "max_speed = \"20000 rpm\"\nmotion = \"lateral\"\nshapes = 0\n"));
    ASSERT_EQ(run.exit, 0) << run.log;
    stiffness = run.csv("s_rolling_stiffness.csv").rows.at(1).at(3);  // A, y, per y
    const Columns c = run.csv("c_undamped.csv");
    for (const auto& row : c.rows)
      own.push_back(row[c.column("speed [rpm]")]);
  }
  const DeckRun run(
      deck(fmt::format("[[step]]\nname = \"m\"\ntype = \"critical_map\"\nmax_speed = \"20000 "
                       "rpm\"\nbackward = true\npoints = 3\n"
                       "stiffness_min = \"{:.17g} N/m\"\nstiffness_max = \"{:.17g} N/m\"\n",
                       0.01 * stiffness, 100 * stiffness)));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns map = run.csv("m_critical_map.csv");
  ASSERT_EQ(own.size(), 2u);
  EXPECT_NEAR(map.rows.at(1)[map.column("backward 1 [rpm]")], own[0], 1e-4 * own[0]);
  EXPECT_NEAR(map.rows.at(1)[map.column("forward 1 [rpm]")], own[1], 1e-4 * own[1]);
  // softer supports never raise a critical speed: their stiffness stays definite
  for (const char* line : {"backward 1 [rpm]", "forward 1 [rpm]"}) {
    EXPECT_LT(map.rows.at(0)[map.column(line)], map.rows.at(1)[map.column(line)]);
    EXPECT_LT(map.rows.at(1)[map.column(line)], map.rows.at(2)[map.column(line)]);
  }
}

// Two rotors, one on supports that are varied, one on others: the critical speed of the second is a
// level line through which that of the first goes.
TEST(CriticalMap, LinesGoByShapeThroughCrossings) {
  const DeckRun run(map_deck(two_supports + R"([[shaft]]
name = "second"
material = "steel"
origin = ["0 m", "1 m", "0 m"]
columns = ["name", "length[m]", "od[mm]", "min_elements"]
rows = [["z", 1, 30, 6]]
[[bearing]]
name = "C"
at = "z:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "D"
at = "z:end"
type = "rigid"
directions = ["y", "z"]
)",
                             "bearings = [\"A\", \"B\"]\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns t = run.csv("map_critical_map.csv");
  // both criticals of the second rotor, 3654 and 14592 rpm, stay where they are at all stiffnesses;
  // numbered from below the higher one would jump where the first rotor's second passes it, at 3e7
  // N/m
  int level = 0;
  for (std::size_t j = 1; j < t.names.size(); ++j) {
    double low = infinity, high = -infinity;
    for (const auto& row : t.rows) {
      low = std::min(low, row[j]);
      high = std::max(high, row[j]);
    }
    bool whole = true;
    for (const auto& row : t.rows)
      whole = whole && !std::isnan(row[j]);
    level += whole && high - low < 1e-8 * high;
  }
  EXPECT_EQ(level, 2) << run.log;
}

// A stiffness between the supports that differs in y and z: modes turn forward at some stiffnesses
// and backward at others, and keep their line. At the highest stiffness the speeds are those of
// rigid supports.
TEST(CriticalMap, LinesAreWholeWhateverWayTheyTurn) {
  const std::string seal = two_supports + R"([[bearing]]
name = "seal"
at = "a:end"
type = "linear"
kyy = "6e6 N/m"
kzz = "2e6 N/m"
)";
  std::string deck = map_deck(seal, "bearings = [\"A\", \"B\"]\n");
  deck.replace(deck.find("points = 4"), 10, "points = 17");
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns t = run.csv("map_critical_map.csv");
  ASSERT_GE(t.names.size(), 4u) << run.log;
  std::size_t most = 0;
  for (const auto& row : t.rows) {
    std::size_t here = 0;
    for (std::size_t j = 1; j < row.size(); ++j)
      here += !std::isnan(row[j]);
    most = std::max(most, here);
  }
  EXPECT_EQ(most, t.names.size() - 1);  // no line takes over from another
  for (std::size_t j = 1; j < t.names.size(); ++j) {
    bool ended = false;
    double last = 0;
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
      const double speed = t.rows[i][j];
      if (std::isnan(speed)) {
        ended = ended || last > 0;
        continue;
      }
      EXPECT_FALSE(ended) << t.names[j] << " comes back at " << t.rows[i][0];
      EXPECT_GE(speed, last * (1 - 1e-9)) << t.names[j];
      // K0 + k B grows by no more than k
      if (last > 0) {
        EXPECT_LE(speed, last * std::sqrt(t.rows[i][0] / t.rows[i - 1][0]) * (1 + 1e-9));
      }
      last = speed;
    }
  }
}

// Numbers within a kind: "torsional 1" is the first torsional mode, wherever it stands in the list.
TEST(ModeNumbers, CountWithinTheirKind) {
  const auto start = [](const std::string& keys) {
    return map_deck(R"([[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
krr = "2e5 N.m/rad"
krxx = "1e5 N.m/rad"
[[probe]]
name = "P"
at = "d"
)",
                    "[[step]]\nname = \"modes\"\ntype = \"modal\"\nmodes = 8\n[[step]]\nname = "
                    "\"t\"\ntype = \"transient\"\nduration = \"1 ms\"\nstart = "
                    "\"mode\"\nmode_amplitude = \"0.01 mm\"\nlinear = true\n" +
                        keys);
  };
  const DeckRun run(start("mode_kind = \"torsional\"\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const io::Value modes = run.summary("modes").at("modes");
  int torsional = 0;
  for (const io::Value& m : modes.items()) {
    EXPECT_FALSE(m.at("damping ratio").is_null());
    if (m.at("kind").text() != "torsional") continue;
    EXPECT_EQ(m.at("label").text(), fmt::format("torsional {}", ++torsional));
  }
  EXPECT_GE(torsional, 1);
  // the twist of the first torsional mode moves no probe: the disk stays where the weight puts it
  const Columns twist = run.csv("t.csv");
  const DeckRun bent(start("mode_kind = \"lateral\"\n"));
  ASSERT_EQ(bent.exit, 0) << bent.log;
  const Columns bend = bent.csv("t.csv");
  const std::size_t y = bend.column("P.y [m]");
  const auto range = [&](const Columns& t) {
    double low = infinity, high = -infinity;
    for (const auto& row : t.rows) {
      low = std::min(low, row[y]);
      high = std::max(high, row[y]);
    }
    return high - low;
  };
  EXPECT_LT(range(twist), 1e-3 * range(bend));
}

// A hot shaft that is free to grow carries no force, nor does one under preload whose end is free;
// where both ends are held it does, about the undeformed rotor as about the equilibrium. The
// undeformed one took the force of a shaft that is not let grow for both: 26.5 Hz instead of 38.7.
TEST(LinearisedAbout, UndeformedShaftsAreInBalanceAlongTheirAxis) {
  const auto deck = [](const std::string& stress, const std::string& right) {
    return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "200 GPa"
nu = 0.3
density = "8000 kg/m^3"
expansion = "1.2e-5 1/K"
[[shaft]]
name = "r"
material = "m"
)" + stress +
           R"(columns = ["name", "length[mm]", "od[mm]"]
rows = [["b", 1500, 80]]
[[disk]]
at = "b:mid"
mass = "60 kg"
Ip = "1 kg.m^2"
Id = "0.6 kg.m^2"
[[bearing]]
name = "A"
at = "b:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
[[bearing]]
name = "B"
at = "b:end"
type = "linear"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
)" + right +
           "[output]\nreport = false\n" + modal("eq", "speed = \"3000 rpm\"\nmodes = 4\n") +
           modal("un", "speed = \"3000 rpm\"\nmodes = 4\nabout = \"undeformed\"\n");
  };
  const std::string hot = "temperature_rise = \"80 K\"\n", tight = "axial_preload = \"200 kN\"\n";
  const double cold = frequencies(DeckRun(deck("", "")), "eq")[0];
  for (const std::string& stress : {hot, tight}) {
    const DeckRun free(deck(stress, "")), held(deck(stress, "kxx = \"1e8 N/m\"\n"));
    const double eq = frequencies(free, "eq")[0], un = frequencies(free, "un")[0];
    EXPECT_NEAR(un, eq, 1e-6 * eq) << stress << free.log;
    EXPECT_NEAR(un, cold, 2e-3 * cold) << stress << "but for the change of its length";
    const auto a = frequencies(held, "eq"), b = frequencies(held, "un");
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k)
      EXPECT_NEAR(a[k], b[k], 1e-6 * a[k]) << stress << k;
    EXPECT_GT(std::abs(a[0] - cold), 2e-3 * cold) << stress;
  }
}
