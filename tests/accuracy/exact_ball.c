/* The ball arithmetic of exact.c: Newton's and Krawczyk's method on a pair of bicubics, and on which side of its
 * patch's border a root lies. */
#include "accuracy/exact_parts.h"

#include <math.h>

/* The start is within the box, so these are plenty. */
enum { NEWTON_STEPS = 40 };

void ball_jet_init(struct ball_jet *jet) { arb_init(jet->value), arb_init(jet->ds), arb_init(jet->dt); }
void ball_jet_clear(struct ball_jet *jet) { arb_clear(jet->value), arb_clear(jet->ds), arb_clear(jet->dt); }

/* Cubic Bernstein weights of t, and their derivatives. */
static void weights(const arb_t t, arb_t w[4], arb_t dw[4], long bits)
{
  arb_t s, x;
  arb_init(s), arb_init(x);
  arb_sub_ui(s, t, 1, bits), arb_neg(s, s);
  arb_mul(dw[0], s, s, bits), arb_mul(x, s, t, bits), arb_mul(dw[3], t, t, bits);
  arb_mul(w[0], dw[0], s, bits), arb_mul(w[1], dw[0], t, bits), arb_mul_ui(w[1], w[1], 3, bits);
  arb_mul(w[2], x, t, bits), arb_mul_ui(w[2], w[2], 3, bits), arb_mul(w[3], dw[3], t, bits);
  arb_mul_2exp_si(x, x, 1);
  arb_sub(dw[1], dw[0], x, bits), arb_sub(dw[2], x, dw[3], bits);
  arb_neg(dw[0], dw[0]);
  for (int k = 0; k < 4; k++) arb_mul_ui(dw[k], dw[k], 3, bits);
  arb_clear(s), arb_clear(x);
}

void ball_evaluate(const fmpz *c, const arb_t s, const arb_t t, struct ball_jet *out, long bits)
{
  arb_t w[4][4], row, row_t; /* w: of s, its derivatives, of t, its derivatives */
  for (int n = 0; n < 16; n++) arb_init(w[n / 4][n % 4]);
  arb_init(row), arb_init(row_t);
  weights(s, w[0], w[1], bits), weights(t, w[2], w[3], bits);
  arb_zero(out->value), arb_zero(out->ds), arb_zero(out->dt);
  for (int i = 0; i < 4; i++) {
    arb_zero(row), arb_zero(row_t);
    for (int j = 0; j < 4; j++) {
      arb_addmul_fmpz(row, w[2][j], &c[4 * i + j], bits);
      arb_addmul_fmpz(row_t, w[3][j], &c[4 * i + j], bits);
    }
    arb_addmul(out->value, w[0][i], row, bits);
    arb_addmul(out->ds, w[1][i], row, bits);
    arb_addmul(out->dt, w[0][i], row_t, bits);
  }
  for (int n = 0; n < 16; n++) arb_clear(w[n / 4][n % 4]);
  arb_clear(row), arb_clear(row_t);
}

/* step = Y F at the middles of s and t. Y is the inverse Jacobian there; its middles are kept. */
static bool newton_step(const fmpz (*F)[16], const arb_t s, const arb_t t, arb_t Y[4], arb_t step[2], long bits)
{
  struct ball_jet f[2];
  arb_t determinant, x;
  ball_jet_init(&f[0]), ball_jet_init(&f[1]), arb_init(determinant), arb_init(x);
  for (int n = 0; n < 2; n++) ball_evaluate(F[n], s, t, &f[n], bits);
  arb_mul(determinant, f[0].ds, f[1].dt, bits), arb_submul(determinant, f[0].dt, f[1].ds, bits);
  const bool good = !arb_contains_zero(determinant);
  if (good) {
    arb_div(Y[0], f[1].dt, determinant, bits), arb_div(Y[1], f[0].dt, determinant, bits), arb_neg(Y[1], Y[1]);
    arb_div(Y[2], f[1].ds, determinant, bits), arb_neg(Y[2], Y[2]), arb_div(Y[3], f[0].ds, determinant, bits);
    for (int n = 0; n < 4; n++) mag_zero(arb_radref(Y[n]));
    for (int n = 0; n < 2; n++) {
      arb_mul(step[n], Y[2 * n], f[0].value, bits);
      arb_addmul(step[n], Y[2 * n + 1], f[1].value, bits);
    }
  }
  ball_jet_clear(&f[0]), ball_jet_clear(&f[1]), arb_clear(determinant), arb_clear(x);
  return good;
}

/* Krawczyk's test on the square of half-width r about (s,t). On success both become balls that contain exactly one
 * root. */
static bool krawczyk(const fmpz (*F)[16], arb_t s, arb_t t, arb_t Y[4], arb_t step[2], const mag_t r, long bits)
{
  arb_t X[2], K[2], M, spread;
  struct ball_jet f[2];
  ball_jet_init(&f[0]), ball_jet_init(&f[1]), arb_init(M), arb_init(spread);
  for (int n = 0; n < 2; n++) {
    arb_init(X[n]), arb_init(K[n]);
    arb_set(X[n], n ? t : s), arb_add_error_mag(X[n], r);
  }
  arb_add_error_mag(spread, r);
  bool good = true;
  for (int n = 0; n < 2; n++) ball_evaluate(F[n], X[0], X[1], &f[n], bits);
  for (int n = 0; n < 2; n++) {
    arb_sub(K[n], n ? t : s, step[n], bits);
    for (int m = 0; m < 2; m++) { /* (I - Y J)[n][m] times the spread */
      arb_mul(M, Y[2 * n], m ? f[0].dt : f[0].ds, bits);
      arb_addmul(M, Y[2 * n + 1], m ? f[1].dt : f[1].ds, bits);
      if (m == n) arb_sub_ui(M, M, 1, bits);
      arb_addmul(K[n], M, spread, bits);
    }
    good = good && arb_contains_interior(X[n], K[n]);
  }
  if (good) arb_set(s, K[0]), arb_set(t, K[1]);
  for (int n = 0; n < 2; n++) arb_clear(X[n]), arb_clear(K[n]), ball_jet_clear(&f[n]);
  arb_clear(M), arb_clear(spread);
  return good;
}

void ball_start(const fmpz (*F)[16], arb_t s, arb_t t)
{
  double c[2][16], x[2];
  for (int f = 0; f < 2; f++) {
    slong most = 0;
    for (int n = 0; n < 16; n++)
      if ((slong)fmpz_bits(&F[f][n]) > most) most = (slong)fmpz_bits(&F[f][n]);
    for (int n = 0; n < 16; n++) {
      slong exponent;
      const double mantissa = fmpz_get_d_2exp(&exponent, &F[f][n]);
      c[f][n] = exponent - most > -1000 ? ldexp(mantissa, (int)(exponent - most)) : 0;
    }
  }
  if (!quick_newton((const double(*)[16])c, x)) x[0] = x[1] = 0.5;
  arb_set_d(s, x[0]), arb_set_d(t, x[1]);
}

bool ball_prove(const fmpz (*F)[16], arb_t s, arb_t t, long bits)
{
  arb_t Y[4], step[2];
  mag_t size, other;
  bool good = true, proven = false;
  for (int n = 0; n < 4; n++) arb_init(Y[n]);
  arb_init(step[0]), arb_init(step[1]), mag_init(size), mag_init(other);
  for (int n = 0; n < NEWTON_STEPS && good && !proven; n++) {
    good = newton_step(F, s, t, Y, step, bits);
    if (!good) break;
    arb_get_mag(size, step[0]), arb_get_mag(other, step[1]);
    mag_max(size, size, other);
    if (mag_cmp_2exp_si(size, 2) > 0) good = false;
    if (mag_cmp_2exp_si(size, -(bits / 2) + 8) < 0) {
      mag_set_ui_2exp_si(other, 1, 16 - bits);
      mag_mul_2exp_si(size, size, 2);
      mag_max(size, size, other);
      for (int wide = 0; wide < 4 && !proven; wide++) {
        proven = krawczyk(F, s, t, Y, step, size, bits);
        mag_mul_2exp_si(size, size, 8);
      }
      if (proven) break;
    }
    for (int k = 0; k < 2; k++) mag_zero(arb_radref(step[k]));
    arb_sub(s, s, step[0], bits), arb_sub(t, t, step[1], bits);
    mag_zero(arb_radref(s)), mag_zero(arb_radref(t));
  }
  for (int n = 0; n < 4; n++) arb_clear(Y[n]);
  arb_clear(step[0]), arb_clear(step[1]), mag_clear(size), mag_clear(other);
  return proven;
}

static bool edge_is_line(const fmpz *const e[2][4])
{
  fmpz_t x;
  bool line = true;
  fmpz_init(x);
  for (int n = 0; n < 4 && line; n++) {
    for (int m = 0; m < n && line; m++) {
      fmpz_mul(x, e[0][n], e[1][m]), fmpz_submul(x, e[0][m], e[1][n]);
      line = fmpz_is_zero(x);
    }
  }
  fmpz_clear(x);
  return line;
}

static int edge_sign(const fmpz *const c[4], const arb_t t, bool upper)
{
  arb_t at, w[4], dw[4], sum;
  arf_t end;
  arb_init(at), arb_init(sum), arf_init(end);
  for (int k = 0; k < 4; k++) arb_init(w[k]), arb_init(dw[k]);
  if (upper) arb_get_ubound_arf(end, t, EXACT_PRECISION);
  else arb_get_lbound_arf(end, t, EXACT_PRECISION);
  arb_set_arf(at, end);
  weights(at, w, dw, EXACT_PRECISION);
  for (int k = 0; k < 4; k++) arb_addmul_fmpz(sum, w[k], c[k], EXACT_PRECISION);
  const int sign = arb_is_positive(sum) ? 1 : arb_is_negative(sum) ? -1 : 0;
  for (int k = 0; k < 4; k++) arb_clear(w[k]), arb_clear(dw[k]);
  arb_clear(at), arb_clear(sum), arf_clear(end);
  return sign;
}

/* Whether the only root next to a border, at `along` it, lies exactly on it: there both nets are multiples of one cubic
 * that changes its sign within the ball. */
static bool exactly_on(const struct box *box, int border, const arb_t along)
{
  const fmpz *e[2][4];
  for (int f = A; f <= B; f++)
    for (int n = 0; n < 4; n++)
      e[f][n] = &box->c[f][border == 0 ? n : border == 1 ? 12 + n : border == 2 ? 4 * n : 4 * n + 3];
  if (!edge_is_line((const fmpz *const(*)[4])e)) return false;
  for (int f = A; f <= B; f++) {
    const int low = edge_sign((const fmpz *const *)e[f], along, false),
              high = edge_sign((const fmpz *const *)e[f], along, true);
    if (low * high < 0) return true;
  }
  return false;
}

static bool at_border(const struct box *box, int border)
{
  const int v = border / 2;
  const fmpz *corner = v ? &box->v : &box->u;
  if (border % 2 == 0) return fmpz_is_zero(corner);
  fmpz_t end;
  fmpz_init(end);
  fmpz_one(end), fmpz_mul_2exp(end, end, (ulong)box->halved[v]), fmpz_sub_ui(end, end, 1);
  const bool last = fmpz_equal(end, corner);
  fmpz_clear(end);
  return last;
}

enum side ball_side(const struct box *box, const arb_t s, const arb_t t)
{
  bool unknown[4] = {false}, any = false;
  arb_t x;
  arb_init(x);
  enum side side = SIDE_IN;
  for (int border = 0; border < 4; border++) {
    if (!at_border(box, border)) continue;
    arb_set(x, border / 2 ? t : s);
    if (border % 2) arb_sub_ui(x, x, 1, EXACT_PRECISION), arb_neg(x, x);
    if (arb_is_negative(x)) side = SIDE_OUT;
    unknown[border] = !arb_is_nonnegative(x) && !arb_is_negative(x);
    any |= unknown[border];
  }
  arb_clear(x);
  if (side == SIDE_OUT || !any) return side;
  const int in_u = unknown[0] ? 0 : unknown[1] ? 1 : -1, in_v = unknown[2] ? 2 : unknown[3] ? 3 : -1;
  if (in_u >= 0 && in_v >= 0) {
    const int corner = (in_u == 1 ? 12 : 0) + (in_v == 3 ? 3 : 0);
    return fmpz_is_zero(&box->c[A][corner]) && fmpz_is_zero(&box->c[B][corner]) ? SIDE_IN : SIDE_UNKNOWN;
  }
  if (in_u >= 0) return exactly_on(box, in_u, t) ? SIDE_IN : SIDE_UNKNOWN;
  return exactly_on(box, in_v, s) ? SIDE_IN : SIDE_UNKNOWN;
}
