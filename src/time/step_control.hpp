// Step length control: K. Gustafsson's predictive controller (ACM TOMS 20 (1994) 496-517, doi
// 10.1145/198429.198437) as in Hairer & Wanner II, IV.8, with a dead band that spares
// refactorisations.
#pragma once
#include <array>
#include <vector>

namespace whirl::time {

/// Errors are relative to the allowance: 1 is just accepted. The estimate behaves as h^exponent.
class StepControl {
 public:
  StepControl() { reset(); }
  void configure(double exponent) { exponent_ = exponent; }
  /// Forgets the previous step (start, discontinuity).
  void reset() {
    have_previous_ = false;
    recent_.fill(large);
    rejected_ = false;
    newton_limit_ = large;
  }
  /// Next step after an accepted one. iterations: Newton iterations spent, of `limit`.
  double accepted(double h, double error, int iterations, int limit);
  /// Step to try after one that failed the error test.
  double rejected(double h, double error);
  /// Newton failed at h: the next accepted step must not grow at once, nor those after it to where
  /// it failed, for a while.
  void newton_failed(double h);

  void save(std::vector<double>& out) const;
  const double* restore(const double* in);

 private:
  static constexpr double large = 1e300;
  double exponent_ = 4.0;
  double h_previous_ = 0.0, error_previous_ = 0.0;
  bool have_previous_ = false, rejected_ = false;
  double newton_limit_ = 1e300;  ///< longest step to propose, s; relaxes with each accepted one
  /// Ratios the last steps proposed: in an oscillation the error has valleys twice a period, and
  /// growing into each only to be rejected at the next peak costs two factorisations.
  std::array<double, 8> recent_{};
};

}  // namespace whirl::time
