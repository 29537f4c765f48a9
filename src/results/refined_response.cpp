#include <results/linear_limits.hpp>
#include <results/mesh_accuracy.hpp>
#include <results/refined_response.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::results {
namespace {

/// 1/size^2 = least + curvature (x - place)^2
struct Resonance {
  double place = 0, least = nan, curvature = nan;
  bool peaks() const { return least > 0.0 && curvature > 0.0; }
  double amplitude() const { return 1.0 / std::sqrt(least); }
  double amplification() const { return place / (2.0 * std::sqrt(least / curvature)); }
};

Resonance fit(const std::array<double, 3>& at, const std::array<double, 3>& size) {
  const double h = at[1] - at[0];
  std::array<double, 3> y{};
  for (std::size_t k = 0; k < 3; ++k)
    y[k] = 1.0 / (size[k] * size[k]);
  Resonance r;
  r.curvature = (y[0] - 2.0 * y[1] + y[2]) / (2.0 * h * h);
  const double slope = (y[2] - y[0]) / (2.0 * h);
  r.place = at[1] - slope / (2.0 * r.curvature);
  r.least = y[1] - slope * slope / (4.0 * r.curvature);
  return r;
}

/// A quarter of the width at half power.
double distance_of_places(double size, double at, double amplification,
                          const std::function<double(double)>& own) {
  if (amplification > 0.0) return 0.25 * size / amplification;
  const double h = 1e-3 * size;
  const Resonance rough = fit({at - h, at, at + h}, {own(at - h), own(at), own(at + h)});
  const double width = rough.peaks() ? std::sqrt(rough.least / rough.curvature) : 0.02 * size;
  return std::clamp(0.5 * width, 1e-7 * size, 0.05 * size);
}

system::State spread_state(const FrequencyStep& s, const meshes::Halved& fine,
                           const system::System& refined) {
  system::State out = refined.make_state();
  const system::State& own = s.linear.equilibrium().state;
  const VecX q = meshes::spread(fine, own.q);
  if (q.size() == out.q.size() && !own.frames.moved()) {
    out.q = q;
    out.frames.kept = own.frames.kept;  // films as warm as they were found
  }
  return out;
}

}  // namespace

RefinedModel::RefinedModel(const FrequencyStep& s)
    : fine_(meshes::halve(s.job.mesh, std::vector<bool>(s.job.mesh.lines.size(), true))),
      built_(assembly::build_system(s.job.model, fine_.mesh, s.step.name)),
      linear_(s.linearizer_of(built_.system)) {
  linear_.start_from(spread_state(s, fine_, built_.system));
}

analysis::Point RefinedModel::point(analysis::Point p) const {
  p.node = fine_.node[static_cast<std::size_t>(p.node)];
  return p;
}

Index RefinedModel::unknown(Index k) const {
  return 6 * fine_.node[static_cast<std::size_t>(k / 6)] + k % 6;
}

PeakError peak_error(double at, double amplification, const std::function<double(double)>& own,
                     const std::function<double(double)>& refined) {
  // half its height so near to it: nothing damps it, and it has no height
  constexpr double sharpest = 1e-6;
  const double height = own(at);
  if (own(at * (1.0 + sharpest)) < 0.5 * height) return {};
  const double half = distance_of_places(std::abs(at), at, amplification, own);
  const std::array<double, 3> places{at - half, at, at + half};
  std::array<double, 3> here{}, there{};
  for (std::size_t k = 0; k < 3; ++k) {
    here[k] = k == 1 ? height : own(places[k]);
    there[k] = refined(places[k]);
  }
  PeakError e;
  const Resonance a = fit(places, here), b = fit(places, there);
  if (a.peaks() && b.peaks()) {
    e.amplitude = meshes::error_of_change * std::abs(b.amplitude() / a.amplitude() - 1.0);
    e.amplification =
        meshes::error_of_change * std::abs(b.amplification() / a.amplification() - 1.0);
  } else {
    e.amplitude = meshes::error_of_change * std::abs(there[1] / here[1] - 1.0);
  }
  return e;
}

bool is_rounding(const run::Job& job, double amplitude) {
  constexpr double rounding = 1e-13;  // of the length of a shaft, a few hundred last digits
  double length = 0;
  for (const meshes::Line& line : job.mesh.lines)
    length = std::max(length, line.length);
  return !(amplitude > rounding * length);
}

void AmplitudeAccuracy::add(double error, const std::string& name) {
  looked_ = true;
  if (std::isnan(error)) {
    ++not_judged_;
  } else if (worst_.empty() || error > largest_) {
    largest_ = error;
    worst_ = name;
  }
}

void AmplitudeAccuracy::report() {
  if (!looked_) return;
  const run::Job& job = step_.job;
  io::Value& v = step_.summary()["mesh"];
  if (not_judged_ > 0) v["amplitudes not judged"] = not_judged_;
  if (worst_.empty()) return step_.claim_also(what_ + ": error of the elements not judged");
  v["relative error of amplitudes"] = largest_;
  v["largest of amplitudes at"] = worst_;
  std::string text = fmt::format("{} right to {} (elements)", what_, error_text(largest_));
  if (not_judged_ > 0) text += fmt::format(", {} of them not judged", not_judged_);
  step_.claim_also(text);
  if (largest_ <= job.model.mesh_accuracy) return;
  warn_of_coarse_mesh(step_.job, step_.step.name,
                      fmt::format("the amplitude of {} is off by about {}, {} wanted", worst_,
                                  error_text(largest_), error_text(job.model.mesh_accuracy)));
}

}  // namespace whirl::results
