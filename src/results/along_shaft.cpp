#include <results/along_shaft.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

std::string element_name(const meshes::Mesh& mesh, std::size_t element) {
  const meshes::Element& e = mesh.elements.at(element);
  return fmt::format("{}, {:.4g} to {:.4g} m", mesh.lines[at(e.line)].name, e.s1, e.s2);
}

namespace {

/// Axis in the unit that suits the largest value of its curves; scales them.
void take_unit(plot::Axes& a, const std::string& si) {
  double largest = 0;
  for (const plot::Series& s : a.series)
    largest = std::max(largest, largest_of(s));
  const plot::DisplayUnit u = plot::unit_for(si, largest);
  for (plot::Series& s : a.series)
    for (double& y : s.y)
      y *= u.factor;
  a.y.unit = u.name;
}

/// Supports as thin vertical lines.
void mark_supports(plot::Axes& a, const run::Job& job, std::size_t line, bool named) {
  const auto add = [&](double s, const std::string& name) {
    plot::Rule r;
    r.value = s;
    if (named) r.label = name;
    a.rules.push_back(r);
  };
  for (const model::Bearing& b : job.model.bearings) {
    if (b.at.shaft == line) add(b.at.s, b.name);
    if (b.to && b.to->shaft == line) add(b.to->s, b.name);
  }
}

}  // namespace

plot::Series curve_of(std::string label) {
  plot::Series s;
  s.label = std::move(label);
  s.keep_all = true;
  return s;
}

double largest_of(const plot::Series& s) {
  double largest = 0;
  for (double y : s.y)
    largest = std::max(largest, std::abs(y));
  return largest;
}

plot::Figure figure_of_line(const run::Job& job, const std::string& step, const char* what,
                            std::size_t line) {
  plot::Figure f;
  f.name = job.mesh.lines.size() > 1 ? fmt::format("{}_{}_{}", step, what, line + 1)
                                     : fmt::format("{}_{}", step, what);
  return f;
}

void add_row(plot::Figure& f, const run::Job& job, std::size_t line, const char* label,
             const std::string& unit, std::vector<plot::Series> curves, bool of_several) {
  plot::Axes a;
  a.x = plot::Axis("position along the shaft", "m");
  a.x.min = 0.0;
  a.x.max = job.mesh.lines[line].length;
  a.y = plot::Axis(label, "");
  a.y.include_zero = true;
  a.series = std::move(curves);
  mark_supports(a, job, line, f.axes.empty());
  a.share_x = !f.axes.empty();
  a.legend = a.series.size() > 1;
  if (!a.legend && of_several) a.y.label += " " + a.series.front().label;
  if (unit == "rad")
    a.y.unit = "rad";
  else
    take_unit(a, unit);
  f.axes.push_back(std::move(a));
}

}  // namespace whirl::results
