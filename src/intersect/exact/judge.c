/* Turns what is found on one ray into its answer: which root is nearest, and whether that is proven. */
#include "intersect/exact/judge.h"

#include <stdlib.h>

#include "base/real.h"

void judge_turn(struct judge *j, uint32_t patch)
{
  if (j->patch == patch) return;
  j->patch = patch;
  j->pool.used = 0;
  j->seen = sight_make(j->asked->model->scene->patches[patch].P, j->asked->ray, &j->pool, &j->sight);
}

double judge_least_t(const struct exact_root *root)
{
  const wide t = root->t - root->t_error;
  return (double)t > t ? nextafter((double)t, -INFINITY) : (double)t;
}

/* The largest t that the root may have. */
static double most_t(const struct exact_root *root)
{
  const wide t = root->t + root->t_error;
  return (double)t < t ? nextafter((double)t, INFINITY) : (double)t;
}

/* Nothing behind the nearest hit matters, nor behind the nearest maybe: it would be as doubtful. */
static void set_limit(struct judge *j)
{
  j->limit = j->asked->ray->t_max;
  if (j->hit) j->limit = real_min(j->limit, most_t(&j->nearest));
  if (j->doubtful) j->limit = real_min(j->limit, most_t(&j->maybe));
  if (j->asked->known) j->limit = real_min(j->limit, most_t(j->asked->known));
  if (j->asks == JUDGE_ANY && j->hit) j->limit = -INFINITY;
}

/* ---- roots beside each other ---- */

/* Whether b, with its radii, is within those of a. */
static bool within(const struct exact_root *a, const struct exact_root *b)
{
  return fabs((double)(a->u - b->u)) + b->radius_u <= a->radius_u &&
         fabs((double)(a->v - b->v)) + b->radius_v <= a->radius_v;
}

bool judge_same(struct judge *j, const struct exact_root *a, const struct exact_root *b)
{
  if (a->patch != b->patch) return false;
  if (within(a, b) || within(b, a)) return true; /* there is one root in there */
  if (!judge_sharp(a) || !judge_sharp(b) || fabs((double)(a->u - b->u)) > a->radius_u + b->radius_u ||
      fabs((double)(a->v - b->v)) > a->radius_v + b->radius_v)
    return false;
  /* Half the margin of a piece, 2^-70, from a root there is no other one of the same pair of polynomials. */
  if (a->borders != b->borders) judge_undecided(j, real_min(judge_least_t(a), judge_least_t(b)));
  return true;
}

int judge_compare(struct judge *j, const struct exact_root *a, const struct exact_root *b)
{
  const wide apart = a->t - b->t, error = (wide)a->t_error + b->t_error;
  if (wide_abs(apart) > error) return apart < 0 ? -1 : 1;
  if (!(judge_sharp(a) && judge_sharp(b))) judge_undecided(j, real_min(judge_least_t(a), judge_least_t(b)));
  return 0;
}

bool judge_stands_before(const struct exact_root *a, const struct exact_root *b)
{
  if (a->patch != b->patch) return a->patch < b->patch;
  const bool apart = wide_abs(a->u - b->u) > (wide)a->radius_u + b->radius_u;
  return apart ? a->u < b->u : a->v < b->v;
}

/* ---- what is found ---- */

void judge_root(struct judge *j, const struct exact_root *root)
{
  if (j->asks == JUDGE_ALL) {
    const struct exact_found found = {.root = *root, .kind = root->borders ? EXACT_BORDER : EXACT_INSIDE, .taken = -1};
    (void)exact_list_add(j->list, &found); /* on failure, list->failed is set */
    return;
  }
  if (j->asks == JUDGE_KNOWN && !within(j->asked->known, root)) return;
  if (j->hit && judge_same(j, &j->nearest, root)) return;
  const int order = j->hit ? judge_compare(j, &j->nearest, root) : 1;
  if (order >= 0) j->tied = order == 0;
  if (order > 0 || (order == 0 && judge_stands_before(root, &j->nearest))) j->nearest = *root, j->hit = true;
  set_limit(j);
}

/* The most open places of one ray that are listed; a surface along the ray may make hundreds. */
enum { LISTED_OPEN = 64 };

void judge_maybe(struct judge *j, double u, double v, double t, double t_error, double from)
{
  const struct ray *ray = j->asked->ray;
  const struct exact_root maybe = {.patch = j->patch, .u = u, .v = v, .t = t, .t_error = t_error};
  if (t < ray->t_min - t_error || t > ray->t_max + t_error) return;
  judge_undecided(j, from);
  if (!(t > ray->t_min + t_error && t < ray->t_max)) return;
  if (j->asks == JUDGE_ALL) {
    const struct exact_found found = {.root = maybe, .kind = EXACT_OPEN, .taken = -1};
    if (j->list->count < LISTED_OPEN) (void)exact_list_add(j->list, &found);
    return;
  }
  if (j->doubtful && (j->maybe.t < t || (j->maybe.t == t && j->maybe.patch <= j->patch))) return;
  j->maybe = maybe, j->doubtful = true;
  set_limit(j);
}

void judge_left(struct judge *j, double near, double far)
{
  if (near > j->limit) return;
  judge_undecided(j, near);
  j->cut_short |= far > j->asked->ray->t_min;
}

/* ---- regions ---- */

static int by_distance(const void *a, const void *b)
{
  const struct exact_region *x = a, *y = b;
  if (x->near != y->near) return x->near < y->near ? -1 : 1;
  return x->patch < y->patch ? -1 : x->patch > y->patch;
}

/* A region in which the ray lies leaves so much of the work for each of the others: what a ray next to a tangency
 * takes. */
enum { LEAST_SHARE = 512 * WORK_PIECE };

/* Searches the case's regions, the first that the ray meets first. */
static void search(struct judge *j)
{
  struct exact_region *regions = j->asked->regions;
  const size_t known = j->asks == JUDGE_NEAREST && j->asked->known; /* its patch may be searched, too */
  size_t count = 0;
  if (j->asked->region_count > 1) qsort(regions, j->asked->region_count, sizeof *regions, by_distance);
  for (size_t k = 0; k < j->asked->region_count; k++) /* those of one patch are next to each other */
    if (count == 0 || regions[count - 1].patch != regions[k].patch) regions[count++] = regions[k];
  for (size_t k = 0; k < count && regions[k].near <= j->limit; k++) {
    const int64_t left = j->pool.work, rest = left - (int64_t)(count - k - 1 + known) * LEAST_SHARE;
    const int64_t share = rest > LEAST_SHARE ? rest : left < LEAST_SHARE ? left : LEAST_SHARE;
    j->pool.work = share;
    exact_search(j, regions[k].patch, regions[k].near);
    j->pool.work += left - share;
  }
}

/* ---- the case ---- */

void judge_run(struct judge *j, const struct exact_case *asked, enum judge_asks asks, struct exact_list *list)
{
  j->asked = asked, j->asks = asks, j->list = list;
  j->hit = j->tied = j->doubtful = j->cut_short = false;
  j->pool = (struct pool){j->room, POOL_LIMBS, 0, (int64_t)asked->limit * WORK_PIECE};
  j->undecided = asked->cut_from, j->patch = UINT32_MAX;
  set_limit(j);
  search(j);
}

void judge_end(const struct judge *j) { *j->asked->work += j->asked->limit - (uint64_t)(j->pool.work / WORK_PIECE); }

void exact_closest(const struct exact_case *asked, struct exact_decision *out)
{
  const struct exact_root *known = asked->known;
  bool theirs = false; /* the answer is the known root */
  struct judge j;
  judge_run(&j, asked, JUDGE_NEAREST, NULL);
  if (known && !(j.hit && most_t(&j.nearest) < judge_least_t(known))) { /* nothing is clearly before it */
    theirs = asked->model->unproven || (!j.hit && j.undecided > most_t(known));
    if (!theirs && !(j.hit && judge_same(&j, known, &j.nearest))) exact_search(&j, known->patch, judge_least_t(known));
    theirs |= !j.hit || (!j.tied && judge_same(&j, known, &j.nearest));
    if (!j.hit) j.nearest = *known, j.hit = true;
  }
  const bool maybe = j.doubtful && !(j.hit && judge_least_t(&j.nearest) <= most_t(&j.maybe));
  out->sure = j.undecided == INFINITY || (j.hit && j.undecided > most_t(&j.nearest)); /* a doubt is undecided, too */
  out->known = theirs && !maybe, out->hit = j.hit || maybe, out->root = maybe ? j.maybe : j.nearest;
  judge_end(&j);
}

/* What a search for a root that is there may take. The ray's budget does not count: it may depend on its neighbours. */
enum { PLACE_LIMIT = 8192 };

void exact_place(const struct exact_case *asked, struct exact_root *out)
{
  struct ray ray = *asked->ray;
  struct exact_case here = *asked;
  struct exact_region region = {asked->known->patch, judge_least_t(asked->known)};
  struct judge j;
  ray.t_min = region.near; /* the root is behind it, and within the ray's range */
  here.ray = &ray, here.regions = &region, here.region_count = 1, here.limit = PLACE_LIMIT;
  judge_run(&j, &here, JUDGE_KNOWN, NULL);
  *out = j.hit ? j.nearest : *asked->known;
  judge_end(&j);
}

bool exact_occluded(const struct exact_case *asked, bool *proven)
{
  struct judge j;
  judge_run(&j, asked, JUDGE_ANY, NULL);
  judge_end(&j);
  *proven = j.hit || !(j.doubtful || j.cut_short);
  return j.hit || !*proven;
}
