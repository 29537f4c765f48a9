// The force of internal and external damping (shaft_damping.hpp), for one element (double, Dual) or
// several (a compiler vector). Included inside an anonymous namespace after shaft_strain.inl and
// system/spin.inl.
#pragma once

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

/// Force in (lambda, d1, d2, phi1, phi2), linear in the rates, and the power it takes, W.
template <class S>
struct DampingForce {
  typename S::V lambda, d1, d2;
  typename S::T phi1, phi2, power;
};

/// What of the kinematics one end contributes: p = G q; sigma = phi' + (ad - w).d' + ad.a'.
template <class S>
struct DampingEnd {
  End<S> end;
  typename S::V q;   // d - (a.d) a = delta + n a
  typename S::V w;   // spin form (e x d)/(1 + e.d)
  typename S::V ad;  // (a x d)/(1 + a.d)
};
template <class S>
WHIRL_INLINE DampingEnd<S> damping_end(const typename S::V& e, const typename S::V& t,
                                       const Chord<S>& chord) {
  DampingEnd<S> r;
  r.end = end_of(chord, t);
  r.q = r.end.delta + r.end.n * chord.a;
  r.w = spin_form(e, t, spin_divisor(e, t));
  r.ad = cross(chord.a, r.end.delta) / divisor(2.0 - r.end.n);
  return r;
}

/// sigma: spin of one end about the chord.
template <class S>
WHIRL_INLINE typename S::T spin_about_chord(const DampingEnd<S>& x, const typename S::V& adot,
                                            const typename S::V& ddot,
                                            const typename S::T& phi_rate) {
  return phi_rate + dot(x.ad - x.w, ddot) + dot(x.ad, adot);
}

/// Moments and torque of the rates, and what the moments add to the forces on both sigma.
template <class S>
struct DampingStresses {
  typename S::V m1, m2;
  typename S::T torque, turning, power;
};
template <bool Rotating, class S>
WHIRL_INLINE DampingStresses<S> damping_stresses(const DampingParameters<S>& p,
                                                 const DampingEnd<S>& e1, const DampingEnd<S>& e2,
                                                 const Chord<S>& chord, const typename S::V& adot,
                                                 const DampingRates<S>& v) {
  const typename S::V& a = chord.a;
  const typename S::T s1 = spin_about_chord(e1, adot, v.d1, v.phi1);
  const typename S::T s2 = spin_about_chord(e2, adot, v.d2, v.phi2);
  typename S::V r1 = bending_rate(e1.end, e1.q, a, adot, v.d1),
                r2 = bending_rate(e2.end, e2.q, a, adot, v.d2);
  typename S::V turned1{}, turned2{};  // a x p
  if constexpr (Rotating) {
    const typename S::T sigma = 0.5 * (s1 + s2);
    turned1 = e1.end.angle.G * cross(a, e1.q);
    turned2 = e2.end.angle.G * cross(a, e2.q);
    r1 = r1 - sigma * turned1;
    r2 = r2 - sigma * turned2;
  }
  DampingStresses<S> o;
  o.m1 = p.d11 * r1 + p.d12 * r2;
  o.m2 = p.d12 * r1 + p.d22 * r2;
  o.torque = p.d_twist * (s2 - s1);
  if constexpr (Rotating) o.turning = -0.5 * (dot(o.m1, turned1) + dot(o.m2, turned2));
  o.power = dot(o.m1, r1) + dot(o.m2, r2) + o.torque * (s2 - s1);
  return o;
}

/// Both ends and the chord, which the rates do not change.
template <class S>
struct DampingKinematics {
  Chord<S> chord;
  DampingEnd<S> e1, e2;
};
template <class S>
WHIRL_INLINE DampingKinematics<S> damping_kinematics(const DampingParameters<S>& p,
                                                     const typename S::V& e,
                                                     const typename S::V& du,
                                                     const typename S::V& t1,
                                                     const typename S::V& t2) {
  const Chord<S> chord = chord_of<S>(p.length, p.e0, e, du);
  return {chord, damping_end<S>(e, t1, chord), damping_end<S>(e, t2, chord)};
}

template <bool Rotating, class S>
WHIRL_INLINE DampingForce<S> damping_force(const DampingParameters<S>& p,
                                           const DampingKinematics<S>& x,
                                           const DampingRates<S>& v) {
  const typename S::V& a = x.chord.a;
  const DampingEnd<S>&e1 = x.e1, &e2 = x.e2;
  const typename S::T ldot = dot(a, v.lambda);
  const typename S::V adot = x.chord.inverse * (v.lambda - ldot * a);
  const DampingStresses<S> r = damping_stresses<Rotating>(p, e1, e2, x.chord, adot, v);
  typename S::T b1 = -r.torque, b2 = r.torque;  // conjugate to sigma_1, sigma_2
  if constexpr (Rotating) {
    b1 = b1 + r.turning;
    b2 = b2 + r.turning;
  }
  const typename S::V k1 = cosine_force(e1.end, e1.q, r.m1), k2 = cosine_force(e2.end, e2.q, r.m2);
  const typename S::T &G1 = e1.end.angle.G, &G2 = e2.end.angle.G;
  DampingForce<S> f;
  f.d1 = k1 + G1 * perpendicular(a, r.m1) + b1 * (e1.ad - e1.w);
  f.d2 = k2 + G2 * perpendicular(a, r.m2) + b2 * (e2.ad - e2.w);
  const typename S::V fa = b1 * e1.ad + b2 * e2.ad - k1 - k2 - (G1 * (1.0 - e1.end.n)) * r.m1 -
                           (G2 * (1.0 - e2.end.n)) * r.m2;
  f.lambda = x.chord.inverse * perpendicular(a, fa) + (p.d_axial * ldot) * a;
  f.phi1 = b1;
  f.phi2 = b2;
  f.power = r.power + p.d_axial * ldot * ldot;
  return f;
}
