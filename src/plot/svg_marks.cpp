// What stands inside the frame of cartesian axes: maps, bars, patches, curves, markers, rules,
// notes.
#include <plot/decimate.hpp>
#include <plot/palette.hpp>
#include <plot/png.hpp>
#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace whirl::plot::svg {
namespace {

struct HeatScale {
  double lo, hi;
};
HeatScale heat_scale(const HeatMap& h) {
  double lo = infinity, hi = -infinity;
  for (const double v : h.values)
    if (std::isfinite(v) && (!h.logarithmic || v > 0)) {
      lo = std::min(lo, v);
      hi = std::max(hi, v);
    }
  if (!std::isnan(h.min)) lo = h.min;
  if (!std::isnan(h.max)) hi = h.max;
  if (!(hi > lo)) {
    lo = h.logarithmic ? 0.1 : 0;
    hi = lo + 1;
  }
  return {lo, hi};
}

void draw_image(Canvas& c, const std::string& png, const Box& at, std::string_view rest) {
  c.add("<image preserveAspectRatio=\"none\" style=\"image-rendering:pixelated\"");
  c.attr("x", at.x);
  c.attr("y", at.y);
  c.attr("width", at.w);
  c.attr("height", at.h);
  c.add(rest);
  c.add(" href=\"data:image/png;base64," + base64(png) + "\"/>\n");
}

}  // namespace

void draw_heat(Canvas& c, const HeatMap& h, const Prepared& p) {
  const auto [lo, hi] = heat_scale(h);
  const auto index = [&, lo = lo, hi = hi](double v) -> std::uint8_t {
    const double t =
        h.logarithmic ? (v > 0 ? std::log(v / lo) / std::log(hi / lo) : 0) : (v - lo) / (hi - lo);
    return std::isnan(t) ? 0
                         : static_cast<std::uint8_t>(std::lround(255 * std::clamp(t, 0.0, 1.0)));
  };
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(h.nx) * static_cast<std::size_t>(h.ny));
  const auto cell = [&h](int iy, int ix) {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(h.nx) +
           static_cast<std::size_t>(ix);
  };
  for (int iy = 0; iy < h.ny; ++iy)  // the picture starts at the top
    for (int ix = 0; ix < h.nx; ++ix)
      cells[cell(h.ny - 1 - iy, ix)] = index(h.values[cell(iy, ix)]);
  char range[160];
  std::snprintf(range, sizeof range, " data-heat=\"%d %d %.9g %.9g %d\"", h.nx, h.ny, lo, hi,
                h.logarithmic ? 1 : 0);
  draw_image(c, make_png(h.nx, h.ny, cells, color_map()),
             {p.x(h.x0), p.y(h.y1), p.x(h.x1) - p.x(h.x0), p.y(h.y0) - p.y(h.y1)},
             range + (" data-hl=\"" + escape(h.label) + "\" data-hu=\"" + escape(h.unit) + "\""));
}

void draw_color_bar(Canvas& c, const HeatMap& h, const Box& bar) {
  const auto [lo, hi] = heat_scale(h);
  std::vector<std::uint8_t> ramp(256);
  for (std::size_t k = 0; k < 256; ++k)
    ramp[k] = static_cast<std::uint8_t>(255 - k);
  draw_image(c, make_png(1, 256, ramp, color_map()), bar, "");
  const Scale s{lo, hi, h.logarithmic, bar.bottom(), bar.y};
  const Axis axis(h.label, h.unit, h.logarithmic);
  const Ticks t = axis_ticks(axis, s, bar.h, 48);
  for (std::size_t k = 0; k < t.major.size(); ++k) {
    c.line(bar.right(), s(t.major[k]), bar.right() + 3, s(t.major[k]), stroke(ink, 0.9));
    c.text(bar.right() + 6, s(t.major[k]) + 4, t.labels[k], tick_size);
  }
  const double x = bar.right() + 22 + widest_label(t), y = bar.y + bar.h / 2;
  c.text(x, y, axis_title(axis, t.exponent), label_size, "middle",
         "transform=\"rotate(-90 " + number_text(x) + " " + number_text(y) + ")\"");
}

namespace {

// Further values and names of the points, for the readout: only of points that the path has. Lists
// in an attribute: a line each, cells apart by tabs, both as character references, or XML would
// read them as blanks.
constexpr const char* next_line = "&#10;";
constexpr const char* next_cell = "&#9;";

std::string point_attributes(const Series& s, const std::vector<double>& px,
                             const std::vector<double>& py) {
  const auto drawn = [&](std::size_t i) {
    return i < px.size() && !std::isnan(px[i]) && !std::isnan(py[i]);
  };
  std::string extra;
  for (const Extra& e : s.extra) {
    if (!extra.empty()) extra += next_line;
    extra += escape(e.label) + next_cell + (e.unit == "-" ? "" : escape(e.unit));
    for (std::size_t i = 0; i < e.values.size(); ++i)
      if (drawn(i)) extra += next_cell + escape(readable(e.values[i], 5));
  }
  std::string names;
  for (std::size_t i = 0; i < s.point_names.size(); ++i) {
    if (!drawn(i)) continue;
    if (!names.empty()) names += next_line;
    names += escape(s.point_names[i]);
  }
  std::string out;
  if (!s.extra.empty()) out += " data-extra=\"" + extra + '"';
  if (!s.point_names.empty()) out += " data-names=\"" + names + '"';
  return out;
}

}  // namespace

std::string readout_attributes(const Series& s, const std::vector<double>& px,
                               const std::vector<double>& py) {
  std::string out;
  if (!s.trace_label.empty() || !s.label.empty())
    out += " data-name=\"" + escape(s.trace_label.empty() ? s.label : s.trace_label) + '"';
  if (s.amplitude_per_y != 0) {
    char v[80];
    std::snprintf(v, sizeof v, " data-base=\"%.9g %.9g\"", s.baseline, s.amplitude_per_y);
    out += v;
    out += " data-unit=\"" + escape(s.amplitude_unit) + '"';
  }
  return out + point_attributes(s, px, py);
}

namespace {

/// A curve that runs one way but for less than one sees: exactly so, and to the right; others stay
/// as they are.
void from_left_to_right(std::vector<double>& px, std::vector<double>& py) {
  constexpr double unseen = 0.3;  // px
  for (const bool backward : {false, true}) {
    if (backward) {
      std::reverse(px.begin(), px.end());
      std::reverse(py.begin(), py.end());
    }
    double most = -infinity, fall = 0;
    for (const double x : px)
      if (!std::isnan(x)) {
        most = std::max(most, x);
        fall = std::max(fall, most - x);
      }
    if (fall > unseen) continue;
    most = -infinity;
    for (double& x : px)
      if (!std::isnan(x)) x = most = std::max(most, x);
    return;
  }
  std::reverse(px.begin(), px.end());
  std::reverse(py.begin(), py.end());
}

}  // namespace

void draw_series(Canvas& c, const Axes& a, const Colors& k, const Prepared& p,
                 std::vector<Point>& seen, std::vector<PinJob>& pins, bool pins_only) {
  for (std::size_t i = 0; i < a.series.size(); ++i) {
    const Series& s = a.series[i];
    if (pins_only && s.style.marker == Marker::none) continue;
    const Scale& ys = s.right_axis ? p.r : p.y;
    std::vector<double> px(s.x.size()), py(s.x.size());
    for (std::size_t j = 0; j < s.x.size(); ++j) {
      px[j] = p.x(s.x[j]);
      py[j] = j < s.y.size() ? ys(s.y[j]) : nan;
    }
    const bool keep = s.keep_all || !s.extra.empty() || !s.point_names.empty();
    if (!keep) from_left_to_right(px, py);
    if (!pins_only && s.style.width > 0) {
      const std::string d = path_of(px, py, keep, is_increasing(px), c.options, &seen);
      c.add("<path data-s=\"" + std::to_string(i) + "\"" +
            (s.right_axis ? " data-right=\"1\"" : ""));
      std::string paint = stroke(k.series[i], s.style.width, s.style.dash);
      if (s.fill_to_baseline) {  // a trace hides those behind it; the fill closes from its last
                                 // point to its first
        paint.replace(paint.find("fill=\"none\""), 11,
                      std::string("fill=\"") + paper_light + "\" fill-opacity=\"0.9\"");
        paint.insert(paint.find("class=\"") + 7, "hp ");
      }
      c.add(readout_attributes(s, px, py) + ' ' + paint);
      if (s.style.opacity < 1) c.attr("stroke-opacity", s.style.opacity);
      c.add(" stroke-linejoin=\"round\"" +
            std::string(s.style.dash == Dash::solid ? " stroke-linecap=\"round\"" : "") + " d=\"" +
            d + "\"/>\n");
    } else if (!pins_only) {
      for (std::size_t j = 0; j < px.size(); j += 1 + px.size() / 3000)
        if (!std::isnan(px[j]) && !std::isnan(py[j])) seen.push_back({px[j], py[j]});
    }
    if (s.style.marker != Marker::none) {
      // Markers that fall on one another's place are drawn once.
      PinJob job{{}, {}, i, k.series[i], " data-quiet=\"1\""};
      if (s.style.width <= 0) {  // no path to read values from: the markers carry them
        job.attributes = readout_attributes(s, px, py);
      }
      if (px.size() > 2000 && !keep) {
        for (const auto& run : decimate_path(px, py, 1.0))
          for (const auto j : run) {
            job.x.push_back(px[j]);
            job.y.push_back(py[j]);
          }
      } else {
        job.x = std::move(px);
        job.y = std::move(py);
      }
      pins.push_back(std::move(job));
    }
  }
}

void draw_bars_and_patches(Canvas& c, const Axes& a, const Colors& k, const Prepared& p) {
  std::size_t number = a.series.size();
  for (std::size_t i = 0; i < a.bars.size(); ++i, ++number) {
    const auto& s = a.bars[i];
    const Scale& ys = s.right_axis ? p.r : p.y;
    const double base = ys.log ? ys.p0 : ys(0.0);
    c.add("<g data-s=\"" + std::to_string(number) + "\" " + fill(k.bars[i]) + ">");
    for (std::size_t j = 0; j < s.x.size(); ++j) {
      const double x0 = p.x(s.x[j] - s.width / 2), x1 = p.x(s.x[j] + s.width / 2),
                   y = ys(s.height[j]);
      if (std::isnan(y)) continue;
      c.add("<rect");
      c.attr("x", x0);
      c.attr("y", std::min(y, base));
      c.attr("width", x1 - x0);
      c.attr("height", std::abs(base - y));
      c.add("><title>" +
            escape((s.label.empty() ? "" : s.label + ": ") + readable(s.height[j]) + " " +
                   (s.right_axis ? a.right : a.y).unit) +
            "</title></rect>");
    }
    c.add("</g>\n");
  }
  for (std::size_t i = 0; i < a.patches.size(); ++i, ++number) {
    const auto& s = a.patches[i];
    std::string d;
    for (std::size_t j = 0; j < s.x.size(); ++j) {
      d += j == 0 ? 'M' : j == 1 ? 'L' : ' ';
      append_number(d, p.x(s.x[j]));
      d += ' ';
      append_number(d, p.y(s.y[j]));
    }
    c.add("<g data-s=\"" + std::to_string(number) + "\"><path " + fill(k.patches[i]));
    c.attr("fill-opacity", s.fill_opacity);
    c.add(" d=\"" + d + "Z\">" +
          (s.tooltip.empty() ? "" : "<title>" + escape(s.tooltip) + "</title>") + "</path>");
    if (s.style.width > 0)
      c.add("<path data-quiet=\"1\" " + stroke(k.patches[i], s.style.width, s.style.dash) +
            " stroke-linejoin=\"round\" d=\"" + d + "Z\"/>");
    c.add("</g>\n");
  }
}

void draw_rules(Canvas& c, const Axes& a, const Prepared& p, const Box& b) {
  for (const auto& r : a.rules) {
    const double v = r.vertical ? p.x(r.value) : p.y(r.value);
    if (std::isnan(v)) continue;
    const std::string s =
        "data-quiet=\"1\" " +
        stroke(r.style.color == next_color ? ink : r.style.color, r.style.width, r.style.dash);
    c.add("<path " + s + " d=\"");
    if (r.vertical)
      c.add("M" + number_text(v) + " " + number_text(b.y - 20 * b.h) + "V" +
            number_text(b.y + 20 * b.h));
    else
      c.add("M" + number_text(b.x - 20 * b.w) + " " + number_text(v) + "H" +
            number_text(b.x + 20 * b.w));
    c.add("\"/>\n");
  }
}

namespace {

/// As a browser may set it.
double note_width(const std::string& text) { return wide_fonts * text_width(text, note_size); }

bool is_free(const Box& t, const std::vector<Box>& taken) {
  return std::none_of(taken.begin(), taken.end(), [&](const Box& o) { return t.overlaps(o); });
}

bool inside(const Box& t, const Box& frame) {
  constexpr double apart = 4;  // px, from the upright edges, which look like letters
  return t.x >= frame.x + apart && t.right() <= frame.right() - apart && t.y >= frame.y + 2 &&
         t.bottom() <= frame.bottom() - 2;
}

/// What a text would hide: other texts above all, then the frame's edge, then curves. No more is
/// counted where that and `beside` reach `most`.
double hidden_by(const Box& t, const Box& frame, const std::vector<Box>& taken,
                 const std::vector<Point>& seen, double beside = 0, double most = infinity) {
  double cost = inside(t, frame) ? 0 : 20;
  for (const Box& o : taken)
    cost += t.overlaps(o) ? 10 : 0;
  for (const Point& q : seen) {
    if (beside + cost >= most) break;
    cost +=
        q.x > t.x - 2 && q.x < t.right() + 2 && q.y > t.y - 1 && q.y < t.bottom() + 1 ? 0.12 : 0;
  }
  return cost;
}

/// Those that a text within so many px of a point may hide, in their order.
std::vector<Point> near(const Point& p, double w, double reach, const std::vector<Point>& seen) {
  const double dx = reach + w + 3, dy = 1.2 * reach + 14 + 3;
  std::vector<Point> out;
  for (const Point& q : seen)
    if (std::abs(q.x - p.x) < dx && std::abs(q.y - p.y) < dy) out.push_back(q);
  return out;
}

/// Beside a point, where it hides least, no further away than told.
Box place_beside(const Point& p, double w, const Box& frame, const std::vector<Box>& taken,
                 const std::vector<Point>& all_seen, double furthest = 130) {
  const std::vector<Point> seen = near(p, w, std::min(furthest, 130.0), all_seen);
  Box at;
  double best = infinity;
  constexpr std::array<std::pair<double, double>, 10> directions{{{1.0, -1.0},
                                                                  {-1.0, -1.0},
                                                                  {1.0, 1.0},
                                                                  {-1.0, 1.0},
                                                                  {0.0, -1.2},
                                                                  {0.0, 1.2},
                                                                  {1.0, -0.4},
                                                                  {-1.0, -0.4},
                                                                  {1.0, 0.4},
                                                                  {-1.0, 0.4}}};
  for (const double reach : {9.0, 20.0, 34.0, 50.0, 70.0, 95.0, 125.0}) {
    if (reach > furthest || reach * 0.02 >= best) break;  // further away nothing is better
    for (const auto& [sx, sy] : directions) {
      const Box t{sx > 0   ? p.x + reach
                  : sx < 0 ? p.x - reach - w
                           : p.x - w / 2,
                  p.y + sy * reach - 7, w, 14};
      const double cost = reach * 0.02 + hidden_by(t, frame, taken, seen, reach * 0.02, best);
      if (cost >= best) continue;
      best = cost;
      at = t;
    }
  }
  return at;
}

/// At a place, or as near to it as there is room, no further away than told: in rows of the text,
/// half its width aside counting as one. weight: of what it hides of bodies and curves.
Box place_near(const Box& wanted, const Box& frame, const std::vector<Box>& taken,
               const std::vector<Point>& seen, double furthest, double weight) {
  if (hidden_by(wanted, frame, taken, seen) == 0.0) return wanted;
  Box at = wanted;
  double best = infinity;
  const int most_rows = static_cast<int>(furthest);
  for (int rows = -most_rows; rows <= most_rows; ++rows)
    for (const double column : {0.0, -0.5, 0.5, -1.1, 1.1}) {
      if (std::abs(rows) + 2 * std::abs(column) > furthest) continue;
      const Box t{wanted.x + column * wanted.w, wanted.y + 15.0 * rows, wanted.w, wanted.h};
      // a name beside what it names looks like its neighbour's
      const double cost =
          std::abs(rows) + 3.5 * std::abs(column) + (rows > 0 ? 0 : 0.1) +
          10 * (hidden_by(t, frame, taken, {}) + weight * hidden_by(t, frame, {}, seen));
      if (cost >= best) continue;
      best = cost;
      at = t;
    }
  return at;
}

/// Places the notes of some axes one after the other.
class NotePlacer {
 public:
  NotePlacer(const Axes& a, const Prepared& p, const Box& frame, const std::vector<Point>& seen);
  NotePlan place();

 private:
  Box place_text(const PlacedNote& note, const std::string& text, bool is_number) const;
  void take(const Box& text);
  bool has_room(const PlacedNote& note) const;
  void number_the_rest(std::vector<PlacedNote> rest);

  const Axes& a_;
  const Box& frame_;
  const std::vector<Point>& seen_;
  std::vector<Box> taken_;
  NotePlan plan_;
};

NotePlacer::NotePlacer(const Axes& a, const Prepared& p, const Box& frame,
                       const std::vector<Point>& seen)
    : a_(a),
      frame_(frame),
      seen_(seen) {
  plan_.frame = frame;
  const std::vector<RuleName> names = places_of_names(a, p.x, p.y, frame);
  std::map<int, std::string> numbered;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].at.w > 0) taken_.push_back(names[i].at);
    if (names[i].number > 0) numbered[names[i].number] = a.rules[i].label;
  }
  for (const auto& [number, label] : numbered)
    plan_.key.push_back(std::to_string(number) + ": " + label);
  for (std::size_t i = 0; i < a.notes.size(); ++i) {
    const Note& n = a.notes[i];
    const Point q{p.x(n.x), (n.right_axis ? p.r : p.y)(n.y)};
    if (std::isnan(q.x) || std::isnan(q.y) || q.x < frame.x - 1 || q.x > frame.right() + 1 ||
        q.y < frame.y - 1 || q.y > frame.bottom() + 1)
      continue;
    plan_.notes.push_back({i, q, {}, 0});
    constexpr double mark = 4.5;  // half of what stands at the point
    if (n.leader) taken_.push_back({q.x - mark, q.y - mark, 2 * mark, 2 * mark});
  }
}

Box NotePlacer::place_text(const PlacedNote& note, const std::string& text, bool is_number) const {
  const Note& n = a_.notes[note.note];
  const double w = note_width(text);
  if (n.leader) return place_beside(note.point, w, frame_, taken_, seen_, is_number ? 130 : 50);
  // a text that is wide stands about where the whole one would have its middle
  const double x =
      note.point.x + n.dx + (is_number ? (note_width(n.text) / wide_fonts - w) / 2 : 0);
  const Box wanted{x, note.point.y + n.dy - 11, w, 14};
  // a number may stand on a body, a name must not
  return is_number ? place_near(wanted, frame_, taken_, seen_, 6.0, 0.15)
                   : place_near(wanted, frame_, taken_, seen_, 2.5, 1.0);
}

/// What stands beside a text keeps its distance, or two read as one.
void NotePlacer::take(const Box& text) {
  constexpr double apart = 4;  // px
  taken_.push_back({text.x - apart, text.y, text.w + 2 * apart, text.h});
}

/// Names of a drawing stand on no body.
bool NotePlacer::has_room(const PlacedNote& note) const {
  if (!inside(note.at, frame_) || !is_free(note.at, taken_)) return false;
  if (a_.patches.empty() || a_.notes[note.note].leader) return true;
  constexpr double a_corner = 0.4;
  return hidden_by(note.at, frame_, {}, seen_) < a_corner;
}

/// From left to right.
void NotePlacer::number_the_rest(std::vector<PlacedNote> rest) {
  std::stable_sort(rest.begin(), rest.end(), [](const PlacedNote& one, const PlacedNote& other) {
    return one.point.x < other.point.x;
  });
  for (PlacedNote& note : rest) {
    note.number = static_cast<int>(plan_.key.size()) + 1;
    const std::string number = std::to_string(note.number);
    note.at = place_text(note, number, true);
    take(note.at);
    plan_.key.push_back(number + ": " + a_.notes[note.note].text);
    plan_.notes.push_back(note);
  }
}

NotePlan NotePlacer::place() {
  std::vector<PlacedNote> rest;
  const std::vector<PlacedNote> all = std::move(plan_.notes);
  plan_.notes.clear();
  for (PlacedNote note : all) {
    note.at = place_text(note, a_.notes[note.note].text, false);
    if (!has_room(note)) {
      rest.push_back(note);
      continue;
    }
    take(note.at);
    plan_.notes.push_back(note);
  }
  number_the_rest(std::move(rest));
  return std::move(plan_);
}

/// A circle at p, and the text at its place.
void draw_leader(Canvas& c, const Point& p, const std::string& text, const Box& at) {
  c.add("<g class=\"pin\" data-p=\"" + number_text(p.x) + " " + number_text(p.y) + "\">");
  c.line(p.x, p.y, std::clamp(p.x, at.x, at.right()), at.y + at.h / 2 < p.y ? at.bottom() : at.y,
         stroke(ink, 0.7));
  c.add("<circle");
  c.attr("cx", p.x);
  c.attr("cy", p.y);
  c.attr("r", 3.2);
  c.add(" class=\"ci hp\" stroke=\"#222222\" stroke-width=\"1.2\" fill=\"#ffffff\"/>");
  c.add("<rect rx=\"2\"");
  c.attr("x", at.x - 2);
  c.attr("y", at.y);
  c.attr("width", at.w + 4);
  c.attr("height", at.h);
  c.add(" " + paper_fill() + " fill-opacity=\"0.8\"/>");
  c.text(at.x + at.w / 2, at.y + 11, text, note_size, "middle");
  c.add("</g>\n");
}

}  // namespace

void draw_note(Canvas& c, const Point& p, const std::string& text, const Box& frame,
               std::vector<Box>& taken, const std::vector<Point>& seen) {
  const Box at = place_beside(p, note_width(text), frame, taken, seen);
  taken.push_back(at);
  draw_leader(c, p, text, at);
}

NotePlan place_notes(const Axes& a, const Prepared& p, const Box& frame,
                     const std::vector<Point>& seen) {
  return NotePlacer(a, p, frame, seen).place();
}

namespace {

constexpr double key_row = 15;

/// Width of a column of the key and the number of them.
std::pair<double, std::size_t> key_columns(const NotePlan& plan, double width) {
  double widest = 0;
  for (const std::string& entry : plan.key)
    widest = std::max(widest, note_width(entry) + 12);
  const auto columns = static_cast<std::size_t>(std::max(1.0, width / std::max(1.0, widest)));
  return {widest, std::min(columns, std::max<std::size_t>(1, plan.key.size()))};
}

}  // namespace

double key_height(const NotePlan& plan, double width) {
  if (plan.key.empty()) return 0;
  const std::size_t columns = key_columns(plan, width).second;
  const std::size_t rows = (plan.key.size() + columns - 1) / columns;
  return 8 + key_row * static_cast<double>(rows);
}

/// Column by column.
void draw_key(Canvas& c, const NotePlan& plan, const Point& corner, double width) {
  if (plan.key.empty()) return;
  const auto [each, columns] = key_columns(plan, width);
  const std::size_t rows = (plan.key.size() + columns - 1) / columns;
  c.add("<g class=\"key\">");
  for (std::size_t i = 0; i < plan.key.size(); ++i) {
    const std::size_t column = i / rows, row = i % rows;
    c.text_within(width, corner.x + each * static_cast<double>(column),
                  corner.y + 14 + key_row * static_cast<double>(row), plan.key[i], note_size,
                  "start");
  }
  c.add("</g>\n");
}

namespace {

constexpr int name_rows = 4;

/// Has an upright rule at v px others at its right, where its name would stand, but none at its left?
bool is_left_free(const std::vector<Rule>& rules, const Scale& x, const Box& b, double v,
                  double w) {
  const auto crossed = [&](double from, double to) {
    return std::any_of(rules.begin(), rules.end(), [&](const Rule& r) {
      return r.vertical && x(r.value) > from && x(r.value) < to;
    });
  };
  constexpr double apart = 4;
  return v - w - apart > b.x && crossed(v + 0.5, v + w) && !crossed(v - w - apart, v - 0.5);
}

/// Beside a rule at v px, in the first row that is free, from the one told on; the last one
/// otherwise.
Box beside_rule(const Rule& r, double v, double w, const Box& b, int first, double most,
                const std::vector<Box>& taken, bool left) {
  Box at = r.vertical ? Box{v + 3, b.y + 3 + 14.0 * first, w, 14}
                      : Box{b.right() - w - 4, v - 15, w, 14};
  if (r.vertical && (at.right() > b.right() || left)) at.x = v - w - 3;
  for (int k = first; k < most && !is_free(at, taken); ++k) {
    if (r.vertical)
      at.y += 14;
    else
      at.x -= w + 10;
  }
  return at;
}

}  // namespace

std::vector<RuleName> places_of_names(const Axes& a, const Scale& x, const Scale& y, const Box& b) {
  constexpr double apart = 5;
  std::vector<RuleName> names(a.rules.size());
  std::vector<Box> taken;
  std::vector<std::size_t> rest;
  const auto px = [&](const Rule& r) { return r.vertical ? x(r.value) : y(r.value); };
  for (std::size_t i = 0; i < a.rules.size(); ++i) {
    const Rule& r = a.rules[i];
    const double v = px(r), w = note_width(r.label) + apart;
    if (r.label.empty() || std::isnan(v) ||
        (r.vertical ? v < b.x || v > b.right() : v < b.y || v > b.bottom()))
      continue;
    const double most =
        r.vertical ? std::min<double>(name_rows - 1, b.h / 14 - 1) : b.w / (w + 10) - 1;
    const bool left = r.vertical && is_left_free(a.rules, x, b, v, w);
    const Box at = beside_rule(r, v, w, b, 0, most, taken, left);
    if (r.vertical && !is_free(at, taken)) {
      rest.push_back(i);
      continue;
    }
    taken.push_back(at);
    names[i].at = at;
  }
  std::stable_sort(rest.begin(), rest.end(),
                   [&](std::size_t i, std::size_t j) { return px(a.rules[i]) < px(a.rules[j]); });
  for (std::size_t k = 0; k < rest.size(); ++k) {
    const Rule& r = a.rules[rest[k]];
    RuleName& name = names[rest[k]];
    name.number = static_cast<int>(k) + 1;
    const double w = note_width(std::to_string(name.number)) + apart;
    const bool left = is_left_free(a.rules, x, b, px(r), w);
    const double most = b.h / 14 - 1;
    const int first = most > name_rows ? name_rows : 0;  // beside a name it would be part of it
    name.at = beside_rule(r, px(r), w, b, first, most, taken, left);
    taken.push_back(name.at);
  }
  return names;
}

double names_height(const Axes& a, const Scale& x, const Box& b) {
  double lowest = b.y;
  const Scale nowhere{0, 1, false, nan, nan};  // of names beside level rules
  for (const RuleName& name : places_of_names(a, x, nowhere, b))
    if (name.at.w > 0) lowest = std::max(lowest, name.at.bottom() + 2);
  return lowest - b.y;
}

namespace {

/// Do curves or rules run through a text? Bodies are pale enough to be read on.
bool is_crossed(const Axes& a, const Prepared& p, const Box& text, const std::vector<Point>& seen) {
  const auto on = [&text](double x, double y) {
    return x > text.x && x < text.right() && y > text.y && y < text.bottom();
  };
  for (const Rule& r : a.rules)
    if (r.vertical ? on(p.x(r.value), text.y + 1) : on(text.x + 1, p.y(r.value))) return true;
  return std::any_of(seen.begin(), seen.end(), [&](const Point& q) { return on(q.x, q.y); });
}

/// A text beside its point; what crosses it is dimmed.
void draw_name(Canvas& c, const Box& at, const std::string& text, bool crossed) {
  if (crossed) {
    c.add("<rect");
    c.attr("x", at.x - 1);
    c.attr("y", at.y + 1);
    c.attr("width", note_width(text) + 2);
    c.attr("height", 12);
    c.add(" " + paper_fill() + " fill-opacity=\"0.8\"/>");
  }
  c.text(at.x, at.y + 11, text, note_size);
}

}  // namespace

void draw_notes(Canvas& c, const Axes& a, const Prepared& p, const Box& b, const NotePlan& plan,
                const std::vector<Point>& seen, std::vector<Box>& taken) {
  const std::vector<RuleName> names = places_of_names(a, p.x, p.y, b);
  for (std::size_t i = 0; i < a.rules.size(); ++i) {
    const Rule& r = a.rules[i];
    const Box& at = names[i].at;
    if (!(at.w > 0)) continue;
    const double v = r.vertical ? p.x(r.value) : p.y(r.value);
    taken.push_back(at);
    c.add("<g class=\"pin\" data-p=\"" + number_text(r.vertical ? v : b.right()) + " " +
          number_text(r.vertical ? b.y : v) + "\" data-lock=\"" + (r.vertical ? "y" : "x") + "\">");
    const std::string name = names[i].number > 0 ? std::to_string(names[i].number) : r.label;
    draw_name(c, at, name, is_crossed(a, p, at, seen));
    c.add("</g>\n");
  }
  const double dx = b.x - plan.frame.x, dy = b.y - plan.frame.y;
  for (const PlacedNote& placed : plan.notes) {
    const Note& n = a.notes[placed.note];
    const std::string text = placed.number > 0 ? std::to_string(placed.number) : n.text;
    const Box at{placed.at.x + dx, placed.at.y + dy, placed.at.w, placed.at.h};
    const Point point{placed.point.x + dx, placed.point.y + dy};
    taken.push_back(at);
    if (n.leader) {
      draw_leader(c, point, text, at);
      continue;
    }
    c.add("<g class=\"pin\" data-p=\"" + number_text(point.x) + " " + number_text(point.y) + "\">");
    const bool on_body = placed.number > 0 && !a.patches.empty();
    draw_name(c, at, text, on_body || is_crossed(a, p, at, seen));
    c.add("</g>\n");
  }
}

}  // namespace whirl::plot::svg
