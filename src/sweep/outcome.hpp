// What a finished sweep shows: its table, statistics of the responses, and what they depend on.
#pragma once
#include <sweep/columns.hpp>
#include <sweep/plan.hpp>
#include <map>

namespace whirl::sweep {

/// Writes sweep.csv, statistics.csv, effects.csv, where responses are words words.csv, where asked for
/// probabilities.csv and sensitivity.csv and sweep.h5 (the columns of sweep.csv, words as strings),
/// summary.json and sweep.html; prints the statistics.
/// rows: one for every run.
/// @throws Error (Exit::io) when a file cannot be written, or HDF5 is wanted and was not built.
void write_outcome(const Plan& plan, const std::map<std::int64_t, Row>& rows,
                   const SweepOptions& options);

/// Of the runs that gave a value.
struct Statistics {
  std::size_t count = 0;
  double mean = 0, deviation = 0;  ///< standard deviation of the sample
  double least = 0, largest = 0;
  double p05 = 0, median = 0, p95 = 0;  ///< quantiles, between order statistics
};
/// @pre at least one value
Statistics statistics_of(std::vector<double> values);

/// Of runs that count by weights: self-normalised means and quantiles.
struct WeightedStatistics {
  double runs = 0;  ///< unweighted runs they are worth (L. Kish, Survey Sampling, 1965)
  double mean = 0, error = 0, deviation = 0, least = 0, p05 = 0, median = 0, p95 = 0, largest = 0;
};
/// nan among the values: left out.
/// @pre one weight a value, at least one value
WeightedStatistics weighted_statistics(const std::vector<double>& values,
                                       const std::vector<double>& weights);

/// How probable a value beyond a limit is. Of weighted samples self-normalised, or where the runs
/// beyond are lighter than the others by more than chance (rare cases that are drawn for) the sum of
/// their weights over the number of runs.
struct Probability {
  double value = 0, error = 0;  ///< of the runs that gave a value; nan: not known
  bool known = true;
  std::size_t runs = 0;     ///< beyond
  std::size_t without = 0;  ///< gave no value: nobody knows on which side they are
  double covered = 1;       ///< share of the distribution that weighted samples stand for
  /// Of all runs and all that weighted samples do not stand for: none, all of what is not known
  /// beyond.
  double least = 0, most = 0;
};
/// @pre one weight a value
Probability probability_beyond(const std::vector<double>& values,
                               const std::vector<double>& weights, double limit, bool above);

/// Rank correlation (Spearman) of two samples that count by weights, -1 .. 1; ties share their mean
/// rank; nan when one of them does not vary.
/// @pre one weight a pair
double rank_correlation(const std::vector<double>& x, const std::vector<double>& y,
                        const std::vector<double>& weights);
/// Of two columns of runs, over those in which both are numbers; nan where weighted samples do not
/// stand for their distribution too.
double rank_correlation(const Columns& c, const std::vector<double>& x,
                        const std::vector<double>& y);

}  // namespace whirl::sweep
