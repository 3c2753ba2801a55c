/* The bounding volume hierarchy: containment, completeness, depth, on friendly and on hostile boxes. */
#include "geometry/bvh.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "random.h"

enum { SEED = 20240503, MANY = 3000 };

struct walk {
  const struct bvh *bvh;
  const struct bvh_box *boxes;
  unsigned char *seen;
  size_t nodes;
  int depth;
};

static bool contains(const struct bvh_node *node, int side, const struct bvh_box *box)
{
  for (int k = 0; k < 3; k++)
    if (!((double)node->lo[k][side] <= box->lo[k] && (double)node->hi[k][side] >= box->hi[k])) return false;
  return true;
}

/* Walks the subtree. Returns the exact union of the boxes below it, which the parent must contain. */
static struct bvh_box walk(struct walk *w, uint32_t child, int depth)
{
  if (depth > w->depth) w->depth = depth;
  if (child & BVH_LEAF) {
    const uint32_t index = child & ~BVH_LEAF;
    w->seen[index]++;
    return w->boxes[index];
  }
  const struct bvh_node *node = &w->bvh->nodes[child];
  assert_true(child < w->bvh->node_count);
  assert_true(w->nodes++ < w->bvh->node_count); /* no cycle */
  struct bvh_box sum = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  assert_int_not_equal(node->child[0], 0);
  for (int side = 0; side < BVH_WIDTH; side++) {
    if (node->child[side] == 0) { /* so are all that follow */
      assert_true(side + 1 == BVH_WIDTH || node->child[side + 1] == 0);
      continue;
    }
    const struct bvh_box below = walk(w, node->child[side], depth + 1);
    assert_true(contains(node, side, &below));
    for (int k = 0; k < 3; k++) sum.lo[k] = fmin(sum.lo[k], below.lo[k]), sum.hi[k] = fmax(sum.hi[k], below.hi[k]);
  }
  return sum;
}

/* Builds the tree and checks all that the header promises. Returns the depth. */
static int check(const struct bvh_box *boxes, size_t count)
{
  struct bvh bvh;
  struct bvh_box *given = malloc(count * sizeof *given);
  assert_non_null(given);
  memcpy(given, boxes, count * sizeof *given);
  assert_int_equal(bvh_build(given, count, NULL, &bvh), STATUS_OK);
  free(given);
  unsigned char *seen = calloc(count, 1);
  assert_non_null(seen);
  struct walk w = {&bvh, boxes, seen, 0, 0};
  walk(&w, 0, 0);
  for (size_t k = 0; k < count; k++) assert_int_equal(seen[k], 1);
  assert_int_equal(w.nodes, bvh.node_count);
  assert_true(w.depth <= BVH_MAX_DEPTH);
  free(seen);
  bvh_free(&bvh);
  assert_true(bvh.nodes == NULL && bvh.node_count == 0);
  return w.depth;
}

static struct bvh_box box_at(struct random *random, double spread, double size, const double offset[3])
{
  struct bvh_box box;
  for (int k = 0; k < 3; k++) {
    const double at = offset[k] + random_between(random, -spread, spread);
    box.lo[k] = at - size * random_unit(random), box.hi[k] = at + size * random_unit(random);
  }
  return box;
}

TEST(none_one_two)
{
  struct bvh bvh = {(struct bvh_node *)&bvh, 7};
  assert_int_equal(bvh_build(NULL, 0, NULL, &bvh), STATUS_OK);
  assert_true(bvh.node_count == 0 && bvh.nodes == NULL);
  bvh_free(&bvh);

  struct random random = {SEED};
  const double zero[3] = {0, 0, 0};
  struct bvh_box boxes[2] = {box_at(&random, 1, 1, zero), box_at(&random, 1, 1, zero)};
  struct bvh_box given = boxes[0];
  assert_int_equal(bvh_build(&given, 1, NULL, &bvh), STATUS_OK);
  assert_int_equal(bvh.node_count, 1);
  assert_true(contains(&bvh.nodes[0], 0, &boxes[0]));
  assert_int_equal(bvh.nodes[0].child[0], BVH_LEAF);
  for (int side = 1; side < BVH_WIDTH; side++) assert_int_equal(bvh.nodes[0].child[side], 0);
  bvh_free(&bvh);
  check(boxes, 2);
}

TEST(friendly_boxes)
{
  static struct bvh_box boxes[MANY];
  struct random random = {SEED + 1};
  const double zero[3] = {0, 0, 0};
  for (size_t k = 0; k < MANY; k++) boxes[k] = box_at(&random, 1, 0.02, zero);
  const int depth = check(boxes, MANY);
  print_message("depth of %d random boxes: %d\n", MANY, depth);
  assert_true(depth < 24);
  for (size_t count = 3; count < 40; count++) check(boxes, count);
}

static double area(const struct bvh_node *node, int side)
{
  double size[3];
  for (int k = 0; k < 3; k++) size[k] = (double)node->hi[k][side] - (double)node->lo[k][side];
  return size[0] * size[1] + size[1] * size[2] + size[2] * size[0];
}

/* The expected number of boxes that a ray tries is the surface of all boxes of the tree, in units of the whole one's.
 * It depends on where ranges are divided: 15.9, or 18.9 if the smallest range is divided first. */
TEST(planes_are_the_cheapest)
{
  static struct bvh_box boxes[MANY];
  struct random random = {SEED + 4};
  const double zero[3] = {0, 0, 0};
  for (size_t k = 0; k < MANY; k++) boxes[k] = box_at(&random, 1, 0.02, zero);
  struct bvh bvh;
  assert_int_equal(bvh_build(boxes, MANY, NULL, &bvh), STATUS_OK);
  double sum = 0;
  for (size_t n = 0; n < bvh.node_count; n++)
    for (int side = 0; side < BVH_WIDTH && bvh.nodes[n].child[side] != 0; side++) sum += area(&bvh.nodes[n], side);
  sum /= 3 * 2.02 * 2.02;
  print_message("surface of all boxes of the tree: %.2f times that of the whole\n", sum);
  assert_true(sum < 17);
  bvh_free(&bvh);
}

/* The stored boxes are in single precision: at an offset of 1e6 a box is smaller than one rounding. */
TEST(rounding_goes_outwards)
{
  static struct bvh_box boxes[MANY];
  struct random random = {SEED + 2};
  static const double offsets[][3] = {
    {1e6, -1e6, 1e6}, {-1e6, 3e5, 0}, {1e300, -1e300, 1e-300}, {1e-42, -1e-44, 0}, {3e38, 3.5e38, -3.5e38}};
  for (size_t o = 0; o < sizeof offsets / sizeof *offsets; o++) {
    for (size_t k = 0; k < MANY; k++) boxes[k] = box_at(&random, 1e-3, 1e-6, offsets[o]);
    check(boxes, MANY);
  }
  for (size_t k = 0; k < MANY; k++) boxes[k] = box_at(&random, 1e-40, 1e-42, (const double[3]){0, 0, 0});
  check(boxes, MANY);
}

TEST(all_equal)
{
  static struct bvh_box boxes[MANY];
  for (size_t k = 0; k < MANY; k++) boxes[k] = (struct bvh_box){{0.1, 0.2, 0.3}, {0.4, 0.5, 0.6}};
  assert_true(check(boxes, MANY) <= 13);
  for (size_t k = 0; k < MANY; k++) boxes[k] = (struct bvh_box){{1, 1, 1}, {1, 1, 1}}; /* points */
  check(boxes, MANY);
  /* Equal centres, unlike sizes. */
  for (size_t k = 0; k < MANY; k++) {
    const double r = 1 + (double)k;
    boxes[k] = (struct bvh_box){{-r, -r, -r}, {r, r, r}};
  }
  check(boxes, MANY);
}

/* Each box is twice as far away as the one before. A plane splits one off, so the depth grows by one a box until
 * halving takes over. */
TEST(exponentially_spaced)
{
  static struct bvh_box boxes[MANY];
  static const double bases[] = {2, 1.25, 16, 0.5};
  for (size_t b = 0; b < sizeof bases / sizeof *bases; b++) {
    size_t count = 0;
    for (; count < MANY; count++) {
      const double at = pow(bases[b], (double)count);
      if (!(at < 1e150 && at > 1e-150)) break;
      boxes[count] = (struct bvh_box){{at, -at, at}, {at * 1.01, at, at}};
    }
    const int depth = check(boxes, count);
    print_message("base %g: %d boxes, depth %d\n", bases[b], (int)count, depth);
  }
  /* Doubly so: the same spacing on three axes, thousands of boxes in a few clusters. */
  for (size_t k = 0; k < MANY; k++) {
    struct bvh_box *box = &boxes[k];
    for (int a = 0; a < 3; a++)
      box->lo[a] = box->hi[a] = ldexp(1 + (double)(k % 7), (int)(k / (size_t)(a + 1) % 900) - 450);
  }
  print_message("clusters: depth %d\n", check(boxes, MANY));
}

TEST(flat_and_long_boxes)
{
  static struct bvh_box boxes[MANY];
  struct random random = {SEED + 3};
  for (size_t k = 0; k < MANY; k++) {
    const double x = random_unit(&random), y = random_unit(&random);
    boxes[k] = k % 3 == 0   ? (struct bvh_box){{x, y, 0}, {x, y, 0}}
               : k % 3 == 1 ? (struct bvh_box){{-1e30, y, x}, {1e30, y, x}}
                            : (struct bvh_box){{x, -1e200, 0}, {x, 1e200, 1e-200}};
  }
  check(boxes, MANY);
  for (size_t k = 0; k < MANY; k++) { /* as wide as a double can be */
    const double y = random_unit(&random);
    boxes[k] = (struct bvh_box){{-1.7e308, y, -y}, {1.7e308, y, y * (double)(k % 2)}};
  }
  check(boxes, MANY);
  for (size_t k = 0; k < MANY; k++) { /* centres that differ by the least possible number */
    const double x = (double)(k % 5) * 0x1p-1074;
    boxes[k] = (struct bvh_box){{x, 0, 0}, {x, 0, 0}};
  }
  check(boxes, MANY);
}
