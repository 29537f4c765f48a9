// Stretches of film for AVX2 and FMA; compiled with those flags on x86-64 (see CMakeLists.txt), chosen
// at run time.
#if defined(__AVX2__) && defined(__FMA__)
#define WHIRL_LANES_TABLE avx2_kernels
#define WHIRL_LANES_ISA "avx2"
#include <elements/films/film_lanes.inl>
#else
#include <elements/films/film_lanes.hpp>
namespace whirl::elements::film_lanes {
const Kernels* avx2_kernels() { return nullptr; }
}  // namespace whirl::elements::film_lanes
#endif
