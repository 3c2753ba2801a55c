/* Quadruple precision nets: evaluation and restriction by de Casteljau's algorithm (G. Farin, Curves and Surfaces for
 * CAGD). */
#include "reference/quad.h"

#include <math.h>

quad quad_sqrt(quad x)
{
  if (!(x > 0) || x - x != 0) return x > 0 ? x : 0;
  quad unit = 1; /* scales x to where doubles are normal */
  for (; x > 0x1p1000; x *= 0x1p-1000) unit *= 0x1p500;
  for (; x < 0x1p-1000; x *= 0x1p1000) unit *= 0x1p-500;
  int exponent;
  double leading = frexp((double)x, &exponent);
  if (exponent & 1) {
    leading *= 2;
    exponent--;
  }
  quad root = (quad)ldexp(sqrt(leading), exponent / 2);
  for (int k = 0; k < 2; k++) root = (root + x / root) / 2; /* 53 bits, 106 bits, all */
  return unit * root;
}

quad quad_net_magnitude(const struct quad_net *net)
{
  quad m = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) m = quad_max(m, quad_abs(net->c[i][j]));
  return m;
}

/* Value and derivative of the cubic with Bernstein coefficients c at t. */
static void cubic_jet(const quad c[4], quad t, quad *value, quad *derivative)
{
  quad s = 1 - t, p[3], q[2];
  for (int k = 0; k < 3; k++) p[k] = s * c[k] + t * c[k + 1];
  for (int k = 0; k < 2; k++) q[k] = s * p[k] + t * p[k + 1];
  *value = s * q[0] + t * q[1];
  *derivative = 3 * (q[1] - q[0]);
}

struct quad_jet quad_net_jet(const struct quad_net *net, quad u, quad v)
{
  quad row[4], row_dv[4], mixed;
  for (int i = 0; i < 4; i++) cubic_jet(net->c[i], v, &row[i], &row_dv[i]);
  struct quad_jet jet;
  cubic_jet(row, u, &jet.value, &jet.du);
  cubic_jet(row_dv, u, &jet.dv, &mixed);
  return jet;
}

/* The coefficients of the cubic over [0,t] (high == 0) or [t,1] (high == 1), in place. */
static void cubic_cut(quad c[4], quad t, int high)
{
  const quad s = 1 - t;
  for (int level = 1; level < 4; level++) {
    if (high)
      for (int k = 0; k < 4 - level; k++) c[k] = s * c[k] + t * c[k + 1];
    else
      for (int k = 3; k >= level; k--) c[k] = s * c[k - 1] + t * c[k];
  }
}

/* The coefficients over [t0, t0 + w]. 1 - t0 and w / (1 - t0) round in quadruple precision only. */
static void cubic_restrict(quad c[4], quad t0, quad w)
{
  if (t0 > 0) cubic_cut(c, t0, 1);
  const quad end = w / (1 - t0);
  if (end < 1) cubic_cut(c, end, 0);
}

void quad_net_restrict(const struct quad_net *net, quad u0, quad wu, quad v0, quad wv, struct quad_net *out)
{
  *out = *net;
  for (int i = 0; i < 4; i++) cubic_restrict(out->c[i], v0, wv);
  for (int j = 0; j < 4; j++) {
    quad column[4] = {out->c[0][j], out->c[1][j], out->c[2][j], out->c[3][j]};
    cubic_restrict(column, u0, wu);
    for (int i = 0; i < 4; i++) out->c[i][j] = column[i];
  }
}
