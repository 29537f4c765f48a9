// Points in the unit cube, each a function of seed, dimension and number alone: any process gets
// the same, in any order.
#pragma once
#include <cstddef>
#include <cstdint>

namespace whirl::sweep {

/// In (0, 1), independent of all others.
double random_point(std::uint64_t seed, std::size_t dimension, std::int64_t sample);
/// Latin hypercube: one of `samples` points in every n-th of the axis, at a random place in it.
double latin_point(std::uint64_t seed, std::size_t dimension, std::int64_t sample,
                   std::int64_t samples);
/// Sobol's sequence with the direction numbers of S. Joe and F. Y. Kuo (SIAM J. Sci. Comput. 30
/// (2008) 2635, doi 10.1137/070709359), shifted digit by digit by the seed.
/// @pre dimension < sobol_dimensions
double sobol_point(std::uint64_t seed, std::size_t dimension, std::int64_t sample);
inline constexpr std::size_t sobol_dimensions = 10;

}  // namespace whirl::sweep
