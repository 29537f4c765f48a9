// The speeds and frequencies that the steps of a deck go through, and what they must agree with.
#include <deck/validate_parts.hpp>

#include <core/units.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::deck {

namespace {

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

}  // namespace

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
  if (const auto* x = std::get_if<model::SensitivityStep>(&s.law))
    return std::pair(x->speed * ratio, x->speed * ratio);
  if (const auto* x = std::get_if<model::BalancingStep>(&s.law)) {
    const auto [a, b] = std::minmax_element(x->speeds.begin(), x->speeds.end());
    return std::pair(std::min(*a * ratio, *b * ratio), std::max(*a * ratio, *b * ratio));
  }
  if (const auto* x = std::get_if<model::ApiLateralStep>(&s.law))
    return std::pair(std::min(x->min_speed * ratio, x->max_speed * ratio),
                     std::max(x->min_speed * ratio, x->max_speed * ratio));
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
  if (const auto* x = std::get_if<model::CriticalStep>(&s.law)) {
    // without min_speed the search begins where the tables do
    const double low = x->min_speed > 0 ? x->min_speed : x->max_speed;
    return std::pair(std::min(low * ratio, x->max_speed * ratio),
                     std::max(low * ratio, x->max_speed * ratio));
  }
  if (const auto* x = std::get_if<model::CriticalMapStep>(&s.law))
    return std::pair(x->max_speed * ratio, x->max_speed * ratio);
  return {};
}

namespace {

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
  const auto ends = [](const model::FrequencyRange& f) {
    return f.values.empty() ? std::pair(f.start, f.stop)
                            : std::pair(f.values.front(), f.values.back());
  };
  if (const auto* x = std::get_if<model::HarmonicStep>(&s.law)) {
    if (x->speeds) return speeds(*x->speeds, x->order);
    if (!x->frequency) return std::nullopt;
    return ends(*x->frequency);
  }
  if (const auto* x = std::get_if<model::SensitivityStep>(&s.law)) return ends(x->frequency);
  return std::nullopt;
}

}  // namespace

void check_tables(const model::Model& m, Problems& out) {
  for (const auto& b : m.bearings) {
    const auto* table = std::get_if<model::TableBearing>(&b.law);
    if (!table || table->speed.empty()) continue;
    for (const auto& s : m.steps)
      if (!table->frequency.empty() && std::holds_alternative<model::TransientStep>(s.law))
        report(
            out, "W03",
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
          report(out, "E22",
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
        report(out, "E22",
               fmt::format(
                   "the table of bearing '{}' covers {} to {}, but step '{}' goes from {} to {}",
                   b.name, units::display(table->speed.front(), "rpm"),
                   units::display(table->speed.back(), "rpm"), s.name,
                   units::display(range->first, "rpm"), units::display(range->second, "rpm")),
               "extend the table, narrow the step, or write extrapolate = \"hold\"", b.where);
    }
  }
}

namespace {

const model::PrescribedSpin* prescribes(const model::Drive& d) {
  const auto* p = std::get_if<model::PrescribedSpin>(&d.law);
  return p && p->angle ? p : nullptr;
}

bool acts_in(const model::Drive& d, const model::Step& s) {
  return d.step.empty() || d.step == s.name;
}

struct TimeSpan {
  double begin = 0, end = 0;
};

/// Times a transient runs through: they go on where it starts from another one.
TimeSpan times_run(const model::Model& m, const model::Step& s) {
  TimeSpan span;
  for (const auto& earlier : m.steps) {
    if (&earlier == &s) break;
    if (earlier.name == s.from) span.begin = times_run(m, earlier).end;
  }
  const auto* t = std::get_if<model::TransientStep>(&s.law);
  span.end = span.begin + (t ? t->duration : 0.0);
  return span;
}

/// Times at which two laws are compared: at equal distances and at their corners.
std::vector<double> times_to_compare(TimeSpan span, const model::PrescribedSpin& a,
                                     const model::PrescribedSpin& b) {
  constexpr int parts = 200;  // enough to see a law that does not follow the other
  std::vector<double> times;
  for (int i = 0; i <= parts; ++i)
    times.push_back(span.begin + (span.end - span.begin) * i / parts);
  for (const auto* law : {&a, &b})
    for (const double t : law->angle->breakpoints())
      if (t > span.begin && t < span.end) times.push_back(t);
  return times;
}

/// What two drives prescribe at a time, rad/s, where what is between them must not follow.
struct Contradiction {
  double time, first, second;
};

/// A shaft between two stations with prescribed angles takes the twist of a vibration, or that of a
/// test; it does not take a twist that grows: more than a radian in the step, or speeds that differ
/// all the time. sign: of the second's turning seen in the axis of the first.
std::optional<Contradiction> wound_up(const model::PrescribedSpin& a,
                                      const model::PrescribedSpin& b, double sign, TimeSpan span) {
  constexpr double most_twist = 1.0;  // rad
  constexpr double digits = 1e-6;     // to which written speeds agree
  const auto twist = [&](double t) { return sign * b.angle->at(t).f - a.angle->at(t).f; };
  const double at_start = twist(span.begin);
  std::optional<Contradiction> largest;
  bool above = true, below = true, too_far = false;
  for (const double t : times_to_compare(span, a, b)) {
    const double first = a.angle->at(t).df, second = sign * b.angle->at(t).df;
    const double slack = digits * std::max(std::abs(first), std::abs(second));
    above = above && second - first > slack;
    below = below && first - second > slack;
    too_far = too_far || std::abs(twist(t) - at_start) > most_twist;
    if (!largest || std::abs(second - first) > std::abs(largest->second - largest->first))
      largest = {t, first, second};
  }
  const bool apart = a.of_speed && b.of_speed && (above || below);
  return apart || too_far ? largest : std::nullopt;
}

/// The other of two ends of a joint that ties spins.
std::optional<std::size_t> tied_by(const model::Joint& j, std::size_t shaft) {
  const bool ties = j.kind == model::JointKind::rigid || j.kind == model::JointKind::slider ||
                    j.kind == model::JointKind::universal;
  if (!ties || !j.to) return std::nullopt;
  if (j.at.shaft == shaft) return j.to->shaft;
  if (j.to->shaft == shaft) return j.at.shaft;
  return std::nullopt;
}

/// Whether two shafts turn as one: the same, or tied by joints, over others too.
bool turn_as_one(const model::Model& m, std::size_t a, std::size_t b) {
  std::vector<std::size_t> reached{a};
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const model::Joint& j : m.joints) {
      const auto other = tied_by(j, reached[k]);
      if (!other || !m.shafts[*other].rotating) continue;
      if (std::find(reached.begin(), reached.end(), *other) == reached.end())
        reached.push_back(*other);
    }
  return std::find(reached.begin(), reached.end(), b) != reached.end();
}

void report_two_speeds(const model::Model& m, const model::Drive& a, const model::Drive& b,
                       const Contradiction& c, const std::string& step, Problems& out) {
  const std::string& first = m.shafts[a.at.shaft].name;
  const std::string& second = m.shafts[b.at.shaft].name;
  const std::string line =
      first == second ? fmt::format("shaft '{}'", first)
                      : fmt::format("shafts '{}' and '{}', which turn as one,", first, second);
  report(
      out, "E37",
      fmt::format("drives '{}' and '{}' prescribe {} and {} for {}{}: what is between them would "
                  "be wound up",
                  a.name, b.name, units::display(c.first, "rpm"), units::display(c.second, "rpm"),
                  line, step.empty() ? "" : fmt::format(" at {:.4g} s of step '{}'", c.time, step)),
      "prescribe the speed at one station: the rest follows; or give the drives different steps",
      b.where);
}

/// Two drives of one line of shafts that cannot both be followed: whether they are, and it is told.
bool contradict(const model::Model& m, const model::Drive& a, const model::Drive& b,
                Problems& out) {
  const auto *p = prescribes(a), *q = prescribes(b);
  if (!p || !q || !turn_as_one(m, a.at.shaft, b.at.shaft)) return false;
  if (!m.shafts[a.at.shaft].rotating) return false;  // told of each
  bool in_time = false;
  // lines that are tied may be drawn in opposite directions
  const bool same = a.at.shaft == b.at.shaft;
  for (const auto& s : m.steps) {
    const bool transient = std::holds_alternative<model::TransientStep>(s.law);
    if (!transient || !acts_in(a, s) || !acts_in(b, s)) continue;
    in_time = true;
    const TimeSpan span = times_run(m, s);
    const auto along = wound_up(*p, *q, 1.0, span);
    if (!along || (!same && !wound_up(*p, *q, -1.0, span))) continue;
    report_two_speeds(m, a, b, *along, s.name, out);
    return true;
  }
  if (in_time || !a.step.empty() || !b.step.empty()) return false;
  const auto along = wound_up(*p, *q, 1.0, {});
  if (!along || (!same && !wound_up(*p, *q, -1.0, {}))) return false;
  report_two_speeds(m, a, b, *along, "", out);
  return true;
}

/// A casing stands: a drive may twist it, not turn it.
void check_driven_casing(const model::Model& m, const model::Drive& d, Problems& out) {
  const auto* p = prescribes(d);
  const model::Shaft& casing = m.shafts[d.at.shaft];
  if (!p || casing.rotating) return;
  const model::PrescribedSpin still{make_constant(0.0), true};
  std::optional<Contradiction> turned;
  bool in_time = false;
  for (const auto& s : m.steps) {
    if (!std::holds_alternative<model::TransientStep>(s.law) || !acts_in(d, s)) continue;
    in_time = true;
    if (!turned) turned = wound_up(still, *p, 1.0, times_run(m, s));
  }
  if (!in_time && d.step.empty()) turned = wound_up(still, *p, 1.0, {});
  if (!turned) return;
  report(out, "E37",
         fmt::format("drive '{}' prescribes {} for shaft '{}', which does not rotate", d.name,
                     units::display(turned->second, "rpm"), casing.name),
         "rotating = true for that shaft, or the drive at a station of one that turns", d.where);
}

}  // namespace

void check_drives(const model::Model& m, Problems& out) {
  for (std::size_t i = 0; i < m.drives.size(); ++i) {
    const model::Drive& b = m.drives[i];
    check_driven_casing(m, b, out);
    for (std::size_t j = 0; j < i; ++j) {
      const model::Drive& a = m.drives[j];
      const bool both = std::holds_alternative<model::PrescribedSpin>(a.law) &&
                        std::holds_alternative<model::PrescribedSpin>(b.law);
      const bool one_station = a.at.shaft == b.at.shaft && a.at.s == b.at.s;
      const bool one_step = a.step.empty() || b.step.empty() || a.step == b.step;
      if (!both || !one_step) continue;
      if (one_station)
        report(out, "E26",
               fmt::format("drives '{}' and '{}' both prescribe the spin of one station", a.name,
                           b.name),
               "keep one of the two, or give them different steps", b.where);
      else if (contradict(m, a, b, out))
        break;  // one of the two it is at odds with is enough
    }
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
      report(out, "E26",
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
      report(out, "E37",
             fmt::format("{} '{}' turns with its shafts, but shaft '{}' does not rotate",
                         pair->noun, b.name, here.rotating ? there.name : here.name),
             "rotating = true for that shaft, or a bearing of type \"linear\" between the two",
             b.where);
      continue;
    }
    if (wrong(here.speed_ratio, there.speed_ratio))
      report(out, "E37",
             fmt::format("{}, but their speed_ratio are {:.6g} and {:.6g}", ties, there.speed_ratio,
                         here.speed_ratio),
             fmt::format("speed_ratio = {:.10g} for shaft '{}'", ratio * here.speed_ratio + 0.0,
                         there.name),
             there.where);
    else if (wrong(here.spin0, there.spin0))
      report(out, "E37",
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
        report(out, "E37",
               fmt::format("{}, but the drives of step '{}' prescribe {} and {} at {:.4g} s", ties,
                           s.name, units::display(c, "rpm"), units::display(a, "rpm"), time),
               pair->mesh
                   ? "prescribe the speed of one of the two: the other follows through the mesh"
                   : "prescribe the speed of one of the two: the other follows",
               b.where);
        said = true;
      }
    }
  }
}

/// Joints that leave no turning about the shafts' axis tie their speeds.
void check_speeds_of_joints(const model::Model& m, Problems& out) {
  for (const model::Joint& j : m.joints) {
    const bool ties = j.kind == model::JointKind::rigid || j.kind == model::JointKind::slider ||
                      j.kind == model::JointKind::universal;
    if (!ties || !j.to) continue;
    const auto &here = m.shafts[j.at.shaft], &there = m.shafts[j.to->shaft];
    if (!here.rotating || !there.rotating) continue;  // lines that stand: assembly
    const double a = std::abs(here.speed_ratio), c = std::abs(there.speed_ratio);
    if (std::abs(c - a) <= 1e-6 * std::max(a, c)) continue;
    report(
        out, "E37",
        fmt::format("joint '{}' turns shaft '{}' at the speed of '{}', but their speed_ratio are "
                    "{:.6g} and {:.6g}",
                    j.name, there.name, here.name, there.speed_ratio, here.speed_ratio),
        fmt::format("speed_ratio = {:.10g} for shaft '{}'", here.speed_ratio, there.name),
        there.where);
  }
}

}  // namespace whirl::deck
