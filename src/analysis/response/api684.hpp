// Tables as API RP 684 (rotordynamic tutorial) and API 617 ask for: critical speeds as response
// peaks, amplification factors by half-power points, separation margins.
//
//   AF = Nc/(N2 - N1), N1 and N2 the speeds with 0.707 of the peak. AF < 2.5: critically damped, no
//       margin required.
//   Required margin (% of the nearer end of the operating range):
//     peak below it:   SM = 17 (1 - 1/(AF - 1.5))   peak above it:
//         SM = 10 + 17 (1 - 1/(AF - 1.5))
#pragma once
#include <analysis/response/unbalance.hpp>

namespace whirl::analysis {

struct OperatingRange {
  double min = 0, max = 0;
};  ///< rad/s

struct MarginRow {
  std::string probe;
  double speed = 0, amplitude = 0, amplification = nan;  ///< rad/s, m, -
  double low = nan, high = nan;                          ///< half-power speeds, rad/s
  double required = 0,
         actual = 0;  ///< margins, fraction (0.17 = 17 %); actual < 0: inside the range
  double amplification_bound = nan;  ///< the factor, or what it is below where it is not known
  /// No margin is asked for: a factor below the limit, known or not.
  bool is_damped(double limit) const { return amplification_bound < limit; }
  bool critically_damped = false;  ///< by RP 684, limit 2.5
  /// Not passed with the margin of the bound, and the factor is not known: the speeds end, or a higher
  /// peak begins, before its half-power points.
  bool undetermined = false;
  bool passed = true;
};

/// Distance of a speed from the range as a fraction of its nearer end; inside, less than zero, of the speed.
double margin_of(double speed, const OperatingRange& range);
/// Required margin as a fraction.
double required_margin(double amplification, bool above);

/// @pre range.min <= range.max; peaks name probes of the list.
std::vector<MarginRow> separation_margins(const std::vector<ResponsePeak>& peaks,
                                          const std::vector<ResponseProbe>& probes,
                                          const OperatingRange& range, std::size_t order = 0);

}  // namespace whirl::analysis
