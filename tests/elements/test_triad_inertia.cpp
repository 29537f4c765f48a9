// The rest of the rotary inertia on the triads: positive, and whole.
#include <la/dense.hpp>
#include <core/rotation.hpp>
#include <elements/shaft/general_beam.hpp>
#include <elements/shaft/section_beam.hpp>
#include <elements/shaft/triad_inertia.hpp>

#include <gtest/gtest.h>

#include <random>

using namespace whirl;
using elements::MassKind;
using elements::TriadInertia;
using elements::TriadShare;

namespace {

/// On angular velocities (left, right) of two triads that lie alike.
Matrix<6> on_spins(const TriadInertia& t) {
  Matrix<6> out = Matrix<6>::Zero();
  for (int i = 0; i < 2; ++i)
    for (int k = 0; k < 2; ++k)
      for (std::size_t a = 0; a < 3; ++a)
        for (std::size_t b = 0; b < 3; ++b) {
          // (w1 x e_a).(w2 x e_b) = w1.w2 e_a.e_b - (w1.e_b)(w2.e_a)
          const double m = t.on[a][b](i, k);
          if (a == b) out.block<3, 3>(3 * i, 3 * k) += m * Mat3::Identity();
          out(3 * i + static_cast<int>(b), 3 * k + static_cast<int>(a)) -= m;
        }
  return out;
}

struct Draw {
  std::mt19937 random;
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  /// Positive semi-definite, of a flat section more often than not; products with the axis or none.
  Mat3 tensor(bool coupled) {
    const double flat = std::pow(10.0, (*this)(-6, 0));
    const Mat3 turn = rotation::L(Vec3((*this)(-3, 3), 0, 0));
    Mat3 J = turn * Vec3(1 + flat, flat, 1).asDiagonal() * turn.transpose();
    if (coupled) {
      const Mat3 tilt = rotation::L(Vec3(0, (*this)(-0.3, 0.3), (*this)(-0.3, 0.3)));
      J = tilt * J * tilt.transpose();
    } else {
      J.row(0).tail<2>().setZero();
      J.col(0).tail<2>().setZero();
    }
    return J;
  }
  TriadShare share() {
    return {Vec2((*this)(0, 1), (*this)(0, 1)), Vec2((*this)(0, 1), (*this)(0, 1))};
  }
};

template <class M>
double least_eigenvalue(const M& m) {
  return la::symmetric_eigenpairs(MatX(0.5 * (m + m.transpose()))).values[0];
}

FullSection section_of(Draw& draw, double height) {
  FullSection s;
  const double flat = std::pow(10.0, draw(-3, 0)), A = height * height * flat;
  const double Iz = A * height * height / 12, Iy = Iz * flat * flat;
  s.stiffness.diagonal() << 2e11 * A, 6e10 * A, 6e10 * A, 3e11 * Iy, 2e11 * Iy, 2e11 * Iz;
  s.mass = offset_mass(8000 * A, Vec2(draw(-1, 1), draw(-1, 1)) * height, 8000 * (Iy + Iz),
                       8000 * Iy, 8000 * Iz, 0);
  return s;
}

/// The mass matrix on (place, lateral tilt, spin) of both ends at rest in a chart.
template <class Beam>
Matrix<12> mass_of(const Beam& beam, const Mat3& chart) {
  system::NodeState n[2];
  for (system::NodeState& s : n) {
    s.u = s.du = s.ddu = s.t = s.dd = s.ddd = Vec3::Zero();
    s.chart = &chart;
  }
  system::TangentX<14> t;
  t.set_zero();
  beam.add_tangent({&n[0], &n[1]}, {}, t);
  Eigen::Matrix<double, 14, 12> motion = Eigen::Matrix<double, 14, 12>::Zero();
  for (int i = 0; i < 2; ++i) {
    motion.block<3, 3>(7 * i, 6 * i) = Mat3::Identity();
    motion.block<3, 2>(7 * i + 3, 6 * i + 3) = chart.rightCols<2>();
    motion(7 * i + 6, 6 * i + 5) = 1;
  }
  return motion.transpose() * t.M * motion;
}

}  // namespace

TEST(TriadInertia, IsPositiveAndWhole) {
  Draw draw{std::mt19937(7)};
  for (int trial = 0; trial < 2000; ++trial) {
    const Mat3 J = draw.tensor(trial % 3 == 0);
    const MassKind kind = trial % 2 == 0 ? MassKind::corrected : MassKind::consistent;
    const TriadInertia t(J, draw(0, 1), kind, draw.share());
    const Matrix<6> m = on_spins(t);
    ASSERT_GE(least_eigenvalue(m), -1e-14 * J(0, 0)) << trial;
    Mat3 whole = m.topLeftCorner<3, 3>() + m.topRightCorner<3, 3>() + m.bottomLeftCorner<3, 3>() +
                 m.bottomRightCorner<3, 3>();
    whole(1, 1) += t.contained;
    whole(2, 2) += t.contained;
    ASSERT_LT((whole - J).cwiseAbs().maxCoeff(), 1e-14 * J(0, 0)) << trial;
  }
}

TEST(TriadInertia, ElementsShorterThanTheirSectionHavePositiveMass) {
  // Rotary inertia of the mean of both planes in M4 and what is left on the triads, of both signs,
  // gave a negative mass to a flat section whose elements are shorter than it is high.
  Draw draw{std::mt19937(11)};
  for (int trial = 0; trial < 500; ++trial) {
    const double height = std::pow(10.0, draw(-3, 0)), l = height * std::pow(10.0, draw(-1.5, 1.5));
    const FullSection s = section_of(draw, height);
    const MassKind kind = trial % 2 == 0 ? MassKind::corrected : MassKind::consistent;
    const double whole = trial % 4 == 0 ? draw(0, 1) : 1.0;
    TriadShare share;
    share.spin *= whole;
    share.tilt *= trial % 8 == 0 ? 0.0 : whole;
    const Mat3 axes = rotation::L(Vec3(draw(-1, 1), draw(-1, 1), draw(-1, 1)));
    const Mat3 chart = rotation::L(Vec3(draw(-1, 1), draw(-1, 1), draw(-1, 1)));
    const elements::SectionBeam beam(elements::make_section_constants(s, l, 0.0, kind, share),
                                     l * axes.col(0), axes, axes, Vec3::Zero(), Vec3::Zero(), chart,
                                     chart);
    const Matrix<12> M = mass_of(beam, chart);
    const Vector<12> size = M.diagonal().cwiseSqrt();
    ASSERT_GT(M.diagonal().minCoeff(), 0.0) << trial;
    const Matrix<12> scaled =
        size.cwiseInverse().asDiagonal() * M * size.cwiseInverse().asDiagonal();
    ASSERT_GT(least_eigenvalue(scaled), 0.0) << trial << ": " << l / height;
  }
}
