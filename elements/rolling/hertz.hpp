// Hertz stiffness of rolling contacts.
//
// Point contact, Q = K delta^(3/2):  K = pi kappa E' sqrt(R E/(4.5 F^3)), with F, E the complete
// elliptic integrals of modulus sqrt(1 - 1/kappa^2) and the ellipticity kappa (>= 1) from the exact
// relation
//   (kappa^2 + 1) E - 2 F = F_rho (kappa^2 - 1) E,   F_rho = (|1/Rx - 1/Ry|) R,  1/R = 1/Rx + 1/Ry,
// E' = 2/((1-nu1^2)/E1 + (1-nu2^2)/E2). Hertz, J. reine angew. Math. 92 (1882),
// doi 10.1515/crll.1882.92.156; Hamrock, Schmid & Jacobson, Fundamentals of Fluid Film Lubrication,
// 2nd ed., ch. 17, doi 10.1201/9780203021187. Line contact, Q = K delta^(10/9):  K = 8.06e4 l^(8/9)
// N/mm^(10/9), l in mm, steel (Palmgren 1959; Harris, Rolling Bearing Analysis).
#pragma once

namespace whirl::elements {

struct ContactMaterial {
  double E = 208e9, nu = 0.3;
};  ///< Pa, -

/// Rx, Ry: effective radii of curvature in the two principal planes, m (1/R = 1/R1 +- 1/R2), both
/// positive. N/m^1.5.
double hertz_point_stiffness(double Rx, double Ry, const ContactMaterial& a = {},
                             const ContactMaterial& b = {});
/// Ellipticity kappa >= 1 of the contact.
/// @pre Rx, Ry > 0.
double hertz_ellipticity(double Rx, double Ry);
/// length: effective roller length, m. N/m^(10/9).
double hertz_line_stiffness(double length);
/// Two contacts in series, exponent n: (K1^(-1/n) + K2^(-1/n))^(-n).
/// @pre K1, K2, n > 0.
double hertz_series(double K1, double K2, double n);

}  // namespace whirl::elements
