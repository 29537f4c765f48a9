// General sparse LU on the active unknowns: KLU with AMD ordering (SuiteSparse).
#pragma once
#include <la/direct.hpp>

namespace whirl::la {

template <class Scalar>
std::unique_ptr<DirectSolver<Scalar>> make_klu_solver(const BlockPattern& pattern,
                                                      std::span<const unsigned char> active);

}  // namespace whirl::la
