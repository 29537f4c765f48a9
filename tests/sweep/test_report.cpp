// What the report of a sweep says of its samples: bounds of percentiles, fits, matrices of points.
#include <sweep/confidence.hpp>
#include <sweep/pictures.hpp>
#include <sweep/scatter_matrix.hpp>
#include <sweep/surface.hpp>
#include <core/error.hpp>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <random>

namespace whirl::sweep {
namespace {

/// Two keys, x from 0 to 2 and y from 10 to 30, and a response.
Plan plan_of(const std::vector<std::string>& vary, std::int64_t samples,
             const std::string& sampling = "random") {
  Plan plan;
  std::vector<Factor> factors;
  for (const std::string& v : vary)
    factors.push_back(read_factor(v));
  const Sampling laid = sampling == "sobol" ? Sampling::sobol
                        : sampling == "lhs" ? Sampling::latin_hypercube
                                            : Sampling::random;
  plan.design = Design(std::move(factors), samples, laid, 7);
  plan.responses.push_back(read_response("z=t:c"));
  return plan;
}

template <class Function>
Columns columns_by(const Plan& plan, Function f) {
  Columns c;
  const std::size_t keys = plan.design.factors().size();
  c.factors.resize(keys);
  c.responses.resize(1);
  c.units = {"mm"};
  for (std::int64_t run = 0; run < plan.design.runs(); ++run) {
    const auto values = plan.design.values(run);
    std::vector<double> point;
    for (std::size_t k = 0; k < keys; ++k) {
      point.push_back(leading_number(values[k]));
      c.factors[k].push_back(point.back());
    }
    c.responses[0].push_back(f(point));
    c.weight.push_back(1);
  }
  return c;
}

const std::vector<std::string> two_keys{"a.x=uniform(0, 2)", "a.y=uniform(10, 30)"};

}  // namespace

// Places from 1 by exact sums of binomial probabilities in fractions.
TEST(QuantileBounds, AreThoseOfTheBinomialDistribution) {
  struct Known {
    std::size_t samples;
    double p;
    std::size_t low, high;
  };
  for (const Known& k : {Known{6, 0.5, 1, 6},
                         {20, 0.5, 6, 15},
                         {72, 0.05, 1, 9},
                         {72, 0.95, 64, 72},
                         {73, 0.05, 1, 9},
                         {100, 0.05, 1, 11},
                         {100, 0.5, 40, 61},
                         {100, 0.95, 90, 100},
                         {200, 0.05, 4, 17},
                         {200, 0.5, 86, 115},
                         {500, 0.05, 16, 36},
                         {500, 0.95, 465, 485}}) {
    const auto b = bounds_of_quantile(k.samples, k.p);
    ASSERT_TRUE(b) << k.samples << " " << k.p;
    EXPECT_EQ(b->low + 1, k.low) << k.samples << " " << k.p;
    EXPECT_EQ(b->high + 1, k.high) << k.samples << " " << k.p;
  }
  EXPECT_FALSE(bounds_of_quantile(5, 0.5));
  EXPECT_FALSE(bounds_of_quantile(71, 0.05));
  EXPECT_FALSE(bounds_of_quantile(71, 0.95));
  EXPECT_FALSE(bounds_of_quantile(0, 0.5));
  EXPECT_EQ(samples_for_bounds(0.5), 6u);
  EXPECT_EQ(samples_for_bounds(0.05), 72u);
  EXPECT_EQ(samples_for_bounds(0.95), 72u);
}

// Of many samples the bounds of the median are n/2 -+ 1.96 sqrt(n)/2.
TEST(QuantileBounds, OfManySamplesAreThoseOfANormalDistribution) {
  const double n = 1e6;
  const auto b = bounds_of_quantile(1000000, 0.5);
  ASSERT_TRUE(b);
  EXPECT_NEAR(static_cast<double>(b->low), 0.5 * n - 1.959964 * 0.5 * std::sqrt(n), 2);
  EXPECT_NEAR(static_cast<double>(b->high), 0.5 * n + 1.959964 * 0.5 * std::sqrt(n), 2);
}

// Whatever the distribution: the truth lies inside in 95 % of cases, and not in all.
TEST(QuantileBounds, HoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(3);
  std::exponential_distribution<double> draw(1.0);
  const double truth = -std::log(1 - 0.95);
  const auto places = bounds_of_quantile(150, 0.95);
  ASSERT_TRUE(places);
  int inside = 0;
  constexpr int cases = 4000;
  for (int k = 0; k < cases; ++k) {
    std::vector<double> x(150);
    for (double& v : x)
      v = draw(random);
    std::sort(x.begin(), x.end());
    inside += x[places->low] <= truth && truth <= x[places->high];
  }
  EXPECT_GT(inside, 0.94 * cases);
  EXPECT_LT(inside, 0.99 * cases);
}

TEST(QuantileBounds, SayWhyThereAreNone) {
  std::vector<double> values(100);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = static_cast<double>((37 * k) % 100);  // 0 .. 99, mixed
  const auto all = bounds_of_response(plan_of(two_keys, 100), values);
  EXPECT_EQ(all.missing, "");
  ASSERT_TRUE(all.p05 && all.median && all.p95);
  EXPECT_EQ(all.p05->low, 0);
  EXPECT_EQ(all.p05->high, 10);
  EXPECT_EQ(all.median->low, 39);
  EXPECT_EQ(all.median->high, 60);
  EXPECT_EQ(all.p95->low, 89);
  EXPECT_EQ(all.p95->high, 99);
  values.resize(50);
  const auto few = bounds_of_response(plan_of(two_keys, 50), values);
  EXPECT_TRUE(few.median);
  EXPECT_FALSE(few.p05);
  EXPECT_EQ(few.missing, "not enough samples for 5 % and 95 %: they take 72");
  values.resize(5);
  EXPECT_NE(bounds_of_response(plan_of(two_keys, 5), values).missing.find("the median takes 6"),
            std::string::npos);
  EXPECT_NE(bounds_of_response(plan_of({"a.x=1:9:100"}, 1), values).missing.find("list"),
            std::string::npos);
  EXPECT_NE(bounds_of_response(plan_of(two_keys, 128, "sobol"), values).missing.find("scheme"),
            std::string::npos);
  const auto drawn = plan_of({"a.x=normal(1, 0.1) drawn normal(1, 0.3)"}, 100);
  EXPECT_NE(bounds_of_response(drawn, values).missing.find("weighted"), std::string::npos);
}

TEST(QuadraticFit, IsExactOfAQuadratic) {
  const Plan plan = plan_of(two_keys, 40);
  const auto f = [](const std::vector<double>& p) {
    return 3 + 2 * p[0] - 0.1 * p[1] + p[0] * p[0] - 0.25 * p[0] * p[1] + 0.02 * p[1] * p[1];
  };
  Columns c = columns_by(plan, f);
  c.responses[0][7] = nan;  // a run that failed
  const auto fit = QuadraticFit::of(c.factors, c.responses[0]);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->runs(), 39u);
  EXPECT_LT(fit->residual(), 1e-11);
  EXPECT_LT(fit->share_left(), 1e-20);
  for (const std::vector<double>& p : {std::vector<double>{0.3, 12}, {1.9, 28}, {1, 20}})
    EXPECT_NEAR(fit->at(p), f(p), 1e-11);
}

// Noise of a known deviation is what stays.
TEST(QuadraticFit, StatesTheResidual) {
  const Plan plan = plan_of(two_keys, 4000);
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.4);
  const Columns c =
      columns_by(plan, [&](const std::vector<double>& p) { return 5 * p[0] + noise(random); });
  const auto fit = QuadraticFit::of(c.factors, c.responses[0]);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->residual(), 0.4, 0.4 * 4 / std::sqrt(2 * 4000.0));
  const double variance = 25.0 * 4 / 12;  // of 5 x, x uniform over 2
  EXPECT_NEAR(fit->share_left(), 0.16 / (0.16 + variance), 2e-3);
}

TEST(QuadraticFit, TakesTwiceAsManyRunsAsCoefficients) {
  const auto sum = [](const std::vector<double>& p) { return p[0] + p[1]; };
  const Columns few = columns_by(plan_of(two_keys, 11), sum);
  EXPECT_FALSE(QuadraticFit::of(few.factors, few.responses[0]));
  const Columns enough = columns_by(plan_of(two_keys, 12), sum);
  EXPECT_TRUE(QuadraticFit::of(enough.factors, enough.responses[0]));
  const Columns same = columns_by(plan_of({"a.x=uniform(0, 2)", "a.y=3,3"}, 30), sum);
  EXPECT_FALSE(QuadraticFit::of(same.factors, same.responses[0]));
}

TEST(Contours, OfTwoListsAreBetweenTheRuns) {
  const Plan plan = plan_of({"a.x=0:2:5", "a.y=10:30:3"}, 1);
  const auto plane = [](const std::vector<double>& p) { return 10 * p[0] + p[1]; };
  const plot::Figure f = contours(plan, columns_by(plan, plane), 0);
  ASSERT_EQ(f.axes.size(), 1u);
  ASSERT_EQ(f.axes[0].heat.size(), 1u);
  const plot::HeatMap& heat = f.axes[0].heat[0];
  // from 10 to 50 in bands of 5: a cell has the middle of its band
  EXPECT_EQ(heat.min, 10);
  EXPECT_EQ(heat.max, 50);
  for (int iy = 0; iy < heat.ny; iy += 7)
    for (int ix = 0; ix < heat.nx; ix += 7) {
      const double x = 2 * (ix + 0.5) / heat.nx, y = 10 + 20 * (iy + 0.5) / heat.ny;
      const double band = heat.values[static_cast<std::size_t>(iy * heat.nx + ix)];
      EXPECT_NEAR(band, plane({x, y}), 2.5 + 1e-9);
    }
  // lines of the levels lie on their level
  const auto levels = f.axes[0].series.size() - 1;  // the last one: dots
  EXPECT_GE(levels, 7u);
  for (std::size_t k = 0; k < levels; ++k)
    for (std::size_t i = 0; i < f.axes[0].series[k].x.size(); ++i) {
      const double z = plane({f.axes[0].series[k].x[i], f.axes[0].series[k].y[i]});
      if (std::isnan(z)) continue;
      EXPECT_NEAR(z / 5, std::round(z / 5), 1e-9);
    }
  EXPECT_EQ(f.axes[0].series.back().x.size(), 15u);
}

TEST(Contours, OfSamplesSayWhatTheFitLeaves) {
  const Plan plan = plan_of({two_keys[0], two_keys[1], "a.w=uniform(0, 1)"}, 60);
  const plot::Figure f =
      contours(plan, columns_by(plan, [](const std::vector<double>& p) { return p[0] * p[1]; }), 0);
  ASSERT_EQ(f.axes.size(), 1u);
  EXPECT_EQ(f.axes[0].x.label, "a.x");
  EXPECT_EQ(f.axes[0].y.label, "a.y");
  EXPECT_NE(f.caption.find("60 runs"), std::string::npos) << f.caption;
  EXPECT_NE(f.caption.find("% of the variance; the other keys at their medians"), std::string::npos)
      << f.caption;
  const Plan words = plan_of({"a.x=uniform(0, 2)", "a.oil=VG32,VG46"}, 60);
  EXPECT_TRUE(
      contours(words, columns_by(words, [](const std::vector<double>& p) { return p[0]; }), 0)
          .axes.empty());
}

TEST(Contours, OfOneValueAreNone) {
  // a fit of equal values differs by rounding, which no level parts
  const Plan plan = plan_of(two_keys, 60);
  const Columns c = columns_by(plan, [](const std::vector<double>&) { return 71.17625434171771; });
  EXPECT_TRUE(contours(plan, c, 0).axes.empty());
}

TEST(WorstRuns, AreOfTheDistribution) {
  Plan plan = plan_of({"a.x=uniform(8, 12) drawn normal(10, 4)"}, 100);
  plan.worst.push_back({0, false, 3});
  std::map<std::int64_t, Row> rows;
  for (std::int64_t run = 0; run < plan.design.runs(); ++run) {
    rows[run].run = run;
    rows[run].answers.push_back({leading_number(plan.design.values(run)[0]), "mm", "", ""});
  }
  const std::vector<std::int64_t> worst = worst_runs(plan, rows);
  ASSERT_EQ(worst.size(), 3u);
  for (const std::int64_t run : worst)
    EXPECT_LE(rows[run].answers[0].value, 12.0);
}

TEST(ScatterMatrix, HasEveryColumnAgainstEveryOther) {
  const Plan plan = plan_of(two_keys, 700);
  const plot::Figure f =
      scatter_matrix(plan, columns_by(plan, [](const std::vector<double>& p) { return -p[0]; }));
  ASSERT_EQ(f.axes.size(), 9u);
  EXPECT_EQ(f.columns, 3);
  for (const std::size_t k : {0u, 4u, 8u}) {
    ASSERT_EQ(f.axes[k].bars.size(), 1u);
    double runs = 0;
    for (const double h : f.axes[k].bars[0].height)
      runs += h;
    EXPECT_EQ(runs, 700);
  }
  ASSERT_EQ(f.axes[2].notes.size(), 1u);  // x against the response
  EXPECT_EQ(f.axes[2].notes[0].text, "-1.00");
  const plot::Series& cloud = f.axes[6].series.at(0);
  EXPECT_EQ(cloud.x.size(), 350u);
  for (std::size_t k = 0; k < cloud.x.size(); ++k)
    EXPECT_EQ(cloud.y[k], -cloud.x[k]);
}

TEST(ScatterMatrix, LeavesOutTheKeysThatMatterLeast) {
  std::vector<std::string> keys;
  for (int k = 0; k < 12; ++k)
    keys.push_back("a.k" + std::to_string(k) + "=uniform(0, 1)");
  const Plan plan = plan_of(keys, 200);
  const plot::Figure f = scatter_matrix(
      plan, columns_by(plan, [](const std::vector<double>& p) { return p[3] + p[9]; }));
  ASSERT_EQ(f.axes.size(), 64u);
  std::vector<std::string> shown;
  for (std::size_t k = 56; k < 64; ++k)
    shown.push_back(f.axes[k].x.label);
  for (const char* name : {"a.k3", "a.k9", "z"})
    EXPECT_NE(std::find(shown.begin(), shown.end(), name), shown.end()) << name;
  EXPECT_NE(f.caption.find("8 of 13 columns"), std::string::npos) << f.caption;
}

TEST(Responses, NamesThatSpreadsheetsTakeForFormulasAreRefused) {
  for (const char* text : {"@SUM(A1:A9)=t:c", "-x=t:c", "+x=t:c", "@t:c", "\tx=t:c"})
    EXPECT_THROW(read_response(text), Error) << text;
  EXPECT_EQ(read_response("x-y=t:c").name, "x-y");
}

}  // namespace whirl::sweep
