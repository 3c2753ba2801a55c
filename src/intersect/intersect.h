/* Rays against all patches of a scene: closest hit, any hit and all hits, a packet of rays at a time.
 *
 * Build once from a scene, then share between threads; each thread owns one `tracer`, which holds its counters, its
 * scratch memory and its warm starts. No call on a tracer allocates or fails, but tracer_all.
 *
 * What an answer promises (with `polish on`, the default): of all points where the exact ray meets the exact patches, a
 * hit is the nearest with t in (t_min, t_max), or on the first of the patches that it is that near on (exact/ties.c); a miss
 * has none. `certain` means this is proven; `grazing` means that
 * the answer can be turned by a change of the input within the rounding bound of the evaluation (a tangency, the border
 * of an open surface, a coincident component): then a hit is reported where a hit cannot be excluded, but for one that
 * 113 bits cannot tell from t_min or t_max, which is left out. Corners and poles are given points: the nearest hit is certain
 * where the ray meets one exactly, though the surface is open there; of all hits it is grazing then, for how many patches are
 * met in that point means nothing. The answer to a ray does not depend on the rays it
 * shares a packet with, but for last places where another hit is so near that double precision cannot tell which comes
 * first; for these, and whether it is certain, where what it passes before its hit or behind it takes all of its share
 * of work; and with `start previous`.
 */
#ifndef PSCN_INTERSECT_INTERSECT_H
#define PSCN_INTERSECT_INTERSECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/team.h"
#include "scene/scene.h"

enum { PACKET_SIZE = 16 };

struct ray {
  double origin[3];
  double direction[3]; /* any length > 0, finite */
  /* in units of |direction|: points origin + t direction, 0 <= t_min < t < t_max. Where no double lies between the two t of
   * a hit is t_max */
  double t_min, t_max;
};

enum certainty { CERTAINTY_CERTAIN, CERTAINTY_GRAZING };

enum { HIT_NONE = UINT32_MAX };

struct hit {
  uint32_t patch; /* index into scene.patches, or HIT_NONE: a miss, and then only certainty is written too */
  enum certainty certainty;
  double t;           /* in units of |direction| */
  double u, v;        /* parameters of the whole patch, in [0,1] */
  double point[3];    /* S(u,v) */
  double point_error; /* absolute bound on the distance from `point` to the exact patch */
  /* how far from `point` off the surface a ray must start to be told from one that starts on it */
  double clearance;
  double normal[3]; /* unit, facing the ray's origin */
};

/* Every hit of one ray, in order of t. A point of a border that patches share is one hit where the ray crosses the
 * surface there, and so is a pole, or a corner of several patches; its patch is the first of them in the scene.
 * Surfaces that lie on each other are a hit each, the first in the scene first.
 *
 * `certain`: it is proven that there are `count` hits, each of them listed, and that this is their order; so a ray
 * whose t_max is infinite starts inside a closed surface where `count` is odd, and outside where it is even. `grazing`:
 * not proven, for the ray touches a surface, an open border or a crease from outside, or starts or ends on a surface,
 * nearer than 113 bits can tell; then the list has what is proven, and what may be a hit as well: their own certainty
 * tells them apart. */
struct hit_list {
  enum certainty certainty;
  size_t count;
  const struct hit *hits; /* hits[0..count-1], the tracer's; they are gone at its next call of tracer_all */
};

/* The stages of a ray and a leaf whose box it passes (lanes/candidate.h). */
enum stage {
  STAGE_BILINEAR,  /* the resultant of degree 2 of the leaf's bilinear part, and its quadric */
  STAGE_PLANES,    /* hulls of the plane polynomials */
  STAGE_RESULTANT, /* the resultant of full degree is formed */
  STAGE_ROOTS,     /* its roots are sought */
  STAGE_COUNT
};

struct intersect_counts {
  uint64_t rays[2];        /* closest-hit and all-hits rays, any-hit rays */
  uint64_t patches_tested; /* ray-leaf pairs that reached the algebra */
  uint64_t roots_found, roots_accepted;
  uint64_t stages[STAGE_COUNT]; /* ray-leaf pairs that came to each */
  uint64_t escalated;           /* ray-leaf pairs left to the last resort (exact/exact.h) */
  uint64_t work;                /* of the last resort, in boxes that it might have looked at */
  uint64_t certain, grazing;    /* answers by certainty, not of any-hit rays */
};

struct intersector;
struct tracer;

/* Whether the instruction set that the environment variable PSCN_KERNEL asks for (baseline, avx2, avx512 or avx512_narrow;
 * none: the best there is) is one that this processor has and the program was built with. */
bool intersector_kernel_here(void);

/* Of which kind that one's arithmetic is: "fused" or "baseline", as products are rounded that are added to, and what it was
 * compiled for and by, such as "fused, x86_64, GNU 12". Those of one kind answer alike to the last bit. */
const char *intersector_arithmetic(void);

/* Prepares the scene: degrees, leaves, bounding hierarchy. Borrows the scene, which must outlive it.
 * STATUS_LIMIT where memory is short, STATUS_USAGE where PSCN_KERNEL asks for what is not here; then *out is NULL. */
enum status intersector_create(const struct scene *scene, struct intersector **out) STATUS_MUST_CHECK;

/* The same by a team of threads, where there is enough to do; NULL for none. Answers are those of any other number of
 * threads, to the last bit. STATUS_LIMIT also where threads are short. */
enum status intersector_create_by(const struct scene *scene, const struct team *team,
                                  struct intersector **out) STATUS_MUST_CHECK;
void intersector_destroy(struct intersector *intersector);

enum status tracer_create(const struct intersector *intersector, struct tracer **out) STATUS_MUST_CHECK;
void tracer_destroy(struct tracer *tracer);

/* Forgets the warm starts of `start previous`. The renderer calls it at the start of every tile, so that a picture
 * depends neither on threads nor on the crop. */
void tracer_forget(struct tracer *tracer);

/* The nearest hit of each of `count` <= PACKET_SIZE rays. */
void tracer_closest(struct tracer *tracer, size_t count, const struct ray rays[], struct hit out_hits[]);

/* Whether anything is hit by each of `count` <= PACKET_SIZE rays, or may be hit beyond its share of work. */
void tracer_occluded(struct tracer *tracer, size_t count, const struct ray rays[], bool out_occluded[]);

/* All hits of each of `count` <= PACKET_SIZE rays. The first hit of a certain list is the nearest hit, which may
 * differ in last bits from that of tracer_closest. STATUS_LIMIT where memory is short; then *out means nothing. */
enum status tracer_all(struct tracer *tracer, size_t count, const struct ray rays[],
                       struct hit_list out[]) STATUS_MUST_CHECK;

/* An origin for a ray that leaves the surface at `hit` along `direction`: moved off the surface by the clearance, to
 * the side that `direction` points to. It meets neither the sheet it leaves nor skips one beyond. */
void hit_leave(const struct hit *hit, const double direction[3], double out_origin[3]);

const struct intersect_counts *tracer_counts(const struct tracer *tracer);

#endif
