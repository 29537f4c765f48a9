#include <plot/decimate.hpp>
#include <algorithm>
#include <cstdint>
#include <array>
#include <cmath>

namespace whirl::plot {

bool is_increasing(std::span<const double> x) {
  double last = -INFINITY;
  for (const double v : x) {
    if (v < last) return false;
    if (!std::isnan(v)) last = v;
  }
  return true;
}

std::vector<std::size_t> decimate_columns(std::span<const double> x, std::span<const double> y,
                                          double x0, double x1, std::size_t columns) {
  std::vector<std::size_t> keep;
  const std::size_t n = x.size();
  const double scale = static_cast<double>(columns) / (x1 - x0);
  std::ptrdiff_t column = -2;
  std::size_t first = 0, low = 0, high = 0, last = 0;
  bool open = false, gap = false;
  const auto close = [&] {
    if (!open) return;
    std::array<std::size_t, 4> k{first, low, high, last};
    std::sort(k.begin(), k.end());
    for (std::size_t j = 0; j < 4; ++j)
      if (j == 0 || k[j] != k[j - 1]) keep.push_back(k[j]);
    open = false;
  };
  for (std::size_t i = 0; i < n; ++i) {
    if (std::isnan(x[i]) || std::isnan(y[i])) {
      close();
      if (!gap) keep.push_back(i);
      gap = true;
      continue;
    }
    gap = false;
    // Everything left of the range is one column and everything right of it another: enough for the
    // lines that cross.
    const double c = std::floor((x[i] - x0) * scale);
    const auto now =
        c < 0 ? std::ptrdiff_t{-1}
        : c >= static_cast<double>(columns) && x[i] > x1
            ? static_cast<std::ptrdiff_t>(columns)
            : std::min(static_cast<std::ptrdiff_t>(c), static_cast<std::ptrdiff_t>(columns) - 1);
    if (!open || now != column) {
      close();
      open = true;
      column = now;
      first = low = high = i;
    }
    if (y[i] < y[low]) low = i;
    if (y[i] > y[high]) high = i;
    last = i;
  }
  close();
  return keep;
}

namespace {

/// A set of segments from cell to cell.
class Segments {
 public:
  using Key = std::array<std::int32_t, 4>;
  /// most: that will be inserted.
  explicit Segments(std::size_t most) {
    std::size_t places = 16;
    while (places < 2 * most)
      places *= 2;
    keys_.resize(places);
    used_.resize(places);
  }
  /// Whether it is new.
  bool insert(const Key& key) {
    std::size_t at = hash(key) & (keys_.size() - 1);
    for (; used_[at]; at = (at + 1) & (keys_.size() - 1))
      if (keys_[at] == key) return false;
    used_[at] = 1;
    keys_[at] = key;
    return true;
  }

 private:
  static std::size_t hash(const Key& key) {
    std::uint64_t h = 0x9E3779B97F4A7C15ull;
    for (const auto v : key) {
      h = (h ^ static_cast<std::uint32_t>(v)) * 0xBF58476D1CE4E5B9ull;
      h ^= h >> 29;
    }
    return h;
  }

  std::vector<Key> keys_;
  std::vector<unsigned char> used_;
};

}  // namespace

std::vector<std::vector<std::size_t>> decimate_path(std::span<const double> px,
                                                    std::span<const double> py, double cell) {
  Segments drawn(px.size());
  std::vector<std::vector<std::size_t>> runs;
  const auto grid = [&](double v) {
    return static_cast<std::int32_t>(std::lround(std::clamp(v / cell, -1e8, 1e8)));
  };
  bool have = false, joined = false;
  std::size_t from = 0;
  std::int32_t gx = 0, gy = 0;
  for (std::size_t i = 0; i < px.size(); ++i) {
    if (std::isnan(px[i]) || std::isnan(py[i])) {
      have = joined = false;
      continue;
    }
    const std::int32_t hx = grid(px[i]), hy = grid(py[i]);
    if (!have) {
      have = true;
      joined = false;
      from = i;
      gx = hx;
      gy = hy;
      continue;
    }
    if (hx == gx && hy == gy) continue;  // within one cell
    // The same segment backwards looks the same.
    std::array<std::int32_t, 4> key{gx, gy, hx, hy};
    if (std::pair(hx, hy) < std::pair(gx, gy)) key = {hx, hy, gx, gy};
    if (drawn.insert(key)) {
      if (!joined) runs.push_back({from});
      runs.back().push_back(i);
      joined = true;
    } else
      joined = false;
    from = i;
    gx = hx;
    gy = hy;
  }
  if (runs.empty() && have) runs.push_back({from});
  return runs;
}

}  // namespace whirl::plot
