// The formulas of shaft_strain.inl for one element, with double, Dual or DualRate for its scalars.
// Included inside an anonymous namespace after <core/dual_rate.hpp>, <system/kernel.hpp> and
// <math.h>.
#pragma once

using namespace single;
using namespace system::of_one;

#define WHIRL_INLINE inline
#include <core/series.inl>
#include <elements/shaft/angle_ratio.inl>

template <int N>
AngleRatio<Dual<N>> angle_ratio(const Dual<N>& n) {
  const AngleRatio<double> r = angle_ratio(n.v);
  return {chain(n, r.F, 2.0 * r.G), chain(n, r.G, r.G1),
          chain(n, r.G1, angle_ratio_second(n.v, r))};
}
template <int N>
AngleRatio<DualRate<N>> angle_ratio(const DualRate<N>& n) {
  const AngleRatio<double> r = angle_ratio(n.v);
  const double second = angle_ratio_second(n.v, r);
  return {chain(n, r.F, 2.0 * r.G, 2.0 * r.G1), chain(n, r.G, r.G1, second),
          chain(n, r.G1, second, angle_ratio_third(n.v, r))};
}

#include <elements/shaft/shaft_strain.inl>
#undef WHIRL_INLINE
