/* The plane polynomials of one ray on a box of a leaf's parameters, their coefficients side by side.
 *
 * Internal to src/intersect/lanes: cover.c includes it. The lanes are not rays here, because boxes are examined for
 * only one ray or two.
 */
#ifndef PSCN_INTERSECT_LANES_COVER_NETS_H
#define PSCN_INTERSECT_LANES_COVER_NETS_H

#include <stdbool.h>

#include "base/lanes.h"
#include "base/real.h"

/* A row of a net, its coefficients side by side. */
typedef four_doubles row;
typedef int64_t row_mask __attribute__((vector_size(32)));

LANES_INLINE row row_all(double x) { return x - (row){0}; }

LANES_INLINE bool row_any(row_mask mask)
{
#if defined(__AVX__)
  return _mm256_movemask_pd((__m256d)mask) != 0;
#else
  return (mask[0] | mask[1] | mask[2] | mask[3]) != 0;
#endif
}

/* A polynomial in Bernstein form, coefficient (i,j) in row i. */
struct cover_net {
  row c[4];
};

/* Replaces four cubics by their lower halves. */
LANES_INLINE void rows_halve(row c[4], row high[4])
{
  const row c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
  const row q0 = 0.5 * (c0 + c1), q1 = 0.5 * (c1 + c2), q2 = 0.5 * (c2 + c3);
  const row r0 = 0.5 * (q0 + q1), r1 = 0.5 * (q1 + q2), s = 0.5 * (r0 + r1);
  c[1] = q0, c[2] = r0, c[3] = s;
  high[0] = s, high[1] = r1, high[2] = q2, high[3] = c3;
}

/* Replaces the net by that of the lower half of its box, across u or v. */
LANES_INLINE void net_halve(struct cover_net *net, bool across_u, struct cover_net *high)
{
  if (!across_u) four_doubles_turn(net->c);
  rows_halve(net->c, high->c);
  if (!across_u) four_doubles_turn(net->c), four_doubles_turn(high->c);
}

/* The largest absolute value of a coefficient. */
LANES_INLINE double net_size(const struct cover_net *net)
{
  double size = 0;
  for (int n = 0; n < 16; n++) size = real_max(fabs(net->c[n / 4][n % 4]), size);
  return size;
}

/* Whether the net, its coefficients off by `error`, may change sign. */
LANES_INLINE bool net_changes(const struct cover_net *net, double error)
{
  const row *c = net->c, e = row_all(error);
  return row_any((c[0] <= e) | (c[1] <= e) | (c[2] <= e) | (c[3] <= e)) &&
         row_any((c[0] >= -e) | (c[1] >= -e) | (c[2] >= -e) | (c[3] >= -e));
}

LANES_INLINE void net_combine(const struct cover_net *a, const struct cover_net *b, double p, double q,
                              struct cover_net *out)
{
  for (int n = 0; n < 4; n++) out->c[n] = p * a->c[n] + q * b->c[n];
}

/* Bounds the least growth of four cubics and the largest change of others, by differences of neighbouring
 * coefficients. */
LANES_INLINE void rows_slopes(const row grow[4], const row move[4], double error, double *least, double *most)
{
  *least = INFINITY, *most = 0;
  for (int n = 0; n < 3; n++) {
    const row grows = grow[n + 1] - grow[n], moves = move[n + 1] - move[n];
    for (int k = 0; k < 4; k++) *least = real_min(grows[k], *least), *most = real_max(fabs(moves[k]), *most);
  }
  *least -= 2 * error, *most += 2 * error;
}

/* Whether two polynomials, which aim along u and v, take no pair of values twice. Between two points the values change
 * by the mean Jacobian on the way, times it. Its elements lie within three times the coefficients' differences. So it
 * is not singular if the product of its diagonal exceeds that of the other elements. */
LANES_INLINE bool nets_one_to_one(const struct cover_net *along_u, double error_u, const struct cover_net *along_v,
                                  double error_v)
{
  struct cover_net turned_u = *along_u, turned_v = *along_v;
  double least_u, least_v, most_u, most_v;
  four_doubles_turn(turned_u.c), four_doubles_turn(turned_v.c);
  rows_slopes(along_u->c, turned_u.c, error_u, &least_u, &most_u);
  rows_slopes(turned_v.c, along_v->c, error_v, &least_v, &most_v);
  return least_u > 0 && least_v > 0 && least_u * least_v > (1 + 8 * UNIT_ROUNDOFF) * (most_u * most_v);
}

/* Whether the box is not cleared: none of a, b and two combinations, which aim along the box's parameters, keeps one
 * sign on it, and the combinations may take a pair of values twice if it has a root. `size` bounds the coefficients,
 * `error` their errors. */
LANES_INLINE bool nets_full(const struct cover_net *a, const struct cover_net *b, bool has_root, double size,
                            double error)
{
  const double au = (a->c[3][1] + a->c[3][2]) - (a->c[0][1] + a->c[0][2]);
  const double av = (a->c[1][3] + a->c[2][3]) - (a->c[1][0] + a->c[2][0]);
  const double bu = (b->c[3][1] + b->c[3][2]) - (b->c[0][1] + b->c[0][2]);
  const double bv = (b->c[1][3] + b->c[2][3]) - (b->c[1][0] + b->c[2][0]);
  const double sense = au * bv < av * bu ? -1 : 1;
  const double combined = error + 8 * UNIT_ROUNDOFF * size; /* with three roundings of its own */
  const double error_u = combined * (fabs(bv) + fabs(av)), error_v = combined * (fabs(bu) + fabs(au));
  struct cover_net along_u, along_v;
  net_combine(a, b, sense * bv, -sense * av, &along_u);
  if (!net_changes(&along_u, error_u)) return false;
  net_combine(a, b, -sense * bu, sense * au, &along_v);
  if (!net_changes(&along_v, error_v)) return false;
  if (has_root && nets_one_to_one(&along_u, error_u, &along_v, error_v)) return false;
  return net_changes(a, error) && net_changes(b, error);
}

#endif
