#include <analysis/study/scheme_damping.hpp>
#include <core/contract.hpp>

#include <time/stability.hpp>

#include <la/dense.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

constexpr double shortest = 1e-16;  // s

Complex generalized_alpha(double rho, Complex lambda, double h) {
  // Chung and Hulbert; the undamped oscillator of frequency |lambda|, in (q, h v, h^2 a)
  const double am = (2.0 * rho - 1.0) / (rho + 1.0), af = rho / (rho + 1.0), gamma = 0.5 - am + af,
               beta = 0.25 * (1.0 - am + af) * (1.0 - am + af);
  const double w2 = std::norm(lambda) * h * h;
  Mat3 left, right;
  left << 1, 0, -beta, 0, 1, -gamma, (1 - af) * w2, 0, 1 - am;
  right << 1, 1, 0.5 - beta, 0, 1, 1 - gamma, -af * w2, 0, -am;
  const Mat3 A = left.inverse() * right;
  const VecXc roots = la::eigenvalues(A);
  // the principal pair is the one nearest to the exact factor
  const Complex exact = std::polar(1.0, std::sqrt(w2));
  Complex best = roots[0];
  for (int k = 1; k < 3; ++k)
    if (std::abs(roots[k] - exact) < std::abs(best - exact)) best = roots[k];
  return best * std::exp(lambda.real() * h);
}

}  // namespace

Complex amplification(std::string_view method, double rho_inf, Complex lambda, double h) {
  if (method == "radau5" || method == "gauss4" || method == "gauss6")
    return time::stability_function(method, lambda * h);
  if (method == "generalized_alpha") return generalized_alpha(rho_inf, lambda, h);
  return {nan, nan};
}

double numerical_decay(std::string_view method, double rho_inf, Complex lambda, double h) {
  WHIRL_EXPECTS(h > 0.0);
  return -std::log(std::abs(amplification(method, rho_inf, lambda, h))) / h + lambda.real();
}

void StepHistogram::look(const Snapshot& s) {
  spin_ = std::max(spin_, std::abs(s.node(reference_).spin()));
}

void StepHistogram::step(StepAccess& s) {
  const double h = s.t1() - s.t0();
  const auto bin = static_cast<std::size_t>(
      std::clamp(std::log2(h / shortest) * per_octave, 0.0, static_cast<double>(time_.size() - 1)));
  time_[bin] += h;
  seconds_ += h;
  look(s.end());
}

double StepHistogram::mean_decay(std::string_view method, double rho_inf, Complex lambda) const {
  double sum = 0.0, counted = 0.0;
  for (std::size_t k = 0; k < time_.size() && counted < 0.5 * seconds_; ++k) {
    const double part = std::min(time_[k], 0.5 * seconds_ - counted);
    if (!(part > 0.0)) continue;
    sum +=
        part * numerical_decay(method, rho_inf, lambda,
                               shortest * std::exp2((static_cast<double>(k) + 0.5) / per_octave));
    counted += part;
  }
  return counted > 0.0 ? sum / counted : 0.0;
}

void StepHistogram::save(OutArchive& out) const {
  out.put(spin_);
  out.put(seconds_);
  out.put(time_);
}

void StepHistogram::restore(InArchive& in) {
  spin_ = in.number();
  seconds_ = in.number();
  time_ = in.numbers();
  time_.resize(per_octave * octaves);
}

}  // namespace whirl::analysis
