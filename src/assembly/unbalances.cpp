// Unbalances. A static moment U at one section has no limit in a beam: with the section's mass m
// and inertia J (per length h both ~ h) the kinetic energy m u'^2/2 + U u'.b' + J omega^2/2 is
// positive only while U^2 < m J, so that on short elements a run with a perfectly ordinary
// unbalance grows without bound at the highest frequencies of the mesh. So U has the place of its
// section and turns with the nearest node whose inertia suffices: the force stays where it is, and
// only how the shaft twists and bends between the two is left out of its direction. Where no node
// suffices (a bare shaft in short elements) the place is the mean over a few, with weights v_i whose
// centre is the section, and each part of it turns with nodes of its own:
// T = U sum_i v_i u_i'.(sum_j w_ij b_j)'. With as much of the inertia J_j of the nodes about for each as
// v_i^2/m_i is of the sum, all of them are positive while U^2 (sum v_i^2/m_i)/(sum J_j) < 1.
#include <assembly/node_inertia.hpp>
#include <assembly/parts.hpp>
#include <elements/loads/unbalance.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {
namespace {

/// Largest U_j^2/(m_j J_j), squared root of it: what the unbalance may change of the inertia of its
/// nodes is a hundredth.
constexpr double fine = 0.1;
/// Where no more nodes are to be had. The consistent masses of neighbours are at least a third of
/// the lumped ones counted here.
constexpr double impossible = 1.0 / 3.0;

double largest_factor(const model::Unbalance& u) {
  if (!u.factor) return 1.0;
  double most = std::abs(u.factor->at(0.0).f);
  for (const double t : u.factor->breakpoints())
    for (const double s : {t, std::nextafter(t, -infinity)})
      most = std::max(most, std::abs(u.factor->at(s).f));
  return most;
}

/// Weights of nodes first, first + 1, .. of a line.
struct Mean {
  Index first = 0;
  std::vector<double> w;
};

/// A line as its nodes: places (increasing), inertias.
struct Slices {
  std::vector<double> x;
  std::vector<NodeInertia> nodes;
  Index size() const { return static_cast<Index>(x.size()); }
  double mass(Index j) const { return nodes[static_cast<std::size_t>(j)].mass; }
  double turning(Index j) const {
    const NodeInertia& n = nodes[static_cast<std::size_t>(j)];
    return std::min(n.Id, n.Ip);
  }
  double place(Index j) const { return x[static_cast<std::size_t>(j)]; }
  /// One node more, that which is nearer to x0. False: there is none.
  bool grow(Index& lo, Index& hi, double x0) const {
    const bool left = lo > 0, right = hi + 1 < size();
    if (!left && !right) return false;
    if (right && (!left || place(hi + 1) - x0 <= x0 - place(lo - 1)))
      ++hi;
    else
      --lo;
    return true;
  }
};

/// The mean place x0 of nodes lo .. hi: weights of least sum v_i^2/m_i; none where there is no such
/// mean.
Mean mean_place(const Slices& s, Index lo, Index hi, double x0) {
  if (lo == hi && s.place(lo) == x0) return {lo, {1.0}};
  double s0 = 0, s1 = 0, s2 = 0;
  const double scale = std::max(s.place(hi) - s.place(lo), 1e-300);
  for (Index j = lo; j <= hi; ++j) {
    const double xi = (s.place(j) - x0) / scale;
    s0 += s.mass(j);
    s1 += s.mass(j) * xi;
    s2 += s.mass(j) * xi * xi;
  }
  const double det = s0 * s2 - s1 * s1;
  Mean out{lo, {}};
  for (Index j = lo; j <= hi && det > 0; ++j)
    out.w.push_back(s.mass(j) * (s2 - s1 * (s.place(j) - x0) / scale) / det);
  return out;
}

/// Place and directions of a moment that no node bears by itself.
struct Spread {
  Mean place;
  Index first = 0, last = -1;  ///< nodes whose directions it takes
  double light = 0, J = 0;     ///< sum v^2/m, 1/kg; sum of their inertia, kg m2
  double worst() const { return J > 0 ? std::sqrt(light / J) : infinity; }  ///< 1/(kg m)
};

/// The narrowest place that bears U to `fine` with the directions of as many nodes as that takes; the
/// best there is.
Spread spread(double U, double x0, Index k, const Slices& s) {
  Spread best;
  Index lo = k, hi = k;
  do {
    Spread now{mean_place(s, lo, hi, x0), k, k, 0, s.turning(k)};
    if (now.place.w.empty()) continue;
    for (std::size_t i = 0; i < now.place.w.size(); ++i)
      if (const double v = now.place.w[i]; v != 0)
        now.light += v * v / s.mass(lo + static_cast<Index>(i));
    while (U * now.worst() > fine) {
      Index a = now.first, b = now.last;
      if (!s.grow(a, b, x0)) break;
      now.J += s.turning(a < now.first ? a : b);
      now.first = a;
      now.last = b;
    }
    if (now.worst() < best.worst()) best = now;
  } while (U * best.worst() > fine && s.grow(lo, hi, x0));
  return best;
}

/// The nearest node with whose direction node k carries U to `fine`; -1: none.
Index guide_of(double U, Index k, const std::vector<double>& x,
               const std::vector<NodeInertia>& nodes) {
  const auto i = static_cast<std::size_t>(k);
  Index best = -1;
  double nearest = infinity;
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    const double distance = std::abs(x[j] - x[i]);
    if (U > fine * nodes[i].carries_with(nodes[j]) || distance >= nearest) continue;
    nearest = distance;
    best = static_cast<Index>(j);
  }
  return best;
}

void too_much(Assembly& a, const model::Unbalance& u, double U,
              const std::vector<NodeInertia>& nodes) {
  NodeInertia whole;
  for (const NodeInertia& n : nodes) {
    whole.mass += n.mass;
    whole.Ip += n.Ip;
  }
  a.error("E38",
          fmt::format(
              "an unbalance of {:.4g} kg m is more than its shaft can have: {:.4g} kg with a "
              "radius of inertia of {:.3g} mm about the axis, the mass centre {:.3g} mm beside it",
              U, whole.mass, 1e3 * std::sqrt(whole.Ip / whole.mass), 1e3 * U / whole.mass),
          "an amount is mass times eccentricity: 1 g at 100 mm is \"100 g.mm\" = \"1e-4 kg.m\"; "
          "give the disk that has it its mass, Ip and Id",
          u, u.name.empty() ? "unbalance" : u.name);
}

/// Spread evenly over elements and rigid sections: with the cubic shapes of an element, int N ds =
/// l/2 on the displacement and +-l^2/12 on the director of each end, which the offset of a node's
/// share stands for.
void add_spread(Assembly& a, const model::Unbalance& u, const meshes::Line& line,
                const std::vector<NodeInertia>& nodes) {
  const double from = u.at.s, to = u.to->s, per_length = u.amount / (to - from),
               tiny = 1e-9 * (to - from);
  std::vector<Vec2> share(nodes.size(), Vec2::Zero());  // kg m, kg m2 along the axis from the node
  const auto add = [&](Index node, double amount, double moment) {
    share[static_cast<std::size_t>(node - line.first_node)] += Vec2(amount, moment);
  };
  for (Index i = line.first_element; i < line.first_element + line.elements; ++i) {
    const meshes::Element& e = a.mesh.elements[static_cast<std::size_t>(i)];
    if (e.s1 < from - tiny || e.s2 > to + tiny) continue;  // its ends are nodes
    const double l = e.s2 - e.s1, half = 0.5 * per_length * l, moment = per_length * l * l / 12;
    add(e.left.node, half, half * e.left.offset + moment);
    add(e.right.node, half, half * e.right.offset - moment);
  }
  for (const meshes::RigidPart& r : a.mesh.rigid_parts) {
    if (r.node < line.first_node || r.node >= line.first_node + line.nodes) continue;
    const double s = a.mesh.nodes[static_cast<std::size_t>(r.node)].s,
                 o1 = std::max(r.o1, from - s), o2 = std::min(r.o2, to - s);
    if (o2 > o1) add(r.node, per_length * (o2 - o1), per_length * (o2 - o1) * 0.5 * (o1 + o2));
  }
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (share[i][0] == 0) continue;
    const double U = std::abs(share[i][0]) * largest_factor(u), own = nodes[i].carries();
    if (own > 0 && U > impossible * own)
      return too_much(a, u, std::abs(u.amount) * largest_factor(u), nodes);
    a.builder.add(
        elements::UnbalanceMass(share[i][0], u.phase, u.factor, share[i][1] / share[i][0]),
        {line.first_node + static_cast<Index>(i)}, "unbalances");
  }
}

/// Each part of the place with its share of the directions, both from left to right.
void add_spread_point(Assembly& a, const model::Unbalance& u, const meshes::Line& line,
                      const Spread& s, const Slices& slices) {
  Index j = s.first;
  double left = slices.turning(j);  // of node j, not given away yet
  for (std::size_t i = 0; i < s.place.w.size(); ++i) {
    const double v = s.place.w[i];
    if (v == 0) continue;
    const Index place = s.place.first + static_cast<Index>(i);
    const double share = s.J * v * v / (slices.mass(place) * s.light);
    for (double taken = 0; taken < share * (1 - 1e-9);) {
      const double part = j == s.last ? share - taken : std::min(left, share - taken);
      const double amount = u.amount * v * part / share;
      if (part > 0 && place == j)
        a.builder.add(elements::UnbalanceMass(amount, u.phase, u.factor), {line.first_node + j},
                      "unbalances");
      else if (part > 0)
        a.builder.add(elements::LightUnbalance(amount, u.phase, u.factor),
                      {line.first_node + place, line.first_node + j}, "unbalances of light slices");
      taken += part;
      left -= part;
      if (left <= 0 && j < s.last) left = slices.turning(++j);
    }
  }
}

}  // namespace

void add_unbalances(Assembly& a) {
  std::vector<std::vector<NodeInertia>> known(a.mesh.lines.size());
  for (const model::Unbalance& u : a.model.unbalances) {
    const meshes::Place at = a.mesh.place(u.at);
    a.take_breakpoints(u.factor);
    const Index line_index = a.mesh.nodes[static_cast<std::size_t>(at.node)].line;
    const meshes::Line& line = a.mesh.lines[static_cast<std::size_t>(line_index)];
    std::vector<NodeInertia>& nodes = known[static_cast<std::size_t>(line_index)];
    if (nodes.empty()) nodes = node_inertias(a.model, a.mesh, line);
    if (u.to) {
      add_spread(a, u, line, nodes);
      continue;
    }
    const Index k = at.node - line.first_node;
    const double U = std::abs(u.amount) * largest_factor(u),
                 own = nodes[static_cast<std::size_t>(k)].carries();
    // A node without any inertia is a mass point on a massless shaft; whether it may turn is for
    // the scene to say.
    if (U <= fine * own || own == 0) {
      a.builder.add(elements::UnbalanceMass(u.amount, u.phase, u.factor, at.offset), {at.node},
                    "unbalances");
      continue;
    }
    Slices slices{{}, nodes};
    for (Index i = 0; i < line.nodes; ++i)
      slices.x.push_back(a.mesh.nodes[static_cast<std::size_t>(line.first_node + i)].s);
    if (const Index guide = guide_of(U, k, slices.x, nodes); guide >= 0) {
      a.builder.add(elements::LightUnbalance(u.amount, u.phase, u.factor, at.offset),
                    {at.node, line.first_node + guide}, "unbalances of light slices");
      continue;
    }
    const Spread s = spread(U, slices.place(k) + at.offset, k, slices);
    if (U * std::min(s.worst(), 1 / own) > impossible) {
      too_much(a, u, U, nodes);
      continue;
    }
    if (!(s.worst() < 1 / own)) {
      a.builder.add(elements::UnbalanceMass(u.amount, u.phase, u.factor, at.offset), {at.node},
                    "unbalances");
      continue;
    }
    add_spread_point(a, u, line, s, slices);
    const double width = slices.place(s.place.first + static_cast<Index>(s.place.w.size()) - 1) -
                         slices.place(s.place.first);
    if (width > 0)
      a.built.notes.push_back(
          fmt::format("{} ({:.4g} kg m): its place is the mean over {:.3g} mm of the shaft, as the "
                      "slice of one node is too light to carry it",
                      u.name.empty() ? "unbalance" : u.name, u.amount, 1e3 * width));
  }
}

}  // namespace whirl::assembly
