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

/* The third root of a line through two points at constant v of a leaf over a plane, where z is a cubic in x. */
static double third_root(const struct subject *s, double v, double u1, double u2)
{
  double c[4];
  for (int i = 0; i < 4; i++) {
    double net[4][4] = {{0}};
    memcpy(net[0], &s->leaf.x[2][4 * (size_t)i], sizeof net[0]);
    c[i] = patch_evaluate(net, 0, v).value;
  }
  const double cubic = c[3] - 3 * c[2] + 3 * c[1] - c[0], square = 3 * (c[2] - 2 * c[1] + c[0]);
  return -square / cubic - u1 - u2;
}

/* Makes such a leaf whose two known roots are, given how much the rest turns, as far apart as they may be beside a
 * third one. With s and t about the middle z is s^3 - 3/4 s^2 and something linear, for roots near s = -1/4 and, twice,
 * s = 1/2. */
static void make_s_shape(struct random *random, struct subject *s)
{
  static const double height[4] = {-15, 5, -11, -15}; /* times 48 */
  const bool mirrored = random_bits(random) % 2;
  const double size = exp2(random_between(random, -6, 0)) / 48;
  do subject_make(random, HALVINGS, ROUGH, s);
  while (!s->over_a_plane);
  s->patch.cut.split[0] = s->patch.cut.split[1] = 1;
  for (int n = 0; n < 16; n++) s->patch.x[2][n / 4][n % 4] = (mirrored ? -size : size) * height[n / 4];
  leaves_make(&s->patch, 0, 0, 1, &s->leaf);
  leaf_quadrics(1, &s->leaf);
}

static void know(struct leaf_root *root, unsigned lane, double u, double v, double w)
{
  root->at.u[lane] = u, root->at.v[lane] = v, root->w[lane] = w;
  root->at.radius_u[lane] = root->at.radius_v[lane] = 0x1p-26; /* the effect of the points' rounding */
}

static void a_third_root_is_never_told_away(void **state)
{
  (void)state;
  struct random random = {SEED + 1};
  const lane_mask all = (lane_mask){0} == 0;
  double most = 0;
  unsigned lost = 0, three = 0, two = 0, closed = 0;
  for (int n = 0; n < 4 * CASES; n++) {
    struct subject s = {.patch = {.scale = 0}};
    struct packet *p = &s.packet;
    struct leaf_root root = {.t = {0}}, second = root;
    lane_mask third = {0};
    const bool s_shape = n % 2;
    if (s_shape) make_s_shape(&random, &s);
    else do
        subject_make(&random, HALVINGS, ROUGH, &s);
      while (!s.over_a_plane);
    for (unsigned lane = 0; lane < LANES; lane++) {
      const double v = random_unit(&random), u = random_unit(&random), other = random_unit(&random);
      const double u1 = s_shape ? 1 - u / 64 : u, u2 = s_shape ? 0.25 + other / 32 : other;
      const double u3 = third_root(&s, v, u1, u2);
      double one[3], two_at[3];
      subject_point(&s, u1, v, one), subject_point(&s, u2, v, two_at);
      const double way = two_at[0] - one[0];
      for (int k = 0; k < 3; k++) {
        p->direction[k][lane] = (two_at[k] - one[k]) / way;
        p->origin[k][lane] = s.patch.center[k] + s.patch.scale * one[k];
      }
      p->t_min[lane] = -INFINITY, p->t_max[lane] = INFINITY;
      const int axis = fabs(p->direction[2][lane]) > 1 ? 2 : 0;
      know(&root, lane, u1, v, one[axis]), know(&second, lane, u2, v, two_at[axis]);
      third[lane] = -(u3 > 0 && u3 < 1);
    }
    root.at.exists = second.at.exists = all;
    subject_look(&s, GRAIN * s.patch.scale);
    for (unsigned axes = p->axes; axes; axes &= axes - 1) {
      struct candidate it = {.leaf = &s.leaf, .patch = &s.patch, .axis = __builtin_ctz(axes)};
      it.line = &p->line[it.axis];
      struct quadric_along along;
      const lane_mask asked = quadric_along(p, &it, p->on_axis[it.axis], &along);
      const lane_mask done = quadric_closes_two(&along, &it, &root, &second, asked);
      const lanes taken = lanes_abs(along.f[2] * (root.w - second.w)) / (2 * along.turn);
      for (unsigned lane = 0; lane < LANES; lane++)
        if (asked[lane] & third[lane]) most = fmax(most, taken[lane]);
      three += lanes_count(asked & third), two += s_shape ? 0 : lanes_count(asked & ~third);
      lost += lanes_count(done & third), closed += s_shape ? 0 : lanes_count(done & ~third);
    }
  }
  print_message(
    "of %u a third root lost %u times; of %u without one %u closed; of what the rest may turn it takes %.3g\n", three,
    lost, two, closed, most);
  assert_int_equal(lost, 0);
  assert_true(most > 0.55);
  assert_true(three > 100 && closed > two / 20);
}

__attribute__((noinline)) static int run(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(another_root_is_never_told_away),
                                     cmocka_unit_test(a_third_root_is_never_told_away)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
