/* One ray a lane against one leaf: plane polynomials, two-dimensional Newton, and the test that proves what it found.
 *
 * Internal to src/intersect/lanes.
 * Parameters (u,v) are the leaf's own, [0,1] x [0,1] over the leaf. Norms of parameter vectors are maximum norms.
 */
#ifndef PSCN_INTERSECT_LANES_NEWTON_H
#define PSCN_INTERSECT_LANES_NEWTON_H

#include "base/lanes.h"
#include "intersect/certificate.h"
#include "intersect/model.h"
#include "intersect/lanes/names.h"

/* The two plane polynomials of every lane over a leaf. */
struct plane_nets {
  lanes a[16], b[16]; /* a[4 * i + j] */
  lanes slope[2];
  lanes error; /* bound on the error of any coefficient, and of a value inside the leaf */
};

/* What is known after Newton's process. The fields mean something only where `exists`. */
struct newton_root {
  lanes u, v;
  lanes radius_u, radius_v; /* the exact root is within */
  lane_mask exists;         /* exactly one root of the exact polynomials within the radii */
  lane_mask alone;          /* and no other in the leaf */
  lanes size;               /* |M|, the longer row, see newton_row_length */
  lanes bend;               /* bend (step + off), half of how far M J is at most from 1 at the root */
  lanes off;                /* |M| error */
};

/* The process stops where its next step would be no longer than this, in leaf parameters: it converges
 * quadratically, so after steps s and s' the next is about s'^3/s^2. Not a tolerance of the answer, whose radius is
 * computed, and whose last places are last_step.h's. */
#define NEWTON_NEXT_STEP 0x1p-48
/* What stands for s at the first step, as if the start were that near: it has to be a hit by itself to be the last. */
#define NEWTON_START 0x1p-18
enum { NEWTON_MAX_STEPS = 10 };

/* The inverse Jacobian M: steps are M (a, b). */
struct newton_inverse {
  lanes ua, ub, va, vb;
};

LANES_INLINE void newton_weights(lanes t, lanes w[4], lanes dw[4])
{
  const lanes s = 1 - t, ss = s * s, tt = t * t, st = s * t;
  w[0] = ss * s, w[1] = 3 * (ss * t), w[2] = 3 * (st * t), w[3] = tt * t;
  dw[0] = -3 * ss, dw[1] = 3 * (ss - 2 * st), dw[2] = 3 * (2 * st - tt), dw[3] = 3 * tt;
}

struct newton_jet {
  lanes value, du, dv;
};

LANES_INLINE struct newton_jet newton_evaluate(const lanes net[16], const lanes wu[4], const lanes du[4],
                                               const lanes wv[4], const lanes dv[4])
{
  struct newton_jet jet = {{0}, {0}, {0}};
  for (int i = 0; i < 4; i++) {
    const lanes *n = net + 4 * i;
    const lanes row = n[0] * wv[0] + n[1] * wv[1] + n[2] * wv[2] + n[3] * wv[3];
    const lanes row_dv = n[0] * dv[0] + n[1] * dv[1] + n[2] * dv[2] + n[3] * dv[3];
    jet.value += wu[i] * row;
    jet.du += du[i] * row;
    jet.dv += wu[i] * row_dv;
  }
  return jet;
}

/* A row of the inverse Jacobian as a covector of space: its length bounds how fast that parameter moves with the
 * surface. */
LANES_INLINE lanes newton_row_length(lanes p, lanes q, const lanes slope[2])
{
  const lanes r = p * slope[0] + q * slope[1];
  return lanes_sqrt(p * p + q * q + r * r);
}

/* The certificate (certificate.h): sets all but u and v of *r, which hold where the process went on the lanes that
 * `settled`. bend is |M| (|Suu| + 2 |Suv| + |Svv|). */
LANES_INLINE void newton_prove(const struct leaf *leaf, const struct newton_inverse *m, const lanes slope[2],
                               lanes error, lanes step, lane_mask settled, struct newton_root *r)
{
  const lanes size_u = newton_row_length(m->ua, m->ub, slope), size_v = newton_row_length(m->va, m->vb, slope);
  const lanes size = lanes_max(size_u, size_v);
  const lanes bend = size * (leaf->second[0] + 2 * leaf->second[1] + leaf->second[2]);
  const lanes off = size * error;
  const lane_mask near = (lanes_abs(r->u - 0.5) < 0.5 + LEAF_MARGIN) & (lanes_abs(r->v - 0.5) < 0.5 + LEAF_MARGIN);
  r->exists = settled & near & certificate_holds(bend, step, off);
  r->radius_u = certificate_radius(bend, step, size_u * error);
  r->radius_v = certificate_radius(bend, step, size_v * error);
  const lanes reach_u = 0.5 + lanes_abs(r->u - 0.5), reach_v = 0.5 + lanes_abs(r->v - 0.5);
  const lanes q = size *
                  ((leaf->second[0] + leaf->second[1]) * reach_u + (leaf->second[1] + leaf->second[2]) * reach_v);
  r->alone = r->exists & certificate_alone(q, off);
  r->size = size, r->bend = bend * (step + off), r->off = off;
}

/* newton.c: Newton's process from (u,v) on the lanes of `active`, and the test. */
struct newton_root newton_refine(const struct plane_nets *nets, const struct leaf *leaf, lanes u, lanes v,
                                 lane_mask active);

#endif
