#include <sweep/words.hpp>
#include <sweep/confidence.hpp>
#include <core/contract.hpp>
#include <core/types.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace whirl::sweep {

std::vector<WordShare> shares_of(const Plan& plan, const Columns& c, std::size_t response) {
  const std::vector<std::string>& words = c.words[response];
  WHIRL_EXPECTS(words.size() == c.weight.size());
  std::map<std::string, WordShare> found;
  double runs = 0, weights = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k].empty()) continue;
    WordShare& w = found[words[k]];
    w.word = words[k];
    ++w.runs;
    w.share += c.weight[k];
    ++runs;
    weights += c.weight[k];
  }
  const bool bounded = obstacle_to_bounds(plan).empty();
  const bool covered = covered_share(c.weight) == 1.0;
  std::vector<WordShare> out;
  for (auto& [word, w] : found) {
    w.share = weights > 0 && covered ? w.share / weights : nan;
    const Interval bounds =
        bounded ? bounds_of_share(static_cast<double>(w.runs), runs) : Interval{nan, nan};
    w.from = bounds.low;
    w.to = bounds.high;
    out.push_back(std::move(w));
  }
  std::stable_sort(out.begin(), out.end(),
                   [](const WordShare& a, const WordShare& b) { return a.runs > b.runs; });
  return out;
}

io::Table words_table(const Plan& plan, const Columns& c) {
  io::Table t;
  t.title = "Words";
  t.nan_means = "no bounds: see the last column";
  t.columns = {{"response", "-", ""},
               {"word", "-", ""},
               {"runs", "-", "that gave it"},
               {"share", "-", "of the runs that gave a word"},
               {"share from", "-", "bounds, 95 % confidence, after Wilson"},
               {"share to", "-", ""},
               {"missing bounds", "-", "why there are none"}};
  const std::string missing = obstacle_to_bounds(plan);
  for (std::size_t r = 0; r < plan.responses.size(); ++r) {
    if (c.words[r].empty()) continue;
    for (const WordShare& w : shares_of(plan, c, r))
      t.add({plan.responses[r].name, cell_of_word(w.word), static_cast<double>(w.runs), w.share,
             w.from, w.to, missing});
  }
  return t;
}

namespace {

/// Mean of a column of numbers over the runs of a word; nan: no number.
double mean_over(const std::vector<double>& column, const std::vector<std::string>& words,
                 const std::vector<double>& weight, const std::string& word) {
  double sum = 0, weights = 0;
  for (std::size_t k = 0; k < column.size(); ++k) {
    if (words[k] != word || std::isnan(column[k])) continue;
    sum += weight[k] * column[k];
    weights += weight[k];
  }
  return weights > 0 ? sum / weights : nan;
}

}  // namespace

io::Table keys_by_word(const Plan& plan, const Columns& c) {
  io::Table t;
  t.title = "Where the words are";
  t.nan_means = "the key is text";
  t.columns = {{"response", "-", ""},
               {"word", "-", ""},
               {"runs", "-", "that gave it"},
               {"varied", "-", ""},
               {"unit", "-", ""},
               {"mean", "-", "of what is varied, over the runs of the word"},
               {"mean of all", "-", "over the runs of any word"}};
  for (std::size_t r = 0; r < plan.responses.size(); ++r) {
    const std::vector<std::string>& words = c.words[r];
    if (words.empty()) continue;
    std::vector<std::string> any;  // all words as one
    any.reserve(words.size());
    for (const std::string& word : words)
      any.emplace_back(word.empty() ? "" : "any");
    for (const WordShare& w : shares_of(plan, c, r))
      for (std::size_t f = 0; f < c.factors.size(); ++f) {
        const Factor& factor = plan.design.factors()[f];
        t.add({plan.responses[r].name, cell_of_word(w.word), static_cast<double>(w.runs),
               factor.path, factor.unit.empty() ? "-" : factor.unit,
               mean_over(c.factors[f], words, c.weight, w.word),
               mean_over(c.factors[f], any, c.weight, "any")});
      }
  }
  return t;
}

plot::Figure word_figure(const Plan& plan, const Columns& c, std::size_t response) {
  constexpr std::size_t most_bars = 12;
  std::vector<WordShare> shares = shares_of(plan, c, response);
  plot::Figure figure;
  figure.name = fmt::format("words_{}", response + 1);
  figure.title = plan.responses[response].name;
  if (shares.empty()) return figure;
  if (shares.size() > most_bars)
    figure.caption = fmt::format("the {} most frequent of {} words", most_bars, shares.size());
  shares.resize(std::min(shares.size(), most_bars));
  plot::Axes axes;
  axes.x = plot::Axis("", "");
  axes.y = plot::Axis("share of the runs", "-");
  axes.y.include_zero = true;
  axes.legend = false;
  plot::Bars bars;
  plot::Series bounds;
  bounds.keep_all = true;
  bounds.style.color = 1;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double place = static_cast<double>(k);
    axes.x.ticks.push_back(place);
    axes.x.tick_labels.push_back(shares[k].word);
    bars.x.push_back(place);
    bars.height.push_back(shares[k].share);
    if (std::isnan(shares[k].from)) continue;
    bounds.x.insert(bounds.x.end(), {place, place, nan});
    bounds.y.insert(bounds.y.end(), {shares[k].from, shares[k].to, nan});
  }
  axes.x.min = -0.6;
  axes.x.max = static_cast<double>(shares.size()) - 0.4;
  axes.bars.push_back(std::move(bars));
  if (!bounds.x.empty()) {
    axes.series.push_back(std::move(bounds));
    figure.caption += figure.caption.empty() ? "" : "; ";
    figure.caption += "lines: bounds of the share, 95 % confidence";
  }
  figure.axes.push_back(std::move(axes));
  return figure;
}

}  // namespace whirl::sweep
