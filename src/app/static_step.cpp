// A static step: the spinning, loaded equilibrium, with deflections, reactions and section forces.
#include <analysis/equilibrium.hpp>
#include <app/job.hpp>

#include <fmt/format.h>

#include <chrono>

namespace whirl::app {

void run_static_step(Job& job, const model::Step& step, const model::StaticStep& law) {
  const auto wall0 = std::chrono::steady_clock::now();
  system::SystemProblem problem(job.system(), {la::SolverKind::automatic, job.model.chart_change, 2.0});
  StepState s = job.start_of(step, law.speed);
  job.settle(problem, s);
  VecX r(job.system().size());
  problem.frames = s.state.frames;
  problem.residual(s.state.t, s.state.q, s.state.v, s.state.a, r);
  problem.power(s.state.t, s.state.q, s.state.v, s.state.a, r);   // node states and energy of this state
  const auto node = [&](Index n) -> const system::NodeState& { return problem.workspace().nodes[static_cast<std::size_t>(n)]; };
  const auto reaction = [&](Index k) { return r[k]; };

  io::Table shape;
  shape.title = "Deflection";
  shape.columns = {{"shaft", "-", ""}, {"position", "m", ""}, {"station", "-", ""}, {"u_x", "m", "displacement"}, {"u_y", "m", ""},
                   {"u_z", "m", ""}, {"slope_y", "rad", "d_y of the section normal"}, {"slope_z", "rad", ""}, {"phi", "rad", "axial angle"}};
  std::vector<io::Series> curves;
  io::Axes axes;
  axes.x = io::Axis("position", "m");
  axes.y = io::Axis("deflection", "m");
  for (const meshes::Line& line : job.mesh.lines) {
    io::Series y, z;
    y.label = line.name + " y", z.label = line.name + " z";
    for (Index k = line.first_station; k < line.first_station + line.stations; ++k) {
      const meshes::Station& st = job.mesh.stations[static_cast<std::size_t>(k)];
      const system::NodeState& n = node(st.at.node);
      const Vec3 u = n.u + st.at.offset * n.t;
      shape.add({line.name, st.position.x(), st.label(), u.x(), u.y(), u.z(), n.t.y(), n.t.z(), n.phi});
      y.x.push_back(st.position.x()), y.y.push_back(u.y()), z.x.push_back(st.position.x()), z.y.push_back(u.z());
    }
    y.keep_all = z.keep_all = true;
    axes.series.push_back(std::move(y)), axes.series.push_back(std::move(z));
  }
  io::Table supports;
  supports.title = "Support forces on the shaft";
  supports.columns = {{"support", "-", ""}, {"F_x", "N", ""}, {"F_y", "N", ""}, {"F_z", "N", ""}};
  for (const assembly::SupportForce& f : job.built.support_forces) {
    const Vec3 v = f.force(node, s.state.t, reaction);
    supports.add({f.name, v.x(), v.y(), v.z()});
  }
  job.folder.write_table(step.name + "_deflection.csv", shape);
  job.folder.write_table(step.name + "_supports.csv", supports);
  io::Value& v = job.summary["steps"][step.name];
  v["type"] = "static";
  v["speed [rpm]"] = s.speed * 30.0 / pi;
  for (const assembly::SupportForce& f : job.built.support_forces) {
    const Vec3 force = f.force(node, s.state.t, reaction);
    io::Value& q = v["support forces [N]"][f.name];
    q.push(force.x()), q.push(force.y()), q.push(force.z());
  }
  v["elastic energy [J]"] = problem.energy().elastic;
  v["run time [s]"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall0).count();
  if (job.model.output.report) {
    io::ReportSection section;
    section.title = fmt::format("{}: static equilibrium", step.name);
    io::Figure f;
    f.name = step.name + "_deflection", f.title = "Deflected centre line";
    f.axes.push_back(std::move(axes));
    section.figures.push_back(std::move(f));
    section.tables.push_back(std::move(supports));
    section.files.emplace_back("deflection", step.name + "_deflection.csv");
    job.report.sections.push_back(std::move(section));
  }
  ProgressLine(step.name, job.options.quiet).done(fmt::format("equilibrium at {:.0f} rpm", s.speed * 30.0 / pi));
  job.states[step.name] = std::move(s);
}

}  // namespace whirl::app
