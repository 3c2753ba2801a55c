/* A box on which a and b are one polynomial up to a factor, as they are if the ray lies in the plane of a flat patch.
 * The ray then meets curves.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 *
 * Where that polynomial and w are coordinates of the box (their Jacobian keeps its sign), w is monotone along each
 * curve. So what comes first lies on a border of the box, and is a root of a cubic.
 */
#ifndef PSCN_INTERSECT_EXACT_CURVES_H
#define PSCN_INTERSECT_EXACT_CURVES_H

#include "intersect/exact/box.h"

enum curves {
  CURVES_NONE,   /* no point of the box is on the ray */
  CURVES_BEGIN,  /* the curves' first point on the ray is (u,v), on a border of the box */
  CURVES_UNKNOWN /* not known */
};

/* Finds where the curves of the box begin along the ray. way: 1 if t grows with w, -1 if it falls. *off bounds how
 * far, in w, that point may lie behind the first one. error: see box_test. */
enum curves curves_begin(struct box *box, const double error[2], double way, double *u, double *v, double *off);

/* Finds the point of the curves at which w is `depth`, by Newton's method from the middle of the box. Returns whether
 * it finds one in the box. */
bool curves_at(struct box *box, const double error[2], double depth, double *u, double *v);

#endif
