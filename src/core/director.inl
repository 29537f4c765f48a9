// The director d(gamma) = e cos g + (sin g/g) gamma x e and its motion, for one node (T = double)
// or several (T a compiler vector). Included inside an anonymous namespace after <math.h>; the
// includer gives bool every(mask), WHIRL_INLINE and core/series.inl. The functions b_k are those of
// BesselRatios (core/rotation.hpp).

// b_m = sum_k (-x/2)^k / (k! (2m+2k+1)!!).
template <int M>
struct BesselSeries {
  double c[12]{};
  constexpr BesselSeries() {
    long double first = 1.0L;
    for (int j = 1; j <= 2 * M + 1; j += 2)
      first *= j;
    long double term = 1.0L / first;
    for (int k = 0; k < 12; ++k) {
      c[k] = static_cast<double>(term);
      term *= -0.5L / (static_cast<long double>(k + 1) * (2 * M + 2 * k + 3));
    }
  }
};
constexpr BesselSeries<2> series_b2;
constexpr BesselSeries<3> series_b3;

template <class T>
struct Ratios {
  T b0, b1, b2, b3, cosine;
};

// Downwards the recurrence b_{k-1} = (2k+1) b_k - x b_{k+1} is stable for small x.
template <class T>
WHIRL_INLINE Ratios<T> downwards(T x, T b2, T b3) {
  const T b1 = 5.0 * b2 - x * b3, b0 = 3.0 * b1 - x * b2;
  return {b0, b1, b2, b3, b0 - x * b1};
}

WHIRL_INLINE Ratios<double> by_trigonometry(double x) {
  const double g = ::sqrt(x);
  Ratios<double> r;
  r.cosine = ::cos(g);
  r.b0 = ::sin(g) / g;
  r.b1 = (r.b0 - r.cosine) / x;
  r.b2 = (3.0 * r.b1 - r.b0) / x;
  r.b3 = (5.0 * r.b2 - r.b1) / x;
  return r;
}
/// Writes those with x > 4 anew.
WHIRL_INLINE void redo_large(double x, Ratios<double>& r) {
  if (x > 4.0) r = by_trigonometry(x);
}

template <class T>
WHIRL_INLINE Ratios<T> ratios_of(T x) {
  // Usual tilts (below 0.2 rad) need six terms; twelve are exact up to the chart switch at 2 rad.
  if (every(x <= 0.04)) return downwards(x, horner<6>(series_b2.c, x), horner<6>(series_b3.c, x));
  Ratios<T> r = downwards(x, horner<12>(series_b2.c, x), horner<12>(series_b3.c, x));
  if (!every(x <= 4.0)) redo_large(x, r);
  return r;
}

/// cos g - 1 without cancellation; the second form where the cosine is negative.
WHIRL_INLINE double cosine_less_one(double x, const Ratios<double>& b) {
  return b.cosine > -0.5 ? -x * b.b0 * b.b0 / (1.0 + b.cosine) : b.cosine - 1.0;
}

/// t = d - e and D = dd/dgamma (row, column) in chart axes (e, e2, e3).
template <class T>
struct Place {
  T t[3], D[3][2];
};
template <class T>
WHIRL_INLINE Place<T> place_of(T g2, T g3, T x, const Ratios<T>& b) {
  Place<T> o;
  o.t[0] = cosine_less_one(x, b);
  o.t[1] = b.b0 * g3;
  o.t[2] = -(b.b0 * g2);
  o.D[0][0] = -(b.b0 * g2);
  o.D[0][1] = -(b.b0 * g3);
  const T b3 = b.b1 * g3, b2 = b.b1 * g2;
  o.D[1][0] = -(b3 * g2);
  o.D[1][1] = b.b0 - b3 * g3;
  o.D[2][0] = b2 * g2 - b.b0;
  o.D[2][1] = b2 * g3;
  return o;
}

/// D' = d(d')/dgamma at the rates w: the second derivative of d contracted with w.
template <class T>
WHIRL_INLINE void jacobian_rate(T g2, T g3, T w2, T w3, const Ratios<T>& b, T (&r)[3][2]) {
  const T alpha = g2 * w2 + g3 * w3, ba = b.b1 * alpha, bg2 = b.b1 * g2, bg3 = b.b1 * g3;
  // p = gamma x e = (g3, -g2) turns into (w3, -w2)
  const T l3 = b.b2 * alpha * g3 - b.b1 * w3, l2 = b.b1 * w2 - b.b2 * alpha * g2;
  r[0][0] = ba * g2 - b.b0 * w2;
  r[0][1] = ba * g3 - b.b0 * w3;
  r[1][0] = l3 * g2 - bg3 * w2;
  r[1][1] = l3 * g3 - bg3 * w3 - ba;
  r[2][0] = l2 * g2 + bg2 * w2 + ba;
  r[2][1] = l2 * g3 + bg2 * w3;
}

/// d' = D w, d'' = D a + D' w.
template <class T>
WHIRL_INLINE void motion_of(const Place<T>& o, const T (&r)[3][2], T w2, T w3, T a2, T a3,
                            T (&rate)[3], T (&accel)[3]) {
  for (int i = 0; i < 3; ++i) {
    rate[i] = o.D[i][0] * w2 + o.D[i][1] * w3;
    accel[i] = o.D[i][0] * a2 + o.D[i][1] * a3 + r[i][0] * w2 + r[i][1] * w3;
  }
}
