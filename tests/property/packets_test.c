/* The answers to a ray do not depend on the rays beside it or the order of the patches. (accuracy-kernels
 * compares the instruction sets, and any hit with the nearest.) */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "method_of.h"
#include "property/world.h"

enum { SEED = 20240510 };

/* The answers to the rays one by one; valid until the next call. */
static const struct hit *answers_alone(const struct set_up *s)
{
  static struct hit alone[STAGE_RAYS];
  for (int n = 0; n < STAGE_RAYS; n++) tracer_closest(s->world->tracer, 1, &s->rays[n], &alone[n]);
  return alone;
}

/* In their order, shuffled, and shuffled in packets of every size. */
static void companions(struct set_up *s)
{
  const struct hit *alone = answers_alone(s);
  struct tracer *other; /* for all hits of one ray */
  size_t order[STAGE_RAYS];
  int wrong = 0;
  assert_int_equal(tracer_create(s->world->intersector, &other), STATUS_OK);
  for (size_t n = 0; n < STAGE_RAYS; n++) order[n] = n;
  for (int round = 0; round < 3; round++) {
    for (size_t first = 0, size; first < STAGE_RAYS; first += size) {
      struct ray rays[PACKET_SIZE];
      struct hit hits[PACKET_SIZE];
      struct hit_list lists[PACKET_SIZE], list;
      size = round == 2 ? 1 + random_bits(s->random) % PACKET_SIZE : PACKET_SIZE;
      if (size > STAGE_RAYS - first) size = STAGE_RAYS - first;
      for (size_t n = 0; n < size; n++) rays[n] = s->rays[order[first + n]];
      tracer_closest(s->world->tracer, size, rays, hits);
      assert_int_equal(tracer_all(s->world->tracer, size, rays, lists), STATUS_OK);
      for (size_t n = 0; n < size; n++) {
        const struct hit *want = &alone[order[first + n]];
        assert_int_equal(tracer_all(other, 1, &rays[n], &list), STATUS_OK);
        if ((!same_hit(&hits[n], want) || !same_list(&lists[n], &list)) && wrong++ < 2)
          world_print_case("companions", s->kind, &rays[n], want, &hits[n]);
      }
    }
    random_shuffle(s->random, STAGE_RAYS, order);
  }
  tracer_destroy(other);
  assert_int_equal(wrong, 0);
}

TEST(answers_do_not_depend_on_companions)
{
  static const char *const methods[] = {"bernstein", "aberth { split 1 }", "newton { split 2 }", "laguerre { split 1 }",
                                        "durand_kerner { split 2 }"};
  for (size_t n = 0; n < sizeof methods / sizeof methods[0]; n++) {
    const struct method method = method_of(methods[n]);
    on_all_stages(SEED + 10 * n, 1, &method, companions);
  }
}

/* Rays in all directions, in a scene with so many leaves that each ray goes through the hierarchy separately. */
TEST(rays_apart_do_not_depend_on_companions)
{
  static world_net nets[WORLD_MAX];
  struct random random = {SEED + 4};
  struct world world;
  const struct method options = method_of("bernstein { split 64 }");
  int wrong = 0, hits = 0;
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
  const struct method options = method_of("bernstein { split 2 }");
  struct ray rays[RAYS];
  int wrong = 0, ended = 0;
  world_net *nets = malloc(HEAP * sizeof *nets);
  assert_non_null(nets);
  for (size_t p = 0; p < HEAP; p++)
    for (int k = 0; k < 48; k++) nets[p][k / 12][k / 3 % 4][k % 3] = random_between(&random, -1, 1);
  world_open(&world, nets, HEAP, &options);
  world.tracer->budget = BUDGET;
  for (int n = 0; n < RAYS; n++) {
    rays[n] = (struct ray){.t_max = INFINITY};
    world_towards(&random, (const double[3]){0}, 1, &rays[n]);
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
  int wrong = 0, certain = 0;
  for (size_t p = 0; p < CARDS; p++) {
    for (int k = 0; k < 3; k++) {
      const double a = random_between(&random, -1, 1), b = random_between(&random, -1, 1),
                   c = random_between(&random, -1, 1);
      for (int n = 0; n < 16; n++) nets[p][n / 4][n % 4][k] = (n / 4 * a + n % 4 * b) / 3 + n / 4 * (n % 4) * c / 9;
    }
  }
  world_open(&world, nets, CARDS, NULL);
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

TEST(answers_do_not_depend_on_the_order_of_patches) { on_all_stages(SEED + 3, 1, NULL, shuffled); }

enum { SHEETS = 1200 };

/* One of the four patches, bent and slanted, of a sheet; all have a corner at z on the z axis, and exact
 * coordinates. Bit 0 of `quarter`: the patch at x > 0; bit 1: at y > 0. */
static void quarter_sheet(unsigned quarter, double z, double slope, double bend, world_net out)
{
  for (int n = 0; n < 16; n++) {
    const int x = quarter & 1 ? n / 4 : n / 4 - 3, y = quarter & 2 ? n % 4 : n % 4 - 3;
    const double at[3] = {x, y, z + slope * x + bend * (x * x + y * y)};
    memcpy(out[n / 4][n % 4], at, sizeof at);
  }
}

/* A stack of sheets, in no order in the scene. Rays along its axis meet each sheet in a corner of all its patches,
 * or where two of them meet, so far more places are left to the last resort than a ray has room for. The answer
 * depends only on the first sheet: not on those behind it, nor on the rays beside it, nor on which box the walk
 * reaches first. The sheets slant, so the boxes are long along the axis. */
TEST(a_stack_is_met_on_its_first_sheet)
{
  enum { RAYS_ALONG = 6, APART = 90 };
  static const double beside[] = {0, 1.5, -0.75};
  static world_net nets[4 * SHEETS];
  static double z[SHEETS];
  static size_t place[4 * SHEETS];
  struct random random = {SEED + 7};
  struct world world;
  for (size_t k = 0; k < 4 * SHEETS; k++) place[k] = k;
  random_shuffle(&random, 4 * SHEETS, place);
  for (size_t s = 0; s < SHEETS; s++) {
    z[s] = (s > 0 ? z[s - 1] : 0) + 1 + floor(random_between(&random, 0, 64)) / 16;
    const double slope = floor(random_between(&random, -128, 129)), bend = floor(random_between(&random, -4, 5)) / 256;
    for (unsigned q = 0; q < 4; q++) quarter_sheet(q, z[s], slope, bend, nets[place[4 * s + q]]);
  }
  world_open(&world, nets, 4 * SHEETS, NULL);
  for (size_t b = 0; b < sizeof beside / sizeof *beside; b++) {
    struct ray rays[RAYS_ALONG];
    struct hit together[RAYS_ALONG];
    for (size_t n = 0; n < RAYS_ALONG; n++) { /* from between two sheets, up or down */
      const size_t below = n == 1 ? SHEETS - 1 : APART * n;
      const double from = n == 0 ? z[0] - 1 : n == 1 ? z[SHEETS - 1] + 1 : (z[below] + z[below + 1]) / 2;
      rays[n] = (struct ray){{0, beside[b], from}, {0, 0, n & 1 ? -1 : 1}, 0, INFINITY};
    }
    tracer_closest(world.tracer, RAYS_ALONG, rays, together);
    for (size_t n = 0; n < RAYS_ALONG; n++) {
      const struct hit alone = world_closest(&world, &rays[n]);
      const size_t sheet = n == 0 ? 0 : n == 1 ? SHEETS - 1 : n & 1 ? APART * n : APART * n + 1;
      size_t first = 4 * SHEETS;
      for (unsigned q = 0; q < 4; q++)
        if ((q & 2 ? beside[b] >= 0 : beside[b] <= 0) && place[4 * sheet + q] < first) first = place[4 * sheet + q];
      assert_int_equal(alone.certainty, CERTAINTY_CERTAIN);
      assert_int_equal(alone.patch, first);
      if (beside[b] == 0) assert_true(alone.t == fabs(z[sheet] - rays[n].origin[2]));
      assert_same_hit("stack", WORLD_GRID, &rays[n], &alone, &together[n]);
    }
  }
  world_close(&world);
}
