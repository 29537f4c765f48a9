// A finished sweep as columns of numbers and words.
#pragma once
#include <sweep/plan.hpp>

namespace whirl::sweep {

struct Columns {
  std::vector<std::vector<double>> factors;    ///< nan: text
  std::vector<std::vector<double>> responses;  ///< nan: failed, or a word
  /// Of the responses that some run gives a word: empty, failed; all numbers: no entries.
  std::vector<std::vector<std::string>> words;
  std::vector<std::string> units;  ///< of the responses
  std::vector<double> weight;      ///< of the runs
};
/// rows: one for every run.
Columns columns_of(const Plan& plan, const std::map<std::int64_t, Row>& rows);

/// A word as a cell: where a spreadsheet would take it for a formula, behind an apostrophe.
std::string cell_of_word(const std::string& word);
/// The number at the head of a value, nan for text.
double leading_number(const std::string& value);
/// What is no nan.
std::vector<double> finite(const std::vector<double>& x);
/// Values of runs in which both are numbers.
std::pair<std::vector<double>, std::vector<double>> pairs_of(const std::vector<double>& x,
                                                             const std::vector<double>& y);

}  // namespace whirl::sweep
