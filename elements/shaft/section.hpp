// Cross-section properties of a shaft element: a solid or hollow circle whose diameters vary
// linearly from end 1 to end 2 (cylinder, cone, hollow cone), or constants given directly.
//
// Shear factor kappa (shear stiffness kappa G A) of a hollow circle, m = inner/outer diameter:
//   Cowper      6(1+nu)(1+m^2)^2 / ((7+6nu)(1+m^2)^2 + (20+12nu) m^2)
//               G. R. Cowper, J. Appl. Mech. 33 (1966) 335-340, doi 10.1115/1.3625046
//   Hutchinson  6(1+nu)^2(1+m^2)^2 / (7+34m^2+7m^4 + nu(12+48m^2+12m^4) + nu^2(4+16m^2+4m^4))
//               J. R. Hutchinson, J. Appl. Mech. 68 (2001) 87-92, doi 10.1115/1.1349417
// nu is E/(2G) - 1, so that a material with its own G stays consistent.
#pragma once
#include <core/types.hpp>

namespace whirl::elements {

/// Stiffness and inertia of one cross-section.
struct SectionProperties {
  double EA = 0;     ///< N
  double kGA = 0;    ///< kappa G A, N; infinite: no shear deformation
  double GJ = 0;     ///< N m2
  double EI = 0;     ///< N m2
  double rhoA = 0;   ///< kg/m
  double rhoI = 0;   ///< transverse rotary inertia, kg m; 0: Euler-Bernoulli mass
  double rhoIp = 0;  ///< polar inertia, kg m
};

/// Area, transverse and polar second moments of a hollow circle, m2 and m4.
/// @pre od >= id >= 0.
double annulus_area(double od, double id);
double annulus_I(double od, double id);
double annulus_J(double od, double id);

/// Shear factors of a hollow circle, m = id/od in [0, 1).
/// @pre 0 <= m <= 1 (also hutchinson_factor).
double cowper_factor(double m, double nu);
double hutchinson_factor(double m, double nu);

enum class ShearRule { cowper, hutchinson, rigid, given };

/// The section along one element; xi from 0 (end 1) to 1 (end 2).
struct ElementSection {
  // Circle with linear diameters, m. Mass and stiffness may have their own.
  double mass_od1 = 0, mass_id1 = 0, mass_od2 = 0, mass_id2 = 0;
  double od1 = 0, id1 = 0, od2 = 0, id2 = 0;
  double E = 0, G = 0, rho = 0;  ///< Pa, Pa, kg/m3
  ShearRule shear = ShearRule::cowper;
  double kappa = 0;            ///< for ShearRule::given
  bool rotary_inertia = true;  ///< false: rhoI = 0 (rhoIp, spin and its gyroscopic effect, stays)
  double added_mass = 0;       ///< kg/m without stiffness or rotary inertia
  // Or constants (kGA <= 0 stands for no shear deformation).
  bool constants = false;
  SectionProperties given{};

  SectionProperties at(double xi) const;
  /// Same properties at both ends and everywhere between.
  bool uniform() const;
  /// The part from xi1 to xi2 of this section, as a section of its own (diameters interpolated).
  /// @pre 0 <= xi1 <= xi2 <= 1.
  ElementSection part(double xi1, double xi2) const;
};

}  // namespace whirl::elements
