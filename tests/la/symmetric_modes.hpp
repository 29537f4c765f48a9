// Undamped modes at rest, real and proved complete: what other solutions are compared with.
#pragma once
#include <core/error.hpp>
#include <la/block_lu.hpp>
#include <la/eigen.hpp>
#include <la/multiply.hpp>
#include <algorithm>
#include <cmath>

namespace whirl::la {

/// A mode of K x = omega^2 M x with symmetric K and M, M positive semidefinite.
struct RealMode {
  double omega2 = 0.0;    ///< (rad/s)^2; negative beyond buckling
  VecX x;                 ///< x^T M x = 1
  double residual = 0.0;  ///< backward error as in Mode
};

/// The `count` eigenvalues omega^2 of least size in ascending order (undamped, at rest). C is not
/// looked at. That none is missing below the last is proved by the inertia of K - s M (Sylvester),
/// which needs K with few negative eigenvalues, or none.
inline std::vector<RealMode> symmetric_modes(const MCK& m, std::span<const unsigned char> active,
                                             Index count, double tolerance = 1e-12) {
  // lambda = -omega^2: a positive shift then makes K + sigma M definite.
  MCK problem(m.K.pattern());
  problem.K = m.K;
  problem.C = m.M;
  BlockLu<double> inertia(m.K.pattern(), active);
  std::vector<RealMode> modes;
  Index guard = 2;
  for (int round = 0;; ++round) {
    ModeOptions options;
    options.count = count + guard;
    options.tolerance = tolerance;
    const std::vector<Mode> found = quadratic_modes(problem, active, options);
    modes.clear();
    for (const Mode& f : found)
      modes.push_back({-f.lambda.real(), f.x.real(), f.residual});
    std::stable_sort(modes.begin(), modes.end(),
                     [](const RealMode& a, const RealMode& b) { return a.omega2 < b.omega2; });
    const Index n = static_cast<Index>(modes.size());
    if (n == 0) return modes;
    // Sylvester: K - s M has as many negative eigenvalues as there are modes below s. s stands in
    // the widest gap above the wanted ones, or above all modes when these are all there are.
    Index below = n;
    double s = modes.back().omega2 +
               1e-6 * (std::abs(modes.back().omega2) + std::abs(modes.front().omega2));
    if (n > count) {
      double widest = -1.0;
      for (Index i = std::min(count, n - 1); i < n; ++i) {
        const double a = modes[static_cast<std::size_t>(i - 1)].omega2,
                     b = modes[static_cast<std::size_t>(i)].omega2;
        const double gap = (b - a) / (std::abs(a) + std::abs(b));
        if (gap > widest) {
          widest = gap;
          below = i;
          s = 0.5 * (a + b);
        }
      }
    }
    if (inertia.factor(m, -s, 0.0, 1.0) == Status::ok && inertia.negative_eigenvalues() == below)
      break;
    if (round == 4)
      throw run_error("E62", "the number of modes found does not agree with the inertia of K - s M",
                      "check that M and K are symmetric and M is not indefinite");
    guard = 2 * guard + 1;
  }
  if (static_cast<Index>(modes.size()) > count) modes.resize(static_cast<std::size_t>(count));
  // x^T M x = 1, and M-orthogonal within groups of equal eigenvalues (the others are already).
  VecX Mx(6 * m.M.pattern().size());
  for (std::size_t i = 0; i < modes.size(); ++i) {
    for (int pass = 0; pass < 2; ++pass)
      for (std::size_t j = i; j-- > 0 && modes[i].omega2 - modes[j].omega2 <=
                                             1e-6 * (std::abs(modes[i].omega2) +
                                                     std::abs(modes.back().omega2) * 1e-6);) {
        multiply(m.M, modes[j].x, Mx);
        modes[i].x -= modes[i].x.dot(Mx) * modes[j].x;
      }
    multiply(m.M, modes[i].x, Mx);
    const double mass = modes[i].x.dot(Mx);
    if (mass > 0.0) modes[i].x /= std::sqrt(mass);
  }
  return modes;
}

}  // namespace whirl::la
