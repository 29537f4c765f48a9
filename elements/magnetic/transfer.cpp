#include <elements/magnetic/transfer.hpp>

#include <core/contract.hpp>
#include <core/error.hpp>
#include <la/dense.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace whirl::elements {

MatXc StateSpace::at(Complex s) const {
  if (states() == 0) return D.cast<Complex>();
  const MatXc from_states = MatXc(s * MatXc::Identity(states(), states()) - A.cast<Complex>());
  return C.cast<Complex>() * la::DenseLu<Complex>(from_states).solve(MatXc(B.cast<Complex>())) +
         D.cast<Complex>();
}

StateSpace make_gain(double gain) {
  return {MatX(0, 0), MatX(0, 1), MatX(1, 0), MatX::Constant(1, 1, gain)};
}

namespace {

std::vector<double> without_leading_zeros(std::span<const double> c) {
  std::vector<double> out(c.begin(), c.end());
  while (!out.empty() && out.back() == 0.0)
    out.pop_back();
  return out;
}

/// rad/s: the mean size of the poles that are not zero.
double time_scale(const std::vector<double>& a) {
  std::size_t lowest = 0;
  while (a[lowest] == 0.0)
    ++lowest;
  const auto poles = static_cast<double>(a.size() - 1 - lowest);
  return poles > 0 ? std::pow(std::abs(a[lowest] / a.back()), 1.0 / poles) : 1.0;
}

}  // namespace

StateSpace make_transfer(std::span<const double> numerator, std::span<const double> denominator) {
  const std::vector<double> a = without_leading_zeros(denominator);
  std::vector<double> b = without_leading_zeros(numerator);
  if (a.empty()) throw run_error("E84", "the denominator of a transfer function is zero");
  if (b.size() > a.size())
    throw run_error("E84",
                    "the numerator of a transfer function has a higher degree than its "
                    "denominator: it would differentiate noise without end",
                    "give the derivative a lag");
  b.resize(a.size(), 0.0);
  const auto n = static_cast<Index>(a.size() - 1);
  // with s = w p the coefficients of p^k are those of s^k times w^k: entries of one size
  const double w = time_scale(a);
  std::vector<double> scaled_a, scaled_b;
  const double leading = a.back() * std::pow(w, static_cast<double>(n));
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double power = std::pow(w, static_cast<double>(k));
    scaled_a.push_back(a[k] * power / leading);
    scaled_b.push_back(b[k] * power / leading);
  }
  StateSpace out{MatX::Zero(n, n), MatX::Zero(n, 1), MatX::Zero(1, n),
                 MatX::Constant(1, 1, scaled_b.back())};
  for (Index k = 0; k < n; ++k) {
    if (k + 1 < n) out.A(k, k + 1) = w;
    out.A(n - 1, k) = -w * scaled_a[at(k)];
    out.C(0, k) = scaled_b[at(k)] - scaled_a[at(k)] * scaled_b.back();
  }
  if (n > 0) out.B(n - 1, 0) = w;
  return out;
}

StateSpace make_delay(double T, int degree) {
  WHIRL_EXPECTS(T > 0 && degree >= 1 && degree <= 6);
  std::vector<double> numerator, denominator;
  double c = 1.0;  // (2n - k)! n! / ((2n)! k! (n - k)!)
  for (int k = 0; k <= degree; ++k) {
    if (k > 0) c *= static_cast<double>(degree - k + 1) / (k * (2 * degree - k + 1));
    const double term = c * std::pow(T, k);
    denominator.push_back(term);
    numerator.push_back(k % 2 == 0 ? term : -term);
  }
  return make_transfer(numerator, denominator);
}

StateSpace series(const StateSpace& first, const StateSpace& second) {
  WHIRL_EXPECTS(first.outputs() == second.inputs());
  const Index n = first.states(), m = second.states();
  StateSpace out{MatX::Zero(n + m, n + m), MatX(n + m, first.inputs()),
                 MatX(second.outputs(), n + m), second.D * first.D};
  out.A.topLeftCorner(n, n) = first.A;
  out.A.bottomLeftCorner(m, n) = second.B * first.C;
  out.A.bottomRightCorner(m, m) = second.A;
  out.B.topRows(n) = first.B;
  out.B.bottomRows(m) = second.B * first.D;
  out.C.leftCols(n) = second.D * first.C;
  out.C.rightCols(m) = second.C;
  return out;
}

StateSpace parallel(const StateSpace& one, const StateSpace& other) {
  WHIRL_EXPECTS(one.inputs() == other.inputs() && one.outputs() == other.outputs());
  const Index n = one.states(), m = other.states();
  StateSpace out{MatX::Zero(n + m, n + m), MatX(n + m, one.inputs()), MatX(one.outputs(), n + m),
                 one.D + other.D};
  out.A.topLeftCorner(n, n) = one.A;
  out.A.bottomRightCorner(m, m) = other.A;
  out.B.topRows(n) = one.B;
  out.B.bottomRows(m) = other.B;
  out.C.leftCols(n) = one.C;
  out.C.rightCols(m) = other.C;
  return out;
}

StateSpace beside(const StateSpace& one, const StateSpace& other) {
  const Index n = one.states(), m = other.states();
  StateSpace out{MatX::Zero(n + m, n + m), MatX::Zero(n + m, one.inputs() + other.inputs()),
                 MatX::Zero(one.outputs() + other.outputs(), n + m),
                 MatX::Zero(one.outputs() + other.outputs(), one.inputs() + other.inputs())};
  out.A.topLeftCorner(n, n) = one.A;
  out.A.bottomRightCorner(m, m) = other.A;
  out.B.topLeftCorner(n, one.inputs()) = one.B;
  out.B.bottomRightCorner(m, other.inputs()) = other.B;
  out.C.topLeftCorner(one.outputs(), n) = one.C;
  out.C.bottomRightCorner(other.outputs(), m) = other.C;
  out.D.topLeftCorner(one.outputs(), one.inputs()) = one.D;
  out.D.bottomRightCorner(other.outputs(), other.inputs()) = other.D;
  return out;
}

VecX sizes_of_states(const StateSpace& s) {
  const Index n = s.states();
  if (n == 0) return VecX(0);
  const VecXc poles = la::eigenvalues(s.A);
  double slowest = infinity, fastest = 0;
  const double none = 1e-9 * poles.cwiseAbs().maxCoeff();
  for (const Complex& p : poles) {
    if (std::abs(p) <= none) continue;
    slowest = std::min(slowest, std::abs(p));
    fastest = std::max(fastest, std::abs(p));
  }
  if (fastest == 0) slowest = fastest = 1.0;
  VecX size = VecX::Zero(n);
  constexpr int per_decade = 4;
  const double from = 0.1 * slowest;
  const int points =
      static_cast<int>(std::ceil(per_decade * std::log10(100.0 * fastest / slowest)));
  for (int k = 0; k <= points; ++k) {
    const Complex at(0.0, from * std::pow(10.0, static_cast<double>(k) / per_decade));
    const MatXc from_states = at * MatXc::Identity(n, n) - s.A.cast<Complex>();
    const MatXc reached = la::DenseLu<Complex>(from_states).solve(MatXc(s.B.cast<Complex>()));
    size = size.cwiseMax(reached.cwiseAbs().rowwise().maxCoeff());
  }
  const double least = 1e-12 * size.maxCoeff();
  for (double& x : size)
    if (!(x > least)) x = 1.0;
  return size;
}

StateSpace rescaled(const StateSpace& s, const VecX& size) {
  WHIRL_EXPECTS(size.size() == s.states() && (size.array() > 0.0).all());
  const VecX inverse = size.cwiseInverse();
  return {inverse.asDiagonal() * s.A * size.asDiagonal(), inverse.asDiagonal() * s.B,
          s.C * size.asDiagonal(), s.D};
}

}  // namespace whirl::elements
