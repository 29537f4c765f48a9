// Four entries at a time with the 32 registers of AVX-512VL: the weights stay in them.
#if defined(__AVX512VL__) && defined(__FMA__)
#define WHIRL_LANES_TABLE avx512_kernels
#define WHIRL_LANES_ISA "avx512vl"
#include <time/stage_lanes.inl>
#else
#include <time/stage_lanes.hpp>
namespace whirl::time::lanes {
const Kernels* avx512_kernels() { return nullptr; }
}  // namespace whirl::time::lanes
#endif
