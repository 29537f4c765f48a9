// Schemes of sensitivity against functions whose indices and effects are known.
#include <sweep/confidence.hpp>
#include <sweep/design.hpp>
#include <sweep/outcome.hpp>
#include <sweep/sampling.hpp>
#include <sweep/sensitivity.hpp>
#include <core/types.hpp>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <set>

namespace whirl::sweep {
namespace {

/// Values of f over all runs of a design of distributions, numbers as --set would get them.
std::vector<double> runs_of(const Design& d,
                            const std::function<double(const std::vector<double>&)>& f) {
  std::vector<double> out;
  for (std::int64_t run = 0; run < d.runs(); ++run) {
    std::vector<double> x;
    for (const std::string& value : d.values(run))
      x.push_back(std::stod(value));
    out.push_back(f(x));
  }
  return out;
}

std::vector<Factor> ishigami_factors() {
  std::vector<Factor> f;
  for (const char* name : {"a.x", "a.y", "a.z"})
    f.push_back(
        read_factor(fmt::format("{}=uniform(-3.141592653589793, 3.141592653589793)", name)));
  return f;
}

// T. Ishigami and T. Homma, ISUMA 1990, doi 10.1109/ISUMA.1990.151285: closed forms.
TEST(SobolIndices, OfIshigamisFunction) {
  constexpr double a = 7, b = 0.1;
  const Design d(ishigami_factors(), 4096, Sampling::saltelli, 5);
  ASSERT_EQ(d.runs(), 4096 * 5);
  const auto y = runs_of(d, [](const auto& x) {
    return std::sin(x[0]) + a * std::pow(std::sin(x[1]), 2) +
           b * std::pow(x[2], 4) * std::sin(x[0]);
  });
  const double v1 = 0.5 * std::pow(1 + b * std::pow(pi, 4) / 5, 2), v2 = a * a / 8;
  const double v13 = b * b * std::pow(pi, 8) * (1.0 / 18 - 1.0 / 50), v = v1 + v2 + v13;
  std::size_t used = 0;
  const auto i = sobol_indices(y, 3, used);
  ASSERT_EQ(used, 4096u);
  const double first[] = {v1 / v, v2 / v, 0}, total[] = {(v1 + v13) / v, v2 / v, v13 / v};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(i[k].first, first[k], 0.01) << k;
    EXPECT_NEAR(i[k].total, total[k], 0.01) << k;
    EXPECT_LT(std::abs(i[k].first - first[k]), 3 * i[k].first_error + 1e-3) << k;
    EXPECT_LT(i[k].first_error, 0.03);
  }
}

TEST(SobolIndices, LeaveOutPointsWithFailedRuns) {
  const Design d(ishigami_factors(), 64, Sampling::saltelli, 5);
  auto y = runs_of(d, [](const auto& x) { return 2 * x[0] + x[2]; });
  y[3 * 5 + 4] = nan;
  std::size_t used = 0;
  const auto i = sobol_indices(y, 3, used);
  EXPECT_EQ(used, 63u);
  EXPECT_EQ(i[1].first, 0);  // does not matter at all
  EXPECT_EQ(i[1].total, 0);
  EXPECT_NEAR(i[0].total, 0.8, 0.1);
  const std::vector<double> same(y.size(), 1.0);
  EXPECT_TRUE(sobol_indices(same, 3, used).empty());
}

TEST(MorrisEffects, OfAStraightLineAreItsSlopes) {
  std::vector<Factor> f{read_factor("a.x=uniform(0, 1)"), read_factor("a.y=uniform(0, 1)"),
                        read_factor("a.z=uniform(0, 1)")};
  const Design d(f, 8, Sampling::morris, 3);
  ASSERT_EQ(d.runs(), 32);
  const auto y = runs_of(d, [](const auto& x) { return 3 * x[0] - 2 * x[1] + x[2] * x[2]; });
  const auto e = morris_effects(y, 3, 3);
  EXPECT_NEAR(e[0].mean, 3 * 0.95, 1e-12);  // levels 0 .. 1 stand at quantiles 0.025 .. 0.975
  EXPECT_NEAR(e[0].deviation, 0, 1e-12);
  EXPECT_NEAR(e[1].mean, -2 * 0.95, 1e-12);
  EXPECT_NEAR(e[1].magnitude, 2 * 0.95, 1e-12);
  EXPECT_GT(e[2].deviation, 0.05);
  EXPECT_EQ(e[2].paths, 8u);
}

TEST(MorrisEffects, EveryPathMovesEveryNumberOnce) {
  const std::set<double> levels{0, 1.0 / 3, 2.0 / 3, 1};
  for (std::int64_t path = 0; path < 50; ++path) {
    std::set<std::size_t> moved;
    for (std::size_t k = 0; k < 4; ++k) {
      moved.insert(morris_moved(9, 4, path, k));
      for (std::size_t j = 0; j < 4; ++j) {
        const std::int64_t run = 5 * path + static_cast<std::int64_t>(k);
        const double now = morris_level(9, j, 4, run), next = morris_level(9, j, 4, run + 1);
        EXPECT_TRUE(levels.count(now)) << now;
        EXPECT_NEAR(std::abs(next - now), j == morris_moved(9, 4, path, k) ? 2.0 / 3 : 0.0, 1e-15);
      }
    }
    EXPECT_EQ(moved.size(), 4u);
  }
}

TEST(OneAtATime, StandsAtMediansAndMovesOne) {
  const Design d({read_factor("a.x=uniform(0, 1)"), read_factor("a.y=normal(5, 1)")}, 1,
                 Sampling::one_at_a_time, 1);
  ASSERT_EQ(d.runs(), 5);
  EXPECT_EQ(d.values(0), (std::vector<std::string>{"0.5", "5"}));
  EXPECT_EQ(d.values(1), (std::vector<std::string>{"0.05", "5"}));
  EXPECT_EQ(d.values(2), (std::vector<std::string>{"0.95", "5"}));
  EXPECT_EQ(d.values(3)[0], "0.5");
  EXPECT_NEAR(std::stod(d.values(4)[1]), 5 + 1.6448536269514722, 1e-12);
}

TEST(WeightedSamples, FindARareTail) {
  // P(z > 4) of a standard normal z, by samples around 4
  const Design d({read_factor("a.x=normal(0, 1) drawn normal(4, 1)")}, 4000, Sampling::random, 2);
  const auto y = runs_of(d, [](const auto& x) { return x[0]; });
  std::vector<double> w;
  for (std::int64_t run = 0; run < d.runs(); ++run)
    w.push_back(d.weight(run));
  const Probability p = probability_beyond(y, w, 4, true);
  const double exact = normal_probability(-4);
  EXPECT_NEAR(exact, 3.167124183311986e-5, 1e-17);
  EXPECT_LT(std::abs(p.value - exact), 3 * p.error);
  EXPECT_LT(p.error, 0.05 * exact);
  EXPECT_GT(p.runs, 1800u);
  const Design plain({read_factor("a.x=normal(0, 1)")}, 50, Sampling::random, 2);
  EXPECT_EQ(plain.weight(7), 1.0);
}

// Normal variables of correlation 0.6: P(x > 1.5 and y > 1) is 0.0384744466 (bivariate normal
// integral). The samples are of other distributions.
TEST(WeightedSamples, OfCorrelatedKeysCountByTheirJointDensities) {
  const Design d({read_factor("a.x=normal(0, 1) drawn normal(1, 1.3)"),
                  read_factor("a.y=normal(0, 1) drawn uniform(-5, 5)")},
                 40000, Sampling::random, 3, {read_correlation("a.x,a.y=0.6")});
  const std::vector<double> hits =
      runs_of(d, [](const std::vector<double>& x) { return x[0] > 1.5 && x[1] > 1 ? 1.0 : 0.0; });
  double sum = 0, of_hits = 0;
  for (std::int64_t run = 0; run < d.runs(); ++run) {
    sum += d.weight(run);
    of_hits += d.weight(run) * hits[static_cast<std::size_t>(run)];
  }
  EXPECT_NEAR(sum / static_cast<double>(d.runs()), 1.0, 0.02);
  EXPECT_NEAR(of_hits / sum, 0.0384744466, 0.03 * 0.0384744466);
}

TEST(Distributions, ScoresAreThoseOfTheirQuantiles) {
  for (const char* law : {"uniform(2, 5)", "loguniform(2, 5)", "triangular(1, 2, 6)",
                          "triangular(1, 1, 6)", "normal(3, 2)", "lognormal(4, 0.3)"}) {
    const Factor f = read_factor(std::string("a.x=") + law);
    for (const double p : {1e-6, 0.02, 0.2, 0.5, 0.9, 0.999})
      EXPECT_NEAR(f.score(f.at_quantile(p)), normal_quantile(p), 1e-6) << law << " at " << p;
  }
}

// What the distribution cannot give is neither least nor largest of it.
TEST(WeightedSamples, OfNoWeightAreNone) {
  const std::vector<double> x{-9, 1, 2, 3, 9}, w{0, 1, 1, 1, 0};
  const WeightedStatistics s = weighted_statistics(x, w);
  EXPECT_DOUBLE_EQ(s.least, 1);
  EXPECT_DOUBLE_EQ(s.largest, 3);
  EXPECT_EQ(probability_beyond(x, w, 2.5, true).runs, 1u);
  EXPECT_TRUE(std::isnan(weighted_statistics({5.0}, {0.0}).mean));
}

TEST(WeightedSamples, OfEqualWeightAreOrdinaryOnes) {
  const std::vector<double> x{3, 1, 2, nan, 5, 4}, one(6, 1.0);
  const WeightedStatistics w = weighted_statistics(x, one);
  const Statistics s = statistics_of({3, 1, 2, 5, 4});
  EXPECT_DOUBLE_EQ(w.runs, 5);
  EXPECT_DOUBLE_EQ(w.mean, s.mean);
  EXPECT_DOUBLE_EQ(w.median, s.median);
  EXPECT_DOUBLE_EQ(w.largest, 5);
  EXPECT_NEAR(w.deviation, s.deviation * std::sqrt(4.0 / 5), 1e-12);
  const Probability p = probability_beyond(x, one, 3.5, true);
  EXPECT_DOUBLE_EQ(p.value, 0.4);
  EXPECT_DOUBLE_EQ(p.error, std::sqrt(0.4 * 0.6 / 4));
  // the one that gave none may be on either side
  EXPECT_EQ(p.without, 1u);
  EXPECT_DOUBLE_EQ(p.least, 2.0 / 6);
  EXPECT_DOUBLE_EQ(p.most, 3.0 / 6);
  // none and all: with that probability one outcome in twenty is this one
  for (const double limit : {9.0, 0.0}) {
    const Probability sure = probability_beyond(x, one, limit, true);
    EXPECT_DOUBLE_EQ(sure.value, limit > 0 ? 0.0 : 1.0);
    EXPECT_NEAR(std::pow(1 - sure.error, 5), 0.05, 1e-12);
  }
  EXPECT_TRUE(std::isnan(probability_beyond(x, std::vector<double>(6, 0.5), 9, true).error));
}

// Of N(0, 1), drawn from N(4, 1.2): the weights of 3,000 samples come to a tenth of what they are in the mean.
TEST(WeightedSamples, SayHowMuchOfTheDistributionTheyStandFor) {
  const auto share_of = [](const char* law) {
    const Design design({read_factor(law)}, 3000, Sampling::random, 1);
    std::vector<double> weights;
    for (std::int64_t run = 0; run < design.runs(); ++run)
      weights.push_back(design.weight(run));
    return covered_share(weights);
  };
  EXPECT_LT(share_of("a.x=normal(0, 1) drawn normal(4, 1.2)"), 0.5);
  EXPECT_LT(share_of("a.x=normal(0, 1) drawn normal(6, 1)"), 0.5);
  EXPECT_EQ(share_of("a.x=normal(0, 1) drawn normal(1, 1.5)"), 1.0);
  EXPECT_EQ(share_of("a.x=normal(0, 1) drawn uniform(-6, 6)"), 1.0);
  EXPECT_EQ(share_of("a.x=normal(0, 1)"), 1.0);
}

std::vector<double> weights_of(const Design& d) {
  std::vector<double> w;
  for (std::int64_t run = 0; run < d.runs(); ++run)
    w.push_back(d.weight(run));
  return w;
}

// x = N(1.5, 0.5), drawn from N(0, 1.5); half of the runs, those below 0, give no value: 0.0013 of
// the distribution.
TEST(WeightedSamples, WithFailedRunsGiveProbabilitiesWithinTheirBounds) {
  const Design d({read_factor("a.x=normal(1.5, 0.5) drawn normal(0, 1.5)")}, 2000, Sampling::random,
                 1);
  const auto y = runs_of(d, [](const auto& x) { return x[0] < 0 ? nan : x[0]; });
  const std::vector<double> w = weights_of(d);
  for (const double limit : {-1.0, 0.5, 1.5, 2.0, 2.5}) {
    const double failing = normal_probability(-3);
    const double exact = limit < 0 ? 1 : normal_probability((1.5 - limit) / 0.5) / (1 - failing);
    const Probability p = probability_beyond(y, w, limit, true);
    EXPECT_NEAR(p.value, exact, limit < 0 ? 1e-12 : 3 * p.error) << limit;
    EXPECT_LE(p.least, p.value) << limit;
    EXPECT_GE(p.most, p.value) << limit;
    EXPECT_LT(p.most - p.least, 0.005) << limit;
    EXPECT_LE(p.most, 1.0) << limit;
    EXPECT_GT(p.without, 900u);
  }
}

TEST(WeightedSamples, OfWhichAllLieBeyondLieThereSurely) {
  const Design d({read_factor("a.x=normal(0, 1) drawn normal(0.5, 1.3)")}, 500, Sampling::random,
                 3);
  const auto y = runs_of(d, [](const auto& x) { return x[0]; });
  EXPECT_DOUBLE_EQ(probability_beyond(y, weights_of(d), -100, true).value, 1.0);
}

// Of N(100, 10), drawn from N(150, 10): next to nothing of the distribution.
TEST(WeightedSamples, ThatMissTheirDistributionBoundAProbability) {
  const Design d({read_factor("a.x=normal(100, 10) drawn normal(150, 10)")}, 400, Sampling::random,
                 1);
  const auto y = runs_of(d, [](const auto& x) { return x[0]; });
  const std::vector<double> w = weights_of(d);
  const auto holds = [&](double limit, bool above, double exact) {
    const Probability p = probability_beyond(y, w, limit, above);
    EXPECT_LT(p.covered, 0.5);
    EXPECT_TRUE(std::isnan(p.value)) << limit;
    EXPECT_TRUE(std::isnan(p.error)) << limit;
    EXPECT_LE(p.least, exact) << limit;
    EXPECT_GE(p.most, exact) << limit;
  };
  holds(110, true, normal_probability(-1));
  holds(80, true, normal_probability(2));
  holds(150, false, normal_probability(5));
  // what is drawn for is known: the runs that weigh most lie on the other side
  const Probability rare = probability_beyond(y, w, 150, true);
  EXPECT_NEAR(rare.value, normal_probability(-5), 3 * rare.error);
  EXPECT_LT(rare.error, 0.2 * rare.value);
}

TEST(WeightedSamples, ThatMissHalfOfTheirDistributionBoundAProbability) {
  const Design d({read_factor("a.x=uniform(90, 110) drawn normal(108, 3)")}, 400, Sampling::random,
                 1);
  const auto y = runs_of(d, [](const auto& x) { return x[0]; });
  const Probability p = probability_beyond(y, weights_of(d), 108, false);
  EXPECT_FALSE(p.known);
  EXPECT_LT(p.least, 0.9);
  EXPECT_GT(p.most, 0.9);
}

// |x| of N(0, 1) neither grows nor falls with x; where it is drawn, around 1, it grows.
TEST(WeightedSamples, CorrelateAsTheirDistributionDoes) {
  const Design d({read_factor("a.x=normal(0, 1) drawn normal(1, 1.3)")}, 4000, Sampling::random, 1);
  Columns c;
  c.factors = {runs_of(d, [](const auto& x) { return x[0]; })};
  c.responses = {runs_of(d, [](const auto& x) { return std::abs(x[0]); })};
  c.weight = weights_of(d);
  EXPECT_NEAR(rank_correlation(c, c.factors[0], c.responses[0]), 0.0, 0.1);
  EXPECT_GT(rank_correlation(c.factors[0], c.responses[0], std::vector<double>(4000, 1.0)), 0.4);
}

TEST(WeightedSamples, ThatMissTheirDistributionDoNotCorrelate) {
  const Design d({read_factor("a.x=normal(0, 1) drawn normal(4, 1)")}, 400, Sampling::random, 1);
  Columns c;
  c.factors = {runs_of(d, [](const auto& x) { return x[0]; })};
  c.weight = weights_of(d);
  EXPECT_TRUE(std::isnan(rank_correlation(c, c.factors[0], c.factors[0])));
}

// The mean weight is 1, and all of it that of one run.
TEST(WeightedSamples, OfWhichOneWeighsAllStandForNothing) {
  std::vector<double> weights(100, 1e-3);
  weights[7] = 100;
  EXPECT_LT(covered_share(weights), 0.01);
  EXPECT_EQ(covered_share({1.1, 0.9, 1}), 1.0);
}

TEST(Densities, IntegrateToOneOverTheirQuantiles) {
  // int f dx over (a, b) = difference of the quantiles, by the midpoint rule
  for (const char* law : {"uniform(1, 3)", "loguniform(1, 100)", "triangular(1, 2, 5)",
                          "normal(3, 0.5)", "lognormal(2, 0.4)"}) {
    const Factor f = read_factor(fmt::format("a.b={}", law));
    const double a = f.at_quantile(0.1), b = f.at_quantile(0.8);
    double sum = 0;
    constexpr int n = 20000;
    for (int k = 0; k < n; ++k)
      sum += f.density(a + (b - a) * (k + 0.5) / n) * (b - a) / n;
    EXPECT_NEAR(sum, 0.7, 1e-6) << law;
  }
}

TEST(Correlations, AreThoseOfTheNormalScores) {
  std::vector<Factor> f{read_factor("a.x=uniform(0, 1)"), read_factor("a.k=1,2"),
                        read_factor("a.y=normal(0, 2)"), read_factor("a.z=uniform(0, 1)")};
  const Design d(f, 4000, Sampling::latin_hypercube, 4,
                 {read_correlation("a.x, a.y = 0.8"), read_correlation("a.z,a.y=-0.3")});
  double xy = 0, yz = 0, xz = 0;
  for (std::int64_t s = 0; s < 4000; ++s) {
    const auto q = d.quantiles(s);
    const double x = normal_quantile(q[0]), y = normal_quantile(q[1]), z = normal_quantile(q[2]);
    xy += x * y / 4000;
    yz += y * z / 4000;
    xz += x * z / 4000;
  }
  EXPECT_NEAR(xy, 0.8, 0.03);
  EXPECT_NEAR(yz, -0.3, 0.03);
  EXPECT_NEAR(xz, 0.0, 0.03);
  const Design free(f, 4000, Sampling::latin_hypercube, 4);
  EXPECT_EQ(d.quantiles(17)[0], free.quantiles(17)[0]);  // the first stays what it is
}

}  // namespace
}  // namespace whirl::sweep
