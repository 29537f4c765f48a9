// Load paths past limit points: the column beyond its Euler load against the elastica, the
// snap-through of two bars against its closed form.
#include "record.hpp"
#include <analysis/statics/load_path.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::analysis;
using elements::ShaftBeam;

namespace {

elements::ElementSection section(double EA, double EI) {
  elements::ElementSection s;
  s.constants = true;
  s.given = {EA, 0.0, EI, EI, 1.0, 0, 0};  // no shear deformation
  return s;
}

/// Cantilever column of length 1 and EI = 1 along x, n elements, end load (-P, imperfection P).
system::System column(int n, double P, double imperfection) {
  system::Builder b;
  b.add_line("column");
  const auto c = elements::make_shaft_constants(section(1e8, 1.0), 1.0 / n);
  for (int i = 0; i <= n; ++i)
    b.add_node({Vec3(1.0 * i / n, 0, 0), 0, "node " + std::to_string(i), false});
  for (int i = 0; i < n; ++i)
    b.add(ShaftBeam<false>(c, Vec3::UnitX()), {i, i + 1}, "shaft elements");
  for (int k = 0; k < 6; ++k)
    b.hold(0, k);
  b.add(elements::PointForce{Vec3(-P, imperfection * P, 0), nullptr}, {n}, "forces");
  return b.finalize();
}

}  // namespace

TEST(LoadPath, ColumnFollowsTheElastica) {
  // S. Timoshenko, J. Gere, Theory of Elastic Stability, 2nd ed., 2.7: with k = sin(alpha/2), alpha
  // the end slope, P L^2/EI = K(k)^2, x_a = 2 E(k)/K(k) - 1, y_a = 2 k/K(k). With the load inclined
  // by beta the same elastica ends at another slope: P L^2/EI = (K(k) - F(phi0, k))^2, k =
  // sin((alpha + beta)/2), sin phi0 = sin(beta/2)/k.
  test::Record record("Column beyond buckling: the elastica",
                      "S. Timoshenko, J. Gere, Theory of Elastic Stability, 2nd ed., 2.7");
  double worst_load = 0, worst_tip = 0;
  for (const bool by_arc : {true, false}) {
    const double beta = by_arc ? 2e-3 : 1e-6;
    const system::System s = column(20, pi * pi / 4, std::tan(beta));
    SteadySystem running(s);
    LoadPathOptions o;
    o.last_load = 3.0;
    if (!by_arc) {
      o.controlled = 6 * 20 + 1;
      o.controlled_to = 0.78;
      o.steps = 30;
    }
    int checked = 0;
    double last = 0, largest_tilt = 0;
    const LoadPathResult r =
        follow_load_path(running, 0.0, s.make_state(), o, [&](const LoadPathPoint& p) {
          const VecX& q = p.state->q;
          rotation::Director d;
          const Index tip = 6 * 20;
          rotation::director(q.segment<2>(tip + 4), d);
          const Vec3 normal = p.state->frames.axes(20) * (d.t + Vec3::UnitX());
          const double alpha = std::atan2(normal.y(), normal.x());
          largest_tilt = std::max(largest_tilt, std::abs(alpha));
          last = p.load;
          if (alpha < 0.5) return true;  // below, the imperfection still shows
          const double k = std::sin(0.5 * (alpha + beta)), K = std::comp_ellint_1(k),
                       E = std::comp_ellint_2(k);
          const double root = K - std::ellint_1(k, std::asin(std::sin(0.5 * beta) / k));
          // 20 elements, 1/EA = 1e-8
          worst_load = std::max(
              worst_load, std::abs(p.load * pi * pi / 4 / std::cos(beta) - root * root) / (K * K));
          if (!by_arc)  // the inclination of 1e-6 shows below
            worst_tip = std::max({worst_tip, std::abs(1.0 + q[tip] - (2.0 * E / K - 1.0)),
                                  std::abs(q[tip + 1] - 2.0 * k / K)});
          ++checked;
          return true;
        });
    EXPECT_EQ(r.end, LoadPathEnd::reached) << r.why;
    EXPECT_GT(checked, 5);
    EXPECT_TRUE(r.last.state.q.allFinite());
    if (by_arc) {
      EXPECT_EQ(r.load, 3.0);
      EXPECT_GT(largest_tilt, 2.3);  // beyond a right angle, and beyond the switch of charts
    } else {
      EXPECT_EQ(r.last.state.q[6 * 20 + 1], 0.78);
    }
  }
  record.below("20 elements, to three times the buckling load: error of the load", "of it",
               worst_load, 5e-5);
  record.below("the same: error of the tip's place", "of the length", worst_tip, 5e-5);
}

TEST(LoadPath, BarSnapsThrough) {
  // R. von Mises, ZAMM 3 (1923) 406: half of the two-bar frame. A bar of half span 1 and rise 0.3,
  // EA = 1, pinned at both ends, its crown on a vertical guide: P = EA w (1/L - 1/sqrt(1+w^2))
  // times -1, w the rise that is left (strain referred to the unloaded length L).
  const double w0 = 0.3, L = std::hypot(1.0, w0);
  system::Builder b;
  Mat3 triad;
  triad << Vec3(1, w0, 0) / L, Vec3(-w0, 1, 0) / L, Vec3::UnitZ();
  b.add_line("bar", triad);
  const auto c = elements::make_shaft_constants(section(1.0, 1.0), L);
  b.add_node({Vec3(0, 0, 0), 0, "pin", false});
  b.add_node({Vec3(1, w0, 0), 0, "crown", false});
  b.add(ShaftBeam<false>(c, triad.col(0)), {0, 1}, "shaft elements");
  for (int k : {0, 1, 2, 3})
    b.hold(0, k);
  b.hold(1, 0);
  b.hold(1, 2);
  b.add(elements::PointForce{Vec3(0, -0.01, 0), nullptr}, {1}, "forces");
  const system::System s = b.finalize();
  for (const bool by_arc : {true, false}) {
    SteadySystem running(s);
    LoadPathOptions o;
    o.last_load = 1.0;
    o.steps = 40;
    if (!by_arc) {
      o.controlled = 7;
      o.controlled_to = -0.7;
    }
    int limits = 0;
    double highest = -infinity, lowest = infinity;
    const LoadPathResult r =
        follow_load_path(running, 0.0, s.make_state(), o, [&](const LoadPathPoint& p) {
          const double w = w0 + p.state->q[7];
          EXPECT_NEAR(0.01 * p.load, w * (1.0 / std::hypot(1.0, w) - 1.0 / L), 1e-12)
              << w;  // Newton's tolerance
          limits += p.limit;
          if (w > 0.0) highest = std::max(highest, p.load);
          lowest = std::min(lowest, p.load);
          return true;
        });
    EXPECT_EQ(r.end, LoadPathEnd::reached) << r.why;
    EXPECT_EQ(limits, 2);
    const double l = std::cbrt(L), w = std::sqrt(l * l - 1.0),
                 limit = w * (1.0 / l - 1.0 / L) / 0.01;
    EXPECT_GT(highest, 0.97 * limit);  // points beside the top
    EXPECT_LE(highest, limit * (1 + 1e-9));
    EXPECT_LT(lowest, -0.97 * limit);
    EXPECT_LT(w0 + r.last.state.q[7], -w0);  // hangs through
    if (!by_arc) {
      EXPECT_EQ(r.last.state.q[7], -0.7);
    }
    if (by_arc) {
      EXPECT_EQ(r.load, 1.0);
    }
  }
}
