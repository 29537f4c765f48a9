// Free bodies and what their motion keeps.
#pragma once
#include "record.hpp"

#include <analysis/transient/transient.hpp>
#include <core/rotation.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/rigid/rigid_disk.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <system/problem.hpp>

#include <cmath>

namespace whirl::test {

/// A free spinning shaft with a disk, four elements.
inline system::System free_rotor() {
  system::Builder b;
  const Index line = b.add_line("shaft");
  elements::ElementSection bar;
  bar.od1 = bar.od2 = bar.mass_od1 = bar.mass_od2 = 0.02;
  bar.E = 2.1e11;
  bar.G = 8e10;
  bar.rho = 7850;
  const auto constants = elements::make_shaft_constants(bar, 0.2);
  b.add_node({Vec3::Zero(), line, "left"});
  for (int i = 1; i <= 4; ++i) {
    b.add_node({Vec3(0.2 * i, 0, 0), line, "node"});
    b.add(elements::ShaftBeam<false>(constants, Vec3::UnitX()), {i - 1, i}, "shaft");
  }
  b.add(elements::RigidDisk{1.0, 2e-3, 3e-3, 0.0}, {1}, "disk");
  return b.finalize();
}

/// One rigid body with three moments of inertia.
inline system::System free_body() {
  system::Builder b;
  const Index line = b.add_line("body");
  const Index node = b.add_node({Vec3::Zero(), line, "body"});
  b.add(elements::RigidBody(2.0, Vec3::Zero(), Vec3(0.02, 0.03, 0.045).asDiagonal()), {node},
        "body");
  return b.finalize();
}

/// Linear momentum, angular momentum about the global origin, and energy.
struct Kept {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double energy = 0;
};
inline Kept kept(const system::System& s, const system::State& x) {
  system::Workspace w = s.make_workspace();
  la::MCK m = s.make_matrices();
  EXPECT_TRUE(s.tangent(w, x.frames, x.t, x.q, x.v, x.a, m));
  VecX p = VecX::Zero(s.size());
  m.M.add_multiply(1.0, x.v, p);
  Kept out;
  for (Index i = 0; i < s.nodes(); ++i) {
    const Vec3 on_u = p.segment<3>(6 * i);
    out.linear += on_u;
    out.angular += (s.node(i).position + x.q.segment<3>(6 * i)).cross(on_u);
    for (int k = 0; k < 3; ++k) {
      const rotation::ChartRates rate = rotation::rates_of_omega(
          Vec2(x.q.segment<2>(6 * i + 4)), Vec3(x.frames.axes(i).transpose() * Vec3::Unit(k)));
      out.angular[k] += p[6 * i + 3] * rate.phi + p.segment<2>(6 * i + 4).dot(rate.gamma);
    }
  }
  const system::Energy e = s.energy(w);
  out.energy = e.kinetic + e.elastic;
  return out;
}

/// Angle the first director has gone through, rad.
struct Tumbles final : analysis::Observer {
  double angle = 0;
  Vec3 last;
  void begin(const analysis::Snapshot& s) override { last = s.node(0).d(); }
  void step(analysis::StepAccess& s) override {
    const Vec3 now = s.at(s.t1()).node(0).d();
    angle += std::atan2(now.cross(last).norm(), now.dot(last));
    last = now;
  }
};

inline void tumble_a_thousand_times(const char* name, const system::System& s, const Vec3& omega,
                                    double t_end, const char* method, double tolerance,
                                    double energy_drift, double angular_drift) {
  Record record(name, "free motion keeps momentum, angular momentum and energy");
  system::State start = s.make_state();
  for (Index i = 0; i < s.nodes(); ++i) {
    start.v.segment<3>(6 * i) = Vec3(0.1, 0.2, -0.3) + omega.cross(s.node(i).position);
    start.v.segment<3>(6 * i + 3) = omega;
  }
  system::SystemProblem problem(s);
  analysis::TransientOptions o;
  o.method = method;
  o.integrator.tolerance = tolerance;
  o.integrator.t_end = t_end;
  Tumbles turns;
  const Kept before = kept(s, start);
  const analysis::TransientResult r = analysis::run_transient(problem, start, o, {&turns});
  ASSERT_EQ(r.reason, analysis::StopReason::end_time) << r.detail;
  EXPECT_GT(turns.angle / two_pi, 1000.0);
  const Kept after = kept(s, r.end);
  const double linear = (after.linear - before.linear).norm() / before.linear.norm(),
               angular = (after.angular - before.angular).norm() / before.angular.norm(),
               energy = std::abs(after.energy / before.energy - 1);
  std::printf("%s: %.0f tumbles, momentum %.2e, angular momentum %.2e, energy %.2e\n", name,
              turns.angle / two_pi, linear, angular, energy);
  record.below("momentum lost over 1,000 tumbles, relative", "-", linear, 1e-9);
  record.below("angular momentum lost, relative", "-", angular, angular_drift);
  record.below("energy's drift, relative", "-", energy, energy_drift);
}

}  // namespace whirl::test
