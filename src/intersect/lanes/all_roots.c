/* All roots of r by Aberth's method on all lanes of a packet at once, and what can be proven of them.
 *
 * Compiled once per instruction set. This is method.c's task for the method that `solver aberth` means where its roots
 * are only to start from (prepare/model.c).
 */
#include <math.h>

#include "algebra/aberth_lanes.h"
#include "intersect/lanes/cover.h"
#include "intersect/lanes/nearest.h"

/* How many roots near [0,1] a lane may try: of 18, more are real in [0,1] next to never. How often the leaf is halved
 * to see that the ray passes it by before any root is sought. Choices of speed. */
enum { TRIED_ROOTS = 8, MISS_HALVINGS = 3 };

/* The roots tried, k-th of every lane. */
struct all_roots {
  int count;
  struct bilinear_root root[TRIED_ROOTS]; /* where the leaf has no parts, only `at` */
  lane_mask proven[TRIED_ROOTS];          /* a root that none before it is */
};

/* Start values on the lanes of `active`: the roots kept, taken off the real axis, or cold. */
static void all_roots_start(struct aberth_lanes *a, const struct solver_warm *warm, lane_mask active)
{
  if (warm && warm->count == a->degree) {
    for (int k = 0; k < a->degree; k++) {
      const double lift = fabs(warm->im[k]) < ABERTH_LIFT ? (k % 2 ? ABERTH_LIFT : -ABERTH_LIFT) : 0;
      a->zr[k] = lanes_all(2 * warm->re[k] - 1), a->zi[k] = lanes_all(2 * warm->im[k] + lift);
    }
    return;
  }
  for (int k = 0; k < a->degree; k++) a->zr[k] = a->zi[k] = lanes_all(1);
  for (unsigned bits = lanes_bits(active); bits; bits &= bits - 1) aberth_lanes_start(a, (unsigned)__builtin_ctz(bits));
}

/* Keeps the roots on one of the lanes for the next rays. */
static void all_roots_keep(const struct aberth_lanes *a, lane_mask done, struct solver_warm *warm)
{
  const unsigned bits = lanes_bits(done);
  if (!warm) return;
  warm->count = bits ? a->degree : 0;
  if (!bits) return;
  const unsigned lane = 31 - (unsigned)__builtin_clz(bits);
  for (int k = 0; k < a->degree; k++) warm->re[k] = 0.5 + 0.5 * a->zr[k][lane], warm->im[k] = 0.5 * a->zi[k][lane];
}

/* The roots near [0,1], collected lane by lane: kept[k] the k-th of every lane, has[k] where there is one. */
static int all_roots_near(const struct aberth_lanes *a, lane_mask done, lanes kept[TRIED_ROOTS],
                          lane_mask has[TRIED_ROOTS])
{
  int counts[LANES] = {0}, most = 0;
  for (int k = 0; k < TRIED_ROOTS; k++) kept[k] = lanes_all(0.5), has[k] = (lane_mask){0};
  for (int i = 0; i < a->degree; i++) {
    const lane_mask near = (lanes_abs(a->zi[i]) <= ABERTH_MARGIN) & (lanes_abs(a->zr[i]) <= 1 + ABERTH_MARGIN);
    for (unsigned bits = lanes_bits(done & near); bits; bits &= bits - 1) {
      const unsigned lane = (unsigned)__builtin_ctz(bits);
      if (counts[lane] == TRIED_ROOTS) continue;
      const int k = counts[lane]++;
      kept[k][lane] = 0.5 + 0.5 * a->zr[i][lane], has[k][lane] = -1;
      most = most > counts[lane] ? most : counts[lane];
    }
  }
  return most;
}

/* Makes the roots exact and proven. Returns the lanes that are decided: one root is alone in the leaf, or there are
 * as many as r has sign variations. */
static lane_mask all_roots_prove(const struct packet *p, const struct candidate *it, int count, const lanes kept[],
                                 const lane_mask has[], struct all_roots *all)
{
  const bool v_kept = it->leaf->v_kept;
  lane_mask alone = {0};
  lanes found = {0}, within = {0};
  all->count = count;
  for (int k = 0; k < count; k++) {
    struct newton_root *r = &all->root[k].at;
    lane_mask *proven = &all->proven[k];
    *proven = (lane_mask){0};
    const lane_mask open = has[k] & ~alone;
    *r = (struct newton_root){.exists = {0}};
    if (!lanes_any(open)) continue;
    const lanes at = start_within(kept[k]), other = start_within(resultant_eliminated(it, at));
    const lanes start[2] = {v_kept ? other : at, v_kept ? at : other};
    if (it->leaf->parts) bilinear_root_solve(p, it->leaf, it->axis, start, open, &all->root[k]);
    else *r = newton_refine(&it->nets, it->leaf, start[0], start[1], open);
    *proven = open & r->exists;
    for (int j = 0; j < k; j++) {
      const struct newton_root *old = &all->root[j].at;
      const lane_mask same = all->proven[j] & (lanes_abs(old->u - r->u) <= old->radius_u + r->radius_u) &
                             (lanes_abs(old->v - r->v) <= old->radius_v + r->radius_v);
      *proven &= ~same;
    }
    const lanes parameter = v_kept ? r->v : r->u, radius = v_kept ? r->radius_v : r->radius_u;
    found += lanes_select(*proven, lanes_all(1), lanes_all(0));
    within += lanes_select(*proven & (parameter > radius) & (1 - parameter > radius), lanes_all(1), lanes_all(0));
    /* whatever else was found is this root again */
    const lane_mask only = open & r->alone;
    for (int j = 0; j < k; j++) all->proven[j] &= ~only;
    *proven |= only;
    alone |= only;
  }
  return alone | ((found > 0) & (within == it->variations));
}

/* The same for lanes that this leaves open, by boxes. */
static lane_mask all_roots_cover(const struct candidate *it, const struct all_roots *all, lane_mask open)
{
  struct known_root known[TRIED_ROOTS];
  int count = 0;
  for (int k = 0; k < all->count; k++) {
    const struct newton_root *r = &all->root[k].at;
    const lane_mask proven = all->proven[k] & open;
    if (lanes_any(proven)) known[count++] = (struct known_root){r->u, r->v, r->size, r->bend, r->off, proven};
  }
  return cover_proves(it, count, known, COVER_HALVINGS, open);
}

/* The roots of r near [0,1] on the lanes of `active`, as starts: see all_roots_near. */
static int all_roots_solve(struct packet *p, const struct candidate *it, lane_mask active, lanes kept[TRIED_ROOTS],
                           lane_mask has[TRIED_ROOTS])
{
  const struct solver_options *options = &it->patch->method->roots;
  struct aberth_lanes a;
  active &= aberth_lanes_set(&a, it->degree, it->c);
  if (!lanes_any(active)) return 0;
  struct solver_warm *warm = p->model == p->tracer->model ? tracer_warm(p->tracer, it->patch->method, it->number)
                                                          : NULL;
  all_roots_start(&a, warm, active);
  const double settled = options->tolerance > ABERTH_SETTLED ? options->tolerance : ABERTH_SETTLED;
  const lane_mask done = aberth_lanes_run(&a, active, settled, options->max_iterations);
  all_roots_keep(&a, done, warm);
  p->tracer->counts.roots_found += (unsigned)(a.degree * __builtin_popcount(lanes_bits(done)));
  return all_roots_near(&a, done, kept, has);
}

/* The lanes of `active` that are decided, and their roots. */
static lane_mask all_roots_find(struct packet *p, const struct candidate *it, lane_mask active, struct all_roots *all)
{
  lanes kept[TRIED_ROOTS];
  lane_mask has[TRIED_ROOTS];
  all->count = 0;
  if (it->degree < 1) return (lane_mask){0};
  /* One sign variation is a root, which mostly is a hit. */
  const lane_mask doubtful = active & (it->variations != 1);
  lane_mask decided = {0};
  if (lanes_any(doubtful)) decided = cover_proves(it, 0, NULL, MISS_HALVINGS, doubtful);
  if (!lanes_any(active & ~decided)) return decided;
  const int count = all_roots_solve(p, it, active & ~decided, kept, has);
  decided |= all_roots_prove(p, it, count, kept, has, all);
  if (lanes_any(active & ~decided)) decided |= all_roots_cover(it, all, active & ~decided);
  return decided;
}

lane_mask stage_all_roots(struct packet *p, struct candidate *it, lane_mask active)
{
  struct all_roots all;
  const lane_mask decided = all_roots_find(p, it, active, &all);
  for (int k = 0; k < all.count; k++) {
    const lane_mask hits = decided & all.proven[k] & inside(&all.root[k].at);
    if (it->leaf->parts) offer_bend_root(p, it, &all.root[k], hits);
    else offer_root(p, it, &all.root[k].at, hits);
  }
  return active & ~decided;
}
