// Shaft element force in vectors of four with the 32 registers of AVX-512VL: fewer spills than with
// AVX2's 16.
#if defined(__AVX512VL__) && defined(__FMA__)
#define WHIRL_LANES_TABLE avx512_kernels
#define WHIRL_LANES_ISA "avx512vl"
#include <elements/shaft/shaft_lanes.inl>
#else
#include <elements/shaft/shaft_lanes.hpp>
namespace whirl::elements::lanes {
const Kernels* avx512_kernels() { return nullptr; }
}  // namespace whirl::elements::lanes
#endif
