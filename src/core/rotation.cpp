#include <core/error.hpp>
#include <core/rotation.hpp>
#include <core/single.hpp>
#include <array>
#include <cmath>
#include <math.h>
#include <fmt/format.h>

namespace whirl::rotation {

namespace {

using single::every;
#define WHIRL_INLINE inline
#include <core/series.inl>
#include <core/director.inl>
#undef WHIRL_INLINE

// (g - sin g)/g^3 = sum_k (-x)^k / (2k+3)!
template <int N>
constexpr std::array<double, N> g_minus_sin_series() {
  std::array<double, N> c{};
  long double term = 1.0L / 6.0L;
  for (int k = 0; k < N; ++k) {
    c[static_cast<std::size_t>(k)] = static_cast<double>(term);
    term *= -1.0L / (static_cast<long double>(2 * k + 4) * (2 * k + 5));
  }
  return c;
}

constexpr auto series_gs = g_minus_sin_series<13>();

double cross2(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// P turns gamma into p = gamma x e: (g2, g3) -> (g3, -g2).
Vec2 turn(const Vec2& v) { return Vec2(v.y(), -v.x()); }
Vec2 turn_back(const Vec2& v) { return Vec2(-v.y(), v.x()); }

double one_minus_cos_slope(double x) {  // d/dx of b0(x/4)^2/2
  const BesselRatios h = bessel_ratios(0.25 * x);
  return -0.125 * h.b0 * h.b1;
}

// D+ d' for d' in the tangent plane: d'_perp = b0 P gamma' - b1 p alpha, d'_x = -b0 alpha, alpha =
// gamma.gamma'.
Vec2 pull_back(const Vec2& gamma, const BesselRatios& b, const Vec3& v) {
  const Vec2 p = turn(gamma), v_perp = v.tail<2>();
  const double alpha = b.cosine * p.dot(v_perp) - b.b0 * gamma.squaredNorm() * v.x();
  return turn_back(v_perp + b.b1 * alpha * p) / b.b0;
}

Vec3 whole(const Vec3& t) { return Vec3(1.0 + t.x(), t.y(), t.z()); }

BesselRatios plain(const Ratios<double>& r) { return {r.b0, r.b1, r.b2, r.b3, r.cosine}; }
Ratios<double> plain(const BesselRatios& r) { return {r.b0, r.b1, r.b2, r.b3, r.cosine}; }

Place<double> position(const Vec2& g, Director& o) {
  const double x = g.squaredNorm();
  o.gamma = g;
  o.b = bessel_ratios(x);
  const Place<double> p = place_of(g.x(), g.y(), x, plain(o.b));
  o.t << p.t[0], p.t[1], p.t[2];
  o.D << p.D[0][0], p.D[0][1], p.D[1][0], p.D[1][1], p.D[2][0], p.D[2][1];
  return p;
}

}  // namespace

BesselRatios bessel_ratios(double x) { return plain(ratios_of(x)); }

double one_minus_cos_ratio(double x) {
  const double b = bessel_ratios(0.25 * x).b0;
  return 0.5 * b * b;
}

double g_minus_sin_ratio(double x) {
  return x <= 4.0 ? horner<13>(series_gs.data(), x) : (1.0 - bessel_ratios(x).b0) / x;
}

Mat3 L(const Vec3& v) {
  const double x = v.squaredNorm();
  const Mat3 s = skew(v);
  return Mat3::Identity() + bessel_ratios(x).b0 * s + one_minus_cos_ratio(x) * s * s;
}

Mat3 minimal_rotation(const Vec3& a, const Vec3& b) {
  const double c = 0.5 * (a + b).squaredNorm();  // 1 + a.b
  if (!(c > 1e-24))
    throw run_error("E71", "no minimal rotation takes a direction to its opposite",
                    "choose an intermediate direction");
  const Vec3 v = a.cross(b);
  return (c - 1.0) * Mat3::Identity() + skew(v) + (v / c) * v.transpose();
}

double solid_angle(const Vec3& u, const Vec3& v, const Vec3& w) {
  return 2.0 * std::atan2(u.dot(v.cross(w)), 1.0 + u.dot(v) + v.dot(w) + w.dot(u));
}

Mat2 Director::curvature(const Vec3& f) const {
  const Vec2 fp = f.tail<2>(), p = turn(gamma), h = turn_back(fp);
  const double fpp = fp.dot(p);
  const double diagonal = -(b.b0 * f.x() + b.b1 * fpp), outer = b.b1 * f.x() + b.b2 * fpp;
  Mat2 m;
  m(0, 0) = diagonal + gamma.x() * (outer * gamma.x() - 2.0 * b.b1 * h.x());
  m(1, 1) = diagonal + gamma.y() * (outer * gamma.y() - 2.0 * b.b1 * h.y());
  m(0, 1) = m(1, 0) =
      outer * gamma.x() * gamma.y() - b.b1 * (gamma.x() * h.y() + h.x() * gamma.y());
  return m;
}

void director(const Vec2& gamma, Director& out) { position(gamma, out); }

void director(const Vec2& gamma, const Vec2& dgamma, const Vec2& ddgamma, Director& o) {
  const Place<double> at = position(gamma, o);
  // Written out in scalars: this runs for every node of every linearisation. d2 d[w, .] and d2
  // d[gamma'', .], then d3 d[w, w, .].
  const double b0 = o.b.b0, b1 = o.b.b1, b2 = o.b.b2, b3 = o.b.b3;
  const double g2 = gamma.x(), g3 = gamma.y(), w2 = dgamma.x(), w3 = dgamma.y(), a2 = ddgamma.x(),
               a3 = ddgamma.y();
  const double alpha = g2 * w2 + g3 * w3, beta = g2 * a2 + g3 * a3, ww = w2 * w2 + w3 * w3;
  const double ba = b1 * alpha, bg2 = b1 * g2, bg3 = b1 * g3;
  double r[3][2], rate[3], accel[3];
  jacobian_rate(g2, g3, w2, w3, plain(o.b), r);
  motion_of(at, r, w2, w3, a2, a3, rate, accel);
  o.D_rate << r[0][0], r[0][1], r[1][0], r[1][1], r[2][0], r[2][1];
  o.rate << rate[0], rate[1], rate[2];
  o.accel << accel[0], accel[1], accel[2];
  // d2 d[gamma'', .] + d3 d[w, w, .]: coefficients of g^T, w^T and gamma''^T, and the part that
  // turns
  const double aa = alpha * alpha, cg = b1 * beta + b1 * ww - b2 * aa, cw = 2.0 * ba;
  const double q = b2 * (beta + ww) - b3 * aa, k = 2.0 * b2 * alpha,
               turning = b2 * aa - b1 * (ww + beta);
  const double m3 = q * g3 + k * w3 - b1 * a3, m2 = b1 * a2 - q * g2 - k * w2;  // times g^T
  const double n3 = k * g3 - 2.0 * b1 * w3, n2 = 2.0 * b1 * w2 - k * g2;        // times w^T
  o.D_accel << cg * g2 + cw * w2 - b0 * a2, cg * g3 + cw * w3 - b0 * a3,
      m3 * g2 + n3 * w2 - bg3 * a2, m3 * g3 + n3 * w3 - bg3 * a3 + turning,
      m2 * g2 + n2 * w2 + bg2 * a2 - turning, m2 * g3 + n2 * w3 + bg2 * a3;
}

Vec2 gamma_of_director(const Vec3& t) {
  const double sine = std::hypot(t.y(), t.z());
  if (sine == 0.0) {
    if (t.x() < -1.0)
      throw run_error(
          "E71",
          "the section normal is opposite to the reference axis: the transverse rotation is pi",
          "turn on the change of chart (model.chart_change = true)");
    return Vec2::Zero();
  }
  const double scale = std::atan2(sine, 1.0 + t.x()) / sine;
  return Vec2(-t.z() * scale, t.y() * scale);
}

ChartRates rates_of_omega(const Vec2& gamma, const Vec3& omega) {
  Director o;
  position(gamma, o);
  const Vec3 d = whole(o.t);
  const Vec2 rate = pull_back(gamma, o.b, omega.cross(d));
  // (11) in the form s + (1-cos g)/g^2 e.(gamma x gamma'), regular wherever gamma' is
  return {omega.dot(d) + one_minus_cos_ratio(gamma.squaredNorm()) * cross2(gamma, rate), rate};
}

Vec3 omega_of_rates(const Vec2& gamma, double dphi, const Vec2& dgamma) {
  Director o;
  position(gamma, o);
  const Vec3 d = whole(o.t);
  const double s = dphi - one_minus_cos_ratio(gamma.squaredNorm()) * cross2(gamma, dgamma);
  return d.cross(o.D * dgamma) + s * d;
}

ChartRates accelerations_of_omega(const Vec2& gamma, double dphi, const Vec2& dgamma,
                                  const Vec3& domega) {
  Director o;
  director(gamma, dgamma, Vec2::Zero(), o);
  const double x = gamma.squaredNorm(), a = one_minus_cos_ratio(x), swept = cross2(gamma, dgamma);
  const Vec3 d = whole(o.t), omega = d.cross(o.rate) + (dphi - a * swept) * d;
  // o.accel holds D' gamma' here; the remainder D gamma'' is tangent to the sphere
  const Vec2 ddgamma = pull_back(gamma, o.b, domega.cross(d) + omega.cross(o.rate) - o.accel);
  const double a_rate = 2.0 * one_minus_cos_slope(x) * gamma.dot(dgamma);
  return {domega.dot(d) + a_rate * swept + a * cross2(gamma, ddgamma), ddgamma};
}

Vec3 omega_rate_of_rates(const Vec2& gamma, double dphi, const Vec2& dgamma, double ddphi,
                         const Vec2& ddgamma) {
  Director o;
  director(gamma, dgamma, ddgamma, o);
  const double x = gamma.squaredNorm(), a = one_minus_cos_ratio(x), swept = cross2(gamma, dgamma);
  const double a_rate = 2.0 * one_minus_cos_slope(x) * gamma.dot(dgamma);
  const double s = dphi - a * swept, ds = ddphi - a_rate * swept - a * cross2(gamma, ddgamma);
  const Vec3 d = whole(o.t);
  return d.cross(o.accel) + ds * d + s * o.rate;
}

double chart_condition(double g) {
  // Along gamma the map is an isometry; across it, it is [1, -(1-cos g)/g; 0, sin g/g].
  const double x = g * g, b = std::abs(bessel_ratios(x).b0), c = one_minus_cos_ratio(x) * g;
  const double largest = 0.5 * (std::hypot(1.0 + b, c) + std::hypot(1.0 - b, c));
  return largest * largest / b;
}

ChartChange::ChartChange(const Mat3& triad, const Vec3& new_e) : from_(triad) {
  // Orthonormal to the last digit again: rounding would grow by a factor at every change and turn
  // up as energy.
  const Vec3 e = new_e.normalized();
  const Vec3 e2 = minimal_rotation(triad.col(0), e) * triad.col(1);
  to_.col(0) = e;
  to_.col(1) = (e2 - e2.dot(e) * e).normalized();
  to_.col(2) = e.cross(to_.col(1));
}

Angles ChartChange::apply(const Angles& old) const {
  Director o;
  position(old.gamma, o);
  const Vec3 d = whole(o.t);                // in the old chart's axes
  const Mat3 Q = to_.transpose() * from_;   // old axes -> new axes
  const Vec3 new_e = Q.row(0).transpose();  // e' in the old axes
  const Vec3 t = Q * d - Vec3::UnitX();
  Angles now;
  now.phi = old.phi + solid_angle(Vec3::UnitX(), d, new_e);
  now.gamma = gamma_of_director(t);
  const Vec3 omega = Q * omega_of_rates(old.gamma, old.dphi, old.dgamma);
  const Vec3 domega =
      Q * omega_rate_of_rates(old.gamma, old.dphi, old.dgamma, old.ddphi, old.ddgamma);
  const ChartRates v = rates_of_omega(now.gamma, omega);
  now.dphi = v.phi;
  now.dgamma = v.gamma;
  const ChartRates acc = accelerations_of_omega(now.gamma, now.dphi, now.dgamma, domega);
  now.ddphi = acc.phi;
  now.ddgamma = acc.gamma;
  return now;
}

void take_turns(double& phi, double n) {
  constexpr double low = 2.4492935982947064e-16;  // 2 pi - two_pi
  phi = std::fma(-n, two_pi, phi) - n * low;
}

double without_turns(double phi, double turns) {
  constexpr double low = 2.4492935982947064e-16;  // 2 pi - two_pi
  return turns == 0.0 ? phi : std::fma(-turns, two_pi, phi) - turns * low;
}

}  // namespace whirl::rotation
