#include <elements/between_shafts/shaft_coupling.hpp>

#include <core/dual.hpp>

#include <array>
#include <cmath>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::TangentX;

namespace {

// y = (x, y, z, tau_y, tau_z, theta, psi) and its rate: linear in the nodes with these signs.
constexpr int coordinate[7] = {0, 1, 2, 4, 5, 6, 6};
constexpr double sign[2][7] = {{1, 1, 1, 1, 1, 1, 0.5}, {-1, -1, -1, -1, -1, -1, 0.5}};

template <class T>
struct Relative {
  std::array<T, 7> y, v;
};

Relative<double> relative(const ShaftCoupling& k, const Nodes<2>& x) {
  Relative<double> r;
  const auto &a = *x[0], &b = *x[1];
  const Vec3 u = a.u - b.u + k.offset, du = a.du - b.du;
  const Vec2 t = (a.d() - b.d()).tail<2>() + k.angle, dt = (a.dd - b.dd).tail<2>();
  const double whole = 0.5 * (a.turns + b.turns);
  r.y = {u.x(),
         u.y(),
         u.z(),
         t.x(),
         t.y(),
         a.phi - b.phi + two_pi * (a.turns - b.turns),
         0.5 * (a.phi + b.phi) + two_pi * (whole - std::floor(whole))};
  r.v = {du.x(), du.y(), du.z(), dt.x(), dt.y(), a.dphi - b.dphi, 0.5 * (a.dphi + b.dphi)};
  return r;
}

/// p, p' and the generalized force on y.
template <class T>
struct Motion {
  std::array<T, 6> p, rate;
  std::array<T, 7> force;
  Motion(const ShaftCoupling& k, const Relative<T>& r) {
    using std::cos, std::sin;
    const T c = cos(r.y[6]), s = sin(r.y[6]);
    const T ry = T(0.0) - r.y[4], vry = T(0.0) - r.v[4];  // tilts about y and z: -tau_z, tau_y
    p = {r.y[0], c * r.y[1] + s * r.y[2], c * r.y[2] - s * r.y[1],
         r.y[5], c * ry + s * r.y[3],     c * r.y[3] - s * ry};
    rate = {
        r.v[0], c * r.v[1] + s * r.v[2] + r.v[6] * p[2], c * r.v[2] - s * r.v[1] - r.v[6] * p[1],
        r.v[5], c * vry + s * r.v[3] + r.v[6] * p[5],    c * r.v[3] - s * vry - r.v[6] * p[4]};
    std::array<T, 6> load;
    for (int i = 0; i < 6; ++i) {
      T q = 0.0;
      for (int j = 0; j < 6; ++j)
        q += k.K(i, j) * p[static_cast<std::size_t>(j)] +
             k.C(i, j) * rate[static_cast<std::size_t>(j)];
      load[static_cast<std::size_t>(i)] = q;
    }
    force = {load[0],
             c * load[1] - s * load[2],
             s * load[1] + c * load[2],
             s * load[4] + c * load[5],
             s * load[5] - c * load[4],
             load[3],
             load[1] * p[2] - load[2] * p[1] + load[4] * p[5] - load[5] * p[4]};
  }
};

}  // namespace

namespace {

/// m is the same in all axes turned about x.
bool same_all_round(const Matrix<6>& m) {
  Matrix<6> turn = Matrix<6>::Zero();
  turn(1, 2) = turn(4, 5) = 1.0;
  turn(2, 1) = turn(5, 4) = -1.0;
  const Matrix<6> change = m * turn - turn * m;
  const Matrix<6> size = m.cwiseAbs() * turn.cwiseAbs() + turn.cwiseAbs() * m.cwiseAbs();
  return (change.cwiseAbs().array() <= 1e-12 * size.array()).all();
}

}  // namespace

system::Dependence ShaftCoupling::depends(const Context&) const {
  const bool round = same_all_round(K) && same_all_round(C);
  return {.angle = round ? system::twist_angle : system::each_angle, .spin = !C.isZero(0.0)};
}

void ShaftCoupling::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const Motion<double> m(*this, relative(*this, x));
  for (int a = 0; a < 2; ++a)
    for (std::size_t i = 0; i < 7; ++i)
      f[7 * a + coordinate[i]] += sign[a][i] * m.force[i];
}

void ShaftCoupling::add_tangent(const Nodes<2>& x, const Context&, TangentX<14>& t) const {
  using D = Dual<14>;
  const Relative<double> r = relative(*this, x);
  Relative<D> d;
  for (int i = 0; i < 7; ++i) {
    const auto k = static_cast<std::size_t>(i);
    d.y[k] = D::variable(r.y[k], i);
    d.v[k] = D::variable(r.v[k], 7 + i);
  }
  const Motion<D> m(*this, d);
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 7; ++j) {
          const double s = sign[a][i] * sign[b][j];
          t.K(7 * a + coordinate[i], 7 * b + coordinate[j]) +=
              s * m.force[static_cast<std::size_t>(i)].g[j];
          t.C(7 * a + coordinate[i], 7 * b + coordinate[j]) +=
              s * m.force[static_cast<std::size_t>(i)].g[7 + j];
        }
}

void ShaftCoupling::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  const Motion<double> m(*this, relative(*this, x));
  const Eigen::Map<const Vector<6>> p(m.p.data()), rate(m.rate.data());
  e.elastic += 0.5 * p.dot(K * p);
  e.dissipated += rate.dot(C * rate);
}

}  // namespace whirl::elements
