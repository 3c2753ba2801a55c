/* Where a root lies: in the patch or on its borders, within the ray's range or not, and how far along the ray.
 *
 * A root is zoomed in on until it is sharp, and it is known on which side of a border, and of the ray's start and end, it
 * lies. Whether it lies exactly on one of them is decided by equality: at some multiples of 2^-16 both polynomials are
 * zero; on some borders one is zero all along (judge.h); t of a flat patch is the same all over it.
 */
#include "intersect/exact/judge.h"

#include <math.h>

#include "base/real.h"

/* The most zooms into a root, each of up to 2^39; what is then not known is undecided. Two make a root sharp. */
enum { ZOOMS = 4 };

/* ---- along the ray ---- */

/* The product of two doubles is exact in wide arithmetic, and a depth's error has room for the rounding of `off`. */
static enum place_within on_side(const struct depth *depth, double along, double t, bool after)
{
  if (!(fabs(t) < INFINITY)) return (t > 0) == after ? PLACE_OUT : PLACE_IN;
  const wide bound = (wide)t * along, off = depth->w - bound;
  if (depth->error > 0 && wide_abs(off) <= depth->error) return PLACE_UNKNOWN;
  if (off == 0 && depth->exact) return PLACE_OUT;
  const bool above = off > 0 || (off == 0 && !depth->exact);
  return (above == (along > 0)) == after ? PLACE_IN : PLACE_OUT;
}

enum place_within place_in_range(const struct judge *j, const struct depth *depth)
{
  const struct ray *ray = j->asked->ray;
  const enum place_within start = on_side(depth, j->sight.along, ray->t_min, true);
  const enum place_within end = on_side(depth, j->sight.along, ray->t_max, false);
  return start == PLACE_OUT || end == PLACE_OUT ? PLACE_OUT
         : start == PLACE_IN && end == PLACE_IN ? PLACE_IN
                                                : PLACE_UNKNOWN;
}

/* ---- a root's place ---- */

struct placing {
  struct judge *j;
  const struct waiting *from;
  struct piece piece; /* zoomed in */
  struct piece_root root;
  bool corner; /* it was found exactly in the corner at `at`: it may be singular */
  unsigned on; /* borders on which it lies */
  struct depth depth;
};

/* Whether both polynomials are 0 at the multiples of 2^-SIMPLE_BITS of the patch that are nearest to the root, and it may
 * be there: then it is in a corner of a piece that ends there, which is now the root's. */
static bool in_corner(struct placing *p)
{
  struct pool *pool = &p->j->pool;
  struct piece part[3] = {p->from->border < 0 ? p->j->sight.off : p->j->sight.on[p->from->border]};
  int end[2];
  for (int k = 0; k < 2; k++) {
    const wide here = p->piece.low[k] + p->piece.size[k] * p->root.at[k];
    const double simple = real_clamp(rint(ldexp((double)here, SIMPLE_BITS)), 0, ldexp(1, SIMPLE_BITS));
    const wide off = here - (wide)ldexp(simple, -SIMPLE_BITS);
    end[k] = simple > 0;
    if (wide_abs(off) > p->piece.size[k] * p->root.radius ||
        !piece_part(&part[k], k, (limb)simple - (limb)end[k], (limb)simple + !end[k], SIMPLE_BITS, pool, &part[k + 1]))
      return false;
  }
  if (!piece_corner_root(&part[2], end[0], end[1], pool)) return false;
  p->piece = part[2], p->root.at[0] = end[0], p->root.at[1] = end[1], p->root.radius = 0;
  p->depth.w = piece_coefficient(&p->piece, NET_W, 12 * end[0] + 3 * end[1], &p->depth.exact), p->depth.error = 0;
  return true;
}

/* Sets p->on. Returns whether the root is known to be in the patch; it may be outside by no more than its radius. */
static bool in_patch(struct placing *p)
{
  const int own = p->from->border >= 0 ? p->j->sight.border[p->from->border] : -1;
  unsigned unknown = 0;
  p->on = own >= 0 ? 1u << own : 0;
  for (int border = 0; border < 4; border++) {
    if (border == own || !(p->piece.borders >> border & 1)) continue;
    const double at = p->root.at[border / 2], inside = border & 1 ? 1 - at : at;
    if (inside <= p->root.radius) unknown |= 1u << border;
  }
  if (p->corner || (unknown && in_corner(p))) {
    p->on |= p->piece.borders & (1u << (int)p->root.at[0] | 4u << (int)p->root.at[1]);
    return true;
  }
  return !unknown;
}

/* Relative to the largest coefficients of a and b. A derivative is at most 6 times that, and a sum of 24 products with some
 * 8 roundings in each; second derivatives are at most 36, so within these radii the Jacobian changes by 720 times them. */
#define JACOBIAN_ERROR(radii) ((double)(4 * 36 * (24 + 8) * WIDE_ROUNDOFF) + 720 * (radii))

/* The sign of the Jacobian of (a,b) by (u,v) at the root; 0 if it may vanish. */
static int jacobian_sign(const struct placing *p, const struct exact_root *root)
{
  wide wu[4], wv[4], eu[3], ev[3], x[4][4], du[2] = {0, 0}, dv[2] = {0, 0}, most[2] = {0, 0};
  bool exact;
  wide_cubic(root->u, wu, eu);
  wide_cubic(root->v, wv, ev);
  for (int k = 0; k < 2; k++) {
    for (int c = 0; c < 16; c++) {
      x[c / 4][c % 4] = piece_coefficient(&p->j->sight.plane, k, c, &exact);
      most[k] = wide_max(most[k], wide_abs(x[c / 4][c % 4]));
    }
    for (int n = 0; n < 3; n++)
      for (int m = 0; m < 4; m++)
        du[k] += eu[n] * wv[m] * (x[n + 1][m] - x[n][m]), dv[k] += wu[m] * ev[n] * (x[m][n + 1] - x[m][n]);
  }
  const wide jacobian = du[0] * dv[1] - dv[0] * du[1];
  if (wide_abs(jacobian) <= JACOBIAN_ERROR(root->radius_u + root->radius_v) * most[0] * most[1]) return 0;
  return jacobian > 0 ? 1 : -1;
}

static struct exact_root found_root(const struct placing *p)
{
  struct exact_root out = {.patch = p->j->patch, .borders = p->on};
  wide at[2];
  double radius[2];
  for (int k = 0; k < 2; k++) {
    at[k] = p->piece.low[k] + p->piece.size[k] * p->root.at[k];
    radius[k] = (double)p->piece.size[k] * p->root.radius + (double)(4 * WIDE_ROUNDOFF);
    for (int end = 0; end < 2; end++)
      if (p->on >> (2 * k + end) & 1) at[k] = end, radius[k] = 0;
  }
  out.u = at[0], out.v = at[1], out.radius_u = radius[0], out.radius_v = radius[1];
  out.t = p->depth.w / p->j->sight.along;
  out.t_error = p->depth.error / fabs(p->j->sight.along) + (double)(8 * WIDE_ROUNDOFF * wide_abs(out.t));
  return out;
}

/* Reports a root of which nothing better will be known. */
static void report(const struct placing *p, struct exact_root found, bool inside, enum place_within within)
{
  static const int sense[4] = {-1, 1, 1, -1}; /* of the way in which a border runs, and the way inward */
  struct judge *j = p->j;
  const double t = (double)found.t, from = judge_least_t(&found);
  const bool touches = p->corner && !p->on && j->asks == JUDGE_ALL && jacobian_sign(p, &found) == 0;
  if (within == PLACE_UNKNOWN) {
    judge_undecided(j, from);
  } else if (!inside || touches) {
    judge_maybe(j, (double)found.u, (double)found.v, t, found.t_error, from);
  } else {
    if (p->on) found.side = sense[__builtin_ctz(p->on)] * jacobian_sign(p, &found);
    judge_root(j, &found);
  }
}

void place_root(struct judge *j, const struct waiting *it, const struct piece_root *root)
{
  struct placing p = {.j = j, .from = it, .piece = it->piece, .root = *root, .corner = root->radius == 0};
  for (int zooms = 0;; zooms++) {
    struct piece closer;
    struct piece_root next;
    double box[2][2];
    if (!piece_exact(&p.piece, &j->pool)) {
      judge_left(j, it->near, it->far);
      break;
    }
    if (p.corner)
      p.depth.w = piece_coefficient(&p.piece, NET_W, 12 * (int)root->at[0] + 3 * (int)root->at[1], &p.depth.exact);
    else p.depth.w = piece_depth(&p.piece, p.root.at, p.root.radius, &p.depth.error, &p.depth.exact);
    const bool inside = in_patch(&p);
    enum place_within within = place_in_range(j, &p.depth);
    if (within == PLACE_UNKNOWN && in_corner(&p)) within = place_in_range(j, &p.depth);
    if (within == PLACE_OUT) break;
    const struct exact_root found = found_root(&p);
    enum piece_verdict verdict = PIECE_OPEN;
    for (int k = 0; k < 2; k++)
      box[k][0] = p.root.at[k] - 16 * p.root.radius, box[k][1] = p.root.at[k] + 16 * p.root.radius;
    if (zooms < ZOOMS && !(inside && within == PLACE_IN && judge_sharp(&found)) &&
        piece_box(&p.piece, box, &j->pool, &closer))
      verdict = piece_root(&closer, true, &j->pool, &next);
    if (verdict == PIECE_EMPTY) break; /* it is outside the patch, or in the neighbouring piece alone */
    if (verdict == PIECE_OPEN) {
      report(&p, found, inside, within);
      break;
    }
    p.piece = closer, p.root = next;
  }
}
