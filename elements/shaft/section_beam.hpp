// Beam element of any section: full symmetric 6x6 stiffness and mass per length, section axes that
// turn along it (pre-twist), initial curvature, offset ends. For composite and thin-walled beams,
// blades, and sections whose shear, elastic and mass centres lie apart.
//
// Each end carries an orthonormal triad (D, B, C), D along the element, B and C the section's y and
// z, and a rigid offset: r_i = x_i + R_i o_i. Section stresses sigma = (F, M) and strains (gamma,
// kappa) in these axes refer to the line of the r_i; S = stiffness^-1, per length.
//
// Kinematics. Relative rotation exp(theta) of the triads, mid triad R_m = R_1 exp(theta/2), and
//   u = g e + h (theta.e) theta,   e = R_m^T (r2 - r1),   g = (|theta|/2)/sin(|theta|/2),
//       h = (1 - g)/|theta|^2:
// d = (u, theta) is the screw that carries end 1 to end 2, length x strain where the strain is
// constant: circles and helices are exact, and a pre-twisted section has constant S and strain. For
// a strain m + k x, x in (-length/2, length/2), W. Magnus' expansion gives d = length m +
// length^3/12 [m, k] + length^5/240 [[m, k], k] (J. Sonneville, A. Cardona, O. Bruls 2014, doi
// 10.1016/j.cma.2013.10.008, for the element of constant strain).
//
// Energy. Equilibrium inside without loads is sigma' = -(kappa x F, kappa x M + (e1 + gamma) x F),
// so k = -S c/length, c = (theta x F, v x F + theta x M), v = length (e1 + gamma), and minimising
// over k leaves
//   V = 1/2 q.H^-1 q,   sigma = H^-1 q,   H = length S + length/12 B^T S B,   B sigma = c,
//   q = d - d0 + ((e1 a.a - a a.e1)/(240 length), 0),   v = u - (u0 - length e1) + e1 x a/12,
// a = -length^3 k_kappa to first order, a = P (d - d0). H is positive definite: V is
// bounded below whatever the shape. For a straight beam and small motion it is the exact stiffness
// of any beam loaded at its ends; energy and forces are of order 4 in large deformation. The last
// two are the shortening by the bow and the part of u that is bow and not shear: without them the
// order is the same, but slender elements are too stiff until they are short. Under axial force
// the element tends to Haringx's column (the axisymmetric one: Engesser's).
// Forces from dV: with y = S c,
//   dV/dd = sigma + P^T (..) - length/12 (F x y_kappa, F x y_gamma + M x y_kappa),
// on the rates e' = R_m^T (r2' - r1') - omega_m x e, theta' = G (omega2 - omega1), omega_m =
// (omega1 + omega2)/2 - j theta x (omega2 - omega1), G = g + h theta theta^T, j = tan(|theta|/4)/(2
// |theta|), all in the axes of R_m. Damping: a constant positive matrix on d'.
//
// Inertia: M8 (x) 1 on (r1, D1, B1, C1, r2, D2, B2, C2), exact for rigid motion: translation along
// the line of mass centres by the shape functions of timoshenko_matrices.hpp (mean of both planes;
// its tangents are the directors and what the twist about the shear centre adds), the smaller
// rotary inertia on the line of shear centres and its directors, the rest and the polar one on the
// triads (triad_inertia.hpp). Frequencies: order 4 where sections are slender or alike in both
// planes; coupling and unequal planes of thick elements leave a part of order 2 (the corrections of
// the translation are those of the mean plane), 1e-5 with 16 elements.
//
// Tangents by forward differentiation (core/dual.hpp). Units SI. Limits: relative rotation of the
// ends of one element below pi; small strain.
#pragma once
#include <core/section_matrices.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <elements/shaft/triad_inertia.hpp>
#include <system/kernel.hpp>

namespace whirl::system {
template <int W>
struct StiffnessRateX;
}

namespace whirl::elements {

struct SectionBeamConstants {
  double length = 0;                      ///< m, arc length
  Matrix<6> S = Matrix<6>::Zero();        ///< compliance per length
  Matrix<8> M8 = Matrix<8>::Zero();       ///< inertia of the header, kg, kg m, kg m^2
  Matrix<6> damping = Matrix<6>::Zero();  ///< on d', positive semi-definite
  double alpha = 0;                       ///< mass-proportional damping, 1/s
};

/// twist: angle of the section axes at the right end less that at the left, rad.
SectionBeamConstants make_section_constants(const FullSection& section, double length, double twist,
                                            MassKind kind = MassKind::corrected,
                                            const TriadShare& share = {});

struct SectionBeam {
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

  SectionBeamConstants c;
  Vec3 chord = Vec3::UnitX();  ///< r2 - r1 in the reference configuration, m
  Mat3 triad1 = Mat3::Identity(), triad2 = Mat3::Identity();  ///< columns D, B, C there
  Vec3 offset1 = Vec3::Zero(), offset2 = Vec3::Zero();        ///< o_i there, m
  Mat3 body1 = Mat3::Identity(), body2 = Mat3::Identity();    ///< in components of the charts
  Vec3 arm1 = Vec3::Zero(), arm2 = Vec3::Zero();              ///< at rest
  // made by the constructor
  Vector<6> d0 = Vector<6>::Zero();   ///< d without stress
  Vector<6> pre = Vector<6>::Zero();  ///< H sigma of the stress at d0: preload, temperature
  double V0 = 0;                      ///< energy of that, J
  Matrix<6> H0 = Matrix<6>::Identity();
  Eigen::Matrix<double, 3, 6> P = Eigen::Matrix<double, 3, 6>::Zero();  ///< a of the header: m, m^2

  SectionBeam() = default;
  /// The reference configuration is stress-free. chart1, chart2: triads of the nodes' lines as given
  /// to the builder.
  SectionBeam(const SectionBeamConstants& constants, const Vec3& chord, const Mat3& triad1,
              const Mat3& triad2, const Vec3& offset1 = Vec3::Zero(),
              const Vec3& offset2 = Vec3::Zero(), const Mat3& chart1 = Mat3::Identity(),
              const Mat3& chart2 = Mat3::Identity());
  /// Another unstressed shape: triads at the ends of the same chord as the reference has.
  void set_unstressed(const Mat3& t1, const Mat3& t2);
  /// Axial force (N, tension positive) and free axial strain in the reference configuration.
  void set_prestress(double force, double free_strain);
  /// Viscous damping: beta times the stiffness (s), and beta_twist times that of the twist more.
  void set_damping(double beta, double beta_twist);

  /// Nothing in it tells one direction across the axes of its nodes from another: matrices that a
  /// turn about the axis leaves as they are, whatever they couple, and an unstressed shape along it.
  bool axisymmetric() const;

  void add_force(const system::Nodes<2>& x, const system::Context& ctx,
                 system::ForceX<14>& f) const;
  void add_tangent(const system::Nodes<2>& x, const system::Context& ctx,
                   system::TangentX<14>& t) const;
  void add_energy(const system::Nodes<2>& x, const system::Context& ctx, system::Energy& e) const;
  /// Force and stiffness and their derivatives along a motion (system/stiffness_rate.hpp), exact.
  void add_stiffness_rate(const system::Nodes<2>& x, const system::Nodes<2>& rate,
                          const system::Context& ctx, system::StiffnessRateX<14>& out) const;

 private:
  void set_reference();
};

}  // namespace whirl::elements
