// Hertz stiffness of rolling contacts, and closed-form estimates of bearing stiffness.
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
double hertz_ellipticity(double Rx, double Ry);
/// length: effective roller length, m. N/m^(10/9).
double hertz_line_stiffness(double length);
/// Two contacts in series, exponent n: (K1^(-1/n) + K2^(-1/n))^(-n).
double hertz_series(double K1, double K2, double n);

/// Stiffness along the load (kyy) and across it (kxx) of a loaded bearing, N/m: kyy = 13e6 n^(2/3)
/// d^(1/3) F^(1/3) cos^(5/3) alpha (balls, d: ball diameter), kyy = 1e9 n^0.9 l^0.8 F^0.1 cos^1.9
/// alpha (rollers, l: length); kxx/kyy interpolated in n from 8: 0.46, 12: 0.64, 16: 0.73 (balls),
/// 0.49, 0.66, 0.74 (rollers). F: static load, N; alpha: contact angle, rad. Friswell, Penny,
/// Garvey & Lees 2010, doi 10.1017/CBO9780511780509, pp. 182-185.
struct BearingEstimate {
  double along, across;
};
BearingEstimate estimate_ball_bearing(int balls, double diameter, double load, double alpha);
BearingEstimate estimate_roller_bearing(int rollers, double length, double load, double alpha);

}  // namespace whirl::elements
