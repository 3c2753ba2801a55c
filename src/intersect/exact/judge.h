/* The case of one ray: what is found is told to the judge, who alone decides what it means.
 *
 * Internal to src/intersect/exact.
 */
#ifndef PSCN_INTERSECT_EXACT_JUDGE_H
#define PSCN_INTERSECT_EXACT_JUDGE_H

#include "intersect/exact/exact.h"
#include "intersect/exact/zoom.h"
#include "intersect/local_ray.h"

/* Roots on borders that even wide arithmetic cannot tell from them: at a shared edge there are two of them, in a corner
 * some more. */
enum { JUDGE_BORDERS_MAX = 16 };

/* Roots at one t, some sheets that lie on each other. */
enum { JUDGE_RIVALS_MAX = 8 };

/* Work is counted in boxes looked at, some 1,300 instructions each; what else is done is worth so many: to take a patch or
 * a part of it to the ray's frame, to take a patch to fixed point, to zoom a box, to look for a fold, to sharpen a
 * root. Where all hits are asked for each of the first HITS_MOST that are found brings WORK_HIT. What a ray may take in all
 * is summed up in docs/method.md, "The numbers of the last resort". */
enum {
  WORK_REGION = 8,
  WORK_ZOOM_START = 16,
  WORK_ZOOM = 16,
  WORK_FOLD = 2,
  WORK_SHARPEN = 16,
  WORK_HIT = 32,
  HITS_MOST = 512
};

struct judge {
  const struct exact_case *asked;
  bool all; /* all hits are asked for, and `list` has whatever is found; else roots on borders only */
  struct exact_list *list;
  struct exact_root nearest; /* of the certain roots inside patches, where there are rivals */
  /* it, and those that nothing tells from it or from each other by t; room for one more */
  struct exact_root rival[JUDGE_RIVALS_MAX + 1];
  size_t rivals;
  struct exact_maybe maybe; /* the nearest, where `doubtful` */
  bool doubtful;
  bool cut_short; /* a box beyond the ray's start is left for which the work, or halving, ended: it may hold a hit */
  /* where a root may be that `nearest`, or one before it, could not be told from (judge_tie_fine); infinite for none */
  double tied_from;
  bool doubt; /* where all hits are asked for, any */
  /* what may be a hit begins here or behind, known as such, left out at an end of the ray, undecided for want of work, or never
   * told of; infinite for none */
  double undecided;
  double limit; /* nothing beyond this t matters */
  int work;     /* that may still be done, see WORK_REGION */
  int apart;    /* the same besides, for regions by themselves (regions.c) */
  int own;      /* what the region that is searched has of that */
  size_t open;  /* places in `list` that may be hits, where all hits are asked for */
  /* of the patch looked at last */
  uint32_t patch;
  struct ray ray;               /* as it is looked at there: the ray itself, or across a plane that it starts in */
  struct model_patch *prepared; /* in `room` where the model does not keep it */
  struct patch_room room;
  bool zoomed; /* `zoom` is set */
  struct zoom zoom;
  struct local_ray local;
};

/* So much is done. */
static inline void judge_spend(struct judge *j, int work)
{
  j->work -= work;
  *j->asked->work += (uint64_t)work;
}

/* Starts the case, and has its regions searched. */
void judge_run(struct judge *j, const struct exact_case *asked, bool all, struct exact_list *list);

/* ---- the search of its regions ---- */

/* regions.c: has the case's regions searched, which are put into another order: those that the ray meets first come first
 * where the nearest hit is asked for. */
void judge_search(struct judge *j);

/* search.c: tells the judge of every root in the region that is nearer than `limit`, and of every place that cannot be
 * decided. Where no work is left, only of a place that may be one, and of a doubt. The judge has turned to the region's
 * patch. */
void search_region(struct judge *j, const struct exact_region *region);

/* Turns to the patch: prepared, room and local are of it from here on. */
void judge_turn(struct judge *j, uint32_t patch);

/* The ray through the patch that it has turned to, in fixed point. */
struct zoom *judge_zoom(struct judge *j);

/* ---- what a search tells, of the patch that the judge has turned to ---- */

/* A proven root, anywhere on the patch or around it. */
void judge_root(struct judge *j, struct exact_root *root);

/* The ray meets a border of the patch that is one point, as far as wide arithmetic can tell: returns whether it does. If that
 * is not known nothing is told of what is next to the point, which begins by `reach` before it. */
bool judge_pole(struct judge *j, int border, double reach);

/* The point (u,v), at t as nearly as t_error, is on the ray or not; what it stands for begins no earlier than `from`. */
void judge_maybe(struct judge *j, double u, double v, double t, double t_error, double from);

/* What begins there is left undecided. */
static inline void judge_undecided(struct judge *j, double near)
{
  j->doubt |= j->all;
  if (!(near >= j->undecided)) j->undecided = near;
}

/* ---- roots beside each other ---- */

/* Makes the root as good as wide arithmetic can; returns whether it is: else its place may have moved. Turns to its patch. */
bool judge_sharpen(struct judge *j, struct exact_root *root);

/* The same; where that cannot be done the root stays as it is, and may still be told from another. */
void judge_improve(struct judge *j, struct exact_root *root);

/* Whether the two cannot be told apart by t. */
bool judge_tie(const struct exact_root *a, const struct exact_root *b);

/* Of two such roots, made as sharp as they get: whether it is no matter, t being the same to what wide arithmetic leaves of
 * roots that are not ill-conditioned, each of its patch, and to a rounding. */
bool judge_tie_fine(const struct exact_root *a, const struct exact_root *b);

/* Returns it, and where it matters has the nearest hit not be certain from the first of the two on. */
bool judge_weigh_tie(struct judge *j, const struct exact_root *a, const struct exact_root *b);

/* Which of two roots that nothing tells apart on the ray comes first: by patch, and by its parameters where a patch meets
 * itself. */
bool judge_stands_before(const struct exact_root *a, const struct exact_root *b);

/* A root that counts: the nearest, or of those that are not proven to be behind another one the first. Of three each may be
 * at one t with the next, and the first before the last. Where all hits are asked for it is put on the list. */
void judge_keep(struct judge *j, struct exact_root *root);

/* ---- roots on borders, of j->list ---- */

/* borders.c: of the nearest hit. Those that something certain is next to are hits; the others may be. A corner belongs to
 * the first of its patches, and so does a border that lies on another surface. */
void judge_settle_borders(struct judge *j);

/* Whether the root, on these borders, is in a corner that the ray meets exactly: *out is the root there then, and may be the
 * same. The judge has turned to its patch. */
bool judge_corner(const struct judge *j, unsigned borders, const struct exact_root *root, struct exact_root *out);

/* The same of a root that was found, which is told of then. */
bool judge_tell_corner(struct judge *j, const struct exact_found *found);

/* borders.c: whether the two roots, each on one border of its patch, are on the same border, and the patches lie on either
 * side of it as the ray sees them: then it crosses the surface there. */
bool judge_across(const struct judge *j, const struct exact_found *a, const struct exact_found *b);

/* star.c: the roots of j->list[first..end-1] that lie in one corner of patches, or at one pole, together with `at`, as
 * out[..], where the ray crosses the surface there: these are all that the patches have next to that point, and are one
 * hit. Returns how many, 0 where that is not proven. */
enum { STAR_MAX = 32 };
size_t judge_star(struct judge *j, size_t at, size_t first, size_t end, size_t out[STAR_MAX]);

/* passes.c: whether the ray passes through the point, in exact arithmetic; false too where a product is too small for
 * that. */
bool judge_passes(const struct ray *ray, const double point[3]);

/* borders.c: takes the root to where it is on its patch's borders, and to the control point in a corner that the ray meets.
 * Turns to that patch. */
void judge_to_border(struct judge *j, struct exact_found *found);

/* Tells of the border's root as of what may be a hit. Turns to its patch. */
void judge_open(struct judge *j, const struct exact_found *border);

/* all.c: what may be a hit, where all hits are asked for. */
void judge_add_open(struct judge *j, const struct exact_maybe *maybe);

#endif
