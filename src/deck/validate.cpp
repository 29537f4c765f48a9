#include <model/resolution.hpp>
#include <algorithm>
#include <cmath>
#include <core/units.hpp>
#include <deck/deck.hpp>
#include <deck/validate.hpp>
#include <fmt/format.h>
#include <map>
#include <set>

namespace whirl::deck {
namespace {

using Problems = std::vector<WholeModelProblem>;

void add(Problems& p, const char* code, std::string message, std::string hint, const Where& where,
         Diagnostic::Severity severity = Diagnostic::Severity::error) {
  p.push_back({severity, code, std::move(message), std::move(hint), where});
}

/// Rigid motions of one shaft that something resists. Lateral and tilting restraint in one plane
/// follows from the stations where that plane is held: one place holds the shift, a second place or
/// a tilting stiffness the tilt.
struct Restraint {
  bool axial = false;
  std::array<std::set<double>, 2> stations;  ///< held laterally along y, z
  std::array<bool, 2> tilt{};                ///< tilt in the x-y, x-z plane held by a moment
  bool lateral(int k) const { return !stations[static_cast<std::size_t>(k)].empty(); }
  bool tilting(int k) const {
    return tilt[static_cast<std::size_t>(k)] || stations[static_cast<std::size_t>(k)].size() > 1;
  }
};

/// Direction of the tilt in the x-y and the x-z plane: about z, about y.
constexpr std::array<std::size_t, 2> tilt_in_plane{5, 4};

std::vector<Restraint> restraints(const model::Model& m) {
  std::vector<Restraint> r(m.shafts.size());
  const auto apply = [&](const model::Location& at, const model::Directions& held) {
    Restraint& x = r[at.shaft];
    x.axial = x.axial || held[0];
    for (std::size_t k = 0; k < 2; ++k) {
      if (held[1 + k]) x.stations[k].insert(at.s);
      x.tilt[k] = x.tilt[k] || held[tilt_in_plane[k]];
    }
  };
  for (const auto& b : m.bearings)
    if (!b.to) apply(b.at, model::traits_of(b.law).held);
  // a bearing to another shaft holds as far as that shaft is held there; whole chains settle in as
  // many passes
  for (std::size_t pass = 0; pass < m.shafts.size(); ++pass)
    for (const auto& b : m.bearings) {
      if (!b.to) continue;
      for (const auto& [here, there] : {std::pair(b.at, *b.to), std::pair(*b.to, b.at)}) {
        if (here.shaft == there.shaft) continue;
        const Restraint& other = r[there.shaft];
        model::Directions held = model::traits_of(b.law).held;
        held[0] = held[0] && other.axial;
        for (std::size_t k = 0; k < 2; ++k) {
          const bool fixed =
              other.lateral(static_cast<int>(k)) && other.tilting(static_cast<int>(k));
          held[1 + k] = held[1 + k] && fixed;
          held[tilt_in_plane[k]] = held[tilt_in_plane[k]] && fixed;
        }
        apply(here, held);
      }
    }
  return r;
}

bool starts_static(const model::Step& s) {
  if (std::holds_alternative<model::StaticStep>(s.law)) return true;
  if (const auto* t = std::get_if<model::TransientStep>(&s.law))
    return s.from.empty() && t->start == model::TransientStep::Start::static_equilibrium;
  return false;
}

void check_restraint(const model::Model& m, Problems& out) {
  const auto needs = std::find_if(m.steps.begin(), m.steps.end(), starts_static);
  if (needs == m.steps.end()) return;
  const auto r = restraints(m);
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    if (m.joined(k)) continue;  // the assembled model knows
    const auto say = [&](const char* motion, const char* hint) {
      add(out, "E32",
          fmt::format("nothing resists {} of shaft '{}', but step '{}' needs a static equilibrium",
                      motion, m.shafts[k].name, needs->name),
          hint, m.shafts[k].where);
    };
    if (!r[k].axial)
      say("axial motion",
          "give a bearing kxx, or add one of type \"rigid\" with directions = [\"x\"]; or start "
          "from rest");
    for (int a = 0; a < 2; ++a) {
      const char* axis = a == 0 ? "y" : "z";
      if (!r[k].lateral(a))
        say(a == 0 ? "motion along y" : "motion along z",
            a == 0 ? "a bearing with kyy is missing" : "a bearing with kzz is missing");
      else if (!r[k].tilting(a))
        say(a == 0 ? "tilting in the x-y plane" : "tilting in the x-z plane",
            fmt::format("it is held along {} at one place only: a second bearing or a tilting "
                        "stiffness is missing",
                        axis)
                .c_str());
    }
  }
}

/// Prescribed spin of a shaft in a step (null: none).
const model::PrescribedSpin* prescribed(const model::Model& m, std::size_t shaft,
                                        const model::Step* s) {
  for (const auto& d : m.drives)
    if (d.at.shaft == shaft && (d.step.empty() || (s && d.step == s->name)))
      if (const auto* p = std::get_if<model::PrescribedSpin>(&d.law); p && p->angle) return p;
  return nullptr;
}

/// Spin of a shaft, rad/s, where a step without a state to start from begins. own: speed of the
/// reference the step gives.
double spin_at_start(const model::Model& m, const model::Step& s, std::size_t shaft,
                     std::optional<double> own) {
  if (!m.shafts[shaft].rotating) return 0.0;
  if (own) return *own * m.shafts[shaft].speed_ratio;
  const auto* p = prescribed(m, shaft, &s);
  return p ? p->angle->at(0.0).df : m.shafts[shaft].spin0;
}

/// Speeds a step goes through: least and largest of the reference shaft, or nothing.
std::optional<std::pair<double, double>> speeds_of(const model::Model& m, const model::Step& s,
                                                   std::size_t shaft) {
  const double ratio = m.shafts[shaft].speed_ratio;
  const auto range = [&](const model::SpeedRange& r) {
    const double a = r.values.empty() ? r.start : r.values.front(),
                 b = r.values.empty() ? r.stop : r.values.back();
    return std::pair(std::min(a * ratio, b * ratio), std::max(a * ratio, b * ratio));
  };
  if (const auto* x = std::get_if<model::StaticStep>(&s.law)) {
    if (x->speeds) return range(*x->speeds);
    if (!s.from.empty() && !x->own_speed()) return std::nullopt;  // that of the step it starts from
    const double spin = spin_at_start(m, s, shaft, x->own_speed());
    return std::pair(spin, spin);
  }
  if (const auto* x = std::get_if<model::ModalStep>(&s.law))
    return std::pair(x->speed * ratio, x->speed * ratio);
  if (const auto* x = std::get_if<model::CampbellStep>(&s.law)) return range(x->speed);
  if (const auto* x = std::get_if<model::UnbalanceStep>(&s.law)) return range(x->speed);
  if (const auto* x = std::get_if<model::StabilityStep>(&s.law)) return range(x->speed);
  if (const auto* x = std::get_if<model::HarmonicStep>(&s.law))
    return x->speeds ? range(*x->speeds) : std::pair(x->speed * ratio, x->speed * ratio);
  if (const auto* x = std::get_if<model::BucklingStep>(&s.law))
    return std::pair(x->speed * ratio, x->speed * ratio);
  if (const auto* x = std::get_if<model::TransientStep>(&s.law)) {
    for (const auto& d : m.drives) {
      const auto* p = std::get_if<model::PrescribedSpin>(&d.law);
      if (!p || !p->angle || d.at.shaft != shaft || (!d.step.empty() && d.step != s.name)) continue;
      // a law is smooth between its breakpoints; 1000 samples find its extremes well enough for a
      // check
      double low = infinity, high = -infinity;
      std::vector<double> t = p->angle->breakpoints();
      for (int i = 0; i <= 1000; ++i)
        t.push_back(x->duration * i / 1000);
      for (double ti : t) {
        if (ti < 0 || ti > x->duration) continue;
        const double w = p->angle->at(ti).df;
        low = std::min(low, w);
        high = std::max(high, w);
      }
      return std::pair(low, high);
    }
    // a free spin is known at its start only
    const double start = spin_at_start(m, s, shaft, x->own_speed());
    if (s.from.empty() && x->previous.empty()) return std::pair(start, start);
  }
  return {};  // critical speeds look inside the table only
}

std::string in_hertz(double w) { return fmt::format("{:.6g} Hz", to_hz(w)); }

/// Frequencies of excitation of a step, rad/s: least and largest, or nothing.
std::optional<std::pair<double, double>> frequencies_of(const model::Model& m,
                                                        const model::Step& s) {
  const auto speeds = [](const model::SpeedRange& r, double order) {
    const double a = order * std::abs(r.values.empty() ? r.start : r.values.front()),
                 b = order * std::abs(r.values.empty() ? r.stop : r.values.back());
    return std::pair(std::min(a, b), std::max(a, b));
  };
  if (const auto* x = std::get_if<model::UnbalanceStep>(&s.law)) {
    std::pair<double, double> all{infinity, 0.0};  // of all shafts that turn
    for (const auto& shaft : m.shafts) {
      if (!shaft.rotating || shaft.speed_ratio == 0) continue;
      const auto own = speeds(x->speed, std::abs(shaft.speed_ratio));
      if (own.first > 0 || own.second > 0)
        all = {std::min(all.first, own.first), std::max(all.second, own.second)};
    }
    return all.second > 0 ? std::optional(all) : std::nullopt;
  }
  if (const auto* x = std::get_if<model::HarmonicStep>(&s.law)) {
    if (x->speeds) return speeds(*x->speeds, x->order);
    if (!x->frequency) return std::nullopt;
    const auto& f = *x->frequency;
    return f.values.empty() ? std::pair(f.start, f.stop)
                            : std::pair(f.values.front(), f.values.back());
  }
  return std::nullopt;
}

/// A shaft whose bending stiffnesses differ by more than rounding of its data turns its matrices
/// with it.
bool turns_with_stiffness(const model::Shaft& s) {
  constexpr double share = 0.02;
  if (!s.rotating || s.speed_ratio == 0) return false;
  return std::any_of(s.sections.begin(), s.sections.end(), [](const model::Section& x) {
    return x.general &&
           std::abs(x.general->Iy - x.general->Iz) > share * std::max(x.general->Iy, x.general->Iz);
  });
}

/// A law has one value from 0 to `duration`, s: looked at where it may change and 1000 times
/// between.
bool is_constant(const Law& law, double duration) {
  std::vector<double> times = law.breakpoints();
  for (int i = 0; i <= 1000; ++i)
    times.push_back(duration * i / 1000);
  const double first = law.at(0.0).f;
  return std::none_of(times.begin(), times.end(), [&](double t) {
    return t >= 0 && t <= duration && std::abs(law.at(t).f - first) > 1e-9 * std::abs(first);
  });
}

void check_linear(const model::Model& m, Problems& out) {
  for (const auto& s : m.steps) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    if (!t || !t->linear) continue;
    const auto say = [&](std::string what, const char* hint) {
      add(out, "E39", fmt::format("step '{}' is linear, but {}", s.name, what), hint, s.where);
    };
    for (const auto& shaft : m.shafts)
      if (turns_with_stiffness(shaft))
        say(fmt::format("the stiffness of shaft '{}' turns with it", shaft.name),
            "leave linear out of the step");
    if (m.base.turn && m.base.turn->rate && !is_constant(*m.base.turn->rate, t->duration))
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

void check_maps(const model::Model& m, Problems& out) {
  for (const auto& s : m.steps) {
    const auto* map = std::get_if<model::CriticalMapStep>(&s.law);
    if (!map) continue;
    for (const std::string& name : map->bearings)
      if (std::none_of(m.bearings.begin(), m.bearings.end(),
                       [&](const model::Bearing& b) { return b.name == name; }))
        add(out, "E80",
            fmt::format("step '{}' names bearing '{}', which the deck does not have", s.name, name),
            "", s.where);
    const bool any = std::any_of(m.bearings.begin(), m.bearings.end(), [](const model::Bearing& b) {
      return model::traits_of(b.law).acts != model::Acts::as_constraint && !b.to;
    });
    if (map->bearings.empty() && !any)
      add(out, "E80", fmt::format("step '{}' has no bearing to vary: all are rigid", s.name),
          "give the bearing a stiffness (type \"linear\")", s.where);
  }
}

void check_tables(const model::Model& m, Problems& out) {
  for (const auto& b : m.bearings) {
    const auto* table = std::get_if<model::TableBearing>(&b.law);
    if (!table || table->speed.empty()) continue;
    for (const auto& s : m.steps)
      if (!table->frequency.empty() && std::holds_alternative<model::TransientStep>(s.law))
        add(out, "W03",
            fmt::format("the table of bearing '{}' depends on frequency: step '{}' is a motion in "
                        "time and takes its values at the frequency of the spin",
                        b.name, s.name),
            "true for synchronous motion; a motion at another frequency (subsynchronous whirl) "
            "sees other coefficients",
            b.where, Diagnostic::Severity::warning);
    if (table->extrapolate_hold) continue;
    for (const auto& s : m.steps) {
      if (const auto w = frequencies_of(m, s); w && !table->frequency.empty()) {
        const double least = table->frequency.front(), most = table->frequency.back();
        if (w->first < least - 1e-9 * most || w->second > most + 1e-9 * most)
          add(out, "E22",
              fmt::format(
                  "the table of bearing '{}' covers {} to {}, but step '{}' goes from {} to {}",
                  b.name, in_hertz(least), in_hertz(most), s.name, in_hertz(w->first),
                  in_hertz(w->second)),
              "extend the table, narrow the step, or write extrapolate = \"hold\"", b.where);
      }
      const auto range = speeds_of(m, s, b.at.shaft);
      if (!range) continue;
      // rounding of rpm to rad/s and back
      const double slack =
          1e-9 * std::max(std::abs(table->speed.front()), std::abs(table->speed.back()));
      if (range->first < table->speed.front() - slack ||
          range->second > table->speed.back() + slack)
        add(out, "E22",
            fmt::format(
                "the table of bearing '{}' covers {} to {}, but step '{}' goes from {} to {}",
                b.name, units::display(table->speed.front(), "rpm"),
                units::display(table->speed.back(), "rpm"), s.name,
                units::display(range->first, "rpm"), units::display(range->second, "rpm")),
            "extend the table, narrow the step, or write extrapolate = \"hold\"", b.where);
    }
  }
}

void check_drives(const model::Model& m, Problems& out) {
  for (std::size_t i = 0; i < m.drives.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const auto &a = m.drives[j], &b = m.drives[i];
      const bool both = std::holds_alternative<model::PrescribedSpin>(a.law) &&
                        std::holds_alternative<model::PrescribedSpin>(b.law);
      if (both && a.at.shaft == b.at.shaft && a.at.s == b.at.s &&
          (a.step.empty() || b.step.empty() || a.step == b.step))
        add(out, "E26",
            fmt::format("drives '{}' and '{}' both prescribe the spin of one station", a.name,
                        b.name),
            "keep one of the two, or give them different steps", b.where);
    }
}

/// A transient begins at the speed its drives prescribe: another one given for it contradicts.
/// (Where it goes on from another step the run says what jumps.)
void check_start_speeds(const model::Model& m, Problems& out) {
  for (const auto& s : m.steps) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    if (!t || !t->own_speed() || !s.from.empty() || !t->previous.empty()) continue;
    for (const auto& d : m.drives) {
      const auto* p = std::get_if<model::PrescribedSpin>(&d.law);
      if (!p || !p->angle || (!d.step.empty() && d.step != s.name) ||
          !m.shafts[d.at.shaft].rotating)
        continue;
      const double driven = p->angle->at(0.0).df,
                   wanted = *t->own_speed() * m.shafts[d.at.shaft].speed_ratio;
      if (std::abs(driven - wanted) <= 1e-6 * std::max(std::abs(driven), std::abs(wanted)))
        continue;
      add(out, "E26",
          fmt::format("step '{}' begins at {}, but drive '{}' prescribes {} at time 0", s.name,
                      units::display(wanted, "rpm"), d.name, units::display(driven, "rpm")),
          "leave initial_speed out, or let the drive's law begin at it", d.where);
    }
  }
}

/// Gears and couplings tie the speeds of two shafts together.
void check_speeds_of_pairs(const model::Model& m, Problems& out) {
  for (const auto& b : m.bearings) {
    const std::optional<model::ShaftPair> pair = *model::traits_of(b.law).pair;
    if (!pair || !b.to) continue;
    const auto &here = m.shafts[b.at.shaft], &there = m.shafts[b.to->shaft];
    const double ratio = pair->speed_ratio;
    const auto wrong = [ratio](double a, double c) {
      return std::abs(c - ratio * a) > 1e-6 * std::max(std::abs(c), std::abs(ratio * a));
    };
    const std::string ties =
        fmt::format("{} '{}'{}{} turns shaft '{}' at {}the speed of '{}'", pair->noun, b.name,
                    pair->details.empty() ? "" : " ", pair->details, there.name,
                    ratio == 1 ? std::string() : fmt::format("{:.6g} times ", ratio), here.name);
    if (!here.rotating || !there.rotating) {
      add(out, "E37",
          fmt::format("{} '{}' turns with its shafts, but shaft '{}' does not rotate", pair->noun,
                      b.name, here.rotating ? there.name : here.name),
          "rotating = true for that shaft, or a bearing of type \"linear\" between the two",
          b.where);
      continue;
    }
    if (wrong(here.speed_ratio, there.speed_ratio))
      add(out, "E37",
          fmt::format("{}, but their speed_ratio are {:.6g} and {:.6g}", ties, there.speed_ratio,
                      here.speed_ratio),
          fmt::format("speed_ratio = {:.10g} for shaft '{}'", ratio * here.speed_ratio + 0.0,
                      there.name),
          there.where);
    else if (wrong(here.spin0, there.spin0))
      add(out, "E37",
          fmt::format("{}, but their initial_spin are {} and {}", ties,
                      units::display(there.spin0, "rpm"), units::display(here.spin0, "rpm")),
          fmt::format("initial_spin = \"{}\" for shaft '{}'",
                      units::display(ratio * here.spin0 + 0.0, "rpm"), there.name),
          there.where);
    for (const auto& s : m.steps) {
      const auto* t = std::get_if<model::TransientStep>(&s.law);
      const auto *p = prescribed(m, b.at.shaft, &s), *q = prescribed(m, b.to->shaft, &s);
      if (!t || !p || !q) continue;
      bool said = false;
      for (int i = 0; i <= 200 && !said;
           ++i) {  // enough to see a law that does not follow the other
        const double time = t->duration * i / 200, a = p->angle->at(time).df,
                     c = q->angle->at(time).df;
        if (!wrong(a, c)) continue;
        add(out, "E37",
            fmt::format("{}, but the drives of step '{}' prescribe {} and {} at {:.4g} s", ties,
                        s.name, units::display(c, "rpm"), units::display(a, "rpm"), time),
            pair->mesh ? "prescribe the speed of one of the two: the other follows through the mesh"
                       : "prescribe the speed of one of the two: the other follows",
            b.where);
        said = true;
      }
    }
  }
}

void check_places(const model::Model& m, Problems& out) {
  const auto on_shaft = [&](const model::Location& at, const char* what) {
    if (at.housing >= 0)
      add(out, "E26", fmt::format("a {} cannot stand on the support of a bearing", what),
          "only probes and loads can", at.where);
  };
  for (const auto& d : m.disks)
    on_shaft(d.at, "disk");
  for (const auto& u : m.unbalances) {
    on_shaft(u.at, "unbalance");
    if (!u.to) continue;
    on_shaft(*u.to, "unbalance");
    if (u.to->shaft != u.at.shaft || !(u.to->s > u.at.s))
      add(out, "E26",
          "the end of an unbalance lies on another shaft or not to the right of its beginning",
          "'to' is a place further right on the shaft of 'at'", u.to->where);
  }
  for (const auto& d : m.drives)
    on_shaft(d.at, "drive");
  for (const auto& j : m.joints) {
    on_shaft(j.at, "joint");
    if (j.to) on_shaft(*j.to, "joint");
  }
  for (const auto& b : m.bearings) {
    on_shaft(b.at, "bearing");
    if (!b.to) continue;
    on_shaft(*b.to, "bearing");
    // forces on both sides are taken to meet in one point (gears: in one plane)
    const std::optional<model::ShaftPair> pair = *model::traits_of(b.law).pair;
    if (b.at.housing >= 0 || b.to->housing >= 0) continue;
    const Vec3 apart =
        m.shafts[b.to->shaft].position(b.to->s) - m.shafts[b.at.shaft].position(b.at.s);
    const double along = std::abs(apart.x()),
                 across = pair && pair->mesh ? 0.0 : apart.tail<2>().norm();
    if (along > 1e-3)
      add(out, "W05",
          fmt::format("the two places of '{}' are {:.5g} mm apart along x: its forces on both "
                      "shafts are not in line, and their couple is missing",
                      b.name, 1e3 * along),
          "check the origins of the shafts and the two places; a spacer is a section of one of the "
          "shafts",
          b.where, Diagnostic::Severity::warning);
    if (across > 1e-6)
      add(out, "W05",
          fmt::format("the two places of '{}' are {:.5g} mm apart across the shafts: that distance "
                      "has no effect",
                      b.name, 1e3 * across),
          pair ? "a misalignment is given by offset_y, offset_z, angle_y, angle_z"
               : "a set point of the springs is given by 'setpoint'",
          b.where, Diagnostic::Severity::warning);
  }
}

/// Torsion takes part in a step of small motions.
bool twists(const model::StepLaw& law) {
  return std::visit(
      [](const auto& s) {
        using T = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<T, model::StaticStep> ||
                      std::is_same_v<T, model::TransientStep> ||
                      std::is_same_v<T, model::CriticalMapStep>)
          return false;
        else if constexpr (requires { s.motion; })
          return s.motion == model::MotionKind::all || s.motion == model::MotionKind::torsional;
        else
          return true;
      },
      law);
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
    add(out, "W06",
        fmt::format("drive '{}' holds the twist of shaft '{}' at {} in step{} {}: torsional "
                    "motions are those of a shaft clamped there; the speed is that of the step",
                    d.name, m.shafts[d.at.shaft].name, d.at.text,
                    steps.find(',') == std::string::npos ? "" : "s", steps),
        "name the transient step it drives (step = \"..\") to leave the shaft free in the others",
        d.where, Diagnostic::Severity::warning);
  }
}

/// An axial preload is a force only between two places that hold the shaft along its axis.
void check_preloads(const model::Model& m, Problems& out) {
  for (std::size_t k = 0; k < m.shafts.size(); ++k) {
    if (m.shafts[k].axial_preload == 0) continue;
    std::set<double> places;
    for (const auto& b : m.bearings) {
      if (!(*model::traits_of(b.law).held)[0]) continue;
      if (b.at.shaft == k) places.insert(b.at.s);
      if (b.to && b.to->shaft == k) places.insert(b.to->s);
    }
    if (places.size() > 1) continue;
    add(out, "W02",
        fmt::format("axial_preload of shaft '{}' has no effect but its length: it relaxes, because "
                    "nothing holds the shaft along its axis at two places",
                    m.shafts[k].name),
        "axial_force is a force that pulls at the ends and stays", m.shafts[k].where,
        Diagnostic::Severity::warning);
  }
}

void check_effects(const model::Model& m, Problems& out) {
  const bool transient = std::any_of(m.steps.begin(), m.steps.end(), [](const model::Step& s) {
    return std::holds_alternative<model::TransientStep>(s.law);
  });
  const auto warn = [&](std::string what, const Where& w) {
    add(out, "W02", fmt::format("{} without effect: the deck has no transient step", what), "", w,
        Diagnostic::Severity::warning);
  };
  for (const auto& s : m.shafts) {
    if (transient && s.damping.loss_factor != 0 && s.damping.loss_frequency == 0)
      add(out, "W02",
          fmt::format("internal_loss_factor of shaft '{}' has no effect on transient steps: "
                      "hysteretic damping has no form in time",
                      s.name),
          "internal_loss_frequency = \"30 Hz\": viscous damping stands for it then that loses as "
          "much at this frequency, seen in rotating axes",
          s.where, Diagnostic::Severity::warning);
    for (const auto& x : s.sections)
      if (x.temperature_rise != 0 &&
          (x.constants || m.materials.empty() || m.materials.at(x.material).expansion == 0)) {
        add(out, "W02",
            fmt::format("temperature_rise of section '{}' has no effect: {}", x.name,
                        x.constants ? "its constants have no thermal expansion"
                                    : "its material has no 'expansion'"),
            "expansion = \"12e-6 1/K\" for steel", x.where, Diagnostic::Severity::warning);
        break;
      }
  }
  if (transient) return;
  if (!m.initial.empty()) warn("an initial motion", m.initial.front().where);
  const bool shapes = std::any_of(m.steps.begin(), m.steps.end(), [](const model::Step& s) {
    return std::holds_alternative<model::StaticStep>(s.law) ||
           std::holds_alternative<model::ModalStep>(s.law) ||
           std::holds_alternative<model::CriticalStep>(s.law) ||
           std::holds_alternative<model::UnbalanceStep>(s.law) ||
           std::holds_alternative<model::HarmonicStep>(s.law) ||
           std::holds_alternative<model::BucklingStep>(s.law);
  });
  if (shapes) return;
  for (const auto& o : m.output.vtk)
    if (o.step.empty()) warn("a picture output", o.where);
}

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
      add(out, "E26",
          fmt::format(
              "step '{}' starts from step '{}', but is linearised about the undeformed rotor",
              s.name, s.from),
          "leave out 'from', or about = \"equilibrium\"", s.where);
    if (const auto* stability = std::get_if<model::StabilityStep>(&s.law);
        stability && stability->map)
      add(out, "E26",
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
    for (const model::Bearing& b : m.bearings)
      if (model::traits_of(b.law).needs_load && !varied_film(b))
        add(out, "E26",
            fmt::format("step '{}' is linearised about the undeformed rotor, where bearing '{}' "
                        "carries no load: its stiffness is that of its load",
                        s.name, b.name),
            "about = \"equilibrium\", or a bearing of type \"linear\" or \"table\" in its place",
            s.where);
  }
}

}  // namespace

std::vector<WholeModelProblem> check_model(const model::Model& m) {
  Problems out;
  check_restraint(m, out);
  check_tables(m, out);
  check_linear(m, out);
  check_maps(m, out);
  check_drives(m, out);
  check_start_speeds(m, out);
  check_speeds_of_pairs(m, out);
  check_places(m, out);
  check_clamps(m, out);
  check_preloads(m, out);
  check_undeformed(m, out);
  check_effects(m, out);
  return out;
}

namespace {

/// Characters a number takes in CSV files, bytes in binary ones.
constexpr double csv_bytes = 20;
constexpr double binary_bytes = 8;

struct Interval {
  double begin = 0, end = 0;
  double length() const { return std::max(0.0, end - begin); }
};

Interval common(const Interval& a, double t0, double t1) {
  return {std::max(a.begin, t0), std::min(a.end, t1)};
}

/// When each transient step runs: one that starts from another goes on where that one ends.
std::map<std::string, Interval> times_of_steps(const model::Model& m) {
  std::map<std::string, Interval> r;
  for (const auto& s : m.steps) {
    const auto before = r.find(s.from);
    const double begin = before == r.end() ? 0.0 : before->second.end;
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    r[s.name] = {begin, begin + (t ? t->duration : 0.0)};
  }
  return r;
}

double count_of_nodes(const model::Model& m) {
  double sections = 0;
  const model::Resolution resolution = model::resolution_of(m);
  for (const auto& s : m.shafts)
    for (const auto& x : s.sections) {
      const double longest = model::longest_element(m, s, x, resolution);
      const double parts =
          std::isfinite(longest) ? std::min(1e6, std::ceil(x.length / longest)) : 1.0;
      sections += std::max<double>(x.min_elements, parts);
    }
  return sections + static_cast<double>(m.shafts.size() + m.disks.size() + m.bearings.size());
}

double count_of_columns(const model::Model& m) {
  double columns = 2 + static_cast<double>(m.shafts.size());
  for (const auto& p : m.probes)
    columns += p.angles.empty() ? 2 : static_cast<double>(p.angles.size());
  return columns + 3.0 * static_cast<double>(m.bearings.size()) + 6;
}

double bytes_of_pictures(const model::VtkOutput& o, const Interval& time, double nodes) {
  const Interval window = common(time, o.t0, o.t1);
  double frames = o.every > 0 ? window.length() / o.every : o.frames;
  if (o.every == 0 && o.frames_per_revolution > 0) frames = o.max_frames;
  frames = std::min<double>(frames, o.max_frames);
  const bool surface = std::find(o.content.begin(), o.content.end(), "surface") != o.content.end();
  // a centre-line node carries some 20 doubles; a surface point 12 floats and its share of
  // connectivity
  return frames * (nodes * 160 + (surface ? nodes * o.points_around * 80 : 0) + 4000);
}

}  // namespace

OutputEstimate estimate_output(const model::Model& m) {
  OutputEstimate e;
  const double nodes = count_of_nodes(m), columns = count_of_columns(m);
  const auto times = times_of_steps(m);
  double largest = 0;
  for (const auto& s : m.steps) {
    const auto* t = std::get_if<model::TransientStep>(&s.law);
    if (!t) continue;
    const Interval& time = times.at(s.name);
    // the adaptive step is not known beforehand, so only a given interval can be judged
    const double every = m.output.every > 0 ? m.output.every : t->integrator.dt;
    const double row =
        columns * ((m.output.csv ? csv_bytes : 0) + (m.output.binary ? binary_bytes : 0));
    const double before = e.total();
    if (every > 0) e.histories += common(time, m.output.t0, m.output.t1).length() / every * row;
    for (const auto& o : m.output.vtk)
      if (o.step.empty() || o.step == s.name) e.pictures += bytes_of_pictures(o, time, nodes);
    if (e.total() - before > largest) {
      largest = e.total() - before;
      e.where = s.where;
    }
  }
  // how long the speed or the amplitude stays inside its window is what the run is to find out
  const model::Output& o = m.output;
  e.at_most = o.speed_low > -infinity || o.speed_high < infinity || o.above > 0;
  return e;
}

std::string size_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.1f} MB", bytes / 1e6);
  if (bytes < 1e12) return fmt::format("{:.1f} GB", bytes / 1e9);
  return fmt::format("{:.1f} TB", bytes / 1e12);
}

std::vector<Diagnostic> check_output(const model::Model& m, double available) {
  const OutputEstimate e = estimate_output(m);
  const double sure = e.pictures + (e.at_most ? 0 : e.histories);
  if (sure <= available) return {};
  Diagnostic d;
  d.code = "E33";
  d.message = fmt::format(
      "the output would take about {} (histories {}, pictures {}), but only {} are free",
      size_text(e.total()), size_text(e.histories), size_text(e.pictures), size_text(available));
  d.hint = e.histories > e.pictures ? "write rows less often: output.every"
                                    : "ask for fewer frames or a window in [[output.vtk]]";
  d.where = e.where;
  return {d};
}

}  // namespace whirl::deck
