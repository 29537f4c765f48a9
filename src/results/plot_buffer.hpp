// Keeps the shape of arbitrarily long time histories in bounded memory: the extremes of every
// channel in buckets of time.
#pragma once
#include <core/archive.hpp>
#include <cstddef>
#include <vector>

namespace whirl::results {

class PlotBuffer {
 public:
  /// channels: values a row beside the time. capacity: buckets kept (rows themselves, until there
  /// are more). rows: whole ones kept, an even number.
  explicit PlotBuffer(std::size_t channels, std::size_t capacity = 1 << 14,
                      std::size_t rows = 1 << 16)
      : channels_(channels),
        capacity_(capacity),
        rows_capacity_(rows) {}
  /// row[0] is the time.
  void append(const std::vector<double>& row);
  /// Points of one channel: the rows themselves while they fit, else minimum and maximum of each
  /// bucket in order of time.
  struct Points {
    std::vector<double> t, y;
  };
  Points channel(std::size_t k) const;
  /// Of a channel without sudden changes: its values at times, straight between kept rows.
  std::vector<double> values_at(std::size_t k, const std::vector<double>& times) const;
  std::size_t rows() const { return rows_; }
  void save(OutArchive& out) const;
  void restore(InArchive& in);
  /// Whole rows (time first), every stride-th of them: for paths, where columns belong together.
  const std::vector<std::vector<double>>& kept_rows() const { return kept_; }

 private:
  struct Extreme {
    double lo, hi, t_lo, t_hi;
  };
  void halve();
  std::size_t channels_, capacity_, rows_capacity_, stride_ = 1, rows_ = 0, filled_ = 0;
  std::vector<Extreme> data_;  // bucket-major
  std::vector<std::vector<double>> kept_;
  std::size_t keep_stride_ = 1;
};

}  // namespace whirl::results
