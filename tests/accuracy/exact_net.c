/* See exact_parts.h. */
#include "accuracy/exact_parts.h"

#include <math.h>
#include <string.h>

#include "base/wide.h"

/* Bits of a preconditioner's entries (enough for a patch that is a line up to rounding); for MARGIN see
 * net_dominates. */
enum { PRECONDITIONER_BITS = 192, MARGIN = 30 };

void nets_init(fmpz *c, int count)
{
  for (int n = 0; n < count; n++) fmpz_init(&c[n]);
}

void nets_clear(fmpz *c, int count)
{
  for (int n = 0; n < count; n++) fmpz_clear(&c[n]);
}

void box_init(struct box *box)
{
  nets_init(&box->c[0][0], NETS * 16);
  fmpz_init(&box->u), fmpz_init(&box->v);
  box->halved[0] = box->halved[1] = 0;
}

void box_clear(struct box *box)
{
  nets_clear(&box->c[0][0], NETS * 16);
  fmpz_clear(&box->u), fmpz_clear(&box->v);
}

/* The exponent of the last bit of x, or `other` if that is less or x is 0. */
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

/* t in the unit of net T: t |d|^2 2^(direction's exponent - coordinates'). */
static void t_scaled(double t, const fmpz_t square, int shift, fmpz_t out)
{
  int own;
  const double m = frexp(t, &own);
  fmpz_set_d(out, ldexp(m, 53));
  fmpz_mul(out, out, square);
  if (m != 0) fmpz_mul_2exp(out, out, (ulong)(own - 53 + shift));
}

/* The axis along which the ray is longest relative to the patch. Any axis along which it moves would do. But if the
 * patch is a line to 192 bits, the two planes along another one could be equal to as many bits. */
static int crossed_axis(const double P[4][4][3], const double d[3])
{
  int k = 0;
  wide size[3];
  for (int axis = 0; axis < 3; axis++) {
    wide low = P[0][0][axis], high = low;
    for (int n = 1; n < 16; n++) {
      const wide x = P[n / 4][n % 4][axis];
      low = x < low ? x : low, high = x > high ? x : high;
    }
    size[axis] = high - low;
    const wide here = d[axis] * size[k], there = d[k] * size[axis];
    if (d[k] == 0 || (here < 0 ? -here : here) > (there < 0 ? -there : there)) k = axis;
  }
  return k;
}

void box_of_patch(const double P[4][4][3], const double o[3], const double d[3], double t_min, double t_max,
                  struct box *out, struct interval *interval)
{
  const double ends[2] = {t_min, t_max};
  const int k = crossed_axis(P, d);
  int places = 1 << 20, slopes = 1 << 20;
  for (int axis = 0; axis < 3; axis++) {
    places = last_bit(o[axis], places), slopes = last_bit(d[axis], slopes);
    for (int n = 0; n < 16; n++) places = last_bit(P[n / 4][n % 4][axis], places);
  }
  if (places == 1 << 20) places = 0;
  int times = slopes - places; /* of t's integer unit */
  int extra = 0;               /* additional bits of net T, so that the ends are whole numbers */
  for (int n = 0; n < 2; n++)
    if (isfinite(ends[n]) && ends[n] != 0 && last_bit(ends[n], 1 << 20) + times < -extra)
      extra = -(last_bit(ends[n], 1 << 20) + times);
  fmpz_t from[3], along[3], at[3], square;
  fmpz_init(square);
  for (int axis = 0; axis < 3; axis++) {
    fmpz_init(from[axis]), fmpz_init(along[axis]), fmpz_init(at[axis]);
    scaled(o[axis], places, from[axis]), scaled(d[axis], slopes, along[axis]);
    fmpz_addmul(square, along[axis], along[axis]);
  }
  t_scaled(t_min, square, times + extra, interval->low);
  interval->endless = !isfinite(t_max);
  if (!interval->endless) t_scaled(t_max, square, times + extra, interval->high);
  arb_set_fmpz(interval->unit, square);
  arb_mul_2exp_si(interval->unit, interval->unit, times + extra);
  arb_inv(interval->unit, interval->unit, UNIT_PRECISION);
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  for (int n = 0; n < 16; n++) {
    for (int axis = 0; axis < 3; axis++) {
      scaled(P[n / 4][n % 4][axis], places, at[axis]);
      fmpz_sub(at[axis], at[axis], from[axis]);
      fmpz_addmul(&out->c[T][n], at[axis], along[axis]);
    }
    fmpz_mul_2exp(&out->c[T][n], &out->c[T][n], (ulong)extra);
    fmpz_mul(&out->c[A][n], along[k], at[i]), fmpz_submul(&out->c[A][n], along[i], at[k]);
    fmpz_mul(&out->c[B][n], along[k], at[j]), fmpz_submul(&out->c[B][n], along[j], at[k]);
  }
  for (int axis = 0; axis < 3; axis++) fmpz_clear(from[axis]), fmpz_clear(along[axis]), fmpz_clear(at[axis]);
  fmpz_clear(square);
}

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

void box_split(const struct box *box, int across_v, struct box *low, struct box *high)
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

/* The cubic c[0], c[stride] ... from corner/N to (corner+1)/N, N = 2^halved, times N^3, by its blossom at both ends. */
static void cut(fmpz *c, int stride, uint64_t corner, int halved)
{
  const ulong from = corner, size = (ulong)1 << halved;
  fmpz_t line[4];
  fmpz p[4] = {0};
  for (int n = 0; n < 4; n++) fmpz_init(line[n]), fmpz_set(line[n], &c[n * stride]);
  for (int r = 0; r < 4; r++) {
    for (int n = 0; n < 4; n++) fmpz_set(&p[n], line[n]);
    for (int level = 0; level < 3; level++) {
      const ulong x = level < r ? from + 1 : from;
      for (int n = 0; n < 3 - level; n++) fmpz_mul_ui(&p[n], &p[n], size - x), fmpz_addmul_ui(&p[n], &p[n + 1], x);
    }
    fmpz_set(&c[r * stride], &p[0]);
  }
  for (int n = 0; n < 4; n++) fmpz_clear(line[n]), fmpz_clear(&p[n]);
}

void box_of_place(const struct box *box, const struct place *place, struct box *out)
{
  for (int f = 0; f < NETS; f++) {
    for (int n = 0; n < 16; n++) fmpz_set(&out->c[f][n], &box->c[f][n]);
    for (int n = 0; n < 4 && place->halved[0]; n++) cut(&out->c[f][n], 4, place->corner[0], place->halved[0]);
    for (int n = 0; n < 4 && place->halved[1]; n++) cut(&out->c[f][4 * n], 1, place->corner[1], place->halved[1]);
  }
  fmpz_mul_2exp(&out->u, &box->u, (ulong)place->halved[0]), fmpz_mul_2exp(&out->v, &box->v, (ulong)place->halved[1]);
  fmpz_add_ui(&out->u, &out->u, place->corner[0]), fmpz_add_ui(&out->v, &out->v, place->corner[1]);
  for (int k = 0; k < 2; k++) out->halved[k] = box->halved[k] + place->halved[k];
}

int box_changes_along_v(const struct box *box)
{
  double most[2] = {0, 0};
  fmpz_t change;
  fmpz_init(change);
  for (int f = A; f <= B; f++) {
    slong unit = 0;
    for (int n = 0; n < 16; n++)
      if ((slong)fmpz_bits(&box->c[f][n]) > unit) unit = (slong)fmpz_bits(&box->c[f][n]);
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
  return most[1] > most[0];
}

int net_sign(const fmpz *c)
{
  const int sign = fmpz_sgn(&c[0]);
  for (int n = 1; n < 16 && sign; n++)
    if (fmpz_sgn(&c[n]) != sign) return 0;
  return sign;
}

/* Mean derivatives of both nets over the box, times a common factor: J[f][0] by u, J[f][1] by v. Each row is truncated
 * to PRECONDITIONER_BITS. */
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

void box_combinations(const struct box *box, fmpz F[2][16])
{
  fmpz J[2][2];
  nets_init(&J[0][0], 4);
  mean_jacobian(box, J);
  combine(box, &J[1][1], &J[0][1], F[0]);
  combine(box, &J[1][0], &J[0][0], F[1]);
  nets_clear(&J[0][0], 4);
}

bool net_dominates(const fmpz *F, int own_is_v)
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

bool box_dependent(const struct box *box)
{
  const fmpz *a = box->c[A], *b = box->c[B];
  int first = 0;
  while (first < 15 && fmpz_is_zero(&a[first]) && fmpz_is_zero(&b[first])) first++;
  fmpz_t x;
  fmpz_init(x);
  bool dependent = true;
  for (int n = first + 1; n < 16 && dependent; n++) {
    fmpz_mul(x, &a[first], &b[n]), fmpz_submul(x, &a[n], &b[first]);
    dependent = fmpz_is_zero(x);
  }
  fmpz_clear(x);
  return dependent;
}

void box_straighten(struct box *box, struct interval *interval)
{
  fmpz_t step, slope;
  fmpz *t = box->c[T], straight[16];
  fmpz_init(step), fmpz_init(slope);
  nets_init(straight, 16);
  const fmpz *c = NULL;
  for (int n = 0; n < 32 && !c; n++) { /* the first coefficient that is not the net's first */
    const fmpz *net = box->c[n < 16 ? A : B];
    fmpz_sub(step, &net[n % 16], &net[0]), fmpz_sub(slope, &t[n % 16], &t[0]);
    if (!fmpz_is_zero(step)) c = net;
  }
  if (fmpz_sgn(step) < 0) fmpz_mul_si(step, step, -1), fmpz_mul_si(slope, slope, -1);
  bool one = c;
  for (int n = 0; n < 16 && one; n++) {
    fmpz_mul(&straight[n], &t[n], step), fmpz_submul(&straight[n], &c[n], slope);
    one = fmpz_equal(&straight[n], &straight[0]);
  }
  if (one) {
    for (int n = 0; n < 16; n++) fmpz_swap(&t[n], &straight[n]);
    fmpz_mul(interval->low, interval->low, step), fmpz_mul(interval->high, interval->high, step);
    arb_div_fmpz(interval->unit, interval->unit, step, UNIT_PRECISION);
  }
  nets_clear(straight, 16);
  fmpz_clear(step), fmpz_clear(slope);
}
