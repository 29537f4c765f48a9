// Balancing by influence coefficients: r = r0 + A w, with vibration vectors r (m, complex: amplitude
// and -lag), correction unbalances w (kg m, complex: amount and angle from the rotor mark) and A from
// the model or from trial runs (T. P. Goodman 1964, doi 10.1115/1.3653163: least squares). Modal: the
// corrections of mode k are combinations of planes that leave the other modes alone (R. E. D. Bishop,
// G. M. L. Gladwell 1959).
#pragma once
#include <core/types.hpp>

#include <vector>

namespace whirl::analysis {

/// Corrections of least squares: argmin |r0 + A w|; of all of them the smallest where A leaves some
/// undetermined.
VecXc balance_by_influence(const MatXc& A, const VecXc& r0);

/// Combinations of planes, one a column: phi W = 1, of least size. phi: a row a mode, deflection at
/// the planes.
/// @pre no more modes than planes
MatX modal_patterns(const MatX& phi);

/// Corrections mode by mode. rows[k]: rows of A and r0 that were taken at the speed of mode k.
VecXc balance_by_modes(const MatXc& A, const VecXc& r0, const MatX& patterns,
                       const std::vector<std::vector<Index>>& rows);

/// Zone of a vibration: 0 (A) to 3 (D), by how many of the three borders it oversteps.
int zone_of(double amplitude, const std::vector<double>& borders);

}  // namespace whirl::analysis
