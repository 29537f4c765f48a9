// Coefficients against spin and frequency: interpolation, derivatives, ranges, what is asked and
// what is not.
#include "conformance.hpp"
#include <core/error.hpp>
#include <elements/supports/coefficient_grid.hpp>

using namespace whirl;
using namespace whirl::test;
using namespace whirl::elements;

namespace {

using Grid = CoefficientGrid<2>;
const std::vector<double> spins{0, 100, 250, 400, 700}, frequencies{0, 50, 150, 300, 450, 800};

CoefficientValues<2> smooth(double s, double w) {
  const auto mat = [](double a, double b, double c, double d) {
    return (Mat2() << a, b, c, d).finished();
  };
  s /= 100;
  w /= 100;
  return {mat(100 + 10 * s + 3 * w, 5 + s * s + 0.4 * w * w, -8 - 3 * s * w, 120 - s + w),
          mat(4 + s + 2 * w + 0.5 * s * w, 0.3, 0.2 * s, 5 - 0.1 * w * w),
          mat(0.2 + 0.1 * s, 0.05 * w, -0.04, 0.3)};
}

Grid grid(Grid::Between between, Grid::Outside outside, const std::vector<double>& s = spins,
          const std::vector<double>& w = frequencies) {
  std::vector<CoefficientValues<2>> rows;
  for (double x : s)
    for (double y : w)
      rows.push_back(smooth(x, y));
  return {s, w, rows, between, outside};
}

}  // namespace

TEST(CoefficientGrid, ValuesAndDerivatives) {
  for (const auto between : {Grid::Between::linear, Grid::Between::monotone_cubic}) {
    const Grid g = grid(between, Grid::Outside::hold);
    CoefficientValues<2> v, ds, dw, p, m, x, y;
    for (double s : spins)
      for (double w : frequencies) {
        g.at(s, w, v, ds, dw);
        EXPECT_LT((v.K - smooth(s, w).K).norm() + (v.C - smooth(s, w).C).norm(),
                  1e-12 * v.K.norm());
      }
    for (const auto& [s, w] : {std::pair{30.0, 20.0}, std::pair{120.0, 400.0},
                               std::pair{650.0, 500.0}, std::pair{300.0, 60.0}}) {
      g.at(s, w, v, ds, dw);
      // what is linear in either variable comes back exactly (cxx has the product s w too)
      EXPECT_NEAR(v.K(0, 0), smooth(s, w).K(0, 0), 1e-11);
      EXPECT_NEAR(v.C(0, 0), smooth(s, w).C(0, 0), 1e-11);
      // central differences: exact for the cubics up to h^2 f'''/6
      const double h = 1e-3;
      g.at(s + h, w, p, x, y);
      g.at(s - h, w, m, x, y);
      EXPECT_LT(((p.K - m.K) / (2 * h) - ds.K).norm() + ((p.C - m.C) / (2 * h) - ds.C).norm() +
                    ((p.M - m.M) / (2 * h) - ds.M).norm(),
                1e-9);
      g.at(s, w + h, p, x, y);
      g.at(s, w - h, m, x, y);
      EXPECT_LT(((p.K - m.K) / (2 * h) - dw.K).norm() + ((p.C - m.C) / (2 * h) - dw.C).norm(),
                1e-9);
    }
  }
}

// Halved spacing: bilinear interpolation errs by nearly a quarter (the samples do not meet the
// middle of every cell), the cubic by an eighth.
TEST(CoefficientGrid, OrderOfTheError) {
  for (const auto& [between, factor] :
       {std::pair{Grid::Between::linear, 3.7}, std::pair{Grid::Between::monotone_cubic, 6.5}}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      std::vector<double> s, w;
      std::vector<CoefficientValues<2>> rows;
      const int n = k ? 20 : 10;
      for (int i = 0; i <= n; ++i) {
        s.push_back(i / double(n));
        w.push_back(i / double(n));
      }
      for (double x : s)
        for (double y : w)
          rows.push_back({Mat2::Constant(std::exp(x + 0.7 * y)), Mat2::Zero(), Mat2::Zero()});
      const Grid g(s, w, rows, between, Grid::Outside::undefined);
      CoefficientValues<2> v, ds, dw;
      error[k] = 0;
      for (double x = 0.21; x < 0.8; x += 0.0137)
        for (double y = 0.21; y < 0.8; y += 0.0171) {
          g.at(x, y, v, ds, dw);
          error[k] = std::max(error[k], std::abs(v.K(0, 0) - std::exp(x + 0.7 * y)));
        }
    }
    EXPECT_GT(error[0] / error[1], factor);
    EXPECT_LT(error[1], between == Grid::Between::linear ? 2.5e-3 : 2e-4);
  }
}

TEST(CoefficientGrid, AskedAndSynchronous) {
  const Grid g = grid(Grid::Between::monotone_cubic, Grid::Outside::undefined, spins,
                      {100, 200, 300, 450, 800});
  CoefficientValues<2> v, dv, x, ds, dw;
  const double none = whirl::nan;
  g.at(320.0, none, v, dv);
  g.at(320.0, 320.0, x, ds, dw);
  EXPECT_EQ(v.K, x.K);
  EXPECT_LT((dv.K - ds.K - dw.K).norm(), 1e-15 * dv.K.norm());
  g.at(40.0, none, v, dv);  // below the first frequency: held there
  g.at(40.0, 100.0, x, ds, dw);
  EXPECT_EQ(v.K, x.K);
  EXPECT_EQ(dv.K, ds.K);
  g.at(320.0, 600.0, v, dv);
  g.at(320.0, 600.0, x, ds, dw);
  EXPECT_EQ(v.C, x.C);
  EXPECT_EQ(dv.C, ds.C);
  g.at(320.0, 50.0, v, dv);  // asked, and not in the table
  EXPECT_TRUE(v.K.hasNaN());
  g.at(701.0, none, v, dv);
  EXPECT_TRUE(v.K.hasNaN());
  // beyond the end by the rounding of the end is at the end, also where the table starts at zero
  g.at(700.0 * (1 + 1e-12), 800.0 * (1 + 1e-12), v, ds, dw);
  g.at(700.0, 800.0, x, ds, dw);
  EXPECT_LT((v.K - x.K).norm(), 1e-9 * x.K.norm());
  const Grid held = grid(Grid::Between::linear, Grid::Outside::hold);
  held.at(900.0, 2000.0, v, ds, dw);
  held.at(700.0, 800.0, x, ds, dw);
  EXPECT_EQ(v.K, x.K);
}

TEST(CoefficientGrid, Conformance) {
  ConformanceOptions o;
  o.chart = tilted_chart();
  o.v0.assign(12, 0.0);
  o.v0[3] = 350;
  o.tilt = 0.4;
  o.dphi = 20;  // stays inside one piece of the grid while differences are taken
  o.ddphi = 300;
  o.symmetric_M = false;
  o.semidefinite_M = false;
  o.passive = false;  // C of a table need not be positive
  for (const auto between : {Grid::Between::linear, Grid::Between::monotone_cubic}) {
    const auto g = std::make_shared<Grid>(grid(between, Grid::Outside::hold));
    check_kernel(LateralJoint<TableBearingLaw<true, Grid>, true>{{g}, {0.2, -0.1}}, o);
    o.frequency = 500.0;
    check_kernel(LateralJoint<TableBearingLaw<true, Grid>>{{g}}, o);
    o.frequency = whirl::nan;
  }
}

TEST(CoefficientGrid, BadTables) {
  const std::vector<CoefficientValues<2>> two(2, smooth(1, 1));
  const auto make = [&](std::vector<double> s, std::vector<double> w,
                        std::vector<CoefficientValues<2>> r) {
    Grid g(std::move(s), std::move(w), r, Grid::Between::linear, Grid::Outside::hold);
  };
  EXPECT_THROW(make({}, {}, {}), Error);
  EXPECT_THROW(make({1, 2}, {1, 2}, two), Error);
  EXPECT_THROW(make({2, 1}, {1}, two), Error);
  EXPECT_THROW(make({1}, {2, 1}, two), Error);
  EXPECT_THROW(make({1}, {-1, 1}, two), Error);
  EXPECT_THROW(
      make({1}, {1, 2}, {smooth(1, 1), {Mat2::Constant(whirl::nan), Mat2::Zero(), Mat2::Zero()}}),
      Error);
}
