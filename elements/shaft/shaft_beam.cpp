#include <elements/shaft/shaft_beam.hpp>
#include <core/contract.hpp>

#include <core/dual_rate.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/shaft/shaft_lanes.hpp>
#include <system/spin.hpp>
#include <system/stiffness_rate.hpp>
#include <math.h>
#include <algorithm>
#include <array>
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

#include <elements/shaft/shaft_single.inl>

using One = Numbers;

/// An element at a configuration.
struct Deformed {
  ShaftStiffness<One> c;
  Strain<One> strain;
  Twist<One> twist;
  double psi;
  Stresses<One> stress;

  template <bool Offsets>
  Deformed(const ShaftBeam<Offsets>& b, const NodeState& x1, const NodeState& x2)
      : c{b.c.length, b.c.EA_l,      b.c.b11,      b.c.b12,      b.c.b22,
          b.c.k11,    b.c.k12,       b.c.k22,      b.c.GJ_l,     b.c.tau_c,
          b.preload,  b.soft_torque, b.soft_axial, b.soft_shear, b.soft_limit} {
    Vec3 du = x2.u - x1.u;
    if constexpr (Offsets) du += b.c.o2 * x2.t - b.c.o1 * x1.t;
    strain = strain_of<One>(c.length, b.e0, x1.e(), du, x1.t, x2.t);
    twist = twist_of(x1.e(), c.tau_c, strain);
    psi = x2.phi - x1.phi + twist.geometric - b.psi0;
    stress = stresses_of(c, strain, psi);
  }
};

/// m += a b^T. Spelled out: small fixed sizes that general product code would not unroll.
void add_outer(Mat3& m, const Vec3& a, const Vec3& b) {
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      m(i, j) += a[i] * b[j];
}

/// m += f [v]
void add_skew(Mat3& m, double f, const Vec3& v) {
  m(0, 1) -= f * v.z();
  m(0, 2) += f * v.y();
  m(1, 0) += f * v.z();
  m(1, 2) -= f * v.x();
  m(2, 0) -= f * v.y();
  m(2, 1) += f * v.x();
}

/// Second derivative of a solid angle Omega(e, v, w) in (v, w), from dOmega = p dN + r dD: N is
/// bilinear with d2N/dv dw = -[e], D with 1; dp = -c2 dN - c1 dD, dr = -c1 dN + c2 dD with
/// c1 = (p^2 - r^2)/2, c2 = -p r.
class SolidAngleCurvature {
 public:
  explicit SolidAngleCurvature(const SolidAngle<One>& angle)
      : o(angle),
        c1(0.5 * (o.p * o.p - o.r * o.r)),
        c2(-o.p * o.r) {}
  /// m += f times the second derivative.
  void add_vv(double f, Mat3& m) const { add(f, o.Nv, o.Dv, o.Nv, o.Dv, m); }
  void add_ww(double f, Mat3& m) const { add(f, o.Nw, o.Dw, o.Nw, o.Dw, m); }
  void add_vw(double f, const Vec3& e, Mat3& m) const {
    add(f, o.Nv, o.Dv, o.Nw, o.Dw, m);
    add_mixed(f, -1.0, e, m);
  }
  void add_wv(double f, const Vec3& e, Mat3& m) const {
    add(f, o.Nw, o.Dw, o.Nv, o.Dv, m);
    add_mixed(f, 1.0, e, m);
  }

 private:
  void add(double f, const Vec3& Nx, const Vec3& Dx, const Vec3& Ny, const Vec3& Dy,
           Mat3& m) const {
    add_outer(m, f * (c2 * Dx - c1 * Nx), Dy);
    add_outer(m, -f * (c1 * Dx + c2 * Nx), Ny);
  }
  void add_mixed(double f, double sign, const Vec3& e, Mat3& m) const {
    add_skew(m, sign * f * o.p, e);
    m.diagonal().array() += f * o.r;
  }
  const SolidAngle<One>& o;
  double c1, c2;
};

/// V as a function of (n1, n2, m, tau) at given stresses: slopes and second derivatives.
struct ScalarForm {
  double n1, n2, m, tau;
  double n1n1, n2n2, n1n2, n1m, n2m, n1tau, n2tau;
};
ScalarForm scalar_form(const BendingStiffness<double>& c, double torque_tau_c,
                       const Strain<One>& s) {
  const AngleRatio<double>&r1 = s.end1.angle, &r2 = s.end2.angle;
  const double second1 = angle_ratio_second(s.end1.n, r1),
               second2 = angle_ratio_second(s.end2.n, r2);
  const double D1G2 = r1.G1 * r2.G, G1D2 = r1.G * r2.G1, D1D2 = r1.G1 * r2.G1;
  const double along = torque_tau_c * s.tau;
  const BendingSlopes<double> slope = bending_slopes(c.c11, c.c12, c.c22, s);
  ScalarForm f;
  f.n1 = slope.n1 + along * D1G2;
  f.n2 = slope.n2 + along * G1D2;
  f.m = slope.m;
  f.tau = torque_tau_c * s.GG;
  f.n1n1 = c.c11 * r1.G1 + c.c12 * (second1 * r2.G * s.P - 2.0 * D1G2 * s.end2.n) +
           along * second1 * r2.G;
  f.n2n2 = c.c22 * r2.G1 + c.c12 * (r1.G * second2 * s.P - 2.0 * G1D2 * s.end1.n) +
           along * r1.G * second2;
  f.n1n2 = c.c12 * (D1D2 * s.P - D1G2 * s.end1.n - G1D2 * s.end2.n - s.GG) + along * D1D2;
  f.n1m = c.c12 * D1G2;
  f.n2m = c.c12 * G1D2;
  f.n1tau = torque_tau_c * D1G2;
  f.n2tau = torque_tau_c * G1D2;
  return f;
}

/// Second derivatives of V in (a, d1, d2) at constant l, by blocks (row, column).
struct Hessian {
  Mat3 aa = Mat3::Zero(), d1a = Mat3::Zero(), d2a = Mat3::Zero();
  Mat3 d1d1 = Mat3::Zero(), d1d2 = Mat3::Zero(), d2d2 = Mat3::Zero();

  /// += f g g^T
  void add_square(double f, const Gradient<One>& g) {
    add_outer(d1d1, f * g.d1, g.d1);
    add_outer(d1d2, f * g.d1, g.d2);
    add_outer(d2d2, f * g.d2, g.d2);
    add_outer(d1a, f * g.d1, g.a);
    add_outer(d2a, f * g.d2, g.a);
    add_outer(aa, f * g.a, g.a);
  }

  /// += sum of h_xy dx dy^T over the scalars x, y of a ScalarForm: rows of h against the gradients.
  void add_scalars(const ScalarForm& h, const Strain<One>& s, const Gradient<One>& tau) {
    const Vec3 &p1 = s.end1.delta, &p2 = s.end2.delta, sum = p1 + p2;
    const Vec3 y11 = h.n1n1 * p1 + h.n1m * p2 + h.n1tau * tau.d1;
    const Vec3 y12 = h.n1n2 * p1 + h.n2m * p2 + h.n2tau * tau.d1;
    const Vec3 y21 = h.n1n2 * p2 + h.n1m * p1 + h.n1tau * tau.d2;
    const Vec3 y22 = h.n2n2 * p2 + h.n2m * p1 + h.n2tau * tau.d2;
    const Vec3 y1m = h.n1m * p1, y1tau = h.n1tau * p1;
    const Vec3 y2m = h.n2m * p2, y2tau = h.n2tau * p2;
    const Vec3 ya1 = -h.n1n1 * p1 - h.n1n2 * p2 - h.n1m * sum + h.n1tau * tau.a;
    const Vec3 ya2 = -h.n1n2 * p1 - h.n2n2 * p2 - h.n2m * sum + h.n2tau * tau.a;
    const Vec3 yam = -h.n1m * p1 - h.n2m * p2, yatau = -h.n1tau * p1 - h.n2tau * p2;
    add_outer(d1d1, y11, p1);
    add_outer(d1d1, y1m, p2);
    add_outer(d1d1, y1tau, tau.d1);
    add_outer(d1d2, y12, p2);
    add_outer(d1d2, y1m, p1);
    add_outer(d1d2, y1tau, tau.d2);
    add_outer(d2d2, y22, p2);
    add_outer(d2d2, y2m, p1);
    add_outer(d2d2, y2tau, tau.d2);
    add_outer(d1a, -y11 - y1m, p1);
    add_outer(d1a, -y12 - y1m, p2);
    add_outer(d1a, y1tau, tau.a);
    add_outer(d2a, -y21 - y2m, p1);
    add_outer(d2a, -y22 - y2m, p2);
    add_outer(d2a, y2tau, tau.a);
    add_outer(aa, -ya1 - yam, p1);
    add_outer(aa, -ya2 - yam, p2);
    add_outer(aa, yatau, tau.a);
  }

  /// += slopes times the second derivatives of (n1, n2, m, tau).
  void add_curvature(const ScalarForm& f, const Strain<One>& s) {
    d1d1.diagonal().array() += f.n1;
    d2d2.diagonal().array() += f.n2;
    d1d2.diagonal().array() += f.m;
    aa.diagonal().array() += f.n1 + f.n2 + 2.0 * f.m;
    d1a.diagonal().array() -= f.n1 + f.m;
    d2a.diagonal().array() -= f.n2 + f.m;
    add_skew(d1a, f.tau, s.d2);
    add_skew(d2a, -f.tau, s.d1);
    add_skew(d1d2, -f.tau, s.chord.a);
  }

  /// += the torque on the solid angles in psi.
  void add_solid_angles(double torque, const Vec3& e, const Twist<One>& t) {
    const SolidAngleCurvature at1(t.at1), at2(t.at2);
    at1.add_vv(-torque, d1d1);
    at1.add_ww(-torque, aa);
    at1.add_vw(-torque, e, d1a);
    at2.add_ww(-torque, d2d2);
    at2.add_vv(-torque, aa);
    at2.add_wv(-torque, e, d2a);
  }
};

/// The same in (lambda, d1, d2): blocks with lambda, and those of d1, d2.
struct ChordHessian {
  Mat3 ll, l1, l2;
  Mat3 d1d1, d1d2, d2d2;

  /// From (a, l): da = P dlambda, P = (1 - a a^T)/l. across: dV/da; w: gradient of w, beside
  /// dw/dl = 1.
  ChordHessian(const Chord<One>& c, const Hessian& h, double N, const Vec3& across, double EA_l,
               const Gradient<One>& w)
      : d1d1(h.d1d1),
        d1d2(h.d1d2),
        d2d2(h.d2d2) {
    const Vec3& a = c.a;
    const double il = c.inverse, il2 = il * il;
    const Vec3 Pacross = il * perpendicular(a, across);
    const Vec3 Pw = (EA_l * il) * perpendicular(a, w.a);
    // P Haa P = (Haa - a (a^T Haa) - (Haa a) a^T + (a^T Haa a) a a^T)/l^2
    const Vec3 Ha = h.aa * a;
    const double tension = (N - a.dot(across) * il) * il;
    ll = il2 * h.aa;
    ll.diagonal().array() += tension;
    const Vec3 side = Pw - il2 * Ha - il * Pacross;
    add_outer(ll, a, side);
    add_outer(ll, side + (il2 * a.dot(Ha) + EA_l - tension) * a, a);
    // P Haa_i + EA a gw_i^T, i = 1, 2
    l1 = il * h.d1a.transpose();
    add_outer(l1, a, EA_l * w.d1 - il * (h.d1a * a));
    l2 = il * h.d2a.transpose();
    add_outer(l2, a, EA_l * w.d2 - il * (h.d2a * a));
  }

  // d lambda = dx2 - dx1 + o2 dd2 - o1 dd1
  void add_offsets(double o1, double o2) {
    d1d1 += -o1 * (l1 + l1.transpose()) + o1 * o1 * ll;
    d2d2 += o2 * (l2 + l2.transpose()) + o2 * o2 * ll;
    d1d2 += -o1 * l2 + o2 * l1.transpose() - o1 * o2 * ll;
    l1 -= o1 * ll;
    l2 += o2 * ll;
  }

  void add_to(Matrix<14>& K) const {
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) {
        K(i, j) += ll(i, j);
        K(7 + i, 7 + j) += ll(i, j);
        K(i, 7 + j) -= ll(i, j);
        K(7 + i, j) -= ll(i, j);
        K(i, 3 + j) -= l1(i, j);
        K(7 + i, 3 + j) += l1(i, j);
        K(3 + j, i) -= l1(i, j);
        K(3 + j, 7 + i) += l1(i, j);
        K(i, 10 + j) -= l2(i, j);
        K(7 + i, 10 + j) += l2(i, j);
        K(10 + j, i) -= l2(i, j);
        K(10 + j, 7 + i) += l2(i, j);
        K(3 + i, 3 + j) += d1d1(i, j);
        K(10 + i, 10 + j) += d2d2(i, j);
        K(3 + i, 10 + j) += d1d2(i, j);
        K(10 + j, 3 + i) += d1d2(i, j);
      }
  }
};

/// Stiffness GJ_l of the twist between phi and everything: g the gradient of psi in (lambda, d1,
/// d2) with the nodes' offsets inside.
void add_twist_coupling(double GJ_l, const Gradient<One>& g, Matrix<14>& K) {
  for (int i = 0; i < 3; ++i) {
    const double l = GJ_l * g.a[i], d1 = GJ_l * g.d1[i], d2 = GJ_l * g.d2[i];
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
}

template <bool Offsets>
void add_elastic_tangent(const ShaftBeam<Offsets>& b, const Vec3& e, const Deformed& x,
                         Matrix<14>& K) {
  const Strain<One>& s = x.strain;
  const Stresses<One>& r = x.stress;
  const BendingStiffness<double> c = bending_stiffness_of(x.c, r);
  const ScalarForm form = scalar_form(c, r.torque * x.c.tau_c, s);
  Gradient<One> psi = twist_gradient(x.twist, x.c.tau_c, s);
  const Gradient<One> bending = bending_gradient(bending_slopes(c.c11, c.c12, c.c22, s), s);
  const Vec3 across = elastic_gradient(bending, r.torque, psi).a;
  // w = l - length + length e_b, and B/2 = |th2 - th1|^2/2
  Gradient<One> w = bending_gradient(bending_slopes(x.c.b11, x.c.b12, x.c.b22, s), s);
  const Gradient<One> half_B = bending_gradient(bending_slopes(1.0, -1.0, 1.0, s), s);
  // Second derivatives of V in (w, psi, B/2): squares of dw and dpsi shifted along dB/2, and one of
  // that.
  const double EA_l = x.c.EA_l * (1.0 - r.B * x.c.soft_axial * x.c.EA_l * r.give.g2);
  const double GJ_l = x.c.GJ_l - r.B * x.c.soft_torque;
  const double shift_w = 2.0 * x.c.soft_axial * r.give.g1 * x.c.EA_l / EA_l;
  const double shift_psi = GJ_l > 0.0 ? 2.0 * x.c.soft_torque * x.psi / GJ_l : 0.0;
  w = {x.c.length * w.a - shift_w * half_B.a, x.c.length * w.d1 - shift_w * half_B.d1,
       x.c.length * w.d2 - shift_w * half_B.d2};
  psi = {psi.a - shift_psi * half_B.a, psi.d1 - shift_psi * half_B.d1,
         psi.d2 - shift_psi * half_B.d2};

  Hessian h;
  h.add_square(EA_l, w);
  h.add_square(GJ_l, psi);
  const double softened = EA_l * shift_w * shift_w + GJ_l * shift_psi * shift_psi;
  if (softened != 0.0) h.add_square(-softened, half_B);
  h.add_scalars(form, s, tau_gradient(s));
  h.add_solid_angles(r.torque, e, x.twist);
  h.add_curvature(form, s);
  ChordHessian in_chord(s.chord, h, r.N, across, EA_l, w);
  psi.a = chord_gradient(s.chord, 0.0, psi.a);
  if constexpr (Offsets) {
    in_chord.add_offsets(b.c.o1, b.c.o2);
    psi.d1 -= b.c.o1 * psi.a;
    psi.d2 += b.c.o2 * psi.a;
  }
  in_chord.add_to(K);
  add_twist_coupling(GJ_l, psi, K);
}

/// Start of (x1, d1, x2, d2) in the element's 14.
constexpr int pos[4] = {0, 3, 7, 10};

/// Of M4 X''.
void add_mass(const Matrix<4>& M4, Matrix<14>& M) {
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 3; ++i)
        M(pos[k] + i, pos[j] + i) += M4(k, j);
}

/// What a function's derivative in (lambda, d1, d2) has.
using OnBend = std::array<Vec3, 3>;
/// Second derivatives, all of them skew matrices [v]: v of row, column.
using SkewBlocks = std::array<OnBend, 3>;

/// From (b, d1, d2), b = lambda/length, and lambda's part on the offsets.
template <bool Offsets>
void to_lambda(const ShaftBeam<Offsets>& beam, Vec3& b, Vec3& d1, Vec3& d2) {
  b *= beam.inverse;
  if constexpr (Offsets) {
    d1 -= beam.c.o1 * b;
    d2 += beam.c.o2 * b;
  }
}

/// What Gamma = b.w, w = sum_k sigma_k x d_k' - kappa x b', consists of (shaft_beam.hpp): sigma = S
/// delta, kappa = sum_i c_i delta_i, c = S (1, 1) + r.
template <bool Offsets>
struct BentShape {
  const ShaftBeam<Offsets>& beam;
  Vec3 b, b_rate, w;
  Vec3 sigma[2], kappa;
  double sum[2], c[2];

  BentShape(const ShaftBeam<Offsets>& of, const Nodes<2>& x, const Strain<One>& strain) : beam(of) {
    const Vec3 stretch = strain.chord.stretch * beam.inverse * strain.chord.a;
    b = strain.chord.a + stretch;
    b_rate = chord(x[0]->du, x[0]->dd, x[1]->du, x[1]->dd);
    const Vec3 delta1 = strain.end1.delta - stretch, delta2 = strain.end2.delta - stretch;
    for (int i = 0; i < 2; ++i) {
      sum[i] = beam.bend[i] + beam.bend[i + 1];
      c[i] = sum[i] + beam.bend[3 + i];
      sigma[i] = beam.bend[i] * delta1 + beam.bend[i + 1] * delta2;
    }
    kappa = c[0] * delta1 + c[1] * delta2;
    w = sigma[0].cross(x[0]->dd) + sigma[1].cross(x[1]->dd) - kappa.cross(b_rate);
  }
  /// b of these (x1, d1, x2, d2), or a derivative.
  Vec3 chord(const Vec3& u1, const Vec3& d1, const Vec3& u2, const Vec3& d2) const {
    Vec3 lambda = u2 - u1;
    if constexpr (Offsets) lambda += beam.c.o2 * d2 - beam.c.o1 * d1;
    return beam.inverse * lambda;
  }
};

/// The spin of a bent inside with its derivatives.
struct BentSpin {
  double value = 0, rate = 0;
  OnBend g, g_rate;      ///< dGamma/dX', its rate
  OnBend E, E_rate;      ///< dGamma/dX, its rate
  SkewBlocks D, D_rate;  ///< of g and g_rate in X
  SkewBlocks H;          ///< of E in X

  template <bool Offsets>
  BentSpin(const ShaftBeam<Offsets>& beam, const Nodes<2>& x, const Strain<One>& strain) {
    const BentShape<Offsets> at(beam, x, strain);
    const Vec3 &b = at.b, &b1 = at.b_rate, &w = at.w;
    const Vec3* sigma = at.sigma;
    const Vec3 b2 = at.chord(x[0]->ddu, x[0]->ddd, x[1]->ddu, x[1]->ddd);
    const Vec3 *d1[2] = {&x[0]->dd, &x[1]->dd}, *d2[2] = {&x[0]->ddd, &x[1]->ddd};
    const Vec3 kappa1 = at.c[0] * (*d1[0] - b1) + at.c[1] * (*d1[1] - b1);
    Vec3 w1 = b2.cross(at.kappa);
    for (int k = 0; k < 2; ++k)
      w1 += sigma[k].cross(*d2[k]) + beam.bend[3 + k] * b1.cross(*d1[k]);
    value = b.dot(w);
    rate = b1.dot(w) + b.dot(w1);
    g[0] = -b.cross(at.kappa);
    g_rate[0] = -b1.cross(at.kappa) - b.cross(kappa1);
    E[0] = w;
    E_rate[0] = w1;
    D[0][0] = at.kappa + (at.c[0] + at.c[1]) * b;
    D_rate[0][0] = kappa1 + (at.c[0] + at.c[1]) * b1;
    H[0][0] = Vec3::Zero();
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t i = k + 1;
      const double S1 = beam.bend[static_cast<Index>(k)], S2 = beam.bend[static_cast<Index>(i)];
      const Vec3 turn = S1 * *d1[0] + S2 * *d1[1], turn1 = S1 * *d2[0] + S2 * *d2[1];
      const Vec3 sigma1 = turn - at.sum[k] * b1;
      const Vec3 eta = turn - at.c[k] * b1, eta1 = turn1 - at.c[k] * b2;
      g[i] = b.cross(sigma[k]);
      g_rate[i] = b1.cross(sigma[k]) + b.cross(sigma1);
      E[i] = eta.cross(b);
      E_rate[i] = eta1.cross(b) + eta.cross(b1);
      E[0] -= E[i];
      E_rate[0] -= E_rate[i];
      D[i][0] = -sigma[k] - at.sum[k] * b;
      D_rate[i][0] = -turn;
      D[0][i] = -at.c[k] * b;
      D_rate[0][i] = -at.c[k] * b1;
      H[i][0] = eta;
      H[0][i] = -eta;
      for (std::size_t j = 0; j < 2; ++j) {
        const double s = beam.bend[static_cast<Index>(k + j)];
        D[i][j + 1] = s * b;
        D_rate[i][j + 1] = s * b1;
        H[i][j + 1] = Vec3::Zero();
      }
    }
    for (OnBend* f : {&g, &g_rate, &E, &E_rate})
      to_lambda(beam, (*f)[0], (*f)[1], (*f)[2]);
    for (SkewBlocks* m : {&D, &D_rate, &H}) {
      for (OnBend& row : *m)
        to_lambda(beam, row[0], row[1], row[2]);
      for (std::size_t j = 0; j < 3; ++j)
        to_lambda(beam, (*m)[0][j], (*m)[1][j], (*m)[2][j]);
    }
  }

  static Vector<14> in_element(const OnBend& f) {
    Vector<14> r;
    r << -f[0], f[1], 0.0, f[0], f[2], 0.0;
    return r;
  }
};

/// m += [v] by blocks (lambda, d1, d2) of a row and a column.
void add_skew_blocks(const SkewBlocks& v, Matrix<14>& m) {
  const auto add = [&](int r, int q, const Vec3& x) {
    m(r, q + 1) -= x.z();
    m(r, q + 2) += x.y();
    m(r + 1, q) += x.z();
    m(r + 1, q + 2) -= x.x();
    m(r + 2, q) -= x.y();
    m(r + 2, q + 1) += x.x();
  };
  add(0, 0, v[0][0]);
  add(7, 7, v[0][0]);
  add(0, 7, -v[0][0]);
  add(7, 0, -v[0][0]);
  for (std::size_t i = 1; i < 3; ++i) {
    const int at_d = i == 1 ? 3 : 10;
    add(0, at_d, -v[0][i]);
    add(7, at_d, v[0][i]);
    add(at_d, 0, -v[i][0]);
    add(at_d, 7, v[i][0]);
    add(at_d, 3, v[i][1]);
    add(at_d, 10, v[i][2]);
  }
}

/// Of the force of s Gamma, s the mean spin, s_v = ds/dX', but for what stands in the nodes' own
/// Gamma/2 and Gamma'/2 (add_polar_tangent): f = s' g + s (g' - E) + s_v Gamma' - Gamma/2 d x d'.
void add_bent_tangent(const BentSpin& b, const Nodes<2>& x, const SpinRate (&sp)[2],
                      TangentX<14>& out) {
  const double s = 0.5 * (sp[0].s + sp[1].s), s_rate = 0.5 * (sp[0].sdot + sp[1].sdot);
  const Vector<14> g = BentSpin::in_element(b.g), g_rate = BentSpin::in_element(b.g_rate),
                   E = BentSpin::in_element(b.E), E_rate = BentSpin::in_element(b.E_rate);
  const Vector<14> curl = g_rate - E, rate_v = g_rate + E;
  for (int i = 0; i < 2; ++i) {
    const NodeState& node = *x[static_cast<std::size_t>(i)];
    const int at_d = 7 * i + 3, at_phi = 7 * i + 6;
    // (d, phi) of a node stand together
    Vector<4> s_v, moment;
    s_v << -0.5 * sp[i].w, 0.5;
    moment << -0.5 * node.d().cross(node.dd), 0.0;
    out.M.middleRows<4>(at_d) += s_v * g.transpose();
    out.C.middleRows<4>(at_d) += s_v * rate_v.transpose() + moment * g.transpose();
    out.K.middleRows<4>(at_d) += s_v * E_rate.transpose() + moment * E.transpose();
    out.M.middleCols<4>(at_d) += g * s_v.transpose();
    out.C.col(at_phi) += 0.5 * curl;
    for (int j = 0; j < 3; ++j) {
      out.C.col(at_d + j) += (0.5 * sp[i].sdot_dd[j]) * g + s_v[j] * curl;
      out.K.col(at_d + j) += (0.5 * sp[i].sdot_d[j]) * g + (0.5 * sp[i].s_d[j]) * curl;
    }
  }
  SkewBlocks on_C, on_K;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      on_C[i][j] = s * (b.D[i][j] + b.D[j][i]);  // D - D^T
      on_K[i][j] = s_rate * b.D[i][j] + s * (b.D_rate[i][j] - b.H[i][j]);
    }
  add_skew_blocks(on_C, out.C);
  add_skew_blocks(on_K, out.K);
}

/// Of the polar inertia on the spins: h = polar s + Gamma/2; f_phi = h', f_d = -h' w - h d x d'.
void add_polar_tangent(const Mat2& polar, const BentSpin& bent, const Nodes<2>& x,
                       const SpinRate (&sp)[2], TangentX<14>& out) {
  auto &M = out.M, &C = out.C, &K = out.K;
  for (int i = 0; i < 2; ++i) {
    const NodeState& node = *x[static_cast<std::size_t>(i)];
    const int r = 7 * i;
    const double h = polar(i, 0) * sp[0].s + polar(i, 1) * sp[1].s + 0.5 * bent.value;
    const double hdot = polar(i, 0) * sp[0].sdot + polar(i, 1) * sp[1].sdot + 0.5 * bent.rate;
    const Vec3 d = node.d(), dxd = d.cross(node.dd);
    const Mat3 W = sp[i].W();
    Mat3 on_d = Mat3::Zero(), on_dd = Mat3::Zero();
    add_skew(on_d, h, node.dd);
    add_skew(on_dd, -h, d);
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) {
        K(r + 3 + a, r + 3 + b) += on_d(a, b) - hdot * W(a, b);
        C(r + 3 + a, r + 3 + b) += on_dd(a, b);
      }
    for (int j = 0; j < 2; ++j) {
      const int q = 7 * j;
      const double p = polar(i, j);
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

/// S11, S12, S22, r1, r2 of Gamma. With b fixed the couple of s Gamma is to be -s b x G X', G = G4 -
/// lumped, which contracts with translations to zero and with rotations to a vector across them:
/// X' = R delta' + a rotation at the rate b', R of the end rotations alone.
Vector<5> bend_of(const ShaftElementConstants& c) {
  Matrix<4> G = c.G4;
  G(1, 1) -= c.polar.row(0).sum();
  G(3, 3) -= c.polar.row(1).sum();
  Eigen::Matrix<double, 4, 2> R;
  R << -c.o1, 0.0, 1.0, 0.0, 0.0, -c.o2, 0.0, 1.0;
  const Vector<4> turn(0.0, 1.0, c.length + c.o1 - c.o2, 1.0);
  const Mat2 S = -0.5 * R.transpose() * G * R;
  const Vec2 r = R.transpose() * G * turn;
  Vector<5> out;
  out << S(0, 0), S(0, 1), S(1, 1), r;
  return out;
}

}  // namespace

template <bool Offsets>
ShaftBeam<Offsets>::ShaftBeam(const ShaftElementConstants& constants, const Vec3& direction)
    : c(constants),
      e0(direction) {
  WHIRL_EXPECTS(constants.length > 0.0 && constants.mass >= 0.0);
  WHIRL_EXPECTS(std::abs(direction.norm() - 1.0) < 1e-9);
  bend = bend_of(c);
  inverse = 1.0 / c.length;
  const double mean = 0.5 * (c.k11 + c.k22), EI = 0.5 * c.length * (mean - c.k12);
  if (!(EI > 0)) return;
  // 1/(1 + Phi); a cone without shear gives a little more or less than one
  const double stiff = std::min((mean + c.k12) / (3.0 * (mean - c.k12)), 1.0);
  soft_torque = c.GJ_l * c.GJ_l * c.length * (1.0 - stiff) / (12.0 * EI);
  soft_shear = (1.0 - stiff) / stiff * c.length * c.length / (12.0 * EI);
  soft_axial = soft_shear * c.length / 12.0;
  soft_limit = -0.5 / soft_shear;  // -infinity without shear
}

namespace {

/// What the kernels of shaft_lanes.hpp take for granted.
template <bool Offsets>
constexpr bool beam_in_place() {
  using Beam = ShaftBeam<Offsets>;
  using Places = lanes::ShaftPlaces;
  constexpr auto stands = [](std::size_t offset, int place) {
    return offset == static_cast<std::size_t>(place) * sizeof(double);
  };
  static_assert(stands(offsetof(Beam, c.length), Places::length));
  static_assert(stands(offsetof(Beam, c.o1), Places::o1));
  static_assert(stands(offsetof(Beam, c.o2), Places::o2));
  static_assert(stands(offsetof(Beam, c.EA_l), Places::EA_l));
  static_assert(stands(offsetof(Beam, c.b11), Places::b11));
  static_assert(stands(offsetof(Beam, c.b12), Places::b12));
  static_assert(stands(offsetof(Beam, c.b22), Places::b22));
  static_assert(stands(offsetof(Beam, c.k11), Places::k11));
  static_assert(stands(offsetof(Beam, c.k12), Places::k12));
  static_assert(stands(offsetof(Beam, c.k22), Places::k22));
  static_assert(stands(offsetof(Beam, c.GJ_l), Places::GJ_l));
  static_assert(stands(offsetof(Beam, c.tau_c), Places::tau_c));
  static_assert(stands(offsetof(Beam, c.M4), Places::M4));
  static_assert(stands(offsetof(Beam, c.polar), Places::polar));
  static_assert(stands(offsetof(Beam, e0), Places::e0));
  static_assert(stands(offsetof(Beam, psi0), Places::psi0));
  static_assert(stands(offsetof(Beam, preload), Places::preload));
  static_assert(stands(offsetof(Beam, soft_torque), Places::soft_torque));
  static_assert(stands(offsetof(Beam, soft_axial), Places::soft_axial));
  static_assert(stands(offsetof(Beam, soft_shear), Places::soft_shear));
  static_assert(stands(offsetof(Beam, soft_limit), Places::soft_limit));
  static_assert(stands(offsetof(Beam, bend), Places::bend));
  static_assert(stands(offsetof(Beam, inverse), Places::inverse));
  static_assert(sizeof(Matrix<4>) == 16 * sizeof(double) && sizeof(Mat2) == 4 * sizeof(double));
  return stands(sizeof(Beam), Places::size) && sizeof(Vector<7>) == 7 * sizeof(double);
}

/// A batch as the lanes see it.
template <bool Offsets>
lanes::Elements lanes_of(std::span<const ShaftBeam<Offsets>> elements,
                         const std::array<Index, 2>* nodes, const NodeState* states) {
  static_assert(beam_in_place<Offsets>());
  lanes::Elements b;
  b.element = &elements[0].c.length;
  b.count = elements.size();
  b.nodes = nodes->data();
  b.state = states[0].u.data();
  return b;
}

}  // namespace

template <bool Offsets>
void ShaftBeam<Offsets>::add_forces(std::span<const ShaftBeam> elements,
                                    const std::array<Index, 2>* nodes, const NodeState* states,
                                    const Context&, Vector<7>* force) {
  if (elements.empty()) return;
  lanes::Elements b = lanes_of(elements, nodes, states);
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
  const Deformed now(*this, *x[0], *x[1]);
  const SpinRate spin[2] = {SpinRate(*x[0]), SpinRate(*x[1])};
  add_elastic_tangent(*this, x[0]->e(), now, out.K);
  add_mass(c.M4, out.M);
  const BentSpin bent(*this, x, now.strain);
  add_bent_tangent(bent, x, spin, out);
  add_polar_tangent(c.polar, bent, x, spin, out);
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_energies(std::span<const ShaftBeam> elements,
                                      const std::array<Index, 2>* nodes, const NodeState* states,
                                      const Context& ctx, Energy& e) {
  if (elements.empty()) return;
  static const lanes::Kernels& kernels = lanes::kernels();
  lanes::Energies sum{e.elastic, e.kinetic, e.gravity};
  (Offsets ? kernels.add_energy_offset : kernels.add_energy)(lanes_of(elements, nodes, states),
                                                             ctx.gravity.data(), sum);
  e.elastic = sum.elastic;
  e.kinetic = sum.kinetic;
  e.gravity = sum.gravity;
}

template <bool Offsets>
void ShaftBeam<Offsets>::add_energy(const Nodes<2>& x, const Context& ctx, Energy& e) const {
  const NodeState states[2] = {*x[0], *x[1]};
  const std::array<Index, 2> nodes{0, 1};
  add_energies({this, 1}, &nodes, states, ctx, e);
}

template <bool Offsets>
typename ShaftBeam<Offsets>::Internal ShaftBeam<Offsets>::internal(const Nodes<2>& x) const {
  const Deformed now(*this, *x[0], *x[1]);
  const Strain<One>& s = now.strain;
  const Vec3& a = s.chord.a;
  // rotation vectors from chord to normal
  const Vec3 th1 = s.end1.angle.G * a.cross(s.d1), th2 = s.end2.angle.G * a.cross(s.d2);
  const double Q = now.stress.Q;
  Internal r;
  r.N = now.stress.N;
  r.torque = now.stress.torque;
  r.moment1 = (c.k11 - Q) * th1 + (c.k12 + Q) * th2;
  r.moment2 = (c.k12 + Q) * th1 + (c.k22 - Q) * th2;
  r.shear = a.cross(r.moment1 + r.moment2) / s.chord.l;
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
