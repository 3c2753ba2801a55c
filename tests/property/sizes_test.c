/* Scenes whose parts differ in size and place over the whole range of doubles: each part is answered as if it were
 * alone. */
#include <math.h>

#include "cmocka_test.h"
#include "intersect/model.h"
#include "property/world.h"

enum { SEED = 20261122, RAYS = 24 };

/* The number of leaves that rays were tried on. */
static uint64_t tried(const struct world *world) { return tracer_counts(world->tracer)->patches_tested; }

/* Villages, and a single patch, up to so far apart that floats in the frame of the whole do not resolve the patches of a
 * village. */
enum { VILLAGES = 3, VILLAGE = 60, VILLAGERS = VILLAGES * VILLAGE };

static void village(struct random *random, const double at[3], world_net nets[VILLAGE])
{
  for (int p = 0; p < VILLAGE; p++) {
    double corner[3];
    for (int k = 0; k < 3; k++) corner[k] = at[k] + random_between(random, -2, 2);
    for (int n = 0; n < 16; n++) {
      const double step[3] = {n / 4 * 0.3, n % 4 * 0.3, random_between(random, -0.2, 0.2)};
      for (int k = 0; k < 3; k++) nets[p][n / 4][n % 4][k] = corner[k] + step[k];
    }
  }
}

/* Rays at a village are answered as if nothing else existed, and are tried on no more leaves if that is not too far. */
TEST(what_is_far_away_changes_nothing)
{
  static world_net nets[VILLAGERS + 1];
  size_t hits = 0;
  static const double distances[] = {1e3, 1e6, 1e9, 1e12, 1e15, 1e17, 1e20, 1e30, 1e45, 1e90};
  for (size_t d = 0; d < sizeof distances / sizeof distances[0]; d++) {
    const double apart = distances[d];
    struct random random = {SEED};
    const double at[VILLAGES + 1][3] = {{0, 0, 0}, {apart, 0, 0}, {apart / 3, -apart, 7}, {-apart, apart, apart}};
    for (int v = 0; v < VILLAGES; v++) village(&random, at[v], nets + VILLAGE * v);
    for (int n = 0; n < 16; n++)
      for (int k = 0; k < 3; k++)
        nets[VILLAGERS][n / 4][n % 4][k] = at[VILLAGES][k] + (k == 0) * (n / 4) + (k == 1) * (n % 4);
    struct world all, alone;
    world_open(&all, nets, VILLAGERS + 1, NULL);
    for (int v = 0; v < (apart > 1e12 ? 1 : VILLAGES); v++) { /* farther apart, rounding destroys the others */
      const uint64_t before = tried(&all);
      world_open(&alone, nets + VILLAGE * v, VILLAGE, NULL);
      for (int n = 0; n < 10 * RAYS; n++) {
        struct ray ray = {.t_max = INFINITY};
        for (int k = 0; k < 3; k++) {
          ray.origin[k] = at[v][k] + random_between(&random, -5, 5);
          ray.direction[k] = at[v][k] + random_between(&random, -2, 2) - ray.origin[k];
        }
        struct hit hit = world_closest(&all, &ray);
        const struct hit other = world_closest(&alone, &ray);
        if (other.certainty != CERTAINTY_CERTAIN) continue;
        assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
        if (hit.patch < VILLAGERS && other.patch == HIT_NONE) continue; /* the ray goes on to another village */
        if (hit.patch != HIT_NONE) hit.patch -= (uint32_t)(VILLAGE * v);
        assert_int_equal(hit.patch, other.patch);
        if (hit.patch != HIT_NONE) assert_true(fabs(hit.t - other.t) <= 0x1p-50 * other.t);
        hits += hit.patch != HIT_NONE;
      }
      const uint64_t took = tried(&all) - before, least = tried(&alone);
      if (apart <= 1e3) assert_in_range(took, 0, 2 * least + 10 * RAYS);
      world_close(&alone);
    }
    world_close(&all);
  }
  assert_true(hits > 1000);
}

/* Bowls round 0, each 2^8 times as wide as the next, over the range of numbers that are read. Together rays are answered as
 * they are alone. */
TEST(bowls_stand_in_bowls)
{
  enum { BOWLS = 78, BOWL_RAYS = PACKET_SIZE };
  static world_net nets[BOWLS];
  const double least = exp2(320 - 8.2 * BOWLS);
  for (int k = 0; k < BOWLS; k++) {
    const double size = exp2(320 - 8.2 * k);
    for (int n = 0; n < 16; n++) {
      const int i = n / 4, j = n % 4;
      const double at[3] = {(i - 1.5) / 1.5, (j - 1.5) / 1.5, ((i == 1 || i == 2) + (j == 1 || j == 2)) / 4.0 - 1};
      for (int c = 0; c < 3; c++) nets[k][i][j][c] = size * at[c];
    }
  }
  struct world world;
  struct ray rays[BOWL_RAYS];
  struct hit hits[BOWL_RAYS];
  bool occluded[BOWL_RAYS];
  for (int n = 0; n < BOWL_RAYS; n++) {
    rays[n] = (struct ray){.t_max = INFINITY};
    for (int c = 0; c < 3; c++) {
      rays[n].origin[c] = least * (n + c) * 1e-3;
      rays[n].direction[c] = (n >> c & 1 ? 1 : -1) * (1 + 0.01 * c + 0.001 * n);
    }
  }
  world_open(&world, nets, BOWLS, NULL);
  assert_true(world.tracer->model->inner_count >= BOWLS / 2);
  tracer_closest(world.tracer, BOWL_RAYS, rays, hits);
  tracer_occluded(world.tracer, BOWL_RAYS, rays, occluded);
  size_t met = 0;
  for (int n = 0; n < BOWL_RAYS; n++) {
    const struct hit alone = world_closest(&world, &rays[n]);
    assert_int_equal(hits[n].patch, alone.patch);
    assert_int_equal(hits[n].certainty, alone.certainty);
    assert_int_equal(occluded[n], alone.patch != HIT_NONE);
    met += alone.patch != HIT_NONE;
  }
  assert_true(met >= BOWL_RAYS / 4);
  world_close(&world);
}
