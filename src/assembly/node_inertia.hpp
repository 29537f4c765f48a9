// What is joined at each node of a line: its bodies and half of each of its elements.
#pragma once
#include <meshes/mesh.hpp>
#include <model/model.hpp>
#include <vector>

namespace whirl::assembly {

struct NodeInertia {
  double mass = 0, Id = 0, Ip = 0;  ///< kg, kg m2 about the node
  double carries() const;           ///< sqrt(mass min(Id, Ip)), kg m: an unbalance must be less
  /// With the direction of another node.
  double carries_with(const NodeInertia& other) const;
  NodeInertia& operator+=(const NodeInertia& o) {
    return mass += o.mass, Id += o.Id, Ip += o.Ip, *this;
  }
};

/// Of the elements alone, node by node. Sums over the elements of the line.
std::vector<NodeInertia> element_inertias(const model::Model& model, const meshes::Mesh& mesh,
                                          const meshes::Line& line);
/// Of the bodies alone: disks and rigid sections.
std::vector<NodeInertia> body_inertias(const model::Model& model, const meshes::Mesh& mesh,
                                       const meshes::Line& line);
/// Both.
std::vector<NodeInertia> node_inertias(const model::Model& model, const meshes::Mesh& mesh,
                                       const meshes::Line& line);

}  // namespace whirl::assembly
