#include <analysis/response/frequency_response.hpp>
#include <core/contract.hpp>

namespace whirl::analysis {

HarmonicResponder::HarmonicResponder(Linearizer& linear, FrequencyResponseOptions options)
    : linear_(linear),
      options_(std::move(options)),
      solver_(linear, options_.motion) {
  if (!options_.outputs.empty()) meter_ = std::make_unique<VariationMeter>(linear);
}

FrequencyPoint HarmonicResponder::at(double Omega, double w, double scale) {
  WHIRL_EXPECTS(w >= 0.0 && std::isfinite(Omega));
  FrequencyPoint p;
  p.Omega = Omega;
  p.frequency = w;
  VecXc given = VecXc::Zero(linear_.system().size()), force;
  for (const HarmonicForce& f : options_.forces)
    given[f.unknown] += scale * f.amplitude;
  const VecXc a = solver_.response(Omega, w, [&] {
    force = given;
    linear_.system().reduce(linear_.equilibrium().state, force);
    return force;
  });
  if (force.size() == 0) force = given;
  for (const ResponseProbe& probe : options_.probes)
    p.probe.push_back(amplitude_at(linear_, a, probe.point));
  drop_rounding(largest_displacement(linear_.system(), a), p.probe);
  for (Index k : options_.unknowns)
    p.unknown.push_back(a[k]);
  const VecXc& shape = solver_.bounded().size() > 0 ? solver_.bounded() : a;
  if (meter_) meter_->measure(shape, force, w, options_.outputs, p.output);
  if (options_.shapes) p.shape = shape;
  return p;
}

}  // namespace whirl::analysis
