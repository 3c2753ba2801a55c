/* The box along a leaf, in floats, is missed by no ray through a point of the leaf, wherever the ray starts and
 * however large the leaf's tree is. Compiled once per instruction set (CMakeLists.txt); skipped if the processor
 * lacks it. */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "intersect/lanes/view.h"
#include "lanes_main.h"
#include "unit/lane_subject.h"

enum { SEED = 20261123, CASES = 20000 };

struct viewed {
  struct subject s; /* but for its packet */
  struct model_tree tree;
  double error; /* how far the true surface may be from the leaf */
  struct oriented_box box;
  struct packet packet[PACKETS];
  struct view view;
};

static double power(struct random *random, double least, double most)
{
  return exp2(rint(random_between(random, least, most)));
}

/* On corners and borders, which the slabs reach, as often as between them. */
static double parameter(struct random *random)
{
  const double t = random_between(random, -0.5, 1.5);
  return t < 0 ? 0 : t > 1 ? 1 : t;
}

/* The largest distance of a control point from the sixth one, in one coordinate: at least half of the extent. */
static double leaf_size(const struct viewed *s)
{
  double size = 0;
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 16; i++) size = fmax(size, s->s.patch.scale * fabs(s->s.leaf.x[k][i] - s->s.leaf.x[k][5]));
  return size;
}

/* Makes a leaf of any shape, exact, or off by up to an eighth of its size. */
static void make_leaf(struct random *random, bool off, struct viewed *s)
{
  subject_make(random, 5, 0, &s->s);
  /* a tree that holds it, not much larger, or far larger */
  s->tree.frame = exp2(ceil(log2(leaf_size(s)))) * power(random, 1, 14);
  for (int k = 0; k < 3; k++)
    s->tree.origin[k] = s->s.patch.center[k] + s->s.patch.scale * s->s.leaf.x[k][5] +
                        s->tree.frame * random_between(random, -0.25, 0.25);
  s->error = off ? leaf_size(s) * power(random, -20, -3) : 0;
  leaf_orient(&s->tree, s->error, &s->s.patch, s->s.leaf.slab, &s->box);
}

/* Ray `number` goes through a point of the leaf that is off by up to its error, moved aside by `aside` across the ray.
 * *out_t is where it is met. */
static void make_ray(struct random *random, struct viewed *s, unsigned number, double aside, double *out_t)
{
  const double u = parameter(random), v = parameter(random);
  const double scale = power(random, -10, 10), away = s->tree.frame * power(random, -20, 24);
  struct packet *p = &s->packet[number / LANES];
  const unsigned lane = number % LANES;
  double direction[3], square = 0;
  for (int k = 0; k < 3; k++) direction[k] = random_between(random, -1, 1), square += direction[k] * direction[k];
  if (random_bits(random) % 4 == 0) direction[random_bits(random) % 3] *= 0x1p-40;
  *out_t = away / scale / sqrt(square);
  const double across[3] = {direction[1], -direction[0], 0};
  double at[3];
  subject_point(&s->s, u, v, at);
  for (int k = 0; k < 3; k++) {
    const double off = s->error > 0 ? s->error * random_between(random, -1, 1) : 0;
    const double point = s->s.patch.center[k] + s->s.patch.scale * at[k] + off;
    p->direction[k][lane] = scale * direction[k];
    p->origin[k][lane] = point + aside * across[k] / sqrt(square) - *out_t * p->direction[k][lane];
  }
  p->t_min[lane] = random_bits(random) % 2 ? 0 : *out_t * random_between(random, 0, 1);
  p->t_max[lane] = random_bits(random) % 2 ? INFINITY : *out_t * random_between(random, 1 + 0x1p-50, 2);
}

static void look(struct viewed *s)
{
  for (int h = 0; h < PACKETS; h++) {
    struct packet *p = &s->packet[h];
    p->count = LANES, p->t_far = p->t_max;
    packet_untried(p);
  }
  view_set(&s->view, s->packet, PACKETS, &s->tree);
  view_set_ends(&s->view, s->packet, PACKETS);
}

static void rays_that_meet_the_leaf_pass_its_box(void **state)
{
  (void)state;
  struct random random = {SEED};
  for (int n = 0; n < CASES; n++) {
    struct viewed s = {.packet = {{.t_error = {0}}}};
    double t[FLOAT_LANES];
    make_leaf(&random, n % 2 == 1, &s);
    for (unsigned k = 0; k < FLOAT_LANES; k++) make_ray(&random, &s, k, 0, &t[k]);
    look(&s);
    const unsigned all = view_oriented(&s.view, &s.box);
    for (unsigned k = 0; k < FLOAT_LANES; k++) {
      if ((all >> k & 1) && view_oriented_one(&s.view, k, &s.box)) continue;
      fail_msg("case %d, ray %u, met at %g", n, k, t[k]);
    }
  }
}

/* Rays pass the leaf by at about three times its size, in a tree not much larger than the leaf. */
static void rays_that_do_not_are_told(void **state)
{
  (void)state;
  struct random random = {SEED + 1};
  int asked = 0, told = 0, alike = 0;
  for (int n = 0; n < CASES / 4; n++) {
    struct viewed s = {.packet = {{.t_error = {0}}}};
    double t[FLOAT_LANES];
    make_leaf(&random, false, &s);
    for (unsigned k = 0; k < FLOAT_LANES; k++) make_ray(&random, &s, k, 6 * leaf_size(&s), &t[k]);
    look(&s);
    const unsigned all = view_oriented(&s.view, &s.box);
    for (unsigned k = 0; k < FLOAT_LANES; k++) {
      const struct packet *p = &s.packet[k / LANES];
      double far = 0;
      for (int c = 0; c < 3; c++) far = fmax(far, fabs(p->origin[c][k % LANES] - s.tree.origin[c]));
      if (far > 16 * s.tree.frame) continue;
      asked++, told += !(all >> k & 1), alike += (all >> k & 1) == view_oriented_one(&s.view, k, &s.box);
    }
  }
  print_message("%d of %d told, %d alike by themselves\n", told, asked, alike);
  assert_true(asked > CASES / 4 && told > asked * 9 / 10 && alike > asked * 999 / 1000);
}

static void rays_that_end_before_are_told(void **state)
{
  (void)state;
  struct random random = {SEED + 2};
  int asked = 0, told = 0;
  for (int n = 0; n < CASES / 4; n++) {
    struct viewed s = {.packet = {{.t_error = {0}}}};
    double t[FLOAT_LANES];
    make_leaf(&random, false, &s);
    for (unsigned k = 0; k < FLOAT_LANES; k++) {
      make_ray(&random, &s, k, 0, &t[k]);
      s.packet[k / LANES].t_min[k % LANES] = 0, s.packet[k / LANES].t_max[k % LANES] = 0.25 * t[k];
    }
    look(&s);
    const unsigned all = view_oriented(&s.view, &s.box);
    for (unsigned k = 0; k < FLOAT_LANES; k++) {
      const struct packet *p = &s.packet[k / LANES];
      /* crosses the slab steeply, on a way much longer than the box */
      double across = 0;
      for (int c = 0; c < 3; c++) across += s.s.leaf.slab[0].g[c] * p->direction[c][k % LANES] * t[k];
      if (!(fabs(across) > 8 * s.s.patch.scale * s.s.leaf.slab[0].half) || !(fabs(across) > 0x1p-8 * s.tree.frame))
        continue;
      if (fabs(t[k] * p->longest[k % LANES]) > 8 * s.tree.frame) continue;
      asked++, told += !(all >> k & 1);
    }
  }
  print_message("%d of %d told\n", told, asked);
  assert_true(asked > CASES / 20 && told > asked * 9 / 10);
}

__attribute__((noinline)) static int run(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(rays_that_meet_the_leaf_pass_its_box),
    cmocka_unit_test(rays_that_do_not_are_told),
    cmocka_unit_test(rays_that_end_before_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
