/* Rays against all patches of a scene: closest hit, any hit and all hits, a packet of rays at a time.
 *
 * Create one intersector for a scene and share it between threads. Each thread owns a `tracer`, which holds its
 * counters, its scratch memory and its warm starts. No call on a tracer but tracer_all allocates or fails.
 *
 * With `polish on`, the default, a hit is the nearest of all points with t in (t_min, t_max) where the exact ray meets
 * the exact patches, borders included. Of patches that are equally near the first is reported. A miss means that there
 * is no such point. `certain` means that this is proven. `grazing` means that it is not: the ray touches a surface
 * exactly, lies in one, or passes so near such a place that its share of work does not suffice. A hit is then reported
 * if one cannot be excluded. A corner or a pole that the ray meets exactly is a certain hit, even where the surface is
 * open there, and so is a border in one plane with the ray, or where u and v are multiples of 2^-16; at other places
 * exactly on a border, or within some 2^-160 of the patch from there, the ray is grazing. At an open border a list of
 * all hits is grazing in any case, because it does not follow on which side of the surface the ray is.
 *
 * The answer to a ray does not depend on the other rays of its packet, with these exceptions: its last places, if
 * another hit is so near that double precision does not show which comes first; its last places and its certainty, if
 * what it passes before or behind its hit takes all of its share of work; and answers with `start previous`.
 */
#ifndef PSCN_INTERSECT_INTERSECT_H
#define PSCN_INTERSECT_INTERSECT_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/team.h"
#include "scene/scene.h"

enum { PACKET_SIZE = 16 };

struct ray {
  double origin[3];
  double direction[3]; /* any length > 0; all numbers but t_max are 0 or from 1e-100 to 1e100 in size */
  /* in units of |direction|: points origin + t direction, 0 <= t_min < t < t_max. If no double lies between the two, t
   * of a hit is t_max */
  double t_min, t_max;
};

enum certainty { CERTAINTY_CERTAIN, CERTAINTY_GRAZING };

enum { HIT_NONE = UINT32_MAX };

struct hit {
  uint32_t patch; /* index into scene.patches, or HIT_NONE: a miss, for which only certainty is written, too */
  enum certainty certainty;
  double t;           /* in units of |direction| */
  double u, v;        /* parameters of the whole patch, in [0,1] */
  double point[3];    /* S(u,v) */
  double point_error; /* absolute bound on the distance from `point` to the exact patch */
  /* how far off the surface a ray must start to be distinct from one that starts on it (tracer_leave) */
  double clearance;
  double normal[3]; /* unit, facing the ray's origin */
};

/* Every hit of one ray, in order of t. A point of a border that patches share is one hit if the ray crosses the surface
 * there, and so is a pole, or a corner of several patches; its patch is the first of them in the scene. Surfaces that
 * lie on each other are one hit each, the first in the scene first.
 *
 * `certain`: it is proven that there are `count` hits, that each is listed, and that this is their order. So a ray
 * whose t_max is infinite starts inside a closed surface if `count` is odd, and outside if it is even. `grazing`: not
 * proven, because the ray touches a surface or a crease from outside, meets an open border, a corner whose borders are
 * on one line or nearly so, or a place where the nearest hit would be grazing, or its share of work did not suffice.
 * The list then has the proven hits and the possible ones, which are grazing themselves. */
struct hit_list {
  enum certainty certainty;
  size_t count;
  const struct hit *hits; /* hits[0..count-1], owned by the tracer; valid until its next call of tracer_all */
};

/* The stages of a candidate: a ray and a leaf whose box it passes (lanes/candidate.h). */
enum stage {
  STAGE_BILINEAR,  /* the resultant of degree 2 of the leaf's bilinear part */
  STAGE_PLANES,    /* the planes' polynomials are set, and pieces of the leaf examined */
  STAGE_RESULTANT, /* the resultant of full degree is formed */
  STAGE_ROOTS,     /* the roots of the resultant are sought */
  STAGE_COUNT
};

struct intersect_counts {
  uint64_t rays[2];        /* closest-hit and all-hits rays, any-hit rays */
  uint64_t patches_tested; /* candidates that reached the algebra */
  uint64_t roots_found, roots_accepted;
  uint64_t stages[STAGE_COUNT]; /* candidates that came to each */
  uint64_t escalated;           /* candidates left to the last resort (exact/exact.h) */
  uint64_t work;                /* of the last resort, in pieces that it might have examined */
  uint64_t certain, grazing;    /* answers by certainty, except of any-hit rays */
};

struct intersector;
struct tracer;

/* Whether this processor and this program have the instruction set that the environment variable PSCN_KERNEL names
 * (baseline, avx2 or avx512; none: the best there is). */
bool intersector_kernel_here(void);

/* The kind of that set's arithmetic, "fused" or "baseline" by whether products are rounded before they are added to,
 * and the processor and compiler that it was built for and by, such as "fused, x86_64, GNU 12". Equal kinds answer
 * alike to the last bit. */
const char *intersector_arithmetic(void);

/* Prepares the scene: degrees, leaves, bounding hierarchy. Borrows the scene, which must outlive the intersector.
 * STATUS_LIMIT if memory is short, STATUS_USAGE if PSCN_KERNEL asks for a set that is not here; *out is then NULL. */
enum status intersector_create(const struct scene *scene, struct intersector **out) STATUS_MUST_CHECK;

/* The same by a team of threads, if there is enough to do; NULL for none. Answers do not depend on the number of
 * threads, to the last bit. STATUS_LIMIT also if threads are short. */
enum status intersector_create_by(const struct scene *scene, const struct team *team,
                                  struct intersector **out) STATUS_MUST_CHECK;
void intersector_destroy(struct intersector *intersector);

/* Whether patches have fewer leaves than their `split` says, because memory was short. */
bool intersector_cut_less(const struct intersector *intersector);

enum status tracer_create(const struct intersector *intersector, struct tracer **out) STATUS_MUST_CHECK;
void tracer_destroy(struct tracer *tracer);

/* Forgets the warm starts of `start previous`. The renderer calls it at the start of every tile, so that a picture
 * depends neither on threads nor on the crop. */
void tracer_forget(struct tracer *tracer);

/* From when *stop is not 0 on, the tracer ends its work as soon as it can, and its answers mean nothing. Borrowed. */
void tracer_stop_at(struct tracer *tracer, const atomic_int *stop);

/* The nearest hit of each of `count` <= PACKET_SIZE rays. */
void tracer_closest(struct tracer *tracer, size_t count, const struct ray rays[], struct hit out_hits[]);

/* Whether each of `count` <= PACKET_SIZE rays hits anything, or may hit something beyond its share of work. */
void tracer_occluded(struct tracer *tracer, size_t count, const struct ray rays[], bool out_occluded[]);

/* All hits of each of `count` <= PACKET_SIZE rays. The first hit of a certain list is the nearest hit; it may differ in
 * its last bits from that of tracer_closest. STATUS_LIMIT if memory is short; *out then means nothing. */
enum status tracer_all(struct tracer *tracer, size_t count, const struct ray rays[],
                       struct hit_list out[]) STATUS_MUST_CHECK;

/* The origin of a ray that leaves the surface at the `hit` of `ray` along `direction`, such as a shadow ray: a point of
 * `ray` itself from which the surface is `clearance` away. If `direction` points to the normal's side, the point is
 * before the hit, or where the ray starts if that is nearer. Nothing is between, so it is in the same cell of space as
 * the ray's start, even where surfaces meet at an acute angle; a point beside the hit need not be.
 *
 * Proven for a certain hit. The exact point is before the exact hit, at a t that is one of doubles. Each coordinate of
 * *out_origin is that of the point rounded, and one or two doubles nearer to the ray's start: off it by e <= 2^-51 of
 * itself, while the clearance is at least 128 e. So *out_origin is in the same cell unless another surface comes within
 * sqrt(3) e of that point, which no plane across an axis does that the ray meets later, nor any other if the ray meets
 * it at or behind the hit under an angle whose sine is 1/64 of the hit's or more. Next to a border of the patch, where
 * such a surface may be expected, the view from *out_origin back to the ray's start is traced, and a start farther back
 * is taken until nothing is in it. That proves that the cell is the same, but for what is within e of the ray's start.
 *
 * Not proven: where surfaces of other patches pass through this one, or nearly touch it, at an angle to the ray as
 * small as said; in rooms no wider than the clearance; behind the hit, if `direction` points to the other side; for
 * grazing hits, for which the start is taken from `point`, because a solver's bare root may be off the ray. */
void tracer_leave(struct tracer *tracer, const struct ray *ray, const struct hit *hit, const double direction[3],
                  double out_origin[3]);

/* Rays that leave `count` <= PACKET_SIZE hits of `rays` for a point, such as shadow rays, from t = 0 to `end`; the
 * point is at t = 1. If a ray would start at the very point, it goes the way from the hit. Returns as bits those with a
 * hit on whose normal's side the point is; the others of `out` mean nothing. */
unsigned tracer_leave_for(struct tracer *tracer, size_t count, const struct ray rays[], const struct hit hits[],
                          const double point[3], double end, struct ray out[]);

const struct intersect_counts *tracer_counts(const struct tracer *tracer);

#endif
