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

/* Whether a Jacobian is not singular, given the differences along u (`grow_u`) and along v (`move_u`) of a polynomial that
 * aims along u, and those along v (`grow_v`) and along u (`move_v`) of one that aims along v: the product of its diagonal
 * exceeds that of the other elements. */
LANES_INLINE bool slopes_regular(const row grow_u[4], const row move_u[4], double error_u, const row grow_v[4],
                                 const row move_v[4], double error_v)
{
  double least_u, least_v, most_u, most_v;
  rows_slopes(grow_u, move_u, error_u, &least_u, &most_u);
  rows_slopes(grow_v, move_v, error_v, &least_v, &most_v);
  return least_u > 0 && least_v > 0 && least_u * least_v > (1 + 8 * UNIT_ROUNDOFF) * (most_u * most_v);
}

/* Whether two polynomials, which aim along u and v, take no pair of values twice. Between two points the values change
 * by the mean Jacobian on the way, times it. Its elements lie within three times the coefficients' differences. */
LANES_INLINE bool nets_one_to_one(const struct cover_net *along_u, double error_u, const struct cover_net *along_v,
                                  double error_v)
{
  struct cover_net turned_u = *along_u, turned_v = *along_v;
  four_doubles_turn(turned_u.c), four_doubles_turn(turned_v.c);
  return slopes_regular(along_u->c, turned_u.c, error_u, turned_v.c, along_v->c, error_v);
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

/* ---- boxes at a pole ---- */

/* Turns the net so that the border (geometry/edges.h) is row 0. */
LANES_INLINE void net_turn(struct cover_net *net, int border)
{
  if (border >= 2) four_doubles_turn(net->c);
  if (!(border & 1)) return;
  const struct cover_net old = *net;
  for (int n = 0; n < 4; n++) net->c[n] = old.c[3 - n];
}

/* Divides a net that is constant on row 0 by the distance from there, as far as differences within rows are concerned:
 * those of row 0 vanish, and the quotient's have 3/n times those of row n. *out has rows and columns exchanged. */
LANES_INLINE void net_divide(const struct cover_net *net, struct cover_net *out)
{
  out->c[0] = out->c[1] = 3 * net->c[1];
  out->c[2] = 1.5 * net->c[2], out->c[3] = net->c[3];
  four_doubles_turn(out->c);
}

/* Whether two polynomials, constant on row 0, take no pair of values twice beside it; they aim along the distance d from
 * it and along the other parameter e. Their difference between (d',e') and (d,e) is the mean of their derivative by d,
 * times d - d', and the mean of the one by e, divided by d, times d (e - e'). */
LANES_INLINE bool nets_one_to_one_at_pole(const struct cover_net *along_d, double error_d,
                                          const struct cover_net *along_e, double error_e)
{
  struct cover_net divided_d, divided_e;
  net_divide(along_d, &divided_d), net_divide(along_e, &divided_e);
  return slopes_regular(along_d->c, divided_d.c, 3 * error_d, divided_e.c, along_e->c, 3 * error_e);
}

/* Whether the sign of a0 b - b0 a shows that the box has no root, as of a leaf with a pole (planes_at_pole); a0 and b0
 * are a and b at the pole, which is row 0. */
LANES_INLINE bool nets_miss_pole(const struct cover_net *a, const struct cover_net *b, double size, double error)
{
  const double a0 = a->c[0][0], b0 = b->c[0][0], sizes = fabs(a0) + fabs(b0), off = error * sizes;
  struct cover_net turn;
  net_combine(a, b, -b0, a0, &turn);
  double least = INFINITY, most = -INFINITY;
  for (int n = 4; n < 16; n++) {
    const double x = turn.c[n / 4][n % 4];
    least = real_min(x, least), most = real_max(x, most);
  }
  const double beyond = real_max(least, -most) - off;
  return beyond > 0 && (a0 * a0 + b0 * b0 - off) * beyond > 8 * size * sizes * off;
}

/* Whether a box at a pole, which is that border of it, is not cleared: as nets_full, where every combination of a and b
 * is constant on one border, and no Jacobian regular. */
LANES_INLINE bool nets_full_at_pole(const struct cover_net *a, const struct cover_net *b, int border, bool has_root,
                                    double size, double error)
{
  struct cover_net x = *a, y = *b, along_d, along_e;
  net_turn(&x, border), net_turn(&y, border);
  const double combined = error + 8 * UNIT_ROUNDOFF * size;
  if (nets_miss_pole(&x, &y, size, combined)) return false;
  if (!has_root) return true;
  const double xd = (x.c[3][1] + x.c[3][2]) - (x.c[0][1] + x.c[0][2]), xe = x.c[3][3] - x.c[3][0];
  const double yd = (y.c[3][1] + y.c[3][2]) - (y.c[0][1] + y.c[0][2]), ye = y.c[3][3] - y.c[3][0];
  const double sense = xd * ye < xe * yd ? -1 : 1;
  net_combine(&x, &y, sense * ye, -sense * xe, &along_d);
  net_combine(&x, &y, -sense * yd, sense * xd, &along_e);
  return !nets_one_to_one_at_pole(&along_d, combined * (fabs(ye) + fabs(xe)), &along_e,
                                  combined * (fabs(yd) + fabs(xd)));
}

#endif
