/* The hit at a root: its bounds are those of hits that the lanes find, its t is in the ray's range, and it has a normal. */
#include <math.h>
#include <stdlib.h>

#include "cmocka_test.h"
#include "intersect/exact/exact.h"
#include "intersect/local_ray.h"

/* SMALL and LARGE share a border; THIN and SLANTED are nearly curves, POLE is so, too, and far away. */
enum { SMALL, LARGE, THIN, POLE, POINT, SLANTED, PATCHES };

static struct scene_patch patches[PATCHES];
static struct method solver;
static struct scene scene = {.patches = patches, .patch_count = PATCHES, .solvers = &solver, .solver_count = 1};
static struct model *model;
static const struct ray ray = {{96, 100, 8}, {0.5, 1, -2}, 1, 3};

static int set_up(void **state __attribute__((unused)))
{
  for (int n = 0; n < 16; n++) {
    const double i = n / 4, j = n % 4, bend = n / 4 == 1 ? 0.25 : 0, rise = n % 4 == 2 ? 8 : 0;
    const double P[PATCHES][3] = {{97 + i, 100 + 2 * j, bend},
                                  {292 - 64 * j, 100 + 2 * i, rise},
                                  {j, i * 0x1p-60, 0},
                                  {0x1p20 + i, i * j * 0x1p-35, 0},
                                  {7, 7, 7},
                                  {i + j, 0.75 * (i + j) + i * 0x1p-22, 0.625 * (i + j)}};
    for (int p = 0; p < PATCHES; p++)
      for (int c = 0; c < 3; c++) patches[p].P[n / 4][n % 4][c] = P[p][c];
  }
  method_default(solver_at(0), &solver);
  solver.split = 1; /* one leaf, whose derivatives are those of the patch */
  return model_create(&scene, NULL, &model) == STATUS_OK ? 0 : -1;
}

static int tear_down(void **state __attribute__((unused)))
{
  model_destroy(model);
  return 0;
}

static struct hit hit_at(uint32_t patch, double u, double v, double t, double radius_u, double radius_v)
{
  const struct exact_root root = {.patch = patch, .u = u, .v = v, .t = t, .radius_u = radius_u, .radius_v = radius_v};
  struct hit hit;
  exact_hit(model, &ray, &root, true, &hit);
  return hit;
}

TEST_WITH(bounds_are_those_of_the_lanes, set_up, tear_down)
{
  struct intersector *intersector;
  struct tracer *tracer;
  assert_int_equal(intersector_create(&scene, &intersector), STATUS_OK);
  assert_int_equal(tracer_create(intersector, &tracer), STATUS_OK);
  for (int n = 0; n < 8; n++) {
    const struct ray down = {{n < 4 ? 96.5 + 0.5 * n : 30.0 * n, 101.25 + 0.5 * n, 8}, {0.125, 0, -1}, 0, INFINITY};
    struct hit lanes;
    tracer_closest(tracer, 1, &down, &lanes);
    assert_int_equal(lanes.patch, n < 4 ? SMALL : LARGE);
    const struct hit hit = hit_at(lanes.patch, lanes.u, lanes.v, 2, 0, 0);
    for (int c = 0; c < 3; c++) assert_true(fabs(hit.normal[c] - lanes.normal[c]) < 0x1p-45);
    assert_true(fabs(hit.point_error / lanes.point_error - 1) < 0x1p-40);
    assert_true(fabs(hit.clearance / lanes.clearance - 1) < 0x1p-40);
  }
  tracer_destroy(tracer);
  intersector_destroy(intersector);
}

TEST_WITH(clearance_on_a_border_is_that_of_the_larger_patch, set_up, tear_down)
{
  const double inside = hit_at(SMALL, 0.5, 0.5, 2, 0, 0).clearance, beside = hit_at(LARGE, 0.5, 0.5, 2, 0, 0).clearance;
  assert_true(hit_at(SMALL, 1, 0.5, 2, 0, 0).clearance > 0.5 * beside && inside < 0.25 * beside);
  assert_true(hit_at(SMALL, 1 - 0x1p-40, 0.5, 2, 0x1p-40, 0).clearance > 0.5 * beside);
  model->cuts[LARGE].loose = 1;
  assert_true(hit_at(SMALL, 1, 0.5, 2, 0, 0).clearance > 20 && hit_at(LARGE, 0.5, 1, 2, 0, 0).clearance > 20);
  assert_true(hit_at(SMALL, 0.5, 0.5, 2, 0, 0).clearance < 1);
  model->cuts[LARGE].loose = 0, model->cuts[SMALL].loose = 1;
  assert_true(hit_at(LARGE, 0.5, 1, 2, 0, 0).clearance > 20 && hit_at(LARGE, 0.5, 0.5, 2, 0, 0).clearance < 20);
}

TEST_WITH(a_hit_is_in_the_patch_and_in_the_range, set_up, tear_down)
{
  struct ray none = ray;
  struct exact_root root = {.t = 2};
  struct hit hit = hit_at(SMALL, -0x1p-60, 1.5, 1, 0, 0);
  assert_true(hit.u == 0 && hit.v == 1 && hit.t == nextafter(1, 2));
  assert_true(hit_at(SMALL, 0, 0, 3, 0, 0).t == nextafter(3, 2) && hit_at(SMALL, 0, 0, 2, 0, 0).t == 2);
  none.t_min = nextafter(3, 2); /* no double is in the range */
  exact_hit(model, &none, &root, true, &hit);
  assert_true(hit.t == 3);
  root.t = 4, exact_hit(model, &none, &root, true, &hit);
  assert_true(hit.t == 3 && hit.certainty == CERTAINTY_CERTAIN);
  assert_int_equal(hit_at(SMALL, 0.5, 0.5, 2, 0x1p-10, 0).certainty, CERTAINTY_GRAZING); /* its place is not known */
  assert_int_equal(hit_at(SMALL, 0.5, 0.5, 2, 0, 0x1p-10).certainty, CERTAINTY_GRAZING);
}

TEST_WITH(a_hit_has_a_normal, set_up, tear_down)
{
  const double length = sqrt(5.25);
  wide w[4], dw[3];
  wide_cubic(0.25, w, dw);
  assert_true(64 * w[1] == 27 && 64 * w[2] == 9 && 16 * dw[1] == 18 && 16 * dw[2] == 3);
  for (int p = THIN; p <= POLE; p++) assert_true(hit_at((uint32_t)p, 0, 0.5, 2, 0, 0).normal[2] == 1);
  const struct hit slanted = hit_at(SLANTED, 0.3, 0.6, 2, 0, 0); /* rounding the derivatives moves it by 2^-30 */
  assert_true(fabs(slanted.normal[0] / slanted.normal[2] + 0.625) < 0x1p-45 && fabs(slanted.normal[1]) < 0x1p-45);
  const struct hit front = hit_at(POINT, 0.5, 0.5, 2, 0, 0);
  for (int c = 0; c < 3; c++) assert_true(fabs(front.normal[c] + ray.direction[c] / length) < 0x1p-50);
}
