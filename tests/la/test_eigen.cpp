#include "symmetric_modes.hpp"
#include "beam_chain.hpp"
#include "fixtures.hpp"
#include <core/error.hpp>
#include <core/interrupt.hpp>
#include <gtest/gtest.h>
#include <la/dense.hpp>
#include <la/block_lu.hpp>
#include <la/eigen.hpp>
#include <la/root_count.hpp>

using namespace whirl;
using namespace whirl::la;
using namespace whirl::la::test;

namespace {

/// All finite eigenvalues with Im >= 0 of the active part, from a dense linearisation of its own:
/// 1/lambda is an eigenvalue of [-K^-1 C, -K^-1 M; I, 0].
std::vector<Complex> dense_eigenvalues(const MCK& m, const Mask& active) {
  std::vector<Index> u;
  for (std::size_t i = 0; i < active.size(); ++i)
    if (active[i]) u.push_back(static_cast<Index>(i));
  const MatX M = dense(m.M)(u, u), C = dense(m.C)(u, u), K = dense(m.K)(u, u);
  const Index n = K.rows();
  const DenseLu<double> lu(K);
  MatX a = MatX::Zero(2 * n, 2 * n);
  a.topLeftCorner(n, n) = -lu.solve(C);
  a.topRightCorner(n, n) = -lu.solve(M);
  a.bottomLeftCorner(n, n).setIdentity();
  // Balance the halves: frequencies are far from 1.
  const double w = std::sqrt(K.norm() / std::max(M.norm(), 1e-300));
  a.topRightCorner(n, n) *= w;
  a.bottomLeftCorner(n, n) /= w;
  const VecXc mu = eigenvalues(a);
  std::vector<Complex> lambda;
  for (const Complex x : mu)
    if (std::abs(x) > 1e-7 * mu.cwiseAbs().maxCoeff() && (1.0 / x).imag() >= 0.0)
      lambda.push_back(1.0 / x);
  std::sort(lambda.begin(), lambda.end(),
            [](Complex x, Complex y) { return std::abs(x) < std::abs(y); });
  return lambda;
}

/// Every one of the first `modes.size()` dense eigenvalues is among the modes, within `tolerance`
/// relative; conjugates once.
void expect_same(std::vector<Mode> modes, const std::vector<Complex>& reference, double tolerance) {
  std::sort(modes.begin(), modes.end(),
            [](const Mode& a, const Mode& b) { return std::abs(a.lambda) < std::abs(b.lambda); });
  ASSERT_LE(modes.size(), reference.size());
  std::vector<bool> used(reference.size(), false);
  for (const Mode& mode : modes) {
    std::size_t best = 0;
    double distance = infinity;
    for (std::size_t j = 0; j < std::min(reference.size(), modes.size() + 2); ++j)
      if (!used[j] && std::abs(reference[j] - mode.lambda) < distance) {
        distance = std::abs(reference[j] - mode.lambda);
        best = j;
      }
    used[best] = true;
    EXPECT_LE(distance, tolerance * std::abs(mode.lambda))
        << mode.lambda << " nearest " << reference[best];
  }
  // None below the largest was passed over.
  for (std::size_t j = 0; j < modes.size(); ++j)
    EXPECT_TRUE(used[j] || std::abs(std::abs(reference[j]) - std::abs(modes.back().lambda)) <
                               1e-6 * std::abs(reference[j]))
        << reference[j];
}

double residual(const MCK& m, const Mask& active, const Mode& mode) {
  const MatXc q = dense<Complex>(m, active, mode.lambda * mode.lambda, mode.lambda, 1.0);
  const MatX size = std::norm(mode.lambda) * dense(m.M).cwiseAbs() +
                    std::abs(mode.lambda) * dense(m.C).cwiseAbs() + dense(m.K).cwiseAbs();
  return (q * mode.x).norm() / (size * mode.x.cwiseAbs()).norm();
}

/// Number of whirl frequencies below omega of an undamped gyroscopic system: the negative
/// eigenvalues of the Hermitian matrix K + i omega C - omega^2 M, which cross zero downwards only.
Index frequencies_below(const MCK& m, const Mask& active, double omega) {
  BlockLu<Complex> lu(m.K.pattern(), active);
  EXPECT_EQ(lu.factor(m, -omega * omega, Complex(0.0, omega), 1.0), Status::ok);
  return lu.negative_eigenvalues();
}

Mask pinned(const BlockPattern& p, bool only_bending) {
  Mask a = all_active(p);
  const auto hold = [&](Index node, int c) { a[static_cast<std::size_t>(6 * node + c)] = 0; };
  for (const Index end : {Index(0), p.size() - 1}) {
    hold(end, 1);
    hold(end, 2);
  }
  if (only_bending)
    for (Index i = 0; i < p.size(); ++i) {
      hold(i, 0);
      hold(i, 3);
    }
  return a;
}

}  // namespace

TEST(QuadraticModes, GyroscopicRotorOnSpringsInClosedForm) {
  // One node: u_y and u_z on springs, tilt with Jt w^2 -+ Jp Omega w - kt = 0, everything else
  // held.
  const BlockPattern p(1, {});
  MCK m(p);
  const double mass = 3.0, k = 2.7e4, jt = 0.02, jp = 0.034, kt = 150.0, Omega = 800.0;
  for (int c : {1, 2}) {
    m.M.block(0)(c, c) = mass;
    m.K.block(0)(c, c) = k;
  }
  for (int c : {4, 5}) {
    m.M.block(0)(c, c) = jt;
    m.K.block(0)(c, c) = kt;
  }
  m.C.block(0)(4, 5) = jp * Omega;
  m.C.block(0)(5, 4) = -jp * Omega;
  Mask a(6, 1);
  a[0] = a[3] = 0;
  const double g = jp * Omega, root = std::sqrt(g * g + 4.0 * jt * kt);
  const double expected[] = {(root - g) / (2.0 * jt), std::sqrt(k / mass), std::sqrt(k / mass),
                             (root + g) / (2.0 * jt)};
  for (const Index dense_below : {0, 36}) {
    ModeOptions o;
    o.count = 4;
    o.dense_below = dense_below;
    const auto modes = quadratic_modes(m, a, o);
    ASSERT_EQ(modes.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(modes[i].lambda.imag(), expected[i], 1e-13 * expected[i]);
      EXPECT_NEAR(modes[i].lambda.real(), 0.0, 1e-13 * expected[i]);
      EXPECT_LT(modes[i].residual, 1e-14);
    }
    // The double one comes with two independent vectors.
    EXPECT_GT(std::abs(modes[1].x(1) * modes[2].x(2) - modes[1].x(2) * modes[2].x(1)), 0.1);
    // Backward and forward precession: u_phi_z / u_phi_y = -+ i.
    EXPECT_NEAR(std::abs(modes[0].x(5) / modes[0].x(4) - modes[3].x(4) / modes[3].x(5)), 0.0,
                1e-12);
  }
}

// Of more than some hundred modes the search takes a part at a time, all near zero first.
TEST(QuadraticModes, HundredsOfModes) {
  Shaft s;
  s.elements = 80;
  const BlockPattern p(81, chain(81));
  const Mask a = pinned(p, true);
  const MCK m = shaft_matrices(p, s, 3000.0);
  ModeOptions o;
  o.count = 300;
  o.tolerance = 1e-9;
  const auto parts = quadratic_modes(m, a, o);
  o.dense_below = 1000;
  const auto whole = quadratic_modes(m, a, o);
  ASSERT_EQ(parts.size(), 300u);
  ASSERT_EQ(whole.size(), 300u);
  for (std::size_t k = 0; k < 300; ++k)
    EXPECT_NEAR(parts[k].lambda.imag(), whole[k].lambda.imag(), 1e-6 * whole[k].lambda.imag());
}

TEST(QuadraticModes, TheSearchStopsWhenAsked) {
  const BlockPattern p(33, chain(33));
  Shaft s;
  s.elements = 32;
  const MCK m = shaft_matrices(p, s, 300.0);
  const Mask a = pinned(p, true);
  for (const Index dense_below : {0, 1000}) {
    ModeOptions o;
    o.count = 8;
    o.dense_below = dense_below;
    interrupt::flag.store(true);
    EXPECT_THROW(quadratic_modes(m, a, o), Interrupted);
    interrupt::flag.store(false);
    EXPECT_EQ(quadratic_modes(m, a, o).size(), 8u);
  }
}

TEST(QuadraticModes, SpinningRayleighShaftInClosedForm) {
  // Pinned ends: (rho A + rho I k^2) w^2 -+ 2 rho I k^2 Omega w - E I k^4 = 0 with k = j pi / L.
  Shaft s;
  s.elements = 32;
  const BlockPattern p(33, chain(33));
  const Mask a = pinned(p, true);
  for (const double Omega : {0.0, 1e-7, 300.0, 5000.0}) {
    const MCK m = shaft_matrices(p, s, Omega);
    ModeOptions o;
    o.count = 8;
    const auto modes = quadratic_modes(m, a, o);
    ASSERT_EQ(modes.size(), 8u);
    std::vector<double> exact;
    for (int j = 1; j <= 6; ++j) {
      const double k = j * pi / s.length, mm = s.rho * (s.area() + s.I() * k * k),
                   g = 2.0 * s.rho * s.I() * k * k * Omega;
      const double root = std::sqrt(g * g + 4.0 * mm * s.E * s.I() * std::pow(k, 4));
      exact.push_back((root - g) / (2.0 * mm));
      exact.push_back((root + g) / (2.0 * mm));
    }
    std::sort(exact.begin(), exact.end());
    for (std::size_t i = 0; i < 8; ++i) {
      // Cubic elements: error (k h)^4 / 720 in omega^2, 3.5e-5 for the fourth mode in 32 elements.
      EXPECT_NEAR(modes[i].lambda.imag(), exact[i], 4e-5 * exact[i]) << Omega;
      EXPECT_LT(std::abs(modes[i].lambda.real()), 1e-10 * exact[i]);
      EXPECT_LT(modes[i].residual, 1e-14);
    }
  }
}

TEST(QuadraticModes, MatchesDenseOnRandomProblems) {
  std::mt19937 rng(17);
  for (int round = 0; round < 24; ++round) {
    const Index n = 3 + round % 7;
    const BlockPattern p(n, round % 2 ? chain(n) : random_graph(n, 2, rng));
    MCK m = random_matrices(p, 6.0, rng);
    for (Index i = 0; i < n; ++i)
      m.M.block(p.diagonal(i)) += 4.0 * Matrix<6>::Identity();
    const Mask a = round % 3 ? random_mask(p, 0.25, rng) : all_active(p);
    if (round % 4 == 3)  // a massless, damped node and one without anything but stiffness
      for (Index j = 0; j < n; ++j) {
        const bool first = p.slot(0, j) >= 0, last = p.slot(n - 1, j) >= 0;
        if (first) {
          m.M.block(p.slot(0, j)).setZero();
          m.M.block(p.slot(j, 0)).setZero();
        }
        if (last) {
          m.M.block(p.slot(n - 1, j)).setZero();
          m.M.block(p.slot(j, n - 1)).setZero();
          m.C.block(p.slot(n - 1, j)).setZero();
          m.C.block(p.slot(j, n - 1)).setZero();
        }
      }
    const auto reference = dense_eigenvalues(m, a);
    for (const Index dense_below : {0, 1000}) {
      ModeOptions o;
      o.count = 7;
      o.dense_below = dense_below;
      const auto modes = quadratic_modes(m, a, o);
      ASSERT_EQ(modes.size(), std::min<std::size_t>(7, reference.size())) << round;
      expect_same(modes, reference, 1e-9);  // what the dense reference is good for
      for (const Mode& mode : modes) {
        EXPECT_LT(residual(m, a, mode), 1e-14) << round;
        EXPECT_LT(mode.residual, 1e-14);
        for (std::size_t u = 0; u < a.size(); ++u) {
          if (!a[u]) {
            EXPECT_EQ(mode.x(static_cast<Index>(u)), 0.0);
          }
        }
      }
    }
  }
}

TEST(QuadraticModes, DoubleRealRootsComeTwice) {
  // Rounding makes a pair of a double real root when the vectors found for it are taken apart: both
  // were given the pair's real part, and the second was lost. lambda^2 + 10 lambda + 20 stands
  // twice in the diagonal of T^-1 Q S^-1.
  constexpr Index nodes = 3, n = 6 * nodes;
  const BlockPattern p(nodes, {{0, 1}, {0, 2}, {1, 2}});
  for (unsigned seed = 1; seed <= 9; ++seed) {
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> u(-0.15, 0.15);
    const auto mixing = [&] {
      return MatX(MatX::Identity(n, n) + MatX::NullaryExpr(n, n, [&] { return u(rng); }));
    };
    const MatX T = mixing(), S = mixing();
    VecX mass = VecX::Ones(n), damping(n), stiffness(n);
    for (Index i = 0; i < n; ++i) {
      damping[i] = i < 2 ? 10.0 : 0.02 * static_cast<double>(i);
      stiffness[i] = i < 2 ? 20.0 : std::pow(5.5 + static_cast<double>(i), 2);
    }
    MCK m(p);
    const auto fill = [&](BlockMatrix<6>& to, const VecX& diagonal) {
      const MatX full = T * diagonal.asDiagonal() * S;
      for (Index i = 0; i < nodes; ++i)
        for (Index j = 0; j < nodes; ++j)
          to.block(p.slot(i, j)) = full.block<6, 6>(6 * i, 6 * j);
    };
    fill(m.M, mass);
    fill(m.C, damping);
    fill(m.K, stiffness);
    for (const Index dense_below : {0, 1000}) {
      ModeOptions o;
      o.count = 0;
      o.max_frequency = 9.0;
      o.dense_below = dense_below;
      const auto modes = quadratic_modes(m, all_active(p), o);
      for (const double root : {-5.0 - std::sqrt(5.0), -5.0 + std::sqrt(5.0)}) {
        const auto at_root = [&](const Mode& mode) { return std::abs(mode.lambda - root) < 1e-9; };
        EXPECT_EQ(std::count_if(modes.begin(), modes.end(), at_root), 2)
            << seed << " " << dense_below << " " << root;
      }
    }
  }
}

TEST(QuadraticModes, RotorsMatchDenseInAllRegimes) {
  const BlockPattern p(9, chain(9));
  const Mask a = all_active(p);
  for (const double Omega : {0.0, 1e-6, 200.0, 2000.0})
    for (const double kz : {1e7, 0.8e7})
      for (const double damping : {0.0, 300.0, 1e5, 3e6}) {
        MCK m = rotor(p, 8, Omega, kz, damping);
        add_bearing(m, 0, 0.0, 0.0, 0.0, 0.0,
                    damping > 0.0 ? 2e6 : 0.0);  // cross-coupled: unstable
        m.K.block(p.diagonal(3))(3, 3) += 1e4;   // the dense reference needs K regular
        const auto reference = dense_eigenvalues(m, a);
        ModeOptions o;
        o.count = 10;
        o.dense_below = 0;
        const auto modes = quadratic_modes(m, a, o);
        ASSERT_EQ(modes.size(), 10u);
        // The dense reference loses half the digits of double roots.
        expect_same(modes, reference, 1e-6);
        for (const Mode& mode : modes)
          EXPECT_LT(mode.residual, 1e-14)
              << Omega << " " << kz << " " << damping << " " << mode.lambda;
      }
}

TEST(QuadraticModes, FreeShaftHasSixRigidMotionsAndTheTextbookBendingModes) {
  Shaft s;
  s.elements = 40;
  s.diameter = 0.003;  // slender, so that rotary inertia counts 1e-5
  const BlockPattern p(41, chain(41));
  const Mask a = all_active(p);
  const MCK m = shaft_matrices(p, s, 0.0);
  ModeOptions o;
  o.count = 10;
  const auto modes = quadratic_modes(m, a, o);
  ASSERT_EQ(modes.size(), 10u);
  MatX rigid(p.size() * 6, 6);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(modes[i].lambda, 0.0);
    EXPECT_LT(modes[i].residual, 1e-13);
    rigid.col(static_cast<Index>(i)) = modes[i].x.real().normalized();
  }
  EXPECT_GT((rigid.transpose() * rigid).eval().eigenvalues().real().minCoeff(),
            1e-3);  // independent
  const double beta[] = {4.73004074, 4.73004074, 7.85320462, 7.85320462};
  for (std::size_t i = 0; i < 4; ++i) {
    const double omega =
        std::pow(beta[i] / s.length, 2) * std::sqrt(s.E * s.I() / (s.rho * s.area()));
    EXPECT_NEAR(modes[6 + i].lambda.imag(), omega, 3e-5 * omega);  // rotary inertia 2e-5, mesh 4e-6
  }
  // A stiff one that spins with a heavy disk precesses as a whole at Jp Omega / Jt; an axis that
  // stands still is a motion as well.
  s.diameter = 0.3;
  const double Omega = 10.0;
  MCK spinning = shaft_matrices(p, s, Omega);
  add_disk(spinning, 20, 100.0, 60.0, 31.0, Omega);
  const auto whirl = quadratic_modes(spinning, a, o);
  ASSERT_EQ(whirl.size(), 10u);
  std::size_t zero = 0;
  for (const Mode& mode : whirl)
    zero += mode.lambda == 0.0;
  const double mass = s.rho * s.area() * s.length, jp = 2.0 * s.rho * s.I() * s.length;
  const double jt = mass * s.length * s.length / 12.0 + 0.5 * jp,
               precession = (jp + 60.0) * Omega / (jt + 31.0);
  EXPECT_EQ(zero, 6u);
  EXPECT_NEAR(whirl[6].lambda.imag(), precession,
              1e-5 * precession);  // bending: (precession / first bending frequency)^2 = 2e-6
}

TEST(QuadraticModes, DraggedRigidMotionHasARealRoot) {
  // A free mass with drag c: lambda = 0 and -c/m; a sprung one beside it.
  const BlockPattern p(8, chain(8));
  MCK m(p);
  Mask a(48, 0);
  for (Index i = 0; i < 8; ++i) {
    a[static_cast<std::size_t>(6 * i)] = 1;
    m.M.block(p.diagonal(i))(0, 0) = 2.0;
    m.C.block(p.diagonal(i))(0, 0) = 0.5;
    if (i == 0) continue;
    const double k = 1e3;
    m.K.block(p.diagonal(i))(0, 0) += k;
    m.K.block(p.diagonal(i - 1))(0, 0) += k;
    m.K.block(p.slot(i, i - 1))(0, 0) = m.K.block(p.slot(i - 1, i))(0, 0) = -k;
  }
  for (const Index dense_below : {0, 36}) {
    ModeOptions o;
    o.count = 3;
    o.dense_below = dense_below;
    const auto modes = quadratic_modes(m, a, o);
    ASSERT_EQ(modes.size(), 3u);
    EXPECT_NEAR(std::abs(modes[0].lambda), 0.0, 1e-12);
    EXPECT_NEAR(modes[1].lambda.real(), -0.25, 1e-12);
    EXPECT_EQ(modes[1].lambda.imag(), 0.0);
    const double w2 = 2.0 * 1e3 / 2.0 * (1.0 - std::cos(pi / 8.0));
    EXPECT_NEAR(std::abs(modes[2].lambda), std::sqrt(w2), 1e-12 * std::sqrt(w2));
    EXPECT_NEAR(modes[2].lambda.real(), -0.125, 1e-11);
    o.real_roots = false;
    const auto whirl = quadratic_modes(m, a, o);
    ASSERT_EQ(whirl.size(), 3u);
    for (const Mode& mode : whirl)
      EXPECT_GT(mode.lambda.imag(), 1.0);
  }
}

// A spin whose rate pushes the shaft aside, which turns it in turn, as journals do whose films carry more the
// faster they turn: what it decays by is c - t'K^-1 f, not c; down to where rounding of stiffness hides it.
TEST(QuadraticModes, ASpinThatMovesTheShaftAsideDecaysByWhatIsLeft) {
  constexpr Index nodes = 20;
  constexpr double inertia = 0.2, torsion = 1e7, k = 2e7, cross = 3e7, mass = 30.0;
  const BlockPattern p(nodes, chain(nodes));
  Mask a(6 * nodes, 0);
  for (Index i = 0; i < nodes; ++i)
    a[static_cast<std::size_t>(6 * i + 3)] = 1;
  a[1] = a[2] = 1;
  Mat2 K;
  K << k, cross, -cross, k;
  const Vec2 f(0.7, -1.3);
  for (double size = 1e-5; size < 1.0; size *= 1.3)
    for (const double left : {0.05, 0.3, 1.0, 2.5, -0.4}) {
      const double rate = left < 0.0 ? size : -size, drag = -rate * nodes * inertia / left;
      SCOPED_TRACE(testing::Message() << rate << ", what is left of it " << left);
      MCK m(p);
      for (Index i = 0; i < nodes; ++i) {
        m.M.block(p.diagonal(i))(3, 3) = inertia;
        if (i == 0) continue;
        m.K.block(p.diagonal(i))(3, 3) += torsion;
        m.K.block(p.diagonal(i - 1))(3, 3) += torsion;
        m.K.block(p.slot(i, i - 1))(3, 3) = m.K.block(p.slot(i - 1, i))(3, 3) = -torsion;
      }
      const Index d = p.diagonal(0);
      m.M.block(d).block<2, 2>(1, 1) = mass * Mat2::Identity();
      m.K.block(d).block<2, 2>(1, 1) = K;
      m.C.block(d).block<2, 2>(1, 1) = 2e3 * Mat2::Identity();
      m.C.block(d)(3, 3) = drag;
      m.C.block(d).block<2, 1>(1, 3) = drag * f;
      const Vec2 moved = K.inverse() * f;
      m.K.block(d).block<1, 2>(3, 1) = (1.0 - left) * moved.transpose() / moved.squaredNorm();
      ModeOptions o;
      o.count = 3;
      o.certify = true;
      o.maybe_free = MatX::Zero(6 * nodes, 1);
      for (Index i = 0; i < nodes; ++i)
        o.maybe_free(6 * i + 3, 0) = 1.0;
      ModeSolver solver(p, a, o);
      double nearest = infinity;
      for (const Mode& mode : solver.solve(m))
        nearest = std::min(nearest, std::abs(mode.lambda - rate));
      EXPECT_TRUE(solver.certificate().complete());
      constexpr double hidden =
          1e-2;  // ten times the root of what rounding of 1e7 makes of 20 x 0.2
      EXPECT_LT(nearest, std::abs(rate) > hidden ? 2e-2 * std::abs(rate) : hidden);
    }
}

TEST(QuadraticModes, CountIsCompleteBelowAFrequency) {
  const Index n = 60;
  const BlockPattern p(n + 1, chain(n + 1));
  Mask a = all_active(p);
  a[3] = 0;  // spin held, so that K is definite and the count by inertia holds
  for (const double Omega : {0.0, 50.0, 600.0})
    for (const double limit : {150.0, 900.0, 6000.0}) {
      const MCK m = rotor(p, n, Omega, 1e7);
      ModeOptions o;
      o.count = 0;
      o.max_frequency = limit;
      const auto modes = quadratic_modes(m, a, o);
      EXPECT_EQ(static_cast<Index>(modes.size()), frequencies_below(m, a, limit)) << Omega;
      for (const Mode& mode : modes)
        EXPECT_LE(mode.lambda.imag(), limit);
    }
}

TEST(QuadraticModes, ComplexShiftFindsTheNeighbours) {
  const Index n = 30;
  const BlockPattern p(n + 1, chain(n + 1));
  const Mask a = all_active(p);
  const MCK m = rotor(p, n, 300.0, 0.8e7, 2000.0);
  ModeOptions all;
  all.count = 24;
  const auto reference = quadratic_modes(m, a, all);
  ModeOptions o;
  o.count = 4;
  o.shift = Complex(0.0, 1200.0);
  const auto modes = quadratic_modes(m, a, o);
  ASSERT_EQ(modes.size(), 4u);
  std::vector<Complex> nearest;
  for (const Mode& r : reference)
    nearest.push_back(r.lambda);
  std::sort(nearest.begin(), nearest.end(),
            [&](Complex x, Complex y) { return std::abs(x - *o.shift) < std::abs(y - *o.shift); });
  nearest.resize(4);
  std::sort(nearest.begin(), nearest.end(),
            [](Complex x, Complex y) { return x.imag() < y.imag(); });
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT(std::abs(modes[i].lambda - nearest[i]), 1e-9 * std::abs(nearest[i]));
}

TEST(QuadraticModes, ExactlyTheLowestOfALongChain) {
  const Index n = 2000;
  const BlockPattern p(n + 1, chain(n + 1));
  Mask a = all_active(p);
  a[3] = 0;
  const MCK m = rotor(p, n, 400.0, 1e7);
  ModeOptions o;
  o.count = 14;
  const auto modes = quadratic_modes(m, a, o);
  ASSERT_EQ(modes.size(), 14u);
  // Between neighbours, and beyond the last, the count by inertia is the count of modes.
  for (std::size_t i = 0; i + 1 < modes.size(); ++i) {
    const double between = 0.5 * (modes[i].lambda.imag() + modes[i + 1].lambda.imag());
    if (modes[i + 1].lambda.imag() - modes[i].lambda.imag() < 1e-3 * between) continue;
    EXPECT_EQ(frequencies_below(m, a, between), static_cast<Index>(i + 1));
  }
  // The same rotor in 250 elements: meshes this fine agree to 1e-4 (their rods' lumped ends differ
  // by h).
  const BlockPattern coarse(251, chain(251));
  Mask b = all_active(coarse);
  b[3] = 0;
  const auto reference = quadratic_modes(rotor(coarse, 250, 400.0, 1e7), b, o);
  for (std::size_t i = 0; i < 8; ++i)
    EXPECT_NEAR(modes[i].lambda.imag(), reference[i].lambda.imag(),
                5e-3 * reference[i].lambda.imag());
}

TEST(QuadraticModes, AMatrixWithNothingInItIsDiagnosed) {
  const BlockPattern p(12, chain(12));
  Mask a = all_active(p);
  MCK m = rotor(p, 11, 0.0);
  for (BlockMatrix<6>* x : {&m.M, &m.K})
    for (Index j : {4, 5, 6}) {
      x->block(p.slot(5, j)).row(3).setZero();
      x->block(p.slot(j, 5)).col(3).setZero();
    }
  try {
    quadratic_modes(m, a);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().front().where.entity, "node 5");
  }
  EXPECT_TRUE(quadratic_modes(m, Mask(72, 0)).empty());
}

TEST(ModeSolver, SweepsGiveWhatSingleSpeedsGive) {
  const Index n = 24;
  const BlockPattern p(n + 1, chain(n + 1));
  const Mask a = all_active(p);
  for (const double kz : {1e7, 0.8e7})
    for (const double damping : {0.0, 700.0, 1e5}) {
      ModeOptions o;
      o.count = 11;
      ModeSolver sweep(p, a, o);
      for (int k = 0; k <= 20; ++k) {
        const MCK m = rotor(p, n, 80.0 * k, kz, damping);
        const auto modes = sweep.solve(m);
        const auto fresh = quadratic_modes(m, a, o);
        ASSERT_EQ(modes.size(), 11u);
        ASSERT_EQ(fresh.size(), 11u);
        for (std::size_t i = 0; i < 11; ++i)
          EXPECT_LT(std::abs(modes[i].lambda - fresh[i].lambda),
                    1e-8 * std::abs(fresh[i].lambda) + 1e-8)
              << kz << " " << damping << " speed " << k;
      }
    }
}

TEST(ModeSolver, FollowsModesThroughCrossings) {
  // Torsion and stretching do not feel the spin; forward whirl rises through them. `from` keeps
  // them apart.
  const Index n = 20;
  const BlockPattern p(n + 1, chain(n + 1));
  const Mask a = all_active(p);
  ModeOptions o;
  o.count = 10;
  ModeSolver sweep(p, a, o);
  const auto lateral = [](const Mode& m) {
    double s = 0.0, all = 0.0;
    for (Index u = 0; u < m.x.size(); ++u) {
      all += std::norm(m.x(u));
      if (u % 6 != 0 && u % 6 != 3) s += std::norm(m.x(u));
    }
    return s / all;
  };
  std::vector<Mode> last;
  int crossings = 0;
  for (int k = 0; k <= 60; ++k) {
    const auto modes = sweep.solve(rotor(p, n, 10.0 + 60.0 * k, 0.8e7, 0.0));
    ASSERT_EQ(modes.size(), 10u);
    for (std::size_t i = 0; i < modes.size() && k > 0; ++i) {
      if (modes[i].from < 0) continue;
      const Mode& old = last[static_cast<std::size_t>(modes[i].from)];
      EXPECT_EQ(lateral(modes[i]) > 0.5, lateral(old) > 0.5) << k << " " << i;
      EXPECT_LT(std::abs(modes[i].lambda - old.lambda), 0.1 * std::abs(old.lambda) + 1e-6);
      crossings += modes[i].from != static_cast<Index>(i);
    }
    last = modes;
  }
  EXPECT_GE(crossings, 4);  // two modes change places at each crossing
  const auto work = sweep.work();
  EXPECT_LT(work.factorizations, 25);  // about one a mode
}

TEST(ModeSolver, FollowPolishesOneMode) {
  const Index n = 20;
  const BlockPattern p(n + 1, chain(n + 1));
  const Mask a = all_active(p);
  ModeSolver solver(p, a);
  const auto modes = solver.solve(rotor(p, n, 100.0, 0.8e7, 500.0));
  const MCK next = rotor(p, n, 110.0, 0.8e7, 500.0);
  const auto reference = quadratic_modes(next, a);
  for (std::size_t i = 1; i < 8; ++i) {
    const auto mode = solver.follow(next, modes[i]);
    ASSERT_TRUE(mode);
    EXPECT_LT(std::abs(mode->lambda - reference[i].lambda), 1e-9 * std::abs(reference[i].lambda));
  }
}

TEST(SymmetricModes, PinnedBeamAndDenseReference) {
  Shaft s;
  s.elements = 16;
  const BlockPattern p(17, chain(17));
  Mask a = pinned(p, false);
  a[0] = a[3] = 0;
  const MCK m = shaft_matrices(p, s, 0.0);
  const auto modes = symmetric_modes(m, a, 9);
  ASSERT_EQ(modes.size(), 9u);
  std::vector<Index> u;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i]) u.push_back(static_cast<Index>(i));
  const MatX K = dense(m.K)(u, u), M = dense(m.M)(u, u);
  const SymmetricEigenpairs reference = symmetric_eigenpairs(K, M);
  MatX X(p.size() * 6, 9);
  for (Index i = 0; i < 9; ++i) {
    // The dense solver is good to eps times the ratio of extreme eigenvalues, 1e7.
    EXPECT_NEAR(modes[static_cast<std::size_t>(i)].omega2, reference.values(i),
                1e-8 * reference.values(i));
    EXPECT_LT(modes[static_cast<std::size_t>(i)].residual, 1e-14);
    X.col(i) = modes[static_cast<std::size_t>(i)].x;
  }
  EXPECT_LT((X.transpose() * dense(m.M) * X - MatX::Identity(9, 9)).cwiseAbs().maxCoeff(), 1e-8);
  const double k = pi / s.length,
               exact = s.E * s.I() * std::pow(k, 4) / (s.rho * (s.area() + s.I() * k * k));
  EXPECT_NEAR(modes[0].omega2, exact, 5e-6 * exact);  // (k h)^4 / 720 = 2e-6
}

TEST(LinearModes, EulerBucklingOfAPinnedColumn) {
  Shaft s;
  s.elements = 16;
  const BlockPattern p(17, chain(17));
  Mask a = pinned(p, true);
  const MCK m = shaft_matrices(p, s, 0.0);
  const BlockMatrix<6> g = thrust_matrix(p, s);
  const auto modes = linear_modes(m.K, g, a, 6);
  ASSERT_EQ(modes.size(), 6u);
  for (int j = 0; j < 6; ++j) {
    const double n = j / 2 + 1, load = n * n * pi * pi * s.E * s.I() / (s.length * s.length);
    // (k h)^4 / 720 of the third buckling mode is 1.7e-4.
    EXPECT_NEAR(modes[static_cast<std::size_t>(j)].lambda.real(), load, 2e-4 * load);
    EXPECT_EQ(modes[static_cast<std::size_t>(j)].lambda.imag(), 0.0);
  }
  // Near a given load only what is near it.
  const double second = modes[2].lambda.real();
  const auto near = linear_modes(m.K, g, a, 2, 1.02 * second);
  ASSERT_EQ(near.size(), 2u);
  for (const Mode& mode : near)
    EXPECT_NEAR(mode.lambda.real(), second, 1e-10 * second);
}

// A free slide that rounding holds by 1e-20 of the stiffest spring, a signal of 1e-9 1/s and masses at
// 1e3 and 1e6 rad/s: the shift of the slow ones left nothing of the fast ones, and the list was "0
// modes, complete".
TEST(QuadraticModes, SlowUnknownsHideNoFastOnes) {
  const BlockPattern p(1, {});
  for (const double held : {0.0, 1e-20, -1e-20})
    for (const double rate : {1e-9, 1e-3, 1e3}) {
      MCK m(p);
      auto M = m.M.block(0), C = m.C.block(0), K = m.K.block(0);
      M.diagonal() << 1, 1, 1, 0, 0, 0;
      C.diagonal() << 0, 2, 20, 1, 0, 0;
      K.diagonal() << held, 1e6, 1e12, rate, 0, 0;
      const Mask a{1, 1, 1, 1, 0, 0};
      for (const int count : {2, 6}) {
        ModeOptions o;
        o.count = count;
        o.certify = true;
        ModeSolver solver(p, a, o);
        std::vector<double> fast;
        for (const Mode& mode : solver.solve(m))
          if (mode.lambda.imag() > 1.0) fast.push_back(mode.lambda.imag());
        EXPECT_TRUE(solver.certificate().complete()) << held << " " << rate;
        ASSERT_EQ(fast.size(), 2u) << held << " " << rate << " " << count;
        EXPECT_NEAR(fast[0], std::sqrt(1e6 - 1), 1e-6);
        EXPECT_NEAR(fast[1], std::sqrt(1e12 - 100), 1e-3);
      }
    }
}

/// Disks on a massless pinned shaft in axes that turn with it, each damped: eight roots a disk are all
/// that is finite.
struct MasslessRotor {
  BlockPattern pattern;
  Mask active;
  MCK m;
  Index disks = 0;
};

MasslessRotor random_massless_rotor(std::mt19937& rng) {
  std::uniform_real_distribution<double> u(0.0, 1.0);
  Shaft s;
  s.elements = std::uniform_int_distribution<Index>(2, 5)(rng);
  s.diameter = 0.02 + 0.08 * u(rng);
  s.rho = 0.0;
  const double Omega = 50.0 + 350.0 * u(rng);
  MasslessRotor r{BlockPattern(s.elements + 1, chain(s.elements + 1)), {}, {}, 0};
  r.m = shaft_matrices(r.pattern, s, 0.0);
  r.active = pinned(r.pattern, true);
  for (Index i = 1; i <= s.elements; ++i)
    r.active[static_cast<std::size_t>(6 * i)] = 1;  // and can move along
  for (Index i = 1; i < s.elements; ++i) {
    if (i > 1 && u(rng) < 0.4) continue;
    ++r.disks;
    auto M = r.m.M.block(r.pattern.diagonal(i)), C = r.m.C.block(r.pattern.diagonal(i)),
         K = r.m.K.block(r.pattern.diagonal(i));
    const double mass = 1.0 + 20.0 * u(rng), Id = 1e-3 * mass, Ip = (0.5 + u(rng)) * Id,
                 c = 100.0 * u(rng);
    for (const auto& [a, b, inertia, polar, drag] :
         {std::tuple{1, 2, mass, 0.0, c}, std::tuple{4, 5, Id, Ip, 0.0}}) {
      M(a, a) = M(b, b) = inertia;
      C(a, a) = C(b, b) = drag;
      C(a, b) = Omega * (polar - 2.0 * inertia);
      C(b, a) = -C(a, b);
      K(a, a) += Omega * Omega * (polar - inertia);
      K(b, b) += Omega * Omega * (polar - inertia);
      K(a, b) -= Omega * drag;
      K(b, a) += Omega * drag;
    }
  }
  return r;
}

// The roots at infinity of what has no mass came out as rounding, outnumbered the finite ones and set
// the shift among them: one of four modes was listed, on some processors.
TEST(QuadraticModes, WhatHasNoMassHidesNothing) {
  std::mt19937 rng(5);
  for (int k = 0; k < 200; ++k) {
    const MasslessRotor r = random_massless_rotor(rng);
    for (const Index below : {Index(0), Index(36)}) {
      ModeOptions o;
      o.count = 4 * r.disks;
      o.dense_below = below;
      const std::vector<Mode> modes = quadratic_modes(r.m, r.active, o);
      EXPECT_EQ(static_cast<Index>(modes.size()), 4 * r.disks) << k << " " << below;
      expect_same(modes, dense_eigenvalues(r.m, r.active), 1e-6);
    }
  }
}

// The same with few modes asked for, of a fine mesh: the crowd is in the region that is counted, and no
// root of it is known. It is cut off; one search from place to place took minutes.
TEST(QuadraticModes, ACrowdNobodyAskedForIsNotLookedFor) {
  Shaft s;
  s.elements = 150;
  const BlockPattern p(151, chain(151));
  const Mask a = pinned(p, true);
  const MCK undamped = shaft_matrices(p, s, 0.0);
  ModeOptions o;
  o.count = 4;
  o.certify = true;
  const std::vector<Mode> slow = quadratic_modes(undamped, a, o);
  ASSERT_EQ(slow.size(), 4u);
  for (const double factor : {0.2, 0.5, 1.0}) {
    const double beta = factor / slow.back().lambda.imag();  // a half is the damping ratio
    MCK m = shaft_matrices(p, s, 0.0);
    for (std::size_t k = 0; k < m.K.value_count(); ++k)
      m.C.data()[k] += beta * m.K.data()[k];
    ModeSolver solver(p, a, o);
    const std::vector<Mode> modes = solver.solve(m);
    EXPECT_TRUE(solver.certificate().complete()) << factor;
    std::vector<Complex> oscillating;
    for (const Mode& mode : modes)
      if (oscillates(mode.lambda)) oscillating.push_back(mode.lambda);
    ASSERT_EQ(oscillating.size(), 4u) << factor;
    for (std::size_t k = 0; k < 4; ++k) {
      const double w = slow[k].lambda.imag(), decay = 0.5 * beta * w * w;
      const Complex expected(-decay, std::sqrt(w * w - decay * decay));
      EXPECT_NEAR(std::abs(oscillating[k] - expected), 0.0, 1e-6 * w) << factor << " " << k;
    }
    EXPECT_LE(solver.work().searches, 12) << factor;
  }
}

// Filters of four control loops that are alike, beside the few slow modes asked for: what decays in the
// region that is counted comes out of one search over it. It took a dense solution of all unknowns.
TEST(QuadraticModes, FiltersOfControlLoopsAreFoundTogether) {
  Shaft s;
  s.elements = 60;
  constexpr Index loops = 4;
  const Index nodes = s.elements + 1;
  Pairs pairs = chain(nodes);
  for (Index k = 0; k < loops; ++k)
    pairs.emplace_back(12 * (k + 1), nodes + k);
  const BlockPattern p(nodes + loops, pairs);
  MCK m = shaft_matrices(p, s, 0.0);
  const std::array<double, 6> rates{40.0, 300.0, 900.0, 1500.0, 2500.0, 4000.0};
  for (Index k = 0; k < loops; ++k) {
    const Index loop = p.diagonal(nodes + k);
    for (int f = 0; f < 6; ++f) {
      m.C.block(loop)(f, f) = 1.0;
      m.K.block(loop)(f, f) = rates[at(f)];
    }
    // each reads a displacement, and nothing follows it
    m.K.block(p.slot(nodes + k, 12 * (k + 1)))(0, 1) = -1.0;
  }
  const BlockPattern bare(nodes, chain(nodes));
  const Mask held = pinned(bare, true);
  Mask active = held;
  active.insert(active.end(), 6 * loops, 1);
  ModeOptions o;
  o.count = 0;
  o.max_frequency = 2000.0;
  o.certify = true;
  const std::vector<Mode> expected = quadratic_modes(shaft_matrices(bare, s, 0.0), held, o);
  o.real_roots = true;
  ModeSolver solver(p, active, o);
  std::vector<double> found;
  std::array<int, 6> copies{};
  for (const Mode& mode : solver.solve(m)) {
    if (mode.lambda.imag() > 0.0) found.push_back(mode.lambda.imag());
    for (std::size_t f = 0; f < rates.size(); ++f)
      copies[f] += std::abs(mode.lambda + rates[f]) < 1e-8 * rates[f];
  }
  EXPECT_TRUE(solver.certificate().complete());
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k)
    EXPECT_NEAR(found[k], expected[k].lambda.imag(), 1e-8 * found[k]);
  for (std::size_t f = 0; f < rates.size(); ++f)
    EXPECT_EQ(copies[f], loops) << rates[f];
  EXPECT_LT(solver.work().operator_products, 6 * p.size());  // which a dense solution takes
}

// Damping by the stiffness, C = beta K: nothing oscillates faster than 1/beta, and all that is faster
// crowds about -1/beta. More modes asked for than there are: the list ends, as far as it is certified.
TEST(QuadraticModes, ACrowdOfDecayingRootsEndsAList) {
  Shaft s;
  s.elements = 24;
  const BlockPattern p(25, chain(25));
  const Mask a = pinned(p, true);
  MCK m = shaft_matrices(p, s, 0.0);
  const double beta = 1e-4;
  for (std::size_t k = 0; k < m.K.value_count(); ++k)
    m.C.data()[k] += beta * m.K.data()[k];
  ModeOptions o;
  o.count = 40;
  o.certify = true;
  ModeSolver solver(p, a, o);
  std::size_t oscillating = 0;
  double last = 0.0;
  const std::vector<Mode> modes = solver.solve(m);
  const CountRegion region{solver.certificate().radius, solver.certificate().reach};
  for (const Mode& mode : modes)
    if (oscillates(mode.lambda)) {
      oscillating += region.contains(mode.lambda);
      last = std::max(last, mode.lambda.imag());
      // lambda^2 + beta w^2 lambda + w^2 = 0
      const double w = std::abs(mode.lambda);
      EXPECT_NEAR(mode.lambda.real(), -0.5 * beta * w * w, 1e-6 * w);
    }
  const Certificate& c = solver.certificate();
  EXPECT_TRUE(c.complete());
  EXPECT_GE(oscillating, 8u);
  EXPECT_GE(c.radius, last);
  EXPECT_LT(last, 1 / beta);
  // by the undamped frequencies: those of the circle that the region holds
  MCK undamped = shaft_matrices(p, s, 0.0);
  ModeOptions all;
  all.count = 0;
  all.max_frequency = 2 / beta;
  all.certify = true;
  std::size_t expected = 0;
  for (const Mode& mode : quadratic_modes(undamped, a, all)) {
    const double w = mode.lambda.imag(), decay = 0.5 * beta * w * w;
    if (decay >= w || !oscillates(Complex(-decay, std::sqrt(w * w - decay * decay)))) continue;
    expected += decay < c.reach && std::sqrt(w * w - decay * decay) < c.radius;
  }
  EXPECT_EQ(oscillating, expected);
}
