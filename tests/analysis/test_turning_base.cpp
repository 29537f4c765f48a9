// Inertia on a turning base: conformance, and free motion that must be uniform in inertial axes.
#include "../elements/conformance.hpp"
#include <analysis/transient/observer.hpp>
#include <analysis/transient/transient.hpp>
#include <core/rotation.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <elements/rigid/turning_base.hpp>
#include <elements/loads/unbalance.hpp>
#include <system/problem.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

TurningBasePtr base(const Vec3& gravity = Vec3(0.3, -2.0, -9.0)) {
  auto b = std::make_shared<TurningBase>();
  b->axis = Vec3(0.36, 0.48, 0.8);
  b->about = Vec3(0.4, -1.0, 0.3);
  b->rate = make_harmonic(0.7, 1.1, 2.0, 0.3);
  b->gravity = gravity;
  return b;
}

template <class K>
OnTurningBase<K> on(const K& k) {
  std::array<Vec3, K::n_nodes> position;
  for (int i = 0; i < K::n_nodes; ++i)
    position[i] = Vec3(0.2 + 0.4 * i, 0.1, 0.0);
  return {k, base(), position};
}

ConformanceOptions options() {
  ConformanceOptions o;
  o.chart = tilted_chart();
  return o;
}

/// Rotation of the base at time t, and its angular velocity.
Mat3 attitude(const TurningBase& b, double t) {
  return rotation::L(Vec3(b.rate->integral(t) * b.axis));
}

analysis::TransientResult run(const system::System& sys, const system::State& start, double t_end,
                              analysis::Observer& o) {
  system::SystemProblem problem(sys);
  analysis::TransientOptions t;
  t.integrator.tolerance = 1e-9;
  t.integrator.t_end = t_end;
  return analysis::run_transient(problem, start, t, {&o});
}

}  // namespace

TEST(TurningBase, Conformance) {
  const ConformanceOptions o = options();
  check_kernel(on(PointMass{2.5}), o);
  check_kernel(on(RigidDisk{5.0, 0.08, 0.15, 0.2}), o);
  Mat3 J;
  J << 0.20, 0.03, -0.02, 0.03, 0.15, 0.01, -0.02, 0.01, 0.12;
  check_kernel(on(RigidBody(3.0, Vec3(0.1, 0.05, -0.08), J)), o);
  check_kernel(on(UnbalanceMass(0.03, 0.4, make_smooth_step(0, 2, 0.3, 1.7), -0.3)), o);
}

// A spinning, tumbling disk in free fall. In inertial axes its mass centre follows a parabola and
// its angular momentum stays.
TEST(TurningBase, FreeFlightOfASpinningDisk) {
  const Vec3 g(0.3, -2.0, -9.0), position(0.2, 0.1, 0.0);
  const TurningBasePtr b = base(g);
  const RigidDisk disk{5.0, 0.08, 0.15, 0.2};
  system::Builder builder;
  builder.add_line("disk");
  builder.add_node({position, 0, "disk", false});
  builder.set_gravity(g);
  builder.add(disk, {0}, "disks");
  builder.add(OnTurningBase<RigidDisk>(disk, b, {position}), {0}, "turning base");
  const system::System sys = builder.finalize();
  system::State start = sys.make_state();
  start.v << 0.5, -0.3, 0.2, 40.0, 0.6, -0.4;

  struct Watch final : analysis::Observer {
    const TurningBase& b;
    const RigidDisk& k;
    Vec3 position, g, X0, V0, H0;
    double worst_X = 0, worst_H = 0;
    Watch(const TurningBase& base, const RigidDisk& disk, const Vec3& p, const Vec3& gravity)
        : b(base),
          k(disk),
          position(p),
          g(gravity) {}
    void look(const analysis::Snapshot& s, bool first) {
      const system::NodeState& n = s.node(0);
      const Mat3 A = attitude(b, s.t());
      const Vec3 w = b.rate->at(s.t()).f * b.axis, r = position + n.u + k.offset * n.d() - b.about;
      const Vec3 X = A * r, V = A * (n.du + k.offset * n.dd + w.cross(r)), omega = n.omega() + w,
                 d = n.d();
      const Vec3 H = A * (k.Jt * (omega - omega.dot(d) * d) + k.Jp * omega.dot(d) * d);
      if (first) {
        X0 = X;
        V0 = V;
        H0 = H;
      }
      worst_X = std::max(worst_X, (X - X0 - s.t() * V0 - 0.5 * s.t() * s.t() * g).norm());
      worst_H = std::max(worst_H, (H - H0).norm() / H0.norm());
    }
    void begin(const analysis::Snapshot& s) override { look(s, true); }
    void step(analysis::StepAccess& s) override { look(s.end(), false); }
  } watch(*b, disk, position, g);
  const analysis::TransientResult r = run(sys, start, 3.0, watch);
  ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
  // 1e-9 a step of a motion of 45 m and 40 rad/s, some hundreds of steps
  EXPECT_LT(watch.worst_X, 1e-6);
  EXPECT_LT(watch.worst_H, 1e-6);
}

// A free shaft at rest in inertial axes stays there, straight and unstressed, whatever the base
// does.
TEST(TurningBase, ShaftAtRestInSpaceStaysAtRest) {
  const TurningBasePtr b = base(Vec3::Zero());
  ElementSection section;
  section.od1 = section.od2 = section.mass_od1 = section.mass_od2 = 0.05;
  section.E = 2.1e11;
  section.G = 8.08e10;
  section.rho = 7850;
  const double l = 0.3;
  const ShaftBeam<false> beam(make_shaft_constants(section, l), Vec3::UnitX());
  system::Builder builder;
  builder.add_line("shaft");
  std::vector<Vec3> at;
  for (int i = 0; i < 4; ++i) {
    at.push_back(Vec3(l * i, 0, 0));
    builder.add_node({at.back(), 0, "node", false});
  }
  for (Index i = 0; i < 3; ++i) {
    builder.add(beam, {i, i + 1}, "shaft elements");
    builder.add(
        OnTurningBase<ShaftBeam<false>>(
            beam, b, {at[static_cast<std::size_t>(i)], at[static_cast<std::size_t>(i) + 1]}),
        {i, i + 1}, "turning base");
  }
  const system::System sys = builder.finalize();
  system::State start = sys.make_state();
  const Vec3 w = b->rate->at(0.0).f * b->axis;
  for (Index i = 0; i < 4; ++i) {
    start.v.segment<3>(6 * i) = -w.cross(at[static_cast<std::size_t>(i)] - b->about);
    start.v[6 * i + system::spin_phi] = -w.x();
    start.v[6 * i + system::gamma2] = -w.y();
    start.v[6 * i + system::gamma3] = -w.z();
  }
  struct Watch final : analysis::Observer {
    const TurningBase& b;
    const std::vector<Vec3>& at;
    double worst_X = 0, worst_d = 0;
    Watch(const TurningBase& base, const std::vector<Vec3>& p) : b(base), at(p) {}
    void step(analysis::StepAccess& s) override {
      const analysis::Snapshot& e = s.end();
      const Mat3 A = attitude(b, e.t());
      for (Index i = 0; i < 4; ++i) {
        const Vec3& p = at[static_cast<std::size_t>(i)];
        worst_X = std::max(worst_X, (A * (p + e.node(i).u - b.about) - (p - b.about)).norm());
        worst_d = std::max(worst_d, (A * e.node(i).d() - Vec3::UnitX()).norm());
      }
    }
  } watch(*b, at);
  const analysis::TransientResult r = run(sys, start, 1.5, watch);
  ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
  EXPECT_LT(watch.worst_X, 1e-6);  // m of about 2 m: 1e-9 a step
  EXPECT_LT(watch.worst_d, 1e-6);
}
