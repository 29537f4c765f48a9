// Curves in space, parallel projection. The report's script repeats this projection when the figure
// is turned.
#include <plot/svg_draw.hpp>
#include <core/text.hpp>
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace whirl::plot::svg {
namespace {

struct Projection {
  double ca, sa, ce, se;
  explicit Projection(const std::array<double, 2>& view)
      : ca(std::cos(view[0] * pi / 180)),
        sa(std::sin(view[0] * pi / 180)),
        ce(std::cos(view[1] * pi / 180)),
        se(std::sin(view[1] * pi / 180)) {}
  /// Right, up and towards the reader.
  Vec3 operator()(const Vec3& p) const {
    const double f = p.x() * ca + p.y() * sa;
    return {p.y() * ca - p.x() * sa, p.z() * ce - f * se, f * ce + p.z() * se};
  }
};

// Leaves out points closer than `tolerance` (box units) to the last one kept, and coarser until few
// enough remain.
std::vector<std::size_t> thin(const std::vector<Vec3>& p) {
  std::vector<std::size_t> keep;
  for (double tolerance = 1e-3;; tolerance *= 1.5) {
    keep.clear();
    for (std::size_t i = 0; i < p.size(); ++i) {
      const bool hole = std::isnan(p[i].x());
      if (keep.empty() || hole || std::isnan(p[keep.back()].x()) || i + 1 == p.size() ||
          (p[i] - p[keep.back()]).squaredNorm() > tolerance * tolerance)
        if (!(hole && !keep.empty() && std::isnan(p[keep.back()].x()))) keep.push_back(i);
    }
    if (keep.size() <= 6000 || tolerance > 0.1) return keep;
  }
}

/// Range of one axis of the data, with margins; what the axis fixes stays.
Scale scale_of(const Axes& a, std::size_t d) {
  double lo = infinity, hi = -infinity;
  for (const SpaceSeries& s : a.space)
    for (const double v : d == 0 ? s.x : d == 1 ? s.y : s.z)
      if (std::isfinite(v)) {
        lo = std::min(lo, v);
        hi = std::max(hi, v);
      }
  if (!(lo <= hi)) {
    lo = 0;
    hi = 1;
  }
  if (hi - lo < 1e-12 * std::max(std::abs(lo), std::abs(hi)) || hi == lo) {
    lo -= 0.5 * std::max(std::abs(lo), 1e-3);
    hi += 0.5 * std::max(std::abs(hi), 1e-3);
  }
  const double margin = 0.03 * (hi - lo);
  const Axis& axis = d == 0 ? a.x : d == 1 ? a.y : a.z;
  return {std::isnan(axis.min) ? lo - margin : axis.min,
          std::isnan(axis.max) ? hi + margin : axis.max, false, -a.space_aspect[d] / 2,
          a.space_aspect[d] / 2};
}

std::array<Scale, 3> scales_of(const Axes& a) {
  std::array<Scale, 3> scale{scale_of(a, 0), scale_of(a, 1), scale_of(a, 2)};
  if (!a.equal_aspect) return scale;
  // one unit of length for all: the box follows the data
  double longest = 0;
  for (const Scale& s : scale)
    longest = std::max(longest, s.hi - s.lo);
  for (Scale& s : scale) {
    s.p1 = (s.hi - s.lo) / longest;
    s.p0 = -s.p1;
  }
  return scale;
}

const char* anchor_of(double outwards_x) {
  return outwards_x > 0.35 ? "start" : outwards_x < -0.35 ? "end" : "middle";
}

constexpr double title_row = 15;
constexpr double fewest_ticks = 3;  ///< of which one may stand where axes meet

/// Room for the labels and the title of the upright axis, px.
double left_of(const Scale& upright, bool narrow) {
  constexpr double marks = 34;  // gaps and the letters of the title
  const double labels = widest_label(linear_ticks(upright.lo, upright.hi, fewest_ticks));
  return std::max(narrow ? 40.0 : 56.0, marks + labels);
}

/// A title with a comma takes two lines where it stands below the box.
std::vector<std::string> lines_of(const std::string& title) {
  const std::size_t comma = title.find(", ");
  if (comma == std::string::npos) return {title};
  return {title.substr(0, comma + 1), title.substr(comma + 2)};
}

/// Axes in space on the canvas.
class SpaceDrawing {
 public:
  SpaceDrawing(Canvas& c, const Axes& a, const Box& cell);
  void draw();

 private:
  /// An edge of the box that carries the labels of its axis, in px.
  struct Edge {
    Vec3 start;  ///< its place but for the axis's own coordinate
    Point middle;
    double length, ox, oy;  ///< ox, oy: unit vector outwards
  };

  void fit();
  Point px(const Vec3& p) const {
    const Vec3 q = view_(p);
    return {cx_ + unit_ * q.x(), cy_ - unit_ * q.y()};
  }
  void segment(const Vec3& p, const Vec3& q, const std::string& style) {
    const Point m = px(p), n = px(q);
    c_.line(m.x, m.y, n.x, n.y, style);
  }
  void begin();
  void draw_faces();
  Vec3 labelled_edge(Index d) const;
  Edge edge_of(Index d) const;
  void draw_axis(Index d);
  double draw_ticks(Index d, const Edge& edge);
  void put_title(const std::string& title, const Point& wanted, const char* anchor);
  Box place_of_legend() const;
  void append_motion(std::string& to, const std::array<Complex, 3>& motion) const;
  void draw_curve(std::size_t i);

  Canvas& c_;
  const Axes& a_;
  const Box& cell_;
  const Colors colors_;
  const std::array<const Axis*, 3> axis_;
  const std::array<Scale, 3> scale_;
  const Projection view_;
  const double top_;
  const std::vector<LegendEntry> entries_;
  const Box legend_;
  const double left_;  ///< margin, px
  const Box box_;
  double unit_ = 1, cx_ = 0, cy_ = 0;  ///< px a unit of the box, and where its middle stands
  std::array<double, 3> back_{};       ///< where the faces behind the data stand
  std::array<Ticks, 3> ticks_;
  std::vector<Point> seen_;
  std::vector<Box> labels_;  ///< of the ticks
};

SpaceDrawing::SpaceDrawing(Canvas& c, const Axes& a, const Box& cell)
    : c_(c),
      a_(a),
      cell_(cell),
      colors_(resolve_colors(a)),
      axis_{&a.x, &a.y, &a.z},
      scale_(scales_of(a)),
      view_(a.view),
      top_(a.title.empty() ? 6 : 26),
      entries_(legend_entries(a, colors_)),
      legend_(legend_size_of(entries_, c.narrow ? narrow_legend_width : 0)),
      left_(left_of(scale_[2], c.narrow)),
      box_{cell.x + left_, cell.y + top_ + 2, cell.w - left_ - (c.narrow ? 30 : 56),
           cell.h - top_ - 48 - (c.narrow ? legend_.h : 0) -
               (a.y.label.find(", ") == std::string::npos ? 0 : title_row)} {
  fit();
  const Vec3 towards(view_.ca * view_.ce, view_.sa * view_.ce, view_.se);
  for (std::size_t d = 0; d < 3; ++d) {
    back_[d] = towards[static_cast<Index>(d)] > 0 ? scale_[d].p0 : scale_[d].p1;
    const double wanted = std::clamp(unit_ * 2 * scale_[d].p1 / 70, fewest_ticks, 6.0);
    ticks_[d] = linear_ticks(scale_[d].lo, scale_[d].hi, wanted);
  }
}

/// The projected box into the cell.
void SpaceDrawing::fit() {
  Vec3 lo = Vec3::Constant(infinity), hi = -lo;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p =
        view_(Vec3(i & 1 ? scale_[0].p1 : scale_[0].p0, i & 2 ? scale_[1].p1 : scale_[1].p0,
                   i & 4 ? scale_[2].p1 : scale_[2].p0));
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  unit_ = std::min(box_.w / (hi.x() - lo.x()), box_.h / (hi.y() - lo.y()));
  cx_ = box_.x + box_.w / 2 - unit_ * (lo.x() + hi.x()) / 2;
  cy_ = box_.y + box_.h / 2 + unit_ * (lo.y() + hi.y()) / 2;
}

void SpaceDrawing::begin() {
  c_.add("<g class=\"axes\" data-kind=\"space\" data-box=\"" + number_text(box_.x) + " " +
         number_text(box_.y) + " " + number_text(box_.w) + " " + number_text(box_.h) +
         "\" data-cell=\"" + number_text(cell_.x) + " " + number_text(cell_.right()) + " " +
         number_text(cell_.y) + " " + number_text(cell_.bottom()) + "\" data-view=\"" +
         number_text(a_.view[0]) + " " + number_text(a_.view[1]) + "\" data-half=\"" +
         number_text(scale_[0].p1, 4) + " " + number_text(scale_[1].p1, 4) + " " +
         number_text(scale_[2].p1, 4) + '"');
  axis_attributes(c_, "x", a_.x, scale_[0]);
  axis_attributes(c_, "y", a_.y, scale_[1]);
  axis_attributes(c_, "z", a_.z, scale_[2]);
  c_.add(">\n");
  if (!a_.title.empty())
    c_.text(cell_.x + 8, cell_.y + top_ - 9, a_.title, title_size, "start", "font-weight=\"600\"");
}

/// The three faces of the box behind the data, with their grids.
void SpaceDrawing::draw_faces() {
  std::vector<Segment> grid, edges;
  const auto add = [this](std::vector<Segment>& to, const Vec3& p, const Vec3& q) {
    const Point m = px(p), n = px(q);
    to.push_back({m.x, m.y, n.x, n.y});
  };
  for (Index d = 0; d < 3; ++d) {
    const Index u = (d + 1) % 3, v = (d + 2) % 3;  // grid lines of u and v on the back face of d
    Vec3 p, q;
    p[d] = q[d] = back_[at(d)];
    for (const auto& [i, j] : {std::pair{u, v}, {v, u}}) {
      const Scale& along = scale_[at(i)];
      p[j] = scale_[at(j)].p0;
      q[j] = scale_[at(j)].p1;
      for (const double tick : ticks_[at(i)].major) {
        p[i] = q[i] = along(tick);
        add(grid, p, q);
      }
      for (const double edge : {along.p0, along.p1}) {
        p[i] = q[i] = edge;
        add(edges, p, q);
      }
    }
  }
  c_.lines(grid, stroke(faint, 0.8));
  c_.lines(edges, stroke(faint, 1.2));
}

/// Labels stand along the edge on the outline: for x and y the lower one nearest the reader, for z
/// the leftmost.
Vec3 SpaceDrawing::labelled_edge(Index d) const {
  Vec3 p = Vec3::Zero();
  if (d < 2) {
    const Index u = d == 0 ? 1 : 0;
    p[u] = -back_[at(u)];
    p[2] = scale_[2].p0;
    return p;
  }
  double leftmost = infinity;
  for (const double pu : {scale_[0].p0, scale_[0].p1})
    for (const double pv : {scale_[1].p0, scale_[1].p1})
      if (const double x = view_(Vec3(pu, pv, 0)).x(); x < leftmost) {
        leftmost = x;
        p[0] = pu;
        p[1] = pv;
      }
  return p;
}

SpaceDrawing::Edge SpaceDrawing::edge_of(Index d) const {
  Edge e;
  e.start = labelled_edge(d);
  Vec3 p = e.start, q = e.start;
  p[d] = scale_[at(d)].p0;
  q[d] = scale_[at(d)].p1;
  const Point m = px(p), n = px(q);
  e.middle = {(m.x + n.x) / 2, (m.y + n.y) / 2};
  const double ex = n.x - m.x, ey = n.y - m.y;
  e.length = std::max(1e-9, std::hypot(ex, ey));
  // Outwards: away from the middle of the box.
  e.ox = e.middle.x - (box_.x + box_.w / 2);
  e.oy = e.middle.y - (box_.y + box_.h / 2);
  const double along = (e.ox * ex + e.oy * ey) / e.length;
  e.ox -= along * ex / e.length;
  e.oy -= along * ey / e.length;
  const double size = std::max(1e-9, std::hypot(e.ox, e.oy));
  e.ox /= size;
  e.oy /= size;
  return e;
}

/// Returns the width of the widest label, px.
double SpaceDrawing::draw_ticks(Index d, const Edge& edge) {
  const Ticks& ticks = ticks_[at(d)];
  double widest = 0;
  for (std::size_t i = 0; i < ticks.major.size(); ++i) {
    Vec3 w = edge.start;
    w[d] = scale_[at(d)](ticks.major[i]);
    const Point t = px(w);
    c_.line(t.x, t.y, t.x + 4 * edge.ox, t.y + 4 * edge.oy, stroke(ink, 0.9));
    const char* anchor = anchor_of(edge.ox);
    const double x = t.x + 9 * edge.ox, y = t.y + 11 * edge.oy + 4;
    const double width = wide_fonts * text_width(ticks.labels[i], tick_size);
    const double left = x - width * (anchor[0] == 's' ? 0.0 : anchor[0] == 'e' ? 1.0 : 0.5);
    const Box label{left, y - 10, width, 12};
    if (std::any_of(labels_.begin(), labels_.end(),
                    [&](const Box& o) { return label.overlaps(o); }))
      continue;  // axes that meet: one of the two labels stands there
    labels_.push_back(label);
    c_.text(x, y, ticks.labels[i], tick_size - 0.5, anchor);
    widest = std::max(widest, text_width(ticks.labels[i], tick_size));
  }
  return widest;
}

void SpaceDrawing::draw_axis(Index d) {
  const Edge edge = edge_of(d);
  Vec3 p = edge.start, q = edge.start;
  p[d] = scale_[at(d)].p0;
  q[d] = scale_[at(d)].p1;
  segment(p, q, stroke(ink, 0.9));
  if (edge.length < 12) return;  // seen end on
  c_.add("<g class=\"ts\"");
  c_.attr("data-px", edge.length);
  c_.add(">");
  const double widest = draw_ticks(d, edge);
  c_.add("</g>");
  const double reach = 16 + std::abs(edge.ox) * widest + 12 * std::abs(edge.oy);
  const std::string title = axis_title(*axis_[at(d)], ticks_[at(d)].exponent);
  if (d == 2) {
    const double x = edge.middle.x + reach * edge.ox - 6, y = edge.middle.y;
    // what does not fit between the ends of the cell is set smaller
    constexpr double least = 0.5;
    const double room = 2.0 * std::min(y - cell_.y, cell_.bottom() - y);
    const double full = wide_fonts * text_width(title, label_size);
    const double share = std::clamp(room / std::max(1.0, full), least, 1.0);
    c_.text(x, y, title, share * label_size, "middle",
            "transform=\"rotate(-90 " + number_text(x) + " " + number_text(y) + ")\"");
    const double length = share * full;
    labels_.push_back({x - 10, y - length / 2, 13, length});
    return;
  }
  put_title(title, {edge.middle.x + reach * edge.ox, edge.middle.y + reach * edge.oy + 6},
            anchor_of(edge.ox));
}

/// Within the cell, below the labels that are there.
void SpaceDrawing::put_title(const std::string& title, const Point& wanted, const char* anchor) {
  const std::vector<std::string> lines = lines_of(title);
  const auto box_of = [&](const std::string& line, double y) {
    const double width = wide_fonts * text_width(line, label_size);
    const double left = wanted.x - width * (anchor[0] == 's' ? 0.0 : anchor[0] == 'e' ? 1.0 : 0.5);
    const double last = cell_.right() - 2 - width;
    return Box{std::max(cell_.x + 2, std::min(last, left)), y - 10, width, 13};
  };
  const auto is_free = [&](double y) {
    for (const std::string& line : lines) {
      const Box box = box_of(line, y);
      if (std::any_of(labels_.begin(), labels_.end(),
                      [&](const Box& o) { return box.overlaps(o); }))
        return false;
      y += title_row;
    }
    return true;
  };
  double y = wanted.y;
  for (int k = 0; k < 6 && !is_free(y); ++k)
    y += 4;
  for (const std::string& line : lines) {
    const Box box = box_of(line, y);
    labels_.push_back(box);
    c_.text(box.x + box.w / 2, y, line, label_size, "middle");
    y += title_row;
  }
}

/// Real and imaginary parts in units of the box.
void SpaceDrawing::append_motion(std::string& to, const std::array<Complex, 3>& motion) const {
  for (std::size_t d = 0; d < 3; ++d) {
    const double unit = 2 * scale_[d].p1 / (scale_[d].hi - scale_[d].lo);
    for (const double part : {motion[d].real(), motion[d].imag()}) {
      append_number(to, unit * part, 4);
      to += ' ';
    }
  }
}

void SpaceDrawing::draw_curve(std::size_t i) {
  const SpaceSeries& s = a_.space[i];
  std::vector<Vec3> p(s.x.size());
  for (std::size_t j = 0; j < p.size(); ++j)
    p[j] = {scale_[0](s.x[j]), scale_[1](s.y[j]), scale_[2](s.z[j])};
  std::vector<double> qx, qy;
  std::string xyz, motion;
  for (const std::size_t j : thin(p)) {
    if (std::isnan(p[j].x() + p[j].y() + p[j].z())) {
      qx.push_back(nan);
      qy.push_back(nan);
      xyz += "| ";
      if (!s.motion.empty()) motion += "| ";
      continue;
    }
    if (!s.motion.empty()) append_motion(motion, s.motion[j]);
    const Point q = px(p[j]);
    qx.push_back(q.x);
    qy.push_back(q.y);
    for (const double x : p[j]) {
      append_number(xyz, x, 4);
      xyz += ' ';
    }
  }
  if (!xyz.empty()) xyz.pop_back();
  if (!motion.empty()) motion.pop_back();
  std::string d = path_of(qx, qy, true, false, c_.options, &seen_);
  if (s.closed_fill) d += "Z";
  const int color = colors_.space[i];
  std::string name = "data-name=\"" + escape(s.label) + "\" data-xyz=\"" + xyz + "\"" +
                     (motion.empty() ? "" : " data-motion=\"" + motion + "\"");
  if (s.played)
    name += fmt::format(" data-played=\"{} {} {}\"", s.played->from, s.played->to,
                        s.played->trails ? 1 : 0);
  c_.add("<path data-s=\"" + std::to_string(i) + "\" " + name + " " +
         (s.closed_fill ? "data-quiet=\"1\" " : ""));
  if (s.closed_fill)
    c_.add(fill(color) + " fill-opacity=\"0.13\"");
  else if (s.style.width > 0)
    c_.add(stroke(color, s.style.width, s.style.dash) + " stroke-linejoin=\"round\"");
  else  // marks alone
    c_.add("fill=\"none\"");
  if (s.style.opacity < 1) c_.attr("stroke-opacity", s.style.opacity);
  c_.add(" d=\"" + d + "\"/>\n");
  if (s.style.marker != Marker::none)
    draw_pins(c_, qx, qy, s.style, color, static_cast<int>(i), false, " " + name);
}

/// The upper right corner, or the next that no label stands in; below the box of a narrow drawing.
Box SpaceDrawing::place_of_legend() const {
  const double left = cell_.x + 4, right = cell_.right() - legend_.w - 4;
  const double top = cell_.y + top_, bottom = cell_.bottom() - legend_.h - 2;
  if (c_.narrow) return {left, bottom, legend_.w, legend_.h};
  for (const Point& corner : {Point{right, top}, {left, top}, {right, bottom}, {left, bottom}}) {
    const Box place{corner.x, corner.y, legend_.w, legend_.h};
    if (std::none_of(labels_.begin(), labels_.end(),
                     [&](const Box& label) { return label.overlaps(place); }))
      return place;
  }
  return {right, top, legend_.w, legend_.h};
}

void SpaceDrawing::draw() {
  begin();
  c_.add("<g class=\"box\">\n");
  draw_faces();
  for (Index d = 0; d < 3; ++d)
    draw_axis(d);
  c_.add("</g>\n");
  const Scale right_of_middle{0, 1, false, cx_, cx_ + unit_}, below{0, 1, false, cy_, cy_ + unit_};
  PlotGroup plot(c_, right_of_middle, below, below);
  for (std::size_t i = 0; i < a_.space.size(); ++i)
    draw_curve(i);
  plot.end();
  draw_legend(c_, entries_, cell_, seen_, {}, place_of_legend(),
              c_.narrow ? narrow_legend_width : 0);
  c_.add("</g>\n");
}

}  // namespace

void draw_space(Canvas& c, const Axes& a, const Box& cell) { SpaceDrawing(c, a, cell).draw(); }

}  // namespace whirl::plot::svg
