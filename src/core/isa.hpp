// Which of the kernels compiled once per instruction set the machine can run.
#pragma once
#include <cstdlib>
#include <string_view>

namespace whirl {

/// The words that WHIRL_ISA may be.
inline bool known_isa(std::string_view word) {
  return word.empty() || word == "baseline" || word == "avx2" || word == "avx512";
}

/// The best of three tables; avx2 and avx512 may be null (not compiled in). AVX-512 means F and VL,
/// both need FMA. The environment variable WHIRL_ISA=baseline or avx2 asks for less than the
/// machine can: the same digits on unlike machines, tests.
template <class Kernels>
const Kernels& best_kernels(const Kernels* baseline, const Kernels* avx2, const Kernels* avx512) {
#if defined(__x86_64__) && defined(__GNUC__)
  __builtin_cpu_init();
  const char* const variable = std::getenv("WHIRL_ISA");
  const std::string_view most = variable ? variable : "";
  if (most == "baseline") return *baseline;
  if (most == "avx2") avx512 = nullptr;
  const bool fma = __builtin_cpu_supports("fma");
  if (avx512 && fma && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
    return *avx512;
  if (avx2 && fma && __builtin_cpu_supports("avx2")) return *avx2;
#else
  (void)avx2;
  (void)avx512;
#endif
  return *baseline;
}

}  // namespace whirl
