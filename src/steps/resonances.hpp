// Where a grid of speeds or frequencies is made finer, so that no peak of a response is too sharp
// for it.
#pragma once
#include <core/error.hpp>
#include <results/frequency.hpp>
#include <vector>

namespace whirl::steps {

/// A resonance, rad/s, and places about it, in multiples of its half width: of a mode of that
/// damping ratio, of either sign. Appended to `out`.
void add_places_about(double resonance, double damping_ratio, std::vector<double>& out);

/// Ascending, apart by 1e-7 at least.
void sort_apart(std::vector<double>& grid);

/// W15: resonances could not be found, for this reason, and the points are those asked for.
void warn_of_coarse_points(results::FrequencyStep& s, const Error& why);

}  // namespace whirl::steps
