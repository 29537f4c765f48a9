// axial_force pulls at the ends of a shaft whatever it does; axial_preload is a force only where
// its supports balance it.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// A slender shaft of 1 m, 20 mm thick, hinged at both ends; right: directions held at the right
/// end; key: of the shaft.
std::string deck(const std::string& right, const std::string& key) {
  return R"(format = 1
[model]
gravity = "0 m/s^2"
[[material]]
name = "bar"
E = "200 GPa"
nu = 0.3
density = "7800 kg/m^3"
[[shaft]]
name = "s"
material = "bar"
)" + key +
         R"(columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 1000, 20, 12]]
[[bearing]]
name = "L"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "R"
at = "a:end"
type = "rigid"
directions = )" +
         right + R"(
[[step]]
name = "pull"
type = "static"
[[step]]
name = "modes"
type = "modal"
modes = 2
motion = "lateral"
[output]
report = false
)";
}

struct Result {
  double least, largest, thrust,
      frequency;  ///< axial force along the shaft and at the left support, N; first frequency, Hz
  std::string log;
};

Result run(const std::string& right, const std::string& key) {
  const DeckRun d(deck(right, key));
  EXPECT_EQ(d.exit, 0) << d.log;
  const Columns sections = d.csv("pull_sections.csv"), modes = d.csv("modes_modes.csv"),
                supports = d.csv("pull_supports.csv");
  Result r{infinity, -infinity, supports.rows.at(0).at(supports.column("F_x [N]")),
           modes.rows.at(0).at(modes.column("frequency [Hz]")), d.log};
  for (const auto& row : sections.rows) {
    const double N = row[sections.column("N [N]")];
    r.least = std::min(r.least, N);
    r.largest = std::max(r.largest, N);
  }
  return r;
}

const std::string sliding = "[\"y\", \"z\"]", held = "[\"x\", \"y\", \"z\"]";
constexpr double P = 5000.0;
// hinged: w^2 = w0^2 (1 + P/Pcr), Pcr = pi^2 EI/L^2. Shear and rotary inertia of this shaft change
// w0 by 2e-4 and the ratio by less
const double critical = pi * pi * 200e9 * pi / 64 * std::pow(0.02, 4);
const double stiffened = std::sqrt(1.0 + P / critical), softened = std::sqrt(1.0 - P / critical);

}  // namespace

TEST(AxialForce, StaysWhateverTheShaftDoes) {
  const double f0 = run(sliding, "").frequency;
  const Result pulled = run(sliding, "axial_force = \"5 kN\"\n"),
               pushed = run(sliding, "axial_force = \"-5 kN\"\n");
  EXPECT_NEAR(pulled.least, P, 1e-6 * P);
  EXPECT_NEAR(pulled.largest, P, 1e-6 * P);
  EXPECT_NEAR(pulled.thrust, 0.0, 1e-6 * P);  // the two forces are in balance
  EXPECT_NEAR(pushed.least, -P, 1e-6 * P);
  EXPECT_NEAR(pulled.frequency / f0, stiffened, 1e-3);
  EXPECT_NEAR(pushed.frequency / f0, softened, 1e-3);
}

TEST(AxialForce, OfAPreloadIsBalancedByTheSupports) {
  const double f0 = run(sliding, "").frequency;
  const Result clamped = run(held, "axial_preload = \"5 kN\"\n");
  EXPECT_NEAR(clamped.least, P, 1e-6 * P);
  EXPECT_NEAR(clamped.thrust, -P, 1e-6 * P);
  EXPECT_NEAR(clamped.frequency / f0, stiffened, 1e-3);
  EXPECT_EQ(clamped.log.find("W02"), std::string::npos) << clamped.log;
  // a free end: it shortens, and carries nothing; that is said
  const Result slides = run(sliding, "axial_preload = \"5 kN\"\n");
  EXPECT_NEAR(slides.largest, 0.0, 1e-3);
  EXPECT_NEAR(slides.frequency / f0, 1.0, 1e-4);
  EXPECT_NE(slides.log.find("axial_preload of shaft 's' has no effect but its length"),
            std::string::npos)
      << slides.log;
}

TEST(AxialForce, IsALoadThatBuckles) {
  // buckling: a push of 5 kN buckles the hinged column at Pcr/5 kN; shear lowers it by 3e-4
  std::string text = deck(sliding, "axial_force = \"-5 kN\"\n");
  text.replace(text.find("[[step]]\nname = \"modes\""), std::string::npos,
               "[[step]]\nname = \"b\"\ntype = \"buckling\"\n[output]\nreport = false\n");
  const DeckRun d(text);
  ASSERT_EQ(d.exit, 0) << d.log;
  const std::size_t at = d.log.find("smallest load factor ");
  ASSERT_NE(at, std::string::npos) << d.log;
  EXPECT_NEAR(std::stod(d.log.substr(at + 21)), critical / P, 1e-3 * critical / P);
}

// Beck's column: a push that follows the free end causes no buckling, but flutter. The real part of a
// complex factor was told as its buckling load.
TEST(AxialForce, AFollowingPushHasNoBucklingLoad) {
  const DeckRun d(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "s"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 1000, 20, 10], ["b", 1000, 20, 10]]
[[load]]
at = "b:end"
frame = "rotating"
force = ["-1000 N", "0 N", "0 N"]
[[bearing]]
at = "a:start"
type = "rigid"
directions = ["x", "y", "z", "rx", "ry", "rz"]
[[step]]
name = "b"
type = "buckling"
modes = 4
[output]
report = false
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NE(d.log.find("no buckling load"), std::string::npos) << d.log;
  EXPECT_EQ(d.log.find("smallest load factor"), std::string::npos) << d.log;
}
