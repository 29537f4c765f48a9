#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>

namespace whirl::plot::svg {
namespace {
constexpr double row = 17, sample = 26, pad = 7;
}

std::vector<LegendEntry> legend_entries(const Axes& a, const Colors& k) {
  std::vector<LegendEntry> e;
  if (!a.legend) return e;
  int number = 0;
  for (std::size_t i = 0; i < a.series.size(); ++i, ++number)
    if (!a.series[i].label.empty())
      e.push_back({a.series[i].label, a.series[i].style, k.series[i], number});
  for (std::size_t i = 0; i < a.bars.size(); ++i, ++number)
    if (!a.bars[i].label.empty())
      e.push_back({a.bars[i].label, a.bars[i].style, k.bars[i], number, false, true});
  for (std::size_t i = 0; i < a.patches.size(); ++i, ++number)
    if (!a.patches[i].label.empty())
      e.push_back({a.patches[i].label, a.patches[i].style, k.patches[i], number, true});
  for (std::size_t i = 0; i < a.space.size(); ++i, ++number)
    if (!a.space[i].label.empty())
      e.push_back({a.space[i].label, a.space[i].style, k.space[i], number});
  return e;
}

namespace {

/// Of the widest entry, px.
double entry_width(const std::vector<LegendEntry>& entries, double width) {
  double w = 0;
  for (const auto& e : entries)
    w = std::max(w, wide_fonts * text_width(e.label, legend_size));
  w += sample + 6;
  return width > 0 ? std::min(w, width - 2 * pad) : w;
}

std::size_t columns_of(const std::vector<LegendEntry>& entries, double width) {
  constexpr double apart = 10;
  const double free = width - 2 * pad + apart, each = entry_width(entries, width) + apart;
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::max(1.0, free / each)), 1,
                                 std::max<std::size_t>(1, entries.size()));
}

}  // namespace

Box legend_size_of(const std::vector<LegendEntry>& entries, double width) {
  if (entries.empty()) return {};
  const double w = entry_width(entries, width);
  const std::size_t columns = columns_of(entries, width);
  const std::size_t rows = (entries.size() + columns - 1) / columns;
  return {0, 0, columns > 1 ? width : w + 2 * pad, row * static_cast<double>(rows) + 2 * pad - 4};
}

namespace {

bool covers(const Box& t, const Point& p) {
  return p.x > t.x - 3 && p.x < t.right() + 3 && p.y > t.y - 3 && p.y < t.bottom() + 3;
}

/// Of nine places in the frame the one where a legend of this size hides least: corners first, the
/// upper right before the others.
Box best_place(const Box& size, const Box& frame, const std::vector<Point>& seen,
               const std::vector<Box>& taken) {
  const double m = 8,
               xs[3] = {frame.right() - size.w - m, frame.x + m, frame.x + (frame.w - size.w) / 2};
  const double ys[3] = {frame.y + m, frame.bottom() - size.h - m, frame.y + (frame.h - size.h) / 2};
  double least = infinity;
  Box best = size;
  for (int iy = 0; iy < 3; ++iy)
    for (int ix = 0; ix < 3; ++ix) {
      if (ix == 2 && iy == 2) continue;
      const Box t{xs[ix], ys[iy], size.w, size.h};
      double inside = 0;
      for (const Point& p : seen)
        inside += covers(t, p) ? 1 : 0;
      double cost = 0.002 * (3 * iy + ix) + (inside > 0 ? 0.1 : 0.0) +
                    inside / (1.0 + static_cast<double>(seen.size()));
      for (const Box& o : taken)
        cost += t.overlaps(o) ? 2 : 0;
      if (cost < least) {
        least = cost;
        best = t;
      }
    }
  return best;
}

void rectangle(Canvas& c, const Box& b) {
  c.attr("x", b.x);
  c.attr("y", b.y);
  c.attr("width", b.w);
  c.attr("height", b.h);
}

/// y: middle of its row.
void draw_entry(Canvas& c, const LegendEntry& e, const Box& b, double y) {
  c.add("<g class=\"entry\" data-s=\"" + std::to_string(e.series) +
        "\"><rect fill=\"transparent\"");
  rectangle(c, {b.x, y - row / 2, b.w, row});
  c.add("/>");
  const double x0 = b.x + pad, x1 = x0 + sample;
  if (e.patch || e.bar) {
    c.add("<rect");
    rectangle(c, {x0 + 4, y - 5, sample - 8, 10});
    c.add(" " + fill(e.color) + (e.patch ? " fill-opacity=\"0.4\"" : "") + "/>");
  } else {
    if (e.style.width > 0) c.line(x0, y, x1, y, stroke(e.color, e.style.width, e.style.dash));
    if (e.style.marker != Marker::none) {
      Style s = e.style;
      s.marker_size = std::min(s.marker_size, 7.0);
      draw_pins(c, {(x0 + x1) / 2}, {y}, s, e.color, e.series, false, " data-legend=\"1\"");
    }
  }
  c.text_within(b.right() - x1 - 6, x1 + 6, y + 4, e.label, legend_size, "start");
  c.add("</g>\n");
}

}  // namespace

bool legend_hides(const std::vector<LegendEntry>& entries, const Box& frame,
                  const std::vector<Point>& seen, const std::vector<Box>& taken) {
  if (entries.empty()) return false;
  const Box best = best_place(legend_size_of(entries), frame, seen, taken);
  return std::any_of(seen.begin(), seen.end(), [&](const Point& p) { return covers(best, p); }) ||
         std::any_of(taken.begin(), taken.end(), [&](const Box& b) { return best.overlaps(b); });
}

void draw_legend(Canvas& c, const std::vector<LegendEntry>& entries, const Box& frame,
                 const std::vector<Point>& seen, const std::vector<Box>& taken, const Box& outside,
                 double width) {
  if (entries.empty()) return;
  Box b = legend_size_of(entries, width);
  if (outside.w > 0) {
    b.x = outside.x;
    b.y = outside.y;
  } else
    b = best_place(b, frame, seen, taken);
  c.add("<g class=\"legend\"><rect rx=\"3\"");
  rectangle(c, b);
  c.add(
      " class=\"fp cg\" fill=\"#ffffff\" fill-opacity=\"0.88\" stroke=\"#d9d9d9\" "
      "stroke-width=\"0.7\"/>\n");
  const std::size_t columns = columns_of(entries, width);
  const double each = b.w / static_cast<double>(columns), first = b.y + pad + row / 2 - 2;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::size_t line = i / columns;
    const Box column{b.x + each * static_cast<double>(i % columns), b.y, each, b.h};
    draw_entry(c, entries[i], column, first + row * static_cast<double>(line));
  }
  c.add("</g>\n");
}

}  // namespace whirl::plot::svg
