// Lists of modes are complete and verdicts of stability right: random machines on films and linear
// supports, free to turn or nearly so, against all eigenvalues of the same matrices by a dense
// method.
#include "../la/dense_spectrum.hpp"
#include "../validation/deck_model.hpp"
#include "random_machines.hpp"

#include <analysis/spectra/stability.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <core/error.hpp>
#include <gtest/gtest.h>

#include <cstdlib>

using namespace whirl;
using namespace whirl::analysis;
using whirl::test::DeckModel;
using whirl::test::rpm;

namespace {

std::vector<Complex> all_roots(const la::MCK& m, std::span<const unsigned char> active,
                               double scale) {
  return la::test::dense_spectrum(m, la::test::Mask(active.begin(), active.end()), scale);
}

struct Tally {
  int machines = 0, solved = 0, without_equilibrium = 0, certified = 0, certain = 0, unstable = 0,
      diverging = 0, recovered = 0, unresolved = 0;
};

/// One machine at one speed: what the list says against all roots. strict: all lists are certified,
/// and whatever is said to grow does by the dense method.
void check_machine(const DeckModel& d, double Omega, Index count, const std::string& name,
                   Tally& tally, bool strict) {
  Linearizer linear(d.built.system, d.running());
  ModesOptions o;
  o.count = count;
  o.real_roots = true;
  o.judge = true;
  SpectrumCertificate certificate;
  std::vector<WhirlMode> modes;
  try {
    modes = whirl_modes(linear, Omega, o, &certificate);
  } catch (const Error& e) {
    const std::string code = e.diagnostics().front().code;
    ASSERT_TRUE(code == "E75" || code == "E76")
        << name << ": " << e.what();  // no equilibrium: not this test's matter
    ++tally.without_equilibrium;
    return;
  }
  ++tally.solved;
  tally.certified += certificate.complete();
  tally.certain += certificate.stability_certain();
  tally.recovered += certificate.list.recovered > 0;
  if (!certificate.complete())
    std::printf("%s at %g rpm: %s\n", name.c_str(), Omega / rpm, certificate.text().c_str());
  EXPECT_TRUE(certificate.complete() || !strict) << name << ": " << certificate.text();
  const std::vector<Complex> all =
      all_roots(linear.at(Omega), linear.active(), 0.37 * certificate.list.radius);
  double largest = 0;
  for (const Complex s : all)
    largest = std::max(largest, std::abs(s));
  const double rounding = 1e-13 * largest;  // what the dense method leaves of a simple root
  // A free motion is a double root: the dense method leaves the square root of its rounding,
  // relative to its shift.
  const double zero = 1e-6 * certificate.list.radius;
  // What grows is listed whatever its number: the list proper ends at the mode asked for.
  double last = 0;
  Index number = 0;
  for (const WhirlMode& m : modes)
    if (m.oscillates() && ++number <= count) last = m.frequency;
  const la::CountRegion region{certificate.list.radius, certificate.list.reach};
  bool grows = false;
  for (const Complex s : all) {
    if (s.imag() < 0) continue;
    const double near = 1e-6 * std::abs(s) + 1e4 * rounding;
    grows = grows || s.real() > std::max(near, zero);
    const bool oscillates = s.imag() > near;
    const bool inside = region.contains(s * (1 + 1e-9));
    const bool wanted = inside && ((oscillates && s.imag() < last * (1 - 1e-6)) || s.real() > near);
    if (!wanted || std::abs(s) < near || std::abs(s) < zero) continue;
    const bool listed = std::any_of(modes.begin(), modes.end(), [&](const WhirlMode& m) {
      return std::abs(m.lambda - s) < near;
    });
    EXPECT_TRUE(listed) << name << " at " << Omega / rpm << " rpm: " << s.real() << " " << s.imag()
                        << " i is not in the list; " << certificate.text();
  }
  Index oscillating = 0;
  bool said = false;
  for (const WhirlMode& m : modes) {
    if (m.oscillates()) ++oscillating;
    // In the long campaign what grows more slowly than the dense method can tell is not judged by
    // it: films drive an axial mode that has no damping of its own by 1e-10 of its frequency.
    const double resolved =
        strict ? 0.0 : std::max(1e-6 * std::abs(m.lambda) + 1e4 * rounding, zero);
    const bool grows_here = m.growth() > 0;
    said = said || (grows_here && m.lambda.real() > resolved);
    tally.unresolved += grows_here && m.lambda.real() <= resolved;
    tally.diverging += !m.oscillates() && m.growth() > 0;
    if (std::abs(m.lambda) < std::max(zero, 1e4 * rounding)) continue;
    const bool real = std::any_of(all.begin(), all.end(), [&](Complex s) {
      return std::abs(s - m.lambda) < 1e-5 * std::abs(s) + 1e5 * rounding;
    });
    EXPECT_TRUE(real) << name << ": " << m.lambda << " is no root";
  }
  EXPECT_GE(oscillating, count) << name;
  tally.unstable += said;
  if (!certificate.stability_certain()) return;
  EXPECT_EQ(said, grows) << name << " at " << Omega / rpm << " rpm";
}

Tally campaign(unsigned first, unsigned machines,
               tests::RandomMachine::Films films = tests::RandomMachine::Films::some) {
  Tally tally;
  for (unsigned seed = first; seed < first + machines; ++seed) {
    const tests::RandomMachine machine(seed, films);
    ++tally.machines;
    const DeckModel d(machine.deck());
    for (const double share : {0.15, 1.0})
      check_machine(d, share * machine.top_speed() * rpm, 8 + seed % 7,
                    "machine " + std::to_string(seed), tally,
                    films == tests::RandomMachine::Films::some);
  }
  return tally;
}

void report(const Tally& t) {
  std::printf(
      "%d machines, %d spectra (%d without equilibrium), %d certified, %d certain at all "
      "frequencies, %d unstable, %d divergences, %d recovered by the count, %d growths below what "
      "the dense method tells\n",
      t.machines, t.solved, t.without_equilibrium, t.certified, t.certain, t.unstable, t.diverging,
      t.recovered, t.unresolved);
}

}  // namespace

TEST(Certificates, RandomMachinesLoseNoModeAndNoVerdictIsFalse) {
  const char* wanted = std::getenv("WHIRL_CAMPAIGN");  // the long campaign: so many machines
  const Tally t = campaign(1000, wanted ? static_cast<unsigned>(std::atoi(wanted)) : 25);
  EXPECT_EQ(t.certified, t.solved);
  report(t);
}

// The long campaign: 500 machines, all on films. `ctest -L long`. A list that is not certified says
// so; none of them lacks a mode that the dense method finds, and no certified verdict is false.
TEST(Certificates, LongCampaignOfFilms) {
  const char* wanted = std::getenv("WHIRL_FILM_CAMPAIGN");
  const Tally t = campaign(20000, wanted ? static_cast<unsigned>(std::atoi(wanted)) : 4,
                           tests::RandomMachine::Films::always);
  EXPECT_GE(t.certified, t.solved - t.solved / 250);
  report(t);
}

// Cross coupling that grows past the damping with the speed: forward whirl grows from 1000 rad/s on,
// at a rate that stays within the rounding of a fine mesh at the next speed of the search. The onset
// is where the rate is zero, not where it leaves that band, on either mesh.
TEST(Certificates, OnsetIsWhereGrowthIsZeroOnEveryMesh) {
  constexpr double k = 2e6, c = 1e-2;
  Index neutral[2] = {0, 0};
  for (const int elements : {4, 160}) {
    std::string rows;
    const auto row = [&](double spin, double cross) {
      rows +=
          fmt::format("[{}, {}, {}, {:.17g}, {:.17g}, {}, {}],\n", spin, k, k, cross, -cross, c, c);
    };
    row(0, 0.0);
    row(2000, 2 * c * 300);
    std::string text = R"(format = 1
[[shaft]]
name = "r"
material = "steel"
[[shaft.section]]
name = "a"
length = "1 m"
od = "60 mm"
min_elements = )" + std::to_string(elements) +
                       R"(
[[disk]]
name = "d"
at = "a:mid"
mass = "20 kg"
Ip = "0.1 kg.m^2"
Id = "0.06 kg.m^2"
[[step]]
name = "s"
type = "stability"
speed = { start = "100 rpm", stop = "200 rpm", points = 2 }
)";
    for (const char* at : {"start", "end"})
      text += fmt::format(R"([[bearing]]
name = "{0}"
at = "a:{0}"
type = "table"
columns = ["speed[rad/s]", "kyy[N/m]", "kzz[N/m]", "kyz[N/m]", "kzy[N/m]", "cyy[N.s/m]", "czz[N.s/m]"]
rows = [
{1}]
)",
                          at, rows);
    const test::DeckModel a(text);
    analysis::Linearizer linear(a.built.system, a.running());
    linear.stay_undeformed();
    analysis::StabilityOptions o;
    o.motion = analysis::Motion::lateral;
    o.modes = 2;
    o.all = true;
    o.speeds = {200, 1800};
    const analysis::StabilityResult wide = analysis::find_instability(linear, o);
    ASSERT_EQ(wide.onsets.size(), 1u) << elements;
    const double onset = wide.onsets.front().speed;
    // kyz = c w there
    EXPECT_NEAR(onset / 2000 * 600, wide.onsets.front().frequency, 1e-4 * onset);
    o.speeds = {200, onset * (1 + 1e-5), 1800};
    const analysis::StabilityResult close = analysis::find_instability(linear, o);
    ASSERT_EQ(close.onsets.size(), 1u) << elements;
    EXPECT_NEAR(close.onsets.front().speed, onset, 2e-6 * onset) << elements;
    EXPECT_TRUE(close.onsets.front().gains);
    neutral[elements > 100] = close.verdicts[1].neutral;
    if (close.verdicts[1].neutral > 0) {
      EXPECT_GT(close.verdicts[1].neutral_within, 0.0);
      EXPECT_LT(close.verdicts[1].neutral_within, 1e-3);
    }
  }
  EXPECT_GE(neutral[1], 1);
}
