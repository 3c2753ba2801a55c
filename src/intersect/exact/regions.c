/* The regions that a ray leaves open: the order in which they are searched, and the work each may take. */
#include <stdlib.h>

#include "base/real.h"
#include "intersect/exact/judge.h"

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

static int by_distance(const void *a, const void *b)
{
  const struct exact_region *x = a, *y = b;
  if (x->near != y->near) return x->near < y->near ? -1 : 1;
  return by_region(x, y);
}

/* A region gets its share of the work that is left, or this much, so that one in which the ray lies leaves some for the
 * others: what a ray next to a tangency takes. */
enum { LEAST_SHARE = 512 };

void regions_search(struct judge *j)
{
  struct exact_region *regions = j->asked->regions;
  const size_t count = merge(regions, j->asked->region_count);
  if (!j->all && count > 1) qsort(regions, count, sizeof *regions, by_distance);
  for (size_t k = 0; k < count && (j->all || regions[k].near <= j->limit); k++) {
    const int all = j->work, fair = (int)((size_t)real_max(all, 0) / (count - k));
    const int share = fair > LEAST_SHARE ? fair : all < LEAST_SHARE ? all : LEAST_SHARE;
    if (all <= 0) {
      judge_left(j, regions[k].near, INFINITY);
      continue;
    }
    j->work = share;
    judge_turn(j, regions[k].patch);
    search_region(j, &regions[k]);
    j->work = all - share + j->work;
  }
}
