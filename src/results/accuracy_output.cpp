// What a transient says about its own accuracy: energy balance, largest tilt, local errors,
// numerical against physical damping, warnings.
#include <analysis/spectra/whirl_modes.hpp>
#include <analysis/study/scheme_damping.hpp>
#include <assembly/element_section.hpp>
#include <core/messages.hpp>
#include <core/rotation.hpp>
#include <la/block_lu.hpp>
#include <results/frequency.hpp>
#include <results/mesh_accuracy.hpp>
#include <results/transient_output.hpp>
#include <run/progress.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::results {

namespace {

/// Of a mesh element, N m/rad.
double torsional_stiffness(const model::Model& m, const meshes::Element& e) {
  const model::Section& section = m.shafts[at(e.line)].sections[e.section];
  if (section.general) return m.materials[section.material].G * section.general->J / (e.s2 - e.s1);
  return assembly::element_constants(m, e).GJ_l;
}

/// Nodes whose angle a drive prescribes.
std::vector<analysis::EnergyBalance::Driven> driven_nodes(const run::Job& job) {
  std::vector<analysis::EnergyBalance::Driven> driven;
  for (const assembly::TurnCount& count : job.built.turn_counts) {
    if (!count.angle) continue;
    double stiffness = 0;
    for (const meshes::Element& e : job.mesh.elements)
      if (e.left.node == count.node || e.right.node == count.node)
        stiffness += torsional_stiffness(job.model, e);
    driven.push_back({count.node, stiffness});
  }
  return driven;
}

class EnergyOutput final : public TransientOutput {
 public:
  explicit EnergyOutput(const TransientSetup& s)
      : balance_(s.integration.breakpoints, driven_nodes(s.job)) {}
  const analysis::EnergyBalance& balance() const { return balance_; }

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&balance_);
    parts.add({run::Part::energy}, balance_);
  }

  void summarize(TransientEnd& end) override {
    io::Value& v = end.summary["energy"];
    v["stored at start [J]"] = balance_.stored0();
    v["stored at end [J]"] = balance_.stored();
    v["supplied [J]"] = balance_.supplied();
    v["dissipated [J]"] = balance_.dissipated();
    v["defect [J]"] = balance_.defect();
    v["largest defect [J]"] = balance_.worst_defect();
  }

  std::string headline() const override {
    return fmt::format("energy defect {:.2e} J", balance_.worst_defect());
  }

 private:
  analysis::EnergyBalance balance_;
};

class TiltOutput final : public TransientOutput {
 public:
  const analysis::TiltWatch& tilt() const { return tilt_; }

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&tilt_);
    parts.add({run::Part::tilt}, tilt_);
  }

  void summarize(TransientEnd& end) override {
    io::Value& v = end.summary["largest tilt"];
    v["|gamma| [rad]"] = tilt_.tilt();
    v["time [s]"] = tilt_.time();
    v["node"] = end.job.system().node(tilt_.node()).name;
    v["condition of (phi', gamma') -> omega"] = rotation::chart_condition(tilt_.tilt());
  }

 private:
  analysis::TiltWatch tilt_;
};

/// A mode that the motion can contain, and the relative error of its frequency on the mesh.
struct Contained {
  analysis::WhirlMode mode;
  double mesh_error = nan;  ///< of those that judge_mesh looks at
};
constexpr Index lowest_modes = 4;  ///< listed however fast they are
/// Modes up to this multiple of the largest spin are listed, and their mesh is looked at up to the
/// other one (model::resolution_of).
constexpr double beside_the_spin = 2.0, judged_mesh = 1.5;

/// Something may drive free motions: supports whose stiffness is not symmetric, a controller.
bool may_grow(const system::System& system, const la::MCK& m) {
  for (Index i = 0; i < system.nodes(); ++i)
    if (system.node(i).signal) return true;
  constexpr double rounding = 1e-9;
  const la::BlockPattern& p = system.pattern();
  for (Index i = 0; i < p.size(); ++i) {
    const Matrix<6> K = m.K.block(p.diagonal(i));
    // angles turned by moments have a skew part in any equilibrium
    const Mat2 lateral = K.block<2, 2>(system::uy, system::uy);
    if (std::abs(lateral(0, 1) - lateral(1, 0)) > rounding * lateral.cwiseAbs().maxCoeff())
      return true;
  }
  return false;
}

/// Modes slower than a frequency, as far as the inertia of stiffness and mass alone tells; most where
/// it tells nothing.
Index modes_below(const system::System& system, const la::MCK& conservative, double frequency,
                  Index most) {
  la::BlockLu<double> shifted(system.pattern(), system.active());
  if (shifted.factor(conservative, -frequency * frequency, 0.0, 1.0) != la::Status::ok) return most;
  return std::min(shifted.negative_eigenvalues(), most);
}

/// The rotation at the end of the run, `speed` that of the reference.
analysis::SteadyRotation rotation_at(const TransientEnd& end, const assembly::Built& built,
                                     double speed) {
  const run::Job& job = end.job;
  const system::State& state = end.result.end;
  analysis::SteadyRotation running;
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    const Index n = job.mesh.lines[l].first_node;
    const double spin = state.v[6 * n + system::spin_phi];
    running.ratio.push_back(!job.model.shafts[l].rotating ? 0.0
                            : speed != 0.0                ? spin / speed
                                                          : job.model.shafts[l].speed_ratio);
  }
  running.ratio.resize(at(built.system.lines()), 0.0);
  running.axially_free = built.axially_free;
  for (const assembly::MagneticControl& c : built.magnetic_controls)
    running.control_bandwidth = std::max(running.control_bandwidth, c.bandwidth);
  running.time = state.t;
  running.hysteretic = false;  // a motion in time has its stand-in
  return running;
}

/// These are all up to a frequency, and as many that move as are listed in any case.
bool enough(const std::vector<analysis::WhirlMode>& modes, Index asked, double highest) {
  if (static_cast<Index>(modes.size()) < asked || modes.back().frequency <= highest) return false;
  const auto moving =
      std::count_if(modes.begin(), modes.end(), [](const auto& m) { return m.frequency > 0.0; });
  return moving >= lowest_modes;
}

/// The lowest modes: all up to a frequency, of twice as many as are listed in any case. Where nothing
/// drives free motions but the rotation, what is faster need not be found, but for the one that shows
/// that there is none between: half of them take half the time.
std::vector<analysis::WhirlMode> slow_modes(analysis::Linearizer& linear, double speed,
                                            double highest) {
  constexpr Index most = 2 * lowest_modes;
  analysis::ModesOptions options;
  options.judge = may_grow(linear.system(), linear.at(speed));
  options.count = most;
  options.guard = 0;
  if (!options.judge) {
    const la::MCK& conservative = linear.conservative_at(speed);
    const Index below = modes_below(linear.system(), conservative, highest, most);
    options.count = std::min(std::max(lowest_modes, below + 1), most);
  }
  std::vector<analysis::WhirlMode> modes = analysis::whirl_modes(linear, speed, options);
  if (options.count == most || enough(modes, options.count, highest)) return modes;
  options.count = most;
  return analysis::whirl_modes(linear, speed, options);
}

struct ContainedModes {
  std::vector<Contained> modes;
  std::vector<std::string> left_out;  ///< shafts whose elements are not judged
};

bool follows_oil(const TransientEnd& end) { return !end.job.built.carried_oil.empty(); }
constexpr const char* films_of_modes = "of the momentary state, as in linear steps";

/// The system without the oil that a run has followed: its cells have motions of their own, hundreds as
/// slow as the rotor's, which die away within a turn. None: none was followed.
std::optional<assembly::Built> with_momentary_films(const TransientEnd& end) {
  const run::Job& job = end.job;
  if (!follows_oil(end)) return std::nullopt;
  return assembly::build_system(job.model, job.mesh, end.step.name, assembly::FilmOil::momentary);
}

/// Modes the motion can contain at the end of the run: up to twice the largest spin, the four
/// lowest in any case, and what grows. near: the equilibrium is sought from there; null: from the
/// reference configuration.
ContainedModes modes_that_matter(const TransientEnd& end, double speed, double largest_spin,
                                 const system::State* near) {
  const run::Job& job = end.job;
  const std::optional<assembly::Built> momentary = with_momentary_films(end);
  const assembly::Built& built = momentary ? *momentary : job.built;
  analysis::SteadyRotation running = rotation_at(end, built, speed);
  std::vector<double> spin;
  double fastest = largest_spin;
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    spin.push_back(speed * running.ratio[l]);
    fastest = std::max(fastest, std::abs(spin.back()));
  }
  analysis::EquilibriumOptions o;
  o.chart_change = job.model.chart_change;
  analysis::Linearizer linear(built.system, std::move(running), o);
  if (near) linear.start_from(*near);
  std::vector<analysis::WhirlMode> modes = slow_modes(linear, speed, beside_the_spin * fastest);
  const assembly::MeshError mesh(job.model, job.mesh, built);
  ContainedModes contained{{}, mesh.left_out()};
  std::vector<Contained>& out = contained.modes;
  for (analysis::WhirlMode& m : modes) {
    const bool beyond = static_cast<Index>(out.size()) >= lowest_modes &&
                        m.frequency > beside_the_spin * largest_spin;
    if (!(m.frequency > 0.0) || (beyond && m.growth() <= 0)) continue;
    const bool looked_at = out.empty() || m.frequency <= judged_mesh * largest_spin;
    const bool judged = looked_at && (!mesh.empty() || mesh.left_out().empty());
    const double error = judged ? relative_mesh_error(mesh, linear.at(speed), m, spin) : nan;
    out.push_back({std::move(m), error});
  }
  return contained;
}

class AccuracyOutput final : public TransientOutput {
 public:
  AccuracyOutput(const TransientSetup& s, const analysis::EnergyBalance& energy,
                 const analysis::TiltWatch& tilt)
      : energy_(energy),
        tilt_(tilt),
        begun_(s.law.linear && !s.resumed ? &s.start.state : nullptr),
        steps_(s.job.reference()) {}

  void attach(std::vector<analysis::Observer*>& observers, run::Parts& parts) override {
    observers.push_back(&steps_);
    parts.add({run::Part::step_lengths}, steps_);
  }

  void summarize(TransientEnd& end) override {
    {
      const run::PhaseTimer timer(end.job, "accuracy");
      std::vector<std::string> warnings;
      judge_energy(end, warnings);
      judge_steps(end, warnings);
      judge_twist(end, warnings);
      judge_modes(end, warnings);
      // both planes of a round rotor have the same to say
      warnings.erase(std::unique(warnings.begin(), warnings.end()), warnings.end());
      for (const std::string& w : warnings)
        warn_of_step(end.job, end.step, w);
    }
    warn_of_second_order(end);
  }

 private:
  void judge_energy(TransientEnd& end, std::vector<std::string>& warnings) const;
  void judge_steps(const TransientEnd& end, std::vector<std::string>& warnings) const;
  void judge_twist(TransientEnd& end, std::vector<std::string>& warnings) const;
  void judge_modes(TransientEnd& end, std::vector<std::string>& warnings) const;
  void judge_mesh(TransientEnd& end, const ContainedModes& contained) const;
  void judge_damping(TransientEnd& end, const std::vector<Contained>& modes, double speed,
                     std::vector<std::string>& warnings) const;
  void add_damping_row(TransientEnd& end, const analysis::WhirlMode& m, io::Table& t,
                       std::vector<std::string>& warnings) const;
  void warn_of_second_order(TransientEnd& end) const;

  const analysis::EnergyBalance& energy_;
  const analysis::TiltWatch& tilt_;
  const system::State* begun_;  ///< near the equilibrium that small motions are about, or null
  analysis::StepHistogram steps_;
};

/// How far the energy balance is off, of the energy turned over.
void AccuracyOutput::judge_energy(TransientEnd& end, std::vector<std::string>& warnings) const {
  const double tolerance = end.law.integrator.tolerance;
  const time::Statistics& s = end.result.statistics;
  // a motion that turns over next to nothing (a steady whirl without damping) is measured by the
  // energy it has
  const bool exchanges = energy_.exchanged() > energy_.worst_defect();
  const double turned = exchanges ? energy_.exchanged() : energy_.largest_energy();
  const double defect = turned > 0.0 ? energy_.worst_defect() / turned : 0.0;
  const char* measure = exchanges ? "turned over" : "of the motion, which turns over none";
  io::Value& v = end.summary["accuracy"];
  v["aimed at, of the peak response"] = tolerance;
  v["energy defect / energy turned over"] = defect;
  v["local error / allowance, mean"] = s.error_mean();
  v["local error / allowance, max"] = s.error_max;
  end.section.text += fmt::format(
      "\n\nAccuracy: aimed at {:.2g} of the peak response with {:.3f} s CPU; local errors {:.2g} "
      "of what they may be on average, {:.2g} at most. The energy balance "
      "(stored - supplied + dissipated) is off by {:.2g} J at most, {:.2g} of the energy {}.",
      tolerance, end.result.seconds, s.error_mean(), s.error_max, energy_.worst_defect(), defect,
      measure);
  // an amplitude error of a percent is an energy error of two
  constexpr double doubtful = 0.02;
  // 4e-21 J: the thermal energy of one motion. Less is rounding of a rotor at rest
  const double nothing = std::max(energy_.rounding(), 4e-21);
  const bool rounding = energy_.worst_defect() <= nothing;
  if (energy_.known() && defect > doubtful && rounding)
    end.section.text += fmt::format(
        " Rounding of the energies and of the drives' torques alone may reach {:.2g} J: here the "
        "balance says nothing of the amplitudes.",
        nothing);
  if (!energy_.known())
    warnings.push_back(
        "the motion leaves the range in which the energies of its supports are defined (a film's "
        "clearance, a table): its energy balance is not known");
  else if (defect > doubtful && !rounding)
    warnings.push_back(fmt::format(
        "the energy balance is off by {:.2g} of the energy {} ({:.1g} of all energy): do not trust "
        "the amplitudes of vibration; try a smaller tolerance",
        defect, measure, energy_.worst_defect() / energy_.largest_energy()));
}

/// Steps that are too long for the accuracy asked for, or rejected again and again.
void AccuracyOutput::judge_steps(const TransientEnd& end,
                                 std::vector<std::string>& warnings) const {
  const model::IntegratorOptions& scheme = end.law.integrator;
  const time::Statistics& s = end.result.statistics;
  if (scheme.dt > 0.0 && s.error_max > 1.0)
    warnings.push_back(
        fmt::format("the fixed step is too long for the accuracy asked for: local errors up to "
                    "{:.2g} times the allowance for {:.2g} of the peak",
                    s.error_max, scheme.tolerance));
  const double accepted = static_cast<double>(s.accepted);
  const double all = static_cast<double>(s.accepted + s.rejected_error + s.rejected_newton);
  if (s.accepted > 100 && accepted < 0.7 * all)
    warnings.push_back(fmt::format(
        "{:.0f} % of the steps were rejected: the model is not smooth at the scale of the steps",
        100.0 * (1.0 - accepted / all)));
}

/// Vibration of twist that the steps pass over: they are chosen for it only where it is asked for.
void AccuracyOutput::judge_twist(TransientEnd& end, std::vector<std::string>& warnings) const {
  const time::Statistics& s = end.result.statistics;
  const double tolerance = end.law.integrator.tolerance;
  // local errors grow with a power of the step, their sum with one more
  constexpr double followed = 3e-3;
  if (!(s.twist_error * tolerance > followed)) return;
  end.summary["accuracy"]["twist, half its range [rad]"] = s.twist;
  end.summary["accuracy"]["local error of twist / allowance"] = s.twist_error;
  const std::string said = fmt::format(
      "the steps do not follow the vibration of twist (half its range is {:.2g} rad; local errors "
      "up "
      "to {:.2g} times the allowance for {:.2g} of that)",
      s.twist, s.twist_error, tolerance);
  const std::string cure = end.law.integrator.dt > 0.0
                               ? "try a smaller dt"
                               : "a table 'torques' in the step makes them follow it";
  // beside lateral motion, where nothing asks for torques, steps that pass over it are what is wanted
  if (s.twists_alone) return warnings.push_back(said + ", and nothing else moves: " + cure);
  const std::string note =
      fmt::format("{}: speeds and torques along shafts are without it; {}", said, cure);
  end.section.text += fmt::format("\n\nNote: {}.", note);
  if (!end.job.options.quiet) say(fmt::format("  {}: note: {}\n", end.step.name, note));
}

/// What the mesh and the steps do to the modes at the end of the run.
void AccuracyOutput::judge_modes(TransientEnd& end, std::vector<std::string>& warnings) const {
  if (end.result.reason == analysis::StopReason::failed) return;
  const double speed = end.result.end.v[6 * end.job.reference() + system::spin_phi];
  ContainedModes contained;
  try {
    contained = modes_that_matter(end, speed, steps_.largest_spin(), begun_);
  } catch (const Error& e) {
    end.summary["accuracy"]["modes"] = std::string("not found at the end of the run: ") + e.what();
    return;
  }
  if (follows_oil(end)) end.summary["accuracy"]["films in the modes"] = films_of_modes;
  judge_mesh(end, contained);
  judge_damping(end, contained.modes, speed, warnings);
}

/// Of the modes whose mesh is looked at: the lowest one in any case.
void AccuracyOutput::judge_mesh(TransientEnd& end, const ContainedModes& contained) const {
  const std::vector<Contained>& modes = contained.modes;
  std::vector<analysis::WhirlMode> listed;
  listed.reserve(modes.size());
  for (const Contained& c : modes)
    listed.push_back(c.mode);
  const std::vector<std::string> labels = labels_of(listed);
  double largest = 0;
  std::string worst;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (!(modes[k].mesh_error >= largest)) continue;
    largest = modes[k].mesh_error;
    worst = labels[k];
  }
  for (const std::string& shaft : contained.left_out)
    end.summary["mesh"]["not judged"].push("shaft '" + shaft + "'");
  if (worst.empty()) return;
  io::Value& v = end.summary["mesh"];
  v["elements"] = end.job.mesh.elements.size();
  v["relative error of frequencies"] = largest;
  v["largest at"] = worst;
  end.section.text += fmt::format(
      "\n\nOn its elements the rotor has the frequencies up to {} times its fastest spin right to "
      "{}.",
      judged_mesh, error_text(largest));
  if (largest > end.job.model.mesh_accuracy)
    warn_of_coarse_mesh(end.job, end.step.name,
                        fmt::format("the frequency of {} is off by about {}, {} wanted", worst,
                                    error_text(largest), error_text(end.job.model.mesh_accuracy)));
}

/// The damping that the steps add.
void AccuracyOutput::judge_damping(TransientEnd& end, const std::vector<Contained>& modes,
                                   double speed, std::vector<std::string>& warnings) const {
  const model::IntegratorOptions& scheme = end.law.integrator;
  const bool unknown =
      !std::isfinite(analysis::numerical_decay(scheme.method, scheme.rho_inf, Complex(0, 1), 1e-3));
  if (unknown) return;
  io::Table t;
  const long rpm = std::lround(to_rpm(speed));  // a rotor that has stopped: no "-0"
  t.title = fmt::format("Damping of the modes at {} rpm: physical, and what the steps add", rpm);
  t.columns = {
      {"frequency", "Hz", ""},
      {"motion", "-", ""},
      {"physical damping ratio", "-", follows_oil(end) ? films_of_modes : ""},
      {"numerical damping ratio", "-", "mean over the half of the run with the shortest steps"},
      {"amplitude lost to it over the run", "-", ""}};
  for (const Contained& c : modes)
    add_damping_row(end, c.mode, t, warnings);
  if (!t.rows.empty()) end.section.tables.push_back(std::move(t));
}

void AccuracyOutput::add_damping_row(TransientEnd& end, const analysis::WhirlMode& m, io::Table& t,
                                     std::vector<std::string>& warnings) const {
  const model::IntegratorOptions& scheme = end.law.integrator;
  // the mode's own damping is left out where it would not last: of a growing or heavily damped
  // mode only the frequency counts
  const double decay = steps_.mean_decay(scheme.method, scheme.rho_inf, Complex(0.0, m.frequency));
  const double physical = tidy(m.damping_ratio), numerical = decay / m.frequency;
  constexpr double resolved = 0.5;  // rad a step
  const double lost = 1.0 - std::exp(-std::max(decay, 0.0) * steps_.seconds());
  io::Value q;
  q["frequency [Hz]"] = to_hz(m.frequency);
  q["physical damping ratio"] = physical;
  q["numerical damping ratio"] = numerical;
  end.summary["accuracy"]["modes"].push(q);
  const std::string motion = m.kind == analysis::ModeKind::lateral
                                 ? fmt::format("lateral, {}", analysis::to_string(m.direction))
                                 : std::string(analysis::to_string(m.kind));
  t.add({to_hz(m.frequency), motion, physical, numerical, lost});
  if (const double growth = m.lambda.real();
      m.growth() > 0 && decay > growth && growth * steps_.seconds() > 1.0)
    warnings.push_back(
        fmt::format("a motion at {:.4g} Hz grows by {:.3g} 1/s about the rotor's equilibrium at "
                    "the end, and the "
                    "steps, which do not resolve it, damp it by {:.3g} 1/s: the rotor is unstable "
                    "though the run "
                    "does not show it; try dt_max = \"{:.2g} ms\"",
                    to_hz(m.frequency), growth, decay, 1e3 * resolved / m.frequency));
  // it matters when it is not small against the physical one, and has the time to show
  if (numerical > 0.1 * std::abs(physical) && lost > 0.01 &&
      m.frequency <= 1.2 * steps_.largest_spin())
    warnings.push_back(fmt::format(
        "numerical damping of the mode at {:.4g} Hz (ratio {:.2g}) is not small against its "
        "physical damping ({:.2g}): try a smaller tolerance, or method = \"gauss6\"",
        to_hz(m.frequency), numerical, physical));
}

/// Small motions leave out the square of the tilt.
void AccuracyOutput::warn_of_second_order(TransientEnd& end) const {
  const double tilt = tilt_.tilt();
  if (!end.law.linear || tilt * tilt <= 0.01) return;
  warn_of_step(end.job, end.step,
               fmt::format("linear = true, but {} tilts by {:.2g} rad: the terms left out are "
                           "{:.2g} of those kept",
                           end.job.system().node(tilt_.node()).name, tilt, tilt * tilt));
}

}  // namespace

void add_energy(const TransientSetup& setup, TransientOutputs& outputs) {
  outputs.push_back(std::make_unique<EnergyOutput>(setup));
}

void add_tilt(const TransientSetup&, TransientOutputs& outputs) {
  outputs.push_back(std::make_unique<TiltOutput>());
}

void add_accuracy(const TransientSetup& setup, TransientOutputs& outputs) {
  const auto& energy = find_output<EnergyOutput>(outputs).balance();
  const auto& tilt = find_output<TiltOutput>(outputs).tilt();
  outputs.push_back(std::make_unique<AccuracyOutput>(setup, energy, tilt));
}

}  // namespace whirl::results
