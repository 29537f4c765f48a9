#include <analysis/spectra/onset_isolation.hpp>
#include <analysis/spectra/track.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Relative width of the bracket in which a change of the number of growing roots is isolated.
constexpr double no_width = 1e-10;
/// Relative distance within which onsets of roots next to zero are rounding's, and motions of two sides of a
/// bracket of no width are one.
constexpr double near_by = 1e-7;
/// Of the speed: what a double root at zero becomes by rounding, its square root.
constexpr double at_zero = 1e-6;

SpeedVerdict verdict_of(double speed, const std::vector<WhirlMode>& modes,
                        const SpectrumCertificate& certificate) {
  SpeedVerdict v;
  v.speed = speed;
  v.certificate = certificate;
  for (const WhirlMode& m : modes) {
    if (m.oscillates() && m.growth() == 0) {
      ++v.neutral;
      v.neutral_within = std::max(v.neutral_within, m.rounding);
    }
    if (m.growth() <= 0) continue;
    ++(m.oscillates() ? v.whirling : v.diverging);
    v.growing += m.lambda.imag() != 0.0 ? 2 : 1;
    if (m.lambda.real() > v.fastest) {
      v.fastest = m.lambda.real();
      v.fastest_at = m.frequency;
    }
  }
  return v;
}

/// One of the roots of a list that grow; pairs have two.
struct GrowingRoot {
  Complex s;
  std::size_t mode;
};

std::vector<GrowingRoot> growing_roots(const std::vector<WhirlMode>& modes) {
  std::vector<GrowingRoot> roots;
  for (std::size_t k = 0; k < modes.size(); ++k) {
    if (modes[k].growth() <= 0) continue;
    roots.push_back({modes[k].lambda, k});
    if (modes[k].lambda.imag() != 0.0) roots.push_back({std::conj(modes[k].lambda), k});
  }
  return roots;
}

/// Its growth is there on the other side as well, but not told from rounding.
bool grows_within_rounding(const WhirlMode& m, const std::vector<WhirlMode>& there) {
  const double rate = m.lambda.real();
  return std::any_of(there.begin(), there.end(), [&](const WhirlMode& w) {
    return w.growth() == 0 && w.lambda.real() > 0.5 * rate && std::abs(w.lambda - m.lambda) < rate;
  });
}

/// Each motion of nearly this frequency of one list has one in the other. Growth may differ: hysteretic damping
/// turns its sense where a motion turns as the rotor does, and moves its frequency by far less.
bool as_many_near(const WhirlMode& m, const std::vector<WhirlMode>& here,
                  const std::vector<WhirlMode>& there) {
  constexpr double far_less = 0.1;
  const auto near = [&](const WhirlMode& w) {
    const double jump = std::abs(w.lambda.real() - m.lambda.real());
    return w.oscillates() &&
           std::abs(w.frequency - m.frequency) <= far_less * jump + near_by * m.frequency;
  };
  return m.oscillates() && std::count_if(there.begin(), there.end(), near) >=
                               std::count_if(here.begin(), here.end(), near);
}

}  // namespace

Look::Look(double speed, std::vector<WhirlMode> found, const SpectrumCertificate& certificate)
    : verdict(verdict_of(speed, found, certificate)),
      modes(std::move(found)) {}

OnsetIsolation::OnsetIsolation(Linearizer& linear, const ModesOptions& modes, double span,
                               double tolerance)
    : solver_(linear, modes),
      follower_(linear, modes),
      least_size_(1e-6 * std::abs(span)),
      tolerance_(tolerance) {}

Look OnsetIsolation::look_at(double speed) {
  std::vector<WhirlMode> modes = solver_.solve(speed);
  return {speed, std::move(modes), solver_.certificate()};
}

OnsetIsolation::Found OnsetIsolation::between(const Look& a, const Look& b) {
  found_ = {};
  isolate(a, b);
  settle();
  return std::move(found_);
}

void OnsetIsolation::isolate(const Look& a, const Look& b) {
  if (a.verdict.growing == b.verdict.growing) return;
  const double size = std::max({std::abs(a.speed()), std::abs(b.speed()), least_size_});
  if (b.speed() - a.speed() <= no_width * size) return add(a, b);
  const Look middle = look_at(0.5 * (a.speed() + b.speed()));
  isolate(a, middle);
  isolate(middle, b);
}

/// A mode that grows at one end of a bracket and continues nothing that grows at the other.
struct OnsetIsolation::Parted {
  WhirlMode mode;
  bool one_of_pair = false;  ///< a real root there is continued by the other of the pair
  bool real() const { return one_of_pair || mode.frequency == 0.0; }
};

/// What is left when each growing root there has taken the nearest one here.
std::vector<OnsetIsolation::Parted> OnsetIsolation::parted(const std::vector<WhirlMode>& here,
                                                           const std::vector<WhirlMode>& there) {
  std::vector<GrowingRoot> left = growing_roots(here);
  for (const GrowingRoot& r : growing_roots(there)) {
    const auto nearest = std::min_element(left.begin(), left.end(),
                                          [&r](const GrowingRoot& a, const GrowingRoot& b) {
                                            return std::abs(a.s - r.s) < std::abs(b.s - r.s);
                                          });
    if (nearest != left.end()) left.erase(nearest);
  }
  std::vector<Parted> fresh;
  for (std::size_t k = 0; k < here.size(); ++k) {
    const auto roots =
        std::count_if(left.begin(), left.end(), [k](const GrowingRoot& r) { return r.mode == k; });
    if (roots > 0) fresh.push_back({here[k], roots == 1 && here[k].lambda.imag() != 0.0});
  }
  return fresh;
}

/// The roots that grow, by the lists, at one end of a bracket of no width only. They crossed the axis
/// in it, but for those that entered or left a list growing: beyond it growth is not excluded, or to
/// quiet_ratio only.
void OnsetIsolation::add(const Look& a, const Look& b) {
  const bool gains = b.verdict.growing > a.verdict.growing;
  const Look &few = gains ? a : b, &many = gains ? b : a;
  const double at = 0.5 * (a.speed() + b.speed());
  for (const Parted& p : parted(many.modes, few.modes)) {
    const WhirlMode& m = p.mode;
    if (grows_within_rounding(m, few.modes))
      add_slow(p, few.speed(), many.speed(), gains);
    else if (!as_many_near(m, many.modes, few.modes) && grows_unlisted(m, few))
      found_.unplaced.push_back({(gains ? many : few).speed(), m.frequency, m.lambda.real()});
    else
      found_.onsets.push_back({at, p.real() ? 0.0 : m.frequency, gains, m, true});
  }
}

/// It grows at `few` as well, where the list does not reach it.
bool OnsetIsolation::grows_unlisted(const WhirlMode& m, const Look& few) {
  const SpectrumCertificate& known = few.verdict.certificate;
  const double size = std::abs(m.lambda);
  if (size < at_zero * std::abs(few.speed())) return false;
  if (known.complete() && size < known.list.radius) return false;
  const auto there = follower_.follow(few.speed(), m);
  if (!there) return !known.stability_certain();
  return there->growth() > 0 && std::abs(there->lambda - m.lambda) < 0.5 * m.lambda.real();
}

/// What leaves the band of rounding at `many`: it crosses the axis a little beyond `few`, or grows there
/// as well.
void OnsetIsolation::add_slow(const Parted& p, double few, double many, bool gains) {
  const WhirlMode& m = p.mode;
  const auto rate = [](double, const WhirlMode& x) { return x.lambda.real(); };
  const double away = (few > many ? 1.0 : -1.0) * std::abs(few);
  Onset onset{many, p.real() ? 0.0 : m.frequency, gains, m, false};
  for (const double share : {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3}) {
    const double beyond = few + share * away;
    const auto there = follower_.follow(beyond, m);
    if (!there || there->lambda.real() >= 0.0) continue;
    onset.begins = true;
    if (const auto root = find_on_mode(follower_, beyond, *there, many, m, rate, tolerance_)) {
      onset.speed = root->speed;
      onset.mode = root->mode;
      if (!p.real()) onset.frequency = root->mode.frequency;
    }
    break;
  }
  found_.onsets.push_back(std::move(onset));
}

/// Of onsets against each other, so near that rounding parts them, what is left between both sides.
void OnsetIsolation::settle() {
  std::vector<Onset> all;
  std::swap(all, found_.onsets);
  std::sort(all.begin(), all.end(),
            [](const Onset& x, const Onset& y) { return x.speed < y.speed; });
  for (std::size_t k = 0, end = 0; k < all.size(); k = end) {
    const double width = near_by * std::abs(all[k].speed);
    bool opposed = false;
    for (end = k + 1; end < all.size() && all[end].speed - all[end - 1].speed <= width; ++end)
      opposed = opposed || all[end].gains != all[k].gains;
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(k),
               last = all.begin() + static_cast<std::ptrdiff_t>(end);
    if (!opposed) {
      found_.onsets.insert(found_.onsets.end(), first, last);
      continue;
    }
    const Look low = look_at(all[k].speed - width), high = look_at(all[end - 1].speed + width);
    if (low.verdict.growing != high.verdict.growing) add(low, high);
  }
}

}  // namespace whirl::analysis
