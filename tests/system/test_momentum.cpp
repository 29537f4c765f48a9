// The momentum form against the second-order form and against published motions.
#include "../core/extrapolation.hpp"
#include "../core/reference.hpp"
#include <core/error.hpp>
#include <core/rotation.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/loads/point_load.hpp>
#include <elements/rigid/point_mass.hpp>
#include <elements/rigid/rigid_body.hpp>
#include <elements/loads/spin_torque.hpp>
#include <elements/supports/spring_block.hpp>
#include <elements/loads/unbalance.hpp>
#include <system/momentum.hpp>
#include <gtest/gtest.h>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;
using namespace whirl::system;

namespace {

/// Integrates y to t1, charts and turns taken care of after every step.
VecX run(MomentumProblem& p, double t0, double t1, VecX y, int steps) {
  const double H = (t1 - t0) / steps;
  const auto f = [&](double t, const VecX& x) {
    VecX dy(x.size());
    EXPECT_TRUE(p.rate(t, x, dy));
    return dy;
  };
  for (int i = 0; i < steps; ++i) {
    y = extrapolate(f, t0 + i * H, t0 + (i + 1) * H, y, 1);
    p.accept(y);
  }
  return y;
}

Matrix<6> random_spd(Random& r, double size) {
  Matrix<6> m;
  for (int i = 0; i < 6; ++i)
    m.row(i) = r.vector<6>().transpose();
  return size * (m * m.transpose());
}

/// Three bodies of all three forms with every kind of element the form allows.
System mixed(Random& r) {
  Builder b;
  const Index line = b.add_line("rotor", r.rotation());
  const Index free = b.add_node({Vec3(0.1, 0, 0), line, "free body"}),
              pivot = b.add_node({Vec3(1, 0, 0), line, "top"});
  const Index point = b.add_node({Vec3(0.1, 0, 0.2), line, "pedestal"}),
              ground = b.add_ground(Vec3::Zero(), "ground");
  for (int c = 0; c < 3; ++c)
    b.hold(pivot, c);
  b.set_gravity(Vec3(1, 2, -9));
  b.set_base_acceleration(1, make_harmonic(0, 3, 4, 0.5));
  Mat3 J;
  J << 0.20, 0.03, -0.02, 0.03, 0.15, 0.01, -0.02, 0.01, 0.12;
  b.add(RigidBody(3.0, Vec3(0.1, 0.05, -0.08), J), {free}, "body");
  b.add(UnbalanceMass(0.05, 0.4), {free}, "unbalance");
  b.add(RigidBody(2.0, Vec3(0.3, 0.01, 0.02), J), {pivot}, "body");
  b.add(PointMass{1.5}, {point}, "mass");
  b.add(SpringBlock{200, 50, -0.2, Vec3(0.6, 0, 0.8)}, {free}, "spring");
  const Matrix<6> zero = Matrix<6>::Zero();
  b.add(LinearBearing(random_spd(r, 100), random_spd(r, 2), zero, r.vector<6>(), r.vector<6>(), 0.1,
                      0.2),
        {free, pivot}, "bearing");
  b.add(LinearBearing(random_spd(r, 100), random_spd(r, 2), zero, r.vector<6>(), r.vector<6>(), 0.1,
                      0),
        {free, ground}, "bearing");
  const Mat3 K = 50 * Mat3::Identity();
  b.add(TranslationalBearing{K, 0.1 * K, Mat3::Zero(), Vec3::Zero(), Vec3::Zero()}, {free, point},
        "support");
  b.add(BodyLoad{Vec3(1, 2, 3), Vec3(0.1, -0.2, 0.3), 0.1, make_harmonic(1, 1, 3, 0)}, {free},
        "load");
  TorqueLaw law;
  law.of_time = make_constant(0.7);
  law.viscous = 0.1;
  b.add(JointTorque{law, Vec3::UnitX()}, {pivot}, "drive");
  b.add(FixedTorque{law, Vec3::UnitY()}, {free}, "drive");
  return b.finalize();
}

}  // namespace

TEST(Momentum, SatisfiesTheSecondOrderEquations) {
  Random r(21);
  for (int n = 0; n < 20; ++n) {
    const System s = mixed(r);
    MomentumProblem p(s);
    State x = s.make_state();
    x.q = VecX::NullaryExpr(s.size(), [&] { return r.number(); });
    x.v = VecX::NullaryExpr(s.size(), [&] { return 5 * r.number(); });
    const double t = 0.3;
    s.impose(x.frames, t, x.q, x.v, x.a);
    VecX y(p.size());
    p.set_state(x, y);
    State z;
    ASSERT_TRUE(p.get_state(t, y, z));
    // a state survives the way there and back
    EXPECT_LT((z.q - x.q).norm(), 1e-13);
    EXPECT_LT((z.v - x.v).norm(), 1e-12);
    Workspace w = s.make_workspace();
    VecX residual(s.size()), at_rest(s.size());
    s.residual(w, z.frames, t, z.q, z.v, z.a, residual);
    s.residual(w, z.frames, t, z.q, z.v, VecX::Zero(s.size()), at_rest);
    for (Index i = 0; i < s.size(); ++i)
      if (s.active()[static_cast<std::size_t>(i)]) {
        EXPECT_NEAR(residual[i], 0.0, 1e-12 * at_rest.norm()) << i;
      }
  }
}

TEST(Momentum, OneDiskRotorOfThePaper) {
  // Sorokin & Zhang 2018, doi 10.18698/2308-6033-2018-10-1815: D = 0.5 m, m = 5 kg, l = 0.75 m, C1
  // = 2000 N/m, C2 = 500 N m, 50 rad/s; table: two independent formulations integrated at order 8,
  // rtol 1e-12.
  const double D = 0.5, m = 5, l = 0.75, J = m * D * D / 16;
  Builder b;
  const Index line = b.add_line("rotor"), disk = b.add_node({Vec3(l, 0, 0), line, "disk"});
  b.add(RigidDisk{m, J, 2 * J, 0}, {disk}, "disk");
  b.add(SpringBlock{2000, 500, -l, Vec3::UnitX()}, {disk}, "spring block");
  b.set_gravity(Vec3(0, 0, -9.81));
  const System s = b.finalize();
  MomentumProblem p(s);
  State x = s.make_state();
  x.v[3] = 50;
  VecX y(p.size());
  p.set_state(x, y);
  EXPECT_NEAR(y[9], 2 * J * 50, 1e-12);  // K = J_c . e omega0

  const double table[4][7] = {
      {1, 0.739505515, -0.00613730358, -0.0785390156, 49.9972956, 0.0749684786, -0.00826746605},
      {2, 0.753673251, 0.0742199631, -0.0987913595, 99.9977928, 0.0910020105, 0.0677597893},
      {5, 0.737350448, 0.00925074668, -0.104446011, 249.988669, 0.0968815038, 0.0116157341},
      {10, 0.745250642, 0.0181325644, -0.136435971, 499.977124, 0.126412517, 0.0145155382}};
  double t = 0;
  Workspace w = s.make_workspace();
  const auto energy = [&](const State& z) {
    s.evaluate_nodes(w, z.frames, z.t, z.q, z.v, z.a);
    const Energy e = s.energy(w);
    return e.kinetic + e.elastic + e.gravity;
  };
  p.get_state(0, y, x);
  const double E0 = energy(x), T0 = 0.5 * 2 * J * 2500;
  EXPECT_NEAR(E0, T0, 1e-11);
  for (const auto& row : table) {
    // steps of 1/200 s: 0.7 rad of the fastest whirl each, order 14
    y = run(p, t, row[0], y, static_cast<int>(200 * (row[0] - t)));
    t = row[0];
    ASSERT_TRUE(p.get_state(t, y, x));
    const double computed[6] = {l + x.q[0], x.q[1], x.q[2], x.total_phi(disk, line),
                                x.q[4],     x.q[5]};
    // nine figures are printed
    for (int i = 0; i < 6; ++i)
      EXPECT_NEAR(computed[i], row[i + 1], 6e-9 * std::abs(row[i + 1]))
          << "t " << t << " column " << i;
    EXPECT_NEAR(energy(x), E0, 1e-9) << "energy, J";
    s.evaluate_nodes(w, x.frames, t, x.q, x.v, x.a);
    EXPECT_NEAR(w.nodes[0].spin(), 50.0, 1e-10);  // omega.d is an invariant of this rotor
  }
}

TEST(Momentum, RefusesWhatItDoesNotCover) {
  const auto refusal = [](auto build) {
    Builder b;
    const Index n = b.add_node({Vec3::Zero(), b.add_line("rotor"), "disk"});
    build(b, n);
    const System s = b.finalize();
    try {
      MomentumProblem p(s);
    } catch (const Error& e) {
      EXPECT_EQ(e.diagnostics().at(0).code, "E74");
      return std::string(e.what());
    }
    return std::string("covered");
  };
  const RigidDisk disk{1, 1, 2, 0};
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_EQ(refusal([&](Builder& b, Index n) { b.add(disk, {n}, "disk"); }), "covered");
  EXPECT_TRUE(has(refusal([&](Builder& b, Index n) {
                    b.add(disk, {n}, "disk");
                    b.hold(n, 1);
                  }),
                  "partly held"));
  EXPECT_TRUE(has(refusal([&](Builder& b, Index n) {
                    b.add(SpringBlock{1, 1, 0, Vec3::UnitX()}, {n}, "spring");
                  }),
                  "without mass"));
  EXPECT_TRUE(has(refusal([&](Builder& b, Index n) {
                    b.add(RigidDisk{1, 0, 0, 0}, {n}, "disk");
                  }),
                  "rotary inertia"));
  EXPECT_TRUE(has(refusal([&](Builder& b, Index n) {
                    b.add(disk, {n}, "disk");
                    b.add(UnbalanceMass(1, 0, make_table({0, 1}, {0, 1})), {n}, "unbalance");
                  }),
                  "changes in time"));
  EXPECT_TRUE(has(refusal([&](Builder& b, Index n) {
                    b.add(disk, {n}, "disk");
                    for (int c = 0; c < 3; ++c)
                      b.hold(n, c, make_harmonic(0, 1, 1, 0));
                  }),
                  "prescribed"));
  EXPECT_TRUE(has(refusal([&](Builder& b, Index n) {
                    b.add(disk, {n}, "disk");
                    b.add(TranslationalBearing{Mat3::Zero(), Mat3::Zero(), Mat3::Identity(),
                                               Vec3::Zero(), Vec3::Zero()},
                          {n, b.add_ground(Vec3::Zero(), "ground")}, "bearing");
                  }),
                  "mass in bearing"));
  EXPECT_TRUE(has(refusal([](Builder& b, Index) { b.add_ground(Vec3::Zero(), "ground"); }),
                  "nothing that moves"));
}

TEST(Momentum, ChartsAndTurnsDoNotChangeTheMotion) {
  // A fast tumbling body: with charts moved, against the same body integrated in the one chart that
  // never needs it.
  Builder b;
  const Index line = b.add_line("body"), n = b.add_node({Vec3::Zero(), line, "body"});
  Mat3 J;
  J << 2, 0.1, 0, 0.1, 1.5, 0.2, 0, 0.2, 3;
  b.add(RigidBody(1.0, Vec3(0.1, -0.2, 0.3), J), {n}, "body");
  const System s = b.finalize();
  MomentumProblem p(s);
  State x = s.make_state();
  x.v << 0.1, -0.2, 0.3, 1.0, 5.0, 0.5;
  VecX y(p.size());
  p.set_state(x, y);
  const Vec3 K0 = y.segment<3>(9), v0 = y.segment<3>(3), r0 = y.head<3>();
  const double E0 = K0.dot(J.inverse() * K0);
  int moved = 0;
  const int steps = 2000;
  for (int i = 0; i < steps; ++i) {
    const Mat3 before = p.frames.axes(0);
    y = run(p, i * 0.01, (i + 1) * 0.01, y, 1);
    moved += before != p.frames.axes(0);
    EXPECT_LE(y.segment<2>(7).norm(), rotation::chart_switch + 1e-12);
  }
  EXPECT_GT(moved, 10);
  State z;
  ASSERT_TRUE(p.get_state(20, y, z));
  EXPECT_EQ((y.segment<3>(3) - v0).norm(), 0.0);
  // rounding of r, 4e-15 at 30 m, times the extrapolation's weights (25) and 2000 steps
  EXPECT_LT((y.head<3>() - r0 - 20 * v0).norm(), 5e-10);
  // the attitude against quaternions in long double
  using Y = Eigen::Matrix<Real, 4, 1>;
  const auto rate = [&](Real, const Y& q) {
    const Real n2 = q.squaredNorm();
    const RVec3 u = q.tail<3>();
    const RMat3 S = r_skew(u), R = RMat3::Identity() + 2 * (q[0] * S + S * S) / n2;
    const RVec3 w = R * J.inverse().cast<Real>() * (R.transpose() * K0.cast<Real>());
    Y dq;
    dq << -w.dot(u) / 2, (q[0] * w + w.cross(u)) / 2;
    return dq;
  };
  const Y q = extrapolate(rate, Real(0), Real(20), Y(Y(1, 0, 0, 0)), 1000);
  const RVec3 u = q.tail<3>();
  const RMat3 S = r_skew(u), R = RMat3::Identity() + 2 * (q[0] * S + S * S) / q.squaredNorm();
  const Mat3 attitude =
      p.frames.axes(0) * rotation::L(Vec3(0, y[7], y[8])) * rotation::L(Vec3(y[6], 0, 0));
  EXPECT_LT((attitude - R.cast<double>()).norm(), 1e-10);
  const Vec3 K = y.segment<3>(9);
  EXPECT_LT((K - K0).norm(), 1e-15);
  EXPECT_NEAR(K.dot(attitude * J.inverse() * attitude.transpose() * K), E0, 1e-11 * E0);
}
