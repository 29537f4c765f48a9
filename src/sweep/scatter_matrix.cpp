#include <sweep/scatter_matrix.hpp>
#include <sweep/outcome.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::sweep {
namespace {

constexpr std::size_t most_columns = 8;
constexpr std::size_t most_points = 500;  // of a cell

struct Column {
  std::string name, unit;
  const std::vector<double>* values = nullptr;
  double importance = 0;  ///< largest rank correlation with a response; responses: above all
};

bool varies(const std::vector<double>& column) {
  const std::vector<double> known = finite(column);
  return !known.empty() && *std::min_element(known.begin(), known.end()) <
                               *std::max_element(known.begin(), known.end());
}

/// What a key means for the response that depends on it most.
double importance_of(const Columns& c, const std::vector<double>& key) {
  double most = 0;
  for (const auto& response : c.responses) {
    const double correlation = rank_correlation(c, key, response);
    if (!std::isnan(correlation)) most = std::max(most, std::abs(correlation));
  }
  return most;
}

std::vector<Column> columns_that_vary(const Plan& plan, const Columns& c) {
  constexpr double above_all = 2;
  std::vector<Column> out;
  for (std::size_t f = 0; f < c.factors.size(); ++f)
    if (varies(c.factors[f])) {
      const Factor& factor = plan.design.factors()[f];
      out.push_back({factor.path, factor.unit, &c.factors[f], importance_of(c, c.factors[f])});
    }
  for (std::size_t r = 0; r < c.responses.size(); ++r)
    if (varies(c.responses[r]))
      out.push_back({plan.responses[r].name, c.units[r], &c.responses[r], above_all});
  return out;
}

/// The most important ones, in the order they had.
void leave_out(std::vector<Column>& columns) {
  if (columns.size() <= most_columns) return;
  std::vector<double> order;
  order.reserve(columns.size());
  for (const Column& c : columns)
    order.push_back(c.importance);
  std::sort(order.rbegin(), order.rend());
  const double least = order[most_columns - 1];
  std::erase_if(columns, [least](const Column& c) { return c.importance < least; });
  columns.resize(std::min(columns.size(), most_columns));
}

plot::Axis plain_axis() {
  plot::Axis axis("", "");
  axis.min = 0;
  axis.max = 1;
  axis.ticks = {0.5};
  axis.tick_labels = {""};
  return axis;
}

/// An axis of a cell, with its name where the cell stands at the border.
plot::Axis axis_of(const Column& c, bool at_border) {
  if (at_border) return {c.name, c.unit.empty() ? "-" : c.unit};
  const std::vector<double> known = finite(*c.values);
  plot::Axis axis("", "");
  axis.ticks = {*std::min_element(known.begin(), known.end())};
  axis.tick_labels = {""};
  return axis;
}

plot::Axes histogram_of(const Column& c, bool last) {
  const std::vector<double> values = finite(*c.values);
  const Statistics s = statistics_of(values);
  const int bins = 1 + static_cast<int>(std::ceil(std::log2(static_cast<double>(values.size()))));
  const double width = (s.largest - s.least) / bins;
  plot::Bars bars;
  bars.width = 0.95 * width;
  for (int k = 0; k < bins; ++k) {
    bars.x.push_back(s.least + (k + 0.5) * width);
    bars.height.push_back(0);
  }
  for (const double v : values)
    ++bars.height[static_cast<std::size_t>(
        std::clamp(static_cast<int>((v - s.least) / width), 0, bins - 1))];
  plot::Axes axes;
  axes.x = axis_of(c, last);
  axes.y = plot::Axis("", "");
  axes.y.include_zero = true;
  axes.y.ticks = {0};
  axes.y.tick_labels = {""};
  axes.bars.push_back(std::move(bars));
  return axes;
}

plot::Axes cloud_of(const Column& across, const Column& up, bool first, bool last) {
  auto [x, y] = pairs_of(*across.values, *up.values);
  const std::size_t stride = (x.size() + most_points - 1) / most_points;
  plot::Series cloud;
  for (std::size_t k = 0; k < x.size(); k += stride) {
    cloud.x.push_back(x[k]);
    cloud.y.push_back(y[k]);
  }
  cloud.style.width = 0;
  cloud.style.color = 0;
  cloud.style.marker = plot::Marker::circle;
  cloud.style.marker_size = 2.5;
  cloud.style.opacity = 0.6;
  plot::Axes axes;
  axes.x = axis_of(across, last);
  axes.y = axis_of(up, first);
  axes.series.push_back(std::move(cloud));
  return axes;
}

plot::Axes correlation_of(const Columns& c, const Column& across, const Column& up) {
  const double exact = rank_correlation(c, *across.values, *up.values);
  const double correlation = std::abs(exact) < 0.005 ? 0.0 : exact;  // no "-0.00"
  plot::Axes axes;
  axes.x = plain_axis();
  axes.y = plain_axis();
  plot::Note note{0.4, 0.6, std::isnan(correlation) ? "-" : fmt::format("{:.2f}", correlation)};
  note.leader = false;
  note.dx = note.dy = 0;
  axes.notes.push_back(std::move(note));
  return axes;
}

}  // namespace

plot::Figure scatter_matrix(const Plan& plan, const Columns& c) {
  plot::Figure figure;
  figure.name = "scatter_matrix";
  figure.title = "Keys and responses against each other";
  std::vector<Column> columns = columns_that_vary(plan, c);
  const std::size_t all = columns.size();
  leave_out(columns);
  const std::size_t n = columns.size();
  if (n < 2) return figure;
  for (std::size_t row = 0; row < n; ++row)
    for (std::size_t k = 0; k < n; ++k) {
      const bool last = row + 1 == n;
      plot::Axes axes = k == row  ? histogram_of(columns[k], last)
                        : k < row ? cloud_of(columns[k], columns[row], k == 0, last)
                                  : correlation_of(c, columns[k], columns[row]);
      axes.legend = false;
      figure.axes.push_back(std::move(axes));
    }
  figure.columns = static_cast<int>(n);
  figure.width = std::max(760.0, 170.0 * static_cast<double>(n));
  figure.height = 140.0 * static_cast<double>(n);
  figure.caption = "points: runs; diagonal: how often; above it: rank correlations";
  if (all > n) figure.caption += fmt::format("; the {} of {} columns that matter most", n, all);
  if (plan.design.runs() > static_cast<std::int64_t>(most_points))
    figure.caption += fmt::format("; of the points {} at most", most_points);
  return figure;
}

}  // namespace whirl::sweep
