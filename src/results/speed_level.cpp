#include <results/speed_level.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::results {

namespace {

/// Prescribed at the node whose spin is the reference speed; null: none is.
LawPtr prescribed_angle(const run::Job& job) {
  for (const assembly::TurnCount& count : job.built.turn_counts)
    if (count.node == job.reference() && count.angle) return count.angle;
  return nullptr;
}

}  // namespace

SpeedLevel speed_level(const run::Job& job, double speed, double tolerance) {
  constexpr double rounding = 1e-14;
  constexpr double least_accuracy = 1e-3;
  SpeedLevel out;
  out.angle = prescribed_angle(job);
  out.spin = job.reference_ratio() * speed;
  if (!out.angle) {
    // a speed that settles at the level is known to what the steps are accurate to
    out.hold = std::min(tolerance, least_accuracy) * std::abs(out.spin);
    return out;
  }
  double largest = std::max(std::abs(out.spin), std::abs(out.angle->at(0.0).df));
  for (const double t : out.angle->breakpoints())
    largest = std::max(largest, std::abs(out.angle->at(t).df));
  out.reach = rounding * largest;
  out.hold = 2.0 * out.reach;
  return out;
}

}  // namespace whirl::results
