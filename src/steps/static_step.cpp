// A static step: the spinning, loaded equilibrium, or the path of equilibria under a growing load,
// with deflections, reactions, section forces and stresses.
#include <analysis/statics/load_path.hpp>
#include <results/frequency.hpp>
#include <results/held.hpp>
#include <results/stability_results.hpp>
#include <results/static_results.hpp>
#include <results/support_coefficients.hpp>
#include <run/support_diagnosis.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <core/error.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace whirl::steps {

namespace {

analysis::LoadPathOptions path_options(const run::Job& job, const model::LoadPath& p,
                                       const analysis::EquilibriumOptions& e) {
  analysis::LoadPathOptions o;
  o.equilibrium = e;
  o.steps = p.steps;
  o.max_points = p.max_points;
  if (p.control == model::LoadPath::Control::displacement) {
    const meshes::Place at = job.mesh.place(p.at);
    o.controlled = 6 * at.node + p.direction;
    o.controlled_to = p.to;
  } else {
    o.last_load = p.last_load;
    o.branch = p.branch;
  }
  return o;
}

/// What is to be said about a path: its end, limit points and bifurcations; and the same into the
/// summary.
std::vector<std::string> describe_path(const analysis::LoadPathResult& r, io::Value& v) {
  std::vector<std::string> notes{"load path " + analysis::describe(r)};
  v["end"] = analysis::describe(r);
  v["reached"] = r.end == analysis::LoadPathEnd::reached;
  v["load factor"] = r.load;
  v["points"] = r.points;
  int number = 0;
  for (std::size_t k = 0; k < r.critical.size(); ++k) {
    const analysis::CriticalPoint& c = r.critical[k];
    if (c.limit) {
      notes.push_back(fmt::format(
          "limit point near load factor {:.6g}: {} unstable directions before, {} after", c.load,
          c.before, c.after));
      v["limit points near"].push(c.load);
      continue;
    }
    ++number;
    const bool followed = r.branched_at == static_cast<int>(k);
    notes.push_back(fmt::format(
        "bifurcation {} at load factor {:.8g}: {} unstable directions before, {} after{}", number,
        c.load, c.before, c.after,
        followed ? "; the path went on along its branch"
                 : fmt::format("; 'branch = {}' follows what branches off", number)));
    io::Value b = io::Value::object();
    b["number"] = number;
    b["load factor"] = c.load;
    b["unstable directions before"] = static_cast<int>(c.before);
    b["unstable directions after"] = static_cast<int>(c.after);
    b["followed"] = followed;
    v["bifurcations"].push(std::move(b));
  }
  return notes;
}

/// Tables of critical points and of the directions in which a path branches.
void write_critical_points(run::Job& job, const std::string& step,
                           const analysis::LoadPathResult& r) {
  if (r.critical.empty()) return;
  job.folder.write_table(step + "_critical_points.csv", results::critical_table(r));
  int number = 0;
  for (const analysis::CriticalPoint& c : r.critical) {
    if (c.limit) continue;
    ++number;
    const std::string title =
        fmt::format("Direction of bifurcation {} at load factor {:.8g}", number, c.load);
    job.folder.write_table(
        fmt::format("{}_bifurcation_{}.csv", step, number),
        results::shape_table(job, title, c.state.frames, c.state.q, c.direction));
  }
}

/// A path that did not get where the deck wants it is a failure of the step, once its results are
/// written.
void check_end(const std::string& step, const analysis::LoadPathResult& r) {
  if (r.end == analysis::LoadPathEnd::reached || r.end == analysis::LoadPathEnd::stopped) return;
  const char* hint =
      "path.csv shows how far it came; beyond a limit point equilibria under this load may not "
      "exist, or lie on another branch";
  if (r.end == analysis::LoadPathEnd::too_many_points)
    hint =
        "give path.max_points more points, or path.steps fewer steps; a path that turned back may "
        "never reach its load";
  if (r.end == analysis::LoadPathEnd::no_branch)
    hint =
        "a path without bifurcations has no branch; an imperfection turns them into limit points "
        "or bends";
  throw run_error("E69", fmt::format("step '{}': the load path {}", step, analysis::describe(r)),
                  hint);
}

}  // namespace

void run_static_step(run::Job& job, const model::Step& step, const model::StaticStep& law) {
  if (law.speeds)
    return run_static_speeds(job, step, results::speeds_of(*law.speeds), law.load_steps);
  const Stopwatch watch;
  system::SystemProblem problem(job.system(),
                                {la::SolverKind::automatic, job.model.chart_change, 2.0});
  run::StepState s = job.start_of(step, law.own_speed());
  io::Value& v = job.summary["steps"][step.name];
  v["type"] = "static";
  v["speed [rpm]"] = to_rpm(s.speed);
  results::StaticFrames frames(job, step.name);

  analysis::EquilibriumOptions options;
  options.chart_change = job.model.chart_change;
  options.load_steps = law.load_steps;
  analysis::Equilibrium found;
  double load = 1.0;
  std::optional<results::PathRecord> path;
  std::optional<analysis::LoadPathResult> followed;
  std::vector<std::string> notes;
  if (law.path) {
    analysis::SteadySystem running(job.system(), job.steady_rotation_of(s));
    path.emplace(job, *law.path);
    run::ProgressLine progress(step.name, job.options.quiet);
    const auto accept = [&](const analysis::LoadPathPoint& p) {
      path->add(problem, p);
      if (frames.any()) {
        problem.workspace().context.load = p.load;
        const auto node = [&](Index n) -> const system::NodeState& {
          return problem.workspace().nodes[static_cast<std::size_t>(n)];
        };
        const auto points = assembly::calc_section_results(job.model, job.mesh, job.built, node,
                                                           problem.workspace().context);
        frames.write(job, problem, *p.state, p.load, points);
      }
      progress.update(0.0, fmt::format("load factor {:.5g}", p.load));
      return true;
    };
    followed = analysis::follow_load_path(running, s.speed, s.state,
                                          path_options(job, *law.path, options), accept);
    load = followed->load;
    notes = describe_path(*followed, v["path"]);
    write_critical_points(job, step.name, *followed);
    found = followed->last;
  } else {
    found = job.settle(s, options);
    run::warn_of_closed_contacts(job, step, s);
  }
  s.state = found.state;
  v["Newton iterations"] = found.iterations;
  v["load steps"] = found.load_steps;

  // node states, reactions and energy of the state found
  VecX r(job.system().size());
  problem.frames = s.state.frames;
  problem.workspace().context.load = load;
  if (!problem.residual(s.state.t, s.state.q, s.state.v, s.state.a, r))
    throw run_error("R11", fmt::format("step '{}': the state found cannot be evaluated", step.name),
                    {});
  problem.power(s.state.t, s.state.q, s.state.v, s.state.a, r);
  analysis::SteadySystem turning(job.system(), job.steady_rotation_of(s));
  turning.set_load(load);
  const std::vector<results::SupportLoad> loads =
      results::calc_support_loads(job, turning, s.state, s.speed, found.reactions);
  const analysis::Definiteness tangent =
      results::judge_state(turning, s.state, s.speed, found.spin_holds, true);
  results::add_stability(v, tangent, s.speed);
  results::warn_of_unstable(job, step.name, tangent, s.speed);
  if (!tangent.stable() && tangent.shape.size() > 0)
    job.folder.write_table(step.name + "_unstable_direction.csv",
                           results::shape_table(job, "Direction in which the equilibrium is left",
                                                s.state.frames, s.state.q, tangent.shape));
  results::StaticResults results = results::make_static_results(
      job, step.name, problem, loads, found.reactions, found.spin_holds, v);
  if (!law.path && frames.any()) frames.write(job, problem, s.state, s.state.t, results.points);
  frames.end();

  job.folder.write_table(step.name + "_deflection.csv", results.deflection);
  job.folder.write_table(step.name + "_supports.csv", results.supports);
  job.folder.write_table(step.name + "_sections.csv", results.sections);
  const bool rolling = !results.rolling.rows.empty();
  if (rolling) job.folder.write_table(step.name + "_rolling.csv", results.rolling);
  if (path) job.folder.write_table(step.name + "_path.csv", path->table());
  const std::vector<results::SupportCoefficients> linear =
      results::calc_support_coefficients(job, s);
  io::Table coefficients = results::support_table(linear),
            five = results::rolling_stiffness_table(linear);
  const bool has_five = !five.rows.empty();
  if (has_five) job.folder.write_table(step.name + "_rolling_stiffness.csv", five);
  const bool linearised = !coefficients.rows.empty();
  if (linearised) job.folder.write_table(step.name + "_coefficients.csv", coefficients);
  const RunTime time = watch.elapsed();
  run::put_run_time(v, time);
  const std::string kind = tangent.stable() ? "equilibrium" : results::stability_line(tangent, 0.0);
  const std::string ended = law.path ? notes.front()
                                     : fmt::format("{} at {:.0f} rpm, {} Newton iterations", kind,
                                                   to_rpm(s.speed), found.iterations);
  run::ProgressLine(step.name, job.options.quiet).done(fmt::format("{}, {}", ended, time.text()));
  io::ReportSection section;
  results::say_held(job, step, results::held_in_step(job, step, found.spin_holds), section);
  if (job.model.output.report) {
    const std::string held = std::move(section.text);
    section.title = fmt::format("{}: static equilibrium", step.name);
    section.text = fmt::format(
        "At {:.6g} rpm, load factor {:.6g}: {} Newton iterations, {} load step{}.", to_rpm(s.speed),
        load, found.iterations, found.load_steps, found.load_steps == 1 ? "" : "s");
    if (!tangent.stable())
      section.text += fmt::format("\n\nIt is an {}.", results::stability_line(tangent, s.speed));
    for (const std::string& n : notes)
      section.text += "\n\n" + n + ".";
    section.text += held;
    if (followed && !followed->critical.empty())
      section.tables.push_back(results::critical_table(*followed));
    if (path) section.figures.push_back(path->figure(step.name));
    for (plot::Figure& f : results.figures)
      section.figures.push_back(std::move(f));
    section.tables.push_back(std::move(results.supports));
    section.tables.push_back(std::move(results.extremes));
    if (linearised) {
      section.tables.push_back(std::move(coefficients));
      section.files.emplace_back("bearing coefficients", step.name + "_coefficients.csv");
    }
    for (const char* what : {"deflection", "supports", "sections"})
      section.files.emplace_back(what, step.name + "_" + what + ".csv");
    if (has_five) {
      section.tables.push_back(std::move(five));
      section.files.emplace_back("stiffness of rolling bearings",
                                 step.name + "_rolling_stiffness.csv");
    }
    if (rolling) {
      section.tables.push_back(std::move(results.rolling));
      section.files.emplace_back("rolling elements", step.name + "_rolling.csv");
    }
    if (path) section.files.emplace_back("load path", step.name + "_path.csv");
    job.report.sections.push_back(std::move(section));
  }
  if (!job.options.quiet && !job.options.json) {
    for (std::size_t k = 1; k < notes.size(); ++k)
      std::fputs(("  " + notes[k] + "\n").c_str(), stdout);
    for (const std::string& line : results.lines)
      std::fputs(("  " + line + "\n").c_str(), stdout);
  }
  s.governors.clear();  // an equilibrium: none of them has begun
  job.states[step.name] = std::move(s);
  if (followed) check_end(step.name, *followed);
}

}  // namespace whirl::steps
