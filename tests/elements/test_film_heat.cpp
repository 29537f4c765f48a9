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
    EXPECT_EQ(t.hot_share, 0.5);  // as much arrives as enters
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
  const HeatSettings fine = finer_settings(finer_settings(s));
  const Vec2 r(0.2 * c, -0.6 * c);
  const HeatBalance a = balance(film, r, s), b = balance(film, r, fine);
  double rise = 0;
  for (std::size_t k = 0; k < 2; ++k)
    rise = std::max(rise, b.pads[k].hottest - s.supply_temperature);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(a.pads[k].hottest, b.pads[k].hottest, 3e-3 * rise);
    EXPECT_NEAR(a.pads[k].out, b.pads[k].out, 2e-3 * rise);
  }
}

// Of one grid the error falls with the cells, of two with their square, or nearly so; what a finer one
// tells is no less than half of it.
TEST(FilmHeat, TwoGridsAreBetterThanOne) {
  const FiniteJournal film = split_bearing();
  HeatSettings s = settings();
  s.wall = 0.015;
  const Vec2 r(0.2 * c, -0.6 * c);
  const HeatBalance best = balance(film, r, finer_settings(finer_settings(s)));
  const auto distance = [&](const HeatSettings& x, const HeatBalance& from) {
    const HeatBalance b = balance(film, r, x);
    double worst = 0;
    for (std::size_t k = 0; k < 2; ++k)
      worst = std::max(worst, std::abs(b.pads[k].hottest - from.pads[k].hottest));
    return worst;
  };
  HeatSettings one = s;
  one.grids = 1;
  EXPECT_LT(distance(s, best), 0.5 * distance(one, best));
  EXPECT_LT(distance(s, best), 2.0 * distance(s, balance(film, r, finer_settings(s))));
}

namespace {

/// The film on a grid along the axis too; recesses: of the first pad and the second.
FiniteJournal on_grid(const std::vector<std::vector<Recess>>& recesses) {
  FiniteJournal film = split_bearing();
  std::vector<GridPad> grid;
  for (std::size_t k = 0; k < 2; ++k) {
    const JournalSurface::Arc& arc = film.surface->arcs()[k];
    grid.emplace_back(arc.start, arc.length, arc.round, R / L, 120, 6, recesses.at(k));
  }
  film.grid = std::make_shared<const std::vector<GridPad>>(std::move(grid));
  film.leakage = film.source = 12.0;
  return film;
}

}  // namespace

// The profile along the axis is off by some parts in a thousand of the force, and the heat with it.
TEST(FilmHeat, AGridAlongTheAxisIsAsWarm) {
  const Vec2 r(0.2 * c, -0.6 * c);
  HeatSettings s = settings();
  s.wall = 0.015;
  const HeatBalance profile = balance(split_bearing(), r, s),
                    grid = balance(on_grid({{}, {}}), r, s);
  for (std::size_t k = 0; k < 2; ++k) {
    const double rise = profile.pads[k].hottest - s.supply_temperature;
    EXPECT_NEAR(grid.pads[k].hottest, profile.pads[k].hottest, 0.01 * rise);
    EXPECT_NEAR(grid.pads[k].out, profile.pads[k].out, 0.01 * rise);
    EXPECT_NEAR(grid.pads[k].to_pad, profile.pads[k].to_pad,
                0.02 * std::abs(profile.pads[k].to_pad));
  }
}

// Pockets, tracks and tapers: the film turns into heat what its nodes lose, and all of it goes somewhere.
TEST(FilmHeat, TheHeatOfRecesses) {
  const double arc = 160 * pi / 180;
  const std::vector<Recess> pocket{{0.0, 2.0, 2 * c, 2 * c, 0.7}},
      track{{0.0, arc, 0, 0, 0.3, true}}, taper{{0.0, 1.5, c, 0.0, 1.0}};
  HeatSettings s = settings();
  s.wall = 0.015;
  for (const auto& recesses : {std::vector<std::vector<Recess>>{pocket, track}, {taper, taper}})
    for (const double density : {0.0, 900.0})
      for (const double spin : {Omega, -Omega}) {
        FiniteJournal film = on_grid(recesses);
        film.turbulent_density = density;
        const Vec2 r(0.2 * c, -0.5 * c);
        const HeatBalance b = balance(film, r, s, spin);
        for (std::size_t k = 0; k < 2; ++k) {
          const PadTemperatures& t = b.pads[k];
          EXPECT_NEAR(t.to_pad + t.to_journal + t.carried, t.heat, 1e-7 * t.heat);
          EXPECT_NEAR(t.heat, film_standing(film, k, at(r, spin), 900).power, 1e-6 * t.heat);
          EXPECT_GT(t.film_coldest, s.supply_temperature - 1.0);
        }
      }
}

// Where film has ruptured the filled gap is dragged along whole: beside a track, too.
TEST(FilmHeat, RupturedGapsCarryHalfTheSpeed) {
  const std::vector<Recess> track{{0.0, 160 * pi / 180, 0, 0, 0.3, true}};
  for (const auto& recesses : {std::vector<std::vector<Recess>>{{}, {}}, {track, track}}) {
    const FiniteJournal film = on_grid(recesses);
    const FilmField f = sample_film(film, 1, at(Vec2(0.3 * c, -0.7 * c)), 49);
    int ruptured = 0;
    for (std::size_t i = 1; i + 1 < f.theta.size(); ++i) {
      if (f.wet[i - 1] || f.wet[i] || f.wet[i + 1]) continue;
      ++ruptured;
      const double dragged = 0.5 * R * Omega * L * f.gap[i];
      EXPECT_NEAR(f.filled[i], dragged, 2e-3 * dragged) << i;
    }
    EXPECT_GT(ruptured, 5);
  }
}

// All that ruptured film turns into heat goes somewhere, however little of the width oil wets.
TEST(FilmHeat, RupturedFilmThatConservesMass) {
  HeatSettings s = settings();
  s.wall = 0.015;
  const double arc = 160 * pi / 180;
  const std::vector<Recess> pocket{{0.0, 2.0, 2 * c, 2 * c, 0.7}},
      track{{0.0, arc, 0, 0, 0.3, true}};
  const std::vector<FiniteJournal> films{split_bearing(), on_grid({{}, {}}),
                                         on_grid({pocket, track})};
  for (std::size_t kind = 0; kind < films.size(); ++kind)
    for (const double spin : {Omega, -Omega})
      for (const double supply : {0.0, 5e4}) {
        SCOPED_TRACE(testing::Message() << kind << ", " << spin << " rad/s, " << supply << " Pa");
        FiniteJournal film = films[kind];
        film.mass_conserving = true;
        film.supply_pressure = supply;
        const Vec2 r(0.3 * c, -0.5 * c);
        const HeatBalance b = balance(film, r, s, spin);
        double journal = 0, heat = 0, power = 0;
        for (std::size_t k = 0; k < 2; ++k) {
          const PadTemperatures& t = b.pads[k];
          EXPECT_NEAR(t.to_pad + t.to_journal + t.carried, t.heat, 1e-7 * t.heat);
          EXPECT_GT(t.film_coldest, s.supply_temperature - 1.0);
          heat += t.heat;
          power += film_loss(film, k, at(r, spin));
          journal += t.to_journal;
        }
        EXPECT_NEAR(heat, power, 1e-6 * power);
        EXPECT_NEAR(journal, 0.0, 1e-7 * b.pads[0].heat);
      }
}

// A gap that opens from its groove is ruptured all along: streams of oil as thick as the gap is, dragged
// at half the speed, each warmed by what it turns into heat itself: dT/dx = 2 eta U/(rho c h^2).
TEST(FilmHeat, StreamsThatNothingCools) {
  HeatSettings s = settings();
  s.conductivity = 1e-12;
  const double e = 0.6;
  const Vec2 r = e * c * Vec2(std::cos(5 * pi / 180), std::sin(5 * pi / 180));
  for (FiniteJournal film : {split_bearing(), on_grid({{}, {}})}) {
    film.mass_conserving = true;
    const PadTemperatures t = balance(film, r, s).pads[0];
    double rise = 0;
    constexpr int n = 1000;
    for (int k = 0; k < n; ++k) {
      const double theta = (10 + 160 * (k + 0.5) / n) * pi / 180,
                   h = c * (1 - e * std::cos(theta - 5 * pi / 180));
      rise += 2 * eta * R * Omega / (s.density * s.specific_heat * h * h) * R * 160 * pi / 180 / n;
    }
    EXPECT_NEAR(t.out - t.in, rise, 5e-3 * rise) << (film.grid != nullptr);
    EXPECT_NEAR(t.carried, t.heat, 1e-7 * t.heat);
  }
}

// Full film is as warm whether it conserves mass where it would rupture or not.
TEST(FilmHeat, FullFilmThatConservesMass) {
  HeatSettings s = settings();
  s.wall = 0.015;
  const Vec2 r(0.2 * c, -0.3 * c);
  FiniteJournal film = split_bearing();
  film.supply_pressure = 5e6;
  const HeatBalance full = balance(film, r, s);
  film.mass_conserving = true;
  const HeatBalance b = balance(film, r, s);
  for (std::size_t k = 0; k < 2; ++k) {
    const double rise = full.pads[k].hottest - s.supply_temperature;
    EXPECT_NEAR(b.pads[k].hottest, full.pads[k].hottest, 5e-3 * rise);
    EXPECT_NEAR(b.pads[k].out, full.pads[k].out, 5e-3 * rise);
    EXPECT_NEAR(b.pads[k].heat, full.pads[k].heat, 5e-3 * full.pads[k].heat);
  }
}

// With a profile and on a grid: where it forms of what is carried to it, and where it has ruptured.
TEST(FilmHeat, AGridThatConservesMassIsAsWarm) {
  HeatSettings s = settings();
  s.wall = 0.015;
  const Vec2 r(0.5 * c, -0.5 * c);
  const auto conserving = [&](FiniteJournal film) {
    film.mass_conserving = true;
    return balance(film, r, s);
  };
  const HeatBalance profile = conserving(split_bearing()), grid = conserving(on_grid({{}, {}}));
  for (std::size_t k = 0; k < 2; ++k) {
    const double rise = profile.pads[k].hottest - s.supply_temperature;
    EXPECT_NEAR(grid.pads[k].hottest, profile.pads[k].hottest, 0.015 * rise);
    EXPECT_NEAR(grid.pads[k].out, profile.pads[k].out, 0.015 * rise);
    EXPECT_NEAR(grid.pads[k].heat, profile.pads[k].heat, 0.01 * profile.pads[k].heat);
  }
}

namespace {

/// Of a bearing with two pads, pad 0 before pad 1 and that before pad 0 again: a groove passes on no more
/// oil and heat than it gets, by the flows of the films, and all loss leaves with oil or through pads.
void expect_closed(const FiniteJournal& film, const Vec2& r, const HeatSettings& s, double spin) {
  const HeatBalance b = balance(film, r, s, spin);
  double heat = 0, away = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const PadTemperatures &t = b.pads[k], &before = b.pads[1 - k];
    const double in = film_standing(film, k, at(r, spin), 900).inflow,
                 given = film_standing(film, 1 - k, at(r, spin), 900).outflow;
    const double warm = before.out - s.supply_temperature;
    const double passed = std::min(s.carry_over, given / in);
    EXPECT_NEAR(t.in - s.supply_temperature, t.hot_share * warm, 5e-3 * warm);
    EXPECT_GE(t.hot_share, passed - 1e-2);
    // a groove under pressure drives some back: then more leaves for it than all in all
    if (film.supply_pressure == 0.0) {
      EXPECT_LE(t.hot_share, passed + 1e-2);
      EXPECT_LE(in * (t.in - s.supply_temperature), 1.01 * given * warm);
    }
    EXPECT_GT(t.to_oil, 0.0);
    heat += t.heat;
    away += t.to_oil + t.to_pad;
  }
  EXPECT_NEAR(away, heat, 1e-6 * heat);
}

void expect_bath(const FiniteJournal& film, const Vec2& r, const HeatSettings& s, double spin) {
  const HeatBalance b = balance(film, r, s, spin);
  const double unit = s.density * s.specific_heat;
  const bool given = !std::isnan(s.supply_flow);
  double heat = 0, away = 0, returned = 0, taken = 0, to_pad = 0, back = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const PadTemperatures &t = b.pads[k], &before = b.pads[1 - k];
    const double in = film_standing(film, k, at(r, spin), 900).inflow,
                 out = film_standing(film, 1 - k, at(r, spin), 900).outflow,
                 hot = std::min(given ? s.carry_over * out : s.carry_over * in, given ? in : out);
    const double warm = before.out - s.supply_temperature, enters = t.in - s.supply_temperature;
    const double mixed = hot * warm + (in - hot) * (b.bath - s.supply_temperature);
    EXPECT_NEAR(in * enters, given ? mixed : in * s.carry_over * warm,
                (given ? 1e-2 : 1e-9) * in * warm);
    back += unit * (in * enters - hot * warm);
    heat += t.heat;
    away += t.to_oil + t.to_pad;
    returned += t.returned;
    to_pad += t.to_pad;
    taken += t.beyond;
  }
  const double own = std::isnan(s.housing_temperature) ? heat : heat - to_pad,
               bath = b.bath - s.supply_temperature;
  EXPECT_NEAR(away, heat + returned, 1e-6 * heat);
  EXPECT_NEAR(returned, back, 0.01 * (heat + returned));
  EXPECT_NEAR(returned, taken * bath, 1e-2 * heat);
  if (returned > 0.01 * heat) {
    EXPECT_NEAR(unit * b.supply_flow * bath, own, 1e-6 * heat);
    // what leaves the films and pads mixes with the supply, and is taken in again or let off
    const double backs = std::isnan(s.housing_temperature) ? to_pad : 0.0;
    EXPECT_NEAR(taken * (b.mixed - s.supply_temperature) + backs,
                (taken + unit * b.supply_flow) * bath, 2e-2 * heat);
  }
}

}  // namespace

TEST(FilmHeat, GroovesMakeNoHeat) {
  const Vec2 r(0.3 * c, -0.6 * c);
  for (const FiniteJournal& kind : {split_bearing(), on_grid({{}, {}})})
    for (const bool conserving : {false, true})
      for (const double supply : {0.0, 5e4})
        for (const double spin : {60.0, 400.0, -600.0})
          for (const double share : {0.2, 0.75, 0.95}) {
            SCOPED_TRACE(testing::Message() << (kind.grid != nullptr) << conserving << ", "
                                            << supply << " Pa, " << spin << " rad/s, " << share);
            FiniteJournal film = kind;
            film.mass_conserving = conserving;
            film.supply_pressure = supply;
            HeatSettings s = settings();
            s.wall = 0.015;
            s.carry_over = share;
            expect_closed(film, r, s, spin);
          }
}

// Grooves under so much pressure drive oil back into the ends of the pads: it is their oil, as cool as it is fed,
// and all heat leaves.
TEST(FilmHeat, WhatAGrooveDrivesBackIsItsOil) {
  const Vec2 r(0.3 * c, -0.6 * c);
  HeatSettings s = settings();
  s.wall = 0.015;
  for (const FiniteJournal& kind : {split_bearing(), on_grid({{}, {}})})
    for (const double spin : {60.0, -60.0}) {
      SCOPED_TRACE(testing::Message() << (kind.grid != nullptr) << ", " << spin << " rad/s");
      FiniteJournal film = kind;
      film.supply_pressure = 1e6;
      const HeatBalance b = balance(film, r, s, spin);
      double heat = 0, away = 0, coolest = infinity;
      for (std::size_t k = 0; k < 2; ++k) {
        const PadTemperatures& t = b.pads[k];
        heat += t.heat;
        away += t.to_oil + t.to_pad;
        if (film_standing(film, k, at(r, spin), 900).outflow > 0.0) continue;
        const double last = spin > 0.0 ? t.film.back() : t.film.front();
        coolest = std::min(coolest,
                           (last - s.supply_temperature) / (t.film_hottest - s.supply_temperature));
      }
      EXPECT_NEAR(away, heat, 1e-6 * heat);
      EXPECT_LT(coolest, 0.4);  // one pad at least is fed at its end, too
    }
}

// Flooded: temperatures as the share says, and what comes back by the flows of the films; with a supply flow, by
// the energy of all that is within the housing.
TEST(FilmHeat, HeatOfTheBath) {
  const Vec2 r(0.3 * c, -0.6 * c);
  for (const FiniteJournal& kind : {split_bearing(), on_grid({{}, {}})})
    for (const double spin : {60.0, 400.0, -600.0})
      for (const double flow : {whirl::nan, 2e-5, 1e-4})
        for (const bool housing : {false, true}) {
          SCOPED_TRACE(testing::Message() << (kind.grid != nullptr) << ", " << spin << " rad/s, "
                                          << flow << " m3/s " << housing);
          HeatSettings s = settings();
          s.wall = 0.015;
          s.flooded = true;
          s.supply_flow = flow;
          s.carry_over = std::isnan(flow) ? 0.75 : 1.0;
          if (housing) s.housing_temperature = 303.15;
          expect_bath(kind, r, s, spin);
        }
}

namespace {

/// What leaves the pads, as the journal goes half a turn round (the other half is that of the other pad).
void expect_steady(const FiniteJournal& film, double eccentricity, int steps) {
  const HeatSettings s = settings();
  std::array<std::vector<double>, 2> rise;
  double mean = 0;
  for (int k = 0; k <= steps; ++k) {
    const double turn = k * pi / steps;
    const Vec2 r = eccentricity * c * Vec2(std::cos(turn), std::sin(turn));
    const HeatBalance b = balance(film, r, s, 400);
    for (std::size_t i = 0; i < 2; ++i) {
      rise[i].push_back(b.pads[i].out - s.supply_temperature);
      mean += 0.5 * rise[i].back() / (steps + 1);
    }
  }
  // 60 % in a degree; where a film vanished with all that it takes in that was so at once
  const double most = 0.6 * mean * 180 / steps;
  for (const std::vector<double>& of : rise)
    for (std::size_t k = 1; k < of.size(); ++k)
      ASSERT_NEAR(of[k], of[k - 1], most) << 180.0 * static_cast<double>(k) / steps << " deg";
}

}  // namespace

// As the journal goes round films get shorter and vanish, in the middle and at the ends of a pad: temperatures do
// not jump.
TEST(FilmHeat, VanishingFilmsLeaveNoJump) {
  for (const double e : {0.157, 0.4, 0.6, 0.8}) {
    SCOPED_TRACE(e);
    expect_steady(split_bearing(), e, 1800);
    SCOPED_TRACE("on a grid");
    expect_steady(on_grid({{}, {}}), e, 360);
  }
}

// Where films begin and end goes from node to node of a grid: places get warmer or cooler, none at once.
TEST(FilmHeat, FrontsThatPassNodesLeaveNoJump) {
  const Recess dam{0.0, 100 * pi / 180, 3 * c, 3 * c, 0.6, false};
  const HeatSettings s = settings();
  for (const std::vector<std::vector<Recess>>& recesses :
       {std::vector<std::vector<Recess>>{{}, {}}, std::vector<std::vector<Recess>>{{dam}, {}}}) {
    const FiniteJournal film = on_grid(recesses);
    std::array<std::vector<double>, 2> last;
    for (int k = 0; k <= 100; ++k) {
      const double turn = (150.0 + 0.1 * k) * pi / 180;
      const Vec2 r = 0.3 * c * Vec2(std::cos(turn), std::sin(turn));
      const HeatBalance b = balance(film, r, s, 500);
      for (std::size_t i = 0; i < 2; ++i) {
        const std::vector<double>& now = b.pads[i].viscosity;
        // at once it was 21 to 24 %
        for (std::size_t n = 0; k > 0 && n < now.size(); ++n)
          ASSERT_LT(std::abs(std::log(now[n] / last[i][n])), 0.03) << k << ", cell " << n;
        last[i] = now;
      }
    }
  }
}

// Films of Reynolds form again behind a ruptured stretch: what they lack is fresh oil.
TEST(FilmHeat, FilmsThatFormAgainTakeInFreshOil) {
  const std::vector<JournalPad> whole{{0.0, 350 * pi / 180, pi}};
  const FiniteJournal film{R, L, eta, std::make_shared<JournalSurface>(c, 0.0, whole, 72)};
  HeatSettings s = settings();
  s.conductivity = 1e-12;
  s.cells = 192;
  const Vec2 r = 0.6 * c * Vec2(std::cos(0.5 * pi), std::sin(0.5 * pi));
  const std::vector<HeatPad> pads{{&film, 0, at(r)}};
  const PadTemperatures t = balance_heat(pads, s).pads[0];
  const FilmField f = sample_film(film, 0, at(r), 193);
  std::size_t forms = 0;
  for (std::size_t i = 1; i < 193; ++i)
    if (f.wet[i] && !f.wet[i - 1]) forms = i;
  ASSERT_GT(forms, 96u);
  const double left = f.flow[forms - 2] / f.flow[forms + 1];
  ASSERT_LT(left, 0.6);
  const double before = t.film[forms - 3] - s.supply_temperature,
               behind = t.film[forms + 3] - s.supply_temperature;
  EXPECT_NEAR(behind, left * before, 0.1 * before);
  EXPECT_NEAR(t.to_oil, t.heat, 1e-6 * t.heat);
  EXPECT_NEAR(t.hot_share, std::min(0.75, f.flow.back() / f.flow.front()), 1e-3);
}

// What the difference of two equilibria says of a hot film is what its linear law says.
TEST(FilmHeat, CoefficientsAreDifferencesOfEquilibria) {
  FiniteJournal film = split_bearing();
  film.kept_from = 0;
  film.knots = 21;
  const std::size_t each = static_cast<std::size_t>(film.kept_each());
  std::vector<double> kept(2 * each, 0.0);
  HeatSettings s = settings();
  s.wall = 0.015;
  s.pad_expansion = 1.8e-5;
  const auto point = [&](const Vec2& r) {
    FilmPoint p = at(r);
    p.kept = kept.data();
    return p;
  };
  Vec2 r(0.3 * c, -0.5 * c);
  const auto equilibrium = [&](const Vec2& load) {
    FilmForce f;
    FilmTangent t;
    for (int k = 0; k < 40; ++k) {
      film.evaluate(point(r), f, t);
      Mat2 K = t.F_r;  // w = -m J r follows the place
      Mat2 J;
      J << 0.0, -1.0, 1.0, 0.0;
      K -= 0.5 * Omega * t.F_w * J;
      const Vec2 step = -K.inverse() * (f.F + load);
      r += std::min(1.0, 0.2 * c / step.norm()) * step;
    }
    EXPECT_LT((f.F + load).norm(), 1e-8 * load.norm());
    film.evaluate(point(r), f, t);
    Mat2 J;
    J << 0.0, -1.0, 1.0, 0.0;
    return std::pair<Vec2, Mat2>(r, t.F_r - 0.5 * Omega * t.F_w * J);
  };
  const Vec2 load(0.0, -6e3);
  for (int round = 0; round < 25; ++round) {  // film and heat in balance
    const Vec2 there = equilibrium(load).first;
    const std::vector<HeatPad> pads{{&film, 0, point(there)}, {&film, 1, point(there)}};
    const HeatBalance b = balance_heat(pads, s);
    std::vector<double> settled(2 * each);
    for (std::size_t k = 0; k < 2; ++k)
      keep_heat(b, k, pads[k], std::span(settled).subspan(k * each, each));
    for (std::size_t i = 0; i < kept.size(); ++i)
      kept[i] += 0.5 * (settled[i] - kept[i]);
  }
  EXPECT_LT(kept[each / 2], -0.1);  // it is hot
  const Mat2 K = equilibrium(load).second;
  for (const Vec2& d : {Vec2(1.0, 0.0), Vec2(0.0, 1.0)}) {
    const Vec2 forth = equilibrium(load + d).first, back = equilibrium(load - d).first;
    const Vec2 by_law = -K.inverse() * d;
    EXPECT_LT((0.5 * (forth - back) - by_law).norm(), 1e-5 * by_law.norm());
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
