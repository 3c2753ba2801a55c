/* The state of a packet: its rays, one a lane, where they look, and what they have found.
 *
 * Internal to src/intersect; included by the sources that are compiled once per instruction set.
 */
#ifndef PSCN_INTERSECT_PACKET_H
#define PSCN_INTERSECT_PACKET_H

#include "base/double_lanes.h"
#include "intersect/exact/exact.h"
#include "intersect/refine.h"
#include "intersect/surface.h"
#include "intersect/tracer.h"

#define NO_PATCH INT64_MAX

/* Roots nearer to the ray's start than these parts of their patch's frame want more digits: the last step leaves 2^-72
 * of the frame, a root that is final without it the rounding of its leaf's bend. */
#define NEAR_START 0x1p-16
#define NEAR_START_FINAL 0x1p-6

/* The best root of every lane. */
struct best {
  lanes u, v, radius_u, radius_v; /* parameters of the whole patch; the exact root is within the radii */
  lanes t;                        /* infinite where there is none */
  lane_mask patch, leaf;          /* where it is; NO_PATCH where there is none. They order roots of equal t */
  lane_mask certain;             /* proven */
  lane_mask final; /* right to the last places, and what follows is set; the others' comes from last_step.h */
  struct surface_point point;
  lanes normal[3];                  /* of any length and sense */
  lanes tangent;                    /* bound on the derivatives' coordinates that the normal is the product of */
  lane_mask doubt; /* some unproven root could not be told from t_min, and was left out */
};

/* What the lanes leave open, a list a lane. */
struct postponed {
  unsigned cut_off; /* bit k: lane k had more than there is room for */
  unsigned count[LANES];
  struct exact_region region[LANES][EXACT_REGIONS_MAX];
};

/* Lanes where a root at t comes before the best: nearer, or as near to the last bit and of a lower patch or leaf. That
 * orders all roots, so the answer is the same in whatever order they come. */
LANES_INLINE lane_mask best_after(const struct best *best, lanes t, lane_mask patch, lane_mask leaf)
{
  const lane_mask first = (patch < best->patch) | ((patch == best->patch) & (leaf < best->leaf));
  return (t < best->t) | ((t == best->t) & first);
}

/* Takes over a certain root on the lanes of `taken`. */
LANES_INLINE void best_take(struct best *best, lane_mask taken, const lanes at[2], const lanes radius[2], lanes t,
                            lane_mask patch, lane_mask leaf)
{
  best->u = lanes_select(taken, at[0], best->u), best->v = lanes_select(taken, at[1], best->v);
  best->radius_u = lanes_select(taken, radius[0], best->radius_u);
  best->radius_v = lanes_select(taken, radius[1], best->radius_v);
  best->t = lanes_select(taken, t, best->t);
  best->patch = (taken & patch) | (~taken & best->patch), best->leaf = (taken & leaf) | (~taken & best->leaf);
  best->certain |= taken, best->final &= ~taken;
}

struct packet {
  struct tracer *tracer;
  const struct model *model;
  const struct ray *rays; /* directions scaled to about 1 */
  size_t count;
  /* of the scene's rays, where these are the same in an object's coordinates; else NULL */
  struct packet *outer;
  const struct model_copy *copy;  /* then the object's copy */
  lanes shift;                    /* then t of the scene is shift + t */
  bool any;               /* any hit will do */
  bool moved;             /* live or t_far is not what it was */
  lane_mask live;         /* lanes with a ray that still looks for a hit */
  lane_mask on_axis[3];   /* lanes whose dominant axis this is */
  unsigned axes;          /* bit k: some lane's */
  lanes origin[3], direction[3], longest; /* longest: the largest component of the direction */
  lanes slope[3][2], reciprocal[3]; /* per axis; slope 0 on other lanes */
  lanes slope_rest[3][2];           /* what its rounding took away */
  lanes t_min, t_max, t_far;        /* t_far: the nearest hit so far plus its error, or the ray's end */
  /* what control points and rays are off by besides their rounding in a patch's frame */
  double net_error;
  lanes t_error;                    /* what that, and the shift, makes of t */
  struct best best;
  struct postponed *postponed;
  /* The frame of the patch tried last. */
  uint32_t patch;
  struct {
    lanes moment[2], moment_rest[2], start[2], to_t, error;
  } local[3];
};

/* The dominant axis of a lane that looks for a hit. */
static inline int packet_axis(const struct packet *p, unsigned lane)
{
  return p->on_axis[0][lane] ? 0 : p->on_axis[1][lane] ? 1 : 2;
}

/* The lanes' rays in the frame of a patch, as local_ray.c makes it for one ray. */

LANES_INLINE void packet_set_patch(struct packet *p, uint32_t index)
{
  const struct model_patch *patch = &p->model->patches[index];
  lanes hi[3], lo[3];
  const double inverse = 1 / patch->scale;
  for (int k = 0; k < 3; k++) {
    const struct double_lanes from = double_lanes_sum(p->origin[k], lanes_all(-patch->center[k]));
    hi[k] = from.hi * inverse, lo[k] = from.lo * inverse;
  }
  for (int k = 0; k < 3; k++) {
    if (!(p->axes & 1u << k)) continue;
    for (int s = 0; s < 2; s++) {
      const int i = (k + 1 + s) % 3;
      const lanes plus = hi[i] * p->direction[k], minus = hi[k] * p->direction[i];
      const lanes plus_error = lanes_product_error(hi[i], p->direction[k], plus);
      const lanes minus_error = lanes_product_error(hi[k], p->direction[i], minus);
      struct double_lanes sum = double_lanes_sum(plus, -minus);
      sum.lo += (plus_error - minus_error) + (lo[i] * p->direction[k] - lo[k] * p->direction[i]);
      const lanes moment = (sum.hi + sum.lo) * p->reciprocal[k];
      p->local[k].moment[s] = moment;
      p->local[k].moment_rest[s] =
          (sum.lo - lanes_product_error(moment, p->direction[k], sum.hi)) * p->reciprocal[k];
    }
    p->local[k].start[0] = -hi[k], p->local[k].start[1] = -lo[k];
    p->local[k].to_t = patch->scale * p->reciprocal[k];
    p->local[k].error = PLANE_ERROR(lanes_abs(p->local[k].moment[0]), lanes_abs(p->local[k].moment[1])) +
                        2 * p->net_error * inverse;
  }
  p->patch = index;
}

/* packet.c: no hit yet on the rays, of which there are LANES; those from `count` on repeat the first. *postponed, which
 * the packet borrows, is emptied. */
void packet_start(struct packet *p, struct tracer *tracer, const struct ray *rays, size_t count, bool any,
                  struct postponed *postponed);

/* packet.c: where the rays look, from their directions; no hit yet. `live` and the ends are set. */
void packet_orient(struct packet *p);

/* packet.c: tries the leaf on the lanes of `active`, and keeps what is nearer than the best. */
void packet_leaf(struct packet *p, uint32_t index, lane_mask active);

/* packet.c: leaves what is open of the leaf, or of the same leaf of a copy, to the last resort (exact.h). */
void packet_postpone(struct packet *p, const struct leaf *leaf, lane_mask open);

/* copy.c: the rays of `outer` on the lanes of `active`, in the coordinates of the copy's object. */
void packet_enter(struct packet *outer, const struct model_copy *copy, lane_mask active, struct packet *inner);

/* copy.c: what was found there becomes the outer packet's best where it is nearer. */
void packet_leave(struct packet *inner);

/* What is known of a root on a nearly bilinear leaf. Points and derivatives are in the frame of its patch. */
struct leaf_root {
  struct refined at;
  lanes w, t;                   /* place on the ray */
  lanes point[3], su[3], sv[3]; /* derivatives by the leaf's parameters */
};

/* leaf_root.c: a root on a leaf that has parts, on the lanes of `active`: by Newton's process to the last places, and
 * the test. It starts from start[0], start[1], values of u and v, or where `start` is NULL from a root of the resultant
 * of the bilinear part, of degree 2. */
void leaf_root_solve(const struct packet *p, const struct leaf *leaf, int axis, const lanes start[2], lane_mask active,
                     struct leaf_root *out);

/* finish.c: the answers of the packet's rays: from their best roots, improved by a Newton step on the patch itself where
 * they are not right to the last places yet; or by the last resort. t is in units of the scaled direction. Returns how
 * many are not certain. */
unsigned finish_hits(struct packet *p, struct hit out[]);

/* finish.c: whether the lane's ray, on which the lanes have found nothing, hits what they have left open. */
bool finish_occluded(const struct packet *p, unsigned lane);

#endif
