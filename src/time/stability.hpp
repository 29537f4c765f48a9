// What a scheme does to one mode, q'' + 2 zeta omega q' + omega^2 q = f, at a step h: numerical
// damping and frequency error. For the warning that numerical damping is not small against physical
// damping, and for stability regions.
#pragma once
#include <core/types.hpp>
#include <string_view>

namespace whirl::time {

/// Per step: the scheme's amplification of the mode, the modulus of its dominant root (free
/// spurious roots included in `radius`), and what a user sees of it.
struct ModeResponse {
  double radius = 0.0;         ///< spectral radius of the step; > 1: unstable
  double amplification = 0.0;  ///< modulus of the root that follows the mode
  double damping = 0.0;  ///< apparent damping ratio of the mode less zeta: what the scheme adds
                         ///< (negative: takes away)
  double frequency_error =
      0.0;  ///< apparent damped frequency / true one - 1; nan where the mode no longer oscillates
};

/// name as in make_integrator (ida: BDF of order 2). omega > 0 rad/s, zeta in (-1, 1), h > 0 s.
/// @throws Error for an unknown name.
/// @pre omega, h > 0, |zeta| < 1, 0 <= rho_inf <= 1.
ModeResponse mode_response(std::string_view name, double omega, double zeta, double h,
                           double rho_inf = 0.9);

/// Stability function of a collocation method (Pade approximants of exp), z = h lambda. Throws
/// @throws Error (N10) for other names.
Complex stability_function(std::string_view name, Complex z);

/// Larger root of BDF of order 2 at equal steps, (3/2 - z) r^2 - 2 r + 1/2 = 0.
double bdf2_radius(Complex z);

}  // namespace whirl::time
