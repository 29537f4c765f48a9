#include <elements/linear_bearing.hpp>

namespace whirl::elements {

using namespace system;

Vec3 TranslationalBearing::force_on_first(const Nodes<2>& x) const {
  return preload - K * (x[0]->u - x[1]->u - setpoint) - C * (x[0]->du - x[1]->du) - M * (x[0]->ddu - x[1]->ddu);
}

void TranslationalBearing::add_force(const Nodes<2>& x, const Context&, ForceX<6>& f) const {
  const Vec3 F = force_on_first(x);
  f.head<3>() -= F;
  f.tail<3>() += F;
}

void TranslationalBearing::add_tangent(const Nodes<2>&, const Context&, TangentX<6>& t) const {
  const auto add = [](Matrix<6>& to, const Mat3& m) {
    to.topLeftCorner<3, 3>() += m, to.bottomRightCorner<3, 3>() += m;
    to.topRightCorner<3, 3>() -= m, to.bottomLeftCorner<3, 3>() -= m;
  };
  add(t.M, M), add(t.C, C), add(t.K, K);
}

namespace {

/// Energies of a linear spring, damper and mass in relative coordinates; skew parts of K and M as supplied power.
template <int N>
void add_linear_energy(const Matrix<N>& K, const Matrix<N>& C, const Matrix<N>& M, const Vector<N>& preload,
                       const Vector<N>& q, const Vector<N>& v, const Vector<N>& a, Energy& e) {
  const Vector<N> Kq = K * q, Ma = M * a;
  e.elastic += 0.5 * q.dot(Kq);
  e.kinetic += 0.5 * v.dot(M * v);
  e.dissipated += v.dot(C * v);
  e.supplied += preload.dot(v) + 0.5 * (v.dot(K.transpose() * q - Kq) + v.dot(M.transpose() * a - Ma));
}

}  // namespace

void TranslationalBearing::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  add_linear_energy<3>(K, C, M, preload, x[0]->u - x[1]->u - setpoint, x[0]->du - x[1]->du, x[0]->ddu - x[1]->ddu, e);
}

LinearBearing::S LinearBearing::map(double s) const {
  // rows along the axes; e0 x d has the components -d.e3 along e2 and d.e2 along e3
  S m = S::Zero();
  m.topLeftCorner<3, 3>() = axes_.transpose();
  m.block<3, 3>(0, 3) = s * axes_.transpose();
  m(3, 6) = 1.0;
  m.block<1, 3>(4, 3) = -axes_.col(2).transpose();
  m.block<1, 3>(5, 3) = axes_.col(1).transpose();
  return m;
}

LinearBearing::LinearBearing(const Matrix<6>& K, const Matrix<6>& C, const Matrix<6>& M, const Vector<6>& setpoint,
                             const Vector<6>& preload, double s1, double s2, const Mat3& axes)
    : K_(K), C_(C), M_(M), setpoint_(setpoint), preload_(preload), axes_(axes), S1_(map(s1)), S2_(map(s2)) {
  Matrix<6, 14> B;
  B << S1_, -S2_;
  K14_ = B.transpose() * K_ * B;
  C14_ = B.transpose() * C_ * B;
  M14_ = B.transpose() * M_ * B;
}

LinearBearing::Relative LinearBearing::relative(const Nodes<2>& x) const {
  const auto gather = [](const Vec3& u, const Vec3& d, double phi) {
    Vector<7> X;
    X << u, d, phi;
    return X;
  };
  const NodeState &a = *x[0], &b = *x[1];
  const Vec3 e0 = axes_.col(0);
  // d - e0, exact for small tilt in a chart that has not been moved; whole turns count
  Relative r;
  r.q = S1_ * gather(a.u, a.t + (a.e() - e0), a.phi) - S2_ * gather(b.u, b.t + (b.e() - e0), b.phi) - setpoint_;
  r.q[3] += two_pi * (a.turns - b.turns);
  r.v = S1_ * gather(a.du, a.dd, a.dphi) - S2_ * gather(b.du, b.dd, b.dphi);
  r.a = S1_ * gather(a.ddu, a.ddd, a.ddphi) - S2_ * gather(b.ddu, b.ddd, b.ddphi);
  return r;
}

Vector<6> LinearBearing::load_on_first(const Nodes<2>& x) const {
  const Relative r = relative(x);
  return preload_ - K_ * r.q - C_ * r.v - M_ * r.a;
}

void LinearBearing::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const Vector<6> F = load_on_first(x);
  f.head<7>().noalias() -= S1_.transpose() * F;
  f.tail<7>().noalias() += S2_.transpose() * F;
}

void LinearBearing::add_tangent(const Nodes<2>&, const Context&, TangentX<14>& t) const {
  t.M += M14_;
  t.C += C14_;
  t.K += K14_;
}

void LinearBearing::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  const Relative r = relative(x);
  add_linear_energy<6>(K_, C_, M_, preload_, r.q, r.v, r.a, e);
}

}  // namespace whirl::elements
