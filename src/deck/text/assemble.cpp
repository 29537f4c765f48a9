#include <deck/text/assemble.hpp>
#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <system_error>
#include <utility>

namespace whirl::deck {
namespace {

constexpr int max_include_depth = 16;
constexpr int max_files = 64;

std::string file_and_line(const Sources& sources, const Spot& s) {
  return s.source >= 0 ? fmt::format("{}:{}", sources[s.source].name, s.line)
                       : std::string("elsewhere");
}

bool holds_tables(const Value& v) {
  return v.is_array() &&
         std::any_of(v.items.begin(), v.items.end(), [](const Value& x) { return x.is_table(); });
}

/// Adds what `from` holds to `into`; lists of tables are joined (those of `into` first).
void merge(Value& into, Value from, const Sources& sources, Diagnostics& diagnostics) {
  for (auto& m : from.members) {
    Member* have = into.find(m.key);
    if (!have)
      into.members.push_back(std::move(m));
    else if (have->value.is_table() && m.value.is_table())
      merge(have->value, std::move(m.value), sources, diagnostics);
    else if (holds_tables(have->value) && holds_tables(m.value))
      for (auto& x : m.value.items)
        have->value.items.push_back(std::move(x));
    else
      diagnostics.error("E29", m.spot,
                        fmt::format("'{}' is set here and in an included file", m.key),
                        fmt::format("the other is in {}", file_and_line(sources, have->spot)));
  }
}

struct Files {
  Sources& sources;
  Diagnostics& diagnostics;
  const AssembleOptions& options;
  std::vector<std::filesystem::path> open;  ///< the chain of files being read
  int count = 0;
};

/// A file that an 'include' names.
struct Included {
  int source = -1;  ///< -1: not taken, and said why
  std::filesystem::path canonical;
};

Included open_included(const Value& name, int source, Files& files) {
  const auto refuse = [&](const std::string& code, std::string message, std::string hint = "") {
    files.diagnostics.error(code, name.spot, std::move(message), std::move(hint));
    return Included{};
  };
  if (!name.is_text()) {
    if (name.kind == Value::Kind::unreadable) return {};
    return refuse(
        "E06", fmt::format("'include' must be a list of file names, not {}", name_of(name.kind)));
  }
  if (!files.options.files_allowed)
    return refuse("E02", fmt::format("cannot read '{}': files are not allowed here", name.text));
  const std::filesystem::path path = files.sources[source].folder / name.text;
  std::error_code ec;
  const auto canonical = std::filesystem::weakly_canonical(path, ec);
  if (std::find(files.open.begin(), files.open.end(), canonical) != files.open.end())
    return refuse("E28", fmt::format("'{}' includes itself", name.text),
                  "remove one 'include' of the circle");
  if (static_cast<int>(files.open.size()) > max_include_depth || ++files.count > max_files)
    return refuse("E28", fmt::format("more than {} files, or more than {} levels, are included",
                                     max_files, max_include_depth));
  if (!may_be_read(files.sources, path, {".toml"}))
    return refuse(
        "E02",
        fmt::format("cannot read '{}': it lies outside the deck's folder and is not named *.toml",
                    name.text),
        "move it beside the deck, or give it the name of a deck");
  FileText text = read_file(path, max_deck_bytes);
  if (!text.ok()) return refuse(text.code, text.message, text.hint);
  const TextProblem bad = check_text(text.text, TextKind::deck);
  const int added = files.sources.add(path.string(), path.parent_path(), std::move(text.text));
  if (!bad.ok()) {
    files.diagnostics.error("E03", Spot{added, bad.line, bad.column, 1}, bad.message, bad.hint);
    return {};
  }
  return {added, canonical};
}

Document parse_with_includes(int source, Files& files) {
  Document doc = parse_toml(files.sources, source, files.diagnostics);
  if (!doc.complete) return doc;
  Member* include = doc.root.find("include");
  if (!include) return doc;
  const Value list = include->value;
  doc.root.members.erase(doc.root.members.begin() + (include - doc.root.members.data()));
  std::vector<Value> names = list.is_array() ? list.items : std::vector<Value>{list};
  Value merged = Value::make_table(doc.root.spot);
  for (const auto& name : names) {
    const Included file = open_included(name, source, files);
    if (file.source < 0) continue;
    files.open.push_back(file.canonical);
    Document part = parse_with_includes(file.source, files);
    files.open.pop_back();
    doc.damaged = doc.damaged || part.damaged || !part.complete;
    if (!part.complete) continue;
    part.root.members.erase(std::remove_if(part.root.members.begin(), part.root.members.end(),
                                           [](const Member& m) { return m.key == "format"; }),
                            part.root.members.end());
    merge(merged, std::move(part.root), files.sources, files.diagnostics);
  }
  merge(merged, std::move(doc.root), files.sources, files.diagnostics);
  merged.spot = Spot{source, 1, 1, 1};
  doc.root = std::move(merged);
  return doc;
}

}  // namespace

bool may_be_read(const Sources& sources, const std::filesystem::path& file,
                 std::initializer_list<std::string_view> extensions) {
  const std::string extension = file.extension().string();
  if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return true;
  std::error_code ec;
  const std::filesystem::path folder =
      sources[0].folder.empty() ? std::filesystem::path(".") : sources[0].folder;
  const auto deck = std::filesystem::weakly_canonical(std::filesystem::absolute(folder, ec), ec);
  const auto whole = std::filesystem::weakly_canonical(std::filesystem::absolute(file, ec), ec);
  const auto [end, rest] = std::mismatch(deck.begin(), deck.end(), whole.begin(), whole.end());
  return end == deck.end() || (std::next(end) == deck.end() && end->empty());
}

Document assemble(Sources& sources, Diagnostics& diagnostics, const AssembleOptions& options) {
  Files files{sources, diagnostics, options, {}, 0};
  std::error_code ec;
  files.open.push_back(std::filesystem::weakly_canonical(
      sources[0].folder / std::filesystem::path(sources[0].name).filename(), ec));
  return parse_with_includes(0, files);
}

namespace {

/// One --set: a path through the document, and the value at its end.
class Override {
 public:
  Override(Document& document, std::string argument, int source, int line, Diagnostics& diagnostics)
      : document_(document),
        argument_(std::move(argument)),
        source_(source),
        line_(line),
        diagnostics_(diagnostics) {}

  /// Of the path that was applied: its parts, members of lists by their numbers.
  const std::string& entry() const { return entry_; }

  void apply() {
    equal_ = argument_.find('=');
    if (equal_ == std::string::npos || equal_ == 0) {
      diagnostics_.error("E34", spot(0, argument_.size()), "a --set has the form path=value",
                         "for example --set parameters.clearance=90um");
      return;
    }
    const TextProblem bad = check_text(argument_, TextKind::argument);
    if (!bad.ok()) {
      diagnostics_.error("E34", spot(0, argument_.size()), bad.message);
      return;
    }
    const std::size_t first = argument_.find_first_not_of(' ', equal_ + 1);
    const std::string_view given =
        first == std::string::npos ? std::string_view() : std::string_view(argument_).substr(first);
    value_ = parse_set_value(given, spot(std::min(first, argument_.size()), argument_.size()));
    Value* at = &document_.root;
    for (std::size_t begin = 0; at && begin < equal_;) {
      const std::size_t end = end_of_part(begin);
      at = step(*at, begin, end);
      begin = end + 1;
    }
  }

 private:
  Spot spot(std::size_t begin, std::size_t end) const {
    return Spot{source_, line_, static_cast<int>(begin) + 1,
                static_cast<int>(std::max<std::size_t>(end - begin, 1))};
  }

  std::size_t end_of_part(std::size_t begin) const {
    // a name in a list may itself contain points when it is quoted
    if (argument_[begin] == '"') return std::min(argument_.find('"', begin + 1), equal_ - 1) + 1;
    return std::min(argument_.find('.', begin), equal_);
  }

  std::string name_of_part(std::size_t begin, std::size_t end) const {
    std::string part = argument_.substr(begin, end - begin);
    while (!part.empty() && part.back() == ' ')
      part.pop_back();
    if (part.size() >= 2 && part.front() == '"' && part.back() == '"')
      part = part.substr(1, part.size() - 2);
    return part;
  }

  /// Into the member that the part from begin to end names; the last one is set. Null: the end of
  /// the path, or a mistake.
  Value* step(Value& at, std::size_t begin, std::size_t end) {
    const std::string part = name_of_part(begin, end);
    if (part.empty()) {
      diagnostics_.error("E34", spot(0, equal_), "the path has an empty part");
      return nullptr;
    }
    const std::string above = std::exchange(above_, part);
    if (at.is_array()) return into_list(at, above, part, begin, end);
    if (at.is_table()) return into_table(at, part, begin, end);
    diagnostics_.error(
        "E34", spot(begin, end),
        fmt::format("'{}' stands below {}, which has no members", part, name_of(at.kind)));
    return nullptr;
  }

  /// Names of the tables in a list, as the reader has them: given, or the kind and a number.
  static std::vector<std::string> names_of(const Value& list, const std::string& kind) {
    std::vector<std::string> names;
    for (const Value& item : list.items) {
      if (!item.is_table()) return {};
      const Member* given = item.find("name");
      std::string name = given && given->value.is_text() ? given->value.text : "";
      for (std::size_t k = names.size() + 1;
           name.empty() || (!given && std::find(names.begin(), names.end(), name) != names.end());
           ++k)
        name = fmt::format("{} {}", kind, k);
      names.push_back(std::move(name));
    }
    if (kind == "shaft" && !names.empty() && names.front() == "shaft 1") names.front() = "shaft";
    return names;
  }

  /// above: the name of the list.
  Value* into_list(Value& at, const std::string& above, const std::string& part, std::size_t begin,
                   std::size_t end) {
    Value* found = nullptr;
    std::size_t index = 0;
    const auto r = std::from_chars(part.data(), part.data() + part.size(), index);
    const bool number = r.ec == std::errc() && r.ptr == part.data() + part.size();
    const std::vector<std::string> names = names_of(at, above);
    for (std::size_t k = 0; k < names.size(); ++k)
      if (names[k] == part) found = &at.items[k];
    if (!found && number && index < at.items.size()) found = &at.items[index];
    if (!found) {
      const auto near = nearest(part, names);
      diagnostics_.error("E34", spot(begin, end), fmt::format("the list has no member '{}'", part),
                         !near.empty() ? fmt::format("did you mean '{}'?", near.front())
                         : names.empty()
                             ? fmt::format("it has {} members, numbered from 0", at.items.size())
                             : fmt::format("known: {}", fmt::join(names, ", ")));
      return nullptr;
    }
    entry_ += fmt::format("[{}]", found - at.items.data());
    if (end < equal_) return found;
    *found = value_;
    return nullptr;
  }

  Value* into_table(Value& at, const std::string& part, std::size_t begin, std::size_t end) {
    Member* m = at.find(part);
    entry_ += "." + part;
    if (end < equal_) {
      if (!m) m = &at.add(part, Value::make_table(spot(begin, end)), spot(begin, end));
      return &m->value;
    }
    if (m) {
      m->value = value_;
      m->spot = spot(begin, end);
    } else {
      at.add(part, value_, spot(begin, end));
    }
    return nullptr;
  }

  Document& document_;
  std::string argument_;
  int source_, line_;
  Diagnostics& diagnostics_;
  std::size_t equal_ = 0;  ///< place of the '='
  std::string above_;      ///< the part of the path before this one
  std::string entry_;
  Value value_;
};

}  // namespace

void apply_overrides(Document& document, const std::vector<std::string>& arguments,
                     Sources& sources, Diagnostics& diagnostics) {
  if (arguments.empty()) return;
  std::string text;
  for (const auto& a : arguments) {
    std::string line = a;
    std::replace(line.begin(), line.end(), '\n', ' ');
    text += line + "\n";
  }
  const int source = sources.add("--set", sources[0].folder, text);
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const int line = static_cast<int>(k) + 1;
    Override(document, std::string(sources.line(source, line)), source, line, diagnostics).apply();
  }
}

std::string entry_of(Document document, const std::string& path) {
  Diagnostics ignored;
  Override one(document, path + "=0", 0, 1, ignored);
  one.apply();
  return one.entry();
}

}  // namespace whirl::deck
