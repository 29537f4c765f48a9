// A transient step: initial state, observers for what the deck asks for, the run, and its results.
#include <analysis/statics/equilibrium.hpp>
#include <analysis/transient/event_log.hpp>
#include <analysis/transient/linear_motion.hpp>
#include <analysis/transient/transient.hpp>
#include <steps/accuracy.hpp>
#include <run/checkpoint.hpp>
#include <results/held.hpp>
#include <run/interrupt.hpp>
#include <run/job.hpp>
#include <results/keyphasor_output.hpp>
#include <results/plot_buffer.hpp>
#include <results/spectra_output.hpp>
#include <run/support_diagnosis.hpp>
#include <results/transient_outputs.hpp>
#include <results/history_figures.hpp>
#include <steps/transient_step.hpp>
#include <steps/starts.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>
#include <core/interrupt.hpp>
#include <core/rotation.hpp>
#include <plot/plots.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

namespace whirl::steps {

using analysis::Measurement;
using analysis::Point;

std::vector<std::pair<std::string, Point>> watched_points(const run::Job& job) {
  std::vector<std::pair<std::string, Point>> watched;
  for (const model::Probe& p : job.model.probes)
    watched.emplace_back(p.name, results::point_of(job, p.at));
  if (watched.empty())
    for (const model::Disk& d : job.model.disks)
      watched.emplace_back("disk " + d.name, results::point_of(job, d.at));
  return watched;
}

/// Films, and nothing else whose stiffness comes and goes within a step.
bool only_films(const run::Job& job) {
  const auto comes_and_goes = [](const model::Bearing& b) {
    const model::SupportTraits t = model::traits_of(b.law);
    return t.gap || t.rolling;
  };
  return !job.built.fine.empty() &&
         std::none_of(job.model.bearings.begin(), job.model.bearings.end(), comes_and_goes);
}

analysis::TransientOptions transient_options(const run::Job& job, const model::TransientStep& law,
                                             double t0) {
  analysis::TransientOptions t;
  t.method = law.integrator.method;
  t.reference = job.reference();
  t.interrupt = &run::interrupted();
  // marks about a quarter of a second of computing apart, counted in steps: the motion must not
  // depend on the clock
  t.steps_between_marks = std::clamp<long>(
      50000 / std::max<long>(static_cast<long>(job.mesh.nodes.size()), 1), 20, 1000);
  t.checkpoint_seconds = law.checkpoint > 0.0 ? law.checkpoint : infinity;
  time::Options& o = t.integrator;
  o.tolerance = law.integrator.tolerance;
  o.t_end = t0 + law.duration;
  o.dt_fixed = law.integrator.dt;
  o.dt_first = law.integrator.dt_first;
  o.dt_min = law.integrator.dt_min;
  o.dt_max = law.integrator.dt_max;
  o.rho_inf = law.integrator.rho_inf;
  for (double b : job.built.breakpoints)
    if (b > t0 && b < o.t_end) o.breakpoints.push_back(b);
  double length = 0.0;
  for (const meshes::Line& l : job.mesh.lines)
    length = std::max(length, l.length);
  if (length > 0.0) o.scales.length = length;
  o.linearize_inside = only_films(job);
  for (const auto& f : job.built.fine)
    for (const Index c : {1, 2})
      o.scales.limits.push_back({6 * f.node + c, f.length});
  if (law.stop_speed != 0.0) t.speed_stops.push_back({job.reference(), law.stop_speed});
  if (law.amplitude_limit < infinity)
    for (const auto& [name, p] : watched_points(job))
      t.amplitude_stops.push_back({p, law.amplitude_limit, name});
  for (const model::Event& e : job.model.events) {
    if (!e.stop) continue;
    if (e.kind == model::Event::Kind::speed)
      t.speed_stops.push_back({job.reference(), e.value});
    else
      t.amplitude_stops.push_back({results::point_of(job, *e.at), e.value, e.name});
  }
  return t;
}

namespace {

/// A start that no transient left: settled as the step asks for.
void settle_start(run::Job& job, run::StepState& start, const model::TransientStep& law) {
  using Start = model::TransientStep::Start;
  if (law.start == Start::rest) return;
  const run::PhaseTimer timer(job, "equilibrium");
  if (law.start == Start::mode)
    start_in_mode(job, start, law);
  else if (law.start == Start::unbalance_response)
    start_in_unbalance_response(job, start);
  else
    job.settle(start, {}, true);
}

}  // namespace

/// The step goes on from the motion of another one, which has its own speed.
static bool goes_on_in_motion(const run::Job& job, const model::Step& step) {
  return std::any_of(job.model.steps.begin(), job.model.steps.end(), [&](const model::Step& s) {
    return s.name == step.from && std::holds_alternative<model::TransientStep>(s.law);
  });
}

run::StepState transient_start(run::Job& job, const model::Step& step,
                               const model::TransientStep& law) {
  const bool other_run = !law.previous.empty();
  const auto speed = goes_on_in_motion(job, step) ? std::nullopt : law.own_speed();
  run::StepState start = other_run ? start_of_other_run(job, law.previous, law.previous_step)
                                   : job.start_of(step, speed);
  begin_governors(job, start);
  if (other_run) return start;
  if (step.from.empty()) {
    settle_start(job, start, law);
    start.governors.clear();  // the equilibrium has angles of its own
    begin_governors(job, start);
  }
  using Start = model::TransientStep::Start;
  const bool steady_motion =
      step.from.empty() && (law.start == Start::unbalance_response || law.start == Start::mode);
  if (!steady_motion) run::warn_of_closed_contacts(job, step, start);
  return start;
}

std::unique_ptr<system::SystemProblem> transient_problem(const run::Job& job,
                                                         const model::TransientStep& law,
                                                         const run::StepState& start) {
  if (!law.linear)
    return std::make_unique<system::SystemProblem>(
        job.system(),
        system::ProblemOptions{la::SolverKind::automatic, job.model.chart_change, 2.0});
  analysis::SteadyRotation running = job.steady_rotation_of(start);
  running.time = start.state.t;
  return std::make_unique<analysis::LinearMotion>(job.system(), running, start.speed, start.state);
}

namespace {

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// What [[event]] names.
std::vector<analysis::EventLog::Watch> watches_of(const run::Job& job) {
  std::vector<analysis::EventLog::Watch> out;
  for (const model::Event& e : job.model.events) {
    if (e.kind == model::Event::Kind::speed)
      out.push_back({e.name,
                     [n = job.reference(), x = e.value](const analysis::Snapshot& s) {
                       return s.node(n).spin() - x;
                     },
                     e.direction});
    else
      out.push_back({e.name,
                     [p = results::point_of(job, *e.at), x = e.value](const analysis::Snapshot& s) {
                       return analysis::displacement(s, p).tail<2>().norm() - x;
                     },
                     e.direction});
  }
  return out;
}

void warn(run::Job& job, const model::Step& step, const std::string& what) {
  job.summary["steps"][step.name]["warnings"].push(what);
  job.report.warnings.push_back(step.name + ": " + what);
  if (!job.options.quiet)
    std::fputs(fmt::format("warning: {}: {}\n", step.name, what).c_str(), stderr);
}

/// A drive that prescribes another speed than the rotor has where the step goes on: an infinite
/// torque for an instant.
void warn_of_jumps(run::Job& job, const model::Step& step, const run::StepState& start) {
  for (const model::Drive& d : job.model.drives) {
    const auto* law = std::get_if<model::PrescribedSpin>(&d.law);
    if (!law || !law->angle || (!d.step.empty() && d.step != step.name)) continue;
    const double wanted = law->angle->at(start.state.t).df;
    const double now = start.state.v[6 * job.mesh.place(d.at).node + system::spin_phi];
    if (std::abs(wanted - now) <= 1e-3 * std::max(std::abs(wanted), std::abs(now))) continue;
    warn(job, step,
         fmt::format("drive '{}' prescribes {:.6g} rpm at t = {:.6g} s, where shaft '{}' turns at "
                     "{:.6g} rpm: its speed jumps",
                     d.name, wanted * 30.0 / pi, start.state.t, job.model.shafts[d.at.shaft].name,
                     now * 30.0 / pi));
  }
}

/// When rows of the histories are wanted, or nothing when always.
analysis::Recorder::Gate gate_of(const run::Job& job,
                                 const std::vector<std::pair<std::string, Point>>& watched) {
  const model::Output& o = job.model.output;
  const bool by_speed =
      o.speed_low > -infinity || o.speed_high<infinity, by_size = o.above> 0.0 && !watched.empty();
  if (!by_speed && !by_size) return {};
  return [&job, &o, points = watched, by_size](const analysis::Snapshot& s) {
    const double spin = s.node(job.reference()).spin();
    if (spin < o.speed_low || spin > o.speed_high) return false;
    return !by_size || std::any_of(points.begin(), points.end(), [&](const auto& p) {
      return analysis::displacement(s, p.second).template tail<2>().norm() > o.above;
    });
  };
}

/// Histories of other columns than those of the earlier part of the run: the file of that part gets
/// a number.
void keep_earlier_series(const run::Job& job, const std::string& name) {
  for (const char* extension : {".csv", ".h5"}) {
    const std::filesystem::path file = job.folder.path(name + extension);
    std::error_code ec;
    if (!std::filesystem::exists(file, ec)) continue;
    int n = 1;
    while (std::filesystem::exists(job.folder.path(fmt::format("{}.{}{}", name, n, extension)), ec))
      ++n;
    std::filesystem::rename(file, job.folder.path(fmt::format("{}.{}{}", name, n, extension)), ec);
  }
}

}  // namespace

void run_transient_step(run::Job& job, const model::Step& step, const model::TransientStep& law) {
  const Stopwatch watch;
  job.build_for(step);
  const std::filesystem::path checkpoint_path = job.folder.path(run::checkpoint_name(step.name));
  const std::optional<run::Checkpoint> resumed =
      job.options.resume ? run::read_checkpoint(checkpoint_path) : std::nullopt;
  run::StepState start = resumed ? run::StepState{resumed->state, resumed->speed, {}}
                                 : transient_start(job, step, law);
  const bool goes_on = !step.from.empty() || !law.previous.empty();
  if (!resumed && goes_on) warn_of_jumps(job, step, start);
  if (!resumed && law.own_speed() && (goes_on_in_motion(job, step) || !law.previous.empty()))
    warn(job, step,
         "initial_speed has no effect: the step goes on from a motion with its own speed");
  const std::unique_ptr<system::SystemProblem> equations = transient_problem(job, law, start);
  system::SystemProblem& problem = *equations;
  const double t0 = resumed ? resumed->t_begin : start.state.t;
  analysis::TransientOptions options = transient_options(job, law, t0);
  const std::vector<std::pair<std::string, Point>> watched = watched_points(job);

  // observers: only what the deck asks for
  std::vector<analysis::Observer*> observers;
  const model::Output& out = job.model.output;
  results::Channels channels = results::make_channels(job);
  results::PlotBuffer buffer(channels.columns);
  std::vector<io::TimeSeriesPtr> sinks;
  if (out.csv) sinks.push_back(io::make_csv_series(job.folder.path(step.name + ".csv")));
  if (out.binary) sinks.push_back(io::make_hdf5_series(job.folder.path(step.name + ".h5")));
  io::TimeSeriesPtr sink = sinks.empty()       ? nullptr
                           : sinks.size() == 1 ? std::move(sinks.front())
                                               : io::make_tee(std::move(sinks));
  run::Parts parts;
  // what a key says must be what decides whether the saved part fits
  std::string columns, watching;
  for (const Measurement& m : channels.all)
    for (std::size_t k = 0; k < m.width(); ++k)
      columns += m.name + "." + (m.components.empty() ? "" : m.components[k]) + " ";
  for (const auto& w : watched)
    watching += w.first + " ";
  bool series_continues = false;
  const std::string series_key =
      fmt::format("series {}{}: {}", out.csv ? "csv " : "", out.binary ? "hdf5 " : "", columns);
  if (sink)
    parts.add(
        series_key,
        [&](OutArchive& a) {
          sink->flush();
          a.put_count(sink->rows());
        },
        [&](InArchive& a) {
          sink->resume(results::io_channels(channels), a.count());
          series_continues = true;
        });
  parts.add(
      "plot buffer " + columns, [&](OutArchive& a) { buffer.save(a); },
      [&](InArchive& a) { buffer.restore(a); });
  analysis::Recorder recorder(
      channels.all,
      [&](const std::vector<double>& row) {
        if (sink) sink->append(row);
        if (out.report) buffer.append(row);
      },
      t0, out.every, out.t0, out.t1, gate_of(job, watched));
  if (channels.columns > 0 && (sink || out.report)) {
    observers.push_back(&recorder);
    parts.add(fmt::format("recorder every {} {}", out.every, series_key), recorder);
  }
  analysis::PeakTracker peaks(watched, job.reference());
  if (!watched.empty()) {
    observers.push_back(&peaks);
    parts.add("peaks " + watching, peaks);
  }
  analysis::EnergyBalance energy(options.integrator.breakpoints);
  observers.push_back(&energy);
  parts.add("energy", energy);
  analysis::TiltWatch tilt;
  observers.push_back(&tilt);
  parts.add("tilt", tilt);
  analysis::StepHistogram lengths(job.reference());
  observers.push_back(&lengths);
  parts.add("step lengths", lengths);
  std::vector<std::unique_ptr<results::Frames>> frames;
  for (const model::VtkOutput& v : out.vtk)
    if (v.step.empty() || v.step == step.name) {
      const std::string name =
          frames.empty() ? step.name : fmt::format("{}_{}", step.name, frames.size() + 1);
      frames.push_back(
          std::make_unique<results::Frames>(job, v, name, t0, options.integrator.t_end));
      observers.push_back(frames.back().get());
      std::string content;
      for (const std::string& c : v.content)
        content += " " + c;
      parts.add(
          fmt::format("frames {} window {} {} every {} per revolution {} scale {} around {}{}",
                      frames.size(), v.t0, v.t1, v.every, v.frames_per_revolution,
                      v.deformation_scale, v.points_around, content),
          *frames.back());
    }
  analysis::EventLog events(watches_of(job), job.reference());
  if (!events.watches().empty()) {
    observers.push_back(&events);
    std::string what = "events";
    for (const model::Event& e : job.model.events)
      what += fmt::format(" {} {} {}", e.name, e.value, e.direction);
    parts.add(what, events);
  }
  std::unique_ptr<results::KeyphasorOutput> keyphasor;
  if (out.tracking.on && !job.model.probes.empty() && (out.csv || out.report)) {
    keyphasor =
        std::make_unique<results::KeyphasorOutput>(job, step, results::probe_senses(job, start));
    observers.push_back(&keyphasor->observer());
    parts.add_output(keyphasor->key(), *keyphasor);
  }
  std::unique_ptr<results::SpectraOutput> spectra;
  if (out.spectra && !job.model.probes.empty() && (out.csv || out.report)) {
    spectra =
        std::make_unique<results::SpectraOutput>(job, step, t0, results::probe_senses(job, start));
    observers.push_back(&spectra->observer());
    parts.add_output(spectra->key(), *spectra);
  }
  if (auto* small = dynamic_cast<analysis::LinearMotion*>(equations.get()))
    parts.add(
        "steady motion", [small](OutArchive& a) { small->save(a); },
        [small](InArchive& a) { small->restore(a); });
  if (!job.built.governors.empty())
    parts.add(
        governors_part, [&start](OutArchive& a) { save_governors(a, start); },
        [&](InArchive& a) {
          restore_governors(a, start);
          begin_governors(job, start);
        });
  double seconds_before = 0.0, wall_before = 0.0;
  parts.add(
      "wall clock", [&](OutArchive& a) { a.put(wall_before + watch.elapsed().wall); },
      [&](InArchive& a) { wall_before = a.number(); });
  parts.restore(resumed ? &*resumed : nullptr);
  if (resumed) {
    options.new_observers = parts.fresh();
    seconds_before = resumed->seconds;
  }
  if (sink && !series_continues) {
    if (resumed) keep_earlier_series(job, step.name);
    sink->begin(results::io_channels(channels));
  }
  const std::string deck = run::what_moves(job.model, step.name);
  const double cpu0 = cpu_seconds();
  std::optional<run::Checkpoint> kept;
  const auto checkpoint_of = [&](const system::State& state,
                                 const time::IntegratorState& integrator) {
    run::Checkpoint c{deck, t0,    start.speed, seconds_before + cpu_seconds() - cpu0,
                      {},   state, integrator,  {}};
    parts.save(c);
    return c;
  };
  if (law.checkpoint > 0.0) {
    options.checkpoint = [&](const system::State& state, const time::IntegratorState& integrator) {
      run::write_checkpoint(checkpoint_path, checkpoint_of(state, integrator));
    };
    options.keep = [&](const system::State& state, const time::IntegratorState& integrator) {
      kept = checkpoint_of(state, integrator);
    };
    options.fall_back = [&] {
      if (kept) run::write_checkpoint(checkpoint_path, *kept);
    };
  }

  run::ProgressLine line(step.name, job.options.quiet);
  options.progress = [&](const analysis::Progress& p) {
    line.update((p.t - t0) / law.duration,
                fmt::format("t {:.4g} s  {:.0f} rpm  dt {:.2e} s  {} steps  {} Newton", p.t,
                            p.spin * 30.0 / pi, p.dt, p.steps, p.newton));
  };
  analysis::TransientResult r = [&] {
    const run::PhaseTimer timer(job, "stepping and histories");
    return analysis::run_transient(problem, start.state, options, observers,
                                   resumed ? &resumed->integrator : nullptr);
  }();
  const interrupt::Shield shield;  // an interrupted step too is written to its end
  r.seconds += seconds_before;
  if (sink) sink->close();
  if (keyphasor) keyphasor->close();
  if (spectra) spectra->close();
  job.states[step.name] = {r.end, start.speed, start.governors};

  // summary
  const time::Statistics& s = r.statistics;
  io::Value& v = job.summary["steps"][step.name];
  v["type"] = "transient";
  v["outcome"] = std::string(to_string(r.reason));
  if (!r.detail.empty()) v["detail"] = r.detail;
  v["t_end [s]"] = r.end.t;
  if (resumed) v["resumed at [s]"] = resumed->state.t;
  v["integrator"]["method"] = law.integrator.method;
  v["integrator"]["tolerance"] = law.integrator.tolerance;
  v["integrator"]["steps"] = s.accepted;
  v["integrator"]["rejected by error"] = s.rejected_error;
  v["integrator"]["rejected by Newton"] = s.rejected_newton;
  v["integrator"]["Newton iterations"] = s.newton_iterations;
  if (problem.is_linear())
    v["equations"] = law.linear ? "linear: small motions about the steadily turning equilibrium"
                                : "linear: constant matrices";
  v["integrator"]["linearisations"] = s.linearizations;
  v["integrator"]["factorisations real"] = s.factorizations_real;
  v["integrator"]["factorisations complex"] = s.factorizations_complex;
  v["integrator"]["residual evaluations"] = s.residuals;
  v["integrator"]["step min [s]"] = s.step_min;
  v["integrator"]["step mean [s]"] = s.step_mean();
  v["integrator"]["step max [s]"] = s.step_max;
  v["integrator"]["local error / allowance, max"] = s.error_max;
  v["integrator"]["local error / allowance, mean"] = s.error_mean();
  const RunTime time{r.seconds, wall_before + watch.elapsed().wall};
  run::put_run_time(v, time);
  v["energy"]["stored at start [J]"] = energy.stored0();
  v["energy"]["stored at end [J]"] = energy.stored();
  v["energy"]["supplied [J]"] = energy.supplied();
  v["energy"]["dissipated [J]"] = energy.dissipated();
  v["energy"]["defect [J]"] = energy.defect();
  v["energy"]["largest defect [J]"] = energy.worst_defect();
  for (const analysis::Peak& p : peaks.peaks()) {
    io::Value& q = v["peaks"][p.name];
    q["amplitude 0-peak [m]"] = p.amplitude;
    q["time [s]"] = p.time;
    q["speed [rpm]"] = p.speed * 30.0 / pi;
  }
  v["largest tilt"]["|gamma| [rad]"] = tilt.tilt();
  v["largest tilt"]["time [s]"] = tilt.time();
  v["largest tilt"]["node"] = job.system().node(tilt.node()).name;
  v["largest tilt"]["condition of (phi', gamma') -> omega"] =
      rotation::chart_condition(tilt.tilt());
  io::ReportSection section;
  section.title = fmt::format("{}: transient", step.name);
  section.text =
      fmt::format("{} at t = {:.6g} s. {} steps of {} ({} rejected), {} Newton iterations.{}",
                  to_string(r.reason), r.end.t, s.accepted, law.integrator.method,
                  s.rejected_error + s.rejected_newton, s.newton_iterations,
                  r.detail.empty() ? "" : " " + r.detail + ".");
  {
    const run::PhaseTimer timer(job, "accuracy");
    const double speed = r.end.v[6 * job.reference() + system::spin_phi];
    for (const std::string& w :
         state_accuracy(job, {law, r, energy, lengths, speed}, v["accuracy"], section))
      warn(job, step, w);
  }
  // second-order terms: the square of the tilt
  if (law.linear && tilt.tilt() * tilt.tilt() > 0.01) {
    warn(job, step,
         fmt::format("linear = true, but {} tilts by {:.2g} rad: the terms left out are {:.2g} of "
                     "those kept",
                     job.system().node(tilt.node()).name, tilt.tilt(), tilt.tilt() * tilt.tilt()));
  }
  for (const auto& f : frames)
    v["frames"] = f->frames();

  line.done(fmt::format("{}: {} steps, {} Newton iterations, {}, energy defect {:.2e} J",
                        to_string(r.reason), s.accepted, s.newton_iterations, time.text(),
                        energy.worst_defect()));
  results::say_held(job, step, results::held_in_step(job, step), section);

  if (!events.watches().empty()) {
    io::Table t;
    t.title = "Events";
    t.columns = {{"event", "-", ""}, {"passage", "-", ""}, {"time", "s", ""}, {"speed", "rpm", ""}};
    for (const auto& e : events.events())
      t.add({events.watches()[e.watch].name, e.rising ? "rising" : "falling", e.t,
             e.speed * 30.0 / pi});
    job.folder.write_table(step.name + "_events.csv", t);
    v["events"] = events.events().size() + events.more();
    if (t.rows.size() > 100) {
      t.title = "Events (the first 100)";
      t.rows.resize(100);
    }
    section.tables.push_back(std::move(t));
    section.files.emplace_back("events", step.name + "_events.csv");
  }

  if (out.report) {
    if (!peaks.peaks().empty()) {
      io::Table t;
      t.title = "Peaks";
      t.columns = {{"probe", "-", ""},
                   {"amplitude 0-peak", "m", ""},
                   {"speed", "rpm", ""},
                   {"time", "s", ""}};
      for (const analysis::Peak& p : peaks.peaks())
        t.add({p.name, p.amplitude, p.speed * 30.0 / pi, p.time});
      job.folder.write_table(step.name + "_peaks.csv", t);
      section.tables.push_back(std::move(t));
    }
    results::add_history_figures(job, step, channels.all, channels.start, buffer, section);
    if (keyphasor) keyphasor->report(job, section);
    if (spectra) spectra->report(section);
    if (sink && out.csv) section.files.emplace_back("time history", step.name + ".csv");
    job.report.sections.push_back(std::move(section));
  }
  if (r.reason == analysis::StopReason::failed) {
    const std::string limits = run::supports_at_their_limit(job, r.end);
    throw run_error("R10", fmt::format("step '{}' stopped {}{}", step.name, r.detail, limits),
                    !limits.empty()
                        ? "results up to that time are complete; extend the table or write "
                          "extrapolate = \"hold\", or give the film more to carry with"
                    : law.integrator.tolerance < 1e-7
                        ? "results up to that time are complete; a tolerance of 1e-7 or more may "
                          "be above the rounding of this model"
                        : "results up to that time are complete; try a smaller tolerance, or look "
                          "at the state before it in the frames",
                    step.name);
  }
}

}  // namespace whirl::steps
