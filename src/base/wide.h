/* The widest floating-point type of the compiler: IEEE binary128 on x86-64 and arm64. Slow (software): for what double
 * cannot decide. Elsewhere long double as it is; WIDE_ROUNDOFF states its precision. */
#ifndef PSCN_BASE_WIDE_H
#define PSCN_BASE_WIDE_H

#include <float.h>

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 wide;
#define WIDE_ROUNDOFF ((wide)0x1p-113)
#else
typedef long double wide;
#define WIDE_ROUNDOFF (LDBL_EPSILON / 2)
#endif

static inline wide wide_abs(wide a) { return a < 0 ? -a : a; }
static inline wide wide_max(wide a, wide b) { return a > b ? a : b; }

/* The weights of a cubic's control values at t, and those of their differences in its derivative. */
static inline void wide_cubic(wide t, wide w[4], wide dw[3])
{
  const wide s = 1 - t;
  w[0] = s * s * s, w[1] = 3 * s * s * t, w[2] = 3 * s * t * t, w[3] = t * t * t;
  dw[0] = 3 * s * s, dw[1] = 6 * s * t, dw[2] = 3 * t * t;
}

#endif
