// When simplified Newton has converged, and when it will not: E. Hairer, G. Wanner, Solving ODEs
// II, IV.8.
#pragma once
#include <core/contract.hpp>
#include <time/problem.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

namespace whirl::time {

/// Corrections are measured relative to the response; the iteration error is rate/(1-rate) times
/// the last correction. Before a rate is known that of earlier steps stands in.
class NewtonMonitor {
 public:
  enum class Verdict { iterate, converged, failed };
  /// limit: largest number of iterations; allowance: largest iteration error of a step; acceptable:
  /// what is still taken when round-off stops the iteration before the allowance is reached.
  /// Part of `acceptable` that rounding may reach.
  static constexpr double rounding_share = 3.0;
  void configure(int limit, double allowance, double acceptable) {
    WHIRL_EXPECTS(limit > 0 && allowance > 0.0);
    limit_ = limit;
    allowance_ = allowance;
    acceptable_ = std::max(acceptable, allowance);
  }
  void begin() {
    count_ = 0;
    rate_ = 0.0;
    // rates of earlier steps are trusted less with each step, and no further than the floor: a
    // contact may close now
    eta_ = std::max(std::pow(eta_, 0.8), eta_floor);
    noise_ *= 0.9;
  }
  /// rounding: size of corrections that are the rounding of the coordinates themselves; nothing
  /// smaller can be asked for, while the error test sees more than that.
  Verdict update(double change, double rounding) {
    ++count_;
    if (!std::isfinite(change)) return Verdict::failed;
    const double floor = std::max(noise_, std::min(rounding, rounding_share * acceptable_));
    if (count_ > 1) {
      const double ratio = previous_ > 0.0 ? change / previous_ : 0.0;
      rate_ = count_ == 2 ? ratio : std::sqrt(ratio * rate_);
      eta_ = rate_ < 0.99 ? rate_ / (1.0 - rate_) : 100.0;
      if (eta_ * change > allowance_ && change > floor) {
        // stagnation at round-off: corrections that no longer shrink, yet far below what the error
        // test sees
        if (count_ > 2 && ratio > stagnant && ratio < 1.2 && 10.0 * change <= acceptable_) {
          noise_ = std::max(noise_, change);
          eta_ = 1.0;
          return Verdict::converged;
        }
        if (rate_ >= 0.99 && 10.0 * change > acceptable_ && (count_ > 2 || ratio >= 2.0))
          return Verdict::failed;
        // hopeless within the iterations left: say so now
        if (rate_ < 0.99 && eta_ * change * std::pow(rate_, limit_ - count_) > 10.0 * acceptable_)
          return Verdict::failed;
      }
    }
    if (eta_ * change <= allowance_ || change <= floor) return Verdict::converged;
    previous_ = change;
    if (count_ < limit_) return Verdict::iterate;
    return eta_ * change <= acceptable_ ? Verdict::converged : Verdict::failed;
  }
  /// True when the matrices have become too old: a new linearisation costs about one iteration and
  /// would save one.
  bool slow() const { return count_ > 2 && rate_ > slow_rate; }
  int count() const { return count_; }
  /// A failed iteration says nothing about the next.
  void forget() { eta_ = 1.0; }
  void save(std::vector<double>& out) const { out.insert(out.end(), {eta_, noise_}); }
  const double* restore(const double* in) {
    eta_ = in[0];
    noise_ = in[1];
    return in + 2;
  }

 private:
  static constexpr double eta_floor = 1e-3, slow_rate = 0.05, stagnant = 0.3;
  int limit_ = 10, count_ = 0;
  double allowance_ = 1e-7, acceptable_ = 1e-6, eta_ = 1.0, rate_ = 0.0, previous_ = 0.0;
  double noise_ = 0.0;  ///< size of corrections that are round-off, as last seen; fades
};

}  // namespace whirl::time
