// Fewer points, the same picture.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace whirl::plot {

/// Indices to draw of a curve whose x does not decrease: of each of `columns` equal columns of [x0,
/// x1] the first, lowest, highest and last point. Points outside keep one neighbour on each side.
/// nan points are kept (they break the line), one of a row of them. The lowest and highest value of
/// every column survive exactly.
std::vector<std::size_t> decimate_columns(std::span<const double> x, std::span<const double> y,
                                          double x0, double x1, std::size_t columns);

/// For curves that go anywhere (orbits), in px: pieces of the path whose segments are new on a grid
/// of `cell` px. Segments that would be drawn over an earlier one are left out. Returns runs of
/// point indices.
std::vector<std::vector<std::size_t>> decimate_path(std::span<const double> px,
                                                    std::span<const double> py, double cell = 0.5);

/// True when no value is below its predecessor (nan ignored).
bool is_increasing(std::span<const double> x);

}  // namespace whirl::plot
