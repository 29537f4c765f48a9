#include <la/axis_count.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::la {

namespace {

constexpr double surprise = 0.4;      ///< of a change of log g, what the slopes do not explain
constexpr double largest_step = 6.0;  ///< of log g between neighbouring samples
constexpr double offset = 1e-4;       ///< of an interval: step of the slopes
constexpr int deepest = 16;           ///< halvings of one interval
constexpr Index most_factorizations = 20000;

/// The argument of an increment of log g in (-pi, pi].
Complex principal(Complex step) { return {step.real(), std::remainder(step.imag(), two_pi)}; }

/// Change of arg(s - root) along the path from rho to i top. Principal values do not jump on it: s -
/// root has no negative real part for roots of the left half plane, root - s none for those of the
/// right one, and about roots within the arc s - root turns from the right over i to the left.
double turn(Complex root, double rho, double top) {
  const Complex from(rho, 0.0);
  const Complex to(0.0, top);
  if (root.real() > 0.0 && std::abs(root) > rho) return std::arg(root - to) - std::arg(root - from);
  const Complex beside(root.real() == 0.0 ? -1e-300 : root.real(), root.imag());
  return std::arg(to - beside) - std::arg(from - beside);
}

double turns_of(const std::vector<Complex>& roots, double rho, double top) {
  double sum = 0.0;
  for (const Complex r : roots) {
    sum += turn(r, rho, top);
    if (r.imag() != 0.0) sum += turn(std::conj(r), rho, top);
  }
  return sum;
}

Complex log_of(Complex s, const std::vector<Complex>& roots) {
  Complex sum = 0.0;
  for (const Complex r : roots) {
    sum += std::log(s - r);
    if (r.imag() != 0.0) sum += std::log(s - std::conj(r));
  }
  return sum;
}

Index growing(const std::vector<Complex>& roots, double rho) {
  Index n = 0;
  for (const Complex r : roots)
    if (r.real() > 0.0 && std::abs(r) > rho) n += r.imag() != 0.0 ? 2 : 1;
  return n;
}

}  // namespace

AxisCounter::AxisCounter(const BlockPattern& pattern, std::span<const unsigned char> active)
    : lu_(pattern, active) {}

Complex AxisCounter::point(double t) const {
  const double rho = problem_->rho;
  if (t == 0.0) return {rho, 0.0};
  if (t < rho) return std::polar(rho, 0.5 * pi * t / rho);
  return {0.0, t};
}

bool AxisCounter::sample(double t, Sample& out) {
  out.t = t;
  const Complex s = point(t);
  const auto log_det = [&](const MCK& m, Complex& log) {
    ++factorizations_;
    if (lu_.factor(m, s * s, s, 1.0) != Status::ok) return false;
    const auto [size, phase] = lu_.determinant();
    log = Complex(size * std::log(10.0), std::arg(phase));
    return true;
  };
  Complex here, held;
  if (!log_det(*problem_->held, held)) return false;
  if (!log_det(problem_->at(t < problem_->rho ? 0.0 : t), here)) return false;
  out.log_g = here - held - log_of(s, problem_->known) + log_of(s, problem_->known_held);
  return std::isfinite(std::abs(out.log_g));
}

bool AxisCounter::slope(const Sample& a, double towards, Complex& out) {
  Sample beside;
  const double step = offset * (towards - a.t);
  if (!sample(a.t + step, beside)) return false;
  out = principal(beside.log_g - a.log_g) / step;
  return true;
}

bool AxisCounter::settle(const Sample& a, const Sample& b, Complex slope_a, Complex slope_b,
                         int depth, Complex& change) {
  Sample middle;
  Complex slope_m;
  if (factorizations_ > most_factorizations || !sample(0.5 * (a.t + b.t), middle)) return false;
  if (!slope(middle, b.t, slope_m)) return false;
  // the integrals of the parabola through the slopes, and what is left of the differences
  const double h = (b.t - a.t) / 24.0;
  const Complex first = h * (5.0 * slope_a + 8.0 * slope_m - slope_b);
  const Complex second = h * (5.0 * slope_b + 8.0 * slope_m - slope_a);
  const Complex rest_first = principal(middle.log_g - a.log_g - first);
  const Complex rest_second = principal(b.log_g - middle.log_g - second);
  const bool expected = std::max(std::abs(rest_first), std::abs(rest_second)) < surprise;
  const bool moderate = std::max(std::abs(first), std::abs(second)) < largest_step;
  if (expected && moderate) {
    change = first + rest_first + second + rest_second;
    return true;
  }
  Complex before, after;
  if (depth == 0 || !settle(a, middle, slope_a, slope_m, depth - 1, before)) return false;
  if (!settle(middle, b, slope_m, slope_b, depth - 1, after)) return false;
  change = before + after;
  return true;
}

AxisCount AxisCounter::count(const AxisProblem& problem) {
  WHIRL_EXPECTS(problem.at && problem.held);
  WHIRL_EXPECTS(0.0 < problem.rho && problem.rho < problem.top && std::isfinite(problem.top));
  WHIRL_EXPECTS(std::is_sorted(problem.stations.begin(), problem.stations.end()));
  problem_ = &problem;
  factorizations_ = 0;
  AxisCount out;
  std::vector<double> stations{0.0, problem.rho};
  for (const double w : problem.stations)
    if (w > problem.rho * (1.0 + 1e-9) && w < problem.top * (1.0 - 1e-9)) stations.push_back(w);
  stations.push_back(problem.top);
  double change = 0.0;
  Sample a;
  if (!sample(0.0, a)) return out;
  for (std::size_t k = 1; k < stations.size(); ++k) {
    Sample b;
    Complex slope_a, slope_b, piece;
    if (!sample(stations[k], b) || !slope(a, b.t, slope_a) || !slope(b, a.t, slope_b)) return out;
    if (!settle(a, b, slope_a, slope_b, deepest, piece)) return out;
    change += piece.imag();
    a = b;
  }
  out.factorizations = factorizations_;
  change += turns_of(problem.known, problem.rho, problem.top) -
            turns_of(problem.known_held, problem.rho, problem.top);
  const double turns = change / pi;
  const Index whole = static_cast<Index>(std::lround(turns));
  out.certain = std::abs(turns - static_cast<double>(whole)) < 0.02;
  out.unknown =
      growing(problem.known_held, problem.rho) - whole - growing(problem.known, problem.rho);
  return out;
}

}  // namespace whirl::la
