// Fourier coefficients of periodic curves given by points.
#pragma once
#include <core/types.hpp>
#include <vector>

namespace whirl {

/// c_k of f(x) = sum c_k exp(2 pi i k x/period) for the curve of straight lines through (x_j, f_j), the
/// last of them back to the first one a period later. Exact for such a curve.
/// @pre two points or more, x increasing within less than a period, k not zero.
Complex periodic_coefficient(const std::vector<double>& x, const std::vector<double>& f,
                             double period, int k);

}  // namespace whirl
