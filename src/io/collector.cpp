#include <io/collector.hpp>
#include <algorithm>
#include <stdexcept>

namespace whirl::io {

void Collector::begin(std::span<const Channel> channels) {
  channels_.assign(channels.begin(), channels.end());
  scale_.clear();
  for (const auto& c : channels)
    scale_.insert(scale_.end(), c.width(), c.scale);
  scaled_.assign(scale_.size(), 0.0);
  envelopes_.assign(scale_.size(), plot::Envelope(bins_));
  ring_.assign(keep_ * scale_.size(), 0.0);
  rows_ = 0;
}

void Collector::resume(std::span<const Channel> channels, std::uint64_t) { begin(channels); }

void Collector::append(std::span<const double> row) {
  if (row.size() != scale_.size())
    throw std::logic_error("TimeSeries: row of the wrong length, or not begun");
  for (std::size_t k = 0; k < row.size(); ++k) {
    scaled_[k] = scale_[k] * row[k];
    envelopes_[k].add(scaled_[0], scaled_[k]);
  }
  if (keep_ > 0)
    std::copy(scaled_.begin(), scaled_.end(),
              ring_.begin() + static_cast<std::ptrdiff_t>(rows_ % keep_ * row.size()));
  ++rows_;
}

Columns Collector::last() const {
  Columns c;
  for (const auto& ch : channels_)
    for (std::size_t k = 0; k < ch.width(); ++k) {
      c.names.push_back(ch.column(k));
      c.units.push_back(ch.unit);
    }
  c.values.resize(scale_.size());
  const std::uint64_t n = std::min<std::uint64_t>(rows_, keep_);
  for (std::uint64_t i = rows_ - n; i < rows_; ++i)
    for (std::size_t k = 0; k < scale_.size(); ++k)
      c.values[k].push_back(ring_[i % keep_ * scale_.size() + k]);
  return c;
}

void replay(const Columns& from, std::span<const Channel> channels, std::uint64_t rows,
            TimeSeries& to) {
  std::vector<double> scale, row;
  for (const auto& c : channels)
    scale.insert(scale.end(), c.width(), c.scale);
  if (from.values.size() != scale.size()) throw std::logic_error("replay: other columns");
  row.resize(scale.size());
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(rows, from.rows()); ++i) {
    for (std::size_t k = 0; k < row.size(); ++k)
      row[k] = from.values[k][i] / scale[k];
    to.append(row);
  }
}

}  // namespace whirl::io
