// Bearings with a floating ring: two films, the ring, its supply and its heat.
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

void describe_film(Visitor& v, model::FloatingRing::Film& f, const char* diameter) {
  v.quantity(required("diameter"), f.diameter, "mm", positive, diameter);
  v.quantity(required("length"), f.length, "mm", positive, "axial length of the film");
  v.quantity(required("clearance"), f.clearance, "um", positive,
             "radial clearance (half the difference of diameters)");
  const bool viscosity = v.quantity(optional("viscosity", "from iso_vg"), f.viscosity, "mPa.s",
                                    positive, "dynamic viscosity in this film");
  const bool temperature =
      v.quantity(optional("temperature", "viscosity or heat is given"), f.temperature, "degC", any,
                 "of this film, -30 to 200 degC, with iso_vg");
  if (!v.clean()) return;
  if (viscosity && temperature)
    v.error("E26", "temperature", "the film has a viscosity and a temperature",
            "keep one of the two");
  else if (temperature)
    check_oil_temperature(v, "temperature", f.temperature);
  if (v.clean() && f.clearance > 0.02 * f.diameter)
    v.error("E14", "clearance",
            fmt::format("the clearance {} is not small against the diameter {}: no film",
                        units::display(f.clearance, "um"), units::display(f.diameter, "mm")),
            "the radial clearance is usually some thousandths of the radius");
}

/// The ring between both films.
void check_ring(Visitor& v, const model::FloatingRing& b) {
  if (!v.clean()) return;
  if (!(b.thickness() > 0)) {
    v.error("E14", "outer",
            fmt::format("the ring is {} thick: its bore is {} wide, its outer diameter {}",
                        units::display(b.thickness(), "mm"), units::display(2.0 * b.bore(), "mm"),
                        units::display(b.outer.diameter, "mm")),
            "the outer diameter of the ring less that of the journal is twice its thickness and "
            "the inner clearance");
    return;
  }
  for (const auto& [film, key] : {std::pair{&b.inner, "inner"}, std::pair{&b.outer, "outer"}})
    if (!(b.carrying_length(*film) > 0)) {
      v.error("E14", "holes",
              fmt::format("the holes leave nothing of the {} film, {} long and {} in diameter", key,
                          units::display(film->length, "mm"), units::display(film->diameter, "mm")),
              "fewer or smaller holes");
      return;
    }
  if (!b.pinned && (b.stiffness > 0 || b.damping > 0))
    v.error("E05", b.stiffness > 0 ? "stiffness" : "damping",
            "a ring that turns has no centring spring", "pinned = true, or leave it out");
}

void check_oil(Visitor& v, const model::FloatingRing& b) {
  if (!v.clean()) return;
  const auto given = [](const model::FloatingRing::Film& f) {
    return f.viscosity > 0 || f.temperature > 0;
  };
  for (const auto& [film, key] : {std::pair{&b.inner, "inner"}, std::pair{&b.outer, "outer"}}) {
    if (b.heat && given(*film)) {
      v.error("E26", key,
              fmt::format(
                  "the {} film has a viscosity or temperature, which the heat balance finds", key),
              "keep one of the two");
      return;
    }
    if (!b.heat && !given(*film)) {
      v.error(
          "E05", key, fmt::format("the oil of the {} film has no viscosity", key),
          "viscosity = \"6 mPa.s\", or temperature = \"110 degC\" with iso_vg of the bearing, or "
          "a heat table");
      return;
    }
    if (b.grade == 0 && (b.heat || film->temperature > 0)) {
      v.error("E05", key, "a film with a temperature needs the grade of its oil",
              "iso_vg = 32 beside 'inner' and 'outer'");
      return;
    }
  }
}

void check_heat(Visitor& v, const model::FloatingRing& b) {
  if (!v.clean()) return;
  if (!b.heat) {
    if (b.supply_temperature != 0)
      v.error("E05", "supply_temperature", "nothing asks for the temperature of the supply",
              "a heat table finds the temperatures of the films");
    return;
  }
  if (b.supply_pressure == 0 || b.supply_temperature == 0) {
    v.error("E05", "heat", "the heat balance needs the supply of the films",
            "supply_pressure = \"3 bar\" and supply_temperature = \"90 degC\"");
    return;
  }
  if (!check_oil_temperature(v, "supply_temperature", b.supply_temperature)) return;
  for (const auto& [c, key] : {std::pair{b.inner_clearance_at(b.supply_temperature), "inner"},
                               std::pair{b.outer_clearance_at(b.supply_temperature), "outer"}})
    if (!(c > 0)) {
      v.error("E14", "heat",
              fmt::format("the {} clearance is {} at the temperature of the supply, {}", key,
                          units::display(c, "um"), units::display(b.supply_temperature, "degC")),
              "the parts grow by their coefficients of expansion from 'reference' on");
      return;
    }
}

}  // namespace

void describe(Visitor& v, model::FloatingRing::Holes& h) {
  v.integer(required("number"), h.number, between(1, 100), "of radial holes through the ring");
  v.quantity(required("diameter"), h.diameter, "mm", positive, "of a hole");
}

void describe(Visitor& v, model::FloatingRing::Heat& h) {
  v.quantity("specific_heat", h.specific_heat, "J/(kg.K)", positive, "of the oil");
  v.number("share", h.share, Range{0, 1, true, false},
           "of the heat of the films that oil and ring take; the rest leaves through shaft and "
           "housing");
  v.quantity("ring_specific_heat", h.ring_specific_heat, "J/(kg.K)", positive, "of the ring");
  v.quantity("conductance", h.conductance, "W/K", not_negative,
             "heat that passes the ring for each degree between the films");
  v.quantity("reference", h.reference, "degC", any,
             "temperature at which the clearances are given");
  v.quantity("shaft_expansion", h.shaft, "1/K", not_negative,
             "coefficient of thermal expansion of the journal, which has the temperature of the "
             "inner film");
  v.quantity("ring_expansion", h.ring, "1/K", not_negative,
             "that of the ring, at the mean temperature of both films");
  v.quantity("housing_expansion", h.housing, "1/K", not_negative,
             "that of the housing, at the temperature of the outer film");
}

void describe(Visitor& v, model::FloatingRing& b) {
  v.table(
      required("inner"), [&](Visitor& w) { describe_film(w, b.inner, "diameter of the journal"); },
      "film between journal and ring");
  v.table(
      required("outer"),
      [&](Visitor& w) { describe_film(w, b.outer, "outer diameter of the ring"); },
      "film between ring and housing");
  v.choice("film", b.theory,
           {{"finite", "finite length with cavitation, as type = \"journal\""},
            {"short", "short-bearing theory, as type = \"short_journal\": quicker"}},
           "theory of both films");
  v.number(optional("iso_vg", "viscosities are given"), b.grade, Range{1, 5000, false, false},
           "ISO VG grade of the oil: its viscosity in mm2/s at 40 degC");
  v.quantity("density", b.density, "kg/m^3", positive, "density of the oil");
  v.quantity("ring_density", b.ring_density, "kg/m^3", positive, "density of the ring");
  v.quantity(optional("mass", "that of an annulus"), b.mass, "kg", positive, "of the ring");
  v.quantity(optional("inertia", "that of an annulus"), b.inertia, "kg.m^2", positive,
             "of the ring about its axis");
  v.flag("pinned", b.pinned, "semi-floating: the ring does not turn");
  v.quantity("stiffness", b.stiffness, "N/m", not_negative,
             "centring spring of a pinned ring, the same in y and z; 0: none");
  v.quantity("damping", b.damping, "N.s/m", not_negative, "damping of the centring spring");
  v.table(optional("holes", "none"), b.holes,
          "holes that feed the inner film; they take their area from both films");
  v.quantity(
      optional("supply_pressure", "not known"), b.supply_pressure, "bar", positive,
      "of the oil above ambient, where it enters the outer film: flows, and the spin at which "
      "the ring keeps it from the inner film");
  v.quantity(optional("supply_temperature", "none"), b.supply_temperature, "degC", any,
             "of the oil, with heat");
  v.table(optional("heat", "temperatures or viscosities are given"), b.heat,
          "balance of heat: both films have temperatures of their own, unknowns of every analysis, "
          "from drag, flow and supply");
  v.quantities(beside_motion("frequency_ratios"), b.frequency_ratios, "", not_negative, -1,
               "frequencies over the speed at which reduced coefficients are written beside the "
               "synchronous ones");
  v.integer("grid", b.nodes, between(24, 360), "points round the circumference of finite films");
  check_ring(v, b);
  check_oil(v, b);
  check_heat(v, b);
  if (v.clean() && b.theory == model::FloatingRing::Theory::brief &&
      (b.inner.length > b.inner.diameter || b.outer.length > b.outer.diameter))
    v.warning("W03", b.inner.length > b.inner.diameter ? "inner" : "outer",
              "the short-bearing theory is for lengths below about half the diameter",
              "film = \"finite\" has no such limit");
}

void add_kinds(Kinds& k, As<model::FloatingRing>) {
  k.add<model::FloatingRing>(
      "floating_ring",
      "journal bearing with a ring between two films, full-floating or pinned: its motion, its "
      "spin "
      "and, with heat, the temperatures of the films are unknowns of every analysis; nonlinear");
}

}  // namespace whirl::deck
