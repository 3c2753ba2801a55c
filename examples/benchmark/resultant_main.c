/* resultant_time [RUNS]: ns a candidate for r(u), on every instruction set of this processor, taking turns. A line
 * each, tabs between: instruction set, lanes, median over runs, smallest, largest; the widest last. */
#include <stdio.h>
#include <stdlib.h>

#include "base/kernel.h"
#include "base/sort.h"
#include "resultant_time.h"

enum { REPEATS = 2000, MAX_RUNS = 1000 };

struct contestant {
  const char *name;
  double (*time)(int repeats, int *out_lanes, double *out_sum);
  int present, lanes;
  double ns[MAX_RUNS];
};

int main(int argc, char **argv)
{
  static struct contestant list[] = {
    {.name = "baseline", .time = resultant_time_baseline, .present = 1},
#if defined(PSCN_HAS_AVX2)
    {.name = "avx2", .time = resultant_time_avx2},
#endif
#if defined(PSCN_HAS_AVX512)
    {.name = "avx512", .time = resultant_time_avx512},
#endif
  };
  const size_t count = sizeof list / sizeof list[0], runs = argc > 1 ? strtoul(argv[1], NULL, 10) : 9;
  if (runs == 0 || runs > MAX_RUNS) return EXIT_FAILURE;
  if (count > 1) list[1].present = KERNEL_RUNS_AVX2;
  if (count > 2) list[2].present = KERNEL_RUNS_AVX512;
  double sum = 0;
  for (size_t r = 0; r < runs; r++) {
    for (size_t k = 0; k < count; k++) {
      double part;
      if (!list[k].present) continue;
      list[k].ns[r] = list[k].time(REPEATS, &list[k].lanes, &part);
      sum += part;
    }
  }
  fprintf(stderr, "r(u) of degree 18, %zu runs (coefficients add up to %.6g)\n", runs, sum);
  for (size_t k = 0; k < count; k++) {
    if (!list[k].present) continue;
    sort_numbers(list[k].ns, runs);
    printf("%s\t%d\t%.1f\t%.1f\t%.1f\n", list[k].name, list[k].lanes, sorted_quantile(list[k].ns, runs, 0.5),
           list[k].ns[0], list[k].ns[runs - 1]);
  }
  return 0;
}
