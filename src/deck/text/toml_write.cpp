#include <core/units.hpp>
#include <deck/text/document.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

std::string quote_text(std::string_view s) {
  std::string r = "\"";
  for (char c : s) {
    switch (c) {
      case '"': r += "\\\""; break;
      case '\\': r += "\\\\"; break;
      case '\n': r += "\\n"; break;
      case '\t': r += "\\t"; break;
      case '\r': r += "\\r"; break;
      default:
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
          r += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
        else
          r += c;
    }
  }
  return r + '"';
}

std::string key_text(std::string_view k) {
  const bool bare = !k.empty() && std::all_of(k.begin(), k.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return bare ? std::string(k) : quote_text(k);
}

bool list_of_tables(const Value& v) {
  return v.is_array() && !v.items.empty() &&
         std::all_of(v.items.begin(), v.items.end(), [](const Value& x) { return x.is_table(); });
}

std::string inline_text(const Value& v) {
  if (!v.varied.empty()) return quote_text(v.varied);
  switch (v.kind) {
    case Value::Kind::boolean: return v.boolean ? "true" : "false";
    case Value::Kind::integer: return fmt::format("{}", v.integer);
    case Value::Kind::real: {
      std::string s = units::format_number(v.real);
      if (s.find_first_of(".en") == std::string::npos) s += ".0";
      return s;
    }
    case Value::Kind::array: {
      std::string r = "[";
      for (const auto& x : v.items)
        r += (r.size() > 1 ? ", " : "") + inline_text(x);
      return r + "]";
    }
    case Value::Kind::table: {
      std::string r = "{";
      for (const auto& m : v.members)
        r += fmt::format("{} {} = {}", r.size() > 1 ? "," : "", key_text(m.key),
                         inline_text(m.value));
      return r + (v.members.empty() ? "}" : " }");
    }
    default: return quote_text(v.text);
  }
}

void write_table(std::string& out, const Value& t, const std::string& path) {
  for (const auto& m : t.members) {
    if (m.value.is_table() || list_of_tables(m.value)) continue;
    const bool rows =
        m.value.is_array() && !m.value.items.empty() && m.value.items.front().is_array();
    if (!rows) {
      out += fmt::format("{} = {}\n", key_text(m.key), inline_text(m.value));
      continue;
    }
    out += key_text(m.key) + " = [\n";
    for (const auto& row : m.value.items)
      out += "  " + inline_text(row) + ",\n";
    out += "]\n";
  }
  for (const auto& m : t.members) {
    const std::string sub = path.empty() ? key_text(m.key) : path + "." + key_text(m.key);
    if (m.value.is_table()) {
      out += fmt::format("\n[{}]\n", sub);
      write_table(out, m.value, sub);
    } else if (list_of_tables(m.value)) {
      for (const auto& x : m.value.items) {
        out += fmt::format("\n[[{}]]\n", sub);
        write_table(out, x, sub);
      }
    }
  }
}

}  // namespace

std::string write_toml(const Value& root) {
  std::string out;
  write_table(out, root, {});
  return out;
}

}  // namespace whirl::deck
