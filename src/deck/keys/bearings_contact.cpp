// Nonlinear springs, stops and rub.
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

struct Units {
  const char *force, *deflection, *stiffness, *damping, *damping2, *per;
};
constexpr Units straight{"N", "mm", "N/m", "N.s/m", "N.s/m^3", "m"},
    angular_units{"N.m", "deg", "N.m/rad", "N.m.s/rad", "N.m.s/rad^3", "rad"};

struct CurvePoint {
  double q = 0, F = 0;
};

void curve_points(Visitor& v, model::ForceLaw& f, const Units& u) {
  int i = f.monotone_cubic ? 0 : 1;
  static constexpr Option words[] = {{"pchip", "monotone cubic"}, {"linear", "straight lines"}};
  v.option("interpolation", i, words,
           "between the rows; outside straight on with the slope at the end");
  f.monotone_cubic = i == 0;
  const auto point = [&u](Visitor& w, CurvePoint& p) {
    w.quantity(required("deflection"), p.q, u.deflection, any,
               "deflection of the shaft against the other side");
    w.quantity(required("force"), p.F, u.force, any, "restoring force, or moment, there");
  };
  v.rows({[&](Visitor& w) {
            CurvePoint p;
            point(w, p);
            if (w.clean() && !f.q.empty() && !(p.q > f.q.back()))
              w.error("E21", "deflection",
                      fmt::format("the deflections do not increase: {} after {}",
                                  units::display(p.q, u.deflection),
                                  units::display(f.q.back(), u.deflection)));
            f.q.push_back(p.q);
            f.F.push_back(p.F);
          },
          [&](Visitor& w) {
            CurvePoint p;
            point(w, p);
          }},
         true, "force against deflection, at least two rows");
  if (v.clean() && f.q.size() < 2) v.error("E20", nullptr, "a force table needs at least two rows");
}

void behind_gap(Visitor& v, model::ForceLaw& f, const Units& u) {
  v.quantity(required("stiffness"), f.stiffness, u.stiffness, positive,
             "stiffness once the gap is closed");
  v.quantity("smooth", f.smooth, u.deflection, not_negative,
             "length over which the stiffness sets in, a parabola; 0: a corner");
}

void shape(Visitor& v, model::ForceLaw& f, const Units& u) {
  using Shape = model::ForceLaw::Shape;
  const Alternative kinds[] = {
      {"polynomial", "a polynomial of the deflection",
       [&](Visitor& w) {
         f.shape = Shape::polynomial;
         w.quantities(
             required("coefficients"), f.coefficients, u.force, any, -1,
             "c0, c1, c2, ... of c0 + c1 q + c2 q^2 + ..., each with its unit, degree 7 at most",
             u.per);
         if (w.clean() && (f.coefficients.empty() || f.coefficients.size() > 8))
           w.error("E20", "coefficients", "1 to 8 coefficients are needed");
       }},
      {"table", "points joined by a monotone cubic or straight lines",
       [&](Visitor& w) {
         f.shape = Shape::table;
         curve_points(w, f, u);
       }},
      {"clearance", "play, then a stiffness on either side",
       [&](Visitor& w) {
         f.shape = Shape::clearance;
         w.quantity(required("gap"), f.gap_plus, u.deflection, not_negative,
                    "play on the positive side");
         const bool both = w.quantity(optional("gap_minus", "gap"), f.gap_minus, u.deflection,
                                      not_negative, "play on the negative side");
         if (!both) f.gap_minus = f.gap_plus;
         behind_gap(w, f, u);
       }},
      {"one_sided", "acts only beyond the gap, on the positive side",
       [&](Visitor& w) {
         f.shape = Shape::one_sided;
         w.quantity(required("gap"), f.gap_plus, u.deflection, any,
                    "deflection at which it begins to act; negative: pressed on at rest");
         behind_gap(w, f, u);
       }},
  };
  v.alternatives(required("shape"), kinds, "force against deflection");
}

void describe_spring(Visitor& v, model::NonlinearSpring& b, bool angular) {
  using Along = model::NonlinearSpring::Along;
  static constexpr Option straight_words[] = {
      {"y", "lateral"},
      {"z", "lateral"},
      {"radial", "central: along the displacement, whatever its direction in (y, z)"},
      {"x", "axial"}};
  static constexpr Option angular_words[] = {
      {"ry", "tilt about y"}, {"rz", "tilt about z"}, {"rx", "twist, whole turns counted"}};
  int i = 0;
  v.option(
      required("direction"), i,
      angular ? std::span<const Option>(angular_words) : std::span<const Option>(straight_words),
      "direction of the deflection");
  b.along = static_cast<Along>(i + (angular ? static_cast<int>(Along::ry) : 0));
  const Units& u = angular ? angular_units : straight;
  shape(v, b.force, u);
  v.quantity("damping", b.damping, u.damping, not_negative, "viscous damping");
  v.quantity("damping2", b.damping2, u.damping2, not_negative,
             "damping that grows with the square of the deflection: damping + damping2 q^2");
  if (!v.clean() || b.along != Along::radial) return;
  const bool at_centre =
      (b.force.shape == model::ForceLaw::Shape::polynomial && b.force.coefficients[0] != 0) ||
      (b.force.shape == model::ForceLaw::Shape::one_sided && b.force.gap_plus < 0);
  if (at_centre)
    v.error("E26", "direction",
            "a radial spring has no force at the centre, where it would have no direction",
            "c0 = \"0 N\", gap >= 0");
  if (b.force.shape == model::ForceLaw::Shape::table &&
      (b.force.q.front() != 0 || b.force.F.front() != 0))
    v.error("E26", nullptr, "the table of a radial spring starts at deflection 0 with force 0",
            "the deflection is the distance from the centre");
}

}  // namespace

void describe(Visitor& v, model::Rub& b) {
  v.quantity(required("gap"), b.gap, "um", not_negative,
             "radial clearance between shaft and stator");
  v.quantity(required("stiffness"), b.stiffness, "N/m", positive, "contact stiffness");
  v.quantity("damping", b.damping, "s/m", not_negative,
             "contact damping beta: normal force k delta (1 + beta delta'), never pulling");
  v.number("friction", b.friction, Range{0, 10, false, false},
           "Coulomb coefficient; friction opposes the slip of the surfaces");
  v.quantity(optional("diameter", "that of the shaft there"), b.diameter, "mm", positive,
             "of the rubbing surface: its circumferential speed decides about slip");
  v.quantity("slip_speed", b.slip_speed, "m/s", positive,
             "slip speed within which friction is viscous: mu tanh(v/slip_speed)");
}

void add_kinds(Kinds& k, As<model::NonlinearSpring>) {
  k.add<model::NonlinearSpring>(
      "nonlinear_spring",
      "spring and damper along one direction: polynomial, table, clearance, one-sided",
      [](Visitor& v, model::NonlinearSpring& b) { describe_spring(v, b, false); });
  k.add<model::NonlinearSpring>(
      "nonlinear_angular_spring", "the same for a tilt or the twist",
      [](Visitor& v, model::NonlinearSpring& b) { describe_spring(v, b, true); });
}

void add_kinds(Kinds& k, As<model::Rub>) {
  k.add<model::Rub>("rub",
                    "rub, stop or catcher bearing: one-sided contact with "
                    "friction; with 'support' the stator has mass and springs");
}

}  // namespace whirl::deck
