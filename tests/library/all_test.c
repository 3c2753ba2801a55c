/* Proves of pscn.h: all hits come in order, as many as there is room for; counts alone; memory may fail. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "library/ball.h"
#include "library/pscn.h"

#include "cmocka_test.h"

enum { SIDE = 40, COUNT = SIDE * SIDE, MOST = 3, BALLS = 4 };

/* Balls in a row along z. A line along z meets each of them twice. */
static struct pscn_scene *make_balls(const struct pscn_options *options)
{
  double points[BALLS][BALL_PATCHES][4][4][3];
  struct pscn_scene *scene;
  for (int ball = 0; ball < BALLS; ball++) {
    ball_points(points[ball]);
    for (int n = 0; n < BALL_PATCHES * 16; n++) points[ball][n / 16][n / 4 % 4][n % 4][2] += 4 * ball;
  }
  (void)pscn_scene_from_points(***points[0], BALLS * BALL_PATCHES, sizeof **points, sizeof(double[3]), options, &scene);
  return scene;
}

static void make_lines(struct pscn_ray rays[COUNT])
{
  for (int n = 0; n < COUNT; n++)
    rays[n] = (struct pscn_ray){
      {(n % SIDE + 0.25) * 2.2 / SIDE - 1.1, (n / SIDE + 0.75) * 2.2 / SIDE - 1.1, -3}, {0, 0, 1}, 0, INFINITY};
}

TEST(test_rows)
{
  static struct pscn_ray rays[COUNT];
  static struct pscn_hits counts[COUNT], alone[COUNT];
  static struct pscn_hit hits[COUNT][MOST], nearest[COUNT];
  struct pscn_scene *scene = make_balls(NULL);
  make_lines(rays);
  rays[7].direction[0] = NAN;
  memset(hits, 0xA5, sizeof hits);
  memset(counts, 0xA5, sizeof counts);
  assert_int_equal(pscn_all(scene, COUNT, rays, sizeof *rays, counts, sizeof *counts, *hits, sizeof *hits, MOST),
                   PSCN_INPUT);
  assert_int_equal(pscn_all(scene, COUNT, rays, sizeof *rays, alone, sizeof *alone, NULL, 0, 0), PSCN_INPUT);
  assert_int_equal(pscn_nearest(scene, COUNT, rays, sizeof *rays, nearest, sizeof *nearest), PSCN_INPUT);
  assert_memory_equal(counts, alone, sizeof counts);
  int through = 0;
  for (int n = 0; n < COUNT; n++) {
    assert_int_equal(counts[n].verdict, nearest[n].verdict);
    assert_memory_equal(&hits[n][0], &nearest[n], offsetof(struct pscn_hit, normal));
    assert_int_equal(hits[n][0].patch, nearest[n].patch);
    if (n == 7) continue;
    assert_int_equal(counts[n].certain, 1);
    const double x = rays[n].origin[0], y = rays[n].origin[1];
    if (hypot(x, y) < 0.99) assert_int_equal(counts[n].count, 2 * BALLS);
    if (hypot(x, y) > 1.01) assert_int_equal(counts[n].count, 0);
    through += counts[n].count > 0;
    for (size_t k = 0; k < MOST; k++) {
      assert_int_equal(hits[n][k].verdict, k < counts[n].count ? PSCN_HIT : PSCN_MISS);
      if (k >= counts[n].count)
        assert_true(isinf(hits[n][k].t) && hits[n][k].patch == PSCN_NO_PATCH && hits[n][k].certain == 1);
      else if (k > 0) assert_true(hits[n][k].t > hits[n][k - 1].t);
    }
  }
  assert_true(through > COUNT / 2);
  /* The third hit is the nearest one behind the second. */
  for (int n = 0; n < COUNT; n += 11) {
    if (counts[n].verdict != PSCN_HIT) continue;
    struct pscn_ray ray = rays[n];
    struct pscn_hit hit;
    ray.t_min = hits[n][1].t + 1e-6;
    assert_int_equal(pscn_nearest(scene, 1, &ray, 0, &hit, 0), PSCN_OK);
    assert_memory_equal(&hit, &hits[n][2], offsetof(struct pscn_hit, normal));
    struct pscn_hits rest;
    assert_int_equal(pscn_all(scene, 1, &ray, 0, &rest, 0, NULL, 0, 0), PSCN_OK);
    assert_int_equal(rest.count, counts[n].count - 2);
  }
  pscn_scene_free(scene);
}

/* If a ray meets the border of an open surface, neither the number nor the hit is proven. */
TEST(test_grazing)
{
  double points[4][4][3];
  for (int n = 0; n < 16; n++)
    points[n / 4][n % 4][0] = n % 4, points[n / 4][n % 4][1] = n / 4, points[n / 4][n % 4][2] = 0;
  const struct pscn_ray rays[] = {{{3, 1, -4}, {0, 0, 1}, 0, INFINITY}, {{2, 1, -4}, {0, 0, 1}, 0, INFINITY}};
  struct pscn_hits counts[2];
  struct pscn_hit hits[2];
  struct pscn_scene *scene;
  assert_int_equal(pscn_scene_from_points(**points, 1, sizeof points, sizeof(double[3]), NULL, &scene), PSCN_OK);
  assert_int_equal(pscn_all(scene, 2, rays, sizeof *rays, counts, sizeof *counts, hits, sizeof *hits, 1), PSCN_OK);
  for (int k = 0; k < 2; k++) {
    assert_true(counts[k].count == 1 && counts[k].verdict == PSCN_HIT && hits[k].verdict == PSCN_HIT);
    assert_true(counts[k].certain == k && hits[k].certain == k);
  }
  pscn_scene_free(scene);
}

TEST(test_arguments)
{
  struct pscn_scene *scene = make_balls(NULL);
  const struct pscn_ray ray = {{0.1, 0.2, -3}, {0, 0, 1}, 0, INFINITY};
  struct pscn_hits count;
  struct pscn_hit hit;
  assert_int_equal(pscn_all(scene, 1, &ray, 0, &count, 0, NULL, 0, 1), PSCN_USAGE);
  assert_int_equal(count.verdict, PSCN_NO_ANSWER);
  hit.verdict = PSCN_HIT;
  assert_int_equal(pscn_all(scene, 1, &ray, 0, NULL, 0, &hit, 0, 1), PSCN_USAGE);
  assert_int_equal(hit.verdict, PSCN_NO_ANSWER);
  hit.verdict = PSCN_HIT;
  assert_int_equal(pscn_all(NULL, 1, &ray, 0, &count, 0, &hit, 0, 1), PSCN_USAGE);
  assert_int_equal(count.verdict, PSCN_NO_ANSWER);
  assert_int_equal(hit.verdict, PSCN_NO_ANSWER);
  assert_int_equal(pscn_all(scene, 0, NULL, 0, NULL, 0, NULL, 0, 0), PSCN_OK);
  pscn_scene_free(scene);
}

/* ---- memory ---- */

struct pool {
  long blocks, asked, fails;
};

static void *pool_resize(void *context, void *block, size_t size)
{
  struct pool *pool = context;
  if (size > 0 && pool->asked++ == pool->fails) return NULL;
  pool->blocks += (size > 0) - (block != NULL);
  if (size > 0) return realloc(block, size);
  free(block);
  return NULL;
}

/* Whatever fails, rays have the same answers or none, and all memory is returned. */
TEST(test_memory)
{
  static struct pscn_ray rays[COUNT];
  static struct pscn_hits as_ever[COUNT], counts[COUNT];
  struct pool pool = {0, 0, -1};
  struct pscn_options options = PSCN_OPTIONS;
  options.memory = (struct pscn_memory){pool_resize, &pool};
  struct pscn_scene *scene = make_balls(&options);
  const long built = pool.blocks;
  make_lines(rays);
  pool.asked = 0;
  assert_int_equal(pscn_all(scene, COUNT, rays, sizeof *rays, as_ever, sizeof *as_ever, NULL, 0, 0), PSCN_OK);
  assert_int_equal(pool.blocks, built);
  const long asked = pool.asked;
  assert_true(asked > 0);
  for (long fails = 0; fails < asked; fails++) {
    struct pscn_hit hit;
    bool answered = true;
    pool.asked = 0, pool.fails = fails;
    memset(counts, 0xA5, sizeof counts);
    assert_int_equal(pscn_all(scene, COUNT, rays, sizeof *rays, counts, sizeof *counts, NULL, 0, 0), PSCN_LIMIT);
    for (int n = 0; n < COUNT; n++) {
      answered &= counts[n].verdict != PSCN_NO_ANSWER;
      const struct pscn_hits none = {0, PSCN_NO_ANSWER, 0};
      assert_memory_equal(&counts[n], answered ? &as_ever[n] : &none, sizeof none);
    }
    assert_false(answered);
    assert_int_equal(pool.blocks, built);
    assert_int_equal(pscn_nearest(scene, 1, rays, 0, &hit, 0), PSCN_OK); /* it needs no memory */
  }
  pscn_scene_free(scene);
  assert_int_equal(pool.blocks, 0);
}
