/* Pieces of a patch. See piece.h. */
#include "intersect/exact/piece.h"

#include "base/real.h"
#include "geometry/patch.h"

/* ---- nets ---- */

/* The bits of the largest coefficient, by those of all together; 0 only if all are 0. */
static int net_bits(const limb *net, int limbs)
{
  for (int k = limbs; k-- > 0;) {
    limb any = 0;
    for (int c = 0; c < 16; c++) {
      const limb fill = limbs_fill(net + c * limbs, limbs);
      any |= (net[c * limbs + k] ^ fill) | (k == 0 && fill);
    }
    if (any) return LIMB_BITS * k + LIMB_BITS - __builtin_clzll(any);
  }
  return 0;
}

/* The leading bits that net_round keeps of the largest coefficient. */
enum { WINDOW = 62 };

int net_round(const limb *net, int limbs, double out[4][4])
{
  const int bits = net_bits(net, limbs), shift = bits > WINDOW ? bits - WINDOW : 0;
  const double unit = ldexp(1, shift - bits);
  for (int c = 0; c < 16; c++) out[c / 4][c % 4] = (double)limbs_window(net + c * limbs, limbs, shift) * unit;
  return bits;
}

limb *pool_net(struct pool *pool, int limbs)
{
  limb *net = pool->at + pool->used;
  if (limbs > PIECE_LIMBS_MAX || pool->used + 16 * (size_t)limbs > pool->room) return NULL;
  pool->used += 16 * (size_t)limbs, pool->work -= work_of_net(limbs);
  return net;
}

wide piece_coefficient(const struct piece *piece, int k, int c, bool *exact)
{
  return limbs_wide(piece->net[k] + c * piece->limbs[k], piece->limbs[k], piece->exponent[k], exact);
}

void piece_depth_changes(const struct piece *piece, int limbs, limb *out)
{
  const int in = piece->limbs[NET_W];
  limb from[PIECE_LIMBS_MAX + 1];
  limbs_copy(from, limbs, piece->net[NET_W], in);
  for (int c = 0; c < 16; c++) {
    limbs_copy(out + c * limbs, limbs, piece->net[NET_W] + c * in, in);
    limbs_subtract(out + c * limbs, out + c * limbs, from, limbs);
  }
}

void piece_measure(struct piece *piece)
{
  limb change[16 * (PIECE_LIMBS_MAX + 1)];
  bool exact;
  for (int k = 0; k < NETS; k++) {
    if (k != NET_W) piece->bits[k] = net_round(piece->net[k], piece->limbs[k], piece->value[k]);
    piece->error[k] = PIECE_ERROR;
  }
  piece->bits[NET_W] = net_bits(piece->net[NET_W], piece->limbs[NET_W]);
  const int limbs = limbs_for(piece->bits[NET_W] + 1);
  piece_depth_changes(piece, limbs, change);
  const int bits = net_round(change, limbs, piece->value[NET_W]);
  piece->scale = bits + piece->exponent[NET_W];
  if (bits == 0) piece->error[NET_W] = 0;
  piece->start = (double)piece_coefficient(piece, NET_W, 0, &exact);
}

/* ---- parts, exactly ---- */

/* The index of coefficient k of the cubic number `row` that runs along u (axis 0) or v. */
static inline int cubic_at(int axis, int row, int k) { return axis == 0 ? 4 * k + row : 4 * row + k; }

/* The limb of 2^by x, of which `below` is the limb before. */
static inline limb shift_limbs(limb x, limb below, int by) { return by == 0 ? x : x << by | below >> (LIMB_BITS - by); }

/* The cubic over [from, from + length] / 2^log2, times 2^(3 log2). Let D[k] be its k-th forward differences, so it is the
 * sum of binomial(3,k) D[k] t^k; those are moved to `from` by Horner's scheme, and become coefficients again by sums. */
static void cubic_part(const limb *const c[4], int in, limb *const out[4], int limbs, limb from, limb length, int log2)
{
  limb D[4][PIECE_LIMBS_MAX];
  limb_sum borrow[6] = {0};
  for (int k = 0; k < limbs; k++) {
    const limb x[4] = {limbs_at(c[0], in, k), limbs_at(c[1], in, k), limbs_at(c[2], in, k), limbs_at(c[3], in, k)};
    limb once[3], twice[2];
    for (int n = 0; n < 3; n++)
      borrow[n] += x[n + 1], borrow[n] -= x[n], once[n] = (limb)borrow[n], borrow[n] >>= LIMB_BITS;
    for (int n = 0; n < 2; n++)
      borrow[n + 3] += once[n + 1], borrow[n + 3] -= once[n], twice[n] = (limb)borrow[n + 3],
                                                              borrow[n + 3] >>= LIMB_BITS;
    borrow[5] += twice[1], borrow[5] -= twice[0];
    D[0][k] = x[0], D[1][k] = once[0], D[2][k] = twice[0], D[3][k] = (limb)borrow[5], borrow[5] >>= LIMB_BITS;
  }
  for (int last = 2; last >= 0; last--) {
    for (int n = 0; n <= last; n++) {
      limb_pair sum = 0;
      limb below = 0;
      for (int k = 0; k < limbs; k++) {
        const limb x = D[n][k];
        sum += (limb_pair)D[n + 1][k] * from + shift_limbs(x, below, log2);
        D[n][k] = (limb)sum, sum >>= LIMB_BITS, below = x;
      }
    }
  }
  const limb by[4] = {1, length, length * length, length * length * length};
  limb_pair part[4] = {0}, sum[4] = {0};
  for (int k = 0; k < limbs; k++) {
    limb x[4];
    for (int n = 0; n < 4; n++) part[n] += (limb_pair)D[n][k] * by[n], x[n] = (limb)part[n], part[n] >>= LIMB_BITS;
    sum[1] += (limb_pair)x[0] + x[1], sum[2] += (limb_pair)x[0] + 2 * (limb_pair)x[1] + x[2];
    sum[3] += (limb_pair)x[0] + 3 * ((limb_pair)x[1] + x[2]) + x[3];
    out[0][k] = x[0];
    for (int n = 1; n < 4; n++) out[n][k] = (limb)sum[n], sum[n] >>= LIMB_BITS;
  }
}

/* Sets the nets of `out` to those of its part of what `piece` is a part of, along one axis. */
static bool part_exactly(const struct piece *piece, int axis, struct pool *pool, struct piece *out)
{
  const int log2 = piece->log2[axis];
  for (int k = 0; k < NETS; k++) {
    out->limbs[k] = limbs_for(piece->bits[k] + 3 * log2), out->exponent[k] = piece->exponent[k] - 3 * log2;
    out->net[k] = pool_net(pool, out->limbs[k]);
    if (!out->net[k]) return false;
    for (int row = 0; row < 4; row++) {
      const limb *c[4];
      limb *to[4];
      for (int n = 0; n < 4; n++) {
        const int at = cubic_at(axis, row, n);
        c[n] = piece->net[k] + at * piece->limbs[k], to[n] = out->net[k] + at * out->limbs[k];
      }
      cubic_part(c, piece->limbs[k], to, out->limbs[k], piece->from[axis], piece->length[axis], log2);
    }
    out->bits[k] = net_bits(out->net[k], out->limbs[k]);
  }
  out->from[axis] = 0, out->length[axis] = 1, out->log2[axis] = 0;
  return true;
}

bool piece_exact(struct piece *piece, struct pool *pool)
{
  struct piece half = *piece, all;
  const size_t before = pool->used;
  if (piece_is_exact(piece)) return true;
  if (!part_exactly(piece, 0, pool, &half)) return false;
  all = half;
  if (!part_exactly(&half, 1, pool, &all)) return false;
  const size_t length = pool->used - (size_t)(all.net[0] - pool->at); /* over the halves, which served */
  memmove(pool->at + before, all.net[0], length * sizeof(limb));
  for (int k = NETS; k-- > 0;) all.net[k] = pool->at + before + (all.net[k] - all.net[0]);
  pool->used = before + length;
  *piece = all;
  piece_measure(piece);
  return true;
}

/* ---- parts, in doubles ---- */

/* The cubics that run along the axis, over [ends[0], ends[1]], by blossoms: each of three steps is a mean, with two
 * roundings of its size, and exact weights. */
static void cut(const double net[4][4], int axis, const double ends[2], double out[4][4])
{
  for (int row = 0; row < 4; row++) {
    double once[2][3], twice[3][2];
    for (int e = 0; e < 2; e++) {
      for (int n = 0; n < 3; n++) {
        const int at = cubic_at(axis, row, n), next = cubic_at(axis, row, n + 1);
        once[e][n] = (1 - ends[e]) * net[at / 4][at % 4] + ends[e] * net[next / 4][next % 4];
      }
    }
    for (int e = 0; e < 3; e++) { /* first and first, first and last, last and last */
      const double *c = once[e / 2], at = ends[(e + 1) / 2];
      for (int n = 0; n < 2; n++) twice[e][n] = (1 - at) * c[n] + at * c[n + 1];
    }
    for (int n = 0; n < 4; n++) {
      const double *c = twice[n < 2 ? 0 : n - 1], at = ends[n > 0];
      const int to = cubic_at(axis, row, n);
      out[to / 4][to % 4] = (1 - at) * c[0] + at * c[1];
    }
  }
}

/* Scales a net by a power of two, so that the largest coefficient is 1/2 to 1. Returns the exponent taken out. */
static int normalise(double net[4][4], double *error)
{
  double most = 0;
  int exponent;
  for (int c = 0; c < 16; c++) most = real_max(most, fabs(net[c / 4][c % 4]));
  (void)frexp(most, &exponent);
  if (most == 0 || exponent == 0) return 0;
  const double by = ldexp(1, -exponent);
  for (int c = 0; c < 16; c++) net[c / 4][c % 4] *= by;
  *error *= by;
  return exponent;
}

/* Parts that are longer than this, in units of their place in what they are a part of, are made exact first. */
enum { LENGTH_BITS = 20, PLACE_BITS = 60 };

bool piece_part(struct piece *piece, int axis, limb from, limb to, int log2, struct pool *pool, struct piece *out)
{
  const double ends[2] = {ldexp((double)from, -log2), ldexp((double)to, -log2)};
  if ((piece->log2[axis] + log2 > PLACE_BITS || piece->length[axis] * (to - from) >> LENGTH_BITS) &&
      !piece_exact(piece, pool))
    return false;
  *out = *piece;
  if (to - from == (limb)1 << log2) return true;
  out->from[axis] = (piece->from[axis] << log2) + from * piece->length[axis];
  out->length[axis] = piece->length[axis] * (to - from), out->log2[axis] = piece->log2[axis] + log2;
  out->low[axis] += (wide)ends[0] * piece->size[axis], out->size[axis] *= ends[1] - ends[0];
  if (from > 0) out->borders &= ~(1u << (2 * axis));
  if (ends[1] < 1) out->borders &= ~(1u << (2 * axis + 1));
  for (int k = 0; k < NETS; k++) {
    cut(piece->value[k], axis, ends, out->value[k]);
    if (out->error[k] > 0) out->error[k] += 8 * UNIT_ROUNDOFF; /* or all are equal */
    const int exponent = normalise(out->value[k], &out->error[k]);
    if (k == NET_W) out->scale += exponent;
  }
  return true;
}

bool piece_box(struct piece *piece, const double box[2][2], struct pool *pool, struct piece *out)
{
  struct piece half;
  for (int axis = 0; axis < 2; axis++) {
    int exponent;
    (void)frexp(box[axis][1] - box[axis][0], &exponent);
    const int log2 = 3 - exponent < 2 ? 2 : 3 - exponent > BOX_BITS ? BOX_BITS : 3 - exponent;
    const double cells = ldexp(1, log2), from = real_clamp(floor(box[axis][0] * cells), 0, cells - 1);
    const double to = real_clamp(ceil(box[axis][1] * cells), from + 1, cells);
    if (!piece_part(axis ? &half : piece, axis, (limb)from, (limb)to, log2, pool, axis ? out : &half)) return false;
  }
  return true;
}

/* ---- tests ---- */

bool piece_misses(const struct piece *piece)
{
  for (int k = 0; k < 2; k++) {
    const double off = piece_is_exact(piece) ? 0 : piece->error[k]; /* rounding keeps signs */
    int positive = 0, negative = 0;
    for (int c = 0; c < 16; c++)
      positive += piece->value[k][c / 4][c % 4] > off, negative += piece->value[k][c / 4][c % 4] < -off;
    if (positive == 16 || negative == 16) return true;
  }
  return false;
}

bool piece_corner_root(struct piece *piece, int iu, int iv, struct pool *pool)
{
  const int c = 12 * iu + 3 * iv;
  for (int k = 0; k < 2; k++)
    if (fabs(piece->value[k][3 * iu][3 * iv]) > piece->error[k]) return false;
  if (!piece_exact(piece, pool)) return false;
  for (int k = 0; k < 2; k++)
    if (!limbs_zero(piece->net[k] + c * piece->limbs[k], piece->limbs[k])) return false;
  return true;
}

int piece_longer(const struct piece *piece)
{
  double along[2] = {0, 0};
  for (int k = 0; k < 2; k++) {
    const double(*x)[4] = piece->value[k];
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 3; j++) {
        along[0] = real_max(along[0], fabs(x[j + 1][i] - x[j][i]));
        along[1] = real_max(along[1], fabs(x[i][j + 1] - x[i][j]));
      }
    }
  }
  return along[0] == along[1] ? piece->size[1] > piece->size[0] : along[1] > along[0];
}

/* ---- combinations ---- */

limb *piece_combine(const struct piece *piece, struct weight p, struct weight q, struct pool *pool, int *out_limbs)
{
  const int in[2] = {piece->limbs[NET_A], piece->limbs[NET_B]};
  const int bits[2] = {piece->bits[NET_A] + limbs_bits(p.at, p.limbs), piece->bits[NET_B] + limbs_bits(q.at, q.limbs)};
  const int limbs = *out_limbs = limbs_for((bits[0] > bits[1] ? bits[0] : bits[1]) + 1);
  limb *out = pool_net(pool, limbs), product[PIECE_LIMBS_MAX];
  for (int c = 0; c < 16 && out; c++) {
    limbs_product(out + c * limbs, limbs, p.at, p.limbs, piece->net[NET_A] + c * in[0], in[0]);
    limbs_product(product, limbs, q.at, q.limbs, piece->net[NET_B] + c * in[1], in[1]);
    limbs_subtract(out + c * limbs, out + c * limbs, product, limbs);
  }
  return out;
}

/* ---- along the ray ---- */

void piece_depths(const struct piece *piece, double *least, double *most)
{
  double low = INFINITY, high = -INFINITY;
  for (int c = 0; c < 16; c++)
    low = real_min(low, piece->value[NET_W][c / 4][c % 4]), high = real_max(high, piece->value[NET_W][c / 4][c % 4]);
  low = ldexp(low - piece->error[NET_W], piece->scale), high = ldexp(high + piece->error[NET_W], piece->scale);
  /* the start, the sum, the differences above, and what the caller divides by */
  const double slack = 8 * UNIT_ROUNDOFF * (fabs(piece->start) + real_max(-low, high));
  *least = piece->start + low - slack, *most = piece->start + high + slack;
}

wide piece_depth(const struct piece *piece, const double at[2], double radius, double *error, bool *exact)
{
  double rest[4][4], most = 0;
  memcpy(rest, piece->value[NET_W], sizeof rest);
  for (int c = 0; c < 16; c++) most = real_max(most, fabs(rest[c / 4][c % 4]));
  const wide start = piece_coefficient(piece, NET_W, 0, exact);
  *error = 0;
  if (most == 0) return start;
  const double unit = ldexp(1, piece->scale);
  const struct patch_jet jet = patch_evaluate(rest, at[0], at[1]);
  /* derivatives on the margin, of both parameters; roundings as in newton; the start, known to 112 bits, and the sum */
  *error = (2 * 6 * PIECE_GROWTH * most * radius + PIECE_MARGIN_OFF * 21 * UNIT_ROUNDOFF * most) * unit +
           (double)(6 * WIDE_ROUNDOFF * wide_abs(start));
  return start + (wide)(jet.value * unit);
}
