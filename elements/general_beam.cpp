#include <elements/general_beam.hpp>

#include <core/dual.hpp>
#include <elements/shaft_strain.hpp>

#include <array>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::NodeState;
using system::TangentX;

namespace {

template <class T> using V3 = Vec3T<T>;

/// Node coordinates, rates and accelerations in any scalar.
template <class T>
struct NodeT {
  const Mat3* chart;
  V3<T> u, t, du, dd, ddu, ddd;
  T phi, dphi, ddphi;
  explicit NodeT(const NodeState& n)
      : chart(n.chart), u(n.u), t(n.t), du(n.du), dd(n.dd), ddu(n.ddu), ddd(n.ddd), phi(n.phi), dphi(n.dphi), ddphi(n.ddphi) {}
};

/// Rotation, angular velocity and acceleration of a node.
template <class T>
struct Motion {
  V3<T> e, d, s2, omega, alpha, w;   // s2 = (e + d)/(1 + e.d)
  V3<T> e2, e3;
  T cphi, sphi;
  explicit Motion(const NodeT<T>& n) : e(Vec3(n.chart->col(0))), d(e + n.t), e2(Vec3(n.chart->col(1))), e3(Vec3(n.chart->col(2))) {
    using std::cos;
    using std::sin;
    const T D = T(2.0) + e.dot(n.t);
    w = (T(1.0) / D) * e.cross(n.t);
    s2 = (T(1.0) / D) * (e + d);
    const T wd = w.dot(n.dd), ed = e.dot(n.dd);
    const T s = n.dphi - wd, sdot = n.ddphi - w.dot(n.ddd) + wd * ed / D;
    omega = d.cross(n.dd) + s * d;
    alpha = d.cross(n.ddd) + sdot * d + s * n.dd;
    cphi = cos(n.phi), sphi = sin(n.phi);
  }
  /// A vector fixed in the node, given by its components in the node's chart at rest.
  V3<T> turn(const Vec3& c) const {
    const V3<T> m = (T(c.y()) * cphi - T(c.z()) * sphi) * e2 + (T(c.y()) * sphi + T(c.z()) * cphi) * e3;
    return T(c.x()) * d + m - d.dot(m) * s2;
  }
  V3<T> accel(const V3<T>& r) const { return alpha.cross(r) + omega.cross(omega.cross(r)); }
};

/// Deformation at a configuration and the rates that go with it.
template <class T>
struct Shape {
  V3<T> a, D[2], delta[2], q[2], p[2], y, z, ro[2];
  T l, stretch, n[2], G[2], G1[2], psi;
  AngleRatio ratio[2];
  Shape(const GeneralBeam& b, const NodeT<T>& n1, const NodeT<T>& n2, const Motion<T>& m1, const Motion<T>& m2) {
    using std::atan2;
    using std::sqrt;
    ro[0] = m1.turn(b.arm1), ro[1] = m2.turn(b.arm2);
    const V3<T> du = n2.u - n1.u + (ro[1] - V3<T>(b.offset2)) - (ro[0] - V3<T>(b.offset1));
    const V3<T> lambda = V3<T>(b.chord) + du;
    l = sqrt(lambda.dot(lambda));
    stretch = (2.0 * V3<T>(b.chord).dot(du) + du.dot(du)) / (l + T(b.l0));
    a = (T(1.0) / l) * lambda;
    D[0] = m1.turn(b.body1.col(0)), D[1] = m2.turn(b.body2.col(0));
    const V3<T> B[2] = {m1.turn(b.body1.col(1)), m2.turn(b.body2.col(1))};
    V3<T> Bt[2];
    for (int i = 0; i < 2; ++i) {
      delta[i] = D[i] - a;
      n[i] = 0.5 * delta[i].dot(delta[i]);
      ratio[i] = AngleRatio(value(n[i]));
      G[i] = chain(n[i], ratio[i].G, ratio[i].G1), G1[i] = chain(n[i], ratio[i].G1, ratio[i].G2);
      q[i] = delta[i] + n[i] * a;
      p[i] = G[i] * q[i];
      Bt[i] = B[i] - (a.dot(B[i]) / (T(2.0) - n[i])) * (a + D[i]);
    }
    const V3<T> sum = Bt[0] + Bt[1];
    y = (T(1.0) / sqrt(sum.dot(sum))) * sum;
    z = a.cross(y);
    psi = atan2(a.dot(Bt[0].cross(Bt[1])), Bt[0].dot(Bt[1])) + T(b.c.tau_c) * a.dot(p[0].cross(p[1]));
  }
  T bow(const GeneralBeamConstants& c) const {
    return 0.5 * (c.b11 * p[0].dot(p[0]) + 2.0 * c.b12 * p[0].dot(p[1]) + c.b22 * p[1].dot(p[1]));
  }
};

double bow0(const GeneralBeam& b) {
  return 0.5 * (b.c.b11 * b.p01.squaredNorm() + 2.0 * b.c.b12 * b.p01.dot(b.p02) + b.c.b22 * b.p02.squaredNorm());
}

/// The three terms of the header: energy, and forces on (p1.y, p2.y), (p1.z, p2.z) and psi.
template <class T>
struct Coupling {
  T V{}, my[2], mz[2], torque{};
  Coupling(const GeneralBeam& b, const T (&ky)[2], const T (&kz)[2], const T& psi) {
    const GeneralBeamConstants& c = b.c;
    const double L = c.length, a12 = 0.5 * (c.ky_def11 + c.ky_def22), b12 = 0.5 * (c.kz_def11 + c.kz_def22);
    const double EIa = 0.5 * L * (a12 - c.ky_def12), EIb = 0.5 * L * (b12 - c.kz_def12);
    const double fa = (a12 + c.ky_def12) / EIa, fb = (b12 + c.kz_def12) / EIb;
    const double g = c.GJ_l > 0.0 ? L * L / (24.0 * c.GJ_l) : 0.0, h = L / 12.0, il = 1.0 / L;
    const T Ey = il * (ky[1] - ky[0]), Ez = il * (kz[1] - kz[0]), Sy = fa * (ky[0] + ky[1]), Sz = fb * (kz[0] + kz[1]);
    const T My = Ey + T(il * (b.p02[0] - b.p01[0])), Mz = Ez + T(il * (b.p02[1] - b.p01[1]));
    const T Ky = Sy + T(fa * (b.p01[0] + b.p02[0])), Kz = Sz + T(fb * (b.p01[1] + b.p02[1]));
    const T t = psi - T(b.psi_r);
    const T cc = EIa * (Mz * Ey) - EIb * (My * Ez);
    const T slope = EIa * (Kz * Ey + Mz * Sy) - EIb * (Ky * Ez + My * Sz);
    const double ra = fa * L / 6.0, rb = fb * L / 6.0;   // 1/(1 + Phi): shear takes its part of a slope of the curvature
    const T s = EIa * (ra * (Mz * Mz) - My * Ey) + EIb * (rb * (My * My) - Mz * Ez);
    V = T(-g) * cc * cc + h * (t * slope + 0.5 * (t * t * s));
    torque = h * (slope + t * s);
    const T cy = EIa * Mz - EIb * Ez, cz = EIa * Ey - EIb * My, th = h * t, tth = 0.5 * (th * t);
    const T gy = T(-2.0 * g) * cc * cy + th * (EIa * Kz - EIb * Sz) + tth * (2.0 * EIb * rb * My - EIa * (Ey + My));
    const T gz = T(-2.0 * g) * cc * cz + th * (EIa * Sy - EIb * Ky) + tth * (2.0 * EIa * ra * Mz - EIb * (Ez + Mz));
    const T ly = fa * (th * cy), lz = fb * (th * cz);
    my[0] = ly - il * gy, my[1] = ly + il * gy, mz[0] = lz - il * gz, mz[1] = lz + il * gz;
  }
};

template <class T>
struct ForceOut {
  V3<T> f[2], m[2];   // on u, and moment on omega
  T dissipated{};
};

template <class T>
ForceOut<T> beam_force(const GeneralBeam& b, const NodeT<T>& n1, const NodeT<T>& n2, const Motion<T>& m1,
                       const Motion<T>& m2) {
  const GeneralBeamConstants& c = b.c;
  const Shape<T> s(b, n1, n2, m1, m2);
  const Motion<T>* mo[2] = {&m1, &m2};
  const NodeT<T>* no[2] = {&n1, &n2};
  ForceOut<T> out;

  const T N = T(b.preload) + c.EA_l * (s.stretch + c.length * (s.bow(c) - T(bow0(b)))), NL = c.length * N;
  T ky[2], kz[2];   // deformations along y and z
  for (int i = 0; i < 2; ++i) {
    const Vec2& p0 = i == 0 ? b.p01 : b.p02;
    ky[i] = s.p[i].dot(s.y) - T(p0[0]), kz[i] = s.p[i].dot(s.z) - T(p0[1]);
  }
  T my[2] = {c.ky_def11 * ky[0] + c.ky_def12 * ky[1], c.ky_def12 * ky[0] + c.ky_def22 * ky[1]};
  T mz[2] = {c.kz_def11 * kz[0] + c.kz_def12 * kz[1], c.kz_def12 * kz[0] + c.kz_def22 * kz[1]};
  const Coupling<T> inner(b, ky, kz, s.psi);
  for (int i = 0; i < 2; ++i) my[i] += inner.my[i], mz[i] += inner.mz[i];
  const T torque = c.GJ_l * (s.psi - T(b.psi0)) + inner.torque;
  T twist = torque;
  V3<T> ad[2];
  for (int i = 0; i < 2; ++i) ad[i] = (T(1.0) / (T(2.0) - s.n[i])) * s.a.cross(s.delta[i]);
  if (c.beta > 0.0 || c.beta_twist > 0.0) {
    // objective rates of the same measures
    const V3<T> rdot = n2.du + m2.omega.cross(s.ro[1]) - n1.du - m1.omega.cross(s.ro[0]);
    const T ldot = s.a.dot(rdot);
    const V3<T> adot = (T(1.0) / s.l) * (rdot - ldot * s.a);
    T sigma[2];
    V3<T> rate[2];
    for (int i = 0; i < 2; ++i) {
      const V3<T> Dd = mo[i]->omega.cross(s.D[i]);
      sigma[i] = (s.a + s.D[i]).dot(mo[i]->omega) / (T(2.0) - s.n[i]) + ad[i].dot(adot);
      const T ndot = s.delta[i].dot(Dd - adot);
      rate[i] = (s.G1[i] * ndot) * s.q[i] + s.G[i] * (Dd - s.a.dot(Dd) * s.a - (T(1.0) - s.n[i]) * adot);
    }
    const T mean = 0.5 * (sigma[0] + sigma[1]);
    T ry[2], rz[2];
    for (int i = 0; i < 2; ++i) {
      rate[i] = rate[i] - mean * s.a.cross(s.p[i]);
      ry[i] = rate[i].dot(s.y), rz[i] = rate[i].dot(s.z);
    }
    const T dy[2] = {c.beta * (c.ky_def11 * ry[0] + c.ky_def12 * ry[1]), c.beta * (c.ky_def12 * ry[0] + c.ky_def22 * ry[1])};
    const T dz[2] = {c.beta * (c.kz_def11 * rz[0] + c.kz_def12 * rz[1]), c.beta * (c.kz_def12 * rz[0] + c.kz_def22 * rz[1])};
    const T psidot = sigma[1] - sigma[0], dt = (c.beta_twist * c.GJ_l) * psidot;
    twist += dt;
    out.dissipated = dt * psidot;
    for (int i = 0; i < 2; ++i) my[i] += dy[i], mz[i] += dz[i], out.dissipated += dy[i] * ry[i] + dz[i] * rz[i];
  }

  // power of the stresses -> forces on chord rate and spins (see shaft_damping.cpp for the same chain)
  V3<T> M[2];
  M[0] = my[0] * s.y + mz[0] * s.z + NL * (T(c.b11) * s.p[0] + T(c.b12) * s.p[1]);
  M[1] = my[1] * s.y + mz[1] * s.z + NL * (T(c.b12) * s.p[0] + T(c.b22) * s.p[1]);
  // twist rate = sigma2 - sigma1 + tau_c (p1 o . (p2 x a) + p2 o . (a x p1)); the last part turns nothing
  M[0] = M[0] + (T(c.tau_c) * torque) * s.p[1].cross(s.a);
  M[1] = M[1] + (T(c.tau_c) * torque) * s.a.cross(s.p[0]);
  const T S = -0.5 * (M[0].dot(s.a.cross(s.p[0])) + M[1].dot(s.a.cross(s.p[1])));
  const T spin[2] = {S - twist, S + twist};
  V3<T> fa = spin[0] * ad[0] + spin[1] * ad[1];
  for (int i = 0; i < 2; ++i) {
    const V3<T> k = (s.G1[i] * M[i].dot(s.q[i])) * s.delta[i];
    fa = fa - k - (s.G[i] * (T(1.0) - s.n[i])) * M[i];
    const V3<T> FD = k + s.G[i] * (M[i] - s.a.dot(M[i]) * s.a);
    out.m[i] = s.D[i].cross(FD) + (spin[i] / (T(2.0) - s.n[i])) * (s.a + s.D[i]);
  }
  const V3<T> fl = N * s.a + (T(1.0) / s.l) * (fa - s.a.dot(fa) * s.a);
  V3<T> fr[2] = {T(-1.0) * fl, fl};

  // inertia
  V3<T> acc[4], g[4];
  for (int i = 0; i < 2; ++i) acc[2 * i] = no[i]->ddu + mo[i]->accel(s.ro[i]), acc[2 * i + 1] = mo[i]->accel(s.D[i]);
  for (int k = 0; k < 4; ++k) {
    g[k] = T(c.M4(k, 0)) * acc[0];
    for (int j = 1; j < 4; ++j) g[k] = g[k] + T(c.M4(k, j)) * acc[j];
  }
  for (int axis = 1; axis <= 2; ++axis) {
    const double J = axis == 1 ? c.rhoIz_l : c.rhoIy_l;
    const V3<T> b1 = m1.turn(b.body1.col(axis)), b2 = m2.turn(b.body2.col(axis));
    const V3<T> a1 = m1.accel(b1), a2 = m2.accel(b2);
    out.m[0] = out.m[0] + b1.cross(T(J * 5.0 / 12.0) * a1 + T(J / 12.0) * a2);
    out.m[1] = out.m[1] + b2.cross(T(J / 12.0) * a1 + T(J * 5.0 / 12.0) * a2);
  }
  for (int i = 0; i < 2; ++i) {
    out.f[i] = fr[i] + g[2 * i];
    out.m[i] = out.m[i] + s.D[i].cross(g[2 * i + 1]) + s.ro[i].cross(out.f[i]);
  }
  return out;
}

/// Moment on omega -> (f_d, f_phi): delta theta = d x delta d + (delta phi - w . delta d) d.
template <class T>
std::array<T, 14> to_X(const ForceOut<T>& f, const Motion<T>& m1, const Motion<T>& m2) {
  std::array<T, 14> r;
  const Motion<T>* mo[2] = {&m1, &m2};
  for (int i = 0; i < 2; ++i) {
    const T along = f.m[i].dot(mo[i]->d);
    const V3<T> fd = f.m[i].cross(mo[i]->d) - along * mo[i]->w;
    T* out = r.data() + 7 * i;
    out[0] = f.f[i].x, out[1] = f.f[i].y, out[2] = f.f[i].z, out[3] = fd.x, out[4] = fd.y, out[5] = fd.z, out[6] = along;
  }
  return r;
}

using D14 = Dual<14>;

template <class Seed>
Matrix<14> differentiate(const GeneralBeam& b, const Nodes<2>& x, Seed&& seed) {
  NodeT<D14> n[2] = {NodeT<D14>(*x[0]), NodeT<D14>(*x[1])};
  for (int i = 0; i < 2; ++i) seed(n[i], *x[i], 7 * i);
  const Motion<D14> m1(n[0]), m2(n[1]);
  const auto f = to_X(beam_force(b, n[0], n[1], m1, m2), m1, m2);
  Matrix<14> J;
  for (int k = 0; k < 14; ++k) J.row(k) = f[static_cast<std::size_t>(k)].g.transpose();
  return J;
}

}  // namespace

GeneralBeam::GeneralBeam(const GeneralBeamConstants& constants, const Vec3& chord_, const Mat3& t1, const Mat3& t2, const Vec3& o1,
                         const Vec3& o2, const Mat3& chart1, const Mat3& chart2)
    : c(constants), chord(chord_), triad1(t1), triad2(t2), offset1(o1), offset2(o2), body1(chart1.transpose() * t1),
      body2(chart2.transpose() * t2), arm1(chart1.transpose() * o1), arm2(chart2.transpose() * o2), l0(chord_.norm()) {
  NodeState rest1, rest2;
  for (NodeState* r : {&rest1, &rest2}) r->u = r->du = r->ddu = r->t = r->dd = r->ddd = Vec3::Zero();
  rest1.chart = &chart1, rest2.chart = &chart2;
  const NodeT<double> n1(rest1), n2(rest2);
  const Motion<double> m1(n1), m2(n2);
  const Shape<double> s(*this, n1, n2, m1, m2);
  psi0 = s.psi;
  p01 = Vec2(s.p[0].dot(s.y), s.p[0].dot(s.z)), p02 = Vec2(s.p[1].dot(s.y), s.p[1].dot(s.z));
  if (p01.squaredNorm() + p02.squaredNorm() > 1e-20) psi_r = psi0;
}

void GeneralBeam::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const Motion<double> m1(n1), m2(n2);
  const auto r = to_X(beam_force(*this, n1, n2, m1, m2), m1, m2);
  f += Eigen::Map<const Vector<14>>(r.data());
}

void GeneralBeam::add_tangent(const Nodes<2>& x, const Context&, TangentX<14>& out) const {
  out.K += differentiate(*this, x, [](NodeT<D14>& n, const NodeState& s, int k) {
    n.u = V3<D14>::variable(s.u, k), n.t = V3<D14>::variable(s.t, k + 3), n.phi = D14::variable(s.phi, k + 6);
  });
  out.C += differentiate(*this, x, [](NodeT<D14>& n, const NodeState& s, int k) {
    n.du = V3<D14>::variable(s.du, k), n.dd = V3<D14>::variable(s.dd, k + 3), n.dphi = D14::variable(s.dphi, k + 6);
  });
  out.M += differentiate(*this, x, [](NodeT<D14>& n, const NodeState& s, int k) {
    n.ddu = V3<D14>::variable(s.ddu, k), n.ddd = V3<D14>::variable(s.ddd, k + 3), n.ddphi = D14::variable(s.ddphi, k + 6);
  });
}

void GeneralBeam::add_energy(const Nodes<2>& x, const Context& ctx, Energy& en) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const Motion<double> m1(n1), m2(n2);
  const Shape<double> s(*this, n1, n2, m1, m2);
  const double w = s.stretch + c.length * (s.bow(c) - bow0(*this));
  double V = (0.5 * c.EA_l * w + preload) * w + 0.5 * c.GJ_l * (s.psi - psi0) * (s.psi - psi0);
  const double y1 = s.p[0].dot(s.y) - p01[0], y2 = s.p[1].dot(s.y) - p02[0], z1 = s.p[0].dot(s.z) - p01[1], z2 = s.p[1].dot(s.z) - p02[1];
  V += 0.5 * (c.ky_def11 * y1 * y1 + 2 * c.ky_def12 * y1 * y2 + c.ky_def22 * y2 * y2);
  V += 0.5 * (c.kz_def11 * z1 * z1 + 2 * c.kz_def12 * z1 * z2 + c.kz_def22 * z2 * z2);
  const double ky[2] = {y1, y2}, kz[2] = {z1, z2};
  en.elastic += V + Coupling<double>(*this, ky, kz, s.psi).V;
  auto vec = [](const V3<double>& v) { return Vec3(v.x, v.y, v.z); };
  const Vec3 w1 = vec(m1.omega), w2 = vec(m2.omega);
  const Vec3 X[4] = {vec(s.ro[0]), vec(s.D[0]), vec(s.ro[1]), vec(s.D[1])};
  const Vec3 v[4] = {x[0]->du + w1.cross(X[0]), w1.cross(X[1]), x[1]->du + w2.cross(X[2]), w2.cross(X[3])};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) en.kinetic += 0.5 * c.M4(k, j) * v[k].dot(v[j]);
  for (int axis = 1; axis <= 2; ++axis) {
    const double J = axis == 1 ? c.rhoIz_l : c.rhoIy_l;
    const Vec3 b1 = w1.cross(vec(m1.turn(body1.col(axis)))), b2 = w2.cross(vec(m2.turn(body2.col(axis))));
    en.kinetic += 0.5 * J * (5.0 / 12.0 * (b1.squaredNorm() + b2.squaredNorm()) + b1.dot(b2) / 6.0);
  }
  // Relative to the reference configuration, so that a change of chart leaves it alone.
  const Vec3 P[4] = {x[0]->u + X[0] - offset1, X[1] - triad1.col(0), x[1]->u + X[2] - offset2, X[3] - triad2.col(0)};
  for (int j = 0; j < 4; ++j) en.gravity -= (c.M4(0, j) + c.M4(2, j)) * ctx.gravity.dot(P[j]);
  if (c.beta > 0.0 || c.beta_twist > 0.0) en.dissipated += beam_force(*this, n1, n2, m1, m2).dissipated;
}

}  // namespace whirl::elements
