// Flexible coupling between the hubs of two shaft lines (nodes 0 and 1), 6 x 6, with stiffness and
// damping that turn with it.
//
// Relative motion of the hubs less the misalignment, q = (x, y, z, tau_y, tau_z): displacement u_0
// - u_1 + o and difference of the axes d_0 - d_1 + alpha in fixed axes (o, alpha: parallel and
// angular misalignment of the hubs as assembled, fixed in space), and the twist theta = phi_0 -
// phi_1 with whole turns. In the frame turning with psi = (phi_0 + phi_1)/2,
//   p = (x, r', theta, t'),   r' = R(-psi)(y, z),
//       t' = R(-psi)(tilt about y, tilt about z) = R(-psi)(-tau_z, tau_y),
//   V = 1/2 p^T K p,   generalized force J^T (K p + C p'),  J = dp/d(nodes):
// the order of K and C is (x, y, z, rx, ry, rz). Conservative but for C (rotating, internal
// damping: it drives forward whirl above the critical speed). With K_yy != K_zz a misaligned
// coupling shakes at twice the spin; isotropic ones pass a constant load. A coupling whose
// stiffness stands still (or is isotropic and undamped) is a LinearBearing, which is cheaper.
// Limits: tilts small (sines for angles). Source: Gibbons, Proc. 5th Turbomachinery Symp. (1976),
// doi 10.21423/R1S94W, for the action of misalignment.
#pragma once
#include <system/kernel.hpp>

namespace whirl::elements {

struct ShaftCoupling {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr bool has_M = false, has_C = true, has_K = true;
  static constexpr system::Family family = system::Family::support;
  /// Sees each angle unless it is the same all round; its twist in any case.
  system::Dependence depends(const system::Context& c) const;

  Matrix<6> K = Matrix<6>::Zero(), C = Matrix<6>::Zero();  ///< N/m, N/rad, N m/rad; turning axes
                                                           ///< (x, y, z, rx, ry, rz), symmetric
  Vec3 offset = Vec3::Zero();                              ///< o, m
  Vec2 angle = Vec2::Zero();                               ///< alpha in (y, z), rad

  void add_force(const system::Nodes<2>& x, const system::Context&, system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context&,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context&, system::Energy& e) const;
};

}  // namespace whirl::elements
