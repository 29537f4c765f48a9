// Body of the shaft element's force kernel; see shaft_lanes.hpp. Included by one .cpp per
// instruction set, which defines WHIRL_LANES_TABLE (name of the function that returns the table)
// and WHIRL_LANES_ISA (its label). Everything here has internal linkage.
#include <elements/shaft/shaft_lanes.hpp>
#include <math.h>

namespace whirl::elements::lanes {
namespace {

#include <core/lanes.inl>

struct Node {
  V u, du, ddu, t, dd, ddd;
  T phi, dphi, ddphi;
};
WHIRL_INLINE Node load_node(const double* const* at) {
  const double* p[width];
  for (int i = 0; i < width; ++i)
    p[i] = at[i];
  Node n;
  load4(p, n.u.x, n.u.y, n.u.z, n.du.x);
  advance(p, 4);
  load4(p, n.du.y, n.du.z, n.ddu.x, n.ddu.y);
  advance(p, 4);
  load4(p, n.ddu.z, n.t.x, n.t.y, n.t.z);
  advance(p, 4);
  load4(p, n.dd.x, n.dd.y, n.dd.z, n.ddd.x);
  advance(p, 4);
  load4(p, n.ddd.y, n.ddd.z, n.phi, n.dphi);
  advance(p, 4);
  n.ddphi = load(p);
  return n;
}

/// G(n) = theta/sin theta, n = 1 - cos theta, G1 = dG/dn, F = theta^2: as AngleRatio
/// (shaft_strain.hpp), whose series coefficients g_k = k/(2k+1) g_(k-1) are spelled out.
struct Ratio {
  T F, G, G1;
};
WHIRL_INLINE Ratio ratio(T n) {
  constexpr double g1 = 1.0 / 3, g2 = g1 * 2 / 5, g3 = g2 * 3 / 7, g4 = g3 * 4 / 9,
                   g5 = g4 * 5 / 11, g6 = g5 * 6 / 13, g7 = g6 * 7 / 15, g8 = g7 * 8 / 17,
                   g9 = g8 * 9 / 19, g10 = g9 * 10 / 21;
  Ratio r;
  if (every(n < 0.02)) {
    if (every(n < 2e-4)) {  // fifth terms: 0.02 (2e-4)^5 < 1e-20
      r.G = 1.0 + n * (g1 + n * (g2 + n * (g3 + n * g4)));
      r.G1 = g1 + n * (2 * g2 + n * (3 * g3 + n * (4 * g4 + n * (5 * g5))));
      r.F = 2.0 * n * (1.0 + n * (g1 / 2 + n * (g2 / 3 + n * (g3 / 4 + n * (g4 / 5)))));
      return r;
    }
    r.G =
        1.0 +
        n * (g1 +
             n * (g2 +
                  n * (g3 +
                       n * (g4 + n * (g5 + n * (g6 + n * (g7 + n * (g8 + n * (g9 + n * g10)))))))));
    r.G1 =
        g1 +
        n * (2 * g2 +
             n * (3 * g3 +
                  n * (4 * g4 +
                       n * (5 * g5 +
                            n * (6 * g6 +
                                 n * (7 * g7 + n * (8 * g8 + n * (9 * g9 + n * (10 * g10)))))))));
    r.F = 2.0 * n *
          (1.0 +
           n * (g1 / 2 +
                n * (g2 / 3 +
                     n * (g3 / 4 +
                          n * (g4 / 5 +
                               n * (g5 / 6 +
                                    n * (g6 / 7 +
                                         n * (g7 / 8 +
                                              n * (g8 / 9 + n * (g9 / 10 + n * (g10 / 11)))))))))));
    return r;
  }
  for (int i = 0; i < width; ++i) {
    const double x = n[i];
    if (x < 0.02) {
      r.G[i] =
          1.0 +
          x * (g1 +
               x * (g2 +
                    x * (g3 +
                         x * (g4 +
                              x * (g5 + x * (g6 + x * (g7 + x * (g8 + x * (g9 + x * g10)))))))));
      r.G1[i] =
          g1 +
          x * (2 * g2 +
               x * (3 * g3 +
                    x * (4 * g4 +
                         x * (5 * g5 +
                              x * (6 * g6 +
                                   x * (7 * g7 + x * (8 * g8 + x * (9 * g9 + x * (10 * g10)))))))));
      r.F[i] =
          2.0 * x *
          (1.0 +
           x * (g1 / 2 +
                x * (g2 / 3 +
                     x * (g3 / 4 +
                          x * (g4 / 5 +
                               x * (g5 / 6 +
                                    x * (g6 / 7 +
                                         x * (g7 / 8 +
                                              x * (g8 / 9 + x * (g9 / 10 + x * (g10 / 11)))))))))));
      continue;
    }
    const double theta = 2.0 * ::asin(__builtin_sqrt(0.5 * x)), q = x * (2.0 - x);
    r.F[i] = theta * theta;
    r.G[i] = theta / __builtin_sqrt(q);
    r.G1[i] = (1.0 - (1.0 - x) * r.G[i]) / q;
  }
  return r;
}

/// atan2(y, x), x > 0 in all but extreme shapes.
WHIRL_INLINE T angle(T y, T x) {
  const T q = y / x, s = q * q;
  if (every((s < 1e-3) & (x > 0.0)))  // eighth term: (1e-3)^8/17 < 1e-25
    return q * (1.0 -
                s * (1.0 / 3 -
                     s * (1.0 / 5 -
                          s * (1.0 / 7 -
                               s * (1.0 / 9 - s * (1.0 / 11 - s * (1.0 / 13 - s * (1.0 / 15))))))));
  T r{};
  for (int i = 0; i < width; ++i)
    r[i] = ::atan2(y[i], x[i]);
  return r;
}

/// Omega(e, v, w) = 2 atan2(N, D) with its gradients in v and w: as SolidAngle (shaft_strain.hpp).
struct Solid {
  T value;
  V grad_v, grad_w;
};
WHIRL_INLINE Solid solid_angle(V e, V v, V w) {
  const V Nv = cross(w, e), Nw = cross(e, v);
  const T N = dot(v, Nv), D = 1.0 + dot(e, v) + dot(v, w) + dot(w, e), f = 2.0 / (N * N + D * D),
          p = D * f, r = -(N * f);
  return {2.0 * angle(N, D), p * Nv + r * (e + w), p * Nw + r * (e + v)};
}

/// Spin rate s = phi' - w . d', its rate, and w = (e x d)/(1 + e.d): as SpinRate (system/spin.hpp).
struct Spin {
  T s, sdot;
  V w;
};
WHIRL_INLINE Spin spin_rate(const Node& n, V e) {
  const T i = 1.0 / (2.0 + dot(e, n.t));
  Spin r;
  r.w = i * cross(e, n.t);
  const T wd = dot(r.w, n.dd);
  r.s = n.dphi - wd;
  r.sdot = n.ddphi - dot(r.w, n.ddd) + wd * dot(e, n.dd) * i;
  return r;
}

/// Pointers of one group, the last element repeated beyond `used`, and its chart axes.
struct Group {
  const double *element[width], *s1[width], *s2[width];
  double *f1[width], *f2[width];
  V e;
};
WHIRL_INLINE Group group_of(const Elements& b, std::size_t first, int used) {
  Group g;
  for (int i = 0; i < width; ++i) {
    const std::size_t k = first + static_cast<std::size_t>(i < used ? i : used - 1);
    const std::ptrdiff_t n1 = b.nodes[2 * k], n2 = b.nodes[2 * k + 1];
    g.element[i] = b.element + static_cast<std::ptrdiff_t>(k) * b.stride;
    g.s1[i] = b.state + n1 * b.state_stride;
    g.s2[i] = b.state + n2 * b.state_stride;
    g.f1[i] = b.force + 7 * n1;
    g.f2[i] = b.force + 7 * n2;
    const double* const chart = *(const double* const*)(const void*)(g.s1[i] + b.chart);
    g.e.x[i] = chart[0];
    g.e.y[i] = chart[1];
    g.e.z[i] = chart[2];
  }
  return g;
}

WHIRL_INLINE void add_to_nodes(const Group& g, int used, V u1, V d1, T phi1, V u2, V d2, T phi2) {
  const T zero{};
  add4(g.f1, 0, used, u1.x, u1.y, u1.z, d1.x);
  add4(g.f1, 3, used, zero, d1.y, d1.z, phi1);
  add4(g.f2, 0, used, u2.x, u2.y, u2.z, d2.x);
  add4(g.f2, 3, used, zero, d2.y, d2.z, phi2);
}

template <bool Offsets>
WHIRL_INLINE void add_group(const ShaftElements& b, std::size_t first, int used) {
  const Group g = group_of(b, first, used);
  const V e = g.e;
  const double* p[width];
  auto from = [&](std::ptrdiff_t offset) {
    for (int i = 0; i < width; ++i)
      p[i] = g.element[i] + offset;
  };
  T length, o1, o2, EA_l, b11, b12, b22, k11, k12, k22, GJ_l, tau_c;
  from(b.scalars);
  load4(p, length, o1, o2, EA_l);
  advance(p, 4);
  load4(p, b11, b12, b22, k11);
  advance(p, 4);
  load4(p, k12, k22, GJ_l, tau_c);
  V e0;
  from(b.e0);
  e0.x = load(p);
  advance(p, 1);
  e0.y = load(p);
  advance(p, 1);
  e0.z = load(p);
  from(b.psi0);
  const T psi0 = load(p);
  from(b.preload);
  const T preload = load(p);
  from(b.soft);
  T soft_torque, soft_axial, soft_shear, soft_limit;
  load4(p, soft_torque, soft_axial, soft_shear, soft_limit);
  const Node x1 = load_node(g.s1), x2 = load_node(g.s2);

  // strain
  V du = x2.u - x1.u;
  if constexpr (Offsets) du = du + (o2 * x2.t - o1 * x1.t);
  const V chord = length * e0 + du;
  const T l = root(dot(chord, chord)), il = 1.0 / l;
  const T stretch = (2.0 * length * dot(e0, du) + dot(du, du)) / (l + length);
  const V alpha = il * (du - stretch * e0), a = e0 + alpha, shift = e - e0 - alpha, d1 = e + x1.t,
          d2 = e + x2.t;
  const V delta1 = x1.t + shift, delta2 = x2.t + shift;
  const T n1 = 0.5 * dot(delta1, delta1), n2 = 0.5 * dot(delta2, delta2), m = dot(delta1, delta2);
  const V cross12 = cross(delta1, delta2);
  const T tau = dot(a, cross12);
  const Ratio r1 = ratio(n1), r2 = ratio(n2);
  const T GG = r1.G * r2.G, P = m - n1 * n2, S = GG * P;

  // twist
  const Solid w1 = solid_angle(e, d1, a), w2 = solid_angle(e, a, d2);
  const T psi = x2.phi - x1.phi + (tau_c * GG * tau - (w1.value + w2.value)) - psi0;

  // bending with the axial force and the torque it carries
  const T N0 =
      preload + EA_l * (stretch + length * (0.5 * (b11 * r1.F + 2.0 * b12 * S + b22 * r2.F)));
  const T B = r1.F + r2.F - 2.0 * S, n = N0 > soft_limit ? N0 : soft_limit, beyond = N0 - n,
          rho = 1.0 / (1.0 + soft_shear * n);
  const T slope = 0.5 * n * rho * (1.0 + rho), give1 = slope + rho * rho * rho * beyond,
          Q = soft_torque * psi * psi + soft_axial * (n * n * rho + (slope + give1) * beyond);
  const T N = N0 - EA_l * soft_axial * B * give1, torque = (GJ_l - soft_torque * B) * psi;
  const T NL = N * length, c11 = k11 + NL * b11 - Q, c12 = k12 + NL * b12 + Q,
          c22 = k22 + NL * b22 - Q;
  const T g1 = c11 * r1.G + c12 * (r1.G1 * r2.G * P - GG * n2),
          g2 = c22 * r2.G + c12 * (r1.G * r2.G1 * P - GG * n1), gm = c12 * GG;
  V gd1 = g1 * delta1 + gm * delta2, gd2 = g2 * delta2 + gm * delta1, ga = V{} - gd1 - gd2;

  const T tG = tau_c * GG, t1 = tau_c * r1.G1 * r2.G * tau, t2 = tau_c * r1.G * r2.G1 * tau;
  add(ga, torque * (tG * (cross(a, delta2 - delta1) + cross12) - t1 * delta1 - t2 * delta2 -
                    w1.grad_w - w2.grad_v));
  add(gd1, torque * (tG * cross(delta2, a) + t1 * delta1 - w1.grad_v));
  add(gd2, torque * (tG * cross(a, delta1) + t2 * delta2 - w2.grad_w));
  const V gl = N * a + il * (ga - dot(a, ga) * a);
  if constexpr (Offsets) {
    add(gd1, V{} - o1 * gl);
    add(gd2, o2 * gl);
  }

  // inertia
  const Spin sp1 = spin_rate(x1, e), sp2 = spin_rate(x2, e);
  const V sa = (0.5 * (sp1.s + sp2.s)) * a;
  V f[4];
  const V* const acc[4] = {&x1.ddu, &x1.ddd, &x2.ddu, &x2.ddd};
  const V* const vel[4] = {&x1.du, &x1.dd, &x2.du, &x2.dd};
  V v[4] = {};
  f[0] = V{} - gl, f[1] = gd1, f[2] = gl, f[3] = gd2;
  for (int j = 0; j < 4; ++j) {
    T c0, c1, c2, c3;
    from(b.M4 + 4 * j);
    load4(p, c0, c1, c2, c3);
    add(f[0], c0 * *acc[j]);
    add(f[1], c1 * *acc[j]);
    add(f[2], c2 * *acc[j]);
    add(f[3], c3 * *acc[j]);
    from(b.G4c + 4 * j);
    load4(p, c0, c1, c2, c3);
    add(v[0], c0 * *vel[j]);
    add(v[1], c1 * *vel[j]);
    add(v[2], c2 * *vel[j]);
    add(v[3], c3 * *vel[j]);
  }
  for (int k = 0; k < 4; ++k)
    f[k] = f[k] - cross(sa, v[k]);
  T p11, p21, p12, p22;
  from(b.polar);
  load4(p, p11, p21, p12, p22);
  const T h1 = p11 * sp1.s + p12 * sp2.s, h2 = p21 * sp1.s + p22 * sp2.s;
  const T q1 = p11 * sp1.sdot + p12 * sp2.sdot, q2 = p21 * sp1.sdot + p22 * sp2.sdot;
  f[1] = f[1] - (q1 * sp1.w + h1 * cross(d1, x1.dd));
  f[3] = f[3] - (q2 * sp2.w + h2 * cross(d2, x2.dd));
  add_to_nodes(g, used, f[0], f[1], q1 - torque, f[2], f[3], q2 + torque);
}

struct Lanes {
  using T = lanes::T;
  using V = lanes::V;
};
WHIRL_INLINE void angle_ratio(T n, T& G, T& G1) {
  const Ratio r = ratio(n);
  G = r.G;
  G1 = r.G1;
}
#include <elements/shaft/shaft_damping.inl>

template <bool Rotating>
WHIRL_INLINE void add_group(const DampingElements& b, std::size_t first, int used) {
  const Group g = group_of(b, first, used);
  const double* p[width];
  for (int i = 0; i < width; ++i)
    p[i] = g.element[i];
  DampingParameters<Lanes> c;
  T o1, o2;
  load4(p, c.length, o1, o2, c.e0.x);
  advance(p, 4);
  load4(p, c.e0.y, c.e0.z, c.d11, c.d12);
  advance(p, 3);
  load4(p, c.d12, c.d22, c.d_twist,
        c.d_axial);  // one over the last, so as not to read beyond the element
  const Node x1 = load_node(g.s1), x2 = load_node(g.s2);
  const V du = x2.u - x1.u + o2 * x2.t - o1 * x1.t;
  const DampingRates<Lanes> v{x2.du - x1.du + o2 * x2.dd - o1 * x1.dd, x1.dd, x2.dd, x1.dphi,
                              x2.dphi};
  const auto f = damping_force<Rotating, Lanes>(c, g.e, du, x1.t, x2.t, v);
  add_to_nodes(g, used, V{} - f.lambda, f.d1 - o1 * f.lambda, f.phi1, f.lambda,
               f.d2 + o2 * f.lambda, f.phi2);
}

/// Flag: offsets of shaft elements, rotation of damping.
template <bool Flag, class B>
void add_all(const B& b) {
  std::size_t i = 0;
  for (; i + width <= b.count; i += width)
    add_group<Flag>(b, i, width);
  if (i < b.count) add_group<Flag>(b, i, static_cast<int>(b.count - i));
}

}  // namespace

const Kernels* WHIRL_LANES_TABLE() {
  static const Kernels table{WHIRL_LANES_ISA, add_all<false, ShaftElements>,
                             add_all<true, ShaftElements>, add_all<true, DampingElements>,
                             add_all<false, DampingElements>};
  return &table;
}

}  // namespace whirl::elements::lanes
