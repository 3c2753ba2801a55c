/* One patch of the scene, prepared: its frame, its net there, its poles.
 *
 * Internal to src/intersect. Safe on any thread for different patches: the cut of one is kept in model->cuts.
 */
#ifndef PSCN_INTERSECT_PREPARE_PATCH_H
#define PSCN_INTERSECT_PREPARE_PATCH_H

#include "base/real.h"
#include "geometry/bvh.h"
#include "geometry/patch.h"
#include "intersect/model.h"

/* A patch smaller than this part of its coordinates, or of the scene's if these are zeros, is framed as if it were that
 * large: a single point has no size of its own, and a frame too small would overflow. */
#define LEAST_EXTENT 0x1p-100

/* Grows `box` to hold a patch's control points, too. */
static inline void box_add_net(struct bvh_box *box, double P[4][4][3])
{
  double lo[3], hi[3];
  points_range((const double(*)[4][3])P, lo, hi);
  for (int k = 0; k < 3; k++) box->lo[k] = real_min(box->lo[k], lo[k]), box->hi[k] = real_max(box->hi[k], hi[k]);
}

/* Whether patches with this method are tried on lanes of rays at once. */
bool patch_on_lanes(const struct method *method);

/* Makes the patch of the scene; its rest, if it has one, in `rest`. */
void patch_make(const struct model *model, uint32_t index, struct model_patch *out, double rest[3][4][4]);

/* The area of the patch's control net in its frame: about that of the patch, and hardly ever less. */
double patch_net_area(const struct model_patch *patch);

#endif
