/* All roots of the rays of a packet, where nearest.c would keep only the nearest of each, and their answers.
 *
 * Compiled once per instruction set and without contraction. A root gets its answer where it is found, just as the
 * nearest one does, together with those that other lanes find there. The last resort puts them in order, and adds what
 * the lanes left open (exact_all).
 */
#include "intersect/lanes/packet.h"

#include <math.h>

void gather_start(struct packet *p, struct gather *gather)
{
  if (!p->oriented) packet_orient(p);
  p->gather = gather;
  gather->hits.count = 0;
  for (int l = 0; l < LANES; l++) {
    struct gathered *lane = &gather->lane[l];
    lane->found.count = lane->regions.count = 0, lane->found.failed = false;
  }
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
  struct hit hits[LANES];
  const lane_mask doubt = p->best.doubt; /* belongs to the list, whichever root came first */
  p->best.doubt = (lane_mask){0};
  (void)finish_best(p, 0, hits);
  p->best.doubt = doubt;
  for (unsigned bits = lanes_bits(taken); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    const struct exact_found found = {.root = packet_root(p, lane),
                                      .kind = p->best.certain[lane] ? EXACT_INSIDE : EXACT_OPEN,
                                      .taken = (int64_t)gather->hits.count,
                                      .leaf = p->best.leaf[lane]};
    struct hit *hit = growing_add(&gather->hits, 1, sizeof *hit);
    if (hit) *hit = hits[lane];
    p->tracer->failed |= !hit || !exact_list_add(&gather->lane[lane].found, &found);
  }
  forget_best(p, taken);
}

void gather_postpone(struct packet *p, uint32_t patch, unsigned lane)
{
  struct exact_region *region = growing_add(&p->gather->lane[lane].regions, 1, sizeof *region);
  p->tracer->failed |= !region;
  if (region) *region = (struct exact_region){.patch = patch};
}

static struct hit answer(const struct packet *p, unsigned lane, const struct exact_found *found)
{
  struct hit hit;
  if (found->taken >= 0 && !found->tied) return ((struct hit *)p->gather->hits.at)[found->taken];
  exact_hit(p->model, &p->rays[lane], &found->root, found->kind != EXACT_OPEN, &hit);
  return hit;
}

unsigned gather_finish(struct packet *p, const int *exponents, struct list_place out[])
{
  struct tracer *tracer = p->tracer;
  unsigned grazing = 0;
  for (unsigned lane = 0; lane < p->count; lane++) {
    struct exact_list *list = &p->gather->lane[lane].found;
    const struct exact_case wanted = packet_case(p, lane);
    bool certain = exact_all(&wanted, list) && !p->best.doubt[lane];
    const size_t first = tracer->hits.count;
    struct hit *hits = growing_add(&tracer->hits, list->count, sizeof *hits);
    tracer->failed |= list->failed || !hits;
    if (tracer->failed) return 0;
    for (size_t k = 0; k < list->count; k++) {
      hits[k] = answer(p, lane, &list->at[k]);
      if (exponents) hits[k].t = ldexp(hits[k].t, -exponents[lane]);
      /* Later hits are no nearer, though their last bits may say so. */
      if (k > 0 && hits[k].t < hits[k - 1].t) hits[k].t = hits[k - 1].t;
      certain &= hits[k].certainty == CERTAINTY_CERTAIN;
    }
    out[lane] = (struct list_place){certain ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING, first, list->count};
    grazing |= (unsigned)!certain << lane;
  }
  return grazing;
}
