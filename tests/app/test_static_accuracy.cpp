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
    EXPECT_FALSE(run.says("W03")) << run.log;
  }
  const DeckRun brief(deck("\"full\"", "40 mm")), long_one(deck("\"full\"", "60 mm"));
  EXPECT_FALSE(brief.says("(film grid)") || brief.says("W03")) << brief.log;
  EXPECT_TRUE(long_one.says("W03")) << long_one.log;
}
