/* All roots of the rays of a packet. See gather.h.
 *
 * Compiled once per instruction set and without contraction. A root gets its answer where it is found, just as the
 * nearest one does, together with those that other lanes find there. A lane that has left nothing open, and whose roots
 * are clearly one behind the other, then only needs them in order; the last resort decides the others (exact_all).
 */
#include "intersect/lanes/gather.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/real.h"

void gather_start(struct packet *p, struct gather *gather)
{
  if (!p->oriented) packet_orient(p);
  p->gather = gather;
  gather->roots.count = gather->open.count = 0;
  gather->failed = gather->list.failed = false;
}

/* Removes the best roots of the lanes of `taken`. */
static void forget_best(struct packet *p, lane_mask taken)
{
  p->best.t = lanes_select(taken, lanes_all(INFINITY), p->best.t);
  p->best.patch |= taken & NO_PATCH;
  p->best.certain &= ~taken, p->best.final &= ~taken;
  p->t_far = p->t_end, p->moved = false;
}

void gather_best(struct packet *p, lane_mask taken)
{
  struct gather *gather = p->gather;
  if (p->outer) {
    packet_leave(p);
    forget_best(p, taken);
    p = p->outer;
  }
  const struct best *best = &p->best;
  const unsigned certain = lanes_bits(best->certain);
  double uv[LANES][4], distance[LANES][4];
  struct hit hits[LANES];
  lanes_store4(best->u, best->v, best->radius_u, best->radius_v, &uv[0][0], 4);
  lanes_store4(best->t, p->t_far - best->t, lanes_all(0), lanes_all(0), &distance[0][0], 4);
  const lane_mask doubt = best->doubt; /* belongs to the list, whichever root came first */
  p->best.doubt = (lane_mask){0};
  (void)finish_best(p, 0, hits);
  p->best.doubt = doubt;
  struct gathered *root = growing_add(&gather->roots, lanes_count(taken), sizeof *root);
  gather->failed |= !root;
  for (unsigned bits = root ? lanes_bits(taken) : 0; bits; bits &= bits - 1, root++) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    memcpy(root->uv, uv[lane], sizeof uv[lane]);
    memcpy(root->distance, distance[lane], sizeof distance[lane]);
    root->hit = hits[lane], root->leaf = best->leaf[lane], root->lane = (uint8_t)lane;
    root->certain = certain >> lane & 1;
  }
  forget_best(p, taken);
}

void gather_postpone(struct gather *gather, uint32_t patch, unsigned lane)
{
  struct gathered_region *open = growing_add(&gather->open, 1, sizeof *open);
  if (!open) gather->failed = true;
  else *open = (struct gathered_region){{.patch = patch}, lane};
}

/* ---- which hits there are ---- */

static double t_of(const struct gathered *root) { return root->distance[0]; }
static double error_of(const struct gathered *root) { return root->distance[1]; }

/* The order in which nearest.h prefers roots, which does not depend on the walk. */
static int by_t(const void *a, const void *b)
{
  const struct gathered *x = *(const struct gathered *const *)a, *y = *(const struct gathered *const *)b;
  if (t_of(x) != t_of(y)) return t_of(x) < t_of(y) ? -1 : 1;
  if (x->hit.patch != y->hit.patch) return x->hit.patch < y->hit.patch ? -1 : 1;
  return x->leaf < y->leaf ? -1 : x->leaf > y->leaf;
}

/* Up to this many are sorted faster by insertion, because the walk finds them nearly in order. */
enum { SORTED_ONE_BY_ONE = 24 };

static void sort_roots(const struct gathered *roots[], size_t count)
{
  if (count > SORTED_ONE_BY_ONE) {
    qsort(roots, count, sizeof *roots, by_t);
    return;
  }
  for (size_t k = 1; k < count; k++) {
    const struct gathered *here = roots[k];
    size_t n = k;
    for (; n > 0 && by_t(&here, &roots[n - 1]) < 0; n--) roots[n] = roots[n - 1];
    roots[n] = here;
  }
}

/* Orders the roots of all lanes: those of lane l are from begin[l] to begin[l + 1] of gather->order. */
static void order_roots(struct gather *gather, size_t begin[LANES + 1])
{
  const struct gathered *roots = gather->roots.at;
  const size_t count = gather->roots.count;
  gather->order.count = 0;
  const struct gathered **order = growing_add(&gather->order, count, sizeof *order);
  size_t next[LANES + 1] = {0};
  gather->failed |= !order;
  if (gather->failed) return;
  for (size_t k = 0; k < count; k++) next[roots[k].lane + 1]++;
  for (size_t lane = 0; lane <= LANES; lane++) begin[lane] = next[lane] += lane > 0 ? next[lane - 1] : 0;
  for (size_t k = 0; k < count; k++) order[next[roots[k].lane]++] = &roots[k];
  for (size_t lane = 0; lane < LANES; lane++) sort_roots(order + begin[lane], begin[lane + 1] - begin[lane]);
}

static void collect_regions(struct gather *gather, unsigned lane)
{
  const struct gathered_region *open = gather->open.at;
  gather->regions.count = 0;
  for (size_t k = 0; k < gather->open.count; k++) {
    if (open[k].lane != lane) continue;
    struct exact_region *region = growing_add(&gather->regions, 1, sizeof *region);
    gather->failed |= !region;
    if (region) *region = open[k].region;
  }
}

/* Has the last resort decide which hits the lane has; `count` roots were taken by the lanes. gather->list gets the
 * hits. Returns whether they are proven. */
static bool decide(struct packet *p, unsigned lane, const struct gathered *const roots[], size_t count)
{
  struct gather *gather = p->gather;
  struct exact_list *list = &gather->list;
  list->count = 0;
  for (size_t k = 0; k < count; k++) {
    const double *uv = roots[k]->uv;
    const struct exact_found found = {.root = {.patch = roots[k]->hit.patch,
                                               .u = uv[0],
                                               .v = uv[1],
                                               .radius_u = uv[2],
                                               .radius_v = uv[3],
                                               .t = t_of(roots[k]),
                                               .t_error = error_of(roots[k])},
                                      .kind = roots[k]->certain ? EXACT_INSIDE : EXACT_OPEN,
                                      .taken = (int64_t)k};
    (void)exact_list_add(list, &found); /* on failure, list->failed is set */
  }
  const struct exact_case wanted = {.model = p->model,
                                    .ray = &p->rays[lane],
                                    .regions = gather->regions.at,
                                    .region_count = gather->regions.count,
                                    .work = &p->tracer->counts.work,
                                    .limit = packet_exact_limit(p, lane)};
  const bool sure = exact_all(&wanted, list);
  gather->failed |= list->failed;
  return sure;
}

/* The answer for what the last resort has found. */
static struct hit answer_found(struct packet *p, unsigned lane, const struct exact_found *found)
{
  struct hit hit;
  struct exact_root root = found->root;
  const struct exact_maybe maybe = {root.patch, (double)root.u, (double)root.v, (double)root.t, root.t_error};
  if (found->kind == EXACT_OPEN) exact_maybe_hit(p->model, &p->rays[lane], &maybe, &hit);
  else exact_root_hit(p->model, &p->rays[lane], &root, !p->model->unproven, &hit);
  return hit;
}

static struct hit *add_hits(struct packet *p, size_t count)
{
  struct hit *hits = growing_add(&p->tracer->hits, count, sizeof *hits);
  p->gather->failed |= !hits;
  return hits;
}

/* Adds the lane's hits to the tracer's. Returns the first of them. */
static struct hit *lane_hits(struct packet *p, unsigned lane, const struct gathered *roots[], size_t count,
                             struct hit_list *out)
{
  struct gather *gather = p->gather;
  bool certain = !p->model->unproven && !p->best.doubt[lane], tie = false;
  double reach = -INFINITY;
  for (size_t k = 0; k < count; k++) {
    const double t = t_of(roots[k]), error = error_of(roots[k]);
    certain &= roots[k]->certain, tie |= t - error <= reach;
    reach = real_max(t + error, reach);
  }
  gather->regions.count = 0;
  if (gather->open.count > 0) collect_regions(gather, lane);
  /* A list in doubt is decided, too: on a line where leaves meet, each of them finds the same root. */
  const bool decided = gather->regions.count > 0 || (tie && !p->model->unproven);
  if (decided) certain &= decide(p, lane, roots, count);
  out->certainty = certain ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING;
  out->count = decided ? gather->list.count : count;
  struct hit *hits = gather->failed ? NULL : add_hits(p, out->count);
  for (size_t k = 0; k < out->count && hits; k++) {
    const struct exact_found *found = decided ? &gather->list.at[k] : NULL;
    if (!found) hits[k] = roots[k]->hit;
    else if (found->taken >= 0 && !(found->tied && found->root.sharp)) hits[k] = roots[found->taken]->hit;
    else hits[k] = answer_found(p, lane, found);
  }
  return hits;
}

bool gather_finish(struct packet *p, const int *exponents, struct hit_list out[])
{
  struct gather *gather = p->gather;
  size_t begin[LANES + 1];
  order_roots(gather, begin);
  for (unsigned lane = 0; lane < p->count && !gather->failed; lane++) {
    struct hit *hits = lane_hits(p, lane, (const struct gathered **)gather->order.at + begin[lane],
                                 begin[lane + 1] - begin[lane], &out[lane]);
    for (size_t k = 0; k < out[lane].count && hits; k++) {
      if (exponents) hits[k].t = ldexp(hits[k].t, -exponents[lane]);
      /* Later hits are no nearer, though their last bits may say so. */
      if (k > 0 && hits[k].t < hits[k - 1].t) hits[k].t = hits[k - 1].t;
      if (hits[k].certainty != CERTAINTY_CERTAIN) out[lane].certainty = CERTAINTY_GRAZING;
    }
  }
  return !gather->failed;
}
