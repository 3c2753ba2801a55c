/* Rays at a ball of patches and their answers, for tests of the library. */
#ifndef TESTS_LIBRARY_BALL_RAYS_H
#define TESTS_LIBRARY_BALL_RAYS_H

#include <math.h>

#include "library/ball.h"
#include "library/pscn.h"

#include "cmocka_test.h"

enum { COUNT = 500 };

/* What the tests of a program share: rays at a ball, and their nearest hits. */
static struct ball {
  struct pscn_scene *scene;
  struct pscn_ray ray[COUNT];
  struct pscn_hit hit[COUNT];
} ball;

static inline double random_unit(uint64_t *seed)
{
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) * 0x1p-53;
}

static inline struct pscn_scene *make_ball(void)
{
  double points[BALL_PATCHES][4][4][3];
  struct pscn_scene *scene;
  ball_points(points);
  assert_int_equal(pscn_scene_from_points(**points[0], BALL_PATCHES, sizeof *points, sizeof ***points, NULL, &scene),
                   PSCN_OK);
  return scene;
}

/* Rays of all directions from around the ball and from within; some at its poles and seams. */
static void make_rays(void)
{
  uint64_t seed = 1;
  for (int n = 0; n < COUNT; n++) {
    struct pscn_ray *ray = &ball.ray[n];
    for (int k = 0; k < 3; k++) {
      const double reach = n % 5 == 0 ? 0.5 : 1.25,
                   at = n % 7 == 0 && k != 1 ? 0 : reach * (2 * random_unit(&seed) - 1);
      ray->origin[k] = n % 5 == 0 ? at : 6 * random_unit(&seed) - 3;
      ray->direction[k] = at - (n % 5 == 0 ? 0.1 : ray->origin[k]);
    }
    ray->t_min = 0;
    ray->t_max = INFINITY;
  }
  ball.scene = make_ball();
  assert_int_equal(pscn_nearest(ball.scene, COUNT, ball.ray, sizeof *ball.ray, ball.hit, sizeof *ball.hit), PSCN_OK);
}

/* Runs the tests with them. */
static int test_run_with_rays(void)
{
  make_rays();
  const int failed = test_run();
  pscn_scene_free(ball.scene);
  return failed;
}

#endif
