/* A binary bounding volume hierarchy over axis-aligned boxes.
 *
 * Built by binned surface-area heuristic (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies,
 * 2007). Read-only once built; any number of threads may walk it. The caller gives boxes in a frame of its choice
 * (near the origin is best, for the stored boxes are single precision, rounded outwards: a stored box always
 * contains the given one).
 */
#ifndef PSCN_GEOMETRY_BVH_H
#define PSCN_GEOMETRY_BVH_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

struct bvh_box {
  double lo[3], hi[3];
};

/* The two children's boxes stand in their parent, so a walk reads one node a step. */
struct bvh_node {
  float lo[2][3], hi[2][3];
  uint32_t child[2]; /* inner child: index of its node; leaf child: BVH_LEAF | index of the box */
};

enum { BVH_LEAF = INT32_MIN }; /* the top bit of a child */

/* The depth that no tree built here passes: what a walk's stack must hold. */
enum { BVH_MAX_DEPTH = 64 };

struct bvh {
  struct bvh_node *nodes; /* nodes[0] is the root; owned */
  size_t node_count;      /* 0 for no boxes */
};

/* Builds over boxes[0..count), count < 2^31. A single box gives one node that has it as both children,
 * the second with an empty box (lo > hi).
 * STATUS_LIMIT where memory is short; then *out is empty. */
enum status bvh_build(const struct bvh_box *boxes, size_t count, struct bvh *out) STATUS_MUST_CHECK;

/* Frees the nodes. */
void bvh_free(struct bvh *bvh);

#endif
