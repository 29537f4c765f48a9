#include <core/contract.hpp>
#include <la/axis_count.hpp>
#include <la/log_change.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::la {

namespace {

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

bool AxisCounter::log_g(double t, Complex& out) {
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
  out = here - held - log_of(s, problem_->known) + log_of(s, problem_->known_held);
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
  LogChange path([this](double t, Complex& log) { return log_g(t, log); });
  for (std::size_t k = 1; k < stations.size(); ++k) {
    Complex piece;
    if (!path.over(stations[k - 1], stations[k], piece)) return out;
    change += piece.imag();
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
