#include <assembly/mass_shares.hpp>

#include <assembly/element_section.hpp>
#include <assembly/node_inertia.hpp>

#include <algorithm>
#include <cmath>

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
  for (const meshes::Line& line : a.mesh.lines) {
    const auto elements = element_inertias(a.model, a.mesh, line),
               bodies = body_inertias(a.model, a.mesh, line);
    const auto part = [](double own, double other) {
      return other > 0 ? own / (own + other) : 1.0;
    };
    for (std::size_t i = 0; i < elements.size(); ++i)
      of_[static_cast<std::size_t>(line.first_node) + i] = {part(elements[i].mass, bodies[i].mass),
                                                            part(elements[i].Id, bodies[i].Id),
                                                            part(elements[i].Ip, bodies[i].Ip)};
  }
  for (const model::Joint& j : a.model.joints) {
    if (!j.to || !joined_at_angle(a.model, j.at.shaft, j.at.s)) continue;
    for (const model::Location& place : {j.at, *j.to})
      of_[static_cast<std::size_t>(a.mesh.place(place).node)].tail<2>().setZero();
  }
  // Of the force of a bearing nothing is inertia, and half an element's mass is little beside it:
  // 0. Where it is stiffer than the element it hardly moves, and 1 gives the better force.
  for (std::size_t i = 0; i < a.model.bearings.size(); ++i) {
    const model::SupportTraits law = model::traits_of(a.model.bearings[i].law);
    const model::NodeLoads& loads = law.loads;
    for (const Index node : {a.mesh.bearings[i].shaft.node, a.mesh.bearings[i].other.node}) {
      if (node < 0 || node >= static_cast<Index>(of_.size())) continue;
      const double k = stiffness_of(law), element = k > 0 ? stiffness_at(a, node) : 1.0;
      of_[static_cast<std::size_t>(node)].array() *=
          Vec3(loads.lateral ? k / (k + element) : 1, loads.tilting ? 0 : 1, loads.torque ? 0 : 1)
              .array();
    }
  }
}

}  // namespace whirl::assembly
