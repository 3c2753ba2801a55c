/* Leaves: their nets, bounds, Taylor polynomials, and the boxes along them. See leaf.h. */
#include "intersect/prepare/leaf.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/prepare/tree.h"

/* ---- cutting ---- */

static int head_bits(int leaves) { return leaves <= 256 ? 20 : 16; }

/* A leaf's net as head + tail. The head is cut from a coordinate's first bits, which is exact if split_is_exact. The tail
 * is smaller by as many bits and includes what x is rounded by. Cutting rounds it, by less than the planes' own errors by
 * about as many bits. */
struct halves {
  double head[3][4][4], tail[3][4][4];
};

static void cut_halves(const struct model_patch *patch, const struct leaf *leaf, struct halves *out)
{
  const uint16_t *split = patch->cut.split;
  const double round = 0x1.8p52 / (1 << head_bits(split[0] * split[1]));
  /* quotients: the last one is 1 for any split */
  const double u[2] = {leaf->column_u / (double)split[0], (leaf->column_u + 1) / (double)split[0]};
  const double v[2] = {leaf->column_v / (double)split[1], (leaf->column_v + 1) / (double)split[1]};
  for (int k = 0; k < 3; k++) {
    for (int n = 0; n < 16; n++) {
      const double x = patch->x[k][n / 4][n % 4], head = (x + round) - round;
      out->head[k][n / 4][n % 4] = head, out->tail[k][n / 4][n % 4] = (x - head) + patch->rest[k][n / 4][n % 4];
    }
    patch_subnet(out->head[k], u[0], u[1], v[0], v[1], out->head[k]);
    patch_subnet(out->tail[k], u[0], u[1], v[0], v[1], out->tail[k]);
  }
}

/* ---- bounds ---- */

/* A bound on the length of the longest: the length itself unless squares lose digits, below some 2^-450 of the patch. */
static double longest(const double v[][3], int count)
{
  double square = 0, largest = 0;
  for (int n = 0; n < count; n++) square = real_max(vector_dot(v[n], v[n]), square);
  if (square >= VECTOR_SQUARE_MIN) return sqrt(square);
  for (int n = 0; n < 3 * count; n++) largest = real_max(fabs(v[n / 3][n % 3]), largest);
  return 2 * largest;
}

/* Bounds on derivatives of the leaf widened by LEAF_MARGIN, in its own parameters. */
static void set_bounds(struct leaf *leaf)
{
  const double shrink = 1 / (1 + 2 * LEAF_MARGIN);
  double x[4][4], du[12][3], dv[12][3], uu[8][3], uv[9][3], vv[8][3];
  for (int k = 0; k < 3; k++) {
    memcpy(x, leaf->x[k], sizeof x);
    patch_subnet(x, -LEAF_MARGIN, 1 + LEAF_MARGIN, -LEAF_MARGIN, 1 + LEAF_MARGIN, x);
    for (int n = 0; n < 12; n++) {
      const int i = n / 3, j = n % 3;
      dv[n][k] = 3 * (x[i][j + 1] - x[i][j]), du[n][k] = 3 * (x[j + 1][i] - x[j][i]);
    }
    for (int n = 0; n < 8; n++) {
      const int i = n / 4, j = n % 4;
      uu[n][k] = 6 * (x[i + 2][j] - 2 * x[i + 1][j] + x[i][j]);
      vv[n][k] = 6 * (x[j][i + 2] - 2 * x[j][i + 1] + x[j][i]);
    }
    for (int n = 0; n < 9; n++) {
      const int i = n / 3, j = n % 3;
      uv[n][k] = 9 * (x[i + 1][j + 1] - x[i + 1][j] - x[i][j + 1] + x[i][j]);
    }
  }
  leaf->first[0] = longest(du, 12) * shrink, leaf->first[1] = longest(dv, 12) * shrink;
  leaf->second[0] = longest(uu, 8), leaf->second[1] = longest(uv, 9), leaf->second[2] = longest(vv, 8);
  for (int n = 0; n < 3; n++) leaf->second[n] *= shrink * shrink;
}

/* ---- Taylor's polynomial ---- */

/* Coefficients about the middle of a cubic in Bernstein form. */
static void taylor(const double b[4], double out[4])
{
  out[0] = ((b[0] + b[3]) + 3 * (b[1] + b[2])) / 8, out[1] = 0.75 * ((b[3] - b[0]) + (b[2] - b[1]));
  out[2] = 1.5 * ((b[0] + b[3]) - (b[1] + b[2])), out[3] = (b[3] - b[0]) - 3 * (b[2] - b[1]);
}

/* The coefficient of s^i t^j goes to out[4 * i + j]. */
static void taylor_net(const double x[4][4], double out[16])
{
  double rows[4][4];
  for (int i = 0; i < 4; i++) taylor(x[i], rows[i]);
  for (int j = 0; j < 4; j++) {
    const double column[4] = {rows[0][j], rows[1][j], rows[2][j], rows[3][j]};
    double of[4];
    taylor(column, of);
    for (int i = 0; i < 4; i++) out[4 * i + j] = of[i];
  }
}

/* The largest powers of s and t over the leaf widened by LEAF_MARGIN. */
#define REACH (0.5 + LEAF_MARGIN)
static const double REACH_POWER[4] = {1, REACH, (REACH) * (REACH), (REACH) * (REACH) * (REACH)};

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

static double error_bound(const struct leaf_parts *parts, bool exact)
{
  double most_rest = 0, most_whole = 0;
  for (int k = 0; k < 3; k++) {
    double sum = 0, roundings = 0, size[4];
    for (int n = 0; n < 16; n++) {
      const double term = REACH_POWER[n / 4] * REACH_POWER[n % 4] * fabs(parts->rest[n][k]);
      sum += term, roundings += TERM_ROUNDINGS(n / 4 + n % 4) * term;
    }
    for (int n = 1; n < 4; n++) size[n] = fabs(parts->base[n][k]);
    most_rest = real_max(most_rest, roundings);
    most_whole = real_max(most_whole, sum + REACH * (size[1] + size[2] + REACH * size[3]));
  }
  return UNIT_ROUNDOFF * (exact ? most_rest : most_rest + CUT_ROUNDINGS * (1 + most_whole));
}

/* Twice the error of a root, in the patch's frame, after the last step of Newton's method: well below its rounding. */
#define LAST_STEP_CURVE (UNIT_ROUNDOFF / 32)

static void set_parts(const struct halves *halves, bool exact, struct leaf *leaf)
{
  static const int bilinear[4] = {0, 4, 1, 5};
  struct leaf_parts *out = &leaf->parts;
  for (int k = 0; k < 3; k++) {
    double head[16], tail[16];
    taylor_net(halves->head[k], head);
    taylor_net(halves->tail[k], tail);
    for (int n = 0; n < 4; n++) {
      double *of = &head[bilinear[n]];
      out->base[n][k] = real_coarse(*of, LEAF_GRAIN);
      *of -= out->base[n][k];
    }
    for (int n = 0; n < 16; n++) out->rest[n][k] = head[n] + tail[n];
  }
  const double *bend = leaf->second, second = bend[0] + 2 * bend[1] + bend[2];
  out->last_step = real_min(NEWTON_LAST_STEP, sqrt(LAST_STEP_CURVE / real_max(second, LAST_STEP_CURVE)));
  out->error = error_bound(out, exact);
  out->final = exact && out->error <= FINAL_ERROR;
}

/* ---- the box along a leaf ---- */

/* A box along the leaf is not worth its rounding if |Su x Sv| is less than this part of the squared derivatives. */
#define LEAST_AREA 0x1p-30

/* Below this |Su x Sv| has no reciprocal, for the net is nearly a point. */
#define LEAST_NORMAL 0x1p-1000

/* Whether two vectors tell a normal. */
static bool tell_normal(const double a[3], const double b[3], double normal[1][3])
{
  vector_cross(a, b, normal[0]);
  const double least = real_max(LEAST_AREA * (vector_dot(a, a) + vector_dot(b, b)), LEAST_NORMAL);
  return longest((const double(*)[3])normal, 1) > least;
}

/* If a leaf is a line, or nearly, the axis farthest from it replaces the shorter of both vectors. */
static void widen_line(double u[3], double v[3])
{
  const bool v_longer = vector_dot(v, v) > vector_dot(u, u);
  const double *along = v_longer ? v : u;
  double *across = v_longer ? u : v, length = 0;
  int least = 0;
  for (int k = 0; k < 3; k++)
    length = real_max(length, fabs(along[k])), least = fabs(along[k]) < fabs(along[least]) ? k : least;
  for (int k = 0; k < 3; k++) across[k] = k == least ? length : 0;
}

/* Sets the slabs. They tell nothing if the net's corners tell no direction in its middle. */
static void set_slabs(const double x[3][16], struct leaf_slab out[3])
{
  double along_u[3], along_v[3], normal[1][3];
  for (int k = 0; k < 3; k++) {
    const double *c = x[k];
    along_u[k] = 0.5 * ((c[12] - c[0]) + (c[15] - c[3])), along_v[k] = 0.5 * ((c[3] - c[0]) + (c[15] - c[12]));
  }
  bool tells = tell_normal(along_u, along_v, normal);
  if (!tells) widen_line(along_u, along_v), tells = tell_normal(along_u, along_v, normal);
  for (int q = 0; q < 3; q++) {
    double *g = out[q].g, of[3], lo = INFINITY, hi = -INFINITY;
    if (q == 0) memcpy(of, normal[0], sizeof of);
    else if (q == 1) vector_cross(along_v, out[0].g, of);
    else vector_cross(out[0].g, along_u, of);
    vector_scale(tells ? 1 / (fabs(of[0]) + fabs(of[1]) + fabs(of[2])) : 0, of, g);
    for (int n = 0; n < 16; n++) {
      const double value = g[0] * x[0][n] + g[1] * x[1][n] + g[2] * x[2][n];
      lo = real_min(lo, value), hi = real_max(hi, value);
    }
    out[q].offset = 0.5 * (lo + hi);
    out[q].half = tells ? 0.5 * (hi - lo) + 8 * UNIT_ROUNDOFF : INFINITY; /* |x| <= 1 */
  }
}

/* ---- the face ---- */

void leaf_make(const struct model_patch *patch, uint32_t index, uint32_t number, struct leaf *out)
{
  const uint16_t *split = patch->cut.split;
  struct halves halves;
  out->patch = index, out->column_u = (uint16_t)(number / split[1]), out->column_v = (uint16_t)(number % split[1]);
  cut_halves(patch, out, &halves);
  for (int k = 0; k < 3; k++)
    for (int n = 0; n < 16; n++) out->x[k][n] = halves.head[k][n / 4][n % 4] + halves.tail[k][n / 4][n % 4];
  set_bounds(out);
  set_parts(&halves, split_is_exact(split[0] * split[1]), out);
  set_slabs((const double(*)[16])out->x, out->slab);
}

/* Rounding of the local net itself: of P - center (half a unit), and of cutting leaves (in either direction six lerps
 * of two roundings each, on values below one). Used for the boxes. */
#define LEAF_NET_ERROR (32 * UNIT_ROUNDOFF)

/* What rounding `half` to a float, and what it is compared with, may do: see lanes/view.h. */
#define HALF_GROWTH (1 + 0x1p-20)

void leaf_orient(const struct model_tree *tree, double error, const struct model_patch *patch,
                 const struct leaf_slab slab[3], struct oriented_box *box)
{
  double shift[3], most = 0;
  for (int k = 0; k < 3; k++) shift[k] = patch->center[k] - tree->origin[k], most = real_max(most, fabs(shift[k]));
  const double slack = LEAF_NET_ERROR * patch->scale + 8 * UNIT_ROUNDOFF * (most + patch->scale) + error;
  for (int q = 0; q < 3; q++) {
    double offset = patch->scale * slab[q].offset;
    for (int k = 0; k < 3; k++) offset += slab[q].g[k] * shift[k], box->g[k][q] = (float)slab[q].g[k];
    box->offset[q] = (float)(offset / tree->frame);
    box->half[q] = (float)((patch->scale * slab[q].half + slack) / tree->frame * HALF_GROWTH);
  }
}

void leaf_box(const struct model *model, const struct model_patch *patch, const double x[3][16], struct bvh_box *box)
{
  for (int k = 0; k < 3; k++) {
    double lo = INFINITY, hi = -INFINITY;
    for (int i = 0; i < 16; i++) lo = real_min(lo, x[k][i]), hi = real_max(hi, x[k][i]);
    const double shift = patch->center[k] - tree_about(&model->tree, k);
    const double slack = LEAF_NET_ERROR * patch->scale + 2 * UNIT_ROUNDOFF * (fabs(shift) + patch->scale) +
                         model->error;
    box->lo[k] = shift + patch->scale * lo - slack, box->hi[k] = shift + patch->scale * hi + slack;
  }
}
