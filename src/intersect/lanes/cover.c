/* Boxes that cover a leaf. See cover.h.
 *
 * Compiled once per instruction set.
 */
#include <math.h>
#include <string.h>

#include "intersect/certificate.h"
#include "intersect/lanes/cover.h"
#include "intersect/lanes/nearest.h"

/* A choice of speed, as COVER_HALVINGS. */
enum { COVER_SPLITS = 160 };

struct cover_box {
  lanes a[16], b[16];
  double u, v, size_u, size_v; /* in leaf parameters */
  int halvings;
  lane_mask open;
};

/* The lanes of `open` on which the root is not alone on the box and itself together. As in newton.c, but where the
 * box is small q does not outweigh the rest: M J at the root is off from 1 by 2 bend, which counts twice against a
 * bound on q, and the root by 2 (|step| + e) from where q takes it, which may make q larger by 2 bend. */
LANES_INLINE lane_mask cover_unknown(const struct leaf *leaf, const struct cover_box *box,
                                     const struct known_root *known, lane_mask open)
{
  const struct newton_root *root = known->at;
  const lanes reach_u = lanes_max(root->u - box->u, (box->u + box->size_u) - root->u);
  const lanes reach_v = lanes_max(root->v - box->v, (box->v + box->size_v) - root->v);
  const lanes q = root->size *
                  ((leaf->second[0] + leaf->second[1]) * reach_u + (leaf->second[1] + leaf->second[2]) * reach_v);
  return open & ~(known->proven & certificate_alone(q + 6 * root->bend, root->off));
}

/* The cubic at c[0], c[stride] ... becomes its lower half. */
LANES_INLINE void cover_halve(lanes *c, int stride, lanes *high)
{
  const lanes c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride];
  const lanes q0 = 0.5 * (c0 + c1), q1 = 0.5 * (c1 + c2), q2 = 0.5 * (c2 + c3);
  const lanes r0 = 0.5 * (q0 + q1), r1 = 0.5 * (q1 + q2), s = 0.5 * (r0 + r1);
  c[stride] = q0, c[2 * stride] = r0, c[3 * stride] = s;
  high[0] = s, high[stride] = r1, high[2 * stride] = q2, high[3 * stride] = c3;
}

/* Halves the box across the parameter along which it is longer: not as seen along the ray, so that a lane's boxes do
 * not depend on its neighbours. It becomes its own lower half. */
static void cover_split(const struct leaf *leaf, struct cover_box *box, struct cover_box *high)
{
  const bool across_u = leaf->first[0] * box->size_u >= leaf->first[1] * box->size_v;
  if (across_u) box->size_u /= 2;
  else box->size_v /= 2;
  box->halvings++;
  high->u = across_u ? box->u + box->size_u : box->u, high->v = across_u ? box->v : box->v + box->size_v;
  high->size_u = box->size_u, high->size_v = box->size_v, high->halvings = box->halvings, high->open = box->open;
  for (int n = 0; n < 4; n++) {
    const int at = across_u ? n : 4 * n, stride = across_u ? 4 : 1;
    cover_halve(box->a + at, stride, high->a + at);
    cover_halve(box->b + at, stride, high->b + at);
  }
}

/* A polynomial on the box, and what each of its coefficients is off by. */
struct cover_net {
  lanes c[16], error;
};

/* p a + q b; `size` bounds the coefficients of a and b, `error` what they are off by. Three roundings of its own. */
LANES_INLINE void cover_combine(const struct cover_box *box, lanes p, lanes q, lanes size, lanes error,
                                struct cover_net *out)
{
  for (int n = 0; n < 16; n++) out->c[n] = p * box->a[n] + q * box->b[n];
  out->error = (error + 8 * UNIT_ROUNDOFF * size) * (lanes_abs(p) + lanes_abs(q));
}

/* The lanes of `open` where it does not keep one sign. */
LANES_INLINE lane_mask cover_changes(const lanes c[16], lanes error, lane_mask open)
{
  lanes low = c[0], high = low;
  for (int n = 1; n < 16; n++) low = lanes_min(c[n], low), high = lanes_max(c[n], high);
  return open & (low <= error) & (high >= -error);
}

/* How it grows along its own parameter at least, and changes along the other at most, as differences of neighbours. */
LANES_INLINE void cover_slopes(const struct cover_net *net, int own, lanes *least, lanes *most)
{
  const int other = 5 - own;
  lanes grows = lanes_all(INFINITY), moves = lanes_all(0);
  for (int n = 0; n < 12; n++) {
    const int at = n / 3, k = n % 3;
    grows = lanes_min(net->c[other * at + own * (k + 1)] - net->c[other * at + own * k], grows);
    moves = lanes_max(lanes_abs(net->c[own * at + other * (k + 1)] - net->c[own * at + other * k]), moves);
  }
  *least = grows - 2 * net->error, *most = moves + 2 * net->error;
}

/* The lanes where two polynomials, that aim along u and v, take no pair of values twice: from one point to another they
 * change by their derivatives, averaged on the way, times it; those are within their differences, three times over, and
 * so no singular matrix, its diagonal's product being larger than that of the other elements. */
LANES_INLINE lane_mask cover_one_to_one(const struct cover_net *along_u, const struct cover_net *along_v)
{
  lanes least_u, least_v, most_u, most_v;
  cover_slopes(along_u, 4, &least_u, &most_u);
  cover_slopes(along_v, 1, &least_v, &most_v);
  return (least_u > 0) & (least_v > 0) & (least_u * least_v > (1 + 8 * UNIT_ROUNDOFF) * (most_u * most_v));
}

/* The lanes where a proven root is in the box. */
LANES_INLINE lane_mask cover_holds(const struct cover_box *box, const struct known_root *known)
{
  const struct newton_root *root = known->at;
  return known->proven & (root->u - root->radius_u >= box->u) & (root->u + root->radius_u <= box->u + box->size_u) &
         (root->v - root->radius_v >= box->v) & (root->v + root->radius_v <= box->v + box->size_v);
}

/* The lanes of `open` where neither a nor b nor one of two combinations, which aim along the box's parameters, keeps one sign
 * on the box, nor both together have no value twice while one of the roots is there. */
LANES_INLINE lane_mask cover_full(const struct cover_box *box, int count, const struct known_root roots[], lanes size,
                                  lanes error, lane_mask open)
{
  const lanes *a = box->a, *b = box->b;
  lanes au = (a[13] + a[14]) - (a[1] + a[2]), av = (a[7] + a[11]) - (a[4] + a[8]);
  lanes bu = (b[13] + b[14]) - (b[1] + b[2]), bv = (b[7] + b[11]) - (b[4] + b[8]);
  const lane_mask turned = au * bv < av * bu;
  struct cover_net along_u, along_v;
  cover_combine(box, lanes_select(turned, -bv, bv), lanes_select(turned, av, -av), size, error, &along_u);
  open = cover_changes(along_u.c, along_u.error, open);
  if (!lanes_any(open)) return open;
  cover_combine(box, lanes_select(turned, bu, -bu), lanes_select(turned, -au, au), size, error, &along_v);
  open = cover_changes(along_v.c, along_v.error, open);
  lane_mask holds = {0};
  for (int k = 0; k < count; k++) holds |= cover_holds(box, &roots[k]);
  if (lanes_any(open & holds)) open &= ~(holds & cover_one_to_one(&along_u, &along_v));
  if (lanes_any(open)) open = cover_changes(a, error, open);
  if (lanes_any(open)) open = cover_changes(b, error, open);
  return open;
}

/* The lanes of `open` between whose ends the box is. */
static lane_mask cover_seen(const struct packet *p, const struct candidate *it, const struct cover_box *box,
                            lane_mask open)
{
  const double half[2] = {0.5 * box->size_u, 0.5 * box->size_v}, middle[2] = {box->u + half[0], box->v + half[1]};
  return open & ~box_out_of_range(p, it, middle, half);
}

lane_mask cover_proves(const struct packet *p, const struct candidate *it, int count, const struct known_root roots[],
                       int halvings, lane_mask open, lanes left[2])
{
  struct cover_box stack[COVER_HALVINGS + 2];
  struct cover_box *whole = &stack[0];
  memcpy(whole->a, it->a, sizeof whole->a), memcpy(whole->b, it->b, sizeof whole->b);
  whole->u = whole->v = 0, whole->size_u = whole->size_v = 1, whole->halvings = 0, whole->open = open;
  lanes size = {0};
  for (int n = 0; n < 16; n++) size = lanes_max(lanes_max(lanes_abs(it->a[n]), lanes_abs(it->b[n])), size);
  int top = 1;
  const lanes given = lanes_min(p->postponed->splits, lanes_all(COVER_SPLITS));
  lanes splits = given;
  while (top > 0) {
    struct cover_box *box = &stack[--top];
    box->open &= open;
    for (int k = 0; k < count; k++) box->open = cover_unknown(it->leaf, box, &roots[k], box->open);
    /* each halving adds three roundings, of values of the leaf's size */
    const lanes error = it->line->error + box->halvings * 4 * UNIT_ROUNDOFF * size;
    if (lanes_any(box->open)) box->open = cover_full(box, count, roots, size, error, box->open);
    if (lanes_any(box->open)) box->open = cover_seen(p, it, box, box->open);
    if (!lanes_any(box->open)) continue;
    splits -= lanes_select(box->open, lanes_all(1), lanes_all(0));
    const lane_mask lost = box->halvings == halvings ? box->open : box->open & (splits < 0);
    if (left) left[0] = lanes_select(lost, lanes_all(box->u + 0.5 * box->size_u - 0.5), left[0]);
    if (left) left[1] = lanes_select(lost, lanes_all(box->v + 0.5 * box->size_v - 0.5), left[1]);
    open &= ~lost, box->open &= open;
    if (!lanes_any(box->open)) continue;
    cover_split(it->leaf, box, box + 1);
    top += 2;
  }
  p->postponed->splits -= given - splits;
  return open;
}

lane_mask cover_two(struct packet *p, const struct candidate *it, const struct leaf_root *first,
                    const struct leaf_root *second, lane_mask open)
{
  const struct newton_root *one = &first->at, *two = &second->at;
  const lane_mask apart = ~one->exists | (lanes_abs(one->u - two->u) > one->radius_u + two->radius_u + UNIT_ROUNDOFF) |
                          (lanes_abs(one->v - two->v) > one->radius_v + two->radius_v + UNIT_ROUNDOFF);
  const struct known_root known[2] = {{one, open & one->exists}, {two, open & two->exists & apart}};
  open &= known[0].proven | known[1].proven;
  if (!lanes_any(open)) return open;
  const int count = lanes_any(known[1].proven) ? 2 : 1;
  const lane_mask covered = cover_proves(p, it, count, known, COVER_HALVINGS, open, NULL);
  offer_root(p, it, first, covered & known[0].proven & inside(one));
  if (count > 1) offer_root(p, it, second, (p->any ? open : covered) & known[1].proven & inside(two));
  return covered;
}
