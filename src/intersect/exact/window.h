/* The part of a patch that one search covers. It gives parameters and depths of the search's boxes their meaning on the
 * patch and along the ray, and tells the judge of what is found.
 *
 * Internal to src/intersect/exact. A box's depth is its third net, w: x_k in the frame of the patch (local_ray.h), or,
 * if zoomed, x_k less that of the window's middle.
 */
#ifndef PSCN_INTERSECT_EXACT_WINDOW_H
#define PSCN_INTERSECT_EXACT_WINDOW_H

#include "intersect/exact/box.h"
#include "intersect/exact/judge.h"

struct window {
  struct judge *judge;
  int zooms;              /* how often it was zoomed */
  wide low[2], size[2];   /* in parameters of the patch; boxes have 0 to 1 of it */
  struct depth_map depth; /* from w to t */
  double depth_error;     /* of w */
};

/* The region, of the judge's current patch. */
struct window window_of_region(struct judge *j, const struct exact_region *region);

/* A box of the window as a window of its own. It still lacks the start and the error of its depths, ... */
struct window window_closer(const struct window *window, const struct box *box);

/* ... which this takes from the zoomed box. */
void window_set_depths(struct window *window, const struct zoomed *zoomed);

/* The length in t of dw of depth. */
static inline double window_length(const struct window *window, double dw)
{
  return error_to_t(window->depth.to_t, window->depth.unit * dw);
}

/* The patch's parameter k at the box's parameter `at`. */
static inline wide window_place(const struct window *window, const struct box *box, int k, double at)
{
  return window->low[k] + window->size[k] * ((wide)(k ? box->v : box->u) + (wide)(k ? box->size_v : box->size_u) * at);
}

/* Sets where the box begins and ends along the ray. */
void window_set_reach(const struct window *window, struct box *box);

/* The box's root, wherever it lies. A root just outside the box is the neighbour's too, and the same. */
struct exact_root window_root(const struct window *window, struct box *box, const double at[2], const double radius[2]);

/* Tells of the box's point (u,v), with t known to t_error, which may be a hit. */
void window_tell_maybe(const struct window *window, const struct box *box, double u, double v, double t,
                       double t_error);

/* touch.c: tries to decide a box where the ray touches the surface, or nearly. Either it has no root, or, if `folds`,
 * all it has are the roots on either side of its fold, or one place there that may be a hit. Returns whether the box is
 * decided and told. Sets *flat to whether a bent combination (fold.h) is flat. */
bool window_touched(const struct window *window, struct box *box, const double error[2], bool folds, bool *flat);

#endif
