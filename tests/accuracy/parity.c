/* Proves inside and outside by parity: the number of all hits of a ray with a closed model, if certain, is odd for a
 * start inside and even for one outside. Rays are aimed exactly at shared edges, corners, poles and iso-lines, next to
 * them, along tangents of the surface and along the axes, from inside and from outside, with every solver and with
 * whole patches. Every wrong answer must be called grazing. */
#include <math.h>
#include <stdio.h>

#include "accuracy/placed_rays.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

enum { FULL_RAYS = 20000000, LEAST_RAYS = 4000, MOST_SHOWN = 12 };

/* See struct placed_shares. */
#define EXACT_SHARE 0.1

/* Each solver and form except the default gets this share of the rays. */
#define OTHERS_SHARE 0.005

static void (*const models[])(struct model *) = {model_dome, model_ball, model_torus};
enum { MODELS = sizeof models / sizeof models[0] };

static const char *const aims[] = {"edge", "corner", "pole", "eighth", "anywhere", "near edge", "near pole", "tangent"};
enum { AIM_EDGE, AIM_CORNER, AIM_POLE, AIM_EIGHTH, AIM_ANYWHERE, AIM_NEAR_EDGE, AIM_NEAR_POLE, AIM_TANGENT, AIMS };

/* Shares of the rays. Those with any aim take the path of nearly all rays of a picture, and a tenth to a thirtieth of
 * the time of the others, which mostly reach the last resort. */
static const double aim_shares[AIMS] = {0.04, 0.02, 0.015, 0.12, 0.69, 0.05, 0.02, 0.045};

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

static void common_choose(const struct model *model, struct random *random, struct common *out)
{
  out->patch = random_bits(random), out->bits = random_bits(random);
  out->cell_u = (double)(random_bits(random) % CELLS), out->cell_v = (double)(random_bits(random) % CELLS);
  model_inside(model, random, out->inside);
}

static struct aimed aim(int kind, const struct model *model, const struct common *common, struct random *random)
{
  const uint64_t bits = common->bits;
  const double tiny = ldexp(1, -(int)(random_bits(random) % 56) - 4), end = (double)(bits >> 8 & 1);
  struct aimed at = {(size_t)(common->patch % model->count), (common->cell_u + random_unit(random)) / CELLS,
                     (common->cell_v + random_unit(random)) / CELLS};
  double *fixed = bits >> 9 & 1 ? &at.u : &at.v;
  if (kind == AIM_EDGE) *fixed = end;
  if (kind == AIM_CORNER) at.u = end, at.v = (double)(bits >> 10 & 1);
  if (kind == AIM_POLE) at.u = 0;
  if (kind == AIM_EIGHTH) *fixed = (double)(bits >> 10 & 7) / 8;
  if (kind == AIM_NEAR_EDGE) *fixed = end > 0 ? 1 - tiny : tiny;
  if (kind == AIM_NEAR_POLE) at.u = tiny;
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
static void choose_direction(int kind, const struct model *model, const struct common *common, const struct aimed *at,
                             const double target[3], struct random *random, double out[3])
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
static bool make_ray(const struct placed_model *in, int kind, const struct common *common, struct random *random,
                     struct ray *ray)
{
  const struct model *model = &in->model;
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
  *ray = (struct ray){.t_max = INFINITY};
  for (int k = 0; k < 3; k++) {
    ray->origin[k] = origin[k];
    ray->direction[k] = target[k] - origin[k];
  }
  /* The rounded start would turn the direction a little; so it is exactly along the axes. */
  if (!in->moved && !inside)
    for (int k = 0; k < 3; k++) ray->direction[k] = direction[k];
  return inside;
}

struct count {
  size_t rays, hits, grazing[AIMS], aimed[AIMS], wrong;
};

static void show(const char *name, int kind, bool inside, const struct ray *ray, const struct hit_list *list)
{
  const double *o = ray->origin, *d = ray->direction;
  printf("parity: %s, %s, from %s: %zu hits; ray %.17g %.17g %.17g %.17g %.17g %.17g\n", name, aims[kind],
         inside ? "inside" : "outside", list->count, o[0], o[1], o[2], d[0], d[1], d[2]);
  for (size_t k = 0; k < list->count && k < MOST_SHOWN; k++)
    printf("  t %.17g u %.17g v %.17g patch %u\n", list->hits[k].t, list->hits[k].u, list->hits[k].v,
           (unsigned)list->hits[k].patch);
}

static void count_packet(struct trial *trial, const char *name, int kind, size_t count, const struct ray rays[],
                         const bool inside[], struct count *to)
{
  struct hit_list lists[PACKET_SIZE];
  assert_int_equal(tracer_all(trial->tracer, count, rays, lists), STATUS_OK);
  for (size_t n = 0; n < count; n++) {
    to->rays++, to->aimed[kind]++, to->hits += lists[n].count;
    to->grazing[kind] += lists[n].certainty == CERTAINTY_GRAZING;
    if (lists[n].certainty == CERTAINTY_GRAZING || lists[n].count % 2 == (inside[n] ? 1 : 0)) continue;
    if (to->wrong++ < MOST_SHOWN) show(name, kind, inside[n], &rays[n], &lists[n]);
  }
}

/* Makes a packet and counts it. Rays exactly along axes and exactly through their aims are only made for models that
 * are not moved. */
static void try_packet(void *context, struct trial *trial, const struct placed_model *at, int kind, size_t count,
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
  count_packet(trial, at->model.name, kind, count, rays, inside, context);
}

static size_t wrong_of(const struct method *options, size_t wanted, uint64_t seed)
{
  const struct placed_shares shares = {.models = models,
                                       .model_count = MODELS,
                                       .kind_count = AIMS,
                                       .kinds = aim_shares,
                                       .exact = EXACT_SHARE,
                                       .shift = 1e3};
  struct random random = {.state = seed = effort_seed(seed)};
  struct count count = {0};
  placed_rays(&shares, options, wanted, &random, try_packet, &count);
  printf("seed %llu, solver %s, split %d: %zu rays, %zu hits, %zu of wrong parity; grazing:", (unsigned long long)seed,
         options->roots.solver->name, options->split, count.rays, count.hits, count.wrong);
  for (int kind = 0; kind < AIMS; kind++)
    printf(" %s %.2f %%", aims[kind], 100 * (double)count.grazing[kind] / (double)count.aimed[kind]);
  printf("\n");
  fflush(stdout);
  return count.wrong;
}

/* ---- bodies with creases ---- */

/* A cube, and two pyramids base to base, whose faces are triangles: each has one border collapsed at its tip. Corners
 * are multiples of 9, so that all control points and aims are exact. */
enum { CUBE_FACES = 6, PYRAMIDS_FACES = 8, BODY_CORNERS = 8 };

static const double cube_corners[BODY_CORNERS][3] = {{-9, -9, -9}, {9, -9, -9}, {-9, 9, -9}, {9, 9, -9},
                                                     {-9, -9, 9},  {9, -9, 9},  {-9, 9, 9},  {9, 9, 9}};
static const int cube_faces[CUBE_FACES][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                                              {2, 3, 6, 7}, {0, 2, 4, 6}, {1, 3, 5, 7}};
static const double pyramids_corners[BODY_CORNERS][3] = {{0, 18, 0}, {0, -9, 0}, {9, 0, 0},
                                                         {0, 0, 9},  {-9, 0, 0}, {0, 0, -9}};
static const int pyramids_faces[PYRAMIDS_FACES][4] = {{0, 0, 2, 3}, {0, 0, 3, 4}, {0, 0, 4, 5}, {0, 0, 5, 2},
                                                      {1, 1, 3, 2}, {1, 1, 4, 3}, {1, 1, 5, 4}, {1, 1, 2, 5}};

struct body {
  const char *name;
  const double (*corners)[3];
  const int (*faces)[4]; /* corners at (u,v) = (0,0), (0,1), (1,0), (1,1) */
  size_t count;
};
static const struct body bodies[] = {{"cube", cube_corners, cube_faces, CUBE_FACES},
                                     {"pyramids", pyramids_corners, pyramids_faces, PYRAMIDS_FACES}};
enum { BODIES = sizeof bodies / sizeof bodies[0] };

static void body_point(const struct body *body, size_t face, double u, double v, double out[3])
{
  const int *c = body->faces[face];
  for (int k = 0; k < 3; k++)
    out[k] = (1 - u) * ((1 - v) * body->corners[c[0]][k] + v * body->corners[c[1]][k]) +
             u * ((1 - v) * body->corners[c[2]][k] + v * body->corners[c[3]][k]);
}

static void body_net(const struct body *body, size_t face, double out[4][4][3])
{
  const int *c = body->faces[face];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 3; k++)
        out[i][j][k] = ((3 - i) * ((3 - j) * body->corners[c[0]][k] + j * body->corners[c[1]][k]) +
                        i * ((3 - j) * body->corners[c[2]][k] + j * body->corners[c[3]][k])) /
                       9;
}

/* Exactly through a corner, or a point of an edge or a face, from outside or from a point inside. */
static bool body_ray(const struct body *body, struct random *random, struct ray *ray)
{
  const uint64_t bits = random_bits(random);
  const double end = (double)(bits >> 8 & 1), part = (double)(bits >> 16 & 15) / 16;
  const double u = bits % 3 == 2 ? (double)(bits >> 24 & 15) / 16 : end;
  const double v = bits % 3 == 0 ? (double)(bits >> 9 & 1) : part;
  const bool inside = bits >> 32 & 1, swap = bits >> 33 & 1;
  double target[3];
  body_point(body, random_bits(random) % body->count, swap ? v : u, swap ? u : v, target);
  *ray = (struct ray){.t_max = INFINITY};
  bool none = true;
  for (int k = 0; k < 3; k++) {
    const double step = (double)(random_bits(random) % 9) - 4;
    ray->direction[k] = inside ? target[k] - step / 2 : step;
    ray->origin[k] = inside ? step / 2 : target[k] - 64 * step;
    none &= ray->direction[k] == 0;
  }
  if (none) ray->direction[0] = 1, ray->origin[0] -= 64;
  return inside;
}

/* The sharpest test: rays that touch an edge or a corner from outside are grazing, those that cross it count it
 * once. */
TEST(test_creases)
{
  const uint64_t seed = effort_seed(830);
  struct random random = {.state = seed};
  const size_t wanted = effort_count(FULL_RAYS / 200, LEAST_RAYS / 2);
  for (int which = 0; which < BODIES; which++) {
    double P[PYRAMIDS_FACES][4][4][3];
    struct trial trial;
    struct count count = {0};
    for (size_t face = 0; face < bodies[which].count; face++) body_net(&bodies[which], face, P[face]);
    trial_create(&trial, (const double(*)[4][4][3])P, bodies[which].count, NULL);
    for (size_t first = 0; first < wanted; first += PACKET_SIZE) {
      struct ray rays[PACKET_SIZE];
      bool inside[PACKET_SIZE];
      for (size_t n = 0; n < PACKET_SIZE; n++) inside[n] = body_ray(&bodies[which], &random, &rays[n]);
      count_packet(&trial, bodies[which].name, AIM_CORNER, PACKET_SIZE, rays, inside, &count);
    }
    trial_destroy(&trial);
    printf("seed %llu, %s: %zu rays, %zu hits, %zu of wrong parity; grazing %.2f %%\n", (unsigned long long)seed,
           bodies[which].name, count.rays, count.hits, count.wrong,
           100 * (double)count.grazing[AIM_CORNER] / (double)count.rays);
    assert_int_equal(count.wrong, 0);
    /* Many touch the body, or lie in a face, but far from all. */
    assert_true(count.grazing[AIM_CORNER] < count.rays / 2);
  }
}

TEST(test_default)
{
  struct method options;
  method_default(solver_at(0), &options);
  assert_int_equal(wrong_of(&options, effort_count(FULL_RAYS, LEAST_RAYS), 811), 0);
}

TEST(test_others)
{
  static const int splits[] = {1, 2, 3, 16};
  const size_t wanted = effort_count((size_t)(OTHERS_SHARE * FULL_RAYS), LEAST_RAYS / 8);
  size_t wrong = 0;
  for (size_t n = 0; n < sizeof splits / sizeof splits[0] + solver_count() - 1; n++) {
    struct method options;
    const bool solver = n + 1 < solver_count();
    method_default(solver_at(solver ? n + 1 : 0), &options);
    if (!solver) options.split = splits[n + 1 - solver_count()];
    wrong += wrong_of(&options, wanted, 820 + n);
  }
  assert_int_equal(wrong, 0);
}
