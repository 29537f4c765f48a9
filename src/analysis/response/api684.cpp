#include <analysis/response/api684.hpp>
#include <core/contract.hpp>

#include <cmath>

namespace whirl::analysis {

namespace {
constexpr double damped_below = 2.5;
}

double margin_of(double speed, const OperatingRange& range) {
  if (speed > range.max) return (speed - range.max) / range.max;
  if (speed < range.min) return (range.min - speed) / range.min;
  return -std::min(speed - range.min, range.max - speed) / speed;
}

double required_margin(double amplification, bool above) {
  if (!(amplification >= damped_below)) return 0.0;
  const double sm = 0.17 * (1.0 - 1.0 / (amplification - 1.5));
  return above ? 0.10 + sm : sm;
}

std::vector<MarginRow> separation_margins(const std::vector<ResponsePeak>& peaks,
                                          const std::vector<ResponseProbe>& probes,
                                          const OperatingRange& range, std::size_t order) {
  WHIRL_EXPECTS(range.min <= range.max);
  std::vector<MarginRow> rows;
  for (const ResponsePeak& p : peaks) {
    if (p.order != order) continue;
    MarginRow r;
    r.probe = probes[p.probe].name;
    r.speed = p.speed;
    r.amplitude = p.amplitude;
    r.amplification = p.amplification();
    r.low = p.low;
    r.high = p.high;
    r.amplification_bound = p.amplification_bound();
    r.critically_damped = r.is_damped(damped_below);
    const double speed = std::abs(p.speed);
    const bool above = speed > range.max;
    r.required = required_margin(r.amplification_bound, above);
    r.actual = margin_of(speed, range);
    r.passed = r.critically_damped || r.actual >= r.required;
    r.undetermined = !r.passed && std::isnan(r.amplification);
    rows.push_back(r);
  }
  return rows;
}

}  // namespace whirl::analysis
