// Several extremes at once, against closed forms.
#include "scene.hpp"
#include <core/error.hpp>
#include <core/law.hpp>
#include <elements/loads/unbalance.hpp>
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

/// r'' + 2 zeta w r' + w^2 r = e W^2 exp(i W t) from rest, r = y + i z; zeta < 1.
Complex from_rest(double w, double zeta, double e, double W, double t) {
  const Complex i(0, 1), H = e * W * W / (w * w - W * W + 2.0 * i * zeta * w * W);
  const Complex root = std::sqrt(Complex(zeta * zeta - 1.0)) * w, a = -zeta * w + root,
                b = -zeta * w - root;
  // r = H exp(iWt) + A exp(at) + B exp(bt), r(0) = r'(0) = 0
  const Complex A = (H * b - i * W * H) / (a - b), B = -H - A;
  return H * std::exp(i * W * t) + A * std::exp(a * t) + B * std::exp(b * t);
}

}  // namespace

// A disk that may tilt, on springs and dampers, with an unbalance, at constant speed: stiffness 1e2
// to 1e14 N/m, masses 1e-9 to 1e9 kg, speeds to 1e6 rpm either way, damping from negative to 0.99,
// eccentricities 1e-12 to 1e-3 m, together. Three periods of the spring or thirty turns, whichever
// is longer, as long as that is not more than 200 periods of the other.
TEST(Combined, UnbalancedDisksOfEveryScale) {
  int runs = 0;
  unsigned pick = 1;
  const auto choose =
      [&pick](auto... x) {  // a fixed walk through the lists: the same cases every time
        const double list[] = {static_cast<double>(x)...};
        pick = pick * 1664525u + 1013904223u;
        return list[(pick >> 16) % sizeof...(x)];
      };
  while (runs < 60) {
    const double k = choose(1e2, 1e5, 1e8, 1e11, 1e14), m = choose(1e-9, 1e-4, 1.0, 1e4, 1e9),
                 zeta = choose(-0.02, 0.0, 1e-6, 0.05, 0.7, 0.99);
    const double W = choose(-1e6, -3000.0, 1.0, 600.0, 3e4, 1e6) * pi / 30.0,
                 e = choose(1e-12, 1e-6, 1e-3), w = std::sqrt(k / m);
    const double spring = two_pi / w, turn = two_pi / std::abs(W),
                 t = std::max(3.1 * spring, 30.3 * turn);
    if (t > 200.0 * std::min(spring, turn)) continue;  // the same scales again, only longer
    ++runs;
    const char* method = methods[runs % 4];
    system::Builder b;
    b.add_line("shaft");
    const Index n = b.add_node({Vec3::Zero(), 0, "disk", false});
    b.add(elements::RigidDisk{m, 1e-3 * m, 2e-3 * m, 0.0}, {n}, "rigid disks");
    b.add(elements::UnbalanceMass(m * e, 0.0), {n}, "unbalances");
    add_spring(b, n, isotropic(k), isotropic(2.0 * zeta * w * m));
    elements::SpringBlock tilt;
    tilt.C2 = 1e-3 * m * w * w;
    b.add(tilt, {n}, "springs");
    b.hold(n, system::ux);
    b.hold(n, system::spin_phi, make_angle_of_speed(make_constant(W), 0.0));
    const system::System s = b.finalize();
    system::State start = s.make_state();
    const std::string what =
        fmt::format("{} k {:g} m {:g} zeta {:g} W {:g} e {:g}", method, k, m, zeta, W, e);
    const system::State end = run_ok(s, start, {t, 1.0, method}, what);
    double largest = 0.0;
    for (int i = 1; i <= 1000; ++i)
      largest = std::max(largest, std::abs(from_rest(w, zeta, e, W, t * i / 1000.0)));
    const Complex exact = from_rest(w, zeta, e, W, t);
    // Aim and hit differ by up to 2.5 over a hundred periods; where the motion grows, early errors
    // grow with it. Displacements are watched down to 1e-13 m.
    const double allowed = (zeta < 0.0 ? 8.0 : 2.5) * aimed * (largest + 1e-13);
    EXPECT_NEAR(end.q[1], exact.real(), allowed) << what;
    EXPECT_NEAR(end.q[2], exact.imag(), allowed) << what;
    EXPECT_EQ(end.q[4], 0.0) << what;  // nothing tilts it
  }
}

// A shaft under a force at its middle: slenderness 2 to 1e4, supports 1e2 to 1e14 N/m and
// neighbouring elements of lengths up to 1:1e6 at once. F L^3/48EI + F L/(4 kGA) + F/2k.
TEST(Combined, SlendernessStiffnessAndElementRatios) {
  for (double slenderness : {2.0, 30.0, 1e3, 1e4})
    for (double k : {1e2, 1e6, 1e10, 1e14})
      for (double ratio : {1.0, 1e-3, 1e-6}) {
        const double L = 1.0, F = 1e-6;
        const elements::ElementSection bar = round_bar(L / slenderness);
        const elements::SectionProperties p = bar.at(0.5);
        const double bending = L * L * L / (48.0 * p.EI) + L / (4.0 * p.kGA),
                     support = 1.0 / (2.0 * k), exact = -F * (bending + support);
        system::Builder b;
        b.add_line("shaft");
        // the middle node stands at L/2 in both meshes
        std::vector<double> lengths{0.25, 0.25, 0.25, 0.25};
        if (ratio < 1.0)
          lengths = {0.25,         0.25 * ratio, 0.25 - 0.25 * ratio, 0.25 - 0.25 * ratio,
                     0.25 * ratio, 0.25};
        const std::size_t middle = lengths.size() / 2;
        add_shaft(b, bar, lengths);
        const auto last = static_cast<Index>(lengths.size());
        add_spring(b, 0, isotropic(k));
        add_spring(b, last, isotropic(k));
        b.hold(0, system::spin_phi);
        // deflections of 1e-6 of the diameter: the ends are held along the axis, and stretching
        // goes with the square of that
        const double force = F * 1e-6 * L / slenderness / std::abs(exact);
        b.add(elements::PointForce{Vec3(0, 0, -force), nullptr}, {static_cast<Index>(middle)},
              "forces");
        const system::System s = b.finalize();
        const std::string what =
            fmt::format("slenderness {:g} k {:g} ratio {:g}", slenderness, k, ratio);
        const double expected = exact * force / F;
        // rounding of stiffness entries, 1e-16 of 12 EI/l^3 of the shortest element, seen from the
        // softer of shaft and supports
        const double shortest = 0.25 * ratio, stiffest = 12.0 * p.EI / std::pow(shortest, 3),
                     softest = 1.0 / (bending + support);
        const double rounding = 1e-16 * std::min(stiffest, p.kGA / shortest) / softest;
        double u = 0.0;
        try {
          u = equilibrium(s).state.q[6 * static_cast<Index>(middle) + 2];
        } catch (const Error& e) {
          EXPECT_GT(rounding, 1e-3)
              << what << ": "
              << e.what();  // the supports are lost in the digits of the shaft: said, not guessed
          continue;
        }
        EXPECT_NEAR(u, expected, std::abs(expected) * (1e-9 + 10.0 * rounding)) << what;
      }
}

// Very stiff and very soft in one rotor: a light, stiffly held mass on a heavy, softly held one,
// spinning fast, dropped. Against the same with ten times the accuracy by another method.
TEST(Combined, TwoSchemesAgree) {
  for (double k_stiff : {1e8, 1e14})
    for (double ratio : {1e-9, 1e-3, 1.0})
      for (double rpm : {0.0, 1e4, 1e6}) {
        system::Builder b;
        b.add_line("shaft");
        add_shaft(b, round_bar(0.02), {0.2, 0.3});
        b.add(elements::RigidDisk{5.0, 0.02, 0.035, 0.0}, {1}, "rigid disks");
        b.add(elements::PointMass{5.0 * ratio}, {2}, "point masses");
        add_spring(b, 0, isotropic(k_stiff), isotropic(10.0));
        add_spring(b, 2, isotropic(1e5), isotropic(50.0));
        b.set_gravity(Vec3(0, 0, -9.81));
        const system::System s = b.finalize();
        system::State start = s.make_state();
        for (Index i = 0; i < 3; ++i)
          start.v[6 * i + system::spin_phi] = rpm * pi / 30.0;
        const std::string what =
            fmt::format("k {:g} mass ratio {:g} {:g} rpm", k_stiff, ratio, rpm);
        const system::State a = run_ok(s, start, {0.05, 1.0, "radau5"}, what),
                            c = run_ok(s, start, {0.05, 1.0, "gauss6", 0.1 * tolerance}, what);
        // both aim at errors relative to the drop of about 5 kg g/1e5 N/m twice; the disk is what
        // carries the motion
        EXPECT_LT((a.q - c.q).segment<3>(6).norm(),
                  1.1 * aimed * 2.0 * (c.q.segment<3>(6).norm() + 5e-4))
            << what;
      }
}
