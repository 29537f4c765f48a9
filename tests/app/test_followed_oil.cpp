// Transients of rotors on journal films that conserve mass, through the program: where they begin, where
// they settle, that steps of other kinds go on from them.
#include "deck_run.hpp"
#include "disk_between_films.hpp"

#include <fmt/format.h>

#include <cmath>

namespace followed_oil_tests {

using whirl::test::Columns;
using whirl::test::DeckRun;

constexpr double clearance = 80e-6;

/// A disk between two split bearings at 3000 rpm. more: keys of the bearings.
std::string rotor(const std::string& steps, const std::string& more = {},
                  const std::string& shape = "shape = \"two_grooves\"") {
  const auto bearing = [&](const char* name, const char* at) {
    return fmt::format(R"([[bearing]]
name = "{}"
at = "{}"
type = "journal"
diameter = "80 mm"
length = "40 mm"
clearance = "80 um"
viscosity = "20 mPa.s"
{}
cavitation = "mass_conserving"
{}
)",
                       name, at, shape, more);
  };
  return whirl::test::disk_between(bearing("DE", "left:start") + bearing("NDE", "right:end"),
                                   steps);
}
const std::string& at_rest = whirl::test::settled_at_speed;
using whirl::test::moves;

struct Ends {
  double y0, z0, y1, z1;  ///< of the journal, m
};
Ends ends_of(const DeckRun& d) {
  EXPECT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("t.csv");
  const std::size_t y = t.column("DE.y [m]"), z = t.column("DE.z [m]");
  return {t.rows.front()[y], t.rows.front()[z], t.rows.back()[y], t.rows.back()[z]};
}
double between(double y, double z, double y1, double z1) {
  return std::hypot(y - y1, z - z1) / clearance;
}

// Begun in its own equilibrium the journal stays; let go in that of the momentary film, or in the middle
// of the bearing, it comes there, and the two equilibria differ by the grid.
TEST(FollowedOil, SettlesInTheEquilibrium) {
  for (const char* more : {"", "supply_pressure = \"2 bar\""}) {
    const Ends stays = ends_of(DeckRun(rotor(moves("start = \"static\"", "0.2 s"), more)));
    EXPECT_LT(between(stays.y0, stays.z0, stays.y1, stays.z1), 1e-7);
    const Ends comes = ends_of(DeckRun(rotor(at_rest + moves("from = \"st\"", "0.3 s"), more)));
    EXPECT_GT(between(comes.y0, comes.z0, stays.y0, stays.z0), 1e-5);
    EXPECT_LT(between(comes.y0, comes.z0, stays.y0, stays.z0), 0.01);
    EXPECT_LT(between(comes.y1, comes.z1, stays.y0, stays.z0), 1e-4);
  }
  const DeckRun fallen(rotor(moves("start = \"rest\"", "0.4 s")));
  const Ends falls = ends_of(fallen),
             stays = ends_of(DeckRun(rotor(moves("start = \"static\"", "1 ms"))));
  EXPECT_EQ(falls.y0, 0.0);
  EXPECT_LT(between(falls.y1, falls.z1, stays.y0, stays.z0), 1e-3);
  const whirl::io::Value energy = fallen.summary("t").at("energy");
  EXPECT_LT(std::abs(energy.at("largest defect [J]").number()),
            1e-6 * energy.at("supplied [J]").number());
}

// What such a transient leaves other steps take up, and the other way round: all have the oil's nodes.
TEST(FollowedOil, StepsGoOn) {
  const DeckRun d(rotor(
      moves("start = \"static\"", "5 ms") +
      "[[step]]\nname = \"st\"\ntype = \"static\"\nfrom = \"t\"\nspeed = \"3000 rpm\"\n"
      "[[step]]\nname = \"m\"\ntype = \"modal\"\nfrom = \"st\"\nspeed = \"3000 rpm\"\nmodes = 2\n"
      "[[step]]\nname = \"on\"\ntype = \"transient\"\nfrom = \"t\"\nduration = \"5 ms\"\n"));
  EXPECT_EQ(d.exit, 0) << d.log;
  const DeckRun alone(
      rotor("[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"3000 rpm\"\nmodes = 2\n"));
  EXPECT_EQ(alone.exit, 0) << alone.log;
  const Columns with = d.csv("m_modes.csv"), without = alone.csv("m_modes.csv");
  const std::size_t f = with.column("frequency [Hz]");
  ASSERT_EQ(with.rows.size(), without.rows.size());
  for (std::size_t k = 0; k < with.rows.size(); ++k)
    EXPECT_NEAR(with.rows[k][f], without.rows[k][f], 1e-6 * without.rows[k][f]);
}

namespace {

const std::string dam = R"(shape = "pressure_dam"
dam_arc = "125 deg"
dam_depth = "160 um"
dam_width = "29 mm"
relief_width = "10 mm")";

}  // namespace

// A pressure dam, whose film is on a grid along the axis: as above, on the cells that the step says.
TEST(FollowedGrid, SettlesInTheEquilibrium) {
  const std::string coarse = "grid = 96";
  const DeckRun still(rotor(moves("start = \"static\"", "0.01 s"), coarse, dam));
  EXPECT_TRUE(still.says("oil followed in 24 x 6 cells")) << still.log;
  const Ends stays = ends_of(still);
  EXPECT_LT(between(stays.y0, stays.z0, stays.y1, stays.z1), 1e-6);
  const DeckRun let_go(rotor(at_rest + moves("from = \"st\"", "0.03 s"), coarse, dam));
  const Ends comes = ends_of(let_go);
  EXPECT_GT(between(comes.y0, comes.z0, stays.y0, stays.z0), 1e-4);
  EXPECT_LT(between(comes.y0, comes.z0, stays.y0, stays.z0), 0.01);
  EXPECT_LT(between(comes.y1, comes.z1, stays.y0, stays.z0), 2e-4);
  const whirl::io::Value energy = let_go.summary("t").at("energy");
  EXPECT_LT(std::abs(energy.at("largest defect [J]").number()),
            1e-6 * energy.at("supplied [J]").number());
}

// The modes that a transient compares its steps with are those of the rotor on films of the momentary state,
// as a modal step has them: not those of oil in its cells.
TEST(FollowedGrid, ModesOfATransientAreThoseOfLinearSteps) {
  for (const std::string& shape : {std::string("shape = \"two_grooves\""), dam}) {
    const DeckRun d(rotor(moves("start = \"static\"", "1 ms") +
                              "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"3000 rpm\"\n"
                              "modes = 8\n",
                          "grid = 96", shape));
    ASSERT_EQ(d.exit, 0) << d.log;
    const whirl::io::Value accuracy = d.summary("t").at("accuracy");
    EXPECT_EQ(accuracy.at("films in the modes").text(),
              "of the momentary state, as in linear steps");
    const Columns modes = d.csv("m_modes.csv");
    const std::size_t f = modes.column("frequency [Hz]"),
                      damping = modes.column("damping ratio [-]");
    ASSERT_GE(accuracy.at("modes").items().size(), 4U);
    for (std::size_t k = 0; k < accuracy.at("modes").items().size(); ++k) {
      const whirl::io::Value& mode = accuracy.at("modes").items()[k];
      EXPECT_NEAR(mode.at("frequency [Hz]").number(), modes.rows.at(k)[f],
                  1e-5 * modes.rows.at(k)[f]);
      EXPECT_NEAR(mode.at("physical damping ratio").number(), modes.rows.at(k)[damping], 1e-5);
    }
  }
}

// Tilting pads on such a grid begin in balance and stay there.
TEST(FollowedGrid, PadsThatTiltStay) {
  std::string deck = rotor(moves("start = \"static\"", "2 ms"), "grid = 96\naxial_grid = 4",
                           "pads = 4\nfirst_pivot = \"-135 deg\"\narc = \"72 deg\"\n"
                           "preload = 0.3\nthickness = \"15 mm\"");
  for (std::size_t at = 0; (at = deck.find("\"journal\"", at)) != std::string::npos;)
    deck.replace(at, 9, "\"tilting_pad\"");
  const DeckRun d(deck);
  EXPECT_TRUE(d.says("oil followed in 24 x 6 cells")) << d.log;
  const Ends stays = ends_of(d);
  EXPECT_LT(between(stays.y0, stays.z0, stays.y1, stays.z1), 1e-6);
}

}  // namespace followed_oil_tests
