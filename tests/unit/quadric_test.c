/* The claims of a leaf's quadric about a ray hold. Rays go through two or three points as far from the leaf as its
 * error allows. Whichever of these roots are known, the leaf is not closed as long as one is unknown. Compiled once
 * per instruction set (CMakeLists.txt); skipped if the processor lacks it. */
#include "cmocka_test.h"
#include "intersect/lanes/quadric.h"
#include "lanes_main.h"
#include "unit/lane_subject.h"

enum { SEED = 20261125, CASES = 20000 };

/* Points are multiples of this part of the patch's scale, and off by at most GRAINS of them. */
#define GRAIN 0x1p-46
#define GRAINS 64

enum { HALVINGS = 4 };
#define ROUGH 0.2

/* A point in grains, from the patch's center. */
static void make_point(struct random *random, const struct subject *s, double margin, double at[2], double out[3])
{
  for (int k = 0; k < 2; k++) at[k] = fmin(fmax(random_between(random, -0.5, 1.5), -margin), 1 + margin);
  subject_point(s, at[0], at[1], out);
  for (int k = 0; k < 3; k++) {
    const double off = random_bits(random) % 2 ? GRAINS - 1 : 1 - GRAINS; /* leaves room for the rounding to a grain */
    out[k] = rint(out[k] / GRAIN) + off;
  }
}

/* Gives lane `lane` a ray through a point of the leaf, between the ray's ends, and through one of the widened leaf.
 * There is the known root, as far off as its radii allow. */
static void make_ray(struct random *random, struct subject *s, struct leaf_root *root, unsigned lane)
{
  struct packet *p = &s->packet;
  double known[2], other[2], from[3], to[3], way[3], most = 0;
  make_point(random, s, LEAF_MARGIN - 0x1p-20, known, from);
  make_point(random, s, 0, other, to);
  for (int k = 0; k < 3; k++) way[k] = to[k] - from[k], most = fmax(most, fabs(way[k]));
  const double unit = ldexp(1, ilogb(fmax(most, 1))), side = random_bits(random) % 2 ? 1 : -1;
  /* The known root has t = 0, the other one `t`. */
  const double t = side * unit * GRAIN * s->patch.scale, radius = random_bits(random) % 2 ? 0x1p-30 : 0;
  int axis = 0;
  for (int k = 0; k < 3; k++) {
    p->direction[k][lane] = side * way[k] / unit;
    p->origin[k][lane] = s->patch.center[k] + s->patch.scale * GRAIN * from[k];
    if (fabs(way[k]) > fabs(way[axis])) axis = k;
  }
  const int first = (int)(random_bits(random) % 3), last = (int)(random_bits(random) % 3);
  p->t_min[lane] = first == 0 ? -INFINITY : first == 1 ? nextafter(t, -INFINITY) : t - fabs(t);
  p->t_max[lane] = last == 0 ? INFINITY : last == 1 ? nextafter(t, INFINITY) : t + fabs(t);
  root->at.u[lane] = known[0], root->at.v[lane] = known[1];
  root->at.radius_u[lane] = root->at.radius_v[lane] = radius;
  const double off = random_bits(random) % 2 ? radius : -radius;
  root->w[lane] = from[axis] * GRAIN + off * (s->leaf.first[0] + s->leaf.first[1]);
}

static void another_root_is_never_told_away(void **state)
{
  (void)state;
  struct random random = {SEED};
  const lane_mask all = (lane_mask){0} == 0;
  unsigned besides = 0, alone = 0, elsewhere = 0, tried = 0;
  for (int n = 0; n < CASES; n++) {
    struct subject s = {.patch = {.scale = 0}};
    struct packet *p = &s.packet;
    struct leaf_root root = {.t = {0}};
    subject_make(&random, HALVINGS, ROUGH, &s);
    for (unsigned lane = 0; lane < LANES; lane++) make_ray(&random, &s, &root, lane);
    subject_look(&s, GRAINS * GRAIN * s.patch.scale);
    for (unsigned axes = p->axes; axes; axes &= axes - 1) {
      struct candidate it = {.leaf = &s.leaf, .patch = &s.patch, .axis = __builtin_ctz(axes)};
      const lane_mask here = p->on_axis[it.axis];
      it.line = &p->line[it.axis];
      struct quadric_along along;
      const lane_mask asked = quadric_along(p, &it, here, &along);
      root.at.exists = all;
      besides += lanes_count(quadric_closes(&along, &it, &root, asked));
      root.at.exists = ~all;
      alone += lanes_count(quadric_closes(&along, &it, &root, asked));
      /* not vacuous: if the ray's ends exclude the other root, much is closed */
      const lanes end = p->t_max;
      root.at.exists = all, p->t_max = lanes_min(p->t_max, lanes_all(0));
      tried += lanes_count(asked), quadric_along(p, &it, here, &along);
      elsewhere += lanes_count(quadric_closes(&along, &it, &root, asked));
      /* the ray's nearest hit so far must not matter: otherwise last places would show which leaf came first */
      p->t_max = end, p->t_far = lanes_min(p->t_far, lanes_all(0));
      quadric_along(p, &it, here, &along);
      besides += lanes_count(quadric_closes(&along, &it, &root, asked));
      p->t_far = end;
    }
  }
  print_message("of %u a second root lost %u times, an only one %u times; %u closed with other ends\n", tried, besides,
                alone, elsewhere);
  assert_int_equal(besides + alone, 0);
  assert_true(elsewhere > tried / 20);
}

/* ---- three roots ---- */

__attribute__((noinline)) static int run(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(another_root_is_never_told_away)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
