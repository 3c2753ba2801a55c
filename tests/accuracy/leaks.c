/* Proves that no ray leaves a closed model. Rays from inside the dome, the ball, the torus and the teapot are aimed
 * exactly at shared edges, corners, poles and iso-lines (where leaves of a patch meet), general and axis-aligned, with
 * every solver. Rays that leave a hit neither strike the point they leave nor miss what comes next.
 *
 * A ray `origin + t (target - origin)` with the target on the surface hits at t = 1 or before. So a ray that slips
 * through at the target is noticed even if it strikes the far wall. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "accuracy/placed_rays.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

enum { FULL_RAYS = 10000000, MOST_SHOWN = 12 };

/* A target is evaluated in doubles, so t = 1 is off by some roundings of the largest coordinate over the distance. 1e-7
 * suffices for a shift of 1e6 seen from 0.1 away. */
#define AT_TARGET 1e-7

/* See struct placed_shares. */
#define EXACT_SHARE 0.02

/* All rays go to the default solver, this share to each of the others. */
#define OTHERS_SHARE 0.02

static void (*const models[])(struct model *) = {model_dome, model_ball, model_torus, model_teapot};
enum { MODELS = sizeof models / sizeof models[0] };

static const char *const aims[] = {"edge", "corner", "eighth", "middle", "anywhere", "near edge", "near pole"};
enum { AIM_EDGE, AIM_CORNER, AIM_EIGHTH, AIM_MIDDLE, AIM_ANYWHERE, AIM_NEAR_EDGE, AIM_NEAR_POLE, AIMS };

static void aim(int kind, struct random *random, double *u, double *v)
{
  const uint64_t bits = random_bits(random);
  const double tiny = ldexp(1, -(int)(bits % 56) - 4), end = (double)(bits >> 8 & 1);
  *u = random_unit(random);
  *v = random_unit(random);
  double *fixed = bits >> 9 & 1 ? u : v;
  switch (kind) {
  case AIM_EDGE: *fixed = end; break;
  case AIM_CORNER:
    *u = end;
    *v = (double)(bits >> 10 & 1);
    break;
  case AIM_EIGHTH: *fixed = (double)(bits >> 10 & 7) / 8; break;
  case AIM_MIDDLE: *fixed = 0.5; break;
  case AIM_NEAR_EDGE: *fixed = end > 0 ? 1 - tiny : tiny; break;
  case AIM_NEAR_POLE: *u = tiny; break;
  default: break;
  }
}

/* Makes one axis of the direction, or two, zero: the ray starts straight in front of the target, if that point is
 * inside, too. */
static void align(struct random *random, const double target[3], double origin[3])
{
  const uint64_t bits = random_bits(random);
  const int axis = (int)(bits % 3);
  if (bits >> 8 & 1) {
    origin[axis] = target[axis];
  } else {
    origin[(axis + 1) % 3] = target[(axis + 1) % 3];
    origin[(axis + 2) % 3] = target[(axis + 2) % 3];
  }
}

/* Whether a point is well inside, by its distance from the middle as in model_inside. An aligned origin may have left
 * the model. */
static bool inside(const struct model *model, const double p[3])
{
  const double r = sqrt(p[0] * p[0] + p[2] * p[2]);
  if (!strcmp(model->name, "torus")) return (r - 1) * (r - 1) + p[1] * p[1] < 0.35 * 0.35;
  if (!strcmp(model->name, "dome") && p[1] < 0.05) return false;
  if (!strcmp(model->name, "teapot")) return r < 0.5 && p[1] > 0.2 && p[1] < 0.8;
  return r * r + p[1] * p[1] < 0.9 * 0.9;
}

static bool at_open_border(const struct model *model, size_t patch, double u, double v)
{
  const bool *open = model->open[patch];
  return (open[0] && u == 0) || (open[1] && u == 1) || (open[2] && v == 0) || (open[3] && v == 1);
}

/* Half of the rays start nearer to their target, by up to this power of ten; but not so near, relative to the
 * coordinates, that rounding may put them outside. Within 1 % of a pole the side of a start is hard to tell. */
enum { NEAREST_START = 9 };
#define INSIDE_STILL 1e-12

static void pull(struct random *random, const double target[3], double origin[3])
{
  const uint64_t bits = random_bits(random);
  if (bits % 2) return;
  const double way = pow(10, -(double)(bits / 2 % (NEAREST_START + 1)));
  double size = 0, length = 0;
  for (int axis = 0; axis < 3; axis++) {
    size = fmax(size, fabs(target[axis]));
    length = fmax(length, fabs(origin[axis] - target[axis]));
  }
  if (way * length < INSIDE_STILL * size) return;
  for (int axis = 0; axis < 3; axis++) origin[axis] = target[axis] + way * (origin[axis] - target[axis]);
}

static void random_ray(const struct placed_model *at, int kind, struct random *random, struct ray *ray)
{
  const struct model *model = &at->model;
  double u, v, target[3], origin[3];
  size_t patch;
  do patch = (size_t)(random_bits(random) % model->count);
  while (model->other[patch]);
  do {
    do aim(kind, random, &u, &v);
    while (at_open_border(model, patch, u, v));
    net_point(model->P[patch], u, v, target);
    model_inside(model, random, origin);
    if (!at->moved && random_bits(random) % 2) align(random, target, origin);
  } while (!inside(model, origin));
  net_point(at->placed.P[patch], u, v, target);
  placed_point(at, origin);
  pull(random, target, origin);
  *ray = (struct ray){.t_min = 0, .t_max = INFINITY};
  for (int axis = 0; axis < 3; axis++) {
    ray->origin[axis] = origin[axis];
    ray->direction[axis] = target[axis] - origin[axis];
  }
}

/* Whether an answer beyond the target is right nevertheless: rounding moves the target far along a ray that is nearly
 * tangent, and puts a start outside that is as near as that to the surface. */
static bool right_after_all(const struct trial *trial, const struct ray *ray, const struct hit *hit)
{
  struct reference_answer truth;
  reference_closest(trial->reference, ray->origin, ray->direction, &truth);
  if (hit->patch == HIT_NONE) return truth.verdict == REFERENCE_MISS;
  if (truth.patch == REFERENCE_NONE) return truth.verdict == REFERENCE_GRAZING && hit->t >= truth.t_first;
  struct facts facts;
  facts_find(reference_net(trial->reference, truth.patch), ray->origin, ray->direction, truth.t, truth.u, truth.v,
             &facts);
  return hit->t <= (double)truth.t + TRIAL_SAME_FLOORS * facts.data.t;
}

static size_t count_leaks(struct trial *trial, const char *name, const char *solver, int kind, size_t count,
                          const struct ray *rays)
{
  static size_t shown = 0;
  struct hit hits[PACKET_SIZE];
  bool occluded[PACKET_SIZE];
  size_t leaks = 0;
  tracer_closest(trial->tracer, count, rays, hits);
  tracer_occluded(trial->tracer, count, rays, occluded);
  for (size_t n = 0; n < count; n++) {
    const bool struck = hits[n].patch != HIT_NONE;
    if (struck == occluded[n] && ((struck && hits[n].t <= 1 + AT_TARGET) || right_after_all(trial, &rays[n], &hits[n])))
      continue;
    leaks++;
    if (shown++ >= MOST_SHOWN) continue;
    const struct ray *r = &rays[n];
    struct reference_answer truth;
    reference_closest(trial->reference, r->origin, r->direction, &truth);
    printf("leak: %s, %s, %s: ray %a %a %a  %a %a %a: t %.17g, occluded %d; truth %d %.17g\n", name, solver, aims[kind],
           r->origin[0], r->origin[1], r->origin[2], r->direction[0], r->direction[1], r->direction[2],
           hits[n].patch == HIT_NONE ? INFINITY : hits[n].t, occluded[n], truth.verdict, truth.t_first);
  }
  return leaks;
}

struct leaks {
  const char *solver;
  size_t rays, leaks;
};

static void try_packet(void *context, struct trial *trial, const struct placed_model *at, int kind, size_t count,
                       struct random *random)
{
  struct leaks *leaks = context;
  struct ray rays[PACKET_SIZE] = {{.t_min = 0}}; /* gcc does not know that there is at least one */
  for (size_t n = 0; n < count; n++) random_ray(at, kind, random, &rays[n]);
  leaks->leaks += count_leaks(trial, at->model.name, leaks->solver, kind, count, rays);
  leaks->rays += count;
}

static size_t leaks_of(const struct method *options, size_t wanted, uint64_t seed)
{
  const struct placed_shares shares = {
    .models = models, .model_count = MODELS, .kind_count = AIMS, .exact = EXACT_SHARE, .shift = 1e6};
  struct random random = {.state = seed = effort_seed(seed)};
  struct leaks leaks = {.solver = options->roots.solver->name};
  placed_rays(&shares, options, wanted, &random, try_packet, &leaks);
  printf("seed %llu, solver %s, split %d: %zu rays, %zu leaks\n", (unsigned long long)seed, leaks.solver,
         options->split, leaks.rays, leaks.leaks);
  return leaks.leaks;
}

TEST(test_default)
{
  struct method options;
  method_default(solver_at(0), &options);
  assert_int_equal(leaks_of(&options, effort_count(FULL_RAYS, 4000), 401), 0);
}

TEST(test_other_solvers)
{
  size_t leaks = 0;
  for (size_t n = 1; n < solver_count(); n++) {
    struct method options;
    method_default(solver_at(n), &options);
    leaks += leaks_of(&options, effort_count((size_t)(OTHERS_SHARE * FULL_RAYS), 1000), 402 + n);
  }
  assert_int_equal(leaks, 0);
}

/* Whole patches, and numbers of leaves other than the default's. */
TEST(test_splits)
{
  static const int splits[] = {1, 2, 3, 16};
  size_t leaks = 0;
  for (size_t n = 0; n < sizeof splits / sizeof splits[0]; n++) {
    struct method options;
    method_default(solver_at(0), &options);
    options.split = splits[n];
    leaks += leaks_of(&options, effort_count((size_t)(OTHERS_SHARE * FULL_RAYS), 1000), 420 + n);
  }
  assert_int_equal(leaks, 0);
}

/* Rays from a hit inside the ball to another point of it: the chord ends there and nowhere before. Outwards there is
 * nothing. The ball of cubics is convex except for 3e-4 of its radius, hence the least angle. */
TEST(test_leave)
{
  const double least_cosine = 0.1, least_chord = 0.1;
  size_t wanted = effort_count(FULL_RAYS / 10, 800), acne = 0, skipped = 0, outwards = 0;
  static const double scales[] = {1, 1e6, 1e-6, 1}, shifts[] = {0, 1e6, 1e-6, 1e4};
  struct random random = {.state = effort_seed(403)};
  for (int place = 0; place < 4; place++) {
    struct placed_model at;
    struct trial trial;
    model_placed(model_ball, &random, scales[place], shifts[place], true, &at);
    trial_create(&trial, (const double(*)[4][4][3])at.placed.P, at.placed.count, NULL);
    for (size_t n = 0; n < wanted / 4; n++) {
      struct ray ray, next = {.t_min = 0, .t_max = INFINITY}, goal;
      struct hit hit, second;
      random_ray(&at, (int)(n % AIMS), &random, &ray);
      random_ray(&at, (int)(n / AIMS % AIMS), &random, &goal);
      tracer_closest(trial.tracer, 1, &ray, &hit);
      if (hit.patch == HIT_NONE) continue; /* whether that is a leak, other tests decide */
      double cosine = 0, length = 0;
      for (int axis = 0; axis < 3; axis++) {
        next.direction[axis] = goal.origin[axis] + goal.direction[axis] - hit.point[axis];
        cosine += next.direction[axis] * hit.normal[axis];
        length += next.direction[axis] * next.direction[axis];
      }
      if (!(sqrt(length) > least_chord * scales[place]) || cosine < least_cosine * sqrt(length)) continue;
      tracer_leave(trial.tracer, &ray, &hit, next.direction, next.origin);
      tracer_closest(trial.tracer, 1, &next, &second);
      if (second.patch == HIT_NONE || second.t > 1.01) skipped++;
      if (second.patch != HIT_NONE && second.t < 0.99) acne++;
      for (int axis = 0; axis < 3; axis++) next.direction[axis] = -next.direction[axis];
      tracer_leave(trial.tracer, &ray, &hit, next.direction, next.origin);
      bool occluded;
      tracer_occluded(trial.tracer, 1, &next, &occluded);
      outwards += occluded;
    }
    trial_destroy(&trial);
  }
  printf("seed 403: struck at the start %zu, slipped through %zu, struck outwards %zu\n", acne, skipped, outwards);
  assert_int_equal(acne + skipped + outwards, 0);
}
