#include <elements/shaft_beam.hpp>

#include <elements/shaft_strain.hpp>
#include <system/spin.hpp>

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
  double l, stretch;   // stretch = l - length
  double n1, n2, m, tau, S;
  AngleRatio r1, r2;

  template <bool Offsets>
  Strain(const ShaftBeam<Offsets>& b, const NodeState& x1, const NodeState& x2) {
    Vec3 du = x2.u - x1.u;
    if constexpr (Offsets) du += b.c.o2 * x2.t - b.c.o1 * x1.t;
    const double L = b.c.length;
    l = (L * b.e0 + du).norm();
    stretch = (2.0 * L * b.e0.dot(du) + du.squaredNorm()) / (l + L);
    const Vec3 alpha = (du - stretch * b.e0) / l;   // a - e0
    a = b.e0 + alpha;
    d1 = x1.d(), d2 = x2.d();
    const Vec3 shift = x1.e() - b.e0 - alpha;       // e - e0 is exactly zero in the line's own chart
    delta1 = x1.t + shift, delta2 = x2.t + shift;
    n1 = 0.5 * delta1.squaredNorm(), n2 = 0.5 * delta2.squaredNorm(), m = delta1.dot(delta2);
    tau = a.dot(delta1.cross(delta2));
    r1 = AngleRatio(n1), r2 = AngleRatio(n2);
    S = r1.G * r2.G * (m - n1 * n2);
  }
  double bow(const ShaftElementConstants& c) const { return 0.5 * (c.b11 * r1.F + 2.0 * c.b12 * S + c.b22 * r2.F); }
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
    h1m = c12 * D1 * G2, h2m = c12 * G1 * D2;
  }
};

using Vector9 = Vector<9>;   // (a, d1, d2)
using Matrix9 = Matrix<9>;

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
  SolidAngle o1, o2;   // Omega(e, d1, a), Omega(e, a, d2)
  double geometric;
  Vector9 g;
  Vec3 tau_a, tau_1, tau_2;
  Twist(const Vec3& e, const Strain& s, double tau_c) : o1(e, s.d1, s.a), o2(e, s.a, s.d2) {
    const double G = s.r1.G * s.r2.G;
    geometric = -(o1.value + o2.value) + tau_c * G * s.tau;
    tau_1 = s.delta2.cross(s.a), tau_2 = s.a.cross(s.delta1);
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

/// Start of (x1, d1, x2, d2) in the element's 14.
constexpr int pos[4] = {0, 3, 7, 10};

}  // namespace

template <bool Offsets>
ShaftBeam<Offsets>::ShaftBeam(const ShaftElementConstants& constants, const Vec3& direction) : c(constants), e0(direction) {
  G4c = c.G4;
  G4c(1, 1) -= c.polar.row(0).sum();
  G4c(3, 3) -= c.polar.row(1).sum();
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const NodeState &x1 = *x[0], &x2 = *x[1];
  const Strain s(*this, x1, x2);
  const double N = preload + c.EA_l * (s.stretch + c.length * s.bow(c)), NL = N * c.length;
  Vector9 g = gradient(Form(c.k11 + NL * c.b11, c.k12 + NL * c.b12, c.k22 + NL * c.b22, s), s);
  const Twist t(x1.e(), s, c.tau_c);
  const double torque = c.GJ_l * (x2.phi - x1.phi + t.geometric - psi0);
  g += torque * t.g;
  chain_gradient(s, N, g);
  f.segment<3>(0) -= g.head<3>();
  f.segment<3>(7) += g.head<3>();
  f.segment<3>(3) += g.segment<3>(3);
  f.segment<3>(10) += g.segment<3>(6);
  if constexpr (Offsets) {
    f.segment<3>(3) -= c.o1 * g.head<3>();
    f.segment<3>(10) += c.o2 * g.head<3>();
  }
  f[6] -= torque, f[13] += torque;

  // inertia
  const SpinRate s1(x1), s2(x2);
  const Vec3* acc[4] = {&x1.ddu, &x1.ddd, &x2.ddu, &x2.ddd};
  const Vec3* vel[4] = {&x1.du, &x1.dd, &x2.du, &x2.dd};
  const double mean_spin = 0.5 * (s1.s + s2.s);
  for (int k = 0; k < 4; ++k) {
    Vec3 y = Vec3::Zero(), v = Vec3::Zero();
    for (int j = 0; j < 4; ++j) y += c.M4(k, j) * *acc[j], v += G4c(k, j) * *vel[j];
    f.segment<3>(pos[k]) += y - mean_spin * s.a.cross(v);
  }
  const double h1 = c.polar(0, 0) * s1.s + c.polar(0, 1) * s2.s, h2 = c.polar(1, 0) * s1.s + c.polar(1, 1) * s2.s;
  const double r1 = c.polar(0, 0) * s1.sdot + c.polar(0, 1) * s2.sdot, r2 = c.polar(1, 0) * s1.sdot + c.polar(1, 1) * s2.sdot;
  f.segment<3>(3) -= r1 * s1.w + h1 * s.d1.cross(x1.dd);
  f.segment<3>(10) -= r2 * s2.w + h2 * s.d2.cross(x2.dd);
  f[6] += r1, f[13] += r2;
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_tangent(const Nodes<2>& x, const Context&, TangentX<14>& out) const {
  const NodeState &x1 = *x[0], &x2 = *x[1];
  const Strain s(*this, x1, x2);
  const double L = c.length, N = preload + c.EA_l * (s.stretch + L * s.bow(c)), NL = N * L;
  const Form bend(c.k11 + NL * c.b11, c.k12 + NL * c.b12, c.k22 + NL * c.b22, s);
  const Vector9 gw = L * gradient(Form(c.b11, c.b12, c.b22, s), s);   // dw = dl + gw . d(a, d1, d2)
  const Twist t(x1.e(), s, c.tau_c);
  const double T = c.GJ_l * (x2.phi - x1.phi + t.geometric - psi0);
  const Vector9 ga = gradient(bend, s) + T * t.g;

  // Hessian in (a, d1, d2): rank-one parts of w and psi, the form in (n1, n2, m, tau), and the curvature of these scalars.
  Matrix9 H;
  H.noalias() = (c.EA_l * gw) * gw.transpose();
  H.noalias() += (c.GJ_l * t.g) * t.g.transpose();
  const double TG = T * c.tau_c;
  const double G1 = s.r1.G, G2 = s.r2.G, D1 = s.r1.G1, D2 = s.r2.G1;
  const double w1 = bend.g1 + TG * D1 * G2 * s.tau, w2 = bend.g2 + TG * G1 * D2 * s.tau, wm = bend.gm, wt = TG * G1 * G2;
  Eigen::Matrix<double, 9, 4> g;   // gradients of n1, n2, m, tau
  g.col(0) << -s.delta1, s.delta1, Vec3::Zero();
  g.col(1) << -s.delta2, Vec3::Zero(), s.delta2;
  g.col(2) << -s.delta1 - s.delta2, s.delta2, s.delta1;
  g.col(3) << t.tau_a, t.tau_1, t.tau_2;
  const double h11 = bend.h11 + TG * s.r1.G2 * G2 * s.tau, h22 = bend.h22 + TG * G1 * s.r2.G2 * s.tau;
  const double h12 = bend.h12 + TG * D1 * D2 * s.tau, h1t = TG * D1 * G2, h2t = TG * G1 * D2;
  Matrix<4> h;
  h << h11, h12, bend.h1m, h1t,
       h12, h22, bend.h2m, h2t,
       bend.h1m, bend.h2m, 0.0, 0.0,
       h1t, h2t, 0.0, 0.0;
  const Eigen::Matrix<double, 9, 4> gh = g * h;
  H.noalias() += gh * g.transpose();
  const Vec3 e = x1.e();
  const Mat3 I = Mat3::Identity();
  H.block<3, 3>(0, 0) += (w1 + w2 + 2.0 * wm) * I - T * (t.o1.hess_ww() + t.o2.hess_vv());
  H.block<3, 3>(3, 3) += w1 * I - T * t.o1.hess_vv();
  H.block<3, 3>(6, 6) += w2 * I - T * t.o2.hess_ww();
  const Mat3 H_1a = -(w1 + wm) * I + wt * skew(s.d2) - T * t.o1.hess_vw(e);
  const Mat3 H_a2 = -(w2 + wm) * I + wt * skew(s.d1) - T * t.o2.hess_vw(e);
  const Mat3 H_12 = wm * I - wt * skew(s.a);
  H.block<3, 3>(3, 0) += H_1a, H.block<3, 3>(0, 3) += H_1a.transpose();
  H.block<3, 3>(0, 6) += H_a2, H.block<3, 3>(6, 0) += H_a2.transpose();
  H.block<3, 3>(3, 6) += H_12, H.block<3, 3>(6, 3) += H_12.transpose();

  // from (a, l) to lambda: da = P dlambda, P = (1 - a a^T)/l
  const Mat3 aa = s.a * s.a.transpose(), P = (I - aa) / s.l;
  const Vec3 va = ga.head<3>(), Pva = P * va, Pcw = P * (c.EA_l * gw.head<3>());   // d2V/dl da = EA_l gw_a
  Mat3 Hll = c.EA_l * aa + P * H.block<3, 3>(0, 0) * P;
  Hll += s.a * Pcw.transpose() + Pcw * s.a.transpose();
  Hll += (N - s.a.dot(va) / s.l) * P - (Pva * s.a.transpose() + s.a * Pva.transpose()) / s.l;
  const Eigen::Matrix<double, 3, 6> Hld = P * H.block<3, 6>(0, 3) + s.a * (c.EA_l * gw.tail<6>()).transpose();
  Vector9 tg = t.g;
  chain_gradient(s, 0.0, tg);

  auto& K = out.K;
  auto add = [&K](int r, int q, const Mat3& b) { K.template block<3, 3>(r, q) += b; };
  Mat3 H1 = Hld.leftCols<3>(), H2 = Hld.rightCols<3>(), H11 = H.block<3, 3>(3, 3), H22 = H.block<3, 3>(6, 6),
       H12 = H.block<3, 3>(3, 6);
  Vec3 tg1 = tg.segment<3>(3), tg2 = tg.segment<3>(6);
  if constexpr (Offsets) {
    // d lambda = dx2 - dx1 + o2 dd2 - o1 dd1
    const double o1 = c.o1, o2 = c.o2;
    H11 += -o1 * (H1 + H1.transpose()) + o1 * o1 * Hll;
    H22 += o2 * (H2 + H2.transpose()) + o2 * o2 * Hll;
    H12 += -o1 * H2 + o2 * H1.transpose() - o1 * o2 * Hll;
    H1 -= o1 * Hll, H2 += o2 * Hll;
    tg1 -= o1 * tg.head<3>(), tg2 += o2 * tg.head<3>();
  }
  add(0, 0, Hll), add(7, 7, Hll), add(0, 7, -Hll), add(7, 0, -Hll);
  add(0, 3, -H1), add(7, 3, H1), add(3, 0, -H1.transpose()), add(3, 7, H1.transpose());
  add(0, 10, -H2), add(7, 10, H2), add(10, 0, -H2.transpose()), add(10, 7, H2.transpose());
  add(3, 3, H11), add(10, 10, H22), add(3, 10, H12), add(10, 3, H12.transpose());
  Vector<14> tp;   // d torque/dX but for phi
  tp << -tg.head<3>(), tg1, 0.0, tg.head<3>(), tg2, 0.0;
  tp *= c.GJ_l;
  K.row(13) += tp.transpose(), K.row(6) -= tp.transpose();
  K.col(13) += tp, K.col(6) -= tp;
  K(6, 6) += c.GJ_l, K(13, 13) += c.GJ_l, K(6, 13) -= c.GJ_l, K(13, 6) -= c.GJ_l;

  // inertia
  const NodeState* n[2] = {&x1, &x2};
  const SpinRate sp[2] = {SpinRate(x1), SpinRate(x2)};
  const Vec3* vel[4] = {&x1.du, &x1.dd, &x2.du, &x2.dd};
  const double mean_spin = 0.5 * (sp[0].s + sp[1].s);
  const Mat3 sa = mean_spin * skew(s.a);
  for (int k = 0; k < 4; ++k) {
    Vec3 v = Vec3::Zero();
    for (int j = 0; j < 4; ++j) {
      v += G4c(k, j) * *vel[j];
      out.M.template block<3, 3>(pos[k], pos[j]).diagonal().array() += c.M4(k, j);
      out.C.template block<3, 3>(pos[k], pos[j]) -= G4c(k, j) * sa;
    }
    // -s a x v through the spins, then through a
    const Vec3 av = 0.5 * s.a.cross(v);
    for (int j = 0; j < 2; ++j) {
      out.C.template block<3, 1>(pos[k], 7 * j + 6) -= av;
      out.C.template block<3, 3>(pos[k], 7 * j + 3) += av * sp[j].w.transpose();
      out.K.template block<3, 3>(pos[k], 7 * j + 3) -= av * sp[j].s_d.transpose();
    }
    const Mat3 B = (mean_spin * skew(v)) * P;
    add(pos[k], 0, -B), add(pos[k], 7, B);
    if constexpr (Offsets) add(pos[k], 3, -c.o1 * B), add(pos[k], 10, c.o2 * B);
  }
  for (int i = 0; i < 2; ++i) {
    const int r = 7 * i;
    const double hi = c.polar(i, 0) * sp[0].s + c.polar(i, 1) * sp[1].s;
    const double hdot = c.polar(i, 0) * sp[0].sdot + c.polar(i, 1) * sp[1].sdot;
    const Vec3 dxd = n[i]->d().cross(n[i]->dd);
    out.K.template block<3, 3>(r + 3, r + 3) += hi * skew(n[i]->dd) - hdot * sp[i].W();
    out.C.template block<3, 3>(r + 3, r + 3) -= hi * skew(n[i]->d());
    for (int j = 0; j < 2; ++j) {
      const int q = 7 * j;
      const double p = c.polar(i, j);
      out.M(r + 6, q + 6) += p;
      out.M.template block<1, 3>(r + 6, q + 3) -= p * sp[j].w.transpose();
      out.M.template block<3, 1>(r + 3, q + 6) -= p * sp[i].w;
      out.M.template block<3, 3>(r + 3, q + 3) += p * sp[i].w * sp[j].w.transpose();
      out.C.template block<1, 3>(r + 6, q + 3) += p * sp[j].sdot_dd.transpose();
      out.C.template block<3, 3>(r + 3, q + 3) -= p * (sp[i].w * sp[j].sdot_dd.transpose() - dxd * sp[j].w.transpose());
      out.C.template block<3, 1>(r + 3, q + 6) -= p * dxd;
      out.K.template block<1, 3>(r + 6, q + 3) += p * sp[j].sdot_d.transpose();
      out.K.template block<3, 3>(r + 3, q + 3) -= p * (sp[i].w * sp[j].sdot_d.transpose() + dxd * sp[j].s_d.transpose());
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
  e.elastic += 0.5 * c.EA_l * w * w + preload * w + 0.5 * (c.k11 * s.r1.F + 2.0 * c.k12 * s.S + c.k22 * s.r2.F) +
               0.5 * c.GJ_l * psi * psi;
  const Vec3* vel[4] = {&x1.du, &x1.dd, &x2.du, &x2.dd};
  double T = 0.0;
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) T += c.M4(k, j) * vel[k]->dot(*vel[j]);
  const Vec2 spin(x1.spin(), x2.spin());
  e.kinetic += 0.5 * T + 0.5 * spin.dot(c.polar * spin);
  const Vec3* px[4] = {&x1.u, &x1.t, &x2.u, &x2.t};
  for (int j = 0; j < 4; ++j) e.gravity -= (c.M4(0, j) + c.M4(2, j)) * ctx.gravity.dot(*px[j]);
}

template <bool Offsets>
typename ShaftBeam<Offsets>::Internal ShaftBeam<Offsets>::internal(const Nodes<2>& x) const {
  const NodeState &x1 = *x[0], &x2 = *x[1];
  const Strain s(*this, x1, x2);
  Internal r;
  r.N = preload + c.EA_l * (s.stretch + c.length * s.bow(c));
  const Twist t(x1.e(), s, c.tau_c);
  r.torque = c.GJ_l * (x2.phi - x1.phi + t.geometric - psi0);
  const Vec3 th1 = s.r1.G * s.a.cross(s.d1), th2 = s.r2.G * s.a.cross(s.d2);   // rotation vectors from chord to normal
  r.moment1 = c.k11 * th1 + c.k12 * th2;
  r.moment2 = c.k12 * th1 + c.k22 * th2;
  r.shear = s.a.cross(r.moment1 + r.moment2) / s.l;
  return r;
}

template struct ShaftBeam<false>;
template struct ShaftBeam<true>;

}  // namespace whirl::elements
