// Keys and responses of a sweep, each against each other.
#pragma once
#include <sweep/columns.hpp>
#include <plot/plot.hpp>

namespace whirl::sweep {

/// Below the diagonal runs as points, on it histograms, above it rank correlations. No axes: fewer
/// than two columns vary. Of many keys those are shown that matter most.
plot::Figure scatter_matrix(const Plan& plan, const Columns& columns);

}  // namespace whirl::sweep
