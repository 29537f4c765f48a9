// The root counter by itself, against all eigenvalues of small systems and against systems whose
// roots were chosen.
#include "beam_chain.hpp"
#include "dense_spectrum.hpp"
#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::la;
using namespace whirl::la::test;

namespace {

/// One node for every two roots: lambda^2 - (a + b) lambda + a b on its first unknown, all coupled
/// by random congruences that keep the roots.
struct Chosen {
  BlockPattern pattern;
  MCK m;
  Mask active;
  Chosen(const std::vector<std::array<Complex, 2>>& roots, std::mt19937& rng)
      : pattern(static_cast<Index>((roots.size() + 5) / 6),
                chain(static_cast<Index>((roots.size() + 5) / 6))),
        m(pattern),
        active(static_cast<std::size_t>(6 * pattern.size()), 0) {
    const Index n = 6 * pattern.size();
    MatX M = MatX::Identity(n, n), C = MatX::Zero(n, n), K = MatX::Identity(n, n);
    for (std::size_t k = 0; k < roots.size(); ++k) {
      const Index i = static_cast<Index>(k);
      active[k] = 1;
      C(i, i) = -(roots[k][0] + roots[k][1]).real();
      K(i, i) = (roots[k][0] * roots[k][1]).real();
    }
    // T1 Q T2 within each node keeps det Q up to a factor.
    std::uniform_real_distribution<double> u(-1.0, 1.0);
    for (Index b = 0; b < pattern.size(); ++b) {
      Matrix<6> left = Matrix<6>::Identity(), right = left;
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
          if (active[static_cast<std::size_t>(6 * b + i)] &&
              active[static_cast<std::size_t>(6 * b + j)]) {
            left(i, j) += 0.4 * u(rng);
            right(i, j) += 0.4 * u(rng);
          }
      const auto put = [&](BlockMatrix<6>& to, const MatX& from) {
        to.block(pattern.diagonal(b)) = left * from.block<6, 6>(6 * b, 6 * b) * right;
      };
      put(m.M, M);
      put(m.C, C);
      put(m.K, K);
    }
  }
};

Index inside(const std::vector<Complex>& roots, const CountRegion& r) {
  return std::count_if(roots.begin(), roots.end(), [&](Complex s) { return r.contains(s); });
}

}  // namespace

TEST(RootCounter, CountsChosenRootsOfEveryKind) {
  // Conjugate pairs of either damping, double and defective pairs, overdamped and diverging roots,
  // double roots at zero and near it.
  const Complex i(0, 1);
  const std::vector<std::array<Complex, 2>> roots = {
      {-1e-9 + 10.0 * i, -1e-9 - 10.0 * i}, {-1e-9 + 10.0 * i, -1e-9 - 10.0 * i},
      {0.5 + 30.0 * i, 0.5 - 30.0 * i},     {-40.0 + 21.0 * i, -40.0 - 21.0 * i},
      {Complex(0.0), Complex(0.0)},         {Complex(0.0), Complex(-1e-3)},
      {Complex(25.0), Complex(-300.0)},     {Complex(-60.0), Complex(-60.0)},
      {-1.0 + 80.0 * i, -1.0 - 80.0 * i},   {-1e-12 + 95.0 * i, -1e-12 - 95.0 * i},
      {Complex(-5e5), Complex(-3.0)},       {-500.0 + 10.0 * i, -500.0 - 10.0 * i}};
  std::vector<Complex> all;
  for (const auto& pair : roots)
    all.insert(all.end(), pair.begin(), pair.end());
  std::mt19937 rng(3);
  const Chosen system(roots, rng);
  RootCounter counter(system.pattern, system.active);
  for (const double radius : {5.0, 20.0, 50.0, 85.0, 200.0})
    for (const double reach : {2.0 * radius, 9.0 * radius}) {
      const CountRegion region{radius, reach};
      const RootCount none = counter.count(system.m, region, {});
      EXPECT_TRUE(none.certain) << radius << " " << reach;
      EXPECT_EQ(none.unknown, inside(all, region)) << radius << " " << reach;
      // Each root left out in turn is missed and found where it is.
      std::vector<Complex> known;
      for (const auto& pair : roots) {
        if (pair[0].imag() != 0.0)
          known.push_back(pair[0]);
        else
          known.insert(known.end(), pair.begin(), pair.end());
      }
      const RootCount complete = counter.count(system.m, region, known);
      EXPECT_TRUE(complete.certain);
      EXPECT_EQ(complete.unknown, 0);
      for (std::size_t k = 0; k < known.size(); ++k) {
        std::vector<Complex> fewer = known;
        fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
        const RootCount c = counter.count(system.m, region, fewer);
        EXPECT_TRUE(c.certain);
        const Index expected = !region.contains(known[k]) ? 0 : known[k].imag() != 0.0 ? 2 : 1;
        EXPECT_EQ(c.unknown, expected) << known[k];
        if (expected > 0) {
          double nearest = infinity;
          for (const Complex z : counter.locate(c.unknown))
            nearest = std::min(nearest, std::abs(z - known[k]));
          EXPECT_LT(nearest, 0.05 * radius) << known[k];
        }
      }
    }
}

TEST(RootCounter, AgreesWithDenseEigenvaluesOfRandomSystems) {
  std::mt19937 rng(29);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  int certain = 0, counted = 0;
  for (int round = 0; round < 150; ++round) {
    const Index n = 2 + round % 9;
    const BlockPattern p(n, round % 3 ? chain(n) : random_graph(n, 2, rng));
    MCK m = random_matrices(p, round % 2 ? 6.0 : 1.0, rng);
    for (Index i = 0; i < n; ++i)
      m.M.block(p.diagonal(i)) += 4.0 * Matrix<6>::Identity();
    if (round % 5 == 4) m.M.block(p.diagonal(n - 1)).setZero();
    const Mask a = round % 4 ? random_mask(p, 0.25, rng) : all_active(p);
    const std::vector<Complex> all = dense_spectrum(m, a, 0.731 + u(rng));
    RootCounter counter(p, a);
    for (const double radius : {0.3 + u(rng), 1.0 + u(rng)}) {
      const CountRegion region{radius, radius * (1.0 + 6.0 * u(rng))};
      std::vector<Complex> known;
      Index missing = 0;
      for (const Complex s : all) {
        if (s.imag() < -1e-12) continue;
        const Complex root = std::abs(s.imag()) <= 1e-12 ? Complex(s.real()) : s;
        if (u(rng) < 0.7)
          known.push_back(root);
        else if (region.contains(root))
          missing += root.imag() != 0.0 ? 2 : 1;
      }
      const RootCount c = counter.count(m, region, known);
      ++counted;
      certain += c.certain;
      if (!c.certain) continue;
      EXPECT_EQ(c.unknown, missing) << "round " << round << " radius " << radius;
    }
  }
  // A root on the curve itself may leave a count open; it may never make one wrong.
  EXPECT_GE(certain, counted - 3);
}

TEST(RootCounter, SpinningShaftsNeedFewFactorizations) {
  // 100 elements, the lowest modes known: the count is settled by two dozen factorisations however
  // many roots lie beyond.
  Shaft s;
  s.elements = 100;
  const BlockPattern p(101, chain(101));
  Mask a = all_active(p);
  for (int c : {0, 1, 2, 3})
    a[static_cast<std::size_t>(c)] = 0;
  for (int c : {1, 2})
    a[static_cast<std::size_t>(600 + c)] = 0;
  const MCK m = shaft_matrices(p, s, 2000.0);
  ModeOptions o;
  o.count = 14;
  const auto modes = quadratic_modes(m, a, o);
  std::vector<Complex> known;
  for (const Mode& mode : modes)
    known.push_back(mode.lambda);
  const double radius = 0.5 * (modes[11].lambda.imag() + modes[12].lambda.imag());
  RootCounter counter(p, a);
  const RootCount c = counter.count(m, {radius, 5.0 * radius}, known);
  EXPECT_TRUE(c.certain);
  EXPECT_EQ(c.unknown, 0);
  EXPECT_LE(c.factorizations, 40);
  known.erase(known.begin() + 5);
  const RootCount one = counter.count(m, {radius, 5.0 * radius}, known);
  ASSERT_EQ(one.unknown, 2);
  const std::vector<Complex> where = counter.locate(2);
  ASSERT_EQ(where.size(), 1u);
  EXPECT_LT(std::abs(where[0] - modes[5].lambda), 0.02 * radius);
}

// Twenty roots about -100 beside a pair nobody knows, or spread over the region: only the first are a
// crowd, and its rate is below (nearly) all of them.
TEST(RootCounter, ACrowdIsTold) {
  std::mt19937 rng(5);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<std::array<Complex, 2>> crowd, spread;
  for (int k = 0; k < 10; ++k) {
    crowd.push_back({-100.0 * (1 + 0.2 * u(rng)), -100.0 * (1 + 0.2 * u(rng))});
    spread.push_back({-250.0 * u(rng), -250.0 * u(rng)});
  }
  const CountRegion region{100.0, 300.0};
  const auto rate_of = [&](const std::vector<std::array<Complex, 2>>& roots) {
    const Chosen system(roots, rng);
    RootCounter counter(system.pattern, system.active);
    const RootCount c = counter.count(system.m, region, {});
    EXPECT_TRUE(c.certain);
    return counter.crowd_rate(c.unknown);
  };
  const double rate = rate_of(crowd);
  EXPECT_GT(rate, 80.0);
  EXPECT_LT(rate, 110.0);
  crowd.push_back({Complex(-5.0, 60.0), Complex(-5.0, -60.0)});
  const double beside = rate_of(crowd);
  EXPECT_GT(beside, 50.0);
  EXPECT_LT(beside, 110.0);
  EXPECT_EQ(rate_of(spread), infinity);
}
