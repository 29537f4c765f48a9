// What a step is asked for that its model cannot give.
#include <deck/validate_parts.hpp>

#include <core/units.hpp>
#include <model/full_section.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace whirl::deck {

namespace {

/// Stiffnesses that differ by more than rounding of the data turn matrices with them.
constexpr double unequal = 0.02;

bool turns_with_stiffness(const model::Shaft& s) {
  if (!s.rotating || s.speed_ratio == 0) return false;
  return std::any_of(s.sections.begin(), s.sections.end(),
                     [](const model::Section& x) { return model::is_unequal(x, unequal); });
}

/// Times that a transient step can have, s.
struct Span {
  double from = 0, to = 0;
};
Span span_of(const model::Model& m, const model::Step& step) {
  const auto duration = [](const model::Step& s) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    return t ? t->duration : 0.0;
  };
  Span out{0.0, duration(step)};
  std::string before = step.from;
  for (std::size_t k = 0; k < m.steps.size() && !before.empty(); ++k) {  // no more than there are
    const auto it = std::find_if(m.steps.begin(), m.steps.end(),
                                 [&](const model::Step& s) { return s.name == before; });
    if (it == m.steps.end()) break;
    out.from += duration(*it);
    out.to += duration(*it);
    before = it->from;
  }
  if (!m.events.empty()) out.from = 0.0;  // a step may end early
  return out;
}

/// A law has one value in a span: looked at where it may change and 1000 times between.
bool is_constant(const Law& law, const Span& span) {
  std::vector<double> times = law.breakpoints();
  for (int i = 0; i <= 1000; ++i)
    times.push_back(span.from + (span.to - span.from) * i / 1000);
  const double first = law.at(span.from).f;
  return std::none_of(times.begin(), times.end(), [&](double t) {
    return t >= span.from && t <= span.to && std::abs(law.at(t).f - first) > 1e-9 * std::abs(first);
  });
}

/// Of the temperatures of a film, s; null: it has none.
const double* time_constant_of(const model::BearingLaw& law) {
  return std::visit(
      [](const auto& x) -> const double* {
        if constexpr (requires { x.flow.heat->time_constant; })
          return x.flow.heat ? &x.flow.heat->time_constant : nullptr;
        else
          return nullptr;
      },
      law);
}

/// The shaft of a place may turn in a step.
bool turns_in(const model::Model& m, const model::Step& step, const model::Location& at) {
  const auto range = speeds_of(m, step, at.shaft);
  const bool stands = range && range->first == 0 && range->second == 0;
  return m.shafts[at.shaft].rotating && !stands;
}

/// Torsion takes part in a step of small motions.
bool twists(const model::StepLaw& law) {
  return std::visit(
      [](const auto& s) {
        using T = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<T, model::StaticStep> ||
                      std::is_same_v<T, model::TransientStep> ||
                      std::is_same_v<T, model::CriticalMapStep> ||
                      std::is_same_v<T, model::ApiLateralStep> ||
                      std::is_same_v<T, model::BalancingStep>)
          return false;
        else if constexpr (requires { s.motion; })
          return s.motion == model::MotionKind::all || s.motion == model::MotionKind::torsional;
        else
          return true;
      },
      law);
}

}  // namespace

void check_linear(const model::Model& m, Problems& out) {
  for (const auto& s : m.steps) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    if (!t || !t->linear) continue;
    const auto say = [&](std::string what, const char* hint) {
      report(out, "E39", fmt::format("step '{}' is linear, but {}", s.name, what), hint, s.where);
    };
    for (const auto& shaft : m.shafts)
      if (turns_with_stiffness(shaft))
        say(fmt::format("the stiffness of shaft '{}' turns with it", shaft.name),
            "leave linear out of the step");
    for (const auto& b : m.bearings) {
      const auto* coupling = std::get_if<model::Coupling>(&b.law);
      if (coupling && model::is_unequal(*coupling, unequal) && m.shafts[b.at.shaft].rotating)
        say(fmt::format("the stiffness of coupling '{}' turns with its shafts", b.name),
            "leave linear out of the step");
      const bool passes = turns_in(m, s, b.at) || (b.to && turns_in(m, s, *b.to));
      const model::SupportTraits law = model::traits_of(b.law);
      if (law.passing->has_value() && passes)
        say(fmt::format("the stiffness of {} '{}' changes as its {} pass",
                        law.pair->has_value() ? (**law.pair).noun : "bearing", b.name,
                        law.pair->has_value() ? "teeth" : "rolling elements"),
            "leave linear out of the step, or give a constant stiffness (of gears no "
            "stiffness_harmonics; "
            "bearings of type = \"linear\")");
      if (const double* follows = time_constant_of(b.law); follows && std::isfinite(*follows))
        report(out, "W02",
               fmt::format("time_constant of the heat of bearing '{}' has no effect on step '{}': "
                           "small motions "
                           "keep the temperatures of their equilibrium",
                           b.name, s.name),
               "leave linear out of the step", b.where, Diagnostic::Severity::warning);
      const auto* magnets = std::get_if<model::MagneticBearing>(&b.law);
      if (magnets && magnets->power && !is_constant(*magnets->power, span_of(m, s)))
        say(fmt::format("the power of magnetic bearing '{}' changes, and the matrices with it",
                        b.name),
            "a constant power, or leave linear out of the step");
    }
    if (m.base.turn && m.base.turn->rate && !is_constant(*m.base.turn->rate, span_of(m, s)))
      say("the base turns at a rate that changes, and the matrices with it",
          "a constant rate, or leave linear out");
    if (t->integrator.method == "momentum_rk")
      say("momentum_rk integrates the general motion of rigid bodies",
          "another method, or linear = false");
    for (const auto& d : m.drives) {
      if (!d.step.empty() && d.step != s.name) continue;
      if (std::holds_alternative<model::TorqueCurve>(d.law)) {
        say(fmt::format("drive '{}' is a torque: it changes the speed", d.name),
            "give it another step, or leave linear out");
      } else if (const auto range = speeds_of(m, s, d.at.shaft);
                 range && range->second - range->first >
                              1e-9 * std::max(std::abs(range->first), std::abs(range->second))) {
        say(fmt::format("drive '{}' changes the speed from {} to {}", d.name,
                        units::display(range->first, "rpm"), units::display(range->second, "rpm")),
            "a constant speed, or leave linear out");
      }
    }
  }
}

void check_cracks(const model::Model& m, Problems& out) {
  if (m.cracks.empty()) return;
  const auto say = [&](const char* code, const model::Step& s, std::string what, const char* hint) {
    report(out, code, fmt::format("step '{}': {}", s.name, what), hint, s.where);
  };
  for (const model::Crack& c : m.cracks) {
    const model::Shaft& shaft = m.shafts[c.at.shaft];
    const bool by_bending = c.breathing == model::Crack::Breathing::hinge ||
                            c.breathing == model::Crack::Breathing::response;
    for (const model::Step& s : m.steps) {
      if (const auto* t = std::get_if<model::TransientStep>(&s.law); t && t->linear)
        say("E39", s,
            fmt::format("it is linear, but the stiffness of shaft '{}' turns with it", shaft.name),
            "leave linear out of the step");
      if (std::holds_alternative<model::BalancingStep>(s.law))
        say("E88", s,
            fmt::format("crack '{}': a cracked rotor does not answer unbalance in proportion, so "
                        "that it has no influence coefficients",
                        c.name),
            "leave the crack out of the model that is balanced");
      if (std::holds_alternative<model::UnbalanceStep>(s.law) && shaft.damping.loss_factor != 0)
        say("E88", s,
            fmt::format("crack '{}': the motion has several frequencies, and hysteretic damping is "
                        "known at one at a time",
                        c.name),
            "internal (viscous) damping in place of internal_loss_factor");
      if (std::holds_alternative<model::StabilityStep>(s.law) && by_bending &&
          !shaft.bow.constant())
        say("E88", s,
            fmt::format("crack '{}' opens by bending, and the bow of shaft '{}' changes in time",
                        c.name, shaft.name),
            "leave time_constant out of the bow, or take breathing = \"mayes\"");
    }
  }
}

namespace {

/// The bearing's film conserves mass.
bool conserves_mass(const model::BearingLaw& law) {
  const auto of = [](const auto& x) -> bool {
    if constexpr (requires { x.flow.cavitation; })
      return x.flow.conserves_mass();
    else
      return false;
  };
  return std::visit(of, law);
}

}  // namespace

void check_cavitation(const model::Model& m, Problems& out) {
  for (const model::Bearing& b : m.bearings) {
    if (!conserves_mass(b.law)) continue;
    if (b.to && m.shafts[b.to->shaft].rotating && m.shafts[b.to->shaft].speed_ratio != 0)
      report(
          out, "E47",
          fmt::format("bearing '{}': the film conserves mass, and its housing, shaft '{}', turns",
                      b.name, m.shafts[b.to->shaft].name),
          "cavitation = \"reynolds\" in the bearing", b.where);
  }
}

void check_events(const model::Model& m, Problems& out) {
  for (std::size_t k = 0; k < m.steps.size(); ++k) {
    const auto* report_step = std::get_if<model::ApiTorsionalStep>(&m.steps[k].law);
    if (!report_step) continue;
    for (const model::ApiEvent& e : report_step->events) {
      const auto end = m.steps.begin() + static_cast<std::ptrdiff_t>(k);
      const auto of = std::find_if(m.steps.begin(), end,
                                   [&](const model::Step& s) { return s.name == e.step; });
      const auto* t = of == end ? nullptr : std::get_if<model::TransientStep>(&of->law);
      if (t && t->torques) continue;
      report(out, "E30",
             fmt::format("event '{}': step '{}' {}", e.name, e.step,
                         of == end ? "stands below the report that looks at it"
                         : !t      ? "is no transient step"
                                   : "has no table 'torques'"),
             "steps run in the order of the deck; [step.torques] makes a transient step keep its "
             "torques",
             e.where);
    }
  }
}

/// An order is counted in turns of the shaft that the torque acts on.
void check_torques(const model::Model& m, Problems& out) {
  for (const model::Step& s : m.steps) {
    const auto* report_step = std::get_if<model::ApiTorsionalStep>(&s.law);
    if (!report_step) continue;
    for (const model::ApiTorque& t : report_step->torques) {
      const model::Shaft& shaft = m.shafts[t.at.shaft];
      const bool turns = shaft.rotating && shaft.speed_ratio != 0;
      if (turns || (t.order == 0 && t.harmonics.empty())) continue;
      report(out, "E26",
             fmt::format("torque '{}' is given by orders of the speed of shaft '{}', which does "
                         "not turn",
                         t.name, shaft.name),
             "give its frequency, or a place on a shaft that turns", t.where);
    }
  }
}

void check_maps(const model::Model& m, Problems& out) {
  const auto mapped = [](const model::Bearing& b) { return *model::traits_of(b.law).mapped; };
  for (const auto& s : m.steps) {
    const auto* map = std::get_if<model::CriticalMapStep>(&s.law);
    if (!map) continue;
    for (const std::string& name : map->bearings) {
      const auto found = std::find_if(m.bearings.begin(), m.bearings.end(),
                                      [&](const model::Bearing& b) { return b.name == name; });
      if (found == m.bearings.end())
        report(
            out, "E80",
            fmt::format("step '{}' names bearing '{}', which the deck does not have", s.name, name),
            "", s.where);
      else if (!mapped(*found))
        report(out, "E80",
               fmt::format("step '{}' names bearing '{}', which has no lateral stiffness to vary",
                           s.name, name),
               "name supports that carry the shaft laterally", s.where);
    }
    const bool some = std::any_of(m.bearings.begin(), m.bearings.end(),
                                  [&](const model::Bearing& b) { return !b.to && mapped(b); });
    if (map->bearings.empty() && !some)
      report(out, "E80",
             fmt::format("step '{}' has no bearing to vary: none carries a shaft laterally by a "
                         "stiffness of its own",
                         s.name),
             "give the bearing a stiffness (type \"linear\"), or name the supports in 'bearings'",
             s.where);
  }
}

/// Without damping and circulation nothing is left of a controller but its magnets' negative
/// stiffness.
void check_controllers(const model::Model& m, Problems& out) {
  const auto magnetic = std::find_if(m.bearings.begin(), m.bearings.end(), [](const auto& b) {
    return std::holds_alternative<model::MagneticBearing>(b.law);
  });
  if (magnetic == m.bearings.end()) return;
  const auto undamped = [](const auto& law) {
    using T = std::decay_t<decltype(law)>;
    if constexpr (requires { law.damped; })
      return !law.damped;
    else
      return std::is_same_v<T, model::CriticalStep> || std::is_same_v<T, model::CriticalMapStep> ||
             std::is_same_v<T, model::ApiLateralStep> || std::is_same_v<T, model::BucklingStep>;
  };
  for (const auto& s : m.steps)
    if (std::visit(undamped, s.law))
      report(out, "E26",
             fmt::format("step '{}' knows mass, gyroscopic moments and symmetric stiffness alone, "
                         "which is nothing of what controls magnetic bearing '{}'",
                         s.name, magnetic->name),
             "modal, campbell, stability, unbalance_response and sensitivity steps have its "
             "controllers in them; or put a linear bearing in its place",
             s.where);
}

/// A prescribed angle is held in small motions: the shaft is clamped there.
void check_clamps(const model::Model& m, Problems& out) {
  for (const auto& d : m.drives) {
    if (!std::holds_alternative<model::PrescribedSpin>(d.law)) continue;
    std::string steps;
    for (const auto& s : m.steps)
      if (twists(s.law) && (d.step.empty() || d.step == s.name))
        steps += fmt::format("{}'{}'", steps.empty() ? "" : ", ", s.name);
    if (steps.empty()) continue;
    report(
        out, "W06",
        fmt::format("drive '{}' holds the twist of shaft '{}' at {} in step{} {}: torsional "
                    "motions are those of a shaft clamped there; the speed is that of the step",
                    d.name, m.shafts[d.at.shaft].name, d.at.text,
                    steps.find(',') == std::string::npos ? "" : "s", steps),
        "name the transient step it drives (step = \"..\") to leave the shaft free in the others",
        d.where, Diagnostic::Severity::warning);
  }
}

namespace {

/// The step named by 'from'; null: none.
const model::Step* earlier_step(const model::Model& m, const model::Step& s) {
  const auto is_it = [&](const model::Step& x) { return !s.from.empty() && x.name == s.from; };
  const auto found = std::find_if(m.steps.begin(), m.steps.end(), is_it);
  return found == m.steps.end() ? nullptr : &*found;
}

/// Where a step goes on from a state there is none to choose.
void warn_of_ignored_starts(const model::Model& m, Problems& out) {
  using Start = model::TransientStep::Start;
  for (const model::Step& s : m.steps) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    if (!t || t->start == Start::static_equilibrium) continue;
    const model::Step* earlier = earlier_step(m, s);
    const bool of_equilibrium = earlier && std::holds_alternative<model::StaticStep>(earlier->law);
    // an equilibrium has a response and modes about it
    if (of_equilibrium && t->start != Start::rest) continue;
    if (!earlier && t->previous.empty()) continue;
    report(out, "W02",
           fmt::format("'start' of step '{}' has no effect: it begins from {}", s.name,
                       earlier ? fmt::format("the state of step '{}'", s.from)
                               : fmt::format("the end of the run in '{}'", t->previous)),
           earlier ? "leave out 'start' or 'from'" : "leave out 'start' or 'previous'", s.where,
           Diagnostic::Severity::warning);
  }
}

}  // namespace

/// A step begins where one other motion ended.
void check_beginnings(const model::Model& m, Problems& out) {
  for (const model::Step& s : m.steps) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    if (t && !t->previous.empty() && !s.from.empty())
      report(out, "E26",
             fmt::format("step '{}' cannot begin both from step '{}' and from the run in '{}'",
                         s.name, s.from, t->previous),
             "leave out 'from' or 'previous'", s.where);
  }
  warn_of_ignored_starts(m, out);
}

/// Windows of time in which no step runs: nothing would be written.
namespace {

struct Stretch {
  double begin, end;  ///< s
};

/// When the transients run; nothing where one goes on at a time that another run knows.
std::optional<std::map<std::string, Stretch>> times_of_transients(const model::Model& m) {
  std::map<std::string, double> end;
  std::map<std::string, Stretch> out;
  for (const model::Step& s : m.steps) {
    const auto before = end.find(s.from);
    const double begin = before == end.end() ? 0.0 : before->second;
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    end[s.name] = begin + (t ? t->duration : 0.0);
    if (!t) continue;
    if (!t->previous.empty()) return std::nullopt;
    out[s.name] = {begin, end[s.name]};
  }
  return out;
}

}  // namespace

void check_windows(const model::Model& m, Problems& out) {
  const auto times = times_of_transients(m);
  if (!times || times->empty()) return;
  const auto check = [&](double t0, double t1, const std::string& step, const char* what,
                         const char* lost, const Where& where) {
    double first = infinity, last = -infinity;
    for (const auto& [name, stretch] : *times) {
      if (!step.empty() && name != step) continue;
      first = std::min(first, stretch.begin);
      last = std::max(last, stretch.end);
    }
    if (!(last >= first) || (t0 < last && t1 > first)) return;
    report(out, "W02",
           fmt::format("the window of {} from {:.6g} s to {:.6g} s holds nothing: transient "
                       "steps run from {:.6g} s to {:.6g} s",
                       what, t0, t1, first, last),
           lost, where, Diagnostic::Severity::warning);
  };
  Where where;
  for (const model::Step& s : m.steps)
    if (times->contains(s.name)) where = s.where;
  check(m.output.t0, m.output.t1, {}, "[output]", "no row of the histories would be written",
        where);
  for (const model::VtkOutput& v : m.output.vtk)
    check(v.t0, v.t1, v.step, "[[output.vtk]]", "no frame would be written", v.where);
}

namespace {

/// Least and largest reference speed of a transient, where a drive prescribes it.
std::optional<std::pair<double, double>> driven_speeds(const model::Model& m,
                                                       const model::Step& s) {
  const model::Drive* first = nullptr;
  for (const model::Drive& d : m.drives) {
    if (!d.step.empty() && d.step != s.name) continue;
    const bool counts = m.shafts[d.at.shaft].speed_ratio == 1.0;
    if (!first || (counts && m.shafts[first->at.shaft].speed_ratio != 1.0)) first = &d;
  }
  const auto* spin = first ? std::get_if<model::PrescribedSpin>(&first->law) : nullptr;
  if (!spin || !spin->angle) return std::nullopt;
  const double ratio = m.shafts[first->at.shaft].speed_ratio;
  const auto range = speeds_of(m, s, first->at.shaft);
  if (!range || ratio == 0.0) return std::nullopt;
  return std::minmax(range->first / ratio, range->second / ratio);
}

}  // namespace

/// A window of speeds that no transient passes through: nothing would be written.
void check_speed_window(const model::Model& m, Problems& out) {
  const double low = m.output.speed_low, high = m.output.speed_high;
  if (low == -infinity && high == infinity) return;
  double least = infinity, most = -infinity;
  Where where;
  for (const model::Step& s : m.steps) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    if (!t) continue;
    const model::Step* earlier = earlier_step(m, s);
    const bool later = earlier && std::holds_alternative<model::TransientStep>(earlier->law);
    const auto range = later || !t->previous.empty() ? std::nullopt : driven_speeds(m, s);
    if (!range) return;  // known to the run alone
    least = std::min(least, range->first);
    most = std::max(most, range->second);
    where = s.where;
  }
  if (!(most >= least) || (low <= most && high >= least)) return;
  report(out, "W02",
         fmt::format("speed_window of [output] from {} to {} holds nothing: transient steps run "
                     "from {} to {}",
                     units::display(low, "rpm"), units::display(high, "rpm"),
                     units::display(least, "rpm"), units::display(most, "rpm")),
         "no row of the histories would be written", where, Diagnostic::Severity::warning);
}

namespace {

bool is_prestressed(const model::Shaft& s) {
  return s.axial_preload != 0 ||
         std::any_of(s.sections.begin(), s.sections.end(),
                     [](const model::Section& x) { return x.temperature_rise != 0; });
}

}  // namespace

/// Steps linearised about the rotor as drawn.
void check_undeformed(const model::Model& m, Problems& out) {
  for (const model::Step& s : m.steps) {
    const bool undeformed = std::visit(
        [](const auto& law) {
          if constexpr (requires { law.about; })
            return law.about == model::About::undeformed;
          else
            return false;
        },
        s.law);
    if (!undeformed) continue;
    if (!s.from.empty())
      report(out, "E26",
             fmt::format(
                 "step '{}' starts from step '{}', but is linearised about the undeformed rotor",
                 s.name, s.from),
             "leave out 'from', or about = \"equilibrium\"", s.where);
    if (const auto* stability = std::get_if<model::StabilityStep>(&s.law);
        stability && stability->map)
      report(
          out, "E26",
          fmt::format("step '{}': a map of the stability over a parameter is about the equilibrium "
                      "of each of its rotors",
                      s.name),
          "leave out 'map', or about = \"equilibrium\"", s.where);
    // a map puts its own stiffness in the place of the films it varies
    const auto* map = std::get_if<model::CriticalMapStep>(&s.law);
    const auto varied_film = [&](const model::Bearing& b) {
      return map && model::traits_of(b.law).film &&
             (map->bearings.empty() ? !b.to
                                    : std::find(map->bearings.begin(), map->bearings.end(),
                                                b.name) != map->bearings.end());
    };
    for (const model::Shaft& shaft : m.shafts)
      if (!shaft.path.empty() && is_prestressed(shaft))
        report(
            out, "E26",
            fmt::format("step '{}' is linearised about the undeformed rotor, where shaft '{}', "
                        "whose line is not straight, is not in balance: heat or preload bends it",
                        s.name, shaft.name),
            "about = \"equilibrium\"", s.where);
    for (const model::Bearing& b : m.bearings)
      if (model::traits_of(b.law).needs_load && !varied_film(b))
        report(out, "E26",
               fmt::format("step '{}' is linearised about the undeformed rotor, where bearing '{}' "
                           "carries no load: its stiffness is that of its load",
                           s.name, b.name),
               "about = \"equilibrium\", or a bearing of type \"linear\" or \"table\" in its place",
               s.where);
  }
}

}  // namespace whirl::deck
