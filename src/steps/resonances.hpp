// Where a grid of speeds or frequencies is made finer, so that no peak of a response is too sharp
// for it.
#pragma once
#include <vector>

namespace whirl::steps {

/// A resonance, rad/s, and places about it, in multiples of its half width: of a mode of that
/// damping ratio, of either sign. Appended to `out`.
void add_places_about(double resonance, double damping_ratio, std::vector<double>& out);

/// Ascending, apart by 1e-7 at least.
void sort_apart(std::vector<double>& grid);

}  // namespace whirl::steps
