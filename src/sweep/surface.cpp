#include <sweep/surface.hpp>
#include <sweep/outcome.hpp>

#include <Eigen/QR>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>

namespace whirl::sweep {

std::optional<QuadraticFit> QuadraticFit::of(const std::vector<std::vector<double>>& keys,
                                             const std::vector<double>& y) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const bool known =
        std::none_of(keys.begin(), keys.end(), [i](const auto& key) { return std::isnan(key[i]); });
    if (known && !std::isnan(y[i])) rows.push_back(i);
  }
  const std::size_t d = keys.size();
  const std::size_t count = 1 + d + d * (d + 1) / 2;
  if (rows.size() < 2 * count) return std::nullopt;
  QuadraticFit fit;
  fit.runs_ = rows.size();
  for (const auto& key : keys) {
    double low = infinity, high = -infinity;
    for (const std::size_t i : rows) {
      low = std::min(low, key[i]);
      high = std::max(high, key[i]);
    }
    if (!(high > low)) return std::nullopt;
    fit.middle_.push_back(0.5 * (low + high));
    fit.half_.push_back(0.5 * (high - low));
  }
  MatX A(static_cast<Index>(rows.size()), static_cast<Index>(count));
  VecX b(static_cast<Index>(rows.size()));
  std::vector<double> point(d);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t k = 0; k < d; ++k)
      point[k] = keys[k][rows[r]];
    A.row(static_cast<Index>(r)) = fit.terms(point).transpose();
    b[static_cast<Index>(r)] = y[rows[r]];
  }
  fit.coefficients_ = A.colPivHouseholderQr().solve(b);
  const double left = (A * fit.coefficients_ - b).squaredNorm();
  const double all = (b.array() - b.mean()).matrix().squaredNorm();
  fit.residual_ = std::sqrt(left / static_cast<double>(rows.size() - count));
  fit.share_left_ = all > 0 ? left / all : 0.0;
  return fit;
}

VecX QuadraticFit::terms(std::span<const double> keys) const {
  const std::size_t d = keys.size();
  std::vector<double> u;
  for (std::size_t k = 0; k < d; ++k)
    u.push_back((keys[k] - middle_[k]) / half_[k]);
  VecX out(static_cast<Index>(1 + d + d * (d + 1) / 2));
  Index place = 0;
  out[place++] = 1;
  for (const double x : u)
    out[place++] = x;
  for (std::size_t k = 0; k < d; ++k)
    for (std::size_t l = k; l < d; ++l)
      out[place++] = u[k] * u[l];
  return out;
}

double QuadraticFit::at(std::span<const double> keys) const {
  return terms(keys).dot(coefficients_);
}

namespace {

struct Range {
  double low = 0, high = 0;
  double at(double share) const { return std::lerp(low, high, share); }
};

Range range_of(const std::vector<double>& column) {
  const std::vector<double> known = finite(column);
  const auto [low, high] = std::minmax_element(known.begin(), known.end());
  return {*low, *high};
}

/// 1, 2 or 5 times a power of ten: about ten of them over the span.
double step_of_levels(double span) {
  const double rough = span / 10;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double nice : {1.0, 2.0, 5.0})
    if (rough <= nice * power) return nice * power;
  return 10 * power;
}

/// Values at the corners of nx times ny cells.
struct Corners {
  int nx = 0, ny = 0;
  Range x, y;
  std::vector<double> values;
  double& at(int ix, int iy) {
    return values[static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx + 1) +
                  static_cast<std::size_t>(ix)];
  }
  double at(int ix, int iy) const { return const_cast<Corners*>(this)->at(ix, iy); }
  double x_of(double ix) const { return x.at(ix / nx); }
  double y_of(double iy) const { return y.at(iy / ny); }
};

/// The pieces of a level's line in the cells, two points each, in cells.
std::vector<std::array<double, 4>> pieces_of(const Corners& c, double level) {
  std::vector<std::array<double, 4>> out;
  for (int iy = 0; iy < c.ny; ++iy)
    for (int ix = 0; ix < c.nx; ++ix) {
      const std::array<std::array<int, 2>, 4> corner{
          {{ix, iy}, {ix + 1, iy}, {ix + 1, iy + 1}, {ix, iy + 1}}};
      std::vector<double> crossed;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& a = corner[k];
        const auto& b = corner[(k + 1) % 4];
        const double from = c.at(a[0], a[1]) - level;
        const double to = c.at(b[0], b[1]) - level;
        if (!((from < 0) != (to < 0)) || std::isnan(from) || std::isnan(to)) continue;
        const double share = from / (from - to);
        crossed.push_back(std::lerp(a[0], b[0], share));
        crossed.push_back(std::lerp(a[1], b[1], share));
      }
      for (std::size_t k = 0; k + 3 < crossed.size(); k += 4)
        out.push_back({crossed[k], crossed[k + 1], crossed[k + 2], crossed[k + 3]});
    }
  return out;
}

void add_level(const Corners& c, double level, plot::Axes& axes) {
  const auto pieces = pieces_of(c, level);
  if (pieces.empty()) return;
  plot::Series line;
  line.style.width = 0.8;
  line.style.color = plot::ink;
  line.keep_all = true;
  for (const auto& p : pieces) {
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
      line.x.push_back(c.x_of(p[k]));
      line.y.push_back(c.y_of(p[k + 1]));
    }
    line.x.push_back(nan);
    line.y.push_back(nan);
  }
  axes.series.push_back(std::move(line));
  const auto& middle = pieces[pieces.size() / 2];
  plot::Note note{c.x_of(middle[0]), c.y_of(middle[1]), fmt::format("{:.4g}", level)};
  note.leader = false;
  note.dx = note.dy = 0;
  axes.notes.push_back(std::move(note));
}

using Surface = std::function<double(double, double)>;

/// Bands of one colour each, and the lines between them.
void fill(const Surface& value, const Range& x, const Range& y, const plot::Axis& of_response,
          plot::Axes& axes) {
  Corners corners{120, 90, x, y, {}};
  corners.values.resize((static_cast<std::size_t>(corners.nx) + 1) *
                        (static_cast<std::size_t>(corners.ny) + 1));
  for (int iy = 0; iy <= corners.ny; ++iy)
    for (int ix = 0; ix <= corners.nx; ++ix)
      corners.at(ix, iy) = value(corners.x_of(ix), corners.y_of(iy));
  axes.x.min = x.low;
  axes.x.max = x.high;
  axes.y.min = y.low;
  axes.y.max = y.high;
  const std::vector<double> known = finite(corners.values);
  if (known.empty()) return;
  const auto [least, largest] = std::minmax_element(known.begin(), known.end());
  constexpr double rounding = 1e-9;  // a surface that is one value
  if (!(*largest - *least > rounding * std::max(std::abs(*least), std::abs(*largest)))) return;
  const double step = step_of_levels(*largest - *least);
  plot::HeatMap heat{corners.nx, corners.ny, x.low, x.high, y.low, y.high, {}, {}, {}};
  heat.label = of_response.label;
  heat.unit = of_response.unit;
  for (int iy = 0; iy < corners.ny; ++iy)
    for (int ix = 0; ix < corners.nx; ++ix) {
      const double v = value(corners.x_of(ix + 0.5), corners.y_of(iy + 0.5));
      heat.values.push_back((std::floor(v / step) + 0.5) * step);
    }
  heat.min = std::floor(*least / step) * step;
  heat.max = std::ceil(*largest / step) * step;
  const double first = std::ceil(*least / step);
  const auto levels = static_cast<int>(std::floor(*largest / step) - first) + 1;
  for (int k = 0; k < levels; ++k)
    add_level(corners, (first + k) * step, axes);
  axes.heat.push_back(std::move(heat));
}

plot::Axis axis_of(const Plan& plan, std::size_t key) {
  const Factor& f = plan.design.factors()[key];
  return {f.path, f.unit.empty() ? "-" : f.unit};
}

plot::Axes axes_over(const Plan& plan, std::size_t first, std::size_t second) {
  plot::Axes axes;
  axes.x = axis_of(plan, first);
  axes.y = axis_of(plan, second);
  axes.legend = false;
  return axes;
}

plot::Series dots(std::vector<double> x, std::vector<double> y) {
  plot::Series s;
  s.x = std::move(x);
  s.y = std::move(y);
  s.style.width = 0;
  s.style.color = plot::ink;
  s.style.marker = plot::Marker::circle;
  s.style.marker_size = 2.5;
  s.style.opacity = 0.6;
  return s;
}

bool is_number(const std::vector<double>& column) {
  const std::vector<double> known = finite(column);
  return known.size() == column.size() && !known.empty() &&
         *std::min_element(known.begin(), known.end()) <
             *std::max_element(known.begin(), known.end());
}

/// Between the values of two lists, nothing else varied: linear in each.
plot::Axes of_lists(const Plan& plan, const Columns& c, std::size_t r,
                    const plot::Axis& of_response) {
  const std::size_t n = plan.design.factors()[1].values.size();
  const std::size_t m = plan.design.factors()[0].values.size();
  std::vector<std::size_t> a(m), b(n);  // in the order of their values
  std::iota(a.begin(), a.end(), std::size_t{0});
  std::iota(b.begin(), b.end(), std::size_t{0});
  const auto x_of = [&](std::size_t i) { return c.factors[0][i * n]; };
  const auto y_of = [&](std::size_t k) { return c.factors[1][k]; };
  std::sort(a.begin(), a.end(), [&](auto i, auto k) { return x_of(i) < x_of(k); });
  std::sort(b.begin(), b.end(), [&](auto i, auto k) { return y_of(i) < y_of(k); });
  const auto place = [](const auto& order, const auto& value_of, double value, double& share) {
    std::size_t k = 0;
    while (k + 2 < order.size() && value_of(order[k + 1]) < value)
      ++k;
    const double from = value_of(order[k]);
    const double to = value_of(order[k + 1]);
    share = to > from ? std::clamp((value - from) / (to - from), 0.0, 1.0) : 0.0;
    return k;
  };
  const Surface value = [&](double x, double y) {
    double along = 0, across = 0;
    const std::size_t i = place(a, x_of, x, along);
    const std::size_t k = place(b, y_of, y, across);
    const auto run = [&](std::size_t p, std::size_t q) { return c.responses[r][a[p] * n + b[q]]; };
    return std::lerp(std::lerp(run(i, k), run(i, k + 1), across),
                     std::lerp(run(i + 1, k), run(i + 1, k + 1), across), along);
  };
  plot::Axes axes = axes_over(plan, 0, 1);
  fill(value, range_of(c.factors[0]), range_of(c.factors[1]), of_response, axes);
  if (!axes.heat.empty()) axes.series.push_back(dots(c.factors[0], c.factors[1]));
  return axes;
}

/// The two keys on which the response depends most.
std::vector<std::size_t> most_important(const Columns& c, std::size_t r,
                                        const std::vector<std::size_t>& keys) {
  std::vector<std::pair<double, std::size_t>> order;
  for (const std::size_t k : keys) {
    const double correlation = rank_correlation(c, c.factors[k], c.responses[r]);
    order.emplace_back(std::isnan(correlation) ? 0.0 : -std::abs(correlation), k);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> out{order[0].second, order[1].second};
  std::sort(out.begin(), out.end());
  return out;
}

double median_of(const std::vector<double>& column) { return statistics_of(finite(column)).median; }

}  // namespace

plot::Figure contours(const Plan& plan, const Columns& c, std::size_t r) {
  const auto& f = plan.design.factors();
  plot::Figure figure;
  figure.name = fmt::format("contours_{}", r + 1);
  const plot::Axis of_response(plan.responses[r].name, c.units[r].empty() ? "-" : c.units[r]);
  std::vector<std::size_t> keys;
  for (std::size_t k = 0; k < f.size(); ++k)
    if (is_number(c.factors[k])) keys.push_back(k);
  if (keys.size() < 2) return figure;
  const bool lists =
      f.size() == 2 && !f[0].random() && !f[1].random() && f[0].file < 0 && f[1].file < 0;
  if (lists) {
    plot::Axes axes = of_lists(plan, c, r, of_response);
    if (axes.heat.empty()) return figure;
    figure.title = plan.responses[r].name + " over both keys";
    figure.caption = "linear between the runs, which are dots";
    figure.axes.push_back(std::move(axes));
    return figure;
  }
  std::vector<std::vector<double>> columns;
  std::vector<double> point;
  for (const std::size_t k : keys) {
    columns.push_back(c.factors[k]);
    point.push_back(median_of(c.factors[k]));
  }
  const auto fit = QuadraticFit::of(columns, c.responses[r]);
  if (!fit) return figure;
  const std::vector<std::size_t> two = most_important(c, r, keys);
  const auto place = [&keys](std::size_t k) {
    return static_cast<std::size_t>(std::find(keys.begin(), keys.end(), k) - keys.begin());
  };
  plot::Axes axes = axes_over(plan, two[0], two[1]);
  const Surface value = [&](double x, double y) {
    point[place(two[0])] = x;
    point[place(two[1])] = y;
    return fit->at(point);
  };
  fill(value, range_of(c.factors[two[0]]), range_of(c.factors[two[1]]), of_response, axes);
  if (axes.heat.empty()) return figure;
  auto [x, y] = pairs_of(c.factors[two[0]], c.factors[two[1]]);
  axes.series.push_back(dots(std::move(x), std::move(y)));
  figure.title = plan.responses[r].name + ", a quadratic through the samples";
  figure.caption = fmt::format(
      "least squares of {} runs (dots): standard deviation about the fit {:.3g}{}{}, {:.2g} % of "
      "the variance{}",
      fit->runs(), fit->residual(), of_response.unit == "-" ? "" : " ",
      of_response.unit == "-" ? "" : of_response.unit, 100 * fit->share_left(),
      keys.size() > 2 ? "; the other keys at their medians" : "");
  figure.axes.push_back(std::move(axes));
  return figure;
}

}  // namespace whirl::sweep
