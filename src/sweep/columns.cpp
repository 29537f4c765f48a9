#include <sweep/columns.hpp>
#include <core/types.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>

namespace whirl::sweep {

double leading_number(const std::string& value) {
  double x = nan;
  const auto read = std::from_chars(value.data(), value.data() + value.size(), x);
  return read.ec == std::errc{} ? x : nan;
}

std::string cell_of_word(const std::string& word) {
  constexpr std::string_view begins_formulas = "=+-@\t\r";
  const bool formula =
      !word.empty() && begins_formulas.find(word.front()) != std::string_view::npos;
  return formula ? "'" + word : word;
}

namespace {

/// A number among words is one of them.
std::string word_of(const Answer& a) {
  if (!a.failure.empty()) return {};
  return a.word.empty() ? fmt::format("{}", a.value) : a.word;
}

std::vector<std::string> words_of(const std::map<std::int64_t, Row>& rows, std::size_t response) {
  const auto is_word = [response](const auto& row) {
    return !row.second.answers[response].word.empty();
  };
  std::vector<std::string> out;
  if (std::none_of(rows.begin(), rows.end(), is_word)) return out;
  for (const auto& [run, row] : rows)
    out.push_back(word_of(row.answers[response]));
  return out;
}

}  // namespace

Columns columns_of(const Plan& plan, const std::map<std::int64_t, Row>& rows) {
  Columns c;
  c.factors.resize(plan.design.factors().size());
  c.responses.resize(plan.responses.size());
  c.units.resize(plan.responses.size());
  for (const auto& [run, row] : rows) {
    const auto values = plan.design.values(run);
    c.weight.push_back(plan.design.weight(run));
    for (std::size_t k = 0; k < values.size(); ++k)
      c.factors[k].push_back(leading_number(values[k]));
    for (std::size_t k = 0; k < c.responses.size(); ++k) {
      c.responses[k].push_back(row.answers[k].failure.empty() ? row.answers[k].value : nan);
      if (c.units[k].empty()) c.units[k] = row.answers[k].unit;
    }
  }
  for (std::size_t k = 0; k < c.responses.size(); ++k) {
    c.words.push_back(words_of(rows, k));
    if (!c.words[k].empty()) c.responses[k].assign(c.responses[k].size(), nan);
  }
  return c;
}

std::vector<double> finite(const std::vector<double>& x) {
  std::vector<double> out;
  std::copy_if(x.begin(), x.end(), std::back_inserter(out),
               [](double v) { return !std::isnan(v); });
  return out;
}

std::pair<std::vector<double>, std::vector<double>> pairs_of(const std::vector<double>& x,
                                                             const std::vector<double>& y) {
  std::pair<std::vector<double>, std::vector<double>> out;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) continue;
    out.first.push_back(x[i]);
    out.second.push_back(y[i]);
  }
  return out;
}

}  // namespace whirl::sweep
