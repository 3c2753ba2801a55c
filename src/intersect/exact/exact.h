/* The last resort: decides what one ray meets, for it alone, slowly and to the end.
 *
 * Internal to src/intersect. Compiled once, scalar, without contraction: its answers are the same bits on every
 * processor. Pure; safe on any thread; uses up to 1.25 MB of stack, for searches within searches. To use it, fill in an
 * exact_case and call exact_closest, exact_occluded or exact_all; exact_root_hit and exact_maybe_hit make the answers.
 *
 * The lanes take a root only where double precision leaves no question: the root is proven, strictly inside its patch,
 * strictly within the ray's range, and not next to another one. Everything they leave open comes here as a list of
 * regions (leaves, or parts of a patch cut for a copy). The regions are searched in the order in which the ray meets
 * them, whatever order the lanes left them in. Where doubles cannot tell on which side of something a root lies, wide
 * arithmetic is used.
 */
#ifndef PSCN_INTERSECT_EXACT_EXACT_H
#define PSCN_INTERSECT_EXACT_EXACT_H

#include <math.h>
#include <stdbool.h>

#include "base/wide.h"
#include "intersect/intersect.h"
#include "intersect/model.h"

/* A part of a patch: a rectangle of leaves, of which patch->cut.split make a side of the patch. */
struct exact_region {
  const struct leaf *leaf; /* its leaf; NULL for several, one that is not kept, or a copy without any */
  uint32_t patch;          /* index into the scene's patches */
  uint16_t column[2];      /* along u, v: the first one; span: how many */
  uint16_t span[2];
  double near; /* nothing open here begins before this t; set unless all hits are asked for */
};

/* A proven root, in parameters of the whole patch: the exact ray has exactly one root within the radii. */
struct exact_root {
  uint32_t patch;
  bool sharp;                /* refined as far as wide arithmetic allows */
  wide u, v, t;              /* t in units of the scaled direction */
  double radius_u, radius_v; /* absolute */
  double t_error;            /* absolute */
  /* of a sharp root: the patch has no other root whose parameters both lie within this of its own */
  double alone;
  bool well_known; /* t also has the accuracy that TIE_ERRORS (sharpen.c) asks for */
};

/* A certain hit has its parameters to this accuracy. */
#define LARGEST_RADIUS 0x1p-20

static inline bool exact_root_placed(const struct exact_root *root)
{
  return root->radius_u <= LARGEST_RADIUS && root->radius_v <= LARGEST_RADIUS;
}

/* Whether two roots of one patch may be the same. */
static inline bool exact_roots_meet(const struct exact_root *a, const struct exact_root *b)
{
  return fabs((double)(a->u - b->u)) <= a->radius_u + b->radius_u &&
         fabs((double)(a->v - b->v)) <= a->radius_v + b->radius_v;
}

static inline bool exact_region_equal(const struct exact_region *a, const struct exact_region *b)
{
  return a->patch == b->patch && a->column[0] == b->column[0] && a->column[1] == b->column[1] &&
         a->span[0] == b->span[0] && a->span[1] == b->span[1];
}

/* regions.c: extends the region to the least rectangle of leaves that holds both; both are of one patch. */
void exact_region_join(struct exact_region *region, const struct exact_region *other);

/* A place that may be a hit or not: a point of a patch, its t, and how far off that t may be. */
struct exact_maybe {
  uint32_t patch;
  unsigned borders; /* of the patch, on which the point lies; bits as of geometry/edges.h */
  double u, v, t, t_error;
};

/* The most regions of a ray whose nearest hit is asked for. If there are more, each patch has one; of still more
 * patches, those that begin first are listed. */
enum { EXACT_REGIONS_MAX = 128 };

/* What a search finds on a ray. */
enum exact_kind {
  EXACT_INSIDE, /* a root strictly inside its patch */
  EXACT_BORDER, /* a root that even wide arithmetic cannot tell from borders of its patch, or a pole that is met */
  EXACT_OPEN    /* a place that may be a hit or not */
};

struct exact_found {
  struct exact_root root; /* of an open one only u, v, t and t_error */
  enum exact_kind kind;
  unsigned borders; /* bits as of geometry/edges.h */
  int64_t taken;    /* number of the lanes' root that it is; negative: none of theirs */
  bool tied;        /* made sharp to tell it from another surface's, so its answer must be sharp too */
  wide least;       /* in a sorted list: lower bound on t of this one and all behind it, errors included */
};

/* A list that grows by memory_grow unless it is fixed. Zero-initialise it; memory_free `at`. */
struct exact_list {
  struct exact_found *at;
  size_t count, room;
  bool fixed, failed; /* failed: memory was short, and something is missing */
};

/* What is asked. */
struct exact_case {
  const struct model *model;
  const struct ray *ray;           /* direction scaled to about 1 */
  const struct exact_root *known;  /* the nearest root that the lanes took; NULL for none */
  const struct exact_maybe *maybe; /* the same if it is not proven; NULL for none */
  struct exact_region *regions;    /* in any order; the call reorders and joins them */
  size_t region_count;
  double cut_from; /* neither what was left out nor a doubt begins before this t; infinite for none */
  uint64_t *work;  /* the work done is added, in boxes examined (judge.h) */
  uint64_t limit;  /* no more of it may be done */
};

enum exact_verdict {
  EXACT_MISS,
  EXACT_ROOT, /* the root is the nearest hit */
  EXACT_MAYBE /* the point may be the nearest hit */
};

struct exact_decision {
  enum exact_verdict verdict;
  bool sure;                /* proven; never so for a maybe */
  struct exact_root root;   /* set with EXACT_ROOT */
  struct exact_maybe maybe; /* set with EXACT_MAYBE */
};

/* The nearest hit of the ray. */
void exact_closest(const struct exact_case *asked, struct exact_decision *out);

/* all.c: finds all hits of the ray. At first *list holds the roots that the lanes took; in the end it holds the hits in
 * their order: roots inside patches, and open places. `known`, `maybe` and `cut_from` are not used, and the number of
 * regions has no limit. Returns whether the result is proven. */
bool exact_all(const struct exact_case *asked, struct exact_list *list);

/* all.c: returns false if there was no room. */
bool exact_list_add(struct exact_list *list, const struct exact_found *found);

/* Whether the ray hits anything, or may do so. */
bool exact_occluded(const struct exact_case *asked);

/* answer.c: the hit at a proven root, refined as far as wide arithmetic allows, or at a point that may be one. t is in
 * units of the scaled direction. */
void exact_root_hit(const struct model *model, const struct ray *ray, struct exact_root *root, bool sure,
                    struct hit *out);
void exact_maybe_hit(const struct model *model, const struct ray *ray, const struct exact_maybe *maybe,
                     struct hit *out);

/* answer.c: converts t back for a ray whose direction was scaled by 2^exponent. Returns whether that made the hit
 * grazing: t has lost digits at an end of the doubles' range. */
bool hit_scale_back(struct hit *hit, const struct ray *scaled, int exponent);

#endif
