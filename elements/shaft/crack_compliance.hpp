// What a transverse crack with a straight edge adds to the rotation of a solid round shaft under
// bending, from the energy that fracture mechanics releases: strips across the edge, each like a
// cracked strip of a plate,
//   c = (1 - nu^2)/(E R^3) C,
//   C_xi  = 32/pi int int (1 - x^2) y F2(y/h)^2 dy dx,  C_eta = 32/pi int int x^2 y F1(y/h)^2 dy dx,
//   F2 = sqrt(tan u/u) (0.923 + 0.199 (1 - sin u)^4)/cos u,    u = pi y/(2 h),
//   F1 = sqrt(tan u/u) (0.752 + 2.02 y/h + 0.37 (1 - sin u)^3)/cos u,
// lengths over R, x along the edge, y depth within a strip of height h = 2 sqrt(1 - x^2). C_eta is over
// the whole edge: the crack is held open (tables that count the half in tension alone have half of
// it). Valid up to a depth of one radius.
// Source: A. D. Dimarogonas, C. A. Papadopoulos, J. Sound Vib. 91 (1983) 583.
#pragma once
#include <core/types.hpp>

namespace whirl::elements {

struct CrackCompliance {
  double xi = 0, eta = 0;  ///< rad/(N m): bending that opens the crack, and across
};

/// @pre 0 < depth <= radius, m; E > 0, Pa.
CrackCompliance crack_compliance(double depth, double radius, double E, double nu);

}  // namespace whirl::elements
