// What a sweep looks at: numbers and words out of the tables and the summary that a run writes.
#pragma once
#include <filesystem>
#include <map>
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
/// What "nan" means in the cells of a table, by the name of its file (io::Table::nan_means).
struct NanMeaning {
  std::string text;
  bool absence = false;  ///< the row has nothing to give
};
using NanMeanings = std::map<std::string, NanMeaning>;
/// Words are picked by row, numbers in any way. The least, the largest and the mean are those of all
/// rows: one that has no finite value is a failure, unless it has nothing to give (an empty cell, or
/// by what nan means).
Answer answer(const Response& r, const std::filesystem::path& results,
              const NanMeanings& meanings = {});

/// "TABLE:COLUMN [unit]" of every table in a results folder, of columns of words "TABLE:COLUMN
/// (words)", and the entries of the summary, for the user to choose from.
std::vector<std::string> list_responses(const std::filesystem::path& results);

}  // namespace whirl::sweep
