// Stretches of film for AVX-512VL and FMA; compiled with those flags on x86-64 (see CMakeLists.txt), chosen
// at run time.
#if defined(__AVX512VL__) && defined(__FMA__)
#define WHIRL_LANES_TABLE avx512_kernels
#define WHIRL_LANES_ISA "avx512vl"
#include <elements/films/film_lanes.inl>
#else
#include <elements/films/film_lanes.hpp>
namespace whirl::elements::film_lanes {
const Kernels* avx512_kernels() { return nullptr; }
}  // namespace whirl::elements::film_lanes
#endif
