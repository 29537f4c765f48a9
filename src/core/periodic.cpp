#include <core/contract.hpp>
#include <core/periodic.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

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

namespace {

/// The smallest number of turns in which all orders repeat.
std::optional<int> common_turns(const std::vector<double>& orders) {
  constexpr int most = 12;
  for (int turns = 1; turns <= most; ++turns) {
    const bool repeat = std::all_of(orders.begin(), orders.end(), [turns](double order) {
      const double cycles = order * turns;
      return std::abs(cycles - std::round(cycles)) < 1e-9 * cycles;
    });
    if (repeat) return turns;
  }
  return std::nullopt;
}

/// The sum and its first two derivatives.
std::array<double, 3> sum_at(const std::vector<Complex>& c, const std::vector<double>& orders,
                             double x) {
  std::array<double, 3> f{};
  for (std::size_t k = 0; k < c.size(); ++k) {
    const Complex z = c[k] * std::polar(1.0, orders[k] * x);
    f[0] += z.real();
    f[1] -= orders[k] * z.imag();
    f[2] -= orders[k] * orders[k] * z.real();
  }
  return f;
}

/// The sum at the extreme near x, by Newton's method.
double extreme_near(const std::vector<Complex>& c, const std::vector<double>& orders, double x) {
  constexpr int passes = 4;
  for (int k = 0; k < passes; ++k) {
    const std::array<double, 3> f = sum_at(c, orders, x);
    if (f[2] == 0) break;
    x -= f[1] / f[2];
  }
  return sum_at(c, orders, x)[0];
}

}  // namespace

// Sixteen samples a period of the highest order find the extremes; all lie on one circle of roots.
double calc_swing(const std::vector<Complex>& c, const std::vector<double>& orders) {
  WHIRL_EXPECTS(!c.empty() && c.size() == orders.size());
  double sum = 0;
  for (const Complex& x : c)
    sum += std::abs(x);
  const std::optional<int> turns = c.size() > 1 ? common_turns(orders) : std::nullopt;
  if (!turns || sum == 0) return 2 * sum;
  std::vector<std::size_t> cycles;
  cycles.reserve(orders.size());
  for (const double order : orders)
    cycles.push_back(static_cast<std::size_t>(std::lround(order * *turns)));
  const std::size_t samples = 16 * *std::max_element(cycles.begin(), cycles.end());
  std::vector<Complex> root(samples);
  for (std::size_t s = 0; s < samples; ++s)
    root[s] = std::polar(1.0, two_pi * static_cast<double>(s) / static_cast<double>(samples));
  double low = infinity, high = -infinity;
  std::size_t at_low = 0, at_high = 0;
  for (std::size_t s = 0; s < samples; ++s) {
    double f = 0;
    for (std::size_t k = 0; k < c.size(); ++k)
      f += (c[k] * root[cycles[k] * s % samples]).real();
    if (f < low) at_low = s;
    if (f > high) at_high = s;
    low = std::min(low, f);
    high = std::max(high, f);
  }
  const double step = two_pi * *turns / static_cast<double>(samples);
  high = std::max(high, extreme_near(c, orders, step * static_cast<double>(at_high)));
  low = std::min(low, extreme_near(c, orders, step * static_cast<double>(at_low)));
  return high - low;
}

}  // namespace whirl
