// What a response depends on, from the runs of a scheme of sensitivity (design.hpp).
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace whirl::sweep {

/// Shares of the variance of a response.
struct SobolIndex {
  double first = 0, total = 0;              ///< of the number alone; with all it interacts with
  double first_error = 0, total_error = 0;  ///< standard errors, from 200 bootstrap samples
};
/// One a dimension: first indices by A. Saltelli et al. (Comput. Phys. Commun. 181 (2010) 259, doi
/// 10.1016/j.cpc.2009.09.018, table 2 b, about the mean), total ones by M. J. W. Jansen (ibid. 117
/// (1999) 35, doi 10.1016/S0010-4655(98)00154-4): of a key without influence both are zero. response: of the runs in order; points with a run that gave no
/// value (nan) are left out. used: points left. Empty when fewer than two are, or nothing varies.
/// @pre a whole number of points of dimensions + 2 runs
std::vector<SobolIndex> sobol_indices(std::span<const double> response, std::size_t dimensions,
                                      std::size_t& used);

/// Elementary effects: change of a response as one number moves, over the distance it moves in
/// level (2/3 of its range), sign by direction.
struct MorrisEffect {
  double mean = 0, magnitude = 0, deviation = 0;  ///< mu, mu*, sigma, in the unit of the response
  std::size_t paths = 0;                          ///< that gave it
};
/// One a dimension; seed: of the design.
/// @pre a whole number of paths of dimensions + 1 runs
std::vector<MorrisEffect> morris_effects(std::span<const double> response, std::size_t dimensions,
                                         unsigned long long seed);

}  // namespace whirl::sweep
