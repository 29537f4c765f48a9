#include <elements/shaft_lanes.hpp>

namespace whirl::elements::lanes {

namespace {
const Kernels& choose() {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  if (avx512_kernels() && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma")) return *avx512_kernels();
  if (avx2_kernels() && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return *avx2_kernels();
#endif
  return *base_kernels();
}
}  // namespace

const Kernels& kernels() {
  static const Kernels& best = choose();
  return best;
}

}  // namespace whirl::elements::lanes
