#include <sweep/pictures.hpp>
#include <sweep/confidence.hpp>
#include <sweep/outcome.hpp>
#include <sweep/scatter_matrix.hpp>
#include <sweep/sensitivity.hpp>
#include <sweep/surface.hpp>
#include <sweep/words.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace whirl::sweep {
namespace {

plot::Axis axis_of_response(const Plan& plan, const Columns& c, std::size_t r) {
  return {plan.responses[r].name, c.units[r].empty() ? "-" : c.units[r]};
}

plot::Axis axis_of_factor(const Plan& plan, std::size_t f) {
  const Factor& factor = plan.design.factors()[f];
  return {factor.path, factor.unit.empty() ? "-" : factor.unit};
}

plot::Series cloud_of(std::vector<double> x, std::vector<double> y) {
  plot::Series cloud;
  cloud.x = std::move(x);
  cloud.y = std::move(y);
  cloud.style.width = 0;
  cloud.style.marker = plot::Marker::circle;
  cloud.style.marker_size = 4;
  cloud.style.opacity = 0.7;
  return cloud;
}

/// Names of the keys at 0, 1, ..
plot::Axis axis_of_keys(const Plan& plan) {
  plot::Axis axis("", "");
  for (std::size_t k = 0; k < plan.design.factors().size(); ++k) {
    axis.ticks.push_back(static_cast<double>(k));
    axis.tick_labels.push_back(plan.design.factors()[k].path);
  }
  axis.min = -0.6;
  axis.max = static_cast<double>(plan.design.factors().size()) - 0.4;
  return axis;
}

/// Where the percentiles lie, as bands behind the bars.
void add_bounds(const QuantileBounds& bounds, double height, plot::Axes& axes,
                std::string& caption) {
  struct Band {
    const char* name;
    const std::optional<Interval>& at;
  };
  const Band bands[] = {{"5 %", bounds.p05}, {"median", bounds.median}, {"95 %", bounds.p95}};
  std::string words;
  for (const Band& b : bands) {
    if (!b.at) continue;
    plot::Patch band;
    band.x = {b.at->low, b.at->high, b.at->high, b.at->low};
    band.y = {0, 0, height, height};
    band.style.color = 1;
    band.style.width = 0;
    band.fill_opacity = 0.3;
    band.tooltip = fmt::format("{}: {:.6g} to {:.6g}", b.name, b.at->low, b.at->high);
    words += fmt::format("{}{} {:.4g} to {:.4g}", words.empty() ? "" : ", ", b.name, b.at->low,
                         b.at->high);
    axes.patches.push_back(std::move(band));
  }
  if (!words.empty()) caption = "bands, 95 % confidence: " + words;
  if (bounds.missing.empty()) return;
  caption += (caption.empty() ? "confidence of the percentiles: " : "; ") + bounds.missing;
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
  axes.x = axis_of_response(plan, c, r);
  axes.y = plot::Axis("runs", "-");
  axes.y.include_zero = true;
  axes.legend = false;
  axes.bars.push_back(std::move(bars));
  for (const auto& [place, name] : {std::pair{s.p05, "5 %"}, {s.median, "median"}, {s.p95, "95 %"}})
    axes.rules.push_back({true, place, name});
  plot::Figure figure;
  figure.name = fmt::format("histogram_{}", r + 1);
  figure.title = plan.responses[r].name;
  const std::vector<double>& heights = axes.bars.front().height;
  const double highest = *std::max_element(heights.begin(), heights.end());
  add_bounds(bounds_of_response(plan, values), highest, axes, figure.caption);
  figure.axes.push_back(std::move(axes));
  return figure;
}

plot::Figure scatter(const Plan& plan, const Columns& c, std::size_t r) {
  plot::Figure figure;
  figure.name = fmt::format("dependence_{}", r + 1);
  figure.title = plan.responses[r].name + " against what is varied";
  for (std::size_t f = 0; f < c.factors.size(); ++f) {
    auto [x, y] = pairs_of(c.factors[f], c.responses[r]);
    if (x.empty()) continue;
    plot::Axes axes;
    axes.x = axis_of_factor(plan, f);
    axes.y = axis_of_response(plan, c, r);
    axes.legend = false;
    axes.series.push_back(cloud_of(std::move(x), std::move(y)));
    figure.axes.push_back(std::move(axes));
  }
  figure.columns = figure.axes.size() > 1 ? 2 : 1;
  figure.height = 320.0 * std::ceil(static_cast<double>(figure.axes.size()) / figure.columns);
  return figure;
}

/// A column from 0 to 1.
std::vector<double> scaled(const std::vector<double>& column) {
  const auto values = finite(column);
  if (values.empty()) return {};
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  const double low = *least, span = *largest - *least;
  std::vector<double> out;
  out.reserve(column.size());
  for (const double x : column)
    out.push_back(span > 0 ? (x - low) / span : x - low + 0.5);
  return out;
}

/// Runs as lines across all columns, in three parts by the first response.
plot::Figure parallel_coordinates(const Plan& plan, const Columns& c) {
  constexpr std::size_t most_lines = 300;
  plot::Figure figure;
  figure.name = "parallel_coordinates";
  figure.title = "All columns, from their least to their largest value";
  std::vector<std::vector<double>> columns;
  plot::Axes axes;
  axes.x = plot::Axis("", "");
  const auto add = [&](const std::vector<double>& column, const std::string& name) {
    auto part = scaled(column);
    if (part.empty()) return;
    axes.x.ticks.push_back(static_cast<double>(columns.size()));
    axes.x.tick_labels.push_back(name);
    columns.push_back(std::move(part));
  };
  for (std::size_t f = 0; f < c.factors.size(); ++f)
    add(c.factors[f], plan.design.factors()[f].path);
  for (std::size_t r = 0; r < c.responses.size(); ++r)
    add(c.responses[r], plan.responses[r].name);
  const auto first = scaled(c.responses[0]);
  if (columns.size() < 3 || first.empty()) return figure;
  axes.x.min = -0.1;
  axes.x.max = static_cast<double>(columns.size()) - 0.4;  // room for the legend
  axes.y = plot::Axis("place between least and largest", "-");
  const char* const names[] = {"lowest third of ", "middle third of ", "highest third of "};
  const std::size_t stride = (first.size() + most_lines - 1) / most_lines;
  for (std::size_t third = 0; third < 3; ++third) {
    plot::Series lines;
    lines.label = names[third] + plan.responses[0].name;
    lines.style.width = 0.8;
    lines.style.opacity = 0.5;
    lines.keep_all = true;
    for (std::size_t run = 0; run < first.size(); run += stride) {
      if (std::isnan(first[run])) continue;
      if (std::min<std::size_t>(2, static_cast<std::size_t>(3.0 * first[run])) != third) continue;
      for (std::size_t k = 0; k < columns.size(); ++k) {
        lines.x.push_back(static_cast<double>(k));
        lines.y.push_back(columns[k][run]);
      }
      lines.x.push_back(nan);
      lines.y.push_back(nan);
    }
    if (!lines.x.empty()) axes.series.push_back(std::move(lines));
  }
  if (stride > 1)
    figure.caption = fmt::format("every run whose number is a multiple of {}", stride);
  figure.axes.push_back(std::move(axes));
  return figure;
}

/// Of two lists of numbers, and nothing else varied.
plot::Figure surface(const Plan& plan, const Columns& c, std::size_t r) {
  plot::Figure figure;
  figure.name = fmt::format("surface_{}", r + 1);
  figure.title = plan.responses[r].name + " over both keys";
  const auto& f = plan.design.factors();
  const bool two_lists = f.size() == 2 && !f[0].random() && !f[1].random() &&
                         f[0].values.size() > 1 && f[1].values.size() > 1 && f[0].file < 0 &&
                         f[1].file < 0;
  if (!two_lists || finite(c.factors[0]).size() != c.factors[0].size() ||
      finite(c.factors[1]).size() != c.factors[1].size())
    return figure;
  plot::Axes axes;
  axes.x = axis_of_factor(plan, 0);
  axes.y = axis_of_response(plan, c, r);
  const std::size_t n = f[1].values.size();
  for (std::size_t k = 0; k < n; ++k) {
    plot::Series line;
    line.label = f[1].path + " = " + f[1].values[k];
    line.style.marker = plot::Marker::circle;
    line.keep_all = true;
    for (std::size_t i = 0; i < f[0].values.size(); ++i) {
      line.x.push_back(c.factors[0][i * n + k]);
      line.y.push_back(c.responses[r][i * n + k]);
    }
    axes.series.push_back(std::move(line));
  }
  figure.axes.push_back(std::move(axes));
  return figure;
}

plot::Figure sobol_figure(const Plan& plan, const Columns& c, std::size_t r) {
  plot::Figure figure;
  figure.name = fmt::format("sobol_{}", r + 1);
  figure.title = plan.responses[r].name + ": Sobol's indices";
  std::size_t used = 0;
  const auto indices = sobol_indices(c.responses[r], plan.design.factors().size(), used);
  if (indices.empty()) return figure;
  plot::Bars first, total;
  first.label = "alone";
  total.label = "with all it interacts with";
  first.width = total.width = 0.32;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    first.x.push_back(static_cast<double>(k) - 0.18);
    first.height.push_back(indices[k].first);
    total.x.push_back(static_cast<double>(k) + 0.18);
    total.height.push_back(indices[k].total);
  }
  plot::Axes axes;
  axes.x = axis_of_keys(plan);
  axes.y = plot::Axis("share of the variance", "-");
  axes.y.include_zero = true;
  axes.bars = {std::move(first), std::move(total)};
  figure.axes.push_back(std::move(axes));
  figure.caption = fmt::format("{} of {} points", used, plan.design.base());
  return figure;
}

plot::Figure morris_figure(const Plan& plan, const Columns& c, std::size_t r) {
  plot::Figure figure;
  figure.name = fmt::format("morris_{}", r + 1);
  figure.title = plan.responses[r].name + ": elementary effects after Morris";
  const auto effects =
      morris_effects(c.responses[r], plan.design.factors().size(), plan.design.seed());
  plot::Axes axes;
  const std::string unit = c.units[r].empty() ? "-" : c.units[r];
  axes.x = plot::Axis("mean of their sizes", unit);
  axes.y = plot::Axis("standard deviation", unit);
  axes.x.include_zero = axes.y.include_zero = true;
  axes.legend = false;
  std::vector<double> x, y;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    if (effects[k].paths == 0) continue;
    x.push_back(effects[k].magnitude);
    y.push_back(effects[k].deviation);
    axes.notes.push_back({x.back(), y.back(), plan.design.factors()[k].path});
  }
  if (x.empty()) return figure;
  axes.series.push_back(cloud_of(std::move(x), std::move(y)));
  axes.series.back().style.marker_size = 8;
  figure.axes.push_back(std::move(axes));
  return figure;
}

/// Bars from the value at the 5 % quantile of each key to that at 95 %, the widest on top.
plot::Figure tornado_figure(const Plan& plan, const Columns& c, std::size_t r) {
  plot::Figure figure;
  figure.name = fmt::format("tornado_{}", r + 1);
  figure.title = plan.responses[r].name + ", one key at a time";
  struct Bar {
    double low, high;
    std::size_t key;
  };
  std::vector<Bar> bars;
  for (std::size_t k = 0; k < plan.design.factors().size(); ++k) {
    const double low = c.responses[r][2 * k + 1], high = c.responses[r][2 * k + 2];
    if (!std::isnan(low) && !std::isnan(high)) bars.push_back({low, high, k});
  }
  if (bars.empty()) return figure;
  std::stable_sort(bars.begin(), bars.end(), [](const Bar& a, const Bar& b) {
    return std::abs(a.high - a.low) < std::abs(b.high - b.low);
  });
  plot::Axes axes;
  axes.x = axis_of_response(plan, c, r);
  axes.y = plot::Axis("", "");
  axes.legend = false;
  for (std::size_t place = 0; place < bars.size(); ++place) {
    const double y = static_cast<double>(place);
    axes.y.ticks.push_back(y);
    axes.y.tick_labels.push_back(plan.design.factors()[bars[place].key].path);
    plot::Patch bar;
    bar.x = {bars[place].low, bars[place].high, bars[place].high, bars[place].low};
    bar.y = {y - 0.35, y - 0.35, y + 0.35, y + 0.35};
    bar.style.color = 0;
    bar.fill_opacity = 0.6;
    bar.tooltip = fmt::format("{:.6g} at 5 %, {:.6g} at 95 %", bars[place].low, bars[place].high);
    axes.patches.push_back(std::move(bar));
  }
  axes.y.min = -0.6;
  axes.y.max = static_cast<double>(bars.size()) - 0.2;
  if (!std::isnan(c.responses[r][0]))
    axes.rules.push_back({true, c.responses[r][0], "all at their medians"});
  figure.height = 120.0 + 40.0 * static_cast<double>(bars.size());
  figure.caption = "from the 5 % to the 95 % quantile of each key, the others at their medians";
  figure.axes.push_back(std::move(axes));
  return figure;
}

/// What the scheme of the samples is for.
plot::Figure scheme_figure(const Plan& plan, const Columns& c, std::size_t r) {
  switch (plan.design.sampling()) {
    case Sampling::saltelli: return sobol_figure(plan, c, r);
    case Sampling::morris: return morris_figure(plan, c, r);
    case Sampling::one_at_a_time: return tornado_figure(plan, c, r);
    case Sampling::random:
    case Sampling::latin_hypercube:
    case Sampling::sobol: break;
  }
  return surface(plan, c, r);
}

}  // namespace

std::vector<plot::Figure> pictures_of(const Plan& plan, const Columns& c) {
  std::vector<plot::Figure> out;
  const auto add = [&](plot::Figure f) {
    if (!f.axes.empty()) out.push_back(std::move(f));
  };
  const bool one_at_a_time = plan.design.sampling() == Sampling::one_at_a_time;
  for (std::size_t r = 0; r < plan.responses.size(); ++r) {
    if (!c.words[r].empty()) add(word_figure(plan, c, r));
    const auto values = finite(c.responses[r]);
    if (values.empty()) continue;
    add(scheme_figure(plan, c, r));
    if (one_at_a_time) continue;
    add(contours(plan, c, r));
    if (!plan.design.weighted()) add(histogram(plan, c, r, values));
    add(scatter(plan, c, r));
  }
  if (one_at_a_time) return out;
  add(scatter_matrix(plan, c));
  add(parallel_coordinates(plan, c));
  return out;
}

}  // namespace whirl::sweep
