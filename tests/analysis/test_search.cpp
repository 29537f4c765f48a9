#include <analysis/search.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;

namespace {

/// Two resonances, the second a millionth of the first.
double response(double w) {
  const auto line = [w](double at, double width) {
    return 1.0 / (1.0 + (w - at) * (w - at) / (width * width));
  };
  return 1e6 * line(1.0, 1e-4) + line(3.0, 5e-2);
}

std::vector<double> sampled(int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k)
    out.push_back(response(0.5 + 4.0 * k / (count - 1)));
  return out;
}

}  // namespace

// The smaller peak was lost where the samples were close: it rises by little from one to the next.
TEST(MaximaOf, AreTheSameHoweverCloseTheSamples) {
  for (const int count : {401, 4001, 40001, 400001})
    EXPECT_EQ(analysis::maxima_of(sampled(count)).size(), 2u) << count;
}

TEST(MaximaOf, RoundingOnASlopeOrAPlateauIsNone) {
  std::vector<double> slope, plateau;
  for (int k = 0; k < 1000; ++k) {
    const double rounding = 1e-15 * ((k * 7919) % 13);
    slope.push_back(1.0 + 1e-16 * k + rounding);
    plateau.push_back(1.0 + rounding);
  }
  EXPECT_TRUE(analysis::maxima_of(slope).empty());
  EXPECT_TRUE(analysis::maxima_of(plateau).empty());
}

TEST(MaximaOf, EndsAreNone) {
  EXPECT_TRUE(analysis::maxima_of({3, 2, 1}).empty());
  EXPECT_TRUE(analysis::maxima_of({1, 2, 3}).empty());
  EXPECT_TRUE(analysis::maxima_of({}).empty());
  EXPECT_EQ(analysis::maxima_of({1, 2, 2, 1}), std::vector<std::size_t>{1});
}
