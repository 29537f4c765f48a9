// Tracking filter and spectra on signals whose content is known.
#include <analysis/transient/order_filter.hpp>
#include <analysis/transient/revolutions.hpp>
#include <analysis/transient/spectrum.hpp>
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <random>
#include <span>

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

namespace {

/// What an order filter finds of a signal of the angle over so many turns from a mark on.
struct Found {
  std::vector<Complex> y;     ///< [turn * orders + order]
  std::vector<long> numbers;  ///< of the turns
};
Found filtered(const std::vector<double>& orders, int turns, int samples, int count, bool backward,
               const std::function<double(double)>& x, int first = 3) {
  Found f;
  OrderFilter filter(1, orders, samples, turns,
                     [&](const Turn& t, std::span<const Complex> y, std::span<const Complex>,
                         std::span<const Turn>) {
                       f.y.insert(f.y.end(), y.begin(), y.end());
                       f.numbers.push_back(t.number);
                     });
  for (int k = 0; k < count; ++k) {
    Turn t = turn_of(samples, backward);
    t.number = backward ? first - k : first + k;
    std::vector<double> s;
    for (int j = 0; j <= samples; ++j)
      s.push_back(x(two_pi * (static_cast<double>(t.number) +
                              static_cast<double>(backward ? samples - j : j) / samples)));
    t.y = t.z = {s};
    filter.take(t);
  }
  filter.end();
  return f;
}

}  // namespace

TEST(OrderFilter, TellsHalvesOfAnOrderApartAndKeepsTheirPhases) {
  const auto x = [](double phi) {
    return 30.0 + 2.0 * std::cos(phi - 0.7) + 0.5 * std::cos(0.5 * phi + 1.9) +
           0.25 * std::cos(1.5 * phi - 0.4);
  };
  for (const bool backward : {false, true})
    for (const int samples : {16, 33, 48}) {
      const Found f = filtered({0.5, 1.0, 1.5}, 4, samples, 9, backward, x);
      ASSERT_EQ(f.numbers.size(), 9u);
      for (std::size_t k = 2; k < 7; ++k) {  // full windows
        EXPECT_LT(std::abs(f.y[3 * k] - std::polar(0.5, 1.9)), 1e-13) << k;
        EXPECT_LT(std::abs(f.y[3 * k + 1] - std::polar(2.0, -0.7)), 1e-13) << k;
        EXPECT_LT(std::abs(f.y[3 * k + 2] - std::polar(0.25, -0.4)), 1e-13) << k;
      }
      // at the ends halves come from the nearest full window
      EXPECT_EQ(f.y[0], f.y[6]);
      EXPECT_EQ(f.y[24], f.y[18]);
    }
}

TEST(OrderFilter, WholeOrdersAreExactUpToTheEnds) {
  const auto x = [](double phi) { return 3.0 + 2.0 * std::cos(phi - 0.7) - std::sin(2.0 * phi); };
  for (const int turns : {1, 2, 3, 4, 7})
    for (const bool backward : {false, true}) {
      const Found f = filtered({1.0, 2.0}, turns, 24, 9, backward, x);
      ASSERT_EQ(f.numbers.size(), 9u);
      for (std::size_t k = 0; k < 9; ++k) {
        EXPECT_EQ(f.numbers[k], backward ? 3 - static_cast<long>(k) : 3 + static_cast<long>(k));
        EXPECT_LT(std::abs(f.y[2 * k] - std::polar(2.0, -0.7)), 1e-13) << turns;
        EXPECT_LT(std::abs(f.y[2 * k + 1] - Complex(0.0, 1.0)), 1e-13) << turns;
      }
    }
}

// Another shaft at 1.37 of the speed: the transfer function of the window, D(x) = sin(pi x) /
// (pi x (1 - x^2)) at x = 0.37 M in the limit of many samples.
TEST(OrderFilter, AnotherShaftIsLeftOutAsTheWindowSays) {
  const auto x = [](double phi) { return std::cos(1.37 * phi); };
  const auto most = [&](int turns) {
    const Found f = filtered({1.0}, turns, 512, 40, false, x);
    double size = 0;
    for (const Complex& y : f.y)  // the ends too
      size = std::max(size, std::abs(y));
    return size;
  };
  const auto hann = [](double v) { return std::sin(pi * v) / (pi * v * (1.0 - v * v)); };
  for (const int turns : {2, 4, 8}) {
    // of the image at -1.37 the same window is taken 2.37 orders away
    const double near = std::abs(hann(0.37 * turns)), image = std::abs(hann(2.37 * turns));
    EXPECT_NEAR(most(turns), near, image + 1e-4) << turns;
  }
  EXPECT_GT(most(1), 0.7);
  EXPECT_LT(most(8), 0.02);
}

TEST(OrderFilter, ARunTooShortForTheWindowKnowsNoHalves) {
  const Found f = filtered({0.5, 1.0}, 4, 16, 3, false, [](double phi) { return std::cos(phi); });
  ASSERT_EQ(f.numbers.size(), 3u);
  EXPECT_TRUE(std::isnan(f.y[0].real()));
  EXPECT_LT(std::abs(f.y[1] - 1.0), 1e-14);
}

TEST(OrderFilter, ATurnMissingBeginsAnew) {
  std::vector<Complex> found;
  OrderFilter filter(1, {1.0}, 16, 4,
                     [&](const Turn&, std::span<const Complex> y, std::span<const Complex>,
                         std::span<const Turn>) { found.push_back(y[0]); });
  for (const long number : {0L, 1L, 2L, 3L, 4L, 5L, 9L, 10L}) {
    Turn t = turn_of(16, false);
    t.number = number;
    const double size = number < 6 ? 1.0 : 5.0;
    t.y = t.z = {samples(t, [size](double phi) { return size * std::cos(phi); })};
    filter.take(t);
    // those before the gap are not mixed with those behind it
    EXPECT_TRUE(number != 9 || found.size() == 6);
  }
  filter.end();
  ASSERT_EQ(found.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(std::abs(found[k]), k < 6 ? 1.0 : 5.0, 1e-13);
}

TEST(OrderFilter, GoesOnFromACheckpointBitForBit) {
  const auto run = [](bool stop) {
    std::vector<Complex> found;
    const auto make = [&] {
      return OrderFilter(
          1, {0.5, 1.0}, 16, 4,
          [&](const Turn&, std::span<const Complex> y, std::span<const Complex>,
              std::span<const Turn>) { found.insert(found.end(), y.begin(), y.end()); });
    };
    OrderFilter filter = make();
    for (long k = 0; k < 12; ++k) {
      if (stop && (k == 2 || k == 7)) {
        OutArchive out;
        filter.save(out);
        filter = make();
        InArchive in(out.data());
        filter.restore(in);
      }
      Turn t = turn_of(16, false);
      t.number = k;
      t.y = t.z = {
          samples(t, [k](double phi) { return std::cos(0.9 * phi + static_cast<double>(k)); })};
      filter.take(t);
    }
    filter.end();
    return found;
  };
  EXPECT_EQ(run(true), run(false));
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
