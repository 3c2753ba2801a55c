/* Proves that no ray leaves a closed model. Rays from inside the dome, the ball, the torus and the teapot are aimed
 * exactly at shared edges, corners, poles and iso-lines (where leaves of a patch meet), general and axis-aligned, with
 * every solver.
 *
 * A ray `origin + t (target - origin)` with the target on the surface hits at t = 1 or before. So a ray that slips
 * through at the target is noticed even if it strikes the far wall. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "accuracy/generate.h"
#include "accuracy/placed_rays.h"
#include "cmocka_test.h"
#include "effort.h"

enum { FULL_RAYS = 10000000, MOST_SHOWN = 12 };

/* A target is evaluated in doubles, so t = 1 is off by some roundings of the largest coordinate over the distance. 1e-7
 * suffices for a shift of 1e6 seen from 0.1 away. */
#define AT_TARGET 1e-7

static void (*const models[])(struct closed_model *) = {model_dome, model_ball, model_torus, model_teapot};

static const struct placed_shares shares = {.models = models,
                                            .model_count = sizeof models / sizeof models[0],
                                            .aims = {[AIM_EDGE] = 0.16,
                                                     [AIM_CORNER] = 0.14,
                                                     [AIM_EIGHTH] = 0.25,
                                                     [AIM_ANYWHERE] = 0.15,
                                                     [AIM_NEAR_EDGE] = 0.15,
                                                     [AIM_NEAR_POLE] = 0.15},
                                            .exact = 0.02,
                                            .shift = 1e6,
                                            .others = 0.02};

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
static bool inside(const struct closed_model *model, const double p[3])
{
  const double r = sqrt(p[0] * p[0] + p[2] * p[2]);
  if (!strcmp(model->name, "torus")) return (r - 1) * (r - 1) + p[1] * p[1] < 0.35 * 0.35;
  if (!strcmp(model->name, "dome") && p[1] < 0.05) return false;
  if (!strcmp(model->name, "teapot")) return r < 0.5 && p[1] > 0.2 && p[1] < 0.8;
  return r * r + p[1] * p[1] < 0.9 * 0.9;
}

static bool at_open_border(const struct closed_model *model, size_t patch, double u, double v)
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

static void random_ray(const struct placed_model *at, enum aim aim, struct random *random, struct ray *ray)
{
  const struct closed_model *model = &at->model;
  double u, v, target[3], origin[3];
  size_t patch;
  do patch = (size_t)(random_bits(random) % model->count);
  while (model->other[patch]);
  do {
    do {
      u = random_unit(random), v = random_unit(random);
      aim_at(aim, random_bits(random), random, &u, &v);
    } while (at_open_border(model, patch, u, v));
    net_point(model->P[patch], u, v, target);
    model_inside(model, random, origin);
    if (!at->moved && random_bits(random) % 2) align(random, target, origin);
  } while (!inside(model, origin));
  net_point(at->placed.P[patch], u, v, target);
  placed_point(at, origin);
  pull(random, target, origin);
  ray_between(origin, target, ray);
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

static void try_packet(void *context, struct trial *trial, const struct placed_model *at, enum aim aim, size_t count,
                       struct random *random)
{
  size_t *leaks = context;
  struct ray rays[PACKET_SIZE] = {{.t_min = 0}}; /* gcc does not know that there is at least one */
  struct hit hits[PACKET_SIZE];
  bool occluded[PACKET_SIZE];
  for (size_t n = 0; n < count; n++) random_ray(at, aim, random, &rays[n]);
  tracer_closest(trial->tracer, count, rays, hits);
  tracer_occluded(trial->tracer, count, rays, occluded);
  for (size_t n = 0; n < count; n++) {
    const bool struck = hits[n].patch != HIT_NONE;
    if (struck == occluded[n] && ((struck && hits[n].t <= 1 + AT_TARGET) || right_after_all(trial, &rays[n], &hits[n])))
      continue;
    if ((*leaks)++ >= MOST_SHOWN) continue;
    printf("leak: %s, %s, %s, occluded %d\n", at->model.name, trial->solver.roots.solver->name, aim_names[aim],
           occluded[n]);
    print_ray(&rays[n]), print_hit("answer", &hits[n]);
  }
}

TEST(no_ray_leaks)
{
  size_t leaks = 0;
  placed_rays(&shares, effort_count(FULL_RAYS, 4000), effort_seed(401), try_packet, &leaks);
  assert_int_equal(leaks, 0);
}
