// Fourier coefficients of curves given by points.
#include <core/periodic.hpp>
#include <gtest/gtest.h>
#include <cmath>

using namespace whirl;

// A triangle between -1 and 1: 8/pi^2 sum cos(k x)/k^2 over odd k (0 at its top).
TEST(Periodic, CoefficientsOfATriangle) {
  const std::vector<double> x{0, pi}, f{1, -1};
  for (int k = 1; k < 8; ++k)
    EXPECT_NEAR(std::abs(periodic_coefficient(x, f, two_pi, k) -
                         (k % 2 == 1 ? 4 / (pi * pi * k * k) : 0.0)),
                0, 1e-15)
        << k;
}

// Any points: against the trapezoidal rule over each straight piece, refined.
TEST(Periodic, CoefficientsOfUnevenPoints) {
  const std::vector<double> x{0.3, 0.5, 1.9, 2.2, 4.0}, f{2, -1, 0.5, 3, 1};
  const double period = 4.5;
  const auto value = [&](double t) {
    std::size_t j = 0;
    while (j + 1 < x.size() && x[j + 1] <= t)
      ++j;
    const bool last = j + 1 == x.size();
    const double b = last ? x[0] + period : x[j + 1], g = last ? f[0] : f[j + 1];
    return f[j] + (g - f[j]) * (t - x[j]) / (b - x[j]);
  };
  constexpr int n = 200000;
  for (const int k : {1, 2, 5, -3}) {
    Complex sum = 0;
    for (int i = 0; i < n; ++i) {
      const double t = x[0] + period * (i + 0.5) / n;
      sum += value(t) * std::polar(1.0, -two_pi * k * t / period);
    }
    EXPECT_NEAR(std::abs(periodic_coefficient(x, f, period, k) - sum / double(n)), 0, 1e-9) << k;
  }
}

// cos x + cos 2x between 2 and -9/8 (cos x = -1/4); sin x + sin 2x both ways as far.
TEST(Periodic, SwingOfASum) {
  EXPECT_NEAR(calc_swing({1, 1}, {1, 2}), 3.125, 1e-14);
  EXPECT_NEAR(calc_swing({1, 1}, {0.5, 1}), 3.125, 1e-14);
  EXPECT_NEAR(calc_swing({1, 1}, {1.5, 3}), 3.125, 1e-14);
  const double top = std::acos((std::sqrt(33.0) - 1) / 8);
  EXPECT_NEAR(calc_swing({Complex(0, -1), Complex(0, -1)}, {1, 2}),
              2 * (std::sin(top) + std::sin(2 * top)), 1e-14);
  // a shift of x changes nothing
  EXPECT_NEAR(calc_swing({std::polar(1.0, 0.3), std::polar(1.0, 0.6)}, {1, 2}), 3.125, 1e-14);
  EXPECT_EQ(calc_swing({Complex(3, 4)}, {0.123}), 10);
  EXPECT_EQ(calc_swing({Complex(3, 4), 1}, {1, std::sqrt(2.0)}), 12);  // never repeats
  EXPECT_EQ(calc_swing({0, 0}, {1, 2}), 0);
}
