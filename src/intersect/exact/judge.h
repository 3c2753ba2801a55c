/* The case of one ray: what is found is told to the judge, who alone decides what it means.
 *
 * Internal to src/intersect/exact.
 */
#ifndef PSCN_INTERSECT_EXACT_JUDGE_H
#define PSCN_INTERSECT_EXACT_JUDGE_H

#include "intersect/exact/exact.h"
#include "intersect/exact/zoom.h"
#include "intersect/local_ray.h"

/* Roots on borders that even wide arithmetic cannot tell from them: at a shared edge there are two of them, in a corner
 * some more. */
enum { JUDGE_BORDERS_MAX = 16 };

struct judge {
  const struct exact_case *asked;
  struct exact_root nearest; /* of the certain roots inside patches, where `found` */
  struct exact_maybe maybe;  /* the nearest, where `doubtful` */
  struct exact_root border[JUDGE_BORDERS_MAX];
  unsigned border_of[JUDGE_BORDERS_MAX]; /* which borders, as bits */
  int border_count;
  bool found, doubtful;
  bool doubt;   /* something could not be told from the ray's start, and was left out */
  double limit; /* nothing beyond this t matters */
  int work;     /* boxes that may still be looked at */
  /* of the patch looked at last */
  uint32_t patch;
  bool zoomed; /* `zoom` is set */
  struct zoom zoom;
  struct local_ray local;
};

/* Turns to the patch. */
void judge_turn(struct judge *j, uint32_t patch);

/* The ray through that patch under the glass. */
struct zoom *judge_zoom(struct judge *j);

/* A proven root, anywhere on that patch or around it. */
void judge_root(struct judge *j, struct exact_root *root);

/* The ray meets a border of that patch that is one point, as far as wide arithmetic can tell. Returns whether it does.
 * */
bool judge_pole(struct judge *j, int border);

/* The point (u,v) of that patch, at t as nearly as t_error, is on the ray or not. */
void judge_maybe(struct judge *j, double u, double v, double t, double t_error);

/* search.c: tells the judge of every root in the region that is nearer than `limit`, and of every place that cannot be
 * decided. Where no work is left, only of a place that may be one, and of a doubt. */
void search_region(struct judge *j, const struct exact_region *region);

/* search.c: where along the ray the region begins, or less. */
double search_near(struct judge *j, const struct exact_region *region);

#endif
