// Motions of single rigid bodies with closed forms or published numbers, by both forms of the
// equations.
#include <la/dense.hpp>
#include "../core/reference.hpp"
#include "explicit_motion.hpp"
#include "rigid_cases.hpp"
#include <algorithm>

using namespace whirl;
using namespace whirl::test;

TEST(RigidMotion, HeavyTop) {
  const RigidCase c = heavy_top();
  for (auto& [name, m] : both_forms(c.system, c.start)) {
    double t = 0;
    for (const TopPoint& p : heavy_top_table) {
      // 150 rad/s: 2 ms is 0.3 rad a step
      m->advance(p.t, static_cast<int>(std::lround(500 * (p.t - t))));
      t = p.t;
      const State& x = m->state();
      // the table has twelve digits; its source states 1e-7
      EXPECT_LT((attitude(c.system, x, 0).col(0) - p.centre).norm(), 2e-9) << name << " t " << t;
      EXPECT_NEAR(energy(c.system, x), heavy_top_energy, 1e-7) << name;
    }
    const Mat3 R = attitude(c.system, m->state(), 0);
    const Vec3 body =
        R.transpose() * angular_velocity(c.system, m->state(), 0);  // along (y, z, x) of the body
    EXPECT_NEAR(body[0], 150.0, 1e-9) << name;
    EXPECT_NEAR(body[1], -5.855624589204, 1e-6) << name;
    EXPECT_NEAR(body[2], 0.1222332194777, 1e-6) << name;
  }
}

TEST(RigidMotion, SymmetricTopNutation) {
  const RigidCase c = symmetric_top();
  const double period = 0.06370064452338624;  // elliptic integrals
  for (auto& [name, m] : both_forms(c.system, c.start)) {
    const auto look = [&c, &m = m](double& theta, double& azimuth) {
      const Vec3 d = attitude(c.system, m->state(), 0).col(0);
      theta = std::atan2(std::hypot(d.x(), d.y()), d.z());
      azimuth = std::atan2(d.y(), d.x());
    };
    double theta, azimuth, theta0, azimuth0;
    look(theta0, azimuth0);
    m->advance(period / 2, 20);
    look(theta, azimuth);
    EXPECT_NEAR(theta * 180 / pi, 30.45901362513339, 1e-9) << name;
    m->advance(period, 20);
    look(theta, azimuth);
    EXPECT_NEAR(theta * 180 / pi, 30.0, 1e-9) << name;
    EXPECT_NEAR((azimuth - azimuth0) / period, 0.7901822172792948, 1e-9)
        << name;  // precession rate
    m->advance(0.1, 20);
    look(theta, azimuth);
    EXPECT_NEAR(theta, 0.531232984385, 1e-11) << name;
    EXPECT_NEAR(azimuth - azimuth0, 0.082377801545, 1e-11) << name;
  }
}

TEST(RigidMotion, FreeAsymmetricTopTurnsOver) {
  // Spin about the middle axis turns over again and again (Dzhanibekov); periods and zero crossings
  // from elliptic integrals.
  struct Case {
    double eps, period, crossing[2];
  } cases[] = {{0.01, 10.051858276326245, {2.741068055554631, 7.766997193733624}},
               {0.1, 6.859148539959867, {1.942859699946581, 5.372433969925987}}};
  for (const Case& k : cases) {
    const RigidCase c = free_top(k.eps);
    for (auto& [name, m] : both_forms(c.system, c.start)) {
      const auto body_rate = [&c, &m = m] {
        const State& x = m->state();
        return Vec3(attitude(c.system, x, 0).transpose() * angular_velocity(c.system, x, 0));
      };
      const double E0 = energy(c.system, m->state());
      // The perturbation holds an energy of order eps^2 J; rounding of 1e-12 J in the 25 J of the
      // spin shifts the next turn-over by 1e-12/eps^2 of a time constant (0.35 s). The rate crosses
      // zero with 12 rad/s2.
      const double rounding = 5e-11 / (k.eps * k.eps);
      m->advance(k.crossing[0], 60);
      EXPECT_NEAR(body_rate()[1], 0.0, 1e-10) << name;
      m->advance(k.crossing[1], 120);
      EXPECT_NEAR(body_rate()[1], 0.0, rounding) << name;
      m->advance(k.period, 60);
      EXPECT_LT((body_rate() - Vec3(k.eps, 5, k.eps)).norm(), rounding) << name;
      if (k.eps == 0.1) {
        m->advance(10.0, 80);
        EXPECT_LT((body_rate() - Vec3(-0.298299034103, -4.992095520546, 0.190597581085)).norm(),
                  1e-8)
            << name;
      }
      EXPECT_NEAR(energy(c.system, m->state()), E0, 1e-11 * E0) << name;
      EXPECT_GT(m->chart_changes, 3) << name;
    }
  }
}

TEST(RigidMotion, TumblesForAThousandSecondsThroughPi) {
  // Against quaternions in long double; some thousand changes of chart.
  const RigidCase c = free_top(0.5);
  MomentumMotion m(c.system, c.start);
  const Vec3 K0(0.5, 10, 1.5);
  const double E0 = energy(c.system, c.start);
  using Y = Eigen::Matrix<Real, 4, 1>;
  const RVec3 inverse(1, Real(1) / 2, Real(1) / 3);
  const auto tensor = [](const Y& q) {
    const RMat3 S = r_skew(RVec3(q.tail<3>()));
    return RMat3(RMat3::Identity() + 2 * (q[0] * S + S * S) / q.squaredNorm());
  };
  const auto rate = [&](Real, const Y& q) {
    const RMat3 R = tensor(q);
    const RVec3 w = R * inverse.cwiseProduct(R.transpose() * K0.cast<Real>()), u = q.tail<3>();
    Y dq;
    dq << -w.dot(u) / 2, (q[0] * w + w.cross(u)) / 2;
    return dq;
  };
  m.advance(1000.0, 20'000);  // 0.25 rad a step
  const Y q = extrapolate(rate, Real(0), Real(1000), Y(Y(1, 0, 0, 0)), 20'000);
  const Mat3 R = attitude(c.system, m.state(), 0);
  // 5000 rad turned: 1e-9 is 2e-13 of it
  EXPECT_LT((R - tensor(q).cast<double>()).norm(), 1e-8);
  EXPECT_LT(
      (R * Vec3(1, 2, 3).cwiseProduct(R.transpose() * angular_velocity(c.system, m.state(), 0)) -
       K0)
          .norm(),
      1e-11);
  EXPECT_NEAR(energy(c.system, m.state()), E0, 1e-9 * E0);
  EXPECT_GT(m.chart_changes, 500);
}

TEST(RigidMotion, WhirlFrequenciesOfARotorOnTwoSprings) {
  // Closed 2 x 2 complex eigenproblem; forward positive, backward negative, Hz.
  struct Case {
    double rpm, hz[4];
  } cases[] = {{0, {-35.84321451, -21.49885651, 21.49885651, 35.84321451}},
               {4000, {-29.58233998, -21.32695918, 21.57941538, 43.61576442}},
               {20000, {-22.08718791, -14.3778232, 21.69146838, 86.20294593}}};
  for (const Case& k : cases) {
    const RigidCase c = rigid_rotor(k.rpm * pi / 30);
    system::Workspace w = c.system.make_workspace();
    la::MCK m = c.system.make_matrices();
    ASSERT_TRUE(c.system.tangent(w, c.start.frames, 0, c.start.q, c.start.v, c.start.a, m));
    const int use[4] = {1, 2, 4, 5};
    Matrix<4> M, C, K;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        M(i, j) = m.M.block(0)(use[i], use[j]);
        C(i, j) = m.C.block(0)(use[i], use[j]);
        K(i, j) = m.K.block(0)(use[i], use[j]);
      }
    Matrix<8> A = Matrix<8>::Zero();
    A.topRightCorner<4, 4>().setIdentity();
    A.bottomLeftCorner<4, 4>() = -M.inverse() * K;
    A.bottomRightCorner<4, 4>() = -M.inverse() * C;
    const la::DenseEigenpairs pairs = la::eigenpairs(MatX(A));
    std::vector<double> hz;
    for (int i = 0; i < 8; ++i) {
      const Complex lambda = pairs.values[i];
      EXPECT_NEAR(lambda.real(), 0.0, 1e-9);
      if (lambda.imag() < 0) continue;
      // forward: z lags y by a quarter turn
      const VecXc v = pairs.vectors.col(i);
      const double turn = -(std::conj(v[0]) * v[1]).imag();
      hz.push_back(k.rpm == 0 ? lambda.imag() / two_pi
                              : std::copysign(lambda.imag() / two_pi, turn));
    }
    std::sort(hz.begin(), hz.end());
    ASSERT_EQ(hz.size(), 4u);
    if (k.rpm == 0) {  // each frequency twice, in both planes
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(hz[i], k.hz[2 + i / 2], 1e-8 * hz[i]);
    } else {
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(hz[i], k.hz[i], 1e-8 * std::abs(k.hz[i])) << k.rpm << " rpm";
    }
  }
}
