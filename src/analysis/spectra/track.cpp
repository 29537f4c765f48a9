#include <analysis/spectra/track.hpp>
#include <core/contract.hpp>

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

std::vector<ModeTracker::Likeness> ModeTracker::compare(const std::vector<WhirlMode>& found) {
  const std::size_t n = found.size();
  // M products of the new modes once
  const la::MCK& m = solver_.matrices();
  std::vector<VecXc> mx(n);
  std::vector<double> norm(n);
  for (std::size_t j = 0; j < n; ++j) {
    la::multiply(m.M, found[j].x, mx[j]);
    norm[j] = std::abs(found[j].x.dot(mx[j]));
  }
  std::vector<Likeness> pairs;
  VecXc my;
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const WhirlMode& old = modes_[i].now;
    la::multiply(m.M, old.x, my);
    const double size = std::abs(old.x.dot(my));
    for (std::size_t j = 0; j < n; ++j) {
      const double like =
          size > 0 && norm[j] > 0 ? std::norm(old.x.dot(mx[j])) / (size * norm[j]) : 0.0;
      if (like < 0.05) continue;
      const double apart = std::abs(found[j].lambda - old.lambda) /
                           (std::abs(old.lambda) + std::abs(found[j].lambda) + 1e-300);
      pairs.push_back(
          {like - 0.5 * apart, like, apart, static_cast<Index>(i), static_cast<Index>(j)});
    }
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
