#include <core/error.hpp>
#include <core/law.hpp>
#include <core/types.hpp>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <string_view>

using namespace whirl;

namespace {

struct Case {
  const char* name;
  LawPtr law;
};

std::vector<Case> all() {
  const std::vector<double> t{-1.0, 0.5, 1.0, 3.0}, f{2.0, -1.0, 4.0, 5.0};
  auto table = make_table(t, f);
  return {{"constant", make_constant(3.5)},
          {"table", table},
          {"pchip", make_pchip(t, f)},
          {"ramp", make_table({0.2, 1.7}, {1, -4})},
          {"smooth", make_smooth_step(0.2, 1.7, 1, -4)},
          {"cosine", make_cosine_step(0.2, 1.7, 1, -4)},
          {"harmonic", make_harmonic(1, 2, 5, 0.3)},
          {"slow harmonic", make_harmonic(1, 2, 1e-9, 0.3)},
          {"decaying", make_decaying(0.4, 2, 5, 0.3, 0.7)},
          {"decaying from before", make_decaying(-0.6, 2, 0, 0, 0.7)},
          {"polynomial", make_polynomial({1, -2, 0.5, 0.25})},
          {"piecewise",
           make_piecewise({-0.5, 0.8, 2.0}, {table, make_harmonic(0, 1, 2, 0), make_constant(7)})},
          {"sum", make_sum({table, make_smooth_step(0, 2, 0, 3)})},
          {"angle", make_angle_of_speed(make_smooth_step(0.2, 1.7, 1, -4), 0.7)},
          {"angle of harmonic", make_angle_of_speed(make_harmonic(1, 2, 5, 0.3), 0.7)}};
}

bool near_break(const Law& law, double t, double h) {
  for (double b : law.breakpoints())
    if (std::abs(t - b) <= h) return true;
  return false;
}

}  // namespace

TEST(Law, DerivativesAgreeWithDifferences) {
  const double h = 1e-3;
  for (const auto& c : all())
    for (double t = -1.93; t < 4.0; t += 0.0971) {
      if (near_break(*c.law, t, 3 * h)) continue;
      const LawValue v = c.law->at(t);
      const auto f = [&](double s) { return c.law->at(s).f; };
      const auto g = [&](double s) { return c.law->at(s).df; };
      // sixth-order differences: truncation h^6 f^(7)/140 < 1e-13, rounding 1e-13/h
      const auto slope = [&](auto& y) {
        return (45 * (y(t + h) - y(t - h)) - 9 * (y(t + 2 * h) - y(t - 2 * h)) + y(t + 3 * h) -
                y(t - 3 * h)) /
               (60 * h);
      };
      EXPECT_NEAR(v.df, slope(f), 1e-10) << c.name << " t=" << t;
      EXPECT_NEAR(v.ddf, slope(g), 1e-10) << c.name << " t=" << t;
      const auto I = [&](double s) { return c.law->integral(s); };
      EXPECT_NEAR(v.f, slope(I), 1e-10) << c.name << " t=" << t;
    }
}

TEST(Law, IntegralsStartAtZeroAndAreContinuous) {
  for (const auto& c : all()) {
    EXPECT_NEAR(c.law->integral(0.0), 0.0, 1e-15) << c.name;
    for (double b : c.law->breakpoints())
      EXPECT_NEAR(c.law->integral(std::nextafter(b, -1e9)), c.law->integral(b), 4e-15) << c.name;
  }
}

TEST(Law, IntegralsAgainstClosedForms) {
  EXPECT_DOUBLE_EQ(make_table({1, 3}, {2, 6})->integral(5), 2 + 8 + 12);
  EXPECT_DOUBLE_EQ(make_smooth_step(1, 3, 2, 6)->integral(5), 2 + 8 + 12);
  EXPECT_DOUBLE_EQ(make_cosine_step(1, 3, 2, 6)->integral(5), 2 + 8 + 12);
  EXPECT_DOUBLE_EQ(make_table({0, 1, 2}, {0, 1, 0})->integral(2), 1.0);
  EXPECT_DOUBLE_EQ(make_polynomial({1, 2, 3})->integral(2), 2 + 4 + 8);
  EXPECT_DOUBLE_EQ(make_harmonic(0, 1, 2, 0)->integral(1), std::sin(2.0) / 2);
  EXPECT_DOUBLE_EQ(make_harmonic(0, 1, 0, 0)->integral(3), 3.0);
  EXPECT_DOUBLE_EQ(make_piecewise({0, 1}, {make_constant(2), make_constant(5)})->integral(3), 12.0);
  EXPECT_DOUBLE_EQ(make_piecewise({0, 1}, {make_constant(2), make_constant(5)})->integral(-3),
                   -6.0);
  // double integral of a linear ramp: t^3/6
  EXPECT_NEAR(make_angle_of_speed(make_table({0, 10}, {0, 10}), 1)->integral(3), 3 + 4.5, 1e-14);
  EXPECT_NEAR(make_angle_of_speed(make_table({0, 10}, {0, 10}), 1)->integral(-3), -3, 1e-14);
}

TEST(Law, AngleOfSpeedIsExactOverALongRun) {
  // 10 s ramp to 1000 rad/s, then hold to 1e6 s: 1e9 rad with a relative rounding error only
  const auto law = make_angle_of_speed(make_table({0, 10}, {0, 1000}), 0);
  EXPECT_DOUBLE_EQ(law->at(1e6).f, 5000 + 1000 * (1e6 - 10));
  EXPECT_DOUBLE_EQ(law->at(5).f, 1250);
  EXPECT_DOUBLE_EQ(law->at(5).df, 500);
  EXPECT_DOUBLE_EQ(law->at(5).ddf, 100);
}

TEST(Law, HeldOutsideAndRightContinuous) {
  const auto ramp = make_table({1, 2}, {3, 5});
  EXPECT_EQ(ramp->at(0).f, 3);
  EXPECT_EQ(ramp->at(9).f, 5);
  EXPECT_EQ(ramp->at(1).df, 2);
  EXPECT_EQ(ramp->at(2).df, 0);
  EXPECT_EQ(ramp->at(std::nextafter(2.0, 0.0)).df, 2);
  EXPECT_EQ(make_table({1}, {4})->at(0).f, 4);
}

TEST(Law, SmoothStepHasZeroEndDerivatives) {
  const auto s = make_smooth_step(1, 3, 0, 2);
  for (double t : {1.0, std::nextafter(3.0, 0.0)}) {
    EXPECT_NEAR(s->at(t).df, 0, 1e-12);
    EXPECT_NEAR(s->at(t).ddf, 0, 1e-12);
  }
  EXPECT_DOUBLE_EQ(s->at(2).f, 1);
}

TEST(Law, PchipIsMonotoneAndHitsItsPoints) {
  // RPN 14 data of Fritsch and Carlson (doi 10.1137/0717021): a cubic spline overshoots, a monotone
  // cubic must not
  const std::vector<double> t{7.99, 8.09, 8.19, 8.7, 9.2, 10, 12, 15, 20};
  const std::vector<double> f{0,        2.76429e-5, 4.37498e-2, 0.169183, 0.469428,
                              0.943740, 0.998636,   0.999919,   0.999994};
  const auto p = make_pchip(t, f);
  for (std::size_t i = 0; i < t.size(); ++i)
    EXPECT_DOUBLE_EQ(p->at(t[i]).f, f[i]);
  for (double s = 7.99; s < 20; s += 0.003)
    EXPECT_GE(p->at(s).df, -1e-15) << s;
  // exact on a straight line
  const auto line = make_pchip({0, 1, 4}, {1, 3, 9});
  EXPECT_NEAR(line->at(2.7).f, 6.4, 1e-14);
}

TEST(Law, BreakpointsAreListedOnce) {
  const auto a = make_table({1, 2}, {0, 1});
  EXPECT_EQ(make_sum({a, make_table({2, 3}, {0, 1})})->breakpoints(),
            (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(make_piecewise({0, 1.5}, {a, make_constant(0)})->breakpoints(),
            (std::vector<double>{1, 1.5}));
  EXPECT_TRUE(make_harmonic(0, 1, 1, 0)->breakpoints().empty());
  EXPECT_EQ(make_angle_of_speed(a, 0)->breakpoints(), a->breakpoints());
}

// In a step that keeps the pace the law moves by no more than four fifths of all it moves.
TEST(Law, PacesMissNothing) {
  for (const auto& [name, law] :
       {Case{"smooth", make_smooth_step(0.2, 1.7, 1, -4)},
        Case{"cosine", make_cosine_step(0.2, 1.7, 1, -4)},
        Case{"harmonic", make_harmonic(1, 2, 50, 0.3)},
        Case{"decaying", make_decaying(0.4, 2, 500, 0.3, 0.01)},
        Case{"pulse", make_decaying(0.4, 2, 0, 0, 0.01)},
        Case{"sum", make_sum({make_constant(2), make_decaying(0.4, 2, 500, 0.3, 0.01)})},
        Case{"piecewise", make_piecewise({0, 0.3}, {make_constant(1), make_harmonic(0, 3, 40, 0)})},
        Case{"angle", make_angle_of_speed(make_smooth_step(0.2, 1.7, 1, -4), 0.7)}}) {
    const bool angle = std::string_view(name) == "angle";
    const auto value = [angle, &law = law](double t) {
      return angle ? law->at(t).df : law->at(t).f;
    };
    double low = infinity, high = -infinity;
    for (double t = 0.0; t < 2.0; t += 1e-4) {
      low = std::min(low, value(t));
      high = std::max(high, value(t));
    }
    for (double t = 0.0; t < 2.0; t += 1e-3) {
      double step = std::min(longest_step(law->paces(), t), 2.0 - t);
      for (const double b : law->breakpoints())
        if (b > t) step = std::min(step, b - t);
      double most = 0.0;
      for (int k = 0; k < 20; ++k)
        most = std::max(most, std::abs(value(t + (k + 0.5) / 20 * step) - value(t)));
      EXPECT_LE(most, 0.8 * (high - low)) << name << " at " << t;
    }
  }
  EXPECT_TRUE(make_table({0, 1, 2}, {0, 3, 0})->paces().empty());
  EXPECT_EQ(longest_step(make_decaying(0.4, 2, 500, 0.3, 0.01)->paces(), 0.3), infinity);
  EXPECT_EQ(longest_step(make_decaying(0.4, 2, 500, 0.3, 0.01)->paces(), 0.6), infinity);
}

TEST(Law, BadInputIsRefused) {
  EXPECT_THROW(make_table({}, {}), Error);
  EXPECT_THROW(make_table({0, 1}, {1}), Error);
  EXPECT_THROW(make_table({0, 0}, {1, 2}), Error);
  EXPECT_THROW(make_table({1, 0}, {1, 2}), Error);
  EXPECT_THROW(make_table({0, whirl::nan}, {1, 2}), Error);
  EXPECT_THROW(make_pchip({0, 1, 2}, {0, infinity, 1}), Error);
  EXPECT_THROW(make_smooth_step(1, 1, 0, 1), Error);
  EXPECT_THROW(make_smooth_step(2, 1, 0, 1), Error);
  EXPECT_THROW(make_cosine_step(0, infinity, 0, 1), Error);
  EXPECT_THROW(make_piecewise({0, 1}, {make_constant(1)}), Error);
  EXPECT_THROW(make_constant(whirl::nan), Error);
}
