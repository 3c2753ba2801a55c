/* One candidate: a leaf and the rays of a packet that may pass its boxes, on the lanes that share a dominant axis.
 *
 * Internal to src/intersect/lanes. A candidate passes a line of stages, which candidate.c shows. All stages have one
 * shape: they take the lanes that are still open, may offer roots (nearest.h), and return the lanes that are open
 * after them. A lane is closed where the leaf is proven to be missed, or all of its roots have been offered. What is
 * open in the end goes to the last resort (exact.h).
 */
#ifndef PSCN_INTERSECT_LANES_CANDIDATE_H
#define PSCN_INTERSECT_LANES_CANDIDATE_H

#include "intersect/lanes/newton.h"

enum { RESULTANT_MAX_DEGREE = 18 };

/* What the stages tell each other, in the order in which they set it. */
struct candidate {
  /* packet_leaf: */
  struct leaf *leaf; /* constant but for its quadric, where it has none yet: then it is the tracer's own */
  const struct model_patch *patch; /* the leaf's */
  int64_t number;                  /* the leaf's, in its model */
  int axis;
  const struct line *line; /* the packet's for that axis */
  /* stage_bilinear: */
  struct leaf_root first; /* the root found first; only where it exists */
  /* stage_planes: */
  lanes a[16], b[16]; /* the nets of the planes' polynomials, a[4 * i + j]; each is off by line->error at most */
  lane_mask along;    /* the ray meets a curve on the leaf, or its pole, as far as double precision can tell */
  lanes alpha, beta;  /* largest |a|, |b| of the nets, then of the form */
  /* stage_resultant: */
  lanes form_error;             /* of a coefficient of the form */
  lanes form_a[16], form_b[16]; /* where the form is not the leaf's own net */
  const lanes *fa, *fb;
  int degree; /* of r, exact roots at the ends taken off */
  lanes c_store[RESULTANT_MAX_DEGREE + 1];
  const lanes *c;   /* c[0..degree] */
  lanes variations; /* sign variations of c, at most; -1 where they are not counted */
};

/* planes.c: the slab across the leaf, to the last places; closed where it lies before the ray's start or behind its end or
 * nearest hit. */
lane_mask stage_slab(const struct packet *p, const struct candidate *it, lane_mask open);

/* planes.c: the t at which the ray comes to the box along the leaf, or less. */
lanes slab_begin(const struct packet *p, const struct candidate *it);

/* planes.c: the box along the leaf, to the last places; closed where the ray passes it by. The walk has looked at it in floats,
 * which is enough for all rays but those that come by many leaves. */
lane_mask stage_box(const struct candidate *it, lane_mask open);

/* planes.c, of a leaf with a pole: closed where the ray starts exactly in the pole and meets no other point of the leaf. From there
 * it would go from stage to stage in vain. */
lane_mask stage_pole(const struct packet *p, struct candidate *it, lane_mask open);

/* planes.c: of `open`, the lanes whose ray starts exactly in a corner of the patch, and meets no other point of the leaf: handles of
 * no length make a corner one where no Jacobian is regular. Sets the polynomials. */
lane_mask leaves_corner(const struct packet *p, struct candidate *it, lane_mask open);

/* bilinear.c: the root of the leaf's bilinear part, from a resultant of degree 2, made good by Newton's method on the
 * leaf. Open stays where the ray is so slanted that it is not proven to be the only one. */
lane_mask stage_bilinear(struct packet *p, struct candidate *it, lane_mask open);

/* quadric.c: closed where the quadric that the leaf lies along tells that it has no root but the one that stage_bilinear has found,
 * or none; with the default method also where it has just one more, which is sought. */
lane_mask stage_quadric(struct packet *p, const struct candidate *it, lane_mask open);

/* planes.c: the plane polynomials a, b: closed where one of them, or a combination, keeps one sign on its whole net.
 * Where these are one polynomial, or the ray meets the leaf's pole within its range, `along` is set: no stage behind can decide
 * that. */
lane_mask stage_planes(const struct packet *p, struct candidate *it, lane_mask open);

/* bilinear.c: by the default method, closed where boxes show that the leaf has no root but the one that stage_bilinear
 * has found, and one more, which is sought where they do not. */
lane_mask stage_cover(struct packet *p, struct candidate *it, lane_mask open);

/* resultant.c: Bezout's resultant r of a and b in Bernstein form: closed where it has no sign variation. */
lane_mask stage_resultant(struct candidate *it, lane_mask open);

/* resultant.c: one root of r, from its control polygon, and where it is not alone another one. Closed where these are
 * proven to be all. */
lane_mask stage_first_root(struct packet *p, struct candidate *it, lane_mask open);

/* all_roots.c: the roots of r by the method that the scene asks for; closed where they are proven to be all. */
lane_mask stage_all_roots(struct packet *p, struct candidate *it, lane_mask open);

/* all_roots.c: the real root of r0 + r1 s + r2 s^2 that is nearest to 0, or the real part of a pair, by that method;
 * takes lanes out of *open where it finds none. */
lanes method_quadratic_root(struct packet *p, const struct candidate *it, const lanes r[3], lane_mask *open);

/* How many roots near [0,1] a lane may try: of 18, more are real in [0,1] next to never. A choice of speed. */
enum { TRIED_ROOTS = 8 };

/* Where to start from: the k-th of every lane, in leaf parameters, where it has so many. */
struct root_starts {
  int count;
  lanes u[TRIED_ROOTS], v[TRIED_ROOTS];
  lane_mask has[TRIED_ROOTS];
};

/* one_by_one.c: from the roots of r by a method that is not for lanes. *out has none. */
void method_starts(const struct packet *p, const struct candidate *it, lane_mask open, struct root_starts *out);

/* one_by_one.c: without polish the roots of r are the answer, proven or not. */
lane_mask stage_bare_roots(struct packet *p, struct candidate *it, lane_mask open);

/* All of a patch is within |w| < 1 in its frame: a ray is not looked at beyond this. */
#define FRAME_END 2.0

/* Between these w = x_k the ray is where it looks for a root up to t = far, but for `off`. */
LANES_INLINE void ray_ends(const struct packet *p, const struct candidate *it, lanes far, lanes *from, lanes *to,
                           lanes *off)
{
  const lanes along = p->direction[it->axis] * (1 / it->patch->scale), start = it->line->start[0];
  const lanes at_min = p->t_min * along - start, at_far = far * along - start;
  *from = lanes_clamp(lanes_min(at_min, at_far), -FRAME_END, FRAME_END);
  *to = lanes_clamp(lanes_max(at_min, at_far), -FRAME_END, FRAME_END);
  *off = 2 * (p->t_error * lanes_abs(along) + 16 * UNIT_ROUNDOFF * lanes_abs(start));
}

/* On the ray x_i = m0 + s0 w, x_j = m1 + s1 w, x_k = w the slab's form is a + b w. */
LANES_INLINE void slab_values(const struct line *line, int k, const struct leaf_slab *slab, lanes *a, lanes *b)
{
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  *a = slab->g[i] * line->moment[0] + (slab->g[j] * line->moment[1] - slab->offset);
  *b = slab->g[i] * line->slope[0] + (slab->g[j] * line->slope[1] + slab->g[k]);
}

LANES_INLINE void plane_values(const struct line *line, int axis, const double x[3][16], int at, lanes *a, lanes *b)
{
  const double k = x[axis][at], i = x[(axis + 1) % 3][at], j = x[(axis + 2) % 3][at];
  *a = (i - line->moment[0]) - line->slope[0] * k;
  *b = (j - line->moment[1]) - line->slope[1] * k;
}

/* Lanes whose ray starts exactly in the corner (u,v) of the patch, 0 or 1 each; none where the leaf does not have it. */
LANES_INLINE lane_mask starts_at_corner(const struct packet *p, const struct candidate *it, int u, int v)
{
  const struct leaf *leaf = it->leaf;
  const bool has = leaf->column_u == u * (it->patch->cut.split[0] - 1) &&
                   leaf->column_v == v * (it->patch->cut.split[1] - 1);
  return has ? packet_starts_at(p, leaf->patch, 12 * u + 3 * v) : (lane_mask){0};
}

/* planes.c: x_k of the points (u,v). */
lanes plane_depth(const struct candidate *it, lanes u, lanes v);

/* resultant.c: the eliminated parameter at a root of r. */
lanes resultant_eliminated(const struct candidate *it, lanes kept);

/* Whether r is of the leaf's own polynomials, so that it has a root for each of the leaf's. Of polynomials of a lower degree,
 * which are off by form->excess, each of those is a root when both are moved so that it is one: no two need be roots of the
 * same r, whose sign variations tell that there is none, but not how many there are. */
LANES_INLINE bool resultant_counts(const struct candidate *it)
{
  return !it->leaf->form || it->leaf->form->excess == 0;
}

/* t within [0,1], or the middle where it is not a number. */
LANES_INLINE lanes start_within(lanes t) { return lanes_clamp(lanes_select(t == t, t, lanes_all(0.5)), 0, 1); }

#endif
