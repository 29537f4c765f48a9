// Floating rings at an equilibrium: how each stands, full and reduced coefficients, a section.
#include <results/support_coefficients.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {
namespace {

/// "y", "z", "ring y", "ring z", "ring spin", "inner temperature", ..
std::string motion_of_ring(Index i, bool turns) {
  static constexpr const char* names[] = {
      "y", "z", "ring y", "ring z", "ring spin", "inner temperature", "outer temperature"};
  return names[i + (i >= 4 && !turns ? 1 : 0)];
}

void add_full_ring(io::Table& t, const SupportCoefficients& c) {
  const elements::PadCoefficients& f = c.ring->full;
  const bool turns = c.ring->turns;
  for (Index i = 0; i < f.K.rows(); ++i)
    for (Index j = 0; j < f.K.cols(); ++j) {
      if (f.K(i, j) == 0 && f.C(i, j) == 0 && f.M(i, j) == 0) continue;
      t.add({c.name, to_rpm(c.spin), motion_of_ring(i, turns), motion_of_ring(j, turns), f.K(i, j),
             f.C(i, j), f.M(i, j)});
    }
}

/// Both clearances together are drawn 2/5 of the radius of the journal.
constexpr double drawn_room = 0.4;

plot::Series draw_circle(double r, const Vec2& centre, const char* label, plot::Style style) {
  plot::Series s;
  for (int k = 0; k <= 120; ++k) {
    const double a = two_pi * k / 120;
    s.x.push_back(centre.x() + r * std::cos(a));
    s.y.push_back(centre.y() + r * std::sin(a));
  }
  s.label = label;
  s.style = style;
  s.keep_all = true;
  return s;
}

plot::Figure draw_ring_section(const std::string& name, const SupportCoefficients& c) {
  const elements::RingStanding& s = c.ring->standing;
  plot::Figure f;
  f.name = name;
  f.title = fmt::format("Floating ring of '{}' at {:.6g} rpm", c.name, to_rpm(c.spin));
  f.caption = fmt::format(
      "Seen against +x; the clearances are drawn {:.0f} % of the journal's radius. The ring turns "
      "at "
      "{:.6g} rpm.",
      100 * drawn_room, to_rpm(c.ring->spin));
  f.height = 460;
  plot::Axes a;
  a.equal_aspect = true;
  a.x = plot::Axis("y / radius of the journal", "-");
  a.y = plot::Axis("z / radius of the journal", "-");
  const double scale = drawn_room / c.clearance, thickness = 0.35;
  const double bore = 1.0 + scale * s.inner.clearance, outside = bore + thickness;
  const Vec2 ring = scale * s.outer.place, journal = ring + scale * s.inner.place;
  a.series.push_back(draw_circle(1.0, journal, "journal", {0, plot::Dash::solid, 1.8}));
  a.series.push_back(draw_circle(bore, ring, "ring", {1, plot::Dash::solid, 1.8}));
  a.series.push_back(draw_circle(outside, ring, "", {1, plot::Dash::solid, 1.8}));
  a.series.push_back(draw_circle(outside + scale * s.outer.clearance, Vec2::Zero(), "housing",
                                 {plot::ink, plot::Dash::solid, 1.8}));
  f.axes.push_back(std::move(a));
  return f;
}

std::vector<io::Table::Column> ring_columns() {
  std::vector<io::Table::Column> out{{"bearing", "-", ""},
                                     {"speed", "rpm", "of the shaft"},
                                     {"ring speed", "rpm", ""},
                                     {"ring speed / speed", "-", ""},
                                     {"ring y", "m", "against the housing"},
                                     {"ring z", "m", ""}};
  for (const std::string film : {"inner", "outer"}) {
    out.push_back({film + " eccentricity", "-", "of its own clearance"});
    out.push_back({film + " load", "N", ""});
    out.push_back({film + " clearance", "m", "as it has grown"});
    out.push_back({film + " thinnest film", "m", ""});
    out.push_back({film + " power loss", "W", ""});
    out.push_back({film + " viscosity", "Pa s", ""});
    out.push_back({film + " temperature", "degC", "empty: it is not an unknown"});
    out.push_back({film + " flow", "m^3/s", "empty: the supply is not known"});
  }
  out.push_back({"torque on the ring", "N m", "of both films: 0, or what a pin holds"});
  out.push_back({"feed pressure of the inner film", "Pa",
                 "behind the ring's holes; below 0 the supply does not reach it"});
  return out;
}

void add_ring_row(io::Table& t, const SupportCoefficients& c) {
  const RingResults& r = *c.ring;
  const elements::RingStanding& s = r.standing;
  std::vector<io::Table::Cell> row{c.name,
                                   to_rpm(c.spin),
                                   to_rpm(r.spin),
                                   c.spin != 0 ? r.spin / c.spin : nan,
                                   s.outer.place.x(),
                                   s.outer.place.y()};
  for (const elements::RingFilmStanding* f : {&s.inner, &s.outer})
    for (const double x : {f->eccentricity, f->force.norm(), f->clearance, f->thinnest(), f->power,
                           f->viscosity, f->temperature - 273.15, f->flow})
      row.emplace_back(x);
  row.emplace_back(s.torque);
  row.emplace_back(s.feed_pressure);
  t.add(std::move(row));
}

}  // namespace

RingTables ring_tables(std::span<const SupportCoefficients> list) {
  RingTables out;
  out.rings.title = "Floating rings at the equilibrium";
  out.rings.nan_means = "the bearing has no such number";
  out.rings.nan_is_absence = true;
  out.rings.columns = ring_columns();
  out.reduced =
      reduced_table("Coefficients that the shaft sees with the rings following, by frequency");
  out.full.title = "Full coefficients of shaft and ring";
  out.full.columns = {{"bearing", "-", ""},
                      {"speed", "rpm", ""},
                      {"force along", "-", "row: a force on the left side, N"},
                      {"motion", "-", "m; spin and temperatures in their units of the theory"},
                      {"full k", "N/m", ""},
                      {"full c", "N s/m", ""},
                      {"full m", "kg", ""}};
  for (const SupportCoefficients& c : list) {
    if (!c.ring) continue;
    const RingResults& r = *c.ring;
    add_ring_row(out.rings, c);
    add_reduced(out.reduced, c, r.ratios, r.reduced);
    add_full_ring(out.full, c);
  }
  return out;
}

std::vector<std::string> starved_rings(std::span<const SupportCoefficients> list) {
  std::vector<std::string> out;
  for (const SupportCoefficients& c : list) {
    if (!c.ring || !(c.ring->standing.feed_pressure < 0)) continue;
    out.push_back(fmt::format(
        "bearing '{}' at {:.6g} rpm: its ring turns at {:.6g} rpm and keeps the supply from the "
        "inner film (from {:.6g} rpm on): that film is given only what it displaces",
        c.name, to_rpm(c.spin), to_rpm(c.ring->spin), to_rpm(c.ring->starved_spin)));
  }
  return out;
}

std::vector<plot::Figure> draw_rings(const std::string& name,
                                     std::span<const SupportCoefficients> list) {
  std::vector<plot::Figure> out;
  const auto rings = std::count_if(list.begin(), list.end(),
                                   [](const SupportCoefficients& c) { return c.ring.has_value(); });
  for (const SupportCoefficients& c : list)
    if (c.ring)
      out.push_back(
          draw_ring_section(rings == 1 ? name : fmt::format("{}_{}", name, out.size() + 1), c));
  return out;
}

}  // namespace whirl::results
