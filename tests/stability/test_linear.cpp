// Scenes with constant coefficients, and the linear limit of the general rotor.
#include "scene.hpp"
#include <analysis/transient/linear_motion.hpp>
#include <analysis/study/scheme_stability.hpp>
#include <core/error.hpp>
#include <core/law.hpp>
#include <elements/loads/unbalance.hpp>
#include <fmt/format.h>
#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

constexpr double speed = 300.0;  // rad/s

/// A shaft on two unequal springs with a disk beside its middle, an unbalance, and weight; a motor
/// holds the speed.
system::System rotor(double unbalance, bool driven = true,
                     const LawPtr& of_speed = make_constant(speed)) {
  system::Builder b;
  b.add_line("shaft");
  add_shaft(b, round_bar(0.03), std::vector<double>(6, 0.15));
  add_spring(b, 0, Vec3(1e8, 2e7, 1e7).asDiagonal(), isotropic(500.0));
  add_spring(b, 6, Vec3(0, 1e7, 2e7).asDiagonal(), isotropic(500.0));
  b.add(elements::RigidDisk{20.0, 0.15, 0.28, 0.0}, {2}, "rigid disks");
  b.add(elements::UnbalanceMass(unbalance, 0.3), {2}, "unbalances");
  b.set_gravity(Vec3(0, 0, -9.81));
  if (driven) b.hold(0, system::spin_phi, make_angle_of_speed(of_speed, 0.0));
  return b.finalize();
}

system::State settled(const system::System& s) {
  analysis::SteadySystem running(s);
  return analysis::EquilibriumSolver(running).solve(speed).state;
}

/// Largest lateral deflection of the disk from its start, sampled at step ends, and the end itself.
struct Track final : analysis::Observer {
  Vec2 first = Vec2::Zero();
  double largest = 0;
  void begin(const analysis::Snapshot& s) override { first = s.node(2).u.tail<2>(); }
  void step(analysis::StepAccess& s) override {
    largest = std::max(largest, (s.end().node(2).u.tail<2>() - first).norm());
  }
};

}  // namespace

// The unbalance appears at once on the turning rotor in static equilibrium. What the linear
// equations leave out is the square of the motion: 1e-6 of the response at tilts of 1e-6, and the
// nonlinear run is that much closer as the unbalance falls.
TEST(Linear, LimitOfTheGeneralRotor) {
  double before = infinity;
  for (double unbalance : {1e-3, 1e-5, 1e-7}) {  // kg m: 50 um, 0.5 um, 5 nm of the disk
    const system::System s = rotor(unbalance);
    const system::State start = settled(s);
    analysis::TransientOptions o;
    o.integrator.tolerance = 1e-9;
    o.integrator.t_end = 0.3;
    system::SystemProblem general(s);
    analysis::LinearMotion small(s, {}, speed, start);
    Track a, b;
    const analysis::TransientResult x = run_transient(general, start, o, {&a}),
                                    y = run_transient(small, start, o, {&b});
    ASSERT_EQ(x.reason, analysis::StopReason::end_time) << x.detail;
    ASSERT_EQ(y.reason, analysis::StopReason::end_time) << y.detail;
    const double difference = (x.end.q - y.end.q).segment<3>(6 * 2).norm() / a.largest;
    EXPECT_LT(difference, std::max(0.02 * before, 1e-6)) << unbalance;
    if (unbalance < 1e-6) {
      EXPECT_LT(difference, 1e-6);
    }
    before = difference;
    // one linearisation in all; a factorisation for each length of step
    EXPECT_EQ(y.statistics.newton_iterations, y.statistics.accepted + y.statistics.rejected_error);
    EXPECT_GT(x.statistics.newton_iterations, y.statistics.newton_iterations);
  }
}

namespace {

/// The steady motion at t, as the rotor of settled() has it.
system::State steady(const system::System& s, system::State x, double t) {
  for (Index i = 0; i < s.nodes(); ++i) {
    if (x.v[6 * i + system::spin_phi] == 0.0) continue;
    x.q[6 * i + system::spin_phi] += speed * t;
  }
  return x;
}

}  // namespace

// Along the steady motion the linear equations are the general ones, whatever turns in them; the
// forces of what turns are a series there. Residuals of several instants of a free motion, taken
// together, are those taken one by one.
TEST(Linear, ResidualsAlongAFreeMotion) {
  for (const bool driven : {true, false}) {
    const system::System s = rotor(1e-4, driven);
    const system::State start = settled(s);
    system::SystemProblem general(s);
    analysis::LinearMotion small(s, {}, speed, start);
    VecX r(s.size()), expected(s.size());
    const VecX still = VecX::Zero(s.size());
    for (const double t : {0.0, 1e-3, 0.0117, 0.5, 3.7}) {
      const system::State x = steady(s, start, t);
      ASSERT_TRUE(small.residual(t, x.q, x.v, still, r));
      ASSERT_TRUE(general.residual(t, x.q, x.v, still, expected));
      // torques of the weight on the unbalance swing a free spin; all are of some N and N m
      EXPECT_LT((r - expected).cwiseAbs().maxCoeff(), 1e-8) << t;
      EXPECT_GT(r.cwiseAbs().maxCoeff(), 1.0) << t;
    }
    system::State x = steady(s, start, 0.02);
    for (Index k = 0; k < s.size(); ++k) {
      if (!s.active()[at(k)]) continue;
      x.q[k] += 1e-6 * std::sin(1.0 + static_cast<double>(k));
      x.v[k] += 1e-3 * std::cos(2.0 + static_cast<double>(k));
    }
    const double span[] = {1e-5, 3e-4, 1e-3}, time[] = {0.02001, 0.0203, 0.021};
    MatX together(s.size(), 3);
    ASSERT_TRUE(small.residuals_along({0.02, x.q, x.v, span, time}, together));
    for (Index k = 0; k < 3; ++k) {
      VecX q = x.q + span[k] * x.v, v = x.v, a = still;
      small.impose(time[k], q, v, a);
      ASSERT_TRUE(small.residual(time[k], q, v, a, r));
      EXPECT_LT((together.col(k) - r).cwiseAbs().maxCoeff(), 1e-9 * r.cwiseAbs().maxCoeff()) << k;
    }
  }
  // and the bound of the state tells the residual along that motion and beside it
  for (const bool driven : {true, false}) {
    const system::System s = rotor(1e-4, driven);
    const system::State start = settled(s);
    analysis::LinearMotion small(s, {}, speed, start);
    system::State x = steady(s, start, 0.02);
    VecX beside = VecX::Zero(s.size()), rates = beside, accelerations = beside;
    for (Index k = 0; k < s.size(); ++k) {
      if (!s.active()[at(k)]) continue;
      const double phase = static_cast<double>(k);
      x.q[k] += 1e-6 * std::sin(1.0 + phase);
      x.v[k] += 1e-3 * std::cos(2.0 + phase);
      beside[k] = 1e-6 * std::sin(3.0 + phase);
      rates[k] = 1e-3 * std::sin(4.0 + phase);
      accelerations[k] = std::sin(5.0 + phase);
    }
    const double span[] = {7e-4}, time[] = {0.0207};
    ASSERT_TRUE(small.bound_along({0.02, x.q, x.v, span, time}));
    time::Bound bound;
    time::StepProducts products;
    bound.resize(s.size());
    products.resize(s.size());
    small.multiply(0.02, x.q, x.v, bound, products);
    VecX told = bound.force + span[0] * bound.rate;
    small.add_K(1.0, beside, told);
    small.add_C(1.0, rates, told);
    small.add_M(1.0, accelerations, told);
    const auto entries = small.changing_entries();
    ASSERT_TRUE(entries.has_value());
    VecX changing(static_cast<Index>(entries->size())), r(s.size());
    small.changing(time[0], changing);
    for (std::size_t e = 0; e < entries->size(); ++e)
      told[(*entries)[e]] += changing[static_cast<Index>(e)];
    VecX q = x.q + span[0] * x.v + beside, v = x.v + rates, a = accelerations;
    small.impose(time[0], q, v, a);
    ASSERT_TRUE(small.residual(time[0], q, v, a, r));
    EXPECT_LT((told - r).cwiseAbs().maxCoeff(), 1e-9 * r.cwiseAbs().maxCoeff()) << driven;
  }
  // what is held by a law that accelerates is asked about one by one
  const system::System s = rotor(1e-4, true, make_table({0.0, 1.0}, {speed, 2.0 * speed}));
  const system::State start = settled(s);
  analysis::LinearMotion small(s, {}, speed, start);
  const double span[] = {1e-3}, time[] = {1e-3};
  MatX together(s.size(), 1);
  EXPECT_FALSE(small.residuals_along({0.0, start.q, start.v, span, time}, together));
  EXPECT_FALSE(small.bound_along({0.0, start.q, start.v, span, time}));
}

// Equal steps: one factorisation serves the whole run, and angles come back with their whole turns.
TEST(Linear, EqualStepsUseOneFactorisation) {
  const system::System s = rotor(1e-5, false);
  const system::State start = settled(s);
  for (const char* method : {"radau5", "gauss4", "gauss6", "generalized_alpha"}) {
    analysis::LinearMotion problem(s, {}, speed, start);
    analysis::TransientOptions o;
    o.method = method;
    o.integrator.t_end = 1.0;
    o.integrator.dt_fixed = 1e-3;
    const analysis::TransientResult r = run_transient(problem, start, o, {});
    ASSERT_EQ(r.reason, analysis::StopReason::end_time) << method << ": " << r.detail;
    EXPECT_EQ(r.statistics.accepted, 1000) << method;
    EXPECT_LE(r.statistics.factorizations_real, 2)
        << method;  // one more finds the initial acceleration
    EXPECT_LE(r.statistics.factorizations_complex, 1) << method;
    EXPECT_NEAR(r.end.total_phi(2, 0), speed, 1e-6 * speed)
        << method;  // the unbalance under gravity swings the free spin
    EXPECT_GT(r.end.frames.turns[0], 40.0) << method;
  }
}

// Masses on springs are linear by themselves; a disk that may tilt, or a stop, is not.
TEST(Linear, FoundFromWhatTheSceneContains) {
  EXPECT_TRUE(mass_on_spring(1.0, 1e4, 1.0, 9.81).linear());
  EXPECT_FALSE(rotor(1e-5).linear());
  // an upright disk with unbalance whose angle follows a law, however fast it accelerates
  system::Builder b;
  b.add_line("shaft");
  const Index n = b.add_node({Vec3::Zero(), 0, "disk", false});
  b.add(elements::RigidDisk{10.0, 0.05, 0.05, 0.0}, {n}, "rigid disks");
  b.add(elements::UnbalanceMass(1e-3, 0.0), {n}, "unbalances");
  add_spring(b, n, isotropic(1e5), isotropic(20.0));
  b.hold(n, 0);
  b.hold(n, 4);
  b.hold(n, 5);
  b.hold(n, system::spin_phi, make_polynomial({0.0, 0.0, 10.0}));
  const system::System s = b.finalize();
  EXPECT_TRUE(s.linear());
  analysis::TransientOptions o;
  o.integrator.tolerance = 1e-7;
  o.integrator.t_end =
      5.4238694;  // F. M. Lewis 1932: largest r/e 23.5842911 at 1.084738806 omega_n
  system::SystemProblem problem(s);
  analysis::PeakTracker peaks({{"disk", {n, 0.0}}}, n);
  const analysis::TransientResult r = run_transient(problem, s.make_state(), o, {&peaks});
  ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
  EXPECT_NEAR(peaks.peaks().front().amplitude / 1e-4, 23.5842911, 1e-5 * 23.58);
  EXPECT_EQ(r.statistics.newton_iterations, r.statistics.accepted + r.statistics.rejected_error);
  EXPECT_LT(r.statistics.factorizations_complex, r.statistics.accepted / 10);
}

// A shaft that is stiffer one way turns its matrices: said, not averaged away.
TEST(Linear, TurningMatricesAreRefused) {
  system::Builder b;
  b.add_line("shaft");
  const Index n = b.add_node({Vec3::Zero(), 0, "body", false});
  b.add(elements::RigidBody(5.0, Vec3::Zero(), Vec3(0.02, 0.01, 0.03).asDiagonal()), {n},
        "rigid bodies");
  Matrix<6> K = Matrix<6>::Identity() * 1e4, none = Matrix<6>::Zero();
  K(3, 3) = 0.0;
  b.add(elements::LinearBearing(K, none, none, Vector<6>::Zero(), Vector<6>::Zero()),
        {n, b.add_ground(Vec3::Zero(), "ground")}, "springs");
  const system::System s = b.finalize();
  try {
    analysis::LinearMotion problem(s, {}, speed, settled(s));
    FAIL() << "taken as constant";
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().front().code, "E39");
  }
}

// The map of a step against the integrator that makes it: on the conservative rotor Gauss keeps
// every energy over 1e5 steps, Radau and generalized-alpha lose what their spectral radius says,
// and no scheme gains at any step.
TEST(Schemes, EnergyOverAHundredThousandSteps) {
  const system::System s = rotor(0.0);
  analysis::Linearizer linear(s);
  const analysis::ReducedRotor r = analysis::reduce_rotor(linear, speed, 6).conservative();
  double fast = 0;
  for (const Complex& l : r.lambda) {
    EXPECT_NEAR(l.real(), 0.0, 1e-9 * std::abs(l));
    fast = std::max(fast, l.imag());
  }
  const double h = two_pi / fast / 20.0;
  for (const char* method : {"radau5", "gauss4", "gauss6", "generalized_alpha"}) {
    const double ratio = analysis::energy_ratio(r, method, h, 100000, 0.9);
    if (std::string(method).starts_with("gauss")) {
      EXPECT_NEAR(ratio, 1.0, 1e-8) << method;  // rounding of 1e5 steps
    } else {
      EXPECT_LT(ratio, 1.0) << method;
      EXPECT_GT(ratio, 0.0) << method;
    }
    for (double x = 1e-3; x < 1e5; x *= 3.0)
      EXPECT_LE(analysis::spectral_radius(r, method, x / fast, 0.9), 1.0 + 1e-6)
          << method << " " << x;
    // short runs: the loss of energy is that of the modes, each by its own root
    const double once = analysis::energy_ratio(r, method, h, 2000, 0.9),
                 twice = analysis::energy_ratio(r, method, h, 4000, 0.9);
    EXPECT_LE(twice, once * (1.0 + 1e-10)) << method;
  }
  EXPECT_NEAR(analysis::spectral_radius(r, "generalized_alpha", 1e6 / fast, 0.9), 0.9, 1e-2);
  EXPECT_LT(analysis::spectral_radius(r, "radau5", 1e9 / fast, 0.9), 1e-3);
}
