// How much of what moves and loads the nodes is the elements' own inertia: the share of
// elements/timoshenko_matrices.hpp.
#pragma once
#include <assembly/parts.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <vector>

namespace whirl::assembly {

/// A joint at s (m) of a line holds another line there that runs in another direction.
bool joined_at_angle(const model::Model& model, std::size_t line, double s);

/// Nodes that a joint makes one count together, so that a line cut and welded is the line.
class MassShares {
 public:
  explicit MassShares(const Assembly& a);
  elements::MassShare of(const meshes::Element& e) const {
    const Vec3 &a = node(e.left), &b = node(e.right);
    return {Vector<4>(a[0], a[1], b[0], b[1]), Vec2(a[2], b[2])};
  }

 private:
  void take_supports(const Assembly& a);
  const Vec3& node(const meshes::Place& p) const { return of_[static_cast<std::size_t>(p.node)]; }
  std::vector<Vec3> of_;  ///< (translation, rotation, spin) of each node
};

}  // namespace whirl::assembly
