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
  VecXc force = VecXc::Zero(linear_.system().size()), a = force;
  for (const HarmonicForce& f : options_.forces)
    force[f.unknown] += scale * f.amplitude;
  if (solver_.prepare(Omega, w)) {
    linear_.system().reduce(linear_.equilibrium().state, force);
    a = force;
    solver_.solve(a);
  } else {
    a.setConstant(Complex(nan, nan));  // undamped resonance met exactly
  }
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
