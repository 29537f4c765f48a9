#include <app/commands.hpp>
#include <app/examples.hpp>
#include <app/starters.hpp>
#include <cstdio>
#include <deck/deck.hpp>
#include <deck/text/document.hpp>
#include <fmt/format.h>
#include <filesystem>
#include <io/file.hpp>
#include <utility>
#include <vector>

namespace whirl::app {
namespace {

std::string short_name(const std::string& folder) {
  const std::size_t k = folder.find_first_not_of("0123456789");
  return k != std::string::npos && k > 0 && folder[k] == '_' ? folder.substr(k + 1) : folder;
}

/// The title line of a deck, for the list.
std::string title_of(std::string_view deck) {
  const std::size_t k = deck.find("title");
  if (k == std::string_view::npos) return {};
  const std::size_t a = deck.find('"', k),
                    b = a == std::string_view::npos ? a : deck.find('"', a + 1);
  return b == std::string_view::npos ? std::string() : std::string(deck.substr(a + 1, b - a - 1));
}

/// Names on standard output, one a line; what to do with them on standard error.
void list_all() {
  for (const auto& e : examples())
    std::fputs(fmt::format("{:<28} {}\n", short_name(e.folder), title_of(e.deck)).c_str(), stdout);
  std::fflush(stdout);
  std::string machines;
  for (const Starter& s : starters())
    machines += (machines.empty() ? "" : ", ") + s.machine;
  std::fputs(fmt::format("these are examples: whirl new --example NAME deck.toml\n"
                         "starters: whirl new --machine KIND deck.toml, of the kinds {}\n",
                         machines)
                 .c_str(),
             stderr);
}

[[noreturn]] void no_such(const char* what, const std::string& name,
                          const std::vector<std::string>& names) {
  Diagnostic d;
  const auto near = deck::nearest(name, names);
  d.message = fmt::format("there is no {} '{}'", what, name);
  d.hint =
      near.empty() ? "`whirl new` lists them" : fmt::format("did you mean '{}'?", near.front());
  throw Error(Exit::usage, std::move(d));
}

const Example& example_named(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& e : examples()) {
    names.push_back(short_name(e.folder));
    if (name == e.folder || name == names.back()) return e;
  }
  no_such("example", name, names);
}

const Starter& starter_of(const std::string& machine) {
  std::vector<std::string> names;
  for (const Starter& s : starters()) {
    names.push_back(s.machine);
    if (machine == s.machine) return s;
  }
  no_such("starter", machine, names);
}

void print_questions(const Starter& starter) {
  for (const Question& q : starter.questions) {
    std::string given = q.answer;
    if (q.kind == Question::Kind::choice) given = fmt::format("{}", fmt::join(q.words, "|"));
    if (q.kind == Question::Kind::number) given += fmt::format(" ({} to {})", q.least, q.most);
    std::fputs(fmt::format("{:<22} {:<22} {}\n", q.key, given, q.text).c_str(), stdout);
  }
}

/// The starter with the answers that were given.
/// @throws Error (Exit::deck) when they make no deck.
std::string answered(const Starter& starter, const std::vector<std::string>& given) {
  std::vector<std::pair<std::string, std::string>> answers;
  for (const std::string& a : given) {
    const std::size_t k = a.find('=');
    if (k == std::string::npos) {
      Diagnostic d;
      d.message = fmt::format("'{}' is no answer", a);
      d.hint = "--answer KEY=VALUE; --questions lists the keys";
      throw Error(Exit::usage, std::move(d));
    }
    answers.emplace_back(a.substr(0, k), a.substr(k + 1));
  }
  std::string text = starter_deck(starter, answers);
  deck::Deck read = deck::read_deck_text(text, "the deck of these answers");
  if (!read.ok()) throw Error(Exit::deck, std::move(read.diagnostics));
  return text;
}

using Files = std::vector<std::pair<std::filesystem::path, std::string>>;

/// @throws Error E91 for one that is there already.
void write_files(const Files& files, bool force) {
  std::error_code ec;
  for (const auto& [file, text] : files) {
    if (force || !std::filesystem::exists(file, ec)) continue;
    Diagnostic d;
    d.code = "E91";
    d.message = fmt::format("'{}' exists already", file.string());
    d.hint = "choose another name or folder, or --force to replace it";
    throw Error(Exit::io, std::move(d));
  }
  for (const auto& [file, text] : files)
    io::write_atomic(file, text);
  const std::string deck = files.front().first.string();
  std::fputs(fmt::format("wrote {}; next: whirl check '{}'\n", deck, deck).c_str(), stderr);
}

}  // namespace

int new_deck(const NewOptions& o) {
  if (o.example.empty() && o.machine.empty()) {
    list_all();
    return static_cast<int>(Exit::ok);
  }
  if (o.questions) {
    print_questions(starter_of(o.machine));
    return static_cast<int>(Exit::ok);
  }
  Files files;
  if (o.machine.empty()) {
    const Example& example = example_named(o.example);
    files.emplace_back(o.file, example.deck);
    for (const ExampleFile& f : example.files)
      files.emplace_back(o.file.parent_path() / f.name, f.text);
  } else {
    files.emplace_back(o.file, answered(starter_of(o.machine), o.answers));
  }
  if (!o.file.empty()) {
    write_files(files, o.force);
    return static_cast<int>(Exit::ok);
  }
  std::fputs(files.front().second.c_str(), stdout);
  for (std::size_t k = 1; k < files.size(); ++k)
    std::fputs(fmt::format("note: the deck reads '{}' from its folder; give `whirl new` a file "
                           "name and both are written\n",
                           files[k].first.string())
                   .c_str(),
               stderr);
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
