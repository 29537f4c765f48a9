// What a motion leaves of the gaps along a machine.
#include <plot/plots.hpp>

#include <core/text.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot {

namespace {

/// The wall behind a gap: from the gap outwards.
Patch wall_of(const GapMark& g, double half_width, double top, double unit) {
  Patch p;
  const double x0 = mm * (g.x - half_width), x1 = mm * (g.x + half_width);
  p.x = {x0, x1, x1, x0};
  p.y = {unit * g.gap, unit * g.gap, top, top};
  p.style = {7, Dash::solid, 1.0};
  p.fill_opacity = 0.3;
  p.tooltip = g.name + ": gap " + readable(unit * g.gap, 4);
  return p;
}

/// "seal 4: 37 %"
std::string share_text(const GapMark& g) {
  return g.name + ": " + readable(100 * g.reach / g.gap, 3) + " %";
}

}  // namespace

Figure plot_clearances(std::string name, std::string title, std::span<const ReachLine> lines,
                       std::span<const GapMark> gaps) {
  double most = 0, widest = 0, x0 = infinity, x1 = -infinity;
  for (const ReachLine& l : lines)
    for (std::size_t i = 0; i < l.x.size(); ++i) {
      most = std::max(most, l.reach[i]);
      x0 = std::min(x0, l.x[i]);
      x1 = std::max(x1, l.x[i]);
    }
  for (const GapMark& g : gaps) {
    most = std::max(most, g.reach);
    widest = std::max(widest, g.gap);
    x0 = std::min(x0, g.x);
    x1 = std::max(x1, g.x);
  }
  const DisplayUnit u = length_unit(std::max(most, widest));
  Axes a;
  a.x = Axis("axial position", "mm");
  // where the gaps dwarf the motion, decades show both
  a.y = Axis("distance from the middle", u.name, most > 0 && widest > 25 * most);
  a.y.include_zero = !a.y.logarithmic;
  const double top = 1.12 * u.factor * std::max(most, widest);
  a.y.max = top;
  if (a.y.logarithmic) a.y.min = 0.02 * u.factor * most;
  const double half_width = std::max(0.008 * (x1 - x0), 1e-6);
  int color = 0;
  for (const ReachLine& l : lines) {
    Series s;
    s.label = l.label;
    s.style = {color++, Dash::solid, 1.9};
    for (std::size_t i = 0; i < l.x.size(); ++i) {
      s.x.push_back(mm * l.x[i]);
      s.y.push_back(u.factor * l.reach[i]);
    }
    a.series.push_back(std::move(s));
  }
  Series used;
  used.label = "in the gap";
  used.style = {1, Dash::solid, 0, Marker::diamond, 9};
  for (const GapMark& g : gaps) {
    a.patches.push_back(wall_of(g, half_width, top, u.factor));
    if (&g == &gaps.front()) a.patches.back().label = "walls";
    used.x.push_back(mm * g.x);
    used.y.push_back(u.factor * g.reach);
    used.point_names.push_back(share_text(g));
    a.notes.push_back({mm * g.x, u.factor * g.gap, share_text(g)});
  }
  if (!gaps.empty()) a.series.push_back(std::move(used));
  Figure f;
  f.name = std::move(name);
  f.title = std::move(title);
  f.height = 400;
  f.axes.push_back(std::move(a));
  return f;
}

}  // namespace whirl::plot
