/* Answers stay the same if the scene is scaled or turned, and if the ray is given differently. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "property/world.h"

enum { SEED = 20240511, RAYS = 64 };

/* How far apart answers may be that are both grazing, relative: some hundred roundings. */
#define SAME_T 1e-13

/* Answers that no traversal changes: they are the same to the last bit. Of a pole met exactly, any of the patches
 * that meet there may be answered, at a place within the last bits: at the limits of the hierarchy's single
 * precision the order differs. */
static bool same_or_grazing(const struct hit *a, const struct hit *b)
{
  if (same_hit(a, b)) return true;
  if (a->certainty != CERTAINTY_GRAZING || b->certainty != CERTAINTY_GRAZING) return false;
  return a->patch != HIT_NONE && b->patch != HIT_NONE && fabs(a->t - b->t) <= SAME_T * a->t;
}

/* Exponents of common scenes, then far beyond the range of a float, up to what is read. */
static const int scene_exponents[] = {20, -20, 100, -100, 300, -300};
enum { EXPONENTS = sizeof scene_exponents / sizeof *scene_exponents, EXPONENTS_OF_FLOAT = 4 };

/* Scaling by a power of two changes no digit of any answer. */
TEST(powers_of_two_scale_exactly)
{
  struct random random = {SEED};
  world_net nets[WORLD_MAX], other[WORLD_MAX];
  int wrong = 0, hits = 0;
  for (int kind = 0; kind < WORLD_KINDS; kind++) {
    for (int e = 0; e < EXPONENTS; e++) {
      const int exponent = scene_exponents[e];
      struct world a, b;
      const size_t count = world_fill((enum world_kind)kind, &random, nets);
      for (size_t p = 0; p < count; p++) world_scale_net(nets[p], ldexp(1, exponent), 0, other[p]);
      world_open(&a, nets, count, NULL);
      world_open(&b, other, count, NULL);
      for (int n = 0; n < RAYS; n++) {
        struct ray ray = world_ray(&random, nets, count, n % RAY_KINDS), scaled = ray;
        for (int k = 0; k < 3; k++) scaled.origin[k] = ldexp(ray.origin[k], exponent);
        const struct hit want = world_closest(&a, &ray);
        struct hit got = world_closest(&b, &scaled);
        hits += want.patch != HIT_NONE;
        if (got.patch != HIT_NONE) {
          got.t = ldexp(got.t, -exponent), got.point_error = ldexp(got.point_error, -exponent);
          for (int k = 0; k < 3; k++) got.point[k] = ldexp(got.point[k], -exponent);
        }
        const bool same = e < EXPONENTS_OF_FLOAT ? same_hit(&want, &got) : same_or_grazing(&want, &got);
        if (!same && wrong++ < 5) world_print_case("power of two", kind, &ray, &want, &got);
      }
      world_close(&a);
      world_close(&b);
    }
  }
  assert_int_equal(wrong, 0);
  assert_true(hits > WORLD_KINDS * EXPONENTS * RAYS / 4);
}

/* x, y, z become y, z, x. The axis along which the ray is longest moves along, and with it the two planes, so no
 * digit of the place changes. (The normal's length is summed in another order.) */
TEST(turned_axes_answer_alike)
{
  struct random random = {SEED + 9};
  world_net nets[WORLD_MAX], other[WORLD_MAX];
  int wrong = 0, hits = 0;
  for (int kind = 0; kind < WORLD_KINDS; kind++) {
    for (int turn = 1; turn < 3; turn++) {
      struct world a, b;
      const size_t count = world_fill((enum world_kind)kind, &random, nets);
      for (size_t p = 0; p < count; p++)
        for (int n = 0; n < 48; n++) other[p][n / 12][n / 3 % 4][(n + turn) % 3] = nets[p][n / 12][n / 3 % 4][n % 3];
      world_open(&a, nets, count, NULL);
      world_open(&b, other, count, NULL);
      for (int n = 0; n < RAYS; n++) {
        const struct ray ray = world_ray(&random, nets, count, n % RAY_KINDS);
        struct ray turned = ray;
        for (int k = 0; k < 3; k++)
          turned.origin[(k + turn) % 3] = ray.origin[k], turned.direction[(k + turn) % 3] = ray.direction[k];
        const struct hit want = world_closest(&a, &ray), got = world_closest(&b, &turned);
        bool same = want.patch == got.patch && want.certainty == got.certainty;
        hits += want.patch != HIT_NONE;
        if (same && want.patch != HIT_NONE) {
          same = want.t == got.t && want.u == got.u && want.v == got.v && want.point_error == got.point_error;
          for (int k = 0; k < 3; k++) {
            same &= want.point[k] == got.point[(k + turn) % 3];
            same &= fabs(want.normal[k] - got.normal[(k + turn) % 3]) <= 0x1p-50;
          }
        }
        if (!same && wrong++ < 5) world_print_case("turned", kind, &ray, &want, &got);
      }
      world_close(&a);
      world_close(&b);
    }
  }
  assert_int_equal(wrong, 0);
  assert_true(hits > WORLD_KINDS * 2 * RAYS / 4);
}

/* Directions scaled by powers of two answer exactly alike. */
TEST(the_length_of_the_direction_does_not_matter)
{
  struct random random = {SEED + 2};
  static const int exponents[] = {1, -30, 190, -190, 300, -300, 900, -900};
  world_net nets[WORLD_MAX];
  int wrong = 0, hits = 0;
  for (int kind = 0; kind < WORLD_KINDS; kind++) {
    struct world world;
    const size_t count = world_fill((enum world_kind)kind, &random, nets);
    world_open(&world, nets, count, NULL);
    for (int n = 0; n < RAYS; n++) {
      struct ray ray = world_ray(&random, nets, count, n % RAY_KINDS), longer = ray;
      const struct hit want = world_closest(&world, &ray);
      const int exponent = exponents[n % 8];
      bool exact = true;
      for (int k = 0; k < 3; k++) {
        longer.direction[k] = ldexp(ray.direction[k], exponent);
        exact &= ldexp(longer.direction[k], -exponent) == ray.direction[k];
      }
      struct hit got = world_closest(&world, &longer);
      got.t = ldexp(got.t, exponent);
      hits += want.patch != HIT_NONE && exact;
      if (want.patch != HIT_NONE && exact && !same_hit(&want, &got) && wrong++ < 5)
        world_print_case("length", kind, &ray, &want, &got);
      if ((want.patch == HIT_NONE) != (got.patch == HIT_NONE) && wrong++ < 5)
        world_print_case("length", kind, &ray, &want, &got);
    }
    world_close(&world);
  }
  assert_int_equal(wrong, 0);
  assert_true(hits > WORLD_KINDS * RAYS / 4);
}

TEST(warm_starts_are_reproducible)
{
  struct random random = {SEED + 8};
  world_net nets[WORLD_MAX];
  for (size_t s = 0; s < solver_count(); s++) {
    for (int kind = 0; kind < WORLD_KINDS; kind += 2) {
      struct method options;
      method_default(solver_at(s), &options);
      options.roots.start = START_PREVIOUS;
      struct world world;
      const size_t count = world_fill((enum world_kind)kind, &random, nets);
      world_open(&world, nets, count, &options);
      struct ray rays[RAYS / 4];
      struct hit once[RAYS / 4];
      for (int n = 0; n < RAYS / 4; n++) rays[n] = world_ray(&random, nets, count, n % RAY_KINDS);
      for (int polish = 0; polish < 2; polish++) {
        for (int n = 0; n < RAYS / 4; n++) {
          const struct hit hit = world_closest(&world, &rays[n]);
          if (polish == 0) once[n] = hit;
          else assert_true(same_hit(&once[n], &hit));
        }
        tracer_forget(world.tracer);
      }
      world_close(&world);
    }
  }
}

TEST(an_empty_scene_is_missed)
{
  struct world world;
  world_net nets[1];
  world_open(&world, nets, 0, NULL);
  const struct ray ray = {{0, 0, 0}, {0, 0, 1}, 0, INFINITY};
  assert_int_equal(world_closest(&world, &ray).patch, HIT_NONE);
  bool occluded = true;
  tracer_occluded(world.tracer, 1, &ray, &occluded);
  assert_false(occluded);
  tracer_closest(world.tracer, 0, NULL, NULL);
  assert_int_equal(tracer_counts(world.tracer)->rays[0], 1);
  assert_int_equal(tracer_counts(world.tracer)->rays[1], 1);
  world_close(&world);
}
