// Decks as engineers write them, against closed forms and finer meshes: machines without a thrust
// bearing, onsets beside motions that nothing damps, amplitudes on the mesh the program chooses,
// lines of a Campbell diagram over both senses of rotation.
#include "deck_run.hpp"

#include <core/types.hpp>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

using whirl::two_pi;
using whirl::test::Columns;
using whirl::test::DeckRun;

namespace {

std::string linear(const std::string& at, const std::string& keys) {
  return fmt::format("[[bearing]]\nat = \"{}\"\ntype = \"linear\"\n{}", at, keys);
}

/// A rotor of 20 kg between two bearings.
std::string rotor(const std::string& bearing, const std::string& rest) {
  return "format = 1\n[output]\nreport = false\n"
         "[[shaft]]\nname = \"s\"\nmaterial = \"steel\"\n"
         "columns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 500, 50], [\"b\", 500, "
         "50]]\n[[disk]]\nat = \"a:end\"\nmass = \"20 kg\"\nIp = \"0.3 kg.m^2\"\nId = \"0.16 "
         "kg.m^2\"\n" +
         bearing + rest;
}

/// A table over the speed of a bearing that drives whirl.
std::string driving_table() {
  std::string rows;
  const double stiffness[] = {5e6, 8e6, 1.2e7, 1.8e7, 2.5e7, 3.3e7, 4.2e7};
  const double damping[] = {5e3, 4e3, 3e3, 2.5e3, 2e3, 1.8e3, 1.5e3};
  for (int k = 0; k < 7; ++k) {
    const double K = stiffness[k];
    rows += fmt::format("[{}, {}, {}, {}, {}, {}, {}], ", 2000 * k, K, 0.8 * K, 0.3 * K, -0.3 * K,
                        damping[k], damping[k]);
  }
  const std::string law =
      "type = \"table\"\ninterpolation = \"linear\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", "
      "\"kzz[N/m]\", \"kyz[N/m]\", \"kzy[N/m]\", \"cyy[N.s/m]\", \"czz[N.s/m]\"]\nrows = [" +
      rows + "]\n";
  return "[[bearing]]\nat = \"a:start\"\n" + law + "[[bearing]]\nat = \"b:end\"\n" + law +
         linear("a:start", "kxx = \"1e7 N/m\"\n");
}

}  // namespace

// A bar that nothing holds has the axial frequencies of a free bar, n c/(2 l); held at one end for the
// equilibrium's sake it had those of a clamped one, half of them.
TEST(NaturalDecks, AFreeBarIsFreeAlongItsAxis) {
  const DeckRun run(
      "format = 1\n[output]\nreport = false\n[model]\nmesh = { min_elements_per_section = 20 "
      "}\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = "
      "\"s\"\nmaterial = \"steel\"\ncolumns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = "
      "[[\"a\", 1000, 40]]\n[[step]]\nname = \"m\"\ntype = \"modal\"\nmotion = \"axial\"\nmodes = "
      "2\n");
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns modes = run.csv("m_modes.csv");
  const DeckRun twisting(
      "format = 1\n[output]\nreport = false\n[model]\nmesh = { min_elements_per_section = 20 "
      "}\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = "
      "\"s\"\nmaterial = \"steel\"\ncolumns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = "
      "[[\"a\", 1000, 40]]\n[[step]]\nname = \"m\"\ntype = \"modal\"\nmotion = "
      "\"torsional\"\nmodes = 2\n");
  const Columns twist = twisting.csv("m_modes.csv");
  const std::size_t f = modes.column("frequency [Hz]");
  ASSERT_EQ(modes.rows.size(), 2u);
  EXPECT_NEAR(modes.rows[1][f], 2 * modes.rows[0][f], 1e-3 * modes.rows[0][f]);
  // both are free bars: sqrt(E/G) = sqrt(2 (1 + nu)) apart, nu = 0.3 of the program's steel
  EXPECT_NEAR(modes.rows[0][f] / twist.rows[0][f], std::sqrt(2.6), 2e-3);
}

// Without a thrust bearing a rotor under its weight has an equilibrium; along its axis it may stand
// anywhere, and that is said. Loaded along its axis it has none.
TEST(NaturalDecks, StaticsNeedNoThrustBearing) {
  const std::string two = linear("a:start", "kyy = \"2e7 N/m\"\nkzz = \"2e7 N/m\"\n") +
                          linear("b:end", "kyy = \"2e7 N/m\"\nkzz = \"2e7 N/m\"\n");
  const std::string step = "[[step]]\nname = \"st\"\ntype = \"static\"\n";
  const DeckRun free(rotor(two, step)),
      held(rotor(two + linear("a:start", "kxx = \"1e7 N/m\"\n"), step));
  ASSERT_EQ(free.exit, 0) << free.log;
  ASSERT_EQ(held.exit, 0) << held.log;
  EXPECT_TRUE(free.says("nothing else holds the axial motion of shaft 's'")) << free.log;
  EXPECT_FALSE(held.says("the axial motion of shaft 's'")) << held.log;
  const Columns own = free.csv("st_deflection.csv"), other = held.csv("st_deflection.csv");
  const std::size_t z = own.column("u_z [m]");
  ASSERT_EQ(own.rows.size(), other.rows.size());
  for (std::size_t k = 0; k < own.rows.size(); ++k)
    EXPECT_NEAR(own.rows[k][z], other.rows[k][z], 1e-9 * std::abs(other.rows[k][z]));
  const DeckRun pushed(
      rotor(two, "[[load]]\nat = \"b:end\"\nforce = [\"10 N\", \"0 N\", \"0 N\"]\n" + step));
  EXPECT_EQ(pushed.exit, 3);
  EXPECT_TRUE(pushed.says("E32")) << pushed.log;
}

// Cross-coupled bearings drive the undamped twist, through the sag, by 1e-10 of its frequency. Where
// lists reached up to it, it was counted as growing, and the search for where it begins to put dozens
// of onsets into the table. What crosses is five motions (dense eigenvalues of another program).
TEST(NaturalDecks, OnsetsAreThoseOfMotionsThatCross) {
  const DeckRun run(rotor(driving_table(),
                          "[[step]]\nname = \"st\"\ntype = \"stability\"\nspeed = { stop = \"12000 "
                          "rpm\", points = 13 }\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns onsets = run.csv("st_onset.csv");
  const std::size_t speed = onsets.column("speed [rpm]"), f = onsets.column("whirl frequency [Hz]");
  const double speeds[] = {5072.56, 7313.15, 8386.80, 11766.80, 11898.46};
  const double frequencies[] = {264.544, 468.378, 641.914, 1201.07, 1239.46};
  ASSERT_EQ(onsets.rows.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(onsets.rows[k][speed], speeds[k], 1e-4 * speeds[k]);
    EXPECT_NEAR(onsets.rows[k][f], frequencies[k], 1e-4 * frequencies[k]);
  }
  EXPECT_EQ(run.csv("st_verdicts.csv").last().at("growing whirl modes [-]"), 6);
}

namespace {

struct Peak {
  double amplitude, factor, said, said_of_factor;
};

Peak peak_of(const std::string& mesh) {
  std::string deck = rotor(
      linear("a:start",
             "kxx = \"1e7 N/m\"\nkyy = \"2e7 N/m\"\nkzz = \"2e7 N/m\"\ncyy = \"3000 "
             "N.s/m\"\nczz = \"3000 N.s/m\"\n") +
          linear("b:end",
                 "kyy = \"2e7 N/m\"\nkzz = \"2e7 N/m\"\ncyy = \"3000 N.s/m\"\nczz = "
                 "\"3000 N.s/m\"\n"),
      "[[unbalance]]\nat = \"a:end\"\namount = \"100 g.mm\"\n[[probe]]\nname = \"P\"\nat = "
      "\"a:mid\"\n[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { start = \"1000 "
      "rpm\", stop = \"6000 rpm\", points = 21 }\n");
  deck.insert(deck.find("[[shaft]]"), mesh);
  const DeckRun run(deck);
  EXPECT_EQ(run.exit, 0) << run.log;
  const auto row = run.csv("u_peaks.csv").last();
  return {row.at("amplitude [m]"), row.at("amplification factor [-]"),
          row.at("mesh error of amplitude [-]"), row.at("mesh error of amplification [-]")};
}

}  // namespace

TEST(NaturalDecks, PeaksKnowWhatTheirElementsLeave) {
  const Peak fine = peak_of("[model.mesh]\nmin_elements_per_section = 40\n");
  for (const char* mesh : {"", "[model.mesh]\nmin_elements_per_section = 1\n"}) {
    const Peak own = peak_of(mesh);
    const double real = std::abs(own.amplitude / fine.amplitude - 1),
                 of_factor = std::abs(own.factor / fine.factor - 1);
    EXPECT_LT(real, 1.3 * own.said + 1e-7) << mesh;
    EXPECT_GT(real, 0.2 * own.said) << mesh;
    EXPECT_LT(of_factor, 1.5 * own.said_of_factor + 1e-6) << mesh;
    EXPECT_GT(of_factor, 0.1 * own.said_of_factor) << mesh;
  }
  EXPECT_LT(fine.said, 1e-6);
}

// A line forward at negative and backward at positive speeds, of a pair at rest that may come out as
// any two circles: named by where it goes.
TEST(NaturalDecks, LinesAreNotNamedAtRest) {
  const DeckRun run(
      "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = "
      "\"s\"\n[[shaft.section]]\nname = \"a\"\nlength = \"0.6 m\"\nrigid = true\n[[disk]]\nat = "
      "\"0.25 m\"\nmass = \"12 kg\"\nIp = \"0.05 kg.m^2\"\nId = \"0.3 kg.m^2\"\n" +
      linear("0 m",
             "kyy = \"2e6 N/m\"\nkzz = \"2e6 N/m\"\ncyy = \"300 N.s/m\"\nczz = \"300 "
             "N.s/m\"\nkxx = \"1e6 N/m\"\n") +
      linear("0.6 m",
             "kyy = \"5e5 N/m\"\nkzz = \"5e5 N/m\"\ncyy = \"100 N.s/m\"\nczz = \"100 "
             "N.s/m\"\n") +
      "[[step]]\nname = \"c\"\ntype = \"campbell\"\nspeed = { start = \"-20000 rpm\", stop = "
      "\"20000 rpm\", points = 5 }\nmodes = 6\n");
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns lines = run.csv("c_campbell.csv");
  const auto last = lines.last();
  // forward whirl rises with the speed, backward whirl falls
  EXPECT_NEAR(last.at("2 F frequency [Hz]"), 159.518, 1e-3);
  EXPECT_NEAR(last.at("2 B frequency [Hz]"), 110.486, 1e-3);
}

// Only the sense of a direction counts: 1e300 has no square.
TEST(NaturalDecks, AnAxisMayBeOfAnyLength) {
  const auto deck = [](const char* axis) {
    return fmt::format(
        "format = 1\n[output]\nreport = false\n[[shaft]]\nname = \"arm\"\nmaterial = "
        "\"steel\"\nrotating = false\ncolumns = [\"name\", \"length[mm]\", \"od[mm]\"]\nrows = "
        "[[\"a\", 500, 20]]\n[[joint]]\nname = \"pin\"\nkind = \"hinge\"\nat = \"a:start\"\naxis = "
        "{}\nstiffness = \"1e4 N.m/rad\"\n[[step]]\nname = \"m\"\ntype = \"modal\"\nmodes = 1\n",
        axis);
  };
  const DeckRun plain(deck("[0, 1, 0]")), huge(deck("[0, 1e300, 0]"));
  ASSERT_EQ(plain.exit, 0) << plain.log;
  ASSERT_EQ(huge.exit, 0) << huge.log;
  EXPECT_EQ(huge.csv("m_modes.csv").last().at("frequency [Hz]"),
            plain.csv("m_modes.csv").last().at("frequency [Hz]"));
}

namespace {

/// A rigid arm, 10 kg and 0.1 kg m2 at its middle, on a joint, and its modes.
std::string arm(const char* joint, const char* keys) {
  return fmt::format(
      "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n[[shaft]]\nname = "
      "\"arm\"\nrotating = false\n[[shaft.section]]\nname = \"a\"\nlength = \"1 m\"\nrigid = "
      "true\n[[disk]]\nat = \"0.5 m\"\nmass = \"10 kg\"\nIp = \"0.1 kg.m^2\"\nId = \"0.5 "
      "kg.m^2\"\n[[joint]]\nat = \"a:start\"\n{}\n[[step]]\nname = \"m\"\ntype = \"modal\"\n{}",
      joint, keys);
}

std::string kind_of_the_mode(const DeckRun& d) {
  return d.summary("m").at("modes").items().front().at("kind").text();
}

}  // namespace

// A mode that lives in the coordinate of its joint alone: 100 N m/rad and 0.1 kg m2 about the axis,
// 1000 N/m and 10 kg across. Where nothing oscillates in the motion asked for, the search ends.
TEST(NaturalDecks, ModesOfJointsAreOfTheKindOfTheirMotion) {
  const char* const pin = "kind = \"hinge\"\naxis = [1, 0, 0]\nstiffness = \"100 N.m/rad\"";
  const DeckRun turning(arm(pin, ""));
  ASSERT_EQ(turning.exit, 0) << turning.log;
  const Columns turns = turning.csv("m_modes.csv");
  ASSERT_EQ(turns.rows.size(), 1u);
  EXPECT_EQ(kind_of_the_mode(turning), "torsional");
  EXPECT_NEAR(turns.last().at("frequency [Hz]"), std::sqrt(1000.0) / (2 * std::numbers::pi), 1e-9);
  EXPECT_EQ(turns.last().at("torsional [%]"), 100);
  const DeckRun across(arm("kind = \"slider\"\naxis = [0, 1, 1]\nstiffness = \"1000 N/m\"", ""));
  ASSERT_EQ(across.exit, 0) << across.log;
  const Columns slides = across.csv("m_modes.csv");
  ASSERT_EQ(slides.rows.size(), 1u);
  EXPECT_EQ(kind_of_the_mode(across), "lateral");
  EXPECT_NEAR(slides.last().at("frequency [Hz]"), 10 / (2 * std::numbers::pi), 1e-9);
  const DeckRun none(arm(pin, "motion = \"lateral\"\n"));
  EXPECT_TRUE(none.says("0 modes")) << none.log;
}

// A flat shaft at a speed of its own: its axes turn with it, not with the reference. Its mirror image
// turns backwards, with angles and cross-coupling the other way round.
TEST(NaturalDecks, FlatShaftsAtSpeedsOfTheirOwn) {
  const auto deck = [](double ratio, const char* kzz, const char* step) {
    const double sense = ratio < 0 ? -1 : 1, share = std::abs(ratio);
    std::string text = fmt::format(
        "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n[shaft]\nname = "
        "\"r\"\nmaterial = \"steel\"\nspeed_ratio = {}\ndamping = {{ external_beta = \"2e-5 s\" "
        "}}\n",
        ratio);
    for (const int length : {300, 550})
      text += fmt::format(
          "[[shaft.section]]\nname = \"s{0}\"\nlength = \"{0} mm\"\nod = \"40 mm\"\ngeneral = {{ A "
          "= "
          "\"1200 mm^2\", Iy = \"1e5 mm^4\", Iz = \"1.4e5 mm^4\", J = \"2e5 mm^4\", kappa_y = "
          "0.85, "
          "kappa_z = 0.85, angle = \"{1} deg\" }}\n",
          length, 20 * sense);
    text +=
        "[[disk]]\nname = \"d\"\nat = \"s300:end\"\nmass = \"15 kg\"\nIp = \"0.12 kg.m^2\"\nId = "
        "\"0.07 kg.m^2\"\n[[probe]]\nname = \"p\"\nat = \"d\"\n";
    for (const char* at : {"s300:start", "s550:end"})
      text += fmt::format(
          "[[bearing]]\nat = \"{}\"\ntype = \"linear\"\nkxx = \"1e8 N/m\"\nkyy = \"2e7 N/m\"\nkzz "
          "= "
          "\"{} N/m\"\nkyz = \"{} N/m\"\nkzy = \"{} N/m\"\ncyy = \"5e3 N.s/m\"\nczz = \"5e3 "
          "N.s/m\"\n",
          at, kzz, 1e6 * sense, -1e6 * sense);
    const std::string speeds =
        std::string(step) == "stability"
            ? fmt::format("speed = {{ start = \"{} rpm\", stop = \"{} rpm\", points = 3 }}\n",
                          2700 / share, 3600 / share)
            : fmt::format("speed = {{ values = [\"{} rpm\", \"{} rpm\"] }}\n", 2000 / share,
                          4500 / share);
    return text +
           fmt::format(
               "[[unbalance]]\nat = \"d\"\namount = \"50 g.mm\"\nphase = \"{} deg\"\n[[step]]\n"
               "name = \"s\"\ntype = \"{}\"\n{}",
               60 * sense, step, speeds);
  };
  // bands on equal supports, where the matrices are constant; responses on unequal ones
  const auto band_of = [&](double ratio) {
    return DeckRun(deck(ratio, "2e7", "stability")).csv("s_bands.csv").last();
  };
  const auto response_of = [&](double ratio) {
    return DeckRun(deck(ratio, "1.5e7", "unbalance_response")).csv("s_response.csv");
  };
  const auto band = band_of(1);
  const Columns response = response_of(1);
  for (const double ratio : {2.0, -1.0, -2.5}) {
    const auto own = band_of(ratio);
    const double share = std::abs(ratio);
    for (const char* edge : {"from [rpm]", "to [rpm]"})
      EXPECT_NEAR(own.at(edge) * share, band.at(edge), 1e-6 * band.at(edge)) << ratio;
    EXPECT_NEAR(own.at("largest growth [1/s]"), band.at("largest growth [1/s]"), 1e-3) << ratio;
    const Columns r = response_of(ratio);
    ASSERT_EQ(r.rows.size(), 2u);
    for (const char* axis : {"p y amplitude [m]", "p z amplitude [m]"})
      for (std::size_t k = 0; k < 2; ++k) {
        const double expected = response.rows[k][response.column(axis)];
        EXPECT_NEAR(r.rows[k][r.column(axis)], expected, 1e-6 * expected) << ratio << " " << axis;
      }
  }
}

// 20 N/m at both ends of 25.7 kg: sqrt(40/25.7) 30/pi = 11.9 rpm, less than a thousandth of 30,000.
TEST(NaturalDecks, CriticalSpeedsFromStandstillOn) {
  const auto deck = [](const char* keys) {
    return rotor(linear("a:start", "kxx = \"20 N/m\"\nkyy = \"20 N/m\"\nkzz = \"20 N/m\"\n") +
                     linear("b:end", "kyy = \"20 N/m\"\nkzz = \"20 N/m\"\n"),
                 std::string("[model]\ngravity = \"0 m/s^2\"\n[[step]]\nname = \"c\"\ntype = "
                             "\"critical_speeds\"\nmax_speed = \"30000 rpm\"\n") +
                     keys);
  };
  const DeckRun whole(deck("min_speed = 0\n"));
  ASSERT_EQ(whole.exit, 0) << whole.log;
  const Columns all = whole.csv("c_undamped.csv");
  const double mass = 20 + 7850 * std::numbers::pi / 4 * 0.05 * 0.05;
  ASSERT_GE(all.rows.size(), 3u);
  EXPECT_NEAR(all.rows[1][all.column("speed [rpm]")], std::sqrt(40 / mass) * 30 / std::numbers::pi,
              0.02);
  EXPECT_FALSE(whole.says("are not looked for")) << whole.log;
  const DeckRun part(deck(""));
  ASSERT_EQ(part.exit, 0) << part.log;
  EXPECT_TRUE(part.says("critical speeds below 30 rpm are not looked for")) << part.log;
}

// 1 kN on a cantilever of 30 mm, 10 mm by 30 mm: P L^3/(3 E I) = 18 um.
TEST(NaturalDecks, NoShearIsNoShearInGeneralSectionsToo) {
  for (const char* centroid : {"0 mm", "1e-6 mm"}) {
    const DeckRun d(fmt::format(
        "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n[[material]]\nname "
        "= "
        "\"s\"\nE = \"200 GPa\"\nnu = 0.3\ndensity = \"8000 kg/m^3\"\n[[shaft]]\nmaterial = "
        "\"s\"\nrotating = false\nshear = \"none\"\n[[shaft.section]]\nname = \"a\"\nlength = "
        "\"0.03 "
        "m\"\nod = \"20 mm\"\ngeneral = {{ A = \"300 mm^2\", Iy = \"22500 mm^4\", Iz = \"2500 "
        "mm^4\", J = \"2600 mm^4\", kappa_y = 0.833, kappa_z = 0.833, centroid = [\"{}\", \"0 "
        "mm\"] "
        "}}\n[[bearing]]\nat = \"a:start\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", \"z\", "
        "\"rx\", \"ry\", \"rz\"]\n[[load]]\nat = \"a:end\"\nforce = [\"0 N\", \"1000 N\", \"0 "
        "N\"]\n[[step]]\nname = \"s\"\ntype = \"static\"\n",
        centroid));
    ASSERT_EQ(d.exit, 0) << d.log;
    EXPECT_NEAR(d.csv("s_deflection.csv").last().at("u_y [m]"), 18e-6, 1e-9) << centroid;
  }
}

namespace {

/// A rigid rotor on two bearings alike, whose stiffness along y falls through zero at 6000 rpm.
std::string softening(double mass, double stiffness, double damping, int points,
                      const std::string& rest = "") {
  const std::string law = fmt::format(
      "type = \"table\"\ninterpolation = \"linear\"\ncolumns = [\"speed[rpm]\", \"kyy[N/m]\", "
      "\"kzz[N/m]\", \"cyy[N.s/m]\", \"czz[N.s/m]\"]\nrows = [[0, {0}, {1}, {2}, {2}], [12000, "
      "-{0}, {1}, {2}, {2}]]\n",
      stiffness, 2 * stiffness, damping);
  return fmt::format(
             "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 "
             "m/s^2\"\n[[shaft]]\nname "
             "= \"s\"\n[[shaft.section]]\nname = \"a\"\nlength = \"0.6 m\"\nrigid = "
             "true\n[[disk]]\nat = \"0.3 m\"\nmass = \"{} kg\"\nIp = \"1e-6 kg.m^2\"\nId = \"0.3 "
             "kg.m^2\"\n[[bearing]]\nat = \"0 m\"\n",
             mass) +
         law + "[[bearing]]\nat = \"0.6 m\"\n" + law + linear("0 m", "kxx = \"1e6 N/m\"\n") +
         fmt::format(
             "[[step]]\nname = \"st\"\ntype = \"stability\"\nspeed = {{ stop = \"12000 "
             "rpm\", points = {} }}\n{}",
             points, rest);
}

}  // namespace

namespace {

/// A wheel on two supports, one of them a table from 500 to 6000 rpm.
std::string on_a_table(const std::string& step) {
  return R"(format = 1
[[shaft]]
name = "rotor"
material = "steel"
columns = ["length[mm]", "od[mm]"]
rows = [[1000, 60]]
[[disk]]
name = "wheel"
at = "500 mm"
mass = "25 kg"
[[bearing]]
name = "A"
at = "0 mm"
type = "table"
columns = ["speed[rpm]", "kyy[N/m]", "kzz[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [[500, 8e7, 8e7, 5e4, 5e4], [3000, 7e7, 7e7, 4e4, 4e4], [6000, 6e7, 6e7, 3e4, 3e4]]
[[bearing]]
name = "B"
at = "1000 mm"
type = "linear"
kxx = "1e8 N/m"
kyy = "7e7 N/m"
kzz = "7e7 N/m"
cyy = "4e4 N.s/m"
czz = "4e4 N.s/m"
[[unbalance]]
at = "wheel"
amount = "100 g.mm"
[[probe]]
name = "P"
at = "wheel"
[output]
report = false
)" + step;
}

}  // namespace

// The force was a difference of both sides: one lies outside the table at its ends.
TEST(NaturalDecks, ForcesAreKnownAtTheEndsOfATable) {
  const std::string deck = on_a_table(
      "[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { values = [\"500 rpm\", "
      "\"501 rpm\", \"5999 rpm\", \"6000 rpm\"] }\n");
  const DeckRun run(deck);
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_FALSE(run.says("not finite")) << run.log;
  const Columns t = run.csv("u_response.csv");
  ASSERT_EQ(t.rows.size(), 4u);
  const std::size_t force = t.column("bearing A force y [N]");
  // as where the same coefficients go on
  std::string held = deck;
  held.replace(held.find("type = \"table\"\n"), 0, "extrapolate = \"hold\"\n");
  const DeckRun beyond(held);
  ASSERT_EQ(beyond.exit, 0) << beyond.log;
  const Columns known = beyond.csv("u_response.csv");
  for (std::size_t row = 0; row < t.rows.size(); ++row)
    EXPECT_NEAR(t.rows[row][force], known.rows[row][force], 1e-6 * known.rows[row][force]);
  // the force of the neighbour within the table, but for the step of speed
  EXPECT_NEAR(t.rows[0][force], t.rows[1][force], 0.01 * t.rows[1][force]);
  EXPECT_NEAR(t.rows[3][force], t.rows[2][force], 0.01 * t.rows[2][force]);
}

// The range begins a thousandth of its end, which no table covers: "the load may lie beyond a limit".
TEST(NaturalDecks, CriticalSpeedsBeginWhereTablesDo) {
  const std::string search =
      "[[step]]\nname = \"c\"\ntype = \"critical_speeds\"\nmax_speed = \"6000 rpm\"\nmotion = "
      "\"lateral\"\n";
  const DeckRun run(on_a_table(search));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(
      run.says("critical speeds below 500 rpm are not looked for: the table of bearing 'A'"))
      << run.log;
  EXPECT_FALSE(run.csv("c_undamped.csv").rows.empty());
  const DeckRun below(on_a_table(search + "min_speed = \"100 rpm\"\n"));
  EXPECT_EQ(below.exit, 3) << below.log;
  EXPECT_TRUE(below.says("E22")) << below.log;
  const DeckRun map(on_a_table(
      "[[step]]\nname = \"m\"\ntype = \"critical_map\"\nmax_speed = \"6000 rpm\"\nstiffness_min = "
      "\"1e6 N/m\"\nstiffness_max = \"1e9 N/m\"\npoints = 5\nbearings = [\"A\", \"B\"]\n"));
  ASSERT_EQ(map.exit, 0) << map.log;
  EXPECT_TRUE(map.says("critical speeds below 500 rpm are not looked for")) << map.log;
  // what ends before the search does is refused, by check too
  const DeckRun far(
      on_a_table("[[step]]\nname = \"c\"\ntype = \"critical_speeds\"\nmax_speed = \"8000 rpm\"\n"));
  EXPECT_EQ(far.exit, 3) << far.log;
  EXPECT_TRUE(far.says("E22")) << far.log;
}

// The line named the largest of the speeds asked for beside a table of larger peaks.
TEST(NaturalDecks, TheLargestResponseCountsThePeaks) {
  const DeckRun run(
      on_a_table("[[step]]\nname = \"u\"\ntype = \"unbalance_response\"\nspeed = { start = \"1000 "
                 "rpm\", stop = "
                 "\"6000 rpm\", points = 6, refine = \"no\" }\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  const Columns peaks = run.csv("u_peaks.csv");
  double most = 0;
  for (const auto& row : peaks.rows)
    for (std::size_t c = 0; c < peaks.names.size(); ++c)
      if (peaks.names[c].find("amplitude") != std::string::npos &&
          peaks.names[c].find("[m]") != std::string::npos)
        most = std::max(most, row[c]);
  ASSERT_GT(most, 0.0);
  EXPECT_NEAR(run.summary("u").at("largest amplitude 0-peak [m]").at("P").number(), most,
              1e-9 * most);
}

// From speed to speed an undamped twist was lost, and with it the certificate.
TEST(NaturalDecks, ATwistThatNothingDampsIsFollowedFromSpeedToSpeed) {
  const DeckRun run(R"(format = 1
[[shaft]]
name = "rotor"
material = "steel"
columns = ["length[mm]", "od_l[mm]", "od_r[mm]"]
rows = [[600, 160, 160], [300, 40, 40]]
[[disk]]
at = "900 mm"
mass = "25 kg"
Ip = "0.6 kg.m^2"
Id = "0.35 kg.m^2"
[[bearing]]
name = "A"
at = "0 mm"
type = "linear"
kxx = "1e8 N/m"
kyy = "8e7 N/m"
kzz = "8e7 N/m"
cyy = "2e4 N.s/m"
czz = "2e4 N.s/m"
[[bearing]]
name = "B"
at = "600 mm"
type = "linear"
kyy = "8e7 N/m"
kzz = "8e7 N/m"
cyy = "2e4 N.s/m"
czz = "2e4 N.s/m"
[output]
report = false
[[step]]
name = "s"
type = "stability"
speed = { values = ["1000 rpm", "1001 rpm", "1002 rpm", "1100 rpm", "3000 rpm"] }
)");
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("certified at 5 speeds")) << run.log;
  const Columns t = run.csv("s_log_decrement.csv");
  for (const auto& row : t.rows)
    EXPECT_NEAR(row[t.column("T1 frequency [Hz]")], 92.1287, 1e-3);
}

// Damping by the stiffness, beside a crowd of decaying roots: the count ends short of it, and the lines
// on the terminal say so as the certificate does. The frequencies are those without damping, w, less
// what the damping ratio beta w/2 takes (rigid bearings: it acts on all there is).
TEST(NaturalDecks, ACountThatEndsShortOfACrowdSaysSo) {
  const auto deck = [](const std::string& damping, const std::string& steps) {
    return "format = 1\n[output]\nreport = false\n[model]\nmesh = { min_elements_per_section = 80 "
           "}\n[[shaft]]\nname = \"s\"\nmaterial = \"steel\"\n" +
           damping +
           "columns = [\"length[mm]\", \"od[mm]\"]\nrows = [[400, 100]]\n[[bearing]]\nat = \"0 "
           "mm\"\ntype = \"rigid\"\ndirections = [\"x\", \"y\", \"z\"]\n[[bearing]]\nat = \"400 "
           "mm\"\ntype = \"rigid\"\ndirections = [\"y\", \"z\"]\n" +
           steps;
  };
  const std::string modal =
      "[[step]]\nname = \"m\"\ntype = \"modal\"\nmotion = \"lateral\"\nmodes = 4\n";
  const DeckRun plain(deck("", modal));
  ASSERT_EQ(plain.exit, 0) << plain.log;
  EXPECT_TRUE(plain.says("Hz, complete,")) << plain.log;
  const Columns undamped = plain.csv("m_modes.csv");
  ASSERT_EQ(undamped.rows.size(), 4u);
  const std::size_t f = undamped.column("frequency [Hz]");
  const double beta = 0.9 / (two_pi * undamped.rows.back()[f]);  // its damping ratio is 0.45
  const DeckRun damped(deck(fmt::format("damping = {{ external_beta = \"{:.9g} s\" }}\n", beta),
                            modal + "[[step]]\nname = \"st\"\ntype = \"stability\"\nmodes = 4\n"
                                    "speed = { stop = \"3000 rpm\", points = 3 }\n"));
  ASSERT_EQ(damped.exit, 0) << damped.log;
  EXPECT_TRUE(damped.says("complete as to what decays no faster than")) << damped.log;
  EXPECT_TRUE(damped.says("all roots that grow or decay slowly accounted for")) << damped.log;
  const Columns found = damped.csv("m_modes.csv");
  ASSERT_EQ(found.rows.size(), 4u) << damped.log;
  for (std::size_t k = 0; k < 4; ++k) {
    const double ratio = 0.5 * beta * two_pi * undamped.rows[k][f],
                 expected = undamped.rows[k][f] * std::sqrt(1 - ratio * ratio);
    EXPECT_NEAR(found.rows[k][f], expected, 1e-6 * expected) << k;
  }
}

// Damping of the material, by its stiffness: hundreds of roots crowd at -1/beta, those of bending as far
// above and below as the rotor turns, amid what is asked for.
// Searches about places of the plane went through them one by one (minutes); where they are is known
// from the first of them that is met. The onset of whirl is that of a coarse mesh, which finds all.
TEST(NaturalDecks, AFineMeshWithMaterialDampingIsJudgedLikeACoarseOne) {
  const auto onset = [](int elements) {
    const DeckRun d(fmt::format(R"(format = 1
[output]
report = false
[model]
mesh = {{ min_elements_per_section = {} }}
[[shaft]]
name = "s"
material = "steel"
damping = {{ internal_beta = "1e-3 s" }}
columns = ["length[mm]", "od[mm]"]
rows = [[300, 60], [200, 80], [300, 60]]
[[disk]]
at = "400 mm"
od = "300 mm"
id = "80 mm"
width = "40 mm"
material = "steel"
[[bearing]]
at = "50 mm"
type = "linear"
kxx = "1e7 N/m"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "2e4 N.s/m"
czz = "2e4 N.s/m"
[[bearing]]
at = "750 mm"
type = "linear"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "2e4 N.s/m"
czz = "2e4 N.s/m"
[[step]]
name = "m"
type = "modal"
speed = "6000 rpm"
modes = 12
[[step]]
name = "lateral"
type = "modal"
motion = "lateral"
speed = "6000 rpm"
modes = 12
[[step]]
name = "st"
type = "stability"
modes = 4
speed = {{ values = ["9000 rpm", "10000 rpm"] }}
)",
                                elements));
    EXPECT_EQ(d.exit, 0) << d.log;
    EXPECT_TRUE(d.says("certified at 2 speeds: all roots")) << d.log;
    EXPECT_TRUE(elements < 10 || d.says("complete as to what decays no faster than")) << d.log;
    const Columns t = d.csv("st_onset.csv");
    EXPECT_EQ(t.rows.size(), 1u) << d.log;
    return t.rows.empty() ? 0.0 : t.rows.front()[t.column("speed [rpm]")];
  };
  const double coarse = onset(4);
  EXPECT_GT(coarse, 9400.0);
  EXPECT_NEAR(onset(20), coarse, 2e-4 * coarse);
}

// A second spool's unbalance has critical speeds of its own: without `orders` they are looked for once a
// turn of every shaft. Its peaks in the response stand where they are.
TEST(NaturalDecks, EverySpoolHasItsCriticalSpeeds) {
  const std::string machine = R"(format = 1
[output]
report = false
[[shaft]]
name = "lp"
material = "steel"
columns = ["name", "length[mm]", "od[mm]", "id[mm]"]
rows = [["fan", 150, 60, 40], ["core", 550, 60, 40], ["turbine", 150, 60, 40]]
[[shaft]]
name = "hp"
origin = ["200 mm", "0 mm", "0 mm"]
material = "steel"
speed_ratio = -1.5
columns = ["name", "length[mm]", "od[mm]", "id[mm]"]
rows = [["compressor", 200, 110, 95], ["combustor", 250, 110, 95]]
[[disk]]
name = "fan disk"
at = "lp/fan:mid"
mass = "12 kg"
Ip = "0.15 kg.m^2"
Id = "0.08 kg.m^2"
[[disk]]
name = "hp disk"
at = "hp/compressor:mid"
mass = "8 kg"
Ip = "0.08 kg.m^2"
Id = "0.045 kg.m^2"
[[bearing]]
at = "lp/fan:start"
type = "linear"
kxx = "5e7 N/m"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
cyy = "2e2 N.s/m"
czz = "2e2 N.s/m"
[[bearing]]
at = "lp/turbine:end"
type = "linear"
kyy = "1.5e7 N/m"
kzz = "1.5e7 N/m"
cyy = "2e2 N.s/m"
czz = "2e2 N.s/m"
[[bearing]]
at = "hp/compressor:start"
type = "linear"
kxx = "5e7 N/m"
kyy = "3e7 N/m"
kzz = "3e7 N/m"
cyy = "2e2 N.s/m"
czz = "2e2 N.s/m"
[[bearing]]
at = "lp/640 mm"
to = "hp/combustor:end - 10 mm"
type = "linear"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
cyy = "2e2 N.s/m"
czz = "2e2 N.s/m"
[[unbalance]]
at = "hp disk"
amount = "50 g.mm"
[[probe]]
name = "hp"
at = "hp disk"
)";
  const auto steps = [](const std::string& orders) {
    return R"([[step]]
name = "c"
type = "critical_speeds"
motion = "lateral"
max_speed = "12000 rpm"
)" + orders +
           R"([[step]]
name = "d"
type = "campbell"
motion = "lateral"
modes = 6
speed = { stop = "12000 rpm", points = 13 }
)" + orders;
  };
  const DeckRun plain(machine + steps("") + R"([[step]]
name = "u"
type = "unbalance_response"
speed = { start = "1000 rpm", stop = "10000 rpm", points = 91 }
)");
  ASSERT_EQ(plain.exit, 0) << plain.log;
  EXPECT_TRUE(plain.says("c: 1x: ")) << plain.log;
  EXPECT_TRUE(plain.says("; 1.5x: ")) << plain.log;
  const DeckRun asked(machine + steps("orders = [1, 1.5]\n"));
  ASSERT_EQ(asked.exit, 0) << asked.log;
  for (const char* table : {"c_damped.csv", "c_undamped.csv", "d_critical_speeds.csv"}) {
    const Columns a = plain.csv(table), b = asked.csv(table);
    ASSERT_EQ(a.rows.size(), b.rows.size()) << table;
    for (std::size_t k = 0; k < a.rows.size(); ++k)
      for (std::size_t j = 0; j < 3; ++j)
        EXPECT_TRUE(a.rows[k][j] == b.rows[k][j] || std::isnan(a.rows[k][j])) << table << " " << k;
  }
  const Columns criticals = plain.csv("c_damped.csv"), peaks = plain.csv("u_peaks.csv");
  ASSERT_FALSE(peaks.rows.empty());
  for (const auto& peak : peaks.rows) {
    const double speed = peak[peaks.column("speed [rpm]")];
    double nearest = 1e9;
    for (const auto& row : criticals.rows)
      if (row[criticals.column("order [-]")] == 1.5)
        nearest = std::min(nearest, std::abs(row[criticals.column("speed [rpm]")] - speed));
    EXPECT_LT(nearest, 0.01 * speed) << speed;
  }
}

// An unbalance is an eccentricity of what stands at its node: of a slice of shaft the larger, the finer
// the mesh. That is no asymmetry of the rotor, for which linear runs are refused.
TEST(NaturalDecks, AnUnbalanceOnABareShaftIsNoAsymmetry) {
  const auto deck = [](int elements, const std::string& linear) {
    return fmt::format(R"(format = 1
[output]
report = false
[model]
mesh = {{ min_elements_per_section = {} }}
[[shaft]]
name = "s"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 50], ["b", 500, 50]]
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
cyy = "2e3 N.s/m"
czz = "2e3 N.s/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
cyy = "2e3 N.s/m"
czz = "2e3 N.s/m"
[[unbalance]]
at = "a:end"
amount = "50 g.mm"
[[probe]]
name = "p"
at = "a:end"
[[drive]]
at = "a:start"
type = "speed"
speed = "3000 rpm"
[[step]]
name = "t"
type = "transient"
duration = "0.1 s"
integrator = {{ tolerance = 1e-6 }}
{})",
                       elements, linear);
  };
  const auto peak = [&](int elements, const std::string& linear) {
    const DeckRun d(deck(elements, linear));
    EXPECT_EQ(d.exit, 0) << d.log;
    if (d.exit != 0) return 0.0;
    return d.summary("t").at("peaks").at("p").at("amplitude 0-peak [m]").number();
  };
  const double general = peak(20, "");
  EXPECT_GT(general, 1e-7);
  for (const int elements : {5, 20, 40})
    EXPECT_NEAR(peak(elements, "linear = true\n"), general, 1e-4 * general) << elements;
}

// Hysteretic damping has no form in time: motions have its stand-in or none, linear ones and those that
// begin in a steady response as well. (As it is in frequency, a circulation, it drove the fast modes of a
// linear run beyond all bounds.)
TEST(NaturalDecks, HystereticDampingIsItsStandInInEveryMotion) {
  const auto deck = [](const std::string& stand_in, const std::string& step) {
    return R"(format = 1
[output]
report = false
[[shaft]]
name = "s"
material = "steel"
damping = { internal_loss_factor = 0.02)" +
           stand_in + R"( }
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 50], ["b", 500, 50]]
[[disk]]
name = "D"
at = "a:end"
mass = "20 kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
cyy = "100 N.s/m"
czz = "100 N.s/m"
[[bearing]]
at = "b:end"
type = "linear"
kyy = "2e7 N/m"
kzz = "2e7 N/m"
cyy = "100 N.s/m"
czz = "100 N.s/m"
[[unbalance]]
at = "D"
amount = "50 g.mm"
[[probe]]
name = "p"
at = "D"
[[drive]]
at = "a:start"
type = "speed"
speed = "6000 rpm"
[[step]]
name = "t"
type = "transient"
integrator = { tolerance = 1e-7 }
)" + step;
  };
  const auto peak = [&](const std::string& stand_in, const std::string& step) {
    const DeckRun d(deck(stand_in, step));
    EXPECT_EQ(d.exit, 0) << d.log;
    return d.summary("t").at("peaks").at("p").at("amplitude 0-peak [m]").number();
  };
  for (const char* stand_in : {"", ", internal_loss_frequency = \"30 Hz\""}) {
    const double general = peak(stand_in, "duration = \"0.06 s\"\n");
    EXPECT_NEAR(peak(stand_in, "duration = \"0.06 s\"\nlinear = true\n"), general, 1e-5 * general)
        << stand_in;
    // a steady motion stays what it is
    const std::string steady = "start = \"unbalance_response\"\n";
    const double first = peak(stand_in, "duration = \"0.02 s\"\n" + steady);
    EXPECT_NEAR(peak(stand_in, "duration = \"0.1 s\"\n" + steady), first, 1e-5 * first) << stand_in;
  }
}

// A loss factor beside tilting pads: one heavily damped motion of many has no frequency of its own, beyond
// all that a verdict needs. It ended the whole step (E77).
TEST(NaturalDecks, OneMotionWithoutAFrequencyOfItsOwnEndsNoVerdict) {
  const DeckRun d(R"(format=1
[output]
report=false
[model]
gravity="9.81 m/s^2"
[[shaft]]
name="rotor"
material="steel"
damping={internal_loss_factor=0.0175}
columns=["name","length[mm]","od[mm]","id[mm]"]
rows=[["s0",314.3,88.49,35.4],["s1",358.39,25.13,0],["s2",365.68,68.13,27.25],["s3",77.79,55.65,0],["s4",227.11,62.93,0]]
[[bearing]]
name="DE"
at="s1:mid"
type="tilting_pad"
pads=4
first_pivot="-90 deg"
preload=0.14
diameter="25.13 mm"
length="11.71 mm"
clearance="49.43 um"
iso_vg=32
temperature="45 degC"
[[bearing]]
name="NDE"
at="s4:mid"
type="tilting_pad"
pads=4
first_pivot="-54 deg"
preload=0.15
diameter="62.93 mm"
length="42.14 mm"
clearance="101.5 um"
iso_vg=32
temperature="45 degC"
[[bearing]]
name="thrust"
at="s0:start"
type="linear"
kxx="1e8 N/m"
cxx="1e4 N.s/m"
[[bearing]]
name="xc"
at="s2:mid"
type="cross_coupling"
k="5.13e+04 N/m"
[[step]]
name="st"
type="stability"
speed={values=["2700 rpm","4500 rpm"]}
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("certified up to")) << d.log;
  const Columns t = d.csv("st_onset.csv");
  ASSERT_EQ(t.rows.size(), 1u);
  EXPECT_NEAR(t.rows.front()[t.column("speed [rpm]")], 3803.3, 0.5);
}

// The free spin of a small rotor on a damper: a double zero beside slow real roots. A list that was long
// enough before the search came to it was INCOMPLETE, or rounding hid it from a small shift.
TEST(NaturalDecks, TheFreeSpinOfASmallRotorIsInEveryList) {
  for (const int modes : {1, 4, 6, 8, 10, 12}) {
    const DeckRun d(fmt::format(R"(format=1
[output]
report=false
[model]
gravity="0 m/s^2"
[[shaft]]
name="rotor"
material="titanium"
columns=["name","length[mm]","od[mm]","id[mm]"]
rows=[["s0",43.87,14.55,5.82],["s1",40.18,5.91,0],["s2",64.91,5.13,0],["s3",62.33,9.2,0]]
[[bearing]]
name="DE"
at="s0:mid"
type="linear"
kyy="3.279e+04 N/m"
kzz="3.279e+04 N/m"
kyz="0 N/m"
kzy="-0 N/m"
cyy="2.398 N.s/m"
czz="2.398 N.s/m"
support={{mass="0.0113 kg",kyy="9.18e+04 N/m",kzz="1.38e+05 N/m",cyy="2.19 N.s/m",czz="2.19 N.s/m"}}
[[bearing]]
name="NDE"
at="s3:mid"
type="squeeze_film"
film="finite"
diameter="14.72 mm"
length="4.416 mm"
clearance="29.4 um"
viscosity="10 mPa.s"
stiffness="2.3e+04 N/m"
[[bearing]]
name="thrust"
at="s0:start"
type="linear"
kxx="1e8 N/m"
cxx="1e4 N.s/m"
[[step]]
name="m"
type="modal"
speed="2000 rpm"
modes={}
)",
                                modes));
    EXPECT_EQ(d.exit, 0) << d.log;
    EXPECT_TRUE(d.says("Hz, complete,")) << d.log;
  }
}

// The search for a critical speed by secants left its bracket for a speed of nearly zero, where films carry
// nothing (E75 "at 0 rpm" of a search from 300 rpm on). That of the Campbell diagram is 2035 rpm.
TEST(NaturalDecks, ASearchForACriticalSpeedAsksForNoSpeedBeyondIt) {
  const DeckRun d(R"(format=1
[output]
report=false
[model]
gravity="9.81 m/s^2"
[[shaft]]
name="rotor"
material="inconel_718"
damping={internal_beta="4.4e-07 s",external_beta="3e-05 s"}
columns=["name","length[mm]","od[mm]","id[mm]"]
rows=[["s0",286.8,70.5,0],["s1",110.99,63.37,0],["s2",557.73,60.57,0]]
[[disk]]
name="D0"
at="s0:end"
mass="44.99 kg"
Ip="1.105 kg.m^2"
Id="0.9582 kg.m^2"
[[disk]]
name="D1"
at="s1:end"
mass="41.99 kg"
Ip="0.6749 kg.m^2"
Id="0.4585 kg.m^2"
[[disk]]
name="D2"
at="s2:mid"
mass="34.56 kg"
Ip="0.2707 kg.m^2"
Id="0.1685 kg.m^2"
[[bearing]]
name="DE"
at="s0:mid"
type="tilting_pad"
pads=5
first_pivot="-45 deg"
preload=0.31
diameter="70.5 mm"
length="62.9 mm"
clearance="72.18 um"
iso_vg=46
temperature="45 degC"
[[bearing]]
name="NDE"
at="s2:mid"
type="tilting_pad"
pads=4
first_pivot="-90 deg"
preload=0.4
diameter="60.57 mm"
length="48.01 mm"
clearance="61.71 um"
iso_vg=46
temperature="65 degC"
[[bearing]]
name="thrust"
at="s0:start"
type="linear"
kxx="1e8 N/m"
cxx="1e4 N.s/m"
[[step]]
name="c"
type="critical_speeds"
motion="lateral"
min_speed="300 rpm"
max_speed="3000 rpm"
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("c_damped.csv");
  ASSERT_EQ(t.rows.size(), 1u) << d.log;
  EXPECT_NEAR(t.rows.front()[t.column("speed [rpm]")], 2035.4, 0.5);
}

// Two tilts of rigid pedestals that nothing damps, at 5033 Hz: their rounding counted as growth, and a
// list of eight modes went on to them.
TEST(NaturalDecks, ANeutralModeFarBeyondTheListIsNotInIt) {
  const DeckRun d(R"(format=1
[output]
report=false
[model]
gravity="9.81 m/s^2"
[[shaft]]
name="rotor"
material="steel"
columns=["name","length[mm]","od[mm]","min_elements"]
rows=[["a",600,100,4],["b",600,110,4]]
[[disk]]
name="D"
at="rotor/a:end"
mass="150 kg"
Ip="4 kg.m^2"
Id="2.5 kg.m^2"
[[bearing]]
name="thrust"
at="rotor/a:start"
type="linear"
kxx="1e8 N/m"
cxx="1e4 N.s/m"
krxx="0 N.m/rad"
[[shaft]]
name="cDE"
origin=["-5 mm","0 mm","0 mm"]
rotating=false
[[shaft.section]]
name="c"
length="10 mm"
rigid=true
[[disk]]
name="MDE"
at="cDE/c:mid"
mass="40 kg"
Ip="1 kg.m^2"
Id="1 kg.m^2"
[[bearing]]
name="gDE"
at="cDE/c:mid"
type="linear"
kyy="3e+08 N/m"
kzz="4e+08 N/m"
cyy="20000 N.s/m"
czz="20000 N.s/m"
kxx="1e9 N/m"
krr="1e9 N.m/rad"
krxx="1e9 N.m/rad"
[[shaft]]
name="cNDE"
origin=["1195 mm","0 mm","0 mm"]
rotating=false
[[shaft.section]]
name="c"
length="10 mm"
rigid=true
[[disk]]
name="MNDE"
at="cNDE/c:mid"
mass="60 kg"
Ip="1 kg.m^2"
Id="1 kg.m^2"
[[bearing]]
name="gNDE"
at="cNDE/c:mid"
type="linear"
kyy="2e+08 N/m"
kzz="5e+08 N/m"
cyy="30000 N.s/m"
czz="30000 N.s/m"
kxx="1e9 N/m"
krr="1e9 N.m/rad"
krxx="1e9 N.m/rad"
[[bearing]]
name="DE"
at="rotor/a:start"
type="floating_ring"
inner={diameter="60 mm",length="40 mm",clearance="50 um",viscosity="10 mPa.s"}
outer={diameter="80 mm",length="50 mm",clearance="80 um",viscosity="12 mPa.s"}
to="cDE/c:mid"
[[bearing]]
name="NDE"
at="rotor/b:end"
type="floating_ring"
inner={diameter="60 mm",length="40 mm",clearance="50 um",viscosity="10 mPa.s"}
outer={diameter="80 mm",length="50 mm",clearance="80 um",viscosity="12 mPa.s"}
to="cNDE/c:mid"
[[step]]
name="m"
type="modal"
speed="5000 rpm"
modes=8
motion="lateral"
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_EQ(d.csv("m_modes.csv").rows.size(), 8u) << d.log;
}

// Bounce and tilt along y lose their stiffness at 6000 rpm both. A light rotor on stiff bearings parts
// from zero so fast that its divergence was taken for growth that has no onset, and called stable.
TEST(NaturalDecks, DivergenceBeginsWhereTheStiffnessEnds) {
  for (const double mass : {0.05, 12.0})
    for (const double stiffness : {1e5, 1e7, 1e9})
      for (const double ratio : {0.0, 1e-3, 3.0})
        for (const int points : {3, 6, 13}) {
          const DeckRun run(
              softening(mass, stiffness, ratio * std::sqrt(stiffness * mass), points));
          const std::string what =
              fmt::format("{} kg, {} N/m, damping {}: {}", mass, stiffness, ratio, run.log);
          ASSERT_EQ(run.exit, 0) << what;
          EXPECT_TRUE(run.says("instability above 6000 rpm, diverging without whirl")) << what;
          const Columns onsets = run.csv("st_onset.csv");
          ASSERT_EQ(onsets.rows.size(), 2u) << what;
          for (const auto& row : onsets.rows)
            EXPECT_NEAR(row[onsets.column("speed [rpm]")], 6000, 1e-5) << what;
          EXPECT_EQ(run.csv("st_verdicts.csv").last().at("diverging motions [-]"), 2) << what;
        }
}

namespace {

/// A rigid stretch of 200 mm in rigid bearings at its ends, its disk off the middle by `arm` mm
/// towards the end at x = 200 mm; the bearing there holds x too (`locating` = 1), or that at x = 0.
/// last: that one is named last.
std::string rigid_stretch(double arm, int locating, bool last) {
  const auto bearing = [&](int end) {
    return fmt::format(
        "[[bearing]]\nname = \"{}\"\nat = \"link:{}\"\ntype = \"rigid\"\ndirections = [{}\"y\", "
        "\"z\"]\n",
        "AB"[end], end == 0 ? "start" : "end", end == locating ? "\"x\", " : "");
  };
  return fmt::format(R"(format = 1
[[shaft]]
name = "s"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["link", 200, true]]
[[disk]]
name = "d"
at = "link:start + {} mm"
mass = "20 kg"
Ip = "0.05 kg.m^2"
Id = "0.03 kg.m^2"
[[load]]
at = "d"
force = ["{} N", "300 N", "0 N"]
[[unbalance]]
at = "d"
amount = "1000 g.mm"
{}{}[[step]]
name = "st"
type = "static"
[[step]]
name = "tr"
type = "transient"
duration = "20 ms"
initial_speed = "3000 rpm"
[output]
report = false
quantities = ["bearing_force"]
)",
                     100 + arm, locating == 1 ? -50 : 50, bearing(last ? 1 - locating : locating),
                     bearing(last ? locating : 1 - locating));
}

}  // namespace

// The bearing that holds x stood at the left end and first in the deck, or was refused (E26). F_y and
// F_z by the lever rule, F_x = 50 N.
TEST(NaturalDecks, ARigidStretchIsHeldAlongItsAxisAtEitherEnd) {
  for (const int locating : {0, 1})
    for (const bool last : {false, true}) {
      const DeckRun run(rigid_stretch(locating == 1 ? 30 : -30, locating, last));
      ASSERT_EQ(run.exit, 0) << run.log;
      const Columns tr = run.csv("tr.csv");
      const std::string here = fmt::format("bearing {} force", "AB"[locating]),
                        there = fmt::format("bearing {} force", "BA"[locating]);
      const DeckRun first(rigid_stretch(-30, 0, false));
      const Columns left = first.csv("tr.csv");
      ASSERT_EQ(left.rows.size(), tr.rows.size());
      const auto a = tr.last(), b = left.last();
      const double sign = locating == 1 ? -1 : 1;
      EXPECT_NEAR(a.at(here + ".x [N]"), -50 * sign, 1e-6);
      for (const char* along : {".x [N]", ".y [N]", ".z [N]"}) {
        const double s = along[1] == 'x' ? sign : 1;
        EXPECT_NEAR(a.at(here + along), s * b.at(std::string("bearing A force") + along), 1e-6)
            << along;
        EXPECT_NEAR(a.at(there + along), s * b.at(std::string("bearing B force") + along), 1e-6)
            << along;
      }
    }
}

TEST(NaturalDecks, MotionOfTheBaseIsTakenAtItsBeginningWithoutTime) {
  const std::string base =
      "[base]\ny = { type = \"harmonic\", mean = \"1 m/s^2\", amplitude = \"2 m/s^2\", frequency = "
      "\"20 Hz\" }\nz = \"3 m/s^2\"\n";
  const DeckRun run(rotor(linear("a:start",
                                 "kxx = \"1e7 N/m\"\nkyy = \"1e7 N/m\"\nkzz = \"1e7 "
                                 "N/m\"\n") +
                              linear("b:end", "kyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\n"),
                          base + "[[step]]\nname = \"st\"\ntype = \"static\"\n"));
  ASSERT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("acceleration along y of the base at its value at t = 0, 3 m/s^2"))
      << run.log;
  EXPECT_FALSE(run.says("acceleration along z")) << run.log;
}

// 1 and 2 kg m2 on a shaft, driven on the branch of an induction motor's torque that rises with the
// speed: k' > 0 at the one disc makes both twist ever more.
TEST(NaturalDecks, TorsionalModesThatGrowAreCounted) {
  const auto line = [](const char* from) {
    const DeckRun run(
        std::string("format = 1\n[output]\nreport = false\n[[shaft]]\nname = "
                    "\"s\"\nmaterial = \"steel\"\ncolumns = [\"name\", "
                    "\"length[mm]\", \"od[mm]\"]\nrows = [[\"a\", 500, 40]]\n") +
        "[[disk]]\nat = \"a:start\"\nmass = \"20 kg\"\nIp = \"1 kg.m^2\"\nId = \"0.6 "
        "kg.m^2\"\n[[disk]]\nat = \"a:end\"\nmass = \"20 kg\"\nIp = \"2 kg.m^2\"\nId "
        "= \"1.2 kg.m^2\"\n" +
        linear("a:start", "kxx = \"1e7 N/m\"\nkyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\n") +
        linear("a:end", "kyy = \"1e7 N/m\"\nkzz = \"1e7 N/m\"\n") +
        "[[drive]]\nat = \"a:start\"\ntype = \"torque\"\ninduction = { breakdown = "
        "\"500 N.m\", slip_breakdown = 0.1, synchronous = \"1500 rpm\" }\n[[step]]\nname "
        "= \"t\"\ntype = \"torsional\"\nmodes = 1\nmax_speed = \"" +
        from + "\"\n");
    EXPECT_EQ(run.exit, 0) << run.log;
    return run.says("1 torsional modes (1 unstable)");
  };
  EXPECT_TRUE(line("1200 rpm"));
  EXPECT_FALSE(line("1450 rpm"));
}

namespace {

/// An example, with other steps.
std::string example_with(const std::string& name, const std::string& steps) {
  std::ifstream in(std::string(WHIRL_SOURCE) + "/examples/" + name + "/deck.toml");
  std::string text((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  text = text.substr(0, text.find("[[step]]"));
  return text + steps + "[output]\nreport = false\n";
}

}  // namespace

// Massless nodes under damping in proportion to their stiffness have the one rate -1/beta twelve times over,
// two bearings alike each rate of their pads twice: copies that no search tells apart make no list
// incomplete, however many and of however many rates they are.
TEST(NaturalDecks, CopiesOfDecayingRootsAreNotMissing) {
  const DeckRun shaft(example_with(
      "07_internal_damping", "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"0 rpm\"\n"));
  ASSERT_EQ(shaft.exit, 0) << shaft.log;
  EXPECT_TRUE(shaft.says("complete") && !shaft.says("INCOMPLETE")) << shaft.log;
  const DeckRun pads(example_with("28_tilting_pads",
                                  "[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = { start = "
                                  "\"500 rpm\", stop = \"3000 rpm\", points = 4 }\n"));
  ASSERT_EQ(pads.exit, 0) << pads.log;
  EXPECT_TRUE(pads.says("certified at 4 speeds")) << pads.log;
}

TEST(NaturalDecks, AModelWithoutMassHasNoModesAndSaysWhy) {
  const DeckRun d(example_with("32_bend", "[[step]]\nname = \"m\"\ntype = \"modal\"\n"));
  EXPECT_TRUE(d.says("without mass")) << d.log;
}
