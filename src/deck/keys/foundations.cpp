// [[foundation]]: reduced matrices under bearings.
#include <core/units.hpp>
#include <deck/visitor.hpp>

#include <la/dense.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace whirl::deck {
namespace {

struct Entry {
  int row = 0, column = 0;
  double K = 0, C = 0, M = 0;
};

/// Number of rotations among the row and the column of an entry -> units.
constexpr const char* stiffness_unit[3] = {"N/m", "N/rad", "N.m/rad"};
constexpr const char* damping_unit[3] = {"N.s/m", "N.s/rad", "N.m.s/rad"};
constexpr const char* mass_unit[3] = {"kg", "kg.m", "kg.m^2"};

void describe(Visitor& v, Entry& e, const std::vector<model::Foundation::Coordinate>& coordinates) {
  v.integer(required("row"), e.row, at_least(1),
            "coordinate, counted from 1 in the order of 'coordinates'");
  v.integer(required("column"), e.column, at_least(1), "coordinate");
  std::size_t rotations = 0;
  for (const int k : {e.row, e.column})
    if (k >= 1 && k <= static_cast<int>(coordinates.size()) &&
        coordinates[static_cast<std::size_t>(k - 1)].direction >= 3)
      ++rotations;
  v.quantity(
      zero_without_unit("K"), e.K, stiffness_unit[rotations], any,
      "stiffness: force in the row from motion in the column. Where rotations take part the cell "
      "carries its own unit, \"2e6 N.m/rad\", or \"2e6 N/rad\" between a force and a rotation");
  v.quantity(zero_without_unit("C"), e.C, damping_unit[rotations], any,
             "damping; with rotations N.m.s/rad, N.s/rad");
  v.quantity(zero_without_unit("M"), e.M, mass_unit[rotations], any,
             "mass; with rotations kg.m^2, kg.m");
}

/// "DE.y" -> bearing and direction; anything without a dot is an internal coordinate.
void find_coordinate(Visitor& v, model::Foundation::Coordinate& c) {
  const std::size_t dot = c.name.rfind('.');
  if (dot == std::string::npos) return;
  const std::string bearing = c.name.substr(0, dot), direction = c.name.substr(dot + 1);
  const auto& list = v.model().bearings;
  for (std::size_t k = 0; k < list.size(); ++k)
    if (list[k].name == bearing) c.bearing = static_cast<int>(k);
  if (c.bearing < 0) {
    v.error("E17", "coordinates", fmt::format("there is no bearing '{}'", bearing),
            "\"bearing.y\" is the support point of a bearing; a name without a dot is an internal "
            "coordinate");
    return;
  }
  static constexpr const char* directions[] = {"x", "y", "z", "rx", "ry", "rz"};
  const auto* found = std::find(std::begin(directions), std::end(directions), direction);
  if (found == std::end(directions)) {
    v.error("E15", "coordinates", fmt::format("'{}' is not a direction", direction),
            "it is x, y, z, or a rotation: rx, ry, rz");
    return;
  }
  c.direction = static_cast<int>(found - std::begin(directions));
  const model::Bearing& b = list[static_cast<std::size_t>(c.bearing)];
  if (b.pedestal)
    v.error("E26", "coordinates",
            fmt::format("bearing '{}' stands on a support of its own", b.name),
            "keep one of 'support' and the foundation");
  else if (b.to)
    v.error("E26", "coordinates", fmt::format("bearing '{}' is between two shafts", b.name));
  else if (model::traits_of(b.law).acts != model::Acts::between_nodes)
    v.error("E26", "coordinates", fmt::format("bearing '{}' holds the shaft to the ground", b.name),
            "a bearing on a foundation needs a stiffness of its own: type = \"linear\", ...");
}

}  // namespace

void describe(Visitor& v, model::Foundation& f) {
  v.name(f, "foundation");
  std::vector<std::string> names;
  v.texts(required("coordinates"), names,
          "what the rows of the matrices are: \"DE.y\" the support point of bearing DE along y (x, "
          "y, z; rx, ry, rz its rotations), a name without a dot an internal (modal) coordinate. "
          "Directions that are not listed are held");
  for (const std::string& n : names) {
    f.coordinates.push_back({n, -1, 0});
    if (v.clean()) find_coordinate(v, f.coordinates.back());
    for (std::size_t i = 0; v.clean() && i + 1 < f.coordinates.size(); ++i)
      if (f.coordinates[i].name == n)
        v.error("E16", "coordinates", fmt::format("the coordinate '{}' is there twice", n));
  }
  bool symmetric = true;
  v.flag("symmetric", symmetric,
         "one half of the matrices is enough; false: K and C are not symmetric (circulatory and "
         "gyroscopic parts), and every entry is given");
  const auto n = static_cast<Index>(names.size());
  f.K = f.C = f.M = MatX::Zero(n, n);
  MatX given = MatX::Zero(n, n);
  const auto add = [&](Visitor& w) {
    Entry e;
    describe(w, e, f.coordinates);
    if (!w.clean()) return;
    if (e.row > n || e.column > n) {
      w.error("E14", e.row > n ? "row" : "column", fmt::format("there are {} coordinates", n));
      return;
    }
    const Index i = e.row - 1, j = e.column - 1;
    const auto differs = [](double x, double y) {
      return std::abs(x - y) > 1e-9 * (std::abs(x) + std::abs(y));
    };
    if (given(i, j) != 0 &&
        (differs(e.K, f.K(i, j)) || differs(e.C, f.C(i, j)) || differs(e.M, f.M(i, j))))
      w.error("E29", "row",
              fmt::format("the entry {}, {} is given twice and not the same", e.row, e.column),
              symmetric ? "the matrices are symmetric: one half is enough; symmetric = false says "
                          "that they are not"
                        : "");
    f.K(i, j) = e.K;
    f.C(i, j) = e.C;
    f.M(i, j) = e.M;
    given(i, j) = 1;
    if (symmetric) {
      f.K(j, i) = e.K;
      f.C(j, i) = e.C;
      f.M(j, i) = e.M;
      given(j, i) = 1;
    }
  };
  v.rows({add,
          [](Visitor& w) {
            Entry e;
            describe(w, e, {});
          }},
         true, "entries of the matrices, one row an entry; those left out are zero");
  if (!v.clean()) return;
  for (Index i = 0; i < n; ++i)
    if (!(f.K(i, i) > 0) && !(f.M(i, i) > 0))
      v.error("E05", nullptr,
              fmt::format("coordinate '{}' has neither stiffness nor mass",
                          f.coordinates[static_cast<std::size_t>(i)].name));
  if (!v.clean()) return;
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < i; ++j) {
      const double a = f.M(i, j), b = f.M(j, i);
      if (std::abs(a - b) <= 1e-9 * (std::abs(a) + std::abs(b))) continue;
      v.error("E26", nullptr,
              fmt::format("the mass matrix is not symmetric: {} kg at {}, {} and {} kg at {}, {}",
                          a, i + 1, j + 1, b, j + 1, i + 1),
              "forces from unsymmetric parts belong to K and C");
      return;
    }
  // In units that make the diagonal one. A negative mass would make every motion grow; rounding of
  // a reduction leaves 1e-6 at most.
  VecX size = f.M.diagonal();
  for (Index i = 0; i < n; ++i)
    size[i] = size[i] > 0 ? 1 / std::sqrt(size[i]) : 1.0;
  const MatX scaled = size.asDiagonal() * f.M * size.asDiagonal();
  if (n > 0 && la::symmetric_eigenpairs(scaled).values[0] < -1e-6)
    v.error("E14", nullptr,
            "the mass matrix is not positive: some motion would have a negative kinetic energy",
            "check signs and couplings of M, and that a massless coordinate has none");
}

}  // namespace whirl::deck
