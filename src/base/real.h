/* The smaller and the larger of two doubles, as one instruction each. Unlike fmin and fmax: b where either is NaN. */
#ifndef PSCN_BASE_REAL_H
#define PSCN_BASE_REAL_H

static inline double real_min(double a, double b) { return a < b ? a : b; }
static inline double real_max(double a, double b) { return a > b ? a : b; }

#endif
