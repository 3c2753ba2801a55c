/* All hits of one ray: which of the roots found are the same, what those on borders mean, and their order.
 *
 * Each step is a proof or a doubt. Roots on a border count if the ray is proven to cross the surface there, once for all
 * the patches that meet. Roots at one t are in the order of their patches.
 */
#include <stdlib.h>

#include "base/memory.h"
#include "intersect/exact/judge.h"

bool exact_list_add(struct exact_list *list, const struct exact_found *found)
{
  struct exact_found *at = memory_grow(list->at, &list->room, list->count + 1, sizeof *at);
  list->failed |= !at;
  if (at) list->at = at, list->at[list->count++] = *found;
  return at;
}

/* Marks what is left out; the mark is a patch that does not exist. */
#define LEFT_OUT UINT32_MAX

static void list_close(struct exact_list *list)
{
  size_t kept = 0;
  for (size_t k = 0; k < list->count; k++)
    if (list->at[k].root.patch != LEFT_OUT) list->at[kept++] = list->at[k];
  list->count = kept;
}

/* By t, then by everything else but `taken`, so that the order does not depend on how they came. The lanes' roots of one
 * patch at one t are in the order of struct best. */
static int by_t(const void *a, const void *b)
{
  const struct exact_found *x = a, *y = b;
  if (x->root.t != y->root.t) return x->root.t < y->root.t ? -1 : 1;
  if (x->root.patch != y->root.patch) return x->root.patch < y->root.patch ? -1 : 1;
  if (x->leaf != y->leaf) return x->leaf < y->leaf ? -1 : 1;
  if (x->root.u != y->root.u) return x->root.u < y->root.u ? -1 : 1;
  if (x->root.v != y->root.v) return x->root.v < y->root.v ? -1 : 1;
  return x->kind < y->kind ? -1 : x->kind > y->kind;
}

/* Up to this many are sorted faster by insertion, because the walk finds them nearly in order. */
enum { SORTED_ONE_BY_ONE = 24 };

static void list_sort(struct exact_list *list)
{
  if (list->count > SORTED_ONE_BY_ONE) {
    qsort(list->at, list->count, sizeof *list->at, by_t);
    return;
  }
  for (size_t k = 1; k < list->count; k++) {
    const struct exact_found here = list->at[k];
    size_t n = k;
    for (; n > 0 && by_t(&here, &list->at[n - 1]) < 0; n--) list->at[n] = list->at[n - 1];
    list->at[n] = here;
  }
}

/* Whether b, of no less t, may be met at the same t as a. */
static bool overlap(const struct exact_found *a, const struct exact_found *b)
{
  return b->root.t - a->root.t <= (wide)a->root.t_error + b->root.t_error;
}

/* Of roots that are one, keeps one: of one that the lanes found and one that is exact, the number and the place. An open
 * place is left out where a root is. */
static void leave_out_same(struct judge *j)
{
  struct exact_found *at = j->list->at;
  wide widest = 0; /* of two that overlap, the difference is no more */
  list_sort(j->list);
  for (size_t k = 0; k < j->list->count; k++) widest = wide_max(widest, 2 * (wide)at[k].root.t_error);
  for (size_t a = 0; a < j->list->count; a++) {
    for (size_t b = a + 1; b < j->list->count && at[b].root.t - at[a].root.t <= widest; b++) {
      if (at[a].root.patch == LEFT_OUT || at[b].root.patch == LEFT_OUT || !overlap(&at[a], &at[b])) continue;
      const bool open = at[a].kind == EXACT_OPEN, other_open = at[b].kind == EXACT_OPEN;
      if (!open && !other_open && !judge_same(j, &at[a].root, &at[b].root)) continue;
      const struct exact_found lanes = at[a].taken >= 0 ? at[a] : at[b];
      if (!other_open && (open || at[b].taken < 0)) at[a] = at[b];
      at[a].taken = lanes.taken, at[a].tied |= lanes.tied, at[b].root.patch = LEFT_OUT;
    }
  }
  list_close(j->list);
}

/* The first of the lanes' roots that may be met at one t with another root, and was not sought yet; NULL for none. */
static struct exact_found *first_tied(const struct exact_list *list)
{
  for (size_t k = 0; k < list->count; k++) {
    struct exact_found *at = &list->at[k];
    const bool tied = (k > 0 && overlap(at - 1, at)) || (k + 1 < list->count && overlap(at, at + 1));
    if (tied && at->taken >= 0 && !at->tied && !judge_sharp(&at->root)) return at;
  }
  return NULL;
}

/* Searches the patches of such roots. For now, `tied` says so. */
static void search_tied(struct judge *j)
{
  struct exact_found *tied;
  while (j->pool.work > 0 && (tied = first_tied(j->list))) {
    tied->tied = true;
    exact_search(j, tied->root.patch, (double)tied->root.t);
    leave_out_same(j);
  }
}

/* A root on a border is a hit if the ray crosses the surface there; otherwise it may be. */
static void settle_borders(struct judge *j)
{
  struct exact_found *at = j->list->at;
  for (size_t k = 0; k < j->list->count; k++) {
    if (at[k].kind != EXACT_BORDER || at[k].root.patch == LEFT_OUT) continue;
    size_t which[VERTEX_MAX], first = k;
    const size_t count = vertex_crossed(j, k, which);
    for (size_t n = 0; n < count; n++)
      if (at[which[n]].root.patch < at[first].root.patch) first = which[n];
    for (size_t n = 0; n < count; n++)
      if (which[n] != first) at[which[n]].root.patch = LEFT_OUT;
    at[first].kind = count > 0 ? EXACT_INSIDE : EXACT_OPEN;
    if (count == 0) judge_undecided(j, (double)at[first].root.t);
  }
  list_close(j->list);
}

/* Puts roots that are met at one t in the order of their patches, and marks them. */
static void order(struct judge *j)
{
  struct exact_found *at = j->list->at;
  for (size_t k = 0; k < j->list->count; k++) {
    struct exact_found here = at[k];
    size_t n = k;
    here.tied = false;
    while (n > 0 && here.kind != EXACT_OPEN && at[n - 1].kind != EXACT_OPEN &&
           judge_compare(j, &at[n - 1].root, &here.root) == 0) {
      here.tied = at[n - 1].tied = true;
      if (!judge_stands_before(&here.root, &at[n - 1].root)) break;
      at[n] = at[n - 1], n--;
    }
    at[n] = here;
  }
}

bool exact_all(const struct exact_case *asked, struct exact_list *list)
{
  struct judge j;
  list_sort(list);
  if (asked->model->unproven) return false;
  if (asked->region_count == 0 && !first_tied(list)) return true;
  judge_run(&j, asked, JUDGE_ALL, list);
  leave_out_same(&j);
  search_tied(&j);
  settle_borders(&j);
  leave_out_same(&j);
  order(&j);
  judge_end(&j);
  return j.undecided == INFINITY;
}
