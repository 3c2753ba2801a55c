/* Rays at the border that two patches share, near the origin and far from it, for all true bidegrees, judged by the
 * reference.
 *
 * Away from the origin a patch has a low degree only up to rounding. A resultant that was formed at the low degree,
 * without an error term for that, once dismissed both patches (certain misses, 22 of 4,000 rays at 1e6). */
#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/patch.h"
#include "property/world.h"
#include "reference/facts.h"
#include "worse.h"

enum { SEED = 20240512, SCENES = 4, RAYS = 80, SHEETS = 1200 };

/* One ray in this many goes to a border that is open, so that there are misses, too. */
enum { OPEN = 20 };

/* Raises a cubic row from degree n to 3, in place. */
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

/* A ray at the border at this u, or off it by some last places of the coordinates. */
static struct ray border_ray(struct random *random, world_net net, double u, double offset)
{
  struct ray ray = {{0}, {0}, 0, INFINITY};
  const double v = random_between(random, 0.05, 0.95), last_place = 0x1p-53 * fmax(1, offset);
  for (int k = 0; k < 3; k++) {
    double x[4][4];
    for (int e = 0; e < 16; e++) x[e / 4][e % 4] = net[e / 4][e % 4][k];
    const double at = patch_evaluate(x, u, v).value;
    ray.origin[k] = at + (k == 2 ? random_between(random, 0.5, 3) : random_between(random, -1, 1));
    ray.direction[k] = at - ray.origin[k] + (k < 2 ? random_between(random, -8, 8) * last_place : 0);
  }
  return ray;
}

TEST(shared_borders_do_not_leak)
{
  static const double offsets[] = {0, 1e6, 1e9};
  struct random random = {SEED};
  int leaks = 0, invented = 0, hits = 0, misses = 0;
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
        const struct ray ray = border_ray(&random, nets[0], r % OPEN == 0 ? 0 : 1, offsets[o]);
        struct reference_answer want;
        struct hit got;
        reference_closest(reference, ray.origin, ray.direction, &want);
        tracer_closest(world.tracer, 1, &ray, &got);
        misses += want.verdict == REFERENCE_MISS;
        if (want.verdict == REFERENCE_MISS) invented += got.patch != HIT_NONE && got.certainty == CERTAINTY_CERTAIN;
        if (want.verdict != REFERENCE_HIT) continue;
        hits++;
        if (got.patch != HIT_NONE) {
          /* Times the sine of the angle of incidence; relative to t, which is about the scene's size. */
          struct facts facts;
          facts_find((const double(*)[4][3])nets[want.patch], ray.origin, ray.direction, want.t, want.u, want.v,
                     &facts);
          worst = worse(worst, fabs((double)((quad)got.t - want.t)) / (double)want.t * facts.incidence);
        } else if (leaks++ < 3) {
          print_message("leak: degree (%d,%d) at %g, certainty %d, u %.3g\n", m, n, offsets[o], got.certainty,
                        (double)want.u);
        }
      }
      reference_destroy(reference);
      world_close(&world);
    }
  }
  print_message("%d hits, t off by %.3g at most, %d misses\n", hits, worst, misses);
  assert_true(hits > 8 * SCENES * RAYS * 3);
  assert_true(misses > SCENES * 27);
  assert_int_equal(leaks, 0);
  assert_int_equal(invented, 0);
  assert_true(worst < 1e-13);
}

/* One of the four patches, bent and slanted, of a sheet; all have a corner at z on the z axis, and exact
 * coordinates. Bit 0 of `quarter`: the patch at x > 0; bit 1: at y > 0. */
static void quarter_sheet(unsigned quarter, double z, double slope, double bend, world_net out)
{
  for (int n = 0; n < 16; n++) {
    const int x = quarter & 1 ? n / 4 : n / 4 - 3, y = quarter & 2 ? n % 4 : n % 4 - 3;
    const double at[3] = {x, y, z + slope * x + bend * (x * x + y * y)};
    memcpy(out[n / 4][n % 4], at, sizeof at);
  }
}

/* A stack of sheets, in no order in the scene. Rays along its axis meet each sheet in a corner of all its patches,
 * or where two of them meet, so far more places are left to the last resort than a ray has room for. The answer
 * depends only on the first sheet: not on those behind it, nor on the rays beside it, nor on which box the walk
 * reaches first. The sheets slant, so the boxes are long along the axis. */
TEST(a_stack_is_met_on_its_first_sheet)
{
  enum { RAYS_ALONG = 6, APART = 90 };
  static const double beside[] = {0, 1.5, -0.75};
  static world_net nets[4 * SHEETS];
  static double z[SHEETS];
  static size_t place[4 * SHEETS];
  struct random random = {SEED + 1};
  struct world world;
  for (size_t k = 0; k < 4 * SHEETS; k++) place[k] = k;
  random_shuffle(&random, 4 * SHEETS, place);
  for (size_t s = 0; s < SHEETS; s++) {
    z[s] = (s > 0 ? z[s - 1] : 0) + 1 + floor(random_between(&random, 0, 64)) / 16;
    const double slope = floor(random_between(&random, -128, 129)), bend = floor(random_between(&random, -4, 5)) / 256;
    for (unsigned q = 0; q < 4; q++) quarter_sheet(q, z[s], slope, bend, nets[place[4 * s + q]]);
  }
  world_open(&world, nets, 4 * SHEETS, NULL);
  for (size_t b = 0; b < sizeof beside / sizeof *beside; b++) {
    struct ray rays[RAYS_ALONG];
    struct hit together[RAYS_ALONG];
    for (size_t n = 0; n < RAYS_ALONG; n++) { /* from between two sheets, up or down */
      const size_t below = n == 1 ? SHEETS - 1 : APART * n;
      const double from = n == 0 ? z[0] - 1 : n == 1 ? z[SHEETS - 1] + 1 : (z[below] + z[below + 1]) / 2;
      rays[n] = (struct ray){{0, beside[b], from}, {0, 0, n & 1 ? -1 : 1}, 0, INFINITY};
    }
    tracer_closest(world.tracer, RAYS_ALONG, rays, together);
    for (size_t n = 0; n < RAYS_ALONG; n++) {
      const struct hit alone = world_closest(&world, &rays[n]);
      const size_t sheet = n == 0 ? 0 : n == 1 ? SHEETS - 1 : n & 1 ? APART * n : APART * n + 1;
      size_t first = 4 * SHEETS;
      for (unsigned q = 0; q < 4; q++)
        if ((q & 2 ? beside[b] >= 0 : beside[b] <= 0) && place[4 * sheet + q] < first) first = place[4 * sheet + q];
      assert_int_equal(alone.certainty, CERTAINTY_CERTAIN);
      assert_int_equal(alone.patch, first);
      if (beside[b] == 0) assert_true(alone.t == fabs(z[sheet] - rays[n].origin[2]));
      assert_same_hit("stack", WORLD_GRID, &rays[n], &alone, &together[n]);
    }
  }
  world_close(&world);
}

int main(void)
{
  print_message("seed %d\n", SEED);
  return test_run();
}
