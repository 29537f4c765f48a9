// Pictures of a finished sweep.
#pragma once
#include <sweep/columns.hpp>
#include <plot/plot.hpp>

namespace whirl::sweep {

/// Everything that can be drawn of these runs: histograms with their quantiles and where those lie,
/// each response against what is varied, a matrix of all columns against each other, all runs as lines
/// across all columns, lines and filled contours where two lists of numbers are combined, filled
/// contours of a quadratic through samples, and what the scheme of sensitivity found.
std::vector<plot::Figure> pictures_of(const Plan& plan, const Columns& columns);

}  // namespace whirl::sweep
