// A static step: the spinning, loaded equilibrium, or the path of equilibria under a growing load,
// with deflections, reactions, section forces and stresses.
#include <core/messages.hpp>
#include <analysis/statics/load_path.hpp>
#include <results/frequency.hpp>
#include <results/held.hpp>
#include <results/linear_limits.hpp>
#include <results/stability_results.hpp>
#include <results/static_accuracy.hpp>
#include <results/static_results.hpp>
#include <results/support_coefficients.hpp>
#include <run/support_diagnosis.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <core/error.hpp>

#include <fmt/format.h>

namespace whirl::steps {

namespace {

constexpr const char* drifted =
    ", reached as a motion without inertia (Newton's method found none that attracts)";

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
    if (const system::FollowerDef* f = job.system().followers().find(at.node);
        f && !(f->pinned && p.direction >= 3))
      throw run_error(
          "E41", fmt::format("the place of displacement control is carried along by {}", f->joint),
          "control the place the joint hangs on, or another");
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
  for (const analysis::Unlocated& u : r.unlocated) {
    const std::string text = fmt::format(
        "between load factors {:.6g} and {:.6g} the unstable directions change from {} to {}; "
        "where "
        "was not found",
        u.from, u.to, u.before, u.after);
    notes.push_back(text);
    v["not located"].push(text);
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

/// A static step on its way: the equilibrium, or the last one of a path, and what is shown of it.
class StaticRun {
 public:
  StaticRun(run::Job& job, const model::Step& step, const model::StaticStep& law);
  /// Error E69: a path did not get where the deck wants it.
  void execute();

 private:
  void settle();
  void follow_path();
  void write_point(const analysis::LoadPathPoint& p);
  void evaluate();
  void judge();
  void judge_mesh();
  void write_tables();
  void say_end(const RunTime& time) const;
  void add_section();
  io::Value& summary() { return job_.summary["steps"][step_.name]; }
  std::string file(const std::string& what) const { return step_.name + "_" + what + ".csv"; }

  const Stopwatch watch_;
  run::Job& job_;
  const model::Step& step_;
  const model::StaticStep& law_;
  system::SystemProblem problem_;
  run::StepState state_;
  results::StaticFrames frames_;
  analysis::EquilibriumOptions options_;
  analysis::Equilibrium found_;
  double load_ = 1.0;
  std::optional<analysis::SteadySystem> turning_;  ///< for frames of a path
  std::optional<results::PathRecord> path_;
  std::optional<analysis::LoadPathResult> followed_;
  std::vector<std::string> notes_;
  analysis::Definiteness tangent_;
  results::StaticResults results_;
  io::Table coefficients_, rolling_stiffness_;
  results::PadTables pads_;
  io::Table films_;
  results::RingTables rings_;
};

StaticRun::StaticRun(run::Job& job, const model::Step& step, const model::StaticStep& law)
    : job_(job),
      step_(step),
      law_(law),
      problem_(job.system(), {la::SolverKind::automatic, job.model.chart_change}),
      state_(job.start_of(step, law.own_speed())),
      frames_(job, step.name) {
  options_.chart_change = job.model.chart_change;
  options_.load_steps = law.load_steps;
}

void StaticRun::settle() {
  found_ = job_.settle(state_, options_);
  run::warn_of_closed_contacts(job_, step_, results::equilibrium_at(state_.speed), state_.state);
}

void StaticRun::follow_path() {
  analysis::SteadySystem running(job_.system(), job_.steady_rotation_of(state_));
  path_.emplace(job_, *law_.path);
  run::ProgressLine progress(step_.name, job_.options.quiet);
  const auto accept = [&](const analysis::LoadPathPoint& p) {
    write_point(p);
    progress.update(0.0, fmt::format("load factor {:.5g}", p.load));
    return true;
  };
  followed_ = analysis::follow_load_path(running, state_.speed, state_.state,
                                         path_options(job_, *law_.path, options_), accept);
  load_ = followed_->load;
  notes_ = describe_path(*followed_, summary()["path"]);
  write_critical_points(job_, step_.name, *followed_);
  found_ = followed_->last;
}

void StaticRun::write_point(const analysis::LoadPathPoint& p) {
  path_->add(problem_, p);
  if (!frames_.any()) return;
  if (!turning_) turning_.emplace(job_.system(), job_.steady_rotation_of(state_));
  turning_->set_load(p.load);
  VecX reactions(job_.system().size());
  if (!turning_->residual(p.state->frames, state_.speed, p.state->q, reactions)) return;
  const results::MeanLoads loads =
      results::calc_mean_loads(job_, *turning_, *p.state, state_.speed, reactions);
  const system::Workspace& nodes = problem_.workspace();
  const auto points =
      assembly::calc_section_results(job_.model, job_.mesh, job_.built, nodes, loads.elements);
  frames_.write(job_, nodes, p.load, loads, points);
}

/// Node states of the state found.
void StaticRun::evaluate() {
  const system::State& x = state_.state;
  problem_.frames = x.frames;
  system::Workspace& nodes = problem_.workspace();
  nodes.context.load = load_;
  nodes.context.whole_turn = job_.steady_rotation_of(state_).mean;
  if (!job_.system().evaluate_nodes(nodes, x.frames, x.t, x.q, x.v, x.a))
    throw run_error("R11",
                    fmt::format("step '{}': the state found cannot be evaluated", step_.name), {});
}

/// Whether it is stable, and what its results are.
void StaticRun::judge() {
  const system::State& x = state_.state;
  analysis::SteadySystem turning(job_.system(), job_.steady_rotation_of(state_));
  turning.set_load(load_);
  const results::MeanLoads loads =
      results::calc_mean_loads(job_, turning, x, state_.speed, found_.reactions);
  tangent_ = results::judge_state(turning, x, state_.speed, found_.holds(), true);
  results::add_stability(summary(), tangent_, state_.speed);
  results::warn_of_unstable(job_, step_.name, tangent_, state_.speed);
  if (!tangent_.stable() && tangent_.shape.size() > 0)
    job_.folder.write_table(file("unstable_direction"),
                            results::shape_table(job_, "Direction in which the equilibrium is left",
                                                 x.frames, x.q, tangent_.shape));
  results_ = results::make_static_results(job_, step_.name, problem_, loads, found_.reactions,
                                          found_.spin_holds, summary());
  if (!path_ && frames_.any())
    frames_.write(job_, problem_.workspace(), x.t, loads, results_.points);
  frames_.end();
}

/// What the elements do to the equilibrium; of a path to the last one, under the load it stands at.
void StaticRun::judge_mesh() {
  if (!results::has_deflections(job_, state_)) return;
  const auto accuracy =
      results::static_mesh_error(job_, step_.name, state_, job_.steady_rotation_of(state_), load_);
  std::string said = accuracy ? results::report_static_accuracy(job_, step_.name, *accuracy)
                              : results::report_no_static_accuracy(job_, step_.name);
  if (path_) said += fmt::format(", at load factor {:.6g}", load_);
  results_.deflection.title += "; " + said;
  results_.lines.push_back(said);
}

void StaticRun::write_tables() {
  const std::vector<results::SupportCoefficients> linear =
      results::calc_support_coefficients(job_, state_);
  coefficients_ = results::support_table(linear);
  if (const std::string grid = results::report_grid_error(summary(), linear); !grid.empty()) {
    coefficients_.title += "; " + grid;
    results_.lines.push_back(grid);
  }
  rolling_stiffness_ = results::rolling_stiffness_table(linear);
  pads_ = results::pad_tables(linear);
  for (std::string& unloaded : results::unloaded_pads(linear)) {
    summary()["unloaded pads"].push(unloaded);
    results_.lines.push_back(std::move(unloaded));
  }
  for (plot::Figure& f : results::draw_pads(step_.name + "_pads", linear))
    results_.figures.push_back(std::move(f));
  films_ = results::film_table(linear);
  for (plot::Figure& f : results::draw_films(step_.name + "_films", linear))
    results_.figures.push_back(std::move(f));
  results::warn_of_turbulence(job_, step_.name, linear);
  results::warn_of_hot_bath(job_, step_.name, linear);
  for (std::string& line : results::groove_lines(job_, linear)) {
    summary()["grooves"].push(line);
    results_.lines.push_back(std::move(line));
  }
  rings_ = results::ring_tables(linear);
  for (std::string& starved : results::starved_rings(linear)) {
    summary()["starved rings"].push(starved);
    results_.lines.push_back(std::move(starved));
  }
  for (plot::Figure& f : results::draw_rings(step_.name + "_rings", linear))
    results_.figures.push_back(std::move(f));
  job_.folder.write_table(file("deflection"), results_.deflection);
  job_.folder.write_table(file("supports"), results_.supports);
  job_.folder.write_table(file("sections"), results_.sections);
  if (path_) job_.folder.write_table(file("path"), path_->table());
  const auto write = [&](const char* what, const io::Table& t) {
    if (!t.rows.empty()) job_.folder.write_table(file(what), t);
  };
  write("joints", results_.joints);
  write("magnets", results_.magnets);
  write("rolling", results_.rolling);
  write("rolling_stiffness", rolling_stiffness_);
  write("coefficients", coefficients_);
  write("films", films_);
  write("pads", pads_.pads);
  write("pad_coefficients", pads_.reduced);
  write("full_coefficients", pads_.full);
  write("rings", rings_.rings);
  write("ring_coefficients", rings_.reduced);
  write("full_ring_coefficients", rings_.full);
}

void StaticRun::say_end(const RunTime& time) const {
  const std::string kind = tangent_.undecided() ? "equilibrium, open whether it is stable,"
                           : tangent_.stable()  ? "equilibrium"
                                                : results::stability_line(tangent_, 0.0);
  const std::string ended =
      path_ ? notes_.front()
            : fmt::format("{} at {:.0f} rpm, {} Newton iterations{}", kind, to_rpm(state_.speed),
                          found_.iterations, found_.drifted ? drifted : "");
  run::ProgressLine(step_.name, job_.options.quiet)
      .done(fmt::format("{}, {}{}", ended,
                        tangent_.judged ? "" : results::left_to_controllers + ", ", time.text()));
}

/// Moves the tables and figures of the results into the report.
void StaticRun::add_section() {
  io::ReportSection section;
  section.title = fmt::format("{}: static equilibrium", step_.name);
  section.text =
      fmt::format("At {:.6g} rpm, load factor {:.6g}: {} Newton iterations, {} load step{}.",
                  to_rpm(state_.speed), load_, found_.iterations, found_.load_steps,
                  found_.load_steps == 1 ? "" : "s");
  if (found_.drifted) section.text += " It was" + std::string(drifted + 1) + ".";
  if (!tangent_.stable())
    section.text +=
        fmt::format("\n\nIt is an {}.", results::stability_line(tangent_, state_.speed));
  if (tangent_.undecided())
    section.text += fmt::format("\n\nOpen: {}.", results::stability_line(tangent_, state_.speed));
  if (!tangent_.judged) section.text += "\n\n" + std::string(results::left_to_controllers) + ".";
  for (const std::string& n : notes_)
    section.text += "\n\n" + n + ".";
  results::say_held(job_, step_, results::held_in_step(job_, step_, found_.holds()), section);
  if (!job_.model.output.report) return;
  if (followed_ && !followed_->critical.empty())
    section.tables.push_back(results::critical_table(*followed_));
  if (path_) section.figures.push_back(path_->figure(step_.name));
  for (plot::Figure& f : results_.figures)
    section.figures.push_back(std::move(f));
  section.tables.push_back(std::move(results_.supports));
  section.tables.push_back(std::move(results_.extremes));
  if (!results_.joints.rows.empty()) section.tables.push_back(std::move(results_.joints));
  const auto add = [&](io::Table& t, const char* title, const char* what) {
    if (t.rows.empty()) return;
    section.tables.push_back(std::move(t));
    section.files.emplace_back(title, file(what));
  };
  add(coefficients_, "bearing coefficients", "coefficients");
  add(films_, "films", "films");
  add(pads_.pads, "tilting pads", "pads");
  add(pads_.reduced, "coefficients by frequency", "pad_coefficients");
  if (!pads_.full.rows.empty())
    section.files.emplace_back("full coefficients", file("full_coefficients"));
  add(rings_.rings, "floating rings", "rings");
  add(rings_.reduced, "coefficients with the rings by frequency", "ring_coefficients");
  if (!rings_.full.rows.empty())
    section.files.emplace_back("full coefficients of rings", file("full_ring_coefficients"));
  for (const char* what : {"deflection", "supports", "sections"})
    section.files.emplace_back(what, file(what));
  add(rolling_stiffness_, "stiffness of rolling bearings", "rolling_stiffness");
  add(results_.magnets, "magnetic bearings", "magnets");
  add(results_.rolling, "rolling elements", "rolling");
  if (path_) section.files.emplace_back("load path", file("path"));
  job_.report.sections.push_back(std::move(section));
}

void StaticRun::execute() {
  summary()["type"] = "static";
  summary()["speed [rpm]"] = to_rpm(state_.speed);
  if (law_.path)
    follow_path();
  else
    settle();
  state_.state = found_.state;
  summary()["Newton iterations"] = found_.iterations;
  summary()["load steps"] = found_.load_steps;
  if (found_.drifted) summary()["reached as a motion without inertia"] = true;
  evaluate();
  judge();
  judge_mesh();
  results::warn_of_tables(job_, step_.name, state_.speed, state_.speed);
  results::warn_of_mean_crack(job_, step_.name, state_.speed != 0);
  results::warn_of_short_bearings(job_, step_.name, state_.state);
  write_tables();
  const RunTime time = watch_.elapsed();
  run::put_run_time(summary(), time);
  say_end(time);
  add_section();
  if (!job_.options.quiet && !job_.options.json) {
    for (std::size_t k = 1; k < notes_.size(); ++k)
      print("  " + notes_[k] + "\n");
    for (const std::string& line : results_.lines)
      print("  " + line + "\n");
  }
  state_.drives.clear();  // an equilibrium: none of them has begun
  job_.states[step_.name] = std::move(state_);
  if (followed_) check_end(step_.name, *followed_);
}

}  // namespace

void run_static_step(run::Job& job, const model::Step& step, const model::StaticStep& law) {
  if (law.speeds)
    return run_static_speeds(job, step, results::speeds_of(*law.speeds), law.load_steps);
  StaticRun(job, step, law).execute();
}

}  // namespace whirl::steps
