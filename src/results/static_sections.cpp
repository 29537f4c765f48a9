// Section forces and stresses of a static state.
#include <results/along_shaft.hpp>
#include <results/static_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace whirl::results {

namespace {

using assembly::SectionPoint;
using Value = double (*)(const SectionPoint&);

bool is_of(const SectionPoint& p, std::size_t line) { return p.line == static_cast<Index>(line); }

/// Stress field: "" where there is none.
io::Table::Cell stress_cell(const SectionPoint& p, double x) {
  return p.has_stress ? io::Table::Cell(x) : io::Table::Cell("");
}

/// Behind what is not what any moment of the turn has.
constexpr std::string_view as_mean = ", mean over a turn in fixed axes";

void add_section_table(const run::Job& job, bool means, StaticResults& out) {
  io::Table& t = out.sections;
  t.title = "Section forces and stresses";
  if (means) t.title += as_mean;
  t.columns = {{"shaft", "-", ""},
               {"s", "m", ""},
               {"element", "-", ""},
               {"N", "N", "axial force, tension positive"},
               {"V_y", "N", "of the right part on the left one"},
               {"V_z", "N", ""},
               {"T", "N m", "torque"},
               {"M_y", "N m", ""},
               {"M_z", "N m", "positive: hollow towards +y"},
               {"M", "N m", "bending moment, resultant"},
               {"axial stress", "Pa", ""},
               {"bending stress", "Pa", ""},
               {"torsion stress", "Pa", ""},
               {"von Mises stress", "Pa", ""}};
  for (const SectionPoint& p : out.points)
    t.add({job.mesh.lines[at(p.line)].name, p.s, static_cast<double>(p.element), p.N, p.V.x(),
           p.V.y(), p.T, p.M.x(), p.M.y(), p.M.norm(), stress_cell(p, p.axial),
           stress_cell(p, p.bending), stress_cell(p, p.torsion), stress_cell(p, p.von_mises)});
}

struct SectionExtreme {
  double value = 0, s = 0;
  bool any = false;
};

/// Of one line, by magnitude, with its sign.
SectionExtreme find_extreme(const std::vector<SectionPoint>& points, std::size_t line, Value of,
                            bool stress) {
  SectionExtreme best;
  for (const SectionPoint& p : points) {
    if (!is_of(p, line) || (stress && !p.has_stress)) continue;
    const double v = of(p);
    if (!best.any || std::abs(v) > std::abs(best.value) * (1 + 1e-9)) best = {v, p.s, true};
  }
  return best;
}

/// Largest von Mises stress over yield strength; 0 where no material has one.
double yield_use_of(const run::Job& job, const std::vector<SectionPoint>& points,
                    std::size_t line) {
  double use = 0;
  if (job.model.materials.empty()) return use;
  for (const SectionPoint& p : points) {
    if (!is_of(p, line) || !p.has_stress) continue;
    const std::size_t section = job.mesh.elements[at(p.element)].section;
    const double yield =
        job.model.materials.at(job.model.shafts[line].sections[section].material).yield;
    if (yield > 0) use = std::max(use, p.von_mises / yield);
  }
  return use;
}

/// What is below it is rounding, not a result: a billionth of the largest force, moment or stress
/// (by their unit) on a line.
double rounding_of(const std::vector<SectionPoint>& points, std::size_t line,
                   const std::string& unit) {
  double largest = 0;
  for (const SectionPoint& p : points) {
    if (!is_of(p, line)) continue;
    largest = std::max(largest, unit == "N"     ? std::hypot(p.N, p.V.norm())
                                : unit == "N m" ? std::hypot(p.T, p.M.norm())
                                                : p.von_mises);
  }
  return 1e-9 * largest;
}

/// The largest value of every quantity on one line.
void add_extremes(const run::Job& job, std::size_t line, StaticResults& out, io::Value& summary) {
  const std::string& name = job.mesh.lines[line].name;
  const std::string owner =
      fmt::format("{} '{}'", job.mesh.lines[line].rotating ? "shaft" : "casing", name);
  const auto add = [&](const char* label, const char* si, Value of, bool stress) {
    const SectionExtreme x = find_extreme(out.points, line, of, stress);
    if (!x.any) return x;
    const bool real = std::abs(x.value) > rounding_of(out.points, line, si);
    const double shown = real ? x.value : 0.0;
    const plot::DisplayUnit unit = plot::unit_for(si, std::abs(shown));
    out.extremes.add({name, label, shown * unit.factor, unit.name, x.s});
    summary["largest"][name][fmt::format("{} [{}]", label, si)] = shown;
    if (real) summary["largest"][name][fmt::format("{} at [m]", label)] = x.s;
    return x;
  };
  const auto say = [&](const char* what, const char* si, const SectionExtreme& x,
                       const std::string& more) {
    const plot::DisplayUnit u = plot::unit_for(si, x.value);
    out.lines.push_back(fmt::format("{}: largest {} {:.4g} {} at {:.4g} m{}", owner, what,
                                    x.value * u.factor, u.name, x.s, more));
  };
  add(
      "axial force", "N", [](const SectionPoint& p) { return p.N; }, false);
  add(
      "shear force", "N", [](const SectionPoint& p) { return p.V.norm(); }, false);
  add(
      "torque", "N m", [](const SectionPoint& p) { return p.T; }, false);
  const SectionExtreme moment = add(
      "bending moment", "N m", [](const SectionPoint& p) { return p.M.norm(); }, false);
  if (moment.value > 0) say("bending moment", "N m", moment, "");
  add(
      "axial stress", "Pa", [](const SectionPoint& p) { return p.axial; }, true);
  add(
      "bending stress", "Pa", [](const SectionPoint& p) { return p.bending; }, true);
  add(
      "torsion stress", "Pa", [](const SectionPoint& p) { return p.torsion; }, true);
  const SectionExtreme stress = add(
      "von Mises stress", "Pa", [](const SectionPoint& p) { return p.von_mises; }, true);
  if (!(stress.value > 0)) return;
  const double use = yield_use_of(job, out.points, line);
  say("von Mises stress", "Pa", stress,
      use > 0 ? fmt::format(", safety against yield {:.3g}", 1.0 / use) : "");
  if (use > 0) summary["largest"][name]["safety against yield"] = 1.0 / use;
}

/// One row of axes a kind of result that is not zero everywhere.
struct Row {
  const char* label;
  const char* unit;
  std::vector<std::pair<const char*, Value>> curves;
};

void add_rows(plot::Figure& f, const run::Job& job, std::size_t line,
              const std::vector<SectionPoint>& points, const std::vector<Row>& rows) {
  // What is below 1e-9 of the largest value of its unit is rounding, not a result.
  std::vector<double> largest(rows.size(), 0.0);
  std::map<std::string, double> of_unit;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const auto& [label, value] : rows[r].curves)
      for (const SectionPoint& p : points)
        if (is_of(p, line)) largest[r] = std::max(largest[r], std::abs(value(p)));
    of_unit[rows[r].unit] = std::max(of_unit[rows[r].unit], largest[r]);
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!(largest[r] > 1e-6 * of_unit[rows[r].unit])) continue;  // nothing one could read
    std::vector<plot::Series> shown;
    for (const auto& [label, value] : rows[r].curves) {
      plot::Series s = curve_of(label);
      for (const SectionPoint& p : points) {
        if (!is_of(p, line)) continue;
        s.x.push_back(p.s);
        s.y.push_back(value(p));
      }
      if (largest_of(s) > 1e-9 * largest[r]) shown.push_back(std::move(s));
    }
    add_row(f, job, line, rows[r].label, rows[r].unit, std::move(shown), rows[r].curves.size() > 1);
  }
  f.height = 90.0 + 190.0 * static_cast<double>(f.axes.size());
}

plot::Figure force_figure(const run::Job& job, const std::string& step, std::size_t line,
                          const std::vector<SectionPoint>& points, const std::string& of) {
  plot::Figure f = figure_of_line(job, step, "sections", line);
  f.title = "Section forces" + of;
  f.caption =
      "Of the right part on the left one; N tension positive; M_z positive bends the shaft "
      "hollow towards +y.";
  add_rows(f, job, line, points,
           {{"shear force",
             "N",
             {{"V_y", [](const SectionPoint& p) { return p.V.x(); }},
              {"V_z", [](const SectionPoint& p) { return p.V.y(); }}}},
            {"bending moment",
             "N m",
             {{"M_z", [](const SectionPoint& p) { return p.M.y(); }},
              {"M_y", [](const SectionPoint& p) { return p.M.x(); }}}},
            {"torque", "N m", {{"T", [](const SectionPoint& p) { return p.T; }}}},
            {"axial force", "N", {{"N", [](const SectionPoint& p) { return p.N; }}}}});
  return f;
}

plot::Figure stress_figure(const run::Job& job, const std::string& step, std::size_t line,
                           const std::vector<SectionPoint>& points, const std::string& of) {
  plot::Figure f = figure_of_line(job, step, "stress", line);
  f.title = "Stress at the surface" + of;
  f.caption =
      "Nominal, without stress concentration. In a turning shaft the bending stress alternates "
      "once a revolution.";
  add_rows(f, job, line, points,
           {{"stress",
             "Pa",
             {{"von Mises", [](const SectionPoint& p) { return p.von_mises; }},
              {"bending", [](const SectionPoint& p) { return p.bending; }},
              {"torsion", [](const SectionPoint& p) { return p.torsion; }},
              {"axial", [](const SectionPoint& p) { return p.axial; }}}}});
  f.height = 340;
  return f;
}

}  // namespace

void add_sections(const run::Job& job, const std::string& step, bool means, StaticResults& out,
                  io::Value& summary) {
  add_section_table(job, means, out);
  out.extremes.title = "Largest section forces and stresses";
  if (means) out.extremes.title += as_mean;
  out.extremes.columns = {{"shaft", "-", ""},
                          {"quantity", "-", ""},
                          {"value", "", ""},
                          {"unit", "-", ""},
                          {"s", "m", ""}};
  const bool stressed = std::any_of(out.points.begin(), out.points.end(),
                                    [](const SectionPoint& p) { return p.has_stress; });
  const auto show = [&](plot::Figure f) {
    if (!f.axes.empty()) out.figures.push_back(std::move(f));
  };
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    add_extremes(job, l, out, summary);
    std::string of = job.mesh.lines.size() > 1 ? " of " + job.mesh.lines[l].name : "";
    if (means) of += as_mean;
    show(force_figure(job, step, l, out.points, of));
    if (stressed) show(stress_figure(job, step, l, out.points, of));
  }
}

}  // namespace whirl::results
