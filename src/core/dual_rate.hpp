// Derivatives of fixed width together with their rates along one direction: of a force f(x) the
// value, its rate f' = df . x', the gradient, and the rate of the gradient, all exact to round-off.
// For stiffness matrices and how they change along a motion, without differences.
#pragma once
#include <core/types.hpp>
#include <cmath>

namespace whirl {

/// v + e epsilon + (g + h epsilon) . delta with epsilon^2 = 0 and delta_i delta_j = 0: value, rate,
/// gradient, rate of the gradient.
template <int N>
struct DualRate {
  double v = 0.0, e = 0.0;
  Vector<N> g = Vector<N>::Zero(), h = Vector<N>::Zero();
  DualRate() = default;
  DualRate(double value) : v(value) {}  // implicit: constants mix with duals
  DualRate(double value, double rate, const Vector<N>& gradient, const Vector<N>& gradient_rate)
      : v(value),
        e(rate),
        g(gradient),
        h(gradient_rate) {}
  /// The independent variable k at a value, moving at a rate.
  static DualRate variable(double value, double rate, int k) {
    DualRate d(value);
    d.e = rate;
    d.g[k] = 1.0;
    return d;
  }
  /// f(x) with its first and second derivative at x.
  friend DualRate chain(const DualRate& x, double f, double df, double ddf) {
    return {f, df * x.e, df * x.g, df * x.h + (ddf * x.e) * x.g};
  }

  friend DualRate operator+(const DualRate& a, const DualRate& b) {
    return {a.v + b.v, a.e + b.e, a.g + b.g, a.h + b.h};
  }
  friend DualRate operator-(const DualRate& a, const DualRate& b) {
    return {a.v - b.v, a.e - b.e, a.g - b.g, a.h - b.h};
  }
  friend DualRate operator-(const DualRate& a) { return {-a.v, -a.e, -a.g, -a.h}; }
  friend DualRate operator*(const DualRate& a, const DualRate& b) {
    return {a.v * b.v, a.v * b.e + a.e * b.v, a.v * b.g + b.v * a.g,
            a.v * b.h + a.e * b.g + b.v * a.h + b.e * a.g};
  }
  friend DualRate operator*(double a, const DualRate& b) {
    return {a * b.v, a * b.e, a * b.g, a * b.h};
  }
  friend DualRate operator*(const DualRate& b, double a) { return a * b; }
  friend DualRate operator/(const DualRate& a, const DualRate& b) {
    const double i = 1.0 / b.v;
    return a * chain(b, i, -i * i, 2.0 * i * i * i);
  }
  DualRate& operator+=(const DualRate& b) { return *this = *this + b; }
  DualRate& operator-=(const DualRate& b) { return *this = *this - b; }
  friend DualRate sqrt(const DualRate& x) {
    const double s = std::sqrt(x.v);
    return chain(x, s, 0.5 / s, -0.25 / (s * x.v));
  }
  friend DualRate sin(const DualRate& x) {
    return chain(x, std::sin(x.v), std::cos(x.v), -std::sin(x.v));
  }
  friend DualRate cos(const DualRate& x) {
    return chain(x, std::cos(x.v), -std::sin(x.v), -std::cos(x.v));
  }
  friend DualRate atan2(const DualRate& y, const DualRate& x) {
    // d = (x dy - y dx)/(x^2 + y^2), carried by numbers that have the value and the rate of what
    // they stand for
    const double q = x.v * x.v + y.v * y.v, dq = 2.0 * (x.v * x.e + y.v * y.e);
    const double a = x.v / q, b = -y.v / q;
    const double da = (x.e - a * dq) / q, db = (-y.e - b * dq) / q;
    return {std::atan2(y.v, x.v), a * y.e + b * x.e, a * y.g + b * x.g,
            a * y.h + b * x.h + da * y.g + db * x.g};
  }
};

template <int N>
double value(const DualRate<N>& x) {
  return x.v;
}

}  // namespace whirl
