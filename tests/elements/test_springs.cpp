// Spring block and linear bearings.
#include "conformance.hpp"
#include <elements/supports/linear_bearing.hpp>
#include <elements/supports/matrix_part.hpp>
#include <elements/loads/moment.hpp>
#include <elements/supports/spring_block.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

TEST(SpringBlock, Conformance) {
  ConformanceOptions o;
  o.symmetric_K = true;
  o.chart = tilted_chart();
  check_kernel(SpringBlock{2000, 500, -0.75, o.chart.col(0)}, o);
  // after a change of chart the reference axis is no longer the chart's
  check_kernel(SpringBlock{2000, 500, -0.75, Vec3(0.9, 0.1, -0.3).normalized()}, o);
}

TEST(SpringBlock, ForceAndMomentOfTheEulerVector) {
  // -C1 (r_a - r_a0) at a, -C2 gamma: moment about the node -C2 gamma - C1 (s d) x (u + s (d - e))
  const SpringBlock k{2000, 500, -0.75, Vec3::UnitX()};
  Random r(3);
  for (int n = 0; n < 20; ++n) {
    Vector<6> q = r.vector<6>(), zero = Vector<6>::Zero();
    q.tail<2>() *= n < 10 ? 1.5 : 1e-9;
    const Mat3 chart = Mat3::Identity();
    const NodeFrame<1, 7> x(q, zero, zero, chart, Vec3::Zero());
    const auto& s = x.state[0];
    system::ForceX<7> f = Vector<7>::Zero();
    k.add_force(x.nodes(), {}, f);
    const Vec3 ra = q.head<3>() - 0.75 * s.t, gamma(0, q[4], q[5]);
    EXPECT_LT((f.head<3>() - 2000 * ra).norm(), 1e-12);
    EXPECT_LT((moment_of(s, f.segment<3>(3), f[6]) - 500 * gamma - (-0.75 * s.d()).cross(2000 * ra))
                  .norm(),
              1e-11);
    if (n >= 10) {  // a tilt of 1e-9 rad keeps its digits
      q.head<3>().setZero();
      const NodeFrame<1, 7> y(q, zero, zero, chart, Vec3::Zero());
      f.setZero();
      SpringBlock{0, 500, 0, Vec3::UnitX()}.add_force(y.nodes(), {}, f);
      EXPECT_LT((y.director[0].D.transpose() * f.segment<3>(3) - 500 * q.tail<2>()).norm(),
                1e-14 * 500 * q.tail<2>().norm());
    }
  }
}

namespace {

Matrix<6> random_matrix(Random& r, double size) {
  Matrix<6> m;
  for (int i = 0; i < 6; ++i)
    m.row(i) = size * r.vector<6>().transpose();
  return m;
}

}  // namespace

TEST(LinearBearing, Conformance) {
  Random r(11);
  const Matrix<6> A = random_matrix(r, 30), B = random_matrix(r, 3), D = random_matrix(r, 1);
  ConformanceOptions o;
  o.chart = tilted_chart();
  // symmetric: conservative and passive
  o.symmetric_K = true;
  const LinearBearing symmetric(A * A.transpose(), B * B.transpose(), D * D.transpose(),
                                r.vector<6>(), r.vector<6>(), 0.3, -0.2, r.rotation());
  check_kernel(symmetric, o);
  // cross-coupled
  o.symmetric_K = o.symmetric_M = o.semidefinite_M = o.passive = false;
  check_kernel(LinearBearing(A, B, D, r.vector<6>(), r.vector<6>(), 0.3, -0.2, r.rotation()), o);
}

TEST(TranslationalBearing, Conformance) {
  Random r(12);
  const Mat3 A = random_matrix(r, 30).topLeftCorner<3, 3>(),
             B = random_matrix(r, 3).topLeftCorner<3, 3>(),
             D = random_matrix(r, 1).topLeftCorner<3, 3>();
  ConformanceOptions o;
  o.symmetric_K = true;
  check_kernel(TranslationalBearing{A * A.transpose(), B * B.transpose(), D * D.transpose(),
                                    r.vector<3>(), r.vector<3>()},
               o);
  o.symmetric_K = o.symmetric_M = o.semidefinite_M = o.passive = false;
  check_kernel(TranslationalBearing{A, B, D, r.vector<3>(), r.vector<3>()}, o);
}

TEST(LinearBearing, IsTheTranslationalOneAtTheNode) {
  Random r(13);
  const Matrix<6> z = Matrix<6>::Zero();
  Matrix<6> K = z, C = z;
  K.topLeftCorner<3, 3>() = random_matrix(r, 30).topLeftCorner<3, 3>();
  C.topLeftCorner<3, 3>() = random_matrix(r, 30).topLeftCorner<3, 3>();
  const LinearBearing full(K, C, z, Vector<6>::Zero(), Vector<6>::Zero());
  const TranslationalBearing fast{K.topLeftCorner<3, 3>(), C.topLeftCorner<3, 3>(), Mat3::Zero(),
                                  Vec3::Zero(), Vec3::Zero()};
  const Vector<12> q = r.vector<12>(), v = r.vector<12>(), a = r.vector<12>();
  const Mat3 chart = tilted_chart();
  const NodeFrame<2, 7> x(q, v, a, chart, Vec3::Zero());
  EXPECT_LT((full.load_on_first(x.nodes()).head<3>() - fast.force_on_first(x.nodes())).norm(),
            1e-13);
  EXPECT_EQ(full.load_on_first(x.nodes()).tail<3>().norm(), 0.0);
}

TEST(LinearBearing, TiltsAndWholeTurns) {
  const Matrix<6> K = Vector<6>(0, 0, 0, 10, 20, 30).asDiagonal();
  const Matrix<6> z = Matrix<6>::Zero();
  const LinearBearing b(K, z, z, Vector<6>::Zero(), Vector<6>::Zero());
  Vector<12> q = Vector<12>::Zero(), v = q, a = q;
  q[3] = 0.5;
  q[4] = 1e-4;
  q[5] = -2e-4;
  const Mat3 chart = Mat3::Identity();
  NodeFrame<2, 7> x(q, v, a, chart, Vec3::Zero());
  x.state[0].turns = 3;
  const Vector<6> F = b.load_on_first(x.nodes());
  EXPECT_NEAR(F[3], -10 * (0.5 + 3 * two_pi), 1e-12);
  EXPECT_NEAR(F[4], -20 * 1e-4, 20 * 1e-4 * 1e-8);  // sin of the tilt
  EXPECT_NEAR(F[5], 30 * 2e-4, 30 * 2e-4 * 1e-8);
}

// Constant matrices at one and two support points with rotations. (An internal coordinate does not
// fall; the system sees to that, not the kernel.)
TEST(MatrixPart, Conformance) {
  Random r(13);
  const auto matrix = [&](int n, double size) {
    MatX m(n, n);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; i += 6)
        m.block<6, 1>(i, j) = size * r.vector<6>();
    return m;
  };
  ConformanceOptions o;
  o.chart = tilted_chart();
  o.symmetric_K = true;
  const auto square = [](const MatX& m) { return MatX(m * m.transpose()); };
  check_kernel(
      with_rotations<1>(square(matrix(6, 30)), square(matrix(6, 3)), square(matrix(6, 1)), {false}),
      o);
  check_kernel(with_rotations<2>(square(matrix(12, 30)), square(matrix(12, 3)),
                                 square(matrix(12, 1)), {false, false}),
               o);
  // circulatory and gyroscopic parts: their power counts
  o.symmetric_K = o.passive = false;
  check_kernel(
      with_rotations<2>(matrix(12, 30), matrix(12, 3), square(matrix(12, 1)), {false, false}), o);
  MatrixPart<2> plain;
  plain.K = matrix(6, 30);
  plain.C = matrix(6, 3);
  plain.M = square(matrix(6, 1));
  check_kernel(plain, o);
}
