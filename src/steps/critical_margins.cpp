#include <steps/critical_margins.hpp>

#include <analysis/response/harmonic.hpp>

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

/// How far the shafts that turn at this order whirl with their spin in a mode, as WhirlMode::forwardness of them
/// alone: on others, which turn the other way, the same orbit is another one.
double forwardness_of(analysis::Linearizer& linear, const analysis::WhirlMode& mode, double order) {
  const system::System& system = linear.system();
  double area = 0, sum = 0;
  for (Index i = 0; i < system.nodes(); ++i) {
    const system::NodeDef& node = system.node(i);
    if (node.scalar || node.line < 0) continue;
    const double ratio = linear.running().ratio(node.line);
    if (std::abs(std::abs(ratio) - std::abs(order)) > 1e-9 * std::abs(order)) continue;
    const analysis::PointAmplitude a = analysis::amplitude_at(linear, mode.x, {i, 0.0});
    const double forward = std::norm(a.forward()), backward = std::norm(a.backward());
    area += forward - backward;
    sum += forward + backward;
  }
  return sum > 0 ? area / sum : -1.0;
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
  std::vector<CriticalMargin> out;
  for (analysis::Critical& c : analysis::critical_speeds(linear, o, certificate)) {
    const bool lateral = c.mode.kind == analysis::ModeKind::lateral;
    if (!lateral || forwardness_of(linear, c.mode, options.order) < hardly_driven) continue;
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
