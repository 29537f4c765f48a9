// Static steps of rotors that know their angle: bowed, flat, with a loss factor. The machine is statically
// determinate, so that its section forces are those of its weight and load by hand.
#include "deck_run.hpp"

#include <core/types.hpp>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;

constexpr double g = 9.80665, disk_mass = 20, side = 300, span = 1.0, place = 0.4;

constexpr std::string_view round_shaft = "od = \"60 mm\"\n";
constexpr std::string_view flat =
    "general = { A = \"3600 mm^2\", Iy = \"1.0e6 mm^4\", Iz = \"1.3e6 mm^4\", J = \"2e6 mm^4\", "
    "kappa_y = 0.85, kappa_z = 0.85, angle = \"20 deg\" }\n";

/// 20 kg and a load to the side at 0.4 m of 1 m between bearings. extra: keys of the shaft.
std::string rotor(std::string_view extra, std::string_view section, std::string_view step,
                  double gravity = g) {
  return fmt::format(
      R"(format = 1
[output]
report = false
[model]
gravity = "{} m/s^2"
[[shaft]]
name = "r"
material = "steel"
{}[[shaft.section]]
name = "a"
length = "400 mm"
{}[[shaft.section]]
name = "b"
length = "600 mm"
{}[[disk]]
name = "d"
at = "a:end"
mass = "20 kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "1e7 N/m"
kzz = "3e7 N/m"
[[bearing]]
name = "B"
at = "b:end"
type = "linear"
kyy = "3e7 N/m"
kzz = "3e7 N/m"
[[probe]]
name = "p"
at = "d"
{}[[step]]
name = "s"
{})",
      gravity, extra, section, section,
      gravity > 0 ? "[[load]]\nat = \"d\"\nforce = [\"0 N\", \"300 N\", \"0 N\"]\n" : "", step);
}

/// N/m, of the shaft: what bearing A carries beside its share of the disk.
double weight_of_shaft(const DeckRun& run) {
  const Columns t = run.csv("s_supports.csv");
  const double left = t.rows.at(0)[t.column("F_z [N]")];
  return 2 * (left - disk_mass * g * (span - place) / span) / span;
}

std::string still(std::string_view speed) {
  return fmt::format("type = \"static\"\nspeed = \"{}\"\n", speed);
}

/// M_y, M_z, V_y, V_z of the table are those of what stands left of the section: the force of the left
/// bearing, the weight of the shaft (N/m), disk and load.
void expect_balance(const DeckRun& run, double per_length) {
  const Columns t = run.csv("s_sections.csv");
  const double share = (span - place) / span;
  const double left_y = -side * share, left_z = 0.5 * per_length * span + disk_mass * g * share;
  ASSERT_GT(t.rows.size(), 8u);
  for (std::size_t k = 0; k < t.rows.size(); ++k) {
    const auto value = [&](const char* name) { return t.rows[k][t.column(name)]; };
    const double s = value("s [m]");
    const bool beyond =
        s > place + 1e-9 || (s > place - 1e-9 && t.rows[k - 1][t.column("s [m]")] == s);
    const double up = left_z - per_length * s - (beyond ? disk_mass * g : 0.0);
    const double across = left_y + (beyond ? side : 0.0);
    const double M_y =
        -left_z * s + 0.5 * per_length * s * s + (beyond ? disk_mass * g * (s - place) : 0.0);
    const double M_z = left_y * s + (beyond ? side * (s - place) : 0.0);
    EXPECT_NEAR(value("V_z [N]"), -up, 1e-3) << s << run.log;
    EXPECT_NEAR(value("V_y [N]"), -across, 1e-3) << s << run.log;
    EXPECT_NEAR(value("M_y [N m]"), M_y, 1e-3) << s << run.log;
    EXPECT_NEAR(value("M_z [N m]"), M_z, 1e-3) << s << run.log;
  }
}

constexpr std::string_view bows[] = {
    "bow = { amount = \"100 um\" }\n", "bow = { amount = \"100 um\", phase = \"90 deg\" }\n",
    "bow = { amount = \"100 um\", phase = \"-90 deg\" }\n",
    "bow = { amount = \"100 um\", phase = \"90 deg\", time_constant = \"10 s\", initial = \"50 "
    "um\" }\n"};
constexpr double steel_weight = 7850 * g * std::numbers::pi / 4 * 0.06 * 0.06;

}  // namespace

// The moments of the bow at angle zero were added: 226.9 N m for 76.2.
TEST(BowedRotors, SectionForcesAtSpeedAreThoseOfTheLoads) {
  const DeckRun straight(rotor("", round_shaft, still("3000 rpm")));
  ASSERT_EQ(straight.exit, 0) << straight.log;
  const double weight = weight_of_shaft(straight);
  EXPECT_NEAR(weight / steel_weight, 1.0, 0.02);  // steel of 7850 kg/m3 or thereabouts
  expect_balance(straight, weight);
  const double energy = straight.summary("s").at("elastic energy [J]").number();
  for (const std::string_view bow : bows)
    for (const char* speed : {"1 rpm", "3000 rpm"}) {
      const DeckRun run(rotor(bow, round_shaft, still(speed)));
      ASSERT_EQ(run.exit, 0) << run.log;
      expect_balance(run, weight);
      EXPECT_NEAR(run.summary("s").at("elastic energy [J]").number() / energy, 1.0, 1e-3);
    }
}

// The stiffness at angle zero met the deflection of the mean one.
TEST(BowedRotors, SectionForcesOfAFlatShaftAreThoseOfTheLoads) {
  const DeckRun reference(rotor("", flat, still("0 rpm")));
  const double weight = weight_of_shaft(reference);
  for (const char* speed : {"0 rpm", "4200 rpm"}) {
    const DeckRun run(rotor("", flat, still(speed)));
    ASSERT_EQ(run.exit, 0) << run.log;
    expect_balance(run, weight);
    EXPECT_FALSE(run.says("W10")) << run.log;
  }
}

// The stand-in of motions in time gave 0.8 % where nothing is.
TEST(BowedRotors, SectionForcesOfALossFactorAreThoseOfTheLoads) {
  for (const std::string_view section : {round_shaft, flat}) {
    const DeckRun elastic(rotor("", section, still("3000 rpm")));
    const double weight = weight_of_shaft(elastic);
    const DeckRun run(
        rotor("damping = { internal_loss_factor = 0.01 }\n", section, still("3000 rpm")));
    ASSERT_EQ(run.exit, 0) << run.log;
    expect_balance(run, weight);
  }
}

// Displacements and energies that are rounding were compared with each other.
TEST(BowedRotors, WithoutLoadHasNoErrorOfRounding) {
  const DeckRun turning(rotor(bows[1], round_shaft, still("3000 rpm"), 0.0));
  ASSERT_EQ(turning.exit, 0) << turning.log;
  EXPECT_FALSE(turning.says("W10")) << turning.log;
  EXPECT_FALSE(turning.says("largest bending moment")) << turning.log;
  const DeckRun motion(rotor(bows[1], round_shaft,
                             "type = \"transient\"\nduration = \"0.1 s\"\ninitial_speed = \"0 "
                             "rpm\"\n",
                             0.0));
  ASSERT_EQ(motion.exit, 0) << motion.log;
  EXPECT_FALSE(motion.says("do not trust")) << motion.log;
}

// It was turned to an equilibrium of its weight, bow up as often as down; a bow of zero found none (E75).
TEST(BowedRotors, AtRestTheyStayAtTheirAngle) {
  const DeckRun straight(rotor("", round_shaft, still("0 rpm")));
  const auto sag = [](const DeckRun& run) {
    const Columns t = run.csv("s_deflection.csv");
    EXPECT_NEAR(t.rows.at(1)[t.column("s [m]")], place, 1e-9);
    return t.rows.at(1)[t.column("u_z [m]")];
  };
  const double half_sine = 1e-4 * std::sin(std::numbers::pi * place);
  struct Case {
    std::string_view bow;
    double up;  ///< m, of the bow at the disk
  };
  for (const auto& [bow, up] :
       {Case{bows[1], half_sine}, Case{bows[2], -half_sine},
        Case{"bow = { amount = \"100 um\", phase = \"30 deg\" }\n", 0.5 * half_sine},
        Case{"bow = { amount = \"100 um\", phase = \"90 deg\", time_constant = \"10 s\" }\n",
             0.0}}) {
    const DeckRun run(rotor(bow, round_shaft, still("0 rpm")));
    ASSERT_EQ(run.exit, 0) << run.log;
    EXPECT_TRUE(run.says("held: angle of node")) << run.log;
    EXPECT_FALSE(run.says("W08")) << run.log;
    EXPECT_NEAR(sag(run), sag(straight) + up, 1e-8) << bow;
  }
  // beside a casing whose section is not round either
  const std::string casing = fmt::format(
      "[[shaft]]\nname = \"casing\"\nmaterial = \"steel\"\nrotating = "
      "false\n[[shaft.section]]\nname = "
      "\"c\"\nlength = \"1 m\"\n{}[[bearing]]\nat = \"casing:start\"\ntype = \"rigid\"\n"
      "directions = [\"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\"]\n",
      flat);
  const DeckRun beside(rotor(bows[1], round_shaft, still("0 rpm") + casing));
  ASSERT_EQ(beside.exit, 0) << beside.log;
  EXPECT_NEAR(sag(beside), sag(straight) + half_sine, 1e-8);
  const DeckRun cold(
      rotor(bows[3], round_shaft,
            "type = \"transient\"\nduration = \"5 ms\"\ninitial_speed = \"0 rpm\"\n"));
  EXPECT_EQ(cold.exit, 0) << cold.log;
  const DeckRun series(
      rotor(bows[0], round_shaft,
            "type = \"static\"\nspeeds = { start = \"0 rpm\", stop = \"3000 rpm\", "
            "points = 3 }\n"));
  ASSERT_EQ(series.exit, 0) << series.log;
  EXPECT_FALSE(series.says("W10")) << series.log;
}

// A bow of 50 um does not change what the length of the elements does to the frequencies.
TEST(BowedRotors, MeshIsJudgedAsThatOfStraightOnes) {
  const auto error_of = [](const char* bow, const char* step) {
    const DeckRun r(fmt::format(
        "format = 1\n[model.mesh]\nmin_elements_per_section = 1\n[[shaft]]\nname = \"r\"\nmaterial "
        "= "
        "\"steel\"\n{}columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 700, 60], "
        "[\"b\", 700, 60]]\n[[bearing]]\nat = \"a:start\"\ntype = \"linear\"\nkxx = \"1e8 "
        "N/m\"\nkyy = \"5e7 N/m\"\nkzz = \"5e7 N/m\"\n[[bearing]]\nat = \"b:end\"\ntype = "
        "\"linear\"\nkyy = \"5e7 N/m\"\nkzz = \"5e7 N/m\"\n[[step]]\nname = \"s\"\n{}",
        bow, step));
    EXPECT_EQ(r.exit, 0) << r.log;
    return r.summary("s").at("mesh").at("relative error of frequencies").number();
  };
  const char* bow = "bow = { amount = \"50 um\" }\n";
  for (const char* step : {"type = \"modal\"\nspeed = \"3000 rpm\"\nmodes = 4\n",
                           "type = \"transient\"\nduration = \"10 ms\"\ninitial_speed = \"9000 "
                           "rpm\"\nstart = \"static\"\n"}) {
    const double straight = error_of("", step);
    EXPECT_GT(straight, 1e-4) << step;
    EXPECT_NEAR(error_of(bow, step), straight, 0.02 * straight) << step;
  }
}
