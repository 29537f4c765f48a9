#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot::svg {

namespace {

/// Polar axes on the canvas.
class PolarDrawing {
 public:
  PolarDrawing(Canvas& c, const Axes& a, const Box& cell);
  void draw();

 private:
  double largest_radius() const;
  /// degrees: of the axis; r: px.
  Point place(double degrees, double r) const {
    const double f = (a_.zero_at + (a_.clockwise ? -degrees : degrees)) * pi / 180;
    return {cx_ + r * std::cos(f), cy_ - r * std::sin(f)};
  }
  void begin();
  void put_label(const Point& p, const std::string& text, double size);
  void draw_grid();
  void draw_curve(std::size_t i);
  void draw_radii();

  Canvas& c_;
  const Axes& a_;
  const Box& cell_;
  const Colors colors_;
  const std::vector<LegendEntry> entries_;
  const Box legend_;
  bool legend_below_ = false;
  Ticks ticks_;
  double step_ = 1, full_ = 1;                ///< between circles, of the outermost one
  double top_ = 0, R_ = 0, cx_ = 0, cy_ = 0;  ///< px
  std::vector<Point> seen_;
  std::vector<Box> taken_;  ///< by texts
};

PolarDrawing::PolarDrawing(Canvas& c, const Axes& a, const Box& cell)
    : c_(c),
      a_(a),
      cell_(cell),
      colors_(resolve_colors(a)),
      entries_(legend_entries(a, colors_)),
      legend_(legend_size_of(entries_, c.narrow ? narrow_legend_width : 0)) {
  const double largest = largest_radius();
  ticks_ = linear_ticks(0, largest * 1.02, 4);
  step_ = ticks_.major.size() > 1 ? ticks_.major[1] - ticks_.major[0] : largest;
  full_ = std::isnan(a.y.max) ? step_ * std::ceil(largest / step_ - 0.02) : largest;
  top_ = a.title.empty() ? 8 : 26;
  const auto radius = [&](double right, double below) {
    return std::max(20.0, std::min((cell.w - right - 80) / 2, (cell.h - top_ - 76 - below) / 2));
  };
  // the legend beside the circle or below it, where it leaves more of it
  const double right = entries_.empty() ? 0 : legend_.w + 10,
               below = entries_.empty() ? 0 : legend_.h + 8;
  legend_below_ = c.narrow || radius(0, below) > radius(right, 0);
  R_ = legend_below_ ? radius(0, below) : radius(right, 0);
  cx_ = cell.x + (cell.w - (legend_below_ ? 0 : right)) / 2;
  cy_ = cell.y + top_ + 20 + R_;
}

double PolarDrawing::largest_radius() const {
  if (!std::isnan(a_.y.max)) return a_.y.max;
  double largest = 0;
  for (const Series& s : a_.series)
    for (const double v : s.y)
      if (std::isfinite(v)) largest = std::max(largest, v);
  return largest > 0 ? largest : 1;
}

void PolarDrawing::begin() {
  c_.add("<g class=\"axes\" data-kind=\"polar\" data-box=\"" + number_text(cx_ - R_) + " " +
         number_text(cy_ - R_) + " " + number_text(2 * R_) + " " + number_text(2 * R_) +
         "\" data-zero=\"" + number_text(a_.zero_at) + "\" data-cw=\"" +
         (a_.clockwise ? "1" : "0") + '"');
  axis_attributes(c_, "x", a_.x, Scale{0, 360, false});
  axis_attributes(c_, "y", a_.y, Scale{0, full_, false});
  c_.add(">\n");
  if (!a_.title.empty())
    c_.text(cell_.x + 8, cell_.y + top_ - 9, a_.title, title_size, "start", "font-weight=\"600\"");
}

/// A text about a point.
void PolarDrawing::put_label(const Point& p, const std::string& text, double size) {
  const double w = wide_fonts * text_width(text, size);
  taken_.push_back({p.x - w / 2, p.y - 7, w, 14});
  c_.text(p.x, p.y + 4, text, size, "middle");
}

void PolarDrawing::draw_grid() {
  for (int deg = 0; deg < 360; deg += 30) {
    const Point p = place(deg, R_), q = place(deg, R_ + 15);
    c_.line(cx_, cy_, p.x, p.y, stroke(faint, 0.8));
    put_label(q, std::to_string(deg) + "°", tick_size);
  }
  for (double r = step_; r < full_ * 1.001; r += step_) {
    c_.add("<circle");
    c_.attr("cx", cx_);
    c_.attr("cy", cy_);
    c_.attr("r", R_ * r / full_);
    c_.add(" " + (r > full_ * 0.999 ? stroke(ink, 0.9) : stroke(faint, 0.8)) + "/>");
  }
}

void PolarDrawing::draw_curve(std::size_t i) {
  const Series& s = a_.series[i];
  std::vector<double> px(s.x.size(), nan), py(s.x.size(), nan);
  for (std::size_t j = 0; j < s.x.size() && j < s.y.size(); ++j) {
    if (!std::isfinite(s.x[j]) || !std::isfinite(s.y[j])) continue;
    const Point p = place(s.x[j], R_ * s.y[j] / full_);
    px[j] = p.x;
    py[j] = p.y;
  }
  const std::string rest = readout_attributes(s, px, py);
  const bool keep = s.keep_all || !s.extra.empty() || !s.point_names.empty();
  if (s.style.width > 0)
    c_.add("<path data-s=\"" + std::to_string(i) + "\"" + rest + " " +
           stroke(colors_.series[i], s.style.width, s.style.dash) +
           " stroke-linejoin=\"round\" d=\"" + path_of(px, py, keep, false, c_.options, &seen_) +
           "\"/>\n");
  draw_pins(c_, px, py, s.style, colors_.series[i], static_cast<int>(i), false,
            s.style.width > 0 ? std::string(" data-quiet=\"1\"") : rest);
}

/// Along the ray at 15 degrees, where no angle is labelled.
void PolarDrawing::draw_radii() {
  for (double r = step_; r < full_ * 1.001; r += step_) {
    const Point p = place(a_.clockwise ? -15 : 15, R_ * r / full_);
    const auto n = static_cast<std::size_t>(std::lround(r / step_));
    if (n < ticks_.labels.size()) put_label(p, ticks_.labels[n], tick_size - 1);
  }
}

void PolarDrawing::draw() {
  begin();
  c_.add("<g class=\"gx\">");
  draw_grid();
  c_.add("</g>\n");
  const Scale right_of_middle{0, 1, false, cx_, cx_ + R_}, below{0, 1, false, cy_, cy_ + R_};
  PlotGroup plot(c_, right_of_middle, below, below);
  for (std::size_t i = 0; i < a_.series.size(); ++i)
    draw_curve(i);
  plot.end();
  c_.add("<g class=\"radii\">");
  draw_radii();
  c_.add("</g>\n");
  const Box inside{cx_ - R_ - 30, cy_ - R_, 2 * R_ + 60, 2 * R_};
  for (const auto& n : a_.notes)
    draw_note(c_, place(n.x, R_ * n.y / full_), n.text, inside, taken_, seen_);
  c_.text_within(cell_.w - 8, cx_, cy_ + R_ + 40,
                 axis_title(a_.y, ticks_.exponent) + ", " + a_.x.label, label_size, "middle");
  const Point corner = legend_below_ ? Point{cx_ - legend_.w / 2, cy_ + R_ + 48}
                                     : Point{cell_.right() - legend_.w, cell_.y + top_};
  draw_legend(c_, entries_, cell_, seen_, {}, {corner.x, corner.y, legend_.w, legend_.h},
              c_.narrow ? narrow_legend_width : 0);
  c_.add("</g>\n");
}

}  // namespace

void draw_polar(Canvas& c, const Axes& a, const Box& cell) { PolarDrawing(c, a, cell).draw(); }

}  // namespace whirl::plot::svg
