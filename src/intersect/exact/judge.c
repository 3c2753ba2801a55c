/* Turns what is found on one ray into its answer: which root is nearest, and whether that is proven. */
#include "intersect/exact/judge.h"

#include <stdlib.h>

#include "base/real.h"

void judge_turn(struct judge *j, uint32_t patch)
{
  if (j->patch == patch) return;
  j->patch = patch;
  j->pool = (struct pool){j->room, POOL_LIMBS, 0};
  j->seen = sight_make(j->asked->model->scene->patches[patch].P, j->asked->ray, &j->pool, &j->sight);
  judge_spend(j, WORK_SIGHT);
}

/* The least and the largest t that the root may have. */
static double least_t(const struct exact_root *root)
{
  const wide t = root->t - root->t_error;
  return (double)t > t ? nextafter((double)t, -INFINITY) : (double)t;
}

static double most_t(const struct exact_root *root)
{
  const wide t = root->t + root->t_error;
  return (double)t < t ? nextafter((double)t, INFINITY) : (double)t;
}

/* Nothing behind the nearest hit matters, nor anything within the error of the nearest maybe: it would be as
 * doubtful. */
static void set_limit(struct judge *j)
{
  double limit = j->asked->ray->t_max;
  if (j->hit) limit = real_min(limit, most_t(&j->nearest));
  if (j->doubtful) limit = real_min(limit, j->maybe.t - j->maybe.t_error);
  if (j->any && j->hit) limit = -INFINITY;
  j->limit = limit;
}

/* ---- roots beside each other ---- */

static bool sharpen(struct judge *j, struct exact_root *root)
{
  if (root->sharp) return true;
  judge_spend(j, WORK_SIGHT);
  return place_sharpen(j->asked->model, j->asked->ray, true, root);
}

static bool meet(const struct exact_root *a, const struct exact_root *b)
{
  return fabs((double)(a->u - b->u)) <= a->radius_u + b->radius_u &&
         fabs((double)(a->v - b->v)) <= a->radius_v + b->radius_v;
}

/* Whether all places where b may be are so near to a that no other root is. */
static bool alone_with(const struct exact_root *a, const struct exact_root *b)
{
  return fabs((double)(a->u - b->u)) + a->radius_u + b->radius_u <= a->alone[0] &&
         fabs((double)(a->v - b->v)) + a->radius_v + b->radius_v <= a->alone[1];
}

/* Whether both are in the same corner, or at the same pole. */
static bool one_point(const struct exact_root *a, const struct exact_root *b)
{
  return a->borders == b->borders && a->u == b->u && a->v == b->v && a->t_error == b->t_error && a->t == b->t;
}

bool judge_same(struct judge *j, struct exact_root *a, struct exact_root *b, bool *sure)
{
  if (a->patch != b->patch) return false;
  for (int tries = 0; tries < 2; tries++) {
    if (one_point(a, b)) return true;
    if (!meet(a, b)) return false;
    if (alone_with(a, b) || alone_with(b, a)) return true;
    (void)sharpen(j, a), (void)sharpen(j, b);
  }
  *sure = false;
  return true;
}

/* Relative to t: two roots nearer to each other than this count as met at one t, if they are known so well. */
#define ONE_T 0x1p-60

int judge_compare(struct judge *j, struct exact_root *a, struct exact_root *b, bool *sure)
{
  for (int tries = 0; tries < 2; tries++) {
    const wide apart = a->t - b->t, error = (wide)a->t_error + b->t_error;
    if (wide_abs(apart) > error) return apart < 0 ? -1 : 1;
    if (tries == 0) (void)sharpen(j, a), (void)sharpen(j, b);
    else if (!(a->sharp && b->sharp) && error > ONE_T * wide_abs(a->t)) *sure = false;
  }
  return 0;
}

bool judge_stands_before(const struct exact_root *a, const struct exact_root *b)
{
  if (a->patch != b->patch) return a->patch < b->patch;
  const bool apart = wide_abs(a->u - b->u) > (wide)a->radius_u + b->radius_u;
  return apart ? a->u < b->u : a->v < b->v;
}

/* ---- what is found ---- */

/* Whether the list has the root already. */
static bool listed(struct judge *j, struct exact_root *root)
{
  for (size_t k = 0; k < j->list->count; k++) {
    struct exact_found *found = &j->list->at[k];
    bool sure = true;
    if (found->kind == EXACT_OPEN || !judge_same(j, &found->root, root, &sure)) continue;
    j->doubt |= !sure;
    if (root->borders && !found->root.borders) found->root = *root, found->kind = EXACT_BORDER;
    return true;
  }
  return false;
}

void judge_root(struct judge *j, const struct exact_root *root)
{
  struct exact_root here = *root;
  bool sure = true;
  if (j->all) {
    const struct exact_found found = {.root = here, .kind = here.borders ? EXACT_BORDER : EXACT_INSIDE, .taken = -1};
    if (!listed(j, &here)) (void)exact_list_add(j->list, &found); /* on failure, list->failed is set */
    return;
  }
  if (j->hit && judge_same(j, &j->nearest, &here, &sure)) return;
  const int order = j->hit ? judge_compare(j, &j->nearest, &here, &sure) : 1;
  if (!sure) judge_undecided(j, real_min(least_t(&j->nearest), least_t(&here)));
  j->known &= order < 0; /* of two at one t either may be the one that the lanes come to */
  if (order > 0 || (order == 0 && judge_stands_before(&here, &j->nearest))) j->nearest = here, j->hit = true;
  set_limit(j);
}

/* The most open places of one ray that are listed; a surface along the ray may make hundreds. */
enum { LISTED_OPEN = 64 };

static void keep_maybe(struct judge *j, const struct exact_maybe *maybe, double from)
{
  const struct ray *ray = j->asked->ray;
  if (maybe->t < ray->t_min - maybe->t_error || maybe->t > ray->t_max + maybe->t_error) return;
  judge_undecided(j, from);
  if (!(maybe->t > ray->t_min + maybe->t_error && maybe->t < ray->t_max)) return;
  if (j->all) {
    const struct exact_found found = {
      .root = {.patch = maybe->patch, .u = maybe->u, .v = maybe->v, .t = maybe->t, .t_error = maybe->t_error},
      .kind = EXACT_OPEN,
      .taken = -1};
    if (j->list->count < LISTED_OPEN) (void)exact_list_add(j->list, &found);
    return;
  }
  if (j->doubtful && !(maybe->t < j->maybe.t || (maybe->t == j->maybe.t && maybe->patch < j->maybe.patch))) return;
  j->maybe = *maybe, j->doubtful = true;
  set_limit(j);
}

void judge_maybe(struct judge *j, double u, double v, double t, double t_error, double from)
{
  const struct exact_maybe maybe = {j->patch, u, v, t, t_error};
  keep_maybe(j, &maybe, from);
}

void judge_left(struct judge *j, double near, double far)
{
  if (near > j->limit) return;
  judge_undecided(j, near);
  j->cut_short |= far > j->asked->ray->t_min;
}

/* ---- regions ---- */

static int by_patch(const void *a, const void *b)
{
  const struct exact_region *x = a, *y = b;
  return x->patch < y->patch ? -1 : x->patch > y->patch;
}

static int by_distance(const void *a, const void *b)
{
  const struct exact_region *x = a, *y = b;
  return x->near != y->near ? (x->near < y->near ? -1 : 1) : by_patch(a, b);
}

/* Sorts the regions, each patch once. Returns how many there are. */
static size_t sort_regions(struct exact_region regions[], size_t count, bool all)
{
  size_t kept = 0;
  if (count > 1) qsort(regions, count, sizeof *regions, all ? by_patch : by_distance);
  for (size_t k = 0; k < count; k++)
    if (kept == 0 || regions[kept - 1].patch != regions[k].patch) regions[kept++] = regions[k];
  return kept;
}

/* A region gets its share of the work that is left, or this much, so that one in which the ray lies leaves some for the
 * others: what a ray next to a tangency takes. */
enum { LEAST_SHARE = 512 };

/* Whether the patch is met where the known root is, which is of an earlier patch of the same surface. */
static bool is_met_behind(const struct judge *j, uint32_t patch)
{
  const struct exact_root *known = j->all ? NULL : j->asked->known;
  const uint32_t *surface = j->asked->model->surface;
  return known && surface && surface[patch] != 0 && surface[patch] == surface[known->patch] && known->patch < patch;
}

/* Searches the case's regions, the first that the ray meets first. */
static void search(struct judge *j)
{
  struct exact_region *regions = j->asked->regions;
  const size_t count = sort_regions(regions, j->asked->region_count, j->all);
  for (size_t k = 0; k < count && (j->all || regions[k].near <= j->limit); k++) {
    if (is_met_behind(j, regions[k].patch)) continue;
    const int all = j->work, fair = (int)((size_t)real_max(all, 0) / (count - k));
    const int share = fair > LEAST_SHARE ? fair : all < LEAST_SHARE ? all : LEAST_SHARE;
    if (all <= 0) {
      judge_left(j, regions[k].near, INFINITY);
      continue;
    }
    j->work = share;
    judge_turn(j, regions[k].patch);
    exact_search(j, regions[k].near);
    j->work = all - share + j->work;
  }
}

/* ---- the case ---- */

void judge_run(struct judge *j, const struct exact_case *asked, enum judge_asks asks, struct exact_list *list)
{
  j->asked = asked, j->list = list, j->all = asks == JUDGE_ALL, j->any = asks == JUDGE_ANY;
  j->hit = j->known = j->doubtful = j->cut_short = j->doubt = false;
  j->work = (int)asked->limit, j->undecided = INFINITY, j->patch = UINT32_MAX;
  if (!j->all) {
    j->undecided = asked->cut_from;
    if (asked->known) j->nearest = *asked->known, j->hit = j->known = true;
  }
  set_limit(j);
  if (!j->all && asked->maybe) keep_maybe(j, asked->maybe, asked->maybe->t);
  search(j);
}

void exact_closest(const struct exact_case *asked, struct exact_decision *out)
{
  struct judge j;
  judge_run(&j, asked, JUDGE_NEAREST, NULL);
  if (j.hit && j.undecided <= most_t(&j.nearest)) (void)sharpen(&j, &j.nearest);
  const double to = j.hit ? most_t(&j.nearest) : INFINITY;
  *out = (struct exact_decision){.verdict = EXACT_MISS, .sure = j.undecided > to || j.undecided == INFINITY};
  if (j.doubtful && !(j.hit && j.nearest.t <= j.maybe.t)) out->verdict = EXACT_MAYBE, out->maybe = j.maybe;
  else if (j.hit) out->verdict = EXACT_ROOT, out->root = j.nearest, out->known = j.known;
}

bool exact_occluded(const struct exact_case *asked)
{
  struct judge j;
  judge_run(&j, asked, JUDGE_ANY, NULL);
  return j.hit || j.doubtful || j.cut_short;
}
