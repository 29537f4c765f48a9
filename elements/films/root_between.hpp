// A root of a function between two places.
#pragma once
#include <cmath>

namespace whirl::elements {

/// A root of f between low and high, where it changes its sign (Illinois); f may be as steep as it
/// likes at the ends: it is looked at through asinh(f/scale). known: of low and high, how well the
/// place is wanted.
/// @pre f(low) < 0 < f(high), scale > 0.
template <class F>
double root_between(double low, double high, double scale, const F& f, double known = 1e-15) {
  const auto g = [&](double x) { return std::asinh(f(x) / scale); };
  double at_low = g(low), at_high = g(high);
  const double smallest = known * (std::abs(low) + std::abs(high));
  int side = 0;
  for (int k = 0; k < 200 && high - low > smallest; ++k) {
    // a half now and then: flat stretches
    double x = k % 4 == 3 ? 0.5 * (low + high) : low + (high - low) * at_low / (at_low - at_high);
    if (!(x > low && x < high)) x = 0.5 * (low + high);
    const double y = g(x);
    if (y == 0.0) return x;
    if (y < 0.0) {
      low = x;
      at_low = y;
      if (side < 0) at_high *= 0.5;
      side = -1;
    } else {
      high = x;
      at_high = y;
      if (side > 0) at_low *= 0.5;
      side = 1;
    }
  }
  return 0.5 * (low + high);
}

}  // namespace whirl::elements
