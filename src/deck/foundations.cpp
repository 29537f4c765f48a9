// [[foundation]]: reduced matrices under bearings.
#include <core/units.hpp>
#include <cmath>
#include <deck/visitor.hpp>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

struct Entry { int row = 0, column = 0; double K = 0, C = 0, M = 0; };

void describe(Visitor& v, Entry& e) {
  v.integer(required("row"), e.row, at_least(1), "coordinate, counted from 1 in the order of 'coordinates'");
  v.integer(required("column"), e.column, at_least(1), "coordinate");
  v.quantity("K", e.K, "N/m", any, "stiffness");
  v.quantity("C", e.C, "N.s/m", any, "damping");
  v.quantity("M", e.M, "kg", any, "mass");
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
    v.error("E17", "coordinates", fmt::format("there is no bearing '{}'", bearing), "\"bearing.y\" is the support point of a bearing; a name without a dot is an internal coordinate");
    return;
  }
  if (direction != "x" && direction != "y" && direction != "z") {
    v.error("E15", "coordinates", fmt::format("'{}' is not a direction", direction), "it is x, y or z");
    return;
  }
  c.direction = direction[0] - 'x';
  const model::Bearing& b = list[static_cast<std::size_t>(c.bearing)];
  if (b.pedestal) v.error("E26", "coordinates", fmt::format("bearing '{}' stands on a support of its own", b.name), "keep one of 'support' and the foundation");
  else if (b.to) v.error("E26", "coordinates", fmt::format("bearing '{}' is between two shafts", b.name));
  else if (std::holds_alternative<model::RigidSupport>(b.law) || std::holds_alternative<model::SpringBlock>(b.law))
    v.error("E26", "coordinates", fmt::format("bearing '{}' holds the shaft to the ground", b.name), "a bearing on a foundation needs a stiffness of its own: type = \"linear\", ...");
}

}  // namespace

void describe(Visitor& v, model::Foundation& f) {
  v.name(f, "foundation");
  std::vector<std::string> names;
  v.texts(required("coordinates"), names, "what the rows of the matrices are: \"DE.y\" the support point of bearing DE along y, a name without a dot an internal (modal) coordinate");
  for (const std::string& n : names) {
    f.coordinates.push_back({n, -1, 0});
    if (v.clean()) find_coordinate(v, f.coordinates.back());
    for (std::size_t i = 0; v.clean() && i + 1 < f.coordinates.size(); ++i)
      if (f.coordinates[i].name == n) v.error("E16", "coordinates", fmt::format("the coordinate '{}' is there twice", n));
  }
  const auto n = static_cast<Index>(names.size());
  f.K = f.C = f.M = MatX::Zero(n, n);
  MatX given = MatX::Zero(n, n);
  const auto add = [&](Visitor& w) {
    Entry e;
    describe(w, e);
    if (!w.clean()) return;
    if (e.row > n || e.column > n) {
      w.error("E14", e.row > n ? "row" : "column", fmt::format("there are {} coordinates", n));
      return;
    }
    const Index i = e.row - 1, j = e.column - 1;
    const double size = std::abs(e.K) + std::abs(f.K(i, j));
    if (given(i, j) != 0 && std::abs(e.K - f.K(i, j)) > 1e-9 * size) w.error("E29", "row", fmt::format("the entry {}, {} is given twice and not the same", e.row, e.column), "the matrices are symmetric: one half is enough");
    given(i, j) = given(j, i) = 1;
    f.K(i, j) = f.K(j, i) = e.K, f.C(i, j) = f.C(j, i) = e.C, f.M(i, j) = f.M(j, i) = e.M;
  };
  v.rows({add, [](Visitor& w) { Entry e; describe(w, e); }}, true, "entries of the symmetric matrices, one row an entry; those left out are zero");
  for (Index i = 0; v.clean() && i < n; ++i)
    if (!(f.K(i, i) > 0) && !(f.M(i, i) > 0)) v.error("E05", nullptr, fmt::format("coordinate '{}' has neither stiffness nor mass", f.coordinates[static_cast<std::size_t>(i)].name));
}

}  // namespace whirl::deck
