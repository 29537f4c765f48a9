// Reduced foundations: a node for every support point and every internal coordinate, matrices in
// parts between pairs of them.
#include <assembly/parts.hpp>
#include <core/contract.hpp>
#include <elements/supports/matrix_part.hpp>
#include <elements/rigid/point_mass.hpp>

#include <fmt/format.h>

#include <map>

namespace whirl::assembly {
namespace {

using Foundation = model::Foundation;

/// Where a coordinate lives.
struct Coordinate {
  Index node;
  int component;
  bool internal;
};

/// Rows and columns (x, y, z, rx, ry, rz) of N nodes.
template <int N>
struct Parts {
  Matrix<6 *N> K = Matrix<6 * N>::Zero(), C = K, M = K;
};

template <int N>
void add_part(Assembly& a, const Parts<N>& p, const std::array<Index, N>& nodes,
              const std::array<bool, N>& internal, const char* kind) {
  bool turns = false;
  for (int i = 0; i < 6 * N; ++i)
    if (i % 6 >= 3)
      for (const auto* m : {&p.K, &p.C, &p.M})
        turns = turns || !m->row(i).isZero(0.0) || !m->col(i).isZero(0.0);
  if (turns) {
    a.builder.add(elements::with_rotations<N>(p.K, p.C, p.M, internal), nodes, kind);
    return;
  }
  elements::MatrixPart<N> part;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      const auto take = [&](auto& to, const auto& from) {
        to.template block<3, 3>(3 * i, 3 * j) = from.template block<3, 3>(6 * i, 6 * j);
      };
      take(part.K, p.K);
      take(part.C, p.C);
      take(part.M, p.M);
    }
  part.internal = internal;
  a.builder.add(part, nodes, kind);
}

/// Masses that are no more than points: each support point with the same mass along all its
/// directions, without couplings. Node -> kg.
std::map<Index, double> point_masses(const Foundation& f, const std::vector<Coordinate>& place) {
  std::map<Index, double> out;
  for (std::size_t i = 0; i < place.size(); ++i) {
    const auto r = static_cast<Index>(i);
    const double m = f.M(r, r);
    if (((f.M.row(r).array() != 0).count() > (m != 0 ? 1 : 0)) ||
        (m != 0 && (place[i].internal || place[i].component >= 3)))
      return {};
    if (place[i].internal || place[i].component >= 3) continue;
    const auto [at, fresh] = out.emplace(place[i].node, m);
    if (!fresh && at->second != m) return {};
  }
  return out;
}

/// A node for every coordinate: the support points are there, the internal ones are added.
std::vector<Coordinate> place_coordinates(Assembly& a, const Foundation& f,
                                          const std::string& who) {
  std::vector<Coordinate> place;
  Index line = -1;
  std::map<Index, std::array<bool, 6>> used;
  for (const auto& c : f.coordinates) {
    if (c.bearing >= 0) {
      WHIRL_EXPECTS(at(c.bearing) < a.mesh.bearings.size());
      place.push_back(
          {a.mesh.bearings[static_cast<std::size_t>(c.bearing)].pedestal, c.direction, false});
      used[place.back().node][static_cast<std::size_t>(c.direction)] = true;
    } else {
      if (line < 0) line = a.builder.add_line(who);
      place.push_back(
          {a.builder.add_node(
               {Vec3::Zero(), line, fmt::format("coordinate '{}' of {}", c.name, who), true}),
           0, true});
    }
  }
  for (const auto& [node, directions] : used)  // a support point moves along its coordinates only
    for (int c = 0; c < 6; ++c)
      if (!directions[static_cast<std::size_t>(c)]) a.builder.hold(node, c);
  return place;
}

/// Where the mass of a reduced body is, its matrices do not say, so the centrifugal and Coriolis
/// forces of a turning base on it are known for points only. False: it is no such body.
bool add_as_points(Assembly& a, const Foundation& f, const std::vector<Coordinate>& place,
                   const std::string& who) {
  const std::map<Index, double> points = point_masses(f, place);
  if (points.empty()) {
    a.error(
        "E26",
        fmt::format("{}: its mass matrix does not say where the mass is, so the forces of a "
                    "turning base on it are not known",
                    who),
        "on a turning base give the support points one mass each, the same along their "
        "directions and without couplings, or make the casing a [[shaft]] with rotating = false",
        f, who);
    return false;
  }
  for (const auto& [node, mass] : points)
    if (mass != 0) a.builder.add(elements::PointMass{mass}, {node}, "point masses");
  return true;
}

void add_foundation(Assembly& a, const Foundation& f) {
  [[maybe_unused]] const Index n = static_cast<Index>(f.coordinates.size());
  WHIRL_EXPECTS(f.M.rows() == n && f.M.cols() == n && f.K.rows() == n && f.C.rows() == n);
  const std::string who = fmt::format("foundation '{}'", f.name);
  const std::vector<Coordinate> place = place_coordinates(a, f, who);
  MatX M = f.M;
  if (a.model.base.turn && !M.isZero(0.0)) {
    if (!add_as_points(a, f, place, who)) return;
    M.setZero();
  }

  std::map<Index, Parts<1>> single;
  std::map<std::array<Index, 2>, Parts<2>> pairs;
  std::map<Index, bool> internal;
  for (std::size_t i = 0; i < place.size(); ++i)
    internal[place[i].node] = place[i].internal;
  for (std::size_t i = 0; i < place.size(); ++i)
    for (std::size_t j = 0; j < place.size(); ++j) {
      const auto r = static_cast<Index>(i), s = static_cast<Index>(j);
      const double k = f.K(r, s), c = f.C(r, s), m = M(r, s);
      const auto [n1, d1, internal1] = place[i];
      const auto [n2, d2, internal2] = place[j];
      if (n1 == n2) {
        Parts<1>& p = single[n1];
        p.K(d1, d2) = k;
        p.C(d1, d2) = c;
        p.M(d1, d2) = m;
      } else if (k != 0 || c != 0 || m != 0) {
        const bool swap = n2 < n1;
        Parts<2>& p = pairs[swap ? std::array{n2, n1} : std::array{n1, n2}];
        const int row = swap ? 6 + d1 : d1, column = swap ? d2 : 6 + d2;
        p.K(row, column) = k;
        p.C(row, column) = c;
        p.M(row, column) = m;
      }
    }
  for (const auto& [node, p] : single)
    add_part<1>(a, p, {node}, {internal[node]}, "foundation matrices");
  for (const auto& [nodes, p] : pairs)
    add_part<2>(a, p, nodes, {internal[nodes[0]], internal[nodes[1]]}, "foundation couplings");
}

}  // namespace

void add_foundations(Assembly& a) {
  for (const Foundation& f : a.model.foundations)
    add_foundation(a, f);
}

}  // namespace whirl::assembly
