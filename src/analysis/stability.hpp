// Stability: log decrement against speed, and the onset speed of instability, at which a damped mode has Re lambda = 0.
//
// Modes are followed over the speed (track.hpp); where the real part changes sign the speed is solved for by secant, with the
// equilibrium and all coefficients of bearings linearised anew at every trial.
#pragma once
#include <analysis/campbell.hpp>

namespace whirl::analysis {

struct StabilityOptions {
  double min_speed = 0, max_speed = 0;   ///< rad/s
  Index grid = 40;                       ///< speeds of the search
  std::vector<double> speeds;            ///< or these, monotonic
  Index modes = 12;                      ///< modes followed, of least frequency
  Motion motion = Motion::all;
  double tolerance = 1e-12;              ///< relative, of the speed
  bool all = false;                      ///< go on after the first crossing; else stop there
};

struct Onset {
  double speed = 0;                      ///< rad/s
  double frequency = 0;                  ///< whirl frequency there, rad/s
  bool gains = true;                     ///< unstable above (true) or below (false) this speed
  WhirlMode mode;
  double ratio() const { return frequency / speed; }   ///< whirl ratio
};

struct StabilityResult {
  bool stable_at_start = true;           ///< at min_speed
  std::vector<Onset> onsets;             ///< ascending
  Campbell diagram;                      ///< of the modes followed, at the speeds of the search
};

StabilityResult find_instability(Linearizer& linear, const StabilityOptions& options);

/// Log decrement of the least stable modes over speed and one parameter (a clearance, a viscosity, a stiffness).
struct StabilityMap {
  std::vector<double> speeds, parameter;
  std::vector<std::vector<double>> least_log_decrement;   ///< [parameter][speed], of oscillating lateral modes
  /// [parameter]: first onset within the speeds, solved for, rad/s; nan: stable at all of them; -inf: unstable at the first one already.
  std::vector<double> onset;
  std::vector<double> frequency;                          ///< of the whirl there, rad/s; nan without
};
StabilityMap stability_map(const std::function<system::System(double)>& build, const Running& running,
                           const std::vector<double>& parameter, const StabilityOptions& options);

}  // namespace whirl::analysis
