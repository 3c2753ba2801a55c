/* The quadric that a leaf lies along. See struct leaf_quadric (model.h).
 *
 * Compiled once per instruction set, without contraction and without fused multiply-add. Parameters are those of a net,
 * of the leaf or the leaf widened, s and t within [-1/2,1/2]: no result depends on how a parameter is scaled.
 */
#include <math.h>

#include "intersect/prepare/leaf_nets.h"

/* z, y1 and y2 of struct leaf_quadric, as nets. */
enum { Z, Y1, Y2 };

/* Where taylor_net puts the coefficients of s, t, s^2 ... */
enum { S = 4, T = 1, SS = 8, ST = 5, TT = 2, SSS = 12, SST = 9, STT = 6, TTT = 3 };

static void set_forms(const lane_net x[3], const struct lane_slab slab[3], lane_net out[3])
{
  for (int q = 0; q < 3; q++) {
    const lanes *g = slab[q].g;
    for (int n = 0; n < 16; n++) {
      const int i = n / 4, j = n % 4;
      out[q][i][j] = (g[0] * x[0][i][j] + (g[1] * x[1][i][j] + g[2] * x[2][i][j])) - slab[q].offset;
    }
  }
}

/* Chooses a quadric whose rest is small; rest_bounds finds out how small. It has the surface's second derivatives in
 * the middle of the leaf, and the linear part that halves what third derivatives leave of value and derivatives. */
static void fit(const lane_net of[3], lanes c[6])
{
  lanes z[16], p[16], q[16];
  taylor_net(of[Z], z), taylor_net(of[Y1], p), taylor_net(of[Y2], q);
  /* (s,t) is k (y1,y2) up to terms of higher order. */
  const lanes inverse = 1 / (p[S] * q[T] - p[T] * q[S]);
  const lanes k[2][2] = {{q[T] * inverse, -p[T] * inverse}, {-q[S] * inverse, p[S] * inverse}};
  lanes along_1 = k[0][0] * z[S] + k[1][0] * z[T], along_2 = k[0][1] * z[S] + k[1][1] * z[T];
  const lanes ss = z[SS] - along_1 * p[SS] - along_2 * q[SS], st = z[ST] - along_1 * p[ST] - along_2 * q[ST];
  const lanes tt = z[TT] - along_1 * p[TT] - along_2 * q[TT];
  c[3] = ss * k[0][0] * k[0][0] + st * k[0][0] * k[1][0] + tt * k[1][0] * k[1][0];
  c[4] = 2 * ss * k[0][0] * k[0][1] + st * (k[0][0] * k[1][1] + k[0][1] * k[1][0]) + 2 * tt * k[1][0] * k[1][1];
  c[5] = ss * k[0][1] * k[0][1] + st * k[0][1] * k[1][1] + tt * k[1][1] * k[1][1];
  /* The quadratic part's derivatives by y1 and y2, along s and t. */
  const lanes ps = 2 * c[3] * p[S] + c[4] * q[S], pt = 2 * c[3] * p[T] + c[4] * q[T];
  const lanes qs = c[4] * p[S] + 2 * c[5] * q[S], qt = c[4] * p[T] + 2 * c[5] * q[T];
  const lanes sss = z[SSS] - along_1 * p[SSS] - along_2 * q[SSS] - (ps * p[SS] + qs * q[SS]);
  const lanes sst = z[SST] - along_1 * p[SST] - along_2 * q[SST] - (pt * p[SS] + qt * q[SS] + ps * p[ST] + qs * q[ST]);
  const lanes stt = z[STT] - along_1 * p[STT] - along_2 * q[STT] - (ps * p[TT] + qs * q[TT] + pt * p[ST] + qt * q[ST]);
  const lanes ttt = z[TTT] - along_1 * p[TTT] - along_2 * q[TTT] - (pt * p[TT] + qt * q[TT]);
  const lanes more_s = 0.25 * (sss + 0.5 * stt), more_t = 0.25 * (ttt + 0.5 * sst);
  along_1 += k[0][0] * more_s + k[1][0] * more_t, along_2 += k[0][1] * more_s + k[1][1] * more_t;
  c[0] = z[0] - along_1 * p[0] - along_2 * q[0] + (c[3] * p[0] * p[0] + c[4] * p[0] * q[0] + c[5] * q[0] * q[0]);
  c[1] = along_1 - 2 * c[3] * p[0] - c[4] * q[0], c[2] = along_2 - c[4] * p[0] - 2 * c[5] * q[0];
}

/* Adds, or with sign -1 subtracts, the product of two bicubics, in Bernstein form of degree (6,6) times C(6,i)
 * C(6,j). */
static void add_product(double sign, const lane_net a, const lane_net b, lanes out[7][7])
{
  static const double binomial[4] = {1, 3, 3, 1};
  lanes weighted[16];
  for (int m = 0; m < 16; m++) weighted[m] = binomial[m / 4] * binomial[m % 4] * b[m / 4][m % 4];
  for (int n = 0; n < 16; n++) {
    const lanes of = sign * binomial[n / 4] * binomial[n % 4] * a[n / 4][n % 4];
    for (int m = 0; m < 16; m++) out[n / 4 + m / 4][n % 4 + m % 4] += of * weighted[m];
  }
}

/* z minus the quadric, in Bernstein form of degree (6,6). */
static void rest(const lane_net of[3], const lanes c[6], lanes out[7][7])
{
  static const double binomial[7] = {1, 6, 15, 20, 15, 6, 1};
  lane_net one, a, b;
  for (int n = 0; n < 16; n++) {
    const int i = n / 4, j = n % 4;
    one[i][j] = lanes_all(1), a[i][j] = c[1] + (c[3] * of[Y1][i][j] + c[4] * of[Y2][i][j]);
    b[i][j] = c[2] + c[5] * of[Y2][i][j];
  }
  for (int n = 0; n < 49; n++) out[n / 7][n % 7] = lanes_all(0);
  add_product(1, of[Z], one, out);
  add_product(-1, of[Y1], a, out);
  add_product(-1, of[Y2], b, out);
  for (int n = 0; n < 49; n++) out[n / 7][n % 7] = out[n / 7][n % 7] / (binomial[n / 7] * binomial[n % 7]) - c[0];
}

LANES_INLINE lanes largest(lanes a, lanes b) { return lanes_max(lanes_abs(a), b); }

/* Bounds on a form: its value, its smallest derivative by its own parameter, S or T, its largest by the other, and by
 * either. */
struct form_bounds {
  lanes most, least, cross, steepest;
};

static struct form_bounds form_bounds(const lane_net y, int own)
{
  struct form_bounds b = {{0}, lanes_all(INFINITY), {0}, {0}};
  for (int n = 0; n < 16; n++) b.most = largest(y[n / 4][n % 4], b.most);
  for (int n = 0; n < 12; n++) {
    const lanes s = 3 * (y[n % 3 + 1][n / 3] - y[n % 3][n / 3]), t = 3 * (y[n / 3][n % 3 + 1] - y[n / 3][n % 3]);
    b.least = lanes_min(own == S ? s : t, b.least), b.cross = largest(own == S ? t : s, b.cross);
    b.steepest = largest(s, largest(t, b.steepest));
  }
  return b;
}

/* With E = QUADRIC_ERROR: coefficients of the exact patch's forms differ from the net's by at most E; those of the
 * widened leaf, which are mixed six times with weights of 1.125 and -0.125, by 3.9 E; its derivatives by 6 times that.
 * A ray's forms are off by 3 E. All roundings here, and those of a ray's forms, of size 4 at most, in the quadric, are
 * far less. */
#define FORM_SLACK (36 * QUADRIC_ERROR)

/* A bound on how far the forms turn into each other: the area of a step in both must be at least this part of the
 * product of its sides. The growth covers the rounding of the area and of what is made of it. */
#define LEAST_SHARE 0x1p-10
#define AREA_GROWTH (1 + 0x1p-30)

/* Of the rest: its range, how much it turns, and what QUADRIC_ERROR may do to all of that and to a derivative along a
 * ray. */
struct rest_bounds {
  lanes low, high, turn[2], slack;
};

static void rest_bounds(const lane_net of[3], const lanes c[6], struct rest_bounds *out)
{
  lanes r[7][7], by_s = {0}, by_t = {0};
  rest(of, c, r);
  out->low = out->high = r[0][0];
  for (int n = 1; n < 49; n++)
    out->low = lanes_min(r[n / 7][n % 7], out->low), out->high = lanes_max(r[n / 7][n % 7], out->high);
  for (int n = 0; n < 42; n++) {
    by_s = largest(6 * (r[n % 6 + 1][n / 6] - r[n % 6][n / 6]), by_s);
    by_t = largest(6 * (r[n / 6][n % 6 + 1] - r[n / 6][n % 6]), by_t);
  }
  const struct form_bounds one = form_bounds(of[Y1], S);
  const struct form_bounds two = form_bounds(of[Y2], T);
  /* How much z minus the quadric moves if the forms do; then the same of its derivatives. */
  const lanes square_1 = lanes_abs(c[3]), mixed = lanes_abs(c[4]), square_2 = lanes_abs(c[5]);
  const lanes moves = 1 + (lanes_abs(c[1]) + 2 * square_1 * one.most + mixed * two.most) +
                      (lanes_abs(c[2]) + mixed * one.most + 2 * square_2 * two.most);
  out->slack = FORM_SLACK * (moves + 2 * (square_1 + mixed + square_2) * (1 + one.steepest + two.steepest));
  by_s += out->slack, by_t += out->slack;
  /* From one point to another y1 and y2 change by their derivatives, averaged on the way: an invertible matrix. */
  const lanes least_1 = one.least - FORM_SLACK, least_2 = two.least - FORM_SLACK;
  const lanes cross_1 = one.cross + FORM_SLACK, cross_2 = two.cross + FORM_SLACK;
  const lanes area = least_1 * least_2 - cross_1 * cross_2, inverse = AREA_GROWTH / area;
  const lane_mask sound = (least_1 > 0) & (least_2 > 0) & (area > LEAST_SHARE * (least_1 * least_2));
  out->turn[0] = lanes_select(sound, (by_s * least_2 + by_t * cross_2) * inverse, lanes_all(INFINITY));
  out->turn[1] = lanes_select(sound, (by_s * cross_1 + by_t * least_1) * inverse, lanes_all(INFINITY));
}

/* As struct leaf_quadric. */
struct lane_quadric {
  lanes c[6], off, turn[2], turn_wide[2], slack;
};
static_assert(sizeof(struct leaf_quadric) == sizeof(double[12]), "stored in a row");

static void quadric_set(const lane_net x[3], const lane_net wide[3], const struct lane_slab slab[3],
                        struct lane_quadric *out)
{
  lane_net forms[3];
  struct rest_bounds leaf, around;
  set_forms(x, slab, forms);
  fit((const lane_net *)forms, out->c);
  rest_bounds((const lane_net *)forms, out->c, &leaf);
  set_forms(wide, slab, forms);
  rest_bounds((const lane_net *)forms, out->c, &around);
  out->c[0] += 0.5 * (leaf.low + leaf.high);
  out->off = 0.5 * (leaf.high - leaf.low) + leaf.slack, out->slack = around.slack;
  for (int k = 0; k < 2; k++) out->turn[k] = leaf.turn[k], out->turn_wide[k] = around.turn[k];
  /* Where something is not a number, or there are no forms, the quadric tells nothing. */
  const lane_mask tells = (out->off < 4) & (out->slack < 4);
  for (int n = 0; n < 6; n++) out->c[n] = lanes_select(tells, out->c[n], lanes_all(0));
  out->off = lanes_select(tells, out->off, lanes_all(INFINITY));
  out->slack = lanes_select(tells, out->slack, lanes_all(INFINITY));
}

void quadrics_make(size_t count, struct leaf leaves[])
{
  while (count > 0) {
    const size_t here = count < LANES ? count : LANES;
    lane_net x[3], wide[3];
    struct lane_slab slab[3];
    struct lane_quadric quadric;
    lanes_gather(x[0][0], 48, here, leaves->x[0], LEAF);
    lanes_gather(slab->g, 15, here, leaves->slab->g, LEAF);
    for (int k = 0; k < 3; k++) subnet_widened((const lanes(*)[4])x[k], LEAF_MARGIN, wide[k]);
    quadric_set((const lane_net *)x, (const lane_net *)wide, slab, &quadric);
    lanes_scatter(quadric.c, 12, here, leaves->quadric.c, LEAF);
    for (size_t k = 0; k < here; k++) leaves[k].has_quadric = true;
    leaves += here, count -= here;
  }
}
