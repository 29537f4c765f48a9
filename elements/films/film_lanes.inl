// Body of the films' kernels; see film_lanes.hpp. Included by one .cpp per instruction set, which
// defines WHIRL_LANES_TABLE (name of the function that returns the table) and WHIRL_LANES_ISA (its
// label). Everything here has internal linkage.
#include <elements/films/film_lanes.hpp>
#include <math.h>
#include <string.h>

namespace whirl::elements::film_lanes {
namespace {

#include <core/lanes.inl>
#include <elements/films/film_condense.inl>

/// A number and its slopes in four variables.
template <class S>
struct Sloped {
  S v, g[4];
};
template <class S>
WHIRL_INLINE Sloped<S> operator+(const Sloped<S>& a, const Sloped<S>& b) {
  return {a.v + b.v, {a.g[0] + b.g[0], a.g[1] + b.g[1], a.g[2] + b.g[2], a.g[3] + b.g[3]}};
}
template <class S>
WHIRL_INLINE Sloped<S> operator-(const Sloped<S>& a, const Sloped<S>& b) {
  return {a.v - b.v, {a.g[0] - b.g[0], a.g[1] - b.g[1], a.g[2] - b.g[2], a.g[3] - b.g[3]}};
}
template <class S>
WHIRL_INLINE Sloped<S> operator-(const Sloped<S>& a) {
  return {-a.v, {-a.g[0], -a.g[1], -a.g[2], -a.g[3]}};
}
template <class S>
WHIRL_INLINE Sloped<S> operator+(double a, const Sloped<S>& b) {
  return {a + b.v, {b.g[0], b.g[1], b.g[2], b.g[3]}};
}
template <class S>
WHIRL_INLINE Sloped<S> operator-(double a, const Sloped<S>& b) {
  return {a - b.v, {-b.g[0], -b.g[1], -b.g[2], -b.g[3]}};
}
template <class S>
WHIRL_INLINE Sloped<S> operator*(double a, const Sloped<S>& b) {
  return {a * b.v, {a * b.g[0], a * b.g[1], a * b.g[2], a * b.g[3]}};
}
template <class S>
WHIRL_INLINE Sloped<S> operator*(const Sloped<S>& a, const Sloped<S>& b) {
  return {a.v * b.v,
          {a.v * b.g[0] + b.v * a.g[0], a.v * b.g[1] + b.v * a.g[1], a.v * b.g[2] + b.v * a.g[2],
           a.v * b.g[3] + b.v * a.g[3]}};
}
template <class S>
WHIRL_INLINE Sloped<S> operator/(double a, const Sloped<S>& b) {
  const S q = a / b.v, by = -q / b.v;
  return {q, {by * b.g[0], by * b.g[1], by * b.g[2], by * b.g[3]}};
}
template <class S>
WHIRL_INLINE void operator+=(Sloped<S>& a, const Sloped<S>& b) {
  a = a + b;
}
template <class S>
WHIRL_INLINE void operator-=(Sloped<S>& a, const Sloped<S>& b) {
  a = a - b;
}

/// The numbers of a film without slopes (N = 0) and with four: several at a time, and one.
template <int N>
struct NumberOf;
template <>
struct NumberOf<0> {
  using Many = T;
  using One = double;
};
template <>
struct NumberOf<4> {
  using Many = Sloped<T>;
  using One = Sloped<double>;
};

WHIRL_INLINE void spread_out(const double (&from)[1], T& to) { to = all(from[0]); }
WHIRL_INLINE void spread_out(const double (&from)[5], Sloped<T>& to) {
  to = {all(from[0]), {all(from[1]), all(from[2]), all(from[3]), all(from[4])}};
}
template <int N, class Many>
WHIRL_INLINE Pair<Many> pair_of(const double (&from)[2][1 + N]) {
  Pair<Many> to;
  spread_out(from[0], to.x);
  spread_out(from[1], to.y);
  return to;
}
WHIRL_INLINE void set_lane(T& to, int lane, const T& from) { to[lane] = from[lane]; }
WHIRL_INLINE void set_lane(Sloped<T>& to, int lane, const Sloped<T>& from) {
  to.v[lane] = from.v[lane];
  for (int k = 0; k < 4; ++k)
    to.g[k][lane] = from.g[k][lane];
}
WHIRL_INLINE double one_of(const T& from, int lane) { return from[lane]; }
WHIRL_INLINE Sloped<double> one_of(const Sloped<T>& from, int lane) {
  return {from.v[lane], {from.g[0][lane], from.g[1][lane], from.g[2][lane], from.g[3][lane]}};
}
WHIRL_INLINE void put(double from, double (&to)[1]) { to[0] = from; }
WHIRL_INLINE void put(const Sloped<double>& from, double (&to)[5]) {
  to[0] = from.v;
  for (int k = 0; k < 4; ++k)
    to[1 + k] = from.g[k];
}
template <class S>
WHIRL_INLINE Pair<S> turned(const Pair<S>& a, const Pair<S>& by) {
  return {a.x * by.x - a.y * by.y, a.x * by.y + a.y * by.x};
}

template <class Many>
struct PlaceOfMany {
  Pair<Many> e, b;
  Many spread, over_spread;
};

template <int N>
void condense(const Tables& tables, const Stretch<N>& s, Ends<N>& out) {
  using Many = typename NumberOf<N>::Many;
  using One = typename NumberOf<N>::One;
  PlaceOfMany<Many> at;
  at.e = pair_of<N, Many>(s.e);
  at.b = pair_of<N, Many>(s.b);
  spread_out(s.spread, at.spread);
  spread_out(s.over_spread, at.over_spread);
  Many element_width, over_width;
  spread_out(s.width, element_width);
  spread_out(s.over_width, over_width);
  // every lane at the points of its own element of the first few, then on by as many elements
  const Pair<Many> by_one = pair_of<N, Many>(s.turn);
  Pair<Many> zeta[points], by_all = by_one;
  for (int lane = 1; lane < width; ++lane)
    by_all = turned(by_all, by_one);
  for (int q = 0; q < points; ++q) {
    Pair<Many> there = pair_of<N, Many>(s.first[q]);
    zeta[q] = there;
    for (int lane = 1; lane < width; ++lane) {
      there = turned(there, by_one);
      set_lane(zeta[q].x, lane, there.x);
      set_lane(zeta[q].y, lane, there.y);
    }
  }
  Condensed<One> c = {};
  for (int first = 0; first < s.count; first += width) {
    FilmElement<Many> e =
        integrate_element(tables, at, Alike{}, element_width, over_width, by_all, s.beta, zeta);
    Condensed<Many> inner = {};
    drop_bubbles(e, inner);
    const int used = s.count - first < width ? s.count - first : width;
    for (int lane = 0; lane < used; ++lane) {
      FilmElement<One> one;
      for (int k = entries - 3; k < entries; ++k)
        one.A[k] = one_of(e.A[k], lane);
      for (int k = bubbles; k < shapes; ++k)
        one.B[k] = {one_of(e.B[k].x, lane), one_of(e.B[k].y, lane)};
      c.S00 += one_of(inner.S00, lane);
      c.S01 += one_of(inner.S01, lane);
      c.S11 += one_of(inner.S11, lane);
      append_element(one, first + lane == 0, c);
    }
  }
  put(c.S00, out.S00);
  put(c.S01, out.S01);
  put(c.S11, out.S11);
  put(c.out_a.x, out.out_a[0]);
  put(c.out_a.y, out.out_a[1]);
  put(c.out_b.x, out.out_b[0]);
  put(c.out_b.y, out.out_b[1]);
  put(c.D_aa, out.D_aa);
  put(c.D_ab, out.D_ab);
  put(c.D_bb, out.D_bb);
}

constexpr Kernels table = {WHIRL_LANES_ISA, condense<0>, condense<4>};

}  // namespace

const Kernels* WHIRL_LANES_TABLE() { return &table; }

}  // namespace whirl::elements::film_lanes
