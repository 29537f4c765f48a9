// Lubricating films, seals and the destabilising forces of flow.
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::deck {
namespace {

void oil(Visitor& v, model::Oil& o) {
  const bool viscosity = v.quantity(optional("viscosity", "from iso_vg"), o.viscosity, "mPa.s",
                                    positive, "dynamic viscosity");
  const bool grade =
      v.number(optional("iso_vg", "viscosity is given"), o.grade, Range{1, 5000, false, false},
               "ISO VG grade of the oil: its viscosity in mm2/s at 40 degC");
  const bool temperature =
      v.quantity(optional("temperature", "viscosity is given"), o.temperature, "degC", any,
                 "temperature of the film, -30 to 200 degC, with iso_vg");
  v.quantity("density", o.density, "kg/m^3", positive, "density of the oil, with iso_vg");
  if (!v.clean()) return;
  if (temperature && !(o.temperature >= 243.15 && o.temperature <= 473.15))
    v.error("E14", "temperature",
            fmt::format("{} is outside -30 to 200 degC, where the viscosity of oils is known",
                        units::display(o.temperature, "degC")),
            "the temperature of the film, in degC");
  else if (viscosity && grade)
    v.error("E26", "iso_vg", "the viscosity is given directly and by a grade",
            "keep one of the two");
  else if (!viscosity && !grade)
    v.error("E05", nullptr, "the oil has no viscosity",
            "viscosity = \"20 mPa.s\", or iso_vg = 46 and temperature = \"50 degC\"");
  else if (grade && !temperature)
    v.error("E05", "iso_vg", "a grade needs 'temperature'", "temperature = \"50 degC\"");
}

template <class Film>
void dimensions(Visitor& v, Film& b,
                const char* clearance = "radial clearance (half the difference of diameters)") {
  v.quantity(required("diameter"), b.diameter, "mm", positive, "journal diameter");
  v.quantity(required("length"), b.length, "mm", positive, "axial length of the film");
  v.quantity(required("clearance"), b.clearance, "um", positive, clearance);
  if (v.clean() && b.clearance > 0.02 * b.diameter)
    v.error("E14", "clearance",
            fmt::format("the clearance {} is not small against the diameter {}: no film",
                        units::display(b.clearance, "um"), units::display(b.diameter, "mm")),
            "the radial clearance is usually about a thousandth of the radius");
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

void describe(Visitor& v, model::FiniteJournal& b) {
  using Shape = model::FiniteJournal::Shape;
  dimensions(v, b);
  oil(v, b.oil);
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
  };
  v.alternatives(required("shape"), shapes, "shape of the bearing surface");
  v.integer("grid", b.nodes, between(24, 360), "points round the circumference");
}

void describe(Visitor& v, model::TiltingPadJournal::Pad& p) {
  v.quantity(required("pivot"), p.pivot, "deg", any, "angle of the pivot, from y towards z");
  v.quantity("arc", p.arc, "deg", Range{0, two_pi, true, true}, "of the pad");
  v.number("offset", p.offset, fraction, "of the pivot from the start of the pad, in arcs");
  v.number("preload", p.preload, Range{0, 1, false, true},
           "1 - (assembled clearance)/(clearance of the pad)");
}

namespace {

/// Pads that reach into each other.
void check_pads(Visitor& v, const model::TiltingPadJournal& b) {
  struct Stretch {
    double from, to;
    std::size_t number;
  };
  std::vector<Stretch> all;
  for (const auto& p : b.pads()) {
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
    v.error("E14", b.own.empty() ? "arc" : "pad",
            fmt::format("pads {} and {} overlap by {}", all[k].number, next.number,
                        units::display(all[k].to - begins, "deg")),
            "smaller arcs, or fewer pads");
    return;
  }
}

}  // namespace

void describe(Visitor& v, model::TiltingPadJournal& b) {
  dimensions(v, b, "radial clearance as assembled: of a centred journal at the pivots");
  oil(v, b.oil);
  const bool count = v.integer(optional("pads", "5, or those listed"), b.count, between(1, 24),
                               "number of equal pads");
  const bool first = v.quantity(optional("first_pivot", "-90 deg"), b.first, "deg", any,
                                "angle of the first pivot of equal pads, from y towards z: where "
                                "the load points it is on a pad");
  v.quantity("arc", b.like.arc, "deg", Range{0, two_pi, true, true}, "of a pad");
  v.number("offset", b.like.offset, fraction,
           "of the pivot from the start of its pad in arcs; 0.5: central, more: towards the end in "
           "the sense of rotation y -> z");
  v.number("preload", b.like.preload, Range{0, 1, false, true},
           "1 - (assembled clearance)/(clearance of the pads)");
  v.list(optional("pad", "equal pads"), Visitor::body_of(b.own, b.like),
         "a pad by itself, instead of equal ones; what it leaves out is that of the bearing");
  v.quantity("thickness", b.thickness, "mm", not_negative,
             "of a pad at its pivot: the pivot is that far behind the film");
  v.quantity("inertia", b.inertia, "kg.m^2", not_negative,
             "moment of inertia of a pad about its pivot; 0: it follows the film at once");
  v.quantity("mass", b.mass, "kg", not_negative, "of a pad: its motion along an elastic pivot");
  const bool elastic = v.quantity(optional("pivot_stiffness", "rigid pivots"), b.pivot_stiffness,
                                  "N/m", positive, "of a pivot, radial");
  v.quantity("pivot_damping", b.pivot_damping, "N.s/m", not_negative, "of an elastic pivot");
  v.quantity("tilt_stiffness", b.tilt_stiffness, "N.m/rad", not_negative,
             "of a pivot against tilting: a flexure");
  v.quantities(beside_motion("frequency_ratios"), b.frequency_ratios, "", not_negative, -1,
               "frequencies over the speed at which reduced coefficients are written beside the "
               "synchronous ones");
  v.integer("grid", b.nodes, between(24, 360), "points round the circumference");
  if (!v.clean()) return;
  if ((count || first) && !b.own.empty())
    v.error("E26", count ? "pads" : "first_pivot", "equal pads and pads by themselves are given",
            "keep one of the two");
  else if (!elastic && (b.mass != 0 || b.pivot_damping != 0))
    v.error("E05", b.mass != 0 ? "mass" : "pivot_damping", "a rigid pivot does not move",
            "give pivot_stiffness, or leave it out");
  else
    check_pads(v, b);
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
