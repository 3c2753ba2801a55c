/* Copies of an object that share its leaves are answered as patches with leaves of their own. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/wide.h"
#include "cmocka_test.h"
#include "copied.h"
#include "effort.h"
#include "intersect/intersect.h"
#include "intersect/model.h"
#include "property/world.h"

enum {
  SEED = 20261121,
  RAYS = 128,
  PATCHES = 1100,
  PACKET = 8,
  FULL_FAR_SCENES = 6000, /* preparing such a scene takes nearly all of the time */
  LEAST_FAR_SCENES = 3,
  BESIDE = 6,
  FULL_BESIDE_SCENES = 2000,
  LEAST_BESIDE_SCENES = 1
};

/* How the copies are made. */
struct plan {
  int kind; /* of the object's patches */
  void (*place)(const struct plan *plan, struct random *random, struct scene_copy *copy);
  bool single;           /* only the first of them */
  double parts;          /* 0, or the factor by which all but the first are scaled; that is then beside them */
  const struct ray *far; /* NULL, or a ray that passes the first copy at t = `at` */
  double at;
  size_t beside;   /* 0, or how many copies stand in one place up to roundings; the rays are then aimed at these */
  double sizes[3]; /* along the axes, powers of two, so that maps are exact */
  double off;      /* how far along x, at most, control points are from where the map puts them */
  double last_off; /* that of a control point of the last copy */
};

/* A scene of many copies of one object, with and without its list of copies. */
struct pair {
  int kind;
  struct scene scene;
  struct method solver;
  struct scene_object object;
  struct intersector *intersector[2];
  struct tracer *tracer[2];
  struct ray rays[RAYS];
};

/* Any affine map: rotated, skewed, mirrored, long or short, far away. */
static void random_map(const struct plan *plan, struct random *random, struct scene_copy *copy)
{
  (void)plan;
  copied_anyhow(random, ldexp(1, (int)(random_bits(random) % 13) - 6), 1000, copy);
}

/* Any such map about 0, of one size, so that all copies lie deep inside one another. */
static void about_zero(const struct plan *plan, struct random *random, struct scene_copy *copy)
{
  (void)plan;
  copied_anyhow(random, 1, 0, copy);
}

/* A shear along one axis, by at most MOST_SHEAR, in whole numbers throughout, so that control points stay exact. */
#define MOST_SHEAR 512

static void exact_shear(const struct plan *plan, struct random *random, struct scene_copy *copy)
{
  (void)plan;
  const int i = (int)(random_bits(random) % 3), k = (i + 1 + (int)(random_bits(random) % 2)) % 3;
  copy->A[i][k] = rint(random_between(random, -MOST_SHEAR, MOST_SHEAR));
  for (int n = 0; n < 3; n++) copy->b[n] = rint(random_between(random, -4096, 4096));
}

/* Scales about 0 and permutes the axes. Where copies are long, they are not deep inside one another; else they would
 * not share. */
static void exact_scale(const struct plan *plan, struct random *random, struct scene_copy *copy)
{
  (void)plan;
  const double size = ldexp(1, (int)(random_bits(random) % 8) - 4);
  const int turn = (int)(random_bits(random) % 3);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) copy->A[i][j] = (i + turn) % 3 == j ? (random_bits(random) % 2 ? size : -size) : 0;
}

/* Behind one another, apart. */
static void in_a_row(const struct plan *plan, struct random *random, struct scene_copy *copy)
{
  (void)random;
  for (int k = 0; k < 3; k++) copy->A[k][k] = plan->sizes[k];
  copy->b[2] = 4 * (double)copy->first_patch;
}

/* A translation that puts a corner next to where the ray passes. */
static void put_in_the_way(const struct plan *plan, world_net net, struct random *random, struct scene_copy *copy)
{
  const double inside = pow(2, random_between(random, -30, -10)) * (random_bits(random) % 4 ? 1 : -1);
  for (int k = 0; k < 3; k++) {
    const wide at = (wide)plan->far->origin[k] + (wide)plan->at * plan->far->direction[k];
    const double corner = net[0][0][k] + inside * (net[3][3][k] - net[0][0][k]);
    for (int i = 0; i < 3; i++) copy->A[i][k] = i == k;
    copy->b[k] = (double)at - corner;
  }
}

/* The place of the first copy, moved by some roundings along one axis. */
static void put_beside(const struct scene_copy *first, struct random *random, struct scene_copy *copy)
{
  double *b = &copy->b[random_bits(random) % 3];
  memcpy(copy->A, first->A, sizeof copy->A), memcpy(copy->b, first->b, sizeof copy->b);
  *b *= 1 + (double)(1 + random_bits(random) % 4) * 0x1p-52;
}

static void place_all(const struct plan *plan, struct random *random, struct scene *scene)
{
  struct scene_copy *copies = scene->copies;
  for (size_t c = 0; c < scene->copy_count; c++) {
    plan->place(plan, random, &copies[c]);
    if (c > 0 && c < plan->beside) put_beside(&copies[0], random, &copies[c]);
    if (plan->far && c == 0) put_in_the_way(plan, scene->objects->P[0], random, &copies[c]);
  }
  copied_place(scene);
  for (size_t n = 0; n < scene->patch_count * 16 && plan->off > 0; n++)
    scene->patches[n / 16].P[n / 4 % 4][n % 4][0] += random_between(random, -plan->off, plan->off);
  scene->patches[scene->patch_count - 1].P[0][0][0] += plan->last_off;
}

static void pair_open(struct pair *pair, struct random *random, const struct plan *plan)
{
  static world_net nets[WORLD_MAX];
  memset(pair, 0, sizeof *pair);
  pair->kind = plan->kind;
  const size_t filled = world_fill((enum world_kind)plan->kind, random, nets), count = plan->single ? 1 : filled;
  for (size_t n = 0; n < count * 16 && plan->parts > 0; n++) {
    double *x = nets[n / 16][n / 4 % 4][n % 4];
    for (int k = 0; k < 3; k++) x[k] = n < 16 ? x[k] / 8 + (k == 0 ? 2 : 0.25) : x[k] * plan->parts;
  }
  pair->object = (struct scene_object){nets, count};
  struct scene *scene = &pair->scene;
  method_default(solver_at(0), &pair->solver);
  scene->solvers = &pair->solver, scene->solver_count = 1;
  copied_open(scene, &pair->object, PATCHES / count);
  place_all(plan, random, scene);
  const size_t copies = scene->copy_count;
  for (int k = 0; k < 2; k++) {
    scene->copy_count = k == 0 ? copies : 0;
    assert_int_equal(intersector_create(scene, &pair->intersector[k]), STATUS_OK);
    assert_int_equal(tracer_create(pair->intersector[k], &pair->tracer[k]), STATUS_OK);
  }
  for (int n = 0; n < RAYS; n++) {
    world_net aim[WORLD_MAX];
    const size_t c = random_bits(random) % (plan->beside ? plan->beside : copies);
    for (size_t p = 0; p < count; p++) memcpy(aim[p], scene->patches[c * count + p].P, sizeof aim[p]);
    pair->rays[n] = world_ray(random, aim, count, n % RAY_KINDS);
  }
}

static void pair_close(struct pair *pair)
{
  for (int k = 0; k < 2; k++) tracer_destroy(pair->tracer[k]), intersector_destroy(pair->intersector[k]);
  copied_close(&pair->scene);
}

static void compare(struct pair *pair)
{
  int wrong = 0, hits = 0, certain[2] = {0, 0};
  for (int n = 0; n < RAYS; n += PACKET) {
    struct hit hits_of[2][PACKET];
    for (int k = 0; k < 2; k++) tracer_closest(pair->tracer[k], PACKET, &pair->rays[n], hits_of[k]);
    for (int l = 0; l < PACKET; l++) {
      const struct hit *a = &hits_of[0][l], *b = &hits_of[1][l];
      for (int k = 0; k < 2; k++) certain[k] += hits_of[k][l].certainty == CERTAINTY_CERTAIN;
      hits += a->patch != HIT_NONE;
      if (hits_agree(&pair->rays[n + l], a, b)) continue;
      if (wrong++ < 3) world_print_case("copies", pair->kind, &pair->rays[n + l], a, b);
    }
  }
  assert_int_equal(wrong, 0);
  assert_true(hits > RAYS / 8);
  /* Rays that are undecidable in the object are decided in the scene. */
  assert_true(certain[0] >= certain[1] - RAYS / 100);
}

/* All hits: equally many, at the same places, on the same patches. */
static void compare_all(struct pair *pair)
{
  int wrong = 0, certain = 0;
  for (int n = 0; n < RAYS; n++) {
    struct hit_list lists[2];
    for (int k = 0; k < 2; k++) assert_int_equal(tracer_all(pair->tracer[k], 1, &pair->rays[n], &lists[k]), STATUS_OK);
    if (lists[0].certainty != CERTAINTY_CERTAIN || lists[1].certainty != CERTAINTY_CERTAIN) continue;
    bool same = lists[0].count == lists[1].count;
    for (size_t h = 0; same && h < lists[0].count; h++) {
      const struct hit *a = &lists[0].hits[h], *b = &lists[1].hits[h];
      same = a->patch == b->patch && hits_agree(&pair->rays[n], a, b);
    }
    certain++;
    if (!same && wrong++ < 3)
      print_message("kind %d ray %d: %zu hits, by themselves %zu\n", pair->kind, n, lists[0].count, lists[1].count);
  }
  assert_int_equal(wrong, 0);
  assert_true(certain > RAYS / 4 || pair->kind == WORLD_DEGENERATE);
}

/* Alone, in packets, and as any hit. */
static void company(struct pair *pair)
{
  int wrong = 0;
  for (int n = 0; n < RAYS; n += PACKET) {
    struct hit together[PACKET], alone;
    bool occluded[PACKET];
    tracer_closest(pair->tracer[0], PACKET, &pair->rays[n], together);
    tracer_occluded(pair->tracer[0], PACKET, &pair->rays[n], occluded);
    for (int l = 0; l < PACKET; l++) {
      tracer_closest(pair->tracer[0], 1, &pair->rays[n + l], &alone);
      const bool differ = !same_hit(&alone, &together[l]) || occluded[l] != (alone.patch != HIT_NONE);
      if (differ && wrong++ < 3) world_print_case("company", pair->kind, &pair->rays[n + l], &alone, &together[l]);
    }
  }
  assert_int_equal(wrong, 0);
}

/* A ray that leaves a surface does not meet it where it left: its hits are those without sharing. */
static void leave(struct pair *pair)
{
  struct random random = {SEED};
  int wrong = 0;
  for (int n = 0; n < RAYS; n++) {
    struct hit hit, next[2];
    tracer_closest(pair->tracer[0], 1, &pair->rays[n], &hit);
    if (hit.patch == HIT_NONE || hit.certainty != CERTAINTY_CERTAIN) continue;
    struct ray ray = {{0}, {0}, 0, INFINITY};
    for (int k = 0; k < 3; k++) ray.direction[k] = random_between(&random, -1, 1);
    tracer_leave(pair->tracer[0], &pair->rays[n], &hit, ray.direction, ray.origin);
    for (int k = 0; k < 2; k++) tracer_closest(pair->tracer[k], 1, &ray, &next[k]);
    if (hits_agree(&ray, &next[0], &next[1])) continue;
    if (wrong++ < 3) world_print_case("leave", pair->kind, &ray, &next[0], &next[1]);
  }
  assert_int_equal(wrong, 0);
}

/* Every kind of scene, or every other one if the effort is small (PSCN_SEED chooses), for preparing these takes far
 * longer than asking. */
static void each_kind(struct plan plan, uint64_t seed)
{
  static struct pair pair;
  struct random random = {seed};
  const int step = effort_fraction() < EFFORT_DEFAULT ? 2 : 1;
  for (plan.kind = (int)((effort_seed(0) + seed) % (uint64_t)step); plan.kind < WORLD_KINDS; plan.kind += step) {
    pair_open(&pair, &random, &plan);
    compare(&pair);
    compare_all(&pair);
    company(&pair);
    leave(&pair);
    pair_close(&pair);
  }
}

TEST(copies_answer_as_patches_of_their_own) { each_kind((struct plan){.place = random_map}, SEED); }

/* Then only the ray, mapped to the object, is off; a shear enlarges that error. */
TEST(sheared_copies_answer_as_patches_of_their_own) { each_kind((struct plan){.place = exact_shear}, SEED + 5); }

/* From so far away that double-double does not resolve the copy, nothing is proven that is not so. */
TEST(rays_from_very_far_away_claim_nothing_of_copies)
{
  static struct pair pair;
  struct random random = {SEED + 3};
  int wrong = 0, certain = 0;
  const int scenes = (int)effort_count(FULL_FAR_SCENES, LEAST_FAR_SCENES);
  for (int n = 0; n < scenes; n++) {
    const double far = pow(2, random_between(&random, 30, n % 3 ? 95 : 40));
    struct ray ray = {.t_max = INFINITY};
    struct hit hits[2];
    for (int k = 0; k < 3; k++) ray.direction[k] = random_between(&random, -1, 1);
    for (int k = 0; k < 3; k++) ray.origin[k] = -far * ray.direction[k];
    pair_open(&pair, &random, &(struct plan){.kind = WORLD_GRID, .place = random_map, .far = &ray, .at = far});
    for (int k = 0; k < 2; k++) tracer_closest(pair.tracer[k], 1, &ray, &hits[k]);
    if (hits[0].certainty == CERTAINTY_CERTAIN && hits[1].certainty == CERTAINTY_CERTAIN) {
      certain++;
      if (hits[0].patch != hits[1].patch && wrong++ < 3) world_print_case("far", pair.kind, &ray, &hits[0], &hits[1]);
    }
    pair_close(&pair);
  }
  assert_int_equal(wrong, 0);
  assert_true(certain > 0);
}

/* Of surfaces that are some roundings apart, the nearest is known for certain or not at all. This holds even where
 * the errors in the object's coordinates leave open which of two leaves has the root. */
TEST(nearest_of_copies_beside_each_other)
{
  static struct pair pair;
  struct random random = {SEED + 4};
  int wrong = 0, certain = 0;
  const int scenes = (int)effort_count(FULL_BESIDE_SCENES, LEAST_BESIDE_SCENES);
  for (int n = 0; n < scenes; n++) {
    pair_open(&pair, &random, &(struct plan){.kind = WORLD_GRID, .place = random_map, .beside = BESIDE});
    for (int l = 0; l < RAYS; l++) {
      struct hit hits[2];
      for (int k = 0; k < 2; k++) tracer_closest(pair.tracer[k], 1, &pair.rays[l], &hits[k]);
      if (hits[0].certainty != CERTAINTY_CERTAIN || hits[1].certainty != CERTAINTY_CERTAIN) continue;
      certain++;
      if (hits[0].patch != hits[1].patch && wrong++ < 3)
        world_print_case("beside", pair.kind, &pair.rays[l], &hits[0], &hits[1]);
    }
    pair_close(&pair);
  }
  assert_int_equal(wrong, 0);
  assert_true(certain > scenes * RAYS / 2);
}

/* A patch that is small beside the whole object is as certain in copies as by itself. */
TEST(small_parts_of_copies_are_certain)
{
  static struct pair pair;
  struct random random = {SEED + 9};
  static const double parts[] = {0x1p-30, 0x1p-100};
  for (size_t n = 0; n < sizeof parts / sizeof parts[0]; n++) {
    pair_open(&pair, &random, &(struct plan){.kind = WORLD_GRID, .place = exact_scale, .parts = parts[n]});
    compare(&pair);
    pair_close(&pair);
  }
}

/* Copies that lie deep inside one another do not share leaves: each ray would be mapped to the coordinates of nearly
 * all of them. */
TEST(deep_copies_have_leaves_of_their_own)
{
  static struct pair pair;
  struct random random = {SEED + 10};
  pair_open(&pair, &random, &(struct plan){.kind = WORLD_GRID, .place = random_map});
  assert_true(pair.tracer[0]->model->copy_count > 2 * (pair.scene.patch_count / pair.object.patch_count) / 3);
  pair_close(&pair);
  pair_open(&pair, &random, &(struct plan){.kind = WORLD_GRID, .place = about_zero});
  assert_int_equal(pair.tracer[0]->model->copy_count, 0);
  compare(&pair);
  pair_close(&pair);
}

/* The object's leaves are no farther from a copy's surface than `loose` says, which is also how far rays that leave
 * the surface start from it. The control points show it: they are rounded, those of leaves are not. */
TEST(leaves_are_no_looser_than_told)
{
  static struct pair pair;
  struct random random = {SEED + 11};
  pair_open(&pair, &random, &(struct plan){.kind = WORLD_WILD, .place = random_map});
  const struct model *model = pair.tracer[0]->model;
  const size_t count = pair.object.patch_count;
  long double farthest = 0;
  for (size_t c = 0; c < model->copy_count; c++) {
    const size_t first = model->copies[c].first_patch;
    const struct scene_copy *copy = &pair.scene.copies[first / count];
    for (size_t n = 0; n < count * 48; n++) {
      const size_t p = n / 48, i = n / 12 % 4, j = n / 3 % 4, k = n % 3;
      long double off = copy->b[k] - (long double)pair.scene.patches[first + p].P[i][j][k];
      for (int r = 0; r < 3; r++) off += (long double)pair.object.P[p][i][j][r] * copy->A[r][k];
      assert_true(fabsl(off) <= (long double)model->cuts[first + p].loose);
      farthest = fmaxl(farthest, fabsl(off));
    }
  }
  assert_true(farthest > 0);
  pair_close(&pair);
}

/* ---- borders ---- */

/* Copies share leaves only if no control point is farther off than this part of the object (copies.c). */
#define MOST_OFF 0x1p-30

/* A point of a border, up to roundings. */
static void border_point(struct random *random, world_net net, double point[3])
{
  const double x = random_unit(random), y = 1 - x, b[4] = {y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x};
  const int across = (int)(random_bits(random) % 2), edge = random_bits(random) % 2 ? 3 : 0;
  for (int k = 0; k < 3; k++) {
    point[k] = 0;
    for (int n = 0; n < 4; n++) point[k] += b[n] * (across ? net[n][edge][k] : net[edge][n][k]);
  }
}

/* Only two errors matter at the borders of copies: how far their control points are from the object's, and how far rays
 * in its coordinates are from where they should be. Rays that pass a border at that distance, or at a far smaller one,
 * have the hits that they have without sharing. */
static void pass_borders(struct random *random, const struct plan *plan, double near)
{
  enum { BORDER_RAYS = 1024, ASKED = 8 };
  static struct pair pair;
  int wrong = 0, certain[2] = {0};
  pair_open(&pair, random, plan);
  const struct model *model = pair.tracer[0]->model;
  assert_int_equal(model->copy_count, PATCHES - 1); /* all but the last */
  assert_true(model->objects[0].error <= MOST_OFF);
  for (int n = 0; n < BORDER_RAYS; n++) {
    struct ray ray = {.t_max = 1}; /* before the next copy */
    struct hit hits[2];
    double point[3];
    const double by = near * pow(2, random_between(random, -16, 0));
    border_point(random, pair.scene.patches[n % ASKED].P, point);
    for (int k = 0; k < 3; k++) {
      ray.direction[k] = random_between(random, -1, 1);
      ray.origin[k] = point[k] - ray.direction[k] / 2 + random_between(random, -by, by);
    }
    for (int k = 0; k < 2; k++) {
      tracer_closest(pair.tracer[k], 1, &ray, &hits[k]);
      certain[k] += hits[k].certainty == CERTAINTY_CERTAIN;
    }
    if (!hits_agree(&ray, &hits[0], &hits[1]) && wrong++ < 3)
      world_print_case("border", WORLD_GRID, &ray, &hits[0], &hits[1]);
  }
  pair_close(&pair);
  assert_int_equal(wrong, 0);
  for (int k = 0; k < 2; k++) assert_true(certain[k] > BORDER_RAYS - BORDER_RAYS / 100);
}

/* The control points are off by as much as copies may be that share. */
TEST(copies_are_met_where_they_are)
{
  struct random random = {SEED + 12};
  const struct plan plan = {
    .place = in_a_row, .single = true, .sizes = {1, 1, 1}, .off = MOST_OFF / 8, .last_off = 0x1p-20};
  pass_borders(&random, &plan, MOST_OFF / 4);
}

/* Here only the start of a ray is off. In the object's coordinates it is as far from the object as the copy is long,
 * times how much wider the object is. */
TEST(slender_copies_are_met_up_to_their_borders)
{
  struct random random = {SEED + 13};
  static const double sizes[][3] = {{1, 0x1p-17, 0x1p-17}, {0x1p-17, 0x1p-17, 1}};
  for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++) {
    struct plan plan = {.place = in_a_row, .single = true, .last_off = 0x1p-20};
    memcpy(plan.sizes, sizes[n], sizeof plan.sizes);
    pass_borders(&random, &plan, 0);
  }
}
