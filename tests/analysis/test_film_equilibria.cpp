// Random machines in oil films: an equilibrium that exists is found, and none is claimed where
// there is none.
#include <analysis/statics/equilibrium.hpp>
#include <assembly/build_system.hpp>
#include <deck/deck.hpp>
#include <elements/films/finite_journal.hpp>
#include "../core/reference.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::elements;

namespace {

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * 0.5 * (1.0 + random_.number());
  }
  double decade(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  int whole(int low, int high) {
    return std::min(high, low + static_cast<int>((high - low + 1) * between(0.0, 1.0)));
  }

 private:
  test::Random random_;
};

struct Journal {
  FiniteJournal film;
  std::string deck;
  Vec2 load;  ///< on the journal, from the statics of a straight rotor, N
};

/// A bearing of any shape, its viscosity such that the Sommerfeld number eta N L D (R/c)^2/W is
/// `sommerfeld`.
Journal any_journal(Draw& draw, double shaft, double spin, const Vec2& load, double sommerfeld) {
  Journal j;
  const double D = shaft * draw.between(0.8, 1.2), L = D * draw.decade(0.2, 2),
               c = D * draw.decade(5e-4, 2e-3);
  const double stiff = std::abs(spin) / two_pi * L * D * std::pow(0.5 * D / c, 2);
  const double eta = std::clamp(sommerfeld * load.norm() / stiff, 1e-5, 100.0);
  const double groove = draw.between(0.05, 0.6), at = draw.between(-3, 3),
               preload = draw.between(0, 0.8), offset = draw.between(0.3, 0.75);
  const int shape = draw.whole(0, 2), lobes = draw.whole(2, 5);
  j.deck = fmt::format(
      "type = \"journal\"\ndiameter = \"{:.17g} m\"\nlength = \"{:.17g} m\"\nclearance = \"{:.17g} "
      "m\"\nviscosity = \"{:.17g} Pa.s\"\n",
      D, L, c, eta);
  std::vector<JournalPad> pads;
  if (shape == 0) j.deck += "shape = \"plain\"\n";
  if (shape == 1) {
    j.deck += fmt::format(
        "shape = \"two_grooves\"\ngroove = \"{:.17g} rad\"\ngroove_at = \"{:.17g} rad\"\n", groove,
        at);
    pads = two_groove_pads(at, groove);
  }
  if (shape == 2) {
    j.deck += fmt::format(
        "shape = \"lobes\"\nlobes = {}\npreload = {:.17g}\ngroove = \"{:.17g} rad\"\nlobe_at = "
        "\"{:.17g} rad\"\nlobe_offset = {:.17g}\n",
        lobes, preload, groove, at, offset);
    pads = lobe_pads(lobes, at, groove, offset);
  }
  j.film = {0.5 * D, L, eta, std::make_shared<JournalSurface>(c, shape == 2 ? preload : 0.0, pads)};
  j.load = load;
  return j;
}

/// Whether the film carries the load where it is believed, up to an eccentricity of 0.99: damped
/// Newton from everywhere there.
bool carries(const Journal& j, double spin) {
  const FilmLaw<FiniteJournal> law{j.film};
  const double c = j.film.surface->clearance(), W = j.load.norm();
  const auto at = [&](const Vec2& r, Vec2& g, Mat2& K) {
    LateralMotion m;
    m.r = r;
    m.v.setZero();
    m.a.setZero();
    m.spin = spin;
    Vector<4> z;
    LateralTangent t;
    law.tangent(m, z, t);
    g = z.head<2>() + j.load;
    K = t.r.topRows<2>();
    return g.allFinite();
  };
  for (double size : {0.05, 0.3, 0.6, 0.8, 0.9, 0.96, 0.985})
    for (int k = 0; k < 36; ++k) {
      Vec2 r = size * c * Vec2(std::cos(two_pi * k / 36), std::sin(two_pi * k / 36)), g, next;
      Mat2 K, K_next;
      if (!at(r, g, K)) continue;
      for (int it = 0; it < 80; ++it) {
        if (g.norm() < 1e-9 * W && r.norm() < 0.99 * c) return true;
        const Vec2 d = -K.inverse() * g;
        double part = std::min(1.0, 0.2 * c / d.norm());
        while (part > 1e-6 &&
               !(at(r + part * d, next, K_next) && next.norm() < (1.0 - 1e-4 * part) * g.norm()))
          part *= 0.5;
        if (!(part > 1e-6)) break;
        r += part * d;
        g = next;
        K = K_next;
      }
    }
  return false;
}

struct Machine {
  double spin;
  Journal journal[2];
  std::string deck;
};

/// A shaft with two disks in two journals, weight in any direction; the bearings' loads are
/// statically determinate.
Machine any_machine(Draw& draw, double least_sommerfeld) {
  Machine m;
  m.spin = draw.decade(5, 1500) * (draw.between(0, 1) < 0.3 ? -1.0 : 1.0);
  const double L = draw.between(0.5, 3), d = draw.decade(0.05, 0.3),
               mass[2] = {draw.decade(5, 2000), draw.decade(5, 2000)};
  const double at[2] = {draw.between(0.05, 0.95) * L, draw.between(0.05, 0.95) * L},
               a = draw.between(0.02, 0.3) * L, b = draw.between(0.7, 0.98) * L;
  const double g = 9.81, turn = draw.between(0, two_pi), shaft = 7800 * pi / 4 * d * d * L;
  const Vec2 down(std::cos(turn), std::sin(turn));
  const double total = g * (shaft + mass[0] + mass[1]),
               moment = g * (shaft * L / 2 + mass[0] * at[0] + mass[1] * at[1]);
  const double second = (moment - total * a) / (b - a), load[2] = {total - second, second},
               place[2] = {a, b};
  m.deck = fmt::format(
      "format = 1\n[model]\ngravity_vector = [\"0 m/s^2\", \"{:.17g} m/s^2\", \"{:.17g} "
      "m/s^2\"]\n[[material]]\nname = \"s\"\nE = \"210 GPa\"\nnu = 0.3\ndensity = \"7800 kg/m^3\"\n"
      "[[shaft]]\nname = \"r\"\nmaterial = \"s\"\n[[shaft.section]]\nlength = \"{:.17g} m\"\nod = "
      "\"{:.17g} m\"\nmin_elements = 4\n"
      "[[bearing]]\nname = \"thrust\"\nat = \"r/{:.17g} m\"\ntype = \"linear\"\nkxx = \"1e8 "
      "N/m\"\ncxx = \"1e4 N.s/m\"\n",
      g * down.x(), g * down.y(), L, d, a);
  for (int k = 0; k < 2; ++k) {
    m.deck += fmt::format(
        "[[disk]]\nname = \"d{}\"\nat = \"r/{:.17g} m\"\nmass = \"{:.17g} kg\"\nIp = \"{:.17g} "
        "kg.m^2\"\nId = \"{:.17g} kg.m^2\"\n",
        k, at[k], mass[k], 0.02 * mass[k], 0.011 * mass[k]);
    m.journal[k] = any_journal(draw, d, m.spin, load[k] * down, draw.decade(least_sommerfeld, 30));
    m.deck += fmt::format("[[bearing]]\nname = \"{}\"\nat = \"r/{:.17g} m\"\n",
                          k == 0 ? "first" : "second", place[k]) +
              m.journal[k].deck;
  }
  return m;
}

struct Count {
  int found = 0, none = 0;
};

/// Every machine has an equilibrium whose films carry what statics says, or an independent search
/// finds none either.
Count run(unsigned seed, int machines, double least_sommerfeld) {
  Draw draw(seed);
  Count count;
  for (int n = 0; n < machines; ++n) {
    const Machine m = any_machine(draw, least_sommerfeld);
    const deck::Deck deck = deck::read_deck_text(m.deck, "deck.toml");
    const meshes::Mesh mesh = meshes::make_mesh(deck.model);
    const assembly::Built built = assembly::build_system(deck.model, mesh);
    analysis::SteadySystem running(built.system);
    analysis::EquilibriumSolver solver(running);
    const auto e = solver.try_solve(m.spin);
    if (!e) {
      ++count.none;
      EXPECT_FALSE(carries(m.journal[0], m.spin) && carries(m.journal[1], m.spin))
          << "machine " << n << " of seed " << seed << "\n"
          << solver.why();
      continue;
    }
    ++count.found;
    system::Workspace w = built.system.make_workspace();
    built.system.evaluate_nodes(w, e->state.frames, e->state.t, e->state.q, e->state.v, e->state.a);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto film = built.conditions.at(k).state([&](Index i) -> const system::NodeState& {
        return w.nodes[static_cast<std::size_t>(i)];
      });
      // of the straight rotor; its sag moves the loads by less
      EXPECT_NEAR(film.load, m.journal[k].load.norm(),
                  0.01 * (m.journal[0].load.norm() + m.journal[1].load.norm()))
          << "machine " << n << " of seed " << seed << " bearing " << k << " eccentricity "
          << film.displacement / film.gap;
    }
  }
  return count;
}

}  // namespace

// From light loads to the wall: Sommerfeld numbers from 0.02 to 30. (298 of 298 in a longer run of
// 300.)
TEST(FilmEquilibria, WhatExistsIsFound) {
  const Count c = run(1, 40, 0.02);
  EXPECT_GE(c.found, 38);
}

// Down to a hundredth of that: journals on the edge of a groove, or with more load than the film
// bears. Whatever is found carries the load.
TEST(FilmEquilibria, NoneIsClaimedWhereThereIsNone) {
  const Count c = run(2, 40, 2e-4);
  EXPECT_GE(c.none, 1);
  EXPECT_GE(c.found, 30);
}
