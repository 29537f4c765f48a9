// Ball and roller bearings.
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

void fit(Visitor& v, int n, double D, double pitch, const char* key, const char* what) {
  if (!v.clean()) return;
  if (D >= pitch)
    v.error("E14", key, fmt::format("the {} are not smaller than the pitch circle", what));
  else if (n > 2 && D > pitch * std::sin(pi / n))
    v.error("E14", key,
            fmt::format("{} {} of {} do not fit on a pitch circle of {}", n, what,
                        units::display(D, "mm"), units::display(pitch, "mm")));
}

}  // namespace

void describe(Visitor& v, model::BallBearing& b) {
  v.integer(required("balls"), b.balls, between(2, 200), "number of balls");
  v.quantity(required("ball_diameter"), b.ball_diameter, "mm", positive, "ball diameter");
  v.quantity(required("pitch_diameter"), b.pitch_diameter, "mm", positive,
             "diameter of the circle of ball centres");
  v.quantity("contact_angle", b.contact_angle, "deg", Range{0, 80 * pi / 180, false, true},
             "free contact angle; 0: deep groove");
  v.quantity(
      "clearance", b.clearance, "um", any,
      "radial clearance of a deep-groove bearing, half the diametral play; negative: interference");
  v.number("f_inner", b.f_inner, Range{0.5, 1, true, false},
           "groove radius over ball diameter, inner ring");
  v.number("f_outer", b.f_outer, Range{0.5, 1, true, false}, "the same, outer ring");
  int direction = b.direction > 0 ? 0 : 1;
  static constexpr Option words[] = {{"+x", "carries a push of the shaft towards +x"},
                                     {"-x", "carries a push towards -x"}};
  v.option("direction", direction, words, "side of an angular-contact bearing");
  b.direction = direction == 0 ? 1 : -1;
  v.quantity(optional("stiffness", "Hertz, steel"), b.stiffness, "N/m^1.5", positive,
             "load of a ball over deflection to 3/2, both contacts");
  v.quantity("preload", b.preload, "N", not_negative,
             "axial force the undisplaced bearing pushes with");
  v.quantity("c_radial", b.c_radial, "N.s/m", not_negative, "damping of lateral motion");
  v.quantity("c_axial", b.c_axial, "N.s/m", not_negative, "damping of axial motion");
  fit(v, b.balls, b.ball_diameter, b.pitch_diameter, "ball_diameter", "balls");
  if (!v.clean()) return;
  if (b.contact_angle != 0 && b.clearance != 0)
    v.error("E26", "clearance", "a contact angle and a clearance are both given",
            "the contact angle of a deep-groove bearing follows from its clearance");
  if (b.contact_angle == 0 && b.preload != 0)
    v.error("E26", "preload", "a deep-groove bearing has no side to be preloaded on",
            "give a contact_angle, or a negative clearance");
  if (b.clearance >= (b.f_inner + b.f_outer - 1) * b.ball_diameter)
    v.error("E14", "clearance",
            fmt::format("the clearance {} is larger than the grooves allow: {}",
                        units::display(b.clearance, "um"),
                        units::display((b.f_inner + b.f_outer - 1) * b.ball_diameter, "um")));
}

void describe(Visitor& v, model::RollerBearing& b) {
  v.integer(required("rollers"), b.rollers, between(2, 200), "number of rollers");
  v.quantity(required("roller_diameter"), b.roller_diameter, "mm", positive, "roller diameter");
  v.quantity(required("roller_length"), b.roller_length, "mm", positive,
             "effective length of a roller");
  v.quantity(required("pitch_diameter"), b.pitch_diameter, "mm", positive,
             "diameter of the circle of roller centres");
  v.quantity("clearance", b.clearance, "um", any,
             "radial clearance, half the diametral play; negative: interference");
  v.quantity(optional("stiffness", "Palmgren, steel"), b.stiffness, "N/m^(10/9)", positive,
             "load of a roller over deflection to 10/9, both contacts");
  v.quantity("c_radial", b.c_radial, "N.s/m", not_negative, "damping of lateral motion");
  v.quantity("c_axial", b.c_axial, "N.s/m", not_negative, "damping of axial motion");
  fit(v, b.rollers, b.roller_diameter, b.pitch_diameter, "roller_diameter", "rollers");
}

namespace {

void describe_estimate(Visitor& v, model::RollingEstimate& b, bool roller) {
  b.roller = roller;
  const char* elements = b.roller ? "rollers" : "balls";
  v.integer(required(elements), b.elements, between(2, 200),
            b.roller ? "number of rollers" : "number of balls");
  v.quantity(required(b.roller ? "roller_length" : "ball_diameter"), b.size, "mm", positive,
             b.roller ? "effective length of a roller" : "ball diameter");
  v.quantity(required("load"), b.load, "N", positive,
             "static load of the bearing: the estimate holds about it");
  v.quantity("load_angle", b.load_angle, "deg", any, "line of the load, from +y towards +z");
  v.quantity("contact_angle", b.contact_angle, "deg", Range{0, 80 * pi / 180, false, true},
             "contact angle; 0: radial bearing");
  v.quantity("c_radial", b.c_radial, "N.s/m", not_negative, "damping of lateral motion");
  v.quantity("kxx", b.kxx, "N/m", not_negative, "axial stiffness (not estimated)");
  if (v.clean() && (b.elements < 8 || b.elements > 16))
    v.warning("W03", elements,
              fmt::format("the ratio of the stiffnesses across and along the load is known for 8 "
                          "to 16 elements, not for {}",
                          b.elements),
              fmt::format("taken for {}; type = \"{}\" follows the contacts one by one",
                          b.elements < 8 ? 8 : 16, b.roller ? "roller" : "ball"));
}

}  // namespace

void add_kinds(Kinds& k, As<model::BallBearing>) {
  k.add<model::BallBearing>("ball",
                            "deep-groove or angular-contact ball bearing: Hertz "
                            "contact, clearance or preload, varying compliance");
}

void add_kinds(Kinds& k, As<model::RollerBearing>) {
  k.add<model::RollerBearing>("roller", "cylindrical roller bearing");
}

void add_kinds(Kinds& k, As<model::RollingEstimate>) {
  k.add<model::RollingEstimate>(
      "ball_estimate",
      "ball bearing as a linear spring at its static load: estimated stiffness along and "
      "across the load (Friswell, Penny, Garvey & Lees 2010, doi "
      "10.1017/CBO9780511780509, 5.5.4)",
      [](Visitor& v, model::RollingEstimate& b) { describe_estimate(v, b, false); });
  k.add<model::RollingEstimate>(
      "roller_estimate", "cylindrical roller bearing, estimated in the same way",
      [](Visitor& v, model::RollingEstimate& b) { describe_estimate(v, b, true); });
}

}  // namespace whirl::deck
