/* resultant_time.c under the name of each instruction set. Returns ns a candidate over `repeats` x 64 resultants, the
 * lanes of a register, and a sum of coefficients, so that no work can be optimized away. */
#ifndef RESULTANT_TIME_H
#define RESULTANT_TIME_H

double resultant_time_baseline(int repeats, int *out_lanes, double *out_sum);
double resultant_time_avx2(int repeats, int *out_lanes, double *out_sum);
double resultant_time_avx512(int repeats, int *out_lanes, double *out_sum);

#endif
