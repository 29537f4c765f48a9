// The reference of all tables and keys, and the table of units, as Markdown.
#include <core/units.hpp>
#include <deck/describer.hpp>
#include <deck/reference.hpp>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace whirl::deck {
namespace {

std::string type_of(const KeyInfo& k) {
  switch (k.kind) {
    case KeyInfo::Kind::quantity:
      return (k.unit.empty() ? "number" : k.unit) + (k.each ? ", or a list" : "");
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

/// Where the reference of laws stands, as seen from the page that is written.
constexpr const char* laws_below = "#laws-of-time";

void write_rows(std::string& out, const TableInfo& t) {
  if (!t.row) return;
  out += fmt::format(
      "{}: `columns = [\"key[unit]\", ...]` with `rows = [[...], ...]`, or `file = "
      "\"table.csv\"`{}. Columns:\n\n",
      t.row_doc, t.row_required ? "" : " (optional)");
  write_keys(out, t.row->keys);
}

void write_table(std::string& out, const TableInfo& t, const std::string& path,
                 const std::string& header, int depth, const char* laws) {
  if (!t.keys.empty()) write_keys(out, t.keys);
  write_rows(out, t);
  for (const auto& k : t.keys) {
    const std::string sub = path.empty() ? k.name : path + "." + k.name;
    const std::string level(static_cast<std::size_t>(std::min(depth + 2, 5)), '#');
    if (k.kind == KeyInfo::Kind::alternatives) {
      for (const auto& c : k.choices) {
        out += fmt::format("{} {}, {} = \"{}\"\n\n{}.\n\n", level, header, k.name, c.name, c.doc);
        write_table(out, *c.table, path, fmt::format("{}, {} = \"{}\"", header, k.name, c.name),
                    depth + 1, laws);
      }
    } else if (k.kind == KeyInfo::Kind::either) {
      out += fmt::format("`{}`: see [Laws of time]({}).\n\n", sub, laws);
    } else if (k.table) {
      const std::string title =
          k.kind == KeyInfo::Kind::list ? fmt::format("[[{}]]", sub) : fmt::format("[{}]", sub);
      out += fmt::format("{} {}\n\n{}.\n\n", level, title, k.doc);
      write_table(out, *k.table, sub, title, depth + 1, laws);
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

constexpr const char* how_to_read =
    "Every table and key of a deck, format 1. A value with a dimension is a "
    "string with its unit, such as `\"75 um\"`; the unit named here is the "
    "usual one, any other of the same kind does as well (`whirl schema --units`). A bare number "
    "is dimensionless; zero needs no unit, but as a temperature. A place is `\"section:mid\"` "
    "(`:start`, `:end`), with "
    "an offset where wanted (`\"section:end - 20 mm\"`), a distance from the left end (`\"1.14 "
    "m\"`), or the name of a disk or bearing (if no section or shaft of that name begins "
    "elsewhere); with several shafts "
    "`\"shaft/section:mid\"`. `${name}` stands for a parameter.\n\n";

constexpr const char* axes_and_signs =
    "## Axes and signs\n\n"
    "Right-handed axes, fixed in space: **x** along the shafts from left to right, **y** across, "
    "**z** up (weight acts along -z unless `gravity_direction` says otherwise).\n\n"
    "| what | sign |\n|---|---|\n"
    "| spin, torque, angle about the shaft | positive by the right hand about x: it carries y "
    "towards z |\n"
    "| angles of probes, lobes, pivots, loads, heavy spots | from y towards z, of heavy spots on "
    "the shaft |\n"
    "| rotations `rx`, `ry`, `rz` | positive by the right hand about x, y, z: a shaft that rises "
    "along x has a negative `ry` |\n"
    "| force of a linear bearing on the shaft | preload - K (q - setpoint) - C q' - M q''; `kyz` "
    "is "
    "the force along y from motion along z |\n"
    "| cross-coupling | `kyz = k`, `kzy = -k` with k > 0 drives whirl in the sense of a positive "
    "spin |\n"
    "| forward, backward | with and against the spin of the shaft there |\n"
    "| phase | a lag: behind the rotor mark, later in time |\n"
    "| axial force in a shaft | tension positive |\n\n"
    "Other programs: what ROSS, Dyrobes and API's coefficients call x, y (along the shaft: z) is "
    "y, "
    "z here (along the shaft: x). So kxx, kxy, kyx, kyy there are kyy, kyz, kzy, kzz here; "
    "`whirl convert` does that.\n\n";

void write_laws(std::string& out, const char* laws) {
  out +=
      "A constant (`\"9000 rpm\"`), or a table with a `type`. Where the key "
      "is a speed the values are speeds, and so on; the unit shown stands for that.\n\n";
  if (const KeyInfo* law = find_law(deck_keys())) write_table(out, *law->table, "", "law", 1, laws);
}

// ---- pages

const KeyInfo* alternatives_of(const TableInfo& t) {
  for (const auto& k : t.keys)
    if (k.kind == KeyInfo::Kind::alternatives) return &k;
  return nullptr;
}

std::string title_of(const KeyInfo& k) {
  return k.kind == KeyInfo::Kind::list ? fmt::format("[[{}]]", k.name)
                                       : fmt::format("[{}]", k.name);
}

/// The page of a table with many kinds: what they share, and a list of their pages, which follow.
void add_kinds(std::vector<ReferencePage>& pages, const KeyInfo& k, const KeyInfo& kinds) {
  const std::string title = title_of(k);
  std::string out = fmt::format("# {}\n\n{}. What all kinds share:\n\n", title, k.doc);
  TableInfo shared = *k.table;
  std::erase_if(shared.keys,
                [](const KeyInfo& x) { return x.kind == KeyInfo::Kind::alternatives; });
  write_table(out, shared, k.name, title, 0, "laws.md");
  out += fmt::format("## Kinds\n\n| {} | |\n|---|---|\n", kinds.name);
  std::vector<ReferencePage> own;
  for (const auto& c : kinds.choices) {
    const std::string file = fmt::format("{}_{}.md", k.name, c.name);
    out += fmt::format("| [`\"{}\"`]({}) | {} |\n", c.name, file, cell(c.doc));
    const std::string header = fmt::format("{}, {} = \"{}\"", title, kinds.name, c.name);
    std::string page =
        fmt::format("# {}\n\n{}. Beside these keys those that [all kinds share]({}.md).\n\n",
                    header, c.doc, k.name);
    write_table(page, *c.table, k.name, header, 0, "laws.md");
    own.push_back({"deck/" + file, std::move(page)});
  }
  pages.push_back({fmt::format("deck/{}.md", k.name), std::move(out)});
  pages.insert(pages.end(), own.begin(), own.end());
}

void add_page(std::vector<ReferencePage>& pages, const KeyInfo& k) {
  constexpr std::size_t many = 8;  // kinds that get pages of their own
  const KeyInfo* kinds = alternatives_of(*k.table);
  if (kinds && kinds->choices.size() >= many) return add_kinds(pages, k, *kinds);
  const std::string title = title_of(k);
  std::string out = fmt::format("# {}\n\n{}.\n\n", title, k.doc);
  write_table(out, *k.table, k.name, title, 0, "laws.md");
  pages.push_back({fmt::format("deck/{}.md", k.name), std::move(out)});
}

}  // namespace

std::string reference_markdown() {
  std::string out =
      fmt::format("# Deck reference\n\n{}{}## Top level\n\n", how_to_read, axes_and_signs);
  write_table(out, deck_keys(), "", "", 0, laws_below);
  out += "## Laws of time\n\n";
  write_laws(out, laws_below);
  return out;
}

std::vector<ReferencePage> reference_pages() {
  std::vector<ReferencePage> pages;
  for (const auto& k : deck_keys().keys)
    if (k.table) add_page(pages, k);
  std::string laws = "# Laws of time\n\n";
  write_laws(laws, "laws.md");
  pages.push_back({"deck/laws.md", std::move(laws)});
  std::string index =
      fmt::format("# Deck reference\n\n{}{}## Top level\n\n", how_to_read, axes_and_signs);
  write_keys(index, deck_keys().keys);
  index += "## Pages\n\n";
  for (const ReferencePage& p : pages)
    index += fmt::format("- [{}]({})\n", p.text.substr(2, p.text.find('\n') - 2), p.file);
  pages.insert(pages.begin(), {"deck.md", std::move(index)});
  return pages;
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
