// The force of internal and external damping (shaft_damping.hpp), for one element (double, Dual) or
// several (a compiler vector). Included inside an anonymous namespace. S gives the scalar S::T and
// the vector S::V with +, -, scalar *, and the free functions dot, cross, root(x) = sqrt,
// constant<S>(x); angle_ratio(n, G, G1) gives G = theta/sin theta and dG/dn at n = 1 - cos theta.

/// Parameters of ShaftDamping.
template <class S>
struct DampingParameters {
  typename S::V e0;
  typename S::T length, d11, d12, d22, d_twist, d_axial;
};

/// Rates the damping acts on: lambda' = r2' - r1', directors, axial angles.
template <class S>
struct DampingRates {
  typename S::V lambda{}, d1{}, d2{};
  typename S::T phi1{}, phi2{};
};

/// Force in (lambda, d1, d2, phi1, phi2), linear in the rates.
template <class S>
struct DampingForce {
  typename S::V lambda, d1, d2;
  typename S::T phi1, phi2, power;
};

/// What of the kinematics one end contributes.
template <class S>
struct DampingEnd {
  typename S::V delta, q, w, ad;  // d - a; d - (a.d) a; spin form; (a x d)/(1 + a.d)
  typename S::T n, G, G1;
};
template <class S>
WHIRL_INLINE DampingEnd<S> damping_end(const typename S::V& e, const typename S::V& t,
                                       const typename S::V& a, const typename S::V& shift) {
  DampingEnd<S> r;
  r.delta = t + shift;
  r.n = 0.5 * dot(r.delta, r.delta);
  angle_ratio(r.n, r.G, r.G1);
  r.q = r.delta + r.n * a;
  r.w = (1.0 / (2.0 + dot(e, t))) * cross(e, t);
  r.ad = (1.0 / (2.0 - r.n)) * cross(a, r.delta);
  return r;
}

template <bool Rotating, class S>
WHIRL_INLINE DampingForce<S> damping_force(const DampingParameters<S>& p, const typename S::V& e,
                                           const typename S::V& du, const typename S::V& t1,
                                           const typename S::V& t2, const DampingRates<S>& v) {
  using T = typename S::T;
  using V = typename S::V;
  const V chord = p.length * p.e0 + du;
  const T l = root(dot(chord, chord)), il = 1.0 / l;
  const T stretch = (2.0 * p.length * dot(p.e0, du) + dot(du, du)) / (l + p.length);
  const V alpha = il * (du - stretch * p.e0), a = p.e0 + alpha,
          shift = e - p.e0 - alpha;  // e - e0 is exactly zero in the line's own chart
  const DampingEnd<S> e1 = damping_end<S>(e, t1, a, shift), e2 = damping_end<S>(e, t2, a, shift);
  const T ldot = dot(a, v.lambda);
  const V adot = il * (v.lambda - ldot * a);

  auto strain_rate = [&](const DampingEnd<S>& x, const V& dd)
      __attribute__((always_inline)) {  // p' perpendicular to a
    const T ndot = dot(x.delta, dd - adot);
    return (x.G1 * ndot) * x.q + x.G * (dd - dot(a, dd) * a - (1.0 - x.n) * adot);
  };
  auto spin = [&](const DampingEnd<S>& x, const V& dd, const T& phi)
      __attribute__((always_inline)) {
    return phi + dot(x.ad - x.w, dd) + dot(x.ad, adot);
  };
  const T s1 = spin(e1, v.d1, v.phi1), s2 = spin(e2, v.d2, v.phi2);
  V r1 = strain_rate(e1, v.d1), r2 = strain_rate(e2, v.d2);
  V turned1{}, turned2{};  // a x p
  if constexpr (Rotating) {
    const T sigma = 0.5 * (s1 + s2);
    turned1 = e1.G * cross(a, e1.q);
    turned2 = e2.G * cross(a, e2.q);
    r1 = r1 - sigma * turned1;
    r2 = r2 - sigma * turned2;
  }
  const V m1 = p.d11 * r1 + p.d12 * r2, m2 = p.d12 * r1 + p.d22 * r2;
  const T torque = p.d_twist * (s2 - s1);
  T b1 = -torque, b2 = torque;  // conjugate to sigma_1, sigma_2
  if constexpr (Rotating) {
    const T s = -0.5 * (dot(m1, turned1) + dot(m2, turned2));
    b1 = b1 + s;
    b2 = b2 + s;
  }
  DampingForce<S> f;
  const V k1 = (e1.G1 * dot(m1, e1.q)) * e1.delta, k2 = (e2.G1 * dot(m2, e2.q)) * e2.delta;
  auto perpendicular = [&](const V& x) __attribute__((always_inline)) { return x - dot(a, x) * a; };
  f.d1 = k1 + e1.G * perpendicular(m1) + b1 * (e1.ad - e1.w);
  f.d2 = k2 + e2.G * perpendicular(m2) + b2 * (e2.ad - e2.w);
  const V fa =
      b1 * e1.ad + b2 * e2.ad - k1 - k2 - (e1.G * (1.0 - e1.n)) * m1 - (e2.G * (1.0 - e2.n)) * m2;
  f.lambda = il * perpendicular(fa) + (p.d_axial * ldot) * a;
  f.phi1 = b1;
  f.phi2 = b2;
  f.power = dot(m1, r1) + dot(m2, r2) + torque * (s2 - s1) + p.d_axial * ldot * ldot;
  return f;
}
