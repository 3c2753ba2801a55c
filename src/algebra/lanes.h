/* Eight doubles side by side, for loops over the roots of one polynomial. Internal to src/algebra.
 *
 * GCC's and clang's vector extensions: one source for every width; the compiler splits eight lanes into what the machine
 * has. ALGEBRA_CLONES marks the function into which all of it is inlined: built for several widths, picked at run time.
 * All of them round alike (no contraction), so the answer does not depend on the machine.
 */
#ifndef PSCN_ALGEBRA_LANES_H
#define PSCN_ALGEBRA_LANES_H

#include <math.h>
#include <stdint.h>

enum { LANES = 8 };

typedef double lanes __attribute__((vector_size(64)));
typedef int64_t lane_mask __attribute__((vector_size(64)));

#define LANES_INLINE static inline __attribute__((always_inline))

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define ALGEBRA_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define ALGEBRA_CLONES
#endif

LANES_INLINE lanes lanes_all(double value)
{
  return value - (lanes){0};
}

LANES_INLINE lanes lanes_select(lane_mask mask, lanes yes, lanes no)
{
  return (lanes)(((lane_mask)yes & mask) | ((lane_mask)no & ~mask));
}

LANES_INLINE lanes lanes_sqrt(lanes value)
{
  lanes out;
  for (int l = 0; l < LANES; l++) {
    out[l] = __builtin_sqrt(value[l]);
  }
  return out;
}

#endif
