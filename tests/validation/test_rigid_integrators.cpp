// Rigid bodies through the program's own time integrators: heavy top, tumbling bodies through pi, a
// fast spin.
#include "../core/extrapolation.hpp"
#include "../core/reference.hpp"
#include "../system/explicit_motion.hpp"
#include "../system/rigid_cases.hpp"
#include <elements/supports/spring_block.hpp>
#include <time/integrator.hpp>
#include <functional>

using namespace whirl;
using namespace whirl::test;

namespace {

struct Outcome {
  State end;
  time::Statistics statistics;
  time::StepStatus status = time::StepStatus::ok;
  int chart_changes = 0;
  Index outside = -1;
};

/// From the case's start to t_end; look(state) after every step.
Outcome integrate(
    const RigidCase& c, const char* method, double tolerance, double t_end,
    bool chart_change = true, const std::function<void(const State&)>& look = [](const State&) {}) {
  system::ProblemOptions po;
  po.chart_change = chart_change;
  system::SystemProblem problem(c.system, po);
  problem.frames = c.start.frames;
  time::Options o;
  o.tolerance = tolerance;
  o.t_end = t_end;
  auto integrator = time::make_integrator(method, problem, o);
  integrator->start(0.0, c.start.q, c.start.v);
  Outcome r;
  const auto state = [&] {
    return State{integrator->time(), integrator->q(), integrator->v(), integrator->a(),
                 problem.frames};
  };
  look(state());
  while (integrator->time() < t_end) {
    const Mat3 before = problem.frames.axes(0);
    const time::StepReport step = integrator->advance();
    r.status = step.status;
    r.chart_changes += before != problem.frames.axes(0);
    if (!step.ok()) break;
    look(state());
  }
  r.end = state();
  r.statistics = integrator->statistics();
  r.outside = problem.outside();
  return r;
}

Vec3 body_rate(const RigidCase& c, const State& x) {
  return attitude(c.system, x, 0).transpose() * angular_velocity(c.system, x, 0);
}

RigidCase paper_rotor(double spin) {
  // Sorokin & Zhang 2018, doi 10.18698/2308-6033-2018-10-1815: D = 0.5 m, m = 5 kg, l = 0.75 m, C1
  // = 2000 N/m, C2 = 500 N m
  const double D = 0.5, m = 5, l = 0.75, J = m * D * D / 16;
  system::Builder b;
  const Index line = b.add_line("rotor"), disk = b.add_node({Vec3(l, 0, 0), line, "disk"});
  b.add(elements::RigidDisk{m, J, 2 * J, 0}, {disk}, "disk");
  b.add(elements::SpringBlock{2000, 500, -l, Vec3::UnitX()}, {disk}, "spring block");
  b.set_gravity(Vec3(0, 0, -9.81));
  RigidCase c = finish(b);
  c.start.v[3] = spin;
  return c;
}

}  // namespace

TEST(RigidIntegrators, HeavyTop) {
  const RigidCase c = heavy_top();
  struct Method {
    const char* name;
    double tolerance, error;
  };
  // The tolerance bounds the error of one step; the top turns 48 times, over which the same-sign
  // part of it adds up to at most 3 tolerances (1 m of mass centre as scale). The energy is a
  // quadratic form of the same error, 3e-10 of it.
  for (const Method& m : {Method{"radau5", 1e-9, 3e-9}, Method{"gauss6", 1e-9, 3e-9}}) {
    const Outcome r = integrate(c, m.name, m.tolerance, 2.0);
    ASSERT_EQ(r.status, time::StepStatus::ok);
    EXPECT_LT((attitude(c.system, r.end, 0).col(0) - heavy_top_table[3].centre).norm(), m.error)
        << m.name;
    EXPECT_NEAR(energy(c.system, r.end), heavy_top_energy, 3e-10 * heavy_top_energy) << m.name;
    RecordProperty(m.name, static_cast<int>(r.statistics.accepted));
  }
}

TEST(RigidIntegrators, FreeAsymmetricTopTurnsOver) {
  const RigidCase c = free_top(0.1);
  for (const char* method : {"radau5", "gauss6"}) {
    const Outcome r = integrate(c, method, 1e-10, 10.0);
    ASSERT_EQ(r.status, time::StepStatus::ok);
    // each of two turn-overs magnifies errors by up to 5/0.1 = 50, so 1e-10 of 5 rad/s may come out
    // as 1e-6; it is a tenth of that
    EXPECT_LT((body_rate(c, r.end) - Vec3(-0.298299034103, -4.992095520546, 0.190597581085)).norm(),
              1e-7)
        << method;
    EXPECT_GT(r.chart_changes, 3) << method;
  }
}

TEST(RigidIntegrators, TumblesForAThousandSecondsThroughPi) {
  // J = diag(1, 2, 3), omega0 = (0.5, 5, 0.5): 800 turns, the director through pi again and again.
  // Reference: quaternions in long double. Energy and the angular momentum in space are kept as
  // well as the method integrates.
  const RigidCase c = free_top(0.5);
  const Vec3 K0(0.5, 10, 1.5), J(1, 2, 3);
  using Y = Eigen::Matrix<Real, 4, 1>;
  const auto tensor = [](const Y& q) {
    const RMat3 S = r_skew(RVec3(q.tail<3>()));
    return RMat3(RMat3::Identity() + 2 * (q[0] * S + S * S) / q.squaredNorm());
  };
  const auto rate = [&](Real, const Y& q) {
    const RMat3 R = tensor(q);
    const RVec3 body = R.transpose() * K0.cast<Real>(), w = R * body.cwiseQuotient(J.cast<Real>()),
                u = q.tail<3>();
    Y dq;
    dq << -w.dot(u) / 2, (q[0] * w + w.cross(u)) / 2;
    return dq;
  };
  const Y q = extrapolate(rate, Real(0), Real(1000), Y(Y(1, 0, 0, 0)), 20'000);
  const double E0 = energy(c.system, c.start);
  double largest_tilt = 0;
  const Outcome r = integrate(c, "gauss6", 1e-10, 1000.0, true, [&](const State& x) {
    largest_tilt = std::max(largest_tilt, x.q.tail<2>().norm());
  });
  ASSERT_EQ(r.status, time::StepStatus::ok);
  const Mat3 R = attitude(c.system, r.end, 0);
  const Vec3 K = R * J.cwiseProduct(body_rate(c, r.end));
  // 5000 rad of turning: 1e-5 rad of attitude is 2e-9 of it
  EXPECT_LT((R - tensor(q).cast<double>()).norm(), 1e-5);
  EXPECT_LT((K - K0).norm() / K0.norm(), 2e-9);
  EXPECT_NEAR(energy(c.system, r.end), E0, 5e-9 * E0);
  EXPECT_GT(r.chart_changes, 500);
  EXPECT_LT(largest_tilt, 3.0);
}

TEST(RigidIntegrators, StraightThroughPi) {
  // Spin about a transverse axis takes the director exactly through -e: gamma = (5 t, 0).
  const RigidCase c = free_top(0.0);
  for (const char* method : {"radau5", "gauss6", "generalized_alpha"}) {
    const Outcome on = integrate(c, method, 1e-6, 10.0, true);
    ASSERT_EQ(on.status, time::StepStatus::ok) << method;
    EXPECT_LT((attitude(c.system, on.end, 0) - rotation::L(Vec3(0, 50.0, 0))).norm(), 1e-10)
        << method;  // steady rotation
    // without the change of chart: a clear end, with node and time
    const Outcome off = integrate(c, method, 1e-6, 10.0, false);
    EXPECT_NE(off.status, time::StepStatus::ok) << method;
    ASSERT_EQ(off.outside, 0) << method;
    EXPECT_EQ(c.system.node(off.outside).name, "body");
    EXPECT_GT(off.end.q.tail<2>().norm(), 2.9) << method;  // it got as far as the chart goes
    EXPECT_LE(off.end.t, pi / 5) << method;
  }
}

TEST(RigidIntegrators, StepsFollowTheWhirlNotTheSpin) {
  // At 5000 rad/s for 10 s (8000 turns) the steps are those of the whirl: slow precession, and
  // nutation at Jp/Jt times the spin only while something excites it.
  const RigidCase slow = paper_rotor(50), fast = paper_rotor(5000);
  const Outcome a = integrate(slow, "radau5", 1e-5, 10.0),
                b = integrate(fast, "radau5", 1e-5, 10.0);
  ASSERT_EQ(b.status, time::StepStatus::ok);
  EXPECT_LT(b.statistics.accepted, a.statistics.accepted);
  EXPECT_GT(b.statistics.step_max * 5000, 20.0);  // radians of spin a step
  const Vec3 d = attitude(fast.system, b.end, 0).col(0);
  // omega.d is an integral of the motion; what is left is the end of the Newton iterations, some
  // 1e-13 of the spin a step
  EXPECT_NEAR(angular_velocity(fast.system, b.end, 0).dot(d), 5000.0, 1e-10 * 5000);
}
