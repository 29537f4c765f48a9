#include <plot/decimate.hpp>
#include <plot/palette.hpp>
#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>

namespace whirl::plot::svg {

double Scale::operator()(double v) const {
  if (!log) return p0 + (v - lo) / (hi - lo) * (p1 - p0);
  return v > 0 ? p0 + std::log(v / lo) / std::log(hi / lo) * (p1 - p0) : nan;
}

void Canvas::attr(const char* name, double v) {
  out += ' ';
  out += name;
  out += "=\"";
  append_number(out, v);
  out += '"';
}

void Canvas::text(double x, double y, std::string_view content, double size, const char* anchor,
                  std::string_view extra) {
  out += "<text";
  attr("x", x);
  attr("y", y);
  attr("font-size", size);
  if (std::string_view(anchor) != "start") out += std::string(" text-anchor=\"") + anchor + '"';
  out += " " + fill(ink);
  if (!extra.empty()) {
    out += " ";
    out += extra;
  }
  out += '>';
  out += escape(content);
  out += "</text>";
}

void Canvas::line(double x0, double y0, double x1, double y1, std::string_view rest) {
  out += "<line";
  attr("x1", x0);
  attr("y1", y0);
  attr("x2", x1);
  attr("y2", y1);
  out += ' ';
  out += rest;
  out += "/>";
}

void Canvas::text_within(double width, double x, double y, std::string_view content, double size,
                         const char* anchor, std::string_view extra) {
  const double wanted = wide_fonts * text_width(content, size);
  text(x, y, content, size * std::clamp(width / std::max(1.0, wanted), 0.65, 1.0), anchor, extra);
}

void Canvas::lines(const std::vector<Segment>& all, std::string_view rest) {
  if (options.standalone) {
    for (const Segment& s : all)
      line(s.x0, s.y0, s.x1, s.y1, rest);
    return;
  }
  if (all.empty()) return;
  out += "<path ";
  out += rest;
  out += " d=\"";
  for (const Segment& s : all) {
    out += 'M';
    append_number(out, s.x0, 1);
    out += ' ';
    append_number(out, s.y0, 1);
    out += s.y0 == s.y1 ? 'H' : s.x0 == s.x1 ? 'V' : 'L';
    if (s.y0 == s.y1 || s.x0 != s.x1) append_number(out, s.x1, 1);
    if (s.y0 != s.y1 && s.x0 != s.x1) out += ' ';
    if (s.y0 != s.y1) append_number(out, s.y1, 1);
  }
  out += "\"/>";
}

namespace {

/// What a scale of a second drawing makes of px of the first: factor and offset.
struct Stretch {
  double factor = 1, offset = 0;
  bool is(const Stretch& o) const {
    return std::abs(factor - o.factor) < 1e-3 && std::abs(offset - o.offset) < 0.2;
  }
};

Stretch stretch(const Scale& from, const Scale& to) {
  Stretch s;
  s.factor = (to(from.hi) - to(from.lo)) / (from.p1 - from.p0);
  s.offset = to(from.lo) - s.factor * from.p0;
  return s;
}

}  // namespace

PlotGroup::PlotGroup(Canvas& c, const Scale& x, const Scale& y, const Scale& right) : c_(c) {
  c.add("<g class=\"plot\"");
  if (c.drawn && !c.narrow) {
    c.drawn->push_back({c.id(), x, y, right});
    c.add(" id=\"" + c.drawn->back().id + "\"");
  }
  c.add(">\n");
  from_ = c.out.size();
  if (!c.narrow || !c.drawn || c.plots >= c.drawn->size()) return;
  const DrawnPlot& first = (*c.drawn)[c.plots++];
  const Stretch sx = stretch(first.x, x), sy = stretch(first.y, y);
  if (!sy.is(stretch(first.right, right))) return;
  repeated_ = "<use class=\"again\" href=\"#" + first.id + "\" transform=\"matrix(" +
              number_text(sx.factor, 5) + " 0 0 " + number_text(sy.factor, 5) + ' ' +
              number_text(sx.offset) + ' ' + number_text(sy.offset) + ")\"/>\n";
}

void PlotGroup::end() {
  if (!repeated_.empty()) {
    c_.out.resize(from_);
    c_.add(repeated_);
  }
  c_.add("</g>\n");
}

namespace {

std::string color_class(char kind, int color) {
  return color == ink     ? std::string(1, kind) + "i"
         : color == faint ? std::string(1, kind) + "g"
                          : kind + std::to_string(color % palette_size);
}
const char* color_value(int color) {
  return color == ink     ? ink_light
         : color == faint ? grid_light
                          : palette_light[static_cast<std::size_t>(color % palette_size)];
}

}  // namespace

std::string stroke(int color, double width, Dash dash) {
  if (dash == Dash::solid && color >= palette_size)  // a colour met before
    dash = color < 2 * palette_size ? Dash::dashed : Dash::dotted;
  std::string s = "class=\"" + color_class('c', color) + "\" stroke=\"" + color_value(color) +
                  "\" fill=\"none\"";
  if (width > 0) s += " stroke-width=\"" + number_text(width) + '"';
  const double w = std::max(width, 1.0);
  const auto dashes = [&](std::initializer_list<double> d) {
    s += " stroke-dasharray=\"";
    for (const double x : d)
      s += number_text(x * w) + (x == *(d.end() - 1) ? "" : " ");
    s += '"';
  };
  switch (dash) {
    case Dash::solid: break;
    case Dash::dashed: dashes({4, 2.5}); break;
    case Dash::dotted: dashes({1, 2}); break;
    case Dash::dash_dot: dashes({5, 2, 1, 2.2}); break;
  }
  return s;
}

std::string fill(int color) {
  return "class=\"" + color_class('f', color) + "\" fill=\"" + color_value(color) + '"';
}
std::string paper_fill() { return std::string("class=\"fp\" fill=\"") + paper_light + '"'; }

Colors resolve_colors(const Axes& a) {
  Colors k;
  int next = 0;
  const auto pick = [&](const Style& s) { return s.color == next_color ? next++ : s.color; };
  for (const auto& s : a.series)
    k.series.push_back(pick(s.style));
  for (const auto& s : a.bars)
    k.bars.push_back(pick(s.style));
  for (const auto& s : a.patches)
    k.patches.push_back(pick(s.style));
  for (const auto& s : a.space)
    k.space.push_back(pick(s.style));
  return k;
}

std::string axis_title(const Axis& a, int exponent) {
  if (a.unit.empty() && exponent == 0) return a.label;
  std::string unit = a.unit.empty() ? "-" : a.unit;
  if (exponent != 0)
    unit = power_of_ten(exponent) + (a.unit == "-" || a.unit.empty() ? "" : " " + a.unit);
  return a.label.empty() ? "[" + unit + "]" : a.label + " [" + unit + "]";
}

void axis_attributes(Canvas& c, const char* name, const Axis& a, const Scale& s) {
  char b[128];
  std::snprintf(b, sizeof b, " data-%s=\"%.17g %.17g %d\"", name, s.lo, s.hi, s.log ? 1 : 0);
  c.add(b);
  c.add(std::string(" data-") + name + "l=\"" + escape(a.label) + "\" data-" + name + "u=\"" +
        escape(a.unit == "-" ? "" : a.unit) + '"');
}

namespace {

/// A point of a curve, and where `joined` the way to it in steps of a few px: texts keep clear of it.
void see(std::vector<Point>& seen, const Point& p, bool joined) {
  constexpr double step = 6;
  if (joined && !seen.empty()) {
    const Point from = seen.back();
    const double length = std::hypot(p.x - from.x, p.y - from.y);
    const int parts = length < 4000 ? static_cast<int>(length / step) : 0;
    for (int k = 1; k < parts; ++k)
      seen.push_back({from.x + (p.x - from.x) * k / parts, from.y + (p.y - from.y) * k / parts});
  }
  seen.push_back(p);
}

}  // namespace

namespace {

/// Writes a path point by point.
class PathText {
 public:
  PathText(bool by_differences, std::vector<Point>* seen)
      : by_differences_(by_differences),
        seen_(seen) {}
  void put(double x, double y);
  /// Ends a piece.
  void lift() {
    put_waiting();
    if (run_ == 1) text_ += "h0";  // a lone point: visible with round caps
    run_ = 0;
  }
  std::string take() {
    lift();
    return std::move(text_);
  }

 private:
  void put_tenths(long tenths, bool first);
  void put_waiting();
  void put_difference(long x, long y);

  bool by_differences_;
  std::vector<Point>* seen_;
  std::string text_;
  std::size_t run_ = 0, written_ = 0;  ///< points of this piece; of them in the text
  long x_ = 0, y_ = 0;                 ///< tenths of a px, of the last point written
  std::optional<long> waiting_{};  ///< x of a point as high as that one, perhaps not the last such
};

/// Without what a reader does not need: "-.5" after a number needs no blank.
void PathText::put_tenths(long tenths, bool first) {
  const long size = std::abs(tenths);
  std::array<char, 24> written;
  char* end = written.data();
  if (tenths < 0)
    *end++ = '-';
  else if (!first)
    *end++ = ' ';
  if (size >= 10 || size == 0) end = std::to_chars(end, end + 20, size / 10).ptr;
  if (size % 10 != 0) {
    *end++ = '.';
    *end++ = static_cast<char>('0' + size % 10);
  }
  text_.append(written.data(), end);
}

void PathText::put_waiting() {
  if (!waiting_) return;
  const long x = *waiting_;
  waiting_.reset();
  put_tenths(x - x_, written_ < 2);
  put_tenths(0, false);
  ++written_;
  x_ = x;
}

/// Of a level stretch, as the floor of a spectrum, only the ends.
void PathText::put_difference(long x, long y) {
  if (run_ == 0) {
    text_ += 'M';
    put_tenths(x, true);
    put_tenths(y, false);
    written_ = 1;
    x_ = x;
    y_ = y;
    return;
  }
  if (run_ == 1) text_ += 'l';
  const bool goes_on = !waiting_ || (*waiting_ >= x_ && x >= *waiting_);
  if (y == y_ && goes_on) {
    waiting_ = x;
    return;
  }
  put_waiting();
  put_tenths(x - x_, written_ < 2);
  put_tenths(y - y_, false);
  ++written_;
  x_ = x;
  y_ = y;
}

void PathText::put(double x, double y) {
  if (std::isnan(x) || std::isnan(y)) return lift();
  // Far outside the frame: renderers have limits.
  x = std::clamp(x, -1e5, 1e5);
  y = std::clamp(y, -1e5, 1e5);
  if (by_differences_)
    put_difference(std::lround(10 * x), std::lround(10 * y));
  else {
    text_ += run_ == 0 ? "M" : run_ == 1 ? "L" : " ";
    append_number(text_, x);
    text_ += ' ';
    append_number(text_, y);
  }
  ++run_;
  if (seen_) see(*seen_, {x, y}, run_ > 1);
}

}  // namespace

std::string path_of(const std::vector<double>& px, const std::vector<double>& py, bool keep_all,
                    bool increasing, const SvgOptions& options, std::vector<Point>* seen) {
  const bool whole = keep_all || px.size() < 500;
  PathText text(!keep_all && px.size() >= 24 && !options.standalone, seen);
  if (whole) {
    for (std::size_t i = 0; i < px.size(); ++i)
      text.put(px[i], py[i]);
    return text.take();
  }
  if (!increasing) {
    for (const auto& piece : decimate_path(px, py, 0.5 / std::max(1.0, options.columns_per_px))) {
      for (const auto i : piece)
        text.put(px[i], py[i]);
      text.lift();
    }
    return text.take();
  }
  double lo = infinity, hi = -infinity;
  for (const double x : px)
    if (!std::isnan(x)) {
      lo = std::min(lo, x);
      hi = std::max(hi, x);
    }
  if (!(hi > lo)) hi = lo + 1;
  const auto n = static_cast<std::size_t>(std::max(1.0, options.columns_per_px * (hi - lo)));
  for (const auto i : decimate_columns(px, py, lo, hi, n))
    text.put(px[i], py[i]);
  return text.take();
}

void draw_pins(Canvas& c, const std::vector<double>& px, const std::vector<double>& py,
               const Style& style, int color, int series, bool right, std::string_view rest,
               const Box* clip) {
  const std::string id = c.id();
  const double r = style.marker_size / 2;
  std::string shape;
  const auto n = [&](double k) { return number_text(k * r); };
  switch (style.marker) {
    case Marker::none: return;
    case Marker::circle: shape = "<circle r=\"" + n(1) + "\"/>"; break;
    case Marker::square:
      shape = "<path d=\"M" + n(-0.9) + " " + n(-0.9) + "H" + n(0.9) + "V" + n(0.9) + "H" +
              n(-0.9) + "Z\"/>";
      break;
    case Marker::diamond:
      shape = "<path d=\"M0 " + n(-1.25) + "L" + n(1.25) + " 0 0 " + n(1.25) + " " + n(-1.25) +
              " 0Z\"/>";
      break;
    case Marker::triangle:
      shape = "<path d=\"M0 " + n(-1.2) + "L" + n(1.1) + " " + n(0.8) + " " + n(-1.1) + " " +
              n(0.8) + "Z\"/>";
      break;
    case Marker::cross:
      shape = "<path d=\"M" + n(-0.9) + " " + n(-0.9) + "L" + n(0.9) + " " + n(0.9) + "M" +
              n(-0.9) + " " + n(0.9) + "L" + n(0.9) + " " + n(-0.9) + "\"/>";
      break;
    case Marker::plus:
      shape = "<path d=\"M" + n(-1.1) + " 0H" + n(1.1) + "M0 " + n(-1.1) + "V" + n(1.1) + "\"/>";
      break;
  }
  c.add("<defs><g id=\"" + id + "\">" + shape + "</g></defs>");
  c.add("<g data-s=\"" + std::to_string(series) + "\" data-pins=\"1\"" +
        (right ? " data-right=\"1\"" : "") + std::string(rest) + ">");
  const bool open = style.marker == Marker::cross || style.marker == Marker::plus;
  const std::string paint = open           ? stroke(color, 1.5)
                            : style.filled ? fill(color)
                                           : stroke(color, 1.4);
  std::string inner = paint;
  if (!open && !style.filled) {  // hollow markers hide the line behind them
    const auto at = inner.find("fill=\"none\"");
    inner.replace(at, 11, std::string("fill=\"") + paper_light + '"');
    inner.insert(inner.find("class=\"") + 7, "hp ");
  }
  c.add("<g " + inner + ">");
  for (std::size_t i = 0; i < px.size(); ++i) {
    if (std::isnan(px[i]) || std::isnan(py[i])) continue;
    if (clip && (px[i] < clip->x - 0.5 || px[i] > clip->right() + 0.5 || py[i] < clip->y - 0.5 ||
                 py[i] > clip->bottom() + 0.5))
      continue;
    c.add("<use href=\"#" + id + "\"");
    c.attr("x", px[i]);
    c.attr("y", py[i]);
    c.add("/>");
  }
  c.add("</g></g>\n");
}

}  // namespace whirl::plot::svg
