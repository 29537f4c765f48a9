#include <core/error.hpp>
#include <plot/palette.hpp>
#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>

namespace whirl::plot {

using namespace svg;

std::string render_svg(const Figure& figure, const SvgOptions& options) {
  Canvas c{{}, figure, options, safe_name(options.id.empty() ? figure.name : options.id)};
  const double W = figure.width, H = figure.height;
  const std::string size = number_text(W) + " " + number_text(H);
  if (options.standalone) c.add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  c.add("<svg class=\"figure\" id=\"" + c.prefix + "\" viewBox=\"0 0 " + size + "\" width=\"" +
        number_text(W) + "\" height=\"" + number_text(H) + '"');
  if (options.standalone) c.add(" xmlns=\"http://www.w3.org/2000/svg\"");
  c.add(
      " font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" "
      "role=\"img\">\n");
  c.add("<title>" + escape(figure.title.empty() ? figure.name : figure.title) + "</title>\n");
  if (options.standalone) c.add("<rect width=\"100%\" height=\"100%\" " + paper_fill() + "/>\n");
  double top = 6;
  if (!figure.title.empty() &&
      options.standalone) {  // in the report the title stands above the figure
    c.text(W / 2, 22, figure.title, 15, "middle", "font-weight=\"600\"");
    top = 32;
  }
  const auto columns = static_cast<std::size_t>(std::max(1, figure.columns));
  const std::size_t n = figure.axes.size(), rows = (n + columns - 1) / columns;
  const double cell_w = W / static_cast<double>(columns);
  double total = 0;
  std::vector<double> weight(rows, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    weight[i / columns] = std::max(weight[i / columns], figure.axes[i].weight);
  for (const double w : weight)
    total += w;

  // Axes of a column share their margins, so that their frames line up. The height is shared among
  // the frames, not the cells: what margins take is taken first.
  std::vector<Margins> margins(n), column(columns);
  std::vector<CartesianFlags> flags(n);
  std::vector<double> row_top(rows, 0.0), row_bottom(rows, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    flags[i].hide_x = i + columns < n && figure.axes[i + columns].share_x;
    if (figure.axes[i].kind != AxesKind::cartesian) continue;
    margins[i] = cartesian_margins(figure.axes[i], cell_w,
                                   (H - top) * figure.axes[i].weight / total, flags[i]);
    auto& m = column[i % columns];
    m.left = std::max(m.left, margins[i].left);
    m.right = std::max(m.right, margins[i].right);
    row_top[i / columns] = std::max(row_top[i / columns], margins[i].top);
    row_bottom[i / columns] = std::max(row_bottom[i / columns], margins[i].bottom);
  }
  double free = H - top - 4;
  for (std::size_t r = 0; r < rows; ++r)
    free -= row_top[r] + row_bottom[r];
  double y = top;
  for (std::size_t r = 0; r < rows; ++r) {
    const double h = std::max(10.0, free * weight[r] / total);
    for (std::size_t k = 0; k < columns && r * columns + k < n; ++k) {
      const std::size_t i = r * columns + k;
      const double x = cell_w * static_cast<double>(k);
      const Box cell{x, y, cell_w, h + row_top[r] + row_bottom[r]};
      switch (figure.axes[i].kind) {
        case AxesKind::cartesian:
          draw_cartesian(
              c, figure.axes[i],
              {x + column[k].left, y + row_top[r], cell_w - column[k].left - column[k].right, h},
              flags[i]);
          break;
        case AxesKind::polar: draw_polar(c, figure.axes[i], cell); break;
        case AxesKind::space: draw_space(c, figure.axes[i], cell); break;
      }
    }
    y += h + row_top[r] + row_bottom[r];
  }
  c.add("</svg>\n");
  return std::move(c.out);
}

}  // namespace whirl::plot
