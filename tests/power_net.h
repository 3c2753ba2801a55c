/* The control net over [-1,1] x [-1,1] of a polynomial in power form. */
#ifndef PSCN_TESTS_POWER_NET_H
#define PSCN_TESTS_POWER_NET_H

/* power[i][j] is the coefficient of x^i y^j; x runs across the net's rows. Values are products of blossoms: that of
 * x^i at node n is the mean of the products of i of three numbers, of which n are 1 and the others -1. */
static inline void power_net(double power[4][4], double net[4][4])
{
  static const double blossom[4][4] = {
    {1, 1, 1, 1}, {-1, -1 / 3.0, 1 / 3.0, 1}, {1, -1 / 3.0, -1 / 3.0, 1}, {-1, 1, -1, 1}};
  for (int n = 0; n < 16; n++) {
    net[n / 4][n % 4] = 0;
    for (int k = 0; k < 16; k++)
      net[n / 4][n % 4] += power[k / 4][k % 4] * blossom[k / 4][n / 4] * blossom[k % 4][n % 4];
  }
}

#endif
