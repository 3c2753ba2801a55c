/* The estimate of how many surfaces a line crosses in a tree is right, compared with random lines. */
#include <math.h>
#include <stdlib.h>

#include "cmocka_test.h"
#include "property/world.h"

enum { SEED = 20261124 };

/* The tree that the world's rays walk first. */
static const struct model_tree *tree_of(const struct world *world) { return &world->tracer->model->tree; }

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
