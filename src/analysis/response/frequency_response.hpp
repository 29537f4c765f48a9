// Response to given harmonic forces: at one speed against the excitation frequency (asynchronous),
// or at n times the speed.
#pragma once
#include <analysis/response/unbalance.hpp>

namespace whirl::analysis {

/// Force (N) or moment (N m) amplitude on one unknown, f(t) = Re(amplitude exp(i w t)); a moment on
/// phi acts along the spin.
struct HarmonicForce {
  Index unknown = 0;
  Complex amplitude;
};

struct FrequencyResponseOptions {
  std::vector<HarmonicForce> forces;
  std::vector<ResponseProbe> probes;
  std::vector<Index> unknowns;  ///< amplitudes of these are returned too (twist angles and so on)
  std::vector<Measurement> outputs;
  Motion motion = Motion::all;
  bool shapes = false;
};

struct FrequencyPoint {
  double Omega = 0, frequency = 0;  ///< rad/s
  std::vector<PointAmplitude> probe;
  std::vector<Complex> unknown;
  std::vector<std::vector<Complex>> output;
  VecXc shape;
};

/// Responses one by one.
class HarmonicResponder {
 public:
  HarmonicResponder(Linearizer& linear, FrequencyResponseOptions options);
  /// At speed Omega and excitation frequency w, rad/s; scale: factor on all forces. nan everywhere
  /// at an undamped resonance.
  /// @pre w >= 0.
  FrequencyPoint at(double Omega, double w, double scale = 1.0);

 private:
  Linearizer& linear_;
  FrequencyResponseOptions options_;
  HarmonicSolver solver_;
  std::unique_ptr<VariationMeter> meter_;
};

}  // namespace whirl::analysis
