// Curves in space, parallel projection. The report's script repeats this projection when the figure
// is turned.
#include <plot/svg_draw.hpp>
#include <core/text.hpp>
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

}  // namespace

void draw_space(Canvas& c, const Axes& a, const Box& cell) {
  const Colors k = resolve_colors(a);
  const std::array<const Axis*, 3> axis = {&a.x, &a.y, &a.z};
  std::array<Scale, 3> scale;
  for (std::size_t d = 0; d < 3; ++d) {
    double lo = infinity, hi = -infinity;
    for (const auto& s : a.space)
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
    const double pad = 0.03 * (hi - lo);
    scale[d] = {std::isnan(axis[d]->min) ? lo - pad : axis[d]->min,
                std::isnan(axis[d]->max) ? hi + pad : axis[d]->max, false, -a.space_aspect[d] / 2,
                a.space_aspect[d] / 2};
  }
  if (a.equal_aspect) {  // one unit of length for all: the box follows the data
    double longest = 0;
    for (const auto& s : scale)
      longest = std::max(longest, s.hi - s.lo);
    for (auto& s : scale) {
      s.p1 = (s.hi - s.lo) / longest;
      s.p0 = -s.p1;
    }
  }
  const Projection view(a.view);
  const double top = a.title.empty() ? 6 : 26;
  const Box box{cell.x + 56, cell.y + top + 2, cell.w - 112, cell.h - top - 48};
  Vec3 lo = Vec3::Constant(infinity), hi = -lo;
  for (int i = 0; i < 8; ++i) {
    const Vec3 p = view(Vec3(i & 1 ? scale[0].p1 : scale[0].p0, i & 2 ? scale[1].p1 : scale[1].p0,
                             i & 4 ? scale[2].p1 : scale[2].p0));
    lo = lo.cwiseMin(p);
    hi = hi.cwiseMax(p);
  }
  const double unit = std::min(box.w / (hi.x() - lo.x()), box.h / (hi.y() - lo.y()));
  const double cx = box.x + box.w / 2 - unit * (lo.x() + hi.x()) / 2,
               cy = box.y + box.h / 2 + unit * (lo.y() + hi.y()) / 2;
  const auto px = [&](const Vec3& p) {
    const Vec3 q = view(p);
    return Point{cx + unit * q.x(), cy - unit * q.y()};
  };

  c.add("<g class=\"axes\" data-kind=\"space\" data-box=\"" + number_text(box.x) + " " +
        number_text(box.y) + " " + number_text(box.w) + " " + number_text(box.h) +
        "\" data-view=\"" + number_text(a.view[0]) + " " + number_text(a.view[1]) +
        "\" data-half=\"" + number_text(scale[0].p1, 4) + " " + number_text(scale[1].p1, 4) + " " +
        number_text(scale[2].p1, 4) + '"');
  axis_attributes(c, "x", a.x, scale[0]);
  axis_attributes(c, "y", a.y, scale[1]);
  axis_attributes(c, "z", a.z, scale[2]);
  c.add(">\n");
  if (!a.title.empty())
    c.text(cell.x + 8, cell.y + top - 9, a.title, title_size, "start", "font-weight=\"600\"");

  // The three faces of the box behind the data, with their grids; then labelled edges.
  c.add("<g class=\"box\">\n");
  const Vec3 towards(view.ca * view.ce, view.sa * view.ce, view.se);
  std::array<double, 3> back;
  for (std::size_t d = 0; d < 3; ++d)
    back[d] = towards[static_cast<Index>(d)] > 0 ? scale[d].p0 : scale[d].p1;
  std::array<Ticks, 3> ticks;
  for (std::size_t d = 0; d < 3; ++d)
    ticks[d] =
        linear_ticks(scale[d].lo, scale[d].hi, std::clamp(unit * 2 * scale[d].p1 / 70, 2.0, 6.0));
  const auto segment = [&](const Vec3& p, const Vec3& q, const std::string& s) {
    const Point m = px(p), n = px(q);
    c.line(m.x, m.y, n.x, n.y, s);
  };
  for (Index d = 0; d < 3; ++d) {
    const Index u = (d + 1) % 3, v = (d + 2) % 3;  // grid lines of u and v on the back face of d
    const auto at = [](Index i) { return static_cast<std::size_t>(i); };
    Vec3 p, q;
    p[d] = q[d] = back[at(d)];
    for (const auto& [i, j] : {std::pair{u, v}, {v, u}}) {
      p[j] = scale[at(j)].p0;
      q[j] = scale[at(j)].p1;
      for (const double tick : ticks[at(i)].major) {
        p[i] = q[i] = scale[at(i)](tick);
        segment(p, q, stroke(faint, 0.8));
      }
      for (const double edge : {scale[at(i)].p0, scale[at(i)].p1}) {
        p[i] = q[i] = edge;
        segment(p, q, stroke(faint, 1.2));
      }
    }
  }
  for (Index d = 0; d < 3; ++d) {
    // Labels along the edge on the outline: for x and y the lower one nearest the reader, for z the
    // leftmost.
    const auto at = [](Index i) { return static_cast<std::size_t>(i); };
    const Index u = d == 0 ? 1 : 0, v = d == 2 ? 1 : 2;
    Vec3 p = Vec3::Zero();
    if (d < 2) {
      p[u] = -back[at(u)];
      p[v] = scale[2].p0;
    } else {
      double leftmost = infinity;
      for (const double pu : {scale[0].p0, scale[0].p1})
        for (const double pv : {scale[1].p0, scale[1].p1})
          if (const double x = view(Vec3(pu, pv, 0)).x(); x < leftmost) {
            leftmost = x;
            p[0] = pu;
            p[1] = pv;
          }
    }
    Vec3 q = p;
    p[d] = scale[at(d)].p0;
    q[d] = scale[at(d)].p1;
    segment(p, q, stroke(ink, 0.9));
    const Point m = px(p), n = px(q), middle{(m.x + n.x) / 2, (m.y + n.y) / 2};
    // Outwards: away from the middle of the box.
    double ox = middle.x - (box.x + box.w / 2), oy = middle.y - (box.y + box.h / 2);
    const double ex = n.x - m.x, ey = n.y - m.y, el = std::max(1e-9, std::hypot(ex, ey)),
                 along = (ox * ex + oy * ey) / el;
    ox -= along * ex / el;
    oy -= along * ey / el;
    const double ol = std::max(1e-9, std::hypot(ox, oy));
    ox /= ol;
    oy /= ol;
    if (el < 12) continue;  // seen end on
    double widest = 0;
    for (std::size_t i = 0; i < ticks[at(d)].major.size(); ++i) {
      Vec3 w = p;
      w[d] = scale[at(d)](ticks[at(d)].major[i]);
      const Point t = px(w);
      c.line(t.x, t.y, t.x + 4 * ox, t.y + 4 * oy, stroke(ink, 0.9));
      c.text(t.x + 9 * ox, t.y + 11 * oy + 4, ticks[at(d)].labels[i], tick_size - 0.5,
             ox > 0.35    ? "start"
             : ox < -0.35 ? "end"
                          : "middle");
      widest = std::max(widest, text_width(ticks[at(d)].labels[i], tick_size));
    }
    const double reach = 16 + std::abs(ox) * widest + 12 * std::abs(oy);
    if (d == 2) {
      const double x = middle.x + reach * ox - 6, y = middle.y;
      c.text(x, y, axis_title(*axis[2], ticks[2].exponent), label_size, "middle",
             "transform=\"rotate(-90 " + number_text(x) + " " + number_text(y) + ")\"");
    } else
      c.text(middle.x + reach * ox, middle.y + reach * oy + 6,
             axis_title(*axis[at(d)], ticks[at(d)].exponent), label_size,
             ox > 0.35    ? "start"
             : ox < -0.35 ? "end"
                          : "middle");
  }
  c.add("</g>\n<g class=\"plot\">\n");
  std::vector<Point> seen;
  for (std::size_t i = 0; i < a.space.size(); ++i) {
    const auto& s = a.space[i];
    std::vector<Vec3> p(s.x.size());
    for (std::size_t j = 0; j < p.size(); ++j)
      p[j] = {scale[0](s.x[j]), scale[1](s.y[j]), scale[2](s.z[j])};
    std::vector<double> qx, qy;
    std::string xyz;
    for (const auto j : thin(p)) {
      if (std::isnan(p[j].x() + p[j].y() + p[j].z())) {
        qx.push_back(nan);
        qy.push_back(nan);
        xyz += "| ";
        continue;
      }
      const Point q = px(p[j]);
      qx.push_back(q.x);
      qy.push_back(q.y);
      for (Index d = 0; d < 3; ++d) {
        append_number(xyz, p[j][d], 4);
        xyz += ' ';
      }
    }
    if (!xyz.empty()) xyz.pop_back();
    std::string d = path_of(qx, qy, true, false, 1, &seen);
    if (s.closed_fill) d += "Z";
    c.add("<path data-s=\"" + std::to_string(i) + "\" data-name=\"" + escape(s.label) +
          "\" data-xyz=\"" + xyz + "\" " + (s.closed_fill ? "data-quiet=\"1\" " : ""));
    if (s.closed_fill)
      c.add(fill(k.space[i]) + " fill-opacity=\"0.13\"");
    else
      c.add(stroke(k.space[i], s.style.width, s.style.dash) + " stroke-linejoin=\"round\"");
    if (s.style.opacity < 1) c.attr("stroke-opacity", s.style.opacity);
    c.add(" d=\"" + d + "\"/>\n");
    if (s.style.marker != Marker::none)
      draw_pins(c, qx, qy, s.style, k.space[i], static_cast<int>(i), false,
                " data-name=\"" + escape(s.label) + "\" data-xyz=\"" + xyz + "\"");
  }
  c.add("</g>\n");
  const auto entries = legend_entries(a, k);
  const Box size = legend_size_of(entries);
  draw_legend(c, entries, cell, seen, {},
              {cell.right() - size.w - 4, cell.y + top, size.w, size.h});
  c.add("</g>\n");
}

}  // namespace whirl::plot::svg
