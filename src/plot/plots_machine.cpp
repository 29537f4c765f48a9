// All lines of a machine in one elevation.
#include <plot/plots.hpp>

#include <core/text.hpp>
#include <algorithm>
#include <cmath>
#include <utility>

namespace whirl::plot {

namespace {

class MachineElevation {
 public:
  explicit MachineElevation(const MachineDrawing& machine);
  Figure figure(std::string name);

 private:
  void find_extent();
  void add_body(const MachineLine& l, double s0, double s1, std::array<double, 4> radii,
                const Style& style, double opacity, const std::string& label,
                const std::string& tip);
  void add_line(const MachineLine& l, int color);
  void add_names(const MachineLine& l);
  void add_links();
  void add_name(double x, double y, const std::string& text, double dy) {
    axes_.notes.push_back({mm * x, mm * y, text, false, -text_width(text, 11) / 2, dy});
  }

  const MachineDrawing& machine_;
  double x0_ = infinity, x1_ = -infinity, y0_ = infinity, y1_ = -infinity, glyph_ = 0;
  Axes axes_;
};

MachineElevation::MachineElevation(const MachineDrawing& machine) : machine_(machine) {
  find_extent();
  glyph_ = std::max(0.05 * (y1_ - y0_), 0.012 * (x1_ - x0_));
  axes_.x = Axis("x", "mm");
  axes_.y = Axis(machine.across.empty() ? "radius" : machine.across, "mm");
  axes_.equal_aspect = x1_ - x0_ < 8 * (y1_ - y0_);
}

void MachineElevation::find_extent() {
  const auto take = [&](double x, double y) {
    x0_ = std::min(x0_, x);
    x1_ = std::max(x1_, x);
    y0_ = std::min(y0_, y);
    y1_ = std::max(y1_, y);
  };
  for (const MachineLine& l : machine_.lines) {
    for (const DrawnSection& s : l.drawing.sections)
      for (const double r : {s.outer_left, s.outer_right, -s.outer_left, -s.outer_right}) {
        take(l.x + s.s0, l.height + r);
        take(l.x + s.s1, l.height + r);
      }
    for (const DrawnDisk& d : l.drawing.disks)
      for (const double r : {d.outer, -d.outer}) {
        take(l.x + d.s - d.width / 2, l.height + r);
        take(l.x + d.s + d.width / 2, l.height + r);
      }
  }
  if (!(x1_ > x0_)) take(x0_ + 1e-3, y0_);
  if (!(y1_ > y0_)) take(x0_, y0_ + (x1_ - x0_) / 50);
}

/// Radii: outer left and right, inner left and right.
void MachineElevation::add_body(const MachineLine& l, double s0, double s1,
                                std::array<double, 4> radii, const Style& style, double opacity,
                                const std::string& label, const std::string& tip) {
  const bool solid = radii[2] <= 0 && radii[3] <= 0;
  for (const double side : {1.0, -1.0}) {
    if (solid && side < 0) break;
    const double in_left = solid ? -radii[0] : radii[2], in_right = solid ? -radii[1] : radii[3];
    Patch p;
    p.label = side > 0 ? label : "";
    p.x = {mm * (l.x + s0), mm * (l.x + s1), mm * (l.x + s1), mm * (l.x + s0)};
    p.y = {mm * (l.height + side * radii[0]), mm * (l.height + side * radii[1]),
           mm * (l.height + side * in_right), mm * (l.height + side * in_left)};
    p.style = style;
    p.fill_opacity = opacity;
    p.tooltip = tip;
    axes_.patches.push_back(std::move(p));
  }
}

void MachineElevation::add_line(const MachineLine& l, int color) {
  const RotorDrawing& d = l.drawing;
  for (const DrawnSection& s : d.sections)
    add_body(l, s.s0, s.s1, {s.outer_left, s.outer_right, s.inner_left, s.inner_right},
             {color, Dash::solid, 1.1}, 0.2, &s == &d.sections.front() ? d.title : "",
             d.title + ", " + s.name);
  for (const DrawnDisk& k : d.disks)
    add_body(l, k.s - k.width / 2, k.s + k.width / 2, {k.outer, k.outer, k.inner, k.inner},
             {color, Dash::solid, 1.1}, 0.45, "", k.name);
  for (const DrawnMark& b : d.bearings) {
    Patch p;
    const double x = l.x + b.s, y = l.height - b.radius;
    p.x = {mm * x, mm * (x + glyph_), mm * (x - glyph_)};
    p.y = {mm * y, mm * (y - 1.6 * glyph_), mm * (y - 1.6 * glyph_)};
    p.style = {ink, Dash::solid, 1.0};
    p.fill_opacity = 0.25;
    p.tooltip = b.name;
    axes_.patches.push_back(std::move(p));
  }
  for (const DrawnJoint& j : d.joints) {
    Series joint;
    joint.label = j.kind + " ‘" + j.name + "’";
    const bool listed = std::any_of(axes_.series.begin(), axes_.series.end(),
                                    [&](const Series& s) { return s.label == joint.label; });
    if (listed) joint.trace_label = std::exchange(joint.label, {});  // on the other line of it
    joint.x = {mm * (l.x + j.s)};
    joint.y = {mm * l.height};
    joint.style = {4, Dash::solid, 0, j.marker, 11};
    axes_.series.push_back(std::move(joint));
  }
}

/// Disks above, supports below.
void MachineElevation::add_names(const MachineLine& l) {
  for (const DrawnDisk& k : l.drawing.disks)
    add_name(l.x + k.s, l.height + k.outer, k.name, -7);
  for (const DrawnMark& b : l.drawing.bearings)
    add_name(l.x + b.s, l.height - b.radius - 1.6 * glyph_, b.name, 15);
}

void MachineElevation::add_links() {
  for (const MachineLink& k : machine_.links) {
    Patch p;
    if (&k == &machine_.links.front()) p.label = "between lines";
    const double w = 0.5 * glyph_;
    const double from = std::abs(k.to - k.from) > 1e-9 ? k.from : k.from - w;
    p.x = {mm * (k.x - w), mm * (k.x + w), mm * (k.x + w), mm * (k.x - w)};
    p.y = {mm * from, mm * from, mm * k.to, mm * k.to};
    p.style = {4, Dash::solid, 1.2};
    p.fill_opacity = 0.6;
    p.tooltip = k.name;
    axes_.patches.push_back(std::move(p));
    add_name(k.x, std::max(from, k.to), k.name, -7);
  }
}

Figure MachineElevation::figure(std::string name) {
  // casings first: what runs inside is drawn over them
  int color = 0;
  for (const MachineLine& l : machine_.lines)
    add_line(l, color++);
  add_links();
  for (const MachineLine& l : machine_.lines)
    add_names(l);
  Series centre;
  centre.trace_label = "centre lines";
  for (const MachineLine& l : machine_.lines) {
    if (l.drawing.sections.empty()) continue;
    for (const double s : {l.drawing.sections.front().s0, l.drawing.sections.back().s1}) {
      centre.x.push_back(mm * (l.x + s));
      centre.y.push_back(mm * l.height);
    }
    centre.x.push_back(nan);
    centre.y.push_back(nan);
  }
  centre.style = {ink, Dash::dash_dot, 0.9};
  axes_.series.push_back(std::move(centre));
  const double room = 4.5 * glyph_;
  axes_.y.min = mm * (y0_ - room);
  axes_.y.max = mm * (y1_ + room);
  Figure f;
  f.name = std::move(name);
  f.title = machine_.title;
  f.width = 860;
  f.height = 420;
  if (axes_.equal_aspect)
    f.height = std::clamp(110 + 780 * (y1_ - y0_ + 2 * room) / (1.1 * (x1_ - x0_)), 300.0, 680.0);
  else
    f.caption = "Radii are drawn larger than lengths.";
  f.axes.push_back(std::move(axes_));
  return f;
}

}  // namespace

Figure plot_machine(std::string name, const MachineDrawing& machine) {
  return MachineElevation(machine).figure(std::move(name));
}

}  // namespace whirl::plot
