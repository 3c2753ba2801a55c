/* Hierarchies in frames of their own. See tree.h and model.h. */
#include "intersect/prepare/tree.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"

/* Boxes no larger than this part of a frame have one of their own where all of them lie within that part: a float is
 * then still some thousand times finer than they are. Choices of speed. */
#define SMALL_BOX 0x1p-8
#define SMALL_PART 0x1p-6

static double box_extent(const struct bvh_box *box)
{
  double extent = 0;
  for (int k = 0; k < 3; k++) extent = real_max(extent, box->hi[k] - box->lo[k]);
  return extent;
}

static void box_add(struct bvh_box *sum, const struct bvh_box *box)
{
  for (int k = 0; k < 3; k++)
    sum->lo[k] = real_min(sum->lo[k], box->lo[k]), sum->hi[k] = real_max(sum->hi[k], box->hi[k]);
}

/* Moves the small boxes to the end where they lie together, and writes their hull; returns how many stay. */
static size_t set_apart(const struct bvh_box boxes[], uint32_t index[], size_t count, double frame,
                        struct bvh_box *hull)
{
  *hull = (struct bvh_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
  size_t large = 0;
  for (size_t k = 0; k < count; k++) {
    const uint32_t here = index[k];
    if (box_extent(&boxes[here]) > SMALL_BOX * frame) index[k] = index[large], index[large++] = here;
    else box_add(hull, &boxes[here]);
  }
  return large > 0 && count - large > 1 && box_extent(hull) <= SMALL_PART * frame ? large : count;
}

/* The box in the frame, and what its own rounding in the whole one may be. */
static struct bvh_box framed(const struct bvh_box *box, const double middle[3], double frame)
{
  struct bvh_box out;
  for (int k = 0; k < 3; k++) {
    const double slack = 4 * UNIT_ROUNDOFF * (1 + fabs(middle[k]));
    out.lo[k] = (box->lo[k] - middle[k] - slack) / frame, out.hi[k] = (box->hi[k] - middle[k] + slack) / frame;
  }
  return out;
}

/* A tree about `middle`, of size `frame`, both in the frame of the boxes. */
static enum status build(struct arena *arena, const struct bvh_box boxes[], uint32_t index[], size_t count,
                         const double middle[3], double frame, const struct model_tree *whole, const struct team *team,
                         struct model_tree *out)
{
  struct bvh_box hull;
  const size_t stay = set_apart(boxes, index, count, frame, &hull), inner = stay < count;
  const bool first = frame == 1;
  bool given = first && !inner; /* the boxes as they are: no copies of them */
  for (size_t k = 0; given && k < stay; k++) given = index[k] == k;
  struct bvh_box *own = given ? NULL : memory_alloc(stay + inner + 1, sizeof *own);
  *out = (struct model_tree){.frame = whole->frame * frame};
  for (int k = 0; k < 3; k++) out->origin[k] = whole->origin[k] + whole->frame * middle[k];
  if (!own && !given) return STATUS_LIMIT;
  for (size_t k = 0; own && k < stay; k++) own[k] = first ? boxes[index[k]] : framed(&boxes[index[k]], middle, frame);
  if (inner) own[stay] = framed(&hull, middle, frame);
  enum status status = bvh_build(given ? boxes : own, stay + inner, team, &out->bvh);
  memory_free(own);
  for (size_t n = 0; status == STATUS_OK && n < out->bvh.node_count; n++) {
    for (int side = 0; side < BVH_WIDTH; side++) {
      uint32_t *child = &out->bvh.nodes[n].child[side];
      const uint32_t box = *child & ~(uint32_t)BVH_LEAF;
      if (*child & (uint32_t)BVH_LEAF) *child = (uint32_t)BVH_LEAF | (box == stay ? (uint32_t)MODEL_INNER : index[box]);
    }
  }
  if (status != STATUS_OK || !inner) return status;
  out->inner = arena_alloc(arena, 1, sizeof *out->inner);
  if (!out->inner) return STATUS_LIMIT;
  double center[3];
  int exponent;
  for (int k = 0; k < 3; k++) center[k] = hull.lo[k] / 2 + hull.hi[k] / 2;
  frexp(real_max(box_extent(&hull) / 2, UNIT_ROUNDOFF), &exponent);
  return build(arena, boxes, index + stay, count - stay, center, ldexp(1, exponent), whole, team, out->inner);
}

enum status tree_build(struct arena *arena, const struct bvh_box boxes[], size_t count, const double origin[3],
                       double frame, const struct team *team, struct model_tree *out)
{
  static const double middle[3] = {0, 0, 0};
  const struct model_tree whole = {.origin = {origin[0], origin[1], origin[2]}, .frame = frame};
  *out = (struct model_tree){.frame = frame};
  uint32_t *index = memory_alloc(count + 1, sizeof *index);
  if (!index) return STATUS_LIMIT;
  for (size_t k = 0; k < count; k++) index[k] = (uint32_t)k;
  const enum status status = build(arena, boxes, index, count, middle, 1, &whole, team, out);
  memory_free(index);
  return status;
}

void tree_free(struct model_tree *tree)
{
  for (; tree; tree = tree->inner) bvh_free(&tree->bvh);
}
