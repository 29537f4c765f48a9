// Galerkin's balance of what changes with the angle against the integrals it stands for.
#include <analysis/spectra/harmonic_balance.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace whirl::analysis {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

struct Sample {
  Matrix<6> M, C, K;
};

/// Mean and two waves of each.
Sample at(const std::vector<Matrix<6>>& parts, Index step, double theta) {
  const double c = std::cos(static_cast<double>(step) * theta),
               s = std::sin(static_cast<double>(2 * step) * theta);
  return {parts[0] + c * parts[1] + s * parts[2], parts[3] + c * parts[4] + s * parts[5],
          parts[6] + c * parts[7] + s * parts[8]};
}

std::vector<Matrix<6>> some_matrices() {
  std::srand(5);
  std::vector<Matrix<6>> out;
  for (int k = 0; k < 9; ++k)
    out.push_back(Matrix<6>::Random());
  return out;
}

la::BlockPattern pattern_of(Index parts) {
  std::vector<std::pair<Index, Index>> all;
  for (Index a = 0; a < parts; ++a)
    for (Index b = 0; b < parts; ++b)
      all.emplace_back(a, b);
  return {parts, all};
}

/// What multiplies x_b, x_b' and x_b'' in the equation of part a, by many angles.
Sample integrate(const std::vector<Matrix<6>>& parts, const std::vector<Index>& orders, Index step,
                 double W, Index a, Index b) {
  constexpr int points = 200;
  constexpr double h = 1e-3;
  Sample out{Matrix<6>::Zero(), Matrix<6>::Zero(), Matrix<6>::Zero()};
  double norm = 0;
  for (int n = 0; n < points; ++n) {
    const double theta = two_pi * n / points;
    const VecX f = waves_at(orders, theta), before = waves_at(orders, theta - h),
               after = waves_at(orders, theta + h);
    const double value = f[b], rate = W * (after[b] - before[b]) / (2 * h),
                 acceleration = W * W * (after[b] - 2 * f[b] + before[b]) / (h * h);
    const Sample s = at(parts, step, theta);
    out.M += f[a] * value * s.M;
    out.C += f[a] * (value * s.C + 2 * rate * s.M);
    out.K += f[a] * (value * s.K + rate * s.C + acceleration * s.M);
    norm += f[a] * f[a];
  }
  return {out.M / norm, out.C / norm, out.K / norm};
}

}  // namespace

TEST(HarmonicBalance, IsGalerkins) {
  const std::vector<Matrix<6>> matrices = some_matrices();
  const double W = 3.7;
  struct Case {
    std::vector<Index> orders;
    Index step;
  };
  const std::vector<Case> cases = {
      {{0, 2, 4, 6}, 2}, {{0, 1, 2, 3}, 1}, {{1, 3, 5}, 2}, {{0, 1, 2, 3, 4}, 1}, {{1}, 2}};
  for (const Case& c : cases) {
    const HarmonicBalance balance(c.orders, c.step);
    const la::BlockPattern pattern = pattern_of(balance.parts());
    la::MCK out(pattern);
    for (la::BlockMatrix<6>* m : {&out.M, &out.C, &out.K})
      m->set_zero();
    const Index points = 2 * balance.waves() + 8;
    VecX weights;
    std::vector<Sample> waves(static_cast<std::size_t>(balance.waves()),
                              {Matrix<6>::Zero(), Matrix<6>::Zero(), Matrix<6>::Zero()});
    for (Index n = 0; n < points; ++n) {
      const double theta = two_pi * static_cast<double>(n) / static_cast<double>(points);
      const Sample s = at(matrices, c.step, theta);
      balance.weigh(theta, points, weights);
      for (Index h = 0; h < balance.waves(); ++h) {
        Sample& w = waves[static_cast<std::size_t>(h)];
        w.M += weights[h] * s.M;
        w.C += weights[h] * s.C;
        w.K += weights[h] * s.K;
      }
    }
    for (Index h = 0; h < balance.waves(); ++h) {
      const Sample& w = waves[static_cast<std::size_t>(h)];
      balance.add(h, 0, 0, W, w.M, w.C, w.K, out);
    }
    for (Index a = 0; a < balance.parts(); ++a)
      for (Index b = 0; b < balance.parts(); ++b) {
        const Sample own = integrate(matrices, c.orders, c.step, W, a, b);
        const Index k = pattern.slot(a, b);
        EXPECT_LT((out.M.block(k) - own.M).norm(), 1e-12);
        // of the differences, of 1e-3 rad
        EXPECT_LT((out.C.block(k) - own.C).norm(), 1e-5 * (1.0 + out.C.block(k).norm()));
        EXPECT_LT((out.K.block(k) - own.K).norm(), 1e-5 * (1.0 + out.K.block(k).norm()));
      }
  }
}

}  // namespace whirl::analysis
