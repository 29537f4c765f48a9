#include <assembly/node_inertia.hpp>
#include <core/contract.hpp>

#include <assembly/element_section.hpp>
#include <meshes/mass_properties.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::assembly {

double NodeInertia::carries() const { return carries_with(*this); }

double NodeInertia::carries_with(const NodeInertia& other) const {
  return std::sqrt(mass * std::min(other.Id, other.Ip));
}

std::vector<NodeInertia> element_inertias(const model::Model& model, const meshes::Mesh& mesh,
                                          const meshes::Line& line) {
  WHIRL_EXPECTS(line.nodes > 0);
  std::vector<NodeInertia> out(static_cast<std::size_t>(line.nodes));
  for (Index i = line.first_element; i < line.first_element + line.elements; ++i) {
    const meshes::Element& e = mesh.elements[static_cast<std::size_t>(i)];
    const double h = 0.5 * (e.s2 - e.s1);
    NodeInertia half;
    const model::Section& section =
        model.shafts[static_cast<std::size_t>(e.line)].sections[e.section];
    if (const auto& g = section.general) {
      const double rho = model.materials.at(section.material).rho;
      half.mass = h * (rho * g->A + section.added_mass_per_length);
      half.Ip = h * rho * (g->Iy + g->Iz);
      half.Id = section.rotary_inertia ? h * rho * std::min(g->Iy, g->Iz) : 0.0;
    } else {
      const elements::SectionProperties p = element_section(model, e).at(0.5);
      half = {h * p.rhoA, h * p.rhoI, h * p.rhoIp};
    }
    half.Id += half.mass * h * h / 13.0;  // of the translation shapes: rhoA l^3/105 an end
    for (const Index node : {e.left.node, e.right.node})
      out[static_cast<std::size_t>(node - line.first_node)] += half;
  }
  return out;
}

std::vector<NodeInertia> body_inertias(const model::Model& model, const meshes::Mesh& mesh,
                                       const meshes::Line& line) {
  WHIRL_EXPECTS(line.nodes > 0);
  std::vector<NodeInertia> out(static_cast<std::size_t>(line.nodes));
  const auto add = [&](Index node, const NodeInertia& what) {
    const Index k = node - line.first_node;
    if (k >= 0 && k < line.nodes) out[static_cast<std::size_t>(k)] += what;
  };
  for (const meshes::RigidPart& r : mesh.rigid_parts) {
    const meshes::MassProperties p = meshes::section_mass(
        model, model.shafts[static_cast<std::size_t>(r.line)].sections[r.section],
        Vec3(r.o1, 0, 0));
    add(r.node, {p.mass, p.Id(), p.Ip()});
  }
  for (const model::Disk& d : model.disks)
    add(mesh.place(d.at).node,
        {d.mass, d.inertia ? std::min((*d.inertia)(1, 1), (*d.inertia)(2, 2)) : d.Id,
         d.inertia ? (*d.inertia)(0, 0) : d.Ip});
  return out;
}

std::vector<NodeInertia> node_inertias(const model::Model& model, const meshes::Mesh& mesh,
                                       const meshes::Line& line) {
  std::vector<NodeInertia> out = element_inertias(model, mesh, line);
  const std::vector<NodeInertia> bodies = body_inertias(model, mesh, line);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] += bodies[i];
  return out;
}

}  // namespace whirl::assembly
