// How stiffness grows along a motion: against differences of exact tangents.
#include <core/rotation.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/timoshenko_matrices.hpp>
#include <system/stiffness_rate.hpp>

#include <gtest/gtest.h>

#include <random>

using namespace whirl;
using namespace whirl::system;
using elements::GeneralBeam;

namespace {

GeneralBeam curved_beam() {
  elements::GeneralBeamConstants c;
  const double L = 0.4;
  c.length = L;
  c.EA_l = 4e4 / L;
  c.GJ_l = 90 / L;
  c.ky_def11 = c.ky_def22 = 4 * 120 / L;
  c.ky_def12 = 2 * 120 / L;
  c.kz_def11 = c.kz_def22 = 4 * 7 / L;
  c.kz_def12 = 2 * 7 / L;
  c.b11 = c.b22 = 2.0 / 15;
  c.b12 = -1.0 / 30;
  const Mat3 T = rotation::L(Vec3(0.3, 0.5, -0.4));
  const Mat3 t1 = T * rotation::L(Vec3(0.2, 0.1, -0.15)),
             t2 = T * rotation::L(Vec3(-0.1, 0.12, 0.2));
  return GeneralBeam(c, 0.39 * T.col(0), t1, t2, Vec3(0.02, 0.05, -0.03), Vec3(-0.04, 0.01, 0.02));
}

}  // namespace

TEST(StiffnessRate, IsTheDerivativeOfTheTangent) {
  const GeneralBeam beam = curved_beam();
  std::mt19937 rng(3);
  std::normal_distribution<double> normal;
  const Mat3 chart = Mat3::Identity();
  for (int trial = 0; trial < 5; ++trial) {
    VecX x(14), dx(14);
    for (Index k = 0; k < 14; ++k) {
      x[k] = 0.1 * normal(rng);
      dx[k] = normal(rng);
    }
    const auto states = [&](const VecX& X) {
      std::array<NodeState, 2> n;
      for (std::size_t i = 0; i < 2; ++i) {
        const Index k = 7 * static_cast<Index>(i);
        n[i].u = X.segment<3>(k);
        n[i].t = X.segment<3>(k + 3);
        n[i].phi = X[k + 6];
        n[i].du = n[i].ddu = n[i].dd = n[i].ddd = Vec3::Zero();
        n[i].chart = &chart;
      }
      return n;
    };
    const auto tangent = [&](double step) {
      const auto n = states(x + step * dx);
      TangentX<14> t;
      t.set_zero();
      beam.add_tangent({&n[0], &n[1]}, {}, t);
      return Matrix<14>(t.K);
    };
    const auto n = states(x), rate = states(dx);
    StiffnessRateX<14> r;
    beam.add_stiffness_rate({&n[0], &n[1]}, {&rate[0], &rate[1]}, {}, r);
    const Matrix<14> K = tangent(0.0);
    EXPECT_LT((r.K - K).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
    EXPECT_LT((r.df - K * dx).cwiseAbs().maxCoeff(), 1e-11 * (K * dx).cwiseAbs().maxCoeff());
    // differences of fourth order: steps of 1e-3 leave 1e-12 of the fifth derivative, and rounding
    // of 1e-13
    const double h = 1e-3;
    const Matrix<14> difference =
        (8.0 * (tangent(h) - tangent(-h)) - (tangent(2 * h) - tangent(-2 * h))) / (12.0 * h);
    EXPECT_LT((r.dK - difference).cwiseAbs().maxCoeff(), 1e-7 * difference.cwiseAbs().maxCoeff())
        << trial;
  }
}

// A shaft that moves as a whole is not stressed: no stiffness grows, whatever the mesh.
TEST(StiffnessRate, RigidMotionGivesNone) {
  Builder b;
  b.add_line("shaft");
  elements::ElementSection section;
  section.constants = true;
  section.given = {1e8, 1e6, 80, 100, 1, 0, 0};
  const int n = 4;
  const auto c = elements::make_shaft_constants(section, 0.25);
  for (int i = 0; i <= n; ++i)
    b.add_node({Vec3(0.25 * i, 0, 0), 0, "node", false});
  for (int i = 0; i < n; ++i)
    b.add(elements::ShaftBeam<false>(c, Vec3::UnitX()), {i, i + 1}, "shaft elements");
  const System s = b.finalize();
  const State rest = s.make_state();
  Workspace w = s.make_workspace();
  ASSERT_TRUE(s.evaluate_nodes(w, rest.frames, 0.0, rest.q, rest.v, rest.a));
  const Vec3 turn(0.3, -0.7, 0.4);
  VecX u(s.size());
  for (Index i = 0; i <= n; ++i) {
    u.segment<3>(6 * i) = Vec3(1, 2, 3) + turn.cross(s.node(i).position);
    u.segment<3>(6 * i + 3) = turn;  // about x, y, z: phi, gamma
  }
  la::BlockMatrix<6> out(s.pattern());
  out.set_zero();
  add_stiffness_rate({s, w, rest.frames, rest.q, u}, 1.0, out);
  const double stiffest = 1e8 / 0.25;
  EXPECT_LT(
      Eigen::Map<VecX>(out.data(), static_cast<Index>(out.value_count())).cwiseAbs().maxCoeff(),
      1e-13 * stiffest);
  // stretching by the strain s makes the stiffness of a string: N/L, N = EA s
  u.setZero();
  for (Index i = 0; i <= n; ++i)
    u[6 * i] = 1e-3 * s.node(i).position.x();
  out.set_zero();
  add_stiffness_rate({s, w, rest.frames, rest.q, u}, 1.0, out);
  VecX sideways = VecX::Zero(s.size()), force = sideways;
  for (Index i = 0; i <= n; ++i) {
    sideways[6 * i + 1] = s.node(i).position.x();
    sideways[6 * i + 5] = 1.0;  // turns with the line
  }
  out.add_multiply(1.0, sideways, force);
  EXPECT_NEAR(sideways.dot(force), 1e5, 1e-6);  // N times the length
}
