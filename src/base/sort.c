/* Numbers in order. */
#include "base/sort.h"

#include <math.h>
#include <stdlib.h>

static int compare(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

void sort_numbers(double *values, size_t count) { qsort(values, count, sizeof *values, compare); }

double sorted_quantile(const double *sorted, size_t count, double part)
{
  const size_t rank = (size_t)ceil(part * (double)count);
  return sorted[rank == 0 ? 0 : rank - 1];
}
