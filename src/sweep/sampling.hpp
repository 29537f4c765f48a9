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

/// Quantile of one number in a run of Saltelli's scheme: run = point (d + 2) + k, k = 0 the point, 1
/// its other, 2 + j the point with number j of its other (A. Saltelli et al., Comput. Phys. Commun.
/// 181 (2010) 259, doi 10.1016/j.cpc.2009.09.018). Sobol's points up to five numbers, else random.
double saltelli_point(std::uint64_t seed, std::size_t dimension, std::size_t dimensions,
                      std::int64_t run);

/// Level 0, 1/3, 2/3 or 1 of one number in a run of Morris' scheme: run = path (d + 1) + k, k numbers
/// moved so far (M. D. Morris, Technometrics 33 (1991) 161, doi 10.1080/00401706.1991.10484804).
double morris_level(std::uint64_t seed, std::size_t dimension, std::size_t dimensions,
                    std::int64_t run);
/// Which number moves between runs k and k + 1 of a path.
std::size_t morris_moved(std::uint64_t seed, std::size_t dimensions, std::int64_t path,
                         std::size_t k);
/// Quantile of a level: 2.5 % to 97.5 %, for distributions without ends.
inline double morris_quantile(double level) { return 0.025 + 0.95 * level; }

}  // namespace whirl::sweep
