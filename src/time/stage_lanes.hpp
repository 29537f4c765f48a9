// The loop of LinearStages::finish, compiled once per instruction set and chosen at run time. Only
// plain data crosses this interface.
#pragma once
#include <cstddef>

namespace whirl::time::lanes {

/// Weights of the real solution and of the real and imaginary parts of the complex one in a sum.
struct Weights {
  double real = 0.0, re = 0.0, im = 0.0;
};

/// What is made of the solutions, entry by entry.
struct Sums {
  Weights stage[3];                   ///< accelerations of the stages
  Weights increment, rate_increment;  ///< of q over free motion, of v
  Weights end;                        ///< acceleration at the step's end
  Weights last;                       ///< increment of q over free motion at the last stage
  Weights defect;                     ///< of q at the start
  Weights at_start;                   ///< the interpolant's acceleration there
  Weights leading;                    ///< leading coefficient of the accelerations' polynomial
};

struct Vectors {
  std::ptrdiff_t n;
  const double *real, *complex;  ///< the solutions; complex interleaved
  const double *q0, *v0, *a0, *q0_low, *v0_low;
  double h;
  double share;  ///< of a0, taken from `inertia`
  double* stages;
  double *q, *v, *a, *q_low, *v_low;
  double *last_increment, *stiff, *inertia, *filter;
};

struct Kernels {
  const char* isa;
  void (*finish_three)(const Sums&, const Vectors&);  ///< of three stages
  void (*finish_two)(const Sums&, const Vectors&);
};

/// The best set for the machine the program runs on.
const Kernels& kernels();

const Kernels* base_kernels();
const Kernels* avx2_kernels();    ///< nullptr where not compiled in
const Kernels* avx512_kernels();  ///< nullptr where not compiled in

}  // namespace whirl::time::lanes
