/* The last resort: what one ray meets, decided for it alone, slowly and to the end.
 *
 * Internal to src/intersect. Compiled once, scalar, without contraction: its answers are the same bits on every
 * processor. Pure; safe on any thread; uses up to 1.25 MB of stack, for searches within searches.
 *
 * The lanes take a root only where double precision leaves no question: it is proven, strictly inside its patch,
 * strictly within the ray's range, not next to another one. Whatever they leave open comes here as a list of
 * regions (leaves, or parts of a patch cut for a copy), which are searched in the order in which the ray meets them,
 * in whatever order the lanes came by. Roots are looked at in wide arithmetic wherever double cannot tell on which side
 * of something they lie.
 */
#ifndef PSCN_INTERSECT_EXACT_EXACT_H
#define PSCN_INTERSECT_EXACT_EXACT_H

#include <math.h>
#include <stdbool.h>

#include "base/wide.h"
#include "intersect/intersect.h"
#include "intersect/model.h"

/* A part of a patch: the columns of a leaf, of patch->cut.split a side. */
struct exact_region {
  const struct leaf *leaf; /* its leaf; NULL where that is not kept, or a copy has none of its own */
  uint32_t patch;          /* index into the scene's patches */
  uint16_t column[2];      /* along u, v: the first, and how many */
  uint16_t span[2];
  double near; /* what is open there begins at this t or behind, of the ray's nearest hit */
};

/* A proven root, in parameters of the whole patch: exactly one root of the exact ray lies within the radii. */
struct exact_root {
  uint32_t patch;
  bool sharp;                /* as good as wide arithmetic makes it */
  wide u, v, t;              /* t in units of the scaled direction */
  double radius_u, radius_v; /* absolute */
  double t_error;            /* absolute */
  double alone;    /* of a sharp one: no other root of the patch has parameters that are both within this of its */
  bool well_known; /* and its t is as good as TIE_ERRORS (sharpen.c) say */
};

/* The parameters of a certain hit are right to this. */
#define LARGEST_RADIUS 0x1p-20

static inline bool exact_root_placed(const struct exact_root *root)
{
  return root->radius_u <= LARGEST_RADIUS && root->radius_v <= LARGEST_RADIUS;
}

/* Whether two of one patch may be the same. */
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

/* regions.c: the region becomes the least rectangle of leaves that has both, which are of one patch. */
void exact_region_join(struct exact_region *region, const struct exact_region *other);

/* A place that may be a hit or none: a point of a patch, and how far along the ray it may be off. */
struct exact_maybe {
  uint32_t patch;
  unsigned borders; /* of the patch that the point lies on, bits as of geometry/edges.h */
  double u, v, t, t_error;
};

/* Of one ray whose nearest hit is asked for; where there are more each patch has one, and of more patches those that begin
 * first. */
enum { EXACT_REGIONS_MAX = 128 };

/* What is found on a ray. */
enum exact_kind {
  EXACT_INSIDE, /* a root that is strictly inside its patch */
  EXACT_BORDER, /* one that even wide arithmetic cannot tell from borders of its patch, or a pole that the ray meets */
  EXACT_OPEN    /* a place that may be a hit or none */
};

struct exact_found {
  struct exact_root root; /* of an open one u, v, t and t_error */
  enum exact_kind kind;
  unsigned borders; /* bits as of geometry/edges.h */
  int64_t taken;    /* the number of the lanes' root that it is; negative: of none */
  bool tied;        /* it was made sharp to be told from another surface's, and its answer is to be */
  wide least;       /* of a sorted list: where this one and all behind it begin, by t and its error */
};

/* A list that grows by memory_grow, but where it is fixed. Zero-initialise; memory_free `at`. */
struct exact_list {
  struct exact_found *at;
  size_t count, room;
  bool fixed, failed; /* failed: memory was short, and something was left out */
};

/* What is asked. */
struct exact_case {
  const struct model *model;
  const struct ray *ray;           /* direction scaled to about 1 */
  const struct exact_root *known;  /* the nearest that the lanes took; NULL where there is none */
  const struct exact_maybe *maybe; /* the same where it is not proven; NULL */
  struct exact_region *regions;    /* in any order; put into another one */
  size_t region_count;
  double cut_from; /* what was left out begins there or behind, as does any doubt; infinite for nothing */
  uint64_t *work;  /* what it takes is added, in boxes looked at (judge.h) */
};

enum exact_verdict {
  EXACT_MISS,
  EXACT_ROOT, /* the nearest hit is this root */
  EXACT_MAYBE /* the nearest hit may be this point */
};

struct exact_decision {
  enum exact_verdict verdict;
  bool sure;                /* proven; a maybe never is */
  struct exact_root root;   /* where it is one */
  struct exact_maybe maybe; /* where it is one */
};

/* The nearest hit of the ray. */
void exact_closest(const struct exact_case *asked, struct exact_decision *out);

/* all.c: all hits of the ray, of which *list has those that the lanes took, `known`, `maybe` and `cut_from` are not
 * looked at, and of regions there may be any number. *list becomes the hits in their order, roots inside patches and open
 * ones. Returns whether it is proven. */
bool exact_all(const struct exact_case *asked, struct exact_list *list);

/* all.c: whether there was room for it. */
bool exact_list_add(struct exact_list *list, const struct exact_found *found);

/* Whether anything is hit, or may be. */
bool exact_occluded(const struct exact_case *asked);

/* answer.c: the hit at a proven root, as good as wide arithmetic makes it, or at a point that may be one. t is in
 * units of the scaled direction. */
void exact_root_hit(const struct model *model, const struct ray *ray, struct exact_root *root, bool sure,
                    struct hit *out);
void exact_maybe_hit(const struct model *model, const struct ray *ray, const struct exact_maybe *maybe,
                     struct hit *out);

/* answer.c: of a ray whose direction was scaled by 2^exponent, t of the one that was asked for. Returns whether the hit is
 * grazing for it: t has lost digits at an end of the doubles. */
bool hit_scale_back(struct hit *hit, const struct ray *scaled, int exponent);

#endif
