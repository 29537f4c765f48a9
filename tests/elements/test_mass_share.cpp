// Frequencies of a pinned shaft with a body at its middle against the characteristic equation of
// the Bernoulli beam with a point mass mu times its own, 1 = mu beta/4 (tan(beta/2) - tanh(beta/2))
// for symmetric modes (W. C. Hurty, M. F. Rubinstein, Dynamics of Structures, 1964, ch. 5), beta^4
// = omega^2 rhoA L^4/EI; and the weight that the shares leave out.
#include <la/dense.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <gtest/gtest.h>
#include <cmath>

using namespace whirl;
using namespace whirl::elements;

namespace {

/// EI = rhoA = L = 1, no shear, no rotary inertia.
ElementSection slender() {
  ElementSection s;
  s.constants = true;
  s.given = {1e6, 0, 1, 1, 1, 0, 0};
  return s;
}

/// beta of symmetric mode 1, 2, ..: between the poles of the tangent at (2 n - 1) pi, where the
/// right side passes from -infinity or 0 to infinity.
double exact_beta(double mu, int n) {
  double a = n == 1 ? 1e-6 : (2 * n - 3) * pi * (1 + 1e-12), b = (2 * n - 1) * pi * (1 - 1e-12);
  for (int i = 0; i < 200; ++i) {
    const double c = 0.5 * (a + b);
    (mu * c / 4 * (std::tan(c / 2) - std::tanh(c / 2)) < 1 ? a : b) = c;
  }
  return 0.5 * (a + b);
}

/// omega of mode m of n elements; shared: with the share of the middle node.
double frequency(double mu, int n, int m, bool shared) {
  MatX K = MatX::Zero(2 * n + 2, 2 * n + 2), M = K;
  for (int e = 0; e < n; ++e) {
    MassShare share;
    const double w = 1.0 / n / (1.0 / n + mu);
    if (shared && e + 1 == n / 2) share.bending[2] = w;
    if (shared && e == n / 2) share.bending[0] = w;
    const ShaftElementConstants c =
        make_shaft_constants(slender(), 1.0 / n, 0, 0, MassKind::corrected, share);
    K.block<4, 4>(2 * e, 2 * e) += bending_stiffness(c);
    M.block<4, 4>(2 * e, 2 * e) += c.M4;
  }
  M(n, n) += mu;
  std::vector<int> keep;
  for (int i = 1; i < 2 * n + 2; ++i)
    if (i != 2 * n) keep.push_back(i);
  const MatX k = K(keep, keep), mm = M(keep, keep);
  return std::sqrt(la::symmetric_eigenpairs(k, mm).values(m - 1));
}

}  // namespace

TEST(MassShare, FrequenciesWithABodyConvergeWithOrderSix) {
  for (const double mu : {0.5, 5.0})
    for (const int symmetric : {1, 2}) {
      const double beta = exact_beta(mu, symmetric), exact = beta * beta;
      const int mode = 2 * symmetric - 1;
      double e[3], whole[3];
      for (int k = 0; k < 3; ++k) {
        e[k] = frequency(mu, 4 << k, mode, true) / exact - 1;
        whole[k] = frequency(mu, 4 << k, mode, false) / exact - 1;
      }
      std::printf(
          "  mu %4.1f mode %d: 4, 8, 16 elements %9.2e %9.2e %9.2e, shaft's share everywhere %9.2e "
          "%9.2e %9.2e\n",
          mu, mode, e[0], e[1], e[2], whole[0], whole[1], whole[2]);
      EXPECT_GT(std::log2(std::abs(e[0] / e[1])),
                5.5);  // order 6; below 1e-9 the eigenvalues are rounding
      EXPECT_NEAR(std::log2(std::abs(whole[0] / whole[2])) / 2, symmetric == 1 ? 4.0 : 4.6,
                  0.3);  // what it mends: order 4
      EXPECT_LT(std::abs(e[2]), std::abs(whole[2]) / 5);
    }
}

TEST(MassShare, RigidMotionKeepsItsEnergyAndTheLineItsWeight) {
  const MassShare share{Vector<4>(0.3, 0.8, 0.05, 0.6), Vec2(0.1, 0.9)};
  const double o1 = 0.03, o2 = -0.02, l = 0.4;
  const ShaftElementConstants a = make_shaft_constants(slender(), l, o1, o2),
                              b = make_shaft_constants(slender(), l, o1, o2, MassKind::corrected,
                                                       share);
  const Vector<4> t(1, 0, 1, 0), r(0, 1, l + o1 - o2, 1);  // node 2 at node 1 + (l + o1 - o2) d
  for (const Vector<4>& x : {t, r})
    EXPECT_NEAR(x.dot(b.M4 * x), x.dot(a.M4 * x), 1e-13 * x.dot(a.M4 * x));
  EXPECT_NEAR(t.dot((b.M4 - a.M4) * t), 0.0, 1e-15);
  EXPECT_GT(((b.M4 - a.M4) * t).norm(), 1e-6);  // but not each node its own: weight_rest.hpp
  EXPECT_LT((b.M4 - b.M4.transpose()).norm(), 1e-18);
}
