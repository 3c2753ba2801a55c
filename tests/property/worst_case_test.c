/* Scenes made to keep a ray busy: when its budget is exhausted, the ray gets what is known, as grazing; what is certain
 * stays so. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "method_of.h"
#include "property/world.h"

enum { SEED = 20261122, MOST_PATCHES = 1000, RAYS = 24 };

/* Work of the last resort for one ray: in company and alone. The budget is looked at between pieces and candidates, so
 * LATE is what some candidates may cost. */
enum { WORK = RAY_BUDGET / COST_EXACT * 5 / 4, WORK_ALL = 49152, LATE = 1 << 14 };

typedef void fill(struct random *random, size_t number, size_t count, world_net net);
typedef void aim(struct random *random, struct ray *ray);

/* Makes nets equal up to a rounding or a few: nets exactly on another one take no part in nearest hits. */
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
  world_towards(random, way, 0, ray);
  for (int k = 0; k < 3; k++) ray->origin[k] = -back * way[k], ray->direction[k] = way[k];
}

/* One point and fifteen others that are equal. */
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

/* Patches round one point, a corner of all of them. */
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
  world_towards(random, (const double[3]){0}, off, ray);
  if (random_bits(random) % 2)
    for (int k = 0; k < 3; k++) ray->origin[k] = off * random_between(random, -1, 1);
}

/* The same bowl repeated, and rays next to its top. */
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

/* Flat patches, and rays in their plane. */
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
  if (random_bits(random) % 3 == 0) world_towards(random, (const double[3]){0, 0.2, 0}, 0, ray);
}

static const struct made_up {
  size_t count;
  fill *fill;
  aim *aim;
} made_up[] = {{300, collinear, along_the_line}, {100, one_point, end_on},     {1000, fan, past_the_pole},
               {1000, bowls, over_the_top},      {1000, floors, in_the_plane}, {1000, pages, along_the_spine}};

/* The counts since `before`, which is then set to the present counts. */
static struct intersect_counts counted(const struct world *world, struct intersect_counts *before)
{
  const struct intersect_counts *now = tracer_counts(world->tracer);
  const struct intersect_counts since = {
    .patches_tested = now->patches_tested - before->patches_tested,
    .stages[STAGE_PLANES] = now->stages[STAGE_PLANES] - before->stages[STAGE_PLANES],
    .stages[STAGE_RESULTANT] = now->stages[STAGE_RESULTANT] - before->stages[STAGE_RESULTANT],
    .work = now->work - before->work};
  *before = *now;
  return since;
}

static void within(struct intersect_counts took, size_t work)
{
  const uint64_t *stages = took.stages;
  const uint64_t cost = COST_TRIED * took.patches_tested + COST_PLANES * stages[STAGE_PLANES] +
                        COST_RESULTANT * stages[STAGE_RESULTANT];
  assert_in_range(cost, 0, RAY_BUDGET + LATE);
  assert_in_range(took.work, 0, work);
}

TEST(a_ray_takes_no_more_than_its_budget)
{
  static world_net nets[MOST_PATCHES];
  for (size_t s = 0; s < sizeof made_up / sizeof *made_up; s++) {
    const struct made_up *scene = &made_up[s];
    struct random random = {SEED + s};
    for (size_t n = 0; n < scene->count; n++) scene->fill(&random, n, scene->count, nets[n]);
    struct world world;
    world_open(&world, nets, scene->count, NULL);
    struct intersect_counts before = {.work = 0};
    for (int n = 0; n < RAYS; n++) {
      struct ray ray = {.t_max = INFINITY};
      bool occluded;
      scene->aim(&random, &ray);
      const struct hit hit = world_closest(&world, &ray);
      within(counted(&world, &before), WORK);
      tracer_occluded(world.tracer, 1, &ray, &occluded);
      within(counted(&world, &before), WORK);
      const struct hit_list list = world_all(&world, &ray);
      within(counted(&world, &before), WORK_ALL);
      if (hit.certainty != CERTAINTY_CERTAIN) continue;
      assert_int_equal(occluded, hit.patch != HIT_NONE);
      if (list.certainty == CERTAINTY_CERTAIN) assert_int_equal(list.count > 0, hit.patch != HIT_NONE);
    }
    world_close(&world);
  }
}

/* A tunnel of arches, more leaves than a ray's budget lasts for, and a wall behind it. */
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

/* A ray whose work ends on its way through the tunnel counts as hidden, alone or together with a ray that reaches
 * the wall first and makes the others do so too. */
TEST(what_is_not_looked_at_hides)
{
  static world_net nets[ARCHES + 1];
  struct world world;
  const struct method whole = method_of("bernstein { split 1 }");
  struct ray rays[PACKET_SIZE];
  bool occluded[PACKET_SIZE], alone;
  tunnel(nets);
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

/* As many sheets, one behind the other, which the ray passes next to an edge, so that it is tried on each; and a
 * wall behind them, which it meets. */
static void passed_sheet(size_t number, world_net net)
{
  for (int n = 0; n < 16; n++) {
    const int i = n / 4, j = n % 4;
    const double a = (i - j) / 3.0 + 0.05 * sin(3 * i + j), b = (i + j) / 3.0 + 0.05 * cos(i + 2 * j);
    const double at[3] = {a, b, 0.5 * (double)number + 0.3 * a + 0.2 * b + 0.01 * sin(2 * i + j)};
    memcpy(net[i][j], at, sizeof at);
  }
}

TEST(what_is_passed_by_hides_nothing)
{
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
  assert_true(tracer_counts(world.tracer)->patches_tested > ARCHES / 2); /* it was tried on them */
  world_close(&world);
}

/* Work that is counted without leaves being tried. With more patches than KEPT, neither patches nor leaves are kept. */
enum { KEPT = 1 << 16, CROWD = KEPT + 4096, THROUGH = 4000, BUDGET = 90000 };

/* Flat nets through one point. */
static void through_the_point(struct random *random, world_net net)
{
  double along[2][3];
  for (int k = 0; k < 6; k++) along[k / 3][k % 3] = random_between(random, -1, 1);
  for (int n = 0; n < 16; n++)
    for (int k = 0; k < 3; k++) net[n / 4][n % 4][k] = (n / 4 - 1.5) * along[0][k] + (n % 4 - 1.5) * along[1][k];
}

/* A sheaf of straws, at such a slant that their boxes all overlap. */
static void straw(struct random *random, world_net net)
{
  const double at[2] = {random_between(random, -1e-3, 1e-3), random_between(random, -1e-3, 1e-3)};
  for (int n = 0; n < 16; n++) {
    const double t = n / 4 - 1.5;
    for (int k = 0; k < 3; k++) net[n / 4][n % 4][k] = t + (k < 2 ? at[k] : 0) + 1e-6 * random_between(random, -1, 1);
  }
}

/* Far from all others. */
static void aside(struct random *random, world_net net)
{
  double at[3];
  for (int k = 0; k < 3; k++) at[k] = (k == 0 ? 20 : 0) + random_between(random, -1, 1);
  for (int n = 0; n < 48; n++) net[n / 12][n / 3 % 4][n % 3] = at[n % 3] + random_between(random, 0, 1e-3);
}

/* The first rays of each packet are the hard ones. They and the rays beside them get the same answers in the packet
 * as alone, even if the hard ones exhaust their budgets. Returns how many of the hard ones are certain. */
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

TEST(boxes_and_leaves_made_are_counted)
{
  enum { STRAWS, POINT, KINDS, HARD = 8 };
  world_net *nets = calloc(CROWD, sizeof *nets);
  const struct method whole = method_of("bernstein { split 1 }");
  assert_non_null(nets);
  for (int kind = 0; kind < KINDS; kind++) {
    struct random random = {SEED + (uint64_t)kind};
    struct ray rays[PACKET_SIZE];
    for (size_t p = 0; p < CROWD; p++)
      if (kind == STRAWS) straw(&random, nets[p]);
      else if (p < THROUGH) through_the_point(&random, nets[p]);
      else aside(&random, nets[p]);
    for (size_t n = 0; n < PACKET_SIZE; n++) {
      rays[n] = (struct ray){.t_max = INFINITY};
      world_towards(&random, (const double[3]){0}, kind == STRAWS ? 1e-6 : 1e-8, &rays[n]);
      if (n >= HARD) rays[n].origin[2] += 40;
    }
    for (int crowd = 0; crowd < 2; crowd++) {
      struct world world;
      world_open(&world, nets, crowd ? CROWD : kind == STRAWS ? CROWD / 8 : THROUGH, &whole);
      world.tracer->budget = BUDGET;
      const int certain = certain_of(&world, HARD, rays);
      assert_int_equal(certain, crowd ? 0 : HARD);
      world_close(&world);
    }
  }
  free(nets);
}
