#include <elements/supports/rub.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::elements {

namespace {

struct Touch {
  Vec2 n, t;
  double rho, delta, drho, slip;
  Touch(const RubLaw& k, const LateralMotion& m) {
    rho = m.r.norm();
    delta = rho - k.gap;
    n = rho > 0.0 ? Vec2(m.r / rho)
                  : Vec2(Vec2::UnitX());  // gap = 0 at the very centre: no force, any direction
    t = Vec2(-n.y(), n.x());
    drho = m.v.dot(n);
    slip = m.v.dot(t) + k.radius * m.spin - (k.radius + rho) * m.housing_spin;
  }
};

}  // namespace

void RubLaw::force(const LateralMotion& m, Vector<4>& z) const {
  z.setZero();
  const Touch c(*this, m);
  const double rate = 1.0 + damping * c.drho;
  if (c.delta <= 0.0 || rate <= 0.0) return;
  const double N = stiffness * c.delta * rate, Ft = -friction * N * std::tanh(c.slip / slip_speed);
  z << -N * c.n + Ft * c.t, radius * Ft, -(radius + c.rho) * Ft;
}

void RubLaw::tangent(const LateralMotion& m, Vector<4>& z, LateralTangent& t) const {
  z.setZero();
  t.set_zero();
  const Touch c(*this, m);
  const double rate = 1.0 + damping * c.drho;
  if (c.delta <= 0.0 || rate <= 0.0) return;
  const double N = stiffness * c.delta * rate, th = std::tanh(c.slip / slip_speed),
               Ft = -friction * N * th;
  z << -N * c.n + Ft * c.t, radius * Ft, -(radius + c.rho) * Ft;
  // Gradients in r: of rho, n; of n, t t^T/rho; of t, -n t^T/rho; of drho, (v.t) t/rho; of v.t,
  // -(v.n) t/rho.
  using Row = Eigen::RowVector2d;
  const double vt = m.v.dot(c.t), inv = c.rho > 0.0 ? 1.0 / c.rho : 0.0;
  const Row n = c.n.transpose(), tt = c.t.transpose();
  const Row N_r = stiffness * (rate * n + c.delta * damping * vt * inv * tt),
            N_v = stiffness * c.delta * damping * n;
  const double dth = (1.0 - th * th) / slip_speed, Ft_slip = -friction * N * dth;
  const Row slip_r = -c.drho * inv * tt - m.housing_spin * n;
  const Row Ft_r = -friction * th * N_r + Ft_slip * slip_r,
            Ft_v = -friction * th * N_v + Ft_slip * tt;
  t.r.topRows<2>() = -c.n * N_r - N * inv * c.t * tt + c.t * Ft_r - Ft * inv * c.n * tt;
  t.r.row(2) = radius * Ft_r;
  t.r.row(3) = -(radius + c.rho) * Ft_r - Ft * n;
  t.v.topRows<2>() = -c.n * N_v + c.t * Ft_v;
  t.v.row(2) = radius * Ft_v;
  t.v.row(3) = -(radius + c.rho) * Ft_v;
  Vector<4> dir;
  dir << c.t, radius, -(radius + c.rho);
  t.spin = Ft_slip * radius * dir;
  t.housing_spin = -Ft_slip * (radius + c.rho) * dir;
}

void RubLaw::energy(const LateralMotion& m, system::Energy& e) const {
  const Touch c(*this, m);
  if (c.delta <= 0.0) return;
  e.elastic += 0.5 * stiffness * c.delta * c.delta;
  const double rate = std::max(0.0, 1.0 + damping * c.drho), N = stiffness * c.delta * rate;
  e.dissipated += stiffness * c.delta * (rate - 1.0) * c.drho +
                  friction * N * c.slip * std::tanh(c.slip / slip_speed);
}

}  // namespace whirl::elements
