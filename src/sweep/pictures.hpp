// Pictures of a finished sweep.
#pragma once
#include <sweep/columns.hpp>
#include <plot/plot.hpp>

namespace whirl::sweep {

/// Everything that can be drawn of these runs: histograms with their quantiles, each response
/// against what is varied and against the others, all runs as lines across all columns, a surface
/// where two lists of numbers are combined, and what the scheme of sensitivity found.
std::vector<plot::Figure> pictures_of(const Plan& plan, const Columns& columns);

}  // namespace whirl::sweep
