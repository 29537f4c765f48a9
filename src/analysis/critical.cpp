#include <analysis/critical.hpp>

#include <core/error.hpp>
#include <la/block_lu.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {
constexpr std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Undamped: counts the negative eigenvalues of S(Omega).
class Counter {
 public:
  Counter(Linearizer& linear, const CriticalOptions& o)
      : linear_(linear), options_(o), motion_(linear.system(), o.motion),
        lu_(linear.system().pattern(), motion_.active()) {}
  Index count(double Omega) { return count(Omega, options_.order * Omega); }
  /// tables: frequency of supports tabulated against it.
  Index count(double Omega, double tables) {
    const double w = options_.order * Omega;
    const la::MCK& m = matrices(Omega, tables);
    // exactly on an eigenvalue: look beside it
    if (lu_.factor(m, Complex(-w * w, 0), Complex(0, w), Complex(1, 0)) != la::Status::ok) return count(Omega * (1 + 1e-12), tables);
    return lu_.negative_eigenvalues();
  }
  std::span<const unsigned char> active() const { return motion_.active(); }
  const la::MCK& matrices(double Omega, double tables) { return motion_.reduce(linear_.conservative_at(Omega, tables)); }

 private:
  Linearizer& linear_;
  CriticalOptions options_;
  MotionReduction motion_;
  la::BlockLu<Complex> lu_;
};

struct Bracket { double a, b; Index na, nb; };

/// Halves brackets until each holds one change, or changes that cannot be told apart (a double root).
void isolate(Counter& counter, const Bracket& k, double scale, std::vector<Bracket>& out) {
  const Index changes = std::abs(k.nb - k.na);
  if (changes == 0) return;
  // one root: until it lies within 1e-3, so that the nearest eigenvalue is the right one; several: until 1e-6
  const double width = k.b - k.a;
  if (width < (changes == 1 ? 1e-3 : 1e-6) * k.b) {
    out.push_back(k);
    return;
  }
  const double middle = 0.5 * (k.a + k.b);
  const Index n = counter.count(middle);
  isolate(counter, {k.a, middle, k.na, n}, scale, out);
  isolate(counter, {middle, k.b, n, k.nb}, scale, out);
}

std::vector<Critical> undamped(Linearizer& linear, const CriticalOptions& o, double low) {
  Counter counter(linear, o);
  std::vector<Bracket> brackets;
  double a = low;
  Index na = counter.count(a);
  std::vector<double> grid;
  for (Index k = 1; k <= o.grid; ++k) grid.push_back(low + (o.max_speed - low) * static_cast<double>(k) / static_cast<double>(o.grid));
  // Coefficients against frequency can raise a mode through n Omega (own_frequency.hpp: left out) near where it comes down: apart at the rows.
  const std::vector<double>& rows = linear.running().running().table_frequencies;
  for (const double w : rows)
    if (w > o.order * low && w < o.order * o.max_speed) grid.push_back(w / o.order);
  std::sort(grid.begin(), grid.end());
  for (const double b : grid) {
    const Index nb = counter.count(b);
    isolate(counter, {a, b, na, nb}, o.max_speed, brackets);
    a = b, na = nb;
  }
  ModesOptions mo;
  mo.damped = false, mo.motion = o.motion;
  WhirlSolver follower(linear, mo);
  std::vector<Critical> out;
  for (const Bracket& k : brackets) {
    const double middle = 0.5 * (k.a + k.b);
    if (!rows.empty() && k.nb < k.na && counter.count(k.b, o.order * middle) >= counter.count(k.a, o.order * middle)) continue;   // the table raised it
    const Index wanted = std::abs(k.nb - k.na);
    // The modes of the bracket's middle nearest to i n Omega.
    const la::MCK& m = counter.matrices(middle, o.order * middle);
    la::ModeOptions lo;
    lo.count = wanted + 2;
    lo.shift = Complex(0, o.order * middle);
    std::vector<la::Mode> near = la::quadratic_modes(m, counter.active(), lo);
    std::sort(near.begin(), near.end(), [&](const la::Mode& x, const la::Mode& y) {
      return std::abs(x.lambda - *lo.shift) < std::abs(y.lambda - *lo.shift);
    });
    if (static_cast<Index>(near.size()) < wanted) throw run_error("E77", "a critical speed was counted but its mode not found");
    for (Index j = 0; j < wanted; ++j) {
      // Newton's method on Omega: the frequency of the mode less n Omega, by secant from two neighbouring speeds.
      const auto gap = [&](double Omega, const WhirlMode& w) { return w.frequency - o.order * Omega; };
      WhirlMode mode = describe_mode(near[at(j)], counter.matrices(middle, o.order * middle), linear);
      double x0 = middle, f0 = gap(x0, mode);
      double x1 = middle + (f0 == 0.0 ? 0.0 : 0.1 * (k.b - k.a) * (f0 > 0 ? 1 : -1)), f1 = f0;
      for (int it = 0; it < 40 && f1 != 0.0; ++it) {
        const auto next = follower.follow(x1, mode);
        if (!next) throw run_error("E77", "a critical speed was isolated but its mode was lost on the way");
        mode = *next, f1 = gap(x1, mode);
        if (f1 == f0 || x1 == x0) break;
        const double x2 = x1 - f1 * (x1 - x0) / (f1 - f0);
        const bool done = std::abs(x2 - x1) <= o.tolerance * x1;
        x0 = x1, f0 = f1, x1 = x2;
        if (done) break;
      }
      out.push_back({x1, o.order * x1, o.order, mode});
    }
  }
  return out;
}

std::vector<Critical> damped(Linearizer& linear, const CriticalOptions& o, double low) {
  TrackOptions t;
  t.modes.motion = o.motion;
  t.modes.count = 0;
  t.modes.max_frequency = 1.1 * o.order * o.max_speed;   // only modes that reach the order line within the range matter
  ModeTracker tracker(linear, t);
  ModesOptions mo = t.modes;
  mo.max_frequency = infinity, mo.count = 2;
  WhirlSolver follower(linear, mo);
  const auto gap = [&](double Omega, const WhirlMode& w) { return w.frequency - o.order * Omega; };
  std::vector<Critical> out;
  const auto visit = [&](double a, double b, const std::vector<TrackedMode>& modes) {
    for (const TrackedMode& m : modes) {
      if (!m.has_before || m.now.frequency == 0.0) continue;
      const double ga = gap(a, m.before), gb = gap(b, m.now);
      if ((ga > 0) == (gb > 0) && gb != 0.0) continue;
      if (ga == 0.0) continue;   // counted at the end of the step before
      if (const auto root = find_on_mode(follower, a, m.before, b, m.now, gap, o.tolerance))
        out.push_back({root->speed, o.order * root->speed, o.order, root->mode});
    }
  };
  for (Index k = 0; k <= o.grid; ++k)
    tracker.advance(low + (o.max_speed - low) * static_cast<double>(k) / static_cast<double>(o.grid), visit);
  return out;
}
}  // namespace

std::vector<Critical> critical_speeds(Linearizer& linear, const CriticalOptions& options) {
  if (!(options.max_speed > options.min_speed) || !(options.order > 0))
    throw run_error("E77", "critical speeds need an order above zero and a range of speeds");
  // At standstill every rotor that turns freely has the frequency 0 = n x 0: that is no critical speed.
  const double low = options.min_speed > 0 ? options.min_speed : 1e-3 * options.max_speed;
  CriticalOptions o = options;
  o.max_speed = std::min(o.max_speed, o.max_frequency / o.order);
  if (!(o.max_speed > low)) return {};
  std::vector<Critical> out = o.damped ? damped(linear, o, low) : undamped(linear, o, low);
  std::sort(out.begin(), out.end(), [](const Critical& a, const Critical& b) { return a.speed < b.speed; });
  return out;
}

CriticalMap critical_map(const std::function<system::System(double)>& build, const CriticalMapOptions& options) {
  CriticalMap map;
  map.stiffness = options.stiffness;
  for (std::size_t i = 0; i < options.stiffness.size(); ++i) {
    const system::System system = build(options.stiffness[i]);
    Running running = options.running;
    running.top_speed = std::max(running.top_speed, options.critical.max_speed);
    Linearizer linear(system, running);
    std::size_t forward = 0, backward = 0;
    double last_planar = -1;
    for (const Critical& c : critical_speeds(linear, options.critical)) {
      if (c.mode.kind != ModeKind::lateral) continue;
      const bool back = c.mode.direction == Direction::backward;
      if (back && options.forward_only) continue;
      if (c.mode.direction == Direction::planar) {   // without gyroscopic effect both planes have the same speed: one line
        if (options.forward_only && std::abs(c.speed - last_planar) < 1e-9 * c.speed) continue;
        last_planar = c.speed;
      }
      // the n-th of its direction continues the n-th line of that direction
      const std::size_t number = back ? backward++ : forward++;
      std::size_t seen = 0;
      CriticalMapLine* line = nullptr;
      for (CriticalMapLine& l : map.lines)
        if ((l.direction == Direction::backward) == back && seen++ == number) line = &l;
      if (!line) {
        map.lines.push_back({back ? Direction::backward : Direction::forward, std::vector<double>(options.stiffness.size(), nan)});
        line = &map.lines.back();
      }
      line->speed[i] = c.speed;
    }
  }
  return map;
}

}  // namespace whirl::analysis
