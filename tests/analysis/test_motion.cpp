// Kinds of motion: condensation against dense algebra, free motions, senses of the spin.
#include <la/dense.hpp>
#include "rotors.hpp"

#include <analysis/spectra/whirl_modes.hpp>

#include <Eigen/QR>
#include <gtest/gtest.h>

#include <algorithm>

using namespace whirl;
using namespace whirl::analysis;
using namespace whirl::tests;

namespace {

MatX dense(const la::BlockMatrix<6>& a, const std::vector<Index>& rows,
           const std::vector<Index>& cols) {
  const Index n = 6 * a.pattern().size();
  MatX out(static_cast<Index>(rows.size()), static_cast<Index>(cols.size()));
  VecX e(n), y(n);
  for (std::size_t j = 0; j < cols.size(); ++j) {
    e.setZero();
    y.setZero();
    e[cols[j]] = 1.0;
    a.add_multiply(1.0, e, y);
    for (std::size_t i = 0; i < rows.size(); ++i)
      out(static_cast<Index>(i), static_cast<Index>(j)) = y[rows[i]];
  }
  return out;
}

/// 6 m of shaft, 100 mm thick, that sags by 10 mm; kxx: along its axis at the left end.
Rotor sagging(double kxx) {
  Rotor r;
  r.add_shaft(cylinder(0.1, 210e9, 80e9, 7850), 6.0, 10);
  r.add_bearing(0, 1e9, 1e9, 100, 100);
  r.add_bearing(6, 1e9, 1e9, 100, 100);
  if (kxx > 0) {
    elements::TranslationalBearing t;
    t.K(0, 0) = kxx;
    r.b.add(t, {r.at(0), r.b.add_ground(Vec3::Zero(), "ground")}, "bearings");
  }
  r.b.set_gravity(Vec3(0, 0, -9.81));
  return r;
}

}  // namespace

// Matrices without inertia along and about the axis are the dense static condensation, and a free
// shaft is restrained without force: the pseudo-inverse, which knows no restraint, gives the same.
TEST(MotionReduction, IsStaticCondensation) {
  for (const double kxx : {0.0, 1e9, 1e4}) {
    Rotor r = sagging(kxx > 0 ? kxx : 1e6);  // an equilibrium wants a support
    const system::System s = r.b.finalize();
    Linearizer linear(s);
    la::MCK m = linear.at(30.0);
    const Index first = 6 * r.at(0) + system::ux;
    if (kxx == 0)
      m.K.block(m.K.pattern().diagonal(first / 6))(0, 0) -= 1e6;  // the spring taken away again
    MotionReduction motion(s, Motion::lateral, {});
    const la::MCK& reduced = motion.reduce(m);
    EXPECT_EQ(motion.restraints().size(), kxx == 0 ? 2u : 1u);  // spin, and the axis
    std::vector<Index> l, f;
    for (Index k = 0; k < s.size(); ++k)
      if (s.active()[static_cast<std::size_t>(k)])
        (kind_of_unknown(s, k) == Motion::lateral ? l : f).push_back(k);
    const MatX Kff = dense(m.K, f, f), Kfl = dense(m.K, f, l), Klf = dense(m.K, l, f);
    Eigen::CompleteOrthogonalDecomposition<MatX> all;
    all.setThreshold(1e-12);
    all.compute(Kff);
    const MatX expected = dense(m.K, l, l) - Klf * all.solve(Kfl);
    const MatX found =
        dense(reduced.K, l, l) -
        dense(reduced.K, l, f) *
            la::DenseLu<double>(dense(reduced.K, f, f)).solve(dense(reduced.K, f, l));
    // sag stiffens by EA (sag/length)^2: the condensation takes away what holding adds; both leave
    // rounding of 1e9 N/m
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(),
              1e-9 * dense(m.K, l, l).cwiseAbs().maxCoeff())
        << kxx;
    EXPECT_TRUE(dense(reduced.M, f, l).isZero(0.0));
    EXPECT_TRUE(dense(reduced.M, f, f).isZero(0.0));
    EXPECT_TRUE(dense(reduced.C, f, f).isZero(0.0));
    EXPECT_EQ(dense(reduced.M, l, l), dense(m.M, l, l));
    EXPECT_EQ(dense(reduced.C, l, l), dense(m.C, l, l));
  }
}

// Of two stiffnesses what follows takes the one, what moves by itself the other.
TEST(MotionReduction, WhatFollowsHasAStiffnessOfItsOwn) {
  Rotor r = sagging(1e6);
  const system::System s = r.b.finalize();
  Linearizer linear(s);
  const la::MCK m = linear.at(30.0);
  la::MCK other = m;
  for (std::ptrdiff_t k = 0; k < static_cast<std::ptrdiff_t>(other.K.value_count()); ++k)
    other.K.data()[k] *= 1.25;
  MotionReduction motion(s, Motion::lateral, {});
  const la::MCK& reduced = motion.reduce(m, other.K);
  std::vector<Index> l, f;
  for (Index k = 0; k < s.size(); ++k)
    if (s.active()[static_cast<std::size_t>(k)])
      (kind_of_unknown(s, k) == Motion::lateral ? l : f).push_back(k);
  EXPECT_EQ(dense(reduced.K, l, l), dense(m.K, l, l));
  EXPECT_EQ(dense(reduced.K, l, f), dense(other.K, l, f));
  EXPECT_EQ(dense(reduced.K, f, l), dense(other.K, f, l));
}

// A restraint goes when the motion is held at another speed, and comes back.
TEST(MotionReduction, RestraintsFollowTheStiffness) {
  Rotor r = sagging(1e6);
  const system::System s = r.b.finalize();
  Linearizer linear(s);
  const la::MCK held = linear.at(30.0);
  la::MCK free = held;
  free.K.block(free.K.pattern().diagonal(r.at(0)))(0, 0) -= 1e6;
  MotionReduction motion(s, Motion::lateral, {});
  for (int round = 0; round < 3; ++round) {
    motion.reduce(held);
    EXPECT_EQ(motion.restraints().size(), 1u);
    motion.reduce(free);
    EXPECT_EQ(motion.restraints().size(), 2u);
  }
}

TEST(MotionReduction, PlanesOfASaggedShaftAreAlike) {
  Rotor r = sagging(1e9);
  const system::System s = r.b.finalize();
  Linearizer linear(s);
  const auto lateral =
      whirl_modes(linear, 0.0, {.count = 4, .motion = Motion::lateral, .damped = false});
  const auto all = whirl_modes(linear, 0.0, {.count = 4, .damped = false});
  ASSERT_EQ(lateral.size(), 4u);
  // alike to the square of sag over length, 3e-6, times small integers; held along the axis they
  // are 6 % apart
  EXPECT_NEAR(lateral[0].frequency, lateral[1].frequency, 3e-4 * lateral[0].frequency);
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(lateral[k].frequency, all[k].frequency, 1e-4 * all[k].frequency);
}

// Whirl is measured against the spin of the shaft concerned; what stands follows the shaft it
// carries.
TEST(SpinSenses, StandingPartsFollowTheShaftTheyCarry) {
  system::Builder b;
  for (const char* name : {"one", "two", "casing", "apart"})
    b.add_line(name);
  const auto node = [&](double x, double y, Index line) {
    const Index i = b.add_node({Vec3(x, y, 0), line, "node"});
    b.add(elements::RigidDisk{1.0, 0.01, 0.02, 0}, {i}, "disks");
    return i;
  };
  const auto spring = [&](Index i, Index j) {
    elements::TranslationalBearing t;
    t.K = 1e6 * Mat3::Identity();
    b.add(t, {i, j}, "bearings");
  };
  const Index one = node(0, 0, 0), two = node(2, 0, 1);
  const Index left = node(0, 0.1, 2), middle = node(0.9, 0.1, 2), right = node(2, 0.1, 2),
              apart = node(5, 0, 3);
  spring(one, left);
  spring(two, right);
  spring(left, middle);
  spring(middle, right);
  for (const Index i : {left, right, apart})
    spring(i, b.add_ground(Vec3::Zero(), "ground"));
  const system::System s = b.finalize();
  const auto senses = [&](std::vector<double> ratio) {
    const std::vector<double> all = spin_senses(s, ratio);
    std::vector<double> out;
    for (const Index i : {one, two, left, middle, right, apart})
      out.push_back(all[static_cast<std::size_t>(i)]);
    return out;
  };
  using Senses = std::vector<double>;
  EXPECT_EQ(senses({1.0, 1.5}), (Senses{1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(senses({-1.0, -1.5}), (Senses{-1, -1, -1, -1, -1, -1}));
  EXPECT_EQ(
      senses({1.0, -1.5}),
      (Senses{1, -1, 1, 1, -1, 1}));  // the middle is nearer to the left; apart: the first shaft
  EXPECT_EQ(senses({-1.0, 1.5}), (Senses{-1, 1, -1, -1, 1, -1}));
  EXPECT_EQ(senses({}), (Senses{1, 1, 1, 1, 1, 1}));
  SteadyRotation running;
  running.ratio = {-1.0, -1.0};
  Linearizer linear(s, running);
  linear.at(0.0);
  EXPECT_EQ(linear.sense(one), -1.0);  // at rest: of a positive speed
  linear.at(-10.0);
  EXPECT_EQ(linear.sense(left), 1.0);
}
