/* Binned SAH builder (Wald 2007), iterative, with the children's boxes in the parent. Large ranges are divided in
 * rounds, each round by all threads; where nodes lie depends on the boxes only. */
#include "geometry/bvh.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>

#include "base/float_lanes.h"
#include "base/memory.h"

enum {
  BIN_COUNT = 16,
  WHOLE_COUNT = 4096 /* a range of at most this many boxes is built whole, by one thread */
};

/* Some boxes. Their subtree has the nodes from `node` on, at most node_limit(count). */
struct range {
  uint32_t first, count, depth, node;
};

/* Corners as in nodes, rounded outwards; the fourth number is 0. */
struct float_box {
  four_floats lo, hi;
};

static const struct float_box NOTHING = {{INFINITY, INFINITY, INFINITY, 0}, {-INFINITY, -INFINITY, -INFINITY, 0}};

struct builder {
  struct float_box *boxes; /* a range of them is a subtree */
  uint32_t *numbers;       /* the numbers of the caller's boxes */
  struct bvh_node *nodes;
};

/* The large ranges of a round, and those of the next one, up to BVH_WIDTH from each. */
struct round {
  const struct builder *builder;
  const struct range *ranges;
  size_t count;
  struct range *next;
  atomic_size_t taken;
};

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

static struct float_box float_box(const struct bvh_box *box)
{
  return (struct float_box){{float_below(box->lo[0]), float_below(box->lo[1]), float_below(box->lo[2])},
                            {float_above(box->hi[0]), float_above(box->hi[1]), float_above(box->hi[2])}};
}

static void box_add(struct float_box *sum, const struct float_box *box)
{
  sum->lo = four_floats_min(sum->lo, box->lo), sum->hi = four_floats_max(sum->hi, box->hi);
}

static double box_area(const struct float_box *b)
{
  const four_floats size = b->hi - b->lo;
  const double x = size[0], y = size[1], z = size[2];
  return x < 0 ? 0 : x * y + y * z + z * x;
}

static four_floats box_center(const struct float_box *b) { return 0.5f * b->lo + 0.5f * b->hi; }

static struct float_box range_box(const struct builder *b, const struct range *r)
{
  struct float_box box = NOTHING;
  for (uint32_t k = 0; k < r->count; k++) box_add(&box, &b->boxes[r->first + k]);
  return box;
}

/* The bins of centres, equally wide along each axis. */
struct bins {
  four_floats lo, scale;
  int count; /* bins along each axis; fewer for few boxes */
  struct float_box box[3][BIN_COUNT];
  uint32_t boxes[3][BIN_COUNT];
};

/* The scale may be infinite if all centres are within a subnormal distance. */
static four_mask bins_of(const struct bins *bins, const struct float_box *box)
{
  const four_floats at = (box_center(box) - bins->lo) * bins->scale, last = four_floats_all((float)(bins->count - 1));
  return __builtin_convertvector(four_floats_min(four_floats_max(at, four_floats_all(0)), last), four_mask);
}

/* The cheapest plane between an axis' bins. Lowers *cost if one is cheaper; returns whether one is. */
static bool best_plane(const struct bins *bins, int axis, uint32_t count, double *cost, int *plane)
{
  double right_area[BIN_COUNT];
  struct float_box sum = NOTHING;
  for (int k = bins->count - 1; k > 0; k--) {
    box_add(&sum, &bins->box[axis][k]);
    right_area[k] = box_area(&sum);
  }
  bool found = false;
  uint32_t left = 0;
  sum = NOTHING;
  for (int k = 1; k < bins->count; k++) {
    box_add(&sum, &bins->box[axis][k - 1]);
    left += bins->boxes[axis][k - 1];
    if (left == 0 || left == count) continue;
    const double c = box_area(&sum) * left + right_area[k] * (count - left);
    if (c < *cost) *cost = c, *plane = k, found = true;
  }
  return found;
}

/* The axis of the cheapest plane of all, or -1. */
static int best_axis(const struct builder *b, const struct range *r, struct bins *bins, int *plane)
{
  for (int a = 0; a < 3; a++)
    for (int k = 0; k < bins->count; k++) bins->box[a][k] = NOTHING, bins->boxes[a][k] = 0;
  for (uint32_t k = 0; k < r->count; k++) {
    const struct float_box *box = &b->boxes[r->first + k];
    const four_mask at = bins_of(bins, box);
    for (int a = 0; a < 3; a++) box_add(&bins->box[a][at[a]], box), bins->boxes[a][at[a]]++;
  }
  double cost = INFINITY;
  int axis = -1;
  for (int a = 0; a < 3; a++)
    if (bins->scale[a] > 0 && best_plane(bins, a, r->count, &cost, plane)) axis = a;
  return axis;
}

static void swap(const struct builder *b, uint32_t i, uint32_t j)
{
  const struct float_box box = b->boxes[i];
  const uint32_t number = b->numbers[i];
  b->boxes[i] = b->boxes[j], b->numbers[i] = b->numbers[j];
  b->boxes[j] = box, b->numbers[j] = number;
}

/* Splits the range; returns how many of its boxes go left, at least one on either side. */
static uint32_t split(const struct builder *b, const struct range *r)
{
  four_floats lo = NOTHING.lo, hi = NOTHING.hi;
  for (uint32_t k = 0; k < r->count; k++) {
    const four_floats c = box_center(&b->boxes[r->first + k]);
    lo = four_floats_min(lo, c), hi = four_floats_max(hi, c);
  }
  struct bins bins = {.lo = lo, .count = r->count < BIN_COUNT / 2 ? 2 * (int)r->count : BIN_COUNT};
  int plane = 0;
  bool apart = false;
  for (int a = 0; a < 3; a++) {
    if (!(hi[a] > lo[a])) continue;
    bins.scale[a] = (float)bins.count / (hi[a] - lo[a]), apart = true;
  }
  /* all centres in one place, or the tree grows too deep: halve, which bounds the depth */
  if (!apart || r->depth >= BVH_MAX_DEPTH / 2) return r->count / 2;
  const int axis = best_axis(b, r, &bins, &plane);
  if (axis < 0) return r->count / 2;
  uint32_t left = 0;
  for (uint32_t k = 0; k < r->count; k++)
    if (bins_of(&bins, &b->boxes[r->first + k])[axis] < plane) swap(b, r->first + k, r->first + left++);
  return left;
}

static void set_child(struct bvh_node *node, int side, const struct float_box *box)
{
  for (int k = 0; k < 3; k++) node->lo[k][side] = box->lo[k], node->hi[k][side] = box->hi[k];
}

/* A node's children. At most BVH_WIDTH boxes are a child each. A larger range is split, each time the part with the
 * largest box, until there are BVH_WIDTH parts. Returns how many there are. */
static int divide(const struct builder *b, const struct range *r, struct range out[BVH_WIDTH],
                  struct float_box box[BVH_WIDTH])
{
  if (r->count <= BVH_WIDTH) {
    for (uint32_t k = 0; k < r->count; k++)
      out[k] = (struct range){r->first + k, 1, r->depth + 1, 0}, box[k] = b->boxes[r->first + k];
    return (int)r->count;
  }
  int count = 1;
  out[0] = *r, box[0] = range_box(b, r);
  while (count < BVH_WIDTH) {
    int largest = -1;
    for (int k = 0; k < count; k++)
      if (out[k].count > 1 && (largest < 0 || box_area(&box[k]) > box_area(&box[largest]))) largest = k;
    if (largest < 0) break;
    struct range *whole = &out[largest], *right = &out[count];
    const uint32_t left = split(b, whole);
    *right = (struct range){whole->first + left, whole->count - left, whole->depth + 1, 0};
    whole->count = left, whole->depth++;
    box[largest] = range_box(b, whole), box[count] = range_box(b, right);
    count++;
  }
  return count;
}

/* No tree has more nodes than this, by induction: a node has four children, or one for each box. */
static uint32_t node_limit(uint32_t count) { return count < 2 ? 1 : (uint32_t)((2 * (uint64_t)count - 1) / 3); }

/* Makes the node of a range, and writes the ranges of its inner children to out. Their nodes are at *next: one after
 * the other, or, if `sparse`, so that each has room for its whole subtree. Returns how many there are. */
static int make_node(const struct builder *b, const struct range *r, bool sparse, uint32_t *next,
                     struct range out[BVH_WIDTH])
{
  struct range part[BVH_WIDTH];
  struct float_box box[BVH_WIDTH];
  struct bvh_node *node = &b->nodes[r->node];
  const int children = divide(b, r, part, box);
  int inner = 0;
  for (int side = 0; side < children; side++) {
    set_child(node, side, &box[side]);
    node->child[side] = part[side].count > 1 ? *next : BVH_LEAF | b->numbers[part[side].first];
    if (part[side].count == 1) continue;
    part[side].node = *next;
    *next += sparse ? node_limit(part[side].count) : 1;
    out[inner++] = part[side];
  }
  return inner;
}

static void build_whole(const struct builder *b, const struct range *root)
{
  struct range stack[BVH_STACK];
  size_t top = 0;
  uint32_t next = root->node + 1;
  stack[top++] = *root;
  while (top > 0) {
    const struct range r = stack[--top];
    top += (size_t)make_node(b, &r, false, &next, stack + top);
  }
}

static enum status build_round(void *context, size_t worker)
{
  struct round *round = context;
  (void)worker;
  for (size_t k; (k = atomic_fetch_add(&round->taken, 1)) < round->count;) {
    const struct range *range = &round->ranges[k];
    uint32_t next = range->node + 1;
    if (range->count <= WHOLE_COUNT) build_whole(round->builder, range);
    else make_node(round->builder, range, true, &next, round->next + BVH_WIDTH * k);
  }
  return STATUS_OK;
}

static enum status build(const struct builder *b, uint32_t count, const struct team *team)
{
  size_t ranges = 1;
  struct range *now = memory_alloc(1, sizeof *now);
  enum status status = now ? STATUS_OK : STATUS_LIMIT;
  if (now) now[0] = (struct range){.count = count};
  while (status == STATUS_OK && ranges > 0) {
    struct round round = {.builder = b, .ranges = now, .count = ranges};
    round.next = memory_alloc(ranges, BVH_WIDTH * sizeof *round.next);
    status = round.next ? team_run(team, ranges, build_round, &round) : STATUS_LIMIT;
    ranges = 0;
    for (size_t k = 0; status == STATUS_OK && k < BVH_WIDTH * round.count; k++)
      if (round.next[k].count > 0) round.next[ranges++] = round.next[k];
    memory_free(now);
    now = round.next;
  }
  memory_free(now);
  return status;
}

/* Stores the boxes as floats, in the same memory, and their numbers behind them. */
static void take_boxes(struct bvh_box *boxes, size_t count, struct builder *out)
{
  static_assert(sizeof *out->boxes + sizeof *out->numbers <= sizeof *boxes, "there is room");
  out->boxes = (void *)boxes, out->numbers = (void *)(out->boxes + count);
  for (size_t k = 0; k < count; k++) {
    struct bvh_box box;
    memcpy(&box, &boxes[k], sizeof box); /* for the compiler, which may assume that doubles are no floats */
    const struct float_box rounded = float_box(&box);
    memcpy(&out->boxes[k], &rounded, sizeof rounded);
  }
  for (size_t k = 0; k < count; k++) out->numbers[k] = (uint32_t)k;
}

enum status bvh_build(struct bvh_box *boxes, size_t count, const struct team *team, struct bvh *out)
{
  *out = (struct bvh){NULL, 0};
  if (count == 0) return STATUS_OK;
  if (count > INT32_MAX) return STATUS_LIMIT;
  size_t node_count = node_limit((uint32_t)count);
  struct builder b = {.nodes = memory_alloc(node_count, sizeof *b.nodes)};
  if (!b.nodes) return STATUS_LIMIT;
  take_boxes(boxes, count, &b);
  const enum status status = build(&b, (uint32_t)count, team);
  if (status != STATUS_OK) {
    memory_free(b.nodes);
    return status;
  }
  while (node_count > 1 && b.nodes[node_count - 1].child[0] == 0) node_count--;
  struct bvh_node *fewer = memory_resize(b.nodes, node_count * sizeof *b.nodes);
  *out = (struct bvh){fewer ? fewer : b.nodes, node_count};
  return STATUS_OK;
}

void bvh_free(struct bvh *bvh)
{
  memory_free(bvh->nodes);
  *bvh = (struct bvh){NULL, 0};
}
