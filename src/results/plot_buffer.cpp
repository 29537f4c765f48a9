#include <results/plot_buffer.hpp>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace whirl::results {

void PlotBuffer::append(std::span<const double> row) {
  WHIRL_EXPECTS(row.size() == channels_ + 1);
  if (data_.empty() && rows_ == std::min(capacity_, rows_capacity_)) fill_buckets();
  if (!data_.empty()) widen(row);
  if (rows_ % keep_stride_ == 0) keep(row);
  ++rows_;
}

/// A bucket a row so far.
void PlotBuffer::fill_buckets() {
  data_.reserve(capacity_ * channels_);
  for (const Rows::Row row : kept_rows())
    for (std::size_t k = 0; k < channels_; ++k)
      data_.push_back({row[k + 1], row[k + 1], row[0], row[0]});
}

void PlotBuffer::widen(std::span<const double> row) {
  if (filled_ == 0) {
    if (data_.size() == capacity_ * channels_) halve();
    for (std::size_t k = 0; k < channels_; ++k)
      data_.push_back({row[k + 1], row[k + 1], row[0], row[0]});
  } else {
    Extreme* bucket = data_.data() + data_.size() - channels_;
    for (std::size_t k = 0; k < channels_; ++k) {
      const double y = row[k + 1];
      if (y < bucket[k].lo) {
        bucket[k].lo = y;
        bucket[k].t_lo = row[0];
      }
      if (y > bucket[k].hi) {
        bucket[k].hi = y;
        bucket[k].t_hi = row[0];
      }
    }
  }
  if (++filled_ == stride_) filled_ = 0;
}

void PlotBuffer::keep(std::span<const double> row) {
  const std::size_t width = channels_ + 1;
  if (kept_.size() == rows_capacity_ * width) {
    for (std::size_t i = 1; i < rows_capacity_ / 2; ++i)
      std::copy_n(&kept_[2 * i * width], width, &kept_[i * width]);
    kept_.resize(rows_capacity_ / 2 * width);
    keep_stride_ *= 2;
  }
  if (rows_ % keep_stride_ == 0) kept_.insert(kept_.end(), row.begin(), row.end());
}

void PlotBuffer::halve() {
  const std::size_t half = capacity_ / 2;
  for (std::size_t b = 0; b < half; ++b)
    for (std::size_t k = 0; k < channels_; ++k) {
      const Extreme &x = data_[2 * b * channels_ + k], &y = data_[(2 * b + 1) * channels_ + k];
      Extreme& out = data_[b * channels_ + k];
      const Extreme merged{x.lo <= y.lo ? x.lo : y.lo, x.hi >= y.hi ? x.hi : y.hi,
                           x.lo <= y.lo ? x.t_lo : y.t_lo, x.hi >= y.hi ? x.t_hi : y.t_hi};
      out = merged;
    }
  data_.resize(half * channels_);
  stride_ *= 2;
}

void PlotBuffer::save(OutArchive& out) const {
  // tens of megabytes in a long run: as they stand, and moved once
  const std::string_view extremes(reinterpret_cast<const char*>(data_.data()),
                                  data_.size() * sizeof(Extreme));
  out.reserve(out.data().size() + extremes.size() + 8 * kept_.size() + 64);
  for (std::size_t n : {stride_, rows_, filled_, keep_stride_})
    out.put_count(n);
  out.put(extremes);
  out.put(kept_);
}

void PlotBuffer::restore(InArchive& in) {
  for (std::size_t* n : {&stride_, &rows_, &filled_, &keep_stride_})
    *n = in.count();
  const std::string extremes = in.text();
  kept_ = in.numbers();
  const std::size_t width = channels_ + 1;
  if (extremes.size() % sizeof(Extreme) != 0 ||
      extremes.size() > sizeof(Extreme) * capacity_ * channels_ || kept_.size() % width != 0 ||
      kept_.size() > rows_capacity_ * width)
    throw std::invalid_argument("plot buffer of another run");
  data_.resize(extremes.size() / sizeof(Extreme));
  if (!data_.empty()) std::memcpy(data_.data(), extremes.data(), extremes.size());
}

PlotBuffer::Points PlotBuffer::channel(std::size_t k) const {
  Points p;
  if (data_.empty()) {
    for (const Rows::Row row : kept_rows()) {
      p.t.push_back(row[0]);
      p.y.push_back(row[k + 1]);
    }
    return p;
  }
  const std::size_t n = channels_ ? data_.size() / channels_ : 0;
  for (std::size_t b = 0; b < n; ++b) {
    const Extreme& x = data_[b * channels_ + k];
    if (x.t_lo == x.t_hi) {
      p.t.push_back(x.t_lo);
      p.y.push_back(x.lo);
      continue;
    }
    const bool low_first = x.t_lo < x.t_hi;
    p.t.push_back(low_first ? x.t_lo : x.t_hi);
    p.y.push_back(low_first ? x.lo : x.hi);
    p.t.push_back(low_first ? x.t_hi : x.t_lo);
    p.y.push_back(low_first ? x.hi : x.lo);
  }
  return p;
}

std::vector<double> PlotBuffer::values_at(std::size_t k, const std::vector<double>& times) const {
  std::vector<double> out;
  out.reserve(times.size());
  const Rows kept = kept_rows();
  for (const double t : times) {
    if (kept.size() < 2) {
      out.push_back(kept.empty() ? 0.0 : kept[0][k + 1]);
      continue;
    }
    std::size_t low = 0, high = kept.size();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      if (t < kept[middle][0])
        high = middle;
      else
        low = middle + 1;
    }
    const std::size_t after = low;  // the first row beyond the time
    if (after == 0) {
      out.push_back(kept[0][k + 1]);
      continue;
    }
    const std::size_t right = after == kept.size() ? after - 1 : after;
    const Rows::Row a = kept[right - 1], b = kept[right];
    const double span = b[0] - a[0], x = span > 0 ? (t - a[0]) / span : 0.0;
    out.push_back(a[k + 1] + x * (b[k + 1] - a[k + 1]));
  }
  return out;
}

}  // namespace whirl::results
