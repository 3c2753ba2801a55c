/* How finely patches are cut if `split` is auto. */
#include <stdlib.h>

#include "cmocka_test.h"
#include "intersect/model.h"
#include "random.h"

enum { SEED = 20261122 };

/* z of a net over the unit square. */
typedef double height(int i, int j);

static double flat(int i, int j) { return 0.1 * i + 0.2 * j; }

/* Bent along u only, a little, and by a third of a pipe. */
static double page(int i, int j) { return (void)j, 0.05 * (i == 1 || i == 2); }
static double gutter(int i, int j) { return 6 * page(i, j); }

static double bowl(int i, int j) { return page(i, j) + page(j, i); }
static double cup(int i, int j) { return 8 * bowl(i, j); }

/* Bent along v only. */
static double arch(int i, int j) { return 10 * page(j, i); }

struct kind {
  height *z; /* NULL: sixteen random points */
  double length;
  bool aslant;     /* to all axes: what goes along y goes along all of them */
  size_t count;    /* of such patches */
  double apart[2]; /* they follow each other by this along x and z */
};

struct cut {
  int split[2];
};

/* The cut of the patch in the middle; together they have at most half a million leaves. */
static struct cut cut_of(struct kind kind)
{
  struct random random = {SEED};
  struct scene scene = {.patch_count = kind.count, .solver_count = 1};
  struct method method;
  struct model *model;
  method_default(solver_at(0), &method);
  scene.solvers = &method, scene.patches = calloc(kind.count, sizeof *scene.patches);
  assert_non_null(scene.patches);
  for (size_t p = 0; p < kind.count; p++) {
    for (int n = 0; n < 16; n++) {
      double *x = scene.patches[p].P[n / 4][n % 4];
      x[0] = kind.z ? n / 4 / 3.0 + kind.apart[0] * (double)p : random_between(&random, -1, 1);
      x[1] = kind.z ? kind.length * (n % 4 / 3.0 - 0.5) : random_between(&random, -1, 1);
      x[2] = kind.z ? kind.z(n / 4, n % 4) + kind.apart[1] * (double)p : random_between(&random, -1, 1);
      if (kind.aslant) x[0] += x[1], x[2] += x[1];
    }
  }
  assert_int_equal(model_create(&scene, NULL, &model), STATUS_OK);
  assert_non_null(model->leaves);
  assert_true(model->leaf_count <= 1 << 19);
  const uint16_t *split = model->cuts[kind.count / 2].split;
  const struct cut cut = {{split[0], split[1]}};
  print_message("%zu, %g long: %d x %d\n", kind.count, kind.length, cut.split[0], cut.split[1]);
  model_destroy(model);
  free(scene.patches);
  return cut;
}

static int leaves_of(struct kind kind)
{
  const struct cut cut = cut_of(kind);
  return cut.split[0] * cut.split[1];
}

TEST(patches_are_cut_as_far_as_they_bend)
{
  const int few = leaves_of((struct kind){bowl, 1, .count = 1}), more = leaves_of((struct kind){cup, 1, .count = 1});
  assert_int_equal(leaves_of((struct kind){flat, 1, .count = 1}), 1);
  assert_in_range(few, 2, 64);
  assert_in_range(more, 2 * few, 1024);
  assert_in_range(leaves_of((struct kind){.count = 1}), 256, 1024);
  const struct cut along = cut_of((struct kind){arch, 1, .count = 1});
  assert_int_equal(along.split[0], 1);
  assert_in_range(along.split[1], 4, 64);
}

/* Few rays meet each of many patches, and leaves cost memory. */
TEST(many_patches_are_cut_less)
{
  const int one = leaves_of((struct kind){cup, 1, .count = 1});
  assert_in_range(leaves_of((struct kind){cup, 1, .count = 3000, .apart = {2, 0}}), 2, one / 2);
  assert_in_range(leaves_of((struct kind){.count = 20000}), 4, 16);
}

/* Sheets in a stack overlap one another's boxes. They are cut finer along the parameter that bends. */
TEST(sheets_in_a_stack_are_cut_finer)
{
  const struct cut apart = cut_of((struct kind){page, 1, .count = 100, .apart = {2, 0}});
  const struct cut stack = cut_of((struct kind){page, 1, .count = 100, .apart = {0, 1e-3}});
  assert_in_range(stack.split[0], 4 * apart.split[0], 64);
  assert_int_equal(stack.split[1], apart.split[1]);
}

/* A patch that bends across its long side is cut across it; a flat one along the axes is not cut. */
TEST(rods_are_cut_across)
{
  static const double lengths[] = {6, 30, 1000, 1e5, 1e9};
  for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
    assert_in_range(cut_of((struct kind){gutter, lengths[k], .count = 1}).split[0], 2, 64);
    assert_int_equal(leaves_of((struct kind){flat, lengths[k], .count = 1}), 1);
  }
}

/* The boxes of a long patch aslant to the axes are mostly air. */
TEST(long_patches_aslant_are_cut_along)
{
  static const double lengths[] = {15, 1000, 1e5, 1e9};
  for (size_t k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
    const struct cut cut = cut_of((struct kind){flat, lengths[k], .aslant = true, .count = 1});
    assert_int_equal(cut.split[0], 1);
    assert_in_range(cut.split[1], 8, 64);
  }
}
