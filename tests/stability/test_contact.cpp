// Clearances of zero and 1e-9 m, stops up to 1e12 N/m and impacts, against exact sequences of
// flights and contacts.
#include "scene.hpp"
#include <elements/supports/nonlinear_spring.hpp>
#include <elements/supports/rub.hpp>
#include <fmt/format.h>
#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

/// Distance fallen at time t by a mass of 1 kg dropped `gap` above a stop of stiffness k: parabolas
/// and half sines in turn.
double bouncing(double gap, double k, double g, double t) {
  const double w = std::sqrt(k), fall = std::sqrt(2.0 * gap / g);
  if (t <= fall) return 0.5 * g * t * t;
  t -= fall;
  const double v = g * fall;  // at every touch and release
  const double contact = 2.0 / w * (pi - std::atan2(v * w, g)), flight = 2.0 * v / g;
  t = std::fmod(t, contact + flight);
  if (t <= contact) return gap + g / (w * w) * (1.0 - std::cos(w * t)) + v / w * std::sin(w * t);
  t -= contact;
  return gap - v * t + 0.5 * g * t * t;
}

}  // namespace

// Several bounces: the phase error of each contact adds up, and the height changes by flight speed
// times that phase.
TEST(Contact, BouncesOnAStop) {
  for (const char* method : {"radau5", "gauss6", "generalized_alpha"})
    for (double gap : {0.0, 1e-9, 1e-3})
      for (double k : {1e4, 1e8, 1e12}) {
        const double g = 9.81, w = std::sqrt(k), fall = std::sqrt(2.0 * gap / g);
        const double contact = 2.0 / w * (pi - std::atan2(g * fall * w, g)),
                     cycle = contact + 2.0 * fall;
        const double t = fall + 2.6 * cycle;
        system::Builder b;
        b.add_line("shaft");
        const Index n = b.add_node({Vec3::Zero(), 0, "journal", false});
        const Index ground = b.add_ground(Vec3::Zero(), "stop");
        b.add(elements::PointMass{1.0}, {n}, "point masses");
        const auto stop =
            std::make_shared<elements::ForceCurve>(elements::ForceCurve::one_sided(gap, k));
        const auto none =
            std::make_shared<elements::ForceCurve>(elements::ForceCurve::polynomial({0.0}));
        b.add(elements::ScalarSpring<3>::translation(-Vec3::UnitZ(), stop, none), {n, ground},
              "stops");
        b.hold(n, 0);
        b.hold(n, 1);
        b.set_gravity(Vec3(0, 0, -g));
        const system::System s = b.finalize();
        const std::string what = fmt::format("{} gap {:g} k {:g}", method, gap, k);
        analysis::EnergyBalance energy;
        const analysis::TransientResult r = run(s, s.make_state(), {t, 1.0, method}, {&energy});
        ASSERT_EQ(r.reason, analysis::StopReason::end_time) << what << ": " << r.detail;
        const system::State& end = r.end;
        const double peak = gap + 2.0 * g / k + g * fall / w;
        // Three contacts, each with the aimed error in its phase and its rebound: 10 aims of the
        // height. Generalized-alpha takes the acceleration it has at the end of a contact of 3 us
        // along into flights of 29 ms: a tenth of a percent of the rebound's speed each.
        const bool carried = std::string(method) == "generalized_alpha" && k > 1e10 && gap > 1e-6;
        EXPECT_NEAR(-end.q[2], bouncing(gap, k, g, t),
                    (carried ? 500.0 : 10.0) * aimed * (peak + 1e-13))
            << what;
        if (gap > 1e-6) {
          EXPECT_LT(energy.worst_defect(), (carried ? 0.03 : 10.0 * aimed) * g * gap) << what;
        }
      }
}

// A journal falls into its clearance bearing and comes to rest on it: gap + mg/k, gap 0 and 1e-9 m
// among others.
TEST(Contact, ComesToRestInAClearance) {
  for (double gap : {0.0, 1e-9, 1e-6, 1e-4})
    for (double k : {1e5, 1e8, 1e11}) {
      system::Builder b;
      b.add_line("shaft");
      const Index n = b.add_node({Vec3::Zero(), 0, "journal", false});
      const Index ground = b.add_ground(Vec3::Zero(), "bore");
      b.add(elements::RigidDisk{1.0, 1e-3, 2e-3, 0.0}, {n}, "rigid disks");
      elements::Rub rub;
      rub.law.gap = gap;
      rub.law.stiffness = k;
      rub.law.damping = 1.0;
      rub.law.friction = 0.1;
      rub.law.radius = 0.05;
      b.add(rub, {n, ground}, "rubs");
      add_spring(b, n, Mat3::Zero(),
                 isotropic(2.0 * 0.5 * std::sqrt(k)));  // half of critical in contact
      b.hold(n, 0);
      b.hold(n, 3);
      b.hold(n, 4);
      b.hold(n, 5);
      b.set_gravity(Vec3(0, 0, -9.81));
      const system::System s = b.finalize();
      const double w = std::sqrt(k), c = std::sqrt(k), rest = gap + 9.81 / k;
      const double t = 40.0 / w + 2.0 * gap * c / 9.81;  // falls at the speed g/c at most
      const std::string what = fmt::format("gap {:g} k {:g}", gap, k);
      const system::State end = run_ok(s, s.make_state(), {t, 1.0}, what);
      EXPECT_NEAR(end.q[2], -rest, aimed * (rest + 1e-13)) << what;
      EXPECT_NEAR(end.q[1], 0.0, aimed * (rest + 1e-13)) << what;
    }
}

// A hammer blow: a triangle of 1e6 N and 1 us on a mass on a spring, far from the scales of what
// follows.
TEST(Contact, HammerBlow) {
  const double m = 1.0, k = 1e4, w = 100.0, width = 1e-6, t = 0.2;
  system::Builder b;
  b.add_line("shaft");
  const Index n = b.add_node({Vec3::Zero(), 0, "mass", false});
  b.add(elements::PointMass{m}, {n}, "point masses");
  add_spring(b, n, isotropic(k));
  // impulse 0.5 N s
  b.add(elements::PointForce{Vec3(0, 0, 1e6),
                             make_table({0.0, 0.01, 0.01 + 0.5 * width, 0.01 + width},
                                        {0.0, 0.0, 1.0, 0.0})},
        {n}, "forces");
  const system::System s = b.finalize();
  const double impulse = 1e6 * 0.5 * width, centre = 0.01 + 0.5 * width;
  for (const char* method : methods) {
    const system::State end = run_ok(s, s.make_state(), {t, 1.0, method}, method);
    // the blow's width changes the response by (w width)^2/24
    EXPECT_NEAR(end.q[2], impulse / (m * w) * std::sin(w * (t - centre)), aimed * impulse / (m * w))
        << method;
  }
}
