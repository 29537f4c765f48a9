// The series of the shaft's strain measures: every branch against long double.
#include <core/dual_rate.hpp>
#include <system/kernel.hpp>

#include <gtest/gtest.h>

#include <math.h>
#include <array>
#include <cmath>

namespace whirl::elements {
namespace {

#include <elements/shaft/shaft_single.inl>

/// Derivative k of G = sum g_j n^j, g_j = j!/(2j + 1)!!, and F = 2 n sum g_j/(j + 1) n^j.
long double series(long double n, int derivative) {
  long double g = 1.0L, sum = 0.0L;
  for (int j = 0; j <= 400; ++j) {
    if (j > 0) g *= j / (2.0L * j + 1.0L);
    long double factor = g;
    for (int k = 0; k < derivative; ++k)
      factor *= j - k;
    if (j >= derivative) sum += factor * std::pow(n, static_cast<long double>(j - derivative));
  }
  return sum;
}

/// Both sides of every change of branch.
constexpr std::array<double, 11> cosine_deficits{0.0,     1e-24,  1e-9, 1.99e-4, 2.01e-4, 0.0199,
                                                 0.02001, 0.0201, 0.3,  1.0,     1.7};

}  // namespace

TEST(AngleRatio, AgreesWithLongDoubleInEveryBranch) {
  for (double n : cosine_deficits) {
    const AngleRatio<double> r = angle_ratio(n);
    const long double theta = 2.0L * std::asin(std::sqrt(0.5L * n));
    const double F = static_cast<double>(theta * theta), G = static_cast<double>(series(n, 0)),
                 G1 = static_cast<double>(series(n, 1)), G2 = static_cast<double>(series(n, 2)),
                 G3 = static_cast<double>(series(n, 3));
    EXPECT_NEAR(r.F, F, 8e-16 * F) << n;
    EXPECT_NEAR(r.G, G, 8e-16 * G) << n;
    // the closed form k multiplies the round-off of the one before by (2 k - 1)/(n (2 - n)), 25
    // (2 k - 1) where it begins: 6e-15, 4e-13, 5e-11, of derivatives of about 0.3
    EXPECT_NEAR(r.G1, G1, 2e-14 * G1) << n;
    EXPECT_NEAR(angle_ratio_second(n, r), G2, 2e-12 * G2) << n;
    EXPECT_NEAR(angle_ratio_third(n, r), G3, 2e-10 * G3) << n;
  }
}

TEST(AngleRatio, DualsCarryItsDerivatives) {
  for (double n : cosine_deficits) {
    const AngleRatio<double> r = angle_ratio(n);
    const double second = angle_ratio_second(n, r), third = angle_ratio_third(n, r);
    const auto dual = angle_ratio(Dual<1>::variable(n, 0));
    EXPECT_EQ(dual.F.g[0], 2.0 * r.G);
    EXPECT_EQ(dual.G.g[0], r.G1);
    EXPECT_EQ(dual.G1.g[0], second);
    const auto moving = angle_ratio(DualRate<1>::variable(n, 3.0, 0));
    EXPECT_EQ(moving.F.h[0], 6.0 * r.G1);
    EXPECT_EQ(moving.G.h[0], 3.0 * second);
    EXPECT_EQ(moving.G1.h[0], 3.0 * third);
  }
}

TEST(Arctangent, AgreesWithLongDouble) {
  for (double y : {0.0, 1e-20, -1e-6, 0.0316, -0.0317, 0.5, 2.0})
    for (double x : {1.0, 0.9, -0.4}) {
      const double exact = static_cast<double>(std::atan2(static_cast<long double>(y), x));
      EXPECT_NEAR(arctangent(y, x), exact, 4.5e-16 * std::abs(exact)) << y << ' ' << x;
    }
}

TEST(ShearGive, ContinuesWithValueAndTwoSlopes) {
  // g = N^2/(1 + N/kGA) down to -kGA/2, its parabola below: one formula, no corner
  const double softness = 0.25, limit = -2.0, step = 1e-4;
  for (double N : {3.0, -1.0, limit, -5.0}) {
    const auto at = [&](double force) { return shear_give(force, softness, limit); };
    const ShearGive<double> r = at(N);
    const double inside = std::max(N, limit), rho = 1.0 / (1.0 + softness * inside);
    const double past = N - inside, slope = inside * rho * (1.0 + rho);
    EXPECT_NEAR(r.g, inside * inside * rho + slope * past + rho * rho * rho * past * past, 1e-13);
    // central differences, truncation 1e-8
    EXPECT_NEAR((at(N + step).g - at(N - step).g) / (2.0 * step), 2.0 * r.g1, 1e-6);
    EXPECT_NEAR((at(N + step).g1 - at(N - step).g1) / (2.0 * step), r.g2, 1e-3);
  }
}

}  // namespace whirl::elements
