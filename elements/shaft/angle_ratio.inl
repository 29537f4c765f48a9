// G(n) = theta/sin theta and F(n) = theta^2 as functions of n = 1 - cos theta, 0 <= n < 2, which
// keeps the digits of a small angle; dimensionless. F' = 2 G and n (2 - n) G' = 1 - (1 - n) G, from
// which
//   G = sum g_k n^k,   g_0 = 1,  g_k = k/(2k + 1) g_(k-1),   F = 2 n sum g_k/(k + 1) n^k.
// For one element (double) or several (a compiler vector). Included inside an anonymous namespace;
// the includer gives WHIRL_INLINE, every, core/series.inl, <math.h>, and for vectors
// angle_ratio_beyond(n, ratio), called where not every n is within the series.
#pragma once

/// Coefficients of G, of its derivatives, and of F/(2 n).
struct AngleSeries {
  double G[11]{}, G1[10]{}, G2[10]{}, G3[9]{}, F[11]{};
  constexpr AngleSeries() {
    double g = 1.0;
    for (int k = 0; k <= 11; ++k) {
      if (k > 0) g = g * k / (2 * k + 1);
      if (k <= 10) G[k] = g;
      if (k <= 10) F[k] = g / (k + 1);
      if (k >= 1 && k <= 10) G1[k - 1] = k * g;
      if (k >= 2) G2[k - 2] = k * (k - 1) * g;
      if (k >= 3) G3[k - 3] = k * (k - 1) * (k - 2) * g;
    }
  }
};
constexpr AngleSeries angle_series;
/// Beyond it the closed forms are as exact; below it the eleventh term is under 0.02^10 g_10 =
/// 1e-21.
constexpr double angle_series_limit = 0.02;

template <class T>
struct AngleRatio {
  T F, G, G1;  // G1 = dG/dn
};

template <int N, int N1, class T>
WHIRL_INLINE AngleRatio<T> angle_by_series(T n) {
  AngleRatio<T> r;
  r.G = horner<N>(angle_series.G, n);
  r.G1 = horner<N1>(angle_series.G1, n);
  r.F = 2.0 * n * horner<N>(angle_series.F, n);
  return r;
}
WHIRL_INLINE AngleRatio<double> angle_by_arcsine(double n) {
  const double theta = 2.0 * ::asin(__builtin_sqrt(0.5 * n)), q = n * (2.0 - n);
  AngleRatio<double> r;
  r.F = theta * theta;
  r.G = theta / __builtin_sqrt(q);
  r.G1 = (1.0 - (1.0 - n) * r.G) / q;
  return r;
}
WHIRL_INLINE void angle_ratio_beyond(double n, AngleRatio<double>& r) {
  r = n < angle_series_limit ? angle_by_series<11, 10>(n) : angle_by_arcsine(n);
}

template <class T>
WHIRL_INLINE AngleRatio<T> angle_ratio(T n) {
  // sixth terms of usual bends: 0.02 (2e-4)^5 < 1e-20
  if (every(n < 2e-4)) return angle_by_series<5, 5>(n);
  if (every(n < angle_series_limit)) return angle_by_series<11, 10>(n);
  AngleRatio<T> r{};
  angle_ratio_beyond(n, r);
  return r;
}

/// d2G/dn2 and d3G/dn3, r = angle_ratio(n).
WHIRL_INLINE double angle_ratio_second(double n, const AngleRatio<double>& r) {
  if (n < angle_series_limit) return horner<10>(angle_series.G2, n);
  return (r.G - 3.0 * (1.0 - n) * r.G1) / (n * (2.0 - n));
}
WHIRL_INLINE double angle_ratio_third(double n, const AngleRatio<double>& r) {
  if (n < angle_series_limit) return horner<9>(angle_series.G3, n);
  return (4.0 * r.G1 - 5.0 * (1.0 - n) * angle_ratio_second(n, r)) / (n * (2.0 - n));
}
