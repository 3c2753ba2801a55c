/* The answer to a ray does not depend on the rays beside it or the order of the patches. (accuracy-kernels
 * compares the instruction sets.) */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "property/world.h"

enum { SEED = 20240510, SCENES = 1 };

/* The answers to the rays one by one; valid until the next call. */
static const struct hit *answers_alone(const struct set_up *s)
{
  static struct hit alone[STAGE_RAYS];
  for (int n = 0; n < STAGE_RAYS; n++) tracer_closest(s->world->tracer, 1, &s->rays[n], &alone[n]);
  return alone;
}

struct alone {
  const struct hit *hits; /* of each ray alone */
  int wrong;
};

static void compare_with_alone(const struct set_up *s, size_t size, const size_t number[], const struct ray rays[],
                               void *context)
{
  struct alone *alone = context;
  struct hit hits[PACKET_SIZE];
  tracer_closest(s->world->tracer, size, rays, hits);
  for (size_t n = 0; n < size; n++) {
    const struct hit *want = &alone->hits[number[n]];
    if (!same_hit(&hits[n], want) && alone->wrong++ < 2)
      world_print_case("companions", s->kind, &rays[n], want, &hits[n]);
  }
}

static void companions(struct set_up *s)
{
  struct alone alone = {answers_alone(s), 0};
  in_all_companies(s, compare_with_alone, &alone);
  assert_int_equal(alone.wrong, 0);
}

TEST(answers_do_not_depend_on_companions) { on_all_stages(SEED, SCENES, companions); }

/* Rays in all directions, in a scene with so many leaves that each ray goes through the hierarchy separately. */
TEST(rays_apart_do_not_depend_on_companions)
{
  static world_net nets[WORLD_MAX];
  struct random random = {SEED + 4};
  struct world world;
  struct method options;
  int wrong = 0, hits = 0;
  method_default(solver_find("bernstein", 9), &options);
  options.split = 64;
  const size_t count = world_fill(WORLD_GRID, &random, nets);
  world_open(&world, nets, count, &options);
  assert_true(world.tracer->model->leaf_count >= 1 << 14);
  for (int n = 0; n < 60; n++) {
    struct ray rays[PACKET_SIZE];
    struct hit together[PACKET_SIZE];
    bool occluded[PACKET_SIZE];
    for (int k = 0; k < PACKET_SIZE; k++) rays[k] = world_ray(&random, nets, count, k % RAY_KINDS);
    tracer_closest(world.tracer, PACKET_SIZE, rays, together);
    tracer_occluded(world.tracer, PACKET_SIZE, rays, occluded);
    for (int k = 0; k < PACKET_SIZE; k++) {
      const struct hit alone = world_closest(&world, &rays[k]);
      hits += alone.patch != HIT_NONE;
      if (same_hit(&alone, &together[k]) && occluded[k] == (alone.patch != HIT_NONE)) continue;
      if (wrong++ < 2) world_print_case("apart", WORLD_GRID, &rays[k], &alone, &together[k]);
    }
  }
  world_close(&world);
  assert_int_equal(wrong, 0);
  assert_true(hits > 100);
}

/* Patches all through one another in one place. Many rays pass more leaves than a ray may be tried on. Which leaves
 * are tried depends on their order; what is certain of the ray must not. */
TEST(exhausted_rays_do_not_depend_on_companions)
{
  enum { HEAP = 20000, RAYS = 120, FEW = 3, BUDGET = 3 << 13 };
  struct random random = {SEED + 5};
  struct world world;
  struct method options;
  struct ray rays[RAYS];
  int wrong = 0, ended = 0;
  method_default(solver_find("bernstein", 9), &options);
  options.split = 2;
  world_net *nets = malloc(HEAP * sizeof *nets);
  assert_non_null(nets);
  for (size_t p = 0; p < HEAP; p++)
    for (int k = 0; k < 48; k++) nets[p][k / 12][k / 3 % 4][k % 3] = random_between(&random, -1, 1);
  world_open(&world, nets, HEAP, &options);
  world.tracer->budget = BUDGET;
  for (int n = 0; n < RAYS; n++) {
    rays[n] = (struct ray){.t_max = INFINITY};
    for (int k = 0; k < 3; k++) {
      rays[n].origin[k] = random_between(&random, -3, 3);
      rays[n].direction[k] = random_between(&random, -1, 1) - rays[n].origin[k];
    }
  }
  for (int n = 0; n < RAYS; n += FEW) {
    struct hit together[FEW];
    tracer_closest(world.tracer, FEW, rays + n, together);
    for (int k = 0; k < FEW; k++) {
      const struct hit alone = world_closest(&world, &rays[n + k]);
      ended += alone.certainty == CERTAINTY_GRAZING;
      if (alone.certainty == together[k].certainty && alone.patch == together[k].patch) continue;
      if (wrong++ < 2) world_print_case("share", WORLD_WILD, &rays[n + k], &alone, &together[k]);
    }
  }
  world_close(&world);
  free(nets);
  assert_int_equal(wrong, 0);
  assert_in_range(ended, RAYS / 20, RAYS / 2);
}

/* Bent cards that share a corner, more than a ray through that corner has room for. Which of them are left open
 * depends on whether the walk reached patches before the corner first. The range of rays from far away begins
 * somewhere among the cards. */
TEST(rays_through_a_crowded_corner_do_not_depend_on_companions)
{
  enum { CARDS = 200, RAYS = 8000, FEW = 8 };
  static world_net nets[CARDS];
  struct random random = {SEED + 6};
  struct world world;
  struct method options;
  int wrong = 0, certain = 0;
  method_default(solver_find("bernstein", 9), &options);
  for (size_t p = 0; p < CARDS; p++) {
    for (int k = 0; k < 3; k++) {
      const double a = random_between(&random, -1, 1), b = random_between(&random, -1, 1),
                   c = random_between(&random, -1, 1);
      for (int n = 0; n < 16; n++) nets[p][n / 4][n % 4][k] = (n / 4 * a + n % 4 * b) / 3 + n / 4 * (n % 4) * c / 9;
    }
  }
  world_open(&world, nets, CARDS, &options);
  for (int n = 0; n < RAYS; n += FEW) {
    struct ray rays[FEW];
    struct hit together[FEW];
    bool occluded[FEW];
    for (int m = 0; m < FEW; m++) {
      rays[m] = (struct ray){.t_max = INFINITY};
      const bool far = m == 1 && n % 2;
      for (int k = 0; k < 3; k++) {
        const double from = random_between(&random, -1, 1);
        rays[m].origin[k] = far ? ldexp(from, 200) : from, rays[m].direction[k] = -from;
      }
      if (far) rays[m].t_min = 0x1p200;
    }
    tracer_closest(world.tracer, FEW, rays, together);
    tracer_occluded(world.tracer, FEW, rays, occluded);
    for (int m = 0; m < FEW; m++) {
      const struct hit alone = world_closest(&world, &rays[m]);
      bool by_itself;
      tracer_occluded(world.tracer, 1, &rays[m], &by_itself);
      certain += alone.certainty == CERTAINTY_CERTAIN;
      const bool same = alone.certainty == together[m].certainty && alone.patch == together[m].patch;
      if (same && occluded[m] == by_itself) continue;
      if (wrong++ < 2) world_print_case("corner", WORLD_WILD, &rays[m], &alone, &together[m]);
    }
  }
  world_close(&world);
  assert_int_equal(wrong, 0);
  assert_true(certain > RAYS / 2);
}

/* Any hit is found exactly if a closest one is, alone and in packets. */
static void occlusion(struct set_up *s)
{
  const struct hit *alone = answers_alone(s);
  int wrong = 0;
  for (size_t first = 0; first < STAGE_RAYS; first += PACKET_SIZE) {
    bool occluded[PACKET_SIZE], by_itself;
    tracer_occluded(s->world->tracer, PACKET_SIZE, &s->rays[first], occluded);
    for (size_t n = 0; n < PACKET_SIZE; n++) {
      tracer_occluded(s->world->tracer, 1, &s->rays[first + n], &by_itself);
      const bool want = alone[first + n].patch != HIT_NONE;
      if (occluded[n] == want && by_itself == want) continue;
      if (wrong++ < 2)
        world_print_case("occlusion", s->kind, &s->rays[first + n], &alone[first + n], &alone[first + n]);
    }
  }
  assert_int_equal(wrong, 0);
}

TEST(occluded_is_whether_there_is_a_hit) { on_all_stages(SEED + 1, SCENES, occlusion); }

/* Another order of the patches: the same t and, unless hits are tied, the same patch. */
static void shuffled(struct set_up *s)
{
  const struct hit *alone = answers_alone(s);
  static world_net nets[WORLD_MAX];
  size_t place[WORLD_MAX];
  for (size_t p = 0; p < s->count; p++) place[p] = p;
  random_shuffle(s->random, s->count, place);
  for (size_t p = 0; p < s->count; p++) memcpy(nets[place[p]], s->nets[p], sizeof nets[0]);
  struct world world;
  world_open(&world, nets, s->count, NULL);
  int wrong = 0, tied = 0;
  for (size_t n = 0; n < STAGE_RAYS; n++) {
    struct hit hit;
    tracer_closest(world.tracer, 1, &s->rays[n], &hit);
    const struct hit *want = &alone[n];
    bool good = (hit.patch == HIT_NONE) == (want->patch == HIT_NONE);
    if (good && hit.patch != HIT_NONE && (hit.certainty == CERTAINTY_CERTAIN || want->certainty == CERTAINTY_CERTAIN)) {
      if (hit.patch == place[want->patch]) good = hit.t == want->t && hit.u == want->u && hit.v == want->v;
      else good = fabs(hit.t - want->t) <= 1e-9 * want->t, tied++;
    }
    if (!good && wrong++ < 3) world_print_case("order", s->kind, &s->rays[n], want, &hit);
  }
  world_close(&world);
  assert_int_equal(wrong, 0);
  assert_true(tied < STAGE_RAYS * 2 / 3); /* flat patches, which meet at borders and lie on each other */
}

TEST(answers_do_not_depend_on_the_order_of_patches) { on_all_stages(SEED + 3, SCENES, shuffled); }
