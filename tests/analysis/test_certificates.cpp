// Lists of modes are complete and verdicts of stability right: random machines on films and linear
// supports, free to turn or nearly so, against all eigenvalues of the same matrices by a dense
// method.
#include "../validation/deck_model.hpp"
#include "machine_checks.hpp"
#include "random_machines.hpp"

#include <analysis/spectra/stability.hpp>
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

using namespace whirl;
using namespace whirl::analysis;
using whirl::test::DeckModel;
using whirl::test::rpm;
using whirl::tests::check_machine;
using whirl::tests::report;
using whirl::tests::Tally;

namespace {

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

// Loss factors: each mode has a damping at its own rate, and the twist that follows lateral motion is
// free to turn at any of them. Lateral lists are whole, and with inertia along and about the axis each
// of their modes is there too, where it is not strongly damped (there the shaft's end may pull it).
TEST(Certificates, LateralModesWithALossFactorAreAmongAll) {
  constexpr unsigned machines = 24;
  std::mt19937 rng(5);
  int compared = 0;
  for (unsigned seed = 1; seed <= machines; ++seed) {
    const tests::RandomMachine machine(40000 + seed);
    std::string deck = machine.deck();
    const std::size_t damped = deck.find("damping = { internal_beta");
    if (damped != std::string::npos) deck.erase(damped, deck.find('\n', damped) + 1 - damped);
    const std::string steel = "material = \"steel\"\n";
    const double loss = 1e-3 * std::pow(50.0, std::uniform_real_distribution<double>(0, 1)(rng));
    deck.insert(deck.find(steel) + steel.size(),
                fmt::format("damping = {{ internal_loss_factor = {} }}\n", loss));
    const DeckModel d(deck);
    Linearizer linear(d.built.system, d.running());
    const double Omega = 0.5 * machine.top_speed() * rpm;
    SpectrumCertificate of_lateral, of_all;
    std::vector<WhirlMode> lateral, all;
    try {
      lateral = whirl_modes(linear, Omega, {.count = 6, .motion = Motion::lateral}, &of_lateral);
      all = whirl_modes(linear, Omega, {.count = 14}, &of_all);
    } catch (const Error& e) {
      ASSERT_EQ(e.diagnostics().front().code, "E75") << seed << ": " << e.what();
      continue;  // no equilibrium
    }
    EXPECT_TRUE(of_lateral.complete()) << seed << ": " << of_lateral.text();
    for (const WhirlMode& m : lateral) {
      if (m.damping_ratio > 0.5 || all.empty() || m.frequency > all.back().frequency) continue;
      double nearest = infinity;
      for (const WhirlMode& a : all)
        nearest = std::min(nearest, std::abs(a.lambda - m.lambda));
      EXPECT_LT(nearest, 0.02 * std::abs(m.lambda)) << seed << " at " << m.frequency;
      ++compared;
    }
  }
  EXPECT_GT(compared, 60);
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
