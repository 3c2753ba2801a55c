/* Patches that lie exactly on earlier ones: a certain nearest hit is the one without them, to the last bit, and all hits
 * are those without them, repeated for each twin. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "copied.h"
#include "geometry/edges.h"
#include "intersect/intersect.h"
#include "method_of.h"
#include "net_order.h"
#include "property/world.h"

enum { SEED = 20261122, RAYS = 384, TIMES = 4, MOST = TIMES * WORLD_MAX, FAR = 70000, COPIES = 300 };

static bool equal(world_net P, world_net Q)
{
  bool same = true;
  for (int n = 0; n < 48; n++) same &= P[n / 12][n / 3 % 4][n % 3] == Q[n / 12][n / 3 % 4][n % 3];
  return same;
}

static bool same_surface(world_net P, world_net Q)
{
  world_net other;
  bool same = false;
  for (int order = 0; order < 8; order++) in_order(P, order, other), same |= equal(other, Q);
  return same;
}

/* A scene of patches that lie on each other, and one without those that lie on earlier ones. */
struct pair {
  struct world world[2];
  uint32_t first[MOST];   /* for each patch of the second scene, its index in the first one; */
  size_t times[MOST];     /* how many patches of the first scene are that surface; */
  uint32_t surface[MOST]; /* for each patch of the first scene, its surface in the second */
};

static void twins_fill(struct pair *pair, struct random *random, world_net nets[], size_t count, size_t solver_count)
{
  size_t order[MOST], most = 0;
  for (size_t p = 0; p < count; p++)
    for (size_t n = 1 + random_bits(random) % TIMES; n > 0; n--) order[most++] = p;
  random_shuffle(random, most, order);
  for (size_t k = 0; k < most; k++) {
    struct scene_patch *patch = &pair->world[0].scene.patches[k];
    in_order(nets[order[k]], (int)(random_bits(random) % 8), patch->P);
    for (int n = 0; n < 48; n++)
      if (patch->P[n / 12][n / 3 % 4][n % 3] == 0 && random_bits(random) % 2) patch->P[n / 12][n / 3 % 4][n % 3] = -0.0;
    patch->solver = (uint32_t)(random_bits(random) % solver_count);
  }
  pair->world[0].scene.patch_count = most;
}

/* Leaves out of the second scene the patches that lie on earlier ones. */
static void twins_leave(struct pair *pair)
{
  struct scene *all = &pair->world[0].scene, *few = &pair->world[1].scene;
  uint32_t surface[MOST];
  assert_int_equal(surfaces_find(all->patches, sizeof *all->patches, all->patch_count, surface), STATUS_OK);
  for (size_t k = 0; k < all->patch_count; k++) {
    size_t n = 0;
    while (n < few->patch_count && !same_surface(few->patches[n].P, all->patches[k].P)) n++;
    assert_int_equal((surface[k] & SURFACE_AGAIN) != 0, n < few->patch_count);
    pair->surface[k] = (uint32_t)n, pair->times[n] = n < few->patch_count ? pair->times[n] + 1 : 1;
    if (n < few->patch_count) continue;
    pair->first[n] = (uint32_t)k, few->patches[few->patch_count++] = all->patches[k];
  }
}

/* far: the number of small patches far away that are added. */
static void pair_open(struct pair *pair, struct random *random, world_net nets[], size_t count, size_t far,
                      struct method solvers[], size_t solver_count)
{
  memset(pair, 0, sizeof *pair);
  for (int k = 0; k < 2; k++) {
    pair->world[k].scene = (struct scene){.solvers = solvers, .solver_count = solver_count};
    pair->world[k].scene.patches = calloc(MOST + far, sizeof *pair->world[k].scene.patches);
    assert_non_null(pair->world[k].scene.patches);
  }
  twins_fill(pair, random, nets, count, solver_count);
  twins_leave(pair);
  for (size_t p = 0; p < far; p++) {
    struct scene_patch patch = {0};
    for (int n = 0; n < 48; n++) patch.P[n / 12][n / 3 % 4][n % 3] = 1000 + random_between(random, 0, 0.01);
    for (int k = 0; k < 2; k++) pair->world[k].scene.patches[pair->world[k].scene.patch_count++] = patch;
  }
  for (int k = 0; k < 2; k++) world_prepare(&pair->world[k]);
}

static void pair_close(struct pair *pair) { world_close(&pair->world[0]), world_close(&pair->world[1]); }

/* Every hit of the scene without twins occurs as often as its surface does. */
static void assert_all_there(const struct pair *pair, const struct hit_list *all, const struct hit_list *few)
{
  size_t left[MOST] = {0}, sum = 0;
  for (size_t k = 0; k < few->count; k++) sum += pair->times[few->hits[k].patch];
  assert_int_equal(all->count, sum);
  for (size_t k = 0; k < few->count; k++) left[few->hits[k].patch] += pair->times[few->hits[k].patch];
  for (size_t k = 0; k < all->count; k++) left[pair->surface[all->hits[k].patch]]--;
  for (size_t n = 0; n < MOST; n++) assert_int_equal(left[n], 0);
  for (size_t k = 1; k < all->count; k++) { /* twins in the order of their patches */
    const struct hit *before = &all->hits[k - 1], *here = &all->hits[k];
    assert_true(before->t <= here->t);
    if (before->t == here->t && pair->surface[before->patch] == pair->surface[here->patch])
      assert_true(before->patch <= here->patch);
  }
}

static void compare(const struct pair *pair, int kind, struct random *random, world_net nets[], size_t count)
{
  size_t hits = 0, certain = 0;
  struct asked asked;
  for (int n = 0; n < RAYS; n += ASKED_RAYS) {
    world_ask_both((struct tracer *[]){pair->world[0].tracer, pair->world[1].tracer}, random, nets, count, n, &asked);
    for (int l = 0; l < ASKED_RAYS; l++) {
      const struct hit_list *all = &asked.list[0][l], *few = &asked.list[1][l];
      struct hit *hit = &asked.hit[1][l];
      if (hit->patch != HIT_NONE) hits++, hit->patch = pair->first[hit->patch];
      /* what share of the work is left for what is in doubt also depends on the boxes of twins */
      if (hit->certainty != CERTAINTY_CERTAIN && asked.hit[0][l].certainty != CERTAINTY_CERTAIN) continue;
      /* where several patches of one plane are met, either the lanes or the last resort give the last places */
      const bool same = kind == WORLD_FLAT ? hits_agree(&asked.rays[l], &asked.hit[0][l], hit)
                                           : same_hit(&asked.hit[0][l], hit);
      if (!same) world_print_case("twins or not", kind, &asked.rays[l], &asked.hit[0][l], hit), fail();
      assert_int_equal(asked.occluded[0][l], asked.occluded[1][l]);
      if (all->certainty == CERTAINTY_CERTAIN && few->certainty == CERTAINTY_CERTAIN)
        assert_all_there(pair, all, few), certain++;
    }
  }
  assert_true(hits > RAYS / 16 && certain > RAYS / 4);
}

/* On every `step`-th kind of scene. */
static void on_kinds(int step, size_t far, struct method solvers[], size_t solver_count)
{
  static struct pair pair;
  static world_net nets[WORLD_MAX];
  struct random random = {SEED};
  for (int kind = 0; kind < WORLD_KINDS; kind += step) {
    const size_t count = world_fill((enum world_kind)kind, &random, nets);
    pair_open(&pair, &random, nets, count, far, solvers, solver_count);
    compare(&pair, kind, &random, nets, count);
    pair_close(&pair);
  }
}

TEST(of_one_solver)
{
  struct method solver = method_of("bernstein");
  on_kinds(1, 0, &solver, 1);
}

TEST(of_several)
{
  struct method solvers[] = {method_of("bernstein"), method_of("newton { split 3 }"), method_of("aberth"),
                             method_of("bernstein { split 1 }")};
  on_kinds(1, 0, solvers, 4);
}

TEST(that_are_not_kept)
{
  struct method solver = method_of("bernstein { split 1 }"); /* in both scenes */
  on_kinds(3, FAR, &solver, 1);                              /* preparing them takes long */
}

/* Copies of an object, one of whose patches lies on another if `twice`; half of the copies then lie on other copies. */
static void copies_fill(struct scene *scene, struct scene_object *object, bool twice)
{
  struct random random = {SEED};
  copied_open(scene, object, twice ? COPIES * 3 / 2 : COPIES);
  for (size_t c = 0, place = 0; c < scene->copy_count; place++) {
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = (double)(random_bits(&random) % 20) * 0.5;
    for (size_t n = 0; n <= (size_t)(twice && place % 2); n++) memcpy(scene->copies[c++].b, at, sizeof at);
  }
  copied_place(scene);
}

TEST(that_are_copies)
{
  static world_net nets[WORLD_MAX];
  struct random random = {SEED};
  struct scene_object objects[2];
  struct pair pair;
  struct method solver = method_of("bernstein");
  const size_t count = world_fill(WORLD_DOME, &random, nets);
  in_order(nets[1], 5, nets[count]);
  for (int k = 0; k < 2; k++) {
    objects[k] = (struct scene_object){nets, k == 0 ? count + 1 : count};
    pair.world[k].scene = (struct scene){.solvers = &solver, .solver_count = 1};
    copies_fill(&pair.world[k].scene, &objects[k], k == 0);
  }
  for (int k = 0; k < 2; k++) world_prepare(&pair.world[k]);
  for (int k = 0; k < 2; k++) assert_true(pair.world[k].tracer->model->copy_count > COPIES / 2);
  size_t hits = 0;
  for (int n = 0; n < RAYS; n++) {
    struct ray ray = world_ray(&random, nets, count, n % RAY_KINDS);
    struct hit hit[2];
    const struct scene_copy *copy = &pair.world[0].scene.copies[random_bits(&random) % pair.world[0].scene.copy_count];
    for (int k = 0; k < 3; k++) ray.origin[k] += copy->b[k];
    for (int k = 0; k < 2; k++) tracer_closest(pair.world[k].tracer, 1, &ray, &hit[k]);
    if (hit[0].patch != HIT_NONE) hits++, hit[0].patch %= (uint32_t)count + 1;
    if (hit[1].patch != HIT_NONE) hit[1].patch %= (uint32_t)count;
    assert_same_hit("copies", WORLD_DOME, &ray, &hit[0], &hit[1]);
  }
  assert_true(hits > RAYS / 2);
  pair_close(&pair);
}

enum { SHEETS = 7, STACKS = 200, STACK_RAYS = 8 };

/* Sheets in any order, so close that wide arithmetic tells apart only those that are not next to each other. Every
 * answer must be consistent, although each of three sheets may be at one t with the next while the first is before
 * the last. */
TEST(sheets_that_wide_arithmetic_just_tells)
{
  struct random random = {SEED + 5};
  int sure = 0, wrong = 0;
  for (int stack = 0; stack < STACKS; stack++) {
    world_net base, nets[SHEETS];
    int at[SHEETS];
    struct world world;
    /* for a ray from 2^55 away, 113 bits leave about 2^-55 unknown */
    const double apart = ldexp(1, -57 + stack % 4);
    for (int n = 0; n < 16; n++) {
      base[n / 4][n % 4][0] = n / 4, base[n / 4][n % 4][1] = n % 4;
      base[n / 4][n % 4][2] = stack % 2 ? ldexp(rint(random_between(&random, -8, 8)), -16) : 0;
    }
    for (int p = 0; p < SHEETS; p++) {
      at[p] = (int)(random_bits(&random) % 16);
      memcpy(nets[p], base, sizeof base);
      for (int n = 0; n < 16; n++) nets[p][n / 4][n % 4][2] += at[p] * apart;
    }
    world_open(&world, nets, SHEETS, NULL);
    for (int n = 0; n < STACK_RAYS; n++) {
      const struct ray ray = {
        {random_between(&random, 0, 3), random_between(&random, 0, 3), -0x1p55}, {0, 0, 1}, 0, INFINITY};
      const struct hit nearest = world_closest(&world, &ray);
      const struct hit_list list = world_all(&world, &ray);
      if (nearest.certainty != CERTAINTY_CERTAIN || list.certainty != CERTAINTY_CERTAIN) continue;
      sure++;
      bool good = list.count == SHEETS && abs(at[list.hits[0].patch] - at[nearest.patch]) * apart <= 0x1p-53;
      int most = 0;
      for (size_t k = 0; k < list.count; k++) { /* the farthest so far cannot be told from any behind it */
        const int here = at[list.hits[k].patch];
        most = here > most ? here : most;
        good = good && (most - here) * apart <= 0x1p-53;
      }
      if (!good && wrong++ < 3) world_print_case("sheets", stack, &ray, &nearest, &list.hits[0]);
    }
    world_close(&world);
  }
  assert_int_equal(wrong, 0);
  assert_true(sure > STACKS * STACK_RAYS / 2);
}

/* Two planes that meet on the ray are met at one t, at whatever slant. */
TEST(planes_that_meet_on_the_ray_are_met_at_one_t)
{
  for (int slant = 0; slant <= 64; slant += 5) {
    world_net nets[2];
    struct world world;
    for (int n = 0; n < 16; n++) {
      for (int p = 0; p < 2; p++) {
        double *x = nets[p][n / 4][n % 4];
        x[0] = n / 4 - 1.5, x[1] = n % 4 - 1.5, x[2] = (p + 1) * x[1];
      }
    }
    world_open(&world, nets, 2, NULL);
    const struct ray ray = {{-2, 0, -2 * ldexp(1, -slant)}, {1, 0, ldexp(1, -slant)}, 0, INFINITY};
    const struct hit hit = world_closest(&world, &ray);
    const struct hit_list list = world_all(&world, &ray);
    assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
    assert_int_equal(list.certainty, CERTAINTY_CERTAIN);
    world_close(&world);
  }
}
