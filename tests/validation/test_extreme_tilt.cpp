// The chart near its limit: a free axisymmetric body that spins and tumbles steadily, driven to 3.0
// rad and to pi.
#include <analysis/transient/transient.hpp>
#include <core/rotation.hpp>
#include <elements/rigid/rigid_disk.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::analysis;

namespace {

system::System make_body() {
  system::Builder b;
  b.add_line("body");
  const Index n = b.add_node({Vec3::Zero(), 0, "node at 0 m of shaft 'body'", false});
  elements::RigidDisk disk;
  disk.mass = 2.0;
  disk.Jt = 0.3;
  disk.Jp = 0.3;  // a sphere: any steady omega is a free motion
  b.add(disk, {n}, "rigid disks");
  return b.finalize();
}

system::State tumbling(const system::System& s, const Vec3& omega) {
  system::State x = s.make_state();
  const rotation::ChartRates r = rotation::rates_of_omega(Vec2::Zero(), omega);
  x.v[system::spin_phi] = r.phi;
  x.v.segment<2>(4) = r.gamma;
  return x;
}

// Director of a body turning with constant omega from d = e.
Vec3 director_at(const Vec3& omega, double t) { return rotation::L(t * omega) * Vec3::UnitX(); }

}  // namespace

TEST(ExtremeTilt, DrivenToThreeRadians) {
  // Without chart change, up to |gamma| = 3.0, where the map (phi', gamma') -> omega has condition
  // 30: the director stays right to the accuracy asked for, times that condition.
  const system::System s = make_body();
  system::SystemProblem problem(s, {la::SolverKind::automatic, false, 2.0});
  const Vec3 omega(0.05, 1.0, 0.4);  // nearly transverse: the director sweeps past d = -e
  TransientOptions o;
  o.integrator.tolerance = 1e-9;
  const double w = omega.norm(), reach = 3.0;
  o.integrator.t_end = reach / omega.tail<2>().norm();
  TiltWatch tilt;
  const TransientResult r = run_transient(problem, tumbling(s, omega), o, {&tilt});
  ASSERT_EQ(r.reason, StopReason::end_time) << r.detail;
  EXPECT_GT(tilt.tilt(), 2.95);
  const double condition = rotation::chart_condition(tilt.tilt());
  EXPECT_GT(condition, 20.0);
  EXPECT_LT(condition, 50.0);
  rotation::Director d;
  rotation::director(r.end.q.segment<2>(4), d);
  EXPECT_LT((d.t + Vec3::UnitX() - director_at(omega, r.end.t)).norm(),
            1e-9 * condition * w * r.end.t);
}

TEST(ExtremeTilt, WithoutChartChangeTheRunStopsAndSaysWhere) {
  const system::System s = make_body();
  system::SystemProblem problem(s, {la::SolverKind::automatic, false, 2.0});
  TransientOptions o;
  o.integrator.t_end = 10.0;
  const TransientResult r = run_transient(problem, tumbling(s, Vec3(0, 1.0, 0)), o, {});
  EXPECT_EQ(r.reason, StopReason::failed);
  EXPECT_NEAR(r.end.t, rotation::chart_limit, 0.01);  // 1 rad/s
  EXPECT_NE(r.detail.find("node at 0 m of shaft 'body'"), std::string::npos) << r.detail;
  EXPECT_NE(r.detail.find("at t = 3."), std::string::npos) << r.detail;
  EXPECT_TRUE(r.end.q.allFinite());
}

TEST(ExtremeTilt, WithChartChangeItTumblesOn) {
  const system::System s = make_body();
  system::SystemProblem problem(s);
  const Vec3 omega(0.3, 1.0, -0.4);
  TransientOptions o;
  o.integrator.tolerance = 1e-8;
  o.integrator.t_end = 100.0;
  const TransientResult r = run_transient(problem, tumbling(s, omega), o, {});
  ASSERT_EQ(r.reason, StopReason::end_time) << r.detail;
  rotation::Director d;
  rotation::director(r.end.q.segment<2>(4), d);
  const Vec3 director = r.end.frames.axes(0) * (d.t + Vec3::UnitX());
  // 18 turns through pi: the error asked for, 1e-8 of a radian of response, grows with the number
  // of charts (about 50)
  EXPECT_LT((director - director_at(omega, 100.0)).norm(), 1e-6);
}
