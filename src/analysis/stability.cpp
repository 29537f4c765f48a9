#include <analysis/stability.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// A growth rate below the rounding of the eigenvalue decides nothing.
bool unstable(const WhirlMode& m) { return m.lambda.real() > 1e-12 * std::abs(m.lambda); }

ModesOptions mode_options(const StabilityOptions& o) {
  ModesOptions m;
  m.count = o.modes, m.motion = o.motion;
  return m;
}

/// One sweep: onsets, and what `each` wants to see at the grid's speeds.
StabilityResult sweep(Linearizer& linear, const StabilityOptions& o,
                      const std::function<void(std::size_t, const std::vector<TrackedMode>&)>& each) {
  StabilityResult out;
  TrackOptions t;
  t.modes = mode_options(o);
  ModeTracker tracker(linear, t);
  WhirlSolver follower(linear, t.modes);
  std::vector<double> speeds = o.speeds;
  if (speeds.empty())
    for (Index k = 0; k <= o.grid; ++k) speeds.push_back(o.min_speed + (o.max_speed - o.min_speed) * static_cast<double>(k) / static_cast<double>(o.grid));
  CampbellRecorder recorder(speeds);
  const auto rate = [](double, const WhirlMode& w) { return w.lambda.real(); };
  const auto visit = [&](double a, double b, const std::vector<TrackedMode>& modes) {
    for (const TrackedMode& m : modes) {
      if (!m.has_before || m.now.frequency == 0.0 || unstable(m.before) == unstable(m.now)) continue;
      // From exactly undamped to unstable (a conservative mode gaining damping from rotation) there is no sign change to find.
      if ((m.before.lambda.real() > 0) == (m.now.lambda.real() > 0)) continue;
      if (const auto root = find_on_mode(follower, a, m.before, b, m.now, rate, o.tolerance))
        out.onsets.push_back({root->speed, root->mode.frequency, unstable(m.now), root->mode});
    }
  };
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    const auto& modes = tracker.advance(speeds[k], visit);
    recorder.take(k, modes, tracker.lines());
    if (k == 0)
      for (const TrackedMode& m : modes) out.stable_at_start = out.stable_at_start && !(unstable(m.now) && m.now.frequency > 0);
    if (each) each(k, modes);
    if (!each && !o.all && !out.onsets.empty()) break;
  }
  out.diagram = recorder.finish(tracker.speeds_solved());
  std::sort(out.onsets.begin(), out.onsets.end(), [](const Onset& a, const Onset& b) { return a.speed < b.speed; });
  return out;
}

}  // namespace

StabilityResult find_instability(Linearizer& linear, const StabilityOptions& options) { return sweep(linear, options, {}); }

StabilityMap stability_map(const std::function<system::System(double)>& build, const Running& running,
                           const std::vector<double>& parameter, const StabilityOptions& options) {
  StabilityMap map;
  map.parameter = parameter;
  map.speeds = options.speeds;
  for (Index k = 0; options.speeds.empty() && k <= options.grid; ++k)
    map.speeds.push_back(options.min_speed + (options.max_speed - options.min_speed) * static_cast<double>(k) / static_cast<double>(options.grid));
  for (double p : parameter) {
    const system::System system = build(p);
    Running r = running;
    for (const double Omega : map.speeds) r.top_speed = std::max(r.top_speed, std::abs(Omega));
    Linearizer linear(system, r);
    std::vector<double> least(map.speeds.size(), nan);
    const StabilityResult result = sweep(linear, options, [&](std::size_t k, const std::vector<TrackedMode>& modes) {
      for (const TrackedMode& m : modes)
        if (m.now.kind == ModeKind::lateral && m.now.frequency > 0 && !(least[k] <= m.now.log_decrement)) least[k] = m.now.log_decrement;
    });
    map.least_log_decrement.push_back(std::move(least));
    map.onset.push_back(result.stable_at_start ? nan : -infinity);
    map.frequency.push_back(nan);
    for (const Onset& o : result.onsets)
      if (o.gains && result.stable_at_start) {
        map.onset.back() = o.speed, map.frequency.back() = o.frequency;
        break;
      }
  }
  return map;
}

}  // namespace whirl::analysis
