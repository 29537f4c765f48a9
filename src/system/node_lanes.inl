// Body of the node kernel; see node_lanes.hpp. Included by one .cpp per instruction set, which
// defines WHIRL_LANES_TABLE and WHIRL_LANES_ISA. Everything here has internal linkage.
#include <math.h>
#include <system/node_lanes.hpp>

namespace whirl::system::lanes {
namespace {

#include <core/lanes.inl>

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
struct Six {
  V u;
  T phi, g2, g3;
};
WHIRL_INLINE Six load6(const double* const* from) {
  const double* p[width];
  for (int i = 0; i < width; ++i)
    p[i] = from[i];
  Six s;
  T skip;
  load4(p, s.u.x, s.u.y, s.u.z, s.phi);
  advance(p, 2);
  load4(p, skip, skip, s.g2, s.g3);
  return s;
}

WHIRL_INLINE std::ptrdiff_t evaluate_group(const Motion& m, std::ptrdiff_t first, int used) {
  const double *pq[width], *pv[width], *pa[width];
  double *state[width], *D[width];
  int line[width];
  T falling{};
  bool same = true;
  for (int i = 0; i < width; ++i) {
    const std::ptrdiff_t k = first + (i < used ? i : used - 1);
    pq[i] = m.q + 6 * k;
    pv[i] = m.v + 6 * k;
    pa[i] = m.a + 6 * k;
    state[i] = m.state + k * m.stride;
    D[i] = m.D + 6 * k;
    line[i] = m.line[k];
    falling[i] = m.falling[k];
    same = same && line[i] == line[0];
  }
  const Six q = load6(pq), v = load6(pv), a = load6(pa);
  const T x = q.g2 * q.g2 + q.g3 * q.g3;
  const Mask inside = x < m.limit_squared;  // false for NaN too
  if (!every(inside))
    for (int i = 0; i < used; ++i)
      if (!inside[i]) return first + i;
  const Ratios<T> b = ratios_of(x);
  const Place<T> o = place_of(q.g2, q.g3, x, b);
  T D_rate[3][2], rate[3], accel[3];
  jacobian_rate(q.g2, q.g3, v.g2, v.g3, b, D_rate);
  motion_of(o, D_rate, v.g2, v.g3, a.g2, a.g3, rate, accel);

  V axis[3];  // columns e, e2, e3
  if (same) {
    const double* const c = m.chart + 9 * line[0];
    for (int k = 0; k < 3; ++k)
      axis[k] = {all(c[3 * k]), all(c[3 * k + 1]), all(c[3 * k + 2])};
  } else {
    for (int i = 0; i < width; ++i) {
      const double* const c = m.chart + 9 * line[i];
      for (int k = 0; k < 3; ++k) {
        axis[k].x[i] = c[3 * k];
        axis[k].y[i] = c[3 * k + 1];
        axis[k].z[i] = c[3 * k + 2];
      }
    }
  }
  auto turned = [&](T cx, T cy, T cz) { return cx * axis[0] + cy * axis[1] + cz * axis[2]; };
  const V t = turned(o.t[0], o.t[1], o.t[2]), dd = turned(rate[0], rate[1], rate[2]),
          ddd = turned(accel[0], accel[1], accel[2]);
  const V D2 = turned(o.D[0][0], o.D[1][0], o.D[2][0]),
          D3 = turned(o.D[0][1], o.D[1][1], o.D[2][1]);
  const V ddu = {a.u.x - falling * m.gravity[0], a.u.y - falling * m.gravity[1],
                 a.u.z - falling * m.gravity[2]};

  store4(state, 0, used, q.u.x, q.u.y, q.u.z, v.u.x);
  store4(state, 4, used, v.u.y, v.u.z, ddu.x, ddu.y);
  store4(state, 8, used, ddu.z, t.x, t.y, t.z);
  store4(state, 12, used, dd.x, dd.y, dd.z, ddd.x);
  store4(state, 16, used, ddd.y, ddd.z, q.phi, v.phi);
  store4(D, 0, used, D2.x, D2.y, D2.z, D3.x);
  for (int i = 0; i < width; ++i) {
    if (i >= used) break;
    state[i][20] = a.phi[i];
    state[i][21] = m.turns[line[i]];
    *(const double**)(void*)(state[i] + 22) = m.chart + 9 * line[i];
    D[i][4] = D3.y[i];
    D[i][5] = D3.z[i];
  }
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
