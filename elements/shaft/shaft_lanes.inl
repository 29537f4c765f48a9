// Body of the shaft element's force kernels; see shaft_lanes.hpp. Included by one .cpp per
// instruction set, which defines WHIRL_LANES_TABLE (name of the function that returns the table)
// and WHIRL_LANES_ISA (its label). Everything here has internal linkage.
#include <elements/shaft/shaft_lanes.hpp>
#include <system/node_places.hpp>
#include <math.h>
#include <string.h>

namespace whirl::elements::lanes {
namespace {

#include <core/lanes.inl>
#include <core/series.inl>
#include <system/spin.inl>

WHIRL_INLINE T arctangent_beyond(T y, T x) {
  T r{};
  for (int i = 0; i < width; ++i)
    r[i] = ::atan2(y[i], x[i]);
  return r;
}

#include <elements/shaft/angle_ratio.inl>

WHIRL_INLINE void angle_ratio_beyond(T n, AngleRatio<T>& r) {
  for (int i = 0; i < width; ++i) {
    AngleRatio<double> one;
    angle_ratio_beyond(n[i], one);
    r.F[i] = one.F;
    r.G[i] = one.G;
    r.G1[i] = one.G1;
  }
}

#include <elements/shaft/shaft_strain.inl>
#include <elements/shaft/shaft_damping.inl>

using system::NodePlaces;

struct Node {
  V u, du, ddu, t, dd, ddd;
  T phi, dphi, ddphi;
};
WHIRL_INLINE Node load_node(const double* const* at) {
  T r[NodePlaces::ddphi + 1];
  load_record(at, r);
  Node n;
  n.u = vector_at(r, NodePlaces::u);
  n.du = vector_at(r, NodePlaces::du);
  n.ddu = vector_at(r, NodePlaces::ddu);
  n.t = vector_at(r, NodePlaces::t);
  n.dd = vector_at(r, NodePlaces::dd);
  n.ddd = vector_at(r, NodePlaces::ddd);
  n.phi = r[NodePlaces::phi];
  n.dphi = r[NodePlaces::dphi];
  n.ddphi = r[NodePlaces::ddphi];
  return n;
}

/// Pointers of one group, the last element repeated beyond `used`, and its chart axes.
struct Group {
  const double *element[width], *s1[width], *s2[width];
  double *f1[width], *f2[width];
  V e;
};
template <class Places>
WHIRL_INLINE Group group_of(const Elements& b, std::size_t first, int used) {
  Group g;
  for (int i = 0; i < width; ++i) {
    const std::size_t k = first + static_cast<std::size_t>(i < used ? i : used - 1);
    const std::ptrdiff_t n1 = b.nodes[2 * k], n2 = b.nodes[2 * k + 1];
    g.element[i] = b.element + static_cast<std::ptrdiff_t>(k) * Places::size;
    g.s1[i] = b.state + n1 * NodePlaces::size;
    g.s2[i] = b.state + n2 * NodePlaces::size;
    g.f1[i] = b.force ? b.force + 7 * n1 : nullptr;
    g.f2[i] = b.force ? b.force + 7 * n2 : nullptr;
    const double* chart;
    memcpy(&chart, g.s1[i] + NodePlaces::chart, sizeof chart);
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

/// What the elastic force of a ShaftBeam depends on.
struct Shaft {
  ShaftStiffness<Lanes> c;
  V e0;
  T o1, o2, psi0;
};
WHIRL_INLINE Shaft load_shaft(const double* const* at) {
  using P = ShaftPlaces;
  T r[P::scalars];
  load_record(at, r);
  const double* after[width];
  for (int i = 0; i < width; ++i)
    after[i] = at[i] + P::rest;
  T q[P::after_rest - P::rest];
  load_record(after, q);
  Shaft s;
  s.c = {r[P::length],
         r[P::EA_l],
         r[P::b11],
         r[P::b12],
         r[P::b22],
         r[P::k11],
         r[P::k12],
         r[P::k22],
         r[P::GJ_l],
         r[P::tau_c],
         q[P::preload - P::rest],
         q[P::soft_torque - P::rest],
         q[P::soft_axial - P::rest],
         q[P::soft_shear - P::rest],
         q[P::soft_limit - P::rest]};
  s.o1 = r[P::o1];
  s.o2 = r[P::o2];
  s.e0 = vector_at(q, P::e0 - P::rest);
  s.psi0 = q[P::psi0 - P::rest];
  return s;
}

/// Strain, twist and stresses at the places of the nodes.
struct Deformed {
  Strain<Lanes> strain;
  Twist<Lanes> twist;
  T psi;
  Stresses<Lanes> stress;
};
template <bool Offsets>
WHIRL_INLINE Deformed deformed(const Shaft& k, V e, const Node& x1, const Node& x2) {
  V du = x2.u - x1.u;
  if constexpr (Offsets) du = du + (k.o2 * x2.t - k.o1 * x1.t);
  Deformed now;
  now.strain = strain_of<Lanes>(k.c.length, k.e0, e, du, x1.t, x2.t);
  now.twist = twist_of(e, k.c.tau_c, now.strain);
  now.psi = x2.phi - x1.phi + now.twist.geometric - k.psi0;
  now.stress = stresses_of(k.c, now.strain, now.psi);
  return now;
}

/// On (lambda, d1, d2), and the torque.
struct ElasticForce {
  V lambda, d1, d2;
  T torque;
  Chord<Lanes> chord;
  V delta1, delta2;
};
template <bool Offsets>
WHIRL_INLINE ElasticForce elastic_force(const Shaft& k, V e, const Node& x1, const Node& x2) {
  const Deformed now = deformed<Offsets>(k, e, x1, x2);
  const Strain<Lanes>& s = now.strain;
  const Stresses<Lanes>& stress = now.stress;
  const BendingStiffness<T> c = bending_stiffness_of(k.c, stress);
  const Gradient<Lanes> bending = bending_gradient(bending_slopes(c.c11, c.c12, c.c22, s), s);
  const Gradient<Lanes> g =
      elastic_gradient(bending, stress.torque, twist_gradient(now.twist, k.c.tau_c, s));
  ElasticForce f{chord_gradient(s.chord, stress.N, g.a),
                 g.d1,
                 g.d2,
                 stress.torque,
                 s.chord,
                 s.end1.delta,
                 s.end2.delta};
  if constexpr (Offsets) {
    add(f.d1, -(k.o1 * f.lambda));
    add(f.d2, k.o2 * f.lambda);
  }
  return f;
}

/// Spin and its rate, spin form.
struct NodeSpin {
  T s, sdot;
  V w;
};
WHIRL_INLINE NodeSpin spin_of(V e, const Node& n) {
  const Divisor one_plus_cosine = spin_divisor(e, n.t);
  const V w = spin_form(e, n.t, one_plus_cosine);
  return {spin_rate(w, n.dd, n.dphi),
          spin_acceleration(e, w, n.dd, n.ddd, n.ddphi, one_plus_cosine), w};
}

/// Four numbers of every element, a column of a matrix.
WHIRL_INLINE void load_column(const double* const* element, int place, T (&column)[4]) {
  const double* p[width];
  for (int i = 0; i < width; ++i)
    p[i] = element[i] + place;
  load_record(p, column);
}

/// f += M4 X'' on X = (x1, d1, x2, d2).
WHIRL_INLINE void add_inertia(const Group& g, const Node& x1, const Node& x2, V (&f)[4]) {
  const V* const acc[4] = {&x1.ddu, &x1.ddd, &x2.ddu, &x2.ddd};
  for (int j = 0; j < 4; ++j) {
    T column[4];
    load_column(g.element, ShaftPlaces::M4 + 4 * j, column);
    for (int k = 0; k < 4; ++k)
      add(f[k], column[k] * *acc[j]);
  }
}

/// Of the spin of a bent inside: Gamma and its rate, on the spins.
struct BentSpin {
  T value, rate;
};
/// f += the force of s Gamma at given s, the mean spin. Gamma = b.w, w = sum_k sigma_k x d_k' + b' x
/// kappa, with sigma = S delta, kappa = sum_i c_i delta_i, c = S (1, 1) + r, eta_i = sigma_i' - r_i b':
///   on d_i  b x (s' sigma_i + s (sigma_i' + eta_i)) + s b' x sigma_i,
///   on b    -b x (s' kappa + s (kappa' + eta_1 + eta_2)) - s (b' x kappa + w)
template <bool Offsets>
WHIRL_INLINE BentSpin add_bent_spin(const Group& g, const ElasticForce& elastic, T o1, T o2,
                                    const NodeSpin& sp1, const NodeSpin& sp2, const Node& x1,
                                    const Node& x2, V (&f)[4]) {
  const double* at[width];
  for (int i = 0; i < width; ++i)
    at[i] = g.element[i] + ShaftPlaces::bend;
  T k[6];
  load_record(at, k);
  const T S11 = k[0], S12 = k[1], S22 = k[2], r1 = k[3], r2 = k[4], inverse = k[5];
  const T c1 = S11 + S12 + r1, c2 = S12 + S22 + r2;
  const T spin = 0.5 * (sp1.s + sp2.s), spin_rate = 0.5 * (sp1.sdot + sp2.sdot);
  const V stretch = (elastic.chord.stretch * inverse) * elastic.chord.a;
  const V b = elastic.chord.a + stretch;
  V lambda_rate = x2.du - x1.du, lambda_accel = x2.ddu - x1.ddu;
  if constexpr (Offsets) {
    lambda_rate = lambda_rate + (o2 * x2.dd - o1 * x1.dd);
    lambda_accel = lambda_accel + (o2 * x2.ddd - o1 * x1.ddd);
  }
  const V b_rate = inverse * lambda_rate, b_accel = inverse * lambda_accel;
  const V delta1 = elastic.delta1 - stretch, delta2 = elastic.delta2 - stretch;
  const V rate1 = x1.dd - b_rate, rate2 = x2.dd - b_rate;
  const V sigma1 = S11 * delta1 + S12 * delta2, sigma2 = S12 * delta1 + S22 * delta2;
  const V kappa = c1 * delta1 + c2 * delta2;
  const V sigma_rate1 = S11 * rate1 + S12 * rate2, sigma_rate2 = S12 * rate1 + S22 * rate2;
  const V eta1 = sigma_rate1 - r1 * b_rate, eta2 = sigma_rate2 - r2 * b_rate;
  const V turning = spin * b_rate;
  const V p1 = cross(b, spin_rate * sigma1 + spin * (sigma_rate1 + eta1)) + cross(turning, sigma1);
  const V p2 = cross(b, spin_rate * sigma2 + spin * (sigma_rate2 + eta2)) + cross(turning, sigma2);
  const V sideways = cross(b_rate, kappa);
  const V w = cross(sigma1, x1.dd) + cross(sigma2, x2.dd) + sideways;
  const V w_rate = cross(sigma1, x1.ddd) + cross(sigma2, x2.ddd) + cross(b_accel, kappa) +
                   cross(b_rate, r1 * x1.dd + r2 * x2.dd);
  const V kappa_rate = c1 * rate1 + c2 * rate2;
  const V on_lambda = inverse * (cross(b, spin_rate * kappa + spin * (kappa_rate + eta1 + eta2)) +
                                 spin * (sideways + w));
  add(f[0], on_lambda);
  add(f[1], p1);
  f[2] = f[2] - on_lambda;
  add(f[3], p2);
  if constexpr (Offsets) {
    add(f[1], o1 * on_lambda);
    f[3] = f[3] - o2 * on_lambda;
  }
  return {dot(b, w), dot(b_rate, w) + dot(b, w_rate)};
}

template <bool Offsets>
WHIRL_INLINE void add_shafts(const Elements& b, std::size_t first, int used) {
  const Group g = group_of<ShaftPlaces>(b, first, used);
  const Node x1 = load_node(g.s1), x2 = load_node(g.s2);
  const Shaft shaft = load_shaft(g.element);
  const ElasticForce elastic = elastic_force<Offsets>(shaft, g.e, x1, x2);
  const NodeSpin sp1 = spin_of(g.e, x1), sp2 = spin_of(g.e, x2);
  V f[4] = {-elastic.lambda, elastic.d1, elastic.lambda, elastic.d2};
  add_inertia(g, x1, x2, f);
  const BentSpin bent = add_bent_spin<Offsets>(g, elastic, shaft.o1, shaft.o2, sp1, sp2, x1, x2, f);
  const T half = 0.5 * bent.value, half_rate = 0.5 * bent.rate;
  T polar[4];
  load_column(g.element, ShaftPlaces::polar, polar);
  const T p11 = polar[0], p21 = polar[1], p12 = polar[2], p22 = polar[3];
  const T h1 = p11 * sp1.s + p12 * sp2.s + half, h2 = p21 * sp1.s + p22 * sp2.s + half;
  const T q1 = p11 * sp1.sdot + p12 * sp2.sdot + half_rate;
  const T q2 = p21 * sp1.sdot + p22 * sp2.sdot + half_rate;
  f[1] = f[1] - (q1 * sp1.w + h1 * cross(g.e + x1.t, x1.dd));
  f[3] = f[3] - (q2 * sp2.w + h2 * cross(g.e + x2.t, x2.dd));
  add_to_nodes(g, used, f[0], f[1], q1 - elastic.torque, f[2], f[3], q2 + elastic.torque);
}

/// Elastic energy; V of stresses_of.
WHIRL_INLINE T elastic_energy(const Shaft& k, const Deformed& now) {
  const Stresses<Lanes>& r = now.stress;
  const T F1 = now.strain.end1.angle.F, F2 = now.strain.end2.angle.F;
  return 0.5 * k.c.EA_l * r.w * r.w + k.c.preload * r.w +
         0.5 * (k.c.k11 * F1 + 2.0 * k.c.k12 * now.strain.theta12 + k.c.k22 * F2) +
         0.5 * k.c.GJ_l * now.psi * now.psi - 0.5 * r.Q * r.B;
}

/// Gamma of add_bent_spin.
template <bool Offsets>
WHIRL_INLINE T bent_spin(const Group& g, const Strain<Lanes>& s, T o1, T o2, const Node& x1,
                         const Node& x2) {
  const double* at[width];
  for (int i = 0; i < width; ++i)
    at[i] = g.element[i] + ShaftPlaces::bend;
  T k[6];
  load_record(at, k);
  const T S11 = k[0], S12 = k[1], S22 = k[2], r1 = k[3], r2 = k[4], inverse = k[5];
  const V stretch = (s.chord.stretch * inverse) * s.chord.a;
  V lambda_rate = x2.du - x1.du;
  if constexpr (Offsets) lambda_rate = lambda_rate + (o2 * x2.dd - o1 * x1.dd);
  const V delta1 = s.end1.delta - stretch, delta2 = s.end2.delta - stretch;
  const V kappa = (S11 + S12 + r1) * delta1 + (S12 + S22 + r2) * delta2;
  const V w = cross(S11 * delta1 + S12 * delta2, x1.dd) +
              cross(S12 * delta1 + S22 * delta2, x2.dd) + cross(inverse * lambda_rate, kappa);
  return dot(s.chord.a + stretch, w);
}

template <bool Offsets>
WHIRL_INLINE void add_energies(const Elements& b, std::size_t first, int used,
                               const double* gravity, Energies& sum) {
  const Group g = group_of<ShaftPlaces>(b, first, used);
  const Node x1 = load_node(g.s1), x2 = load_node(g.s2);
  const Shaft shaft = load_shaft(g.element);
  const Deformed now = deformed<Offsets>(shaft, g.e, x1, x2);
  const T elastic = elastic_energy(shaft, now);
  // d - e0, not d - e: e moves with the chart, and the weight's moment on the directors of a cone
  // does not cancel.
  const V shift = g.e - shaft.e0, d1 = x1.t + shift, d2 = x2.t + shift;
  const V* const place[4] = {&x1.u, &d1, &x2.u, &d2};
  const V* const rate[4] = {&x1.du, &x1.dd, &x2.du, &x2.dd};
  T kinetic{}, weight{};
  for (int j = 0; j < 4; ++j) {
    T column[4];
    load_column(g.element, ShaftPlaces::M4 + 4 * j, column);
    for (int k = 0; k < 4; ++k)
      kinetic += column[k] * dot(*rate[k], *rate[j]);
    weight += (column[0] + column[2]) *
              (gravity[0] * place[j]->x + gravity[1] * place[j]->y + gravity[2] * place[j]->z);
  }
  T polar[4];
  load_column(g.element, ShaftPlaces::polar, polar);
  const T s1 = spin_of(g.e, x1).s, s2 = spin_of(g.e, x2).s;
  kinetic += s1 * (polar[0] * s1 + polar[2] * s2) + s2 * (polar[1] * s1 + polar[3] * s2) +
             (s1 + s2) * bent_spin<Offsets>(g, now.strain, shaft.o1, shaft.o2, x1, x2);
  for (int i = 0; i < used; ++i) {
    sum.elastic += elastic[i];
    sum.kinetic += 0.5 * kinetic[i];
    sum.gravity -= weight[i];
  }
}

template <bool Rotating>
WHIRL_INLINE void add_dampers(const Elements& b, std::size_t first, int used) {
  using P = DampingPlaces;
  const Group g = group_of<P>(b, first, used);
  T r[P::size];
  load_record(g.element, r);
  const DampingParameters<Lanes> c{vector_at(r, P::e0), r[P::length],  r[P::d11],    r[P::d12],
                                   r[P::d22],           r[P::d_twist], r[P::d_axial]};
  const T o1 = r[P::o1], o2 = r[P::o2];
  const Node x1 = load_node(g.s1), x2 = load_node(g.s2);
  const V du = x2.u - x1.u + o2 * x2.t - o1 * x1.t;
  const DampingRates<Lanes> v{x2.du - x1.du + o2 * x2.dd - o1 * x1.dd, x1.dd, x2.dd, x1.dphi,
                              x2.dphi};
  const DampingForce<Lanes> f =
      damping_force<Rotating>(c, damping_kinematics(c, g.e, du, x1.t, x2.t), v);
  add_to_nodes(g, used, -f.lambda, f.d1 - o1 * f.lambda, f.phi1, f.lambda, f.d2 + o2 * f.lambda,
               f.phi2);
}

using AddGroup = void(const Elements&, std::size_t first, int used);
template <AddGroup Add>
void add_all(const Elements& b) {
  std::size_t i = 0;
  for (; i + width <= b.count; i += width)
    Add(b, i, width);
  if (i < b.count) Add(b, i, static_cast<int>(b.count - i));
}

template <bool Offsets>
void add_all_energies(const Elements& b, const double* gravity, Energies& sum) {
  std::size_t i = 0;
  for (; i + width <= b.count; i += width)
    add_energies<Offsets>(b, i, width, gravity, sum);
  if (i < b.count) add_energies<Offsets>(b, i, static_cast<int>(b.count - i), gravity, sum);
}

}  // namespace

const Kernels* WHIRL_LANES_TABLE() {
  static const Kernels table{WHIRL_LANES_ISA,
                             add_all<add_shafts<false>>,
                             add_all<add_shafts<true>>,
                             add_all<add_dampers<true>>,
                             add_all<add_dampers<false>>,
                             add_all_energies<false>,
                             add_all_energies<true>};
  return &table;
}

}  // namespace whirl::elements::lanes
