// Designs of sweeps: what --vary means, and the points of each kind of sampling.
#include <sweep/design.hpp>
#include <sweep/sampling.hpp>
#include <core/error.hpp>
#include <gtest/gtest.h>
#include <unistd.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>

namespace whirl::sweep {
namespace {

std::vector<std::string> values_of(const std::string& text) { return read_factor(text).values; }

TEST(SweepFactors, RangesListsAndUnits) {
  EXPECT_EQ(values_of("b.clearance=60um:90 um:4"),
            (std::vector<std::string>{"60 um", "70 um", "80 um", "90 um"}));
  EXPECT_EQ(values_of("k=1:100 N/m:3:log"),
            (std::vector<std::string>{"1 N/m", "10 N/m", "100 N/m"}));
  EXPECT_EQ(values_of("x = 0.1:0.3:3"), (std::vector<std::string>{"0.1", "0.2", "0.3"}));
  EXPECT_EQ(values_of("kind=plain, lobed"), (std::vector<std::string>{"plain", "lobed"}));
  EXPECT_EQ(read_factor("b.c=60 um, 70 um").unit, "um");
  EXPECT_EQ(values_of("b.c=60, 70 um"), (std::vector<std::string>{"60 um", "70 um"}));
  EXPECT_EQ(read_factor("a.b=normal(30 kg, 5 %)").parameters, (std::vector<double>{30, 1.5}));
  EXPECT_EQ(read_factor("a.b=uniform(1, 3 kg)").unit, "kg");
}

TEST(SweepFactors, WhatIsNoFactorIsRefused) {
  for (const char* text :
       {"clearance", "=1:2:3", "a=", "a=1:2", "a=1:2:1", "a=1:2:x", "a=1um:2mm:3", "a=-1:2:3:log",
        "a=1:2:3:lin", "a=uniform(2, 1)", "a=uniform(1)", "a=normal(1, 0)", "a=triangular(1, 3, 2)",
        "a=uniform(1, 2", "a=1,,2", "a=lognormal(1 um, 2 um)", "a=x:y:3:z:w,",
        "k=3e6 N/m, 4 kN/mm"})
    EXPECT_THROW(
        {
          const Factor f = read_factor(text);
          if (f.values == std::vector<std::string>{"x:y:3:z:w", ""}) return;
        },
        Error)
        << text;
}

TEST(SweepDesign, CombinesListsAndSamples) {
  const Design d({read_factor("a=1,2"), read_factor("b=uniform(0, 1)"), read_factor("c=x,y,z")}, 5,
                 Sampling::latin_hypercube, 7);
  ASSERT_EQ(d.runs(), 30);
  std::set<std::vector<std::string>> seen;
  for (std::int64_t run = 0; run < d.runs(); ++run) {
    const auto v = d.values(run);
    EXPECT_EQ(v[1], d.values(run % 5)[1]);  // the same samples at every combination
    seen.insert(v);
  }
  EXPECT_EQ(seen.size(), 30u);
  EXPECT_EQ(d.values(0)[0], "1");
  EXPECT_EQ(d.values(0)[2], "x");
  EXPECT_EQ(d.values(5)[2], "y");  // the last list changes first
}

TEST(SweepDesign, ListsOfAFileGoTogether) {
  const auto file = std::filesystem::temp_directory_path() /
                    ("whirl_runs_" + std::to_string(::getpid()) + ".csv");
  std::ofstream(file) << "b.A.clearance [um],b.kind\n60,plain\n75,\"lobed\"\n90,plain\n";
  std::vector<Factor> f = read_runs(file, 0);
  f.push_back(read_factor("m=1,2"));
  const Design d(f, 1, Sampling::latin_hypercube, 1);
  ASSERT_EQ(d.runs(), 6);
  EXPECT_EQ(d.values(0), (std::vector<std::string>{"60 um", "plain", "1"}));
  EXPECT_EQ(d.values(1), (std::vector<std::string>{"60 um", "plain", "2"}));
  EXPECT_EQ(d.values(2), (std::vector<std::string>{"75 um", "lobed", "1"}));
  EXPECT_EQ(d.values(5), (std::vector<std::string>{"90 um", "plain", "2"}));
  for (const char* bad : {"", "a,b\n", "a,b\n1\n", "a,\n1,2\n", "a,b\n1,\n"}) {
    std::ofstream(file) << bad;
    EXPECT_THROW(read_runs(file, 0), Error) << bad;
  }
  std::filesystem::remove(file);
}

/// Runs of a file of this text; what stands against it.
class FileOfRuns : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(file_); }
  std::vector<Factor> read(const std::string& text) const {
    std::ofstream(file_) << text;
    return read_runs(file_, 0);
  }
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const Error& e) {
      return e.diagnostics().front().message;
    }
    return "none";
  }
  const std::filesystem::path file_ = std::filesystem::temp_directory_path() /
                                      ("whirl_file_of_runs_" + std::to_string(::getpid()) + ".csv");
};

TEST_F(FileOfRuns, TakesTheUnitOfItsCells) {
  const std::vector<Factor> f = read("p.P,d.m\n900 N,1\n1000,2\n1200 N,3\n");
  EXPECT_EQ(f[0].unit, "N");
  EXPECT_EQ(f[0].values, (std::vector<std::string>{"900 N", "1000 N", "1200 N"}));
  EXPECT_EQ(f[1].unit, "");
}

TEST_F(FileOfRuns, HasOneUnitAColumn) {
  EXPECT_NE(refusal("p.P,d.m\n900 N,1\n1 kN,2\n").find("p.P': units 'N' and 'kN' in one list"),
            std::string::npos);
  EXPECT_NE(refusal("p.P [N]\n900 N\n").find("'900 N' has a unit, and its heading has 'N'"),
            std::string::npos);
}

TEST_F(FileOfRuns, SaysWhichCellIsEmpty) {
  EXPECT_NE(refusal("a,b\n1,2\n3,\n").find("line 3: the cell of 'b' is empty"), std::string::npos);
  EXPECT_NE(refusal("a,b\n1,2\n3\n").find("line 3: 1 values where 2 belong"), std::string::npos);
}

TEST(SweepDesign, RefusesSchemesAndCorrelationsThatCannotBe) {
  const Factor list = read_factor("a=1,2"), x = read_factor("x=uniform(0, 1)"),
               y = read_factor("y=uniform(0, 1)"), z = read_factor("z=uniform(0, 1)"),
               drawn = read_factor("w=normal(0, 1) drawn normal(1, 1)");
  for (const Sampling s : {Sampling::saltelli, Sampling::morris, Sampling::one_at_a_time}) {
    EXPECT_THROW(Design({list, x}, 4, s, 1), Error);
    EXPECT_THROW(Design({drawn, x}, 4, s, 1), Error);
    EXPECT_THROW(Design({x, y}, 4, s, 1, {{"x", "y", 0.5}}), Error);
  }
  const auto with = [&](std::vector<Correlation> c) {
    return Design({x, y, z, list}, 4, Sampling::random, 1, c);
  };
  EXPECT_NO_THROW(with({{"x", "y", 0.5}}));
  EXPECT_THROW(with({{"x", "a", 0.5}}), Error);
  EXPECT_THROW(with({{"x", "y", 0.9}, {"y", "x", 0.5}}), Error);
  EXPECT_THROW(with({{"x", "y", 0.9}, {"y", "z", 0.9}, {"x", "z", -0.9}}), Error);
  for (const char* text : {"x=0.5", "x,y", "x,y=1", "x,x=0.5", "x,y=0.5 mm", "x,y,z=0.1"})
    EXPECT_THROW(read_correlation(text), Error) << text;
  for (const char* text :
       {"a=normal(0, 1) drawn 1:2:3", "a=normal(0 um, 1 um) drawn normal(1, 1)",
        "a=uniform(5, 15) drawn uniform(8, 12)", "a=normal(10, 2) drawn uniform(8, 12)",
        "a=triangular(1, 2, 6) drawn loguniform(1.5, 9)"})
    EXPECT_THROW(read_factor(text), Error) << text;
}

TEST(SweepDesign, RefusesWhatCannotBe) {
  const auto design = [](std::vector<Factor> f, std::int64_t samples) {
    return Design(std::move(f), samples, Sampling::sobol, 1);
  };
  EXPECT_THROW(design({read_factor("a=1,2")}, 10), Error);
  EXPECT_THROW(design({read_factor("a=uniform(0, 1)")}, 1), Error);
  EXPECT_THROW(design({read_factor("a=1,2"), read_factor("a=3,4")}, 1), Error);
  std::vector<Factor> many;
  for (int k = 0; k < 11; ++k)
    many.push_back(read_factor("p" + std::to_string(k) + "=uniform(0, 1)"));
  EXPECT_THROW(design(many, 10), Error);
}

TEST(SweepSampling, LatinHypercubeHasOnePointInEveryPart) {
  for (const std::int64_t n : {2, 7, 64, 1000})
    for (std::size_t dimension : {0u, 1u, 12u}) {
      std::set<int> parts;
      for (std::int64_t k = 0; k < n; ++k) {
        const double x = latin_point(3, dimension, k, n);
        ASSERT_GT(x, 0);
        ASSERT_LT(x, 1);
        parts.insert(static_cast<int>(x * static_cast<double>(n)));
      }
      EXPECT_EQ(parts.size(), static_cast<std::size_t>(n));
    }
}

TEST(SweepSampling, SobolPointsAreNets) {
  // Every dimension: one of the first 2^m points in each 2^m-th. The first two together: one in
  // each box of area 2^-m, whatever its sides.
  for (const std::uint64_t seed : {1u, 42u})
    for (int m = 1; m <= 10; ++m) {
      const int n = 1 << m;
      for (std::size_t d = 0; d < sobol_dimensions; ++d) {
        std::set<int> parts;
        for (int k = 0; k < n; ++k)
          parts.insert(static_cast<int>(sobol_point(seed, d, k) * n));
        EXPECT_EQ(parts.size(), static_cast<std::size_t>(n)) << d;
      }
      for (int sides = 0; sides <= m; ++sides) {
        std::set<std::pair<int, int>> boxes;
        for (int k = 0; k < n; ++k)
          boxes.insert({static_cast<int>(sobol_point(seed, 0, k) * (1 << sides)),
                        static_cast<int>(sobol_point(seed, 1, k) * (1 << (m - sides)))});
        EXPECT_EQ(boxes.size(), static_cast<std::size_t>(n));
      }
    }
}

TEST(SweepSampling, SobolIntegratesBetterThanChance) {
  // the product of 10 factors (1 + (2 x - 1) / 3) has the mean 1
  const auto error = [](auto point) {
    constexpr int n = 4096;
    double sum = 0;
    for (int k = 0; k < n; ++k) {
      double f = 1;
      for (std::size_t d = 0; d < sobol_dimensions; ++d)
        f *= 1 + (2 * point(d, k) - 1) / 3;
      sum += f / n;
    }
    return std::abs(sum - 1);
  };
  const double sobol = error([](std::size_t d, int k) { return sobol_point(5, d, k); });
  const double random = error([](std::size_t d, int k) { return random_point(5, d, k); });
  EXPECT_LT(sobol, 2e-3);   // measured 3e-4
  EXPECT_LT(random, 4e-2);  // standard error 1e-2
}

TEST(SweepSampling, RandomPointsHaveTheirMoments) {
  constexpr int n = 100000;
  double mean = 0, square = 0, product = 0;
  for (int k = 0; k < n; ++k) {
    const double x = random_point(9, 0, k) - 0.5, y = random_point(9, 1, k) - 0.5;
    mean += x / n;
    square += x * x / n;
    product += x * y / n;
  }
  EXPECT_NEAR(mean, 0, 4e-3);  // four standard errors, here and below
  EXPECT_NEAR(square, 1.0 / 12, 1e-3);
  EXPECT_NEAR(product, 0, 1.1e-3);
  EXPECT_NE(random_point(9, 0, 0), random_point(10, 0, 0));
}

TEST(SweepSampling, QuantilesOfDistributions) {
  for (double p : {1e-300, 1e-12, 1e-3, 0.07, 0.3, 0.5, 0.8, 0.999}) {
    const double x = normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / p, 1.0, 1e-12 * (1 + x * x)) << p;
  }
  EXPECT_NEAR(read_factor("a=normal(10, 2)").at_quantile(0.8413447460685429), 12, 1e-12);
  EXPECT_NEAR(read_factor("a=lognormal(10, 0.5)").at_quantile(0.8413447460685429),
              10 * std::exp(0.5), 1e-11);
  EXPECT_NEAR(read_factor("a=triangular(0, 1, 4)").at_quantile(0.25), 1, 1e-14);
  EXPECT_NEAR(read_factor("a=triangular(0, 1, 4)").at_quantile(0.8125), 2.5, 1e-14);
  EXPECT_NEAR(read_factor("a=loguniform(1, 100)").at_quantile(0.5), 10, 1e-13);
}

}  // namespace
}  // namespace whirl::sweep
