// PNG of a grid of palette indices.
#pragma once
#include <plot/palette.hpp>
#include <cstdint>
#include <span>
#include <string>

namespace whirl::plot {

/// nx columns, ny rows from the top, one byte a cell. Stored without compression: the cells stand
/// in the file as they are, ny rows of one zero byte and nx indices, so that a script can read them
/// back.
std::string make_png(int nx, int ny, std::span<const std::uint8_t> cells,
                     std::span<const Rgb> palette);

}  // namespace whirl::plot
