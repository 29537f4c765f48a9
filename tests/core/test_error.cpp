#include <core/error.hpp>
#include <gtest/gtest.h>
#include <set>
#include <string>

using namespace whirl;

namespace {
Diagnostic sample() {
  Diagnostic d;
  d.code = "E07";
  d.message = "no unit";
  d.hint = "write one";
  d.where = {"deck.toml", 62, 8, 4, ""};
  return d;
}
}  // namespace

TEST(Diagnostic, IsPrintedWithItsLine) {
  EXPECT_EQ(format(sample(), "length 1234 x"),
            "deck.toml:62:8: error[E07]: no unit\n  62 | length 1234 x\n     |        ^~~~\n     = "
            "hint: write one\n");
}

TEST(Diagnostic, WithoutALine) {
  Diagnostic d = sample();
  EXPECT_EQ(format(d), "deck.toml:62:8: error[E07]: no unit\n     = hint: write one\n");
  d.where = {};
  d.hint.clear();
  d.severity = Diagnostic::Severity::warning;
  EXPECT_EQ(format(d), "warning[E07]: no unit\n");
}

TEST(Diagnostic, CaretCountsCharactersNotBytes) {
  Diagnostic d = sample();
  d.where.column = 6;
  d.where.length = 2;
  EXPECT_EQ(format(d, "\xC2\xB5\xC2\xB5 = \tab"),
            "deck.toml:62:6: error[E07]: no unit\n  62 | \xC2\xB5\xC2\xB5 =  ab\n     |      ^~\n  "
            "   = hint: write one\n");
}

TEST(Diagnostic, LongLinesAreCut) {
  Diagnostic d = sample();
  d.where.column = 5000;
  const std::string r = format(d, std::string(10000, 'x'));
  EXPECT_LT(r.size(), 500u);
  EXPECT_NE(r.find("...xxx"), std::string::npos);
  EXPECT_NE(r.find("xxx...\n"), std::string::npos);
}

TEST(Diagnostic, CaretBeyondTheLineIsHarmless) {
  Diagnostic d = sample();
  d.where.column = 100;
  d.where.length = 100;
  EXPECT_EQ(
      format(d, "ab"),
      "deck.toml:62:100: error[E07]: no unit\n  62 | ab\n     |   ^\n     = hint: write one\n");
}

TEST(Diagnostic, ControlCharactersNeitherCutNorPaint) {
  Diagnostic d = sample();
  d.message = std::string("a\0b", 3) + "\x1b[31m";
  EXPECT_EQ(format(d),
            "deck.toml:62:8: error[E07]: a\\u0000b\\u001b[31m\n     = hint: write one\n");
}

TEST(Diagnostic, ColourOnlyWhenAsked) {
  EXPECT_EQ(format(sample(), "x", false).find('\x1b'), std::string::npos);
  EXPECT_NE(format(sample(), "x", true).find("\x1b[1;31merror[E07]\x1b[0m"), std::string::npos);
}

TEST(Catalogue, IsSortedCompleteAndWithoutDoubles) {
  std::set<std::string> seen;
  std::string before;
  for (const auto& c : error_catalogue()) {
    EXPECT_TRUE(seen.insert(c.code).second) << c.code;
    EXPECT_LT(before, std::string(c.code));
    before = c.code;
    EXPECT_GT(std::string(c.title).size(), 5u) << c.code;
    EXPECT_GT(std::string(c.text).size(), 40u) << c.code;
    EXPECT_EQ(find_code(c.code), &c);
  }
  EXPECT_EQ(find_code("E00"), nullptr);
}
