#include <core/contract.hpp>
#include <core/periodic.hpp>

namespace whirl {

// By parts twice: each corner of the curve counts with the change of its slope.
Complex periodic_coefficient(const std::vector<double>& x, const std::vector<double>& f,
                             double period, int k) {
  WHIRL_EXPECTS(x.size() >= 2 && x.size() == f.size());
  WHIRL_EXPECTS(k != 0 && x.back() < x.front() + period);
  const std::size_t n = x.size();
  const auto slope_after = [&](std::size_t j) {
    const bool last = j + 1 == n;
    return (f[last ? 0 : j + 1] - f[j]) / ((last ? x[0] + period : x[j + 1]) - x[j]);
  };
  const double w = two_pi * k / period;
  Complex sum = 0.0;
  for (std::size_t j = 0; j < n; ++j)
    sum += (slope_after(j) - slope_after(j > 0 ? j - 1 : n - 1)) * std::polar(1.0, -w * x[j]);
  return -sum / (w * w * period);
}

}  // namespace whirl
