// What a static step says of its mesh, against meshes that are much finer.
#include "../analysis/any_machine.hpp"
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;
using whirl::tests::AnyMachine;

/// A slender cantilever bent far out of its line, in so many elements.
std::string bent(int elements) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "strip"
material = "steel"
rotating = false
[[shaft.section]]
name = "a"
length = "1 m"
od = "10 mm"
min_elements = )" +
         std::to_string(elements) + R"(
[[bearing]]
at = "strip/0 m"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "strip/1 m"
force = ["0 N", "150 N", "40 N"]
[[step]]
name = "st"
type = "static"
load_steps = 4
[output]
report = false
)";
}

/// Places of the rows: s, and the number of the shaft (its stations stand in their order).
std::vector<std::pair<int, double>> places(const Columns& c) {
  std::vector<std::pair<int, double>> out;
  const std::size_t s = c.column("s [m]");
  int shaft = 0;
  for (const std::vector<double>& row : c.rows) {
    if (!out.empty() && row[s] < out.back().second) ++shaft;
    out.push_back({shaft, row[s]});
  }
  return out;
}

/// Largest distance between the displacements of the stations of a coarse mesh and those of a finer
/// one, over the largest of them.
double apart(const Columns& coarse, const Columns& fine) {
  double most = 0, worst = 0;
  const auto own = places(coarse), other = places(fine);
  const std::size_t first = coarse.column("u_x [m]");
  for (std::size_t k = 0, m = 0; k < own.size(); ++k) {
    while (m < other.size() &&
           (other[m].first != own[k].first || std::abs(other[m].second - own[k].second) > 1e-9))
      ++m;
    EXPECT_LT(m, other.size()) << k;
    if (m == other.size()) break;
    double size = 0, moved = 0;
    for (std::size_t c = first; c < first + 3; ++c) {
      size += coarse.rows[k][c] * coarse.rows[k][c];
      moved += std::pow(coarse.rows[k][c] - fine.rows[m][c], 2);
    }
    most = std::max(most, std::sqrt(size));
    worst = std::max(worst, std::sqrt(moved));
  }
  return worst / most;
}

struct Found {
  Columns deflection;
  double said;
};

std::optional<Found> found_in(const std::string& deck) {
  const DeckRun run(deck);
  if (run.exit != 0) return std::nullopt;
  const whirl::io::Value step = run.summary("st");
  return Found{run.csv("st_deflection.csv"),
               step.at("mesh").at("relative error of deflections").number()};
}

}  // namespace

// One element a span has nodes at the supports alone, and all of the sag lies between them: it was drawn
// by the cubic of the end slopes, four fifths of it.
TEST(StaticAccuracy, SagBetweenNodesIsThatOfTheBeam) {
  constexpr double E = 200e9, G = E / 2.6, rho = 7800, g = 9.80665, pi = 3.14159265358979;
  const auto largest = [&](const std::string& rows, const std::string& supports, int elements) {
    const DeckRun run(
        "format = 1\n[model]\n" +
        (elements > 0 ? "mesh = { min_elements_per_section = " + std::to_string(elements) + " }\n"
                      : std::string()) +
        "[output]\nreport = false\n[[material]]\nname = \"m\"\nE = \"200 GPa\"\nnu = 0.3\n"
        "density = \"7800 kg/m^3\"\n[[shaft]]\nname = \"a\"\nmaterial = \"m\"\ncolumns = "
        "[\"name\", \"length[mm]\", \"od_l[mm]\", \"id_l[mm]\", \"od_r[mm]\", "
        "\"id_r[mm]\"]\nrows = [" +
        rows + "]\n" + supports + "[[step]]\nname = \"s\"\ntype = \"static\"\n");
    EXPECT_EQ(run.exit, 0) << run.log;
    EXPECT_FALSE(run.says("W10")) << run.log;
    return run.summary("s").at("deflection").at("a").at("largest [m]").number();
  };
  const auto at = [](const char* place, bool clamped = false) {
    return std::string("[[bearing]]\nat = \"") + place +
           "\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", \"z\"" +
           (clamped ? ", \"rx\", \"ry\", \"rz\"]\n" : "]\n");
  };
  const auto beside = [](const char* place) {
    return std::string("[[bearing]]\nat = \"") + place +
           "\"\ntype = \"rigid\"\ndirections = [\"y\", \"z\"]\n";
  };
  for (const double id : {0.0, 0.03}) {
    const double od = 0.06, L = 1.2;
    const double A = pi / 4 * (od * od - id * id),
                 I = pi / 64 * (std::pow(od, 4) - std::pow(id, 4));
    const double m = id / od, q = (1 + m * m) * (1 + m * m), nu = 0.3;
    const double kappa = 6 * (1 + nu) * q / ((7 + 6 * nu) * q + (20 + 12 * nu) * m * m);  // Cowper
    const double w = rho * A * g;
    const std::string row = "[\"s\", 1200, 60, " + std::to_string(1000 * id) + ", 60, " +
                            std::to_string(1000 * id) + "]";
    const double exact = 5 * w * std::pow(L, 4) / (384 * E * I) + w * L * L / (8 * kappa * G * A);
    EXPECT_NEAR(largest(row, at("s:start") + beside("s:end"), 0) / exact, 1.0, 1e-5);
    const double clamped = w * std::pow(L, 4) / (384 * E * I) + w * L * L / (8 * kappa * G * A);
    EXPECT_NEAR(largest(row, at("s:start", true) + at("s:end", true), 0) / clamped, 1.0, 1e-3);
  }
  // spans, cones: against many elements
  for (const auto& [rows, supports] :
       {std::pair<std::string, std::string>{
            "[\"s\", 600, 60, 30, 60, 30], [\"t\", 600, 60, 30, 60, 30]",
            at("s:start") + beside("s:end") + beside("t:end")},
        {"[\"s\", 900, 80, 0, 50, 0], [\"t\", 300, 40, 0, 40, 0]", at("s:start") + beside("t:end")},
        {"[\"s\", 900, 80, 10, 80, 10], [\"t\", 400, 60, 0, 30, 0]",
         at("s:start") + beside("s:end")}})
    EXPECT_NEAR(largest(rows, supports, 0) / largest(rows, supports, 40), 1.0, 1e-3) << rows;
}

TEST(StaticAccuracy, IsThatOfAMeshMuchFiner) {
  const auto fine = found_in(bent(64));
  ASSERT_TRUE(fine);
  double before = 1;
  for (const int elements : {2, 4, 8}) {
    const auto own = found_in(bent(elements));
    ASSERT_TRUE(own);
    const double real = apart(own->deflection, fine->deflection);
    EXPECT_LT(real, 1.2 * own->said) << elements;
    EXPECT_GT(real, 0.3 * own->said) << elements;
    EXPECT_LT(own->said, 0.5 * before) << elements;
    before = own->said;
  }
}

TEST(StaticAccuracy, CoarseMeshesAreWarnedOf) {
  const DeckRun coarse(bent(1)), fine(bent(32));
  EXPECT_TRUE(coarse.says("W10")) << coarse.log;
  EXPECT_TRUE(coarse.says("deflections of shaft 'strip' are off by about")) << coarse.log;
  EXPECT_FALSE(fine.says("W10")) << fine.log;
  EXPECT_TRUE(fine.says("deflections right to")) << fine.log;
}

// Machines of every kind under their weight, at speed.
TEST(StaticAccuracy, OfRandomMachines) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const auto deck = [&](int finer) {
      AnyMachine::View view;
      view.finer = finer;
      const AnyMachine m(seed, view);
      return m.deck() + fmt::format(
                            "[[step]]\nname = \"st\"\ntype = \"static\"\nspeed = \"{} "
                            "rad/s\"\n",
                            0.7 * m.top_speed());
    };
    const auto own = found_in(deck(1)), fine = found_in(deck(8));
    if (!own || !fine) continue;
    ++compared;
    const double real = apart(own->deflection, fine->deflection);
    EXPECT_LT(real, 2.0 * own->said + 1e-7) << seed;
    EXPECT_LT(own->said, 1e-3) << seed;
  }
  EXPECT_GE(compared, 9);
}

// Films of dampers say what their grid leaves; short ones beyond their theory, and long seals, are
// warned of when the deck is read.
TEST(StaticAccuracy, FilmsOfDampersSayTheirGrid) {
  const auto deck = [](const std::string& film, const char* length) {
    return whirl::test::lateral_mass(10, "9.81 m/s^2", R"([[bearing]]
name = "damper"
at = "mass"
type = "squeeze_film"
diameter = "100 mm"
length = ")" + std::string(length) + R"("
clearance = "100 um"
viscosity = "20 mPa.s"
stiffness = "2e6 N/m"
film = )" + film + R"(
[[step]]
name = "st"
type = "static"
[output]
report = false
)");
  };
  for (const char* film : {"\"finite\"", "\"sealed\"\ngroove_at = \"50 deg\""}) {
    const DeckRun run(deck(film, "60 mm"));
    ASSERT_EQ(run.exit, 0) << run.log;
    const Columns table = run.csv("st_coefficients.csv");
    const double error = table.rows.at(0).at(table.column("grid error [-]"));
    EXPECT_GT(error, 0.0) << film;
    EXPECT_LT(error, 5e-3) << film;
    EXPECT_TRUE(run.says("(film grid)")) << run.log;
    // sealed ends have no profile along the axis to be wrong
    const double axial = table.rows.at(0).at(table.column("axial error [-]"));
    const bool has_profile = std::string(film).starts_with("\"finite\"");
    EXPECT_EQ(run.says("axial profile"), has_profile) << run.log;
    EXPECT_EQ(std::isnan(axial), !has_profile);
    if (has_profile) {
      EXPECT_GT(axial, error);
      EXPECT_LT(axial, 0.03);
    }
    EXPECT_FALSE(run.says("W03")) << run.log;
  }
  const DeckRun brief(deck("\"full\"", "40 mm")), long_one(deck("\"full\"", "60 mm"));
  EXPECT_FALSE(brief.says("(film grid)") || brief.says("W03")) << brief.log;
  EXPECT_TRUE(long_one.says("W03")) << long_one.log;
}

// A strip frame far beyond its buckling load: Newton's method on the finer mesh goes to another equilibrium,
// whose distance is no error of the elements ("off by about 9e+01 of the largest" was said of 1.5e-4).
TEST(StaticAccuracy, AnotherEquilibriumIsNoErrorOfTheMesh) {
  const std::string leg =
      "length = \"240 mm\"\nmin_elements = 8\ngeneral = { A = \"18 mm^2\", Iy = \"0.54 mm^4\", Iz "
      "= \"1350 "
      "mm^4\", J = \"2.16 mm^4\", kappa_y = 0.8333, kappa_z = 0.8333 }\n";
  const DeckRun d(R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "m"
E = "71.24 GPa"
G = "27.19 GPa"
density = "2700 kg/m^3"
[[shaft]]
name = "frame"
material = "m"
rotating = false
path = [{ to = ["240 mm", "0 mm", "0 mm"] }, { to = ["240 mm", "-240 mm", "0 mm"] }]
[[shaft.section]]
name = "leg1"
)" + leg + "[[shaft.section]]\nname = \"leg2\"\n" +
                  leg + R"([[bearing]]
name = "clamp"
at = "leg1:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[load]]
at = "leg2:end"
force = ["1 N", "0 N", "1 mN"]
[[step]]
name = "path"
type = "static"
path = { load = 5, steps = 40, max_points = 2000 }
[output]
report = false
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("are off by")) << d.log;
}
