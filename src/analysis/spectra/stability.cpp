#include <analysis/spectra/onset_isolation.hpp>
#include <analysis/spectra/stability.hpp>

#include <core/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <optional>

namespace whirl::analysis {

namespace {

ModesOptions mode_options(const StabilityOptions& o) {
  ModesOptions m;
  m.count = o.modes;
  m.motion = o.motion;
  m.real_roots = true;
  m.judge = true;
  return m;
}

std::vector<double> speeds_of(const StabilityOptions& o) {
  if (!o.speeds.empty()) return o.speeds;
  std::vector<double> speeds;
  for (Index k = 0; k <= o.grid; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(o.grid);
    speeds.push_back(o.min_speed + (o.max_speed - o.min_speed) * share);
  }
  return speeds;
}

TrackOptions track_options(const StabilityOptions& o) {
  TrackOptions t{mode_options(o)};
  t.ahead = speeds_of(o);
  // A search that ends at the first onset should not have gone far beyond it.
  if (!o.all) t.at_once = 2 * ModesAhead::run_length;
  t.threads = o.threads;
  return t;
}

/// A search for onsets on its way over the speed.
class Sweep {
 public:
  Sweep(Linearizer& linear, const StabilityOptions& options)
      : options_(options),
        track_(track_options(options)),
        tracker_(linear, track_),
        isolation_(linear, track_.modes, track_.ahead.back() - track_.ahead.front(),
                   options.tolerance) {}

  /// Goes on to a speed and finds the onsets on the way.
  const std::vector<TrackedMode>& advance(double speed) {
    const std::size_t before = onsets.size();
    deferred_ = 0;
    const auto visit = [&](double a, double b, const std::vector<TrackedMode>& modes) {
      for (const TrackedMode& m : modes)
        visit_mode(a, b, m);
    };
    const auto& modes = tracker_.advance(speed, visit);
    std::vector<WhirlMode> now;
    now.reserve(modes.size());
    for (const TrackedMode& m : modes)
      now.push_back(m.now);
    looks_.emplace_back(speed, std::move(now), tracker_.certificate());
    if (looks_.size() > 3) looks_.pop_front();
    verdicts.push_back(looks_.back().verdict);
    if (looks_.size() > 1) account(looks_[looks_.size() - 2], looks_.back(), before);
    look_between(modes);
    return modes;
  }

  std::vector<Onset> onsets;
  std::vector<SpeedVerdict> verdicts;
  std::vector<Unplaced> unplaced;
  ModeTracker& tracker() { return tracker_; }

 private:
  /// A line on its way through the band in which its growth cannot be told from rounding.
  struct Passage {
    int definite = 0;      ///< last growth() that was not neutral
    bool leaving = false;  ///< grew beyond the band, and is in it without having crossed zero
    std::optional<TrackedMode> crossing;  ///< the step of its last change of sign
    double from = 0, to = 0;              ///< speeds of that step
  };

  /// An onset is where the growth is zero, once it has been beyond the band on both sides: what is
  /// known of rounding is a bound that depends on the mesh, its zero is not.
  void visit_mode(double a, double b, const TrackedMode& m) {
    if (!m.has_before || !m.now.oscillates() || !m.before.oscillates()) {
      if (passages_[m.id].leaving) deferred_ -= 2;
      passages_.erase(m.id);
      return;
    }
    Passage& p = passages_[m.id];
    if (m.before.growth() != 0) p.definite = m.before.growth();
    const bool crosses = (m.before.lambda.real() > 0) != (m.now.lambda.real() > 0);
    if (crosses) {
      p.crossing = m;
      p.from = a;
      p.to = b;
    }
    const int now = m.now.growth();
    if (p.leaving && (now > 0 || crosses)) {
      p.leaving = false;
      deferred_ -= 2;
      if (now <= 0) add_crossing(p, false);
    } else if (m.before.growth() > 0 && now <= 0) {
      if (crosses) {
        add_crossing(p, false);
      } else {
        p.leaving = true;
        deferred_ += 2;
      }
    } else if (m.before.growth() <= 0 && now > 0 && p.crossing && (crosses || p.definite < 0)) {
      // From exactly undamped to unstable (a conservative mode gaining damping from rotation) there
      // is no change of sign to find.
      add_crossing(p, true);
    }
    if (now != 0) {
      p.definite = now;
      p.crossing.reset();
    }
  }

  void add_crossing(Passage& p, bool gains) {
    const auto rate = [](double, const WhirlMode& w) { return w.lambda.real(); };
    const TrackedMode step = *p.crossing;
    p.crossing.reset();
    if (const auto root = find_on_mode(isolation_.follower(), p.from, step.before, p.to, step.now,
                                       rate, options_.tolerance))
      onsets.push_back({root->speed, root->mode.frequency, gains, root->mode, true});
  }

  /// Onsets between two speeds that the modes followed do not account for are isolated by the
  /// number of growing roots. A pair of real roots that becomes an oscillating one, or the reverse,
  /// is no onset: both grow before and after.
  void account(const Look& a, const Look& b, std::size_t first_onset) {
    Index change = b.verdict.growing - a.verdict.growing + deferred_;
    for (std::size_t k = first_onset; k < onsets.size(); ++k)
      change -= onsets[k].gains ? 2 : -2;
    if (change == 0) return;
    onsets.resize(first_onset);
    take(isolation_.between(a, b));
  }

  /// What an interval looked at before gave again stands once.
  void take(OnsetIsolation::Found found) {
    std::erase_if(onsets, [&found](const Onset& old) {
      return std::any_of(found.onsets.begin(), found.onsets.end(), [&old](const Onset& o) {
        return o.gains == old.gains && std::abs(o.speed - old.speed) <= 1e-9 * std::abs(o.speed);
      });
    });
    onsets.insert(onsets.end(), found.onsets.begin(), found.onsets.end());
    unplaced.insert(unplaced.end(), found.unplaced.begin(), found.unplaced.end());
  }

  /// A growth ratio that bends towards zero between three speeds is looked at where the parabola
  /// through them is highest.
  void look_between(const std::vector<TrackedMode>& modes) {
    for (const TrackedMode& m : modes) {
      std::vector<Vec2>& h = history_[m.id];
      const double size = std::abs(m.now.lambda);
      h.push_back({verdicts.back().speed, size > 0 ? m.now.lambda.real() / size : 0.0});
      if (h.size() > 3) h.erase(h.begin());
    }
    if (looks_.size() < 3) return;
    if (!std::all_of(looks_.begin(), looks_.end(),
                     [](const Look& look) { return look.verdict.stable(); }))
      return;
    for (const TrackedMode& m : modes) {
      const std::vector<Vec2>& h = history_[m.id];
      if (h.size() < 3 || h[0][0] != looks_.front().speed()) continue;
      const auto peak = vertex(h);
      if (!peak || peak->second < 0.3 * h[1][1])
        continue;  // does not come much nearer to zero than the middle one
      look_at_peak(peak->first);
    }
  }

  static std::optional<std::pair<double, double>> vertex(const std::vector<Vec2>& h) {
    const double x0 = h[0][0] - h[1][0], x2 = h[2][0] - h[1][0];
    const double s0 = (h[0][1] - h[1][1]) / x0, s2 = (h[2][1] - h[1][1]) / x2;
    const double bend = (s2 - s0) / (x2 - x0);
    const double slope = s0 - bend * x0;
    if (!(bend < 0.0)) return std::nullopt;
    const double x = -0.5 * slope / bend;
    if (!(x > std::min(x0, x2) && x < std::max(x0, x2)) || x == 0.0) return std::nullopt;
    return std::pair(h[1][0] + x, h[1][1] + slope * x + bend * x * x);
  }

  void look_at_peak(double speed) {
    const Look peak = isolation_.look_at(speed);
    if (peak.verdict.stable()) return;
    const bool late = speed > looks_[1].speed();
    take(isolation_.between(looks_[late ? 1 : 0], peak));
    take(isolation_.between(peak, looks_[late ? 2 : 1]));
  }

  StabilityOptions options_;
  TrackOptions track_;
  ModeTracker tracker_;
  OnsetIsolation isolation_;
  std::deque<Look> looks_;             ///< the last three
  std::map<Index, Passage> passages_;  ///< by line
  /// Growing roots that left or entered the band of this step without an onset, and those whose onset
  /// is put into this step though they left before.
  Index deferred_ = 0;
  std::map<Index, std::vector<Vec2>>
      history_;  ///< by line: speed and growth ratio of the last three
};

/// One sweep: onsets, and what `each` wants to see at the grid's speeds.
StabilityResult sweep(
    Linearizer& linear, const StabilityOptions& o,
    const std::function<void(std::size_t, const std::vector<TrackedMode>&)>& each) {
  StabilityResult out;
  Sweep search(linear, o);
  const std::vector<double> speeds = speeds_of(o);
  CampbellRecorder recorder(speeds, o.shapes);
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    const auto& modes = search.advance(speeds[k]);
    std::vector<TrackedMode> oscillating;
    for (const TrackedMode& m : modes)
      if (m.now.oscillates()) oscillating.push_back(m);
    recorder.take(k, oscillating, search.tracker().lines());
    if (each) each(k, oscillating);
    const bool found = !search.onsets.empty() || !search.unplaced.empty();
    if (!each && !o.all && found) break;
  }
  out.verdicts = std::move(search.verdicts);
  out.stable_at_start = out.verdicts.front().stable();
  out.onsets = std::move(search.onsets);
  out.unplaced = std::move(search.unplaced);
  out.diagram = recorder.finish(search.tracker().speeds_solved());
  std::sort(out.onsets.begin(), out.onsets.end(),
            [](const Onset& a, const Onset& b) { return a.speed < b.speed; });
  return out;
}

}  // namespace

std::optional<Unplaced> StabilityResult::unannounced() const {
  if (!stable_at_start) return std::nullopt;
  double limit = infinity;
  for (const Onset& o : onsets)
    if (o.gains) limit = std::min(limit, o.speed);
  std::optional<Unplaced> first;
  const auto take = [&](const Unplaced& seen) {
    if (seen.speed < limit && (!first || seen.speed < first->speed)) first = seen;
  };
  for (const SpeedVerdict& v : verdicts)
    if (!v.stable()) take({v.speed, nan, v.fastest});
  for (const Unplaced& u : unplaced)
    take(u);
  return first;
}

StabilityResult find_instability(Linearizer& linear, const StabilityOptions& options) {
  return sweep(linear, options, {});
}

StabilityMap stability_map(const std::function<system::System(double)>& build,
                           const SteadyRotation& running, const std::vector<double>& parameter,
                           const StabilityOptions& options) {
  StabilityMap map;
  map.parameter = parameter;
  map.speeds = speeds_of(options);
  const std::size_t count = parameter.size();
  map.least_log_decrement.resize(count);
  map.onset.resize(count);
  map.frequency.assign(count, nan);
  StabilityOptions one_thread = options;
  one_thread.threads = 1;
  std::mutex building;
  std::vector<unsigned char> certain(count), placed(count, true);
  run_side_by_side(count, options.threads, [&](std::size_t p) {
    const system::System system = [&] {
      const std::lock_guard lock(building);
      return build(parameter[p]);
    }();
    SteadyRotation r = running;
    for (const double Omega : map.speeds)
      r.top_speed = std::max(r.top_speed, std::abs(Omega));
    Linearizer linear(system, r);
    std::vector<double> least(map.speeds.size(), nan);
    const StabilityResult result =
        sweep(linear, one_thread, [&](std::size_t k, const std::vector<TrackedMode>& modes) {
          for (const TrackedMode& m : modes)
            if (m.now.kind == ModeKind::lateral && m.now.frequency > 0 &&
                !(least[k] <= m.now.log_decrement))
              least[k] = m.now.log_decrement;
        });
    map.least_log_decrement[p] = std::move(least);
    certain[p] = result.certain();
    map.onset[p] = result.stable_at_start ? nan : -infinity;
    if (const auto seen = result.unannounced()) {
      map.onset[p] = seen->speed;
      placed[p] = false;
      return;
    }
    for (const Onset& o : result.onsets)
      if (o.gains && result.stable_at_start) {
        map.onset[p] = o.speed;
        map.frequency[p] = o.frequency;
        break;
      }
  });
  map.certain.assign(certain.begin(), certain.end());
  map.placed.assign(placed.begin(), placed.end());
  return map;
}

}  // namespace whirl::analysis
