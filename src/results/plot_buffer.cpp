#include <results/plot_buffer.hpp>

#include <algorithm>
#include <utility>

namespace whirl::results {

void PlotBuffer::append(const std::vector<double>& row) {
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
  if (rows_ % keep_stride_ == 0) {
    if (kept_.size() == rows_capacity_) {
      for (std::size_t i = 1; i < rows_capacity_ / 2; ++i)
        kept_[i] = std::move(kept_[2 * i]);
      kept_.resize(rows_capacity_ / 2);
      keep_stride_ *= 2;
    }
    if (rows_ % keep_stride_ == 0) kept_.push_back(row);
  }
  ++rows_;
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
  for (std::size_t n : {stride_, rows_, filled_, keep_stride_, data_.size(), kept_.size()})
    out.put_count(n);
  for (const Extreme& e : data_) {
    out.put(e.lo);
    out.put(e.hi);
    out.put(e.t_lo);
    out.put(e.t_hi);
  }
  for (const auto& row : kept_)
    out.put(row);
}

void PlotBuffer::restore(InArchive& in) {
  std::size_t data = 0, kept = 0;
  for (std::size_t* n : {&stride_, &rows_, &filled_, &keep_stride_, &data, &kept})
    *n = in.count();
  if (data > capacity_ * channels_ || kept > rows_capacity_)
    throw std::invalid_argument("plot buffer of another run");
  data_.resize(data);
  kept_.resize(kept);
  for (Extreme& e : data_) {
    e.lo = in.number();
    e.hi = in.number();
    e.t_lo = in.number();
    e.t_hi = in.number();
  }
  for (auto& row : kept_)
    row = in.numbers();
}

PlotBuffer::Points PlotBuffer::channel(std::size_t k) const {
  Points p;
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
  for (const double t : times) {
    const auto after = std::upper_bound(kept_.begin(), kept_.end(), t,
                                        [](double x, const auto& row) { return x < row[0]; });
    if (after == kept_.begin() || kept_.size() < 2) {
      out.push_back(kept_.empty() ? 0.0 : kept_.front()[k + 1]);
      continue;
    }
    const auto right = after == kept_.end() ? after - 1 : after;
    const std::vector<double>&a = *(right - 1), &b = *right;
    const double span = b[0] - a[0], x = span > 0 ? (t - a[0]) / span : 0.0;
    out.push_back(a[k + 1] + x * (b[k + 1] - a[k + 1]));
  }
  return out;
}

}  // namespace whirl::results
