/* The case of one ray: searches tell the judge what they find, and the judge alone decides what it means.
 *
 * Internal to src/intersect/exact.
 */
#ifndef PSCN_INTERSECT_EXACT_JUDGE_H
#define PSCN_INTERSECT_EXACT_JUDGE_H

#include "intersect/exact/exact.h"
#include "intersect/exact/zoom.h"
#include "intersect/local_ray.h"

/* Most roots on borders that even wide arithmetic cannot tell from the borders. A shared edge has two of them, a corner
 * some more. */
enum { JUDGE_BORDERS_MAX = 16 };

/* Most roots at one t: some sheets that lie on each other. */
enum { JUDGE_RIVALS_MAX = 8 };

/* Work is counted in boxes examined, some 1,300 instructions each. Other steps count as this many boxes: taking a patch
 * or a part of it to the ray's frame, taking a patch to fixed point, zooming a box, looking for a fold, sharpening a
 * root. If all hits are asked for, each of the first HITS_MOST hits brings WORK_HIT more. docs/method.md, "The numbers
 * of the last resort", sums up what one ray may take. */
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
  bool all; /* all hits are asked for, and `list` gets all that is found; else only roots on borders */
  struct exact_list *list;
  struct exact_root nearest; /* of the certain roots inside patches; set if there are rivals */
  /* `nearest`, and the roots that t tells neither from it nor from each other; room for one more */
  struct exact_root rival[JUDGE_RIVALS_MAX + 1];
  size_t rivals;
  struct exact_maybe maybe; /* the nearest, if `doubtful` */
  bool doubtful;
  /* work or halvings ran out on a box beyond the ray's start, which may hold a hit */
  bool cut_short;
  /* where a root may be that could not be told from `nearest`, or from one before it (judge_tie_fine); infinite for
   * none */
  double tied_from;
  bool doubt; /* any doubt, if all hits are asked for */
  /* lower bound on t of all that may be a hit: known as such, left out at an end of the ray, undecided for want of
   * work, or never told of; infinite for none */
  double undecided;
  double limit; /* nothing beyond this t matters */
  int work;     /* still to be spent, see WORK_REGION */
  int apart;    /* the same, reserved for single regions (regions.c) */
  int own;      /* the share of `apart` that the current region has */
  size_t open;  /* open places found, if all hits are asked for */
  /* of the current patch */
  uint32_t patch;
  /* the ray as the patch is tested with it: itself, or turned straight across a plane in which it starts */
  struct ray ray;
  struct model_patch *prepared; /* in `room` if the model does not keep it */
  struct patch_room room;
  int zeros[4]; /* rows of the net, from each border (geometry/edges.h) on, in one point that the ray meets exactly */
  bool zoomed;  /* `zoom` is set */
  struct zoom zoom;
  struct local_ray local;
};

/* Takes so much of the work. */
static inline void judge_spend(struct judge *j, int work)
{
  j->work -= work;
  *j->asked->work += (uint64_t)work;
}

/* Starts the case and searches its regions. */
void judge_run(struct judge *j, const struct exact_case *asked, bool all, struct exact_list *list);

/* ---- the search of its regions ---- */

/* regions.c: searches the case's regions. Reorders them: if the nearest hit is asked for, the ray meets the first ones
 * first. */
void judge_search(struct judge *j);

/* search.c: tells the judge of every root in the region that is nearer than `limit`, and of every place that cannot be
 * decided. If no work is left, it tells only of a doubt, and of a place that may be a root. The region's patch must be
 * the current one. */
void search_region(struct judge *j, const struct exact_region *region);

/* Makes the patch the current one: sets all that is of it, but for `zoom`. */
void judge_turn(struct judge *j, uint32_t patch);

/* The ray through the current patch, in fixed point. */
struct zoom *judge_zoom(struct judge *j);

/* ---- what a search tells of the current patch ---- */

/* Tells of a proven root, anywhere on the patch or around it. */
void judge_root(struct judge *j, struct exact_root *root);

/* Tells that the ray meets a border that is one point exactly (`zeros`). */
void judge_pole_met(struct judge *j, int border);

/* Tells that it meets one as far as wide arithmetic can tell, but not exactly. The search tells nothing of what is next
 * to the point; that begins at most `reach` before it. */
void judge_pole(struct judge *j, int border, double reach);

/* Tells that (u,v), with t known to t_error, may be on the ray. What the point stands for begins at `from` or
 * behind. */
void judge_maybe(struct judge *j, double u, double v, double t, double t_error, double from);

/* Tells that something beginning there is left undecided. */
static inline void judge_undecided(struct judge *j, double near)
{
  j->doubt |= j->all;
  if (!(near >= j->undecided)) j->undecided = near;
}

/* ---- roots beside each other ---- */

/* Sharpens the root if it is not sharp yet, which makes its patch the current one. Returns whether it is sharp; if not,
 * its place may have moved. */
bool judge_sharpen(struct judge *j, struct exact_root *root);

/* The same, but if that fails the root is unchanged; it may still be told from another one. */
void judge_improve(struct judge *j, struct exact_root *root);

/* Whether t does not tell the two apart. */
bool judge_tie(const struct exact_root *a, const struct exact_root *b);

/* Whether the order of two such roots, sharpened as far as possible, does not matter: neither is ill-conditioned, so
 * each has t to the accuracy that wide arithmetic has in its patch, and the two t are equal to a rounding. */
bool judge_tie_fine(const struct exact_root *a, const struct exact_root *b);

/* Returns the same. If the order matters, the nearest hit is not certain from the first of the two on. */
bool judge_weigh_tie(struct judge *j, const struct exact_root *a, const struct exact_root *b);

/* Which of two roots that nothing tells apart on the ray comes first: the one of the earlier patch, or, where a patch
 * meets itself, that of smaller parameters. */
bool judge_stands_before(const struct exact_root *a, const struct exact_root *b);

/* Takes a root that counts. The nearest hit is the first in the scene of those not proven to be behind another one. (Of
 * three roots each may be tied with the next, and the first still be before the last.) If all hits are asked for, the
 * root goes to the list. */
void judge_keep(struct judge *j, struct exact_root *root);

/* ---- roots on borders, of j->list ---- */

/* borders.c: settles them for the nearest hit. Those where the ray is proven to cross the surface, or to meet a
 * corner exactly, are hits; the others may be. A corner belongs to the first of its patches, as does a border that lies
 * on another surface. */
void judge_settle_borders(struct judge *j);

/* Whether the root, on these borders, is in a corner that the ray meets exactly. Sets *out, which may be *root, to the
 * root there. The root's patch must be the current one. */
bool judge_corner(const struct judge *j, unsigned borders, const struct exact_root *root, struct exact_root *out);

/* The same for a root that was found, and tells of it if so. */
bool judge_tell_corner(struct judge *j, const struct exact_found *found);

/* borders.c: whether the two roots, each on one border of its patch, are on the same border, with the patches on either
 * side of it as the ray sees them. Then the ray crosses the surface there. */
bool judge_across(const struct judge *j, const struct exact_found *a, const struct exact_found *b);

/* star.c: finds the roots of j->list[first..end-1] that lie, with root `at`, in one corner of patches or at one pole.
 * If the ray crosses the surface there, they are all roots that the patches have next to that point, and are one hit.
 * Writes their indices to out and returns their number; returns 0 if that is not proven. */
enum { STAR_MAX = 32 };
size_t judge_star(struct judge *j, size_t at, size_t first, size_t end, size_t out[STAR_MAX]);

/* passes.c: whether the ray passes through the point, in exact arithmetic. Also false if a product is too small for
 * that. */
bool judge_passes(const struct ray *ray, const double point[3]);

/* borders.c: moves the root onto its patch's borders, or to the control point in a corner that the ray meets. Makes
 * that patch the current one. */
void judge_to_border(struct judge *j, struct exact_found *found);

/* Tells of the border's root as a place that may be a hit. Makes its patch the current one. */
void judge_open(struct judge *j, const struct exact_found *border);

/* all.c: adds a place that may be a hit; for all hits only. */
void judge_add_open(struct judge *j, const struct exact_maybe *maybe);

#endif
