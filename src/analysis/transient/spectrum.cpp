#include <analysis/transient/spectrum.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

void fft(std::vector<Complex>& x) {
  WHIRL_EXPECTS(!x.empty() && (x.size() & (x.size() - 1)) == 0);
  // Cooley and Tukey, radix 2: bit reversal, then butterflies.
  const std::size_t n = x.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1)
      j ^= bit;
    j ^= bit;
    if (i < j) std::swap(x[i], x[j]);
  }
  for (std::size_t length = 2; length <= n; length <<= 1) {
    const std::size_t half = length / 2;
    for (std::size_t k = 0; k < half; ++k) {
      const Complex w =
          std::polar(1.0, -two_pi * static_cast<double>(k) / static_cast<double>(length));
      for (std::size_t i = k; i < n; i += length) {
        const Complex u = x[i], v = w * x[i + half];
        x[i] = u + v;
        x[i + half] = u - v;
      }
    }
  }
}

namespace {

/// At least four samples a period of the highest frequency reported: content up to three times it
/// does not fold into view.
std::size_t block_length(int lines) {
  WHIRL_EXPECTS(lines > 0);
  std::size_t n = 1;
  while (n < 4 * static_cast<std::size_t>(lines))
    n <<= 1;
  return n;
}

}  // namespace

Spectra::Spectra(std::vector<Point> probes, Index reference, double t_begin,
                 SpectrumOptions options, Sink sink)
    : probes_(std::move(probes)),
      reference_(reference),
      options_(options),
      sink_(std::move(sink)),
      length_(block_length(options.lines)),
      interval_(two_pi * options.lines / options.max_frequency / static_cast<double>(length_)),
      ticker_(t_begin, interval_),
      phi_(length_),
      window_(length_),
      work_(length_) {
  WHIRL_EXPECTS(options_.max_frequency > 0.0 && sink_ != nullptr);
  y_.assign(probes_.size(), std::vector<double>(length_));
  z_ = y_;
  for (std::size_t k = 0; k < length_; ++k)
    window_[k] =
        0.5 - 0.5 * std::cos(two_pi * static_cast<double>(k) / static_cast<double>(length_));
  const auto lines = static_cast<std::size_t>(options.lines);
  block_.resolution = options.max_frequency / options.lines;
  block_.full.assign(probes_.size(), std::vector<double>(2 * lines + 1));
  block_.y.assign(probes_.size(), std::vector<double>(lines + 1));
  block_.z = block_.y;
}

void Spectra::begin(const Snapshot& s) {
  while (ticker_.next() < s.t() - 1e-9 * interval_)
    ticker_.advance();
  filled_ = 0;
  if (std::abs(ticker_.next() - s.t()) <= 1e-9 * interval_) {
    take(s);
    ticker_.advance();
  }
}

void Spectra::take(const Snapshot& s) {
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    const Vec3 u = displacement(s, probes_[i]);
    y_[i][filled_] = u.y();
    z_[i][filled_] = u.z();
  }
  phi_[filled_++] = s.total_phi(reference_);
  if (filled_ == length_) transform(s.t());
}

void Spectra::transform(double t_end) {
  const double span = static_cast<double>(length_ - 1) * interval_;
  block_.t = t_end - 0.5 * span;
  block_.speed = (phi_.back() - phi_.front()) / span;
  const auto lines = static_cast<std::size_t>(options_.lines);
  const double scale = 2.0 / static_cast<double>(length_);  // 1 / sum of the window
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    double mean_y = 0.0, mean_z = 0.0;  // a sag leaks into the lowest lines
    for (std::size_t k = 0; k < length_; ++k) {
      mean_y += y_[i][k];
      mean_z += z_[i][k];
    }
    mean_y /= static_cast<double>(length_);
    mean_z /= static_cast<double>(length_);
    for (std::size_t k = 0; k < length_; ++k)
      work_[k] = window_[k] * Complex(y_[i][k] - mean_y, z_[i][k] - mean_z);
    fft(work_);
    for (std::size_t k = 0; k <= lines; ++k) {
      const Complex plus = scale * work_[k], minus = scale * work_[(length_ - k) % length_];
      block_.full[i][lines + k] = std::abs(plus);
      block_.full[i][lines - k] = std::abs(minus);
      // y and z are real: their spectra are the even and odd parts
      block_.y[i][k] = std::abs(plus + std::conj(minus));
      block_.z[i][k] = std::abs(plus - std::conj(minus));
    }
  }
  sink_(block_);
  // half overlap: what the window takes from one block it gives to the next
  const std::size_t half = length_ / 2;
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    std::copy(y_[i].begin() + static_cast<std::ptrdiff_t>(half), y_[i].end(), y_[i].begin());
    std::copy(z_[i].begin() + static_cast<std::ptrdiff_t>(half), z_[i].end(), z_[i].begin());
  }
  std::copy(phi_.begin() + static_cast<std::ptrdiff_t>(half), phi_.end(), phi_.begin());
  filled_ = half;
}

void Spectra::step(StepAccess& s) {
  for (const double slack = 1e-9 * interval_; ticker_.next() <= s.t1() + slack; ticker_.advance())
    take(s.at(std::min(ticker_.next(), s.t1())));
}

void Spectra::save(OutArchive& out) const {
  out.put_count(static_cast<std::uint64_t>(ticker_.count()));
  out.put_count(filled_);
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    out.put(std::span<const double>(y_[i].data(), filled_));
    out.put(std::span<const double>(z_[i].data(), filled_));
  }
  out.put(std::span<const double>(phi_.data(), filled_));
}

void Spectra::restore(InArchive& in) {
  ticker_.set_count(static_cast<long>(in.count()));
  filled_ = in.count();
  const auto take_back = [&](std::vector<double>& x) {
    const std::vector<double> saved = in.numbers();
    if (saved.size() > x.size()) throw std::invalid_argument("spectra of another run");
    std::copy(saved.begin(), saved.end(), x.begin());
  };
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    take_back(y_[i]);
    take_back(z_[i]);
  }
  take_back(phi_);
}

}  // namespace whirl::analysis
