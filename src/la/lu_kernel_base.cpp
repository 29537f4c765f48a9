// Block LU kernels for the instruction set the whole program is built for.
#ifdef __AVX2__
#include <immintrin.h>
#endif
#define WHIRL_LU_TABLE base_kernels
#define WHIRL_LU_ISA "baseline"
#include <la/lu_kernel.inl>
