// The linearised bearings of a state: eccentricity, attitude, K and C of every film, seal, table, contact and rolling bearing.
#pragma once
#include <app/job.hpp>

namespace whirl::app {

/// One row a bearing whose coefficients depend on where the shaft runs; empty when there is none. F = -K r - C r' on the shaft, (y, z),
/// N/m and N s/m, at the equilibrium `s`. Eccentricity and attitude are measured from the middle of the bearing, the attitude from
/// the direction of the load (opposite to the force on the shaft) in the sense y -> z, 0 to 360 deg. Rolling bearings in a turning rotor: means over a pass.
io::Table support_coefficients(const Job& job, const StepState& s);

}  // namespace whirl::app
