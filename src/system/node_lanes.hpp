// Node states from the unknowns, several nodes at a time, compiled once per instruction set (see
// la/lu_kernel.hpp for why only plain data crosses this interface). What a force needs; the
// derivatives of the Jacobian, which only a linearisation needs, are rotation::director's.
#pragma once
#include <cstddef>

namespace whirl::system::lanes {

/// Arrays over the nodes; distances in doubles.
struct Motion {
  std::ptrdiff_t count = 0;                               ///< of the nodes to be evaluated
  const std::ptrdiff_t* nodes = nullptr;                  ///< which they are; null: all
  const double *q = nullptr, *v = nullptr, *a = nullptr;  ///< 6 a node: u, phi, gamma2, gamma3
  const int* line = nullptr;                              ///< per node
  const int* axes = nullptr;                              ///< per node: number of its chart
  const double* falling =
      nullptr;  ///< per node: 1, or 0 for scalar degrees of freedom, which gravity does not touch
  const double* chart = nullptr;  ///< 9 a chart, column-major
  const double* turns = nullptr;  ///< 1 a line
  double gravity[3] = {};         ///< m/s2
  double limit_squared = 0.0;     ///< of |gamma|
  double* state = nullptr;        ///< out: the numbers of the NodeStates (system/node_places.hpp)
  double* D = nullptr;            ///< out: 3x2 a node, column-major, global axes
};

struct Kernels {
  const char* isa;
  /// Index of the first node with |gamma| beyond the limit or not finite, or -1.
  std::ptrdiff_t (*evaluate)(const Motion&);
};

/// The best set for the machine the program runs on.
const Kernels& kernels();

const Kernels* base_kernels();
const Kernels* avx2_kernels();    ///< nullptr where not compiled in
const Kernels* avx512_kernels();  ///< nullptr where not compiled in

}  // namespace whirl::system::lanes
