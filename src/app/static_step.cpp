// A static step: the spinning, loaded equilibrium, or the path of equilibria under a growing load, with deflections, reactions,
// section forces and stresses.
#include <analysis/load_path.hpp>
#include <app/frequency.hpp>
#include <app/held.hpp>
#include <app/static_results.hpp>
#include <app/support_coefficients.hpp>
#include <app/support_diagnosis.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace whirl::app {

namespace {

analysis::LoadPathOptions path_options(const Job& job, const model::LoadPath& p, const analysis::EquilibriumOptions& e) {
  analysis::LoadPathOptions o;
  o.equilibrium = e;
  o.steps = p.steps, o.max_points = p.max_points;
  if (p.control == model::LoadPath::Control::displacement) {
    const meshes::Place at = job.mesh.place(p.at);
    o.controlled = 6 * at.node + p.direction;
    o.controlled_to = p.to;
  } else {
    o.last_load = p.last_load;
  }
  return o;
}

const char* text_of(analysis::LoadPathEnd e) {
  switch (e) {
    case analysis::LoadPathEnd::reached: return "reached its end";
    case analysis::LoadPathEnd::stopped: return "stopped";
    case analysis::LoadPathEnd::too_many_points: return "ended after max_points points";
    default: return "was lost";
  }
}

}  // namespace

void run_static_step(Job& job, const model::Step& step, const model::StaticStep& law) {
  if (law.speeds) return run_static_speeds(job, step, speeds_of(*law.speeds), law.load_steps);
  const Stopwatch watch;
  system::SystemProblem problem(job.system(), {la::SolverKind::automatic, job.model.chart_change, 2.0});
  StepState s = job.start_of(step, law.own_speed());
  io::Value& v = job.summary["steps"][step.name];
  v["type"] = "static";
  v["speed [rpm]"] = s.speed * 30.0 / pi;
  StaticFrames frames(job, step.name);

  analysis::EquilibriumOptions options;
  options.chart_change = job.model.chart_change;
  options.load_steps = law.load_steps;
  analysis::Equilibrium found;
  double load = 1.0;
  std::optional<PathRecord> path;
  std::vector<std::string> notes;
  if (law.path) {
    analysis::RunningSystem running(job.system(), job.running_of(s));
    path.emplace(job, *law.path);
    ProgressLine progress(step.name, job.options.quiet);
    analysis::LoadPathResult r = analysis::follow_load_path(running, s.speed, s.state, path_options(job, *law.path, options), [&](const analysis::LoadPathPoint& p) {
      path->add(problem, *p.state, p.load, p.limit);
      if (frames.any()) {
        problem.workspace().context.load = p.load;
        const auto points = assembly::calc_section_results(job.model, job.mesh, job.built, [&](Index n) -> const system::NodeState& { return problem.workspace().nodes[static_cast<std::size_t>(n)]; }, problem.workspace().context);
        frames.write(job, problem, *p.state, p.load, points);
      }
      progress.update(0.0, fmt::format("load factor {:.5g}", p.load));
      return true;
    });
    load = r.load;
    notes.push_back(fmt::format("load path {} at load factor {:.6g} after {} points", text_of(r.end), r.load, r.points));
    if (r.end == analysis::LoadPathEnd::lost) notes.back() += ": " + r.why;
    for (double x : path->limits()) notes.push_back(fmt::format("limit point near load factor {:.5g}", x));
    v["path"]["end"] = text_of(r.end), v["path"]["load factor"] = r.load, v["path"]["points"] = r.points;
    for (double x : path->limits()) v["path"]["limit points near"].push(x);
    found = std::move(r.last);
  } else {
    found = job.settle(s, options);
    warn_of_closed_contacts(job, step, s);
  }
  s.state = found.state;
  v["Newton iterations"] = found.iterations, v["load steps"] = found.load_steps;

  // node states, reactions and energy of the state found
  VecX r(job.system().size());
  problem.frames = s.state.frames;
  problem.workspace().context.load = load;
  if (!problem.residual(s.state.t, s.state.q, s.state.v, s.state.a, r)) throw run_error("R11", fmt::format("step '{}': the state found cannot be evaluated", step.name), {});
  problem.power(s.state.t, s.state.q, s.state.v, s.state.a, r);
  analysis::RunningSystem turning(job.system(), job.running_of(s));
  turning.set_load(load);
  const std::vector<SupportLoad> loads = calc_support_loads(job, turning, s.state, s.speed, found.reactions);
  StaticResults results = make_static_results(job, step.name, problem, loads, found.reactions, found.spin_holds, v);
  if (!law.path && frames.any()) frames.write(job, problem, s.state, s.state.t, results.points);
  frames.end();

  job.folder.write_table(step.name + "_deflection.csv", results.deflection);
  job.folder.write_table(step.name + "_supports.csv", results.supports);
  job.folder.write_table(step.name + "_sections.csv", results.sections);
  const bool rolling = !results.rolling.rows.empty();
  if (rolling) job.folder.write_table(step.name + "_rolling.csv", results.rolling);
  if (path) job.folder.write_table(step.name + "_path.csv", path->table());
  const std::vector<SupportCoefficients> linear = calc_support_coefficients(job, s);
  io::Table coefficients = support_table(linear), five = rolling_stiffness_table(linear);
  const bool has_five = !five.rows.empty();
  if (has_five) job.folder.write_table(step.name + "_rolling_stiffness.csv", five);
  const bool linearised = !coefficients.rows.empty();
  if (linearised) job.folder.write_table(step.name + "_coefficients.csv", coefficients);
  const RunTime time = watch.elapsed();
  put_run_time(v, time);
  ProgressLine(step.name, job.options.quiet)
      .done(fmt::format("{}, {}", law.path ? notes.front() : fmt::format("equilibrium at {:.0f} rpm, {} Newton iterations", s.speed * 30.0 / pi, found.iterations),
                        time.text()));
  io::ReportSection section;
  say_held(job, step, held_in_step(job, step, found.spin_holds), section);
  if (job.model.output.report) {
    const std::string held = std::move(section.text);
    section.title = fmt::format("{}: static equilibrium", step.name);
    section.text = fmt::format("At {:.6g} rpm, load factor {:.6g}: {} Newton iterations, {} load step{}.", s.speed * 30.0 / pi, load, found.iterations, found.load_steps,
                               found.load_steps == 1 ? "" : "s");
    for (const std::string& n : notes) section.text += "\n\n" + n + ".";
    section.text += held;
    if (path) section.figures.push_back(path->figure(step.name));
    for (io::Figure& f : results.figures) section.figures.push_back(std::move(f));
    section.tables.push_back(std::move(results.supports));
    section.tables.push_back(std::move(results.extremes));
    if (linearised) section.tables.push_back(std::move(coefficients)), section.files.emplace_back("bearing coefficients", step.name + "_coefficients.csv");
    for (const char* what : {"deflection", "supports", "sections"}) section.files.emplace_back(what, step.name + "_" + what + ".csv");
    if (has_five) section.tables.push_back(std::move(five)), section.files.emplace_back("stiffness of rolling bearings", step.name + "_rolling_stiffness.csv");
    if (rolling) section.tables.push_back(std::move(results.rolling)), section.files.emplace_back("rolling elements", step.name + "_rolling.csv");
    if (path) section.files.emplace_back("load path", step.name + "_path.csv");
    job.report.sections.push_back(std::move(section));
  }
  if (!job.options.quiet && !job.options.json) {
    for (std::size_t k = 1; k < notes.size(); ++k) std::fputs(("  " + notes[k] + "\n").c_str(), stdout);
    for (const std::string& line : results.lines) std::fputs(("  " + line + "\n").c_str(), stdout);
  }
  s.governors.clear();   // an equilibrium: none of them has begun
  job.states[step.name] = std::move(s);
}

}  // namespace whirl::app
