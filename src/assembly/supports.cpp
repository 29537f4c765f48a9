// Bearings, supports and pedestals. A bearing acts between its shaft node and the other side:
// ground, pedestal, or a second station. Rigid supports hold unknowns of the shaft node itself; no
// penalty stiffness anywhere.
#include <core/contract.hpp>
#include <assembly/support_parts.hpp>
#include <elements/supports/coefficient_grid.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/supports/spring_block.hpp>
#include <elements/supports/table_bearing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace whirl::assembly {

// ---------------------------------------------------------------- one function a law

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::LinearBearing& law) {
  const Pair nodes{n.shaft.node, n.other.node};
  const auto translations_only = [](const Matrix<6>& m) {
    return m.bottomRows<3>().isZero(0.0) && m.topRightCorner<3, 3>().isZero(0.0);
  };
  const bool small = n.shaft.offset == 0 && n.other.offset == 0 && translations_only(law.K) &&
                     translations_only(law.C) && translations_only(law.M) &&
                     law.preload.tail<3>().isZero(0.0);
  if (small && !a.model.keep_everything) {
    ++a.translational;
    const elements::TranslationalBearing k{law.K.topLeftCorner<3, 3>(), law.C.topLeftCorner<3, 3>(),
                                           law.M.topLeftCorner<3, 3>(), law.setpoint.head<3>(),
                                           law.preload.head<3>()};
    a.builder.add(k, nodes, "linear bearings");
    a.built.support_forces.push_back(
        {b.name, [k, nodes](const NodeAt& at, const system::Context&, const ReactionAt&) {
           return k.force_on_first(nodes_of(at, nodes));
         }});
    return;
  }
  const elements::LinearBearing k(law.K, law.C, law.M, law.setpoint, law.preload, n.shaft.offset,
                                  n.other.offset);
  a.builder.add(k, nodes, "linear bearings");
  a.built.support_forces.push_back(
      {b.name, [k, nodes](const NodeAt& at, const system::Context&, const ReactionAt&) {
         return Vec3(k.load_on_first(nodes_of(at, nodes)).head<3>());
       }});
  if (!small)
    a.built.support_forces.back().moment = [k, nodes](const NodeAt& at, const system::Context&,
                                                      const ReactionAt&) {
      return Vec3(k.load_on_first(nodes_of(at, nodes)).tail<3>());
    };
}

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::SpringBlock& law) {
  if (n.other.node >= 0) {  // relative to a moving point: the linear form
    add_law(a, b, n, linear_form(law));
    return;
  }
  elements::SpringBlock k;
  k.C1 = law.C1;
  k.C2 = law.C2;
  k.offset = n.shaft.offset;
  const Index node = n.shaft.node;
  a.builder.add(k, {node}, "spring blocks");
  a.built.support_forces.push_back(
      {b.name, [k, node](const NodeAt& at, const system::Context&, const ReactionAt&) {
         return Vec3(-k.C1 * k.displacement(at(node)));
       }});
  if (law.C2 == 0) return;
  a.built.support_forces.back().moment = [k, node](const NodeAt& at, const system::Context& c,
                                                   const ReactionAt&) {
    system::ForceX<7> f = system::ForceX<7>::Zero();
    k.add_force({&at(node)}, c, f);
    return moment_about_place(at(node), f, k.offset);
  };
}

namespace {

template <int N>
std::vector<elements::CoefficientValues<N>> table_rows(const model::TableBearing& law) {
  const auto part = [](const std::vector<Matrix<6>>& m, std::size_t i) -> Matrix<N> {
    constexpr int first = N == 2 ? 1 : 0;
    return i < m.size() ? Matrix<N>(m[i].block<N, N>(first, first)) : Matrix<N>::Zero();
  };
  std::vector<elements::CoefficientValues<N>> rows(law.K.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i] = {part(law.K, i), part(law.C, i), part(law.M, i)};
  return rows;
}

/// Adds the kernel of a table: the lateral one where nothing else is given, else the one in all six
/// motions.
template <class Table>
void add_table_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                   const model::TableBearing& law, std::shared_ptr<const Table> table,
                   const char* kind) {
  WHIRL_EXPECTS(n.shaft.node >= 0 && n.other.node >= 0);
  const auto add = [&](auto mass) {
    if constexpr (Table::size == 2) {
      add_lateral(a, b, n, elements::TableBearingLaw<mass.value, Table>{table}, kind,
                  Friction::none);
    } else {
      const Pair nodes{n.shaft.node, n.other.node};
      const elements::SpatialTableBearing<mass.value, Table> k{
          table, {n.shaft.offset, n.other.offset}, law.setpoint, law.preload};
      add_element(a, b, k, nodes, kind);
      a.built.support_forces.push_back(
          {b.name,
           [k, nodes](const NodeAt& at, const system::Context& c, const ReactionAt&) {
             return Vec3(k.load_on_first(nodes_of(at, nodes), c).template head<3>());
           },
           [k, nodes](const NodeAt& at, const system::Context& c, const ReactionAt&) {
             return Vec3(k.load_on_first(nodes_of(at, nodes), c).template tail<3>());
           }});
    }
  };
  if (table->has_mass())
    add(std::true_type{});
  else
    add(std::false_type{});
}

template <int N>
void add_table_of(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                  const model::TableBearing& law) {
  using Table = elements::CoefficientTable<N>;
  using Grid = elements::CoefficientGrid<N>;
  const auto between = law.monotone_cubic ? Table::Between::monotone_cubic : Table::Between::linear;
  const auto outside = law.extrapolate_hold ? Table::Outside::hold : Table::Outside::undefined;
  guarded(a, b, [&] {
    if (law.frequency.empty()) {
      add_table_law<Table>(a, b, n, law,
                           std::make_shared<Table>(law.speed, table_rows<N>(law), between, outside),
                           "tabulated bearings");
    } else {
      a.built.table_frequencies.insert(a.built.table_frequencies.end(), law.frequency.begin(),
                                       law.frequency.end());
      add_table_law<Grid>(
          a, b, n, law,
          std::make_shared<Grid>(law.speed, law.frequency, table_rows<N>(law), between, outside),
          "bearings tabulated against frequency");
    }
  });
}

}  // namespace

void add_law(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
             const model::TableBearing& law) {
  const auto lateral = [](const std::vector<Matrix<6>>& list) {
    return std::all_of(list.begin(), list.end(), [](Matrix<6> m) {
      m.block<2, 2>(1, 1).setZero();
      return m.isZero(0.0);
    });
  };
  const bool small = lateral(law.K) && lateral(law.C) && lateral(law.M) &&
                     law.setpoint.isZero(0.0) && law.preload.isZero(0.0);
  if (small && !a.model.keep_everything)
    add_table_of<2>(a, b, n, law);
  else
    add_table_of<6>(a, b, n, law);
}

// ---------------------------------------------------------------- rigid supports

namespace {

/// What rigid supports hold of one node. A second one on the same rigid stretch, `arm` away, holds
/// the tilts instead: with u held, u + arm (d - e) = 0 means d_y = gamma3 sin g/g = 0, d_z =
/// -gamma2 sin g/g = 0. With both tilts held the stretch moves along x as its node does.
/// The reaction of a displacement is then the sum of both supports' forces.
struct HeldNode {
  struct Share {
    std::size_t direction;
    Index unknown;
    double scale;
  };
  std::array<bool, 6> held{};  // unknowns of the node
  std::shared_ptr<std::vector<Share>> second = std::make_shared<std::vector<Share>>();
  /// A tilt is what holds a direction off the node.
  bool tilt_serves(std::size_t unknown) const {
    return std::any_of(second->begin(), second->end(), [unknown](const Share& x) {
      return static_cast<std::size_t>(x.unknown) % 6 == unknown;
    });
  }
};

/// Moment of a support that holds rotations of its node; null when it holds none. A held angle is
/// zero, so its generalised force is the moment itself (gamma2 about y, gamma3 about z).
SupportForce::Law moment_of_held(Index node, const model::RigidSupport& law) {
  if (!law.held[3] && !law.held[4] && !law.held[5]) return {};
  return [node, turns = law.held](const NodeAt&, const system::Context&, const ReactionAt& r) {
    Vec3 M = Vec3::Zero();
    for (Index c = 0; c < 3; ++c)
      if (turns[static_cast<std::size_t>(3 + c)]) M[c] = r(6 * node + 3 + c);
    return M;
  };
}

/// The shaft sits rigidly in the pedestal: its mass, spring and damper act on the shaft station, in
/// the directions held.
void add_rigid_on_pedestal(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                           const model::RigidSupport& law, HeldNode& h) {
  WHIRL_EXPECTS(b.pedestal && n.ground >= 0);
  const Index node = n.shaft.node;
  Vec3 on = Vec3::Zero();
  for (int c = 0; c < 3; ++c)
    on[c] = law.held[static_cast<std::size_t>(c)] ? 1.0 : 0.0;
  model::LinearBearing linear;
  linear.K.topLeftCorner<3, 3>() = on.asDiagonal() * b.pedestal->K * on.asDiagonal();
  linear.C.topLeftCorner<3, 3>() = on.asDiagonal() * b.pedestal->C * on.asDiagonal();
  const bool whole = on.sum() == 3 && n.shaft.offset == 0;
  if (!whole) linear.M.topLeftCorner<3, 3>() = b.pedestal->mass * Mat3(on.asDiagonal());
  meshes::BearingNodes to_ground = n;
  to_ground.other = {n.ground, 0.0};
  add_law(a, b, to_ground, linear);
  SupportForce& support = a.built.support_forces.back();
  if (whole && b.pedestal->mass > 0) {
    // its weight and inertia (ddu: less gravity) stand between the spring and the shaft
    a.builder.add(elements::PointMass{b.pedestal->mass}, {node}, "point masses");
    support.force = [spring = support.force, m = b.pedestal->mass, node](
                        const NodeAt& at, const system::Context& c, const ReactionAt& r) {
      return Vec3(spring(at, c, r) - m * at(node).ddu);
    };
  }
  for (std::size_t c = 3; c < 6; ++c)
    if (law.held[c]) {
      a.builder.hold(node, static_cast<int>(c));
      h.held[c] = true;
    }
  if (const SupportForce::Law held_turns = moment_of_held(node, law)) support.moment = held_turns;
}

/// Where the forces of a rigid support are read.
struct HeldForces {
  std::array<Index, 3> unknown{-1, -1, -1};  // whose reaction is the force along x, y, z
  std::array<double, 3> scale{1, 1, 1};
  bool first = false;  // it holds translations of the node itself
};

/// Holds the unknowns of the node that the support resists: x, y, z, rx, ry, rz in order are u, phi,
/// gamma2, gamma3. Off the node a lateral direction is held by the tilt.
/// @pre those at the node have been asked before those off it.
HeldForces hold_directions(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
                           const model::RigidSupport& law, HeldNode& h) {
  const Index node = n.shaft.node;
  const double arm = n.shaft.offset;
  HeldForces out;
  const auto no_room = [&](const char* direction) {
    a.error("E26",
            fmt::format("{}: the rigid stretch it stands on is held elsewhere in a way that "
                        "leaves no room for holding {} here",
                        name_of(b), direction),
            "on a rigid stretch two rigid bearings may hold y and z both, x one of them, and no "
            "third one anything",
            b, name_of(b));
  };
  for (const std::size_t c : {1, 2, 0, 3, 4, 5}) {  // tilts are held before x asks for them
    if (!law.held[c]) continue;
    const std::size_t tilt = c == 1 ? 5 : 4;  // y: gamma3, z: gamma2
    const bool own = c >= 3 || arm == 0;
    if (c >= 3 ? h.tilt_serves(c)
               : !own && (c == 0 ? h.held[0] || !h.held[4] || !h.held[5]
                                 : !h.held[c] || h.held[tilt])) {
      constexpr const char* names[] = {"x", "y", "z", "rx", "ry", "rz"};
      no_room(names[c]);
      continue;
    }
    if (own || c == 0) {
      h.held[c] = true;
      a.builder.hold(node, static_cast<int>(c));
      if (c < 3) out.unknown[c] = 6 * node + static_cast<Index>(c);
      out.first = out.first || (c < 3 && own);
      continue;
    }
    h.held[tilt] = true;
    a.builder.hold(node, static_cast<int>(tilt));
    out.unknown[c] = 6 * node + static_cast<Index>(tilt);
    out.scale[c] = (c == 1 ? 1.0 : -1.0) / arm;  // Q_gamma3 = arm F_y, Q_gamma2 = -arm F_z
    h.second->push_back({c, out.unknown[c], out.scale[c]});
  }
  return out;
}

/// What rigid supports hold, of all bearings of a model: what stands off the nodes of rigid
/// stretches finds them held, in whatever order the deck names them.
class RigidSupports {
 public:
  explicit RigidSupports(Assembly& a) : a_(a), forces_(a.model.bearings.size()) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < forces_.size(); ++i)
      if (law_of(i) && !a.model.bearings[i].pedestal && nodes(i).other.node < 0) order.push_back(i);
    const auto rank = [this](std::size_t i) {
      const model::Directions& held = law_of(i)->held;
      return nodes(i).shaft.offset == 0 ? 0 : held[1] || held[2] ? 1 : 2;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t k) { return rank(i) < rank(k); });
    for (const std::size_t i : order)
      forces_[i] =
          hold_directions(a, a.model.bearings[i], nodes(i), *law_of(i), held_[nodes(i).shaft.node]);
  }
  HeldNode& at_node(Index node) { return held_[node]; }
  const HeldForces& forces(std::size_t bearing) const { return forces_[bearing]; }

 private:
  const model::RigidSupport* law_of(std::size_t i) const {
    return std::get_if<model::RigidSupport>(&a_.model.bearings[i].law);
  }
  const meshes::BearingNodes& nodes(std::size_t i) const { return a_.mesh.bearings[i]; }
  Assembly& a_;
  std::map<Index, HeldNode> held_;
  std::vector<HeldForces> forces_;
};

void add_rigid(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n,
               const model::RigidSupport& law, RigidSupports& rigid) {
  WHIRL_EXPECTS(n.shaft.node >= 0);
  if (n.other.node >= 0) {
    a.error("E26",
            fmt::format("{}: a rigid bearing holds a shaft to the ground; between two shafts it "
                        "must have a stiffness",
                        name_of(b)),
            "use type = \"linear\" with the stiffness of the connection", b, name_of(b));
    return;
  }
  HeldNode& h = rigid.at_node(n.shaft.node);
  if (b.pedestal) return add_rigid_on_pedestal(a, b, n, law, h);
  const HeldForces& forces = rigid.forces(number_of(a, b));
  const auto others = forces.first ? h.second : nullptr;
  a.built.support_forces.push_back(
      {b.name,
       [unknown = forces.unknown, scale = forces.scale, others](
           const NodeAt&, const system::Context&, const ReactionAt& r) {
         Vec3 F = Vec3::Zero();
         for (std::size_t c = 0; c < 3; ++c)
           if (unknown[c] >= 0) F[static_cast<Index>(c)] = scale[c] * r(unknown[c]);
         if (others)
           for (const HeldNode::Share& o : *others)
             F[static_cast<Index>(o.direction)] -= o.scale * r(o.unknown);
         return F;
       },
       moment_of_held(n.shaft.node, law)});
}

// ---------------------------------------------------------------- pedestals

void add_pedestal(Assembly& a, const model::Bearing& b, const meshes::BearingNodes& n) {
  WHIRL_EXPECTS(n.pedestal >= 0 && n.ground >= 0);
  const model::Pedestal& p = *b.pedestal;
  if (p.mass > 0) a.builder.add(elements::PointMass{p.mass}, {n.pedestal}, "point masses");
  a.builder.add(elements::TranslationalBearing{p.K, p.C, Mat3::Zero(), Vec3::Zero(), Vec3::Zero()},
                {n.pedestal, n.ground}, "pedestals");
  const model::Directions acts = model::traits_of(b.law).held;
  for (int c = 0; c < 6; ++c) {  // it does not turn, and where it has no spring it does not move
    const bool no_spring = c < 3 && p.K.row(c).isZero(0.0) && p.K.col(c).isZero(0.0);
    if (c < 3 && !no_spring) continue;
    a.builder.hold(n.pedestal, c);
    if (no_spring && acts[static_cast<std::size_t>(c)])
      a.built.held.push_back(
          fmt::format("pedestal of {} along {}: it has no stiffness there", name_of(b), "xyz"[c]));
  }
}

}  // namespace

void add_supports(Assembly& a) {
  RigidSupports rigid(a);
  a.built.support_terms.resize(a.model.bearings.size());
  for (std::size_t i = 0; i < a.model.bearings.size(); ++i) {
    const model::Bearing& b = a.model.bearings[i];
    const meshes::BearingNodes& n = a.mesh.bearings[i];
    if (b.to && b.pedestal) {
      a.error("E26",
              fmt::format("{}: a pedestal stands on the ground; between two shafts there is none",
                          name_of(b)),
              {}, b, name_of(b));
      continue;
    }
    if (n.other.node == n.shaft.node) {
      a.error("E26",
              fmt::format("{}: both its ends are the same place or rigidly connected", name_of(b)),
              {}, b, name_of(b));
      continue;
    }
    std::visit(
        [&](const auto& law) {
          using Law = std::decay_t<decltype(law)>;
          if constexpr (std::is_same_v<Law, model::RigidSupport>)
            add_rigid(a, b, n, law, rigid);
          else
            add_law(a, b, n, law);
        },
        b.law);
    if (n.pedestal >= 0 && b.pedestal) add_pedestal(a, b, n);
  }
  if (a.translational > 0)
    a.built.simpler.push_back(
        fmt::format("moments and tilts of {} linear bearing{}: without coefficients",
                    a.translational, a.translational > 1 ? "s" : ""));
}

}  // namespace whirl::assembly
