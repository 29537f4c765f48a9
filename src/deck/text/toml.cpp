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
#include <optional>
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

/// A number, from `start` on, and the unit behind it.
struct BareNumber {
  std::size_t end = 0;  ///< of the number
  bool comma = false;   ///< it holds a decimal comma
  Piece unit;           ///< number and unit, where one stands behind it
};

/// Reads the number that starts at `start`; nothing where none does. comma_counts: a comma between
/// digits belongs to it.
std::optional<BareNumber> read_number(std::string_view line, std::size_t start, bool comma_counts) {
  const auto digit_at = [&](std::size_t k) { return k < line.size() && digit(line[k]); };
  std::size_t k = start + (line[start] == '+' || line[start] == '-' ? 1 : 0);
  if (!digit_at(k) && !(k < line.size() && line[k] == '.' && digit_at(k + 1))) return std::nullopt;
  BareNumber out;
  while (k < line.size() && (digit(line[k]) || line[k] == '.'))
    ++k;
  if (comma_counts && k < line.size() && line[k] == ',' && digit_at(k + 1)) {
    out.comma = true;
    ++k;
    while (digit_at(k))
      ++k;
  }
  if (k + 1 < line.size() && (line[k] == 'e' || line[k] == 'E') &&
      (digit_at(k + 1) || ((line[k + 1] == '-' || line[k + 1] == '+') && digit_at(k + 2)))) {
    k += 2;
    while (digit_at(k))
      ++k;
  }
  out.end = k;
  std::size_t u = k;
  while (u < line.size() && (line[u] == ' ' || line[u] == '\t'))
    ++u;
  if (u < line.size() && (letter(line[u]) || line[u] == '%')) {
    std::size_t e = std::min(line.find_first_of(",]}#\"'", u), line.size());
    while (e > u && (line[e - 1] == ' ' || line[e - 1] == '\t' || line[e - 1] == '\r'))
      --e;
    out.unit = {start, e, out.comma ? Piece::decimal_comma : Piece::quantity};
  }
  return out;
}

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
    if (before == '=' || before == '[' || before == ',')
      if (const auto number = read_number(line, i, brackets == 0)) {
        if (number->unit.kind != Piece::none) return number->unit;
        if (number->comma) return {i, number->end, Piece::decimal_comma};
        i = number->end - 1;
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

/// A line of a deck that is no TOML: says what is wrong with it, and what may stand in its place so
/// that the rest can be read.
class LineMender {
 public:
  LineMender(const toml::parse_error& e, Spot at, std::string line, Diagnostics& diagnostics)
      : at_(at),
        line_(std::move(line)),
        bare_(find_bare(line_)),
        value_(value_of_line(line_)),
        description_(e.description()),
        diagnostics_(diagnostics),
        replacement_(line_) {}

  bool is_bare() const { return bare_.kind != Piece::none; }
  /// Reports the mistake. False: nothing can stand in its place.
  bool mend() {
    if (is_bare()) return mend_bare();
    if (says_redefined() && value_ != std::string::npos) return drop_second_key();
    if (says_redefined() && first() != std::string::npos && line_[first()] == '[')
      say_second_table();
    else
      say_syntax();
    return replace_value();
  }
  /// A whole line is left out, and keys of it with it.
  bool damaged() const { return damaged_; }
  /// What stands for the line; the control character is written as an escape, since TOML forbids it
  /// in the text.
  std::string replacement() const {
    std::string out = replacement_;
    if (const auto k = out.find('\x01'); k != std::string::npos) out.replace(k, 1, "\\u0001");
    return out;
  }

 private:
  bool says_redefined() const { return description_.find("redefine") != std::string::npos; }
  std::size_t first() const { return line_.find_first_not_of(" \t"); }

  /// A value without quotes.
  bool mend_bare() {
    const std::string_view piece =
        std::string_view(line_).substr(bare_.begin, bare_.end - bare_.begin);
    at_.column = characters(std::string_view(line_).substr(0, bare_.begin)) + 1;
    at_.length = characters(piece);
    std::string quoted(piece);
    if (bare_.kind == Piece::quantity) {
      diagnostics_.error("E11", at_, fmt::format("the quantity {} is not in quotes", piece),
                         fmt::format("write \"{}\"", piece));
    } else {
      const std::string point = with_point(piece);
      const bool unit = point.find_first_not_of("+-.0123456789eE") != std::string::npos;
      diagnostics_.error("E12", at_, fmt::format("{} has a comma inside a number", piece),
                         fmt::format("write {}{}{} with a decimal point and no thousands separator",
                                     unit ? "\"" : "", point, unit ? "\"" : ""));
      quoted = std::string(bad_text);
    }
    replacement_ = line_.substr(0, bare_.begin) + '"' + quoted + '"' + line_.substr(bare_.end);
    return true;
  }

  bool drop_second_key() {
    const std::size_t k = first();
    const std::string key = line_.substr(k, line_.find_first_of(" \t=", k) - k);
    at_.column = static_cast<int>(k) + 1;
    at_.length = static_cast<int>(key.size());
    diagnostics_.error("E29", at_, fmt::format("'{}' is set twice in this table", key),
                       "keep one of the two");
    replacement_.clear();
    return true;
  }

  void say_second_table() {
    const std::size_t open = line_.find('['), close = line_.find_last_of(']');
    const std::size_t length = close == std::string::npos ? 1 : close + 1 - open;
    at_.column = static_cast<int>(open) + 1;
    at_.length = static_cast<int>(std::max<std::size_t>(1, length));
    diagnostics_.error("E29", at_,
                       fmt::format("the table {} is given twice",
                                   line_.substr(open, static_cast<std::size_t>(at_.length))),
                       "join the two, or write [[...]] for a list of tables");
  }

  void say_syntax() {
    const auto [message, hint] = explain_syntax(description_, line_);
    diagnostics_.error("E01", at_, message, hint);
  }

  /// The value, or the line where there is none.
  bool replace_value() {
    if (value_ != std::string::npos && line_.find("\"\"\"") == std::string::npos) {
      const std::size_t last = line_.find_last_not_of(" \t\r");
      const bool continues = last != std::string::npos &&
                             (line_[last] == '[' || line_[last] == '{' || line_[last] == ',');
      replacement_ = line_.substr(0, value_) + " \"" + std::string(bad_text) + '"';
      return !continues;  // a list over several lines: its end cannot be found
    }
    const bool header = first() != std::string::npos && line_[first()] == '[' &&
                        value_ == std::string::npos && line_.find('=') == std::string::npos &&
                        line_.find(',') == std::string::npos;
    replacement_.clear();
    damaged_ = true;
    return !header && at_.line >= 1;  // the keys after it would land in another table
  }

  Spot at_;
  std::string line_;
  Piece bare_;
  std::size_t value_;
  std::string description_;
  Diagnostics& diagnostics_;
  std::string replacement_;
  bool damaged_ = false;
};

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
    const Spot at = spot_of(e.source(), source);
    const auto number = static_cast<std::size_t>(std::max(at.line, 1));
    std::size_t begin = 0;
    for (std::size_t k = 1; k < number && begin < text.size(); ++k)
      begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
    std::size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin && text[end - 1] == '\r') --end;

    LineMender mender(e, at, text.substr(begin, end - begin), diagnostics);
    const bool again = !mended.insert(number).second && !mender.is_bare();
    const bool mendable = mender.mend() && !again && mistakes < max_mistakes;
    doc.damaged = doc.damaged || mender.damaged();
    if (!mendable) {
      doc.complete = false;
      return doc;
    }
    text.replace(begin, end - begin, mender.replacement());
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
