// Forward-mode derivatives of fixed width, for kernels whose closed-form tangent would be longer
// than it is worth: exact to round-off, no allocation. Vec3T works with double and with Dual alike.
#pragma once
#include <core/types.hpp>
#include <cmath>

namespace whirl {

/// v + g . epsilon, N independent directions.
template <int N>
struct Dual {
  double v = 0.0;
  Vector<N> g = Vector<N>::Zero();
  Dual() = default;
  Dual(double value) : v(value) {}  // implicit: constants mix with duals
  Dual(double value, const Vector<N>& gradient) : v(value), g(gradient) {}
  static Dual variable(double value, int k) {
    Dual d(value);
    d.g[k] = 1.0;
    return d;
  }

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.v + b.v, a.g + b.g}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.v - b.v, a.g - b.g}; }
  friend Dual operator-(const Dual& a) { return {-a.v, -a.g}; }
  friend Dual operator*(const Dual& a, const Dual& b) { return {a.v * b.v, a.v * b.g + b.v * a.g}; }
  friend Dual operator*(double a, const Dual& b) { return {a * b.v, a * b.g}; }
  friend Dual operator*(const Dual& b, double a) { return {a * b.v, a * b.g}; }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double q = a.v / b.v;
    return {q, (a.g - q * b.g) / b.v};
  }
  Dual& operator+=(const Dual& b) {
    v += b.v;
    g += b.g;
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    v -= b.v;
    g -= b.g;
    return *this;
  }
  /// f(x) with derivative df at x.
  friend Dual chain(const Dual& x, double f, double df) { return {f, df * x.g}; }
  friend Dual sqrt(const Dual& x) {
    const double s = std::sqrt(x.v);
    return {s, x.g / (2.0 * s)};
  }
  friend Dual sin(const Dual& x) { return {std::sin(x.v), std::cos(x.v) * x.g}; }
  friend Dual cos(const Dual& x) { return {std::cos(x.v), -std::sin(x.v) * x.g}; }
  friend Dual atan2(const Dual& y, const Dual& x) {
    const double q = x.v * x.v + y.v * y.v;
    return {std::atan2(y.v, x.v), (x.v * y.g - y.v * x.g) / q};
  }
};

inline double value(double x) { return x; }
template <int N>
double value(const Dual<N>& x) {
  return x.v;
}
inline double chain(double, double f, double) { return f; }

/// Three components of any scalar.
template <class T>
struct Vec3T {
  T x{}, y{}, z{};
  Vec3T() = default;
  Vec3T(T a, T b, T c) : x(a), y(b), z(c) {}
  explicit Vec3T(const Vec3& v) : x(v.x()), y(v.y()), z(v.z()) {}
  /// Independent variables k, k+1, k+2 at v (T must be a Dual).
  static Vec3T variable(const Vec3& v, int k) {
    return {T::variable(v.x(), k), T::variable(v.y(), k + 1), T::variable(v.z(), k + 2)};
  }
  friend Vec3T operator+(const Vec3T& a, const Vec3T& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend Vec3T operator-(const Vec3T& a, const Vec3T& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Vec3T operator*(const T& s, const Vec3T& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec3T operator/(const Vec3T& a, const T& s) { return (T(1.0) / s) * a; }
  friend Vec3T operator-(const Vec3T& a) { return {-a.x, -a.y, -a.z}; }
  T dot(const Vec3T& b) const { return x * b.x + y * b.y + z * b.z; }
  Vec3T cross(const Vec3T& b) const {
    return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x};
  }
};

}  // namespace whirl
