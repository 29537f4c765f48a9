// Numbers that are none are counted on their way into a file, except where the table says what they mean.
#include "temp_folder.hpp"
#include <core/types.hpp>
#include <gtest/gtest.h>
#include <io/nonfinite.hpp>
#include <io/results.hpp>

namespace whirl::io {
namespace {

TEST(NonFinite, InTablesUnlessTheyMeanSomething) {
  TempFolder dir;
  const ResultsFolder folder(dir.path());
  Table t;
  t.columns = {{"speed", "rpm", ""}, {"frequency", "Hz", ""}, {"kind", "-", ""}};
  t.add({1.0, 2.0, "x"});
  t.add({2.0, nan, ""});
  take_nonfinite();
  t.nan_means = "the mode is not there at this speed";
  folder.write_table("a.csv", t);
  EXPECT_TRUE(take_nonfinite().empty());
  t.nan_means.clear();
  t.add({infinity, nan, ""});
  folder.write_table("b.csv", t);
  const auto noted = take_nonfinite();
  ASSERT_EQ(noted.size(), 1u);
  EXPECT_EQ(noted[0].file, "b.csv");
  EXPECT_EQ(noted[0].column, "speed");
  EXPECT_EQ(noted[0].count, 3u);
  EXPECT_TRUE(take_nonfinite().empty());   // said once
  t.nan_means = "none";
  folder.write_table("c.csv", t);   // an infinity means nothing anywhere
  ASSERT_EQ(take_nonfinite().size(), 1u);
}

TEST(NonFinite, InTimeHistories) {
  TempFolder dir;
  take_nonfinite();
  const std::vector<Channel> channels{{"t", "s", "", {}, 1.0, ""}, {"P", "m", "", {"y", "z"}, 1.0, ""}};
  auto series = make_csv_series(dir.path() / "m.csv");
  series->begin(channels);
  series->append(std::vector<double>{0, 1, 2});
  series->append(std::vector<double>{1, 1, nan});
  series->append(std::vector<double>{2, infinity, nan});
  series->close();
  const auto noted = take_nonfinite();
  ASSERT_EQ(noted.size(), 1u);
  EXPECT_EQ(noted[0].file, "m.csv");
  EXPECT_EQ(noted[0].column, "P.z");
  EXPECT_EQ(noted[0].count, 3u);
}

}  // namespace
}  // namespace whirl::io
