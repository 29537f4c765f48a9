#include <elements/shaft/shaft_beam.hpp>

#include <elements/shaft/general_beam.hpp>
#include <elements/shaft/shaft_lanes.hpp>
#include <elements/shaft/shaft_strain.hpp>
#include <system/spin.hpp>
#include <system/stiffness_rate.hpp>
#include <algorithm>
#include <cstddef>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::NodeState;
using system::SpinRate;
using system::TangentX;

namespace {

/// Chord and strain scalars at a configuration.
struct Strain {
  Vec3 a, d1, d2, delta1, delta2;
  double l, stretch;  // stretch = l - length
  double n1, n2, m, tau, S;
  AngleRatio r1, r2;

  template <bool Offsets>
  Strain(const ShaftBeam<Offsets>& b, const NodeState& x1, const NodeState& x2) {
    Vec3 du = x2.u - x1.u;
    if constexpr (Offsets) du += b.c.o2 * x2.t - b.c.o1 * x1.t;
    const double L = b.c.length;
    l = (L * b.e0 + du).norm();
    stretch = (2.0 * L * b.e0.dot(du) + du.squaredNorm()) / (l + L);
    const Vec3 alpha = (du - stretch * b.e0) / l;  // a - e0
    a = b.e0 + alpha;
    d1 = x1.d();
    d2 = x2.d();
    const Vec3 shift = x1.e() - b.e0 - alpha;  // e - e0 is exactly zero in the line's own chart
    delta1 = x1.t + shift;
    delta2 = x2.t + shift;
    n1 = 0.5 * delta1.squaredNorm();
    n2 = 0.5 * delta2.squaredNorm();
    m = delta1.dot(delta2);
    tau = a.dot(delta1.cross(delta2));
    r1 = AngleRatio(n1);
    r2 = AngleRatio(n2);
    S = r1.G * r2.G * (m - n1 * n2);
  }
  double bow(const ShaftElementConstants& c) const {
    return 0.5 * (c.b11 * r1.F + 2.0 * c.b12 * S + c.b22 * r2.F);
  }
};

/// Derivatives of c11/2 F1 + c12 S + c22/2 F2 in (n1, n2, m).
struct Form {
  double g1, g2, gm, h11, h22, h12, h1m, h2m;
  Form(double c11, double c12, double c22, const Strain& s) {
    const double G1 = s.r1.G, G2 = s.r2.G, D1 = s.r1.G1, D2 = s.r2.G1, P = s.m - s.n1 * s.n2;
    g1 = c11 * G1 + c12 * (D1 * G2 * P - G1 * G2 * s.n2);
    g2 = c22 * G2 + c12 * (G1 * D2 * P - G1 * G2 * s.n1);
    gm = c12 * G1 * G2;
    h11 = c11 * D1 + c12 * (s.r1.G2 * G2 * P - 2.0 * D1 * G2 * s.n2);
    h22 = c22 * D2 + c12 * (G1 * s.r2.G2 * P - 2.0 * G1 * D2 * s.n1);
    h12 = c12 * (D1 * D2 * P - D1 * G2 * s.n1 - G1 * D2 * s.n2 - G1 * G2);
    h1m = c12 * D1 * G2;
    h2m = c12 * G1 * D2;
  }
};

/// g(N) of the header and half its derivative, and half its second one.
struct Give {
  double g, g1, g2;
  template <class Beam>
  Give(const Beam& b, double N) {
    const double n = std::max(N, b.soft_limit), d = N - n, rho = 1.0 / (1.0 + b.soft_shear * n),
                 slope = 0.5 * n * rho * (1.0 + rho);
    g2 = rho * rho * rho;
    g1 = slope + g2 * d;
    g = n * n * rho + (slope + g1) * d;
  }
};

/// What acts on the rates of w, psi and |th2 - th1|^2/2 once the inside has given way: V = .. - B/2
/// (q psi^2 + r g), B = |th2 - th1|^2.
struct Inside {
  double psi, B, N, torque, Q;
  Give give;
  template <class Beam>
  Inside(const Beam& b, const Strain& s, double N0, double twist)
      : psi(twist),
        B(s.r1.F + s.r2.F - 2.0 * s.S),
        torque((b.c.GJ_l - b.soft_torque * B) * twist),
        give(b, N0) {
    N = N0 - b.c.EA_l * b.soft_axial * B * give.g1;
    Q = b.soft_torque * twist * twist + b.soft_axial * give.g;
  }
};

using Vector9 = Vector<9>;  // (a, d1, d2)

/// Gradient of a Form in (a, d1, d2).
Vector9 gradient(const Form& f, const Strain& s) {
  Vector9 g;
  g.segment<3>(3) = f.g1 * s.delta1 + f.gm * s.delta2;
  g.segment<3>(6) = f.g2 * s.delta2 + f.gm * s.delta1;
  g.head<3>() = -g.segment<3>(3) - g.segment<3>(6);
  return g;
}

/// Geometric part of the twist and its gradient in (a, d1, d2).
struct Twist {
  SolidAngle o1, o2;  // Omega(e, d1, a), Omega(e, a, d2)
  double geometric;
  Vector9 g;
  Vec3 tau_a, tau_1, tau_2;
  Twist(const Vec3& e, const Strain& s, double tau_c) : o1(e, s.d1, s.a), o2(e, s.a, s.d2) {
    const double G = s.r1.G * s.r2.G;
    geometric = -(o1.value + o2.value) + tau_c * G * s.tau;
    tau_1 = s.delta2.cross(s.a);
    tau_2 = s.a.cross(s.delta1);
    tau_a = s.a.cross(s.delta2 - s.delta1) + s.delta1.cross(s.delta2);
    const double c1 = tau_c * s.r1.G1 * s.r2.G * s.tau, c2 = tau_c * s.r1.G * s.r2.G1 * s.tau;
    g.head<3>() = -o1.grad_w() - o2.grad_v() + tau_c * G * tau_a - c1 * s.delta1 - c2 * s.delta2;
    g.segment<3>(3) = -o1.grad_v() + tau_c * G * tau_1 + c1 * s.delta1;
    g.segment<3>(6) = -o2.grad_w() + tau_c * G * tau_2 + c2 * s.delta2;
  }
};

/// From (a, d1, d2) and the derivative Vl in l to (lambda, d1, d2), lambda = r2 - r1.
void chain_gradient(const Strain& s, double Vl, Vector9& g) {
  const Vec3 ga = g.head<3>();
  g.head<3>() = Vl * s.a + (ga - s.a.dot(ga) * s.a) / s.l;
}

/// m += s [v]
inline void add_skew(Mat3& m, double f, const Vec3& v) {
  m(0, 1) -= f * v.z();
  m(0, 2) += f * v.y();
  m(1, 0) += f * v.z();
  m(1, 2) -= f * v.x();
  m(2, 0) -= f * v.y();
  m(2, 1) += f * v.x();
}

/// Start of (x1, d1, x2, d2) in the element's 14.
constexpr int pos[4] = {0, 3, 7, 10};

}  // namespace

template <bool Offsets>
ShaftBeam<Offsets>::ShaftBeam(const ShaftElementConstants& constants, const Vec3& direction)
    : c(constants),
      e0(direction) {
  G4c = c.G4;
  G4c(1, 1) -= c.polar.row(0).sum();
  G4c(3, 3) -= c.polar.row(1).sum();
  const double mean = 0.5 * (c.k11 + c.k22), EI = 0.5 * c.length * (mean - c.k12);
  if (!(EI > 0)) return;
  const double stiff =
      std::min((mean + c.k12) / (3.0 * (mean - c.k12)),
               1.0);  // 1/(1 + Phi); a cone without shear gives a little more or less than one
  soft_torque = c.GJ_l * c.GJ_l * c.length * (1.0 - stiff) / (12.0 * EI);
  soft_shear = (1.0 - stiff) / stiff * c.length * c.length / (12.0 * EI);
  soft_axial = soft_shear * c.length / 12.0;
  soft_limit = -0.5 / soft_shear;  // -infinity without shear
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_forces(std::span<const ShaftBeam> elements,
                                    const std::array<Index, 2>* nodes, const NodeState* states,
                                    const Context&, Vector<7>* force) {
  if (elements.empty()) return;
  static_assert(sizeof(ShaftBeam) % sizeof(double) == 0 &&
                sizeof(NodeState) % sizeof(double) == 0 && sizeof(Vector<7>) == 7 * sizeof(double));
  static_assert(offsetof(NodeState, ddphi) == 20 * sizeof(double) &&
                offsetof(ShaftElementConstants, tau_c) - offsetof(ShaftElementConstants, length) ==
                    11 * sizeof(double));
  const ShaftBeam& k = elements[0];
  const double* const start = reinterpret_cast<const double*>(&k);
  lanes::ShaftElements b;
  b.element = start;
  b.stride = sizeof(ShaftBeam) / sizeof(double);
  b.count = elements.size();
  b.scalars = &k.c.length - start;
  b.M4 = k.c.M4.data() - start;
  b.G4c = k.G4c.data() - start;
  b.polar = k.c.polar.data() - start;
  b.e0 = k.e0.data() - start;
  b.psi0 = &k.psi0 - start;
  b.preload = &k.preload - start;
  b.soft = &k.soft_torque - start;
  b.nodes = nodes->data();
  b.state = states[0].u.data();
  b.state_stride = sizeof(NodeState) / sizeof(double);
  b.chart = offsetof(NodeState, chart) / sizeof(double);
  b.force = force->data();
  static const lanes::Kernels& kernels = lanes::kernels();
  (Offsets ? kernels.add_force_offset : kernels.add_force)(b);
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_force(const Nodes<2>& x, const Context& ctx, ForceX<14>& f) const {
  const NodeState states[2] = {*x[0], *x[1]};
  const std::array<Index, 2> nodes{0, 1};
  Vector<7> force[2] = {f.template head<7>(), f.template tail<7>()};
  add_forces({this, 1}, &nodes, states, ctx, force);
  f << force[0], force[1];
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_tangent(const Nodes<2>& x, const Context&, TangentX<14>& out) const {
  const NodeState &x1 = *x[0], &x2 = *x[1];
  const Strain s(*this, x1, x2);
  const double L = c.length, N0 = preload + c.EA_l * (s.stretch + L * s.bow(c));
  Twist t(x1.e(), s, c.tau_c);
  const Inside in(*this, s, N0, x2.phi - x1.phi + t.geometric - psi0);
  const double N = in.N, NL = N * L, T = in.torque;
  const Form bend(c.k11 + NL * c.b11 - in.Q, c.k12 + NL * c.b12 + in.Q, c.k22 + NL * c.b22 - in.Q,
                  s);
  Vector9 gw = L * gradient(Form(c.b11, c.b12, c.b22, s), s);  // dw = dl + gw . d(a, d1, d2)
  const Vector9 ga = gradient(bend, s) + T * t.g;
  // Second derivatives of V in (w, psi, beta), beta = |th2 - th1|^2/2: squares of gw and t.g
  // shifted along the gradient of beta, and one of that.
  const Vector9 gb = gradient(Form(1.0, -1.0, 1.0, s), s);
  const double EA_l = c.EA_l * (1.0 - in.B * soft_axial * c.EA_l * in.give.g2),
               GJ_l = c.GJ_l - in.B * soft_torque;
  const double shift_w = 2.0 * soft_axial * in.give.g1 * c.EA_l / EA_l,
               shift_t = GJ_l > 0.0 ? 2.0 * soft_torque * in.psi / GJ_l : 0.0;
  const double bb = -(EA_l * shift_w * shift_w + GJ_l * shift_t * shift_t);
  gw -= shift_w * gb;
  t.g -= shift_t * gb;

  // Hessian in (a, d1, d2), by blocks: rank-one parts of w and psi, the form in (n1, n2, m, tau),
  // the curvature of these scalars. Outer products are spelled out (add_outer): small fixed sizes
  // that general product code would not unroll.
  const double TG = T * c.tau_c;
  const double G1 = s.r1.G, G2 = s.r2.G, D1 = s.r1.G1, D2 = s.r2.G1;
  const double w1 = bend.g1 + TG * D1 * G2 * s.tau, w2 = bend.g2 + TG * G1 * D2 * s.tau,
               wm = bend.gm, wt = TG * G1 * G2;
  const double h11 = bend.h11 + TG * s.r1.G2 * G2 * s.tau,
               h22 = bend.h22 + TG * G1 * s.r2.G2 * s.tau;
  const double h12 = bend.h12 + TG * D1 * D2 * s.tau, h1t = TG * D1 * G2, h2t = TG * G1 * D2;
  // rows of h g for the gradients g of (n1, n2, m, tau) in d1, d2 and a
  const Vec3 &p1 = s.delta1, &p2 = s.delta2, ps = p1 + p2;
  const Vec3 y11 = h11 * p1 + bend.h1m * p2 + h1t * t.tau_1,
             y12 = h12 * p1 + bend.h2m * p2 + h2t * t.tau_1;
  const Vec3 y1m = bend.h1m * p1, y1t = h1t * p1;
  const Vec3 y21 = h12 * p2 + bend.h1m * p1 + h1t * t.tau_2,
             y22 = h22 * p2 + bend.h2m * p1 + h2t * t.tau_2;
  const Vec3 y2m = bend.h2m * p2, y2t = h2t * p2;
  const Vec3 ya1 = -h11 * p1 - h12 * p2 - bend.h1m * ps + h1t * t.tau_a,
             ya2 = -h12 * p1 - h22 * p2 - bend.h2m * ps + h2t * t.tau_a;
  const Vec3 yam = -bend.h1m * p1 - bend.h2m * p2, yat = -h1t * p1 - h2t * p2;
  const Vec3 wa = gw.head<3>(), wd1 = gw.segment<3>(3), wd2 = gw.tail<3>();
  const Vec3 ta = t.g.head<3>(), td1 = t.g.segment<3>(3), td2 = t.g.tail<3>();
  const Vec3 ba = gb.head<3>(), b1 = gb.segment<3>(3), b2 = gb.tail<3>();
  auto start = [&](const Vec3& wx, const Vec3& tx, const Vec3& bx, const Vec3& wy, const Vec3& ty,
                   const Vec3& by) {
    Mat3 m = Mat3::Zero();
    add_outer(m, EA_l * wx, wy);
    add_outer(m, GJ_l * tx, ty);
    if (bb != 0.0) add_outer(m, bb * bx, by);
    return m;
  };
  const Vec3 e = x1.e();
  Mat3 H11 = start(wd1, td1, b1, wd1, td1, b1), H12 = start(wd1, td1, b1, wd2, td2, b2),
       H22 = start(wd2, td2, b2, wd2, td2, b2);
  Mat3 H1a = start(wd1, td1, b1, wa, ta, ba), H2a = start(wd2, td2, b2, wa, ta, ba),
       Haa = start(wa, ta, ba, wa, ta, ba);
  add_outer(H11, y11, p1);
  add_outer(H11, y1m, p2);
  add_outer(H11, y1t, t.tau_1);
  add_outer(H12, y12, p2);
  add_outer(H12, y1m, p1);
  add_outer(H12, y1t, t.tau_2);
  add_outer(H22, y22, p2);
  add_outer(H22, y2m, p1);
  add_outer(H22, y2t, t.tau_2);
  add_outer(H1a, -y11 - y1m, p1);
  add_outer(H1a, -y12 - y1m, p2);
  add_outer(H1a, y1t, t.tau_a);
  add_outer(H2a, -y21 - y2m, p1);
  add_outer(H2a, -y22 - y2m, p2);
  add_outer(H2a, y2t, t.tau_a);
  add_outer(Haa, -ya1 - yam, p1);
  add_outer(Haa, -ya2 - yam, p2);
  add_outer(Haa, yat, t.tau_a);
  t.o1.add_vv(-T, H11);
  t.o1.add_ww(-T, Haa);
  t.o1.add_vw(-T, e, H1a);
  t.o2.add_ww(-T, H22);
  t.o2.add_vv(-T, Haa);
  t.o2.add_wv(-T, e, H2a);
  H11.diagonal().array() += w1;
  H22.diagonal().array() += w2;
  H12.diagonal().array() += wm;
  Haa.diagonal().array() += w1 + w2 + 2.0 * wm;
  H1a.diagonal().array() -= w1 + wm;
  H2a.diagonal().array() -= w2 + wm;
  add_skew(H1a, wt, s.d2);
  add_skew(H2a, -wt, s.d1);
  add_skew(H12, -wt, s.a);

  // from (a, l) to lambda: da = P dlambda, P = (1 - a a^T)/l
  const Vec3 va = ga.head<3>(), Pva = (va - s.a.dot(va) * s.a) / s.l,
             Pcw = (EA_l / s.l) * (wa - s.a.dot(wa) * s.a);
  // P Haa P = (Haa - a (a^T Haa) - (Haa a) a^T + (a^T Haa a) a a^T)/l^2
  const Vec3 Ha = Haa * s.a;
  const double il = 1.0 / s.l, il2 = il * il, aHa = s.a.dot(Ha),
               tension = (N - s.a.dot(va) * il) * il;
  Mat3 Hll = il2 * Haa;
  Hll.diagonal().array() += tension;
  const Vec3 side = Pcw - il2 * Ha - il * Pva;
  add_outer(Hll, s.a, side);
  add_outer(Hll, side + (il2 * aHa + EA_l - tension) * s.a, s.a);
  // Hl_i = P Haa_i + EA a gw_i^T, i = 1, 2
  auto lambda_d = [&](const Mat3& Hda, const Vec3& wd) {
    Mat3 m = il * Hda.transpose();
    add_outer(m, s.a, EA_l * wd - il * (Hda * s.a));
    return m;
  };
  Mat3 H1 = lambda_d(H1a, wd1), H2 = lambda_d(H2a, wd2);
  Vector9 tg = t.g;
  chain_gradient(s, 0.0, tg);
  Vec3 tg1 = tg.segment<3>(3), tg2 = tg.segment<3>(6);
  if constexpr (Offsets) {
    // d lambda = dx2 - dx1 + o2 dd2 - o1 dd1
    const double o1 = c.o1, o2 = c.o2;
    H11 += -o1 * (H1 + H1.transpose()) + o1 * o1 * Hll;
    H22 += o2 * (H2 + H2.transpose()) + o2 * o2 * Hll;
    H12 += -o1 * H2 + o2 * H1.transpose() - o1 * o2 * Hll;
    H1 -= o1 * Hll;
    H2 += o2 * Hll;
    tg1 -= o1 * tg.head<3>();
    tg2 += o2 * tg.head<3>();
  }
  auto& K = out.K;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const double ll = Hll(i, j), l1 = H1(i, j), l2 = H2(i, j), m12 = H12(i, j);
      K(i, j) += ll;
      K(7 + i, 7 + j) += ll;
      K(i, 7 + j) -= ll;
      K(7 + i, j) -= ll;
      K(i, 3 + j) -= l1;
      K(7 + i, 3 + j) += l1;
      K(3 + j, i) -= l1;
      K(3 + j, 7 + i) += l1;
      K(i, 10 + j) -= l2;
      K(7 + i, 10 + j) += l2;
      K(10 + j, i) -= l2;
      K(10 + j, 7 + i) += l2;
      K(3 + i, 3 + j) += H11(i, j);
      K(10 + i, 10 + j) += H22(i, j);
      K(3 + i, 10 + j) += m12;
      K(10 + j, 3 + i) += m12;
    }
  for (int i = 0; i < 3; ++i) {  // torque against phi
    const double l = GJ_l * tg[i], d1 = GJ_l * tg1[i], d2 = GJ_l * tg2[i];
    K(13, i) -= l;
    K(i, 13) -= l;
    K(6, i) += l;
    K(i, 6) += l;
    K(13, 7 + i) += l;
    K(7 + i, 13) += l;
    K(6, 7 + i) -= l;
    K(7 + i, 6) -= l;
    K(13, 3 + i) += d1;
    K(3 + i, 13) += d1;
    K(6, 3 + i) -= d1;
    K(3 + i, 6) -= d1;
    K(13, 10 + i) += d2;
    K(10 + i, 13) += d2;
    K(6, 10 + i) -= d2;
    K(10 + i, 6) -= d2;
  }
  K(6, 6) += GJ_l;
  K(13, 13) += GJ_l;
  K(6, 13) -= GJ_l;
  K(13, 6) -= GJ_l;

  // inertia
  const NodeState* n[2] = {&x1, &x2};
  const SpinRate sp[2] = {SpinRate(x1), SpinRate(x2)};
  const Vec3* vel[4] = {&x1.du, &x1.dd, &x2.du, &x2.dd};
  const double mean_spin = 0.5 * (sp[0].s + sp[1].s);
  auto &C = out.C, &M = out.M;
  const Vec3 ms = mean_spin * s.a;
  for (int k = 0; k < 4; ++k) {
    const int r = pos[k];
    Vec3 v = Vec3::Zero();
    for (int j = 0; j < 4; ++j) {
      const int q = pos[j];
      v += G4c(k, j) * *vel[j];
      const double m = c.M4(k, j), gx = G4c(k, j) * ms.x(), gy = G4c(k, j) * ms.y(),
                   gz = G4c(k, j) * ms.z();
      M(r, q) += m;
      M(r + 1, q + 1) += m;
      M(r + 2, q + 2) += m;
      C(r, q + 1) += gz;
      C(r, q + 2) -= gy;
      C(r + 1, q) -= gz;
      C(r + 1, q + 2) += gx;
      C(r + 2, q) += gy;
      C(r + 2, q + 1) -= gx;
    }
    // -s a x v through the spins, then through a: s [v] P = s ([v] - (v x a) a^T)/l
    const Vec3 av = 0.5 * s.a.cross(v);
    Mat3 B = Mat3::Zero();
    add_skew(B, mean_spin * il, v);
    add_outer(B, (-mean_spin * il) * v.cross(s.a), s.a);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 2; ++j)
        C(r + i, 7 * j + 6) -= av[i];
      for (int j = 0; j < 3; ++j) {
        C(r + i, 3 + j) += av[i] * sp[0].w[j];
        C(r + i, 10 + j) += av[i] * sp[1].w[j];
        K(r + i, 3 + j) -= av[i] * sp[0].s_d[j];
        K(r + i, 10 + j) -= av[i] * sp[1].s_d[j];
        K(r + i, j) -= B(i, j);
        K(r + i, 7 + j) += B(i, j);
        if constexpr (Offsets) {
          K(r + i, 3 + j) -= c.o1 * B(i, j);
          K(r + i, 10 + j) += c.o2 * B(i, j);
        }
      }
    }
  }
  for (int i = 0; i < 2; ++i) {
    const int r = 7 * i;
    const double hi = c.polar(i, 0) * sp[0].s + c.polar(i, 1) * sp[1].s;
    const double hdot = c.polar(i, 0) * sp[0].sdot + c.polar(i, 1) * sp[1].sdot;
    const Vec3 d = n[i]->d(), dxd = d.cross(n[i]->dd);
    const Mat3 W = sp[i].W();
    Mat3 A = Mat3::Zero(), B = Mat3::Zero();
    add_skew(A, hi, n[i]->dd);
    add_skew(B, -hi, d);
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) {
        K(r + 3 + a, r + 3 + b) += A(a, b) - hdot * W(a, b);
        C(r + 3 + a, r + 3 + b) += B(a, b);
      }
    for (int j = 0; j < 2; ++j) {
      const int q = 7 * j;
      const double p = c.polar(i, j);
      const Vec3 &wi = sp[i].w, &wj = sp[j].w;
      M(r + 6, q + 6) += p;
      for (int b = 0; b < 3; ++b) {
        M(r + 6, q + 3 + b) -= p * wj[b];
        M(r + 3 + b, q + 6) -= p * wi[b];
        C(r + 6, q + 3 + b) += p * sp[j].sdot_dd[b];
        C(r + 3 + b, q + 6) -= p * dxd[b];
        K(r + 6, q + 3 + b) += p * sp[j].sdot_d[b];
        for (int a = 0; a < 3; ++a) {
          M(r + 3 + a, q + 3 + b) += p * wi[a] * wj[b];
          C(r + 3 + a, q + 3 + b) -= p * (wi[a] * sp[j].sdot_dd[b] - dxd[a] * wj[b]);
          K(r + 3 + a, q + 3 + b) -= p * (wi[a] * sp[j].sdot_d[b] + dxd[a] * sp[j].s_d[b]);
        }
      }
    }
  }
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_energy(const Nodes<2>& x, const Context& ctx, Energy& e) const {
  const NodeState &x1 = *x[0], &x2 = *x[1];
  const Strain s(*this, x1, x2);
  const double w = s.stretch + c.length * s.bow(c);
  const Twist t(x1.e(), s, c.tau_c);
  const double psi = x2.phi - x1.phi + t.geometric - psi0;
  e.elastic += 0.5 * c.EA_l * w * w + preload * w +
               0.5 * (c.k11 * s.r1.F + 2.0 * c.k12 * s.S + c.k22 * s.r2.F) +
               0.5 * c.GJ_l * psi * psi;
  const double N = preload + c.EA_l * w;
  e.elastic -= 0.5 * (soft_torque * psi * psi + soft_axial * Give(*this, N).g) *
               (s.r1.F + s.r2.F - 2.0 * s.S);
  const Vec3* vel[4] = {&x1.du, &x1.dd, &x2.du, &x2.dd};
  double T = 0.0;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      T += c.M4(k, j) * vel[k]->dot(*vel[j]);
  const Vec2 spin(x1.spin(), x2.spin());
  e.kinetic += 0.5 * T + 0.5 * spin.dot(c.polar * spin);
  // d - e0, not d - e: e moves with the chart, and the weight's moment on the directors of a cone
  // does not cancel.
  const Vec3 shift = x1.e() - e0;
  const Vec3 p[4] = {x1.u, x1.t + shift, x2.u, x2.t + shift};
  for (int j = 0; j < 4; ++j)
    e.gravity -= (c.M4(0, j) + c.M4(2, j)) * ctx.gravity.dot(p[j]);
}

template <bool Offsets>
typename ShaftBeam<Offsets>::Internal ShaftBeam<Offsets>::internal(const Nodes<2>& x) const {
  const NodeState &x1 = *x[0], &x2 = *x[1];
  const Strain s(*this, x1, x2);
  Internal r;
  const Twist t(x1.e(), s, c.tau_c);
  const Inside in(*this, s, preload + c.EA_l * (s.stretch + c.length * s.bow(c)),
                  x2.phi - x1.phi + t.geometric - psi0);
  r.N = in.N;
  r.torque = in.torque;
  const Vec3 th1 = s.r1.G * s.a.cross(s.d1),
             th2 = s.r2.G * s.a.cross(s.d2);  // rotation vectors from chord to normal
  r.moment1 = (c.k11 - in.Q) * th1 + (c.k12 + in.Q) * th2;
  r.moment2 = (c.k12 + in.Q) * th1 + (c.k22 - in.Q) * th2;
  r.shear = s.a.cross(r.moment1 + r.moment2) / s.l;
  return r;
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_stiffness_rate(const Nodes<2>& x, const Nodes<2>& rate,
                                            const Context& ctx,
                                            system::StiffnessRateX<14>& out) const {
  GeneralBeamConstants g;
  g.length = c.length;
  g.EA_l = c.EA_l;
  g.GJ_l = c.GJ_l;
  g.ky_def11 = g.kz_def11 = c.k11;
  g.ky_def12 = g.kz_def12 = c.k12;
  g.ky_def22 = g.kz_def22 = c.k22;
  g.b11 = c.b11;
  g.b12 = c.b12;
  g.b22 = c.b22;
  const Vec3 side = e0.unitOrthogonal();
  Mat3 triad;
  triad << e0, side, e0.cross(side);
  // its normals are the directors, whatever the chart
  const double o1 = Offsets ? c.o1 : 0.0, o2 = Offsets ? c.o2 : 0.0;
  GeneralBeam beam(g, c.length * e0, triad, triad, o1 * e0, o2 * e0, triad, triad);
  beam.preload = preload;
  beam.add_stiffness_rate(x, rate, ctx, out);
}

template struct ShaftBeam<false>;
template struct ShaftBeam<true>;

namespace {
[[maybe_unused]] const bool known_plain = system::know_stiffness_rate<ShaftBeam<false>>();
[[maybe_unused]] const bool known_offset = system::know_stiffness_rate<ShaftBeam<true>>();
}  // namespace

}  // namespace whirl::elements
