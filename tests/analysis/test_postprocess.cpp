// Tracking filter and spectra on signals whose content is known.
#include <analysis/transient/revolutions.hpp>
#include <analysis/transient/spectrum.hpp>
#include <gtest/gtest.h>
#include <cmath>
#include <random>

using namespace whirl;
using namespace whirl::analysis;

namespace {

Turn turn_of(int n, bool backward) {
  Turn t;
  t.n = n;
  t.backward = backward;
  t.t0 = 0.0;
  t.t1 = 0.02;
  return t;
}

std::vector<double> samples(const Turn& t, const std::function<double(double)>& x) {
  std::vector<double> out;
  for (int j = 0; j <= t.n; ++j)
    out.push_back(x(two_pi * (t.backward ? t.n - j : j) / t.n));
  return out;
}

}  // namespace

TEST(TrackingFilter, FindsAmplitudeAndPhaseOfEachOrder) {
  const auto x = [](double phi) {
    return 3.0 + 2.0 * std::cos(phi - 0.7) + 0.5 * std::cos(2.0 * phi + 1.9) +
           0.1 * std::sin(5.0 * phi);
  };
  for (const bool backward : {false, true})
    for (const int n : {16, 48}) {
      const Turn t = turn_of(n, backward);
      const auto s = samples(t, x);
      // the trapezoidal rule is exact here: round-off alone is left
      EXPECT_LT(std::abs(synchronous(t, s, 1) - std::polar(2.0, -0.7)), 1e-14);
      EXPECT_LT(std::abs(synchronous(t, s, 2) - std::polar(0.5, 1.9)), 1e-14);
      EXPECT_LT(std::abs(synchronous(t, s, 5) - Complex(0.0, -0.1)), 1e-14);
      EXPECT_LT(std::abs(synchronous(t, s, 3)), 1e-14);
      EXPECT_NEAR(range_of(s).mean, 3.0, 1e-14);
    }
}

TEST(TrackingFilter, ForwardAndBackwardSpeedsHaveSigns) {
  EXPECT_NEAR(turn_of(16, false).speed(), two_pi / 0.02, 1e-12);
  EXPECT_NEAR(turn_of(16, true).speed(), -two_pi / 0.02, 1e-12);
}

TEST(TrackingFilter, RangeOfATurn) {
  const Turn t = turn_of(48, false);
  const Range r = range_of(samples(t, [](double phi) { return 1.0 + std::sin(phi); }));
  EXPECT_NEAR(r.high, 2.0, 1e-15);
  EXPECT_NEAR(r.low, 0.0, 1e-15);
}

TEST(Fft, EqualsTheSum) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const std::size_t n : {1u, 2u, 8u, 64u}) {
    std::vector<Complex> x(n), y;
    for (auto& v : x)
      v = {normal(random), normal(random)};
    y = x;
    fft(y);
    for (std::size_t k = 0; k < n; ++k) {
      Complex sum = 0.0;
      for (std::size_t j = 0; j < n; ++j)
        sum += x[j] *
               std::polar(1.0, -two_pi * static_cast<double>(j * k % n) / static_cast<double>(n));
      EXPECT_LT(std::abs(sum - y[k]), 1e-13 * static_cast<double>(n));
    }
  }
}
