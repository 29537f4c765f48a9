#include <steps/resonances.hpp>

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

}  // namespace whirl::steps
