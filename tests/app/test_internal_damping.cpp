// Internal damping from the deck: growth on both sides of the onset, and the onset on unequal
// supports, in closed form.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

using namespace whirl;
using test::Columns;
using test::DeckRun;

namespace {

/// The rotor of the example (10 kg, 1e6 N/m, 50 N s/m standing still, 100 N s/m turning) with a
/// spring beside its shaft, and steps of its own.
std::string deck(const std::string& spring, const std::string& steps) {
  std::ifstream in(std::filesystem::path(WHIRL_SOURCE) / "examples/07_internal_damping/deck.toml");
  std::ostringstream text;
  text << in.rdbuf();
  std::string t = text.str();
  t.resize(t.find("[[step]]"));
  const std::string damper = "cyy  = ";
  return t.insert(t.find(damper), spring) + steps + "[output]\nreport = false\n";
}

constexpr double rpm = pi / 30;

}  // namespace

// omega_n (1 + ce/ci) = 474.341649 rad/s: a hundredth above it whirl grows by 0.0749572 1/s, a
// hundredth below it dies by 0.07495847 1/s (given to seven digits; the logarithmic decrement of
// 1e-3 carries ten).
TEST(InternalDampingDeck, GrowthOnBothSidesOfTheOnset) {
  for (const auto& [factor, growth] : {std::pair{1.01, 0.0749572}, {0.99, -0.07495847}}) {
    const DeckRun d(deck("", fmt::format("[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = "
                                         "\"{:.12g} rpm\"\nmodes = 2\nmotion = \"lateral\"\n",
                                         factor * 474.341649025 / rpm)));
    ASSERT_EQ(d.exit, 0) << d.log;
    const Columns modes = d.csv("m_modes.csv");
    double most = -infinity;
    for (const auto& row : modes.rows) {
      const auto mode = modes.named(row);
      most = std::max(most, -mode.at("frequency [Hz]") * mode.at("log decrement [-]"));
    }
    EXPECT_NEAR(most, growth, 1e-6 * std::abs(growth)) << factor;
  }
}

// ky = 1.2e6 N/m: sqrt(d^2 + c^2 k/m)/ci = 1116.915395 rad/s, whirling at sqrt(k/m) = 331.662479
// rad/s.
TEST(InternalDampingDeck, OnsetOnUnequalSupports) {
  const DeckRun d(deck("kyy = \"2e5 N/m\"\n",
                       "[[step]]\nname = \"s\"\ntype = \"stability\"\nspeed = { start = \"100 "
                       "rpm\", stop = \"14000 rpm\", points = 20 }\nmodes = 4\n"));
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns onset = d.csv("s_onset.csv");
  ASSERT_EQ(onset.rows.size(), 1u);
  const auto row = onset.named(onset.rows[0]);
  EXPECT_NEAR(row.at("speed [rpm]") * rpm, 1116.915395, 1e-9 * 1116.9);
  EXPECT_NEAR(row.at("whirl frequency [Hz]") * two_pi, 331.662479, 2e-9 * 331.7);
}
