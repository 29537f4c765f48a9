// Mode shapes and the drawing of the rotor; error against run time.
#include <plot/plots.hpp>

#include <fmt/format.h>
#include <core/text.hpp>
#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::plot {

namespace {

/// Factor and phase that make the largest excursion of a shape 1 and show it at that moment.
struct Moment {
  double scale;
  Complex factor;  ///< of size `scale`
};

Moment largest_moment(const ModeShape& mode) {
  constexpr double first_of_equals = 1.0 + 1e-7;  // round orbits are as large at any moment
  double largest = 0, theta0 = 0;
  for (std::size_t i = 0; i < mode.s.size(); ++i)
    for (int k = 0; k < 90; ++k) {
      const double theta = two_pi * k / 90;
      const Complex z = std::polar(1.0, theta);
      if (const double r = std::hypot((z * mode.y[i]).real(), (z * mode.z[i]).real());
          r > first_of_equals * largest) {
        largest = r;
        theta0 = theta;
      }
    }
  const double scale = largest > 0 ? 1 / largest : 1;
  return {scale, std::polar(scale, theta0)};
}

void append(SpaceSeries& s, double x, double y, double z) {
  s.x.push_back(x);
  s.y.push_back(y);
  s.z.push_back(z);
}

void append(Series& s, double x, double y) {
  s.x.push_back(x);
  s.y.push_back(y);
}

/// What the largest deflection, drawn as 1, is; empty: of no size.
std::string size_of_one(const Moment& moment, bool in_metres) {
  if (!in_metres) return {};
  const double largest = 1 / moment.scale;
  const DisplayUnit u = length_unit(largest);
  return readable(u.factor * largest, 3) + " " + u.name;
}

/// "deflection y, largest = 1", "deflection y, 1 = 12.3 µm".
std::string deflection_label(const std::string& direction, const std::string& one) {
  return "deflection" + direction + (one.empty() ? ", largest = 1" : ", 1 = " + one);
}

/// The deflected shaft at a moment and orbits of some stations.
Axes shape_in_space(const ModeShape& mode, const Moment& moment, const DisplayUnit& u) {
  Axes space;
  space.kind = AxesKind::space;
  space.space_aspect = {2.4, 1, 1};
  space.view = {-62, 20};
  space.x = Axis("axial position", u.name);
  const std::string one = size_of_one(moment, mode.in_metres);
  space.y = Axis(deflection_label(" y", one), "-");
  space.z = Axis(deflection_label(" z", one), "-");
  space.y.min = space.z.min = -1.08;
  space.y.max = space.z.max = 1.08;
  space.weight = 1.7;
  SpaceSeries rest{"", {}, {}, {}, Style{ink, Dash::dash_dot, 0.9}},
      line{"deflected shaft", {}, {}, {}, Style{0, Dash::solid, 2.4}},
      dots{"", {}, {}, {}, Style{0, Dash::solid, 0, Marker::circle, 4.5}};
  SpaceSeries orbits{"orbits of the stations", {}, {}, {}, Style{1, Dash::solid, 0.9}};
  const std::size_t n = mode.s.size();
  for (std::size_t i = 0; i < n; ++i) {
    const double s = u.factor * mode.s[i];
    const double y = (moment.factor * mode.y[i]).real(), z = (moment.factor * mode.z[i]).real();
    const std::array<Complex, 3> motion{0.0, moment.factor * mode.y[i], moment.factor * mode.z[i]};
    append(rest, s, 0, 0);
    append(line, s, y, z);
    line.motion.push_back(motion);
    if (n > 16 && i % (n / 13) != 0 && i + 1 != n) continue;
    for (int k = 0; k <= 48; ++k) {
      const Complex p = std::polar(1.0, two_pi * k / 48) * moment.factor;
      append(orbits, s, (p * mode.y[i]).real(), (p * mode.z[i]).real());
    }
    append(orbits, nan, nan, nan);
    append(dots, s, y, z);
    dots.motion.push_back(motion);
  }
  space.space = {std::move(rest), std::move(orbits), std::move(line), std::move(dots)};
  return space;
}

/// The same in the planes y and z, and the largest radius.
Axes shape_in_planes(const ModeShape& mode, const Moment& moment, const DisplayUnit& u) {
  Series y, z, envelope;
  y.label = "y";
  z.label = "z";
  envelope.label = "largest radius";
  y.style = {0, Dash::solid, 1.8};
  z.style = {1, Dash::dashed, 1.8};
  envelope.style = {7, Dash::dotted, 1.5};
  for (std::size_t i = 0; i < mode.s.size(); ++i) {
    const double s = u.factor * mode.s[i];
    append(y, s, (moment.factor * mode.y[i]).real());
    append(z, s, (moment.factor * mode.z[i]).real());
    // Major semi-axis of the ellipse: the sum of the two circular parts.
    const Complex i1(0, 1);
    append(envelope, s,
           moment.scale * 0.5 *
               (std::abs(mode.y[i] + i1 * mode.z[i]) + std::abs(mode.y[i] - i1 * mode.z[i])));
  }
  Axes planes;
  planes.x = Axis("axial position", u.name);
  planes.y = Axis(deflection_label("", size_of_one(moment, mode.in_metres)), "-");
  planes.series = {std::move(y), std::move(z), std::move(envelope)};
  planes.rules.push_back({false, 0, "", {ink, Dash::solid, 0.8}});
  for (const auto& [text, s] : mode.stations)
    planes.rules.push_back({true, u.factor * s, text, {faint, Dash::dashed, 1.0}});
  return planes;
}

}  // namespace

Figure plot_mode_shape(std::string name, std::string title, const ModeShape& mode) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 640;
  const double most =
      mode.s.empty() ? 1 : std::max(std::abs(mode.s.front()), std::abs(mode.s.back()));
  const DisplayUnit u = most >= 10 ? DisplayUnit{1, "m"} : DisplayUnit{1e3, "mm"};
  const Moment moment = largest_moment(mode);
  f.axes = {shape_in_space(mode, moment, u), shape_in_planes(mode, moment, u)};
  if (!mode.label.empty()) f.caption = mode.label;
  return f;
}

namespace {

/// A machine of several lines in space, its deflection magnified.
class MachinePicture {
 public:
  explicit MachinePicture(const MachineShape& shape);
  Axes in_space() const;
  Axes in_planes() const;
  const DisplayUnit& unit() const { return unit_; }

 private:
  void put(SpaceSeries& s, const Vec3& rest, const Eigen::Vector3cd& u, bool moves) const;
  const MachineShape& shape_;
  DisplayUnit unit_;
  Moment moment_;  ///< its factor makes the largest deflection 1 at the moment shown
  Complex to_one_;
  double draw_ = 0;  ///< m, of a deflection of 1
};

MachinePicture::MachinePicture(const MachineShape& shape) : shape_(shape) {
  Vec3 lo = Vec3::Constant(infinity), hi = -lo;
  ModeShape all;  // the moment of the largest lateral excursion of any line
  for (const ShapeLine& l : shape.lines)
    for (std::size_t i = 0; i < l.rest.size(); ++i) {
      lo = lo.cwiseMin(l.rest[i]);
      hi = hi.cwiseMax(l.rest[i]);
      all.s.push_back(0);
      all.y.push_back(l.u[i][1]);
      all.z.push_back(l.u[i][2]);
    }
  const double size = all.s.empty() ? 1.0 : std::max((hi - lo).maxCoeff(), 1e-6);
  unit_ = size >= 10 ? DisplayUnit{1, "m"} : DisplayUnit{1e3, "mm"};
  moment_ = largest_moment(all);
  to_one_ = moment_.factor;
  draw_ = 0.14 * size;
}

void MachinePicture::put(SpaceSeries& s, const Vec3& rest, const Eigen::Vector3cd& u,
                         bool moves) const {
  const Eigen::Vector3cd m = unit_.factor * draw_ * to_one_ * u;
  const Vec3 p = unit_.factor * rest + (moves ? Vec3(m.real()) : Vec3::Zero());
  append(s, p.x(), p.y(), p.z());
  if (moves) s.motion.push_back({m[0], m[1], m[2]});
}

Axes MachinePicture::in_space() const {
  Axes a;
  a.kind = AxesKind::space;
  a.equal_aspect = true;
  a.view = {-62, 20};
  a.x = Axis("x", unit_.name);
  // places are to scale, deflections are not
  const std::string enlarged =
      shape_.in_metres ? "deflection enlarged " + readable(draw_ * moment_.scale, 2) + " times"
                       : "deflection without scale";
  a.y = Axis("y, " + enlarged, unit_.name);
  a.z = Axis("z, " + enlarged, unit_.name);
  a.weight = 1.8;
  SpaceSeries rest{"", {}, {}, {}, Style{ink, Dash::dash_dot, 0.8}};
  SpaceSeries orbits{"orbits of the stations", {}, {}, {}, Style{faint, Dash::solid, 0.9}};
  SpaceSeries links{"supports", {}, {}, {}, Style{7, Dash::dotted, 1.2}};
  SpaceSeries ends{"", {}, {}, {}, Style{7, Dash::solid, 0, Marker::square, 5}};
  orbits.style.color = 7;
  orbits.style.opacity = 0.6;
  std::vector<SpaceSeries> lines;
  int color = 0;
  for (const ShapeLine& l : shape_.lines) {
    SpaceSeries s{l.label, {}, {}, {}, Style{color++, Dash::solid, 2.4}};
    for (std::size_t i = 0; i < l.rest.size(); ++i) {
      put(rest, l.rest[i], l.u[i], false);
      put(s, l.rest[i], l.u[i], true);
    }
    append(rest, nan, nan, nan);
    for (const std::size_t i : l.stations) {
      for (int k = 0; k <= 32; ++k) {
        const Eigen::Vector3cd m = draw_ * std::polar(1.0, two_pi * k / 32) * to_one_ * l.u[i];
        put(orbits, l.rest[i] + Vec3(m.real()), m, false);
      }
      append(orbits, nan, nan, nan);
    }
    lines.push_back(std::move(s));
  }
  for (const ShapeLink& l : shape_.links) {
    put(ends, l.at, l.u_at, true);
    if (l.to_ground || (l.at - l.to).norm() < 1e-9) continue;
    put(links, l.at, l.u_at, true);
    put(links, l.to, l.u_to, true);
    append(links, nan, nan, nan);
    links.motion.push_back({});
  }
  a.space = {std::move(rest), std::move(orbits)};
  for (SpaceSeries& s : lines)
    a.space.push_back(std::move(s));
  if (!links.x.empty()) a.space.push_back(std::move(links));
  if (!ends.x.empty()) a.space.push_back(std::move(ends));
  return a;
}

/// y and z of every line at the moment shown, one scale for all.
Axes MachinePicture::in_planes() const {
  Axes a;
  a.x = Axis("x", unit_.name);
  a.y = Axis(deflection_label("", size_of_one(moment_, shape_.in_metres)), "-");
  int color = 0;
  for (const ShapeLine& l : shape_.lines) {
    for (const Index c : {1, 2}) {
      Series s;
      s.label = l.label + (c == 1 ? ", y" : ", z");
      s.style = {color, c == 1 ? Dash::solid : Dash::dashed, 1.8};
      for (std::size_t i = 0; i < l.rest.size(); ++i)
        append(s, unit_.factor * l.rest[i].x(), (to_one_ * l.u[i][c]).real());
      a.series.push_back(std::move(s));
    }
    ++color;
  }
  a.rules.push_back({false, 0, "", {ink, Dash::solid, 0.8}});
  return a;
}

}  // namespace

Figure plot_machine_shape(std::string name, std::string title, const MachineShape& shape) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 680;
  const MachinePicture picture(shape);
  f.axes = {picture.in_space(), picture.in_planes()};
  return f;
}

Figure plot_line(std::string name, const LineDrawing& line) {
  Figure f;
  f.name = std::move(name);
  f.title = line.title;
  f.height = 500;
  Axes a;
  a.kind = AxesKind::space;
  a.equal_aspect = true;
  double size = 0;
  for (const Vec3& r : line.line)
    size = std::max(size, r.cwiseAbs().maxCoeff());
  const DisplayUnit u = length_unit(size);
  a.x = Axis("x", u.name);
  a.y = Axis("y", u.name);
  a.z = Axis("z", u.name);
  const auto put = [&u](SpaceSeries& s, const Vec3& r) {
    s.x.push_back(u.factor * r.x());
    s.y.push_back(u.factor * r.y());
    s.z.push_back(u.factor * r.z());
  };
  SpaceSeries centre{"centre line", {}, {}, {}, Style{0, Dash::solid, 2.2}},
      nodes{"nodes", {}, {}, {}, {}};
  nodes.style = {0, Dash::solid, 0, Marker::circle, 3.5};
  for (const Vec3& r : line.line)
    put(centre, r);
  for (const Vec3& r : line.nodes)
    put(nodes, r);
  a.space = {std::move(centre), std::move(nodes)};
  const auto marks = [&](const std::vector<DrawnPoint>& points, int color, Marker marker) {
    for (const DrawnPoint& p : points) {
      SpaceSeries s{p.name, {}, {}, {}, {}};
      put(s, p.r);
      s.style = {color, Dash::solid, 0, marker, 9};
      a.space.push_back(std::move(s));
    }
  };
  marks(line.supports, 1, Marker::square);
  marks(line.disks, 2, Marker::circle);
  marks(line.probes, 3, Marker::diamond);
  marks(line.joints, 4, Marker::cross);
  f.axes.push_back(std::move(a));
  return f;
}

namespace {

/// A rotor in its plane: parts, supports and names.
class RotorPicture {
 public:
  explicit RotorPicture(const RotorDrawing& rotor);
  Figure figure(std::string name);

 private:
  void find_extent();
  void add_outline(double sa, double sb, std::array<double, 2> outer, std::array<double, 2> inner,
                   const Style& style, double opacity, const std::string& tip,
                   const std::string& label);
  void add_sections();
  void add_disks();
  void add_bearings();
  void add_lines();
  void add_names();
  void add_name(double s, double radius, const std::string& text, double dy) {
    axes_.notes.push_back({mm * s, mm * radius, text, false, -text_width(text, 11) / 2, dy});
  }

  const RotorDrawing& rotor_;
  double s0_ = infinity, s1_ = -infinity, r1_ = 0;  ///< ends and largest radius, m
  double glyph_ = 0;                                ///< size of a symbol, m
  Axes axes_;
};

RotorPicture::RotorPicture(const RotorDrawing& rotor) : rotor_(rotor) {
  find_extent();
  glyph_ = std::max(0.12 * r1_, 0.018 * (s1_ - s0_));
  axes_.x = Axis("axial position", "mm");
  axes_.y = Axis("radius", "mm");
  // Drawn to one scale unless that would make it a hair.
  axes_.equal_aspect = s1_ - s0_ < 16 * r1_;
  axes_.legend = true;
}

void RotorPicture::find_extent() {
  for (const auto& p : rotor_.sections) {
    s0_ = std::min(s0_, p.s0);
    s1_ = std::max(s1_, p.s1);
    r1_ = std::max({r1_, p.outer_left, p.outer_right});
  }
  for (const auto& d : rotor_.disks) {
    s0_ = std::min(s0_, d.s - d.width / 2);
    s1_ = std::max(s1_, d.s + d.width / 2);
    r1_ = std::max(r1_, d.outer);
  }
  for (const auto& b : rotor_.bearings) {
    s0_ = std::min(s0_, b.s);
    s1_ = std::max(s1_, b.s);
  }
  if (!(s1_ > s0_)) {
    s0_ -= 0.5 * std::max(r1_, 1e-3);
    s1_ = s0_ + std::max(r1_, 1e-3);
  }
  if (!(r1_ > 0)) r1_ = (s1_ - s0_) / 50;
}

// An outer and an inner radius along s: two halves, or one area when there is no bore.
void RotorPicture::add_outline(double sa, double sb, std::array<double, 2> outer,
                               std::array<double, 2> inner, const Style& style, double opacity,
                               const std::string& tip, const std::string& label) {
  const bool solid = inner[0] <= 0 && inner[1] <= 0;
  for (const double side : {1.0, -1.0}) {
    if (solid && side < 0) break;
    Patch p;
    p.label = side > 0 ? label : "";
    p.x = {mm * sa, mm * sb, mm * sb, mm * sa};
    p.y = {mm * side * outer[0], mm * side * outer[1], mm * side * (solid ? -outer[1] : inner[1]),
           mm * side * (solid ? -outer[0] : inner[0])};
    p.style = style;
    p.fill_opacity = opacity;
    p.tooltip = tip;
    axes_.patches.push_back(std::move(p));
  }
}

/// In mm.
std::string diameter_text(double radius) { return readable(2e3 * radius, 5); }

void RotorPicture::add_sections() {
  for (const auto& p : rotor_.sections) {
    std::string tip = p.name + ": length " + readable(mm * (p.s1 - p.s0), 5) +
                      " mm, outer diameter " + diameter_text(p.outer_left);
    if (p.outer_right != p.outer_left) tip += " to " + diameter_text(p.outer_right);
    tip += " mm";
    if (p.inner_left > 0 || p.inner_right > 0)
      tip += ", bore " + diameter_text(p.inner_left) +
             (p.inner_right != p.inner_left ? " to " + diameter_text(p.inner_right) : "") + " mm";
    add_outline(p.s0, p.s1, {p.outer_left, p.outer_right}, {p.inner_left, p.inner_right},
                {0, Dash::solid, 1.1}, 0.22, tip, &p == &rotor_.sections.front() ? "shaft" : "");
  }
}

void RotorPicture::add_disks() {
  for (const auto& p : rotor_.disks) {
    const std::string tip = p.name + ": outer diameter " + diameter_text(p.outer) + " mm, width " +
                            readable(mm * p.width, 4) + " mm";
    add_outline(p.s - p.width / 2, p.s + p.width / 2, {p.outer, p.outer}, {p.inner, p.inner},
                {1, Dash::solid, 1.1}, 0.35, tip, &p == &rotor_.disks.front() ? "disks" : "");
  }
}

/// A support: a triangle under the shaft.
void RotorPicture::add_bearings() {
  for (const auto& b : rotor_.bearings) {
    Patch p;
    p.label = &b == &rotor_.bearings.front() ? "bearings" : "";
    p.x = {mm * b.s, mm * (b.s + glyph_), mm * (b.s - glyph_)};
    p.y = {-mm * b.radius, -mm * (b.radius + 1.6 * glyph_), -mm * (b.radius + 1.6 * glyph_)};
    p.style = {2, Dash::solid, 1.2};
    p.fill_opacity = 0.4;
    p.tooltip = b.name;
    axes_.patches.push_back(std::move(p));
  }
}

/// The centre line, nodes, joints and probes.
void RotorPicture::add_lines() {
  Series centre;
  centre.trace_label = "centre line";
  const double over = 0.02 * (s1_ - s0_);
  centre.x = {mm * (s0_ - over), mm * (s1_ + over)};
  centre.y = {0, 0};
  centre.style = {ink, Dash::dash_dot, 0.9};
  axes_.series.push_back(std::move(centre));
  if (!rotor_.nodes.empty()) {
    Series nodes;
    nodes.label = "nodes";
    for (const double s : rotor_.nodes)
      append(nodes, mm * s, 0);
    nodes.style = {ink, Dash::solid, 0, Marker::circle, 3.5};
    axes_.series.push_back(std::move(nodes));
  }
  for (const auto& j : rotor_.joints) {
    Series joint;
    joint.label = fmt::format("{} ‘{}’", j.kind, j.name);
    append(joint, mm * j.s, 0);
    joint.style = {4, Dash::solid, 0, j.marker, 11};
    axes_.series.push_back(std::move(joint));
  }
  if (rotor_.probes.empty()) return;
  Series probes;
  probes.label = "probes";
  for (const auto& p : rotor_.probes)
    append(probes, mm * p.s, mm * (p.radius + 0.6 * glyph_));
  probes.style = {3, Dash::solid, 0, Marker::triangle, 9};
  axes_.series.push_back(std::move(probes));
}

/// Outside the outline: disks and bearings below, probes and joints above.
void RotorPicture::add_names() {
  for (const auto& p : rotor_.disks)
    add_name(p.s, -p.outer, p.name, 15);
  for (const auto& p : rotor_.bearings)
    add_name(p.s, -(p.radius + 1.6 * glyph_), p.name, 15);
  for (const auto& p : rotor_.probes)
    add_name(p.s, p.radius + 0.6 * glyph_, p.name, -9);
  for (const auto& j : rotor_.joints)
    add_name(j.s, j.radius, j.name, -9);
}

Figure RotorPicture::figure(std::string name) {
  add_sections();
  add_disks();
  add_bearings();
  add_lines();
  add_names();
  const double reach = r1_ + 3.2 * glyph_;
  axes_.y.min = -mm * reach;
  axes_.y.max = mm * reach;
  Figure f;
  f.name = std::move(name);
  f.title = rotor_.title;
  f.width = 860;
  f.height = 300;
  if (axes_.equal_aspect)  // as high as one scale wants, within reason
    f.height = std::clamp(110 + 780 * 2 * reach / (1.1 * (s1_ - s0_)), 240.0, 620.0);
  else
    f.caption = "Radii are drawn larger than lengths.";
  f.axes.push_back(std::move(axes_));
  return f;
}

}  // namespace

Figure plot_rotor(std::string name, const RotorDrawing& rotor) {
  return RotorPicture(rotor).figure(std::move(name));
}

Figure plot_study(std::string name, std::string title, std::span<const StudyCurve> curves,
                  std::string error_label, std::string error_unit, double target) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 480;
  Axes a;
  a.x = Axis("run time (CPU)", "s", true);
  a.y = Axis(std::move(error_label), std::move(error_unit), true);
  constexpr Marker marks[] = {Marker::circle,   Marker::square, Marker::diamond,
                              Marker::triangle, Marker::cross,  Marker::plus};
  std::vector<std::pair<double, double>> all;
  std::size_t k = 0;
  for (const auto& c : curves) {
    Series s;
    s.label = c.label;
    s.style.width = 1.3;
    s.style.marker = marks[k % std::size(marks)];
    for (const auto& p : c.points) {
      s.x.push_back(p.seconds);
      s.y.push_back(p.error);
      s.point_names.push_back(p.label);
      if (p.seconds > 0 && p.error > 0) all.emplace_back(p.seconds, p.error);
    }
    a.series.push_back(std::move(s));
    ++k;
  }
  // Nobody is both faster and more accurate than a point of the front.
  std::sort(all.begin(), all.end());
  Series front;
  front.label = "Pareto front";
  front.style = {ink, Dash::dotted, 1.6};
  double best = infinity;
  for (const auto& [t, e] : all)
    if (e < best) {
      if (!front.x.empty()) {
        front.x.push_back(t);
        front.y.push_back(best);
      }
      front.x.push_back(t);
      front.y.push_back(e);
      best = e;
    }
  if (front.x.size() > 2) a.series.push_back(std::move(front));
  if (target > 0)
    a.rules.push_back({false, target, "target " + readable(target, 2), {1, Dash::dashed, 1.1}});
  f.axes.push_back(std::move(a));
  return f;
}

}  // namespace whirl::plot
