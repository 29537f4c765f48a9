// [[bearing]]: whatever connects a shaft with the ground or another shaft.
//
// To add a kind: docs/developer/add_a_bearing_law.md. Reading, error messages, the JSON schema, the
// reference documentation and the resolved deck follow from its describe().
#include <core/units.hpp>
#include <deck/keys/bearing_kinds.hpp>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

constexpr const char* bearing_place =
    "place on a shaft: \"section:mid\", \"section:end - 20 mm\", \"1.14 m\"";
std::string hertz(double w) { return fmt::format("{:.6g} Hz", to_hz(w)); }

}  // namespace

/// Names of the entries of a 6x6 matrix, row by row: kxx .. kzz; krxx, kryy, krzz, kryz, krzy
/// (moment about y from rotation about z, ..); the rest with both directions written out: ky_rz
/// (force along y from rotation about z), krz_y (moment about z from motion along y), krx_ry.
const std::array<std::string, 36>& entry_names(char prefix) {
  static const auto names = [] {
    std::array<std::array<std::string, 36>, 3> r;
    static constexpr const char* axes[6] = {"x", "y", "z", "rx", "ry", "rz"};
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t i = 0; i < 36; ++i) {
        const std::size_t row = i / 6, column = i % 6;
        const std::string letter(1, "kcm"[p]);
        const bool tilt = row >= 3 && column >= 3 && (row == column || (row > 3 && column > 3));
        if (row < 3 && column < 3)
          r[p][i] = letter + axes[row] + axes[column];
        else if (tilt)
          r[p][i] = letter + axes[row] + axes[column - 3];
        else
          r[p][i] = letter + axes[row] + "_" + axes[column];
      }
    return r;
  }();
  return names[prefix == 'k' ? 0 : prefix == 'c' ? 1 : 2];
}

namespace {

/// What the entries mean, in the order of their names.
const std::array<std::string, 36>& entry_docs(std::size_t of) {
  static const auto docs = [] {
    std::array<std::array<std::string, 36>, 3> r;
    static constexpr const char* what[3] = {"stiffness", "damping", "mass"};
    static constexpr const char* axes[3] = {"x", "y", "z"};
    for (std::size_t p = 0; p < 3; ++p)
      for (std::size_t i = 0; i < 36; ++i) {
        const std::size_t row = i / 6, column = i % 6;
        const char* const force = row >= 3 ? "moment about" : "force along";
        const char* const motion = column >= 3 ? "rotation about" : "motion along";
        r[p][i] = fmt::format("{}: {} {} from {} {}", what[p], force, axes[row % 3], motion,
                              axes[column % 3]);
      }
    return r;
  }();
  return docs[of];
}

}  // namespace

void describe_entries(Visitor& v, Matrix<6>& m, char prefix) {
  static constexpr const char* units[3][3] = {
      {"N/m", "N/rad", "N.m/rad"}, {"N.s/m", "N.s/rad", "N.m.s/rad"}, {"kg", "kg.m", "kg.m^2"}};
  static constexpr const char* what[3] = {"stiffness", "damping", "mass"};
  static constexpr const char* both_names[3] = {"krr", "crr", "mrr"};
  const std::size_t p = prefix == 'k' ? 0 : prefix == 'c' ? 1 : 2;
  const auto& names = entry_names(prefix);
  const auto entry = [&](Index row, Index column, const char* absent, bool listed) {
    const bool turn = row >= 3, turned = column >= 3;
    const auto i = static_cast<std::size_t>(6 * row + column);
    Key key = optional(names[i].c_str(), absent);
    key.listed = listed;
    return v.quantity(key, m(row, column),
                      units[p][static_cast<std::size_t>(turn) + static_cast<std::size_t>(turned)],
                      any, entry_docs(p)[i].c_str());
  };
  for (const auto& [row, column] :
       {std::pair{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 1}, {0, 1}, {0, 2}, {1, 0}, {2, 0}})
    entry(row, column, "0", true);
  double both = 0;
  const bool all = v.quantity(optional(both_names[p], "0"), both, units[p][2], any,
                              fmt::format("{}: tilting, the same about y and z", what[p]).c_str());
  const bool y = entry(4, 4, both_names[p], true), z = entry(5, 5, both_names[p], true);
  if (all && !y) m(4, 4) = both;
  if (all && !z) m(5, 5) = both;
  for (const auto& [row, column] : {std::pair{4, 5}, {5, 4}, {3, 3}})
    entry(row, column, "0", true);
  for (Index row = 0; row < 6; ++row)
    for (Index column = 0; column < 6; ++column)
      if ((row < 3) != (column < 3) || (row >= 3 && row != column && (row == 3 || column == 3)))
        entry(row, column, "0", false);
}

bool only_matrix(Visitor& v, char letter) {
  std::vector<std::string> names(entry_names(letter).begin(), entry_names(letter).end());
  names.push_back(letter + std::string("rr"));
  for (const std::string& key : names) {
    if (!v.given(key.c_str())) continue;
    v.error("E26", key.c_str(),
            fmt::format("'{}' and the full matrix '{}' are both given", key,
                        static_cast<char>(letter - 'a' + 'A')),
            "keep one of the two");
    return false;
  }
  return true;
}

namespace {

constexpr const char* other_entries =
    "entries that couple displacements and rotations have both directions in their name: ky_rz "
    "(N/rad) force along y from rotation about z, krz_y (N) moment about z from motion along y, "
    "krx_ry";

void describe_rest(Visitor& v, Vector<6>& setpoint, Vector<6>& preload) {
  std::vector<double> position{0, 0, 0}, tilt{0, 0, 0}, force{0, 0, 0}, moment{0, 0, 0};
  v.quantities("setpoint", position, "mm", any, 3, "displacement at which the springs are free");
  v.quantities("setpoint_tilt", tilt, "deg", any, 3, "rotation at which the springs are free");
  v.quantities("preload", force, "N", any, 3, "constant force on the shaft");
  v.quantities("preload_moment", moment, "N.m", any, 3, "constant moment on the shaft");
  for (Index i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    setpoint[i] = position[k];
    setpoint[i + 3] = tilt[k];
    preload[i] = force[k];
    preload[i + 3] = moment[k];
  }
}

}  // namespace

void describe(Visitor& v, model::SpringBlock& b) {
  v.quantity(required("C1"), b.C1, "N/m", not_negative,
             "stiffness against displacement, the same in all directions: force -C1 r");
  v.quantity(required("C2"), b.C2, "N.m/rad", not_negative,
             "stiffness against tilt: moment -C2 gamma, gamma the Euler vector of the tilt");
}

void describe(Visitor& v, model::LinearBearing& b) {
  for (const auto& [m, letter] : {std::pair(&b.K, 'k'), std::pair(&b.C, 'c'), std::pair(&b.M, 'm')})
    describe_entries(v, *m, letter);
  const bool K =
      v.matrix(optional("K", "the entries"), b.K, "N/m", "N/rad", "N.m/rad",
               "full stiffness in the order x, y, z, rx, ry, rz, instead of the entries");
  const bool C =
      v.matrix(optional("C", "the entries"), b.C, "N.s/m", "N.s/rad", "N.m.s/rad", "full damping");
  const bool M = v.matrix(optional("M", "the entries"), b.M, "kg", "kg.m", "kg.m^2", "full mass");
  describe_rest(v, b.setpoint, b.preload);
  if (!v.clean()) return;
  for (const auto& [matrix, letter] : {std::pair(K, 'k'), std::pair(C, 'c'), std::pair(M, 'm')})
    if (matrix && !only_matrix(v, letter)) return;
  if (b.K.isZero(0) && b.C.isZero(0) && b.M.isZero(0) && b.preload.isZero(0))
    v.error("E05", nullptr, "the bearing has no stiffness, damping, mass or preload",
            "give kyy = \"1e8 N/m\", kzz, kxx, cyy, ...");
}

namespace {

struct TableRow {
  double speed = 0, frequency = nan;
  Matrix<6> K = Matrix<6>::Zero(), C = K, M = K;
};

void describe(Visitor& v, TableRow& r) {
  v.quantity(required("speed"), r.speed, "rpm", any, "speed of the shaft");
  v.quantity(Key("frequency"), r.frequency, "rad/s", not_negative,
             "frequency of the motion (Hz, rpm or rad/s): the rows are then a grid, speed by "
             "speed, with the same frequencies for every speed");
  for (const auto& [m, letter] : {std::pair(&r.K, 'k'), std::pair(&r.C, 'c'), std::pair(&r.M, 'm')})
    describe_entries(v, *m, letter);
}

/// Columns that are there: looked at in the first row.
void check_columns(Visitor& v) {
  bool stiffness = v.given("krr");
  for (const std::string& key : entry_names('k'))
    stiffness = stiffness || v.given(key.c_str());
  if (!stiffness)
    v.error("E05", nullptr, "the table has no stiffness",
            "columns such as kyy[N/m] and kzz[N/m]; write 0 where there is none");
  for (const auto& [one, other] : {std::pair("kyy", "kzz"), std::pair("kzz", "kyy")})
    if (v.given(one) && !v.given(other))
      v.error("E05", one, fmt::format("'{}' without '{}'", one, other),
              "write 0 where there is none");
}

}  // namespace

void describe(Visitor& v, model::TableBearing& b) {
  static constexpr Option interpolations[] = {{"pchip", "monotone cubic"},
                                              {"linear", "straight lines"}};
  static constexpr Option ends[] = {
      {"error", "a speed or frequency outside the table is a mistake"},
      {"hold", "the coefficients at the edge hold outside"}};
  int interpolation = 0, outside = 0;
  v.option("interpolation", interpolation, interpolations, "between the rows");
  v.option("extrapolate", outside, ends, "outside the table");
  b.monotone_cubic = interpolation == 0;
  b.extrapolate_hold = outside == 1;
  bool mass = false;
  int rows = 0;
  std::size_t column = 0;  // place of the next row in its speed's frequencies
  const auto add = [&](Visitor& w) {
    TableRow r;
    describe(w, r);
    if (!w.clean()) return;
    if (rows == 0) check_columns(w);
    const bool by_frequency = !std::isnan(r.frequency);
    if (rows++ > 0 && by_frequency != !b.frequency.empty()) {
      w.error("E05", "frequency", "rows with and without a frequency");
      return;
    }
    const bool same_speed = by_frequency && !b.speed.empty() && r.speed == b.speed.back();
    if (!same_speed) {
      if (!b.speed.empty() && !(r.speed > b.speed.back()))
        w.error("E21", "speed",
                fmt::format("the speeds do not increase: {} after {}",
                            units::display(r.speed, "rpm"), units::display(b.speed.back(), "rpm")));
      if (column < b.frequency.size() && !b.speed.empty())
        w.error("E26", "frequency",
                fmt::format("{} has {} frequencies, the first speed has {}",
                            units::display(b.speed.back(), "rpm"), column, b.frequency.size()),
                "every speed needs the same frequencies");
      b.speed.push_back(r.speed);
      column = 0;
    }
    if (by_frequency) {
      if (b.speed.size() == 1) {
        if (!b.frequency.empty() && !(r.frequency > b.frequency.back()))
          w.error("E21", "frequency",
                  fmt::format("the frequencies do not increase: {} after {}", hertz(r.frequency),
                              hertz(b.frequency.back())));
        b.frequency.push_back(r.frequency);
      } else if (column >= b.frequency.size() ||
                 std::abs(b.frequency[column] - r.frequency) > 1e-9 * r.frequency) {
        w.error("E26", "frequency",
                column >= b.frequency.size()
                    ? fmt::format("{} has more frequencies than the first speed",
                                  units::display(r.speed, "rpm"))
                    : fmt::format("the frequencies differ from those of the first speed: {} for {}",
                                  hertz(r.frequency), hertz(b.frequency[column])),
                "every speed needs the same frequencies, in the same order");
      }
      ++column;
    }
    b.K.push_back(r.K);
    b.C.push_back(r.C);
    b.M.push_back(r.M);
    mass = mass || !r.M.isZero(0.0);
  };
  static const std::string doc = fmt::format(
      "coefficients against speed (and frequency), one row per speed (and frequency); {}",
      other_entries);
  v.rows({add,
          [](Visitor& w) {
            TableRow r;
            describe(w, r);
          }},
         true, doc.c_str());
  describe_rest(v, b.setpoint, b.preload);
  if (v.clean() && b.K.size() != b.speed.size() * std::max<std::size_t>(b.frequency.size(), 1))
    v.error("E26", nullptr,
            fmt::format("the table has {} rows for {} speeds and {} frequencies", b.K.size(),
                        b.speed.size(), b.frequency.size()),
            "every speed needs the same frequencies");
  if (!mass) b.M.clear();
}

void describe(Visitor& v, model::RigidSupport& b) {
  static constexpr Option words[] = {{"x", "axial"},         {"y", "lateral"},
                                     {"z", "lateral"},       {"rx", "the spin"},
                                     {"ry", "tilt about y"}, {"rz", "tilt about z"}};
  std::vector<std::string> held;
  v.options(required("directions"), held, words,
            "motions held, exactly (constraints, no penalty stiffness)");
  for (const auto& h : held)
    for (std::size_t i = 0; i < 6; ++i)
      b.held[i] = b.held[i] || h == words[i].name;
  if (v.clean() && held.empty())
    v.error("E05", "directions", "no direction is held", "directions = [\"y\", \"z\"]");
}

void add_kinds(Kinds& k, As<model::LinearBearing>) {
  static const std::string doc = fmt::format(
      "constant stiffness, damping and mass, up to 6x6, fixed axes; force on the shaft = preload - "
      "K (q - setpoint) - C q'; {}",
      other_entries);
  k.add<model::LinearBearing>("linear", doc.c_str());
}

void add_kinds(Kinds& k, As<model::SpringBlock>) {
  k.add<model::SpringBlock>("spring_block",
                            "isotropic spring at a point and isotropic spring against tilt");
}

void add_kinds(Kinds& k, As<model::TableBearing>) {
  k.add<model::TableBearing>(
      "table",
      "stiffness, damping and mass as type = \"linear\" has them, tabulated against speed, and "
      "where given against the frequency of the motion: modes take them at their own "
      "frequency, responses at that of the excitation, statics and transients at that of the "
      "spin (synchronous, held at the table's ends)");
}

void add_kinds(Kinds& k, As<model::RigidSupport>) {
  k.add<model::RigidSupport>("rigid", "directions held exactly");
}

void describe(Visitor& v, model::Pedestal& p) {
  v.quantity(required("mass"), p.mass, "kg", not_negative, "mass of the pedestal");
  static constexpr const char* keys[2][9] = {
      {"kxx", "kxy", "kxz", "kyx", "kyy", "kyz", "kzx", "kzy", "kzz"},
      {"cxx", "cxy", "cxz", "cyx", "cyy", "cyz", "czx", "czy", "czz"}};
  for (Index i = 0; i < 9; ++i)
    v.quantity(keys[0][i], p.K(i / 3, i % 3), "N/m", any, "stiffness between pedestal and ground");
  for (Index i = 0; i < 9; ++i)
    v.quantity(keys[1][i], p.C(i / 3, i % 3), "N.s/m", any, "damping between pedestal and ground");
  if (v.clean() && (!(p.K(1, 1) > 0) || !(p.K(2, 2) > 0)))
    v.error("E05", nullptr, "the support needs 'kyy' and 'kzz'",
            "leave 'support' out for a rigid pedestal");
}

void describe(Visitor& v, model::Bearing& b) {
  v.name(b, "bearing");
  v.location(required("at"), b.at, bearing_place);
  model::Location to;
  if (v.location(optional("to", "the ground"), to, "place on another shaft that it connects with"))
    b.to = to;
  Kinds kinds(b.law);
  model::for_each_law([&](auto law) { add_kinds(kinds, law); });
  v.alternatives(required("type"), kinds.list(), "kind of bearing");
  v.table(optional("support", "rigid"), b.pedestal,
          "a pedestal: mass on springs between the bearing and the ground");
  if (v.clean() && b.to && b.to->shaft == b.at.shaft && b.to->s == b.at.s)
    v.error("E14", "to", "the bearing connects a station with itself");
  if (v.clean() && model::traits_of(b.law).pair->has_value() &&
      (!b.to || b.to->shaft == b.at.shaft))
    v.error("E26", b.to ? "to" : nullptr,
            fmt::format("'{}' connects two shafts, but {}", b.name,
                        b.to ? "both its places are on one" : "'to' is missing"),
            "to = \"other_shaft/section:start\"");
  if (v.clean() && b.to && b.pedestal)
    v.error("E26", "support", "a bearing between two shafts has no pedestal");
}

}  // namespace whirl::deck
