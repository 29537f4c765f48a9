#include <elements/supports/spring_block.hpp>
#include <core/single.hpp>

#include <math.h>

namespace whirl::elements {

using namespace system;

namespace {

using namespace single;

#define WHIRL_INLINE inline
#include <core/series.inl>
#include <elements/shaft/angle_ratio.inl>
#undef WHIRL_INLINE

/// d - e0; in a chart that has not been moved it is t to the last digit.
Vec3 tilt(const NodeState& n, const Vec3& e0) { return n.t + (n.e() - e0); }
}  // namespace

Vec3 SpringBlock::displacement(const NodeState& n) const { return n.u + offset * tilt(n, e0); }

void SpringBlock::add_force(const Nodes<1>& x, const Context&, ForceX<7>& f) const {
  const Vec3 delta = tilt(*x[0], e0), F = C1 * (x[0]->u + offset * delta);
  const AngleRatio<double> r = angle_ratio(0.5 * delta.squaredNorm());  // 1 - cos theta
  f.head<3>() += F;
  f.segment<3>(3) += offset * F + (C2 * r.G) * delta;
}

void SpringBlock::add_tangent(const Nodes<1>& x, const Context&, TangentX<7>& t) const {
  const Vec3 delta = tilt(*x[0], e0);
  const AngleRatio<double> r = angle_ratio(0.5 * delta.squaredNorm());
  t.K.block<3, 3>(3, 3) += (C2 * r.G1) * delta * delta.transpose();
  for (int i = 0; i < 3; ++i) {
    t.K(i, i) += C1;
    t.K(i, 3 + i) += C1 * offset;
    t.K(3 + i, i) += C1 * offset;
    t.K(3 + i, 3 + i) += C1 * offset * offset + C2 * r.G;
  }
}

void SpringBlock::add_energy(const Nodes<1>& x, const Context&, Energy& e) const {
  const Vec3 delta = tilt(*x[0], e0);
  e.elastic += 0.5 * C1 * (x[0]->u + offset * delta).squaredNorm() +
               0.5 * C2 * angle_ratio(0.5 * delta.squaredNorm()).F;
}

}  // namespace whirl::elements
