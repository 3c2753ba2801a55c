/* Places roots that are known to be in a piece. See place.c.
 *
 * Internal to src/intersect/exact.
 */
#ifndef PSCN_INTERSECT_EXACT_PLACE_H
#define PSCN_INTERSECT_EXACT_PLACE_H

#include "intersect/exact/judge.h"

/* A piece in which roots are sought. */
struct waiting {
  struct piece piece;
  size_t keep; /* the pool up to here holds what it is a part of */
  double near, far;
  int border; /* its roots are those on border[..] of the sight; -1: those off such borders */
};

/* w at a root, as by piece_depth. */
struct depth {
  wide w;
  double error;
  bool exact;
};

enum place_within { PLACE_OUT, PLACE_IN, PLACE_UNKNOWN };

/* Whether that is strictly between the ray's ends. */
enum place_within place_in_range(const struct judge *j, const struct depth *depth);

/* Reports a root that piece_root has found, or, with a radius of 0, one in a corner of the piece. If the ray may only touch
 * the surface there, within the patch, it does not count among all hits. */
void place_root(struct judge *j, const struct waiting *it, const struct piece_root *root);

#endif
