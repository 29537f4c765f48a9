// Files that are no decks at all: each is refused at once, with a message, whatever its size.
#include <deck/deck.hpp>
#include <gtest/gtest.h>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

class NotDecks : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() /
        ("whirl_not_decks_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
         "_" + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string report(const std::string& name, const std::string& content) {
    const fs::path p = folder_ / name;
    std::ofstream(p, std::ios::binary) << content;
    return report(p);
  }
  /// The report with the folder left out.
  std::string report(const fs::path& p) {
    std::string r = deck::read_deck(p).report();
    const std::string prefix = folder_.string() + "/";
    for (std::size_t k; (k = r.find(prefix)) != std::string::npos;)
      r.erase(k, prefix.size());
    return r;
  }
  fs::path folder_;
};

}  // namespace

TEST_F(NotDecks, Empty) {
  const char* expected =
      "a.toml: error[E03]: the file is empty\n     = hint: `whirl new` writes a deck to start "
      "from\n";
  EXPECT_EQ(report("a.toml", ""), std::string(expected));
  EXPECT_EQ(report("a.toml", " \n\n"), std::string(expected));
  EXPECT_EQ(report("a.toml", "\xEF\xBB\xBF"), std::string(expected));
}

TEST_F(NotDecks, Binary) {
  EXPECT_EQ(report("a.toml", std::string("format = 1\nab\0cd", 16)),
            "a.toml:2:3: error[E03]: the file holds control characters: it is not a text file\n   "
            "2 | ab cd\n     |   ^\n     = hint: a deck is a UTF-8 text file\n");
  EXPECT_EQ(report("a.toml", "\x7F\x45LF\x02\x01"),
            "a.toml:1:1: error[E03]: the file holds control characters: it is not a text file\n   "
            "1 | ?ELF  \n     | ^\n     = hint: a deck is a UTF-8 text file\n");
  EXPECT_EQ(report("a.toml", "title = \"\xE9t\xE9\"\n"),
            "a.toml:1:10: error[E03]: the file is not UTF-8 text\n   1 | title = \"\xE9t\xE9\"\n   "
            "  |          ^\n     = hint: a deck is a UTF-8 text file\n");
  EXPECT_EQ(report("a.toml", std::string("\xFF\xFE"
                                         "f\0o\0",
                                         6)),
            "a.toml: error[E03]: the file is UTF-16 text\n     = hint: save it as UTF-8\n");
}

TEST_F(NotDecks, FolderOrMissing) {
  fs::create_directories(folder_ / "d");
  EXPECT_EQ(report(folder_ / "d"), "error[E02]: cannot read 'd': it is a folder\n");
  std::ofstream(folder_ / "d" / "deck.toml") << "format = 1\n";
  EXPECT_EQ(
      report(folder_ / "d"),
      "error[E02]: cannot read 'd': it is a folder\n     = hint: did you mean 'd/deck.toml'?\n");
  EXPECT_EQ(report(folder_ / "none.toml"), "error[E02]: cannot read 'none.toml': no such file\n");
  std::ofstream(folder_ / "Rotor.toml") << "format = 1\n";
  EXPECT_EQ(report(folder_ / "rotor.toml"),
            "error[E02]: cannot read 'rotor.toml': no such file\n     = hint: there is a file "
            "'Rotor.toml' in that folder\n");
}

TEST_F(NotDecks, HundredMegabytesOfBrackets) {
  const fs::path p = folder_ / "a.toml";
  {
    std::ofstream out(p, std::ios::binary);
    const std::string piece(1 << 20, '[');
    for (int k = 0; k < 100; ++k)
      out << piece;
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(report(p),
            "error[E03]: 'a.toml' is larger than the limit of 8 MiB\n     = hint: long tables "
            "belong in CSV files named by 'file'\n");
  // reading stops at the limit: 8 MiB take milliseconds; two seconds allow for a busy machine
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST_F(NotDecks, DeepBrackets) {
  const auto begin = std::chrono::steady_clock::now();
  const std::string r = report("a.toml", std::string("a = ").append(4 << 20, '['));
  EXPECT_EQ(r.substr(0, r.find('\n') + 1),
            "a.toml:1:69: error[E03]: brackets are nested deeper than 64 levels\n");
  EXPECT_LT(r.size(), 500u);  // the line of 4 MiB is shown in part
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

TEST_F(NotDecks, ManyMistakesEndSomewhere) {
  std::string text = "format = 1\n";
  for (int k = 0; k < 2000; ++k)
    text += fmt::format("k{} = = 3\n", k);
  const auto d = deck::read_deck_text(text);
  EXPECT_GT(d.errors, 10);
  EXPECT_LE(d.errors, 60);  // reading gives up after 50 mistakes of syntax
}

// the parser's own assertion ended the program where assertions are on
TEST_F(NotDecks, HeadersThatBeginAsNoKeyDoes) {
  for (const char* text : {"format = 1\n[@]\n", "format = 1\n[[@]]\n", "format = 1\n[a.@]\n"})
    EXPECT_NE(deck::read_deck_text(text).report().find("saw '@'"), std::string::npos) << text;
}

TEST_F(NotDecks, ParametersThatMultiply) {
  // each level doubles: 2^40 without a limit
  std::string text = "format = 1\n[parameters]\np0 = \"ab\"\n";
  for (int k = 1; k <= 40; ++k)
    text += fmt::format("p{0} = \"${{p{1}}}${{p{1}}}\"\n", k, k - 1);
  text += "[shaft]\nname = \"${p40}\"\n";
  const auto d = deck::read_deck_text(text);
  EXPECT_NE(d.report().find("E27"), std::string::npos);
}

namespace {

/// Of the processor, whoever else uses it.
double seconds_to_read(const std::string& text, deck::Deck& deck) {
  const std::clock_t begin = std::clock();
  deck = deck::read_deck_text(text);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

}  // namespace

// 100,000 rows, each wrong: five times as many as once took 5.5 s, in which time grew with the
// square of the errors.
TEST_F(NotDecks, AWhollyWrongTableIsCutShort) {
  std::string text =
      "format = 1\n[shaft]\nmaterial = \"steel\"\ncolumns = [\"length[mm]\", \"od[mm]\"]\nrows = "
      "[\n";
  for (int k = 0; k < 100000; ++k)
    text += fmt::format("[{}, -1],\n", k + 1);
  deck::Deck d;
  EXPECT_LT(seconds_to_read(text + "]\n", d),
            10.0);  // a second or two, nearly all of it the TOML library's
  EXPECT_GE(d.errors, 200);
  ASSERT_EQ(d.diagnostics.size(), 201u);
  EXPECT_EQ(d.diagnostics.back().message, "the first 200 errors are shown; there may be more");
  EXPECT_EQ(d.diagnostics.back().severity, Diagnostic::Severity::note);
}

TEST_F(NotDecks, WrongTablesOneByOneAreCutShort) {
  std::string text =
      "format = 1\n[shaft]\nmaterial = \"steel\"\ncolumns = [\"length[mm]\", \"od[mm]\"]\nrows = "
      "[[100, 20]]\n";
  for (int k = 0; k < 20000; ++k)
    text += fmt::format("[[disk]]\nat = \"{} mm\"\nmas = 1\n", k);
  deck::Deck d;
  EXPECT_LT(seconds_to_read(text, d), 10.0);
  EXPECT_EQ(d.diagnostics.size(), 201u);
}

TEST_F(NotDecks, ARepeatedErrorHidesNoOthers) {
  // the header is wrong, which is found again in every row; the mistake after it is said all the
  // same
  std::string text =
      "format = 1\n[shaft]\nmaterial = \"steel\"\ncolumns = [\"length\", \"od[mm]\"]\nrows = [\n";
  for (int k = 0; k < 1000; ++k)
    text += "[1, 20],\n";
  deck::Deck d;
  seconds_to_read(text + "]\n[[probe]]\nplace = 3\n", d);
  EXPECT_NE(d.report().find("unknown key 'place'"), std::string::npos) << d.report();
  EXPECT_LT(d.diagnostics.size(), 10u);
}
