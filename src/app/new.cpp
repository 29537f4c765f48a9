#include <app/commands.hpp>
#include <app/examples.hpp>
#include <cstdio>
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

}  // namespace

int new_deck(const NewOptions& o) {
  if (o.example.empty()) {
    for (const auto& e : examples())
      std::fputs(fmt::format("{:<28} {}\n", short_name(e.folder), title_of(e.deck)).c_str(),
                 stdout);
    return static_cast<int>(Exit::ok);
  }
  const Example* found = nullptr;
  std::vector<std::string> names;
  for (const auto& e : examples()) {
    names.push_back(short_name(e.folder));
    if (o.example == e.folder || o.example == names.back()) found = &e;
  }
  if (!found) {
    Diagnostic d;
    const auto near = deck::nearest(o.example, names);
    d.message = fmt::format("there is no example '{}'", o.example);
    d.hint =
        near.empty() ? "`whirl new` lists them" : fmt::format("did you mean '{}'?", near.front());
    throw Error(Exit::usage, std::move(d));
  }
  if (o.file.empty()) {
    std::fputs(found->deck, stdout);
    for (const ExampleFile& f : found->files)
      std::fputs(fmt::format("note: the deck reads '{}' from its folder; give `whirl new` a file "
                             "name and both are written\n",
                             f.name)
                     .c_str(),
                 stderr);
    return static_cast<int>(Exit::ok);
  }
  std::vector<std::pair<std::filesystem::path, const char*>> files{{o.file, found->deck}};
  for (const ExampleFile& f : found->files)
    files.emplace_back(o.file.parent_path() / f.name, f.text);
  std::error_code ec;
  for (const auto& [file, text] : files) {
    if (o.force || !std::filesystem::exists(file, ec)) continue;
    Diagnostic d;
    d.code = "E91";
    d.message = fmt::format("'{}' exists already", file.string());
    d.hint = "choose another name or folder, or --force to replace it";
    throw Error(Exit::io, std::move(d));
  }
  for (const auto& [file, text] : files)
    io::write_atomic(file, text);
  std::fputs(
      fmt::format("wrote {}; next: whirl check '{}'\n", o.file.string(), o.file.string()).c_str(),
      stderr);
  return static_cast<int>(Exit::ok);
}

}  // namespace whirl::app
