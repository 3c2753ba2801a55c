/* How long forming r(u) takes, one candidate a lane: the resultant of degree 18 of two bicubic nets, in scaled
 * Bernstein form, by Bezout's 3x3 determinant. Compiled once per instruction set; resultant_main.c calls those that the
 * processor has. */
#include "resultant_time.h"

#include "base/clock.h"
#include "base/kernel.h"
#include "base/lanes.h"

#define BEZOUT_REAL lanes
#define BEZOUT_NAME(name) bezout_lanes_##name
#include "algebra/bezout.h"

enum { NETS = 64, DEGREE = 18 };

/* Out of line, as a kernel calls it: takes nets, returns coefficients. */
static __attribute__((noinline)) void form(const lanes a[16], const lanes b[16], lanes c[DEGREE + 1])
{
  bezout_lanes_resultant(3, 3, a, b, c);
}

double KERNEL(resultant_time)(int repeats, int *out_lanes, double *out_sum)
{
  static lanes net[NETS + 1][16];
  unsigned long long state = 1;
  for (int n = 0; n <= NETS; n++) {
    for (int k = 0; k < 16 * LANES; k++) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      net[n][k / LANES][k % LANES] = (double)(state >> 11) * 0x1p-52 - 1;
    }
  }
  lanes c[DEGREE + 1], sum = {0};
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  for (int r = 0; r < repeats; r++) {
    for (int n = 0; n < NETS; n++) {
      form(net[n], net[n + 1], c);
      sum += c[r % (DEGREE + 1)];
    }
  }
  const double seconds = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  *out_lanes = LANES;
  *out_sum = 0;
  for (int k = 0; k < LANES; k++) *out_sum += sum[k];
  return 1e9 * seconds / ((double)repeats * NETS * LANES);
}
