/* The estimate of how many surfaces a line crosses in a tree is right, compared with random lines; and answers do
 * not depend on the order in which trees with many crossings are walked. */
#include <math.h>
#include <stdlib.h>

#include "cmocka_test.h"
#include "property/world.h"

enum { SEED = 20261124, NETS = 250 * WORLD_MAX };

/* NETS wild nets in one place, in leaves so small that a line passes hundreds of their boxes. */
static void open_deep(struct world *world, struct random *random, world_net nets[NETS])
{
  struct method options;
  size_t count = 0;
  method_default(solver_find("bernstein", 9), &options);
  options.split = 4;
  while (count + WORLD_MAX <= NETS) count += world_fill(WORLD_WILD, random, nets + count);
  world_open(world, nets, count, &options);
}

/* The tree that the world's rays walk first. */
static struct model_tree *tree_of(const struct world *world)
{
  return (struct model_tree *)&world->tracer->model->tree;
}

/* ---- how many ---- */

static void random_direction(struct random *random, double out[3])
{
  double square;
  do {
    square = 0;
    for (int k = 0; k < 3; k++) out[k] = random_between(random, -1, 1), square += out[k] * out[k];
  } while (square > 1 || square < 0.01);
  for (int k = 0; k < 3; k++) out[k] /= sqrt(square);
}

/* The hull of the root's boxes, in the scene's coordinates. */
static void hull_of(const struct model_tree *tree, double lo[3], double hi[3])
{
  const struct bvh_node *root = &tree->bvh.nodes[0];
  for (int k = 0; k < 3; k++) {
    lo[k] = INFINITY, hi[k] = -INFINITY;
    for (int side = 0; side < BVH_WIDTH && root->child[side] != 0; side++)
      lo[k] = fmin((double)root->lo[k][side], lo[k]), hi[k] = fmax((double)root->hi[k][side], hi[k]);
    lo[k] = lo[k] * tree->frame + tree->origin[k], hi[k] = hi[k] * tree->frame + tree->origin[k];
  }
}

static bool meets(const double lo[3], const double hi[3], const struct ray *line)
{
  double from = -INFINITY, to = INFINITY;
  for (int k = 0; k < 3; k++) {
    const double a = (lo[k] - line->origin[k]) / line->direction[k], b = (hi[k] - line->origin[k]) / line->direction[k];
    from = fmax(from, fmin(a, b)), to = fmin(to, fmax(a, b));
  }
  return from <= to;
}

/* Lines equally likely anywhere and in any direction: each goes through a random point of a sphere's disk, across a
 * random direction. */
static double crossings_by_lines(struct world *world, struct random *random)
{
  double lo[3], hi[3], middle[3], radius = 0;
  size_t lines = 0, crossings = 0;
  hull_of(tree_of(world), lo, hi);
  for (int k = 0; k < 3; k++) middle[k] = (lo[k] + hi[k]) / 2, radius += (hi[k] - lo[k]) * (hi[k] - lo[k]) / 4;
  radius = sqrt(radius);
  while (lines < 4000) {
    struct ray line = {.t_min = 0, .t_max = INFINITY};
    struct hit_list list;
    double across[3], along = 0;
    random_direction(random, line.direction), random_direction(random, across);
    for (int k = 0; k < 3; k++) along += across[k] * line.direction[k];
    double length = 0, far = radius * sqrt(random_unit(random));
    for (int k = 0; k < 3; k++) across[k] -= along * line.direction[k], length += across[k] * across[k];
    for (int k = 0; k < 3; k++)
      line.origin[k] = middle[k] + far * across[k] / sqrt(length) - 4 * radius * line.direction[k];
    if (!meets(lo, hi, &line)) continue;
    assert_int_equal(tracer_all(world->tracer, 1, &line, &list), STATUS_OK);
    lines++, crossings += list.count;
  }
  return (double)crossings / (double)lines;
}

/* A leaf's area is a little smaller than that of the face of the box along it. */
TEST(lines_cross_as_many)
{
  static const enum world_kind kinds[] = {WORLD_GRID, WORLD_WILD, WORLD_DOME, WORLD_LOW};
  struct random random = {SEED};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
    world_net nets[WORLD_MAX];
    struct world world;
    const size_t count = world_fill(kinds[k], &random, nets);
    world_open(&world, nets, count, NULL);
    const double told = tree_of(&world)->crossings, found = crossings_by_lines(&world, &random);
    world_close(&world);
    print_message("kind %d: %.3f told, %.3f found\n", kinds[k], told, found);
    assert_true(told >= 0.9 * found && told <= 1.5 * found);
  }
}

/* ---- the order ---- */

enum { RAYS = 40 * PACKET_SIZE };

struct answers {
  struct hit hit[RAYS];
  uint64_t tested;
};

/* Asks `together` rays at once. */
static void ask(struct world *world, const struct ray rays[RAYS], size_t together, struct answers *out)
{
  const uint64_t before = world->tracer->counts.patches_tested;
  for (size_t n = 0; n < RAYS; n += together)
    tracer_closest(world->tracer, together < RAYS - n ? together : RAYS - n, rays + n, out->hit + n);
  out->tested = world->tracer->counts.patches_tested - before;
}

/* Rays side by side, which stay together in packets, and rays in all directions. */
static void make_rays(struct random *random, struct ray rays[RAYS])
{
  for (int n = 0; n < RAYS; n++) {
    struct ray *ray = &rays[n];
    *ray = (struct ray){.origin = {0.3, -0.2, 6}, .direction = {0, 0, -1}, .t_max = INFINITY};
    for (int k = 0; k < 2; k++)
      ray->direction[k] = 0.2 * sin(n / PACKET_SIZE * (k + 2)) + random_between(random, -0.01, 0.01);
    if (n >= RAYS / 2) random_direction(random, ray->direction);
    for (int k = 0; k < 3 && n >= RAYS / 2; k++) ray->origin[k] = random_between(random, -1, 1) - 3 * ray->direction[k];
  }
}

TEST(answers_do_not_depend_on_the_order_of_leaves)
{
  static world_net nets[NETS];
  static struct ray rays[RAYS];
  static struct answers node_by_node, nearest_first;
  struct random random = {SEED + 1};
  struct world world;
  int wrong = 0, hits = 0;
  open_deep(&world, &random, nets);
  make_rays(&random, rays);
  struct model_tree *tree = tree_of(&world);
  const double crossings = tree->crossings;
  const size_t together[] = {1, 3, PACKET_SIZE};
  for (size_t k = 0; k < sizeof together / sizeof *together; k++) {
    tree->crossings = 0, ask(&world, rays, together[k], &node_by_node);
    tree->crossings = crossings, ask(&world, rays, together[k], &nearest_first);
    for (int n = 0; n < RAYS; n++) {
      const struct hit *a = &node_by_node.hit[n], *b = &nearest_first.hit[n];
      hits += b->patch != HIT_NONE;
      if (!same_hit(a, b) && wrong++ < 3) world_print_case("order", WORLD_WILD, &rays[n], a, b);
    }
    print_message("%zu at once: %.1f leaves a ray node by node, %.1f nearest first\n", together[k],
                  (double)node_by_node.tested / RAYS, (double)nearest_first.tested / RAYS);
    assert_true(nearest_first.tested < node_by_node.tested);
  }
  world_close(&world);
  assert_int_equal(wrong, 0);
  assert_true(hits > RAYS);
}
