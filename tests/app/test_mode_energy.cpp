// Where the energy of a mode is: of springs between two bodies as of those to the ground.
#include "deck_run.hpp"

#include <fmt/format.h>

#include <string>

namespace {

using whirl::test::Columns;
using whirl::test::DeckRun;

/// 10 kg on a bearing of 2 MN/m on a pedestal of 1 MN/m and next to no mass.
std::string on_a_pedestal(const char* name) {
  return fmt::format(R"([[shaft]]
name = "{0}"
[[shaft.section]]
name = "a"
length = "1 m"
rigid = true
[[disk]]
name = "d{0}"
at = "{0}/a:mid"
mass = "10 kg"
Ip = "0.1 kg.m^2"
Id = "5 kg.m^2"
[[bearing]]
name = "B{0}"
at = "{0}/a:mid"
type = "linear"
kxx = "1e9 N/m"
kyy = "2e6 N/m"
kzz = "2e6 N/m"
krr = "1e8 N.m/rad"
[bearing.support]
mass = "0.01 kg"
kxx = "1e9 N/m"
kyy = "1e6 N/m"
kzz = "1e6 N/m"
)",
                     name);
}

constexpr const char* head =
    "format = 1\n[output]\nreport = false\n[model]\ngravity = \"0 m/s^2\"\n";
constexpr const char* modal =
    "[[step]]\nname = \"m\"\ntype = \"modal\"\nspeed = \"0 rpm\"\nmodes = 2\nmotion = "
    "\"lateral\"\n";

}  // namespace

// In series the softer one has the energy: 1/k of each over their sum.
TEST(ModeEnergy, OfABearingAndItsPedestalIsThatOfSpringsInSeries) {
  const DeckRun d(std::string(head) + on_a_pedestal("r") + modal);
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("m_energy_parts.csv");
  for (const auto& row : t.rows) {
    const auto shares = t.named(row);
    EXPECT_NEAR(shares.at("strain: Br [%]"), 100.0 / 3, 0.1);
    EXPECT_NEAR(shares.at("strain: Br pedestal [%]"), 200.0 / 3, 0.1);
  }
}

// A bearing between two rotors takes part by what moves within it: nothing where both move alike, all
// but what the pedestals have where they move against each other.
TEST(ModeEnergy, OfABearingBetweenTwoRotorsIsThatOfTheirDistance) {
  const std::string between =
      "[[bearing]]\nname = \"I\"\nat = \"r/a:mid\"\nto = \"q/a:mid\"\ntype = \"linear\"\n"
      "kyy = \"1e6 N/m\"\nkzz = \"1e6 N/m\"\n";
  std::string deck = std::string(head) + on_a_pedestal("r") + on_a_pedestal("q") + between + modal;
  deck.replace(deck.find("modes = 2"), 9, "modes = 4");
  const DeckRun d(deck);
  ASSERT_EQ(d.exit, 0) << d.log;
  const Columns t = d.csv("m_energy_parts.csv");
  ASSERT_EQ(t.rows.size(), 4u);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto shares = t.named(t.rows[k]);
    const bool against = k >= 2;
    // per unit of each rotor: both supports 2/3 MN/m, the bearing between 1 MN/m over twice the way
    const double between_share = against ? 4.0 / (4.0 + 2 * 2.0 / 3) : 0.0;
    const double of_pedestals = (1 - between_share) * 2 / 3;
    EXPECT_NEAR(shares.at("strain: I [%]"), 100 * between_share, 0.1) << k;
    EXPECT_NEAR(shares.at("strain: Br pedestal [%]"), 50 * of_pedestals, 0.1) << k;
    EXPECT_NEAR(shares.at("strain: Bq [%]"), 25 * of_pedestals, 0.1) << k;
  }
}
