/* A leaf's slab and the pieces that cover it are right to the last places. Rays go through points as far from the leaf
 * as its error allows; none of them may be reported to miss it. Compiled once per instruction set (CMakeLists.txt);
 * skipped if the processor lacks it. */
#include "cmocka_test.h"
#include "intersect/lanes/candidate.h"
#include "lanes_main.h"
#include "unit/lane_subject.h"

enum { SEED = 20261124, CASES = 20000 };

/* Points are multiples of this part of the patch's scale, so that origins of rays are exact. They are off by at most
 * GRAINS of them. */
#define GRAIN 0x1p-40
#define GRAINS 64

/* A direction of few bits: any one, or nearly along the leaf. */
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

/* Gives lane `lane` a ray next to a point of the leaf, which lies at t, between the ray's ends. */
static void make_ray(struct random *random, struct subject *s, unsigned lane)
{
  struct packet *p = &s->packet;
  const double t = s->patch.scale * exp2(rint(random_between(random, -3, 3))), grain = s->patch.scale * GRAIN;
  const int from = (int)(random_bits(random) % 3), to = (int)(random_bits(random) % 3);
  double direction[3], point[3];
  double uv[2];
  for (int k = 0; k < 2; k++) { /* on a border, next to one, or anywhere */
    const double near = random_bits(random) % 2 ? exp2(-random_between(random, 1, 40)) : random_unit(random);
    uv[k] = random_bits(random) % 4 == 0 ? 0 : near;
    if (random_bits(random) % 2) uv[k] = 1 - uv[k];
  }
  make_direction(random, s, direction);
  subject_point(s, uv[0], uv[1], point);
  for (int k = 0; k < 3; k++) {
    const double off = random_bits(random) % 2 ? GRAINS - 1 : 1 - GRAINS; /* leaves room for the rounding to a grain */
    const double at = s->patch.center[k] + s->patch.scale * point[k];
    p->direction[k][lane] = direction[k], p->origin[k][lane] = (rint(at / grain) + off) * grain - t * direction[k];
  }
  p->t_min[lane] = from == 0 ? 0 : from == 1 ? nextafter(t, 0) : 0.5 * t;
  p->t_max[lane] = to == 0 ? INFINITY : to == 1 ? nextafter(t, INFINITY) : 2 * t;
}

static void rays_that_meet_what_it_stands_for_are_not_told_to_miss(void **state)
{
  (void)state;
  static struct postponed postponed;
  struct random random = {SEED};
  unsigned slab = 0, pieces = 0;
  for (int n = 0; n < CASES; n++) {
    struct subject s = {.patch = {.scale = 0}, .packet = {.postponed = &postponed}};
    struct packet *p = &s.packet;
    subject_make(&random, 3, 0, &s);
    s.leaf.parts.last_step = -1; /* no root is proven, or a piece that has one might be done with */
    for (unsigned lane = 0; lane < LANES; lane++) make_ray(&random, &s, lane);
    subject_look(&s, GRAINS * GRAIN * s.patch.scale);
    for (unsigned axes = p->axes; axes; axes &= axes - 1) {
      struct candidate it = {.leaf = &s.leaf, .patch = &s.patch, .axis = __builtin_ctz(axes)};
      const lane_mask here = p->on_axis[it.axis];
      it.line = &p->line[it.axis];
      slab += lanes_count(here & ~stage_slab(p, &it, here));
      pieces += lanes_count(cover_proves(p, &it, COVER_HALVINGS, here));
    }
  }
  print_message("%u and %u of %d lost by slab and pieces\n", slab, pieces, CASES * LANES);
  assert_int_equal(slab + pieces, 0);
}

__attribute__((noinline)) static int run(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(rays_that_meet_what_it_stands_for_are_not_told_to_miss)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
