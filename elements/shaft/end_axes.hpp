// A straight element's ends, and the axes of what is fixed in its section: for what acts through its
// bending alone.
#pragma once
#include <core/types.hpp>
#include <cmath>

namespace whirl::elements {

struct EndAxes {
  double length = 1;            ///< unstressed, between the end points, m
  double o1 = 0;                ///< end point 1 = node 1 + o1 d1, m
  double o2 = 0;                ///< end point 2 = node 2 + o2 d2, m
  Vec3 normal = Vec3::UnitY();  ///< first axis of the section, fixed in it, perpendicular to x

  /// angle: of the first axis from e2 towards e3, rad.
  static Vec3 normal_at(double angle) { return Vec3(0, std::cos(angle), std::sin(angle)); }
};

/// First-order approach of an amount to its end: end + (start - end) exp(-t/constant).
struct Growth {
  double start = 1, end = 1, constant = 0;  ///< constant: s; 0: at its end at once

  double at(double t) const {
    return constant > 0 ? end + (start - end) * std::exp(-t / constant) : end;
  }
  double rate(double t) const {
    return constant > 0 ? (end - start) / constant * std::exp(-t / constant) : 0.0;
  }
  bool varies() const { return constant > 0 && start != end; }
};

}  // namespace whirl::elements
