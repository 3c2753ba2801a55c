/* The next hit of a ray: all hits along it, from both ends; within intervals of t; on leaving a surface. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/vector.h"
#include "property/world.h"

enum { SEED = 20240511, SCENES = 2, RAYS = 64 };

/* Finds all hits along a ray by continuing from each hit's t. */
static int all_hits(const struct world *world, struct ray ray, struct hit hits[], int most, bool *certain)
{
  int count = 0;
  for (*certain = true; count < most; count++) {
    hits[count] = world_closest(world, &ray);
    *certain &= hits[count].certainty == CERTAINTY_CERTAIN;
    if (hits[count].patch == HIT_NONE) break;
    ray.t_min = hits[count].t + 1e-12 * fmax(1, fabs(hits[count].t));
  }
  return count;
}

/* Whether one of the hits is next to a border: the way back is another line, which may pass an open border by. */
static bool next_to_border(const struct hit hits[], int count)
{
  for (int k = 0; k < count; k++)
    if (fmin(fmin(hits[k].u, 1 - hits[k].u), fmin(hits[k].v, 1 - hits[k].v)) < 1e-9) return true;
  return false;
}

TEST(intervals_of_t_are_respected)
{
  struct random random = {SEED + 4};
  world_net nets[WORLD_MAX];
  int wrong = 0, counted = 0;
  for (int kind = 0; kind < WORLD_KINDS; kind++) {
    for (int scene = 0; scene < SCENES; scene++) {
      struct world world;
      const size_t count = world_fill((enum world_kind)kind, &random, nets);
      world_open(&world, nets, count, NULL);
      for (int n = 0; n < RAYS; n++) {
        /* No tangents: the way back starts at a rounded point; being another line, it may meet no surface there. */
        if (n % RAY_KINDS == 3 || n % RAY_KINDS == 5 || n % RAY_KINDS == 6) continue;
        struct ray ray = world_ray(&random, nets, count, n % RAY_KINDS), part = ray, back = ray;
        struct hit forward[40], backward[40];
        bool certain, certain_back;
        const int hits = all_hits(&world, ray, forward, 40, &certain);
        if (hits == 0) continue;
        /* Just before the first hit and just after it, always within the interval asked for. */
        part.t_max = forward[0].t * (1 - 1e-9);
        const struct hit before = world_closest(&world, &part);
        part.t_max = forward[0].t * (1 + 1e-9);
        const struct hit after = world_closest(&world, &part);
        part.t_max = forward[0].t;
        const struct hit at = world_closest(&world, &part);
        if (certain && (before.patch != HIT_NONE || after.patch == HIT_NONE || after.t != forward[0].t) && wrong++ < 5)
          world_print_case("interval", kind, &part, &forward[0], before.patch != HIT_NONE ? &before : &after);
        if (at.patch != HIT_NONE && !(at.t > 0 && at.t < part.t_max) && wrong++ < 5)
          world_print_case("t_max", kind, &part, &at, &at);
        for (int k = 0; k < hits; k++) assert_true(forward[k].t > 0 && (k == 0 || forward[k].t > forward[k - 1].t));
        /* The same points, from the other end. */
        const double end = forward[hits - 1].t + 1;
        vector_add_scaled(ray.origin, end, ray.direction, back.origin);
        vector_scale(-1, ray.direction, back.direction);
        back.t_max = end;
        const int seen = all_hits(&world, back, backward, 40, &certain_back);
        if (!certain || !certain_back || next_to_border(forward, hits) || next_to_border(backward, seen)) continue;
        counted++;
        bool same = seen == hits;
        for (int k = 0; same && k < hits; k++) {
          const struct hit *f = &forward[k], *b = &backward[hits - 1 - k];
          const double length = vector_length(ray.direction),
                       steep = fabs(vector_dot(ray.direction, f->normal)) / length;
          /* The other origin is rounded, so the line differs by some units of the last place. */
          same = fabs(f->t + b->t - end) * steep * steep <= 1e-12 * fmax(1, end);
        }
        if (!same && wrong++ < 5) {
          world_print_case("backwards", kind, &ray, &forward[0], &backward[0]);
          for (int k = 0; k < hits; k++) print_message("  forward %.17g on %u\n", forward[k].t, forward[k].patch);
          for (int k = 0; k < seen; k++)
            print_message("  backward %.17g on %u\n", end - backward[k].t, backward[k].patch);
        }
      }
      world_close(&world);
    }
  }
  print_message("%d rays walked both ways\n", counted);
  assert_true(counted > 150);
  assert_int_equal(wrong, 0);
}

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
  print_message("%d rays left\n", left);
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

int main(void)
{
  print_message("seed %d\n", SEED);
  return test_run();
}
