// Beams in large rotation against exact solutions of the shear-deformable, extensible rod.
//
// Bend: K.-J. Bathe, S. Bolourchi, Int. J. Numer. Methods Eng. 14 (1979) 961, doi
// 10.1002/nme.1620140703; reference values by shooting on the exact rod equations (8th order,
// residual 1e-9), which other codes confirm to 0.1 %.
// Strip: E. Dowell, J. Traybar, An experimental study of the nonlinear stiffness of a rotor blade
// (Princeton, 1975); O. Bauchau et al., Multibody Syst Dyn 37 (2016) 29, doi
// 10.1007/s11044-016-9514-y; values by shooting for the stiffnesses stated here.
#include "beam_line.hpp"
#include "exact_rod.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace whirl;
using namespace whirl::test;

namespace {

/// Quarter of a right angle of radius 100 in the plane z = 0 from the origin along +y, centre (100,
/// 0, 0).
LinePoint bend(double s) {
  const double t = s / 100.0;
  LinePoint p;
  p.r = Vec3(100.0 * (1.0 - std::cos(t)), 100.0 * std::sin(t), 0);
  p.triad << Vec3(std::sin(t), std::cos(t), 0), Vec3(-std::cos(t), std::sin(t), 0), Vec3::UnitZ();
  return p;
}

BeamSection bend_section(double kGA, double GJ) { return {1e7, kGA, kGA, GJ, 1e7 / 12, 1e7 / 12}; }

Vec3 bend_tip(int n, const BeamSection& section, double F) {
  system::Builder b;
  Mat3 chart;
  chart << Vec3::UnitY(), -Vec3::UnitX(), Vec3::UnitZ();
  const Index line = b.add_line("bend", chart);
  const Index tip = add_beam(b, line, chart, bend, 0.0, 25.0 * pi, n, section);
  clamp(b, 0);
  b.add(elements::PointForce{Vec3(0, 0, F), nullptr}, {tip}, "forces");
  const system::System s = b.finalize();
  return s.node(tip).position + displacement(settle(s), tip);
}

}  // namespace

TEST(LargeDeflection, BendOf45Degrees) {
  struct Case {
    double kGA, GJ, F;
    Vec3 tip;
  };
  const double a = 1e7 / 12;
  for (const Case& c : {Case{5e6, a, 150, {26.69552457, 66.36601029, 25.10499688}},
                        Case{5e6, a, 300, {22.24478095, 58.77912249, 40.19189167}},
                        Case{5e6, a, 450, {18.50817893, 52.23855801, 48.50292734}},
                        Case{5e6, a, 600, {15.68480053, 47.15043857, 53.47485879}},
                        Case{5e6, a, 3000, {4.232875917, 23.02430822, 68.53908949}},
                        Case{5e6 * 5 / 6, 833333.3, 600, {15.68468948, 47.15009624, 53.475478}},
                        Case{5e6, 0.1405770 * 5e6, 600, {15.55778582, 46.89192478, 53.60736927}}}) {
    // order 4; at F = 3000 the tip has moved by 95, and the references have 1e-9 of it
    const double coarse = (bend_tip(16, bend_section(c.kGA, c.GJ), c.F) - c.tip).norm(),
                 fine = (bend_tip(32, bend_section(c.kGA, c.GJ), c.F) - c.tip).norm();
    EXPECT_LT(fine, c.F < 3000 ? 5e-6 : 5e-5) << c.F;
    EXPECT_GT(std::log2(coarse / fine), 3.6) << c.F;
  }
}

// The element tends to Engesser's column (axial force along the tangent), the exact rod is
// Haringx's (along the section normal). On a straight cantilever that is all that is left when the
// mesh is fine, and it goes as the square of F/kGA.
TEST(LargeDeflection, EngesserAgainstHaringx) {
  double left[2] = {};
  for (int k = 0; k < 2; ++k) {
    const BeamSection section = bend_section(k == 0 ? 5e4 : 1e5, 1e7 / 12);
    system::Builder b;
    const Index line = b.add_line("beam");
    const Index tip = add_beam(
        b, line, Mat3::Identity(),
        [](double s) {
          return LinePoint{Vec3(s, 0, 0), Mat3::Identity()};
        },
        0.0, 25.0 * pi, 48, section);
    clamp(b, 0);
    const Vec3 F(0, 0, 150);
    b.add(elements::PointForce{F, nullptr}, {tip}, "forces");
    const system::System s = b.finalize();
    const ExactRod rod{section, 25.0 * pi};
    left[k] = (s.node(tip).position + displacement(settle(s), tip) - rod.solve(F).r).norm();
  }
  EXPECT_NEAR(left[0], 3.85e-4, 0.1e-4);  // (F/kGA)^2 x 78.5 = 7e-4
  EXPECT_NEAR(left[0] / left[1], 4.0, 0.15);
}

TEST(LargeDeflection, RollUpToAFullCircle) {
  // M = 2 pi EI/L bends the cantilever to a circle; two turns with twice as much. r(L) = EI/M
  // (sin(ML/EI), 1 - cos(ML/EI)).
  const double L = 10, EI = 86900;
  BeamSection section{1.77e6, 1.77e6, 1.77e6, 8160, EI, 215000};
  for (const double turns : {0.5, 1.0, 2.0}) {
    system::Builder b;
    // All directors stay in the plane x-z: measured from the axis across it none is ever further
    // than a right angle.
    Mat3 chart;
    chart << Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX();
    const Index line = b.add_line("strip", chart);
    const auto straight = [](double s) { return LinePoint{Vec3(s, 0, 0), Mat3::Identity()}; };
    const Index tip = add_beam(b, line, chart, straight, 0.0, L, 20, section);
    clamp(b, 0);
    const double M = -two_pi * turns * EI / L;
    b.add(elements::FixedLoad{Vec3::Zero(), Vec3(0, M, 0), 0.0, nullptr}, {tip}, "loads");
    const system::System s = b.finalize();
    const system::State x = settle(s, 8);
    const Vec3 r = s.node(tip).position + displacement(x, tip);
    const double R = EI / std::abs(M), angle = two_pi * turns;
    EXPECT_LT((r - Vec3(R * std::sin(angle), 0, R * (1 - std::cos(angle)))).norm(),
              turns < 1 ? 5e-6 : 1e-12);  // half a circle: 20 elements; whole turns close exactly,
                                          // every element bends alike
  }
}

TEST(LargeDeflection, PrincetonStrip) {
  // L 0.508 m, 12.77 x 3.2024 mm; load at angle theta between the hard (0) and the soft direction
  // (90 deg): u2 soft, u3 hard, twist atan2(R32, R22).
  struct Case {
    double P, theta, u2, u3, twist;
  };
  const BeamSection section{2932146.262, 932616.4954, 932616.4954,
                            3.221507621, 39.84613284, 2.505852698};
  for (const Case& c : {Case{4.448, 0, 0, 0.004880035011, 0},
                        Case{4.448, 45, 0.05436317358, 0.003612564823, 0.3157295339},
                        Case{4.448, 90, 0.07578865183, 0, 0},
                        Case{8.896, 15, 0.04079901102, 0.009678051327, 0.6528566262},
                        Case{8.896, 60, 0.1263934841, 0.006085396479, 1.043357051},
                        Case{13.345, 30, 0.1144726693, 0.01532057917, 2.490234212},
                        Case{13.345, 45, 0.1525123157, 0.01406221437, 2.701297112},
                        Case{13.345, 75, 0.1916895108, 0.005833791565, 1.237811939}}) {
    double error[2] = {}, twist_error[2] = {};
    for (int k = 0; k < 2; ++k) {
      system::Builder b;
      const Index line = b.add_line("strip");
      const Index tip = add_beam(
          b, line, Mat3::Identity(),
          [](double s) {
            return LinePoint{Vec3(s, 0, 0), Mat3::Identity()};
          },
          0.0, 0.508, 8 << k, section);
      clamp(b, 0);
      const double t = c.theta * pi / 180;
      b.add(elements::PointForce{c.P * Vec3(0, std::sin(t), std::cos(t)), nullptr}, {tip},
            "forces");
      const system::System s = b.finalize();
      const system::State x = settle(s);
      const Vec3 u = displacement(x, tip);
      const Mat3 R = rotation_of(x, tip, line, Mat3::Identity());
      error[k] = std::hypot(u.y() - c.u2, u.z() - c.u3);
      twist_error[k] = std::abs(std::atan2(R(2, 1), R(1, 1)) * 180 / pi - c.twist);
    }
    // the references have 1e-9 m; what 16 elements leave is 1e-7 of the deflection and 5e-6 of the
    // twist, and falls with order 4
    EXPECT_LT(error[1], 1e-6 * std::hypot(c.u2, c.u3));
    EXPECT_LT(twist_error[1], 1e-5 * c.twist + 1e-12);
    if (error[1] > 1e-9) {
      EXPECT_GT(std::log2(error[0] / error[1]), 3.8);
    }
  }
}
