// General beam element: unequal principal stiffnesses, any direction, initial curvature and twist,
// rigid end offsets. For keyed or slotted shafts (it turns with phi), bowed rotors, curved lines,
// frames and casings.
//
// Each end carries an orthonormal triad (D, B, C) fixed to its node, D along the element, B and C
// the principal axes, and a rigid offset: r_i = x_i + R_i o_i. With the chord a = (r2 - r1)/l and
// the twistless transport P(a <- D_i):
//   p_i      vector from a towards D_i, perpendicular to a, |p_i| = angle between them
//   y, z     section axes at mid-element: bisector of the transported B1, B2, and a x y
//   psi
//       angle from transported B1 to transported B2 about a, in (-pi, pi], and the area between the
//       bent element and its chord, which lifts
//            the torsion of space curves from order 2 to 4: - 1/2 a.(p1 x p2) - length^2/12 a.(m x
//                k)
//   V = 1/2 EA_l w^2 + 1/2 sum_ij [kz_ij (p_i - p0_i).y (p_j - p0_j).y + ky_ij (p_i - p0_i).z (p_j
//       - p0_j).z] + 1/2 GJ_l (psi - psi0)^2
//       + P w,   w = l - l0 + length/2 sum_ij b_ij (p_i.p_j - p0_i.p0_j),   N = P + EA_l w
// with the mean curvature m = (p2 - p1)/length and its change from end to end k = 6/((1 + Phi)
// length) (p1 + p2), each plane with its own Phi. Inside the element, x = xi - 1/2, curvatures are
// m + k x (m^e + k^e x those of the deformation; EIa for bending along y, EIb along z), and the
// sections turn by alpha against y, z. That costs alpha c + 1/2 alpha^2 s per length, with
//   c(x) = EIa k_z k^e_y - EIb k_y k^e_z = c0 + c1 x + c2 x^2,
//       s(x) = EIa (k_z^2 - k_y k^e_y) + EIb (k_y^2 - k_z k^e_z) = s0 + s1 x + s2 x^2
// and torque and shear: T' = -c, M_y' = Q_y - x_y, x_y = t/length (EIa m_z - EIb m^e_z) + T m_z,
// x_z = t/length (EIa m^e_y - EIb m_y) - T m_y, Q' = -m N. alpha is t x, t = psi - psi_r, and a
// parabola 1 - 4 x^2 by as much as makes the energy least. Terms that keep order 4 for unequal
// stiffnesses, initial curvature, and shear:
//   V += length/12 [t c1 + 1/2 t^2 (s0 + 3/20 s2)] - 3/32 length^3 (2/3 c0 + 1/30 (c2 + t
//       s1))^2/(GJ + length^2 (s0/10 + s2/280))
//      - length^3/24 [phi_a x_y^2/EIa + phi_b x_z^2/EIb + g_a m_y^2/kGA_a + g_b m_z^2/kGA_b],
//          g = N^2/(1 + N/kGA),   phi = Phi/(1 + Phi)
// The first line is the integral of a square, 1/2 EIa (k^e_y + alpha k_z)^2 + .., with alpha
// condensed: it never takes more than bending and torsion hold. To leading order it is c0^2/GJ and
// t^2 s0 alone, but in a strip bent the soft way length^2 s is far above GJ, and these would make
// the stiff plane negative. psi_r = psi0 where the element is curved at rest, else 0. (What the
// inside gains: each slope costs 1/24 length^3 stiffness slope^2; a slope of the curvature that no
// end moment makes is held back by its own shear, which leaves Phi/(1 + Phi). Without shear in it
// the last line leaves an error of 1/2 T^2 m^2/kGA per length on all meshes.)
// The force is found from the power of the stresses on objective rates, p_i o = (p_i')_perp - sigma
// a x p_i and psi' = sigma2 - sigma1, sigma_i = (a + D_i).(omega_i - a x a')/(1 + a.D_i), which are
// exactly the rates of the measures above. The betas damp the same rates (viscous,
// rotating with the section).
// Inertia: M4 (x) 1 on (r1, D1, r2, D2), with the smaller rotary inertia on the static shape
// (timoshenko_matrices.hpp); what is left of the rotary and the polar inertia on the triads, 1/2
// sum_ij (m_ij^D D_i'.D_j' + m_ij^B B_i'.B_j' + m_ij^C C_i'.C_j') (triad_inertia.hpp). Exact for
// every rigid motion.
//
// The tangent is by forward differentiation (core/dual.hpp): exact, about ten times the cost of the
// axisymmetric element. Units SI. Limits: relative twist of one element below pi; angle between
// chord and D below pi; small strain. Source of the corotational idea with transported triads:
// Battini & Pacoste 2002, doi 10.1016/S0045-7825(01)00352-8.
#pragma once
#include <elements/shaft/triad_inertia.hpp>
#include <system/kernel.hpp>

namespace whirl::system {
template <int W>
struct StiffnessRateX;
}

namespace whirl::elements {

struct GeneralBeamConstants {
  double length = 0;          ///< m, arc length used in stiffness and mass
  double EA_l = 0, GJ_l = 0;  ///< N/m, N m
  /// End stiffnesses for deflection along the section's y (bending about z: EIz) and along z (EIy),
  /// N m.
  double ky_def11 = 0, ky_def12 = 0, ky_def22 = 0, kz_def11 = 0, kz_def12 = 0, kz_def22 = 0;
  double b11 = 0, b12 = 0, b22 = 0;  ///< bowing coefficients
  Matrix<4> M4 = Matrix<4>::Zero();  ///< inertia on (r1, D1, r2, D2): translation, and the smaller
                                     ///< rotary inertia; kg, kg m, kg m^2
  TriadInertia triads;               ///< the rest; no products: B and C are principal axes
  double beta = 0;                   ///< stiffness-proportional damping of bending, rotating, s
  double beta_twist = 0;             ///< the same of the twist, s
  double beta_axial = 0;             ///< and of the length of the chord, s
  bool damped() const { return beta > 0.0 || beta_twist > 0.0 || beta_axial > 0.0; }
  double alpha = 0;  ///< mass-proportional damping, 1/s: of the velocities of the beam's own mass
};

struct GeneralBeam {
  static constexpr int n_nodes = 2, width = 7;
  static constexpr system::Axes axes = system::Axes::any;
  static constexpr bool has_M = true, has_C = true, has_K = true, quadratic_in_rates = true;
  static constexpr system::Family family = system::Family::shaft;
  /// Sees the angle unless it is axisymmetric; its twist in any case.
  system::Dependence depends(const system::Context&) const {
    return {.angle = axisymmetric() ? system::twist_angle : system::each_angle,
            .spin = true,
            .weight = true};
  }

  GeneralBeamConstants c;
  Vec3 chord = Vec3::UnitX();  ///< r2 - r1 in the reference configuration, m
  Mat3 triad1 = Mat3::Identity(),
       triad2 = Mat3::Identity();  ///< columns D, B, C of each end in the reference configuration
  Vec3 offset1 = Vec3::Zero(), offset2 = Vec3::Zero();  ///< o_i in the reference configuration, m
  Mat3 body1 = Mat3::Identity(),
       body2 = Mat3::Identity();  ///< the same triads and offsets in components of the nodes'
                                  ///< charts at rest
  Vec3 arm1 = Vec3::Zero(), arm2 = Vec3::Zero();
  double preload = 0;  ///< axial force at w = 0, N, tension positive
  double psi_r = 0;    ///< twist at which the section axes do not turn inside the element, rad
  // unstressed values of the measures (made by the constructor)
  double l0 = 0, psi0 = 0;
  Vec2 p01 = Vec2::Zero(), p02 = Vec2::Zero();

  GeneralBeam() = default;
  /// The reference configuration is stress-free, whatever the angles between chord and triads.
  /// chart1, chart2: triads of the nodes' lines as given to the builder. The nodes may be on
  /// different lines; charts may be moved.
  /// @pre positive length, chord not zero.
  GeneralBeam(const GeneralBeamConstants& constants, const Vec3& chord, const Mat3& triad1,
              const Mat3& triad2, const Vec3& offset1 = Vec3::Zero(),
              const Vec3& offset2 = Vec3::Zero(), const Mat3& chart1 = Mat3::Identity(),
              const Mat3& chart2 = Mat3::Identity());

  /// Nothing in it tells one direction across the axes of its nodes from another.
  bool axisymmetric() const;

  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
  /// Force and stiffness and their derivatives along a motion (system/stiffness_rate.hpp), exact.
  void add_stiffness_rate(const system::Nodes<2>& x, const system::Nodes<2>& rate,
                          const system::Context& ctx, system::StiffnessRateX<14>& out) const;
};

}  // namespace whirl::elements
