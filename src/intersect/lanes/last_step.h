/* The last Newton step of several hits of one patch: the last places of U, V and T, the point, the normal.
 *
 * Internal to src/intersect/lanes.
 */
#ifndef PSCN_INTERSECT_LANES_LAST_STEP_H
#define PSCN_INTERSECT_LANES_LAST_STEP_H

#include "intersect/lanes/names.h"
#include "intersect/lanes/surface.h"
#include "intersect/model.h"

/* Hits of rays with one dominant axis on one patch. */
struct last_step {
  const struct model_patch *patch;
  int axis;
  const lanes *origin, *direction; /* [3] */
  bool near;                       /* to the rays' starts: their roots want more digits */
  lane_mask improves;              /* the others keep u, v and t as they come */
  lanes u, v, t;                   /* in and out */
  lanes point[3], normal[3];       /* out: in the patch's frame; unit, of either sense */
  lanes tangent;                   /* out: bound on the derivatives' coordinates */
  lane_mask done;                  /* out: point and normal are sure */
};

/* Improves the lanes that ask for it, and takes point and normal of all lanes. A lane whose steps do not end within
 * the patch's size keeps what it came with. T is right to 2^-72 of the patch's frame, near the start to 2^-100, and then rounded
 * once. */
void last_step_take(struct last_step *l);

#endif
