// What a deck would write, and whether there is room for it.
#include <deck/deck.hpp>
#include <model/resolution.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace whirl::deck {

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
    e.open = e.open || (!(every > 0) && row > 0);
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
