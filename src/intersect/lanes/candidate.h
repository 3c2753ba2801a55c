/* A candidate: a leaf, and those rays of a packet that may pass its boxes and share a dominant axis.
 *
 * Internal to src/intersect/lanes. A candidate goes through a sequence of stages; candidate.c shows their order. All
 * stages have one shape: they take the lanes that are still open, may offer roots (nearest.h), and return the lanes
 * that are open after them. A stage closes a lane once the leaf is proven to be missed, or all of its roots have been
 * offered. The last resort (exact.h) decides what is open at the end.
 */
#ifndef PSCN_INTERSECT_LANES_CANDIDATE_H
#define PSCN_INTERSECT_LANES_CANDIDATE_H

#include "intersect/lanes/newton.h"
#include "intersect/prepare/leaf.h"

enum { RESULTANT_MAX_DEGREE = 18 };

/* What the stages pass on to later ones, in the order in which they set it. */
struct candidate {
  /* packet_leaf: */
  const struct leaf *leaf;
  const struct model_patch *patch; /* the leaf's */
  int64_t number;                  /* the leaf's, in its model */
  int axis;
  const struct line *line; /* the packet's, for that axis */
  /* stage_bilinear: */
  struct leaf_root first; /* the first root found; meaningful only where it exists */
  /* planes_set: */
  lanes a[16], b[16]; /* nets of the planes' polynomials, a[4 * i + j]; each is off by line->error at most */
  /* stage_resultant: */
  struct leaf_form form;
  lanes form_error;             /* of a coefficient of the form */
  lanes form_a[16], form_b[16]; /* used if the form is not the leaf's own net */
  const lanes *fa, *fb;
  lanes alpha, beta; /* the largest of either */
  int degree;        /* of r, without its exact roots at the ends */
  lanes c_store[RESULTANT_MAX_DEGREE + 1];
  const lanes *c;   /* c[0..degree] */
  lanes variations; /* upper bound on the sign variations of c; -1: not counted */
};

/* planes.c: tests the slab across the leaf to the last places. Closes lanes where it lies before the ray's start,
 * behind its end, or behind the nearest hit so far. */
lane_mask stage_slab(const struct packet *p, const struct candidate *it, lane_mask open);

/* planes.c: a lower bound on the t at which the ray enters the box along the leaf. */
lanes slab_begin(const struct packet *p, const struct candidate *it);

/* bilinear.c: finds the root of the leaf's bilinear part by a resultant of degree 2, and refines it by Newton's method
 * on the leaf. A lane stays open if the ray is so slanted that the root is not proven to be the only one. */
lane_mask stage_bilinear(struct packet *p, struct candidate *it, lane_mask open);

/* planes.c: sets the plane polynomials a and b. */
void planes_set(struct candidate *it);

/* cover.c: closes lanes where pieces that cover the leaf show that it has no root, by the default method also none
 * besides that of stage_bilinear. Where they do not, the default method seeks one more root, and examines the pieces with
 * both. */
lane_mask stage_cover(struct packet *p, struct candidate *it, lane_mask open);

/* resultant.c: sets the form and, with polish, Bezout's resultant r of a and b in Bernstein form. Closes lanes where
 * that has no sign variation. */
lane_mask stage_resultant(struct candidate *it, lane_mask open);

/* all_roots.c: finds the roots of r by the scene's method. Closes lanes where they are proven to be
 * all. */
lane_mask stage_all_roots(struct packet *p, struct candidate *it, lane_mask open);

/* all_roots.c: returns the real root of r0 + r1 s + r2 s^2 nearest to 0, or the real part of a complex pair, by that
 * method. Removes lanes from *open where it finds none. */
lanes method_quadratic_root(struct packet *p, const struct candidate *it, const lanes r[3], lane_mask *open);

/* The most roots near [0,1] that are tried on a lane: of 18 roots, more are hardly ever real and in [0,1]. A choice of
 * speed. */
enum { TRIED_ROOTS = 8 };

/* Start values in leaf parameters: the k-th of every lane that has so many. */
struct root_starts {
  int count;
  lanes u[TRIED_ROOTS], v[TRIED_ROOTS];
  lane_mask has[TRIED_ROOTS];
};

/* resultant.c: sets the k-th start values from a value of the kept parameter, near a root of r. */
void starts_set(const struct candidate *it, int k, lanes kept, struct root_starts *out);

/* resultant.c: takes start values from where the control polygon of r crosses zero last and, if r may have several roots,
 * first. *out is empty before. */
void polygon_starts(const struct candidate *it, lane_mask open, struct root_starts *out);

/* one_by_one.c: the same from the roots of r by a method that does not run on lanes. */
void method_starts(const struct packet *p, const struct candidate *it, lane_mask open, struct root_starts *out);

/* one_by_one.c: without polish the roots of r are the answer, proven or not. */
lane_mask stage_bare_roots(struct packet *p, struct candidate *it, lane_mask open);

/* A patch lies within |w| < 1 in its frame; a ray is not examined beyond this. */
#define FRAME_END 2.0

/* The ray seeks a root up to t = far between these values of w = x_k, each off by `off` at most. */
LANES_INLINE void ray_ends(const struct packet *p, const struct candidate *it, lanes far, lanes *from, lanes *to,
                           lanes *off)
{
  const lanes along = p->direction[it->axis] * (1 / it->patch->scale), start = it->line->start[0];
  const lanes at_min = p->t_min * along - start, at_far = far * along - start;
  *from = lanes_clamp(lanes_min(at_min, at_far), -FRAME_END, FRAME_END);
  *to = lanes_clamp(lanes_max(at_min, at_far), -FRAME_END, FRAME_END);
  *off = 2 * (p->t_error * lanes_abs(along) + 16 * UNIT_ROUNDOFF * lanes_abs(start));
}

/* On the ray x_i = m0 + s0 w, x_j = m1 + s1 w, x_k = w, the slab's form g x - offset is a + b w. */
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

/* planes.c: x_k of the points (u,v). */
lanes plane_depth(const struct candidate *it, lanes u, lanes v);

/* Whether r is made of the leaf's own polynomials, and so has a root for each of the leaf's. Polynomials of a lower
 * degree are off by the excess. Moved by a constant they have any one root of the leaf as their root, but two roots
 * may need different constants, and so different r. The sign variations of r then prove that there is no root, but do
 * not bound how many there are. */
LANES_INLINE bool resultant_counts(const struct candidate *it) { return it->form.excess == 0; }

/* t clamped to [0,1], or the middle if it is not a number. */
LANES_INLINE lanes start_within(lanes t) { return lanes_clamp(lanes_select(t == t, t, lanes_all(0.5)), 0, 1); }

#endif
