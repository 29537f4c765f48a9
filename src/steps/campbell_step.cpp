// A Campbell step: natural frequencies and damping against speed, each line one mode, with the
// critical speeds on it.
#include <analysis/spectra/campbell.hpp>
#include <analysis/spectra/critical.hpp>
#include <model/resolution.hpp>
#include <results/frequency.hpp>
#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <run/progress.hpp>
#include <results/campbell_lines.hpp>
#include <steps/criticals_between.hpp>
#include <steps/step_kinds.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace whirl::steps {

namespace {

io::Table make_table(const analysis::Campbell& c) {
  io::Table t;
  t.title = "Campbell diagram";
  t.nan_means = "the mode is not there at this speed, or above those listed";
  t.nan_is_absence = true;
  t.columns.push_back({"speed", "rpm", ""});
  for (const analysis::CampbellLine& l : c.lines) {
    t.columns.push_back({l.label + " frequency", "Hz", "damped natural frequency"});
    t.columns.push_back({l.label + " log decrement", "-", ""});
    t.columns.push_back({l.label + " damping ratio", "-", ""});
    t.columns.push_back({l.label + " direction", "-", ""});
  }
  for (std::size_t k = 0; k < c.speeds.size(); ++k) {
    std::vector<io::Table::Cell> row{to_rpm(c.speeds[k])};
    for (const analysis::CampbellLine& l : c.lines) {
      row.emplace_back(to_hz(l.frequency[k]));
      row.emplace_back(results::tidy(l.log_decrement[k]));
      row.emplace_back(results::tidy(l.damping_ratio[k]));
      row.emplace_back(std::isnan(l.frequency[k]) ? std::string()
                                                  : std::string(to_string(l.direction_at[k])));
    }
    t.add(std::move(row));
  }
  return t;
}

io::Table empty_critical_table() {
  io::Table t;
  t.title = "Critical speeds";
  t.columns = {{"order", "-", "excitations a revolution"},
               {"speed", "rpm", ""},
               {"frequency", "Hz", ""},
               {"kind", "-", ""},
               {"direction", "-", ""},
               {"log decrement", "-", ""},
               {"damping ratio", "-", ""}};
  return t;
}

double highest_frequency(const analysis::Campbell& c) {
  double highest = 0;
  for (const analysis::CampbellLine& l : c.lines)
    for (double f : l.frequency)
      highest = std::max(highest, std::isnan(f) ? 0.0 : f);
  return highest;
}

bool rises(const std::vector<double>& speeds) {
  return std::is_sorted(speeds.begin(), speeds.end()) && speeds.front() < speeds.back();
}

/// Critical speeds of one order: those the lines of the diagram pass, and above the speeds where its
/// lists of modes reach the order line those of a search of its own.
std::vector<analysis::Critical> criticals_of(results::FrequencyStep& s,
                                             const analysis::CampbellOptions& o,
                                             analysis::CriticalOptions q,
                                             analysis::OrderCrossings* crossings) {
  std::vector<analysis::Critical> out;
  const double last = std::min(q.max_speed, q.max_frequency / q.order);
  double sure_to = 0.0;
  if (crossings != nullptr) {
    out = crossings->solve(s.linear, q.tolerance, q.threads);
    sure_to = std::min(crossings->sure_to(), last);
    std::erase_if(out, [&](const analysis::Critical& c) { return c.speed > sure_to; });
    if (sure_to >= last) return out;
    const auto above = std::upper_bound(o.speeds.begin(), o.speeds.end(), sure_to);
    q.grid = std::max<Index>(1, o.speeds.end() - above);
    q.min_speed = std::max(q.min_speed, sure_to);
  }
  if (q.min_speed >= last) return out;
  for (analysis::Critical& c : analysis::critical_speeds(s.linear, q))
    if (c.speed > sure_to) out.push_back(std::move(c));
  return out;
}

/// Intersections with the orders, solved for. crossings: one an order, or none.
std::vector<plot::CriticalMark> find_criticals(results::FrequencyStep& s,
                                               const model::CampbellStep& law,
                                               const analysis::CampbellOptions& o,
                                               const analysis::Campbell& c,
                                               std::vector<analysis::OrderCrossings>& crossings,
                                               io::Table& table) {
  std::vector<plot::CriticalMark> marks;
  for (std::size_t i = 0; i < law.orders.size(); ++i) {
    const double order = law.orders[i];
    analysis::CriticalOptions q;
    q.order = order;
    const double first = std::min(o.speeds.front(), o.speeds.back());
    const double last = std::max(o.speeds.front(), o.speeds.back());
    q.max_speed = last;
    q.min_speed = first;
    q.motion = o.track.modes.motion;
    q.damped = law.damped;
    q.grid = static_cast<Index>(o.speeds.size());
    q.max_frequency = highest_frequency(c);
    q.threads = s.job.options.jobs;
    analysis::OrderCrossings* known = crossings.empty() ? nullptr : &crossings[i];
    for (const analysis::Critical& k :
         first < 0.0 ? criticals_between(s, q, first, last) : criticals_of(s, o, q, known)) {
      marks.push_back({k.speed, k.frequency, order, {}});
      table.add({order, to_rpm(k.speed), to_hz(k.frequency), std::string(to_string(k.mode.kind)),
                 results::direction_text(k.mode), results::tidy(k.mode.log_decrement),
                 results::tidy(k.mode.damping_ratio)});
    }
  }
  return marks;
}

/// Of the modes asked for, at the last speed.
void report_mesh(results::FrequencyStep& s, const analysis::Campbell& c, Index asked) {
  std::span<const analysis::WhirlMode> modes = c.last;
  if (asked > 0) modes = modes.first(std::min(modes.size(), static_cast<std::size_t>(asked)));
  results::MeshAccuracy accuracy(s);
  accuracy.look_at(modes, c.speeds.back());
  accuracy.report();
}

bool any_damping(const analysis::Campbell& c) {
  return std::any_of(c.lines.begin(), c.lines.end(), [](const analysis::CampbellLine& l) {
    return std::any_of(l.log_decrement.begin(), l.log_decrement.end(),
                       [](double x) { return std::abs(x) > 1e-6; });
  });
}

/// Marks the lines that are among the `count` of least frequency at some speed.
std::vector<bool> listed_lines(const analysis::Campbell& c, std::size_t count) {
  std::vector<bool> listed(c.lines.size(), false);
  for (std::size_t k = 0; k < c.speeds.size(); ++k) {
    std::vector<std::size_t> there;
    for (std::size_t l = 0; l < c.lines.size(); ++l)
      if (!std::isnan(c.lines[l].frequency[k])) there.push_back(l);
    std::stable_sort(there.begin(), there.end(), [&](std::size_t a, std::size_t b) {
      return c.lines[a].frequency[k] < c.lines[b].frequency[k];
    });
    there.resize(std::min(there.size(), count));
    for (const std::size_t l : there)
      listed[l] = true;
  }
  return listed;
}

/// A line has no place at a speed: it was there at the one before or is there at the next, near the
/// end of a list that holds `count` others here.
bool is_cut(const analysis::Campbell& c, const analysis::CampbellLine& line, std::size_t count) {
  constexpr double near_the_end = 0.9;
  for (std::size_t k = 0; k < c.speeds.size(); ++k) {
    if (!std::isnan(line.frequency[k])) continue;
    const double before = k > 0 ? line.frequency[k - 1] : nan;
    const double after = k + 1 < c.speeds.size() ? line.frequency[k + 1] : nan;
    std::size_t there = 0;
    double highest = 0.0;
    for (const analysis::CampbellLine& other : c.lines)
      if (!std::isnan(other.frequency[k])) {
        ++there;
        highest = std::max(highest, other.frequency[k]);
      }
    const double own = std::isnan(before) ? after : before;
    if (there >= count && own >= near_the_end * highest) return true;
  }
  return false;
}

bool complete(const analysis::Campbell& c) {
  return std::all_of(c.certificates.begin(), c.certificates.end(),
                     [](const analysis::SpectrumCertificate& x) { return x.complete(); });
}

/// The diagram of the lines that belong to the modes asked for at some speed. Where one of them
/// would end or begin because others take its place in the list, the list is made longer, unless
/// that one cannot be certified.
analysis::Campbell follow_lines(Index asked,
                                const std::function<analysis::Campbell(Index count)>& follow) {
  Index count = asked;
  analysis::Campbell c = follow(count);
  if (asked <= 0) return c;
  for (int longer = 0; longer < 4; ++longer) {
    const std::vector<bool> listed = listed_lines(c, static_cast<std::size_t>(asked));
    bool cut = false;
    for (std::size_t l = 0; l < c.lines.size(); ++l)
      cut = cut || (listed[l] && is_cut(c, c.lines[l], static_cast<std::size_t>(count)));
    if (!cut) break;
    const Index more = count + std::max<Index>(4, asked / 2);
    analysis::Campbell longer_list = follow(more);
    if (complete(c) && !complete(longer_list)) {
      c = follow(count);
      break;
    }
    c = std::move(longer_list);
    count = more;
  }
  if (count == asked) return c;
  const std::vector<bool> listed = listed_lines(c, static_cast<std::size_t>(asked));
  std::vector<analysis::CampbellLine> kept;
  for (std::size_t l = 0; l < c.lines.size(); ++l)
    if (listed[l]) kept.push_back(std::move(c.lines[l]));
  c.lines = std::move(kept);
  return c;
}

}  // namespace

void run_campbell_step(run::Job& job, const model::Step& step, const model::CampbellStep& asked) {
  model::CampbellStep law = asked;
  law.orders = model::orders_of(job.model, asked.orders);
  analysis::CampbellOptions o;
  o.speeds = results::speeds_of(law.speed);
  o.track.modes.count = law.modes;
  o.track.modes.max_frequency = law.max_frequency;
  o.track.modes.motion = results::motion_of(law.motion);
  o.track.modes.damped = law.damped;
  o.track.threads = job.options.jobs;
  const double top = std::max(std::abs(o.speeds.front()), std::abs(o.speeds.back()));
  results::FrequencyStep s(job, step, "campbell", "Campbell diagram", top);
  // At standstill every rotor that turns freely has the frequency 0 = n x 0: no critical speed.
  const double lowest = o.speeds.front() > 0 ? o.speeds.front() : 1e-3 * top;
  std::vector<analysis::OrderCrossings> crossings;
  const auto visit = [&](double from, double to, const std::vector<analysis::TrackedMode>& modes) {
    for (analysis::OrderCrossings& order : crossings)
      order.look(from, to, modes);
  };
  const analysis::Campbell c = [&] {
    const run::PhaseTimer timer(job, "Campbell diagram");
    return follow_lines(law.modes, [&](Index count) {
      analysis::CampbellOptions longer = o;
      longer.track.modes.count = count;
      crossings.clear();
      if (law.damped && o.speeds.front() >= 0 && rises(o.speeds))
        for (const double order : law.orders)
          crossings.emplace_back(order, lowest, top, longer.track.modes);
      return analysis::campbell(s.linear, longer, visit);
    });
  }();
  io::Table criticals = empty_critical_table();
  std::vector<plot::CriticalMark> marks;
  const bool a_range = top > 0 && o.speeds.front() != o.speeds.back();
  if (a_range) {
    const run::PhaseTimer timer(job, "critical speeds");
    marks = find_criticals(s, law, o, c, crossings, criticals);
  }
  const std::size_t found = marks.size();

  io::Value& v = s.summary();
  v["modes"] = c.lines.size();
  v["speeds"] = c.speeds.size();
  v["speeds solved"] = c.speeds_solved;
  for (const plot::CriticalMark& m : marks)
    v["critical speeds [rpm]"][fmt::format("{:g}x", m.order)].push(to_rpm(m.speed));
  report_mesh(s, c, law.modes);
  results::warn_of_tables(job, step.name, o.speeds.front(), o.speeds.back());
  s.add_table("campbell", make_table(c), false);
  s.add_table("critical_speeds", std::move(criticals));
  const std::vector<plot::CampbellLine> lines = results::drawn_lines(c);
  s.add_figure(
      plot::plot_campbell(s.file("campbell"), "Campbell diagram", lines, law.orders, marks));
  if (any_damping(c))
    s.add_figure(
        plot::plot_stability(s.file("log_decrement"), "Log decrement of the modes", lines));
  s.section.text = fmt::format(
      "{} modes followed over {} speeds. Critical speeds are solved for, not read off the diagram.",
      c.lines.size(), c.speeds.size());
  std::size_t weakest = 0;
  for (std::size_t k = 1; k < c.certificates.size(); ++k)
    if (!c.certificates[k].complete() && c.certificates[weakest].complete()) weakest = k;
  s.certify(c.certificates[weakest], fmt::format("at {:.6g} rpm", to_rpm(c.speeds[weakest])));
  s.section.text += c.certificates[weakest].complete()
                        ? " At every speed the roots were counted: the list of modes is complete."
                        : " " + results::capital(c.certificates[weakest].text()) + ".";
  const std::string searched = a_range ? fmt::format(", {} critical speeds", found) : "";
  s.finish(fmt::format("{} modes at {} speed{}{}", c.lines.size(), c.speeds.size(),
                       c.speeds.size() == 1 ? "" : "s", searched));
}

}  // namespace whirl::steps
