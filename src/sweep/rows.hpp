// Rows of a sweep as they are finished: append-only files of one line a run, each with a checksum,
// so that a killed sweep loses what was running and nothing else.
#pragma once
#include <sweep/response.hpp>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace whirl::sweep {

/// What one run gave.
struct Row {
  std::int64_t run = 0;
  int exit = 0;         ///< as the program's (core/error.hpp); -1: the process ended by itself
  std::string code;     ///< of its first error; empty: none
  std::string message;  ///< of the same
  double cpu = 0;       ///< s
  std::vector<Answer> answers;
};

/// One line, checksum at its end; the same row gives the same line.
std::string line_of(const Row& row);
/// Nothing when the checksum does not fit: a line that was not written to its end.
std::optional<Row> row_of(std::string_view line);

/// The whole lines of a file of rows, by their runs, and how many bytes they take; none when there
/// is no file.
struct RowsRead {
  std::map<std::int64_t, Row> rows;
  std::uint64_t bytes = 0;
};
RowsRead read_rows(const std::filesystem::path& file);

}  // namespace whirl::sweep
