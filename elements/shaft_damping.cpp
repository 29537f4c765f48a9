#include <elements/shaft_damping.hpp>

#include <core/dual.hpp>
#include <elements/shaft_strain.hpp>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::TangentX;

namespace {

/// Rates the damping acts on: lambda' = r2' - r1', directors, axial angles.
struct Rates {
  Vec3 lambda = Vec3::Zero(), d1 = Vec3::Zero(), d2 = Vec3::Zero();
  double phi1 = 0, phi2 = 0;
};

/// Force in (lambda, d1, d2, phi1, phi2), linear in the rates.
template <class T>
struct Force {
  Vec3T<T> lambda, d1, d2;
  T phi1{}, phi2{}, power{};
};

/// What of the kinematics one end contributes.
template <class T>
struct End {
  Vec3T<T> delta, q, w, ad;   // d - a; d - (a.d) a; spin form; (a x d)/(1 + a.d)
  T n, G, G1;
  End(const Vec3T<T>& e, const Vec3T<T>& t, const Vec3T<T>& a, const Vec3T<T>& shift) : delta(t + shift) {
    n = 0.5 * delta.dot(delta);
    const AngleRatio r(value(n));
    G = chain(n, r.G, r.G1), G1 = chain(n, r.G1, r.G2);
    q = delta + n * a;
    w = (T(1.0) / (T(2.0) + e.dot(t))) * e.cross(t);
    ad = (T(1.0) / (T(2.0) - n)) * a.cross(delta);
  }
};

template <bool Rotating, class T>
Force<T> damping_force(const ShaftDamping<Rotating>& p, const Vec3& axis, const Vec3T<T>& du, const Vec3T<T>& t1,
                       const Vec3T<T>& t2, const Rates& v) {
  const Vec3T<T> e0(p.e0), e(axis), zero(axis - p.e0);
  const T L(p.length);
  const Vec3T<T> lambda = L * e0 + du;
  using std::sqrt;
  const T l = sqrt(lambda.dot(lambda));
  const T stretch = (2.0 * L * e0.dot(du) + du.dot(du)) / (l + L);
  const Vec3T<T> alpha = (T(1.0) / l) * (du - stretch * e0), a = e0 + alpha, shift = zero - alpha;
  const End<T> e1(e, t1, a, shift), e2(e, t2, a, shift);
  const Vec3T<T> vl(v.lambda), v1(v.d1), v2(v.d2);
  const T ldot = a.dot(vl);
  const Vec3T<T> adot = (T(1.0) / l) * (vl - ldot * a);

  auto strain_rate = [&](const End<T>& x, const Vec3T<T>& dd) {   // p' perpendicular to a
    const T ndot = x.delta.dot(dd - adot);
    return (x.G1 * ndot) * x.q + x.G * (dd - a.dot(dd) * a - (T(1.0) - x.n) * adot);
  };
  auto spin = [&](const End<T>& x, const Vec3T<T>& dd, double phi) { return T(phi) + (x.ad - x.w).dot(dd) + x.ad.dot(adot); };
  const T s1 = spin(e1, v1, v.phi1), s2 = spin(e2, v2, v.phi2);
  Vec3T<T> r1 = strain_rate(e1, v1), r2 = strain_rate(e2, v2);
  if constexpr (Rotating) {
    const T sigma = 0.5 * (s1 + s2);
    r1 = r1 - sigma * a.cross(e1.G * e1.q), r2 = r2 - sigma * a.cross(e2.G * e2.q);
  }
  const Vec3T<T> m1 = T(p.d11) * r1 + T(p.d12) * r2, m2 = T(p.d12) * r1 + T(p.d22) * r2;
  const T torque = p.d_twist * (s2 - s1);
  T b1 = -torque, b2 = torque;   // conjugate to sigma_1, sigma_2
  if constexpr (Rotating) {
    const T S = -0.5 * (m1.dot(a.cross(e1.G * e1.q)) + m2.dot(a.cross(e2.G * e2.q)));
    b1 += S, b2 += S;
  }
  Force<T> f;
  const Vec3T<T> k1 = (e1.G1 * m1.dot(e1.q)) * e1.delta, k2 = (e2.G1 * m2.dot(e2.q)) * e2.delta;
  auto perpendicular = [&](const Vec3T<T>& x) { return x - a.dot(x) * a; };
  f.d1 = k1 + e1.G * perpendicular(m1) + b1 * (e1.ad - e1.w);
  f.d2 = k2 + e2.G * perpendicular(m2) + b2 * (e2.ad - e2.w);
  const Vec3T<T> fa = b1 * e1.ad + b2 * e2.ad - k1 - k2 - (e1.G * (T(1.0) - e1.n)) * m1 - (e2.G * (T(1.0) - e2.n)) * m2;
  f.lambda = (T(1.0) / l) * perpendicular(fa) + (p.d_axial * ldot) * a;
  f.phi1 = b1, f.phi2 = b2;
  f.power = m1.dot(r1) + m2.dot(r2) + torque * (s2 - s1) + p.d_axial * ldot * ldot;
  return f;
}

/// (lambda, d1, d2, phi1, phi2) forces into the element's 14 entries.
template <class Out>
void scatter(double o1, double o2, const Vec3& fl, const Vec3& f1, const Vec3& f2, double p1, double p2, Out&& out) {
  out.template segment<3>(0) -= fl;
  out.template segment<3>(7) += fl;
  out.template segment<3>(3) += f1 - o1 * fl;
  out.template segment<3>(10) += f2 + o2 * fl;
  out[6] += p1, out[13] += p2;
}

Vec3 values(const Vec3T<double>& v) { return {v.x, v.y, v.z}; }

template <bool Rotating>
Rates rates_of(const ShaftDamping<Rotating>& p, const Nodes<2>& x) {
  return {x[1]->du - x[0]->du + p.o2 * x[1]->dd - p.o1 * x[0]->dd, x[0]->dd, x[1]->dd, x[0]->dphi, x[1]->dphi};
}

template <bool Rotating>
Vec3 du_of(const ShaftDamping<Rotating>& p, const Nodes<2>& x) {
  return x[1]->u - x[0]->u + p.o2 * x[1]->t - p.o1 * x[0]->t;
}

}  // namespace

template <bool Rotating>
ShaftDamping<Rotating>::ShaftDamping(const ShaftElementConstants& c, const Vec3& direction, double bb, double bt, double ba)
    : length(c.length), o1(c.o1), o2(c.o2), e0(direction), d11(bb * c.k11), d12(bb * c.k12), d22(bb * c.k22),
      d_twist(bt * c.GJ_l), d_axial(ba * c.EA_l) {}

template <bool Rotating>
void ShaftDamping<Rotating>::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  using V = Vec3T<double>;
  const auto r = damping_force<Rotating, double>(*this, x[0]->e(), V(du_of(*this, x)), V(x[0]->t), V(x[1]->t), rates_of(*this, x));
  scatter(o1, o2, values(r.lambda), values(r.d1), values(r.d2), r.phi1, r.phi2, f);
}

template <bool Rotating>
void ShaftDamping<Rotating>::add_tangent(const Nodes<2>& x, const Context&, TangentX<14>& out) const {
  using V = Vec3T<double>;
  const Vec3 e = x[0]->e(), du = du_of(*this, x);
  // C: the force is linear in the rates, one column per rate of (lambda, d1, d2, phi1, phi2)
  const V vdu(du), vt1(x[0]->t), vt2(x[1]->t);
  Eigen::Matrix<double, 14, 11> columns = Eigen::Matrix<double, 14, 11>::Zero();
  for (int k = 0; k < 11; ++k) {
    Rates v;
    if (k < 3) v.lambda[k] = 1.0;
    else if (k < 6) v.d1[k - 3] = 1.0;
    else if (k < 9) v.d2[k - 6] = 1.0;
    else (k == 9 ? v.phi1 : v.phi2) = 1.0;
    const auto r = damping_force<Rotating, double>(*this, e, vdu, vt1, vt2, v);
    scatter(o1, o2, values(r.lambda), values(r.d1), values(r.d2), r.phi1, r.phi2, columns.col(k));
  }
  auto& C = out.C;
  C.template middleCols<3>(0) -= columns.leftCols<3>();
  C.template middleCols<3>(7) += columns.leftCols<3>();
  C.template middleCols<3>(3) += columns.middleCols<3>(3) - o1 * columns.leftCols<3>();
  C.template middleCols<3>(10) += columns.middleCols<3>(6) + o2 * columns.leftCols<3>();
  C.col(6) += columns.col(9), C.col(13) += columns.col(10);

  // K: nine directions at once (lambda, d1, d2)
  using D = Dual<9>;
  using W = Vec3T<D>;
  const auto r = damping_force<Rotating, D>(*this, e, W::variable(du, 0), W::variable(x[0]->t, 3), W::variable(x[1]->t, 6), rates_of(*this, x));
  Eigen::Matrix<double, 14, 9> g = Eigen::Matrix<double, 14, 9>::Zero();
  for (int k = 0; k < 9; ++k) {
    auto slope = [k](const W& v) { return Vec3(v.x.g[k], v.y.g[k], v.z.g[k]); };
    scatter(o1, o2, slope(r.lambda), slope(r.d1), slope(r.d2), r.phi1.g[k], r.phi2.g[k], g.col(k));
  }
  auto& K = out.K;
  K.template middleCols<3>(0) -= g.leftCols<3>();
  K.template middleCols<3>(7) += g.leftCols<3>();
  K.template middleCols<3>(3) += g.middleCols<3>(3) - o1 * g.leftCols<3>();
  K.template middleCols<3>(10) += g.middleCols<3>(6) + o2 * g.leftCols<3>();
}

template <bool Rotating>
void ShaftDamping<Rotating>::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  using V = Vec3T<double>;
  e.dissipated += damping_force<Rotating, double>(*this, x[0]->e(), V(du_of(*this, x)), V(x[0]->t), V(x[1]->t), rates_of(*this, x)).power;
}

template struct ShaftDamping<false>;
template struct ShaftDamping<true>;

namespace {
constexpr int pos[4] = {0, 3, 7, 10};
}

void ShaftMassDamping::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const Vec3* vel[4] = {&x[0]->du, &x[0]->dd, &x[1]->du, &x[1]->dd};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) f.segment<3>(pos[k]) += C4(k, j) * *vel[j];
}

void ShaftMassDamping::add_tangent(const Nodes<2>&, const Context&, TangentX<14>& t) const {
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) t.C.block<3, 3>(pos[k], pos[j]).diagonal().array() += C4(k, j);
}

void ShaftMassDamping::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  const Vec3* vel[4] = {&x[0]->du, &x[0]->dd, &x[1]->du, &x[1]->dd};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j) e.dissipated += C4(k, j) * vel[k]->dot(*vel[j]);
}

}  // namespace whirl::elements
