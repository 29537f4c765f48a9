// The beam element of full sections: the conformance suite with all couplings, twist and offsets;
// linear statics and rigid motion in closed form; order 4 in large deformation; agreement with the
// other elements where they overlap.
#include "conformance.hpp"
#include <elements/shaft/general_beam.hpp>
#include <elements/shaft/section_beam.hpp>
#include <system/stiffness_rate.hpp>

#include <Eigen/Geometry>

#include <random>

using namespace whirl;
using namespace whirl::test;
using elements::SectionBeam;
using elements::SectionBeamConstants;

namespace {

Matrix<6> random_symmetric(unsigned seed, double part) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> d(-part, part);
  Matrix<6> A;
  for (int i = 0; i < 6; ++i)
    for (int k = i; k < 6; ++k)
      A(i, k) = A(k, i) = i == k ? 1.0 : d(rng);
  return A;
}

/// Everything coupled with everything, mass centre and products of inertia.
FullSection coupled() {
  Vector<6> size;
  size << 4e4, 2e4, 1.5e4, 90, 70, 120;
  const Vector<6> root = size.cwiseSqrt();
  FullSection s;
  s.stiffness = root.asDiagonal() * random_symmetric(3, 0.12) * root.asDiagonal();
  s.mass = offset_mass(2.0, Vec2(0.03, -0.02), 0.012, 0.009, 0.005, 0.001);
  return s;
}

Mat3 axes_at(double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitX()).toRotationMatrix(); }

/// Curved, twisted, with offsets, in a direction of its own.
SectionBeam any_beam(double beta, double alpha, const Mat3& chart) {
  const Mat3 T = rotation::L(Vec3(0.3, 0.5, -0.4));
  const Mat3 t1 = T * rotation::L(Vec3(0.2, 0.1, -0.15)),
             t2 = T * rotation::L(Vec3(0.5, 0.12, 0.2));
  const Vec3 o1(0.02, 0.05, -0.03), o2(-0.04, 0.01, 0.02), chord = 0.39 * T.col(0);
  SectionBeamConstants c = elements::make_section_constants(coupled(), 0.4, 0.3);
  c.alpha = alpha;
  SectionBeam b(c, chord, t1, t2, o1, o2, chart, chart);
  b.set_prestress(300.0, 1e-4);
  if (beta > 0) b.set_damping(beta, 2 * beta);
  return b;
}

/// A node at a place and turned against its chart at rest.
struct Placed {
  system::NodeState n;
  Placed(const Vec3& u, const Mat3& turned, const Mat3& chart) {
    n.u = u;
    n.du = n.ddu = n.dd = n.ddd = Vec3::Zero();
    const Mat3 R = turned * chart;  // the chart's axes now
    const Vec3 d = R.col(0);
    n.t = d - chart.col(0);
    const Mat3 A = rotation::minimal_rotation(chart.col(0), d).transpose() * R;
    n.phi = std::atan2(A.col(1).dot(chart.col(2)), A.col(1).dot(chart.col(1)));
    n.chart = &chart;
  }
};

/// A line of elements clamped at its left end, loaded at its right end, in its linear range: flexibility
/// at the tip from the tangents at rest.
Matrix<6> tip_flexibility(const FullSection& section, double length, double twist, int n) {
  const Mat3 chart = Mat3::Identity();
  MatX K = MatX::Zero(6 * (n + 1), 6 * (n + 1));
  const double l = length / n;
  const SectionBeamConstants c = elements::make_section_constants(section, l, twist / n);
  for (int e = 0; e < n; ++e) {
    const SectionBeam b(c, Vec3(l, 0, 0), axes_at(twist * e / n), axes_at(twist * (e + 1) / n));
    const Placed p(Vec3::Zero(), chart, chart);
    system::TangentX<14> t;
    t.set_zero();
    b.add_tangent({&p.n, &p.n}, {}, t);
    Eigen::Matrix<double, 14, 12> J = Eigen::Matrix<double, 14, 12>::Zero();  // small rotations
    for (int i = 0; i < 2; ++i) {
      J.block<3, 3>(7 * i, 6 * i).setIdentity();
      J(7 * i + 6, 6 * i + 3) = 1;
      J(7 * i + 5, 6 * i + 4) = -1;
      J(7 * i + 4, 6 * i + 5) = 1;
    }
    K.block<12, 12>(6 * e, 6 * e) += J.transpose() * t.K * J;
  }
  const MatX held = K.bottomRightCorner(6 * n, 6 * n);
  return held.inverse().bottomRightCorner<6, 6>();
}

/// int B(s)^T S(s) B(s) ds, B the section stresses of loads at the tip.
Matrix<6> exact_flexibility(const FullSection& section, double length, double twist) {
  const Matrix<6> S = section.stiffness.inverse();
  Matrix<6> f = Matrix<6>::Zero();
  const int n = 2000;
  for (int k = 0; k < n; ++k)
    for (const double part : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
      const double s = length * (k + part) / n;
      Matrix<6> B = Matrix<6>::Identity(), Q = Matrix<6>::Zero();
      B(4, 2) = -(length - s);
      B(5, 1) = length - s;
      Q.topLeftCorner<3, 3>() = Q.bottomRightCorner<3, 3>() = axes_at(twist * s / length);
      const Matrix<6> inside = Q.transpose() * B;
      f += length / n / 2 * inside.transpose() * S * inside;
    }
  return f;
}

}  // namespace

TEST(SectionBeam, IsAKernel) {
  for (const double beta : {0.0, 2e-3}) {
    ConformanceOptions o;
    o.chart = tilted_chart();
    o.objective = true;
    const SectionBeam b = any_beam(beta, beta > 0 ? 0.7 : 0.0, o.chart);
    o.objective = beta == 0;  // mass-proportional damping knows the fixed axes
    o.position = {Vec3::Zero(), b.chord + b.offset1 - b.offset2};
    o.symmetric_K = beta == 0;
    check_kernel(b, o);
  }
}

TEST(SectionBeam, StiffnessRateIsExact) {
  const Mat3 chart = Mat3::Identity();
  const SectionBeam b = any_beam(0, 0, chart);
  std::mt19937 rng(2);
  std::normal_distribution<double> d;
  Vector<14> x, dx;
  for (int k = 0; k < 14; ++k) {
    x[k] = 0.05 * d(rng);
    dx[k] = d(rng);
  }
  const auto states = [&](const Vector<14>& v) {
    std::array<system::NodeState, 2> n;
    for (int i = 0; i < 2; ++i) {
      auto& s = n[static_cast<std::size_t>(i)];
      s.du = s.ddu = s.dd = s.ddd = Vec3::Zero();
      s.u = v.segment<3>(7 * i);
      s.t = v.segment<3>(7 * i + 3);
      s.phi = v[7 * i + 6];
      s.chart = &chart;
    }
    return n;
  };
  const auto tangent = [&](double step) {
    const auto n = states(x + step * dx);
    system::TangentX<14> t;
    t.set_zero();
    b.add_tangent({&n[0], &n[1]}, {}, t);
    return Matrix<14>(t.K);
  };
  const auto n = states(x), rate = states(dx);
  system::StiffnessRateX<14> r;
  b.add_stiffness_rate({&n[0], &n[1]}, {&rate[0], &rate[1]}, {}, r);
  const Matrix<14> K = tangent(0.0);
  EXPECT_LT((r.K - K).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
  EXPECT_LT((r.df - K * dx).cwiseAbs().maxCoeff(), 1e-11 * (K * dx).cwiseAbs().maxCoeff());
  const double h = 3e-4;
  const Matrix<14> difference =
      (8.0 * (tangent(h) - tangent(-h)) - (tangent(2 * h) - tangent(-2 * h))) / (12.0 * h);
  EXPECT_LT((r.dK - difference).cwiseAbs().maxCoeff(), 1e-7 * difference.cwiseAbs().maxCoeff());
}

TEST(SectionBeam, IsExactInItsLinearRange) {
  // Straight: one element is exact for any coupling. Pre-twisted: order 4.
  const FullSection s = coupled();
  const Matrix<6> exact = exact_flexibility(s, 2.0, 0.0), one = tip_flexibility(s, 2.0, 0.0, 1);
  const Vector<6> size = exact.diagonal().cwiseSqrt();
  const auto error = [&](const Matrix<6>& a, const Matrix<6>& b) {
    return (size.cwiseInverse().asDiagonal() * (a - b) * size.cwiseInverse().asDiagonal())
        .cwiseAbs()
        .maxCoeff();
  };
  EXPECT_LT(error(one, exact), 1e-12);
  const double quarter = pi / 2;
  const Matrix<6> twisted = exact_flexibility(s, 2.0, quarter);
  double last = 0;
  for (const int n : {2, 4, 8, 16}) {
    const double e = error(tip_flexibility(s, 2.0, quarter, n), twisted);
    std::printf("pre-twist of 90 deg, %d elements: %.2e\n", n, e);
    if (last > 0) {
      EXPECT_NEAR(std::log2(last / e), 4.0, 0.15);
    }
    last = e;
  }
  EXPECT_LT(last, 1e-5);
}

TEST(SectionBeam, AgreesWithTheGeneralElementInItsLinearRange) {
  // Same stiffness and the same inertia matrices for sections without coupling.
  const double l = 0.4, EA = 4e4, kGAy = 3e3, kGAz = 2e3, GJ = 90, EIy = 70, EIz = 120, m = 2;
  const double rhoIy = 3e-3, rhoIz = 5e-3;
  FullSection s;
  s.stiffness = offset_stiffness(EA, kGAy, kGAz, GJ, EIy, EIz, {0, 0}, {0, 0});
  s.mass = offset_mass(m, {0, 0}, rhoIy + rhoIz, rhoIy, rhoIz, 0);
  elements::GeneralBeamConstants g;
  const auto plane = [&](double EI, double kGA) {
    elements::ElementSection e;
    e.constants = true;
    e.given = {EA, kGA, GJ, EI, m, std::min(rhoIy, rhoIz), 0};
    return elements::make_shaft_constants(e, l);
  };
  const auto y = plane(EIz, kGAy), z = plane(EIy, kGAz);
  g.length = l;
  g.EA_l = y.EA_l;
  g.GJ_l = y.GJ_l;
  g.ky_def11 = y.k11;
  g.ky_def12 = y.k12;
  g.ky_def22 = y.k22;
  g.kz_def11 = z.k11;
  g.kz_def12 = z.k12;
  g.kz_def22 = z.k22;
  g.M4 = 0.5 * (y.M4 + z.M4);
  const auto& stiffer = rhoIz > rhoIy ? y : z;
  g.triads = {l * Vec3(rhoIy + rhoIz, rhoIy, rhoIz).asDiagonal().toDenseMatrix(),
              elements::shear_share(stiffer.k11, stiffer.k12, stiffer.k22)};
  const elements::GeneralBeam general(g, Vec3(l, 0, 0), axes_at(0.3), axes_at(0.3));
  const SectionBeam full(elements::make_section_constants(s, l, 0), Vec3(l, 0, 0), axes_at(0.3),
                         axes_at(0.3));
  const Mat3 chart = Mat3::Identity();
  Placed p(Vec3::Zero(), chart, chart);
  p.n.dphi = 30;  // gyroscopic terms
  system::TangentX<14> a, b;
  a.set_zero();
  b.set_zero();
  general.add_tangent({&p.n, &p.n}, {}, a);
  full.add_tangent({&p.n, &p.n}, {}, b);
  const auto close = [](const Matrix<14>& u, const Matrix<14>& v) {
    return (u - v).cwiseAbs().maxCoeff() / u.cwiseAbs().maxCoeff();
  };
  EXPECT_LT(close(a.M, b.M), 1e-13);
  EXPECT_LT(close(a.C, b.C), 1e-13);
  // K holds centrifugal terms on t besides: compare where t does not stretch d
  EXPECT_LT(close(a.K, b.K), 1e-12);
}

TEST(SectionBeam, RigidMotionHasTheInertiaOfItsMass) {
  const FullSection s = coupled();
  const double l = 0.7;
  const SectionBeam b(elements::make_section_constants(s, l, 0.0), Vec3(l, 0, 0), Mat3::Identity(),
                      Mat3::Identity());
  // about end 1: int [v + omega x (s e1)] . M ..
  Matrix<6> whole = Matrix<6>::Zero();
  const int n = 2;
  for (int k = 0; k < n; ++k)
    for (const double part : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)}) {
      const double x = l * (k + part) / n;
      Matrix<6> A = Matrix<6>::Identity();
      A(1, 5) = x;
      A(2, 4) = -x;
      whole += l / n / 2 * A.transpose() * s.mass * A;
    }
  const Mat3 chart = Mat3::Identity();
  std::mt19937 rng(4);
  std::normal_distribution<double> d;
  for (int trial = 0; trial < 5; ++trial) {
    Vector<6> v;
    for (int k = 0; k < 6; ++k)
      v[k] = d(rng);
    std::array<Placed, 2> p{Placed(Vec3::Zero(), chart, chart), Placed(Vec3::Zero(), chart, chart)};
    const Vec3 omega = v.tail<3>();
    for (int i = 0; i < 2; ++i) {
      auto& node = p[static_cast<std::size_t>(i)].n;
      node.du = v.head<3>() + omega.cross(Vec3(i * l, 0, 0));
      node.dd = omega.cross(Vec3::UnitX());
      node.dphi = omega.x();
    }
    system::Energy e;
    b.add_energy({&p[0].n, &p[1].n}, {}, e);
    EXPECT_NEAR(e.kinetic, 0.5 * v.dot(whole * v), 1e-13 * e.kinetic);
  }
}

TEST(SectionBeam, CirclesAreExact) {
  // One element bent to 2.1 rad by a couple, and twisted: constant strain of any size.
  FullSection s = coupled();
  s.stiffness = offset_stiffness(4e4, 3e3, 2e3, 90, 70, 120, {0, 0}, {0, 0});
  const double l = 0.7;
  const SectionBeam b(elements::make_section_constants(s, l, 0.0), Vec3(l, 0, 0), Mat3::Identity(),
                      Mat3::Identity());
  const Mat3 chart = Mat3::Identity();
  for (const Vec3& kappa : {Vec3(0, 0, 3.0), Vec3(0, -2.0, 0), Vec3(4.0, 0, 0)}) {
    const Vec3 turn = l * kappa;
    Vec3 r = Vec3::Zero();
    const int n = 4000;
    for (int k = 0; k < n; ++k)
      r += l / n * (rotation::L((k + 0.5) / n * turn) * Vec3::UnitX());
    const Placed p1(Vec3::Zero(), chart, chart), p2(r - Vec3(l, 0, 0), rotation::L(turn), chart);
    system::Energy e;
    b.add_energy({&p1.n, &p2.n}, {}, e);
    const Vec3 bending = s.stiffness.bottomRightCorner<3, 3>() * kappa;
    EXPECT_NEAR(e.elastic, 0.5 * l * bending.dot(kappa), 1e-6 * e.elastic);  // of r, 1e-7
  }
}

namespace {

/// Extension twists and bending shears it, the same in every direction.
FullSection tube() {
  FullSection s;
  s.stiffness.diagonal() << 4e4, 2e4, 2e4, 90, 70, 70;
  const auto couple = [&](Index i, Index k, double x) {
    s.stiffness(i, k) = s.stiffness(k, i) = x;
  };
  couple(0, 3, 500);
  couple(1, 4, 250);
  couple(2, 5, 250);
  couple(1, 5, -130);
  couple(2, 4, 130);
  s.mass = offset_mass(2.0, Vec2::Zero(), 0.012, 0.007, 0.007, 0);
  return s;
}

SectionBeam spinning_beam(const FullSection& section, double tilt = 0.0) {
  const double l = 0.4;
  const SectionBeamConstants c = elements::make_section_constants(section, l, 0.3);
  const Mat3 axes = rotation::L(Vec3(0, 0, tilt));
  SectionBeam b(c, Vec3(l, 0, 0), axes * axes_at(0.2), axes * axes_at(0.5), Vec3(0.01, 0, 0),
                Vec3(-0.02, 0, 0));
  b.set_prestress(300.0, 1e-4);
  b.set_damping(1e-3, 2e-3);
  return b;
}

/// Largest change of the forces, relative, as both nodes turn on in some motion.
double change_as_it_turns(const SectionBeam& b) {
  const Mat3 chart = Mat3::Identity();
  std::mt19937 rng(7);
  std::normal_distribution<double> d;
  std::array<system::NodeState, 2> n;
  const auto any = [&](double size) { return Vec3(size * Vec3(d(rng), d(rng), d(rng))); };
  for (system::NodeState& s : n) {
    s.u = any(0.02);
    s.du = any(0.1);
    s.ddu = any(1.0);
    const Vec3 lean(0, 0.2 * d(rng), 0.2 * d(rng));
    const Vec3 director = rotation::L(lean) * Vec3::UnitX();
    s.t = director - Vec3::UnitX();
    s.dd = any(1.0).cross(director);
    s.ddd = any(1.0).cross(director) - s.dd.squaredNorm() * director;
    s.phi = 0.3 * d(rng);
    s.dphi = 20 * d(rng);
    s.ddphi = d(rng);
    s.chart = &chart;
  }
  const auto force = [&](double angle) {
    std::array<system::NodeState, 2> now = n;
    for (system::NodeState& s : now)
      s.phi += angle;
    system::ForceX<14> f = system::ForceX<14>::Zero();
    b.add_force({&now[0], &now[1]}, {}, f);
    return Vector<14>(f);
  };
  const Vector<14> start = force(0);
  double worst = 0;
  for (const double angle : {0.4, 1.1, 2.0, 4.7})
    worst = std::max(worst, (force(angle) - start).norm() / start.norm());
  return worst;
}

}  // namespace

TEST(SectionBeam, ACoupledSectionThatIsAlikeAllAroundDoesNotSeeItsAngle) {
  const SectionBeam round = spinning_beam(tube());
  EXPECT_TRUE(round.axisymmetric());
  EXPECT_EQ(round.depends({}).angle, system::twist_angle);
  EXPECT_LT(change_as_it_turns(round), 1e-12);
  // every entry that tells two directions apart does
  const auto changed = [](bool stiffness, Index i, Index k, double by) {
    FullSection s = tube();
    Matrix<6>& A = stiffness ? s.stiffness : s.mass;
    A(i, k) += by;
    if (i != k) A(k, i) += by;
    const SectionBeam b = spinning_beam(s);
    EXPECT_FALSE(b.axisymmetric()) << i << k;
    EXPECT_EQ(b.depends({}).angle, system::each_angle);
    EXPECT_GT(change_as_it_turns(b), 1e-9) << stiffness << i << k;
  };
  for (Index i = 0; i < 6; ++i)
    for (Index k = i; k < 6; ++k) {
      const bool lateral_i = i % 3 != 0, lateral_k = k % 3 != 0;
      const double size = std::sqrt(tube().stiffness(i, i) * tube().stiffness(k, k));
      if (lateral_i || lateral_k) changed(true, i, k, 1e-3 * size);
    }
  changed(false, 4, 4, 1e-4);
  changed(false, 4, 5, 1e-4);
  FullSection off = tube();
  off.mass = offset_mass(2.0, Vec2(1e-4, 0), 0.012, 0.007, 0.007, 0);
  EXPECT_FALSE(spinning_beam(off).axisymmetric());
  EXPECT_FALSE(spinning_beam(tube(), 1e-3).axisymmetric());
}
