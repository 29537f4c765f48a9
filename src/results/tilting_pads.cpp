// Tilting pads at an equilibrium: how each stands, full and reduced coefficients, a section.
#include <results/support_coefficients.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {
namespace {

constexpr double pad_degrees = 180.0 / pi;

/// "y", "z", "tilt 1", "pivot 1", ..
std::vector<std::string> motion_names(const PadResults& ring) {
  std::vector<std::string> out{"y", "z"};
  for (std::size_t k = 0; k < ring.pads.size(); ++k) {
    out.push_back(fmt::format("tilt {}", k + 1));
    if (ring.gives[k]) out.push_back(fmt::format("pivot {}", k + 1));
  }
  return out;
}

void add_full(io::Table& t, const SupportCoefficients& c) {
  const elements::PadCoefficients& f = c.pads->full;
  const std::vector<std::string> names = motion_names(*c.pads);
  for (Index i = 0; i < f.K.rows(); ++i)
    for (Index j = 0; j < f.K.cols(); ++j) {
      if (f.K(i, j) == 0 && f.C(i, j) == 0 && f.M(i, j) == 0) continue;
      t.add({c.name, to_rpm(c.spin), names[at(i)], names[at(j)], f.K(i, j), f.C(i, j), f.M(i, j)});
    }
}

/// Clearances are drawn 1/5 of the radius at the assembled one.
constexpr double drawn_clearance = 0.2;

/// Points of an arc round a centre, radius r + rise over the angles.
plot::Series draw_arc(double from, double to, double r, const Vec2& centre) {
  plot::Series s;
  for (int k = 0; k <= 60; ++k) {
    const double a = from + (to - from) * k / 60;
    s.x.push_back(centre.x() + r * std::cos(a));
    s.y.push_back(centre.y() + r * std::sin(a));
  }
  return s;
}

/// A pad as it stands: its face, and a line from its pivot inwards as long as its share of the load.
void draw_pad(plot::Axes& a, const PadResults& ring, std::size_t k, const PadDrawing& d,
              double most) {
  const elements::PadStanding& pad = ring.pads[k];
  plot::Series face = draw_arc(d.from, d.to, d.radius, d.centre);
  face.style = {static_cast<int>(k), plot::Dash::solid, ring.carries(k) ? 3.0 : 1.2};
  face.label = ring.carries(k) ? fmt::format("pad {}: {:.4g} N", k + 1, pad.load)
                               : fmt::format("pad {}: no load", k + 1);
  face.keep_all = true;
  a.series.push_back(std::move(face));
  const Vec2 n(std::cos(ring.pivots[k]), std::sin(ring.pivots[k]));
  const double length = most > 0 ? 0.5 * std::max(0.0, pad.load) / most : 0.0;
  plot::Series load;
  const Vec2 foot = 1.25 * n, tip = (1.25 + length) * n;
  load.x = {foot.x(), tip.x()};
  load.y = {foot.y(), tip.y()};
  load.style = {static_cast<int>(k), plot::Dash::solid, 2.0, plot::Marker::circle, 5.0};
  load.keep_all = true;
  a.series.push_back(std::move(load));
}

plot::Figure draw_section(const std::string& name, const SupportCoefficients& c) {
  const PadResults& ring = *c.pads;
  plot::Figure f;
  f.name = name;
  f.title = fmt::format("Pads of '{}' at {:.6g} rpm", c.name, to_rpm(c.spin));
  f.caption =
      "Seen against +x; the clearances are drawn a fifth of the radius. Loads of the pads outside "
      "their pivots, the largest half a radius; pads that carry nothing are thin.";
  f.height = 460;
  plot::Axes a;
  a.equal_aspect = true;
  a.x = plot::Axis("y / radius", "-");
  a.y = plot::Axis("z / radius", "-");
  const double scale = drawn_clearance / c.clearance;
  plot::Series journal = draw_arc(0.0, two_pi, 1.0, scale * c.place);
  journal.label = "journal";
  journal.style = {plot::ink, plot::Dash::solid, 1.4};
  journal.keep_all = true;
  a.series.push_back(std::move(journal));
  double most = 0;
  for (const elements::PadStanding& p : ring.pads)
    most = std::max(most, p.load);
  for (std::size_t k = 0; k < ring.pads.size(); ++k) {
    PadDrawing d = ring.drawings[k];
    d.centre *= scale;
    d.radius = 1.0 + scale * d.radius;
    draw_pad(a, ring, k, d, most);
  }
  f.axes.push_back(std::move(a));
  return f;
}

}  // namespace

double PadResults::least_load() const {
  constexpr double share = 1e-5;  // of the largest: less is rounding
  double most = 0;
  for (const elements::PadStanding& p : pads)
    most = std::max(most, p.load);
  return share * most;
}

bool PadResults::carries(std::size_t pad) const { return pads[pad].load > least_load(); }

PadTables pad_tables(std::span<const SupportCoefficients> list) {
  PadTables out;
  out.pads.title = "Tilting pads at the equilibrium";
  out.pads.columns = {{"bearing", "-", ""},
                      {"speed", "rpm", ""},
                      {"pad", "-", ""},
                      {"pivot", "deg", "from +y towards +z"},
                      {"pad load", "N", "along the pivot, outwards"},
                      {"tilt", "rad", "about +x, y to z"},
                      {"pivot compression", "m", ""},
                      {"pad eccentricity", "-", "of the journal towards the pivot; 1: contact"},
                      {"smallest film", "m", ""},
                      {"power loss", "W", "of its film"},
                      {"carries", "-", "0: no load at any tilt; it rests where its film begins"}};
  out.reduced =
      reduced_table("Coefficients that the shaft sees with the pads following, by frequency");
  out.full.title = "Full coefficients of shaft and pads";
  out.full.columns = {{"bearing", "-", ""},
                      {"speed", "rpm", ""},
                      {"force along", "-", "force N, moment N m on the left side"},
                      {"motion", "-", "m, tilt rad"},
                      {"full k", "N/m", "and N/rad, N m/rad"},
                      {"full c", "N s/m", "and N s/rad, N m s/rad"},
                      {"full m", "kg", "and kg m^2"}};
  for (const SupportCoefficients& c : list) {
    if (!c.pads) continue;
    const PadResults& p = *c.pads;
    for (std::size_t k = 0; k < p.pads.size(); ++k) {
      const elements::PadStanding& s = p.pads[k];
      out.pads.add({c.name, to_rpm(c.spin), static_cast<double>(k + 1), p.pivots[k] * pad_degrees,
                    s.load, s.tilt, s.pressed, s.eccentricity, s.film, s.power,
                    p.carries(k) ? 1 : 0});
    }
    add_reduced(out.reduced, c, p.ratios, p.reduced);
    add_full(out.full, c);
  }
  return out;
}

std::vector<std::string> unloaded_pads(std::span<const SupportCoefficients> list) {
  std::vector<std::string> out;
  for (const SupportCoefficients& c : list) {
    if (!c.pads) continue;
    std::string numbers;
    int count = 0;
    for (std::size_t k = 0; k < c.pads->pads.size(); ++k)
      if (!c.pads->carries(k)) {
        numbers += fmt::format("{}{}", count == 0 ? "" : ", ", k + 1);
        ++count;
      }
    if (count == 0) continue;
    out.push_back(fmt::format(
        "bearing '{}' at {:.6g} rpm: pad{} {} carr{} nothing and rest{} where {} film begins (in "
        "practice such pads may flutter)",
        c.name, to_rpm(c.spin), count == 1 ? "" : "s", numbers, count == 1 ? "ies" : "y",
        count == 1 ? "s" : "", count == 1 ? "its" : "their"));
  }
  for (const SupportCoefficients& c : list) {
    if (!c.pads) continue;
    const auto text = [least = c.pads->least_load()](double load) {
      return load > least ? fmt::format("{:.4g} N", load) : std::string("nothing");
    };
    for (std::size_t k = 0; k < c.pads->pads.size(); ++k)
      if (!std::isnan(c.pads->others[k]))
        out.push_back(fmt::format(
            "bearing '{}' at {:.6g} rpm: pad {} carries {}, and in another balance with the "
            "journal "
            "where it is {}: which one it takes depends on how the speed is reached",
            c.name, to_rpm(c.spin), k + 1, text(c.pads->pads[k].load), text(c.pads->others[k])));
  }
  return out;
}

std::vector<plot::Figure> draw_pads(const std::string& name,
                                    std::span<const SupportCoefficients> list) {
  std::vector<plot::Figure> out;
  for (const SupportCoefficients& c : list)
    if (c.pads)
      out.push_back(
          draw_section(list.size() == 1 ? name : fmt::format("{}_{}", name, out.size() + 1), c));
  return out;
}

}  // namespace whirl::results
