#include <plot/decimate.hpp>
#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot::svg {
Ticks axis_ticks(const Axis& a, const Scale& s, double length, double spacing) {
  Ticks t;
  if (!a.ticks.empty()) {
    t = fixed_ticks(a.ticks);
    if (!a.tick_labels.empty()) {
      t.labels = a.tick_labels;
      t.labels.resize(t.major.size());
      t.exponent = 0;
    }
    return t;
  }
  const double target = std::clamp(length / spacing, length >= 140 ? 3.0 : 2.0, 10.0);
  if (s.log) return log_ticks(s.lo, s.hi, target);
  constexpr double few = 45.0;  // degrees, of which one multiple of 15 or two would be ticks
  if ((a.unit == "°" || a.unit == "deg") && s.hi - s.lo >= few) return angle_ticks(s.lo, s.hi);
  return linear_ticks(s.lo, s.hi, target);
}

double widest_label(const Ticks& t) {
  double w = 0;
  for (const auto& l : t.labels)
    w = std::max(w, wide_fonts * text_width(l, tick_size));
  return w;
}

namespace {

constexpr double colorbar = 100, tick_length = 4;

struct Range {
  double lo = infinity, hi = -infinity;
  bool log = false;
  void add(double v) {
    if (std::isfinite(v) && (!log || v > 0)) {
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
  }
  void add(const std::vector<double>& v) {
    for (const double x : v)
      add(x);
  }
};

// Margins around data, then what the axis fixes.
void finish(const Range& r, const Axis& a, double pad, Scale& s) {
  double lo = r.lo, hi = r.hi;
  s.log = a.logarithmic;
  if (!(lo <= hi)) {
    lo = s.log ? 0.1 : 0;
    hi = s.log ? 10 : 1;
  }  // nothing to show
  if (a.include_zero && !s.log) {
    lo = std::min(lo, 0.0);
    hi = std::max(hi, 0.0);
  }
  if (s.log) {
    if (hi < lo * 1.001) {
      lo /= 2;
      hi *= 2;
    }
    const double f = std::pow(hi / lo, pad);
    lo /= f;
    hi *= f;
  } else {
    double span = hi - lo;
    const double size = std::max(std::abs(lo), std::abs(hi));
    if (span <= 1e-12 * size) {
      span = size > 0 ? 0.2 * size : 1;
      lo -= span / 2;
      hi += span / 2;
    }  // constant
    // Zero stays at the edge when the data end there, but for rounding.
    constexpr double rounding = 1e-9;
    if (std::abs(lo) < rounding * hi) lo = 0.0;
    if (std::abs(hi) < -rounding * lo) hi = 0.0;
    if (lo != 0.0 || !a.include_zero) lo -= pad * span;
    if (hi != 0.0 || !a.include_zero) hi += pad * span;
  }
  if (!std::isnan(a.min)) lo = a.min;
  if (!std::isnan(a.max)) hi = a.max;
  if (!(hi > lo)) hi = s.log ? lo * 10 : lo + 1;
  s.lo = lo;
  s.hi = hi;
}

bool has_right(const Axes& a) {
  return std::any_of(a.series.begin(), a.series.end(),
                     [](const Series& s) { return s.right_axis; }) ||
         std::any_of(a.bars.begin(), a.bars.end(), [](const Bars& s) { return s.right_axis; });
}

/// A band at the top, of the height given, without data.
void make_room(Scale& s, double band, double height) {
  const double more = band / (height - band);
  if (s.log)
    s.hi *= std::pow(s.hi / s.lo, more);
  else
    s.hi += more * (s.hi - s.lo);
}

Prepared place(const DataScales& data, const Axes& a, const Box& b) {
  Prepared p{data.x, data.y, data.right, {}, {}, {}};
  p.x.p0 = b.x;
  p.x.p1 = b.right();
  p.y.p0 = p.r.p0 = b.bottom();
  p.y.p1 = p.r.p1 = b.y;
  if (a.equal_aspect) {  // the tighter direction rules; the other range grows about its centre
    const double ux = (p.x.hi - p.x.lo) / b.w, uy = (p.y.hi - p.y.lo) / b.h, u = std::max(ux, uy);
    const double cx = (p.x.lo + p.x.hi) / 2, cy = (p.y.lo + p.y.hi) / 2;
    p.x.lo = cx - u * b.w / 2;
    p.x.hi = cx + u * b.w / 2;
    p.y.lo = cy - u * b.h / 2;
    p.y.hi = cy + u * b.h / 2;
  }
  const double band = std::min(names_height(a, p.x, b), 0.45 * b.h);
  if (std::isnan(a.y.max)) make_room(p.y, band, b.h);
  if (std::isnan(a.right.max)) make_room(p.r, band, b.h);
  // With equal aspect both directions get the same step.
  p.tx = axis_ticks(a.x, p.x, b.w, a.equal_aspect ? 68 : 90);
  p.ty = axis_ticks(a.y, p.y, b.h, a.equal_aspect ? 68 : 48);
  if (has_right(a)) p.tr = axis_ticks(a.right, p.r, b.h, 48);
  return p;
}

/// Points of the curves about 6 px apart, of long ones as many as tell where they are.
void look_over(const Axes& a, const Prepared& p, std::vector<Point>& seen) {
  constexpr std::size_t most = 2000;
  for (const Series& s : a.series) {
    const Scale& scale = s.right_axis ? p.r : p.y;
    const std::size_t n = std::min(s.x.size(), s.y.size()), stride = n / most + 1;
    Point last{nan, nan};
    for (std::size_t i = 0; i < n; i += stride) {
      const Point q{p.x(s.x[i]), scale(s.y[i])};
      const bool joined = stride == 1 && s.style.width > 0;
      const double way = joined ? std::hypot(q.x - last.x, q.y - last.y) : 0.0;
      const int parts = way < 4000 ? static_cast<int>(way / 6) : 0;
      for (int k = 1; k < parts; ++k)
        seen.push_back({last.x + (q.x - last.x) * k / parts, last.y + (q.y - last.y) * k / parts});
      if (std::isfinite(q.x) && std::isfinite(q.y)) seen.push_back(q);
      last = q;
    }
  }
}

void draw_grid(Canvas& c, const Prepared& p, const Box& b) {
  const std::string s = stroke(faint, 0.8);
  std::vector<Segment> upright, level;
  for (const double v : p.tx.major)
    upright.push_back({p.x(v), b.y, p.x(v), b.bottom()});
  for (const double v : p.ty.major)
    level.push_back({b.x, p.y(v), b.right(), p.y(v)});
  c.add("<g class=\"gx\">");
  c.lines(upright, s);
  c.add("</g><g class=\"gy\">");
  c.lines(level, s);
  c.add("</g>\n");
}

/// A tick and its label beside or below an axis.
struct TickText {
  double x, y;
  const std::string* label;
};

void draw_tick_texts(Canvas& c, const std::vector<TickText>& all, const char* anchor) {
  const bool page = !c.options.standalone;
  if (all.empty()) return;
  if (page) {  // said once
    c.add("<g font-size=\"" + number_text(tick_size) + "\" text-anchor=\"" + anchor + "\" " +
          fill(ink) + ">");
  }
  for (const TickText& t : all) {
    if (!page) {
      c.text(t.x, t.y, *t.label, tick_size, anchor);
      continue;
    }
    c.add("<text x=\"" + number_text(t.x, 1) + "\" y=\"" + number_text(t.y, 1) + "\">" +
          escape(*t.label) + "</text>");
  }
  if (page) c.add("</g>");
}

/// Below the frame; labels that would touch the one before are left out.
void draw_x_ticks(Canvas& c, const Prepared& p, const Box& b, bool labels) {
  std::vector<Segment> marks;
  std::vector<TickText> texts;
  double taken = -infinity;
  for (std::size_t k = 0; k < p.tx.major.size(); ++k) {
    const double x = p.x(p.tx.major[k]);
    if (x < b.x - 0.5 || x > b.right() + 0.5) continue;
    marks.push_back({x, b.bottom(), x, b.bottom() + tick_length});
    const double half = text_width(p.tx.labels[k], tick_size) / 2;
    if (!labels || x - half < taken + 3) continue;
    taken = x + half;
    texts.push_back({x, b.bottom() + tick_length + 12.5, &p.tx.labels[k]});
  }
  for (const double v : p.tx.minor)
    marks.push_back({p.x(v), b.bottom(), p.x(v), b.bottom() + 2.5});
  c.lines(marks, stroke(ink, 0.9));
  draw_tick_texts(c, texts, "middle");
}

/// Beside the frame.
void draw_y_ticks(Canvas& c, const Ticks& ticks, const Scale& scale, const Box& b, bool right) {
  const double x = right ? b.right() : b.x, out = right ? 1 : -1;
  std::vector<Segment> marks;
  std::vector<TickText> texts;
  for (std::size_t k = 0; k < ticks.major.size(); ++k) {
    const double y = scale(ticks.major[k]);
    if (y < b.y - 0.5 || y > b.bottom() + 0.5) continue;
    marks.push_back({x, y, x + out * tick_length, y});
    texts.push_back({x + out * (tick_length + 3), y + 4, &ticks.labels[k]});
  }
  if (!right)
    for (const double v : ticks.minor)
      marks.push_back({x - 2.5, scale(v), x, scale(v)});
  c.lines(marks, stroke(ink, 0.9));
  draw_tick_texts(c, texts, right ? "start" : "end");
}

void draw_ticks(Canvas& c, const Axes& a, const Prepared& p, const Box& b, const CartesianFlags& f,
                bool right) {
  c.add("<g class=\"tx\">");
  draw_x_ticks(c, p, b, !f.hide_x);
  c.add("</g><g class=\"ty\">");
  draw_y_ticks(c, p.ty, p.y, b, false);
  c.add("</g>");
  if (right) {
    c.add("<g class=\"tr\">");
    draw_y_ticks(c, p.tr, p.r, b, true);
    c.add("</g>");
  }
  c.add("\n<rect class=\"frame ci\" fill=\"none\" stroke=\"#222222\" stroke-width=\"0.9\"");
  c.attr("x", b.x);
  c.attr("y", b.y);
  c.attr("width", b.w);
  c.attr("height", b.h);
  c.add("/>\n");
  if (!f.hide_x)
    c.text_within(b.w + 40, b.x + b.w / 2, b.bottom() + tick_length + 31,
                  axis_title(a.x, p.tx.exponent), label_size, "middle", "data-label=\"x\"");
  const auto sideways = [&](double x, double y, const std::string& t, const char* which) {
    // A title longer than its axis is set smaller.
    const double least = c.narrow ? 0.5 : 0.7;
    const double beyond = c.narrow ? 8 : 24;  // the legend of a narrow drawing is below the frame
    const double wide = std::max(1.0, wide_fonts * text_width(t, label_size));
    const double size = label_size * std::clamp((b.h + beyond) / wide, least, 1.0);
    c.text(x, y, t, size, "middle",
           "data-label=\"" + std::string(which) + "\" transform=\"rotate(-90 " + number_text(x) +
               " " + number_text(y) + ")\"");
  };
  sideways(b.x - tick_length - 10 - widest_label(p.ty), b.y + b.h / 2,
           axis_title(a.y, p.ty.exponent), "y");
  if (right)
    sideways(b.right() + tick_length + 18 + widest_label(p.tr), b.y + b.h / 2,
             axis_title(a.right, p.tr.exponent), "r");
}

/// Points over the extent of every body, a patch with an outline, for what shall not hide one.
void add_bodies(const Axes& a, const Prepared& p, std::vector<Point>& seen) {
  constexpr double apart = 8;  // px
  for (const Patch& s : a.patches) {
    if (s.style.width <= 0) continue;
    double x0 = infinity, x1 = -infinity, y0 = infinity, y1 = -infinity;
    for (std::size_t i = 0; i < s.x.size() && i < s.y.size(); ++i) {
      const double x = p.x(s.x[i]), y = p.y(s.y[i]);
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
    if (!(x0 <= x1) || !(y0 <= y1)) continue;
    const int nx = 1 + static_cast<int>((x1 - x0) / apart),
              ny = 1 + static_cast<int>((y1 - y0) / apart);
    for (int i = 0; i <= nx; ++i)
      for (int j = 0; j <= ny; ++j)
        seen.push_back({std::lerp(x0, x1, 1.0 * i / nx), std::lerp(y0, y1, 1.0 * j / ny)});
  }
}

}  // namespace

DataScales data_range(const Axes& a) {
  Range rx, ry, rr;
  rx.log = a.x.logarithmic;
  ry.log = a.y.logarithmic;
  rr.log = a.right.logarithmic;
  bool loose = !a.bars.empty() || !a.patches.empty() || a.equal_aspect;
  for (const auto& s : a.series) {
    rx.add(s.x);
    (s.right_axis ? rr : ry).add(s.y);
    loose = loose || s.style.width <= 0 || s.style.marker != Marker::none || !is_increasing(s.x);
  }
  for (const auto& s : a.bars) {
    for (const double v : s.x) {
      rx.add(v - s.width / 2);
      rx.add(v + s.width / 2);
    }
    (s.right_axis ? rr : ry).add(s.height);
    (s.right_axis ? rr : ry).add(0.0);
  }
  for (const auto& s : a.patches) {
    rx.add(s.x);
    ry.add(s.y);
  }
  for (const auto& h : a.heat) {
    rx.add(h.x0);
    rx.add(h.x1);
    ry.add(h.y0);
    ry.add(h.y1);
  }
  // Histories run from edge to edge; clouds, loops and drawings get air.
  DataScales out;
  finish(rx, a.x, loose ? 0.04 : 0.0, out.x);
  finish(ry, a.y, a.heat.empty() ? 0.06 : 0.0, out.y);
  finish(rr, a.right, 0.06, out.right);
  return out;
}

namespace {

Margins margins_about(const Axes& a, const Prepared& p, const CartesianFlags& f) {
  Margins m;
  m.left = widest_label(p.ty) + tick_length + 3 + 24;
  m.bottom = f.hide_x ? 8 : 42;
  m.top = a.title.empty() ? 8 : 26;
  m.right = std::max(14.0, p.tx.labels.empty() || f.hide_x
                               ? 0.0
                               : text_width(p.tx.labels.back(), tick_size) / 2 + 4);
  if (has_right(a)) m.right = widest_label(p.tr) + tick_length + 30;
  if (!a.heat.empty()) m.right = colorbar;
  return m;
}

}  // namespace

Margins cartesian_margins(const Axes& a, const DataScales& data, double width, double height,
                          CartesianFlags& f) {
  Prepared p = place(data, a, {0, 0, std::max(50.0, width - 90), std::max(40.0, height - 60)});
  const Margins first = margins_about(a, p, f);
  const auto entries = legend_entries(a, resolve_colors(a));
  const Box size = legend_size_of(entries, f.legend_width);
  if (f.legend_width > 0) {
    Margins m = first;
    if (!entries.empty()) m.bottom += size.h + 4;
    return m;
  }
  const auto frame_beside = [&](const Margins& m, double legend) {
    return Box{m.left, m.top, std::max(50.0, width - m.left - m.right - legend),
               std::max(40.0, height - m.top - m.bottom)};
  };
  const Box frame = frame_beside(first, 0);
  p = place(data, a, frame);
  std::vector<Point> seen;
  look_over(a, p, seen);
  add_bodies(a, p, seen);
  std::vector<Box> names;
  for (const RuleName& name : places_of_names(a, p.x, p.y, frame))
    names.push_back(name.at);
  f.legend_outside =
      entries.size() > 8 || size.h > 0.6 * height || legend_hides(entries, frame, seen, names);
  const double legend = f.legend_outside ? size.w + 6 : 0.0;
  p = place(data, a, frame_beside(first, legend));
  Margins m = margins_about(a, p, f);
  m.left = std::max(m.left, first.left);
  m.right = std::max(m.right, first.right) + legend;
  return m;
}

NotePlan plan_notes(const Axes& a, const DataScales& data, const Box& frame) {
  if (a.notes.empty() && a.rules.empty()) return {};
  const Prepared p = place(data, a, frame);
  std::vector<Point> seen;
  look_over(a, p, seen);
  add_bodies(a, p, seen);
  return place_notes(a, p, frame, seen);
}

double left_margin(const Axes& a, const DataScales& data, const Box& frame) {
  return margins_about(a, place(data, a, frame), {}).left;
}

namespace {

/// What the script reads, the title, and the path that clips the curves, whose id is returned.
std::string begin_cartesian(Canvas& c, const Axes& a, const Prepared& p, const Box& b,
                            const CartesianFlags& f) {
  c.add("<g class=\"axes\" data-kind=\"xy\" data-box=\"" + number_text(b.x) + " " +
        number_text(b.y) + " " + number_text(b.w) + " " + number_text(b.h) + '"');
  axis_attributes(c, "x", a.x, p.x);
  axis_attributes(c, "y", a.y, p.y);
  if (has_right(a)) axis_attributes(c, "r", a.right, p.r);
  if (a.equal_aspect) c.add(" data-equal=\"1\"");
  if (a.share_x) c.add(" data-share=\"1\"");
  if (f.hide_x) c.add(" data-hidex=\"1\"");
  if (!a.x.tick_labels.empty()) c.add(" data-fixed=\"1\"");
  c.add(">\n");
  if (!a.title.empty())
    c.text_within(c.narrow ? narrow_width - b.x - 2 : infinity, b.x, b.y - 9, a.title, title_size,
                  "start", "font-weight=\"600\"");
  std::string clip = c.id();
  c.add("<clipPath id=\"" + clip + "\"><rect");
  c.attr("x", b.x);
  c.attr("y", b.y);
  c.attr("width", b.w);
  c.attr("height", b.h);
  c.add("/></clipPath>\n");
  return clip;
}

/// Below the frame: the legend of a narrow drawing, and the key.
void draw_below(Canvas& c, const std::vector<LegendEntry>& entries, const Box& b,
                const CartesianFlags& f) {
  double y = b.bottom() + (f.hide_x ? 6 : 40);
  if (f.legend_width > 0 && !entries.empty()) {
    const Box size = legend_size_of(entries, f.legend_width);
    const Box legend{4, y, size.w, size.h};
    draw_legend(c, entries, legend, {}, {}, legend, f.legend_width);
    y += size.h + 4;
  }
  if (f.legend_width > 0)
    draw_key(c, f.notes, {8, y}, f.legend_width);
  else
    draw_key(c, f.notes, {b.x, y}, b.w);
}

}  // namespace

void draw_cartesian(Canvas& c, const Axes& a, const DataScales& data, const Box& b,
                    const CartesianFlags& f) {
  const Colors k = resolve_colors(a);
  const Prepared p = place(data, a, b);
  const bool right = has_right(a);
  const std::string clip = begin_cartesian(c, a, p, b, f);
  draw_grid(c, p, b);
  std::vector<Point> seen;
  std::vector<PinJob> pins;
  std::vector<Box> taken;
  const auto entries = legend_entries(a, k);
  c.add("<g clip-path=\"url(#" + clip + ")\">");
  PlotGroup plot(c, p.x, p.y, right ? p.r : p.y);
  // a legend below the frame hides nothing: what is seen is not asked for
  const bool again = plot.repeats() && f.legend_width > 0;
  if (!again) {
    if (!a.heat.empty()) draw_heat(c, a.heat.front(), p);
    draw_bars_and_patches(c, a, k, p);
    draw_rules(c, a, p, b);
  }
  draw_series(c, a, k, p, seen, pins, again);
  plot.end();
  c.add("<g class=\"pins\">\n");
  for (const auto& job : pins)
    draw_pins(c, job.x, job.y, a.series[job.series].style, job.color, static_cast<int>(job.series),
              a.series[job.series].right_axis, job.attributes);
  std::vector<Point> lines;
  look_over(a, p, lines);
  draw_notes(c, a, p, b, f.notes, lines, taken);
  add_bodies(a, p, seen);
  c.add("</g></g>\n");
  draw_ticks(c, a, p, b, f, right);
  if (!a.heat.empty()) draw_color_bar(c, a.heat.front(), {b.right() + 14, b.y, 13, b.h});
  if (f.legend_width <= 0) {
    const double beside = right            ? widest_label(p.tr) + tick_length + 30
                          : a.heat.empty() ? 8
                                           : colorbar;
    const Box size = legend_size_of(entries);
    const Box outside{b.right() + beside, b.y, size.w, size.h};
    draw_legend(c, entries, b, seen, taken, f.legend_outside ? outside : Box{});
  }
  draw_below(c, entries, b, f);
  c.add("</g>\n");
}

}  // namespace whirl::plot::svg
