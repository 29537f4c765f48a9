// The count along the axis against systems with all states: a pad on springs, condensed at every
// frequency, is what a table of a support against frequency holds.
#include "dense_spectrum.hpp"
#include <gtest/gtest.h>
#include <la/dense.hpp>
#include <la/axis_count.hpp>

using namespace whirl;
using namespace whirl::la;
using namespace whirl::la::test;

namespace {

MatX positive(Index n, double least, std::mt19937& rng) {
  std::normal_distribution<double> u(0.0, 1.0);
  const MatX a = MatX::NullaryExpr(n, n, [&] { return u(rng); });
  return MatX(a * a.transpose() / static_cast<double>(n)) + least * MatX::Identity(n, n);
}

/// A rotor (node 0) with damping of either sign and circulatory stiffness, on a pad (node 1) whose
/// own motions decay.
struct OnPad {
  BlockPattern pattern{2, chain(2)};
  MCK full{pattern};
  Mask active = all_active(pattern);
  MatX M, C, K;

  explicit OnPad(std::mt19937& rng) {
    std::normal_distribution<double> u(0.0, 1.0);
    M = MatX::Zero(12, 12);
    C = MatX::Zero(12, 12);
    M.topLeftCorner(6, 6) = positive(6, 0.5, rng);
    M.bottomRightCorner(6, 6) = positive(6, 0.5, rng);
    C.topLeftCorner(6, 6) = 0.1 * MatX::NullaryExpr(6, 6, [&] { return u(rng); });
    C.bottomRightCorner(6, 6) = positive(6, 0.3, rng);
    K = 100.0 * positive(12, 0.5, rng);
    const MatX twist = MatX::NullaryExpr(6, 6, [&] { return u(rng); });
    K.topLeftCorner(6, 6) += 8.0 * (twist - twist.transpose());
    for (Index i = 0; i < 2; ++i)
      for (Index j = 0; j < 2; ++j) {
        const Index slot = i == j ? pattern.diagonal(i) : pattern.slot(i, j);
        full.M.block(slot) = M.block<6, 6>(6 * i, 6 * j);
        full.C.block(slot) = C.block<6, 6>(6 * i, 6 * j);
        full.K.block(slot) = K.block<6, 6>(6 * i, 6 * j);
      }
  }
};

/// The same without the pad's states, against the frequency.
struct Condensed {
  const OnPad& all;
  BlockPattern pattern{1, chain(1)};
  MCK m{pattern};
  Mask active = all_active(pattern);

  const MCK& at(double w) {
    const Complex s(0.0, std::max(w, 1e-5));
    const MatXc Q = s * s * all.M + s * all.C + all.K;
    const MatXc pad =
        Q.topRightCorner(6, 6) *
        DenseLu<Complex>(MatXc(Q.bottomRightCorner(6, 6))).solve(MatXc(Q.bottomLeftCorner(6, 6)));
    m.M.block(0) = all.M.topLeftCorner(6, 6);
    m.K.block(0) = all.K.topLeftCorner(6, 6) - pad.real();
    m.C.block(0) = all.C.topLeftCorner(6, 6) - pad.imag() / s.imag();
    return m;
  }
};

std::vector<Complex> upper(const std::vector<Complex>& roots) {
  std::vector<Complex> out;
  for (const Complex z : roots)
    if (z.imag() >= 0.0) out.push_back(z);
  return out;
}

}  // namespace

TEST(AxisCounter, CountsWhatTheFullSystemHas) {
  std::mt19937 rng(11);
  int stable = 0;
  for (int k = 0; k < 60; ++k) {
    const OnPad all(rng);
    Condensed condensed{all};
    AxisProblem p;
    p.top = 1000.0;
    p.rho = 1e-2;
    MCK held = condensed.at(p.top);
    p.held = &held;
    p.at = [&](double w) -> const MCK& { return condensed.at(std::min(w, p.top)); };
    p.stations = {3.0, 10.0, 30.0};
    p.known_held = upper(dense_spectrum(held, condensed.active, 1.7));
    const std::vector<Complex> roots = dense_spectrum(all.full, all.active, 1.7);
    const Index growing =
        std::count_if(roots.begin(), roots.end(), [](Complex z) { return z.real() > 0.0; });
    stable += growing == 0;
    AxisCounter counter(condensed.pattern, condensed.active);
    const AxisCount none = counter.count(p);
    EXPECT_TRUE(none.certain) << k;
    EXPECT_EQ(none.unknown, growing) << k;
    p.known = upper(roots);
    const AxisCount complete = counter.count(p);
    EXPECT_TRUE(complete.certain) << k;
    EXPECT_EQ(complete.unknown, 0) << k;
    // one left out is missed, one too many as well
    for (const Complex z : roots)
      if (z.real() > 0.0 && z.imag() >= 0.0) {
        std::erase(p.known, z);
        EXPECT_EQ(counter.count(p).unknown, z.imag() > 0.0 ? 2 : 1) << k;
        p.known.push_back(z);
        p.known.push_back(z);
        EXPECT_EQ(counter.count(p).unknown, z.imag() > 0.0 ? -2 : -1) << k;
        break;
      }
  }
  EXPECT_GT(stable, 5);
  EXPECT_LT(stable, 55);
}
