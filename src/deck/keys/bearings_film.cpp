// Lubricating films, seals and the destabilising forces of flow.
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::deck {

bool check_oil_temperature(Visitor& v, const char* key, double T) {
  if (T >= 243.15 && T <= 473.15) return true;
  v.error("E14", key,
          fmt::format("{} is outside -30 to 200 degC, where the viscosity of oils is known",
                      units::display(T, "degC")),
          "the temperature of the film, in degC");
  return false;
}

namespace {

/// Which keys of the oil are given.
struct OilGiven {
  bool viscosity = false, grade = false, temperature = false, thinning = false;
};

OilGiven oil_keys(Visitor& v, model::Oil& o, bool heated) {
  OilGiven given;
  given.viscosity = v.quantity(optional("viscosity", "from iso_vg"), o.viscosity, "mPa.s", positive,
                               "dynamic viscosity");
  given.grade =
      v.number(optional("iso_vg", "viscosity is given"), o.grade, Range{1, 5000, false, false},
               "ISO VG grade of the oil: its viscosity in mm2/s at 40 degC");
  given.temperature = v.quantity(
      optional("temperature", "viscosity is given"), o.temperature, "degC", any,
      heated ? "temperature of the film, -30 to 200 degC, with iso_vg; with heat that at "
               "which viscosity holds"
             : "temperature of the film, -30 to 200 degC, with iso_vg");
  v.quantity("density", o.density, "kg/m^3", positive,
             heated ? "density of the oil, with iso_vg, turbulence and heat"
                    : "density of the oil, with iso_vg");
  if (heated)
    given.thinning =
        v.quantity(optional("thinning", "from iso_vg"), o.thinning, "1/K", not_negative,
                   "with viscosity and heat: at T the viscosity is that given times "
                   "exp(-thinning (T - temperature))");
  return given;
}

void check_oil(Visitor& v, const model::Oil& o, const OilGiven& given) {
  if (given.temperature) check_oil_temperature(v, "temperature", o.temperature);
  if (!v.clean()) return;
  if (given.viscosity && given.grade)
    v.error("E26", "iso_vg", "the viscosity is given directly and by a grade",
            "keep one of the two");
  else if (!given.viscosity && !given.grade)
    v.error("E05", nullptr, "the oil has no viscosity",
            "viscosity = \"20 mPa.s\", or iso_vg = 46 and temperature = \"50 degC\"");
}

void oil(Visitor& v, model::Oil& o) {
  const OilGiven given = oil_keys(v, o, false);
  if (!v.clean()) return;
  check_oil(v, o, given);
  if (v.clean() && given.grade && !given.temperature)
    v.error("E05", "iso_vg", "a grade needs 'temperature'", "temperature = \"50 degC\"");
}

void describe_heat(Visitor& v, model::FilmHeat& h, bool tilting) {
  using Feed = model::FilmHeat::Feed;
  v.quantity(required("supply_temperature"), h.supply_temperature, "degC", any, "of the fresh oil");
  v.quantity("specific_heat", h.specific_heat, "J/(kg.K)", positive, "of the oil");
  v.quantity("conductivity", h.conductivity, "W/(m.K)", positive, "of the oil");
  v.choice("feed", h.feed,
           {{"flooded", tilting ? "the pads stand in a bath of oil: carry_over 0.75"
                                : "the oil of the pad before stays in the groove: carry_over 0.75"},
            {"leading_edge", "fresh oil in a groove of the pad's leading edge: carry_over 0.3"}},
           "how pads are fed");
  const bool flows =
      tilting && v.quantity(optional("supply_flow", "that which carry_over stands for"),
                            h.supply_flow, "L/min", positive,
                            "fresh oil to the whole bearing: predicts how warm the oil about the "
                            "pads is, and that enters where the pad before gives too little");
  if (h.feed == Feed::leading_edge)
    h.carry_over = 0.3;
  else if (flows)
    h.carry_over = 1.0;
  v.number(optional("carry_over",
                    tilting ? "by feed; 1 where flooded pads have supply_flow" : "by feed"),
           h.carry_over, Range{0, 1, false, true},
           tilting ? "flooded: how much warmer the oil that enters a pad is than that supplied, "
                     "over how much warmer it leaves the pad before; or, with supply_flow, the "
                     "share of that oil which enters. leading_edge: share of oil of the pad "
                     "before in what enters, where that gives as much"
                   : "share of hot oil, from the pad before, in the oil that enters a pad, where "
                     "that pad gives as much");
  if (tilting) h.wall = nan;
  v.quantity(tilting ? optional("wall", "the thickness of the pads") : Key("wall"), h.wall, "mm",
             not_negative,
             "thickness of the pads for the heat that goes through them; 0: none does");
  v.quantity("wall_conductivity", h.wall_conductivity, "W/(m.K)", positive, "of the pads");
  v.quantity("back_coefficient", h.back_coefficient, "W/(m^2.K)", not_negative,
             "heat transfer from the back and the ends of the pads");
  v.quantity(optional("housing_temperature",
                      tilting ? "that of the oil about the pads with supply_flow, else of that "
                                "which enters each"
                              : "that of the oil which enters each pad"),
             h.housing_temperature, "degC", any, "of what is about the pads");
  v.quantity("shaft_expansion", h.shaft_expansion, "1/K", not_negative,
             "thermal expansion of the journal, which closes the clearance");
  v.quantity("pad_expansion", h.pad_expansion, "1/K", not_negative,
             tilting ? "of the pads: their thickness closes the clearance, their radius grows, and "
                       "pads hotter at their faces open"
                     : "of the pads, which are the bush: it opens the clearance");
  if (tilting)
    v.quantity("housing_expansion", h.housing_expansion, "1/K", not_negative,
               "of the housing, which opens the clearance");
  v.quantity("assembly_temperature", h.assembly_temperature, "degC", any,
             "at which the clearances are those given");
  v.quantity(
      optional("time_constant", "they stay as they begin"), h.time_constant, "s", positive,
      "by which, in a motion in time, viscosities and clearances go towards those that are in "
      "balance with it");
}

/// Keys of what goes beyond isoviscous laminar oil at ambient pressure, and the oil's checks.
void flow_of_film(Visitor& v, model::FilmFlow& f, model::Oil& o, bool tilting) {
  const OilGiven given = oil_keys(v, o, true);
  v.choice("turbulence", f.regime,
           {{"laminar", "none"},
            {"ng_pan", "factors of Ng and Pan by the local Reynolds number, with density"}},
           "what turbulence adds to the resistance of the film");
  v.quantity("supply_pressure", f.supply_pressure, "bar", not_negative,
             tilting ? "of the oil between the pads and behind them, above ambient"
                     : "of the oil in the grooves, above ambient");
  v.choice("cavitation", f.cavitation,
           {{"reynolds",
             "a film forms and ruptures without a slope of its pressure, as if oil were "
             "wherever it forms"},
            {"mass_conserving",
             "after Jakobsson, Floberg and Olsson: ruptured film carries on what "
             "oil there is, and the next film forms where that fills the gap"}},
           "how much oil there is where the film has ruptured");
  model::FilmHeat heat;
  const bool heated = v.table(
      optional("heat", "one viscosity everywhere"),
      [&](Visitor& w) { describe_heat(w, heat, tilting); },
      "temperatures of film and pads, in balance with every equilibrium; a motion in time keeps "
      "those it begins with, or follows with time_constant");
  if (heated) f.heat = heat;
  if (!v.clean()) return;
  check_oil(v, o, given);
  if (!v.clean()) return;
  if (!heated && given.thinning)
    v.error("E05", "thinning", "a viscosity that falls with temperature needs 'heat'",
            "heat = { supply_temperature = \"40 degC\" }");
  else if (!heated && given.grade && !given.temperature)
    v.error("E05", "iso_vg", "a grade needs 'temperature', or 'heat'", "temperature = \"50 degC\"");
  else if (heated && given.grade && given.temperature)
    v.error("E26", "temperature", "the temperature of the film is given, and 'heat' finds it",
            "keep one of the two");
  else if (heated && given.viscosity && !(given.temperature && given.thinning))
    v.error("E05", "viscosity",
            "with 'heat' a viscosity needs the temperature at which it holds, and 'thinning'",
            "temperature = \"40 degC\", thinning = \"0.03 1/K\"; or iso_vg instead");
  if (!v.clean() || !heated) return;
  check_oil_temperature(v, "heat", heat.supply_temperature);
  if (given.grade) o.temperature = heat.supply_temperature;
}

template <class Film>
void diameter_and_length(Visitor& v, Film& b) {
  v.quantity(required("diameter"), b.diameter, "mm", positive, "journal diameter");
  v.quantity(required("length"), b.length, "mm", positive, "axial length of the film");
}

void check_clearance(Visitor& v, const char* key, double clearance, double diameter) {
  if (!v.clean() || clearance <= 0.02 * diameter) return;
  v.error("E14", key,
          fmt::format("the clearance {} is not small against the diameter {}: no film",
                      units::display(clearance, "um"), units::display(diameter, "mm")),
          "the radial clearance is usually about a thousandth of the radius");
}

template <class Film>
void dimensions(Visitor& v, Film& b) {
  diameter_and_length(v, b);
  v.quantity(
      required("clearance"), b.clearance, "um", positive,
      "radial clearance as assembled (half the difference of diameters, of lobes where it is "
      "least)");
  check_clearance(v, "clearance", b.clearance, b.diameter);
}

}  // namespace

void describe(Visitor& v, model::ShortJournal& b) {
  dimensions(v, b);
  oil(v, b.oil);
  if (v.clean() && b.length > b.diameter)
    v.warning("W03", "length",
              "the short-bearing theory is for lengths below about half the diameter",
              "type = \"journal\" has no such limit");
}

void describe(Visitor& v, model::FiniteJournal::Groove& g) {
  v.quantity(required("at"), g.at, "deg", any, "angle of its middle, from y towards z");
  v.quantity("width", g.width, "deg", Range{0, two_pi, true, true}, "along the circumference");
}

namespace {

/// Along the axis, of shapes that need a grid there.
constexpr int usual_rows = 6;

/// Which edge of the pads the surface of the journal enters by.
void leading_edge(Visitor& v, bool& at_end) {
  int edge = at_end ? 1 : 0;
  v.choice("leading", edge, {{"start", "of a shaft that turns y -> z"}, {"end", "z -> y"}},
           "edge of a pad at which its recess begins");
  at_end = edge == 1;
}

/// Pressure dam of the first pad, relief track of the second.
void describe_dam(Visitor& v, model::FiniteJournal& b) {
  b.shape = model::FiniteJournal::Shape::pressure_dam;
  b.rows = usual_rows;
  b.groove = 20 * pi / 180;
  v.quantity("groove", b.groove, "deg", Range{0, pi / 2, true, true}, "width of a groove");
  v.quantity("groove_at", b.groove_at, "deg", any,
             "angle of the first groove, from y towards z; the pad with the dam follows it");
  v.number("preload", b.preload, Range{0, 1, false, true},
           "1 - (assembled clearance)/(clearance of the two pads); 0: a cylinder");
  v.quantity(required("dam_arc"), b.recess_arc, "deg", Range{0, pi, true, true},
             "arc of the pocket, from the leading edge of its pad to the dam");
  v.quantity(required("dam_depth"), b.recess_depth, "um", positive, "depth of the pocket");
  v.quantity(required("dam_width"), b.recess_width, "mm", positive,
             "axial width of the pocket, in the middle of the length");
  v.quantity(optional("relief_width", "no track"), b.relief_width, "mm", positive,
             "axial width of a relief track in the middle of the other pad, deep and open to the "
             "grooves");
  leading_edge(v, b.leading_at_end);
  if (!v.clean()) return;
  if (b.recess_arc >= pi - b.groove)
    v.error("E14", "dam_arc", "the pocket is longer than its pad: there is no dam",
            "less than 180 deg less a groove");
  else if (b.recess_width > b.length || b.relief_width >= b.length)
    v.error("E14", b.recess_width > b.length ? "dam_width" : "relief_width",
            fmt::format("wider than the film is long ({})", units::display(b.length, "mm")));
}

void describe_lands(Visitor& v, model::FiniteJournal& b) {
  b.shape = model::FiniteJournal::Shape::tapered_land;
  b.rows = usual_rows;
  b.groove = 20 * pi / 180;
  v.integer("lands", b.lobes, between(2, 8), "number of pads");
  v.quantity("groove", b.groove, "deg", Range{0, pi / 2, true, true},
             "width of a groove between two pads");
  v.quantity("land_at", b.lobe_at, "deg", any, "angle of the middle of the first pad, from y to z");
  v.quantity(required("taper_arc"), b.recess_arc, "deg", Range{0, pi, true, true},
             "arc of the taper, from the leading edge of a pad to its land");
  v.quantity(required("taper_depth"), b.recess_depth, "um", positive,
             "depth of the taper at the leading edge");
  const bool narrow = v.quantity(optional("taper_width", "the whole length"), b.recess_width, "mm",
                                 positive, "axial width of the taper, in the middle of the length");
  leading_edge(v, b.leading_at_end);
  if (!v.clean()) return;
  if (!narrow) b.recess_width = b.length;
  const double arc = two_pi / b.lobes - b.groove;
  if (arc <= 0)
    v.error("E14", "groove", "the grooves leave nothing of the pads", "narrower grooves, or fewer");
  else if (b.recess_arc > arc * (1 + 1e-9))
    v.error("E14", "taper_arc", fmt::format("longer than a pad ({})", units::display(arc, "deg")),
            "at most all of the pad");
  else if (b.recess_width > b.length)
    v.error("E14", "taper_width",
            fmt::format("wider than the film is long ({})", units::display(b.length, "mm")));
}

void describe_grooves(Visitor& v, model::FiniteJournal& b) {
  b.shape = model::FiniteJournal::Shape::grooves;
  v.list(required("axial_groove"), Visitor::body_of(b.grooves, model::FiniteJournal::Groove{}),
         "an axial groove");
  if (!v.clean()) return;
  if (b.grooves.empty())
    v.error("E05", "axial_groove", "no groove is given",
            "axial_groove = [{ at = \"90 deg\" }], or shape = \"plain\"");
  for (std::size_t k = 0; k < b.grooves.size(); ++k)
    for (std::size_t i = 0; i < k; ++i) {
      const double apart = std::abs(std::remainder(b.grooves[k].at - b.grooves[i].at, two_pi));
      if (apart > 0.5 * (b.grooves[k].width + b.grooves[i].width)) continue;
      v.error("E14", "axial_groove",
              fmt::format("grooves {} and {} touch each other", i + 1, k + 1),
              "one groove instead, or narrower ones");
      return;
    }
}

/// The grid of a film; shapes that need one along the axis come with some rows.
template <class Law>
void film_grid(Visitor& v, Law& b, const char* without) {
  const bool points = v.integer(optional("grid", "72, or 240 with a grid along the axis"), b.nodes,
                                between(24, 360), "points round the circumference");
  const bool needed = b.rows > 0;
  v.integer(
      optional("axial_grid", without), b.rows, between(0, 8),
      "rows over half the length where the pressure along the axis is found on a grid too, 3 to "
      "8, a few hundred times dearer; 0: one profile, whose error stands beside the coefficients");
  if (!v.clean()) return;
  if (needed && b.rows == 0)
    v.error("E26", "axial_grid", "a surface that varies along the axis has no single profile",
            "leave it out, or 3 to 8 rows");
  else if (b.rows == 1 || b.rows == 2)
    v.error("E14", "axial_grid", "a grid along the axis has 3 to 8 rows over half the length");
  if (!v.clean() || b.rows == 0) return;
  if (!points) b.nodes = 240;
}

}  // namespace

void describe(Visitor& v, model::FiniteJournal& b) {
  using Shape = model::FiniteJournal::Shape;
  dimensions(v, b);
  flow_of_film(v, b.flow, b.oil, false);
  const Alternative shapes[] = {
      {"plain", "a cylinder without grooves", [&](Visitor&) { b.shape = Shape::plain; }},
      {"two_grooves", "a cylinder with two axial grooves, opposite each other",
       [&](Visitor& w) {
         b.shape = Shape::two_grooves;
         b.groove = 20 * pi / 180;
         w.quantity("groove", b.groove, "deg", Range{0, pi / 2, true, true}, "width of a groove");
         w.quantity("groove_at", b.groove_at, "deg", any,
                    "angle of the first groove, from y towards z");
       }},
      {"lobes", "equal lobes with grooves between them",
       [&](Visitor& w) {
         b.shape = Shape::lobes;
         b.groove = 20 * pi / 180;
         w.integer("lobes", b.lobes, between(2, 8), "number of lobes");
         w.number("preload", b.preload, Range{0, 1, false, true},
                  "1 - (assembled clearance)/(clearance of the lobes); 0: a cylinder");
         w.quantity("groove", b.groove, "deg", Range{0, pi / 2, false, true}, "width of a groove");
         w.quantity("lobe_at", b.lobe_at, "deg", any,
                    "angle of the middle of the first lobe, from y towards z");
         w.number("lobe_offset", b.lobe_offset, fraction,
                  "where the lobe is tightest: 0 its start, 0.5 its middle, 1 its end in the sense "
                  "of rotation y -> z");
         if (w.clean() && b.lobes * b.groove >= two_pi)
           w.error("E14", "groove", "the grooves leave nothing of the lobes");
       }},
      {"grooves", "a cylinder with axial grooves anywhere",
       [&](Visitor& w) { describe_grooves(w, b); }},
      {"pressure_dam", "two grooves; the first pad with a pocket that ends at a dam",
       [&](Visitor& w) { describe_dam(w, b); }},
      {"tapered_land", "equal pads between grooves, each with a taper that ends at a land",
       [&](Visitor& w) { describe_lands(w, b); }},
  };
  v.alternatives(required("shape"), shapes, "shape of the bearing surface");
  film_grid(v, b, "0, or 6 for shapes that vary along the axis");
  const bool fed = b.flow.supply_pressure > 0, heated = b.flow.heat.has_value(),
             conserves = b.flow.conserves_mass();
  if (v.clean() && b.shape == Shape::plain && (fed || heated || conserves))
    v.error("E26",
            fed      ? "supply_pressure"
            : heated ? "heat"
                     : "cavitation",
            "a plain cylinder has no groove through which oil could come",
            "shape = \"two_grooves\", or \"lobes\"");
}

namespace {

using Pad = model::TiltingPadJournal::Pad;

/// A ball or a line in its seat.
void describe_contact(Visitor& v, std::optional<model::TiltingPadJournal::Contact>& contact) {
  using Contact = model::TiltingPadJournal::Contact;
  Contact c;
  const Alternative shapes[] = {
      {"ball", "a ball in a hollow seat, or on a flat one (Hertz: load as the power 3/2)",
       [&](Visitor& w) {
         c.shape = Contact::Shape::ball;
         w.quantity(required("radius"), c.radius, "mm", positive, "of the ball");
         w.quantity(optional("seat_radius", "a flat seat"), c.seat_radius, "mm", positive,
                    "of the hollow seat, larger than that of the ball");
         w.quantity("E", c.E, "GPa", positive, "Young's modulus of both");
         w.number("nu", c.nu, Range{0, 0.5, false, true}, "Poisson's ratio of both");
         if (w.clean() && c.seat_radius <= c.radius)
           w.error("E14", "seat_radius", "the ball does not fit into its seat",
                   "a seat is a little wider than its ball");
       }},
      {"line", "a rocker on a line, of steel (Palmgren: load as the power 10/9)",
       [&](Visitor& w) {
         c.shape = Contact::Shape::line;
         w.quantity(optional("length", "that of the bearing"), c.length, "mm", positive,
                    "of the line, along the axis");
       }},
  };
  v.alternatives(required("shape"), shapes, "what touches");
  if (!v.clean()) return;
  contact = c;
}

/// What keeps a pivot that does not give.
const char* const rigid_hint = "give pivot_stiffness or pivot_contact, or leave it out";

}  // namespace

void describe(Visitor& v, model::TiltingPadJournal::Pad& p) {
  constexpr const char* without = "that of the bearing";
  v.quantity(required("pivot"), p.pivot, "deg", any, "angle of the pivot, from y towards z");
  v.quantity("arc", p.arc, "deg", Range{0, two_pi, true, true}, "of the pad");
  v.number("offset", p.offset, fraction, "of the pivot from the start of the pad, in arcs");
  v.number("preload", p.preload, Range{0, 1, false, true},
           "1 - (assembled clearance)/(clearance of the pad)");
  v.quantity(optional("clearance", without), p.clearance, "um", positive,
             "radial, as assembled: of a centred journal at the pivot");
  v.quantity(optional("thickness", without), p.thickness, "mm", not_negative,
             "at the pivot, which is that far behind the film");
  v.quantity(optional("inertia", without), p.inertia, "kg.m^2", not_negative,
             "moment of inertia about the pivot; 0: the pad follows the film at once");
  const bool mass = v.quantity(optional("mass", without), p.mass, "kg", not_negative,
                               "for its motion along an elastic pivot");
  const bool elastic = v.quantity(optional("pivot_stiffness", "the pivot of the bearing"),
                                  p.pivot_stiffness, "N/m", positive, "of the pivot, radial");
  std::optional<model::TiltingPadJournal::Contact> own;
  const bool contact = v.table(
      optional("pivot_contact", "the pivot of the bearing"),
      [&](Visitor& w) { describe_contact(w, own); },
      "an elastic pivot that stiffens with its load, instead of pivot_stiffness");
  const bool damping = v.quantity(optional("pivot_damping", without), p.pivot_damping, "N.s/m",
                                  not_negative, "of an elastic pivot");
  v.quantity(optional("tilt_stiffness", without), p.tilt_stiffness, "N.m/rad", not_negative,
             "of the pivot against tilting: a flexure");
  if (elastic || contact) p.contact = own;
  if (contact) p.pivot_stiffness = 0;
  if (!v.clean()) return;
  if (elastic && contact)
    v.error("E26", "pivot_stiffness", "the pivot has a stiffness and a contact",
            "keep one of the two");
  else if (p.rigid_pivot() && ((mass && p.mass != 0) || (damping && p.pivot_damping != 0)))
    v.error("E05", mass && p.mass != 0 ? "mass" : "pivot_damping", "a rigid pivot does not move",
            rigid_hint);
}

namespace {

/// Keys of a bearing that hold for all its pads, or are lists of one value for each.
class PadKeys {
 public:
  PadKeys(Visitor& v, Pad& like) : v_(v), like_(like) {}

  bool operator()(const Key& k, double Pad::*value, const char* unit, Range range,
                  const char* doc) {
    std::vector<double> each;
    const bool given = v_.one_or_each(k, like_.*value, each, unit, range, doc);
    if (each.empty()) return given;
    like_.*value = *std::max_element(each.begin(), each.end());
    lists_.push_back({k.name, value, std::move(each)});
    return given;
  }
  bool lists() const { return !lists_.empty(); }
  /// Pad k, from 0, but for what it says itself.
  Pad pad(std::size_t k) const {
    Pad out = like_;
    for (const List& x : lists_)
      if (k < x.each.size()) out.*x.value = x.each[k];
    return out;
  }
  void check_lengths(std::size_t pads) const {
    for (const List& x : lists_)
      if (x.each.size() != pads)
        v_.error("E20", x.key,
                 fmt::format("'{}' has {} value{} for {} pad{}", x.key, x.each.size(),
                             x.each.size() == 1 ? "" : "s", pads, pads == 1 ? "" : "s"),
                 "one value for all pads, or a list of one for each");
  }
  /// A list that moves a pad on a rigid pivot.
  void check_pivots(const std::vector<Pad>& pads) const {
    for (const List& x : lists_)
      for (std::size_t k = 0; k < pads.size(); ++k) {
        const bool along = x.value == &Pad::mass || x.value == &Pad::pivot_damping;
        if (!along || !pads[k].rigid_pivot() || pads[k].*x.value == 0) continue;
        v_.error("E05", x.key, fmt::format("the pivot of pad {} is rigid and does not move", k + 1),
                 rigid_hint);
        return;
      }
  }

 private:
  struct List {
    const char* key;
    double Pad::*value;
    std::vector<double> each;
  };
  Visitor& v_;
  Pad& like_;
  std::vector<List> lists_;
};

/// Pads that reach into each other.
void check_overlap(Visitor& v, const std::vector<Pad>& pads) {
  struct Stretch {
    double from, to;
    std::size_t number;
  };
  std::vector<Stretch> all;
  for (const auto& p : pads) {
    const double from = p.pivot - p.offset * p.arc,
                 begin = from - two_pi * std::floor(from / two_pi);
    all.push_back({begin, begin + p.arc, all.size() + 1});
  }
  std::sort(all.begin(), all.end(),
            [](const Stretch& x, const Stretch& y) { return x.from < y.from; });
  for (std::size_t k = 0; k < all.size(); ++k) {
    const bool last = k + 1 == all.size();
    const Stretch& next = all[last ? 0 : k + 1];
    const double begins = next.from + (last ? two_pi : 0.0);
    if (all[k].to <= begins + 1e-9) continue;
    v.error("E14", v.given("pad") ? "pad" : "arc",
            fmt::format("pads {} and {} overlap by {}", all[k].number, next.number,
                        units::display(all[k].to - begins, "deg")),
            "smaller arcs, or fewer pads");
    return;
  }
}

/// Mass and damper of pivots none of which gives.
void check_rigid_pivots(Visitor& v, const model::TiltingPadJournal& b,
                        const std::vector<Pad>& pads) {
  const bool rigid =
      std::all_of(pads.begin(), pads.end(), [](const Pad& p) { return p.rigid_pivot(); });
  if (rigid && (b.like.mass != 0 || b.like.pivot_damping != 0))
    v.error("E05", b.like.mass != 0 ? "mass" : "pivot_damping", "a rigid pivot does not move",
            rigid_hint);
}

/// The pads of a bearing whose keys are read: by themselves where one differs.
void settle_pads(Visitor& v, model::TiltingPadJournal& b, const PadKeys& keys) {
  std::vector<Pad> pads = b.pads();
  keys.check_lengths(pads.size());
  if (!v.clean()) return;
  if (b.own.empty() && keys.lists()) {
    for (std::size_t k = 0; k < pads.size(); ++k) {
      const double pivot = pads[k].pivot;
      pads[k] = keys.pad(k);
      pads[k].pivot = pivot;
    }
    b.own = pads;
  }
  b.clearance = infinity;
  for (const Pad& p : pads) {
    b.clearance = std::min(b.clearance, p.clearance);
    check_clearance(v, v.given("pad") ? "pad" : "clearance", p.clearance, b.diameter);
  }
  if (v.clean()) check_rigid_pivots(v, b, pads);
  if (v.clean()) keys.check_pivots(pads);
  if (v.clean()) check_overlap(v, pads);
}

}  // namespace

void describe(Visitor& v, model::TiltingPadJournal& b) {
  PadKeys each(v, b.like);
  diameter_and_length(v, b);
  each(required("clearance"), &Pad::clearance, "um", positive,
       "radial clearance as assembled: of a centred journal at the pivots; ratios to the clearance "
       "of "
       "a bearing are to its smallest");
  each("thickness", &Pad::thickness, "mm", not_negative,
       "of a pad at its pivot: the pivot is that far behind the film");
  flow_of_film(v, b.flow, b.oil, true);
  const bool count = v.integer(optional("pads", "5, or those listed"), b.count, between(1, 24),
                               "number of equal pads");
  const bool first = v.quantity(optional("first_pivot", "-90 deg"), b.first, "deg", any,
                                "angle of the first pivot of equal pads, from y towards z: where "
                                "the load points it is on a pad");
  each("arc", &Pad::arc, "deg", Range{0, two_pi, true, true}, "of a pad");
  each("offset", &Pad::offset, "", fraction,
       "of the pivot from the start of its pad in arcs; 0.5: central, more: towards the end in "
       "the sense of rotation y -> z");
  each("preload", &Pad::preload, "", Range{0, 1, false, true},
       "1 - (assembled clearance)/(clearance of the pads)");
  each("inertia", &Pad::inertia, "kg.m^2", not_negative,
       "moment of inertia of a pad about its pivot; 0: it follows the film at once");
  each("mass", &Pad::mass, "kg", not_negative, "of a pad: its motion along an elastic pivot");
  const bool elastic = each(optional("pivot_stiffness", "rigid pivots"), &Pad::pivot_stiffness,
                            "N/m", positive, "of a pivot, radial");
  const bool contact = v.table(
      optional("pivot_contact", "pivots as pivot_stiffness says"),
      [&](Visitor& w) { describe_contact(w, b.like.contact); },
      "elastic pivots that stiffen with their load, instead of pivot_stiffness");
  each("pivot_damping", &Pad::pivot_damping, "N.s/m", not_negative, "of an elastic pivot");
  each("tilt_stiffness", &Pad::tilt_stiffness, "N.m/rad", not_negative,
       "of a pivot against tilting: a flexure");
  v.list(optional("pad", "equal pads"),
         {[&](Visitor& w) {
            b.own.push_back(each.pad(b.own.size()));
            describe(w, b.own.back());
          },
          [&](Visitor& w) {
            Pad p = b.like;
            describe(w, p);
          }},
         "a pad by itself, instead of equal ones; what it leaves out is that of the bearing");
  v.quantities(beside_motion("frequency_ratios"), b.frequency_ratios, "", not_negative, -1,
               "frequencies over the speed at which reduced coefficients are written beside the "
               "synchronous ones");
  film_grid(v, b, "0");
  if (!v.clean()) return;
  if ((count || first) && !b.own.empty())
    v.error("E26", count ? "pads" : "first_pivot", "equal pads and pads by themselves are given",
            "keep one of the two");
  else if (elastic && contact)
    v.error("E26", "pivot_stiffness", "the pivots have a stiffness and a contact",
            "keep one of the two");
  else
    settle_pads(v, b, each);
}

void describe(Visitor& v, model::SqueezeFilm& b) {
  dimensions(v, b);
  oil(v, b.oil);
  using Film = model::SqueezeFilm::Film;
  const Alternative films[] = {
      {"cavitated", "open ends, short, cavitated at ambient pressure (pi film)",
       [&](Visitor&) { b.film = Film::cavitated; }},
      {"full", "open ends, short, fed at a pressure that keeps it from cavitating (2 pi film)",
       [&](Visitor&) { b.film = Film::full; }},
      {"finite", "open ends, any length, cavitated", [&](Visitor&) { b.film = Film::finite; }},
      {"sealed", "sealed ends, fed by an axial groove",
       [&](Visitor& w) {
         b.film = Film::sealed;
         b.groove = 10 * pi / 180;
         w.quantity("groove", b.groove, "deg", Range{0, pi, true, true},
                    "width of the feeding groove");
         w.quantity("groove_at", b.groove_at, "deg", any, "its angle, from y towards z");
       }},
  };
  v.alternatives(required("film"), films, "boundary conditions of the film");
  v.quantity("stiffness", b.stiffness, "N/m", not_negative,
             "centring spring, the same along y and z; 0: none");
  v.quantity("damping", b.damping, "N.s/m", not_negative, "damping of the centring spring");
  const bool is_short = b.film == Film::cavitated || b.film == Film::full;
  if (v.clean() && is_short && b.length > 0.5 * b.diameter)
    v.warning("W03", "length",
              "the theory of short films is for lengths below about half the diameter",
              "film = \"finite\" has no such limit");
}

void describe(Visitor& v, model::AnnularSeal& b) {
  dimensions(v, b);
  v.quantity(required("pressure_drop"), b.pressure_drop, "bar", positive, "over the seal");
  v.quantity(required("density"), b.density, "kg/m^3", positive, "density of the liquid");
  v.quantity(required("viscosity"), b.viscosity, "mPa.s", positive,
             "dynamic viscosity of the liquid");
  v.number("inlet_loss", b.inlet_loss, not_negative, "inlet loss coefficient xi");
  v.number("inlet_swirl", b.inlet_swirl, between(-2, 2),
           "circumferential inlet velocity over surface speed; 0.5: fully developed");
  if (v.clean() && b.length > 0.75 * b.diameter)
    v.warning("W03", "length",
              "the short-seal theory of Black and Childs is for lengths below about three quarters "
              "of the diameter",
              "type = \"table\" takes coefficients from a bulk-flow solution");
}

void describe(Visitor& v, model::CrossCoupling& b) {
  using From = model::CrossCoupling::From;
  const bool given = v.quantity(optional("k", "from alford or wachel"), b.k, "N/m", any,
                                "cross-coupled stiffness: force k times the displacement, a "
                                "quarter turn ahead in the sense y -> z");
  const bool alford = v.table(
      optional("alford", "none"),
      [&](Visitor& w) {
        w.number("beta", b.alford.beta, positive, "efficiency factor");
        w.quantity(required("torque"), b.alford.torque, "N.m", any,
                   "torque of the stage; its sign is the sense of the driven whirl");
        w.quantity(required("diameter"), b.alford.diameter, "mm", positive, "mean blade diameter");
        w.quantity(required("blade_height"), b.alford.blade_height, "mm", positive, "blade height");
      },
      "Alford: k = beta torque/(diameter blade_height)");
  const bool wachel = v.table(
      optional("wachel", "none"),
      [&](Visitor& w) {
        w.quantity(required("power"), b.wachel.power, "kW", not_negative, "power of the stage");
        w.quantity(required("speed"), b.wachel.speed, "rpm", any,
                   "speed at which it has that power; its sign is the sense of the driven whirl");
        w.quantity(required("diameter"), b.wachel.diameter, "mm", positive, "impeller diameter");
        w.quantity(required("width"), b.wachel.width, "mm", positive, "smallest flow width");
        w.quantity("molar_mass", b.wachel.molar_mass, "kg", positive,
                   "molar mass of the gas: mass of one mole");
        w.number("density_ratio", b.wachel.density_ratio, positive,
                 "density at discharge over density at suction");
        if (w.clean() && b.wachel.speed == 0) w.error("E14", "speed", "the speed must not be zero");
      },
      "Wachel (API 617), for impellers");
  if (alford) b.from = From::alford;
  if (wachel) b.from = From::wachel;
  if (v.clean() && given + alford + wachel != 1)
    v.error(given + alford + wachel == 0 ? "E05" : "E26", nullptr,
            given + alford + wachel == 0 ? "the cross coupling is not given"
                                         : "the cross coupling is given more than once",
            "give one of k, alford and wachel");
}

void add_kinds(Kinds& k, As<model::ShortJournal>) {
  k.add<model::ShortJournal>(
      "short_journal",
      "plain journal bearing, short-bearing theory, cavitated half film; nonlinear in "
      "displacement and velocity");
}

void add_kinds(Kinds& k, As<model::FiniteJournal>) {
  k.add<model::FiniteJournal>(
      "journal",
      "journal bearing of finite length with cavitation: plain, with axial grooves, "
      "multi-lobe; nonlinear");
}

void add_kinds(Kinds& k, As<model::TiltingPadJournal>) {
  k.add<model::TiltingPadJournal>("tilting_pad",
                                  "journal bearing of pads that tilt about rigid or elastic "
                                  "pivots; their tilts are unknowns of "
                                  "every analysis; nonlinear");
}

void add_kinds(Kinds& k, As<model::SqueezeFilm>) {
  k.add<model::SqueezeFilm>("squeeze_film",
                            "squeeze-film damper, with a centring spring or without");
}

void add_kinds(Kinds& k, As<model::AnnularSeal>) {
  k.add<model::AnnularSeal>(
      "annular_seal",
      "liquid annular seal, coefficients after Black and Childs that follow the speed");
}

void add_kinds(Kinds& k, As<model::CrossCoupling>) {
  k.add<model::CrossCoupling>("cross_coupling",
                              "destabilising force of a stage: given, Alford or Wachel");
}

}  // namespace whirl::deck
