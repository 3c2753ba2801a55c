/* Proves parity on closed surfaces that nobody would draw (cycle_nets.h): folded, self-intersecting, thin, skew,
 * graded, of whole numbers, with poles, seams, T-junctions and borders that four patches share. In half of them each
 * patch has a solver of its own. A ray that starts outside all control points meets the surface an even number of
 * times. Of rays that start at one point, wherever it is, either all meet it an even number of times or none does. The
 * nearest hit, and whether there is one, agree with the list of all hits. Every wrong answer must be called grazing. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "accuracy/cycle_scenes.h"
#include "accuracy/generate.h"
#include "accuracy/models.h"
#include "accuracy/trial.h"
#include "cmocka_test.h"
#include "effort.h"
#include "intersect/intersect.h"
#include "random.h"

enum {
  FULL_RAYS = 4000000,
  LEAST_RAYS = 512,
  PACKETS_A_CYCLE = 32,
  PACKETS_A_CROWD = 1024,
  MOST_SHOWN = 6,
  MOST_HITS_SHOWN = 16,
  TESTS_MOST = 12
};

/* Nearest hit and list agree in T up to some roundings of it and of the largest coordinate. */
#define SAME_T 1e-9
#define SAME_PLACE 0x1p-40

struct count {
  size_t rays, hits, grazing, wrong, differing, nearest_grazing, parts;
};

/* ---- rays ---- */

/* In the middle, on a border, at a corner, or next to one. */
static double parameter(struct random *random)
{
  static const size_t most = 6;
  const double end = (double)choose(random, 2), off = ldexp(1, -4 - (int)choose(random, 56));
  const size_t kind = choose(random, most);
  return kind == 0   ? end
         : kind == 1 ? fabs(end - off)
         : kind == 2 ? (double)choose(random, 9) / 8
                     : random_unit(random);
}

/* A point of a patch, and its tangents if `along` is given. */
static void some_point(const struct cycle_scene *s, struct random *random, double out[3], double along[2][3])
{
  const double(*P)[4][3] = (const double(*)[4][3])s->scene.patches[choose(random, s->scene.patch_count)].P;
  const double u = parameter(random), v = parameter(random);
  net_point(P, u, v, out);
  if (along) net_tangents(P, u, v, along[0], along[1]);
}

static double longest(const double d[3]) { return fmax(fmax(fabs(d[0]), fabs(d[1])), fabs(d[2])); }

/* Aimed at a point: from anywhere, along its tangent plane or next to that, or along axes. */
static void outside_ray(const struct cycle_scene *s, struct random *random, struct ray *ray)
{
  double at[3], along[2][3], d[3];
  some_point(s, random, at, along);
  random_direction(random, d);
  if (choose(random, 2)) {
    const double part = random_between(random, -1, 1), off = choose(random, 4) ? random_decade(random, 1, 18) : 0;
    for (int k = 0; k < 3; k++) d[k] = part * along[0][k] + (1 - fabs(part)) * along[1][k] + off * s->size * d[k];
  }
  const double length = longest(d);
  if (!(length > 0)) d[0] = 1;
  const double away = (choose(random, 4) ? 4 : 4 / random_decade(random, 0, 14)) * s->size / (length > 0 ? length : 1);
  for (int k = 0; k < 3; k++) ray->origin[k] = at[k] - away * d[k], ray->direction[k] = d[k];
}

/* Anywhere among the patches, or next to one. Not at a corner, because that is on the surface. */
static void inside_point(const struct cycle_scene *s, struct random *random, double out[3])
{
  double at[3], other[3];
  do {
    const double off = choose(random, 2) ? 1 : random_decade(random, 1, 17);
    some_point(s, random, at, NULL), some_point(s, random, other, NULL);
    for (int k = 0; k < 3; k++)
      out[k] = at[k] + off * (0.6 * (other[k] - at[k]) + 0.01 * s->size * random_between(random, -1, 1));
  } while (memcmp(out, at, sizeof at) == 0);
}

/* Whether the point is outside all control points, by far more than roundings. */
static bool is_outside(const struct cycle_scene *s, const double p[3])
{
  double off = 0;
  for (int k = 0; k < 3; k++) off = fmax(off, fabs(p[k] - s->middle[k]));
  return off > 1.5 * s->size;
}

/* A packet whose rays start outside, or all at one point. */
static bool make_rays(const struct cycle_scene *s, struct random *random, struct ray rays[PACKET_SIZE])
{
  const bool outside = choose(random, 2);
  double start[3];
  inside_point(s, random, start);
  for (int n = 0; n < PACKET_SIZE; n++) {
    struct ray *ray = &rays[n];
    do {
      *ray = (struct ray){.t_max = INFINITY};
      if (outside) {
        outside_ray(s, random, ray);
        continue;
      }
      some_point(s, random, ray->direction, NULL);
      for (int k = 0; k < 3; k++) ray->origin[k] = start[k], ray->direction[k] -= start[k];
      if (choose(random, 4) == 0) random_direction(random, ray->direction);
    } while (!(longest(ray->direction) > 0) || (outside && !is_outside(s, ray->origin)));
    const double scale = choose(random, 8) ? 1 : random_decade(random, -30, 30);
    for (int k = 0; k < 3; k++) ray->direction[k] *= scale;
  }
  return outside;
}

/* ---- answers ---- */

static void show(const char *what, const struct cycle_scene *s, const struct ray *ray, const struct hit_list *list,
                 const struct hit *hit)
{
  static size_t shown = 0;
  if (shown++ >= MOST_SHOWN) return;
  printf("%s: %zu hits\n", what, list->count);
  print_ray(ray), print_hit("nearest", hit);
  for (size_t k = 0; k < list->count && k < MOST_HITS_SHOWN; k++) print_hit("hit", &list->hits[k]);
  if (s->scene.patch_count <= CYCLE_MOST) print_patches(&s->scene);
}

static bool same_t(const struct cycle_scene *s, const struct ray *ray, double t, double other)
{
  const double size = longest(s->middle) + s->size + longest(ray->origin);
  return fabs(t - other) <= SAME_T * t + SAME_PLACE * size / longest(ray->direction);
}

static bool nearest_is(const struct cycle_scene *s, const struct ray *ray, const struct hit *hit,
                       const struct hit *first)
{
  if (!first || hit->patch == HIT_NONE) return !first && hit->patch == HIT_NONE;
  return same_t(s, ray, hit->t, first->t);
}

/* Part of a ray, from before a hit of its list to behind it, or to the end, if the hits are well apart. Returns that
 * hit. */
static const struct hit *part_of(const struct cycle_scene *s, struct random *random, const struct hit_list *list,
                                 struct ray *ray)
{
  const size_t k = choose(random, list->count + 1), last = list->count;
  const struct hit *hits = list->hits;
  const bool from = k > 0, to = k < last && k + 1 < last && choose(random, 2);
  const double least = from ? hits[k - 1].t : 0;
  if (k < last && from && same_t(s, ray, hits[k].t, least)) return NULL;
  if (to && same_t(s, ray, hits[k + 1].t, hits[k].t)) return NULL;
  if (from) ray->t_min = k < last ? least + (hits[k].t - least) / 2 : 2 * least;
  if (to) ray->t_max = hits[k].t + (hits[k + 1].t - hits[k].t) / 2;
  return k < last ? &hits[k] : NULL;
}

/* Compares the nearest hits of parts of the rays, and whether there are any, with the lists of the whole rays. */
static void ask_parts(const struct cycle_scene *s, struct random *random, size_t count, const struct ray whole[],
                      const struct hit_list lists[], struct count *to)
{
  struct ray rays[PACKET_SIZE];
  struct hit hits[PACKET_SIZE];
  bool occluded[PACKET_SIZE], clear[PACKET_SIZE];
  const struct hit *first[PACKET_SIZE];
  for (size_t n = 0; n < count; n++) {
    rays[n] = whole[n], first[n] = NULL;
    clear[n] = lists[n].certainty == CERTAINTY_CERTAIN && lists[n].count > 0;
    if (clear[n]) first[n] = part_of(s, random, &lists[n], &rays[n]);
    clear[n] &= first[n] || rays[n].t_min > 0;
  }
  tracer_closest(s->tracer, count, rays, hits);
  tracer_occluded(s->tracer, count, rays, occluded);
  for (size_t n = 0; n < count; n++) {
    if (!clear[n]) continue;
    to->parts++;
    if (occluded[n] == (first[n] != NULL) &&
        (hits[n].certainty == CERTAINTY_GRAZING || nearest_is(s, &rays[n], &hits[n], first[n])))
      continue;
    to->differing++, show("part differs", s, &rays[n], &lists[n], &hits[n]);
  }
}

static void ask(const struct cycle_scene *s, struct random *random, struct count *to)
{
  struct ray rays[PACKET_SIZE];
  struct hit hits[PACKET_SIZE];
  bool occluded[PACKET_SIZE];
  struct hit_list lists[PACKET_SIZE];
  const bool outside = make_rays(s, random, rays);
  const size_t count = choose(random, 4) ? PACKET_SIZE : 1 + choose(random, PACKET_SIZE);
  tracer_closest(s->tracer, count, rays, hits);
  tracer_occluded(s->tracer, count, rays, occluded);
  assert_int_equal(tracer_all(s->tracer, count, rays, lists), STATUS_OK);
  size_t certain[2] = {0, 0};
  for (size_t n = 0; n < count; n++)
    if (lists[n].certainty == CERTAINTY_CERTAIN) certain[lists[n].count % 2]++;
  const size_t expected = outside || certain[0] >= certain[1] ? 0 : 1;
  for (size_t n = 0; n < count; n++) {
    to->rays++, to->hits += lists[n].count;
    if (lists[n].certainty == CERTAINTY_GRAZING) {
      to->grazing++;
      continue;
    }
    const bool wrong = lists[n].count % 2 != expected;
    if (wrong) to->wrong++, show(outside ? "odd from outside" : "parity differs", s, &rays[n], &lists[n], &hits[n]);
    to->nearest_grazing += hits[n].certainty == CERTAINTY_GRAZING;
    if (hits[n].certainty == CERTAINTY_GRAZING && hits[n].patch != HIT_NONE) continue;
    const struct hit *first = lists[n].count > 0 ? &lists[n].hits[0] : NULL;
    if (nearest_is(s, &rays[n], &hits[n], first) && occluded[n] == (first != NULL)) continue;
    to->differing++, show("nearest or occluded differs", s, &rays[n], &lists[n], &hits[n]);
  }
  ask_parts(s, random, count, rays, lists, to);
}

static void print_count(const char *name, uint64_t seed, const struct count *c)
{
  printf("seed %llu, %s: %zu rays, %zu hits, %zu of wrong parity, %zu with another nearest one, of %zu parts too; "
         "grazing %.2f %%, nearest %.2f %%\n",
         (unsigned long long)seed, name, c->rays, c->hits, c->wrong, c->differing, c->parts,
         100 * (double)c->grazing / (double)c->rays, 100 * (double)c->nearest_grazing / (double)c->rays);
  fflush(stdout);
  assert_int_equal(c->wrong + c->differing, 0);
}

static void test_shape(void **state)
{
  const size_t shape = (size_t)(uintptr_t)*state;
  const uint64_t seed = effort_seed(840 + shape);
  struct random random = {.state = seed};
  struct count count = {0};
  const size_t wanted = effort_count(FULL_RAYS / cycle_shape_count(), LEAST_RAYS);
  while (count.rays < wanted) {
    struct cycle_scene scene;
    cycle_scene_create(shape, &random, &scene);
    for (size_t n = 0; n < PACKETS_A_CYCLE && count.rays < wanted; n++) ask(&scene, &random, &count);
    cycle_scene_destroy(&scene);
  }
  print_count(cycle_shape_name(shape), seed, &count);
}

/* Many instances of a surface: as copies, or as so many patches that none is kept. */
static void test_crowd(void **state)
{
  const bool copied = *state != NULL;
  const uint64_t seed = effort_seed(copied ? 850 : 851);
  struct random random = {.state = seed};
  struct count count = {0};
  const size_t wanted = effort_count(FULL_RAYS / 20, LEAST_RAYS), shapes = cycle_shape_count();
  for (size_t n = 0; count.rays < wanted; n++) {
    struct cycle_scene scene;
    size_t shape;
    do shape = choose(&random, shapes);
    while (!cycle_shape_moves(shape));
    cycle_crowd_create(shape, copied, &random, &scene);
    for (size_t k = 0; k < PACKETS_A_CROWD && count.rays < wanted; k++) ask(&scene, &random, &count);
    cycle_scene_destroy(&scene);
  }
  print_count(copied ? "copies" : "not kept", seed, &count);
}

int main(void)
{
  struct CMUnitTest tests[TESTS_MOST] = {
    {.name = "copies", .test_func = test_crowd, .initial_state = (void *)(uintptr_t)1},
    {.name = "not kept", .test_func = test_crowd}};
  assert_true(cycle_shape_count() + 2 <= TESTS_MOST);
  for (size_t n = 0; n < cycle_shape_count(); n++)
    tests[2 + n] = (struct CMUnitTest){
      .name = cycle_shape_name(n), .test_func = test_shape, .initial_state = (void *)(uintptr_t)n};
  return _cmocka_run_group_tests("cycles", tests, 2 + cycle_shape_count(), NULL, NULL);
}
