/* Random rays over random patches: tame (nearly regular nets), wild (any net), and self-intersecting (folded nets,
 * where a ray meets a patch up to 18 times); alone and several in a scene. */
#include <math.h>
#include <stdio.h>

#include "accuracy/trial.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

enum { FULL_RAYS = 1000000 / 3, RAYS_A_SCENE = 64, MOST_PATCHES = 6 };

/* A net near a regular one in a random plane. `wild` is the size of the random part; `fold` turns every second row
 * back. */
static void random_net(struct random *random, double wild, bool fold, double P[4][4][3])
{
  int up = (int)(random_bits(random) % 3), across = (up + 1) % 3, along = (up + 2) % 3;
  double center[3];
  for (int axis = 0; axis < 3; axis++) center[axis] = random_between(random, -1.5, 1.5);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      for (int axis = 0; axis < 3; axis++) P[i][j][axis] = center[axis] + wild * random_between(random, -1, 1);
      P[i][j][across] += fold ? 3.0 * (i % 2) - 1.5 : i - 1.5;
      P[i][j][along] += fold ? 2.0 * (j % 2) + 0.3 * j - 1.5 : j - 1.5;
    }
  }
}

static void random_ray(struct random *random, struct ray *ray)
{
  *ray = (struct ray){.t_min = 0, .t_max = INFINITY};
  double length = ldexp(1, (int)(random_bits(random) % 13) - 6);
  for (int axis = 0; axis < 3; axis++) {
    ray->origin[axis] = random_between(random, -6, 6);
    ray->direction[axis] = length * (random_between(random, -2, 2) - ray->origin[axis]);
  }
}

static void run(const char *name, uint64_t seed, double wild, bool fold)
{
  size_t wanted = effort_count(FULL_RAYS, 2000);
  struct tally tally = {.name = name};
  struct random random = {.state = seed = effort_seed(seed)};
  for (size_t scene = 0; tally.rays < wanted; scene++) {
    double P[MOST_PATCHES][4][4][3];
    size_t count = scene % 2 ? MOST_PATCHES : 1;
    for (size_t n = 0; n < count; n++) random_net(&random, wild, fold, P[n]);
    struct ray rays[RAYS_A_SCENE];
    for (int n = 0; n < RAYS_A_SCENE; n++) random_ray(&random, &rays[n]);
    struct trial trial;
    trial_create(&trial, (const double(*)[4][4][3])P, count, NULL);
    trial_rays(&trial, rays, RAYS_A_SCENE, &tally);
    trial_destroy(&trial);
  }
  printf("seed %llu\n", (unsigned long long)seed);
  tally_print(&tally);
  assert_true(tally.undecided <= tally.rays / 1000);
  tally_assert(&tally);
  tally_free(&tally);
}

TEST(test_tame) { run("tame", 101, 0.35, false); }

TEST(test_wild) { run("wild", 102, 2.5, false); }

TEST(test_self_intersecting) { run("self-intersecting", 103, 0.8, true); }
