/* How finely patches are cut if `split` is auto. */
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "intersect/model.h"
#include "random.h"

enum { SEED = 20261122 };

/* z of a net over the unit square. */
typedef double height(struct random *random, int i, int j);

static double flat(struct random *random, int i, int j)
{
  (void)random;
  return 0.1 * i + 0.2 * j;
}

static double bowl(struct random *random, int i, int j)
{
  (void)random;
  return 0.05 * ((i == 1 || i == 2) + (j == 1 || j == 2));
}

/* A peak that affects only the leaves near one corner. */
static double peak(struct random *random, int i, int j)
{
  (void)random;
  return i == 3 && j == 3 ? 20 : 0;
}

/* Leaves of a quarter of its side turn by less than a quarter; those of half its side by a little more. */
static double cup(struct random *random, int i, int j)
{
  (void)random;
  return 0.11 * ((i == 1 || i == 2) + (j == 1 || j == 2));
}

/* Leaves of an eighth of its side turn by less than a quarter, of a quarter by less than 0.42, of half by less than
 * 0.84. */
static double deep_cup(struct random *random, int i, int j) { return 4 * cup(random, i, j); }

/* Bent along u only. */
static double page(struct random *random, int i, int j)
{
  (void)random, (void)j;
  return 0.05 * (i == 1 || i == 2);
}

/* A third of a pipe. */
static double gutter(struct random *random, int i, int j) { return 6 * page(random, i, j); }

/* Bent along v only, by half of what the patch is wide, so that boxes along it are not mostly air. */
static double arch(struct random *random, int i, int j)
{
  (void)random, (void)i;
  return 0.5 * (j == 1 || j == 2);
}

/* The width, relative to the length, of a patch that is a point at u = 0; 0: it is none. */
static double pointed;

static double cone(struct random *random, int i, int j)
{
  (void)random;
  return i / 3.0 * 0.5 * pointed * (j == 1 || j == 2);
}

/* Whether patches lie aslant to all axes: what goes along y goes along all of them. */
static bool aslant;

/* How the first and the middle one of `count` patches are cut. All have this height and length, and follow each other
 * by `apart` along x and z. If z is NULL, their points are random in a cube. */
static void cut_of(height *z, double length, size_t count, const double apart[2], int split[2], int middle[2])
{
  struct random random = {SEED};
  struct scene scene = {.patch_count = count, .solver_count = 1};
  struct method method;
  struct model *model;
  method_default(solver_at(0), &method);
  scene.solvers = &method, scene.patches = calloc(count, sizeof *scene.patches);
  assert_non_null(scene.patches);
  for (size_t p = 0; p < count; p++) {
    for (int n = 0; n < 16; n++) {
      double *x = scene.patches[p].P[n / 4][n % 4];
      x[0] = z ? n / 4 / 3.0 + apart[0] * (double)p : random_between(&random, -1, 1);
      x[1] = z ? length * (n % 4 / 3.0 - 0.5) * (pointed > 0 ? pointed * (n / 4 / 3.0) : 1)
               : random_between(&random, -1, 1);
      x[2] = z ? z(&random, n / 4, n % 4) + apart[1] * (double)p : random_between(&random, -1, 1);
      if (aslant) x[0] += x[1], x[2] += x[1];
    }
  }
  assert_int_equal(model_create(&scene, NULL, &model), STATUS_OK);
  for (int side = 0; side < 2; side++)
    split[side] = model->cuts[0].split[side], middle[side] = model->cuts[count / 2].split[side];
  assert_non_null(model->leaves);
  model_destroy(model);
  free(scene.patches);
}

/* The cut of patches that are all cut alike, and in both directions. */
static int split_of_apart(height *z, size_t count, const double apart[2])
{
  int split[2], middle[2];
  cut_of(z, 1, count, apart, split, middle);
  assert_int_equal(split[1], split[0]);
  assert_memory_equal(middle, split, sizeof split);
  return split[0];
}

static int split_of(height *z, size_t count) { return split_of_apart(z, count, (double[2]){2, 0}); }

TEST(patches_are_cut_as_far_as_they_bend)
{
  assert_int_equal(split_of(flat, 1), 1);
  const int few = split_of(bowl, 1);
  assert_true(few > 1 && few < 16);
  assert_int_equal(split_of(peak, 1), 16);
  assert_int_equal(split_of(NULL, 1), 32);
}

/* Leaves cost memory: at most half a million are made. */
TEST(many_patches_are_cut_less)
{
  enum { MANY = 20000 };
  assert_int_equal(split_of(NULL, MANY), 4);
  assert_int_equal(split_of(NULL, 2 * MANY), 2);
}

/* Patches side by side are small in any picture. Of patches in a stack no more leaves are seen than of one patch,
 * unless they are so near that their leaves lie in one another's boxes. */
TEST(patches_side_by_side_are_cut_less)
{
  enum { MANY = 3000 };
  const int one = split_of(cup, 1);
  print_message("%d; %d, %d\n", one, split_of(cup, MANY), split_of_apart(cup, MANY, (double[2]){0, 0.1}));
  assert_true(one * one * MANY > 1 << 15);
  assert_int_equal(split_of(cup, MANY), one / 2);
  assert_int_equal(split_of_apart(cup, MANY, (double[2]){0, 0.1}), one);
  assert_int_equal(split_of(deep_cup, 1), 8);
  assert_int_equal(split_of(deep_cup, MANY), 4);
  assert_int_equal(split_of(deep_cup, 10000), 2);
}

/* Sheets in a stack overlap one another's boxes. They are cut finer along the parameter that bends, as far as the
 * number of leaves allows. */
TEST(sheets_in_a_stack_are_cut_finer)
{
  enum { SHEETS = 100, MANY = 20000 };
  int one[2], split[2], middle[2];
  cut_of(page, 1, 1, (double[2]){0, 0}, one, middle);
  cut_of(page, 1, SHEETS, (double[2]){0, 0.1}, split, middle);
  assert_memory_equal(split, one, sizeof one);
  assert_memory_equal(middle, one, sizeof one);
  cut_of(page, 1, SHEETS, (double[2]){0, 1e-3}, split, middle);
  print_message("%d x %d, in a stack %d x %d\n", one[0], one[1], middle[0], middle[1]);
  assert_in_range(middle[0], 4 * one[0], 16 * one[0]);
  assert_int_equal(middle[1], one[1]);
  cut_of(page, 1, MANY, (double[2]){0, 1e-6}, split, middle);
  assert_in_range(middle[0] * middle[1], 2, (1 << 19) / MANY);
}

/* A patch that bends across its long side is cut along it, however long it is; a flat one is not. */
TEST(rods_are_cut_across)
{
  static const double lengths[] = {6, 15, 30, 1000, 1e5};
  for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
    int split[2], middle[2];
    cut_of(gutter, lengths[k], 1, (double[2]){0, 0}, split, middle);
    print_message("%g long: %d x %d\n", lengths[k], split[0], split[1]);
    assert_in_range(split[0], 2, 4);
    assert_in_range(split[1], 2, 4);
    cut_of(flat, lengths[k], 1, (double[2]){0, 0}, split, middle);
    assert_int_equal(split[0], 1);
    assert_int_equal(split[1], 1);
  }
}

/* A ribbon that bends along its length is cut along it only, and as far however long it is. */
TEST(ribbons_are_cut_along)
{
  static const double lengths[] = {1e3, 1e5, 1e7, 1e9};
  int first[2];
  for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
    int split[2], middle[2];
    cut_of(arch, lengths[k], 1, (double[2]){0, 0}, split, middle);
    print_message("%g long: %d x %d\n", lengths[k], split[0], split[1]);
    if (k == 0) memcpy(first, split, sizeof first);
    assert_int_equal(split[0], 1);
    assert_in_range(split[1], 2, 64);
    assert_int_equal(split[1], first[1]);
  }
}

/* The boxes of a long patch aslant to the axes are mostly air. So it is cut along its long side, until its leaves are
 * about as long as wide, or are 64; but not into more than a quarter of a million leaves in all. */
TEST(long_patches_aslant_are_cut_along)
{
  enum { MANY = 20000 };
  static const double lengths[] = {6, 15, 30, 1000, 1e5};
  height *const heights[] = {flat, gutter};
  for (size_t k = 0; k < 2 * sizeof lengths / sizeof lengths[0]; k++) {
    const double length = lengths[k / 2];
    int straight[2], split[2], many[2], middle[2];
    cut_of(heights[k % 2], length, 1, (double[2]){0, 0}, straight, middle);
    aslant = true;
    cut_of(heights[k % 2], length, 1, (double[2]){0, 0}, split, middle);
    cut_of(heights[k % 2], length, MANY, (double[2]){0, 0}, many, middle);
    aslant = false;
    print_message("%g long: %d x %d, %d x %d of many\n", length, split[0], split[1], many[0], many[1]);
    assert_int_equal(split[0], straight[0]);
    assert_in_range(split[1], length < 100 ? (int)(length / 4) : 64, length < 100 ? (int)(2 * length) : 64);
    assert_in_range(many[0] * many[1], 2, (1 << 18) / MANY);
  }
}

/* A cone's side is cut on the way to its pole, although it is straight along it. */
TEST(cones_are_cut_before_poles)
{
  static const double widths[] = {0.5, 0.2, 0.1, 0.02};
  for (size_t k = 0; k < sizeof widths / sizeof widths[0]; k++) {
    int split[2], middle[2];
    pointed = widths[k];
    cut_of(cone, 1, 1, (double[2]){0, 0}, split, middle);
    print_message("%g wide: %d x %d\n", pointed, split[0], split[1]);
    assert_in_range(split[0], 4, 16);
  }
  pointed = 0;
}
