/* A packet: as many rays as a register has lanes, where they look, and what they have found.
 *
 * Internal to src/intersect; included by the sources that are compiled once per instruction set.
 */
#ifndef PSCN_INTERSECT_LANES_PACKET_H
#define PSCN_INTERSECT_LANES_PACKET_H

#include "base/double_lanes.h"
#include "intersect/exact/exact.h"
#include "intersect/lanes/surface.h"
#include "intersect/lanes/names.h"
#include "intersect/tracer.h"

#define NO_PATCH INT64_MAX

enum { ALL_LANES = (1 << LANES) - 1 };

/* Sends for so many bytes, of a size that is known when it is compiled. */
LANES_INLINE void fetch(const void *from, size_t size)
{
  enum { CACHE_LINE = 64 };
#pragma GCC unroll 16
  for (size_t at = 0; at < size; at += CACHE_LINE) __builtin_prefetch((const char *)from + at);
}

/* Roots nearer to the ray's start than this part of their patch's frame want more digits: the last step leaves 2^-72 of the
 * frame. */
#define NEAR_START 0x1p-16

/* Those that the last step leaves if it is taken from there: 2^-100. */
#define NEAREST_START 0x1p-44

/* And so do roots farther from it: the moments of a ray that starts there, in double-double, are no better than 2^-60
 * (MOMENT_ERROR). */
#define FAR_START 0x1p40

/* The best root of every lane. */
struct best {
  lanes u, v, radius_u, radius_v; /* parameters of the whole patch; the exact root is within the radii */
  lanes t;                        /* infinite where there is none */
  lane_mask patch, leaf;          /* where it is; NO_PATCH where there is none. They order roots of equal t */
  lane_mask certain;              /* proven */
  lane_mask final; /* right to the last places, and what follows is set; the others' comes from last_step.h */
  struct surface_point point;
  lanes normal[3];   /* of any length and sense */
  lanes tangent;     /* bound on the derivatives' coordinates that the normal is the product of */
  lane_mask doubt;   /* some unproven root could not be told from t_min, and was left out */
  lane_mask touches; /* the ray starts on a patch: in doubt whatever else is known, in any company */
};

/* Rays in the frame of a patch, as local_ray.h has one of them. */
struct line {
  lanes slope[2], slope_rest[2]; /* 0 on lanes of another axis; slope_rest: what its rounding took away */
  lanes moment[2], moment_rest[2];
  lanes start[2], to_t;
  lanes error;
};

/* What counts as so many of the looks that a ray may take (MOST_LOOKS): a leaf that it meets, whose boxes it passes; besides,
 * one whose slab it does not pass by in doubles, either, so that it is tried, 65,536 of them in all; one that the quadric leaves
 * open, so that dear stages decide it, 4,096 of them; and to make one that is not kept. Where hits are gathered, which take
 * their time themselves, there are so many times as many. */
enum { LOOKS_MET = 4, LOOKS_TRIED = 28, LOOKS_DEAR = 480, LOOKS_MADE = 32, LOOKS_OF_ALL = 4 };

/* What else it may cost: leaves that are left open, after which the others are left open as they are, for the last
 * resort looks at all of a patch's at once (where hits are gathered they are told as known then); the splits of boxes
 * that cover a leaf, after which the last resort has what comes; and the sweeps of methods that find all roots, each as
 * dear as the degree squared, after which boxes have it. */
enum { MOST_OPEN = 512, MOST_OPEN_OF_ALL = 1024, MOST_SPLITS = 1536 };
enum { MOST_SWEEPS = 384 * 18 * 18, MOST_SWEEPS_OF_ALL = 4 * MOST_SWEEPS };

/* How often that is halved for a ray alone, and in the company of others: what comes to a ray and in which order depends on those
 * beside it, so that where its share ends does, too. In company one that takes more than its share, an eighth, is let go, and
 * asked alone (intersect.c). */
enum { SHARE_ALONE = 0, SHARE_IN_COMPANY = 3 };

/* What the lanes leave open, a list a lane. */
struct postponed {
  int share; /* SHARE_ALONE or SHARE_IN_COMPANY */
  int64_t most_looks;
  unsigned most_open;
  /* bit k, of lane k: it has a list; that has most_open leaves; a patch has one region there; the ray goes no further */
  unsigned open, full, merged, let_go;
  unsigned count[LANES];
  lanes cut_from;       /* nothing that begins there or behind is on the list; infinite where all is */
  lane_mask looks;      /* how many more a ray may take; below 0 it goes no further */
  unsigned left[LANES]; /* how many leaves were left open */
  lanes splits;         /* how many more there may be to cover leaves (cover.h) */
  lanes sweeps;         /* how many more there may be over all roots */
  struct exact_region region[LANES][EXACT_REGIONS_MAX];
};

/* Leaves that are put off until all others have been tried, where any hit will do: those that rays start in, which few of them
 * hit, and those that only dear stages decide. Rays that have hit something by then need not be tried on them. */
enum { MOST_LATER = 32 };
struct later {
  unsigned count;
  struct {
    uint32_t leaf;
    unsigned rays; /* of all packets that go together, as bits */
  } at[MOST_LATER];
};

/* Puts the leaf off for these rays; false where there is no room. */
static inline bool later_add(struct later *later, uint32_t leaf, unsigned rays)
{
  unsigned k = 0;
  while (k < later->count && later->at[k].leaf != leaf) k++;
  if (k == MOST_LATER) return false;
  if (k == later->count) later->at[later->count++].leaf = leaf, later->at[k].rays = 0;
  later->at[k].rays |= rays;
  return true;
}

struct packet {
  struct tracer *tracer;
  const struct model *model;
  const struct ray *rays; /* directions scaled to about 1 */
  size_t count;
  /* of the scene's rays, where these are the same in an object's coordinates; else NULL */
  struct packet *outer;
  const struct model_copy *copy;          /* then the object's copy */
  lanes shift;                            /* then t of the scene is shift + t */
  bool any;                               /* any hit will do */
  struct later *later;                    /* where leaves are put off; NULL where they are not, or not any more */
  unsigned first_ray;                     /* there */
  struct gather *gather;                  /* all hits are asked for, and gathered here; else NULL */
  lanes t_end;                            /* then what t_far is, but while a root is taken */
  bool moved;                             /* live or t_far is not what it was */
  lane_mask live;                         /* lanes with a ray that still looks for a hit */
  lanes origin[3], direction[3], longest; /* longest: the largest component of the direction */
  lanes t_min, t_max, t_far;              /* t_far: the nearest hit so far plus its error, or the ray's end */
  /* what control points and rays are off by besides their rounding in a patch's frame */
  double net_error;
  lanes t_error;               /* what that, and the shift, makes of t */
  struct postponed *postponed; /* not used where all hits are asked for */
  uint32_t patch;              /* the one tried last, UINT32_MAX for none */
  bool oriented;               /* by packet_orient, without which nothing of what follows is set: */
  lane_mask on_axis[3];        /* lanes whose dominant axis this is */
  unsigned axes;               /* bit k: some lane's */
  lanes reciprocal[3];         /* of the direction, per axis */
  struct line line[3];         /* per axis; but for the slopes of the patch tried last */
  struct best best;
};

/* The dominant axis of a lane that looks for a hit. */
static inline int packet_axis(const struct packet *p, unsigned lane)
{
  return p->on_axis[0][lane] ? 0 : p->on_axis[1][lane] ? 1 : 2;
}

/* What a packet borrows: copies of its rays where some need scaling, or there are too few and not one; what it leaves
 * open. */
struct ready {
  struct postponed postponed;
  bool copied;
  struct ray copy[LANES];
  int exponent[LANES];
};

/* packet.c: up to LANES rays, none of which has hit anything yet, with that share of work. The packet borrows *ready. */
void packet_begin(struct packet *p, struct ready *ready, struct tracer *tracer, size_t count, const struct ray rays[],
                  bool any, int share);

/* The rays that were let go to be asked alone, as bits: nothing they have left open need be looked at. */
LANES_INLINE unsigned packet_let_go(const struct packet *p)
{
  return p->postponed->share > SHARE_ALONE ? p->postponed->let_go : 0;
}

/* The rays that have left more open than there is room for, or go no further. */
LANES_INLINE unsigned packet_cut_off(const struct packet *p)
{
  return lanes_bits(p->postponed->cut_from < INFINITY) | p->postponed->let_go;
}

/* The rays, that have been tried on nothing yet, have that share of so much. */
LANES_INLINE void packet_set_share(struct postponed *postponed, int share, int looks, int open, int sweeps)
{
  postponed->share = share, postponed->most_looks = looks >> share, postponed->most_open = (unsigned)(open >> share);
  postponed->looks = postponed->most_looks + (lane_mask){0};
  postponed->splits = lanes_all(MOST_SPLITS >> share), postponed->sweeps = lanes_all(sweeps >> share);
}

/* Nothing is left open, and all of the rays' share is there. */
LANES_INLINE void packet_set_ready(struct postponed *postponed, const struct tracer *tracer, int share)
{
  postponed->open = postponed->full = postponed->merged = postponed->let_go = 0,
  postponed->cut_from = lanes_all(INFINITY);
  for (int l = 0; l < LANES; l++) postponed->count[l] = postponed->left[l] = 0;
  packet_set_share(postponed, share, tracer->most_looks, MOST_OPEN, MOST_SWEEPS);
}

/* Takes so many looks from what each of the rays has left; returns what that is then. A mask & a number is that number on the
 * lanes of the mask, 0 on the others. */
LANES_INLINE lane_mask packet_spend(struct packet *p, lane_mask looks) { return p->postponed->looks -= looks; }

/* The largest size of the three. */
LANES_INLINE lanes largest_of(const lanes x[3])
{
  return lanes_max(lanes_max(lanes_abs(x[0]), lanes_abs(x[1])), lanes_abs(x[2]));
}

/* No leaf has been tried on the rays, whose directions and ends are set. */
LANES_INLINE void packet_untried(struct packet *p)
{
  p->longest = largest_of(p->direction);
  p->oriented = p->moved = false, p->patch = UINT32_MAX;
}

/* packet.c: where the rays look, from their directions, and no hit yet. Many packets never come near a leaf: this is
 * done for the first one. */
void packet_orient(struct packet *p);

/* packet.c: turns to the frame of a patch, as local_ray.c makes it for one ray; orients the packet first where no leaf
 * was tried before. */
void packet_set_patch(struct packet *p, const struct model_patch *patch, uint32_t index);

/* Lanes whose root at t, in units of the packet's directions, is nearer to the ray's start than that part of the patch's frame. */
LANES_INLINE lane_mask packet_nearer(const struct packet *p, const struct model_patch *patch, double part, lanes t)
{
  return lanes_abs(t) * p->longest < part * patch->scale;
}

/* Lanes where it is as far as that, and not too far. */
LANES_INLINE lane_mask packet_has_digits(const struct packet *p, const struct model_patch *patch, double from, lanes t)
{
  return ~packet_nearer(p, patch, from, t) & (lanes_abs(t) * p->longest <= FAR_START * patch->scale);
}

/* Lanes whose ray starts exactly in the plane. */
LANES_INLINE lane_mask packet_starts_in(const struct packet *p, const struct flat_plane *plane)
{
  return p->origin[plane->axis] == plane->value;
}

/* Lanes whose ray starts exactly in that control point of the patch, as edge_at numbers them, which is on the ray's line there and
 * nowhere else, and is no hit. */
LANES_INLINE lane_mask packet_starts_at(const struct packet *p, uint32_t patch, int at)
{
  if (p->outer) return (lane_mask){0}; /* in an object's coordinates the start is rounded */
  const double *point = p->model->scene->patches[patch].P[at / 4][at % 4];
  return (p->origin[0] == point[0]) & (p->origin[1] == point[1]) & (p->origin[2] == point[2]) & (p->t_min >= 0);
}

/* candidate.c: tries the leaf, of that patch and number, on the lanes of `active`, and keeps what is nearer than the best. */
void packet_leaf(struct packet *p, struct leaf *leaf, const struct model_patch *patch, uint32_t number,
                 lane_mask active);

/* nearest.c: the rays on these lanes, as bits, go no further: there is more than is known of. */
void packet_give_up(struct packet *p, unsigned worn);

/* nearest.c: in company, rays of `active` whose share of splits or sweeps has ended are let go, for what is done without is not
 * what they would get alone. To be called wherever some are taken. */
void packet_spent(struct packet *p, lane_mask active);

/* copy.c: the rays of `outer` on the lanes of `active`, in the coordinates of the copy's object. */
void packet_enter(struct packet *outer, const struct model_copy *copy, lane_mask active, struct packet *inner);

/* copy.c: what was found there becomes the outer packet's best where it is nearer. */
void packet_leave(struct packet *inner);

/* finish.c: the answers of the packet's rays: from their best roots, improved by a Newton step on the patch itself
 * where they are not right to the last places yet; or by the last resort. t is in units of the scaled direction.
 * Returns how many are not certain. */
unsigned finish_hits(struct packet *p, struct hit out[]);

/* finish.c: the lanes, as bits, whose answers those are not certain and might be others in other company. */
unsigned finish_unsettled(const struct packet *p, const struct hit hits[]);

/* finish.c: the same, of lanes that have nothing open; those of `written` have their answers. */
unsigned finish_best(const struct packet *p, unsigned written, struct hit out[]);

/* finish.c: the rays that hit anything, as bits: the lanes have found it, or what they have left open is hit, or may be. */
unsigned finish_occluded(const struct packet *p);

#endif
