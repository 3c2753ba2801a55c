/* Folds. See fold.h. */
#include "intersect/exact/fold.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"

/* A polynomial's derivatives, or bounds on them: out[i][j] is taken i times by x and j times by y. */
struct derivatives {
  double d[4][4];
};

static void to_powers(double *b, int stride)
{
  const double b0 = b[0], b1 = b[stride], b2 = b[2 * stride], b3 = b[3 * stride];
  b[0] = 0.125 * ((b0 + b3) + 3 * (b1 + b2)), b[stride] = 0.375 * ((b3 - b0) + (b2 - b1));
  b[2 * stride] = 0.375 * ((b0 + b3) - (b1 + b2)), b[3 * stride] = 0.125 * ((b3 - b0) - 3 * (b2 - b1));
}

static void powers_of(double net[4][4], struct fold_powers *out)
{
  for (int n = 0; n < 16; n++) out->c[n / 4][n % 4] = net[n / 4][n % 4];
  for (int n = 0; n < 4; n++) to_powers(out->c[n], 1);
  for (int n = 0; n < 4; n++) to_powers(&out->c[0][n], 4);
}

static void combine(const struct fold_powers *a, const struct fold_powers *b, double p, double q,
                    struct fold_powers *out)
{
  for (int n = 0; n < 16; n++) out->c[n / 4][n % 4] = p * a->c[n / 4][n % 4] + q * b->c[n / 4][n % 4];
}

/* The derivatives at x of a cubic in powers: out[i] is the i-th. */
static void cubic_derivatives(const double c[4], double x, double out[4])
{
  out[0] = ((c[3] * x + c[2]) * x + c[1]) * x + c[0], out[1] = (3 * c[3] * x + 2 * c[2]) * x + c[1];
  out[2] = 6 * c[3] * x + 2 * c[2], out[3] = 6 * c[3];
}

static void derive(const struct fold_powers *p, double x, double y, struct derivatives *out)
{
  double rows[4][4], column[4], values[4];
  for (int i = 0; i < 4; i++) cubic_derivatives(p->c[i], y, rows[i]);
  for (int j = 0; j < 4; j++) {
    for (int i = 0; i < 4; i++) column[i] = rows[i][j];
    cubic_derivatives(column, x, values);
    for (int i = 0; i < 4; i++) out->d[i][j] = values[i];
  }
}

/* The same in the middle, where they follow from the powers; up to second derivatives. */
static void derive_middle(const struct fold_powers *p, struct derivatives *out)
{
  for (int i = 0; i < 3; i++)
    for (int j = 0; i + j < 3; j++) out->d[i][j] = p->c[i][j] * (i == 2 || j == 2 ? 2 : 1);
}

/* Bounds on the derivatives on the larger box. */
static void bound(const struct fold_powers *p, struct derivatives *out)
{
  struct fold_powers sizes;
  for (int n = 0; n < 16; n++) sizes.c[n / 4][n % 4] = fabs(p->c[n / 4][n % 4]);
  derive(&sizes, 2, 2, out);
}

/* D and its first derivatives. */
static void determinant(const struct derivatives *f, const struct derivatives *g, double out[3])
{
  const double(*F)[4] = f->d, (*G)[4] = g->d;
  out[0] = F[1][0] * G[0][1] - F[0][1] * G[1][0];
  out[1] = F[2][0] * G[0][1] + F[1][0] * G[1][1] - F[1][1] * G[1][0] - F[0][1] * G[2][0];
  out[2] = F[1][1] * G[0][1] + F[1][0] * G[0][2] - F[0][2] * G[1][0] - F[0][1] * G[1][1];
}

/* A bound on D_xx + 2 D_xy + D_yy, from bounds on derivatives. */
static double determinant_bend(const struct derivatives *f, const struct derivatives *g)
{
  const double(*F)[4] = f->d, (*G)[4] = g->d;
  const double xx = F[3][0] * G[0][1] + 2 * (F[2][0] * G[1][1] + F[1][1] * G[2][0]) + F[1][0] * G[2][1] +
                    F[2][1] * G[1][0] + F[0][1] * G[3][0];
  const double xy = F[2][1] * G[0][1] + F[2][0] * G[0][2] + F[1][0] * G[1][2] + F[1][2] * G[1][0] + F[0][2] * G[2][0] +
                    F[0][1] * G[2][1];
  const double yy = F[1][2] * G[0][1] + 2 * (F[1][1] * G[0][2] + F[0][2] * G[1][1]) + F[1][0] * G[0][3] +
                    F[0][3] * G[1][0] + F[0][1] * G[1][2];
  return xx + 2 * xy + yy;
}

static double second_sum(const struct derivatives *f) { return f->d[2][0] + 2 * f->d[1][1] + f->d[0][2]; }
static double first_most(const struct derivatives *f) { return real_max(f->d[1][0], f->d[0][1]); }

static double row_size(const double m[2], double one, double two) { return fabs(m[0]) * one + fabs(m[1]) * two; }

/* The inverse of the map's Jacobian. Returns whether it has one. */
static bool invert(const double g[3], const double d[3], double m[2][2])
{
  const double whole = g[1] * d[2] - g[2] * d[1], inverse = 1 / whole;
  m[0][0] = d[2] * inverse, m[0][1] = -g[2] * inverse, m[1][0] = -d[1] * inverse, m[1][1] = g[1] * inverse;
  return fabs(whole) > 0;
}

/* Rounding in the coefficients of F and G, each off by `error`, changes the second derivatives of G on the larger box,
 * and so how far its row of the map's Jacobian turns, by this many errors: (24 + 2 36 + 24)/4 2^4. The row of D has
 * products. In these, first derivatives are off by 96 errors, second ones by 96, 144 and 96, third ones by 48 and 144.
 * They are multiplied by three times second_sum, by second_sum and by twice first_most: less than twice as much in all.
 * So rounding takes at most 2 FOLD_ROUNDING, and fold_find leaves it that much of FOLD_BEND. */
#define FOLD_ROUNDINGS 480
#define FOLD_ROUNDING 0x1p-6

/* Newton's method on the map ends at a step whose square is below rounding; otherwise it does not lead to a fold in the
 * box. */
#define FOLD_STEP 0x1p-27
enum { FOLD_STEPS = 8 };

/* How far from the middle a fold may be: up to BOX_MARGIN outside the box. */
#define FOLD_REACH (1 + 2 * BOX_MARGIN)

/* One step of it from `at`, for a map with rows g and d and inverse Jacobian m. Returns the step's length, or NaN if it
 * leads too far. */
static double step_on(const double g[3], const double d[3], double m[2][2], double at[2])
{
  const double x = m[0][0] * g[0] + m[0][1] * d[0], y = m[1][0] * g[0] + m[1][1] * d[0];
  at[0] -= x, at[1] -= y;
  return fabs(at[0]) <= 2 && fabs(at[1]) <= 2 ? real_max(fabs(x), fabs(y)) : NAN;
}

/* Takes the steps from the second on. */
static bool find(const struct fold_powers *f, const struct fold_powers *g, double step, double at[2])
{
  for (int n = 1; n < FOLD_STEPS && step > FOLD_STEP; n++) {
    struct derivatives here[2];
    double d[3], m[2][2];
    derive(f, at[0], at[1], &here[0]), derive(g, at[0], at[1], &here[1]);
    const double values[3] = {here[1].d[0][0], here[1].d[1][0], here[1].d[0][1]};
    determinant(&here[0], &here[1], d);
    if (!invert(values, d, m)) return false;
    step = step_on(values, d, m, at);
  }
  return step <= FOLD_STEP && fabs(at[0]) <= FOLD_REACH && fabs(at[1]) <= FOLD_REACH;
}

void fold_combine(struct box *box, struct fold_pair *out)
{
  struct fold_powers a, b;
  powers_of(box->net[0], &a), powers_of(box->net[1], &b);
  const bool by_y = fabs(b.c[0][1]) + fabs(a.c[0][1]) > fabs(b.c[1][0]) + fabs(a.c[1][0]);
  const double p = by_y ? b.c[0][1] : b.c[1][0], q = by_y ? -a.c[0][1] : -a.c[1][0], length = sqrt(p * p + q * q);
  out->any = length > 0;
  if (!out->any) return;
  double(*row)[2] = out->row;
  row[0][0] = row[1][1] = p / length, row[0][1] = q / length, row[1][0] = -row[0][1];
  combine(&a, &b, row[0][0], row[0][1], &out->f), combine(&a, &b, row[1][0], row[1][1], &out->g);
}

/* Roundings, of the largest coefficient of a and b, in the powers of F and G and what is made of them: 8 in each of the
 * powers, which sum up to 25, 3 in the combination, 2 in the straighter G, 6 in F - m G, 25 in a sum of all. */
#define BENT_ROUNDINGS 2048

static double squares(double x, double y, double z) { return x * x + y * y + z * z; }

/* Straightens G, because where G bends it brings terms of the third degree into F - m G. G + share F has the least sum
 * of two squares: its second derivatives in the middle, relative to G's, and share times F's first ones, relative to
 * G's, of which they are then at most half. Returns share. */
static double straighten(const struct fold_powers *f, const struct fold_powers *g, struct fold_powers *out)
{
  const double(*F)[4] = f->c, (*G)[4] = g->c;
  const double first_f = squares(F[1][0], F[0][1], 0), second_f = squares(F[2][0], F[1][1], F[0][2]);
  const double first_g = squares(G[1][0], G[0][1], 0), second_g = squares(G[2][0], G[1][1], G[0][2]);
  const double both = F[2][0] * G[2][0] + F[1][1] * G[1][1] + F[0][2] * G[0][2];
  const double whole = second_f + first_f * second_g / first_g, share = whole > 0 ? -both / whole : 0;
  combine(g, f, 1, share, out);
  return share;
}

/* The polynomial m, of degree 1, for which F - m G has the least first and second derivatives in the middle: only those
 * along G = 0 remain. */
static void bent_factor(const struct fold_powers *f, const struct fold_powers *g, double m[3])
{
  const double(*F)[4] = f->c, (*G)[4] = g->c;
  const double x = G[1][0], y = G[0][1], square = x * x + y * y, start = (F[1][0] * x + F[0][1] * y) / square;
  const double xx = F[2][0] - start * G[2][0], xy = F[1][1] - start * G[1][1], yy = F[0][2] - start * G[0][2];
  const double across = (xx * x * x + xy * x * y + yy * y * y) / square;
  const double twist = (2 * (yy - xx) * x * y + xy * (x * x - y * y)) / square;
  m[1] = (across * x - twist * y) / square, m[2] = (across * y + twist * x) / square;
  m[0] = start - G[0][0] * (m[1] * x + m[2] * y) / square;
}

enum fold_bent fold_bent_test(const struct fold_pair *pair, struct box *box, const double error[2])
{
  struct fold_powers straight;
  const double(*f)[4] = pair->f.c, (*g)[4] = straight.c;
  double m[3], largest = 0, sum = 0, wider_f[5][5] = {{0}}, wider_g[6][6] = {{0}};
  if (!pair->any) return BENT_OPEN;
  const double share = straighten(&pair->f, &pair->g, &straight);
  bent_factor(&pair->f, &straight, m);
  for (int n = 0; n < 16; n++) {
    wider_f[n / 4][n % 4] = f[n / 4][n % 4], wider_g[1 + n / 4][1 + n % 4] = g[n / 4][n % 4];
    largest = real_max(largest, real_max(fabs(box->net[0][n / 4][n % 4]), fabs(box->net[1][n / 4][n % 4])));
  }
  for (int i = 0; i < 5; i++)
    for (int j = 0; j < 5; j++)
      sum += fabs(wider_f[i][j] - m[0] * wider_g[i + 1][j + 1] - m[1] * wider_g[i][j + 1] - m[2] * wider_g[i + 1][j]);
  const double middle = fabs(f[0][0] - m[0] * g[0][0]),
               most = 1 + (1 + fabs(share)) * (fabs(m[0]) + fabs(m[1]) + fabs(m[2]));
  const double off = most * (error[0] + error[1] + BENT_ROUNDINGS * UNIT_ROUNDOFF * largest);
  return 2 * middle > sum + off ? BENT_APART : sum <= FLAT_ERRORS * off ? BENT_FLAT : BENT_OPEN;
}

bool fold_find(const struct fold_pair *pair, const double error[2], struct fold *out)
{
  const struct fold_powers *f = &pair->f, *g = &pair->g;
  if (!pair->any) return false;
  const double p = pair->row[0][0], q = pair->row[0][1];
  struct derivatives most[2], here[2];
  double d[3];
  derive_middle(f, &here[0]), derive_middle(g, &here[1]);
  const double middle[3] = {here[1].d[0][0], here[1].d[1][0], here[1].d[0][1]};
  determinant(&here[0], &here[1], d);
  out->at[0] = out->at[1] = 0;
  if (!invert(middle, d, out->m)) return false;
  const double step = step_on(middle, d, out->m, out->at);
  if (!(step >= 0)) return false;
  bound(f, &most[0]), bound(g, &most[1]);
  const double bend_d = determinant_bend(&most[0], &most[1]), bend_g = second_sum(&most[1]);
  const double off = FOLD_ROUNDINGS * (error[0] + error[1]);
  const double off_d = off * (first_most(&most[0]) + first_most(&most[1]) + second_sum(&most[0]) + bend_g);
  for (int k = 0; k < 2; k++) {
    if (!(row_size(out->m[k], bend_g, bend_d) <= FOLD_BEND - 2 * FOLD_ROUNDING)) return false;
    if (!(row_size(out->m[k], off, off_d) <= FOLD_ROUNDING)) return false;
  }
  if (!find(f, g, step, out->at)) return false;
  derive(f, out->at[0], out->at[1], &here[0]), derive(g, out->at[0], out->at[1], &here[1]);
  const double gx = here[1].d[1][0], gy = here[1].d[0][1];
  const double share = (here[0].d[1][0] * gx + here[0].d[0][1] * gy) / (gx * gx + gy * gy);
  determinant(&here[0], &here[1], d);
  out->row[0][0] = p + share * q, out->row[0][1] = q - share * p, out->row[1][0] = -q, out->row[1][1] = p;
  out->way[0] = -gy, out->way[1] = gx;
  out->second = gy * d[1] - gx * d[2];
  out->first = first_most(&most[0]) + first_most(&most[1]);
  out->bend = second_sum(&most[0]) + fabs(share) * bend_g;
  return fabs(out->second) > 0;
}

enum fold_verdict fold_weigh(struct fold *fold, const double h[3], const double g[3], double error)
{
  const double d = fabs(h[1] * g[2] - h[2] * g[1]) +
                   16 * (error + UNIT_ROUNDOFF * (fabs(h[1]) + fabs(h[2]))) * fold->first;
  /* Twice Newton's step on the map, with its errors: on the larger box M inverts the Jacobian to within 1/2. */
  const double off = 2 *
                     real_max(row_size(fold->m[0], fabs(g[0]) + error, d), row_size(fold->m[1], fabs(g[0]) + error, d));
  const double turned = fabs(h[1]) + fabs(h[2]) + 16 * error;
  const double least = 2 * (error + (turned + fold->bend * off) * off);
  const double largest = fabs(h[0]) > least ? fabs(h[0]) : 2 * least;
  fold->half = sqrt(2 * largest / fabs(fold->second)), fold->uncertain = off;
  return !(fabs(h[0]) > least) ? FOLD_OPEN : (h[0] > 0) == (fold->second > 0) ? FOLD_EMPTY : FOLD_ROOTS;
}

enum fold_verdict fold_weigh_box(struct fold *fold, struct box *box, const double error[2])
{
  const double u = 0.5 + 0.5 * fold->at[0], v = 0.5 + 0.5 * fold->at[1];
  const struct patch_jet a = patch_evaluate(box->net[0], u, v), b = patch_evaluate(box->net[1], u, v);
  double values[2][3], sum = 0;
  for (int k = 0; k < 2; k++) {
    const double p = fold->row[k][0], q = fold->row[k][1];
    values[k][0] = p * a.value + q * b.value;
    values[k][1] = (p * a.du + q * b.du) / 2, values[k][2] = (p * a.dv + q * b.dv) / 2;
    sum = real_max(sum, fabs(p) + fabs(q));
  }
  return fold_weigh(fold, values[0], values[1], sum * (error[0] + error[1] + 8 * UNIT_ROUNDOFF));
}
