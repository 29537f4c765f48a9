// Finite rotations split into an axial and a transverse part, R = L(gamma) L(phi e), gamma perpendicular to e.
// F. D. Sorokin, H. Zhang, Engineering Journal: Science and Innovation 2018 no. 10, doi 10.18698/2308-6033-2018-10-1815
// ("the paper"; equation numbers are its).
//
// The chart (phi, gamma) is good for |gamma| < pi: the map (phi', gamma') -> omega has determinant sin g / g. (The paper
// says 2 pi, where B alone degenerates; but at g = pi, d = -e, every azimuth of gamma gives the same d, and phi and that
// azimuth turn about the same line: the denominator of (11), (g/2) cot(g/2), is zero there.)
#pragma once
#include <core/types.hpp>

namespace whirl::rotation {

/// Rotation tensor of the Euler vector v, rad: L = 1 + sin g/g [v] + (1-cos g)/g^2 [v]^2.
Mat3 L(const Vec3& v);
/// Zhilin tensor, omega = B(v) v' (1): B = 1 + (1-cos g)/g^2 [v] + (g-sin g)/g^3 [v]^2.
Mat3 B(const Vec3& v);
/// Inverse of B: 1 - [v]/2 + (1/g^2 - cot(g/2)/(2g)) [v]^2; singular at g = 2 pi.
Mat3 B_inverse(const Vec3& v);
/// Euler vector of a rotation tensor, norm in [0, pi].
Vec3 euler_vector(const Mat3& R);
/// Minimal rotation taking unit vector a to unit vector b (a != -b).
Mat3 minimal_rotation(const Vec3& a, const Vec3& b);
/// Signed solid angle of the spherical triangle of unit vectors (u, v, w), in (-2 pi, 2 pi).
double solid_angle(const Vec3& u, const Vec3& v, const Vec3& w);

/// The even functions of g as functions of x = g^2 with their first three x-derivatives, free of cancellation:
/// cosine: cos g; sinc: sin g / g.
struct Even { double f, f1, f2, f3; };
Even cosine_of_square(double x);
Even sinc_of_square(double x);

/// The director d(gamma) = e cos g + (sin g/g) gamma x e and what the node Jacobian needs, in chart axes
/// (e, e2, e3) = (x, y, z), gamma = (gamma2, gamma3).
struct Director {
  Vec3 t;          ///< d - e
  Mat32 D;         ///< dd/dgamma (singular values 1 and sin g/g)
  Vec3 rate;       ///< d' = D gamma'
  Mat32 D_rate;    ///< d(d')/dgamma = D' (the rate of D)
  Vec3 accel;      ///< d'' = D gamma'' + D' gamma'
  Mat32 D_accel;   ///< d(d'')/dgamma
  Vec2 gamma;
  /// Contraction with the second derivative: sum_k f_k d2 d_k / dgamma2 (symmetric 2x2).
  Mat2 curvature(const Vec3& f) const;
};
/// Position only.
void director(const Vec2& gamma, Director& out);
/// Position, rates and accelerations with all derivatives.
void director(const Vec2& gamma, const Vec2& dgamma, const Vec2& ddgamma, Director& out);

/// gamma of a director in chart axes (d != -e): gamma = angle(e, d) (e x d)/|e x d|, from the offset t = d - e.
Vec2 gamma_of_director(const Vec3& t);
/// (phi', gamma') of an angular velocity omega, chart axes: (11) phi' = (e+d).omega/(1+e.d), (9) gamma' = D+ (omega x d).
struct ChartRates { double phi; Vec2 gamma; };
ChartRates rates_of_omega(const Vec2& gamma, const Vec3& omega);
/// omega of chart rates: d x d' + s d.
Vec3 omega_of_rates(const Vec2& gamma, double dphi, const Vec2& dgamma);
/// Condition number of the map (phi', gamma') -> omega.
double chart_condition(double g);

}  // namespace whirl::rotation
