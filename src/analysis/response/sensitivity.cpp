#include <analysis/response/sensitivity.hpp>

#include <core/contract.hpp>

#include <algorithm>

namespace whirl::analysis {

SensitivityMeter::SensitivityMeter(Linearizer& linear, std::vector<OpenedLoop> loops)
    : loops_(std::move(loops)),
      solver_(linear),
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

void SensitivityMeter::solve(std::span<const OpenedLoop> loops, std::span<Complex> values) {
  x_.setZero(solver_.linear().system().size(), static_cast<Index>(loops.size()));
  for (std::size_t k = 0; k < loops.size(); ++k)
    for (const auto& [unknown, force] : loops[k].entry)
      x_(unknown, static_cast<Index>(k)) += force;
  solver_.solve_columns(x_);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    column_ = x_.col(static_cast<Index>(k));
    values[k] = 1.0 + seen(loops[k], column_);
  }
}

bool SensitivityMeter::prepare(double Omega, double w) {
  // beside a motion that nothing damps, and no loop sees: the loops are the same there
  constexpr double aside = 1e-9;
  return solver_.prepare(Omega, w) || solver_.prepare(Omega, (1.0 + aside) * w);
}

const std::vector<Complex>& SensitivityMeter::at(double Omega, double w) {
  WHIRL_EXPECTS(w > 0);
  if (prepare(Omega, w))
    solve(loops_, values_);
  else
    std::fill(values_.begin(), values_.end(), Complex(nan, nan));
  return values_;
}

Complex SensitivityMeter::of(std::size_t loop, double Omega, double w) {
  WHIRL_EXPECTS(w > 0 && loop < loops_.size());
  Complex value(nan, nan);
  if (prepare(Omega, w)) solve({&loops_[loop], 1}, {&value, 1});
  return value;
}

}  // namespace whirl::analysis
