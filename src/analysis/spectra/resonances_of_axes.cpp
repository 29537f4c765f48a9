// Where parametric and combination resonances lie: (w_i + w_j) = n Omega and |w_i - w_j| = n Omega, w in fixed
// axes (V. V. Bolotin, The Dynamic Stability of Elastic Systems, 1964; V. A. Yakubovich and V. M. Starzhinskii,
// Linear Differential Equations with Periodic Coefficients, 1975).
#include <analysis/spectra/rotating_axes.hpp>

#include <analysis/spectra/whirl_modes.hpp>
#include <core/error.hpp>

#include <algorithm>
#include <cmath>

namespace whirl::analysis {

namespace {

/// Natural frequencies at a speed, rad/s, ascending.
struct Frequencies {
  double speed = 0;
  std::vector<double> w;
  bool known = true;  ///< false: a table of frequencies ends below one of them
};

std::vector<Frequencies> frequencies_at(Linearizer& linear, const std::vector<double>& speeds,
                                        double sense) {
  constexpr Index slowest = 6;
  ModesOptions o;
  o.count = slowest;
  o.motion = Motion::lateral;
  o.certify = false;
  WhirlSolver solver(linear, o);
  std::vector<Frequencies> out;
  for (const double Omega : speeds) {
    Frequencies f{Omega, {}, true};
    try {
      for (const WhirlMode& m : solver.solve(sense * Omega))
        f.w.push_back(m.frequency);
    } catch (const Error& e) {
      if (e.diagnostics().front().code != "E81") throw;
      f.known = false;
    }
    out.push_back(std::move(f));
  }
  return out;
}

/// These speeds, and others between them where they are far apart.
std::vector<double> with_more(std::vector<double> speeds) {
  constexpr int parts = 12;
  const double first = speeds.front(), last = speeds.back();
  for (int k = 1; k < parts; ++k)
    speeds.push_back(first + (last - first) * k / parts);
  std::sort(speeds.begin(), speeds.end());
  const auto same = [](double a, double b) { return b - a < 1e-6 * b; };
  speeds.erase(std::unique(speeds.begin(), speeds.end(), same), speeds.end());
  return speeds;
}

}  // namespace

std::optional<std::vector<Resonance>> RotatingAxes::resonances(const std::vector<double>& speeds,
                                                               double sense) const {
  std::vector<Resonance> out;
  if (speeds.size() < 2 || !(speeds.back() > speeds.front())) return out;
  Linearizer linear(linear_);
  const std::vector<Frequencies> known = frequencies_at(linear, with_more(speeds), sense);
  if (std::any_of(known.begin(), known.end(), [](const Frequencies& f) { return !f.known; }))
    return std::nullopt;
  const double ratio = std::abs(ratio_);
  const auto look = [&](const Frequencies& a, const Frequencies& b, std::size_t i, std::size_t j,
                        double sign, double multiple) {
    const auto distance = [&](const Frequencies& f) {
      return f.w[j] + sign * f.w[i] - multiple * ratio * f.speed;
    };
    const double at_a = distance(a), at_b = distance(b);
    if (!(at_a * at_b <= 0.0) || at_a == at_b) return;
    const double share = at_a / (at_a - at_b);
    const double w = a.w[j] + share * (b.w[j] - a.w[j]);
    const double Omega = a.speed + share * (b.speed - a.speed);
    out.push_back({Omega, std::abs(w - ratio * Omega), (at_b - at_a) / (b.speed - a.speed)});
  };
  for (std::size_t k = 0; k + 1 < known.size(); ++k) {
    const Frequencies &a = known[k], &b = known[k + 1];
    const std::size_t count = std::min(a.w.size(), b.w.size());
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i; j < count; ++j)
        for (Index n = 1; n <= joined_multiples(); ++n) {
          look(a, b, i, j, 1.0, static_cast<double>(n));
          if (i != j) look(a, b, i, j, -1.0, static_cast<double>(n));
        }
  }
  std::sort(out.begin(), out.end(),
            [](const Resonance& x, const Resonance& y) { return x.speed < y.speed; });
  // bands as narrow as the distance of two that count as one hardly grow
  constexpr double apart = 1e-3;
  std::vector<Resonance> kept;
  for (const Resonance& x : out) {
    const bool before = std::any_of(kept.rbegin(), kept.rend(), [&](const Resonance& y) {
      return x.speed - y.speed < apart * x.speed &&
             std::abs(x.frequency - y.frequency) < apart * ratio * x.speed;
    });
    if (!before) kept.push_back(x);
  }
  return kept;
}

}  // namespace whirl::analysis
