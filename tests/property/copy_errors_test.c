/* Hits at the borders of copies that share leaves. Only two errors matter there: how far the copies' control points
 * are from the object's, and how far rays in its coordinates are from where they should be. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "intersect/model.h"
#include "property/world.h"

/* Copies of one patch, apart from one another, and enough of them to share leaves. */
enum { SEED = 20261126, COPIES = 1100, ASKED = 8, RAYS = 1024 };

/* Copies share leaves only if no control point is farther off than this part of the object (copies.c). */
#define MOST_OFF 0x1p-30

/* All copies, which share leaves, and the first few alone, which do not. */
struct sharing {
  world_net nets[WORLD_MAX]; /* the first is the object's */
  struct method solver;
  struct scene_object object;
  struct scene_copy copies[COPIES];
  struct scene_patch patches[COPIES];
  struct scene scene[2];
  struct intersector *intersector[2];
  struct tracer *tracer[2];
};

/* sizes: along the axes, powers of two, so that maps are exact. off: how far, at most, control points are from where
 * the map puts them. One control point of the last copy is so far off that this copy does not share. */
static void sharing_open(struct sharing *sharing, struct random *random, const double sizes[3], double off)
{
  memset(sharing, 0, sizeof *sharing);
  world_fill(WORLD_GRID, random, sharing->nets);
  method_default(solver_at(0), &sharing->solver);
  sharing->object = (struct scene_object){sharing->nets, 1};
  for (size_t c = 0; c < COPIES; c++) {
    struct scene_copy *copy = &sharing->copies[c];
    copy->first_patch = c, copy->b[2] = 4 * (double)c;
    for (int k = 0; k < 3; k++) copy->A[k][k] = sizes[k];
    for (int n = 0; n < 48; n++) {
      double *x = &sharing->patches[c].P[n / 12][n / 3 % 4][n % 3];
      *x = copy->b[n % 3] + sizes[n % 3] * sharing->nets[0][n / 12][n / 3 % 4][n % 3];
      if (n % 3 == 0) *x += random_between(random, -off, off);
    }
  }
  sharing->patches[COPIES - 1].P[0][0][0] += 0x1p-20;
  for (int k = 0; k < 2; k++) {
    struct scene *scene = &sharing->scene[k];
    scene->solvers = &sharing->solver, scene->solver_count = 1;
    scene->objects = &sharing->object, scene->object_count = 1;
    scene->copies = sharing->copies, scene->copy_count = k == 0 ? COPIES : 0;
    scene->patches = sharing->patches, scene->patch_count = k == 0 ? COPIES : ASKED;
    assert_int_equal(intersector_create(scene, &sharing->intersector[k]), STATUS_OK);
    assert_int_equal(tracer_create(sharing->intersector[k], &sharing->tracer[k]), STATUS_OK);
  }
  const struct model *model = sharing->tracer[0]->model;
  assert_int_equal(model->copy_count, COPIES - 1);
  assert_true(model->objects[0].error <= MOST_OFF);
}

static void sharing_close(struct sharing *sharing)
{
  for (int k = 0; k < 2; k++) tracer_destroy(sharing->tracer[k]), intersector_destroy(sharing->intersector[k]);
}

/* A point of a border, up to roundings. */
static void border_point(struct random *random, world_net net, double point[3])
{
  const double x = random_unit(random), y = 1 - x, b[4] = {y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x};
  const int across = (int)(random_bits(random) % 2), edge = random_bits(random) % 2 ? 3 : 0;
  for (int k = 0; k < 3; k++) {
    point[k] = 0;
    for (int n = 0; n < 4; n++) point[k] += b[n] * (across ? net[n][edge][k] : net[edge][n][k]);
  }
}

/* Rays that pass a border at that distance, or at a far smaller one, have the hits that they have without sharing. */
static void pass_borders(struct sharing *sharing, struct random *random, double near)
{
  int wrong = 0, certain[2] = {0};
  for (int n = 0; n < RAYS; n++) {
    struct ray ray = {.t_max = 1}; /* before the next copy */
    struct hit hits[2];
    double point[3];
    const double by = near * pow(2, random_between(random, -16, 0));
    border_point(random, sharing->patches[n % ASKED].P, point);
    for (int k = 0; k < 3; k++) {
      ray.direction[k] = random_between(random, -1, 1);
      ray.origin[k] = point[k] - ray.direction[k] / 2 + random_between(random, -by, by);
    }
    for (int k = 0; k < 2; k++) {
      tracer_closest(sharing->tracer[k], 1, &ray, &hits[k]);
      certain[k] += hits[k].certainty == CERTAINTY_CERTAIN;
    }
    if (!hits_agree(&ray, &hits[0], &hits[1]) && wrong++ < 3)
      world_print_case("border", WORLD_GRID, &ray, &hits[0], &hits[1]);
  }
  print_message("%d rays, certain %d, by themselves %d, wrong %d\n", RAYS, certain[0], certain[1], wrong);
  assert_int_equal(wrong, 0);
  assert_true(certain[0] > RAYS - RAYS / 100 && certain[1] > RAYS - RAYS / 100);
}

/* The control points are off by as much as copies may be that share. */
TEST(copies_are_met_where_they_are)
{
  static struct sharing sharing;
  struct random random = {SEED};
  sharing_open(&sharing, &random, (double[3]){1, 1, 1}, MOST_OFF / 8);
  pass_borders(&sharing, &random, MOST_OFF / 4);
  sharing_close(&sharing);
}

/* Here only the start of a ray is off. In the object's coordinates it is as far from the object as the copy is long,
 * times how much wider the object is. */
TEST(slender_copies_are_met_up_to_their_borders)
{
  static struct sharing sharing;
  static const double sizes[][3] = {{1, 0x1p-17, 0x1p-17}, {0x1p-17, 0x1p-17, 1}};
  struct random random = {SEED + 1};
  for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++) {
    sharing_open(&sharing, &random, sizes[n], 0);
    pass_borders(&sharing, &random, 0);
    sharing_close(&sharing);
  }
}

int main(void)
{
  print_message("seed %d\n", SEED);
  return test_run();
}
