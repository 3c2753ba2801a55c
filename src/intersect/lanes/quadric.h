/* Whether a leaf has roots besides the known ones, by the quadric that it lies along (struct leaf_quadric).
 *
 * Internal to src/intersect/lanes.
 *
 * Along the ray y1 and y2 are linear in w = x_k, so f(w) = z - (c[0] + c[1] y1 + ... + c[5] y2^2) is a polynomial of
 * degree 2. At a root, f is the leaf's rest there. So
 *
 *   - there is no root at any w where |f(w)| > off;
 *   - of two roots at w1 and w2 the rests differ by f(w1) - f(w2) = f'((w1 + w2)/2) (w1 - w2), and by no more than
 *     |w1 - w2| (turn[0] |y1'| + turn[1] |y2'|). So if there is a root at w1, there is none at a w2 where
 *     |f'((w1 + w2)/2)| exceeds the factor in parentheses. Nor is there another one at w1 itself: where turn is
 *     finite, distinct points of the leaf differ in y1 or y2;
 *
 * The first proves that a ray passes a bent leaf by. The second shows on which side of a leaf a grazing ray stays. In these cases a bound on how far the leaf's Jacobian turns decides
 * nothing, whereas f takes the ray's own direction into account.
 */
#ifndef PSCN_INTERSECT_LANES_QUADRIC_H
#define PSCN_INTERSECT_LANES_QUADRIC_H

#include "intersect/lanes/candidate.h"

/* f, and the range in which slabs and ends of the ray allow roots. */
struct quadric_along {
  lanes f[3]; /* f(w) = f[0] + f[1] w + f[2] w^2 */
  lanes from, to;
  /* bound on the difference of the rests of two roots, over their distance: on the leaf, and on the widened one */
  lanes turn, turn_wide;
};

/* quadric.c: sets *out. Returns the lanes of `open` on which it may be used: their rays are known well enough. */
lane_mask quadric_along(const struct packet *p, const struct candidate *it, lane_mask open, struct quadric_along *out);

/* quadric.c: the lanes of `open` on which the leaf has no root between the ends of the ray besides *root, if that
 * exists. */
lane_mask quadric_closes(const struct quadric_along *along, const struct candidate *it, const struct leaf_root *root,
                         lane_mask open);

#endif
