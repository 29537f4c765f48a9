#include <core/contract.hpp>
#include <la/log_change.hpp>
#include <la/wedge_count.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::la {

namespace {

/// log of D at s with the known roots divided out. Conjugates too: D is nearly symmetric.
Complex log_of_known(Complex s, const WedgeProblem& p) {
  Complex sum = 0.0;
  for (const Complex r : p.known)
    sum += std::log(s - r) + std::log(s - std::conj(r));
  for (const Complex r : p.rising)
    sum += std::conj(std::log(s - r));
  return sum;
}

/// t in [-1, 1] on a level of the wedge; samples crowd where lightly damped roots are.
double across(double t, double width, double w) {
  const double grade = std::log1p(8.0 * width / w);
  return std::copysign(w * std::expm1(grade * std::abs(t)) / 8.0, t);
}

}  // namespace

WedgeCounter::WedgeCounter(const BlockPattern& pattern, std::span<const unsigned char> active)
    : lu_(pattern, active) {}

WedgeCount WedgeCounter::count(const WedgeProblem& p) {
  WHIRL_EXPECTS(p.at && 0.0 < p.low && p.low < p.top && std::isfinite(p.top) && p.reach > 0.0);
  WHIRL_EXPECTS(std::is_sorted(p.stations.begin(), p.stations.end()));
  WedgeCount out;
  if (!(p.low > 0.0)) return out;
  const auto log_of = [&](Complex s, Complex& log) {
    ++out.factorizations;
    if (lu_.factor(p.at(s), s * s, s, 1.0) != Status::ok) return false;
    const auto [size, phase] = lu_.determinant();
    log = Complex(size * std::log(10.0), std::arg(phase)) - log_of_known(s, p);
    return true;
  };
  double turned = 0.0;
  const auto follow = [&](const LogChange::Function& f, const std::vector<double>& stations) {
    LogChange path(f);
    for (std::size_t k = 1; k < stations.size(); ++k) {
      Complex change;
      if (!path.over(stations[k - 1], stations[k], change)) return false;
      turned += change.imag();
    }
    return true;
  };
  const auto level = [&](double w) -> LogChange::Function {
    return [&log_of, &p, w](double t, Complex& log) {
      return log_of({across(t, p.reach * w, w), w}, log);
    };
  };
  const auto ray = [&](double side) -> LogChange::Function {
    return [&log_of, &p, side](double t, Complex& log) {
      return log_of({side * p.reach * t, t}, log);
    };
  };
  std::vector<double> up{p.low};
  for (const double w : p.stations)
    if (w > p.low * (1.0 + 1e-9) && w < p.top * (1.0 - 1e-9)) up.push_back(w);
  up.push_back(p.top);
  // D may vary by powers of ten between two stations far apart.
  for (std::size_t k = 1; k < up.size(); ++k)
    if (up[k] > 4.0 * up[k - 1])
      up.insert(up.begin() + static_cast<std::ptrdiff_t>(k), 2.0 * up[k - 1]);
  const std::vector<double> down(up.rbegin(), up.rend());
  const std::vector<double> right{-1.0, 0.0, 1.0};
  const std::vector<double> left(right.rbegin(), right.rend());
  if (!follow(level(p.low), right) || !follow(ray(1.0), up) || !follow(level(p.top), left) ||
      !follow(ray(-1.0), down))
    return out;
  const double turns = turned / two_pi;
  out.unknown = static_cast<Index>(std::lround(turns));
  out.certain = std::abs(turns - static_cast<double>(out.unknown)) < 0.02;
  return out;
}

}  // namespace whirl::la
