// Fewer points, the same picture.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace whirl::plot {

/// Indices to draw of a curve whose x does not decrease: of each of `columns` equal columns of [x0,
/// x1] the first, lowest, highest and last point. Points outside keep one neighbour on each side.
/// nan points are kept (they break the line), one of a row of them. The lowest and highest value of
/// every column survive exactly.
std::vector<std::size_t> decimate_columns(std::span<const double> x, std::span<const double> y,
                                          double x0, double x1, std::size_t columns);

/// For curves that go anywhere (orbits), in px: pieces of the path whose segments are new on a grid
/// of `cell` px. Segments that would be drawn over an earlier one are left out. Returns runs of
/// point indices.
std::vector<std::vector<std::size_t>> decimate_path(std::span<const double> px,
                                                    std::span<const double> py, double cell = 0.5);

/// True when no value is below its predecessor (nan ignored).
bool is_increasing(std::span<const double> x);

/// Keeps the picture of an endless curve in bounded memory: at most `bins` bins of equally many
/// points, each with its first, lowest, highest and last point; when full, neighbours merge.
/// Extremes survive exactly.
class Envelope {
 public:
  explicit Envelope(std::size_t bins = 4096);
  void add(double x, double y);
  /// The points kept so far, in order.
  void points(std::vector<double>& x, std::vector<double>& y) const;
  std::uint64_t count() const { return count_; }

 private:
  struct Point {
    double x, y;
    std::uint64_t order;
  };
  struct Bin {
    Point first, low, high, last;
  };
  std::size_t most_;
  std::uint64_t per_bin_ = 1, in_last_ = 0, count_ = 0;
  std::vector<Bin> bins_;
};

}  // namespace whirl::plot
