#include <analysis/spectra/track.hpp>
#include <core/contract.hpp>

#include <la/dense.hpp>
#include <la/multiply.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

ModeTracker::ModeTracker(Linearizer& linear, const TrackOptions& options)
    : linear_(linear),
      options_(options),
      solver_(linear, options.modes) {
  if (!options_.ahead.empty())
    ahead_.emplace(linear, options_.modes, options_.ahead, options_.at_once, options_.threads);
}

const std::vector<WhirlMode>& ModeTracker::find(double Omega) {
  // A speed put in between leaves the one ahead where it is.
  if (ahead_ && !(found_ahead_ && found_ahead_->Omega == Omega))
    if (const ModesAtSpeed* next = ahead_->at(Omega)) found_ahead_ = next;
  if (found_ahead_ && found_ahead_->Omega == Omega) {
    linear_.set_equilibrium(found_ahead_->equilibrium);
    if (!started_) solver_.move_to(Omega);  // the metric of the first speed does for all
    certificate_ = found_ahead_->certificate;
    return found_ahead_->modes;
  }
  const std::vector<WhirlMode>& modes = solver_.solve(Omega);
  certificate_ = solver_.certificate();
  return modes;
}

struct ModeTracker::Likeness {
  double score, like, apart;
  Index old, now;
};

namespace {

/// Modes of one eigenvalue, of which any basis of their space may come out (two shafts alike). Two planes
/// of one shaft at rest are left to the pairing of planar modes.
std::vector<std::vector<std::size_t>> sets_of_equals(const std::vector<const WhirlMode*>& modes) {
  constexpr double equal = 1e-9;
  std::vector<std::vector<std::size_t>> out;
  std::vector<bool> taken(modes.size(), false);
  for (std::size_t i = 0; i < modes.size(); ++i) {
    if (taken[i] || !modes[i]->oscillates()) continue;
    std::vector<std::size_t> set{i};
    for (std::size_t j = i + 1; j < modes.size(); ++j)
      if (!taken[j] &&
          std::abs(modes[j]->lambda - modes[i]->lambda) <= equal * std::abs(modes[i]->lambda))
        set.push_back(j);
    const bool planes = set.size() == 2 && modes[i]->direction == Direction::planar &&
                        modes[set[1]]->direction == Direction::planar;
    if (set.size() < 2 || planes) continue;
    for (const std::size_t j : set)
      taken[j] = true;
    out.push_back(std::move(set));
  }
  return out;
}

/// Modes at one speed, what M makes of them, and their squared lengths by it.
struct ModesByMass {
  std::vector<const WhirlMode*> mode;
  std::vector<VecXc> mx;
  std::vector<double> size;

  void add(const WhirlMode& m, const la::BlockMatrix<6>& M) {
    mode.push_back(&m);
    la::multiply(M, m.x, mx.emplace_back());
    size.push_back(std::abs(m.x.dot(mx.back())));
  }
};

/// Share of a vector of squared length `size` in the space of a set, by mass: 1 where it lies in it.
double share_in_space(const ModesByMass& modes, const std::vector<std::size_t>& set, const VecXc& x,
                      double size) {
  const auto n = static_cast<Index>(set.size());
  MatXc gram(n, n);
  VecXc on(n);
  for (Index a = 0; a < n; ++a) {
    const VecXc& of = modes.mode[set[at(a)]]->x;
    for (Index b = 0; b < n; ++b)
      gram(a, b) = of.dot(modes.mx[set[at(b)]]);
    on[a] = std::conj(x.dot(modes.mx[set[at(a)]]));
  }
  const double share = on.dot(la::pivoted_solution(gram, on)).real() / size;
  return std::isfinite(share) ? std::min(share, 1.0) : 0.0;
}

/// [of][in]: share of a mode in the space of the equals that another is one of; 0 where it has none.
MatX shares_among_equals(const ModesByMass& of, const ModesByMass& in) {
  MatX out = MatX::Zero(static_cast<Index>(of.mode.size()), static_cast<Index>(in.mode.size()));
  for (const std::vector<std::size_t>& set : sets_of_equals(in.mode))
    for (std::size_t i = 0; i < of.mode.size(); ++i) {
      if (!(of.size[i] > 0)) continue;
      const double share = share_in_space(in, set, of.mode[i]->x, of.size[i]);
      for (const std::size_t j : set)
        out(static_cast<Index>(i), static_cast<Index>(j)) = share;
    }
  return out;
}

}  // namespace

std::vector<ModeTracker::Likeness> ModeTracker::compare(const std::vector<WhirlMode>& found) {
  const la::BlockMatrix<6>& M = solver_.matrices().M;
  ModesByMass old, now;
  for (const TrackedMode& m : modes_)
    old.add(m.now, M);
  for (const WhirlMode& m : found)
    now.add(m, M);
  const MatX old_among_equals = shares_among_equals(old, now);
  const MatX now_among_equals = shares_among_equals(now, old);
  std::vector<Likeness> pairs;
  for (std::size_t i = 0; i < old.mode.size(); ++i)
    for (std::size_t j = 0; j < now.mode.size(); ++j) {
      if (!(old.size[i] > 0 && now.size[j] > 0)) continue;
      const auto a = static_cast<Index>(i), b = static_cast<Index>(j);
      const double own = std::norm(old.mode[i]->x.dot(now.mx[j])) / (old.size[i] * now.size[j]);
      const double like = std::max({own, old_among_equals(a, b), now_among_equals(b, a)});
      if (like < 0.05) continue;
      const Complex was = old.mode[i]->lambda, is = now.mode[j]->lambda;
      const double apart = std::abs(is - was) / (std::abs(was) + std::abs(is) + 1e-300);
      // among equals those that are alike themselves
      const double score = like - 0.5 * apart - 0.01 * (like - own);
      pairs.push_back({score, like, apart, a, b});
    }
  std::sort(pairs.begin(), pairs.end(),
            [](const Likeness& a, const Likeness& b) { return a.score > b.score; });
  return pairs;
}

bool ModeTracker::pair(const std::vector<WhirlMode>& found, bool last_chance,
                       std::vector<Index>& of_new) {
  std::vector<Index> of_old(modes_.size(), -1);
  of_new.assign(found.size(), -1);
  bool sure = true;
  for (const Likeness& k : compare(found)) {
    if (of_old[at(k.old)] >= 0 || of_new[at(k.now)] >= 0) continue;
    // A planar pair at rest splits into two circles, each 0.5 like both: no doubt, whichever way
    // they are paired.
    const bool split = modes_[at(k.old)].now.direction == Direction::planar;
    // What does not oscillate is followed as well as may be, not at the price of more speeds.
    const bool matters = modes_[at(k.old)].now.oscillates() && found[at(k.now)].oscillates();
    if (matters && k.like < options_.doubt && !(split && k.like > 0.45)) {
      sure = false;
      // No mode goes so far in the smallest step: one ends here, another begins.
      if (last_chance && k.apart > 0.2) continue;
    }
    of_old[at(k.old)] = k.now;
    of_new[at(k.now)] = k.old;
  }
  return sure;
}

bool ModeTracker::step(double Omega, bool last_chance) {
  const std::vector<WhirlMode>& found = find(Omega);
  ++solved_;
  std::vector<Index> of_new(found.size(), -1);
  if (started_) {
    const bool sure = pair(found, last_chance, of_new);
    if (!sure && !last_chance) return false;
  }
  std::vector<TrackedMode> next;
  for (std::size_t j = 0; j < found.size(); ++j) {
    const Index i = of_new[j];
    if (i >= 0)
      next.push_back({modes_[at(i)].id, found[j], modes_[at(i)].now, true});
    else
      next.push_back({next_id_++, found[j], {}, false});
  }
  modes_ = std::move(next);
  started_ = true;
  speed_ = Omega;
  return true;
}

const std::vector<TrackedMode>& ModeTracker::advance(double Omega, const Visit& visit) {
  WHIRL_EXPECTS(std::isfinite(Omega));
  if (!started_) {
    step(Omega, true);
    return modes_;
  }
  const double whole = std::abs(Omega - speed_);
  double goal = Omega;
  int doubts = 0;
  while (speed_ != Omega) {
    const double from = speed_;
    const bool last_chance = doubts >= options_.most_doubts ||
                             std::abs(goal - from) <= whole * std::ldexp(1.0, -options_.halvings);
    if (step(goal, last_chance)) {
      if (visit) visit(from, speed_, modes_);
      goal = Omega;
    } else {
      ++doubts;
      goal = 0.5 * (from + goal);
    }
  }
  return modes_;
}

namespace {

using Measure = std::function<double(double, const WhirlMode&)>;

/// Of what it has at the ends a measure leaves so much at its zero; more where it jumps: growth by
/// hysteretic damping at the speed of the spin, where the frequency does not, or one mode taken for
/// another on the way, where it does.
constexpr double left_at_zero = 1e-4;
constexpr double one_frequency = 1e-6;

/// @pre g has not the same sign at both, and is zero at neither.
std::optional<TrackedRoot> find_between(WhirlSolver& solver, TrackedRoot lo, TrackedRoot hi,
                                        const Measure& g, double tolerance) {
  const double a = lo.speed, b = hi.speed;
  const double ga = g(a, lo.mode), gb = g(b, hi.mode);
  const double zero = left_at_zero * std::max(std::abs(ga), std::abs(gb));
  const auto checked = [&](const TrackedRoot& root, double f) {
    const double apart = std::abs(lo.mode.lambda.imag() - hi.mode.lambda.imag());
    const bool found = std::abs(f) <= zero || apart <= one_frequency * std::abs(root.mode.lambda);
    return found ? std::optional(root) : std::nullopt;
  };
  const double enough = tolerance * std::max(std::abs(a), std::abs(b));
  // Trials come from the secant through the last two points, kept inside the bracket; a bisection
  // whenever the bracket has not shrunk to half in three trials.
  TrackedRoot best = std::abs(ga) < std::abs(gb) ? lo : hi;
  double x0 = lo.speed, f0 = ga, x1 = hi.speed, f1 = gb, width = std::abs(b - a);
  if (std::abs(f0) < std::abs(f1)) {
    std::swap(x0, x1);
    std::swap(f0, f1);
  }
  for (int it = 0, slow = 0; it < 100; ++it) {
    double x = f1 != f0 ? x1 - f1 * (x1 - x0) / (f1 - f0) : 0.5 * (lo.speed + hi.speed);
    const double low = std::min(lo.speed, hi.speed), high = std::max(lo.speed, hi.speed);
    if (!(x > low && x < high) || slow >= 3) {
      x = 0.5 * (low + high);
      slow = 0;
    }
    const TrackedRoot& near = std::abs(x - lo.speed) < std::abs(x - hi.speed) ? lo : hi;
    auto mode = solver.follow(x, near.mode);
    if (!mode) mode = solver.follow(x, (&near == &lo ? hi : lo).mode);
    if (!mode) return std::nullopt;
    const double f = g(x, *mode);
    const double step = std::abs(x - x1);
    best = {x, *mode};
    x0 = x1;
    f0 = f1;
    x1 = x;
    f1 = f;
    if (f == 0.0) return best;
    if ((f > 0) == (ga > 0))
      lo = best;
    else
      hi = best;
    if (step <= enough) return checked(best, f);
    const double now = std::abs(hi.speed - lo.speed);
    if (now <= enough) return checked(best, f);
    slow = now < 0.5 * width ? 0 : slow + 1;
    if (now < 0.5 * width) width = now;
  }
  return checked(best, f1);
}

/// The mode of `from` followed in small steps to the one at which the measure changes its sign.
std::optional<TrackedRoot> find_in_steps(WhirlSolver& solver, const TrackedRoot& from, double to,
                                         const Measure& g, double tolerance) {
  constexpr int steps = 32;
  TrackedRoot last = from;
  for (int k = 1; k <= steps; ++k) {
    const double x = from.speed + (to - from.speed) * k / steps;
    const auto mode = solver.follow(x, last.mode);
    if (!mode) return std::nullopt;
    const TrackedRoot next{x, *mode};
    const double before = g(last.speed, last.mode), now = g(x, next.mode);
    if (now == 0.0) return next;
    if ((before > 0) != (now > 0)) return find_between(solver, last, next, g, tolerance);
    last = next;
  }
  return std::nullopt;
}

}  // namespace

std::optional<TrackedRoot> find_on_mode(WhirlSolver& solver, double a, const WhirlMode& start_a,
                                        double b, const WhirlMode& start_b, const Measure& g,
                                        double tolerance) {
  WHIRL_EXPECTS(a != b && tolerance > 0.0);
  const TrackedRoot lo{a, start_a}, hi{b, start_b};
  const double ga = g(a, start_a), gb = g(b, start_b);
  if (ga == 0.0) return lo;
  if (gb == 0.0) return hi;
  if ((ga > 0) == (gb > 0)) return std::nullopt;
  if (auto root = find_between(solver, lo, hi, g, tolerance)) return root;
  return find_in_steps(solver, lo, b, g, tolerance);
}

}  // namespace whirl::analysis
