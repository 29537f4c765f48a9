// Rolling bearings: Hertz, load sharing, stiffness, varying compliance, classical checks.
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/rolling/hertz.hpp>
#include <elements/rolling/rolling_bearing.hpp>
#include <Eigen/LU>
#include <algorithm>
#include <numeric>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

// 8 balls between races of 40.1 and 63.9 mm, K = 1.334e10 N/m^1.5: the usual varying-compliance
// bearing (Fukata et al. 1985)
BallBearing fukata(double clearance) {
  BallGeometry g;
  g.balls = 8;
  g.ball_diameter = (0.0639 - 0.0401) / 2;
  g.pitch_diameter = (0.0639 + 0.0401) / 2;
  g.radial_clearance = clearance;
  g.stiffness = 1.334e10;
  return make_ball_bearing(g);
}

/// Displacement along y under W with a ball (psi = 0) or a gap (psi = pi/Z) under the load.
double press(const BallBearing& b, double W, double psi) {
  double lo = 0, hi = 1e-3;
  for (int i = 0; i < 200; ++i) {
    const double mid = 0.5 * (lo + hi);
    Vector<6> q = Vector<6>::Zero();
    q[1] = mid;
    q[5] = psi;
    RollingPotential p;
    b.potential(q, p, false);
    (p.g[1] < W ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
}

RollerBearing rollers(double clearance) {
  RollerGeometry g;
  g.rollers = 13;
  g.roller_diameter = 0.0125;
  g.roller_length = 0.014;
  g.pitch_diameter = 0.065;
  g.radial_clearance = clearance;
  return make_roller_bearing(g);
}

}  // namespace

TEST(Hertz, KnownContacts) {
  // sphere on sphere: K = (2/3) E' sqrt(R_eff of the pair), circular contact
  const double E = 208e9 / (1 - 0.09);
  EXPECT_NEAR(hertz_point_stiffness(0.01, 0.01), 2.0 / 3.0 * E * std::sqrt(0.01), 1e-12 * 1e11);
  EXPECT_NEAR(hertz_ellipticity(0.01, 0.01), 1.0, 1e-15);
  // the two branches of the solver meet
  EXPECT_NEAR(hertz_ellipticity(1.0, 1.0 + 2.001e-5) - hertz_ellipticity(1.0, 1.0 + 1.999e-5),
              2.0 / 3.0 * 2e-8, 2e-10);
  // ellipticity against Hamrock's fit (Ry/Rx)^(2/pi), good to 4 % (Hamrock, Schmid & Jacobson 2004,
  // ch. 17)
  for (double r : {2.0, 5.0, 20.0, 100.0})
    EXPECT_NEAR(hertz_ellipticity(1.0, r), std::pow(r, 2 / pi), 0.04 * std::pow(r, 2 / pi));
  // defining relation, with the elliptic integrals by quadrature
  const double kappa = hertz_ellipticity(0.004, 0.09), m2 = 1 - 1 / (kappa * kappa);
  double F = 0, S = 0;
  const int N = 4000;
  for (int i = 0; i < N; ++i) {
    const double a = (i + 0.5) * pi / 2 / N, d = std::sqrt(1 - m2 * std::sin(a) * std::sin(a));
    F += pi / 2 / N / d;
    S += pi / 2 / N * d;
  }
  const double rho = (1 / 0.004 - 1 / 0.09) / (1 / 0.004 + 1 / 0.09), k2 = kappa * kappa;
  EXPECT_NEAR(((k2 + 1) * S - 2 * F) / ((k2 - 1) * S), rho, 1e-9);
  // the handbook form K = (2 sqrt 2/3) E/(1-nu^2) (sum of curvatures)^(-1/2) delta*^(-3/2) (Harris:
  // 2.15e5 N/mm^1.5 for steel)
  const double star = 2 * F / pi * std::cbrt(pi / (2 * k2 * S)),
               handbook = 2 * std::sqrt(2.0) / 3 * E / std::sqrt(1 / 0.004 + 1 / 0.09) /
                          std::pow(star, 1.5);
  EXPECT_NEAR(hertz_point_stiffness(0.004, 0.09), handbook, 1e-6 * handbook);
  EXPECT_NEAR(hertz_series(3.0, 3.0, 1.5), 3.0 / std::pow(2.0, 1.5), 1e-14);
  EXPECT_NEAR(hertz_line_stiffness(0.001), 8.06e4 * std::pow(1000.0, 10.0 / 9.0), 1e-6);
}

TEST(RollingBearing, Conformance) {
  ConformanceOptions o;
  o.symmetric_K = true;
  o.u = 1e-5;
  o.du = 1e-2;
  o.ddu = 10;
  o.tilt = 2e-4;
  o.dtilt = 0.1;
  o.ddtilt = 10;
  // every element loaded throughout: differences do not cross the onset; what they feel together
  // may hardly change while they roll
  o.over_declared.angle = system::angle_sum(0.5, 0.5);
  auto deep = fukata(-8e-5);
  deep.c_radial = 500;
  deep.c_axial = 200;
  check_kernel(deep, o);
  BallGeometry g;
  g.balls = 16;
  g.ball_diameter = 0.02223;
  g.pitch_diameter = 0.12527;
  g.contact_angle = 40 * pi / 180;
  g.f_inner = g.f_outer = 0.5232;
  auto angular = make_ball_bearing(g);
  set_axial_preload(angular, 2e5);
  check_kernel(angular, o);
  o.u = 5e-6;
  o.tilt = 1e-4;
  check_kernel(rollers(-4e-5), o);
}

TEST(RollingBearing, PartlyLoadedTangent) {
  // a few balls loaded: third-order smooth only, so plain central differences
  const auto b = fukata(2e-6);
  Vector<6> q;
  q << 3e-6, 8e-6, -5e-6, 2e-5, 1e-5, 0.3;
  RollingPotential p, a, c;
  b.potential(q, p, true);
  const double step[6] = {1e-9, 1e-9, 1e-9, 1e-8, 1e-8, 1e-5};
  for (int j = 0; j < 6; ++j) {
    Vector<6> up = q, dn = q;
    up[j] += step[j];
    dn[j] -= step[j];
    b.potential(up, a, false);
    b.potential(dn, c, false);
    EXPECT_NEAR((a.V - c.V) / (2 * step[j]), p.g[j], 1e-6 * std::abs(p.g[j]) + 1e-9);
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR((a.g[i] - c.g[i]) / (2 * step[j]), p.H(i, j),
                  1e-7 * std::sqrt(std::abs(p.H(i, i) * p.H(j, j))) +
                      1e-9 * std::abs(p.H(1, 1)) * (i > 2 ? 1e-2 : 1))
          << i << j;
  }
}

// The mean over the angle of the cage: whatever the direction of the load, with few elements in
// contact, the energy and its derivatives turn with it; a dense sum over cage angles is the reference.
double apart(const Mat3& a, const Mat3& b) { return (a - b).norm() / b.norm(); }
double apart(const Mat2& a, const Mat2& b) { return (a - b).norm() / b.norm(); }

template <class Bearing>
void expect_mean_turns(const Bearing& b, double shift, double tilt) {
  Vector<6> q;
  q << 2e-6, shift, 0, tilt, 0.3 * tilt, 0;
  RollingPotential own, p;
  b.mean_potential(q, own, true);
  ASSERT_GT(own.g.norm(), 0.0);
  Matrix<6> sum = Matrix<6>::Zero();
  Vector<6> load = Vector<6>::Zero();
  constexpr int angles = 4000;
  for (int k = 0; k < angles; ++k) {
    q[5] = two_pi / b.elements * (k + 0.5) / angles;
    b.potential(q, p, true);
    sum += p.H / angles;
    load += p.g / angles;
  }
  q[5] = 0;
  EXPECT_LT((load - own.g).head<3>().norm(), 1e-7 * load.head<3>().norm());
  const Mat3 spring = own.H.topLeftCorner<3, 3>(), summed = sum.topLeftCorner<3, 3>();
  EXPECT_LT(apart(spring, summed), 1e-4);
  for (const double a : {0.1, 0.77, 2.9, 5.0}) {
    Matrix<6> turn = Matrix<6>::Identity();
    const Mat2 r = Eigen::Rotation2Dd(a).toRotationMatrix();
    turn.block<2, 2>(1, 1) = turn.block<2, 2>(3, 3) = r;
    b.mean_potential(turn * q, p, true);
    EXPECT_LT((p.g - turn * own.g).head<3>().norm(), 1e-10 * own.g.head<3>().norm()) << a;
    const Matrix<6> H = turn * own.H * turn.transpose();
    const Mat3 turned = H.topLeftCorner<3, 3>(), found = p.H.topLeftCorner<3, 3>();
    const Mat2 tilts = H.block<2, 2>(3, 3), found_tilts = p.H.block<2, 2>(3, 3);
    EXPECT_LT(apart(found, turned), 1e-8) << a;
    EXPECT_LT(apart(found_tilts, tilts), 1e-8) << a;
  }
}

TEST(RollingBearing, MeanTurnsWithTheLoad) {
  BallGeometry g;
  g.balls = 7;
  g.ball_diameter = 0.01;
  g.pitch_diameter = 0.05;
  g.radial_clearance = 5e-6;
  for (const double shift : {5.2e-6, 8e-6, 3e-5})
    for (const double tilt : {0.0, 1e-4})
      expect_mean_turns(make_ball_bearing(g), shift, tilt);
  RollerGeometry r;
  r.rollers = 9;
  r.roller_diameter = 0.01;
  r.roller_length = 0.01;
  r.pitch_diameter = 0.05;
  r.radial_clearance = 5e-6;
  for (const double shift : {8e-6, 3e-5})
    for (const double tilt : {0.0, 3e-4})
      expect_mean_turns(make_roller_bearing(r), shift, tilt);
}

TEST(RollingBearing, LoadSharing) {
  // radial clearance um, load N, ball under load (1) or gap (0), displacement m, tangent N/m: roots
  // of the 8-ball sum
  const double table[][5] = {
      {0, 58.8, 1, 1.789759857e-06, 49280354.37},  {0, 196, 1, 3.993747404e-06, 73615071.33},
      {0, 58.8, 0, 1.802089581e-06, 48943182.92},  {0, 196, 0, 4.021260482e-06, 73111404.08},
      {1, 58.8, 1, 2.97298009e-06, 49114386.5},    {1, 196, 0, 5.242020287e-06, 72842652},
      {5, 58.8, 1, 7.567395999e-06, 43916464.13},  {5, 196, 1, 9.87145827e-06, 72322642.58},
      {5, 58.8, 0, 7.344383524e-06, 45642192.09},  {10, 196, 1, 1.559219672e-05, 67581319.78},
      {10, 58.8, 0, 1.275634453e-05, 45642192.09}, {10, 196, 0, 1.513601304e-05, 68180378.76}};
  for (const auto& t : table) {
    const auto b = fukata(t[0] * 1e-6);
    const double psi = t[2] ? 0.0 : pi / 8, x = press(b, t[1], psi);
    EXPECT_NEAR(x, t[3], 1e-9 * t[3]);
    Vector<6> q = Vector<6>::Zero();
    q[1] = x;
    q[5] = psi;
    RollingPotential p;
    b.potential(q, p, true);
    EXPECT_NEAR(p.H(1, 1), t[4], 1e-9 * t[4]);
    const auto loads = b.loads(q);
    double sum = 0;
    for (int j = 0; j < 8; ++j)
      sum += loads[static_cast<std::size_t>(j)] * std::cos(psi + two_pi * j / 8);
    EXPECT_NEAR(sum, t[1], 1e-9 * t[1]);
  }
}

TEST(RollingBearing, StribeckNumber) {
  // Z Qmax/F at zero clearance: 4.37 (balls), 4.08 (rollers)
  const int Z[] = {8, 12, 16};
  const double ball[] = {4.345708935, 4.364492313, 4.368085065},
               roller[] = {4.077006838, 4.082806932, 4.084109416};
  for (int i = 0; i < 3; ++i) {
    Vector<6> q = Vector<6>::Zero();
    q[1] = 1e-5;
    const auto number = [&](const auto& bearing) {
      RollingPotential p;
      bearing.potential(q, p, false);
      return Z[i] * bearing.loads(q)[0] / p.g[1];
    };
    BallGeometry g;
    g.balls = Z[i];
    g.ball_diameter = 0.008;
    g.pitch_diameter = 0.06;
    g.stiffness = 1e10;
    EXPECT_NEAR(number(make_ball_bearing(g)), ball[i], 1e-8);
    RollerGeometry r;
    r.rollers = Z[i];
    r.roller_diameter = 0.008;
    r.roller_length = 0.01;
    r.pitch_diameter = 0.06;
    EXPECT_NEAR(number(make_roller_bearing(r)), roller[i], 1e-8);
  }
}

TEST(RollingBearing, CageSpeedAndWholeTurns) {
  const auto b = fukata(0);
  // ball passes per shaft revolution over the outer ring, 8 d_i/(d_i + d_o)
  EXPECT_NEAR(8 * b.cage[0], 3.0846153846153848, 1e-12);
  Vector<12> q = Vector<12>::Zero(), zero = q;
  const Mat3 chart = Mat3::Identity();
  q[3] = 1.234;
  NodeFrame<2, 7> x(q, zero, zero, chart, Vec3::Zero());
  const double psi = b.deflection(x.nodes())[5];
  x.state[0].turns = 52000 * 1000.0;
  x.state[1].turns = 0;  // 1000 common turns of shaft (52000) and cage (20050)
  EXPECT_NEAR(std::remainder(b.deflection(x.nodes())[5] - psi, two_pi), 0.0, 1e-7);
  x.state[0].turns = 1;
  EXPECT_NEAR(std::remainder(b.deflection(x.nodes())[5] - psi - two_pi * b.cage[0], two_pi), 0.0,
              1e-14);
  // both rings together: the cage goes with them
  EXPECT_NEAR(b.cage[0] + b.cage[1], 1.0, 1e-15);
}

TEST(RollingBearing, AngularContactUnderThrust) {
  // 218 angular-contact bearing, Harris: Z = 16, D = 22.23 mm, alpha0 = 40 deg, B = 0.0464, axial
  // constant 896.7 N/mm^2; thrust 17800 N. Exact root of sin a (cos 40/cos a - 1)^1.5 = Fa/(Z D^2
  // K): 41.59207702 deg, 0.03831822 mm
  BallGeometry g;
  g.balls = 16;
  g.ball_diameter = 0.02223;
  g.pitch_diameter = 0.12527;
  g.contact_angle = 40 * pi / 180;
  g.f_inner = g.f_outer = 0.5232;
  // K (B D)^1.5 = 896.7 N/mm^2 D^2
  g.stiffness = 896.7e6 * 0.02223 * 0.02223 / std::pow(0.0464 * 0.02223, 1.5);
  for (int side : {1, -1}) {
    g.direction = side;
    const auto b = make_ball_bearing(g);
    double lo = 0, hi = 1e-3;
    Vector<6> q = Vector<6>::Zero();
    for (int i = 0; i < 100; ++i) {
      q[0] = side * 0.5 * (lo + hi);
      RollingPotential p;
      b.potential(q, p, false);
      (side * p.g[0] < 17800 ? lo : hi) = std::abs(q[0]);
    }
    EXPECT_NEAR(std::abs(q[0]), 0.03831822e-3, 1e-7 * 0.0383e-3);
    const double angle = std::atan2(std::abs(b.contact.a0 + q[0]), b.contact.r0) * 180 / pi;
    EXPECT_NEAR(angle, 41.59207702, 1e-7);
    RollingPotential p;  // pulled the other way it comes loose
    q[0] = -side * 1e-5;
    b.potential(q, p, false);
    EXPECT_EQ(p.g[0], 0.0);
  }
  // preload: the undisplaced bearing pushes back with it
  g.stiffness = 0;  // Hertz from the geometry
  auto b = make_ball_bearing(g);
  set_axial_preload(b, 500);
  RollingPotential p;
  b.potential(Vector<6>::Zero(), p, true);
  EXPECT_NEAR(std::abs(p.g[0]), 500, 1e-7);
  EXPECT_GT((Matrix<5>(p.H.topLeftCorner<5, 5>()).determinant()), 0.0);
}

TEST(RollingBearing, RollerTiltMoment) {
  // an aligned roller row carries no moment; a tilt is resisted, and 5 slices differ from 41 by
  // little
  auto b = rollers(0);
  Vector<6> q = Vector<6>::Zero();
  q[1] = 2e-5;
  RollingPotential p, fine;
  b.potential(q, p, true);
  EXPECT_NEAR(p.g[3], 0.0, 1e-12 * p.g[1]);
  EXPECT_EQ(p.g[0], 0.0);
  EXPECT_GT(p.H(3, 3), 0.0);
  q[3] = 5e-4;
  b.contact.slices = 9;
  b.potential(q, p, true);
  b.contact.slices = 201;
  b.potential(q, fine, true);
  EXPECT_GT(p.g[3], 0.0);
  EXPECT_NEAR(p.g[3], fine.g[3],
              0.03 * fine.g[3]);  // lamina rule, error ~ 1/(4 slices^2) plus the edge of contact
  EXPECT_NEAR(p.g[1], fine.g[1], 0.005 * fine.g[1]);
}

// The kernel takes ninth roots of its own, several rollers at a time.
TEST(RollingBearing, RollerLoadsToTheLastDigits) {
  RollerContact c;
  c.K = 3.7e8;
  c.clearance = 2e-6;
  c.length = 0.02;
  c.slices = 1;
  for (int k = -40; k <= -5; ++k)
    for (int j = 0; j < 64; ++j) {
      const double rho = c.clearance + std::ldexp(1.0 + j / 64.0, k), delta = rho - c.clearance;
      const double Q =
          static_cast<double>(c.K * std::pow(static_cast<long double>(delta), 10.0L / 9.0L));
      EXPECT_NEAR(c.load(0.0, rho, 0.0), Q, 1e-15 * Q) << delta;
    }
  EXPECT_EQ(c.load(0.0, c.clearance, 0.0), 0.0);
  EXPECT_EQ(c.load(0.0, -1e-5, 0.0), 0.0);
  // slices: each with its own deflection
  c.slices = 9;
  const double rho = 3e-6, t = 2e-4;
  double sum = 0;
  for (int i = 0; i < c.slices; ++i) {
    const double delta = rho + c.length * ((i + 0.5) / c.slices - 0.5) * t - c.clearance;
    if (delta > 0) sum += c.K / c.slices * std::pow(delta, 10.0 / 9.0);
  }
  EXPECT_NEAR(c.load(0.0, rho, t), sum, 1e-14 * sum);
}

TEST(RollingBearing, VaryingComplianceCycle) {
  // m = 20 kg, c = 2000 N s/m, W = 196 N along y, clearance 5 um, shaft 10 rev/s: limit cycle by an
  // independent 8th-order run
  auto b = fukata(5e-6);
  const double m = 20, c = 2000, W = 196, rate = b.cage[0] * two_pi * 10,
               period = two_pi / 8 / rate;
  Vec2 r(9.8e-6, 0), v = Vec2::Zero();
  const auto accel = [&](double t, const Vec2& x, const Vec2& w) {
    Vector<6> q = Vector<6>::Zero();
    q[1] = x.x();
    q[2] = x.y();
    q[5] = std::fmod(rate * t, two_pi);
    RollingPotential p;
    b.potential(q, p, false);
    return Vec2((Vec2(W, 0) - p.g.segment<2>(1) - c * w) / m);
  };
  const int steps = 2000;
  const double h = period / steps;
  double xmin = 1, xmax = -1, ymin = 1, ymax = -1, mean = 0;
  for (int cycle = 0; cycle < 21; ++cycle)
    for (int i = 0; i < steps; ++i) {
      const double t = (cycle * steps + i) * h;
      const Vec2 k1 = accel(t, r, v), k2 = accel(t + h / 2, r + h / 2 * v, v + h / 2 * k1),
                 k3 = accel(t + h / 2, r + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2),
                 k4 = accel(t + h, r + h * v + h * h / 2 * k2, v + h * k3);
      r += h * v + h * h / 6 * (k1 + k2 + k3);
      v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      if (cycle < 20) continue;
      xmin = std::min(xmin, r.x());
      xmax = std::max(xmax, r.x());
      ymin = std::min(ymin, r.y());
      ymax = std::max(ymax, r.y());
      mean += r.x() / steps;
    }
  EXPECT_NEAR(xmin, 9.71753874e-06, 1e-5 * 1e-5);
  EXPECT_NEAR(xmax, 9.87555871e-06, 1e-5 * 1e-5);
  EXPECT_NEAR(mean, 9.82006387e-06, 1e-5 * 1e-5);
  EXPECT_NEAR(ymin, -7.17400478e-07, 1e-4 * 7e-7);
  EXPECT_NEAR(ymax, 6.63437104e-07, 1e-4 * 7e-7);
}

TEST(RollingBearing, BadGeometry) {
  const auto code = [](auto change) {
    BallGeometry g;
    g.balls = 8;
    g.ball_diameter = 0.0119;
    g.pitch_diameter = 0.052;
    change(g);
    try {
      make_ball_bearing(g);
      return std::string("none");
    } catch (const Error& e) {
      return e.diagnostics().front().code;
    }
  };
  EXPECT_EQ(code([](BallGeometry&) {}), "none");
  EXPECT_EQ(code([](BallGeometry& g) { g.balls = 1; }), "E83");
  EXPECT_EQ(code([](BallGeometry& g) { g.balls = 40; }), "E83");
  EXPECT_EQ(code([](BallGeometry& g) { g.f_inner = 0.5; }), "E83");
  EXPECT_EQ(code([](BallGeometry& g) { g.radial_clearance = 1e-3; }), "E83");
  EXPECT_EQ(code([](BallGeometry& g) {
              g.contact_angle = 0.4;
              g.radial_clearance = 1e-6;
            }),
            "E83");
  EXPECT_EQ(code([](BallGeometry& g) { g.stiffness = -1; }), "E83");
  auto deep = fukata(0);
  EXPECT_THROW(set_axial_preload(deep, 10), Error);
}
