/* The eight orders in which a net can be read. */
#ifndef TESTS_NET_ORDER_H
#define TESTS_NET_ORDER_H

#include <string.h>

/* Reads the net in that order: bit 1 swaps the parameters, bit 2 reverses u, bit 4 reverses v. */
static inline void in_order(double P[4][4][3], int order, double out[4][4][3])
{
  for (int n = 0; n < 16; n++) {
    int i = n / 4, j = n % 4;
    if (order & 1) i = n % 4, j = n / 4;
    if (order & 2) i = 3 - i;
    if (order & 4) j = 3 - j;
    memcpy(out[n / 4][n % 4], P[i][j], sizeof out[0][0]);
  }
}

#endif
