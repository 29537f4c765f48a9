// The motion of a node that follows another one, X_b = X_b(X_a, angle, slide), for any scalar S:
// values, derivatives, time rates and derivatives of those come from one formula.
//
// Body a stands at R_a = L(d) L(phi e) C_a against the reference, C_a its moved axes (frames.hpp).
// With n the axis and o the arm from a to b, both of the reference and fixed in a,
//   r_b = r_a + R_a (o + slide n),   R_b = R_a L(angle n).
// Of b is wanted u, d - e_b and phi about e_b. With s(d) = (1 + e.d, e x d) the quaternion of L(d)
// up to its length, p = s (cos phi/2, e sin phi/2) (cos angle/2, n sin angle/2) k the quaternion of
// L(d_b) L(phi_b e_b), k that of C_a C_b^T:
//   phi_b = 2 arg z,   z = p_0 + i e_b.p
// which is linear in d, as in AngleTransport. Nothing is normalised: any smooth extension off |d| =
// 1 serves (node.hpp).
#pragma once
#include <core/dual.hpp>
#include <core/types.hpp>

namespace whirl::system::joints {

inline constexpr int inputs = 6;  ///< d (3), phi, angle, slide
using First = Dual<inputs>;

/// Value, gradient and second derivatives.
struct Second {
  double v = 0.0;
  Vector<inputs> g = Vector<inputs>::Zero();
  Matrix<inputs> h = Matrix<inputs>::Zero();
  Second() = default;
  Second(double value) : v(value) {}
  Second(double value, const Vector<inputs>& gradient, const Matrix<inputs>& second)
      : v(value),
        g(gradient),
        h(second) {}
  static Second variable(double value, int k) {
    Second d(value);
    d.g[k] = 1.0;
    return d;
  }
  friend Second operator+(const Second& a, const Second& b) {
    return {a.v + b.v, a.g + b.g, a.h + b.h};
  }
  friend Second operator-(const Second& a, const Second& b) {
    return {a.v - b.v, a.g - b.g, a.h - b.h};
  }
  friend Second operator*(double a, const Second& b) { return {a * b.v, a * b.g, a * b.h}; }
  friend Second operator*(const Second& a, const Second& b) {
    return {a.v * b.v, a.v * b.g + b.v * a.g,
            a.v * b.h + b.v * a.h + a.g * b.g.transpose() + b.g * a.g.transpose()};
  }
  /// f(x) with its two derivatives at x.
  friend Second chain(const Second& x, double f, double df, double ddf) {
    return {f, df * x.g, df * x.h + ddf * x.g * x.g.transpose()};
  }
};

inline double inverse(double x) { return 1.0 / x; }
inline First inverse(const First& x) { return 1.0 / x; }
inline Second inverse(const Second& x) {
  const double i = 1.0 / x.v;
  return chain(x, i, -i * i, 2.0 * i * i * i);
}
inline Second sin(const Second& x) {
  const double s = std::sin(x.v);
  return chain(x, s, std::cos(x.v), -s);
}
inline Second cos(const Second& x) {
  const double c = std::cos(x.v);
  return chain(x, c, -std::sin(x.v), -c);
}
inline Second atan2(const Second& y, const Second& x) {
  const double r2 = x.v * x.v + y.v * y.v;
  // ln z = ln(x + i y): the second derivative is Im(z''/z - (z'/z)^2)
  const Vector<inputs> re = (x.v * x.g + y.v * y.g) / r2, im = (x.v * y.g - y.v * x.g) / r2;
  return {std::atan2(y.v, x.v), im,
          Matrix<inputs>((x.v * y.h - y.v * x.h) / r2 - re * im.transpose() - im * re.transpose())};
}

/// Value and the first two time derivatives of T: double, or First.
template <class T>
struct Rate {
  T v{0.0}, d{0.0}, dd{0.0};
  Rate() = default;
  Rate(double value) : v(value) {}
  Rate(const T& value, const T& rate, const T& accel) : v(value), d(rate), dd(accel) {}
  friend Rate operator+(const Rate& a, const Rate& b) {
    return {a.v + b.v, a.d + b.d, a.dd + b.dd};
  }
  friend Rate operator-(const Rate& a, const Rate& b) {
    return {a.v - b.v, a.d - b.d, a.dd - b.dd};
  }
  friend Rate operator*(double a, const Rate& b) { return {a * b.v, a * b.d, a * b.dd}; }
  friend Rate operator*(const Rate& a, const Rate& b) {
    return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2.0 * (a.d * b.d) + a.v * b.dd};
  }
};
template <class T>
Rate<T> inverse(const Rate<T>& x) {
  const T i = inverse(x.v), i2 = i * i;
  return {i, T(-1.0 * (i2 * x.d)), T(2.0 * (i2 * i * x.d * x.d) - i2 * x.dd)};
}
template <class T>
Rate<T> sin(const Rate<T>& x) {
  using std::cos;
  using std::sin;
  const T s = sin(x.v), c = cos(x.v);
  return {s, c * x.d, c * x.dd - s * x.d * x.d};
}
template <class T>
Rate<T> cos(const Rate<T>& x) {
  using std::cos;
  using std::sin;
  const T s = sin(x.v), c = cos(x.v);
  return {c, T(-1.0 * (s * x.d)), T(-1.0 * (s * x.dd + c * x.d * x.d))};
}
template <class T>
Rate<T> atan2(const Rate<T>& y, const Rate<T>& x) {
  using std::atan2;
  const T over = inverse(T(x.v * x.v + y.v * y.v));
  const T re = (x.v * x.d + y.v * y.d) * over, im = (x.v * y.d - y.v * x.d) * over;
  return {atan2(y.v, x.v), im, (x.v * y.dd - y.v * x.dd) * over - 2.0 * (re * im)};
}

template <class S>
struct Vec {
  S x, y, z;
  Vec() = default;
  Vec(const S& a, const S& b, const S& c) : x(a), y(b), z(c) {}
  Vec(const Vec3& a) : x(a.x()), y(a.y()), z(a.z()) {}
  friend Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
};
template <class S>
Vec<S> times(const S& s, const Vec3& a) {
  return {a.x() * s, a.y() * s, a.z() * s};
}
template <class S>
Vec<S> times(const S& s, const Vec<S>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class S>
S dot(const Vec3& a, const Vec<S>& b) {
  return a.x() * b.x + a.y() * b.y + a.z() * b.z;
}
template <class S>
S dot(const Vec<S>& a, const Vec<S>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S>
Vec<S> cross(const Vec3& a, const Vec<S>& b) {
  return {a.y() * b.z - a.z() * b.y, a.z() * b.x - a.x() * b.z, a.x() * b.y - a.y() * b.x};
}

/// What does not change while the axes stand.
struct Axes {
  Vec3 e;          ///< of a
  Vec3 e_b;        ///< of b
  Vec3 normal;     ///< C_a times the reference normal of b
  Vec3 axis;       ///< C_a n
  Vec3 arm, arm0;  ///< C_a o, and o, m
  double k0;       ///< quaternion of C_a C_b^T
  Vec3 k;
};

template <class S>
struct Inputs {
  Vec<S> t;  ///< d - e of a
  S phi, angle, slide;
};
template <class S>
struct Outputs {
  Vec<S> u;           ///< u_b - u_a, m
  Vec<S> t;           ///< d_b - e_b
  S real, imaginary;  ///< z
};

/// How the motion of a changes a vector fixed in it, L(d) L(phi e) x - x; small where the motion
/// is. sine, versine: sin phi, 1 - cos phi.
template <class S>
Vec<S> change(const Axes& k, const Inputs<S>& in, const S& sine, const S& versine,
              const S& over_divisor, const Vec<S>& x) {
  const S along = dot(k.e, x);
  const Vec<S> across = times(along, k.e) + times(S(-1.0), x);  // e x (e x x)
  const Vec<S> turn = times(sine, cross(k.e, x)) + times(versine, across);
  const Vec<S> b = x + turn;
  const S et = dot(k.e, in.t), tb = dot(in.t, b);
  const S of_e = 2.0 * ((along * et - tb) * over_divisor);
  const S of_t = 2.0 * along - (2.0 * along + tb) * over_divisor;
  return turn + times(of_e, k.e) + times(of_t, in.t);
}

template <class S>
Outputs<S> place(const Axes& k, const Inputs<S>& in) {
  using std::cos;
  using std::sin;
  const S c = cos(0.5 * in.phi), s = sin(0.5 * in.phi);
  const S ca = cos(0.5 * in.angle), sa = sin(0.5 * in.angle);
  const S sine = 2.0 * (s * c), versine = 2.0 * (s * s);
  const S divisor = S(2.0) + dot(k.e, in.t);  // 1 + e.d
  const S over = inverse(divisor);
  Outputs<S> out;

  const Vec<S> slide = times(in.slide, k.axis);
  out.u = Vec<S>(Vec3(k.arm - k.arm0)) + slide +
          change(k, in, sine, versine, over, Vec<S>(k.arm) + slide);

  const Vec3 aside = k.axis.cross(k.normal), back = k.axis.cross(aside);
  const Vec<S> turned = times(S(2.0 * (sa * ca)), aside) + times(S(2.0 * (sa * sa)), back);
  out.t = Vec<S>(Vec3(k.normal - k.e_b)) + turned +
          change(k, in, sine, versine, over, Vec<S>(k.normal) + turned);

  // s (c, e s): (e x d).e = 0
  const Vec<S> w = cross(k.e, in.t);
  const Vec<S> we = times(S(-1.0), cross(k.e, w));
  const S p0 = divisor * c;
  const Vec<S> p = times(c, w) + times(S(divisor * s), k.e) + times(s, we);
  // times (ca, n sa)
  const S q0 = p0 * ca - dot(k.axis, p) * sa;
  const Vec<S> pn = times(S(-1.0), cross(k.axis, p));
  const Vec<S> q = times(ca, p) + times(S(p0 * sa), k.axis) + times(sa, pn);
  // times k: scalar part and the part along e_b
  out.real = k.k0 * q0 - dot(k.k, q);
  out.imaginary = k.e_b.dot(k.k) * q0 + dot(Vec3(k.k0 * k.e_b + k.k.cross(k.e_b)), q);
  return out;
}

}  // namespace whirl::system::joints
