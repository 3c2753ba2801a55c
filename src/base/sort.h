/* Numbers in order. Any thread. */
#ifndef PSCN_BASE_SORT_H
#define PSCN_BASE_SORT_H

#include <stddef.h>

/* values[0 .. count-1] from the least to the greatest, in place; NANs, if any, leave the order open. */
void sort_numbers(double *values, size_t count);

/* The least of sorted[0 .. count-1], count > 0, that `part` (0 to 1) of them do not pass: a part of 1/2 is the median,
 * the lower one of two. */
double sorted_quantile(const double *sorted, size_t count, double part);

#endif
