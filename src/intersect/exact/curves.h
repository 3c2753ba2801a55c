/* A box on which a and b are one polynomial but for a factor, as they are where the ray lies in the plane of a flat patch:
 * what is on the ray are curves.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 *
 * Where that polynomial and w are coordinates of the box (their Jacobian keeps its sign), along each curve w only grows or
 * only falls, so what comes first is on a border of the box, a root of a cubic.
 */
#ifndef PSCN_INTERSECT_EXACT_CURVES_H
#define PSCN_INTERSECT_EXACT_CURVES_H

#include "intersect/exact/box.h"

enum curves {
  CURVES_NONE,   /* no point of the box is on the ray */
  CURVES_BEGIN,  /* of all that are the one at (u,v), on a border of the box, comes first */
  CURVES_UNKNOWN /* that is not known */
};

/* Where the curves of the box begin along the ray: way is 1 where t grows with w, -1 where it falls. *off: a bound on what
 * that point's w may be larger than the first one's. error: see box_test. */
enum curves curves_begin(struct box *box, const double error[2], double way, double *u, double *v, double *off);

/* The point of the curves where w is `depth`, by Newton's method from the middle of the box on. Returns whether it is
 * found, in the box. */
bool curves_at(struct box *box, const double error[2], double depth, double *u, double *v);

#endif
