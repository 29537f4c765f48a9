#include <core/isa.hpp>
#include <time/stage_lanes.hpp>

namespace whirl::time::lanes {

const Kernels& kernels() {
  static const Kernels& best = best_kernels(base_kernels(), avx2_kernels(), avx512_kernels());
  return best;
}

}  // namespace whirl::time::lanes
