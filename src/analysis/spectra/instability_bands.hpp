// Bands of speed in which a rotor whose matrices turn with it is unstable (rotating_axes.hpp).
#pragma once
#include <analysis/spectra/rotating_axes.hpp>
#include <functional>

namespace whirl::analysis {

/// A range of speeds in which a motion grows.
struct InstabilityBand {
  double low = nan, high = nan;  ///< rad/s; nan: beyond the speeds looked at
  double growth = 0, speed = 0;  ///< 1/s, largest found within, and where (rad/s)
  double frequency =
      0;  ///< there, in rotating axes, rad/s; 0: the rotor bends out at its own speed
};

struct BandOptions {
  std::vector<double>
      speeds;  ///< rad/s, ascending; more are put in where rotation takes the last stiffness, and,
               ///< where matrices are periodic, where the sum or difference of two frequencies is a
               ///< multiple of the speed (parametric and combination resonances)
  double sense = 1;          ///< -1: the rotor runs backwards, at the negative of all speeds
  Index modes = 8;           ///< of least frequency in rotating axes
  double tolerance = 1e-11;  ///< relative, of the edges
  /// Told before each speed: the share of the speeds that is done, and the speed, rad/s.
  std::function<void(double, double)> progress;
};

struct BandResult {
  std::vector<double> speeds, growth,
      frequency;  ///< largest real part (1/s) of the motions, and its frequency in rotating axes
  /// Largest share of the last harmonic in one of the slowest motions at each speed: rates are right to
  /// about its square of the speed.
  std::vector<double> cut;
  std::vector<InstabilityBand> bands;
  /// Parametric and combination resonances between the speeds were looked for, where there can be any.
  bool sought_between = true;
  Index evaluations = 0;  ///< speeds looked at on the way, edges and maxima included
  /// Speeds at which the motions were counted too, by an independent method, and at which not.
  Index counted = 0, uncounted = 0;
  double counted_to = infinity;  ///< rad/s, rotating axes: least frequency that the counts reach
  bool complete() const { return uncounted == 0; }
};

/// Growth, as a share of the speed, that is taken for none: what harmonics left out of Hill's equations
/// make of nothing, or rounding where the matrices are constant.
double unnoticed_share(const RotatingAxes& axes);
/// Largest real part, 1/s, of the motions at a speed, rad/s, with its sign; modes: of least frequency in rotating
/// axes, as many as are looked at where speeds go up to the fastest.
double largest_growth(RotatingAxes& axes, double Omega, double fastest, Index modes);

/// Bands of parametric instability. Edges are solved for; bands narrower than the distance of the
/// speeds are found where they belong to a critical speed (whirl at the speed itself), or lie halfway
/// between two bands that were found; other combination bands must be as wide as that distance to be seen.
/// @pre ascending speeds, at least one mode.
BandResult find_bands(RotatingAxes& axes, const BandOptions& options);

}  // namespace whirl::analysis
