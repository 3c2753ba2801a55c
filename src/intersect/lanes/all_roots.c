/* The roots of r by the scene's method, on all lanes of a packet at once or one by one, and what is
 * proven of them.
 *
 * Compiled once per instruction set.
 */
#include <math.h>

#include "algebra/roots_lanes.h"
#include "intersect/lanes/cover.h"
#include "intersect/lanes/nearest.h"

/* The roots tried: the k-th of every lane. */
struct all_roots {
  int count;
  struct leaf_root root[TRIED_ROOTS];
  lane_mask proven[TRIED_ROOTS]; /* a root, and none of those before it */
};

/* Sets start values on the lanes of `active`: the roots that were kept, moved off the real axis, or cold ones. */
static void all_roots_start(struct roots_lanes *a, const struct solver_warm *warm, lane_mask active)
{
  if (!warm || warm->count != a->degree) {
    roots_lanes_start(a, active);
    return;
  }
  for (int k = 0; k < a->degree; k++) {
    const double lift = fabs(warm->im[k]) < ROOTS_LIFT ? (k % 2 ? ROOTS_LIFT : -ROOTS_LIFT) : 0;
    a->zr[k] = lanes_all(2 * warm->re[k] - 1), a->zi[k] = lanes_all(2 * warm->im[k] + lift);
  }
}

/* Keeps the roots of one lane for the next rays. */
static void all_roots_keep(const struct roots_lanes *a, lane_mask done, struct solver_warm *warm)
{
  const unsigned bits = lanes_bits(done);
  if (!warm) return;
  warm->count = bits ? a->degree : 0;
  if (!bits) return;
  const unsigned lane = 31 - (unsigned)__builtin_clz(bits);
  for (int k = 0; k < a->degree; k++) warm->re[k] = 0.5 + 0.5 * a->zr[k][lane], warm->im[k] = 0.5 * a->zi[k][lane];
}

/* Collects the roots near [0,1], lane by lane. */
static void all_roots_near(const struct candidate *it, const struct roots_lanes *a, lane_mask done,
                           struct root_starts *out)
{
  int counts[LANES] = {0};
  lanes kept[TRIED_ROOTS];
  for (int k = 0; k < TRIED_ROOTS; k++) kept[k] = lanes_all(0.5);
  for (int i = 0; i < a->degree; i++) {
    const lane_mask near = (lanes_abs(a->zi[i]) <= ROOTS_MARGIN) & (lanes_abs(a->zr[i]) <= 1 + ROOTS_MARGIN);
    for (unsigned bits = lanes_bits(done & near & ~a->moving[i]); bits; bits &= bits - 1) {
      const unsigned lane = (unsigned)__builtin_ctz(bits);
      if (counts[lane] == TRIED_ROOTS) continue;
      const int k = counts[lane]++;
      kept[k][lane] = 0.5 + 0.5 * a->zr[i][lane], out->has[k][lane] = -1;
      out->count = out->count > counts[lane] ? out->count : counts[lane];
    }
  }
  for (int k = 0; k < out->count; k++) starts_set(it, k, kept[k], out);
}

/* Refines the roots by Newton's method, and proves them. Returns the lanes that are decided: one root is alone in the
 * leaf, or there are as many roots as r has sign variations. */
static lane_mask all_roots_prove(const struct packet *p, const struct candidate *it, const struct root_starts *starts,
                                 struct all_roots *all)
{
  const bool v_kept = it->form.v_kept;
  lane_mask alone = {0};
  lanes found = {0}, within = {0};
  all->count = starts->count;
  for (int k = 0; k < starts->count; k++) {
    struct newton_root *r = &all->root[k].at;
    lane_mask *proven = &all->proven[k];
    *proven = (lane_mask){0};
    const lane_mask open = starts->has[k] & ~alone;
    *r = (struct newton_root){.exists = {0}};
    if (!lanes_any(open)) continue;
    const lanes start[2] = {starts->u[k] - 0.5, starts->v[k] - 0.5};
    newton_solve(p, it->leaf, it->axis, start, open, &all->root[k]);
    *proven = r->exists;
    for (int j = 0; j < k; j++) *proven &= ~(all->proven[j] & roots_meet(&all->root[j].at, r));
    const lanes parameter = v_kept ? r->v : r->u, radius = v_kept ? r->radius_v : r->radius_u;
    found += lanes_select(*proven, lanes_all(1), lanes_all(0));
    within += lanes_select(*proven & (parameter > radius) & (1 - parameter > radius), lanes_all(1), lanes_all(0));
    /* all other roots found are this one again */
    const lane_mask only = r->alone;
    for (int j = 0; j < k; j++) all->proven[j] &= ~only;
    *proven |= only;
    alone |= only;
  }
  return resultant_counts(it) ? alone | ((found > 0) & (within == it->variations)) : alone;
}

/* The lanes of `open` where pieces prove these roots to be all of the leaf's. Those without any are not tried by the
 * default method: there the ray nearly touches the leaf, and pieces would do one time in ten. */
static lane_mask all_roots_cover(struct packet *p, const struct candidate *it, const struct all_roots *all,
                                 lane_mask open)
{
  struct known_root known[TRIED_ROOTS];
  lane_mask some = {0};
  int count = 0;
  for (int k = 0; k < all->count; k++) {
    const struct newton_root *r = &all->root[k].at;
    const lane_mask proven = all->proven[k] & open;
    some |= proven;
    if (lanes_any(proven)) known[count++] = (struct known_root){r, proven};
  }
  if (it->patch->lanes == SOLVER_LANES_SIGNS) open &= some;
  return cover_proves(p, it, count, known, COVER_HALVINGS, open, NULL);
}

/* Finds the roots of the polynomial that is set. Returns the lanes of `active` where the method succeeds: see
 * roots_lanes_run. */
static lane_mask all_roots_solve(struct packet *p, const struct candidate *it, lane_mask active, lanes enough,
                                 struct roots_lanes *out)
{
  const struct solver_options *options = &it->patch->method->roots;
  if (!lanes_any(active)) return active;
  out->method = it->patch->lanes;
  struct solver_warm *warm = p->model == p->tracer->model ? tracer_warm(p->tracer, it->patch->method, it->number)
                                                          : NULL;
  all_roots_start(out, warm, active);
  const double settled = options->tolerance > ROOTS_SETTLED ? options->tolerance : ROOTS_SETTLED;
  const lane_mask done = roots_lanes_run(out, active, enough, settled, options->max_iterations);
  packet_charge(p, __builtin_convertvector(out->sweeps * (1.0 / PRODUCTS_A_UNIT), lane_mask));
  all_roots_keep(out, done, warm);
  for (int k = 0; k < out->degree; k++) p->tracer->counts.roots_found += lanes_count(done & ~out->moving[k]);
  return done;
}

lanes method_quadratic_root(struct packet *p, const struct candidate *it, const lanes r[3], lane_mask *open)
{
  struct roots_lanes a;
  const lane_mask able = roots_lanes_set_quadratic(&a, r[0], 0.5 * r[1], 0.25 * r[2]); /* s = y/2 */
  *open = all_roots_solve(p, it, *open & able, lanes_all(1), &a);
  if (!lanes_any(*open)) return lanes_all(0);
  const lanes size[2] = {lanes_abs(a.zr[0]) + lanes_abs(a.zi[0]), lanes_abs(a.zr[1]) + lanes_abs(a.zi[1])};
  const lane_mask second = ~a.moving[1] & (size[1] < size[0]);
  return 0.5 * lanes_select(second, a.zr[1], a.zr[0]);
}

/* Finds roots by a method for lanes. */
static void all_roots_find(struct packet *p, const struct candidate *it, lane_mask active, struct root_starts *out)
{
  struct roots_lanes a;
  if (it->degree < 1) return;
  const lane_mask able = roots_lanes_set(&a, it->degree, it->c);
  all_roots_near(it, &a, all_roots_solve(p, it, active & able, it->variations, &a), out);
}

static void all_roots_offer(struct packet *p, const struct candidate *it, const struct all_roots *all, lane_mask where)
{
  for (int k = 0; k < all->count; k++)
    offer_root(p, it, &all->root[k], where & all->proven[k] & inside(&all->root[k].at));
}

lane_mask stage_all_roots(struct packet *p, struct candidate *it, lane_mask active)
{
  struct root_starts starts = {0};
  struct all_roots all;
  if (it->patch->lanes == SOLVER_LANES_SIGNS) {
    p->tracer->counts.roots_found += lanes_count(active);
    polygon_starts(it, active, &starts);
  } else if (it->patch->lanes != SOLVER_LANES_NONE) {
    all_roots_find(p, it, active, &starts);
  } else {
    method_starts(p, it, active, &starts);
  }
  const lane_mask decided = all_roots_prove(p, it, &starts, &all);
  all_roots_offer(p, it, &all, p->any ? active : decided);
  const lane_mask open = active & ~decided & p->live;
  if (!lanes_any(open)) return open;
  const lane_mask covered = all_roots_cover(p, it, &all, open);
  all_roots_offer(p, it, &all, covered);
  return open & ~covered;
}
