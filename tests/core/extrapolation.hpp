// Gragg-Bulirsch-Stoer extrapolation of order 14 with fixed steps: an integrator for references,
// independent of the program's.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace whirl::test {

/// y' = f(t, y) from t0 to t1 in `steps` steps; f(t, y) returns y'. Scalar: double or long double.
template <class Vec, class F>
Vec extrapolate(const F& f, typename Vec::Scalar t0, typename Vec::Scalar t1, Vec y, int steps) {
  using Real = typename Vec::Scalar;
  constexpr int rows = 7;
  const Real H = (t1 - t0) / steps;
  for (int s = 0; s < steps; ++s) {
    const Real t = t0 + s * H;
    const Vec slope = f(t, y);
    std::vector<Vec> before, row;
    for (int j = 0; j < rows; ++j) {
      const int n = 2 * (j + 1);
      const Real h = H / n;
      Vec a = y, b = y + h * slope;
      for (int i = 1; i < n; ++i) {
        const Vec c = a + 2 * h * f(t + i * h, b);
        a = b;
        b = c;
      }
      // Gragg's smoothing, then Aitken and Neville in h^2
      row.assign(1, (a + b + h * f(t + H, b)) / Real(2));
      for (int k = 1; k <= j; ++k) {
        const Real r = Real(j + 1) / Real(j + 1 - k);
        const auto i = static_cast<std::size_t>(k);
        row.push_back(row[i - 1] + (row[i - 1] - before[i - 1]) / (r * r - 1));
      }
      before = row;
    }
    y = row.back();
  }
  return y;
}

}  // namespace whirl::test
