// A CSV file of results with its text: what io::read_csv() leaves out.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::io {

/// A series or table as it stands in its file, column by column.
struct TableFile {
  struct Column {
    std::string name, unit;
    std::vector<double> numbers;       ///< text cells: NaN
    std::vector<std::string> texts{};  ///< every cell as written, of columns with text; else empty
  };
  std::vector<Column> columns;
  std::size_t rows() const { return columns.empty() ? 0 : columns.front().numbers.size(); }
};

/// Reads a CSV series or table; an unfinished last line (killed run) is left out.
/// @throws Error (Exit::io) when it cannot be read or has no header.
TableFile read_table(const std::filesystem::path& file);

}  // namespace whirl::io
