#include <core/table.hpp>
#include <algorithm>

namespace whirl {
namespace {

std::string_view trim(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t'))
    s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t'))
    s.remove_suffix(1);
  return s;
}

int count_characters(std::string_view s) {
  return static_cast<int>(std::count_if(
      s.begin(), s.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

char find_separator(std::string_view header) {
  bool quoted = false;
  int bracket = 0;
  std::size_t semicolons = 0, tabs = 0;
  for (char c : header) {
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == '[' || c == '(') ++bracket;
    if (c == ']' || c == ')') --bracket;
    if (bracket > 0) continue;
    semicolons += c == ';';
    tabs += c == '\t';
  }
  return semicolons > 0 ? ';' : tabs > 0 ? '\t' : ',';
}

/// Cells of one line; false when a quote is not closed (its character position in `bad`).
bool split_line(std::string_view line, int number, char separator, std::vector<Cell>& out,
                int& bad) {
  std::size_t i = 0;
  for (;;) {
    std::size_t start = i;
    while (start < line.size() &&
           (line[start] == ' ' || (line[start] == '\t' && separator != '\t')))
      ++start;
    Cell cell;
    cell.line = number;
    cell.column = count_characters(line.substr(0, start)) + 1;
    if (start < line.size() && line[start] == '"') {
      cell.quoted = true;
      i = start + 1;
      for (;; ++i) {
        if (i >= line.size()) {
          bad = cell.column;
          return false;
        }
        if (line[i] != '"') {
          cell.text += line[i];
          continue;
        }
        if (i + 1 < line.size() && line[i + 1] == '"') {
          cell.text += '"';
          ++i;
          continue;
        }
        break;
      }
      ++i;
      cell.length = count_characters(line.substr(start, i - start));
      while (i < line.size() && line[i] != separator)
        cell.text +=
            line[i++];  // text after the closing quote is kept, to be rejected by its reader
      if (cell.text.find_last_not_of(" \t") != std::string::npos)
        cell.text.erase(cell.text.find_last_not_of(" \t") + 1);
    } else {
      i = std::min(line.find(separator, start), line.size());
      const std::string_view t = trim(line.substr(start, i - start));
      cell.text = t;
      cell.length = std::max(1, count_characters(t));
    }
    out.push_back(std::move(cell));
    if (i >= line.size()) return true;
    ++i;
  }
}

}  // namespace

CellTable read_cells(std::string_view text) {
  CellTable table;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  int number = 0;
  bool header = true;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t stop = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, stop - at);
    at = stop + 1;
    ++number;
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::string_view bare = trim(line);
    if (bare.empty() || bare.front() == '#') continue;
    if (header) table.separator = find_separator(line);
    std::vector<Cell> cells;
    int bad = 0;
    if (!split_line(line, number, table.separator, cells, bad)) {
      table.problem = "a quote is not closed";
      table.problem_line = number;
      table.problem_column = bad;
      return table;
    }
    if (header)
      table.header = std::move(cells);
    else
      table.rows.push_back(std::move(cells));
    header = false;
  }
  if (header) {
    table.problem = "the table is empty";
    table.problem_line = 0;
  }
  return table;
}

ColumnTitle split_title(std::string_view title) {
  ColumnTitle t;
  const std::size_t open = title.find_first_of("[(");
  if (open == std::string_view::npos || (title.back() != ']' && title.back() != ')')) {
    t.name = trim(title);
    return t;
  }
  t.name = trim(title.substr(0, open));
  t.unit = title.substr(open + 1, title.size() - open - 2);
  t.unit_offset = open + 1;
  t.has_unit = true;
  return t;
}

}  // namespace whirl
