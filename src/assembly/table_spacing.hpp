// Whether the rows of a table of coefficients are close enough for what they tell.
#pragma once
#include <model/bearing_laws.hpp>

namespace whirl::assembly {

/// Beside which row a table says least about what lies between.
struct CoarsestRow {
  double error = 0;  ///< estimated, a share of the largest coefficient of its kind there
  double at = 0;     ///< rad/s: speed of the row, or its frequency
  bool against_frequency = false;
};

/// Every inner row is left out once and interpolated from those beside it, as the table is: what it
/// misses by is, with rows half as far apart, at least four times the error beside it (of second
/// order where a coefficient turns, of third elsewhere). Rows of speeds low .. high only, rad/s.
/// @pre the rows belong to the speeds (times the frequencies) of the table.
CoarsestRow coarsest_row(const model::TableBearing& table, double low, double high);

}  // namespace whirl::assembly
