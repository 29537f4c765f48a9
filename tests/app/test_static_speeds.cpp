// Equilibria against speed, as a user asks for them: closed forms and a published table.
#include "deck_run.hpp"
#include "lateral_mass.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <array>
#include <cmath>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// 525 N on a journal of 100 mm, c = 0.1 mm, over the speeds.
std::string deck(const std::string& film, const std::string& speeds) {
  return test::lateral_mass(53.5, "0 m/s^2",
                            R"([[load]]
at = "mass"
force = ["0 N", "0 N", "-525 N"]
[[bearing]]
name = "film"
at = "mass"
diameter = "100 mm"
clearance = "100 um"
)" + film + "[[step]]\nname = \"films\"\ntype = \"static\"\nspeeds = { values = [" +
                                speeds + "] }\n");
}

}  // namespace

// Short bearing, 0.1 Pa s: places, K and C at some speeds in closed form, given to 7 digits and
// more; Sommerfeld number; at 8244.3368 rpm a rigid rotor of W/g is on the verge, whirling at
// 0.500974 of the speed.
TEST(StaticSpeeds, LocusAndCoefficientsOfAShortBearing) {
  const DeckRun d(deck(
      "type = \"short_journal\"\nlength = \"30 mm\"\nviscosity = \"100 mPa.s\"\n",
      R"("250 rpm", "500 rpm", "1000 rpm", "1500 rpm", "2000 rpm", "3000 rpm", "4500 rpm", "6000 rpm", "8244.3368 rpm", "9000 rpm")"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("films_coefficients.csv");
  ASSERT_EQ(t.rows.size(), 10u);
  struct Row {
    std::size_t at;
    double rpm, eps, y, z;
    std::array<double, 4> K, C;
  };
  const Row rows[] = {{0,
                       250,
                       0.6263321828,
                       4.378244406e-05,
                       -4.47885881e-05,
                       {10813626.86, 928977.8507, -22136852.16, 22645568.89},
                       {413413.6043, -422914.0706, -422914.0706, 1348686.009}},
                      {1,
                       500,
                       0.4979192959,
                       4.01964744e-05,
                       -2.938502507e-05,
                       {11614705.86, 4570091.776, -20871774.07, 15257994.97},
                       {308209.3237, -225311.7677, -225311.7677, 663598.367}},
                      {2,
                       1000,
                       0.3505981693,
                       3.164847255e-05,
                       -1.508525599e-05,
                       {12429102.83, 10664141.9, -22053842.74, 10511972.19},
                       {251020.2017, -119648.8708, -119648.8708, 373847.2763}},
                      {3,
                       1500,
                       0.266297509,
                       2.512087788e-05,
                       -8.836578948e-06,
                       {12807959, 16393593, -25060393, 8815302},
                       {232896.93, -81924.37, -81924.37, 294911.62}},
                      {4,
                       2000,
                       0.2125707865,
                       2.048576484e-05,
                       -5.674225211e-06,
                       {13005276.63, 22025300.74, -28956900.97, 8020592.778},
                       {224867.2491, -62284.58759, -62284.58759, 261976.9155}},
                      {5,
                       3000,
                       0.1495988732,
                       1.468979142e-05,
                       -2.829886335e-06,
                       {13186034.91, 33198907.05, -38088177.76, 7337423.025},
                       {218207.4932, -42036.15869, -42036.15869, 235620.1839}},
                      {6,
                       4500,
                       0.1025414757,
                       1.016694842e-05,
                       -1.33442952e-06,
                       {13282337.46, 49894583.47, -53250549.27, 6989226.458},
                       {214901.3209, -28206.16911, -28206.16911, 222860.2186}},
                      {7,
                       6000,
                       0.0777108205,
                       7.733091851e-06,
                       -7.674676941e-07,
                       {13319078.24, 66568204.24, -69112938.37, 6859086.697},
                       {213681.0962, -21206.69731, -21206.69731, 218205.3944}},
                      {9,
                       9000,
                       0.05220674418,
                       5.209147448e-06,
                       -3.467336819e-07,
                       {13346425.28, 99895875.48, -101606178.1, 6763157.422},
                       {212787.0587, -14163.63062, -14163.63062, 214813.5795}}};
  for (const Row& r : rows) {
    const auto at = t.named(t.rows[r.at]);
    EXPECT_NEAR(at.at("speed [rpm]"), r.rpm, 1e-12 * r.rpm);
    EXPECT_NEAR(at.at("eccentricity / clearance [-]"), r.eps, 1e-7 * r.eps);
    EXPECT_NEAR(at.at("y [m]"), r.y, 1e-7 * 1e-4);
    EXPECT_NEAR(at.at("z [m]"), r.z, 1e-7 * 1e-4);
    EXPECT_NEAR(at.at("load [N]"), 525, 1e-6);
    const char* names[] = {"yy", "yz", "zy", "zz"};
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(at.at(fmt::format("k{} [N/m]", names[k])), r.K[k], 2e-7 * std::abs(r.K[2]))
          << r.rpm << " k" << names[k];
      EXPECT_NEAR(at.at(fmt::format("c{} [N s/m]", names[k])), r.C[k], 2e-7 * std::abs(r.C[3]))
          << r.rpm << " c" << names[k];
    }
  }
  EXPECT_NEAR(t.rows[3][t.column("Sommerfeld number [-]")], 3.571428571, 1e-8);
  EXPECT_NEAR(t.rows[3][t.column("Sommerfeld number [-]")] * pi * 0.09, 1.009797639,
              1e-8);  // Ss = S pi (L/D)^2
  EXPECT_NEAR(t.rows[3][t.column("attitude [deg]")], 70.62004779, 1e-6);
  // p^2 = M c Omega^2/W is known to 1e-7 of the speed
  EXPECT_NEAR(t.rows[8][t.column("threshold mass [kg]")], 53.51681957, 1e-6 * 53.5);
  EXPECT_NEAR(t.rows[8][t.column("whirl / speed [-]")], 0.500974, 1e-6);
  EXPECT_TRUE(std::filesystem::exists(d.folder / "r/plots/films_locus.svg"))
      << "the locus has a picture";
}

// Lund & Thomsen (ASME 1978), two axial grooves, L/D = 0.5: one deck over the speeds that have the
// Sommerfeld numbers of the table. Three digits; the locus 0.5 %, K and B 6 % or 0.06.
TEST(StaticSpeeds, LundThomsenTable) {
  const double table[][10] = {{0.244, 0.655, 40.25, 4.21, 3.74, -0.13, 1.64, 6.87, 1.82, 1.54},
                              {0.379, 0.57, 45.43, 3.33, 3.64, -0.43, 1.68, 6.76, 1.87, 1.89},
                              {0.58, 0.477, 51.01, 2.67, 3.7, -0.78, 1.75, 6.96, 1.94, 2.4},
                              {0.917, 0.372, 57.45, 2.12, 4.01, -1.3, 1.85, 7.7, 2.06, 3.23},
                              {1.656, 0.244, 65.85, 1.69, 5.06, -2.2, 1.95, 9.93, 2.15, 4.8}};
  const double W = 525, c = 1e-4, eta = 0.02;
  std::string speeds;
  for (const auto& t : table)
    speeds += fmt::format("{}\"{:.12g} Hz\"", speeds.empty() ? "" : ", ",
                          t[0] * W / (eta * 0.05 * 0.1 * 2.5e5));
  const DeckRun d(
      deck("type = \"journal\"\nshape = \"two_grooves\"\ngroove = \"20 deg\"\nlength = \"50 "
           "mm\"\nviscosity = \"20 mPa.s\"\n",
           speeds));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns csv = d.csv("films_coefficients.csv");
  ASSERT_EQ(csv.rows.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto& t = table[i];
    const auto at = csv.named(csv.rows[i]);
    const double Omega = at.at("speed [rpm]") * pi / 30, k = c / W, b = c * Omega / W;
    EXPECT_NEAR(at.at("Sommerfeld number [-]"), t[0], 1e-9);
    EXPECT_NEAR(at.at("eccentricity / clearance [-]"), t[1], 0.005 * t[1]);
    EXPECT_NEAR(at.at("attitude [deg]"), t[2], 0.005 * t[2]);
    // their x is along the load, -z; their y is +y
    const double got[] = {k * at.at("kzz [N/m]"),   -k * at.at("kzy [N/m]"),
                          -k * at.at("kyz [N/m]"),  k * at.at("kyy [N/m]"),
                          b * at.at("czz [N s/m]"), -b * at.at("czy [N s/m]"),
                          b * at.at("cyy [N s/m]")};
    for (std::size_t q = 0; q < 7; ++q)
      EXPECT_NEAR(got[q], t[q + 3], std::max(0.06, 0.06 * std::abs(t[q + 3])))
          << "S " << t[0] << " column " << q;
  }
}

// A speed at which the film carries too little is left out and named; the others are there. At rest
// a film carries nothing. (At any speed above it an equilibrium exists, ever nearer to the wall;
// beyond what is believed of a film, W03.)
TEST(StaticSpeeds, SpeedsWithoutEquilibriumAreNamed) {
  const DeckRun d(
      deck("type = \"journal\"\nshape = \"plain\"\nlength = \"30 mm\"\nviscosity = \"1 mPa.s\"\n",
           R"("0 rpm", "3000 rpm", "6000 rpm")"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("none at 0 rpm")) << d.log;
  EXPECT_EQ(d.csv("films_coefficients.csv").rows.size(), 2u);
}

// What a film's grid leaves of K and C is estimated on one twice as fine, and that is about the
// distance to a grid so fine that it leaves nothing.
TEST(StaticSpeeds, CoefficientsSayWhatTheirGridLeaves) {
  struct Found {
    std::array<double, 8> entries;
    double error;
  };
  const auto solve = [](const char* grid) {
    const DeckRun d(deck(std::string("type = \"journal\"\nshape = \"two_grooves\"\ngroove = \"20 "
                                     "deg\"\nlength = \"50 mm\"\nviscosity = \"20 mPa.s\"\n") +
                             grid,
                         R"("1500 rpm")"));
    EXPECT_EQ(d.exit, 0) << d.log;
    const Columns csv = d.csv("films_coefficients.csv");
    const auto row = csv.named(csv.rows.at(0));
    Found f;
    std::size_t k = 0;
    for (const char* unit : {"k", "c"})
      for (const char* e : {"yy", "yz", "zy", "zz"})
        f.entries[k++] = row.at(std::string(unit) + e + (unit[0] == 'k' ? " [N/m]" : " [N s/m]"));
    f.error = row.at("grid error [-]");
    EXPECT_EQ(d.summary("films").at("film grid").at("relative error of coefficients").number(),
              f.error);
    return f;
  };
  const Found coarse = solve("grid = 24\n"), chosen = solve(""), fine = solve("grid = 180\n");
  const auto apart = [&](const Found& f, std::size_t first) {
    double d = 0, size = 0;
    for (std::size_t k = first; k < first + 4; ++k) {
      d += std::pow(f.entries[k] - fine.entries[k], 2);
      size += std::pow(fine.entries[k], 2);
    }
    return std::sqrt(d / size);
  };
  const double measured = std::max(apart(coarse, 0), apart(coarse, 4));
  EXPECT_GT(coarse.error, 0.2 * measured);
  EXPECT_LT(coarse.error, 5.0 * measured);
  EXPECT_LT(chosen.error, 5e-3);
  EXPECT_LT(chosen.error, coarse.error);
}

namespace {

std::string torsion_spring(const std::string& speed) {
  return whirl::test::lateral_mass(10, "0 m/s^2", R"([[bearing]]
name = "spring"
at = "mass"
type = "linear"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
krxx = "1e4 N.m/rad"
crxx = "2 N.m.s/rad"
[[load]]
at = "mass"
moment = ["4 N.m", "0 N.m", "0 N.m"]
[[step]]
name = "st"
type = "static"
speed = ")" + speed + "\"\n[output]\nreport = false\n");
}

}  // namespace

// A shaft that stands is held by the spring against its angle; one that turns steadily winds it up
// by nothing. It was held where it stood, and turning it got the mean torque of a revolution of the
// spring, 24 kN m.
TEST(StaticTwist, ASpringAgainstTheAngleOfAShaft) {
  {
    const DeckRun still(torsion_spring("0 rpm"));
    ASSERT_EQ(still.exit, 0) << still.log;
    EXPECT_NEAR(still.csv("st_deflection.csv")
                    .named(still.csv("st_deflection.csv").rows[1])
                    .at("phi [rad]"),
                4e-4, 1e-12);
  }
  const DeckRun turning(torsion_spring("3000 rpm"));
  ASSERT_EQ(turning.exit, 0) << turning.log;
  const Columns supports = turning.csv("st_supports.csv");
  double moment = 0;
  for (const auto& row : supports.rows)
    moment += row[supports.column("M_x [N m]")];
  // the spring's damper: c Omega
  EXPECT_NEAR(moment, -2.0 * 3000 * 3.14159265358979 / 30, 1e-6);
  // An unbalance makes the step look at the whole revolution, which said 3/4 pi times the stiffness.
  const DeckRun unbalanced(torsion_spring("3000 rpm") +
                           "[[unbalance]]\nat = \"mass\"\namount = \"10 g.mm\"\n");
  ASSERT_EQ(unbalanced.exit, 0) << unbalanced.log;
  double again = 0;
  for (const auto& row : unbalanced.csv("st_supports.csv").rows)
    again += row[supports.column("M_x [N m]")];
  EXPECT_NEAR(again, moment, 1e-6);
}
