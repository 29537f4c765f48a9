// When simplified Newton has converged, and when it will not: E. Hairer, G. Wanner, Solving ODEs II, IV.8.
#pragma once
#include <time/problem.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::time {

/// Corrections are measured relative to the response; the iteration error is rate/(1-rate) times the last correction.
/// Before a rate is known that of earlier steps stands in.
class NewtonMonitor {
 public:
  enum class Verdict { iterate, converged, failed };
  /// limit: largest number of iterations; allowance: largest iteration error of a step.
  void configure(int limit, double allowance) { limit_ = limit, allowance_ = allowance; }
  void begin() {
    count_ = 0;
    rate_ = 0.0;
    // rates of earlier steps are trusted less with each step, and no further than the floor: a contact may close now
    eta_ = std::max(std::pow(eta_, 0.8), eta_floor);
  }
  Verdict update(double change) {
    ++count_;
    if (!std::isfinite(change)) return Verdict::failed;
    if (count_ > 1) {
      const double ratio = previous_ > 0.0 ? change / previous_ : 0.0;
      rate_ = count_ == 2 ? ratio : std::sqrt(ratio * rate_);
      if (rate_ >= 0.99) {
        if (change > allowance_) return Verdict::failed;
        eta_ = 100.0;
      } else {
        eta_ = rate_ / (1.0 - rate_);
      }
      // hopeless within the iterations left: say so now
      if (eta_ * change * std::pow(rate_, limit_ - count_) > 10.0 * allowance_) return Verdict::failed;
    }
    if (eta_ * change <= allowance_) return Verdict::converged;
    previous_ = change;
    return count_ < limit_ ? Verdict::iterate : Verdict::failed;
  }
  /// True when the matrices have become too old: a new linearisation costs about one iteration and would save one.
  bool slow() const { return count_ > 2 && rate_ > slow_rate; }
  int count() const { return count_; }
  double eta() const { return eta_; }
  void set_eta(double eta) { eta_ = eta; }

 private:
  static constexpr double eta_floor = 1e-3, slow_rate = 0.05;
  int limit_ = 10, count_ = 0;
  double allowance_ = 1e-7, eta_ = 1.0, rate_ = 0.0, previous_ = 0.0;
};

}  // namespace whirl::time
