#include <core/isa.hpp>
#include <elements/shaft/shaft_lanes.hpp>

namespace whirl::elements::lanes {

const Kernels& kernels() {
  static const Kernels& best = best_kernels(base_kernels(), avx2_kernels(), avx512_kernels());
  return best;
}

}  // namespace whirl::elements::lanes
