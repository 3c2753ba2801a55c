/* Finds all that a ray hits in a patch, by dividing pieces of it until each has no root or one (piece.h).
 *
 * Pieces behind the nearest hit so far are dropped. Where two roots are one, or a patch lies along the ray, pieces
 * become as small as LEAST_SIZE and are reported as undecided.
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

/* ---- along the ray ---- */

static void set_reach(const struct judge *j, struct waiting *it)
{
  double least, most;
  piece_depths(&it->piece, &least, &most);
  const double one = least / j->sight.along, two = most / j->sight.along;
  it->near = real_min(one, two), it->far = real_max(one, two);
}

/* ---- corners ---- */

/* Whether a combination of the polynomials keeps its sign on the piece but for that corner, where it is 0. */
static bool zero_only(const limb *net, int limbs, int u, int v)
{
  bool positive = false, negative = false;
  for (int c = 0; c < 16; c++) {
    const limb *x = net + c * limbs;
    negative |= limbs_fill(x, limbs) != 0, positive |= limbs_fill(x, limbs) == 0 && !limbs_zero(x, limbs);
    if ((c == 4 * (3 - u) + v || c == 4 * u + 3 - v || c == 4 * (3 - u) + 3 - v) && limbs_zero(x, limbs)) return false;
  }
  return !(positive && negative);
}

/* Whether a root in the corner (u,v), each 0 or 3, is the only one of the piece, though the Jacobian may vanish there:
 * where a handle has no length, or both tangents are one line. The combinations tried are those of a and b that are zero
 * at a neighbouring control point. */
static bool corner_alone(struct judge *j, const struct piece *piece, int u, int v)
{
  const int *limbs = piece->limbs, beside[2] = {4 * u + (v ? 2 : 1), 4 * (u ? 2 : 1) + v};
  for (int k = 0; k < 2; k++) {
    const struct weight p = {piece->net[1] + beside[k] * limbs[1], limbs[1]};
    const struct weight q = {piece->net[0] + beside[k] * limbs[0], limbs[0]};
    const size_t before = j->pool.used;
    int length;
    const limb *net = piece_combine(piece, p, q, &j->pool, &length);
    j->pool.used = before;
    if (net && zero_only(net, length, u, v)) return true;
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
    place_root(j, it, &root);
    return true;
  }
  return false;
}

/* ---- the search ---- */

/* Whether the piece is too small to be divided; a point of it is then reported as undecided. */
static bool gives_up(struct judge *j, const struct waiting *it)
{
  const struct piece *piece = &it->piece;
  if (piece->size[0] > LEAST_SIZE || piece->size[1] > LEAST_SIZE) return false;
  const double u = (double)(piece->low[0] + piece->size[0] / 2), v = (double)(piece->low[1] + piece->size[1] / 2);
  judge_maybe(j, u, v, it->near / 2 + it->far / 2, it->far / 2 - it->near / 2, it->near);
  return true;
}

/* Where a and b are multiples of each other the ray meets curves. If t changes along them all over the piece, none of
 * them begins within it; and those that begin on the patch's borders are found there. Only where all of the patch is on
 * the ray are these not listed. */
static bool decide_curves(struct judge *j, struct waiting *it)
{
  const bool begins = j->sight.borders < 4 || it->near <= j->asked->ray->t_min;
  return (!begins && piece_depth_turns(&it->piece, &j->pool)) || gives_up(j, it);
}

/* Returns whether the piece is done with. If not, all that it may hold is in the box. */
static bool decide(struct judge *j, struct waiting *it, double box[2][2])
{
  struct piece_root root;
  for (int k = 0; k < 2; k++) box[k][0] = 0, box[k][1] = 1;
  if (it->border < 0 && j->sight.dependent) return decide_curves(j, it);
  const enum piece_verdict verdict = piece_root(&it->piece, false, &j->pool, &root);
  memcpy(box, root.box, sizeof root.box);
  if (verdict == PIECE_ROOT) place_root(j, it, &root);
  return verdict != PIECE_OPEN || decide_corner(j, it) || gives_up(j, it);
}

static bool beyond(const struct judge *j, const struct waiting *it)
{
  return it->near > j->limit || it->far < j->asked->ray->t_min;
}

/* A box shorter than this both ways, as a part of the piece, is cut out rather than the piece halved. A choice of speed,
 * but for one thing: a piece that is cut in one way only may never end. */
#define BOX_LENGTH 0.5

/* If the box is small, and a multiple of 2^-SIMPLE_BITS of the patch is strictly inside it by one parameter at least, a
 * tangency may be exactly there: then parts of the patch that together hold the box, and end there. Returns how many;
 * 0 if there is no such point. Parts of the whole that are no shorter than 2^-BOX_BITS take no room. */
enum { PARTS_MAX = 4 };
static int divide_at_simple(struct judge *j, const struct waiting *it, const double box[2][2],
                            struct piece out[PARTS_MAX])
{
  const struct piece *piece = &it->piece;
  struct piece *whole = it->border < 0 ? &j->sight.off : &j->sight.on[it->border];
  double at[2], far = 0;
  bool side[2][2];
  for (int k = 0; k < 2; k++) {
    const wide low = piece->low[k] + box[k][0] * piece->size[k], high = piece->low[k] + box[k][1] * piece->size[k];
    at[k] = ldexp(rint(ldexp((double)low / 2 + (double)high / 2, SIMPLE_BITS)), -SIMPLE_BITS);
    side[k][0] = low < at[k], side[k][1] = at[k] < high;
    if (low > at[k] || at[k] > high) return 0;
    far = real_max(far, real_max((double)(at[k] - low), (double)(high - at[k])));
  }
  if ((side[0][0] && side[0][1]) + (side[1][0] && side[1][1]) == 0) return 0;
  if (far >= ldexp(1, -SIMPLE_BITS - 4) || far < LEAST_SIZE) return 0;
  int exponent, count = 0;
  (void)frexp(far, &exponent);
  const int log2 = exponent < -BOX_BITS ? BOX_BITS : -exponent;
  for (int n = 0; n < 4; n++) {
    struct piece half;
    const limb u = (limb)ldexp(at[0], log2) - (n / 2 == 0), v = (limb)ldexp(at[1], log2) - (n % 2 == 0);
    if (!side[0][n / 2] || !side[1][n % 2]) continue;
    (void)piece_part(whole, 0, u, u + 1, log2, &j->pool, &half);
    (void)piece_part(&half, 1, v, v + 1, log2, &j->pool, &out[count++]);
  }
  return count;
}

/* Divides the piece: the parts that hold the box, or its halves. Returns how many of them may hold a root, or -1 if
 * there was no room. */
static int divide(struct judge *j, struct waiting *it, const double box[2][2], struct waiting out[PARTS_MAX])
{
  struct piece part[PARTS_MAX];
  int axis = piece_longer(&it->piece), count = 0, parts = divide_at_simple(j, it, box, part);
  const double length[2] = {box[0][1] - box[0][0], box[1][1] - box[1][0]};
  if (parts == 0 && real_max(length[0], length[1]) < BOX_LENGTH && length[0] * it->piece.size[0] >= LEAST_SIZE &&
      length[1] * it->piece.size[1] >= LEAST_SIZE) {
    parts = piece_box(&it->piece, box, &j->pool, &part[0]) ? 1 : -1;
  } else if (parts == 0) {
    if (it->piece.size[axis] <= LEAST_SIZE) axis = 1 - axis;
    for (; parts >= 0 && parts < 2; parts++)
      if (!piece_part(&it->piece, axis, (limb)parts, (limb)parts + 1, 1, &j->pool, &part[parts])) parts = -2;
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
    double box[2][2];
    j->pool.used = it.keep;
    j->pool.work -= WORK_PIECE;
    if (beyond(j, &it) || decide(j, &it, box)) continue;
    const int parts = j->pool.work > 0 && count + PARTS_MAX <= WAITING_MAX ? divide(j, &it, box, part) : -1;
    if (parts < 0) judge_left(j, it.near, it.far);
    for (int h = 0; h < parts; h++) waiting[count++] = part[h];
  }
}

/* ---- patches ---- */

/* A border all of whose points are on the ray: a pole, which is hit there, or a line along the ray. */
static void report_met(struct judge *j, int border)
{
  const bool is_pole = edge_is_point(j->asked->model->scene->patches[j->patch].P, border);
  struct depth depth = {.error = 0};
  wide t[4];
  double near = INFINITY, far = -INFINITY, at[2];
  for (int n = 3; n >= 0; n--) {
    depth.w = piece_coefficient(&j->sight.plane, NET_W, edge_at(border, n), &depth.exact);
    t[n] = depth.w / j->sight.along;
    near = real_min(near, (double)t[n]), far = real_max(far, (double)t[n]);
  }
  const int end = t[3] < t[0]; /* of a line, that which the ray meets first */
  edge_place(border, is_pole ? 0.5 : end, at);
  struct exact_root pole = {.patch = j->patch, .borders = 1u << border, .u = at[0], .v = at[1]};
  pole.t = t[0], pole.t_error = (double)(8 * WIDE_ROUNDOFF * wide_abs(t[0]));
  if (is_pole && place_in_range(j, &depth) == PLACE_IN) judge_root(j, &pole);
  if (is_pole) return;
  judge_maybe(j, at[0], at[1], (double)t[3 * end], 0, near);
  if (far >= j->asked->ray->t_min) judge_left(j, near, INFINITY); /* its other points */
}

/* Whether t is the same all over the patch and not within the ray's range: a flat patch across an axis. */
static bool out_of_range(const struct judge *j)
{
  struct depth depth = {.error = j->sight.plane.error[NET_W]};
  depth.w = piece_coefficient(&j->sight.plane, NET_W, 0, &depth.exact);
  return depth.error == 0 && place_in_range(j, &depth) != PLACE_IN;
}

void exact_search(struct judge *j, uint32_t patch, double near)
{
  struct waiting waiting[WAITING_MAX];
  int count = 0;
  if (j->pool.work > 0) judge_turn(j, patch);
  if (j->pool.work <= 0 || !j->seen) {
    judge_left(j, near, INFINITY);
    return;
  }
  if (out_of_range(j)) return;
  const size_t before = j->pool.used;
  for (int k = -1; k < j->sight.borders; k++) {
    waiting[count] = (struct waiting){
      .piece = k < 0 ? j->sight.off : j->sight.on[k], .keep = j->pool.used, .border = k};
    set_reach(j, &waiting[count++]);
  }
  for (int k = 0; k < 4; k++)
    if (j->sight.met & 1u << k) report_met(j, k);
  search_run(j, waiting, count);
  j->pool.used = before;
}
