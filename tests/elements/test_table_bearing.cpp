// Tabulated bearing: interpolation, ranges, tangents with the spin's part, power balance.
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/supports/coefficient_grid.hpp>
#include <elements/supports/linear_bearing.hpp>
#include <elements/supports/table_bearing.hpp>

#include <random>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

Mat2 mat(double a, double b, double c, double d) {
  Mat2 m;
  m << a, b, c, d;
  return m;
}

std::vector<CoefficientTable<2>::Values> rows(bool mass) {
  std::vector<CoefficientTable<2>::Values> v;
  for (double s : {0.0, 1.0, 2.5, 4.0, 7.0})
    v.push_back({mat(100 + 10 * s, 5 + s * s, -8 - 3 * s, 120 - s), mat(4 + s, 0.3, 0.2 * s, 5),
                 mass ? mat(0.2 + 0.1 * s, 0.05, -0.04, 0.3) : Mat2(Mat2::Zero())});
  return v;
}
const std::vector<double> spins{0, 100, 250, 400, 700};

}  // namespace

TEST(TableBearing, Conformance) {
  using T = CoefficientTable<2>;
  ConformanceOptions o;
  o.chart = tilted_chart();
  o.v0.assign(12, 0.0);
  o.v0[3] = 320;
  o.tilt = 0.4;
  o.dphi = 20;  // stays inside one cubic piece while differences are taken
  o.ddphi = 300;
  o.symmetric_M = false;
  o.semidefinite_M = false;
  o.passive = false;  // C of a table need not be positive
  for (auto between : {T::Between::linear, T::Between::monotone_cubic}) {
    check_kernel(LateralJoint<TableBearingLaw<false>>{{std::make_shared<T>(
                     spins, rows(false), between, T::Outside::hold)}},
                 o);
    check_kernel(LateralJoint<TableBearingLaw<true>>{{std::make_shared<T>(
                     spins, rows(true), between, T::Outside::hold)}},
                 o);
    check_kernel(
        LateralJoint<TableBearingLaw<true>, true>{
            {std::make_shared<T>(spins, rows(true), between, T::Outside::hold)}, {0.2, -0.1}},
        o);
  }
}

TEST(TableBearing, Interpolation) {
  using T = CoefficientTable<2>;
  T::Values v, dv;
  const T linear(spins, rows(true), T::Between::linear, T::Outside::undefined);
  linear.at(175, v, dv);
  EXPECT_NEAR(v.K(0, 0), 117.5, 1e-12);
  EXPECT_NEAR(dv.K(0, 0), 0.1, 1e-14);
  EXPECT_NEAR(v.K(0, 1), (6 + 11.25) / 2, 1e-12);
  const T cubic(spins, rows(true), T::Between::monotone_cubic, T::Outside::undefined);
  for (std::size_t i = 0; i < spins.size(); ++i) {
    cubic.at(spins[i], v, dv);
    EXPECT_EQ((v.K - rows(true)[i].K).cwiseAbs().maxCoeff(), 0.0);
    EXPECT_EQ((v.M - rows(true)[i].M).cwiseAbs().maxCoeff(), 0.0);
  }
  // monotone data stay monotone, the slope is continuous and is the derivative
  double last = -1;
  for (double s = 0; s <= 700; s += 0.5) {
    cubic.at(s, v, dv);
    EXPECT_GT(v.K(0, 1), last);
    last = v.K(0, 1);
    if (s == 0 || s == 700) continue;
    T::Values a, b, d;
    cubic.at(s - 1e-4, a, d);
    cubic.at(s + 1e-4, b, d);
    EXPECT_NEAR((b.K(0, 1) - a.K(0, 1)) / 2e-4, dv.K(0, 1), 1e-7);
  }
  cubic.at(700.001, v, dv);
  EXPECT_TRUE(std::isnan(v.K(0, 0)));
  EXPECT_FALSE(cubic.covers(-0.001));
  const T held(spins, rows(true), T::Between::monotone_cubic, T::Outside::hold);
  held.at(9e9, v, dv);
  EXPECT_EQ(v.K(0, 0), 170.0);
  EXPECT_EQ(dv.K.norm(), 0.0);
}

// All six motions, from points off the nodes: full matrices without symmetry, at speeds between the
// rows.
TEST(SpatialTableBearing, Conformance) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> d(-1, 1);
  const auto matrix = [&](double size) {
    return Matrix<6>(Matrix<6>::NullaryExpr([&] { return size * d(random); }));
  };
  std::vector<CoefficientValues<6>> rows;
  for (std::size_t i = 0; i < 6; ++i)
    rows.push_back({matrix(100) + 300 * Matrix<6>::Identity(), matrix(3), matrix(0.2)});
  const std::vector<double> three{0, 250, 700};
  const Vector<6> setpoint = Vector<6>::NullaryExpr([&] { return 0.1 * d(random); }),
                  preload = Vector<6>::NullaryExpr([&] { return 20 * d(random); });
  ConformanceOptions o;
  o.v0.assign(12, 0.0);
  o.v0[3] = 320;
  o.tilt = 0.4;
  o.dphi = 20;  // stays inside one cubic piece while differences are taken
  o.ddphi = 300;
  o.symmetric_M = false;
  o.semidefinite_M = false;
  o.passive = false;
  using T = CoefficientTable<6>;
  using G = CoefficientGrid<6>;
  for (const bool linear : {true, false}) {
    const auto table = std::make_shared<T>(std::vector<double>{0, 100, 250, 400, 550, 700}, rows,
                                           linear ? T::Between::linear : T::Between::monotone_cubic,
                                           T::Outside::hold);
    check_kernel(SpatialTableBearing<true, T>{table, {0.3, -0.2}, setpoint, preload}, o);
    const auto grid = std::make_shared<G>(three, std::vector<double>{0, 900}, rows,
                                          linear ? T::Between::linear : T::Between::monotone_cubic,
                                          T::Outside::hold);
    check_kernel(SpatialTableBearing<true, G>{grid, {0.3, -0.2}, setpoint, preload}, o);
  }
  for (auto& r : rows)
    r.M.setZero();
  check_kernel(
      SpatialTableBearing<false, T>{
          std::make_shared<T>(std::vector<double>{0, 100, 250, 400, 550, 700}, rows,
                              T::Between::monotone_cubic, T::Outside::hold),
          {0.3, -0.2},
          setpoint,
          preload},
      o);
}

// With one row it is the linear bearing.
TEST(SpatialTableBearing, IsTheLinearOneWhereNothingChanges) {
  using T = CoefficientTable<6>;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> d(-1, 1);
  const auto matrix = [&] { return Matrix<6>(Matrix<6>::NullaryExpr([&] { return d(random); })); };
  const Matrix<6> K = matrix(), C = matrix(), M = matrix();
  const Vector<6> setpoint = matrix().col(0), preload = matrix().col(0);
  const SpatialTableBearing<true, T> table{
      std::make_shared<T>(std::vector<double>{0.0}, std::vector<CoefficientValues<6>>{{K, C, M}},
                          T::Between::linear, T::Outside::hold),
      {0.3, -0.2},
      setpoint,
      preload};
  const LinearBearing linear(K, C, M, setpoint, preload, 0.3, -0.2);
  const Matrix<12, 1> q = Matrix<12, 1>::NullaryExpr([&] { return 0.3 * d(random); }), v = 2 * q,
                      a = -3 * q;
  const Mat3 chart = Mat3::Identity();
  const NodeFrame<2, 7> frame(q, v, a, chart, Vec3::Zero());
  system::ForceX<14> f = system::ForceX<14>::Zero(), g = f;
  table.add_force(frame.nodes(), {}, f);
  linear.add_force(frame.nodes(), {}, g);
  EXPECT_LT((f - g).norm(), 1e-14 * g.norm());
  EXPECT_EQ(table.load_on_first(frame.nodes(), {}), linear.load_on_first(frame.nodes()));
}

TEST(TableBearing, BadTables) {
  using T = CoefficientTable<2>;
  const auto code = [](std::vector<double> s, std::vector<T::Values> r) {
    try {
      T(std::move(s), std::move(r), T::Between::linear, T::Outside::hold);
      return std::string("none");
    } catch (const Error& e) {
      return e.diagnostics().front().code;
    }
  };
  EXPECT_EQ(code({}, {}), "E81");
  EXPECT_EQ(code({0, 1}, rows(false)), "E81");
  EXPECT_EQ(code({0, 100, 90, 400, 700}, rows(false)), "E81");
  auto bad = rows(false);
  bad[2].C(1, 0) = whirl::nan;
  EXPECT_EQ(code(spins, bad), "E81");
}
