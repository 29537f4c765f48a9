// States a transient step can start from beside rest and static equilibrium.
#include <analysis/response/harmonic.hpp>
#include <analysis/spectra/whirl_modes.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/stability_results.hpp>
#include <results/transient_output.hpp>
#include <run/checkpoint.hpp>
#include <run/job.hpp>
#include <steps/starts.hpp>

#include <fmt/format.h>

namespace whirl::steps {

namespace {

/// The turning model at the spins of a start.
analysis::Linearizer linearizer_of(const run::Job& job, const run::StepState& start) {
  analysis::SteadyRotation running;
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    const double spin = start.state.v[6 * job.mesh.lines[l].first_node + system::spin_phi];
    running.ratio.push_back(start.speed != 0.0             ? spin / start.speed
                            : job.model.shafts[l].rotating ? job.model.shafts[l].speed_ratio
                                                           : 0.0);
  }
  running.ratio.resize(static_cast<std::size_t>(job.system().lines()), 0.0);
  running.axially_free = job.built.axially_free;
  running.time = start.state.t;
  running.hysteretic = false;  // the motion that begins has its stand-in
  analysis::EquilibriumOptions o;
  o.chart_change = job.model.chart_change;
  return analysis::Linearizer(job.system(), running, o);
}

/// Axial angle of the reference at the start: what turns with the rotor stands there.
double start_angle(const run::Job& job, const run::StepState& start) {
  return start.state.q[6 * job.reference() + system::spin_phi];
}

/// The equilibrium has its rotor at angle zero; the start's angles are put back.
void take_equilibrium(const run::Job& job, const analysis::Equilibrium& e, run::StepState& start) {
  const VecX q0 = start.state.q, v0 = start.state.v;
  const double t = start.state.t;
  start.state = e.state;
  start.state.t = t;
  for (Index i = 0; i < job.system().nodes(); ++i) {
    if (job.system().node(i).scalar) continue;
    start.state.q[6 * i + system::spin_phi] += q0[6 * i + system::spin_phi];
    start.state.v[6 * i + system::spin_phi] = v0[6 * i + system::spin_phi];
  }
  start.state.a.setZero();
}

/// The response that is steady is one about the rotor as the mean of its turn: not of every rotor.
/// @throws Error E26 where the motion is another.
void check_steady(const run::Job& job, const run::StepState& start) {
  constexpr const char* hint =
      "start = \"static\", and long enough for the motion to settle; or from another run that has";
  const auto refuse = [&](const std::string& why) {
    throw run_error(
        "E26", "start = \"unbalance_response\" is a steady motion that this rotor has not: " + why,
        hint);
  };
  if (results::turns_with_stiffness(job.model) || results::turns_with_inertia(job.model))
    refuse("its stiffness or inertia turns with it, and the response at one frequency is not all");
  for (const model::Shaft& s : job.model.shafts)
    if (s.bow.any() && !s.bow.constant())
      refuse(fmt::format("the thermal bow of shaft '{}' is on its way from what it is at the start",
                         s.name));
  const double theta = start_angle(job, start);
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    const Index n = job.mesh.lines[l].first_node;
    const double spin = start.state.v[6 * n + system::spin_phi];
    if (spin == 0.0 || start.speed == 0.0) continue;
    const double angle = start.state.q[6 * n + system::spin_phi];
    if (std::abs(angle - spin / start.speed * theta) > 1e-9)
      refuse(fmt::format("shaft '{}' begins at an angle of its own", job.mesh.lines[l].name));
  }
}

}  // namespace

void start_in_unbalance_response(const run::Job& job, run::StepState& start) {
  check_steady(job, start);
  analysis::Linearizer linear = linearizer_of(job, start);
  linear.at(start.speed);
  const std::vector<VecXc> f = linear.forcing();
  const std::vector<double> orders(linear.running().orders().begin(),
                                   linear.running().orders().end());
  analysis::HarmonicSolver solver(linear);
  const double theta = start_angle(job, start);
  VecX q = VecX::Zero(job.system().size()), v = q;
  for (std::size_t k = 0; k < orders.size(); ++k) {
    const double w = orders[k] * start.speed;
    VecXc a = -f[k];
    if (!solver.prepare(start.speed, w))
      throw run_error(
          "E76",
          fmt::format("no steady unbalance response at {:.6g} rpm: resonance without damping",
                      to_rpm(start.speed)),
          "start from static equilibrium, or give the model damping");
    solver.solve(a);
    const Complex turn = std::polar(1.0, orders[k] * theta);
    q += (turn * a).real();
    v += (Complex(0.0, w) * turn * a).real();
  }
  take_equilibrium(job, linear.equilibrium(), start);
  start.state.q += q;
  start.state.v += v;
}

namespace {

bool is_of(const analysis::WhirlMode& m, model::MotionKind kind) {
  using Kind = analysis::ModeKind;
  switch (kind) {
    case model::MotionKind::lateral: return m.kind == Kind::lateral;
    case model::MotionKind::torsional: return m.kind == Kind::torsional;
    case model::MotionKind::axial: return m.kind == Kind::axial;
    case model::MotionKind::all: break;
  }
  return true;
}

}  // namespace

void start_in_mode(const run::Job& job, run::StepState& start, const model::TransientStep& law) {
  analysis::Linearizer linear = linearizer_of(job, start);
  std::optional<analysis::WhirlMode> found;
  int of_kind = 0;
  std::size_t all = 0;
  // more modes until there are enough of the kind, or no more
  for (Index count = law.mode + 2; !found; count *= 2) {
    analysis::ModesOptions o;
    o.count = count;
    const std::vector<analysis::WhirlMode> modes = analysis::whirl_modes(linear, start.speed, o);
    of_kind = 0;
    all = modes.size();
    for (const analysis::WhirlMode& m : modes)
      if (is_of(m, law.mode_kind) && ++of_kind == law.mode) found = m;
    if (static_cast<Index>(modes.size()) < count || count > 2 * job.system().size()) break;
  }
  if (!found) {
    constexpr std::string_view names[] = {"", "lateral ", "torsional ", "axial "};
    throw run_error(
        "E76",
        fmt::format("the rotor has {} {}modes, not {}",
                    law.mode_kind == model::MotionKind::all ? static_cast<int>(all) : of_kind,
                    names[static_cast<int>(law.mode_kind)], law.mode),
        "choose a lower number");
  }
  take_equilibrium(job, linear.equilibrium(), start);
  start.state.q += law.mode_amplitude * found->x.real();
  start.state.v += law.mode_amplitude * (found->lambda * found->x).real();
}

namespace {

/// The motion that grows fastest about the equilibrium at a start; nothing: none does, or its modes are not
/// to be had.
std::optional<analysis::WhirlMode> fastest_growth(const run::Job& job,
                                                  const run::StepState& start) {
  try {
    analysis::Linearizer linear = linearizer_of(job, start);
    linear.start_from(start.state);
    analysis::ModesOptions o;
    o.count = 1;
    o.real_roots = true;
    o.judge = true;
    std::optional<analysis::WhirlMode> fastest;
    for (const analysis::WhirlMode& m : analysis::whirl_modes(linear, start.speed, o))
      if (m.growth() > 0 && (!fastest || m.lambda.real() > fastest->lambda.real())) fastest = m;
    return fastest;
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

void warn_of_unstable_start(run::Job& job, const model::Step& step, const run::StepState& start,
                            const analysis::Equilibrium& equilibrium) {
  analysis::SteadyRotation running = job.steady_rotation_of(start);
  running.hysteretic = false;
  analysis::SteadySystem turning(job.system(), running);
  const analysis::Definiteness d =
      results::judge_state(turning, equilibrium.state, start.speed, equilibrium.holds(), false);
  if (d.judged) {
    results::warn_of_unstable(job, step.name + ", where it begins", d, start.speed);
    return;
  }
  const auto growth = fastest_growth(job, start);
  if (!growth) return;
  Diagnostic w;
  w.code = "W13";
  const std::string motion = growth->frequency > 0
                                 ? fmt::format("a motion of {:.5g} Hz", to_hz(growth->frequency))
                                 : "a motion that does not oscillate";
  w.message = fmt::format(
      "step '{}': the equilibrium in which it begins is unstable: with its controllers {} grows by "
      "{:.3g} 1/s",
      step.name, motion, growth->lambda.real());
  w.hint = "undisturbed it may stand there for the whole run; a modal step lists what grows";
  results::warn(job, std::move(w));
}

Beginning beginning_of(const run::Job& job, const model::Step& step,
                       const model::TransientStep& law) {
  return !law.previous.empty() || job.goes_on_in_motion(step) ? Beginning::in_motion
                                                              : Beginning::settled;
}

void begin_drives(const run::Job& job, run::StepState& start, Beginning beginning) {
  std::map<std::string, run::StepState::Began> acting;
  for (const assembly::TurnCount& count : job.built.turn_counts) {
    run::StepState::Began began{start.state.t, 0.0};
    const auto before = start.drives.find(count.drive);
    const bool goes_on = !count.angle || beginning == Beginning::resumed;
    if (goes_on && before != start.drives.end())
      began = before->second;
    else if (count.angle && beginning == Beginning::settled)
      began.angle = count.angle->at(began.time).f;
    else
      began.angle = start.state.total_phi(count.node, job.system().node(count.node).line);
    count.begin(began.time, began.angle);
    acting[count.drive] = began;
  }
  for (const assembly::CoastingLine& c : job.built.coasting) {
    const system::State& now = start.state;
    run::StepState::Began began{now.t, now.total_phi(c.node, job.system().node(c.node).line)};
    const std::string key = "line " + c.line;
    if (const auto before = start.drives.find(key);
        beginning == Beginning::resumed && before != start.drives.end())
      began = before->second;
    c.begin(began.time, began.angle, now.v[6 * c.node + system::spin_phi]);
    acting[key] = began;
  }
  start.drives = std::move(acting);
}

void save_drives(OutArchive& out, const run::StepState& start) {
  out.put_count(start.drives.size());
  for (const auto& [drive, began] : start.drives) {
    out.put(drive);
    out.put(began.time);
    out.put(began.angle);
  }
}

void restore_drives(InArchive& in, run::StepState& start) {
  start.drives.clear();
  for (std::uint64_t n = in.count(); n > 0; --n) {
    const std::string drive = in.text();
    run::StepState::Began& began = start.drives[drive];
    began.time = in.number();
    began.angle = in.number();
  }
}

run::StepState start_of_other_run(run::Job& job, const model::Step& own, const std::string& folder,
                                  const std::string& step) {
  const run::Checkpoint c = run::last_state_of(folder, step);
  run::check_state_fits(c, folder, job.system(), job.model.deck_path);
  if (const std::string difference = run::other_rotor(c, job.model); !difference.empty())
    results::warn_of_step(
        job, own,
        fmt::format("the run in '{}' is one of another rotor: {}; the state it ended in is no "
                    "motion of this one",
                    folder, difference));
  run::StepState start{c.state, c.speed, {}};
  start.state.frames.hold_kept(start.state.t);
  if (const auto drives = c.parts.find({run::Part::drives}); drives != c.parts.end()) {
    InArchive in(drives->second);
    restore_drives(in, start);
  }
  return start;
}

}  // namespace whirl::steps
