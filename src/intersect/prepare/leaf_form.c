/* What a leaf's resultants are made of: its net at its true degree. See leaf.h. */
#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/prepare/leaf.h"

/* A declared control point carries half a unit in the last place from its decimal form and a few from its transforms. A
 * patch whose excess over a lower degree is at most this, relative to its largest coordinate, was meant to be of that
 * degree. */
#define DEGREE_SLACK (8 * UNIT_ROUNDOFF)

static void true_degrees(const struct model_patch *patch, int *m, int *n)
{
  double x[3][4][4], far = 0;
  memcpy(x, patch->x, sizeof x);
  for (int k = 0; k < 3; k++) far = real_max(far, fabs(patch->center[k]));
  patch_bidegree(x, DEGREE_SLACK * (1 + far / patch->scale), m, n);
}

/* Whether v is kept, not u. u is kept if an edge u = 0 or 1 is collapsed, because r(v) would be identically zero at the
 * apex; v the other way round; otherwise the parameter of higher degree, because the determinant is smaller then. */
static bool keep_v(int m, int n, const double x[3][4][4])
{
  const int rows = patch_border_is_point(x, 0) + patch_border_is_point(x, 1);
  const int columns = patch_border_is_point(x, 2) + patch_border_is_point(x, 3);
  if (rows != columns) return columns > rows;
  return n > m;
}

/* How far, on [0,1]^2, the polynomial of bidegree (m,n) with the net r is from the bicubic x: the largest distance of x
 * from r's net raised to (3,3), plus the roundings of raising it (two degrees twice, three each). */
static double reduction_excess(double r[4][4], int m, int n, double x[4][4])
{
  double up[4][4], excess = 0, size = 0;
  memcpy(up, r, sizeof up);
  for (int d = n; d < 3; d++)
    for (int i = 0; i <= m; i++)
      for (int j = d + 1; j >= 0; j--)
        up[i][j] = ((j > 0 ? j * up[i][j - 1] : 0) + (j <= d ? (d + 1 - j) * up[i][j] : 0)) / (d + 1);
  for (int d = m; d < 3; d++)
    for (int j = 0; j < 4; j++)
      for (int i = d + 1; i >= 0; i--)
        up[i][j] = ((i > 0 ? i * up[i - 1][j] : 0) + (i <= d ? (d + 1 - i) * up[i][j] : 0)) / (d + 1);
  for (int k = 0; k < 16; k++) {
    excess = real_max(excess, fabs(up[k / 4][k % 4] - x[k / 4][k % 4]));
    size = real_max(size, fabs(r[k / 4][k % 4]));
  }
  return m == 3 && n == 3 ? 0 : excess + 16 * UNIT_ROUNDOFF * size;
}

void leaf_form_make(const struct model_patch *patch, const struct leaf *leaf, struct leaf_form *out)
{
  int m, n;
  true_degrees(patch, &m, &n);
  double x[3][4][4];
  memcpy(x, leaf->x, sizeof x);
  const bool v_kept = out->v_kept = keep_v(m, n, (const double(*)[4][4])x);
  out->kept_degree = (uint8_t)(v_kept ? n : m), out->eliminated_degree = (uint8_t)(v_kept ? m : n);
  for (int end = 0; end < 2; end++)
    out->zeros[end] = leaf_border_is_point(patch, leaf, 2 * v_kept + end) ? out->eliminated_degree : 0;
  out->own = m == 3 && n == 3 && !v_kept, out->size = 1, out->excess = 0;
  for (int k = 0; k < 3 && !out->own; k++) {
    double r[4][4];
    patch_reduce(x[k], m, n, r);
    out->excess = real_max(out->excess, reduction_excess(r, m, n, x[k]));
    for (int at = 0; at < 16; at++) {
      const int i = at / 4, j = at % 4;
      out->x[k][at] = v_kept ? r[j][i] : r[i][j];
      out->size = real_max(out->size, fabs(r[i][j]));
    }
  }
}
