/* Binned SAH builder (Wald 2007), iterative, children's boxes stored in the parent. Large ranges are divided round by
 * round, those of a round by all threads; where nodes lie depends on the boxes only. */
#include "geometry/bvh.h"

#include <stdatomic.h>
#include <stdbool.h>

#include "base/memory.h"

enum {
  BIN_COUNT = 16,
  WHOLE_COUNT = 4096 /* a range of no more boxes is built as a whole, by one thread */
};

/* Some boxes, whose subtree has the nodes from `node` on, node_limit(count) at most. */
struct range {
  uint32_t first, count, depth, node;
};

struct builder {
  const struct bvh_box *boxes;
  uint32_t *order; /* box indices; a range of it is a subtree */
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
  struct bvh_box box = BVH_EMPTY;
  for (uint32_t k = 0; k < count; k++) bvh_box_add(&box, &b->boxes[b->order[first + k]]);
  return box;
}

/* The scale may be infinite where all centres are within a subnormal distance. */
static int bin_of(double center, double lo, double scale)
{
  const double bin = (center - lo) * scale;
  return !(bin > 0) ? 0 : bin >= BIN_COUNT ? BIN_COUNT - 1 : (int)bin;
}

/* The boxes of a range by where their centres lie along an axis. */
struct bins {
  double lo, scale;
  struct bvh_box box[BIN_COUNT];
  uint32_t count[BIN_COUNT];
};

/* The cheapest of the BIN_COUNT - 1 planes; *cost is lowered where one beats it. Returns whether one did. */
static bool best_plane(const struct bins *bins, uint32_t count, double *cost, int *plane)
{
  double right_area[BIN_COUNT];
  struct bvh_box sum = BVH_EMPTY;
  for (int k = BIN_COUNT - 1; k > 0; k--) {
    bvh_box_add(&sum, &bins->box[k]);
    right_area[k] = box_area(&sum);
  }
  bool found = false;
  uint32_t left = 0;
  sum = BVH_EMPTY;
  for (int k = 1; k < BIN_COUNT; k++) {
    bvh_box_add(&sum, &bins->box[k - 1]);
    left += bins->count[k - 1];
    if (left == 0 || left == count) continue;
    const double c = box_area(&sum) * left + right_area[k] * (count - left);
    if (c < *cost) *cost = c, *plane = k, found = true;
  }
  return found;
}

/* The axis of the cheapest plane of all, or -1. */
static int best_axis(const struct builder *b, const struct range *r, struct bins bins[3], int *plane)
{
  for (int a = 0; a < 3; a++)
    for (int k = 0; k < BIN_COUNT; k++) bins[a].box[k] = BVH_EMPTY, bins[a].count[k] = 0;
  for (uint32_t k = 0; k < r->count; k++) {
    const struct bvh_box *box = &b->boxes[b->order[r->first + k]];
    for (int a = 0; a < 3; a++) {
      const int at = bin_of(box_center(box, a), bins[a].lo, bins[a].scale);
      bvh_box_add(&bins[a].box[at], box);
      bins[a].count[at]++;
    }
  }
  double cost = INFINITY;
  int axis = -1;
  for (int a = 0; a < 3; a++)
    if (bins[a].scale > 0 && best_plane(&bins[a], r->count, &cost, plane)) axis = a;
  return axis;
}

static void swap(uint32_t *a, uint32_t *b)
{
  const uint32_t c = *a;
  *a = *b, *b = c;
}

/* Splits the range; returns how many of its boxes go left, at least one on either side. */
static uint32_t split(const struct builder *b, const struct range *r)
{
  double lo[3], hi[3];
  uint32_t *order = b->order + r->first;
  for (int a = 0; a < 3; a++) lo[a] = INFINITY, hi[a] = -INFINITY;
  for (uint32_t k = 0; k < r->count; k++) {
    for (int a = 0; a < 3; a++) {
      const double c = box_center(&b->boxes[order[k]], a);
      lo[a] = real_min(lo[a], c), hi[a] = real_max(hi[a], c);
    }
  }
  int axis = -1, plane = 0;
  struct bins bins[3];
  for (int a = 2; a >= 0; a--) {
    bins[a].lo = lo[a], bins[a].scale = hi[a] > lo[a] ? BIN_COUNT / (hi[a] - lo[a]) : 0;
    if (hi[a] > lo[a]) axis = a;
  }
  /* all centres in one place, or the tree grows too deep: halve, which bounds the depth */
  if (axis < 0 || r->depth >= BVH_MAX_DEPTH / 2) return r->count / 2;
  if (r->count == 2) { /* all planes between the two are one */
    if (box_center(&b->boxes[order[0]], axis) > box_center(&b->boxes[order[1]], axis)) swap(&order[0], &order[1]);
    return 1;
  }
  axis = best_axis(b, r, bins, &plane);
  if (axis < 0) return r->count / 2;
  uint32_t left = 0;
  for (uint32_t k = 0; k < r->count; k++)
    if (bin_of(box_center(&b->boxes[order[k]], axis), bins[axis].lo, bins[axis].scale) < plane)
      swap(&order[k], &order[left++]);
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
    *right = (struct range){whole->first + left, whole->count - left, whole->depth + 1, 0};
    whole->count = left, whole->depth++;
    box[largest] = range_box(b, whole->first, whole->count), box[count] = range_box(b, right->first, right->count);
    count++;
  }
  return count;
}

/* With four children, or one for each box: by induction no more nodes than this. */
static uint32_t node_limit(uint32_t count) { return count < 2 ? 1 : (uint32_t)((2 * (uint64_t)count - 1) / 3); }

/* Makes the node of a range; the ranges of its inner children are written to out, and have their nodes at *next, where
 * `sparse` is false one after the other, else so that each has room for all. Returns how many. */
static int make_node(const struct builder *b, const struct range *r, bool sparse, uint32_t *next,
                     struct range out[BVH_WIDTH])
{
  struct range part[BVH_WIDTH];
  struct bvh_box box[BVH_WIDTH];
  struct bvh_node *node = &b->nodes[r->node];
  const int children = divide(b, r, part, box);
  int inner = 0;
  for (int side = 0; side < children; side++) {
    set_child(node, side, &box[side]);
    node->child[side] = part[side].count > 1 ? *next : (uint32_t)BVH_LEAF | b->order[part[side].first];
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

enum status bvh_build(const struct bvh_box *boxes, size_t count, const struct team *team, struct bvh *out)
{
  *out = (struct bvh){NULL, 0};
  if (count == 0) return STATUS_OK;
  if (count > INT32_MAX) return STATUS_LIMIT;
  struct builder b = {boxes, NULL, NULL};
  enum status status = STATUS_LIMIT;
  b.order = memory_alloc(count, sizeof *b.order);
  size_t node_count = node_limit((uint32_t)count);
  b.nodes = memory_alloc(node_count, sizeof *b.nodes);
  if (!b.order || !b.nodes) goto done;
  for (size_t k = 0; k < count; k++) b.order[k] = (uint32_t)k;
  status = build(&b, (uint32_t)count, team);
  if (status != STATUS_OK) goto done;
  while (node_count > 1 && b.nodes[node_count - 1].child[0] == 0) node_count--;
  struct bvh_node *fewer = memory_resize(b.nodes, node_count * sizeof *b.nodes);
  *out = (struct bvh){fewer ? fewer : b.nodes, node_count};
  b.nodes = NULL;
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
