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
  explicit Grid(const std::vector<DataScales>& of) : data(of) {}
  std::size_t columns = 1, rows = 0;
  double width = 0, total = 0;  ///< of the drawing
  double cell_w = 0;
  std::vector<double> height;               ///< of the frames of each row
  std::vector<double> row_top, row_bottom;  ///< margins of each row
  std::vector<Margins> column;              ///< left and right margins of each column
  std::vector<CartesianFlags> flags;        ///< of each of the axes
  const std::vector<DataScales>& data;      ///< of each of the axes
};

/// Rows, columns, and the share of each row.
std::vector<double> begin_grid(Grid& g, const Figure& figure) {
  const std::size_t n = figure.axes.size();
  g.rows = (n + g.columns - 1) / g.columns;
  g.cell_w = g.width / static_cast<double>(g.columns);
  g.column.resize(g.columns);
  g.flags.resize(n);
  g.row_top.assign(g.rows, 0.0);
  g.row_bottom.assign(g.rows, 0.0);
  std::vector<double> weight(g.rows, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    weight[i / g.columns] = std::max(weight[i / g.columns], figure.axes[i].weight);
    g.flags[i].hide_x = i + g.columns < n && figure.axes[i + g.columns].share_x;
  }
  return weight;
}

/// `height`: of the cell of an axis of weight 1, px.
void add_margins(Grid& g, const Figure& figure, double height) {
  for (std::size_t i = 0; i < figure.axes.size(); ++i) {
    const Axes& a = figure.axes[i];
    if (a.kind != AxesKind::cartesian) continue;
    const Margins m = cartesian_margins(a, g.data[i], g.cell_w, height * a.weight, g.flags[i]);
    Margins& column = g.column[i % g.columns];
    column.left = std::max(column.left, m.left);
    column.right = std::max(column.right, m.right);
    g.row_top[i / g.columns] = std::max(g.row_top[i / g.columns], m.top);
    g.row_bottom[i / g.columns] = std::max(g.row_bottom[i / g.columns], m.bottom);
  }
}

/// When the frames have their heights: their ticks may have wider labels than those reckoned with.
void widen_left(Grid& g, const Figure& figure) {
  for (int pass = 0; pass < 2; ++pass)
    for (std::size_t i = 0; i < figure.axes.size(); ++i) {
      if (figure.axes[i].kind != AxesKind::cartesian) continue;
      Margins& column = g.column[i % g.columns];
      const Box frame{column.left, 0, g.cell_w - column.left - column.right,
                      g.height[i / g.columns]};
      column.left = std::max(column.left, left_margin(figure.axes[i], g.data[i], frame));
    }
}

/// When all frames stand: a key makes the drawing higher, not its frames lower.
void add_notes(Grid& g, const Figure& figure) {
  std::vector<double> keys(g.rows, 0.0);
  for (std::size_t i = 0; i < figure.axes.size(); ++i) {
    if (figure.axes[i].kind != AxesKind::cartesian) continue;
    const Margins& m = g.column[i % g.columns];
    const Box frame{m.left, 0, g.cell_w - m.left - m.right, g.height[i / g.columns]};
    CartesianFlags& f = g.flags[i];
    f.notes = plan_notes(figure.axes[i], g.data[i], frame);
    double& key = keys[i / g.columns];
    key = std::max(key, key_height(f.notes, f.legend_width > 0 ? f.legend_width : frame.w));
  }
  for (std::size_t r = 0; r < g.rows; ++r) {
    g.row_bottom[r] += keys[r];
    g.total += keys[r];
  }
}

Grid lay_out(const Figure& figure, const std::vector<DataScales>& data, double top) {
  Grid g(data);
  g.columns = static_cast<std::size_t>(std::max(1, figure.columns));
  g.width = figure.width;
  g.total = figure.height;
  const std::vector<double> weight = begin_grid(g, figure);
  double total = 0;
  for (const double w : weight)
    total += w;
  add_margins(g, figure, (figure.height - top) / total);
  double free = figure.height - top - 4;
  for (std::size_t r = 0; r < g.rows; ++r)
    free -= g.row_top[r] + g.row_bottom[r];
  for (const double w : weight)
    g.height.push_back(std::max(10.0, free * w / total));
  widen_left(g, figure);
  add_notes(g, figure);
  return g;
}

/// Of a frame of the narrow drawing, or of the cell of polar axes and axes in space, px. wide, as
/// wide_width: the frame of the other drawing.
double narrow_height(const Axes& a, double width, double wide_width, double wide) {
  const double legend = legend_size_of(legend_entries(a, resolve_colors(a)), narrow_legend_width).h;
  switch (a.kind) {
    case AxesKind::polar: return narrow_width + 30 + legend;
    case AxesKind::space: return 300 + legend;
    case AxesKind::cartesian: break;
  }
  if (a.equal_aspect) return std::clamp(wide * width / wide_width, 150.0, 340.0);
  return std::clamp(0.7 * wide, 150.0, 330.0);
}

/// All axes below one another, as high as they need to be.
Grid lay_out_narrow(const Figure& figure, const std::vector<DataScales>& data, double top) {
  const Grid wide = lay_out(figure, data, top);
  Grid g(data);
  g.width = narrow_width;
  begin_grid(g, figure);
  for (std::size_t i = 0; i < figure.axes.size(); ++i) {
    g.flags[i].hide_x = wide.columns == 1 && wide.flags[i].hide_x;
    g.flags[i].legend_width = narrow_legend_width;
  }
  constexpr double reckoned_with = 220;
  add_margins(g, figure, reckoned_with);
  g.total = top + 4;
  for (std::size_t i = 0; i < figure.axes.size(); ++i) {
    const Margins& m = wide.column[i % wide.columns];
    g.height.push_back(
        narrow_height(figure.axes[i], g.cell_w - g.column[0].left - g.column[0].right,
                      wide.cell_w - m.left - m.right, wide.height[i / wide.columns]));
    g.total += g.height[i] + g.row_top[i] + g.row_bottom[i];
  }
  widen_left(g, figure);
  add_notes(g, figure);
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
      draw_cartesian(c, a, g.data[i],
                     {x + m.left, y + g.row_top[r], g.cell_w - m.left - m.right, h}, g.flags[i]);
      break;
    case AxesKind::polar: draw_polar(c, a, cell); break;
    case AxesKind::space: draw_space(c, a, cell); break;
  }
}

/// Of the head of the file, px. In the report the title stands above the figure.
double head_height(const Canvas& c) {
  return c.figure.title.empty() || !c.options.standalone ? 6 : 32;
}

void draw_head(Canvas& c, const Grid& g) {
  const Figure& figure = c.figure;
  const std::string width = number_text(g.width), height = number_text(g.total);
  const bool alone = c.options.standalone;
  if (alone) c.add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
  c.add("<svg class=\"figure" +
        std::string(c.narrow  ? " narrow"
                    : c.drawn ? " wide"
                              : "") +
        "\" id=\"" + c.prefix + "\" viewBox=\"0 0 " + width + " " + height + "\" width=\"" + width +
        "\" height=\"" + height + '"');
  if (alone)
    c.add(
        " xmlns=\"http://www.w3.org/2000/svg\" font-family=\"Helvetica, Arial, 'Liberation Sans', "
        "'DejaVu Sans', sans-serif\"");
  c.add(" role=\"img\">\n");
  c.add("<title>" + escape(figure.title.empty() ? figure.name : figure.title) + "</title>\n");
  if (alone) c.add("<rect width=\"100%\" height=\"100%\" " + paper_fill() + "/>\n");
  if (!figure.title.empty() && alone)
    c.text(figure.width / 2, 22, figure.title, 15, "middle", "font-weight=\"600\"");
}

/// In a page the style sheet gives what has a class its colours.
std::string without_colors(const std::string& svg) {
  std::string out;
  out.reserve(svg.size());
  std::size_t done = 0;
  for (std::size_t at = svg.find("class=\""); at != std::string::npos;
       at = svg.find("class=\"", at + 1)) {
    std::size_t end = svg.find('"', at + 7) + 1;
    out.append(svg, done, end - done);
    for (bool found = true; found;) {
      found = false;
      for (const std::string_view name : {" stroke=\"#", " fill=\"#", " fill=\"none\""})
        if (svg.compare(end, name.size(), name) == 0) {
          end = svg.find('"', svg.find('"', end) + 1) + 1;
          found = true;
        }
    }
    done = end;
  }
  return out.append(svg, done);
}

std::string draw(Canvas& c) {
  double y = head_height(c);
  const Grid g = c.narrow ? lay_out_narrow(c.figure, *c.data, y) : lay_out(c.figure, *c.data, y);
  draw_head(c, g);
  for (std::size_t r = 0; r < g.rows; ++r) {
    for (std::size_t i = r * g.columns; i < std::min((r + 1) * g.columns, c.figure.axes.size());
         ++i)
      draw_axes(c, g, i, y);
    y += g.height[r] + g.row_top[r] + g.row_bottom[r];
  }
  c.add("</svg>\n");
  return c.options.standalone ? std::move(c.out) : without_colors(c.out);
}

std::vector<DataScales> scales_of(const Figure& figure) {
  std::vector<DataScales> all;
  for (const Axes& a : figure.axes)
    all.push_back(a.kind == AxesKind::cartesian ? data_range(a) : DataScales{});
  return all;
}

}  // namespace

std::string render_svg(const Figure& figure, const SvgOptions& options) {
  const std::vector<DataScales> data = scales_of(figure);
  Canvas c{{}, figure, options, safe_name(options.id.empty() ? figure.name : options.id)};
  c.data = &data;
  return draw(c);
}

SvgPair render_for_page(const Figure& figure, const SvgOptions& options) {
  const std::string id = safe_name(options.id.empty() ? figure.name : options.id);
  const std::vector<DataScales> data = scales_of(figure);
  std::vector<DrawnPlot> drawn;
  Canvas wide{{}, figure, options, id + "_wide", &drawn};
  wide.data = &data;
  SvgPair out;
  out.wide = draw(wide);
  Canvas narrow{{}, figure, options, id + "_narrow", &drawn, true};
  narrow.ids = wide.ids;
  narrow.data = &data;
  out.narrow = draw(narrow);
  return out;
}

}  // namespace whirl::plot
