#include <elements/shaft/thermal_bow.hpp>

#include <core/dual_rate.hpp>
#include <system/stiffness_rate.hpp>
#include <math.h>
#include <array>

namespace whirl::elements {

using system::Context;
using system::Energy;
using system::ForceX;
using system::Nodes;
using system::NodeState;
using system::TangentX;

namespace {

#include <elements/shaft/shaft_single.inl>

#include <elements/shaft/beam_nodes.inl>
#include <elements/shaft/beam_derivatives.inl>

#include <elements/shaft/end_bending.inl>

template <class T>
ForceOut<T> bending_force(const ThermalBow& b, const NodeT<T>& n1, const NodeT<T>& n2,
                          const SectionMotion<T>& m1, const SectionMotion<T>& m2,
                          const Context& c) {
  const EndBending<T> x(b.at, n1, n2, m1, m2);
  const double A = b.amount(c);
  const T on_y[2] = {T(-A * b.s1[0]), T(-A * b.s2[0])};
  const T on_z[2] = {T(-A * b.s1[1]), T(-A * b.s2[1])};
  return x.forces(on_y, on_z);
}

}  // namespace

void ThermalBow::add_force(const Nodes<2>& x, const Context& c, ForceX<14>& f) const {
  const auto r = place_force(*this, x, c);
  f += Eigen::Map<const Vector<14>>(r.data());
}

void ThermalBow::add_tangent(const Nodes<2>& x, const Context& c, TangentX<14>& t) const {
  t.K += differentiate_place(*this, x, c);
}

void ThermalBow::add_energy(const Nodes<2>& x, const Context& c, Energy& e) const {
  const NodeT<double> n1(*x[0]), n2(*x[1]);
  const SectionMotion<double> m1(n1), m2(n2);
  const EndBending<double> b(at, n1, n2, m1, m2);
  const double A = amount(c), rate = c.averaged ? 0.0 : growth.rate(c.time);
  const double load = s1[0] * b.P[0].y + s1[1] * b.P[0].z + s2[0] * b.P[1].y + s2[1] * b.P[1].z;
  e.elastic += 0.5 * A * A * square - A * load;
  e.supplied += rate * (A * square - load);
}

}  // namespace whirl::elements
