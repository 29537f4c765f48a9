#include <analysis/transient/order_filter.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace whirl::analysis {

OrderFilter::OrderFilter(std::size_t probes, std::vector<double> orders, int samples, int turns,
                         Sink sink)
    : orders_(std::move(orders)),
      samples_(static_cast<std::size_t>(samples)),
      side_(static_cast<std::size_t>(turns / 2)),
      sink_(std::move(sink)) {
  WHIRL_EXPECTS(samples > 0 && turns > 0 && sink_ != nullptr);
  for (std::size_t half = 0; half <= side_; ++half)
    windows_.push_back(make_window(half, std::min(2 * static_cast<int>(half) + 1, turns)));
  Turn empty;
  empty.n = samples;
  empty.y.assign(probes, std::vector<double>(samples_ + 1));
  empty.z = empty.y;
  kept_.assign(2 * side_ + 1, empty);
  y_.resize(probes * orders_.size());
  z_.resize(y_.size());
}

OrderFilter::Window OrderFilter::make_window(std::size_t half, int turns) const {
  Window w;
  const double n = static_cast<double>(samples_), reach = 0.5 * turns * n;
  const std::size_t last = (2 * half + 1) * samples_;
  w.kernel.resize(orders_.size());
  for (std::size_t p = 0; p <= last; ++p) {
    const double from_start = static_cast<double>(p) - static_cast<double>(half * samples_);
    const double from_middle = from_start - 0.5 * n;
    double weight = p == 0 || p == last ? 0.5 : 1.0;
    if (turns > 1)
      weight = std::abs(from_middle) < reach ? 1.0 + std::cos(pi * from_middle / reach) : 0.0;
    w.sum += weight;
    w.weight.push_back(weight);
    for (std::size_t k = 0; k < orders_.size(); ++k)
      w.kernel[k].push_back(weight * std::polar(1.0, -orders_[k] * two_pi * from_start / n));
  }
  return w;
}

bool OrderFilter::follows(const Turn& turn) const {
  const Turn& before = kept_[count_ - 1];
  return turn.backward == before.backward &&
         turn.number == before.number + (turn.backward ? -1 : 1);
}

void OrderFilter::take(const Turn& turn) {
  WHIRL_EXPECTS(turn.n == static_cast<int>(samples_) &&
                turn.y.size() * orders_.size() == y_.size());
  if (count_ > 0 && !follows(turn)) end();
  if (count_ == kept_.size()) {
    std::rotate(kept_.begin(), kept_.begin() + 1, kept_.end());
    --count_;
    --next_;
  }
  kept_[count_++] = turn;
  if (count_ < kept_.size()) return;
  while (next_ <= side_)
    give(next_++);
}

void OrderFilter::end() {
  while (next_ < count_)
    give(next_++);
  count_ = next_ = 0;
}

void OrderFilter::give(std::size_t turn) {
  const bool full = count_ == kept_.size();
  const std::size_t centre = full ? side_ : turn;
  const std::size_t half = full ? side_ : std::min(turn, count_ - 1 - turn);
  for (std::size_t i = 0; i < y_.size(); ++i) {
    const std::size_t probe = i / orders_.size(), order = i % orders_.size();
    const bool is_whole = orders_[order] == std::round(orders_[order]);
    if (!is_whole && !full) {
      y_[i] = z_[i] = Complex(nan, nan);
      continue;
    }
    y_[i] = amplitude(&Turn::y, probe, order, centre, half);
    z_[i] = amplitude(&Turn::z, probe, order, centre, half);
  }
  sink_(kept_[turn], y_, z_, std::span(kept_).subspan(centre - half, 2 * half + 1));
}

Complex OrderFilter::amplitude(Direction direction, std::size_t probe, std::size_t order,
                               std::size_t centre, std::size_t half) const {
  const Window& w = windows_[half];
  const std::vector<Complex>& kernel = w.kernel[order];
  Complex sum = 0.0, of_constant = 0.0;
  double mean = 0.0;
  std::size_t p = 0;
  for (std::size_t k = centre - half; k <= centre + half; ++k) {
    const std::vector<double>& x = (kept_[k].*direction)[probe];
    // a turn ends where the next begins
    const std::size_t end = k == centre + half ? samples_ + 1 : samples_;
    for (std::size_t j = 0; j < end; ++j, ++p) {
      sum += x[j] * kernel[p];
      mean += x[j] * w.weight[p];
      of_constant += kernel[p];
    }
  }
  const double order_value = orders_[order];
  if (order_value == 0.0) return mean / w.sum;
  // where the window does not see to it that a constant gives nothing
  sum -= mean / w.sum * of_constant;
  sum *= 2.0 / w.sum;
  const Turn& middle = kept_[centre];
  const double marks = order_value * static_cast<double>(middle.number + (middle.backward ? 1 : 0));
  const Complex start = std::polar(1.0, -two_pi * std::remainder(marks, 1.0));
  return (middle.backward ? std::conj(sum) : sum) * start;
}

void OrderFilter::save(OutArchive& out) const {
  out.put_count(count_);
  out.put_count(next_);
  for (std::size_t k = 0; k < count_; ++k) {
    const Turn& turn = kept_[k];
    for (const double x :
         {static_cast<double>(turn.number), turn.t0, turn.t1, turn.backward ? 1.0 : 0.0})
      out.put(x);
    for (std::size_t i = 0; i < turn.y.size(); ++i) {
      out.put(turn.y[i]);
      out.put(turn.z[i]);
    }
  }
}

void OrderFilter::restore(InArchive& in) {
  count_ = in.count();
  next_ = in.count();
  if (count_ > kept_.size() || next_ > count_)
    throw std::invalid_argument("tracking filter of another run");
  for (std::size_t k = 0; k < count_; ++k) {
    Turn& turn = kept_[k];
    turn.number = static_cast<long>(in.number());
    turn.t0 = in.number();
    turn.t1 = in.number();
    turn.backward = in.number() != 0.0;
    for (std::size_t i = 0; i < turn.y.size(); ++i) {
      turn.y[i] = in.numbers();
      turn.z[i] = in.numbers();
    }
  }
}

}  // namespace whirl::analysis
