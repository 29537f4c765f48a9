// The summary of a run, flat: what stands in no table can be a response too.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace whirl::sweep {

/// Name of the table that the summary counts as.
inline constexpr const char* summary_table = "summary";

/// A number, or a word: text, true or false.
struct SummaryEntry {
  std::string path;  ///< keys on the way, "steps.run_up.outcome"; items of lists by number from 1
  std::string unit;  ///< behind the last key, "t_end [s]"; it is no part of the path
  double number = 0;
  std::string word;  ///< empty: a number
};

/// In the order of the file, without what is an empty text.
/// @throws Error (Exit::io) when the file cannot be read or is not JSON.
std::vector<SummaryEntry> read_summary(const std::filesystem::path& file);

}  // namespace whirl::sweep
