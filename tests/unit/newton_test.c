/* Roots on a leaf, and beside it: a proven root is within its radii, however the points are off within their bounds.
 * Compiled once per instruction set (CMakeLists.txt); skipped if the processor lacks it. */
#include "cmocka_test.h"
#include "intersect/lanes/candidate.h"
#include "lanes_main.h"
#include "quad_root.h"
#include "unit/lane_subject.h"
#include "worse.h"

enum { SEED = 20261126, CASES = 600 };

/* As far beside the leaf as a root may exist. */
#define BESIDE (LEAF_MARGIN - CERTIFICATE_REACH - 0x1p-12)

/* Makes a patch that is one leaf, near a parallelogram. */
static void make_patch(struct random *random, struct subject *s)
{
  double along[2][3];
  const double bend = pow(2, -random_between(random, 4, 40));
  method_default(solver_at(0), &s->method);
  s->patch = (struct model_patch){.scale = 1, .cut = {.split = {1, 1}}, .method = &s->method};
  s->patch.rest = (const double(*)[4][4])s->rest;
  for (int k = 0; k < 3; k++) {
    for (int side = 0; side < 2; side++) along[side][k] = random_between(random, -0.4, 0.4);
    for (int n = 0; n < 16; n++)
      s->patch.x[k][n / 4][n % 4] = along[0][k] * (n / 4 / 1.5 - 1) + along[1][k] * (n % 4 / 1.5 - 1) +
                                    bend * random_between(random, -0.1, 0.1);
  }
  leaf_make(&s->patch, 0, 0, &s->leaf);
}

/* A parameter on either side of the leaf, or in it. */
static double place(struct random *random)
{
  const int kind = (int)(random_bits(random) % 3);
  return kind == 0 ? -BESIDE : kind == 1 ? 1 + BESIDE : random_between(random, 0, 1);
}

/* Errors of coefficients, of size `error`, with the signs that move the value at (u,v) farthest. */
static double off_at(int i, double u, double error) { return u < 0 || u > 1 ? (i % 2 ? -error : error) : error; }

/* The polynomials, over the leaf, of the exact ray in this lane, with points that are off by `error`. */
static void truth_make(const struct subject *s, unsigned lane, const double at[2], const double error[3],
                       struct quad_net truth[2])
{
  const struct packet *p = &s->packet;
  const int k = packet_axis(p, lane);
  quad x[3][16];
  for (int c = 0; c < 3; c++)
    for (int n = 0; n < 16; n++)
      x[c][n] = (quad)s->leaf.x[c][n] + off_at(n / 4, at[0], 1) * off_at(n % 4, at[1], error[c]);
  for (int plane = 0; plane < 2; plane++) {
    const int i = (k + 1 + plane) % 3;
    const quad slope = (quad)p->direction[i][lane] / p->direction[k][lane];
    const quad moment = (quad)p->origin[i][lane] - slope * p->origin[k][lane];
    for (int n = 0; n < 16; n++) truth[plane].c[n / 4][n % 4] = x[i][n] - moment - slope * x[k][n];
  }
}

static void make_ray(struct random *random, struct subject *s, const double at[2], unsigned lane)
{
  struct packet *p = &s->packet;
  double point[3];
  subject_point(s, at[0], at[1], point);
  for (int k = 0; k < 3; k++) {
    p->direction[k][lane] = random_bits(random) % 2 ? random_between(random, -1, 1) : random_bits(random) % 2 ? 1 : -1;
    p->origin[k][lane] = point[k] - p->direction[k][lane];
  }
  p->t_min[lane] = 0, p->t_max[lane] = INFINITY;
}

/* How far the lane's proven root, which was aimed at `at`, is off at most, in its radii, if the points are off by
 * `error`. */
static double farthest(const struct subject *s, const struct newton_root *root, unsigned lane, const double at[2],
                       double error)
{
  double most = 0;
  for (int signs = 0; signs < 8; signs++) {
    const double off[3] = {signs & 1 ? error : -error, signs & 2 ? error : -error, signs & 4 ? error : -error};
    struct quad_net truth[2];
    quad u = root->u[lane], v = root->v[lane];
    truth_make(s, lane, at, off, truth);
    assert_true(quad_root(truth, &u, &v));
    most = worse(most, worse((double)quad_abs(u - root->u[lane]) / root->radius_u[lane],
                             (double)quad_abs(v - root->v[lane]) / root->radius_v[lane]));
  }
  return most;
}

static void a_proven_root_is_within_its_radii(void **state)
{
  (void)state;
  struct random random = {SEED};
  int proven = 0, beside = 0;
  double most = 0, most_beside = 0;
  for (int n = 0; n < CASES; n++) {
    struct subject s = {.patch = {.scale = 0}};
    struct packet *p = &s.packet;
    double at[LANES][2];
    const double error = pow(2, -random_between(&random, 14, 50));
    make_patch(&random, &s);
    for (unsigned lane = 0; lane < LANES; lane++) {
      at[lane][0] = place(&random), at[lane][1] = place(&random);
      make_ray(&random, &s, at[lane], lane);
    }
    subject_look(&s, error);
    for (unsigned axes = p->axes; axes; axes &= axes - 1) {
      const int axis = __builtin_ctz(axes);
      const lanes start[2] = {lanes_all(0), lanes_all(0)};
      struct leaf_root root;
      newton_solve(p, &s.leaf, axis, start, p->on_axis[axis], &root);
      for (unsigned bits = lanes_bits(root.at.exists & p->on_axis[axis]); bits; bits &= bits - 1) {
        const unsigned lane = (unsigned)__builtin_ctz(bits);
        const bool both = (root.at.u[lane] < 0 || root.at.u[lane] > 1) && (root.at.v[lane] < 0 || root.at.v[lane] > 1);
        const double part = farthest(&s, &root.at, lane, at[lane], error);
        proven++, beside += both;
        if (both) most_beside = worse(most_beside, part);
        else most = worse(most, part);
      }
    }
  }
  print_message("%d proven, %d of them next to a corner; off by %.3g of the radius, there %.3g\n", proven, beside, most,
                most_beside);
  assert_true(proven > CASES && beside > CASES / 8);
  assert_true(most <= 1 && most_beside <= 1);
  assert_true(most > 0.25); /* not vacuous */
}

__attribute__((noinline)) static int run(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_proven_root_is_within_its_radii)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
