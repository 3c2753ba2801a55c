/* Proves that the default solver is right where methods fail: the situations of situations.h, judged by the reference.
 *
 * In every class no proven hit may be lost, none invented, and T, U, V must be within their floors. In classes whose
 * rays are degenerate by design (a curve in common, a collapsed edge met exactly) the reference leaves many rays
 * undecided. There the answer must not pass a proven hit, nor come before the first possible one. Every hit has a
 * normal where its surface has one, at a collapsed pole too. */
#include <math.h>
#include <stdio.h>

#include "accuracy/class_tests.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"
#include "worse.h"

enum { FULL_RAYS = 50000, LEAST_RAYS = 64, FULL_POLES = 10000 };

static void ask(const char *name, const struct situation *s, size_t most, void *tally)
{
  (void)name;
  struct trial trial;
  trial_create(&trial, (const double(*)[4][4][3])s->P, s->count, NULL);
  trial_rays(&trial, s->rays, most, tally);
  trial_destroy(&trial);
}

static void test_class(void **state)
{
  const struct situation_class *class = *state;
  struct tally tally = {.name = class->name};
  if (!class_wanted(class)) return;
  class_ask_rays(class, FULL_RAYS, LEAST_RAYS, effort_seed(class->seed), ask, &tally);
  tally_assert(&tally);
}

/* The allowed error of the limit normal at a collapsed pole. Directions of control points are rounded when a model is
 * placed at up to POLE_SHIFT times its size. So the error is some times 2^-53 POLE_SHIFT over the distance of the
 * points next to the pole. */
#define POLE_SHIFT 10
#define POLE_NORMAL (64 * POLE_SHIFT * DOUBLE_UNIT)

/* A pole met exactly is left to subdivision, which ends at boxes of some 1e-13. The normal turns by at most POLE_TURN u
 * on the way from the pole: 3 |P1 - P0| = 1.66 over the radius 1. */
#define POLE_PARAMETER 0x1p-40
#define POLE_TURN 2

/* Rays from inside exactly at the poles of placed balls and at the apex of placed domes. The answer may be any of the
 * patches that meet there; the normal is the axis, facing the origin. */
static void test_poles(void **state)
{
  (void)state;
  static const double scales[] = {1, 1e6, 1e-6};
  size_t wanted = effort_count(FULL_POLES, 300);
  struct random random = {.state = 520};
  double worst = 0;
  for (size_t n = 0; n < wanted; n++) {
    struct closed_model model;
    (n % 2 ? model_ball : model_dome)(&model);
    struct placement placement;
    double scale = scales[n % 3], origin[3];
    placement_random(&random, scale, n % 4 ? POLE_SHIFT * scale : 0, &placement);
    model_inside(&model, &random, origin);
    placement_apply(&placement, origin, origin);
    model_place(&model, &placement);
    struct trial trial;
    trial_create(&trial, (const double(*)[4][4][3])model.P, model.count, NULL);
    /* row 0 of the ball's lower half */
    const double sign = n % 4 == 3 ? -1 : 1, *pole = model.P[sign < 0 ? 4 : 0][0][0];
    struct ray ray = {.t_min = 0, .t_max = INFINITY};
    for (int axis = 0; axis < 3; axis++) {
      ray.origin[axis] = origin[axis];
      ray.direction[axis] = pole[axis] - origin[axis];
    }
    struct hit hit;
    tracer_closest(trial.tracer, 1, &ray, &hit);
    trial_destroy(&trial);
    assert_int_not_equal(hit.patch, HIT_NONE);
    assert_true(hit.u <= POLE_PARAMETER);
    for (int axis = 0; axis < 3; axis++)
      worst = worse(worst, fabs(hit.normal[axis] + sign * placement.M[axis][1] / scale) - POLE_TURN * hit.u);
  }
  printf("seed 520: %zu poles, normals off by %.2g at most beyond their turn, %.2g allowed\n", wanted, worst,
         POLE_NORMAL);
  assert_true(worst <= POLE_NORMAL);
}

int main(void)
{
  const struct CMUnitTest others[] = {cmocka_unit_test(test_poles)};
  return class_tests_run("classes", situation_class_count(), test_class, others, 1);
}
