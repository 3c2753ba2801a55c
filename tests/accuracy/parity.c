/* Proves inside and outside by parity: the number of all hits of a ray with a closed model, if certain, is odd for a
 * start inside and even for one outside. Rays are aimed exactly at shared edges, corners, poles and iso-lines, next to
 * them, along tangents of the surface and along the axes, from inside and from outside, with every solver and with
 * whole patches. Every wrong answer must be called grazing. */
#include <math.h>
#include <stdio.h>

#include "accuracy/generate.h"
#include "accuracy/placed_rays.h"
#include "cmocka_test.h"
#include "effort.h"

enum { FULL_RAYS = 20000000, LEAST_RAYS = 4000, MOST_SHOWN = 12 };

static void (*const models[])(struct closed_model *) = {model_dome, model_ball, model_torus};

/* Rays with any aim take the path of nearly all rays of a picture, and a tenth to a thirtieth of the time of the others,
 * which mostly reach the last resort. */
static const struct placed_shares shares = {.models = models,
                                            .model_count = sizeof models / sizeof models[0],
                                            .aims = {[AIM_EDGE] = 0.04,
                                                     [AIM_CORNER] = 0.02,
                                                     [AIM_POLE] = 0.015,
                                                     [AIM_EIGHTH] = 0.12,
                                                     [AIM_ANYWHERE] = 0.69,
                                                     [AIM_NEAR_EDGE] = 0.05,
                                                     [AIM_NEAR_POLE] = 0.02,
                                                     [AIM_TANGENT] = 0.045},
                                            .exact = 0.1,
                                            .shift = 1e3,
                                            .others = 0.01};

/* Every model lies within this distance of the middle. A point that model_inside has is inside, moved by rounding or
 * not. */
#define OUTSIDE 4.0

struct aimed {
  size_t patch;
  double u, v;
};

/* What the rays of a packet have in common. In most packets they are aimed at one eighth of one patch and start next to
 * each other, as in a picture; in the others they have nothing in common. */
struct common {
  uint64_t patch, bits; /* bits: which border, which end */
  double cell_u, cell_v, inside[3];
};
enum { COHERENT_OF_4 = 3, CELLS = 8 };
#define APART 0.05

static void common_choose(const struct closed_model *model, struct random *random, struct common *out)
{
  out->patch = random_bits(random), out->bits = random_bits(random);
  out->cell_u = (double)(random_bits(random) % CELLS), out->cell_v = (double)(random_bits(random) % CELLS);
  model_inside(model, random, out->inside);
}

static struct aimed aim(enum aim kind, const struct closed_model *model, const struct common *common,
                        struct random *random)
{
  struct aimed at = {(size_t)(common->patch % model->count), (common->cell_u + random_unit(random)) / CELLS,
                     (common->cell_v + random_unit(random)) / CELLS};
  aim_at(kind, common->bits, random, &at.u, &at.v);
  return at;
}

/* Makes one axis of the direction, or two, zero. */
static void align(struct random *random, double direction[3])
{
  const uint64_t bits = random_bits(random);
  const size_t axis = bits % 3;
  direction[(axis + 1) % 3] *= (double)(bits >> 8 & 1);
  direction[axis] = 0;
  if (direction[(axis + 1) % 3] == 0 && direction[(axis + 2) % 3] == 0) direction[(axis + 2) % 3] = 1;
}

/* The direction of a ray at the point, seen from inside the model. */
static void choose_direction(enum aim kind, const struct closed_model *model, const struct common *common,
                             const struct aimed *at, const double target[3], struct random *random, double out[3])
{
  double along[2][3];
  for (int k = 0; k < 3; k++) out[k] = target[k] - (common->inside[k] + APART * random_between(random, -1, 1));
  if (kind != AIM_TANGENT) return;
  net_tangents((const double(*)[4][3])model->P[at->patch], at->u, at->v, along[0], along[1]);
  const double part = random_between(random, -1, 1),
               off = random_bits(random) % 2 ? 0 : pow(10, -random_between(random, 3, 18));
  for (int k = 0; k < 3; k++) out[k] = part * along[0][k] + (1 - fabs(part)) * along[1][k] + off * out[k];
}

/* A ray through a point of the model that starts outside; or inside, at a point from which that one is seen. */
static bool make_ray(const struct placed_model *in, enum aim kind, const struct common *common, struct random *random,
                     struct ray *ray)
{
  const struct closed_model *model = &in->model;
  const struct aimed at = aim(kind, model, common, random);
  double target[3], direction[3], origin[3];
  bool inside = random_bits(random) % 2 && kind != AIM_TANGENT;
  net_point((const double(*)[4][3])model->P[at.patch], at.u, at.v, target);
  choose_direction(kind, model, common, &at, target, random, direction);
  if (!inside && !in->moved && random_bits(random) % 2) align(random, direction);
  double size = 0;
  for (int k = 0; k < 3; k++) size = fmax(size, fabs(direction[k]));
  if (!(size > 0)) direction[0] = size = 1;
  for (int k = 0; k < 3; k++) origin[k] = target[k] - direction[k] * (inside ? 1 : OUTSIDE / size);
  net_point((const double(*)[4][3])in->placed.P[at.patch], at.u, at.v, target);
  placed_point(in, origin);
  ray_between(origin, target, ray);
  /* The rounded start would turn the direction a little; so it is exactly along the axes. */
  if (!in->moved && !inside)
    for (int k = 0; k < 3; k++) ray->direction[k] = direction[k];
  return inside;
}

struct count {
  size_t rays, grazing, wrong;
};

static void count_packet(struct trial *trial, const char *name, size_t count, const struct ray rays[],
                         const bool inside[], struct count *to)
{
  struct hit_list lists[PACKET_SIZE];
  assert_int_equal(tracer_all(trial->tracer, count, rays, lists), STATUS_OK);
  for (size_t n = 0; n < count; n++) {
    const bool grazing = lists[n].certainty == CERTAINTY_GRAZING;
    to->rays++, to->grazing += grazing;
    if (grazing || lists[n].count % 2 == (inside[n] ? 1 : 0)) continue;
    if (to->wrong++ >= MOST_SHOWN) continue;
    printf("parity: %s, %s, from %s: %zu hits\n", name, trial->solver.roots.solver->name,
           inside[n] ? "inside" : "outside", lists[n].count);
    print_ray(&rays[n]);
    for (size_t k = 0; k < lists[n].count && k < MOST_SHOWN; k++) print_hit("hit", &lists[n].hits[k]);
  }
}

/* Makes a packet and counts it. Rays exactly along axes and exactly through their aims are only made for models that
 * are not moved. */
static void try_packet(void *context, struct trial *trial, const struct placed_model *at, enum aim kind, size_t count,
                       struct random *random)
{
  struct ray rays[PACKET_SIZE] = {{{0}, {0}, 0, 0}};
  bool inside[PACKET_SIZE];
  const bool coherent = random_bits(random) % 4 < COHERENT_OF_4;
  struct common common;
  for (size_t n = 0; n < count; n++) {
    if (n == 0 || !coherent) common_choose(&at->model, random, &common);
    inside[n] = make_ray(at, kind, &common, random, &rays[n]);
  }
  count_packet(trial, at->model.name, count, rays, inside, context);
}

TEST(test_models)
{
  struct count count = {0};
  placed_rays(&shares, effort_count(FULL_RAYS, LEAST_RAYS), effort_seed(811), try_packet, &count);
  printf("%zu rays, %zu grazing, %zu of wrong parity\n", count.rays, count.grazing, count.wrong);
  assert_int_equal(count.wrong, 0);
}
