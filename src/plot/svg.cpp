#include <core/error.hpp>
#include <plot/palette.hpp>
#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>

namespace whirl::plot {

using namespace svg;

namespace {

/// Where the axes of a figure stand. Axes of a column share their margins, so that their frames
/// line up. The height is shared among the frames, not the cells: what margins take is taken
/// first.
struct Grid {
  std::size_t columns = 1, rows = 0;
  double cell_w = 0;
  std::vector<double> height;               ///< of the frames of each row
  std::vector<double> row_top, row_bottom;  ///< margins of each row
  std::vector<Margins> column;              ///< left and right margins of each column
  std::vector<CartesianFlags> flags;        ///< of each of the axes
};

Grid lay_out(const Figure& figure, double top) {
  Grid g;
  g.columns = static_cast<std::size_t>(std::max(1, figure.columns));
  const std::size_t n = figure.axes.size();
  g.rows = (n + g.columns - 1) / g.columns;
  g.cell_w = figure.width / static_cast<double>(g.columns);
  std::vector<double> weight(g.rows, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    weight[i / g.columns] = std::max(weight[i / g.columns], figure.axes[i].weight);
  double total = 0;
  for (const double w : weight)
    total += w;
  g.column.resize(g.columns);
  g.flags.resize(n);
  g.row_top.assign(g.rows, 0.0);
  g.row_bottom.assign(g.rows, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const Axes& a = figure.axes[i];
    g.flags[i].hide_x = i + g.columns < n && figure.axes[i + g.columns].share_x;
    if (a.kind != AxesKind::cartesian) continue;
    const Margins m =
        cartesian_margins(a, g.cell_w, (figure.height - top) * a.weight / total, g.flags[i]);
    Margins& column = g.column[i % g.columns];
    column.left = std::max(column.left, m.left);
    column.right = std::max(column.right, m.right);
    g.row_top[i / g.columns] = std::max(g.row_top[i / g.columns], m.top);
    g.row_bottom[i / g.columns] = std::max(g.row_bottom[i / g.columns], m.bottom);
  }
  double free = figure.height - top - 4;
  for (std::size_t r = 0; r < g.rows; ++r)
    free -= g.row_top[r] + g.row_bottom[r];
  for (const double w : weight)
    g.height.push_back(std::max(10.0, free * w / total));
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t i = 0; i < n; ++i) {
      if (figure.axes[i].kind != AxesKind::cartesian) continue;
      Margins& column = g.column[i % g.columns];
      const Box frame{column.left, 0, g.cell_w - column.left - column.right,
                      g.height[i / g.columns]};
      column.left = std::max(column.left, left_margin(figure.axes[i], frame));
    }
  return g;
}

void draw_axes(Canvas& c, const Grid& g, std::size_t i, double y) {
  const Axes& a = c.figure.axes[i];
  const std::size_t r = i / g.columns, k = i % g.columns;
  const double x = g.cell_w * static_cast<double>(k), h = g.height[r];
  const Box cell{x, y, g.cell_w, h + g.row_top[r] + g.row_bottom[r]};
  const Margins& m = g.column[k];
  switch (a.kind) {
    case AxesKind::cartesian:
      draw_cartesian(c, a, {x + m.left, y + g.row_top[r], g.cell_w - m.left - m.right, h},
                     g.flags[i]);
      break;
    case AxesKind::polar: draw_polar(c, a, cell); break;
    case AxesKind::space: draw_space(c, a, cell); break;
  }
}

/// The head of the file; returns where the axes begin, px from the top.
double draw_head(Canvas& c) {
  const Figure& figure = c.figure;
  const std::string width = number_text(figure.width), height = number_text(figure.height);
  const bool alone = c.options.standalone;
  if (alone) c.add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  c.add("<svg class=\"figure\" id=\"" + c.prefix + "\" viewBox=\"0 0 " + width + " " + height +
        "\" width=\"" + width + "\" height=\"" + height + '"');
  if (alone) c.add(" xmlns=\"http://www.w3.org/2000/svg\"");
  c.add(
      " font-family=\"Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif\" "
      "role=\"img\">\n");
  c.add("<title>" + escape(figure.title.empty() ? figure.name : figure.title) + "</title>\n");
  if (alone) c.add("<rect width=\"100%\" height=\"100%\" " + paper_fill() + "/>\n");
  if (figure.title.empty() || !alone) return 6;  // in the report the title stands above the figure
  c.text(figure.width / 2, 22, figure.title, 15, "middle", "font-weight=\"600\"");
  return 32;
}

}  // namespace

std::string render_svg(const Figure& figure, const SvgOptions& options) {
  Canvas c{{}, figure, options, safe_name(options.id.empty() ? figure.name : options.id)};
  double y = draw_head(c);
  const Grid g = lay_out(figure, y);
  for (std::size_t r = 0; r < g.rows; ++r) {
    for (std::size_t i = r * g.columns; i < std::min((r + 1) * g.columns, figure.axes.size()); ++i)
      draw_axes(c, g, i, y);
    y += g.height[r] + g.row_top[r] + g.row_bottom[r];
  }
  c.add("</svg>\n");
  return std::move(c.out);
}

}  // namespace whirl::plot
