/* The last Newton step for several hits on one patch: the last places of U, V and T, the point, the normal.
 *
 * Internal to src/intersect/lanes.
 */
#ifndef PSCN_INTERSECT_LANES_LAST_STEP_H
#define PSCN_INTERSECT_LANES_LAST_STEP_H

#include "intersect/lanes/names.h"
#include "intersect/lanes/surface.h"
#include "intersect/model.h"

/* Hits on one patch, of rays with one dominant axis. */
struct last_step {
  const struct model_patch *patch;
  int axis;
  const lanes *origin, *direction; /* [3] */
  lane_mask near;                  /* roots near the rays' starts: they need more digits */
  lane_mask improves;              /* the others keep their u, v and t */
  lanes u, v, t;                   /* in and out */
  lanes point[3], normal[3];       /* out: in the patch's frame; the normal of unit length and either sense */
  lanes tangent;                   /* out: bound on the derivatives' coordinates */
  lane_mask done;                  /* out: point and normal are sure */
};

/* Improves the lanes of `improves`, and sets point and normal of all lanes. A lane whose steps do not end within the
 * patch's size keeps its u, v and t. T is right to 2^-80 of the patch's frame, on lanes of `near` to 2^-100, and then
 * rounded once. */
void last_step_take(struct last_step *l);

#endif
