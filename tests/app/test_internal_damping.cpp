// Internal damping from the deck: growth on both sides of the onset, and the onset on unequal
// supports, in closed form.
#include "deck_run.hpp"

#include <core/types.hpp>

#include <fmt/format.h>

#include <array>
#include <vector>

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

// Forward and backward whirl of nearly one frequency, an axial mode whose vector rounding keeps from
// its thirteenth digit, and modes that hardly oscillate: each is found at its own rate. Undamped
// outside, the rotor gains from its loss factor exactly where the speed passes the frequency.
TEST(InternalDampingDeck, LossFactorOfARotorOnPlainSupports) {
  const DeckRun d(R"(format = 1
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 500, 50], ["b", 500, 50]]
[shaft.damping]
internal_loss_factor = 0.02
[[disk]]
name = "d"
at = "a:end"
mass = "30 kg"
Ip = "0.4 kg.m^2"
Id = "0.22 kg.m^2"
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
[[bearing]]
name = "R"
at = "b:end"
type = "linear"
kyy = "5e7 N/m"
kzz = "5e7 N/m"
[[step]]
type = "modal"
name = "m"
speed = "6000 rpm"
modes = 12
[[step]]
type = "stability"
name = "s"
speed = { start = "500 rpm", stop = "9000 rpm", points = 6 }
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("complete")) << d.log;
  EXPECT_EQ(d.csv("m_modes.csv").rows.size(), 12u);
  const Columns onset = d.csv("s_onset.csv");
  ASSERT_EQ(onset.rows.size(), 1u);
  EXPECT_NEAR(onset.named(onset.rows[0]).at("frequency / speed [-]"), 1.0, 1e-9);
}

// Heavily damped supports on pedestals: pairs of roots that hardly oscillate or not at all.
TEST(InternalDampingDeck, LossFactorBesideOverdampedSupports) {
  const DeckRun d(R"(format = 1
[shaft]
name = "rotor"
material = "steel"
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 345, 50.4], ["b", 175, 89.3], ["c", 235, 69.1], ["d", 342, 56.7], ["e", 475, 91.5]]
[shaft.damping]
internal_loss_factor = 0.0473
[[disk]]
name = "d"
at = "b:start"
mass = "25.52 kg"
Ip = "0.3391 kg.m^2"
Id = "0.3426 kg.m^2"
[[bearing]]
name = "L"
at = "a:start"
type = "linear"
kxx = "1e7 N/m"
kyy = "5.177e6 N/m"
kzz = "5.177e6 N/m"
cyy = "4.958e4 N.s/m"
czz = "4.958e4 N.s/m"
[[bearing]]
name = "R"
at = "e:end"
type = "linear"
kyy = "2.102e8 N/m"
kzz = "2.102e8 N/m"
support = { mass = "1.045 kg", kyy = "1.054e8 N/m", kzz = "1.504e8 N/m" }
[[step]]
type = "modal"
name = "m"
speed = "8724.2 rpm"
modes = 5
[[step]]
type = "stability"
name = "s"
speed = { start = "200 rpm", stop = "8724.2 rpm", points = 4 }
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_TRUE(d.says("complete")) << d.log;
  EXPECT_TRUE(d.says("no growth found from 200")) << d.log;
}

// A free spin is free however fast a mode decays: what decays of hysteretic damping is no stiffness of
// twist and axial motion, which follow lateral motion without damping. Lists were not certified, and
// some were wrong by 2 Hz.
TEST(InternalDampingDeck, LateralModesOfASaggedRotorWithALossFactorAreThoseOfAll) {
  const DeckRun d(R"(format = 1
[output]
report = false
[[shaft]]
name = "r"
material = "steel"
damping = { internal_loss_factor = 0.01 }
columns = ["name", "length[mm]", "od[mm]"]
rows = [["a", 400, 60], ["b", 900, 90], ["c", 500, 60]]
[[disk]]
at = "a:end"
mass = "300 kg"
Ip = "9 kg.m^2"
Id = "5 kg.m^2"
[[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "1.5e7 N/m"
cyy = "4e4 N.s/m"
czz = "3e4 N.s/m"
[[bearing]]
at = "c:end"
type = "linear"
kyy = "8e6 N/m"
kzz = "9e6 N/m"
cyy = "3e4 N.s/m"
czz = "5e4 N.s/m"
[[step]]
name = "lateral"
type = "modal"
speed = "4000 rpm"
modes = 8
motion = "lateral"
[[step]]
name = "all"
type = "modal"
speed = "4000 rpm"
modes = 10
)");
  ASSERT_EQ(d.exit, 0) << d.log;
  EXPECT_FALSE(d.says("not certified")) << d.log;
  std::vector<std::array<double, 2>> lists[2];
  for (const bool all : {false, true}) {
    const io::Value step = d.summary(all ? "all" : "lateral");
    for (const io::Value& m : step.at("modes").items())
      if (m.at("kind").text() == "lateral")
        lists[all].push_back({m.at("frequency [Hz]").number(), m.at("damping ratio").number()});
  }
  ASSERT_EQ(lists[0].size(), 8u);
  ASSERT_GE(lists[1].size(), 8u);
  // the square of the sag over the length, 1e-7, of the inertia that lateral motion leaves out
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_NEAR(lists[0][k][0], lists[1][k][0], 1e-6 * lists[1][k][0]) << k;
    EXPECT_NEAR(lists[0][k][1], lists[1][k][1], 3e-4 * lists[1][k][1]) << k;
  }
}

// A round shaft written as a general section: its stretch was damped by external_beta alone, and not at all
// by a loss factor.
TEST(InternalDampingDeck, DampsTheStretchOfGeneralSections) {
  const double d = 0.05, A = pi * d * d / 4, I = A * d * d / 16;
  const std::string general = fmt::format(
      "general = {{ A = \"{:.17g} m^2\", Iy = \"{:.17g} m^4\", Iz = \"{:.17g} m^4\", J = "
      "\"{:.17g} m^4\", kappa_y = 0.886, kappa_z = 0.886 }}\n",
      A, I, I, 2 * I);
  for (const char* damping :
       {"internal_beta = \"2e-6 s\", external_beta = \"1e-6 s\"", "internal_loss_factor = 0.01"}) {
    std::array<std::vector<double>, 2> decrements;
    for (const bool as_general : {false, true}) {
      const DeckRun run(fmt::format("format = 1\n[[shaft]]\nname = \"s\"\nmaterial = "
                                    "\"steel\"\ndamping = {{ {} }}\n[[shaft.section]]\nname = "
                                    "\"a\"\nlength = \"1 m\"\n{}",
                                    damping, as_general ? general : "od = \"50 mm\"\n") +
                        R"([[bearing]]
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "2e7 N/m"
kzz = "1.5e7 N/m"
[[bearing]]
at = "a:end"
type = "linear"
kyy = "2e7 N/m"
kzz = "1.5e7 N/m"
[[step]]
name = "m"
type = "modal"
speed = "4000 rpm"
modes = 3
motion = "axial"
)");
      ASSERT_EQ(run.exit, 0) << run.log;
      const io::Value summary = run.summary("m");
      for (const io::Value& m : summary.at("modes").items())
        decrements[as_general].push_back(m.at("log decrement").number());
    }
    ASSERT_EQ(decrements[0].size(), 3u);
    ASSERT_EQ(decrements[1].size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_GT(decrements[0][k], 1e-4);
      EXPECT_NEAR(decrements[1][k], decrements[0][k], 1e-6 * decrements[0][k]) << damping << k;
    }
  }
}

// Hysteretic damping turns its sense where whirl turns as the rotor does: what dies there by more than the air
// takes grows just above it. And massless nodes, whose viscous damping turns with the rotor, hide no mode:
// with k = 48 E I/L^3 whirl grows from c w = eta k + beta k (Omega - w) on.
TEST(InternalDampingDeck, LossFactorsBesideOtherDamping) {
  const DeckRun outside(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "s"
material = "steel"
damping = { internal_loss_factor = 0.01 }
columns = ["name", "length[mm]", "od[mm]", "min_elements"]
rows = [["a", 300, 40, 2], ["b", 300, 40, 2]]
[[disk]]
name = "d"
at = "a:end"
mass = "15 kg"
Ip = "0.2 kg.m^2"
Id = "0.11 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "linear"
kxx = "1e8 N/m"
kyy = "3e7 N/m"
kzz = "3e7 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
[[bearing]]
name = "B"
at = "b:end"
type = "linear"
kyy = "3e7 N/m"
kzz = "3e7 N/m"
cyy = "300 N.s/m"
czz = "300 N.s/m"
[[step]]
name = "st"
type = "stability"
speed = { start = "500 rpm", stop = "9000 rpm", points = 6 }
modes = 8
[output]
report = false
)");
  ASSERT_EQ(outside.exit, 0) << outside.log;
  EXPECT_FALSE(outside.says("not known")) << outside.log;
  const Columns first = outside.csv("st_onset.csv");
  ASSERT_EQ(first.rows.size(), 1u) << outside.log;
  const auto at = first.named(first.rows[0]);
  EXPECT_NEAR(at.at("frequency / speed [-]"), 1.0, 1e-9);
  constexpr double EI = 8349.76422461912, k = 48.0 * EI, c = 50.0, eta = 0.02, beta = 1e-5,
                   m = 10.0;
  const DeckRun massless(fmt::format(R"(format = 1
[model]
gravity = "0 m/s^2"
[[shaft]]
name = "s"
damping = {{ internal_loss_factor = {}, internal_beta = "{} s" }}
[[shaft.section]]
name = "a"
length = "500 mm"
min_elements = 2
constants = {{ EA = "1e8 N", kGA = "1e12 N", GJ = "1e4 N.m^2", EI = "{} N.m^2", rhoA = "0 kg/m", rhoI = "0 kg.m", rhoIp = "0 kg.m" }}
[[shaft.section]]
name = "b"
length = "500 mm"
min_elements = 2
constants = {{ EA = "1e8 N", kGA = "1e12 N", GJ = "1e4 N.m^2", EI = "{} N.m^2", rhoA = "0 kg/m", rhoI = "0 kg.m", rhoIp = "0 kg.m" }}
[[disk]]
name = "D"
at = "a:end"
mass = "{} kg"
Ip = "0.2 kg.m^2"
Id = "0.1 kg.m^2"
[[bearing]]
name = "A"
at = "a:start"
type = "rigid"
directions = ["x", "y", "z"]
[[bearing]]
name = "B"
at = "b:end"
type = "rigid"
directions = ["y", "z"]
[[bearing]]
name = "air"
at = "D"
type = "linear"
cyy = "{} N.s/m"
czz = "{} N.s/m"
[[step]]
name = "st"
type = "stability"
speed = {{ start = "500 rpm", stop = "9000 rpm", points = 10 }}
[output]
report = false
)",
                                     eta, beta, EI, EI, m, c, c));
  ASSERT_EQ(massless.exit, 0) << massless.log;
  const Columns second = massless.csv("st_onset.csv");
  ASSERT_EQ(second.rows.size(), 1u) << massless.log;
  const double w = std::sqrt(k / m), onset = w + (c * w - eta * k) / (beta * k);
  EXPECT_NEAR(second.named(second.rows[0]).at("speed [rpm]") * rpm, onset, 1e-5 * onset);
}
