/* Normals of certain hits next to poles, where Su x Sv nearly vanishes, agree with quadruple precision at the same
 * place. Next to poles whose points were rounded one by one, they agree with the normals of the pole. */
#include <math.h>
#include <string.h>

#include "reference/quad.h"

#include "cmocka_test.h"
#include "random.h"
#include "world.h"
#include "worse.h"

enum { SEED = 20261126, PATCHES = 400, RAYS = 32, FARTHEST = 36 };

/* How much a normal may be off: intersect/local_ray.h. */
#define SURE 0x1p-18

/* Kinds of poles: a border is one point; so is the row behind it; or part of that row. */
enum { ONE_ROW, TWO_ROWS, ROW_IN_PART, KINDS };

static void pole(struct random *random, int kind, world_net net)
{
  for (int n = 0; n < 48; n++) net[n / 12][n / 3 % 4][n % 3] = random_between(random, -1, 1);
  for (int j = 1; j < 4; j++) memcpy(net[0][j], net[0][0], sizeof net[0][0]);
  for (int j = 0; j < 4 && kind == TWO_ROWS; j++) memcpy(net[1][j], net[0][0], sizeof net[0][0]);
  if (kind == ROW_IN_PART) memcpy(net[1][2], net[1][1], sizeof net[1][1]);
}

/* S, and Su x Sv scaled to unit length. */
static void surface(world_net net, double u, double v, double at[3], double normal[3])
{
  struct quad_jet jet[3];
  quad n[3];
  for (int c = 0; c < 3; c++) {
    struct quad_net of;
    for (int k = 0; k < 16; k++) of.c[k / 4][k % 4] = net[k / 4][k % 4][c];
    jet[c] = quad_net_jet(&of, u, v), at[c] = (double)jet[c].value;
  }
  for (int c = 0; c < 3; c++) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    n[c] = jet[i].du * jet[j].dv - jet[j].du * jet[i].dv;
  }
  const quad length = quad_sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int c = 0; c < 3; c++) normal[c] = (double)(n[c] / length);
}

/* How far the hit's normal, of either sign, is from the net's normal there. */
static double normal_off(world_net net, const struct hit *hit, double u)
{
  double at[3], normal[3], facing = 0, off = 0;
  surface(net, u, hit->v, at, normal);
  for (int c = 0; c < 3; c++) facing += normal[c] * hit->normal[c];
  for (int c = 0; c < 3; c++) off = worse(off, fabs(hit->normal[c] - copysign(normal[c], facing * normal[c])));
  return off;
}

TEST(normals_next_to_poles_are_those_of_the_surface)
{
  struct random random = {SEED};
  int certain[KINDS] = {0};
  for (int n = 0; n < PATCHES; n++) {
    world_net net[1];
    struct world world;
    pole(&random, n % KINDS, net[0]);
    world_open(&world, net, 1, NULL);
    for (int k = 0; k < RAYS; k++) {
      struct ray ray = {.t_max = INFINITY};
      double at[3], normal[3];
      const double u = ldexp(random_between(&random, 0.5, 1), -1 - k * FARTHEST / RAYS);
      surface(net[0], u, random_between(&random, 0.1, 0.9), at, normal);
      for (int c = 0; c < 3; c++)
        ray.origin[c] = random_between(&random, -3, 3), ray.direction[c] = at[c] - ray.origin[c];
      const struct hit hit = world_closest(&world, &ray);
      if (hit.patch == HIT_NONE || hit.certainty != CERTAINTY_CERTAIN) continue;
      if (hit.u == 0) continue; /* from here a cusp's end is its point; Su x Sv is 0 there */
      certain[n % KINDS]++;
      const double off = normal_off(net[0], &hit, hit.u);
      if (!(off <= SURE)) fail_msg("kind %d, u %.3g v %.3g: the normal is off by %.2g", n % KINDS, hit.u, hit.v, off);
    }
    world_close(&world);
  }
  for (int k = 0; k < KINDS; k++) assert_true(certain[k] > PATCHES / KINDS * RAYS / 4);
}

enum { ROUNDED_POLES = 600, MOST_AWAY = 20, MOST_EXPONENT = 700 };

/* A pole at 0, as on a ball; its numbers have room to be moved by up to MOST_AWAY. */
static void cap(struct random *random, world_net net)
{
  double to[3][3];
  for (int n = 0; n < 9; n++) to[n / 3][n % 3] = random_between(random, -1, 1);
  for (int n = 0; n < 48; n++) {
    const int i = n / 12, j = n / 3 % 4, c = n % 3;
    const double r = i / 3.0, x = r * cos(j / 2.0), y = r * sin(j / 2.0), z = i > 1 ? -r * r : 0;
    net[i][j][c] = ldexp(round(ldexp(to[c][0] * x + to[c][1] * y + to[c][2] * z, 30)), -30);
  }
}

/* Far from zero, and in scenes of all sizes. */
TEST(poles_that_are_rounded_point_by_point_have_their_normals)
{
  struct random random = {SEED};
  int certain = 0;
  for (int n = 0; n < ROUNDED_POLES; n++) {
    world_net exact, net[1];
    const int away = n % (MOST_AWAY + 1), exponent = MOST_EXPONENT * (n % 3 - 1);
    const double v = random_between(&random, 0.1, 0.9), u = ldexp(1, away - 55);
    double at[3], normal[3];
    struct ray ray = {.t_max = INFINITY};
    struct world world;
    cap(&random, exact);
    for (int k = 0; k < 48; k++) {
      const double x = ldexp(1, away) + exact[k / 12][k / 3 % 4][k % 3];
      const double last = k < 12 ? ldexp((double)(random_bits(&random) % 2), away - 52) : 0;
      net[0][k / 12][k / 3 % 4][k % 3] = ldexp(x + last, exponent);
    }
    surface(net[0], u, v, at, normal);
    surface(exact, ldexp(1, -40), v, ray.origin, normal);
    for (int c = 0; c < 3; c++) {
      ray.direction[c] = -normal[c] + random_between(&random, -0.1, 0.1);
      ray.origin[c] = at[c] - ldexp(ray.direction[c], exponent);
    }
    world_open(&world, net, 1, NULL);
    const struct hit hit = world_closest(&world, &ray);
    world_close(&world);
    if (hit.patch == HIT_NONE || hit.certainty != CERTAINTY_CERTAIN || hit.u > 2 * u) continue;
    certain++;
    const double off = normal_off(exact, &hit, ldexp(1, -40));
    if (!(off <= SURE)) fail_msg("2^%d away, size 2^%d, u %.3g v %.3g: off by %.2g", away, exponent, hit.u, hit.v, off);
  }
  assert_true(certain > ROUNDED_POLES / 16);
}
