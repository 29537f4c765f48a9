// A response over two keys, as filled contours: between the values of two lists, or a quadratic that
// is fitted to samples.
#pragma once
#include <sweep/columns.hpp>
#include <core/types.hpp>
#include <plot/plot.hpp>
#include <optional>
#include <span>
#include <vector>

namespace whirl::sweep {

/// y = a + b'u + u'C u, u the keys from -1 to 1 over the range of their samples: least squares.
class QuadraticFit {
 public:
  /// keys: one column each, as long as y; rows with a nan are left out. Nothing: a key that does not
  /// vary, or fewer runs than twice the coefficients.
  static std::optional<QuadraticFit> of(const std::vector<std::vector<double>>& keys,
                                        const std::vector<double>& y);
  double at(std::span<const double> keys) const;
  /// Standard deviation of the samples about the fit (runs less coefficients), unit of the response.
  double residual() const { return residual_; }
  /// Share of the variance of the samples that the fit leaves, 0 .. 1.
  double share_left() const { return share_left_; }
  std::size_t runs() const { return runs_; }

 private:
  VecX terms(std::span<const double> keys) const;
  std::vector<double> middle_, half_;
  VecX coefficients_;
  double residual_ = 0, share_left_ = 0;
  std::size_t runs_ = 0;
};

/// Filled contours of a response over two keys; no axes where the runs give none.
plot::Figure contours(const Plan& plan, const Columns& columns, std::size_t response);

}  // namespace whirl::sweep
