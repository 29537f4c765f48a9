#include <io/file.hpp>
#include <io/report.hpp>
#include <io/report/assets.hpp>
#include <plot/plots.hpp>
#include <plot/svg.hpp>
#include <core/parallel.hpp>
#include <core/text.hpp>
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

namespace whirl::io {
namespace {

std::string paragraphs(const std::string& text) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find("\n\n", at), text.size());
    if (end > at) out += "<p>" + escape(text.substr(at, end - at)) + "</p>\n";
    at = end + 2;
  }
  return out;
}

/// By the anchor of the figure; none where no table leads to one.
using FigureNumbers = std::map<std::string, int>;

double largest_in(const Table& t, std::size_t column) {
  double largest = 0;
  for (const auto& row : t.rows)
    if (!row[column].is_text && std::isfinite(row[column].number))
      largest = std::max(largest, std::abs(row[column].number));
  return largest;
}

struct ShownColumn {
  bool numeric = false;
  plot::DisplayUnit unit{1.0, ""};
  double zero_below = 0;  ///< what is smaller is rounding
  bool units = false;     ///< its cells are units
  bool is_long = false;   ///< a text in it takes a line of its own in a card
};

/// Largest number of a column and of those beside it in the same unit: lowest and highest, from and
/// to, components.
double largest_beside(const Table& t, std::size_t k) {
  const auto same = [&](std::size_t j) { return t.columns[j].unit == t.columns[k].unit; };
  double all = largest_in(t, k);
  for (std::size_t j = k; j-- > 0 && same(j);)
    all = std::max(all, largest_in(t, j));
  for (std::size_t j = k + 1; j < t.columns.size() && same(j); ++j)
    all = std::max(all, largest_in(t, j));
  return all;
}

/// Columns beside each other in the same unit share a prefix as long as that leaves each its digits.
/// Shares and ratios may be small and right; of what has a unit, a million millionth of the largest
/// is rounding, of forces and moments a millionth of those beside them nothing.
ShownColumn shown_as(const Table& t, std::size_t k) {
  ShownColumn out;
  out.numeric = !t.rows.empty() && !t.rows[0][k].is_text;  // set so when its first cell is a number
  out.units = t.columns[k].name == "unit";
  const std::string& unit = t.columns[k].unit;
  if (unit == "-" || unit.empty()) return out;
  const double own = largest_in(t, k), all = largest_beside(t, k);
  const bool load = unit == "N" || unit == "N.m" || unit == "N m";
  out.zero_below = unit == "%" ? 5e-5 : load ? 1e-6 * all : 1e-12 * all;
  out.unit.name = unit;
  const bool metric = unit == "m" || unit == "N" || unit == "N.m" || unit == "N m" ||
                      unit == "Pa" || unit == "J" || unit == "W";
  if (!metric) return out;
  const double largest = own > out.zero_below && own < 1e-2 * all ? own : all;
  out.unit = unit == "m" ? plot::length_unit(largest) : plot::unit_for(unit, largest);
  return out;
}

/// A unit as it is printed: "kg m2" is "kg·m²".
std::string printed_unit(std::string unit) {
  const auto replace = [&unit](std::string_view from, std::string_view to) {
    for (std::size_t at = unit.find(from); at != std::string::npos; at = unit.find(from, at))
      unit.replace(at, from.size(), to);
  };
  replace("^2", "²");
  replace("^3", "³");
  replace("m2", "m²");
  replace("m3", "m³");
  replace("N.", "N·");
  replace("N m", "N·m");
  replace("kg m", "kg·m");
  replace("g mm", "g·mm");
  if (unit.starts_with("um")) unit.replace(0, 1, "µ");
  return unit;
}

/// What stands for a number that is none.
constexpr const char* no_number = "–";

/// A class for its colour; a link to the figure that it names.
std::string cell_html(const Table::Cell& c, const ShownColumn& column,
                      const FigureNumbers& numbers) {
  using Mark = Table::Cell::Mark;
  const std::string kind = c.mark == Mark::passed   ? "passed"
                           : c.mark == Mark::failed ? "failed"
                           : column.numeric         ? "n"
                           : column.is_long         ? "long"
                                                    : "";
  std::string text = c.is_text              ? escape(column.units ? printed_unit(c.text) : c.text)
                     : std::isnan(c.number) ? no_number
                     : std::abs(c.number) < column.zero_below
                         ? "0"
                         : readable(column.unit.factor * c.number, 5);
  if (const auto n = numbers.find(safe_name(c.figure)); n != numbers.end())
    text = "<a href=\"#" + n->first + "\">Figure " + std::to_string(n->second) + "</a>";
  return (kind.empty() ? std::string("<td>") : "<td class=\"" + kind + "\">") + text + "</td>";
}

/// Below a table with numbers that are none.
std::string footnote(const Table& t) {
  const bool missing = std::any_of(t.rows.begin(), t.rows.end(), [](const auto& row) {
    return std::any_of(row.begin(), row.end(),
                       [](const Table::Cell& c) { return !c.is_text && std::isnan(c.number); });
  });
  if (!missing) return {};
  return std::string("<p class=\"note\">") + no_number + ": " +
         escape(t.nan_means.empty() ? "not found" : t.nan_means) + "</p>";
}

/// Characters of a text as it is seen, of one with markup or several bytes a letter too.
std::size_t letters_of(const std::string& html) {
  std::size_t n = 0;
  bool tag = false;
  for (const char c : html) {
    if (c == '<') tag = true;
    if (!tag && (static_cast<unsigned char>(c) & 0xC0) != 0x80) ++n;
    if (c == '>') tag = false;
  }
  return n;
}

std::size_t longest_word(const std::string& text) {
  std::size_t longest = 0;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find(' ', from), text.size());
    longest = std::max(longest, letters_of(text.substr(from, to - from)));
    from = to + 1;
  }
  return longest;
}

/// A table is no narrower, em of its letters: texts break between words, numbers nowhere.
double least_width(const Table& t, const std::vector<ShownColumn>& columns) {
  double width = 0;
  for (std::size_t k = 0; k < t.columns.size(); ++k) {
    std::size_t letters =
        std::max(longest_word(t.columns[k].name), letters_of(printed_unit(columns[k].unit.name)));
    for (const auto& row : t.rows)
      if (k < row.size()) {
        const std::string cell = cell_html(row[k], columns[k], {});
        letters = std::max(letters, columns[k].numeric ? letters_of(cell) : longest_word(cell));
      }
    width += 0.58 * static_cast<double>(letters) + 0.75;
  }
  return width;
}

/// Size of the letters that let a table so wide stand on a printed page 182 mm wide; empty: the
/// usual one.
std::string print_size(double width) {
  constexpr double page = 510, usual = 8, least = 3.5;  // pt
  if (width * usual <= page) return {};
  return "--print:" + readable(std::max(least, page / width), 2) + "pt;";
}

/// Has a telephone no room for a table so wide?
bool needs_cards(double width) {
  constexpr double room = 315, letters = 12;  // px
  return width * letters > room;
}

/// A text as a string of a style in an attribute.
std::string style_string(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return "'" + escape(out) + "'";
}

/// What stands before each value of a card: --n1 of the first column.
std::string card_names(const Table& t, const std::vector<ShownColumn>& columns) {
  std::string out;
  for (std::size_t k = 0; k < t.columns.size(); ++k) {
    const std::string unit = printed_unit(columns[k].unit.name);
    out += "--n" + std::to_string(k + 1) + ':' +
           style_string(t.columns[k].name + (unit.empty() ? "" : ", " + unit)) + ';';
  }
  return out;
}

/// Takes a text of a column a line of its own in a card?
bool has_long_text(const Table& t, std::size_t k, const ShownColumn& column,
                   const FigureNumbers& numbers) {
  constexpr std::size_t letters_of_a_third = 15;
  if (column.numeric) return false;
  return std::any_of(t.rows.begin(), t.rows.end(), [&](const auto& row) {
    return k < row.size() && letters_of(cell_html(row[k], column, numbers)) > letters_of_a_third;
  });
}

/// Of a wide table the columns that say something; those without a number in any row are in the
/// file alone.
Table without_empty_columns(const Table& t) {
  if (t.columns.size() <= 10 || t.rows.size() < 3) return t;
  Table out = t;
  for (std::size_t k = t.columns.size(); k-- > 0;) {
    const bool empty = std::all_of(t.rows.begin(), t.rows.end(), [k](const auto& row) {
      return k < row.size() && !row[k].is_text && std::isnan(row[k].number);
    });
    if (!empty) continue;
    const auto column = static_cast<std::ptrdiff_t>(k);
    out.columns.erase(out.columns.begin() + column);
    for (auto& row : out.rows)
      row.erase(row.begin() + column);
  }
  return out;
}

std::string table_html(const Table& whole, const FigureNumbers& numbers) {
  const Table t = without_empty_columns(whole);
  std::vector<ShownColumn> columns(t.columns.size());
  for (std::size_t k = 0; k < t.columns.size(); ++k)
    columns[k] = shown_as(t, k);
  const double width = least_width(t, columns);
  const bool cards = needs_cards(width);
  for (std::size_t k = 0; cards && k < t.columns.size(); ++k)
    columns[k].is_long = has_long_text(t, k, columns[k], numbers);
  const std::string style = print_size(width) + (cards ? card_names(t, columns) : "");
  std::string s = "<div class=\"scroll\"><table";
  if (cards) s += " class=\"cards\"";
  if (!style.empty()) s += " style=\"" + style + '"';
  s += '>';
  if (!t.title.empty()) s += "<caption>" + escape(t.title) + "</caption>";
  s += "<thead><tr>";
  for (std::size_t k = 0; k < t.columns.size(); ++k) {
    const auto& c = t.columns[k];
    s += columns[k].numeric ? "<th class=\"n\"" : "<th";
    if (!c.description.empty()) s += " title=\"" + escape(c.description) + '"';
    const std::string unit = printed_unit(columns[k].unit.name);
    s += ">" + escape(c.name) + (unit.empty() ? "" : "<small>" + escape(unit) + "</small>") +
         "</th>";
  }
  s += "</tr></thead>\n<tbody>";
  if (t.rows.empty())
    s += "<tr><td colspan=\"" + std::to_string(t.columns.size()) + "\">none</td></tr>\n";
  for (const auto& row : t.rows) {
    s += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      s += cell_html(row[k], columns[k], numbers);
    s += "</tr>\n";
  }
  return s + "</tbody></table></div>" + footnote(t) + "\n";
}

/// Six digits, as JSON has it.
std::string short_number(double x) {
  char b[32];
  std::snprintf(b, sizeof b, "%.6g", x);
  return b;
}

std::string value_html(const Value& v) {
  if (v.is_object()) {
    std::string s = "<table>";
    for (const auto& [k, x] : v.members())
      s += "<tr><td>" + escape(k) + "</td><td>" + value_html(x) + "</td></tr>";
    return s + "</table>";
  }
  if (v.is_array()) {
    std::string s;
    for (const auto& x : v.items())
      s += (s.empty() ? "" : x.is_object() ? "" : ", ") + value_html(x);
    return s;
  }
  if (v.is_text()) return escape(v.text());
  if (v.is_number()) return std::isnan(v.number()) ? no_number : readable(v.number(), 7);
  return v.is_null() ? "" : v.boolean() ? "yes" : "no";
}

/// The moments of a replay for the script: displacements as bytes, each moment on its own scale.
std::string replay_html(const plot::Replay& r, const std::string& id) {
  const std::size_t each = r.samples * r.points;
  std::string bytes, scales, times, speeds, rest;
  const auto add = [](std::string& to, double x) {
    to += (to.empty() ? "" : ",") + short_number(x);
  };
  for (std::size_t m = 0; m < r.time.size(); ++m) {
    float most = 0;
    for (std::size_t i = m * each; i < (m + 1) * each; ++i)
      most = std::max({most, std::abs(r.y[i]), std::abs(r.z[i])});
    const float scale = most > 0 ? most / 127 : 1.0F;
    for (std::size_t i = m * each; i < (m + 1) * each; ++i)
      for (const float x : {r.y[i], r.z[i]})
        bytes += static_cast<char>(static_cast<signed char>(std::lround(x / scale)));
    add(scales, static_cast<double>(scale));
    add(times, r.time[m]);
    add(speeds, to_rpm(r.speed[m]));
  }
  for (const Vec3& p : r.rest)
    for (const double x : p)
      add(rest, x);
  return "<script type=\"application/json\" class=\"replay\" data-for=\"" + id +
         "\">{\"samples\":" + std::to_string(r.samples) +
         ",\"points\":" + std::to_string(r.points) + ",\"shown\":" + std::to_string(r.shown) +
         ",\"gain\":" + short_number(r.gain) + ",\"rest\":[" + rest + "],\"t\":[" + times +
         "],\"rpm\":[" + speeds + "],\"scale\":[" + scales + "],\"bytes\":\"" + base64(bytes) +
         "\"}</script>\n";
}

bool turns(const plot::Figure& f) {
  return std::any_of(f.axes.begin(), f.axes.end(),
                     [](const plot::Axes& a) { return a.kind == plot::AxesKind::space; });
}

std::string figure_html(const plot::Figure& f, const std::string& id, const std::string& marks,
                        const FigureNumbers& numbers) {
  const auto number = numbers.find(id);
  const std::string title =
      (number == numbers.end() ? "" : "Figure " + std::to_string(number->second) + ". ") + f.title;
  std::string s = "<figure id=\"" + id + "\" style=\"width:" + number_text(f.width) +
                  "px\"><div class=\"bar\"><h3>" + escape(title) + "</h3><span class=\"hint\">";
  s += turns(f) ? "drag turns" : "click, then wheel zooms; drag pans; shift-drag: window";
  s += "</span><button data-do=\"reset\" title=\"back to the whole picture (double "
       "click)\">reset</button>"
       "<button data-do=\"save\" title=\"save this picture as it is now\">SVG</button></div>\n";
  // About a column a px, as in print: twice as many doubled the page.
  const plot::SvgPair drawn = plot::render_for_page(f, {false, id, marks, 0.85});
  s += drawn.wide + drawn.narrow;
  if (f.replay) s += replay_html(*f.replay, id);
  if (!f.caption.empty()) s += "<figcaption>" + escape(f.caption) + "</figcaption>";
  return s + "</figure>\n";
}

std::string anchor(std::size_t k) { return "s" + std::to_string(k + 1); }

using FigureIds = std::vector<std::vector<std::string>>;  ///< [section][figure]

/// Their names, made different where two steps draw the same plot.
FigureIds figure_ids(const Report& r) {
  FigureIds ids(r.sections.size());
  std::set<std::string> taken;
  for (std::size_t k = 0; k < r.sections.size(); ++k)
    for (const auto& f : r.sections[k].figures) {
      std::string id = safe_name(f.name);
      for (int n = 2; !taken.insert(id).second; ++n)
        id = safe_name(f.name) + "-" + std::to_string(n) + "-";
      ids[k].push_back(std::move(id));
    }
  return ids;
}

/// Where a table leads to figures all of them have numbers.
FigureNumbers figure_numbers(const Report& r, const FigureIds& ids) {
  const auto leads = [](const Table& t) {
    return std::any_of(t.rows.begin(), t.rows.end(), [](const auto& row) {
      return std::any_of(row.begin(), row.end(),
                         [](const Table::Cell& c) { return !c.figure.empty(); });
    });
  };
  FigureNumbers numbers;
  if (std::none_of(r.sections.begin(), r.sections.end(), [&](const ReportSection& s) {
        return std::any_of(s.tables.begin(), s.tables.end(), leads);
      }))
    return numbers;
  int n = 0;
  for (const auto& of_section : ids)
    for (const std::string& id : of_section)
      numbers[id] = ++n;
  return numbers;
}

/// Sections fold over their figures, and on a narrow screen (by the script) all of it folds.
std::string contents_html(const Report& r, const FigureIds& ids) {
  std::size_t figures = 0;
  for (const auto& of_section : ids)
    figures += of_section.size();
  constexpr std::size_t seen_at_once = 24;
  const std::string open = figures <= seen_at_once ? " open" : "";
  std::string s = "<nav aria-label=\"Contents\"><details open><summary>Contents</summary><ol>";
  for (std::size_t k = 0; k < r.sections.size(); ++k) {
    const std::string link =
        "<a href=\"#" + anchor(k) + "\">" + escape(r.sections[k].title) + "</a>";
    s += "<li>";
    if (ids[k].empty()) {
      s += link + "</li>";
      continue;
    }
    s += "<details";
    s += open;
    s += "><summary>" + link + "</summary>";
    for (std::size_t i = 0; i < ids[k].size(); ++i)
      s += "<span class=\"sub\"><a href=\"#" + ids[k][i] + "\">" +
           escape(r.sections[k].figures[i].title) + "</a></span>";
    s += "</details></li>";
  }
  return s + "</ol></details></nav>\n";
}

std::string facts_html(const Report& r) {
  if (r.facts.empty()) return {};
  std::string s = "<dl class=\"facts\">";
  for (const auto& [name, value] : r.facts)
    s += "<div><dt>" + escape(name) + "</dt><dd>" + escape(value) + "</dd></div>";
  return s + "</dl>\n";
}

std::string warnings_html(const Report& r) {
  if (r.warnings.empty()) return {};
  std::string s = "<div class=\"warnings\">";
  for (const auto& w : r.warnings)
    s += "<p>" + escape(w) + "</p>";
  return s + "</div>\n";
}

/// Name and text in two columns, as at the head of a drawing.
std::string title_block_html(const Report& r) {
  if (r.title_block.empty()) return {};
  std::string s = "<table class=\"title-block\">";
  for (const auto& [name, text] : r.title_block)
    s += "<tr><th>" + escape(name) + "</th><td>" + escape(text) + "</td></tr>";
  return s + "</table>\n";
}

/// Tables of earlier sections, as they are written, and links to these.
using PrintedTables = std::map<std::string, std::string>;

/// A table, or a link to the same one of an earlier section.
std::string table_once_html(const Table& t, const FigureNumbers& numbers,
                            const PrintedTables& printed) {
  std::string html = table_html(t, numbers);
  const auto same = printed.find(html);
  if (t.rows.empty() || t.title.empty() || same == printed.end()) return html;
  return "<p class=\"same\">" + escape(t.title) + ": as in " + same->second + "</p>\n";
}

std::string section_html(const ReportSection& x, const std::string& id,
                         const std::vector<std::string>& figures, const FigureNumbers& numbers,
                         PrintedTables& printed) {
  std::string s =
      "<section id=\"" + id + "\"><h2>" + escape(x.title) + "</h2>\n" + paragraphs(x.text);
  for (const auto& t : x.tables)
    s += table_once_html(t, numbers, printed);
  for (const auto& t : x.tables)
    printed.try_emplace(table_html(t, numbers),
                        "<a href=\"#" + id + "\">" + escape(x.title) + "</a>");
  if (!figures.empty()) {
    s += "<div class=\"figures\">";
    for (const std::string& figure : figures)
      s += figure;
    s += "</div>\n";
  }
  if (!x.files.empty()) {
    s += "<p class=\"files\">Files: ";
    for (std::size_t i = 0; i < x.files.size(); ++i)
      s += (i ? ", " : "") +
           ("<a href=\"" + escape(x.files[i].second) + "\">" + escape(x.files[i].first) + "</a>");
    s += "</p>\n";
  }
  return s + "</section>\n";
}

using DrawnFigures = std::vector<std::vector<std::string>>;  ///< [section][figure]

DrawnFigures draw_figures(const Report& r, const FigureIds& ids, const FigureNumbers& numbers,
                          int threads) {
  DrawnFigures drawn;
  std::vector<std::pair<std::size_t, std::size_t>> all;
  for (std::size_t k = 0; k < r.sections.size(); ++k) {
    const std::size_t count = r.sections[k].figures.size();
    drawn.emplace_back(count);
    for (std::size_t i = 0; i < count; ++i)
      all.emplace_back(k, i);
  }
  run_side_by_side(all.size(), threads, [&](std::size_t n) {
    const auto [k, i] = all[n];
    const std::string marks = anchor(k) + "f" + std::to_string(i);
    drawn[k][i] = figure_html(r.sections[k].figures[i], ids[k][i], marks, numbers);
  });
  return drawn;
}

/// As many rules as the widest table in cards has columns; the names themselves stand in the table.
std::string card_css(const Report& r) {
  std::size_t columns = 0;
  for (const ReportSection& x : r.sections)
    for (const Table& t : x.tables)
      columns = std::max(columns, t.columns.size());
  std::string s = "@media screen and (max-width: 600px) {\n";
  for (std::size_t k = 1; k <= columns; ++k) {
    s += fmt::format(".cards td:nth-child({0})::before {{ content: var(--n{0}); }}\n", k);
  }
  return s + "}\n";
}

}  // namespace

std::string render_report(const Report& r, int threads) {
  std::string s =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escape(r.title) + "</title>\n<style>\n";
  s += report_css;
  s += card_css(r);
  s += "</style>\n</head>\n<body>\n";
  const bool nav = r.sections.size() > 1;
  const FigureIds ids = figure_ids(r);
  const FigureNumbers numbers = figure_numbers(r, ids);
  s += nav ? "<div class=\"page with-nav\">\n" : "<div class=\"page\">\n";
  s += "<header><h1>" + escape(r.title) + "</h1>";
  if (!r.subtitle.empty()) s += "<p class=\"subtitle\">" + escape(r.subtitle) + "</p>";
  s += title_block_html(r) + "</header>\n";
  if (nav) s += contents_html(r, ids);
  s += "<main>\n" + facts_html(r) + warnings_html(r);
  const DrawnFigures drawn = draw_figures(r, ids, numbers, threads);
  PrintedTables printed;
  for (std::size_t k = 0; k < r.sections.size(); ++k)
    s += section_html(r.sections[k], anchor(k), drawn[k], numbers, printed);
  if (!r.summary.is_null())
    s += "<details><summary>Run summary</summary>" + value_html(r.summary) + "</details>\n";
  if (!r.deck.empty())
    s += "<details><summary>Deck, resolved</summary><pre>" + escape(r.deck) + "</pre></details>\n";
  s += "</main>\n</div>\n<script>\n";
  s += report_js;
  return s + "</script>\n</body>\n</html>\n";
}

void write_report(const std::filesystem::path& file, const Report& r, int threads) {
  write_atomic(file, render_report(r, threads));
}

}  // namespace whirl::io
