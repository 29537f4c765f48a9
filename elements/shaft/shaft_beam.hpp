// Corotational Timoshenko shaft element, axisymmetric section: two nodes of one shaft line,
// directors d_i and chart axis e.
//
// Frame-free: with the chord a = (r2 - r1)/l (r_i = x_i + o_i d_i), delta_i = d_i - a, everything
// elastic is a function of
//   l,   n_i = |delta_i|^2/2 = 1 - cos theta_i,   m = delta_1.delta_2,   tau = a.(d1 x d2),
//       phi2 - phi1   and two solid angles:
//   theta_i^2 = F(n_i),   G(n) = theta/sin theta,   th1.th2 = S = G1 G2 (m - n1 n2),
//       a.(th1 x th2) = G1 G2 tau
//   V = 1/2 EA_l w^2 + P w + 1/2 (k11 F1 + 2 k12 S + k22 F2) + 1/2 GJ_l psi^2 - 1/2 (q psi^2 + r
//       g(N)) |th2 - th1|^2,
//       N = P + EA_l w
//   w = l - length + length/2 (b11 F1 + 2 b12 S + b22 F2)   (bowing; tends to Engesser's column)
//   psi = phi2 - phi1 - [Omega(e,d1,a) + Omega(e,a,d2)] + tau_c G1 G2 tau - psi0
// q and r are what shear leaves of the element's inside. On a bent beam torque and axial force make
// moment and shear force vary, M' = -m T, Q' = -m N with the mean curvature m = |th2 - th1|/length,
// which the shape under end moments does not contain; given back to the inside, they soften it:
//   q = GJ^2/(12 EI length) Phi/(1 + Phi),   r = length/(12 kGA),   g = N^2/(1 + N/kGA),
//       below N = -kGA/2 (no shaft gets there) its parabola.
// Without them the energy is wrong by 1/2 m^2 T^2/kGA per length on every mesh of elements longer
// than the shaft is thick, and shear-soft columns converge with order 2; with them with order 4.
// The differences delta_i keep a tilt of 1e-12 rad to its last digits, where cosines would lose it.
// Nothing contains phi but psi, and psi is not wrapped: wind-up is unbounded. Rigid motion of any
// size leaves l, n, m, tau and psi unchanged.
//
// Inertia: T = 1/2 X'^T (M4 (x) 1) X' with the constant M4 of shaft_constants.hpp, X = (x1, d1, x2,
// d2); polar inertia 1/2 s^T polar s on the nodal spins s_i = omega_i . d_i; and what the inside of
// a bent element spins beside the straight line between s1 and s2 (s' along the shaft is the rate
// of twist less d.(d_s x d')), to first order in it:
//   T += (s1 + s2)/2 Gamma,
//   Gamma = b.(sum_ik S_ik delta_i x delta_k' - sum_i r_i delta_i x b'),   delta_i = d_i - b,
// b = (r2 - r1)/length the chord, which differs from a by the stretch. S, r make the gyroscopic couple
// of a nearly straight element the consistent one, of matrix G4 instead of the lumped row sums of
// polar (see bend_of), so that whirl frequencies converge at the order of the beam instead of
// Omega^2 h^2. Gamma does not see rigid motion, T is one function of
// the state: a free line keeps its energy, momentum and angular momentum however it is bent.
// Gravity and base motion enter through NodeState::ddu.
//
// Units SI. Limits: angle between chord and normal of one element below pi; axisymmetric sections;
// small strain. Sources: kinematics Sorokin & Zhang 2018, doi 10.18698/2308-6033-2018-10-1815;
// constants see timoshenko_matrices.hpp.
#pragma once
#include <elements/shaft/shaft_constants.hpp>
#include <system/kernel.hpp>
#include <span>

namespace whirl::system {
template <int W>
struct StiffnessRateX;
}

namespace whirl::elements {

/// One element. Offsets: o1 or o2 differ from zero (rigid lengths at its ends).
template <bool Offsets>
struct ShaftBeam {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::common;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true,
                        powerless = true;
  static constexpr system::Family family = system::Family::shaft;
  static constexpr system::Dependence depends{
      .angle = system::twist_angle, .spin = true, .weight = true};

  ShaftElementConstants c;
  Vector<5> bend = Vector<5>::Zero();  ///< S11, S12, S22, r1, r2 of Gamma, kg m^2
  double inverse = 0;                  ///< 1/length, 1/m
  Vec3 e0 = Vec3::UnitX();             ///< unit vector of the unstressed element, global axes
  double psi0 = 0;                     ///< twist at zero torque, rad
  double preload = 0;                  ///< axial force at w = 0, N, tension positive
  double soft_torque = 0;              ///< q, N m
  double soft_axial = 0;               ///< r, m/N
  double soft_shear = 0;               ///< 1/kGA, 1/N
  double soft_limit = -infinity;       ///< -kGA/2, N

  ShaftBeam() = default;
  /// @pre positive length, direction a unit vector.
  ShaftBeam(const ShaftElementConstants& constants, const Vec3& direction);

  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  /// All elements of a batch, several at a time (shaft_lanes.hpp): nodes[i] of element i index
  /// states and forces.
  static void add_forces(std::span<const ShaftBeam> elements, const std::array<Index, 2>* nodes,
                         const system::NodeState* states, const system::Context& ctx,
                         Vector<7>* force);
  /// The same for energies, added in the order of the elements.
  static void add_energies(std::span<const ShaftBeam> elements, const std::array<Index, 2>* nodes,
                           const system::NodeState* states, const system::Context& ctx,
                           system::Energy& e);
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
  /// Force and stiffness and their derivatives along a motion (system/stiffness_rate.hpp): that of
  /// the general beam with these constants.
  void add_stiffness_rate(const system::Nodes<2>& x, const system::Nodes<2>& rate,
                          const system::Context& ctx, system::StiffnessRateX<14>& out) const;

  /// Section resultants for results: axial force N (tension positive), torque, end moments (acting
  /// on the element at ends 1 and 2, global axes, N m) and the shear force it carries.
  struct Internal {
    double N, torque;
    Vec3 moment1, moment2, shear;
  };
  Internal internal(const system::Nodes<2>& x) const;
};

extern template struct ShaftBeam<false>;
extern template struct ShaftBeam<true>;

}  // namespace whirl::elements
