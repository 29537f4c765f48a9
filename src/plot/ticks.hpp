// Where an axis gets its ticks, and how they are written.
#pragma once
#include <string>
#include <vector>

namespace whirl::plot {

struct Ticks {
  std::vector<double> major, minor;
  std::vector<std::string> labels;  ///< one a major tick
  int exponent = 0;  ///< labels are values / 10^exponent (a multiple of 3); 0 when written out
};

/// Ticks at 1, 2, 2.5 or 5 times a power of ten inside [lo, hi], about `target` of them.
Ticks linear_ticks(double lo, double hi, double target);
/// Decades inside [lo, hi], 1-2-5 as well when there are few of them; at most about `target`
/// labels.
Ticks log_ticks(double lo, double hi, double target);
/// Multiples of 30 or 45 degrees.
Ticks angle_ticks(double lo, double hi);
/// Labels for given tick positions.
Ticks fixed_ticks(const std::vector<double>& at);

}  // namespace whirl::plot
