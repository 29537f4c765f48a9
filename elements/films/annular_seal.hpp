// Annular (plain) liquid seal: short-seal closed form of Black and Childs, as coefficients that
// follow the spin.
//
// Turbulent bulk flow with Blasius friction: lambda = 0.066 Ra^(-1/4) (1 + 1/(4 b^2))^(3/8), Ra = V
// C/nu, b = V/(R s); leakage dp = rho V^2/2 (1 + xi + 2 sigma), sigma = lambda L/C; transit time T
// = L/V; m0 = -1/4;
//   beta = 1/(1 + 4 b^2),   B = 1 + 4 b^2 beta (1 + m0),   E = (1 + xi)/(2 (1 + xi + B sigma)),
//       a = sigma (1 + beta (1 + m0)),
//   v0 = inlet swirl velocity/(R s) - 1/2
// First order in v0, with z the share of the seal passed:
//   alpha1 = E + B sigma (1/12 + E/2),  alpha2 = (1/6 + E)/2
//   gamma1 = sigma/a {E B + (1/sigma - B/a) [(1 - e^-a)(E + 1/2 + 1/a) - 1]}
//   gamma2 = 1/a {(E + 1/a^2)(1 - e^-a) - (1/2 + 1/a) e^-a}
//   K = n [(1 - m0) sigma E - (sT)^2/4 (alpha2 + 2 v0 gamma2)],  k = n sT/2 (alpha1 + 2 v0 gamma1),
//   C = n T alpha1,   c = n s T^2 (alpha2 + v0 gamma2),   M = n T^2 alpha2,
//       n = (pi R dp/lambda) 2 sigma/(1 + xi + 2 sigma)
// and -F = [K k; -k K] r + [C c; -c C] v + M a on the journal, (y, z), spin y -> z. They are
// Childs' forms, regrouped: D.W. Childs, ASME J. Lubr. Tech. 105 (1983) 429-436, doi
// 10.1115/1.3254633; H.F. Black, J. Mech. Eng. Sci. 11 (1969) 206-213, doi
// 10.1243/JMES_JOUR_1969_011_023_02. The friction factor needs V, found by Newton.
//
// No torque on the shaft: the cross coupling is supplied power, as with a table. Limits: centred
// seal, small motion (|r| < C/2), L/D below about 0.75, turbulent (Ra > 1000), incompressible,
// smooth surfaces.
#pragma once
#include <elements/supports/lateral_joint.hpp>

namespace whirl::elements {

struct AnnularSeal {
  static constexpr bool inertia = true;
  static constexpr system::Dependence depends{.spin = true};
  double radius = 0, length = 0, clearance = 0;  ///< R, L, C (radial), m
  double pressure_drop = 0;                      ///< dp, Pa
  double density = 0, viscosity = 0;             ///< kg/m3, dynamic Pa s
  double inlet_loss = 0.1;                       ///< xi
  double inlet_swirl = 0.5;                      ///< inlet swirl velocity/(R s)

  struct Coefficients {
    double K, k, C, c, M;
  };
  struct Flow {
    double V, lambda, sigma;
  };  ///< axial velocity m/s, friction factor, lambda L/C
  Flow flow(double spin) const;
  /// Coefficients at a spin and their derivatives in it.
  void coefficients(double spin, Coefficients& v, Coefficients& dv) const;

  void force(const LateralMotion& m, Vector<4>& z) const;
  void tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const;
  void energy(const LateralMotion& m, system::Energy& e) const;
};

using SealJoint = LateralJoint<AnnularSeal>;

/// Cross-coupled stiffness of flow in a bladed stage, N/m: K_yz = +k, K_zy = -k for spin y -> z (F
/// = -K r drives forward whirl). Alford, ASME J. Eng. Power 87 (1965), doi 10.1115/1.3678270: k =
/// beta torque/(mean diameter * blade height).
/// @pre mean_diameter and blade_height positive.
double alford_stiffness(double beta, double torque, double mean_diameter, double blade_height);
/// Wachel's formula (Wachel & von Nimitz 1981; API 617) in SI: k = power/(speed diameter width) *
/// molar_mass/(10 g/mol) * density_ratio; power W, speed rad/s, impeller diameter and smallest flow
/// width m, molar mass kg/mol, discharge over suction density.
/// @pre speed not zero, diameter and width positive.
double wachel_stiffness(double power, double speed, double diameter, double width,
                        double molar_mass, double density_ratio);

}  // namespace whirl::elements
