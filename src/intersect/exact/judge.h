/* The case of one ray: what a search finds, and what it means for the answer.
 *
 * Internal to src/intersect/exact. Layers: piece and sight; search and place; judge; vertex and all.
 */
#ifndef PSCN_INTERSECT_EXACT_JUDGE_H
#define PSCN_INTERSECT_EXACT_JUDGE_H

#include "intersect/exact/exact.h"
#include "intersect/exact/piece.h"

/* ---- sight.c: the whole patch as a piece, and what is special at its borders ----
 *
 * As the ray sees it, a border is a cubic curve in the plane of (a,b), and the ray is the origin. Where that curve lies
 * on a line through the origin, some combination p a + q b is zero along the border, so it is divisible by the distance
 * from the border. The kept polynomial (a or b) and the quotient have the same zeros off the border, and simple ones
 * however near to it. So it is at a border that is one point (a pole), at a straight one that the ray meets, and at one
 * in whose plane the ray lies. The roots on such a border are those of the kept polynomial there: they are the roots of
 * the pair (kept polynomial on the border, distance).
 */
struct sight {
  struct piece plane; /* the ray's own a and b */
  struct piece off;   /* the same after all exchanges: it has all roots of the patch off the borders listed below */
  bool dependent;     /* a and b are multiples of each other: the ray lies in the plane of a flat patch */
  unsigned met;       /* borders all of whose points are on the ray, as bits */
  int borders;        /* so many have their curves on a line through the origin: */
  int border[4];      /* their numbers as of geometry/edges.h */
  struct piece on[4]; /* its roots are those on the border: a is the kept polynomial there, b the distance */
  double along;       /* t = w / along */
};

/* Nets are in the pool. False if there is no room. */
bool sight_make(double (*P)[4][3], const struct ray *ray, struct pool *pool, struct sight *out);

/* Memory for nets, in limbs: 256 KB, of which a search of rays with ordinary numbers needs a tenth. */
enum { POOL_LIMBS = 1 << 15 };

enum judge_asks {
  JUDGE_NEAREST, /* the nearest hit */
  JUDGE_KNOWN,   /* the lanes' root; no other counts */
  JUDGE_ANY,
  JUDGE_ALL
};

struct judge {
  const struct exact_case *asked;
  enum judge_asks asks;
  struct exact_list *list; /* gets all that is found, if all hits are asked for */
  bool hit;                /* `nearest` is set: the nearest of the roots */
  struct exact_root nearest;
  bool tied;     /* another root is met at its t */
  bool doubtful; /* `maybe` is set: the nearest of the places that may be hits */
  struct exact_root maybe;
  bool cut_short;   /* something is left for want of work, beyond the ray's start */
  double undecided; /* lower bound on t of all that may be a hit, and is not known to be one; infinite for none */
  double limit;     /* nothing beyond this t matters */
  /* of the current patch */
  uint32_t patch;
  bool seen; /* `sight` is set: its numbers are not too long */
  struct sight sight;
  struct pool pool;
  limb room[POOL_LIMBS];
};

/* Starts the case, sets all of j but its room, and searches the case's regions. `list` only if all hits are asked
 * for. */
void judge_run(struct judge *j, const struct exact_case *asked, enum judge_asks asks, struct exact_list *list);

/* Ends the case: adds the work that it took. */
void judge_end(const struct judge *j);

/* Makes the patch the current one. */
void judge_turn(struct judge *j, uint32_t patch);

/* search.c: reports every root of the patch that is nearer than `limit`, and every place that cannot be decided. All of
 * them begin at `near` or behind. */
void exact_search(struct judge *j, uint32_t patch, double near);

/* ---- place.c: where a root that is known to be in a piece lies ---- */

/* Equalities are looked for at multiples of 2^-SIMPLE_BITS of the patch, and in corners of pieces. */
enum { SIMPLE_BITS = 16 };

/* A piece in which roots are sought. */
struct waiting {
  struct piece piece;
  size_t keep; /* the pool up to here holds what it is a part of */
  double near, far;
  int border; /* its roots are those on border[..] of the sight; -1: those off such borders */
};

/* w at a root, as by piece_depth. */
struct depth {
  wide w;
  double error;
  bool exact;
};

enum place_within { PLACE_OUT, PLACE_IN, PLACE_UNKNOWN };

/* Whether that is strictly between the ray's ends. */
enum place_within place_in_range(const struct judge *j, const struct depth *depth);

/* Reports a root that piece_root has found, or, with a radius of 0, one in a corner of the piece. If the ray may only touch
 * the surface there, within the patch, it does not count among all hits. */
void place_root(struct judge *j, const struct waiting *it, const struct piece_root *root);

/* ---- what a search tells of the current patch ---- */

/* A root of the patch, its borders included, that lies strictly within the ray's range. */
void judge_root(struct judge *j, const struct exact_root *root);

/* (u,v), clamped to the patch and with t known to t_error, may be a hit; what it stands for begins at `from` or
 * behind. */
void judge_maybe(struct judge *j, double u, double v, double t, double t_error, double from);

/* What lies between those t is left undecided for want of work or room. */
void judge_left(struct judge *j, double near, double far);

/* Something beginning there is left undecided. */
static inline void judge_undecided(struct judge *j, double near)
{
  if (!(near >= j->undecided)) j->undecided = near;
}

/* Whether a root is known as well as can be: within 2^-106 of its patch. */
static inline bool judge_sharp(const struct exact_root *root)
{
  return root->radius_u <= 0x1p-106 && root->radius_v <= 0x1p-106;
}

/* The least t that the root may have. */
double judge_least_t(const struct exact_root *root);

/* ---- roots beside each other; what cannot be told is noted as undecided ---- */

/* Whether the two are known to be one root of one patch. */
bool judge_same(struct judge *j, const struct exact_root *a, const struct exact_root *b);

/* -1 or 1: a is met before or behind b; 0: both at one t, as far as is known. */
int judge_compare(struct judge *j, const struct exact_root *a, const struct exact_root *b);

/* Which of two roots at one t comes first: the one of the earlier patch, or, where a patch meets itself, that of
 * smaller parameters. */
bool judge_stands_before(const struct exact_root *a, const struct exact_root *b);

/* ---- vertex.c: whether the ray crosses the surface in roots on borders, of j->list ---- */

/* Finds the roots of the list that are one point of the surface with root `at` of it, if the ray crosses the surface
 * there. Writes their indices to out and returns their number; returns 0 if that is not proven. */
enum { VERTEX_MAX = 32 };
size_t vertex_crossed(struct judge *j, size_t at, size_t out[VERTEX_MAX]);

#endif
