/* Rays from very far away: the errors of their planes in doubles are within the bound. */
#include <math.h>

#include "base/wide.h"
#include "cmocka_test.h"
#include "intersect/local_ray.h"
#include "random.h"
#include "worse.h"

enum { SEED = 20240607, RAYS = 2000 };

/* (q_i d_k - q_k d_i)/d_k in wide arithmetic, q being the origin in the patch's frame. Right to a hundredth of the
 * error in doubles. */
static wide moment(const struct model_patch *patch, const struct ray *ray, int i, int k)
{
  const double *d = ray->direction, *o = ray->origin;
  const wide qi = (wide)o[i] - patch->center[i], qk = (wide)o[k] - patch->center[k];
  return (qi * d[k] - qk * d[i]) / d[k] / patch->scale;
}

/* The error of a plane in doubles, in units of its bound, if the ray comes from 2^65 patches away. The patch lies where
 * rounding has put the ray. */
static double off_in_doubles(struct random *random)
{
  struct model_patch patch = {.scale = 0x1p-40};
  struct ray ray = {.t_max = INFINITY};
  struct local_ray local;
  double off = 0;
  const double way = random_between(random, 0x1p24, 0x1p25);
  for (int k = 0; k < 3; k++) {
    ray.direction[k] = random_between(random, -1, 1), ray.origin[k] = -way * ray.direction[k];
    patch.center[k] = fma(way, ray.direction[k], ray.origin[k]) + random_between(random, -0.5, 0.5) * patch.scale;
  }
  local_ray_make(&patch, &ray, &local);
  for (int s = 0; s < 2; s++)
    off = worse(off, fabs((double)(moment(&patch, &ray, (local.axis + 1 + s) % 3, local.axis) - local.moment[s])));
  return off / local.error;
}

TEST(planes_in_doubles)
{
  struct random random = {SEED};
  double most = 0;
  for (int n = 0; n < RAYS; n++) most = worse(most, off_in_doubles(&random));
  print_message("off by no more than %.3g of the bound\n", most);
  assert_true(most <= 1 && most > 0.01); /* not vacuous: 0.178 */
}
