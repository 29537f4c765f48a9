#include <analysis/transient/kept_in_time.hpp>
#include <core/contract.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

constexpr double share_of_constant = 0.05;  // between two looks
constexpr double most_looks = 2000;

double shortest_constant(const system::System& system) {
  double out = infinity;
  for (const system::Keeper& k : system.keepers())
    out = std::min(out, k.time_constant);
  return out;
}

}  // namespace

bool KeptInTime::any(const system::System& system) {
  return std::isfinite(shortest_constant(system));
}

KeptInTime::KeptInTime(const system::System& system, double t_begin, double duration,
                       double dt_fixed, Sink sink)
    : system_(system),
      t_begin_(t_begin),
      every_(std::max(
          {share_of_constant * shortest_constant(system), duration / most_looks, dt_fixed})),
      sink_(std::move(sink)) {
  WHIRL_EXPECTS(any(system) && duration > 0.0);
}

/// Irregular: a spin that turns so many times between two looks would always show the same phase.
double KeptInTime::look_at(long k) const {
  constexpr double golden = 0.6180339887498949;
  const double n = static_cast<double>(k);
  return t_begin_ + every_ * (n + golden * n - std::floor(golden * n));
}

void KeptInTime::look(const Snapshot& s) {
  system_.settle_kept(s.workspace(), settled_);
  largest_.resize(settled_.size(), 0.0);
  due_ = true;
  if (!sink_) return;
  kept_.resize(settled_.size());
  for (std::size_t i = 0; i < kept_.size(); ++i)
    kept_[i] = s.frames().kept_at(i, s.t());
  sink_(s.t(), kept_, settled_);
}

void KeptInTime::step(StepAccess& s) {
  if (s.t1() < look_at(looks_ + 1)) return;
  while (s.t1() >= look_at(looks_ + 1))
    ++looks_;
  last_step_ = s.t1() - s.t0();
  look(s.at(look_at(looks_)));  // whatever the steps are
}

void KeptInTime::apply(double t, system::Frames& frames) {
  if (!due_) return;
  due_ = false;
  frames.hold_kept(t);
  frames.kept_from = t;
  frames.kept_rate.assign(frames.kept.size(), 0.0);
  // a look falls on the end of the step that passes its time
  const double span = look_at(looks_ + 1) - t + last_step_;
  for (const system::Keeper& k : system_.keepers()) {
    if (!std::isfinite(k.time_constant)) continue;
    const double share = -std::expm1(-span / k.time_constant);
    for (std::size_t i = k.first; i < k.first + k.count; ++i) {
      const double change = share * (settled_[i] - frames.kept[i]);
      frames.kept_rate[i] = change / span;
      largest_[i] = std::max(largest_[i], std::abs(change));
    }
  }
}

double KeptInTime::largest_change(std::size_t first, std::size_t count) const {
  WHIRL_EXPECTS(first + count <= largest_.size());
  const auto from = largest_.begin() + static_cast<std::ptrdiff_t>(first);
  return count == 0 ? 0.0 : *std::max_element(from, from + static_cast<std::ptrdiff_t>(count));
}

void KeptInTime::save(OutArchive& out) const {
  out.put_count(static_cast<std::size_t>(looks_));
  out.put(largest_);
  out.put(due_ ? settled_ : std::vector<double>());
}

void KeptInTime::restore(InArchive& in) {
  looks_ = static_cast<long>(in.count());
  largest_ = in.numbers();
  const system::Keeper& last = system_.keepers().back();
  if (largest_.size() != last.first + last.count)
    throw std::invalid_argument("temperatures of another run");
  settled_ = in.numbers();
  due_ = !settled_.empty();
}

}  // namespace whirl::analysis
