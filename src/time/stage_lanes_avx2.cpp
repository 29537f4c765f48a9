// Four entries at a time.
#if defined(__AVX2__) && defined(__FMA__)
#define WHIRL_LANES_TABLE avx2_kernels
#define WHIRL_LANES_ISA "avx2"
#include <time/stage_lanes.inl>
#else
#include <time/stage_lanes.hpp>
namespace whirl::time::lanes {
const Kernels* avx2_kernels() { return nullptr; }
}  // namespace whirl::time::lanes
#endif
