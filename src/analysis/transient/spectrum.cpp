#include <analysis/transient/spectrum.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <array>
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

namespace {

/// Values at a place between uniform samples, by the polynomial through the twelve nearest.
class Between {
 public:
  /// @pre at least as many samples as the polynomial takes; 0 <= x <= samples - 1.
  Between(double x, std::size_t samples) {
    constexpr std::size_t before = points / 2 - 1;  // left of the interval of x
    const double first = std::clamp(std::floor(x) - static_cast<double>(before), 0.0,
                                    static_cast<double>(samples - points));
    first_ = static_cast<std::size_t>(first);
    double sum = 0;
    for (std::size_t j = 0; j < points; ++j) {
      const double distance = x - first - static_cast<double>(j);
      if (distance == 0) {
        weight_.fill(0.0);
        weight_[j] = 1.0;
        return;
      }
      weight_[j] = binomial[j] / distance;
      sum += weight_[j];
    }
    for (double& w : weight_)
      w /= sum;
  }
  double of(const std::vector<double>& values) const {
    double out = 0;
    for (std::size_t j = 0; j < points; ++j)
      out += weight_[j] * values[first_ + j];
    return out;
  }
  static constexpr std::size_t points = 12;

 private:
  /// Barycentric weights of equidistant points: binomial coefficients of alternating sign.
  static constexpr std::array<double, points> binomial{1,   -11,  55,  -165, 330, -462,
                                                       462, -330, 165, -55,  11,  -1};
  std::size_t first_;
  std::array<double, points> weight_{};
};

}  // namespace

Ridge strongest(const std::vector<double>& full, double resolution) {
  WHIRL_EXPECTS(full.size() % 2 == 1);
  const auto middle = static_cast<std::ptrdiff_t>(full.size() / 2),
             n = static_cast<std::ptrdiff_t>(full.size());
  const auto value = [&](std::ptrdiff_t k) { return full[static_cast<std::size_t>(k)]; };
  std::ptrdiff_t best = -1;
  for (std::ptrdiff_t k = 0; k < n; ++k)
    if (std::abs(k - middle) > 1 && (best < 0 || value(k) > value(best))) best = k;
  if (best < 0 || !(value(best) > 0)) return {};
  const double left = best > 0 ? value(best - 1) : 0.0,
               right = best + 1 < n ? value(best + 1) : 0.0;
  // a Hann window's own lines: (2 a - 1)/(a + 1) of a line away, a the ratio of the two highest
  const double ratio = std::max(left, right) / value(best),
               away = std::max(0.0, (2 * ratio - 1) / (ratio + 1)),
               rise = away > 0 ? pi * away * (1 - away * away) / std::sin(pi * away) : 1.0;
  const double line = static_cast<double>(best - middle) + (right >= left ? away : -away);
  return {line * resolution, rise * value(best)};
}

namespace {

/// From -1 to 1 along a block.
double place_in_block(std::size_t k, std::size_t length) {
  return 2.0 * static_cast<double>(k) / static_cast<double>(length) - 1.0;
}

}  // namespace

/// The straight line through a block, weighted as the window does: a sag, and a centre line that
/// moves with the speed. Oscillations of more than some lines have next to no part in it.
Spectra::Drift Spectra::drift_of(const std::vector<double>& values) const {
  double weight = 0, sum = 0, moment = 0, square = 0;
  for (std::size_t k = 0; k < length_; ++k) {
    const double x = place_in_block(k, length_), w = window_[k];
    weight += w;
    sum += w * values[k];
    moment += w * x * values[k];
    square += w * x * x;
  }
  return {sum / weight, moment / square};  // the window is even in x
}

void Spectra::spectrum_of(const std::vector<double>& y, const std::vector<double>& z,
                          std::vector<double>& full, std::vector<double>* one_sided_y,
                          std::vector<double>* one_sided_z) {
  const auto lines = static_cast<std::size_t>(options_.lines);
  const double scale = 2.0 / static_cast<double>(length_);  // 1 / sum of the window
  const Drift in_y = drift_of(y), in_z = drift_of(z);       // they would leak into the lowest lines
  for (std::size_t k = 0; k < length_; ++k) {
    const double x = place_in_block(k, length_);
    work_[k] =
        window_[k] * Complex(y[k] - in_y.mean - in_y.slope * x, z[k] - in_z.mean - in_z.slope * x);
  }
  fft(work_);
  for (std::size_t k = 0; k <= lines; ++k) {
    const Complex plus = scale * work_[k], minus = scale * work_[(length_ - k) % length_];
    full[lines + k] = std::abs(plus);
    full[lines - k] = std::abs(minus);
    // y and z are real: their spectra are the even and odd parts
    if (one_sided_y) (*one_sided_y)[k] = std::abs(plus + std::conj(minus));
    if (one_sided_z) (*one_sided_z)[k] = std::abs(plus - std::conj(minus));
  }
}

/// From three angles: a torsional vibration is no change of the speed.
void Spectra::find_change(double span) {
  const std::size_t half = length_ / 2 - 1;
  const double h = static_cast<double>(half) * interval_;
  block_.change = (phi_[2 * half] - 2 * phi_[half] + phi_[0]) / (h * h) * span;
}

/// The blocks of samples again, at equal angles of the reference. None where it does not turn one way.
void Spectra::take_equal_angles() {
  block_.ordered.clear();
  if (!(std::abs(block_.change) > block_.resolution) || length_ < Between::points) return;
  const double whole = phi_.back() - phi_.front();
  for (std::size_t k = 1; k < length_; ++k)
    if (!((phi_[k] - phi_[k - 1]) * whole > 0)) return;
  angle_y_.resize(probes_.size(), std::vector<double>(length_));
  angle_z_.resize(probes_.size(), std::vector<double>(length_));
  const double last = static_cast<double>(length_ - 1);
  std::size_t near = 0;
  for (std::size_t k = 0; k < length_; ++k) {
    const double target = phi_.front() + whole * static_cast<double>(k) / last;
    while (near + 2 < length_ && (phi_[near + 1] - target) * whole < 0)
      ++near;
    const double slope = phi_[near + 1] - phi_[near];
    double x = static_cast<double>(near) + (target - phi_[near]) / slope;
    for (int pass = 0; pass < 2; ++pass) {
      x = std::clamp(x, 0.0, last);
      x += (target - Between(x, length_).of(phi_)) / slope;
    }
    const Between at(std::clamp(x, 0.0, last), length_);
    for (std::size_t i = 0; i < probes_.size(); ++i) {
      angle_y_[i][k] = at.of(y_[i]);
      angle_z_[i][k] = at.of(z_[i]);
    }
  }
  block_.ordered.resize(probes_.size(), std::vector<double>(block_.full.front().size()));
  for (std::size_t i = 0; i < probes_.size(); ++i)
    spectrum_of(angle_y_[i], angle_z_[i], block_.ordered[i], nullptr, nullptr);
}

void Spectra::transform(double t_end) {
  const double span = static_cast<double>(length_ - 1) * interval_;
  block_.t = t_end - 0.5 * span;
  block_.speed = (phi_.back() - phi_.front()) / span;
  for (std::size_t i = 0; i < probes_.size(); ++i)
    spectrum_of(y_[i], z_[i], block_.full[i], &block_.y[i], &block_.z[i]);
  find_change(span);
  if (!probes_.empty()) take_equal_angles();
  block_.ridge.clear();
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    block_.ridge.push_back(strongest(block_.full[i], block_.resolution));
    if (block_.ordered.empty()) continue;
    const Ridge sharp = strongest(block_.ordered[i], block_.resolution);
    if (sharp.amplitude > block_.ridge.back().amplitude)
      block_.ridge.back() = {sharp.frequency, sharp.amplitude, true};
  }
  sink_(block_);
  keep_all_but(hop());
}

/// Samples from one block to the next. Half a block, where the speed is steady: what the window
/// takes from one it gives to the next. Where it changes, as many as it takes to change by a line.
std::size_t Spectra::hop() const {
  const double lines = std::abs(block_.change) / block_.resolution;
  std::size_t blocks = 2;
  while (static_cast<double>(blocks) < lines && blocks < most_overlapping)
    blocks *= 2;
  return std::max<std::size_t>(1, length_ / blocks);
}

void Spectra::keep_all_but(std::size_t first) {
  const auto begin = static_cast<std::ptrdiff_t>(first);
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    std::copy(y_[i].begin() + begin, y_[i].end(), y_[i].begin());
    std::copy(z_[i].begin() + begin, z_[i].end(), z_[i].begin());
  }
  std::copy(phi_.begin() + begin, phi_.end(), phi_.begin());
  filled_ = length_ - first;
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
