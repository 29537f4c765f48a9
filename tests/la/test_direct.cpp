#include "fixtures.hpp"
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <la/block_lu.hpp>
#include <la/direct.hpp>

using namespace whirl;
using namespace whirl::la;
using namespace whirl::la::test;

namespace {

template <class Scalar>
using Vec = Eigen::Matrix<Scalar, -1, 1>;

Complex some_scalar(Complex, double a, double b) { return {a, b}; }
double some_scalar(double, double a, double) { return a; }

/// Relative difference of two solutions that must agree but for rounding times the condition of
/// random matrices.
template <class Scalar>
double difference(const Vec<Scalar>& a, const Vec<Scalar>& b) {
  return (a - b).norm() / b.norm();
}

template <class Scalar>
void expect_solves(DirectSolver<Scalar>& solver, const MCK& m, const Mask& active, Scalar cm,
                   Scalar cc, Scalar ck, double growth = 1.0) {
  ASSERT_EQ(solver.factor(m, cm, cc, ck), Status::ok) << solver.name();
  const auto s = dense<Scalar>(m, active, cm, cc, ck);
  const Vec<Scalar> b = Vec<Scalar>::Random(s.rows());
  Vec<Scalar> x = b;
  solver.solve(x);
  // Right-hand sides beside one another: the same bits, wherever a column stands.
  Eigen::Matrix<Scalar, -1, -1> columns = b.replicate(1, 7);
  columns.col(5).setZero();
  solver.solve_columns(columns);
  for (Index j = 0; j < columns.cols(); ++j)
    EXPECT_TRUE(columns.col(j) == (j == 5 ? Vec<Scalar>(0.0 * b) : x)) << solver.name() << " " << j;
  const Vec<Scalar> expected = s.partialPivLu().solve(b);
  const double condition =
      s.cwiseAbs().rowwise().sum().maxCoeff() * s.inverse().cwiseAbs().rowwise().sum().maxCoeff();
  // Both answers carry an error of about eps times the condition number; 30 covers the sums of some
  // tens of terms. Where diagonal blocks do not dominate, the block LU promises no more than its
  // growth (not recorded below 1e3).
  EXPECT_LT(difference(x, expected), 30.0 * 2.2e-16 * condition * growth)
      << solver.name() << " condition " << condition;
  for (Index u = 0; u < s.rows(); ++u) {
    if (!active[static_cast<std::size_t>(u)]) {
      EXPECT_EQ(x(u), b(u));
    }
  }
}

template <class Scalar>
class Direct : public testing::Test {};
using Scalars = testing::Types<double, Complex>;
TYPED_TEST_SUITE(Direct, Scalars);

std::vector<const lu::Kernels*> all_kernels() {
  std::vector<const lu::Kernels*> k{lu::base_kernels()};
  if (lu::kernels().isa != std::string_view("baseline")) {
    if (lu::avx2_kernels()) k.push_back(lu::avx2_kernels());
    if (lu::kernels().isa == std::string_view("avx512")) k.push_back(lu::avx512_kernels());
  }
  return k;
}

}  // namespace

TYPED_TEST(Direct, MatchesDenseOnChainsTreesAndGraphs) {
  using S = TypeParam;
  std::mt19937 rng(7);
  for (int round = 0; round < 40; ++round) {
    const Index n = 1 + round % 13;
    const Pairs pairs = round % 3 == 0   ? chain(n)
                        : round % 3 == 1 ? random_tree(n, rng)
                                         : random_graph(n, n, rng);
    const BlockPattern p(n, pairs);
    // Diagonally heavy, barely so, and not at all.
    const MCK m = random_matrices(p, round % 4 == 0 ? 30.0 : round % 4 == 1 ? 5.0 : 0.0, rng);
    const Mask active = round % 2 ? random_mask(p, 0.3, rng) : all_active(p);
    const S cm = some_scalar(S(), 0.7, -1.3), cc = some_scalar(S(), -0.4, 0.9),
            ck = some_scalar(S(), 1.1, 0.2);
    const double growth = round % 4 == 0 ? 1.0 : 1e3;
    expect_solves<S>(*make_direct_solver<S>(p, active, SolverKind::automatic), m, active, cm, cc,
                     ck, growth);
    expect_solves<S>(*make_direct_solver<S>(p, active, SolverKind::klu), m, active, cm, cc, ck);
    if (round % 4 != 0) continue;
    for (const auto* k : all_kernels())
      for (const auto o : {lu::Ordering::natural, lu::Ordering::two_ended, lu::Ordering::amd}) {
        BlockLu<S> solver(p, active, o, k);
        expect_solves<S>(solver, m, active, cm, cc, ck);
        EXPECT_LT(solver.growth(), 1e4);
      }
  }
}

/// Products of blocks in a factorisation.
std::size_t products(const BlockPattern& p, lu::Ordering o) {
  const lu::Symbolic symbolic(p, all_active(p), o);
  const auto entries = static_cast<std::size_t>(symbolic.entries());
  return 2 * entries + 2 * static_cast<std::size_t>(symbolic.plan().update_start[entries]);
}

TEST(Orders, ALongChainBetweenClustersCostsWhatAChainCosts) {
  // a rotor of 101 nodes in two magnetic bearings: each has sensors six nodes away, and for each of
  // its two axes a controller of six signals, all coupled
  Pairs pairs = chain(101);
  Index next = 101;
  for (const auto& [magnet, sensor] : {std::pair<Index, Index>{14, 8}, {86, 92}})
    for (int axis = 0; axis < 2; ++axis) {
      for (Index i = next; i < next + 6; ++i)
        for (Index j = next; j < i; ++j)
          pairs.emplace_back(i, j);
      pairs.emplace_back(sensor, next);
      pairs.emplace_back(magnet, next + 5);
      next += 6;
    }
  const BlockPattern p(next, pairs);
  EXPECT_LT(products(p, lu::Ordering::best), 0.65 * products(p, lu::Ordering::amd));
  std::mt19937 rng(5);
  BlockLu<Complex> solver(p, all_active(p));
  expect_solves<Complex>(solver, random_matrices(p, 30.0, rng), all_active(p), Complex(0.7, -1.3),
                         Complex(-0.4, 0.9), Complex(1.1, 0.2));
}

TEST(Orders, TheBestIsNeverDearerThanMinimumDegree) {
  std::mt19937 rng(17);
  for (int round = 0; round < 200; ++round) {
    const Index n = 1 + round % 40;
    const BlockPattern p(n, round % 2 ? random_tree(n, rng) : random_graph(n, n + round % 7, rng));
    const std::vector<int> order = lu::make_order(p, lu::Ordering::best);
    EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), static_cast<std::size_t>(n));
    EXPECT_LE(products(p, lu::Ordering::best), products(p, lu::Ordering::amd)) << round;
  }
}

TYPED_TEST(Direct, LeavesOutAbsentTerms) {
  using S = TypeParam;
  std::mt19937 rng(8);
  const BlockPattern p(6, chain(6));
  MCK m = random_matrices(p, 0.0, rng);
  for (BlockMatrix<6>* a : {&m.M, &m.C, &m.K})
    for (Index i = 0; i < 6; ++i)
      a->block(p.diagonal(i)) += 20.0 * Matrix<6>::Identity();
  const Mask active = all_active(p);
  for (const auto kind : {SolverKind::block, SolverKind::klu}) {
    const auto solver = make_direct_solver<S>(p, active, kind);
    for (int which = 1; which < 8; ++which)
      expect_solves<S>(*solver, m, active, S(which & 1 ? 1.5 : 0.0), S(which & 2 ? 0.5 : 0.0),
                       S(which & 4 ? 2.0 : 0.0));
  }
}

TYPED_TEST(Direct, HeldUnknownsHideWhateverStandsThere) {
  using S = TypeParam;
  std::mt19937 rng(9);
  const BlockPattern p(4, chain(4));
  MCK m = random_matrices(p, 20.0, rng);
  Mask active = all_active(p);
  for (int c = 0; c < 6; ++c)
    active[static_cast<std::size_t>(6 + c)] = 0;  // node 1 held altogether
  for (int c = 1; c < 6; ++c)
    active[static_cast<std::size_t>(18 + c)] = 0;  // node 3: one unknown left
  const MCK clean = m;
  m.K.block(p.diagonal(1)).setConstant(whirl::nan);
  m.K.block(p.slot(1, 2)).setConstant(infinity);
  for (const auto kind : {SolverKind::block, SolverKind::klu}) {
    const auto a = make_direct_solver<S>(p, active, kind),
               b = make_direct_solver<S>(p, active, kind);
    ASSERT_EQ(a->factor(m, S(0.1), S(0.2), S(1.0)), Status::ok);
    ASSERT_EQ(b->factor(clean, S(0.1), S(0.2), S(1.0)), Status::ok);
    Vec<S> x = Vec<S>::Random(24), y = x;
    a->solve(x);
    b->solve(y);
    EXPECT_EQ(x, y);
  }
  const Mask none(24, 0);
  for (const auto kind : {SolverKind::block, SolverKind::klu}) {
    const auto solver = make_direct_solver<S>(p, none, kind);
    ASSERT_EQ(solver->factor(m, S(0.1), S(0.2), S(1.0)), Status::ok);
    const Vec<S> b = Vec<S>::Random(24);
    Vec<S> x = b;
    solver->solve(x);
    EXPECT_EQ(x, b);
  }
}

TYPED_TEST(Direct, PivotsInsideABlock) {
  using S = TypeParam;
  // Diagonal blocks with zero diagonals: a permutation. Only exchanges inside the block can handle
  // them.
  const BlockPattern p(3, chain(3));
  MCK m(p);
  for (Index i = 0; i < 3; ++i)
    for (int c = 0; c < 6; ++c)
      m.K.block(p.diagonal(i))((c + 1 + i) % 6, c) = 1.0 + c;
  m.K.block(p.slot(0, 1)).setConstant(0.1);
  m.K.block(p.slot(2, 1)).setConstant(-0.2);
  const Mask active = all_active(p);
  BlockLu<S> solver(p, active);
  expect_solves<S>(solver, m, active, S(0.0), S(0.0), S(1.0));
  EXPECT_EQ(solver.repivoted_blocks(), 3);
}

TYPED_TEST(Direct, UnitsDoNotMatter) {
  using S = TypeParam;
  // The same matrix with unknowns and equations in units that differ by up to 1e12, and all of it
  // times 1e-12.
  std::mt19937 rng(11);
  const BlockPattern p(8, chain(8));
  const MCK m = random_matrices(p, 4.0, rng);
  const Mask active = all_active(p);
  Vector<6> unit;
  unit << 1e6, 1e6, 1e6, 1e-6, 1e-6, 1.0;
  MCK scaled(p);
  for (Index k = 0; k < p.blocks(); ++k)
    scaled.K.block(k) = 1e-12 * unit.asDiagonal() * m.K.block(k) * unit.asDiagonal();
  for (const auto kind : {SolverKind::block, SolverKind::klu}) {
    const auto a = make_direct_solver<S>(p, active, kind),
               b = make_direct_solver<S>(p, active, kind);
    ASSERT_EQ(a->factor(m, S(0.0), S(0.0), S(1.0)), Status::ok);
    ASSERT_EQ(b->factor(scaled, S(0.0), S(0.0), S(1.0)), Status::ok);
    Vec<S> x = Vec<S>::Random(48), y = x;
    for (Index i = 0; i < 8; ++i)
      y.template segment<6>(6 * i) =
          (1e-12 * unit.asDiagonal() * y.template segment<6>(6 * i)).eval();
    a->solve(x);
    b->solve(y);
    for (Index i = 0; i < 8; ++i)
      y.template segment<6>(6 * i) = (unit.asDiagonal() * y.template segment<6>(6 * i)).eval();
    EXPECT_LT(difference(y, x), 1e-12);  // condition number below 100
  }
}

TYPED_TEST(Direct, AutomaticFallsBackWhenAPivotMustComeFromAnotherNode) {
  using S = TypeParam;
  // Node 0 has no stiffness of its own but is tied to node 1: the first diagonal block is zero, the
  // matrix regular.
  const BlockPattern p(2, chain(2));
  MCK m(p);
  m.K.block(p.slot(0, 1)).setIdentity();
  m.K.block(p.slot(1, 0)).setIdentity();
  m.K.block(p.diagonal(1)).setIdentity();
  const Mask active = all_active(p);
  EXPECT_EQ(BlockLu<S>(p, active, lu::Ordering::natural).factor(m, S(0.0), S(0.0), S(1.0)),
            Status::singular);
  const auto solver = make_direct_solver<S>(p, active);
  expect_solves<S>(*solver, m, active, S(0.0), S(0.0), S(1.0));
  EXPECT_EQ(solver->name(), "klu");
  // Nearly zero: the block LU goes through, with growth, and the automatic solver does not accept
  // it.
  for (int c = 0; c < 6; ++c)
    m.K.block(p.diagonal(0))(c, c) = 1e-9;
  BlockLu<S> block(p, active, lu::Ordering::natural);
  ASSERT_EQ(block.factor(m, S(0.0), S(0.0), S(1.0)), Status::ok);
  EXPECT_GT(block.growth(), 1e8);
  expect_solves<S>(*solver, m, active, S(0.0), S(0.0), S(1.0));
  EXPECT_EQ(solver->name(), "klu");
  // And back to the block solver when it serves again.
  for (int c = 0; c < 6; ++c)
    m.K.block(p.diagonal(0))(c, c) = 3.0;
  expect_solves<S>(*solver, m, active, S(0.0), S(0.0), S(1.0));
  EXPECT_EQ(solver->name(), "block");
}

TYPED_TEST(Direct, FindsTheUnknownNothingResists) {
  using S = TypeParam;
  // A rod chain fixed in everything but the axial direction (component 0), which is free: singular
  // there.
  for (const Index n : {1, 2, 3, 10, 400}) {
    const BlockPattern p(n, chain(n));
    MCK m(p);
    for (Index i = 0; i < n; ++i)
      m.K.block(p.diagonal(i)).diagonal().tail<5>().setConstant(2.5);
    for (Index i = 0; i + 1 < n; ++i) {
      const double k = 1e9 / (1.0 + static_cast<double>(i % 3));
      m.K.block(p.diagonal(i))(0, 0) += k;
      m.K.block(p.diagonal(i + 1))(0, 0) += k;
      m.K.block(p.slot(i, i + 1))(0, 0) = m.K.block(p.slot(i + 1, i))(0, 0) = -k;
    }
    Mask active = all_active(p);
    for (const auto kind : {SolverKind::block, SolverKind::klu, SolverKind::automatic}) {
      const auto solver = make_direct_solver<S>(p, active, kind);
      ASSERT_EQ(solver->factor(m, S(0.0), S(0.0), S(1.0)), Status::singular)
          << n << " " << solver->name();
      EXPECT_EQ(solver->singular_unknown() % 6, 0) << n << " " << solver->name();
      EXPECT_GE(solver->singular_unknown(), 0);
    }
    // A support a million million times softer than the rods is enough.
    m.K.block(p.diagonal(0))(0, 0) += 1e-3;
    for (const auto kind : {SolverKind::block, SolverKind::klu, SolverKind::automatic})
      EXPECT_EQ(make_direct_solver<S>(p, active, kind)->factor(m, S(0.0), S(0.0), S(1.0)),
                Status::ok)
          << n;
  }
}

TYPED_TEST(Direct, ReportsWhatIsNotFinite) {
  using S = TypeParam;
  std::mt19937 rng(3);
  const BlockPattern p(5, chain(5));
  for (const double poison : {whirl::nan, infinity}) {
    MCK m = random_matrices(p, 20.0, rng);
    m.K.block(p.diagonal(3))(2, 2) = poison;
    const Mask active = all_active(p);
    for (const auto kind : {SolverKind::block, SolverKind::klu, SolverKind::automatic})
      EXPECT_EQ(make_direct_solver<S>(p, active, kind)->factor(m, S(0.0), S(0.0), S(1.0)),
                Status::singular);
  }
  const MCK zero(p);
  for (const auto kind : {SolverKind::block, SolverKind::klu, SolverKind::automatic}) {
    const auto solver = make_direct_solver<S>(p, all_active(p), kind);
    EXPECT_EQ(solver->factor(zero, S(1.0), S(1.0), S(1.0)), Status::singular);
    EXPECT_EQ(solver->factor(zero, S(0.0), S(0.0), S(0.0)), Status::singular);
  }
}

TYPED_TEST(Direct, GyroscopicAndIndefiniteChainsKeepTheirAccuracy) {
  using S = TypeParam;
  // Weak stiffness, strong skew coupling in the diagonal blocks, shifted into the spectrum: pivots
  // inside blocks matter.
  std::mt19937 rng(21);
  const BlockPattern p(60, chain(60));
  MCK m = random_matrices(p, 0.0, rng);
  for (Index i = 0; i < 60; ++i) {
    Matrix<6> g = 1e6 * Matrix<6>::Random();
    m.K.block(p.diagonal(i)) = 1e-3 * m.K.block(p.diagonal(i)) + (g - g.transpose());
  }
  const Mask active = all_active(p);
  for (const auto kind : {SolverKind::block, SolverKind::klu, SolverKind::automatic}) {
    const auto solver = make_direct_solver<S>(p, active, kind);
    expect_solves<S>(*solver, m, active, S(-0.3), S(0.5), S(1.0));
  }
}

TYPED_TEST(Direct, RefactorsWithoutRememberingTheLastMatrix) {
  using S = TypeParam;
  std::mt19937 rng(5);
  const BlockPattern p(9, random_graph(9, 6, rng));
  const Mask active = random_mask(p, 0.2, rng);
  for (const auto kind : {SolverKind::block, SolverKind::klu, SolverKind::automatic}) {
    const auto solver = make_direct_solver<S>(p, active, kind);
    for (int round = 0; round < 12; ++round) {
      // The shift changes sign and size, so that pivots KLU chose before no longer serve.
      const MCK m = random_matrices(p, round % 3 == 0 ? 1e4 : round % 3 == 1 ? 0.0 : -10.0, rng);
      expect_solves<S>(
          *solver, m, active, some_scalar(S(), 1.0, 0.5), some_scalar(S(), 0.1, -0.5), S(1.0),
          kind == SolverKind::klu || round % 3 == 0 ? 1.0 : 1e3 * std::max(1.0, solver->growth()));
    }
  }
}

TEST(BlockLu, DeterminantAndInertiaMatchDense) {
  std::mt19937 rng(13);
  for (int round = 0; round < 10; ++round) {
    const Index n = 1 + round;
    const BlockPattern p(n, round % 2 ? chain(n) : random_graph(n, 3, rng));
    MCK m = random_matrices(p, 0.0, rng);
    // symmetric K, skew C: K + i s C is Hermitian
    for (Index i = 0; i < n; ++i)
      for (Index k = p.row_start()[static_cast<std::size_t>(i)];
           k < p.row_start()[static_cast<std::size_t>(i) + 1]; ++k) {
        const Index j = p.cols()[static_cast<std::size_t>(k)];
        if (j < i) continue;
        const Index t = p.slot(j, i);
        if (i == j) {
          m.K.block(k) = (m.K.block(k) + m.K.block(k).transpose()).eval();
          m.C.block(k) = (m.C.block(k) - m.C.block(k).transpose()).eval();
        } else {
          m.K.block(t) = m.K.block(k).transpose();
          m.C.block(t) = -m.C.block(k).transpose();
        }
      }
    const Mask active = random_mask(p, 0.2, rng);
    BlockLu<Complex> z(p, active);
    ASSERT_EQ(z.factor(m, 0.0, Complex(0.0, 0.7), 1.0), Status::ok);
    const MatXc s = dense<Complex>(m, active, 0.0, Complex(0.0, 0.7), 1.0);
    const Complex det = s.determinant();
    const auto [size, phase] = z.determinant();
    EXPECT_NEAR(size, std::log10(std::abs(det)), 1e-9 * (1.0 + std::abs(size)));
    EXPECT_LT(std::abs(phase - det / std::abs(det)), 1e-9);
    const Eigen::SelfAdjointEigenSolver<MatXc> eig(s, Eigen::EigenvaluesOnly);
    EXPECT_EQ(z.negative_eigenvalues(), (eig.eigenvalues().array() < 0.0).count());
    BlockLu<double> r(p, active);
    ASSERT_EQ(r.factor(m, 0.0, 0.0, 1.0), Status::ok);
    const Eigen::SelfAdjointEigenSolver<MatX> eigr(dense<double>(m, active, 0.0, 0.0, 1.0),
                                                   Eigen::EigenvaluesOnly);
    EXPECT_EQ(r.negative_eigenvalues(), (eigr.eigenvalues().array() < 0.0).count());
  }
}
