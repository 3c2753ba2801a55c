/* Exact subdivision; see exact.h. Methods: G. Farin, Curves and Surfaces for CAGD (nets, halving); R. Moore, R.
 * Kearfott, M. Cloud, Introduction to Interval Analysis, chapter 8 (preconditioning, Krawczyk's operator). */
#include "accuracy/exact.h"

#include <math.h>
#include <string.h>

#include "accuracy/exact_ball.h"
#include "accuracy/exact_point.h"

/* Bits of the entries of a preconditioner (enough for a patch that is a line but for rounding), and how much more than the border of a box (relative to its size) the proof
 * of uniqueness covers, 2^-OVERHANG: the derivatives there change by less than 2^-MARGIN of their largest. */
enum { PRECONDITIONER_BITS = 192, OVERHANG = 40, MARGIN = 30 };

enum { FIRST_PRECISION = 192, MOST_HALVINGS = 1200, STACK = 256 };

struct search {
  struct exact_roots *out;
  fmpz_t low, high; /* the ends of the interval in the unit of net T of the whole patch */
  bool endless;
  arb_t unit; /* t - t_about = unit x (value of net T) */
  struct box stack[STACK];
  int depth;
  slong bits[NETS]; /* of the largest coefficient over the whole patch */
};

static void nets_init(fmpz *c, int count)
{
  for (int n = 0; n < count; n++) fmpz_init(&c[n]);
}

static void nets_clear(fmpz *c, int count)
{
  for (int n = 0; n < count; n++) fmpz_clear(&c[n]);
}

static void box_init(struct box *box)
{
  nets_init(&box->c[0][0], NETS * 16);
  fmpz_init(&box->u), fmpz_init(&box->v);
  box->halved[0] = box->halved[1] = 0;
}

static void box_clear(struct box *box)
{
  nets_clear(&box->c[0][0], NETS * 16);
  fmpz_clear(&box->u), fmpz_clear(&box->v);
}

/* ---- the nets of a patch ---- */

/* The exponent of the last bit of x, or `other` where that is less or x is 0. */
static int last_bit(double x, int other)
{
  int exponent;
  double m = frexp(x, &exponent);
  if (m == 0) return other;
  exponent -= 53;
  return exponent < other ? exponent : other;
}

/* out = x 2^-exponent. */
static void scaled(double x, int exponent, fmpz_t out)
{
  int own;
  const double m = frexp(x, &own);
  fmpz_set_d(out, ldexp(m, 53));
  if (m != 0) fmpz_mul_2exp(out, out, (ulong)(own - 53 - exponent));
}

/* Where t lies in the unit of net T before it is moved to t_about: t |d|^2 2^(direction's exponent - coordinates'). */
static void t_scaled(double t, const fmpz_t square, int shift, fmpz_t out)
{
  int own;
  const double m = frexp(t, &own);
  fmpz_set_d(out, ldexp(m, 53));
  fmpz_mul(out, out, square);
  if (m != 0) fmpz_mul_2exp(out, out, (ulong)(own - 53 + shift));
}

static void start(struct search *s, const double P[4][4][3], const double o[3], const double d[3], const double ends[3])
{
  int places = 1 << 20, slopes = 1 << 20, k = 0;
  for (int axis = 0; axis < 3; axis++) {
    places = last_bit(o[axis], places), slopes = last_bit(d[axis], slopes);
    for (int n = 0; n < 16; n++) places = last_bit(P[n / 4][n % 4][axis], places);
    if (fabs(d[axis]) > fabs(d[k])) k = axis;
  }
  if (places == 1 << 20) places = 0;
  int times = slopes - places; /* of t's integer unit */
  int extra = 0;               /* net T has this many bits more, so that the ends are whole numbers */
  for (int n = 0; n < 3; n++)
    if (isfinite(ends[n]) && ends[n] != 0 && last_bit(ends[n], 1 << 20) + times < -extra)
      extra = -(last_bit(ends[n], 1 << 20) + times);
  fmpz_t from[3], along[3], at[3], square, about, product;
  fmpz_init(square), fmpz_init(about), fmpz_init(product);
  for (int axis = 0; axis < 3; axis++) {
    fmpz_init(from[axis]), fmpz_init(along[axis]), fmpz_init(at[axis]);
    scaled(o[axis], places, from[axis]), scaled(d[axis], slopes, along[axis]);
    fmpz_addmul(square, along[axis], along[axis]);
  }
  t_scaled(ends[0], square, times + extra, s->low);
  s->endless = !isfinite(ends[1]);
  if (!s->endless) t_scaled(ends[1], square, times + extra, s->high);
  t_scaled(ends[2], square, times + extra, about);
  fmpz_sub(s->low, s->low, about), fmpz_sub(s->high, s->high, about);
  arb_set_fmpz(s->unit, square);
  arb_mul_2exp_si(s->unit, s->unit, times + extra);
  arb_inv(s->unit, s->unit, FIRST_PRECISION);
  struct box *box = &s->stack[0];
  box_init(box);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  for (int n = 0; n < 16; n++) {
    for (int axis = 0; axis < 3; axis++) {
      scaled(P[n / 4][n % 4][axis], places, at[axis]);
      fmpz_sub(at[axis], at[axis], from[axis]);
      fmpz_addmul(&box->c[T][n], at[axis], along[axis]);
    }
    fmpz_mul_2exp(&box->c[T][n], &box->c[T][n], (ulong)extra);
    fmpz_sub(&box->c[T][n], &box->c[T][n], about);
    fmpz_mul(&box->c[A][n], along[k], at[i]), fmpz_submul(&box->c[A][n], along[i], at[k]);
    fmpz_mul(&box->c[B][n], along[k], at[j]), fmpz_submul(&box->c[B][n], along[j], at[k]);
  }
  s->depth = 1;
  for (int axis = 0; axis < 3; axis++) fmpz_clear(from[axis]), fmpz_clear(along[axis]), fmpz_clear(at[axis]);
  fmpz_clear(square), fmpz_clear(about), fmpz_clear(product);
}

/* ---- nets ---- */

/* 8 times the cubic c[0], c[stride] ... over both halves. */
static void halve(const fmpz *c, int stride, fmpz *low, fmpz *high)
{
  const fmpz *c0 = c, *c1 = c + stride, *c2 = c + 2 * stride, *c3 = c + 3 * stride;
  fmpz_t p0, p1, p2, q0, q1, r;
  fmpz_init(p0), fmpz_init(p1), fmpz_init(p2), fmpz_init(q0), fmpz_init(q1), fmpz_init(r);
  fmpz_add(p0, c0, c1), fmpz_add(p1, c1, c2), fmpz_add(p2, c2, c3);
  fmpz_add(q0, p0, p1), fmpz_add(q1, p1, p2), fmpz_add(r, q0, q1);
  fmpz_mul_2exp(low, c0, 3), fmpz_mul_2exp(low + stride, p0, 2), fmpz_mul_2exp(low + 2 * stride, q0, 1);
  fmpz_set(low + 3 * stride, r), fmpz_set(high, r);
  fmpz_mul_2exp(high + 3 * stride, c3, 3), fmpz_mul_2exp(high + 2 * stride, p2, 2);
  fmpz_mul_2exp(high + stride, q1, 1);
  fmpz_clear(p0), fmpz_clear(p1), fmpz_clear(p2), fmpz_clear(q0), fmpz_clear(q1), fmpz_clear(r);
}

static void box_split(const struct box *box, int across_v, struct box *low, struct box *high)
{
  for (int f = 0; f < NETS; f++) {
    for (int n = 0; n < 4; n++) {
      const int at = across_v ? 4 * n : n;
      halve(&box->c[f][at], across_v ? 1 : 4, &low->c[f][at], &high->c[f][at]);
    }
  }
  memcpy(low->halved, box->halved, sizeof low->halved);
  low->halved[across_v]++;
  memcpy(high->halved, low->halved, sizeof low->halved);
  fmpz_mul_2exp(&low->u, &box->u, !across_v), fmpz_mul_2exp(&low->v, &box->v, (ulong)across_v);
  fmpz_add_ui(&high->u, &low->u, !across_v), fmpz_add_ui(&high->v, &low->v, (ulong)across_v);
}

/* 1 or -1 where all coefficients have that sign, else 0. */
static int one_sign(const fmpz *c)
{
  const int sign = fmpz_sgn(&c[0]);
  for (int n = 1; n < 16 && sign; n++)
    if (fmpz_sgn(&c[n]) != sign) return 0;
  return sign;
}

/* Mean derivatives of both nets over the box, times one factor: J[f][0] by u, J[f][1] by v. Each row is cut off to
 * PRECONDITIONER_BITS. */
static void mean_jacobian(const struct box *box, fmpz J[2][2])
{
  slong excess[2];
  for (int f = A; f <= B; f++) {
    fmpz_zero(&J[f][0]), fmpz_zero(&J[f][1]);
    for (int k = 0; k < 4; k++) {
      fmpz_add(&J[f][0], &J[f][0], &box->c[f][12 + k]), fmpz_sub(&J[f][0], &J[f][0], &box->c[f][k]);
      fmpz_add(&J[f][1], &J[f][1], &box->c[f][4 * k + 3]), fmpz_sub(&J[f][1], &J[f][1], &box->c[f][4 * k]);
    }
    const slong bits[2] = {(slong)fmpz_bits(&J[f][0]), (slong)fmpz_bits(&J[f][1])};
    excess[f] = (bits[0] > bits[1] ? bits[0] : bits[1]) - PRECONDITIONER_BITS;
    if (excess[f] < 0) excess[f] = 0;
  }
  const slong common = excess[A] < excess[B] ? excess[A] : excess[B];
  for (int f = A; f <= B; f++) {
    for (int k = 0; k < 2; k++) {
      fmpz_tdiv_q_2exp(&J[f][k], &J[f][k], (ulong)excess[f]);
      fmpz_mul_2exp(&J[f][k], &J[f][k], (ulong)(excess[f] - common));
    }
  }
}

/* out = x A - y B. */
static void combine(const struct box *box, const fmpz *x, const fmpz *y, fmpz *out)
{
  for (int n = 0; n < 16; n++) fmpz_mul(&out[n], x, &box->c[A][n]), fmpz_submul(&out[n], y, &box->c[B][n]);
}

/* Whether |dF/d own| > |dF/d other| on the box and on what is next to it. */
static bool dominates(const fmpz *F, int own_is_v)
{
  fmpz_t least, most, largest, difference;
  fmpz_init(least), fmpz_init(most), fmpz_init(largest), fmpz_init(difference);
  int sign = 0;
  bool good = true;
  for (int k = 0; k < 12 && good; k++) {
    const int low = own_is_v ? 4 * (k / 3) + k % 3 : k, step = own_is_v ? 1 : 4;
    fmpz_sub(difference, &F[low + step], &F[low]);
    if (k == 0) sign = fmpz_sgn(difference);
    good = sign != 0 && fmpz_sgn(difference) == sign;
    fmpz_abs(difference, difference);
    if (k == 0 || fmpz_cmp(difference, least) < 0) fmpz_set(least, difference);
    if (fmpz_cmp(difference, largest) > 0) fmpz_set(largest, difference);
  }
  for (int k = 0; k < 12 && good; k++) {
    const int low = own_is_v ? k : 4 * (k / 3) + k % 3, step = own_is_v ? 4 : 1;
    fmpz_sub(difference, &F[low + step], &F[low]);
    fmpz_abs(difference, difference);
    if (fmpz_cmp(difference, most) > 0) fmpz_set(most, difference);
  }
  if (good) {
    if (fmpz_cmp(most, largest) > 0) fmpz_set(largest, most);
    fmpz_fdiv_q_2exp(largest, largest, MARGIN);
    fmpz_add(most, most, largest);
    good = fmpz_cmp(least, most) > 0;
  }
  fmpz_clear(least), fmpz_clear(most), fmpz_clear(largest), fmpz_clear(difference);
  return good;
}

/* ---- roots of a box ---- */

static double double_of(const arb_t x) { return arf_get_d(arb_midref(x), ARF_RND_NEAR); }

/* A parameter of the whole patch. */
static double whole(const fmpz *corner, int halved, const arb_t at)
{
  arb_t x;
  arb_init(x);
  arb_set_fmpz(x, corner), arb_add(x, x, at, FIRST_PRECISION), arb_mul_2exp_si(x, x, -halved);
  const double value = double_of(x);
  arb_clear(x);
  return value;
}

static struct exact_root *add_root(struct search *s)
{
  struct exact_roots *out = s->out;
  if (out->count < EXACT_MOST_ROOTS) return &out->root[out->count++];
  return NULL;
}

/* A range of t in which nothing is known; where there is no room, the last one is made longer. */
static void add_unknown(struct search *s, double u, double v, double low, double high)
{
  struct exact_root *root = add_root(s);
  if (root) {
    *root = (struct exact_root){u, v, low, false, high};
    return;
  }
  root = &s->out->root[EXACT_MOST_ROOTS - 1];
  *root = (struct exact_root){root->u, root->v, fmin(root->t_off, low), false, fmax(root->t_end, high)};
}

/* The value of net T of a box, a ball, as t - t_about. */
static void t_of(const struct search *s, const struct box *box, const arb_t value, arb_t out)
{
  arb_mul(out, value, s->unit, FIRST_PRECISION);
  arb_mul_2exp_si(out, out, -3 * (box->halved[0] + box->halved[1]));
}

/* Whether x, in the unit of the box's net T, lies after the end `end` of the interval: 1 yes, -1 no, 0 unknown. */
static int after(const struct box *box, const arb_t x, const fmpz_t end)
{
  arb_t difference;
  fmpz_t scaled_end;
  arb_init(difference), fmpz_init(scaled_end);
  fmpz_mul_2exp(scaled_end, end, (ulong)(3 * (box->halved[0] + box->halved[1])));
  arb_sub_fmpz(difference, x, scaled_end, EXACT_PRECISION);
  const int sign = arb_is_positive(difference) ? 1 : arb_is_nonpositive(difference) ? -1 : 0;
  arb_clear(difference), fmpz_clear(scaled_end);
  return sign;
}

/* Adds the one root of the box, if it is within patch and interval. False: more precision is needed. */
static bool accept(struct search *s, const struct box *box, const arb_t at_u, const arb_t at_v, bool last)
{
  const enum side side = ball_side(box, at_u, at_v);
  if (side == SIDE_OUT) return true;
  struct ball_jet jet;
  ball_jet_init(&jet);
  ball_evaluate(box->c[T], at_u, at_v, &jet, EXACT_PRECISION);
  const int begun = after(box, jet.value, s->low), ended = s->endless ? -1 : after(box, jet.value, s->high);
  bool sure = side == SIDE_IN && begun && ended, out = begun < 0 || ended > 0;
  if (!sure && !out) {
    const enum side exactly = point_side(box, at_u, at_v, s->low, s->endless ? NULL : s->high);
    sure = exactly == SIDE_IN, out = exactly == SIDE_OUT;
  }
  if (out || (!sure && !last)) {
    ball_jet_clear(&jet);
    return out;
  }
  arb_t t;
  arb_init(t);
  t_of(s, box, jet.value, t);
  const double t_off = double_of(t), u = whole(&box->u, box->halved[0], at_u), v = whole(&box->v, box->halved[1], at_v);
  struct exact_root *root = sure ? add_root(s) : NULL;
  if (root) *root = (struct exact_root){u, v, t_off, true, t_off};
  else add_unknown(s, u, v, t_off, t_off);
  arb_clear(t), ball_jet_clear(&jet);
  return true;
}

/* Whether x is within 2^-OVERHANG of [0,1]. */
static bool near_box(const arb_t x)
{
  const double m = double_of(x);
  return m > -ldexp(1, -OVERHANG - 1) && m < 1 + ldexp(1, -OVERHANG - 1) &&
         mag_cmp_2exp_si(arb_radref(x), -OVERHANG - 2) < 0;
}

/* Whether the box, which has at most one root in it or next to it, is done with. */
static bool settle_one(struct search *s, const struct box *box, const struct pair *pair)
{
  arb_t u, v;
  bool done = false;
  arb_init(u), arb_init(v);
  ball_start(pair, u, v);
  if (ball_prove(pair, u, v, FIRST_PRECISION) && near_box(u) && near_box(v)) {
    done = accept(s, box, u, v, false);
    for (long bits = 4 * FIRST_PRECISION; !done; bits *= 4) {
      mag_zero(arb_radref(u)), mag_zero(arb_radref(v));
      if (!ball_prove(pair, u, v, bits)) break;
      done = accept(s, box, u, v, 4 * bits > EXACT_PRECISION);
    }
  }
  arb_clear(u), arb_clear(v);
  return done;
}

/* Whether all of the box's net T lies outside of the interval. */
static bool outside_interval(const struct search *s, const struct box *box)
{
  fmpz_t end;
  bool before = true, behind = !s->endless;
  fmpz_init(end);
  const ulong shift = (ulong)(3 * (box->halved[0] + box->halved[1]));
  fmpz_mul_2exp(end, s->low, shift);
  for (int n = 0; n < 16 && before; n++) before = fmpz_cmp(&box->c[T][n], end) <= 0;
  fmpz_mul_2exp(end, s->high, shift);
  for (int n = 0; n < 16 && behind; n++) behind = fmpz_cmp(&box->c[T][n], end) >= 0;
  fmpz_clear(end);
  return before || behind;
}

/* Whether the box is done with: no root in it, or its only one known. The combinations are the rows of the mean
 * Jacobian's adjugate: they vary along u and along v alone, and next to a tangency both only quadratically. */
static bool settle(struct search *s, const struct box *box)
{
  if (one_sign(box->c[A]) || one_sign(box->c[B]) || outside_interval(s, box)) return true;
  fmpz J[2][2];
  struct pair pair;
  nets_init(&J[0][0], 4), nets_init(&pair.F[0][0], 32);
  mean_jacobian(box, J);
  combine(box, &J[1][1], &J[0][1], pair.F[0]);
  combine(box, &J[1][0], &J[0][0], pair.F[1]);
  const bool done = one_sign(pair.F[0]) || one_sign(pair.F[1]) ||
                    (dominates(pair.F[0], 0) && dominates(pair.F[1], 1) && settle_one(s, box, &pair));
  nets_clear(&J[0][0], 4), nets_clear(&pair.F[0][0], 32);
  return done;
}

/* Gives up a box: its t is unknown within the range of its net. */
static void give_up(struct search *s, const struct box *box)
{
  arb_t value, t, middle;
  double low = INFINITY, high = -INFINITY;
  arb_init(value), arb_init(t), arb_init(middle);
  for (int n = 0; n < 16; n++) {
    arb_set_fmpz(value, &box->c[T][n]);
    t_of(s, box, value, t);
    low = fmin(low, double_of(t)), high = fmax(high, double_of(t));
  }
  arb_set_d(middle, 0.5);
  add_unknown(s, whole(&box->u, box->halved[0], middle), whole(&box->v, box->halved[1], middle), low, high);
  arb_clear(value), arb_clear(t), arb_clear(middle);
}

/* ---- edges met exactly ---- */

/* Where both polynomials vanish on a border all its points are roots: adds them, and divides them out. */
static void strip_edges(struct search *s)
{
  struct box *box = &s->stack[0];
  for (int border = 0; border < 4; border++) {
    bool known = false;
    while (point_edge_vanishes(box->c[A], border) && point_edge_vanishes(box->c[B], border)) {
      arb_t value, t;
      arb_init(value), arb_init(t);
      double low = INFINITY, high = -INFINITY;
      bool in = true;
      for (int n = 0; n < 4; n++) {
        const fmpz *c = &box->c[T][border == 0 ? n : border == 1 ? 12 + n : border == 2 ? 4 * n : 4 * n + 3];
        arb_set_fmpz(value, c);
        t_of(s, box, value, t);
        low = fmin(low, double_of(t)), high = fmax(high, double_of(t));
        in = in && fmpz_cmp(c, s->low) > 0 && (s->endless || fmpz_cmp(c, s->high) < 0);
      }
      const double u = border == 1 ? 1 : border == 0 ? 0 : 0.5, v = border == 3 ? 1 : border == 2 ? 0 : 0.5;
      struct exact_root *root = !known && in && low == high ? add_root(s) : NULL;
      if (root) *root = (struct exact_root){u, v, low, true, low};
      else if (!known && !outside_interval(s, box) && !(low == high)) add_unknown(s, u, v, low, high);
      known = true;
      arb_clear(value), arb_clear(t);
      bool zero = true;
      for (int n = 0; n < 16; n++) zero = zero && fmpz_is_zero(&box->c[A][n]) && fmpz_is_zero(&box->c[B][n]);
      if (zero) return;
      for (int f = A; f <= B; f++) {
        for (int n = 0; n < 4; n++) {
          fmpz *line = &box->c[f][border < 2 ? n : 4 * n];
          const int stride = border < 2 ? 4 : 1;
          if (border % 2) fmpz_swap(line, line + 3 * stride), fmpz_swap(line + stride, line + 2 * stride);
          point_divide_out(line, stride);
          if (border % 2) fmpz_swap(line, line + 3 * stride), fmpz_swap(line + stride, line + 2 * stride);
        }
      }
    }
  }
}

/* Whether to halve across v: where the largest change from one coefficient to the next is, of both nets, each in units
 * of its largest coefficient over the whole patch. */
static int split_across_v(const struct search *s, const struct box *box)
{
  double most[2] = {0, 0};
  fmpz_t change;
  fmpz_init(change);
  for (int f = A; f <= B; f++) {
    const slong unit = s->bits[f] + 3 * (box->halved[0] + box->halved[1]);
    for (int n = 0; n < 12; n++) {
      const int at[2] = {n, 4 * (n / 3) + n % 3}, step[2] = {4, 1};
      for (int k = 0; k < 2; k++) {
        slong exponent = 0;
        fmpz_sub(change, &box->c[f][at[k] + step[k]], &box->c[f][at[k]]);
        const double size = fabs(fmpz_get_d_2exp(&exponent, change));
        most[k] = fmax(most[k], ldexp(size, (int)(exponent - unit)));
      }
    }
  }
  fmpz_clear(change);
  const int across_v = most[1] > most[0];
  return box->halved[across_v] < MOST_HALVINGS ? across_v : !across_v;
}

void exact_patch_roots(const double P[4][4][3], const double origin[3], const double direction[3], double t_min,
                       double t_max, double t_about, struct exact_roots *out)
{
  struct search s; /* the stack is too large to be cleared each time */
  s.out = out, s.depth = 0;
  memset(s.bits, 0, sizeof s.bits);
  out->count = out->boxes = 0;
  fmpz_init(s.low), fmpz_init(s.high), arb_init(s.unit);
  const double ends[3] = {t_min, t_max, t_about};
  start(&s, P, origin, direction, ends);
  strip_edges(&s);
  for (int f = A; f <= B; f++)
    for (int n = 0; n < 16; n++)
      if ((slong)fmpz_bits(&s.stack[0].c[f][n]) > s.bits[f]) s.bits[f] = (slong)fmpz_bits(&s.stack[0].c[f][n]);
  while (s.depth > 0) {
    struct box box = s.stack[--s.depth];
    if (!settle(&s, &box)) {
      if (++out->boxes > EXACT_BOXES || s.depth + 2 > STACK || box.halved[0] + box.halved[1] >= 2 * MOST_HALVINGS) {
        give_up(&s, &box);
      } else {
        struct box *low = &s.stack[s.depth], *high = low + 1;
        box_init(low), box_init(high);
        box_split(&box, split_across_v(&s, &box), low, high);
        s.depth += 2;
      }
    }
    box_clear(&box);
  }
  fmpz_clear(s.low), fmpz_clear(s.high), arb_clear(s.unit);
}

void exact_cleanup(void) { flint_cleanup(); }
