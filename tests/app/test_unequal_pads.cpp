// Tilting-pad bearings whose pads differ, through the program: lists of one value for each pad, pads with
// pivots of another kind, against equal pads, against differences of equilibria, turned, and wrong ones.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace unequal_pads_tests {

using whirl::test::Columns;
using whirl::test::DeckRun;

constexpr double degrees = M_PI / 180;

/// A load on the middle of a rotor, half of it on each bearing, N.
struct Load {
  double y = 0, z = -225629.814;
};

const std::string still =
    "[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"94.2477796 rad/s\"\n";

/// A rigid rotor on two like bearings.
std::string rotor(const std::string& bearing, const Load& load = {},
                  const std::string& steps = still) {
  const auto end = [&](const char* name, const char* at) {
    return fmt::format("[[bearing]]\nname = \"{}\"\nat = \"{}\"\n{}\n", name, at, bearing);
  };
  return fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "rigid"]
rows = [["a", 1000, 400, true], ["b", 1000, 400, true]]
[[bearing]]
name = "thrust"
at = "a:start"
type = "linear"
kxx = "10 MN/m"
cxx = "1e4 N.s/m"
[[probe]]
name = "P"
at = "a:start"
[[drive]]
at = "a:start"
type = "speed"
speed = "94.2477796 rad/s"
[[load]]
at = "a:end"
force = ["0 N", "{:.12g} N", "{:.12g} N"]
[output]
report = false
every = "1 ms"
)",
                     load.y, load.z) +
         end("DE", "a:start") + end("NDE", "b:end") + steps;
}

const std::string film = R"(type = "tilting_pad"
diameter = "399.9992 mm"
length = "263.144 mm"
viscosity = "19.01574061 mPa.s"
frequency_ratios = [0]
)";

/// "[\"1 N/m\", \"2 N/m\"]"; without a unit "[1, 2]".
std::string listed(const std::vector<double>& values, const std::string& unit) {
  std::string out;
  for (const double x : values)
    out += fmt::format(
        "{}{}", out.empty() ? "" : ", ",
        unit.empty() ? fmt::format("{:.15g}", x) : fmt::format("\"{:.15g} {}\"", x, unit));
  return "[" + out + "]";
}

struct PadKey {
  const char* name;
  const char* unit;
  std::vector<double> values;
};
std::string keys_of(const std::vector<PadKey>& keys) {
  std::string out;
  for (const PadKey& k : keys)
    out += fmt::format("{} = {}\n", k.name, listed(k.values, k.unit));
  return out;
}

/// Five pads none of which is like another.
std::vector<PadKey> five_unlike() {
  return {{"arc", "deg", {60, 55, 62, 58, 52}},
          {"offset", "", {0.5, 0.52, 0.55, 0.5, 0.53}},
          {"preload", "", {0.3, 0.25, 0.2, 0.35, 0.4}},
          {"clearance", "um", {194, 200, 190, 205, 198}},
          {"thickness", "mm", {100, 110, 95, 120, 105}},
          {"inertia", "kg.m^2", {0.1, 0.2, 0.3, 0.4, 0.5}},
          {"mass", "kg", {10, 11, 12, 13, 14}},
          {"pivot_stiffness", "N/m", {2e9, 1.8e9, 2.2e9, 3e8, 2e9}},
          {"pivot_damping", "N.s/m", {1e5, 2e5, 3e5, 4e5, 5e5}},
          {"tilt_stiffness", "N.m/rad", {1e5, 2e5, 3e5, 4e5, 5e5}}};
}

/// Pivots at 54 + 72 k deg: elastic, rigid, a ball, soft, a line.
const std::string five_kinds = R"(clearance = "194.564 um"
preload = 0.3
inertia = "0.2 kg.m^2"
mass = "12 kg"
pivot_damping = "1e5 N.s/m"
[[bearing.pad]]
pivot = "54 deg"
pivot_stiffness = "2e9 N/m"
[[bearing.pad]]
pivot = "126 deg"
[[bearing.pad]]
pivot = "198 deg"
pivot_contact = { shape = "ball", radius = "190 mm", seat_radius = "200 mm" }
mass = "15 kg"
[[bearing.pad]]
pivot = "270 deg"
pivot_stiffness = "4e8 N/m"
clearance = "200 um"
[[bearing.pad]]
pivot = "342 deg"
pivot_contact = { shape = "line" }
preload = 0.25
)";

struct Results {
  Columns coefficients, pads, reduced, full;
  explicit Results(const DeckRun& d)
      : coefficients(d.csv("st_coefficients.csv")),
        pads(d.csv("st_pads.csv")),
        reduced(d.csv("st_pad_coefficients.csv")),
        full(d.csv("st_full_coefficients.csv")) {}
  double of(const std::string& column) const {
    return coefficients.rows.at(0).at(coefficients.column(column));
  }
  double pad(std::size_t k, const char* column) const {
    return pads.rows.at(k).at(pads.column(column));
  }
  /// At frequency 0: row y, z; column y, z.
  double stiffness(int i, int j) const {
    return reduced.rows.at(1).at(
        reduced.column(fmt::format("reduced k{}{} [N/m]", "yz"[i], "yz"[j])));
  }
};

Results results_of(const std::string& deck) {
  const DeckRun d(deck);
  EXPECT_EQ(d.exit, 0) << d.log;
  return Results(d);
}

std::string read(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// Of the full coefficients of the first bearing, by the motion; the same force.
struct OnDiagonal {
  double k = std::nan(""), c = std::nan(""), m = std::nan("");
};
OnDiagonal diagonal(const DeckRun& d, const std::string& motion) {
  std::ifstream in(d.folder / "r" / "st_full_coefficients.csv");
  std::string line;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = Columns::cells_of(line);
    if (cells.at(2) == motion && cells.at(3) == motion)
      return {Columns::number(cells.at(4)), Columns::number(cells.at(5)),
              Columns::number(cells.at(6))};
  }
  return {};
}

// As lists or once for all: the same bytes of equilibria, coefficients, modes and motions, cold and hot.
TEST(UnequalPads, ListsOfEqualValuesChangeNothing) {
  const std::string steps =
      still +
      "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"94.2477796 rad/s\"\nmodes = 4\n"
      "[[step]]\nname = \"t\"\ntype = \"transient\"\nstart = \"rest\"\nduration = \"0.02 s\"\n";
  const std::string hot =
      "temperature = \"40 degC\"\nthinning = \"0.03 1/K\"\nheat = { "
      "supply_temperature = \"40 degC\", pad_expansion = \"12e-6 1/K\" }\n";
  for (const std::string& more : {std::string(), hot}) {
    std::string once, lists;
    for (PadKey k : five_unlike()) {
      const std::string list = listed({k.values[0]}, k.unit);
      once += fmt::format("{} = {}\n", k.name, list.substr(1, list.size() - 2));
      k.values.assign(5, k.values[0]);
      lists += keys_of({k});
    }
    const std::string& which = more.empty() ? steps : still;
    const DeckRun a(rotor(film + once + more, {}, which)), b(rotor(film + lists + more, {}, which));
    ASSERT_EQ(a.exit, 0) << a.log;
    ASSERT_EQ(b.exit, 0) << b.log;
    int compared = 0;
    for (const auto& file : std::filesystem::directory_iterator(a.folder / "r")) {
      if (file.path().extension() != ".csv") continue;
      ++compared;
      EXPECT_EQ(read(file), read(b.folder / "r" / file.path().filename())) << file.path();
    }
    EXPECT_GE(compared, more.empty() ? 8 : 5);
  }
}

// Lists, tables of pads and the resolved deck of either say the same.
TEST(UnequalPads, ListsAndTablesAreTheSame) {
  const std::vector<PadKey> keys = five_unlike();
  std::string tables = "clearance = \"1 mm\"\n";
  for (std::size_t k = 0; k < 5; ++k) {
    tables += fmt::format("[[bearing.pad]]\npivot = \"{} deg\"\n", 54 + 72 * k);
    for (const PadKey& key : keys) {
      const std::string list = listed({key.values[k]}, key.unit);
      tables += fmt::format("{} = {}\n", key.name, list.substr(1, list.size() - 2));
    }
  }
  const DeckRun a(rotor(film + "first_pivot = \"54 deg\"\n" + keys_of(keys)));
  const DeckRun b(rotor(film + tables));
  ASSERT_EQ(a.exit, 0) << a.log;
  ASSERT_EQ(b.exit, 0) << b.log;
  const DeckRun again(read(a.folder / "r" / "resolved.toml")),
      again_b(read(b.folder / "r" / "resolved.toml"));
  for (const DeckRun* d : {&b, &again, &again_b}) {
    const Results one(a), other(*d);
    for (const char* column : {"y [m]", "z [m]", "kyy [N/m]", "kzz [N/m]", "cyy [N s/m]",
                               "eccentricity / clearance [-]", "Sommerfeld number [-]"})
      EXPECT_NEAR(other.of(column), one.of(column), 1e-7 * std::abs(one.of(column))) << column;
  }
  // ratios to the clearance are to the smallest
  const Results one(a);
  EXPECT_NEAR(one.of("eccentricity / clearance [-]"), one.of("eccentricity [m]") / 190e-6, 1e-9);
  for (std::size_t k = 0; k < 5; ++k) {
    const double angle = (54.0 + 72.0 * static_cast<double>(k)) * degrees;
    const double towards = one.of("y [m]") * std::cos(angle) + one.of("z [m]") * std::sin(angle);
    EXPECT_NEAR(one.pad(k, "pad eccentricity [-]"),
                (towards - one.pad(k, "pivot compression [m]")) / (1e-6 * keys[3].values[k]), 1e-9);
    EXPECT_NEAR(one.pad(k, "pivot compression [m]"), one.pad(k, "pad load [N]") / keys[7].values[k],
                1e-12);
    const OnDiagonal tilt = diagonal(a, fmt::format("tilt {}", k + 1)),
                     pivot = diagonal(a, fmt::format("pivot {}", k + 1));
    EXPECT_EQ(tilt.m, keys[5].values[k]);
    EXPECT_EQ(pivot.m, keys[6].values[k]);
    EXPECT_GE(tilt.k, keys[9].values[k]);
    EXPECT_GE(pivot.c, keys[8].values[k]);
  }
}

// An elastic pad that stands pressed by xi has the film of one on a rigid pivot with the clearance c + xi
// and the same radius of its pad, (c + xi)/(1 - m') = c/(1 - m).
TEST(UnequalPads, PressedPadsAreThoseFurtherOut) {
  constexpr double c = 194.564e-6, m = 0.3;
  const std::string first = "first_pivot = \"54 deg\"\n";
  const Results elastic = results_of(rotor(
      film + first +
      "clearance = \"194.564 um\"\npreload = 0.3\n"
      "pivot_stiffness = [\"2e9 N/m\", \"1e9 N/m\", \"3e9 N/m\", \"2.5e9 N/m\", \"3.5e9 N/m\"]\n"));
  PadKey clearance{"clearance", "um", {}}, preload{"preload", "", {}};
  for (std::size_t k = 0; k < 5; ++k) {
    const double own = c + elastic.pad(k, "pivot compression [m]");
    clearance.values.push_back(1e6 * own);
    preload.values.push_back(1.0 - own / (c / (1.0 - m)));
  }
  const Results rigid = results_of(rotor(film + first + keys_of({clearance, preload})));
  EXPECT_GT(elastic.pad(3, "pivot compression [m]"), 3e-5);
  for (const char* column : {"y [m]", "z [m]"})
    EXPECT_NEAR(rigid.of(column), elastic.of(column), 1e-6 * c) << column;
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(rigid.pad(k, "pad load [N]"), elastic.pad(k, "pad load [N]"), 0.1) << k;
    EXPECT_NEAR(rigid.pad(k, "smallest film [m]"), elastic.pad(k, "smallest film [m]"), 1e-10) << k;
  }
}

// A pad on a soft pivot, and pivots of all kinds in one bearing: reduced coefficients at no frequency are
// those of neighbouring equilibria.
TEST(UnequalPads, CoefficientsAreThoseOfEquilibria) {
  const std::string soft =
      "first_pivot = \"54 deg\"\nclearance = \"194.564 um\"\npreload = 0.3\n"
      "pivot_stiffness = [\"2e9 N/m\", \"2e9 N/m\", \"2e9 N/m\", \"2e8 N/m\", \"2e9 N/m\"]\n";
  for (const std::string& bearing : {soft, five_kinds}) {
    const Load load{30000, -220000};
    const Results here = results_of(rotor(film + bearing, load));
    constexpr double step = 400;  // N on both bearings
    const auto moved = [&](double y, double z) {
      const Results to = results_of(rotor(film + bearing, {load.y + y, load.z + z})),
                    from = results_of(rotor(film + bearing, {load.y - y, load.z - z}));
      return std::array{to.of("y [m]") - from.of("y [m]"), to.of("z [m]") - from.of("z [m]")};
    };
    const auto by_y = moved(step, 0), by_z = moved(0, step);
    // K times what a load moves is the load
    const double size = std::abs(here.stiffness(1, 1));
    const double determinant = by_y[0] * by_z[1] - by_y[1] * by_z[0];
    EXPECT_NEAR(here.stiffness(0, 0), step * by_z[1] / determinant, 1e-5 * size);
    EXPECT_NEAR(here.stiffness(0, 1), -step * by_z[0] / determinant, 1e-5 * size);
    EXPECT_NEAR(here.stiffness(1, 0), -step * by_y[1] / determinant, 1e-5 * size);
    EXPECT_NEAR(here.stiffness(1, 1), step * by_y[0] / determinant, 1e-5 * size);
  }
}

// What each kind of pivot gives: nothing, load over stiffness, Hertz and Palmgren.
TEST(UnequalPads, PivotsOfAllKinds) {
  const DeckRun d(rotor(film + five_kinds, {100000, -200000}));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Results r(d);
  const auto load = [&](std::size_t k) { return r.pad(k, "pad load [N]"); };
  const auto xi = [&](std::size_t k) { return r.pad(k, "pivot compression [m]"); };
  EXPECT_NEAR(xi(0), load(0) / 2e9, 1e-12);
  EXPECT_EQ(xi(1), 0.0);
  EXPECT_NEAR(xi(3), load(3) / 4e8, 1e-12);
  EXPECT_GT(load(3), 1e4);
  const double ball = 4.0 / 3.0 * 210e9 / (2 * (1 - 0.09)) * std::sqrt(3.8) * std::pow(xi(2), 1.5);
  EXPECT_NEAR(ball, load(2), 1e-6 * load(2));
  const double line = 8.06e4 * std::pow(263.144, 8.0 / 9) * std::pow(1e3 * xi(4), 10.0 / 9);
  EXPECT_NEAR(line, load(4), 1e-6 * load(4));
  EXPECT_TRUE(std::isnan(diagonal(d, "pivot 2").k));
  EXPECT_EQ(diagonal(d, "pivot 1").m, 12.0);
  EXPECT_EQ(diagonal(d, "pivot 3").m, 15.0);
  EXPECT_EQ(diagonal(d, "tilt 2").m, 0.2);
  // held rigidly a pivot is as one that is very stiff
  std::string stiff = five_kinds;
  const std::string second = "pivot = \"126 deg\"\n";
  stiff.insert(stiff.find(second) + second.size(), "pivot_stiffness = \"1e15 N/m\"\n");
  const Results other = results_of(rotor(film + stiff, {100000, -200000}));
  for (const char* column : {"y [m]", "z [m]", "kyy [N/m]", "kyz [N/m]", "kzy [N/m]", "kzz [N/m]",
                             "cyy [N s/m]", "czz [N s/m]"})
    EXPECT_NEAR(other.of(column), r.of(column), 1e-5 * std::abs(r.of(column)) + 1e-12) << column;
}

// With its lists and its load turned by one pad a bearing does the same in the turned axes.
TEST(UnequalPads, TurnedByOnePad) {
  std::vector<PadKey> keys = five_unlike();
  const std::string first = "first_pivot = \"54 deg\"\n";
  const Results one = results_of(rotor(film + first + keys_of(keys), {20000, -220000}));
  for (PadKey& k : keys)
    std::rotate(k.values.begin(), k.values.end() - 1, k.values.end());
  const double c = std::cos(72 * degrees), s = std::sin(72 * degrees);
  const Load load{c * 20000 + s * 220000, s * 20000 - c * 220000};
  const Results turned = results_of(rotor(film + first + keys_of(keys), load));
  for (std::size_t k = 0; k < 5; ++k)
    for (const char* column : {"pad load [N]", "tilt [rad]", "pivot compression [m]",
                               "pad eccentricity [-]", "smallest film [m]", "power loss [W]"}) {
      const double own = one.pad(k, column);
      EXPECT_NEAR(turned.pad((k + 1) % 5, column), own, 1e-8 * std::abs(own) + 1e-12)
          << column << k;
    }
  EXPECT_NEAR(turned.of("y [m]"), c * one.of("y [m]") - s * one.of("z [m]"), 1e-11);
  EXPECT_NEAR(turned.of("z [m]"), s * one.of("y [m]") + c * one.of("z [m]"), 1e-11);
  for (const std::string part : {"k", "c"}) {
    const auto matrix = [&](const Results& r) {
      const std::string unit = part == "k" ? " [N/m]" : " [N s/m]";
      return std::array{r.of(part + "yy" + unit), r.of(part + "yz" + unit),
                        r.of(part + "zy" + unit), r.of(part + "zz" + unit)};
    };
    const auto a = matrix(one), b = matrix(turned);
    // R A R^T
    const std::array left{c * a[0] - s * a[2], c * a[1] - s * a[3], s * a[0] + c * a[2],
                          s * a[1] + c * a[3]};
    const std::array both{left[0] * c - left[1] * s, left[0] * s + left[1] * c,
                          left[2] * c - left[3] * s, left[2] * s + left[3] * c};
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_NEAR(b[i], both[i], 1e-10 * std::abs(a[3])) << part << i;
  }
}

// Motions stay in the equilibrium that they begin in, and come to it.
TEST(UnequalPads, MotionsEndInTheEquilibrium) {
  const Load heavy{20000, -220000}, light{5000, -60000};  // at once, the heavy one presses through
  const auto ends = [](const std::string& bearing, const Load& load, const char* start,
                       const char* duration, double tolerance) {
    const DeckRun d(
        rotor(film + bearing, load,
              still + fmt::format("[[step]]\nname = \"t\"\ntype = \"transient\"\nstart = "
                                  "\"{}\"\nduration = \"{}\"\n",
                                  start, duration)));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Results r(d);
    const auto end = d.csv("t.csv").last();
    EXPECT_NEAR(end.at("P.y [m]"), r.of("y [m]"), tolerance);
    EXPECT_NEAR(end.at("P.z [m]"), r.of("z [m]"), tolerance);
  };
  const std::string lists = "first_pivot = \"54 deg\"\n" + keys_of(five_unlike());
  ends(lists, heavy, "static", "0.05 s", 1e-10);
  ends(five_kinds, heavy, "static", "0.05 s", 1e-10);
  ends(lists, light, "rest", "1 s", 1e-7);
  ends(five_kinds, light, "rest", "1 s", 1e-7);
}

// Nothing goes through a pad without thickness where the walls are as thick as the pads.
TEST(UnequalPads, WallsAreAsThickAsEachPad) {
  const auto into_pads = [](const std::string& more) {
    const DeckRun d(rotor(film +
                          "clearance = \"194.564 um\"\npreload = 0.3\ntemperature = \"40 degC\"\n"
                          "first_pivot = \"54 deg\"\nthinning = \"0.03 1/K\"\n" +
                          more));
    EXPECT_EQ(d.exit, 0) << d.log;
    const Columns films = d.csv("st_films.csv");
    std::vector<double> out;
    for (std::size_t k = 0; k < 5; ++k)
      out.push_back(films.rows.at(k).at(films.column("heat into pad [W]")));
    return out;
  };
  const std::string list =
      "thickness = [\"60 mm\", \"60 mm\", \"60 mm\", \"0 mm\", \"60 mm\"]\nheat = { "
      "supply_temperature = \"40 degC\"";
  const std::vector<double> own = into_pads(list + " }\n"),
                            same = into_pads(list + ", wall = \"60 mm\" }\n");
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_GT(same[k], 1.0);
    if (k == 3)
      EXPECT_EQ(own[k], 0.0);
    else
      EXPECT_GT(own[k], 1.0);
  }
}

TEST(UnequalPads, BadInput) {
  const auto fails = [](const std::string& bearing, const char* code, const std::string& text) {
    const DeckRun d(rotor(film + bearing));
    EXPECT_NE(d.exit, 0) << bearing;
    EXPECT_TRUE(d.says(code) && d.says(text)) << d.log;
  };
  const std::string gap = "clearance = \"194.564 um\"\n";
  for (const PadKey& k : five_unlike()) {
    if (k.name == std::string("clearance")) continue;
    const std::string four = listed({k.values.begin(), k.values.begin() + 4}, k.unit);
    const std::string pivots =
        k.name == std::string("pivot_stiffness") ? "" : "pivot_stiffness = \"1e9 N/m\"\n";
    fails(gap + pivots + fmt::format("{} = {}\n", k.name, four), "error[E20]",
          fmt::format("'{}' has 4 values for 5 pads", k.name));
  }
  fails("clearance = [\"190 um\"]\n", "error[E20]", "'clearance' has 1 value for 5 pads");
  fails("clearance = []\n", "error[E20]", "'clearance' is a list without values");
  fails("clearance = [\"190 um\", \"190 um\", \"190 um\", \"0 um\", \"190 um\"]\n", "error[E14]",
        "'clearance'");
  fails("clearance = [\"190 um\", \"190 um\", \"190 um\", \"9 mm\", \"190 um\"]\n", "error[E14]",
        "is not small");
  fails(gap + "arc = [\"60 deg\", \"60 mm\", \"60 deg\", \"60 deg\", \"60 deg\"]\n", "error[E0",
        "arc");
  fails(gap + "arc = [\"60 deg\", \"100 deg\", \"60 deg\", \"60 deg\", \"60 deg\"]\n", "error[E14]",
        "pads 1 and 2 overlap");
  fails(gap + "pads = 4\npreload = [0.1, 0.2, 0.3, 0.4, 0.5]\n", "error[E20]",
        "5 values for 4 pads");
  fails(gap + "preload = [0.1, 0.2, 1.0, 0.4, 0.5]\n", "error[E14]", "preload");
  fails(gap + "mass = [0, 0, \"1 kg\", 0, 0]\n", "error[E05]", "rigid pivot");
  const auto pads = [](const std::string& first, const std::string& second) {
    return "[[bearing.pad]]\npivot = \"-90 deg\"\n" + first +
           "[[bearing.pad]]\npivot = \"90 deg\"\n" + second;
  };
  const std::string elastic = "pivot_stiffness = \"1e9 N/m\"\n",
                    line = "pivot_contact = { shape = \"line\" }\n";
  fails(gap + "thickness = [\"1 mm\"]\n" + pads("", ""), "error[E20]", "1 value for 2 pads");
  fails(gap + pads(elastic + line, elastic), "error[E26]", "a stiffness and a contact");
  fails(gap + pads(elastic, "mass = \"1 kg\"\n"), "error[E05]", "a rigid pivot does not move");
  fails(gap + "mass = [\"1 kg\", \"1 kg\"]\n" + pads(elastic, ""), "error[E05]",
        "the pivot of pad 2 is rigid");
  fails(gap + pads(elastic, "clearance = \"9 mm\"\n"), "error[E14]", "is not small");
}

}  // namespace unequal_pads_tests
