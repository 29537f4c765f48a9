#include <time/step_control.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::time {
namespace {
constexpr double safety = 0.9;
constexpr double grow_limit = 8.0, shrink_limit = 0.2;
constexpr double dead_band = 1.2;  // growth below this is not worth a factorisation
constexpr double hold = 0.95;   // nor is a reduction above this, while the safety factor covers it;
constexpr double notch = 0.85;  // a smaller one is made large enough to last
constexpr double prompt = 2.0;  // growth beyond this is taken at once, else it must last
constexpr double newton_back = 0.8,
                 newton_relax =
                     1.15;  // after a failure at h: the next proposals stay below 0.8 h, 0.92 h, ..
constexpr double error_floor =
    1e-8;  // of the allowance; keeps the ratio of two round-off errors out of the prediction
}  // namespace

double StepControl::accepted(double h, double error, int iterations, int limit) {
  WHIRL_EXPECTS(h > 0.0 && error >= 0.0);
  WHIRL_EXPECTS(iterations >= 0 && limit > 0);
  error = std::max(error, error_floor);
  const double effort = safety * (1.0 + 2.0 * limit) / (iterations + 2.0 * limit);
  double ratio = std::min(safety, effort) * std::pow(error, -1.0 / exponent_);
  if (have_previous_) {
    const double predicted =
        safety * (h / h_previous_) * std::pow(error_previous_ / (error * error), 1.0 / exponent_);
    ratio = std::min(ratio, predicted);
  }
  ratio = std::clamp(ratio, shrink_limit, grow_limit);
  if (rejected_) ratio = std::min(ratio, 1.0);
  if (newton_limit_ < large) {
    ratio = std::clamp(newton_limit_ / h, std::min(ratio, 1.0), ratio);
    newton_limit_ *= newton_relax;
    if (newton_limit_ > large) newton_limit_ = large;
  }
  rejected_ = false;
  h_previous_ = h;
  error_previous_ = std::max(error, 1e-2);
  have_previous_ = true;

  std::rotate(recent_.begin(), recent_.begin() + 1, recent_.end());
  recent_.back() = ratio;
  if (ratio > 1.0 && ratio < prompt) {
    double lasting = ratio;
    for (double r : recent_)
      lasting = std::min(lasting, r == large ? ratio : r);
    ratio = std::max(
        lasting,
        1.0);  // one of them was a recovery from something: no growth, yet no reason to shrink
  }
  if (ratio >= hold && ratio < dead_band) return h;
  if (ratio < 1.0) ratio = std::min(ratio, notch);
  // the stored ratios refer to the step they were proposed for
  for (double& r : recent_)
    if (r != large) r /= ratio;
  return h * ratio;
}

void StepControl::newton_failed(double h) {
  WHIRL_EXPECTS(h > 0.0);
  rejected_ = true;
  newton_limit_ = newton_back * h;
}

double StepControl::rejected(double h, double error) {
  WHIRL_EXPECTS(h > 0.0);
  rejected_ = true;
  for (double& r : recent_)
    r = large;
  if (!std::isfinite(error)) return shrink_limit * h;
  return h * std::clamp(safety * std::pow(error, -1.0 / exponent_), shrink_limit, 0.8);
}

void StepControl::save(std::vector<double>& out) const {
  out.insert(out.end(), {h_previous_, error_previous_, have_previous_ ? 1.0 : 0.0,
                         rejected_ ? 1.0 : 0.0, newton_limit_});
  out.insert(out.end(), recent_.begin(), recent_.end());
}

const double* StepControl::restore(const double* in) {
  h_previous_ = *in++;
  error_previous_ = *in++;
  have_previous_ = *in++ != 0.0;
  rejected_ = *in++ != 0.0;
  newton_limit_ = *in++;
  for (double& r : recent_)
    r = *in++;
  return in;
}

}  // namespace whirl::time
