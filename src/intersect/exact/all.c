/* All hits of one ray: which of the roots found are the same, what those on borders mean, and their order.
 *
 * Each step is a proof or a doubt. Roots of one patch whose enclosures meet are one root if one enclosure holds the
 * other, or if the certificate proves that no other root is as near. Roots on a border count if the ray is proven to
 * cross the surface there, once for all the patches that meet. Two roots whose order double precision cannot tell are
 * refined as far as wide arithmetic allows; those at one t even then are in the order of their patches.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "geometry/twins.h"
#include "intersect/exact/judge.h"

/* The most open places of one ray that are listed; a surface along the ray may make hundreds. */
enum { LISTED_OPEN = 64 };

/* Work that telling apart, settling and ordering may take in addition to the search. Comparing this many roots takes as
 * long as examining a box. What is left when the work runs out is a doubt. */
enum { ALL_WORK = 2560, WORK_COMPARED = 64 };

bool exact_list_add(struct exact_list *list, const struct exact_found *found)
{
  if (list->fixed && list->count == list->room) return false;
  if (!list->fixed) {
    struct exact_found *at = memory_grow(list->at, &list->room, list->count + 1, sizeof *at);
    list->failed |= !at;
    if (!at) return false;
    list->at = at;
  }
  struct exact_found *added = &list->at[list->count++];
  *added = *found;
  added->least = found->root.t - found->root.t_error;
  return true;
}

/* Removes the marked ones from the list; the mark is a patch that does not exist. */
#define LEFT_OUT UINT32_MAX

static void list_close(struct exact_list *list)
{
  size_t kept = 0;
  for (size_t k = 0; k < list->count; k++)
    if (list->at[k].root.patch != LEFT_OUT) list->at[kept++] = list->at[k];
  list->count = kept;
}

void judge_add_open(struct judge *j, const struct exact_maybe *maybe)
{
  j->doubt = true;
  const struct exact_found found = {
    .root = {.patch = maybe->patch, .u = maybe->u, .v = maybe->v, .t = maybe->t, .t_error = maybe->t_error},
    .kind = EXACT_OPEN,
    .borders = maybe->borders,
    .taken = -1};
  if (j->open < LISTED_OPEN) (void)exact_list_add(j->list, &found); /* on failure, list->failed is set */
  j->open++;
}

/* ---- the same root ---- */

static double apart(wide a, wide b) { return fabs((double)(a - b)); }

/* Whether the enclosure of root a holds all of b's. */
static bool holds(const struct exact_root *a, const struct exact_root *b)
{
  return apart(a->u, b->u) + b->radius_u <= a->radius_u && apart(a->v, b->v) + b->radius_v <= a->radius_v;
}

/* Whether two roots of one patch are one. If that cannot be told, true, and a doubt. */
static bool same_root(struct judge *j, const struct exact_root *a, const struct exact_root *b)
{
  if (!exact_roots_meet(a, b)) return false;
  if (holds(a, b) || holds(b, a)) return true;
  struct exact_root one = *a, two = *b;
  if (judge_sharpen(j, &one) && judge_sharpen(j, &two)) {
    if (!exact_roots_meet(&one, &two)) return false;
    const double off = fmax(apart(one.u, two.u) + one.radius_u + two.radius_u,
                            apart(one.v, two.v) + one.radius_v + two.radius_v);
    if (off <= fmax(one.alone, two.alone) || holds(&one, &two) || holds(&two, &one)) return true;
  }
  j->doubt = true;
  return true;
}

/* The end of the run of roots from `first` on in which each may be at one t with another one. A root with a large error
 * may reach back over others. */
static size_t run_end(const struct exact_list *list, size_t first)
{
  wide reach = list->at[first].root.t + list->at[first].root.t_error;
  size_t end = first + 1;
  for (; end < list->count && list->at[end].least <= reach; end++) {
    const struct exact_root *root = &list->at[end].root;
    if (root->t + root->t_error > reach) reach = root->t + root->t_error;
  }
  return end;
}

/* Takes the work of comparing `count` roots with one of them. Returns whether none is left, which is a doubt. */
static bool worn_out(struct judge *j, size_t count)
{
  judge_spend(j, 1 + (int)(count / WORK_COMPARED));
  j->doubt |= j->work <= 0;
  return j->work <= 0;
}

/* Of roots that are one, keeps the first, which has the least t: it is the one that would be the nearest hit. */
static void leave_out_same(struct judge *j, size_t first, size_t end)
{
  struct exact_found *at = j->list->at;
  for (size_t a = first; a < end && !worn_out(j, end - a); a++) {
    for (size_t b = a + 1; b < end && at[a].root.patch != LEFT_OUT; b++) {
      if (at[b].root.patch != at[a].root.patch || at[a].kind == EXACT_OPEN || at[b].kind == EXACT_OPEN) continue;
      if (!same_root(j, &at[a].root, &at[b].root)) continue;
      /* If one is known to be inside its patch, both are. */
      if (at[a].kind == EXACT_BORDER) at[a] = at[b];
      at[b].root.patch = LEFT_OUT;
    }
  }
}

/* An open place is not listed if t does not tell it from another hit there. */
static void leave_out_open(struct judge *j, size_t first, size_t end)
{
  struct exact_found *at = j->list->at;
  for (size_t a = first; a < end; a++) {
    if (at[a].kind != EXACT_OPEN) continue;
    for (size_t b = first; b < end; b++)
      if (b != a && at[b].root.patch != LEFT_OUT && (at[b].kind == EXACT_INSIDE || b < a) &&
          judge_tie(&at[a].root, &at[b].root)) {
        at[a].root.patch = LEFT_OUT;
        break;
      }
  }
}

/* ---- borders ---- */

/* Makes the roots which[0..count-1] of the list one hit, on the patch that stands first in the scene. */
static void count_once(struct judge *j, const size_t which[], size_t count)
{
  struct exact_found *at = j->list->at, *first = &at[which[0]];
  for (size_t k = 1; k < count; k++)
    if (at[which[k]].root.patch < first->root.patch) first = &at[which[k]];
  for (size_t k = 0; k < count; k++)
    if (&at[which[k]] != first) at[which[k]].root.patch = LEFT_OUT;
  judge_to_border(j, first);
  first->kind = EXACT_INSIDE;
}

/* A root on a border is a hit if the ray crosses the surface there; otherwise it may be. */
static void settle_border(struct judge *j, size_t at, size_t first, size_t end)
{
  const bool left = !worn_out(j, end - first);
  size_t which[STAR_MAX] = {at}, count = left ? judge_star(j, at, first, end, which) : 0;
  for (size_t b = first; b < end && count == 0 && left; b++) {
    const struct exact_found *other = &j->list->at[b];
    if (b == at || other->root.patch == LEFT_OUT || other->kind != EXACT_BORDER) continue;
    if (judge_across(j, &j->list->at[at], other)) which[0] = at, which[1] = b, count = 2;
  }
  if (count > 0) {
    count_once(j, which, count);
    return;
  }
  const struct exact_found border = j->list->at[at];
  j->list->at[at].root.patch = LEFT_OUT;
  judge_open(j, &border);
}

/* ---- the order ---- */

/* By t, then by everything else, so that the order does not depend on how they came. At equal t and patch the lanes'
 * roots come first, in their order. */
static int by_t(const void *a, const void *b)
{
  const struct exact_found *x = a, *y = b;
  if (x->root.t != y->root.t) return x->root.t < y->root.t ? -1 : 1;
  if (x->root.patch != y->root.patch) return x->root.patch < y->root.patch ? -1 : 1;
  if ((x->taken < 0) != (y->taken < 0)) return x->taken < 0 ? 1 : -1;
  if (x->taken != y->taken) return x->taken < y->taken ? -1 : 1;
  if (x->root.u != y->root.u) return x->root.u < y->root.u ? -1 : 1;
  if (x->root.v != y->root.v) return x->root.v < y->root.v ? -1 : 1;
  return x->kind < y->kind ? -1 : x->kind > y->kind;
}

static void sort_part(struct exact_found at[], size_t count)
{
  if (count > 1) qsort(at, count, sizeof *at, by_t);
  wide least = INFINITY;
  for (size_t k = count; k-- > 0;) {
    const struct exact_root *root = &at[k].root;
    if (root->t - root->t_error < least) least = root->t - root->t_error;
    at[k].least = least;
  }
}

static void sort(struct exact_list *list) { sort_part(list->at, list->count); }

/* Whether the patches are different and lie exactly on each other. */
static bool are_twins(const struct judge *j, const struct exact_root *a, const struct exact_root *b)
{
  const struct model *model = j->asked->model;
  struct scene_patch *patches = model->scene->patches;
  return model->twin && (model->twin[a->patch] || model->twin[b->patch]) && a->patch != b->patch &&
         net_twins(patches[a->patch].P, patches[b->patch].P);
}

/* Whether the two roots, of twins, are certainly one: nets in the same order have the same parameters. */
static bool one_of_equal(const struct judge *j, const struct exact_root *a, const struct exact_root *b)
{
  struct scene_patch *patches = j->asked->model->scene->patches;
  return (holds(a, b) || holds(b, a)) && net_equal(patches[a->patch].P, patches[b->patch].P);
}

/* Whether nothing tells which of the two comes first. An open place has its place by t. */
static bool tie(const struct exact_found *a, const struct exact_found *b)
{
  return a->kind != EXACT_OPEN && b->kind != EXACT_OPEN && judge_tie(&a->root, &b->root);
}

/* Sharpens two roots that cannot be told apart, each if possible, as is done if only the nearest hit is asked for. */
static void tell_apart(struct judge *j, struct exact_found *a, struct exact_found *b)
{
  const bool twins = are_twins(j, &a->root, &b->root);
  if (!tie(a, b) || (twins && one_of_equal(j, &a->root, &b->root))) return;
  judge_improve(j, &a->root), judge_improve(j, &b->root);
  if (!twins) a->tied = b->tied = true;
}

/* The error of t that counts in asking what is behind it. An open place has its place by t. */
static double end_error(const struct exact_found *found) { return found->kind == EXACT_OPEN ? 0 : found->root.t_error; }

/* Whether `a`, a root, is proven to be behind `b`: by the same difference as in judge_tie, because sums of t and error
 * are rounded. */
static bool behind(const struct exact_found *a, const struct exact_found *b)
{
  return a->root.t - b->root.t > a->root.t_error + end_error(b);
}

/* The next in order of those from `first` on, which are sorted by t: the first in the scene of those not proven to be
 * behind any of the others. It is a doubt if it matters that this one comes before others it cannot be told from. */
static size_t next_in_order(struct judge *j, size_t first, size_t end)
{
  const struct exact_found *at = j->list->at;
  size_t next = first, ends = first; /* anything behind one of them is behind the one that ends first */
  wide reach = INFINITY;
  for (size_t k = first; k < end && at[k].least <= reach; k++) {
    if (at[k].root.t - at[ends].root.t < (wide)end_error(&at[ends]) - end_error(&at[k])) ends = k;
    reach = at[ends].root.t + end_error(&at[ends]);
  }
  for (size_t k = first + 1; k < end && at[k].least <= reach; k++) {
    if (at[k].kind == EXACT_OPEN || behind(&at[k], &at[ends])) continue;
    if (at[next].kind != EXACT_OPEN && judge_stands_before(&at[k].root, &at[next].root)) next = k;
  }
  for (size_t k = first; k < end && at[k].least <= reach && !j->doubt; k++) {
    const struct exact_root *a = &at[next].root, *b = &at[k].root;
    if (k == next || !tie(&at[next], &at[k])) continue;
    if (are_twins(j, a, b) && one_of_equal(j, a, b)) continue;
    j->doubt |= !judge_tie_fine(a, b);
  }
  return next;
}

static void order(struct judge *j, size_t first, size_t end)
{
  struct exact_found *at = j->list->at;
  for (size_t k = first; k < end && !worn_out(j, 1); k++) {
    const wide reach = at[k].root.t + at[k].root.t_error;
    for (size_t n = k + 1; n < end && at[n].least <= reach && j->work > 0; n++) tell_apart(j, &at[k], &at[n]);
  }
  sort_part(at + first, end - first);
  for (size_t k = first; k + 1 < end && !worn_out(j, 1); k++) {
    const size_t next = next_in_order(j, k, end);
    const struct exact_found found = at[next];
    memmove(at + k + 1, at + k, (next - k) * sizeof *at);
    at[k] = found;
  }
}

/* Calls `run` for all runs of roots that t does not tell apart. */
static void for_runs(struct judge *j, void (*run)(struct judge *j, size_t first, size_t end))
{
  for (size_t first = 0, end; first < j->list->count; first = end) {
    end = run_end(j->list, first);
    if (end - first > 1) run(j, first, end);
  }
}

bool exact_all(const struct exact_case *asked, struct exact_list *list)
{
  struct judge j;
  judge_run(&j, asked, true, list);
  j.work = ALL_WORK + WORK_HIT * (int)(list->count < HITS_MOST ? list->count : HITS_MOST);
  if ((uint64_t)j.work > asked->limit) j.work = (int)asked->limit;
  sort(list);
  for_runs(&j, leave_out_same);
  list_close(list);
  const size_t count = list->count; /* open places are added at the end */
  for (size_t first = 0, end; first < count; first = end) {
    end = run_end(list, first);
    end = end < count ? end : count;
    for (size_t k = first; k < end; k++)
      if (list->at[k].kind == EXACT_BORDER && list->at[k].root.patch != LEFT_OUT) settle_border(&j, k, first, end);
  }
  list_close(list);
  sort(list);
  for_runs(&j, leave_out_open);
  list_close(list);
  for_runs(&j, order);
  return !j.doubt;
}
