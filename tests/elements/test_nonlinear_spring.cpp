// Force curves and the nonlinear springs made of them.
#include "conformance.hpp"
#include <core/error.hpp>
#include <core/law.hpp>
#include <elements/supports/nonlinear_spring.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

ForceCurvePtr curve(ForceCurve f) { return std::make_shared<const ForceCurve>(std::move(f)); }
const auto duffing = curve(ForceCurve::polynomial({0, 100, 30, 4e3}));
const auto damper = curve(ForceCurve::polynomial({3, 0, 50}));

}  // namespace

TEST(ForceCurve, SlopeAndEnergyAreThoseOfTheForce) {
  const ForceCurve curves[] = {ForceCurve::polynomial({1, -2, 3, 0.5, 0, 0, 0, 2}),
                               ForceCurve::table({-2, -1, 0, 1, 3}, {-9, -4, 0, 3, 20}, true),
                               ForceCurve::clearance(0.3, 0.5, 1000, 0.1),
                               ForceCurve::one_sided(-0.2, 50, 0.05)};
  for (const auto& f : curves)
    for (double x = -2.93; x < 3.5; x += 0.171) {
      const double h = 1e-3;
      const auto v = f.at(x);
      // fourth-order differences of pieces of degree <= 8
      const auto slope = [&](auto g) {
        return (8 * (g(x + h) - g(x - h)) - (g(x + 2 * h) - g(x - 2 * h))) / (12 * h);
      };
      EXPECT_NEAR(v.slope, slope([&](double u) { return f.at(u).F; }),
                  1e-6 * (1 + std::abs(v.slope)));
      EXPECT_NEAR(v.F, slope([&](double u) { return f.at(u).energy; }), 1e-6 * (1 + std::abs(v.F)));
    }
  for (const auto& f : curves)
    EXPECT_NEAR(f.at(0.0).energy, 0.0, 1e-15);
}

TEST(ForceCurve, Shapes) {
  const auto play = ForceCurve::clearance(0.3, 0.5, 1000);
  EXPECT_EQ(play(0.5), 0.0);
  EXPECT_EQ(play(-0.3), 0.0);
  EXPECT_NEAR(play(0.6), 100, 1e-12);
  EXPECT_NEAR(play(-0.6), -300, 1e-12);
  EXPECT_NEAR(play.at(-0.6).energy, 0.5 * 1000 * 0.09, 1e-12);
  const auto soft = ForceCurve::clearance(0.3, 0.5, 1000, 0.1);
  EXPECT_NEAR(soft(0.55), 0.5 * 1000 / 0.1 * 0.0025, 1e-12);
  EXPECT_NEAR(soft(0.7), 1000 * 0.15, 1e-12);
  const auto stop = ForceCurve::one_sided(-0.2, 50);
  EXPECT_NEAR(stop(0), 10, 1e-14);
  EXPECT_EQ(stop(-0.3), 0.0);
  const auto line = ForceCurve::table({-1, 0, 2}, {-5, 0, 4}, false);
  EXPECT_NEAR(line(-3), -15, 1e-14);
  EXPECT_NEAR(line(3), 6, 1e-14);
}

// Rows of F = 100 x^2: the slopes at the ends are those of the parabola. Places of 50, 1200 and 2000 N by
// scipy.interpolate.PchipInterpolator 1.10.
TEST(ForceCurve, MonotoneCubicsHaveTheSlopesOfLawsAndTables) {
  const auto f = ForceCurve::table({0, 1, 2, 3, 4}, {0, 100, 400, 900, 1600}, true);
  EXPECT_EQ(f.at(0).slope, 0.0);
  EXPECT_NEAR(f.at(4).slope, 800, 1e-12);
  EXPECT_NEAR(f(4.5), 2000, 1e-12);
  EXPECT_NEAR(f(0.65270), 50, 1e-2);
  EXPECT_NEAR(f(3.46729), 1200, 1e-2);
  const auto law = make_pchip({0, 1, 2, 3, 4}, {0, 100, 400, 900, 1600});
  for (const double x : {0.1, 0.7, 1.3, 2.9, 3.6})
    EXPECT_NEAR(f(x), law->at(x).f, 1e-12 * 1600) << x;
}

TEST(ForceCurve, BadInput) {
  const auto code = [](auto make) {
    try {
      make();
      return std::string("none");
    } catch (const Error& e) {
      return e.diagnostics().front().code;
    }
  };
  EXPECT_EQ(code([] { ForceCurve::clearance(-1e-6, 0, 1); }), "E82");
  EXPECT_EQ(code([] { ForceCurve::clearance(0, 0, -1); }), "E82");
  EXPECT_EQ(code([] { ForceCurve::table({0, 0}, {1, 2}, true); }), "E82");
  EXPECT_EQ(code([] { ForceCurve::table({0}, {1}, true); }), "E82");
  EXPECT_EQ(code([] { ForceCurve::polynomial({0, whirl::nan}); }), "E82");
  EXPECT_EQ(code([] { ForceCurve::polynomial(std::vector<double>(9, 1.0)); }), "E82");
}

TEST(NonlinearSpring, Conformance) {
  ConformanceOptions o;
  o.chart = tilted_chart();
  o.symmetric_K = true;
  const Vec3 n = Vec3(1, 2, -2).normalized();
  check_kernel(ScalarSpring<3>::translation(n, duffing, damper), o);
  check_kernel(ScalarSpring<7>::translation(n, duffing, damper, 0.3, -0.2), o);
  check_kernel(ScalarSpring<7>::tilt(o.chart.col(1), o.chart.col(0), duffing, damper), o);
  o.phi = 0.3;
  check_kernel(ScalarSpring<7>::twist(duffing, damper), o);
  const auto odd = curve(ForceCurve::polynomial({0, 100, 0, 4e3}));
  check_kernel(RadialSpring{odd, damper}, o);
}

TEST(NonlinearSpring, TwistCountsWholeTurns) {
  const auto linear = curve(ForceCurve::polynomial({0, 7})),
             none = curve(ForceCurve::polynomial({0}));
  const auto k = ScalarSpring<7>::twist(linear, none);
  Vector<12> q = Vector<12>::Zero(), zero = q;
  q[3] = 0.5;
  q[9] = 0.25;
  const Mat3 chart = Mat3::Identity();
  NodeFrame<2, 7> x(q, zero, zero, chart, Vec3::Zero());
  x.state[0].turns = 1e6;
  x.state[1].turns = 1e6 - 3;
  system::ForceX<14> f = Vector<14>::Zero();
  k.add_force(x.nodes(), {}, f);
  EXPECT_NEAR(f[6], 7 * (0.25 + 3 * two_pi), 1e-7);
  EXPECT_EQ(f[13], -f[6]);
}

TEST(NonlinearSpring, RadialCentre) {
  const RadialSpring k{curve(ForceCurve::clearance(1e-3, 1e-3, 1e6)), damper};
  Vector<12> q = Vector<12>::Zero(), zero = q;
  const Mat3 chart = Mat3::Identity();
  const NodeFrame<2, 3> x(q, zero, zero, chart, Vec3::Zero());
  system::ForceX<6> f = Vector<6>::Zero();
  system::TangentX<6> t;
  t.set_zero();
  k.add_force(x.nodes(), {}, f);
  k.add_tangent(x.nodes(), {}, t);
  EXPECT_EQ(f.norm(), 0.0);
  EXPECT_EQ(t.K.norm(), 0.0);
  EXPECT_TRUE(t.C.allFinite());
}
