#include <steps/resonances.hpp>

#include <analysis/response/unbalance.hpp>
#include <analysis/spectra/critical.hpp>
#include <analysis/spectra/rotating_axes.hpp>
#include <core/error.hpp>
#include <results/linear_limits.hpp>
#include <steps/criticals_between.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace whirl::steps {
namespace {

constexpr double least_damping = 1e-6;

bool drives(Driven driven, analysis::ModeKind kind) {
  switch (kind) {
    case analysis::ModeKind::lateral: return driven.lateral;
    case analysis::ModeKind::torsional: return driven.torsional;
    case analysis::ModeKind::axial: break;
  }
  return driven.axial;
}

bool has_peak(Driven driven, const analysis::WhirlMode& m) {
  return std::abs(m.damping_ratio) > least_damping || drives(driven, m.kind);
}

/// Appends a resonance and places about it. Where nothing damps it, it has none itself: the response
/// there has no bound.
void add_places(double resonance, double damping_ratio, std::vector<double>& out) {
  const double width = std::max(std::abs(damping_ratio), least_damping);
  for (const double x : {-8.0, -4.0, -2.0, -1.0, -0.5, 0.5, 1.0, 2.0, 4.0, 8.0})
    out.push_back(resonance * (1.0 + x * width));
  if (std::abs(damping_ratio) > least_damping) out.push_back(resonance);
}

void put_into(std::vector<double>& grid, const std::vector<double>& places) {
  const double low = grid.front(), high = grid.back();
  for (const double x : places)
    if (x > low && x < high) grid.push_back(x);
  std::sort(grid.begin(), grid.end());
  const auto close = [](double a, double b) { return b - a < 1e-7 * std::abs(b); };
  grid.erase(std::unique(grid.begin(), grid.end(), close), grid.end());
}

void warn_of_coarse_grid(results::FrequencyStep& s, const Error& why) {
  Diagnostic w;
  w.severity = Diagnostic::Severity::warning;
  w.code = "W15";
  w.message = fmt::format(
      "step '{}': the points are those asked for, and a peak between two of "
      "them may be missed: resonances were not found ({})",
      s.step.name, why.diagnostics().front().message);
  w.hint = "more points, or speeds and frequencies one by one";
  results::warn(s.job, std::move(w));
}

}  // namespace

void refine_at_frequencies(results::FrequencyStep& s, analysis::Motion motion, Driven driven,
                           double speed, std::vector<double>& grid) {
  analysis::ModesOptions o;
  o.count = 0;
  o.max_frequency = grid.back();
  o.motion = motion;
  o.certify = false;
  o.continued = true;
  std::vector<double> places;
  try {
    for (const analysis::WhirlMode& m : analysis::whirl_modes(s.linear, speed, o)) {
      if (!has_peak(driven, m)) continue;
      add_places(m.frequency, m.damping_ratio, places);
      // coefficients of a frequency leave the decay out: the resonance may be much sharper
      if (m.continued != m.lambda)
        add_places(std::abs(m.continued.imag()), m.continued.real() / std::abs(m.continued),
                   places);
    }
  } catch (const Error& e) {
    warn_of_coarse_grid(s, e);
  }
  put_into(grid, places);
}

void refine_at_criticals(results::FrequencyStep& s, analysis::Motion motion, Driven driven,
                         double order, std::vector<double>& grid) {
  if (grid.front() == grid.back()) return;
  analysis::CriticalOptions o;
  o.order = order;
  o.damped = true;
  o.motion = motion;
  // they only say where the grid is to be finer: found, not counted, and where modes cannot be
  // followed the tracker goes in smaller steps
  o.certify = false;
  constexpr Index smooth = 4, any = 8;  // coefficients of supports may bend lines of frequencies
  o.grid = s.linear.running().quadratic_in_speed() ? smooth : any;
  o.tolerance = 1e-9;  // of the last step of a secant: the place is right to its square
  o.threads = s.job.options.jobs;
  std::vector<double> places;
  try {
    for (const analysis::Critical& c : criticals_between(s, o, grid.front(), grid.back()))
      if (has_peak(driven, c.mode)) add_places(c.speed, c.mode.damping_ratio, places);
  } catch (const Error& e) {
    warn_of_coarse_grid(s, e);
  }
  put_into(grid, places);
}

void refine_at_poles(results::FrequencyStep& s, std::vector<double>& grid) {
  if (grid.front() == grid.back()) return;
  std::vector<double> places;
  try {
    analysis::Linearizer linear(s.linear);
    // near enough to put speeds there: the response itself takes as many harmonics as it needs
    analysis::RotatingAxes axes(linear, analysis::fastest_of(grid));
    for (const Complex pole : axes.poles(grid.front(), grid.back()))
      add_places(pole.real(), pole.imag() / std::abs(pole), places);
  } catch (const Error& e) {
    warn_of_coarse_grid(s, e);
  }
  put_into(grid, places);
}

}  // namespace whirl::steps
