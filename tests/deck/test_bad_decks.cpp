// Every mistake a deck can have, with the whole text the user sees. bad/NAME.toml is read, its
// report compared with bad/NAME.txt. Lines "#--set path=value" at the top of a deck are overrides.
// After a wanted change of wording run the test with WHIRL_UPDATE_GOLDEN=1 and read the difference
// before committing it.
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <gtest/gtest.h>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

std::string file_text(const fs::path& p) {
  std::ifstream in(p, std::ios::binary);
  std::ostringstream s;
  s << in.rdbuf();
  return s.str();
}

std::vector<fs::path> decks() {
  std::vector<fs::path> r;
  for (const auto& e : fs::directory_iterator("bad"))
    if (e.path().extension() == ".toml") r.push_back(e.path());
  std::sort(r.begin(), r.end());
  return r;
}

deck::Deck read_with_overrides(const fs::path& p) {
  deck::ReadOptions o;
  std::istringstream lines(file_text(p));
  std::string line;
  while (std::getline(lines, line) && line.starts_with("#--set "))
    o.set.push_back(line.substr(7));
  return deck::read_deck(p, o);
}

}  // namespace

TEST(BadDecks, PrintTheirMessages) {
  const bool update = std::getenv("WHIRL_UPDATE_GOLDEN") != nullptr;
  for (const auto& p : decks()) {
    const std::string report = read_with_overrides(p).report();
    fs::path golden = p;
    golden.replace_extension(".txt");
    if (update) std::ofstream(golden, std::ios::binary) << report;
    EXPECT_EQ(report, file_text(golden)) << p;
  }
}

TEST(BadDecks, SayWhatTheirNameSays) {
  for (const auto& p : decks()) {
    const auto d = read_with_overrides(p);
    const std::string code = p.filename().string().substr(0, 3);
    EXPECT_TRUE(std::any_of(d.diagnostics.begin(), d.diagnostics.end(),
                            [&](const Diagnostic& x) { return x.code == code; }))
        << p << "\n"
        << d.report();
    EXPECT_EQ(d.ok(), code[0] == 'W') << p;
  }
}

TEST(BadDecks, CoverEveryCodeOfTheReader) {
  std::set<std::string> seen;
  for (const auto& p : decks())
    for (const auto& d : read_with_overrides(p).diagnostics)
      seen.insert(d.code);
  for (const auto& c : error_catalogue()) {
    const std::string code = c.code;
    if ((code[0] == 'E' && code >= "E40") || code[0] == 'N' || code[0] == 'R')
      continue;  // found while running
    if (code == "W04" || (code[0] == 'W' && code >= "W07" && code != "W19"))
      continue;                   // found while running
    if (code == "E33") continue;  // needs a disk: test_output_estimate
    if (code == "E38") continue;  // needs the inertia of a mesh: tests/app/test_extremes
    EXPECT_TRUE(seen.count(code)) << code << ": no bad deck shows it";
  }
}

TEST(BadDecks, AreSortedByPlaceAndKnownToExplain) {
  for (const auto& p : decks()) {
    const auto d = read_with_overrides(p);
    for (std::size_t i = 0; i < d.diagnostics.size(); ++i) {
      EXPECT_NE(find_code(d.diagnostics[i].code), nullptr) << p << ": " << d.diagnostics[i].code;
      if (i == 0 || d.diagnostics[i].where.file != d.diagnostics[i - 1].where.file) continue;
      EXPECT_LE(std::pair(d.diagnostics[i - 1].where.line, d.diagnostics[i - 1].where.column),
                std::pair(d.diagnostics[i].where.line, d.diagnostics[i].where.column))
          << p;
    }
  }
}

TEST(BadDecks, ExitCodes) {
  EXPECT_EQ(deck::exit_of(deck::read_deck("bad/E04_unknown_keys.toml").diagnostics), Exit::deck);
  EXPECT_EQ(deck::exit_of(deck::read_deck("bad/no_such_deck.toml").diagnostics), Exit::io);
  EXPECT_EQ(deck::exit_of(read_with_overrides("bad/E34_set.toml").diagnostics), Exit::usage);
  EXPECT_THROW(deck::load_model("bad/E04_unknown_keys.toml"), Error);
}
