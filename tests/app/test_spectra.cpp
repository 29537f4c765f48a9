// What lists of modes and verdicts of stability say, through the program: complete beside a free
// spin, real roots judged, rounding no instability.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

std::vector<double> column(const Columns& table, const std::string& name) {
  std::vector<double> out;
  for (const auto& row : table.rows)
    out.push_back(row[table.column(name)]);
  return out;
}

/// A small shaft on two films, free to turn: the drag of the films slows its spin at 0.02 1/s.
std::string on_films(const std::string& extra) {
  return R"(format = 1
[output]
report = false
[[shaft]]
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 35, 5, 4], ["b", 35, 5, 4]]
[[disk]]
at = "a:end"
od = "20 mm"
id = "5 mm"
width = "5 mm"
material = "steel"
[[bearing]]
name = "thrust"
at = "a:mid"
type = "linear"
kxx = "1e6 N/m"
cxx = "1 N.s/m"
[[bearing]]
name = "A"
at = "a:start"
type = "short_journal"
diameter = "5 mm"
length = "2.5 mm"
clearance = "7.5 um"
viscosity = "0.2 mPa.s"
[[bearing]]
name = "B"
at = "b:end"
type = "short_journal"
diameter = "5 mm"
length = "2.5 mm"
clearance = "7.5 um"
viscosity = "0.2 mPa.s"
[[step]]
name = "m"
type = "modal"
speed = "60000 rpm"
modes = 14
shapes = 0
)" + extra;
}

std::string column_under(const std::string& force) {
  return R"(format = 1
[output]
report = false
[model]
gravity = "0 m/s^2"
[[material]]
name = "steel"
E = "210 GPa"
nu = 0.3
density = "7850 kg/m^3"
[shaft]
name = "column"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["column", 1000, 4, 20]]
[[bearing]]
at = "column:start"
type = "rigid"
directions = ["x", "y", "z", "ry", "rz"]
[[load]]
at = "column:end"
force = [")" +
         force + R"(", "0 N", "0 N"]
[[step]]
name = "m"
type = "modal"
modes = 4
shapes = 0
[[step]]
name = "s"
type = "stability"
speed = { start = "0 rpm", stop = "100 rpm", points = 3 }
)";
}

}  // namespace

TEST(Spectra, FilmsBesideAFreeSpinLoseNoMode) {
  // The same small motions without the free root: a soft spring holds the spin. Its lateral modes
  // are those of the free rotor to 1e-8, for the spring feels them only through the drag of the
  // films.
  const DeckRun free(on_films("")), held(on_films(R"([[bearing]]
name = "hold"
at = "a:start"
type = "linear"
krxx = "10 N.m/rad"
)"));
  ASSERT_EQ(free.exit, 0) << free.log;
  ASSERT_EQ(held.exit, 0) << held.log;
  EXPECT_TRUE(free.says("complete")) << free.log;
  const std::vector<double> a = column(free.csv("m_modes.csv"), "frequency [Hz]");
  std::vector<double> b = column(held.csv("m_modes.csv"), "frequency [Hz]");
  ASSERT_EQ(a.size(), 14u);
  EXPECT_TRUE(std::is_sorted(a.begin(), a.end()));
  // Lateral and axial ones; torsion itself the spring changes.
  for (const double f : {332.8758, 494.1965, 530.2474, 1062.984, 2561.617, 3117.252, 8234.979,
                         9301.024, 17953.80, 18247.34, 19802.66, 20473.17}) {
    const auto near = [f](double x) { return std::abs(x - f) < 1e-5 * f; };
    EXPECT_TRUE(std::any_of(a.begin(), a.end(), near)) << f;
    EXPECT_TRUE(std::any_of(b.begin(), b.end(), near)) << f;
  }
}

TEST(Spectra, ColumnBeyondItsEulerLoadDiverges) {
  // 1.2 times the Euler load: EI w'''' + P w'' + rho A s^2 w = 0, clamped and free under a dead
  // load, has one growing root, 8.556874 1/s, in each plane (the determinant of its four
  // conditions). Twenty elements and shear leave 1e-5.
  const DeckRun above(column_under("-7.8135816 N"));
  ASSERT_EQ(above.exit, 0) << above.log;
  const std::vector<double> rates = column(above.csv("m_real_roots.csv"), "rate [1/s]");
  const auto grows = [](double x) { return x > 0; };
  ASSERT_EQ(std::count_if(rates.begin(), rates.end(), grows), 2) << above.log;
  for (const double x : rates)
    if (grows(x)) {
      EXPECT_NEAR(x, 8.556874248, 2e-5 * 8.557);
    }
  EXPECT_TRUE(above.says("2 diverging")) << above.log;
  EXPECT_TRUE(above.says("unstable at 0 rpm already (a motion diverges")) << above.log;
  const DeckRun below(column_under("-5 N"));
  EXPECT_TRUE(below.says("stable from 0 to 100 rpm (certified")) << below.log;
}

TEST(Spectra, OnsetOfDivergenceIsLocated) {
  // A disk of 10 kg on springs of 1e6 N/m and a table that falls from 0 to -4e6 N/m between 0 and
  // 4000 rpm in z: K vanishes at 1000 rpm. Rigid, so the closed form is the table's own.
  const DeckRun d(R"(format = 1
[output]
report = false
[model]
gravity = "0 m/s^2"
mesh = { min_elements_per_section = 1 }
[[shaft]]
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 50, 100], ["b", 50, 100]]
[[bearing]]
name = "springs"
at = "a:end"
type = "linear"
kxx = "1e6 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
krr = "1e5 N.m/rad"
cyy = "100 N.s/m"
czz = "100 N.s/m"
[[bearing]]
name = "pull"
at = "a:end"
type = "table"
columns = ["speed[rpm]", "kyy[N/m]", "kzz[N/m]"]
rows = [[0, 0, 0], [4000, 0, -4e6]]
[[step]]
name = "s"
type = "stability"
speed = { start = "100 rpm", stop = "3900 rpm", points = 12 }
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns onset = d.csv("s_onset.csv");
  ASSERT_EQ(onset.rows.size(), 1u) << d.log;
  // What grows within the rounding of the matrices is neutral: that is 3e-4 rpm here.
  EXPECT_NEAR(onset.rows[0][onset.column("speed [rpm]")], 1000.0, 1e-3);
  EXPECT_EQ(onset.rows[0][onset.column("whirl frequency [Hz]")], 0.0);
  EXPECT_TRUE(d.says("diverging without whirl")) << d.log;
}

TEST(Spectra, RoundingIsNoInstability) {
  // An undamped shaft on undamped springs, turning: nothing dissipates, nothing grows, whatever the
  // last digits say.
  const DeckRun d(R"(format = 1
[output]
report = false
[[shaft]]
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 500, 50, 20], ["b", 500, 60, 20]]
[[disk]]
at = "a:end"
mass = "40 kg"
Ip = "0.5 kg.m^2"
Id = "0.3 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e7 N/m"
kzz = "2e7 N/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "2e7 N/m"
krxx = "1e3 N.m/rad"
[[step]]
name = "m"
type = "modal"
speed = "9000 rpm"
modes = 20
shapes = 0
[[step]]
name = "s"
type = "stability"
speed = { start = "0 rpm", stop = "12000 rpm", points = 13 }
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("unstable")) << d.log;
  EXPECT_TRUE(
      d.says("stable from 0 to 12000 rpm (certified at 13 speeds: all roots accounted for)"))
      << d.log;
  EXPECT_TRUE(d.csv("s_onset.csv").rows.empty());
}

namespace {

/// A disk in the middle of a shaft whose bearings differ: forward and backward critical speed stand
/// 3e-4 apart.
std::string nearly_isotropic(double stiffness, double mass, double damping,
                             const std::string& step) {
  char parameters[200];
  std::snprintf(parameters, sizeof parameters,
                "k = \"%.15g N/m\"\nm = \"%.15g kg\"\nc = \"%g N.s/m\"\n", stiffness, mass,
                damping);
  return std::string("format = 1\n[output]\nreport = false\n[parameters]\n") + parameters +
         R"([model]
gravity = "9.81 m/s^2"
[[material]]
name = "steel 7850"
E = "210 GPa"
nu = 0.3
density = "7850 kg/m^3"
[shaft]
name = "rotor"
material = "steel 7850"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 40], ["b", 500, 40]]
[[disk]]
at = "a:end"
mass = "${m}"
Ip = "0.4 kg.m^2"
Id = "0.2 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kyy = "${k}"
kzz = "${k}"
cyy = "${c}"
czz = "${c}"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "1e7 N/m"
kzz = "1e7 N/m"
cyy = "${c}"
czz = "${c}"
[[step]]
)" + step;
}

}  // namespace

// At these values the modes of the two, followed through the crossing, were lost (E77).
TEST(CriticalSpeeds, ForwardAndBackwardNearlyAtOneSpeed) {
  for (const auto& [k, m] :
       {std::pair{95931993.3527388, 31.9320275349431}, std::pair{63409656.265937, 29.6495962236838},
        std::pair{85981658.8739267, 29.0810370688051},
        std::pair{81287084.1187965, 29.1844538547032}}) {
    const std::string range =
        "name = \"c\"\ntype = \"critical_speeds\"\nmax_speed = \"8000 rpm\"\n";
    const DeckRun criticals(nearly_isotropic(k, m, 2e3, range));
    ASSERT_EQ(criticals.exit, 0) << criticals.log;
    const auto speeds = column(criticals.csv("c_undamped.csv"), "speed [rpm]");
    ASSERT_EQ(speeds.size(), 3u);
    for (const double speed : speeds) {
      char step[100];
      std::snprintf(
          step, sizeof step,
          "name = \"m\"\ntype = \"modal\"\nspeed = \"%.15g rpm\"\nmodes = 3\nshapes = 0\n", speed);
      // undamped, as the list; both steps, for which the mesh is chosen
      const DeckRun modes(nearly_isotropic(k, m, 0, range + "[[step]]\n" + step));
      ASSERT_EQ(modes.exit, 0) << modes.log;
      double off = 1;
      for (const double f : column(modes.csv("m_modes.csv"), "frequency [Hz]"))
        off = std::min(off, std::abs(60 * f / speed - 1));
      // the undamped list leaves out the even part of C, of the size of the sag's slope squared
      EXPECT_LT(off, 1e-5) << speed;
    }
    EXPECT_GT(speeds[1] / speeds[0] - 1, 1e-4);
  }
}

// The resolved deck of a run keeps what its stability map varies: it passes, and draws the same map.
TEST(Spectra, ResolvedDeckOfAMapRunsAgain) {
  const DeckRun first(
      std::filesystem::path(WHIRL_SOURCE "/examples/07_internal_damping/deck.toml"));
  ASSERT_EQ(first.exit, 0) << first.log;
  std::ostringstream resolved;
  resolved << std::ifstream(first.folder / "r" / "resolved.toml").rdbuf();
  EXPECT_NE(resolved.str().find("\"${c_external}\""), std::string::npos) << resolved.str();
  const Columns before = first.csv("stability_map_onset.csv");
  const DeckRun again(resolved.str());
  ASSERT_EQ(again.exit, 0) << again.log;
  EXPECT_EQ(again.csv("stability_map_onset.csv").rows.size(), 8u);
  EXPECT_EQ(column(again.csv("stability_map_onset.csv"), before.names[1]),
            column(before, before.names[1]));
  std::ostringstream twice;
  twice << std::ifstream(again.folder / "r" / "resolved.toml").rdbuf();
  EXPECT_EQ(twice.str(), resolved.str());
}

// Gyroscopic effect lifts the third forward line of an overhung disk above the fourth backward one:
// of six modes asked for both belong to the list somewhere, and neither ends where the other takes
// its place.
TEST(Spectra, CampbellLinesGoOnWhereOthersFillTheList) {
  const DeckRun run(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "R"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 600, 30, 6], ["b", 200, 30, 3]]
[[disk]]
at = "b:end"
mass = "8 kg"
Ip = "0.12 kg.m^2"
Id = "0.06 kg.m^2"
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
at = "a:end"
type = "rigid"
directions = ["y", "z"]
[[step]]
name = "c"
type = "campbell"
speed = { start = "0 rpm", stop = "60000 rpm", points = 13 }
modes = 6
motion = "lateral"
[output]
report = false
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns c = run.csv("c_campbell.csv");
  int lines = 0;
  for (const std::string& name : c.names) {
    if (name.find(" frequency") == std::string::npos) continue;
    ++lines;
    for (const double f : column(c, name))
      EXPECT_FALSE(std::isnan(f)) << name;
  }
  EXPECT_EQ(lines, 7);
  const std::vector<double> forward = column(c, "3 F frequency [Hz]");
  ASSERT_EQ(forward.size(), 13u);
  EXPECT_GT(forward.back(), column(c, "4 B frequency [Hz]").back());
}

namespace {

/// So many rigid rotors alike, each on springs of its own.
std::string rotors_alike(int count) {
  std::string deck = "format = 1\n[model]\ngravity = \"0 m/s^2\"\n[output]\nreport = false\n";
  for (int k = 0; k < count; ++k)
    deck += fmt::format(R"([[shaft]]
name = "s{0}"
origin = ["0 m", "{0} m", "0 m"]
[[shaft.section]]
name = "body"
length = "1 m"
rigid = true
[[disk]]
name = "d{0}"
at = "s{0}/body:mid"
mass = "100 kg"
Ip = "0.5 kg.m^2"
Id = "1 kg.m^2"
[[bearing]]
name = "B{0}"
at = "s{0}/body:mid"
type = "linear"
kxx = "1e8 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
cyy = "20 N.s/m"
czz = "20 N.s/m"
krr = "2e4 N.m/rad"
)",
                        k);
  return deck + R"([[step]]
name = "c"
type = "campbell"
motion = "lateral"
modes = )" +
         std::to_string(4 * count) +
         "\nspeed = { start = \"0 rpm\", stop = \"2000 rpm\", points = 11 }\n";
}

}  // namespace

// Of modes of one frequency any basis of their space may come out: a line is one of the space.
TEST(Spectra, ShaftsAlikeHaveWholeLines) {
  for (const int count : {1, 2, 3}) {
    const DeckRun run(rotors_alike(count));
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_TRUE(run.says(fmt::format("c: {} modes at 11 speeds", 4 * count))) << run.log;
    const Columns c = run.csv("c_campbell.csv");
    for (std::size_t k = 0; k < c.names.size(); ++k) {
      if (c.names[k].find("frequency") == std::string::npos) continue;
      for (const auto& row : c.rows)
        EXPECT_TRUE(std::isfinite(row[k])) << count << " " << c.names[k];
    }
  }
}

// Two inertias of 4 and 6 kg m2 on 2e5 N m/rad: 288.675 rad/s without the damper of 100 N m s/rad, below which
// the damped frequency lies. The list of critical speeds ended there.
TEST(CriticalSpeeds, OfTheHighestDampedTorsionalModeAreListed) {
  const DeckRun d(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "motor"
[[shaft.section]]
name = "m"
length = "500 mm"
rigid = true
[[shaft]]
name = "fan"
origin = ["500 mm", "0 mm", "0 mm"]
[[shaft.section]]
name = "f"
length = "500 mm"
rigid = true
[[disk]]
name = "rotor"
at = "m:start"
mass = "100 kg"
Ip = "4 kg.m^2"
[[disk]]
name = "wheel"
at = "f:end"
mass = "100 kg"
Ip = "6 kg.m^2"
[[bearing]]
name = "coupling"
at = "m:end"
to = "f:start"
type = "coupling"
kxx = "1e7 N/m"
krxx = "2e5 N.m/rad"
crxx = "100 N.m.s/rad"
[[bearing]]
name = "A"
at = "m:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "B"
at = "m:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "C"
at = "f:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "D"
at = "f:end"
type = "rigid"
directions = ["y", "z"]
[[step]]
name = "t"
type = "torsional"
max_speed = "3600 rpm"
orders = [1, 2]
[output]
report = false
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  const double w = std::sqrt(2e5 / 4.0 + 2e5 / 6.0) * 30.0 / std::numbers::pi;
  const Columns t = d.csv("t_critical_speeds.csv");
  ASSERT_EQ(t.rows.size(), 2u) << d.log;
  EXPECT_NEAR(t.rows[0][1], w, 1e-9 * w);
  EXPECT_NEAR(t.rows[1][1], 0.5 * w, 1e-9 * w);
}
