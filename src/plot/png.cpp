#include <plot/png.hpp>
#include <png.h>
#include <csetjmp>
#include <stdexcept>
#include <vector>

namespace whirl::plot {
namespace {

void append(png_structp png, png_bytep bytes, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char*>(bytes), count);
}

void no_flush(png_structp) {}

/// Keeps the message and jumps out of the library.
void fail(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

/// False when the library gives up: it jumps back here, so nothing in this frame has a destructor.
bool write(png_structp png, png_infop info, std::string& target, std::uint32_t nx,
           std::span<png_bytep> rows, std::span<const png_color> palette) {
  if (setjmp(png_jmpbuf(png))) return false;
  const auto ny = static_cast<std::uint32_t>(rows.size());
  png_set_write_fn(png, &target, append, no_flush);
  png_set_IHDR(png, info, nx, ny, 8, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
  png_set_compression_level(png, 9);
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  return true;
}

}  // namespace

std::string make_png(int nx, int ny, std::span<const std::uint8_t> cells,
                     std::span<const Rgb> palette) {
  const auto width = static_cast<std::size_t>(nx), height = static_cast<std::size_t>(ny);
  std::vector<png_color> colors;
  for (const Rgb& c : palette)
    colors.push_back({c.r, c.g, c.b});
  std::vector<std::uint8_t> writable(cells.begin(), cells.end());  // as the library's rows are
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < height; ++y)
    rows.push_back(writable.data() + y * width);
  std::string target, error;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, fail, ignore);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  const bool written =
      info && write(png, info, target, static_cast<std::uint32_t>(nx), rows, colors);
  png_destroy_write_struct(&png, &info);
  if (!written) throw std::runtime_error("picture not written: " + error);
  return target;
}

}  // namespace whirl::plot
