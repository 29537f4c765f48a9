#include <core/text.hpp>
#include <plot/ticks.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::plot {
namespace {

int exponent_for(double largest) {
  if (!(largest > 0)) return 0;
  const int e = static_cast<int>(std::floor(std::log10(largest) + 1e-12));
  return e >= 5 || e <= -3 ? 3 * static_cast<int>(std::floor(e / 3.0)) : 0;
}

void label(Ticks& t, double step) {
  double largest = 0;
  for (const double v : t.major)
    largest = std::max(largest, std::abs(v));
  t.exponent = exponent_for(largest);
  const double unit = std::pow(10.0, t.exponent);
  int decimals = 0;
  for (double s = step / unit;
       decimals < 12 && std::abs(s - std::round(s)) > 1e-6 * std::max(1.0, std::abs(s)); s *= 10)
    ++decimals;
  for (const double v : t.major) {
    std::string s;
    // All labels of an axis have the same number of decimals.
    const double x = std::abs(v) < 1e-9 * step ? 0.0 : v / unit;
    char b[64];
    std::snprintf(b, sizeof b, "%.*f", decimals, x);
    s = b;
    if (s[0] == '-') s = "−" + s.substr(1);
    t.labels.push_back(std::move(s));
  }
}

/// Two at least: one number does not tell how long an axis is.
constexpr std::size_t fewest = 2;

Ticks linear_ticks_about(double lo, double hi, double target) {
  Ticks t;
  const double span = hi - lo;
  const double raw = span / std::max(target, 1.0),
               power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * power;
  int parts = 5;
  for (const auto& [factor, minor] : {std::pair{1.0, 5}, {2.0, 4}, {2.5, 5}, {5.0, 5}})
    if (factor * power >= raw * 0.999) {
      step = factor * power;
      parts = minor;
      break;
    }
  const double eps = 1e-9 * span;
  for (double k = std::ceil((lo - eps) / step); k * step <= hi + eps; ++k)
    t.major.push_back(k * step);
  const double small = step / parts;
  for (double k = std::ceil((lo - eps) / small); k * small <= hi + eps; ++k)
    if (std::abs(std::remainder(k, parts)) > 0.5) t.minor.push_back(k * small);
  label(t, step);
  return t;
}

}  // namespace

Ticks linear_ticks(double lo, double hi, double target) {
  const double span = hi - lo;
  if (!(span > 0) || !std::isfinite(span)) return {};
  Ticks t = linear_ticks_about(lo, hi, target);
  for (double more = 1.5; t.major.size() < fewest && more < 8; more *= 1.5)
    t = linear_ticks_about(lo, hi, more * target);
  return t;
}

Ticks log_ticks(double lo, double hi, double target) {
  Ticks t;
  if (!(lo > 0) || !(hi > lo) || !std::isfinite(hi)) return t;
  const int first = static_cast<int>(std::floor(std::log10(lo) + 1e-9)),
            last = static_cast<int>(std::ceil(std::log10(hi) - 1e-9));
  const double decades = std::log10(hi / lo);
  const auto inside = [&](double v) { return v >= lo * (1 - 1e-9) && v <= hi * (1 + 1e-9); };
  if (decades < 0.8) {  // hardly logarithmic: ordinary ticks
    t = linear_ticks(lo, hi, target);
    return t;
  }
  int skip = std::max(1, static_cast<int>(std::ceil(decades / std::max(target, 2.0))));
  const auto powers = [&] {
    int n = 0;
    for (int e = first; e <= last; ++e)
      n += e % skip == 0 && inside(std::pow(10.0, e)) ? 1 : 0;
    return n;
  };
  while (skip > 1 && powers() < static_cast<int>(fewest))
    --skip;
  const bool between = decades < 2.2;
  for (int e = first; e <= last; ++e)
    for (int m = 1; m < 10; ++m) {
      const double v = m * std::pow(10.0, e);
      if (!inside(v)) continue;
      if ((m == 1 && e % skip == 0) || (between && (m == 2 || m == 5))) {
        t.major.push_back(v);
        const bool plain = last - first <= 4 && v >= 0.0099 && v < 1.001e5;
        t.labels.push_back(plain    ? number_text(v, 3)
                           : m == 1 ? power_of_ten(e)
                                    : std::to_string(m) + "·" + power_of_ten(e));
      } else if (skip == 1 || m == 1)
        t.minor.push_back(v);
    }
  return t;
}

Ticks angle_ticks(double lo, double hi) {
  Ticks t;
  const double span = hi - lo, step = span <= 120 ? 15 : span <= 200 ? 30 : span <= 400 ? 90 : 180;
  for (double k = std::ceil(lo / step - 1e-9); k * step <= hi + 1e-9 * span; ++k)
    t.major.push_back(k * step);
  label(t, step);
  return t;
}

Ticks fixed_ticks(const std::vector<double>& at) {
  Ticks t;
  t.major = at;
  double step = 0;
  for (std::size_t k = 1; k < at.size(); ++k)
    step = step == 0 ? std::abs(at[k] - at[k - 1]) : std::min(step, std::abs(at[k] - at[k - 1]));
  label(t, step > 0 ? step : (at.empty() ? 1 : std::max(1e-300, std::abs(at[0]))));
  return t;
}

}  // namespace whirl::plot
