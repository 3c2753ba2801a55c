/* Whether a leaf has roots besides those that are known, by the quadric that it lies along (struct leaf_quadric).
 *
 * Internal to src/intersect/lanes.
 *
 * Along the ray, where y1 and y2 are linear in w = x_k, f(w) = z - (c[0] + c[1] y1 + ... + c[5] y2^2) is a polynomial of degree
 * 2. At a root it is the leaf's rest there. So
 *
 *   - there is no root at any w where |f(w)| > off;
 *   - of two roots at w1 and w2 the rests differ by f(w1) - f(w2) = f'((w1 + w2)/2) (w1 - w2), and by no more than |w1 - w2|
 *     times turn[0] |y1'| + turn[1] |y2'|: besides a root at w1 there is none at a w2 where |f'((w1 + w2)/2)| is more than
 *     that. Nor is there another one at w1, for where turn is finite points of the leaf differ in y1 or y2;
 *   - besides two roots at w1 and w2 there is none where f'((w1 + w)/2) and f'((w2 + w)/2), which are f[2] (w1 - w2) apart,
 *     cannot both be as small as that.
 *
 * The first tells of a ray that passes a bent leaf by, the second of one that grazes it on which side of it the ray stays, the
 * third of one that cuts a piece off: all where a bound on how far the leaf's Jacobian turns tells nothing, for here the ray's
 * own direction is what counts.
 */
#ifndef PSCN_INTERSECT_LANES_QUADRIC_H
#define PSCN_INTERSECT_LANES_QUADRIC_H

#include "intersect/lanes/candidate.h"

/* f, and where slabs and ends of the ray leave room for roots. */
struct quadric_along {
  lanes f[3];     /* f(w) = f[0] + f[1] w + f[2] w^2 */
  lanes slope[2]; /* y1' and y2' */
  lanes from, to;
  /* bound on what the rests of two roots differ by, over their distance: on the leaf, and on the widened one */
  lanes turn, turn_wide;
};

/* quadric.c: returns the lanes of `open` that *out tells anything of: rays that are known well enough. */
lane_mask quadric_along(const struct packet *p, const struct candidate *it, lane_mask open, struct quadric_along *out);

/* quadric.c: the lanes of `asked` on which the leaf has no root between the ends of the ray but *root, where that exists. */
lane_mask quadric_closes(const struct quadric_along *along, const struct candidate *it, const struct leaf_root *root,
                         lane_mask asked);

/* quadric.c: the lanes of `asked` on which both exist, are not the same, and are all. */
lane_mask quadric_closes_two(const struct quadric_along *along, const struct candidate *it,
                             const struct leaf_root *first, const struct leaf_root *second, lane_mask asked);

#endif
