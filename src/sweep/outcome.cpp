#include <sweep/outcome.hpp>
#include <sweep/columns.hpp>
#include <sweep/confidence.hpp>
#include <sweep/pictures.hpp>
#include <sweep/sensitivity.hpp>
#include <sweep/words.hpp>
#include <core/contract.hpp>
#include <core/types.hpp>
#include <io/report.hpp>
#include <io/results.hpp>
#include <io/words.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace whirl::sweep {
namespace {

using Rows = std::map<std::int64_t, Row>;

/// Ranks by weight: of what lies below, and half of what is equal.
std::vector<double> ranks_of(const std::vector<double>& x, const std::vector<double>& weights) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return x[a] < x[b]; });
  std::vector<double> rank(x.size());
  double below = 0;
  for (std::size_t i = 0; i < order.size();) {
    double same = 0;
    std::size_t j = i;
    for (; j < order.size() && x[order[j]] == x[order[i]]; ++j)
      same += weights[order[j]];
    for (std::size_t k = i; k < j; ++k)
      rank[order[k]] = below + 0.5 * same;
    below += same;
    i = j;
  }
  return rank;
}

io::Table sweep_table(const Plan& plan, const Rows& rows, const Columns& c) {
  io::Table t;
  t.title = "Runs";
  t.nan_means = "the run gave no value; the column beside it says why";
  t.columns.push_back({"run", "-", "from 0"});
  std::vector<bool> text;
  for (std::size_t k = 0; k < c.factors.size(); ++k) {
    const Factor& f = plan.design.factors()[k];
    text.push_back(std::any_of(c.factors[k].begin(), c.factors[k].end(),
                               [](double x) { return std::isnan(x); }));
    t.columns.push_back({f.path, text[k] || f.unit.empty() ? "-" : f.unit, "varied"});
  }
  const bool weighted = plan.design.weighted();
  if (weighted)
    t.columns.push_back({"weight", "-", "density of what is varied over that it was drawn from"});
  for (std::size_t k = 0; k < plan.responses.size(); ++k) {
    t.columns.push_back({plan.responses[k].name, c.units[k].empty() ? "-" : c.units[k],
                         plan.responses[k].table + ": " + plan.responses[k].column});
    t.columns.push_back({plan.responses[k].name + " failure", "-", "why there is no value"});
  }
  t.columns.push_back({"exit", "-", "exit code of the run; -1: its process ended by itself"});
  t.columns.push_back({"code", "-", "of its first error"});
  t.columns.push_back({"message", "-", "of its first error"});
  for (const auto& [run, row] : rows) {
    std::vector<io::Table::Cell> cells{static_cast<double>(run)};
    const auto values = plan.design.values(run);
    for (std::size_t k = 0; k < values.size(); ++k)
      if (text[k])
        cells.emplace_back(cell_of_word(values[k]));
      else
        cells.emplace_back(leading_number(values[k]));
    if (weighted) cells.emplace_back(c.weight[t.rows.size()]);
    for (std::size_t k = 0; k < row.answers.size(); ++k) {
      const Answer& a = row.answers[k];
      if (c.words[k].empty())
        cells.emplace_back(a.failure.empty() ? a.value : nan);
      else
        cells.emplace_back(cell_of_word(c.words[k][t.rows.size()]));
      cells.emplace_back(a.failure);
    }
    cells.emplace_back(row.exit);
    cells.emplace_back(row.code);
    cells.emplace_back(row.message);
    t.add(std::move(cells));
  }
  return t;
}

/// What weighted samples do not tell; empty: nothing.
std::string not_covered(double share) {
  if (share == 1.0) return "";
  return fmt::format(
      "; those drawn stand for {:.2g} of the distribution only: no means, no quantiles, no shares",
      share);
}

io::Table statistics_table(const Plan& plan, const Columns& c) {
  io::Table t;
  t.title = "Responses";
  t.nan_means =
      "no run gave a value, or its scheme has no samples of the distributions; of the error: the "
      "runs are no independent samples; of bounds, and of "
      "weighted "
      "samples: see the last column";
  t.columns = {{"response", "-", ""},
               {"unit", "-", ""},
               {"runs", "-",
                plan.design.weighted() ? "that gave a value; equivalent ones, after Kish: sum of "
                                         "weights squared over sum of squares"
                                       : "that gave a value"},
               {"failed", "-", "runs without a value"},
               {"mean", "-", "in the unit of the response, as all that follow"},
               {"error of the mean", "-", "standard error"},
               {"standard deviation", "-", ""},
               {"least", "-", ""},
               {"5 %", "-", "quantile"},
               {"median", "-", ""},
               {"95 %", "-", "quantile"},
               {"largest", "-", ""},
               {"5 % from", "-", "bounds of the quantile, 95 % confidence, by order statistics"},
               {"5 % to", "-", ""},
               {"median from", "-", ""},
               {"median to", "-", ""},
               {"95 % from", "-", ""},
               {"95 % to", "-", ""},
               {"missing bounds", "-", "why there are none, or not all"}};
  const double share = covered_share(c.weight);
  const bool covered = share == 1.0, independent = independent_runs(plan);
  for (std::size_t k = 0; k < plan.responses.size(); ++k) {
    if (!c.words[k].empty()) continue;
    const auto values = finite(c.responses[k]);
    const double failed = static_cast<double>(c.responses[k].size() - values.size());
    std::vector<io::Table::Cell> cells{plan.responses[k].name, c.units[k],
                                       static_cast<double>(values.size()), failed};
    if (plan.design.weighted() && !values.empty()) {
      const WeightedStatistics w = weighted_statistics(c.responses[k], c.weight);
      cells[2] = w.runs;
      for (double x : {w.mean, w.error, w.deviation, w.least, w.p05, w.median, w.p95, w.largest})
        cells.emplace_back(covered ? x : nan);
    } else if (values.empty()) {
      for (int i = 0; i < 8; ++i)
        cells.emplace_back(nan);
    } else {
      Statistics s = statistics_of(values);
      const double error =
          independent ? s.deviation / std::sqrt(static_cast<double>(s.count)) : nan;
      if (!follows_distributions(plan.design))
        s.mean = s.deviation = s.p05 = s.median = s.p95 = nan;
      for (double x : {s.mean, error, s.deviation, s.least, s.p05, s.median, s.p95, s.largest})
        cells.emplace_back(x);
    }
    const QuantileBounds bounds = bounds_of_response(plan, values);
    for (const auto& interval : {bounds.p05, bounds.median, bounds.p95}) {
      cells.emplace_back(interval ? interval->low : nan);
      cells.emplace_back(interval ? interval->high : nan);
    }
    cells.emplace_back(bounds.missing + not_covered(share));
    t.add(std::move(cells));
  }
  return t;
}

/// The same with the words: a row each, in columns of their own.
io::Table with_words(io::Table statistics, const io::Table& words, const Plan& plan,
                     const Columns& c) {
  if (words.rows.empty()) return statistics;
  const std::size_t numbers = statistics.columns.size();
  statistics.nan_means += "; of a word: it has no mean, a number no share";
  statistics.columns.push_back({"word", "-", "empty: numbers"});
  statistics.columns.push_back({"share", "-", "of the runs that gave a word"});
  statistics.columns.push_back({"share from", "-", "bounds, 95 % confidence, after Wilson"});
  statistics.columns.push_back({"share to", "-", ""});
  for (auto& row : statistics.rows) {
    row.emplace_back("");
    row.insert(row.end(), 3, nan);
  }
  for (const auto& word : words.rows) {
    const auto response =
        std::find_if(plan.responses.begin(), plan.responses.end(),
                     [&word](const Response& r) { return r.name == word[0].text; });
    const std::vector<std::string>& all =
        c.words[static_cast<std::size_t>(response - plan.responses.begin())];
    const auto failed = std::count(all.begin(), all.end(), std::string());
    std::vector<io::Table::Cell> cells{word[0], "-", word[2], static_cast<double>(failed)};
    cells.resize(numbers - 1, nan);
    cells.insert(cells.end(), {word[6], word[1], word[3], word[4], word[5]});
    statistics.add(std::move(cells));
  }
  return statistics;
}

/// Some columns of it.
io::Table part_of(const io::Table& table, std::string title,
                  const std::vector<std::size_t>& columns) {
  io::Table part;
  part.title = std::move(title);
  part.nan_means = table.nan_means;
  for (const std::size_t k : columns)
    part.columns.push_back(table.columns[k]);
  for (const auto& row : table.rows) {
    std::vector<io::Table::Cell> cells;
    cells.reserve(columns.size());
    for (const std::size_t k : columns)
      cells.push_back(row[k]);
    part.add(std::move(cells));
  }
  return part;
}

/// On a page the bounds stand in a table of their own.
void add_statistics(const io::Table& statistics, std::vector<io::Table>& tables) {
  tables.push_back(part_of(statistics, statistics.title, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  tables.push_back(part_of(statistics, "Percentiles and their bounds, 95 % confidence",
                           {0, 1, 8, 12, 13, 9, 14, 15, 10, 16, 17, 18}));
}

/// "y > 40"
std::string name_of(const Plan& plan, const Limit& limit) {
  return fmt::format("{} {} {:.6g}", plan.responses[limit.response].name, limit.above ? ">" : "<",
                     limit.value);
}

Probability probability_of(const Columns& c, const Limit& limit) {
  return probability_beyond(c.responses[limit.response], c.weight, limit.value, limit.above);
}

/// What weighted samples leave open of a probability; empty: nothing.
std::string open_text(const Probability& p) {
  if (p.covered == 1.0) return "";
  const std::string share =
      fmt::format("those drawn stand for {:.2g} of the distribution only", p.covered);
  return share + (p.known ? ": the rest is taken to lie on the other side, as the heaviest runs do"
                          : ", and the rest may lie on either side");
}

/// "195 of 400 runs gave no 'on': ..": what a probability does not cover.
std::string uncovered_text(const Plan& plan, const Columns& c) {
  std::string text;
  for (const Limit& limit : plan.limits) {
    const Probability p = probability_of(c, limit);
    if (p.without > 0)
      text += fmt::format(
          "{} of {} runs gave no '{}': the probability of {} is that of the others; of all it is "
          "from {:.4g} to {:.4g}\n",
          p.without, c.weight.size(), plan.responses[limit.response].name, name_of(plan, limit),
          p.least, p.most);
    if (p.covered < 1.0)
      text += fmt::format("the probability of {} lies between {:.4g} and {:.4g}: {}\n",
                          name_of(plan, limit), p.least, p.most, open_text(p));
  }
  return text;
}

/// How probable it is to lie beyond the limits asked for.
io::Table probabilities_table(const Plan& plan, const Columns& c) {
  io::Table t;
  t.title = "Probabilities";
  t.nan_means =
      "no run gave a value, or see the last column; an error: none or all of weighted samples lie "
      "there, or the runs are no independent samples";
  const bool independent = independent_runs(plan);
  t.columns = {{"response", "-", ""},
               {"unit", "-", ""},
               {"beyond", "-", ""},
               {"probability", "-", "of the runs that gave a value"},
               {"error", "-", "standard error; of none or all, what they leave open at 95 %"},
               {"runs", "-", "that lie there"},
               {"runs without a value", "-", ""},
               {"at least", "-", "of all runs: none of those without a value lies there"},
               {"at most", "-",
                "of all runs: all of those without a value lie there, and what weighted samples do "
                "not stand for"},
               {"open", "-", "what weighted samples do not tell"}};
  for (const Limit& limit : plan.limits) {
    const Probability p = probability_of(c, limit);
    t.add({plan.responses[limit.response].name, c.units[limit.response],
           fmt::format("{} {:.6g}", limit.above ? ">" : "<", limit.value), p.value,
           independent ? p.error : nan, static_cast<double>(p.runs), static_cast<double>(p.without),
           p.least, p.most, open_text(p)});
  }
  return t;
}

/// What the scheme of sensitivity found; no columns without one.
io::Table sensitivity_table(const Plan& plan, const Columns& c) {
  const Sampling scheme = plan.design.sampling();
  const std::size_t keys = plan.design.factors().size();
  io::Table t;
  t.title = "Sensitivity";
  t.nan_means = "no run gave a value";
  if (scheme == Sampling::saltelli)
    t.columns = {{"response", "-", ""},
                 {"varied", "-", ""},
                 {"first index", "-", "share of the variance due to the key alone"},
                 {"error of the first", "-", "standard error, bootstrap"},
                 {"total index", "-", "share due to the key and all it interacts with"},
                 {"error of the total", "-", "standard error, bootstrap"},
                 {"points", "-", "of which all runs gave a value"}};
  else if (scheme == Sampling::morris)
    t.columns = {{"response", "-", ""},
                 {"varied", "-", ""},
                 {"mean effect", "-", "mu, in the unit of the response a range of the key"},
                 {"mean size of effects", "-", "mu*"},
                 {"deviation of effects", "-",
                  "sigma: not zero where the effect is not linear, or "
                  "depends on other keys"},
                 {"paths", "-", "that gave an effect"}};
  else if (scheme == Sampling::one_at_a_time)
    t.columns = {{"response", "-", ""},
                 {"varied", "-", ""},
                 {"at the medians", "-", "in the unit of the response, as all that follow"},
                 {"at 5 %", "-", "of this key, the others at their medians"},
                 {"at 95 %", "-", ""},
                 {"swing", "-", "from 5 % to 95 %"}};
  for (std::size_t r = 0; r < plan.responses.size() && !t.columns.empty(); ++r) {
    std::size_t used = 0;
    const auto& y = c.responses[r];
    const auto sobol =
        scheme == Sampling::saltelli ? sobol_indices(y, keys, used) : std::vector<SobolIndex>();
    const auto morris = scheme == Sampling::morris ? morris_effects(y, keys, plan.design.seed())
                                                   : std::vector<MorrisEffect>();
    for (std::size_t k = 0; k < keys; ++k) {
      std::vector<io::Table::Cell> cells{plan.responses[r].name, plan.design.factors()[k].path};
      std::vector<double> numbers;
      if (scheme == Sampling::saltelli) {
        const SobolIndex i = sobol.empty() ? SobolIndex{nan, nan, nan, nan} : sobol[k];
        numbers = {i.first, i.first_error, i.total, i.total_error, static_cast<double>(used)};
      } else if (scheme == Sampling::morris) {
        numbers = {morris[k].mean, morris[k].magnitude, morris[k].deviation,
                   static_cast<double>(morris[k].paths)};
      } else {
        const double low = y[2 * k + 1], high = y[2 * k + 2];
        numbers = {y[0], low, high, high - low};
      }
      for (const double x : numbers)
        cells.emplace_back(x);
      t.add(std::move(cells));
    }
  }
  return t;
}

io::Table effects_table(const Plan& plan, const Columns& c) {
  io::Table t;
  t.title = "What the responses depend on";
  const double share = covered_share(c.weight);
  t.nan_means = "one of the two does not vary, or is text";
  if (share < 1.0)
    t.nan_means = fmt::format(
        "weighted samples: those drawn stand for {:.2g} of the distribution only", share);
  t.columns = {{"response", "-", ""},
               {"varied", "-", ""},
               {"rank correlation", "-",
                "after Spearman, by the weights of the runs: 1 or -1 where one grows or falls with "
                "the other throughout"}};
  for (std::size_t r = 0; r < plan.responses.size(); ++r) {
    if (!c.words[r].empty()) continue;
    for (std::size_t f = 0; f < c.factors.size(); ++f)
      t.add({plan.responses[r].name, plan.design.factors()[f].path,
             rank_correlation(c, c.factors[f], c.responses[r])});
  }
  return t;
}

/// The worst runs, with their reports.
io::ReportSection worst_section(const Plan& plan, const Rows& rows) {
  io::ReportSection section;
  section.title = "Worst runs";
  for (const std::int64_t run : worst_runs(plan, rows)) {
    std::string text = fmt::format("run {}", run);
    for (std::size_t r = 0; r < plan.responses.size(); ++r)
      if (const Answer& a = rows.at(run).answers[r]; !a.word.empty())
        text += fmt::format(", {} {}", plan.responses[r].name, a.word);
      else if (a.failure.empty())
        text +=
            fmt::format(", {} {:.6g}{}{}", plan.responses[r].name, a.value,
                        a.unit.empty() || a.unit == "-" ? "" : " ", a.unit == "-" ? "" : a.unit);
    section.files.emplace_back(std::move(text), worst_folder(run) + "/report.html");
  }
  return section;
}

io::Report report_of(const Plan& plan, const Rows& rows, const Columns& c,
                     std::vector<io::Table> tables, const io::Value& summary) {
  io::Report report;
  report.title = "Sweep";
  report.facts = {{"runs", std::to_string(plan.design.runs())}};
  report.summary = summary;
  io::ReportSection section;
  section.title = "Responses";
  section.tables = std::move(tables);
  section.files = {{"all runs", "sweep.csv"}};
  section.figures = pictures_of(plan, c);
  report.sections.push_back(std::move(section));
  if (io::ReportSection worst = worst_section(plan, rows); !worst.files.empty())
    report.sections.push_back(std::move(worst));
  return report;
}

void print_words(const io::Table& words) {
  for (const auto& row : words.rows)
    std::printf("%-32s %7.0f runs %5.1f %%  %s\n", row[0].text.c_str(), row[2].number,
                100 * row[3].number, row[1].text.c_str());
}

void print_statistics(const io::Table& t) {
  if (t.rows.empty()) return;
  std::printf("%-32s %8s %7s %7s %12s %12s %12s %12s\n", "response", "unit", "runs", "failed",
              "5 %", "median", "95 %", "largest");
  for (const auto& row : t.rows)
    std::printf("%-32s %8s %7.0f %7.0f %12.6g %12.6g %12.6g %12.6g\n", row[0].text.c_str(),
                row[1].text.c_str(), row[2].number, row[3].number, row[8].number, row[9].number,
                row[10].number, row[11].number);
}

}  // namespace

Statistics statistics_of(std::vector<double> values) {
  WHIRL_EXPECTS(!values.empty());
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const auto quantile = [&](double p) {
    const double place = p * (n - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - std::floor(place)) * (values[above] - values[below]);
  };
  Statistics s;
  s.count = values.size();
  s.least = values.front();
  s.largest = values.back();
  for (double x : values)
    s.mean += x / n;
  double squares = 0;
  for (double x : values)
    squares += (x - s.mean) * (x - s.mean);
  s.deviation = values.size() > 1 ? std::sqrt(squares / (n - 1)) : 0.0;
  s.p05 = quantile(0.05);
  s.median = quantile(0.5);
  s.p95 = quantile(0.95);
  return s;
}

WeightedStatistics weighted_statistics(const std::vector<double>& values,
                                       const std::vector<double>& weights) {
  WHIRL_EXPECTS(values.size() == weights.size());
  std::vector<std::pair<double, double>> known;
  double sum = 0, squares = 0;
  WeightedStatistics s;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k]) || weights[k] == 0.0) continue;
    known.emplace_back(values[k], weights[k]);
    sum += weights[k];
    squares += weights[k] * weights[k];
    s.mean += weights[k] * values[k];
  }
  if (!(sum > 0)) return {0, nan, nan, nan, nan, nan, nan, nan, nan};
  std::sort(known.begin(), known.end());
  s.mean /= sum;
  s.runs = sum * sum / squares;
  double spread = 0, error = 0;
  for (const auto& [x, w] : known) {
    spread += w * (x - s.mean) * (x - s.mean);
    error += w * w * (x - s.mean) * (x - s.mean);
  }
  s.deviation = std::sqrt(spread / sum);
  s.error = std::sqrt(error) / sum;
  s.least = known.front().first;
  s.largest = known.back().first;
  const auto quantile = [&](double p) {
    double below = 0;
    for (const auto& [x, w] : known)
      if ((below += w) >= p * sum) return x;
    return known.back().first;
  };
  s.p05 = quantile(0.05);
  s.median = quantile(0.5);
  s.p95 = quantile(0.95);
  return s;
}

namespace {

/// Runs that gave a value, and what those beyond a limit weigh among them.
struct Split {
  double runs = 0, known = 0, unknown = 0, beyond = 0, squares_beyond = 0, squares = 0;
  std::size_t hits = 0;
};

bool lies_beyond(double x, double limit, bool above) { return above ? x > limit : x < limit; }

Split split_at(const std::vector<double>& values, const std::vector<double>& weights, double limit,
               bool above) {
  Split s;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double w = weights[k];
    (std::isnan(values[k]) ? s.unknown : s.known) += w;
    if (std::isnan(values[k])) continue;
    ++s.runs;
    s.squares += w * w;
    if (w == 0.0 || !lies_beyond(values[k], limit, above)) continue;
    ++s.hits;
    s.beyond += w;
    s.squares_beyond += w * w;
  }
  return s;
}

/// Whether the runs beyond a limit are lighter than the others by more than chance: then what the
/// samples do not reach, to which the heaviest are nearest, is taken to lie on the other side.
bool lie_apart(const std::vector<double>& values, const std::vector<double>& weights, double limit,
               bool above, const Split& s) {
  double heaviest = 0, heavier = 0;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (lies_beyond(values[k], limit, above)) heaviest = std::max(heaviest, weights[k]);
  for (std::size_t k = 0; k < values.size(); ++k)
    heavier += !std::isnan(values[k]) && weights[k] > heaviest;
  // that none of the heavier ones lies there, if it were the same for all weights
  constexpr double chance = 1e-3;
  return s.hits > 0 && std::pow(1.0 - static_cast<double>(s.hits) / s.runs, heavier) < chance;
}

/// Of the mean over the runs: of all weights, or self-normalised.
double error_of_mean(const Split& s, double p, bool self_normalised, double all) {
  if (self_normalised) {
    const double spread = s.squares_beyond * (1 - 2 * p) + p * p * s.squares;
    return s.runs > 1 ? std::sqrt(std::max(0.0, spread) * s.runs / (s.runs - 1)) / s.known : nan;
  }
  const double mean = s.beyond / all;
  return std::sqrt(std::max(0.0, s.squares_beyond / all - mean * mean) / (all - 1)) /
         (1.0 - s.unknown / all);
}

}  // namespace

Probability probability_beyond(const std::vector<double>& values,
                               const std::vector<double>& weights, double limit, bool above) {
  WHIRL_EXPECTS(values.size() == weights.size());
  const Split s = split_at(values, weights, limit, above);
  const double runs = static_cast<double>(values.size()), all = s.known + s.unknown;
  const bool weighted =
      std::any_of(weights.begin(), weights.end(), [](double w) { return w != 1.0; });
  Probability p;
  p.runs = s.hits;
  p.without = values.size() - static_cast<std::size_t>(s.runs);
  p.covered = covered_share(weights);
  // The mean weight is 1. Where the heaviest runs count, self-normalising makes up for how often
  // they came; where they do not, it would spoil what is known of the others.
  const bool apart =
      weighted && s.beyond + s.unknown <= runs && lie_apart(values, weights, limit, above, s);
  const double base = apart || p.covered < 1.0 ? runs : all;
  p.least = std::min(p.covered, s.beyond / base);
  p.most = std::min(1.0, p.least + s.unknown / base + (1.0 - p.covered));
  p.known = s.runs > 0 && s.known > 0 && (apart || p.covered == 1.0);
  p.value = p.known ? s.beyond / (apart ? runs - s.unknown : s.known) : nan;
  // Of none or all of n runs nothing spreads: the probability that leaves this outcome one chance in
  // twenty (for weighted samples there is none).
  constexpr double chance = 0.05;
  const bool one_side = s.hits == 0 || static_cast<double>(s.hits) == s.runs;
  if (!p.known || (weighted && one_side))
    p.error = nan;
  else
    p.error =
        one_side ? 1.0 - std::pow(chance, 1.0 / s.runs) : error_of_mean(s, p.value, !apart, runs);
  return p;
}

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y,
                        const std::vector<double>& weights) {
  WHIRL_EXPECTS(x.size() == y.size() && x.size() == weights.size());
  const auto a = ranks_of(x, weights), b = ranks_of(y, weights);
  const double mean = 0.5 * std::accumulate(weights.begin(), weights.end(), 0.0);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += weights[i] * (a[i] - mean) * (b[i] - mean);
    aa += weights[i] * (a[i] - mean) * (a[i] - mean);
    bb += weights[i] * (b[i] - mean) * (b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : nan;
}

double rank_correlation(const Columns& c, const std::vector<double>& x,
                        const std::vector<double>& y) {
  WHIRL_EXPECTS(x.size() == y.size() && x.size() == c.weight.size());
  if (covered_share(c.weight) < 1.0) return nan;
  auto [a, b] = pairs_of(x, y);
  std::vector<double> weights;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!std::isnan(x[i]) && !std::isnan(y[i])) weights.push_back(c.weight[i]);
  return rank_correlation(a, b, weights);
}

namespace {

bool has_text(const io::Table& table, std::size_t column) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [column](const auto& row) { return row[column].is_text; });
}

void write_numbers(const std::filesystem::path& file, const io::Table& table) {
  std::vector<std::size_t> numbers;
  std::vector<io::Channel> channels;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (has_text(table, k)) continue;
    numbers.push_back(k);
    const io::Table::Column& c = table.columns[k];
    channels.push_back({c.name, c.unit, c.description, {}, 1.0, "runs"});
  }
  const io::TimeSeriesPtr out = io::make_hdf5_series(file);
  out->begin(channels);
  std::vector<double> values(numbers.size());
  for (const auto& row : table.rows) {
    for (std::size_t k = 0; k < numbers.size(); ++k)
      values[k] = row[numbers[k]].number;
    out->append(values);
  }
  out->close();
}

/// Numbers as rows and columns, what is text as lists of words.
void write_hdf5(const std::filesystem::path& file, const io::Table& table) {
  write_numbers(file, table);
  std::vector<io::WordColumn> words;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (!has_text(table, k)) continue;
    io::WordColumn column{table.columns[k].name, table.columns[k].description, {}};
    for (const auto& row : table.rows)
      column.cells.push_back(row[k].text);
    words.push_back(std::move(column));
  }
  io::add_words_hdf5(file, words);
}

}  // namespace

void write_outcome(const Plan& plan, const Rows& rows, const SweepOptions& options) {
  const Columns c = columns_of(plan, rows);
  io::ResultsFolder folder(plan.root);
  const io::Table statistics = statistics_table(plan, c), effects = effects_table(plan, c);
  const io::Table words = words_table(plan, c);
  const io::Table runs = sweep_table(plan, rows, c);
  folder.write_table("sweep.csv", runs);
  if (options.hdf5) write_hdf5(folder.path("sweep.h5"), runs);
  folder.write_table("statistics.csv", with_words(statistics, words, plan, c));
  folder.write_table("effects.csv", effects);
  std::vector<io::Table> tables;
  if (!words.rows.empty()) {
    tables = {words, keys_by_word(plan, c)};
    folder.write_table("words.csv", tables.back());
  }
  if (!statistics.rows.empty()) add_statistics(statistics, tables);
  if (!plan.limits.empty()) {
    if (!options.run.quiet) std::fputs(uncovered_text(plan, c).c_str(), stderr);
    tables.push_back(probabilities_table(plan, c));
    folder.write_table("probabilities.csv", tables.back());
  }
  if (io::Table sensitivity = sensitivity_table(plan, c); !sensitivity.columns.empty()) {
    tables.push_back(std::move(sensitivity));
    folder.write_table("sensitivity.csv", tables.back());
  }
  if (!effects.rows.empty()) tables.push_back(effects);
  io::Value summary = io::Value::object();
  summary["runs"] = plan.design.runs();
  summary["failed"] =
      std::count_if(rows.begin(), rows.end(), [](const auto& r) { return r.second.exit != 0; });
  for (const auto& row : statistics.rows) {
    io::Value& v = summary["responses"][row[0].text];
    for (std::size_t k = 1; k < row.size(); ++k) {
      const std::string& name = statistics.columns[k].name;
      if (row[k].is_text)
        v[name] = row[k].text;
      else
        v[name] = row[k].number;
    }
  }
  for (const auto& row : words.rows) {
    io::Value& v = summary["responses"][row[0].text][row[1].text];
    v["runs"] = row[2].number;
    v["share"] = row[3].number;
    v["share from"] = row[4].number;
    v["share to"] = row[5].number;
  }
  folder.write_json("summary.json", summary);
  io::write_report(folder.path("sweep.html"), report_of(plan, rows, c, tables, summary));
  if (options.run.json)
    std::fputs(io::to_json(summary).c_str(), stdout);
  else if (!options.run.quiet)
    print_statistics(statistics);
  if (const double share = covered_share(c.weight); share < 1.0 && !options.run.quiet)
    std::fputs(fmt::format("weighted samples{}\n", not_covered(share)).c_str(), stderr);
  if (!options.run.json && !options.run.quiet) print_words(words);
}

}  // namespace whirl::sweep
