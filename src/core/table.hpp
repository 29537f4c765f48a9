// Text tables (CSV): cells with their place in the file. Separators: comma, semicolon or tab, found
// from the header. '#' starts a comment line; cells may be quoted ("" inside quotes is a quote); LF
// and CRLF; a byte-order mark is skipped.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace whirl {

struct Cell {
  std::string text;  ///< without surrounding blanks and quotes
  int line = 0;      ///< from 1
  int column = 0;    ///< from 1, in characters
  int length = 0;    ///< characters the cell takes in the line
  bool quoted = false;
};

struct CellTable {
  std::vector<Cell> header;
  std::vector<std::vector<Cell>> rows;
  char separator = ',';
  /// Set when the text is no table: message and place.
  std::string problem;
  int problem_line = 0, problem_column = 0;
};

CellTable read_cells(std::string_view text);

/// A column title "length[mm]", "length [mm]" or "length (mm)" split into name and unit; offset of
/// the unit in bytes.
struct ColumnTitle {
  std::string name, unit;
  bool has_unit = false;
  std::size_t unit_offset = 0;
};
ColumnTitle split_title(std::string_view title);

}  // namespace whirl
