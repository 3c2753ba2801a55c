/* Whether the known roots are all that a leaf has, by pieces that cover it, for one ray after the other: few need it. A
 * piece is done with if it has no root, or no other one than a proven one in it. Other pieces are halved, and if they
 * seem to have one more root it is sought.
 *
 * A piece is a rectangle of the leaf's parameters with the nets of the ray's two planes' polynomials over it. The last
 * resort has the same operations in integers. The lanes are not rays here but coefficients, because pieces are examined
 * for only one ray or two. Compiled once per instruction set.
 */
#include <math.h>
#include <string.h>

#include "base/real.h"
#include "intersect/lanes/candidate.h"

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
struct net {
  row c[4];
};

/* The pair of polynomials whose common roots are those on the ray: a and b, or, on a leaf with a pole, one of them and
 * the quotient that replaces the other. */
struct piece {
  struct net f[2];
  double u, v, size_u, size_v; /* in leaf parameters */
  int halvings;
};

/* What all pieces of one ray on a leaf share. */
struct piece_ray {
  const struct leaf *leaf;
  struct leaf_roots *known; /* with those that are found on the way */
  int lane, most, splits;   /* `most` roots, no more */
  double size[2], error[2]; /* of the coefficients of either polynomial: a bound, and their errors */
};

/* The largest absolute value of a coefficient. */
LANES_INLINE double net_size(const struct net *net)
{
  double size = 0;
  for (int n = 0; n < 16; n++) size = real_max(fabs(net->c[n / 4][n % 4]), size);
  return size;
}

/* Whether the net, its coefficients off by `error`, may change sign. */
LANES_INLINE bool net_changes(const struct net *net, double error)
{
  const row *c = net->c, e = row_all(error);
  return row_any((c[0] <= e) | (c[1] <= e) | (c[2] <= e) | (c[3] <= e)) &&
         row_any((c[0] >= -e) | (c[1] >= -e) | (c[2] >= -e) | (c[3] >= -e));
}

LANES_INLINE double net_middle(const struct net *net)
{
  const row *c = net->c, ends = c[0] + c[3] + 3 * (c[1] + c[2]);
  return (ends[0] + ends[3] + 3 * (ends[1] + ends[2])) / 64;
}

LANES_INLINE void net_combine(const struct net f[2], double p, double q, struct net *out)
{
  for (int n = 0; n < 4; n++) out->c[n] = p * f[0].c[n] + q * f[1].c[n];
}

/* ---- halve ---- */

/* Replaces four cubics by their lower halves. */
LANES_INLINE void rows_halve(row c[4], row high[4])
{
  const row c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3];
  const row q0 = 0.5 * (c0 + c1), q1 = 0.5 * (c1 + c2), q2 = 0.5 * (c2 + c3);
  const row r0 = 0.5 * (q0 + q1), r1 = 0.5 * (q1 + q2), s = 0.5 * (r0 + r1);
  c[1] = q0, c[2] = r0, c[3] = s;
  high[0] = s, high[1] = r1, high[2] = q2, high[3] = c3;
}

LANES_INLINE void net_halve(struct net *net, bool across_u, struct net *high)
{
  if (!across_u) four_doubles_turn(net->c);
  rows_halve(net->c, high->c);
  if (!across_u) four_doubles_turn(net->c), four_doubles_turn(high->c);
}

/* Halves the piece across the parameter along which it is longer. *piece becomes the lower half. */
LANES_INLINE void piece_halve(const struct piece_ray *ray, struct piece *piece, struct piece *high)
{
  const double *first = ray->leaf->first;
  const bool across_u = first[0] * piece->size_u >= first[1] * piece->size_v;
  if (across_u) piece->size_u /= 2;
  else piece->size_v /= 2;
  piece->halvings++;
  high->u = across_u ? piece->u + piece->size_u : piece->u, high->v = across_u ? piece->v : piece->v + piece->size_v;
  high->size_u = piece->size_u, high->size_v = piece->size_v, high->halvings = piece->halvings;
  for (int k = 0; k < 2; k++) net_halve(&piece->f[k], across_u, &high->f[k]);
}

/* ---- exclude ---- */

/* Two combinations of the pair, which aim along u and v. */
struct aimed {
  struct net along[2];
  double error[2];
  double slope; /* of either by its parameter of the piece, about */
};

/* Whether the piece has no root: one of the pair, or of two combinations, which aim along the piece's parameters, keeps
 * its sign on its net. If not, the combinations are set. */
LANES_INLINE bool piece_exclude(const struct piece_ray *ray, const struct piece *piece, struct aimed *out)
{
  double error[2], du[2], dv[2];
  for (int k = 0; k < 2; k++) {
    const row *c = piece->f[k].c;
    du[k] = (c[3][1] + c[3][2]) - (c[0][1] + c[0][2]), dv[k] = (c[1][3] + c[2][3]) - (c[1][0] + c[2][0]);
    /* each halving adds three roundings, of values of the leaf's size */
    error[k] = ray->error[k] + piece->halvings * 4 * UNIT_ROUNDOFF * ray->size[k];
    if (!net_changes(&piece->f[k], error[k])) return true;
    error[k] += 8 * UNIT_ROUNDOFF * ray->size[k]; /* three roundings of a combination */
  }
  const double determinant = du[0] * dv[1] - dv[0] * du[1], sense = determinant < 0 ? -1 : 1;
  out->slope = 0.5 * fabs(determinant);
  net_combine(piece->f, sense * dv[1], -sense * dv[0], &out->along[0]);
  out->error[0] = error[0] * fabs(dv[1]) + error[1] * fabs(dv[0]);
  if (!net_changes(&out->along[0], out->error[0])) return true;
  net_combine(piece->f, -sense * du[1], sense * du[0], &out->along[1]);
  out->error[1] = error[0] * fabs(du[1]) + error[1] * fabs(du[0]);
  return !net_changes(&out->along[1], out->error[1]);
}

/* ---- unique ---- */

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

/* Whether the combinations take no pair of values twice on the piece. Between two points the values change by the mean
 * Jacobian on the way, times it. Its elements lie within three times the coefficients' differences. It is not singular
 * if the product of its diagonal exceeds that of the other elements. */
LANES_INLINE bool piece_unique(const struct aimed *aimed)
{
  double least_u, least_v, most_u, most_v;
  struct net turned[2] = {aimed->along[0], aimed->along[1]};
  four_doubles_turn(turned[0].c), four_doubles_turn(turned[1].c);
  rows_slopes(aimed->along[0].c, turned[0].c, aimed->error[0], &least_u, &most_u);
  rows_slopes(turned[1].c, aimed->along[1].c, aimed->error[1], &least_v, &most_v);
  return least_u > 0 && least_v > 0 && least_u * least_v > (1 + 8 * UNIT_ROUNDOFF) * (most_u * most_v);
}

/* ---- root ---- */

LANES_INLINE bool root_within(const struct newton_root *root, int lane, const struct piece *piece)
{
  const double u = root->u[lane], radius_u = root->radius_u[lane], v = root->v[lane], radius_v = root->radius_v[lane];
  return u - radius_u >= piece->u && u + radius_u <= piece->u + piece->size_u && v - radius_v >= piece->v &&
         v + radius_v <= piece->v + piece->size_v;
}

/* Whether a proven root of the ray is in the piece. */
LANES_INLINE bool piece_root(const struct piece_ray *ray, const struct piece *piece)
{
  const struct leaf_roots *known = ray->known;
  for (int k = 0; k < known->count; k++)
    if (known->proven[k][ray->lane] && root_within(&known->root[k].at, ray->lane, piece)) return true;
  return false;
}

/* ---- divide ---- */

/* A ray whose planes' polynomials are both less than this many times their error at a pole meets it, as far as doubles
 * show. */
#define POLE_MET 4

/* Exchanges the pair of a leaf for one whose roots are simple and regular at its pole, that border. There f0 and f1 are
 * constants, of which let that of f0 be the larger one, c0; then f1 becomes ((c1/c0) f0 - f1) / d, with d the distance
 * from the border. The numerator is 0 there, so its coefficients of row n are those of the quotient in row n - 1, times
 * n/3, and the quotient is raised to degree 3 again. Nothing else knows of poles.
 *
 * c0 and c1 are off by e, so their quotient by 3 e/|c0| where |c0| >= 4 e (POLE_MET); and the numerator by 2 e for f0
 * and f1, that times f0, and roundings. If |c0| is less, the ray meets the pole, as far as doubles show, and the pair
 * stays. */
LANES_INLINE void piece_divide(struct piece_ray *ray, int border, struct piece *piece)
{
  const int at = edge_at(border, 0);
  const double first = piece->f[0].c[at / 4][at % 4], second = piece->f[1].c[at / 4][at % 4];
  const int kept = fabs(first) >= fabs(second) ? 0 : 1;
  const double c0 = kept ? second : first, ratio = (kept ? first : second) / c0, e = ray->error[0];
  if (!(fabs(c0) >= POLE_MET * e)) return;
  struct net numerator, *quotient = &piece->f[1 - kept];
  net_combine(piece->f, kept ? -1 : ratio, kept ? ratio : -1, &numerator);
  row *c = numerator.c;
  if (border >= 2) four_doubles_turn(c);
  const bool last = border & 1; /* the border is row 3 */
  const row one = c[last ? 2 : 1], two = c[last ? 1 : 2], three = c[last ? 0 : 3];
  const row raised[4] = {3 * one, one + two, two + (1.0 / 3) * three, three};
  for (int n = 0; n < 4; n++) quotient->c[last ? 3 - n : n] = raised[n];
  if (border >= 2) four_doubles_turn(quotient->c);
  const double size = ray->size[0] + ray->size[1];
  ray->error[1 - kept] = 3 * (2 * e + 3 * e / fabs(c0) * (size + e) + 16 * UNIT_ROUNDOFF * size);
  ray->size[1 - kept] = net_size(quotient);
}

/* ---- cover ---- */

/* The most pieces halved on a leaf. A choice of speed, as COVER_HALVINGS. */
enum { COVER_SPLITS = 160 };

/* The most halvings of the leaf to show that the ray passes it by, for a method that seeks its roots afterwards; and
 * the least of a piece in which one more root is sought, because larger ones are too bent. Choices of speed. */
enum { MISS_HALVINGS = 3, SEEK_HALVINGS = 5 };

/* Seeks one more root by Newton's method, from where the combinations' linear parts vanish, if that is in the piece. */
static void piece_seek(const struct packet *p, const struct candidate *it, const struct piece *piece,
                       const struct aimed *aimed, struct piece_ray *ray)
{
  double at[2];
  struct leaf_roots *known = ray->known;
  if (piece->halvings < SEEK_HALVINGS || known->count == ray->most) return;
  for (int k = 0; k < 2; k++) {
    const double value = net_middle(&aimed->along[k]);
    if (!(fabs(value) <= 0.5 * aimed->slope)) return;
    at[k] = 0.5 - value / aimed->slope;
  }
  if (!piece_unique(aimed)) return;
  const lanes start[2] = {lanes_all(piece->u + at[0] * piece->size_u - 0.5),
                          lanes_all(piece->v + at[1] * piece->size_v - 0.5)};
  const lane_mask here = lanes_mask(1u << ray->lane);
  struct leaf_root *root = &known->root[known->count];
  newton_solve(p, it->leaf, it->axis, start, here, root);
  lane_mask further = here & root->at.exists;
  for (int k = 0; k < known->count; k++) further &= ~(known->proven[k] & roots_meet(&known->root[k].at, &root->at));
  known->proven[known->count] = further;
  known->count += lanes_any(further);
  ray->splits++; /* it takes as long */
}

/* Whether all pieces are done with. stack[0], the leaf, is set. */
static bool cover(const struct packet *p, const struct candidate *it, struct piece_ray *ray,
                  struct piece stack[COVER_HALVINGS + 2], int halvings)
{
  ray->splits = 0;
  for (int top = 1; top > 0;) {
    struct piece *piece = &stack[--top];
    struct aimed aimed;
    if (piece_exclude(ray, piece, &aimed)) continue;
    if (!piece_root(ray, piece)) piece_seek(p, it, piece, &aimed, ray);
    if (piece_root(ray, piece) && piece_unique(&aimed)) continue;
    if (piece->halvings == halvings || ray->splits >= COVER_SPLITS) return false;
    piece_halve(ray, piece, piece + 1);
    top += 2, ray->splits++;
  }
  return true;
}

/* The net of a plane's polynomial; each coefficient is off by line->error at most. */
LANES_INLINE void plane_net(const struct candidate *it, int lane, int number, struct net *out)
{
  const struct line *line = it->line;
  const double moment = line->moment[number][lane], slope = line->slope[number][lane];
  row x[4], depth[4]; /* x_i or x_j, and x_k */
  memcpy(x, it->leaf->x[(it->axis + 1 + number) % 3], sizeof x), memcpy(depth, it->leaf->x[it->axis], sizeof depth);
  for (int n = 0; n < 4; n++) out->c[n] = (x[n] - moment) - slope * depth[n];
}

lane_mask cover_proves(struct packet *p, struct candidate *it, int halvings, lane_mask open)
{
  struct leaf_roots *known = &it->known;
  const int count = known->count;
  struct piece stack[COVER_HALVINGS + 2], *leaf = &stack[0];
  struct piece_ray ray;
  int pole = 0; /* the first border that is one */
  while (pole < 4 && !leaf_border_is_point(it->patch, it->leaf, pole)) pole++;
  ray.leaf = it->leaf, ray.known = known, ray.most = count + MORE_ROOTS;
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const int lane = ray.lane = __builtin_ctz(bits);
    const lane_mask here = lanes_mask(bits & -bits);
    leaf->u = leaf->v = 0, leaf->size_u = leaf->size_v = 1, leaf->halvings = 0;
    for (int k = 0; k < 2; k++) {
      plane_net(it, lane, k, &leaf->f[k]);
      ray.size[k] = net_size(&leaf->f[k]), ray.error[k] = it->line->error[lane];
    }
    if (pole < 4) piece_divide(&ray, pole, leaf);
    const bool covered = cover(p, it, &ray, stack, halvings);
    p->postponed->left[lane] -= COST_BOX * (1 + 2 * ray.splits);
    if (!covered) open &= ~here;
    for (int k = count; k < known->count && (covered || p->any); k++)
      offer_root(p, it, &known->root[k], here & inside(&known->root[k].at));
    known->count = count;
  }
  return open;
}

lane_mask stage_cover(struct packet *p, struct candidate *it, lane_mask open)
{
  const bool all = it->patch->lanes == SOLVER_LANES_SIGNS;
  struct leaf_roots *known = &it->known;
  known->count = all;
  if (all) known->proven[0] = open & known->root[0].at.exists;
  const lane_mask covered = cover_proves(p, it, all ? COVER_HALVINGS : MISS_HALVINGS, open);
  offer_known(p, it, p->any ? open : covered);
  return open & ~covered & p->live;
}
