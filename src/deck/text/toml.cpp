// The only file that knows the TOML library. Converts its tree to ours, in the order of the text.
//
// The library stops at the first mistake. Since users want all of them, the offending text is
// mended (an unquoted quantity is quoted, anything else is replaced by a value that is known to be
// bad) and the text is parsed again.
#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_UNRELEASED_FEATURES 0
// The parser asserts, before it reports the mistake itself, that a table header begins as a key
// does ("[@]"); with NDEBUG Clang is told to assume it. Text of a user decides: neither may be.
#define TOML_ASSERT(...) static_assert(true)
#pragma push_macro("NDEBUG")
#undef NDEBUG
#include <toml++/toml.h>
#pragma pop_macro("NDEBUG")

#include <deck/text/document.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace whirl::deck {
namespace {

constexpr std::string_view bad_text =
    "\x01unreadable";  // cannot come from a file: control characters are refused before
constexpr int max_mistakes = 50;

Spot spot_of(const toml::source_region& r, int source) {
  Spot s;
  s.source = source;
  s.line = static_cast<int>(r.begin.line);
  s.column = static_cast<int>(r.begin.column);
  s.length = r.end.line == r.begin.line && r.end.column > r.begin.column
                 ? static_cast<int>(r.end.column - r.begin.column)
                 : 1;
  return s;
}

Value convert(const toml::node& n, int source) {
  Value v;
  v.spot = spot_of(n.source(), source);
  if (const auto* t = n.as_table()) {
    v.kind = Value::Kind::table;
    for (const auto& [key, node] : *t)
      v.members.push_back(
          {std::string(key.str()), spot_of(key.source(), source), convert(node, source)});
    std::stable_sort(v.members.begin(), v.members.end(), [](const Member& a, const Member& b) {
      return std::pair(a.spot.line, a.spot.column) < std::pair(b.spot.line, b.spot.column);
    });
  } else if (const auto* a = n.as_array()) {
    v.kind = Value::Kind::array;
    for (const auto& x : *a)
      v.items.push_back(convert(x, source));
  } else if (const auto* s = n.as_string()) {
    v.kind = s->get() == bad_text ? Value::Kind::unreadable : Value::Kind::text;
    v.text = s->get();
  } else if (const auto* i = n.as_integer()) {
    v.kind = Value::Kind::integer;
    v.integer = i->get();
  } else if (const auto* d = n.as_floating_point()) {
    v.kind = Value::Kind::real;
    v.real = d->get();
  } else if (const auto* b = n.as_boolean()) {
    v.kind = Value::Kind::boolean;
    v.boolean = b->get();
  } else {
    v.kind = Value::Kind::date;
  }
  return v;
}

bool digit(char c) { return c >= '0' && c <= '9'; }
bool letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (static_cast<unsigned char>(c) & 0x80);
}

/// A stretch of a line, in bytes.
struct Piece {
  std::size_t begin = 0, end = 0;
  enum { none, quantity, decimal_comma } kind = none;
};

/// The first number in the line that is followed by a unit or holds a comma, outside strings and
/// comments, at a place where a value can stand.
Piece find_bare(std::string_view line) {
  char quote = '\0';
  char before = '\0';  // last character that is not blank
  int brackets = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote) {
      if (c == '\\' && quote == '"')
        ++i;
      else if (c == quote) {
        quote = '\0';
        before = c;
      }
      continue;
    }
    if (c == '"' || c == '\'') {
      quote = c;
      continue;
    }
    if (c == '#') break;
    if (c == ' ' || c == '\t') continue;
    const bool value_here = before == '=' || before == '[' || before == ',';
    const std::size_t start = i;
    std::size_t k = i + (c == '+' || c == '-' ? 1 : 0);
    if (value_here && k < line.size() &&
        (digit(line[k]) || (line[k] == '.' && k + 1 < line.size() && digit(line[k + 1])))) {
      bool comma = false;
      while (k < line.size() && (digit(line[k]) || line[k] == '.'))
        ++k;
      if (brackets == 0 && k + 1 < line.size() && line[k] == ',' && digit(line[k + 1])) {
        comma = true;
        ++k;
        while (k < line.size() && digit(line[k]))
          ++k;
      }
      if (k + 1 < line.size() && (line[k] == 'e' || line[k] == 'E') &&
          (digit(line[k + 1]) || ((line[k + 1] == '-' || line[k + 1] == '+') &&
                                  k + 2 < line.size() && digit(line[k + 2])))) {
        k += 2;
        while (k < line.size() && digit(line[k]))
          ++k;
      }
      std::size_t u = k;
      while (u < line.size() && (line[u] == ' ' || line[u] == '\t'))
        ++u;
      if (u < line.size() && (letter(line[u]) || line[u] == '%')) {
        std::size_t e = u;
        while (e < line.size() && line[e] != ',' && line[e] != ']' && line[e] != '}' &&
               line[e] != '#' && line[e] != '"' && line[e] != '\'')
          ++e;
        while (e > u && (line[e - 1] == ' ' || line[e - 1] == '\t' || line[e - 1] == '\r'))
          --e;
        return {start, e, comma ? Piece::decimal_comma : Piece::quantity};
      }
      if (comma) return {start, k, Piece::decimal_comma};
      i = k - 1;
      before = '0';
      continue;
    }
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') --brackets;
    before = c;
  }
  return {};
}

int characters(std::string_view s) {
  return static_cast<int>(std::count_if(
      s.begin(), s.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string with_point(std::string_view s) {
  std::string r(s);
  std::replace(r.begin(), r.end(), ',', '.');
  return r;
}

/// Start of the value in a line "key = value", or npos.
std::size_t value_of_line(std::string_view line) {
  std::size_t i = line.find_first_not_of(" \t");
  if (i == std::string_view::npos) return i;
  while (i < line.size() &&
         (letter(line[i]) || digit(line[i]) || line[i] == '_' || line[i] == '-' || line[i] == '.' ||
          line[i] == '"' || line[i] == ' ' || line[i] == '\t'))
    ++i;
  if (i >= line.size() || line[i] != '=') return std::string_view::npos;
  return i + 1;
}

std::string lower_first(std::string s) {
  if (!s.empty() && s[0] >= 'A' && s[0] <= 'Z' && !(s.size() > 1 && s[1] >= 'A' && s[1] <= 'Z'))
    s[0] = static_cast<char>(s[0] - 'A' + 'a');
  return s;
}

/// What the library says, in the words of a user, for the usual mistakes.
std::pair<std::string, std::string> explain_syntax(const std::string& description,
                                                   std::string_view line) {
  const auto says = [&](const char* s) { return description.find(s) != std::string::npos; };
  if (says("control characters other than TAB") || (says("string") && says("end-of-file")))
    return {"a quote is not closed", "text stands between two double quotes on one line"};
  if (says("expected value, saw")) return {"a value is missing after '='", ""};
  if (says("could not determine value type") && line.find("==") != std::string_view::npos)
    return {"'==' where '=' is expected", ""};
  if (says("could not determine value type"))
    return {"a value that is neither a number nor text in quotes", "text stands in double quotes"};
  if (says("parsing table header"))
    return {"a header that is not closed", "write [name] or [[name]]"};
  if (says("end-of-file"))
    return {"the file ends inside a value", "a bracket or quote is not closed"};
  std::string text = description;
  if (text.starts_with("Error while ")) text = "while " + text.substr(12);
  return {fmt::format("not valid TOML ({})", lower_first(text)), ""};
}

}  // namespace

Document parse_toml(const Sources& sources, int source, Diagnostics& diagnostics) {
  Document doc;
  std::string text = sources[source].text;
  std::set<std::size_t> mended;  // lines already replaced
  for (int mistakes = 0;; ++mistakes) {
    toml::parse_result result = toml::parse(std::string_view(text));
    if (result) {
      doc.root = convert(result.table(), source);
      return doc;
    }
    const auto& e = result.error();
    Spot at = spot_of(e.source(), source);
    const auto number = static_cast<std::size_t>(std::max(at.line, 1));
    std::size_t begin = 0;
    for (std::size_t k = 1; k < number && begin < text.size(); ++k)
      begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
    std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin && text[end - 1] == '\r') --end;
    const std::string line = text.substr(begin, end - begin);

    const Piece bare = find_bare(line);
    const std::size_t value = value_of_line(line);
    const std::string description(e.description());
    const bool again = !mended.insert(number).second && bare.kind == Piece::none;
    std::string replacement = line;
    bool mendable = !again && mistakes < max_mistakes;
    if (bare.kind != Piece::none) {
      const std::string_view piece =
          std::string_view(line).substr(bare.begin, bare.end - bare.begin);
      at.column = characters(std::string_view(line).substr(0, bare.begin)) + 1;
      at.length = characters(piece);
      if (bare.kind == Piece::quantity) {
        diagnostics.error("E11", at, fmt::format("the quantity {} is not in quotes", piece),
                          fmt::format("write \"{}\"", piece));
        replacement =
            line.substr(0, bare.begin) + '"' + std::string(piece) + '"' + line.substr(bare.end);
      } else {
        const std::string point = with_point(piece);
        const bool unit = point.find_first_not_of("+-.0123456789eE") != std::string::npos;
        diagnostics.error(
            "E12", at, fmt::format("{} has a comma inside a number", piece),
            fmt::format("write {}{}{} with a decimal point and no thousands separator",
                        unit ? "\"" : "", point, unit ? "\"" : ""));
        replacement =
            line.substr(0, bare.begin) + '"' + std::string(bad_text) + '"' + line.substr(bare.end);
      }
    } else if (description.find("redefine") != std::string::npos && value != std::string::npos) {
      const std::size_t k = line.find_first_not_of(" \t");
      const std::string key = line.substr(k, line.find_first_of(" \t=", k) - k);
      at.column = static_cast<int>(k) + 1;
      at.length = static_cast<int>(key.size());
      diagnostics.error("E29", at, fmt::format("'{}' is set twice in this table", key),
                        "keep one of the two");
      replacement.clear();
    } else {
      const bool redefined = description.find("redefine") != std::string::npos &&
                             line.find_first_not_of(" \t") != std::string::npos &&
                             line[line.find_first_not_of(" \t")] == '[';
      if (redefined) {
        at.column = static_cast<int>(line.find('[')) + 1;
        at.length = static_cast<int>(
            std::max<std::size_t>(1, line.find_last_of(']') == std::string::npos
                                         ? 1
                                         : line.find_last_of(']') + 1 - line.find('[')));
        diagnostics.error(
            "E29", at,
            fmt::format("the table {} is given twice",
                        line.substr(line.find('['), static_cast<std::size_t>(at.length))),
            "join the two, or write [[...]] for a list of tables");
      } else {
        const auto [message, hint] = explain_syntax(description, line);
        diagnostics.error("E01", at, message, hint);
      }
      const std::size_t first = line.find_first_not_of(" \t");
      const bool header = first != std::string::npos && line[first] == '[' &&
                          value == std::string::npos && line.find('=') == std::string::npos &&
                          line.find(',') == std::string::npos;
      if (value != std::string::npos && line.find("\"\"\"") == std::string::npos) {
        const std::size_t open = line.find_last_not_of(" \t\r");
        const bool continues = open != std::string::npos &&
                               (line[open] == '[' || line[open] == '{' || line[open] == ',');
        if (continues) mendable = false;  // a list over several lines: its end cannot be found
        replacement = line.substr(0, value) + " \"" + std::string(bad_text) + '"';
      } else {
        if (header || at.line < 1)
          mendable = false;  // the keys after it would land in another table
        replacement.clear();
        doc.damaged = true;
      }
    }
    if (!mendable) {
      doc.complete = false;
      return doc;
    }
    // the control character is written as an escape, since TOML forbids it in the text
    if (const auto k = replacement.find('\x01'); k != std::string::npos)
      replacement.replace(k, 1, "\\u0001");
    text.replace(begin, end - begin, replacement);
  }
}

Value parse_set_value(std::string_view text, const Spot& spot) {
  const std::string line = fmt::format("v = {}\n", text);
  Value v = Value::of_text(std::string(text));
  if (check_text(line, TextKind::deck).ok() &&
      text.find('\n') ==
          std::string_view::npos) {  // else no TOML, such as 90 um with a Greek letter
    toml::parse_result result = toml::parse(line);
    const toml::node* node = result ? result.table().get("v") : nullptr;
    if (node && result.table().size() == 1) v = convert(*node, spot.source);
  }
  // every place inside is the argument itself
  const auto place = [&](auto&& self, Value& x) -> void {
    x.spot = spot;
    for (auto& i : x.items)
      self(self, i);
    for (auto& m : x.members) {
      m.spot = spot;
      self(self, m.value);
    }
  };
  place(place, v);
  return v;
}

}  // namespace whirl::deck
