/* The part of a patch that one search is about: what parameters and depths of its boxes mean on the patch and along the
 * ray, and what of them is told to the judge.
 *
 * Internal to src/intersect/exact. A box's depth is what its third net, w, is: x_k in a frame of the patch (local_ray.h),
 * or zoomed x_k less the window's middle.
 */
#ifndef PSCN_INTERSECT_EXACT_WINDOW_H
#define PSCN_INTERSECT_EXACT_WINDOW_H

#include "intersect/exact/box.h"
#include "intersect/exact/judge.h"

struct window {
  struct judge *judge;
  int zooms;              /* how often it has been zoomed */
  wide low[2], size[2];   /* in parameters of the patch; a box's are from 0 to 1 of it */
  struct depth_map depth; /* from w to t */
  double depth_error;     /* of w */
};

/* The region of the patch that the judge has turned to. */
struct window window_of_region(struct judge *j, const struct exact_region *region);

/* A box of it as a window of its own, but for the start and the errors of its depths, ... */
struct window window_closer(const struct window *window, const struct box *box);

/* ... which are those of the zoomed box. */
void window_set_depths(struct window *window, const struct zoomed *zoomed);

/* What dw of depth is of t. */
static inline double window_length(const struct window *window, double dw)
{
  return error_to_t(window->depth.to_t, window->depth.unit * dw);
}

/* The patch's parameter k where the box's is `at`. */
static inline wide window_place(const struct window *window, const struct box *box, int k, double at)
{
  return window->low[k] + window->size[k] * ((wide)(k ? box->v : box->u) + (wide)(k ? box->size_v : box->size_u) * at);
}

/* Sets where along the ray the box begins and ends. */
void window_set_reach(const struct window *window, struct box *box);

/* The box's root, wherever it lies: one just outside the box is the neighbour's as well, and the same. */
struct exact_root window_root(const struct window *window, struct box *box, const double at[2], const double radius[2]);

/* Tells of the box's point (u,v), its t as nearly as t_error, that may be a hit. */
void window_tell_maybe(const struct window *window, const struct box *box, double u, double v, double t,
                       double t_error);

/* touch.c: decides the box where the ray touches the surface, or nearly: it has no root, or `folds` and those on either
 * side of its fold, or that may be a hit, are all. Returns whether it is decided, and told; else *flat is set where a bent
 * combination (fold.h) is flat. */
bool window_touched(const struct window *window, struct box *box, const double error[2], bool folds, bool *flat);

#endif
