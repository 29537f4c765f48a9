#include <core/isa.hpp>
#include <system/node_lanes.hpp>

namespace whirl::system::lanes {

const Kernels& kernels() {
  static const Kernels& best = best_kernels(base_kernels(), avx2_kernels(), avx512_kernels());
  return best;
}

}  // namespace whirl::system::lanes
