#include <steps/resonances.hpp>

#include <results/linear_limits.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {

void add_places_about(double resonance, double damping_ratio, std::vector<double>& out) {
  for (const double x : {-8.0, -4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0, 8.0})
    out.push_back(resonance * (1.0 + x * damping_ratio));
}

void sort_apart(std::vector<double>& grid) {
  std::sort(grid.begin(), grid.end());
  const auto close = [](double a, double b) { return b - a < 1e-7 * std::abs(b); };
  grid.erase(std::unique(grid.begin(), grid.end(), close), grid.end());
}

void warn_of_coarse_points(results::FrequencyStep& s, const Error& why) {
  Diagnostic w;
  w.severity = Diagnostic::Severity::warning;
  w.code = "W15";
  w.message = fmt::format(
      "step '{}': the points are those asked for, and a peak between two of "
      "them may be missed: resonances were not found ({})",
      s.step.name, why.diagnostics().front().message);
  w.hint = "more points, or speeds and frequencies one by one";
  results::warn(s.job, std::move(w));
}

}  // namespace whirl::steps
