// A transient step: initial state, observers for what the deck asks for, the run, and its results.
#include <analysis/equilibrium.hpp>
#include <analysis/transient.hpp>
#include <app/interrupt.hpp>
#include <app/job.hpp>
#include <app/plot_buffer.hpp>
#include <core/rotation.hpp>
#include <io/plots.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::app {

namespace {

using analysis::Measurement;
using analysis::Point;
using analysis::Snapshot;

bool wants(const model::Output& o, std::string_view quantity) {
  return std::find(o.quantities.begin(), o.quantities.end(), quantity) != o.quantities.end();
}

Point point_of(const Job& job, const model::Location& at) {
  const meshes::Place p = job.mesh.place(at);
  return {p.node, p.offset};
}

/// Channels of a time history, with the plots they belong to.
struct Channels {
  std::vector<Measurement> all;
  std::vector<std::size_t> start;        // first column (without time) of each measurement
  std::size_t columns = 0;
  std::size_t add(Measurement m) {
    start.push_back(columns);
    columns += m.width();
    all.push_back(std::move(m));
    return all.size() - 1;
  }
};

Channels make_channels(const Job& job) {
  const model::Model& m = job.model;
  Channels c;
  if (wants(m.output, "speed")) {
    c.add(analysis::measure_spin("speed", job.reference()));
    c.add(analysis::measure_phi("phi", job.reference()));
    for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
      const meshes::Line& line = job.mesh.lines[l];
      if (line.rotating && job.mesh.lines.size() > 1) c.add(analysis::measure_spin("speed " + line.name, line.first_node));
    }
  }
  if (wants(m.output, "probes"))
    for (const model::Probe& p : m.probes) c.add(analysis::measure_displacement(p.name, point_of(job, p.at), p.angles));
  if (wants(m.output, "positions"))
    for (const model::Probe& p : m.probes) c.add(analysis::measure_position(p.name + " position", point_of(job, p.at)));
  if (wants(m.output, "velocity"))
    for (const model::Probe& p : m.probes) c.add(analysis::measure_velocity(p.name + " velocity", point_of(job, p.at)));
  if (wants(m.output, "rotation"))
    for (const model::Probe& p : m.probes) {
      const Point at = point_of(job, p.at);
      c.add(analysis::measure_gamma(p.name + " gamma", at.node));
      c.add(analysis::measure_phi(p.name + " phi", at.node));
      c.add(analysis::measure_phi_rate(p.name + " omega_phi", at.node));
    }
  if (wants(m.output, "bearing_force"))
    for (const assembly::SupportForce& f : job.built.support_forces) {
      Measurement x{"bearing " + f.name + " force", "N", "force of the support on the shaft, fixed axes", {"x", "y", "z"}, 1.0, {}};
      x.evaluate = [&f](const Snapshot& s, double* out) {
        Eigen::Map<Vec3>{out} = f.force([&s](Index n) -> const system::NodeState& { return s.node(n); }, s.t(),
                                        [&s](Index k) { return s.reactions()[k]; });
      };
      c.add(std::move(x));
    }
  if (wants(m.output, "torque"))
    for (const assembly::DriveTorque& d : job.built.drive_torques) {
      Measurement x{"drive " + d.name + " torque", "N.m", "torque of the drive on the shaft", {}, 1.0, {}};
      x.evaluate = [&d](const Snapshot& s, double* out) {
        *out = d.torque([&s](Index n) -> const system::NodeState& { return s.node(n); }, s.t(), [&s](Index k) { return s.reactions()[k]; });
      };
      c.add(std::move(x));
    }
  if (wants(m.output, "energy")) c.add(analysis::measure_energy());
  return c;
}

std::vector<io::Channel> io_channels(const Channels& c) {
  std::vector<io::Channel> out{{"t", "s", "time", {}, 1.0, {}}};
  for (const Measurement& m : c.all) out.push_back({m.name, m.unit, m.description, m.components, m.scale, {}});
  return out;
}

/// Writes frames of the moving rotor when they are due.
class Frames final : public analysis::Observer {
 public:
  Frames(const Job& job, const model::VtkOutput& o, const std::string& step, double t0, double t1)
      : job_(job), schedule_({o.t0, o.t1, o.every, o.frames_per_revolution, o.frames, o.max_frames}, t0, t1) {
    io::VtkFrameOptions options;
    options.directory = job.folder.path("vtk");
    options.name = step;
    io::set_content(options, o.content);
    options.deformation_scale = o.deformation_scale;
    options.points_around = o.points_around;
    options.max_frames = static_cast<std::uint64_t>(o.max_frames);
    writer_ = io::make_vtk_frames(options);
    const std::size_t n = job.mesh.nodes.size();
    poses_.resize(n), velocity_.resize(n), omega_.resize(n);
  }
  void begin(const Snapshot& s) override {
    writer_->begin(job_.scene);
    phi_ = s.total_phi(job_.reference());
    if (!schedule_.by_revolution() && schedule_.next_time() <= s.t()) write(s), schedule_.advance();
  }
  void step(analysis::StepAccess& s) override {
    if (!schedule_.by_revolution()) {
      for (; schedule_.next_time() <= s.t1() * (1 + 1e-12); schedule_.advance()) write(s.at(std::min(schedule_.next_time(), s.t1())));
      return;
    }
    // frames at fixed angles of the reference: phi is nearly linear inside a step, so a secant needs two or three looks
    const double phi1 = s.end().total_phi(job_.reference()), sign = phi1 >= phi_ ? 1.0 : -1.0;
    double target = schedule_.next_angle(phi_, sign), a = s.t0(), fa = phi_;
    while (sign * (phi1 - target) >= 0.0 && phi1 != phi_) {
      double lo = a, flo = fa, hi = s.t1(), fhi = phi1, t = hi;
      for (int k = 0; k < 8 && std::abs(fhi - flo) > 1e-9; ++k) {
        t = lo + (hi - lo) * (target - flo) / (fhi - flo);
        const double f = s.at(t).total_phi(job_.reference());
        if (std::abs(f - target) < 1e-6) break;
        (sign * (f - target) < 0.0 ? lo : hi) = t;
        (sign * (f - target) < 0.0 ? flo : fhi) = f;
      }
      if (schedule_.in_window(t)) write(s.at(t));
      a = t, fa = target;
      target = schedule_.next_angle(target + sign * 1e-9, sign);
    }
    phi_ = phi1;
  }
  void end() override { writer_->end(); }
  std::uint64_t frames() const { return writer_->frames(); }

 private:
  void write(const Snapshot& s) {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      const system::NodeState& n = s.node(static_cast<Index>(i));
      poses_[i] = {job_.mesh.nodes[i].position + n.u, n.d(), n.phi};
      velocity_[i] = n.du, omega_[i] = n.omega();
    }
    io::FrameState frame;
    frame.time = s.t();
    frame.nodes = poses_, frame.velocity = velocity_, frame.angular_velocity = omega_;
    writer_->frame(frame);
  }
  const Job& job_;
  io::FrameSchedule schedule_;
  std::unique_ptr<io::FrameWriter> writer_;
  std::vector<io::Pose> poses_;
  std::vector<Vec3> velocity_, omega_;
  double phi_ = 0;
};

}  // namespace

std::vector<std::pair<std::string, Point>> watched_points(const Job& job) {
  std::vector<std::pair<std::string, Point>> watched;
  for (const model::Probe& p : job.model.probes) watched.emplace_back(p.name, point_of(job, p.at));
  if (watched.empty())
    for (const model::Disk& d : job.model.disks) watched.emplace_back("disk " + d.name, point_of(job, d.at));
  return watched;
}

analysis::TransientOptions transient_options(const Job& job, const model::TransientStep& law, double t0) {
  analysis::TransientOptions t;
  t.method = law.integrator.method;
  t.reference = job.reference();
  t.interrupt = &interrupted();
  time::Options& o = t.integrator;
  o.tolerance = law.integrator.tolerance;
  o.t_end = t0 + law.duration;
  o.dt_fixed = law.integrator.dt, o.dt_first = law.integrator.dt_first, o.dt_min = law.integrator.dt_min, o.dt_max = law.integrator.dt_max;
  o.rho_inf = law.integrator.rho_inf;
  for (double b : job.built.breakpoints)
    if (b > t0 && b < o.t_end) o.breakpoints.push_back(b);
  double length = 0.0;
  for (const meshes::Line& l : job.mesh.lines) length = std::max(length, l.length);
  if (length > 0.0) o.scales.length = length;
  if (law.stop_speed != 0.0) t.speed_stops.push_back({job.reference(), law.stop_speed});
  if (law.amplitude_limit < infinity)
    for (const auto& [name, p] : watched_points(job)) t.amplitude_stops.push_back({p, law.amplitude_limit, name});
  return t;
}

StepState transient_start(Job& job, system::SystemProblem& problem, const model::Step& step, const model::TransientStep& law) {
  StepState start = job.start_of(step, law.speed0);
  if (law.start == model::TransientStep::Start::static_equilibrium && step.from.empty()) {
    const PhaseTimer timer(job, "equilibrium");
    job.settle(problem, start);
  }
  return start;
}

void run_transient_step(Job& job, const model::Step& step, const model::TransientStep& law) {
  job.build_for(step);
  system::SystemProblem problem(job.system(), {la::SolverKind::automatic, job.model.chart_change, 2.0});
  StepState start = transient_start(job, problem, step, law);
  const double t0 = start.state.t;
  analysis::TransientOptions options = transient_options(job, law, t0);
  const std::vector<std::pair<std::string, Point>> watched = watched_points(job);

  // observers: only what the deck asks for
  std::vector<analysis::Observer*> observers;
  const model::Output& out = job.model.output;
  Channels channels = make_channels(job);
  PlotBuffer buffer(channels.columns);
  std::vector<io::TimeSeriesPtr> sinks;
  if (out.csv) sinks.push_back(io::make_csv_series(job.folder.path(step.name + ".csv")));
  if (out.binary) sinks.push_back(io::make_hdf5_series(job.folder.path(step.name + ".h5")));
  io::TimeSeriesPtr sink = sinks.empty() ? nullptr : sinks.size() == 1 ? std::move(sinks.front()) : io::make_tee(std::move(sinks));
  if (sink) sink->begin(io_channels(channels));
  analysis::Recorder recorder(
      channels.all,
      [&](const std::vector<double>& row) {
        if (sink) sink->append(row);
        if (out.report) buffer.append(row);
      },
      t0, out.every);
  if (channels.columns > 0 && (sink || out.report)) observers.push_back(&recorder);
  analysis::PeakTracker peaks(watched, job.reference());
  if (!watched.empty()) observers.push_back(&peaks);
  analysis::EnergyBalance energy;
  observers.push_back(&energy);
  analysis::TiltWatch tilt;
  observers.push_back(&tilt);
  std::vector<std::unique_ptr<Frames>> frames;
  for (const model::VtkOutput& v : out.vtk)
    if (v.step.empty() || v.step == step.name) {
      frames.push_back(std::make_unique<Frames>(job, v, step.name, t0, options.integrator.t_end));
      observers.push_back(frames.back().get());
    }

  ProgressLine line(step.name, job.options.quiet);
  options.progress = [&](const analysis::Progress& p) {
    line.update((p.t - t0) / law.duration,
                fmt::format("t {:.4g} s  {:.0f} rpm  dt {:.2e} s  {} steps  {} Newton", p.t, p.spin * 30.0 / pi, p.dt, p.steps, p.newton));
  };
  const analysis::TransientResult r = [&] {
    const PhaseTimer timer(job, "stepping and histories");
    return analysis::run_transient(problem, start.state, options, observers);
  }();
  if (sink) sink->close();
  job.states[step.name] = {r.end, start.speed};

  // summary
  const time::Statistics& s = r.statistics;
  io::Value& v = job.summary["steps"][step.name];
  v["type"] = "transient", v["outcome"] = std::string(to_string(r.reason));
  if (!r.detail.empty()) v["detail"] = r.detail;
  v["t_end [s]"] = r.end.t;
  v["integrator"]["method"] = law.integrator.method, v["integrator"]["tolerance"] = law.integrator.tolerance;
  v["integrator"]["steps"] = s.accepted, v["integrator"]["rejected by error"] = s.rejected_error;
  v["integrator"]["rejected by Newton"] = s.rejected_newton, v["integrator"]["Newton iterations"] = s.newton_iterations;
  v["integrator"]["linearisations"] = s.linearizations;
  v["integrator"]["factorisations real"] = s.factorizations_real, v["integrator"]["factorisations complex"] = s.factorizations_complex;
  v["integrator"]["residual evaluations"] = s.residuals;
  v["integrator"]["step min [s]"] = s.step_min, v["integrator"]["step mean [s]"] = s.step_mean(), v["integrator"]["step max [s]"] = s.step_max;
  v["integrator"]["local error / allowance, max"] = s.error_max, v["integrator"]["local error / allowance, mean"] = s.error_mean();
  v["run time [s]"] = r.seconds;
  v["energy"]["stored at start [J]"] = energy.stored0(), v["energy"]["stored at end [J]"] = energy.stored();
  v["energy"]["supplied [J]"] = energy.supplied(), v["energy"]["dissipated [J]"] = energy.dissipated();
  v["energy"]["defect [J]"] = energy.defect(), v["energy"]["largest defect [J]"] = energy.worst_defect();
  for (const analysis::Peak& p : peaks.peaks()) {
    io::Value& q = v["peaks"][p.name];
    q["amplitude 0-peak [m]"] = p.amplitude, q["time [s]"] = p.time, q["speed [rpm]"] = p.speed * 30.0 / pi;
  }
  v["largest tilt"]["|gamma| [rad]"] = tilt.tilt(), v["largest tilt"]["time [s]"] = tilt.time();
  v["largest tilt"]["node"] = job.system().node(tilt.node()).name;
  v["largest tilt"]["condition of (phi', gamma') -> omega"] = rotation::chart_condition(tilt.tilt());
  for (const auto& f : frames) v["frames"] = f->frames();

  line.done(fmt::format("{}: {} steps, {} Newton iterations, {:.3f} s, energy defect {:.2e} J", to_string(r.reason), s.accepted,
                        s.newton_iterations, r.seconds, energy.worst_defect()));

  if (out.report) {
    io::ReportSection section;
    section.title = fmt::format("{}: transient", step.name);
    section.text = fmt::format("{} at t = {:.6g} s. {} steps of {} ({} rejected), {} Newton iterations, {:.3f} s CPU. Largest defect of the energy balance {:.3g} J.{}",
                               to_string(r.reason), r.end.t, s.accepted, law.integrator.method, s.rejected_error + s.rejected_newton,
                               s.newton_iterations, r.seconds, energy.worst_defect(), r.detail.empty() ? "" : " " + r.detail + ".");
    if (!peaks.peaks().empty()) {
      io::Table t;
      t.title = "Peaks";
      t.columns = {{"probe", "-", ""}, {"amplitude 0-peak", "m", ""}, {"speed", "rpm", ""}, {"time", "s", ""}};
      for (const analysis::Peak& p : peaks.peaks()) t.add({p.name, p.amplitude, p.speed * 30.0 / pi, p.time});
      job.folder.write_table(step.name + "_peaks.csv", t);
      section.tables.push_back(std::move(t));
    }
    add_history_figures(job, step, channels.all, channels.start, buffer, section);
    if (sink && out.csv) section.files.emplace_back("time history", step.name + ".csv");
    job.report.sections.push_back(std::move(section));
  }
  if (r.reason == analysis::StopReason::failed)
    throw run_error("R10", fmt::format("step '{}' stopped {}", step.name, r.detail),
                    "results up to that time are complete; try a smaller tolerance, or look at the state before it in the frames", step.name);
}

}  // namespace whirl::app
