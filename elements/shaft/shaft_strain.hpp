// Strain measures of the shaft element and their derivatives with respect to (a, d1, d2): shared by
// stiffness and damping.
#pragma once
#include <core/types.hpp>
#include <cmath>

namespace whirl::elements {

/// G(n) = theta/sin theta with n = 1 - cos theta, and two derivatives; F = theta^2 (F' = 2 G).
/// n(2-n) G' = 1 - (1-n) G, from which the series G = sum g_k n^k, g_k = k/(2k+1) g_(k-1).
struct AngleRatio {
  double F = 0, G = 1, G1 = 0, G2 = 0;
  AngleRatio() = default;
  explicit AngleRatio(double n) {
    if (n < 0.02) {
      // ten terms: g_10 0.02^10 < 1e-21
      double g = 1.0, p = 1.0, p1 = 0.0, p2 = 0.0;  // n^k, n^(k-1), n^(k-2)
      F = 2.0 * n;
      for (int k = 1; k <= 10; ++k) {
        p2 = p1;
        p1 = p;
        p *= n;
        g *= k / (2.0 * k + 1.0);
        G += g * p;
        G1 += k * g * p1;
        G2 += k * (k - 1) * g * p2;
        F += 2.0 * g * p * n / (k + 1.0);
      }
    } else {
      const double theta = 2.0 * std::asin(std::sqrt(0.5 * n)), q = n * (2.0 - n), s = std::sqrt(q);
      F = theta * theta;
      G = theta / s;
      G1 = (1.0 - (1.0 - n) * G) / q;
      G2 = (G - 3.0 * (1.0 - n) * G1) / q;
    }
  }
};

/// m += a b^T
inline void add_outer(Mat3& m, const Vec3& a, const Vec3& b) {
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      m(i, j) += a[i] * b[j];
}

/// Omega(e, v, w) = 2 atan2(N, D), N = e.(v x w), D = 1 + e.v + v.w + w.e: first and second
/// derivative in (v, w), e fixed.
struct SolidAngle {
  double value, p, r;   ///< dOmega = p dN + r dD
  double c1, c2;        ///< second derivative weights
  Vec3 Nv, Nw, Dv, Dw;  ///< gradients of N and D
  SolidAngle(const Vec3& e, const Vec3& v, const Vec3& w)
      : Nv(w.cross(e)),
        Nw(e.cross(v)),
        Dv(e + w),
        Dw(e + v) {
    const double N = v.dot(Nv), D = 1.0 + e.dot(v) + v.dot(w) + w.dot(e), Q = N * N + D * D;
    value = 2.0 * std::atan2(N, D);
    p = 2.0 * D / Q;
    r = -2.0 * N / Q;
    c1 = 2.0 * (D * D - N * N) / (Q * Q);
    c2 = 4.0 * D * N / (Q * Q);
  }
  Vec3 grad_v() const { return p * Nv + r * Dv; }
  Vec3 grad_w() const { return p * Nw + r * Dw; }
  /// m += f times the second derivative. N is bilinear with d2N/dv dw = -[e], D with 1.
  void add_vv(double f, Mat3& m) const { add(f, Nv, Dv, Nv, Dv, m); }
  void add_ww(double f, Mat3& m) const { add(f, Nw, Dw, Nw, Dw, m); }
  void add_vw(double f, const Vec3& e, Mat3& m) const {
    add(f, Nv, Dv, Nw, Dw, m);
    mixed(f, -1.0, e, m);
  }
  void add_wv(double f, const Vec3& e, Mat3& m) const {
    add(f, Nw, Dw, Nv, Dv, m);
    mixed(f, 1.0, e, m);
  }

 private:
  void add(double f, const Vec3& Nx, const Vec3& Dx, const Vec3& Ny, const Vec3& Dy,
           Mat3& m) const {
    add_outer(m, f * (c2 * Dx - c1 * Nx), Dy);
    add_outer(m, -f * (c1 * Dx + c2 * Nx), Ny);
  }
  void mixed(double f, double sign, const Vec3& e, Mat3& m) const {
    const double q = sign * f * p;
    m(0, 1) -= q * e.z();
    m(0, 2) += q * e.y();
    m(1, 0) += q * e.z();
    m(1, 2) -= q * e.x();
    m(2, 0) -= q * e.y();
    m(2, 1) += q * e.x();
    m.diagonal().array() += f * r;
  }
};

}  // namespace whirl::elements
