/* The nearest point where a ray meets a leaf, by subdivision: complete by itself, slow.
 *
 * Internal to src/intersect. Pure; safe on any thread; uses some 100 KB of stack.
 */
#ifndef PSCN_INTERSECT_SUBDIVIDE_H
#define PSCN_INTERSECT_SUBDIVIDE_H

#include "intersect/tracer.h"

struct subdivide_task {
  const struct model *model;
  const struct leaf *leaf;
  const struct model_patch *patch;  /* the leaf's */
  double (*P)[4][3];                /* its control points in the scene */
  const struct ray *world;          /* the ray, direction scaled as in the packet */
  const struct local_ray *local;    /* the same in the patch's frame */
  double t_min, t_max;
};

/* Finds the nearest root with t in (t_min, t_max), or where rounding leaves no answer a point with certain = false.
 * Roots that lie outside the leaf by no more than rounding count. Returns whether there is one; only then is *out
 * written. Sets *doubt where some root could not be told from t_min, and was left out. */
bool subdivide_closest(const struct subdivide_task *task, struct leaf_hit *out, bool *doubt);

#endif
