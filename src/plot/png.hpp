// PNG of a grid of palette indices.
#pragma once
#include <plot/palette.hpp>
#include <cstdint>
#include <span>
#include <string>

namespace whirl::plot {

/// nx columns, ny rows from the top, one byte a cell: an index into the palette of at most 256
/// colors. Written without compression (deflate's stored blocks, no filter): a script can read the
/// cells back. @throws std::runtime_error when libpng refuses.
std::string make_png(int nx, int ny, std::span<const std::uint8_t> cells,
                     std::span<const Rgb> palette);

}  // namespace whirl::plot
