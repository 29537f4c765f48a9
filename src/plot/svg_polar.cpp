#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot::svg {

void draw_polar(Canvas& c, const Axes& a, const Box& cell) {
  const Colors k = resolve_colors(a);
  const auto entries = legend_entries(a, k);
  const Box legend = legend_size_of(entries);
  double largest = 0;
  for (const auto& s : a.series)
    for (const double v : s.y)
      if (std::isfinite(v)) largest = std::max(largest, v);
  if (!(largest > 0)) largest = 1;
  if (!std::isnan(a.y.max)) largest = a.y.max;
  const Ticks t = linear_ticks(0, largest * 1.02, 4);
  const double step = t.major.size() > 1 ? t.major[1] - t.major[0] : largest;
  const double full = std::isnan(a.y.max) ? step * std::ceil(largest / step - 0.02) : largest;
  const double top = a.title.empty() ? 8 : 26;
  const double right = entries.empty() ? 0 : legend.w + 10;
  const double R = std::max(20.0, std::min((cell.w - right - 80) / 2, (cell.h - top - 76) / 2));
  const double cx = cell.x + (cell.w - right) / 2, cy = cell.y + top + 20 + R;
  const auto at = [&](double degrees, double r) {
    const double f = (a.zero_at + (a.clockwise ? -degrees : degrees)) * pi / 180;
    return Point{cx + r * std::cos(f), cy - r * std::sin(f)};
  };
  c.add("<g class=\"axes\" data-kind=\"polar\" data-box=\"" + number_text(cx - R) + " " +
        number_text(cy - R) + " " + number_text(2 * R) + " " + number_text(2 * R) +
        "\" data-zero=\"" + number_text(a.zero_at) + "\" data-cw=\"" + (a.clockwise ? "1" : "0") +
        '"');
  axis_attributes(c, "x", a.x, Scale{0, 360, false});
  axis_attributes(c, "y", a.y, Scale{0, full, false});
  c.add(">\n");
  if (!a.title.empty())
    c.text(cell.x + 8, cell.y + top - 9, a.title, title_size, "start", "font-weight=\"600\"");
  c.add("<g class=\"gx\">");
  for (int deg = 0; deg < 360; deg += 30) {
    const Point p = at(deg, R), q = at(deg, R + 15);
    c.line(cx, cy, p.x, p.y, stroke(faint, 0.8));
    c.text(q.x, q.y + 4, std::to_string(deg) + "°", tick_size, "middle");
  }
  for (double r = step; r < full * 1.001; r += step) {
    c.add("<circle");
    c.attr("cx", cx);
    c.attr("cy", cy);
    c.attr("r", R * r / full);
    c.add(" " + (r > full * 0.999 ? stroke(ink, 0.9) : stroke(faint, 0.8)) + "/>");
  }
  c.add("</g>\n<g class=\"plot\">\n");
  std::vector<Point> seen;
  for (std::size_t i = 0; i < a.series.size(); ++i) {
    const auto& s = a.series[i];
    std::vector<double> px(s.x.size(), nan), py(s.x.size(), nan);
    for (std::size_t j = 0; j < s.x.size() && j < s.y.size(); ++j) {
      if (!std::isfinite(s.x[j]) || !std::isfinite(s.y[j])) continue;
      const Point p = at(s.x[j], R * s.y[j] / full);
      px[j] = p.x;
      py[j] = p.y;
    }
    const std::string rest = readout_attributes(s, px, py);
    const bool keep = s.keep_all || !s.extra.empty() || !s.point_names.empty();
    if (s.style.width > 0)
      c.add("<path data-s=\"" + std::to_string(i) + "\"" + rest + " " +
            stroke(k.series[i], s.style.width, s.style.dash) + " stroke-linejoin=\"round\" d=\"" +
            path_of(px, py, keep, false, c.options.columns_per_px, &seen) + "\"/>\n");
    draw_pins(c, px, py, s.style, k.series[i], static_cast<int>(i), false,
              s.style.width > 0 ? std::string(" data-quiet=\"1\"") : rest);
  }
  c.add("</g>\n");
  // Radii along the ray at 15 degrees, where no angle is labelled.
  for (double r = step; r < full * 1.001; r += step) {
    const Point p = at(a.clockwise ? -15 : 15, R * r / full);
    const auto n = static_cast<std::size_t>(std::lround(r / step));
    if (n < t.labels.size()) c.text(p.x, p.y + 4, t.labels[n], tick_size - 1, "middle");
  }
  std::vector<Box> taken;
  const Box inside{cx - R - 30, cy - R, 2 * R + 60, 2 * R};
  for (const auto& n : a.notes)
    draw_note(c, at(n.x, R * n.y / full), n.text, inside, taken, seen);
  c.text(cx, cy + R + 40, axis_title(a.y, t.exponent) + ", " + a.x.label, label_size, "middle");
  draw_legend(c, entries, cell, seen, {},
              {cell.right() - legend.w, cell.y + top, legend.w, legend.h});
  c.add("</g>\n");
}

}  // namespace whirl::plot::svg
