// Strain measures, stresses and their forces of the straight axisymmetric shaft element, written
// once: for one element (double, Dual) or several (a compiler vector). Equations, units and
// sources: shaft_beam.hpp. Included inside an anonymous namespace after angle_ratio.inl; the
// includer gives the names of core/single.hpp or core/lanes.inl, and arctangent_beyond(y, x) where
// its series ends. S: kind of numbers, S::T scalars and S::V vectors.
#pragma once

/// x less its part along the unit vector a.
template <class V>
WHIRL_INLINE V perpendicular(const V& a, const V& x) {
  return x - dot(a, x) * a;
}

/// Chord lambda = r2 - r1 = length e0 + du: l = |lambda|, a = lambda/l.
template <class S>
struct Chord {
  typename S::T l, inverse;  // l, 1/l
  typename S::T stretch;     // l - length = (2 length e0.du + du.du)/(l + length)
  typename S::V a, shift;    // a; e - a
};
template <class S>
WHIRL_INLINE Chord<S> chord_of(const typename S::T& length, const typename S::V& e0,
                               const typename S::V& e, const typename S::V& du) {
  Chord<S> c;
  const typename S::V lambda = length * e0 + du;
  c.l = root(dot(lambda, lambda));
  c.inverse = 1.0 / c.l;
  c.stretch = (2.0 * length * dot(e0, du) + dot(du, du)) / (c.l + length);
  const typename S::V alpha = c.inverse * (du - c.stretch * e0);
  c.a = e0 + alpha;
  c.shift = e - e0 - alpha;  // e - e0 is exactly zero in the line's own chart
  return c;
}

/// One end: director against chord.
template <class S>
struct End {
  typename S::V delta;              // d - a
  typename S::T n;                  // |delta|^2/2 = 1 - cos theta
  AngleRatio<typename S::T> angle;  // F = theta^2, G = theta/sin theta, G1 = dG/dn
};
template <class S>
WHIRL_INLINE End<S> end_of(const Chord<S>& chord, const typename S::V& t) {
  End<S> r;
  r.delta = t + chord.shift;
  r.n = 0.5 * dot(r.delta, r.delta);
  r.angle = angle_ratio(r.n);
  return r;
}

/// p = G q, q = delta + n a: from the chord towards the director, |p| = theta. p' less its part
/// along a, with n' = delta.(d' - a'): G1 n' q + G (d' - (a.d') a - (1 - n) a').
template <class S>
WHIRL_INLINE typename S::V bending_rate(const End<S>& x, const typename S::V& q,
                                        const typename S::V& a, const typename S::V& adot,
                                        const typename S::V& ddot) {
  const typename S::T ndot = dot(x.delta, ddot - adot);
  return (x.angle.G1 * ndot) * q + x.angle.G * (ddot - dot(a, ddot) * a - (1.0 - x.n) * adot);
}
/// Of the moment m conjugate to p', the part that acts on n'.
template <class S>
WHIRL_INLINE typename S::V cosine_force(const End<S>& x, const typename S::V& q,
                                        const typename S::V& m) {
  return (x.angle.G1 * dot(m, q)) * x.delta;
}

/// Both ends together. th_i: rotation vector from chord to director.
template <class S>
struct Strain {
  Chord<S> chord;
  End<S> end1, end2;
  typename S::V d1, d2;   // directors
  typename S::V cross12;  // delta1 x delta2
  typename S::T tau;      // a.(d1 x d2) = a.(delta1 x delta2)
  typename S::T GG;       // G1 G2: a.(th1 x th2) = GG tau
  typename S::T P;        // m - n1 n2, m = delta1.delta2
  typename S::T theta12;  // th1.th2 = GG P
};
template <class S>
WHIRL_INLINE Strain<S> strain_of(const typename S::T& length, const typename S::V& e0,
                                 const typename S::V& e, const typename S::V& du,
                                 const typename S::V& t1, const typename S::V& t2) {
  Strain<S> s;
  s.chord = chord_of<S>(length, e0, e, du);
  s.d1 = e + t1;
  s.d2 = e + t2;
  s.end1 = end_of(s.chord, t1);
  s.end2 = end_of(s.chord, t2);
  s.cross12 = cross(s.end1.delta, s.end2.delta);
  s.tau = dot(s.chord.a, s.cross12);
  s.GG = s.end1.angle.G * s.end2.angle.G;
  s.P = dot(s.end1.delta, s.end2.delta) - s.end1.n * s.end2.n;
  s.theta12 = s.GG * s.P;
  return s;
}

/// Derivatives in (a, d1, d2).
template <class S>
struct Gradient {
  typename S::V a, d1, d2;
};

/// Of tau.
template <class S>
WHIRL_INLINE Gradient<S> tau_gradient(const Strain<S>& s) {
  const typename S::V &a = s.chord.a, &delta1 = s.end1.delta, &delta2 = s.end2.delta;
  return {cross(a, delta2 - delta1) + s.cross12, cross(delta2, a), cross(a, delta1)};
}

/// Coefficients 1, -1/3, 1/5, .. of arctan(q)/q in q^2.
struct ArctangentSeries {
  double c[8]{};
  constexpr ArctangentSeries() {
    for (int k = 0; k < 8; ++k)
      c[k] = (k % 2 == 0 ? 1.0 : -1.0) / (2 * k + 1);
  }
};
constexpr ArctangentSeries arctangent_series;
WHIRL_INLINE double arctangent_beyond(double y, double x) { return ::atan2(y, x); }
/// atan2(y, x), x > 0 in all but extreme shapes.
template <class T>
WHIRL_INLINE T arctangent(T y, T x) {
  const T q = y / x, square = q * q;
  // ninth term: (1e-3)^8/17 < 1e-25
  if (every((square < 1e-3) & (x > 0.0))) return q * horner<8>(arctangent_series.c, square);
  return arctangent_beyond(y, x);
}

/// Omega(e, v, w) = 2 atan2(N, D), N = e.(v x w), D = 1 + e.v + v.w + w.e: the solid angle between
/// three unit vectors, rad.
template <class S>
struct SolidAngle {
  typename S::T value, p, r;     // dOmega = p dN + r dD, p = 2 D/(N^2 + D^2), r = -2 N/(N^2 + D^2)
  typename S::V Nv, Nw, Dv, Dw;  // gradients of N and D
  typename S::V grad_v, grad_w;  // of Omega
};
template <class S>
WHIRL_INLINE SolidAngle<S> solid_angle(const typename S::V& e, const typename S::V& v,
                                       const typename S::V& w) {
  SolidAngle<S> o;
  o.Nv = cross(w, e);
  o.Nw = cross(e, v);
  o.Dv = e + w;
  o.Dw = e + v;
  const typename S::T N = dot(v, o.Nv), D = 1.0 + dot(e, v) + dot(v, w) + dot(w, e),
                      f = 2.0 / (N * N + D * D);
  o.p = D * f;
  o.r = -(N * f);
  o.value = 2.0 * arctangent(N, D);
  o.grad_v = o.p * o.Nv + o.r * o.Dv;
  o.grad_w = o.p * o.Nw + o.r * o.Dw;
  return o;
}

/// Geometric part of the twist, tau_c GG tau - [Omega(e, d1, a) + Omega(e, a, d2)], rad.
template <class S>
struct Twist {
  SolidAngle<S> at1, at2;
  typename S::T geometric;
};
template <class S>
WHIRL_INLINE Twist<S> twist_of(const typename S::V& e, const typename S::T& tau_c,
                               const Strain<S>& s) {
  Twist<S> t;
  t.at1 = solid_angle<S>(e, s.d1, s.chord.a);
  t.at2 = solid_angle<S>(e, s.chord.a, s.d2);
  t.geometric = tau_c * s.GG * s.tau - (t.at1.value + t.at2.value);
  return t;
}
template <class S>
WHIRL_INLINE Gradient<S> twist_gradient(const Twist<S>& t, const typename S::T& tau_c,
                                        const Strain<S>& s) {
  const Gradient<S> tau = tau_gradient(s);
  const AngleRatio<typename S::T>&r1 = s.end1.angle, &r2 = s.end2.angle;
  const typename S::T cG = tau_c * s.GG, c1 = tau_c * r1.G1 * r2.G * s.tau,
                      c2 = tau_c * r1.G * r2.G1 * s.tau;
  return {cG * tau.a - c1 * s.end1.delta - c2 * s.end2.delta - t.at1.grad_w - t.at2.grad_v,
          cG * tau.d1 + c1 * s.end1.delta - t.at1.grad_v,
          cG * tau.d2 + c2 * s.end2.delta - t.at2.grad_w};
}

/// Slopes of the bending form 1/2 c11 F1 + c12 th1.th2 + 1/2 c22 F2 in (n1, n2, m).
template <class T>
struct BendingSlopes {
  T n1, n2, m;
};
template <class S>
WHIRL_INLINE BendingSlopes<typename S::T> bending_slopes(const typename S::T& c11,
                                                         const typename S::T& c12,
                                                         const typename S::T& c22,
                                                         const Strain<S>& s) {
  const AngleRatio<typename S::T>&r1 = s.end1.angle, &r2 = s.end2.angle;
  return {c11 * r1.G + c12 * (r1.G1 * r2.G * s.P - s.GG * s.end2.n),
          c22 * r2.G + c12 * (r1.G * r2.G1 * s.P - s.GG * s.end1.n), c12 * s.GG};
}
template <class S>
WHIRL_INLINE Gradient<S> bending_gradient(const BendingSlopes<typename S::T>& slope,
                                          const Strain<S>& s) {
  Gradient<S> g;
  g.d1 = slope.n1 * s.end1.delta + slope.m * s.end2.delta;
  g.d2 = slope.n2 * s.end2.delta + slope.m * s.end1.delta;
  g.a = -g.d1 - g.d2;
  return g;
}

/// The numbers of a ShaftBeam that its stresses depend on.
template <class S>
struct ShaftStiffness {
  typename S::T length, EA_l, b11, b12, b22, k11, k12, k22, GJ_l, tau_c;
  typename S::T preload, soft_torque, soft_axial, soft_shear, soft_limit;
};

/// What of the bending form stands at EA_l: w - (l - length) = length e_b, m.
template <class S>
WHIRL_INLINE typename S::T bowing(const ShaftStiffness<S>& c, const Strain<S>& s) {
  return c.length *
         (0.5 * (c.b11 * s.end1.angle.F + 2.0 * c.b12 * s.theta12 + c.b22 * s.end2.angle.F));
}

/// g = N^2/(1 + N/kGA), g1 = g'/2, g2 = g''/2; below the limit, -kGA/2, the parabola that continues
/// it. softness = 1/kGA.
template <class T>
struct ShearGive {
  T g, g1, g2;
};
template <class T, class C>
WHIRL_INLINE ShearGive<T> shear_give(const T& N, const C& softness, const C& limit) {
  const T n = at_least(N, limit), beyond = N - n, rho = 1.0 / (1.0 + softness * n);
  const T slope = 0.5 * n * rho * (1.0 + rho);
  ShearGive<T> r;
  r.g2 = rho * rho * rho;
  r.g1 = slope + r.g2 * beyond;
  r.g = n * n * rho + (slope + r.g1) * beyond;
  return r;
}

/// Stresses: V = 1/2 EA_l w^2 + preload w + bending + 1/2 GJ_l psi^2 - 1/2 Q B.
template <class S>
struct Stresses {
  typename S::T w;          // axial strain times length: stretch + bowing, m
  typename S::T N, torque;  // on the rates of w and psi, N, N m
  typename S::T B;          // |th2 - th1|^2
  typename S::T Q;          // soft_torque psi^2 + soft_axial g(N0), N m
  ShearGive<typename S::T> give;
};
template <class S>
WHIRL_INLINE Stresses<S> stresses_of(const ShaftStiffness<S>& c, const Strain<S>& s,
                                     const typename S::T& psi) {
  Stresses<S> r;
  r.w = s.chord.stretch + bowing(c, s);
  const typename S::T N0 = c.preload + c.EA_l * r.w;
  r.B = s.end1.angle.F + s.end2.angle.F - 2.0 * s.theta12;
  r.give = shear_give(N0, c.soft_shear, c.soft_limit);
  r.Q = c.soft_torque * psi * psi + c.soft_axial * r.give.g;
  r.N = N0 - c.EA_l * c.soft_axial * r.B * r.give.g1;
  r.torque = (c.GJ_l - c.soft_torque * r.B) * psi;
  return r;
}

/// Bending stiffness with what the axial force adds and the inside gives.
template <class T>
struct BendingStiffness {
  T c11, c12, c22;
};
template <class S>
WHIRL_INLINE BendingStiffness<typename S::T> bending_stiffness_of(const ShaftStiffness<S>& c,
                                                                  const Stresses<S>& r) {
  const typename S::T NL = r.N * c.length;
  return {c.k11 + NL * c.b11 - r.Q, c.k12 + NL * c.b12 + r.Q, c.k22 + NL * c.b22 - r.Q};
}

/// dV in (a, d1, d2) at constant l.
template <class S>
WHIRL_INLINE Gradient<S> elastic_gradient(const Gradient<S>& bending, const typename S::T& torque,
                                          const Gradient<S>& twist) {
  return {bending.a + torque * twist.a, bending.d1 + torque * twist.d1,
          bending.d2 + torque * twist.d2};
}

/// From the derivatives in a and l to that in lambda: da = (1 - a a^T) dlambda/l, dl = a.dlambda.
template <class S>
WHIRL_INLINE typename S::V chord_gradient(const Chord<S>& c, const typename S::T& along,
                                          const typename S::V& across) {
  return along * c.a + c.inverse * perpendicular(c.a, across);
}
