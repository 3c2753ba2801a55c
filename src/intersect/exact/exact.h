/* The last resort: decides what one ray meets, for it alone, in exact arithmetic.
 *
 * Internal to src/intersect. Compiled once, scalar, without contraction: its answers are the same bits on every
 * processor. Pure; safe on any thread; uses up to 1 MB of stack. To use it, fill in an exact_case and call
 * exact_closest, exact_occluded or exact_all; exact_hit makes the answers.
 *
 * The lanes take a root only where double precision leaves no question: the root is proven, strictly inside its patch,
 * strictly within the ray's range, and not next to another one. Everything they leave open comes here as a list of
 * patches. The order of work: judge.c takes them in the order in which the ray meets them; sight.c writes a patch, as
 * the ray sees it, as nets of integers; search.c divides them (piece.c) until each piece has no root or one (root.c);
 * place.c computes a root to 2^-106 of its patch; judge.c decides what it means for the answer; all.c and vertex.c
 * count hits. A root of the lanes that is next to another one is not used: its patch is searched.
 *
 * A ray meets a patch in its borders and corners, too. All decisions are exact, except that two roots that near to each
 * other are one, or are met at one t. What is not decided is `grazing`: what is open when the work is used up; and a
 * root exactly on a border, or within some 2^-160 of the patch from it, unless u and v are multiples of 2^-16 or the ray
 * lies in one plane with the border (judge.h).
 */
#ifndef PSCN_INTERSECT_EXACT_EXACT_H
#define PSCN_INTERSECT_EXACT_EXACT_H

#include <math.h>
#include <stdbool.h>

#include "base/wide.h"
#include "intersect/intersect.h"
#include "intersect/model.h"

/* A patch in which the lanes leave something open. */
struct exact_region {
  uint32_t patch; /* index into the scene's patches */
  double near;    /* nothing open here begins before this t; set unless all hits are asked for */
};

/* A proven root, in parameters of the whole patch: the exact ray has exactly one root within the radii. Or a place that may
 * be a hit or not. */
struct exact_root {
  uint32_t patch;
  unsigned borders; /* on which it lies exactly: bits as of geometry/edges.h; the parameter across is then 0 or 1 */
  int side;         /* of a root on one border: the side of the border's curve, as the ray sees it and in the sense of
                     * the border's parameter, on which the patch lies: 1 left, -1 right, 0 not known */
  wide u, v, t;     /* t in units of the scaled direction */
  double radius_u, radius_v; /* absolute */
  double t_error;            /* absolute */
};

/* The most regions of a ray whose nearest hit is asked for; of more, those that begin first are listed. */
enum { EXACT_REGIONS_MAX = 128 };

/* What a search finds on a ray. */
enum exact_kind {
  EXACT_INSIDE, /* a root that counts: inside its patch, or where the ray crosses the surface on a border */
  EXACT_BORDER, /* a root on a border, not settled yet */
  EXACT_OPEN    /* a place that may be a hit or not */
};

struct exact_found {
  struct exact_root root;
  enum exact_kind kind;
  int64_t taken; /* number of the lanes' root that it is; negative: none of theirs */
  int64_t leaf;  /* of a root of the lanes: where they found it */
  bool tied;     /* another surface is met at its t, so its own t counts, not that of the lanes' hit */
};

/* A list that grows by memory_grow. Zero-initialise it; memory_free `at`. */
struct exact_list {
  struct exact_found *at;
  size_t count, room;
  bool failed; /* memory was short, and something is missing */
};

/* The question. */
struct exact_case {
  const struct model *model;
  const struct ray *ray;          /* direction scaled to about 1 */
  const struct exact_root *known; /* the nearest root that the lanes took, if the nearest hit is wanted; or NULL */
  struct exact_region *regions;   /* in any order; the call reorders them. For all hits a patch may stand there twice */
  size_t region_count;
  double cut_from; /* neither what was left out nor a doubt begins before this t; infinite for none */
  uint64_t *work;  /* the work done is added, in pieces examined (piece.h) */
  uint64_t limit;  /* no more of it may be done */
};

struct exact_decision {
  bool sure;  /* proven */
  bool known; /* the answer is the lanes' root, and nothing else is near */
  bool hit;   /* otherwise: it is `root`, or a miss */
  struct exact_root root;
};

/* The nearest hit of the ray. */
void exact_closest(const struct exact_case *asked, struct exact_decision *out);

/* Computes the root that the lanes took, `known`, to 2^-106 of its patch; *out is the same root if that is not possible.
 * The case's regions and its limit are not used. */
void exact_place(const struct exact_case *asked, struct exact_root *out);

/* all.c: finds all hits of the ray. At first *list holds the roots that the lanes took; in the end it holds the hits in
 * their order: roots that count, and open places. The number of regions has no limit, and cut_from must be infinite.
 * Returns whether the result is proven. */
bool exact_all(const struct exact_case *asked, struct exact_list *list);

/* all.c: returns false if there was no room. */
bool exact_list_add(struct exact_list *list, const struct exact_found *found);

/* Whether the ray hits anything, or may do so. *proven: which of the two is known. */
bool exact_occluded(const struct exact_case *asked, bool *proven);

/* answer.c: the hit at a root, or, not `sure`, at a place that may be one. t is in units of the scaled direction. */
void exact_hit(const struct model *model, const struct ray *ray, const struct exact_root *root, bool sure,
               struct hit *out);

#endif
