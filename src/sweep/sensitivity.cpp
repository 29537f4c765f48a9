#include <sweep/sensitivity.hpp>
#include <sweep/sampling.hpp>
#include <core/contract.hpp>
#include <core/types.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::sweep {
namespace {

/// First and total index of one dimension from the points named; nan when nothing varies.
struct Shares {
  double first, total;
};
Shares shares_of(std::span<const double> response, std::size_t dimensions, std::size_t dimension,
                 const std::vector<std::size_t>& points) {
  const std::size_t each = dimensions + 2;
  double sum = 0, squares = 0;
  const auto n = static_cast<double>(points.size());
  for (const std::size_t p : points)
    sum += response[p * each] + response[p * each + 1];
  const double mean = sum / (2 * n);
  double alone = 0, by_own = 0;
  for (const std::size_t p : points) {
    const double a = response[p * each], b = response[p * each + 1];
    const double mixed = response[p * each + 2 + dimension];
    squares += (a - mean) * (a - mean) + (b - mean) * (b - mean);
    alone += (b - mean) * (mixed - a);
    by_own += (a - mixed) * (a - mixed);
  }
  const double variance = squares / (2 * n - 1);
  if (!(variance > 0)) return {nan, nan};
  return {alone / (n * variance), by_own / (2 * n * variance)};
}

double deviation_of(const std::vector<double>& x) {
  double mean = 0, squares = 0;
  const auto n = static_cast<double>(x.size());
  for (const double v : x)
    mean += v / n;
  for (const double v : x)
    squares += (v - mean) * (v - mean);
  return x.size() > 1 ? std::sqrt(squares / (n - 1)) : 0.0;
}

/// Runs first .. first + count - 1 all gave a value.
bool all_known(std::span<const double> response, std::size_t first, std::size_t count) {
  const auto part = response.subspan(first, count);
  return std::none_of(part.begin(), part.end(), [](double x) { return std::isnan(x); });
}

}  // namespace

std::vector<SobolIndex> sobol_indices(std::span<const double> response, std::size_t dimensions,
                                      std::size_t& used) {
  const std::size_t each = dimensions + 2;
  WHIRL_EXPECTS(dimensions > 0 && response.size() % each == 0);
  std::vector<std::size_t> points;
  for (std::size_t p = 0; p < response.size() / each; ++p)
    if (all_known(response, p * each, each)) points.push_back(p);
  used = points.size();
  if (used < 2) return {};
  std::vector<SobolIndex> out;
  constexpr std::int64_t resamples = 200;
  for (std::size_t j = 0; j < dimensions; ++j) {
    const Shares whole = shares_of(response, dimensions, j, points);
    if (std::isnan(whole.first)) return {};
    std::vector<double> first, total;
    std::vector<std::size_t> drawn(used);
    for (std::int64_t r = 0; r < resamples; ++r) {
      for (std::size_t k = 0; k < used; ++k) {
        const double u =
            random_point(static_cast<std::uint64_t>(r), 0, static_cast<std::int64_t>(k));
        drawn[k] =
            points[std::min(used - 1, static_cast<std::size_t>(u * static_cast<double>(used)))];
      }
      const Shares s = shares_of(response, dimensions, j, drawn);
      if (std::isnan(s.first)) continue;
      first.push_back(s.first);
      total.push_back(s.total);
    }
    out.push_back({whole.first, whole.total, deviation_of(first), deviation_of(total)});
  }
  return out;
}

std::vector<MorrisEffect> morris_effects(std::span<const double> response, std::size_t dimensions,
                                         unsigned long long seed) {
  const std::size_t each = dimensions + 1;
  WHIRL_EXPECTS(dimensions > 0 && response.size() % each == 0);
  std::vector<std::vector<double>> effects(dimensions);
  for (std::size_t path = 0; path < response.size() / each; ++path)
    for (std::size_t k = 0; k + 1 < each; ++k) {
      const std::size_t run = path * each + k;
      if (!all_known(response, run, 2)) continue;
      const auto number = static_cast<std::int64_t>(path);
      const std::size_t j = morris_moved(seed, dimensions, number, k);
      const double moved = morris_level(seed, j, dimensions, static_cast<std::int64_t>(run) + 1) -
                           morris_level(seed, j, dimensions, static_cast<std::int64_t>(run));
      effects[j].push_back((response[run + 1] - response[run]) / moved);
    }
  std::vector<MorrisEffect> out;
  for (const std::vector<double>& e : effects) {
    MorrisEffect m;
    m.paths = e.size();
    for (const double x : e) {
      m.mean += x / static_cast<double>(e.size());
      m.magnitude += std::abs(x) / static_cast<double>(e.size());
    }
    if (e.empty()) m.mean = m.magnitude = nan;
    m.deviation = e.empty() ? nan : deviation_of(e);
    out.push_back(m);
  }
  return out;
}

}  // namespace whirl::sweep
