// The products that a time step of a linear motion asks for.
#pragma once
#include <la/block.hpp>

namespace whirl::la {

/// What the steps of a linear motion ask of the matrices, all of it in one pass over them.
struct StepProducts {
  const VecX &q, &v, &stiff_of, &inertia_of, &filter_of;
  double shift;
  VecX& bound;    ///< K q + C v
  VecX& rate;     ///< K v
  VecX& stiff;    ///< K stiff_of
  VecX& inertia;  ///< M inertia_of
  VecX& filter;   ///< (shift M + C) filter_of
};
/// @pre all of the length of the matrices, what is written apart from what is read.
void multiply(const MCK& m, const StepProducts& x);

}  // namespace whirl::la
