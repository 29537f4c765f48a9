// What a sweep looks at: numbers out of the tables that a run writes.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::sweep {

/// One number of a run.
struct Response {
  enum class Pick { row, last, least, largest, largest_magnitude, mean };
  std::string name;    ///< column of the sweep's table
  std::string table;   ///< file below the results folder, ".csv" left out
  std::string column;  ///< its heading, with or without the unit
  Pick pick = Pick::row;
  std::size_t row = 1;  ///< from 1
};

/// Reads "[NAME=]TABLE:COLUMN[:PICK]", PICK a row from 1 (default), last, min, max, absmax or mean.
/// @throws Error (E99, Exit::usage)
Response read_response(const std::string& text);

/// Its value in the results of a run.
struct Answer {
  double value;  ///< in `unit`; nan with a failure
  std::string unit;
  std::string failure;  ///< empty: none; else why there is no value
};
Answer answer(const Response& r, const std::filesystem::path& results);

/// "TABLE:COLUMN [unit]" of every table in a results folder, for the user to choose from.
std::vector<std::string> list_responses(const std::filesystem::path& results);

}  // namespace whirl::sweep
