// Decks as engineers write them, against closed forms and finer meshes: machines without a thrust
// bearing, onsets beside motions that nothing damps, amplitudes on the mesh the program chooses,
// lines of a Campbell diagram over both senses of rotation.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

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
