/* Small scenes and awkward rays. */
#include "property/world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/patch.h"
#include "geometry/vector.h"

/* Rounds to a multiple of 2^-20, so that scaled and moved nets are exact too. */
static double grain(double x) { return rint(x * 0x1p20) * 0x1p-20; }

static void set(double p[3], double x, double y, double z) { p[0] = grain(x), p[1] = grain(y), p[2] = grain(z); }

static size_t fill_grid(struct random *random, world_net nets[])
{
  enum { SIDE = 3 };
  double height[3 * SIDE + 1][3 * SIDE + 1];
  for (int i = 0; i <= 3 * SIDE; i++)
    for (int j = 0; j <= 3 * SIDE; j++) height[i][j] = random_between(random, -0.2, 0.2);
  for (int p = 0; p < SIDE * SIDE; p++) {
    for (int n = 0; n < 16; n++) {
      const int i = p / SIDE * 3 + n / 4, j = p % SIDE * 3 + n % 4;
      set(nets[p][n / 4][n % 4], i / 4.5 - 1, j / 4.5 - 1, height[i][j]);
    }
  }
  return SIDE * SIDE;
}

static size_t fill_wild(struct random *random, world_net nets[])
{
  for (int p = 0; p < 4; p++)
    for (int n = 0; n < 16; n++)
      set(nets[p][n / 4][n % 4], random_between(random, -1, 1), random_between(random, -1, 1),
          random_between(random, -1, 1));
  return 4;
}

/* Quarter turns of a profile, by the usual cubic for a circle; u = 0 is the pole. */
static size_t fill_dome(struct random *random, world_net nets[])
{
  static const double turn[13][2] = {{1, 0},      {1, 0.552},  {0.552, 1},   {0, 1},       {-0.552, 1},
                                     {-1, 0.552}, {-1, 0},     {-1, -0.552}, {-0.552, -1}, {0, -1},
                                     {0.552, -1}, {1, -0.552}, {1, 0}};
  const double radius[4] = {0, random_between(random, 0.3, 0.6), 1, 1}, height[4] = {0.9, 0.9, 0.5, 0};
  for (int p = 0; p < 4; p++)
    for (int n = 0; n < 16; n++) {
      const double *at = turn[3 * p + n % 4];
      set(nets[p][n / 4][n % 4], radius[n / 4] * at[0], radius[n / 4] * at[1], height[n / 4]);
    }
  return 4;
}

static size_t fill_flat(struct random *random, world_net nets[])
{
  const double tilt = random_bits(random) % 2 ? 0 : random_between(random, -1, 1);
  for (int p = 0; p < 6; p++) {
    for (int n = 0; n < 16; n++) {
      const double bend = p > 3 && n / 4 % 3 && n % 4 % 3 ? random_between(random, -0.2, 0.2) : 0;
      const double x = grain((n / 4 + bend) / 3 - (p % 2)), y = grain((n % 4 + bend) / 3 - (p / 2 % 2));
      set(nets[p][n / 4][n % 4], x, y, grain(tilt) * x);
    }
  }
  memcpy(nets[6], nets[1], sizeof nets[1]); /* one exactly on top of another, and one turned round */
  for (int n = 0; n < 16; n++) memcpy(nets[7][n / 4][n % 4], nets[2][3 - n / 4][3 - n % 4], sizeof nets[7][0][0]);
  return 8;
}

static size_t fill_low(struct random *random, world_net nets[])
{
  for (int p = 0; p < 9; p++) {
    const int m = 1 + p / 3, n = 1 + p % 3;
    double low[3][4][4];
    for (int k = 0; k < 48; k++) low[k / 16][k / 4 % 4][k % 4] = random_between(random, -1, 1);
    /* a cubic with the values of a polynomial of degree (m,n) at its four nodes, by degree elevation */
    for (int e = 0; e < 16; e++) {
      double point[3];
      const double s = (e / 4) / 3.0, t = (e % 4) / 3.0;
      for (int k = 0; k < 3; k++) {
        /* Blossoms of u^a at the control values: u -> i/3, u^2 -> i(i-1)/6, u^3 -> [i = 3]. */
        const double bu[4] = {1, s, e / 4 * (e / 4 - 1) / 6.0, e / 4 == 3},
                     bv[4] = {1, t, e % 4 * (e % 4 - 1) / 6.0, e % 4 == 3};
        point[k] = 0;
        for (int a = 0; a <= m; a++)
          for (int b = 0; b <= n; b++) point[k] += low[k][a][b] * bu[a] * bv[b] * 0.5;
      }
      memcpy(nets[p][e / 4][e % 4], point, sizeof point); /* not rounded by grain: that would raise the degree again */
    }
  }
  return 9;
}

static size_t fill_degenerate(struct random *random, world_net nets[])
{
  fill_wild(random, nets), fill_wild(random, nets + 4);
  for (int n = 0; n < 16; n++) {
    double(*net)[4][3] = nets[0];
    set(net[n / 4][n % 4], 0.25, 0.5, -0.125);                              /* a point */
    memcpy(nets[1][n / 4][n % 4], nets[1][0][n % 4], sizeof nets[1][0][0]); /* a curve */
    set(nets[2][n / 4][n % 4], n / 4 / 3.0, n / 4 / 3.0, 0.5);              /* a line */
    nets[3][n / 4][n % 4][2] = 0.25;                                        /* folded flat */
    /* ruled: each half of the rows is equal */
    memcpy(nets[4][n / 4][n % 4], nets[4][n / 4 > 1 ? 3 : 0][n % 4], sizeof nets[4][0][0]);
    if (n / 4 == 0) memcpy(nets[5][0][n % 4], nets[5][0][0], sizeof nets[5][0][0]); /* collapsed at u = 0 */
    if (n % 4 == 3) memcpy(nets[5][n / 4][3], nets[5][0][3], sizeof nets[5][0][0]); /* and at v = 1 */
    /* two poles */
    if (n / 4 == 0 || n / 4 == 3) memcpy(nets[6][n / 4][n % 4], nets[6][n / 4][0], sizeof nets[6][0][0]);
    memcpy(nets[7][n / 4][n % 4], nets[7][n % 4][n / 4], sizeof nets[7][0][0]); /* folded on its diagonal */
  }
  return 8;
}

size_t world_fill(enum world_kind kind, struct random *random, world_net nets[WORLD_MAX])
{
  switch (kind) {
  case WORLD_GRID: return fill_grid(random, nets);
  case WORLD_WILD: return fill_wild(random, nets);
  case WORLD_DOME: return fill_dome(random, nets);
  case WORLD_FLAT: return fill_flat(random, nets);
  case WORLD_LOW: return fill_low(random, nets);
  default: return fill_degenerate(random, nets);
  }
}

void world_open(struct world *world, world_net *nets, size_t count, const struct method *options)
{
  memset(world, 0, sizeof *world);
  if (options) world->solver = *options;
  else method_default(solver_at(0), &world->solver);
  world->scene.solvers = &world->solver, world->scene.solver_count = 1;
  world->scene.patches = calloc(count + 1, sizeof *world->scene.patches);
  assert_non_null(world->scene.patches);
  world->scene.patch_count = count;
  for (size_t p = 0; p < count; p++) memcpy(world->scene.patches[p].P, nets[p], sizeof nets[p]);
  world_prepare(world);
}

void world_prepare(struct world *world)
{
  assert_int_equal(intersector_create(&world->scene, &world->intersector), STATUS_OK);
  assert_int_equal(tracer_create(world->intersector, &world->tracer), STATUS_OK);
}

void world_close(struct world *world)
{
  tracer_destroy(world->tracer);
  intersector_destroy(world->intersector);
  free(world->scene.patches), free(world->scene.copies);
}

/* The point and the derivatives of a net. */
static void surface(world_net net, double u, double v, double point[3], double du[3], double dv[3])
{
  for (int k = 0; k < 3; k++) {
    double x[4][4];
    for (int n = 0; n < 16; n++) x[n / 4][n % 4] = net[n / 4][n % 4][k];
    const struct patch_jet jet = patch_evaluate(x, u, v);
    point[k] = jet.value, du[k] = jet.du, dv[k] = jet.dv;
  }
}

struct ray world_ray(struct random *random, world_net *nets, size_t count, int kind)
{
  struct ray ray = {{0}, {0}, 0, INFINITY};
  const size_t p = random_bits(random) % count;
  double u = random_unit(random), v = random_unit(random), point[3], du[3], dv[3];
  const double eighths[2] = {(double)(random_bits(random) % 9) / 8, (double)(random_bits(random) % 9) / 8};
  if (kind == 1) u = eighths[0];                 /* a line of constant u: a border, or where leaves meet */
  if (kind == 2) u = eighths[0], v = eighths[1]; /* a corner of leaves */
  if (kind == 3 && random_bits(random) % 2) v = eighths[1];
  surface(nets[p], u, v, point, du, dv);
  for (int k = 0; k < 3; k++) ray.origin[k] = random_between(random, -3, 3);
  if (kind == 6) /* from far away */
    for (int k = 0; k < 3; k++) ray.origin[k] *= 1e6;
  for (int k = 0; k < 3; k++) ray.direction[k] = point[k] - ray.origin[k];
  if (kind == 3) { /* tangent */
    const double a = random_between(random, -1, 1), b = random_between(random, -1, 1);
    for (int k = 0; k < 3; k++)
      ray.direction[k] = a * du[k] + b * dv[k], ray.origin[k] = point[k] - 2 * ray.direction[k];
  }
  if (kind == 4) { /* along an axis */
    const int axis = (int)(random_bits(random) % 3);
    const double sign = random_bits(random) % 2 ? 1 : -1;
    for (int k = 0; k < 3; k++)
      ray.direction[k] = k == axis ? sign : sign * 0.0, ray.origin[k] = point[k] - 4 * ray.direction[k];
  }
  if (kind == 5) /* from the surface, anywhere */
    for (int k = 0; k < 3; k++) ray.origin[k] = point[k], ray.direction[k] = random_between(random, -1, 1);
  if (kind == 7) /* missing more often than hitting */
    for (int k = 0; k < 3; k++) ray.direction[k] += random_between(random, -1, 1);
  if (ray.direction[0] == 0 && ray.direction[1] == 0 && ray.direction[2] == 0) ray.direction[2] = 1;
  return ray;
}

void on_all_stages(uint64_t seed, int scenes, const struct method *options, void (*body)(struct set_up *stage))
{
  static struct set_up stage;
  static world_net nets[WORLD_MAX];
  struct random random = {seed};
  for (int kind = 0; kind < WORLD_KINDS; kind++) {
    for (int scene = 0; scene < scenes; scene++) {
      struct world world;
      stage.kind = kind, stage.random = &random, stage.world = &world, stage.nets = nets;
      stage.count = world_fill((enum world_kind)kind, &random, nets);
      world_open(&world, nets, stage.count, options);
      for (int n = 0; n < STAGE_RAYS; n++) stage.rays[n] = world_ray(&random, nets, stage.count, n % RAY_KINDS);
      body(&stage);
      world_close(&world);
    }
  }
}

void world_ask_both(struct tracer *const tracers[2], struct random *random, world_net *nets, size_t count, int first,
                    struct asked *out)
{
  for (int l = 0; l < ASKED_RAYS; l++) out->rays[l] = world_ray(random, nets, count, (first + l) % RAY_KINDS);
  for (int k = 0; k < 2; k++) {
    tracer_closest(tracers[k], ASKED_RAYS, out->rays, out->hit[k]);
    tracer_occluded(tracers[k], ASKED_RAYS, out->rays, out->occluded[k]);
    assert_int_equal(tracer_all(tracers[k], ASKED_RAYS, out->rays, out->list[k]), STATUS_OK);
  }
}

bool same_hit(const struct hit *a, const struct hit *b)
{
  if (a->patch != b->patch || a->certainty != b->certainty) return false;
  if (a->patch == HIT_NONE) return true;
  return a->t == b->t && a->u == b->u && a->v == b->v && a->point_error == b->point_error &&
         !memcmp(a->point, b->point, sizeof a->point) && !memcmp(a->normal, b->normal, sizeof a->normal);
}

bool same_list(const struct hit_list *a, const struct hit_list *b)
{
  bool same = a->certainty == b->certainty && a->count == b->count;
  for (size_t k = 0; same && k < a->count; k++) same = same_hit(&a->hits[k], &b->hits[k]);
  return same;
}

void world_print_case(const char *what, int kind, const struct ray *r, const struct hit *a, const struct hit *b)
{
  print_message("%s: world %d, origin %.17g %.17g %.17g, direction %.17g %.17g %.17g, t %.17g to %.17g\n", what, kind,
                r->origin[0], r->origin[1], r->origin[2], r->direction[0], r->direction[1], r->direction[2], r->t_min,
                r->t_max);
  const struct hit *both[2] = {a, b};
  for (int k = 0; k < 2; k++) {
    const struct hit *h = both[k];
    if (h->patch == HIT_NONE) print_message("  miss %d\n", h->certainty);
    else print_message("  patch %u t %.17g u %.17g v %.17g certainty %d\n", h->patch, h->t, h->u, h->v, h->certainty);
  }
}

void assert_same_hit(const char *what, int kind, const struct ray *ray, const struct hit *a, const struct hit *b)
{
  if (same_hit(a, b)) return;
  world_print_case(what, kind, ray, a, b);
  fail();
}

void world_towards(struct random *random, const double at[3], double off, struct ray *ray)
{
  for (int k = 0; k < 3; k++) {
    ray->origin[k] = random_between(random, -6, 6);
    ray->direction[k] = at[k] + off * random_between(random, -1, 1) - ray->origin[k];
  }
}

/* How far apart two right answers may be, as a difference of t: last places of a point and of t, divided by the sine
 * of the angle of incidence. */
static double tolerance(const struct ray *ray, const struct hit *hit)
{
  const double length = vector_length(ray->direction);
  const double steep = fabs(vector_dot(ray->direction, hit->normal)) / length;
  return 4 * hit->point_error / (steep * length) + 0x1p-51 * hit->t;
}

bool hits_agree(const struct ray *ray, const struct hit *a, const struct hit *b)
{
  if (a->certainty != CERTAINTY_CERTAIN || b->certainty != CERTAINTY_CERTAIN) return true;
  if ((a->patch == HIT_NONE) != (b->patch == HIT_NONE)) return false;
  if (a->patch == HIT_NONE) return true;
  return fabs(a->t - b->t) <= tolerance(ray, a) + tolerance(ray, b);
}

struct hit world_closest(const struct world *world, const struct ray *ray)
{
  struct hit hit;
  memset(&hit, 0, sizeof hit);
  tracer_closest(world->tracer, 1, ray, &hit);
  return hit;
}

struct hit_list world_all(const struct world *world, const struct ray *ray)
{
  struct hit_list list;
  assert_int_equal(tracer_all(world->tracer, 1, ray, &list), STATUS_OK);
  return list;
}

void world_scale_net(world_net net, double factor, double offset, world_net out)
{
  for (int n = 0; n < 48; n++) out[n / 12][n / 3 % 4][n % 3] = net[n / 12][n / 3 % 4][n % 3] * factor + offset;
}
