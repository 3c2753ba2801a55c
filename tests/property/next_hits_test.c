/* Rays that leave a hit: they neither meet the surface there nor skip what is next to it. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/vector.h"
#include "property/world.h"

enum { SEED = 20240511, RAYS = 64 };

/* A ray that leaves a hit, to either side, at no flat angle, does not meet the sheet it leaves. The patches' radii
 * of curvature are above 1/100; the sheet is met again no nearer than that times the sine of 0.1. */
TEST(leaving_a_surface_does_not_meet_it)
{
  struct random random = {SEED + 6};
  static const double offsets[] = {0, 1e3, 1e6};
  world_net nets[WORLD_MAX], moved[WORLD_MAX];
  int wrong = 0, left = 0;
  for (int kind = 0; kind < 3; kind++) { /* the wavy one, the wild one and the dome */
    for (int o = 0; o < 3; o++) {
      struct world world;
      const size_t count = world_fill((enum world_kind)kind, &random, nets);
      for (size_t p = 0; p < count; p++) world_scale_net(nets[p], 1, offsets[o], moved[p]);
      world_open(&world, moved, count, NULL);
      for (int n = 0; n < 2 * RAYS; n++) {
        struct ray ray = world_ray(&random, moved, count, n % 3);
        const struct hit hit = world_closest(&world, &ray);
        const double inner = fmin(fmin(hit.u, 1 - hit.u), fmin(hit.v, 1 - hit.v));
        if (hit.patch == HIT_NONE || inner < 0.001) continue; /* at a crease the ray rightly meets the other patch */
        double d[3];
        for (int k = 0; k < 3; k++) d[k] = random_between(&random, -1, 1);
        vector_scale(1 / vector_length(d), d, d);
        const double side = vector_dot(d, hit.normal);
        if (fabs(side) < 0.1) continue;
        struct ray next = {{0}, {d[0], d[1], d[2]}, 0, kind == WORLD_WILD ? 1e-6 : 1e-4};
        tracer_leave(world.tracer, &ray, &hit, d, next.origin);
        const struct hit again = world_closest(&world, &next);
        left++;
        if (again.patch != HIT_NONE && wrong++ < 5) world_print_case("left", kind, &next, &hit, &again);
      }
      world_close(&world);
    }
  }
  assert_true(left > 300);
  assert_int_equal(wrong, 0);
}

/* Two sheets 1e-9 apart are two: leaving the first one, a ray meets the second. */
TEST(a_sheet_right_behind_is_not_skipped)
{
  struct random random = {SEED + 7};
  const double gap = 1e-9;
  for (int scene = 0; scene < 6; scene++) {
    world_net nets[WORLD_MAX];
    struct world world;
    size_t count = world_fill(WORLD_GRID, &random, nets);
    count = 4;
    for (size_t p = 0; p < count; p++) {
      memcpy(nets[count + p], nets[p], sizeof nets[p]);
      for (int n = 0; n < 16; n++) nets[count + p][n / 4][n % 4][2] -= gap;
    }
    world_open(&world, nets, 2 * count, NULL);
    for (int n = 0; n < RAYS; n++) {
      struct ray ray = world_ray(&random, nets, count, n % 2);
      ray.origin[2] = fabs(ray.origin[2]) + 1;
      const struct hit first = world_closest(&world, &ray);
      if (first.patch == HIT_NONE || first.patch >= count || first.normal[2] < 0.3) continue;
      struct ray next = {{0}, {0, 0, -1}, 0, INFINITY};
      tracer_leave(world.tracer, &ray, &first, next.direction, next.origin);
      const struct hit second = world_closest(&world, &next);
      assert_true(second.patch != HIT_NONE && second.patch >= count);
      assert_true(fabs(second.t - gap) < 1e-2 * gap);
    }
    world_close(&world);
  }
}
