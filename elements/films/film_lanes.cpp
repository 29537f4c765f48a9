#include <core/isa.hpp>
#include <elements/films/film_lanes.hpp>
#include <elements/films/pad_film_parts.hpp>

namespace whirl::elements {

namespace film_lanes {

const Kernels& kernels() {
  static const Kernels& best = best_kernels(base_kernels(), avx2_kernels(), avx512_kernels());
  return best;
}

}  // namespace film_lanes

namespace film_parts {
namespace {

void put(double from, double (&to)[1]) { to[0] = from; }
void put(const Dual<4>& from, double (&to)[5]) {
  to[0] = from.v;
  for (int k = 0; k < 4; ++k)
    to[1 + k] = from.g[k];
}
template <class T, int N>
void put(const Pair<T>& from, double (&to)[2][N]) {
  put(from.x, to[0]);
  put(from.y, to[1]);
}
void take(const double (&from)[1], double& to) { to = from[0]; }
void take(const double (&from)[5], Dual<4>& to) {
  to.v = from[0];
  for (int k = 0; k < 4; ++k)
    to.g[k] = from[1 + k];
}

template <int N, class T, class Kernel>
Condensed<T> condense_in_lanes(const Place<T>& at, const T& from, const T& to, double beta, int n,
                               Kernel kernel) {
  using std::cos;
  using std::sin;
  const T width = (1.0 / n) * (to - from);
  const std::array<Pair<T>, points> zeta = first_points(from, width);
  film_lanes::Stretch<N> s;
  put(at.e, s.e);
  put(at.b, s.b);
  put(at.spread, s.spread);
  put(at.over_spread, s.over_spread);
  put(width, s.width);
  put(1.0 / width, s.over_width);
  put(Pair<T>{cos(width), sin(width)}, s.turn);
  for (std::size_t q = 0; q < points; ++q)
    put(zeta[q], s.first[q]);
  s.beta = beta;
  s.count = n;
  film_lanes::Ends<N> ends;
  kernel(reference(), s, ends);
  Condensed<T> c;
  take(ends.S00, c.S00);
  take(ends.S01, c.S01);
  take(ends.S11, c.S11);
  take(ends.out_a[0], c.out_a.x);
  take(ends.out_a[1], c.out_a.y);
  take(ends.out_b[0], c.out_b.x);
  take(ends.out_b[1], c.out_b.y);
  take(ends.D_aa, c.D_aa);
  take(ends.D_ab, c.D_ab);
  take(ends.D_bb, c.D_bb);
  return c;
}

}  // namespace

template <>
Condensed<double> condense(const Place<double>& at, const Alike&, const double& from,
                           const double& to, double beta, int n) {
  return condense_in_lanes<0>(at, from, to, beta, n, film_lanes::kernels().condense);
}
template <>
Condensed<Dual<4>> condense(const Place<Dual<4>>& at, const Alike&, const Dual<4>& from,
                            const Dual<4>& to, double beta, int n) {
  return condense_in_lanes<4>(at, from, to, beta, n, film_lanes::kernels().condense_with_slopes);
}

}  // namespace film_parts
}  // namespace whirl::elements
