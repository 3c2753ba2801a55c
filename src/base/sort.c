/* Numbers in order. */
#include "base/sort.h"

#include <stdlib.h>

static int compare(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

void sort_numbers(double *values, size_t count)
{
  qsort(values, count, sizeof *values, compare);
}

double sorted_quantile(const double *sorted, size_t count, double part)
{
  const double place = part * (double)(count - 1);
  const size_t below = (size_t)place, above = below + 1 < count ? below + 1 : below;
  return sorted[below] + (place - (double)below) * (sorted[above] - sorted[below]);
}
