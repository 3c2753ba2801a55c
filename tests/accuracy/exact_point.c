/* Roots that are known exactly. See exact_parts.h. */
#include "accuracy/exact_parts.h"

#include <flint/fmpq.h>

/* The simplest fraction in the ball. */
static void simplest(const arb_t x, fmpq_t out)
{
  fmpz_t low, high, exponent;
  fmpq_t from, to;
  fmpz_init(low), fmpz_init(high), fmpz_init(exponent), fmpq_init(from), fmpq_init(to);
  arb_get_interval_fmpz_2exp(low, high, exponent, x);
  const slong shift = fmpz_get_si(exponent);
  fmpq_set_fmpz(from, low), fmpq_set_fmpz(to, high);
  if (shift < 0) fmpq_div_2exp(from, from, (ulong)-shift), fmpq_div_2exp(to, to, (ulong)-shift);
  else fmpq_mul_2exp(from, from, (ulong)shift), fmpq_mul_2exp(to, to, (ulong)shift);
  fmpq_simplest_between(out, from, to);
  fmpz_clear(low), fmpz_clear(high), fmpz_clear(exponent), fmpq_clear(from), fmpq_clear(to);
}

/* The cubic Bernstein weights of x = p/q, times q^3. */
static void weights(const fmpq_t x, fmpz w[4])
{
  const fmpz *p = fmpq_numref(x), *q = fmpq_denref(x);
  fmpz_t rest;
  fmpz_init(rest);
  fmpz_sub(rest, q, p);
  fmpz_pow_ui(&w[0], rest, 3), fmpz_pow_ui(&w[3], p, 3);
  fmpz_mul(&w[1], rest, rest), fmpz_mul(&w[1], &w[1], p), fmpz_mul_ui(&w[1], &w[1], 3);
  fmpz_mul(&w[2], p, p), fmpz_mul(&w[2], &w[2], rest), fmpz_mul_ui(&w[2], &w[2], 3);
  fmpz_clear(rest);
}

/* The net c at a point. */
static void value(const fmpz *c, const fmpz wu[4], const fmpz wv[4], fmpz_t out)
{
  fmpz_t row;
  fmpz_init(row);
  fmpz_zero(out);
  for (int i = 0; i < 4; i++) {
    fmpz_zero(row);
    for (int j = 0; j < 4; j++) fmpz_addmul(row, &wv[j], &c[4 * i + j]);
    fmpz_addmul(out, &wu[i], row);
  }
  fmpz_clear(row);
}

/* Whether x of a box is in the patch. */
static bool in_patch(const fmpz_t corner, int halved, const fmpq_t x)
{
  fmpq_t at;
  fmpz_t end;
  fmpq_init(at), fmpz_init(end);
  fmpq_add_fmpz(at, x, corner);
  fmpz_one(end), fmpz_mul_2exp(end, end, (ulong)halved);
  const bool in = fmpq_sgn(at) >= 0 && fmpq_cmp_fmpz(at, end) <= 0;
  fmpq_clear(at), fmpz_clear(end);
  return in;
}

/* The sign of t minus an end of the interval, both times `unit`. */
static int compare(const fmpz_t t, const fmpz_t end, const fmpz_t unit)
{
  fmpz_t at;
  fmpz_init(at);
  fmpz_mul(at, end, unit);
  const int sign = fmpz_cmp(t, at);
  fmpz_clear(at);
  return sign;
}

enum side point_side(const struct box *box, const arb_t s, const arb_t t, const fmpz_t low, const fmpz *high)
{
  fmpq_t u, v;
  fmpz wu[4] = {0}, wv[4] = {0};
  fmpz_t x, unit;
  enum side side = SIDE_UNKNOWN;
  fmpq_init(u), fmpq_init(v), fmpz_init(x), fmpz_init(unit);
  simplest(s, u), simplest(t, v);
  weights(u, wu), weights(v, wv);
  value(box->c[A], wu, wv, x);
  if (fmpz_is_zero(x)) value(box->c[B], wu, wv, x);
  if (fmpz_is_zero(x)) {
    value(box->c[T], wu, wv, x);
    fmpz_mul(unit, fmpq_denref(u), fmpq_denref(v)), fmpz_pow_ui(unit, unit, 3);
    fmpz_mul_2exp(unit, unit, (ulong)(3 * (box->halved[0] + box->halved[1])));
    const bool in = in_patch(&box->u, box->halved[0], u) && in_patch(&box->v, box->halved[1], v) &&
                    compare(x, low, unit) > 0 && (!high || compare(x, high, unit) < 0);
    side = in ? SIDE_IN : SIDE_OUT;
  }
  for (int k = 0; k < 4; k++) fmpz_clear(&wu[k]), fmpz_clear(&wv[k]);
  fmpq_clear(u), fmpq_clear(v), fmpz_clear(x), fmpz_clear(unit);
  return side;
}

/* The net c at u alone, at v alone, and at both. */
struct lines {
  fmpz at_u[4], at_v[4], both;
};

static void lines_of(const fmpz *c, const fmpz wu[4], const fmpz wv[4], struct lines *out)
{
  *out = (struct lines){.both = 0};
  for (int n = 0; n < 16; n++) {
    fmpz_addmul(&out->at_u[n % 4], &wu[n / 4], &c[n]);
    fmpz_addmul(&out->at_v[n / 4], &wv[n % 4], &c[n]);
  }
  for (int k = 0; k < 4; k++) fmpz_addmul(&out->both, &wu[k], &out->at_v[k]);
}

static void lines_clear(struct lines *l)
{
  for (int k = 0; k < 4; k++) fmpz_clear(&l->at_u[k]), fmpz_clear(&l->at_v[k]);
  fmpz_clear(&l->both);
}

static bool vanishes(const fmpz c[4])
{
  return fmpz_is_zero(&c[0]) && fmpz_is_zero(&c[1]) && fmpz_is_zero(&c[2]) && fmpz_is_zero(&c[3]);
}

/* The derivative of a cubic at p/q, times q^2 and over 3. */
static void slope(const fmpz c[4], const fmpq_t x, fmpz_t out)
{
  fmpz_t rest, step;
  fmpz_init(rest), fmpz_init(step);
  const fmpz *p = fmpq_numref(x), *q = fmpq_denref(x);
  fmpz_sub(rest, q, p);
  fmpz_zero(out);
  for (int k = 0; k < 3; k++) {
    fmpz_sub(step, &c[k + 1], &c[k]);
    fmpz_mul(step, step, k < 2 ? rest : p), fmpz_mul(step, step, k < 1 ? rest : p);
    fmpz_addmul_ui(out, step, k == 1 ? 2 : 1);
  }
  fmpz_clear(rest), fmpz_clear(step);
}

/* Whether the gradients of both nets are parallel. */
static bool parallel(const struct lines l[2], const fmpq_t u, const fmpq_t v)
{
  fmpz_t du[2], dv[2];
  for (int f = A; f <= B; f++) {
    fmpz_init(du[f]), fmpz_init(dv[f]);
    slope(l[f].at_v, u, du[f]), slope(l[f].at_u, v, dv[f]);
  }
  fmpz_mul(du[A], du[A], dv[B]), fmpz_submul(du[A], du[B], dv[A]);
  const bool good = fmpz_is_zero(du[A]);
  for (int f = A; f <= B; f++) fmpz_clear(du[f]), fmpz_clear(dv[f]);
  return good;
}

/* The simplest fraction in the place. */
static void simplest_of(const struct place *place, int axis, fmpq_t out)
{
  fmpz_t corner, size;
  fmpq_t from, to;
  fmpz_init(corner), fmpz_init(size), fmpq_init(from), fmpq_init(to);
  fmpz_add_ui(corner, corner, place->corner[axis]);
  fmpz_one(size), fmpz_mul_2exp(size, size, (ulong)place->halved[axis]);
  fmpq_set_fmpz_frac(from, corner, size);
  fmpz_add_ui(corner, corner, 1);
  fmpq_set_fmpz_frac(to, corner, size);
  fmpq_simplest_between(out, from, to);
  fmpz_clear(corner), fmpz_clear(size), fmpq_clear(from), fmpq_clear(to);
}

enum hopeless point_hopeless(const struct box *whole, const struct place *place)
{
  fmpq_t u, v;
  fmpz wu[4] = {0}, wv[4] = {0};
  struct lines l[2];
  fmpq_init(u), fmpq_init(v);
  simplest_of(place, 0, u), simplest_of(place, 1, v);
  weights(u, wu), weights(v, wv);
  for (int f = A; f <= B; f++) lines_of(whole->c[f], wu, wv, &l[f]);
  enum hopeless found = HOPELESS_NOT;
  if ((vanishes(l[A].at_u) && vanishes(l[B].at_u)) || (vanishes(l[A].at_v) && vanishes(l[B].at_v)))
    found = HOPELESS_CURVE;
  else if (fmpz_is_zero(&l[A].both) && fmpz_is_zero(&l[B].both) && parallel(l, u, v)) found = HOPELESS_POINT;
  for (int k = 0; k < 4; k++) fmpz_clear(&wu[k]), fmpz_clear(&wv[k]);
  for (int f = A; f <= B; f++) lines_clear(&l[f]);
  fmpq_clear(u), fmpq_clear(v);
  return found;
}

bool point_edge_vanishes(const fmpz *c, int border)
{
  for (int n = 0; n < 4; n++)
    if (!fmpz_is_zero(&c[border == 0 ? n : border == 1 ? 12 + n : border == 2 ? 4 * n : 4 * n + 3])) return false;
  return true;
}

void point_divide_out(fmpz *c, int stride)
{
  fmpz_t q[3];
  for (int n = 0; n < 3; n++) fmpz_init(q[n]);
  fmpz_mul_ui(q[0], c + stride, 6), fmpz_mul_ui(q[1], c + 2 * stride, 3), fmpz_mul_ui(q[2], c + 3 * stride, 2);
  fmpz_mul_ui(c, q[0], 3); /* raised to degree 3 again, times 3 */
  fmpz_mul_ui(c + stride, q[1], 2), fmpz_add(c + stride, c + stride, q[0]);
  fmpz_mul_ui(c + 2 * stride, q[1], 2), fmpz_add(c + 2 * stride, c + 2 * stride, q[2]);
  fmpz_mul_ui(c + 3 * stride, q[2], 3);
  for (int n = 0; n < 3; n++) fmpz_clear(q[n]);
}
