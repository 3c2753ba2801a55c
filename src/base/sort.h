/* Numbers in order. Any thread. */
#ifndef PSCN_BASE_SORT_H
#define PSCN_BASE_SORT_H

#include <math.h>
#include <stdlib.h>

static inline int sort_compare(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Sorts values[0 .. count-1] from the least to the greatest, in place. NaNs, if any, leave the order open. */
static inline void sort_numbers(double *values, size_t count) { qsort(values, count, sizeof *values, sort_compare); }

/* The least of sorted[0 .. count-1], count > 0, such that the fraction `part` (0 to 1) of them is not above it. 1/2
 * gives the median, the lower one of two. */
static inline double sorted_quantile(const double *sorted, size_t count, double part)
{
  const size_t rank = (size_t)ceil(part * (double)count);
  return sorted[rank == 0 ? 0 : rank - 1];
}

#endif
