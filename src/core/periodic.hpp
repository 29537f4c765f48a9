// Fourier coefficients of periodic curves given by points, and how far a sum of harmonics swings.
#pragma once
#include <core/types.hpp>
#include <vector>

namespace whirl {

/// c_k of f(x) = sum c_k exp(2 pi i k x/period) for the curve of straight lines through (x_j, f_j), the
/// last of them back to the first one a period later. Exact for such a curve.
/// @pre two points or more, x increasing within less than a period, k not zero.
Complex periodic_coefficient(const std::vector<double>& x, const std::vector<double>& f,
                             double period, int k);

/// Highest less lowest value of sum_k Re(c_k exp(i order_k x)) over all x. Where the orders have no
/// common period of a dozen turns or less it is twice the sum of the amplitudes, which they come near to.
/// @pre as many orders as coefficients; the orders of several are above zero.
double calc_swing(const std::vector<Complex>& c, const std::vector<double>& orders);

}  // namespace whirl
