#include <analysis/spectra/instability_bands.hpp>
#include <core/contract.hpp>

#include <analysis/search.hpp>
#include <la/eigen.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace whirl::analysis {

namespace {

struct Growth {
  double rate = 0, frequency = 0;
  std::optional<la::Mode> mode;
  double cut = 0;  ///< largest share of the last harmonic in one of the slowest motions
};

/// A speed and the growth there.
struct Visited {
  double speed = 0;
  Growth growth;
};

class BandSearch {
 public:
  BandSearch(RotatingAxes& axes, const BandOptions& o)
      : axes_(axes),
        solver_(axes.pattern(), axes.active(), options(axes, o)),
        of_mean_(options(axes, o)),
        tolerance_(o.tolerance),
        sense_(o.sense) {
    of_mean_.count = of_mean_.count > 0 ? o.modes : 0;
  }

  /// The motion that grows fastest, of all.
  Growth at(double Omega) {
    ++evaluations;
    const la::MCK& m = axes_.at(sense_ * Omega, Complex(0, infinity));
    Growth best{-infinity, 0, {}};
    if (!started_ && !axes_.constant()) solver_.start_from(axes_.motions_and_copies(of_mean_));
    started_ = true;
    const std::vector<la::Mode>& modes = solver_.solve(m);
    note_count(solver_.certificate());
    std::vector<std::pair<double, double>> cut;  // frequency, share of the last harmonic
    for (la::Mode x : modes) {
      if (!is_motion(x)) continue;
      settle(Omega, x);
      cut.emplace_back(std::abs(x.lambda.imag()), axes_.last_share(x.x));
      constexpr double rounding = 1e-12;  // of several that nothing damps the slowest
      if (x.lambda.real() > best.rate + rounding * std::abs(x.lambda)) best = growth_of(x);
    }
    best.cut = cut_of_slowest(std::move(cut));
    return best;
  }
  /// Faster motions meet copies of others in their last harmonics whatever the number of these.
  static double cut_of_slowest(std::vector<std::pair<double, double>> cut) {
    constexpr std::size_t slowest = 4;
    std::sort(cut.begin(), cut.end());
    double most = 0.0;
    for (std::size_t k = 0; k < std::min(slowest, cut.size()); ++k)
      most = std::max(most, cut[k].second);
    return most;
  }
  Visited visit(double Omega) { return {Omega, at(Omega)}; }
  /// The few motions nearest a frequency in rotating axes: a look that costs little.
  struct Near {
    bool grows = false;
    double gap = infinity;  ///< rad/s, between the two frequencies that are nearest to that
    double frequency = 0;   ///< rad/s, in the middle of them
  };
  Near look_near(double Omega, double frequency) {
    ++evaluations;
    la::ModeOptions l;
    l.count = 4;
    l.shift = Complex(0.0, frequency);
    la::ModeSolver solver(axes_.pattern(), axes_.active(), l);
    const std::vector<la::Mode>& modes = solver.solve(axes_.at(sense_ * Omega, l.shift.value()));
    Near out;
    std::vector<double> frequencies;
    for (const la::Mode& x : modes) {
      out.grows = out.grows || x.lambda.real() > noise(Omega);
      for (const double w : {x.lambda.imag(), -x.lambda.imag()})
        frequencies.push_back(w);
    }
    if (frequencies.size() < 2) return out;
    std::partial_sort(
        frequencies.begin(), frequencies.begin() + 2, frequencies.end(),
        [&](double a, double b) { return std::abs(a - frequency) < std::abs(b - frequency); });
    out.gap = std::abs(frequencies[0] - frequencies[1]);
    out.frequency = std::max(0.0, 0.5 * (frequencies[0] + frequencies[1]));
    return out;
  }
  /// A speed about a resonance at which something grows. The mean matrices place it but roughly: what varies
  /// moves frequencies by its square, and the gap that is left between two says how far it is away.
  /// @param low, high  speeds of the search: none beyond them
  std::optional<double> growing_about(const Resonance& r, double low, double high) {
    constexpr int rounds = 3;
    constexpr double beside = 0.1;  // of the speed
    const Near first = look_near(r.speed, r.frequency);
    if (first.grows) return r.speed;
    for (const double side : {1.0, -1.0}) {
      Near last = first;
      double Omega = r.speed;
      for (int k = 0; k < rounds; ++k) {
        Omega += side * last.gap / std::abs(r.slope);
        if (!(std::abs(Omega - r.speed) < beside * r.speed && Omega > low && Omega < high)) break;
        const Near now = look_near(Omega, last.frequency);
        if (now.grows) return Omega;
        if (!(now.gap < last.gap)) break;
        last = now;
      }
    }
    return std::nullopt;
  }
  /// The same motion as at a speed near by; where it cannot be followed, the fastest of all.
  Growth follow(double Omega, const Growth& near) {
    if (!near.mode) return at(Omega);
    ++evaluations;
    std::optional<la::Mode> x =
        solver_.follow(axes_.at(sense_ * Omega, Complex(0, infinity)), *near.mode);
    if (!x || !is_motion(*x)) return at(Omega);
    // copies lie a speed or two apart
    if (std::abs(x->lambda - near.mode->lambda) > 0.25 * std::abs(axes_.speed(Omega)))
      return at(Omega);
    settle(Omega, *x);
    return growth_of(*x);
  }

  /// Whether the fastest motion at one speed is that at another, and grows on the way, as far as a few looks
  /// can tell.
  bool is_one_motion(const Visited& a, const Visited& b) {
    if (!a.growth.mode || !b.growth.mode) return false;
    constexpr int steps = 4;
    la::Mode x = *a.growth.mode;
    for (int k = 1; k <= steps; ++k) {
      const double Omega = k < steps ? a.speed + (b.speed - a.speed) * k / steps : b.speed;
      ++evaluations;
      auto next = solver_.follow(axes_.at(sense_ * Omega, Complex(0, infinity)), x);
      if (!next || !is_motion(*next)) return false;
      x = std::move(*next);
      settle(Omega, x);
      if (!(x.lambda.real() > noise(Omega))) return false;
    }
    return is_copy(x.lambda, b.growth.mode->lambda, b.speed);
  }

  /// Whether two exponents are one, whatever multiple of what varies lies between them: which copy of a
  /// motion has the largest constant part changes with the speed.
  bool is_copy(Complex a, Complex b, double Omega) const {
    constexpr double equal = 1e-6, cut = 1e-3;  // copies are not cut alike
    const double W = std::abs(axes_.speed(Omega)), period = static_cast<double>(axes_.step()) * W;
    if (std::abs(a - b) < equal * W) return true;
    if (axes_.constant() || std::abs(a.real() - b.real()) > cut * std::abs(b.real())) return false;
    const auto is_multiple = [&](double difference) {
      return std::abs(difference - period * std::round(difference / period)) < cut * W;
    };
    return is_multiple(a.imag() - b.imag()) || is_multiple(a.imag() + b.imag());
  }

  /// The speed between a stable and an unstable one where the growth is zero. It crosses zero
  /// there, or, without damping, two frequencies merge and it rises as a square root from the
  /// rounding of a double eigenvalue. Neutral motions (growth zero at every speed) hide the
  /// crossing, so it is extrapolated from within the band.
  double edge(double stable, const Visited& unstable) {
    const double level = noise(unstable.speed);
    Visited from = unstable;
    Visited inner = from;
    Visited a = passage(stable, from, level, 1.001, &inner);
    if (!(at(a.speed).rate > 0.5 * level)) {  // not followed: found by looking at all
      inner = from;
      a = passage(stable, from, level, 1.001, &inner, true);
    }
    // Another motion may go on growing where the one followed has ceased to, or was lost where two meet.
    for (int round = 0; round < 8; ++round) {
      Visited outside{a.speed + 1e-4 * (stable - a.speed), {}};
      outside.growth = at(outside.speed);
      if (!(outside.growth.rate > 1.1 * level)) break;
      from = inner = outside;
      a = passage(stable, from, level, 1.001, &inner, true);
    }
    if (from.growth.rate < 4.0 * level) return a.speed;
    const Visited b = passage(a.speed, inner, 3.0 * level, 2.0);
    const double middle = 0.5 * (a.speed + b.speed);
    return extrapolate(a, {middle, follow(middle, b.growth)}, b);
  }
  /// Growth that says nothing.
  double noise(double Omega) const { return unnoticed_share(axes_) * std::abs(axes_.speed(Omega)); }
  Index evaluations = 0;
  Index counted = 0, uncounted = 0;  ///< calls of at() with and without a complete count
  double counted_to = infinity;      ///< rad/s, rotating axes, the least of all counts

 private:
  /// Damping that depends on the rate of each motion leaves no matrices whose roots could be counted.
  void note_count(const la::Certificate& c) {
    if (axes_.hysteretic() || !c.complete()) {
      ++uncounted;
      return;
    }
    ++counted;
    counted_to = std::min(counted_to, c.radius);
  }
  /// Neither a copy nor a rigid motion.
  bool is_motion(const la::Mode& x) const {
    return axes_.constant_share(x.x) >= 0.2 && std::abs(x.lambda) != 0.0;
  }
  static Growth growth_of(const la::Mode& x) {
    return {x.lambda.real(), std::abs(x.lambda.imag()), x, 0.0};
  }
  /// Hysteretic damping at the rate of the motion itself; a motion that stands in the rotor loses
  /// nothing.
  void settle(double Omega, la::Mode& x) {
    for (int round = 0; round < 40 && axes_.hysteretic() && x.lambda.imag() != 0.0; ++round) {
      const Complex rate = x.lambda;
      const auto next = solver_.follow(axes_.at(sense_ * Omega, rate), x);
      if (!next) break;
      x = *next;
      if (std::abs(x.lambda - rate) <= 1e-12 * std::abs(rate)) break;
    }
  }
  static double bend(double f0, double f1, double f2) {
    return std::abs(f2 - 2.0 * f1 + f0) / std::abs(f2 - f0);
  }
  /// The parabola of the speed over the growth, or over its square where that is straighter, at
  /// growth zero.
  static double extrapolate(const Visited& a, const Visited& middle, const Visited& b) {
    const double x[3] = {a.speed, middle.speed, b.speed};
    double r[3] = {a.growth.rate, middle.growth.rate, b.growth.rate};
    const bool root = bend(r[0] * r[0], r[1] * r[1], r[2] * r[2]) < bend(r[0], r[1], r[2]);
    if (root)
      for (double& v : r)
        v *= v;
    double zero = 0.0;
    for (int k = 0; k < 3; ++k) {
      const int p = (k + 1) % 3, q = (k + 2) % 3;
      zero += x[k] * r[p] * r[q] / ((r[k] - r[p]) * (r[k] - r[q]));
    }
    return std::abs(zero - x[0]) < std::abs(x[2] - x[0]) + 1e-6 * std::abs(x[0]) ? zero : x[0];
  }
  /// Where the growth passes this level, on the side where it is above, by less than the factor
  /// `close`. The motion followed may not exist beyond its band, so secants go through places
  /// within it alone, on the growth or its square by turns; what they do not bring into the
  /// bracket, or not nearer, is halved. inner: the last place met with three times that growth.
  /// all: nothing is followed, the fastest motion counts.
  Visited passage(double stable, Visited unstable, double level, double close,
                  Visited* inner = nullptr, bool all = false) {
    std::optional<Visited> before;
    bool halve = true;
    for (int k = 0; k < 60; ++k) {
      const double width = std::abs(unstable.speed - stable);
      if (unstable.growth.rate <= close * level) break;
      if (width <= tolerance_ * std::abs(unstable.speed)) break;
      double next = 0.5 * (stable + unstable.speed);
      if (before && !halve) {
        const double x = secant(*before, unstable, 0.5 * (1.0 + close) * level, k % 4 < 2);
        if ((x - stable) * (x - unstable.speed) < 0.0) next = x;
      }
      Visited there{next, all ? at(next) : follow(next, unstable.growth)};
      if (there.growth.rate > level) {
        if (inner && there.growth.rate >= 3.0 * level) *inner = there;
        before = unstable;
        unstable = std::move(there);
        halve = false;
      } else {
        stable = next;
        halve = !halve;
      }
    }
    return unstable;
  }
  static double secant(const Visited& a, const Visited& b, double level, bool squared) {
    const auto value = [squared](double r) { return squared ? r * r : r; };
    const double fa = value(a.growth.rate), fb = value(b.growth.rate);
    return b.speed + (b.speed - a.speed) * (value(level) - fb) / (fb - fa);
  }
  static la::ModeOptions options(const RotatingAxes& axes, const BandOptions& o) {
    la::ModeOptions l;
    l.count = o.modes * (2 * axes.harmonics() + 1);
    // of a light shaft that many would reach a thousand times the speed, each in copies close together
    const double reach = axes.reach(o.speeds.back());
    if (std::isfinite(reach)) {
      l.count = 0;
      l.max_frequency = reach;
    }
    l.certify = l.growing = true;
    return l;
  }
  RotatingAxes& axes_;
  la::ModeSolver solver_;
  la::ModeOptions of_mean_;
  bool started_ = false;  ///< the solver knows motions
  double tolerance_, sense_;
};

/// Between its ends the rotation takes stiffnesses: as many more or fewer are negative.
struct Seed {
  double low = 0, high = 0;
  Index at_low = 0, at_high = 0;
  double middle() const { return 0.5 * (low + high); }
  double width() const { return high - low; }
  bool narrow() const { return width() < 1e-7 * high; }
};

/// Halves a seed: the parts in which something changes take its place.
std::size_t halve(RotatingAxes& axes, double sense, std::vector<Seed>& seeds, std::size_t k) {
  const Seed s = seeds[k];
  const Index n = axes.negative_stiffnesses(sense * s.middle());
  std::vector<Seed> parts;
  if (n != s.at_low) parts.push_back({s.low, s.middle(), s.at_low, n});
  if (n != s.at_high) parts.push_back({s.middle(), s.high, n, s.at_high});
  seeds.erase(seeds.begin() + static_cast<std::ptrdiff_t>(k));
  seeds.insert(seeds.begin() + static_cast<std::ptrdiff_t>(k), parts.begin(), parts.end());
  return parts.size();
}

/// Zeros of the symmetric stiffness between neighbouring speeds, each to a thousandth of what is
/// between them: damping may leave a band no wider than a hundredth of that.
std::vector<double> zeros_of_stiffness(RotatingAxes& axes, double sense,
                                       const std::vector<double>& speeds) {
  std::vector<Seed> seeds;
  for (std::size_t k = 0; k + 1 < speeds.size(); ++k) {
    if (!(speeds[k] > 0.0)) continue;
    const Seed s{speeds[k], speeds[k + 1], axes.negative_stiffnesses(sense * speeds[k]),
                 axes.negative_stiffnesses(sense * speeds[k + 1])};
    if (s.at_low != s.at_high) seeds.push_back(s);
  }
  for (std::size_t k = 0; k < seeds.size();)
    if (std::abs(seeds[k].at_high - seeds[k].at_low) > 1 && !seeds[k].narrow())
      halve(axes, sense, seeds, k);
    else
      ++k;
  for (std::size_t k = 0; k + 1 < seeds.size();) {
    const Seed &a = seeds[k], &b = seeds[k + 1];
    const bool apart = b.middle() - a.middle() > 1e3 * (a.width() + b.width());
    const std::size_t wider = a.width() > b.width() ? k : k + 1;
    if (apart || seeds[wider].narrow())
      ++k;
    else if (halve(axes, sense, seeds, wider) != 1 || wider == k)
      k = k > 0 ? k - 1 : 0;
  }
  std::vector<double> zeros;
  for (const Seed& s : seeds)
    for (Index n = 0; n < std::abs(s.at_high - s.at_low); ++n)
      zeros.push_back(s.middle());
  return zeros;
}

/// The speeds asked for, and one within each stretch between seeds.
std::vector<double> list_speeds(RotatingAxes& axes, const BandOptions& o) {
  std::vector<double> speeds = o.speeds;
  const std::vector<double> edges = zeros_of_stiffness(axes, o.sense, o.speeds);
  for (std::size_t k = 0; k + 1 < edges.size(); ++k)
    if (edges[k + 1] - edges[k] > 1e-6 * edges[k])
      speeds.push_back(0.5 * (edges[k] + edges[k + 1]));
  std::sort(speeds.begin(), speeds.end());
  speeds.erase(std::unique(speeds.begin(), speeds.end()), speeds.end());
  return speeds;
}

/// The band of the samples first to last, which all grow while their neighbours do not.
InstabilityBand measure_band(BandSearch& search, const std::vector<Visited>& samples,
                             std::size_t first, std::size_t last) {
  InstabilityBand band;
  if (first > 0) band.low = search.edge(samples[first - 1].speed, samples[first]);
  if (last + 1 < samples.size()) band.high = search.edge(samples[last + 1].speed, samples[last]);
  std::size_t top = first;
  for (std::size_t j = first; j <= last; ++j)
    if (samples[j].growth.rate > samples[top].growth.rate) top = j;
  // the largest growth between the neighbours of the largest sample, where the band has ends
  const double a = top > first ? samples[top - 1].speed : band.low,
               b = top < last ? samples[top + 1].speed : band.high;
  const Visited& largest = samples[top];
  band.speed = largest.speed;
  if (std::isfinite(a) && std::isfinite(b))
    band.speed = find_maximum(a, largest.speed, largest.growth.rate, b, 1e-8, [&](double Omega) {
      return search.follow(Omega, largest.growth).rate;
    });
  const Growth g = search.at(band.speed);
  band.growth = g.rate;
  band.frequency = g.frequency;
  return band;
}

/// Parametric and combination resonances between the speeds looked at: those at which something grows
/// near one of the two motions are looked at as the others are.
/// Whether they could be.
bool visit_resonances(BandSearch& search, const RotatingAxes& axes, double sense,
                      std::vector<Visited>& samples) {
  std::vector<double> speeds(samples.size());
  std::transform(samples.begin(), samples.end(), speeds.begin(),
                 [](const Visited& v) { return v.speed; });
  const auto resonances = axes.resonances(speeds, sense);
  if (!resonances) return false;
  for (const Resonance& r : *resonances)
    if (const auto speed = search.growing_about(r, speeds.front(), speeds.back()))
      samples.push_back(search.visit(*speed));
  std::sort(samples.begin(), samples.end(),
            [](const Visited& x, const Visited& y) { return x.speed < y.speed; });
  return true;
}

/// Halves what lies between a speed at which something grows and a neighbour where nothing does, to a part of
/// the speed: other bands may lie between.
void narrow_edges(BandSearch& search, std::vector<Visited>& samples) {
  constexpr double near = 0.03;
  const auto grows = [&](const Visited& x) { return x.growth.rate > search.noise(x.speed); };
  for (std::size_t k = 0; k + 1 < samples.size();) {
    const double a = samples[k].speed, b = samples[k + 1].speed;
    if (grows(samples[k]) == grows(samples[k + 1]) || b - a <= near * b) {
      ++k;
      continue;
    }
    Visited middle = search.visit(0.5 * (a + b));
    // what is new on the left is looked at again
    samples.insert(samples.begin() + static_cast<std::ptrdiff_t>(k) + 1, std::move(middle));
  }
}

/// Growing neighbours belong to one band where one motion grows from one to the other; between others is
/// looked at, to a part of what lies between them.
void separate_bands(BandSearch& search, std::vector<Visited>& samples) {
  const auto grows = [&](const Visited& x) { return x.growth.rate > search.noise(x.speed); };
  constexpr int halvings = 7;
  std::vector<Visited> found;
  const auto look = [&](const auto& self, const Visited& a, const Visited& b, int left) -> void {
    if (left == 0 || !grows(a) || !grows(b) || search.is_one_motion(a, b)) return;
    Visited middle = search.visit(0.5 * (a.speed + b.speed));
    self(self, a, middle, left - 1);
    if (grows(middle)) self(self, middle, b, left - 1);
    found.push_back(std::move(middle));
  };
  for (std::size_t k = 0; k + 1 < samples.size(); ++k)
    look(look, samples[k], samples[k + 1], halvings);
  samples.insert(samples.end(), std::make_move_iterator(found.begin()),
                 std::make_move_iterator(found.end()));
  std::sort(samples.begin(), samples.end(),
            [](const Visited& x, const Visited& y) { return x.speed < y.speed; });
}

/// Two motions that have bands of their own, at their critical speeds, have one together halfway between
/// (a combination resonance), which may lie between the speeds looked at.
std::vector<InstabilityBand> combined_bands(BandSearch& search,
                                            const std::vector<InstabilityBand>& bands) {
  constexpr double aside = 0.02;  // of the way from a band to the place halfway
  std::vector<InstabilityBand> out;
  const auto visit = [&](double Omega) { return search.visit(Omega); };
  const auto grows = [&](const Visited& x) { return x.growth.rate > search.noise(x.speed); };
  const auto lies_in = [](double Omega) {
    return [Omega](const InstabilityBand& b) { return !(Omega < b.low) && !(Omega > b.high); };
  };
  for (std::size_t i = 0; i < bands.size(); ++i)
    for (std::size_t j = i + 1; j < bands.size(); ++j) {
      const double from = bands[i].high, to = bands[j].low;
      const double halfway = 0.25 * (bands[i].low + from + to + bands[j].high);
      if (!std::isfinite(halfway)) continue;
      if (std::any_of(bands.begin(), bands.end(), lies_in(halfway))) continue;
      if (std::any_of(out.begin(), out.end(), lies_in(halfway))) continue;
      const Visited middle = visit(halfway);
      if (!grows(middle)) continue;
      // the neighbours on both sides, whatever lies between the two
      double left = from, right = to;
      for (const InstabilityBand& b : bands) {
        if (b.high < halfway) left = std::max(left, b.high);
        if (b.low > halfway) right = std::min(right, b.low);
      }
      const std::vector<Visited> samples{visit(left + aside * (halfway - left)), middle,
                                         visit(right - aside * (right - halfway))};
      if (!grows(samples.front()) && !grows(samples.back()))
        out.push_back(measure_band(search, samples, 1, 1));
    }
  return out;
}

}  // namespace

double unnoticed_share(const RotatingAxes& axes) {
  // harmonics left out leave a false growth of some 1e-5 of the speed
  return axes.constant() ? 1e-6 : 3e-5;
}

double largest_growth(RotatingAxes& axes, double Omega, double fastest, Index modes) {
  BandOptions o;
  o.modes = modes;
  o.sense = Omega < 0.0 ? -1.0 : 1.0;
  o.speeds = {std::abs(fastest)};
  return BandSearch(axes, o).at(std::abs(Omega)).rate;
}

BandResult find_bands(RotatingAxes& axes, const BandOptions& o) {
  WHIRL_EXPECTS(o.modes > 0 && o.tolerance > 0.0);
  WHIRL_EXPECTS(std::is_sorted(o.speeds.begin(), o.speeds.end()));
  const std::vector<double> speeds = list_speeds(axes, o);
  BandSearch search(axes, o);
  BandResult out;
  std::vector<Visited> samples;
  for (const double Omega : speeds) {
    if (o.progress)
      o.progress(static_cast<double>(samples.size()) / static_cast<double>(speeds.size()), Omega);
    samples.push_back(search.visit(Omega));
  }
  if (!axes.constant()) out.sought_between = visit_resonances(search, axes, o.sense, samples);
  separate_bands(search, samples);
  if (!axes.constant()) {
    narrow_edges(search, samples);
    separate_bands(search, samples);
  }
  for (const Visited& v : samples) {
    out.speeds.push_back(v.speed);
    out.growth.push_back(v.growth.rate);
    out.frequency.push_back(v.growth.frequency);
    out.cut.push_back(v.growth.cut);
  }
  const auto grows = [&](std::size_t k) { return out.growth[k] > search.noise(out.speeds[k]); };
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (!grows(k)) continue;
    std::size_t last = k;
    while (last + 1 < samples.size() && grows(last + 1))
      ++last;
    if (o.progress) o.progress(1.0, out.speeds[k]);
    out.bands.push_back(measure_band(search, samples, k, last));
    k = last;
  }
  for (const InstabilityBand& band : combined_bands(search, out.bands))
    out.bands.push_back(band);
  std::sort(out.bands.begin(), out.bands.end(),
            [](const InstabilityBand& a, const InstabilityBand& b) { return a.speed < b.speed; });
  out.evaluations = search.evaluations;
  out.counted = search.counted;
  out.uncounted = search.uncounted;
  out.counted_to = search.counted_to;
  return out;
}

}  // namespace whirl::analysis
