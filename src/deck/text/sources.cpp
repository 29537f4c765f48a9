#include <deck/text/sources.hpp>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <system_error>

namespace whirl::deck {

int Sources::add(std::string name, std::filesystem::path folder, std::string text) {
  Source s{std::move(name), std::move(folder), std::move(text), {0}};
  for (std::size_t i = 0; i < s.text.size(); ++i)
    if (s.text[i] == '\n') s.line_start.push_back(i + 1);
  sources_.push_back(std::move(s));
  return static_cast<int>(sources_.size()) - 1;
}

std::string_view Sources::line(int source, int number) const {
  if (source < 0 || source >= size() || number < 1) return {};
  const Source& s = (*this)[source];
  const auto k = static_cast<std::size_t>(number - 1);
  if (k >= s.line_start.size()) return {};
  const std::size_t a = s.line_start[k];
  std::size_t b = k + 1 < s.line_start.size() ? s.line_start[k + 1] - 1 : s.text.size();
  std::string_view r = std::string_view(s.text).substr(a, b - a);
  if (r.ends_with('\r')) r.remove_suffix(1);
  if (number == 1 && r.starts_with("\xEF\xBB\xBF")) r.remove_prefix(3);
  return r;
}

Where Sources::where(const Spot& s) const {
  Where w;
  if (s.source < 0 || s.source >= size()) return w;
  w.file = (*this)[s.source].name;
  w.line = s.line;
  w.column = s.column;
  w.length = s.length;
  return w;
}

std::string_view Sources::line(const Where& w) const {
  for (int i = 0; i < size(); ++i)
    if ((*this)[i].name == w.file) return line(i, w.line);
  return {};
}

namespace {

/// In pieces: the size of pipes and devices is not known beforehand.
void read_stream(std::istream& in, const std::string& name, std::size_t limit, FileText& r) {
  std::string buffer(1u << 16, '\0');
  while (in) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    r.text.append(buffer.data(), static_cast<std::size_t>(in.gcount()));
    if (r.text.size() > limit) {
      r.text.clear();
      r.code = "E03";
      r.message = fmt::format("'{}' is larger than the limit of {} MiB", name, limit >> 20);
      r.hint = "long tables belong in CSV files named by 'file'";
      return;
    }
  }
  if (in.bad()) {
    r.text.clear();
    r.code = "E02";
    r.message = fmt::format("cannot read '{}': {}", name, std::strerror(errno));
  }
}

}  // namespace

FileText read_file(const std::filesystem::path& path, std::size_t limit) {
  FileText r;
  std::error_code ec;
  const auto status = std::filesystem::status(path, ec);
  if (ec || !std::filesystem::exists(status)) {
    r.code = "E02";
    r.message = fmt::format(
        "cannot read '{}': {}", path.string(),
        ec && ec != std::errc::no_such_file_or_directory ? ec.message() : "no such file");
    // a near name in the same folder is the usual mistake
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    std::vector<std::string> near;
    for (std::filesystem::directory_iterator it(folder, ec), none;
         !ec && it != none && near.size() < 200; it.increment(ec))
      near.push_back(it->path().filename().string());
    std::sort(near.begin(), near.end());
    const std::string want = path.filename().string();
    for (const auto& n : near)
      if (n != want && n.size() == want.size() &&
          std::equal(n.begin(), n.end(), want.begin(), [](char a, char b) {
            return std::tolower(static_cast<unsigned char>(a)) ==
                   std::tolower(static_cast<unsigned char>(b));
          }))
        r.hint = fmt::format("there is a file '{}' in that folder", n);
    return r;
  }
  if (std::filesystem::is_directory(status)) {
    r.code = "E02";
    r.message = fmt::format("cannot read '{}': it is a folder", path.string());
    if (std::filesystem::exists(path / "deck.toml", ec))
      r.hint = fmt::format("did you mean '{}'?", (path / "deck.toml").string());
    return r;
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    r.code = "E02";
    r.message = fmt::format("cannot read '{}': {}", path.string(), std::strerror(errno));
    return r;
  }
  read_stream(in, path.string(), limit, r);
  return r;
}

FileText read_standard_input(std::size_t limit) {
  static const FileText kept = [limit] {
    FileText r;
    read_stream(std::cin, "standard input", limit, r);
    return r;
  }();
  return kept;
}

namespace {

/// Bytes of the UTF-8 sequence at s, or 0 when there is none.
std::size_t sequence(std::string_view s) {
  const auto b = [&](std::size_t k) {
    return k < s.size() ? static_cast<unsigned char>(s[k]) : 0u;
  };
  const auto tail = [&](std::size_t k) { return (b(k) & 0xC0u) == 0x80u; };
  if (b(0) < 0x80) return 1;
  if (b(0) >= 0xC2 && b(0) < 0xE0 && tail(1)) return 2;
  if ((b(0) & 0xF0u) == 0xE0u && tail(1) && tail(2) && !(b(0) == 0xE0 && b(1) < 0xA0) &&
      !(b(0) == 0xED && b(1) >= 0xA0))
    return 3;
  if (b(0) >= 0xF0 && b(0) < 0xF5 && tail(1) && tail(2) && tail(3) &&
      !(b(0) == 0xF0 && b(1) < 0x90) && !(b(0) == 0xF4 && b(1) >= 0x90))
    return 4;
  return 0;
}

/// Where in a deck the text stands: within quotes, a comment, so many brackets.
class TomlPlace {
 public:
  bool plain() const { return state_ == State::plain; }
  bool too_deep() const { return depth_ > max_depth || dots_ > max_depth; }
  std::string what_is_deep() const {
    return depth_ > max_depth ? "brackets are" : "a dotted key is";
  }

  /// Takes the character at the front of `rest`, of n bytes; how many bytes it takes.
  std::size_t take(std::string_view rest, std::size_t n) {
    const char c = rest.front();
    const bool escape = rest.starts_with("\\\"") || rest.starts_with("\\\\");
    switch (state_) {
      case State::plain: return take_plain(rest, n);
      case State::comment:
        if (c == '\n') state_ = State::plain;
        break;
      case State::basic:
        if (escape) return 2;
        if (c == '"' || c == '\n') state_ = State::plain;
        break;
      case State::literal:
        if (c == '\'' || c == '\n') state_ = State::plain;
        break;
      case State::long_basic:
        if (escape) return 2;
        if (rest.starts_with(three_basic)) return go(State::plain, 3);
        break;
      case State::long_literal:
        if (rest.starts_with(three_literal)) return go(State::plain, 3);
        break;
    }
    return n;
  }

 private:
  enum class State { plain, comment, basic, literal, long_basic, long_literal };
  static constexpr std::string_view three_basic = "\"\"\"", three_literal = "'''";
  std::size_t go(State to, std::size_t bytes) {
    state_ = to;
    return bytes;
  }
  std::size_t take_plain(std::string_view rest, std::size_t n) {
    if (rest.starts_with(three_basic)) return go(State::long_basic, 3);
    if (rest.starts_with(three_literal)) return go(State::long_literal, 3);
    switch (rest.front()) {
      case '#': return go(State::comment, n);
      case '"': return go(State::basic, n);
      case '\'': return go(State::literal, n);
      case '[':
      case '{':
        ++depth_;
        dots_ = 0;
        break;
      case ']':
      case '}':
        depth_ = std::max(0, depth_ - 1);
        dots_ = 0;
        break;
      case '.': ++dots_; break;
      case '=':
      case ',':
      case '\n': dots_ = 0; break;
      default: break;
    }
    return n;
  }

  State state_ = State::plain;
  int depth_ = 0, dots_ = 0;
};

}  // namespace

TextProblem check_text(std::string_view text, TextKind kind) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    return {"the file is UTF-16 text", "save it as UTF-8", 0, 0};
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    return {"the file is empty", "`whirl new` writes a deck to start from", 0, 0};
  int line = 1, column = 1;
  TomlPlace place;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t n = sequence(text.substr(i));
    const char c = text[i];
    const auto u = static_cast<unsigned char>(c);
    if (n == 0 || (u < 0x20 && c != '\n' && c != '\r' && c != '\t') || u == 0x7F)
      return {n == 0 ? "the file is not UTF-8 text"
                     : "the file holds control characters: it is not a text file",
              "a deck is a UTF-8 text file", line, column};
    std::size_t advance = n;
    if (kind != TextKind::table) {
      // Not TOML, and one of the parser's character tables does not cover them.
      if (n > 1 && kind == TextKind::deck && place.plain())
        return {fmt::format("'{}' stands outside quotes", text.substr(i, n)),
                "put names and values with such letters in quotes", line, column};
      const bool plain = place.plain();
      advance = place.take(text.substr(i), n);
      if (plain && place.too_deep())
        return {fmt::format("{} nested deeper than {} levels", place.what_is_deep(), max_depth),
                "no deck needs that", line, column};
    }
    if (c == '\n') {
      ++line;
      column = 1;
    } else
      column += advance == n ? 1 : static_cast<int>(advance);
    i += advance;
  }
  return {};
}

}  // namespace whirl::deck
