// What a sweep varies: the keys, the values they take, and how samples are laid. The settings of
// every run are a function of these, of the number of samples and of the seed alone.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace whirl::sweep {

/// One key of the deck and the values it takes.
struct Factor {
  enum class Law { values, uniform, loguniform, triangular, normal, lognormal };
  std::string path;  ///< as --set takes it: "bearing.NDE.clearance"
  std::string unit;  ///< of its numbers, as given; empty: none, or text
  Law law = Law::values;
  std::vector<std::string> values;  ///< Law::values: as --set takes them
  /// Of the distribution: (low, high); triangular (low, mode, high); normal (mean, standard
  /// deviation); lognormal (median, standard deviation of the logarithm).
  std::vector<double> parameters;

  bool random() const { return law != Law::values; }
  /// Value at a quantile in (0, 1) of the distribution, in `unit`.
  double at_quantile(double p) const;
};

/// Reads "PATH=VALUES". VALUES:
///   60 um:90 um:7            seven values at equal distances; 60um:90um:7:log at equal ratios
///   60 um, 75 um, 90 um      these
///   uniform(60 um, 90 um)    and loguniform, triangular(low, mode, high), normal(mean, deviation),
///                            lognormal(median, deviation of the logarithm)
/// A deviation in % is one of the mean. All numbers of a factor have one unit; one that is left out
/// is that of the last.
/// @throws Error (E99, Exit::usage)
Factor read_factor(const std::string& text);

enum class Sampling { random, latin_hypercube, sobol };

/// All runs of a sweep: every combination of listed values, and at each of these the same samples of
/// the distributions.
class Design {
 public:
  Design() = default;
  /// samples: of the distributions; 1 without any.
  /// @throws Error (E99, Exit::usage): samples without a distribution or the other way round, a key
  /// twice, more than ten distributions for Sobol's points, more than 1e9 runs
  Design(std::vector<Factor> factors, std::int64_t samples, Sampling sampling, std::uint64_t seed);
  std::int64_t runs() const { return combinations_ * samples_; }
  const std::vector<Factor>& factors() const { return factors_; }
  /// Of run 0 .. runs() - 1, one a factor, as --set takes them.
  std::vector<std::string> values(std::int64_t run) const;

 private:
  double quantile(std::size_t dimension, std::int64_t sample) const;

  std::vector<Factor> factors_;
  std::int64_t combinations_ = 1, samples_ = 1;
  Sampling sampling_ = Sampling::latin_hypercube;
  std::uint64_t seed_ = 0;
};

/// Quantile of the standard normal distribution.
/// M. J. Wichura, Algorithm AS 241, Applied Statistics 37 (1988) 477, doi 10.2307/2347330.
/// @param p in (0, 1)
double normal_quantile(double p);

}  // namespace whirl::sweep
