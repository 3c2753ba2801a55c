/* Rays through the hierarchy: two packets at a time, their rays side by side as floats.
 *
 * Compiled once per instruction set; the table of this compilation is KERNEL(kernel), see names.h.
 *
 * The boxes lie in the frame (world - origin)/frame, all within about [-1,1]. A ray is looked at there by its depth:
 * the distance along its dominant axis, counted from where it enters the frame, so that few bits are enough wherever
 * it comes from. Every rounding widens the boxes: an absolute slack for the origin's, a relative one for those of
 * the distances (Ize, Robust BVH Ray Traversal, 2013).
 */
#include <math.h>
#include <string.h>

#include "base/float_lanes.h"
#include "intersect/lanes/gather.h"

#define FLOAT_ROUNDOFF 0x1p-24f

/* Growth of a depth that others are compared with: three roundings in each of the two (direction, reciprocal, sum), one
 * in the end of the ray, and those of growing. */
#define DEPTH_GROWTH (1 + 16 * FLOAT_ROUNDOFF)

/* A row of a node's planes, one for each child. */
enum { BVH_ROW = sizeof(float[BVH_WIDTH]) };

/* All rays' bits. */
#define ALL_RAYS ((1u << (FLOAT_LANES - 1) << 1) - 1)

/* All boxes, and the roundings of making them. */
#define FRAME_HALF 1.0625

/* A ray that starts farther away is moved up to the frame first; in wide arithmetic where that would lose it. */
#define FRAME_NEAR 16.0
#define FRAME_FAR 0x1p30

/* What rounding may do to the start of a ray, or to the frame's origin, on the way into the frame: of its coordinates. */
#define START_ROUNDOFF (16 * UNIT_ROUNDOFF)

/* What may be wrong with the origin besides its own roundings, relative to its size in the frame or to 1: rounding it
 * and its sum with the slack to float, its product with the reciprocal, and a box's, for the planes are that far off
 * then. */
#define ORIGIN_SLACK 0x1p-22

/* A stand-in for the reciprocal of 0: so large that all that is beyond the slack ends up beyond the frame, finite so
 * that 0 times it is 0. */
#define HUGE_INVERSE 0x1p80f

/* Where in a node the planes stand that a ray comes to first and last along each axis, in bytes. */
struct sides {
  size_t first[3], last[3];
};

/* The rays as one tree's frame sees them. A ray passes the plane x_k = c at a depth from c inverse + early to c inverse
 * + late. */
struct view {
  float_lanes inverse[3], early[3], late[3], far;
  lanes start[2], unit[2]; /* of each packet: depth = t unit - start */
  bool apart;              /* along each axis some rays go up and some down */
  bool alike;              /* all rays enter boxes by the same sides: */
  struct sides sides;
};

struct bundle {
  struct packet packet[2];
  int packets; /* 1 where a second would be empty */
  struct view view;
  unsigned live; /* bit k: ray k still looks for a hit */
};

static void bundle_update(struct bundle *b)
{
  lanes far[2];
  b->live = 0;
  for (int h = 0; h < b->packets; h++) {
    const lanes end = b->packet[h].t_far * b->view.unit[h];
    far[h] = (end - b->view.start[h]) + 8 * UNIT_ROUNDOFF * (lanes_abs(end) + lanes_abs(b->view.start[h]));
    b->live |= lanes_bits(b->packet[h].live) << h * LANES;
  }
  b->view.far = float_lanes_join(far[0], far[b->packets - 1]) * DEPTH_GROWTH;
}

/* The depth where the line of a ray enters the frame, or less. */
static lanes frame_entry(const lanes from[3], const lanes slack[3], const lanes direction[3])
{
  lanes enter = lanes_all(-INFINITY);
  for (int k = 0; k < 3; k++) {
    const lanes half = FRAME_HALF + slack[k], inverse = 1 / direction[k];
    enter = lanes_max(lanes_min((-half - from[k]) * inverse, (half - from[k]) * inverse), enter);
  }
  return enter;
}

LANES_INLINE void sides_set(struct sides *sides, int k, bool down)
{
  const size_t lo = offsetof(struct bvh_node, lo), hi = offsetof(struct bvh_node, hi), at = (size_t)k * BVH_ROW;
  sides->first[k] = (down ? hi : lo) + at, sides->last[k] = (down ? lo : hi) + at;
}

/* Out of line, for it is rare: where the rays of the lanes `far` come to the frame, as local_ray.h has it. */
__attribute__((noinline)) static void come_near(const struct packet *p, const struct model_tree *tree, lane_mask far,
                                                lanes from[3], lanes slack[3], lanes *start)
{
  for (unsigned bits = lanes_bits(far); bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    struct ray ray = {.t_min = p->t_min[l]};
    double at[3];
    for (int k = 0; k < 3; k++) ray.origin[k] = p->origin[k][l], ray.direction[k] = p->direction[k][l];
    (*start)[l] = local_ray_enter(&ray, tree->origin, tree->frame, at);
    /* the ray is where it should be, but the frame's origin is rounded */
    for (int k = 0; k < 3; k++) from[k][l] = at[k], slack[k][l] = START_ROUNDOFF * fabs(tree->origin[k]) / tree->frame;
  }
}

/* `packets`: the bundle's. */
LANES_INLINE void view_set(struct bundle *b, const struct model_tree *tree, int packets)
{
  b->view.alike = b->view.apart = true;
  const double to_frame = 1 / tree->frame; /* a power of two */
  lanes low[3][2], high[3][2], along[3][2];
  const int last = packets - 1;
  for (int h = 0; h <= last; h++) {
    const struct packet *p = &b->packet[h];
    const lanes shrink = 1 / p->longest;
    lanes from[3], slack[3], direction[3], farthest = {0};
    for (int k = 0; k < 3; k++) {
      along[k][h] = direction[k] = p->direction[k] * shrink;
      from[k] = (p->origin[k] - tree->origin[k]) * to_frame;
      slack[k] = START_ROUNDOFF * (lanes_abs(p->origin[k]) + fabs(tree->origin[k])) * to_frame;
      farthest = lanes_max(lanes_abs(from[k]), farthest);
    }
    b->view.unit[h] = p->longest * to_frame;
    /* No ray is in the frame before this depth: its dominant coordinate is outside. */
    lanes start = lanes_max(p->t_min * b->view.unit[h], -(farthest + 2));
    if (lanes_any(farthest > FRAME_NEAR)) start = lanes_max(frame_entry(from, slack, direction), start);
    for (int k = 0; k < 3; k++) from[k] += start * direction[k], slack[k] += 8 * UNIT_ROUNDOFF * lanes_abs(start);
    const lane_mask far = ~(farthest <= FRAME_FAR);
    if (lanes_any(far)) come_near(p, tree, far, from, slack, &start);
    b->view.start[h] = start;
    for (int k = 0; k < 3; k++) {
      slack[k] += ORIGIN_SLACK * (1 + lanes_abs(from[k]));
      low[k][h] = from[k] + slack[k], high[k][h] = from[k] - slack[k];
    }
  }
  for (int k = 0; k < 3; k++) {
    const float_lanes d = float_lanes_join(along[k][0], along[k][last]);
    const float_lanes huge = float_lanes_select(d < 0, float_lanes_all(-HUGE_INVERSE), float_lanes_all(HUGE_INVERSE));
    const float_lanes inverse = float_lanes_select(float_lanes_abs(d) > 1 / HUGE_INVERSE, 1 / d, huge);
    const float_lanes to_low = float_lanes_join(low[k][0], low[k][last]) * -inverse;
    const float_lanes to_high = float_lanes_join(high[k][0], high[k][last]) * -inverse;
    const unsigned down = float_lanes_bits(d < 0);
    b->view.inverse[k] = inverse;
    b->view.early[k] = float_lanes_min(to_low, to_high), b->view.late[k] = float_lanes_max(to_low, to_high);
    const bool same = down == 0 || down == ALL_RAYS;
    b->view.alike &= same, b->view.apart &= !same;
    sides_set(&b->view.sides, k, down != 0);
  }
}

/* Twice in the code, so that one packet costs no second one. */
static void bundle_start(struct bundle *b, const struct model_tree *tree)
{
  if (b->packets == 1) view_set(b, tree, 1);
  else view_set(b, tree, 2);
  bundle_update(b);
}

/* A row of four planes of a node. */
LANES_INLINE const float *node_row(const struct bvh_node *node, size_t at)
{
  return (const float *)(const void *)((const char *)node + at);
}

/* What the rays make of a node: where they enter its children, and their bits where they pass one before their ends. */
struct entries {
  float_lanes near[BVH_WIDTH];
  unsigned rays[BVH_WIDTH];
};

/* `alike`: the view's. */
LANES_INLINE void bundle_boxes(const struct view *view, const struct bvh_node *node, bool alike, struct entries *out)
{
  float_lanes near[BVH_WIDTH], far[BVH_WIDTH];
  for (int k = 0; k < 3; k++) {
    const float_lanes inverse = view->inverse[k], early = view->early[k], late = view->late[k];
    const float *first = alike ? node_row(node, view->sides.first[k]) : node->lo[k];
    const float *last = alike ? node_row(node, view->sides.last[k]) : node->hi[k];
#pragma GCC unroll 4
    for (int side = 0; side < BVH_WIDTH; side++) {
      const float_lanes one = first[side] * inverse, other = last[side] * inverse;
      const float_lanes enter = (alike ? one : float_lanes_min(one, other)) + early;
      const float_lanes leave = (alike ? other : float_lanes_max(one, other)) + late;
      near[side] = float_lanes_max(enter, k > 0 ? near[side] : float_lanes_all(0));
      far[side] = float_lanes_min(leave, k > 0 ? far[side] : view->far);
    }
  }
#pragma GCC unroll 4
  for (int side = 0; side < BVH_WIDTH; side++) {
    out->near[side] = near[side];
    out->rays[side] = float_lanes_up_to(near[side], far[side] * DEPTH_GROWTH);
  }
}

/* Out of line, or the compiler takes the products that both forms have in front of them, and fuses none. */
__attribute__((noinline)) static void bundle_boxes_any(const struct view *view, const struct bvh_node *node,
                                                       struct entries *out)
{
  bundle_boxes(view, node, false, out);
}

static void bundle_walk(struct bundle *b, const struct model_tree *tree, unsigned rays);

static void bundle_copy(struct bundle *b, const struct model_copy *copy, unsigned active)
{
  struct bundle inner;
  inner.packets = b->packets;
  for (int h = 0; h < b->packets; h++)
    packet_enter(&b->packet[h], copy, lanes_mask(active >> h * LANES), &inner.packet[h]);
  bundle_start(&inner, &copy->object->model->tree);
  bundle_walk(&inner, &copy->object->model->tree, inner.live);
  for (int h = 0; h < b->packets; h++) packet_leave(&inner.packet[h]);
}

/* The same rays in the frame of a tree in a tree. */
static void bundle_inner(struct bundle *b, const struct model_tree *inner, unsigned active)
{
  const struct view outer = b->view;
  bundle_start(b, inner);
  bundle_walk(b, inner, active & b->live);
  b->view = outer;
  bundle_update(b);
}

/* Whether all in that box lies exactly on what stands before it in the scene, whose hit is the nearest then. */
LANES_INLINE bool lies_again(const struct packet *p, uint32_t index)
{
  const struct model *model = p->model;
  if (!model->again || p->gather) return false;
  if (index >= model->leaf_count) return model->copies[index - model->leaf_count].again;
  return model->again[model->leaves ? model->leaves[index].patch : model->places[index].patch];
}

/* Tries what box `index` of the tree stands for. */
static void bundle_leaf(struct bundle *b, const struct model_tree *tree, uint32_t index, unsigned active)
{
  const struct model *model = b->packet[0].model;
  const unsigned all = (1u << LANES) - 1;
  if (index == MODEL_INNER) {
    bundle_inner(b, tree->inner, active);
  } else if (lies_again(&b->packet[0], index)) {
    return;
  } else if (index >= model->leaf_count) {
    bundle_copy(b, &model->copies[index - model->leaf_count], active);
  } else {
    if (active & all) packet_leaf(&b->packet[0], index, lanes_mask(active & all));
    if (active >> LANES) packet_leaf(&b->packet[1], index, lanes_mask(active >> LANES));
  }
  bool moved = false;
  for (int h = 0; h < b->packets; h++) moved |= b->packet[h].moved, b->packet[h].moved = false;
  if (moved) bundle_update(b);
}

/* One ray as the frame sees it, four times over. */
struct ray_view {
  four_floats inverse[3], early[3], late[3];
  struct sides sides;
};

LANES_INLINE struct ray_view ray_view_of(const struct view *view, unsigned lane)
{
  struct ray_view ray;
  for (int k = 0; k < 3; k++) {
    ray.inverse[k] = four_floats_all(view->inverse[k][lane]);
    ray.early[k] = four_floats_all(view->early[k][lane]), ray.late[k] = four_floats_all(view->late[k][lane]);
    sides_set(&ray.sides, k, view->inverse[k][lane] < 0);
  }
  return ray;
}

/* The node's children that the ray passes before `end`, as bits; as bundle_boxes. */
LANES_INLINE unsigned ray_boxes(const struct ray_view *ray, float end, const struct bvh_node *node, float out_near[4])
{
  four_floats near = four_floats_all(0), far = four_floats_all(end), first, last;
  four_mask child;
  for (int k = 0; k < 3; k++) {
    memcpy(&first, node_row(node, ray->sides.first[k]), sizeof first);
    memcpy(&last, node_row(node, ray->sides.last[k]), sizeof last);
    near = four_floats_max(first * ray->inverse[k] + ray->early[k], near);
    far = four_floats_min(last * ray->inverse[k] + ray->late[k], far);
  }
  memcpy(&child, node->child, sizeof child), memcpy(out_near, &near, sizeof near);
  return four_mask_bits((near <= far * DEPTH_GROWTH) & (child != 0));
}

/* What is on the stack is wanted soon, and the rays of a large scene come by other boxes than those before them: it is
 * brought from memory meanwhile, of a leaf what its first stage reads. */
LANES_INLINE void fetch_child(const struct model *model, const struct bvh *bvh, uint32_t child)
{
  const uint32_t box = child & ~(uint32_t)BVH_LEAF;
  if (child == box) {
    __builtin_prefetch(&bvh->nodes[child]);
    __builtin_prefetch(&bvh->nodes[child].child);
  } else if (model->leaves && box < model->leaf_count) {
    const struct leaf *leaf = &model->leaves[box];
    __builtin_prefetch(&leaf->slabs);
    __builtin_prefetch(&leaf->slabs.offset);
    __builtin_prefetch(&leaf->patch);
  }
}

/* One ray on its way through what is below some node. */
struct ray_way {
  struct ray_view ray;
  unsigned lane;
  uint32_t child; /* where it is */
  size_t top;
  struct {
    float near;
    uint32_t child;
  } stack[BVH_STACK];
};

/* Four boxes at a time instead of all rays. Returns whether the ray goes on. */
LANES_INLINE bool ray_step(struct bundle *b, const struct model_tree *tree, struct ray_way *way)
{
  if (way->child & (uint32_t)BVH_LEAF) {
    bundle_leaf(b, tree, way->child & ~(uint32_t)BVH_LEAF, 1u << way->lane);
    if (!(b->live >> way->lane & 1)) return false;
  } else {
    const struct bvh_node *node = &tree->bvh.nodes[way->child];
    const size_t first = way->top;
    float near[BVH_WIDTH];
    for (unsigned bits = ray_boxes(&way->ray, b->view.far[way->lane], node, near); bits; bits &= bits - 1) {
      const int side = __builtin_ctz(bits);
      size_t n = way->top++; /* the nearest on top */
      for (; n > first && way->stack[n - 1].near < near[side]; n--) way->stack[n] = way->stack[n - 1];
      way->stack[n].near = near[side], way->stack[n].child = node->child[side];
      fetch_child(b->packet[0].model, &tree->bvh, node->child[side]);
    }
  }
  do {
    if (way->top == 0) return false;
    way->top--;
  } while (way->stack[way->top].near > b->view.far[way->lane]);
  way->child = way->stack[way->top].child;
  return true;
}

LANES_INLINE void ray_begin(const struct bundle *b, uint32_t child, unsigned lane, struct ray_way *way)
{
  way->ray = ray_view_of(&b->view, lane), way->lane = lane, way->child = child, way->top = 0;
}

/* One ray through what is below `child`. */
static void ray_walk(struct bundle *b, const struct model_tree *tree, uint32_t child, unsigned lane)
{
  struct ray_way way;
  ray_begin(b, child, lane, &way);
  while (ray_step(b, tree, &way)) continue;
}

/* The rays through all of the tree, a step of each in turn: where one goes next is brought from memory while the others
 * take their steps. Out of line for the room it takes. */
__attribute__((noinline)) static void rays_walk(struct bundle *b, const struct model_tree *tree, unsigned rays)
{
  struct ray_way ways[FLOAT_LANES];
  for (unsigned bits = rays; bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    ray_begin(b, 0, lane, &ways[lane]);
  }
  while (rays)
    for (unsigned bits = rays; bits; bits &= bits - 1)
      if (!ray_step(b, tree, &ways[__builtin_ctz(bits)])) rays &= ~(bits & -bits);
}

/* So few rays go their ways one by one: four boxes for one of them are a third of the work of four boxes for all. */
enum { FEW_TOGETHER = 3 };

/* So many leaves, of some 1.1 KB each, are in no processor's own caches. Where the rays have nothing in common there,
 * waiting for memory is more than what they could share. */
enum { MANY_LEAVES = 1 << 14 };

static bool rays_apart(const struct bundle *b)
{
  const struct model *model = b->packet[0].model;
  return b->view.apart && model->leaves && model->leaf_count >= MANY_LEAVES && !b->packet[0].tracer->warm;
}

static void bundle_walk(struct bundle *b, const struct model_tree *tree, unsigned rays)
{
  const struct bvh *bvh = &tree->bvh;
  struct {
    float_lanes near;
    float first;   /* where the first of the rays enters */
    unsigned rays; /* a leaf's test on one ray must not depend on its neighbours, so each ray goes its own way */
    uint32_t child;
  } stack[BVH_STACK];
  size_t top = 0;
  if (bvh->node_count == 0) return;
  if (rays_apart(b)) {
    rays_walk(b, tree, rays);
    return;
  }
  const int few = b->packet[0].tracer->warm ? 1 : FEW_TOGETHER; /* warm starts go from ray to ray, all together */
  uint32_t child = 0;
  for (;;) {
    if (child & (uint32_t)BVH_LEAF) {
      bundle_leaf(b, tree, child & ~(uint32_t)BVH_LEAF, rays);
    } else if (__builtin_popcount(rays) <= few) {
      for (unsigned bits = rays; bits; bits &= bits - 1) ray_walk(b, tree, child, (unsigned)__builtin_ctz(bits));
    } else {
      const struct bvh_node *node = &bvh->nodes[child];
      const size_t first = top;
      struct entries in;
      if (b->view.alike) bundle_boxes(&b->view, node, true, &in);
      else bundle_boxes_any(&b->view, node, &in);
      for (int side = 0; side < BVH_WIDTH && node->child[side] != 0; side++) {
        const unsigned hit = rays & in.rays[side];
        if (!hit) continue;
        const float enter = in.near[side][__builtin_ctz(hit)];
        size_t n = top++; /* the nearest on top */
        for (; n > first && stack[n - 1].first < enter; n--) stack[n] = stack[n - 1];
        stack[n].near = in.near[side], stack[n].first = enter, stack[n].rays = hit, stack[n].child = node->child[side];
        fetch_child(b->packet[0].model, bvh, node->child[side]);
      }
    }
    do {
      if (top == 0) return;
      top--;
      rays = stack[top].rays & b->live & float_lanes_up_to(stack[top].near, b->view.far);
    } while (rays == 0);
    child = stack[top].child;
  }
}

/* ---- the face ---- */

static void bundle_begin(struct bundle *b, struct ready ready[2], struct tracer *tracer, size_t count,
                         const struct ray rays[], bool any)
{
  b->packets = count > LANES ? 2 : 1;
  for (size_t h = 0, first = 0; h < (size_t)b->packets; h++, first += LANES) {
    const size_t left = count - first;
    packet_begin(&b->packet[h], &ready[h], tracer, left < LANES ? left : LANES, rays + first, any);
  }
  bundle_start(b, &tracer->model->tree);
}

static void closest(struct tracer *tracer, size_t count, const struct ray rays[], struct hit out_hits[])
{
  for (size_t first = 0; first < count; first += FLOAT_LANES) {
    struct ready ready[2];
    struct bundle bundle;
    bundle_begin(&bundle, ready, tracer, count - first, rays + first, false);
    bundle_walk(&bundle, &tracer->model->tree, bundle.live);
    for (size_t h = 0; h < (size_t)bundle.packets; h++) {
      struct packet *packet = &bundle.packet[h];
      struct hit *hits = out_hits + first + h * LANES;
      unsigned grazing = finish_hits(packet, hits);
      for (size_t l = 0; l < packet->count && ready[h].copied; l++)
        if (hits[l].patch != HIT_NONE) grazing += hit_scale_back(&hits[l], &packet->rays[l], ready[h].exponent[l]);
      tracer->counts.grazing += grazing, tracer->counts.certain += packet->count - grazing;
      tracer->counts.rays[0] += packet->count;
    }
  }
}

static void occluded(struct tracer *tracer, size_t count, const struct ray rays[], bool out_occluded[])
{
  for (size_t first = 0; first < count; first += FLOAT_LANES) {
    struct ready ready[2];
    struct bundle bundle;
    bundle_begin(&bundle, ready, tracer, count - first, rays + first, true);
    bundle_walk(&bundle, &tracer->model->tree, bundle.live);
    for (size_t h = 0; h < (size_t)bundle.packets; h++) {
      const struct packet *packet = &bundle.packet[h];
      const unsigned hit = finish_occluded(packet);
      for (size_t l = 0; l < packet->count; l++) out_occluded[first + h * LANES + l] = hit >> l & 1;
      tracer->counts.rays[1] += packet->count;
    }
  }
}

/* The lists' hits are where they are in tracer->hits only when all of them are there. */
static bool all(struct tracer *tracer, size_t count, const struct ray rays[], struct hit_list out[])
{
  bool done = true;
  tracer->hits.count = 0;
  for (size_t first = 0; first < count; first += FLOAT_LANES) {
    struct ready ready[2];
    struct bundle bundle;
    bundle_begin(&bundle, ready, tracer, count - first, rays + first, false);
    for (int h = 0; h < bundle.packets; h++) gather_start(&bundle.packet[h], &tracer->gather[h]);
    bundle_walk(&bundle, &tracer->model->tree, bundle.live);
    for (size_t h = 0; h < (size_t)bundle.packets; h++) {
      struct packet *packet = &bundle.packet[h];
      done &= gather_finish(packet, ready[h].copied ? ready[h].exponent : NULL, out + first + h * LANES);
      tracer->counts.rays[0] += packet->count;
    }
  }
  const struct hit *hits = tracer->hits.at;
  for (size_t k = 0; k < count && done; k++) {
    out[k].hits = hits, hits += out[k].count;
    ++*(out[k].certainty == CERTAINTY_CERTAIN ? &tracer->counts.certain : &tracer->counts.grazing);
  }
  return done;
}

const struct kernel KERNEL(kernel) = {KERNEL_NAME, closest, occluded, all};
