#include <analysis/spectra/critical.hpp>

#include <core/contract.hpp>
#include <core/error.hpp>
#include <core/parallel.hpp>
#include <la/block_lu.hpp>
#include <la/dense.hpp>
#include <la/multiply.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace whirl::analysis {

namespace {

/// Undamped: counts the negative eigenvalues of S(Omega).
class Counter {
 public:
  Counter(Linearizer& linear, const CriticalOptions& o)
      : linear_(linear),
        options_(o),
        motion_(linear.system(), o.motion, linear.running().spinning()),
        lu_(linear.system().pattern(), motion_.active()) {}
  Index count(double Omega) { return count(Omega, options_.order * Omega); }
  /// tables: frequency of supports tabulated against it.
  Index count(double Omega, double tables) {
    // exactly on an eigenvalue: look beside it, ever farther
    for (double beside = 1e-12; beside < 1e-6; beside *= 2) {
      const double w = options_.order * Omega;
      const la::MCK& m = matrices(Omega, tables);
      if (lu_.factor(m, Complex(-w * w, 0), Complex(0, w), Complex(1, 0)) == la::Status::ok)
        return lu_.negative_eigenvalues();
      Omega *= 1 + beside;
    }
    throw run_error(
        "E77",
        fmt::format("critical speeds cannot be counted near {:.6g} rpm: the matrix is singular at "
                    "every speed tried",
                    to_rpm(Omega)),
        "parts without mass, or stiffnesses too far apart for the digits of the computer");
  }
  std::span<const unsigned char> active() const { return motion_.active(); }
  const la::MCK& matrices(double Omega, double tables) {
    return motion_.reduce(linear_.conservative_at(Omega, tables));
  }

 private:
  Linearizer& linear_;
  CriticalOptions options_;
  MotionReduction motion_;
  la::BlockLu<Complex> lu_;
};

struct Bracket {
  double a, b;
  Index na, nb;
};

/// Halves brackets until each holds one change, or changes that cannot be told apart (a double
/// root).
void isolate(Counter& counter, const Bracket& k, double scale, std::vector<Bracket>& out) {
  const Index changes = std::abs(k.nb - k.na);
  if (changes == 0) return;
  // one root: until it lies within 1e-3, so that the nearest eigenvalue is the right one; several:
  // until 1e-6
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

/// Brackets of all changes of the count from `low` on. Coefficients against frequency can raise a
/// mode through n Omega (frequency_dependent_modes.hpp: left out) near where it comes down: apart
/// at the rows of the tables.
std::vector<Bracket> bracket(Counter& counter, const CriticalOptions& o, double low,
                             const std::vector<double>& rows) {
  std::vector<Bracket> brackets;
  double a = low;
  Index na = counter.count(a);
  std::vector<double> grid;
  for (Index k = 1; k <= o.grid; ++k)
    grid.push_back(low +
                   (o.max_speed - low) * static_cast<double>(k) / static_cast<double>(o.grid));
  for (const double w : rows)
    if (w > o.order * low && w < o.order * o.max_speed) grid.push_back(w / o.order);
  std::sort(grid.begin(), grid.end());
  for (const double b : grid) {
    const Index nb = counter.count(b);
    isolate(counter, {a, b, na, nb}, o.max_speed, brackets);
    a = b;
    na = nb;
  }
  return brackets;
}

/// The modes of the bracket's middle nearest to i n Omega, as many as were counted.
std::vector<la::Mode> modes_within(Counter& counter, const CriticalOptions& o, const Bracket& k) {
  const Index wanted = std::abs(k.nb - k.na);
  const double middle = 0.5 * (k.a + k.b);
  const la::MCK& m = counter.matrices(middle, o.order * middle);
  la::ModeOptions lo;
  lo.count = wanted + 2;
  lo.shift = Complex(0, o.order * middle);
  std::vector<la::Mode> near = la::quadratic_modes(m, counter.active(), lo);
  std::sort(near.begin(), near.end(), [&](const la::Mode& x, const la::Mode& y) {
    return std::abs(x.lambda - *lo.shift) < std::abs(y.lambda - *lo.shift);
  });
  if (static_cast<Index>(near.size()) < wanted)
    throw run_error("E77", "a critical speed was counted but its mode not found");
  near.resize(at(wanted));
  return near;
}

/// Newton's method on Omega from the bracket's middle, where the mode is known: its frequency less
/// n Omega, by secant from two neighbouring speeds. Nothing when the mode is lost on the way, or
/// when it leads out of the bracket: to the critical speed of another mode.
std::optional<Critical> find_critical(WhirlSolver& follower, const CriticalOptions& o,
                                      const Bracket& k, WhirlMode mode) {
  const auto gap = [&](double Omega, const WhirlMode& w) { return w.frequency - o.order * Omega; };
  const double middle = 0.5 * (k.a + k.b);
  double x0 = middle, f0 = gap(x0, mode);
  double x1 = middle + (f0 == 0.0 ? 0.0 : 0.1 * (k.b - k.a) * (f0 > 0 ? 1 : -1)), f1 = f0;
  for (int it = 0; it < 40 && f1 != 0.0; ++it) {
    const auto next = follower.follow(x1, mode);
    if (!next) return std::nullopt;
    mode = *next;
    f1 = gap(x1, mode);
    if (f1 == f0 || x1 == x0) break;
    const double x2 = x1 - f1 * (x1 - x0) / (f1 - f0);
    const double width = k.b - k.a;
    if (!(x2 > k.a - width && x2 < k.b + width)) return std::nullopt;
    const bool done = std::abs(x2 - x1) <= o.tolerance * x1;
    x0 = x1;
    f0 = f1;
    x1 = x2;
    if (done) break;
  }
  const double slack = 1e-9 * k.b;
  if (!(x1 >= k.a - slack && x1 <= k.b + slack)) return std::nullopt;
  return Critical{x1, o.order * x1, o.order, mode};
}

/// The same by halving the bracket where the count changes: modes whose frequencies nearly agree
/// cannot always be followed, but they can always be counted.
void find_by_count(Counter& counter, Linearizer& linear, const CriticalOptions& o, const Bracket& k,
                   std::vector<Critical>& out) {
  if (k.na == k.nb) return;
  const double middle = 0.5 * (k.a + k.b);
  constexpr double digits = 1e-12;  // of a count
  if (k.b - k.a > std::max(o.tolerance, digits) * k.b) {
    const Index n = counter.count(middle);
    find_by_count(counter, linear, o, {k.a, middle, k.na, n}, out);
    find_by_count(counter, linear, o, {middle, k.b, n, k.nb}, out);
    return;
  }
  for (const la::Mode& near : modes_within(counter, o, k))
    out.push_back({middle, o.order * middle, o.order,
                   describe_mode(near, counter.matrices(middle, o.order * middle), linear)});
}

/// The critical speeds of a bracket, as many as its count changes.
std::vector<Critical> criticals_of(Counter& counter, WhirlSolver& follower, Linearizer& linear,
                                   const CriticalOptions& o, const Bracket& k) {
  const double middle = 0.5 * (k.a + k.b);
  std::vector<Critical> out;
  for (const la::Mode& near : modes_within(counter, o, k)) {
    const WhirlMode mode = describe_mode(near, counter.matrices(middle, o.order * middle), linear);
    const auto found = find_critical(follower, o, k, mode);
    if (!found) {
      out.clear();
      find_by_count(counter, linear, o, k, out);
      return out;
    }
    out.push_back(*found);
  }
  return out;
}

std::vector<Critical> undamped(Linearizer& linear, const CriticalOptions& o, double low) {
  Counter counter(linear, o);
  const std::vector<double>& rows = linear.running().running().table_frequencies;
  const std::vector<Bracket> brackets = bracket(counter, o, low, rows);
  ModesOptions mo;
  mo.damped = false;
  mo.motion = o.motion;
  WhirlSolver follower(linear, mo);
  std::vector<Critical> out;
  for (const Bracket& k : brackets) {
    const double middle = 0.5 * (k.a + k.b);
    if (!rows.empty() && k.nb < k.na &&
        counter.count(k.b, o.order * middle) >= counter.count(k.a, o.order * middle))
      continue;  // the table raised it
    for (Critical& c : criticals_of(counter, follower, linear, o, k))
      out.push_back(std::move(c));
  }
  return out;
}

std::vector<Critical> damped(Linearizer& linear, const CriticalOptions& o, double low,
                             SpectrumCertificate* certificate) {
  TrackOptions t;
  t.modes.motion = o.motion;
  t.modes.count = 0;
  t.modes.certify = o.certify;
  t.modes.max_frequency =
      1.1 * o.order * o.max_speed;  // only modes that reach the order line within the range matter
  for (Index k = 0; k <= o.grid; ++k)
    t.ahead.push_back(low +
                      (o.max_speed - low) * static_cast<double>(k) / static_cast<double>(o.grid));
  t.threads = o.threads;
  ModeTracker tracker(linear, t);
  OrderCrossings crossings(o.order, low, o.max_speed, t.modes);
  const auto visit = [&](double from, double to, const std::vector<TrackedMode>& modes) {
    crossings.look(from, to, modes);
  };
  for (std::size_t k = 0; k < t.ahead.size(); ++k) {
    tracker.advance(t.ahead[k], visit);
    const SpectrumCertificate& now = tracker.certificate();
    if (certificate && (k == 0 || (certificate->complete() && !now.complete()))) *certificate = now;
  }
  std::vector<Critical> out = crossings.solve(linear, o.tolerance, o.threads);
  if (certificate && crossings.sure_to() < o.max_speed)
    certificate->open =
        fmt::format("a mode was lost on the way to its critical speed above {:.6g} rpm",
                    to_rpm(crossings.sure_to()));
  return out;
}
}  // namespace

OrderCrossings::OrderCrossings(double order, double min_speed, double max_speed,
                               const ModesOptions& modes)
    : order_(order),
      min_speed_(min_speed),
      max_speed_(max_speed),
      sure_to_(min_speed),
      modes_(modes) {
  WHIRL_EXPECTS(order > 0.0 && min_speed >= 0.0 && min_speed < max_speed);
}

double OrderCrossings::reach_of(const std::vector<TrackedMode>& modes) const {
  Index oscillating = 0;
  double highest = 0.0;
  for (const TrackedMode& m : modes) {
    if (!m.now.oscillates()) continue;
    ++oscillating;
    highest = std::max(highest, m.now.frequency);
  }
  return modes_.count > 0 && oscillating >= modes_.count ? highest : modes_.max_frequency;
}

void OrderCrossings::look(double from, double to, const std::vector<TrackedMode>& modes) {
  if (to <= min_speed_ || from >= max_speed_) return;
  if (reach_of(modes) < order_ * std::min(to, max_speed_)) sure_ = false;
  for (const TrackedMode& m : modes) {
    if (m.now.frequency == 0.0) continue;
    const double now = gap(to, m.now);
    // below the order line and not known before: it may have come from above the list
    if (!m.has_before && m.now.oscillates() && now <= 0.0) sure_ = false;
    if (!m.has_before) continue;
    const double before = gap(from, m.before);
    const bool passes = (before > 0.0) != (now > 0.0) || now == 0.0;
    // on the line at `from`: kept at the end of the step before
    if (passes && before != 0.0) steps_.push_back({from, to, m.before, m.now});
  }
  if (sure_) sure_to_ = std::min(to, max_speed_);
}

std::vector<Critical> OrderCrossings::solve(const Linearizer& linear, double tolerance,
                                            int threads) {
  ModesOptions one_at_a_time = modes_;
  one_at_a_time.max_frequency = infinity;
  one_at_a_time.count = 2;
  // where whirl meets the spin its damping, and with it the frequency, jumps from one side to the other
  one_at_a_time.hysteresis_order = order_;
  const auto g = [this](double Omega, const WhirlMode& w) { return gap(Omega, w); };
  std::vector<std::optional<TrackedRoot>> roots(steps_.size());
  run_side_by_side(steps_.size(), threads, [&](std::size_t k) {
    const Step& s = steps_[k];
    Linearizer own(linear);
    WhirlSolver follower(own, one_at_a_time);
    roots[k] = find_on_mode(follower, s.from, s.before, s.to, s.now, g, tolerance);
  });
  std::vector<Critical> out;
  for (std::size_t k = 0; k < roots.size(); ++k) {
    const auto& root = roots[k];
    if (!root) {
      sure_to_ = std::min(sure_to_, std::max(min_speed_, steps_[k].from));
      continue;
    }
    if (root->speed >= min_speed_ && root->speed <= max_speed_)
      out.push_back({root->speed, order_ * root->speed, order_, root->mode});
  }
  std::sort(out.begin(), out.end(),
            [](const Critical& a, const Critical& b) { return a.speed < b.speed; });
  return out;
}

double undamped_reach(double frequency, double damping_ratio) {
  constexpr double rounding = 1e-4;
  const double z2 = std::min(damping_ratio * damping_ratio, 0.99);
  return frequency / std::sqrt(1.0 - z2) * (1.0 + 2.0 * z2 + rounding);
}

double lowest_speed(double min_speed, double max_speed) {
  return min_speed > 0 ? min_speed : 1e-3 * max_speed;
}

namespace {

bool same_speed(const Critical& a, const Critical& b) {
  return std::abs(a.speed - b.speed) <= 1e-9 * b.speed;
}

}  // namespace

std::vector<Critical> critical_speeds(Linearizer& linear, const CriticalOptions& options,
                                      SpectrumCertificate* certificate) {
  if (!(options.max_speed > options.min_speed) || !(options.order > 0))
    throw run_error("E77", "critical speeds need an order above zero and a range of speeds");
  const double low = lowest_speed(options.min_speed, options.max_speed);
  CriticalOptions o = options;
  o.max_speed = std::min(o.max_speed, o.max_frequency / o.order);
  if (!(o.max_speed > low)) return {};
  std::vector<Critical> out =
      o.damped ? damped(linear, o, low, certificate) : undamped(linear, o, low);
  std::sort(out.begin(), out.end(),
            [](const Critical& a, const Critical& b) { return a.speed < b.speed; });
  for (std::size_t k = 0; k + 1 < out.size(); ++k) {
    WhirlMode &a = out[k].mode, &b = out[k + 1].mode;
    const bool lateral = a.kind == ModeKind::lateral && b.kind == ModeKind::lateral;
    if (!lateral || !same_speed(out[k], out[k + 1])) continue;
    separate_pair(linear, true, a, b);
    ++k;
  }
  return out;
}

namespace {

/// Critical speeds at one stiffness. Those at one speed (1e-9) share their space of shapes.
struct MapPoint {
  struct Entry {
    Critical critical;
    MatXc space;             ///< shapes of all critical speeds here, this one first
    double forwardness = 0;  ///< of the space: 0 where it holds the mirror image of the shape
    Index line = -1;
  };
  std::unique_ptr<system::System> system;
  la::MCK matrices;  ///< mass: the metric
  std::vector<Entry> entries;
};

/// Share of x within the space, 0 .. 1, in the metric of the mass.
double share_in(const la::MCK& m, const VecXc& x, const MatXc& space) {
  MatXc mass_space(space.rows(), space.cols());
  VecXc column;
  for (Index k = 0; k < space.cols(); ++k) {
    la::multiply(m.M, VecXc(space.col(k)), column);
    mass_space.col(k) = column;
  }
  la::multiply(m.M, x, column);
  const double size = std::abs(x.dot(column));
  if (!(size > 0)) return 0.0;
  const VecXc product = mass_space.adjoint() * x;
  const MatXc gram = space.adjoint() * mass_space;
  // dependent columns of `space` leave the coordinates open, but not the sum
  return std::abs(product.dot(la::ColumnSpan<Complex>(gram).coordinates(product))) / size;
}

/// Ways to call a line continued.
constexpr double alike = 0.6;            ///< share of a shape that is sure
constexpr double nearly_same = 0.9;      ///< the same, of lines that change places
constexpr double slack = 0.02;           ///< of the bounds of a speed: supports may depend on it
constexpr double hardly_forward = -0.5;  ///< forwardness of what turns backward

class MapTracker {
 public:
  MapTracker(const std::function<system::System(double)>& build, const CriticalMapOptions& options)
      : build_(build),
        options_(options) {}

  CriticalMap run() {
    const std::vector<double>& k = options_.stiffness;
    constexpr std::size_t batch = 8;  // points kept at a time
    std::vector<MapPoint> points(batch);
    for (std::size_t i = 0; i < k.size(); ++i) {
      if (i % batch == 0)
        run_side_by_side(std::min(batch, k.size() - i), options_.threads,
                         [&](std::size_t j) { points[j] = solve(k[i + j]); });
      MapPoint next = std::move(points[i % batch]);
      if (i > 0) advance(k[i - 1], k[i], next, 4);
      number(next);
      for (const MapPoint::Entry& e : next.entries) {
        Followed& l = lines_[at(e.line)];
        l.line.speed[i] = e.critical.speed;
        l.forwardness += e.forwardness;
        l.most = std::max(l.most, e.forwardness);
        ++l.points;
      }
      last_ = std::move(next);
    }
    return finish();
  }

 private:
  struct Pair {
    double score, like;
    std::size_t old, now;
  };
  struct Followed {
    CriticalMapLine line;
    double forwardness = 0;  ///< sum
    double most = -1;        ///< of them
    int points = 0;
  };

  MapPoint solve(double stiffness) const {
    MapPoint p;
    p.system = std::make_unique<system::System>(build_(stiffness));
    SteadyRotation running = options_.running;
    running.top_speed = std::max(running.top_speed, options_.critical.max_speed);
    Linearizer linear(*p.system, running);
    if (options_.undeformed) linear.stay_undeformed();
    const std::vector<Critical> all = critical_speeds(linear, options_.critical);
    MotionReduction motion(*p.system, options_.critical.motion, linear.running().spinning());
    p.matrices = motion.reduce(linear.conservative_at(options_.critical.max_speed));
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!wanted(all[i].mode)) continue;
      MapPoint::Entry e;
      e.critical = all[i];
      std::vector<std::size_t> group{i};
      for (std::size_t j = 0; j < all.size(); ++j)
        if (j != i && same_speed(all[i], all[j])) group.push_back(j);
      e.space.resize(all[i].mode.x.size(), static_cast<Index>(group.size()));
      for (std::size_t j = 0; j < group.size(); ++j)
        e.space.col(static_cast<Index>(j)) = all[group[j]].mode.x;
      // without gyroscopic effect the shapes of a double root are any two motions of their plane:
      // with a shape its mirror image is there, which turns the other way
      const bool mirrored =
          share_in(p.matrices, e.critical.mode.x.conjugate(), e.space) > 1.0 - 1e-6;
      e.forwardness = mirrored ? 0.0 : e.critical.mode.forwardness;
      p.entries.push_back(std::move(e));
    }
    return p;
  }

  bool wanted(const WhirlMode& m) const {
    switch (options_.critical.motion) {
      case Motion::lateral: return m.kind == ModeKind::lateral;
      case Motion::torsional: return m.kind == ModeKind::torsional;
      case Motion::axial: return m.kind == ModeKind::axial;
      case Motion::all: break;
    }
    return true;
  }

  /// Whether a line may go from the one critical speed to the other while the stiffness grows:
  /// K0 + k B grows by no more than k itself does.
  static bool may_become(const Critical& a, const Critical& b, double growth) {
    return b.speed >= a.speed * (1.0 - slack) &&
           b.speed <= a.speed * std::sqrt(growth) * (1.0 + slack);
  }

  /// Pairs of the last point with the next, at a stiffness `growth` times as large; whether nothing
  /// stayed in doubt.
  bool pair(const MapPoint& next, double growth, std::vector<Pair>& taken) const {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < last_.entries.size(); ++i)
      for (std::size_t j = 0; j < next.entries.size(); ++j) {
        const Critical& a = last_.entries[i].critical;
        const Critical& b = next.entries[j].critical;
        const double like = share_in(next.matrices, a.mode.x, next.entries[j].space);
        if (like < alike) continue;
        // of several at one speed the one whose own shape it is
        const double own = share_in(next.matrices, a.mode.x, next.entries[j].space.col(0));
        const double apart = std::abs(a.speed - b.speed) / (a.speed + b.speed);
        pairs.push_back({like - 0.5 * apart + 1e-3 * own, like, i, j});
      }
    std::stable_sort(pairs.begin(), pairs.end(),
                     [](const Pair& a, const Pair& b) { return a.score > b.score; });
    Marks old_taken(last_.entries.size(), 0), now_taken(next.entries.size(), 0);
    for (const Pair& p : pairs) {
      if (old_taken[p.old] || now_taken[p.now]) continue;
      old_taken[p.old] = now_taken[p.now] = 1;
      taken.push_back(p);
    }
    const auto swaps = [&](const Pair& p) {
      return p.like < nearly_same && std::any_of(taken.begin(), taken.end(), [&](const Pair& q) {
               return (p.old < q.old) != (p.now < q.now) && p.old != q.old;
             });
    };
    const std::size_t sure = taken.size();
    const bool changes = std::any_of(taken.begin(), taken.end(), swaps);
    pair_by_order(next, growth, old_taken, now_taken, taken);
    return !changes && taken.size() == sure;
  }

  using Marks = std::vector<unsigned char>;
  /// What is left, from below.
  void pair_by_order(const MapPoint& next, double growth, const Marks& old_taken,
                     const Marks& now_taken, std::vector<Pair>& taken) const {
    std::size_t i = 0, j = 0;
    while (i < last_.entries.size() && j < next.entries.size()) {
      const Critical& a = last_.entries[i].critical;
      const Critical& b = next.entries[j].critical;
      if (old_taken[i])
        ++i;
      else if (now_taken[j])
        ++j;
      else if (may_become(a, b, growth))
        taken.push_back({0, 0, i++, j++});
      else if (b.speed < a.speed)  // it comes from below the speeds looked at
        ++j;
      else
        ++i;
    }
  }

  /// Hands the lines of last_, at stiffness a, on to `next`, at b.
  void advance(double a, double b, MapPoint& next, int halvings) {
    std::vector<Pair> pairs;
    if (!pair(next, b / a, pairs) && halvings > 0) {
      const double middle = std::sqrt(a * b);
      MapPoint between = solve(middle);
      advance(a, middle, between, halvings - 1);
      number(between);
      last_ = std::move(between);
      advance(middle, b, next, halvings - 1);
      return;
    }
    for (const Pair& p : pairs)
      next.entries[p.now].line = last_.entries[p.old].line;
  }

  /// New lines for what continues none.
  void number(MapPoint& p) {
    for (MapPoint::Entry& e : p.entries) {
      if (e.line >= 0) continue;
      e.line = static_cast<Index>(lines_.size());
      Followed l;
      l.line.kind = e.critical.mode.kind;
      l.line.speed.assign(options_.stiffness.size(), nan);
      lines_.push_back(std::move(l));
    }
  }

  /// Two planes without gyroscopic effect.
  static bool same_line(const CriticalMapLine& a, const CriticalMapLine& b) {
    if (a.kind != ModeKind::lateral || b.kind != ModeKind::lateral) return false;
    for (std::size_t i = 0; i < a.speed.size(); ++i)
      if (std::isnan(a.speed[i]) != std::isnan(b.speed[i]) ||
          std::abs(a.speed[i] - b.speed[i]) > 1e-9 * b.speed[i])
        return false;
    return true;
  }

  static std::ptrdiff_t first(const CriticalMapLine& l) {
    return std::find_if(l.speed.begin(), l.speed.end(), [](double x) { return !std::isnan(x); }) -
           l.speed.begin();
  }

  CriticalMap finish() {
    CriticalMap map;
    map.stiffness = options_.stiffness;
    for (Followed& f : lines_) {
      if (f.points == 0) continue;  // met between the stiffnesses asked for alone
      CriticalMapLine& l = f.line;
      const bool lateral = l.kind == ModeKind::lateral;
      l.forwardness = f.forwardness / f.points;
      const bool second = std::any_of(map.lines.begin(), map.lines.end(),
                                      [&](const CriticalMapLine& o) { return same_line(o, l); });
      if (options_.forward_only && lateral && (second || f.most < hardly_forward)) continue;
      if (lateral && (second || l.forwardness < 0)) l.direction = Direction::backward;
      map.lines.push_back(std::move(l));
    }
    std::stable_sort(
        map.lines.begin(), map.lines.end(), [](const CriticalMapLine& a, const CriticalMapLine& b) {
          const auto i = first(a), j = first(b);
          return i != j
                     ? i < j
                     : a.speed[static_cast<std::size_t>(i)] < b.speed[static_cast<std::size_t>(j)];
        });
    return map;
  }

  const std::function<system::System(double)>& build_;
  const CriticalMapOptions& options_;
  MapPoint last_;
  std::vector<Followed> lines_;
};

}  // namespace

CriticalMap critical_map(const std::function<system::System(double)>& build,
                         const CriticalMapOptions& options) {
  return MapTracker(build, options).run();
}

}  // namespace whirl::analysis
