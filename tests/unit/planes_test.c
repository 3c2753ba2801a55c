/* A leaf's slab, box and plane polynomials to the last places, against rays through points of what the leaf stands for, which is
 * as far from it as it may be: none of them may be told to miss it. Compiled once per instruction set (CMakeLists.txt); where
 * the processor lacks it the test is skipped. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/patch.h"
#include "intersect/lanes/candidate.h"
#include "intersect/prepare/leaf.h"
#include "lanes_main.h"
#include "random.h"

enum { SEED = 20261124, CASES = 20000 };

/* Points are multiples of this part of the patch's scale, and what they are off by is no more than so many of that: origins of
 * rays are exact then. */
#define GRAIN 0x1p-40
#define GRAINS 64

struct subject {
  double rest[3][4][4];
  struct method method;
  struct model_patch patch;
  struct leaf leaf;
  struct packet packet;
};

/* Of any shape, or flat, or slender. */
static void make_leaf(struct random *random, struct subject *s)
{
  const int kind = (int)(random_bits(random) % 3), side = 1 << random_bits(random) % 4;
  method_default(solver_at(0), &s->method);
  s->patch = (struct model_patch){
    .scale = exp2(rint(random_between(random, -30, 30))), .m = 3, .n = 3, .split = {side, side}, .method = &s->method};
  s->patch.rest = (const double(*)[4][4])s->rest;
  for (int k = 0; k < 3; k++) {
    s->patch.center[k] = s->patch.scale * rint(random_between(random, -4, 4));
    for (int n = 0; n < 16; n++) {
      double x = random_between(random, -1, 1);
      if (kind == 1) x = k == 0 ? n / 4 / 4.0 : k == 1 ? n % 4 / 4.0 : (n / 4 - n % 4) / 8.0;
      if (kind == 2) x = (k == 0 ? n / 4 / 2.0 - 0.75 : 0) + x * 0x1p-7;
      s->patch.x[k][n / 4][n % 4] = x;
    }
  }
  leaves_make(&s->patch, 0, (uint32_t)(random_bits(random) % (uint64_t)(side * side)), 1, &s->leaf);
}

/* A direction of few bits: any, or nearly along the leaf. */
static void make_direction(struct random *random, const struct subject *s, double out[3])
{
  const double few = exp2(4 + 4.0 * (double)(random_bits(random) % 3)), a = random_between(random, -1, 1);
  const bool along = random_bits(random) % 2 == 0;
  double most = 0;
  for (int k = 0; k < 3; k++) {
    const double(*base)[3] = s->leaf.parts.base;
    out[k] = along ? a * base[1][k] + (1 - fabs(a)) * base[2][k] : random_between(random, -1, 1);
    most = fmax(most, fabs(out[k]));
  }
  for (int k = 0; k < 3; k++) out[k] = rint(out[k] / most * few) / few;
}

/* Lane `lane` gets a ray that is next to a point of the leaf at t, between its ends. */
static void make_ray(struct random *random, struct subject *s, unsigned lane)
{
  struct packet *p = &s->packet;
  const double t = s->patch.scale * exp2(rint(random_between(random, -3, 3))), grain = s->patch.scale * GRAIN;
  const int from = (int)(random_bits(random) % 3), to = (int)(random_bits(random) % 3);
  double direction[3];
  const double u = fmin(fmax(random_between(random, -0.5, 1.5), 0), 1),
               v = fmin(fmax(random_between(random, -0.5, 1.5), 0), 1);
  make_direction(random, s, direction);
  for (int k = 0; k < 3; k++) {
    double net[4][4];
    memcpy(net, s->leaf.x[k], sizeof net);
    const double off = random_bits(random) % 2 ? GRAINS - 1 : 1 - GRAINS; /* and the rounding to a grain */
    const double point = s->patch.center[k] + s->patch.scale * patch_evaluate(net, u, v).value;
    p->direction[k][lane] = direction[k], p->origin[k][lane] = (rint(point / grain) + off) * grain - t * direction[k];
  }
  p->t_min[lane] = from == 0 ? 0 : from == 1 ? nextafter(t, 0) : 0.5 * t;
  p->t_max[lane] = to == 0 ? INFINITY : to == 1 ? nextafter(t, INFINITY) : 2 * t;
}

static void rays_that_meet_what_it_stands_for_are_not_told_to_miss(void **state)
{
  (void)state;
  struct random random = {SEED};
  unsigned box = 0, slab = 0, planes = 0;
  for (int n = 0; n < CASES; n++) {
    struct subject s = {.patch = {.scale = 0}};
    struct packet *p = &s.packet;
    make_leaf(&random, &s);
    for (unsigned lane = 0; lane < LANES; lane++) make_ray(&random, &s, lane);
    p->live = (lane_mask){0} == 0, p->t_far = p->t_max, p->net_error = GRAINS * GRAIN * s.patch.scale;
    packet_untried(p);
    packet_set_patch(p, &s.patch, 0);
    for (unsigned axes = p->axes; axes; axes &= axes - 1) {
      struct candidate it = {.leaf = &s.leaf, .patch = &s.patch, .axis = __builtin_ctz(axes)};
      const lane_mask here = p->on_axis[it.axis];
      it.line = &p->line[it.axis];
      slab += lanes_count(here & ~stage_slab(p, &it, here));
      box += lanes_count(here & ~stage_box(&it, here));
      planes += lanes_count(here & ~(stage_planes(&it, here) | it.along));
    }
  }
  print_message("%u, %u and %u of %d lost by slab, box and planes\n", slab, box, planes, CASES * LANES);
  assert_int_equal(slab + box + planes, 0);
}

__attribute__((noinline)) static int run(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(rays_that_meet_what_it_stands_for_are_not_told_to_miss)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
