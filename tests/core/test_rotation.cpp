// The kinematics against independent computations. Equation numbers: doi
// 10.18698/2308-6033-2018-10-1815.
#include "reference.hpp"
#include <core/error.hpp>
#include <core/rotation.hpp>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace rot = whirl::rotation;
using namespace whirl;
using namespace whirl::test;

namespace {

const std::vector<double> norms{1e-300, 1e-200, 1e-160, 1e-100, 1e-30, 1e-16,  1e-12,  1e-8,
                                1e-6,   1e-4,   1e-3,   0.01,   0.1,   0.1999, 0.2001, 0.5,
                                1.0,    1.5,    1.999,  2.001,  2.5,   2.9,    3.0,    3.1};

// Series of b_m in long double; cancels nothing worth mentioning below g = 4.
Real bessel_reference(int m, Real x) {
  Real first = 1;
  for (int j = 1; j <= 2 * m + 1; j += 2)
    first *= j;
  Real term = 1 / first, s = 0;
  for (int k = 0; k < 60; ++k) {
    s += term;
    term *= -x / 2 / (Real(k + 1) * (2 * m + 2 * k + 3));
  }
  return s;
}

RVec3 embed(const RVec2& g) { return RVec3(0, g.x(), g.y()); }
RVec3 director_reference(const RVec2& g) { return exponential(embed(g)).col(0); }
// d - e from the half-angle form
RVec3 offset_reference(const RVec2& g) {
  const Real n = std::hypot(g.x(), g.y()), h = std::sin(n / 2),
             s = n > 0 ? std::sin(n) / n : Real(1);
  return RVec3(-2 * h * h, s * g.y(), -s * g.x());
}
RMat3 rotation_reference(Real phi, const RVec2& g) {
  return exponential(embed(g)) * exponential(RVec3(phi, 0, 0));
}
RVec3 axial(const RMat3& w) {
  return RVec3(w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1)) / 2;
}

// A smooth motion of (phi, gamma) through given values, rates and accelerations.
struct Motion {
  double phi, dphi, ddphi;
  Vec2 g, dg, ddg;
  Real phi_at(Real t) const { return phi + dphi * t + ddphi * t * t / 2; }
  RVec2 gamma_at(Real t) const {
    return g.cast<Real>() + dg.cast<Real>() * t + ddg.cast<Real>() * (t * t / 2);
  }
  RMat3 R(Real t) const { return rotation_reference(phi_at(t), gamma_at(t)); }
  RVec3 omega(Real t) const {
    const RMat3 rate = central([&](Real h) { return R(t + h); }, 1e-2L);
    return axial(rate * R(t).transpose());
  }
};

Motion random_motion(Random& r, double g) {
  return {3 * r.number(),       2 * r.number(), r.number(),
          g * r.direction<2>(), r.vector<2>(),  r.vector<2>()};
}

/// Zhilin tensor, omega = B(v) v' (1): B = 1 + (1-cos g)/g^2 [v] + (g-sin g)/g^3 [v]^2.
Mat3 B(const Vec3& v) {
  const double x = v.squaredNorm();
  const Mat3 s = skew(v);
  return Mat3::Identity() + rot::one_minus_cos_ratio(x) * s + rot::g_minus_sin_ratio(x) * s * s;
}

/// Inverse of B: 1 - [v]/2 + (1/g^2 - cot(g/2)/(2g)) [v]^2; singular at g = 2 pi.
Mat3 B_inverse(const Vec3& v) {
  // (1 - h cot h)/(4 h^2) = b1/(4 b0) at h = g/2: no difference of large terms.
  const rot::BesselRatios h = rot::bessel_ratios(0.25 * v.squaredNorm());
  const Mat3 s = skew(v);
  return Mat3::Identity() - 0.5 * s + (0.25 * h.b1 / h.b0) * s * s;
}

/// Takes all whole turns out of phi and returns their number.
double take_whole_turns(double& phi) {
  const double n = std::nearbyint(phi / two_pi);
  rot::take_turns(phi, n);
  return n;
}

}  // namespace

TEST(Rotation, BesselRatiosAgreeWithTheirSeries) {
  for (double g = 1e-3; g < 3.12; g += 1e-3) {
    const double x = g * g;
    const rot::BesselRatios b = rot::bessel_ratios(x);
    const double value[] = {b.b0, b.b1, b.b2, b.b3};
    for (int m = 0; m < 4; ++m) {
      const Real ref = bessel_reference(m, x);
      // 1e-14 relative: at 3.1 rad sin g/g = 0.013 inherits the rounding of g = sqrt(x), 3 ulp of
      // pi
      EXPECT_NEAR(value[m], static_cast<double>(ref), 1e-14 * std::abs(static_cast<double>(ref)))
          << "m " << m << " g " << g;
    }
    EXPECT_NEAR(b.cosine, static_cast<double>(std::cos(std::sqrt(Real(x)))), 4e-16);
    EXPECT_NEAR(rot::one_minus_cos_ratio(x),
                static_cast<double>((1 - std::cos(std::sqrt(Real(x)))) / x), 1e-15 + 1e-19 / x);
    Real f3 = 0, term = 1.0L / 6;
    for (int k = 0; k < 40; ++k) {
      f3 += term;
      term *= -Real(x) / ((2 * k + 4) * (2 * k + 5));
    }
    EXPECT_NEAR(rot::g_minus_sin_ratio(x), static_cast<double>(f3), 3e-16);
  }
}

TEST(Rotation, TensorsAgainstMatrixExponential) {  // (1), (2): L and omega = B v'
  Random r(1);
  for (double g : norms)
    for (int n = 0; n < 4; ++n) {
      const Vec3 v = g * r.direction<3>(), dv = r.vector<3>();
      const RVec3 rv = v.cast<Real>(), rdv = dv.cast<Real>();
      const RMat3 ref = exponential(rv);
      EXPECT_LT((rot::L(v).cast<Real>() - ref).cwiseAbs().maxCoeff(), 1e-15L * 4) << g;
      // small rotations keep their digits off the diagonal
      const Mat3 off = (rot::L(v) - rot::L(v).transpose()) / (2 * g);
      EXPECT_NEAR(off.norm(), static_cast<double>(std::sqrt(2.0L) * std::sin(Real(g)) / Real(g)),
                  1e-14)
          << g;
      const RMat3 rate = central([&](Real h) { return exponential(rv + h * rdv); }, 1e-2L);
      const RVec3 omega = axial(rate * ref.transpose());
      EXPECT_LT((B(v) * dv - omega.cast<double>()).norm(), 1e-14) << g;
      EXPECT_LT((B_inverse(v) * B(v) - Mat3::Identity()).norm(), 1e-14) << g;
      // L = B B^-T, and B v = v
      EXPECT_LT((B(v) * B_inverse(v).transpose() - rot::L(v)).norm(), 1e-14) << g;
      EXPECT_LT((B(v) * v - v).norm(), 1e-15 * g);
    }
}

TEST(Rotation,
     SplitGivesTheDirectorWhateverThePhi) {  // (3)-(5): R = L(gamma) L(phi e), d = R e = L(gamma) e
  Random r(3);
  for (double g : norms) {
    const Vec2 gamma = g * r.direction<2>();
    rot::Director o;
    rot::director(gamma, o);
    for (double phi : {0.0, 1.0, -20.0}) {
      const RVec3 d = rotation_reference(phi, gamma.cast<Real>()).col(0);
      // the rounding of g = sqrt(x) and of d itself, some ulp each
      EXPECT_LT((Vec3::UnitX() + o.t - d.cast<double>()).norm(), 1e-15) << g;
    }
    const Vec3 t = offset_reference(gamma.cast<Real>()).cast<double>();
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(o.t[i], t[i], 1e-14 * std::abs(t[i])) << g << " component " << i;
    EXPECT_LT((rot::gamma_of_director(o.t) - gamma).norm(), (g < 2.9 ? 1e-15 : 1e-14) * g) << g;
  }
}

TEST(Rotation, DirectorDerivativesAgainstDifferences) {
  Random r(4);
  for (double g : norms) {
    const Vec2 gamma = g * r.direction<2>(), w = r.vector<2>(), a = r.vector<2>();
    const RVec2 G = gamma.cast<Real>(), W = w.cast<Real>(), A = a.cast<Real>();
    rot::Director o;
    rot::director(gamma, w, a, o);
    const Real h = 1e-2L;
    const auto d = [&](const RVec2& x) { return director_reference(x); };
    const auto rate = [&](const RVec2& x) {
      return RVec3(central([&](Real s) { return d(x + s * W); }, h));
    };
    // d'' = second difference along gamma + gamma' t + gamma'' t^2/2
    const auto accel = [&](const RVec2& x) {
      return RVec3(central2([&](Real s) { return d(x + s * W + s * s / 2 * A); }, h));
    };
    // 1e-14 of values of order 1; second differences carry 3e-19/h^2 and more where they are nested
    EXPECT_LT((o.rate.cast<Real>() - rate(G)).norm(), 1e-14L) << g;
    EXPECT_LT((o.accel.cast<Real>() - accel(G)).norm(), 3e-14L) << g;
    for (int j = 0; j < 2; ++j) {
      const RVec2 u = RVec2::Unit(j);
      EXPECT_LT((o.D.col(j).cast<Real>() - central([&](Real s) { return d(G + s * u); }, h)).norm(),
                1e-14L)
          << g;
      EXPECT_LT((o.D_rate.col(j).cast<Real>() - central([&](Real s) { return rate(G + s * u); }, h))
                    .norm(),
                3e-14L)
          << g;
      // a triple difference would carry 1e-12: the acceleration just checked is differenced
      // instead, rounding 1e-16/h
      const Vec2 v = Vec2::Unit(j);
      const Vec3 slope = central(
                             [&](Real s) {
                               rot::Director p;
                               rot::director(gamma + static_cast<double>(s) * v, w, a, p);
                               return RVec3(p.accel.cast<Real>());
                             },
                             2e-2L)
                             .cast<double>();
      EXPECT_LT((o.D_accel.col(j) - slope).norm(), 2e-13) << g;
    }
    const Vec3 f = r.vector<3>();
    Mat2 curvature;
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        curvature(i, j) = static_cast<double>(f.cast<Real>().dot(RVec3(central(
            [&](Real s) {
              return RVec3(central(
                  [&](Real q) { return d(G + s * RVec2::Unit(i) + q * RVec2::Unit(j)); }, h));
            },
            h))));
    EXPECT_LT((o.curvature(f) - curvature).norm(), 3e-14) << g;
    EXPECT_EQ(o.curvature(f), o.curvature(f).transpose());
    const Eigen::JacobiSVD<MatX> svd(MatX(o.D));
    EXPECT_NEAR(svd.singularValues()[0], 1.0, 1e-14);
    EXPECT_NEAR(svd.singularValues()[1],
                static_cast<double>(bessel_reference(0, Real(g) * Real(g))), 1e-14);
  }
}

TEST(Rotation, DirectorDerivativesKeepRelativeDigitsForSmallTilt) {
  // Leading orders at g << 1: d'_x = -gamma.gamma', and the radial part of every matrix scales with
  // gamma.
  for (double g : {1e-300, 1e-100, 1e-20, 1e-9}) {
    const Vec2 gamma(0.6 * g, -0.8 * g), w(2 * g, g), a(-g, 3 * g);
    rot::Director o;
    rot::director(gamma, w, a, o);
    EXPECT_NEAR(o.D(0, 0) / g, -0.6, 1e-15);
    EXPECT_NEAR(o.D(0, 1) / g, 0.8, 1e-15);
    EXPECT_NEAR(o.D_rate(0, 0) / g, -2.0, 1e-14);
    EXPECT_NEAR(o.rate.y() / g, 1.0, 1e-14);
    EXPECT_NEAR(o.rate.z() / g, -2.0, 1e-14);
    EXPECT_NEAR(o.accel.z() / g, 1.0, 1e-14);
    EXPECT_NEAR(o.D_accel(0, 1) / g, -3.0, 1e-14);
  }
}

TEST(Rotation, AngularVelocityOfTheSplit) {  // (6)-(8): omega = B(gamma) gamma' + phi' L(gamma) e =
                                             // d x d' + s d
  Random r(5);
  for (double g : norms) {
    const Motion m = random_motion(r, g);
    const RVec3 omega = m.omega(0);
    const Vec3 gamma(0, m.g.x(), m.g.y()), dgamma(0, m.dg.x(), m.dg.y());
    EXPECT_LT((B(gamma) * dgamma + m.dphi * rot::L(gamma).col(0) - omega.cast<double>()).norm(),
              1e-14)
        << g;
    EXPECT_LT((rot::omega_of_rates(m.g, m.dphi, m.dg) - omega.cast<double>()).norm(), 1e-14) << g;
    const RVec3 domega = central([&](Real t) { return m.omega(t); }, 1e-2L);
    EXPECT_LT((rot::omega_rate_of_rates(m.g, m.dphi, m.dg, m.ddphi, m.ddg) - domega.cast<double>())
                  .norm(),
              2e-14)
        << g;
    // spin rate s = omega.d = phi' - e.(d x d')/(1+e.d)
    rot::Director o;
    rot::director(m.g, m.dg, m.ddg, o);
    const Vec3 d = Vec3::UnitX() + o.t, e = Vec3::UnitX();
    const double s = m.dphi - e.dot(d.cross(o.rate)) / (1 + e.dot(d));
    EXPECT_NEAR(s, static_cast<double>(omega.dot(d.cast<Real>())), g < 3.0 ? 1e-14 : 1e-12) << g;
  }
}

TEST(Rotation, RatesFromOmega) {  // (9), (10), (11) in the paper's own form and in ours
  Random r(6);
  for (double g : norms) {
    const Motion m = random_motion(r, g);
    const Vec3 omega = m.omega(0).cast<double>();
    const Vec3 gamma(0, m.g.x(), m.g.y()), e = Vec3::UnitX();
    const Mat3 Bi = B_inverse(gamma);
    const double denominator = e.dot(Bi * rot::L(gamma) * e);
    // condition of the map bounds what rounding in omega does to the rates
    const double tolerance = 2e-15 * rot::chart_condition(g) * (1 + omega.norm());
    EXPECT_NEAR(e.dot(Bi * omega) / denominator, m.dphi, 10 * tolerance) << g;  // (11), paper
    const Vec3 dgamma = Bi * (omega - m.dphi * rot::L(gamma) * e);              // (9), paper
    EXPECT_LT((dgamma.tail<2>() - m.dg).norm(), 10 * tolerance) << g;
    const rot::ChartRates c = rot::rates_of_omega(m.g, omega);
    EXPECT_NEAR(c.phi, m.dphi, tolerance) << g;
    EXPECT_LT((c.gamma - m.dg).norm(), tolerance) << g;
    rot::Director o;
    rot::director(m.g, o);
    const Vec3 d = e + o.t;
    EXPECT_NEAR(c.phi, (e + d).dot(omega) / (1 + e.dot(d)), 10 * tolerance) << g;
    const Vec3 domega = rot::omega_rate_of_rates(m.g, m.dphi, m.dg, m.ddphi, m.ddg);
    const rot::ChartRates a = rot::accelerations_of_omega(m.g, m.dphi, m.dg, domega);
    const double k = rot::chart_condition(g);
    EXPECT_NEAR(a.phi, m.ddphi, 5e-15 * k * k) << g;
    EXPECT_LT((a.gamma - m.ddg).norm(), 5e-15 * k * k) << g;
    // the denominator of (11) is (g/2) cot(g/2): zero at pi, not at 2 pi
    EXPECT_NEAR(denominator, g / 2 / std::tan(g / 2), 2e-15);
  }
}

TEST(Rotation, ChartDeterminantIsSinc) {
  Random r(7);
  for (double g : {1e-8, 0.1, 1.0, 2.0, 3.0, 3.1}) {
    const Vec2 gamma = g * r.direction<2>();
    Mat3 A;
    A.col(0) = rot::omega_of_rates(gamma, 1, Vec2::Zero());
    A.col(1) = rot::omega_of_rates(gamma, 0, Vec2::UnitX());
    A.col(2) = rot::omega_of_rates(gamma, 0, Vec2::UnitY());
    EXPECT_NEAR(A.determinant(), std::sin(g) / g, 1e-14);
    const Eigen::JacobiSVD<MatX> svd{MatX(A)};
    const double condition = svd.singularValues()[0] / svd.singularValues()[2];
    EXPECT_NEAR(rot::chart_condition(g) / condition, 1.0, 1e-12);
  }
  EXPECT_DOUBLE_EQ(rot::chart_condition(0.0), 1.0);
  EXPECT_NEAR(rot::chart_condition(0.15), 1.08, 0.005);
  EXPECT_NEAR(rot::chart_condition(pi / 2), 2.43, 0.01);
  EXPECT_NEAR(rot::chart_condition(2.5), 6.4, 0.05);
  EXPECT_NEAR(rot::chart_condition(3.0), 30.6, 0.05);
  EXPECT_NEAR(rot::chart_condition(pi - 1e-4) * 1e-4, 4.41, 0.01);  // (1 + 4/pi^2) pi
}

TEST(Rotation, MinimalRotationAndSolidAngle) {
  Random r(8);
  for (int n = 0; n < 50; ++n) {
    const Vec3 a = r.direction<3>(), b = r.direction<3>(), c = r.direction<3>();
    const Mat3 P = rot::minimal_rotation(a, b);
    EXPECT_LT((P * a - b).norm(), 4e-15);
    EXPECT_LT((P.transpose() * P - Mat3::Identity()).norm(), 1e-13);
    // its axis is a x b: no component along a or b
    const Vec3 v(P(2, 1) - P(1, 2), P(0, 2) - P(2, 0), P(1, 0) - P(0, 1));
    EXPECT_LT(std::abs(v.dot(a)) + std::abs(v.dot(b)), 1e-13);
    // L'Huilier's formula for the size; the sign is that of the triple product
    const double A = std::acos(b.dot(c)), B = std::acos(a.dot(c)), C = std::acos(a.dot(b)),
                 s = (A + B + C) / 2;
    const double product =
        std::tan(s / 2) * std::tan((s - A) / 2) * std::tan((s - B) / 2) * std::tan((s - C) / 2);
    const double size = 4 * std::atan(std::sqrt(std::max(product, 0.0)));
    EXPECT_NEAR(rot::solid_angle(a, b, c), std::copysign(size, a.dot(b.cross(c))), 1e-7);
    // holonomy: carrying b-transport round the triangle turns about a by the solid angle
    const Mat3 loop =
        rot::minimal_rotation(c, a) * rot::minimal_rotation(b, c) * rot::minimal_rotation(a, b);
    EXPECT_LT((loop - rot::L(rot::solid_angle(a, b, c) * a)).norm(), 1e-12);
  }
  EXPECT_NEAR(rot::solid_angle(Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()), pi / 2,
              1e-15);  // an octant
  // a sliver of 1e-8 rad sides: area 5e-17, no cancellation
  EXPECT_NEAR(rot::solid_angle(Vec3::UnitX(), Vec3(1, 1e-8, 0).normalized(),
                               Vec3(1, 0, 1e-8).normalized()) /
                  5e-17,
              1.0, 1e-12);
}

TEST(Rotation, OppositeDirectionsAreAnError) {
  try {
    rot::minimal_rotation(Vec3::UnitX(), -Vec3::UnitX());
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.diagnostics().at(0).code, "E71");
  }
  EXPECT_THROW(rot::gamma_of_director(Vec3(-2, 0, 0)), Error);
  EXPECT_EQ(rot::gamma_of_director(Vec3::Zero()).norm(), 0.0);
  // at pi the chart is lost: gamma' has no component across gamma
  rot::Director o;
  rot::director(Vec2(pi, 0), o);
  EXPECT_LT((o.D * Vec2(0, 1)).norm(), 1e-15);
  EXPECT_GT(rot::chart_condition(rot::chart_limit), 100.0);
  EXPECT_GT(rot::chart_condition(pi), 1e15);
}

TEST(Rotation, ChartChangeKeepsTheMotion) {
  Random r(9);
  for (double g : {1e-6, 0.3, 1.0, 2.0, 2.05, 2.8, 3.05})
    for (int n = 0; n < 20; ++n) {
      const Motion m = random_motion(r, g);
      const Mat3 triad = r.rotation();
      // to the director itself, or to something near it
      const Vec3 d = triad * exponential(embed(m.g.cast<Real>())).cast<double>().col(0);
      const Vec3 to = n % 2 ? d : Vec3(d + 0.4 * r.vector<3>());
      const rot::ChartChange change(triad, to);
      const rot::Angles before{m.phi, m.dphi, m.ddphi, m.g, m.dg, m.ddg},
          after = change.apply(before);
      const auto body = [](const Mat3& q, double phi,
                           const Vec2& gm) {  // body axes in space: Q R e_k
        return Mat3(q * rot::L(Vec3(0, gm.x(), gm.y())) * rot::L(Vec3(phi, 0, 0)));
      };
      EXPECT_LT(
          (body(triad, before.phi, before.gamma) - body(change.new_triad(), after.phi, after.gamma))
              .norm(),
          1e-13);
      EXPECT_LT((change.new_triad().transpose() * change.new_triad() - Mat3::Identity()).norm(),
                1e-14);
      const double k = rot::chart_condition(g);
      EXPECT_LT((triad * rot::omega_of_rates(before.gamma, before.dphi, before.dgamma) -
                 change.new_triad() * rot::omega_of_rates(after.gamma, after.dphi, after.dgamma))
                    .norm(),
                1e-14 * k);
      EXPECT_LT(
          (triad * rot::omega_rate_of_rates(before.gamma, before.dphi, before.dgamma, before.ddphi,
                                            before.ddgamma) -
           change.new_triad() * rot::omega_rate_of_rates(after.gamma, after.dphi, after.dgamma,
                                                         after.ddphi, after.ddgamma))
              .norm(),
          1e-13 * k);
      if (n % 2) {
        EXPECT_LT(after.gamma.norm(), 1e-14);
      }
      // and back again
      const rot::ChartChange back(change.new_triad(), triad.col(0));
      const rot::Angles again = back.apply(after);
      EXPECT_LT((back.new_triad() - triad).norm(), 1e-13);
      EXPECT_NEAR(again.phi, before.phi, 1e-13 * k);
      EXPECT_LT((again.gamma - before.gamma).norm(), 1e-13 * k);
    }
}

TEST(Rotation, ChartChangeIsContinuousInPhi) {
  // A chart moved in small steps along any path moves phi in small steps: no jump by a turn,
  // whatever phi.
  const Vec2 gamma(1.2, -1.7);
  const Mat3 triad = Mat3::Identity();
  double last = 1e4;
  for (int i = 1; i <= 400; ++i) {
    const double a = 1.9 * i / 400.0;
    const rot::ChartChange c(triad,
                             Vec3(std::cos(a), 0.3 * std::sin(a), -0.95393920141694 * std::sin(a)));
    const double phi = c.apply({1e4, 0, 0, gamma, Vec2::Zero(), Vec2::Zero()}).phi;
    EXPECT_LT(std::abs(phi - last), 0.02);
    last = phi;
  }
}

TEST(Rotation, ManyChartChangesKeepTheTriadAndTheBody) {
  // A body tumbling for 1e5 changes: axes stay orthonormal, and the attitude walks off by rounding
  // alone.
  Random r(10);
  Mat3 triad = Mat3::Identity();
  rot::Angles a;
  a.phi = 0.3;
  a.gamma = Vec2(1.5, -1.4);
  const auto body = [&] {
    return Mat3(triad * rot::L(Vec3(0, a.gamma.x(), a.gamma.y())) * rot::L(Vec3(a.phi, 0, 0)));
  };
  const Mat3 start = body();
  for (int i = 0; i < 100'000; ++i) {
    const Vec3 d = body().col(0);
    const rot::ChartChange c(triad, d + 0.9 * r.vector<3>());
    a = c.apply(a);
    triad = c.new_triad();
  }
  EXPECT_LT((triad.transpose() * triad - Mat3::Identity()).norm(), 1e-15 * 4);
  // 1e5 steps of some 1e-15: 3e-13 as a random walk, 1e-10 if they all pointed one way
  EXPECT_LT((body() - start).norm(), 5e-12);
}

TEST(Rotation, WholeTurnsCostNoAccuracy) {
  // The remainder has the sine and cosine of phi itself, which libm reduces with as many digits of
  // pi as it takes.
  const Real two_pi_long = 6.283185307179586476925286766559L;
  for (double turns : {0.0, 1.0, -3.0, 1e3, 1e6, -1e8}) {
    const double phi = static_cast<double>(turns * two_pi_long + 0.75L);
    double remainder = phi;
    EXPECT_EQ(take_whole_turns(remainder), turns);
    EXPECT_NEAR(std::sin(remainder), std::sin(phi), 3e-16);
    EXPECT_NEAR(std::cos(remainder), std::cos(phi), 3e-16);
  }
  // phi carried as remainder + whole turns over 1e6 revolutions of 37 steps, against the plain sum
  const double step = two_pi / 37;
  double remainder = 0, count = 0, plain = 0;
  const long steps = 37'000'000;
  for (long i = 0; i < steps; ++i) {
    remainder += step;
    plain += step;
    if (remainder > pi) count += take_whole_turns(remainder);
  }
  const Real exact = Real(step) * steps - two_pi_long * count;
  const double error = std::abs(remainder - static_cast<double>(exact));
  const double plain_error = std::abs(static_cast<double>(Real(plain) - Real(step) * steps));
  // each addition to a remainder below 2 pi rounds by at most 4.4e-16; walk or drift, 3.7e7 of them
  // stay below 2e-8
  EXPECT_LT(error, 2e-8);
  EXPECT_GT(plain_error, 1e2 * error);
}
