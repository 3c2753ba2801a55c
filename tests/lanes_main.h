/* For tests that are compiled once per instruction set: they are skipped if the processor lacks it. */
#ifndef PSCN_TESTS_LANES_MAIN_H
#define PSCN_TESTS_LANES_MAIN_H

#include <stdbool.h>
#include <stdio.h>

#include "base/kernel.h"

/* main's return value: run()'s, or TEST_SKIP. run() must not be inlined into main, which runs on every processor. */
static inline int lanes_main(int (*run)(void))
{
#if defined(__AVX512F__)
  const bool here = KERNEL_RUNS_AVX512;
#elif defined(__AVX2__)
  const bool here = KERNEL_RUNS_AVX2;
#else
  const bool here = true;
#endif
  if (here) return run();
  fputs("this processor has no such lanes\n", stderr);
  return TEST_SKIP;
}

#endif
