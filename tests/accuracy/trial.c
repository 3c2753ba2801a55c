/* The intersector's answers compared with the reference's. See trial.h. */
#include "accuracy/trial.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/models.h"
#include "base/diagnostics.h"
#include "cmocka_test.h"
#include "language/language.h"
#include "method_of.h"

enum { MOST_SHOWN = 10 };

/* Parameters this far apart, absolute, belong to two points of the surface; a point is as near to the ray as rounding
 * allows within the sum of 16 products and the ray's own few roundings, relative to the largest coordinate. */
#define OTHER_SHEET 1e-3
#define OTHER_SHEET_NEAR (32 * DOUBLE_UNIT)

/* Where the bound on the normal is below this, what the first order leaves out is below its square. */
#define NORMAL_FIRST_ORDER 1e-3

static void start_intersector(struct trial *trial)
{
  assert_int_equal(intersector_create(&trial->scene, &trial->intersector), STATUS_OK);
  assert_int_equal(tracer_create(trial->intersector, &trial->tracer), STATUS_OK);
}

static void trial_start(struct trial *trial)
{
  const size_t count = trial->scene.patch_count;
  double(*P)[4][4][3] = malloc((count ? count : 1) * sizeof *P);
  assert_non_null(P);
  for (size_t n = 0; n < count; n++) memcpy(P[n], trial->scene.patches[n].P, sizeof P[n]);
  trial->reference = reference_create((const double(*)[4][4][3])P, count);
  free(P);
  assert_non_null(trial->reference);
  start_intersector(trial);
}

/* Copies the patches; all have the first solver. */
static void own_patches(struct trial *trial, size_t count)
{
  trial->own_patches = calloc(count + 1, sizeof *trial->own_patches);
  assert_non_null(trial->own_patches);
  trial->scene.patches = trial->own_patches, trial->scene.patch_count = count;
  trial->scene.solvers = &trial->solver, trial->scene.solver_count = 1;
}

void trial_create(struct trial *trial, const double (*P)[4][4][3], size_t count, const char *solver)
{
  *trial = (struct trial){.solver = method_of(solver ? solver : solver_at(0)->name)};
  own_patches(trial, count);
  for (size_t n = 0; n < count; n++) memcpy(trial->own_patches[n].P, P[n], sizeof P[n]);
  trial_start(trial);
}

void trial_create_beside(struct trial *trial, const struct trial *first, const char *solver)
{
  const struct scene *scene = &first->scene;
  *trial = (struct trial){
    .scene = *scene, .solver = method_of(solver), .reference = first->reference, .reference_borrowed = true};
  own_patches(trial, scene->patch_count);
  for (size_t n = 0; n < scene->patch_count; n++)
    trial->own_patches[n] = scene->patches[n], trial->own_patches[n].solver = 0;
  start_intersector(trial);
}

void trial_of_scene(struct trial *trial, const struct scene *scene)
{
  *trial = (struct trial){.scene = *scene};
  trial_start(trial);
}

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

struct scene *trial_load(const char *path, const char *solver, int width, int height)
{
  struct diagnostics diagnostics = {.tell = tell};
  const struct language_settings settings = {
    .image_width = width, .image_height = height, .solver_text = solver, .tolerance = NAN};
  struct scene *scene = NULL;
  return language_load(path, &settings, &diagnostics, &scene) == STATUS_OK ? scene : NULL;
}

void trial_destroy(struct trial *trial)
{
  tracer_destroy(trial->tracer);
  intersector_destroy(trial->intersector);
  if (!trial->reference_borrowed) reference_destroy(trial->reference);
  free(trial->own_patches);
}

/* ---- prints ---- */

void print_ray(const struct ray *ray)
{
  const double *o = ray->origin, *d = ray->direction;
  printf("  ray %.17g %.17g %.17g %.17g %.17g %.17g\n", o[0], o[1], o[2], d[0], d[1], d[2]);
  if (ray->t_min > 0 || isfinite(ray->t_max)) printf("  from %.17g to %.17g\n", ray->t_min, ray->t_max);
}

void print_hit(const char *name, const struct hit *hit)
{
  printf("  %s: %s ", name, hit->certainty == CERTAINTY_CERTAIN ? "certain" : "grazing");
  if (hit->patch == HIT_NONE) printf("miss\n");
  else printf("t %.17g u %.17g v %.17g patch %u\n", hit->t, hit->u, hit->v, (unsigned)hit->patch);
}

void print_patches(const struct scene *scene)
{
  for (size_t n = 0; n < scene->patch_count; n++) {
    char solver[METHOD_TEXT_SIZE];
    method_text(&scene->solvers[scene->patches[n].solver], solver, sizeof solver);
    printf("bicubic_patch { type 1 flatness 0 u_steps 5 v_steps 5\n");
    for (int k = 0; k < 16; k++) {
      const double *p = scene->patches[n].P[k / 4][k % 4];
      printf("  <%.17g, %.17g, %.17g>%s\n", p[0], p[1], p[2], k < 15 ? "," : "");
    }
    printf("  solver %s }\n", solver);
  }
}

/* ---- one answer ---- */

static void show(const char *what, const struct ray *ray, const struct hit *hit, const struct reference_answer *truth,
                 struct tally *tally)
{
  static const char *const verdicts[] = {"miss", "hit", "grazing"};
  if (tally->shown++ >= MOST_SHOWN) return;
  printf("%s: %s\n", tally->name, what);
  print_ray(ray);
  printf("  reference: %s", verdicts[truth->verdict]);
  if (truth->patch != REFERENCE_NONE)
    printf(" t %.17g u %.17g v %.17g patch %u%s", (double)truth->t, (double)truth->u, (double)truth->v,
           (unsigned)truth->patch, truth->shared ? " (shared edge)" : "");
  if (truth->verdict == REFERENCE_GRAZING) printf(" (nothing before t %.17g)", truth->t_first);
  printf("\n");
  print_hit("intersector", hit);
}

static double largest_coordinate(const struct trial *trial, const struct ray *ray, const struct hit *hit)
{
  double size = 0;
  for (int axis = 0; axis < 3; axis++) {
    size = fmax(size, fabs(ray->origin[axis]));
    for (int k = 0; k < 16; k++) size = fmax(size, fabs(trial->scene.patches[hit->patch].P[k / 4][k % 4][axis]));
  }
  return size;
}

static double direction_length(const struct ray *ray) { return facts_length(ray->direction); }

double trial_size(const struct ray *ray, double t)
{
  double size = 0;
  for (int axis = 0; axis < 3; axis++)
    size = fmax(size, fmax(fabs(ray->origin[axis]), fabs(ray->origin[axis] + t * ray->direction[axis])));
  return size / direction_length(ray);
}

struct facts_floor trial_floor(const struct reference *reference, const struct ray *ray, uint32_t patch, double t,
                               double u, double v)
{
  struct facts facts;
  facts_find(reference_net(reference, patch), ray->origin, ray->direction, t, u, v, &facts);
  const double floor = fmax(facts.data.t, fmin(facts.whole.t, TRIAL_EXTENT * t));
  return (struct facts_floor){.t = floor > 0 ? fmax(floor, TRIAL_LEAST * trial_size(ray, t))
                                             : INFINITY, /* not a number: singular */
                              .u = fmax(facts.data.u, facts.whole.u),
                              .v = fmax(facts.data.v, facts.whole.v)};
}

/* How far in t the answer may be from the reference's, whose floor is given, and be the same hit still. */
static double same_within(const struct trial *trial, const struct ray *ray, const struct hit *hit, double floor)
{
  double allowed = TRIAL_SAME_FLOORS * floor;
  if (hit->certainty == CERTAINTY_GRAZING)
    allowed += TRIAL_NEAR * largest_coordinate(trial, ray, hit) / direction_length(ray);
  return allowed;
}

/* Whether a hit that should not be there may stand: it says grazing, and ray and patch do come that near. */
static bool excused(const struct trial *trial, const struct ray *ray, const struct hit *hit)
{
  if (hit->certainty != CERTAINTY_GRAZING) return false;
  const double off = facts_residual(reference_net(trial->reference, hit->patch), ray->origin, ray->direction, hit->t,
                                    hit->u, hit->v);
  return off <= TRIAL_NEAR * largest_coordinate(trial, ray, hit);
}

/* Where a patch cuts itself two points of it are at one place of the ray, and either is right: far from the other in u
 * and v, and as near to the ray as rounding lets any point be. */
static bool other_sheet(const struct trial *trial, const struct ray *ray, const struct hit *hit,
                        const struct reference_answer *truth)
{
  const double du = (double)quad_abs(hit->u - truth->u), dv = (double)quad_abs(hit->v - truth->v);
  if (hit->patch != truth->patch || fmax(du, dv) < OTHER_SHEET) return false;
  const double off = facts_residual(reference_net(trial->reference, hit->patch), ray->origin, ray->direction, hit->t,
                                    hit->u, hit->v);
  return off <= OTHER_SHEET_NEAR * largest_coordinate(trial, ray, hit);
}

/* The largest k-th difference of control points along both parameters, times what makes it a bound of that
 * derivative. */
static double difference_bound(const double P[4][4][3], int by_u, int by_v)
{
  double largest = 0, factor = 1;
  for (int k = 0; k < by_u; k++) factor *= 3 - k;
  for (int k = 0; k < by_v; k++) factor *= 3 - k;
  for (int i = 0; i + by_u < 4; i++) {
    for (int j = 0; j + by_v < 4; j++) {
      double d[3] = {0};
      for (int m = 0; m <= by_u; m++)
        for (int n = 0; n <= by_v; n++)
          for (int axis = 0; axis < 3; axis++)
            d[axis] += ((by_u - m + by_v - n) % 2 ? -1 : 1) * (by_u == 2 && m == 1 ? 2 : 1) *
                       (by_v == 2 && n == 1 ? 2 : 1) * P[i + m][j + n][axis];
      largest = fmax(largest, facts_length(d));
    }
  }
  return factor * largest;
}

/* What the floors of u and v, and the roundings of the tangents (twelve, on weights that sum up to 6 in size, times
 * the patch's extent), do to the unit normal n = S_u x S_v/|S_u x S_v|: to first order |dn| <= |d(S_u x S_v)|/|S_u x
 * S_v|. */
static double normal_bound(const double P[4][4][3], const struct reference_answer *truth, const struct facts *facts)
{
  double su[3], sv[3], cross[3];
  net_tangents(P, (double)truth->u, (double)truth->v, su, sv);
  for (int axis = 0; axis < 3; axis++) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    cross[axis] = su[i] * sv[j] - su[j] * sv[i];
  }
  const double du = TRIAL_FLOORS * facts->data.u, dv = TRIAL_FLOORS * facts->data.v, mixed = difference_bound(P, 1, 1);
  double extent = 0;
  for (int k = 0; k < 16; k++)
    for (int axis = 0; axis < 3; axis++) extent = fmax(extent, fabs(P[k / 4][k % 4][axis] - P[0][0][axis]));
  const double rounding = 12 * 6 * DOUBLE_UNIT * extent;
  const double off_u = difference_bound(P, 2, 0) * du + mixed * dv + rounding;
  const double off_v = mixed * du + difference_bound(P, 0, 2) * dv + rounding;
  return (off_u * facts_length(sv) + off_v * facts_length(su)) / facts_length(cross) + 8 * DOUBLE_UNIT;
}

/* The normal, where its bound is small enough for the first order to hold. */
static void measure_normal(const struct trial *trial, const struct ray *ray, const struct hit *hit,
                           const struct reference_answer *truth, const struct facts *facts, struct tally *tally)
{
  if (!facts->has_normal) return;
  const double bound = normal_bound((const double(*)[4][3])trial->scene.patches[hit->patch].P, truth, facts);
  if (!(bound < NORMAL_FIRST_ORDER)) return;
  double off = 0, facing = 0;
  for (int axis = 0; axis < 3; axis++) {
    off = fmax(off, fabs(hit->normal[axis] - facts->normal[axis]));
    facing += facts->normal[axis] * ray->direction[axis];
  }
  if (fabs(facing) <= bound * direction_length(ray)) return; /* seen edge-on: which side is seen is rounding */
  if (off > bound && tally->bad_normal++ == 0) show("wrong normal", ray, hit, truth, tally);
}

/* Both found the same hit: how well. */
static void measure(const struct trial *trial, const struct ray *ray, const struct hit *hit,
                    const struct reference_answer *truth, const struct facts *facts, struct tally *tally)
{
  /* the root of a grazing hit may be split or removed by rounding: no first-order floor holds */
  if (hit->certainty == CERTAINTY_GRAZING) return;
  const double dt = (double)quad_abs(hit->t - truth->t);
  tally->worst_t_floor = fmax(tally->worst_t_floor, dt / facts->data.t);
  bool beyond = dt > TRIAL_FLOORS * facts->data.t;
  const bool other = other_sheet(trial, ray, hit, truth);
  if (hit->patch == truth->patch && !truth->shared && !other) {
    const double du = (double)quad_abs(hit->u - truth->u), dv = (double)quad_abs(hit->v - truth->v);
    tally->worst_u_floor = fmax(tally->worst_u_floor, du / facts->data.u);
    tally->worst_v_floor = fmax(tally->worst_v_floor, dv / facts->data.v);
    beyond = beyond || du > TRIAL_FLOORS * facts->data.u || dv > TRIAL_FLOORS * facts->data.v;
  }
  if (beyond) show("T, U or V beyond its floor", ray, hit, truth, tally);
  if (hit->patch != truth->patch || other) return;
  measure_normal(trial, ray, hit, truth, facts, tally);
}

static void judge_hit(const struct trial *trial, const struct ray *ray, const struct hit *hit,
                      const struct reference_answer *truth, const struct facts *facts, struct tally *tally)
{
  const double difference = (double)((quad)hit->t - truth->t);
  if (fabs(difference) <= same_within(trial, ray, hit, facts->data.t)) {
    measure(trial, ray, hit, truth, facts, tally);
  } else if (difference > 0) {
    tally->lost++;
    show("lost, a later hit is answered", ray, hit, truth, tally);
  } else if (!excused(trial, ray, hit)) {
    tally->invented++;
    show("invented, nearer than the first", ray, hit, truth, tally);
  }
}

/* The reference cannot say: any answer between "nothing before t_first" and its own proven hit will do. */
static void judge_grazing(const struct trial *trial, const struct ray *ray, const struct hit *hit,
                          const struct reference_answer *truth, const struct facts *facts, struct tally *tally)
{
  tally->undecided++;
  const bool proven = truth->patch != REFERENCE_NONE;
  if (proven && (hit->patch == HIT_NONE || hit->t > (double)truth->t + same_within(trial, ray, hit, facts->data.t))) {
    tally->lost++;
    show("lost behind a grazing one", ray, hit, truth, tally);
  } else if (hit->patch != HIT_NONE && hit->t < truth->t_first) {
    struct facts at;
    facts_find(reference_net(trial->reference, hit->patch), ray->origin, ray->direction, hit->t, hit->u, hit->v, &at);
    if (hit->t >= truth->t_first - same_within(trial, ray, hit, at.data.t) || excused(trial, ray, hit)) return;
    tally->invented++;
    show("invented before a grazing one", ray, hit, truth, tally);
  }
}

/* Whether the hit's numbers are in the ranges that intersect.h gives them; what is not a number is in none. */
static bool in_ranges(const struct ray *ray, const struct hit *hit)
{
  return hit->t > ray->t_min && hit->t <= ray->t_max && hit->u >= 0 && hit->u <= 1 && hit->v >= 0 && hit->v <= 1 &&
         isfinite(hit->point[0]) && isfinite(hit->point[1]) && isfinite(hit->point[2]) && hit->point_error >= 0 &&
         hit->clearance >= hit->point_error && fabs(facts_length(hit->normal) - 1) <= 8 * DOUBLE_UNIT;
}

static void judge(const struct trial *trial, const struct ray *ray, const struct hit *hit, struct tally *tally)
{
  struct reference_answer truth;
  struct facts known, *facts = NULL; /* of the hit that the reference has proven, if any */
  reference_closest(trial->reference, ray->origin, ray->direction, &truth);
  if (truth.patch != REFERENCE_NONE) {
    facts = &known;
    facts_find(reference_net(trial->reference, truth.patch), ray->origin, ray->direction, truth.t, truth.u, truth.v,
               facts);
  }
  tally->rays++;
  tally->hits += truth.verdict == REFERENCE_HIT;
  tally->grazing += hit->certainty == CERTAINTY_GRAZING;
  if (hit->patch != HIT_NONE && !in_ranges(ray, hit)) {
    tally->invented++;
    show("numbers out of their ranges", ray, hit, &truth, tally);
  } else if (truth.verdict == REFERENCE_GRAZING) {
    judge_grazing(trial, ray, hit, &truth, facts, tally);
  } else if (truth.verdict == REFERENCE_MISS) {
    if (hit->patch == HIT_NONE || excused(trial, ray, hit)) return;
    tally->invented++;
    show("invented", ray, hit, &truth, tally);
  } else if (hit->patch == HIT_NONE) {
    tally->lost++;
    show("lost", ray, hit, &truth, tally);
  } else {
    judge_hit(trial, ray, hit, &truth, facts, tally);
  }
}

void trial_rays(struct trial *trial, const struct ray *rays, size_t count, struct tally *tally)
{
  for (size_t first = 0; first < count; first += PACKET_SIZE) {
    const size_t size = count - first < PACKET_SIZE ? count - first : PACKET_SIZE;
    struct hit hits[PACKET_SIZE];
    tracer_closest(trial->tracer, size, rays + first, hits);
    for (size_t n = 0; n < size; n++) judge(trial, &rays[first + n], &hits[n], tally);
  }
}

void tally_assert(const struct tally *tally)
{
  printf("%s: %zu rays, %zu hits, %zu undecided, %zu grazing; lost %zu, invented %zu; T, U, V off by %.2g, %.2g, %.2g "
         "floors\n",
         tally->name, tally->rays, tally->hits, tally->undecided, tally->grazing, tally->lost, tally->invented,
         tally->worst_t_floor, tally->worst_u_floor, tally->worst_v_floor);
  assert_true(tally->rays > 0);
  assert_int_equal(tally->lost, 0);
  assert_int_equal(tally->invented, 0);
  assert_int_equal(tally->bad_normal, 0);
  assert_true(tally->worst_t_floor <= TRIAL_FLOORS && tally->worst_u_floor <= TRIAL_FLOORS &&
              tally->worst_v_floor <= TRIAL_FLOORS);
}
