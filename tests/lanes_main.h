/* For tests that are compiled once per instruction set: where the processor lacks it they are skipped. */
#ifndef PSCN_TESTS_LANES_MAIN_H
#define PSCN_TESTS_LANES_MAIN_H

#include <stdbool.h>
#include <stdio.h>

/* What main returns: what run() does, or TEST_SKIP. run() must not be inlined into main, which runs on all. */
static inline int lanes_main(int (*run)(void))
{
#if defined(__AVX512F__)
  const bool here = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                    __builtin_cpu_supports("avx512vl");
#elif defined(__AVX2__)
  const bool here = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  const bool here = true;
#endif
  if (here) return run();
  fputs("this processor has no such lanes\n", stderr);
  return TEST_SKIP;
}

#endif
