// Block LU kernels for AVX2 and FMA; compiled with those flags on x86-64 (see CMakeLists.txt),
// chosen at run time.
#if defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#define WHIRL_LU_TABLE avx2_kernels
#define WHIRL_LU_ISA "avx2"
#include <la/lu_kernel.inl>
#else
#include <la/lu_kernel.hpp>
namespace whirl::la::lu {
const Kernels* avx2_kernels() { return nullptr; }
}  // namespace whirl::la::lu
#endif
