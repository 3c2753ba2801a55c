/* Folds: if one is reported as the only one of its box, the box has the reported roots and no others. Tested on
 * cubics f(x) on the line y = 0, whose slope is 0 at two places: one is a fold, and as the other one approaches the
 * box, the fold is more and more bent. */
#include "intersect/exact/fold.h"

#include <math.h>

#include "base/real.h"
#include "cmocka_test.h"
#include "power_net.h"
#include "random.h"

enum { SEED = 20261127, CASES = 400000, BENT_CASES = 100000 };

/* f' = (x - r[0]) (x - r[1]) */
struct cubic {
  double r[2], low;
};

static double cubic_at(const struct cubic *f, double x)
{
  return f->low + x * (f->r[0] * f->r[1] + x * (-(f->r[0] + f->r[1]) / 2 + x / 3));
}

/* The number of roots between -most and most. */
static int roots_within(const struct cubic *f, double most)
{
  const double at[4] = {-most, fmin(fmax(fmin(f->r[0], f->r[1]), -most), most),
                        fmin(fmax(fmax(f->r[0], f->r[1]), -most), most), most};
  int roots = 0;
  for (int k = 0; k < 3; k++) roots += (cubic_at(f, at[k]) > 0) != (cubic_at(f, at[k + 1]) > 0);
  return roots;
}

/* A box with f as a, and y as b. */
static void box_make(const struct cubic *f, struct box *box)
{
  const double c1 = f->r[0] * f->r[1], c2 = -(f->r[0] + f->r[1]) / 2, c3 = 1.0 / 3;
  const double row[4] = {f->low - c1 + c2 - c3, f->low - c1 / 3 - c2 / 3 + c3, f->low + c1 / 3 - c2 / 3 - c3,
                         f->low + c1 + c2 + c3};
  *box = (struct box){.size_u = 1, .size_v = 1};
  for (int n = 0; n < 16; n++) box->net[0][n / 4][n % 4] = row[n / 4], box->net[1][n / 4][n % 4] = n % 4 / 1.5 - 1;
}

static void what_a_fold_tells_is_so(void **state)
{
  (void)state;
  struct random random = {SEED};
  const double error[2] = {64 * UNIT_ROUNDOFF, 64 * UNIT_ROUNDOFF};
  int verdicts[3] = {0}, wrong = 0;
  double most = 0; /* the largest bend of a box: the second derivative of D relative to its first one in the middle */
  for (int n = 0; n < CASES; n++) {
    const double far = random_bits(&random) % 2 ? 1 : 16, side = random_bits(&random) % 2 ? 1 : -1;
    struct cubic f = {{side * random_between(&random, 0, 1), side * random_between(&random, 0, far)}, 0};
    /* make f nearly 0 at a fold or at an end of the box */
    const double at[4] = {f.r[0], f.r[1], -1, 1}, off = pow(10, -random_between(&random, 1, 8));
    f.low = -cubic_at(&f, at[random_bits(&random) % 4]) + (random_bits(&random) % 2 ? off : -off);
    struct box box;
    struct fold_pair pair;
    struct fold fold;
    box_make(&f, &box);
    fold_combine(&box, &pair);
    if (!fold_find(&pair, error, &fold)) continue;
    const enum fold_verdict verdict = fold_weigh_box(&fold, &box, error);
    verdicts[verdict]++;
    most = fmax(most, 2 / fabs(f.r[0] + f.r[1]));
    if (verdict == FOLD_EMPTY) wrong += roots_within(&f, 1) != 0;
    if (verdict == FOLD_ROOTS) wrong += roots_within(&f, 1 + 2 * BOX_MARGIN) > 2;
  }
  print_message("%d empty, %d with two roots, %d open; bent by up to %.3g\n", verdicts[FOLD_EMPTY],
                verdicts[FOLD_ROOTS], verdicts[FOLD_OPEN], most);
  assert_int_equal(wrong, 0);
  assert_true(verdicts[FOLD_EMPTY] > CASES / 400 && verdicts[FOLD_ROOTS] > CASES / 100);
  assert_true(most > 0.25);
}

/* ---- bent combinations ---- */

/* a is the product of two lines; b is one of them, bent by a part of a; all of that line are roots. As long as both
 * nets are within their bounds, they may not be said to have no root. If they are off by more, they mostly are. */
static void what_a_bent_combination_tells_is_so(void **state)
{
  (void)state;
  struct random random = {SEED + 1};
  const double bound = 0x1p-30, error[2] = {bound, bound};
  int flat = 0, apart = 0, beyond = 0;
  for (int n = 0; n < BENT_CASES; n++) {
    const double turn = random_between(&random, 0, 7), middle = pow(10, -random_between(&random, 0, 8));
    const double line[3] = {middle * random_between(&random, -0.5, 0.5), cos(turn), sin(turn)};
    const double part = (random_bits(&random) % 2 ? 1 : -1) * pow(10, random_between(&random, -2, 3));
    const double slope = pow(10, random_between(&random, -3, 0));
    double product[4][4] = {{0}}, bent[4][4] = {{0}}, m[3];
    /* whether the other line is parallel to this one, so that a is extremal in the middle */
    const bool along = random_bits(&random) % 2;
    for (int k = 0; k < 3; k++)
      m[k] = slope * (along ? (k > 0 ? line[k] : -line[k]) : random_between(&random, -1, 1) * (k > 0 ? 1 : middle));
    product[0][0] = m[0] * line[0], product[1][0] = m[0] * line[1] + m[1] * line[0];
    product[0][1] = m[0] * line[2] + m[2] * line[0], product[1][1] = m[1] * line[2] + m[2] * line[1];
    product[2][0] = m[1] * line[1], product[0][2] = m[2] * line[2];
    for (int k = 0; k < 16; k++) bent[k / 4][k % 4] = part * product[k / 4][k % 4];
    bent[0][0] += line[0], bent[1][0] += line[1], bent[0][1] += line[2];
    const bool within = random_bits(&random) % 2;
    const double off = bound * (within ? 1 : random_between(&random, 30, 300));
    product[0][0] += random_bits(&random) % 2 ? off : -off, bent[0][0] += random_bits(&random) % 2 ? off : -off;
    struct box box = {.size_u = 1, .size_v = 1};
    struct fold_pair pair;
    power_net(product, box.net[0]), power_net(bent, box.net[1]);
    fold_combine(&box, &pair);
    const enum fold_bent told = fold_bent_test(&pair, &box, error);
    if (within) assert_true(told != BENT_APART), flat += told == BENT_FLAT;
    else beyond++, apart += told == BENT_APART;
  }
  print_message("%d of %d told to be flat, %d of %d to have no root\n", flat, BENT_CASES - beyond, apart, beyond);
  assert_true(flat > BENT_CASES / 8 && apart > BENT_CASES / 8);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_a_fold_tells_is_so),
                                     cmocka_unit_test(what_a_bent_combination_tells_is_so)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
