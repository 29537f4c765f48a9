// What the mass matrix of an element leaves out of its weight where a body shares one of its nodes
// (timoshenko_matrices.hpp): with it a line sags under gravity exactly as without the correction of
// its masses. Dead forces and, on the directors, dead couples
//   f_k = -rest_k g,   k = u1, d1, u2, d2.
// rest kg, kg m, kg, kg m: differences of order l^4; rest_1 + rest_3 = 0.
#pragma once
#include <system/kernel.hpp>
#include <array>
#include <span>

namespace whirl::elements {

struct WeightRest {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = false, has_C = false, has_K = false, quadratic_in_rates = true,
                        powerless = true, linear_in_displacements = true;
  static constexpr system::Family family = system::Family::load;
  static constexpr system::Dependence depends{.weight = true};

  Vector<4> rest = Vector<4>::Zero();

  void add_force(const system::Nodes<2>&, const system::Context& c, system::ForceX<14>& f) const {
    for (int k = 0; k < 4; ++k)
      f.segment<3>(k < 2 ? 3 * k : 1 + 3 * k) -= rest[k] * c.gravity;
  }
  /// The same for all elements at once: no state is needed.
  static void add_forces(std::span<const WeightRest> elements, const std::array<Index, 2>* nodes,
                         const system::NodeState*, const system::Context& c, Vector<7>* force) {
    for (std::size_t i = 0; i < elements.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k) {
        Vector<7>& f = force[nodes[i][k]];
        f.head<3>() -= elements[i].rest[static_cast<Index>(2 * k)] * c.gravity;
        f.segment<3>(3) -= elements[i].rest[static_cast<Index>(2 * k + 1)] * c.gravity;
      }
  }
  void add_tangent(const system::Nodes<2>&, const system::Context&, system::TangentX<14>&) const {}
  void add_energy(const system::Nodes<2>& x, const system::Context& c, system::Energy& e) const {
    e.gravity -= c.gravity.dot(rest[0] * x[0]->u + rest[1] * x[0]->d() + rest[2] * x[1]->u +
                               rest[3] * x[1]->d());
  }
};

}  // namespace whirl::elements
