#include <assembly/mass_shares.hpp>

#include <assembly/element_section.hpp>
#include <assembly/node_inertia.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace whirl::assembly {
namespace {

/// Mean lateral stiffness of a law that has a constant one, N/m; 0 for the rest.
double stiffness_of(const model::SupportTraits& t) {
  const auto& K = *t.stiffness;
  return K ? 0.5 * ((*K)(1, 1) + (*K)(2, 2)) : 0.0;
}

/// 12 EI/l^3 of the elements at a node, N/m.
double stiffness_at(const Assembly& a, Index node) {
  double sum = 0;
  for (const meshes::Element& e : a.mesh.elements) {
    if (e.left.node != node && e.right.node != node) continue;
    const model::Section& section =
        a.model.shafts[static_cast<std::size_t>(e.line)].sections[e.section];
    const double l = e.s2 - e.s1, EI = section.general
                                           ? a.model.materials.at(section.material).E *
                                                 std::min(section.general->Iy, section.general->Iz)
                                           : element_section(a.model, e).at(0.5).EI;
    sum += 12 * EI / (l * l * l);
  }
  return sum;
}

/// Nodes that joints of a kind, or kinds stiffer than it, make one.
class JointedNodes {
 public:
  /// kind: rigid for what moves and turns as one, spherical for what moves as one.
  JointedNodes(const Assembly& a, model::JointKind kind) {
    for (const model::Joint& j : a.model.joints) {
      // along a slide nothing is passed on, so that lines on a slider count apart
      const bool joins = j.kind == model::JointKind::rigid ||
                         (kind != model::JointKind::rigid && j.kind != model::JointKind::slider);
      if (j.to && joins && !j.arm)
        pairs_.emplace_back(a.mesh.place(j.at).node, a.mesh.place(*j.to).node);
    }
  }
  std::vector<Index> with(Index node) const {
    std::vector<Index> out{node};
    const auto take = [&](Index n) {
      if (std::find(out.begin(), out.end(), n) == out.end()) out.push_back(n);
    };
    for (std::size_t i = 0; i < out.size(); ++i)
      for (const auto& [a, b] : pairs_) {
        if (a == out[i]) take(b);
        if (b == out[i]) take(a);
      }
    return out;
  }

 private:
  std::vector<std::pair<Index, Index>> pairs_;
};

/// (mass, Id, Ip) of every node with those it is joined to: masses of all that moves with it, moments
/// of all that turns with it.
std::vector<Vec3> joined_inertias(const Assembly& a, const std::vector<NodeInertia>& own) {
  const JointedNodes moves(a, model::JointKind::spherical), turns(a, model::JointKind::rigid);
  std::vector<Vec3> out(own.size(), Vec3::Zero());
  for (std::size_t i = 0; i < own.size(); ++i) {
    for (const Index n : moves.with(static_cast<Index>(i)))
      out[i][0] += own[at(n)].mass;
    for (const Index n : turns.with(static_cast<Index>(i)))
      out[i].tail<2>() += Vec2(own[at(n)].Id, own[at(n)].Ip);
  }
  return out;
}

Vec3 tangent(const model::Shaft& shaft, double s) {
  return shaft.path.empty() ? Vec3(Vec3::UnitX()) : Vec3(shaft.path.after(s).triad.col(0));
}

}  // namespace

bool joined_at_angle(const model::Model& model, std::size_t line, double s) {
  return std::any_of(model.joints.begin(), model.joints.end(), [&](const model::Joint& j) {
    if (!j.to) return false;
    const bool here = j.at.shaft == line && std::abs(j.at.s - s) < 1e-9;
    const bool there = j.to->shaft == line && std::abs(j.to->s - s) < 1e-9;
    const Vec3 a = tangent(model.shafts[j.at.shaft], j.at.s),
               b = tangent(model.shafts[j.to->shaft], j.to->s);
    return (here || there) && a.cross(b).norm() > 1e-6;
  });
}

MassShares::MassShares(const Assembly& a) : of_(a.mesh.nodes.size(), Vec3(1, 1, 1)) {
  std::vector<NodeInertia> elements(of_.size()), bodies(of_.size());
  for (const meshes::Line& line : a.mesh.lines) {
    const auto first = [&](std::vector<NodeInertia>& all) { return all.begin() + line.first_node; };
    const auto of_elements = element_inertias(a.model, a.mesh, line),
               of_bodies = body_inertias(a.model, a.mesh, line);
    std::copy(of_elements.begin(), of_elements.end(), first(elements));
    std::copy(of_bodies.begin(), of_bodies.end(), first(bodies));
  }
  const std::vector<Vec3> beside = joined_inertias(a, bodies), own = joined_inertias(a, elements);
  for (std::size_t i = 0; i < of_.size(); ++i)
    for (Index c = 0; c < 3; ++c)
      if (beside[i][c] > 0) of_[i][c] = own[i][c] / (own[i][c] + beside[i][c]);
  for (const model::Joint& j : a.model.joints) {
    if (!j.to || !joined_at_angle(a.model, j.at.shaft, j.at.s)) continue;
    for (const model::Location& place : {j.at, *j.to})
      of_[at(a.mesh.place(place).node)].tail<2>().setZero();
  }
  take_supports(a);
}

void MassShares::take_supports(const Assembly& a) {
  // Of the force of a bearing nothing is inertia, and half an element's mass is little beside it:
  // 0. Where it is stiffer than the element it hardly moves, and 1 gives the better force.
  const JointedNodes together(a, model::JointKind::rigid);
  for (std::size_t i = 0; i < a.model.bearings.size(); ++i) {
    const model::SupportTraits law = model::traits_of(a.model.bearings[i].law);
    const model::NodeLoads& loads = law.loads;
    for (const Index node : {a.mesh.bearings[i].shaft.node, a.mesh.bearings[i].other.node}) {
      if (node < 0 || node >= static_cast<Index>(of_.size())) continue;
      const std::vector<Index> all = together.with(node);
      double element = 0;
      for (const Index n : all)
        element += stiffness_at(a, n);
      const double k = stiffness_of(law);
      if (!(k > 0)) element = 1.0;
      for (const Index n : all)
        of_[at(n)].array() *=
            Vec3(loads.lateral ? k / (k + element) : 1, loads.tilting ? 0 : 1, loads.torque ? 0 : 1)
                .array();
    }
  }
}

}  // namespace whirl::assembly
