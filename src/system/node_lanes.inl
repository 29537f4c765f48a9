// Body of the node kernel; see node_lanes.hpp. Included by one .cpp per instruction set, which
// defines WHIRL_LANES_TABLE and WHIRL_LANES_ISA. Everything here has internal linkage.
#include <math.h>
#include <system/node_lanes.hpp>
#include <system/node_places.hpp>

namespace whirl::system::lanes {
namespace {

#include <core/lanes.inl>
#include <core/series.inl>
#include <core/director.inl>

WHIRL_INLINE void redo_large(T x, Ratios<T>& r) {
  for (int i = 0; i < width; ++i) {
    if (!(x[i] > 4.0)) continue;
    const Ratios<double> one = by_trigonometry(x[i]);
    r.b0[i] = one.b0;
    r.b1[i] = one.b1;
    r.b2[i] = one.b2;
    r.b3[i] = one.b3;
    r.cosine[i] = one.cosine;
  }
}
WHIRL_INLINE T cosine_less_one(T x, const Ratios<T>& b) {
  T r = -(x * b.b0 * b.b0) / (1.0 + b.cosine);
  if (!every(b.cosine > -0.5))
    for (int i = 0; i < width; ++i)
      if (!(b.cosine[i] > -0.5)) r[i] = b.cosine[i] - 1.0;
  return r;
}

/// One node's unknowns: six doubles.
struct Unknowns {
  V u;
  T phi, g2, g3;
};
WHIRL_INLINE Unknowns load_unknowns(const double* const* from) {
  T r[6];
  load_record(from, r);
  return {vector_at(r, 0), r[3], r[4], r[5]};
}

/// Pointers of one group, the last node repeated beyond `used`.
struct Group {
  const double *q[width], *v[width], *a[width];
  double *state[width], *D[width];
  int line[width], axes[width];
  T falling{};
  bool same_axes = true;
};
WHIRL_INLINE Group group_of(const Motion& m, std::ptrdiff_t first, int used) {
  Group g;
  for (int i = 0; i < width; ++i) {
    const std::ptrdiff_t place = first + (i < used ? i : used - 1);
    const std::ptrdiff_t k = m.nodes ? m.nodes[place] : place;
    g.q[i] = m.q + 6 * k;
    g.v[i] = m.v + 6 * k;
    g.a[i] = m.a + 6 * k;
    g.state[i] = m.state + k * NodePlaces::size;
    g.D[i] = m.D + 6 * k;
    g.line[i] = m.line[k];
    g.axes[i] = m.axes[k];
    g.falling[i] = m.falling[k];
    g.same_axes = g.same_axes && g.axes[i] == g.axes[0];
  }
  return g;
}

/// The chart triad: columns e, e2, e3.
struct Triad {
  V axis[3];
};
WHIRL_INLINE Triad triad_of(const Motion& m, const Group& g) {
  Triad r;
  if (g.same_axes) {
    const double* const c = m.chart + 9 * g.axes[0];
    for (int k = 0; k < 3; ++k)
      r.axis[k] = {all(c[3 * k]), all(c[3 * k + 1]), all(c[3 * k + 2])};
    return r;
  }
  for (int i = 0; i < width; ++i) {
    const double* const c = m.chart + 9 * g.axes[i];
    for (int k = 0; k < 3; ++k) {
      r.axis[k].x[i] = c[3 * k];
      r.axis[k].y[i] = c[3 * k + 1];
      r.axis[k].z[i] = c[3 * k + 2];
    }
  }
  return r;
}
WHIRL_INLINE V turned(const Triad& c, T x, T y, T z) {
  return x * c.axis[0] + y * c.axis[1] + z * c.axis[2];
}

WHIRL_INLINE std::ptrdiff_t evaluate_group(const Motion& m, std::ptrdiff_t first, int used) {
  const Group g = group_of(m, first, used);
  const Unknowns q = load_unknowns(g.q), v = load_unknowns(g.v), a = load_unknowns(g.a);
  const T x = q.g2 * q.g2 + q.g3 * q.g3;
  const Mask inside = x < m.limit_squared;  // false for NaN too
  if (!every(inside))
    for (int i = 0; i < used; ++i)
      if (!inside[i]) return m.nodes ? m.nodes[first + i] : first + i;
  const Ratios<T> b = ratios_of(x);
  const Place<T> o = place_of(q.g2, q.g3, x, b);
  T D_rate[3][2], rate[3], accel[3];
  jacobian_rate(q.g2, q.g3, v.g2, v.g3, b, D_rate);
  motion_of(o, D_rate, v.g2, v.g3, a.g2, a.g3, rate, accel);

  const Triad triad = triad_of(m, g);
  const V ddu = {a.u.x - g.falling * m.gravity[0], a.u.y - g.falling * m.gravity[1],
                 a.u.z - g.falling * m.gravity[2]};
  T state[NodePlaces::numbers];
  put(q.u, state, NodePlaces::u);
  put(v.u, state, NodePlaces::du);
  put(ddu, state, NodePlaces::ddu);
  put(turned(triad, o.t[0], o.t[1], o.t[2]), state, NodePlaces::t);
  put(turned(triad, rate[0], rate[1], rate[2]), state, NodePlaces::dd);
  put(turned(triad, accel[0], accel[1], accel[2]), state, NodePlaces::ddd);
  state[NodePlaces::phi] = q.phi;
  state[NodePlaces::dphi] = v.phi;
  state[NodePlaces::ddphi] = a.phi;
  for (int i = 0; i < width; ++i)
    state[NodePlaces::turns][i] = m.turns[g.line[i]];
  store_record(g.state, used, state);
  T D[6];
  put(turned(triad, o.D[0][0], o.D[1][0], o.D[2][0]), D, 0);
  put(turned(triad, o.D[0][1], o.D[1][1], o.D[2][1]), D, 3);
  store_record(g.D, used, D);
  return -1;
}

std::ptrdiff_t evaluate(const Motion& m) {
  for (std::ptrdiff_t i = 0; i < m.count; i += width) {
    const std::ptrdiff_t left = m.count - i,
                         bad = left >= width ? evaluate_group(m, i, width)
                                             : evaluate_group(m, i, static_cast<int>(left));
    if (bad >= 0) return bad;
  }
  return -1;
}

}  // namespace

const Kernels* WHIRL_LANES_TABLE() {
  static const Kernels table{WHIRL_LANES_ISA, evaluate};
  return &table;
}

}  // namespace whirl::system::lanes
