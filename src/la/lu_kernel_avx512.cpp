// Block LU kernels for AVX-512; compiled with those flags on x86-64 (see CMakeLists.txt), chosen at
// run time.
#if defined(__AVX512F__)
#include <immintrin.h>
#define WHIRL_LU_TABLE avx512_kernels
#define WHIRL_LU_ISA "avx512"
#include <la/lu_kernel.inl>
#else
#include <la/lu_kernel.hpp>
namespace whirl::la::lu {
const Kernels* avx512_kernels() { return nullptr; }
}  // namespace whirl::la::lu
#endif
