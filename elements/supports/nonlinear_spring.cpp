#include <elements/supports/nonlinear_spring.hpp>
#include <core/contract.hpp>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::TangentX;

template <int W>
ScalarSpring<W> ScalarSpring<W>::translation(const Vec3& n, ForceCurvePtr F, ForceCurvePtr D,
                                             double s0, double s1) {
  WHIRL_EXPECTS(F && D);
  WHIRL_EXPECTS(std::abs(n.norm() - 1.0) < 1e-9);
  ScalarSpring k;
  k.b0.setZero();
  k.b1.setZero();
  k.b0.template head<3>() = n;
  k.b1.template head<3>() = n;
  if constexpr (W == 7) {
    k.b0.template segment<3>(3) = s0 * n;
    k.b1.template segment<3>(3) = s1 * n;
  }
  k.force = std::move(F);
  k.damping = std::move(D);
  return k;
}

template <int W>
ScalarSpring<W> ScalarSpring<W>::tilt(const Vec3& n, const Vec3& e, ForceCurvePtr F,
                                      ForceCurvePtr D) requires(W == 7) {
  WHIRL_EXPECTS(F && D);
  WHIRL_EXPECTS(std::abs(n.norm() - 1.0) < 1e-9 && std::abs(e.norm() - 1.0) < 1e-9);
  ScalarSpring k;
  k.b0.setZero();
  k.b0.template segment<3>(3) = n.cross(e);
  k.b1 = k.b0;
  k.force = std::move(F);
  k.damping = std::move(D);
  return k;
}

template <int W>
ScalarSpring<W> ScalarSpring<W>::twist(ForceCurvePtr F, ForceCurvePtr D) requires(W == 7) {
  WHIRL_EXPECTS(F && D);
  ScalarSpring k;
  k.b0.setZero();
  k.b0[6] = 1.0;
  k.b1 = k.b0;
  k.force = std::move(F);
  k.damping = std::move(D);
  return k;
}

template <int W>
typename ScalarSpring<W>::Deflection ScalarSpring<W>::deflection(const Nodes<2>& x) const {
  Deflection d{0.0, 0.0};
  for (int i = 0; i < 2; ++i) {
    const auto& n = *x[static_cast<std::size_t>(i)];
    const Vector<W>& b = i == 0 ? b0 : b1;
    const double sign = i == 0 ? 1.0 : -1.0;
    d.q += sign * b.template head<3>().dot(n.u);
    d.dq += sign * b.template head<3>().dot(n.du);
    if constexpr (W == 7) {
      d.q += sign * (b.template segment<3>(3).dot(n.t) + b[6] * n.phi);
      d.dq += sign * (b.template segment<3>(3).dot(n.dd) + b[6] * n.dphi);
    }
  }
  if constexpr (W == 7) d.q += two_pi * (b0[6] * x[0]->turns - b1[6] * x[1]->turns);
  return d;
}

template <int W>
void ScalarSpring<W>::add_force(const Nodes<2>& x, const Context&, ForceX<2 * W>& f) const {
  const Deflection d = deflection(x);
  const double load = (*force)(d.q) + (*damping)(d.q) * d.dq;
  f.template head<W>() += load * b0;
  f.template tail<W>() -= load * b1;
}

template <int W>
void ScalarSpring<W>::add_tangent(const Nodes<2>& x, const Context&, TangentX<2 * W>& t) const {
  const Deflection d = deflection(x);
  const auto F = force->at(d.q), D = damping->at(d.q);
  Vector<2 * W> b;
  b << b0, -b1;
  t.K.noalias() += (F.slope + D.slope * d.dq) * b * b.transpose();
  t.C.noalias() += D.F * b * b.transpose();
}

template <int W>
void ScalarSpring<W>::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  const Deflection d = deflection(x);
  e.elastic += force->at(d.q).energy;
  e.dissipated += (*damping)(d.q) * d.dq * d.dq;
}

template struct ScalarSpring<3>;
template struct ScalarSpring<7>;

namespace {

struct Radial {
  Vec2 r, v;
  double rho;
  explicit Radial(const Nodes<2>& x)
      : r((x[0]->u - x[1]->u).tail<2>()),
        v((x[0]->du - x[1]->du).tail<2>()),
        rho(r.norm()) {}
};

}  // namespace

void RadialSpring::add_force(const Nodes<2>& x, const Context&, ForceX<6>& f) const {
  const Radial q(x);
  const auto F = force->at(q.rho);
  const Vec2 g = (q.rho > 0.0 ? F.F / q.rho : F.slope) * q.r + (*damping)(q.rho) * q.v;
  f.segment<2>(1) += g;
  f.segment<2>(4) -= g;
}

void RadialSpring::add_tangent(const Nodes<2>& x, const Context&, TangentX<6>& t) const {
  const Radial q(x);
  const auto F = force->at(q.rho), D = damping->at(q.rho);
  const double secant = q.rho > 0.0 ? F.F / q.rho : F.slope;
  const Vec2 n = q.rho > 0.0 ? Vec2(q.r / q.rho) : Vec2(Vec2::Zero());
  const Mat2 K = secant * Mat2::Identity() + (F.slope - secant) * n * n.transpose() +
                 D.slope * q.v * n.transpose();
  const auto add = [](const Mat2& m, Matrix<6>& out) {
    out.block<2, 2>(1, 1) += m;
    out.block<2, 2>(4, 4) += m;
    out.block<2, 2>(1, 4) -= m;
    out.block<2, 2>(4, 1) -= m;
  };
  add(K, t.K);
  add(D.F * Mat2::Identity(), t.C);
}

void RadialSpring::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  const Radial q(x);
  e.elastic += force->at(q.rho).energy;
  e.dissipated += (*damping)(q.rho) * q.v.squaredNorm();
}

}  // namespace whirl::elements
