// Finite rotations split into an axial and a transverse part, R = L(gamma) L(phi e), gamma
// perpendicular to e. F. D. Sorokin, H. Zhang, Engineering Journal: Science and Innovation 2018 no.
// 10, doi 10.18698/2308-6033-2018-10-1815 ("the paper"; equation numbers are its).
//
// The chart (phi, gamma) is good for |gamma| < pi: the map (phi', gamma') -> omega has determinant
// sin g / g. (The paper says 2 pi, where B alone degenerates; but at g = pi, d = -e, every azimuth
// of gamma gives the same d, and phi and that azimuth turn about the same line: the denominator of
// (11), (g/2) cot(g/2), is zero there.)
#pragma once
#include <core/types.hpp>
#include <string>

namespace whirl::rotation {

/// Rotation tensor of the Euler vector v, rad: L = 1 + sin g/g [v] + (1-cos g)/g^2 [v]^2.
Mat3 L(const Vec3& v);
/// Minimal rotation taking unit vector a to unit vector b.
/// @throws Error if a = -b.
Mat3 minimal_rotation(const Vec3& a, const Vec3& b);
/// Signed solid angle of the spherical triangle of unit vectors (u, v, w), in (-2 pi, 2 pi).
double solid_angle(const Vec3& u, const Vec3& v, const Vec3& w);

/// b_k = j_k(g)/g^k (j_k the spherical Bessel functions), k = 0..3, and cos g, as functions of x =
/// g^2 >= 0. b_0 = sin g/g and db_k/dx = -b_{k+1}/2, d(cos g)/dx = -b_0/2: with them every
/// derivative below is free of cancellation.
struct BesselRatios {
  double b0, b1, b2, b3, cosine;
};
BesselRatios bessel_ratios(double x);
/// (1 - cos g)/g^2 and (g - sin g)/g^3 as functions of x = g^2.
double one_minus_cos_ratio(double x);
double g_minus_sin_ratio(double x);

/// The director d(gamma) = e cos g + (sin g/g) gamma x e and what the node Jacobian needs, in chart
/// axes (e, e2, e3) = (x, y, z), gamma = (gamma2, gamma3).
struct Director {
  Vec3 t;         ///< d - e
  Mat32 D;        ///< dd/dgamma (singular values 1 and sin g/g)
  Vec3 rate;      ///< d' = D gamma'
  Mat32 D_rate;   ///< d(d')/dgamma = D' (the rate of D)
  Vec3 accel;     ///< d'' = D gamma'' + D' gamma'
  Mat32 D_accel;  ///< d(d'')/dgamma
  Vec2 gamma;
  BesselRatios b;  ///< at g^2
  /// Contraction with the second derivative: sum_k f_k d2 d_k / dgamma2 (symmetric 2x2).
  Mat2 curvature(const Vec3& f) const;
};
/// Position only: t, D, gamma, b.
void director(const Vec2& gamma, Director& out);
/// Position, rates and accelerations with all derivatives.
void director(const Vec2& gamma, const Vec2& dgamma, const Vec2& ddgamma, Director& out);

/// gamma of a director in chart axes (d != -e): gamma = angle(e, d) (e x d)/|e x d|, from the
/// offset t = d - e.
/// @throws Error if d = -e.
Vec2 gamma_of_director(const Vec3& t);
/// (phi', gamma') of an angular velocity omega, chart axes: (11) phi' = (e+d).omega/(1+e.d), (9)
/// gamma' = D+ (omega x d).
struct ChartRates {
  double phi;
  Vec2 gamma;
};
ChartRates rates_of_omega(const Vec2& gamma, const Vec3& omega);
/// omega of chart rates: d x d' + s d, with s = phi' - (1-cos g)/g^2 e.(gamma x gamma').
Vec3 omega_of_rates(const Vec2& gamma, double dphi, const Vec2& dgamma);
/// (phi'', gamma'') of an angular acceleration omega' where the rates are (dphi, dgamma).
ChartRates accelerations_of_omega(const Vec2& gamma, double dphi, const Vec2& dgamma,
                                  const Vec3& domega);
/// omega' of chart rates and accelerations.
Vec3 omega_rate_of_rates(const Vec2& gamma, double dphi, const Vec2& dgamma, double ddphi,
                         const Vec2& ddgamma);
/// Condition number of the map (phi', gamma') -> omega: 1 at g = 0, about 4.4/(pi - g) near pi.
double chart_condition(double g);

/// Beyond chart_switch the reference triad is moved (see ChartChange); at chart_limit, where the
/// condition number is about 100, a chart that may not be moved is given up.
inline constexpr double chart_switch = 1.5;
inline constexpr double chart_limit = 3.1;

/// Orientation of one node in a chart: values, rates and accelerations of phi and gamma.
struct Angles {
  double phi = 0.0, dphi = 0.0, ddphi = 0.0;
  Vec2 gamma = Vec2::Zero(), dgamma = Vec2::Zero(), ddgamma = Vec2::Zero();
};

/// A change of reference triad. triad: columns e, e2, e3. The new one is P(new_e <- e) triad, the
/// minimal rotation, so that body axes P(d <- e) L(phi e) e_k stay what they are, with phi
/// continuous: phi' = phi + Omega(e, d, e'). All nodes of a shaft line change together.
class ChartChange {
 public:
  /// @throws Error if new_e = -e.
  ChartChange(const Mat3& triad, const Vec3& new_e);
  const Mat3& new_triad() const { return to_; }
  /// The same orientation, angular velocity and acceleration in the new chart.
  /// @throws Error if d = -new_e.
  Angles apply(const Angles& old) const;

 private:
  Mat3 from_, to_;
};

/// phi less a number of whole turns, 2 pi carried to 107 bits.
double without_turns(double phi, double turns);
/// Takes n whole turns out of phi, with the same care.
void take_turns(double& phi, double n);

}  // namespace whirl::rotation
