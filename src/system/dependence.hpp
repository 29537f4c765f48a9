// What the force of an element depends on beside position and lateral motion of its nodes. Every
// kernel declares it (kernel.hpp); analyses file the terms of a system by it, and none finds out by
// trial.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace whirl::system {

/// The angles phi of its nodes, as an element sees them.
struct SeenAngle {
  enum class Form {
    none,  ///< not at all
    sum,   ///< through weight . phi alone: a twist, teeth in mesh
    each   ///< in every combination: what is fixed in a turning body
  };
  Form form = Form::none;
  std::array<double, 2> weight{};  ///< of a sum: one a node

  bool operator==(const SeenAngle&) const = default;
  /// What both see together.
  friend constexpr SeenAngle operator|(const SeenAngle& a, const SeenAngle& b) {
    if (a.form == Form::none) return b;
    if (b.form == Form::none || (a.form == b.form && a.weight == b.weight)) return a;
    return {Form::each, {}};
  }
  /// The element sees its nodes turn at these rates (any unit): rates that agree but for rounding
  /// leave a sum as it is.
  bool changes(std::span<const double> rate) const {
    if (form == Form::none) return false;
    double sum = 0.0, size = 0.0;
    for (std::size_t i = 0; i < rate.size(); ++i) {
      const double share = form == Form::each ? std::abs(rate[i]) : weight[i] * rate[i];
      sum += share;
      size += std::abs(share);
    }
    return std::abs(sum) > 1e-12 * size;
  }
};
inline constexpr SeenAngle no_angle{};
inline constexpr SeenAngle each_angle{SeenAngle::Form::each, {}};
constexpr SeenAngle angle_sum(double first, double second) {
  return {SeenAngle::Form::sum, {first, second}};
}
inline constexpr SeenAngle twist_angle = angle_sum(1.0, -1.0);

struct Dependence {
  SeenAngle angle{};
  bool spin = false;       ///< on phi'
  bool frequency = false;  ///< on Context::frequency
  bool rate =
      false;  ///< tangents: on the rate of a small motion, Context::whirl w and growth g, as
              ///< a + b/w + c g/w while Context::whirl_side stays on its side of each spin
  bool time = false;    ///< on Context::time
  bool weight = false;  ///< on a common acceleration of its nodes and Context::gravity
  int harmonics = 2;    ///< of what turns: multiples of the angle in the force, beyond which
                        ///< little is left

  /// What both depend on together.
  friend constexpr Dependence operator|(const Dependence& a, const Dependence& b) {
    return {.angle = a.angle | b.angle,
            .spin = a.spin || b.spin,
            .frequency = a.frequency || b.frequency,
            .rate = a.rate || b.rate,
            .time = a.time || b.time,
            .weight = a.weight || b.weight,
            .harmonics = std::max(a.harmonics, b.harmonics)};
  }
};

}  // namespace whirl::system
