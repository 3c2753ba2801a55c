/* Flat patches on one another in one plane across an axis: the nearest is the first in the scene, as all hits say,
 * and this needs no last resort. */
#include <math.h>
#include <stdlib.h>

#include "cmocka_test.h"
#include "intersect/intersect.h"
#include "property/world.h"

enum { SEED = 20261126, SCENES = 12, RAYS = 64, PACKET = 8, MOST = 24 };

/* A patch in that plane, somewhere within 2 of the middle: four corners, and borders bent within the plane. */
static void flat_net(struct random *random, int axis, double value, world_net out)
{
  const int x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double middle[2] = {random_between(random, -1, 1), random_between(random, -1, 1)};
  for (int n = 0; n < 16; n++) {
    double *P = out[n / 4][n % 4];
    P[axis] = random_bits(random) % 2 && value == 0 ? -0.0 : value;
    P[x] = middle[0] + (n / 4 - 1.5) / 3 + random_between(random, -0.1, 0.1);
    P[y] = middle[1] + (n % 4 - 1.5) / 3 + random_between(random, -0.1, 0.1);
  }
}

/* Bends it a little out of the plane. */
static void bend_net(struct random *random, int axis, world_net net)
{
  for (int n = 0; n < 16; n++) net[n / 4][n % 4][axis] += random_between(random, -0.1, 0.1);
}

/* A scene of them, every fourth one bent if `bent`. */
static void open_flat(struct random *random, int axis, double value, bool bent, struct world *world)
{
  world_net nets[MOST];
  for (int p = 0; p < MOST; p++) {
    flat_net(random, axis, value, nets[p]);
    if (bent && p % 4 == 3) bend_net(random, axis, nets[p]);
  }
  world_open(world, nets, MOST, NULL);
}

/* A ray from nearby, or from so far away that t is not known to its last places. */
static struct ray ray_at(struct random *random, int axis, double value)
{
  struct ray ray = {.t_max = INFINITY};
  const double far = random_bits(random) % 2 ? 1 : 0x1p40, length = random_between(random, 0.3, 3);
  for (int k = 0; k < 3; k++) {
    const double aim = k == axis ? value : random_between(random, -1.2, 1.2), way = random_between(random, -3, 3);
    ray.origin[k] = aim - far * way, ray.direction[k] = length * way;
  }
  return ray;
}

static void check_rays(struct world *world, const struct ray rays[RAYS], int *hits)
{
  for (int n = 0; n < RAYS; n += PACKET) {
    struct hit together[PACKET];
    tracer_closest(world->tracer, PACKET, &rays[n], together);
    for (int l = 0; l < PACKET; l++) {
      const struct hit alone = world_closest(world, &rays[n + l]);
      assert_same_hit("flats", 0, &rays[n + l], &alone, &together[l]);
      const struct hit_list list = world_all(world, &rays[n + l]);
      if (alone.certainty != CERTAINTY_CERTAIN || list.certainty != CERTAINTY_CERTAIN) continue;
      assert_int_equal(alone.patch != HIT_NONE, list.count > 0);
      if (list.count == 0) continue;
      assert_int_equal(alone.patch, list.hits[0].patch);
      *hits += 1;
    }
  }
}

TEST(the_first_of_a_plane_is_the_nearest)
{
  struct random random = {SEED};
  int hits = 0;
  for (int scene = 0; scene < SCENES; scene++) {
    const int axis = scene % 3;
    const double value = scene % 4 ? random_between(&random, -1, 1) : 0;
    struct world world;
    struct ray rays[RAYS];
    open_flat(&random, axis, value, true, &world);
    for (int n = 0; n < RAYS; n++) rays[n] = ray_at(&random, axis, value);
    check_rays(&world, rays, &hits);
    world_close(&world);
  }
  assert_true(hits > SCENES * RAYS / 2);
}

/* A scene of some patches in one plane, folded over themselves, so that a ray meets one up to three times and Newton's
 * method does not suffice. */
static void open_folded(struct random *random, int axis, double value, struct world *world)
{
  enum { FEW = 3 };
  world_net nets[FEW];
  for (int n = 0; n < 48 * FEW; n++)
    nets[n / 48][n / 12 % 4][n / 3 % 4][n % 3] = n % 3 == axis ? value : random_between(random, -1, 1);
  world_open(world, nets, FEW, NULL);
}

/* An open question about a patch behind the plane does not make the hit grazing, whichever the ray reaches first. */
TEST(what_stands_behind_in_a_plane_is_no_doubt)
{
  struct random random = {SEED + 4};
  int hits = 0;
  for (int scene = 0; scene < SCENES; scene++) {
    const int axis = scene % 3;
    struct world world;
    struct ray rays[RAYS];
    open_folded(&random, axis, 0.3, &world);
    for (int n = 0; n < RAYS; n++) {
      rays[n] = ray_at(&random, axis, 0.3);
      if (n % PACKET != 0) continue;
      rays[n].direction[axis] *= 0x1p-13, rays[n].origin[axis] = 0.3 - rays[n].direction[axis];
    }
    check_rays(&world, rays, &hits);
    world_close(&world);
  }
  assert_true(hits > SCENES * RAYS / 8);
}

/* A ray that starts exactly in a plane meets nothing of it; nor does one that starts a little behind it. */
TEST(what_starts_in_a_plane_leaves_it)
{
  struct random random = {SEED + 3};
  int hits = 0;
  for (int scene = 0; scene < SCENES; scene++) {
    const int axis = scene % 3;
    const double value = scene % 4 ? random_between(&random, -1, 1) : 0;
    struct world world;
    open_flat(&random, axis, value, true, &world);
    for (int n = 0; n < RAYS; n++) {
      struct ray ray = ray_at(&random, axis, value), behind;
      for (int k = 0; k < 3; k++) ray.origin[k] = k == axis ? value : random_between(&random, -1, 1);
      behind = ray, behind.t_min = 0x1p-20;
      const struct hit hit = world_closest(&world, &ray), next = world_closest(&world, &behind);
      assert_same_hit("start", 0, &ray, &hit, &next);
      hits += hit.patch != HIT_NONE;
    }
    assert_true(tracer_counts(world.tracer)->escalated * 20 < RAYS);
    world_close(&world);
  }
  assert_true(hits > SCENES * RAYS / 8);
}

/* The ray meets nothing, so certainly. */
static void assert_leaves(const struct world *world, const struct ray *ray, enum certainty certainty)
{
  const struct hit hit = world_closest(world, ray);
  const struct hit_list list = world_all(world, ray);
  bool occluded;
  tracer_occluded(world->tracer, 1, ray, &occluded);
  assert_true(hit.patch == HIT_NONE && hit.certainty == certainty && !occluded);
  assert_true(list.count == 0 && list.certainty == certainty);
}

/* However slowly a ray leaves its plane, and whatever is open about the patches there, it meets none of them. */
TEST(what_leaves_a_plane_slowly_does_not_meet_it)
{
  struct random random = {SEED + 5};
  for (int scene = 0; scene < SCENES; scene++) {
    const int axis = scene % 3;
    struct world world;
    open_folded(&random, axis, 0.3, &world);
    for (int n = 0; n < RAYS; n++) {
      struct ray ray = {.t_max = INFINITY};
      for (int k = 0; k < 3; k++) {
        ray.origin[k] = random_between(&random, -3, 3);
        ray.direction[k] = random_between(&random, -0.5, 0.5) - ray.origin[k];
      }
      ray.origin[(axis + 1) % 3] = copysign(random_between(&random, 1, 3), ray.origin[(axis + 1) % 3]); /* beside all
                                                                                                         * patches */
      ray.origin[axis] = 0.3, ray.direction[axis] = ldexp(1, -n % 60);
      assert_leaves(&world, &ray, CERTAINTY_CERTAIN);
    }
    assert_int_equal(tracer_counts(world.tracer)->escalated, 0);
    world_close(&world);
  }
}

/* A ray that starts in the box of a patch of the plane may touch the patch. The answer does not depend on how it
 * leaves: no hit, and grazing if a ray that leaves straight across is grazing. */
TEST(what_leaves_a_plane_slowly_is_judged_where_it_starts)
{
  struct random random = {SEED + 6};
  for (int scene = 0; scene < SCENES; scene++) {
    const int axis = scene % 3;
    struct world world;
    open_folded(&random, axis, 0.3, &world);
    for (int n = 0; n < RAYS; n++) {
      struct ray ray = {.t_max = INFINITY}, across;
      for (int k = 0; k < 3; k++) {
        ray.origin[k] = random_between(&random, -1, 1);
        ray.direction[k] = random_between(&random, -1, 1);
      }
      ray.origin[axis] = 0.3, ray.direction[axis] = 0, across = ray;
      for (int k = 0; k < 3; k++) across.direction[k] = k == axis;
      ray.direction[axis] = ldexp(1, -n * 4);
      assert_leaves(&world, &ray, world_closest(&world, &across).certainty);
    }
    world_close(&world);
  }
}

/* Nearly all rays meet several patches of the plane, and few meet a border. */
TEST(a_plane_costs_no_last_resort)
{
  struct random random = {SEED + 1};
  struct world world;
  open_flat(&random, 1, 0.7, false, &world);
  for (int n = 0; n < SCENES * RAYS; n++) {
    const struct ray ray = ray_at(&random, 1, 0.7);
    (void)world_closest(&world, &ray);
  }
  assert_true(tracer_counts(world.tracer)->escalated * 100 < SCENES * RAYS);
  world_close(&world);
}
