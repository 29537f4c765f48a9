// Where the percentiles of a distribution lie, by samples of it and without a word on its shape: the
// number of samples below a percentile is binomial, whatever the distribution.
// H. A. David, H. N. Nagaraja, Order Statistics, 3rd ed., Wiley 2003, section 7.1.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace whirl::sweep {

class Design;
struct Plan;

/// Places among sorted samples, from 0.
struct OrderBounds {
  std::size_t low = 0, high = 0;
};
inline constexpr double confidence_of_bounds = 0.95;
/// The samples between which the quantile p lies with confidence_of_bounds at least, what is left of
/// it the same on both sides. Nothing: the samples are too few.
/// @pre 0 < p < 1
std::optional<OrderBounds> bounds_of_quantile(std::size_t samples, double p);
/// From how many samples on there are such bounds.
std::size_t samples_for_bounds(double p);

struct Interval {
  double low = 0, high = 0;
};
/// Bounds of the 5 %, 50 % and 95 % quantiles of a response; nothing: the samples are too few, or are
/// no independent ones.
struct QuantileBounds {
  std::optional<Interval> p05, median, p95;
  std::string missing;  ///< why there are none, or not all; empty: there are all
};
/// Why runs of this plan say nothing of how sure a percentile or a share is; empty: they do.
std::string obstacle_to_bounds(const Plan& plan);
/// Whether the points of the scheme lie as the distributions have it: not those of Morris and one at a time.
bool follows_distributions(const Design& design);
/// Whether the runs are samples, independent of each other, whose mean has a standard error.
bool independent_runs(const Plan& plan);
/// How much of a distribution the samples stand for that were drawn from another one, by the mean of
/// their weights; 1 where that may be 1; where some few runs weigh nearly all, what it is without the
/// heaviest. Of the rest nothing is known: there are no means and no quantiles.
/// Weights are not negative.
/// @pre at least one weight
double covered_share(const std::vector<double>& weights);
/// Between which the probability of something lies with confidence_of_bounds that happened in `count`
/// of `runs` independent runs. E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209.
/// @pre 0 <= count <= runs, runs > 0
Interval bounds_of_share(double count, double runs);
/// values: of runs that gave one.
QuantileBounds bounds_of_response(const Plan& plan, std::vector<double> values);

}  // namespace whirl::sweep
