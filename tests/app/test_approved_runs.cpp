// What notices that a run of a deck writes other numbers than were approved.
#include "approved_runs.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace {

using whirl::test::Fingerprint;

class ApprovedRuns : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("whirl_approved_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  /// Of a file of the results.
  Fingerprint of(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text;
    const std::vector<Fingerprint> all = whirl::test::fingerprints(folder_, "");
    return all.at(1);  // the log is the first
  }
  static std::string difference(const Fingerprint& approved, const Fingerprint& now) {
    return whirl::test::difference(whirl::test::line_of(approved), now);
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace

TEST_F(ApprovedRuns, TablesMayDifferByRounding) {
  const Fingerprint before = of("t.csv", "t [s],u [m],v [m]\n0,1,0.001\n1,-2,0.002\n");
  EXPECT_EQ(difference(before, of("t.csv", "t [s],u [m],v [m]\n0,1.00001,0.001\n1,-2,0.002\n")),
            "");
  // 1e-3 of the largest of their unit
  EXPECT_NE(difference(before, of("t.csv", "t [s],u [m],v [m]\n0,1,0.001\n1,-2,0.005\n")), "");
  EXPECT_NE(difference(before, of("t.csv", "t [s],u [m],v [m]\n0,1,0.001\n1,2,0.002\n")), "");
  EXPECT_NE(difference(before, of("t.csv", "t [s],u [m],v [m]\n0,-2,0.001\n1,1,0.002\n")), "");
  // all of them by one factor
  EXPECT_NE(difference(before, of("t.csv", "t [s],u [m],v [m]\n0,2,0.002\n1,-4,0.004\n")), "");
}

TEST_F(ApprovedRuns, TablesKeepTheirWordsAndRows) {
  const Fingerprint before = of("t.csv", "kind,f [Hz]\nforward,10\nbackward,10\n");
  EXPECT_EQ(difference(before, before), "");
  EXPECT_EQ(difference(before, of("t.csv", "kind,f [Hz]\nforward,10\nforward,10\n")),
            "other words");
  EXPECT_EQ(difference(before, of("t.csv", "kind,f [rpm]\nforward,10\nbackward,10\n")),
            "other words");
  EXPECT_NE(difference(before, of("t.csv", "kind,f [Hz]\nforward,10\n")), "");
  EXPECT_NE(difference(before, of("t.csv", "kind,f [Hz]\nforward,10\nbackward,\n")), "");
}

TEST_F(ApprovedRuns, SummariesKeepNamesAndNumbers) {
  const auto of_summary = [this](const std::string& inside) {
    return of("summary.json", R"({"model": {)" + inside + "}}");
  };
  const Fingerprint before = of_summary(R"("mass [kg]": 2.0, "run time, CPU [s]": 1.0)");
  EXPECT_EQ(difference(before, of_summary(R"("mass [kg]": 2.00001, "run time, CPU [s]": 3.0)")),
            "");
  EXPECT_NE(difference(before, of_summary(R"("mass [kg]": 2.002, "run time, CPU [s]": 1.0)")), "");
  EXPECT_NE(difference(before, of_summary(R"("mass [kg]": -2.0, "run time, CPU [s]": 1.0)")), "");
  EXPECT_NE(difference(before, of_summary(R"("mass [g]": 2.0, "run time, CPU [s]": 1.0)")), "");
  EXPECT_NE(difference(before, of_summary(R"("mass [kg]": 2.0, "held": true)")), "");
}

TEST_F(ApprovedRuns, WhatVariesIsOnlyThere) {
  const Fingerprint now = of("t.csv", "n\n3\n");
  EXPECT_EQ(now.numbers.size(), 5u);
  EXPECT_EQ(whirl::test::difference("t.csv ~ 1 ~ ~ ~ ~ ~", now), "");
  EXPECT_EQ(whirl::test::difference("t.csv ~ 1 ~ *", now), "");
  EXPECT_EQ(whirl::test::difference("t.csv ~ 1 ~ ~ ~ ~", now), "more numbers");
  EXPECT_EQ(whirl::test::difference("t.csv ~ 1 ~ ~ ~ ~ ~ ~", now), "fewer numbers");
}
