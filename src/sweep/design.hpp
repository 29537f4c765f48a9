// What a sweep varies: the keys, the values they take, and how samples are laid. The settings of
// every run are a function of these, of the number of samples and of the seed alone.
#pragma once
#include <core/types.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace whirl::sweep {

/// A distribution of one number.
struct Distribution {
  enum class Law { values, uniform, loguniform, triangular, normal, lognormal };
  Law law = Law::values;  ///< values: none
  /// (low, high); triangular (low, mode, high); normal (mean, standard deviation); lognormal
  /// (median, standard deviation of the logarithm).
  std::vector<double> parameters;

  /// Value at a quantile in (0, 1).
  double at_quantile(double p) const;
  double density(double x) const;
  /// The value of a standard normal variable at the quantile of x; infinite where the density is 0.
  double score(double x) const;
};

/// One key of the deck and the values it takes.
struct Factor : Distribution {
  std::string path;                 ///< as --set takes it: "bearing.NDE.clearance"
  std::string unit;                 ///< of its numbers, as given; empty: none, or text
  std::vector<std::string> values;  ///< Law::values: as --set takes them
  int file = -1;  ///< lists of one file go row by row, together; -1: a list of its own
  /// Samples come from this one instead, and count by the ratio of the densities.
  std::optional<Distribution> drawn;

  bool random() const { return law != Law::values; }
};

/// Reads "PATH=VALUES". VALUES:
///   60 um:90 um:7            seven values at equal distances; 60um:90um:7:log at equal ratios
///   60 um, 75 um, 90 um      these
///   uniform(60 um, 90 um)    and loguniform, triangular(low, mode, high), normal(mean, deviation),
///                            lognormal(median, deviation of the logarithm)
///   normal(1, 0.1) drawn uniform(0.5, 2)     the first, by weighted samples of the second
/// A deviation in % is one of the mean. All numbers of a factor have one unit; one that is left out
/// is that of the last.
/// @throws Error (E99, Exit::usage)
Factor read_factor(const std::string& text);

/// The columns of a file as factors that go row by row, together: headings are keys, with their
/// unit in brackets or not; without it the cells have one, as values of a list do. number: of the file.
/// @throws Error (E99, Exit::usage); Exit::io
std::vector<Factor> read_runs(const std::filesystem::path& file, int number);

/// The two keys' normal scores have this correlation (a Gaussian copula).
struct Correlation {
  std::string first, second;
  double value = 0;
};
/// Reads "PATH, PATH = 0.6".
/// @throws Error (E99, Exit::usage)
Correlation read_correlation(const std::string& text);

/// How samples are laid. The last three are schemes of sensitivity, d distributions:
/// saltelli: N points and N others, and each point with one number of its other: N (d + 2) runs;
/// morris: N paths over four levels in which one number a time moves by two thirds: N (d + 1) runs;
/// one_at_a_time: all at their medians, and each at its 5 % and 95 % quantiles: 2 d + 1 runs.
enum class Sampling { random, latin_hypercube, sobol, saltelli, morris, one_at_a_time };

/// All runs of a sweep: every combination of listed values, and at each of these the same samples of
/// the distributions.
class Design {
 public:
  Design() = default;
  /// samples: of the distributions, N of a scheme of sensitivity; 1 without any.
  /// @throws Error (E99, Exit::usage): samples without a distribution or the other way round, a key
  /// twice, more than ten distributions for Sobol's points, lists beside a scheme of sensitivity,
  /// correlations that cannot be or are given twice, more than 1e9 runs
  Design(std::vector<Factor> factors, std::int64_t samples, Sampling sampling, std::uint64_t seed,
         const std::vector<Correlation>& correlations = {});
  std::int64_t runs() const { return combinations_ * samples_; }
  const std::vector<Factor>& factors() const { return factors_; }
  Sampling sampling() const { return sampling_; }
  std::uint64_t seed() const { return seed_; }
  /// N of a scheme of sensitivity.
  std::int64_t base() const { return base_; }
  /// Of run 0 .. runs() - 1, one a factor, as --set takes them.
  std::vector<std::string> values(std::int64_t run) const;
  /// What the run counts for: ratio of the densities where samples are drawn from others, else 1.
  double weight(std::int64_t run) const;
  bool weighted() const;
  /// Quantiles in (0, 1) of the distributions in a sample, in the order of their factors.
  std::vector<double> quantiles(std::int64_t sample) const;

 private:
  double independent(std::size_t dimension, std::int64_t sample) const;
  void correlate(const std::vector<Correlation>& correlations);
  void require_no_lists() const;

  std::vector<Factor> factors_;
  std::int64_t combinations_ = 1, samples_ = 1, base_ = 1;
  Sampling sampling_ = Sampling::latin_hypercube;
  std::uint64_t seed_ = 0;
  /// Logarithm of the Gaussian copula's density, but for a constant.
  double log_copula(const VecX& score) const;

  MatX cholesky_;  ///< of the correlations, lower; empty: none
};

/// Quantile of the standard normal distribution.
/// M. J. Wichura, Algorithm AS 241, Applied Statistics 37 (1988) 477, doi 10.2307/2347330.
/// @param p in (0, 1)
double normal_quantile(double p);
/// Its probability up to x.
double normal_probability(double x);

}  // namespace whirl::sweep
