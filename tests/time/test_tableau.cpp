// The data of the collocation methods: order conditions, decomposition, stability functions.
#include <gtest/gtest.h>
#include <time/tableau.hpp>
#include <cmath>

namespace whirl::time {
namespace {

const Tableau* const tableaus[] = {&radau5(), &gauss4(), &gauss6()};
std::size_t u(int i) { return static_cast<std::size_t>(i); }

TEST(Tableau, OrderConditions) {
  for (const Tableau* t : tableaus) {
    for (int k = 1; k <= t->order; ++k) {  // B(p)
      double sum = 0;
      for (int i = 0; i < t->stages; ++i)
        sum += t->b[u(i)] * std::pow(t->c[u(i)], k - 1);
      EXPECT_NEAR(sum, 1.0 / k, 2e-16);
    }
    for (int k = 1; k <= t->stages; ++k)  // C(s)
      for (int i = 0; i < t->stages; ++i) {
        double sum = 0;
        for (int j = 0; j < t->stages; ++j)
          sum += t->A[u(i)][u(j)] * std::pow(t->c[u(j)], k - 1);
        EXPECT_NEAR(sum, std::pow(t->c[u(i)], k) / k, 2e-16);
      }
  }
}

TEST(Tableau, Decomposition) {
  for (const Tableau* t : tableaus)
    for (int i = 0; i < t->stages; ++i)
      for (int j = 0; j < t->stages; ++j) {
        const auto I = u(i), J = u(j);
        double inv = 2.0 * (t->lambda_c * t->x_c[I] * t->w_c[J]).real();
        double inv2 = 2.0 * (t->lambda_c * t->lambda_c * t->x_c[I] * t->w_c[J]).real();
        double one = 2.0 * (t->x_c[I] * t->w_c[J]).real();
        if (t->has_real) {
          inv += t->lambda_r * t->x_r[I] * t->w_r[J];
          inv2 += t->lambda_r * t->lambda_r * t->x_r[I] * t->w_r[J];
          one += t->x_r[I] * t->w_r[J];
        }
        double product = 0;
        for (int k = 0; k < t->stages; ++k)
          product += t->A[I][u(k)] * t->Ainv[u(k)][J];
        EXPECT_NEAR(product, i == j ? 1.0 : 0.0, 4e-15);
        EXPECT_NEAR(one, i == j ? 1.0 : 0.0, 4e-15);
        EXPECT_NEAR(inv, t->Ainv[I][J], 4e-14);    // entries up to 20
        EXPECT_NEAR(inv2, t->Ainv2[I][J], 4e-13);  // up to 200
      }
}

// Published digits (Hairer & Wanner II, p. 121 and IV.8): the real eigenvalue of Radau IIA 5 and
// the pair.
TEST(Tableau, KnownEigenvalues) {
  EXPECT_NEAR(radau5().lambda_r, 3.637834252744496, 1e-14);
  EXPECT_NEAR(radau5().lambda_c.real(), 2.681082873627752, 1e-14);
  EXPECT_NEAR(std::abs(radau5().lambda_c.imag()), 3.050430199247411, 1e-14);
  EXPECT_NEAR(gauss4().lambda_c.real(), 3.0, 1e-14);
  EXPECT_NEAR(std::abs(gauss4().lambda_c.imag()), std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(gauss6().lambda_r, 4.6443707092521712, 1e-14);
}

// A quartic (quadratic acceleration) is extrapolated, interpolated and integrated exactly by the
// basis.
TEST(Tableau, BasisAndExtrapolationAreExactForPolynomials) {
  for (const Tableau* t : tableaus) {
    auto accel = [&](double x) {
      return t->stages == 3 ? 1.0 - 2.0 * x + 3.0 * x * x : 1.0 - 2.0 * x;
    };
    auto speed = [&](double x) { return x - x * x + (t->stages == 3 ? x * x * x : 0.0); };
    auto place = [&](double x) {
      return x * x / 2 - x * x * x / 3 + (t->stages == 3 ? x * x * x * x / 4 : 0.0);
    };
    for (double x : {0.0, 0.3, 1.0, 1.7}) {
      const auto b = t->basis(x);
      double a = 0, v = 0, q = 0;
      for (int j = 0; j < t->stages; ++j) {
        const double f = accel(t->c[u(j)]);
        a += b.l[u(j)] * f;
        v += b.l1[u(j)] * f;
        q += b.l2[u(j)] * f;
      }
      EXPECT_NEAR(a, accel(x), 1e-13);
      EXPECT_NEAR(v, speed(x), 1e-13);
      EXPECT_NEAR(q, place(x), 1e-13);
    }
    for (double start : {0.0, 1.0})
      for (double r : {0.2, 1.0, 1.5}) {
        const auto e = t->extrapolation(start, r);
        for (int i = 0; i < t->stages; ++i) {
          double y = 0;
          for (int j = 0; j < t->stages; ++j)
            y += r * r * e[u(i)][u(j)] * accel(t->c[u(j)]);
          const double x = t->c[u(i)] * r;
          EXPECT_NEAR(y, place(start + x) - place(start) - x * speed(start), 2e-13);
        }
      }
  }
}

}  // namespace
}  // namespace whirl::time
