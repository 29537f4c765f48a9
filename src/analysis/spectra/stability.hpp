// Stability: log decrement against speed, and the onset speeds of instability, at which a root
// crosses the imaginary axis: a whirl mode (whirl, flutter) or a motion that does not oscillate
// (divergence).
//
// At every speed the roots are counted (la/root_count.hpp) up to the frequency above which nothing
// can grow (growth_bound.hpp), so that "stable" is a statement about all of them. Modes are
// followed over the speed (track.hpp); where the real part of one changes sign the speed is solved
// for by secant, with the equilibrium and all coefficients of bearings linearised anew at every
// trial. Where what is followed does not account for the change in the number of growing roots, the
// speed is bisected on that number. Between the speeds of the search a mode whose growth rate bends
// towards zero is looked at where it comes nearest.
#pragma once
#include <analysis/spectra/campbell.hpp>

#include <algorithm>
#include <optional>

namespace whirl::analysis {

struct StabilityOptions {
  double min_speed = 0, max_speed = 0;  ///< rad/s
  Index grid = 40;                      ///< speeds of the search
  std::vector<double> speeds;           ///< or these, ascending
  Index modes = 12;                     ///< modes followed, of least frequency
  Motion motion = Motion::all;
  double tolerance = 1e-12;  ///< relative, of the speed
  bool all = false;          ///< go on after the first crossing; else stop there
  int threads = 1;           ///< 0: all processors; the results are the same for any number
  bool shapes = false;       ///< the diagram has the shapes of its motions
};

struct Onset {
  double speed = 0;      ///< rad/s
  double frequency = 0;  ///< whirl frequency there, rad/s; 0: divergence
  bool gains = true;     ///< unstable above (true) or below (false) this speed
  WhirlMode mode;
  /// False: it grows on both sides, on one by so little that rounding could be the cause (of what
  /// nothing damps).
  bool begins = true;
  double ratio() const { return frequency / speed; }  ///< whirl ratio
  bool divergence() const { return frequency == 0.0; }
};

/// What is known of one speed.
struct SpeedVerdict {
  double speed = 0;                   ///< rad/s
  Index whirling = 0, diverging = 0;  ///< growing roots: pairs that oscillate, real ones
  Index growing = 0;                  ///< growing roots, two a pair
  double fastest = 0;                 ///< 1/s: largest growth rate; 0 where nothing grows
  double fastest_at = 0;              ///< rad/s: its frequency
  Index neutral = 0;                  ///< pairs that oscillate, of a growth within rounding
  double neutral_within = 0;          ///< 1/s: the largest of these roundings
  SpectrumCertificate certificate;
  bool stable() const { return whirling + diverging == 0; }
};

/// A motion that grows at a speed, of which it is not known where that begins or ends: it came into
/// the list growing, from frequencies beyond it, or left it so.
struct Unplaced {
  double speed = 0;      ///< rad/s: where it was seen first
  double frequency = 0;  ///< rad/s; nan: that of the verdict there
  double growth = 0;     ///< 1/s
};

struct StabilityResult {
  bool stable_at_start = true;         ///< at the first speed
  std::vector<SpeedVerdict> verdicts;  ///< one a speed
  /// Every verdict accounts for all roots at all frequencies.
  bool certain() const {
    return std::all_of(verdicts.begin(), verdicts.end(),
                       [](const SpeedVerdict& v) { return v.certificate.stability_certain(); });
  }
  /// The largest growth, over its frequency, that a verdict leaves open above its list.
  double growth_left() const {
    double most = 0;
    for (const SpeedVerdict& v : verdicts)
      if (!v.certificate.axis) most = std::max(most, v.certificate.quiet_ratio);
    return most;
  }
  /// Every verdict accounts for all roots of its band.
  bool complete() const {
    return std::all_of(verdicts.begin(), verdicts.end(),
                       [](const SpeedVerdict& v) { return v.certificate.complete(); });
  }
  std::vector<Onset> onsets;  ///< ascending
  std::vector<Unplaced> unplaced;
  /// Where stable at the first speed: the lowest at which something grows below every onset found.
  /// "Stable" and "unstable above" may be said where there is none only.
  std::optional<Unplaced> unannounced() const;
  Campbell diagram;  ///< of the modes followed, at the speeds of the search
};

StabilityResult find_instability(Linearizer& linear, const StabilityOptions& options);

/// Log decrement of the least stable modes over speed and one parameter (a clearance, a viscosity,
/// a stiffness).
struct StabilityMap {
  std::vector<double> speeds, parameter;
  std::vector<std::vector<double>>
      least_log_decrement;  ///< [parameter][speed], of oscillating lateral modes
  /// [parameter]: first onset within the speeds, solved for, rad/s; nan: stable at all of them;
  /// -inf: unstable at the first one already.
  std::vector<double> onset;
  std::vector<bool> certain;  ///< [parameter]: StabilityResult::certain()
  /// [parameter]; false: the onset is where growth was seen first, not where it begins
  /// (StabilityResult::unannounced).
  std::vector<bool> placed;
  std::vector<double> frequency;  ///< of the whirl there, rad/s; nan without
};
StabilityMap stability_map(const std::function<system::System(double)>& build,
                           const SteadyRotation& running, const std::vector<double>& parameter,
                           const StabilityOptions& options);

}  // namespace whirl::analysis
