// Shafts: slenderness, length ratios, buckling and beyond, wind-up, against closed forms.
#include "scene.hpp"
#include <core/error.hpp>
#include <fmt/format.h>
#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

double tip_deflection(const std::vector<double>& lengths, const elements::ElementSection& bar,
                      double F) {
  system::Builder b;
  b.add_line("shaft");
  add_shaft(b, bar, lengths);
  clamp(b, 0);
  const Index tip = static_cast<Index>(lengths.size());
  b.add(elements::PointForce{Vec3(0, 0, F), nullptr}, {tip}, "forces");
  const system::System s = b.finalize();
  return equilibrium(s).state.q[6 * tip + 2];
}

/// F(pi/2, k), the complete elliptic integral of the first kind, by the arithmetic-geometric mean.
double elliptic_K(double k) {
  double a = 1.0, b = std::sqrt(1.0 - k * k);
  while (std::abs(a - b) > 1e-15) {
    const double m = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = m;
  }
  return 0.5 * pi / a;
}

elements::ElementSection wire(double EI) {
  elements::ElementSection s;
  s.constants = true;
  s.given.EA = 1e8 * EI;
  s.given.GJ = EI;
  s.given.EI = EI;
  s.given.rhoA = 1.0;
  s.given.rhoI = 0.0;
  s.given.rhoIp = 1e-4;
  return s;
}

}  // namespace

// Cantilever with a force at its end: F L^3/3EI + F L/kGA, exact with any number of elements;
// length over diameter 2 to 1e4.
TEST(Shafts, Slenderness) {
  for (double slenderness : {2.0, 10.0, 1e2, 1e3, 1e4})
    for (int n : {1, 4, 16}) {
      const double L = 1.0;
      const elements::ElementSection bar = round_bar(L / slenderness);
      const elements::SectionProperties p = bar.at(0.5);
      const double flexibility = L * L * L / (3.0 * p.EI) + L / p.kGA;
      const double F = 1e-6 * L / flexibility;  // deflection 1e-6 L: nonlinear terms 1e-12
      // Round-off: bending against stretching, (slenderness)^2 of n^2 times epsilon, and 1e-11 of
      // the solver and geometry.
      const double allowed = 1e-11 + 1e-15 * slenderness * slenderness * n * n;
      EXPECT_NEAR(tip_deflection(std::vector<double>(static_cast<std::size_t>(n), L / n), bar, F),
                  1e-6 * L, allowed * 1e-6 * L)
          << slenderness << " " << n;
    }
}

// Neighbouring elements of 1 m and 1 um: the exact deflection all the same. Stiffness of the short
// one against the long one: (1e6)^3, its rounding is what remains.
TEST(Shafts, ElementLengthRatios) {
  const elements::ElementSection bar = round_bar(0.05);
  const elements::SectionProperties p = bar.at(0.5);
  for (double ratio : {1e-2, 1e-4, 1e-6})
    for (const auto& lengths : {std::vector<double>{1.0, ratio}, {ratio, 1.0}, {0.5, ratio, 0.5}}) {
      double L = 0.0;
      for (double l : lengths)
        L += l;
      const double flexibility = L * L * L / (3.0 * p.EI) + L / p.kGA, F = 1e-6 / flexibility;
      EXPECT_NEAR(tip_deflection(lengths, bar, F), 1e-6, 1e-6 * 1e-6) << ratio;
    }
  // dropped: three periods of the first mode, with and without the short element
  const auto drop = [&](const std::vector<double>& lengths, const char* method) {
    system::Builder b;
    b.add_line("shaft");
    add_shaft(b, bar, lengths);
    clamp(b, 0);
    b.set_gravity(Vec3(0, 0, -9.81));
    const system::System s = b.finalize();
    return run_ok(s, s.make_state(), {0.08, 1.0, method},
                  fmt::format("{} {} elements", method, lengths.size()))
        .q[6 * static_cast<Index>(lengths.size()) + 2];
  };
  for (const char* method : {"radau5", "gauss6", "generalized_alpha"}) {
    const double plain = drop({0.5, 0.5}, method), mixed = drop({0.5, 1e-6, 0.5 - 1e-6}, method);
    const double sag =
        7850.0 * elements::annulus_area(0.05, 0.0) * 9.81 / (8.0 * p.EI);  // m, static
    EXPECT_NEAR(mixed, plain, 2.0 * aimed * 2.0 * sag)
        << method;  // two runs, each within the aim of a peak of twice the sag
  }
}

// Axial force below buckling: the tip of a beam-column deflects by F/P (tan(kL)/k - L), k^2 = P/EI;
// at 0.99 of the critical load that is a hundred times the linear value.
TEST(Shafts, ForcesUpToBuckling) {
  const double L = 1.0, EI = 100.0, critical = pi * pi * EI / (4.0 * L * L);
  constexpr int n = 16;
  for (double fraction : {1e-6, 0.1, 0.5, 0.9, 0.99}) {
    const double P = fraction * critical, k = std::sqrt(P / EI);
    // tan(x) - x by its series where P is small
    const double x = k * L,
                 excess = x < 1e-2 ? x * x * x / 3.0 * (1.0 + 0.4 * x * x) : std::tan(x) - x;
    const double F = 1e-6 * L / (excess / (k * P));
    system::Builder b;
    b.add_line("shaft");
    add_shaft(b, wire(EI), std::vector<double>(n, L / n));
    clamp(b, 0);
    b.add(elements::PointForce{Vec3(-P, 0, F), nullptr}, {Index(n)}, "forces");
    const system::System s = b.finalize();
    // elements of length L/16 find the critical load to 1e-6 of itself; that error is amplified by
    // 1/(1 - fraction); shortening of the wire by P/EA adds 2e-8 of it
    EXPECT_NEAR(equilibrium(s).state.q[6 * n + 2], 1e-6 * L,
                1e-6 * L * (2e-6 / (1.0 - fraction) + 1e-7))
        << fraction;
  }
}

// Beyond buckling: the elastica of a cantilever whose end has turned by alpha. P = (K(sin
// alpha/2)/L)^2 EI, sideways 2 sin(alpha/2)/sqrt(P/EI) (S. P. Timoshenko, J. M. Gere, Theory of
// Elastic Stability, 2nd ed. 1961, sec. 2.7: 0.593 L at 60 degrees).
TEST(Shafts, BeyondBucklingIsTheElastica) {
  const double L = 1.0, EI = 100.0;
  constexpr int n = 32;
  for (double alpha : {0.35, 60.0 * pi / 180.0, 100.0 * pi / 180.0}) {
    const double k = std::sin(0.5 * alpha), K = elliptic_K(k), P = K * K * EI / (L * L),
                 sideways = 2.0 * k * L / K;
    if (std::abs(alpha - 60.0 * pi / 180.0) < 1e-12) {
      EXPECT_NEAR(sideways, 0.593, 5e-4);  // the book
    }
    system::Builder b;
    b.add_line("shaft");
    add_shaft(b, wire(EI), std::vector<double>(n, L / n));
    clamp(b, 0);
    b.add(elements::PointForce{Vec3(-P, 0, 0), nullptr}, {Index(n)}, "forces");
    const system::System s = b.finalize();
    // start from an arc that turns by alpha: two solutions beside the straight one exist, and this
    // one is asked for
    system::State start = s.make_state();
    const double R = L / alpha;
    for (Index i = 0; i <= n; ++i) {
      const double a = alpha * static_cast<double>(i) / n;
      start.q[6 * i] = R * std::sin(a) - L * static_cast<double>(i) / n;
      start.q[6 * i + 2] = R * (1.0 - std::cos(a));
      start.q[6 * i + 4] = -a;  // about -e2: d turns from e towards e3
    }
    const system::State state = equilibrium(s, &start).state;
    const VecX& q = state.q;
    // 32 elements: corotational bending is second order in the turn of one element, (alpha/32)^2/12
    // and the bowing term takes most of it
    EXPECT_NEAR(q[6 * n + 2], sideways, 1e-3 * sideways) << alpha;
    const Vec3 d = state.normals()[n];
    EXPECT_NEAR(std::atan2(d.z(), d.x()), alpha, 1e-3 * alpha) << alpha;
  }
}

// A force beyond buckling on a perfectly straight, damped shaft that is nudged: it must find the
// bent state by itself.
TEST(Shafts, SnapsToTheElastica) {
  const double L = 1.0, EI = 100.0, alpha = 60.0 * pi / 180.0, k = std::sin(0.5 * alpha),
               K = elliptic_K(k), P = K * K * EI / (L * L);
  constexpr int n = 12;
  system::Builder b;
  b.add_line("shaft");
  add_shaft(b, wire(EI), std::vector<double>(n, L / n));
  clamp(b, 0);
  b.add(elements::PointForce{Vec3(-P, 0, 1e-3), nullptr}, {Index(n)}, "forces");
  for (Index i = 1; i <= n; ++i)
    add_spring(b, i, Mat3::Zero(), isotropic(3.0));
  const system::System s = b.finalize();
  const system::State end = run_ok(s, s.make_state(), {6.0, L}, "snap");
  // 12 elements leave 3e-3 near the bifurcation, where the deflection goes with the root of the
  // distance to the critical load; the nudge of 1e-3 N shifts it by as much
  EXPECT_NEAR(end.q[6 * n + 2], 2.0 * k * L / K, 1e-2 * L);
  EXPECT_LT(end.v.cwiseAbs().maxCoeff(), 1e-2);
}

// A hundred turns of wind-up: the twist is T L/GJ, every turn counted, and the reaction is the
// torque.
TEST(Shafts, WindUpOfAHundredTurns) {
  const double L = 1.0, GJ = 1.0, twist = 100.0 * two_pi;
  elements::ElementSection bar = wire(1e6);  // stiff in bending: no loops
  bar.given.GJ = GJ;
  for (int n : {1, 2, 8}) {
    for (double sign : {1.0, -1.0}) {
      system::Builder b;
      b.add_line("shaft");
      add_shaft(b, bar, std::vector<double>(static_cast<std::size_t>(n), L / n));
      clamp(b, 0);
      b.hold(n, 1);
      b.hold(n, 2);
      b.add(elements::FixedLoad{Vec3::Zero(), Vec3(sign * GJ * twist / L, 0, 0), 0.0, nullptr},
            {Index(n)}, "loads");
      const system::System s = b.finalize();
      const analysis::Equilibrium e = equilibrium(s);
      EXPECT_NEAR(e.state.total_phi(n, 0), sign * twist, 1e-12 * twist) << n;
      EXPECT_NEAR(e.reactions[system::spin_phi], -sign * GJ * twist / L, 1e-12 * GJ * twist / L)
          << n;
    }
  }
}

// Nothing holds the shaft against turning: said, not guessed.
TEST(Shafts, FreeMotionIsDiagnosed) {
  system::Builder b;
  b.add_line("shaft");
  add_shaft(b, round_bar(0.02), {0.5, 0.5});
  b.hold(0, 1);
  b.hold(0, 2);
  b.hold(0, 0);  // a pivot: the shaft can swing
  b.add(elements::PointForce{Vec3(0, 0, 1.0), nullptr}, {Index(2)}, "forces");
  const system::System s = b.finalize();
  try {
    const analysis::Equilibrium e = equilibrium(s);
    // it may hang along the force: then it is an equilibrium indeed
    EXPECT_GT(e.state.q[6 * 2 + 2], 0.5);
  } catch (const Error& e) {
    EXPECT_FALSE(e.diagnostics().empty());
    EXPECT_NE(std::string(e.what()).find("node"), std::string::npos) << e.what();
  }
}
