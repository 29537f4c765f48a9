// Nonlinear problems with M(q): pendulums, a Laval rotor with free spin, a Kepler orbit, stiff and
// massless systems.
#pragma once
#include "dense_problem.hpp"

namespace whirl::time::test {

/// Plane double pendulum, unit masses and lengths, angles from the downward vertical (Kind::tilt),
/// gravity g, viscous friction c on both angles.
class DoublePendulum final : public DenseProblem {
 public:
  explicit DoublePendulum(double g = 9.81, double c = 0.0)
      : DenseProblem(all(2, Kind::tilt)),
        g_(g),
        c_(c) {}
  bool residual(double, CRef q, CRef v, CRef a, Ref r) override {
    const double s = std::sin(q[0] - q[1]), k = std::cos(q[0] - q[1]);
    r[0] = 2.0 * a[0] + k * a[1] + s * v[1] * v[1] + 2.0 * g_ * std::sin(q[0]) + c_ * v[0];
    r[1] = k * a[0] + a[1] - s * v[0] * v[0] + g_ * std::sin(q[1]) + c_ * v[1];
    return true;
  }
  void tangent(double, CRef q, CRef v, CRef a) override {
    const double s = std::sin(q[0] - q[1]), k = std::cos(q[0] - q[1]);
    M << 2.0, k, k, 1.0;
    C << c_, 2.0 * s * v[1], -2.0 * s * v[0], c_;
    const double k0 = -s * a[1] + k * v[1] * v[1], k1 = -s * a[0] - k * v[0] * v[0];
    K << k0 + 2.0 * g_ * std::cos(q[0]), -k0, k1, -k1 + g_ * std::cos(q[1]);
  }
  double energy(const VecX& q, const VecX& v) const {
    return v[0] * v[0] + 0.5 * v[1] * v[1] + std::cos(q[0] - q[1]) * v[0] * v[1] -
           g_ * (2.0 * std::cos(q[0]) + std::cos(q[1]));
  }
  /// y = (q, v)
  VecX rate(const VecX& y) const {
    const double s = std::sin(y[0] - y[1]), k = std::cos(y[0] - y[1]);
    const double f0 = -(s * y[3] * y[3] + 2.0 * g_ * std::sin(y[0]) + c_ * y[2]);
    const double f1 = -(-s * y[2] * y[2] + g_ * std::sin(y[1]) + c_ * y[3]);
    const double det = 2.0 - k * k;
    VecX dy(4);
    dy << y[2], y[3], (f0 - k * f1) / det, (2.0 * f1 - k * f0) / det;
    return dy;
  }

 private:
  double g_, c_;
};

/// Laval rotor with free spin: shaft centre (y, z), angle phi, mass m eccentric by e, polar inertia
/// J, stiffness k, damping c, gyroscopic coupling b (as of a rotating frame), torque T. phi is kept
/// small by accept().
class LavalRotor final : public DenseProblem {
 public:
  double m = 1.0, e = 1e-3, J = 1e-2, k = 1e4, c = 2.0, b = 0.0, torque = 0.1;
  double turns = 0.0;
  LavalRotor() : DenseProblem({Kind::displacement, Kind::displacement, Kind::spin_angle}) {}
  bool residual(double, CRef q, CRef v, CRef a, Ref r) override {
    const double S = m * e * std::sin(q[2]), D = m * e * std::cos(q[2]);
    r[0] = m * a[0] - S * a[2] - D * v[2] * v[2] + c * v[0] + b * v[1] + k * q[0];
    r[1] = m * a[1] + D * a[2] - S * v[2] * v[2] + c * v[1] - b * v[0] + k * q[1];
    r[2] = (J + m * e * e) * a[2] - S * a[0] + D * a[1] - torque;
    return true;
  }
  void tangent(double, CRef q, CRef v, CRef a) override {
    const double S = m * e * std::sin(q[2]), D = m * e * std::cos(q[2]);
    M << m, 0.0, -S, 0.0, m, D, -S, D, J + m * e * e;
    C << c, b, -2.0 * D * v[2], -b, c, -2.0 * S * v[2], 0.0, 0.0, 0.0;
    K << k, 0.0, -D * a[2] + S * v[2] * v[2], 0.0, k, -S * a[2] - D * v[2] * v[2], 0.0, 0.0,
        -D * a[0] - S * a[1];
  }
  bool accept(double, Ref q, Ref, Ref) override {
    const double n = std::round(q[2] / two_pi);
    if (n == 0.0) return false;
    q[2] -= n * two_pi;
    turns += n;
    return true;
  }
  double phi(const VecX& q) const { return q[2] + turns * two_pi; }
  double energy(const VecX& q, const VecX& v) const {
    const double y = v[0] - e * std::sin(q[2]) * v[2], z = v[1] + e * std::cos(q[2]) * v[2];
    return 0.5 * m * (y * y + z * z) + 0.5 * J * v[2] * v[2] +
           0.5 * k * (q[0] * q[0] + q[1] * q[1]);
  }
  VecX rate(const VecX& y) const {
    const double S = m * e * std::sin(y[2]), D = m * e * std::cos(y[2]), w2 = y[5] * y[5];
    const double f0 = D * w2 - c * y[3] - b * y[4] - k * y[0],
                 f1 = S * w2 - c * y[4] + b * y[3] - k * y[1];
    // eliminate the translations: inertia about the mass centre is J
    const double a2 = (torque + (S * f0 - D * f1) / m) / J;
    VecX dy(6);
    dy << y[3], y[4], y[5], (f0 + S * a2) / m, (f1 - D * a2) / m, a2;
    return dy;
  }
};

/// Kepler orbit of eccentricity ecc, unit gravitational parameter and semi-major axis, from its
/// pericentre.
class Kepler final : public DenseProblem {
 public:
  Kepler() : DenseProblem(all(2)) { M.setIdentity(); }
  bool residual(double, CRef q, CRef, CRef a, Ref r) override {
    const double d = q.norm();
    if (d < 1e-3) return false;
    r = a + q / (d * d * d);
    return true;
  }
  void tangent(double, CRef q, CRef, CRef) override {
    const double d = q.norm();
    K = MatX::Identity(2, 2) / (d * d * d) - 3.0 * q * q.transpose() / std::pow(d, 5);
  }
  static VecX start_q(double ecc) { return Vec2(1.0 - ecc, 0.0); }
  static VecX start_v(double ecc) { return Vec2(0.0, std::sqrt((1.0 + ecc) / (1.0 - ecc))); }
};

/// Pendulum of unit mass and length whose support is driven along x by x = amplitude cos(w t)
/// exactly: q = (x, theta).
class DrivenPendulum final : public DenseProblem {
 public:
  double amplitude = 0.2, w = 3.0, g = 9.81;
  DrivenPendulum() : DenseProblem({Kind::held, Kind::tilt}) {}
  void impose(double t, Ref q, Ref v, Ref a) const override {
    q[0] = amplitude * std::cos(w * t);
    v[0] = -amplitude * w * std::sin(w * t);
    a[0] = -w * w * q[0];
  }
  bool residual(double, CRef q, CRef v, CRef a, Ref r) override {
    const double s = std::sin(q[1]), k = std::cos(q[1]);
    r[0] = 2.0 * a[0] + k * a[1] - s * v[1] * v[1];
    r[1] = a[1] + k * a[0] + g * s;
    return true;
  }
  void tangent(double, CRef q, CRef v, CRef a) override {
    const double s = std::sin(q[1]), k = std::cos(q[1]);
    M << 2.0, k, k, 1.0;
    C << 0.0, -2.0 * s * v[1], 0.0, 0.0;
    K << 0.0, -s * a[1] - k * v[1] * v[1], 0.0, -s * a[0] + g * k;
  }
  VecX rate(double t, const VecX& y) const {
    VecX dy(2);
    dy << y[1], -g * std::sin(y[0]) + std::cos(y[0]) * w * w * amplitude * std::cos(w * t);
    return dy;
  }
};

/// Van der Pol: q'' - mu (1 - q^2) q' + q = 0.
class VanDerPol final : public DenseProblem {
 public:
  explicit VanDerPol(double mu) : DenseProblem(all(1)), mu_(mu) { M.setOnes(); }
  bool residual(double, CRef q, CRef v, CRef a, Ref r) override {
    r[0] = a[0] - mu_ * (1.0 - q[0] * q[0]) * v[0] + q[0];
    return true;
  }
  void tangent(double, CRef q, CRef v, CRef) override {
    C(0, 0) = -mu_ * (1.0 - q[0] * q[0]);
    K(0, 0) = 1.0 + 2.0 * mu_ * q[0] * v[0];
  }
  VecX rate(const VecX& y) const {
    VecX dy(2);
    dy << y[1], mu_ * (1.0 - y[0] * y[0]) * y[1] - y[0];
    return dy;
  }

 private:
  double mu_;
};

}  // namespace whirl::time::test
