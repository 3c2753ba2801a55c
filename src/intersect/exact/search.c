/* Finds all that a ray meets in a region of a patch, by halving pieces of it until each has no root or one (piece.h).
 *
 * The piece that begins first along the ray is next; those behind the nearest hit so far are dropped. A root is then
 * placed: zoomed in on until it is known on which side of a border, and of the ray's start and end, it lies. That a root
 * lies exactly on one of them is decided by equality: in a corner of a piece both polynomials are zero; on a border they
 * have a common zero (sight.h); t of a flat patch is the same all over it. Where two roots are one, or a patch lies along
 * the ray, pieces become as small as LEAST_SIZE and are told as undecided.
 */
#include <math.h>

#include "base/real.h"
#include "geometry/edges.h"
#include "intersect/exact/judge.h"

/* Pieces are not halved below this size, as a part of the patch. Roots that the ray passes at a distance of 2^-100 of
 * the patch from a tangency are 2^-50 apart. */
#define LEAST_SIZE 0x1p-64

/* A piece that waits is a sibling of one that is being halved. */
enum { WAITING_MAX = 2 * 64 + 16 };

/* The most zooms into a root, each of up to 2^39; what is then not known is undecided. Two make a root sharp. */
enum { ZOOMS = 6 };
#define SHARP 0x1p-106

struct waiting {
  struct piece piece;
  size_t keep; /* the pool up to here holds what it is a part of */
  double near, far;
  int border; /* its roots are those on border[..] of the sight; -1: those off such borders */
};

/* ---- along the ray ---- */

static void set_reach(const struct judge *j, struct waiting *it)
{
  double least, most;
  piece_depths(&it->piece, &least, &most);
  const double one = least / j->sight.along, two = most / j->sight.along;
  it->near = real_min(one, two), it->far = real_max(one, two);
  it->near -= 2 * UNIT_ROUNDOFF * fabs(it->near), it->far += 2 * UNIT_ROUNDOFF * fabs(it->far);
}

/* How a root lies to an end of the ray. */
enum order { ORDER_BEFORE, ORDER_AT, ORDER_BEHIND, ORDER_UNKNOWN };

/* w at a root, as by piece_depth. */
struct depth {
  wide w;
  double error;
  bool exact;
};

/* The product of two doubles is exact in wide arithmetic. */
static enum order order_to(const struct depth *depth, double along, double t)
{
  if (!(fabs(t) < INFINITY)) return t > 0 ? ORDER_BEFORE : ORDER_BEHIND;
  const wide bound = (wide)t * along, off = depth->w - bound;
  if (depth->error > 0 && wide_abs(off) <= depth->error + 4 * WIDE_ROUNDOFF * wide_abs(bound)) return ORDER_UNKNOWN;
  if (off == 0 && depth->error == 0 && depth->exact) return ORDER_AT;
  const bool above = off > 0 || (off == 0 && !depth->exact);
  return above == (along > 0) ? ORDER_BEHIND : ORDER_BEFORE;
}

/* ---- a root's place ---- */

struct placing {
  struct judge *j;
  const struct waiting *from;
  struct piece piece; /* zoomed in */
  struct piece_root root;
  bool corner; /* it is exactly in the corner at `at` */
  unsigned on; /* borders on which it lies */
  struct depth depth;
};

static bool zoom(struct piece *piece, const struct piece_root *root, struct pool *pool, struct piece *out)
{
  double box[2][2];
  for (int k = 0; k < 2; k++) box[k][0] = root->at[k] - 16 * root->radius, box[k][1] = root->at[k] + 16 * root->radius;
  return piece_box(piece, box, pool, out);
}

/* The corner of the piece that is nearest to the root, if the root may be there and both polynomials are 0 there. */
static bool in_corner(struct placing *p)
{
  const int u = p->root.at[0] >= 0.5, v = p->root.at[1] >= 0.5;
  if (fabs(p->root.at[0] - u) > p->root.radius || fabs(p->root.at[1] - v) > p->root.radius) return false;
  if (!piece_corner_root(&p->piece, u, v, &p->j->pool)) return false;
  const int limbs = p->piece.limbs[NET_W];
  p->root.at[0] = u, p->root.at[1] = v, p->root.radius = 0, p->corner = true;
  p->depth.error = 0;
  p->depth.w = limbs_wide(p->piece.net[NET_W] + (12 * u + 3 * v) * limbs, limbs, p->piece.exponent[NET_W],
                          &p->depth.exact);
  return true;
}

/* Whether the root is the common zero of the two polynomials on that border: then it is exactly there. */
static bool on_border(const struct placing *p, int border)
{
  const struct waiting *from = p->from;
  wide at;
  if (from->border >= 0 || !sight_common(&p->j->sight.plane, border, &at)) return false;
  const int along = border < 2;
  const wide here = (at - from->piece.low[along]) / from->piece.size[along];
  return here >= -PIECE_MARGIN / 2 && here <= 1 + PIECE_MARGIN / 2; /* there is one root in all that */
}

/* Sets p->on. Returns whether the root is in the patch: ORDER_BEHIND for yes, ORDER_BEFORE for no. */
static enum order in_patch(struct placing *p)
{
  const int own = p->from->border >= 0 ? p->j->sight.border[p->from->border].border : -1;
  unsigned unknown = 0;
  p->on = own >= 0 ? 1u << own : 0;
  for (int border = 0; border < 4; border++) {
    if (border == own || !(p->piece.borders >> border & 1)) continue;
    const double at = p->root.at[border / 2], inside = border & 1 ? 1 - at : at;
    if (inside < -p->root.radius) return ORDER_BEFORE;
    if (inside <= p->root.radius) unknown |= 1u << border;
  }
  if (p->corner || (unknown && in_corner(p))) {
    p->on |= unknown;
    return ORDER_BEHIND;
  }
  for (int border = 0; border < 4; border++)
    if (unknown >> border & 1 && on_border(p, border)) p->on |= 1u << border, unknown &= ~(1u << border);
  return unknown ? ORDER_UNKNOWN : ORDER_BEHIND;
}

static enum order in_range(struct placing *p)
{
  const struct ray *ray = p->j->asked->ray;
  for (int tries = 0;; tries++) {
    const enum order start = order_to(&p->depth, p->j->sight.along, ray->t_min);
    const enum order end = order_to(&p->depth, p->j->sight.along, ray->t_max);
    if (start == ORDER_BEFORE || start == ORDER_AT || end == ORDER_BEHIND || end == ORDER_AT) return ORDER_BEFORE;
    if (start == ORDER_BEHIND && end == ORDER_BEFORE) return ORDER_BEHIND;
    if (tries > 0 || p->corner || !in_corner(p)) return ORDER_UNKNOWN;
  }
}

/* The sign of the quotient (sight.h) next to the root, which is on that border; 0 if that is not known. */
static int quotient_sign(const struct placing *p, const struct sight_border *border)
{
  struct pool *pool = &p->j->pool;
  const size_t before = pool->used;
  struct piece off = border->off, part;
  const int along = border->border < 2, end = border->border & 1;
  const double here = (double)p->piece.low[along] + p->piece.size[along] * p->root.at[along];
  double box[2][2];
  box[along][0] = here - 0x1p-29, box[along][1] = here + 0x1p-29;
  box[1 - along][0] = end ? 1 - 0x1p-30 : 0, box[1 - along][1] = end ? 1 : 0x1p-30;
  int positive = 0, negative = 0;
  if (border->side != 0 && piece_box(&off, box, pool, &part) && piece_exact(&part, pool))
    for (int c = 0; c < 16; c++)
      positive += part.value[NET_B][c / 4][c % 4] > 0, negative += part.value[NET_B][c / 4][c % 4] < 0;
  pool->used = before;
  return (positive == 16) - (negative == 16);
}

/* See exact_root.side. Let T be the border's tangent as the ray sees it, and X a point of the patch near to the root. A
 * regular root has cross(T,X) > 0 if the Jacobian's sign, and the ways in which the border and the way inward run, say
 * so. On a line through the origin T is the kept polynomial's derivative along the border over its control value, times
 * that point; and the quotient's sign is that of cross(X, point). */
static int border_side(const struct placing *p)
{
  static const int sense[4] = {-1, 1, 1, -1};
  const struct sight *sight = &p->j->sight;
  const int border = __builtin_ctz(p->on);
  if (p->on & (p->on - 1)) return 0;
  if (p->from->border < 0) return sense[border] * p->root.turn * sight->flip;
  const struct sight_border *own = &sight->border[p->from->border];
  return -sense[border] * p->root.turn * own->side * quotient_sign(p, own);
}

static struct exact_root found_root(const struct placing *p)
{
  struct exact_root out = {.patch = p->j->patch, .borders = p->on};
  double radius[2];
  wide at[2];
  for (int k = 0; k < 2; k++) {
    at[k] = p->piece.low[k] + (wide)p->piece.size[k] * p->root.at[k];
    radius[k] = p->piece.size[k] * p->root.radius + (double)(4 * WIDE_ROUNDOFF);
    const wide first = (at[k] - p->from->piece.low[k]) / p->from->piece.size[k];
    out.alone[k] = (double)p->from->piece.size[k] * (PIECE_MARGIN + (double)(first < 0.5 ? first : 1 - first));
    if (p->from->border >= 0 && p->j->sight.border[p->from->border].border / 2 == k) out.alone[k] = 0;
    for (int end = 0; end < 2; end++)
      if (p->on >> (2 * k + end) & 1) at[k] = end, radius[k] = 0;
  }
  out.u = at[0], out.v = at[1], out.radius_u = radius[0], out.radius_v = radius[1];
  out.sharp = p->corner || (radius[0] <= SHARP && radius[1] <= SHARP);
  out.t = p->depth.w / p->j->sight.along;
  out.t_error = p->depth.error / fabs(p->j->sight.along) + (double)(8 * WIDE_ROUNDOFF * wide_abs(out.t));
  return out;
}

/* Tells of a root that piece_root has found; or, of radius 0, of one in the piece's corner where the Jacobian may vanish:
 * within the patch the ray may touch the surface there, so it does not count among all hits. */
static void tell_root(struct judge *j, const struct waiting *it, const struct piece_root *root)
{
  const size_t before = j->pool.used;
  const bool touched = root->radius == 0;
  struct placing p = {.j = j, .from = it, .piece = it->piece, .root = *root, .corner = root->radius == 0};
  for (int zooms = 0;; zooms++) {
    if (!piece_exact(&p.piece, &j->pool)) {
      judge_undecided(j, it->near);
      break;
    }
    if (p.corner) p.corner = false, (void)in_corner(&p);
    else p.depth.w = piece_depth(&p.piece, p.root.at, p.root.radius, &p.depth.error, &p.depth.exact);
    const enum order inside = in_patch(&p), within = inside == ORDER_BEFORE ? ORDER_BEFORE : in_range(&p);
    if (inside == ORDER_BEFORE || within == ORDER_BEFORE) break;
    struct exact_root found = found_root(&p);
    if (inside == ORDER_BEHIND && within == ORDER_BEHIND && (!p.on || found.sharp)) {
      if (p.on) found.side = border_side(&p);
      if (touched && !p.on && j->all)
        judge_maybe(j, (double)found.u, (double)found.v, (double)found.t, found.t_error, (double)found.t);
      else judge_root(j, &found);
      break;
    }
    struct piece closer;
    judge_spend(j, WORK_SIGHT);
    enum piece_verdict verdict = PIECE_OPEN;
    if (zooms < ZOOMS && zoom(&p.piece, &p.root, &j->pool, &closer))
      verdict = piece_root(&closer, true, &j->pool, &p.root);
    if (verdict == PIECE_EMPTY) break; /* it is outside the patch, or in the neighbouring piece alone */
    if (verdict == PIECE_OPEN) {
      const double t = (double)found.t, from = t - found.t_error - 4 * UNIT_ROUNDOFF * fabs(t);
      if (within == ORDER_UNKNOWN) judge_undecided(j, from);
      else judge_maybe(j, real_clamp((double)found.u, 0, 1), real_clamp((double)found.v, 0, 1), t, found.t_error, from);
      break;
    }
    p.piece = closer;
  }
  j->pool.used = before;
}

/* ---- corners ---- */

/* Whether a combination of the net's polynomials is positive on the piece but for that corner, where it is 0. */
static bool positive_but(double net[4][4], int u, int v)
{
  for (int c = 0; c < 16; c++)
    if (net[c / 4][c % 4] < 0) return false;
  return net[3 - u][v] > 0 && net[u][3 - v] > 0 && net[3 - u][3 - v] > 0;
}

/* Whether a root in the corner (u,v), each 0 or 3, is the only one of the piece, though the Jacobian may vanish there:
 * where a handle has no length, or both tangents are one line. The combinations tried are that which grows alike to both
 * sides, and those that are zero at a neighbouring control point. */
static bool corner_alone(struct judge *j, const struct piece *piece, int u, int v)
{
  double net[4][4], p[2] = {0, 0};
  for (int side = 0; side < 2; side++) {
    const int row = side ? u : 3 - u, column = side ? 3 - v : v;
    const double x[2] = {piece->value[0][row][column], piece->value[1][row][column]}, length = hypot(x[0], x[1]);
    for (int k = 0; k < 2; k++) p[k] += length > 0 ? x[k] / length : 0;
  }
  if (piece_weigh(piece, p, &j->pool, net) && positive_but(net, u, v)) return true;
  for (int side = 0; side < 4; side++) {
    const int at = 4 * (side & 1 ? u : u ? 2 : 1) + (side & 1 ? (v ? 2 : 1) : v);
    limb minus[PIECE_LIMBS_MAX];
    const int minus_of = side < 2 ? 0 : 1, limbs[2] = {piece->limbs[0], piece->limbs[1]};
    const limb *x[2] = {piece->net[0] + at * limbs[0], piece->net[1] + at * limbs[1]};
    limbs_copy(minus, limbs[minus_of], x[minus_of], limbs[minus_of]), limbs_negate(minus, limbs[minus_of]);
    const struct weight first = {minus_of ? minus : x[1], limbs[1], 0}, second = {minus_of ? x[0] : minus, limbs[0], 0};
    const size_t before = j->pool.used;
    int length;
    const limb *combined = piece_combine(piece, first, second, &j->pool, &length);
    if (combined) (void)net_round(combined, length, net);
    j->pool.used = before;
    if (combined && positive_but(net, u, v)) return true;
  }
  return false;
}

/* Decides a piece with a root in one of its corners. */
static bool decide_corner(struct judge *j, struct waiting *it)
{
  for (int corner = 0; corner < 4; corner++) {
    const int u = corner / 2, v = corner % 2;
    if (!piece_corner_root(&it->piece, u, v, &j->pool) || !corner_alone(j, &it->piece, 3 * u, 3 * v)) continue;
    const struct piece_root root = {.at = {u, v}, .radius = 0};
    tell_root(j, it, &root);
    return true;
  }
  return false;
}

/* ---- the search ---- */

/* Tells of a point of a piece that is left undecided. */
static void tell_open(struct judge *j, const struct waiting *it)
{
  const double u = real_clamp((double)(it->piece.low[0] + (wide)it->piece.size[0] / 2), 0, 1);
  const double v = real_clamp((double)(it->piece.low[1] + (wide)it->piece.size[1] / 2), 0, 1);
  judge_maybe(j, u, v, it->near / 2 + it->far / 2, it->far / 2 - it->near / 2, it->near);
}

/* Where a and b are multiples of each other the ray meets curves. If t changes along them all over the piece, none of
 * them begins within it, and those that begin on the patch's borders are found there. */
static bool decide_curves(struct judge *j, struct waiting *it)
{
  j->doubt |= j->all;
  judge_spend(j, WORK_CURVES);
  if (it->near > j->asked->ray->t_min && piece_depth_turns(&it->piece, &j->pool)) return true;
  if (it->piece.size[0] > LEAST_SIZE || it->piece.size[1] > LEAST_SIZE) return false;
  tell_open(j, it);
  return true;
}

/* Returns whether the piece is done with. If not, all that it may hold is in the box. */
static bool decide(struct judge *j, struct waiting *it, double box[2][2])
{
  struct piece_root root;
  for (int k = 0; k < 2; k++) box[k][0] = 0, box[k][1] = 1;
  if (it->border < 0 && j->sight.dependent) return decide_curves(j, it);
  const enum piece_verdict verdict = piece_root(&it->piece, false, &j->pool, &root);
  memcpy(box, root.box, sizeof root.box);
  if (verdict == PIECE_ROOT) tell_root(j, it, &root);
  if (verdict != PIECE_OPEN || decide_corner(j, it)) return true;
  if (it->piece.size[0] > LEAST_SIZE || it->piece.size[1] > LEAST_SIZE) return false;
  tell_open(j, it);
  return true;
}

static bool beyond(const struct judge *j, const struct waiting *it)
{
  return it->near > j->limit || it->far < j->asked->ray->t_min;
}

/* What it takes to make a piece exact. */
static int work_of(const struct piece *piece)
{
  const int limbs = piece->limbs[NET_A] + piece->limbs[NET_B] + piece->limbs[NET_W];
  return 1 + limbs * limbs / WORK_LIMBS; /* rows of the Jacobian are products */
}

/* A box shorter than this both ways, as a part of the piece, is cut out rather than the piece halved. A choice of speed,
 * but for one thing: a piece that is cut in one way only may never end. */
#define BOX_LENGTH 0.5

/* If the box is small, and a multiple of 2^-SIMPLE_BITS of the patch is strictly inside it by one parameter at least, a
 * tangency may be exactly there: then parts of the patch that together hold the box, and end there. Returns how many;
 * 0 if there is no such point, -1 if there was no room. */
enum { SIMPLE_BITS = 16, PARTS_MAX = 4 };
static int divide_at_simple(struct judge *j, const struct waiting *it, const double box[2][2],
                            struct piece out[PARTS_MAX])
{
  const struct piece *piece = &it->piece;
  struct piece *whole = it->border < 0 ? &j->sight.off : &j->sight.border[it->border].on;
  double at[2], far = 0;
  bool side[2][2];
  for (int k = 0; k < 2; k++) {
    const wide low = piece->low[k] + box[k][0] * (wide)piece->size[k],
               high = piece->low[k] + box[k][1] * (wide)piece->size[k];
    at[k] = ldexp(rint(ldexp((double)low / 2 + (double)high / 2, SIMPLE_BITS)), -SIMPLE_BITS);
    side[k][0] = low < at[k], side[k][1] = at[k] < high;
    if (low > at[k] || at[k] > high) return 0;
    far = real_max(far, real_max((double)(at[k] - low), (double)(high - at[k])));
  }
  if ((side[0][0] && side[0][1]) + (side[1][0] && side[1][1]) == 0 || far >= ldexp(1, -SIMPLE_BITS - 4)) return 0;
  int exponent, count = 0;
  (void)frexp(far, &exponent);
  const int log2 = exponent < -BOX_BITS ? BOX_BITS : -exponent;
  for (int n = 0; n < 4; n++) {
    struct piece half;
    const limb u = (limb)ldexp(at[0], log2) - (n / 2 == 0), v = (limb)ldexp(at[1], log2) - (n % 2 == 0);
    if (!side[0][n / 2] || !side[1][n % 2]) continue;
    if (!piece_part(whole, 0, u, u + 1, log2, &j->pool, &half)) return -1;
    if (!piece_part(&half, 1, v, v + 1, log2, &j->pool, &out[count++])) return -1;
  }
  return count;
}

/* Divides the piece: the part that holds the box, or its halves, the one that begins first last. Returns how many of them
 * may hold a root, or -1 if there was no room. */
static int divide(struct judge *j, struct waiting *it, const double box[2][2], struct waiting out[PARTS_MAX])
{
  struct piece part[PARTS_MAX];
  int axis = piece_longer(&it->piece), count = 0, parts = divide_at_simple(j, it, box, part);
  if (parts == 0 && real_max(box[0][1] - box[0][0], box[1][1] - box[1][0]) < BOX_LENGTH) {
    parts = piece_box(&it->piece, box, &j->pool, &part[0]) ? 1 : -1;
  } else if (parts == 0) {
    if (it->piece.size[axis] <= LEAST_SIZE) axis = 1 - axis;
    const bool grows = piece_depth_grows(&it->piece, axis) == (j->sight.along > 0);
    for (; parts >= 0 && parts < 2; parts++) {
      const limb from = (parts == 0) == grows;
      if (!piece_part(&it->piece, axis, from, from + 1, 1, &j->pool, &part[parts])) parts = -2;
    }
  }
  for (int h = 0; h < parts; h++) {
    struct waiting next = {.piece = part[h], .keep = j->pool.used, .border = it->border};
    set_reach(j, &next);
    if (!beyond(j, &next) && !piece_misses(&next.piece)) out[count++] = next;
  }
  return parts < 0 ? -1 : count;
}

static void search_run(struct judge *j, struct waiting waiting[], int count)
{
  while (count > 0) {
    struct waiting it = waiting[--count], part[PARTS_MAX];
    const bool exact = piece_is_exact(&it.piece);
    double box[2][2];
    j->pool.used = it.keep;
    judge_spend(j, 1);
    if (beyond(j, &it) || decide(j, &it, box)) continue;
    if (!exact && piece_is_exact(&it.piece)) judge_spend(j, work_of(&it.piece));
    const int parts = j->work > 0 && count + PARTS_MAX <= WAITING_MAX ? divide(j, &it, box, part) : -1;
    if (parts < 0) judge_left(j, it.near, it.far);
    for (int h = 0; h < parts; h++) waiting[count++] = part[h];
  }
}

/* ---- regions ---- */

/* Columns of leaves as a part [from, to] / 2^log2 that holds them. */
struct cells {
  limb from, to;
  int log2;
};

static struct cells cells_of(unsigned column, unsigned span, unsigned split)
{
  int log2 = 0;
  while (1u << log2 < split) log2++;
  if (split & (split - 1)) log2 += 6;
  const limb of = (limb)1 << log2;
  return (struct cells){column * of / split, ((column + span) * of + split - 1) / split, log2};
}

static bool region_begin(struct judge *j, const struct exact_region *region, struct piece *whole, struct waiting *out)
{
  struct piece half;
  const uint16_t *split = j->asked->model->cuts[region->patch].split;
  for (int k = 0; k < 2; k++) {
    const struct cells at = cells_of(region->column[k], region->span[k], split[k]);
    if (!piece_part(k ? &half : whole, k, at.from, at.to, at.log2, &j->pool, k ? &out->piece : &half)) return false;
  }
  out->keep = j->pool.used;
  set_reach(j, out);
  return true;
}

/* A border all of whose points are on the ray: a pole, which is met there, or a line along the ray. */
static void tell_met(struct judge *j, int border)
{
  double(*P)[4][3] = j->asked->model->scene->patches[j->patch].P;
  const struct piece *plane = &j->sight.plane;
  const bool pole = edge_is_point(P, border);
  double near = INFINITY, at[2];
  for (int n = 0; n < 4; n++) {
    const int limbs = plane->limbs[NET_W];
    struct depth depth = {.error = 0};
    depth.w = limbs_wide(plane->net[NET_W] + edge_at(border, n) * limbs, limbs, plane->exponent[NET_W], &depth.exact);
    const wide t = depth.w / j->sight.along;
    near = real_min(near, (double)t);
    if (!pole) continue;
    const struct ray *ray = j->asked->ray;
    edge_place(border, 0.5, at);
    const struct exact_root root = {.patch = j->patch,
                                    .borders = 1u << border,
                                    .u = at[0],
                                    .v = at[1],
                                    .t = t,
                                    .t_error = (double)(8 * WIDE_ROUNDOFF * wide_abs(t)),
                                    .sharp = true};
    if (order_to(&depth, j->sight.along, ray->t_min) == ORDER_BEHIND &&
        order_to(&depth, j->sight.along, ray->t_max) == ORDER_BEFORE)
      judge_root(j, &root);
    return;
  }
  edge_place(border, 0, at);
  judge_maybe(j, at[0], at[1], near, 4 * UNIT_ROUNDOFF * fabs(near), near);
}

/* Whether t is the same all over the patch and not within the ray's range: a flat patch across an axis. */
static bool out_of_range(const struct judge *j)
{
  static const double middle[2] = {0.5, 0.5};
  const struct ray *ray = j->asked->ray;
  struct depth depth;
  depth.w = piece_depth(&j->sight.plane, middle, 1, &depth.error, &depth.exact);
  return depth.error == 0 && (order_to(&depth, j->sight.along, ray->t_min) != ORDER_BEHIND ||
                              order_to(&depth, j->sight.along, ray->t_max) != ORDER_BEFORE);
}

void search_region(struct judge *j, const struct exact_region *region)
{
  struct waiting waiting[WAITING_MAX];
  const size_t before = j->pool.used;
  int count = 0;
  bool room = j->seen;
  if (room && out_of_range(j)) return;
  for (int k = -1; k < j->sight.borders && room; k++) {
    waiting[count] = (struct waiting){.border = k};
    room = region_begin(j, region, k < 0 ? &j->sight.off : &j->sight.border[k].on, &waiting[count]);
    if (room && (k < 0 || waiting[count].piece.borders >> j->sight.border[k].border & 1)) count++;
  }
  if (room) {
    for (int k = 0; k < 4; k++)
      if (j->sight.met & waiting[0].piece.borders & 1u << k) tell_met(j, k);
    search_run(j, waiting, count);
  } else {
    judge_left(j, region->near, INFINITY);
  }
  j->pool.used = before;
}

/* ---- sharp roots ---- */

/* The part of the patch within `far` of the root in u and v, or within eight times the distance to which its place is
 * known. False if that is all of it, or there is no room. */
static bool part_about(struct piece *piece, const struct exact_root *root, const double far[2], struct pool *pool,
                       struct piece *out)
{
  const double at[2] = {(double)root->u, (double)root->v}, radius[2] = {root->radius_u, root->radius_v};
  double box[2][2];
  for (int k = 0; k < 2; k++) {
    const double here = real_max(far[k], 8 * radius[k]);
    if (!(here < 0.5)) return false;
    box[k][0] = at[k] - here, box[k][1] = at[k] + here;
  }
  return piece_box(piece, box, pool, out);
}

/* How far from a root the patch is cut, in turns, until the certificate holds: if it is not known how far the root is
 * alone, or where that does not do. */
static const double cuts[] = {0x1p-8, 0x1p-20, 0x1p-32, 0x1p-44, 0x1p-56};
enum { CUTS = sizeof cuts / sizeof *cuts };

bool search_sharpen(const struct model *model, const struct ray *ray, bool sharpest, struct exact_root *root)
{
  double(*P)[4][3] = model->scene->patches[root->patch].P;
  limb room[POOL_LIMBS];
  struct pool pool = {room, POOL_LIMBS, 0};
  struct sight sight;
  struct piece piece, closer;
  struct piece_root found;
  bool alone = false;
  if (root->sharp) return true;
  for (int exchanged = 0; exchanged < 2 && !alone; exchanged++) { /* next to a pole, the pair is exchanged */
    pool.used = 0;
    if (!(exchanged ? sight_make(P, ray, &pool, &sight) : sight_plane(P, ray, &pool, &sight))) return false;
    const size_t before = pool.used;
    for (int n = root->alone[0] > 0 && root->alone[1] > 0 ? -1 : 0; n < CUTS && !alone; n++) {
      const double far[2] = {n < 0 ? root->alone[0] : cuts[n], n < 0 ? root->alone[1] : cuts[n]};
      pool.used = before;
      alone = part_about(exchanged ? &sight.off : &sight.plane, root, far, &pool, &piece) &&
              piece_exact(&piece, &pool) && piece_root(&piece, true, &pool, &found) == PIECE_ROOT;
    }
  }
  if (!alone) return false;
  for (int k = 0; k < 2; k++)
    root->alone[k] = piece.size[k] * (PIECE_MARGIN + (found.at[k] < 0.5 ? found.at[k] : 1 - found.at[k]));
  double error;
  bool exact;
  for (int n = 0; piece_exact(&piece, &pool); n++) {
    const wide w = piece_depth(&piece, found.at, found.radius, &error, &exact);
    root->sharp = found.radius * real_max(piece.size[0], piece.size[1]) <= SHARP;
    root->t = w / sight.along;
    root->t_error = error / fabs(sight.along) + (double)(8 * WIDE_ROUNDOFF * wide_abs(root->t));
    if (n == ZOOMS || root->sharp || (!sharpest && root->t_error <= LAST_PLACES * fabs((double)root->t))) break;
    if (!zoom(&piece, &found, &pool, &closer) || piece_root(&closer, true, &pool, &found) != PIECE_ROOT) break;
    piece = closer;
  }
  wide *at[2] = {&root->u, &root->v};
  double *radius[2] = {&root->radius_u, &root->radius_v};
  for (int k = 0; k < 2; k++) {
    if (root->borders >> (2 * k) & 3) continue;
    *at[k] = piece.low[k] + (wide)piece.size[k] * found.at[k];
    *radius[k] = piece.size[k] * found.radius + (double)(4 * WIDE_ROUNDOFF);
  }
  return true;
}
