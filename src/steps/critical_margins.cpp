#include <steps/critical_margins.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

namespace {

/// Unbalance hardly drives a whirl more backward than this.
constexpr double hardly_driven = -0.5;

/// The peak that belongs to a critical speed: damping moves the one from the other by the square of its
/// ratio, other modes and supports that change with speed by a few percent.
std::optional<double> peak_of(const analysis::Critical& c, const std::vector<double>& peaks) {
  const double zeta = c.mode.damping_ratio;
  const double near = 0.02 + 2 * zeta * zeta;
  std::optional<double> best;
  for (const double p : peaks) {
    const double distance = std::abs(p - c.speed);
    if (distance > near * c.speed) continue;
    if (!best || distance < std::abs(*best - c.speed)) best = p;
  }
  return best;
}

}  // namespace

std::vector<CriticalMargin> critical_margins(analysis::Linearizer& linear,
                                             const CriticalMarginOptions& options,
                                             analysis::SpectrumCertificate* certificate) {
  analysis::CriticalOptions o;
  o.order = std::abs(options.order);
  o.min_speed = options.min_speed;
  o.max_speed = options.max_speed;
  o.damped = true;
  o.motion = analysis::Motion::lateral;
  o.threads = options.threads;
  const double sense = options.order < 0.0 ? -1.0 : 1.0;
  std::vector<CriticalMargin> out;
  for (analysis::Critical& c : analysis::critical_speeds(linear, o, certificate)) {
    const bool lateral = c.mode.kind == analysis::ModeKind::lateral;
    if (!lateral || sense * c.mode.forwardness < hardly_driven) continue;
    CriticalMargin m;
    m.actual = analysis::margin_of(c.speed, options.range);
    m.required = options.rule.required(c.amplification(), c.speed > options.range.max);
    m.damped = c.amplification() < options.rule.damped;
    m.peak = peak_of(c, options.peaks);
    m.critical = std::move(c);
    out.push_back(std::move(m));
  }
  return out;
}

}  // namespace whirl::steps
