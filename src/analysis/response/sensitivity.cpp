#include <analysis/response/sensitivity.hpp>

#include <core/contract.hpp>

#include <algorithm>

namespace whirl::analysis {

SensitivityMeter::SensitivityMeter(Linearizer& linear, std::vector<OpenedLoop> loops)
    : loops_(std::move(loops)),
      solver_(linear),
      x_(linear.system().size()),
      values_(loops_.size()) {}

Complex SensitivityMeter::seen(const OpenedLoop& loop, const VecXc& x) {
  if (loop.signal >= 0) return loop.unit * x[loop.signal];
  PointAmplitude a = amplitude_at(solver_.linear(), x, loop.shaft);
  if (loop.housing) {
    const PointAmplitude under = amplitude_at(solver_.linear(), x, *loop.housing);
    a.y -= under.y;
    a.z -= under.z;
  }
  return loop.axis.x() * a.y + loop.axis.y() * a.z;
}

const std::vector<Complex>& SensitivityMeter::at(double Omega, double w) {
  WHIRL_EXPECTS(w > 0);
  if (!solver_.prepare(Omega, w)) {
    std::fill(values_.begin(), values_.end(), Complex(nan, nan));
    return values_;
  }
  for (std::size_t k = 0; k < loops_.size(); ++k) {
    x_.setZero();
    for (const auto& [unknown, force] : loops_[k].entry)
      x_[unknown] += force;
    solver_.solve(x_);
    values_[k] = 1.0 + seen(loops_[k], x_);
  }
  return values_;
}

}  // namespace whirl::analysis
