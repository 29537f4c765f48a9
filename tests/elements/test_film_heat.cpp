// Heat of films: closed forms, energy balance, grid, growth of the clearance.
#include <elements/films/film_heat.hpp>
#include <elements/films/tilting_pad.hpp>

#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::elements;

namespace {

constexpr double c = 1e-4, R = 0.05, L = 0.06, eta = 0.02, Omega = 400;

FiniteJournal split_bearing() {
  return {R, L, eta,
          std::make_shared<JournalSurface>(c, 0.0, two_groove_pads(0.0, 20 * pi / 180), 72)};
}

FilmPoint at(const Vec2& r, double spin = Omega) {
  LateralMotion m;
  m.r = r;
  m.v.setZero();
  m.spin = spin;
  return FilmLaw<FiniteJournal>::point(m);
}

HeatSettings settings() {
  HeatSettings s;
  s.supply_temperature = 313.15;
  s.viscosity = [](double T) { return eta * std::exp(-0.03 * (T - 313.15)); };
  s.coldest = 200;
  s.hottest = 600;
  return s;
}

HeatBalance balance(const FiniteJournal& film, const Vec2& r, const HeatSettings& s,
                    double spin = Omega) {
  const std::vector<HeatPad> pads{{&film, 0, at(r, spin)}, {&film, 1, at(r, spin)}};
  return balance_heat(pads, s);
}

}  // namespace

// A centred journal, no heat into the walls: Couette flow warms by 2 eta U x/(rho c h^2).
TEST(FilmHeat, AdiabaticCouetteFlow) {
  const FiniteJournal film = split_bearing();
  HeatSettings s = settings();
  s.conductivity = 1e-12;
  s.carry_over = 0.5;
  const HeatBalance b = balance(film, Vec2::Zero(), s);
  const double rise =
      2 * eta * R * Omega * R * (160 * pi / 180) / (s.density * s.specific_heat * c * c);
  for (const PadTemperatures& t : b.pads) {
    EXPECT_NEAR(t.out - t.in, rise, 1e-9 * rise);
    // T_in - T_s = s (T_out - T_s)
    EXPECT_NEAR(t.in - s.supply_temperature, 0.5 * (t.out - s.supply_temperature), 1e-9);
    EXPECT_NEAR(t.in - s.supply_temperature, rise, 1e-9 * rise);
  }
}

TEST(FilmHeat, WhatIsLostIsCarriedOrConductedAway) {
  FiniteJournal film = split_bearing();
  film.turbulent_density = 900;
  HeatSettings s = settings();
  s.wall = 0.015;
  s.housing_temperature = 303.15;
  for (const double spin : {Omega, -Omega}) {
    const Vec2 r(0.2 * c, -0.6 * c);
    const HeatBalance b = balance(film, r, s, spin);
    double journal = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const PadTemperatures& t = b.pads[k];
      EXPECT_NEAR(t.to_pad + t.to_journal + t.carried, t.heat, 1e-7 * t.heat);
      EXPECT_NEAR(t.heat, film_standing(film, k, at(r, spin), 900).power, 2e-3 * t.heat);
      EXPECT_GT(t.to_pad, 0.0);
      EXPECT_GT(t.through, 0.0);
      EXPECT_LT(t.pad, t.hottest);
      EXPECT_GE(t.film_hottest, t.hottest - 1e-9);
      journal += t.to_journal;
    }
    EXPECT_NEAR(journal, 0.0, 1e-8 * b.pads[0].heat);
  }
}

// The sense of rotation mirrors everything.
TEST(FilmHeat, MirroredTheOtherWayRound) {
  const FiniteJournal film = split_bearing();
  HeatSettings s = settings();
  s.wall = 0.015;
  const HeatBalance a = balance(film, Vec2(0.2 * c, -0.6 * c), s),
                    b = balance(film, Vec2(-0.2 * c, -0.6 * c), s, -Omega);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(a.pads[k].hottest, b.pads[k].hottest, 1e-6);
    EXPECT_NEAR(a.pads[k].out, b.pads[k].out, 1e-6);
    const std::size_t n = a.pads[k].film.size();
    EXPECT_NEAR(a.pads[k].film[5], b.pads[k].film[n - 6], 1e-6);
  }
}

// A pad between a hot film and cool oil is a wall: heat through it by its thickness and its back.
TEST(FilmHeat, GridOfTheBalance) {
  const FiniteJournal film = split_bearing();
  HeatSettings s = settings();
  s.wall = 0.015;
  HeatSettings fine = s;
  fine.cells = 2 * s.cells;
  fine.layers = 2 * s.layers;
  fine.wall_layers = 2 * s.wall_layers;
  const Vec2 r(0.2 * c, -0.6 * c);
  const HeatBalance a = balance(film, r, s), b = balance(film, r, fine);
  double rise = 0;
  for (std::size_t k = 0; k < 2; ++k)
    rise = std::max(rise, b.pads[k].hottest - s.supply_temperature);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(a.pads[k].hottest, b.pads[k].hottest, 0.02 * rise);
    EXPECT_NEAR(a.pads[k].out, b.pads[k].out, 0.01 * rise);
  }
}

TEST(FilmHeat, GrowthOfTheClearances) {
  const FiniteJournal film = split_bearing();
  HeatSettings s = settings();
  s.housing_temperature = 323.15;
  s.shaft_expansion = 1.1e-5;
  s.pad_expansion = 1.8e-5;
  s.assembly_temperature = 293.15;
  // at rest all is as warm as the oil, 20 K above assembly
  const HeatBalance fixed = balance(film, Vec2(0, -0.1 * c), s, 0.0);
  EXPECT_NEAR(fixed.growth[0], R * (1.8e-5 - 1.1e-5) * 20 / c, 1e-12);
  EXPECT_NEAR(fixed.pad_growth[0], fixed.growth[0], 1e-12);
  s.housing_expansion = 1.2e-5;
  constexpr double thick = 0.02;
  const std::vector<HeatPad> tilting{{&film, 0, at(Vec2(0, -0.1 * c), 0.0), thick}};
  const HeatBalance b = balance_heat(tilting, s);
  EXPECT_NEAR(b.growth[0], ((R + thick) * 1.2e-5 * 30 - thick * 1.8e-5 * 20 - R * 1.1e-5 * 20) / c,
              1e-12);
  EXPECT_NEAR(b.pad_growth[0], R * (1.8e-5 - 1.1e-5) * 20 / c, 1e-12);
  // what is kept: the growths, and the logarithms of viscosity at the knots
  FiniteJournal hot = film;
  hot.kept_from = 0;
  hot.knots = 5;
  std::vector<double> kept(7);
  s.viscosity = [](double) { return 0.5 * eta; };
  const std::vector<HeatPad> cold{{&film, 0, at(Vec2(0, -0.1 * c), 0.0), thick}};
  const HeatPad pad{&hot, 0, {}, thick};
  keep_heat(balance_heat(cold, s), 0, pad, kept);
  EXPECT_NEAR(kept[0], b.growth[0], 1e-12);
  EXPECT_NEAR(kept[1], b.pad_growth[0], 1e-12);
  for (std::size_t i = 2; i < 7; ++i)
    EXPECT_NEAR(kept[i], std::log(0.5), 1e-12);
}
