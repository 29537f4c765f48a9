#include <core/contract.hpp>
#include <la/dense.hpp>
#include <la/log_change.hpp>
#include <la/root_count.hpp>

#include <cmath>

namespace whirl::la {

namespace {

constexpr double largest_arc_step = 12.0;  ///< of log f between neighbouring samples
constexpr double counting_surprise =
    0.4;  ///< of that, what the slopes do not explain: enough to count
constexpr double moment_surprise = 2e-3;  ///< and to say where the roots are
constexpr int deepest_arc = 14;           ///< halvings of one interval
constexpr Index most_arc_samples = 400;

/// Zeros of the polynomial whose roots have the power sums p_1 .. p_n (Newton's identities).
std::vector<Complex> roots_of_moments(const std::vector<double>& p) {
  const Index n = static_cast<Index>(p.size());
  VecX e = VecX::Zero(n + 1);  // elementary symmetric functions
  e(0) = 1.0;
  for (Index k = 1; k <= n; ++k) {
    double sum = 0.0;
    for (Index i = 1; i <= k; ++i)
      sum += (i % 2 ? 1.0 : -1.0) * e(k - i) * p[static_cast<std::size_t>(i - 1)];
    e(k) = sum / static_cast<double>(k);
  }
  MatX companion = MatX::Zero(n, n);
  for (Index k = 0; k < n; ++k)
    companion(0, k) = (k % 2 ? -1.0 : 1.0) * e(k + 1);
  for (Index k = 1; k < n; ++k)
    companion(k, k - 1) = 1.0;
  if (!companion.allFinite()) return {};
  const VecXc values = eigenvalues(companion);
  std::vector<Complex> out;
  for (const Complex v : values)
    if (v.imag() >= 0.0) out.push_back(v);
  return out;
}

}  // namespace

bool CountRegion::contains(Complex s) const {
  if (s.real() >= 0.0) return std::abs(s) <= radius;
  return s.real() >= -reach && std::abs(s.imag()) <= radius;
}

RootCounter::RootCounter(const BlockPattern& pattern, std::span<const unsigned char> active)
    : lu_(pattern, active) {}

Complex RootCounter::point(double t) const {
  const double r = region_.radius;
  if (t <= 1.0) return std::polar(r, 0.5 * pi * t);
  if (t <= 2.0) {
    // Samples crowd where lightly damped roots are.
    const double grade = std::log1p(8.0 * region_.reach / r);
    return {-r * std::expm1(grade * (t - 1.0)) / 8.0, r};
  }
  return {-region_.reach, r * (3.0 - t)};
}

Complex RootCounter::log_f(Complex s) {
  ++factorizations_;
  if (lu_.factor(*m_, s * s, s, 1.0) != Status::ok) return {nan, nan};
  const auto [size, phase] = lu_.determinant();
  Complex out(size * std::log(10.0), std::arg(phase));
  for (const Complex k : known_) {
    out -= std::log(s - k);
    if (k.imag() != 0.0) out -= std::log(s - std::conj(k));
  }
  return out;
}

Complex RootCounter::direction(double t, double within) const {
  const double r = region_.radius;
  if (within <= 1.0) return Complex(0.0, 0.5 * pi) * std::polar(r, 0.5 * pi * t);
  if (within >= 2.0) return {0.0, -r};
  const double grade = std::log1p(8.0 * region_.reach / r);
  return -r * grade * std::exp(grade * (t - 1.0)) / 8.0;
}

bool RootCounter::sample(double t, Sample& out) {
  out.t = t;
  out.s = point(t);
  if (t == 0.0 || t == 3.0) out.s.imag(0.0);  // exactly real: f is
  out.log_f = log_f(out.s);
  const Complex beside = region_.slope_step * region_.radius * Complex(0.6, 0.8);
  out.slope = principal(log_f(out.s + beside) - out.log_f) / beside;
  return std::isfinite(std::abs(out.log_f)) && std::isfinite(std::abs(out.slope));
}

bool RootCounter::settle(const Sample& a, const Sample& b, int depth) {
  Sample middle;
  unsettled_ = a.s;
  if (static_cast<Index>(samples_.size()) > most_arc_samples || !sample(0.5 * (a.t + b.t), middle))
    return false;
  // d log f/dt at the three, the integrals of the parabola through them, and what is left of the
  // differences.
  const Complex ga = a.slope * direction(a.t, middle.t);
  const Complex gm = middle.slope * direction(middle.t, middle.t);
  const Complex gb = b.slope * direction(b.t, middle.t);
  const double h = (b.t - a.t) / 24.0;
  const Complex first = h * (5.0 * ga + 8.0 * gm - gb);
  const Complex second = h * (5.0 * gb + 8.0 * gm - ga);
  const Complex rest_first = principal(middle.log_f - a.log_f - first);
  const Complex rest_second = principal(b.log_f - middle.log_f - second);
  const bool expected = std::max(std::abs(rest_first), std::abs(rest_second)) < surprise_;
  const bool moderate = std::max(std::abs(first), std::abs(second)) < largest_arc_step;
  if (expected && moderate) {
    middle.log_f = a.log_f + first + rest_first;
    samples_.push_back(middle);
    samples_.push_back(b);
    samples_.back().log_f = middle.log_f + second + rest_second;
    return true;
  }
  if (depth == 0 || !settle(a, middle, depth - 1)) return false;
  const Sample reached = samples_.back();
  return settle(reached, b, depth - 1);
}

void RootCounter::add_moments(const Sample& a, const Sample& b,
                              std::vector<double>& moments) const {
  const Complex chord = b.s - a.s;
  const Complex rise = b.log_f - a.log_f;
  const Complex first = a.slope * chord;
  const Complex last = b.slope * chord;
  // log f as the cubic with these ends and slopes; three points of Gauss.
  constexpr double offset = 0.3872983346207417;
  constexpr double at[] = {0.5 - offset, 0.5, 0.5 + offset};
  constexpr double weight[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  for (int g = 0; g < 3; ++g) {
    const double u = at[g];
    const Complex derivative = 6.0 * u * (1.0 - u) * rise + (3.0 * u * u - 4.0 * u + 1.0) * first +
                               (3.0 * u * u - 2.0 * u) * last;
    const Complex s = (a.s + u * chord) / region_.radius;
    Complex power = s;
    for (double& moment : moments) {
      moment += weight[g] * (power * derivative).imag() / pi;
      power *= s;
    }
  }
}

bool RootCounter::follow_curve(double surprise) {
  surprise_ = surprise;
  samples_.clear();
  const double stations[] = {0.0, 0.6, 1.0, 1.4, 2.0, 3.0};
  for (const double t : stations) {
    Sample next;
    unsettled_ = point(t);
    if (!sample(t, next)) return false;
    if (samples_.empty()) {
      samples_.push_back(next);
      continue;
    }
    const Sample last = samples_.back();
    if (!settle(last, next, deepest_arc)) return false;
  }
  return true;
}

RootCount RootCounter::count(const MCK& m, const CountRegion& region,
                             std::span<const Complex> known) {
  WHIRL_EXPECTS(region.radius > 0.0 && std::isfinite(region.radius));
  WHIRL_EXPECTS(region.reach > 0.0 && std::isfinite(region.reach));
  m_ = &m;
  region_ = region;
  known_.assign(known.begin(), known.end());
  factorizations_ = 0;
  RootCount out;
  const bool settled = follow_curve(counting_surprise);
  out.factorizations = factorizations_;
  if (!settled) {
    out.crossed = unsettled_;
    return out;
  }
  // f is real on the real axis: what is no whole number is no count.
  const double turns = (samples_.back().log_f.imag() - samples_.front().log_f.imag()) / pi;
  out.unknown = static_cast<Index>(std::lround(turns));
  out.certain = std::abs(turns - static_cast<double>(out.unknown)) < 0.02;
  return out;
}

std::vector<Complex> RootCounter::locate(Index unknown) {
  WHIRL_EXPECTS(m_ != nullptr);
  std::vector<Complex> out;
  if (unknown <= 0 || !follow_curve(moment_surprise)) return out;
  std::vector<double> moments(static_cast<std::size_t>(unknown), 0.0);
  for (std::size_t k = 1; k < samples_.size(); ++k)
    add_moments(samples_[k - 1], samples_[k], moments);
  for (const Complex z : roots_of_moments(moments))
    out.push_back(z * region_.radius);
  return out;
}

double RootCounter::crowd_rate(Index unknown) const {
  WHIRL_EXPECTS(m_ != nullptr && unknown > 0);
  constexpr double narrow = 0.3;  // of the mean: from 1/beta to 2/beta, most of them at 1/beta
  std::vector<double> moments(2, 0.0);
  for (std::size_t k = 1; k < samples_.size(); ++k)
    add_moments(samples_[k - 1], samples_[k], moments);
  const double mean = moments[0] / static_cast<double>(unknown),
               variance = moments[1] / static_cast<double>(unknown) - mean * mean,
               spread = std::sqrt(std::max(variance, 0.0));
  // pairs off the axis take away from the second moment
  if (!(mean < 0.0) || spread > narrow * -mean ||
      std::sqrt(std::max(-variance, 0.0)) > narrow * -mean)
    return infinity;
  return (-mean - spread) * region_.radius;
}

}  // namespace whirl::la
