// Isotropic spring block holding a point of the axis: translational spring C1 and tilt spring C2 to
// ground. One node.
//   V = 1/2 C1 |u + s (d - e0)|^2 + 1/2 C2 theta^2,  theta = angle(e0, d)
// i.e. force -C1 (r_a - r_a0) at the point r_a = u + s d and moment -C2 gamma with gamma the Euler
// vector of the axis tilt (Sorokin & Zhang 2018, doi 10.18698/2308-6033-2018-10-1815, section on
// the one-disk rotor). It resists no spin. C1 N/m; C2 N m/rad; s: point from the node along d, m;
// e0: undeformed axis, global. Limit: theta < pi.
#pragma once
#include <system/kernel.hpp>

namespace whirl::elements {

struct SpringBlock {
  static constexpr int n_nodes = 1, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = false, has_C = false, has_K = true, quadratic_in_rates = true,
                        powerless = true, linear_in_displacements = true;
  static constexpr system::Family family = system::Family::support;
  static constexpr system::Dependence depends{};

  double C1 = 0, C2 = 0, offset = 0;
  Vec3 e0 = Vec3::UnitX();

  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const;
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const;
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const;
  /// Displacement of the held point from its reference position, m.
  Vec3 displacement(const system::NodeState& n) const;
};

}  // namespace whirl::elements
