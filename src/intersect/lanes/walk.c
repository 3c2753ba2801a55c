/* Rays through the hierarchy: some packets at a time, their rays side by side as floats.
 *
 * The entry points at the end of the file pass a bundle of packets to bundle_walk. It chooses one of three ways through
 * a tree: together_walk (all rays on a node's boxes at once, until few are left), rays_walk (each ray by itself, one
 * step in turn, in large scenes) or ray_walk (one ray to its end). All of them call bundle_leaf with what a box stands
 * for: a leaf, which packet_leaf (candidate.c) tries, a copy, or a tree in a frame of its own, which leads to
 * bundle_walk again.
 *
 * Compiled once per instruction set; the table of this compilation is KERNEL(kernel), see names.h.
 */
#include "intersect/lanes/bundle.h"

static void bundle_walk(struct bundle *b, const struct model_tree *tree, unsigned rays);
static void bundle_walk_all(struct bundle *b, const struct model *model);

/* Walks a copy with those packets that have rays there. */
static void bundle_copy(struct bundle *b, const struct model_copy *copy, unsigned active)
{
  struct bundle inner;
  inner.packets = 0;
  for (struct packet *p = b->packet; active; p++, active >>= LANES)
    if (active & ALL_LANES) packet_enter(p, copy, lanes_mask(active & ALL_LANES), &inner.packet[inner.packets++]);
  inner.defers = b->packet[0].any, inner.later.count = 0;
  bundle_start(&inner, &copy->object->model->tree);
  bundle_walk_all(&inner, copy->object->model);
  for (int h = 0; h < inner.packets; h++) packet_leave(&inner.packet[h]);
}

/* Walks an inner tree with the same rays, in its frame. */
static void bundle_inner(struct bundle *b, const struct model_tree *inner, unsigned active)
{
  const struct view outer = b->view;
  bundle_start(b, inner);
  bundle_walk(b, inner, active & b->live);
  b->view = outer;
  bundle_update(b);
}

/* Those of the rays that may be in box `index` of the tree: if that is a leaf's, in the box along the leaf. */
LANES_INLINE unsigned box_passed(const struct bundle *b, uint32_t index, unsigned rays)
{
  const struct model *model = b->packet[0].model;
  if (index >= model->leaf_count) return rays;
  const struct oriented_box *box = &model->oriented[index];
  if (rays & (rays - 1)) return rays & view_oriented(&b->view, box);
  return view_oriented_one(&b->view, (unsigned)__builtin_ctz(rays), box) ? rays : 0;
}

static void bundle_try(struct bundle *b, uint32_t index, struct leaf *leaf, const struct model_patch *patch,
                       unsigned active)
{
  for (struct packet *p = b->packet; active; p++, active >>= LANES)
    if (active & ALL_LANES) packet_leaf(p, leaf, patch, index, lanes_mask(active & ALL_LANES));
}

/* Tries a leaf that is not kept. Out of line because of the stack that it takes. */
__attribute__((noinline)) static void bundle_make(struct bundle *b, uint32_t index, unsigned active)
{
  struct leaf_room room;
  for (int h = 0; h < b->packets; h++) packet_charge(&b->packet[h], lanes_mask(active >> h * LANES) & COST_MADE);
  struct leaf_room *made = tracer_leaf(b->packet[0].tracer, index, &room);
  bundle_try(b, index, &made->leaf, &made->of.patch, active);
}

/* Tries what box `index` of the tree, which is passed, stands for. */
static void bundle_leaf(struct bundle *b, uint32_t index, unsigned active)
{
  const struct model *model = b->packet[0].model;
  const size_t trees = model->leaf_count + model->copy_count; /* boxes from here on */
  if (index >= trees) {
    bundle_inner(b, &model->inner[index - trees], active);
  } else if (index >= model->leaf_count) {
    bundle_copy(b, &model->copies[index - model->leaf_count], active);
  } else if (model->leaves) {
    struct leaf *leaf = &model->leaves[index];
    bundle_try(b, index, leaf, &model->patches[leaf->patch], active);
  } else {
    bundle_make(b, index, active);
  }
  bool moved = false;
  for (int h = 0; h < b->packets; h++) moved |= b->packet[h].moved, b->packet[h].moved = false;
  if (moved) bundle_update(b);
}

/* Prefetches what a leaf's first stages read of it and of its patch, or what it is made of. */
LANES_INLINE void fetch_leaf(const struct model *model, uint32_t index)
{
  const uint32_t patch = model->oriented[index].patch;
  if (model->leaves) {
    __builtin_prefetch(&model->patches[patch].center);
    __builtin_prefetch(&model->patches[patch].cut);
    fetch(&model->leaves[index], offsetof(struct leaf, x));
  } else {
    __builtin_prefetch(&model->places[index]);
    fetch(&model->scene->patches[patch].P, sizeof model->scene->patches->P);
  }
}

/* Those of the rays that pass that box, and are to be tried on the leaf now. If there are any, it is prefetched. */
LANES_INLINE unsigned rays_pass(struct bundle *b, uint32_t box, unsigned rays)
{
  const struct model *model = b->packet[0].model;
  rays = box_passed(b, box, rays);
  if (rays) rays = bundle_defer(b, box, rays);
  if (rays && box < model->leaf_count) fetch_leaf(model, box);
  return rays;
}

/* Takes one ray through what is below `child`. */
static void ray_walk(struct bundle *b, const struct model_tree *tree, uint32_t child, unsigned lane)
{
  struct ray_way way;
  ray_begin(b, child, lane, &way);
  for (bool on = true; on && ray_charge(b, lane);) {
    const uint32_t box = way.child & ~BVH_LEAF;
    if (way.child == box) {
      on = ray_down(b, tree, &way);
    } else {
      if (rays_pass(b, box, 1u << lane)) bundle_leaf(b, box, 1u << lane);
      on = (b->live >> lane & 1) && ray_next(b, &way);
    }
  }
}

/* Takes the rays through all of the tree, one step of each in turn: what a ray needs next is fetched from memory while
 * the others take their steps. A ray that passes a leaf's box waits there for its next turn, and for others that arrive
 * meanwhile. Out of line because of the stack that it takes. */
__attribute__((noinline)) static void rays_walk(struct bundle *b, const struct model_tree *tree, unsigned rays)
{
  struct ray_way ways[FLOAT_LANES];
  uint32_t waits_at[FLOAT_LANES] = {0}; /* a leaf child; 0: nowhere */
  for (unsigned bits = rays; bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    ray_begin(b, 0, lane, &ways[lane]);
  }
  while (rays) {
    for (unsigned bits = rays; bits; bits &= bits - 1) {
      const unsigned lane = (unsigned)__builtin_ctz(bits);
      struct ray_way *way = &ways[lane];
      const uint32_t child = way->child, box = child & ~BVH_LEAF;
      if (waits_at[lane] == 0 && !ray_charge(b, lane)) {
        rays &= ~(1u << lane);
      } else if (child == box) {
        if (!ray_down(b, tree, way)) rays &= ~(1u << lane);
      } else if (waits_at[lane] == 0) {
        if (rays_pass(b, box, 1u << lane)) waits_at[lane] = child;
        else if (!ray_next(b, way)) rays &= ~(1u << lane);
      } else {
        unsigned here = 0;
        for (int k = 0; k < FLOAT_LANES; k++) here |= (unsigned)(waits_at[k] == child) << k;
        bundle_leaf(b, box, here);
        bits &= ~here | 1u << lane; /* that was their turn, too */
        for (; here; here &= here - 1) {
          const unsigned k = (unsigned)__builtin_ctz(here);
          waits_at[k] = 0;
          if (!(b->live >> k & 1) || !ray_next(b, &ways[k])) rays &= ~(1u << k);
        }
      }
    }
  }
}

/* Rays as few as this go one by one. Four boxes, or a leaf's, cost a single ray a third of the work; and rays that go
 * different ways then reach first what is nearest to each. */
enum { FEW_TOGETHER = 2, FEW_APART = FLOAT_LANES / 2 };

/* Warm starts pass from ray to ray, so all go together. */
LANES_INLINE int most_alone(const struct bundle *b)
{
  return b->packet[0].tracer->warm ? 1 : b->view.apart ? FEW_APART : FEW_TOGETHER;
}

/* This many leaves, of some 1.2 KB each, exceed any processor's own caches. If the rays have nothing in common there,
 * waiting for memory costs more than they could share. */
enum { MANY_LEAVES = 1 << 14 };

static bool rays_apart(const struct bundle *b)
{
  const struct model *model = b->packet[0].model;
  return b->view.apart && model->leaf_count >= MANY_LEAVES && !b->packet[0].tracer->warm;
}

/* Goes down from a node to the nearest of its children; the others wait. Returns whether that child is visited at
 * once. */
LANES_INLINE bool together_down(const struct bundle *b, const struct model_tree *tree, bool nearest, struct waiting *w,
                                unsigned *rays, uint32_t *child)
{
  const struct bvh_node *node = &tree->bvh.nodes[*child];
  const size_t from = sorted_from(nearest, w->top);
  struct entries in;
  view_boxes(&b->view, node, &in);
  uint64_t sides = in.rays & rays_of_sides(*rays);
  if (sides == 0) return false;
  struct entered next = take_side(&in, &sides);
  while (sides != 0) {
    struct entered other = take_side(&in, &sides);
    if (other.first <= next.first) {
      const struct entered farther = next;
      next = other, other = farther;
    }
    waiting_add(w, from, (struct waiting_key){other.first, other.rays, node->child[other.side], 0},
                &in.near[other.side]);
    fetch_child(b->packet[0].model, tree, node->child[other.side]);
  }
  if (w->top > from && w->key[w->top - 1].first < next.first) {
    waiting_add(w, from, (struct waiting_key){next.first, next.rays, node->child[next.side], 0}, &in.near[next.side]);
    return false;
  }
  *rays = next.rays, *child = node->child[next.side];
  return true;
}

/* Goes to the nearest of what waits. Returns whether there is any. */
LANES_INLINE bool together_next(const struct bundle *b, struct waiting *w, unsigned *rays, uint32_t *child)
{
  do {
    if (w->top == 0) return false;
    const struct waiting_key *key = &w->key[--w->top];
    *child = key->child;
    *rays = key->rays & b->live & float_lanes_up_to(w->near[key->room], b->view.far);
  } while (*rays == 0);
  return true;
}

/* Boxes that rays test together are charged once they are this many. */
enum { CHARGED_AT_ONCE = 64 };

/* Takes the rays through the tree together, as long as there are several. Out of line because of the stack that it
 * takes. */
__attribute__((noinline)) static void together_walk(struct bundle *b, const struct model_tree *tree, unsigned rays)
{
  struct waiting waiting;
  waiting.top = waiting.rooms = 0;
  const int few = most_alone(b);
  const bool nearest = nearest_first(b);
  uint32_t child = 0;
  int boxes = 0;
  for (bool on = true; on;) {
    boxes++;
    if (child & BVH_LEAF) {
      const uint32_t box = child & ~BVH_LEAF;
      rays = rays_pass(b, box, rays);
      if (rays) bundle_leaf(b, box, rays);
    } else if (__builtin_popcount(rays) <= few) {
      for (unsigned bits = rays; bits; bits &= bits - 1) ray_walk(b, tree, child, (unsigned)__builtin_ctz(bits));
    } else if (together_down(b, tree, nearest, &waiting, &rays, &child)) {
      continue;
    }
    if (boxes >= CHARGED_AT_ONCE) bundle_charge(b, boxes), boxes = 0;
    on = together_next(b, &waiting, &rays, &child);
  }
  bundle_charge(b, boxes);
}

static void bundle_walk(struct bundle *b, const struct model_tree *tree, unsigned rays)
{
  if (tree->bvh.node_count == 0) return;
  if (rays && (rays & (rays - 1)) == 0) ray_walk(b, tree, 0, (unsigned)__builtin_ctz(rays));
  else if (rays_apart(b)) rays_walk(b, tree, rays);
  else together_walk(b, tree, rays);
}

/* Walks all of the model, and then tries the leaves that were deferred. */
static void bundle_walk_all(struct bundle *b, const struct model *model)
{
  bundle_walk(b, &model->tree, b->live);
  b->defers = false;
  for (unsigned k = 0; k < b->later.count; k++) {
    const unsigned rays = b->later.at[k].rays & b->live;
    if (rays) bundle_leaf(b, b->later.at[k].leaf, rays);
  }
}

/* ---- the face ---- */

LANES_INLINE size_t packets_of(size_t count) { return count < FLOAT_LANES ? (count - 1) / LANES + 1 : PACKETS; }

LANES_INLINE void bundle_begin(struct bundle *b, struct ready ready[PACKETS], struct tracer *tracer, size_t count,
                               const struct ray rays[], bool any, int budget)
{
  const size_t packets = packets_of(count);
  b->packets = (int)packets;
  for (size_t h = 0; h < packets; h++) {
    const size_t left = count - h * LANES;
    packet_begin(&b->packet[h], &ready[h], tracer, left < LANES ? left : LANES, rays + h * LANES, any, budget);
  }
  b->defers = any, b->later.count = 0;
  bundle_start(b, &tracer->model->tree);
}

/* Returns, as bits, the rays whose answers might differ in other company. */
LANES_INLINE unsigned bundle_trace(struct tracer *tracer, enum wanted wanted, size_t count, const struct ray rays[],
                                   void *answers, int budget)
{
  const bool any = wanted == WANTED_ANY;
  unsigned unsettled = 0;
  struct ready ready[PACKETS];
  struct bundle bundle;
  bundle_begin(&bundle, ready, tracer, count, rays, any, budget);
  for (int h = 0; h < bundle.packets && wanted == WANTED_ALL; h++) gather_start(&bundle.packet[h], &tracer->gather[h]);
  bundle_walk_all(&bundle, tracer->model);
  for (size_t h = 0; h < packets_of(count); h++) {
    struct packet *packet = &bundle.packet[h];
    const int *exponents = ready[h].copied ? ready[h].exponent : NULL;
    void *out = wanted_at(wanted, answers, h * LANES);
    const unsigned here = any                        ? finish_occluded(packet, out)
                          : wanted == WANTED_CLOSEST ? finish_hits(packet, exponents, out)
                                                     : gather_finish(packet, exponents, out);
    const size_t grazing = any ? 0 : (size_t)__builtin_popcount(here);
    tracer->counts.grazing += grazing, tracer->counts.certain += any ? 0 : packet->count - grazing;
    tracer->counts.rays[any] += packet->count;
    unsettled |= here << h * LANES;
  }
  return unsettled;
}

/* Whether any hit was found is settled unless a budget was exhausted: only then is a ray of several traced again. A
 * single ray has a call of its own, so that it costs no loops over more. */
static unsigned trace(struct tracer *tracer, enum wanted wanted, size_t count, const struct ray rays[], void *answers)
{
  const bool repeats = wanted == WANTED_ANY ? count > 1 : tracer_repeats(tracer, count);
  const int budget = repeats ? tracer->budget >> BUDGET_IN_COMPANY : tracer->budget;
  unsigned unsettled = 0;
  if (count == 1) (void)bundle_trace(tracer, wanted, 1, rays, answers, budget);
  for (size_t first = 0; first < count && count > 1; first += FLOAT_LANES) {
    void *out = wanted_at(wanted, answers, first);
    unsettled |= bundle_trace(tracer, wanted, count - first, rays + first, out, budget) << first;
  }
  return repeats ? unsettled : 0;
}

const struct kernel KERNEL(kernel) = {KERNEL_NAME, trace, leave_some};
