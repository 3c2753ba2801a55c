/* The numbers of leaves: nets, bounds, Taylor polynomials, boxes along them. One leaf to a lane.
 *
 * Compiled once per instruction set, without contraction and without fused multiply-add, so that every leaf has the same
 * bits.
 */
#include "intersect/prepare/leaf_kernel.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "base/real.h"
#include "geometry/vector.h"
#include "intersect/prepare/leaf_nets.h"

/* ---- cutting ---- */

static int head_bits(int leaves) { return leaves <= 256 ? 20 : 16; }

/* The patch's net as head + tail. The head is a coordinate's first bits, and cutting it is exact if split_is_exact. The
 * tail is smaller by as many bits and includes what x is rounded by. Cutting rounds it, by less than the planes' own
 * errors by about as many bits. */
struct patch_halves {
  double head[3][16], tail[3][16];
};

static void patch_halve(const struct model_patch *patch, int leaves, struct patch_halves *out)
{
  const double round = 0x1.8p52 / (1 << head_bits(leaves));
  for (int k = 0; k < 3; k++) {
    for (int n = 0; n < 16; n++) {
      const double x = patch->x[k][n / 4][n % 4], head = (x + round) - round;
      out->head[k][n] = head, out->tail[k][n] = (x - head) + patch->rest[k][n / 4][n % 4];
    }
  }
}

/* Parts of a patch, and what is known of them. */
struct cut {
  lane_net head[3], tail[3], x[3]; /* x: their sum */
  lanes first[2], second[3];
};

static struct lane_range range_of(lanes column, int split)
{
  const double parts = split;
  /* quotients: the last one is 1 for any split */
  const lanes to = (column + 1) / parts;
  return (struct lane_range){column / parts, to, split == 1, lanes_any(to == 1)};
}

static void cut_nets(const struct patch_halves *patch, const lanes column[2], const uint16_t split[2], struct cut *out)
{
  const struct lane_range u = range_of(column[0], split[0]);
  const struct lane_range v = range_of(column[1], split[1]);
  for (int k = 0; k < 3; k++) {
    lane_net head, tail;
    for (int n = 0; n < 16; n++)
      head[n / 4][n % 4] = lanes_all(patch->head[k][n]), tail[n / 4][n % 4] = lanes_all(patch->tail[k][n]);
    subnet(head, &u, &v, out->head[k]);
    subnet(tail, &u, &v, out->tail[k]);
    for (int n = 0; n < 16; n++) out->x[k][n / 4][n % 4] = out->head[k][n / 4][n % 4] + out->tail[k][n / 4][n % 4];
  }
}

/* ---- bounds ---- */

LANES_INLINE lanes square_of(const lanes v[3]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

LANES_INLINE lanes largest_of(const lanes v[3]) { return lanes_max(v[0], lanes_max(v[1], v[2])); }

/* A bound on the length of the longest: the length itself unless squares lose digits, below some 2^-450 of the
 * patch. */
LANES_INLINE lanes longest(const lanes v[][3], int count)
{
  lanes square = {0}, largest = {0};
  for (int n = 0; n < count; n++) square = lanes_max(square_of(v[n]), square);
  const lane_mask tiny = square < VECTOR_SQUARE_MIN;
  if (!lanes_any(tiny)) return lanes_sqrt(square);
  for (int n = 0; n < count; n++)
    for (int k = 0; k < 3; k++) largest = lanes_max(lanes_abs(v[n][k]), largest);
  return lanes_select(tiny, 2 * largest, lanes_sqrt(square));
}

static void first_bounds(lane_net x[3], lanes out[2])
{
  lanes du[12][3], dv[12][3];
  for (int k = 0; k < 3; k++) {
    for (int n = 0; n < 12; n++) {
      const int i = n / 3, j = n % 3;
      dv[n][k] = 3 * (x[k][i][j + 1] - x[k][i][j]), du[n][k] = 3 * (x[k][j + 1][i] - x[k][j][i]);
    }
  }
  out[0] = longest(du, 12), out[1] = longest(dv, 12);
}

static void second_bounds(lane_net x[3], lanes out[3])
{
  lanes uu[8][3], uv[9][3], vv[8][3];
  for (int k = 0; k < 3; k++) {
    for (int n = 0; n < 8; n++) {
      const int i = n / 4, j = n % 4;
      uu[n][k] = 6 * (x[k][i + 2][j] - 2 * x[k][i + 1][j] + x[k][i][j]);
      vv[n][k] = 6 * (x[k][j][i + 2] - 2 * x[k][j][i + 1] + x[k][j][i]);
    }
    for (int n = 0; n < 9; n++) {
      const int i = n / 3, j = n % 3;
      uv[n][k] = 9 * (x[k][i + 1][j + 1] - x[k][i + 1][j] - x[k][i][j + 1] + x[k][i][j]);
    }
  }
  out[0] = longest(uu, 8), out[1] = longest(uv, 9), out[2] = longest(vv, 8);
}

/* Bounds for the leaves widened by LEAF_MARGIN, in their own parameters. */
static void bounds(struct cut *cut)
{
  lane_net wide[3];
  for (int k = 0; k < 3; k++) subnet_widened((const lanes(*)[4])cut->x[k], LEAF_MARGIN, wide[k]);
  first_bounds(wide, cut->first), second_bounds(wide, cut->second);
  const double shrink = 1 / (1 + 2 * LEAF_MARGIN);
  for (int k = 0; k < 3; k++) cut->second[k] *= shrink * shrink;
  for (int k = 0; k < 2; k++) cut->first[k] *= shrink;
}

/* ---- Taylor's polynomial ---- */

/* The largest powers of s and t over the leaf widened by LEAF_MARGIN. */
#define REACH (0.5 + LEAF_MARGIN)
static const double REACH_POWER[4] = {1, REACH, (REACH) * (REACH), (REACH) * (REACH) * (REACH)};

/* As struct leaf_parts. */
struct lane_parts {
  lanes base[12], rest[48];
  lanes error, last_step, slope_step;
};

/* What rounding adds to the value of a plane's polynomial. For each term of the rest, in either of two coordinates: one
 * rounding of the coefficient; without fused multiply-add, two for each of its powers and two more in Horner's scheme;
 * and one of the sum. To these come eight in the plane. If the cut rounds the net, Taylor coefficients are rounded when
 * they are made, too: their differences lose some fifteen roundings of the sum of all terms but the constant one, and
 * of the net's size 1, in either coordinate. First derivatives are off by at most 3/REACH times that, well below what
 * the certificate allows. */
#define TERM_ROUNDINGS(powers) (16 + 4 * (powers))
#define CUT_ROUNDINGS 32

/* If the rest adds at most this to a plane, points on the leaf are as good as POINT_ERROR says: half of it is in one
 * coordinate. */
#define FINAL_ERROR (16 * UNIT_ROUNDOFF)

static lanes error_bound(const struct lane_parts *parts, bool rounded)
{
  lanes rest[3], whole[3];
  for (int k = 0; k < 3; k++) {
    lanes sum = {0}, roundings = {0}, size[4];
    for (int n = 0; n < 16; n++) {
      const lanes term = REACH_POWER[n / 4] * REACH_POWER[n % 4] * lanes_abs(parts->rest[3 * n + k]);
      sum += term, roundings += TERM_ROUNDINGS(n / 4 + n % 4) * term;
    }
    for (int n = 1; n < 4; n++) size[n] = lanes_abs(parts->base[3 * n + k]);
    rest[k] = roundings, whole[k] = sum + REACH * (size[1] + size[2] + REACH * size[3]);
  }
  if (!rounded) return UNIT_ROUNDOFF * largest_of(rest);
  return UNIT_ROUNDOFF * (largest_of(rest) + CUT_ROUNDINGS * (1 + largest_of(whole)));
}

/* Twice the error of a root, in the patch's frame, after the last step of Newton's method: well below its rounding. */
#define LAST_STEP_CURVE (UNIT_ROUNDOFF / 32)

static void set_parts(const struct cut *cut, bool exact, struct lane_parts *out)
{
  static const int bilinear[4] = {0, 4, 1, 5};
  for (int k = 0; k < 3; k++) {
    lanes head[16], tail[16];
    taylor_net((const lanes(*)[4])cut->head[k], head);
    taylor_net((const lanes(*)[4])cut->tail[k], tail);
    for (int n = 0; n < 4; n++) {
      lanes *of = &head[bilinear[n]];
      out->base[3 * n + k] = lanes_rint(*of / LEAF_GRAIN) * LEAF_GRAIN;
      *of -= out->base[3 * n + k];
    }
    for (int n = 0; n < 16; n++) out->rest[3 * n + k] = head[n] + tail[n];
  }
  const lanes second = cut->second[0] + 2 * cut->second[1] + cut->second[2];
  const lanes first = lanes_min(cut->first[0], cut->first[1]), least = lanes_all(LAST_STEP_CURVE);
  out->last_step = lanes_min(lanes_all(NEWTON_LAST_STEP), lanes_sqrt(least / lanes_max(second, least)));
  out->slope_step = lanes_select(second > UNIT_ROUNDOFF * first, 2 * UNIT_ROUNDOFF * first / second, lanes_all(2));
  out->error = error_bound(out, !exact);
}

/* ---- the box along a leaf ---- */

/* A box along the leaf is not worth its rounding if |Su x Sv| is less than this part of the squared derivatives. */
#define LEAST_AREA 0x1p-30

/* Below this |Su x Sv| has no reciprocal, for the net is nearly a point. */
#define LEAST_NORMAL 0x1p-1000

LANES_INLINE void cross(const lanes a[3], const lanes b[3], lanes out[3])
{
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

/* The lanes on which two vectors tell no normal. */
LANES_INLINE lane_mask without_normal(const lanes a[3], const lanes b[3], lanes normal[1][3])
{
  cross(a, b, normal[0]);
  const lanes area = longest((const lanes(*)[3])normal, 1);
  return ~(area > lanes_max(LEAST_AREA * (square_of(a) + square_of(b)), lanes_all(LEAST_NORMAL)));
}

/* If a leaf is a line, or nearly, the axis farthest from it replaces the shorter of both vectors. */
__attribute__((noinline)) static void widen_line(lane_mask line, lanes u[3], lanes v[3])
{
  const lane_mask b_longer = square_of(v) > square_of(u);
  lanes size[3], taken = {0};
  for (int k = 0; k < 3; k++) size[k] = lanes_abs(lanes_select(b_longer, v[k], u[k]));
  const lanes least = lanes_min(size[0], lanes_min(size[1], size[2]));
  const lanes length = lanes_max(size[0], lanes_max(size[1], size[2]));
  for (int k = 0; k < 3; k++) {
    const lanes across = lanes_select((size[k] == least) & (taken == 0), length, lanes_all(0));
    taken += across;
    u[k] = lanes_select(line & b_longer, across, u[k]), v[k] = lanes_select(line & ~b_longer, across, v[k]);
  }
}

/* Sets the slabs. They tell nothing if the net's corners tell no direction in its middle. */
static void set_slabs(lane_net x[3], struct lane_slab out[3])
{
  lanes along_u[3], along_v[3], normal[1][3];
  for (int k = 0; k < 3; k++) {
    const lanes *corner = x[k][0], *other = x[k][3];
    along_u[k] = 0.5 * ((other[0] - corner[0]) + (other[3] - corner[3]));
    along_v[k] = 0.5 * ((corner[3] - corner[0]) + (other[3] - other[0]));
  }
  lane_mask flat = without_normal(along_u, along_v, normal);
  if (lanes_any(flat)) {
    widen_line(flat, along_u, along_v);
    flat = without_normal(along_u, along_v, normal);
  }
  for (int q = 0; q < 3; q++) {
    lanes *g = out[q].g, lo, hi, of[3], size[3];
    if (q == 0) memcpy(of, normal[0], sizeof of);
    else if (q == 1) cross(along_v, out[0].g, of);
    else cross(out[0].g, along_u, of);
    for (int k = 0; k < 3; k++) size[k] = lanes_abs(of[k]);
    const lanes inverse = 1 / (size[0] + size[1] + size[2]);
    for (int k = 0; k < 3; k++) g[k] = lanes_select(flat, lanes_all(0), inverse * of[k]);
    lo = lanes_all(INFINITY), hi = lanes_all(-INFINITY);
    for (int n = 0; n < 16; n++) {
      const int i = n / 4, j = n % 4;
      const lanes value = g[0] * x[0][i][j] + g[1] * x[1][i][j] + g[2] * x[2][i][j];
      lo = lanes_min(lo, value), hi = lanes_max(hi, value);
    }
    out[q].offset = 0.5 * (lo + hi);
    out[q].half = lanes_select(flat, lanes_all(INFINITY), 0.5 * (hi - lo) + 8 * UNIT_ROUNDOFF); /* |x| <= 1 */
  }
}

/* ---- the face ---- */

static_assert(offsetof(struct leaf_parts, error) == sizeof(double[60]), "stored in a row");

static void leaves_store(const struct cut *cut, const struct lane_slab slab[3], const struct lane_parts *parts,
                         bool exact, size_t here, struct leaf leaves[])
{
  lanes_scatter(cut->x[0][0], 48, here, leaves->x[0], LEAF);
  lanes_scatter(slab->g, 15, here, leaves->slab->g, LEAF);
  lanes_scatter(parts->base, 60, here, leaves->parts.base[0], LEAF);
  for (size_t lane = 0; lane < here; lane++) {
    struct leaf *leaf = &leaves[lane];
    for (int k = 0; k < 2; k++) leaf->first[k] = cut->first[k][lane];
    for (int k = 0; k < 3; k++) leaf->second[k] = cut->second[k][lane];
    leaf->parts.error = parts->error[lane];
    leaf->parts.final = exact && leaf->parts.error <= FINAL_ERROR;
    leaf->parts.last_step = parts->last_step[lane], leaf->parts.slope_step = parts->slope_step[lane];
  }
}

static void leaves(const struct model_patch *patch, size_t count, struct leaf leaves[])
{
  const uint16_t *split = patch->cut.split;
  const int all = split[0] * split[1];
  const bool exact = split_is_exact(all);
  struct patch_halves halves;
  patch_halve(patch, all, &halves);
  while (count > 0) {
    const size_t here = count < LANES ? count : LANES;
    struct cut cut;
    struct lane_slab slab[3];
    struct lane_parts parts;
    double column[2][LANES];
    lanes at[2];
    for (size_t lane = 0; lane < LANES; lane++) { /* lanes without a leaf have the first's */
      const struct leaf *leaf = &leaves[lane < here ? lane : 0];
      column[0][lane] = leaf->column_u, column[1][lane] = leaf->column_v;
    }
    memcpy(at, column, sizeof at);
    cut_nets(&halves, at, split, &cut);
    bounds(&cut);
    set_parts(&cut, exact, &parts);
    set_slabs(cut.x, slab);
    leaves_store(&cut, slab, &parts, exact, here, leaves);
    leaves += here, count -= here;
  }
}

const struct leaf_kernel KERNEL(leaf_kernel) = {leaves, quadrics_make};
