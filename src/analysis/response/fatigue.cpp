#include <analysis/response/fatigue.hpp>
#include <core/contract.hpp>

#include <cmath>

namespace whirl::analysis {

double FatigueStrength::equivalent(double amplitude, double mean) const {
  WHIRL_EXPECTS(strength > 0);
  const double left = 1.0 - std::abs(mean) / strength;
  return left > 0 ? amplitude / left : infinity;
}

double FatigueStrength::life(double a) const {
  WHIRL_EXPECTS(thousand > endurance && endurance > 0 && cycles > 1000);
  if (a <= endurance) return infinity;
  if (a >= strength) return 0.0;
  const double slope = std::log(cycles / 1000) / std::log(thousand / endurance);
  return 1000 * std::pow(a / thousand, -slope);
}

double FatigueStrength::damage(const LoadCycle& c) const {
  return c.count / life(equivalent(c.amplitude(), c.mean));
}

}  // namespace whirl::analysis
