// Formulas of API reports and of balancing, each against a calculation by hand.
#include <analysis/response/api617.hpp>
#include <analysis/response/balancing.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::analysis;

TEST(Api617, UnbalanceVibrationAndScale) {
  // 2 6350 g mm rpm/kg 250 kg/10,000 rpm
  EXPECT_NEAR(api_unbalance(2, 6350, 250, 10000 * pi / 30), 317.5e-6, 1e-15);
  // 25.4 um sqrt(12000/16000), and 25.4 um below 12,000 rpm
  EXPECT_NEAR(vibration_limit(25.4e-6, 12000 * pi / 30, 16000 * pi / 30), 21.99704525e-6, 1e-13);
  EXPECT_EQ(vibration_limit(25.4e-6, 12000 * pi / 30, 9000 * pi / 30), 25.4e-6);
  EXPECT_NEAR(scale_factor(25.4e-6, 10e-6, 6), 2.54, 1e-14);
  EXPECT_EQ(scale_factor(25.4e-6, 1e-6, 6), 6);
  EXPECT_EQ(scale_factor(25.4e-6, 0, 6), 6);
}

TEST(Api617, SeparationMargins) {
  const MarginRule rule;
  EXPECT_EQ(rule.required(2.49, false), 0);
  EXPECT_NEAR(rule.required(5, false), 0.17 * (1 - 1 / 3.5), 1e-15);
  EXPECT_NEAR(rule.required(5, true), 0.10 + 0.17 * (1 - 1 / 3.5), 1e-15);
  EXPECT_EQ(rule.required(whirl::nan, true), 0);
  MarginRule fixed;
  fixed.fixed = 0.15;
  EXPECT_EQ(fixed.required(5, true), 0.15);
  EXPECT_EQ(fixed.required(2, true), 0);
}

// 3 9.55 10,000 (1.11 + 1.14)/(0.35 0.08 1000); axial stages have another factor and no densities
TEST(Api617, AnticipatedCrossCoupling) {
  CrossCoupledStage a;
  a.power = 10000;
  a.speed = 1000 * pi / 30;
  a.diameter = 0.35;
  a.width = 0.08;
  a.discharge = 1.11;
  CrossCoupledStage b = a;
  b.discharge = 1.14;
  EXPECT_NEAR(a.anticipated(3, 1.5, 9.55) + b.anticipated(3, 1.5, 9.55), 23022.32142857143, 1e-7);
  b.axial = true;
  EXPECT_NEAR(b.anticipated(3, 1.5, 9.55), 1.5 * 9.55 * 10000 / (1000 * 0.35 * 0.08), 1e-8);
}

TEST(Api617, CriticalSpeedRatioAgainstDensity) {
  const RatioBoundary edge{{0, 16.53, 60}, {2.5, 2.5, 2.0}};
  EXPECT_EQ(edge.at(10), 2.5);
  EXPECT_NEAR(edge.at(38.265), 2.25, 1e-12);
  EXPECT_EQ(edge.at(60), 2.0);
  EXPECT_EQ(edge.at(60.001), 0);  // nothing of it lies in region A
}

namespace {
/// 41 places over 2 m.
std::pair<std::vector<double>, std::vector<double>> shape(double (*f)(double)) {
  std::pair<std::vector<double>, std::vector<double>> out;
  for (int k = 0; k <= 40; ++k) {
    out.first.push_back(0.05 * k);
    out.second.push_back(f(0.05 * k));
  }
  return out;
}
const JournalWeights journals{{0.5, 1.5}, {60, 40}, 12, 8, 0, 0};
}  // namespace

TEST(Api617, UnbalanceAtTheAntinodes) {
  const auto [s, bow] = shape([](double x) { return std::sin(pi * (x - 0.5)); });
  const ModePlanes one = place_unbalance(s, bow, journals);
  ASSERT_EQ(one.planes.size(), 1u);
  EXPECT_NEAR(one.planes[0].s, 1.0, 1e-12);
  EXPECT_EQ(one.planes[0].weight, 100);

  const auto [s2, wave] = shape([](double x) { return std::sin(2 * pi * (x - 0.5)); });
  const ModePlanes two = place_unbalance(s2, wave, journals);
  EXPECT_EQ(two.form, ModeForm::conical);
  ASSERT_EQ(two.planes.size(), 2u);
  EXPECT_NEAR(two.planes[0].s, 0.75, 1e-12);
  EXPECT_NEAR(two.planes[1].s, 1.25, 1e-12);
  EXPECT_EQ(two.planes[0].weight, 60);
  EXPECT_EQ(two.planes[1].weight, 40);
  EXPECT_FALSE(two.planes[0].turned);
  EXPECT_TRUE(two.planes[1].turned);

  const auto [s3, waves] = shape([](double x) { return std::sin(3 * pi * (x - 0.5)); });
  const ModePlanes three = place_unbalance(s3, waves, journals);
  ASSERT_EQ(three.planes.size(), 3u);
  EXPECT_TRUE(three.planes[1].turned);
  EXPECT_FALSE(three.planes[2].turned);
}

TEST(Api617, UnbalanceOfAnOverhungMode) {
  const auto [s, u] = shape([](double x) { return x < 0.5 ? 1.0 - 1.8 * x : 0.1 * (1.5 - x); });
  JournalWeights j = journals;
  j.motion_left = 0.9;
  const ModePlanes p = place_unbalance(s, u, j);
  EXPECT_EQ(p.form, ModeForm::overhung);
  ASSERT_EQ(p.planes.size(), 1u);
  EXPECT_EQ(p.planes[0].s, 0);
  EXPECT_EQ(p.planes[0].weight, 12);
  // ends that hardly weigh take no unbalance, however far they swing
  j.motion_left = 0.1;
  EXPECT_NE(place_unbalance(s, u, j).form, ModeForm::overhung);
}

TEST(Balancing, InfluenceCoefficients) {
  const Complex a = std::polar(2.0, -pi / 4);
  MatXc A(1, 1);
  A(0, 0) = a;
  VecXc r(1);
  r[0] = std::polar(10.0, -pi / 6);
  const VecXc w = balance_by_influence(A, r);
  EXPECT_NEAR(std::abs(w[0] - std::polar(5.0, pi + pi / 12)), 0, 1e-13);
}

// Two modes, three planes: a pattern drives its own mode alone.
TEST(Balancing, ModalPatterns) {
  MatX phi(2, 3);
  phi << 0.7, 1.0, 0.7, 1.0, 0.0, -1.0;
  const MatX P = modal_patterns(phi);
  EXPECT_LT((phi * P - MatX::Identity(2, 2)).norm(), 1e-14);
  // each mode seen at its own speed by one sensor
  const VecX h = (VecX(2) << 3.0, 5.0).finished();
  MatXc A = (h.asDiagonal() * phi).cast<Complex>();
  const VecXc u = (VecXc(3) << Complex(1, 2), Complex(-1, 0), Complex(0, 1)).finished();
  const VecXc r0 = A * u;
  const VecXc w = balance_by_modes(A, r0, P, {{0}, {1}});
  EXPECT_LT((phi.cast<Complex>() * (u + w)).norm(), 1e-13);
}

TEST(Balancing, Zones) {
  const std::vector<double> borders{68e-6, 127e-6, 187e-6};
  EXPECT_EQ(zone_of(68e-6, borders), 0);
  EXPECT_EQ(zone_of(69e-6, borders), 1);
  EXPECT_EQ(zone_of(150e-6, borders), 2);
  EXPECT_EQ(zone_of(190e-6, borders), 3);
}
