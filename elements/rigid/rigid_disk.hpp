// Axisymmetric rigid disk: one node, seven coordinates.
//   T = 1/2 m |u' + z d'|^2 + 1/2 Jt |d'|^2 + 1/2 Jp s^2,   s = omega.d = phi' - w.d',
//       w = (e x d)/(1 + e.d)
// Lagrange's equations (f = left side; gravity stands in the acceleration u'' - g):
//   f_u = m (u'' + z d''),   f_d = m z (u'' + z d'') + Jt d'' - Jp s' w - Jp s d x d',
//       f_phi = Jp s'
// Nothing contains phi. m kg; Jt (transverse) and Jp (polar) about the mass centre, kg m2; z: mass
// centre from the node along d, m. Source of the kinematics: doi 10.18698/2308-6033-2018-10-1815,
// eq. (11).
#pragma once
#include <system/kernel.hpp>
#include <system/rigid_inertia.hpp>

namespace whirl::elements {

struct RigidDisk {
  static constexpr int n_nodes = 1, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = true, has_C = true, has_K = true, inertial = true,
                        quadratic_in_rates = true, powerless = true, linear_in_displacements = true;
  static constexpr system::Family family = system::Family::body;
  static constexpr system::Dependence depends{.spin = true, .weight = true};

  double mass = 0, Jt = 0, Jp = 0, offset = 0;

  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const;
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const;
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const;
  /// Mass, static moment and inertia about the node, body axes (d, b2, b3).
  system::RigidInertia inertia(double time) const;
};

}  // namespace whirl::elements
