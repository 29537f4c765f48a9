#include <results/along_shaft.hpp>
#include <results/static_results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::results {

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
    const system::NodeState& n = problem.workspace().in_own_axes(w.at.node);
    const Vec3 x = n.u + w.at.offset * (n.d() - Vec3::UnitX());
    for (double v : x) {
      row.emplace_back(v);
      u.push_back(v);
    }
  }
  for (const Watched& w : watched_)
    row.emplace_back(problem.workspace().in_own_axes(w.at.node).phi);
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
      plot::Series s = curve_of(fmt::format("{} u_{}", watched_[w].name, "xyz"[c]));
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

}  // namespace whirl::results
