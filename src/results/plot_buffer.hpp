// Keeps the shape of arbitrarily long time histories in bounded memory: the extremes of every
// channel in buckets of time.
#pragma once
#include <core/archive.hpp>
#include <core/contract.hpp>
#include <cstddef>
#include <span>
#include <vector>

namespace whirl::results {

class PlotBuffer {
 public:
  /// Rows of one width, one behind the other.
  class Rows {
   public:
    using Row = std::span<const double>;
    class Iterator {
     public:
      Iterator(const double* at, std::size_t width) : at_(at), width_(width) {}
      Row operator*() const { return {at_, width_}; }
      Iterator& operator++() {
        at_ += width_;
        return *this;
      }
      bool operator!=(const Iterator& other) const { return at_ != other.at_; }

     private:
      const double* at_;
      std::size_t width_;
    };
    Rows(std::span<const double> values, std::size_t width) : values_(values), width_(width) {
      WHIRL_EXPECTS(width > 0 && values.size() % width == 0);
    }
    std::size_t size() const { return values_.size() / width_; }
    bool empty() const { return values_.empty(); }
    Row operator[](std::size_t row) const { return values_.subspan(row * width_, width_); }
    Iterator begin() const { return {values_.data(), width_}; }
    Iterator end() const { return {values_.data() + values_.size(), width_}; }

   private:
    std::span<const double> values_;
    std::size_t width_;
  };

  /// channels: values a row beside the time. capacity: buckets kept (rows themselves, until there
  /// are more). rows: whole ones kept, an even number.
  explicit PlotBuffer(std::size_t channels, std::size_t capacity = 1 << 14,
                      std::size_t rows = 1 << 16)
      : channels_(channels),
        capacity_(capacity),
        rows_capacity_(rows) {}
  /// row[0] is the time.
  /// @pre a value a channel and the time.
  void append(std::span<const double> row);
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
  /// Good until the next append().
  Rows kept_rows() const { return {kept_, channels_ + 1}; }

 private:
  struct Extreme {
    double lo, hi, t_lo, t_hi;
  };
  static_assert(sizeof(Extreme) == 4 * sizeof(double));
  void fill_buckets();
  void widen(std::span<const double> row);
  void keep(std::span<const double> row);
  void halve();
  std::size_t channels_, capacity_, rows_capacity_, stride_ = 1, rows_ = 0, filled_ = 0;
  std::vector<Extreme> data_;  ///< bucket-major; none while the kept rows are all there were
  std::vector<double> kept_;   ///< row by row
  std::size_t keep_stride_ = 1;
};

}  // namespace whirl::results
