#include <elements/shaft/shaft_damping.hpp>

#include <core/dual_rate.hpp>
#include <elements/shaft/shaft_lanes.hpp>
#include <math.h>
#include <cstddef>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::NodeState;
using system::TangentX;

namespace {

#include <elements/shaft/shaft_single.inl>
#define WHIRL_INLINE inline
#include <elements/shaft/shaft_damping.inl>
#undef WHIRL_INLINE

/// Rates as plain vectors.
struct Rates {
  Vec3 lambda = Vec3::Zero(), d1 = Vec3::Zero(), d2 = Vec3::Zero();
  double phi1 = 0, phi2 = 0;
};

/// One damper at a configuration, in any scalar.
template <bool Rotating, class T>
class Damper {
 public:
  using V = Vec3T<T>;
  Damper(const ShaftDamping<Rotating>& p, const Vec3& e, const V& du, const V& t1, const V& t2)
      : p_{V(p.e0), p.length, p.d11, p.d12, p.d22, p.d_twist, p.d_axial},
        x_(damping_kinematics(p_, V(e), du, t1, t2)) {}
  DampingForce<NumbersOf<T>> force(const Rates& v) const {
    return damping_force<Rotating>(
        p_, x_, DampingRates<NumbersOf<T>>{V(v.lambda), V(v.d1), V(v.d2), v.phi1, v.phi2});
  }

 private:
  DampingParameters<NumbersOf<T>> p_;
  DampingKinematics<NumbersOf<T>> x_;
};

/// (lambda, d1, d2, phi1, phi2) forces into the element's 14 entries.
template <class Out>
void scatter(double o1, double o2, const Vec3& fl, const Vec3& f1, const Vec3& f2, double p1,
             double p2, Out&& out) {
  out.template segment<3>(0) -= fl;
  out.template segment<3>(7) += fl;
  out.template segment<3>(3) += f1 - o1 * fl;
  out.template segment<3>(10) += f2 + o2 * fl;
  out[6] += p1;
  out[13] += p2;
}

Vec3 values(const Vec3T<double>& v) { return {v.x, v.y, v.z}; }

template <bool Rotating>
Rates rates_of(const ShaftDamping<Rotating>& p, const Nodes<2>& x) {
  return {x[1]->du - x[0]->du + p.o2 * x[1]->dd - p.o1 * x[0]->dd, x[0]->dd, x[1]->dd, x[0]->dphi,
          x[1]->dphi};
}

template <bool Rotating>
Vec3 du_of(const ShaftDamping<Rotating>& p, const Nodes<2>& x) {
  return x[1]->u - x[0]->u + p.o2 * x[1]->t - p.o1 * x[0]->t;
}

}  // namespace

template <bool Rotating>
ShaftDamping<Rotating>::ShaftDamping(const ShaftElementConstants& c, const Vec3& direction,
                                     double bb, double bt, double ba)
    : length(c.length),
      o1(c.o1),
      o2(c.o2),
      e0(direction),
      d11(bb * c.k11),
      d12(bb * c.k12),
      d22(bb * c.k22),
      d_twist(bt * c.GJ_l),
      d_axial(ba * c.EA_l) {}

/// What the kernels of shaft_lanes.hpp take for granted.
template <bool Rotating>
constexpr bool damping_in_place() {
  using Damping = ShaftDamping<Rotating>;
  using Places = lanes::DampingPlaces;
  constexpr auto stands = [](std::size_t offset, int place) {
    return offset == static_cast<std::size_t>(place) * sizeof(double);
  };
  static_assert(stands(offsetof(Damping, length), Places::length));
  static_assert(stands(offsetof(Damping, o1), Places::o1));
  static_assert(stands(offsetof(Damping, o2), Places::o2));
  static_assert(stands(offsetof(Damping, e0), Places::e0));
  static_assert(stands(offsetof(Damping, d11), Places::d11));
  static_assert(stands(offsetof(Damping, d12), Places::d12));
  static_assert(stands(offsetof(Damping, d22), Places::d22));
  static_assert(stands(offsetof(Damping, d_twist), Places::d_twist));
  static_assert(stands(offsetof(Damping, d_axial), Places::d_axial));
  return stands(sizeof(Damping), Places::size);
}

template <bool Rotating>
void ShaftDamping<Rotating>::add_forces(std::span<const ShaftDamping> elements,
                                        const std::array<Index, 2>* nodes, const NodeState* states,
                                        const Context&, Vector<7>* force) {
  static_assert(damping_in_place<Rotating>());
  if (elements.empty()) return;
  lanes::Elements b;
  b.element = &elements[0].length;
  b.count = elements.size();
  b.nodes = nodes->data();
  b.state = states[0].u.data();
  b.force = force->data();
  static const lanes::Kernels& kernels = lanes::kernels();
  (Rotating ? kernels.add_internal_damping : kernels.add_external_damping)(b);
}

template <bool Rotating>
void ShaftDamping<Rotating>::add_force(const Nodes<2>& x, const Context& ctx, ForceX<14>& f) const {
  const NodeState states[2] = {*x[0], *x[1]};
  const std::array<Index, 2> nodes{0, 1};
  Vector<7> force[2] = {f.template head<7>(), f.template tail<7>()};
  add_forces({this, 1}, &nodes, states, ctx, force);
  f << force[0], force[1];
}

template <bool Rotating>
void ShaftDamping<Rotating>::add_tangent(const Nodes<2>& x, const Context&,
                                         TangentX<14>& out) const {
  using V = Vec3T<double>;
  const Vec3 e = x[0]->e(), du = du_of(*this, x);
  // C: the force is linear in the rates, one column per rate of (lambda, d1, d2, phi1, phi2)
  const Damper<Rotating, double> damper(*this, e, V(du), V(x[0]->t), V(x[1]->t));
  Eigen::Matrix<double, 14, 11> columns = Eigen::Matrix<double, 14, 11>::Zero();
  for (int k = 0; k < 11; ++k) {
    Rates v;
    if (k < 3)
      v.lambda[k] = 1.0;
    else if (k < 6)
      v.d1[k - 3] = 1.0;
    else if (k < 9)
      v.d2[k - 6] = 1.0;
    else
      (k == 9 ? v.phi1 : v.phi2) = 1.0;
    const auto r = damper.force(v);
    scatter(o1, o2, values(r.lambda), values(r.d1), values(r.d2), r.phi1, r.phi2, columns.col(k));
  }
  auto& C = out.C;
  C.template middleCols<3>(0) -= columns.leftCols<3>();
  C.template middleCols<3>(7) += columns.leftCols<3>();
  C.template middleCols<3>(3) += columns.middleCols<3>(3) - o1 * columns.leftCols<3>();
  C.template middleCols<3>(10) += columns.middleCols<3>(6) + o2 * columns.leftCols<3>();
  C.col(6) += columns.col(9);
  C.col(13) += columns.col(10);

  // K: nine directions at once (lambda, d1, d2)
  using D = Dual<9>;
  using W = Vec3T<D>;
  const Damper<Rotating, D> moving(*this, e, W::variable(du, 0), W::variable(x[0]->t, 3),
                                   W::variable(x[1]->t, 6));
  const auto r = moving.force(rates_of(*this, x));
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
  const Damper<Rotating, double> damper(*this, x[0]->e(), V(du_of(*this, x)), V(x[0]->t),
                                        V(x[1]->t));
  e.dissipated += damper.force(rates_of(*this, x)).power;
}

template struct ShaftDamping<false>;
template struct ShaftDamping<true>;

namespace {
constexpr int vector_rows[4] = {0, 3, 7, 10};
}

void ShaftMassDamping::add_force(const Nodes<2>& x, const Context&, ForceX<14>& f) const {
  const Vec3* vel[4] = {&x[0]->du, &x[0]->dd, &x[1]->du, &x[1]->dd};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      f.segment<3>(vector_rows[k]) += C4(k, j) * *vel[j];
}

void ShaftMassDamping::add_tangent(const Nodes<2>&, const Context&, TangentX<14>& t) const {
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      t.C.block<3, 3>(vector_rows[k], vector_rows[j]).diagonal().array() += C4(k, j);
}

void ShaftMassDamping::add_energy(const Nodes<2>& x, const Context&, Energy& e) const {
  const Vec3* vel[4] = {&x[0]->du, &x[0]->dd, &x[1]->du, &x[1]->dd};
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 4; ++j)
      e.dissipated += C4(k, j) * vel[k]->dot(*vel[j]);
}

}  // namespace whirl::elements
