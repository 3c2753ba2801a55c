/* Preparing leaves: nets, bounds, which parameter to keep, boxes. */
#include "intersect/prepare/leaf.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"

/* Rounding of the local net itself: of P - center (half a unit), and of cutting leaves (six lerps of two roundings
 * each in either direction on values below one). Used for the boxes. */
#define LEAF_NET_ERROR (32 * UNIT_ROUNDOFF)

void leaf_first_bounds(double x[3][16], double out[2])
{
  double du[12][3], dv[12][3];
  for (int k = 0; k < 3; k++) {
    for (int n = 0; n < 12; n++) {
      const int i = n / 3, j = n % 3;
      dv[n][k] = 3 * (x[k][4 * i + j + 1] - x[k][4 * i + j]), du[n][k] = 3 * (x[k][4 * j + 4 + i] - x[k][4 * j + i]);
    }
  }
  out[0] = vector_longest(du, 12), out[1] = vector_longest(dv, 12);
}

bool leaf_border_is_point(const struct model_patch *patch, const uint16_t column[2], const uint16_t span[2], int border)
{
  const int side = border / 2, end = column[side] + span[side];
  return (border & 1 ? end == patch->split[side] : column[side] == 0) && patch->pole[border];
}

/* Whether rows must be kept (true) or columns: the parameter along which an edge collapses is kept, for the other
 * would leave r identically zero at the apex; otherwise the one of higher degree, for the determinant is the smaller
 * then. */
static bool keep_v(const struct model_patch *patch, double x[3][4][4])
{
  const int rows = patch_border_is_point((const double(*)[4][4])x, 0) +
                   patch_border_is_point((const double(*)[4][4])x, 1);
  const int columns = patch_border_is_point((const double(*)[4][4])x, 2) +
                      patch_border_is_point((const double(*)[4][4])x, 3);
  if (rows != columns) return columns > rows;
  return patch->n > patch->m;
}

/* How far the polynomial of bidegree (m,n) with the net r is from the bicubic x, on [0,1]^2: the largest distance of
 * x from r's net raised to (3,3), whose own roundings (two degrees twice, three each) are added. */
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

/* What resultants are formed of. */
static void set_form(const struct model_patch *patch, struct leaf *leaf, struct leaf_form *form)
{
  double x[3][4][4];
  memcpy(x, leaf->x, sizeof x);
  leaf->v_kept = keep_v(patch, x);
  const int kept = leaf->v_kept ? patch->n : patch->m, eliminated = leaf->v_kept ? patch->m : patch->n;
  leaf->kept_degree = (uint8_t)kept, leaf->eliminated_degree = (uint8_t)eliminated;
  const uint16_t column[2] = {leaf->column_u, leaf->column_v}, span[2] = {1, 1};
  const bool low = leaf_border_is_point(patch, column, span, leaf->v_kept ? 2 : 0);
  const bool high = leaf_border_is_point(patch, column, span, leaf->v_kept ? 3 : 1);
  leaf->zeros[0] = (uint8_t)(low ? eliminated : 0), leaf->zeros[1] = (uint8_t)(high ? eliminated : 0);
  leaf->form = NULL;
  if (patch->m == 3 && patch->n == 3 && !leaf->v_kept) return;
  form->size = 1, form->excess = 0;
  for (int k = 0; k < 3; k++) {
    double r[4][4];
    patch_reduce(x[k], patch->m, patch->n, r);
    form->excess = real_max(form->excess, reduction_excess(r, patch->m, patch->n, x[k]));
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 4; j++) {
        form->x[k][4 * i + j] = leaf->v_kept ? r[j][i] : r[i][j];
        form->size = real_max(form->size, fabs(r[i][j]));
      }
    }
  }
  leaf->form = form;
}

/* |Su x Sv| relative to the squared derivatives below which a box along the leaf is not worth its rounding. */
#define LEAST_AREA 0x1p-30

/* A leaf whose derivatives turn by more than this fraction of their size is bent: the root of its bilinear part is off by a
 * quarter of that at most. A choice of speed: what comes of it is proven. */
#define BENT_TURN 2.0

static bool is_bent(const struct leaf *leaf)
{
  const double turn = (leaf->second[0] + 2 * leaf->second[1] + leaf->second[2]) / 2;
  return !(turn <= BENT_TURN * real_min(leaf->first[0], leaf->first[1]));
}

/* A net whose middle has no normal gets a box that tells nothing. */
static void leaf_set_slabs(struct leaf *leaf)
{
  struct leaf_slabs *slabs = &leaf->slabs;
  double along_u[3], along_v[3], *normal = slabs->g[0], largest = 0;
  for (int k = 0; k < 3; k++) {
    const double *x = leaf->x[k];
    along_u[k] = 0.5 * ((x[12] - x[0]) + (x[15] - x[3])), along_v[k] = 0.5 * ((x[3] - x[0]) + (x[15] - x[12]));
  }
  vector_cross(along_u, along_v, normal);
  const double area = vector_length(normal);
  const bool flat = !(area > LEAST_AREA * (vector_dot(along_u, along_u) + vector_dot(along_v, along_v)));
  vector_scale(flat ? 0 : 1 / area, normal, normal);
  vector_cross(along_v, normal, slabs->g[1]);
  vector_cross(normal, along_u, slabs->g[2]);
  for (int q = 0; q < 3; q++) {
    double *g = slabs->g[q], lo = INFINITY, hi = -INFINITY;
    if (q > 0) vector_scale(flat ? 0 : 1 / area, g, g);
    for (int n = 0; n < 16; n++) {
      const double x = g[0] * leaf->x[0][n] + g[1] * leaf->x[1][n] + g[2] * leaf->x[2][n];
      lo = real_min(lo, x), hi = real_max(hi, x);
    }
    const double size = fabs(g[0]) + fabs(g[1]) + fabs(g[2]);
    slabs->offset[q] = 0.5 * (lo + hi);
    slabs->half[q] = 0.5 * (hi - lo) + 8 * UNIT_ROUNDOFF * size; /* |x| <= 1 */
    largest = real_max(largest, size);
  }
  slabs->slack = flat ? INFINITY : 16 * largest * largest;
}

/* Where parameters have k bits behind the point between them, for 2^k leaves, and coordinates h, three halfway values in
 * either direction are multiples of 2^-(3k + h), and their Taylor coefficients of 2^-(3k + h + 6): nothing is rounded up
 * to these. */
enum { EXACT_LEAVES = 1024 };

static int head_bits(const struct model_patch *patch) { return patch->split[0] * patch->split[1] <= 256 ? 20 : 16; }

/* The leaf's net as hi + lo. hi is cut from the coordinates' first bits: exactly where the leaves are a power of two up to
 * EXACT_LEAVES. lo, which is smaller by as many bits and has what x is rounded by, is rounded: by less than the planes'
 * own errors by about as many. */
static void cut_net(struct model_patch *patch, const uint16_t column[2], const uint16_t span[2], double hi[3][4][4],
                    double lo[3][4][4])
{
  const double parts_u = patch->split[0], parts_v = patch->split[1];
  /* quotients: the last one is 1 whatever the split */
  const double u0 = column[0] / parts_u, u1 = (column[0] + span[0]) / parts_u;
  const double v0 = column[1] / parts_v, v1 = (column[1] + span[1]) / parts_v;
  const double round = 0x1.8p52 / (1 << head_bits(patch));
  for (int k = 0; k < 3; k++) {
    double head[4][4], tail[4][4];
    for (int n = 0; n < 16; n++) {
      const double x = patch->x[k][n / 4][n % 4];
      head[n / 4][n % 4] = (x + round) - round;
      tail[n / 4][n % 4] = (x - head[n / 4][n % 4]) + patch->rest[k][n / 4][n % 4];
    }
    patch_subnet(head, u0, u1, v0, v1, hi[k]);
    patch_subnet(tail, u0, u1, v0, v1, lo[k]);
  }
}

void leaf_net(struct model_patch *patch, const uint16_t column[2], const uint16_t span[2], double out[3][16])
{
  double hi[3][4][4], lo[3][4][4];
  cut_net(patch, column, span, hi, lo);
  for (int k = 0; k < 3; k++)
    for (int n = 0; n < 16; n++) out[k][n] = hi[k][n / 4][n % 4] + lo[k][n / 4][n % 4];
}

/* Taylor coefficients about the middle, of a cubic in Bernstein form. */
static void taylor(double b0, double b1, double b2, double b3, double out[4])
{
  out[0] = ((b0 + b3) + 3 * (b1 + b2)) / 8, out[1] = 0.75 * ((b3 - b0) + (b2 - b1));
  out[2] = 1.5 * ((b0 + b3) - (b1 + b2)), out[3] = (b3 - b0) - 3 * (b2 - b1);
}

static void taylor_net(double x[4][4], double out[16])
{
  double rows[4][4], column[4];
  for (int i = 0; i < 4; i++) taylor(x[i][0], x[i][1], x[i][2], x[i][3], rows[i]);
  for (int j = 0; j < 4; j++) {
    taylor(rows[0][j], rows[1][j], rows[2][j], rows[3][j], column);
    for (int i = 0; i < 4; i++) out[4 * i + j] = column[i];
  }
}

/* The largest powers of s and t over the leaf widened by LEAF_MARGIN. */
#define REACH (0.5 + LEAF_MARGIN)
static const double REACH_POWER[4] = {1, REACH, (REACH) * (REACH), (REACH) * (REACH) * (REACH)};

/* A bound on what third derivatives make of parameter vectors of maximum norm 1, over the leaf widened by LEAF_MARGIN:
 * that of the sum of each coordinate's terms. */
static double third_bound(const struct leaf_parts *parts)
{
  static const double falling[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 2, 0}, {1, 3, 6, 6}}; /* n!/(n-k)! */
  double sum[3] = {0, 0, 0};
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++)
        for (int a = 0; a <= 3; a++)
          if (i >= a && j >= 3 - a)
            sum[k] += (a == 0 || a == 3 ? 1 : 3) * falling[i][a] * falling[j][3 - a] * REACH_POWER[i - a] *
                      REACH_POWER[j - (3 - a)] * fabs(parts->rest[4 * i + j][k]);
  return vector_length(sum);
}

/* What rounding adds to the value of a plane's polynomial. Of each term of the rest, in either of two coordinates: one
 * rounding of the coefficient, without fused multiply-add two for each of its powers and two more in Horner's scheme, and
 * one of the sum; and eight in the plane. Where the cut rounds the net, and the Taylor coefficients are rounded when they
 * are made: their differences lose some fifteen roundings of the sum of all terms but the constant one, and of the net's
 * size 1, in either coordinate. First derivatives are off by no more than 3/REACH times that, well below what the
 * certificate has. */
#define TERM_ROUNDINGS(powers) (16 + 4 * (powers))
#define CUT_ROUNDINGS 32

/* Points on a leaf whose rest adds no more than this to a plane are as good as POINT_ERROR has them: half of it is a
 * coordinate's. */
#define FINAL_ERROR (16 * UNIT_ROUNDOFF)

static double error_bound(const struct leaf_parts *parts, bool rounded)
{
  double rest = 0, whole = 0;
  for (int k = 0; k < 3; k++) {
    const double(*base)[3] = parts->base;
    double sum = 0, roundings = 0;
    for (int n = 0; n < 16; n++) {
      const double term = REACH_POWER[n / 4] * REACH_POWER[n % 4] * fabs(parts->rest[n][k]);
      sum += term, roundings += TERM_ROUNDINGS(n / 4 + n % 4) * term;
    }
    rest = real_max(rest, roundings);
    whole = real_max(whole, sum + REACH * (fabs(base[1][k]) + fabs(base[2][k]) + REACH * fabs(base[3][k])));
  }
  return UNIT_ROUNDOFF * (rest + (rounded ? CUT_ROUNDINGS * (1 + whole) : 0));
}

/* Twice what a root may be off by, in the patch's frame, after the last step of Newton's process: well below what
 * rounds it. */
#define LAST_STEP_CURVE (UNIT_ROUNDOFF / 32)

static void set_parts(const struct model_patch *patch, const struct leaf *leaf, double hi[3][4][4], double lo[3][4][4],
                      struct leaf_parts *out)
{
  static const int bilinear[4] = {0, 4, 1, 5};
  for (int k = 0; k < 3; k++) {
    double head[16], tail[16];
    taylor_net(hi[k], head);
    taylor_net(lo[k], tail);
    for (int n = 0; n < 4; n++) {
      const int at = bilinear[n];
      out->base[n][k] = real_coarse(head[at], LEAF_GRAIN);
      head[at] -= out->base[n][k];
    }
    for (int n = 0; n < 16; n++) out->rest[n][k] = head[n] + tail[n];
  }
  const double second = leaf->second[0] + 2 * leaf->second[1] + leaf->second[2];
  const double first = real_min(leaf->first[0], leaf->first[1]);
  out->last_step = real_min(NEWTON_LAST_STEP, sqrt(LAST_STEP_CURVE / real_max(second, LAST_STEP_CURVE)));
  out->slope_step = second > UNIT_ROUNDOFF * first ? 2 * UNIT_ROUNDOFF * first / second : 2;
  out->third = third_bound(out);
  const int leaves = patch->split[0] * patch->split[1];
  const bool exact = leaves <= EXACT_LEAVES && (leaves & (leaves - 1)) == 0;
  out->error = error_bound(out, !exact);
  out->final = exact && out->error <= FINAL_ERROR;
}

void leaf_bounds(double x[3][16], double first[2], double second[3])
{
  double net[3][4][4], wide[3][4][4], wide_net[3][16];
  memcpy(net, x, sizeof net);
  for (int k = 0; k < 3; k++)
    patch_subnet(net[k], -LEAF_MARGIN, 1 + LEAF_MARGIN, -LEAF_MARGIN, 1 + LEAF_MARGIN, wide[k]);
  patch_second_derivative_bounds(wide, second);
  memcpy(wide_net, wide, sizeof wide_net);
  leaf_first_bounds(wide_net, first);
  /* From the widened net's parameters back to the leaf's. */
  const double shrink = 1 / (1 + 2 * LEAF_MARGIN);
  for (int k = 0; k < 3; k++) second[k] *= shrink * shrink;
  for (int k = 0; k < 2; k++) first[k] *= shrink;
}

void leaf_make(struct model_patch *patch, const struct leaf_place *place, struct leaf *leaf, struct leaf_form *form)
{
  double hi[3][4][4], lo[3][4][4];
  cut_net(patch, (uint16_t[2]){place->column_u, place->column_v}, (uint16_t[2]){1, 1}, hi, lo);
  for (int k = 0; k < 3; k++)
    for (int n = 0; n < 16; n++) leaf->x[k][n] = hi[k][n / 4][n % 4] + lo[k][n / 4][n % 4];
  leaf_bounds(leaf->x, leaf->first, leaf->second);
  leaf->bent = is_bent(leaf);
  set_parts(patch, leaf, hi, lo, &leaf->parts);
  leaf_set_slabs(leaf);
  leaf->patch = place->patch, leaf->column_u = place->column_u, leaf->column_v = place->column_v;
  set_form(patch, leaf, form);
}

void leaf_box(const struct model *model, const struct model_patch *patch, double x[3][16], struct bvh_box *box)
{
  for (int k = 0; k < 3; k++) {
    double lo = INFINITY, hi = -INFINITY;
    for (int i = 0; i < 16; i++) lo = real_min(lo, x[k][i]), hi = real_max(hi, x[k][i]);
    const double shift = patch->center[k] - model->tree.origin[k];
    const double slack = LEAF_NET_ERROR * patch->scale + 2 * UNIT_ROUNDOFF * (fabs(shift) + patch->scale) +
                         model->error;
    box->lo[k] = (shift + patch->scale * lo - slack) / model->tree.frame;
    box->hi[k] = (shift + patch->scale * hi + slack) / model->tree.frame;
  }
}
