// General rigid body on one node: offset mass centre, any inertia tensor (skewed disk, asymmetric
// rotor, free body).
//
// Points of the body are linear in its axes b_1 = d, b_2, b_3 (body_vector.hpp), so its energy has
// constant coefficients:
//   T = axisymmetric part (rigid_disk.hpp, with Jp = J_11, Jt = (J_22 + J_33)/2 and the axial
//       offset)
//     + u'.sum_k S_k b_k' + 1/2 sum_kl G_kl b_k'.b_l',   S_k = m eps_k (k = 2, 3),
//         G = m (eps eps^T)_offaxis - J'
// with J' = J - diag(Jp, Jt, Jt) (trace zero, hence the plain minus). Lagrange's equations, every
// derivative closed:
//   f_u = sum_k S_k b_k'',   f_(d,phi) = sum_k (db_k/d(d,phi))^T y_k,
//       y_k = S_k (u'' - g) + sum_l G_kl b_l''
// What turns with phi is only the deviation from axial symmetry, so that an almost symmetric body
// spinning fast loses no digits. mass kg; offset eps of the mass centre from the node, m, and
// inertia J about the mass centre, kg m2, both in body axes (along d, b_2, b_3), which at phi = 0,
// gamma = 0 are the chart's (e, e2, e3).
#pragma once
#include <elements/rigid/rigid_disk.hpp>

namespace whirl::elements {

struct RigidBody {
  static constexpr int n_nodes = 1, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true,
                        inertial = true, powerless = true, linear_in_displacements = true;
  static constexpr system::Family family = system::Family::body;
  /// Sees the angle unless the body is axisymmetric.
  system::Dependence depends(const system::Context& c) const;

  RigidDisk disk;
  Vec2 S = Vec2::Zero();  ///< static moments about b_2, b_3, kg m
  Mat3 G = Mat3::Zero();  ///< kg m2, symmetric, G_11 = 0

  RigidBody() = default;
  /// @throws Error if mass < 0, J not symmetric or no body has it (a principal moment above the sum
  /// of the others).
  RigidBody(double mass, const Vec3& offset, const Mat3& J);

  void add_force(const system::Nodes<1>& x, const system::Context& c, system::ForceX<7>& f) const;
  void add_tangent(const system::Nodes<1>& x, const system::Context& c,
                   system::TangentX<7>& t) const;
  void add_energy(const system::Nodes<1>& x, const system::Context& c, system::Energy& e) const;
  system::RigidInertia inertia(double time) const;
};

/// Inertia of an axisymmetric disk whose axis is tilted by `skew` (rad) from the shaft's towards
/// body angle `phase` (rad).
Mat3 skewed_inertia(double Jp, double Jt, double skew, double phase);

}  // namespace whirl::elements
