// Maxima and zeros of smooth scalar functions.
#pragma once
#include <functional>
#include <vector>

namespace whirl::analysis {

/// Maximum of f in (a, b), f(m) = fm >= f(a), f(b): Brent's parabolic steps with golden sections
/// (R. P. Brent, Algorithms for Minimization without Derivatives, 1973, ch. 5). tolerance:
/// relative, of the place.
/// @pre m between a and b, tolerance > 0.
double find_maximum(double a, double m, double fm, double b, double tolerance,
                    const std::function<double(double)>& f);

/// Numbers of the samples that are maxima: higher than what lies beside them, and by more than
/// rounding than the valleys on both sides. How close the samples are makes no difference. Neither
/// end is one.
std::vector<std::size_t> maxima_of(const std::vector<double>& samples);
/// Numbers of the first and the last sample where it is more than ten times its neighbour, or alone:
/// ends of a range that may stand on a maximum.
std::vector<std::size_t> ends_that_stand_out(const std::vector<double>& samples);

/// Zero of f in [a, b] with a sign change, by the Illinois variant of regula falsi.
/// @pre fa and fb of different sign or zero, tolerance > 0.
double find_crossing(double a, double fa, double b, double fb, double tolerance,
                     const std::function<double(double)>& f);

}  // namespace whirl::analysis
