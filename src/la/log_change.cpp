#include <la/log_change.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::la {

namespace {

constexpr double surprise = 0.4;      ///< of a change of log f, what the slopes do not explain
constexpr double largest_step = 6.0;  ///< of log f between neighbouring samples
constexpr double small_step = 1.0;    ///< one that needs no look at its middle
constexpr double offset = 1e-4;       ///< of an interval: step of the slopes
constexpr int deepest = 16;           ///< halvings of one interval
constexpr Index most_samples = 4000;  ///< of one piece of a path

}  // namespace

bool LogChange::sample(double t, Sample& out) {
  ++samples_;
  out.t = t;
  return f_(t, out.log_f) && std::isfinite(std::abs(out.log_f));
}

bool LogChange::slope(const Sample& a, double towards, Complex& out) {
  Sample beside;
  const double step = offset * (towards - a.t);
  if (!sample(a.t + step, beside)) return false;
  out = principal(beside.log_f - a.log_f) / step;
  return true;
}

bool LogChange::settle(const Sample& a, const Sample& b, Complex slope_a, Complex slope_b,
                       int depth, Complex& change) {
  Sample middle;
  Complex slope_m;
  if (samples_ > limit_ || !sample(0.5 * (a.t + b.t), middle)) return false;
  if (!slope(middle, b.t, slope_m)) return false;
  // the integrals of the parabola through the slopes, and what is left of the differences
  const double h = (b.t - a.t) / 24.0;
  const Complex first = h * (5.0 * slope_a + 8.0 * slope_m - slope_b);
  const Complex second = h * (5.0 * slope_b + 8.0 * slope_m - slope_a);
  const Complex rest_first = principal(middle.log_f - a.log_f - first);
  const Complex rest_second = principal(b.log_f - middle.log_f - second);
  const bool expected = std::max(std::abs(rest_first), std::abs(rest_second)) < surprise;
  const bool moderate = std::max(std::abs(first), std::abs(second)) < largest_step;
  if (expected && moderate) {
    change = first + rest_first + second + rest_second;
    return true;
  }
  Complex before, after;
  if (depth == 0 || !settle(a, middle, slope_a, slope_m, depth - 1, before)) return false;
  if (!settle(middle, b, slope_m, slope_b, depth - 1, after)) return false;
  change = before + after;
  return true;
}

bool LogChange::over(double from, double to, Complex& change) {
  limit_ = samples_ + most_samples;
  Sample a = last_, b;
  last_.t = nan;
  Complex slope_a, slope_b;
  if ((a.t != from && !sample(from, a)) || !sample(to, b)) return false;
  if (!slope(a, to, slope_a) || !slope(b, from, slope_b)) return false;
  last_ = b;
  const Complex first = 0.5 * (to - from) * slope_a;
  const Complex second = 0.5 * (to - from) * slope_b;
  const Complex rest = principal(b.log_f - a.log_f - first - second);
  change = first + second + rest;
  if (2.0 * std::max(std::abs(first), std::abs(second)) < small_step &&
      std::abs(rest) < 0.5 * surprise)
    return true;
  return settle(a, b, slope_a, slope_b, deepest, change);
}

}  // namespace whirl::la
