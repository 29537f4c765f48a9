#include <results/changing_loads.hpp>
#include <results/frequency.hpp>
#include <results/transient_output.hpp>

#include <analysis/spectra/whirl_modes.hpp>
#include <core/error.hpp>
#include <la/multiply.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace whirl::results {

namespace {

/// A time at which a law is farthest from what it is at the start, s; nothing: it does not change.
std::optional<double> farthest(const Law& law, double from, double to) {
  constexpr int looks = 1000;
  std::vector<double> times = law.breakpoints();
  for (int i = 0; i <= looks; ++i)
    times.push_back(from + (to - from) * i / looks);
  const double first = law.at(from).f;
  double most = 0.0, when = from, size = std::abs(first);
  for (const double t : times) {
    if (t < from || t > to) continue;
    const double f = law.at(t).f;
    size = std::max(size, std::abs(f));
    if (std::abs(f - first) <= most) continue;
    most = std::abs(f - first);
    when = t;
  }
  if (most <= 1e-9 * size) return std::nullopt;
  return when;
}

struct Look {
  double time = 0;
  std::string load;
};

/// Times at which loads are farthest from what they are at the start.
std::vector<Look> looks_at(const model::Model& m, double from, double to) {
  std::vector<Look> out;
  const auto add = [&](const LawPtr& law, const std::string& name) {
    if (!law) return;
    if (const auto time = farthest(*law, from, to)) out.push_back({*time, name});
  };
  for (const model::PointLoad& l : m.loads)
    add(l.factor, "load '" + l.name + "'");
  for (const LawPtr& along : m.base.acceleration)
    add(along, "the acceleration of the base");
  return out;
}

/// First-order change of a natural frequency over itself.
double shift_of(const analysis::WhirlMode& mode, const la::MCK& at_start, const la::MCK& then) {
  VecXc y, z;
  la::multiply(then.K, mode.x, y);
  la::multiply(at_start.K, mode.x, z);
  const Complex change = mode.x.dot(y - z);
  la::multiply(at_start.M, mode.x, y);
  la::multiply(at_start.C, mode.x, z);
  const Complex slope = 2.0 * mode.lambda * mode.x.dot(y) + mode.x.dot(z);
  return std::abs(change / (slope * mode.lambda));
}

struct Worst {
  double shift = 0, frequency = 0;
};

Worst worst_of(const std::vector<analysis::WhirlMode>& modes, const la::MCK& at_start,
               const la::MCK& then) {
  Worst out;
  for (const analysis::WhirlMode& m : modes) {
    if (!m.oscillates()) continue;
    const double shift = shift_of(m, at_start, then);
    if (shift > out.shift) out = {shift, m.frequency};
  }
  return out;
}

}  // namespace

void warn_of_changing_loads(run::Job& job, const model::Step& step, const model::TransientStep& law,
                            const run::StepState& start) {
  if (!law.linear) return;
  const double from = start.state.t, to = from + law.duration;
  const std::vector<Look> looks = looks_at(job.model, from, to);
  if (looks.empty()) return;
  const auto linearizer_at = [&](double time) {
    analysis::SteadyRotation running = job.steady_rotation_of(start);
    running.time = time;
    running.hysteretic = false;
    analysis::Linearizer out(job.system(), running, {});
    out.start_from(start.state);
    return out;
  };
  constexpr double seen = 0.01;
  constexpr Index slowest = 6;
  analysis::Linearizer at_start = linearizer_at(from);
  analysis::ModesOptions o;
  o.count = slowest;
  o.certify = false;
  std::vector<analysis::WhirlMode> modes;
  try {
    modes = analysis::whirl_modes(at_start, start.speed, o);
  } catch (const Error& e) {  // a table that ends below them
    return warn_of_step(job, step,
                        "whether loads that change move natural frequencies is not judged: " +
                            e.diagnostics().front().message);
  }
  for (const Look& look : looks) {
    std::string what;
    try {
      analysis::Linearizer then = linearizer_at(look.time);
      const Worst worst = worst_of(modes, at_start.at(start.speed), then.at(start.speed));
      if (worst.shift > seen)
        what = fmt::format("moves the natural frequency at {:.4g} Hz by {:.2g} % (to first order)",
                           to_hz(worst.frequency), 100.0 * worst.shift);
    } catch (const Error& e) {
      if (e.diagnostics().front().code == "E75") continue;  // it moves what nothing holds
      what = "leaves the rotor no equilibrium: " + e.diagnostics().front().message;
    }
    if (what.empty()) continue;
    warn_of_step(
        job, step,
        fmt::format(
            "linear = true keeps the stiffness of the start, but {} as it is at t = {:.6g} s "
            "{}",
            look.load, look.time, what));
  }
}

}  // namespace whirl::results
