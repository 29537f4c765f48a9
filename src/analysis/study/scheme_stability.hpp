// Stability of the time schemes on a rotor: spectral radius of a step against its length, and the
// energy after very many steps.
//
// The rotor is linearised at a speed and projected on its lowest whirl modes (real and imaginary
// parts of the shapes, which keeps the gyroscopic coupling): M_r x'' + C_r x' + K_r x = 0, at most
// a few dozen unknowns. One step of a collocation method or of BDF2 multiplies the eigenvector of
// the eigenvalue lambda by a root of lambda h alone; generalized-alpha does not decouple in
// gyroscopic modes, so its map (q, h v, h^2 b) is built and its eigenvalues are found.
#pragma once
#include <analysis/spectra/whirl_modes.hpp>
#include <string_view>
#include <vector>

namespace whirl::analysis {

struct ReducedRotor {
  MatX M, C, K;
  std::vector<Complex> lambda;  ///< eigenvalues, 1/s, Im >= 0, least frequency first
  /// Without damping and circulation: energy is then constant.
  ReducedRotor conservative() const;
};

/// count: number of modes, rigid motions apart.
/// @throws Error as Linearizer::at; E95 when the rotor has no mode that oscillates.
ReducedRotor reduce_rotor(Linearizer& linear, double Omega, Index count = 12);

/// Largest |eigenvalue| of one step of length h, s; above 1 + rounding a step multiplies some
/// motion. method as in time::make_integrator; ida: BDF of order 2 at equal steps.
/// @pre h > 0 (also energy_ratio).
double spectral_radius(const ReducedRotor& rotor, std::string_view method, double h,
                       double rho_inf);

/// Energy after `steps` equal steps over that before, by the integrator itself, started with equal
/// energy in every mode.
double energy_ratio(const ReducedRotor& rotor, std::string_view method, double h, long steps,
                    double rho_inf);

}  // namespace whirl::analysis
