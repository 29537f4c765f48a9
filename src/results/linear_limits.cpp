#include <results/linear_limits.hpp>
#include <results/clearances.hpp>
#include <analysis/spectra/periodic.hpp>
#include <assembly/film_kernels.hpp>
#include <run/diagnose.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::results {

void warn(run::Job& job, Diagnostic d) {
  d.severity = Diagnostic::Severity::warning;
  job.report.warnings.push_back(d.message);
  job.summary["warnings"].push(d.code + ": " + d.message);
  if (!job.options.quiet) run::print_diagnostics({d});
}

namespace {

/// What grows at a speed, or "".
std::string growth_at(analysis::WhirlSolver& solver, double Omega) {
  const std::vector<analysis::WhirlMode>& modes = solver.solve(Omega);
  const auto fastest = std::max_element(
      modes.begin(), modes.end(), [](const analysis::WhirlMode& a, const analysis::WhirlMode& b) {
        return a.lambda.real() < b.lambda.real();
      });
  if (fastest == modes.end() || fastest->growth() <= 0) return {};
  return fmt::format("{} motion at {:.4g} Hz grows by {:.3g} 1/s", to_string(fastest->kind),
                     to_hz(fastest->frequency), fastest->lambda.real());
}

/// In axes that turn with it the rotor has lost stiffness in an odd number of directions: it bends
/// out at its own speed.
std::string growth_at(analysis::RotatingAxes& axes, double Omega) {
  if (Omega == 0.0 || axes.negative_stiffnesses(Omega) % 2 == 0) return {};
  return "the asymmetric shaft bends out at its own speed";
}

}  // namespace

void warn_of_growth(FrequencyStep& s, std::vector<double> speeds) {
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end()), speeds.end());
  analysis::ModesOptions o;
  o.count = 4;
  o.judge = true;
  o.real_roots = true;
  analysis::WhirlSolver solver(s.linear, o);
  std::optional<analysis::RotatingAxes> axes;
  if ((turns_with_stiffness(s.job.model) || turns_with_inertia(s.job.model)) && s.turns_as_one())
    axes.emplace(s.linear, speeds.back());
  for (const double Omega : speeds) {
    const std::string growth = axes ? growth_at(*axes, Omega) : growth_at(solver, Omega);
    if (growth.empty()) continue;
    Diagnostic d;
    d.code = "W13";
    d.message = fmt::format(
        "step '{}': the rotor is unstable at {:.6g} rpm ({}): the steady response is never reached "
        "there",
        s.step.name, to_rpm(Omega), growth);
    d.hint = "a stability step finds the onset, a transient step what the rotor does beyond it";
    warn(s.job, std::move(d));
    return;
  }
}

void GapCheck::look_at(const Worst& seen, const std::string& name) {
  Worst& x = worst_[name];
  if (x.gap > 0 && seen.displacement * x.gap <= x.displacement * seen.gap) return;
  x = seen;
}

void GapCheck::look(double Omega, std::span<const VecXc> amplitudes, double frequency) {
  const run::Job& job = step_.job;
  const std::vector<std::size_t> seals = seals_of(job.model);
  if ((job.built.conditions.empty() && seals.empty()) || amplitudes.empty()) return;
  step_.linear.at(Omega);
  const system::State& still = step_.linear.equilibrium().state;
  system::Workspace w = job.system().make_workspace();
  const std::vector<analysis::Point> stations = station_points(job);
  reach_.resize(stations.size(), 0.0);
  constexpr int looks = 24;  // a period: the extreme is met to 1 %
  for (int k = 0; k < looks; ++k) {
    const Complex turn = std::polar(1.0, two_pi * k / looks);
    VecX q = still.q;
    for (const VecXc& a : amplitudes)
      q += (a * turn).real();
    job.system().evaluate_nodes(w, still.frames, still.t, q, still.v, still.a);
    const auto node = [&](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
    for (const assembly::SupportCondition& c : job.built.conditions)
      if (const assembly::SupportCondition::State s = c.state(node); s.gap > 0)
        look_at({s.displacement, s.gap, Omega, frequency, s.film, c.where, c.bearing}, c.name);
    for (const std::size_t b : seals)
      look_at({displacement_at(job.mesh.bearings[b], node), seal_gap(job.model.bearings[b]), Omega,
               frequency, true, job.model.bearings[b].where, b},
              job.model.bearings[b].name);
    for (std::size_t i = 0; i < stations.size(); ++i) {
      const system::NodeState& at = node(stations[i].node);
      const Vec3 u = at.u + stations[i].offset * at.t;
      reach_[i] = std::max(reach_[i], u.tail<2>().norm());
    }
  }
}

/// "at 3000 rpm and 40 Hz"
std::string GapCheck::Worst::text() const {
  return std::isnan(frequency)
             ? fmt::format("at {:.6g} rpm", to_rpm(speed))
             : fmt::format("at {:.6g} rpm and {:.5g} Hz", to_rpm(speed), to_hz(frequency));
}

void GapCheck::report(const std::string& of) {
  std::vector<UsedGap> used;
  for (const auto& [name, x] : worst_) {
    if (!(x.gap > 0)) continue;
    used.push_back({x.bearing, x.gap, x.displacement, x.text()});
    io::Value& v = step_.summary()["gaps"][name];
    v["gap [m]"] = x.gap;
    v["largest displacement [m]"] = x.displacement;
    v["at [rpm]"] = to_rpm(x.speed);
    if (!(x.displacement > x.gap)) continue;
    Diagnostic d;
    d.code = "W11";
    d.message = fmt::format(
        "step '{}': {} the response would take the shaft {:.4g} mm from the middle of '{}', whose "
        "{} is {:.4g} mm ({:.3g} times): a linear response does not know it",
        step_.step.name, x.text(), 1e3 * x.displacement, name, x.film ? "clearance" : "gap",
        1e3 * x.gap, x.displacement / x.gap);
    d.hint =
        "a transient step meets the contact or the film as it is; less unbalance, more damping "
        "or another speed keeps the response linear";
    d.where = x.where;
    warn(step_.job, std::move(d));
  }
  if (used.empty() || !step_.job.model.output.report) return;
  add_clearances(step_.job, step_.section, step_.file("clearance_diagram"), of, reach_, used);
}

double table_slack(const model::TableBearing& table) {
  return 1e-9 * std::max(std::abs(table.speed.front()), std::abs(table.speed.back()));
}

namespace {

/// How far a shaft turns beyond the ends of a bearing's table, rad/s; 0: not, or none is held.
double beyond_table(const run::Job& job, const model::Bearing& b, double low, double high) {
  const auto* table = std::get_if<model::TableBearing>(&b.law);
  if (!table || !table->extrapolate_hold || table->speed.empty()) return 0.0;
  const double ratio = job.model.shafts[b.at.shaft].speed_ratio;
  const double below = table->speed.front() - std::min(ratio * low, ratio * high);
  const double above = std::max(ratio * low, ratio * high) - table->speed.back();
  const double most = std::max(below, above);
  return most > table_slack(*table) ? most : 0.0;
}

}  // namespace

void warn_of_held_tables(run::Job& job, const std::string& step, double low, double high) {
  const model::Bearing* worst = nullptr;
  double most = 0;
  std::string others;
  for (const model::Bearing& b : job.model.bearings) {
    const double beyond = beyond_table(job, b, low, high);
    if (beyond == 0.0) continue;
    others += fmt::format("{}'{}'", others.empty() ? "" : ", ", b.name);
    if (beyond <= most) continue;
    most = beyond;
    worst = &b;
  }
  if (!worst) return;
  const auto& table = std::get<model::TableBearing>(worst->law);
  const double ratio = job.model.shafts[worst->at.shaft].speed_ratio;
  Diagnostic d;
  d.code = "W12";
  d.message = fmt::format(
      "step '{}': the coefficients at the edge of their tables are held beyond them for {}; most "
      "for '{}', whose table covers {:.6g} to {:.6g} rpm and whose shaft turns at {:.6g} to {:.6g} "
      "rpm",
      step, others, worst->name, to_rpm(table.speed.front()), to_rpm(table.speed.back()),
      to_rpm(ratio * low), to_rpm(ratio * high));
  d.hint = "a table over all speeds of the step, or extrapolate = \"error\"";
  d.where = worst->where;
  warn(job, std::move(d));
}

double admitted_excess() {
  static const double corner = assembly::short_bearing_excess(longest_short_bearing, 0.7);
  return corner;
}

void warn_of_short_bearings(run::Job& job, const std::string& step,
                            std::span<const ShortFilm> films) {
  double worst = 0.0;
  const ShortFilm* named = nullptr;
  std::string others;
  for (const ShortFilm& f : films) {
    const model::Bearing& b = job.model.bearings[f.bearing];
    const auto* law = std::get_if<model::ShortJournal>(&b.law);
    if (!law) continue;
    const double excess =
        assembly::short_bearing_excess(law->length / law->diameter, f.eccentricity);
    job.summary["steps"][step]["force of short bearings over finite ones"][b.name] = excess;
    const bool too_long = law->length > longest_short_bearing * law->diameter * (1.0 + 1e-9);
    if (!too_long && excess <= admitted_excess() * (1.0 + 1e-9)) continue;
    others += fmt::format("{}'{}'", others.empty() ? "" : ", ", b.name);
    if (excess <= worst) continue;
    worst = excess;
    named = &f;
  }
  if (!named) return;
  const model::Bearing& b = job.model.bearings[named->bearing];
  const auto& law = std::get<model::ShortJournal>(b.law);
  Diagnostic d;
  d.code = "W03";
  d.message = fmt::format(
      "step '{}': too long for the theory of short bearings: {}; '{}' with L/D = {:.3g} at "
      "eccentricity {:.3f} has {:.3g} times the force of a bearing of finite length",
      step, others, b.name, law.length / law.diameter, named->eccentricity, worst);
  d.hint = "type = \"journal\" has no such limit";
  d.where = b.where;
  warn(job, std::move(d));
}

void warn_of_short_bearings(run::Job& job, const std::string& step, const system::State& s) {
  const auto is_short = [](const model::Bearing& b) {
    return std::holds_alternative<model::ShortJournal>(b.law);
  };
  if (std::none_of(job.model.bearings.begin(), job.model.bearings.end(), is_short)) return;
  system::Workspace w = job.system().make_workspace();
  job.system().evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a);
  std::vector<ShortFilm> films;
  for (const assembly::SupportCondition& c : job.built.conditions) {
    if (!is_short(job.model.bearings[c.bearing])) continue;
    const auto x = c.state([&](Index n) -> const system::NodeState& { return w.in_own_axes(n); });
    films.push_back({c.bearing, x.displacement / x.gap});
  }
  warn_of_short_bearings(job, step, films);
}

}  // namespace whirl::results
