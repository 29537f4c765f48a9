#include <steps/accuracy.hpp>

#include <analysis/spectra/whirl_modes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

/// Modes the motion can contain at the end of the run: up to twice the largest spin, and the four
/// lowest in any case.
std::vector<analysis::WhirlMode> modes_that_matter(run::Job& job, const AccuracyInputs& in) {
  analysis::SteadyRotation running;
  for (std::size_t l = 0; l < job.mesh.lines.size(); ++l) {
    const Index n = job.mesh.lines[l].first_node;
    const double spin = in.result.end.v[6 * n + system::spin_phi];
    running.ratio.push_back(!job.model.shafts[l].rotating ? 0.0
                            : in.speed != 0.0             ? spin / in.speed
                                                          : job.model.shafts[l].speed_ratio);
  }
  running.ratio.resize(static_cast<std::size_t>(job.system().lines()), 0.0);
  running.time = in.result.end.t;
  analysis::EquilibriumOptions o;
  o.chart_change = job.model.chart_change;
  analysis::Linearizer linear(job.system(), running, o);
  analysis::ModesOptions options;
  options.count = 8;
  std::vector<analysis::WhirlMode> modes = analysis::whirl_modes(linear, in.speed, options), out;
  for (analysis::WhirlMode& m : modes)
    if (m.frequency > 0.0 && (out.size() < 4 || m.frequency <= 2.0 * in.steps.largest_spin()))
      out.push_back(std::move(m));
  return out;
}

}  // namespace

std::vector<std::string> state_accuracy(run::Job& job, const AccuracyInputs& in, io::Value& v,
                                        io::ReportSection& section) {
  std::vector<std::string> warnings;
  const model::IntegratorOptions& scheme = in.law.integrator;
  const time::Statistics& s = in.result.statistics;
  // a motion that turns over next to nothing (a steady whirl without damping) is measured by the
  // energy it has
  const bool exchanges = in.energy.exchanged() > in.energy.worst_defect();
  const double turned = exchanges ? in.energy.exchanged() : in.energy.largest_energy();
  const double defect = turned > 0.0 ? in.energy.worst_defect() / turned : 0.0;
  const char* measure = exchanges ? "turned over" : "of the motion, which turns over none";
  v["aimed at, of the peak response"] = scheme.tolerance;
  v["energy defect / energy turned over"] = defect;
  v["local error / allowance, mean"] = s.error_mean();
  v["local error / allowance, max"] = s.error_max;
  section.text += fmt::format(
      "\n\nAccuracy: aimed at {:.2g} of the peak response with {:.3f} s CPU; local errors {:.2g} "
      "of what they may be on average, {:.2g} at most. The energy balance "
      "(stored - supplied + dissipated) is off by {:.2g} J at most, {:.2g} of the energy {}.",
      scheme.tolerance, in.result.seconds, s.error_mean(), s.error_max, in.energy.worst_defect(),
      defect, measure);
  // an amplitude error of a percent is an energy error of two
  if (!in.energy.known())
    warnings.push_back(
        "the motion leaves the range in which the energies of its supports are defined (a film's "
        "clearance, a table): its energy balance is not known");
  else if (defect > 0.02 && in.energy.worst_defect() > in.energy.rounding())
    warnings.push_back(
        fmt::format("the energy balance is off by {:.2g} of the energy {}: do not trust the "
                    "amplitudes; try a smaller tolerance",
                    defect, measure));
  if (scheme.dt > 0.0 && s.error_max > 1.0)
    warnings.push_back(
        fmt::format("the fixed step is too long for the accuracy asked for: local errors up to "
                    "{:.2g} times the allowance for {:.2g} of the peak",
                    s.error_max, scheme.tolerance));
  if (const double all = static_cast<double>(s.accepted + s.rejected_error + s.rejected_newton);
      s.accepted > 100 && static_cast<double>(s.accepted) < 0.7 * all)
    warnings.push_back(fmt::format(
        "{:.0f} % of the steps were rejected: the model is not smooth at the scale of the steps",
        100.0 * (1.0 - static_cast<double>(s.accepted) / all)));

  if (!std::isfinite(
          analysis::numerical_decay(scheme.method, scheme.rho_inf, Complex(0, 1), 1e-3)) ||
      in.result.reason == analysis::StopReason::failed)
    return warnings;
  std::vector<analysis::WhirlMode> modes;
  try {
    modes = modes_that_matter(job, in);
  } catch (const Error& e) {
    v["modes"] = std::string("not found at the end of the run: ") + e.what();
    return warnings;
  }
  io::Table t;
  t.title = fmt::format("Damping of the modes at {:.0f} rpm: physical, and what the steps add",
                        to_rpm(in.speed));
  t.columns = {
      {"frequency", "Hz", ""},
      {"motion", "-", ""},
      {"physical damping ratio", "-", ""},
      {"numerical damping ratio", "-", "mean over the half of the run with the shortest steps"},
      {"amplitude lost to it over the run", "-", ""}};
  for (const analysis::WhirlMode& m : modes) {
    // the mode's own damping is left out where it would not last: of a growing or heavily damped
    // mode only the frequency counts
    const double physical = m.damping_ratio,
                 decay =
                     in.steps.mean_decay(scheme.method, scheme.rho_inf, Complex(0.0, m.frequency));
    const double numerical = decay / m.frequency,
                 lost = 1.0 - std::exp(-std::max(decay, 0.0) * in.steps.seconds());
    io::Value q;
    q["frequency [Hz]"] = m.frequency / two_pi;
    q["physical damping ratio"] = physical;
    q["numerical damping ratio"] = numerical;
    v["modes"].push(q);
    const std::string motion = m.kind == analysis::ModeKind::lateral
                                   ? fmt::format("lateral, {}", analysis::to_string(m.direction))
                                   : std::string(analysis::to_string(m.kind));
    t.add({m.frequency / two_pi, motion, physical, numerical, lost});
    // it matters when it is not small against the physical one, and has the time to show
    if (numerical > 0.1 * std::abs(physical) && lost > 0.01 &&
        m.frequency <= 1.2 * in.steps.largest_spin())
      warnings.push_back(fmt::format(
          "numerical damping of the mode at {:.4g} Hz (ratio {:.2g}) is not small against its "
          "physical damping ({:.2g}): try a smaller tolerance, or method = \"gauss6\"",
          m.frequency / two_pi, numerical, physical));
  }
  if (!t.rows.empty()) section.tables.push_back(std::move(t));
  return warnings;
}

}  // namespace whirl::steps
