#include <core/isa.hpp>
#include <la/lu_kernel.hpp>

namespace whirl::la::lu {

const Kernels& kernels() {
  static const Kernels& best = best_kernels(base_kernels(), avx2_kernels(), avx512_kernels());
  return best;
}

}  // namespace whirl::la::lu
