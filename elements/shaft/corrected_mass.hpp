// A correction of a mass matrix, bounded so that the mass stays positive.
#pragma once
#include <core/types.hpp>

namespace whirl::elements {

/// How much of a correction leaves a quarter of the mass in every direction, 1 at most.
///
/// Corrections of full share only add (timoshenko_matrices.hpp). Rows of different shares leave
/// parts of both signs, which are more than the mass itself where an element is alone between two
/// such nodes, or short.
/// @param mass symmetric, positive semi-definite.
/// @param correction symmetric, zero where the mass is.
double admitted_correction(const MatX& mass, const MatX& correction);

}  // namespace whirl::elements
