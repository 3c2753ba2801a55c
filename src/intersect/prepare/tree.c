/* Hierarchies in frames of their own. See tree.h and model.h. */
#include "intersect/prepare/tree.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"
#include "geometry/vector.h"

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

/* Moves the small boxes to the end where they lie together, and writes their hull; returns how many stay. */
static size_t set_apart(const struct bvh_box boxes[], uint32_t index[], size_t count, double frame,
                        struct bvh_box *hull)
{
  *hull = BVH_EMPTY;
  size_t large = 0;
  for (size_t k = 0; k < count; k++) {
    const uint32_t here = index[k];
    if (box_extent(&boxes[here]) > SMALL_BOX * frame) index[k] = index[large], index[large++] = here;
    else bvh_box_add(hull, &boxes[here]);
  }
  return large > 0 && count - large > 1 && box_extent(hull) <= SMALL_PART * frame ? large : count;
}

/* The box in that frame, wider by what rounding it in the frame of the whole may have done. */
static struct bvh_box framed(const struct bvh_box *box, const double middle[3], double frame)
{
  struct bvh_box out;
  for (int k = 0; k < 3; k++) {
    const double slack = 4 * UNIT_ROUNDOFF * (1 + fabs(middle[k]));
    out.lo[k] = (box->lo[k] - middle[k] - slack) / frame, out.hi[k] = (box->hi[k] - middle[k] + slack) / frame;
  }
  return out;
}

/* The leaves of the hierarchy get the numbers of their boxes; its last box is the hull of those set apart, if any. */
static void number_leaves(struct bvh *bvh, const uint32_t index[], size_t stay)
{
  for (size_t n = 0; n < bvh->node_count; n++) {
    for (int side = 0; side < BVH_WIDTH; side++) {
      uint32_t *child = &bvh->nodes[n].child[side];
      const uint32_t box = *child & ~(uint32_t)BVH_LEAF;
      if (*child & (uint32_t)BVH_LEAF) *child = (uint32_t)BVH_LEAF | (box == stay ? (uint32_t)MODEL_INNER : index[box]);
    }
  }
}

/* What the trees are built from: all boxes, in the frame of the whole. */
struct building {
  struct arena *arena;
  struct bvh_box *boxes;
  struct model_tree whole;
  const struct team *team;
};

/* A tree of boxes[index[0..count-1]] in a frame about `middle`, of size `frame`, both in the frame of the whole. */
static enum status build(const struct building *b, uint32_t index[], size_t count, const double middle[3], double frame,
                         struct model_tree *out)
{
  struct bvh_box hull;
  struct bvh_box *boxes = b->boxes;
  const size_t stay = set_apart(boxes, index, count, frame, &hull), inner = stay < count;
  const bool first = frame == 1;
  const bool given = first && !inner; /* the boxes as they are: no copies of them */
  for (size_t k = 0; given && k < stay; k++) index[k] = (uint32_t)k;
  struct bvh_box *own = given ? NULL : memory_alloc(stay + inner + 1, sizeof *own);
  *out = (struct model_tree){.frame = b->whole.frame * frame};
  for (int k = 0; k < 3; k++) out->origin[k] = b->whole.origin[k] + b->whole.frame * middle[k];
  if (!own && !given) return STATUS_LIMIT;
  for (size_t k = 0; own && k < stay; k++) own[k] = first ? boxes[index[k]] : framed(&boxes[index[k]], middle, frame);
  if (inner) own[stay] = framed(&hull, middle, frame);
  const enum status status = bvh_build(given ? boxes : own, stay + inner, b->team, &out->bvh);
  memory_free(own);
  if (status == STATUS_OK) number_leaves(&out->bvh, index, stay);
  if (status != STATUS_OK || !inner) return status;
  out->inner = arena_alloc(b->arena, 1, sizeof *out->inner);
  if (!out->inner) return STATUS_LIMIT;
  double center[3];
  int exponent;
  for (int k = 0; k < 3; k++) center[k] = hull.lo[k] / 2 + hull.hi[k] / 2;
  frexp(real_max(box_extent(&hull) / 2, UNIT_ROUNDOFF), &exponent);
  return build(b, index + stay, count - stay, center, ldexp(1, exponent), out->inner);
}

enum status tree_build(struct arena *arena, struct bvh_box boxes[], size_t count, const struct team *team,
                       struct model_tree *tree)
{
  static const double middle[3] = {0, 0, 0};
  const struct building all = {arena, boxes, *tree, team};
  uint32_t *index = memory_alloc(count + 1, sizeof *index);
  if (!index) return STATUS_LIMIT;
  for (size_t k = 0; k < count; k++) index[k] = (uint32_t)k;
  const enum status status = build(&all, index, count, middle, 1, tree);
  memory_free(index);
  return status;
}

/* ---- crossings ---- */

/* The area of a leaf: of the face across its normal of the box along it. */
static double leaf_area(const struct oriented_box *box)
{
  double g[3][3], normal[3];
  for (int q = 0; q < 3; q++)
    for (int k = 0; k < 3; k++) g[q][k] = (double)box->g[k][q];
  vector_cross(g[1], g[2], normal);
  const double area = 4 * (double)box->half[1] * (double)box->half[2] * vector_length(g[0]) /
                      fabs(vector_dot(g[0], normal));
  return isfinite(area) ? area : 0;
}

/* Of what is in a leaf child's box, times its surface. */
static double crossings_in(const struct model *model, const struct model_tree *tree, uint32_t box, double surface)
{
  if (box == MODEL_INNER) return tree->inner->crossings * surface;
  if (box >= model->leaf_count) return model->copies[box - model->leaf_count].object->model->tree.crossings * surface;
  return 2 * leaf_area(&model->oriented[box]);
}

static void set_crossings(const struct model *model, struct model_tree *tree)
{
  if (tree->inner) set_crossings(model, tree->inner);
  struct bvh_box whole = BVH_EMPTY;
  double sum = 0;
  for (size_t n = 0; n < BVH_WIDTH * tree->bvh.node_count; n++) {
    const struct bvh_node *node = &tree->bvh.nodes[n / BVH_WIDTH];
    const size_t side = n % BVH_WIDTH;
    const uint32_t child = node->child[side];
    struct bvh_box box;
    for (int k = 0; k < 3; k++) box.lo[k] = (double)node->lo[k][side], box.hi[k] = (double)node->hi[k][side];
    if (child == 0) continue;
    if (n < BVH_WIDTH) bvh_box_add(&whole, &box);
    if (child & (uint32_t)BVH_LEAF)
      sum += crossings_in(model, tree, child & ~(uint32_t)BVH_LEAF, box_surface(box.lo, box.hi));
  }
  const double surface = box_surface(whole.lo, whole.hi);
  tree->crossings = surface > 0 ? sum / surface : 0;
}

void tree_set_crossings(struct model *model) { set_crossings(model, &model->tree); }

void tree_free(struct model_tree *tree)
{
  for (; tree; tree = tree->inner) bvh_free(&tree->bvh);
}
