#include <elements/supports/linear_bearing.hpp>
#include <core/contract.hpp>

namespace whirl::elements {

using namespace system;

Vec3 TranslationalBearing::force_on_first(const Nodes<2>& x) const {
  return preload - K * (x[0]->u - x[1]->u - setpoint) - C * (x[0]->du - x[1]->du) -
         M * (x[0]->ddu - x[1]->ddu);
}

void TranslationalBearing::add_force(const Nodes<2>& x, const Context&, ForceX<6>& f) const {
  const Vec3 F = force_on_first(x);
  f.head<3>() -= F;
  f.tail<3>() += F;
}

void TranslationalBearing::add_tangent(const Nodes<2>&, const Context&, TangentX<6>& t) const {
  const auto add = [](Matrix<6>& to, const Mat3& m) {
    to.topLeftCorner<3, 3>() += m;
    to.bottomRightCorner<3, 3>() += m;
    to.topRightCorner<3, 3>() -= m;
    to.bottomLeftCorner<3, 3>() -= m;
  };
  add(t.M, M);
  add(t.C, C);
  add(t.K, K);
}

void TranslationalBearing::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  add_linear_energy<3>(K, C, M, preload, x[0]->u - x[1]->u - setpoint, x[0]->du - x[1]->du,
                       x[0]->ddu - x[1]->ddu, e);
}

LinearBearing::LinearBearing(const Matrix<6>& K, const Matrix<6>& C, const Matrix<6>& M,
                             const Vector<6>& setpoint, const Vector<6>& preload, double s1,
                             double s2, const Mat3& axes)
    : K_(K),
      C_(C),
      M_(M),
      setpoint_(setpoint),
      preload_(preload),
      between_(s1, s2, axes) {
  WHIRL_EXPECTS(K.allFinite() && C.allFinite() && M.allFinite());
  WHIRL_EXPECTS((axes.transpose() * axes - Mat3::Identity()).norm() < 1e-9);
  const Matrix<6, 14> B = between_.B();
  K14_ = B.transpose() * K_ * B;
  C14_ = B.transpose() * C_ * B;
  M14_ = B.transpose() * M_ * B;
}

Vector<6> LinearBearing::load_on_first(const Nodes<2>& x) const {
  const SixMotion::Relative r = between_.relative(x, setpoint_);
  return preload_ - K_ * r.q - C_ * r.v - M_ * r.a;
}

void LinearBearing::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  between_.add_load(load_on_first(x), f);
}

void LinearBearing::add_tangent(const Nodes<2>&, const Context&, TangentX<14>& t) const {
  t.M += M14_;
  t.C += C14_;
  t.K += K14_;
}

void LinearBearing::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  const SixMotion::Relative r = between_.relative(x, setpoint_);
  add_linear_energy<6>(K_, C_, M_, preload_, r.q, r.v, r.a, e);
}

}  // namespace whirl::elements
