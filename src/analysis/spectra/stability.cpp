#include <analysis/spectra/stability.hpp>

#include <core/parallel.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <optional>

namespace whirl::analysis {

namespace {

/// Relative width of the bracket in which a change of the number of growing roots is isolated.
constexpr double no_width = 1e-10;
/// Relative distance within which onsets of roots next to zero are rounding's.
constexpr double near_by = 1e-7;
/// Of frequency and speed: two frequencies that merge grow like the square root of the bracket.
constexpr double axis_width = 2e-5;

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

SpeedVerdict verdict_of(double speed, const std::vector<WhirlMode>& modes,
                        const SpectrumCertificate& certificate) {
  SpeedVerdict v;
  v.speed = speed;
  v.certificate = certificate;
  for (const WhirlMode& m : modes) {
    if (m.oscillates() && m.growth() == 0) {
      ++v.neutral;
      v.neutral_within = std::max(v.neutral_within, m.rounding);
    }
    if (m.growth() <= 0) continue;
    ++(m.oscillates() ? v.whirling : v.diverging);
    v.growing += m.lambda.imag() != 0.0 ? 2 : 1;
    v.fastest = std::max(v.fastest, m.lambda.real());
  }
  return v;
}

/// Modes that grow at one end of a bracket and have nothing that grows at the other to continue: what
/// is left when each root there has taken the nearest one here.
struct Parted {
  WhirlMode mode;
  bool one_of_pair = false;  ///< a real root there is continued by the other of the pair
};
std::vector<Parted> parted(const std::vector<WhirlMode>& here,
                           const std::vector<WhirlMode>& there) {
  struct Root {
    Complex s;
    std::size_t mode;
  };
  const auto growing_roots = [](const std::vector<WhirlMode>& modes) {
    std::vector<Root> roots;
    for (std::size_t k = 0; k < modes.size(); ++k) {
      if (modes[k].growth() <= 0) continue;
      roots.push_back({modes[k].lambda, k});
      if (modes[k].lambda.imag() != 0.0) roots.push_back({std::conj(modes[k].lambda), k});
    }
    return roots;
  };
  std::vector<Root> left = growing_roots(here);
  for (const Root& r : growing_roots(there)) {
    const auto nearest = std::min_element(
        left.begin(), left.end(),
        [&r](const Root& a, const Root& b) { return std::abs(a.s - r.s) < std::abs(b.s - r.s); });
    if (nearest != left.end()) left.erase(nearest);
  }
  std::vector<Parted> fresh;
  for (std::size_t k = 0; k < here.size(); ++k) {
    const auto roots =
        std::count_if(left.begin(), left.end(), [k](const Root& r) { return r.mode == k; });
    if (roots > 0) fresh.push_back({here[k], roots == 1 && here[k].lambda.imag() != 0.0});
  }
  return fresh;
}

/// A search for onsets on its way over the speed.
class Sweep {
 public:
  Sweep(Linearizer& linear, const StabilityOptions& options)
      : options_(options),
        track_(track_options(options)),
        tracker_(linear, track_),
        follower_(linear, track_.modes),
        fresh_(linear, track_.modes) {}

  /// Goes on to a speed and finds the onsets on the way.
  const std::vector<TrackedMode>& advance(double speed) {
    const double from = tracker_.speed();
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
    const SpeedVerdict verdict = verdict_of(speed, now, tracker_.certificate());
    if (!verdicts.empty()) account(from, speed, verdicts.back(), verdict, before);
    verdicts.push_back(verdict);
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
    if (const auto root =
            find_on_mode(follower_, p.from, step.before, p.to, step.now, rate, options_.tolerance))
      onsets.push_back({root->speed, root->mode.frequency, gains, root->mode, true});
  }

  /// Onsets between two speeds that the modes followed do not account for are isolated by the
  /// number of growing roots. A pair of real roots that becomes an oscillating one, or the reverse,
  /// is no onset: both grow before and after.
  void account(double a, double b, const SpeedVerdict& va, const SpeedVerdict& vb,
               std::size_t first_onset) {
    Index change = vb.growing - va.growing + deferred_;
    for (std::size_t k = first_onset; k < onsets.size(); ++k)
      change -= onsets[k].gains ? 2 : -2;
    if (change == 0) return;
    onsets.resize(first_onset);
    isolate(a, b, va, vb);
    settle();
  }

  SpeedVerdict look_at(double speed) {
    modes_there_ = fresh_.solve(speed);
    return verdict_of(speed, modes_there_, fresh_.certificate());
  }

  void isolate(double a, double b, const SpeedVerdict& va, const SpeedVerdict& vb) {
    if (va.growing == vb.growing) return;
    const double least = 1e-6 * std::abs(track_.ahead.back() - track_.ahead.front());
    const double size = std::max({std::abs(a), std::abs(b), least});
    if (std::abs(b - a) <= no_width * size) return add_isolated(a, b, va, vb);
    const double middle = 0.5 * (a + b);
    const SpeedVerdict vm = look_at(middle);
    isolate(a, middle, va, vm);
    isolate(middle, b, vm, vb);
  }

  /// The roots that grow at one end of a bracket of no width only. Where both ends account for all
  /// that grows they crossed in it; else they may have come into the list from beyond it, growing.
  void add_isolated(double a, double b, const SpeedVerdict& va, const SpeedVerdict& vb) {
    const bool gains = vb.growing > va.growing;
    const double few = gains ? a : b, many = gains ? b : a;
    look_at(few);
    const std::vector<WhirlMode> there = modes_there_;
    look_at(many);
    const std::vector<Parted> fresh = parted(modes_there_, there);
    const bool all = va.certificate.stability_certain() && vb.certificate.stability_certain();
    const double at = 0.5 * (a + b);
    onsets.erase(std::remove_if(onsets.begin(), onsets.end(),
                                [&](const Onset& o) {
                                  return o.gains == gains &&
                                         std::abs(o.speed - at) <= 10 * no_width * std::abs(at);
                                }),
                 onsets.end());
    for (const Parted& p : fresh) {
      const WhirlMode& m = p.mode;
      const double frequency = p.one_of_pair ? 0.0 : m.frequency;
      if (grows_within_rounding(m, there))
        add_slow(p, few, many, gains);
      else if (all || starts_at_the_axis(m, few, many))
        onsets.push_back({at, frequency, gains, m, true});
      else if (gains)
        unplaced.push_back({many, m.frequency, m.lambda.real()});
    }
  }

  /// Its growth is there on the other side as well, but not told from rounding.
  static bool grows_within_rounding(const WhirlMode& m, const std::vector<WhirlMode>& there) {
    const double rate = m.lambda.real();
    return std::any_of(there.begin(), there.end(), [&](const WhirlMode& w) {
      return w.growth() == 0 && w.lambda.real() > 0.5 * rate &&
             std::abs(w.lambda - m.lambda) < rate;
    });
  }

  /// What leaves the band of rounding at `many`: it crosses the axis a little beyond `few`, or grows
  /// there as well.
  void add_slow(const Parted& p, double few, double many, bool gains) {
    const WhirlMode& m = p.mode;
    const bool real = p.one_of_pair || m.frequency == 0.0;
    const auto rate = [](double, const WhirlMode& x) { return x.lambda.real(); };
    const double away = (few > many ? 1.0 : -1.0) * std::abs(few);
    for (const double share : {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
      const double beyond = few + share * away;
      const auto there = follower_.follow(beyond, m);
      if (!there || there->lambda.real() >= 0.0) continue;
      const auto root = find_on_mode(follower_, beyond, *there, many, m, rate, options_.tolerance);
      if (root)
        onsets.push_back({root->speed, real ? 0.0 : root->mode.frequency, gains, root->mode, true});
      else
        onsets.push_back({many, real ? 0.0 : m.frequency, gains, m, true});
      return;
    }
    onsets.push_back({many, real ? 0.0 : m.frequency, gains, m, false});
  }

  /// Onsets against each other so near that the matrices' rounding parts them are what is left of
  /// them.
  void settle() {
    std::sort(onsets.begin(), onsets.end(),
              [](const Onset& x, const Onset& y) { return x.speed < y.speed; });
    for (std::size_t k = 0; k < onsets.size();) {
      const double width = near_by * std::abs(onsets[k].speed);
      std::size_t end = k + 1;
      bool opposed = false;
      for (; end < onsets.size() && onsets[end].speed - onsets[end - 1].speed <= width; ++end)
        opposed = opposed || onsets[end].gains != onsets[k].gains;
      if (!opposed) {
        k = end;
        continue;
      }
      const double low = onsets[k].speed - width, high = onsets[end - 1].speed + width;
      onsets.erase(onsets.begin() + static_cast<std::ptrdiff_t>(k),
                   onsets.begin() + static_cast<std::ptrdiff_t>(end));
      const SpeedVerdict at_low = look_at(low), at_high = look_at(high);
      if (at_low.growing == at_high.growing) continue;
      const std::size_t before = onsets.size();
      add_isolated(low, high, at_low, at_high);
      const auto added = onsets.begin() + static_cast<std::ptrdiff_t>(before);
      std::rotate(onsets.begin() + static_cast<std::ptrdiff_t>(k), added, onsets.end());
      k += onsets.size() - before;
    }
  }

  /// Within rounding and what merging frequencies grow by in the bracket; or growing with the
  /// distance from it, be it as its square root.
  bool starts_at_the_axis(const WhirlMode& m, double few, double many) {
    const double rate = m.lambda.real();
    if (rate <= std::max(axis_width * std::max(m.frequency, std::abs(many)), 4 * m.rounding))
      return true;
    look_at(many + 100 * (many - few));
    double nearest = infinity, further = 0;
    for (const WhirlMode& w : modes_there_) {
      const double away = std::abs(w.lambda - m.lambda);
      if (w.growth() <= 0 || away >= nearest) continue;
      nearest = away;
      further = w.lambda.real();
    }
    return rate <= 0.5 * further;
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
    if (verdicts.size() < 3) return;
    const std::size_t n = verdicts.size();
    if (!verdicts[n - 1].stable() || !verdicts[n - 2].stable() || !verdicts[n - 3].stable()) return;
    for (const TrackedMode& m : modes) {
      const std::vector<Vec2>& h = history_[m.id];
      if (h.size() < 3 || h[0][0] != verdicts[n - 3].speed) continue;
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
    const SpeedVerdict peak = look_at(speed);
    if (peak.stable()) return;
    const std::size_t n = verdicts.size();
    const bool late =
        (speed - verdicts[n - 2].speed) * (verdicts[n - 1].speed - verdicts[n - 2].speed) > 0;
    const SpeedVerdict &below = verdicts[late ? n - 2 : n - 3],
                       &above = verdicts[late ? n - 1 : n - 2];
    isolate(below.speed, speed, below, peak);
    isolate(speed, above.speed, peak, above);
    settle();
  }

  StabilityOptions options_;
  TrackOptions track_;
  ModeTracker tracker_;
  WhirlSolver follower_, fresh_;
  std::map<Index, Passage> passages_;  ///< by line
  /// Growing roots that left or entered the band of this step without an onset, and those whose onset
  /// is put into this step though they left before.
  Index deferred_ = 0;
  std::vector<WhirlMode> modes_there_;
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
  CampbellRecorder recorder(speeds);
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
