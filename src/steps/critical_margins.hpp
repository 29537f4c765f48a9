// Separation margins of the modes themselves: what a response to unbalance shows of a critical speed depends on
// where the unbalance and the probes are, and on where its speeds end.
#pragma once
#include <analysis/response/api617.hpp>
#include <analysis/response/api684.hpp>
#include <analysis/spectra/critical.hpp>

#include <optional>
#include <vector>

namespace whirl::steps {

/// A damped critical speed against its margin.
struct CriticalMargin {
  analysis::Critical critical;
  double required = 0, actual = 0;  ///< fractions, as of analysis::MarginRow
  bool damped = false;              ///< its amplification 1/(2 zeta) asks for no margin
  std::optional<double> peak;       ///< of a response that shows it, rad/s
  bool passed() const { return damped || peak || actual >= required; }
};

struct CriticalMarginOptions {
  double order = 1.0;  ///< speed of the unbalanced shaft over that of the reference, with its sign
  double min_speed = 0.0, max_speed = 0.0;  ///< of the reference, rad/s, positive
  analysis::OperatingRange range;
  analysis::MarginRule rule;
  std::vector<double> peaks;  ///< of the responses, those that are judged by their margin, rad/s
  int threads = 1;
};

/// Lateral modes whose frequency is that of the shaft somewhere between the speeds and that an unbalance drives
/// (more than hardly forward), by speed.
/// @throws Error as critical_speeds(); where a table ends within the speeds (E-codes of the supports).
std::vector<CriticalMargin> critical_margins(analysis::Linearizer& linear,
                                             const CriticalMarginOptions& options,
                                             analysis::SpectrumCertificate* certificate = nullptr);

}  // namespace whirl::steps
