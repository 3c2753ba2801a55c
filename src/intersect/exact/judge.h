/* The case of one ray: what a search finds, and what it means for the answer.
 *
 * Internal to src/intersect/exact. Layers: piece, sight, search; then judge; then vertex and all.
 */
#ifndef PSCN_INTERSECT_EXACT_JUDGE_H
#define PSCN_INTERSECT_EXACT_JUDGE_H

#include "intersect/exact/exact.h"
#include "intersect/exact/sight.h"

/* Work is counted in pieces examined, some 1,500 instructions each; one more for each WORK_LIMBS products of limbs of
 * the numbers of one that is made exact. Writing a patch as the ray sees it counts as WORK_SIGHT of them, and so does
 * zooming in on a root; looking for curves, WORK_CURVES. */
enum { WORK_LIMBS = 64, WORK_SIGHT = 8, WORK_CURVES = 40 };

/* Memory for nets, in limbs: 256 KB, of which a search of rays with ordinary numbers needs a tenth. */
enum { POOL_LIMBS = 1 << 15 };

struct judge {
  const struct exact_case *asked;
  bool all, any;           /* all hits are asked for, or any; else the nearest */
  struct exact_list *list; /* gets all that is found, if all hits are asked for */
  bool hit;                /* `nearest` is set: the nearest of the certain roots */
  struct exact_root nearest;
  bool known;    /* which is the one that the lanes took, and alone at its t */
  bool doubtful; /* `maybe` is set: the nearest of the places that may be hits */
  struct exact_maybe maybe;
  bool cut_short;   /* something is left for want of work, beyond the ray's start */
  bool doubt;       /* any, if all hits are asked for */
  double undecided; /* lower bound on t of all that may be a hit, and is not known to be one; infinite for none */
  double limit;     /* nothing beyond this t matters */
  int work;         /* still to be spent */
  /* of the current patch */
  uint32_t patch;
  bool seen; /* `sight` is set: its numbers are not too long */
  struct sight sight;
  struct pool pool;
  limb room[POOL_LIMBS];
};

/* Takes so much of the work. */
static inline void judge_spend(struct judge *j, int work)
{
  j->work -= work;
  *j->asked->work += (uint64_t)work;
}

enum judge_asks { JUDGE_NEAREST, JUDGE_ANY, JUDGE_ALL };

/* Starts the case, sets all of j but its room, and searches the case's regions. `list` only if all hits are asked
 * for. */
void judge_run(struct judge *j, const struct exact_case *asked, enum judge_asks asks, struct exact_list *list);

/* Makes the patch the current one. */
void judge_turn(struct judge *j, uint32_t patch);

/* search.c: reports every root of the current patch that is nearer than `limit`, and every place that cannot be decided.
 * All of them begin at `near` or behind. */
void exact_search(struct judge *j, double near);

/* A t as near as this, relatively, rounds to a double next to it. */
#define LAST_PLACES 0x1p-58

/* place.c: makes the root sharp, or, unless it is to be the `sharpest`, its t right to the last places. Returns false if
 * its place could not be improved. */
bool place_sharpen(const struct model *model, const struct ray *ray, bool sharpest, struct exact_root *root);

/* ---- what a search tells of the current patch ---- */

/* A root of the patch, its borders included, that lies strictly within the ray's range. */
void judge_root(struct judge *j, const struct exact_root *root);

/* (u,v), with t known to t_error, may be a hit; what the point stands for begins at `from` or behind. */
void judge_maybe(struct judge *j, double u, double v, double t, double t_error, double from);

/* What lies between those t is left undecided for want of work or room. */
void judge_left(struct judge *j, double near, double far);

/* Something beginning there is left undecided. */
static inline void judge_undecided(struct judge *j, double near)
{
  j->doubt |= j->all;
  if (!(near >= j->undecided)) j->undecided = near;
}

/* ---- roots beside each other; both are sharpened if needed ---- */

/* Whether the two are one root of one patch. *sure is cleared if that cannot be told; then they count as one. */
bool judge_same(struct judge *j, struct exact_root *a, struct exact_root *b, bool *sure);

/* -1 or 1: a is met before or behind b; 0: both at one t. *sure is cleared if that cannot be told. */
int judge_compare(struct judge *j, struct exact_root *a, struct exact_root *b, bool *sure);

/* Which of two roots at one t comes first: the one of the earlier patch, or, where a patch meets itself, that of
 * smaller parameters. */
bool judge_stands_before(const struct exact_root *a, const struct exact_root *b);

/* ---- vertex.c: whether the ray crosses the surface in roots on borders, of j->list ---- */

/* Finds the roots of the list that are one point of the surface with root `at` of it, if the ray crosses the surface
 * there. Writes their indices to out and returns their number; returns 0 if that is not proven. */
enum { VERTEX_MAX = 32 };
size_t vertex_crossed(struct judge *j, size_t at, size_t out[VERTEX_MAX]);

#endif
