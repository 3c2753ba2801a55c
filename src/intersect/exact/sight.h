/* What a ray sees of a patch: the whole patch as a piece, and what is special at its borders, decided exactly.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 *
 * As the ray sees it, a border is a cubic curve in the plane of (a,b), and the ray is the origin. Where that curve lies
 * on a line through the origin, some combination p a + q b is zero along the border, so it is divisible by the distance
 * from the border. The kept polynomial (a or b) and the quotient have the same zeros off the border, and simple ones
 * however near to it. So it is at a border that is one point (a pole), at a straight one that the ray meets, and at one
 * in whose plane the ray lies. The roots on such a border are those of the kept polynomial there: they are the roots of
 * the pair (kept polynomial on the border, distance).
 */
#ifndef PSCN_INTERSECT_EXACT_SIGHT_H
#define PSCN_INTERSECT_EXACT_SIGHT_H

#include "intersect/exact/piece.h"
#include "intersect/intersect.h"

struct sight {
  struct piece plane; /* the ray's own a and b */
  struct piece off;   /* the same after all exchanges: it has all roots of the patch off the borders listed below */
  bool dependent;     /* a and b are multiples of each other: the ray lies in the plane of a flat patch */
  unsigned met;       /* borders all of whose points are on the ray, as bits */
  int borders;        /* so many have their curves on a line through the origin: */
  int border[4];      /* their numbers as of geometry/edges.h */
  struct piece on[4]; /* its roots are those on the border: a is the kept polynomial there, b the distance */
  double along;       /* t = w / along */
};

/* Nets are in the pool. False if there is no room. */
bool sight_make(double (*P)[4][3], const struct ray *ray, struct pool *pool, struct sight *out);

#endif
