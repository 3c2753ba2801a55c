/* Scenes made so that a ray takes long: it is told what is known when its share of work is done, grazing, and what is
 * certain still is.
 */
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "property/world.h"

enum { SEED = 20261122, MOST_PATCHES = 1000, RAYS = 24 };

/* What one ray may take: leaves tried, leaves left open (after some of them all), work of the last resort; where all hits
 * are asked for, more. See lanes/packet.h and exact/judge.c. */
enum { TRIED = 65536, DEAR = 4096, OPEN = DEAR, OPEN_ALL = 1024 + 1, WORK = 5632, WORK_ALL = 49152, OF_ALL = 4 };

typedef void fill(struct random *random, size_t number, size_t count, world_net net);
typedef void aim(struct random *random, struct ray *ray);

static void towards(struct random *random, const double at[3], double off, struct ray *ray)
{
  for (int k = 0; k < 3; k++) {
    ray->origin[k] = random_between(random, -6, 6);
    ray->direction[k] = at[k] + off * random_between(random, -1, 1) - ray->origin[k];
  }
}

/* Nets that are equal but for a rounding or some: those that lie exactly on another one are no part of nearest hits. */
static double off_by(size_t number) { return 1 + (double)number * 0x1p-52; }

/* Points on a line, in no order. */
static const double way[3] = {0.3, 0.5, 0.7};

static void collinear(struct random *random, size_t number, size_t count, world_net net)
{
  (void)count;
  struct random same = {SEED + (number > 0)};
  (void)random;
  for (int n = 0; n < 16; n++) {
    const double t = random_between(&same, -1, 1) * (n == 0 ? off_by(number) : 1);
    for (int k = 0; k < 3; k++) net[n / 4][n % 4][k] = t * way[k];
  }
}

static void along_the_line(struct random *random, struct ray *ray)
{
  const double back = random_between(random, -1, 6);
  towards(random, way, 0, ray);
  for (int k = 0; k < 3; k++) ray->origin[k] = -back * way[k], ray->direction[k] = way[k];
}

/* One point and fifteen equal others. */
static void one_point(struct random *random, size_t number, size_t count, world_net net)
{
  (void)random, (void)count;
  memset(net, 0, sizeof(world_net));
  for (int k = 0; k < 3; k++) net[0][0][k] = off_by(number);
}

static void end_on(struct random *random, struct ray *ray)
{
  const double off = pow(10, random_between(random, -18, -1));
  for (int k = 0; k < 3; k++) ray->origin[k] = 5 + off * random_between(random, -1, 1), ray->direction[k] = -1;
}

/* Round one point, which is a corner of all of them. */
static void fan(struct random *random, size_t number, size_t count, world_net net)
{
  (void)random;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double turn = j == 3 ? (double)((number + 1) % count) : (double)number + j / 3.0;
      const double angle = 2 * acos(-1) * turn / (double)count;
      net[i][j][0] = i * cos(angle), net[i][j][1] = i * sin(angle), net[i][j][2] = -i * i / 9.0;
    }
  }
}

static void past_the_pole(struct random *random, struct ray *ray)
{
  const double off = pow(10, random_between(random, -18, -2));
  towards(random, (const double[3]){0}, off, ray);
  if (random_bits(random) % 2)
    for (int k = 0; k < 3; k++) ray->origin[k] = off * random_between(random, -1, 1);
}

/* The same bowl again and again, and rays next to its top. */
static void bowls(struct random *random, size_t number, size_t count, world_net net)
{
  (void)random, (void)count;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      net[i][j][0] = i - 1.5, net[i][j][1] = j - 1.5, net[i][j][2] = 0.3 * ((i % 3 != 0) + (j % 3 != 0));
  net[0][0][0] *= off_by(number);
}

static void over_the_top(struct random *random, struct ray *ray)
{
  const double off = pow(10, random_between(random, -18, -1)) * (random_bits(random) % 2 ? 1 : -1);
  *ray = (struct ray){{-5, 0, 0.45 + off}, {1, random_between(random, -0.1, 0.1), 0}, 0, INFINITY};
  if (random_bits(random) % 4 == 0) ray->origin[0] = 0;
}

/* Flat ones, in their plane. */
static void floors(struct random *random, size_t number, size_t count, world_net net)
{
  (void)random, (void)count;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) net[i][j][0] = i - 1.5, net[i][j][1] = j - 1.5, net[i][j][2] = 0;
  net[0][0][0] *= off_by(number);
}

static void in_the_plane(struct random *random, struct ray *ray)
{
  *ray = (struct ray){{random_between(random, -3, 1), 0.1, 0}, {1, random_between(random, -0.1, 0.1), 0}, 0, INFINITY};
}

/* The pages of a book, and rays along its spine. */
static void pages(struct random *random, size_t number, size_t count, world_net net)
{
  (void)random;
  const double angle = 2 * acos(-1) * (double)number / (double)count, x = cos(angle), z = sin(angle);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double bend = i * i / 30.0;
      net[i][j][0] = i * x - bend * z, net[i][j][1] = j - 1.5, net[i][j][2] = i * z + bend * x;
    }
  }
}

static void along_the_spine(struct random *random, struct ray *ray)
{
  const double off = pow(10, random_between(random, -18, -2));
  *ray = (struct ray){
    {off * random_between(random, -1, 1), random_between(random, -5, 1), off}, {0, 1, 0}, 0, INFINITY};
  if (random_bits(random) % 3 == 0) towards(random, (const double[3]){0, 0.2, 0}, 0, ray);
}

static const struct made_up {
  const char *name;
  size_t count;
  fill *fill;
  aim *aim;
} made_up[] = {{"collinear", 300, collinear, along_the_line},
               {"one point", 100, one_point, end_on},
               {"fan", 1000, fan, past_the_pole},
               {"bowls", 1000, bowls, over_the_top},
               {"floors", 1000, floors, in_the_plane},
               {"book", 1000, pages, along_the_spine}};

/* What was counted since `before`, which becomes what is counted now. */
static struct intersect_counts counted(const struct world *world, struct intersect_counts *before)
{
  const struct intersect_counts *now = tracer_counts(world->tracer);
  const struct intersect_counts since = {.patches_tested = now->patches_tested - before->patches_tested,
                                         .stages[STAGE_PLANES] = now->stages[STAGE_PLANES] -
                                                                 before->stages[STAGE_PLANES],
                                         .escalated = now->escalated - before->escalated,
                                         .work = now->work - before->work};
  *before = *now;
  return since;
}

static void within(struct intersect_counts took, size_t shares, size_t open, size_t work)
{
  assert_in_range(took.patches_tested, 0, TRIED * shares);
  assert_in_range(took.stages[STAGE_PLANES], 0, DEAR * shares);
  assert_in_range(took.escalated, 0, open);
  assert_in_range(took.work, 0, work);
}

static void a_ray_takes_no_more_than_its_share(void **state)
{
  (void)state;
  static world_net nets[MOST_PATCHES];
  for (size_t s = 0; s < sizeof made_up / sizeof *made_up; s++) {
    const struct made_up *scene = &made_up[s];
    struct random random = {SEED + s};
    for (size_t n = 0; n < scene->count; n++) scene->fill(&random, n, scene->count, nets[n]);
    struct world world;
    world_open(&world, nets, scene->count, NULL);
    struct intersect_counts before = {.work = 0}, most = {.work = 0};
    for (int n = 0; n < RAYS; n++) {
      struct ray ray = {.t_max = INFINITY};
      struct hit_list list;
      bool occluded;
      scene->aim(&random, &ray);
      const struct hit hit = world_closest(&world, &ray);
      const struct intersect_counts took = counted(&world, &before);
      within(took, 1, OPEN, WORK);
      most.patches_tested = took.patches_tested > most.patches_tested ? took.patches_tested : most.patches_tested;
      most.work = took.work > most.work ? took.work : most.work;
      tracer_occluded(world.tracer, 1, &ray, &occluded);
      within(counted(&world, &before), 1, OPEN, WORK);
      assert_int_equal(tracer_all(world.tracer, 1, &ray, &list), STATUS_OK);
      within(counted(&world, &before), OF_ALL, OPEN_ALL, WORK_ALL);
      if (hit.certainty != CERTAINTY_CERTAIN) continue;
      assert_int_equal(occluded, hit.patch != HIT_NONE);
      if (list.certainty == CERTAINTY_CERTAIN) assert_int_equal(list.count > 0, hit.patch != HIT_NONE);
    }
    print_message("%s: at most %d leaves, work %d\n", scene->name, (int)most.patches_tested, (int)most.work);
    world_close(&world);
  }
}

/* A tunnel of arches, longer than a ray's share of leaves, and a wall behind it. */
enum { ARCHES = 5000 };

static void tunnel(world_net nets[])
{
  static const double arch[4][2] = {{-1, -1}, {-1, 2}, {1, 2}, {1, -1}};
  for (size_t p = 0; p <= ARCHES; p++) {
    for (int n = 0; n < 16; n++) {
      double *at = nets[p][n / 4][n % 4];
      at[0] = arch[n / 4][0], at[1] = arch[n / 4][1], at[2] = (double)p + n % 4 / 3.0;
      if (p == ARCHES) at[0] = 2 * (n / 4) - 3, at[1] = 2 * (n % 4) - 3, at[2] = ARCHES + 3;
    }
  }
}

/* A ray that is let go on its way through the tunnel is hidden, be it alone or together with one that comes by the wall
 * first and has the others do so too. */
static void what_is_not_looked_at_hides(void **state)
{
  (void)state;
  static world_net nets[ARCHES + 1];
  struct world world;
  struct method whole;
  struct ray rays[PACKET_SIZE];
  bool occluded[PACKET_SIZE], alone;
  tunnel(nets);
  method_default(solver_at(0), &whole);
  whole.split = 1;
  world_open(&world, nets, ARCHES + 1, &whole);
  for (int n = 0; n < PACKET_SIZE; n++) rays[n] = (struct ray){{1e-3 * n, 0.1, -2}, {1e-6, 1e-6, 1}, 0, INFINITY};
  rays[0] = (struct ray){{0, 0.1, ARCHES + 5}, {-1e-6, -1e-6, -1}, 0, INFINITY};
  tracer_occluded(world.tracer, PACKET_SIZE, rays, occluded);
  for (int n = 0; n < PACKET_SIZE; n++) {
    tracer_occluded(world.tracer, 1, &rays[n], &alone);
    assert_true(occluded[n] && alone);
    const struct hit hit = world_closest(&world, &rays[n]);
    assert_int_equal(hit.certainty, n == 0 ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING);
  }
  world_close(&world);
}

/* As many sheets, one behind the other, that the ray passes next to an edge, so that each is tried; and a wall behind them,
 * which it meets. */
static void passed_sheet(size_t number, world_net net)
{
  for (int n = 0; n < 16; n++) {
    const int i = n / 4, j = n % 4;
    const double a = (i - j) / 3.0 + 0.05 * sin(3 * i + j), b = (i + j) / 3.0 + 0.05 * cos(i + 2 * j);
    const double at[3] = {a, b, 0.5 * (double)number + 0.3 * a + 0.2 * b + 0.01 * sin(2 * i + j)};
    memcpy(net[i][j], at, sizeof at);
  }
}

static void what_is_passed_by_hides_nothing(void **state)
{
  (void)state;
  static world_net nets[ARCHES + 1];
  struct world world;
  const struct ray ray = {{0.531, 0.529, -5}, {0, 0, 1}, 0, INFINITY};
  for (size_t p = 0; p < ARCHES; p++) passed_sheet(p, nets[p]);
  for (int n = 0; n < 16; n++) {
    double *at = nets[ARCHES][n / 4][n % 4];
    at[0] = 100 * (n / 4 - 1.5), at[1] = 100 * (n % 4 - 1.5), at[2] = 0.5 * ARCHES + 10;
  }
  world_open(&world, nets, ARCHES + 1, NULL);
  const struct hit hit = world_closest(&world, &ray);
  assert_int_equal(hit.patch, ARCHES);
  assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
  assert_true(tracer_counts(world.tracer)->patches_tested > DEAR); /* they are */
  world_close(&world);
}

/* Villages, and a patch all by itself, so far apart that floats in the frame of the whole would not tell the patches of one
 * from one another. */
enum { VILLAGES = 3, VILLAGE = 60, VILLAGERS = VILLAGES * VILLAGE };

static void village(struct random *random, const double at[3], world_net nets[VILLAGE])
{
  for (int p = 0; p < VILLAGE; p++) {
    double corner[3];
    for (int k = 0; k < 3; k++) corner[k] = at[k] + random_between(random, -2, 2);
    for (int n = 0; n < 16; n++) {
      const double step[3] = {n / 4 * 0.3, n % 4 * 0.3, random_between(random, -0.2, 0.2)};
      for (int k = 0; k < 3; k++) nets[p][n / 4][n % 4][k] = corner[k] + step[k];
    }
  }
}

/* Rays at a village are answered as if there were nothing else, and by trying no more leaves. */
static void what_is_far_away_costs_nothing(void **state)
{
  (void)state;
  static world_net nets[VILLAGERS + 1];
  size_t hits = 0;
  static const double distances[] = {1e3, 1e6, 1e9, 1e12, 1e15, 1e17, 1e20, 1e30, 1e45, 1e100, 1e300};
  for (size_t d = 0; d < sizeof distances / sizeof distances[0]; d++) {
    const double apart = distances[d];
    struct random random = {SEED};
    const double at[VILLAGES + 1][3] = {{0, 0, 0}, {apart, 0, 0}, {apart / 3, -apart, 7}, {-apart, apart, apart}};
    for (int v = 0; v < VILLAGES; v++) village(&random, at[v], nets + VILLAGE * v);
    for (int n = 0; n < 16; n++)
      for (int k = 0; k < 3; k++)
        nets[VILLAGERS][n / 4][n % 4][k] = at[VILLAGES][k] + (k == 0) * (n / 4) + (k == 1) * (n % 4);
    struct world all, alone;
    world_open(&all, nets, VILLAGERS + 1, NULL);
    for (int v = 0; v < (apart > 1e12 ? 1 : VILLAGES); v++) { /* the others are rounded to pieces then */
      struct intersect_counts before = *tracer_counts(all.tracer), none = {.work = 0};
      world_open(&alone, nets + VILLAGE * v, VILLAGE, NULL);
      for (int n = 0; n < 10 * RAYS; n++) {
        struct ray ray = {.t_max = INFINITY};
        for (int k = 0; k < 3; k++) {
          ray.origin[k] = at[v][k] + random_between(&random, -5, 5);
          ray.direction[k] = at[v][k] + random_between(&random, -2, 2) - ray.origin[k];
        }
        if (ray.direction[0] == 0 && ray.direction[1] == 0 && ray.direction[2] == 0) continue;
        struct hit hit = world_closest(&all, &ray);
        const struct hit other = world_closest(&alone, &ray);
        if (other.certainty != CERTAINTY_CERTAIN) continue;
        assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
        if (hit.patch < VILLAGERS && other.patch == HIT_NONE) continue; /* it goes on to another village */
        if (hit.patch != HIT_NONE) hit.patch -= (uint32_t)(VILLAGE * v);
        assert_int_equal(hit.patch, other.patch);
        if (hit.patch != HIT_NONE) assert_true(fabs(hit.t - other.t) <= 0x1p-50 * other.t);
        hits += hit.patch != HIT_NONE;
      }
      const uint64_t took = counted(&all, &before).patches_tested, least = counted(&alone, &none).patches_tested;
      assert_in_range(took, 0, 2 * least + 10 * RAYS);
      world_close(&alone);
    }
    world_close(&all);
  }
  assert_true(hits > 1000);
}

/* A bumpy square of that size in the plane y = 0, or with a corner there. */
static void square(double size, bool corner, world_net net)
{
  static const double bump[4] = {1, 2, 0, 1}, along[4] = {1, 0, 1, 2};
  for (int n = 0; n < 16; n++) {
    const double at[3] = {2 * (n / 4) - 3 * !corner, bump[n / 4] * along[n % 4] / 4, 2 * (n % 4) - 3 * !corner};
    for (int k = 0; k < 3; k++) net[n / 4][n % 4][k] = size * at[k];
  }
}

/* Patches in one place, some of them up to 1e560 times as large as others: each is hit as if it were alone, in whatever order
 * they come. */
static void sizes_have_nothing_to_do_with_each_other(void **state)
{
  (void)state;
  enum { SCENES = 400, MOST = 5, LEAST_APART = 3, FARTHEST = 280 };
  struct random random = {SEED};
  size_t hits = 0;
  for (int n = 0; n < SCENES; n++) {
    world_net nets[MOST];
    double power[MOST];
    size_t count = 0;
    for (int k = 0; k < MOST; k++) {
      const double here = k == 0 ? 0 : random_between(&random, -FARTHEST, FARTHEST);
      bool apart = true;
      for (size_t p = 0; p < count; p++) apart &= fabs(power[p] - here) >= LEAST_APART;
      if (apart) power[count++] = here;
    }
    for (size_t p = 0; p < count; p++) square(pow(10, power[p]), n % 2, nets[p]);
    struct world all;
    world_open(&all, nets, count, NULL);
    for (size_t p = 0; p < count; p++) {
      struct world alone;
      world_open(&alone, &nets[p], 1, NULL);
      const double size = pow(10, power[p]);
      for (int k = 0; k < RAYS; k++) {
        struct ray ray = {.t_max = INFINITY, .origin = {0, 8 * size, 0}, .direction = {0, -1, 0}};
        for (int c = 0; c < 3; c += 2) {
          ray.origin[c] = size * random_between(&random, -1, 3);
          if (k % 2) ray.direction[c] = random_between(&random, -0.1, 0.1);
        }
        struct hit hit = world_closest(&all, &ray);
        const struct hit other = world_closest(&alone, &ray);
        if (other.certainty != CERTAINTY_CERTAIN || other.patch == HIT_NONE) continue;
        assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
        assert_int_equal(hit.patch, p);
        assert_true(fabs(hit.t - other.t) <= 0x1p-50 * other.t);
        hits++;
      }
      world_close(&alone);
    }
    world_close(&all);
  }
  assert_true(hits > SCENES * RAYS);
}

/* Bowls round 0, each 2^8 times as wide as the next one, from one end of the doubles to the other, and a crowd at the bottom. */
enum { BOWLS = 240, AT_THE_BOTTOM = 17000, DEEP_RAYS = 16 };

/* What a call may take, as of pscn.h. The sanitizers' frames are larger. */
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
enum { DEEP_STACK = 12 << 20 };
#else
enum { DEEP_STACK = 3 << 19 };
#endif

struct deep {
  struct world world;
  struct ray rays[DEEP_RAYS];
  struct hit hits[DEEP_RAYS];
  bool occluded[DEEP_RAYS];
  size_t listed[DEEP_RAYS];
};

static void *go_deep(void *context)
{
  struct deep *d = context;
  struct hit_list lists[PACKET_SIZE];
  for (size_t n = 0; n < DEEP_RAYS; n += PACKET_SIZE) {
    const size_t count = DEEP_RAYS - n < PACKET_SIZE ? DEEP_RAYS - n : PACKET_SIZE;
    tracer_closest(d->world.tracer, count, d->rays + n, d->hits + n);
    tracer_occluded(d->world.tracer, count, d->rays + n, d->occluded + n);
    if (tracer_all(d->world.tracer, count, d->rays + n, lists) != STATUS_OK) return NULL;
    for (size_t k = 0; k < count; k++) d->listed[n + k] = lists[k].count;
  }
  return d;
}

static void frames_within_frames_take_little_stack(void **state)
{
  (void)state;
  static world_net nets[BOWLS + AT_THE_BOTTOM];
  static struct deep d;
  for (int crowd = 0; crowd < 2; crowd++) { /* with it the rays go apart */
    for (int k = 0; k < BOWLS; k++) {
      const double size = exp2(1000 - 8.2 * k);
      for (int n = 0; n < 16; n++) {
        const int i = n / 4, j = n % 4;
        const double at[3] = {(i - 1.5) / 1.5, (j - 1.5) / 1.5, ((i == 1 || i == 2) + (j == 1 || j == 2)) / 4.0 - 1};
        for (int c = 0; c < 3; c++) nets[k][i][j][c] = size * at[c];
      }
    }
    const double least = exp2(1000 - 8.2 * BOWLS);
    for (int k = 0; k < AT_THE_BOTTOM; k++)
      for (int n = 0; n < 16; n++) {
        const double at[3] = {(n / 4 * 0.01 + 0.1 * (k % 128)) / 128, (n % 4 * 0.01 + 0.1 * (k / 128)) / 128, 1e-6 * k};
        for (int c = 0; c < 3; c++) nets[BOWLS + k][n / 4][n % 4][c] = least * (at[c] + 0.1);
      }
    for (int n = 0; n < DEEP_RAYS; n++) {
      d.rays[n] = (struct ray){.t_max = INFINITY};
      for (int c = 0; c < 3; c++) {
        d.rays[n].origin[c] = least * (n + c) * 1e-3;
        d.rays[n].direction[c] = (n >> c & 1 ? 1 : -1) * (1 + 0.01 * c + 0.001 * n);
      }
    }
    world_open(&d.world, nets, crowd ? BOWLS + AT_THE_BOTTOM : BOWLS, NULL);
    pthread_t thread;
    pthread_attr_t attributes;
    void *done;
    assert_int_equal(pthread_attr_init(&attributes), 0);
    assert_int_equal(pthread_attr_setstacksize(&attributes, DEEP_STACK), 0);
    assert_int_equal(pthread_create(&thread, &attributes, go_deep, &d), 0);
    assert_int_equal(pthread_join(thread, &done), 0);
    pthread_attr_destroy(&attributes);
    assert_non_null(done);
    size_t hits = 0;
    for (int n = 0; n < DEEP_RAYS; n++) {
      const struct hit alone = world_closest(&d.world, &d.rays[n]);
      assert_int_equal(d.hits[n].patch, alone.patch);
      assert_int_equal(d.hits[n].certainty, alone.certainty);
      assert_int_equal(d.occluded[n], alone.patch != HIT_NONE);
      hits += alone.patch != HIT_NONE && d.listed[n] > 0;
    }
    assert_true(hits >= DEEP_RAYS / 4);
    world_close(&d.world);
  }
}

/* What is counted without being tried. Of more patches than these neither they nor leaves are kept. */
enum { KEPT = 1 << 16, CROWD = KEPT + 4096, THROUGH = 4000, FEW_LOOKS = 90000 };

/* Flat nets through one point. */
static void through_the_point(struct random *random, world_net net)
{
  double along[2][3];
  for (int k = 0; k < 6; k++) along[k / 3][k % 3] = random_between(random, -1, 1);
  for (int n = 0; n < 16; n++)
    for (int k = 0; k < 3; k++) net[n / 4][n % 4][k] = (n / 4 - 1.5) * along[0][k] + (n % 4 - 1.5) * along[1][k];
}

/* A sheaf of straws, aslant so that each one's box is everyone's. */
static void straw(struct random *random, world_net net)
{
  const double at[2] = {random_between(random, -1e-3, 1e-3), random_between(random, -1e-3, 1e-3)};
  for (int n = 0; n < 16; n++) {
    const double t = n / 4 - 1.5;
    for (int k = 0; k < 3; k++) net[n / 4][n % 4][k] = t + (k < 2 ? at[k] : 0) + 1e-6 * random_between(random, -1, 1);
  }
}

/* Far from all that. */
static void aside(struct random *random, world_net net)
{
  double at[3];
  for (int k = 0; k < 3; k++) at[k] = (k == 0 ? 20 : 0) + random_between(random, -1, 1);
  for (int n = 0; n < 48; n++) net[n / 12][n / 3 % 4][n % 3] = at[n % 3] + random_between(random, 0, 1e-3);
}

/* The first rays of each packet are the hard ones. In company, asked alone where these take too much, they and those
 * beside are told what they are told alone. Returns how many of the hard ones are certain. */
static int certain_of(const struct world *world, size_t hard, const struct ray rays[PACKET_SIZE])
{
  struct hit hits[PACKET_SIZE];
  bool occluded[PACKET_SIZE];
  int certain = 0;
  tracer_closest(world->tracer, PACKET_SIZE, rays, hits);
  tracer_occluded(world->tracer, PACKET_SIZE, rays, occluded);
  for (size_t n = 0; n < PACKET_SIZE; n++) {
    const struct hit alone = world_closest(world, &rays[n]);
    bool hidden;
    tracer_occluded(world->tracer, 1, &rays[n], &hidden);
    assert_int_equal(hits[n].certainty, alone.certainty);
    assert_int_equal(hits[n].patch, alone.patch);
    assert_int_equal(occluded[n], hidden);
    if (alone.certainty == CERTAINTY_GRAZING) assert_true(hidden);
    if (n < hard) certain += alone.certainty == CERTAINTY_CERTAIN;
    else assert_int_equal(alone.certainty, CERTAINTY_CERTAIN);
  }
  return certain;
}

static void boxes_and_leaves_made_are_counted(void **state)
{
  (void)state;
  enum { STRAWS, POINT, KINDS, HARD = 8 };
  static const char *const names[KINDS] = {"straws", "through the point"};
  world_net *nets = calloc(CROWD, sizeof *nets);
  struct method whole;
  assert_non_null(nets);
  method_default(solver_at(0), &whole);
  whole.split = 1;
  for (int kind = 0; kind < KINDS; kind++) {
    struct random random = {SEED + (uint64_t)kind};
    struct ray rays[PACKET_SIZE];
    for (size_t p = 0; p < CROWD; p++)
      if (kind == STRAWS) straw(&random, nets[p]);
      else if (p < THROUGH) through_the_point(&random, nets[p]);
      else aside(&random, nets[p]);
    for (size_t n = 0; n < PACKET_SIZE; n++) {
      rays[n] = (struct ray){.t_max = INFINITY};
      towards(&random, (const double[3]){0}, kind == STRAWS ? 1e-6 : 1e-8, &rays[n]);
      if (n >= HARD) rays[n].origin[2] += 40;
    }
    for (int crowd = 0; crowd < 2; crowd++) {
      struct world world;
      world_open(&world, nets, crowd ? CROWD : kind == STRAWS ? CROWD / 8 : THROUGH, &whole);
      world.tracer->most_looks = FEW_LOOKS;
      const int certain = certain_of(&world, HARD, rays);
      print_message("%s, %s: %d certain\n", names[kind], crowd ? "more" : "few", certain);
      assert_int_equal(certain, crowd ? 0 : HARD);
      world_close(&world);
    }
  }
  free(nets);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_ray_takes_no_more_than_its_share),
                                     cmocka_unit_test(what_is_not_looked_at_hides),
                                     cmocka_unit_test(what_is_passed_by_hides_nothing),
                                     cmocka_unit_test(what_is_far_away_costs_nothing),
                                     cmocka_unit_test(sizes_have_nothing_to_do_with_each_other),
                                     cmocka_unit_test(frames_within_frames_take_little_stack),
                                     cmocka_unit_test(boxes_and_leaves_made_are_counted)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
