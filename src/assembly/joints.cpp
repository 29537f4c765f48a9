// Joints: which node follows which (src/system/joints.hpp), and what cannot be joined.
//
// Nodes and joints are a graph, the ground one vertex of it. Elements lie between nodes, so that a
// linkage closes its loops through them; a loop of joints alone is one place held twice. Each part
// of the graph is a tree. Its root is the ground, else the node that supports hold, and every other
// node follows the one before it.
#include <assembly/parts.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <la/dense.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace whirl::assembly {
namespace {

using model::Joint;
using model::JointKind;

std::string joint_name(const Joint& j) { return fmt::format("joint '{}'", j.name); }

/// Motions of one side against the other that a joint resists at `place`, as rows on (velocity of
/// the point there would be at `centre`, angular velocity), lengths by `size`.
MatX constraint_rows(const Joint& j, const Vec3& place, const Vec3& centre, double size) {
  const auto without = [](const MatX& free) {  // rows that span what is orthogonal to the columns
    const MatX P = Mat3::Identity() - free * la::pseudo_inverse(free);
    return P;
  };
  MatX rows = MatX::Zero(6, 6);
  const Mat3 all = Mat3::Identity();
  rows.topLeftCorner<3, 3>() = j.kind == JointKind::slider ? without(j.axis) : MatX(all);
  switch (j.kind) {
    case JointKind::rigid:
    case JointKind::slider: rows.bottomRightCorner<3, 3>() = all; break;
    case JointKind::hinge: rows.bottomRightCorner<3, 3>() = without(j.axis); break;
    case JointKind::universal: {
      MatX free(3, 2);
      free << j.axis, j.second_axis;
      rows.bottomRightCorner<3, 3>() = without(free);
      break;
    }
    case JointKind::spherical: break;
  }
  const Vec3 arm = (place - centre) / size;  // v = v0 + w x arm
  for (Index r = 0; r < 3; ++r) {
    const Vec3 along = rows.block<1, 3>(r, 0).transpose();
    rows.block<1, 3>(r, 3) += arm.cross(along).transpose();
  }
  return rows;
}

Index rank_of(const MatX& A) {
  if (A.size() == 0) return 0;
  const la::SymmetricEigenpairs eig = la::symmetric_eigenpairs(MatX(A.transpose() * A));
  return (eig.values.array() > 1e-12 * std::max(1.0, eig.values.maxCoeff())).count();
}

class Joints {
 public:
  explicit Joints(Assembly& a) : a_(a) {}

  void run() {
    list_held();
    for (std::size_t k = 0; k < a_.model.joints.size(); ++k)
      add_edge(k);
    if (!a_.errors.empty()) return;
    check_loops();
    if (!a_.errors.empty()) return;
    std::vector<unsigned char> done(edges_.size(), 0);
    for (std::size_t k = 0; k < edges_.size(); ++k)
      if (!done[k]) grow(root_of(k), done);
    for (std::size_t k = 0; k < edges_.size(); ++k)
      a_.built.joints.push_back(std::move(results_[k]));
  }

 private:
  static constexpr Index ground = -1;
  struct Edge {
    const Joint* joint;
    Index at, to;  ///< nodes; to may be the ground
    double at_offset, to_offset;
  };

  void error(const Joint& j, const char* code, const std::string& message, std::string hint = {}) {
    a_.error(code, fmt::format("{}: {}", joint_name(j), message), std::move(hint), j,
             joint_name(j));
  }

  void list_held() {
    for (std::size_t i = 0; i < a_.model.bearings.size(); ++i) {
      const model::Bearing& b = a_.model.bearings[i];
      const auto* law = std::get_if<model::RigidSupport>(&b.law);
      if (!law || b.to) continue;
      const meshes::Place p = a_.mesh.bearings[i].shaft;
      for (std::size_t c = 0; c < 6; ++c)
        if (law->held[c] && (c >= 3 || !b.pedestal))
          hold(p.node, c < 3 && p.offset != 0.0 && c > 0 ? (c == 1 ? 5 : 4) : c,
               fmt::format("bearing '{}'", b.name));
    }
    for (const model::Drive& d : a_.model.drives)
      if (a_.acts(d) && std::holds_alternative<model::PrescribedSpin>(d.law))
        hold(a_.mesh.place(d.at).node, system::spin_phi, fmt::format("drive '{}'", d.name));
  }
  void hold(Index node, std::size_t component, std::string who) {
    std::string& holder = held_[node][component];
    if (holder.empty()) holder = std::move(who);
  }

  void add_edge(std::size_t k) {
    const Joint& j = a_.model.joints[k];
    const meshes::Place at = a_.mesh.place(j.at);
    const meshes::Place to = j.to ? a_.mesh.place(*j.to) : meshes::Place{ground, 0.0};
    if (at.node == to.node) {
      error(j, "E26", "both its places are one rigid stretch of a line",
            "a joint connects two lines, or a line with the ground");
      return;
    }
    edges_.push_back({&j, at.node, to.node, at.offset, to.offset});
    results_.emplace_back();
    for (const Index n : {at.node, to.node})
      at_node_[n].push_back(edges_.size() - 1);
  }

  /// A joint that meets a way there is already.
  void check_loops() {
    std::map<Index, Index> group;
    const auto root = [&](Index n) {
      while (group.count(n) && group[n] != n)
        n = group[n];
      return n;
    };
    std::vector<std::size_t> before;
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      const Edge& e = edges_[k];
      const Index a = root(e.at), b = root(e.to);
      if (a != b) {
        group[a] = b;
        if (!group.count(b)) group[b] = b;
        before.push_back(k);
        continue;
      }
      std::vector<std::size_t> way;
      find_way(e.at, e.to, before, way);
      report_loop(e, way);
    }
  }
  bool find_way(Index from, Index to, const std::vector<std::size_t>& use,
                std::vector<std::size_t>& way) const {
    if (from == to) return true;
    for (const std::size_t k : use) {
      if (std::find(way.begin(), way.end(), k) != way.end()) continue;
      const Edge& e = edges_[k];
      if (e.at != from && e.to != from) continue;
      way.push_back(k);
      if (find_way(e.at == from ? e.to : e.at, to, use, way)) return true;
      way.pop_back();
    }
    return false;
  }
  void report_loop(const Edge& e, const std::vector<std::size_t>& way) {
    // small motions: the loop's joints against the rigid motions of the parts between them
    const Index n = static_cast<Index>(way.size());
    const auto place = [this](const Joint& j) -> const Vec3& {
      return a_.mesh.station(j.at).position;
    };
    double size = 0;
    for (const std::size_t k : way)
      size = std::max(size, (place(*edges_[k].joint) - place(*e.joint)).norm());
    if (!(size > 0)) size = 1.0;
    MatX A = MatX::Zero(6 * (n + 1), 6 * n);
    std::string names;
    Index wanted = 0;
    const auto put = [&](Index row, const Joint& j, Index first, Index second) {
      const MatX rows = constraint_rows(j, place(j), place(*e.joint), size);
      wanted += rank_of(rows);
      if (first >= 0) A.block(6 * row, 6 * first, 6, 6) += rows;
      if (second >= 0) A.block(6 * row, 6 * second, 6, 6) -= rows;
    };
    for (Index k = 0; k < n; ++k) {
      const Joint& j = *edges_[way[static_cast<std::size_t>(k)]].joint;
      put(k, j, k, k - 1);
      names += fmt::format("{}'{}'", k == 0 ? "" : k + 1 == n ? " and " : ", ", j.name);
    }
    put(n, *e.joint, n - 1, -1);
    const Index rank = rank_of(A);
    std::string verdict;
    if (rank == 6 * n) verdict += "; they lock";
    if (rank < wanted) verdict += fmt::format("; {} held more than once", wanted - rank);
    error(*e.joint, "E40",
          fmt::format("it closes a loop of rigid parts with {} {}: {} directions held, {} of them "
                      "independent, of {} motions{}",
                      n == 1 ? "joint" : "joints", names, wanted, rank, 6 * n, verdict),
          "at one place one joint is enough for two lines; a linkage needs one line in its loop "
          "that deforms, with places of its joints on elements and not on one rigid stretch");
  }

  Index root_of(std::size_t start) const {
    std::vector<Index> seen{edges_[start].at};
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (seen[i] == ground) continue;
      for (const std::size_t k : at_node_.at(seen[i]))
        for (const Index n : {edges_[k].at, edges_[k].to})
          if (std::find(seen.begin(), seen.end(), n) == seen.end()) seen.push_back(n);
    }
    if (std::find(seen.begin(), seen.end(), ground) != seen.end()) return ground;
    for (const Index n : seen)
      if (held_.count(n)) return n;
    return edges_[start].to;
  }

  void grow(Index root, std::vector<unsigned char>& done) {
    std::vector<Index> open{root};
    for (std::size_t i = 0; i < open.size(); ++i)
      for (const std::size_t k : at_node_[open[i]]) {
        if (done[k]) continue;
        done[k] = 1;
        const Index child = edges_[k].at == open[i] ? edges_[k].to : edges_[k].at;
        join(k, open[i], child);
        open.push_back(child);
      }
  }

  Index ghost(const Vec3& place, const std::string& who) {
    return a_.builder.add_node({place, a_.builder.add_line(who), "centre of " + who, false});
  }
  Index scalar(const Joint& j, const char* what) {
    if (line_ < 0) line_ = a_.builder.add_line("joints");
    return a_.builder.add_node(
        {Vec3::Zero(), line_, fmt::format("{} of {}", what, joint_name(j)), true});
  }

  /// `child` follows `parent` by the joint.
  void join(std::size_t k, Index parent, Index child) {
    const Edge& e = edges_[k];
    const Joint& j = *e.joint;
    const std::string who = joint_name(j);
    const bool from_at = parent == e.at;
    if (!check_held(j, child)) return;
    const double parent_offset = from_at ? e.at_offset : e.to_offset,
                 child_offset = from_at ? e.to_offset : e.at_offset;
    if (parent == ground) {
      parent = a_.builder.add_ground(a_.mesh.station(j.at).position, "ground of " + who);
    } else if (parent_offset != 0.0) {
      const Index end = ghost(a_.builder.node(parent).position + Vec3(parent_offset, 0, 0), who);
      follow({end, parent, false, -1, -1, Vec3::UnitX(), who, true});
      parent = end;
    }
    Index last = child;
    if (child_offset != 0.0) {
      last = ghost(a_.builder.node(child).position + Vec3(child_offset, 0, 0), who);
    }
    JointResult& out = results_[k];
    out.name = j.name;
    const double sense = from_at ? -1.0 : 1.0;  // of 'at' against the other
    switch (j.kind) {
      case JointKind::rigid:
        follow({last, parent, false, -1, -1, Vec3::UnitX(), who, last != child});
        break;
      case JointKind::spherical:
        follow({last, parent, true, -1, -1, Vec3::UnitX(), who, last != child});
        break;
      case JointKind::hinge:
        out.angles = {scalar(j, "angle")};
        follow({last, parent, false, out.angles[0], -1, sense * j.axis, who, last != child});
        break;
      case JointKind::slider:
        out.slide = scalar(j, "slide");
        follow({last, parent, false, -1, out.slide, sense * j.axis, who, last != child});
        break;
      case JointKind::universal: {
        out.angles = {scalar(j, "angle"), scalar(j, "second angle")};
        const Index cross = ghost(a_.builder.node(last).position, who);
        const std::size_t inner = from_at ? 0 : 1;
        const Vec3 axes[2] = {sense * j.axis, sense * j.second_axis};
        follow({cross, parent, false, out.angles[inner], -1, axes[inner], who, true});
        follow(
            {last, cross, false, out.angles[1 - inner], -1, axes[1 - inner], who, last != child});
        break;
      }
    }
    if (last != child) follow({child, last, false, -1, -1, Vec3::UnitX(), who});
    add_spring(j, out);
    add_load(e, last, sense, out);
  }
  void follow(system::FollowerDef d) { a_.builder.add_follower(std::move(d)); }

  /// Nothing of a node that follows may be held.
  bool check_held(const Joint& j, Index child) {
    const auto held = held_.find(child);
    if (held == held_.end()) return true;
    constexpr const char* names[] = {"x", "y", "z", "rx", "ry", "rz"};
    for (std::size_t c = 0; c < 6; ++c) {
      if (held->second[c].empty() || (j.kind == JointKind::spherical && c >= 3)) continue;
      error(j, "E40",
            fmt::format("{} is held along {} by {} as well", a_.builder.node(child).name, names[c],
                        held->second[c]),
            "release that direction of the support, or hold the other line there");
      return false;
    }
    return true;
  }

  void add_spring(const Joint& j, const JointResult& out) {
    if (j.stiffness == 0 && j.damping == 0) return;
    const Index node = out.slide >= 0 ? out.slide : out.angles[0];
    elements::TranslationalBearing spring{};
    spring.K(0, 0) = j.stiffness;
    spring.C(0, 0) = j.damping;
    a_.builder.add(spring,
                   {node, a_.builder.add_ground(Vec3::Zero(), "ground of " + joint_name(j))},
                   "linear bearings");
  }

  /// The load on the line of 'at', about its place.
  void add_load(const Edge& e, Index last, double sense, JointResult& out) {
    const auto force = [last, sense](const ReactionAt& r) {
      return Vec3(sense * Vec3(r(6 * last), r(6 * last + 1), r(6 * last + 2)));
    };
    out.force = [force](const NodeAt&, const system::Context&, const ReactionAt& r) {
      return force(r);
    };
    if (e.joint->kind == JointKind::spherical) return;
    const Vec3 between = a_.builder.node(last).position - a_.builder.node(e.at).position;
    out.moment = [force, last, sense, between, at = e.at, offset = e.at_offset](
                     const NodeAt& node, const system::Context&, const ReactionAt& r) {
      const Vec3 of_last(r(6 * last + 3), r(6 * last + 4), r(6 * last + 5));
      const Vec3 arm = between + node(last).u - node(at).u - offset * node(at).d();
      return Vec3(sense * of_last + arm.cross(force(r)));
    };
  }

  Assembly& a_;
  std::vector<Edge> edges_;
  std::vector<JointResult> results_;
  std::map<Index, std::vector<std::size_t>> at_node_;
  std::map<Index, std::array<std::string, 6>> held_;
  Index line_ = -1;
};

}  // namespace

void add_joints(Assembly& a) {
  if (!a.model.joints.empty()) Joints(a).run();
}

}  // namespace whirl::assembly
