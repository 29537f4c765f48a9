// Mode shapes and the drawing of the rotor; error against run time.
#include <plot/plots.hpp>
#include <core/text.hpp>
#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::plot {

Figure plot_mode_shape(std::string name, std::string title, const ModeShape& mode) {
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 640;
  const std::size_t n = mode.s.size();
  // Scale: the largest excursion is 1. Phase: the moment of that excursion.
  double largest = 0, theta0 = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (int k = 0; k < 90; ++k) {
      const double theta = two_pi * k / 90;
      const Complex z = std::polar(1.0, theta);
      if (const double r = std::hypot((z * mode.y[i]).real(), (z * mode.z[i]).real());
          r > largest) {
        largest = r;
        theta0 = theta;
      }
    }
  const double scale = largest > 0 ? 1 / largest : 1;
  const Complex at0 = std::polar(scale, theta0);
  const double most = n ? std::max(std::abs(mode.s.front()), std::abs(mode.s.back())) : 1;
  const DisplayUnit u = most >= 10 ? DisplayUnit{1, "m"} : DisplayUnit{1e3, "mm"};

  Axes space;
  space.kind = AxesKind::space;
  space.space_aspect = {2.4, 1, 1};
  space.view = {-62, 20};
  space.x = Axis("axial position", u.name);
  space.y = Axis("y", "-");
  space.z = Axis("z", "-");
  space.y.min = space.z.min = -1.08;
  space.y.max = space.z.max = 1.08;
  space.weight = 1.7;
  SpaceSeries rest{"", {}, {}, {}, Style{ink, Dash::dash_dot, 0.9}},
      line{"deflected shaft", {}, {}, {}, Style{0, Dash::solid, 2.4}},
      dots{"", {}, {}, {}, Style{0, Dash::solid, 0, Marker::circle, 4.5}};
  SpaceSeries orbits{"orbits of the stations", {}, {}, {}, Style{1, Dash::solid, 0.9}};
  Series y, z, envelope;
  y.label = "y";
  z.label = "z";
  envelope.label = "largest radius";
  y.style = {0, Dash::solid, 1.8};
  z.style = {1, Dash::dashed, 1.8};
  envelope.style = {7, Dash::dotted, 1.5};
  for (std::size_t i = 0; i < n; ++i) {
    const double s = u.factor * mode.s[i], ry = (at0 * mode.y[i]).real(),
                 rz = (at0 * mode.z[i]).real();
    rest.x.push_back(s);
    rest.y.push_back(0);
    rest.z.push_back(0);
    line.x.push_back(s);
    line.y.push_back(ry);
    line.z.push_back(rz);
    y.x.push_back(s);
    y.y.push_back(ry);
    z.x.push_back(s);
    z.y.push_back(rz);
    // Major semi-axis of the ellipse: the sum of the two circular parts.
    const Complex i1(0, 1);
    envelope.x.push_back(s);
    envelope.y.push_back(
        scale * 0.5 *
        (std::abs(mode.y[i] + i1 * mode.z[i]) + std::abs(mode.y[i] - i1 * mode.z[i])));
    if (n > 16 && i % (n / 13) != 0 && i + 1 != n) continue;
    for (int k = 0; k <= 48; ++k) {
      const Complex p = std::polar(1.0, two_pi * k / 48) * at0;
      orbits.x.push_back(s);
      orbits.y.push_back((p * mode.y[i]).real());
      orbits.z.push_back((p * mode.z[i]).real());
    }
    orbits.x.push_back(nan);
    orbits.y.push_back(nan);
    orbits.z.push_back(nan);
    dots.x.push_back(s);
    dots.y.push_back(ry);
    dots.z.push_back(rz);
  }
  space.space = {std::move(rest), std::move(orbits), std::move(line), std::move(dots)};

  Axes planes;
  planes.x = Axis("axial position", u.name);
  planes.y = Axis("deflection, largest = 1", "-");
  planes.series = {std::move(y), std::move(z), std::move(envelope)};
  planes.rules.push_back({false, 0, "", {ink, Dash::solid, 0.8}});
  for (const auto& [text, s] : mode.stations)
    planes.rules.push_back({true, u.factor * s, text, {faint, Dash::dashed, 1.0}});
  f.axes = {std::move(space), std::move(planes)};
  if (!mode.label.empty()) f.caption = mode.label;
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
  f.axes.push_back(std::move(a));
  return f;
}

Figure plot_rotor(std::string name, const RotorDrawing& rotor) {
  Figure f;
  f.name = std::move(name);
  f.title = rotor.title;
  constexpr double mm = 1e3;
  double s0 = infinity, s1 = -infinity, r1 = 0;
  for (const auto& p : rotor.sections) {
    s0 = std::min(s0, p.s0);
    s1 = std::max(s1, p.s1);
    r1 = std::max({r1, p.outer_left, p.outer_right});
  }
  for (const auto& d : rotor.disks) {
    s0 = std::min(s0, d.s - d.width / 2);
    s1 = std::max(s1, d.s + d.width / 2);
    r1 = std::max(r1, d.outer);
  }
  for (const auto& b : rotor.bearings) {
    s0 = std::min(s0, b.s);
    s1 = std::max(s1, b.s);
  }
  if (!(s1 > s0)) {
    s0 -= 0.5 * std::max(r1, 1e-3);
    s1 = s0 + std::max(r1, 1e-3);
  }
  if (!(r1 > 0)) r1 = (s1 - s0) / 50;
  Axes a;
  a.x = Axis("axial position", "mm");
  a.y = Axis("radius", "mm");
  const double glyph = std::max(0.12 * r1, 0.018 * (s1 - s0));
  // Drawn to one scale unless that would make it a hair.
  a.equal_aspect = s1 - s0 < 16 * r1;
  a.legend = true;
  // An outer and an inner radius along s: two halves, or one area when there is no bore.
  const auto outline = [&](double sa, double sb, std::array<double, 2> outer,
                           std::array<double, 2> inner, int color, double opacity,
                           const std::string& tip, const std::string& label) {
    const bool solid = inner[0] <= 0 && inner[1] <= 0;
    for (const double side : {1.0, -1.0}) {
      if (solid && side < 0) break;
      Patch p;
      p.label = side > 0 ? label : "";
      p.x = {mm * sa, mm * sb, mm * sb, mm * sa};
      p.y = {mm * side * outer[0], mm * side * outer[1], mm * side * (solid ? -outer[1] : inner[1]),
             mm * side * (solid ? -outer[0] : inner[0])};
      p.style = {color, Dash::solid, 1.1};
      p.fill_opacity = opacity;
      p.tooltip = tip;
      a.patches.push_back(std::move(p));
    }
  };
  const auto d = [](double radius) { return readable(2e3 * radius, 5); };
  for (const auto& p : rotor.sections) {
    std::string tip = p.name + ": length " + readable(mm * (p.s1 - p.s0), 5) +
                      " mm, outer diameter " + d(p.outer_left);
    if (p.outer_right != p.outer_left) tip += " to " + d(p.outer_right);
    tip += " mm";
    if (p.inner_left > 0 || p.inner_right > 0)
      tip += ", bore " + d(p.inner_left) +
             (p.inner_right != p.inner_left ? " to " + d(p.inner_right) : "") + " mm";
    outline(p.s0, p.s1, {p.outer_left, p.outer_right}, {p.inner_left, p.inner_right}, 0, 0.22, tip,
            &p == &rotor.sections.front() ? "shaft" : "");
  }
  for (const auto& p : rotor.disks)
    outline(p.s - p.width / 2, p.s + p.width / 2, {p.outer, p.outer}, {p.inner, p.inner}, 1, 0.35,
            p.name + ": outer diameter " + d(p.outer) + " mm, width " + readable(mm * p.width, 4) +
                " mm",
            &p == &rotor.disks.front() ? "disks" : "");
  for (const auto& b : rotor.bearings) {  // a support: triangle under the shaft
    Patch p;
    p.label = &b == &rotor.bearings.front() ? "bearings" : "";
    p.x = {mm * b.s, mm * (b.s + glyph), mm * (b.s - glyph)};
    p.y = {-mm * b.radius, -mm * (b.radius + 1.6 * glyph), -mm * (b.radius + 1.6 * glyph)};
    p.style = {2, Dash::solid, 1.2};
    p.fill_opacity = 0.4;
    p.tooltip = b.name;
    a.patches.push_back(std::move(p));
  }
  Series centre;
  centre.trace_label = "centre line";
  const double over = 0.02 * (s1 - s0);
  centre.x = {mm * (s0 - over), mm * (s1 + over)};
  centre.y = {0, 0};
  centre.style = {ink, Dash::dash_dot, 0.9};
  a.series.push_back(std::move(centre));
  if (!rotor.nodes.empty()) {
    Series nodes;
    nodes.label = "nodes";
    for (const double s : rotor.nodes) {
      nodes.x.push_back(mm * s);
      nodes.y.push_back(0);
    }
    nodes.style = {ink, Dash::solid, 0, Marker::circle, 3.5};
    a.series.push_back(std::move(nodes));
  }
  if (!rotor.probes.empty()) {
    Series probes;
    probes.label = "probes";
    for (const auto& p : rotor.probes) {
      probes.x.push_back(mm * p.s);
      probes.y.push_back(mm * (p.radius + 0.6 * glyph));
    }
    probes.style = {3, Dash::solid, 0, Marker::triangle, 9};
    a.series.push_back(std::move(probes));
  }
  // Names outside the outline: disks and bearings below, probes above.
  const auto centred = [](const std::string& text, double dy) {
    return std::pair{-text_width(text, 11) / 2, dy};
  };
  for (const auto& p : rotor.disks) {
    const auto [dx, dy] = centred(p.name, 15);
    a.notes.push_back({mm * p.s, -mm * p.outer, p.name, false, dx, dy});
  }
  for (const auto& p : rotor.bearings) {
    const auto [dx, dy] = centred(p.name, 15);
    a.notes.push_back({mm * p.s, -mm * (p.radius + 1.6 * glyph), p.name, false, dx, dy});
  }
  for (const auto& p : rotor.probes) {
    const auto [dx, dy] = centred(p.name, -9);
    a.notes.push_back({mm * p.s, mm * (p.radius + 0.6 * glyph), p.name, false, dx, dy});
  }
  const double reach = r1 + 3.2 * glyph;
  a.y.min = -mm * reach;
  a.y.max = mm * reach;
  f.width = 860;
  // As high as one scale wants, within reason.
  f.height =
      a.equal_aspect ? std::clamp(110 + 780 * 2 * reach / (1.1 * (s1 - s0)), 240.0, 620.0) : 300;
  if (!a.equal_aspect) f.caption = "Radii are drawn larger than lengths.";
  f.axes.push_back(std::move(a));
  return f;
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
