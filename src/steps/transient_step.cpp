// A transient step: initial state, what the deck asks for, the run, and its results.
#include <analysis/statics/equilibrium.hpp>
#include <analysis/transient/linear_motion.hpp>
#include <analysis/transient/transient.hpp>
#include <core/interrupt.hpp>
#include <core/messages.hpp>
#include <results/changing_loads.hpp>
#include <results/held.hpp>
#include <results/speed_level.hpp>
#include <results/support_coefficients.hpp>
#include <results/transient_output.hpp>
#include <run/checkpoint.hpp>
#include <run/diagnose.hpp>
#include <run/interrupt.hpp>
#include <run/job.hpp>
#include <run/progress.hpp>
#include <run/support_diagnosis.hpp>
#include <steps/starts.hpp>
#include <steps/step_kinds.hpp>
#include <steps/transient_step.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

/// Films, and nothing else whose stiffness comes and goes within a step.
bool only_films(const run::Job& job) {
  const auto comes_and_goes = [](const model::Bearing& b) {
    const model::SupportTraits t = model::traits_of(b.law);
    return t.gap || t.rolling;
  };
  return !job.built.fine.empty() &&
         std::none_of(job.model.bearings.begin(), job.model.bearings.end(), comes_and_goes);
}

/// Shafts that gears, couplings or joints turn together.
bool several_lines(const run::Job& job, const time::TwistGroup& g) {
  const auto line = [&job](Index unknown) { return job.mesh.nodes[at(unknown / 6)].line; };
  return line(g.unknowns.front()) != line(g.unknowns.back());
}

/// Torques in shafts are asked for, or a vibration of twist is what the motion begins with.
bool asks_for_twist(const run::Job& job, const model::TransientStep& law,
                    const std::vector<time::TwistGroup>& groups) {
  if (law.torques) return true;
  using Start = model::TransientStep::Start;
  if (law.start == Start::mode && law.mode_kind == model::MotionKind::torsional) return true;
  const bool joined = std::any_of(groups.begin(), groups.end(),
                                  [&job](const auto& g) { return several_lines(job, g); });
  const std::vector<std::string>& written = job.model.output.quantities;
  return std::any_of(written.begin(), written.end(), [joined](const std::string& q) {
    return q == "shaft_torque" || (joined && (q == "joints" || q == "bearing_moment"));
  });
}

/// Nodes that take as long in a step as the model does: a film on a grid counts as some thousand.
long nodes_of_work(const run::Job& job) {
  constexpr long of_a_film = 3000;
  long sum = std::max<long>(static_cast<long>(job.mesh.nodes.size()), 1);
  for (const model::Bearing& b : job.model.bearings) {
    const auto* journal = std::get_if<model::FiniteJournal>(&b.law);
    const auto* pads = std::get_if<model::TiltingPadJournal>(&b.law);
    if ((journal && journal->rows > 0) || (pads && pads->rows > 0)) sum += of_a_film;
  }
  return sum;
}

analysis::TransientOptions transient_options(const run::Job& job, const model::TransientStep& law,
                                             double t0) {
  analysis::TransientOptions t;
  t.method = law.integrator.method;
  t.reference = job.reference();
  t.interrupt = &run::interrupted();
  // marks about a quarter of a second of computing apart, counted in steps: the motion must not
  // depend on the clock
  t.steps_between_marks = std::clamp<long>(50000 / nodes_of_work(job), 8, 1000);
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
    if (b > t0 && b <= o.t_end) o.breakpoints.push_back(b);
  o.paces = job.built.paces;
  double length = 0.0;
  for (const meshes::Line& l : job.mesh.lines)
    length = std::max(length, l.length);
  if (length > 0.0) o.scales.length = length;
  o.scales.twists = job.twisting_shafts();
  o.scales.follow_twist = asks_for_twist(job, law, o.scales.twists);
  o.linearize_inside = only_films(job);
  for (const auto& f : job.built.fine) {
    if (job.system().node(f.node).scalar) {
      o.scales.limits.push_back({6 * f.node, f.length});
      continue;
    }
    for (const Index c : {1, 2})
      o.scales.limits.push_back({6 * f.node + c, f.length});
  }
  // an angle is right to the tolerance, however many turns it has made
  for (const assembly::JointResult& j : job.built.joints)
    for (const Index angle : j.angles)
      o.scales.limits.push_back({6 * angle, 1.0});
  const auto speed_stop = [&](double speed) {
    const results::SpeedLevel x = results::speed_level(job, speed, law.integrator.tolerance);
    return analysis::SpeedStop{job.reference(), x.spin, x.angle, x.reach, x.hold, {}};
  };
  if (law.stop_speed) t.speed_stops.push_back(speed_stop(*law.stop_speed));
  if (law.amplitude_limit < infinity)
    for (const auto& [name, p] : results::watched_points(job))
      t.amplitude_stops.push_back({p, law.amplitude_limit, name, {}});
  for (std::size_t k = 0; k < job.model.events.size(); ++k) {
    const model::Event& e = job.model.events[k];
    if (!e.stop) continue;
    if (e.kind == model::Event::Kind::speed) {
      t.speed_stops.push_back(speed_stop(e.value));
      t.speed_stops.back().event = k;
    } else {
      t.amplitude_stops.push_back({results::point_of(job, *e.at), e.value, e.name, k});
    }
  }
  return t;
}

namespace {

/// Pads whose elastic pivots have no mass follow the film at once: the motion begins with them in balance
/// with the journal where it is. (From any other place they would get there in no time, which no rate
/// says.)
void settle_pivots(const run::Job& job, system::State& s) {
  std::vector<Index> following;
  for (const assembly::TiltingPads& pads : job.built.tilting_pads)
    for (std::size_t k = 0; k < pads.follows.size(); ++k)
      if (pads.follows[k])
        following.insert(following.end(), pads.unknowns[k].begin(), pads.unknowns[k].end());
  if (following.empty()) return;
  system::Workspace w = job.system().make_workspace();
  VecX balanced = s.q;
  job.system().relax(w, s.frames, s.t, balanced, s.v, s.a);
  for (const Index n : following)
    s.q[6 * n] = balanced[6 * n];
}

/// A start that no transient left: settled as the step asks for.
void settle_start(run::Job& job, const model::Step& step, run::StepState& start,
                  const model::TransientStep& law) {
  using Start = model::TransientStep::Start;
  if (law.start == Start::rest) return settle_pivots(job, start.state);
  const run::PhaseTimer timer(job, "equilibrium");
  if (law.start == Start::mode)
    start_in_mode(job, start, law);
  else if (law.start == Start::unbalance_response)
    start_in_unbalance_response(job, start);
  else {
    const analysis::Equilibrium found = job.settle(start, {}, true);
    warn_of_unstable_start(job, step, start, found);
  }
}

bool all_finite(const std::vector<double>& x) {
  return std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
}

/// The oil of a bearing in balance with the journal where it is, and pads that follow at once with it;
/// false: there is no such balance, and the film begins full.
bool fill_film(const assembly::CarriedOil& oil, const assembly::NodeAt& node, VecX& q) {
  assembly::CarriedOil::Balance found = oil.balanced(node);
  const bool balanced = all_finite(found.content) && all_finite(found.followed);
  if (balanced)
    for (std::size_t k = 0; k < found.followed.size(); ++k)
      q[6 * oil.following[k]] = found.followed[k];
  else
    found.content = oil.full(node);
  for (std::size_t k = 0; k < found.content.size(); ++k)
    q[oil.unknowns[k]] = found.content[k];
  return balanced;
}

/// Oil that no motion has moved yet (zeros, from an equilibrium or from rest) is in balance with the
/// journals where they are.
void fill_films(run::Job& job, const model::Step& step, run::StepState& start) {
  if (job.built.carried_oil.empty()) return;
  system::State& s = start.state;
  system::Workspace w = job.system().make_workspace();
  if (!job.system().evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a)) return;
  const auto node = [&w](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
  for (const assembly::CarriedOil& oil : job.built.carried_oil) {
    if (std::any_of(oil.unknowns.begin(), oil.unknowns.end(),
                    [&s](Index k) { return s.q[k] != 0.0; }))
      continue;
    if (fill_film(oil, node, s.q)) continue;
    results::warn_of_step(
        job, step,
        fmt::format("{}: its oil finds no balance with the journal where the step begins; the film "
                    "begins full, and the motion with what that does to it",
                    oil.bearing));
  }
}

/// Films on a grid along the axis too: which cells follow their oil, and how far these stand from statics
/// where the step begins. One line a bearing.
std::vector<std::string> describe_followed_oil(const run::Job& job, const run::StepState& start) {
  std::vector<std::string> out;
  const system::State& s = start.state;
  system::Workspace w = job.system().make_workspace();
  if (!job.system().evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a)) return out;
  const auto node = [&w](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
  for (const assembly::CarriedOil& oil : job.built.carried_oil) {
    if (oil.grid.empty()) continue;
    out.push_back(fmt::format("{}: oil followed in {}", oil.bearing, oil.grid));
    const double off = oil.off_statics(node);
    if (std::isfinite(off))
      out.back() += fmt::format(
          ", whose force at rest is within {:.1g} of that of statics where the step begins", off);
  }
  return out;
}

}  // namespace

run::StepState transient_start(run::Job& job, const model::Step& step,
                               const model::TransientStep& law) {
  const bool other_run = !law.previous.empty();
  const auto speed = job.goes_on_in_motion(step) ? std::nullopt : law.own_speed();
  run::StepState start = other_run ? start_of_other_run(job, step, law.previous, law.previous_step)
                                   : job.start_of(step, speed);
  const Beginning beginning = beginning_of(job, step, law);
  begin_drives(job, start, beginning);
  if (other_run) {
    fill_films(job, step, start);
    return start;
  }
  using Start = model::TransientStep::Start;
  const bool steady_motion = beginning == Beginning::settled &&
                             (law.start == Start::unbalance_response || law.start == Start::mode);
  if (step.from.empty() || steady_motion) {
    settle_start(job, step, start, law);
    start.drives.clear();  // the equilibrium has angles of its own
    begin_drives(job, start, beginning);
  }
  fill_films(job, step, start);
  if (!steady_motion) run::warn_of_closed_contacts(job, step, "the start", start.state);
  return start;
}

std::unique_ptr<system::SystemProblem> transient_problem(const run::Job& job,
                                                         const model::TransientStep& law,
                                                         const run::StepState& start) {
  if (!law.linear)
    return std::make_unique<system::SystemProblem>(
        job.system(), system::ProblemOptions{la::SolverKind::automatic, job.model.chart_change});
  analysis::SteadyRotation running = job.steady_rotation_of(start);
  running.time = start.state.t;
  auto motion =
      std::make_unique<analysis::LinearMotion>(job.system(), running, start.speed, start.state);
  const std::vector<std::string>& wanted = job.model.output.quantities;
  if (std::find(wanted.begin(), wanted.end(), "joints") != wanted.end()) motion->take_joint_loads();
  return motion;
}

namespace {

/// A drive that prescribes another speed than the rotor has where the step goes on: an infinite
/// torque for an instant. An angle goes on from the one there, whatever its law says.
void warn_of_jumps(run::Job& job, const model::Step& step, const run::StepState& start) {
  constexpr double seen = 1e-3;      // of the speed
  constexpr double rounding = 1e-6;  // of the angle
  for (const model::Drive& d : job.model.drives) {
    const auto* law = std::get_if<model::PrescribedSpin>(&d.law);
    if (!law || !law->angle || (!d.step.empty() && d.step != step.name)) continue;
    const Index node = job.mesh.place(d.at).node;
    const Index k = 6 * node + system::spin_phi;
    const double turns = start.state.frames.turns[at(job.system().node(node).line)];
    const std::string& shaft = job.model.shafts[d.at.shaft].name;
    const LawValue wanted = law->angle->at(start.state.t);
    const double speed = start.state.v[k], angle = start.state.q[k] + two_pi * turns;
    if (std::abs(wanted.df - speed) > seen * std::max(std::abs(wanted.df), std::abs(speed)))
      results::warn_of_step(
          job, step,
          fmt::format("drive '{}' prescribes {:.6g} rpm at t = {:.6g} s, where shaft '{}' turns at "
                      "{:.6g} rpm: its speed jumps",
                      d.name, to_rpm(wanted.df), start.state.t, shaft, to_rpm(speed)));
    if (law->angle_given && std::abs(wanted.f - angle) > rounding * (1.0 + std::abs(angle)))
      results::warn_of_step(
          job, step,
          fmt::format("drive '{}' prescribes an angle of {:.6g} rad at t = {:.6g} s, where shaft "
                      "'{}' stands at {:.6g} rad: it turns on from there, off by {:.6g} rad",
                      d.name, wanted.f, start.state.t, shaft, angle, angle - wanted.f));
  }
}

/// Where a prescribed angle or its rate jumps while a step runs.
struct Jumps {
  int count = 0;
  double time = 0, speed = 0, angle = 0;  ///< the largest: s, rad/s, rad
};
Jumps jumps_of(const Law& angle, double from, double to) {
  constexpr double seen = 1e-3;  // of the largest speed
  double fastest = std::abs(angle.at(from).df);
  for (const double t : angle.breakpoints())
    if (t >= from && t <= to)
      fastest = std::max(
          {fastest, std::abs(angle.at(t).df), std::abs(angle.at(std::nextafter(t, -infinity)).df)});
  Jumps out;
  for (const double t : angle.breakpoints()) {
    if (t <= from || t > to) continue;
    const LawValue left = angle.at(std::nextafter(t, -infinity)), right = angle.at(t);
    const double speed = right.df - left.df, turned = right.f - left.f;
    const bool leaps = std::abs(turned) > 1e-9 * (1.0 + std::abs(right.f));
    const bool jumps = std::abs(speed) > seen * fastest;
    if (!leaps && !jumps) continue;
    const bool larger = leaps ? std::abs(turned) > std::abs(out.angle)
                              : out.angle == 0.0 && std::abs(speed) > std::abs(out.speed);
    if (out.count++ == 0 || larger) {
      out.time = t;
      out.speed = speed;
      out.angle = leaps ? turned : 0.0;
    }
  }
  return out;
}

/// Laws that take no time to change the speed: what does that is in none of the results.
void warn_of_jumping_laws(run::Job& job, const model::Step& step, const model::TransientStep& law,
                          const run::StepState& start) {
  const double from = start.state.t, to = from + law.duration;
  for (const model::Drive& d : job.model.drives) {
    const auto* spin = std::get_if<model::PrescribedSpin>(&d.law);
    if (!spin || !spin->angle || (!d.step.empty() && d.step != step.name)) continue;
    const Jumps jumps = jumps_of(*spin->angle, from, to);
    if (jumps.count == 0) continue;
    const std::string what =
        jumps.angle != 0.0
            ? fmt::format("angle of drive '{}' jumps by {:.4g} rad", d.name, jumps.angle)
            : fmt::format("speed of drive '{}' jumps by {:.4g} rpm", d.name, to_rpm(jumps.speed));
    results::warn_of_step(
        job, step,
        fmt::format("the {} at t = {:.6g} s{}: a torque without bound for an instant, in no column "
                    "of torque "
                    "or work; a ramp, smooth or monotone_cubic law takes time for it",
                    what, jumps.time,
                    jumps.count > 1 ? fmt::format(", the largest of {} jumps", jumps.count) : ""));
  }
}

/// Shafts that gears or couplings tie, and that begin as if nothing did.
void warn_of_pairs(run::Job& job, const model::Step& step, const run::StepState& start) {
  for (const model::Bearing& b : job.model.bearings) {
    const std::optional<model::ShaftPair> pair = *model::traits_of(b.law).pair;
    if (!pair || !b.to) continue;
    const auto spin = [&](const model::Location& at) {
      return start.state.v[6 * job.mesh.place(at).node + system::spin_phi];
    };
    const double here = spin(b.at), there = spin(*b.to), tied = pair->speed_ratio * here;
    if (std::abs(there - tied) <= 1e-3 * std::max(std::abs(there), std::abs(tied))) continue;
    const auto name = [&](const model::Location& at) { return job.model.shafts[at.shaft].name; };
    results::warn_of_step(
        job, step,
        fmt::format("{} '{}' turns shaft '{}' at {:.6g} times the speed of '{}', but they begin at "
                    "{:.6g} and {:.6g} rpm: it meets them with a shock; initial_speed, or "
                    "initial_spin of the shaft that no drive holds, lets them begin together",
                    pair->noun, b.name, name(*b.to), pair->speed_ratio, name(b.at), to_rpm(there),
                    to_rpm(here)));
  }
}

/// Oil of hot films takes no time where these have ruptured.
void warn_of_momentary_oil(run::Job& job, const model::Step& step) {
  const auto momentary = [](const auto& law) {
    return law.flow.conserves_mass() && !law.flow.follows_oil();
  };
  for (const model::Bearing& b : job.model.bearings) {
    const auto* journal = std::get_if<model::FiniteJournal>(&b.law);
    const auto* pads = std::get_if<model::TiltingPadJournal>(&b.law);
    if (!(journal && momentary(*journal)) && !(pads && momentary(*pads))) continue;
    results::warn_of_step(
        job, step,
        fmt::format("bearing '{}': with 'heat' the oil of ruptured film is not followed: it comes "
                    "to the next film in no time, and the film is that of the momentary state",
                    b.name));
  }
}

/// From where a resumed step goes on; nothing: from its beginning.
std::optional<run::Checkpoint> resumed_from(const run::Job& job,
                                            const std::filesystem::path& file) {
  if (!job.options.resume) return std::nullopt;
  std::optional<run::UsableCheckpoint> found = run::usable_checkpoint(file);
  if (!found) return std::nullopt;
  if (!found->earlier.empty()) {
    Diagnostic d;
    d.severity = Diagnostic::Severity::warning;
    d.message = fmt::format("{}; the run goes on from the one before, '{}', at t = {:.6g} s",
                            found->why, found->earlier.string(), found->checkpoint.state.t);
    d.hint = "results are those of an undisturbed run; what came after that time is computed again";
    run::print_diagnostics({d});
  }
  run::put_back(*found, file);
  return std::move(found->checkpoint);
}

/// A transient step on its way.
class TransientRun {
 public:
  TransientRun(run::Job& job, const model::Step& step, const model::TransientStep& law);
  /// Steps through time and writes what came of it. Error R10: no step is possible any more; what
  /// came before is written.
  void execute();

 private:
  void begin_as_it_turns();
  void warn_of_start() const;
  void add_own_parts();
  run::Checkpoint checkpoint_of(const system::State& state,
                                const time::IntegratorState& integrator) const;
  void write_checkpoints();
  void write(const run::Checkpoint& c) const;
  analysis::TransientResult integrate(run::ProgressLine& line);
  void summarize(const analysis::TransientResult& r, const RunTime& time) const;
  void say_followed_oil(io::ReportSection& section) const;
  io::ReportSection section_of(const analysis::TransientResult& r) const;
  [[noreturn]] void say_failure(const analysis::TransientResult& r) const;

  const Stopwatch watch_;
  run::Job& job_;
  const model::Step& step_;
  const model::TransientStep& law_;
  const std::filesystem::path checkpoint_path_;
  const std::string deck_;  ///< what the motion depends on
  std::optional<run::Checkpoint> resumed_, kept_;
  run::StepState start_;
  const std::vector<std::string> oil_;  ///< what is said of films whose oil is followed
  std::unique_ptr<system::SystemProblem> problem_;
  double t_begin_;
  analysis::TransientOptions options_;
  results::TransientOutputs outputs_;
  std::vector<analysis::Observer*> observers_;
  run::Parts parts_;
  double cpu_before_ = 0.0, wall_before_ = 0.0;  ///< of the earlier part of a resumed run, s
  double cpu_begin_ = 0.0;                       ///< where this part began to step, s
};

TransientRun::TransientRun(run::Job& job, const model::Step& step, const model::TransientStep& law)
    : job_(job),
      step_(step),
      law_(law),
      checkpoint_path_(job.folder.path(run::checkpoint_name(step.name))),
      deck_(run::what_moves(job.model, step.name)),
      resumed_(resumed_from(job, checkpoint_path_)),
      start_(resumed_ ? run::StepState{resumed_->state, resumed_->speed, {}}
                      : transient_start(job, step, law)),
      oil_(describe_followed_oil(job, start_)),
      problem_(transient_problem(job, law, start_)),
      t_begin_(resumed_ ? resumed_->t_begin : start_.state.t),
      options_(transient_options(job, law, t_begin_)) {
  if (beginning_of(job, step, law) == Beginning::in_motion) begin_as_it_turns();
  warn_of_start();
  outputs_ = results::make_transient_outputs(
      {job, step, law, start_, options_.integrator, t_begin_, resumed_.has_value(),
       dynamic_cast<const analysis::LinearMotion*>(problem_.get())});
  for (const auto& output : outputs_) {
    output->attach(observers_, parts_);
    if (auto change = output->between_steps()) options_.between_steps = std::move(change);
    if (law.integrator.dt == 0.0)
      options_.integrator.dt_max = std::min(options_.integrator.dt_max, output->longest_step());
  }
  add_own_parts();
  parts_.restore(resumed_ ? &*resumed_ : nullptr);
  if (resumed_) {
    options_.new_observers = parts_.fresh();
    cpu_before_ = resumed_->seconds;
  }
  for (const auto& output : outputs_)
    output->open();
  if (law.checkpoint > 0.0) write_checkpoints();
}

/// A motion that goes on: its accelerations hold what the steps before it left of motions that they did
/// not resolve, and say nothing of the step to begin with. The error test shortens one that is too long.
void TransientRun::begin_as_it_turns() {
  constexpr double turned = 0.01;  // rad
  const double spin = std::abs(start_.state.v[6 * job_.reference() + system::spin_phi]);
  time::Options& o = options_.integrator;
  if (o.dt_first == 0.0 && o.dt_fixed == 0.0 && spin > 0.0)
    o.dt_first = std::min(turned / spin, o.dt_max);
}

void TransientRun::warn_of_start() const {
  if (resumed_) return;
  const bool other_run = !law_.previous.empty();
  if (!step_.from.empty() || other_run) warn_of_jumps(job_, step_, start_);
  using Start = model::TransientStep::Start;
  const bool given = law_.start == Start::rest || law_.start == Start::static_equilibrium;
  if (given && beginning_of(job_, step_, law_) == Beginning::settled)
    warn_of_pairs(job_, step_, start_);
  warn_of_jumping_laws(job_, step_, law_, start_);
  results::warn_of_changing_loads(job_, step_, law_, start_);
  if (!law_.linear) warn_of_momentary_oil(job_, step_);
  if (law_.own_speed() && (job_.goes_on_in_motion(step_) || other_run))
    results::warn_of_step(
        job_, step_,
        "initial_speed has no effect: the step goes on from a motion with its own speed");
}

/// What the motion itself needs to go on.
void TransientRun::add_own_parts() {
  if (auto* small = dynamic_cast<analysis::LinearMotion*>(problem_.get()))
    parts_.add(
        {run::Part::steady_motion}, [small](OutArchive& a) { small->save(a); },
        [small](InArchive& a) { small->restore(a); });
  if (!job_.built.turn_counts.empty() || !job_.built.coasting.empty())
    parts_.add(
        {run::Part::drives}, [this](OutArchive& a) { save_drives(a, start_); },
        [this](InArchive& a) {
          restore_drives(a, start_);
          begin_drives(job_, start_, Beginning::resumed);
        });
  parts_.add(
      {run::Part::wall_clock},
      [this](OutArchive& a) { a.put(wall_before_ + watch_.elapsed().wall); },
      [this](InArchive& a) { wall_before_ = a.number(); });
}

run::Checkpoint TransientRun::checkpoint_of(const system::State& state,
                                            const time::IntegratorState& integrator) const {
  const double cpu = cpu_before_ + thread_cpu_seconds() - cpu_begin_;
  run::Checkpoint c{deck_, t_begin_, start_.speed, cpu, {}, state, integrator, {}};
  parts_.save(c);
  return c;
}

void TransientRun::write(const run::Checkpoint& c) const {
  std::error_code ec;
  if (std::filesystem::exists(checkpoint_path_,
                              ec))  // it becomes the earlier one, a file of this run
    job_.folder.path(run::earlier_checkpoint_name(step_.name));
  run::write_checkpoint(checkpoint_path_, c);
}

void TransientRun::write_checkpoints() {
  options_.checkpoint = [this](const system::State& state,
                               const time::IntegratorState& integrator) {
    write(checkpoint_of(state, integrator));
  };
  options_.keep = [this](const system::State& state, const time::IntegratorState& integrator) {
    kept_ = checkpoint_of(state, integrator);
  };
  options_.fall_back = [this] {
    if (kept_) write(*kept_);
  };
}

analysis::TransientResult TransientRun::integrate(run::ProgressLine& line) {
  options_.progress = [this, &line](const analysis::Progress& p) {
    line.update((p.t - t_begin_) / law_.duration,
                fmt::format("t {:.4g} s  {:.0f} rpm  dt {:.2e} s  {} steps  {} Newton", p.t,
                            to_rpm(p.spin), p.dt, p.steps, p.newton));
  };
  const run::PhaseTimer timer(job_, "stepping and histories");
  cpu_begin_ = thread_cpu_seconds();
  analysis::TransientResult r = analysis::run_transient(
      *problem_, start_.state, options_, observers_, resumed_ ? &resumed_->integrator : nullptr);
  r.seconds += cpu_before_;
  return r;
}

void put_statistics(io::Value& v, const model::IntegratorOptions& scheme,
                    const time::Statistics& s) {
  v["method"] = scheme.method;
  v["tolerance"] = scheme.tolerance;
  v["steps"] = s.accepted;
  v["rejected by error"] = s.rejected_error;
  v["rejected by Newton"] = s.rejected_newton;
  v["Newton iterations"] = s.newton_iterations;
  v["linearisations"] = s.linearizations;
  v["factorisations real"] = s.factorizations_real;
  v["factorisations complex"] = s.factorizations_complex;
  v["residual evaluations"] = s.residuals;
  v["step min [s]"] = s.step_min;
  v["step mean [s]"] = s.step_mean();
  v["step max [s]"] = s.step_max;
  v["local error / allowance, max"] = s.error_max;
  v["local error / allowance, mean"] = s.error_mean();
}

void TransientRun::summarize(const analysis::TransientResult& r, const RunTime& time) const {
  io::Value& v = job_.summary["steps"][step_.name];
  v["type"] = "transient";
  v["outcome"] = std::string(to_string(r.reason));
  if (!r.detail.empty()) v["detail"] = r.detail;
  v["t_end [s]"] = r.end.t;
  if (resumed_) v["resumed at [s]"] = resumed_->state.t;
  put_statistics(v["integrator"], law_.integrator, r.statistics);
  if (problem_->is_linear())
    v["equations"] = law_.linear ? "linear: small motions about the steadily turning equilibrium"
                                 : "linear: constant matrices";
  run::put_run_time(v, time);
}

io::ReportSection TransientRun::section_of(const analysis::TransientResult& r) const {
  const time::Statistics& s = r.statistics;
  io::ReportSection section;
  section.title = fmt::format("{}: transient", step_.name);
  section.text =
      fmt::format("{} at t = {:.6g} s. {} steps of {} ({} rejected), {} Newton iterations.{}",
                  to_string(r.reason), r.end.t, s.accepted, law_.integrator.method,
                  s.rejected_error + s.rejected_newton, s.newton_iterations,
                  r.detail.empty() ? "" : " " + r.detail + ".");
  return section;
}

void TransientRun::say_followed_oil(io::ReportSection& section) const {
  for (const std::string& text : oil_) {
    job_.summary["steps"][step_.name]["oil"].push(text);
    if (!job_.options.quiet) say(fmt::format("  {}: {}\n", step_.name, text));
    section.text += " " + text + ".";
  }
}

void TransientRun::say_failure(const analysis::TransientResult& r) const {
  const std::string limits = run::supports_at_their_limit(job_, r.end);
  const std::string hint =
      !limits.empty() ? "extend the table or write extrapolate = \"hold\", or give the film more "
                        "to carry with"
      : law_.integrator.dt_min > 0.0
          ? fmt::format("dt_min = {:.6g} ms allows no shorter step: leave it out",
                        1e3 * law_.integrator.dt_min)
      : law_.integrator.tolerance < 1e-7
          ? "a tolerance of 1e-7 or more may be above the rounding of this model"
          : "try a smaller tolerance, or look at the state before it in the frames";
  const std::string pad = run::light_pad_without_load(job_, r.end);
  const std::string of_pad = pad.empty() ? ""
                                         : fmt::format(
                                               "{} has no inertia, so that little says how "
                                               "it moves: give its bearing inertia; else ",
                                               pad);
  throw run_error("R10", fmt::format("step '{}' stopped {}{}", step_.name, r.detail, limits),
                  "results up to that time are complete; " + of_pad + hint, step_.name);
}

void TransientRun::execute() {
  run::ProgressLine line(step_.name, job_.options.quiet);
  const analysis::TransientResult r = integrate(line);
  const interrupt::Shield shield;  // an interrupted step too is written to its end
  for (const auto& output : outputs_)
    output->close();
  job_.states[step_.name] = {r.end, start_.speed, start_.drives};

  const RunTime time{r.seconds, wall_before_ + watch_.elapsed().wall};
  summarize(r, time);
  io::ReportSection section = section_of(r);
  results::TransientEnd end{job_, step_, law_, r, job_.summary["steps"][step_.name], section};
  std::string headline =
      fmt::format("{}: {} steps, {} Newton iterations, {}", to_string(r.reason),
                  r.statistics.accepted, r.statistics.newton_iterations, time.text());
  for (const auto& output : outputs_) {
    output->summarize(end);
    if (const std::string words = output->headline(); !words.empty()) headline += ", " + words;
  }
  line.done(headline);
  if (r.reason != analysis::StopReason::failed)
    results::report_kept_films(job_, step_.name, r.end, law_.linear);
  say_followed_oil(section);
  results::say_held(job_, step_, results::held_in_step(job_, step_), section);
  for (const auto& output : outputs_)
    output->report(end);
  if (job_.model.output.report) job_.report.sections.push_back(std::move(section));
  if (r.reason == analysis::StopReason::failed) say_failure(r);
}

}  // namespace

void run_transient_step(run::Job& job, const model::Step& step, const model::TransientStep& law) {
  job.build_for(step);
  TransientRun(job, step, law).execute();
}

}  // namespace whirl::steps
