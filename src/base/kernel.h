/* Sources compiled once per instruction set and linked into one program (pscn_kernels in CMakeLists.txt).
 *
 * In these sources, PSCN_KERNEL is the name of the set: baseline, avx2 or avx512. KERNEL(name) is the
 * name that one compilation gives, and KERNEL_NAME the set's name as a text. Elsewhere, PSCN_HAS_AVX2 and
 * PSCN_HAS_AVX512 say which sets there are besides the baseline, and KERNEL_RUNS_... whether this processor has them.
 * KERNEL_BEST(name) is the best version of a function or object that is compiled for the baseline and AVX2.
 */
#ifndef PSCN_BASE_KERNEL_H
#define PSCN_BASE_KERNEL_H

#define KERNEL_JOIN(name, kernel) name##_##kernel
#define KERNEL_EXPANDED(name, kernel) KERNEL_JOIN(name, kernel)
#define KERNEL(name) KERNEL_EXPANDED(name, PSCN_KERNEL)

#define KERNEL_TEXT(kernel) #kernel
#define KERNEL_TEXT_EXPANDED(kernel) KERNEL_TEXT(kernel)
#define KERNEL_NAME KERNEL_TEXT_EXPANDED(PSCN_KERNEL)

#define KERNEL_RUNS_AVX2                                                                               \
  (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") && \
   __builtin_cpu_supports("bmi2"))
#define KERNEL_RUNS_AVX512                                                                        \
  (KERNEL_RUNS_AVX2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && \
   __builtin_cpu_supports("avx512vl"))
#if defined(PSCN_HAS_AVX2)
#define KERNEL_BEST(name) (*(KERNEL_RUNS_AVX2 ? &name##_avx2 : &name##_baseline))
#else
#define KERNEL_BEST(name) name##_baseline
#endif

#endif
