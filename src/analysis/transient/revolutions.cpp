#include <analysis/transient/revolutions.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

Complex synchronous(const Turn& turn, std::span<const double> x, int order) {
  WHIRL_EXPECTS(x.size() == static_cast<std::size_t>(turn.n) + 1);
  WHIRL_EXPECTS(order >= 0);
  Complex sum = 0.0;
  for (int j = 0; j <= turn.n; ++j) {
    const double phi = two_pi * (turn.backward ? turn.n - j : j) / turn.n;
    const double weight = j == 0 || j == turn.n ? 0.5 : 1.0;
    sum += weight * x[static_cast<std::size_t>(j)] * std::polar(1.0, -order * phi);
  }
  return sum * ((order == 0 ? 1.0 : 2.0) / turn.n);
}

double lag_of(const Turn& turn, Complex amplitude) {
  const double lag = turn.backward ? std::arg(amplitude) : -std::arg(amplitude);
  return lag < 0.0 ? lag + two_pi : lag;
}

Range range_of(std::span<const double> x) {
  WHIRL_EXPECTS(!x.empty());
  Range r{x[0], x[0], 0.0};
  for (std::size_t j = 0; j < x.size(); ++j) {
    r.low = std::min(r.low, x[j]);
    r.high = std::max(r.high, x[j]);
    r.mean += (j == 0 || j + 1 == x.size() ? 0.5 : 1.0) * x[j];
  }
  r.mean /= static_cast<double>(x.size() - 1);
  return r;
}

Revolutions::Revolutions(std::vector<Point> probes, Index reference, int samples, Sink sink)
    : probes_(std::move(probes)),
      reference_(reference),
      sink_(std::move(sink)),
      step_angle_(two_pi / samples) {
  WHIRL_EXPECTS(samples > 0 && sink_ != nullptr);
  turn_.n = samples;
  turn_.y.assign(probes_.size(), std::vector<double>(static_cast<std::size_t>(samples) + 1));
  turn_.z = turn_.y;
}

void Revolutions::begin(const Snapshot& s) {
  phi_ = angle(s);
  rate_ = s.node(reference_).dphi;
  direction_ = 0;
  filled_ = 0;
}

double Revolutions::time_of(StepAccess& s, double phi) {
  // phi is smooth within a step: its cubic from both ends, then Newton on the dense output where
  // that is not enough
  const double h = s.t1() - s.t0(), change = phi_ - step_phi_;
  double x = std::clamp((phi - step_phi_) / change, 0.0, 1.0);
  for (int k = 0; k < 4; ++k) {
    const double y = 1.0 - x;
    const double f = step_phi_ + x * x * (3.0 - 2.0 * x) * change +
                     h * x * y * (y * step_rate_ - x * rate_) - phi;
    const double df =
        6.0 * x * y * change + h * (y * (1.0 - 3.0 * x) * step_rate_ + x * (3.0 * x - 2.0) * rate_);
    if (df * change <= 0.0) break;
    x = std::clamp(x - f / df, 0.0, 1.0);
  }
  double t = s.t0() + x * h;
  for (int k = 0; k < 6; ++k) {
    t = std::min(t, s.t1());
    const StepAccess::Angle turned = s.angle(t, reference_);
    const double error = turned.phi - phi;
    // 1e-6 rad of 2 pi: far below what a turn's filter resolves
    if (std::abs(error) < 1e-6) break;
    if (turned.rate * change <= 0.0) break;
    t = std::clamp(t - error / turned.rate, s.t0(), s.t1());
  }
  return t;
}

void Revolutions::take(StepAccess& s, double t) {
  const auto at = static_cast<std::size_t>(filled_++);
  s.displacements(t, probes_, at_probes_);
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    turn_.y[i][at] = at_probes_[i].x();
    turn_.z[i][at] = at_probes_[i].y();
  }
}

void Revolutions::step(StepAccess& s) {
  step_phi_ = phi_;
  step_rate_ = rate_;
  const Snapshot& end = s.end();
  phi_ = angle(end);
  rate_ = end.node(reference_).dphi;
  if (phi_ == step_phi_) return;
  const int direction = phi_ > step_phi_ ? 1 : -1;
  if (direction != direction_) {  // the rotor turned round (or starts): no whole turn can end
    direction_ = direction;
    filled_ = 0;
    const double k = step_phi_ / step_angle_;
    next_ =
        static_cast<long>(direction > 0 ? std::floor(k + 1e-9) + 1.0 : std::ceil(k - 1e-9) - 1.0);
  }
  for (; direction * (phi_ - static_cast<double>(next_) * step_angle_) >= 0.0; next_ += direction) {
    const bool keyphasor = next_ % turn_.n == 0;
    if (filled_ == 0 && !keyphasor) continue;  // collecting begins at the mark
    const double t = time_of(s, static_cast<double>(next_) * step_angle_);
    if (!keyphasor) {
      take(s, t);
      continue;
    }
    if (filled_ == turn_.n) {
      take(s, t);
      turn_.t1 = t;
      turn_.backward = direction < 0;
      turn_.number = next_ / turn_.n - (direction > 0 ? 1 : 0);
      sink_(turn_);
    }
    filled_ = 0;
    turn_.t0 = t;
    take(s, t);
  }
}

void Revolutions::save(OutArchive& out) const {
  for (double x : {phi_, rate_, turn_.t0, static_cast<double>(next_),
                   static_cast<double>(direction_), static_cast<double>(filled_)})
    out.put(x);
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    out.put(turn_.y[i]);
    out.put(turn_.z[i]);
  }
}

void Revolutions::restore(InArchive& in) {
  phi_ = in.number();
  rate_ = in.number();
  turn_.t0 = in.number();
  next_ = static_cast<long>(in.number());
  direction_ = static_cast<int>(in.number());
  filled_ = static_cast<int>(in.number());
  for (std::size_t i = 0; i < probes_.size(); ++i) {
    turn_.y[i] = in.numbers();
    turn_.z[i] = in.numbers();
  }
}

}  // namespace whirl::analysis
