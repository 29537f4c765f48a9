// Slopes of a monotone cubic through rows of values: weighted harmonic mean of the chords inside,
// three-point one-sided slopes at the ends, limited (Fritsch & Carlson, SIAM J. Numer. Anal. 17,
// 1980, doi 10.1137/0717021; Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5, 1984, doi
// 10.1137/0905021). Where a column of values is monotone, so is the cubic.
#pragma once
#include <core/contract.hpp>
#include <core/types.hpp>
#include <cmath>
#include <vector>

namespace whirl::elements {

/// x increasing; Row: a fixed-size Eigen array, taken entry by entry. One row: zero slope.
/// @pre as many values as places, x strictly increasing.
template <class Row>
std::vector<Row> monotone_slopes(const std::vector<double>& x, const std::vector<Row>& value) {
  WHIRL_EXPECTS(value.size() == x.size());
  const std::size_t n = x.size();
  std::vector<Row> slope(n, Row::Zero());
  if (n < 2) return slope;
  const auto chord = [&](std::size_t i) {
    return Row((value[i + 1] - value[i]) / (x[i + 1] - x[i]));
  };
  if (n == 2) {
    slope[0] = slope[1] = chord(0);
    return slope;
  }
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = x[i] - x[i - 1], h1 = x[i + 1] - x[i], w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
    const Row d0 = chord(i - 1), d1 = chord(i);
    for (Index k = 0; k < Row::SizeAtCompileTime; ++k)
      slope[i][k] = d0[k] * d1[k] > 0 ? (w0 + w1) / (w0 / d0[k] + w1 / d1[k]) : 0.0;
  }
  const auto end = [](double h0, double h1, const Row& d0, const Row& d1) {
    Row s = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    for (Index k = 0; k < Row::SizeAtCompileTime; ++k) {
      if (s[k] * d0[k] <= 0)
        s[k] = 0;
      else if (d0[k] * d1[k] < 0 && std::abs(s[k]) > 3 * std::abs(d0[k]))
        s[k] = 3 * d0[k];
    }
    return s;
  };
  slope[0] = end(x[1] - x[0], x[2] - x[1], chord(0), chord(1));
  slope[n - 1] = end(x[n - 1] - x[n - 2], x[n - 2] - x[n - 3], chord(n - 2), chord(n - 3));
  return slope;
}

}  // namespace whirl::elements
