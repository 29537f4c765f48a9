#include <sweep/outcome.hpp>
#include <core/contract.hpp>
#include <core/types.hpp>
#include <io/report.hpp>
#include <io/results.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace whirl::sweep {
namespace {

using Rows = std::map<std::int64_t, Row>;

/// Mean ranks, from 1.
std::vector<double> ranks_of(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return x[a] < x[b]; });
  std::vector<double> rank(x.size());
  for (std::size_t i = 0; i < order.size();) {
    std::size_t j = i;
    while (j < order.size() && x[order[j]] == x[order[i]])
      ++j;
    for (std::size_t k = i; k < j; ++k)
      rank[order[k]] = 0.5 * static_cast<double>(i + j + 1);
    i = j;
  }
  return rank;
}

/// The number at the head of a value, nan for text.
double leading_number(const std::string& value) {
  double x = nan;
  const auto read = std::from_chars(value.data(), value.data() + value.size(), x);
  return read.ec == std::errc{} ? x : nan;
}

/// The sweep as columns of numbers.
struct Columns {
  std::vector<std::vector<double>> factors;    ///< nan: text
  std::vector<std::vector<double>> responses;  ///< nan: failed
  std::vector<std::string> units;              ///< of the responses
};

Columns columns_of(const Plan& plan, const Rows& rows) {
  Columns c;
  c.factors.resize(plan.design.factors().size());
  c.responses.resize(plan.responses.size());
  c.units.resize(plan.responses.size());
  for (const auto& [run, row] : rows) {
    const auto values = plan.design.values(run);
    for (std::size_t k = 0; k < values.size(); ++k)
      c.factors[k].push_back(leading_number(values[k]));
    for (std::size_t k = 0; k < c.responses.size(); ++k) {
      c.responses[k].push_back(row.answers[k].failure.empty() ? row.answers[k].value : nan);
      if (c.units[k].empty()) c.units[k] = row.answers[k].unit;
    }
  }
  return c;
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
        cells.emplace_back(values[k]);
      else
        cells.emplace_back(leading_number(values[k]));
    for (const Answer& a : row.answers) {
      cells.emplace_back(a.failure.empty() ? a.value : nan);
      cells.emplace_back(a.failure);
    }
    cells.emplace_back(row.exit);
    cells.emplace_back(row.code);
    cells.emplace_back(row.message);
    t.add(std::move(cells));
  }
  return t;
}

std::vector<double> finite(const std::vector<double>& x) {
  std::vector<double> out;
  std::copy_if(x.begin(), x.end(), std::back_inserter(out),
               [](double v) { return !std::isnan(v); });
  return out;
}

io::Table statistics_table(const Plan& plan, const Columns& c) {
  io::Table t;
  t.title = "Responses";
  t.nan_means = "no run gave a value";
  t.columns = {{"response", "-", ""},
               {"unit", "-", ""},
               {"runs", "-", "that gave a value"},
               {"failed", "-", "runs without a value"},
               {"mean", "-", "in the unit of the response, as all that follow"},
               {"error of the mean", "-", "standard error, of independent runs"},
               {"standard deviation", "-", ""},
               {"least", "-", ""},
               {"5 %", "-", "quantile"},
               {"median", "-", ""},
               {"95 %", "-", "quantile"},
               {"largest", "-", ""}};
  for (std::size_t k = 0; k < plan.responses.size(); ++k) {
    const auto values = finite(c.responses[k]);
    const double failed = static_cast<double>(c.responses[k].size() - values.size());
    std::vector<io::Table::Cell> cells{plan.responses[k].name, c.units[k],
                                       static_cast<double>(values.size()), failed};
    if (values.empty()) {
      for (int i = 0; i < 8; ++i)
        cells.emplace_back(nan);
    } else {
      const Statistics s = statistics_of(values);
      for (double x : {s.mean, s.deviation / std::sqrt(static_cast<double>(s.count)), s.deviation,
                       s.least, s.p05, s.median, s.p95, s.largest})
        cells.emplace_back(x);
    }
    t.add(std::move(cells));
  }
  return t;
}

/// Values of runs in which both are numbers.
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

io::Table effects_table(const Plan& plan, const Columns& c) {
  io::Table t;
  t.title = "What the responses depend on";
  t.nan_means = "one of the two does not vary, or is text";
  t.columns = {{"response", "-", ""},
               {"varied", "-", ""},
               {"rank correlation", "-",
                "after Spearman: 1 or -1 where one grows or falls with the "
                "other throughout"}};
  for (std::size_t r = 0; r < plan.responses.size(); ++r)
    for (std::size_t f = 0; f < c.factors.size(); ++f) {
      const auto [x, y] = pairs_of(c.factors[f], c.responses[r]);
      t.add({plan.responses[r].name, plan.design.factors()[f].path, rank_correlation(x, y)});
    }
  return t;
}

plot::Figure histogram(const Plan& plan, const Columns& c, std::size_t r,
                       const std::vector<double>& values) {
  const Statistics s = statistics_of(values);
  // H. A. Sturges, J. Am. Stat. Assoc. 21 (1926) 65
  const int bins = 1 + static_cast<int>(std::ceil(std::log2(static_cast<double>(values.size()))));
  const double width = s.largest > s.least ? (s.largest - s.least) / bins
                                           : std::max(1e-12, 0.01 * std::abs(s.least));
  plot::Bars bars;
  bars.width = 0.95 * width;
  for (int k = 0; k < bins; ++k) {
    bars.x.push_back(s.least + (k + 0.5) * width);
    bars.height.push_back(0);
  }
  for (double v : values)
    ++bars.height[static_cast<std::size_t>(
        std::clamp(static_cast<int>((v - s.least) / width), 0, bins - 1))];
  plot::Axes axes;
  axes.x = plot::Axis(plan.responses[r].name, c.units[r].empty() ? "-" : c.units[r]);
  axes.y = plot::Axis("runs", "-");
  axes.y.include_zero = true;
  axes.legend = false;
  axes.bars.push_back(std::move(bars));
  axes.rules.push_back({true, s.median, "median"});
  return {fmt::format("histogram_{}", r + 1), plan.responses[r].name, "", {axes}};
}

plot::Figure scatter(const Plan& plan, const Columns& c, std::size_t r) {
  plot::Figure figure;
  figure.name = fmt::format("dependence_{}", r + 1);
  figure.title = plan.responses[r].name + " against what is varied";
  for (std::size_t f = 0; f < c.factors.size(); ++f) {
    auto [x, y] = pairs_of(c.factors[f], c.responses[r]);
    if (x.empty()) continue;
    const Factor& factor = plan.design.factors()[f];
    plot::Axes axes;
    axes.x = plot::Axis(factor.path, factor.unit.empty() ? "-" : factor.unit);
    axes.y = plot::Axis(plan.responses[r].name, c.units[r].empty() ? "-" : c.units[r]);
    axes.legend = false;
    plot::Series cloud;
    cloud.x = std::move(x);
    cloud.y = std::move(y);
    cloud.style.width = 0;
    cloud.style.marker = plot::Marker::circle;
    cloud.style.marker_size = 4;
    cloud.style.opacity = 0.7;
    axes.series.push_back(std::move(cloud));
    figure.axes.push_back(std::move(axes));
  }
  figure.columns = figure.axes.size() > 1 ? 2 : 1;
  figure.height = 320.0 * std::ceil(static_cast<double>(figure.axes.size()) / figure.columns);
  return figure;
}

io::Report report_of(const Plan& plan, const Columns& c, const io::Table& statistics,
                     const io::Table& effects, const io::Value& summary) {
  io::Report report;
  report.title = "Sweep";
  report.facts = {{"runs", std::to_string(plan.design.runs())}};
  report.summary = summary;
  io::ReportSection section;
  section.title = "Responses";
  section.tables = {statistics, effects};
  section.files = {{"all runs", "sweep.csv"}};
  for (std::size_t r = 0; r < plan.responses.size(); ++r) {
    const auto values = finite(c.responses[r]);
    if (values.empty()) continue;
    section.figures.push_back(histogram(plan, c, r, values));
    if (plot::Figure f = scatter(plan, c, r); !f.axes.empty())
      section.figures.push_back(std::move(f));
  }
  report.sections.push_back(std::move(section));
  return report;
}

void print_statistics(const io::Table& t) {
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

double rank_correlation(const std::vector<double>& x, const std::vector<double>& y) {
  WHIRL_EXPECTS(x.size() == y.size());
  const auto a = ranks_of(x), b = ranks_of(y);
  const double mean = 0.5 * static_cast<double>(x.size() + 1);
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean) * (b[i] - mean);
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : nan;
}

void write_outcome(const Plan& plan, const Rows& rows, const run::RunOptions& options) {
  const Columns c = columns_of(plan, rows);
  io::ResultsFolder folder(plan.root);
  const io::Table statistics = statistics_table(plan, c), effects = effects_table(plan, c);
  folder.write_table("sweep.csv", sweep_table(plan, rows, c));
  folder.write_table("statistics.csv", statistics);
  folder.write_table("effects.csv", effects);
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
  folder.write_json("summary.json", summary);
  io::write_report(folder.path("sweep.html"), report_of(plan, c, statistics, effects, summary));
  if (options.json)
    std::fputs(io::to_json(summary).c_str(), stdout);
  else if (!options.quiet)
    print_statistics(statistics);
}

}  // namespace whirl::sweep
