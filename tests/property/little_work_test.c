/* Scenes on which rays once did far more work than they need: few leaves are tried, and little is left to the last
 * resort. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "method_of.h"
#include "property/world.h"

enum { SEED = 20261122 };

/* ---- stacks of sheets, lines ---- */

/* A sheet bent along u by more than its distance from the next one. */
static void sheet(size_t number, world_net net)
{
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      net[i][j][0] = i - 1.5, net[i][j][1] = j - 1.5;
      net[i][j][2] = 0.4 * (i == 1 || i == 2) - 1e-3 * (double)number;
    }
}

enum { NETS = 300, NET_RAYS = 400 };

/* Rays at the middle of these nets are all certain, and each is tried on at most `few` leaves, on average. */
static void few_are_tried(world_net nets[NETS], double few)
{
  struct random random = {SEED};
  struct world world;
  world_open(&world, nets, NETS, NULL);
  for (int n = 0; n < NET_RAYS; n++) {
    struct ray ray = {.t_max = INFINITY};
    world_towards(&random, (const double[3]){0, 0, 0.2}, 0.8, &ray);
    assert_int_equal(world_closest(&world, &ray).certainty, CERTAINTY_CERTAIN);
  }
  const double tried = (double)tracer_counts(world.tracer)->patches_tested / NET_RAYS;
  assert_true(tried <= few);
  world_close(&world);
}

/* If leaves were as thick as they bend, each would overlap many others. One leaf is met, and hardly another one may be
 * tried: leaves are gone to in the order in which the ray enters the slabs across them. */
TEST(of_a_stack_few_are_tried)
{
  world_net nets[NETS];
  for (size_t n = 0; n < NETS; n++) sheet(n, nets[n]);
  few_are_tried(nets, 1.1);
}

/* A line from one point to another, along v, along u or along both; or a strip far narrower than it is long. */
static void thread(struct random *random, size_t number, world_net net)
{
  double a[3], b[3], off[3];
  for (int k = 0; k < 3; k++) {
    a[k] = random_between(random, -2, 2), b[k] = random_between(random, -2, 2);
    off[k] = (number % 4 == 3) * random_between(random, -1e-11, 1e-11);
  }
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 3; k++) {
        const int at = number % 4 == 1 ? i : number % 4 == 2 ? (i * j) / 3 : j;
        net[i][j][k] = a[k] + at / 3.0 * (b[k] - a[k]) + i * off[k];
      }
}

/* A leaf that is a line has no normal, but a box along it like any other. */
TEST(of_lines_few_are_tried)
{
  world_net nets[NETS];
  struct random random = {SEED};
  for (size_t n = 0; n < NETS; n++) thread(&random, n, nets[n]);
  few_are_tried(nets, 0.1);
}

/* ---- twins ---- */

/* Patches that lie exactly on the first one take no more work than their boxes: a ray has a small budget, and is certain
 * nevertheless. */
TEST(of_twins_none_is_tried)
{
  enum { BUDGET = 1000 + 2 * NETS }; /* what the first one needs is some 500 */
  world_net nets[NETS];
  struct random random = {SEED + 8};
  struct world world;
  for (size_t n = 0; n < NETS; n++) sheet(0, nets[n]);
  world_open(&world, nets, NETS, NULL);
  world.tracer->budget = BUDGET;
  size_t hits = 0;
  for (int n = 0; n < NET_RAYS; n++) {
    struct ray ray = {.t_max = INFINITY};
    world_towards(&random, (const double[3]){0, 0, 0.2}, 0.8, &ray);
    const struct hit hit = world_closest(&world, &ray);
    assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
    if (hit.patch == HIT_NONE) continue;
    assert_int_equal(hit.patch, 0);
    ray.t_max = hit.t / 2, hits++;
    bool occluded;
    tracer_occluded(world.tracer, 1, &ray, &occluded);
    assert_false(occluded);
  }
  assert_true(hits > NET_RAYS / 2);
  world_close(&world);
}

/* ---- points ---- */

/* A patch of equal points is one leaf, however finely it is to be cut: a ray that passes it, as nearly as boxes can
 * tell, meets what is behind, and has a small budget. */
TEST(a_point_takes_little)
{
  world_net nets[2];
  const struct method fine = method_of("bernstein { split 64 }");
  struct world world;
  sheet(0, nets[1]);
  for (int k = 0; k < 16; k++) memcpy(nets[0][k / 4][k % 4], (const double[3]){0.1, 0.3, -1}, sizeof nets[0][0][0]);
  world_open(&world, nets, 2, &fine);
  world.tracer->budget = 1000;
  const struct ray ray = {.origin = {0.1, 0.3, -4}, .direction = {0, 1e-17, 1}, .t_max = INFINITY};
  const struct hit hit = world_closest(&world, &ray);
  assert_int_equal(hit.patch, 1);
  assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
  world_close(&world);
}

/* ---- next to poles ---- */

/* An eighth of a ball as large as a planet, its pole at 0. */
static void eighth(size_t number, double radius, world_net net)
{
  static const double along[4] = {1, 1, 0.5522847498, 0}, up[4] = {0, 0.5522847498, 1, 1};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      net[i][j][0] = (number & 1 ? -radius : radius) * along[i] * along[j];
      net[i][j][1] = (number & 2 ? -radius : radius) * up[i] - radius;
      net[i][j][2] = (number & 4 ? -radius : radius) * along[i] * up[j];
    }
}

static void open_planet(double radius, struct world *world)
{
  world_net nets[8];
  for (size_t n = 0; n < 8; n++) eighth(n, radius, nets[n]);
  world_open(world, nets, 8, NULL);
}

/* From next to a pole, a millionth of the ball away or less, no leaf is seen over whose whole the Jacobian is
 * regular. Little is left to the last resort nevertheless, from above and from the ground up. */
TEST(next_to_poles_little_is_left_open)
{
  enum { PLANET_RAYS = 400 };
  static const double radii[] = {1e3, 1e4, 1e6};
  struct random random = {SEED + 1};
  for (size_t k = 0; k < sizeof radii / sizeof radii[0]; k++) {
    struct world world;
    open_planet(radii[k], &world);
    for (int n = 0; n < PLANET_RAYS; n++) {
      struct ray ray = {.t_max = INFINITY};
      world_towards(&random, (const double[3]){0, -0.1, 0}, 0, &ray);
      ray.origin[1] = random_between(&random, 1, 6);
      const struct hit hit = world_closest(&world, &ray);
      assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
      if (hit.patch == HIT_NONE) continue;
      const struct ray came = ray;
      ray.direction[1] = random_between(&random, 0.1, 1);
      tracer_leave(world.tracer, &came, &hit, ray.direction, ray.origin);
      assert_int_equal(world_closest(&world, &ray).patch, HIT_NONE);
    }
    const uint64_t open = tracer_counts(world.tracer)->escalated;
    assert_in_range(open, 0, PLANET_RAYS);
    world_close(&world);
  }
}

/* Seen from nearby at a slant, the ground next to a pole bends so much that a leaf at the pole may have two roots.
 * Boxes that divide by the distance from the pole show that it has not. */
TEST(next_to_poles_little_is_left_open_aslant)
{
  enum { ASLANT_RAYS = 400 };
  static const double radii[] = {1e2, 1e3, 1e4};
  struct random random = {SEED + 7};
  for (size_t k = 0; k < sizeof radii / sizeof radii[0]; k++) {
    struct world world;
    open_planet(radii[k], &world);
    for (int n = 0; n < ASLANT_RAYS; n++) {
      struct ray ray = {.t_max = INFINITY};
      ray.origin[0] = random_between(&random, -2, 2), ray.origin[1] = random_between(&random, 0.2, 1),
      ray.origin[2] = -2;
      for (int c = 0; c < 3; c++) ray.direction[c] = (c == 1 ? 0 : random_between(&random, -0.8, 0.8)) - ray.origin[c];
      assert_int_equal(world_closest(&world, &ray).certainty, CERTAINTY_CERTAIN);
    }
    const uint64_t open = tracer_counts(world.tracer)->escalated;
    assert_in_range(open, 0, ASLANT_RAYS / 50);
    world_close(&world);
  }
}

/* ---- in a plane ---- */

/* A quarter of a disc round the origin, flat in y = 0, with a pole in its middle. */
static void disc_quarter(size_t number, world_net net)
{
  static const double k = 0.5522847498, arc[4][2] = {{1, 0}, {1, k}, {k, 1}, {0, 1}};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      net[i][j][0] = (number & 1 ? -i : i) * arc[j][0] / 3;
      net[i][j][1] = 0;
      net[i][j][2] = (number & 2 ? -i : i) * arc[j][1] / 3;
    }
}

/* A ray in the plane of a flat patch meets curves, which begin on its borders. */
TEST(of_what_lies_in_a_plane_little_is_looked_at)
{
  enum { PLANE_RAYS = 100, WORK_MOST = 4000 };
  struct random random = {SEED + 7};
  world_net nets[4];
  struct world world;
  uint64_t most = 0;
  for (size_t n = 0; n < 4; n++) disc_quarter(n, nets[n]);
  world_open(&world, nets, 4, NULL);
  for (int n = 0; n < PLANE_RAYS; n++) {
    const double angle = random_between(&random, 0, 4 * acos(0)), off = random_between(&random, 0.1, 0.9);
    const double c = cos(angle), s = sin(angle);
    const struct ray ray = {
      .origin = {-5 * c - off * s, 0, -5 * s + off * c}, .direction = {c, 0, s}, .t_max = INFINITY};
    const uint64_t before = tracer_counts(world.tracer)->work;
    const struct hit_list list = world_all(&world, &ray);
    const uint64_t work = tracer_counts(world.tracer)->work - before;
    most = work > most ? work : most;
    assert_int_equal(list.certainty, CERTAINTY_GRAZING);
    assert_true(list.count > 0);
  }
  assert_in_range(most, 0, WORK_MOST);
  world_close(&world);
}

/* ---- solvers that never end ---- */

/* Near misses of many patches, for solvers that run to their limit of steps on each: a ray's budget ends after
 * a few. */
TEST(solvers_are_charged)
{
  static const char *const names[] = {"aberth { form paper }", "durand_kerner { form paper }", "newton { form paper }",
                                      "laguerre { form paper }"};
  enum { MOST_SOLVED = 40 };
  static world_net nets[NETS];
  for (size_t n = 0; n < NETS; n++)
    for (int k = 0; k < 16; k++) {
      const int i = k / 4, j = k % 4;
      const double at[3] = {i - 0.015 + 1e-4 * (double)n, j - 1.5, (i + j) % 2 ? -3 : 3};
      memcpy(nets[n][i][j], at, sizeof at);
    }
  for (int way = 0; way < 4; way++) {
    struct method method = method_of(names[way]);
    method.roots.tolerance = 1e-300, method.roots.max_iterations = 10000;
    struct world world;
    world_open(&world, nets, NETS, &method);
    const struct ray ray = {.origin = {0, 0, -5}, .direction = {0, 0.01, 1}, .t_max = INFINITY};
    (void)world_closest(&world, &ray);
    const int solved = (int)(tracer_counts(world.tracer)->roots_found / 18);
    assert_in_range(solved, 1, MOST_SOLVED);
    world_close(&world);
  }
}
