/* A packet: as many rays as a register has lanes, where they go, and what they have found.
 *
 * Internal to src/intersect; included by the sources that are compiled once per instruction set.
 */
#ifndef PSCN_INTERSECT_LANES_PACKET_H
#define PSCN_INTERSECT_LANES_PACKET_H

#include <assert.h>
#include <stddef.h>

#include "base/double_lanes.h"
#include "intersect/exact/exact.h"
#include "intersect/lanes/names.h"
#include "intersect/tracer.h"

#define NO_PATCH INT64_MAX

enum { ALL_LANES = (1 << LANES) - 1 };

/* Rays and hits are read and written four doubles at a time: a ray as origin and direction, t_min, t_max; a hit as its
 * patch and certainty together, t, u, v; the point and its error; the clearance and the normal. */
enum { RAY_STRIDE = sizeof(struct ray) / sizeof(double), HIT_STRIDE = sizeof(struct hit) / sizeof(double) };
static_assert(RAY_STRIDE == 8 && offsetof(struct ray, direction) == 3 * sizeof(double) &&
                offsetof(struct ray, t_min) == 6 * sizeof(double) && HIT_STRIDE == 12 &&
                offsetof(struct hit, t) == sizeof(double) && offsetof(struct hit, point) == 4 * sizeof(double) &&
                offsetof(struct hit, clearance) == 8 * sizeof(double) &&
                offsetof(struct hit, normal) == 9 * sizeof(double),
              "read by fours");

/* Prefetches `size` bytes, a number known at compile time. */
LANES_INLINE void fetch(const void *from, size_t size)
{
  enum { CACHE_LINE = 64 };
#pragma GCC unroll 16
  for (size_t at = 0; at < size; at += CACHE_LINE) __builtin_prefetch((const char *)from + at);
}

/* Roots nearer to the ray's start than this part of their patch's frame need more digits than their leaf gives. All
 * roots of rays between small things on a wide floor are as near. */
#define NEAR_START 0x1p-16

/* The last step on control points relative to the start, right to 2^-100, is enough for roots as near as this. */
#define NEAREST_START 0x1p-44

/* Roots farther from the start than this need more digits, too: the moments of such a ray, in double-double, are no
 * better than 2^-60 (MOMENT_ERROR). */
#define FAR_START 0x1p40

/* A point in the scene, with its error and clearance as in struct hit, and its normal. */
struct surface {
  lanes at[3], error, clearance;
  lanes normal[3]; /* of any length and sense */
  lanes tangent;   /* bound on the coordinates of the derivatives whose product is the normal */
};

/* Sets it from a point in the patch's frame and its derivatives; `scale` times these are by the patch's parameters. */
LANES_INLINE void surface_set(const struct model_patch *patch, const lanes local[3], const lanes su[3],
                              const lanes sv[3], double scale, struct surface *out)
{
  lanes magnitude = lanes_all(0);
  out->tangent = lanes_all(0);
  for (int c = 0; c < 3; c++) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    out->normal[c] = su[i] * sv[j] - su[j] * sv[i];
    out->tangent = lanes_max(lanes_abs(su[c]) + lanes_abs(sv[c]), out->tangent);
    out->at[c] = patch->center[c] + patch->scale * local[c];
    magnitude = lanes_max(lanes_abs(out->at[c]), magnitude);
  }
  out->error = POINT_ERROR(patch->scale, scale * out->tangent, magnitude);
  out->clearance = out->error + CLEARANCE(patch->scale, patch->cut.loose, magnitude);
}

/* The best root of every lane. */
struct best {
  lanes u, v, radius_u, radius_v; /* parameters of the whole patch; the exact root is within the radii */
  lanes t;                        /* infinite: none */
  lane_mask patch, leaf;          /* where it is, NO_PATCH: nowhere; they order roots of equal t */
  lane_mask certain;              /* proven */
  lane_mask final;                /* right to the last places, and `surface` is set; others get theirs from last_step */
  struct surface surface;
  lane_mask doubt; /* unsure: a root near t_min was left out unproven, or the budget was exhausted */
};

/* Rays in the frame of a patch; local_ray.h describes one of them. */
struct line {
  lanes slope[2], slope_rest[2]; /* 0 on lanes of another axis; slope_rest: what rounding the slope took away */
  lanes moment[2], moment_rest[2];
  lanes start[2], to_t;
  lanes error;
};

/* What is left of the rays' budgets, and what the lanes leave open: a list for each lane, with one region a patch. */
struct postponed {
  lane_mask left;           /* of the budget; below 0 it is exhausted */
  unsigned open, exhausted; /* bit k is of lane k: it has a list; its budget did not suffice */
  unsigned count[LANES];
  lanes cut_from; /* nothing that begins at or behind this t is on the list; infinite: the list is complete */
  struct exact_region region[LANES][EXACT_REGIONS_MAX];
};

struct packet {
  struct tracer *tracer;
  const struct model *model;
  const struct ray *rays; /* directions scaled to about 1 */
  size_t count;
  /* the packet of the scene's rays, if these are the same rays in an object's coordinates; else NULL */
  struct packet *outer;
  const struct model_copy *copy;          /* if so, the object's copy */
  lanes shift;                            /* if so, t of the scene is shift + t */
  bool any;                               /* any hit will do */
  struct gather *gather;                  /* all hits are wanted, and gathered here; else NULL */
  lanes t_end;                            /* if so, the value of t_far, except while a root is taken */
  bool moved;                             /* live or t_far has changed */
  lane_mask live;                         /* lanes whose ray still seeks a hit */
  lanes origin[3], direction[3], longest; /* longest: the largest component of the direction */
  lanes t_min, t_max, t_far;              /* t_far: the nearest hit so far plus its error, or the ray's end */
  /* error of control points and rays, besides their rounding in a patch's frame */
  double net_error;
  lanes t_error;               /* error of t that this and the shift cause */
  struct postponed *postponed; /* not used if all hits are wanted */
  uint32_t patch;              /* of the last leaf tried; UINT32_MAX: none */
  bool oriented;               /* packet_orient has run; before, the members below are not set */
  lane_mask on_axis[3];        /* lanes with this dominant axis */
  unsigned axes;               /* bit k: some lane has axis k */
  lanes reciprocal[3];         /* of the direction, per axis */
  struct line line[3];         /* per axis; all but the slopes belong to the patch tried last */
  struct best best;
};

/* The packet of the scene's rays. */
static inline const struct packet *packet_scene(const struct packet *p) { return p->outer ? p->outer : p; }

/* The leaf's patch in the scene. */
static inline uint32_t packet_patch(const struct packet *p, const struct leaf *leaf)
{
  return leaf->patch + (p->outer ? p->copy->first_patch : 0);
}

/* The dominant axis of a lane that seeks a hit. */
static inline int packet_axis(const struct packet *p, unsigned lane)
{
  return p->on_axis[0][lane] ? 0 : p->on_axis[1][lane] ? 1 : 2;
}

/* Storage that a packet borrows: what it leaves open, and copies of its rays if some need scaling, or if they are fewer
 * than LANES but more than one. */
struct ready {
  struct postponed postponed;
  bool copied;
  struct ray copy[LANES];
  int exponent[LANES];
};

/* packet.c: loads up to LANES rays, none of which has hit anything yet, each with that budget. The packet borrows
 * *ready. */
void packet_begin(struct packet *p, struct ready *ready, struct tracer *tracer, size_t count, const struct ray rays[],
                  bool any, int budget);

/* As bits, the rays that have left more open than there is room for, or have exhausted their budgets. */
LANES_INLINE unsigned packet_cut_off(const struct packet *p)
{
  return lanes_bits(p->postponed->cut_from < INFINITY) | p->postponed->exhausted;
}

/* What the lane leaves to the last resort, with what is left of its ray's budget; at least a sixteenth, so that the
 * nearest hit is sought though the lanes have used up all. */
static inline struct exact_case packet_case(const struct packet *p, unsigned lane)
{
  struct postponed *postponed = p->postponed;
  const struct growing *gathered = p->gather ? &p->gather->lane[lane].regions : NULL;
  const int64_t left = postponed->left[lane], least = p->tracer->budget / 16;
  return (struct exact_case){.model = p->model,
                             .ray = &p->rays[lane],
                             .regions = gathered ? gathered->at : postponed->region[lane],
                             .region_count = gathered ? gathered->count : postponed->count[lane],
                             .cut_from = postponed->cut_from[lane],
                             .work = &p->tracer->counts.work,
                             .limit = (uint64_t)(left > least ? left : least) / COST_EXACT};
}

/* Charges each ray that cost: (a mask & a number is that number on the lanes of the mask, and 0 on the others). The
 * walk checks whether anything is left. */
LANES_INLINE void packet_charge(const struct packet *p, lane_mask cost) { p->postponed->left -= cost; }

/* The largest absolute value of the three. */
LANES_INLINE lanes largest_of(const lanes x[3])
{
  return lanes_max(lanes_max(lanes_abs(x[0]), lanes_abs(x[1])), lanes_abs(x[2]));
}

/* Marks the packet as tried on no leaf. Directions and ends are set. */
LANES_INLINE void packet_untried(struct packet *p)
{
  p->longest = largest_of(p->direction);
  p->oriented = p->moved = false, p->patch = UINT32_MAX;
}

/* packet.c: sets what follows from the rays' directions, and that there is no hit yet. Done for the first leaf, because
 * many packets never come near one. */
void packet_orient(struct packet *p);

/* packet.c: sets the lines in the frame of a patch. Orients the packet first, if no leaf was tried before. */
void packet_set_patch(struct packet *p, const struct model_patch *patch, uint32_t index);

/* Lanes whose root at t, in units of the packet's directions, is nearer to the ray's start than `part` of the patch's
 * frame. */
LANES_INLINE lane_mask packet_nearer(const struct packet *p, const struct model_patch *patch, double part, lanes t)
{
  return lanes_abs(t) * p->longest < part * patch->scale;
}

/* Lanes whose root is at least `from` of the frame away, and no farther than FAR_START. */
LANES_INLINE lane_mask packet_has_digits(const struct packet *p, const struct model_patch *patch, double from, lanes t)
{
  return ~packet_nearer(p, patch, from, t) & (lanes_abs(t) * p->longest <= FAR_START * patch->scale);
}

/* The lane's best root. */
static inline struct exact_root packet_root(const struct packet *p, unsigned lane)
{
  const struct best *best = &p->best;
  return (struct exact_root){.patch = (uint32_t)best->patch[lane],
                             .u = best->u[lane],
                             .v = best->v[lane],
                             .t = best->t[lane],
                             .radius_u = best->radius_u[lane],
                             .radius_v = best->radius_v[lane],
                             .t_error = p->t_far[lane] - best->t[lane]};
}

/* Lanes where a root at t comes before the best: it is nearer, or at the same t to the last bit and of a lower patch or
 * leaf. This orders all roots, so the answer does not depend on the order in which they come. */
LANES_INLINE lane_mask best_after(const struct best *best, lanes t, lane_mask patch, lane_mask leaf)
{
  const lane_mask first = (patch < best->patch) | ((patch == best->patch) & (leaf < best->leaf));
  return (t < best->t) | ((t == best->t) & first);
}

/* Lanes of `where` on which a and b are two patches of the scene with one surface: the ray meets both at one t. */
LANES_INLINE lane_mask one_surface(const struct model *model, lane_mask a, lane_mask b, lane_mask where)
{
  lane_mask one = {0};
  if (!model->surface) return one;
  for (unsigned bits = lanes_bits(where & (a != b) & (a != NO_PATCH) & (b != NO_PATCH)); bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    const uint32_t surface = model->surface[a[l]];
    if (surface != 0 && surface == model->surface[b[l]]) one |= lanes_mask(bits & -bits);
  }
  return one;
}

/* Makes a certain root the best on the lanes of `taken`. */
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

/* candidate.c: tries the leaf, with this patch and number, on the lanes of `active`, and keeps roots that come before
 * the best. */
void packet_leaf(struct packet *p, struct leaf *leaf, const struct model_patch *patch, uint32_t number,
                 lane_mask active);

/* nearest.c: the rays on these lanes, as bits, go no further, because their budgets are exhausted. */
void packet_exhaust(struct packet *p, unsigned exhausted);

/* nearest.c: postpones the copy's patch that the best root of these lanes is in. */
void packet_postpone_best(struct packet *p, lane_mask open);

/* copy.c: sets up *inner, the rays of `outer` on the lanes of `active` in the coordinates of the copy's object. */
void packet_enter(struct packet *outer, const struct model_copy *copy, lane_mask active, struct packet *inner);

/* copy.c: takes over what was found there into the outer packet, where it is nearer. */
void packet_leave(struct packet *inner);

/* finish.c: writes the answers of the packet's rays. The last resort decides some; the others come from the best roots,
 * improved by a Newton step on the patch itself unless they are right to the last places already. t is in units of the
 * scaled direction, times 2^-exponents[lane] if `exponents` is not NULL. Returns, as bits, the lanes whose answers are
 * not certain. */
unsigned finish_hits(struct packet *p, const int *exponents, struct hit out[]);

/* finish.c: finish_hits, without exponents, for lanes that have nothing open; those of `written` have their answers
 * already. */
unsigned finish_best(const struct packet *p, unsigned written, struct hit out[]);

/* finish.c: writes which rays hit anything: they have found a hit, or something left open is a hit or may be. Returns,
 * as bits, those whose budgets were exhausted, or that left more open than there is room for. */
unsigned finish_occluded(const struct packet *p, bool out[]);

/* gather.c: has the packet, which has just been started, gather there, beginning with nothing. */
void gather_start(struct packet *p, struct gather *gather);

/* gather.c: adds the packet's best roots, which were just taken on the lanes of `taken`, with their answers. Then there
 * is no best again. */
void gather_best(struct packet *p, lane_mask taken);

/* gather.c: leaves a patch of the scene to the last resort on that lane. */
void gather_postpone(struct packet *p, uint32_t patch, unsigned lane);

/* gather.c: writes the lists of the packet's rays, and adds their hits to tracer->hits. t is as from finish_hits.
 * Returns, as bits, the lanes whose lists are not certain. */
unsigned gather_finish(struct packet *p, const int *exponents, struct list_place out[]);

/* leave.c: the kernel's `leave`. */
struct left leave_some(size_t count, const struct ray rays[], const struct hit hits[], const struct leaving *to,
                       struct ray out[]);

#endif
