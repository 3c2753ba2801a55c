/* Proves of pscn.h that answers are the intersector's, each depending on its ray alone, whatever the order of rays, the
 * strides and the caller's rounding mode; and that every member of an answer is written. */
#define _GNU_SOURCE /* feenableexcept */
#include <fenv.h>
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include "library/ball_rays.h"
#include "worse.h"

static double length(const double a[3]) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

/* The point of a patch at (u,v), by de Casteljau's construction. */
static void patch_point(double P[4][4][3], double u, double v, double out[3])
{
  for (int k = 0; k < 3; k++) {
    double row[4];
    for (int i = 0; i < 4; i++) {
      double p[4] = {P[i][0][k], P[i][1][k], P[i][2][k], P[i][3][k]};
      for (int n = 3; n > 0; n--)
        for (int j = 0; j < n; j++) p[j] += v * (p[j + 1] - p[j]);
      row[i] = p[0];
    }
    for (int n = 3; n > 0; n--)
      for (int j = 0; j < n; j++) row[j] += u * (row[j + 1] - row[j]);
    out[k] = row[0];
  }
}

/* How far hit->du and hit->dv are from differences of nearby points. */
static double derivative_error(const struct pscn_scene *scene, const struct pscn_hit *hit)
{
  const double step = 1e-6;
  double P[4][4][3], worst = 0, from[3], to[3];
  assert_int_equal(pscn_patch(scene, hit->patch, P), PSCN_OK);
  for (int along_v = 0; along_v <= 1; along_v++) {
    const double u = along_v ? 0 : step, v = along_v ? step : 0;
    patch_point(P, hit->u - u, hit->v - v, from);
    patch_point(P, hit->u + u, hit->v + v, to);
    for (int k = 0; k < 3; k++)
      worst = worse(worst, fabs((to[k] - from[k]) / (2 * step) - (along_v ? hit->dv : hit->du)[k]));
  }
  return worst;
}

/* A hit lies on the ray and on the surface; its derivatives and its normal are the surface's. */
TEST(test_hits)
{
  int hits = 0, misses = 0, certain = 0, off_by_something = 0;
  for (int n = 0; n < COUNT; n++) {
    const struct pscn_hit *hit = &ball.hit[n];
    const struct pscn_ray *ray = &ball.ray[n];
    certain += hit->certain;
    misses += hit->verdict == PSCN_MISS;
    if (hit->verdict != PSCN_HIT) continue;
    hits++;
    double off[3], across[3];
    for (int k = 0; k < 3; k++) {
      off[k] = hit->point[k] - ray->origin[k] - hit->t * ray->direction[k];
      across[k] = hit->du[(k + 1) % 3] * hit->dv[(k + 2) % 3] - hit->du[(k + 2) % 3] * hit->dv[(k + 1) % 3];
    }
    assert_true(length(off) < 1e-14);
    assert_true(fabs(length(hit->point) - 1) < 1e-3);
    assert_true(hit->point_error < 1e-14 && hit->point_error >= 0 && hit->clearance > hit->point_error);
    off_by_something += hit->point_error > 0;
    assert_true(fabs(length(hit->normal) - 1) < 1e-14);
    assert_true(hit->patch < BALL_PATCHES && hit->reserved == 0);
    assert_true(derivative_error(ball.scene, hit) < 1e-8);
    const double size = length(across);
    if (size < 1e-3) continue; /* near a pole */
    double cosine = 0;
    for (int k = 0; k < 3; k++) cosine += across[k] / size * hit->normal[k];
    assert_true(fabs(fabs(cosine) - 1) < 1e-12);
  }
  assert_true(hits > 100 && misses > 50 && certain > COUNT * 9 / 10 && off_by_something > hits / 2);
}

/* A patch moved far from the origin has the same derivatives, up to roundings of its own size. */
TEST(test_derivatives_far_away)
{
  double points[2][4][4][3];
  struct pscn_hit hit[2];
  struct pscn_scene *scene;
  uint64_t seed = 3;
  for (int n = 0; n < 48; n++) {
    const int i = n / 12, j = n / 3 % 4, k = n % 3;
    const double flat = k == 0 ? i : k == 1 ? j : 0;
    points[0][i][j][k] = ldexp(rint(ldexp(flat + 0.3 * random_unit(&seed), 20)), -20);
    points[1][i][j][k] = points[0][i][j][k] + (k + 1) * 0x1p30;
  }
  assert_int_equal(pscn_scene_from_points(**points[0], 2, sizeof *points, sizeof ***points, NULL, &scene), PSCN_OK);
  for (int at = 0; at < 2; at++) {
    struct pscn_ray ray = {{1, 2, -5}, {0.125, -0.0625, 1}, 0, INFINITY};
    for (int k = 0; k < 3; k++) ray.origin[k] += at * (k + 1) * 0x1p30;
    assert_int_equal(pscn_nearest(scene, 1, &ray, sizeof ray, &hit[at], sizeof hit[at]), PSCN_OK);
    assert_true(hit[at].verdict == PSCN_HIT && hit[at].patch == (uint32_t)at);
  }
  assert_true(fabs(hit[0].u - hit[1].u) < 0x1p-50 && fabs(hit[0].v - hit[1].v) < 0x1p-50);
  for (int k = 0; k < 3; k++)
    assert_true(fabs(hit[0].du[k] - hit[1].du[k]) < 0x1p-48 && fabs(hit[0].dv[k] - hit[1].dv[k]) < 0x1p-48);
  pscn_scene_free(scene);
}

/* One by one, backwards, and as members of larger structures. */
TEST(test_order_and_strides)
{
  struct pscn_hit alone, backwards[COUNT];
  assert_int_equal(
    pscn_nearest(ball.scene, COUNT, ball.ray + COUNT - 1, -(ptrdiff_t)sizeof *ball.ray, backwards, sizeof *backwards),
    PSCN_OK);
  static struct {
    char before[5];
    struct pscn_ray ray;
    float more;
    struct pscn_hit hit;
    char after[9];
  } apart[COUNT];
  memset(apart, 0x5A, sizeof apart);
  for (int n = 0; n < COUNT; n++) {
    assert_int_equal(pscn_nearest(ball.scene, 1, &ball.ray[n], 0, &alone, 0), PSCN_OK);
    assert_memory_equal(&alone, &ball.hit[n], sizeof alone);
    assert_memory_equal(&backwards[COUNT - 1 - n], &ball.hit[n], sizeof alone);
    apart[n].ray = ball.ray[n];
  }
  assert_int_equal(pscn_nearest(ball.scene, COUNT, &apart->ray, sizeof *apart, &apart->hit, sizeof *apart), PSCN_OK);
  for (int n = 0; n < COUNT; n++) {
    assert_memory_equal(&apart[n].hit, &ball.hit[n], sizeof alone);
    for (int k = 0; k < 9; k++) assert_int_equal(apart[n].after[k], 0x5A);
  }
}

TEST(test_occluded)
{
  uint8_t verdicts[COUNT][2];
  memset(verdicts, 9, sizeof verdicts);
  assert_int_equal(pscn_occluded(ball.scene, COUNT, ball.ray, sizeof *ball.ray, *verdicts, 2), PSCN_OK);
  for (int n = 0; n < COUNT; n++) {
    assert_int_equal(verdicts[n][0], ball.hit[n].verdict);
    assert_int_equal(verdicts[n][1], 9);
  }
}

/* A ray in the plane that a patch touches along a border to the third order, up to a corner that it meets at t: too
 * much work for one ray. */
TEST(test_occluded_end_of_work)
{
  static const double net[4][4][3] = {{{-3, -3, 3}, {-5, -3, 3}, {-7, -3, 3}, {-9, -3, 3}},
                                      {{6, -3, 3}, {1, -3, 4}, {-4, -3, 5}, {-9, -3, 6}},
                                      {{9, -3, 3}, {7, -3, 3}, {5, -3, 3}, {3, -3, 3}},
                                      {{3, -6, 9}, {3, -5, 7}, {3, -4, 5}, {3, -3, 3}}};
  struct pscn_scene *scene;
  assert_int_equal(pscn_scene_from_points(net[0][0], 1, sizeof net, sizeof net[0][0], NULL, &scene), PSCN_OK);
  for (int k = 1; k < 20; k++) {
    const double t = ldexp(1, -k);
    const struct pscn_ray ray = {.origin = {-9 + 2 * t, -3, 3 + 2 * t}, .direction = {-2, 0, -2}, .t_max = INFINITY};
    uint8_t verdict;
    assert_int_equal(pscn_occluded(scene, 1, &ray, 0, &verdict, 0), PSCN_OK);
    assert_int_equal(verdict, PSCN_HIT);
  }
  pscn_scene_free(scene);
}

/* From the surface outwards nothing is met, inwards the other side; and the effect of t_min and t_max. */
TEST(test_ranges)
{
  for (int n = 0; n < COUNT; n++) {
    const struct pscn_hit *hit = &ball.hit[n];
    if (hit->verdict != PSCN_HIT || !hit->certain) continue;
    struct pscn_ray ray = ball.ray[n];
    struct pscn_hit other;
    ray.t_max = hit->t * (1 - 1e-9);
    assert_int_equal(pscn_nearest(ball.scene, 1, &ray, 0, &other, 0), PSCN_OK);
    assert_int_equal(other.verdict, PSCN_MISS);
    ray.t_max = hit->t * (1 + 1e-9);
    assert_int_equal(pscn_nearest(ball.scene, 1, &ray, 0, &other, 0), PSCN_OK);
    assert_memory_equal(&other, hit, sizeof other);
    struct pscn_ray leaving = {.t_max = INFINITY};
    memcpy(leaving.direction, hit->normal, sizeof leaving.direction);
    const bool inside =
      hit->normal[0] * hit->point[0] + hit->normal[1] * hit->point[1] + hit->normal[2] * hit->point[2] < 0;
    assert_int_equal(pscn_leave(ball.scene, &ball.ray[n], hit, leaving.direction, leaving.origin), PSCN_OK);
    assert_int_equal(pscn_nearest(ball.scene, 1, &leaving, 0, &other, 0), PSCN_OK);
    assert_int_equal(other.verdict, inside ? PSCN_HIT : PSCN_MISS);
  }
}

/* A mirrored ray starts within the crease that the first ray came into, be it as acute as this. A start off the floor
 * along its normal would be above the roof. */
TEST(test_leave_in_a_crease)
{
  double nets[2][4][4][3];
  struct pscn_scene *scene;
  for (int k = 0; k < 32; k++) {
    const double x = k / 4 % 4, z = k % 4 - 1.5, at[3] = {x, k < 16 ? 0 : x / 4, z};
    memcpy(nets[k / 16][k / 4 % 4][k % 4], at, sizeof at);
  }
  assert_int_equal(pscn_scene_from_points(nets[0][0][0], 2, sizeof nets[0], sizeof nets[0][0][0], NULL, &scene),
                   PSCN_OK);
  for (int k = 0; k < 60; k++) {
    const double x = ldexp(1, -k);
    const struct pscn_ray ray = {{2 + x, 0.25, 0.1}, {-2, -0.25, 0}, 0, INFINITY};
    struct pscn_hit hit;
    struct pscn_ray next = {.direction = {0, 1, 0}, .t_max = INFINITY};
    uint8_t verdict;
    assert_int_equal(pscn_nearest(scene, 1, &ray, 0, &hit, 0), PSCN_OK);
    assert_int_equal(pscn_leave(scene, &ray, &hit, next.direction, next.origin), PSCN_OK);
    assert_int_equal(pscn_occluded(scene, 1, &next, 0, &verdict, 0), PSCN_OK);
    assert_int_equal(verdict, PSCN_HIT);
    assert_true(next.origin[1] > 0 && next.origin[1] < next.origin[0] / 4);
    assert_int_equal(pscn_leave(NULL, &ray, &hit, next.direction, next.origin), PSCN_USAGE);
  }
  pscn_scene_free(scene);
}

/* Directions as short and as long as they may be. Beyond that they are no directions. */
TEST(test_lengths)
{
  const struct pscn_ray towards = {{0.1, 0.2, -4}, {0.0625, -0.125, 1}, 0, 8};
  struct pscn_hit one, other;
  assert_int_equal(pscn_nearest(ball.scene, 1, &towards, 0, &one, 0), PSCN_OK);
  assert_int_equal(one.verdict, PSCN_HIT);
  for (int e = -320; e <= 320; e += 20) {
    struct pscn_ray ray = towards;
    for (int k = 0; k < 3; k++) ray.direction[k] = ldexp(towards.direction[k], e);
    ray.t_max = ldexp(8, -e);
    assert_int_equal(pscn_nearest(ball.scene, 1, &ray, 0, &other, 0), PSCN_OK);
    assert_true(ldexp(other.t, e) == one.t);
    other.t = one.t;
    assert_memory_equal(&other, &one, sizeof one);
  }
  static const double beyond[] = {0x1p-340, 1.0001e100, 0x1p340, DBL_TRUE_MIN, DBL_MAX};
  for (size_t k = 0; k < sizeof beyond / sizeof *beyond; k++) {
    struct pscn_ray ray = {{0.1, 0.2, -4}, {0, 0, beyond[k]}, 0, INFINITY};
    assert_int_equal(pscn_nearest(ball.scene, 1, &ray, 0, &other, 0), PSCN_INPUT);
    ray = (struct pscn_ray){{0.1, beyond[k], -4}, {0, 0, 1}, 0, INFINITY};
    assert_int_equal(pscn_nearest(ball.scene, 1, &ray, 0, &other, 0), beyond[k] < 1 ? PSCN_OK : PSCN_INPUT);
  }
  for (int e = 0; e <= 320; e += 20) { /* from the end of the numbers */
    const struct pscn_ray ray = {{0.1, 0.2, -1e100}, {0, 0, ldexp(1, e)}, 0, INFINITY};
    assert_int_equal(pscn_nearest(ball.scene, 1, &ray, 0, &other, 0), PSCN_OK);
    assert_int_equal(other.verdict, PSCN_HIT);
    assert_true(ldexp(other.t, e) == 1e100);
  }
}

/* An invalid ray, or one without a scene, has no answer, and this is written, too. */
TEST(test_no_answer)
{
  struct pscn_ray all[] = {ball.ray[0], ball.ray[1], ball.ray[2], ball.ray[3], ball.ray[4], ball.ray[5], ball.ray[6]};
  struct pscn_hit hits[7], hit;
  const struct pscn_hit none = {.t = INFINITY, .patch = PSCN_NO_PATCH, .verdict = PSCN_NO_ANSWER};
  struct pscn_hit missed = {.t = INFINITY, .patch = PSCN_NO_PATCH, .certain = 1};
  uint8_t verdicts[7];
  all[1].origin[2] = NAN;
  memset(all[2].direction, 0, sizeof all[2].direction);
  all[3].direction[1] = INFINITY;
  all[4].t_min = -1e-300;
  all[5].t_max = NAN;
  all[6].t_min = all[6].t_max = 1;
  memset(hits, 0xA5, sizeof hits);
  assert_int_equal(pscn_nearest(ball.scene, 7, all, sizeof *all, hits, sizeof *hits), PSCN_INPUT);
  assert_memory_equal(&hits[0], &ball.hit[0], sizeof hit);
  for (int k = 1; k < 6; k++) assert_memory_equal(&hits[k], &none, sizeof none);
  assert_memory_equal(&hits[6], &missed, sizeof missed);
  assert_int_equal(pscn_occluded(ball.scene, 7, all, sizeof *all, verdicts, 1), PSCN_INPUT);
  assert_int_equal(verdicts[5], PSCN_NO_ANSWER);
  assert_int_equal(verdicts[6], PSCN_MISS);

  struct pscn_scene *broken;
  assert_int_equal(pscn_scene_from_text("broken", "union {", 7, NULL, &broken), PSCN_INPUT);
  memset(hits, 0xA5, sizeof hits);
  assert_int_equal(pscn_nearest(broken, 7, ball.ray, sizeof *all, hits, sizeof *hits), PSCN_USAGE);
  for (int k = 0; k < 7; k++) assert_memory_equal(&hits[k], &none, sizeof none);
  assert_int_equal(pscn_nearest(NULL, 1, ball.ray, 0, &hit, 0), PSCN_USAGE);
  assert_int_equal(pscn_nearest(NULL, 0, ball.ray, 0, &hit, 0), PSCN_USAGE);
  assert_int_equal(pscn_nearest(ball.scene, 1, NULL, 0, &hit, 0), PSCN_USAGE);
  assert_memory_equal(&hit, &none, sizeof none);
  assert_int_equal(pscn_nearest(ball.scene, 1, ball.ray, 0, NULL, 0), PSCN_USAGE);
  assert_int_equal(pscn_nearest(ball.scene, 0, NULL, 0, NULL, 0), PSCN_OK);
  pscn_scene_free(broken);
}

/* A start that each hit's ray leaves it by, back the way it came; none for a miss. */
static void leave_all(double out[][3])
{
  for (int k = 0; k < COUNT; k++) {
    const struct pscn_hit *hit = &ball.hit[k];
    const bool is_hit = hit->verdict == PSCN_HIT;
    const enum pscn_status status = pscn_leave(ball.scene, &ball.ray[k], hit, hit->normal, out[k]);
    assert_int_equal(status, is_hit ? PSCN_OK : PSCN_USAGE);
    if (!is_hit) memset(out[k], 0, sizeof out[k]);
  }
}

/* With another arithmetic of the caller's, answers have the same bits, and that arithmetic is restored. */
TEST(test_arithmetic)
{
  static struct pscn_hit hits[COUNT];
  static double left[2][COUNT][3];
  fenv_t before;
  assert_int_equal(fegetenv(&before), 0);
  leave_all(left[0]);
  feclearexcept(FE_ALL_EXCEPT);
  assert_int_equal(pscn_nearest(ball.scene, COUNT, ball.ray, sizeof *ball.ray, hits, sizeof *hits), PSCN_OK);
  assert_int_equal(fetestexcept(FE_ALL_EXCEPT), 0);
#if defined(__SSE2__)
  const unsigned control = _mm_getcsr() | 0x8040; /* subnormal numbers are flushed to zero, read and written */
  _mm_setcsr(control);
#endif
  assert_int_equal(fesetround(FE_UPWARD), 0);
  feclearexcept(FE_ALL_EXCEPT);
  const int traps_wanted = FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW, asked = feenableexcept(traps_wanted);
  const enum pscn_status status = pscn_nearest(ball.scene, COUNT, ball.ray, sizeof *ball.ray, hits, sizeof *hits);
  leave_all(left[1]);
  struct pscn_scene *scene = make_ball();
  const int round = fegetround(), raised = fetestexcept(FE_ALL_EXCEPT), traps = fegetexcept();
#if defined(__SSE2__)
  const unsigned after = _mm_getcsr();
#endif
  assert_int_equal(fesetenv(&before), 0);
#if defined(__SSE2__)
  assert_int_equal(after & 0x8040, 0x8040);
#endif
  assert_int_equal(round, FE_UPWARD);
  assert_int_equal(raised, 0);
  assert_int_equal(traps, asked < 0 ? 0 : traps_wanted); /* arm64 has none */
  assert_int_equal(status, PSCN_OK);
  assert_memory_equal(hits, ball.hit, sizeof hits);
  assert_memory_equal(left[0], left[1], sizeof left[0]);
  assert_int_equal(pscn_nearest(scene, COUNT, ball.ray, sizeof *ball.ray, hits, sizeof *hits), PSCN_OK);
  assert_memory_equal(hits, ball.hit, sizeof hits);
  pscn_scene_free(scene);
}

/* Points so near each other that arithmetic on 128 bits underflows, which libgcc reports to the x87. It leaves no flag
 * there, where the first trap that a caller enables would see it; and traps that the caller has set only there do not
 * fire. */
TEST(test_underflow)
{
  const double size = 1e-99;
  double net[4][4][3];
  struct pscn_scene *scene;
  struct pscn_hit hit;
  int hits = 0;
  for (int k = 0; k < 16; k++) {
    double *point = net[k / 4][k % 4];
    point[0] = k / 4 * size, point[1] = k % 4 * size, point[2] = (k / 4 * 7 + k % 4 * 5) % 4 * size;
  }
  assert_int_equal(pscn_scene_from_points(net[0][0], 1, sizeof net, sizeof net[0][0], NULL, &scene), PSCN_OK);
  for (int k = 0; k < 16; k++) {
    const double *point = net[k / 4][k % 4];
    const struct pscn_ray ray = {.origin = {1.5 * size, size, -3 * size},
                                 .direction = {point[0] - 1.5 * size, point[1] - size, point[2] + 3 * size},
                                 .t_max = INFINITY};
    feclearexcept(FE_ALL_EXCEPT);
    assert_int_equal(pscn_nearest(scene, 1, &ray, 0, &hit, 0), PSCN_OK);
    assert_int_equal(fetestexcept(FE_ALL_EXCEPT), 0);
    hits += hit.verdict == PSCN_HIT;
#if defined(__x86_64__)
    const uint16_t all_traps = 0x340;
    uint16_t before, after;
    struct pscn_hit again;
    __asm__ volatile("fnstcw %0\n\tfldcw %1" : "=&m"(before) : "m"(all_traps));
    const enum pscn_status status = pscn_nearest(scene, 1, &ray, 0, &again, 0);
    __asm__ volatile("fnstcw %0\n\tfldcw %1" : "=&m"(after) : "m"(before));
    assert_int_equal(status, PSCN_OK);
    assert_int_equal(after, all_traps);
    assert_int_equal(fetestexcept(FE_ALL_EXCEPT), 0);
    assert_memory_equal(&again, &hit, sizeof hit);
#endif
  }
  assert_true(hits >= 8);
  pscn_scene_free(scene);
}

/* `start previous` is for rays asked one after the other; here it is a cold start. */
TEST(test_previous)
{
  double points[BALL_PATCHES][4][4][3];
  static struct pscn_hit forwards[COUNT], backwards[COUNT];
  struct pscn_options options = PSCN_OPTIONS;
  struct pscn_scene *scene;
  options.solver = "newton { start previous polish off }";
  ball_points(points);
  assert_int_equal(
    pscn_scene_from_points(**points[0], BALL_PATCHES, sizeof *points, sizeof ***points, &options, &scene), PSCN_OK);
  assert_int_equal(pscn_nearest(scene, COUNT, ball.ray, sizeof *ball.ray, forwards, sizeof *forwards), PSCN_OK);
  assert_int_equal(pscn_nearest(scene, COUNT, ball.ray + COUNT - 1, -(ptrdiff_t)sizeof *ball.ray, backwards + COUNT - 1,
                                -(ptrdiff_t)sizeof *backwards),
                   PSCN_OK);
  assert_memory_equal(forwards, backwards, sizeof forwards);
  pscn_scene_free(scene);
}

int main(void) { return test_run_with_rays(); }
