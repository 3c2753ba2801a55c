/* All hits of a ray are the nearest hits asked for one after the other. They do not depend on the ray's ends or the
 * instruction set. (The rays beside it: packets_test.c.) There may be thousands. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "method_of.h"
#include "net_order.h"
#include "property/world.h"

enum { SEED = 20240514, SCENES = 3, MOST_HITS = 200 };

/* A copy of a list, for a list is gone when the next one is asked for. */
struct kept {
  enum certainty certainty;
  size_t count;
  struct hit hits[MOST_HITS];
};

static void all_of(struct world *world, const struct ray *ray, struct kept *out)
{
  const struct hit_list list = world_all(world, ray);
  assert_true(list.count <= MOST_HITS);
  out->certainty = list.certainty, out->count = list.count;
  if (list.count > 0) memcpy(out->hits, list.hits, list.count * sizeof *list.hits);
}

/* All hits of each ray alone; valid until the next call. */
static const struct kept *lists_alone(const struct set_up *s)
{
  static struct kept alone[STAGE_RAYS];
  for (int n = 0; n < STAGE_RAYS; n++) all_of(s->world, &s->rays[n], &alone[n]);
  return alone;
}

static void print_lists(const char *what, int kind, const struct ray *ray, const struct kept *a)
{
  struct hit none = {.patch = HIT_NONE};
  world_print_case(what, kind, ray, a->count > 0 ? &a->hits[0] : &none, a->count > 1 ? &a->hits[1] : &none);
  for (size_t k = 0; k < a->count; k++) print_message("  %.17g on %u\n", a->hits[k].t, a->hits[k].patch);
}

/* A hit on the line where leaves of a patch meet may be reported by either leaf. */
static bool same_but_for_rounding(const struct hit *a, const struct hit *b)
{
  return a->patch == b->patch && fabs(a->t - b->t) <= 0x1p-51 * b->t && fabs(a->u - b->u) <= 0x1p-36 &&
         fabs(a->v - b->v) <= 0x1p-36;
}

/* The first one is the nearest hit, to the last bit except where patches of one plane are hit on lines where leaves
 * meet, and in rare cases. The others are the nearest ones behind it. */
static void one_by_one(struct set_up *s)
{
  const struct kept *alone = lists_alone(s);
  int wrong = 0, followed = 0, certain = 0, equal = 0;
  for (size_t n = 0; n < STAGE_RAYS; n++) {
    const struct kept *all = &alone[n];
    struct ray ray = s->rays[n];
    struct hit next = world_closest(s->world, &ray);
    if (all->certainty == CERTAINTY_CERTAIN) {
      const bool first = all->count == 0 ? next.patch == HIT_NONE : same_but_for_rounding(&next, &all->hits[0]);
      certain++, equal += all->count > 0 ? same_hit(&next, &all->hits[0]) : first;
      if ((!first || next.certainty != CERTAINTY_CERTAIN) && wrong++ < 2) print_lists("first", s->kind, &ray, all);
    }
    bool tame = all->certainty == CERTAINTY_CERTAIN;
    for (size_t k = 1; k < all->count; k++) tame &= all->hits[k].t > all->hits[k - 1].t * (1 + 1e-9);
    for (size_t k = 0; k < all->count && tame; k++) {
      if (!(fabs(next.t - all->hits[k].t) <= 1e-12 * next.t) && wrong++ < 2) print_lists("next", s->kind, &ray, all);
      ray.t_min = all->hits[k].t * (1 + 1e-10);
      next = world_closest(s->world, &ray);
      followed++;
    }
    if (tame && next.patch != HIT_NONE && wrong++ < 2) print_lists("last", s->kind, &ray, all);
  }
  assert_int_equal(wrong, 0);
  assert_true(equal >= certain - 1 || s->kind == WORLD_DEGENERATE || s->kind == WORLD_FLAT);
  assert_true(followed > 0 || s->kind == WORLD_DEGENERATE || s->kind == WORLD_FLAT);
}

TEST(they_are_the_nearest_one_by_one) { on_all_stages(SEED, SCENES, NULL, one_by_one); }

/* The hits of a part of the ray are the hits of the whole ray within that part. */
static void parts(struct set_up *s)
{
  const struct kept *alone = lists_alone(s);
  int wrong = 0;
  for (size_t n = 0; n < STAGE_RAYS; n++) {
    const struct kept *all = &alone[n];
    for (size_t from = 0; from < all->count && all->certainty == CERTAINTY_CERTAIN; from++) {
      struct ray part = s->rays[n];
      struct kept some;
      part.t_min = all->hits[from].t * (1 - 1e-9), part.t_max = all->hits[all->count - 1].t * (1 - 1e-9);
      size_t inside = 0, clear = 1;
      for (size_t k = 0; k < all->count; k++) {
        const double t = all->hits[k].t;
        inside += t > part.t_min && t < part.t_max;
        clear &= fabs(t - part.t_min) > 1e-10 * t && fabs(t - part.t_max) > 1e-10 * t;
      }
      all_of(s->world, &part, &some);
      if (clear && (some.count != inside || some.certainty != CERTAINTY_CERTAIN) && wrong++ < 2)
        print_lists("part", s->kind, &part, &some);
    }
  }
  assert_int_equal(wrong, 0);
}

TEST(parts_of_a_ray_have_theirs) { on_all_stages(SEED + 1, SCENES, NULL, parts); }

/* Where the answer is certain, every instruction set counts the same hits and finds them on the same patches. */
static void kernels(struct set_up *s)
{
  const struct kept *alone = lists_alone(s);
  const struct kernel *before = s->world->tracer->kernel, *here[KERNELS_MAX];
  const size_t count = kernels_here(here);
  static struct kept list;
  int wrong = 0;
  for (size_t k = 0; k < count; k++) {
    s->world->tracer->kernel = here[k];
    for (size_t n = 0; n < STAGE_RAYS; n++) {
      const struct kept *other = &alone[n];
      all_of(s->world, &s->rays[n], &list);
      if (list.certainty != CERTAINTY_CERTAIN || other->certainty != CERTAINTY_CERTAIN) continue;
      bool same = list.count == other->count;
      for (size_t h = 0; same && h < list.count; h++) same = list.hits[h].patch == other->hits[h].patch;
      if (!same && wrong++ < 2) print_lists(here[k]->name, s->kind, &s->rays[n], &list);
    }
  }
  s->world->tracer->kernel = before;
  assert_int_equal(wrong, 0);
}

TEST(kernels_agree) { on_all_stages(SEED + 3, SCENES, NULL, kernels); }

/* A stack of sheets, the lowest one first: a ray through them has one hit on each, in order. A ray exactly through
 * their corners, four to a layer, has one hit a layer, on the first of the four. */
TEST(test_stack)
{
  enum { LAYERS = 3000, CORNERS = 100 };
  world_net *nets = calloc(LAYERS, sizeof *nets);
  assert_non_null(nets);
  for (size_t p = 0; p < LAYERS; p++)
    for (int n = 0; n < 16; n++) {
      nets[p][n / 4][n % 4][0] = n / 4, nets[p][n / 4][n % 4][1] = n % 4;
      nets[p][n / 4][n % 4][2] = -(double)p - ((n == 5 || n == 10) && p % 2 ? 0.5 : 0);
    }
  struct world world;
  world_open(&world, nets, LAYERS, NULL);
  const struct ray rays[3] = {{{1.3, 1.7, 1}, {0, 0, -1}, 0, INFINITY},
                              {{1.3, 1.7, -2.0 * LAYERS}, {0, 0, 1}, 0, INFINITY},
                              {{1.3, 3.5, 1}, {0, 0, -1}, 0, INFINITY}};
  struct hit_list lists[3];
  assert_int_equal(tracer_all(world.tracer, 3, rays, lists), STATUS_OK);
  for (int r = 0; r < 2; r++) {
    assert_int_equal(lists[r].certainty, CERTAINTY_CERTAIN);
    assert_int_equal(lists[r].count, LAYERS);
    for (size_t k = 0; k < LAYERS; k++) assert_int_equal(lists[r].hits[k].patch, r ? LAYERS - 1 - k : k);
  }
  assert_int_equal(lists[2].count, 0);
  world_close(&world);

  for (size_t p = 0; p < 4 * CORNERS; p++)
    for (int n = 0; n < 16; n++) {
      nets[p][n / 4][n % 4][0] = n / 4 - (p & 1 ? 3 : 0), nets[p][n / 4][n % 4][1] = n % 4 - (p & 2 ? 3 : 0);
      nets[p][n / 4][n % 4][2] = -(double)(p / 4);
    }
  world_open(&world, nets, 4 * CORNERS, NULL);
  const struct ray down = {{0, 0, 1}, {0, 0, -1}, 0, INFINITY};
  assert_int_equal(tracer_all(world.tracer, 1, &down, lists), STATUS_OK);
  assert_int_equal(lists[0].certainty, CERTAINTY_CERTAIN);
  assert_int_equal(lists[0].count, CORNERS);
  for (size_t k = 0; k < CORNERS; k++) assert_int_equal(lists[0].hits[k].patch, 4 * k);
  world_close(&world);
  free(nets);
}

/* Two patches that bend at a border, and one that crosses both there. Of hits that nothing tells apart, the first in
 * the scene is the nearest and the first of all hits, whichever patch it is on. */
TEST(test_standing_on)
{
  enum { WALLS = 2, FLOOR = 2, ORDERS = 6, PACKETS = 8 };
  static const size_t order[ORDERS][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  world_net nets[3];
  struct random random = {SEED + 8};
  for (int o = 0; o < ORDERS; o++) {
    for (int n = 0; n < 16; n++) {
      const double away = n / 4, along = 2 * (n % 4) - 3;
      for (int wall = 0; wall < WALLS; wall++) {
        double *p = nets[order[o][wall]][n / 4][n % 4];
        p[0] = wall ? away : -away, p[1] = along, p[2] = wall ? -2 * away : away;
      }
      double *p = nets[order[o][FLOOR]][n / 4][n % 4];
      p[0] = 3 * away - 4, p[1] = 3 * along, p[2] = 0;
    }
    struct world world;
    world_open(&world, nets, 3, NULL);
    for (int packet = 0; packet < PACKETS; packet++) {
      struct ray rays[PACKET_SIZE];
      struct hit hits[PACKET_SIZE];
      struct hit_list lists[PACKET_SIZE];
      for (int n = 0; n < PACKET_SIZE; n++) {
        const double sideways = (double)(random_bits(&random) % 9) / 4 - 1,
                     slope = (double)(random_bits(&random) % 4) / 8;
        rays[n] = (struct ray){{-4 * slope, random_between(&random, -2, 2), 4}, {slope, sideways, -1}, 0, INFINITY};
        rays[n].origin[1] = rint(rays[n].origin[1] * 0x1p40) * 0x1p-40 - 4 * sideways;
      }
      tracer_closest(world.tracer, PACKET_SIZE, rays, hits);
      assert_int_equal(tracer_all(world.tracer, PACKET_SIZE, rays, lists), STATUS_OK);
      for (int n = 0; n < PACKET_SIZE; n++) {
        assert_int_equal(hits[n].certainty, CERTAINTY_CERTAIN);
        assert_int_equal(lists[n].certainty, CERTAINTY_CERTAIN);
        assert_int_equal(lists[n].count, 2);
        assert_int_equal(hits[n].patch, 0);
        assert_int_equal(lists[n].hits[0].patch, 0);
        assert_true(hits[n].t == 4 && lists[n].hits[0].t == 4 && lists[n].hits[1].t == 4);
      }
    }
    world_close(&world);
  }
}

/* Two patches with one border, whichever of theirs and in whatever sense, and a ray along z through a point of it: it
 * crosses the surface there, once, if they lie on either side of the border as it sees them. Otherwise it touches it,
 * which is not certain. */
TEST(test_two_sides)
{
  enum { ORDERS = 8, PAIRS = 4 };
  static const double weight[2][4] = {{27, 27, 9, 1}, {1, 3, 3, 1}}, slope[2][4] = {{-9, 3, 5, 1}, {-1, -1, 1, 1}};
  struct random random = {SEED + 9};
  int crossing = 0, certain = 0;
  for (int n = 0; n < ORDERS * ORDERS * PAIRS; n++) {
    double curve[4][3], inward[2][3], at[3] = {0}, along[2] = {0}, side[2];
    const int half = n % 2;
    world_net net, nets[2];
    for (int c = 0; c < 3; c++) {
      for (int k = 0; k < 4; k++) {
        curve[k][c] = (double)(random_bits(&random) % 17) - 8;
        at[c] += curve[k][c] * weight[half][k] / (half ? 8 : 64);
        if (c < 2) along[c] += curve[k][c] * slope[half][k];
      }
    }
    for (int p = 0; p < 2; p++) {
      for (int c = 0; c < 3; c++) inward[p][c] = (double)(random_bits(&random) % 17) - 8;
      side[p] = along[0] * inward[p][1] - along[1] * inward[p][0];
      for (int k = 0; k < 16; k++)
        for (int c = 0; c < 3; c++) net[k / 4][k % 4][c] = curve[k % 4][c] + (k / 4) * inward[p][c];
      in_order(net, n / PAIRS / (p ? ORDERS : 1) % ORDERS, nets[p]);
    }
    if (side[0] == 0 || side[1] == 0) continue;
    struct world world;
    world_open(&world, nets, 2, NULL);
    const struct ray ray = {{at[0], at[1], 64}, {0, 0, -1}, 0, INFINITY};
    const struct hit_list list = world_all(&world, &ray);
    const bool crosses = (side[0] > 0) != (side[1] > 0);
    int here = 0;
    for (size_t k = 0; k < list.count; k++) {
      if (list.hits[k].t != 64 - at[2]) continue;
      here++;
      if (!crosses) assert_int_equal(list.hits[k].certainty, CERTAINTY_GRAZING);
    }
    if (list.certainty == CERTAINTY_CERTAIN) assert_true(crosses && here == 1);
    crossing += crosses, certain += list.certainty == CERTAINTY_CERTAIN;
    world_close(&world);
  }
  assert_true(crossing > ORDERS * ORDERS * PAIRS / 4 && 10 * certain > 9 * crossing);
}

/* A sheet bent into a loop, x = s^3 - s/16 and z = s^2 with s = v - 1/2, meets itself at v = 1/4 and 3/4: a ray in x = 0
 * has both roots there at one t, that of smaller parameters first, and one at v = 1/2 behind them. */
TEST(test_loop)
{
  static const double x[4] = {-9, 13, -13, 9}, z[4] = {3, -1, -1, 3};
  struct random random = {SEED + 11};
  for (int order = 0; order < 8; order++) {
    world_net net, nets[1];
    struct world world;
    for (int n = 0; n < 16; n++)
      net[n / 4][n % 4][0] = x[n % 4], net[n / 4][n % 4][1] = n / 4, net[n / 4][n % 4][2] = z[n % 4];
    in_order(net, order, nets[0]);
    world_open(&world, nets, 1, NULL);
    for (int n = 0; n < 16; n++) {
      const struct ray ray = {{0, random_between(&random, 0.1, 2.9), 8}, {0, 0, -1}, 0, INFINITY};
      const struct hit nearest = world_closest(&world, &ray);
      const struct hit_list list = world_all(&world, &ray);
      assert_int_equal(nearest.certainty, CERTAINTY_CERTAIN);
      assert_int_equal(list.certainty, CERTAINTY_CERTAIN);
      assert_int_equal(list.count, 3);
      assert_true(nearest.t == 7.25 && list.hits[0].t == 7.25 && list.hits[1].t == 7.25 && list.hits[2].t == 8);
      const double first = order & 1 ? list.hits[0].u : list.hits[0].v,
                   second = order & 1 ? list.hits[1].u : list.hits[1].v;
      assert_true(first == 0.25 && second == 0.75 && (order & 1 ? nearest.u : nearest.v) == 0.25);
    }
    world_close(&world);
  }
}

/* A border that is a line along the ray may be a hit where the ray meets its nearer end, whichever that is. */
TEST(test_line_along_the_ray)
{
  for (int order = 0; order < 8; order++) {
    world_net net, nets[1];
    struct world world;
    for (int n = 0; n < 16; n++) {
      const double u = n / 4, v = n % 4;
      net[n / 4][n % 4][0] = 3 * u, net[n / 4][n % 4][1] = u * (2 * v - 3), net[n / 4][n % 4][2] = u + v;
    }
    in_order(net, order, nets[0]);
    world_open(&world, nets, 1, NULL);
    const struct ray ray = {{0, 0, 8}, {0, 0, -1}, 0, INFINITY};
    const struct hit nearest = world_closest(&world, &ray);
    assert_int_equal(nearest.certainty, CERTAINTY_GRAZING);
    assert_int_equal(world_all(&world, &ray).certainty, CERTAINTY_GRAZING);
    assert_true(nearest.patch == 0 && nearest.t == 5);
    world_close(&world);
  }
}

/* A bent patch whose border is in a plane along the ray, which passes beside the plane, however near: it meets the patch
 * once on the one side and not at all on the other. */
TEST(test_beside_a_border)
{
  enum { PATCHES = 32, RAYS = 90 };
  struct random random = {SEED + 10};
  for (int p = 0; p < PATCHES; p++) {
    world_net net, nets[1];
    struct world world;
    for (int n = 0; n < 16; n++) {
      const int base[3] = {8 * (n / 4), 8 * (n % 4) - 12, 0};
      for (int c = 0; c < 3; c++) net[n / 4][n % 4][c] = base[c] + (double)(random_bits(&random) % 5) - 2;
      if (n < 4) net[0][n][0] = 0;
    }
    in_order(net, p % 8, nets[0]);
    world_open(&world, nets, 1, NULL);
    for (int n = 0; n < 2 * RAYS; n++) {
      const double y = random_between(&random, -8, 8), x = ldexp(n % 2 ? 1 : -1, -n / 2);
      const struct ray ray = {{x, y, 64}, {0, 0, -1}, 0, INFINITY};
      const struct hit nearest = world_closest(&world, &ray);
      const struct hit_list list = world_all(&world, &ray);
      assert_int_equal(nearest.certainty, CERTAINTY_CERTAIN);
      assert_int_equal(list.certainty, CERTAINTY_CERTAIN);
      assert_int_equal(list.count, n % 2);
      assert_true((nearest.patch != HIT_NONE) == n % 2);
    }
    world_close(&world);
  }
}

/* All hits and the nearest hit agree on a possible hit whose t, as a double, equals an end of the ray: at a tip, and
 * on an open border. */
TEST(test_next_to_an_end)
{
  world_net net[1];
  for (int n = 0; n < 16; n++) { /* from the tip (0,0,0) to an open border in x = 3 */
    net[0][n / 4][n % 4][0] = n / 4, net[0][n / 4][n % 4][1] = (n / 4) * (n % 4);
    net[0][n / 4][n % 4][2] = n / 4 == 3 ? 0 : (n / 4) * (n % 4 - 1.5);
  }
  struct world world;
  world_open(&world, net, 1, NULL);
  static const struct ray third = {{0, 0, 1}, {0, 0, -3}, 1.0 / 3, INFINITY}, /* 1/3 as a double is below it */
    fifth = {{0, 0, 1}, {0, 0, -5}, 0, 1.0 / 5};                              /* 1/5 as a double is above it */
  for (int border = 0; border < 2; border++) {
    for (int n = 0; n < 2; n++) {
      struct ray ray = n ? fifth : third;
      if (border) ray.origin[0] = 3, ray.origin[1] = 4;
      const struct hit nearest = world_closest(&world, &ray);
      const struct hit_list list = world_all(&world, &ray);
      assert_int_equal(nearest.patch, 0);
      assert_int_equal(nearest.certainty, CERTAINTY_CERTAIN);
      assert_int_equal(list.certainty, CERTAINTY_GRAZING);
      assert_int_equal(list.count, 1);
      assert_true(list.hits[0].t > ray.t_min && list.hits[0].t < ray.t_max);
    }
  }
  world_close(&world);
}

/* Six patches that go twice round a point. A ray through it meets two sheets there, which are not one hit. A ray
 * beside it has two hits. */
TEST(test_twice_round)
{
  static const double way[3][2] = {{18, 0}, {-9, 18}, {-9, -18}};
  world_net nets[6];
  for (int p = 0; p < 6; p++)
    for (int n = 0; n < 16; n++) { /* (i a_p + j a_(p+1))/3, a_p being the p-th of six directions, each at its own
                                    * height */
      const int i = n / 4, j = n % 4, q = (p + 1) % 6;
      for (int k = 0; k < 2; k++) nets[p][i][j][k] = (i * way[p % 3][k] + j * way[q % 3][k]) / 3;
      nets[p][i][j][2] = i * p + j * q;
    }
  struct world world;
  world_open(&world, nets, 6, NULL);
  const struct ray through = {{0, 0, -4}, {0, 0, 1}, 0, INFINITY}, beside = {{0.5, 0.25, -4}, {0, 0, 1}, 0, INFINITY};
  assert_int_equal(world_all(&world, &through).certainty, CERTAINTY_GRAZING);
  const struct hit_list list = world_all(&world, &beside);
  assert_true(list.certainty == CERTAINTY_CERTAIN && list.count == 2);
  world_close(&world);
}

/* Rays along patches that lie on one line cost more than their share of work. Their answers are then the same in a
 * packet as alone. */
TEST(test_worn)
{
  enum { PATCHES = 5, PACKETS = 12 };
  static world_net nets[PATCHES];
  struct random random = {SEED + 7};
  struct tracer *alone;
  struct world world;
  const struct method options = method_of("bernstein { split 16 }");
  int grazing = 0, wrong = 0;
  for (int p = 0; p < PATCHES; p++)
    for (int n = 0; n < 16; n++) nets[p][n / 4][n % 4][1] = (n / 4 - 1.5) * 0.1 * p + (n % 4 - 1) * 0.1;
  world_open(&world, nets, PATCHES, &options);
  assert_int_equal(tracer_create(world.intersector, &alone), STATUS_OK);
  for (int packet = 0; packet < PACKETS; packet++) {
    struct ray rays[PACKET_SIZE];
    struct hit_list lists[PACKET_SIZE];
    for (int n = 0; n < PACKET_SIZE; n++) {
      const double off = n % 2 ? 0 : ldexp(1, -(int)(random_bits(&random) % 70));
      const double way = random_between(&random, -0.5, 0.5);
      rays[n] = (struct ray){{off, random_between(&random, -0.3, 0.6), 0}, {0, way, n % 3 ? 0 : off}, 0, INFINITY};
    }
    assert_int_equal(tracer_all(world.tracer, PACKET_SIZE, rays, lists), STATUS_OK);
    for (int n = 0; n < PACKET_SIZE; n++) {
      struct hit_list list;
      assert_int_equal(tracer_all(alone, 1, &rays[n], &list), STATUS_OK);
      grazing += list.certainty == CERTAINTY_GRAZING, wrong += !same_list(&lists[n], &list);
    }
  }
  assert_true(grazing > PACKETS * PACKET_SIZE / 8);
  assert_int_equal(wrong, 0);
  tracer_destroy(alone);
  world_close(&world);
}
