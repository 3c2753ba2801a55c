/* All roots of the rays of a packet. See gather.h.
 *
 * Compiled once per instruction set and without contraction. A lane that has left nothing open, and whose roots are
 * clearly one behind the other, is done but for its answers; the last resort decides the others (exact_all). Answers
 * are made as for nearest hits, from the first hits of all lanes together, then from the second ones, and so on.
 */
#include "intersect/lanes/gather.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void gather_start(struct packet *p, struct gather *gather)
{
  p->gather = gather;
  gather->roots.count = gather->open.count = gather->plan.count = gather->decided.count = 0;
  gather->failed = gather->decided.failed = gather->list.failed = false;
}

void gather_take(struct packet *p, lane_mask taken, const lanes at[2], const lanes radius[2], lanes t, lanes error,
                 int64_t patch, int64_t leaf, bool certain)
{
  struct gather *gather = p->gather;
  if (p->outer) {
    const lanes far = (p->shift + (t + error)) + 4 * UNIT_ROUNDOFF * (lanes_abs(p->shift) + lanes_abs(t + error));
    t = p->shift + t, error = far - t;
  }
  double uv[LANES][4], distance[LANES][4];
  lanes_store4(at[0], at[1], radius[0], radius[1], &uv[0][0], 4);
  lanes_store4(t, error, lanes_all(0), lanes_all(0), &distance[0][0], 4);
  struct gathered *root = growing_add(&gather->roots, lanes_count(taken), sizeof *root);
  gather->failed |= !root;
  for (unsigned bits = root ? lanes_bits(taken) : 0; bits; bits &= bits - 1, root++) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    memcpy(root->row[ROW_UV], uv[lane], sizeof uv[lane]);
    memcpy(root->row[ROW_DISTANCE], distance[lane], sizeof distance[lane]);
    root->leaf = leaf, root->patch = (uint32_t)patch, root->lane = (uint8_t)lane, root->certain = certain,
    root->final = false;
  }
}

void gather_surface(struct gather *gather, lane_mask taken, const struct surface_point *point, const lanes normal[3],
                    lanes tangent, lane_mask final)
{
  if (gather->failed) return;
  double at[LANES][4], across[LANES][4];
  lanes_store4(point->at[0], point->at[1], point->at[2], point->clearance, &at[0][0], 4);
  lanes_store4(normal[0], normal[1], normal[2], tangent, &across[0][0], 4);
  const unsigned finals = lanes_bits(final);
  struct gathered *root = (struct gathered *)gather->roots.at + gather->roots.count - lanes_count(taken);
  for (unsigned bits = lanes_bits(taken); bits; bits &= bits - 1, root++) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    memcpy(root->row[ROW_POINT], at[lane], sizeof at[lane]);
    memcpy(root->row[ROW_NORMAL], across[lane], sizeof across[lane]);
    root->row[ROW_DISTANCE][2] = point->error[lane], root->final = finals >> lane & 1;
  }
}

void gather_postpone(struct gather *gather, const struct exact_region *region, unsigned on)
{
  for (unsigned bits = on; bits; bits &= bits - 1) {
    struct gathered_region *open = growing_add(&gather->open, 1, sizeof *open);
    if (!open) gather->failed = true;
    else *open = (struct gathered_region){*region, (unsigned)__builtin_ctz(bits)};
  }
}

/* ---- which hits there are ---- */

static double t_of(const struct gathered *root) { return root->row[ROW_DISTANCE][0]; }
static double error_of(const struct gathered *root) { return root->row[ROW_DISTANCE][1]; }

/* In the order in which nearest.h prefers them, which does not depend on the walk. */
static int by_t(const void *a, const void *b)
{
  const struct gathered *x = *(const struct gathered *const *)a, *y = *(const struct gathered *const *)b;
  if (t_of(x) != t_of(y)) return t_of(x) < t_of(y) ? -1 : 1;
  if (x->patch != y->patch) return x->patch < y->patch ? -1 : 1;
  return x->leaf < y->leaf ? -1 : x->leaf > y->leaf;
}

/* Few are put in order faster one by one: the walk comes by them nearly so. */
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

/* All lanes' roots in order: lane l has those from begin[l] to begin[l + 1] of gather->order. */
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

/* Adds `count` hits, which are these roots or, where `roots` is NULL, of those decided. */
static void plan(struct gather *gather, const struct gathered *const roots[], size_t count)
{
  const struct gathered **planned = growing_add(&gather->plan, count, sizeof *planned);
  gather->failed |= !planned;
  for (size_t k = 0; k < count && planned; k++) planned[k] = roots ? roots[k] : NULL;
}

/* Has the last resort decide which hits the lane has, of whose roots the lanes have taken `count`. Returns whether that
 * is proven. */
static bool decide(struct packet *p, unsigned lane, const struct gathered *const roots[], size_t count)
{
  struct gather *gather = p->gather;
  struct exact_list *list = &gather->list;
  list->count = 0;
  for (size_t k = 0; k < count; k++) {
    const double *uv = roots[k]->row[ROW_UV];
    const struct exact_found found = {.root = {.patch = roots[k]->patch,
                                               .u = uv[0],
                                               .v = uv[1],
                                               .radius_u = uv[2],
                                               .radius_v = uv[3],
                                               .t = t_of(roots[k]),
                                               .t_error = error_of(roots[k])},
                                      .kind = roots[k]->certain ? EXACT_INSIDE : EXACT_OPEN,
                                      .taken = (int64_t)k};
    (void)exact_list_add(list, &found); /* or it has failed */
  }
  const struct exact_case asked = {
    .model = p->model, .ray = &p->rays[lane], .regions = gather->regions.at, .region_count = gather->regions.count};
  const bool sure = exact_all(&asked, list);
  for (size_t k = 0; k < list->count; k++) {
    const struct exact_found *found = &list->at[k];
    const bool taken = found->taken >= 0 && !found->root.sharp;
    plan(gather, taken ? &roots[found->taken] : NULL, 1);
    if (!taken) (void)exact_list_add(&gather->decided, found);
  }
  gather->failed |= list->failed || gather->decided.failed;
  return sure;
}

/* Plans the lane's hits. Returns whether it is proven that these are all, and their order. */
static bool plan_lane(struct packet *p, unsigned lane, const struct gathered *const roots[], size_t count)
{
  struct gather *gather = p->gather;
  bool certain = !p->model->unproven && !p->best.doubt[lane], tie = false;
  double reach = -INFINITY;
  for (size_t k = 0; k < count; k++) {
    certain &= roots[k]->certain;
    tie |= !(t_of(roots[k]) - error_of(roots[k]) > reach);
    reach = fmax(reach, t_of(roots[k]) + error_of(roots[k]));
  }
  collect_regions(gather, lane);
  if (gather->failed) return false;
  if (gather->regions.count > 0 || (tie && certain)) return decide(p, lane, roots, count) && certain;
  plan(gather, roots, count);
  return certain;
}

/* ---- the answers ---- */

/* Makes the planned hits the best roots of the lanes of `group`: next[lane], or the next one of those decided. Returns
 * the lanes whose hits are written, as bits. */
static unsigned set_best(struct packet *p, unsigned group, const struct gathered *const *const next[],
                         struct exact_found *decided[], struct hit out[])
{
  struct best *best = &p->best;
  double row[LANES][ROWS][4] = {{{0}}};
  unsigned written = 0;
  best->patch = NO_PATCH + (lane_mask){0};
  best->certain = best->final = best->doubt = (lane_mask){0};
  for (unsigned bits = group; bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    const struct gathered *root = *next[lane];
    if (!root) continue;
    memcpy(row[lane], root->row, sizeof root->row);
    best->patch[lane] = root->patch;
    best->certain[lane] = root->certain ? -1 : 0, best->final[lane] = root->final ? -1 : 0;
  }
  lanes t_error, unused;
  lanes_load4(row[0][ROW_UV], 4 * ROWS, &best->u, &best->v, &best->radius_u, &best->radius_v);
  lanes_load4(row[0][ROW_DISTANCE], 4 * ROWS, &best->t, &t_error, &best->point.error, &unused);
  lanes_load4(row[0][ROW_POINT], 4 * ROWS, &best->point.at[0], &best->point.at[1], &best->point.at[2],
              &best->point.clearance);
  lanes_load4(row[0][ROW_NORMAL], 4 * ROWS, &best->normal[0], &best->normal[1], &best->normal[2], &best->tangent);
  p->t_far = best->t + t_error;
  for (unsigned bits = group; bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    if (*next[lane]) continue;
    struct exact_found *found = decided[lane]++;
    const struct exact_root *root = &found->root;
    const struct exact_maybe maybe = {root->patch,     found->borders,  (double)root->u,
                                      (double)root->v, (double)root->t, root->t_error};
    if (found->kind == EXACT_OPEN) exact_maybe_hit(p->model, &p->rays[lane], &maybe, &out[lane]);
    else if (root->sharp) exact_root_hit(p->model, &p->rays[lane], &found->root, !p->model->unproven, &out[lane]);
    else finish_set_root(p, lane, root);
    if (found->kind == EXACT_OPEN || root->sharp) written |= 1u << lane;
  }
  return written;
}

/* Puts the hits of the lanes of `group` where they belong, behind those before them. */
static void put(const struct hit from[], unsigned group, size_t number, const int *exponents, struct hit *const to[],
                struct hit_list out[])
{
  for (unsigned bits = group; bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    struct hit *hit = to[lane] + number;
    *hit = from[lane];
    if (exponents && exponents[lane] != 0) hit->t = ldexp(hit->t, -exponents[lane]);
    /* What comes later is no nearer, though the last bits may say so. */
    if (number > 0) hit->t = fmax(hit->t, hit[-1].t);
    if (hit->certainty != CERTAINTY_CERTAIN) out[lane].certainty = CERTAINTY_GRAZING;
  }
}

bool gather_finish(struct packet *p, const int *exponents, struct hit_list out[])
{
  struct gather *gather = p->gather;
  size_t begin[LANES + 1], before[LANES][2];
  order_roots(gather, begin);
  for (unsigned lane = 0; lane < p->count && !gather->failed; lane++) {
    before[lane][0] = gather->plan.count, before[lane][1] = gather->decided.count;
    const bool sure = plan_lane(p, lane, (const struct gathered *const *)gather->order.at + begin[lane],
                                begin[lane + 1] - begin[lane]);
    out[lane].certainty = sure ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING;
    out[lane].count = gather->plan.count - before[lane][0];
  }
  struct hit *hits = gather->failed ? NULL : growing_add(&p->tracer->hits, gather->plan.count, sizeof *hits);
  if (!hits) return false;
  const struct gathered *const *next[LANES];
  struct exact_found *decided[LANES];
  struct hit *to[LANES], answer[LANES];
  for (unsigned lane = 0; lane < p->count; lane++) {
    next[lane] = (const struct gathered *const *)gather->plan.at + before[lane][0];
    decided[lane] = gather->decided.at + before[lane][1], to[lane] = hits + before[lane][0];
  }
  for (size_t number = 0;; number++) {
    unsigned group = 0;
    for (unsigned lane = 0; lane < p->count; lane++) group |= (unsigned)(number < out[lane].count) << lane;
    if (!group) return true;
    finish_best(p, set_best(p, group, next, decided, answer), answer);
    put(answer, group, number, exponents, to, out);
    for (unsigned bits = group; bits; bits &= bits - 1) next[__builtin_ctz(bits)]++;
  }
}
