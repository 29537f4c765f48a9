// Figure -> SVG text, by our own renderer.
#pragma once
#include <plot/plot.hpp>
#include <string>

namespace whirl::plot {

struct SvgOptions {
  bool standalone =
      true;  ///< XML header, white background, light colours; else for inlining in the report
  std::string id{};     ///< of the `<svg>`; empty: the figure's name
  std::string marks{};  ///< prefix of the ids in it, short: every marker repeats it; empty: the id
  double columns_per_px =
      1.0;  ///< decimation keeps first, last, lowest and highest point of each such column
};

std::string render_svg(const Figure& figure, const SvgOptions& options = {});

/// A figure for a page that is read on a desk and on a telephone.
struct SvgPair {
  std::string wide;    ///< as the figure says
  std::string narrow;  ///< 360 px wide, axes below one another, legends below them
};
/// The narrow drawing repeats the curves and maps of the wide one by reference: both must stand in
/// one page. `options.standalone` must be false.
SvgPair render_for_page(const Figure& figure, const SvgOptions& options);

}  // namespace whirl::plot
