// Decks that went wrong in the writing: lines deleted, tables deleted, values blanked, torn off.
// Reading, meshing and assembling such a deck ends in a clean error (code known to `whirl explain`,
// a message, the line) or in a model whose forces can be evaluated, never in a crash. A seeded
// sample of the examples' decks; WHIRL_MUTANTS=N tries N of each deck.
#include <assembly/build_system.hpp>
#include <core/error.hpp>
#include <deck/deck.hpp>
#include <gtest/gtest.h>
#include <meshes/mesh.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using namespace whirl;

namespace {

using Lines = std::vector<std::string>;

Lines lines_of(const fs::path& file) {
  Lines r;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);)
    r.push_back(line);
  return r;
}

std::string text_of(const Lines& lines) {
  std::string r;
  for (const auto& l : lines)
    r += l + "\n";
  return r;
}

bool header(const std::string& line) { return line.starts_with("["); }

/// The table that the line belongs to, from its header to before the next.
std::pair<std::size_t, std::size_t> table_of(const Lines& lines, std::size_t at) {
  std::size_t begin = at, end = at + 1;
  while (begin > 0 && !header(lines[begin]))
    --begin;
  while (end < lines.size() && !header(lines[end]))
    ++end;
  return {begin, end};
}

/// One mistake of the kind, near the line.
Lines with_mistake(Lines lines, std::size_t at, unsigned kind, std::mt19937& random) {
  const auto from = lines.begin() + static_cast<std::ptrdiff_t>(at);
  const std::size_t equal = lines[at].find('=');
  const char* values[] = {" \"\"",  " []",   " {}",   " 0",       " -1", " \"x\"",
                          " 1e300", " true", " [[]]", " \"nan\"", ""};
  switch (kind) {
    case 0: lines.erase(from); break;
    case 1: {
      const auto [begin, end] = table_of(lines, at);
      lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(begin),
                  lines.begin() + static_cast<std::ptrdiff_t>(end));
      break;
    }
    case 2:
      if (equal != std::string::npos)
        lines[at] = lines[at].substr(0, equal + 1) + values[random() % std::size(values)];
      else
        lines.erase(from);
      break;
    case 3: lines.insert(from, lines[at]); break;
    case 4: lines.resize(at); break;
    case 5: {  // a letter lost
      std::string& l = lines[at];
      if (!l.empty()) l.erase(random() % l.size(), 1);
      break;
    }
    default: {  // a digit more or less
      std::string& l = lines[at];
      const std::size_t digit = l.find_first_of("123456789");
      if (digit != std::string::npos) l.replace(digit, 1, random() % 2 ? "0" : "9000");
    }
  }
  return lines;
}

/// Empty when all is well.
std::string trouble(const std::string& text, const fs::path& folder) {
  const deck::Deck d = deck::read_deck_text(text, "deck.toml", {}, folder);
  for (const Diagnostic& x : d.diagnostics) {
    if (x.severity == Diagnostic::Severity::note) continue;
    if (!find_code(x.code)) return "unknown code '" + x.code + "': " + x.message;
    const bool nowhere = x.where.line == 0 && x.code != "E03";  // an empty file has no lines
    if (x.message.empty() || nowhere) return "no message or no line: " + format(x);
  }
  if (!d.ok()) return d.diagnostics.empty() ? "refused without a word" : "";
  double elements = 0;  // a mistake may ask for a billion of them, which is refused when memory is
  for (const auto& s : d.model.shafts)
    for (const auto& x : s.sections)
      elements += std::max<double>(x.min_elements, x.length / x.max_element_length);
  if (!(elements < 1e5)) return "";
  try {
    const meshes::Mesh mesh = meshes::make_mesh(d.model);
    std::set<std::string> keys{""};
    for (const model::Drive& x : d.model.drives)
      keys.insert(x.step);
    for (const std::string& step : keys) {
      const assembly::Built built = assembly::build_system(d.model, mesh, step);
      const system::State s = built.system.make_state();
      system::Workspace w = built.system.make_workspace();
      VecX r(built.system.size());
      built.system.residual(w, s.frames, 0.0, s.q, s.v, s.a, r);
    }
  } catch (const Error& e) {
    for (const Diagnostic& x : e.diagnostics())
      if (x.message.empty() || !find_code(x.code)) return "assembly: " + format(x);
    if (e.diagnostics().empty()) return "an error that says nothing";
  }
  return "";
}

}  // namespace

TEST(MutatedDecks, AreRefusedCleanlyOrRead) {
  const char* wanted = std::getenv("WHIRL_MUTANTS");
  const int mutants = wanted ? std::atoi(wanted) : 12;
  std::vector<fs::path> decks;
  for (const auto& e : fs::directory_iterator(fs::path(WHIRL_SOURCE) / "examples"))
    if (fs::exists(e.path() / "deck.toml")) decks.push_back(e.path() / "deck.toml");
  std::sort(decks.begin(), decks.end());
  ASSERT_GT(decks.size(), 20u);
  int tried = 0;
  for (std::size_t k = 0; k < decks.size(); ++k) {
    const Lines lines = lines_of(decks[k]);
    std::mt19937 random(static_cast<unsigned>(k) + 1);
    for (int m = 0; m < mutants; ++m) {
      Lines changed = lines;
      std::string what;
      for (int n = 0; n < 1 + m % 2; ++n) {
        if (changed.empty()) break;
        const std::size_t at = random() % changed.size();
        const unsigned kind = random() % 7;
        what += " kind " + std::to_string(kind) + " at line " + std::to_string(at + 1);
        changed = with_mistake(std::move(changed), at, kind, random);
      }
      if (wanted)
        std::ofstream("/tmp/whirl_mutant.toml") << text_of(changed);  // what it was when it crashes
      const std::string bad = trouble(text_of(changed), decks[k].parent_path());
      EXPECT_TRUE(bad.empty()) << decks[k] << what << "\n" << bad << "\n" << text_of(changed);
      ++tried;
    }
  }
  RecordProperty("mutants", tried);
}

TEST(MutatedDecks, WithoutAReadableShaft) {
  for (const auto& e : fs::directory_iterator(fs::path(WHIRL_SOURCE) / "examples")) {
    if (!fs::exists(e.path() / "deck.toml")) continue;
    const std::string text = text_of(lines_of(e.path() / "deck.toml"));
    // the typo that destroys every shaft; a list of none; and none at all
    std::string typo = text, none;
    for (std::size_t p; (p = typo.find("[shaft")) != std::string::npos;)
      typo.replace(p, 6, "[shft");
    bool inside = false;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) {
      if (header(line)) inside = line.starts_with("[shaft") || line.starts_with("[[shaft");
      if (!inside) none += line + "\n";
    }
    for (const std::string& deck : {typo, none, "shaft = []\n" + none}) {
      const deck::Deck d = deck::read_deck_text(deck, "deck.toml", {}, e.path());
      EXPECT_FALSE(d.ok()) << e.path();
      EXPECT_EQ(trouble(deck, e.path()), "") << e.path();
    }
  }
}
