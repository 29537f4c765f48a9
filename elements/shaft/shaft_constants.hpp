// The numbers of one straight axisymmetric shaft element, made once
// (elements/timoshenko_matrices.*) and read by the shaft kernels. Uniform or conical; all
// stiffnesses come from the exact static solution of a Timoshenko beam loaded at its ends.
//
// Kinematics. The element joins two end points r_i = x_i + o_i d_i, i = 1, 2: x_i the node
// position, d_i the node's director (unit section normal), o_i a constant offset along it (rigid
// lengths merged into the node). Chord a = (r2 - r1)/|r2 - r1|, th_i the rotation vector from a to
// d_i (or the vector of the same length from a towards d_i: only products of two of one kind
// occur). l = |r2 - r1|, length = its unstressed value.
#pragma once
#include <core/types.hpp>

namespace whirl::elements {

/// Aligned so that its numbers stand in the same places whatever alignment matrices have
/// (shaft_lanes.hpp).
struct alignas(32) ShaftElementConstants {
  double length = 0;  ///< unstressed length between the end points, m
  double o1 = 0;      ///< end point 1 = node 1 + o1 d1, m
  double o2 = 0;      ///< end point 2 = node 2 + o2 d2, m

  /// V_a = 1/2 EA_l (l - length + length e_b)^2; EA_l = 1/int ds/(EA), N/m.
  double EA_l = 0;
  /// Bowing strain e_b = 1/2 (b11 th1.th1 + 2 b12 th1.th2 + b22 th2.th2) = (1/length) int w'^2/2
  /// ds; dimensionless.
  double b11 = 0, b12 = 0, b22 = 0;
  /// V_b = 1/2 (k11 th1.th1 + 2 k12 th1.th2 + k22 th2.th2), N m.
  double k11 = 0, k12 = 0, k22 = 0;
  /// V_t = 1/2 GJ_l (psi - psi0)^2; GJ_l = 1/int ds/(GJ), N m.
  double GJ_l = 0;
  /// psi = phi2 - phi1 - [Omega(e,d1,a) + Omega(e,a,d2)] + tau_c a.(th1 x th2); 1/2 (1-Phi)/(1+Phi)
  /// when uniform.
  double tau_c = 0;

  /// T = 1/2 X'^T (M4 (x) 1_3) X', X = (x1, d1, x2, d2) node positions and directors (offsets o_i
  /// already inside): translation and transverse rotary inertia. kg, kg m, kg m^2. Symmetric; exact
  /// for rigid motion.
  Matrix<4> M4 = Matrix<4>::Zero();
  /// int rho I_p G G^T ds on the same X, where d(s) = sum G_k X_k: the spatially consistent
  /// gyroscopic inertia, kg m^2 (and kg m, kg: its rows 1 and 3 vanish only for rigid motion).
  /// Contracted with a rigid rotation it gives polar.sum().
  Matrix<4> G4 = Matrix<4>::Zero();
  /// T = 1/2 s^T polar s on the end spin rates (s1, s2): polar inertia, averaged of consistent and
  /// lumped ([5/12 1/12; 1/12 5/12] rho I_p length when uniform), kg m^2.
  Matrix<2> polar = Matrix<2>::Zero();

  double mass = 0;  ///< kg (= the sum of M4 entries 11, 13, 31, 33)
};

}  // namespace whirl::elements
