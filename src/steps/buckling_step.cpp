// A buckling step: load factors at which the rotor buckles, linearised about the unloaded state,
// and what the nonlinear path says about the first.
#include <analysis/statics/buckling.hpp>
#include <run/diagnose.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <run/progress.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::steps {

namespace {

/// Relative difference of the factor and the load at which the path's tangent loses definiteness up
/// to which both say the same.
constexpr double agreement = 0.02;

/// The factor of least size that a growing load meets; NaN: none.
double first_factor(const std::vector<analysis::BucklingMode>& modes) {
  for (const analysis::BucklingMode& m : modes)
    if (m.factor.real() > 0 && m.factor.imag() == 0.0) return m.factor.real();
  return nan;
}

/// "8.41", "-24.95 +- 16.75i"
std::string text_of(Complex factor) {
  return factor.imag() == 0.0
             ? fmt::format("{:.6g}", factor.real())
             : fmt::format("{:.6g} +- {:.6g}i", factor.real(), std::abs(factor.imag()));
}

std::string describe(const analysis::PathCheck& p) {
  if (p.found)
    return fmt::format(
        "on the path of equilibria stability is lost at load factor {:.6g}, at a {} point", p.load,
        p.limit ? "limit" : "bifurcation");
  if (!p.ended.empty()) return "the path of equilibria " + p.ended;
  return fmt::format("on the path of equilibria stability is not lost up to load factor {:.6g}",
                     p.load);
}

/// Warns when the linearisation and the path do not agree: the rotor is deformed too much before it
/// buckles.
void compare(results::FrequencyStep& s, double factor, const analysis::BucklingMode& mode,
             const analysis::PathCheck& p) {
  io::Value& v = s.summary()["on the path"];
  v["stability is lost"] = p.found;
  v[p.found ? "load factor" : "stable up to load factor"] = p.load;
  if (p.found) v["at"] = p.limit ? "limit point" : "bifurcation point";
  if (!p.ended.empty()) v["end"] = p.ended;
  const bool agrees = p.found && std::abs(p.load - factor) <= agreement * std::abs(factor);
  v["agrees with the first factor"] = agrees;
  s.section.text += fmt::format(
      "\n\nBefore it buckles at the first factor the rotor turns by {:.3g} rad and moves by {:.3g} "
      "of its size; {}.",
      mode.rotation, mode.displacement, describe(p));
  if (agrees) return;
  Diagnostic d;
  d.severity = Diagnostic::Severity::warning;
  d.code = "W09";
  d.message = fmt::format(
      "step '{}': the state before buckling is not small, or not symmetric: load factor {:.6g} of "
      "the linearised analysis (rotations up to {:.3g} rad there), but {}",
      s.step.name, factor, mode.rotation, describe(p));
  d.hint = "a static step with 'path' follows the equilibria; believe the path";
  s.job.report.warnings.push_back(d.message);
  s.job.summary["warnings"].push(d.code + ": " + d.message);
  if (!s.job.options.quiet) run::print_diagnostics({d});
}

/// W09 where the model has buckled before any load acts.
std::string say_unstable(results::FrequencyStep& s, const analysis::BucklingCount& c) {
  if (c.unstable == 0) return "";
  const std::string text = fmt::format(
      "without its loads the model is unstable already, in {} direction{}{}: it has buckled",
      c.unstable, c.unstable == 1 ? "" : "s", c.unstable_certain ? "" : " (counted, not proved)");
  s.summary()["unstable directions without loads"] = static_cast<int>(c.unstable);
  s.section.text += " " + results::capital(text) + ".";
  Diagnostic d;
  d.code = "W09";
  d.message = fmt::format("step '{}': {}", s.step.name, text);
  d.hint =
      "factors on the loads do not say when it buckles; what is built in does (temperature, "
      "preload, forced places of supports): a static step shows the direction";
  results::warn(s.job, std::move(d));
  return "; " + text;
}

/// What is known of the completeness of the list, everywhere; W07 where factors are missing.
std::string certify(results::FrequencyStep& s, const analysis::BucklingCount& c) {
  std::string text =
      c.counted ? fmt::format(
                      "{} load factors of size below {:.6g} ({} positive, {} negative), counted by "
                      "inertia",
                      c.missing == 0 ? "complete: all" : "INCOMPLETE: not all", c.up_to, c.positive,
                      c.negative)
                : fmt::format("completeness not certified: {}", c.why_not);
  if (c.counted && c.missing != 0) text += fmt::format("; {} not in the list", c.missing);
  io::Value& v = s.summary()["certificate"];
  v["complete"] = c.complete();
  v["text"] = text;
  if (c.counted) {
    v["size up to"] = c.up_to;
    v["positive factors"] = static_cast<int>(c.positive);
    v["negative factors"] = static_cast<int>(c.negative);
    v["factors not found"] = static_cast<int>(c.missing);
  }
  s.section.text += " " + results::capital(text) + ".";
  if (c.complete() || !c.counted) return text;
  Diagnostic d;
  d.code = "W07";
  d.message = fmt::format("step '{}': {}", s.step.name, text);
  d.hint = "ask for more or fewer modes; the list is not to be relied on as it is";
  s.job.uncertified.push_back(d.message);
  results::warn(s.job, std::move(d));
  return text;
}

}  // namespace

void run_buckling_step(run::Job& job, const model::Step& step, const model::BucklingStep& law) {
  results::FrequencyStep s(job, step, "buckling", "buckling", std::abs(law.speed));
  const run::PhaseTimer timer(job, "buckling");
  analysis::EquilibriumOptions options;
  options.chart_change = job.model.chart_change;
  const auto [modes, count, unloaded] =
      analysis::buckling(s.linear.running(), law.speed, law.modes, options);
  s.linear.set_equilibrium(unloaded);  // the shapes are drawn about it
  io::Table table;
  table.title = "Buckling";
  table.columns = {
      {"mode", "-", ""},
      {"load factor", "-", "negative: with all loads reversed"},
      {"imaginary part", "-", "not zero: flutter"},
      {"rotation before", "rad", "largest tilt or twist of the linear response at this load"},
      {"displacement before", "-", "its largest displacement over the size of the model"},
      {"on the path", "-",
       "of the first factor: where the path of equilibria loses its stability"}};
  const double first = first_factor(modes);
  std::optional<analysis::PathCheck> path;
  if (!std::isnan(first))
    path = analysis::check_on_path(s.linear.running(), law.speed, first, options);
  io::Value& v = s.summary();
  v["speed [rpm]"] = to_rpm(law.speed);
  for (std::size_t k = 0; k < modes.size(); ++k) {
    const analysis::BucklingMode& m = modes[k];
    const bool checked = path && path->found && m.factor == Complex(first);
    table.add({static_cast<int>(k + 1), m.factor.real(), m.factor.imag(), m.rotation,
               m.displacement, checked ? io::Table::Cell(path->load) : io::Table::Cell("")});
    v["load factors"].push(m.factor.real());
    v["imaginary parts of load factors"].push(m.factor.imag());
    v["rotations before buckling [rad]"].push(m.rotation);
    v["displacements before buckling [-]"].push(m.displacement);
    const std::string name = fmt::format("buckling_{}", k + 1);
    results::add_shape_figures(
        s, {name,
            fmt::format("Buckling shape {}: load factor {}", k + 1, text_of(m.factor)),
            {},
            &m.x,
            analysis::ModeKind::lateral});
    results::write_shape_frames(s, name, m.x);
  }
  s.add_table("buckling", std::move(table));
  s.section.text =
      "Factors on gravity and all loads at which the stiffness of the rotor vanishes, from its "
      "derivative with the loads at the unloaded state.";
  const std::string unstable = say_unstable(s, count);
  const std::string known = certify(s, count);
  const auto is_real = [](const analysis::BucklingMode& m) { return m.factor.imag() == 0.0; };
  std::string line = "no buckling load";
  if (!std::isnan(first))
    line = fmt::format("smallest load factor {:.6g}", first);
  else if (!modes.empty() && is_real(modes.front()))
    line =
        fmt::format("no buckling load; with all loads reversed {}", text_of(-modes.front().factor));
  else if (!modes.empty())
    line = fmt::format(
        "no buckling load among {} factors (the first, {}, is complex: the loads follow the "
        "motion, "
        "and what they may cause is growing whirl)",
        modes.size(), text_of(modes.front().factor));
  if (path) {
    const auto of_first = [&](const analysis::BucklingMode& m) {
      return m.factor == Complex(first);
    };
    compare(s, first, *std::find_if(modes.begin(), modes.end(), of_first), *path);
    line += "; " + describe(*path);
  }
  s.finish(line + unstable + "; " + known);
}

}  // namespace whirl::steps
