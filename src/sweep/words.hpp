// Responses that are words: how often each is, and for which values of what is varied.
#pragma once
#include <io/results.hpp>
#include <plot/plot.hpp>
#include <sweep/columns.hpp>

#include <optional>
#include <string>
#include <vector>

namespace whirl::sweep {

/// One word of a response.
struct WordShare {
  std::string word;
  std::size_t runs = 0;     ///< that gave it
  double share = 0;         ///< of the runs that gave a word; of weighted samples of their weights
  double from = 0, to = 0;  ///< bounds of the share, 95 % confidence; nan: see bounds_of_response()
};
/// The most frequent first, ties by the alphabet. @pre c.words[response] is not empty
std::vector<WordShare> shares_of(const Plan& plan, const Columns& c, std::size_t response);

/// A row a word of each response that is one. No rows: none is.
io::Table words_table(const Plan& plan, const Columns& c);
/// Means of the keys that are numbers over the runs of each word.
io::Table keys_by_word(const Plan& plan, const Columns& c);
/// Shares as bars.
plot::Figure word_figure(const Plan& plan, const Columns& c, std::size_t response);

}  // namespace whirl::sweep
