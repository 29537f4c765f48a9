// What a sweep looks at: numbers and words out of the tables and the summary that a run writes.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::sweep {

/// One number, or word, of a run.
struct Response {
  enum class Pick { row, last, least, largest, largest_magnitude, mean };
  std::string name;  ///< column of the sweep's table
  std::string
      table;  ///< file below the results folder, ".csv" left out; summary_table: summary.json
  std::string column;  ///< its heading, with or without the unit; of the summary a path of keys
  Pick pick = Pick::row;
  std::size_t row = 1;  ///< from 1
};

/// Reads "[NAME=]TABLE:COLUMN[:PICK]", PICK a row from 1 (default), last, min, max, absmax or mean;
/// "[NAME=]summary:KEY.KEY" of the summary.
/// @throws Error (E99, Exit::usage)
Response read_response(const std::string& text);

/// Its value in the results of a run.
struct Answer {
  double value;  ///< in `unit`; nan with a failure
  std::string unit;
  std::string failure;  ///< empty: none; else why there is no value
  std::string word{};   ///< in place of a value, which is then nan
};
/// The file of the results folder that a response is read from.
std::string file_of(const Response& r);
/// Words are picked by row, numbers in any way.
Answer answer(const Response& r, const std::filesystem::path& results);

/// "TABLE:COLUMN [unit]" of every table in a results folder, of columns of words "TABLE:COLUMN
/// (words)", and the entries of the summary, for the user to choose from.
std::vector<std::string> list_responses(const std::filesystem::path& results);

}  // namespace whirl::sweep
