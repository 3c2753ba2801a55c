/* Numbers in order. Any thread. */
#ifndef PSCN_BASE_SORT_H
#define PSCN_BASE_SORT_H

#include <stddef.h>

/* Sorts values[0 .. count-1] from the least to the greatest, in place. NaNs, if any, leave the order open. */
void sort_numbers(double *values, size_t count);

/* The least of sorted[0 .. count-1], count > 0, such that the fraction `part` (0 to 1) of them is not above it. 1/2
 * gives the median, the lower one of two. */
double sorted_quantile(const double *sorted, size_t count, double part);

#endif
