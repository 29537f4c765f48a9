#include <sweep/confidence.hpp>
#include <sweep/plan.hpp>
#include <core/contract.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::sweep {
namespace {

constexpr double in_a_tail = 0.5 * (1 - confidence_of_bounds);

/// Logarithm of the probability that k of n samples lie below the quantile p.
double log_probability(double k, double n, double p) {
  return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(p) +
         (n - k) * std::log1p(-p);
}

/// How many samples at most lie below the quantile p in all but a tail of cases: the most k for which
/// k or fewer have no more than its probability; -1: not even none at all.
double most_in_tail(double n, double p) {
  // what lies farther down than twelve deviations counts for nothing
  const double from = std::floor(n * p - 12 * std::sqrt(n * p * (1 - p)) - 12);
  double sum = 0;
  double k = std::max(0.0, from);
  for (; k <= n; ++k) {
    sum += std::exp(log_probability(k, n, p));
    if (sum > in_a_tail) break;
  }
  return k - 1;
}

}  // namespace

double covered_share(const std::vector<double>& weights) {
  double sum = 0, squares = 0, heaviest = 0;
  for (const double w : weights) {
    sum += w;
    squares += w * w;
    heaviest = std::max(heaviest, w);
  }
  if (!(sum > 0)) return 0;
  constexpr double fewest = 10;  // runs they are worth, from which their mean has an error
  constexpr double errors = 4;   // of the mean weight, by which it is less once in 30,000 times
  const auto runs = static_cast<double>(weights.size());
  const double mean = sum / runs;
  if (sum * sum < std::min(fewest, 0.5 * runs) * squares)  // some few are all there is
    return std::min(1.0, mean) * (1 - heaviest / sum);
  const double error = std::sqrt(std::max(0.0, squares / runs - mean * mean) / runs);
  return mean + errors * error < 1 - 1e-9 ? mean : 1.0;  // 1e-9: rounding
}

bool follows_distributions(const Design& design) {
  return design.sampling() != Sampling::morris && design.sampling() != Sampling::one_at_a_time;
}

bool independent_runs(const Plan& plan) {
  const Design& design = plan.design;
  const bool spread = design.sampling() == Sampling::random ||
                      design.sampling() == Sampling::latin_hypercube ||
                      design.sampling() == Sampling::sobol;
  return spread && std::all_of(design.factors().begin(), design.factors().end(),
                               [](const Factor& f) { return f.random(); });
}

std::string obstacle_to_bounds(const Plan& plan) {
  const Design& design = plan.design;
  if (design.weighted()) return "none: the samples are weighted";
  const bool laid =
      design.sampling() != Sampling::random && design.sampling() != Sampling::latin_hypercube;
  if (laid) return "none: points of this scheme are no independent samples";
  const bool all_random = std::all_of(design.factors().begin(), design.factors().end(),
                                      [](const Factor& f) { return f.random(); });
  return all_random ? "" : "none: values of a list are no samples";
}

Interval bounds_of_share(double count, double runs) {
  WHIRL_EXPECTS(count >= 0 && count <= runs && runs > 0);
  constexpr double z = 1.959963984540054;  // of the normal distribution, 2.5 % beyond it
  const double share = count / runs, weight = z * z / runs;
  const double middle = share + 0.5 * weight;
  const double half = z * std::sqrt(share * (1 - share) / runs + 0.25 * weight / runs);
  return {std::max(0.0, (middle - half) / (1 + weight)),
          std::min(1.0, (middle + half) / (1 + weight))};
}

std::optional<OrderBounds> bounds_of_quantile(std::size_t samples, double p) {
  WHIRL_EXPECTS(p > 0 && p < 1);
  const auto n = static_cast<double>(samples);
  const double below = most_in_tail(n, p);
  const double above = most_in_tail(n, 1 - p);  // of samples above the quantile
  if (below < 0 || above < 0) return std::nullopt;
  return OrderBounds{static_cast<std::size_t>(below),
                     samples - 1 - static_cast<std::size_t>(above)};
}

std::size_t samples_for_bounds(double p) {
  const double rarer = std::max(p, 1 - p);
  return static_cast<std::size_t>(std::ceil(std::log(in_a_tail) / std::log(rarer)));
}

QuantileBounds bounds_of_response(const Plan& plan, std::vector<double> values) {
  QuantileBounds out;
  out.missing = obstacle_to_bounds(plan);
  if (!out.missing.empty()) return out;
  std::sort(values.begin(), values.end());
  const auto bounds = [&values](double p) -> std::optional<Interval> {
    const auto places = bounds_of_quantile(values.size(), p);
    if (!places) return std::nullopt;
    return Interval{values[places->low], values[places->high]};
  };
  out.p05 = bounds(0.05);
  out.median = bounds(0.5);
  out.p95 = bounds(0.95);
  if (!out.median)
    out.missing = fmt::format("not enough samples: the median takes {}, 5 % and 95 % take {}",
                              samples_for_bounds(0.5), samples_for_bounds(0.05));
  else if (!out.p05 || !out.p95)
    out.missing =
        fmt::format("not enough samples for 5 % and 95 %: they take {}", samples_for_bounds(0.05));
  return out;
}

}  // namespace whirl::sweep
