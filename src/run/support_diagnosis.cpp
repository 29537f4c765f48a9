#include <run/support_diagnosis.hpp>

#include <analysis/statics/equilibrium.hpp>
#include <run/diagnose.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace whirl::run {

namespace {

using assembly::SupportCondition;

/// The conditions of the supports at a state; node states as evaluated there.
class Conditions {
 public:
  Conditions(const Job& job, const system::State& s) : workspace_(job.system().make_workspace()) {
    job.system().evaluate_nodes(workspace_, s.frames, s.t, s.q, s.v, s.a);
  }
  SupportCondition::State of(const SupportCondition& c) const { return c.state(node()); }
  /// After `before`; empty where there is no more to say.
  std::string detail(const SupportCondition& c, const std::string& before) const {
    return c.detail ? before + c.detail(node()) : std::string();
  }

 private:
  assembly::NodeAt node() const {
    return [this](Index n) -> const system::NodeState& { return workspace_.in_own_axes(n); };
  }
  system::Workspace workspace_;
};

/// The largest part of the load that has an equilibrium, to 1/256, and that; the least that has none.
struct Carried {
  double share = 0, not_carried = 1;
  std::optional<analysis::Equilibrium> equilibrium;
};

Carried find_carried(const Job& job, const analysis::SteadySystem& running,
                     const StepState& start) {
  analysis::SteadySystem part(job.system(), running.running());
  analysis::EquilibriumOptions options;
  options.max_load_steps =
      10;  // where the last equilibrium leads nowhere a few from none on will do
  analysis::EquilibriumSolver solver(part, options);
  Carried out;
  while (out.not_carried - out.share > 1.0 / 256) {
    const double factor = 0.5 * (out.share + out.not_carried);
    part.set_load(factor);
    auto e =
        solver.try_solve(start.speed, out.equilibrium ? &out.equilibrium->state : &start.state);
    if (e) {
      out.equilibrium = std::move(e);
      out.share = factor;
    } else
      out.not_carried = factor;
  }
  return out;
}

/// Magnets that pull with all they have where the load is as large as it can be: what they carry then.
/// Empty: none does.
std::optional<Error> explain_weak_magnets(const Job& job, const analysis::SteadySystem& running,
                                          const StepState& start, const Error& failed) {
  const auto standing = [&](const system::State& s) {
    system::Workspace w = job.system().make_workspace();
    job.system().evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a);
    const auto node = [&](Index n) -> const system::NodeState& { return w.in_own_axes(n); };
    std::vector<std::array<assembly::MagneticControl::Standing, 2>> out;
    for (const assembly::MagneticControl& m : job.built.magnetic_controls)
      out.push_back(m.standing(node, w.context));
    return out;
  };
  const auto is_limited = [](const auto& axes) {
    return std::isfinite(axes[0].capacity) || std::isfinite(axes[1].capacity);
  };
  const auto at_start = standing(start.state);
  if (std::none_of(at_start.begin(), at_start.end(), is_limited)) return std::nullopt;
  const Carried most = find_carried(job, running, start);
  if (!most.equilibrium) return std::nullopt;
  constexpr double nearly_all = 0.95;
  Diagnostic d = failed.diagnostics().front();
  std::string who;
  const auto now = standing(most.equilibrium->state);
  for (std::size_t k = 0; k < now.size(); ++k)
    for (const std::size_t axis : {0u, 1u}) {
      const assembly::MagneticControl::Standing& s = now[k][axis];
      if (!(std::abs(s.force) > nearly_all * s.capacity)) continue;
      const model::Bearing& b = job.model.bearings[job.built.magnetic_controls[k].bearing];
      who += fmt::format("{}axis {} of magnetic bearing '{}' carries {:.4g} N of at most {:.4g} N",
                         who.empty() ? " " : ", ", axis + 1, b.name, std::abs(s.force), s.capacity);
      if (d.where.line == 0) d.where = b.where;
    }
  if (who.empty()) return std::nullopt;
  d.code = "E76";
  d.message = fmt::format("no equilibrium found: the supports carry {:.3g} of the load; there",
                          most.share) +
              who;
  d.hint =
      "a magnet carries what 'saturation' and 'max_current' let it: more of them, less load, or "
      "another support beside it";
  return Error(failed.exit(), std::move(d));
}

/// Why films do not hold the rotor: the share of the load that they carry, and where they stand
/// then.
Error explain_overload(const Job& job, const analysis::SteadySystem& running,
                       const StepState& start, const Error& failed) {
  const Carried most = find_carried(job, running, start);
  const std::optional<analysis::Equilibrium>& last = most.equilibrium;
  constexpr const char* hint =
      "a film carries more at a higher speed or viscosity, with a smaller clearance, or with a "
      "longer bearing; at rest it carries nothing";
  Diagnostic d = failed.diagnostics().front();
  if (!last) {
    d.message += "; none either under 1/256 of the load";
    d.hint = hint;
    for (const SupportCondition& c : job.built.conditions) {
      const Conditions now(job, start.state);
      if (now.of(c).film && d.where.line == 0) d.where = c.where;
      d.message += now.detail(c, fmt::format("; at the start of bearing '{}' ", c.name));
    }
    return Error(failed.exit(), std::move(d));
  }
  // something did carry a share of it: the load is the matter, not a missing support
  const bool hot = most.not_carried == 1.0 &&
                   std::any_of(job.built.films.begin(), job.built.films.end(),
                               [](const assembly::FilmBearing& b) { return b.heated; });
  if (hot) {  // all of it is carried as long as temperatures stay: they are the matter
    d.message += "; with the temperatures it began with,";
  } else {
    d.code = "E76";
    d.message = fmt::format("no equilibrium found: the supports carry {:.3g} of the load; there",
                            most.share);
  }
  const Conditions now(job, last->state);
  const char* sep = " ";
  bool damper = false;
  for (const SupportCondition& c : job.built.conditions) {
    const SupportCondition::State s = now.of(c);
    if (!s.film) continue;
    constexpr double at_its_end = 0.9;
    damper |= s.displacement > at_its_end * s.gap &&
              !model::traits_of(job.model.bearings[c.bearing].law).follows_spin;
    d.message += fmt::format("{}bearing '{}' carries {:.4g} N at eccentricity {:.3f}", sep, c.name,
                             s.load, s.displacement / s.gap);
    if (s.capacity > 0)
      d.message += fmt::format(" (about {:.4g} N at {})", s.capacity, SupportCondition::believed);
    d.message += now.detail(c, "; ");
    sep = ", ";
    if (d.where.line == 0) d.where = c.where;
  }
  constexpr const char* hint_of_dampers =
      "the film of a damper carries no load that stands still, whatever the speed: its centring "
      "spring does (a larger 'stiffness'), or a larger clearance takes the sag";
  if (!hot) d.hint = damper ? hint_of_dampers : hint;
  return Error(failed.exit(), std::move(d));
}

}  // namespace

Error explain_no_equilibrium(const Job& job, const analysis::SteadySystem& running,
                             const StepState& start, const Error& failed) {
  bool films = false;
  for (const SupportCondition& c : job.built.conditions)
    films = films || Conditions(job, start.state).of(c).film;
  if (!films) {
    if (auto weak = explain_weak_magnets(job, running, start, failed)) return std::move(*weak);
    Diagnostic d = failed.diagnostics().front();
    std::string names;
    for (const model::Bearing& b : job.model.bearings)
      if (model::traits_of(b.law).gap) {
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", b.name);
        d.where = names.find(',') == std::string::npos ? b.where : d.where;
      }
    if (d.code != "E75" || names.empty()) return failed;
    d.message += fmt::format(
        "; {} {} a gap, and moving the shaft along its load finds nothing that holds it", names,
        names.find(',') == std::string::npos ? "has" : "have");
    d.hint =
        "in the middle of its gap a support carries nothing: give the rotor weight or a load that "
        "presses it against the support, less gap, or another support";
    return Error(failed.exit(), std::move(d));
  }
  return explain_overload(job, running, start, failed);
}

std::string supports_at_their_limit(const Job& job, const system::State& s) {
  std::string out;
  system::Workspace w = job.system().make_workspace();
  job.system().evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a);
  constexpr double near = 1e-4;  // the steps before it shrink towards the end of the range
  for (std::size_t i = 0; i < job.model.bearings.size(); ++i) {
    const model::Bearing& b = job.model.bearings[i];
    const auto* table = std::get_if<model::TableBearing>(&b.law);
    if (!table || table->extrapolate_hold || table->speed.empty()) continue;
    const double spin = w.in_own_axes(job.mesh.bearings[i].shaft.node).spin(),
                 low = table->speed.front(), high = table->speed.back();
    const double slack = near * std::max(std::abs(low), std::abs(high));
    if (spin < high - slack && spin > low + slack) continue;
    out += fmt::format(
        "; the table of bearing '{}' covers {:.6g} to {:.6g} rpm, and its shaft turns at {:.6g} "
        "rpm",
        b.name, to_rpm(low), to_rpm(high), to_rpm(spin));
  }
  const Conditions now(job, s);
  for (const SupportCondition& c : job.built.conditions)
    if (const SupportCondition::State x = now.of(c); x.film && x.displacement > (1 - near) * x.gap)
      out += fmt::format("; the journal of bearing '{}' is at the wall (eccentricity {:.6f})",
                         c.name, x.displacement / x.gap);
    else if (x.film)
      out += now.detail(c, fmt::format("; in bearing '{}' ", c.name));
  return out;
}

std::string light_pad_without_load(const Job& job, const system::State& s) {
  system::Workspace w = job.system().make_workspace();
  job.system().evaluate_nodes(w, s.frames, s.t, s.q, s.v, s.a);
  const auto at = [&w](Index k) -> const system::NodeState& { return w.in_own_axes(k); };
  constexpr double little = 0.1;  // of what the pad with the most carries
  std::string out;
  double least = little;
  for (const assembly::TiltingPads& ring : job.built.tilting_pads) {
    const std::vector<elements::PadStanding> pads = ring.standing(at);
    double most = 0.0;
    for (const elements::PadStanding& p : pads)
      most = std::max(most, p.load);
    for (std::size_t k = 0; k < pads.size(); ++k) {
      const double share = most > 0.0 ? pads[k].load / most : 0.0;
      if (!ring.light[k] || share >= least) continue;
      least = share;
      out = fmt::format("pad {} of bearing '{}', which carries {:.3g} N,", k + 1,
                        job.model.bearings[ring.bearing].name, pads[k].load);
    }
  }
  return out;
}

namespace {

/// What a support beyond what it is for says; `at`: "at the start of step 'x'".
Diagnostic beyond(const SupportCondition& c, const SupportCondition::State& s,
                  const std::string& at, const std::string& detail) {
  Diagnostic d;
  d.severity = Diagnostic::Severity::warning;
  d.where = c.where;
  if (s.film) {
    d.code = "W03";
    d.message = fmt::format(
        "bearing '{}' runs at eccentricity {:.5f} {}, carrying {:.4g} N: its film is believed up "
        "to "
        "{}, where it carries about {:.4g} N",
        c.name, s.displacement / s.gap, at, s.load, SupportCondition::believed, s.capacity);
    d.hint = pressed_film_hint;
  } else if (s.magnet) {
    d.code = "W03";
    d.message = fmt::format(
        "the shaft would stand {:.4g} mm from the middle of magnetic bearing '{}' {}, whose air "
        "gap "
        "is {:.4g} mm: it lies on the poles, which the force of the magnet does not know",
        1e3 * s.displacement, c.name, at, 1e3 * s.gap);
    d.hint =
        "a stiffer controller (integral action holds the weight), a larger bias, or a catcher "
        "bearing (type = \"rub\") with less play than the air gap";
  } else {
    d.code = "W04";
    d.message = fmt::format(
        "contact '{}' is closed {}: displacement {:.4g} mm, gap {:.4g} mm, contact force about "
        "{:.3g} N",
        c.name, at, 1e3 * s.displacement, 1e3 * s.gap, s.load);
    d.hint =
        "a larger gap, or a set point of the bearings that lifts the shaft, opens it; the run "
        "goes on with the contact closed";
  }
  d.message += detail;
  return d;
}

/// Of the clearance: the journal has left its bearing where no pad faces it.
constexpr double beyond_any_film = 2.0;

Error no_film(const SupportCondition& c, const SupportCondition::State& s,
              const model::Step& step) {
  Diagnostic d;
  d.code = "E76";
  d.where = c.where;
  d.message = fmt::format(
      "step '{}': no equilibrium found: the load drives the journal of bearing '{}' to where none "
      "of "
      "its pads faces it (its balance would be {:.4g} mm away, the clearance is {:.4g} mm)",
      step.name, c.name, 1e3 * s.displacement, 1e3 * s.gap);
  d.hint = "turn the pads by 'first_pivot', or give the bearing one that faces the load";
  return Error(Exit::no_convergence, std::move(d));
}

}  // namespace

void warn_of_closed_contacts(Job& job, const model::Step& step, const std::string& when,
                             const system::State& state) {
  if (job.built.conditions.empty()) return;
  const Conditions now(job, state);
  std::vector<Diagnostic> out;
  for (const SupportCondition& c : job.built.conditions) {
    const SupportCondition::State s = now.of(c);
    if (!(s.displacement > (s.film ? SupportCondition::believed * s.gap : s.gap))) continue;
    if (s.film && s.displacement > beyond_any_film * s.gap) throw no_film(c, s, step);
    Diagnostic d =
        beyond(c, s, fmt::format("at {} of step '{}'", when, step.name), now.detail(c, "; "));
    job.report.warnings.push_back(d.message);
    io::Value& list = job.summary["warnings"];
    list.push(d.code + ": " + d.message);
    out.push_back(std::move(d));
  }
  if (!job.options.quiet) print_diagnostics(out);
}

}  // namespace whirl::run
