// [[bearing]]: whatever connects a shaft with the ground or another shaft.
//
// To add a kind:
//   1. its parameters as a plain struct in SI in model.hpp, and the struct in the variant BearingLaw;
//   2. a function `void describe(Visitor&, model::NewBearing&)` here or in the file of its family, declared in
//      bearing_kinds.hpp: one line per key with unit, range and explanation, then the checks between keys;
//   3. one line in the list in describe(Visitor&, model::Bearing&).
// Reading, error messages, the JSON schema, the reference documentation and the resolved deck follow from these.
//
//   void describe(Visitor& v, model::SqueezeFilm& b) {
//     v.quantity(required("diameter"), b.diameter, "mm", positive, "journal diameter");
//     v.quantity(required("clearance"), b.clearance, "um", positive, "radial clearance");
//     if (v.clean() && b.clearance > 0.1 * b.diameter) v.error("E14", "clearance", "the clearance is not small against the diameter");
//   }
#include <core/units.hpp>
#include <deck/bearing_kinds.hpp>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

constexpr const char* place = "place on a shaft: \"section:mid\", \"section:end - 20 mm\", \"1.14 m\"";
std::string hertz(double w) { return fmt::format("{:.6g} Hz", w / two_pi); }
constexpr const char* axis_names[3] = {"x", "y", "z"};

}  // namespace

/// The nine translational entries of a 6x6 matrix: prefix "k" -> kxx, kxy, ... in rows (force) and columns (displacement).
void describe_translation(Visitor& v, Matrix<6>& m, char prefix, const char* unit, const char* what) {
  static const auto keys = [] {
    std::array<std::array<std::string, 9>, 3> r;
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t i = 0; i < 9; ++i) r[p][i] = std::string(1, "kcm"[p]) + axis_names[i / 3] + axis_names[i % 3];
    return r;
  }();
  const std::size_t p = prefix == 'k' ? 0 : prefix == 'c' ? 1 : 2;
  for (std::size_t i : {0u, 4u, 8u, 5u, 7u, 1u, 2u, 3u, 6u}) {
    const auto row = static_cast<Index>(i / 3), column = static_cast<Index>(i % 3);
    if (p == 2 && row != column) continue;   // cross-coupled mass only in the full matrix
    const std::string doc = fmt::format("{}: force along {} from motion along {}", what, axis_names[row], axis_names[column]);
    v.quantity(optional(keys[p][i].c_str(), "0"), m(row, column), unit, any, doc.c_str());
  }
}

void describe_rotation(Visitor& v, Matrix<6>& m, bool damping, const char* unit) {
  double both = 0;
  const bool all = v.quantity(damping ? optional("crr", "0") : optional("krr", "0"), both, unit, any, "tilting, the same about y and z");
  const bool y = v.quantity(damping ? optional("cryy", "crr") : optional("kryy", "krr"), m(4, 4), unit, any, "tilting about y");
  const bool z = v.quantity(damping ? optional("crzz", "crr") : optional("krzz", "krr"), m(5, 5), unit, any, "tilting about z");
  v.quantity(damping ? optional("cryz", "0") : optional("kryz", "0"), m(4, 5), unit, any, "tilting: moment about y from rotation about z");
  v.quantity(damping ? optional("crzy", "0") : optional("krzy", "0"), m(5, 4), unit, any, "tilting: moment about z from rotation about y");
  v.quantity(damping ? optional("crxx", "0") : optional("krxx", "0"), m(3, 3), unit, any, "torsional, about x");
  if (all && !y) m(4, 4) = both;
  if (all && !z) m(5, 5) = both;
}

void describe(Visitor& v, model::SpringBlock& b) {
  v.quantity(required("C1"), b.C1, "N/m", not_negative, "stiffness against displacement, the same in all directions: force -C1 r");
  v.quantity(required("C2"), b.C2, "N.m/rad", not_negative, "stiffness against tilt: moment -C2 gamma, gamma the Euler vector of the tilt");
}

void describe(Visitor& v, model::LinearBearing& b) {
  describe_translation(v, b.K, 'k', "N/m", "stiffness");
  describe_rotation(v, b.K, false, "N.m/rad");
  describe_translation(v, b.C, 'c', "N.s/m", "damping");
  describe_rotation(v, b.C, true, "N.m.s/rad");
  describe_translation(v, b.M, 'm', "kg", "mass");
  const bool K = v.matrix(optional("K", "the entries"), b.K, "N/m", "N/rad", "N.m/rad", "full stiffness in the order x, y, z, rx, ry, rz, instead of the entries");
  const bool C = v.matrix(optional("C", "the entries"), b.C, "N.s/m", "N.s/rad", "N.m.s/rad", "full damping");
  const bool M = v.matrix(optional("M", "the entries"), b.M, "kg", "kg.m", "kg.m^2", "full mass");
  std::vector<double> position{0, 0, 0}, tilt{0, 0, 0}, force{0, 0, 0}, moment{0, 0, 0};
  v.quantities("setpoint", position, "mm", any, 3, "displacement at which the springs are free");
  v.quantities("setpoint_tilt", tilt, "deg", any, 3, "rotation at which the springs are free");
  v.quantities("preload", force, "N", any, 3, "constant force on the shaft");
  v.quantities("preload_moment", moment, "N.m", any, 3, "constant moment on the shaft");
  for (Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    b.setpoint[i] = position[k];
    b.setpoint[i + 3] = tilt[k];
    b.preload[i] = force[k];
    b.preload[i + 3] = moment[k];
  }
  if (!v.clean()) return;
  for (const auto& [matrix, letter] : {std::pair(K, 'k'), std::pair(C, 'c'), std::pair(M, 'm')}) {
    if (!matrix) continue;
    for (const char* rest : {"xx", "yy", "zz", "xy", "xz", "yx", "yz", "zx", "zy", "rr", "ryy", "rzz", "ryz", "rzy", "rxx"}) {
      const std::string key = letter + std::string(rest);
      if (!v.given(key.c_str())) continue;
      v.error("E26", key.c_str(), fmt::format("'{}' and the full matrix '{}' are both given", key, static_cast<char>(letter - 'a' + 'A')), "keep one of the two");
      return;
    }
  }
  if (b.K.isZero(0) && b.C.isZero(0) && b.M.isZero(0) && b.preload.isZero(0))
    v.error("E05", nullptr, "the bearing has no stiffness, damping, mass or preload", "give kyy = \"1e8 N/m\", kzz, kxx, cyy, ...");
}

namespace {

struct TableRow {
  double speed = 0, frequency = nan;
  std::array<double, 4> K{}, C{}, M{};
};

void describe(Visitor& v, TableRow& r) {
  static constexpr const char* keys[3][4] = {{"kyy", "kyz", "kzy", "kzz"}, {"cyy", "cyz", "czy", "czz"}, {"myy", "myz", "mzy", "mzz"}};
  static constexpr const char* what[3] = {"stiffness", "damping", "mass"};
  static constexpr const char* unit[3] = {"N/m", "N.s/m", "kg"};
  v.quantity(required("speed"), r.speed, "rpm", any, "speed of the shaft");
  v.quantity(Key("frequency"), r.frequency, "rad/s", not_negative,
             "frequency of the motion (Hz, rpm or rad/s): the rows are then a grid, speed by speed, with the same frequencies for every speed");
  std::array<double, 4>* values[3] = {&r.K, &r.C, &r.M};
  for (std::size_t p = 0; p < 3; ++p)
    for (std::size_t i = 0; i < 4; ++i) {
      const bool must = p == 0 && (i == 0 || i == 3);
      v.quantity(must ? required(keys[p][i]) : Key(keys[p][i]), (*values[p])[i], unit[p], any, what[p]);
    }
}

}  // namespace

void describe(Visitor& v, model::TableBearing& b) {
  static constexpr Option interpolations[] = {{"pchip", "monotone cubic"}, {"linear", "straight lines"}};
  static constexpr Option ends[] = {{"error", "a speed or frequency outside the table is a mistake"}, {"hold", "the coefficients at the edge hold outside"}};
  int interpolation = 0, outside = 0;
  v.option("interpolation", interpolation, interpolations, "between the rows");
  v.option("extrapolate", outside, ends, "outside the table");
  b.monotone_cubic = interpolation == 0;
  b.extrapolate_hold = outside == 1;
  bool mass = false;
  int rows = 0;
  std::size_t column = 0;   // place of the next row in its speed's frequencies
  const auto add = [&](Visitor& w) {
    TableRow r;
    describe(w, r);
    if (!w.clean()) return;
    const bool by_frequency = !std::isnan(r.frequency);
    if (rows++ > 0 && by_frequency != !b.frequency.empty()) {
      w.error("E05", "frequency", "rows with and without a frequency");
      return;
    }
    const bool same_speed = by_frequency && !b.speed.empty() && r.speed == b.speed.back();
    if (!same_speed) {
      if (!b.speed.empty() && !(r.speed > b.speed.back()))
        w.error("E21", "speed", fmt::format("the speeds do not increase: {} after {}", units::display(r.speed, "rpm"), units::display(b.speed.back(), "rpm")));
      if (column < b.frequency.size() && !b.speed.empty())
        w.error("E26", "frequency", fmt::format("{} has {} frequencies, the first speed has {}", units::display(b.speed.back(), "rpm"), column, b.frequency.size()), "every speed needs the same frequencies");
      b.speed.push_back(r.speed);
      column = 0;
    }
    if (by_frequency) {
      if (b.speed.size() == 1) {
        if (!b.frequency.empty() && !(r.frequency > b.frequency.back()))
          w.error("E21", "frequency", fmt::format("the frequencies do not increase: {} after {}", hertz(r.frequency), hertz(b.frequency.back())));
        b.frequency.push_back(r.frequency);
      } else if (column >= b.frequency.size() || std::abs(b.frequency[column] - r.frequency) > 1e-9 * r.frequency) {
        w.error("E26", "frequency", column >= b.frequency.size() ? fmt::format("{} has more frequencies than the first speed", units::display(r.speed, "rpm"))
                                                                : fmt::format("the frequencies differ from those of the first speed: {} for {}", hertz(r.frequency), hertz(b.frequency[column])),
                "every speed needs the same frequencies, in the same order");
      }
      ++column;
    }
    b.K.push_back(r.K);
    b.C.push_back(r.C);
    b.M.push_back(r.M);
    for (double m : r.M) mass = mass || m != 0;
  };
  v.rows({add, [](Visitor& w) { TableRow r; describe(w, r); }}, true, "coefficients against speed (and frequency), one row per speed (and frequency)");
  if (v.clean() && b.K.size() != b.speed.size() * std::max<std::size_t>(b.frequency.size(), 1))
    v.error("E26", nullptr, fmt::format("the table has {} rows for {} speeds and {} frequencies", b.K.size(), b.speed.size(), b.frequency.size()), "every speed needs the same frequencies");
  if (!mass) b.M.clear();
}

void describe(Visitor& v, model::RigidSupport& b) {
  static constexpr Option words[] = {{"x", "axial"}, {"y", "lateral"}, {"z", "lateral"}, {"rx", "the spin"}, {"ry", "tilt about y"}, {"rz", "tilt about z"}};
  std::vector<std::string> held;
  v.options(required("directions"), held, words, "motions held, exactly (constraints, no penalty stiffness)");
  for (const auto& h : held)
    for (std::size_t i = 0; i < 6; ++i) b.held[i] = b.held[i] || h == words[i].name;
  if (v.clean() && held.empty()) v.error("E05", "directions", "no direction is held", "directions = [\"y\", \"z\"]");
}

void describe(Visitor& v, model::Pedestal& p) {
  v.quantity(required("mass"), p.mass, "kg", not_negative, "mass of the pedestal");
  static constexpr const char* keys[2][9] = {{"kxx", "kxy", "kxz", "kyx", "kyy", "kyz", "kzx", "kzy", "kzz"}, {"cxx", "cxy", "cxz", "cyx", "cyy", "cyz", "czx", "czy", "czz"}};
  for (Index i = 0; i < 9; ++i) v.quantity(keys[0][i], p.K(i / 3, i % 3), "N/m", any, "stiffness between pedestal and ground");
  for (Index i = 0; i < 9; ++i) v.quantity(keys[1][i], p.C(i / 3, i % 3), "N.s/m", any, "damping between pedestal and ground");
  if (v.clean() && (!(p.K(1, 1) > 0) || !(p.K(2, 2) > 0))) v.error("E05", nullptr, "the support needs 'kyy' and 'kzz'", "leave 'support' out for a rigid pedestal");
}

namespace {

Alternative spring(const char* word, model::BearingLaw& law, bool angular, const char* doc) {
  return {word, doc, [&law, angular](Visitor& v) {
            if (!std::holds_alternative<model::NonlinearSpring>(law)) law = model::NonlinearSpring{};
            describe_spring(v, std::get<model::NonlinearSpring>(law), angular);
          }};
}

}  // namespace

void describe(Visitor& v, model::Bearing& b) {
  v.name(b, "bearing");
  v.location(required("at"), b.at, place);
  model::Location to;
  if (v.location(optional("to", "the ground"), to, "place on another shaft that it connects with")) b.to = to;
  const Alternative kinds[] = {
      Visitor::alternative<model::LinearBearing>("linear", b.law, "constant stiffness, damping and mass, up to 6x6, fixed axes; force on the shaft = preload - K (q - setpoint) - C q'"),
      Visitor::alternative<model::SpringBlock>("spring_block", b.law, "isotropic spring at a point and isotropic spring against tilt"),
      Visitor::alternative<model::TableBearing>("table", b.law, "lateral stiffness, damping and mass tabulated against speed, and where given against the frequency of the motion: modes take them at their own frequency, responses at that of the excitation, statics and transients at that of the spin (synchronous, held at the table's ends)"),
      Visitor::alternative<model::RigidSupport>("rigid", b.law, "directions held exactly"),
      spring("nonlinear_spring", b.law, false, "spring and damper along one direction: polynomial, table, clearance, one-sided"),
      spring("nonlinear_angular_spring", b.law, true, "the same for a tilt or the twist"),
      Visitor::alternative<model::ShortJournal>("short_journal", b.law, "plain journal bearing, short-bearing theory, cavitated half film; nonlinear in displacement and velocity"),
      Visitor::alternative<model::FiniteJournal>("journal", b.law, "journal bearing of finite length with cavitation: plain, with axial grooves, multi-lobe; nonlinear"),
      Visitor::alternative<model::SqueezeFilm>("squeeze_film", b.law, "squeeze-film damper, with a centring spring or without"),
      Visitor::alternative<model::BallBearing>("ball", b.law, "deep-groove or angular-contact ball bearing: Hertz contact, clearance or preload, varying compliance"),
      Visitor::alternative<model::RollerBearing>("roller", b.law, "cylindrical roller bearing"),
      Visitor::alternative<model::Rub>("rub", b.law, "rub, stop or catcher bearing: one-sided contact with friction; with 'support' the stator has mass and springs"),
      Visitor::alternative<model::AnnularSeal>("annular_seal", b.law, "liquid annular seal, coefficients after Black and Childs that follow the speed"),
      Visitor::alternative<model::CrossCoupling>("cross_coupling", b.law, "destabilising force of a stage: given, Alford or Wachel"),
      Visitor::alternative<model::Coupling>("coupling", b.law, "flexible coupling between two shafts, 6x6, with misalignment; needs 'to'"),
      Visitor::alternative<model::GearPair>("gear", b.law, "spur or helical gear pair between two shafts: mesh stiffness, backlash, transmission error; needs 'to'"),
  };
  v.alternatives(required("type"), kinds, "kind of bearing");
  v.table(optional("support", "rigid"), b.pedestal, "a pedestal: mass on springs between the bearing and the ground");
  if (v.clean() && b.to && b.to->shaft == b.at.shaft && b.to->s == b.at.s) v.error("E14", "to", "the bearing connects a station with itself");
  const bool pair = std::holds_alternative<model::Coupling>(b.law) || std::holds_alternative<model::GearPair>(b.law);
  if (v.clean() && pair && (!b.to || b.to->shaft == b.at.shaft))
    v.error("E26", b.to ? "to" : nullptr, fmt::format("'{}' connects two shafts, but {}", b.name, b.to ? "both its places are on one" : "'to' is missing"), "to = \"other_shaft/section:start\"");
  if (v.clean() && b.to && b.pedestal) v.error("E26", "support", "a bearing between two shafts has no pedestal");
}

}  // namespace whirl::deck
