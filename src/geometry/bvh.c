/* Binned SAH builder (Wald 2007), iterative, children's boxes stored in the parent. */
#include "geometry/bvh.h"

#include <math.h>
#include <stdbool.h>

#include "base/memory.h"
#include "base/real.h"

enum { BIN_COUNT = 16 };

struct range {
  uint32_t first, count, depth;
  uint32_t *link; /* where the parent wants the child's name */
};

struct builder {
  const struct bvh_box *boxes;
  uint32_t *order; /* box indices; a range of it is a subtree */
  struct bvh_node *nodes;
  size_t node_count;
};

static const struct bvh_box empty_box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

static void box_add(struct bvh_box *a, const struct bvh_box *b)
{
  for (int k = 0; k < 3; k++) {
    a->lo[k] = real_min(a->lo[k], b->lo[k]);
    a->hi[k] = real_max(a->hi[k], b->hi[k]);
  }
}

static double box_area(const struct bvh_box *b)
{
  const double x = b->hi[0] - b->lo[0], y = b->hi[1] - b->lo[1], z = b->hi[2] - b->lo[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

static double box_center(const struct bvh_box *b, int axis) { return 0.5 * b->lo[axis] + 0.5 * b->hi[axis]; }

static float float_below(double x)
{
  const float f = (float)x;
  return (double)f > x ? nextafterf(f, -INFINITY) : f;
}

static float float_above(double x)
{
  const float f = (float)x;
  return (double)f < x ? nextafterf(f, INFINITY) : f;
}

static struct bvh_box range_box(const struct builder *b, uint32_t first, uint32_t count)
{
  struct bvh_box box = empty_box;
  for (uint32_t k = 0; k < count; k++) box_add(&box, &b->boxes[b->order[first + k]]);
  return box;
}

/* The scale may be infinite where all centres are within a subnormal distance. */
static int bin_of(double center, double lo, double scale)
{
  const double bin = (center - lo) * scale;
  return !(bin > 0) ? 0 : bin >= BIN_COUNT ? BIN_COUNT - 1 : (int)bin;
}

/* The cheapest of the BIN_COUNT - 1 planes along `axis`; *cost is lowered where one beats it. Returns whether one
 * did. */
static bool best_plane(const struct builder *b, const struct range *r, int axis, double lo, double scale, double *cost,
                       int *plane)
{
  struct bvh_box bin[BIN_COUNT];
  uint32_t count[BIN_COUNT] = {0};
  for (int k = 0; k < BIN_COUNT; k++) bin[k] = empty_box;
  for (uint32_t k = 0; k < r->count; k++) {
    const struct bvh_box *box = &b->boxes[b->order[r->first + k]];
    const int at = bin_of(box_center(box, axis), lo, scale);
    box_add(&bin[at], box);
    count[at]++;
  }
  double right_area[BIN_COUNT];
  struct bvh_box sum = empty_box;
  for (int k = BIN_COUNT - 1; k > 0; k--) {
    box_add(&sum, &bin[k]);
    right_area[k] = box_area(&sum);
  }
  bool found = false;
  uint32_t left = 0;
  sum = empty_box;
  for (int k = 1; k < BIN_COUNT; k++) {
    box_add(&sum, &bin[k - 1]);
    left += count[k - 1];
    if (left == 0 || left == r->count) continue;
    const double c = box_area(&sum) * left + right_area[k] * (r->count - left);
    if (c < *cost) *cost = c, *plane = k, found = true;
  }
  return found;
}

/* Splits the range; returns how many of its boxes go left, at least one on either side. */
static uint32_t split(const struct builder *b, const struct range *r)
{
  double lo[3], hi[3], cost = INFINITY;
  for (int a = 0; a < 3; a++) lo[a] = INFINITY, hi[a] = -INFINITY;
  for (uint32_t k = 0; k < r->count; k++) {
    for (int a = 0; a < 3; a++) {
      const double c = box_center(&b->boxes[b->order[r->first + k]], a);
      lo[a] = real_min(lo[a], c), hi[a] = real_max(hi[a], c);
    }
  }
  int axis = -1, plane = 0;
  if (r->depth < BVH_MAX_DEPTH / 2) {
    for (int a = 0; a < 3; a++)
      if (hi[a] > lo[a] && best_plane(b, r, a, lo[a], BIN_COUNT / (hi[a] - lo[a]), &cost, &plane)) axis = a;
  }
  /* all centres in one place, or the tree grows too deep: halve, which bounds the depth */
  if (axis < 0) return r->count / 2;
  const double scale = BIN_COUNT / (hi[axis] - lo[axis]);
  uint32_t left = 0;
  for (uint32_t k = 0; k < r->count; k++) {
    uint32_t *here = &b->order[r->first + k];
    if (bin_of(box_center(&b->boxes[*here], axis), lo[axis], scale) >= plane) continue;
    const uint32_t swap = *here;
    *here = b->order[r->first + left];
    b->order[r->first + left++] = swap;
  }
  return left;
}

static void set_child(struct bvh_node *node, int side, const struct bvh_box *box)
{
  for (int k = 0; k < 3; k++) {
    node->lo[k][side] = float_below(box->lo[k]);
    node->hi[k][side] = float_above(box->hi[k]);
  }
}

/* A node's children: the range, halved until they are BVH_WIDTH, each time the one with the largest box. Returns how
 * many there are. */
static int divide(const struct builder *b, const struct range *r, struct range out[BVH_WIDTH],
                  struct bvh_box box[BVH_WIDTH])
{
  int count = 1;
  out[0] = *r, box[0] = range_box(b, r->first, r->count);
  while (count < BVH_WIDTH) {
    int largest = -1;
    for (int k = 0; k < count; k++)
      if (out[k].count > 1 && (largest < 0 || box_area(&box[k]) > box_area(&box[largest]))) largest = k;
    if (largest < 0) break;
    struct range *whole = &out[largest], *right = &out[count];
    const uint32_t left = split(b, whole);
    *right = (struct range){whole->first + left, whole->count - left, whole->depth + 1, NULL};
    whole->count = left, whole->depth++;
    box[largest] = range_box(b, whole->first, whole->count), box[count] = range_box(b, right->first, right->count);
    count++;
  }
  return count;
}

static void build(struct builder *b, uint32_t count)
{
  struct range stack[BVH_STACK];
  size_t top = 0;
  uint32_t root_link;
  stack[top++] = (struct range){0, count, 0, &root_link};
  while (top > 0) {
    const struct range r = stack[--top];
    struct bvh_node *node = &b->nodes[b->node_count];
    *r.link = (uint32_t)b->node_count++;
    *node = (struct bvh_node){.child = {0}};
    struct range part[BVH_WIDTH];
    struct bvh_box box[BVH_WIDTH];
    const int children = divide(b, &r, part, box);
    for (int side = 0; side < children; side++) {
      set_child(node, side, &box[side]);
      part[side].link = &node->child[side];
      if (part[side].count > 1) stack[top++] = part[side];
      else node->child[side] = (uint32_t)BVH_LEAF | b->order[part[side].first];
    }
  }
}

enum status bvh_build(const struct bvh_box *boxes, size_t count, struct bvh *out)
{
  *out = (struct bvh){NULL, 0};
  if (count == 0) return STATUS_OK;
  if (count > INT32_MAX) return STATUS_LIMIT;
  struct builder b = {boxes, NULL, NULL, 0};
  enum status status = STATUS_LIMIT;
  b.order = memory_alloc(count, sizeof *b.order);
  b.nodes = memory_alloc(count, sizeof *b.nodes);
  if (!b.order || !b.nodes) goto done;
  for (size_t k = 0; k < count; k++) b.order[k] = (uint32_t)k;
  build(&b, (uint32_t)count);
  struct bvh_node *fewer = memory_resize(b.nodes, b.node_count * sizeof *b.nodes);
  *out = (struct bvh){fewer ? fewer : b.nodes, b.node_count};
  b.nodes = NULL;
  status = STATUS_OK;
done:
  memory_free(b.order);
  memory_free(b.nodes);
  return status;
}

void bvh_free(struct bvh *bvh)
{
  memory_free(bvh->nodes);
  *bvh = (struct bvh){NULL, 0};
}
