// Node states in vectors of four with the 32 registers of AVX-512VL: fewer spills than with AVX2's
// 16.
#if defined(__AVX512VL__) && defined(__FMA__)
#define WHIRL_LANES_TABLE avx512_kernels
#define WHIRL_LANES_ISA "avx512vl"
#include <system/node_lanes.inl>
#else
#include <system/node_lanes.hpp>
namespace whirl::system::lanes {
const Kernels* avx512_kernels() { return nullptr; }
}  // namespace whirl::system::lanes
#endif
