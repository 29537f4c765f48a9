// The corotational shaft element in q-space: exact tangents, invariance under rigid motion, power
// balance, small-tilt digits.
#include <core/rotation.hpp>
#include <elements/shaft/shaft_beam.hpp>
#include <elements/shaft/shaft_damping.hpp>
#include <system/problem.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

using namespace whirl;
using namespace whirl::system;
using elements::ShaftBeam;
using elements::ShaftElementConstants;

namespace {

// A stubby steel-like element with every constant different from zero and no accidental symmetry.
// stiffness: factor on all of it; a soft element lets the inertia's share of K stand out.
ShaftElementConstants constants(bool offsets, double stiffness = 1.0) {
  const double L = 0.4, EA = 3e5 * stiffness, EI = 120.0 * stiffness, GJ = 90.0 * stiffness,
               Phi = 0.3, rhoA = 2.0, rhoI = 0.01;
  ShaftElementConstants c;
  c.length = L;
  if (offsets) {
    c.o1 = 0.1;
    c.o2 = -0.07;
  }
  c.EA_l = EA / L;
  c.GJ_l = GJ / L;
  c.k11 = EI * (4 + Phi) / (L * (1 + Phi));
  c.k22 = 1.1 * c.k11;
  c.k12 = EI * (2 - Phi) / (L * (1 + Phi));
  const double q = (1 + Phi) * (1 + Phi);
  c.b11 = (2.0 / 15 + Phi / 6 + Phi * Phi / 12) / q;
  c.b22 = 1.2 * c.b11;
  c.b12 = -(1.0 / 30 + Phi / 6 + Phi * Phi / 12) / q;
  c.tau_c = 0.5 * (1 - Phi) / (1 + Phi);
  // any symmetric matrix of a rigid body's form is good enough for derivatives; use the cubic
  // beam's
  c.M4 << 156, 22 * L, 54, -13 * L, 22 * L, 4 * L * L, 13 * L, -3 * L * L, 54, 13 * L, 156, -22 * L,
      -13 * L, -3 * L * L, -22 * L, 4 * L * L;
  c.M4 *= rhoA * L / 420;
  Matrix<4> R;
  R << 36, 3 * L, -36, 3 * L, 3 * L, 4 * L * L, -3 * L, -L * L, -36, -3 * L, 36, -3 * L, 3 * L,
      -L * L, -3 * L, 4 * L * L;
  R *= rhoI / (30 * L);
  c.M4 += R;
  c.G4 = 2 * R;
  c.polar << 5, 1, 1, 5;
  c.polar *= 2 * rhoI * L / 12;
  c.mass = rhoA * L;
  return c;
}

enum class With { nothing, rotating, external };

template <bool Offsets>
System make_system(const Mat3& triad = Mat3::Identity(), With damping = With::nothing,
                   double stiffness = 1.0, const Vec3& gravity = Vec3(1, -2, -9.81)) {
  Builder b;
  const Index line = b.add_line("shaft", triad);
  const auto c = constants(Offsets, stiffness);
  const Vec3 e0 = triad.col(0);
  const Index n1 = b.add_node({Vec3::Zero(), line, "node 1", false});
  const Index n2 = b.add_node({Vec3((c.length + c.o1 - c.o2) * e0), line, "node 2", false});
  ShaftBeam<Offsets> beam(c, e0);
  beam.preload = 40.0 * stiffness;
  beam.psi0 = 0.05;
  b.add(beam, {n1, n2}, "shaft elements");
  if (damping == With::rotating)
    b.add(elements::ShaftDamping<true>(c, e0, 2e-3, 1e-3, 5e-4), {n1, n2}, "internal damping");
  if (damping == With::external) {
    b.add(elements::ShaftDamping<false>(c, e0, 2e-3, 1e-3, 5e-4), {n1, n2}, "external damping");
    b.add(elements::ShaftMassDamping{3.0 * c.M4}, {n1, n2}, "mass damping");
  }
  b.set_gravity(gravity);
  return b.finalize();
}

struct Point {
  VecX q, v, a;
};

Point random_point(std::mt19937& rng, double tilt) {
  std::normal_distribution<double> d;
  Point p{VecX(12), VecX(12), VecX(12)};
  for (int k = 0; k < 12; ++k) {
    const int c = k % 6;
    p.q[k] = d(rng) * (c < 3 ? 0.1 * tilt : c == 3 ? 3.0 : tilt);
    p.v[k] = d(rng) * (c == 3 ? 5.0 : 1.0);
    p.a[k] = d(rng);
  }
  p.q[9] = p.q[3] + 0.3;
  return p;
}

// Fourth-order central difference of the residual in direction k of x.
template <class F>
VecX derivative(F&& f, VecX x, Index k, double h) {
  const double x0 = x[k];
  auto at = [&](double s) {
    x[k] = x0 + s * h;
    return f(x);
  };
  return (8.0 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12.0 * h);
}

template <bool Offsets>
void check_tangent(double tilt, unsigned seed, const Mat3& triad, With damping = With::nothing,
                   double stiffness = 1.0) {
  const System sys = make_system<Offsets>(triad, damping, stiffness);
  Workspace w = sys.make_workspace();
  Frames f = sys.make_state().frames;
  std::mt19937 rng(seed);
  const Point p = random_point(rng, tilt);
  la::MCK m = sys.make_matrices();
  ASSERT_TRUE(sys.tangent(w, f, 0, p.q, p.v, p.a, m));
  MatX M(12, 12), C(12, 12), K(12, 12);
  for (Index i = 0; i < 2; ++i)
    for (Index j = 0; j < 2; ++j) {
      const Index s = sys.pattern().slot(i, j);
      M.block<6, 6>(6 * i, 6 * j) = m.M.block(s);
      C.block<6, 6>(6 * i, 6 * j) = m.C.block(s);
      K.block<6, 6>(6 * i, 6 * j) = m.K.block(s);
    }
  auto R = [&](const VecX& q, const VecX& v, const VecX& a) {
    VecX r(12);
    EXPECT_TRUE(sys.residual(w, f, 0, q, v, a, r));
    return r;
  };
  // The residual is linear in a and quadratic in v: differences with step 1 are exact but for
  // round-off (1e-16 of forces of 1e5). In q, order 4 with h = 5e-4 rad: truncation and round-off
  // both below 1e-9.
  MatX Mn(12, 12), Cn(12, 12), Kn(12, 12);
  for (Index k = 0; k < 12; ++k) {
    Mn.col(k) = derivative([&](const VecX& a) { return R(p.q, p.v, a); }, p.a, k, 1.0);
    Cn.col(k) = derivative([&](const VecX& v) { return R(p.q, v, p.a); }, p.v, k, 1.0);
    Kn.col(k) = derivative([&](const VecX& q) { return R(q, p.v, p.a); }, p.q, k,
                           5e-4 * (k % 6 < 3 ? 0.1 : 1.0));
  }
  EXPECT_LT((M - Mn).norm(), 1e-9 * M.norm());
  EXPECT_LT((C - Cn).norm(), 1e-9 * C.norm() + 1e-10);
  EXPECT_LT((K - Kn).norm(), 1e-8 * K.norm());
  EXPECT_LT((M - M.transpose()).norm(), 1e-14 * M.norm());
}

Mat3 tilted_triad() { return rotation::L(Vec3(0.3, -0.8, 1.1)); }

/// Moment about the origin of generalised forces p (or angular momentum of momenta), global axes.
Vec3 moment_of(const System& s, const Frames& f, const VecX& q, const VecX& p) {
  Vec3 m = Vec3::Zero();
  for (Index i = 0; i < s.nodes(); ++i) {
    m += (s.node(i).position + q.segment<3>(6 * i)).cross(Vec3(p.segment<3>(6 * i)));
    for (int k = 0; k < 3; ++k) {
      const rotation::ChartRates rate = rotation::rates_of_omega(
          Vec2(q.segment<2>(6 * i + 4)), Vec3(f.axes(i).transpose() * Vec3::Unit(k)));
      m[k] += p[6 * i + 3] * rate.phi + p.segment<2>(6 * i + 4).dot(rate.gamma);
    }
  }
  return m;
}

/// All forces of a free element have the moment of its inertia alone: dL/dt, along a random motion.
template <bool Offsets>
void check_moment(double tilt, unsigned seed) {
  const System sys = make_system<Offsets>(tilted_triad(), With::nothing, 1.0, Vec3::Zero());
  Workspace w = sys.make_workspace();
  const Frames f = sys.make_state().frames;
  std::mt19937 rng(seed);
  const Point p = random_point(rng, tilt);
  la::MCK m = sys.make_matrices();
  const auto momentum = [&](double t) {
    const VecX q = p.q + t * p.v + 0.5 * t * t * p.a, v = p.v + t * p.a;
    EXPECT_TRUE(sys.tangent(w, f, 0, q, v, p.a, m));
    VecX on = VecX::Zero(12);
    m.M.add_multiply(1.0, v, on);
    return moment_of(sys, f, q, on);
  };
  const double h = 1e-3;
  const Vec3 rate =
      (45.0 * (momentum(h) - momentum(-h)) - 9.0 * (momentum(2 * h) - momentum(-2 * h)) +
       (momentum(3 * h) - momentum(-3 * h))) /
      (60.0 * h);
  VecX r(12);
  ASSERT_TRUE(sys.residual(w, f, 0, p.q, p.v, p.a, r));
  EXPECT_LT((moment_of(sys, f, p.q, r) - rate).norm(), 1e-9 * r.norm());
}

/// Elements first to last of a line of `count`, undamped and damped.
System part_of_line(Index count, Index first, Index last) {
  const auto c = constants(true);
  Builder b;
  const Index line = b.add_line("shaft");
  for (Index i = 0; i <= count; ++i)
    b.add_node({Vec3(0.57 * static_cast<double>(i), 0, 0), line, "", false});
  for (Index i = first; i <= last; ++i) {
    ShaftBeam<true> beam(c, Vec3::UnitX());
    beam.preload = 10.0 * static_cast<double>(i);
    b.add(beam, {i, i + 1}, "shaft elements");
    b.add(elements::ShaftDamping<true>(c, Vec3::UnitX(), 2e-3, 1e-3, 5e-4), {i, i + 1},
          "internal damping");
  }
  return b.finalize();
}

}  // namespace

TEST(ShaftBeam, TangentsAreExact) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    check_tangent<false>(0.4, seed, Mat3::Identity());
    check_tangent<true>(0.4, seed, tilted_triad());
    check_tangent<false>(1e-3, seed, tilted_triad());
    check_tangent<true>(0.4, seed, tilted_triad(), With::nothing, 1e-6);
  }
}

TEST(ShaftBeam, StaticTangentIsSymmetric) {
  const System sys = make_system<true>();
  Workspace w = sys.make_workspace();
  std::mt19937 rng(3);
  Point p = random_point(rng, 0.5);
  p.v.setZero();
  p.a.setZero();
  la::MCK m = sys.make_matrices();
  // gravity-free: inertia loads vanish and K is a true Hessian in the global chart (u, phi, gamma)
  p.a.segment<3>(0) = p.a.segment<3>(6) = Vec3(1, -2, -9.81);
  ASSERT_TRUE(sys.tangent(w, sys.make_state().frames, 0, p.q, p.v, p.a, m));
  for (Index i = 0; i < 2; ++i)
    for (Index j = 0; j < 2; ++j) {
      const Matrix<6> A = m.K.block(sys.pattern().slot(i, j)),
                      B = m.K.block(sys.pattern().slot(j, i));
      EXPECT_LT((A - B.transpose()).norm(), 1e-13 * A.norm());
    }
}

TEST(ShaftBeam, RigidMotionStoresNoEnergy) {
  // Any rotation of the straight, untwisted element: elastic energy to round-off of EA and GJ,
  // 1e-12 of 1/2 GJ (1 rad)^2.
  Builder b;
  const Index line = b.add_line("shaft");
  auto c = constants(true);
  const Vec3 X2((c.length + c.o1 - c.o2), 0, 0);
  const Index n1 = b.add_node({Vec3::Zero(), line, "1", false}),
              n2 = b.add_node({X2, line, "2", false});
  b.add(ShaftBeam<true>(c, Vec3::UnitX()), {n1, n2}, "shaft elements");
  const System sys = b.finalize();
  Workspace w = sys.make_workspace();
  const Frames f = sys.make_state().frames;
  std::mt19937 rng(5);
  std::normal_distribution<double> d;
  for (int i = 0; i < 50; ++i) {
    const Vec2 gamma(d(rng), d(rng));
    if (gamma.norm() > 3.0) continue;
    rotation::Director dir;
    rotation::director(gamma, dir);
    VecX q = VecX::Zero(12), z = VecX::Zero(12), r(12);
    const Vec3 shift(d(rng), d(rng), d(rng));
    q.head<3>() = shift;
    q.segment<3>(6) = shift + X2.x() * dir.t;
    q[3] = q[9] = 10 * d(rng);
    q.segment<2>(4) = q.segment<2>(10) = gamma;
    ASSERT_TRUE(sys.residual(w, f, 0, q, z, z, r));
    EXPECT_LT(sys.energy(w).elastic, 1e-12 * 0.5 * c.GJ_l);
    EXPECT_LT(r.norm(), 1e-9);  // EA_l 1e-16 x lever
  }
}

TEST(ShaftBeam, RigidRotationOfABentTwistedElementKeepsEnergyAndTorque) {
  const System sys = make_system<false>();
  Workspace w = sys.make_workspace();
  const Frames f = sys.make_state().frames;
  std::mt19937 rng(8);
  const Point p = random_point(rng, 0.3);
  VecX r(12), z = VecX::Zero(12);
  ASSERT_TRUE(sys.residual(w, f, 0, p.q, z, z, r));
  const double V = sys.energy(w).elastic;
  const double L = constants(false).length;
  auto R_of = [&](Index i) -> Mat3 {
    const Vec3 g(0, p.q[6 * i + 4], p.q[6 * i + 5]);
    return rotation::L(g) * rotation::L(Vec3(p.q[6 * i + 3], 0, 0));
  };
  for (const Vec3& v : {Vec3(0.4, 0.2, -0.1), Vec3(1.0, -0.6, 0.5), Vec3(-2.0, 0.1, 0.9)}) {
    const Mat3 Q = rotation::L(v);
    VecX q = p.q;
    double phi[2];
    for (Index i = 0; i < 2; ++i) {
      const Mat3 R = Q * R_of(i);
      const Vec3 d = R.col(0);
      q.segment<2>(6 * i + 4) = rotation::gamma_of_director(d - Vec3::UnitX());
      // phi from R = P(e -> d) L(phi e)
      const Mat3 A = rotation::minimal_rotation(Vec3::UnitX(), d).transpose() * R;
      phi[i] = std::atan2(A(2, 1), A(1, 1));
      const Vec3 X(i == 0 ? 0 : L, 0, 0);
      q.segment<3>(6 * i) = Q * (X + p.q.segment<3>(6 * i)) - X;
    }
    // phi is only known modulo 2 pi from R: keep the two continuous with each other
    const double dphi = phi[1] - phi[0], old = p.q[9] - p.q[3];
    q[3] = phi[0];
    q[9] = phi[0] + dphi + two_pi * std::round((old - dphi) / two_pi);
    ASSERT_TRUE(sys.residual(w, f, 0, q, z, z, r));
    EXPECT_NEAR(sys.energy(w).elastic, V, 1e-12 * V);
  }
}

TEST(ShaftDamping, TangentsAreExact) {
  for (unsigned seed = 11; seed <= 14; ++seed) {
    check_tangent<false>(0.4, seed, Mat3::Identity(), With::rotating);
    check_tangent<true>(0.4, seed, tilted_triad(), With::rotating);
    check_tangent<true>(0.3, seed, tilted_triad(), With::external);
    check_tangent<false>(1e-3, seed, tilted_triad(), With::rotating);
  }
}

TEST(ShaftDamping, PowerAndRigidSpin) {
  // The damping part of the residual, found as the difference to the undamped element, loses
  // exactly the reported power, never gains, and a bent element turning rigidly loses nothing to
  // rotating damping while the external one does.
  std::mt19937 rng(21);
  for (With kind : {With::rotating, With::external}) {
    const System damped = make_system<true>(tilted_triad(), kind),
                 bare = make_system<true>(tilted_triad());
    Workspace wd = damped.make_workspace(), wb = bare.make_workspace();
    const Frames f = damped.make_state().frames;
    for (int i = 0; i < 20; ++i) {
      const Point p = random_point(rng, 0.4);
      VecX rd(12), rb(12);
      ASSERT_TRUE(damped.residual(wd, f, 0, p.q, p.v, p.a, rd));
      ASSERT_TRUE(bare.residual(wb, f, 0, p.q, p.v, p.a, rb));
      const double lost = damped.energy(wd).dissipated;
      EXPECT_GT(lost, 0.0);
      EXPECT_NEAR((rd - rb).dot(p.v), lost, 1e-11 * (lost + rb.norm()));
    }
    // rigid spin: every point and director turns with omega about the origin
    Point p = random_point(rng, 0.4);
    const Vec3 omega(30.0, -4.0, 7.0);
    const Mat3 E = tilted_triad();
    for (Index i = 0; i < 2; ++i) {
      const Vec3 X = damped.node(i).position;
      p.v.segment<3>(6 * i) = omega.cross(X + p.q.segment<3>(6 * i));
      const rotation::ChartRates rate =
          rotation::rates_of_omega(p.q.segment<2>(6 * i + 4), E.transpose() * omega);
      p.v[6 * i + 3] = rate.phi;
      p.v.segment<2>(6 * i + 4) = rate.gamma;
    }
    ASSERT_TRUE(damped.evaluate_nodes(wd, f, 0, p.q, p.v, p.a));
    const double lost = damped.energy(wd).dissipated;
    if (kind == With::rotating)
      EXPECT_LT(lost, 1e-20 * 1e6);  // round-off of rates of 30 rad/s squared, times moduli of 1e3
    else
      EXPECT_GT(lost, 1.0);
  }
}

TEST(ShaftBeam, PowerBalance) {
  // d(T + V)/dt = f . v for the inertial and elastic force along any motion (no external power):
  // checked by differencing the energy along q(t) = q + v t + a t^2/2, where every term of the
  // residual contributes.
  const System sys = make_system<true>(tilted_triad());
  Workspace w = sys.make_workspace();
  const Frames f = sys.make_state().frames;
  std::mt19937 rng(13);
  for (int i = 0; i < 5; ++i) {
    const Point p = random_point(rng, 0.4);
    auto energy = [&](double t) {
      const VecX q = p.q + t * p.v + 0.5 * t * t * p.a, v = p.v + t * p.a;
      EXPECT_TRUE(sys.evaluate_nodes(w, f, 0, q, v, p.a));
      const Energy e = sys.energy(w);
      return e.kinetic + e.elastic + e.gravity;
    };
    const double h = 1e-3;
    const double dE = (45.0 * (energy(h) - energy(-h)) - 9.0 * (energy(2 * h) - energy(-2 * h)) +
                       (energy(3 * h) - energy(-3 * h))) /
                      (60.0 * h);
    VecX r(12);
    ASSERT_TRUE(sys.residual(w, f, 0, p.q, p.v, p.a, r));
    EXPECT_NEAR(
        dE, r.dot(p.v),
        1e-8 * r.norm() * p.v.norm());  // sixth-order difference, h^6 of rates of about 10/s
  }
}

TEST(ShaftBeam, MomentIsTheRateOfAngularMomentum) {
  for (const unsigned seed : {3U, 4U, 5U}) {
    check_moment<false>(0.05, seed);
    check_moment<false>(0.5, seed);
    check_moment<true>(0.5, seed);
  }
}

TEST(ShaftBeam, StraightElementHasTheConsistentGyroscopicCouple) {
  // Of matrix G4, whatever stands where: -Omega a x G4 X'.
  const ShaftElementConstants c = constants(false);
  const System sys = make_system<false>(Mat3::Identity(), With::nothing, 1.0, Vec3::Zero());
  Workspace w = sys.make_workspace();
  const double Omega = 700.0;
  VecX v = VecX::Zero(12);
  v[3] = v[9] = Omega;
  const VecX zero = VecX::Zero(12);
  la::MCK m = sys.make_matrices();
  ASSERT_TRUE(sys.tangent(w, sys.make_state().frames, 0, zero, v, zero, m));
  VecX across(12);
  across << 0.0, 0.3, -0.2, 0.0, 0.7, 0.4, 0.0, -0.5, 0.1, 0.0, -0.6, 0.9;
  VecX f = VecX::Zero(12);
  m.C.add_multiply(1.0, across, f);
  Vec3 rate[4], expected[4];
  for (int i = 0; i < 2; ++i) {
    rate[2 * i] = across.segment<3>(6 * i);
    rate[2 * i + 1] = w.D[static_cast<std::size_t>(i)] * across.segment<2>(6 * i + 4);
  }
  for (int k = 0; k < 4; ++k) {
    expected[k].setZero();
    for (int l = 0; l < 4; ++l)
      expected[k] -= Omega * c.G4(k, l) * Vec3::UnitX().cross(rate[l]);
  }
  for (int i = 0; i < 2; ++i) {
    EXPECT_LT((f.segment<3>(6 * i) - expected[2 * i]).norm(), 1e-12 * f.norm());
    const Vec2 on_gamma = w.D[static_cast<std::size_t>(i)].transpose() * expected[2 * i + 1];
    EXPECT_LT((f.segment<2>(6 * i + 4) - on_gamma).norm(), 1e-12 * f.norm());
  }
}

TEST(ShaftBeam, SeveralAtOnceAreSeveralOneByOne) {
  // Groups of every fill against systems of one element each: round-off, another series in a group
  // of unlike bends.
  std::mt19937 rng(11);
  std::normal_distribution<double> d;
  for (Index count = 1; count <= 9; ++count) {
    const System whole = part_of_line(count, 0, count - 1);
    VecX q(whole.size()), v(whole.size()), a(whole.size()), r(whole.size());
    for (Index k = 0; k < whole.size(); ++k) {
      q[k] = 0.05 * d(rng);
      v[k] = d(rng);
      a[k] = d(rng);
    }
    Workspace w = whole.make_workspace();
    ASSERT_TRUE(whole.residual(w, whole.make_state().frames, 0, q, v, a, r));
    VecX sum = VecX::Zero(whole.size()), one(whole.size());
    for (Index i = 0; i < count; ++i) {
      const System part = part_of_line(count, i, i);
      Workspace x = part.make_workspace();
      ASSERT_TRUE(part.residual(x, part.make_state().frames, 0, q, v, a, one));
      sum += one;
    }
    EXPECT_LT((r - sum).norm(), 1e-14 * sum.norm()) << count;
  }
}

TEST(ShaftBeam, SmallTiltKeepsItsDigits) {
  // Linear response at 1e-3 and at 1e-12 agree to 1e-6 (the cubic terms at 1e-3): digits of a tiny
  // tilt are not lost.
  const System sys = make_system<false>();
  Workspace w = sys.make_workspace();
  const Frames f = sys.make_state().frames;
  VecX z = VecX::Zero(12), r1(12), r2(12), r0(12);
  VecX a = VecX::Zero(12);
  a.segment<3>(0) = a.segment<3>(6) = Vec3(1, -2, -9.81);  // cancels gravity exactly
  VecX q = VecX::Zero(12);
  q[9] = 0.05;  // psi0: no torque
  VecX dq = VecX::Zero(12);
  dq[1] = 0.1;
  dq[5] = 1.0;
  dq[10] = -0.7;
  dq[8] = 0.05;
  const auto response = [&](double s, VecX& r) {
    VecX x = q + s * dq;
    sys.residual(w, f, 0, x, z, a, r);
    sys.residual(w, f, 0, q, z, a, r0);
    r = (r - r0) / s;
  };
  response(1e-4, r1);
  response(1e-12, r2);
  for (int k : {1, 2, 4, 5, 7, 8, 10, 11})
    EXPECT_NEAR(r1[k], r2[k], 1e-6 * r1.norm());
}
