// Keeps of a running time series what its plots need, in bounded memory: the envelope of every
// column and the last rows.
#pragma once
#include <plot/decimate.hpp>
#include <io/results.hpp>

namespace whirl::io {

class Collector final : public TimeSeries {
 public:
  /// bins: of each column's envelope (see Envelope). last_rows: newest rows kept whole (orbits,
  /// spectra of the end).
  explicit Collector(std::size_t bins = 4096, std::size_t last_rows = 0)
      : bins_(bins),
        keep_(last_rows) {}
  void begin(std::span<const Channel> channels) override;
  /// Begins anew: the rows of the earlier run are not here. replay() them from their file to have
  /// them.
  void resume(std::span<const Channel> channels, std::uint64_t rows) override;
  void append(std::span<const double> row) override;
  void flush() override {}
  void close() override {}
  std::uint64_t rows() const override { return rows_; }

  const std::vector<Channel>& channels() const { return channels_; }
  std::size_t width() const { return scale_.size(); }
  /// First column (time) and column k of the whole run, thinned; written units.
  void curve(std::size_t column, std::vector<double>& x, std::vector<double>& y) const {
    envelopes_[column].points(x, y);
  }
  /// The last rows, oldest first; written units.
  Columns last() const;

 private:
  std::size_t bins_, keep_;
  std::vector<Channel> channels_;
  std::vector<double> scale_, scaled_, ring_;
  std::vector<plot::Envelope> envelopes_;
  std::uint64_t rows_ = 0;
};

/// Appends the first `rows` rows of a series that was read back to a sink that scales like the one
/// that wrote them.
void replay(const Columns& from, std::span<const Channel> channels, std::uint64_t rows,
            TimeSeries& to);

}  // namespace whirl::io
