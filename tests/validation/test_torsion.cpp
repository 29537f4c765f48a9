// Example 14 against the continuous train: bars in torsion with disks and a coupling, by transfer
// matrices of (phi, T):
//   bar  phi' = T/GJ, T' = -w^2 rho J phi;  disk  T -= w^2 Ip phi;  coupling  phi += T/k.
#include "../app/deck_run.hpp"
#include "record.hpp"
#include <gtest/gtest.h>
#include <cmath>
#include <fstream>
#include <io/value.hpp>
#include <sstream>

namespace {

constexpr double pi = 3.14159265358979323846;

/// Torque at the free end for a unit angle at the other: zero at a natural frequency.
double end_torque(double w) {
  const double rho = 7850, G = 2.1e11 / 2.6;  // steel of the library
  double phi = 1, T = 0;
  const auto bar = [&](double l, double d) {
    const double J = pi / 32 * d * d * d * d, b = w * std::sqrt(rho / G), c = std::cos(b * l),
                 s = std::sin(b * l), z = G * J * b;
    const double p = phi;
    phi = c * p + s / z * T;
    T = -z * s * p + c * T;
  };
  const auto disk = [&](double Ip) { T -= w * w * Ip * phi; };
  bar(0.3, 0.09);
  disk(3.5);
  bar(0.4, 0.09);
  phi += T / 2e5;
  bar(0.35, 0.08);
  disk(1.8);
  bar(0.45, 0.08);
  disk(1.1);
  bar(0.2, 0.07);
  return T;
}

double root(double a, double b) {
  const bool positive = end_torque(a) > 0;
  for (int k = 0; k < 200; ++k) {
    const double c = 0.5 * (a + b);
    ((end_torque(c) > 0) == positive ? a : b) = c;
  }
  return 0.5 * (a + b);
}

}  // namespace

TEST(TorsionalTrain, FrequenciesAndCriticalSpeedsOfTheContinuousTrain) {
  whirl::test::Record record("Torsional train: motor, coupling, two-stage compressor",
                             "continuous bars with disks, by transfer matrices");
  std::ostringstream deck;
  deck << std::ifstream(WHIRL_SOURCE "/examples/14_torsional_train/deck.toml").rdbuf();
  const whirl::test::DeckRun r(deck.str());
  ASSERT_EQ(r.exit, 0) << r.log;
  const auto speeds = r.csv("modes_critical_speeds.csv");  // undamped
  ASSERT_EQ(speeds.rows.size(), 3u);
  const double first = root(250, 350), second = root(900, 1200);
  // 1e-6: four elements a section, order 4
  record.check("once the speed meets the first frequency", "rpm", speeds.rows[0][1],
               first * 30 / pi, 1e-6 * first * 30 / pi);
  record.check("twice the speed meets the first frequency", "rpm", speeds.rows[1][1],
               0.5 * first * 30 / pi, 1e-6 * first * 30 / pi);
  record.check("twice the speed meets the second frequency", "rpm", speeds.rows[2][1],
               0.5 * second * 30 / pi, 1e-6 * second * 30 / pi);
  // Start-up: all inertia to the right of the coupling is accelerated through it; the ringing, up
  // to twice that, has its mean there.
  const auto run = r.csv("start_up.csv");
  double least = 0;
  for (const auto& row : run.rows)
    least = std::min(least, run.named(row).at("bearing coupling moment.x [N.m]"));
  const double right =
      1.8 + 1.1 + 7850 * pi / 32 * (0.8 * std::pow(0.08, 4) + 0.2 * std::pow(0.07, 4));
  const double left = 3.5 + 7850 * pi / 32 * 0.7 * std::pow(0.09, 4),
               share = right / (left + right);
  const double period = 2 * pi / first;
  double sum = 0;
  int count = 0;
  for (const auto& row : run.rows)
    if (row[0] < 2 * period) {
      sum += run.named(row).at("bearing coupling moment.x [N.m]");
      ++count;
    }
  // over two periods: a period is 105.6 rows, the decay 0.2 a period, the second mode adds a few
  // percent, and the load has begun to grow
  record.check("mean torque in the coupling after the start", "N m", sum / count, -1500 * share,
               0.03 * 1500 * share);
  EXPECT_LT(least, -1.7 * 1500 * share);
  EXPECT_GT(least, -2.0 * 1500 * share);
}
