#include <core/table.hpp>
#include <gtest/gtest.h>

using namespace whirl;

TEST(Cells, PlacesAndQuotes) {
  const auto t = read_cells(
      "\xEF\xBB\xBF# comment\r\n\r\na , b[mm] ,\"c, \"\"d\"\"\"\r\n1,  2.5,x\r\n# "
      "more\r\n,\xC2\xB5,\r\n");
  ASSERT_TRUE(t.problem.empty());
  ASSERT_EQ(t.header.size(), 3u);
  EXPECT_EQ(t.header[0].text, "a");
  EXPECT_EQ(t.header[1].text, "b[mm]");
  EXPECT_EQ(t.header[1].column, 5);
  EXPECT_EQ(t.header[1].length, 5);
  EXPECT_EQ(t.header[2].text, "c, \"d\"");
  EXPECT_TRUE(t.header[2].quoted);
  ASSERT_EQ(t.rows.size(), 2u);
  EXPECT_EQ(t.rows[0][1].text, "2.5");
  EXPECT_EQ(t.rows[0][1].line, 4);
  EXPECT_EQ(t.rows[0][1].column, 5);
  EXPECT_EQ(t.rows[1].size(), 3u);
  EXPECT_EQ(t.rows[1][0].text, "");
  EXPECT_EQ(t.rows[1][2].column, 4);  // after one two-byte character
}

TEST(Cells, Separators) {
  EXPECT_EQ(read_cells("a;b\n1,5;2\n").rows[0][0].text, "1,5");
  EXPECT_EQ(read_cells("a\tb c\n1\t2 3\n").rows[0][1].text, "2 3");
  EXPECT_EQ(read_cells("k[N;m],b\n1,2\n").header.size(),
            2u);  // inside brackets it separates nothing
}

TEST(Cells, Problems) {
  EXPECT_EQ(read_cells("").problem, "the table is empty");
  EXPECT_EQ(read_cells("# only a comment\n").problem, "the table is empty");
  const auto t = read_cells("a,b\n1,\"open\n2,3\n");
  EXPECT_EQ(t.problem, "a quote is not closed");
  EXPECT_EQ(t.problem_line, 2);
  EXPECT_EQ(t.problem_column, 3);
}

TEST(Cells, Titles) {
  EXPECT_EQ(split_title("length[mm]").name, "length");
  EXPECT_EQ(split_title("length [mm]").unit, "mm");
  EXPECT_EQ(split_title("k (N/(m))").unit, "N/(m)");
  EXPECT_FALSE(split_title("name").has_unit);
  EXPECT_EQ(split_title(" name ").name, "name");
  EXPECT_TRUE(split_title("x[]").has_unit);
}
