/* The regions that a ray leaves open: the order in which they are searched, and the work each may take. A region at a
 * pole is widened to the strip along it, and many regions of one patch are searched as one. */
#include <math.h>
#include <stdlib.h>

#include "base/real.h"
#include "intersect/exact/judge.h"
#include "intersect/prepare/leaf.h"

/* A ray this near to a pole, in the patch's frame, may meet the strip of leaves along it anywhere; one farther away
 * meets them like any others. A choice of speed. */
#define POLE_NEAR 0x1p-8

static bool passes_near(const struct judge *j, int border)
{
  const struct local_ray *ray = &j->local;
  double(*x)[4][4] = j->prepared->x;
  const int row = edge_at(border, 0) / 4, column = edge_at(border, 0) % 4;
  for (int s = 0; s < 2; s++) {
    const double side = x[(ray->axis + 1 + s) % 3][row][column] - ray->moment[s];
    if (!(fabs(side - ray->slope[s] * x[ray->axis][row][column]) <= POLE_NEAR)) return false;
  }
  return true;
}

/* Widens a region at a border that is one point to the whole strip along it, because a ray that passes the pole closely
 * may meet the strip anywhere. */
static void region_widen(struct judge *j, struct exact_region *r)
{
  judge_turn(j, r->patch);
  const struct model_patch *patch = j->prepared;
  const struct exact_region narrow = *r;
  for (int border = 0; border < 4; border++) {
    const int across = 1 - border / 2;
    if (patch->cut.split[across] == 1 || !leaf_border_is_point(patch, narrow.column, narrow.span, border)) continue;
    if (!passes_near(j, border)) continue;
    r->column[across] = 0, r->span[across] = patch->cut.split[across], r->leaf = NULL;
  }
}

static int by_region(const void *a, const void *b)
{
  const struct exact_region *x = a, *y = b;
  if (x->patch != y->patch) return x->patch < y->patch ? -1 : 1;
  for (int k = 0; k < 2; k++)
    if (x->column[k] != y->column[k]) return x->column[k] < y->column[k] ? -1 : 1;
  for (int k = 0; k < 2; k++)
    if (x->span[k] != y->span[k]) return x->span[k] < y->span[k] ? -1 : 1;
  return 0;
}

void exact_region_join(struct exact_region *region, const struct exact_region *other)
{
  region->near = real_min(region->near, other->near);
  if (exact_region_equal(region, other)) return;
  region->leaf = NULL;
  for (int k = 0; k < 2; k++) {
    const int end = region->column[k] + region->span[k], other_end = other->column[k] + other->span[k];
    if (other->column[k] < region->column[k]) region->column[k] = other->column[k];
    region->span[k] = (uint16_t)((end > other_end ? end : other_end) - region->column[k]);
  }
}

/* More regions of a patch than this are searched as one: the patch lies along the ray, or the ray starts so far away
 * that double precision tells nothing of it. A choice of speed. */
enum { REGIONS_APART = 8 };

/* Joins a patch's regions if there are more than REGIONS_APART of them. Returns how many remain, sorted. */
static size_t merge(struct exact_region regions[], size_t count)
{
  size_t kept = 0;
  if (count > 1) qsort(regions, count, sizeof *regions, by_region);
  for (size_t first = 0, end; first < count; first = end) {
    for (end = first + 1; end < count && regions[end].patch == regions[first].patch;) end++;
    const bool apart = end - first <= REGIONS_APART;
    for (size_t k = first; k < end; k++) /* each once */
      if (k == first || (apart && !exact_region_equal(&regions[kept - 1], &regions[k]))) regions[kept++] = regions[k];
      else exact_region_join(&regions[kept - 1], &regions[k]);
  }
  return kept;
}

/* Work reserved for single regions, the same for each and at most REGION_WORK, so that a region in which the ray lies
 * does not leave the others undecided. All of it takes less than a millisecond. */
enum { APART_WORK = 1536, REGION_WORK = 512 };

/* A region is not begun with less than this: one root and what is tied with it, both sharpened. */
enum { LEAST_WORK = 64 };

static int by_distance(const void *a, const void *b)
{
  const struct exact_region *x = a, *y = b;
  if (x->near != y->near) return x->near < y->near ? -1 : 1;
  return by_region(x, y);
}

/* Searches the region with its share of the reserved work, and with all shared work unless something may be a hit. What
 * it leaves of its share is for the next regions. left: the number of regions from this one on. */
static void search(struct judge *j, const struct exact_region *region, size_t left)
{
  const int part = (int)((size_t)j->apart / left), own = j->own = part < REGION_WORK ? part : REGION_WORK;
  const int shared = j->doubtful ? 0 : j->work;
  const uint64_t before = *j->asked->work;
  const size_t found = j->list->count;
  judge_turn(j, region->patch);
  j->work = shared + own < LEAST_WORK ? 0 : shared + own;
  judge_spend(j, WORK_REGION);
  search_region(j, region);
  const int took = (int)(*j->asked->work - before);
  j->apart -= took < own ? took : own;
  j->work = took < own ? shared : took < shared + own ? shared + own - took : 0;
  if (j->all && j->list->count <= HITS_MOST) j->work += WORK_HIT * (int)(j->list->count - found);
}

void judge_search(struct judge *j)
{
  struct exact_region *regions = j->asked->regions;
  size_t count = j->asked->region_count;
  for (size_t k = 0; k < count; k++) region_widen(j, &regions[k]);
  count = merge(regions, count);
  j->apart = APART_WORK;
  if (!j->all && count > 1) qsort(regions, count, sizeof *regions, by_distance);
  for (size_t k = 0; k < count && (j->all || regions[k].near <= j->limit); k++) search(j, &regions[k], count - k);
}
