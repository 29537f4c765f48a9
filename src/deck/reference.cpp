// The reference of all tables and keys, and the table of units, as Markdown.
#include <core/units.hpp>
#include <deck/describer.hpp>
#include <cmath>
#include <fmt/format.h>

namespace whirl::deck {
namespace {

std::string type_of(const KeyInfo& k) {
  switch (k.kind) {
    case KeyInfo::Kind::quantity: return k.unit.empty() ? "number" : k.unit;
    case KeyInfo::Kind::integer: return "integer";
    case KeyInfo::Kind::flag: return "true/false";
    case KeyInfo::Kind::text: return "text";
    case KeyInfo::Kind::texts: return "list of texts";
    case KeyInfo::Kind::quantities:
      return fmt::format("list of {}{}", k.count >= 0 ? fmt::format("{} ", k.count) : "",
                         k.unit.empty() ? "numbers" : k.unit);
    case KeyInfo::Kind::matrix: return fmt::format("6x6 {}", k.unit);
    case KeyInfo::Kind::option: return "word";
    case KeyInfo::Kind::options: return "list of words";
    case KeyInfo::Kind::location: return "place";
    case KeyInfo::Kind::reference: return "name";
    case KeyInfo::Kind::table: return "table";
    case KeyInfo::Kind::list: return "list of tables";
    case KeyInfo::Kind::alternatives: return "word";
    case KeyInfo::Kind::either: return k.unit.empty() ? "number or law" : k.unit + " or law";
    case KeyInfo::Kind::free_table: return "table";
  }
  return "";
}

/// '|' separates the cells of a Markdown table.
std::string cell(const std::string& s) {
  std::string out;
  for (const char c : s) {
    if (c == '|') out.push_back('\\');
    out.push_back(c);
  }
  return out;
}

std::string range_of(const Range& r) {
  const bool a = std::isfinite(r.min), b = std::isfinite(r.max);
  if (!a && !b) return {};
  if (a && b)
    return fmt::format("{}{}, {}{}", r.open_min ? "(" : "[", units::format_number(r.min),
                       units::format_number(r.max), r.open_max ? ")" : "]");
  if (a) return fmt::format("{} {}", r.open_min ? ">" : ">=", units::format_number(r.min));
  return fmt::format("{} {}", r.open_max ? "<" : "<=", units::format_number(r.max));
}

void write_keys(std::string& out, const std::vector<KeyInfo>& keys) {
  out += "| key | value | default | range | meaning |\n|---|---|---|---|---|\n";
  for (const auto& k : keys) {
    if (!k.listed) continue;
    std::string doc = k.doc;
    for (const auto& w : k.words)
      doc += fmt::format("{} `\"{}\"`{}", &w == k.words.data() ? ":" : ",", w.name,
                         *w.doc ? fmt::format(" {}", w.doc) : "");
    out += fmt::format("| `{}` | {} | {} | {} | {} |\n", k.name, cell(type_of(k)),
                       k.required || k.kind == KeyInfo::Kind::alternatives
                           ? "**required**"
                           : cell(k.default_text.empty() ? k.absent : '`' + k.default_text + '`'),
                       range_of(k.range), cell(doc));
  }
  out += "\n";
}

void write_table(std::string& out, const TableInfo& t, const std::string& path,
                 const std::string& header, int depth) {
  if (!t.keys.empty()) write_keys(out, t.keys);
  if (t.row) {
    out += fmt::format(
        "{}: `columns = [\"key[unit]\", ...]` with `rows = [[...], ...]`, or `file = "
        "\"table.csv\"`{}. Columns:\n\n",
        t.row_doc, t.row_required ? "" : " (optional)");
    write_keys(out, t.row->keys);
  }
  for (const auto& k : t.keys) {
    const std::string sub = path.empty() ? k.name : path + "." + k.name;
    const std::string level(static_cast<std::size_t>(std::min(depth + 2, 5)), '#');
    if (k.kind == KeyInfo::Kind::alternatives) {
      for (const auto& c : k.choices) {
        out += fmt::format("{} {}, {} = \"{}\"\n\n{}.\n\n", level, header, k.name, c.name, c.doc);
        write_table(out, *c.table, path, fmt::format("{}, {} = \"{}\"", header, k.name, c.name),
                    depth + 1);
      }
    } else if (k.kind == KeyInfo::Kind::either) {
      out += fmt::format("`{}`: see [Laws of time](#laws-of-time).\n\n", sub);
    } else if (k.table) {
      const std::string title =
          k.kind == KeyInfo::Kind::list ? fmt::format("[[{}]]", sub) : fmt::format("[{}]", sub);
      out += fmt::format("{} {}\n\n{}.\n\n", level, title, k.doc);
      write_table(out, *k.table, sub, title, depth + 1);
    }
  }
}

/// The first law in the tree: all have the same form.
const KeyInfo* find_law(const TableInfo& t) {
  for (const auto& k : t.keys) {
    if (k.kind == KeyInfo::Kind::either) return &k;
    if (k.table)
      if (const auto* x = find_law(*k.table)) return x;
    for (const auto& c : k.choices)
      if (const auto* x = find_law(*c.table)) return x;
  }
  return nullptr;
}

}  // namespace

std::string reference_markdown() {
  std::string out =
      "# Deck reference\n\nEvery table and key of a deck, format 1. A value with a dimension is a "
      "string with its unit, such as `\"75 um\"`; the unit named here is the "
      "usual one, any other of the same kind does as well (`whirl schema --units`). A bare number "
      "is dimensionless; zero needs no unit, but as a temperature. A place is `\"section:mid\"` "
      "(`:start`, `:end`), with "
      "an offset where wanted (`\"section:end - 20 mm\"`), a distance from the left end (`\"1.14 "
      "m\"`), or the name of a disk or bearing; with several shafts "
      "`\"shaft/section:mid\"`. `${name}` stands for a parameter.\n\n## Top level\n\n";
  write_table(out, deck_keys(), "", "", 0);
  if (const KeyInfo* law = find_law(deck_keys())) {
    out +=
        "## Laws of time\n\nA constant (`\"9000 rpm\"`), or a table with a `type`. Where the key "
        "is a speed the values are speeds, and so on; the unit shown stands for that.\n\n";
    write_table(out, *law->table, "", "law", 1);
  }
  return out;
}

std::string units_markdown() {
  std::string out =
      "# Units\n\nCase matters. Join units with a point (`N.m`), divide with `/`, raise with `^`. "
      "SI prefixes where marked.\n\n| unit | meaning | prefixes |\n|---|---|---|\n";
  for (const auto& u : units::unit_table())
    out += fmt::format("| `{}` | {} | {} |\n", u.name, u.meaning, u.prefixes ? "yes" : "");
  return out;
}

}  // namespace whirl::deck
