#include <results/frame_arrays.hpp>
#include <results/static_results.hpp>

#include <plot/plots.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {
namespace {

using assembly::SectionPoint;

/// Axis in the unit that suits the largest value of its curves; scales them.
void finish(plot::Axes& a, const std::string& si) {
  double m = 0;
  for (const plot::Series& s : a.series)
    for (double y : s.y)
      m = std::max(m, std::abs(y));
  const plot::DisplayUnit u = plot::unit_for(si, m);
  for (plot::Series& s : a.series)
    for (double& y : s.y)
      y *= u.factor;
  a.y.unit = u.name;
}

plot::Series curve(std::string label) {
  plot::Series s;
  s.label = std::move(label);
  s.keep_all = true;
  return s;
}

plot::Axes axes_along(std::string y, double first, double last) {
  plot::Axes a;
  a.x = plot::Axis("position along the shaft", "m");
  a.x.min = first;
  a.x.max = last;
  a.y = plot::Axis(std::move(y), "");
  a.y.include_zero = true;
  return a;
}

/// Supports and disks as thin vertical lines.
void mark(plot::Axes& a, const run::Job& job, std::size_t line) {
  const auto rule = [&](double s, const std::string& name) {
    plot::Rule r;
    r.value = s;
    r.label = name;
    a.rules.push_back(r);
  };
  for (const model::Bearing& b : job.model.bearings) {
    if (b.at.shaft == line) rule(b.at.s, b.name);
    if (b.to && b.to->shaft == line) rule(b.to->s, b.name);
  }
}

/// One row of axes a kind of result that is not zero everywhere.
struct Row {
  const char* label;
  const char* unit;
  std::vector<std::pair<const char*, double (*)(const SectionPoint&)>> curves;
};

void add_rows(plot::Figure& f, const run::Job& job, std::size_t line,
              const std::vector<SectionPoint>& points, const std::vector<Row>& rows,
              double length) {
  // What is below 1e-9 of the largest value of its unit is rounding, not a result.
  std::vector<double> largest(rows.size(), 0.0);
  std::map<std::string, double> of_unit;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (const SectionPoint& p : points)
      if (p.line == static_cast<Index>(line))
        for (const auto& c : rows[r].curves)
          largest[r] = std::max(largest[r], std::abs(c.second(p)));
    of_unit[rows[r].unit] = std::max(of_unit[rows[r].unit], largest[r]);
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!(largest[r] > 1e-9 * of_unit[rows[r].unit])) continue;
    plot::Axes a = axes_along(rows[r].label, 0.0, length);
    for (const auto& c : rows[r].curves) {
      plot::Series s = curve(c.first);
      double m = 0;
      for (const SectionPoint& p : points) {
        if (p.line != static_cast<Index>(line)) continue;
        s.x.push_back(p.s);
        s.y.push_back(c.second(p));
        m = std::max(m, std::abs(c.second(p)));
      }
      if (m > 1e-9 * largest[r]) a.series.push_back(std::move(s));
    }
    mark(a, job, line);
    if (!f.axes.empty())
      for (plot::Rule& x : a.rules)
        x.label.clear();
    a.share_x = !f.axes.empty();
    a.legend = a.series.size() > 1;
    if (!a.legend && rows[r].curves.size() > 1) a.y.label += " " + a.series.front().label;
    finish(a, rows[r].unit);
    f.axes.push_back(std::move(a));
  }
  f.height = 90.0 + 190.0 * static_cast<double>(f.axes.size());
}

std::string file_safe(const std::string& step, const char* what, const run::Job& job,
                      std::size_t line) {
  return job.mesh.lines.size() > 1 ? fmt::format("{}_{}_{}", step, what, line + 1)
                                   : fmt::format("{}_{}", step, what);
}

/// Stress field: "" where there is none.
io::Table::Cell cell(const SectionPoint& p, double x) {
  return p.has_stress ? io::Table::Cell(x) : io::Table::Cell("");
}

}  // namespace

std::vector<SupportLoad> calc_support_loads(const run::Job& job, analysis::SteadySystem& running,
                                            const system::State& state, double Omega,
                                            const VecX& reactions) {
  const auto& supports = job.built.support_forces;
  std::vector<SupportLoad> out(supports.size());
  const auto reaction = [&](Index k) { return reactions[k]; };
  const bool inside = running.visit_revolution(
      state.frames, Omega, state.q, [&](double weight, const system::Workspace& w) {
        const auto node = [&](Index n) -> const system::NodeState& { return w.nodes[at(n)]; };
        for (std::size_t i = 0; i < supports.size(); ++i) {
          out[i].force += weight * supports[i].force(node, w.context, reaction);
          if (supports[i].moment)
            out[i].moment += weight * supports[i].moment(node, w.context, reaction);
        }
      });
  if (!inside) throw run_error("R11", "the state found cannot be evaluated", {});
  return out;
}

StaticResults make_static_results(run::Job& job, const std::string& step,
                                  system::SystemProblem& problem,
                                  const std::vector<SupportLoad>& loads, const VecX& reactions,
                                  std::span<const Index> spin_holds, io::Value& summary) {
  StaticResults out;
  const auto node = [&](Index n) -> const system::NodeState& {
    return problem.workspace().nodes[at(n)];
  };

  // ---- deflection
  out.deflection.title = "Deflection";
  out.deflection.columns = {{"shaft", "-", ""},
                            {"s", "m", "from the left end"},
                            {"station", "-", ""},
                            {"u_x", "m", "displacement of the centre line"},
                            {"u_y", "m", ""},
                            {"u_z", "m", ""},
                            {"slope_y", "rad", "d_y of the section normal"},
                            {"slope_z", "rad", "d_z"},
                            {"phi", "rad", "axial angle"}};
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    const meshes::Line& line = job.mesh.lines[l];
    plot::Series x = curve("axial"), y = curve("y"), z = curve("z"), phi = curve("angle");
    double worst = 0, where = 0;
    const meshes::Station* worst_at = nullptr;
    const double phi0 = node(line.first_node).phi;
    const Path& path = job.model.shafts[l].path;
    const auto size_of = [&](const Vec3& u) {
      return path.empty() ? std::hypot(u.y(), u.z()) : u.norm();
    };
    // direction of a line along a path, now
    const auto tangent = [&](const system::NodeState& n, const Path::Point& p) {
      return Vec3(meshes::section_axes(*n.chart, n.d(), n.phi) * p.triad.col(0));
    };
    for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
      const meshes::Station& st = job.mesh.stations[at(k)];
      const system::NodeState& n = node(st.at.node);
      const Vec3 u = n.u + st.at.offset * (n.d() - Vec3::UnitX());
      const Vec3 d = path.empty() ? n.d() : tangent(n, path.after(st.s));
      out.deflection.add({line.name, st.s, st.label(), u.x(), u.y(), u.z(), d.y(), d.z(), n.phi});
      x.x.push_back(st.s);
      x.y.push_back(u.x());
      y.x.push_back(st.s);
      y.y.push_back(u.y());
      z.x.push_back(st.s);
      z.y.push_back(u.z());
      phi.x.push_back(st.s);
      phi.y.push_back(n.phi - phi0);
      if (const double a = size_of(u); a > worst) {
        worst = a;
        where = st.s;
        worst_at = &st;
      }
    }
    // between nodes: the cubic with the directors as end slopes
    for (plot::Series* c : {&x, &y, &z}) {
      c->x.clear();
      c->y.clear();
    }
    for (Index k = line.first_element; k < line.first_element + line.elements; ++k) {
      const meshes::Element& e = job.mesh.elements[at(k)];
      const auto pose = [&](const meshes::Place& p) {
        const system::NodeState& n = node(p.node);
        return meshes::Pose{job.mesh.nodes[at(p.node)].position + n.u + p.offset * n.d(), n.d(),
                            n.phi};
      };
      meshes::Pose a = pose(e.left), b = pose(e.right);
      if (!path.empty()) {
        a.d = tangent(node(e.left.node), path.after(e.s1));
        b.d = tangent(node(e.right.node), path.before(e.s2));
      }
      // end slopes for the stretched length (thermal growth): chord, and the arc over it
      const double arc = (b.r - a.r).norm() * (1.0 + (b.d - a.d).squaredNorm() / 24.0);
      for (int i = k == line.first_element ? 0 : 1; i <= 8; ++i) {
        const double xi = i / 8.0, s = e.s1 + xi * (e.s2 - e.s1);
        const Vec3 u = meshes::interpolate(a, b, arc, xi).r - job.model.shafts[l].position(s);
        x.x.push_back(s);
        x.y.push_back(u.x());
        y.x.push_back(s);
        y.y.push_back(u.y());
        z.x.push_back(s);
        z.y.push_back(u.z());
        if (const double w = size_of(u); w > worst * (1 + 1e-9)) {
          worst = w;
          where = s;
          worst_at = nullptr;
        }
      }
    }
    plot::Figure f;
    f.name = file_safe(step, "deflection", job, l);
    f.title = job.mesh.lines.size() > 1 ? "Deflected centre line of " + line.name
                                        : "Deflected centre line";
    const auto largest = [](const plot::Series& s) {
      double m = 0;
      for (double v : s.y)
        m = std::max(m, std::abs(v));
      return m;
    };
    const double lateral = std::max(largest(y), largest(z)), size = std::max(lateral, largest(x)),
                 twist = largest(phi);
    const auto row = [&](const char* label, std::vector<plot::Series*> series, const char* unit,
                         double limit) {
      plot::Axes a = axes_along(label, 0.0, line.length);
      for (plot::Series* s : series)
        if (largest(*s) > limit) a.series.push_back(std::move(*s));
      if (a.series.empty()) return;
      mark(a, job, l);
      if (!f.axes.empty())
        for (plot::Rule& r : a.rules)
          r.label.clear();
      a.share_x = !f.axes.empty();
      a.legend = a.series.size() > 1;
      if (!a.legend && series.size() > 1) a.y.label += " " + a.series.front().label;
      if (std::string_view(unit) == "rad")
        a.y.unit = "rad";
      else
        finish(a, unit);
      f.axes.push_back(std::move(a));
    };
    row("lateral displacement", {&y, &z}, "m", std::max(1e-9 * lateral, 1e-15));
    row("axial displacement", {&x}, "m", std::max(1e-6 * size, 1e-15));
    row("twist from the left end", {&phi}, "rad", std::max(1e-9 * twist, 1e-13));
    f.height = 110.0 + 200.0 * static_cast<double>(std::max<std::size_t>(f.axes.size(), 1));
    if (!f.axes.empty()) out.figures.push_back(std::move(f));
    if (worst > 0) {
      const plot::DisplayUnit u = plot::length_unit(worst);
      out.lines.push_back(fmt::format(
          "{} '{}': largest deflection {:.4g} {} at {:.4g} m{}", line.rotating ? "shaft" : "casing",
          line.name, worst * u.factor, u.name, where,
          worst_at && !worst_at->labels.empty() ? " (" + worst_at->label() + ")" : std::string()));
      summary["deflection"][line.name]["largest [m]"] = worst;
      summary["deflection"][line.name]["at [m]"] = where;
    }
  }

  // ---- rolling elements
  out.rolling.title = "Loads of the rolling elements";
  out.rolling.columns = {{"bearing", "-", ""},
                         {"element", "-", ""},
                         {"angle", "deg", "from +y towards +z"},
                         {"load", "N", ""}};
  for (const assembly::RollingLoads& b : job.built.rolling_loads) {
    double most = 0;
    int number = 0, loaded = 0;
    for (const auto& e : b.loads(node)) {
      out.rolling.add({b.name, static_cast<double>(++number), e.angle * 180.0 / pi, e.load});
      most = std::max(most, e.load);
      loaded += e.load > 0 ? 1 : 0;
    }
    summary["rolling elements"][b.name]["largest load [N]"] = most;
    summary["rolling elements"][b.name]["loaded"] = loaded;
  }

  // ---- supports
  out.supports.title = "Supports: force and moment on the shaft";
  out.supports.columns = {{"support", "-", ""},
                          {"F_x", "N", ""},
                          {"F_y", "N", ""},
                          {"F_z", "N", ""},
                          {"M_x", "N m", "about the place of the support"},
                          {"M_y", "N m", ""},
                          {"M_z", "N m", ""}};
  // What is below 1e-14 of the largest force is rounding of springs without load.
  double largest_force = 0;
  for (const SupportLoad& f : loads)
    largest_force = std::max(largest_force, f.force.norm());
  const auto clean = [&](Vec3 v) {
    return Vec3((v.array().abs() < 1e-14 * largest_force).select(0.0, v));
  };
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const assembly::SupportForce& f = job.built.support_forces[i];
    const Vec3 v = clean(loads[i].force), m = clean(loads[i].moment);
    out.supports.add({f.name, v.x(), v.y(), v.z(), m.x(), m.y(), m.z()});
    io::Value& q = summary["support forces [N]"][f.name];
    q.push(v.x());
    q.push(v.y());
    q.push(v.z());
    if (!m.isZero(0.0)) {
      io::Value& qm = summary["support moments [N m]"][f.name];
      qm.push(m.x());
      qm.push(m.y());
      qm.push(m.z());
    }
    std::string line =
        fmt::format("support '{}': {:.5g}, {:.5g}, {:.5g} N", f.name, v.x(), v.y(), v.z());
    if (!m.isZero(0.0)) line += fmt::format("; {:.5g}, {:.5g}, {:.5g} N m", m.x(), m.y(), m.z());
    out.lines.push_back(std::move(line));
  }
  for (Index k : spin_holds) {
    const std::string& line = job.system().line_name(job.system().node(k / 6).line);
    summary["torque that keeps the speed [N m]"][line] = reactions[k];
    if (std::abs(reactions[k]) > 0)
      out.lines.push_back(
          fmt::format("shaft '{}': torque that keeps its speed {:.5g} N m", line, reactions[k]));
  }
  summary["elastic energy [J]"] = problem.energy().elastic;

  // ---- sections
  out.points = assembly::calc_section_results(job.model, job.mesh, job.built, node,
                                              problem.workspace().context);
  const bool stressed = std::any_of(out.points.begin(), out.points.end(),
                                    [](const SectionPoint& p) { return p.has_stress; });
  io::Table& t = out.sections;
  t.title = "Section forces and stresses";
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
           p.V.y(), p.T, p.M.x(), p.M.y(), p.M.norm(), cell(p, p.axial), cell(p, p.bending),
           cell(p, p.torsion), cell(p, p.von_mises)});

  io::Table& x = out.extremes;
  x.title = "Largest section forces and stresses";
  x.columns = {{"shaft", "-", ""},
               {"quantity", "-", ""},
               {"value", "", ""},
               {"unit", "-", ""},
               {"s", "m", ""}};
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    const std::string& name = job.mesh.lines[l].name;
    const char* kind = job.mesh.lines[l].rotating ? "shaft" : "casing";
    struct Quantity {
      const char* label;
      const char* unit;
      double (*of)(const SectionPoint&);
      bool stress;
    };
    double worst_stress = 0, stress_at = 0, yield_use = 0;
    for (const Quantity& q :
         {Quantity{"axial force", "N", [](const SectionPoint& p) { return p.N; }, false},
          {"shear force", "N", [](const SectionPoint& p) { return p.V.norm(); }, false},
          {"torque", "N m", [](const SectionPoint& p) { return p.T; }, false},
          {"bending moment", "N m", [](const SectionPoint& p) { return p.M.norm(); }, false},
          {"axial stress", "Pa", [](const SectionPoint& p) { return p.axial; }, true},
          {"bending stress", "Pa", [](const SectionPoint& p) { return p.bending; }, true},
          {"torsion stress", "Pa", [](const SectionPoint& p) { return p.torsion; }, true},
          {"von Mises stress", "Pa", [](const SectionPoint& p) { return p.von_mises; }, true}}) {
      double best = 0, s = 0;
      bool any = false;
      for (const SectionPoint& p : out.points) {
        if (p.line != static_cast<Index>(l) || (q.stress && !p.has_stress)) continue;
        if (const double v = q.of(p); !any || std::abs(v) > std::abs(best) * (1 + 1e-12)) {
          best = v;
          s = p.s;
          any = true;
        }
      }
      if (!any) continue;
      const plot::DisplayUnit unit = plot::unit_for(q.unit, std::abs(best));
      x.add({name, q.label, best * unit.factor, unit.name, s});
      summary["largest"][name][fmt::format("{} [{}]", q.label, q.unit)] = best;
      summary["largest"][name][fmt::format("{} at [m]", q.label)] = s;
      if (std::string_view(q.label) == "von Mises stress") {
        worst_stress = best;
        stress_at = s;
      }
      if (std::string_view(q.label) == "bending moment" && best > 0) {
        const plot::DisplayUnit u = plot::unit_for("N m", best);
        out.lines.push_back(fmt::format("{} '{}': largest bending moment {:.4g} {} at {:.4g} m",
                                        kind, name, best * u.factor, u.name, s));
      }
    }
    for (const SectionPoint& p : out.points)
      if (p.line == static_cast<Index>(l) && p.has_stress && !job.model.materials.empty()) {
        const double yield =
            job.model.materials
                .at(job.model.shafts[l].sections[job.mesh.elements[at(p.element)].section].material)
                .yield;
        if (yield > 0) yield_use = std::max(yield_use, p.von_mises / yield);
      }
    if (worst_stress > 0) {
      const plot::DisplayUnit u = plot::unit_for("Pa", worst_stress);
      out.lines.push_back(fmt::format(
          "{} '{}': largest von Mises stress {:.4g} {} at {:.4g} m{}", kind, name,
          worst_stress * u.factor, u.name, stress_at,
          yield_use > 0 ? fmt::format(", safety against yield {:.3g}", 1.0 / yield_use) : ""));
      if (yield_use > 0) summary["largest"][name]["safety against yield"] = 1.0 / yield_use;
    }
    const double length = job.mesh.lines[l].length;
    const std::string of = job.mesh.lines.size() > 1 ? " of " + name : "";
    plot::Figure f;
    f.name = file_safe(step, "sections", job, l);
    f.title = "Section forces" + of;
    f.caption =
        "Of the right part on the left one; N tension positive; M_z positive bends the shaft "
        "hollow towards +y.";
    add_rows(f, job, l, out.points,
             {{"shear force",
               "N",
               {{"V_y", [](const SectionPoint& p) { return p.V.x(); }},
                {"V_z", [](const SectionPoint& p) { return p.V.y(); }}}},
              {"bending moment",
               "N m",
               {{"M_z", [](const SectionPoint& p) { return p.M.y(); }},
                {"M_y", [](const SectionPoint& p) { return p.M.x(); }}}},
              {"torque", "N m", {{"T", [](const SectionPoint& p) { return p.T; }}}},
              {"axial force", "N", {{"N", [](const SectionPoint& p) { return p.N; }}}}},
             length);
    if (!f.axes.empty()) out.figures.push_back(std::move(f));
    if (!stressed) continue;
    plot::Figure g;
    g.name = file_safe(step, "stress", job, l);
    g.title = "Stress at the surface" + of;
    g.caption =
        "Nominal, without stress concentration. In a turning shaft the bending stress alternates "
        "once a revolution.";
    add_rows(g, job, l, out.points,
             {{"stress",
               "Pa",
               {{"von Mises", [](const SectionPoint& p) { return p.von_mises; }},
                {"bending", [](const SectionPoint& p) { return p.bending; }},
                {"torsion", [](const SectionPoint& p) { return p.torsion; }},
                {"axial", [](const SectionPoint& p) { return p.axial; }}}}},
             length);
    g.height = 340;
    if (!g.axes.empty()) out.figures.push_back(std::move(g));
  }
  return out;
}

// ---------------------------------------------------------------- load paths

PathRecord::PathRecord(const run::Job& job, const model::LoadPath& law) {
  if (law.control == model::LoadPath::Control::displacement)
    watched_.push_back({"control", job.mesh.place(law.at)});
  for (const model::Probe& p : job.model.probes)
    watched_.push_back({p.name, job.mesh.place(p.at)});
  if (watched_.empty())
    for (const model::Disk& d : job.model.disks)
      watched_.push_back({"disk " + d.name, job.mesh.place(d.at)});
  if (watched_.empty())
    for (const meshes::Line& l : job.mesh.lines)
      watched_.push_back(
          {"right end of " + l.name, job.mesh.stations[at(l.first_station + l.stations - 1)].at});
  table_.title = "Load path";
  table_.columns = {{"load factor", "-", "on gravity and loads"},
                    {"limit point", "-", "1: passed since the row before"},
                    {"bifurcation", "-", "1: other equilibria branch off here"},
                    {"unstable directions", "-", "negative eigenvalues of the static tangent"}};
  for (const Watched& w : watched_)
    for (const char* c : {"u_x", "u_y", "u_z"})
      table_.columns.push_back({w.name + " " + c, "m", ""});
  for (const Watched& w : watched_)
    table_.columns.push_back({w.name + " phi", "rad", ""});
}

void PathRecord::add(system::SystemProblem& problem, const analysis::LoadPathPoint& p) {
  const system::State& s = *p.state;
  problem.frames = s.frames;
  problem.system().evaluate_nodes(problem.workspace(), s.frames, s.t, s.q, s.v, s.a);
  std::vector<io::Table::Cell> row{p.load, p.limit ? 1 : 0, p.bifurcation ? 1 : 0,
                                   static_cast<int>(p.tangent.negative)};
  std::vector<double> u;
  for (const Watched& w : watched_) {
    const system::NodeState& n = problem.workspace().nodes[at(w.at.node)];
    const Vec3 x = n.u + w.at.offset * (n.d() - Vec3::UnitX());
    for (double v : x) {
      row.emplace_back(v);
      u.push_back(v);
    }
  }
  for (const Watched& w : watched_)
    row.emplace_back(problem.workspace().nodes[at(w.at.node)].phi);
  table_.add(std::move(row));
  load_.push_back(p.load);
  u_.push_back(std::move(u));
}

plot::Figure PathRecord::figure(const std::string& step) const {
  plot::Figure f;
  f.name = step + "_path";
  f.title = "Load path";
  f.height = 380;
  plot::Axes a;
  a.x = plot::Axis("displacement", "m");
  a.y = plot::Axis("load factor", "-");
  a.y.include_zero = true;
  double largest = 0;
  for (const auto& u : u_)
    for (double v : u)
      largest = std::max(largest, std::abs(v));
  const plot::DisplayUnit unit = plot::length_unit(largest);
  a.x.unit = unit.name;
  for (std::size_t w = 0; w < watched_.size(); ++w)
    for (std::size_t c = 0; c < 3; ++c) {
      plot::Series s = curve(fmt::format("{} u_{}", watched_[w].name, "xyz"[c]));
      s.style.marker = plot::Marker::circle;
      s.style.marker_size = 3.5;
      double m = 0;
      for (std::size_t k = 0; k < load_.size(); ++k) {
        s.x.push_back(unit.factor * u_[k][3 * w + c]);
        s.y.push_back(load_[k]);
        m = std::max(m, std::abs(u_[k][3 * w + c]));
      }
      if (m > 1e-6 * largest) a.series.push_back(std::move(s));
    }
  f.axes.push_back(std::move(a));
  return f;
}

// ---------------------------------------------------------------- frames

StaticFrames::StaticFrames(const run::Job& job, const std::string& step) {
  for (const model::VtkOutput& o : job.model.output.vtk) {
    if (!o.step.empty() && o.step != step) continue;
    io::VtkFrameOptions options;
    options.directory = job.folder.subfolder("vtk");
    options.name = step;
    io::set_content(options, o.content);
    options.deformation_scale = o.deformation_scale;
    options.points_around = o.points_around;
    options.max_frames = static_cast<std::uint64_t>(o.max_frames);
    writers_.push_back(io::make_vtk_frames(options));
    writers_.back()->begin(job.scene);
  }
}

void StaticFrames::write(const run::Job& job, system::SystemProblem& problem,
                         const system::State& s, double time,
                         const std::vector<SectionPoint>& points) {
  const auto node = [&](Index k) -> const system::NodeState& {
    return problem.workspace().nodes[at(k)];
  };
  VecX r(job.system().size());
  job.system().residual(problem.workspace(), s.frames, s.t, s.q, s.v, s.a, r);
  FrameArrays arrays(job);
  arrays.take_nodes(node);
  arrays.take_sections(points);
  arrays.take_supports(node, problem.workspace().context, [&](Index k) { return r[k]; });
  const io::FrameState frame = arrays.state(time, s.frames, false);
  for (auto& w : writers_)
    w->frame(frame);
}

void StaticFrames::end() {
  for (auto& w : writers_)
    w->end();
}

}  // namespace whirl::results
