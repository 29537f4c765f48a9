#include <elements/supports/lateral_joint.hpp>

namespace whirl::elements {
namespace {

/// y = g dr/dx
template <bool Offsets>
void spread(const std::array<double, 2>& offset, const Matrix<4, 2>& g, Matrix<4, 14>& y) {
  y.setZero();
  y.middleCols<2>(1) = g;
  y.middleCols<2>(8) = -g;
  if constexpr (Offsets) {
    y.middleCols<2>(4) = offset[0] * g;
    y.middleCols<2>(11) = -offset[1] * g;
  }
}

/// out += -B^T y, B the map from X' to (v, s_0, s_1).
template <bool Offsets, class Y, class Out>
void scatter(const std::array<double, 2>& offset, const std::array<system::Spin, 2>& s, const Y& y,
             Out& out) {
  out.template middleRows<2>(1) -= y.template topRows<2>();
  out.template middleRows<2>(8) += y.template topRows<2>();
  out.row(6) -= y.row(2);
  out.row(13) -= y.row(3);
  out.template middleRows<3>(3).noalias() += s[0].w * y.row(2);
  out.template middleRows<3>(10).noalias() += s[1].w * y.row(3);
  if constexpr (Offsets) {
    out.template middleRows<2>(4) -= offset[0] * y.template topRows<2>();
    out.template middleRows<2>(11) += offset[1] * y.template topRows<2>();
  }
}

}  // namespace

template <bool Offsets>
LateralMotion LateralLink<Offsets>::motion(const Nodes& x, const system::Context& c, const Spins& s,
                                           bool accelerations) const {
  const system::NodeState &n = *x[0], &h = *x[1];
  LateralMotion m;
  m.frequency = c.frequency;
  m.kept = n.kept;
  m.spin = s[0].s;
  m.housing_spin = s[1].s;
  m.r = (n.u - h.u).template tail<2>();
  m.v = (n.du - h.du).template tail<2>();
  if (accelerations) m.a = (n.ddu - h.ddu).template tail<2>();
  if constexpr (Offsets) {
    m.r += (offset[0] * n.t - offset[1] * h.t).template tail<2>();
    m.v += (offset[0] * n.dd - offset[1] * h.dd).template tail<2>();
    if (accelerations) m.a += (offset[0] * n.ddd - offset[1] * h.ddd).template tail<2>();
  }
  return m;
}

template <bool Offsets>
void LateralLink<Offsets>::add_force(const Spins& s, const Vector<4>& z,
                                     system::ForceX<14>& f) const {
  scatter<Offsets>(offset, s, z, f);
}

template <bool Offsets>
void LateralLink<Offsets>::add_tangent(const Spins& s, const Vector<4>& z, const LateralTangent& t,
                                       bool inertia, system::TangentX<14>& k) const {
  Matrix<4, 14> y;
  spread<Offsets>(offset, t.v, y);
  y.template middleCols<3>(3).noalias() -= t.spin * s[0].w.transpose();
  y.col(6) += t.spin;
  y.template middleCols<3>(10).noalias() -= t.housing_spin * s[1].w.transpose();
  y.col(13) += t.housing_spin;
  scatter<Offsets>(offset, s, y, k.C);
  spread<Offsets>(offset, t.r, y);
  y.template middleCols<3>(3).noalias() += t.spin * s[0].s_d.transpose();
  y.template middleCols<3>(10).noalias() += t.housing_spin * s[1].s_d.transpose();
  scatter<Offsets>(offset, s, y, k.K);
  k.K.template block<3, 3>(3, 3) += z[2] * s[0].W();
  k.K.template block<3, 3>(10, 10) += z[3] * s[1].W();
  if (!inertia) return;
  spread<Offsets>(offset, t.a, y);
  scatter<Offsets>(offset, s, y, k.M);
}

template struct LateralLink<false>;
template struct LateralLink<true>;

}  // namespace whirl::elements
