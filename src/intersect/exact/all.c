/* All hits of one ray: which of the roots found are the same, what those on borders mean, and their order.
 *
 * Each step is a proof or a doubt. Roots on a border count if the ray is proven to cross the surface there, once for all
 * the patches that meet. Roots at one t are in the order of their patches.
 */
#include <stdlib.h>

#include "base/memory.h"
#include "base/real.h"
#include "intersect/exact/judge.h"

bool exact_list_add(struct exact_list *list, const struct exact_found *found)
{
  struct exact_found *at = memory_grow(list->at, &list->room, list->count + 1, sizeof *at);
  list->failed |= !at;
  if (!at) return false;
  list->at = at;
  list->at[list->count++] = *found;
  return true;
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

/* By t, then by everything else but `taken`, so that the order does not depend on how they came. At equal t and patch the
 * lanes' roots come first, in the order of struct best. */
static int by_t(const void *a, const void *b)
{
  const struct exact_found *x = a, *y = b;
  if (x->root.t != y->root.t) return x->root.t < y->root.t ? -1 : 1;
  if (x->root.patch != y->root.patch) return x->root.patch < y->root.patch ? -1 : 1;
  if ((x->taken < 0) != (y->taken < 0)) return x->taken < 0 ? 1 : -1;
  if (x->leaf != y->leaf) return x->leaf < y->leaf ? -1 : 1;
  if (x->root.u != y->root.u) return x->root.u < y->root.u ? -1 : 1;
  if (x->root.v != y->root.v) return x->root.v < y->root.v ? -1 : 1;
  return x->kind < y->kind ? -1 : x->kind > y->kind;
}

/* Up to this many are sorted faster by insertion, because the walk finds them nearly in order. */
enum { SORTED_ONE_BY_ONE = 24 };

void exact_list_sort(struct exact_list *list)
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

/* Of roots that are one, keeps the one of least t: it would be the nearest hit. An open place is left out where a root
 * is. */
static void leave_out_same(struct judge *j)
{
  struct exact_found *at = j->list->at;
  for (size_t a = 0; a < j->list->count; a++) {
    for (size_t b = a + 1; b < j->list->count && overlap(&at[a], &at[b]); b++) {
      if (at[a].root.patch == LEFT_OUT || at[b].root.patch == LEFT_OUT) continue;
      bool sure = true;
      if (at[b].kind == EXACT_OPEN) at[b].root.patch = LEFT_OUT;
      else if (at[a].kind == EXACT_OPEN) at[a].root.patch = LEFT_OUT;
      else if (judge_same(j, &at[a].root, &at[b].root, &sure)) at[b].root.patch = LEFT_OUT, j->doubt |= !sure;
    }
  }
  list_close(j->list);
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
    j->doubt |= count == 0;
  }
  list_close(j->list);
}

/* Puts those that are met at one t in the order of their patches. */
static void order(struct judge *j)
{
  struct exact_found *at = j->list->at;
  for (size_t a = 0; a < j->list->count; a++) {
    for (size_t b = a + 1; b < j->list->count && overlap(&at[a], &at[b]); b++) {
      bool sure = true;
      if (at[a].kind == EXACT_OPEN || at[b].kind == EXACT_OPEN) continue;
      (void)judge_compare(j, &at[a].root, &at[b].root, &sure);
      at[a].tied = at[b].tied = true;
      j->doubt |= !sure;
    }
  }
  exact_list_sort(j->list);
  for (size_t k = 1; k < j->list->count; k++) {
    const struct exact_found here = at[k];
    size_t n = k;
    for (; n > 0 && here.kind != EXACT_OPEN && at[n - 1].kind != EXACT_OPEN && overlap(&at[n - 1], &here) &&
           judge_stands_before(&here.root, &at[n - 1].root);
         n--)
      at[n] = at[n - 1];
    at[n] = here;
  }
}

/* Whether all are hits, one clearly behind the other. */
static bool clearly_apart(const struct exact_list *list)
{
  double reach = -INFINITY;
  for (size_t k = 0; k < list->count; k++) {
    const struct exact_found *found = &list->at[k];
    const double t = (double)found->root.t, off = found->root.t_error + UNIT_ROUNDOFF * fabs(t);
    if (found->kind != EXACT_INSIDE || t - off <= reach) return false;
    reach = t + off;
  }
  return true;
}

bool exact_all(const struct exact_case *asked, struct exact_list *list)
{
  struct judge j;
  exact_list_sort(list);
  if (asked->region_count == 0 && clearly_apart(list)) return true;
  judge_run(&j, asked, JUDGE_ALL, list);
  exact_list_sort(list);
  leave_out_same(&j);
  settle_borders(&j);
  exact_list_sort(list);
  leave_out_same(&j);
  order(&j);
  return !j.doubt;
}
