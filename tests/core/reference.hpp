// Independent references in long double (64-bit mantissa): matrix exponential and central
// differences.
#pragma once
#include <core/types.hpp>
#include <cmath>
#include <random>

namespace whirl::test {

using Real = long double;
using RVec3 = Eigen::Matrix<Real, 3, 1>;
using RVec2 = Eigen::Matrix<Real, 2, 1>;
using RMat3 = Eigen::Matrix<Real, 3, 3>;

inline RMat3 r_skew(const RVec3& a) {
  RMat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

/// exp([v]) by scaling, Taylor and squaring.
inline RMat3 exponential(const RVec3& v) {
  const int squarings = 8;
  const RMat3 a = r_skew(v) / Real(1 << squarings);
  // exp(a) - 1 is squared as (1+e)^2 - 1 = 2e + e^2, which keeps the digits of small rotations
  RMat3 e = RMat3::Zero(), term = RMat3::Identity();
  for (int k = 1; k < 25; ++k) {
    term = (term * a / Real(k)).eval();
    e += term;
  }
  for (int k = 0; k < squarings; ++k)
    e = (2 * e + e * e).eval();
  return RMat3::Identity() + e;
}

/// Eighth-order central difference of f at 0 with step h.
template <class F>
auto central(const F& f, Real h) {
  return (((f(h) - f(-h)) * (4.0L / 5.0L) - (f(2 * h) - f(-2 * h)) * (1.0L / 5.0L) +
           (f(3 * h) - f(-3 * h)) * (4.0L / 105.0L) - (f(4 * h) - f(-4 * h)) * (1.0L / 280.0L)) /
          h)
      .eval();
}

/// Eighth-order central second difference.
template <class F>
auto central2(const F& f, Real h) {
  return (((f(h) + f(-h)) * (8.0L / 5.0L) - (f(2 * h) + f(-2 * h)) * (1.0L / 5.0L) +
           (f(3 * h) + f(-3 * h)) * (8.0L / 315.0L) - (f(4 * h) + f(-4 * h)) * (1.0L / 560.0L) -
           f(Real(0)) * (205.0L / 72.0L)) /
          (h * h))
      .eval();
}

/// Reproducible random numbers.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number() { return distribution_(engine_); }
  template <int N>
  Vector<N> vector() {
    Vector<N> v;
    for (int i = 0; i < N; ++i)
      v[i] = number();
    return v;
  }
  /// Of length 1.
  template <int N>
  Vector<N> direction() {
    Vector<N> v;
    do
      v = vector<N>();
    while (v.norm() < 0.1 || v.norm() > 1.0);
    return v / v.norm();
  }
  Mat3 rotation() {
    return exponential((direction<3>() * (pi * number())).template cast<Real>())
        .template cast<double>();
  }

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> distribution_{-1.0, 1.0};
};

}  // namespace whirl::test
