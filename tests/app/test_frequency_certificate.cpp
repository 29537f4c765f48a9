// Verdicts on supports tabulated against frequency, against the same support with all its states: a
// bearing on a pedestal of mass, spring and damper is a rational function of the frequency.
#include "deck_run.hpp"

#include <complex>
#include <cstdio>

using whirl::test::DeckRun;

namespace {

constexpr double k1 = 2e7, c1 = 2e3;             // N/m, N s/m: bearing
constexpr double m2 = 12.0, k2 = 3e7, c2 = 6e3;  // kg, N/m, N s/m: pedestal

/// A shaft with internal damping and a disk; the right bearing follows.
std::string rotor(const std::string& right, const std::string& last) {
  return R"(format = 1
[output]
report = false
[[shaft]]
name = "r"
material = "steel"
damping = { internal_beta = "4e-5 s" }
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 60], ["b", 400, 60]]
[[disk]]
name = "d"
at = "a:end"
mass = "40 kg"
Ip = "0.4 kg.m^2"
Id = "0.2 kg.m^2"
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
cxx = "1e3 N.s/m"
kyy = "2e7 N/m"
kzz = "2.2e7 N/m"
cyy = "2e3 N.s/m"
czz = "2e3 N.s/m"
)" + right +
         "[[step]]\nname = \"s\"\ntype = \"stability\"\nmodes = 6\nspeed = { start = \"1000 rpm\", "
         "stop = \"" +
         last + " rpm\", points = 8 }\n";
}

std::string with_states() {
  char text[600];
  std::snprintf(text, sizeof text,
                "[[bearing]]\nname = \"R\"\nat = \"b:end\"\ntype = \"linear\"\n"
                "kyy = \"%g N/m\"\nkzz = \"%g N/m\"\ncyy = \"%g N.s/m\"\nczz = \"%g N.s/m\"\n"
                "support = { mass = \"%g kg\", kyy = \"%g N/m\", kzz = \"%g N/m\", cyy = \"%g "
                "N.s/m\", czz = \"%g N.s/m\" }\n",
                k1, k1, c1, c1, m2, k2, k2, c2, c2);
  return text;
}

/// beyond: what the deck says of frequencies beyond the table.
std::string tabulated(const char* beyond) {
  std::string out =
      "[[bearing]]\nname = \"R\"\nat = \"b:end\"\ntype = \"table\"\nextrapolate = \"" +
      std::string(beyond) +
      "\"\ncolumns = [\"speed[rpm]\", \"frequency[Hz]\", \"kyy[N/m]\", \"kzz[N/m]\", "
      "\"cyy[N.s/m]\", \"czz[N.s/m]\"]\nrows = [";
  constexpr int rows = 80;
  constexpr double top = 5000.0;
  for (int i = 0; i < 2 * (rows + 1); ++i) {
    const int k = i % (rows + 1);
    const int rpm = i > rows ? 20000 : 0;
    const double f = k == 0 ? 0.0 : 2.0 * std::pow(top / 2.0, double(k - 1) / (rows - 1));
    const double w = 2.0 * M_PI * std::max(f, 1e-3);
    const std::complex<double> s(0.0, w);
    const std::complex<double> H =
        (k1 + c1 * s) * (m2 * s * s + c2 * s + k2) / (m2 * s * s + (c1 + c2) * s + k1 + k2);
    char row[160];
    std::snprintf(row, sizeof row, "[%d, %.9g, %.12g, %.12g, %.12g, %.12g],\n", rpm, f, H.real(),
                  H.real(), H.imag() / w, H.imag() / w);
    out += row;
  }
  return out + "]\n";
}

}  // namespace

TEST(FrequencyCertificate, OnsetAndVerdictsAreThoseOfTheSupportWithItsStates) {
  double onset = 0;
  {
    const DeckRun d(rotor(with_states(), "15000"));
    ASSERT_EQ(d.exit, 0) << d.log;
    ASSERT_EQ(d.summary("s").at("onsets").items().size(), 1u) << d.log;
    onset = d.summary("s").at("onsets").items()[0].at("speed [rpm]").number();
    EXPECT_TRUE(d.summary("s").at("certified").boolean()) << d.log;
  }
  const DeckRun d(rotor(tabulated("hold"), "15000"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.summary("s").at("certified").boolean()) << d.log;
  EXPECT_TRUE(d.says("along the imaginary axis")) << d.log;
  ASSERT_EQ(d.summary("s").at("onsets").items().size(), 1u);
  EXPECT_NEAR(d.summary("s").at("onsets").items()[0].at("speed [rpm]").number(), onset,
              2e-4 * onset);
  const auto verdicts = d.csv("s_verdicts.csv");
  for (const auto& row : verdicts.rows)
    EXPECT_EQ(row[verdicts.column("growing whirl modes [-]")],
              row[verdicts.column("speed [rpm]")] > onset ? 1 : 0);
}

TEST(FrequencyCertificate, TablesThatEndAreHeldForTheCountAndItIsSaid) {
  const DeckRun d(rotor(tabulated("error"), "4000"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const whirl::io::Value c = d.summary("s").at("certificate").items()[0];
  EXPECT_TRUE(c.at("growing roots counted").boolean()) << c.at("text").text();
  EXPECT_FALSE(c.at("tables held beyond their ends").boolean());
  EXPECT_NE(c.at("text").text().find("held beyond"), std::string::npos);
}

// A table that begins above the lowest speed of a search: the message names step, bearing and the keys
// of that step.
TEST(FrequencyCertificate, UncoveredFrequencyNamesStepAndBearing) {
  std::string deck = rotor(R"([[bearing]]
name = "R"
at = "b:end"
type = "table"
columns = ["speed[rpm]", "frequency[Hz]", "kyy[N/m]", "kzz[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [[0, 5, 1e7, 1e7, 1e3, 1e3], [0, 400, 1e7, 1e7, 1e3, 1e3], [20000, 5, 1e7, 1e7, 1e3, 1e3], [20000, 400, 1e7, 1e7, 1e3, 1e3]]
)",
                           "2000");
  deck = deck.substr(0, deck.find("[[step]]")) +
         "[[step]]\nname = \"c\"\ntype = \"critical_speeds\"\nmax_speed = \"12000 rpm\"\n";
  const DeckRun run(deck);
  EXPECT_TRUE(run.says("E81")) << run.log;
  EXPECT_TRUE(run.says("step 'c'")) << run.log;
  EXPECT_TRUE(run.says("bearing 'R'")) << run.log;
  EXPECT_TRUE(run.says("min_speed")) << run.log;
}
