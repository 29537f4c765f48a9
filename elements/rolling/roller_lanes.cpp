#include <core/isa.hpp>
#include <elements/rolling/roller_lanes.hpp>

namespace whirl::elements::roller_lanes {

const Kernels& kernels() {
  static const Kernels& best = best_kernels(base_kernels(), avx2_kernels(), avx512_kernels());
  return best;
}

}  // namespace whirl::elements::roller_lanes
