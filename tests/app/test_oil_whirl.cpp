// Oil whirl of the flexible rotor, from the deck to the results: the onset of the eigenvalues,
// nonlinear runs on both sides of it.
#include "deck_run.hpp"
#include "oil_whirl_rotor.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <tuple>
#include <vector>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// Modes at `rpm`, then a nonlinear run at that speed that starts in the mode on the verge.
std::string run_in_mode(double rpm, double seconds, const char* amplitude, double tolerance) {
  return test::oil_whirl_rotor(fmt::format(R"([[drive]]
name = "motor"
at = "a:start"
type = "speed"
speed = "{0:.9g} rpm"
step = "run"
[[step]]
name = "modes"
type = "modal"
speed = "{0:.9g} rpm"
modes = 4
[[step]]
name = "run"
type = "transient"
start = "mode"
mode = 2
mode_amplitude = "{2}"
duration = "{1:.6g} s"
integrator = {{ tolerance = {3:.1g} }}
[output]
every = "1 ms"
quantities = ["probes", "energy"]
report = false
)",
                                           rpm, seconds, amplitude, tolerance));
}

/// Root of the mean square of the journal's distance from its mean place in [from, from + length),
/// m.
double whirl_in(const Columns& run, double from, double length) {
  const std::size_t t = run.column("t [s]"), y = run.column("journal.y [m]"),
                    z = run.column("journal.z [m]");
  double count = 0, Y = 0, Z = 0, sum = 0;
  for (const auto& row : run.rows)
    if (row[t] >= from && row[t] < from + length) {
      ++count;
      Y += row[y];
      Z += row[z];
    }
  for (const auto& row : run.rows)
    if (row[t] >= from && row[t] < from + length)
      sum += std::pow(row[y] - Y / count, 2) + std::pow(row[z] - Z / count, 2);
  return std::sqrt(sum / count);
}

/// All that stand in a picture.
std::vector<double> numbers_of(const std::string& picture) {
  std::vector<double> out;
  for (const char* c = picture.c_str(); *c != '\0';) {
    char* end = nullptr;
    const double x = std::strtod(c, &end);
    if (end == c) {
      ++c;
      continue;
    }
    if (std::isfinite(x)) out.push_back(x);
    c = end;
  }
  return out;
}

/// 2075.4209 rpm by another code's elements, given to 2e-4.
constexpr double onset = 2075.4209;

}  // namespace

TEST(OilWhirlRuns, OnsetOfTheFlexibleRotor) {
  const DeckRun d(test::oil_whirl_rotor(R"([[step]]
name = "stability"
type = "stability"
speed = { start = "1000 rpm", stop = "3000 rpm", points = 11 }
[output]
report = false
)"));
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_NEAR(d.csv("stability_onset.csv").rows.at(0).at(0), onset, 2e-4 * onset);
}

// A mass on a light shaft (a spring of natural frequency 100, 200, 300 rad/s) between journals
// without mass: Omega = sqrt(keq ks/((keq + ks) M))/WFR, in closed form to eight digits. Shaft and
// journals are lines of their own, so that no torque of the films runs through what bends.
TEST(OilWhirlRuns, OnsetOfAMassOnALightShaft) {
  const double M = 525 / 9.81;
  const auto body = [](const char* name, double kg) {
    return fmt::format(R"([[shaft]]
name = "{0}"
material = "steel"
columns = ["name", "length[mm]", "rigid"]
rows = [["{0} left", 100, true], ["{0} right", 100, true]]
[[disk]]
name = "{0} mass"
at = "{0}/{0} left:end"
mass = "{1:.17g} kg"
Ip = "10 kg.m^2"
Id = "6 kg.m^2"
[[bearing]]
name = "{0} guide"
at = "{0} mass"
type = "rigid"
directions = ["x", "ry", "rz"]
)",
                       name, kg);
  };
  for (const auto& [natural, speed, whirl] : {std::tuple{100.0, 1811.3617, 97.37152},
                                              {200.0, 3430.5272, 181.42303},
                                              {300.0, 4678.6899, 246.38206}}) {
    SCOPED_TRACE(natural);
    const DeckRun d("format = 1\n[model]\ngravity = \"9.81 m/s^2\"\n" + body("rotor", M) +
                    body("journal", 0) +
                    fmt::format(R"([[bearing]]
name = "shaft"
at = "rotor mass"
to = "journal mass"
type = "linear"
kyy = "{0:.17g} N/m"
kzz = "{0:.17g} N/m"
[[bearing]]
name = "film"
at = "journal mass"
type = "short_journal"
diameter = "100 mm"
length = "30 mm"
clearance = "100 um"
viscosity = "100 mPa.s"
[[step]]
name = "stability"
type = "stability"
speed = {{ start = "{1:.6g} rpm", stop = "{2:.6g} rpm", points = 11 }}
modes = 4
[output]
report = false
)",
                                M * natural * natural, 0.5 * speed, 1.5 * speed));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns t = d.csv("stability_onset.csv");
    const auto onset = t.named(t.rows.at(0));
    EXPECT_NEAR(onset.at("speed [rpm]"), speed, 2e-7 * speed);
    EXPECT_NEAR(onset.at("whirl frequency [Hz]") * two_pi, whirl, 2e-7 * whirl);
  }
}

// 0.1 um in a clearance of 100 um is a small motion: it decays below the onset and grows above at
// the rate of the eigenvalue. What is left is the second order in amplitude over clearance, and the
// whole whirl periods that the windows hold to one sample in a thousand.
TEST(OilWhirlRuns, SmallMotionsFollowTheEigenvalue) {
  for (const double factor : {0.98, 1.02}) {
    SCOPED_TRACE(factor);
    const DeckRun d(run_in_mode(factor * onset, 12.0, "2 um", 1e-7));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns modes = d.csv("modes_modes.csv");
    const auto mode = modes.named(modes.rows.at(1));
    const double f = mode.at("frequency [Hz]"), rate = -f * mode.at("log decrement [-]");
    EXPECT_NEAR(f, 17.418836, 0.01 * f);  // that of the onset, nearly
    const Columns run = d.csv("run.csv");
    const double window = 34 / f;
    const double found = std::log(whirl_in(run, 10.0, window) / whirl_in(run, 0.0, window)) / 10.0;
    EXPECT_NEAR(found, rate, 3e-3 * std::abs(rate));
    EXPECT_EQ(found > 0, factor > 1);
  }
}

// From some hundredths of the clearance: below the onset back to the equilibrium, above it out to a
// limit cycle near the bearing wall, which stays.
TEST(OilWhirlRuns, ReturnsBelowAndSettlesInAWhipAbove) {
  {
    const DeckRun d(run_in_mode(0.98 * onset, 30.0, "50 um", 1e-4));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns run = d.csv("run.csv");
    EXPECT_LT(whirl_in(run, 28.9, 1.0), 0.02 * whirl_in(run, 0.0, 1.0));
  }
  {
    const DeckRun d(run_in_mode(1.02 * onset, 26.0, "100 um", 1e-6));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns run = d.csv("run.csv");
    const double before = whirl_in(run, 22.0, 1.0), after = whirl_in(run, 24.9, 1.0);
    EXPECT_GT(after, 80e-6);
    EXPECT_LT(after, 100e-6);
    EXPECT_NEAR(after, before, 0.01 * after);
  }
}

// In the whip the film is 5 um thick, the shaft goes 3 mm, and the whirl is so near half the speed
// that the film's wedge all but vanishes: what the journal does must be right to the clearance,
// whatever the tolerance. At the loosest one the amplitude is that of the tightest to its
// tolerance, and the steps are fewer (they were more, ten times, when journals counted like the
// rest of the shaft and growing steps could be made shorter).
TEST(OilWhirlRuns, WhipAtLooseTolerances) {
  const auto whip = [](double tolerance) {
    const DeckRun d(run_in_mode(1.02 * onset, 26.0, "100 um", tolerance));
    EXPECT_EQ(d.exit, 0) << d.log;
    const io::Value run = d.summary("run");
    return std::pair(run.at("peaks").at("journal").at("amplitude 0-peak [m]").number(),
                     run.at("integrator").at("steps").number());
  };
  const auto [exact, most] = whip(1e-6);
  for (const double tolerance : {1e-3, 1e-4}) {
    const auto [peak, steps] = whip(tolerance);
    EXPECT_NEAR(peak, exact, tolerance * exact) << tolerance;
    EXPECT_LT(steps, 0.5 * most) << tolerance;
  }
}

// A film resists nothing at rest, and nothing happens there that could be judged.
TEST(OilWhirl, ResponseOfABalancedRotorIsZero) {
  const DeckRun run(test::oil_whirl_rotor(R"([[step]]
name = "response"
type = "unbalance_response"
speed = { start = "1500 rpm", stop = "2000 rpm", points = 6 }
)"));
  EXPECT_EQ(run.exit, 0) << run.log;
  EXPECT_TRUE(run.says("W02")) << run.log;
}

// What two probes at 45 degrees see is the same path of the journal; the Bode plot is of 1X wherever
// that stands among the orders, and says what it is worth beside a whirl.
TEST(OilWhirlRuns, PathsAndBodePlotsAreThoseOfTheMotion) {
  std::string deck = test::oil_whirl_rotor(R"([[unbalance]]
at = "disk1"
amount = "500 g.mm"
[[drive]]
at = "a:start"
type = "speed"
speed = { type = "ramp", time = ["0 s", "2 s"], value = ["1500 rpm", "6000 rpm"] }
[[step]]
name = "run"
type = "transient"
start = "static"
duration = "2 s"
[output]
tracking = { orders = [0.5, 1, 2] }
)");
  const auto text = [](const std::filesystem::path& file) {
    std::ostringstream out;
    out << std::ifstream(file).rdbuf();
    return out.str();
  };
  const auto of = [&](const DeckRun& run, const char* what) {
    return text(run.folder / "r" / "plots" / (std::string("run_journal_") + what + ".svg"));
  };
  const DeckRun along(deck);
  ASSERT_EQ(along.exit, 0) << along.log;
  deck.replace(deck.find("name = \"journal\""), 16,
               "name = \"journal\"\nangles = [\"45 deg\", \"135 deg\"]");
  const DeckRun turned(deck);
  ASSERT_EQ(turned.exit, 0) << turned.log;
  const std::vector<double> one = numbers_of(of(along, "centreline")),
                            other = numbers_of(of(turned, "centreline"));
  ASSERT_GT(one.size(), 500u);
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t k = 0; k < one.size(); ++k)
    ASSERT_NEAR(one[k], other[k], 0.03 + 1e-4 * std::abs(one[k])) << k;
  EXPECT_NE(of(along, "bode").find("journal: 1X amplitude"), std::string::npos);
  EXPECT_NE(text(along.folder / "r" / "report.html").find("most of the motion is of other"),
            std::string::npos);
}
