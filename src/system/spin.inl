// Spin about the section's own normal, for one node (double, Dual) or several (a compiler vector):
//   w = (e x d)/(1 + e.d),   s = phi' - w.d',   s' = phi'' - w.d'' + (w.d')(e.d')/(1 + e.d)
// in rad/s and rad/s2, with e the chart axis, d the director, t = d - e. Paper eq. (11), doi
// 10.18698/2308-6033-2018-10-1815. The includer gives WHIRL_INLINE, dot, cross and divisor
// (core/single.hpp or core/lanes.inl).

/// 1 + e.d, to divide by.
template <class V>
WHIRL_INLINE auto spin_divisor(const V& e, const V& t) {
  return divisor(2.0 + dot(e, t));
}
/// w
template <class V, class D>
WHIRL_INLINE V spin_form(const V& e, const V& t, const D& one_plus_cosine) {
  return cross(e, t) / one_plus_cosine;
}
/// s
template <class V, class T>
WHIRL_INLINE T spin_rate(const V& w, const V& dd, const T& dphi) {
  return dphi - dot(w, dd);
}
/// s'
template <class V, class T, class D>
WHIRL_INLINE T spin_acceleration(const V& e, const V& w, const V& dd, const V& ddd, const T& ddphi,
                                 const D& one_plus_cosine) {
  return ddphi - dot(w, ddd) + dot(w, dd) * dot(e, dd) / one_plus_cosine;
}
