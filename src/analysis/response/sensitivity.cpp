#include <analysis/response/sensitivity.hpp>

#include <core/contract.hpp>

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

Complex SensitivityMeter::solve(const OpenedLoop& loop) {
  x_.setZero();
  for (const auto& [unknown, force] : loop.entry)
    x_[unknown] += force;
  solver_.solve(x_);
  return 1.0 + seen(loop, x_);
}

const std::vector<Complex>& SensitivityMeter::at(double Omega, double w) {
  WHIRL_EXPECTS(w > 0);
  const bool regular = solver_.prepare(Omega, w);
  for (std::size_t k = 0; k < loops_.size(); ++k)
    values_[k] = regular ? solve(loops_[k]) : Complex(nan, nan);
  return values_;
}

Complex SensitivityMeter::of(std::size_t loop, double Omega, double w) {
  WHIRL_EXPECTS(w > 0 && loop < loops_.size());
  return solver_.prepare(Omega, w) ? solve(loops_[loop]) : Complex(nan, nan);
}

}  // namespace whirl::analysis
