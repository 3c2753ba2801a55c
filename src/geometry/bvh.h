/* A bounding volume hierarchy over axis-aligned boxes, up to four children a node.
 *
 * Built by the binned surface-area heuristic (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies,
 * 2007; four children: Wald, Benthin and Boulos, Getting Rid of Packets, 2008). Read-only once built; any number of
 * threads may walk it. The caller chooses the frame of the boxes, best near the origin: stored boxes are single
 * precision, rounded outwards, and always contain the given ones.
 */
#ifndef PSCN_GEOMETRY_BVH_H
#define PSCN_GEOMETRY_BVH_H

#include <math.h>
#include <stdalign.h>
#include <stddef.h>
#include <stdint.h>

#include "base/real.h"
#include "base/status.h"
#include "base/team.h"

/* Aligned as the float box that the builder puts in its place. */
struct bvh_box {
  alignas(16) double lo[3];
  double hi[3];
};

/* The empty box: the sum with any other box is that box. */
static const struct bvh_box BVH_EMPTY = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

/* Grows `sum` to the least box that holds both. */
static inline void bvh_box_add(struct bvh_box *sum, const struct bvh_box *box)
{
  for (int k = 0; k < 3; k++)
    sum->lo[k] = real_min(sum->lo[k], box->lo[k]), sum->hi[k] = real_max(sum->hi[k], box->hi[k]);
}

enum { BVH_WIDTH = 4 };

/* A node has its children's boxes, so that a walk reads one node a step; side by side, so that one ray is tested
 * against all of them at once. */
struct bvh_node {
  float lo[3][BVH_WIDTH], hi[3][BVH_WIDTH];
  /* inner child: index of its node; leaf child: BVH_LEAF | index of the box; behind the last child: 0, the root, which
   * is nobody's child, with a box that means nothing */
  uint32_t child[BVH_WIDTH];
};

#define BVH_LEAF UINT32_C(0x80000000) /* the top bit of a child */

/* The depth that no tree built here exceeds, and the stack of a walk that puts all children of a node on it before it
 * takes the next one. */
enum { BVH_MAX_DEPTH = 64, BVH_STACK = (BVH_WIDTH - 1) * BVH_MAX_DEPTH + 1 };

struct bvh {
  struct bvh_node *nodes; /* nodes[0] is the root; owned */
  size_t node_count;      /* 0 for no boxes; some of them, all zero, are nobody's child */
};

/* Builds over boxes[0..count), count < 2^31, and uses them up: they cannot be read afterwards. Any team builds the same
 * tree. A single box gives one node with one child. STATUS_LIMIT if memory or threads are short; *out is then empty. */
enum status bvh_build(struct bvh_box *boxes, size_t count, const struct team *team, struct bvh *out) STATUS_MUST_CHECK;

void bvh_free(struct bvh *bvh);

#endif
