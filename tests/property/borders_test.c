/* Rays at the border that two patches share, near and far from the origin, for all true bidegrees, judged by the
 * reference.
 *
 * Away from the origin a patch of low degree is one only within its rounding; a resultant formed at the low degree
 * without an error for that once dismissed both patches (certain misses, 22 of 4,000 rays at 1e6). */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/patch.h"
#include "property/world.h"
#include "reference/facts.h"

enum { SEED = 20240512, SCENES = 4, RAYS = 80 };

/* A cubic row out of one of degree n, in place. */
static void raise(quad c[4], int n)
{
  for (int d = n; d < 3; d++)
    for (int j = d + 1; j >= 0; j--) c[j] = ((j > 0 ? j * c[j - 1] : 0) + (j <= d ? (d + 1 - j) * c[j] : 0)) / (d + 1);
}

/* The net of bidegree (m,n) as a bicubic one, moved by `offset` along each axis and rounded once. */
static void elevate(double low[4][4][3], int m, int n, double offset, world_net out)
{
  for (int k = 0; k < 3; k++) {
    quad rows[4][4] = {{0}};
    for (int i = 0; i <= m; i++) {
      for (int j = 0; j <= n; j++) rows[i][j] = low[i][j][k];
      raise(rows[i], n);
    }
    for (int j = 0; j < 4; j++) {
      quad column[4] = {rows[0][j], rows[1][j], rows[2][j], rows[3][j]};
      raise(column, m);
      for (int i = 0; i < 4; i++) out[i][j][k] = (double)(column[i] + (quad)offset);
    }
  }
}

/* Two patches of bidegree (m,n) with the same control points along u = 1 of the first and u = 0 of the second. */
static void pair(struct random *random, int m, int n, double offset, world_net nets[2])
{
  double low[2][4][4][3];
  for (int p = 0; p < 2; p++) {
    for (int i = 0; i <= m; i++) {
      for (int j = 0; j <= n; j++) {
        low[p][i][j][0] = p + i / (double)m + random_between(random, -0.1, 0.1);
        low[p][i][j][1] = j / (double)n + random_between(random, -0.1, 0.1);
        low[p][i][j][2] = random_between(random, -0.3, 0.3);
      }
    }
  }
  for (int j = 0; j <= n; j++) memcpy(low[1][0][j], low[0][m][j], sizeof low[1][0][j]);
  for (int p = 0; p < 2; p++) elevate(low[p], m, n, offset, nets[p]);
  for (int j = 0; j < 4; j++) memcpy(nets[1][0][j], nets[0][3][j], sizeof nets[1][0][j]);
}

/* A ray at the border, off it by some last places of the coordinates. */
static struct ray border_ray(struct random *random, world_net net, double offset)
{
  struct ray ray = {{0}, {0}, 0, INFINITY};
  const double v = random_between(random, 0.05, 0.95), last_place = 0x1p-53 * fmax(1, offset);
  for (int k = 0; k < 3; k++) {
    double x[4][4];
    for (int e = 0; e < 16; e++) x[e / 4][e % 4] = net[e / 4][e % 4][k];
    const double at = patch_evaluate(x, 1, v).value;
    ray.origin[k] = at + (k == 2 ? random_between(random, 0.5, 3) : random_between(random, -1, 1));
    ray.direction[k] = at - ray.origin[k] + (k < 2 ? random_between(random, -8, 8) * last_place : 0);
  }
  return ray;
}

static void shared_borders_do_not_leak(void **state)
{
  (void)state;
  static const double offsets[] = {0, 1e6, 1e9};
  struct random random = {SEED};
  int leaks = 0, invented = 0, hits = 0;
  double worst = 0;
  for (int o = 0; o < 3; o++) {
    for (int way = 0; way < 9 * SCENES; way++) {
      const int m = 1 + way % 3, n = 1 + way / 3 % 3;
      world_net nets[2];
      struct world world;
      pair(&random, m, n, offsets[o], nets);
      world_open(&world, nets, 2, NULL);
      struct reference *reference = reference_create((const double(*)[4][4][3])nets, 2);
      assert_non_null(reference);
      for (int r = 0; r < RAYS; r++) {
        const struct ray ray = border_ray(&random, nets[0], offsets[o]);
        struct reference_answer want;
        struct hit got;
        reference_closest(reference, ray.origin, ray.direction, &want);
        tracer_closest(world.tracer, 1, &ray, &got);
        if (want.verdict == REFERENCE_MISS) invented += got.patch != HIT_NONE && got.certainty == CERTAINTY_CERTAIN;
        if (want.verdict != REFERENCE_HIT) continue;
        hits++;
        if (got.patch != HIT_NONE) {
          /* Over the sine of the angle at which the surface is met; relative to t, which is about the scene's size. */
          struct facts facts;
          facts_find((const double(*)[4][3])nets[want.patch], ray.origin, ray.direction, want.t, want.u, want.v,
                     &facts);
          worst = fmax(worst, fabs((double)((quad)got.t - want.t)) / (double)want.t * facts.incidence);
        } else if (leaks++ < 3) {
          print_message("leak: degree (%d,%d) at %g, certainty %d, u %.3g\n", m, n, offsets[o], got.certainty,
                        (double)want.u);
        }
      }
      reference_destroy(reference);
      world_close(&world);
    }
  }
  print_message("%d hits, t off by %.3g at most\n", hits, worst);
  assert_true(hits > 8 * SCENES * RAYS * 3);
  assert_int_equal(leaks, 0);
  assert_int_equal(invented, 0);
  assert_true(worst < 1e-13);
}

int main(void)
{
  print_message("seed %d\n", SEED);
  const struct CMUnitTest tests[] = {cmocka_unit_test(shared_borders_do_not_leak)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
